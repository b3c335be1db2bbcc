//! `rungs info`: what a project is.

use std::cell::Cell;
use std::io::Write;

use analysis::{Coverage, CrossReference};
use ladder::{FileType, Image, ProgramFileKind, Severity};
use report::words;
use serde_json::{Value, json};

use super::{Opened, domore, each_dialect, write_json};
use crate::args::InfoArguments;
use crate::output::{Columns, Error, Outcome, Printable};

pub fn run(arguments: &InfoArguments) -> Result<Outcome, Error> {
    let json = arguments.input.json;
    let first = Cell::new(true);
    let separate = |out: &mut dyn Write| if first.replace(false) || json { Ok(()) } else { writeln!(out) };
    let slc = |opened: &Opened, out: &mut dyn Write| {
        separate(out)?;
        if json {
            write_json(opened, describe(opened), out)?;
        } else {
            print(opened, &mut Printable(out))?;
        }
        Ok(Outcome::Done)
    };
    each_dialect(&arguments.files, &arguments.input, slc, |opened, out| {
        separate(out)?;
        domore::info(opened, json, &mut Printable(out))?;
        Ok(Outcome::Done)
    })
}

fn coverage(opened: &Opened) -> Coverage {
    let xref = CrossReference::build(opened.image(), opened.documentation());
    Coverage::build(opened.image(), opened.documentation(), &xref)
}

/// Rows of an image's data file list: name, number, type, elements, words, description. Unused numbers
/// are not listed, as on paper.
fn data_files(image: &Image) -> impl Iterator<Item = &ladder::DataFile> {
    image.data_files.iter().filter(|file| file.file_type != FileType::Unused)
}

fn describe(opened: &Opened) -> Value {
    let (project, image) = (&opened.project, opened.image());
    let (source, processor) = (&project.source, &image.processor);
    let figures = coverage(opened);
    json!({
        "file": opened.path.display().to_string(),
        "sha256": source.sha256,
        "bytes": source.bytes,
        "saved_by": source.saved_by,
        "application": source.application,
        "saved_at": source.saved_at,
        "created_at": source.created_at,
        "images": images(opened),
        "processor": {
            "model": processor.model,
            "catalog": processor.catalog,
            "name": processor.name,
            "family": processor.family.id(),
            "confidence": processor.family_confidence.as_str(),
            "evidence": processor.evidence,
            "project_name": processor.project_name,
            "program_id": processor.program_id.map(|id| format!("{id:x}")),
            "driver": processor.driver,
            "route": processor.route,
        },
        "protection": {
            "deny_future_access": processor.deny_future_access,
            "password_fields_used": processor.password_fields_used,
        },
        "edited": image.is_edited(),
        "memory": image.memory.map(|memory| json!({
            "instruction_words_used": memory.instruction_words_used,
            "instruction_words_left": memory.instruction_words_left,
            "data_words_used": memory.data_words_used,
            "data_words_left": memory.data_words_left,
        })),
        "base_unit": image.io.base_unit,
        "io_unknown": image.io.unknown,
        "io": image.io.slots.iter().map(|slot| json!({
            "slot": slot.number,
            "catalog": slot.module.catalog,
            "description": slot.module.description,
            "identity": slot.module.identity,
            "confidence": slot.module.confidence.as_str(),
            "input_words": slot.inputs.words,
            "input_bits": slot.inputs.bits,
            "output_words": slot.outputs.words,
            "output_bits": slot.outputs.bits,
        })).collect::<Value>(),
        "channels": image.channels.iter().map(|channel| json!({
            "number": channel.number,
            "driver": channel.driver,
            "settings": channel.settings.iter().map(|setting| json!({
                "name": setting.name, "value": setting.value, "confidence": setting.confidence.as_str(),
            })).collect::<Value>(),
            "unexplained_words": channel.unexplained_words,
        })).collect::<Value>(),
        "program_files": image.program_files.iter().filter(|file| file.kind != ProgramFileKind::Unused).map(|file| json!({
            "number": file.number,
            "name": file.name,
            "description": file.description,
            "type": file.kind.as_str(),
            "rungs": file.rungs.len(),
        })).collect::<Value>(),
        "data_files": data_files(image).map(|file| json!({
            "number": file.number,
            "type": file.file_type.to_string(),
            "name": file.name,
            "description": file.description,
            "elements": file.elements,
            "words": file.listed_words(),
            "forced": file.has_forces(),
        })).collect::<Value>(),
        "documentation": {
            "addresses_used": figures.addresses,
            "with_symbol": figures.with_symbol,
            "with_description": figures.with_description,
            "documented": figures.documented,
            "rungs": figures.rungs,
            "rungs_with_comment": figures.with_comment,
            "entries": opened.documentation().entries().len(),
        },
        "revision_notes": project.revision_notes.len(),
    })
}

fn images(opened: &Opened) -> Vec<&'static str> {
    let project = &opened.project;
    let all = [(true, "main"), (project.online.is_some(), "online"), (project.autosave.is_some(), "autosave")];
    all.into_iter().filter_map(|(present, name)| present.then_some(name)).collect()
}

