//! Reads program files. What was complete before an error stays.

use super::message::MessageSetup;
use super::{Branch, Instruction, Item, LadFile, Leg, ProgramFiles, Rung, mark};
use crate::archive::{Object, Reader};
use crate::error::Result;
use std::borrow::Cow;

/// Fewest bytes that a file, a rung, an instruction take, for checking counts.
const MIN_FILE: usize = 2 + 19;
const MIN_RUNG: usize = 2 + 2 + 2 + 12;
const MIN_ITEM: usize = 2;

pub(super) fn files<'a>(out: &mut ProgramFiles<'a>, r: &mut Reader<'a>) -> Result<()> {
    r.expect_object("CProgHolder")?;
    let count = r.count("a number of program files", MIN_FILE)?;
    out.files = Vec::with_capacity(count);
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
    out.rungs.reserve_exact(count);
    r.mark();
    for index in 0..count {
        r.enter("rung", index)?;
        let rung = rung(r)?;
        out.rungs.push(rung);
        r.leave();
        r.mark();
    }
    Ok(())
}

fn rung<'a>(r: &mut Reader<'a>) -> Result<Rung<'a>> {
    r.expect_object("CRung")?;
    r.expect_object("CBranchLeg")?;
    let leg = Leg { items: items(r, &RUNG)? };
    Ok(Rung {
        leg,
        unknown_0: r.u32("the first field after the leg")?,
        edited: r.u32("the edit mark")?,
        comment_id: r.u32("a comment id")?,
    })
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

fn items<'a>(r: &mut Reader<'a>, shape: &Shape) -> Result<Vec<Item<'a>>> {
    let at = r.offset();
    let count = r.count("a number of instructions", MIN_ITEM)?;
    // A null takes two bytes but an `Item` far more: grow with what is really there.
    let mut items = Vec::with_capacity(count.min(64));
    for index in 0..count {
        let item = item(r, index)?;
        items.push(item);
    }
    if !fits(&items, shape) {
        r.deviation_at(
            at,
            format_args!("a {} between its marks {} and {}", shape.name, shape.start, shape.end),
            describe(&items),
        )?;
    }
    Ok(items)
}

fn item<'a>(r: &mut Reader<'a>, index: usize) -> Result<Item<'a>> {
    let at = r.offset();
    match r.object()? {
        Object::New { class, .. } => match class.name {
            b"CIns" => {
                r.enter("instruction", index)?;
                let instruction = instruction(r)?;
                r.leave();
                Ok(Item::Instruction(instruction))
            }
            b"CBranch" => {
                r.enter("branch", index)?;
                let items = items(r, &BRANCH)?;
                r.leave();
                Ok(Item::Branch(Branch { items }))
            }
            b"CBranchLeg" => {
                r.enter("leg", index)?;
                let items = items(r, &LEG)?;
                r.leave();
                Ok(Item::Leg(Leg { items }))
            }
            _ => Err(r.unexpected(at, "CIns, CBranch or CBranchLeg", &Object::New { class, number: 0 })),
        },
        Object::Null => Ok(Item::Null),
        Object::Reference { number } => Ok(Item::Reference(number)),
    }
}

fn instruction<'a>(r: &mut Reader<'a>) -> Result<Instruction<'a>> {
    let count = r.count("a number of operands", 1)?;
    let mut operands = Vec::with_capacity(count.min(16));
    for _ in 0..count {
        operands.push(r.string("an operand")?);
    }
    let mut out = Instruction {
        operands,
        has_code: r.u16("the code mark")?,
        opcode: r.u16("an opcode")?,
        x: r.u16("x")?,
        y: r.u16("y")?,
        ..Instruction::default()
    };
    if out.has_code > 1 {
        r.deviation_at(r.offset() - 8, "code mark 0 or 1", out.has_code)?;
    }
    if out.has_code != 0 {
        let length = r.count("a code length", 1)?;
        let at = r.offset();
        let code = r.bytes("compiled code", length)?;
        if code.first().map(|&b| u16::from(b)) != Some(out.opcode) {
            r.deviation_at(
                at,
                format_args!("code that begins with opcode {:#04x}", out.opcode),
                format_args!("{:02x?}", code.get(..code.len().min(8)).unwrap_or_default()),
            )?;
        }
        out.code = Cow::Borrowed(code);
    }
    if let Some(presence) = MessageSetup::presence(out.opcode) {
        out.message = MessageSetup::read_optional(r, presence, out.has_code != 0)?.map(Box::new);
    }
    Ok(out)
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
