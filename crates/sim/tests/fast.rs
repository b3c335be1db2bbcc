//! Timed and event interrupts and high-speed counters of MicroLogix function files.

mod common;

use common::Bench;
use ladder::Family::{MicroLogix1100, MicroLogix1200};
use sim::Choices;

const COUNT: &str = "ADD N7:0 1 N7:0";

fn counter(data: &[(&str, i64)]) -> Bench {
    let set_up = [
        ("HSC:0/AS", 1),
        ("HSC:0.PFN", 4),
        ("HSC:0.OVF", 1000),
        ("HSC:0.UNF", -1000),
        ("HSC:0.HIP", 900),
        ("HSC:0.LOP", -900),
    ];
    let data: Vec<(&str, i64)> = set_up.iter().chain(data).copied().collect();
    let mut bench =
        Bench::files(MicroLogix1200, &[(2, "XIC I:0/4 OTL HSC:0/SP"), (4, COUNT)], &data, Choices::default());
    bench.scans(1);
    assert_eq!(bench.fault(), None);
    bench
}

#[test]
fn a_counter_rolls_over_at_its_limits() {
    let mut bench = counter(&[("HSC:0.ACC", 1000)]);
    assert!(bench.machine.pulses(0, 1));
    bench.expect(&[("HSC:0.ACC", -1000), ("N7:0", 1)]);
    assert!(bench.machine.pulses(0, -1));
    bench.expect(&[("HSC:0.ACC", 1000), ("N7:0", 2)]);
}

#[test]
fn inputs_of_the_first_counter_count() {
    for (mode, presses, found) in [
        (0, [("I:0/0", 3), ("I:0/1", 1)], 3),
        (2, [("I:0/1", 1), ("I:0/0", 3)], -3),
        (4, [("I:0/0", 3), ("I:0/1", 1)], 2),
        (6, [("I:0/0", 3), ("I:0/1", 1)], 0),
    ] {
        let mut bench = counter(&[("HSC:0.MOD", mode)]);
        for (input, count) in presses {
            bench.edges(input, count);
        }
        bench.expect(&[("HSC:0.ACC", found)]);
    }
}

#[test]
fn limits_act_when_sp_rises() {
    let mut bench = counter(&[("HSC:0.ACC", 500)]);
    bench.set("HSC:0.OVF", 950).scans(1);
    bench.machine.pulses(0, 501);
    bench.expect(&[("HSC:0.ACC", -1000)]);
    bench.set("HSC:0.ACC", 940).set("I:0/4", 1).scans(2);
    bench.machine.pulses(0, 11);
    bench.expect(&[("HSC:0.ACC", -1000)]);
    let mut bench = counter(&[]);
    bench.set("HSC:0.OVF", 400).set("HSC:0.HIP", 500).set("I:0/4", 1).scans(2);
    assert_eq!(bench.fault(), Some(0x37));
    bench.expect(&[("HSC:0/ED", 1)]);
}

#[test]
fn a_counter_drives_its_own_outputs_only() {
    let mut bench = counter(&[("HSC:0.OMB", 3), ("HSC:0.HPO", 0xFFFF), ("HSC:0.ACC", 899)]);
    bench.machine.pulses(0, 1);
    bench.expect(&[("O:0", 3)]);
}

#[test]
fn sti_runs_and_counts_what_waits() {
    let data = [("STI:0.PFN", 4), ("STI:0/AS", 1), ("STI:0.SPM", 30)];
    let mut bench =
        Bench::files(MicroLogix1100, &[(2, "XIC I:0/0 UID 1\nXIC I:0/1 UIE 1"), (4, COUNT)], &data, Choices::default());
    bench.scans(1 + 30).expect(&[("N7:0", 10), ("STI:0/UIX", 0)]);
    bench.set("I:0/0", 1).scans(4).expect(&[("STI:0/UIE", 0), ("STI:0/UIP", 1), ("STI:0/UIL", 0)]);
    bench.scans(12).expect(&[("STI:0/UIL", 1)]);
    let before = bench.get("N7:0");
    bench.set("I:0", 2).scans(1).expect(&[("STI:0/UIP", 0), ("STI:0/UIL", 1)]);
    assert!(bench.get("N7:0") >= before + 2);
}

#[test]
fn events_are_held_until_they_are_lost() {
    let data = [("EII:0.PFN", 4), ("EII:0/UIE", 0)];
    let mut bench = Bench::files(MicroLogix1100, &[(2, "OTE B3:0/0"), (4, COUNT)], &data, Choices::default());
    bench.scans(1);
    bench.machine.event(0);
    bench.machine.event(0);
    bench.expect(&[("EII:0/UIP", 1), ("EII:0/UIL", 0)]);
    bench.machine.event(0);
    bench.expect(&[("EII:0/UIL", 1), ("N7:0", 0)]);
    bench.set("EII:0/UIE", 1).scans(1).expect(&[("N7:0", 2), ("EII:0/UIP", 0), ("EII:0/UIL", 1)]);
}

#[test]
fn an_input_edge_is_an_event() {
    let data = [("EII:0.PFN", 4), ("EII:0/AS", 1)];
    let mut bench = Bench::files(MicroLogix1100, &[(2, "OTE B3:0/0"), (4, COUNT)], &data, Choices::default());
    bench.scans(1).edges("I:0/0", 3).expect(&[("N7:0", 3)]);
}

#[test]
fn nothing_answers_a_message() {
    let mut bench = Bench::new(MicroLogix1100, "XIC I:0/0 MSG MG9:0 N7:0", &[("I:0/0", 1)]);
    bench.scans(1).expect(&[("MG9:0/EN", 1), ("MG9:0/DN", 0), ("MG9:0/ER", 0)]);
    bench.scans(600).expect(&[("MG9:0/ER", 1), ("MG9:0/EN", 1), ("MG9:0/DN", 0)]);
    bench.set("I:0/0", 0).scans(1).expect(&[("MG9:0/EN", 0), ("MG9:0/ER", 1)]);
}
