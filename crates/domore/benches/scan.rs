//! How fast programs scan: `cargo bench -p domore`. The goal behind it is a proof that runs 100,000 pairs
//! of scans a second on a program of 100 rungs.

use std::time::{Duration, Instant};

use domore::engine::{Machine, Options, Program, Value};

/// Rungs as a converted program has them: seal-ins, timers, counters, arithmetic, compares.
fn text(groups: usize) -> String {
    let mut text = String::from("$PRGRM $Main\n\n");
    for n in 0..groups {
        let (x, c) = (n * 3, n * 4);
        text.push_str(&format!("STR X{x}\nOR C{c}\nANDN X{}\nOUT C{c}\n\n", x + 1));
        text.push_str(&format!("STR C{c}\nANDN T{n}.Done\nTMR T{n} 500\n\n"));
        text.push_str(&format!("STR T{n}.Done\nSTR X{}\nUDCG CT{n} 10 DST511\n\n", x + 2));
        text.push_str(&format!("STRGE CT{n}.Acc 5\nAND C{c}\nMATH N{n} \"IF(N{n} > 32000, 0, N{n} + 1)\"\n\n"));
        text.push_str(&format!("STR C{c}\nSTRLT N{n} 100\nORSTR\nMOVE N{n} D{n}\nOUT Y{n}\n\n"));
    }
    text + "$PGMEND $Main\n"
}

fn main() {
    let project = domore::text::read(&text(20)).map(|reading| reading.project).expect("reads");
    let rungs = project.code_blocks().map(|block| block.rungs.len()).sum::<usize>();
    let program = Program::compile(&project, &Options::default()).expect("compiles");
    let mut machine = Machine::new(program);
    machine.enter_run();
    let inputs: Vec<_> = (0..60).filter_map(|number| machine.handle(&format!("X{number}")).ok()).collect();
    machine.set("X0", &Value::Bit(true)).expect("an input");
    let (scans, mut seed) = (400_000u64, 1u64);
    let started = Instant::now();
    for scan in 0..scans {
        // Some input changes in every scan, as in a proof.
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        if let Some(input) = inputs.get((seed >> 33) as usize % inputs.len()) {
            machine.set_number(*input, domore::memory::Num::Int((seed >> 60 & 1) as i64));
        }
        machine.scan(if scan == 0 { Duration::ZERO } else { Duration::from_millis(10) });
    }
    let seconds = started.elapsed().as_secs_f64();
    let executed = machine.instructions();
    println!(
        "{rungs} rungs: {:.0} scans/s, {:.2} ns an instruction ({} a scan)",
        scans as f64 / seconds,
        seconds * 1e9 / executed as f64,
        executed / scans
    );
    let started = Instant::now();
    let mut other = machine.fork();
    for _ in 0..10_000 {
        assert!(other.copy_from(&machine));
    }
    println!("taking over a state: {:.2} us", started.elapsed().as_secs_f64() * 1e6 / 10_000.0);
}
