//! Splitting a printed line into its columns.

/// A piece of a line between runs of two or more spaces.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Cell {
    /// Column of the first character, counted from 0.
    pub start: usize,
    /// The text, without spaces around it.
    pub text: String,
}

/// The cells of a line from left to right.
#[must_use]
pub fn cells(line: &str) -> Vec<Cell> {
    let mut found: Vec<Cell> = Vec::new();
    let mut spaces = 2;
    for (column, c) in line.chars().enumerate() {
        if c == ' ' {
            spaces += 1;
            continue;
        }
        match found.last_mut() {
            Some(cell) if spaces < 2 => {
                cell.text.extend(std::iter::repeat_n(' ', spaces));
                cell.text.push(c);
            }
            _ => found.push(Cell { start: column, text: c.to_string() }),
        }
        spaces = 0;
    }
    found
}

/// Cuts a line at the given columns: text from one start up to the next, trimmed.
///
/// A cell belongs to the last column that starts at or before it, so a text with
/// double spaces inside stays whole.
pub(super) fn cut(line: &str, starts: &[usize]) -> Vec<String> {
    let mut columns: Vec<String> = vec![String::new(); starts.len()];
    let mut ends: Vec<usize> = vec![0; starts.len()];
    for cell in cells(line) {
        let place = starts.iter().rposition(|&s| s <= cell.start).unwrap_or(0);
        let (Some(text), Some(end)) = (columns.get_mut(place), ends.get_mut(place)) else {
            continue;
        };
        if !text.is_empty() {
            text.extend(std::iter::repeat_n(' ', cell.start.saturating_sub(*end)));
        }
        text.push_str(&cell.text);
        *end = cell.start + cell.text.chars().count();
    }
    columns
}

/// Where each of the named columns starts in a heading, or `None` if it is another heading.
///
/// The page edge may cut the last head (`Sym` for `Sym Group`) and leave out the ones after it.
pub(super) fn starts(heading: &str, names: &[&str]) -> Option<Vec<usize>> {
    let heads = cells(heading);
    let fit = !heads.is_empty() && heads.len() <= names.len();
    let matches = heads.iter().zip(names).all(|(head, name)| name.starts_with(&head.text));
    (fit && matches).then(|| heads.iter().map(|h| h.start).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn double_spaces_part_cells_and_single_ones_do_not() {
        let found = cells("  Proc Type   X  y z");
        let texts: Vec<_> = found.iter().map(|c| (c.start, c.text.as_str())).collect();
        assert_eq!(texts, [(2, "Proc Type"), (14, "X"), (17, "y z")]);
    }

    #[test]
    fn a_heading_may_be_cut_at_the_page_edge() {
        let names = ["Address", "Sym Group", "Dev. Code"];
        assert_eq!(starts("Address   Sym", &names), Some(vec![0, 10]));
        assert_eq!(starts("Address   Scope", &names), None);
    }

    #[test]
    fn a_text_with_a_gap_stays_in_its_column() {
        let columns = starts("Address  Symbol  Description", &["Address", "Symbol", "Description"]).unwrap();
        assert_eq!(cut("N7:0             two  words", &columns), ["N7:0", "", "two  words"]);
    }
}
