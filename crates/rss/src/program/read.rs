//! Reads program files. What was complete before an error stays.

use super::message::MessageSetup;
use super::{Branch, Instruction, Item, LadFile, Leg, Operands, ProgramFiles, Rung, mark};
use crate::archive::{Object, Reader};
use crate::error::Result;
use crate::text::Text;
use std::borrow::Cow;

/// Fewest bytes that a file, a rung, an instruction take, for checking counts.
const MIN_FILE: usize = 2 + 19;
const MIN_RUNG: usize = 2 + 2 + 2 + 12;
const MIN_ITEM: usize = 2;

pub(super) fn files<'a>(out: &mut ProgramFiles<'a>, r: &mut Reader<'a>) -> Result<()> {
    r.expect_object("CProgHolder")?;
    let count = r.count("a number of program files", MIN_FILE)?;
    // A count is a claim; beyond the usual numbers, items make their room as they come.
    out.files = Vec::with_capacity(count.min(256));
    r.mark();
    for index in 0..count {
        r.enter("file", index)?;
        out.files.push(LadFile::default());
        if let Some(file) = out.files.last_mut() {
            lad_file(file, index, r)?;
        }
        r.leave();
        r.mark();
    }
    Ok(())
}

fn lad_file<'a>(out: &mut LadFile<'a>, index: usize, r: &mut Reader<'a>) -> Result<()> {
    r.expect_object("CLadFile")?;
    out.rung_count = r.u16("a number of rungs")?;
    out.flags = r.u16("file flags")?;
    out.name = r.array("a file name")?;
    out.number = r.u16("a file number")?;
    if usize::from(out.number) != index {
        r.deviation(format_args!("file number {index}"), out.number)?;
    }
    out.description = r.string("a file description")?;
    let count = r.count("a number of rungs", MIN_RUNG)?;
    if usize::from(out.rung_count) != count {
        r.deviation(format_args!("{} rungs, as stated before the name", out.rung_count), count)?;
    }
    out.rungs.reserve_exact(count.min(1024));
    r.mark();
    for index in 0..count {
        r.enter("rung", index)?;
        out.rungs.push(BLANK_RUNG);
        let read = out.rungs.last_mut().map_or(Ok(()), |out| rung(out, r));
        if read.is_err() {
            // Only complete rungs stay.
            out.rungs.pop();
        }
        read?;
        r.leave();
        r.mark();
    }
    Ok(())
}

fn rung<'a>(out: &mut Rung<'a>, r: &mut Reader<'a>) -> Result<()> {
    r.expect_object("CRung")?;
    r.expect_object("CBranchLeg")?;
    items(&mut out.leg.items, r, &RUNG)?;
    out.unknown_0 = r.u32("the first field after the leg")?;
    out.edited = r.u32("the edit mark")?;
    out.comment_id = r.u32("a comment id")?;
    Ok(())
}

/// What a list of items has to look like.
struct Shape {
    start: u16,
    end: u16,
    /// Branches hold legs and nothing but their marks; legs hold anything else.
    is_branch: bool,
    name: &'static str,
}

const RUNG: Shape = Shape { start: mark::RUNG_START, end: mark::RUNG_END, is_branch: false, name: "rung" };
const BRANCH: Shape = Shape { start: mark::BRANCH_START, end: mark::BRANCH_END, is_branch: true, name: "branch" };
const LEG: Shape = Shape { start: mark::LEG_START, end: mark::LEG_END, is_branch: false, name: "leg" };

fn items<'a>(items: &mut Vec<Item<'a>>, r: &mut Reader<'a>, shape: &Shape) -> Result<()> {
    let at = r.offset();
    let count = r.count("a number of instructions", MIN_ITEM)?;
    // A null takes two bytes but an `Item` far more: grow with what is really there.
    items.reserve_exact(count.min(64));
    for index in 0..count {
        if r.try_object("CIns") {
            fill(items, index, r)?;
            continue;
        }
        if r.try_object("CBranchLeg") {
            leg(items, r, index)?;
        } else if r.try_object("CBranch") {
            branch(items, r, index)?;
        } else {
            let at = r.offset();
            match r.object()? {
                Object::New { class, .. } if class.name == b"CIns" => fill(items, index, r)?,
                Object::New { class, .. } if class.name == b"CBranchLeg" => leg(items, r, index)?,
                Object::New { class, .. } if class.name == b"CBranch" => branch(items, r, index)?,
                Object::Null => items.push(Item::Null),
                Object::Reference { number } => items.push(Item::Reference(number)),
                other => return Err(r.unexpected(at, "CIns, CBranch or CBranchLeg", &other)),
            }
        }
    }
    if !fits(items, shape) {
        r.deviation_at(
            at,
            format_args!("a {} between its marks {} and {}", shape.name, shape.start, shape.end),
            describe(items),
        )?;
    }
    Ok(())
}

