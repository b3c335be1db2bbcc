//! The loop over the operations of a program file and what it calls.

use super::{Core, Exec};
use crate::fault::{self, FaultClass, MajorFault, code};
use crate::op::*;
use crate::status;
use crate::trace::{PowerFlow, Trace};

/// Why a run over a file ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ending {
    /// Its END, or RET.
    End,
    /// TND.
    TempEnd,
    /// SUS.
    Suspend,
    /// A fault that was not cleared.
    Halt,
}

/// What a file runs as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Context {
    Main,
    /// A timed interrupt, or one of a function file.
    Interrupt,
    /// The discrete input interrupt.
    Discrete,
    FaultRoutine,
}

impl Context {
    /// The fault of a JSR too deep: SLC processors tell by its code from where the calls began.
    fn too_deep(self, mx: bool) -> u16 {
        match self {
            Context::Interrupt if !mx => code::NESTING_STI,
            Context::Discrete => code::NESTING_IO,
            Context::FaultRoutine if !mx => code::NESTING_FAULT_ROUTINE,
            _ => code::NESTING,
        }
    }
}

/// Watching is decided at compile time so that scans without a trace pay nothing.
pub(crate) trait Watch {
    const ON: bool;
    fn flow(&mut self, site: OpSite, before: bool, after: bool);
}

pub(crate) struct NoWatch;

impl Watch for NoWatch {
    const ON: bool = false;
    fn flow(&mut self, _: OpSite, _: bool, _: bool) {}
}

impl Watch for &mut dyn Trace {
    const ON: bool = true;
    fn flow(&mut self, site: OpSite, before: bool, after: bool) {
        if site.instruction != NO_INSTRUCTION && self.wants(site.file, site.rung) {
            let (file, rung, instruction) = (site.file, site.rung, site.instruction);
            Trace::flow(*self, PowerFlow { file, rung, instruction, before, after });
        }
    }
}

/// Where a subroutine returns to.
#[derive(Clone, Copy, Default)]
struct Frame {
    position: usize,
    zone: bool,
    flow: Flow,
}

/// Power in a rung. One bit per open branch: power where it began, and what its finished legs passed on.
#[derive(Clone, Copy, Default)]
struct Flow {
    power: bool,
    saved: u64,
    joined: u64,
}

impl Flow {
    /// Executes an operation on words alone; `false`: it is another one.
    #[inline(always)]
    fn simple(&mut self, op: &Op, words: &mut [u16]) -> bool {
        let read = |words: &[u16], at: u32| words.get(at as usize).copied().unwrap_or(0);
        match *op {
            Op::Contact { invert, mask, word } => self.power &= (read(words, word) ^ invert) & mask != 0,
            Op::BranchStart => {
                self.saved = self.saved << 1 | u64::from(self.power);
                self.joined <<= 1;
            }
            Op::NextLeg => {
                self.joined |= u64::from(self.power);
                self.power = self.saved & 1 != 0;
            }
            Op::BranchEnd => {
                self.power |= self.joined & 1 != 0;
                self.saved >>= 1;
                self.joined >>= 1;
            }
            Op::Ote { mask, word } => {
                if let Some(word) = words.get_mut(word as usize) {
                    let on = if self.power { mask } else { 0 };
                    *word = *word & !mask | on;
                }
            }
            Op::Otl { mask, word } => {
                if let Some(word) = words.get_mut(word as usize) {
                    *word |= if self.power { mask } else { 0 };
                }
            }
            Op::Otu { mask, word } => {
                if let Some(word) = words.get_mut(word as usize) {
                    *word &= !if self.power { mask } else { 0 };
                }
            }
            Op::OneShot { mask, word } => {
                if let Some(word) = words.get_mut(word as usize) {
                    let was = *word & mask != 0;
                    let on = if self.power { mask } else { 0 };
                    *word = *word & !mask | on;
                    self.power &= !was;
                }
            }
            Op::CompareWords { relation, a, b } => {
                self.power &= relation.holds(read(words, a) as i16, read(words, b) as i16);
            }
            Op::CompareConstant { relation, value, a } => {
                self.power &= relation.holds(read(words, a) as i16, value);
            }
            // Without power there is nothing to evaluate.
            Op::Test(_) | Op::Do(_) => return !self.power,
            Op::Marker => {}
            _ => return false,
        }
        true
    }
}

