//! Documentation to `MEM DATABASE`: ids given anew, keys in stored form, the mnemonic index in step.

use std::collections::HashMap;

use ladder::{Comment, CommentOwner, Documentation, Target};
use rss::database::{self, Database, Entry, Header, LINES, Mnemonic};
use rss::{Error, Result, Text};

use super::{Notes, owned, text};
use crate::from_rss::documentation::key;

/// Rung comments as the rungs hand them in, with the ids they get.
#[derive(Default)]
pub(super) struct CommentWriter {
    comments: Vec<database::Comment<'static>>,
}

impl CommentWriter {
    /// The id of a comment. One attached to an address is shared by the rungs that show it.
    pub(super) fn id(&mut self, comment: &Comment, file: u16, rung: usize) -> Result<u32> {
        let key = match &comment.owner {
            // The rung's own place counts, wherever the comment came from.
            CommentOwner::Rung { .. } => format!("RUNG{file:06}-{rung:06}"),
            CommentOwner::Address(target) => key(target),
        };
        let shared = matches!(comment.owner, CommentOwner::Address(_));
        let same = |known: &&database::Comment<'_>| {
            known.key == key.as_str() && known.text == comment.text.as_str() && known.title == comment.title.as_str()
        };
        if let Some(known) = self.comments.iter().find(same).filter(|_| shared) {
            return Ok(known.id);
        }
        self.push(comment, key)
    }

    fn push(&mut self, comment: &Comment, key: String) -> Result<u32> {
        let id = number(self.comments.len() + 1)?;
        self.comments.push(database::Comment {
            id,
            text: owned(comment.text.clone())?,
            title: owned(comment.title.clone())?,
            key: owned(key)?,
        });
        Ok(id)
    }
}

/// Longest symbol and widest description line that RSLogix takes.
const WIDTH: usize = 20;

pub(super) fn database<'a>(
    documentation: &'a Documentation,
    mut comments: CommentWriter,
    notes: &mut Notes,
) -> Result<Database<'a>> {
    for comment in &documentation.detached_comments {
        let key = match &comment.owner {
            CommentOwner::Rung { file, rung } => format!("RUNG{file:06}-{rung:06}"),
            CommentOwner::Address(target) => key(target),
        };
        comments.push(comment, key)?;
    }
    let mut addresses = Vec::new();
    let mut ids: HashMap<&Target, u32> = HashMap::new();
    for entry in documentation.entries() {
        let id = number(addresses.len() + 1)?;
        ids.entry(&entry.target).or_insert(id);
        let wide = |text: &String| text.chars().count() > WIDTH;
        let of_file = matches!(entry.target, Target::ProgramFile(_) | Target::DataFile(_));
        if wide(&entry.symbol) || (!of_file && entry.description.iter().any(wide)) {
            let place = format!("documentation of {}", entry.target);
            notes.warning(
                place,
                format!("RSLogix takes symbols and description lines of {WIDTH} characters; this is longer"),
            );
        }
        addresses.push(Entry {
            id,
            key: owned(key(&entry.target))?,
            symbol: text(&entry.symbol)?,
            lines: if of_file { pieces(&entry.description)? } else { lines(&entry.description)? },
            address_id: id,
            ..Entry::default()
        });
    }
    let mut instruction_comments = Vec::new();
    let mut mnemonics: Vec<Mnemonic<'_>> = Vec::new();
    for comment in documentation.instruction_comments() {
        let id = number(instruction_comments.len() + 1)?;
        let address_id = comment.target.as_ref().and_then(|target| ids.get(target).copied()).unwrap_or(0);
        let mnemonic = text(&comment.mnemonic)?;
        match mnemonics.iter_mut().find(|known| known.mnemonic == mnemonic) {
            Some(known) => known.uses.push((address_id, id)),
            None => mnemonics.push(Mnemonic { mnemonic: mnemonic.clone(), uses: vec![(address_id, id)] }),
        }
        instruction_comments.push(Entry {
            id,
            lines: lines(&comment.lines)?,
            mnemonic,
            address_id,
            ..Entry::default()
        });
    }
    let header = Header {
        last_address_id: number(addresses.len())?,
        last_instruction_id: number(instruction_comments.len())?,
        last_comment_id: number(comments.comments.len())?,
        ..Header::default()
    };
    // Entries come in the order of a hash map: groups of 16 ids, descending inside a group.
    addresses.sort_by_key(|entry| order(entry.id));
    instruction_comments.sort_by_key(|entry| order(entry.id));
    let mut comments = comments.comments;
    comments.sort_by_key(|comment| order(comment.id));
    Ok(Database { header, addresses, instruction_comments, mnemonics, comments, ..Database::default() })
}

pub(super) fn order(id: u32) -> (u32, std::cmp::Reverse<u32>) {
    (id >> 4, std::cmp::Reverse(id))
}

fn number(count: usize) -> Result<u32> {
    u32::try_from(count).map_err(|_| Error::Unwritable(format!("{count} entries of documentation")))
}

/// Descriptions of files are stored cut into pieces of the line's width, without regard to words.
pub(super) fn pieces(description: &[String]) -> Result<[Text<'static>; LINES]> {
    let mut stored: [Text<'static>; LINES] = Default::default();
    let cut = description.iter().flat_map(|line| {
        let characters: Vec<char> = line.chars().collect();
        let pieces: Vec<String> = characters.chunks(WIDTH).map(|piece| piece.iter().collect()).collect();
        // A blank line keeps its place.
        if pieces.is_empty() { vec![String::new()] } else { pieces }
    });
    for (place, piece) in stored.iter_mut().zip(cut) {
        *place = owned(piece)?;
    }
    Ok(stored)
}

pub(super) fn lines(lines: &[String]) -> Result<[Text<'_>; LINES]> {
    let mut stored: [Text<'_>; LINES] = Default::default();
    if lines.len() > LINES {
        return Err(Error::Unwritable(format!("a description of {} lines, {LINES} fit", lines.len())));
    }
    for (place, line) in stored.iter_mut().zip(lines) {
        *place = text(line)?;
    }
    Ok(stored)
}
