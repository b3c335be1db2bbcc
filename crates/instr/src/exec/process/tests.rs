//! Printed numbers of PID, its errors, and loops that must settle.

use proptest::prelude::*;

use super::*;

/// A loop with this gain in tenths, updating every 100 ms.
fn block(flags: u16, setpoint: i16, gain: i16) -> [u16; WORDS] {
    let mut block = [0; WORDS];
    block[word::FLAGS] = flags;
    block[word::SETPOINT] = setpoint as u16;
    block[word::GAIN] = gain as u16;
    block[word::UPDATE] = 10;
    block
}

fn run(block: &mut [u16; WORDS], process: i16, state: &mut Loop) -> Option<i16> {
    let inputs = Inputs { process, control: 0, elapsed: 100_000_000 };
    pid(true, block, inputs, state, Rules::new(Lineage::Mx)).unwrap_or_else(|error| panic!("{error:?}"))
}

fn error(block: &mut [u16; WORDS], lineage: Lineage) -> u16 {
    let inputs = Inputs { process: 0, control: 0, elapsed: 0 };
    match pid(true, block, inputs, &mut Loop::default(), Rules::new(lineage)) {
        Err(PidError(code)) => {
            assert_eq!(block[word::ERROR] >> 8, code.code());
            code.code()
        }
        Ok(_) => 0,
    }
}

#[test]
fn the_error_has_the_sign_of_its_mode() {
    let mut reverse = block(0, 100, 10);
    run(&mut reverse, 120, &mut Loop::default());
    assert_eq!(reverse[word::SCALED_ERROR] as i16, -20);
    let mut forward = block(flag::FORWARD, 100, 10);
    assert_eq!(run(&mut forward, 120, &mut Loop::default()), Some(20), "CV rises with PV");
    assert_eq!(forward[word::SCALED_ERROR] as i16, 20);
}

#[test]
fn gain_range() {
    let mut tenths = block(0, 1000, 25);
    assert_eq!(run(&mut tenths, 0, &mut Loop::default()), Some(2500));
    let mut hundredths = block(flag::FINE, 1000, 25);
    assert_eq!(run(&mut hundredths, 0, &mut Loop::default()), Some(250));
    let inputs = Inputs { process: 0, control: 0, elapsed: 0 };
    let old = pid(true, &mut hundredths, inputs, &mut Loop::default(), Rules::new(Lineage::S2));
    assert_eq!(old, Ok(Some(2500)), "RG came with SLC 5/03");
}

#[test]
fn zero_crossing_deadband() {
    let (mut b, mut state) = (block(0, 100, 10), Loop::default());
    b[word::DEADBAND] = 10;
    let outputs = [80, 95, 99, 101, 99].map(|process| run(&mut b, process, &mut state));
    assert_eq!(outputs, [Some(20), Some(5), Some(1), Some(0), Some(0)], "active from 101");
    assert_ne!(b[word::FLAGS] & flag::IN_DEADBAND, 0);
    assert_eq!(run(&mut b, 80, &mut state), Some(20));
    assert_eq!(b[word::FLAGS] & flag::IN_DEADBAND, 0);
    assert_eq!(run(&mut b, 95, &mut state), Some(5), "it has to cross again");
}

#[test]
fn scaling_to_engineering_units() {
    let mut b = block(0, 50, 10);
    (b[word::SCALED_MIN], b[word::SCALED_MAX]) = (0, 100);
    let output = run(&mut b, 4096, &mut Loop::default());
    assert_eq!((b[word::SCALED_PROCESS], b[word::SCALED_ERROR]), (25, 25));
    assert_eq!(output, Some(4096), "half of 16383 minus 4096, rounded");
    b[word::FLAGS] |= flag::UNSCALED;
    run(&mut b, 40, &mut Loop::default());
    assert_eq!(b[word::SCALED_PROCESS], 40);
}

#[test]
fn ranges_of_process_and_setpoint() {
    let mut b = block(0, 100, 10);
    let mut state = Loop::default();
    run(&mut b, -5, &mut state);
    assert_ne!(b[word::FLAGS] & flag::BAD_PROCESS, 0);
    assert_eq!(b[word::SCALED_PROCESS], 0);
    run(&mut b, 16384, &mut state);
    assert_eq!(b[word::SCALED_PROCESS], 16383);
    b[word::SETPOINT] = -1_i16 as u16;
    assert_eq!(run(&mut b, 0, &mut state), Some(100), "a running loop keeps the old set point");
    assert_ne!(b[word::FLAGS] & flag::BAD_SETPOINT, 0);
    assert_eq!(error(&mut b, Lineage::Mx), 0x31);
}

