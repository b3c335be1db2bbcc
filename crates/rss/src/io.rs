//! `IO CONFIGURATION`: the base unit and the modules in its slots, in the two forms that exist.

mod forms;

use self::forms::{read_form, read_slots, write_packed, write_slots};
use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::processor::Model;
use crate::tables::{BaseUnit, IoForm, ModuleIdentity, processor_model};

/// The `CIOInfo` record. Evidence per field: `docs/format/project-streams.md`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct IoConfiguration<'a> {
    /// Model, as in `PROCESSOR` (proven).
    pub model: Model,
    /// The rest, in the form of the model.
    pub layout: IoLayout<'a>,
}

/// Form of the record after the model code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum IoLayout<'a> {
    /// Packed module records (MicroLogix 1100, 1200, 1400).
    Packed(PackedIo),
    /// Fixed table of 31 slots (SLC 500 fixed, MicroLogix 1000).
    Slots(SlotIo<'a>),
    /// Neither; carried as bytes.
    Opaque(&'a [u8]),
}

impl Default for IoLayout<'_> {
    fn default() -> Self {
        IoLayout::Opaque(&[])
    }
}

/// Packed form (proven for models 57 and 60 to 63).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PackedIo {
    /// Slots in use, slot 0 included.
    pub slot_count: u16,
    /// 0 (unknown).
    pub word_1: u16,
    /// Variant of the base unit (inferred).
    pub base_unit: BaseUnit,
    /// 0, rarely 2 (unknown).
    pub word_3: u16,
    /// On-board words.
    pub onboard: IoWords,
    /// 0x0200, 0, 0, 0 (unknown).
    pub words_10_to_13: [u16; 4],
    /// 2 + 2 × slots: word offset of slot 0 in a packed table (proven).
    pub offset: u16,
    /// Configuration of the base unit: input filters and latches (inferred).
    pub config: Vec<u16>,
    /// Expansion modules in slot order.
    pub modules: Vec<PackedModule>,
}

/// Words of one slot in the I and O files.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub struct IoWords {
    /// Input bits in the last input word; 0 = all 16.
    pub input_bits: u16,
    /// Input words.
    pub input_words: u16,
    /// First word in file I.
    pub first_input: u16,
    /// Output bits in the last output word; 0 = all 16.
    pub output_bits: u16,
    /// Output words.
    pub output_words: u16,
    /// First word in file O.
    pub first_output: u16,
}

/// Expansion module of the packed form.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct PackedModule {
    /// 1 (unknown).
    pub word_0: u16,
    /// 0 (unknown).
    pub word_1: u16,
    /// Word offset in a packed table (proven arithmetic).
    pub offset: u16,
    /// Module configuration; empty for discrete modules.
    pub config: Vec<u16>,
    /// Slot number, from 1.
    pub slot: u16,
    /// Words in the I and O files.
    pub words: IoWords,
    /// CIP identity; names in [`crate::tables::expansion_module`].
    pub identity: ModuleIdentity,
    /// Three words, perhaps revisions (unknown).
    pub last_words: [u16; 3],
}

/// Slots that the slot form always holds.
pub const SLOTS: usize = 31;

/// Slot form (proven layout for models 8, 28 and 36).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SlotIo<'a> {
    /// Slots 0 to 30.
    pub slots: Box<[SlotRecord; SLOTS]>,
    /// Slots of the expansion chassis: 2 for the SLC 500 fixed, 0 for the MicroLogix 1000 (inferred).
    pub expansion_slots: u16,
    /// 1,282 bytes, zero in every known project (unknown).
    pub rest: &'a [u8],
    /// 5, 5, 5, 0: three chassis, 5 probably "none" (unknown).
    pub rack: [u8; 4],
    /// Bytes beyond the known length; never seen, carried.
    pub extra: &'a [u8],
}

/// One slot of the slot form.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct SlotRecord {
    /// Input bytes.
    pub input_bytes: u8,
    /// First word in file I.
    pub first_input: u8,
    /// Output bytes.
    pub output_bytes: u8,
    /// First word in file O.
    pub first_output: u8,
    /// Class of the module's ID code; `FF` with number `FF` = empty slot.
    pub class: u8,
    /// Number within the class; 99 = any module of the class (inferred).
    pub number: u8,
    /// 18 bytes, zero in every known project (unknown).
    pub rest: [u8; 18],
}

