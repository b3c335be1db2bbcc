//! `PROGRAM FILES` to rungs: marks become structure, texts become typed operands.

use instr::{Form, Kind, Stored};
use ladder::{
    Branch, Element, Expression, Instruction, MessageSetup, Mnemonic, Operand, ProgramFile, ProgramFileKind, Rung,
    Series,
};
use rss::Text;
use rss::program::{self, Item, LadFile, ProgramFiles};

use super::Notes;
use super::documentation::Comments;

pub(crate) fn program_files(
    stored: &ProgramFiles<'_>,
    comments: &mut Comments,
    notes: &mut Notes<'_>,
) -> Vec<ProgramFile> {
    stored.files.iter().map(|file| program_file(file, comments, notes)).collect()
}

fn program_file(stored: &LadFile<'_>, comments: &mut Comments, notes: &mut Notes<'_>) -> ProgramFile {
    let number = stored.number;
    let rungs = stored.rungs.iter().enumerate().map(|(index, rung)| {
        notes.within(format!("file {number} > rung {index}"));
        let comment = match rung.comment_id {
            0 => None,
            id => {
                let comment = comments.shown(id);
                if comment.is_none() {
                    notes.warning(format!("expected rung comment {id} in the documentation database, found none"));
                }
                comment
            }
        };
        Rung { series: series(&rung.leg.items, notes), edited: rung.edited != 0, comment }
    });
    let rungs: Vec<Rung> = rungs.collect();
    ProgramFile {
        number,
        name: stored.name().trim_end().to_owned(),
        description: stored.description.decode().into_owned(),
        kind: kind(stored, number),
        rungs,
    }
}

/// Files 0 and 1 belong to the processor. A file with rungs is ladder whatever its flags say.
fn kind(stored: &LadFile<'_>, number: u16) -> ProgramFileKind {
    if !stored.rungs.is_empty() {
        ProgramFileKind::Ladder
    } else if number < 2 {
        ProgramFileKind::System
    } else if stored.flags & LadFile::NO_PROGRAM != 0 {
        ProgramFileKind::Unused
    } else {
        ProgramFileKind::Ladder
    }
}