#[test]
fn integral_repeats_the_proportional_part_in_its_time() {
    // Reset 1.0 minutes per repeat, 100 ms per update: 600 updates repeat Kc × E once.
    let (mut b, mut state) = (block(0, 1000, 10), Loop::default());
    b[word::RESET] = 10;
    let mut output = None;
    for _ in 0..600 {
        output = run(&mut b, 0, &mut state);
    }
    let output = output.unwrap_or(0);
    assert!((1998..=2002).contains(&output), "{output}");
    let none = pid(false, &mut b, Inputs { process: 0, control: 0, elapsed: 0 }, &mut state, Rules::new(Lineage::Mx));
    assert_eq!((none, integral(&b), b[word::FLAGS] & flag::ENABLE), (Ok(None), 0.0, 0));
}

#[test]
fn rate_opposes_a_moving_process() {
    for (flags, expected_lower) in [(0, true), (flag::FORWARD, false)] {
        let (mut b, mut state) = (block(flags, 8000, 10), Loop::default());
        (b[word::RATE], b[word::BIAS]) = (100, 8000);
        run(&mut b, 8000, &mut state);
        let output = run(&mut b, 8001, &mut state).unwrap_or(0);
        let proportional = if expected_lower { 7999 } else { 8001 };
        assert_eq!(output < proportional, expected_lower, "{output}");
    }
}

#[test]
fn limits_alarms_and_windup() {
    let (mut b, mut state) = (block(flag::LIMITED, 16000, 100), Loop::default());
    (b[word::OUTPUT_MIN], b[word::OUTPUT_MAX], b[word::RESET]) = (10, 90, 1);
    for _ in 0..1000 {
        assert_eq!(run(&mut b, 0, &mut state), Some(14745), "90 %");
    }
    assert_eq!(integral(&b), 0.0, "no windup");
    assert_ne!(b[word::FLAGS] & flag::UPPER_ALARM, 0);
    assert_eq!(b[word::OUTPUT], 90);
    let low = run(&mut b, 16383, &mut state);
    assert_eq!((low, b[word::OUTPUT]), (Some(1638), 10));
    assert_eq!(b[word::FLAGS] & (flag::UPPER_ALARM | flag::LOWER_ALARM), flag::LOWER_ALARM);
}

/// Two loops of a MicroLogix 1400 saved while running: OL off, 0 and 100 in words 12 and 11, a sum far above
/// the range, UL not set.
#[test]
fn an_output_at_full_scale_does_not_exceed_a_limit_of_100_percent() {
    for (limit, alarm) in [(100, 0), (99, flag::UPPER_ALARM)] {
        let (mut b, mut state) = (block(0, 16000, 240), Loop::default());
        (b[word::OUTPUT_MIN], b[word::OUTPUT_MAX]) = (0, limit);
        assert_eq!(run(&mut b, 0, &mut state), Some(FULL_SCALE));
        assert_eq!(b[word::FLAGS] & flag::UPPER_ALARM, alarm, "{limit} %");
    }
}

#[test]
fn manual_mode_hands_over_without_a_bump() {
    let (mut b, mut state) = (block(flag::MANUAL, 1000, 10), Loop::default());
    b[word::RESET] = 100;
    let inputs = Inputs { process: 900, control: 5000, elapsed: 100_000_000 };
    let output = pid(true, &mut b, inputs, &mut state, Rules::new(Lineage::S3));
    assert_eq!((output, b[word::OUTPUT]), (Ok(None), 31));
    b[word::FLAGS] &= !flag::MANUAL;
    assert_eq!(run(&mut b, 900, &mut state), Some(5000));
}

