//! The two stored forms, field by field.

use super::{IoLayout, IoWords, PackedIo, PackedModule, SLOTS, SlotIo, SlotRecord};
use crate::archive::{Reader, Writer};
use crate::error::Result;
use crate::tables::{BaseUnit, IoForm, ModuleIdentity};

/// Bytes of zeros between the slots and the rack of the slot form.
const SLOT_REST: usize = 1282;

/// Reads one form, to the end. Slots of a model that is not `known` must also fit together.
pub(super) fn read_form<'a>(r: &mut Reader<'a>, form: IoForm, known: bool) -> Result<IoLayout<'a>> {
    let layout = match form {
        IoForm::Packed => IoLayout::Packed(read_packed(r)?),
        IoForm::Slots => {
            let io = read_slots(r)?;
            if !known && !io.fits_together() {
                return Err(r.fault("slots whose words follow one another", "words that do not"));
            }
            IoLayout::Slots(io)
        }
    };
    match r.remaining() {
        0 => Ok(layout),
        n => Err(r.fault("the end of the payload", format_args!("{n} more bytes"))),
    }
}

fn read_io_words(r: &mut Reader<'_>) -> Result<IoWords> {
    Ok(IoWords {
        input_bits: r.u16("input bits")?,
        input_words: r.u16("input words")?,
        first_input: r.u16("the first input word")?,
        output_bits: r.u16("output bits")?,
        output_words: r.u16("output words")?,
        first_output: r.u16("the first output word")?,
    })
}

fn read_words(r: &mut Reader<'_>, what: &'static str) -> Result<Vec<u16>> {
    let count = r.count_u16(what, 2)?;
    (0..count).map(|_| r.u16(what)).collect()
}

fn read_packed(r: &mut Reader<'_>) -> Result<PackedIo> {
    let slot_count = r.u16("the number of slots")?;
    let mut io = PackedIo {
        slot_count,
        word_1: r.u16("word 1")?,
        base_unit: BaseUnit(r.u16("the base unit variant")?),
        word_3: r.u16("word 3")?,
        onboard: read_io_words(r)?,
        words_10_to_13: [r.u16("word 10")?, r.u16("word 11")?, r.u16("word 12")?, r.u16("word 13")?],
        offset: r.u16("the offset of slot 0")?,
        config: read_words(r, "the base unit configuration")?,
        modules: Vec::new(),
    };
    for slot in 1..slot_count {
        r.enter("slot", usize::from(slot))?;
        io.modules.push(PackedModule {
            word_0: r.u16("word 0 of a module")?,
            word_1: r.u16("word 1 of a module")?,
            offset: r.u16("the offset of a module")?,
            config: read_words(r, "the module configuration")?,
            slot: r.u16("the slot number")?,
            words: read_io_words(r)?,
            identity: ModuleIdentity {
                vendor: r.u16("the vendor")?,
                device_type: r.u16("the device type")?,
                code: r.u16("the product code")?,
            },
            last_words: [
                r.u16("word 7 of a module identity")?,
                r.u16("word 8 of a module identity")?,
                r.u16("word 9 of a module identity")?,
            ],
        });
        r.leave();
    }
    Ok(io)
}

fn write_io_words(words: &IoWords, w: &mut Writer) {
    for word in [
        words.input_bits,
        words.input_words,
        words.first_input,
        words.output_bits,
        words.output_words,
        words.first_output,
    ] {
        w.u16(word);
    }
}

fn write_words(words: &[u16], w: &mut Writer) -> Result<()> {
    w.count_u16(words.len())?;
    words.iter().for_each(|word| w.u16(*word));
    Ok(())
}

pub(super) fn write_packed(io: &PackedIo, w: &mut Writer) -> Result<()> {
    for word in [io.slot_count, io.word_1, io.base_unit.0, io.word_3] {
        w.u16(word);
    }
    write_io_words(&io.onboard, w);
    io.words_10_to_13.iter().for_each(|word| w.u16(*word));
    w.u16(io.offset);
    write_words(&io.config, w)?;
    for module in &io.modules {
        w.u16(module.word_0);
        w.u16(module.word_1);
        w.u16(module.offset);
        write_words(&module.config, w)?;
        w.u16(module.slot);
        write_io_words(&module.words, w);
        w.u16(module.identity.vendor);
        w.u16(module.identity.device_type);
        w.u16(module.identity.code);
        module.last_words.iter().for_each(|word| w.u16(*word));
    }
    Ok(())
}

pub(super) fn read_slots<'a>(r: &mut Reader<'a>) -> Result<SlotIo<'a>> {
    let mut slots = Box::new([SlotRecord::default(); SLOTS]);
    for (number, slot) in slots.iter_mut().enumerate() {
        r.enter("slot", number)?;
        *slot = SlotRecord {
            input_bytes: r.u8("input bytes")?,
            first_input: r.u8("the first input word")?,
            output_bytes: r.u8("output bytes")?,
            first_output: r.u8("the first output word")?,
            class: r.u8("the module class")?,
            number: r.u8("the module number")?,
            rest: r.array("the rest of a slot")?,
        };
        r.leave();
    }
    Ok(SlotIo {
        slots,
        expansion_slots: r.u16("expansion slots")?,
        rest: r.bytes("bytes after the slots", SLOT_REST)?,
        rack: r.array("the rack")?,
        extra: &[],
    })
}

pub(super) fn write_slots(io: &SlotIo<'_>, w: &mut Writer) {
    for slot in io.slots.iter() {
        w.bytes(&[slot.input_bytes, slot.first_input, slot.output_bytes, slot.first_output, slot.class, slot.number]);
        w.bytes(&slot.rest);
    }
    w.u16(io.expansion_slots);
    w.bytes(io.rest);
    w.bytes(&io.rack);
    w.bytes(io.extra);
}
