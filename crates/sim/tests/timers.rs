//! Timers and counters, scan by scan.

mod common;

use common::Bench;
use ladder::Family::{MicroLogix1000, MicroLogix1100, Slc503};

const TON: &str = "XIC B3:0/0 TON T4:0 0.01 100 0";
const TOF: &str = "XIC B3:0/1 TOF T4:2 0.01 120 0";
const RTO: &str = "XIC B3:0/2 RTO T4:3 0.01 100 0";

#[test]
fn ton_counts_stops_and_clears() {
    for family in [Slc503, MicroLogix1000, MicroLogix1100] {
        let mut bench = Bench::new(family, TON, &[]);
        bench.set("B3:0/0", 1).scans(1).expect(&[("T4:0/EN", 1), ("T4:0/TT", 1), ("T4:0/DN", 0), ("T4:0.ACC", 0)]);
        bench.scans(99).expect(&[("T4:0/TT", 1), ("T4:0/DN", 0), ("T4:0.ACC", 99)]);
        bench.scans(1).expect(&[("T4:0/EN", 1), ("T4:0/TT", 0), ("T4:0/DN", 1), ("T4:0.ACC", 100)]);
        bench.scans(5).expect(&[("T4:0.ACC", 100)]);
        bench.set("B3:0/0", 0).scans(1);
        bench.expect(&[("T4:0/EN", 0), ("T4:0/TT", 0), ("T4:0/DN", 0), ("T4:0.ACC", 0), ("T4:0.PRE", 100)]);
    }
}

#[test]
fn tof_holds_and_times_off() {
    let mut bench = Bench::new(Slc503, TOF, &[]);
    bench.set("B3:0/1", 1).scans(1).expect(&[("T4:2/EN", 1), ("T4:2/TT", 0), ("T4:2/DN", 1), ("T4:2.ACC", 0)]);
    bench.set("B3:0/1", 0).scans(120).expect(&[("T4:2/EN", 0), ("T4:2/TT", 1), ("T4:2/DN", 1), ("T4:2.ACC", 119)]);
    bench.scans(1).expect(&[("T4:2/TT", 0), ("T4:2/DN", 0), ("T4:2.ACC", 120)]);
    let mut bench = Bench::new(Slc503, TOF, &[]);
    bench.set("B3:0/1", 1).scans(1).set("B3:0/1", 0).scans(61).expect(&[("T4:2.ACC", 60)]);
    bench.machine.enter_program();
    bench.machine.enter_run();
    bench.scans(1).expect(&[("T4:2/EN", 0), ("T4:2/TT", 0), ("T4:2/DN", 0), ("T4:2.ACC", 120)]);
}

#[test]
fn rto_keeps_its_time() {
    let mut bench = Bench::new(Slc503, &format!("{RTO}\nXIC B3:0/3 RES T4:3"), &[]);
    bench.set("B3:0/2", 1).scans(41).expect(&[("T4:3.ACC", 40)]);
    bench.set("B3:0/2", 0).scans(100).expect(&[("T4:3/EN", 0), ("T4:3/TT", 0), ("T4:3/DN", 0), ("T4:3.ACC", 40)]);
    bench.set("B3:0/2", 1).scans(61).expect(&[("T4:3/EN", 1), ("T4:3/DN", 1), ("T4:3.ACC", 100)]);
    bench.set("B3:0/2", 0).scans(1).expect(&[("T4:3/DN", 1)]);
    bench.set("B3:0/3", 1).scans(1).expect(&[("T4:3/DN", 0), ("T4:3.ACC", 0), ("T4:3.PRE", 100)]);
}

#[test]
fn time_below_a_tick_is_not_lost() {
    let mut bench = Bench::new(Slc503, TON, &[]);
    bench.dt = std::time::Duration::from_micros(3_300);
    bench.set("B3:0/0", 1).scans(1 + 100).expect(&[("T4:0.ACC", 33)]);
}

#[test]
fn negative_timer_faults() {
    let mut bench = Bench::new(Slc503, "XIC B3:0/0 TON T4:4 1.0 -1 0", &[]);
    bench.scans(1).set("B3:0/0", 1).scans(1);
    assert_eq!(bench.fault(), Some(0x34));
    bench.expect(&[("S:6", 0x34), ("S:1/13", 1)]);
}

#[test]
fn counters_wrap_and_share() {
    let mut bench = Bench::new(
        Slc503,
        "XIC B3:0/0 CTU C5:1 100 32767\nXIC B3:0/1 CTD C5:1 100 0",
        &[("C5:1.PRE", 100), ("C5:1.ACC", 32767), ("C5:1/DN", 1)],
    );
    bench.edges("B3:0/0", 1).expect(&[("C5:1.ACC", -32768), ("C5:1/OV", 1), ("C5:1/DN", 0)]);
    bench.edges("B3:0/1", 1).expect(&[("C5:1.ACC", 32767), ("C5:1/OV", 0), ("C5:1/DN", 1), ("C5:1/UN", 0)]);
}

#[test]
fn a_rung_true_at_the_first_scan_does_not_count() {
    let mut bench = Bench::new(Slc503, "XIC B3:0/0 CTU C5:0 3 0", &[("C5:0.ACC", 5), ("B3:0/0", 1)]);
    bench.scans(1).expect(&[("C5:0.ACC", 5), ("C5:0/CU", 1), ("C5:0/DN", 1)]);
    bench.edges("B3:0/0", 1).scans(3).expect(&[("C5:0.ACC", 6)]);
}
