//! Timed and event interrupts.

use ladder::FileType;

use super::run::{Context, Ending};
use super::{Core, Exec, Watch};
use crate::fault::code;
use crate::machine::Mode;
use crate::op::{MaskChange, Source};
use crate::status;

/// Flags of an interrupt function file, word 2 of its element, in the order the manuals list them.
/// Their bit numbers are inferred from those of HSC flags seen in compiled programs.
pub(crate) mod flag {
    pub(crate) const EXECUTING: u16 = 1;
    pub(crate) const ENABLE: u16 = 1 << 1;
    pub(crate) const LOST: u16 = 1 << 2;
    pub(crate) const PENDING: u16 = 1 << 3;
    pub(crate) const TIMED: u16 = 1 << 4;
    pub(crate) const AUTO_START: u16 = 1 << 5;
    pub(crate) const ERROR: u16 = 1 << 6;
}

/// Words of an interrupt function file element.
const PROGRAM_FILE: u32 = 0;
const ERROR_CODE: u32 = 1;
pub(super) const FLAGS: u32 = 2;
const SET_POINT: u32 = 3;

/// More timed interrupts than this in one call are counted as lost: a caller asked for hours at once.
const MOST_EXPIRIES: u32 = 200_000;

const MILLISECOND: u64 = 1_000_000;

