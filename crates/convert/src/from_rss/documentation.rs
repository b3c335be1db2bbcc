//! `MEM DATABASE` to documentation: keys to targets, records to entries, comments by id.

use std::collections::HashMap;
use std::collections::hash_map;

use ladder::{
    Address, AddressEntry, Comment, CommentOwner, Diagnostic, Documentation, InstructionComment, Severity, Target,
};
use rss::Text;
use rss::database::{Database, Entry};

/// What a stored key is about. The key form is the address form with padded numbers, so the address
/// parser reads it; the other forms are few.
pub(crate) fn target(key: &str) -> Target {
    if key.is_empty() {
        return Target::Unassigned;
    }
    let number = |text: &str| text.parse::<u16>().ok();
    if let Some(file) = key.strip_prefix("U:").and_then(number) {
        return Target::ProgramFileOperand(file);
    }
    if let Some(file) = key.strip_prefix("PFILE:").and_then(number) {
        return Target::ProgramFile(file);
    }
    if let Some(file) = key.strip_prefix("DFILE:").and_then(number) {
        return Target::DataFile(file);
    }
    if let Some((file, label)) = key.strip_prefix('Q').and_then(|rest| rest.split_once(':'))
        && let (Some(file), Some(label)) = (number(file), number(label))
    {
        return Target::Label { file, number: label };
    }
    match Address::parse(key) {
        Ok(address) => Target::Address(address),
        Err(_) => Target::Other(key.to_owned()),
    }
}

/// The key a target is stored under, the inverse of [`target`].
pub(crate) fn key(target: &Target) -> String {
    match target {
        Target::Address(address) => address_key(address),
        Target::ProgramFileOperand(file) => format!("U:{file:05}"),
        Target::Label { file, number } => format!("Q{file}:{number}"),
        Target::ProgramFile(file) => format!("PFILE:{file:05}"),
        Target::DataFile(file) => format!("DFILE:{file:05}"),
        Target::Unassigned => String::new(),
        Target::Other(key) => key.clone(),
    }
}

fn address_key(address: &Address) -> String {
    use ladder::Place;
    let place = |place: &Place, width: usize| match place {
        Place::Number(n) => format!("{n:0width$}"),
        Place::Indirect(inner) => format!("[{}]", address_key(inner)),
    };
    let mut key = format!("{}{}:{}", address.file_type, place(&address.file, 4), place(&address.element, 3));
    if let Some(word) = address.word {
        key.push_str(&format!(".{word:03}"));
    }
    if let Some(bit) = &address.bit {
        key.push_str(&format!("/{}", place(bit, 2)));
    }
    key
}

/// Lines without the blank ones at the end.
fn lines(texts: &[Text<'_>]) -> Vec<String> {
    let used = texts.iter().rposition(|text| !text.is_empty()).map_or(0, |last| last + 1);
    texts.iter().take(used).map(|text| text.decode().into_owned()).collect()
}

/// Records in the order they were made; the stored order is that of a hash map and says nothing.
fn by_id<'d, 'a>(records: &'d [Entry<'a>]) -> Vec<&'d Entry<'a>> {
    let mut records: Vec<_> = records.iter().collect();
    records.sort_by_key(|record| record.id);
    records
}

/// Entries and instruction comments; rung comments are taken out of [`Comments`] by the rungs.
pub(crate) fn documentation(database: &Database<'_>) -> Documentation {
    let mut documentation = Documentation::default();
    let mut targets: HashMap<u32, Target> = HashMap::with_capacity(database.addresses.len());
    for entry in by_id(&database.addresses) {
        let target = target(&entry.key.decode());
        targets.insert(entry.id, target.clone());
        documentation.add(AddressEntry {
            target,
            symbol: entry.symbol.decode().into_owned(),
            description: lines(&entry.lines),
        });
    }
    let comment = |entry: &Entry<'_>| InstructionComment {
        mnemonic: entry.mnemonic.decode().into_owned(),
        target: targets.get(&entry.address_id).cloned(),
        lines: lines(&entry.lines),
    };
    for entry in by_id(&database.instruction_comments) {
        documentation.add_instruction_comment(comment(entry));
    }
    documentation
}

/// Rung comments by the id that rungs hold.
#[derive(Default)]
pub(crate) struct Comments {
    /// Places in `all`; of several comments with one id the first.
    by_id: HashMap<u32, usize>,
    /// In stored order, each with whether a rung shows it.
    all: Vec<(Comment, bool)>,
}

