//! Program flow: subroutines, jumps, zones, branches, faults, fault routines, timed interrupts.

mod common;

use std::time::Duration;

use common::Bench;
use ladder::Family::{MicroLogix1000, MicroLogix1100, MicroLogix1400, Slc501, Slc502, Slc503};
use sim::{Choices, Mode};

#[track_caller]
fn files(family: ladder::Family, files: &[(u16, &str)], data: &[(&str, i64)]) -> Bench {
    Bench::files(family, files, data, Choices::default())
}

#[test]
fn rungs_run_downwards() {
    let mut bench = Bench::new(Slc503, "XIC B3:0/1 OTE O:0/0\nXIC I:0/0 OTE B3:0/1", &[("I:0/0", 1)]);
    bench.scans(1).expect(&[("O:0/0", 0)]);
    bench.scans(1).expect(&[("O:0/0", 1)]);
}

#[test]
fn branches_or_their_legs_and_nest() {
    let ladder = "BST XIC I:0/0 NXB XIC I:0/1 BST XIC I:0/2 NXB XIC I:0/3 BND BND OTE O:0/0";
    for inputs in 0..16i64 {
        let mut bench = Bench::new(Slc503, ladder, &[("I:0", inputs)]);
        let bit = |n: i64| inputs >> n & 1 != 0;
        let expected = bit(0) || (bit(1) && (bit(2) || bit(3)));
        bench.scans(1).expect(&[("O:0/0", expected.into())]);
    }
    // Each output sees only the conditions between the rail and itself; an empty leg is a wire.
    let mut bench =
        Bench::new(Slc503, "XIC I:0/0 BST OTE O:0/0 NXB XIC I:0/1 OTE O:0/1 NXB BND OTE O:0/2", &[("I:0/0", 1)]);
    bench.scans(1).expect(&[("O:0/0", 1), ("O:0/1", 0), ("O:0/2", 1)]);
}

#[test]
fn a_false_call_leaves_everything() {
    let mut bench =
        files(Slc503, &[(2, "XIC B3:5/1 JSR 3"), (3, "XIC I:0/0 OTE O:0/0")], &[("I:0/0", 1), ("B3:5/1", 1)]);
    bench.scans(1).expect(&[("O:0/0", 1)]);
    bench.set("I:0/0", 0).set("B3:5/1", 0).scans(1).expect(&[("O:0/0", 1)]);
    bench.set("B3:5/1", 1).scans(1).expect(&[("O:0/0", 0)]);
}

#[test]
fn a_call_goes_on_in_its_rung_and_returns_early() {
    let mut bench = files(
        Slc503,
        &[(2, "BST JSR 3 NXB OTE B3:0/0 BND OTE B3:0/1"), (3, "SBR ADD N7:0 1 N7:0\nXIC I:0/0 RET\nADD N7:1 1 N7:1")],
        &[("I:0/0", 1)],
    );
    bench.scans(3).expect(&[("N7:0", 3), ("N7:1", 0), ("B3:0/0", 1), ("B3:0/1", 1)]);
    bench.set("I:0/0", 0).scans(1).expect(&[("N7:0", 4), ("N7:1", 1)]);
}

#[test]
fn nesting_is_limited_by_family() {
    let chain = |levels: u16| -> Vec<(u16, String)> {
        (0..=levels)
            .map(|n| (n + 2, if n == levels { "OTE B3:0/0".into() } else { format!("JSR {}", n + 3) }))
            .collect()
    };
    for (family, allowed) in [(Slc501, 4), (Slc503, 8), (MicroLogix1000, 8)] {
        for (levels, fault) in [(allowed, None), (allowed + 1, Some(0x30))] {
            let program = chain(levels);
            let program: Vec<(u16, &str)> = program.iter().map(|(n, text)| (*n, text.as_str())).collect();
            let mut bench = files(family, &program, &[]);
            bench.scans(1);
            assert_eq!(bench.fault(), fault, "{family} {levels}");
        }
    }
}

#[test]
fn jumps_skip_and_go_back_until_the_watchdog() {
    let mut bench = Bench::new(Slc503, "XIC I:0/0 JMP 1\nOTE B3:0/0\nLBL 1 OTE B3:0/1", &[("I:0/0", 1)]);
    bench.scans(1).expect(&[("B3:0/0", 0), ("B3:0/1", 1)]);
    bench.set("I:0/0", 0).scans(1).expect(&[("B3:0/0", 1)]);
    bench.set("I:0/0", 1).scans(1).expect(&[("B3:0/0", 1)]);
    let mut bench = Bench::new(Slc503, "LBL 7 ADD N7:0 1 N7:0\nLES N7:0 50 JMP 7", &[]);
    bench.scans(1).expect(&[("N7:0", 50)]);
    let mut bench = Bench::new(Slc503, "LBL 7 JMP 7", &[]);
    bench.scans(1);
    assert_eq!(bench.fault(), Some(0x22));
}

