//! `MEM DATABASE`: symbols, descriptions, instruction comments, rung comments and page titles.

use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::text::Text;

/// Lines of a description or an instruction comment.
pub const LINES: usize = 5;

/// The `DBXMemMap` record. Evidence per field: `docs/format/mem-database.md`.
///
/// The lists keep the stored order, which is that of a hash map; nothing may
/// be told from a position.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Database<'a> {
    /// Counters and limits.
    pub header: Header<'a>,
    /// Documented addresses, program and data files, labels.
    pub addresses: Vec<Entry<'a>>,
    /// Comments for one address under one mnemonic.
    pub instruction_comments: Vec<Entry<'a>>,
    /// Index of the instruction comments by mnemonic.
    pub mnemonics: Vec<Mnemonic<'a>>,
    /// Rung comments and page titles.
    pub comments: Vec<Comment<'a>>,
    /// Count of symbol groups; 0 in every known project.
    pub group_count: usize,
    /// What follows a group count other than 0: the layout is unknown.
    pub groups: &'a [u8],
}

/// Start of the record. Fields without a name are named by their position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Header<'a> {
    /// Version of the database, 1 (inferred).
    pub version: u32,
    /// Longest symbol, 20 characters (inferred).
    pub symbol_width: u32,
    /// Lines of a description, 5 (proven as the number stored).
    pub description_lines: u32,
    /// Width of a description line, 20 characters (inferred).
    pub description_width: u32,
    /// 0 (unknown).
    pub field_4: u32,
    /// 5 (unknown; perhaps the lines of an instruction comment).
    pub field_5: u32,
    /// Last message of the database editor (inferred).
    pub message: Text<'a>,
    /// 40 (unknown).
    pub field_7: u32,
    /// Highest address record id ever given (proven).
    pub last_address_id: u32,
    /// Highest instruction comment id ever given (proven).
    pub last_instruction_id: u32,
    /// Highest rung comment id ever given (proven).
    pub last_comment_id: u32,
    /// 0; probably the same for symbol groups (inferred).
    pub last_group_id: u32,
}

impl Default for Header<'_> {
    /// The header of an empty database, as RSLogix writes it.
    fn default() -> Self {
        Header {
            version: 1,
            symbol_width: 20,
            description_lines: 5,
            description_width: 20,
            field_4: 0,
            field_5: 5,
            message: Text::default(),
            field_7: 40,
            last_address_id: 0,
            last_instruction_id: 0,
            last_comment_id: 0,
            last_group_id: 0,
        }
    }
}

/// A record of either list.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Entry<'a> {
    /// Id, unique in its list.
    pub id: u32,
    /// 0 (unknown).
    pub field_1: u32,
    /// 0 (unknown).
    pub field_2: u32,
    /// Address key exactly as stored, e.g. `B0003:009/02`; empty in instruction comments.
    pub key: Text<'a>,
    /// Symbol; empty in instruction comments.
    pub symbol: Text<'a>,
    /// Description lines, or the lines of the instruction comment. Blank lines keep their place.
    pub lines: [Text<'a>; LINES],
    /// Three strings, empty in every known project (unknown).
    pub fields_10_to_12: [Text<'a>; 3],
    /// Mnemonic of an instruction comment; empty in address records.
    pub mnemonic: Text<'a>,
    /// Id of the address record: its own in address records.
    pub address_id: u32,
    /// 0 (unknown).
    pub field_15: u32,
}

/// Smallest stored entry: six numbers and eleven empty strings.
const ENTRY_BYTES: usize = 5 * 4 + 11;

impl<'a> Entry<'a> {
    fn read(r: &mut Reader<'a>) -> Result<Self> {
        Ok(Entry {
            id: r.u32("a record id")?,
            field_1: r.u32("field 1 of a record")?,
            field_2: r.u32("field 2 of a record")?,
            key: r.string("an address key")?,
            symbol: r.string("a symbol")?,
            lines: [
                r.string("description line 1")?,
                r.string("description line 2")?,
                r.string("description line 3")?,
                r.string("description line 4")?,
                r.string("description line 5")?,
            ],
            fields_10_to_12: [
                r.string("field 10 of a record")?,
                r.string("field 11 of a record")?,
                r.string("field 12 of a record")?,
            ],
            mnemonic: r.string("a mnemonic")?,
            address_id: r.u32("an address record id")?,
            field_15: r.u32("field 15 of a record")?,
        })
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.u32(self.id);
        w.u32(self.field_1);
        w.u32(self.field_2);
        w.string(&self.key)?;
        w.string(&self.symbol)?;
        for text in self.lines.iter().chain(&self.fields_10_to_12) {
            w.string(text)?;
        }
        w.string(&self.mnemonic)?;
        w.u32(self.address_id);
        w.u32(self.field_15);
        Ok(())
    }

    /// True if no line holds a character.
    #[must_use]
    pub fn is_blank(&self) -> bool {
        self.lines.iter().all(Text::is_empty)
    }
}

/// One mnemonic of the index, with its instruction comments.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Mnemonic<'a> {
    /// Mnemonic, e.g. `XIC`; `0` for leftovers of an import.
    pub mnemonic: Text<'a>,
    /// (address record id, instruction comment id) in stored order.
    pub uses: Vec<(u32, u32)>,
}

/// A rung comment, a page title, or both.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Comment<'a> {
    /// Id that the rung refers to.
    pub id: u32,
    /// Comment text; lines end in CR LF.
    pub text: Text<'a>,
    /// Page title, one line.
    pub title: Text<'a>,
    /// `RUNGffffff-rrrrrr` or an address key, exactly as stored; see [`Comment::rung`].
    pub key: Text<'a>,
}