impl Comments {
    /// What deviates is reported under the name of the stream.
    pub(crate) fn new(database: &Database<'_>, stream: &str, diagnostics: &mut Vec<Diagnostic>) -> Comments {
        let mut comments = Comments::default();
        for stored in &database.comments {
            let place = format!("{stream}, in rung comment {}", stored.id);
            let mut warn = |message: String| {
                diagnostics.push(Diagnostic { severity: Severity::Warning, place: place.clone(), message });
            };
            let key = || target(&stored.key.decode());
            let owner = match stored.rung() {
                Some((file, rung)) => match u16::try_from(file) {
                    Ok(file) => CommentOwner::Rung { file, rung },
                    Err(_) => {
                        warn(format!("expected a program file up to 65535, found {file}; its key is kept as it is"));
                        CommentOwner::Address(key())
                    }
                },
                None => CommentOwner::Address(key()),
            };
            let comment =
                Comment { text: stored.text.decode().into_owned(), title: stored.title.decode().into_owned(), owner };
            match comments.by_id.entry(stored.id) {
                hash_map::Entry::Vacant(free) => {
                    free.insert(comments.all.len());
                }
                hash_map::Entry::Occupied(_) => {
                    warn("expected a number of its own, found that of an earlier comment, which rungs show".to_owned());
                }
            }
            comments.all.push((comment, false));
        }
        comments
    }

    /// The comment a rung refers to. Comments attached to an address can be shown by several rungs.
    pub(crate) fn shown(&mut self, id: u32) -> Option<Comment> {
        let (comment, shown) = self.all.get_mut(*self.by_id.get(&id)?)?;
        *shown = true;
        Some(comment.clone())
    }

    /// The comments no rung asked for, in stored order.
    pub(crate) fn detached(&self) -> Vec<Comment> {
        self.all.iter().filter(|(_, shown)| !shown).map(|(comment, _)| comment.clone()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_lead_to_targets_and_back() {
        for (stored, shown) in [
            ("O0000:002.000/01", "O:2.0/1"),
            ("I0001:003.000", "I:3.0"),
            ("S0002:001/15", "S:1/15"),
            ("L0009:008/31", "L9:8/31"),
            ("T0004:000.001", "T4:0.PRE"),
            ("C0005:000/13", "C5:0/DN"),
            ("ST0151:007.000", "ST151:7.LEN"),
            ("MG0068:000.017/13", "MG68:0/DN"),
            ("HSC0000:000.007", "HSC:0.HIP"),
            ("ES0001:005/00", "ES1:5/0"),
            ("N[N0007:004]:021/00", "N[N7:4]:21/0"),
            ("N0095:[N0007:174]/[N0007:176]", "N95:[N7:174]/[N7:176]"),
            ("U:00244", "U:244"),
            ("Q51:1", "Q51:1"),
            ("CT0054:005", "CT0054:005"),
        ] {
            let target = target(stored);
            assert_eq!(target.to_string(), shown);
            assert_eq!(key(&target), stored);
        }
        assert_eq!(target("PFILE:00012"), Target::ProgramFile(12));
        assert_eq!(target(""), Target::Unassigned);
    }

    #[test]
    fn comments_that_share_a_number_are_all_kept() {
        let stored = |id, text: &'static str, key: &'static str| rss::database::Comment {
            id,
            text: Text::from_bytes(text.as_bytes()),
            title: Text::default(),
            key: Text::from_bytes(key.as_bytes()),
        };
        let database = Database {
            comments: vec![
                stored(1, "first", "RUNG000002-000000"),
                stored(1, "second", "RUNG000002-000001"),
                stored(2, "far", "RUNG070000-000003"),
            ],
            ..Database::default()
        };
        let mut diagnostics = Vec::new();
        let mut comments = Comments::new(&database, "MEM", &mut diagnostics);
        assert_eq!(comments.shown(1).map(|comment| comment.text).as_deref(), Some("first"));
        let detached: Vec<_> = comments.detached().into_iter().map(|comment| (comment.text, comment.owner)).collect();
        let far = CommentOwner::Address(Target::Other("RUNG070000-000003".to_owned()));
        assert_eq!(detached, [("second".to_owned(), CommentOwner::Rung { file: 2, rung: 1 }), ("far".to_owned(), far)]);
        let places: Vec<&str> = diagnostics.iter().map(|diagnostic| diagnostic.place.as_str()).collect();
        assert_eq!(places, ["MEM, in rung comment 1", "MEM, in rung comment 2"]);
        assert!(diagnostics.iter().all(|diagnostic| diagnostic.severity == Severity::Warning));
    }
}