#[test]
fn labels_are_checked_on_the_way_to_run() {
    for ladder in ["JMP 3", "LBL 3 OTE B3:0/0\nLBL 3 OTE B3:0/1"] {
        let bench = Bench::new(Slc503, ladder, &[]);
        assert_eq!(bench.fault(), Some(0x19), "{ladder}");
        assert_eq!(bench.machine.mode(), Mode::Fault);
    }
}

#[test]
fn a_false_zone_scans_its_rungs_false() {
    let ladder = "XIC B3:5/0 MCR\nXIC I:0/0 OTE O:0/0\nXIC I:0/1 OTL O:0/1\nXIC I:0/0 CTU C5:0 10 0\n\
                  XIC I:0/0 TOF T4:3 0.01 120 0\nMCR\nOTE O:0/2";
    let mut bench = Bench::new(Slc503, ladder, &[("B3:5/0", 1), ("I:0", 3)]);
    bench.scans(1).expect(&[("O:0/0", 1), ("O:0/1", 1), ("C5:0/CU", 1), ("T4:3/EN", 1), ("T4:3/DN", 1)]);
    bench.set("B3:5/0", 0).scans(1);
    bench.expect(&[("O:0/0", 0), ("O:0/1", 1), ("O:0/2", 1), ("C5:0/CU", 0), ("T4:3/TT", 1), ("T4:3/DN", 1)]);
    bench.scans(120).expect(&[("T4:3/TT", 0), ("T4:3/DN", 0), ("T4:3.ACC", 120)]);
    bench.set("B3:5/0", 1).scans(1).expect(&[("C5:0.ACC", 1), ("O:0/0", 1)]);
}

#[test]
fn tnd_ends_the_scan_from_any_depth() {
    let mut bench = files(Slc503, &[(2, "JSR 3\nOTE B3:0/0"), (3, "ADD N7:0 1 N7:0\nXIC I:0/0 TND")], &[("I:0/0", 1)]);
    bench.scans(2).expect(&[("N7:0", 2), ("B3:0/0", 0)]);
    bench.set("I:0/0", 0).scans(1).expect(&[("B3:0/0", 1)]);
}

#[test]
fn ret_in_main_and_suspend_stop() {
    let mut bench = Bench::new(Slc503, "XIC I:0/0 RET", &[("I:0/0", 1)]);
    bench.scans(1);
    assert_eq!(bench.fault(), Some(0x38));
    let mut bench = files(Slc503, &[(2, "OTE O:0/0\nJSR 4"), (4, "SUS 77")], &[]);
    bench.scans(1).expect(&[("S:7", 77), ("S:8", 4)]);
    assert_eq!((bench.machine.mode(), bench.fault()), (Mode::Suspend, None));
    assert_eq!(bench.get("S:1") & 0x1F, 3);
}

#[test]
fn minor_errors_count_at_the_end() {
    let overflow = [("N7:0", 32767)];
    let mut bench = Bench::new(Slc503, "ADD N7:0 1 N7:1", &overflow);
    bench.scans(1).expect(&[("N7:1", 32767), ("S:0/0", 0), ("S:0/1", 1), ("S:5/0", 1), ("S:6", 0x20)]);
    assert_eq!(bench.fault(), Some(0x20));
    let mut bench = Bench::new(Slc503, "ADD N7:0 1 N7:1\nOTU S:5/0", &overflow);
    bench.scans(5);
    assert_eq!(bench.fault(), None);
    let mut bench = Bench::new(Slc503, "ADD N7:0 1 N7:1\nTND\nOTU S:5/0", &overflow);
    bench.scans(1);
    assert_eq!(bench.fault(), Some(0x20));
}