/// The elements between the marks of a leg.
fn series(items: &[Item<'_>], notes: &mut Notes<'_>) -> Series {
    let mut elements = Vec::with_capacity(items.len().saturating_sub(2));
    for item in items {
        match item {
            Item::Instruction(stored) if stored.is_mark() => {}
            Item::Instruction(stored) => elements.push(Element::Instruction(instruction(stored, notes))),
            Item::Branch(branch) => elements.push(Element::Branch(legs(&branch.items, notes))),
            Item::Leg(leg) => {
                notes.warning("expected an instruction or a branch in a leg, found another leg".to_owned());
                elements.extend(series(&leg.items, notes));
            }
            Item::Null | Item::Reference(_) => {
                notes.warning(
                    "expected an instruction or a branch in a leg, found an empty or shared object".to_owned(),
                );
            }
        }
    }
    elements
}

fn legs(items: &[Item<'_>], notes: &mut Notes<'_>) -> Branch {
    let mut branch = Branch::default();
    for item in items {
        match item {
            Item::Leg(leg) => branch.legs.push(series(&leg.items, notes)),
            Item::Instruction(stored) if stored.is_mark() => {}
            other => {
                notes.warning(
                    "expected a leg in a branch, found something else; it is shown as a leg of its own".to_owned(),
                );
                branch.legs.push(series(std::slice::from_ref(other), notes));
            }
        }
    }
    branch
}

pub(crate) fn instruction(stored: &program::Instruction<'_>, notes: &mut Notes<'_>) -> Instruction {
    let known = instr::by_opcode(stored.opcode);
    let mnemonic = match known {
        Some((instruction, _)) => Mnemonic::named(instruction.mnemonic),
        None => {
            notes.warning(format!(
                "operation code {:#04x} belongs to no known instruction; it is shown by its number",
                stored.opcode
            ));
            Mnemonic::Unknown(stored.opcode)
        }
    };
    let texts = &stored.operands;
    let (operands, displayed) = match known {
        Some((_, form)) if form.string_count() == texts.len() => typed(form, texts),
        _ => {
            if let Some((instruction, form)) = known {
                notes.warning(format!(
                    "expected {} texts for {}, found {}; all are shown as operands",
                    form.string_count(),
                    instruction.mnemonic,
                    texts.len()
                ));
            }
            (texts.iter().map(|text| Operand::parse(&text.decode())).collect(), Vec::new())
        }
    };
    Instruction {
        mnemonic,
        operands,
        displayed,
        compiled: stored.has_code != 0,
        message: stored.message.as_ref().map(|setup| Box::new(message(setup))),
    }
}

/// Source texts become operands, value texts stay beside them as what was last displayed.
fn typed(form: &Form, texts: &[Text<'_>]) -> (Vec<Operand>, Vec<Option<String>>) {
    let mut operands = Vec::with_capacity(form.operands.len());
    let mut displayed = Vec::new();
    let mut rest = texts.iter();
    for (index, definition) in form.operands.iter().enumerate() {
        let text = rest.next().map(Text::decode).unwrap_or_default();
        operands.push(operand(definition.kind, &text));
        if definition.stored == Stored::SourceAndValue
            && let Some(value) = rest.next()
        {
            displayed.resize(index, None);
            displayed.push(Some(value.decode().into_owned()));
        }
    }
    if !displayed.is_empty() {
        displayed.resize(form.operands.len(), None);
    }
    (operands, displayed)
}

/// An expression of one operand looks like that operand; only the table tells them apart.
fn operand(kind: Kind, text: &str) -> Operand {
    if kind == Kind::Expression
        && let Ok(expression) = Expression::parse(text)
    {
        return Operand::Expression(expression);
    }
    Operand::parse(text)
}

fn message(setup: &program::MessageSetup<'_>) -> MessageSetup {
    let mut settings = Vec::new();
    let mut add = |name: &'static str, value: String| settings.push((name.into(), value));
    let text = |text: &Text<'_>| text.decode().into_owned();
    let bytes = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ");
    add("Communication Command", text(&setup.command));
    add("Channel", setup.channel.to_string());
    add("Message Timeout", text(&setup.timeout));
    add("Size in Elements", text(&setup.size));
    add("Target Data Table Address", text(&setup.target));
    add("Data Table Address", text(&setup.local));
    add("Node", text(&setup.node));
    add("Target Address", text(&setup.host));
    add("Routing Information", text(&setup.routing));
    for hop in &setup.hops {
        add("Hop Address", text(&hop.address));
        add("Hop h0", hop.h0.to_string());
        add("Hop h1", hop.h1.map(|n| n.to_string()).join(" "));
    }
    if let Some(cip) = &setup.cip {
        add("Service Code (hex)", text(&cip.service));
        for (names, values) in [
            (["Class (dec)", "Instance (dec)", "Attribute (dec)"], &cip.path_decimal),
            (["Class (hex)", "Instance (hex)", "Attribute (hex)"], &cip.path_hex),
        ] {
            for (name, value) in names.into_iter().zip(values) {
                add(name, text(value));
            }
        }
        add("Size in Bytes", text(&cip.length));
        add("Data Table Address (send)", text(&cip.data));
        add("g0", cip.g0.to_string());
        add("Cached Data", bytes(&cip.blob));
    }
    // What is not understood keeps its place in the record as its name.
    add("m0", setup.m0.to_string());
    add("m1", setup.m1.to_string());
    add("Status", format!("{:#06x}", setup.status));
    add("m2", setup.m2.to_string());
    add("m3", bytes(&setup.m3));
    add("m4", bytes(&setup.m4));
    add("m5", text(&setup.m5));
    add("m6", text(&setup.m6));
    add("m7", text(&setup.m7));
    add("m8", text(&setup.m8));
    add("m9", text(&setup.m9));
    add("m10", setup.m10.to_string());
    MessageSetup { settings }
}
