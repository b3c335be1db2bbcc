//! Trends: how chosen values went, scan by scan, within a bound.

use std::collections::VecDeque;

use ladder::Value;

/// Points kept of one trace; a point is stored where the value changes.
pub const POINTS: usize = 20_000;
/// Traces at once.
pub const TRACES: usize = 32;

/// One value over time.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Its address.
    pub address: String,
    points: VecDeque<Point>,
    /// Points that were forgotten or gone back behind.
    first: u64,
}

/// A value from a scan on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Scans so far.
    pub scan: u64,
    /// Simulated time in nanoseconds.
    pub time: u64,
    /// The value; bits are 0 and 1.
    pub value: f64,
}

impl Trace {
    /// A trace without points.
    pub fn new(address: String) -> Trace {
        Trace { address, points: VecDeque::new(), first: 0 }
    }

    /// Notes the value after a scan.
    pub fn note(&mut self, scan: u64, time: u64, value: f64) {
        if self.points.back().is_some_and(|last| last.value.to_bits() == value.to_bits()) {
            return;
        }
        if self.points.len() == POINTS {
            self.points.pop_front();
            self.first += 1;
        }
        self.points.push_back(Point { scan, time, value });
    }

    /// Forgets what came after a scan.
    pub fn back_to(&mut self, scan: u64) {
        while self.points.back().is_some_and(|last| last.scan > scan) {
            self.points.pop_back();
        }
    }

    /// The points from scan `scan` on, and the one before, which holds until then.
    pub fn since(&self, scan: u64) -> impl Iterator<Item = &Point> {
        let from = self.points.partition_point(|point| point.scan < scan).saturating_sub(1);
        self.points.range(from..)
    }

    /// Points that were forgotten because there were too many.
    pub fn forgotten(&self) -> u64 {
        self.first
    }
}

/// A value as a number to draw; `None` for what is no number.
pub fn number(value: &Value) -> Option<f64> {
    Some(match value {
        Value::Bit(on) => f64::from(u8::from(*on)),
        Value::Word(word) => f64::from(*word),
        Value::Long(long) => f64::from(*long),
        Value::Float(number) => f64::from(*number),
        _ => return None,
    })
}
