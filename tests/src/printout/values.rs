//! The data pages: every printed value of every data file, and the fields of the status file.

use super::{Page, cells, row};

/// One data file as printed, its pages joined.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DataValues {
    /// File type letters, for example `N`.
    pub kind: String,
    /// Data file number.
    pub number: u16,
    /// The radix in the title: `bin`, `dec`, `hex`; `None` for structured files.
    pub radix: Option<String>,
    /// File name.
    pub name: String,
    /// File description, empty where none is printed.
    pub description: String,
    /// Rows of the table, in printed order.
    pub rows: Vec<ValueRow>,
    /// The fields of a status file, which is printed as labelled fields.
    pub status: Vec<StatusField>,
}

/// One printed row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ValueRow {
    /// The first column: address of the first value of the row, for example `N7:10` or `T4:0`.
    pub offset: String,
    /// The values under their column heads.
    pub values: Vec<Value>,
    /// What stands right of the values: module, symbol or description, often cut by the page edge.
    pub note: String,
}

/// One printed value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Value {
    /// Column head: bit number, member (`PRE`), or distance from the row's first element.
    pub column: String,
    /// The value as printed.
    pub text: String,
}

/// `Watchdog (x10 ms) S:3 (high byte) = 10` on a status page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StatusField {
    /// The heading above, for example `Scan Times`.
    pub section: String,
    /// The label with the address in it, as printed.
    pub label: String,
    /// The value, empty where none is printed.
    pub text: String,
}

impl DataValues {
    /// Every value with the address of its element: an array column is added to the
    /// element number of the row, other columns keep the row's own address.
    ///
    /// The triples are (address, column, text); the column is empty for arrays.
    pub fn elements(&self) -> impl Iterator<Item = (String, &str, &str)> {
        let array = matches!(self.radix.as_deref(), Some("dec" | "hex" | "oct" | "ascii")) || self.kind == "F";
        self.rows.iter().flat_map(move |row| {
            row.values.iter().map(move |value| {
                let moved = if array { step(&row.offset, &value.column) } else { None };
                match moved {
                    Some(address) => (address, "", value.text.as_str()),
                    None => (row.offset.clone(), value.column.as_str(), value.text.as_str()),
                }
            })
        })
    }
}

/// `N7:10` and column `3` give `N7:13`.
fn step(offset: &str, column: &str) -> Option<String> {
    let (file, element) = offset.rsplit_once(':')?;
    let element: u32 = element.parse().ok()?;
    let column: u32 = column.parse().ok()?;
    Some(format!("{file}:{}", element.checked_add(column)?))
}

pub(super) fn read(files: &mut Vec<DataValues>, page: &Page) -> Vec<String> {
    let Some(file) = heading(&page.title) else {
        return std::iter::once(page.title.clone()).chain(page.lines.iter().cloned()).collect();
    };
    let same = files.last().is_some_and(|f| f.kind == file.kind && f.number == file.number);
    if !same {
        files.push(file);
    }
    let Some(file) = files.last_mut() else {
        return page.lines.clone();
    };
    if file.kind == "S" { read_status(file, page) } else { read_table(file, page) }
}

/// `Data File N7 (dec)   --   INTEGER   --   description`
fn heading(title: &str) -> Option<DataValues> {
    let mut parts = title.strip_prefix("Data File ")?.splitn(3, "--").map(str::trim);
    let mut head = parts.next()?.split_whitespace();
    let file = head.next()?;
    let digits = file.find(|c: char| c.is_ascii_digit())?;
    let (kind, number) = file.split_at_checked(digits)?;
    let radix = head.next().and_then(|r| r.strip_prefix('(')).and_then(|r| r.strip_suffix(')'));
    Some(DataValues {
        kind: kind.to_owned(),
        number: number.parse().ok()?,
        radix: radix.map(str::to_owned),
        name: parts.next()?.to_owned(),
        description: parts.next().unwrap_or_default().to_owned(),
        rows: Vec::new(),
        status: Vec::new(),
    })
}

const NOTE: &str = "(Symbol) Description";

fn read_table(file: &mut DataValues, page: &Page) -> Vec<String> {
    let mut lines = page.lines.iter().filter(|l| !l.is_empty());
    let Some(heading) = lines.next().and_then(|l| l.strip_prefix("Offset")) else {
        return page.lines.clone();
    };
    let heading = heading.trim().trim_end_matches(NOTE).trim();
    let columns: Vec<&str> = match heading {
        "LEN String Text" => vec!["LEN", "text"],
        _ => heading.split_whitespace().collect(),
    };
    let mut lost = Vec::new();
    for line in lines {
        let read = if file.kind == "ST" { read_string(line) } else { read_row(line, &columns) };
        match read {
            Some(row) => file.rows.push(row),
            None => lost.push(line.clone()),
        }
    }
    lost
}

