//! String instructions and the ASCII port instructions.

use instr::exec::Number;
use instr::exec::control::bit::{DONE, EMPTY, ENABLE, ENABLE_UNLOAD, ERROR, FOUND, INHIBIT, UNLOAD};
use instr::exec::text::{self, StringError, Text};

use super::{Core, Exec};
use crate::op::*;
use crate::peer::{PeerAnswer, PeerRequest};
use crate::status;
use ladder::Family;

/// End of a line and what AWA appends, as channels are set up unless changed.
const LINE_END: &[u8] = b"\r";
const APPENDED: &[u8] = b"\r\n";

impl Core<'_> {
    fn string(&mut self, start: Start) -> Exec<&[u16]> {
        let (at, end) = self.start(start)?;
        let at = at as usize;
        let end = (at + text::WORDS).min(end as usize);
        Ok(self.s.mem.get(at..end.max(at)).unwrap_or_default())
    }

    fn put_string(&mut self, start: Start, string: &Text) -> Exec<()> {
        let (at, end) = self.start(start)?;
        let rules = self.p.rules;
        let at = at as usize;
        let end = (at + text::WORDS).min(end as usize);
        string.write(self.s.mem.get_mut(at..end.max(at)).unwrap_or_default(), rules);
        Ok(())
    }

    /// S:5/15; MicroLogix 1100 and 1400 also name the error in S:6.
    fn string_error(&mut self) {
        let minor = self.status(status::MINOR);
        self.set_status(status::MINOR, minor | status::STRING_ERROR);
        if matches!(self.p.family, Family::MicroLogix1100 | Family::MicroLogix1400) {
            self.set_status(status::FAULT_CODE, text::STRING_FAULT);
        }
    }

    /// What a string function gives, or the string error.
    fn checked<T>(&mut self, result: Result<T, StringError>) -> Option<T> {
        if result.is_err() {
            self.string_error();
        }
        result.ok()
    }

    pub(crate) fn strings_equal(&mut self, a: Start, b: Start) -> Exec<bool> {
        let a = Text::read(self.string(a)?);
        let b = Text::read(self.string(b)?);
        let equal = a.and_then(|a| b.map(|b| a == b));
        Ok(self.checked(equal).unwrap_or(false))
    }

    pub(crate) fn string_to_integer(&mut self, source: Start, dest: Target) -> Exec<()> {
        let (to, mode) = (self.kind(dest), self.p.rules.math(self.status(status::CONTROL)));
        let result = text::aci(self.string(source)?, to, mode);
        match self.checked(result).flatten() {
            Some(outcome) => self.leave(dest, outcome),
            None => Ok(()),
        }
    }

    pub(crate) fn integer_to_string(&mut self, source: Source, dest: Start) -> Exec<()> {
        let value = self.load(source)?;
        let mode = self.p.rules.math(self.status(status::CONTROL));
        self.put_string(dest, &text::aic(value, mode))
    }

    pub(crate) fn concatenate(&mut self, a: Start, b: Start, dest: Start) -> Exec<()> {
        let a = Text::read(self.string(a)?);
        let b = Text::read(self.string(b)?);
        let both = a.and_then(|a| b.map(|b| (a, b)));
        let Some((a, b)) = self.checked(both) else { return Ok(()) };
        let (joined, cut) = Text::cut(a.characters().iter().chain(b.characters()).copied());
        if cut {
            self.string_error();
        }
        self.put_string(dest, &joined)
    }

    pub(crate) fn extract(&mut self, source: Start, index: Source, number: Source, dest: Start) -> Exec<()> {
        let (index, number) = (self.integer(index)?, self.integer(number)?);
        let rules = self.p.rules;
        let result = text::aex(self.string(source)?, index, number, rules);
        match self.checked(result) {
            Some(found) => self.put_string(dest, &found),
            None => Ok(()),
        }
    }

    pub(crate) fn search(&mut self, source: Start, index: Source, within: Start, dest: Target) -> Exec<()> {
        let index = self.integer(index)?;
        let wanted = Text::read(self.string(source)?);
        let searched = Text::read(self.string(within)?);
        let result = wanted.and_then(|wanted| {
            let mut words = [[0u16; text::WORDS]; 2];
            let rules = self.p.rules;
            wanted.write(&mut words[0], rules);
            searched?.write(&mut words[1], rules);
            text::asc(&words[0], index, &words[1])
        });
        match self.checked(result) {
            Some(position) => {
                let number = Number::Word(position);
                let mode = self.p.rules.math(self.status(status::CONTROL));
                let stored = instr::exec::logic::mov(number, self.kind(dest), mode).value.unwrap_or(number);
                self.store(dest, stored)
            }
            None => Ok(()),
        }
    }

    /// One execution of a port instruction: starts on a rising rung, then waits in the background.
    pub(crate) fn port(&mut self, request: &Port, power: bool) -> Exec<()> {
        let (at, _) = self.start(request.control)?;
        let control = self.word(at);
        let running = control & INHIBIT != 0;
        if !power && !running {
            self.put_bits(at, ENABLE | ENABLE_UNLOAD, false);
            return Ok(());
        }
        if !running {
            if control & ENABLE != 0 {
                return Ok(());
            }
            self.put_bits(at, DONE | EMPTY | ERROR | FOUND | 0xFF, false);
            self.put_bits(at, ENABLE | ENABLE_UNLOAD | INHIBIT, true);
            self.put(at + 2, 0);
        } else if control & UNLOAD != 0 {
            self.put_bits(at, INHIBIT | ENABLE_UNLOAD, false);
            self.put_bits(at, ERROR, true);
            return Ok(());
        }
        match self.exchange(request, at)? {
            Some(true) => {
                self.put_bits(at, INHIBIT | ENABLE_UNLOAD, false);
                self.put_bits(at, DONE | EMPTY, true);
            }
            Some(false) => {
                self.put_bits(at, INHIBIT | ENABLE_UNLOAD, false);
                self.put_bits(at, ERROR, true);
            }
            None => {}
        }
        Ok(())
    }

    /// `None`: still waiting; `Some(false)`: failed.
    fn exchange(&mut self, request: &Port, at: u32) -> Exec<Option<bool>> {
        let channel = request.channel;
        let sent = |answer: PeerAnswer| match answer {
            PeerAnswer::Absent | PeerAnswer::Error(_) => Some(false),
            PeerAnswer::Pending => None,
            _ => Some(true),
        };
        match request.what {
            PortAction::Handshake => {
                let (and, or) = request.masks.unwrap_or((Source::Integer(-1), Source::Integer(0)));
                let (and, or) = (self.word_of(and)? as u16, self.word_of(or)? as u16);
                Ok(sent(self.peer.request(PeerRequest::Handshake { channel, and, or })))
            }
            PortAction::Write | PortAction::WriteAppend => {
                let Some(string) = request.string else { return Ok(Some(false)) };
                let read = Text::read(self.string(string)?);
                let Some(read) = self.checked(read) else { return Ok(Some(false)) };
                let length = usize::try_from(self.word(at + 1) as i16).unwrap_or(0);
                let length = if length == 0 { read.characters().len() } else { length.min(read.characters().len()) };
                let characters = read.characters().iter().take(length);
                let appended = if request.what == PortAction::WriteAppend { APPENDED } else { &[] };
                let mut bytes = [0u8; text::CAPACITY + APPENDED.len()];
                let mut count = 0;
                for (place, byte) in bytes.iter_mut().zip(characters.chain(appended)) {
                    *place = *byte;
                    count += 1;
                }
                let bytes = bytes.get(..count).unwrap_or_default();
                let answer = sent(self.peer.request(PeerRequest::Send { channel, bytes }));
                if answer == Some(true) {
                    self.put(at + 2, count as u16);
                }
                Ok(answer)
            }
            PortAction::TestLine | PortAction::CountCharacters | PortAction::Read | PortAction::ReadLine => {
                let buffer = match self.peer.request(PeerRequest::Receive { channel }) {
                    PeerAnswer::Bytes(bytes) => bytes,
                    PeerAnswer::Pending => return Ok(None),
                    _ => return Ok(Some(false)),
                };
                self.received(request, at, &buffer)
            }
        }
    }

    fn received(&mut self, request: &Port, at: u32, buffer: &[u8]) -> Exec<Option<bool>> {
        let length = usize::try_from(self.word(at + 1) as i16).unwrap_or(0).min(text::CAPACITY);
        let length = if length == 0 { text::CAPACITY } else { length };
        let line = text::line_length(buffer, LINE_END);
        let count = match request.what {
            PortAction::TestLine => {
                self.put_bits(at, FOUND, line.is_some());
                self.put(at + 2, line.unwrap_or(0).min(usize::from(u16::MAX)) as u16);
                return Ok(Some(true));
            }
            PortAction::CountCharacters => {
                self.put_bits(at, FOUND, !buffer.is_empty());
                self.put(at + 2, buffer.len().min(usize::from(u16::MAX)) as u16);
                return Ok(Some(true));
            }
            PortAction::ReadLine => match line {
                Some(line) => line.min(length),
                None if buffer.len() >= length => length,
                None => return Ok(None),
            },
            _ if buffer.len() >= length => length,
            _ => return Ok(None),
        };
        let Some(string) = request.string else { return Ok(Some(false)) };
        let (taken, _) = Text::cut(buffer.iter().take(count).copied());
        self.put_string(string, &taken)?;
        self.put(at + 2, count as u16);
        self.peer.request(PeerRequest::Take { channel: request.channel, count });
        Ok(Some(true))
    }

    pub(crate) fn clear_port(&mut self, channel: u16, transmit: bool, receive: bool) {
        self.peer.request(PeerRequest::Clear { channel, transmit, receive });
    }
}
