//! Programs and data made to break the engine end in the documented fault, quickly.

mod common;

use std::time::{Duration, Instant};

use common::Bench;
use ladder::Family::{self, MicroLogix1000, MicroLogix1100, MicroLogix1400, Slc502, Slc503};
use ladder::{Address, Branch, Element, Instruction, Mnemonic, Rung, Value};
use sim::{Choices, Machine, Options, Program};

fn after_one_scan(family: Family, ladder: &str, data: &[(&str, i64)]) -> Option<u16> {
    let mut bench = Bench::new(family, ladder, data);
    bench.scans(1);
    bench.fault()
}

#[test]
fn loops_end_in_the_watchdog() {
    let start = Instant::now();
    assert_eq!(after_one_scan(Slc503, "LBL 1 JMP 1", &[]), Some(0x22));
    // Calls that fan out without going deep.
    let calls = "JSR 3\n".repeat(100);
    let files: Vec<(u16, String)> = (2..9)
        .map(|n| (n, if n == 8 { "OTE B3:0/0".into() } else { calls.replace('3', &(n + 1).to_string()) }))
        .collect();
    let files: Vec<(u16, &str)> = files.iter().map(|(n, text)| (*n, text.as_str())).collect();
    let mut bench = Bench::files(Slc503, &files, &[], Choices::default());
    bench.scans(1);
    assert_eq!(bench.fault(), Some(0x22));
    // A fault routine that loops, an interrupt that loops.
    let program = [(2, "LBL 1 JMP 1"), (3, "LBL 1 JMP 1")];
    let mut bench = Bench::files(Slc503, &program, &[("S:29", 3)], Choices::default());
    bench.scans(1).expect(&[("S:5/3", 1)]);
    assert_eq!(bench.fault(), Some(0x22));
    let program = [(2, "OTE B3:0/0"), (5, "LBL 1 JMP 1")];
    let data = [("S:31", 5), ("S:30", 1), ("S:2/1", 1)];
    let mut bench = Bench::files(Slc503, &program, &data, Choices::default());
    bench.scans(2);
    assert_eq!(bench.fault(), Some(0x22));
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}

#[test]
fn recursion_is_too_deep() {
    let mut bench = Bench::files(Slc503, &[(2, "JSR 3"), (3, "JSR 3")], &[], Choices::default());
    bench.scans(1);
    assert_eq!(bench.fault(), Some(0x30));
    let mut bench = Bench::files(MicroLogix1400, &[(2, "JSR 2")], &[], Choices::default());
    bench.scans(1);
    assert_eq!(bench.fault(), Some(0x30));
}

#[test]
fn indirect_addresses_into_nowhere() {
    for index in [-1, -32768, 300, 32767] {
        let data = [("N7:0", index), ("N7:20", 0)];
        assert_eq!(after_one_scan(Slc503, "MOV N7:[N7:0] N7:1", &data), Some(0x2C), "{index}");
        assert_eq!(after_one_scan(Slc503, "MOV 1 N7:[N7:0]", &data), Some(0x2C), "{index}");
        assert_eq!(after_one_scan(Slc503, "COP #N7:[N7:0] #N7:2 2", &data), Some(0x2C), "{index}");
    }
    for index in [-1000, 3000, 32767] {
        let data = [("N7:0", index)];
        assert_eq!(after_one_scan(MicroLogix1400, "MOV N7:[N7:0] N7:1", &data), Some(0x29), "{index}");
        assert_eq!(after_one_scan(MicroLogix1400, "OTE B3:[N7:0]/1", &data), Some(0x29), "{index}");
    }
    for number in [-1, 9, 300] {
        let data = [("N7:0", number)];
        assert_eq!(after_one_scan(Slc503, "MOV N[N7:0]:0 N7:1", &data), Some(0x2B), "{number}");
        assert_eq!(after_one_scan(MicroLogix1100, "MOV N[N7:0]:0 N7:1", &data), Some(0x29), "{number}");
    }
    assert_eq!(after_one_scan(Slc503, "OTE B3:2/[N7:0]", &[("N7:0", 16)]), Some(0x2D));
    assert_eq!(after_one_scan(Slc503, "OTE B3:2/[N7:0]", &[("N7:0", -1)]), Some(0x2D));
    let mut bench = Bench::new(MicroLogix1400, "OTE B3:2/[N7:0]", &[("N7:0", 16)]);
    bench.scans(1).expect(&[("B3:2", 0), ("B3:3", 0)]);
    assert_eq!((bench.fault(), bench.machine.strays() > 0), (None, true));
}

#[test]
fn indexed_addresses_beyond_their_file() {
    assert_eq!(after_one_scan(Slc502, "MOV #N7:10 N7:1", &[("S:24", 10), ("N7:20", 77)]), None);
    assert_eq!(after_one_scan(Slc502, "MOV #N7:10 N7:1", &[("S:24", 11)]), Some(0x2A));
    assert_eq!(after_one_scan(MicroLogix1000, "MOV #N7:10 N7:1", &[("S:24", -11)]), Some(0x2A));
    let across = [("S:24", -11), ("S:2/3", 1)];
    assert_eq!(after_one_scan(Slc502, "MOV #N7:10 N7:1", &across), None, "the file before");
    let outside = [("S:24", 32767), ("S:2/3", 1)];
    assert_eq!(after_one_scan(Slc502, "MOV #N7:10 N7:1", &outside), Some(0x29));
}

