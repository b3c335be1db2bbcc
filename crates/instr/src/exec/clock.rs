//! RHC and TDF: the free running clock of 10 µs ticks.

use super::number::{Number, Width, fit_float};
use super::rules::MathMode;

/// The clock counts 20 bits, 10.48575 s (printed).
pub const CLOCK_MASK: u32 = 0xF_FFFF;

/// RHC: the clock as a float, or its low 16 bits (printed). `ticks` of 10 µs since power-up. A long word
/// takes all 20 bits (inferred).
pub const fn rhc(ticks: u64, to: Width) -> Number {
    let clock = ticks as u32 & CLOCK_MASK;
    match to {
        Width::Word => Number::Word(clock as i16),
        Width::Long => Number::Long(clock as i32),
        Width::Float => Number::Float(clock as f32),
    }
}

/// TDF: the ticks from start to stop, over the wrap of the clock (printed).
///
/// Between integers the difference of 16 bits is positive and valid up to 327.67 ms (printed): 15 bits of
/// it. Where a float takes part it is one of 20 bits.
pub fn tdf(start: Number, stop: Number, to: Width, mode: MathMode) -> Number {
    match (start.integer(), stop.integer()) {
        (Some(start), Some(stop)) if to != Width::Float => {
            let ticks = stop.wrapping_sub(start) as u64;
            match to {
                Width::Word => Number::Word((ticks & 0x7FFF) as i16),
                _ => Number::Long((ticks & u64::from(CLOCK_MASK)) as i32),
            }
        }
        _ => {
            let ticks = |value: Number| value.float() as i64;
            let difference = ticks(stop).wrapping_sub(ticks(start)) as u64 & u64::from(CLOCK_MASK);
            fit_float(difference as f32, to, mode).0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exec::{Lineage, Rules};

    #[test]
    fn clock_values() {
        assert_eq!(rhc(0x12_3456, Width::Word), Number::Word(0x3456));
        assert_eq!(rhc(0x12_3456, Width::Float), Number::Float(144_470.0));
        assert_eq!(rhc(u64::MAX, Width::Long), Number::Long(0xF_FFFF));
    }

    #[test]
    fn differences_wrap() {
        let mode = Rules::new(Lineage::S3).math(0);
        let float = |value: u32| Number::Float(value as f32);
        assert_eq!(tdf(float(0xF_FFF0), float(0x10), Width::Float, mode), Number::Float(32.0));
        let word = |value: u16| Number::Word(value as i16);
        assert_eq!(tdf(word(0xFFF0), word(0x10), Width::Word, mode), Number::Word(32));
        assert_eq!(tdf(word(0x7FF0), word(0x8010), Width::Word, mode), Number::Word(32));
        assert_eq!(tdf(word(100), word(32867), Width::Word, mode), Number::Word(32767));
        assert_eq!(tdf(float(0), float(1_048_575), Width::Word, mode), Number::Word(32767));
        let _ = tdf(Number::Float(f32::NAN), Number::Float(f32::NEG_INFINITY), Width::Long, mode);
    }
}