impl SlotRecord {
    /// The module ID code, 100 × class + number (inferred); `None` for an empty slot.
    /// Names in [`crate::tables::slc_module`].
    #[must_use]
    pub fn id_code(&self) -> Option<u16> {
        (self.class != 0xFF || self.number != 0xFF).then(|| 100 * u16::from(self.class) + u16::from(self.number))
    }
}

/// What sits in a slot, of either form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SlotModule {
    /// The controller's own I/O, packed form.
    Base(BaseUnit),
    /// A module named by its CIP identity.
    Identity(ModuleIdentity),
    /// A module named by its ID code.
    IdCode(u16),
}

/// One occupied slot, of either form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Slot number; 0 is the controller's own I/O.
    pub slot: u16,
    /// What sits there.
    pub module: SlotModule,
    /// Its words in files I and O.
    pub words: IoWords,
}

impl IoWords {
    /// Input points that exist.
    #[must_use]
    pub fn input_points(&self) -> u32 {
        points(self.input_words, self.input_bits)
    }

    /// Output points that exist.
    #[must_use]
    pub fn output_points(&self) -> u32 {
        points(self.output_words, self.output_bits)
    }
}

fn points(words: u16, bits: u16) -> u32 {
    match (words, bits) {
        (0, _) => 0,
        (words, 0) => 16 * u32::from(words),
        (words, bits) => 16 * (u32::from(words) - 1) + u32::from(bits),
    }
}

impl IoConfiguration<'_> {
    /// The occupied slots in order; empty if the form is unknown.
    #[must_use]
    pub fn slots(&self) -> Vec<Slot> {
        match &self.layout {
            IoLayout::Packed(io) => {
                let base = Slot { slot: 0, module: SlotModule::Base(io.base_unit), words: io.onboard };
                let modules = io.modules.iter().map(|module| Slot {
                    slot: module.slot,
                    module: SlotModule::Identity(module.identity),
                    words: module.words,
                });
                std::iter::once(base).chain(modules).collect()
            }
            IoLayout::Slots(io) => (0u16..)
                .zip(io.slots.iter())
                .filter_map(|(slot, record)| {
                    Some(Slot { slot, module: SlotModule::IdCode(record.id_code()?), words: record.words() })
                })
                .collect(),
            IoLayout::Opaque(_) => Vec::new(),
        }
    }

    /// Input and output words of all slots: the element counts of files I and O
    /// in every known project. `None` if the form is unknown.
    #[must_use]
    pub fn total_words(&self) -> Option<(u32, u32)> {
        if matches!(self.layout, IoLayout::Opaque(_)) {
            return None;
        }
        Some(self.slots().iter().fold((0, 0), |(input, output), slot| {
            (input + u32::from(slot.words.input_words), output + u32::from(slot.words.output_words))
        }))
    }
}

impl SlotRecord {
    /// The slot's words in the form of the packed layout.
    #[must_use]
    pub fn words(&self) -> IoWords {
        let words = |bytes: u8| u16::from(bytes).div_ceil(2);
        let bits = |bytes: u8| if bytes % 2 == 1 { 8 } else { 0 };
        IoWords {
            input_bits: bits(self.input_bytes),
            input_words: words(self.input_bytes),
            first_input: u16::from(self.first_input),
            output_bits: bits(self.output_bytes),
            output_words: words(self.output_bytes),
            first_output: u16::from(self.first_output),
        }
    }
}

