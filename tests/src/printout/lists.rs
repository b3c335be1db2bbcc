//! "Program File List" and "Data File List".

use super::Page;

/// A row of the program file list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProgramFileRow {
    /// The name as printed: `[SYSTEM]` for file 0, empty where a file has none.
    pub name: String,
    /// Program file number.
    pub number: u16,
    /// `SYS` or `LADDER`.
    pub kind: String,
    /// Number of rungs, the END rung included.
    pub rungs: usize,
    /// The Debug column: `No`.
    pub debug: String,
    /// The Bytes column.
    pub bytes: u32,
}

/// A row of the data file list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DataFileRow {
    /// The name as printed.
    pub name: String,
    /// Data file number.
    pub number: u16,
    /// File type letters, for example `N` or `ST`.
    pub kind: String,
    /// `Global`.
    pub scope: String,
    /// The Debug column: `No`.
    pub debug: String,
    /// The Words column: three words per element for O and I (data and force masks), 0 for S.
    pub words: u32,
    /// Number of elements.
    pub elements: u32,
    /// The last address, for example `T4:1`.
    pub last: String,
}

pub(super) fn read_programs(rows: &mut Vec<ProgramFileRow>, page: &Page) -> Vec<String> {
    collect(rows, page, &["Name", "Number", "Type", "Rungs", "Debug", "Bytes"], |line| {
        let ([number, kind, rungs, debug, bytes], name) = from_right(line)?;
        Some(ProgramFileRow {
            name,
            number: number.parse().ok()?,
            kind: kind.to_owned(),
            rungs: rungs.parse().ok()?,
            debug: debug.to_owned(),
            bytes: bytes.parse().ok()?,
        })
    })
}

pub(super) fn read_data(rows: &mut Vec<DataFileRow>, page: &Page) -> Vec<String> {
    let heading = ["Name", "Number", "Type", "Scope", "Debug", "Words", "Elements", "Last"];
    collect(rows, page, &heading, |line| {
        let ([number, kind, scope, debug, words, elements, last], name) = from_right(line)?;
        Some(DataFileRow {
            name,
            number: number.parse().ok()?,
            kind: kind.to_owned(),
            scope: scope.to_owned(),
            debug: debug.to_owned(),
            words: words.parse().ok()?,
            elements: elements.parse().ok()?,
            last: last.to_owned(),
        })
    })
}

/// Reads every line that is neither blank nor the heading; gives back the ones that do not fit.
fn collect<T>(rows: &mut Vec<T>, page: &Page, heading: &[&str], read: impl Fn(&str) -> Option<T>) -> Vec<String> {
    let mut lost = Vec::new();
    for line in page.lines.iter().filter(|l| !l.is_empty()) {
        if line.split_whitespace().eq(heading.iter().copied()) {
            continue;
        }
        match read(line) {
            Some(row) => rows.push(row),
            None => lost.push(line.clone()),
        }
    }
    lost
}

/// The last `N` words of a line and the text before them: only the name, first, may hold spaces.
fn from_right<const N: usize>(line: &str) -> Option<([&str; N], String)> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let split = words.len().checked_sub(N)?;
    let (name, rest) = words.split_at_checked(split)?;
    Some((rest.try_into().ok()?, name.join(" ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_may_be_empty_or_hold_spaces() {
        let read = |line| from_right::<5>(line).map(|(rest, name)| (name, rest[0].to_owned()));
        assert_eq!(read("        1   SYS   0   No   0"), Some((String::new(), "1".to_owned())));
        assert_eq!(read("OUT TIMERS  9 LADDER 120 No 4321"), Some(("OUT TIMERS".to_owned(), "9".to_owned())));
        assert_eq!(read("LADDER 235 No"), None);
    }
}
