//! Coils, boxes and program flow to operations.

use super::compile::{Compiler, MOST_LOOPS};
use super::op::*;
use super::operand::Why;
use crate::address::{Constant, Number};
use crate::counter::CounterKind;
use crate::memory::{ElementType, Kind, Num, Place};
use crate::program::Instruction;
use crate::timer::TimerKind;

const IMMEDIATE: &str = "immediate output: written with the others, at the end of the scan";
const SHARED: &str = "another box owns the same structure; the vendor asks for one box per structure";
const CASTS: &str = "the order of the limits is inferred; the smaller one is taken as the lower";
const FILTER: &str = "the formula of FILTER is not described; taken as a step of 1/factor towards the input";
const FLASHER: &str = "FLASHER is taken to begin ON and to be OFF while not enabled";
const DEBOUNCE: &str = "DEBOUNCE is taken to follow the power flow after it was stable for the on or off time";
const TIMED_OUT: &str =
    "TIMEDOUT is taken to stay ON for its time after the power flow rises; its flags are not decoded";
const PIECES: &str = "the pieces of STRPRINT with flags 0x4 are taken to follow each other without a blank";
const COPY_FLAGS: &str = "the flags of COPY are not decoded; rows are copied one after the other";
const SUSPENDED: &str = "SUSPEND is taken to pause a program without a termination scan, RUN to go on";
const RESTARTED: &str = "RESTART is taken to make one termination scan and to start in the scan behind it";
const LOOP_END: &str = "the value a loop variable has behind its loop is not described; taken as one step past the end";
const DATES: &str = "COPY through casts reads and writes element by element, in the order of its rows";

/// Flags of STRPRINT that replaces its string. (Designer export)
const PRINT_OVER: i64 = 4;