impl<'a> Record<'a> for IoConfiguration<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CIOInfo")?;
        self.model = Model(r.u16("the processor model")?);
        r.mark();
        let start = r.checkpoint();
        let at = r.offset();
        // An unknown model is tried in both forms. Each must use up the stream
        // exactly, which no stream of the other form does.
        let usual = processor_model(self.model.0).map(|model| model.io_form);
        let forms = match usual {
            Some(IoForm::Packed) => [IoForm::Packed, IoForm::Slots],
            Some(IoForm::Slots) | None => [IoForm::Slots, IoForm::Packed],
        };
        let mut why = String::new();
        for form in forms {
            match read_form(r, form, usual.is_some()) {
                Ok(layout) => {
                    self.layout = layout;
                    if usual.is_some_and(|usual| usual != form) {
                        r.deviation_at(at, format_args!("the I/O form of model {}", self.model.0), "the other form")?;
                    }
                    return self.check(r, at);
                }
                Err(error) => {
                    if why.is_empty() {
                        why = error.to_string();
                    }
                    r.rewind(&start);
                }
            }
        }
        // Both forms were learnt from controllers without a chassis. A longer
        // table whose slots fit together is taken for slots, and says so.
        if let Ok(mut io) = read_slots(r)
            && io.fits_together()
        {
            let more = r.remaining();
            r.deviation("the end of the slot form", format_args!("{more} more bytes, carried"))?;
            io.extra = r.opaque("bytes after the slot form", more)?;
            self.layout = IoLayout::Slots(io);
            return Ok(());
        }
        r.rewind(&start);
        r.deviation("an I/O configuration of a known form", why)?;
        self.layout = IoLayout::Opaque(r.opaque("an I/O configuration", r.remaining())?);
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CIOInfo");
        w.u16(self.model.0);
        match &self.layout {
            IoLayout::Packed(io) => write_packed(io, w)?,
            IoLayout::Slots(io) => write_slots(io, w),
            IoLayout::Opaque(bytes) => w.bytes(bytes),
        }
        Ok(())
    }
}

impl SlotIo<'_> {
    /// Whether each slot's words begin where those of the slots before it end,
    /// and at least one slot has words: a check that other data would not pass.
    fn fits_together(&self) -> bool {
        let (mut input, mut output) = (0u16, 0u16);
        for slot in self.slots.iter() {
            let words = slot.words();
            let follows = |count, first, next| count == 0 || first == next;
            if !follows(words.input_words, words.first_input, input)
                || !follows(words.output_words, words.first_output, output)
            {
                return false;
            }
            // 31 slots of at most 128 words stay far below 65,536.
            input += words.input_words;
            output += words.output_words;
        }
        input + output > 0
    }
}

/// Words of the packed table before slot 1, and of each module.
const PACKED_BASE: u32 = 10;
const PACKED_MODULE: u32 = 13;
/// Bytes of the packed form before the offset of slot 0, and from there to the base configuration.
const BEFORE_OFFSET: usize = 28;
const OFFSET_AND_COUNT: usize = 4;
/// Bytes of a module before its offset, and behind its configuration.
const MODULE_BEFORE_OFFSET: usize = 4;
const MODULE_AFTER_CONFIG: usize = 26;

impl IoConfiguration<'_> {
    /// Reports what contradicts itself; the values stand as stored. `at` is the
    /// offset behind the model code.
    fn check(&self, r: &mut Reader<'_>, at: usize) -> Result<()> {
        let io = match &self.layout {
            IoLayout::Packed(io) => io,
            IoLayout::Slots(io) if io.fits_together() => return Ok(()),
            IoLayout::Slots(_) => {
                return r.deviation_at(at, "slots whose words follow one another", "words that do not");
            }
            IoLayout::Opaque(_) => return Ok(()),
        };
        let mut at = at + BEFORE_OFFSET;
        let base = 2 + 2 * u32::from(io.slot_count);
        if u32::from(io.offset) != base {
            r.deviation_at(at, format_args!("offset {base} of slot 0"), io.offset)?;
        }
        at += OFFSET_AND_COUNT + 2 * io.config.len();
        for (index, module) in (1u16..).zip(&io.modules) {
            r.enter("slot", usize::from(index))?;
            at += MODULE_BEFORE_OFFSET;
            let offset = u32::from(io.offset) + PACKED_BASE + PACKED_MODULE * u32::from(index - 1);
            if u32::from(module.offset) != offset {
                r.deviation_at(at, format_args!("offset {offset}"), module.offset)?;
            }
            at += OFFSET_AND_COUNT + 2 * module.config.len();
            if module.slot != index {
                r.deviation_at(at, format_args!("slot number {index}"), module.slot)?;
            }
            at += MODULE_AFTER_CONFIG;
            r.leave();
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