impl Comment<'_> {
    /// Program file and rung (from 0) that the key names; `None` for a comment
    /// that is attached to an address. For display follow the id in the rung.
    #[must_use]
    pub fn rung(&self) -> Option<(u32, u32)> {
        parse_rung_key(self.key.as_bytes())
    }
}

fn parse_rung_key(key: &[u8]) -> Option<(u32, u32)> {
    let digits = key.strip_prefix(b"RUNG")?;
    let (file, rest) = digits.split_at_checked(6)?;
    let rung = rest.strip_prefix(b"-")?;
    let number = |digits: &[u8]| {
        if digits.len() != 6 || !digits.iter().all(u8::is_ascii_digit) {
            return None;
        }
        std::str::from_utf8(digits).ok()?.parse().ok()
    };
    Some((number(file)?, number(rung)?))
}

/// The key of a comment on a program file's rung (counted from 0).
#[must_use]
pub fn rung_key(file: u32, rung: u32) -> String {
    format!("RUNG{file:06}-{rung:06}")
}

impl<'a> Record<'a> for Database<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("DBXMemMap")?;
        r.enter_named("header")?;
        self.header = read_header(r)?;
        r.leave();
        r.mark();
        read_entries(r, "a number of address records", "address record", &mut self.addresses)?;
        read_entries(r, "a number of instruction comments", "instruction comment", &mut self.instruction_comments)?;
        let count = r.count("a number of mnemonics", 3)?;
        self.mnemonics.reserve_exact(count.min(RESERVE));
        for index in 0..count {
            r.enter("mnemonic", index)?;
            let mnemonic = r.string("a mnemonic")?;
            let uses = r.count("a number of index entries", 8)?;
            let mut entry = Mnemonic { mnemonic, uses: Vec::with_capacity(uses) };
            for _ in 0..uses {
                let address = r.u32("an address record id")?;
                let comment = r.u32("an instruction comment id")?;
                entry.uses.push((address, comment));
            }
            self.mnemonics.push(entry);
            r.leave();
            r.mark();
        }
        let count = r.count("a number of rung comments", 7)?;
        self.comments.reserve_exact(count.min(RESERVE));
        for index in 0..count {
            r.enter("rung comment", index)?;
            self.comments.push(Comment {
                id: r.u32("a comment id")?,
                text: r.string("a comment")?,
                title: r.string("a page title")?,
                key: r.string("a comment key")?,
            });
            r.leave();
            r.mark();
        }
        self.group_count = r.count("a number of symbol groups", 0)?;
        r.mark();
        if self.group_count != 0 {
            let found = self.group_count;
            r.deviation("no symbol group (their layout is unknown)", format_args!("{found} groups, carried as bytes"))?;
            self.groups = r.opaque("symbol groups", r.remaining())?;
        }
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("DBXMemMap");
        write_header(&self.header, w)?;
        for list in [&self.addresses, &self.instruction_comments] {
            w.count(list.len())?;
            for entry in list {
                entry.write(w)?;
            }
        }
        w.count(self.mnemonics.len())?;
        for entry in &self.mnemonics {
            w.string(&entry.mnemonic)?;
            w.count(entry.uses.len())?;
            for (address, comment) in &entry.uses {
                w.u32(*address);
                w.u32(*comment);
            }
        }
        w.count(self.comments.len())?;
        for comment in &self.comments {
            w.u32(comment.id);
            w.string(&comment.text)?;
            w.string(&comment.title)?;
            w.string(&comment.key)?;
        }
        w.count(self.group_count)?;
        w.bytes(self.groups);
        Ok(())
    }
}

fn read_header<'a>(r: &mut Reader<'a>) -> Result<Header<'a>> {
    Ok(Header {
        version: r.u32("the version")?,
        symbol_width: r.u32("the longest symbol")?,
        description_lines: r.u32("the number of description lines")?,
        description_width: r.u32("the width of a description line")?,
        field_4: r.u32("header field 4")?,
        field_5: r.u32("header field 5")?,
        message: r.string("the last message")?,
        field_7: r.u32("header field 7")?,
        last_address_id: r.u32("the last address record id")?,
        last_instruction_id: r.u32("the last instruction comment id")?,
        last_comment_id: r.u32("the last rung comment id")?,
        last_group_id: r.u32("the last symbol group id")?,
    })
}

fn write_header(header: &Header<'_>, w: &mut Writer) -> Result<()> {
    for field in [
        header.version,
        header.symbol_width,
        header.description_lines,
        header.description_width,
        header.field_4,
        header.field_5,
    ] {
        w.u32(field);
    }
    w.string(&header.message)?;
    for field in [
        header.field_7,
        header.last_address_id,
        header.last_instruction_id,
        header.last_comment_id,
        header.last_group_id,
    ] {
        w.u32(field);
    }
    Ok(())
}

/// Room reserved ahead for a list. A count is a claim: an entry takes ten times
/// as many bytes in memory as it may take in the stream.
const RESERVE: usize = 1 << 12;

fn read_entries<'a>(
    r: &mut Reader<'a>,
    count_of: &'static str,
    what: &'static str,
    list: &mut Vec<Entry<'a>>,
) -> Result<()> {
    let count = r.count(count_of, ENTRY_BYTES)?;
    list.reserve_exact(count.min(RESERVE));
    for index in 0..count {
        r.enter(what, index)?;
        list.push(Entry::read(r)?);
        r.leave();
        r.mark();
    }
    r.mark();
    Ok(())
}

#[cfg(test)]
mod tests;
