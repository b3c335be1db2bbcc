//! What the counters do, as functions of values: one call is one processing of the box.

/// The counter instructions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CounterKind {
    /// CNT: up. (help DMD0030)
    Cnt,
    /// CNTDN: down from the preset. (help DMD0031)
    CntDown,
    /// UDC: up and down. (export)
    Udc,
    /// UDCG: up and down, without reset leg and without termination. (help DMD0094)
    Udcg,
}

impl CounterKind {
    /// The kind of a mnemonic in capitals.
    pub fn from_mnemonic(mnemonic: &str) -> Option<CounterKind> {
        Some(match mnemonic {
            "CNT" => CounterKind::Cnt,
            "CNTDN" => CounterKind::CntDown,
            "UDC" => CounterKind::Udc,
            "UDCG" => CounterKind::Udcg,
            _ => return None,
        })
    }

    /// What .Acc is reset to. (help DMD0030, DMD0031; 0 of UDC inferred)
    pub fn reset_value(self, preset: Option<i32>) -> i32 {
        match self {
            CounterKind::CntDown => preset.unwrap_or(0),
            _ => 0,
        }
    }
}

/// A counter structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counter {
    /// .Acc
    pub acc: i32,
    /// .Done
    pub done: bool,
    /// .DnDone
    pub down_done: bool,
    /// .Reset
    pub reset: bool,
    /// .Zero
    pub zero: bool,
}

impl Counter {
    /// The structure from .Acc and its byte of flags.
    pub(crate) fn unpack(acc: i32, flags: u8) -> Counter {
        let flag = |bit: u8| flags >> bit & 1 != 0;
        Counter { acc, done: flag(0), down_done: flag(1), reset: flag(2), zero: flag(3) }
    }

    /// The byte of flags.
    pub(crate) fn flags(self) -> u8 {
        let bits = [self.done, self.down_done, self.reset, self.zero];
        bits.iter().enumerate().fold(0, |byte, (bit, on)| byte | u8::from(*on) << bit)
    }
}

/// What a box sees when it is processed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CounterInput {
    /// The count leg went from OFF to ON: up, for CNTDN down.
    pub count: bool,
    /// The down leg of UDC and UDCG went from OFF to ON.
    pub down: bool,
    /// The reset leg, or an RSTCT at work.
    pub reset: bool,
    /// The preset, for UDC and UDCG that of the up side; `None` where it is not used.
    pub preset: Option<i32>,
    /// The preset of the down side of UDC and UDCG.
    pub down_preset: Option<i32>,
}

/// Processes a counter. Reset has priority over counting; .Done compares, it does not stop the count.
pub fn process(kind: CounterKind, counter: &mut Counter, input: CounterInput) {
    if input.reset {
        counter.acc = kind.reset_value(input.preset);
    } else {
        let (up, down) = if kind == CounterKind::CntDown { (false, input.count) } else { (input.count, input.down) };
        // Edges of both legs in one scan cancel out. (model choice)
        counter.acc = counter.acc.saturating_add(i32::from(up) - i32::from(down));
    }
    counter.reset = input.reset;
    counter.zero = counter.acc == 0;
    counter.done = match kind {
        CounterKind::CntDown => counter.acc <= 0,
        _ => input.preset.is_some_and(|preset| counter.acc >= preset),
    };
    counter.down_done = input.down_preset.is_some_and(|preset| counter.acc <= preset);
}

#[cfg(test)]
mod tests {
    use super::*;

    const UP: CounterInput =
        CounterInput { count: true, down: false, reset: false, preset: Some(2), down_preset: None };

    #[test]
    fn cnt_counts_past_its_preset_and_reset_wins() {
        let mut counter = Counter::default();
        let mut seen = Vec::new();
        for input in [UP, UP, UP, CounterInput { reset: true, ..UP }] {
            process(CounterKind::Cnt, &mut counter, input);
            seen.push((counter.acc, counter.done, counter.reset, counter.zero));
        }
        let expected =
            [(1, false, false, false), (2, true, false, false), (3, true, false, false), (0, false, true, true)];
        assert_eq!(seen, expected);
    }

    #[test]
    fn cntdn_goes_down_from_its_preset_and_below_zero() {
        let mut counter = Counter::default();
        process(CounterKind::CntDown, &mut counter, CounterInput { reset: true, count: false, ..UP });
        assert_eq!((counter.acc, counter.done), (2, false));
        for _ in 0..3 {
            process(CounterKind::CntDown, &mut counter, UP);
        }
        assert_eq!((counter.acc, counter.done), (-1, true));
    }

    #[test]
    fn udc_compares_both_sides() {
        let mut counter = Counter::default();
        let both = CounterInput { down: true, down_preset: Some(0), ..UP };
        process(CounterKind::Udc, &mut counter, both);
        assert_eq!((counter.acc, counter.done, counter.down_done), (0, false, true));
        process(CounterKind::Udc, &mut counter, CounterInput { down: false, ..both });
        process(CounterKind::Udc, &mut counter, CounterInput { down: false, ..both });
        assert_eq!((counter.acc, counter.done, counter.down_done), (2, true, false));
        counter.acc = i32::MAX;
        process(CounterKind::Udc, &mut counter, UP);
        assert_eq!(counter.acc, i32::MAX);
    }
}