#[test]
fn lengths_beyond_files() {
    let end = |data: &[(&str, i64)], ladder: &str| after_one_scan(Slc503, ladder, data);
    assert_eq!(end(&[("R6:0.LEN", 2000)], "BSL #B3:1 R6:0 N7:0/0 16"), Some(0x33));
    assert_eq!(end(&[("R6:0.LEN", -1)], "BSL #B3:1 R6:0 N7:0/0 16"), Some(0x20), "S:5/2 at END");
    assert_eq!(end(&[("R6:0.LEN", 32767)], "FFL N7:0 #N7:2 R6:0 3 0"), Some(0x33));
    assert_eq!(end(&[("R6:0.LEN", 32767)], "FFU #N7:2 N7:0 R6:0 3 0"), Some(0x33));
    assert_eq!(end(&[("R6:0.POS", 9)], "FFL N7:0 #N7:2 R6:0 3 0"), Some(0x20));
    assert_eq!(end(&[("R6:0.LEN", 32767)], "SQO #N7:2 0FFFFh O:0 R6:0 3 0"), Some(0x32));
    assert_eq!(end(&[("R6:0.POS", 32767)], "SQO #N7:2 0FFFFh O:0 R6:0 3 0"), None, "wraps to 1");
    assert_eq!(end(&[("R6:0.LEN", 0)], "SQO #N7:2 0FFFFh O:0 R6:0 3 0"), Some(0x20));
    assert_eq!(end(&[("N7:9", 5)], "FLL 7 #N7:0 128"), None);
    assert_eq!(end(&[("ST9:0.LEN", 83)], "ACN ST9:0 ST9:0 ST9:1"), None, "S:5/15 is no fault");
    assert_eq!(end(&[("T4:0.PRE", -1)], "TON T4:0 0.01 5 0"), Some(0x34));
}

#[test]
fn copies_stop_at_the_end_of_the_file() {
    let image = {
        let rungs =
            convert::slc::rung::parse_rungs("COP #B3:0 #N7:18 100\nFLL 9 #T4:1 100", Some(Slc503)).expect("rungs");
        let mut image = sim::inline_image(Slc503, vec![(2, rungs)]);
        let file = |file_type, number, elements| ladder::DataFile::new(file_type, number, elements);
        use ladder::FileType::{B, C, N, T};
        image.data_files = vec![file(B, 3, 8), file(T, 4, 2), file(C, 5, 2), file(N, 7, 20), file(N, 9, 20)];
        image
    };
    let mut machine = Machine::new(Program::compile(&image, &Options::default()).expect("program"));
    let at = |text: &str| Address::parse(text).expect("address");
    for word in 0..8 {
        machine.set(&at(&format!("B3:{word}")), &Value::Word(5)).expect("word");
    }
    machine.enter_run();
    machine.scan(Duration::ZERO);
    let get = |text: &str| machine.get(&at(text)).expect("word");
    assert_eq!((get("N7:18"), get("N7:19"), get("N9:0")), (Value::Word(5), Value::Word(5), Value::Word(0)));
    assert_eq!((get("T4:1.ACC"), get("C5:0.PRE")), (Value::Word(9), Value::Word(0)));
}

#[test]
fn odd_rungs_compile_or_are_refused() {
    let named = |name: &'static str| Element::Instruction(Instruction::new(Mnemonic::named(name), Vec::new()));
    let image = |series| sim::inline_image(Slc503, vec![(2, vec![Rung::new(series)])]);
    let compile = |series| Program::compile(&image(series), &Options { inline: true, ..Options::default() });
    // Every instruction without operands: refused with its rung, or harmless.
    for instruction in instr::all() {
        match compile(vec![named(instruction.mnemonic)]) {
            Ok(program) => {
                let mut machine = Machine::new(program);
                machine.enter_run();
                machine.scan(Duration::ZERO);
                machine.scan(Duration::from_secs(1));
            }
            Err(refusals) => assert!(refusals.iter().all(|refusal| refusal.site.is_some()), "{refusals:?}"),
        }
    }
    assert!(compile(vec![Element::Instruction(Instruction::new(Mnemonic::Unknown(0x77), Vec::new()))]).is_err());
    // Branches without legs, with empty legs, and nested beyond reason.
    for legs in [Vec::new(), vec![Vec::new()], vec![Vec::new(), Vec::new()]] {
        assert!(compile(vec![Element::Branch(Branch { legs })]).is_ok());
    }
    let mut nested = Vec::new();
    for _ in 0..500 {
        nested = vec![Element::Branch(Branch { legs: vec![nested] })];
    }
    let refusals = compile(nested).expect_err("too deep");
    assert!(refusals[0].to_string().contains("file 2 rung 0"), "{refusals:?}");
}

#[test]
fn an_empty_image_faults_on_the_way_to_run() {
    let program = Program::compile(&ladder::Image::default(), &Options::default()).expect("nothing to refuse");
    let mut machine = Machine::new(program);
    machine.scan(Duration::ZERO);
    assert_eq!(machine.fault(), None, "program mode executes nothing");
    machine.enter_run();
    machine.scan(Duration::ZERO);
    assert_eq!(machine.fault().map(|fault| fault.code), Some(0x11));
}

#[test]
fn huge_times_end() {
    let start = Instant::now();
    let program = [(2, "TON T4:0 0.01 32767 0\nRHC N7:1"), (5, "ADD N7:0 1 N7:0\nOTU S:5/0")];
    let data = [("S:31", 5), ("S:30", 1), ("S:2/1", 1), ("S:2/10", 1), ("S:37", 9999), ("S:38", 12), ("S:39", 31)];
    let mut bench = Bench::files(Slc503, &program, &data, Choices::default());
    for _ in 0..3 {
        bench.machine.scan(Duration::MAX);
        bench.machine.advance(Duration::MAX);
    }
    bench.expect(&[("T4:0.ACC", 32767), ("T4:0/DN", 1)]);
    assert!(start.elapsed() < Duration::from_secs(30), "{:?}", start.elapsed());
}
