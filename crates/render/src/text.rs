//! Text from projects made fit for a grid of cells: no control characters, known widths, wrapping.

use std::borrow::Cow;
use std::fmt::Write;

use unicode_width::UnicodeWidthChar;

/// Columns a character takes; `None` for one that would move the cursor, hide, or join another.
pub(crate) fn columns(c: char) -> Option<usize> {
    // U+00AD is invisible in most terminals and a hyphen in others.
    UnicodeWidthChar::width(c).filter(|width| *width > 0 && c != '\u{AD}')
}

/// The text with every character that has no certain place on the grid spelled out (`\x1B`), so that
/// a project cannot send control sequences to a terminal and nothing disappears. Tabs become spaces.
pub fn clean(text: &str) -> Cow<'_, str> {
    if text.chars().all(|c| columns(c).is_some()) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        match (c, columns(c)) {
            (_, Some(_)) => out.push(c),
            ('\t', None) => out.push_str("    "),
            // Writing to a string cannot fail.
            (c, None) if u32::from(c) < 0x100 => drop(write!(out, "\\x{:02X}", u32::from(c))),
            (c, None) => drop(write!(out, "\\u{{{:X}}}", u32::from(c))),
        }
    }
    Cow::Owned(out)
}

/// Columns of a text that went through [`clean`], counted as the painter fills them: one character
/// after the other, whatever a terminal might join.
pub(crate) fn width(text: &str) -> usize {
    text.chars().map(|c| columns(c).unwrap_or(0)).sum()
}

/// Byte length of the longest start of `text` that fits `limit` columns; at least one character.
fn fitting(text: &str, limit: usize) -> usize {
    let mut used = 0;
    for (at, c) in text.char_indices() {
        used += columns(c).unwrap_or(0);
        if used > limit && at > 0 {
            return at;
        }
    }
    text.len()
}

/// Cuts a clean text into lines of at most `limit` columns, between words where there are any.
/// Spaces at a cut are left out, those at the start of the text kept.
pub(crate) fn wrap(text: &str, limit: usize) -> Vec<String> {
    let limit = limit.max(2);
    let mut lines = Vec::new();
    let mut rest = text.trim_end();
    // Only as much is measured as one line takes, so the cost stays linear in the text.
    loop {
        let fits = fitting(rest, limit);
        if fits == rest.len() {
            break;
        }
        let (start, _) = rest.split_at(fits);
        let at_space = rest[fits..].starts_with(' ');
        let cut = if at_space { Some(fits) } else { start.rfind(' ').map(|at| at + 1) };
        // Leading spaces are indentation, not a place to cut.
        let cut = cut.filter(|at| !rest[..*at].trim().is_empty()).unwrap_or(fits);
        lines.push(rest[..cut].trim_end().to_owned());
        rest = rest[cut..].trim_start_matches(' ');
    }
    lines.push(rest.to_owned());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_reaches_the_terminal_as_a_command() {
        assert_eq!(clean("20 °C ÷ 2"), "20 °C ÷ 2");
        assert_eq!(clean("a\u{1B}[2Jb\u{9B}c\u{AD}\u{202E}"), "a\\x1B[2Jb\\x9Bc\\xAD\\u{202E}");
        assert_eq!(clean("1\t2"), "1    2");
    }

    #[test]
    fn lines_break_at_words() {
        assert_eq!(wrap("one two three", 8), ["one two", "three"]);
        assert_eq!(wrap("one two  three", 7), ["one two", "three"]);
        assert_eq!(wrap("abcdefgh", 3), ["abc", "def", "gh"]);
        assert_eq!(wrap("   - indented text", 10), ["   -", "indented", "text"]);
        assert_eq!(wrap("      wide", 4), ["    ", "wide"].map(|l| l.trim_end()));
        assert_eq!(wrap("温度温度温", 4), ["温度", "温度", "温"]);
        assert_eq!(wrap("", 4), [""]);
        // Would take minutes if each line measured the rest of the text.
        assert_eq!(wrap(&"a ".repeat(1_000_000), 50).len(), 40_000);
    }
}
