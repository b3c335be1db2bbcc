//! Search in a Do-more program.

use std::collections::HashMap;

use domore::address::{Constant, Number};
use domore::documentation::Documentation;
use domore::instruction::by_mnemonic;
use domore::xref::{Area, CrossReference};
use domore::{Instruction, Project};

use super::{About, Hits, Pattern, Query, Test, like};
use crate::Location;

/// Searches a Do-more program.
///
/// Patterns take its mnemonics (`TMR * >=500`); operands match as they are written and by nickname or element.
pub fn search_domore(project: &Project, query: &Query) -> Hits {
    let mut hits = Hits::default();
    match query {
        Query::Regex(regex) => texts(project, true, &|text| regex.is_match(text), &mut hits),
        Query::Any(text) => {
            if let Some(pattern) = Pattern::parse(text, |word| by_mnemonic(word).is_some()) {
                let documentation = Documentation::new(project);
                for (at, it) in instructions(project).filter(|(_, it)| matches(&pattern, &documentation, it)) {
                    hits.add(Some(at), "instruction", || it.to_string());
                }
            }
            // A folder can hold both dialects: the mnemonics of the other one are no texts either.
            let upper = text.to_ascii_uppercase();
            let is_mnemonic = by_mnemonic(text).is_some() || instr::by_mnemonic(&upper).is_some();
            if !is_mnemonic && hits.list.is_empty() && !addresses(project, text, &mut hits) {
                let lower = text.to_lowercase();
                texts(project, false, &|text| text.to_lowercase().contains(&lower), &mut hits);
            }
        }
    }
    hits
}

/// Code blocks by their place in the text.
fn blocks(project: &Project) -> impl Iterator<Item = (u16, &domore::CodeBlock)> {
    (1..=u16::MAX).zip(project.code_blocks())
}

fn instructions(project: &Project) -> impl Iterator<Item = (Location, &Instruction)> {
    blocks(project).flat_map(|(file, block)| {
        (0..).zip(&block.rungs).flat_map(move |(rung, content)| {
            (0..).zip(&content.instructions).map(move |(instruction, it)| (Location { file, rung, instruction }, it))
        })
    })
}

fn matches(pattern: &Pattern<'_>, documentation: &Documentation<'_>, it: &Instruction) -> bool {
    let holds = |(test, operand): (&Test<'_>, &String)| {
        let shown = documentation.shown(operand);
        let constant = documentation.nickname(operand).map(|entry| entry.extra.trim()).filter(|text| !text.is_empty());
        let number = Constant::parse(constant.unwrap_or(operand)).map(|constant| match constant.value {
            Number::Integer(number) => number as f64,
            Number::Real(number) => number,
        });
        match test {
            Test::Compare(compare, wanted) => number.is_some_and(|number| compare(&number, wanted)),
            Test::Like(word) => {
                word.parse::<f64>().is_ok_and(|wanted| number == Some(wanted))
                    || like(word, operand)
                    || (!shown.name.is_empty() && like(word, &shown.name))
            }
        }
    };
    like(pattern.mnemonic, &it.mnemonic)
        && pattern.operands.len() <= it.operands.len()
        && pattern.operands.iter().zip(&it.operands).all(holds)
}

/// Accesses of an element, nickname or code block; `false` when the text is none of these here.
fn addresses(project: &Project, text: &str, hits: &mut Hits) -> bool {
    let Ok(xref) = CrossReference::build(project) else { return false };
    let Some(area) = xref.area(text) else { return false };
    let touching = xref.touching(&area);
    if touching.is_empty() && matches!(area, Area::Name(_)) {
        return false;
    }
    let mut places: HashMap<&str, u16> = HashMap::new();
    for (number, block) in blocks(project) {
        places.entry(&block.name).or_insert(number);
    }
    for access in touching {
        let file = places.get(access.code_block.as_str()).copied();
        let rung = u32::try_from(access.rung.saturating_sub(1)).ok();
        let location = file.zip(rung).map(|(file, rung)| Location { file, rung, instruction: 0 });
        let role = access.role.map_or("unknown", domore::instruction::Role::as_str);
        let certainty = if access.may { "may" } else { "definite" };
        hits.add(location, role, || format!("{} {} ({certainty})", access.mnemonic, access.written));
    }
    true
}

/// Texts of documentation, and of instructions when asked for.
fn texts(project: &Project, with_instructions: bool, is: &dyn Fn(&str) -> bool, hits: &mut Hits) {
    for (file, block) in blocks(project) {
        if is(&block.name) {
            hits.add_about(Some(About::ProgramFile(file)), "code block", || {
                format!("{} {}", block.kind.title(), block.name)
            });
        }
        for (rung, content) in (0..).zip(&block.rungs) {
            let at = Location { file, rung, instruction: 0 };
            if let Some(comment) = &content.comment {
                let text = comment.plain_lines().join("\n");
                if is(&text) {
                    hits.add(Some(at), "comment", || text);
                }
            }
            if with_instructions {
                for (instruction, it) in (0..).zip(&content.instructions) {
                    let text = it.to_string();
                    if is(&text) {
                        hits.add(Some(Location { instruction, ..at }), "instruction", || text);
                    }
                }
            }
        }
    }
    for entry in project.documentation() {
        if is(&entry.nickname) {
            hits.add_about(Some(About::Address(entry.element.to_string())), "nickname", || {
                format!("{} {}", entry.element, entry.nickname)
            });
        }
        let description = entry.lines().join(" ");
        if is(&description) {
            hits.add_about(Some(About::Address(entry.element.to_string())), "description", || {
                format!("{} {} {description}", entry.element, entry.nickname)
            });
        }
    }
    for block in project.memory().filter(|block| is(&block.name)) {
        hits.add(None, "memory", || format!("{} {} {}", block.name, block.type_word, block.count));
    }
    for device in project.devices().filter(|device| is(&device.name)) {
        hits.add(None, "device", || format!("{} {}", device.name, device.parameters.join(", ")));
    }
}
