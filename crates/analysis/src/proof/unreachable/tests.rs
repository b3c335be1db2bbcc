//! The circuit of a scan allows everything the machine does.

use std::collections::BTreeSet;
use std::time::Duration;

use ladder::{Address, Family, FileType, Value};
use sim::{Machine, Program, Recorder};

use super::cells::is_hidden;
use super::gates::Answer;
use super::scan::{Before, Scan};
use random::Plan;

#[allow(dead_code)]
#[path = "../../../../sim/tests/random/mod.rs"]
mod random;

fn on(data: &[u16], at: u32) -> bool {
    data[(at / 16) as usize] >> (at % 16) & 1 != 0
}

#[test]
fn every_scan_of_the_machine_is_one_of_the_circuit() {
    let families = [Family::Slc501, Family::Slc503, Family::MicroLogix1000, Family::MicroLogix1100];
    let (mut seed, mut scans) = (77u64, 0);
    let mut dice = |limit: u64| {
        seed = seed.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
        (seed >> 33) % limit
    };
    for case in 0..150 {
        let mut rungs = |most: u64| -> Vec<u64> { (0..1 + dice(most)).map(|_| dice(1 << 31) << 16 | 1).collect() };
        let (main, subroutine) = (rungs(8), rungs(3));
        let family = families[case % 4];
        let plan = Plan { family, main, subroutine, seed: case as u64 + 1, scans: 0, forgiving: true };
        let choices = sim::Choices::default().with(sim::choices::Choice::IndirectStaysInFile);
        let options = sim::Options { choices, ..sim::Options::default() };
        let (mut image, mut data) = (plan.image(), plan.data());
        for file in image.data_files.iter_mut().filter(|file| case % 2 == 0 && file.file_type != FileType::S) {
            let file_type = file.file_type;
            file.words.iter_mut().enumerate().for_each(|(index, word)| *word = data.word(file_type, index));
        }
        let program = Program::compile(&image, &options).expect("it runs");
        let outline = program.outline();
        let inputs = BTreeSet::new();
        let Ok(mut any) = Scan::build(&outline, Before::Any, &inputs) else { continue };
        let stored: Vec<_> =
            any.initial.iter().map(|(at, bit)| (*at, *bit)).filter(|(at, _)| !is_hidden(*at)).collect();
        let behind: Vec<_> = stored.iter().map(|(at, _)| (*at, any.bit(*at))).collect();
        let mut machine = Machine::new(program);
        for scan in 0..30 {
            let before = machine.data().to_vec();
            let entered = scan == 0 || !machine.is_executing() || dice(8) == 0;
            if entered {
                machine.enter_program();
                machine.enter_run();
            }
            let terminals = Value::Word(dice(0x10000) as u16 as i16);
            // Programs without terminals have none.
            let _ = machine.set(&Address::parse("I:0.0").expect("an address"), &terminals);
            let mut seen = Recorder::default();
            let dt = if entered { 0 } else { [0, 7, 50, 3000][dice(4) as usize] };
            machine.scan_traced(Duration::from_millis(dt), &mut seen);
            let literal = |bit: batsat::Lit, on: bool| if on { bit } else { !bit };
            let mut assumed = vec![literal(any.first, entered)];
            assumed.extend(stored.iter().map(|(at, bit)| literal(*bit, on(&before, *at))));
            assumed.extend(behind.iter().map(|(at, bit)| literal(*bit, on(machine.data(), *at))));
            for flow in &seen.seen {
                let Some(at) = any.happens.get(&(flow.file, flow.rung, flow.instruction)) else { continue };
                assumed.push(match (flow.before, flow.after) {
                    (true, true) => at.passes,
                    (true, false) => at.blocks,
                    (false, _) => at.off,
                });
            }
            assert_eq!(any.gates.ask(&assumed), Answer::Possible, "case {case} scan {scan}: {}", plan.text());
            scans += 1;
        }
    }
    assert!(scans > 500);
}
