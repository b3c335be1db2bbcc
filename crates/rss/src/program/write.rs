//! Writes program files, the mirror of reading them.

use super::{Branch, Instruction, Item, LadFile, Leg, ProgramFiles, Rung};
use crate::archive::Writer;
use crate::error::{Error, Result};

pub(super) fn files(files: &ProgramFiles<'_>, w: &mut Writer) -> Result<()> {
    w.object("CProgHolder");
    w.count(files.files.len())?;
    files.files.iter().try_for_each(|file| lad_file(file, w))
}

fn lad_file(file: &LadFile<'_>, w: &mut Writer) -> Result<()> {
    w.object("CLadFile");
    w.u16(file.rung_count);
    w.u16(file.flags);
    w.bytes(&file.name);
    w.u16(file.number);
    w.string(&file.description)?;
    w.count(file.rungs.len())?;
    file.rungs.iter().try_for_each(|rung| self::rung(rung, w))
}

fn rung(rung: &Rung<'_>, w: &mut Writer) -> Result<()> {
    w.object("CRung");
    leg(&rung.leg, w)?;
    w.u32(rung.unknown_0);
    w.u32(rung.edited);
    w.u32(rung.comment_id);
    Ok(())
}

fn leg(leg: &Leg<'_>, w: &mut Writer) -> Result<()> {
    w.object("CBranchLeg");
    items(&leg.items, w)
}

fn items(items: &[Item<'_>], w: &mut Writer) -> Result<()> {
    w.count(items.len())?;
    for item in items {
        match item {
            Item::Instruction(i) => instruction(i, w)?,
            Item::Branch(Branch { items }) => {
                w.object("CBranch");
                self::items(items, w)?;
            }
            Item::Leg(l) => leg(l, w)?,
            Item::Null => w.null(),
            Item::Reference(number) => w.reference(*number),
        }
    }
    Ok(())
}

fn instruction(i: &Instruction<'_>, w: &mut Writer) -> Result<()> {
    w.object("CIns");
    w.count(i.operands.len())?;
    for operand in &i.operands {
        w.string(operand)?;
    }
    w.u16(i.has_code);
    w.u16(i.opcode);
    w.u16(i.x);
    w.u16(i.y);
    if i.has_code != 0 {
        w.count(i.code.len())?;
        w.bytes(&i.code);
    } else if !i.code.is_empty() {
        return Err(Error::Unwritable(format!("instruction {:#x} has code but its code mark is 0", i.opcode)));
    }
    if let Some(message) = &i.message {
        message.write(w)?;
    }
    Ok(())
}
