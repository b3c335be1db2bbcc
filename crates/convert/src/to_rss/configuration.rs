//! Processor, I/O and channels to their records.

use ladder::{Image, IoRange, Processor, Slot};
use rss::channel::{Channel, ChannelConfiguration};
use rss::io::{IoConfiguration, IoLayout, IoWords, PackedIo, PackedModule, SLOTS, SlotIo, SlotRecord};
use rss::processor::{Driver, Model};
use rss::tables::{self, BaseUnit, IoForm, ModuleIdentity};
use rss::{Error, Result, Text};

use super::{Notes, Target, text};

pub(super) fn processor<'a>(processor: &'a Processor, model: &Target) -> Result<rss::processor::Processor<'a>> {
    let name = if processor.driver.is_empty() { "(unknown)" } else { &processor.driver };
    let driver = Driver::unconnected(name).to_stored();
    let driver = driver.map_err(|c| Error::Unwritable(format!("driver name: {c:?} is not in code page 1252")))?;
    let code = Model(model.code);
    // The tail of the MicroLogix 1400 record is five zero bytes in every known project.
    let tail: &[u8] = if matches!(model.code, 62 | 63) { &[0; 5] } else { &[] };
    Ok(rss::processor::Processor {
        model: code,
        reported: processor.reported_type.map_or(code, Model),
        driver: Text::from_bytes(&driver).into_owned(),
        name: text(&processor.project_name)?,
        main_program: text(&processor.main_program)?,
        route: text(&processor.route)?,
        program_id: processor.program_id.unwrap_or(0),
        after_program_id: 1,
        tail,
        ..rss::processor::Processor::default()
    })
}

pub(super) fn io(image: &Image, model: &Target, notes: &mut Notes) -> Result<IoConfiguration<'static>> {
    let layout = match model.io_form {
        IoForm::Packed => IoLayout::Packed(packed(image, model)?),
        IoForm::Slots => IoLayout::Slots(slots(image, model)?),
    };
    if image.io.slots.is_empty() {
        notes.note("I/O configuration", "no slot is given: the controller's own I/O of the model is written");
    }
    Ok(IoConfiguration { model: Model(model.code), layout })
}

/// On-board words of the packed models: in, out.
fn onboard_words(model: &Target) -> (u16, u16) {
    match model.code {
        60 | 61 => (6, 4),
        62 | 63 => (8, 6),
        _ => (4, 4),
    }
}

/// Configuration words of the base unit before any filter or latch is set.
fn base_configuration(model: &Target) -> Vec<u16> {
    let (length, first, tail) = match model.code {
        57 => (8, 0x0106, 1),
        60 => (8, 0x0106, 1),
        61 => (9, 0x0107, 1),
        _ => (17, 0x020E, 2),
    };
    let mut words = vec![0; length];
    words[0] = first;
    for word in words.iter_mut().rev().take(tail) {
        *word = 0x00FF;
    }
    words
}

fn words(slot: &Slot) -> IoWords {
    let bits = |range: &IoRange| range.bits % 16;
    IoWords {
        input_bits: bits(&slot.inputs),
        input_words: slot.inputs.words,
        first_input: slot.inputs.first_word,
        output_bits: bits(&slot.outputs),
        output_words: slot.outputs.words,
        first_output: slot.outputs.first_word,
    }
}

fn packed(image: &Image, model: &Target) -> Result<PackedIo> {
    let base = image.io.slots.iter().find(|slot| slot.number == 0);
    let onboard = base.map_or_else(
        || {
            let (input_words, output_words) = onboard_words(model);
            IoWords { input_words, output_words, ..IoWords::default() }
        },
        words,
    );
    let base_configuration = match base {
        Some(slot) if !slot.configuration.is_empty() => slot.configuration.clone(),
        _ => base_configuration(model),
    };
    let modules: Vec<&Slot> = image.io.slots.iter().filter(|slot| slot.number != 0).collect();
    let count = modules.len() + 1;
    let too_many = || Error::Unwritable(format!("{count} slots"));
    let slot_count = u16::try_from(count).map_err(|_| too_many())?;
    let offset = slot_count.checked_mul(2).and_then(|words| words.checked_add(2)).ok_or_else(too_many)?;
    let mut next = offset.checked_add(10).ok_or_else(too_many)?;
    let mut stored = Vec::with_capacity(modules.len());
    for slot in modules {
        stored.push(PackedModule {
            word_0: 1,
            word_1: 0,
            offset: next,
            config: slot.configuration.clone(),
            slot: slot.number,
            words: words(slot),
            identity: identity(slot)?,
            last_words: [0; 3],
        });
        next = next.checked_add(13).ok_or_else(too_many)?;
    }
    Ok(PackedIo {
        slot_count,
        base_unit: base_unit(base),
        onboard,
        words_10_to_13: [0x0200, 0, 0, 0],
        offset,
        config: base_configuration,
        modules: stored,
        ..PackedIo::default()
    })
}

