//! "Processor Information" and "I/O Configuration".

use super::{Page, cells};

/// The page "Processor Information".
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Processor {
    /// For example `Bul.1763 MicroLogix 1100 Series B`, runs of spaces made one.
    pub kind: String,
    /// "Processor Name".
    pub name: String,
    /// "Instruction Words Used" and "Data Table Words Used"; `None` where `*` is printed
    /// because the project was never verified.
    pub used: Option<(u32, u32)>,
    /// "Instruction Words Left"; `None` where `*` is printed.
    pub left: Option<u32>,
    /// Number of program files.
    pub program_files: u32,
    /// Number of data files.
    pub data_files: u32,
    /// "Program ID", printed in hexadecimal.
    pub program_id: Option<u16>,
}

/// A slot of the page "I/O Configuration".
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct IoRow {
    /// Slot number.
    pub slot: u16,
    /// Catalogue number, for example `1762-IQ8`; empty for an empty slot.
    pub catalog: String,
    /// Description, for example `8-Input 10/30 VDC`.
    pub description: String,
}

pub(super) fn read(found: &mut Processor, page: &Page) -> Vec<String> {
    let lines = page.lines.iter().filter(|l| !l.is_empty());
    lines.filter(|line| read_line(found, line).is_none()).cloned().collect()
}

fn read_line(found: &mut Processor, line: &str) -> Option<()> {
    let (label, value) = line.trim().split_once(':')?;
    let value = value.trim();
    match label {
        "Processor Type" => found.kind = value.split_whitespace().collect::<Vec<_>>().join(" "),
        "Processor Name" => value.clone_into(&mut found.name),
        "Total Memory Used" if value == "*" => found.used = None,
        "Total Memory Used" => {
            let (code, data) = value.split_once(" Instruction Words Used - ")?;
            let data = data.strip_suffix(" Data Table Words Used")?;
            found.used = Some((code.parse().ok()?, data.parse().ok()?));
        }
        "Total Memory Left" if value == "*" => found.left = None,
        "Total Memory Left" => {
            found.left = Some(value.strip_suffix(" Instruction Words Left")?.parse().ok()?);
        }
        "Program Files" => found.program_files = value.parse().ok()?,
        "Data Files" => found.data_files = value.parse().ok()?,
        "Program ID" => found.program_id = Some(u16::from_str_radix(value, 16).ok()?),
        _ => return None,
    }
    Some(())
}

pub(super) fn read_io(rows: &mut Vec<IoRow>, page: &Page) -> Vec<String> {
    let mut lost = Vec::new();
    for line in page.lines.iter().filter(|l| !l.is_empty()) {
        let cells = cells(line);
        let mut texts = cells.into_iter().map(|c| c.text);
        let slot = texts.next().and_then(|t| t.parse().ok());
        let (catalog, description) = (texts.next().unwrap_or_default(), texts.next().unwrap_or_default());
        match (slot, texts.next()) {
            (Some(slot), None) => rows.push(IoRow { slot, catalog, description }),
            _ => lost.push(line.clone()),
        }
    }
    lost
}
