//! The frame of a printed page: name above, title, content, page number and date below.

/// One page without its head and foot.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    /// Position in the text, counted from 0 (cover included).
    pub number: usize,
    /// First printed line: the name of the project or file.
    pub name: String,
    /// Second printed line, for example "Program File List"; empty on the cover.
    pub title: String,
    /// The number in the foot, counted by RSLogix from 1 in each part of the report.
    pub foot_number: usize,
    /// What stands in brackets in the foot of data pages: "Radix Decimal".
    pub radix: Option<String>,
    /// Date and time in the foot, as printed.
    pub printed: String,
    /// The lines between title and foot, blank ones at either end left out.
    pub lines: Vec<String>,
}

/// The text that stands alone on the cover of a whole report.
const COVER: &str = "RSLogix Micro Project Report";

/// Parts the text of a report into its pages; empty pages are left out.
pub(super) fn pages(text: &str) -> Vec<Page> {
    text.split('\u{c}').enumerate().filter_map(|(number, page)| read(number, page)).collect()
}

fn read(number: usize, text: &str) -> Option<Page> {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let mut inked = lines.iter().enumerate().filter(|(_, l)| !l.is_empty());
    let (_, name) = inked.next()?;
    let title = inked.next();
    let mut page = Page {
        number,
        name: name.trim().to_owned(),
        title: String::new(),
        foot_number: 0,
        radix: None,
        printed: String::new(),
        lines: Vec::new(),
    };
    let Some((at, title)) = title else {
        if page.name == COVER {
            page.name.clear();
        }
        return Some(page);
    };
    page.title = title.trim().to_owned();
    let mut content = lines.get(at + 1..).unwrap_or_default();
    if let Some(last) = content.iter().rposition(|l| !l.is_empty())
        && let Some(foot) = content.get(last)
        && read_foot(&mut page, foot)
    {
        content = content.get(..last).unwrap_or_default();
    }
    let first = content.iter().position(|l| !l.is_empty()).unwrap_or(content.len());
    let last = content.iter().rposition(|l| !l.is_empty()).map_or(first, |l| l + 1);
    page.lines = content.get(first..last).unwrap_or_default().iter().map(|l| (*l).to_owned()).collect();
    Some(page)
}

/// Reads `Page 3   (Radix Decimal)    Sunday, April 05, 2020 - 11:20:33`.
fn read_foot(page: &mut Page, line: &str) -> bool {
    let cells = super::cells(line);
    let mut parts = cells.iter().map(|c| c.text.as_str());
    let Some(number) = parts.next().and_then(|t| t.strip_prefix("Page ")).and_then(|t| t.parse().ok()) else {
        return false;
    };
    page.foot_number = number;
    for part in parts {
        match part.strip_prefix('(').and_then(|t| t.strip_suffix(')')) {
            Some(radix) => page.radix = Some(radix.to_owned()),
            None => part.clone_into(&mut page.printed),
        }
    }
    true
}