impl Core<'_> {
    /// First word of the STI function file.
    fn timed_file(&self) -> Option<u32> {
        self.p.layout.interrupt(FileType::STI, 0)
    }

    /// Checks and loads interrupts on the way to run.
    pub(crate) fn enter_run_interrupts(&mut self) {
        self.s.timed.executing = false;
        self.s.timed.period = 0;
        self.s.events = [0; 8];
        if self.p.traits.status_file_sti() {
            self.set_status_bit(status::STI_EXECUTING, false);
            self.set_status_bit(status::STI_PENDING, false);
            self.s.timed.fine =
                self.status_bit(status::STI_MILLISECONDS) && self.p.traits.lineage == crate::family::Lineage::S3;
            self.s.timed.enabled = self.status_bit(status::STI_ENABLED);
            match self.status_file_period() {
                Ok(period) => self.start_timed(period),
                Err(code) => return self.halt(code, Self::nowhere()),
            }
            if self.p.traits.lineage == crate::family::Lineage::S3 {
                self.enter_run_discrete();
            }
            return;
        }
        self.enter_run_fast();
        let Some(at) = self.timed_file().filter(|_| self.executing()) else { return };
        let flags = self.word(at + FLAGS);
        let file = self.word(at + PROGRAM_FILE);
        let exists = (3..=255).contains(&file) && self.p.entry(file).is_some();
        if flags & flag::AUTO_START != 0 || file != 0 {
            self.put_bits(at + FLAGS, flag::ERROR, !exists);
            self.put(at + ERROR_CODE, u16::from(!exists));
            if !exists {
                return self.halt(code::STI_FILE, Self::nowhere());
            }
        }
        self.put_bits(at + FLAGS, flag::EXECUTING | flag::PENDING, false);
        if flags & flag::AUTO_START != 0 {
            self.put_bits(at + FLAGS, flag::ENABLE | flag::TIMED, true);
        }
        let period = u64::from(self.word(at + SET_POINT)) * MILLISECOND;
        let timed = self.word(at + FLAGS) & flag::TIMED != 0;
        self.start_timed(if timed { period } else { 0 });
    }

    fn start_timed(&mut self, period: u64) {
        self.s.timed.period = period;
        self.s.timed.next = self.s.now.saturating_add(period);
    }

    pub(crate) fn stop_interrupts(&mut self) {
        self.s.timed.period = 0;
        if self.p.traits.status_file_sti() {
            self.set_status_bit(status::STI_PENDING, false);
        }
        if self.p.traits.lineage == crate::family::Lineage::S3 {
            self.set_status_bit(status::DII_PENDING, false);
        }
    }

    /// The period S:30 and S:31 ask for; 0 when they ask for none.
    fn status_file_period(&self) -> Exec<u64> {
        let (file, set_point) = (self.status(status::STI_FILE), self.status(status::STI_PERIOD) as i16);
        if file == 0 {
            return Ok(0);
        }
        if !(3..=255).contains(&file) || self.p.entry(file).is_none() {
            return Err(code::STI_FILE);
        }
        let unit = if self.s.timed.fine { 1 } else { 10 };
        let most = if self.s.timed.fine { 2550 } else { 255 };
        match u64::try_from(set_point) {
            Ok(count) if count <= most => Ok(count * unit * MILLISECOND),
            _ => Err(code::STI_PERIOD),
        }
    }

    /// Runs what expires up to a time.
    pub(crate) fn timed_interrupts<W: Watch>(&mut self, end: u64, watch: &mut W) {
        let mut expiries = 0;
        while self.executing() && self.s.timed.period > 0 && self.s.timed.next <= end {
            let at = self.s.timed.next;
            self.pass(at);
            self.s.timed.next = at.saturating_add(self.s.timed.period);
            expiries += 1;
            if expiries > MOST_EXPIRIES {
                self.s.timed.next = end.saturating_add(self.s.timed.period);
                self.timed_lost();
                return;
            }
            self.s.limit = self.s.executed.saturating_add(self.p.watchdog);
            self.expire(watch);
        }
    }

    fn timed_lost(&mut self) {
        if self.p.traits.mx() {
            if let Some(at) = self.timed_file() {
                self.put_bits(at + FLAGS, flag::LOST, true);
            }
            return;
        }
        let minor = self.status(status::MINOR);
        self.set_status(status::MINOR, minor | status::STI_OVERFLOW);
        if self.p.traits.lineage == crate::family::Lineage::S3 {
            let extended = self.status(status::EXTENDED_MINOR);
            self.set_status(status::EXTENDED_MINOR, extended | status::STI_LOST);
        }
    }

    /// The interval is over: the routine runs, or waits while it is disabled.
    fn expire<W: Watch>(&mut self, watch: &mut W) {
        if self.p.traits.mx() {
            let Some(at) = self.timed_file() else { return };
            let set_point = u64::from(self.word(at + SET_POINT)) * MILLISECOND;
            if set_point > 0 && set_point != self.s.timed.period {
                self.s.timed.period = set_point;
                self.s.timed.next = self.s.now.saturating_add(set_point);
            }
            return self.function_file_interrupt(at, watch);
        }
        if self.p.traits.lineage == crate::family::Lineage::S3 {
            self.s.timed.enabled = self.status_bit(status::STI_ENABLED);
        }
        match self.status_file_period() {
            Ok(period) if period != self.s.timed.period => self.start_timed(period),
            Ok(_) => {}
            Err(code) => return self.halt(code, Self::nowhere()),
        }
        if !self.s.timed.enabled || self.s.timed.executing {
            if self.status_bit(status::STI_PENDING) || self.s.timed.executing {
                self.timed_lost();
            }
            self.set_status_bit(status::STI_PENDING, true);
            return;
        }
        self.timed_routine(watch);
    }

    fn timed_routine<W: Watch>(&mut self, watch: &mut W) {
        let Some(entry) = self.p.entry(self.status(status::STI_FILE)) else { return };
        self.set_status_bit(status::STI_PENDING, false);
        self.set_status_bit(status::STI_EXECUTING, true);
        self.s.timed.executing = true;
        let ending = self.interrupting(|core| core.run(entry, Context::Interrupt, watch));
        self.s.timed.executing = false;
        self.set_status_bit(status::STI_EXECUTING, false);
        self.ended(ending);
    }

    pub(super) fn ended(&mut self, ending: Ending) {
        match ending {
            Ending::End | Ending::TempEnd => {}
            Ending::Suspend => self.stop(Mode::Suspend),
            Ending::Halt => self.stop(Mode::Fault),
        }
    }

    /// An interrupt whose set-up is a function file element at `at`: one active, two waiting, then lost.
    pub(crate) fn function_file_interrupt<W: Watch>(&mut self, at: u32, watch: &mut W) {
        let flags = self.word(at + FLAGS);
        if flags & flag::ENABLE == 0 || flags & flag::EXECUTING != 0 {
            let waiting = self.waiting(at);
            if *waiting >= 2 {
                self.put_bits(at + FLAGS, flag::LOST, true);
            } else {
                *waiting += 1;
            }
            self.put_bits(at + FLAGS, flag::PENDING, true);
            return;
        }
        let file = self.word(at + PROGRAM_FILE);
        let entry = self.p.entry(file).filter(|_| (3..=255).contains(&file));
        let Some(entry) = entry else {
            self.put_bits(at + FLAGS, flag::ERROR, true);
            self.put(at + ERROR_CODE, 1);
            return;
        };
        self.put_bits(at + FLAGS, flag::EXECUTING, true);
        let ending = self.interrupting(|core| core.run(entry, Context::Interrupt, watch));
        self.put_bits(at + FLAGS, flag::EXECUTING, false);
        self.ended(ending);
    }

    /// Interrupt sources of function files, highest priority first, with their bit in the masks of UID,
    /// UIE and UIF (recalled from the manuals, as the order of the waiting counts).
    const SOURCES: [(u16, FileType, u32); 7] = [
        (6, FileType::EII, 0),
        (5, FileType::EII, 1),
        (4, FileType::HSC, 0),
        (3, FileType::EII, 2),
        (2, FileType::EII, 3),
        (1, FileType::HSC, 1),
        (0, FileType::STI, 0),
    ];

    fn source_at(&self, (_, file_type, element): (u16, FileType, u32)) -> Option<u32> {
        self.p.layout.interrupt(file_type, element)
    }

    /// Count of waiting interrupts of the source at `at`; sources beyond the listed ones share one.
    fn waiting(&mut self, at: u32) -> &mut u8 {
        let index = Self::SOURCES.iter().position(|source| self.source_at(*source) == Some(at)).unwrap_or(7);
        &mut self.s.events[index & 7]
    }

    /// Interrupts that wait and are enabled again, highest priority first.
    pub(crate) fn events<W: Watch>(&mut self, watch: &mut W) {
        if self.p.traits.mx() {
            if self.s.events == [0; 8] {
                return;
            }
            for source in Self::SOURCES {
                let Some(at) = self.source_at(source) else { continue };
                while *self.waiting(at) > 0 && self.word(at + FLAGS) & flag::ENABLE != 0 && self.executing() {
                    *self.waiting(at) -= 1;
                    let more = *self.waiting(at) > 0;
                    self.put_bits(at + FLAGS, flag::PENDING, more);
                    self.function_file_interrupt(at, watch);
                }
            }
            return;
        }
        if self.status_bit(status::STI_PENDING) && self.s.timed.enabled && self.s.timed.period > 0 {
            self.timed_routine(watch);
        }
    }

    /// Takes over what the program changed in the status file.
    pub(crate) fn end_of_scan(&mut self) {
        if !self.p.traits.status_file_sti() {
            return;
        }
        self.s.timed.enabled = self.status_bit(status::STI_ENABLED);
        if self.s.timed.period == 0 {
            match self.status_file_period() {
                Ok(period) => self.start_timed(period),
                Err(code) => self.halt(code, Self::nowhere()),
            }
        }
    }

    /// STS.
    pub(crate) fn timed_start(&mut self, file: Option<Source>, time: Source) -> Exec<()> {
        let time = self.integer(time)?;
        if self.p.traits.mx() {
            let Some(at) = self.timed_file() else { return Ok(()) };
            let set_point = u16::try_from(time).map_err(|_| code::STI_PERIOD)?;
            let program_file = self.word(at + PROGRAM_FILE);
            if !(3..=255).contains(&program_file) || self.p.entry(program_file).is_none() {
                self.put_bits(at + FLAGS, flag::ERROR, true);
                self.put(at + ERROR_CODE, 1);
                return Err(code::STI_FILE);
            }
            self.put(at + SET_POINT, set_point);
            self.put_bits(at + FLAGS, flag::ENABLE | flag::TIMED, true);
            self.start_timed(u64::from(set_point) * MILLISECOND);
            return Ok(());
        }
        if let Some(file) = file {
            let file = self.integer(file)?;
            self.set_status(status::STI_FILE, u16::try_from(file).unwrap_or(u16::MAX));
        }
        self.set_status(status::STI_PERIOD, time as u16);
        self.set_status_bit(status::STI_ENABLED, true);
        self.set_status_bit(status::STI_PENDING, false);
        self.s.timed.enabled = true;
        let period = self.status_file_period()?;
        self.start_timed(period);
        Ok(())
    }

    /// STE and STD act at once.
    pub(crate) fn timed_enable(&mut self, on: bool) {
        self.set_status_bit(status::STI_ENABLED, on);
        self.s.timed.enabled = on;
        self.s.due |= on && self.status_bit(status::STI_PENDING);
    }

    /// UID, UIE, UIF: bits name the sources.
    pub(crate) fn interrupt_mask(&mut self, change: MaskChange, types: Source) -> Exec<()> {
        let types = self.integer(types)? as u16;
        for source in Self::SOURCES {
            let Some(at) = self.source_at(source).filter(|_| types >> source.0 & 1 != 0) else { continue };
            match change {
                MaskChange::Disable => self.put_bits(at + FLAGS, flag::ENABLE, false),
                MaskChange::Enable => {
                    self.put_bits(at + FLAGS, flag::ENABLE, true);
                    self.s.due = true;
                }
                MaskChange::Flush => {
                    *self.waiting(at) = 0;
                    self.put_bits(at + FLAGS, flag::PENDING | flag::LOST, false);
                }
            }
        }
        Ok(())
    }

    /// REF: outputs and inputs now, then the program goes on.
    pub(crate) fn refresh(&mut self, context: Context) -> Exec<()> {
        if context != Context::Main {
            return Err(code::IN_INTERRUPT);
        }
        let minor = self.status(status::MINOR) & status::MINOR_FATAL != 0;
        if minor && !self.p.traits.mx() {
            return Err(code::MINOR_ERROR);
        }
        self.write_outputs();
        self.read_inputs();
        Ok(())
    }
}
