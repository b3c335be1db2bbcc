//! The block of a rung comment and page title.
//!
//! ```text
//! % TITLE/RUNG DESCRIPTION
//! TITLE: page title
//! RUNG DESCRIPTION: first line
//! second line %
//! ```
//!
//! The block ends at the first line whose last character is `%`, so a comment line that itself ends
//! so, and one that begins like a label, need a mark: such a line gets one `\`, at its end or at its
//! beginning, and a line that already looks marked gets one more. Reading takes one away.

use super::TitleBlock;
use super::lines::Lines;

const HEADING: &str = "% TITLE/RUNG DESCRIPTION";
const TITLE: &str = "TITLE:";
const DESCRIPTION: &str = "RUNG DESCRIPTION:";

pub(super) fn begins(line: &str) -> bool {
    line.starts_with(HEADING)
}

/// `% Rung: 7 %`: the number.
pub(super) fn rung_number(line: &str) -> Option<&str> {
    let number = line.trim().strip_prefix("% Rung:")?.strip_suffix('%')?.trim();
    (!number.is_empty() && number.bytes().all(|b| b.is_ascii_digit())).then_some(number)
}

/// Reads the block whose heading is the current line.
pub(super) fn read(lines: &mut Lines<'_>) -> TitleBlock {
    let first = lines.number();
    let heading = lines.next().unwrap_or("");
    let (mut title, mut description): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    // A heading that closes itself has no lines after it.
    let mut ended = heading.trim_end().strip_prefix(HEADING).is_some_and(|rest| rest.ends_with('%'));
    let mut in_title = false;
    while !ended {
        let Some(line) = lines.peek() else { break };
        if rung_number(line).is_some() {
            break;
        }
        lines.next();
        let body = match line.trim_end().strip_suffix('%') {
            Some(body) => {
                ended = true;
                body.strip_suffix(' ').unwrap_or(body)
            }
            None => line,
        };
        let (label, text) = match (body.strip_prefix(TITLE), body.strip_prefix(DESCRIPTION)) {
            (Some(text), _) => (Some(true), text),
            (None, Some(text)) => (Some(false), text),
            (None, None) => (None, body),
        };
        in_title = label.unwrap_or(in_title);
        let text = if label.is_some() { text.strip_prefix(' ').unwrap_or(text) } else { text };
        // The line of the closing mark alone adds nothing when the part had no lines yet.
        let part = if in_title { &mut title } else { &mut description };
        part.push(unmarked(text).to_owned());
    }
    if !ended {
        lines.warn(first, "expected a line that ends in % to close the rung comment, found none");
    }
    TitleBlock { title: title.join("\n"), description: description.join("\n") }
}

pub(super) fn write(block: &TitleBlock, out: &mut String) {
    out.push_str(HEADING);
    out.push('\n');
    for (label, text) in [(TITLE, &block.title), (DESCRIPTION, &block.description)] {
        out.push_str(label);
        for (index, line) in text.split('\n').enumerate() {
            match index {
                0 if line.is_empty() => {}
                0 => out.push(' '),
                _ => out.push('\n'),
            }
            push_marked(out, line);
        }
        out.push_str(if label == TITLE { "\n" } else { " %\n" });
    }
}

fn looks_like_label(line: &str) -> bool {
    let line = line.trim_start_matches('\\');
    line.starts_with(TITLE) || line.starts_with(DESCRIPTION)
}

fn looks_like_end(line: &str) -> bool {
    line.trim_end_matches('\\').trim_end().ends_with('%')
}

fn push_marked(out: &mut String, line: &str) {
    if looks_like_label(line) {
        out.push('\\');
    }
    out.push_str(line);
    if looks_like_end(line) {
        out.push('\\');
    }
}

fn unmarked(line: &str) -> &str {
    let line = match line.strip_prefix('\\') {
        Some(rest) if looks_like_label(rest) => rest,
        _ => line,
    };
    match line.strip_suffix('\\') {
        Some(rest) if looks_like_end(rest) => rest,
        _ => line,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(title: &str, description: &str) -> TitleBlock {
        TitleBlock { title: title.to_owned(), description: description.to_owned() }
    }

    #[test]
    fn blocks_come_back() {
        for (title, description) in [
            ("", ""),
            ("PAGE", ""),
            ("", "one line"),
            ("PAGE", "first\nsecond\n\nfourth"),
            ("", "ends in 100%"),
            ("100%", "100 % \n%\\\n\\"),
            ("", "TITLE: not a title\n\\RUNG DESCRIPTION: x"),
            ("", "blank at the end \n"),
            ("  ", "  indented\n\n"),
            ("a\nb", "% Rung: 3 %\nSOR XIC B3:0/0 EOR\nDATA N7:0"),
            ("", "%\\\\ %\\"),
        ] {
            let written = block(title, description);
            let mut text = String::new();
            write(&written, &mut text);
            assert!(begins(&text));
            let mut lines = Lines::new(&text);
            assert_eq!(read(&mut lines), written, "{text}");
            assert_eq!(lines.peek(), None, "{text}");
        }
    }

    #[test]
    fn other_writers_blocks_are_read() {
        let mut lines =
            Lines::new("% TITLE/RUNG DESCRIPTION  \r\nRUNG DESCRIPTION:Starts the pump\r\n at 50% load. %\r\nx");
        assert_eq!(read(&mut lines), block("", "Starts the pump\n at 50% load."));
        assert_eq!(lines.peek(), Some("x"));
        let mut open = Lines::new("% TITLE/RUNG DESCRIPTION\nTITLE: A\nRUNG DESCRIPTION: b\n% Rung: 4 %\nSOR EOR");
        assert_eq!(read(&mut open), block("A", "b"));
        assert_eq!(open.peek(), Some("% Rung: 4 %"));
        assert_eq!(open.into_diagnostics().len(), 1);
    }
}
