//! The tables of the manuals, and time in any slices.

use proptest::prelude::*;

use super::*;
use crate::exec::Lineage;

const CENTISECOND: u64 = 10_000_000;

type Step = fn(bool, Timer, Time, Rules) -> Result<Timer, NegativeTimer>;

fn rules() -> Rules {
    Rules::new(Lineage::S2)
}

fn scan(step: Step, rung: bool, timer: Timer, elapsed: u64) -> Timer {
    let time = Time { base: CENTISECOND, elapsed };
    step(rung, timer, time, rules()).unwrap_or_else(|_| panic!("{timer:?}"))
}

fn scans(step: Step, rung: bool, mut timer: Timer, count: usize) -> Timer {
    for _ in 0..count {
        timer = scan(step, rung, timer, CENTISECOND);
    }
    timer
}

fn timer(preset: i16, accumulated: i16, bits: u16) -> Timer {
    Timer { control: bits, preset, accumulated, part: 0 }
}

/// EN, TT, DN as digits, and ACC.
fn state(timer: Timer) -> (u16, i16) {
    let digit = |mask: u16, weight: u16| if timer.has(mask) { weight } else { 0 };
    (digit(ENABLE, 100) + digit(TIMING, 10) + digit(DONE, 1), timer.accumulated)
}

#[test]
fn on_delay_runs_through_its_table() {
    let started = scans(on_delay, true, timer(100, 0, 0), 1);
    assert_eq!(state(started), (110, 0), "the scan that starts timing counts no time");
    let before = scans(on_delay, true, started, 99);
    assert_eq!(state(before), (110, 99));
    let done = scans(on_delay, true, before, 1);
    assert_eq!(state(done), (101, 100));
    assert_eq!(state(scans(on_delay, true, done, 50)), (101, 100));
    assert_eq!(state(scans(on_delay, false, done, 1)), (0, 0));
    assert_eq!(state(scan(on_delay, false, timer(100, 50, ENABLE | TIMING), CENTISECOND)), (0, 0));
}

#[test]
fn on_delay_edges() {
    assert_eq!(state(scans(on_delay, true, timer(0, 0, 0), 1)), (101, 0), "PRE 0 never shows TT");
    let lowered = Timer { preset: 30, ..timer(100, 50, ENABLE | TIMING) };
    assert_eq!(state(scans(on_delay, true, lowered, 1)), (101, 50), "done without counting on");
    let raised = timer(200, 100, ENABLE | DONE);
    assert_eq!(state(scans(on_delay, true, raised, 5)), (101, 100), "DN lasts until the rung goes false");
    let follows = rules().with(Choice::DoneFollowsPreset);
    let time = Time { base: CENTISECOND, elapsed: CENTISECOND };
    assert_eq!(on_delay(true, raised, time, follows).map(state), Ok((110, 101)));
    let preloaded = timer(100, 57, 0);
    assert_eq!(state(scans(on_delay, true, preloaded, 1)), (110, 0));
    assert_eq!(state(scan(on_delay, true, timer(100, 0, ENABLE | TIMING), u64::MAX)), (101, 100));
    let longest = timer(32767, 32766, ENABLE | TIMING);
    assert_eq!(state(scan(on_delay, true, longest, CENTISECOND * 99)), (101, 32767));
    let base = Time { base: 0, elapsed: 1 };
    assert!(on_delay(true, timer(5, 1, ENABLE), base, rules()).is_ok());
}

#[test]
fn overshoot_is_a_choice() {
    let timing = timer(100, 95, ENABLE | TIMING);
    let time = Time { base: CENTISECOND, elapsed: 9 * CENTISECOND };
    assert_eq!(on_delay(true, timing, time, rules()).map(state), Ok((101, 100)));
    assert_eq!(on_delay(true, timing, time, rules().with(Choice::AccOvershoots)).map(state), Ok((101, 104)));
    let gap = Time { base: CENTISECOND, elapsed: WRAP + CENTISECOND };
    assert_eq!(on_delay(true, timing, gap, rules().with(Choice::TimerGapWraps)).map(state), Ok((110, 96)));
}