/// The variant stored for slot 0; 0x1000 is "not stated".
fn base_unit(base: Option<&Slot>) -> BaseUnit {
    let stored = base.and_then(|slot| slot.module.identity.strip_prefix("base unit 0x"));
    BaseUnit(stored.and_then(|digits| u16::from_str_radix(digits, 16).ok()).unwrap_or(0x1000))
}

fn identity(slot: &Slot) -> Result<ModuleIdentity> {
    let by_catalog = slot.module.catalog.as_deref().and_then(|catalog| {
        tables::EXPANSION_MODULES.iter().find(|(_, name)| name.catalog.eq_ignore_ascii_case(catalog))
    });
    let numbers: Vec<u16> =
        slot.module.identity.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse().ok()).collect();
    match (numbers.as_slice(), by_catalog) {
        (&[vendor, device_type, code], _) if slot.module.identity.starts_with("vendor ") => {
            Ok(ModuleIdentity { vendor, device_type, code })
        }
        (_, Some((identity, _))) => Ok(*identity),
        _ => Err(unknown_module(slot)),
    }
}

fn unknown_module(slot: &Slot) -> Error {
    let name = slot.module.catalog.as_deref().unwrap_or(&slot.module.description);
    Error::Unwritable(format!("slot {}: the stored identity of module {name} is not known", slot.number))
}

fn slots(image: &Image, model: &Target) -> Result<SlotIo<'static>> {
    const EMPTY: SlotRecord = SlotRecord {
        input_bytes: 0,
        first_input: 0,
        output_bytes: 0,
        first_output: 0,
        class: 0xFF,
        number: 0xFF,
        rest: [0; 18],
    };
    const REST: [u8; 1282] = [0; 1282];
    let mut stored = [EMPTY; SLOTS];
    // (class and number, input bytes, output bytes) of the controller's own I/O.
    let (base, input_bytes, output_bytes) = if model.code == 8 { ([21, 0], 3, 2) } else { ([31, 99], 4, 2) };
    stored[0] = SlotRecord { class: base[0], number: base[1], input_bytes, output_bytes, ..EMPTY };
    for slot in &image.io.slots {
        let place = stored
            .get_mut(usize::from(slot.number))
            .ok_or_else(|| Error::Unwritable(format!("slot {}: there are {SLOTS}", slot.number)))?;
        let byte = |number: u16| {
            u8::try_from(number).map_err(|_| Error::Unwritable(format!("slot {}: {number} I/O words", slot.number)))
        };
        let id = if slot.number == 0 { None } else { Some(id_code(slot)?) };
        let [class, number] = match id {
            None => base,
            Some(id) => [byte(id / 100)?, byte(id % 100)?],
        };
        *place = SlotRecord {
            input_bytes: if slot.number == 0 { input_bytes } else { byte(slot.inputs.bits.div_ceil(8))? },
            first_input: byte(slot.inputs.first_word)?,
            output_bytes: if slot.number == 0 { output_bytes } else { byte(slot.outputs.bits.div_ceil(8))? },
            first_output: byte(slot.outputs.first_word)?,
            class,
            number,
            rest: [0; 18],
        };
    }
    let expansion_slots = if model.code == 8 { 2 } else { 0 };
    Ok(SlotIo { slots: Box::new(stored), expansion_slots, rest: &REST, rack: [5, 5, 5, 0], extra: &[] })
}

fn id_code(slot: &Slot) -> Result<u16> {
    let stored = slot.module.identity.strip_prefix("ID ").and_then(|digits| digits.parse().ok());
    let named = || {
        let catalog = slot.module.catalog.as_deref()?;
        tables::SLC_MODULES.iter().find(|(_, name)| name.catalog.eq_ignore_ascii_case(catalog)).map(|(id, _)| *id)
    };
    stored.or_else(named).ok_or_else(|| unknown_module(slot))
}

/// Blank channels of the sizes the model has.
pub(super) fn channel_bytes(model: &Target) -> Vec<Vec<u8>> {
    let words: &[usize] = match model.code {
        57 => &[44, 44],
        60 => &[44, 68],
        61 => &[44, 525],
        62 => &[96, 590, 96],
        63 => &[96, 641, 96],
        _ => &[],
    };
    words.iter().map(|count| vec![0; 2 * count]).collect()
}

pub(super) fn channels<'a>(model: &Target, bytes: &'a [Vec<u8>]) -> ChannelConfiguration<'a> {
    // Models that keep their channel settings in the status file have eleven zero bytes here.
    let tail: &[u8] = if bytes.is_empty() { &[0; 11] } else { &[] };
    let channels = bytes.iter().map(|bytes| Channel::from_bytes(bytes)).collect();
    ChannelConfiguration { model: Model(model.code), channels, tail, other_shape: None }
}