const LEVELS: usize = 8;

impl Core<'_> {
    /// Runs a file from `entry` until it ends.
    pub(crate) fn run<W: Watch>(&mut self, entry: u32, context: Context, watch: &mut W) -> Ending {
        let program = self.p;
        let ops = program.ops.as_slice();
        let levels = match context {
            Context::Main => program.traits.levels,
            _ => program.traits.interrupt_levels,
        };
        let mut frames = [Frame::default(); LEVELS];
        let mut depth = 0;
        let mut at = entry as usize;
        // Instructions are counted by stretches between transfers of control.
        let mut counted_from = at;
        let mut zone = true;
        let mut flow = Flow { power: true, saved: 0, joined: 0 };
        loop {
            if !W::ON {
                // Most of a program: a tight loop over operations that need nothing but words.
                let words = self.s.mem.as_mut_slice();
                let due = self.s.due;
                while let Some(op) = ops.get(at) {
                    match op {
                        Op::Rung if !due => flow.power = zone,
                        op if flow.simple(op, words) => {}
                        _ => break,
                    }
                    at += 1;
                }
            }
            let Some(op) = ops.get(at) else { return Ending::End };
            let before = flow.power;
            let mut failed = None;
            match *op {
                _ if flow.simple(op, &mut self.s.mem) => {}
                Op::Rung => {
                    flow.power = zone;
                    if self.s.due && context == Context::Main {
                        self.s.due = false;
                        self.events(watch);
                        if !self.executing() {
                            self.count(counted_from, at);
                            return Ending::Halt;
                        }
                    }
                }
                Op::Timer { kind, base, word, slot } => {
                    if let Err(code) = self.timer(kind, base, word, slot, flow.power) {
                        failed = Some(code);
                    }
                }
                Op::Counter { down, word } => self.counter(down, word, flow.power),
                Op::Test(block) => {
                    if flow.power {
                        match self.test(block) {
                            Ok(passed) => flow.power = passed,
                            Err(code) => {
                                flow.power = false;
                                failed = Some(code);
                            }
                        }
                    }
                }
                Op::Do(block) => {
                    self.s.acting = at as u32;
                    if flow.power
                        && let Err(code) = self.act(block, true, context)
                    {
                        failed = Some(code);
                    }
                }
                Op::Always(block) => {
                    self.s.acting = at as u32;
                    match self.one_shot_block(block, flow.power) {
                        Some(result) => match result {
                            Ok(passed) => flow.power = passed,
                            Err(code) => failed = Some(code),
                        },
                        None => {
                            if let Err(code) = self.act(block, flow.power, context) {
                                failed = Some(code);
                            }
                        }
                    }
                }
                Op::Mcr => zone = if zone { flow.power } else { true },
                Op::Jump(target) => {
                    if flow.power {
                        if W::ON {
                            self.watch(watch, at, before, flow.power);
                        }
                        self.count(counted_from, at + 1);
                        if self.s.executed > self.s.limit {
                            failed = Some(code::WATCHDOG);
                        } else {
                            at = target as usize;
                            counted_from = at;
                            continue;
                        }
                        counted_from = at + 1;
                    }
                }
                Op::Call(file) => {
                    if flow.power {
                        self.count(counted_from, at + 1);
                        counted_from = at + 1;
                        match program.entry(file as u16) {
                            _ if self.s.executed > self.s.limit => failed = Some(code::WATCHDOG),
                            _ if depth >= levels || depth >= LEVELS => {
                                failed = Some(context.too_deep(program.traits.mx()));
                            }
                            None => failed = Some(code::UNSUPPORTED),
                            Some(start) => {
                                if W::ON {
                                    self.watch(watch, at, before, flow.power);
                                }
                                if let Some(frame) = frames.get_mut(depth) {
                                    *frame = Frame { position: at + 1, zone, flow };
                                }
                                depth += 1;
                                zone = true;
                                at = start as usize;
                                counted_from = at;
                                continue;
                            }
                        }
                    }
                }
                Op::Return | Op::End => {
                    let is_end = matches!(op, Op::End);
                    if is_end || flow.power {
                        if W::ON {
                            self.watch(watch, at, before, flow.power);
                        }
                        self.count(counted_from, at + 1);
                        counted_from = at + 1;
                        if depth > 0 {
                            depth -= 1;
                            let frame = frames.get(depth).copied().unwrap_or_default();
                            (at, zone, flow) = (frame.position, frame.zone, frame.flow);
                            counted_from = at;
                            continue;
                        }
                        if is_end || context != Context::Main {
                            return self.finish(context, at, Ending::End, watch);
                        }
                        failed = Some(code::RET_IN_MAIN);
                    }
                }
                Op::TempEnd => {
                    if flow.power {
                        if W::ON {
                            self.watch(watch, at, before, flow.power);
                        }
                        self.count(counted_from, at + 1);
                        counted_from = at + 1;
                        if context == Context::Main {
                            return self.finish(context, at, Ending::TempEnd, watch);
                        }
                        failed = Some(code::IN_INTERRUPT);
                    }
                }
                // Executed above.
                Op::BranchStart
                | Op::NextLeg
                | Op::BranchEnd
                | Op::Contact { .. }
                | Op::Ote { .. }
                | Op::Otl { .. }
                | Op::Otu { .. }
                | Op::OneShot { .. }
                | Op::CompareWords { .. }
                | Op::CompareConstant { .. }
                | Op::Marker => {}
                Op::Suspend(number) => {
                    if flow.power {
                        self.count(counted_from, at + 1);
                        self.set_status(status::SUSPEND_CODE, number as u16);
                        let file = program.sites.get(at).map_or(0, |site| site.file);
                        self.set_status(status::SUSPEND_FILE, file);
                        return Ending::Suspend;
                    }
                }
            }
            if W::ON {
                self.watch(watch, at, before, flow.power);
            }
            if let Some(code) = failed {
                self.count(counted_from, at + 1);
                counted_from = at + 1;
                if !self.raise(code, at, context, watch) {
                    return Ending::Halt;
                }
            }
            at += 1;
        }
    }

    fn watch<W: Watch>(&self, watch: &mut W, at: usize, before: bool, after: bool) {
        if let Some(site) = self.p.sites.get(at) {
            watch.flow(*site, before, after);
        }
    }

    /// Adds the instructions of operations `from..to`.
    fn count(&mut self, from: usize, to: usize) {
        let at = |position: usize| self.p.before.get(position).copied().unwrap_or(0);
        self.s.executed += u64::from(at(to).saturating_sub(at(from)));
    }

    /// End of the program scan: minor errors, and a fault the program declared itself.
    fn finish<W: Watch>(&mut self, context: Context, at: usize, ending: Ending, watch: &mut W) -> Ending {
        if context != Context::Main {
            return ending;
        }
        if self.minor_errors(at, watch) { ending } else { Ending::Halt }
    }

    /// The check END, TND and REF make; `false`: the processor halts.
    pub(crate) fn minor_errors<W: Watch>(&mut self, at: usize, watch: &mut W) -> bool {
        if self.status(status::MINOR) & status::MINOR_FATAL != 0
            && !self.raise(code::MINOR_ERROR, at, Context::Main, watch)
        {
            return false;
        }
        if self.status_bit(status::MAJOR_ERROR) {
            let declared = self.status(status::FAULT_CODE);
            return self.raise(declared, at, Context::Main, watch);
        }
        true
    }

    /// Program file and rung of the box that set a minor error; `None` where a coil can have set it as well.
    fn minor_cause(&mut self) -> Option<(u16, u16)> {
        let by = self.s.minor_by.take()?;
        let minor = self.p.layout.status + status::MINOR;
        let sets = |op: &Op| match op {
            Op::Ote { word, mask } | Op::Otl { word, mask } => {
                *word as usize == minor && *mask & status::MINOR_FATAL != 0
            }
            _ => false,
        };
        let site = self.p.sites.get(by as usize).filter(|_| !self.p.ops.iter().any(sets))?;
        Some((site.file, site.rung))
    }

    /// A major fault: the user fault routine may clear it. `true`: the program goes on.
    pub(crate) fn raise<W: Watch>(&mut self, code: u16, at: usize, context: Context, watch: &mut W) -> bool {
        let site = self.p.sites.get(at).copied();
        let (file, rung) = site.map_or((0, 0), |site| (site.file, site.rung));
        self.set_status(status::FAULT_CODE, code);
        self.set_status_bit(status::MAJOR_ERROR, true);
        let cause = if code == code::MINOR_ERROR { self.minor_cause() } else { None };
        self.s.fault = Some(MajorFault { code, file, rung, cause });
        if context == Context::FaultRoutine {
            let minor = self.status(status::MINOR);
            self.set_status(status::MINOR, minor | status::FAULT_IN_ROUTINE);
            return false;
        }
        self.set_status(status::FAULT_RUNG, rung);
        self.set_status(status::FAULT_FILE, file);
        let class = fault::class(code);
        let routine = self.status(status::FAULT_ROUTINE);
        if class == FaultClass::NonUser || routine == 0 {
            return false;
        }
        let Some(entry) = self.p.entry(routine).filter(|_| (3..=255).contains(&routine)) else {
            self.set_status(status::FAULT_CODE, code::FAULT_ROUTINE);
            self.s.fault = Some(MajorFault { code: code::FAULT_ROUTINE, file, rung, cause: None });
            return false;
        };
        // The routine has a budget of its own: after a watchdog fault none is left.
        self.s.limit = self.s.executed.saturating_add(self.p.watchdog);
        let ending = self.interrupting(|core| core.run(entry, Context::FaultRoutine, watch));
        if ending == Ending::End && class == FaultClass::Recoverable && !self.status_bit(status::MAJOR_ERROR) {
            self.s.fault = None;
            return true;
        }
        self.set_status_bit(status::MAJOR_ERROR, true);
        false
    }

    /// Runs something with the registers saved that interrupts preserve.
    pub(crate) fn interrupting<R>(&mut self, run: impl FnOnce(&mut Self) -> R) -> R {
        let saved = [status::FLAGS, status::MATH_LOW, status::MATH_HIGH, status::INDEX];
        let values = saved.map(|word| self.status(word));
        let result = run(self);
        for (word, value) in saved.into_iter().zip(values) {
            // S:0 holds the arithmetic flags in its low bits; the others are hardware settings.
            self.set_status(word, value);
        }
        result
    }

    /// A one-shot condition whose storage bit is decided at run time.
    fn one_shot_block(&mut self, block: u32, power: bool) -> Option<Exec<bool>> {
        let Some(Block::OneShot(bit)) = self.p.blocks.get(block as usize) else { return None };
        let bit = *bit;
        Some(self.read_bit(bit).and_then(|was| {
            self.write_bit(bit, power)?;
            Ok(power && !was)
        }))
    }
}

impl Relation {
    #[inline(always)]
    pub(crate) fn holds<T: PartialOrd>(self, a: T, b: T) -> bool {
        match self {
            Relation::Equal => a == b,
            Relation::NotEqual => a != b,
            Relation::Less => a < b,
            Relation::LessOrEqual => a <= b,
            Relation::Greater => a > b,
            Relation::GreaterOrEqual => a >= b,
        }
    }
}
