//! `MEM DATABASE` of ours with merged entries. Ids stay: the online image refers to comments by them.

use std::collections::{BTreeSet, HashMap};

use ladder::{Comment, CommentOwner, Documentation, Target};
use rss::database::{self, Database, Entry, Header, Mnemonic};
use rss::{Error, Result};

use crate::from_rss::documentation::key;
use crate::to_rss::documentation::{lines, order, pieces};
use crate::to_rss::{owned, text};

/// Rung comments of the result, with the ids they keep or get.
pub(super) struct Comments {
    result: Vec<database::Comment<'static>>,
    used: BTreeSet<u32>,
    next: u32,
    /// Comments of ours that no rung shows, by what is in them.
    old: HashMap<(String, String, String), u32>,
}

impl Comments {
    pub(super) fn new(ours: &Database<'_>) -> Comments {
        let last = ours.comments.iter().map(|comment| comment.id).max().unwrap_or(0);
        let content = |comment: &database::Comment<'_>| {
            let (key, text, title) = (comment.key.to_string(), comment.text.to_string(), comment.title.to_string());
            ((key, text, title), comment.id)
        };
        Comments {
            result: Vec::new(),
            used: BTreeSet::new(),
            next: last.max(ours.header.last_comment_id),
            old: ours.comments.iter().map(content).collect(),
        }
    }

    /// The id of a rung's comment; `old` is the one it has in ours, 0 if none.
    pub(super) fn id(&mut self, comment: &Comment, file: u16, rung: usize, old: u32) -> Result<u32> {
        // The rung's own place counts, wherever the comment came from.
        let key = match &comment.owner {
            CommentOwner::Rung { .. } => format!("RUNG{file:06}-{rung:06}"),
            CommentOwner::Address(target) => key(target),
        };
        let same = |known: &&database::Comment<'_>| {
            known.key == key.as_str() && known.text == comment.text.as_str() && known.title == comment.title.as_str()
        };
        if let Some(known) = self.result.iter().find(same)
            && matches!(comment.owner, CommentOwner::Address(_))
        {
            return Ok(known.id);
        }
        self.push(comment, key, old)
    }

    fn push(&mut self, comment: &Comment, key: String, old: u32) -> Result<u32> {
        let id = if old != 0 && !self.used.contains(&old) { old } else { self.free()? };
        self.used.insert(id);
        self.result.push(database::Comment {
            id,
            text: owned(comment.text.clone())?,
            title: owned(comment.title.clone())?,
            key: owned(key)?,
        });
        Ok(id)
    }

    fn free(&mut self) -> Result<u32> {
        self.next =
            self.next.checked_add(1).ok_or_else(|| Error::Unwritable("no id is left for a comment".to_owned()))?;
        Ok(self.next)
    }
}

/// The key of a stored entry: address key, symbol where that is all there is, which of equal ones.
fn stored_keys<'d>(database: &'d Database<'_>) -> HashMap<(String, String, usize), &'d Entry<'d>> {
    let (mut seen, mut found) = (HashMap::new(), HashMap::new());
    let mut entries: Vec<&Entry<'_>> = database.addresses.iter().collect();
    // The model has them by id.
    entries.sort_by_key(|entry| entry.id);
    for entry in entries {
        let key = entry.key.to_string();
        let symbol = if key.is_empty() { entry.symbol.to_string() } else { String::new() };
        let number = seen.entry((key.clone(), symbol.clone())).or_insert(0_usize);
        found.insert((key, symbol, *number), entry);
        *number += 1;
    }
    found
}

