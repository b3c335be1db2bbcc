//! The operating cycle: time, inputs, program, outputs, housekeeping.

use super::run::{Context, Ending};
use super::{Core, Watch};
use crate::choices::Choice;
use crate::family::Lineage;
use crate::fault::{MajorFault, code};
use crate::machine::Mode;
use crate::op::{BitAt, NO_INSTRUCTION, OpSite};
use crate::status;

const SECOND: u64 = 1_000_000_000;

impl Core<'_> {
    /// Goes to run or test: checks, prescan, first pass.
    pub(crate) fn enter_run(&mut self, mode: Mode) {
        self.set_status_bit(status::MAJOR_ERROR, false);
        self.s.fault = None;
        self.set_mode(mode);
        for timer in &mut self.s.timers {
            timer.fresh = true;
            timer.last = self.s.now;
        }
        for prescan in &self.p.prescan {
            self.prescan(prescan.bit, prescan.set);
        }
        if self.p.choices.has(Choice::OneShotSetByPrescan) {
            for bit in &self.p.one_shots {
                self.prescan(*bit, true);
            }
        }
        self.set_status_bit(status::FIRST_PASS, true);
        self.s.since_scan = 0;
        if let Some((code, site)) = self.p.going_to_run {
            return self.halt(code, site);
        }
        self.enter_run_interrupts();
    }

    /// A bit as prescan leaves it; an indirect one that leads nowhere is left alone.
    fn prescan(&mut self, bit: BitAt, on: bool) {
        let strays = self.s.strays;
        let _ = self.write_bit(bit, on);
        self.s.strays = strays;
    }

    /// A fault outside the program scan.
    pub(crate) fn halt(&mut self, code: u16, site: OpSite) {
        self.set_status(status::FAULT_CODE, code);
        self.set_status_bit(status::MAJOR_ERROR, true);
        self.s.fault = Some(MajorFault { code, file: site.file, rung: site.rung, cause: None });
        self.stop(Mode::Fault);
    }

    pub(crate) fn nowhere() -> OpSite {
        OpSite { file: 2, rung: 0, instruction: NO_INSTRUCTION }
    }

    /// Leaves the executing modes: outputs are de-energized.
    pub(crate) fn stop(&mut self, mode: Mode) {
        self.set_mode(mode);
        self.s.outputs.fill(0);
        self.stop_interrupts();
    }

    pub(crate) fn set_mode(&mut self, mode: Mode) {
        self.s.mode = mode;
        if let Some(code) = mode.code() {
            let word = self.status(status::MODE);
            self.set_status(status::MODE, word & !status::MODE_CODE | code);
        }
    }

    pub(crate) fn executing(&self) -> bool {
        matches!(self.s.mode, Mode::Run | Mode::Test)
    }

    /// Time passes, and with it clocks and timed interrupts.
    pub(crate) fn advance<W: Watch>(&mut self, nanoseconds: u64, watch: &mut W) {
        let end = self.s.now.saturating_add(nanoseconds);
        self.timed_interrupts(end, watch);
        self.pass(end);
    }

    /// Moves the clocks to a time.
    pub(crate) fn pass(&mut self, to: u64) {
        let elapsed = to.saturating_sub(self.s.now);
        self.s.now = to.max(self.s.now);
        self.s.since_scan = self.s.since_scan.saturating_add(elapsed);
        let tick = self.p.traits.clock_tick;
        let gathered = self.s.clock_part.saturating_add(elapsed);
        self.s.clock_part = gathered % tick;
        let clock = self.status(status::CLOCK);
        self.set_status(status::CLOCK, clock.wrapping_add((gathered / tick) as u16));
        let gathered = self.s.second_part.saturating_add(elapsed);
        self.s.second_part = gathered % SECOND;
        if gathered >= SECOND {
            self.move_clocks(gathered / SECOND);
        }
    }

    /// One scan of the program, when it executes.
    pub(crate) fn scan<W: Watch>(&mut self, watch: &mut W) {
        if !self.executing() {
            return;
        }
        let elapsed = std::mem::take(&mut self.s.since_scan);
        self.refill();
        if self.status(status::MINOR) & status::MINOR_FATAL == 0 {
            self.s.minor_by = None;
        }
        self.scan_times(elapsed);
        self.read_inputs();
        match self.p.traits.lineage {
            Lineage::Mx => self.fast_inputs(watch),
            Lineage::S3 => self.discrete_input(watch),
            _ => {}
        }
        if self.executing() {
            self.events(watch);
        }
        if !self.executing() {
            return;
        }
        let Some(entry) = self.p.entry(2) else { return self.halt(code::NO_MAIN, Self::nowhere()) };
        let ending = self.run(entry, Context::Main, watch);
        self.s.scans += 1;
        match ending {
            Ending::End | Ending::TempEnd => {}
            Ending::Suspend => return self.stop(Mode::Suspend),
            // An interrupt routine between rungs can have stopped the processor already.
            Ending::Halt if !self.executing() => return,
            Ending::Halt => return self.stop(Mode::Fault),
        }
        self.write_outputs();
        self.set_status_bit(status::FIRST_PASS, false);
        self.end_of_scan();
    }

    /// The last scan took what passed since it began: the engine itself takes no time.
    fn scan_times(&mut self, elapsed: u64) {
        if elapsed == 0 {
            return;
        }
        let mx = self.p.traits.mx();
        let tens = elapsed / 10_000_000;
        let scan_time = self.status(status::SCAN_TIME);
        self.set_status(status::SCAN_TIME, scan_time & 0xFF00 | tens.min(255) as u16);
        let unit = match mx {
            true => 100_000,
            false if self.status_bit(status::SCAN_IN_MILLISECONDS) => 1_000_000,
            false => 10_000_000,
        };
        let last = (elapsed / unit).min(u64::from(u16::MAX)) as u16;
        let maximum = self.status(status::MAXIMUM_SCAN);
        self.set_status(status::MAXIMUM_SCAN, maximum.max(last));
        let average = self.status(status::AVERAGE_SCAN);
        let average = (u32::from(average) * 7 + u32::from(last)) / 8;
        self.set_status(status::AVERAGE_SCAN, average.min(u32::from(u16::MAX)) as u16);
        let fine = if mx { 100_000 } else { 1_000_000 };
        self.set_status(status::LAST_SCAN, (elapsed / fine).min(u64::from(u16::MAX)) as u16);
    }

    /// A new watchdog interval.
    pub(crate) fn refill(&mut self) {
        self.s.limit = self.s.executed.saturating_add(self.p.watchdog);
    }

    pub(crate) fn forced(&self) -> bool {
        self.status_bit(status::FORCES_ENABLED)
    }

    /// Terminals to file I, forces applied.
    pub(crate) fn read_inputs(&mut self) {
        let (first, _) = self.p.inputs;
        let forced = self.forced();
        let state = &mut *self.s;
        let image = state.mem.get_mut(first..).unwrap_or_default();
        if !forced {
            for (word, terminal) in image.iter_mut().zip(&state.inputs) {
                *word = *terminal;
            }
            return;
        }
        for ((word, terminal), (on, off)) in image.iter_mut().zip(&state.inputs).zip(&state.input_forces) {
            *word = (terminal | on) & off;
        }
    }

    /// File O to terminals, forces applied. In test mode the terminals stay off.
    pub(crate) fn write_outputs(&mut self) {
        let (first, _) = self.p.outputs;
        let forced = self.forced();
        let energized = self.s.mode == Mode::Run;
        let state = &mut *self.s;
        let image = state.mem.get(first..).unwrap_or_default();
        for ((terminal, word), (on, off)) in state.outputs.iter_mut().zip(image).zip(&state.output_forces) {
            *terminal = match (energized, forced) {
                (false, _) => 0,
                (true, false) => *word,
                (true, true) => (word | on) & off,
            };
        }
    }

    /// Seconds pass on the calendar: S:37 to S:42 with S:53, and RTC:0.
    fn move_clocks(&mut self, seconds: u64) {
        let lineage = self.p.traits.lineage;
        if matches!(lineage, Lineage::S3 | Lineage::Mx) {
            let first = (self.p.layout.status + status::YEAR) as u32;
            let day = (self.p.layout.status + status::DAY_OF_WEEK) as u32;
            self.move_clock(first, day, seconds);
        }
        if lineage == Lineage::Mx
            && let Some(file) = self.p.layout.file(ladder::FileType::RTC, 0)
            && let Some(info) = self.p.layout.files.get(file)
        {
            let first = info.start;
            self.move_clock(first, first + 6, seconds);
        }
    }

    /// Year, month, day, hour, minute, second from `first` on; all zero means off.
    pub(crate) fn move_clock(&mut self, first: u32, weekday: u32, seconds: u64) {
        let read = |core: &Self, index: u32| u64::from(core.word(first + index));
        let (year, month, day) = (read(self, 0), read(self, 1), read(self, 2));
        if year == 0 || !(1..=12).contains(&month) || !(1..=31).contains(&day) || year > 9999 {
            return;
        }
        let total = read(self, 3) * 3600 + read(self, 4) * 60 + read(self, 5) + seconds;
        let (mut days, rest) = (total / 86_400, total % 86_400);
        let (mut year, mut month, mut day) = (year, month, day);
        let shifted = days;
        // Whole cycles of 400 years at once keeps the loop short whatever was asked.
        year += days / 146_097 * 400;
        days %= 146_097;
        while days > 0 {
            day += 1;
            days -= 1;
            if day > month_days(year, month) {
                (day, month) = (1, month + 1);
            }
            if month > 12 {
                (month, year) = (1, year + 1);
            }
        }
        for (index, value) in [year, month, day, rest / 3600, rest / 60 % 60, rest % 60].into_iter().enumerate() {
            self.put(first + index as u32, value as u16);
        }
        if shifted > 0 {
            let today = u64::from(self.word(weekday));
            self.put(weekday, ((today + shifted) % 7) as u16);
        }
    }
}

fn month_days(year: u64, month: u64) -> u64 {
    match month {
        4 | 6 | 9 | 11 => 30,
        2 if year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400)) => 29,
        2 => 28,
        _ => 31,
    }
}
