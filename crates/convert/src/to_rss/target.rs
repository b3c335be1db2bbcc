//! Which controller a project is written for.

use ladder::{Family, Image, Project};
use rss::tables::{self, IoForm, ProcessorModel};
use rss::{Error, Result};

use super::Notes;

/// The controller to write.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Target {
    /// Stored model number.
    pub(super) code: u16,
    /// Form of its I/O configuration.
    pub(super) io_form: IoForm,
    /// The program tells the family alone; the model was chosen here.
    pub(super) chosen: bool,
}

impl Target {
    fn known(model: &ProcessorModel) -> Target {
        Target { code: model.code, io_form: model.io_form, chosen: false }
    }
}

/// The product that a project names as its writer when the model in it was chosen by the writer.
pub(crate) const CHOSEN: &str = "rungs, processor model chosen";

/// The model to write: the stored number if there is one, else by name, else by catalogue number or
/// family, which may leave a choice.
///
/// # Errors
/// A controller that no known model number stands for: another one is never written in its place.
pub(super) fn target(project: &Project, image: &Image, notes: &mut Notes) -> Result<Target> {
    let processor = &image.processor;
    if let Some(code) = processor.model {
        let chosen = project.source.application == CHOSEN;
        return Ok(match tables::processor_model(code) {
            Some(model) => Target { chosen, ..Target::known(model) },
            None => {
                let io_form = io_form(image);
                let form = if io_form == IoForm::Packed { "packed modules" } else { "a table of slots" };
                let message = format!("model {code} is not known; its I/O configuration is written as {form}");
                notes.warning("processor", message);
                Target { code, io_form, chosen }
            }
        });
    }
    let all = || tables::PROCESSOR_MODELS.iter();
    let name = processor.name.as_deref();
    if let Some(model) = all().find(|model| name.is_some_and(|name| name.eq_ignore_ascii_case(model.name))) {
        return Ok(Target::known(model));
    }
    let candidates: Vec<&ProcessorModel> = match processor.catalog.as_deref() {
        Some(catalog) => all().filter(|model| is_variant(catalog, model.catalog)).collect(),
        None => all().filter(|model| Family::from_id(model.family) == Some(processor.family)).collect(),
    };
    // The newest series; of variants that are no series the plain one, which comes first.
    let newest = candidates.iter().rev().find(|model| model.name.contains("Series")).or(candidates.first());
    let Some(model) = newest else {
        let known: Vec<String> = all().map(|model| format!("{} {}", model.catalog, model.name)).collect();
        let called = [processor.catalog.as_deref(), name].into_iter().flatten().collect::<Vec<_>>().join(" ");
        return Err(Error::Unwritable(format!(
            "no model number is known for processor {} ({}); known are {}",
            if called.is_empty() { "of unknown name" } else { &called },
            processor.family,
            known.join(", ")
        )));
    };
    let others: Vec<&str> =
        candidates.iter().filter(|other| other.code != model.code).map(|other| other.name).collect();
    let others = if others.is_empty() { String::new() } else { format!(", not {}", others.join(" or ")) };
    let told = processor.catalog.as_deref().unwrap_or("the family");
    let message = format!(
        "{told} does not tell the model: written as {} {}{others}; name the model in the text to choose another",
        model.catalog, model.name
    );
    notes.warning("processor", message);
    Ok(Target { chosen: true, ..Target::known(model) })
}

/// The same catalogue number, or one with the letter of a variant behind it (`1747-L40A`).
fn is_variant(catalog: &str, of: &str) -> bool {
    let rest = catalog.get(..of.len()).filter(|start| start.eq_ignore_ascii_case(of)).and(catalog.get(of.len()..));
    rest.is_some_and(|rest| rest.is_empty() || (rest.len() == 1 && rest.bytes().all(|b| b.is_ascii_alphabetic())))
}

/// The form in which the modules of a controller of unknown model were stored.
fn io_form(image: &Image) -> IoForm {
    let packed = |slot: &ladder::Slot| {
        slot.module.identity.starts_with("vendor ") || slot.module.identity.starts_with("base unit ")
    };
    if image.io.slots.iter().any(packed) { IoForm::Packed } else { IoForm::Slots }
}