pub(super) fn database<'a>(
    (ours, theirs): &'a (Database<'a>, Database<'a>),
    mut comments: Comments,
    merged: &'a Documentation,
) -> Result<Database<'a>> {
    for comment in &merged.detached_comments {
        let key = match &comment.owner {
            CommentOwner::Rung { file, rung } => format!("RUNG{file:06}-{rung:06}"),
            CommentOwner::Address(target) => key(target),
        };
        let old = comments.old.get(&(key.clone(), comment.text.clone(), comment.title.clone())).copied();
        comments.push(comment, key, old.unwrap_or(0))?;
    }
    let (known, others) = (stored_keys(ours), stored_keys(theirs));
    let mut last = ours.addresses.iter().map(|entry| entry.id).chain([ours.header.last_address_id]).max().unwrap_or(0);
    let (mut addresses, mut seen, mut ids) = (Vec::new(), HashMap::new(), HashMap::new());
    for entry in merged.entries() {
        let stored = key(&entry.target);
        let symbol = if stored.is_empty() { entry.symbol.clone() } else { String::new() };
        let number = seen.entry((stored.clone(), symbol.clone())).or_insert(0_usize);
        let name = (stored.clone(), symbol, *number);
        *number += 1;
        let old = known.get(&name);
        let id = match old {
            Some(entry) => entry.id,
            None => next(&mut last)?,
        };
        ids.entry(stored.clone()).or_insert(id);
        let of_file = matches!(entry.target, Target::ProgramFile(_) | Target::DataFile(_));
        let template = old.or(others.get(&name)).map(|entry| (**entry).clone()).unwrap_or_default();
        addresses.push(Entry {
            id,
            address_id: id,
            key: owned(stored)?,
            symbol: text(&entry.symbol)?,
            lines: if of_file { pieces(&entry.description)? } else { lines(&entry.description)? },
            ..template
        });
    }
    let mut old_comments = under(ours);
    let mut last_comment = ours
        .instruction_comments
        .iter()
        .map(|entry| entry.id)
        .chain([ours.header.last_instruction_id])
        .max()
        .unwrap_or(0);
    let (mut instruction_comments, mut mnemonics): (Vec<Entry<'a>>, Vec<Mnemonic<'a>>) = (Vec::new(), Vec::new());
    for comment in merged.instruction_comments() {
        let stored = comment.target.as_ref().map(key).unwrap_or_default();
        let address_id = ids.get(&stored).copied().unwrap_or(0);
        let old = old_comments.get_mut(&(comment.mnemonic.clone(), stored)).and_then(Vec::pop);
        let template = old.cloned().unwrap_or_default();
        let id = match old {
            Some(entry) => entry.id,
            None => next(&mut last_comment)?,
        };
        let mnemonic = text(&comment.mnemonic)?;
        match mnemonics.iter_mut().find(|known| known.mnemonic == mnemonic) {
            Some(known) => known.uses.push((address_id, id)),
            None => mnemonics.push(Mnemonic { mnemonic: mnemonic.clone(), uses: vec![(address_id, id)] }),
        }
        instruction_comments.push(Entry { id, lines: lines(&comment.lines)?, mnemonic, address_id, ..template });
    }
    addresses.sort_by_key(|entry| order(entry.id));
    instruction_comments.sort_by_key(|entry| order(entry.id));
    let mut comments_sorted = comments.result;
    comments_sorted.sort_by_key(|comment| order(comment.id));
    let header = Header {
        last_address_id: last,
        last_instruction_id: last_comment,
        last_comment_id: comments.next,
        ..ours.header.clone()
    };
    Ok(Database {
        header,
        addresses,
        instruction_comments,
        mnemonics,
        comments: comments_sorted,
        group_count: ours.group_count,
        groups: ours.groups,
    })
}

fn next(last: &mut u32) -> Result<u32> {
    *last = last.checked_add(1).ok_or_else(|| Error::Unwritable("no id is left for an entry".to_owned()))?;
    Ok(*last)
}

/// Instruction comments by mnemonic and address key, the first one last.
fn under<'d>(database: &'d Database<'_>) -> HashMap<(String, String), Vec<&'d Entry<'d>>> {
    let keys: HashMap<u32, String> = database.addresses.iter().map(|entry| (entry.id, entry.key.to_string())).collect();
    let mut entries: Vec<&Entry<'_>> = database.instruction_comments.iter().collect();
    entries.sort_by_key(|entry| std::cmp::Reverse(entry.id));
    let mut found: HashMap<(String, String), Vec<&Entry<'_>>> = HashMap::new();
    for entry in entries {
        let key = keys.get(&entry.address_id).cloned().unwrap_or_default();
        found.entry((entry.mnemonic.to_string(), key)).or_default().push(entry);
    }
    found
}
