//! The set-up record behind a message instruction.

use crate::archive::{Reader, Writer};
use crate::error::Result;
use crate::text::Text;
use std::borrow::Cow;

/// Message settings as the set-up dialog shows them. Fields `m0` to `m10` have
/// no known meaning and are numbered in stored order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MessageSetup<'a> {
    /// 0 for Modbus, 1 for CIP Generic. Meaning unknown.
    pub m0: u32,
    /// 0. Meaning unknown.
    pub m1: u16,
    /// Control bits as last displayed: EN 0x80, ST 0x40, DN 0x20, ER 0x10, EW 0x04, TO 0x01. Inferred.
    pub status: u16,
    /// 0. Meaning unknown.
    pub m2: u32,
    /// Communication command as displayed.
    pub command: Text<'a>,
    /// Channel number. Inferred.
    pub channel: u16,
    /// Message timeout in seconds, as text. Inferred.
    pub timeout: Text<'a>,
    /// Size in elements, as text. Inferred.
    pub size: Text<'a>,
    /// Zeros: a u32, or empty strings. Meaning unknown.
    pub m3: [u8; 4],
    /// Data address in the target. Inferred.
    pub target: Text<'a>,
    /// Data address in this controller.
    pub local: Text<'a>,
    /// Zeros, as `m3`.
    pub m4: [u8; 4],
    /// `0`. Meaning unknown.
    pub m5: Text<'a>,
    /// Node as last displayed. Inferred.
    pub node: Text<'a>,
    /// `0`. Meaning unknown.
    pub m6: Text<'a>,
    /// Address of the target, as text. Inferred.
    pub host: Text<'a>,
    /// `0`. Meaning unknown.
    pub m7: Text<'a>,
    /// `0`. Meaning unknown.
    pub m8: Text<'a>,
    /// Empty. Meaning unknown.
    pub m9: Text<'a>,
    /// 20 for Modbus, 30 for CIP Generic. Meaning unknown.
    pub m10: u32,
    /// Path to the target.
    pub hops: Vec<PathHop<'a>>,
    /// Element of the routing information file.
    pub routing: Text<'a>,
    /// Present for CIP Generic.
    pub cip: Option<CipTail<'a>>,
}

/// One hop of a message's path (class `CASAPathHop`).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathHop<'a> {
    /// 4. Meaning unknown.
    pub h0: u32,
    /// Address of the hop, as text.
    pub address: Text<'a>,
    /// 1, 0, 0. Meaning unknown.
    pub h1: [u32; 3],
}

/// What follows the common settings in a CIP Generic message.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CipTail<'a> {
    /// 1. Meaning unknown.
    pub g0: u32,
    /// Service code, hexadecimal text.
    pub service: Text<'a>,
    /// Class, instance, attribute as decimal text.
    pub path_decimal: [Text<'a>; 3],
    /// The same in hexadecimal text.
    pub path_hex: [Text<'a>; 3],
    /// Length in bytes, as text.
    pub length: Text<'a>,
    /// Data table address.
    pub data: Text<'a>,
    /// Cached data of unknown meaning.
    pub blob: Cow<'a, [u8]>,
}

/// How sure it is that an opcode carries a set-up record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Presence {
    /// Seen with every compiled instance.
    Seen {
        /// Whether the CIP tail was seen with it.
        cip: bool,
    },
    /// The instruction is known to send messages, but no instance has been read.
    Possible,
}

impl<'a> MessageSetup<'a> {
    /// The opcodes that can carry the record.
    pub(super) fn presence(opcode: u16) -> Option<Presence> {
        match opcode {
            0x9C => Some(Presence::Seen { cip: false }),
            0xB6 => Some(Presence::Seen { cip: true }),
            0xB3 => Some(Presence::Possible),
            _ => None,
        }
    }