/// Takes one word per column (two for a time base, `.01 sec`); the rest is the note.
///
/// A module with fewer than 16 points is printed with its bits only, under the low columns.
fn read_row(line: &str, columns: &[&str]) -> Option<ValueRow> {
    let mut words = Words(line);
    let offset = words.next()?.to_owned();
    if !offset.contains(':') {
        return None;
    }
    let mut columns = columns;
    if columns.first() == Some(&"15") {
        let bits = Words(words.0).take_while(|w| matches!(*w, "0" | "1")).count();
        columns = columns.get(columns.len().saturating_sub(bits)..)?;
    }
    let mut values = Vec::new();
    for column in columns {
        let Some(word) = words.next() else { break };
        let mut text = word.to_owned();
        if *column == "BASE" {
            text = format!("{text} {}", words.next()?);
        }
        values.push(Value { column: (*column).to_owned(), text });
    }
    Some(ValueRow { offset, values, note: words.0.trim().to_owned() })
}

/// A string has its length before it: that many characters after one space, then the note.
fn read_string(line: &str) -> Option<ValueRow> {
    let mut words = Words(line);
    let offset = words.next()?.to_owned();
    let length = words.next()?;
    let count: usize = length.parse().ok()?;
    let rest = words.0.strip_prefix(' ').unwrap_or(words.0);
    let cut = rest.char_indices().nth(count).map_or(rest.len(), |(at, _)| at);
    let (text, note) = rest.split_at_checked(cut)?;
    let values = vec![
        Value { column: "LEN".to_owned(), text: length.to_owned() },
        Value { column: "text".to_owned(), text: text.trim_end().to_owned() },
    ];
    Some(ValueRow { offset, values, note: note.trim().to_owned() })
}

/// Words of a line, keeping what is left after each.
struct Words<'a>(&'a str);

impl<'a> Iterator for Words<'a> {
    type Item = &'a str;

    fn next(&mut self) -> Option<&'a str> {
        let rest = self.0.trim_start();
        let end = rest.find(' ').unwrap_or(rest.len());
        let (word, rest) = rest.split_at_checked(end)?;
        self.0 = rest;
        (!word.is_empty()).then_some(word)
    }
}

/// Status pages: headings alone on a line, fields `label = value` in one or two columns.
fn read_status(file: &mut DataValues, page: &Page) -> Vec<String> {
    let mut lost = Vec::new();
    let mut section = file.status.last().map(|f| f.section.clone()).unwrap_or_default();
    for line in page.lines.iter().filter(|l| !l.is_empty()) {
        let cells: Vec<row::Cell> = cells(line);
        if let [cell] = cells.as_slice()
            && cell.start == 0
            && !cell.text.contains(['=', ':'])
        {
            section.clone_from(&cell.text);
            continue;
        }
        for cell in cells {
            // "Error Description:" is the one label without an equal sign.
            let field = cell.text.split_once('=').or(cell.text.split_once(": ")).or(cell.text.split_once(':'));
            match field {
                Some((label, text)) => file.status.push(StatusField {
                    section: section.clone(),
                    label: label.trim().to_owned(),
                    text: text.trim().to_owned(),
                }),
                None => lost.push(line.clone()),
            }
        }
    }
    lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_arrays_become_elements() {
        let mut file = heading("Data File N7 (dec)   --   INTEGER").unwrap();
        file.rows.push(read_row("N7:10   4  -5", &["0", "1", "2"]).unwrap());
        let found: Vec<_> = file.elements().collect();
        assert_eq!(found, [("N7:10".to_owned(), "", "4"), ("N7:11".to_owned(), "", "-5")]);
    }

    #[test]
    fn a_time_base_is_two_words_and_a_note_follows() {
        let row = read_row("T4:0   1  1  0 .001 sec  4000  608  (LAMP) on", &["EN", "TT", "DN", "BASE", "PRE", "ACC"]);
        let row = row.unwrap();
        assert_eq!(row.values[3].text, ".001 sec");
        assert_eq!(row.values[5].text, "608");
        assert_eq!(row.note, "(LAMP) on");
    }

    #[test]
    fn eight_points_stand_under_the_low_bits() {
        let columns = ["15", "14", "13", "12", "11", "10", "9", "8", "7", "6", "5", "4", "3", "2", "1", "0"];
        let row = read_row("I:1.0                0 1 0 0 0 0 0 1  1762-IQ8 - 8-Input", &columns).unwrap();
        assert_eq!((row.values.len(), row.values[0].column.as_str(), row.values[1].text.as_str()), (8, "7", "1"));
        assert_eq!(row.note, "1762-IQ8 - 8-Input");
    }

    #[test]
    fn a_string_ends_after_its_length() {
        let row = read_string("ST9:0    5 A B C   (NAME) text").unwrap();
        assert_eq!((row.values[1].text.as_str(), row.note.as_str()), ("A B C", "(NAME) text"));
        let empty = read_string("ST9:1    0       Current").unwrap();
        assert_eq!((empty.values[1].text.as_str(), empty.note.as_str()), ("", "Current"));
    }
}
