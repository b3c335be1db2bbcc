//! The instruction reference page, written from the table.

use std::fmt::Write;

use ladder::member_by_name;

use crate::model::*;
use crate::{all, structural};

/// The reference page in Markdown: what `docs/instructions.md` holds.
pub fn markdown() -> String {
    let mut page = String::from(HEAD);
    // Writing to a String cannot fail.
    let _ = contents(&mut page);
    for category in Category::ALL {
        let _ = write!(page, "\n## {}\n", category.title());
        for instruction in all().iter().filter(|instruction| instruction.category == category) {
            let _ = entry(&mut page, instruction);
        }
    }
    let _ = codes(&mut page);
    page
}

const HEAD: &str = "\
<!-- Written from the instruction table by its own test; change `crates/instr` and run it with RUNGS_BLESS=1. -->

# Instructions

What every SLC 500 and MicroLogix instruction is called, takes and does. Titles and operand names are
those of the box RSLogix 500 draws; a title marked ° was read in no report or manual and can be worded differently.

Of each form:

* **Code** is the operation code a project stores, and how it is known: *printed* (RSLogix named it in a report on a rung
  whose code is known), *usage* (recorded one instruction at a time, and real projects use it), *samples* (recorded one
  instruction at a time), *inferred* (fits in operands and neighbouring codes). A form without a code has never been
  seen in a project: what it is stored as is unknown, not guessed.
* **Processors** have it by their manuals or because a project for them uses it. Firmware matters too.
* **Compiled** are the operands the compiled code holds, in its order; *assumed* where no compiled code of it was seen.
* **Text** is the spelling in rung text; *assumed* where no text of it was seen.

Of each operand: what the instruction does with the data, what may stand there, and how far it reaches from the address named.
Members in brackets are used without being named.
";

fn contents(page: &mut String) -> std::fmt::Result {
    writeln!(page, "\n| group | instructions |\n|---|---|")?;
    for category in Category::ALL {
        let names: Vec<_> = all()
            .iter()
            .filter(|instruction| instruction.category == category)
            .map(|instruction| format!("[{0}](#{1})", instruction.mnemonic, anchor(instruction)))
            .collect();
        writeln!(page, "| {} | {} |", category.title(), names.join(" "))?;
    }
    writeln!(page, "\n{} instructions.", all().len())
}

fn heading(instruction: &Instruction) -> String {
    let mark = if instruction.names == Names::Unconfirmed { "°" } else { "" };
    format!("{} {}{mark}", instruction.mnemonic, instruction.title)
}

