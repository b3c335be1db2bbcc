//! MSG: the handshake bits around an exchange with a partner.

use super::{Core, Exec};
use crate::family::Lineage;
use crate::op::Message;
use crate::peer::{PeerAnswer, PeerRequest};

const ENABLE: u16 = 1 << 15;
const START: u16 = 1 << 14;
const DONE: u16 = 1 << 13;
const ERROR: u16 = 1 << 12;
const CONTINUOUS: u16 = 1 << 11;
const WAITING: u16 = 1 << 10;
const NO_RESPONSE: u16 = 1 << 9;
const TIMED_OUT: u16 = 1 << 8;

/// Error code of a message that was never answered.
const NO_ANSWER: u8 = 0x37;

/// Time-out when the block holds none, in seconds.
const DEFAULT_TIMEOUT: u64 = 5;
const SECOND: u64 = 1_000_000_000;

/// Where the bits of a message stand: on SLC in one word, on MicroLogix in two and a word for the code.
struct Places {
    /// EN and TO.
    enable: u32,
    /// ST, DN, ER, EW.
    state: u32,
    code: u32,
    timeout: u64,
}

impl Core<'_> {
    fn message_places(&self, at: u32, slc: bool) -> Places {
        if slc {
            return Places { enable: at, state: at, code: at, timeout: DEFAULT_TIMEOUT };
        }
        let seconds = u64::from(self.word(at + 10));
        let timeout = if seconds == 0 { DEFAULT_TIMEOUT } else { seconds };
        Places { enable: at + 16, state: at + 17, code: at + 18, timeout }
    }

    pub(crate) fn message(&mut self, message: &Message, power: bool) -> Exec<()> {
        let (at, end) = self.start(message.at)?;
        let places = self.message_places(at, message.slc);
        let enabled = self.word(places.enable) & ENABLE != 0;
        let slot = self.s.messages.get(message.id as usize).copied().unwrap_or_default();
        if !slot.active {
            if power && !enabled {
                return self.begin(message, at, end, &places);
            }
            if !power && self.word(places.state) & (DONE | ERROR) != 0 {
                self.put_bits(places.enable, ENABLE, false);
            }
            return Ok(());
        }
        if self.word(places.enable) & TIMED_OUT != 0 {
            self.finish_message(message, &places, Some(NO_ANSWER), power);
            return Ok(());
        }
        let answer = self.peer.request(PeerRequest::MessagePending { id: message.id });
        self.answered(message, &places, answer, power)
    }

    fn begin(&mut self, message: &Message, at: u32, end: u32, places: &Places) -> Exec<()> {
        self.put_bits(places.state, START | DONE | ERROR | NO_RESPONSE, false);
        self.put_bits(places.enable, TIMED_OUT, false);
        self.put_code(message, places, 0);
        self.put_bits(places.enable, ENABLE, true);
        self.put_bits(places.state, WAITING, true);
        let now = self.s.now;
        if let Some(slot) = self.s.messages.get_mut(message.id as usize) {
            (slot.active, slot.started) = (true, now);
        }
        let (from, to) = match message.local {
            Some(local) => self.start(local)?,
            None => (0, 0),
        };
        let words = |from: u32, to: u32| self.s.mem.get(from as usize..to.max(from) as usize).unwrap_or_default();
        let block = words(at, end.min(at + if message.slc { 14 } else { 25 }));
        let request = PeerRequest::Message { id: message.id, setup: &message.setup, block, local: words(from, to) };
        let answer = self.peer.request(request);
        self.answered(message, places, answer, true)
    }

    fn answered(&mut self, message: &Message, places: &Places, answer: PeerAnswer, power: bool) -> Exec<()> {
        match answer {
            PeerAnswer::Absent => {
                let started = self.s.messages.get(message.id as usize).map_or(0, |slot| slot.started);
                if self.s.now.saturating_sub(started) >= places.timeout * SECOND {
                    self.finish_message(message, places, Some(NO_ANSWER), power);
                }
            }
            PeerAnswer::Pending => {
                self.put_bits(places.state, START, true);
                self.put_bits(places.state, WAITING, false);
            }
            PeerAnswer::Error(code) => self.finish_message(message, places, Some(code), power),
            PeerAnswer::Done | PeerAnswer::Bytes(_) => self.finish_message(message, places, None, power),
            PeerAnswer::Words(words) => {
                if let Some(local) = message.local {
                    let (from, to) = self.start(local)?;
                    let area = self.s.mem.get_mut(from as usize..to.max(from) as usize).unwrap_or_default();
                    area.iter_mut().zip(words).for_each(|(place, word)| *place = word);
                }
                self.finish_message(message, places, None, power);
            }
        }
        Ok(())
    }

    fn finish_message(&mut self, message: &Message, places: &Places, error: Option<u8>, power: bool) {
        self.put_bits(places.state, START | WAITING, false);
        self.put_bits(places.state, if error.is_some() { ERROR } else { DONE }, true);
        self.put_code(message, places, error.unwrap_or(0));
        let continuous = message.slc && self.word(places.state) & CONTINUOUS != 0;
        if !power || continuous || self.p.traits.lineage == Lineage::M10 {
            self.put_bits(places.enable, ENABLE, false);
        }
        if let Some(slot) = self.s.messages.get_mut(message.id as usize) {
            slot.active = false;
        }
    }

    fn put_code(&mut self, message: &Message, places: &Places, code: u8) {
        let word = self.word(places.code);
        self.put(places.code, if message.slc { word & 0xFF00 } else { 0 } | u16::from(code));
    }
}
