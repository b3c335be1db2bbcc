//! ASCII instructions: strings joined, and why the others are left to a person.

use ladder::{FileType, Instruction, Operand};

use super::allocate::Block;
use super::context::{Context, Converted, Person};
use super::emit::Emitter;
use super::marks::Mark;
use super::table::{Row, row};

pub(super) const TABLE: &[Row] = &[
    row("ACN", join),
    row("ASR", |_, _, _| text("compares two strings: no contact of Do-more that does is known in text")),
    row("ASC", |_, _, _| text("looks for a string in another: the text form of such a box is not known")),
    row("AEX", |_, _, _| text("takes a part out of a string: the text form of such a box is not known")),
    row("ACI", |_, _, _| text("reads a number from a string: the text form of such a box is not known")),
    row("AIC", |_, _, _| text("writes a number to a string: STRPRINT does, but how it formats one is not decoded")),
    row("ABL", port),
    row("ACB", port),
    row("ACL", port),
    row("AHL", port),
    row("ARD", port),
    row("ARL", port),
    row("AWA", port),
    row("AWT", port),
];

fn text(why: &str) -> Converted {
    Err(Person::new(Mark::Text, why))
}

fn port(_: &mut Context<'_>, _: &mut Emitter, i: &Instruction) -> Converted {
    let text =
        format!("{}: a serial port with its buffers, its line and its protocol is set up anew in Do-more", i.mnemonic);
    Err(Person::new(Mark::NoCounterpart, text))
}

/// The string element an operand names.
fn string(cx: &Context<'_>, i: &Instruction, index: usize) -> Converted<String> {
    let address = i.operands.get(index).and_then(Operand::address);
    let address = address.filter(|address| address.file_type == FileType::ST && address.is_direct());
    let place = address.and_then(|address| cx.places.word_of(address));
    let element = place.and_then(|(file_type, file, word)| cx.places.element(file_type, file, word));
    let shown = i.operands.get(index).map(ToString::to_string).unwrap_or_default();
    element
        .map(|element| element.to_string())
        .ok_or_else(|| Person::new(Mark::Text, format!("{shown}: no string known before the run")))
}

/// ACN: source A, then source B.
fn join(cx: &mut Context<'_>, e: &mut Emitter, i: &Instruction) -> Converted {
    let (a, b, to) = (string(cx, i, 0)?, string(cx, i, 1)?, string(cx, i, 2)?);
    cx.condition(
        Mark::Text,
        "the two strings have at most 82 characters together: what is more is cut there, with S:5/15",
    );
    cx.condition(Mark::Text, "STRPRINT with flags 0x4 puts no blank between its items");
    let items = domore::address::quote(&format!("{a} {b}"));
    let print = |e: &mut Emitter, to: &str| e.output("STRPRINT", [to, "0x4", items.as_str()]);
    if to == a || to == b {
        let kept = cx.helper(Block::Sl, "slcText", "strings joined, free after its rung");
        print(e, &kept);
        e.output("MEMCOPY", [kept.as_str(), to.as_str(), "0x20000", "1"]);
    } else {
        print(e, &to);
    }
    Ok(())
}
