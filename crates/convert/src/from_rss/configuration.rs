//! Processor, I/O and memory figures: records to the model, codes to names with their evidence.

use ladder::{Confidence, Family, IoConfiguration, IoRange, Memory, Module, Processor, Slot};
use rss::io::{IoLayout, SlotModule};
use rss::tables::{self, Evidence};

pub(super) fn confidence(evidence: Evidence) -> Confidence {
    match evidence {
        Evidence::Printed | Evidence::Proven => Confidence::Proven,
        Evidence::Inferred => Confidence::Inferred,
        Evidence::Weak => Confidence::Weak,
        Evidence::Published => Confidence::Published,
    }
}

pub(crate) fn processor(record: &rss::processor::Processor<'_>) -> Processor {
    let code = record.model.0;
    let model = tables::processor_model(code);
    Processor {
        model: Some(code),
        catalog: model.map(|m| m.catalog.to_owned()),
        name: model.map(|m| m.name.to_owned()),
        family: model.and_then(|m| Family::from_id(m.family)).unwrap_or(Family::Unknown),
        family_confidence: model.map_or(Confidence::Unknown, |m| confidence(m.family_evidence)),
        evidence: model.map_or_else(
            || format!("model code {code} has not been seen in a project of known make"),
            |m| m.basis.to_owned(),
        ),
        project_name: record.name.decode().into_owned(),
        main_program: record.main_program.decode().into_owned(),
        program_id: Some(record.program_id),
        reported_type: Some(record.reported.0),
        driver: record.driver_settings().map(|driver| driver.name).unwrap_or_default(),
        route: record.route.decode().into_owned(),
        deny_future_access: None,
        password_fields_used: Some(record.after_driver.iter().chain(record.tail).any(|byte| *byte != 0)),
    }
}

/// The model of a project whose text told the family alone.
pub(super) fn chosen(processor: &mut Processor) {
    processor.family_confidence = processor.family_confidence.min(Confidence::Weak);
    "chosen when the project was built: its text did not tell the model".clone_into(&mut processor.evidence);
}

pub(crate) fn io(record: &rss::io::IoConfiguration<'_>) -> IoConfiguration {
    let packed = match &record.layout {
        IoLayout::Packed(packed) => Some(packed),
        _ => None,
    };
    let configuration = |slot: u16| match packed {
        Some(packed) if slot == 0 => packed.config.clone(),
        Some(packed) => packed.modules.iter().find(|m| m.slot == slot).map(|m| m.config.clone()).unwrap_or_default(),
        None => Vec::new(),
    };
    let slots = record.slots().into_iter().map(|slot| Slot {
        number: slot.slot,
        module: module(&slot.module, record.model.0),
        inputs: IoRange {
            first_word: slot.words.first_input,
            words: slot.words.input_words,
            bits: points(slot.words.input_points()).min(existing(&slot.module).0),
        },
        outputs: IoRange {
            first_word: slot.words.first_output,
            words: slot.words.output_words,
            bits: points(slot.words.output_points()).min(existing(&slot.module).1),
        },
        configuration: configuration(slot.slot),
    });
    IoConfiguration {
        slots: slots.collect(),
        base_unit: packed.and_then(|p| p.base_unit.letters()).unwrap_or_default(),
        unknown: matches!(record.layout, IoLayout::Opaque(_)).then(|| {
            format!(
                "the I/O configuration of processor model {} has an unknown form; its bytes are kept",
                record.model.0
            )
        }),
    }
}

/// Inputs and outputs that a module has at most.
fn existing(module: &SlotModule) -> (u16, u16) {
    match module {
        SlotModule::IdCode(code) => tables::onboard_points(*code).unwrap_or((u16::MAX, u16::MAX)),
        _ => (u16::MAX, u16::MAX),
    }
}

fn points(count: u32) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}

fn module(module: &SlotModule, model: u16) -> Module {
    let named = |name: Option<&tables::ModuleName>, identity: String| match name {
        Some(name) => Module {
            catalog: Some(name.catalog.to_owned()),
            description: name.description.to_owned(),
            identity,
            confidence: confidence(name.evidence),
        },
        None => Module {
            catalog: None,
            description: "unknown module".to_owned(),
            identity,
            confidence: Confidence::Unknown,
        },
    };
    match module {
        SlotModule::Base(unit) => {
            let processor = tables::processor_model(model);
            Module {
                catalog: processor.map(|p| p.catalog.to_owned()),
                description: processor.map_or("controller", |p| p.name).to_owned(),
                identity: format!("base unit 0x{:04X}", unit.0),
                confidence: processor.map_or(Confidence::Unknown, |p| confidence(p.family_evidence)),
            }
        }
        SlotModule::Identity(id) => named(
            tables::expansion_module(*id),
            format!("vendor {}, type {}, code {}", id.vendor, id.device_type, id.code),
        ),
        SlotModule::IdCode(code) => named(tables::slc_module(*code), format!("ID {code}")),
    }
}

pub(crate) fn memory(record: &rss::compiler::Compiler<'_>, model: u16) -> Option<Memory> {
    let used = record.memory.in_use(rss::processor::Model(model))?;
    Some(Memory {
        instruction_words_used: used.instruction_words_used,
        instruction_words_left: used.instruction_words_left,
        data_words_used: used.data_words_used,
        data_words_left: used.data_words_used.map(|_| record.memory.data_words_left),
    })
}
