//! System bits and words, and the clock of the controller.

use super::run::Core;
use crate::memory::{Kind, Map, Num, Place};

/// Seconds of a day.
const DAY: i64 = 86_400;

/// The year the clock starts from.
const EPOCH_YEAR: i64 = 2000;

/// First bits of system memory.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct System {
    bits: u32,
    words: u32,
    pub(crate) date: u32,
}

impl System {
    pub(crate) fn of(map: &Map) -> System {
        let start = |name: &str| map.block(name).map_or(0, |block| block.start);
        System { bits: start("ST"), words: start("DST"), date: start("SDT") }
    }
}

impl Core<'_> {
    /// Sets what the system shows at the begin of a scan: first scan, square waves, scan counter, clock.
    pub(crate) fn show_system(&mut self, dt: u64) {
        let System { bits, words, date } = self.p.system;
        let now = self.s.now;
        let half = |period: u64| now / (period / 2) % 2 == 1;
        let first = self.s.first;
        let data = &mut self.s.data;
        for (number, on) in [
            (0, first),
            (1, true),
            (2, false),
            (3, half(60_000_000_000)),
            (4, half(1_000_000_000)),
            (5, half(100_000_000)),
        ] {
            data.set_bit(bits + number, on);
        }
        data.set_dword(words, (self.s.scans + 1) as i32);
        data.set_dword(words + 32, i32::try_from(dt / 1000).unwrap_or(i32::MAX));
        data.set_dword(words + 320, 3);
        let second = self.s.clock + (now / 1_000_000_000) as i64;
        if second != self.s.shown_second {
            self.s.shown_second = second;
            self.show_date(date, second);
        }
    }

    fn show_date(&mut self, bit: u32, second: i64) {
        let (days, time) = (second.div_euclid(DAY), second.rem_euclid(DAY));
        let (year, month, day) = civil(days);
        // 1 January 2000 was a Saturday; Sunday is taken as 0.
        let weekday = (days + 6).rem_euclid(7);
        let data = &mut self.s.data;
        let choices = self.p.choices;
        data.store(Place { kind: Kind::U16, bit, read_only: false }, Num::Int(year), choices);
        let rest = [month, day, weekday, time / 3600, time / 60 % 60, time % 60];
        for (index, value) in rest.into_iter().enumerate() {
            data.set_byte(bit + 16 + 8 * index as u32, value as u8);
        }
    }

    /// Sets the clock to what stands in SDT0 after somebody wrote there.
    pub(crate) fn take_date(&mut self) {
        let bit = self.p.system.date;
        let data = &self.s.data;
        let Num::Int(year) = data.number(Place { kind: Kind::U16, bit, read_only: false }) else { return };
        let [month, day, _, hour, minute, second] =
            [0, 1, 2, 3, 4, 5].map(|index| i64::from(data.byte(bit + 16 + 8 * index)));
        let seconds = days(year, month, day) * DAY + hour * 3600 + minute * 60 + second;
        self.s.clock = seconds - (self.s.now / 1_000_000_000) as i64;
        self.s.shown_second = i64::MIN;
    }
}

fn leap(year: i64) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

fn month_days(year: i64, month: i64) -> i64 {
    match month {
        2 if leap(year) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Year, month and day so many days behind 1 January 2000. Years stay below 10000.
fn civil(mut days: i64) -> (i64, i64, i64) {
    let mut year = EPOCH_YEAR;
    while days < 0 && year > 1 {
        year -= 1;
        days += if leap(year) { 366 } else { 365 };
    }
    while days >= if leap(year) { 366 } else { 365 } && year < 9999 {
        days -= if leap(year) { 366 } else { 365 };
        year += 1;
    }
    let mut month = 1;
    while month < 12 && days >= month_days(year, month) {
        days -= month_days(year, month);
        month += 1;
    }
    (year, month, days + 1)
}

/// Days from 1 January 2000; what lies outside the calendar is brought into it.
fn days(year: i64, month: i64, day: i64) -> i64 {
    let (year, month) = (year.clamp(1, 9999), month.clamp(1, 12));
    let years = if year >= EPOCH_YEAR {
        (EPOCH_YEAR..year).map(|year| if leap(year) { 366 } else { 365 }).sum::<i64>()
    } else {
        -(year..EPOCH_YEAR).map(|year| if leap(year) { 366 } else { 365 }).sum::<i64>()
    };
    years + (1..month).map(|month| month_days(year, month)).sum::<i64>() + day.clamp(1, month_days(year, month)) - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_and_dates_agree() {
        for day in [-800, -1, 0, 59, 60, 365, 366, 9_000, 100_000] {
            let (year, month, date) = civil(day);
            assert_eq!(days(year, month, date), day, "{year}-{month}-{date}");
        }
        assert_eq!(civil(0), (2000, 1, 1));
        assert_eq!(civil(59), (2000, 2, 29));
    }
}
