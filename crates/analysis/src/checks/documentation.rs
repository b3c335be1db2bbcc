//! Symbols, descriptions and comments that say nothing, or something about what is gone.

use std::collections::BTreeMap;

use ladder::{Address, FileType, Target};

use super::context::Context;
use super::{Check, Found, Severity};

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "DOC01",
        title: "comment whose rung or address is gone",
        severity: Severity::Note,
        default_on: true,
        explanation: "The project keeps comments that nothing shows: the rung they belong to was deleted or has another last address now, or \
            the address of an instruction comment is gone. They may explain what the machine once did.",
        find: detached,
    },
    Check {
        code: "DOC02",
        title: "symbol or description of an address that does not exist",
        severity: Severity::Note,
        default_on: true,
        explanation: "The documentation names an address beyond the end of its data file, or in a data file the project does not have.",
        find: vanished,
    },
    Check {
        code: "DOC03",
        title: "one symbol for two addresses",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The same symbol stands for two addresses. Who types it gets one of them, and who reads it cannot tell which is meant.",
        find: double_symbol,
    },
    Check {
        code: "DOC04",
        title: "little documentation",
        severity: Severity::Note,
        default_on: true,
        explanation: "Less than half of the addresses that instructions name have a symbol or a description.",
        find: coverage,
    },
    Check {
        code: "DOC05",
        title: "program file without name and description",
        severity: Severity::Note,
        default_on: false,
        explanation: "A file with a name in the list of program files is found without reading its rungs.",
        find: unnamed_file,
    },
    Check {
        code: "DOC06",
        title: "symbol without an address",
        severity: Severity::Note,
        default_on: true,
        explanation: "The symbol was entered and never assigned to an address.",
        find: unassigned,
    },
];

/// Names said of a finding about many.
const SAID: usize = 8;

fn joined(names: &[String]) -> String {
    let mut text = names.iter().take(SAID).cloned().collect::<Vec<_>>().join(", ");
    if names.len() > SAID {
        text.push_str(", ...");
    }
    text
}

fn detached(context: &Context<'_>, found: &mut Found) {
    let docs = context.documentation;
    let rungs = docs.detached_comments.len();
    let instructions = docs.instruction_comments().iter().filter(|comment| comment.target.is_none()).count();
    if rungs > 0 {
        found.add(&[], "", format!("{rungs} rung comments or titles belong to no rung"));
    }
    if instructions > 0 {
        found.add(&[], "", format!("{instructions} instruction comments belong to no address"));
    }
}

fn vanished(context: &Context<'_>, found: &mut Found) {
    let image = context.image;
    let is_gone = |address: &Address| {
        // I/O is numbered by slots; RSLogix names status words of all processors by itself; brackets and
        // function files tell nothing about a size.
        if address.file_type.has_slots()
            || address.file_type == FileType::S
            || address.file_type.is_function_file()
            || !address.is_direct()
        {
            return false;
        }
        let (Some(number), Some(element)) = (address.file.number(), address.element.number()) else { return false };
        image.data_file(address.file_type, number).is_none_or(|file| element >= file.elements)
    };
    let gone: Vec<String> = context
        .documentation
        .entries()
        .iter()
        .filter_map(|entry| match &entry.target {
            Target::Address(address) if is_gone(address) => Some(address.to_string()),
            _ => None,
        })
        .collect();
    if !gone.is_empty() {
        let message = format!("{} documented addresses are not in the data table: {}", gone.len(), joined(&gone));
        found.add(&[], "", message);
    }
}

fn double_symbol(context: &Context<'_>, found: &mut Found) {
    let mut by_symbol: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for entry in context.documentation.entries() {
        if entry.symbol.is_empty() || entry.target == Target::Unassigned {
            continue;
        }
        let targets = by_symbol.entry(entry.symbol.to_ascii_uppercase()).or_default();
        let target = entry.target.to_string();
        if !targets.contains(&target) && targets.len() <= SAID {
            targets.push(target);
        }
    }
    for (symbol, targets) in by_symbol.into_iter().filter(|(_, targets)| targets.len() > 1) {
        found.add(&[], &symbol, format!("{symbol} stands for {}", joined(&targets)));
    }
}

fn coverage(context: &Context<'_>, found: &mut Found) {
    let figures = crate::Coverage::build(context.image, context.documentation, &context.xref);
    if figures.documented * 2 < figures.addresses {
        let message =
            format!("{} of {} addresses in use have a symbol or a description", figures.documented, figures.addresses);
        found.add(&[], "", message);
    }
}

fn unnamed_file(context: &Context<'_>, found: &mut Found) {
    for file in context.image.ladder_files() {
        if file.name.trim().is_empty() && file.description.trim().is_empty() && !file.rungs.iter().all(|it| it.is_end())
        {
            found.add(&[], format!("U:{}", file.number), format!("program file {} has no name", file.number));
        }
    }
}

fn unassigned(context: &Context<'_>, found: &mut Found) {
    let entries = context.documentation.entries().iter();
    let names: Vec<String> = entries
        .filter(|entry| entry.target == Target::Unassigned && !entry.symbol.is_empty())
        .map(|entry| entry.symbol.clone())
        .collect();
    if !names.is_empty() {
        found.add(&[], "", format!("{} symbols have no address: {}", names.len(), joined(&names)));
    }
}