/// Appends an instruction, filled where it stays: of all the reading, moving
/// instructions about would cost the most.
#[inline]
fn fill<'a>(items: &mut Vec<Item<'a>>, index: usize, r: &mut Reader<'a>) -> Result<()> {
    r.enter("instruction", index)?;
    items.push(BLANK_INSTRUCTION);
    if let Some(Item::Instruction(out)) = items.last_mut() {
        instruction(out, r)?;
    }
    r.leave();
    Ok(())
}

fn branch<'a>(out: &mut Vec<Item<'a>>, r: &mut Reader<'a>, index: usize) -> Result<()> {
    r.enter("branch", index)?;
    out.push(BLANK_BRANCH);
    if let Some(Item::Branch(branch)) = out.last_mut() {
        items(&mut branch.items, r, &BRANCH)?;
    }
    r.leave();
    Ok(())
}

fn leg<'a>(out: &mut Vec<Item<'a>>, r: &mut Reader<'a>, index: usize) -> Result<()> {
    r.enter("leg", index)?;
    out.push(BLANK_LEG);
    if let Some(Item::Leg(leg)) = out.last_mut() {
        items(&mut leg.items, r, &LEG)?;
    }
    r.leave();
    Ok(())
}

// Appended and then filled. Constants, so that appending is one plain copy.
const BLANK_RUNG: Rung<'static> = Rung { leg: Leg { items: Vec::new() }, unknown_0: 0, edited: 0, comment_id: 0 };
const BLANK_LEG: Item<'static> = Item::Leg(Leg { items: Vec::new() });
const BLANK_BRANCH: Item<'static> = Item::Branch(Branch { items: Vec::new() });
const BLANK_INSTRUCTION: Item<'static> = Item::Instruction(Instruction {
    operands: Operands::one(Text::from_bytes(&[])),
    has_code: 0,
    opcode: 0,
    x: 0,
    y: 0,
    code: Cow::Borrowed(&[]),
    message: None,
});

#[inline]
fn instruction<'a>(out: &mut Instruction<'a>, r: &mut Reader<'a>) -> Result<()> {
    let count = r.count("a number of operands", 1)?;
    match count {
        1 => out.operands = Operands::one(r.string("an operand")?),
        0 => out.operands = Operands::none(),
        _ => {
            let mut operands = Vec::new();
            r.strings("an operand", count, &mut operands)?;
            out.operands = operands.into();
        }
    }
    let at = r.offset();
    let [h0, h1, o0, o1, x0, x1, y0, y1] = r.array("code mark, opcode, x and y")?;
    out.has_code = u16::from_le_bytes([h0, h1]);
    out.opcode = u16::from_le_bytes([o0, o1]);
    out.x = u16::from_le_bytes([x0, x1]);
    out.y = u16::from_le_bytes([y0, y1]);
    if out.has_code > 1 {
        r.deviation_at(at, "code mark 0 or 1", out.has_code)?;
    }
    if out.has_code != 0 {
        let length = r.count("a code length", 1)?;
        let code = r.bytes("compiled code", length)?;
        if code.first().map(|&b| u16::from(b)) != Some(out.opcode) {
            r.deviation_at(
                r.offset() - length,
                format_args!("code that begins with opcode {:#04x}", out.opcode),
                format_args!("{:02x?}", code.get(..code.len().min(8)).unwrap_or_default()),
            )?;
        }
        out.code = Cow::Borrowed(code);
    }
    if let Some(presence) = MessageSetup::presence(out.opcode) {
        out.message = MessageSetup::read_optional(r, presence, out.has_code != 0)?;
    }
    Ok(())
}

fn fits(items: &[Item<'_>], shape: &Shape) -> bool {
    let is = |item: &Item<'_>, opcode: u16| item.as_instruction().is_some_and(|i| i.opcode == opcode);
    let [first, inner @ .., last] = items else { return false };
    is(first, shape.start)
        && is(last, shape.end)
        && inner.iter().all(|item| match item {
            Item::Leg(_) => shape.is_branch,
            Item::Branch(_) => !shape.is_branch,
            Item::Instruction(i) => !shape.is_branch && !i.is_mark(),
            Item::Null | Item::Reference(_) => false,
        })
}

/// A row of item kinds for a message: `ins 0x39, branch, ins 0x1`.
fn describe(items: &[Item<'_>]) -> String {
    let mut parts: Vec<String> = items
        .iter()
        .take(8)
        .map(|item| match item {
            Item::Instruction(i) => format!("instruction {:#x}", i.opcode),
            Item::Branch(_) => "branch".to_owned(),
            Item::Leg(_) => "leg".to_owned(),
            Item::Null => "null".to_owned(),
            Item::Reference(n) => format!("reference to object {n}"),
        })
        .collect();
    if items.len() > 8 {
        parts.push(format!("{} more", items.len() - 8));
    }
    if parts.is_empty() { "nothing".to_owned() } else { parts.join(", ") }
}