#[test]
fn off_delay_runs_through_its_table() {
    let on = scans(off_delay, true, timer(120, 7, 0), 1);
    assert_eq!(state(on), (101, 0));
    let started = scans(off_delay, false, on, 1);
    assert_eq!(state(started), (11, 0));
    let timing = scans(off_delay, false, started, 119);
    assert_eq!(state(timing), (11, 119));
    assert_eq!(state(scans(off_delay, false, timing, 1)), (0, 120));
    assert_eq!(state(scans(off_delay, false, timing, 9)), (0, 120));
    assert_eq!(state(scans(off_delay, true, timer(120, 60, TIMING | DONE), 1)), (101, 0));
    let without_preset = scans(off_delay, false, scans(off_delay, true, timer(0, 0, 0), 1), 1);
    assert_eq!(state(without_preset), (0, 0), "PRE 0 drops DN in the first false scan");
    let entering = off_delay_entering_run(timer(120, 60, TIMING | DONE));
    assert_eq!(state(entering), (0, 120));
    let reset = timer(120, 60, TIMING | DONE).reset();
    assert_eq!(state(scans(off_delay, false, reset, 5)), (0, 0), "after RES it does not start again");
}

#[test]
fn retentive_keeps_its_time() {
    let timing = timer(100, 40, ENABLE | TIMING);
    let paused = scans(retentive, false, timing, 100);
    assert_eq!(state(paused), (0, 40));
    let resumed = scans(retentive, true, paused, 61);
    assert_eq!(state(resumed), (101, 100));
    let held = scans(retentive, false, resumed, 3);
    assert_eq!(state(held), (1, 100), "DN lasts until RES");
    assert_eq!(state(scans(retentive, true, held, 1)), (101, 100));
    let reset = held.reset();
    assert_eq!((state(reset), reset.preset), ((0, 0), 100));
    assert_eq!(state(scans(retentive, true, reset, 2)), (110, 1));
}

#[test]
fn retentive_keeps_the_part_of_a_tick() {
    let timing = scan(retentive, true, timer(100, 0, ENABLE | TIMING), CENTISECOND * 3 / 2);
    let paused = scan(retentive, false, timing, CENTISECOND);
    let resumed = scan(retentive, true, scan(retentive, true, paused, 0), CENTISECOND / 2);
    assert_eq!(resumed.accumulated, 2);
    let time = Time { base: CENTISECOND, elapsed: 0 };
    let dropped = retentive(false, timing, time, rules().with(Choice::RtoDropsPartTick));
    assert_eq!(dropped.map(|timer| timer.part), Ok(0));
}

#[test]
fn negative_words_are_an_error() {
    let time = Time { base: CENTISECOND, elapsed: CENTISECOND };
    for (preset, accumulated) in [(-1, 0), (10, -5)] {
        let bad = timer(preset, accumulated, 0);
        for step in [on_delay as Step, off_delay, retentive] {
            assert_eq!(step(true, bad, time, rules()), Err(NegativeTimer));
            assert!(step(false, bad, time, rules()).is_ok());
            let always = rules().with(Choice::NegativeTimerAlways);
            assert_eq!(step(false, bad, time, always), Err(NegativeTimer));
        }
        let timing = Timer { control: TIMING | DONE, ..bad };
        assert_eq!(off_delay(false, timing, time, rules()), Err(NegativeTimer));
    }
}

#[test]
fn other_bits_of_the_control_word_stay() {
    assert_eq!(scans(on_delay, true, timer(10, 0, 0x0203), 1).control, ENABLE | TIMING | 0x0203);
    assert_eq!(scans(off_delay, true, timer(10, 0, 0x0203), 1).control, ENABLE | DONE | 0x0203);
    assert_eq!(timer(10, 0, 0xFFFF).reset().control, 0x1FFF);
}

proptest! {
    #[test]
    fn time_counts_the_same_in_any_slices(slices in prop::collection::vec(0_u64..40_000_000, 1..60)) {
        let start = timer(32767, 0, ENABLE | TIMING);
        let sliced = slices.iter().fold(start, |timer, slice| scan(on_delay, true, timer, *slice));
        let whole = scan(on_delay, true, start, slices.iter().sum());
        prop_assert_eq!(sliced, whole);
    }

    #[test]
    fn any_words_are_survived(control: u16, preset: i16, accumulated: i16, part: u64, base: u64, elapsed: u64, rung: bool) {
        let timer = Timer { control, preset, accumulated, part };
        for step in [on_delay as Step, off_delay, retentive] {
            if let Ok(next) = step(rung, timer, Time { base, elapsed }, rules()) {
                prop_assert!(next.accumulated >= 0 || accumulated < 0);
                prop_assert_eq!(next.preset, preset);
            }
        }
    }
}