#[test]
fn a_minor_error_names_the_rung_that_set_it() {
    let overflow = [("N7:0", 32767), ("S:24", 0)];
    let fault = |ladder: &str| {
        let mut bench = Bench::new(Slc503, ladder, &overflow);
        bench.scans(1);
        bench.machine.fault().map(|fault| (fault.code, fault.place(), fault.cause.is_some()))
    };
    assert_eq!(fault("XIC B3:0/0 OTE B3:0/1\nADD N7:0 1 N7:1\nADD N7:0 2 N7:2"), Some((0x20, (2, 1), true)));
    assert_eq!(fault("BSL #B3:1 R6:0 N7:0/0 16\nFFL N7:0 #N7:2 R6:1 0 5"), Some((0x20, (2, 1), true)), "S:5/2");
    // Cleared in between: the second one stops.
    assert_eq!(fault("ADD N7:0 1 N7:1\nOTU S:5/0\nADD N7:0 2 N7:2"), Some((0x20, (2, 2), true)));
    // The program set it, or the fault is another one: the end of the program, and the rung that failed.
    assert_eq!(fault("OTE B3:0/1\nOTL S:5/0"), Some((0x20, (2, 1), false)));
    assert_eq!(fault("ADD N7:0 1 N7:1\nOTU S:5/0\nOTL S:5/0"), Some((0x20, (2, 2), false)));
    assert_eq!(fault("OTE B3:0/1\nADD N7:0 1 N7:1\nRET"), Some((0x38, (2, 2), false)));

    let mut bench = Bench::new(Slc503, "ADD N7:0 1 N7:1\nOTE B3:0/1", &overflow);
    bench.scans(1);
    let said = "major fault 0020 (minor error bit set at the end of the scan) at file 2 rung 1, set by file 2 rung 0";
    assert_eq!(bench.machine.fault().map(|fault| fault.to_string()).as_deref(), Some(said));
    let bytes = bench.machine.save();
    let fault = bench.machine.fault();
    bench.scans(1);
    bench.machine.restore(&bytes).expect("its own state");
    assert_eq!(bench.machine.fault(), fault);
}

#[test]
fn the_fault_routine_clears_a_timer_fault() {
    let program = [(2, "XIC B3:0/0 TON T4:4 1.0 10 -5\nADD N7:0 1 N7:0"), (3, "CLR T4:4.ACC\nOTU S:1/13")];
    let mut bench = files(Slc503, &program, &[("S:29", 3), ("B3:0/0", 1), ("T4:4.ACC", -5)]);
    bench.scans(1).expect(&[("T4:4.ACC", 0), ("S:1/13", 0), ("S:6", 0x34), ("N7:0", 1)]);
    assert_eq!(bench.fault(), None);
    bench.scans(2).expect(&[("N7:0", 3)]);
}

#[test]
fn the_fault_routine_runs_once_and_cannot_clear_everything() {
    let overflow = [("S:29", 3), ("N7:0", 1)];
    let main = "ADD 32767 N7:0 N7:1";
    let mut bench = files(Slc503, &[(2, main), (3, "ADD N7:5 1 N7:5")], &overflow);
    bench.scans(3).expect(&[("N7:5", 1), ("S:1/13", 1), ("S:6", 0x20)]);
    let mut bench = files(Slc503, &[(2, main), (3, "OTU S:5/0\nOTU S:1/13")], &overflow);
    bench.scans(3).expect(&[("N7:1", 32767), ("S:5/0", 0)]);
    assert_eq!(bench.fault(), None);
    // Nesting is no user fault: the routine does not run. Registers of the program survive the routine.
    let deep: Vec<(u16, String)> = (2..14).map(|n| (n, format!("JSR {}", n + 1))).collect();
    let mut program: Vec<(u16, &str)> = deep.iter().map(|(n, text)| (*n, text.as_str())).collect();
    program.extend([(14, "OTE B3:0/0"), (20, "OTU S:1/13\nADD N7:5 1 N7:5")]);
    let mut bench = files(MicroLogix1400, &program, &[("S:29", 20)]);
    bench.scans(1).expect(&[("N7:5", 0)]);
    assert_eq!(bench.fault(), Some(0x30));
}

#[test]
fn a_program_declares_its_own_fault() {
    let mut bench = Bench::new(Slc502, "XIC I:0/0 MOV 77 S:6\nXIC I:0/0 OTL S:1/13", &[("I:0/0", 1)]);
    bench.scans(1).expect(&[("S:6", 0x4D)]);
    assert_eq!(bench.fault(), Some(0x4D));
}

#[test]
fn timed_interrupts_follow_the_status_file() {
    let program = [(2, "OTE B3:0/0"), (5, "ADD N7:0 1 N7:0")];
    let mut bench = files(Slc503, &program, &[("S:31", 5), ("S:30", 25), ("S:2/1", 1)]);
    bench.scans(1 + 100).expect(&[("N7:0", 4)]);
    let mut bench = files(Slc503, &program, &[("S:31", 5), ("S:30", 25), ("S:2/1", 1), ("S:2/10", 1)]);
    bench.scans(1 + 100).expect(&[("N7:0", 40)]);
    let mut bench = files(Slc502, &program, &[("S:31", 5), ("S:30", 255), ("S:2/1", 1)]);
    bench.scans(1 + 254).expect(&[("N7:0", 0)]).scans(1).expect(&[("N7:0", 1)]);
    let mut bench = files(Slc502, &program, &[("S:31", 5), ("S:30", 0), ("S:2/1", 1)]);
    bench.scans(1000).expect(&[("N7:0", 0)]);
    assert_eq!(bench.fault(), None);
    for (file, period, fault) in [(2, 10, 0x23), (5, -1, 0x24), (5, 256, 0x24)] {
        let bench = files(Slc502, &program, &[("S:31", file), ("S:30", period), ("S:2/1", 1)]);
        assert_eq!(bench.fault(), Some(fault), "{file} {period}");
    }
}