/// The anchor GitHub and most other renderers give a heading.
fn anchor(instruction: &Instruction) -> String {
    heading(instruction)
        .to_lowercase()
        .chars()
        .filter(|c| c.is_alphanumeric() || matches!(c, ' ' | '-' | '_'))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

fn entry(page: &mut String, instruction: &Instruction) -> std::fmt::Result {
    writeln!(page, "\n### {}\n\n{}\n", escaped(&heading(instruction)), instruction.doc)?;
    if !instruction.status.is_empty() {
        writeln!(page, "May also write {}.\n", instruction.status.join(", "))?;
    }
    writeln!(page, "| code | processors | drawn | compiled | text |\n|---|---|---|---|---|")?;
    for form in instruction.forms {
        writeln!(
            page,
            "| {} | {} | {} | {} | {} |",
            code(form),
            form.families,
            drawn(form),
            compiled(form),
            text(instruction, form)
        )?;
    }
    let mut described: Vec<&[Operand]> = Vec::new();
    for form in instruction.forms {
        if form.operands.is_empty() || described.contains(&form.operands) {
            continue;
        }
        described.push(form.operands);
        let whose = if described.len() > 1 { format!("{}: ", form.families) } else { String::new() };
        writeln!(page, "\n| {whose}operand | access | what | reach |\n|---|---|---|---|")?;
        for operand in form.operands {
            writeln!(
                page,
                "| {} | {} | {} | {} |",
                operand.name,
                operand.role.as_str(),
                kind(operand),
                reach(form, operand)
            )?;
        }
    }
    Ok(())
}

fn code(form: &Form) -> String {
    let base = form.time_base.map(|base| format!(", {} s", base.text())).unwrap_or_default();
    let other = form.stored_as.map(|name| format!(", as {name}")).unwrap_or_default();
    match form.opcode {
        Some(opcode) => format!("0x{opcode:02X} ({}){base}{other}", form.evidence.as_str()),
        None => "not known".to_owned(),
    }
}

fn drawn(form: &Form) -> String {
    let shape = match form.drawing {
        Drawing::Contact { closed: false } => "`] [`".to_owned(),
        Drawing::Contact { closed: true } => "`]/[`".to_owned(),
        Drawing::Coil("") => "`( )`".to_owned(),
        Drawing::Coil(letters) => format!("`({letters})`"),
        Drawing::Marked(letters) => format!("`[{letters}]`"),
        Drawing::Box { flags: [] } => "box".to_owned(),
        Drawing::Box { flags } => format!("box with {}", flags.join(" ")),
    };
    let place = match form.position {
        Position::Input => "condition",
        Position::RungStart => "first in its rung",
        Position::Output => "output",
        Position::FileEnd => "last rung",
    };
    format!("{shape}, {place}")
}

fn compiled(form: &Form) -> String {
    let names: Vec<_> =
        form.code_order.iter().filter_map(|index| form.operands.get(*index)).map(|operand| operand.name).collect();
    let assumed = if form.code_seen { "" } else { " (assumed)" };
    match (form.opcode, names.as_slice()) {
        (None, _) => "not known".to_owned(),
        (_, []) if form.operands.iter().any(|operand| operand.kind == Kind::Expression) => {
            "steps of the expression".to_owned()
        }
        (_, []) => "-".to_owned(),
        _ => format!("{}{assumed}", names.join(", ")),
    }
}

fn text(instruction: &Instruction, form: &Form) -> String {
    if form.text == TextLevel::Unknown {
        return "not known".to_owned();
    }
    let mut spelling = instruction.mnemonic.to_owned();
    for operand in form.operands.iter().filter(|operand| operand.in_text()) {
        let word: String = operand.name.to_lowercase().split(' ').collect::<Vec<_>>().join("_");
        let _ = write!(spelling, " {}", word.trim_end_matches(['.']).replace(".", ""));
    }
    let assumed = if form.text == TextLevel::Assumed { " (assumed)" } else { "" };
    format!("`{spelling}`{assumed}")
}

fn kind(operand: &Operand) -> String {
    let what = match operand.kind {
        Kind::Bit => "bit",
        Kind::Word => "value",
        Kind::Mask => "mask",
        Kind::Timer => "timer",
        Kind::Counter => "counter",
        Kind::Control => "control element",
        Kind::Resettable => "timer, counter or control element",
        Kind::File => "file, with `#`",
        Kind::WordOrFile => "value, or file with `#`",
        Kind::String => "string",
        Kind::Label => "label",
        Kind::ProgramFile => "program file",
        Kind::Constant => "number",
        Kind::TimeBase => "1.0, 0.01 or 0.001 s",
        Kind::Preset => "preset",
        Kind::Accum => "accumulator",
        Kind::Length => "length",
        Kind::Position => "position",
        Kind::Expression => "expression",
        Kind::HscNumber => "high-speed counter",
        Kind::PtoNumber | Kind::PwmNumber => "output number",
        Kind::PidBlock => "PID element or block",
        Kind::MessageBlock => "message element or block",
        Kind::RoutingBlock => "routing information element",
        Kind::ControlBlock => "control block",
        Kind::Slot => "slot",
        Kind::Slots => "slots",
        Kind::Channel => "channel",
        Kind::InterruptTypes => "mask of interrupt sources",
        Kind::QueueNumber => "data log queue",
        Kind::RecipeFile => "recipe file",
        Kind::Choice => "choice",
        Kind::Display => "status shown",
        Kind::SetupScreen => "leads to a dialog",
        Kind::Unidentified => "not identified",
    };
    match operand.stored {
        Stored::Value if operand.kind != Kind::Display => format!("{what}, as last displayed"),
        _ => what.to_owned(),
    }
}

fn reach(form: &Form, operand: &Operand) -> String {
    let named = |index: usize| form.operands.get(index).map_or("?", |operand| operand.name);
    let extent = match operand.extent {
        Extent::None => "-".to_owned(),
        Extent::Bit => "the bit".to_owned(),
        Extent::Value => "the value".to_owned(),
        Extent::Element => "the element".to_owned(),
        Extent::String => "the string".to_owned(),
        Extent::Elements { length, size_of } => format!("{} elements of the type of {}", named(length), named(size_of)),
        Extent::Steps { length } => format!("{} + 1 elements", named(length)),
        Extent::ValueOrSteps { length } => format!("the value; with `#` {} + 1 elements", named(length)),
        Extent::Words { length } => format!("{} words", named(length)),
        Extent::Bits { length } => format!("{} bits", named(length)),
        Extent::Block { words } => format!("{words} words"),
        Extent::Open => "set up elsewhere".to_owned(),
    };
    if operand.touches.is_empty() {
        return extent;
    }
    let touched: Vec<_> = [Role::Read, Role::Write, Role::ReadWrite]
        .into_iter()
        .filter_map(|role| {
            let names: Vec<_> = operand.touches.iter().filter(|touch| touch.role == role).map(member).collect();
            (!names.is_empty()).then(|| format!("{}s {}", role.as_str().replace('/', "s and "), names.join(" ")))
        })
        .collect();
    format!("{extent} [{}]", touched.join("; "))
}

/// `T.ACC` for a word, `T/DN` for a bit.
fn member(touch: &Touch) -> String {
    let bit = member_by_name(touch.file_type, touch.member).is_some_and(|member| member.bit.is_some());
    format!("{}{}{}", touch.file_type, if bit { '/' } else { '.' }, touch.member)
}

/// Markdown reads `*`, `<` and `|` in headings as markup.
fn escaped(text: &str) -> String {
    text.replace('<', "&lt;").replace('>', "&gt;").replace('|', "\\|")
}

fn codes(page: &mut String) -> std::fmt::Result {
    writeln!(page, "\n## Operation codes\n\n| code | instruction |\n|---|---|")?;
    for mark in structural::MARKS {
        let word = mark.text.map(|text| format!("{text}, ")).unwrap_or_default();
        writeln!(page, "| 0x{:02X} | {word}{} |", mark.opcode, mark.meaning)?;
    }
    let mut rows: Vec<_> = all()
        .iter()
        .flat_map(|instruction| instruction.forms.iter().map(move |form| (form.opcode, instruction, form)))
        .filter_map(|(opcode, instruction, form)| Some((opcode?, instruction.mnemonic, form)))
        .collect();
    rows.sort_by_key(|(opcode, mnemonic, _)| (*opcode, *mnemonic));
    for (opcode, mnemonic, form) in rows {
        let base = form.time_base.map(|base| format!(" {} s", base.text())).unwrap_or_default();
        writeln!(page, "| 0x{opcode:02X} | {mnemonic}{base} |")?;
    }
    let unknown: Vec<_> = all()
        .iter()
        .filter(|instruction| instruction.forms.iter().all(|form| form.opcode.is_none()))
        .map(|instruction| instruction.mnemonic)
        .collect();
    writeln!(page, "\nNo code is known for {}.", unknown.join(", "))
}
