//! Processing of timers, counters and data boxes.

use super::op::*;
use super::run::Core;
use super::state::Phase;
use crate::choices::Choice;
use crate::counter::{self, Counter, CounterInput, CounterKind};
use crate::memory::{Kind, Num, Place};
use crate::timer::{self, Timer, TimerInput, TimerKind};

/// Nanoseconds of a millisecond, the resolution of timers.
const MILLISECOND: u64 = 1_000_000;

/// A reset that waits for its box to be processed.
const PENDING: u64 = u64::MAX;

/// Characters the longest string holds.
const LONGEST_TEXT: usize = 256;

/// Flags stand behind .Acc.
const FLAGS: u32 = 32;

impl Core<'_> {
    fn preset(&mut self, source: Source) -> i32 {
        let value = self.number(source).integer(self.p.choices);
        value.clamp(i32::MIN.into(), i32::MAX.into()) as i32
    }

    /// Whether RSTT or RSTCT holds a structure now.
    fn held(&mut self, structure: u32) -> bool {
        let scan = self.s.scans + 1;
        let Some(reset) = self.s.resets.get_mut(structure as usize) else { return false };
        if *reset == PENDING {
            *reset = 0;
            return true;
        }
        *reset == scan
    }

    /// Processes a timer with the legs on the stack; the stack behind it.
    pub(crate) fn timer(&mut self, index: u32, stack: u64) -> u64 {
        let p = self.p;
        let Some(code) = p.timers.get(index as usize) else { return stack };
        let legs = match code.kind {
            TimerKind::Tmra | TimerKind::TmraDown => 2,
            _ => 1,
        };
        let enable = stack >> (legs - 1) & 1 != 0;
        let reset = (legs == 2 && stack & 1 != 0) | self.held(code.structure);
        let running = enable != (code.kind == TimerKind::OffDelay);
        let now = self.s.now;
        let Some(clock) = self.s.timers.get_mut(index as usize) else { return stack };
        let (starts, mut elapsed) = (clock.fresh, 0);
        if running {
            if clock.fresh {
                clock.last = now;
            } else {
                elapsed = now.saturating_sub(clock.last) / MILLISECOND;
                clock.last += elapsed * MILLISECOND;
            }
        }
        clock.fresh = !running;
        let preset = self.preset(code.preset);
        let mut state = Timer::unpack(self.s.data.dword(code.bit), self.s.data.byte(code.bit + FLAGS));
        let elapsed = elapsed.min(i32::MAX as u64) as i32;
        let input = TimerInput { enable, reset, starts, preset, elapsed };
        let output = timer::process(code.kind, &mut state, input, p.choices);
        self.s.data.set_dword(code.bit, state.acc);
        self.s.data.set_byte(code.bit + FLAGS, state.flags());
        if let Some(bit) = code.output {
            self.s.data.set_bit(bit, output);
        }
        stack >> (legs - 1)
    }

    fn put_timer_reset(&mut self, bit: u32, kind: TimerKind, preset: i32) {
        let mut state = Timer::unpack(self.s.data.dword(bit), self.s.data.byte(bit + FLAGS));
        state.set_reset(kind, preset);
        self.s.data.set_dword(bit, state.acc);
        self.s.data.set_byte(bit + FLAGS, state.flags());
    }

    pub(crate) fn reset_timer(&mut self, index: u32) {
        let p = self.p;
        let Some(reset) = p.resets.get(index as usize) else { return };
        if self.request(reset.structure) {
            return;
        }
        let owner = reset.owner.and_then(|owner| p.timers.get(owner as usize).map(|code| (owner, code)));
        let Some((owner, code)) = owner else {
            return self.put_timer_reset(reset.bit, TimerKind::Tmr, 0);
        };
        let preset = self.preset(code.preset);
        self.put_timer_reset(reset.bit, code.kind, preset);
        // One that stays enabled counts from here, as behind a reset by its leg.
        let now = self.s.now;
        if let Some(clock) = self.s.timers.get_mut(owner as usize) {
            clock.last = now;
        }
        if let Some(bit) = code.output {
            self.s.data.set_bit(bit, false);
        }
    }

    /// Notes a reset; `true` when it waits for the box.
    fn request(&mut self, structure: u32) -> bool {
        let waits = self.p.choices.has(Choice::ResetWhenProcessed);
        let scan = self.s.scans + 1;
        if let Some(reset) = self.s.resets.get_mut(structure as usize) {
            *reset = if waits { PENDING } else { scan };
        }
        waits
    }

    pub(crate) fn terminate_timer(&mut self, index: u32) {
        let p = self.p;
        let Some(code) = p.timers.get(index as usize) else { return };
        if let Some(clock) = self.s.timers.get_mut(index as usize) {
            clock.fresh = true;
        }
        if code.kind == TimerKind::Tmrag {
            return;
        }
        let preset = self.preset(code.preset);
        self.put_timer_reset(code.bit, code.kind, preset);
        if let Some(bit) = code.output {
            self.s.data.set_bit(bit, false);
        }
    }

    /// Processes a counter with the legs on the stack; the stack behind it.
    pub(crate) fn counter(&mut self, index: u32, stack: u64) -> u64 {
        let p = self.p;
        let Some(code) = p.counters.get(index as usize) else { return stack };
        let leg = |from_top: u64| stack >> from_top & 1 != 0;
        let (count, down, reset, legs) = match code.kind {
            CounterKind::Cnt | CounterKind::CntDown => (leg(1), false, leg(0), 2),
            CounterKind::Udc => (leg(2), leg(1), leg(0), 3),
            CounterKind::Udcg => (leg(1), leg(0), false, 2),
        };
        // The edge memories follow their legs during a reset too.
        let input = CounterInput {
            count: self.edge(code.edges[0], count, true),
            down: self.edge(code.edges[1], down, true),
            reset: reset | self.held(code.structure),
            preset: code.preset.map(|preset| self.preset(preset)),
            down_preset: code.down_preset.map(|preset| self.preset(preset)),
        };
        let mut state = Counter::unpack(self.s.data.dword(code.bit), self.s.data.byte(code.bit + FLAGS));
        counter::process(code.kind, &mut state, input);
        self.s.data.set_dword(code.bit, state.acc);
        self.s.data.set_byte(code.bit + FLAGS, state.flags());
        stack >> (legs - 1)
    }

    fn put_counter_reset(&mut self, code: Option<&CounterBox>, bit: u32) {
        let kind = code.map_or(CounterKind::Cnt, |code| code.kind);
        let preset = code.and_then(|code| code.preset).map(|preset| self.preset(preset));
        let down_preset = code.and_then(|code| code.down_preset).map(|preset| self.preset(preset));
        let mut state = Counter::default();
        counter::process(
            kind,
            &mut state,
            CounterInput { reset: true, preset, down_preset, ..CounterInput::default() },
        );
        self.s.data.set_dword(bit, state.acc);
        self.s.data.set_byte(bit + FLAGS, state.flags());
    }

    pub(crate) fn reset_counter(&mut self, index: u32) {
        let p = self.p;
        let Some(reset) = p.resets.get(index as usize) else { return };
        if !self.request(reset.structure) {
            let owner = reset.owner.and_then(|owner| p.counters.get(owner as usize));
            self.put_counter_reset(owner, reset.bit);
        }
    }

    pub(crate) fn terminate_counter(&mut self, index: u32) {
        let p = self.p;
        let Some(code) = p.counters.get(index as usize) else { return };
        code.edges.into_iter().for_each(|memory| self.forget(memory));
        if code.kind != CounterKind::Udcg {
            self.put_counter_reset(Some(code), code.bit);
        }
    }

    pub(crate) fn terminate_box(&mut self, index: u32) {
        let p = self.p;
        if let Some(
            BoxCode::Flasher { output, memory, .. }
            | BoxCode::Debounce { output, memory, .. }
            | BoxCode::TimedOut { output, memory, .. },
        ) = p.boxes.get(index as usize)
        {
            self.s.data.set_bit(*output, false);
            if let Some(phase) = self.s.phases.get_mut(*memory as usize) {
                *phase = Phase::default();
            }
        }
    }

    fn milliseconds(&mut self, source: Source) -> u64 {
        let value = self.number(source).integer(self.p.choices);
        u64::try_from(value).unwrap_or(0).saturating_mul(MILLISECOND)
    }

    pub(crate) fn process_box(&mut self, index: u32, on: bool) {
        let p = self.p;
        let Some(code) = p.boxes.get(index as usize) else { return };
        match code {
            BoxCode::Flasher { times, output, memory } => self.flasher(*times, *output, *memory, on),
            BoxCode::Debounce { times, output, memory } => self.debounce(*times, *output, *memory, on),
            BoxCode::TimedOut { time, output, memory } => self.timed_out(*time, *output, *memory, on),
            _ if !on => {}
            BoxCode::Copy(rows) => self.copy_rows(rows),
            BoxCode::Print { pieces, to } => {
                let (mut text, mut length) = ([0u8; LONGEST_TEXT], 0);
                for piece in pieces {
                    let characters = match piece {
                        Piece::Literal(characters) => characters,
                        Piece::Text(place) => self.s.data.characters(*place),
                    };
                    let room = text.get_mut(length..).unwrap_or_default();
                    let taken = characters.len().min(room.len());
                    room.iter_mut().zip(characters).for_each(|(to, from)| *to = *from);
                    length += taken;
                }
                self.s.data.set_characters(*to, text.get(..length).unwrap_or_default());
            }
            BoxCode::RawCopy { from, to, count } => self.raw_copy(*from, *to, *count),
            BoxCode::Fill(fills) => {
                for (first, stride, count, value) in fills {
                    let value = self.number(*value);
                    for number in 0..*count {
                        let place = Place { bit: first.bit + number * stride, ..*first };
                        self.s.data.store(place, value, p.choices);
                    }
                }
            }
            BoxCode::Clear { first, stride, room, count } => {
                if let Some(count) = self.count(*count, *room) {
                    (*first..first + count * stride).for_each(|bit| self.s.data.set_bit(bit, false));
                }
            }
            BoxCode::Scale { values, to } => {
                let [input, least, most, low, high] = values.map(|value| self.number(value).real());
                if most == least {
                    self.s.troubles += 1;
                    return;
                }
                let scaled = (input - least) / (most - least) * (high - low) + low;
                self.store(*to, Num::Real(scaled));
            }
            BoxCode::Clamp { values, to } => {
                let [input, a, b] = values.map(|value| self.number(value));
                let (low, high) = if a.real() <= b.real() { (a, b) } else { (b, a) };
                let limited = match input.real() {
                    value if value < low.real() => low,
                    value if value > high.real() => high,
                    _ => input,
                };
                self.store(*to, limited);
            }
            BoxCode::Filter { factor, input, output } => {
                let present = match output {
                    Target::Place(place) => Source::Place(*place),
                    Target::Indexed(index) => Source::Indexed(*index),
                };
                let (present, input) = (self.number(present).real(), self.number(*input).real());
                let factor = self.number(*factor).real().max(1.0);
                self.store(*output, Num::Real(present + (input - present) / factor));
            }
        }
    }

    /// A count from 0 to `room`; outside it nothing is done and the trouble counted.
    fn count(&mut self, source: Source, room: u32) -> Option<u32> {
        let count = self.number(source).integer(self.p.choices);
        let count = u32::try_from(count).ok().filter(|count| *count <= room);
        if count.is_none() {
            self.s.troubles += 1;
        }
        count
    }

    /// First element, stride and room of a span.
    fn reach(&mut self, span: Span) -> Option<(Place, u32, u32)> {
        match span {
            Span::Fixed { first, stride, room } => Some((first, stride, room)),
            Span::Indexed { first, stride, end } => {
                let place = self.indexed(first)?;
                Some((place, stride, end.saturating_sub(place.bit) / stride.max(1)))
            }
            Span::Constant(_) => None,
        }
    }

    pub(crate) fn copy_rows(&mut self, rows: &[CopyRow]) {
        for row in rows {
            let Some((to, to_stride, to_room)) = self.reach(row.to) else { continue };
            if let Span::Constant(value) = row.from {
                if let Some(count) = self.count(row.count, to_room) {
                    for number in 0..count {
                        self.s.data.store(Place { bit: to.bit + number * to_stride, ..to }, value, self.p.choices);
                    }
                }
                continue;
            }
            let Some((from, from_stride, from_room)) = self.reach(row.from) else { continue };
            let Some(count) = self.count(row.count, to_room.min(from_room)) else { continue };
            let backward = to.bit > from.bit;
            for step in 0..count {
                // From the end where source and destination could overlap upwards: as if buffered.
                let number = if backward { count - 1 - step } else { step };
                let value = self.s.data.number(Place { bit: from.bit + number * from_stride, ..from });
                self.s.data.store(Place { bit: to.bit + number * to_stride, ..to }, value, self.p.choices);
            }
        }
    }

    fn raw_copy(&mut self, from: Span, to: Span, count: Source) {
        let (Some((from, stride, room)), Some((to, to_stride, to_room))) = (self.reach(from), self.reach(to)) else {
            return;
        };
        let Some(count) = self.count(count, room) else { return };
        let bits = count * stride;
        if u64::from(bits) > u64::from(to_room) * u64::from(to_stride) {
            self.s.troubles += 1;
            return;
        }
        let bytes = from.kind != Kind::Bit && to.kind != Kind::Bit;
        if bytes {
            let (start, length, target) = ((from.bit >> 3) as usize, (bits >> 3) as usize, (to.bit >> 3) as usize);
            let data = self.s.data.bytes_mut();
            if start + length <= data.len() && target + length <= data.len() {
                data.copy_within(start..start + length, target);
            }
            return;
        }
        for step in 0..bits {
            let number = if to.bit > from.bit { bits - 1 - step } else { step };
            let on = self.s.data.bit(from.bit + number);
            self.s.data.set_bit(to.bit + number, on);
        }
    }

    fn flasher(&mut self, times: [Source; 2], output: u32, memory: u32, on: bool) {
        let (now, lit, dark) = (self.s.now, self.milliseconds(times[0]), self.milliseconds(times[1]));
        let Some(phase) = self.s.phases.get_mut(memory as usize) else { return };
        if !on {
            *phase = Phase::default();
        } else if !phase.active {
            *phase = Phase { active: true, since: now };
        }
        let period = lit.saturating_add(dark);
        let passed = now.saturating_sub(phase.since);
        let shines = on && (period == 0 || passed % period < lit);
        self.s.data.set_bit(output, shines);
    }

    fn debounce(&mut self, times: [Source; 2], output: u32, memory: u32, on: bool) {
        let (now, present) = (self.s.now, self.s.data.bit(output));
        let wait = if on { self.milliseconds(times[0]) } else { self.milliseconds(times[1]) };
        let Some(phase) = self.s.phases.get_mut(memory as usize) else { return };
        if on == present {
            *phase = Phase::default();
            return;
        }
        if !phase.active {
            *phase = Phase { active: true, since: now };
        }
        if now.saturating_sub(phase.since) >= wait {
            *phase = Phase::default();
            self.s.data.set_bit(output, on);
        }
    }

    fn timed_out(&mut self, time: Source, output: u32, memory: u32, on: bool) {
        let (now, time) = (self.s.now, self.milliseconds(time));
        let Some(phase) = self.s.phases.get_mut(memory as usize) else { return };
        // `active` is the power flow of the last scan; the time runs from its rise.
        if on && !phase.active {
            phase.since = now;
            self.s.data.set_bit(output, true);
        } else if now.saturating_sub(phase.since) >= time {
            self.s.data.set_bit(output, false);
        }
        phase.active = on;
    }
}