fn print(opened: &Opened, out: &mut dyn Write) -> Result<(), Error> {
    let (project, image) = (&opened.project, opened.image());
    let (source, processor) = (&project.source, &image.processor);
    writeln!(out, "{}", opened.title())?;
    let mut line = |name: &str, value: &str| {
        // What a project holds must not look like lines of its own.
        let value = value.lines().collect::<Vec<_>>().join(" ");
        if value.is_empty() { Ok(()) } else { writeln!(out, "  {name:<18}{value}") }
    };
    line("Processor", &words::processor(processor))?;
    line("Processor name", &processor.project_name)?;
    line("Program ID", &processor.program_id.map(|id| format!("{id:x}")).unwrap_or_default())?;
    line("Saved by", &words::saved_by(source))?;
    line("Saved at", source.saved_at.as_deref().unwrap_or(""))?;
    line("Images", &images(opened).join(", "))?;
    line("Route", &processor.route)?;
    if let Some(memory) = image.memory {
        let data = memory.data_words_used.map(|words| format!(", {words} data table words used")).unwrap_or_default();
        let text = format!(
            "{} instruction words used{data}, {} instruction words left",
            memory.instruction_words_used, memory.instruction_words_left
        );
        // The figures of an edited program are not known before it is verified, on paper neither.
        let text = if image.is_edited() { format!("*  (not verified; at the last verify: {text})") } else { text };
        line("Memory", &text)?;
    }
    line("Protection", words::protection(processor))?;
    print_io(image, out)?;
    print_channels(image, out)?;
    print_program_files(image, out)?;
    print_data_files(image, out)?;
    let figures = coverage(opened);
    writeln!(
        out,
        "\n  Documentation: {} of {} addresses have a symbol or description, {} of {} rungs a comment",
        figures.documented, figures.addresses, figures.with_comment, figures.rungs
    )?;
    let worst = project.diagnostics.iter().filter(|d| d.severity >= Severity::Warning).count();
    if worst > 0 {
        writeln!(out, "  Reading: {worst} deviations from the known format, reported below")?;
    }
    Ok(())
}

fn print_io(image: &Image, out: &mut dyn Write) -> Result<(), Error> {
    writeln!(out, "\n  I/O configuration")?;
    if let Some(unknown) = &image.io.unknown {
        writeln!(out, "    {unknown}")?;
    }
    if !image.io.base_unit.is_empty() {
        writeln!(out, "    Base unit         {}  (inferred)", image.io.base_unit)?;
    }
    let mut table = Columns::new(&["Slot", "Module", "Description", "Inputs", "Outputs", "Identity", "Evidence"]);
    for slot in &image.io.slots {
        table.row([
            slot.number.to_string(),
            slot.module.catalog.clone().unwrap_or_else(|| "unknown".to_owned()),
            slot.module.description.clone(),
            words::points(slot, &slot.inputs, "I"),
            words::points(slot, &slot.outputs, "O"),
            slot.module.identity.clone(),
            slot.module.confidence.as_str().to_owned(),
        ]);
    }
    Ok(table.write(out, "    ")?)
}

fn print_channels(image: &Image, out: &mut dyn Write) -> Result<(), Error> {
    for channel in &image.channels {
        writeln!(out, "\n  Channel {}: {}", channel.number, channel.driver)?;
        for setting in &channel.settings {
            let doubt = if setting.confidence >= ladder::Confidence::Proven {
                String::new()
            } else {
                format!("  ({})", setting.confidence.as_str())
            };
            writeln!(out, "    {:<38}{}{doubt}", setting.name, setting.value)?;
        }
        if channel.unexplained_words > 0 {
            let words = if channel.unexplained_words == 1 { "word" } else { "words" };
            writeln!(out, "    {} configuration {words} of unknown meaning", channel.unexplained_words)?;
        }
    }
    Ok(())
}

fn print_program_files(image: &Image, out: &mut dyn Write) -> Result<(), Error> {
    writeln!(out, "\n  Program files")?;
    let mut table = Columns::new(&["Name", "Number", "Type", "Rungs", "Description"]);
    for file in image.program_files.iter().filter(|file| file.kind != ProgramFileKind::Unused) {
        table.row([
            words::file_name(file),
            file.number.to_string(),
            file.kind.as_str().to_owned(),
            file.rungs.len().to_string(),
            file.description.clone(),
        ]);
    }
    Ok(table.write(out, "    ")?)
}

fn print_data_files(image: &Image, out: &mut dyn Write) -> Result<(), Error> {
    writeln!(out, "\n  Data files")?;
    let mut table = Columns::new(&["Name", "Number", "Type", "Words", "Elements", "Last", "Description"]);
    for file in data_files(image) {
        table.row([
            file.name.clone(),
            file.number.to_string(),
            file.file_type.to_string(),
            file.listed_words().to_string(),
            file.elements.to_string(),
            words::last_element(file),
            file.description.clone() + if file.has_forces() { "  [FORCED]" } else { "" },
        ]);
    }
    Ok(table.write(out, "    ")?)
}