    /// Reads the record if it is there. Whether it is, and whether its CIP tail
    /// is, follows from the bytes: another object must come next, because the
    /// end mark of its leg follows every instruction.
    #[cold]
    pub(super) fn read_optional(r: &mut Reader<'a>, presence: Presence, compiled: bool) -> Result<Option<Box<Self>>> {
        let expected = presence != Presence::Possible && compiled;
        if r.at_object() {
            if expected {
                r.deviation("a message set-up record", "the next object")?;
            }
            return Ok(None);
        }
        let start = r.checkpoint();
        r.enter_named("message set-up")?;
        let read = Self::read(r);
        match read {
            Ok(setup) => {
                r.leave();
                let as_seen = presence == Presence::Seen { cip: setup.cip.is_some() };
                if !(as_seen && compiled) {
                    let kind = if setup.cip.is_some() { "with a CIP tail" } else { "without a CIP tail" };
                    let code = if compiled { "compiled" } else { "not compiled" };
                    r.deviation(
                        "a message set-up record of a form seen before",
                        format_args!("one {kind}, of an instruction {code}"),
                    )?;
                }
                Ok(Some(Box::new(setup)))
            }
            Err(e) if expected => Err(e),
            Err(_) => {
                // An instruction that may or may not carry the record: leave it,
                // and let whoever reads on say what does not fit.
                r.rewind(&start);
                Ok(None)
            }
        }
    }

    fn read(r: &mut Reader<'a>) -> Result<Self> {
        let mut out = MessageSetup {
            m0: r.u32("m0")?,
            m1: r.u16("m1")?,
            status: r.u16("the message status")?,
            m2: r.u32("m2")?,
            command: r.string("the communication command")?,
            channel: r.u16("the channel")?,
            timeout: r.string("the message timeout")?,
            size: r.string("the size in elements")?,
            m3: r.array("m3")?,
            target: r.string("the target address")?,
            local: r.string("the local address")?,
            m4: r.array("m4")?,
            m5: r.string("m5")?,
            node: r.string("the node")?,
            m6: r.string("m6")?,
            host: r.string("the host")?,
            m7: r.string("m7")?,
            m8: r.string("m8")?,
            m9: r.string("m9")?,
            m10: r.u32("m10")?,
            ..MessageSetup::default()
        };
        let hops = r.count("a number of hops", 2 + 17)?;
        for index in 0..hops {
            r.enter("hop", index)?;
            r.expect_object("CASAPathHop")?;
            out.hops.push(PathHop {
                h0: r.u32("h0")?,
                address: r.string("the address of the hop")?,
                h1: [r.u32("h1")?, r.u32("h2")?, r.u32("h3")?],
            });
            r.leave();
        }
        out.routing = r.string("the routing element")?;
        if !r.at_object() {
            out.cip = Some(CipTail::read(r)?);
        }
        Ok(out)
    }

    pub(super) fn write(&self, w: &mut Writer) -> Result<()> {
        w.u32(self.m0);
        w.u16(self.m1);
        w.u16(self.status);
        w.u32(self.m2);
        w.string(&self.command)?;
        w.u16(self.channel);
        w.string(&self.timeout)?;
        w.string(&self.size)?;
        w.bytes(&self.m3);
        w.string(&self.target)?;
        w.string(&self.local)?;
        w.bytes(&self.m4);
        for text in [&self.m5, &self.node, &self.m6, &self.host, &self.m7, &self.m8, &self.m9] {
            w.string(text)?;
        }
        w.u32(self.m10);
        w.count(self.hops.len())?;
        for hop in &self.hops {
            w.object("CASAPathHop");
            w.u32(hop.h0);
            w.string(&hop.address)?;
            hop.h1.iter().for_each(|&field| w.u32(field));
        }
        w.string(&self.routing)?;
        self.cip.as_ref().map_or(Ok(()), |cip| cip.write(w))
    }
}

impl<'a> CipTail<'a> {
    fn read(r: &mut Reader<'a>) -> Result<Self> {
        r.enter_named("CIP tail")?;
        let out = CipTail {
            g0: r.u32("g0")?,
            service: r.string("the service code")?,
            path_decimal: [r.string("the class")?, r.string("the instance")?, r.string("the attribute")?],
            path_hex: [
                r.string("the class in hex")?,
                r.string("the instance in hex")?,
                r.string("the attribute in hex")?,
            ],
            length: r.string("the length")?,
            data: r.string("the data address")?,
            blob: {
                let length = r.count_u32("the size of the cached data", 1)?;
                Cow::Borrowed(r.bytes("cached data", length)?)
            },
        };
        r.leave();
        Ok(out)
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.u32(self.g0);
        w.string(&self.service)?;
        for text in self.path_decimal.iter().chain(&self.path_hex).chain([&self.length, &self.data]) {
            w.string(text)?;
        }
        w.count_u32(self.blob.len())?;
        w.bytes(&self.blob);
        Ok(())
    }
}
