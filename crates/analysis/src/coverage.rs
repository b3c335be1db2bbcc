//! How much of a program is documented.

use ladder::{Address, Documentation, Image, Target};

use crate::xref::CrossReference;

/// Figures of documentation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Coverage {
    /// Different addresses that instructions name, without those decided at run time.
    pub addresses: usize,
    /// Those with a symbol, their own or their element's.
    pub with_symbol: usize,
    /// Those with a description, their own or their element's.
    pub with_description: usize,
    /// Those with either.
    pub documented: usize,
    /// Rungs of ladder files without the END rungs.
    pub rungs: usize,
    /// Those with a rung comment.
    pub with_comment: usize,
    /// Those with a page title.
    pub with_title: usize,
    /// Ladder files.
    pub files: usize,
    /// Those with a name.
    pub files_with_name: usize,
    /// Those with a description.
    pub files_with_description: usize,
}

impl Coverage {
    /// Counts over an image. `documentation` as for [`CrossReference::build`].
    pub fn build(image: &Image, documentation: &Documentation, xref: &CrossReference<'_>) -> Coverage {
        let mut figures = Coverage::default();
        for address in xref.named() {
            let (symbol, description) = documented(documentation, address);
            figures.addresses += 1;
            figures.with_symbol += usize::from(symbol);
            figures.with_description += usize::from(description);
            figures.documented += usize::from(symbol || description);
        }
        for file in image.ladder_files() {
            figures.files += 1;
            figures.files_with_name += usize::from(!file.name.is_empty());
            figures.files_with_description += usize::from(!file.description.is_empty());
            for rung in file.rungs.iter().filter(|rung| !rung.is_end()) {
                let comment = rung.comment.as_ref();
                figures.rungs += 1;
                figures.with_comment += usize::from(comment.is_some_and(|c| !c.text.trim().is_empty()));
                figures.with_title += usize::from(comment.is_some_and(|c| !c.title.trim().is_empty()));
            }
        }
        figures
    }
}

/// Whether an address has a symbol and a description, its own or its element's. The rules of
/// [`Documentation::shown`] without making the texts.
pub(crate) fn documented(documentation: &Documentation, address: &Address) -> (bool, bool) {
    let whole = Address { indexed: false, word: None, bit: None, ..address.clone() };
    let part = !address.file_type.has_slots() && (address.word.is_some() || address.bit.is_some());
    let own = documentation.entry(&Target::from(address));
    let element = if part { documentation.entry(&Target::Address(whole)) } else { None };
    let any = |has: fn(&ladder::AddressEntry) -> bool| own.is_some_and(has) || element.is_some_and(has);
    (any(|entry| !entry.symbol.is_empty()), any(|entry| !entry.description.is_empty()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::AddressEntry;

    #[test]
    fn agrees_with_what_is_shown() {
        let mut docs = Documentation::default();
        for (text, symbol, lines) in
            [("T4:0", "CYCLE", 0), ("T4:1/DN", "", 2), ("I:1.0", "WORD", 1), ("B3:0/1", "A", 1), ("T4:1", "B", 0)]
        {
            let target = Target::Address(Address::parse(text).expect(text));
            docs.add(AddressEntry { target, symbol: symbol.into(), description: vec!["x".into(); lines] });
        }
        for text in ["T4:0", "T4:0/DN", "T4:1/DN", "T4:1.ACC", "I:1.0", "I:1.0/3", "B3:0/1", "B3:0", "N7:0", "#N7:0"] {
            let address = Address::parse(text).expect(text);
            let shown = docs.shown(&Target::from(&address), "");
            assert_eq!(documented(&docs, &address), (shown.symbol.is_some(), !shown.description.is_empty()), "{text}");
        }
    }
}
