//! How much of a program is documented.

use ladder::{Documentation, Image, Target};

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
            let shown = documentation.shown(&Target::from(address), "");
            let (symbol, description) = (shown.symbol.is_some(), !shown.description.is_empty());
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