#[test]
fn timed_mode_waits() {
    let (mut b, mut state) = (block(flag::TIMED, 1000, 10), Loop::default());
    let mut at = |elapsed: u64| {
        let inputs = Inputs { process: 0, control: 0, elapsed };
        let output = pid(true, &mut b, inputs, &mut state, Rules::new(Lineage::S3));
        (output.unwrap_or(None).is_some(), b[word::FLAGS] & flag::DONE != 0, b[word::FLAGS] & flag::TOO_FAST != 0)
    };
    assert_eq!(at(0), (true, true, false));
    assert_eq!(at(60_000_000), (false, false, false));
    assert_eq!(at(60_000_000), (true, true, false));
    assert_eq!(at(70_000_000), (false, false, false), "20 ms were left over");
    assert_eq!(at(10_000_000), (true, true, false));
    assert_eq!(at(500_000_000), (true, true, true));
}

#[test]
fn parameters_are_checked() {
    let with = |index: usize, value: i16| {
        let mut b = block(flag::LIMITED, 100, 10);
        (b[word::OUTPUT_MAX], b[index]) = (100, value as u16);
        b
    };
    for (index, value, code) in [
        (word::UPDATE, 0, 0x11),
        (word::UPDATE, 1025, 0x11),
        (word::GAIN, -1, 0x12),
        (word::RESET, -1, 0x13),
        (word::RATE, -1, 0x14),
        (word::BIAS, 16384, 0x15),
        (word::SCALED_MIN, 1, 0x23),
        (word::SETPOINT, 16384, 0x31),
        (word::DEADBAND, -1, 0x41),
        (word::OUTPUT_MAX, 101, 0x51),
        (word::OUTPUT_MIN, -1, 0x52),
    ] {
        assert_eq!(error(&mut with(index, value), Lineage::Mx), code, "word {index} = {value}");
    }
    let mut crossed = with(word::OUTPUT_MIN, 60);
    crossed[word::OUTPUT_MAX] = 50;
    assert_eq!(error(&mut crossed, Lineage::Mx), 0x53);
    for (index, value, code) in [
        (word::UPDATE, 256, 0x11),
        (word::GAIN, 0, 0x12),
        (word::GAIN, 256, 0x12),
        (word::RESET, 256, 0x13),
        (word::RATE, 256, 0x14),
        (word::SCALED_MAX, 16384, 0x21),
        (word::SCALED_MIN, -16384, 0x22),
    ] {
        assert_eq!(error(&mut with(index, value), Lineage::S2), code, "word {index} = {value}");
        assert_ne!(error(&mut with(index, value), Lineage::S3), code, "word {index} = {value}");
    }
}

#[test]
fn a_first_order_process_settles() {
    let (mut b, mut state) = (block(flag::FINE, 8000, 200), Loop::default());
    (b[word::RESET], b[word::RATE]) = (5, 1);
    let mut process = 0.0_f64;
    for _ in 0..2000 {
        let control = run(&mut b, process as i16, &mut state).unwrap_or(0);
        process += (f64::from(control) - process) * 0.05;
    }
    assert!((process - 8000.0).abs() < 5.0, "{process}");
}

proptest! {
    #[test]
    fn any_block_is_survived(
        words in prop::collection::vec(any::<u16>(), 0..30),
        process: i16, control: i16, elapsed: u64, lineage in 0_usize..5, runs in 1_usize..4,
    ) {
        let lineage = [Lineage::S1, Lineage::S2, Lineage::S3, Lineage::M10, Lineage::Mx][lineage];
        let (mut words, mut state) = (words, Loop::default());
        for rung in [true, true, false].into_iter().cycle().take(runs) {
            if let Some(flags) = words.get_mut(word::UPDATE) {
                *flags %= 1100;
            }
            let inputs = Inputs { process, control, elapsed };
            if let Ok(Some(output)) = pid(rung, &mut words, inputs, &mut state, Rules::new(lineage)) {
                prop_assert!((0..=FULL_SCALE).contains(&output));
            }
        }
    }

    #[test]
    fn good_blocks_stay_within_the_range(
        setpoint in 0_i16..=FULL_SCALE, gain: u8, reset: u8, rate: u8,
        processes in prop::collection::vec(any::<i16>(), 1..40), flags in 0_u16..256,
    ) {
        let (mut b, mut state) = (block(flags & !flag::TIMED, setpoint, i16::from(gain).max(1)), Loop::default());
        (b[word::RESET], b[word::RATE], b[word::OUTPUT_MAX]) = (reset.into(), rate.into(), 100);
        for process in processes {
            let output = run(&mut b, process, &mut state);
            prop_assert!(output.is_none_or(|output| (0..=FULL_SCALE).contains(&output)));
            prop_assert!(state.rate.is_finite());
        }
    }
}