#[test]
fn interrupts_wait_while_disabled() {
    let program = [(2, "XIC I:0/0 STD\nXIC I:0/1 STE"), (5, "ADD N7:0 1 N7:0")];
    let mut bench = files(Slc503, &program, &[("S:31", 5), ("S:30", 2), ("S:2/1", 1), ("I:0/0", 1)]);
    bench.scans(8).expect(&[("N7:0", 0), ("S:2/0", 1), ("S:2/1", 0), ("S:36/9", 1)]);
    bench.set("I:0/0", 0).set("I:0/1", 1).scans(2).expect(&[("S:2/0", 0)]);
    assert!(bench.get("N7:0") >= 1);
}

#[test]
fn an_sti_file_that_does_not_exist_is_a_fault_on_micrologix() {
    let bench = Bench::new(MicroLogix1100, "OTE B3:0/0", &[("STI:0.PFN", 2)]);
    assert_eq!(bench.fault(), Some(0x23));
    bench_error(&bench);
}

fn bench_error(bench: &Bench) {
    assert_eq!(bench.get("STI:0.ER"), 1);
}

#[test]
fn entering_run_clears_coils_and_keeps_latches() {
    let mut bench = Bench::new(Slc503, "XIC I:0/0 OTE B3:0/0\nXIC I:0/0 OTL B3:0/1", &[("I:0/0", 1)]);
    bench.scans(1).expect(&[("B3:0", 3), ("S:1/15", 0)]);
    bench.machine.enter_program();
    bench.expect(&[("B3:0", 3)]);
    bench.machine.enter_run();
    bench.expect(&[("B3:0/0", 0), ("B3:0/1", 1), ("S:1/15", 1)]);
}

#[test]
fn first_pass_lasts_one_scan() {
    let mut bench = Bench::new(Slc503, "XIC S:1/15 ADD N7:0 1 N7:0", &[]);
    bench.scans(5).expect(&[("N7:0", 1)]);
}

#[test]
fn scan_times_average() {
    let mut bench = Bench::new(Slc502, "OTE B3:0/0", &[("S:23", 8)]);
    bench.dt = Duration::from_millis(160);
    bench.scans(2).expect(&[("S:23", 9), ("S:22", 16)]);
}

#[test]
fn clocks_run() {
    let set = [("S:37", 2023), ("S:38", 2), ("S:39", 28), ("S:40", 23), ("S:41", 59), ("S:42", 59), ("S:53", 2)];
    let mut bench = Bench::new(Slc503, "OTE B3:0/0", &set);
    bench.dt = Duration::from_millis(500);
    bench.scans(3).expect(&[
        ("S:38", 3),
        ("S:39", 1),
        ("S:40", 0),
        ("S:41", 0),
        ("S:42", 0),
        ("S:53", 3),
        ("S:4", 100),
    ]);
}

#[test]
fn a_bit_set_from_outside_leaves_the_terminals_beside_it_alone() {
    let ladder = "XIC I:0/1 OTE B3:0/0\nOTL I:0/1\nXIC I:0/1 OTE B3:0/1";
    let mut bench = Bench::new(MicroLogix1100, ladder, &[]);
    bench.scans(1).set("I:0/0", 1).scans(1).expect(&[("B3:0/0", 0), ("B3:0/1", 1), ("I:0/0", 1)]);
}

#[test]
fn forces_act_while_enabled() {
    let mut bench = Bench::new(Slc503, "XIC I:0/0 OTE O:0/0", &[]);
    let address = |text: &str| ladder::Address::parse(text).expect("address");
    assert!(bench.machine.force(&address("I:0/0"), Some(true)));
    assert!(bench.machine.force(&address("O:0/5"), Some(true)));
    assert!(!bench.machine.force(&address("B3:0/0"), Some(true)));
    bench.scans(1).expect(&[("O:0/0", 0), ("S:1/6", 1)]);
    bench.machine.enable_forces(true);
    bench.scans(1).expect(&[("I:0/0", 1), ("O:0/0", 1), ("O:0/5", 0), ("S:1/5", 1)]);
    assert_eq!(bench.machine.output(&address("O:0/5")), Some(ladder::Value::Bit(true)));
    bench.machine.enter_program();
    assert_eq!(bench.machine.output(&address("O:0/5")), Some(ladder::Value::Bit(false)));
}