type Output = Result<(Op, Vec<&'static str>), Why>;

/// Puts something in a table; its index.
fn keep<T>(table: &mut Vec<T>, item: T) -> u32 {
    table.push(item);
    table.len() as u32 - 1
}

/// A number written as a constant.
fn constant(text: &str) -> Option<i64> {
    match Constant::parse(text)?.value {
        Number::Integer(value) => Some(value),
        Number::Real(_) => None,
    }
}

impl Compiler {
    /// A coil, box or instruction that stands alone.
    pub(super) fn output(&mut self, mnemonic: &str, instruction: &Instruction, spot: Spot) -> Output {
        let text = |index: usize| instruction.operand(index);
        if let Some(kind) = TimerKind::from_mnemonic(mnemonic) {
            return self.timer(kind, instruction);
        }
        if let Some(kind) = CounterKind::from_mnemonic(mnemonic) {
            return self.counter(kind, instruction);
        }
        let exact = |op| Ok((op, Vec::new()));
        match mnemonic {
            "OUT" => exact(Op::Out(self.out.coil(text(0))?)),
            "OUTI" => Ok((Op::Out(self.out.coil(text(0))?), vec![IMMEDIATE])),
            "OROUT" => {
                let bit = self.out.coil(text(0))?;
                let memory = self.or_out(bit);
                exact(Op::OrOut { bit, memory })
            }
            "SET" => exact(Op::Set(self.out.coil(text(0))?)),
            "SETI" => Ok((Op::Set(self.out.coil(text(0))?), vec![IMMEDIATE])),
            "RST" => exact(Op::Reset(self.out.coil(text(0))?)),
            "RSTI" => Ok((Op::Reset(self.out.coil(text(0))?), vec![IMMEDIATE])),
            "RSTR" => {
                self.out.coil(text(0))?;
                let (first, stride, count) = self.out.ends(text(0), text(1))?;
                if stride != 1 {
                    return Err(format!("{} is no bit", text(0)));
                }
                exact(Op::ResetRange { first: first.bit, last: first.bit + count - 1 })
            }
            "PD" | "ND" => {
                let bit = self.out.coil(text(0))?;
                exact(Op::Pulse { rise: mnemonic == "PD", bit, memory: self.edge() })
            }
            "RSTT" | "RSTCT" => {
                let timer = mnemonic == "RSTT";
                let element = if timer { ElementType::Timer } else { ElementType::Counter };
                let bit = self.out.structure(text(0), element)?;
                let structure = self.structure(bit);
                let index = keep(&mut self.out.resets, StructureReset { bit, structure, owner: None });
                exact(if timer { Op::ResetTimer(index) } else { Op::ResetCounter(index) })
            }
            "MOVE" => {
                let (from, to) = (self.out.source(text(0))?, self.out.target(text(1))?);
                exact(Op::Move(keep(&mut self.out.moves, (from, to))))
            }
            "MATH" => {
                let target = self.out.target(text(0))?;
                let expression = crate::address::unquote(text(1));
                let expression = expression.ok_or_else(|| format!("{}: expected an expression in quotes", text(1)))?;
                let formula = crate::math::Formula::parse(&expression, &self.out.map)?;
                exact(Op::Math(keep(&mut self.out.maths, (formula, target))))
            }
            "INC" | "DEC" => {
                let target = self.out.target(text(0))?;
                let target = keep(&mut self.out.targets, target);
                exact(Op::Step { add: if mnemonic == "INC" { 1 } else { -1 }, target })
            }
            "COPY" | "INIT" | "MEMCOPY" | "MEMCLEAR" | "STRCLEAR" | "STRPRINT" | "SCALE" | "CLAMP" | "FILTER"
            | "FLASHER" | "DEBOUNCE" | "TIMEDOUT" => {
                let (code, notes) = self.data(mnemonic, instruction)?;
                Ok((Op::Box(keep(&mut self.out.boxes, code)), notes))
            }
            _ => self.flow(mnemonic, instruction, spot),
        }
    }

    /// All OROUT of a bit share one memory.
    fn or_out(&mut self, bit: u32) -> u32 {
        let found = self.out.ops.iter().find_map(|op| match op {
            Op::OrOut { bit: other, memory } if *other == bit => Some(*memory),
            _ => None,
        });
        found.unwrap_or_else(|| {
            self.out.counts.or_outs += 1;
            self.out.counts.or_outs - 1
        })
    }

    fn phase(&mut self) -> u32 {
        self.out.counts.phases += 1;
        self.out.counts.phases - 1
    }

    fn timer(&mut self, kind: TimerKind, instruction: &Instruction) -> Output {
        let bit = self.out.structure(instruction.operand(0), ElementType::Timer)?;
        let preset = self.out.preset(instruction.operand(1))?;
        let output = match kind {
            TimerKind::OnDelay | TimerKind::OffDelay => Some(self.out.coil(instruction.operand(2))?),
            _ => None,
        };
        let structure = self.structure(bit);
        let index = keep(&mut self.out.timers, TimerBox { kind, bit, preset, output, structure });
        let notes = if self.own(bit, index) { Vec::new() } else { vec![SHARED] };
        Ok((Op::Timer(index), notes))
    }

    fn counter(&mut self, kind: CounterKind, instruction: &Instruction) -> Output {
        let bit = self.out.structure(instruction.operand(0), ElementType::Counter)?;
        // What Designer writes for a preset that is not used.
        let unused = |text: &str| text.eq_ignore_ascii_case("DST511");
        let mut preset = |index: usize| {
            let text = instruction.operand(index);
            if text.is_empty() || unused(text) { Ok(None) } else { self.out.preset(text).map(Some) }
        };
        let (preset, down_preset) = (preset(1)?, preset(2)?);
        let structure = self.structure(bit);
        let edges = [self.edge(), self.edge()];
        let code = CounterBox { kind, bit, preset, down_preset, structure, edges };
        let index = keep(&mut self.out.counters, code);
        let notes = if self.own(bit, index) { Vec::new() } else { vec![SHARED] };
        Ok((Op::Counter(index), notes))
    }

    fn data(&mut self, mnemonic: &str, instruction: &Instruction) -> Result<(BoxCode, Vec<&'static str>), Why> {
        let text = |index: usize| instruction.operand(index);
        let out = &mut self.out;
        Ok(match mnemonic {
            "COPY" => {
                let cells = out.table(text(1), 4)?;
                let rows: Vec<String> =
                    cells.chunks(4).flat_map(|row| row.get(1..).unwrap_or_default()).cloned().collect();
                let plain = constant(text(0)) == Some(0) && cells.chunks(4).all(|row| constant(&row[0]) == Some(0));
                let mut notes = if plain { Vec::new() } else { vec![COPY_FLAGS] };
                if rows.iter().any(|cell| cell.contains(':')) {
                    notes.push(DATES);
                }
                (BoxCode::Copy(out.copies(&rows)?), notes)
            }
            "INIT" => {
                let cells = out.table(text(0), 3)?;
                let mut fills = Vec::new();
                for row in cells.chunks(3) {
                    let [first, last, value] = row else { return Err("expected rows of first, last, value".into()) };
                    let (place, stride, count) = out.ends(first, last)?;
                    out.target(first)?;
                    fills.push((place, stride, count, out.source(value)?));
                }
                (BoxCode::Fill(fills), Vec::new())
            }
            "MEMCOPY" => {
                if constant(text(2)) != Some(0x20000) {
                    return Err(format!("mode {} of MEMCOPY is not decoded", text(2)));
                }
                let from = out.span(text(0))?;
                // Memory as it is: a string goes into a string of the same length, nothing else does.
                let to = match (from, out.span(text(1))?) {
                    (Span::Fixed { first: source, .. }, to @ Span::Fixed { first, .. })
                        if matches!(source.kind, Kind::Text(_)) && source.kind == first.kind =>
                    {
                        to
                    }
                    (Span::Fixed { first: Place { kind: Kind::Text(_), .. }, .. }, _) => {
                        return Err(format!("{} is a string", text(0)));
                    }
                    _ => out.writable(text(1))?,
                };
                if matches!(from, Span::Constant(_)) {
                    return Err(format!("{}: expected an element", text(0)));
                }
                (BoxCode::RawCopy { from, to, count: out.source(text(3))? }, Vec::new())
            }
            "MEMCLEAR" => {
                let Span::Fixed { first, stride, room } = out.writable(text(0))? else {
                    return Err(format!("{}: a range found by index is not modelled", text(0)));
                };
                (BoxCode::Clear { first: first.bit, stride, room, count: out.source(text(1))? }, Vec::new())
            }
            "STRCLEAR" => {
                let Span::Fixed { first, stride, room } = out.span(text(0))? else {
                    return Err(format!("{}: expected a string", text(0)));
                };
                (BoxCode::Clear { first: first.bit, stride, room, count: out.source(text(1))? }, Vec::new())
            }
            "STRPRINT" => {
                if constant(text(1)) != Some(PRINT_OVER) || !text(3).is_empty() {
                    return Err(format!("flags {} of STRPRINT are not decoded", text(1)));
                }
                let to = out.text_place(text(0))?;
                let pieces = out.pieces(text(2))?;
                let notes = if pieces.len() > 1 { vec![PIECES] } else { Vec::new() };
                (BoxCode::Print { pieces, to }, notes)
            }
            "SCALE" => {
                let mut value = |index| out.source(text(index));
                let values = [value(0)?, value(1)?, value(2)?, value(3)?, value(4)?];
                (BoxCode::Scale { values, to: out.target(text(5))? }, Vec::new())
            }
            "CLAMP" => {
                let values = [out.source(text(0))?, out.source(text(1))?, out.source(text(2))?];
                (BoxCode::Clamp { values, to: out.target(text(3))? }, vec![CASTS])
            }
            "FILTER" => {
                let (factor, input) = (out.source(text(0))?, out.source(text(1))?);
                (BoxCode::Filter { factor, input, output: out.target(text(2))? }, vec![FILTER])
            }
            "FLASHER" | "DEBOUNCE" => {
                let times = [out.preset(text(0))?, out.preset(text(1))?];
                let output = out.coil(text(2))?;
                let memory = self.phase();
                if mnemonic == "FLASHER" {
                    (BoxCode::Flasher { times, output, memory }, vec![FLASHER])
                } else {
                    (BoxCode::Debounce { times, output, memory }, vec![DEBOUNCE])
                }
            }
            _ => {
                let (time, output) = (out.preset(text(0))?, out.coil(text(1))?);
                (BoxCode::TimedOut { time, output, memory: self.phase() }, vec![TIMED_OUT])
            }
        })
    }

    fn flow(&mut self, mnemonic: &str, instruction: &Instruction, spot: Spot) -> Output {
        let text = |index: usize| instruction.operand(index);
        let exact = |op| Ok((op, Vec::new()));
        match mnemonic {
            "NOP" | "END" => exact(Op::Nothing),
            "RET" => exact(Op::Return),
            "RETC" => exact(Op::ReturnIf),
            "EXIT" => exact(Op::Exit),
            "RUN" | "HALT" | "RESTART" | "SUSPEND" => {
                let block = self.code_block(text(0))?;
                let (action, notes) = match mnemonic {
                    "RUN" => (Action::Run, Vec::new()),
                    "HALT" => (Action::Halt, Vec::new()),
                    "RESTART" => (Action::Restart, vec![RESTARTED]),
                    _ => (Action::Suspend, vec![SUSPENDED]),
                };
                Ok((Op::Control(action, block), notes))
            }
            "CALL" => {
                let block = self.code_block(text(0))?;
                let mut list = |index: usize| match text(index) {
                    "" => Ok(Vec::new()),
                    table => {
                        let cells = self.out.table(table, 3)?;
                        self.out.copies(&cells)
                    }
                };
                let (inputs, outputs) = (list(3)?, list(4)?);
                exact(Op::Call(keep(&mut self.out.calls, CallCode { block, inputs, outputs })))
            }
            "SG" => {
                if !self.loops.is_empty() || !self.repeats.is_empty() {
                    return Err("a stage begins inside a loop".to_owned());
                }
                let bit = self.stage_bit(text(0))?;
                self.stage = Some(bit);
                let start = self.out.ops.len() as u32 + 1;
                exact(Op::Stage(keep(&mut self.out.stages, StageCode { bit, start, end: start })))
            }
            "JMP" => exact(Op::Jump { stage: self.stage_bit(text(0))?, own: self.stage }),
            "SGSET" | "SGRST" => {
                let bit = self.stage_bit(text(0))?;
                exact(Op::StageBits { first: bit, last: bit, on: mnemonic == "SGSET" })
            }
            "SGRSTR" => {
                let (first, last) = (self.stage_bit(text(0))?, self.stage_bit(text(1))?);
                if last < first || last - first >= crate::memory::STAGES {
                    return Err(format!("{} does not stand behind {} in one program", text(1), text(0)));
                }
                exact(Op::StageBits { first, last, on: false })
            }
            "SGDIVRG" => {
                let mut bits = Vec::new();
                for index in 0..instruction.operands.len() {
                    bits.push(self.stage_bit(text(index))?);
                }
                for bit in bits.drain(1.min(bits.len())..).collect::<Vec<_>>() {
                    self.emit(Op::Jump { stage: bit, own: self.stage }, spot);
                }
                let first = bits.first().copied().ok_or("expected a stage")?;
                exact(Op::Jump { stage: first, own: self.stage })
            }
            "FOR" => {
                if self.loops.len() >= MOST_LOOPS {
                    return Err(format!("more than {MOST_LOOPS} loops inside each other"));
                }
                let (variable, from, to) =
                    (self.out.target(text(0))?, self.out.source(text(1))?, self.out.source(text(2))?);
                let step = match text(3) {
                    "" => Source::Constant(Num::Int(1)),
                    step => self.out.source(step)?,
                };
                let body = self.out.ops.len() as u32 + 1;
                let code = ForCode { variable, from, to, step, next: body, body, level: self.loops.len() };
                let index = keep(&mut self.out.loops, code);
                self.loops.push(index);
                Ok((Op::For(index), vec![LOOP_END]))
            }
            "NEXT" => {
                let index = self.loops.pop().ok_or("there is no FOR before it")?;
                let here = self.out.ops.len() as u32;
                if let Some(code) = self.out.loops.get_mut(index as usize) {
                    code.next = here;
                }
                exact(Op::Next(index))
            }
            "REPEAT" => {
                self.repeats.push(self.out.ops.len() as u32 + 1);
                exact(Op::Nothing)
            }
            "UNTIL" => {
                let start = self.repeats.pop().ok_or("there is no REPEAT before it")?;
                let source = self.out.contact(text(0))?;
                exact(Op::Until { place: keep(&mut self.out.sources, source), start })
            }
            "INTCONFIG" => Err("interrupts are not modelled".to_owned()),
            "ENTASK" => Err("the text form of ENTASK is not known".to_owned()),
            other => Err(format!("{other} is not modelled")),
        }
    }
}
