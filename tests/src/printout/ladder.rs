//! The ladder pages as text: which rungs there are, their numbers and marks, and the words around them.
//!
//! Text alone cannot tell where one rung's boxes end and the next one's comment
//! starts, nor what is drawn as a contact; [`crate::drawing`] reads that from the PDF.

use super::Page;

/// A program file's ladder pages, joined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LadderFile {
    /// Program file number.
    pub number: u16,
    /// File name, empty where it has none.
    pub name: String,
    /// File description, empty where it has none.
    pub description: String,
    /// "Total Rungs in File", the END rung included.
    pub total: usize,
    /// The rungs in printed order.
    pub rungs: Vec<Rung>,
    /// Lines after the last rung number.
    pub after: Vec<String>,
}

/// A rung as found in the text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Rung {
    /// Rung number.
    pub number: usize,
    /// Whether the `e` mark of an edited, unverified rung stands beside the number.
    pub edited: bool,
    /// Every line between the previous rung's number and this one, without marks:
    /// the lower part of the previous rung, then this rung's title, comment, descriptions and symbols.
    pub before: Vec<String>,
    /// The rest of the line with the number: what stands on the wire.
    pub wire: String,
}

pub(super) fn read(files: &mut Vec<LadderFile>, page: &Page) -> Vec<String> {
    let Some(file) = heading(&page.title) else {
        return std::iter::once(page.title.clone()).chain(page.lines.iter().cloned()).collect();
    };
    if files.last().is_none_or(|f| f.number != file.number) {
        files.push(file);
    }
    let Some(file) = files.last_mut() else {
        return page.lines.clone();
    };
    for line in page.lines.iter().filter(|l| !l.is_empty()) {
        match numbered(line) {
            Some((number, rest)) => {
                let (edited, wire) = unmark(rest);
                let before = std::mem::take(&mut file.after);
                file.rungs.push(Rung { number, edited, before, wire: wire.trim().to_owned() });
            }
            None => {
                let (_, text) = unmark(line);
                if !text.trim().is_empty() {
                    file.after.push(text.trim().to_owned());
                }
            }
        }
    }
    Vec::new()
}

/// `LAD 4 - NAME - description --- Total Rungs in File = 13`
fn heading(title: &str) -> Option<LadderFile> {
    let (front, total) = title.rsplit_once("--- Total Rungs in File =")?;
    let (number, names) = front.strip_prefix("LAD ")?.split_once(" -")?;
    let (name, description) = names.split_once(" - ").unwrap_or((names, ""));
    Some(LadderFile {
        number: number.parse().ok()?,
        name: name.trim().to_owned(),
        description: description.trim().to_owned(),
        total: total.trim().parse().ok()?,
        rungs: Vec::new(),
        after: Vec::new(),
    })
}

/// A rung number is four digits at the very left.
fn numbered(line: &str) -> Option<(usize, &str)> {
    let (digits, rest) = line.split_at_checked(4)?;
    let all = digits.bytes().all(|b| b.is_ascii_digit());
    (all && (rest.is_empty() || rest.starts_with(' '))).then_some((digits.parse().ok()?, rest))
}

/// Takes an `e` mark off the left margin. Ladder text starts further right.
fn unmark(line: &str) -> (bool, &str) {
    let inner = line.trim_start();
    let margin = line.len() - inner.len();
    match inner.strip_prefix('e') {
        Some(rest) if margin < 9 && (rest.is_empty() || rest.starts_with(' ')) => (true, rest),
        _ => (false, line),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heading_with_and_without_names() {
        let file = heading("LAD 255 - MANUAL - Is it in hand mode? --- Total Rungs in File = 6").unwrap();
        assert_eq!((file.number, file.name.as_str(), file.total), (255, "MANUAL", 6));
        assert_eq!(file.description, "Is it in hand mode?");
        let bare = heading("LAD 2 -    --- Total Rungs in File = 6").unwrap();
        assert_eq!((bare.name.as_str(), bare.total), ("", 6));
    }

    #[test]
    fn a_mark_is_not_a_word() {
        assert_eq!(unmark("     e   text"), (true, "   text"));
        assert_eq!(unmark("         e mc2"), (false, "         e mc2"));
        assert_eq!(unmark("     else"), (false, "     else"));
    }
}
