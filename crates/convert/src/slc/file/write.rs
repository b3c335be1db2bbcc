//! Writes an `.SLC` file.

use std::fmt::Write as _;

use super::{Forces, Ladder, Names, Section, SlcFile, Slot, comment, data};

pub(super) fn write(file: &SlcFile) -> String {
    let mut out = String::new();
    let mut sections = file.sections.iter().peekable();
    while let Some(section) = sections.next() {
        push(section, &mut out);
        // Groups are set apart by two empty lines, sections inside a group by one.
        let ends_group = match (group(section), sections.peek().map(|next| group(next))) {
            (Some(group), next) => next.flatten() != Some(group),
            (None, _) => false,
        };
        out.push_str(if ends_group || matches!(section, Section::Force(_)) { "\n\n" } else { "\n" });
    }
    out
}

#[derive(PartialEq)]
enum Group {
    Rack,
    Ladder,
    Outputs,
    Inputs,
}

fn group(section: &Section) -> Option<Group> {
    match section {
        Section::Rack(_) => Some(Group::Rack),
        Section::Ladder(_) => Some(Group::Ladder),
        Section::Data(data) if data.letters == "O" => Some(Group::Outputs),
        Section::Data(data) if data.letters == "I" => Some(Group::Inputs),
        _ => None,
    }
}

fn push(section: &Section, out: &mut String) {
    // Writing to a string cannot fail.
    let _ = match section {
        Section::Start(start) => writeln!(out, "START {:<11} % {} %", start.catalog, start.description),
        Section::Rack(slots) => {
            rack(slots, out);
            Ok(())
        }
        Section::Project(names) => {
            project(names, out);
            Ok(())
        }
        Section::Ladder(section) => {
            ladder(section, out);
            Ok(())
        }
        Section::Data(section) => {
            data::write(section, out);
            Ok(())
        }
        Section::Force(section) => {
            forces(section, out);
            Ok(())
        }
        Section::Other(lines) => writeln!(out, "{lines}"),
    };
}

fn extra(lines: &str, out: &mut String) {
    if !lines.is_empty() {
        out.push_str(lines);
        out.push('\n');
    }
}

fn numbers<T: std::fmt::Display>(numbers: &[T]) -> String {
    numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(" ")
}

fn rack(slots: &[Slot], out: &mut String) {
    out.push_str("% PROCESSOR RACK CONFIGURATION INFORMATION %\n% SLOT CONFIGURATION INFORMATION %\n");
    for slot in slots {
        let Slot { number, catalog, description, scan_in, scan_out, .. } = slot;
        let _ = write!(out, "SLOT {number} {catalog:<11} % {description} %  SCAN_IN {scan_in} SCAN_OUT {scan_out} ");
        if let Some(words) = &slot.configuration {
            let signed: Vec<i16> = words.iter().map(|word| *word as i16).collect();
            let _ = write!(out, " G_FILE {}\n     {}", words.len(), numbers(&signed));
        }
        if let Some(card) = &slot.io_card {
            let _ = write!(out, " IOCARD {}", numbers(card));
        }
        out.push('\n');
    }
}

fn project(names: &Names, out: &mut String) {
    let _ = writeln!(out, "PROJECT \"{}\"", names.project);
    for (number, name) in &names.program_files {
        let _ = writeln!(out, "  {number:>3}  \"{name}\"");
    }
}

fn ladder(section: &Ladder, out: &mut String) {
    let _ = writeln!(out, "LADDER {}", section.number);
    extra(&section.extra, out);
    for (number, rung) in section.rungs.iter().enumerate() {
        let _ = writeln!(out, "% Rung: {number} %\n{} ", rung.text);
        if rung.text.rsplit(char::is_whitespace).next() != Some("EOR") {
            // An empty line ends a rung whose end is missing.
            out.push('\n');
        }
        if let Some(block) = &rung.title {
            comment::write(block, out);
        }
        extra(&rung.extra, out);
    }
}

fn forces(section: &Forces, out: &mut String) {
    let letter = if section.outputs { 'O' } else { 'I' };
    let _ = writeln!(out, "FORCE {letter}:{:02}\n% ON     OFF  %", section.slot);
    for (word, force) in section.words.iter().enumerate() {
        let _ = writeln!(out, "0X{:04X} 0X{:04X} % FORCE {letter}:{}.{word} %", force.on, force.off, section.slot);
    }
    extra(&section.extra, out);
}
