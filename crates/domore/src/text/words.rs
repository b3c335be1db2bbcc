//! Words of a line: operands between separators, quotes.

/// The words of an instruction line and whether a quote was left open.
pub(super) struct Words<'a> {
    /// Words as spelled, quotes included.
    pub words: Vec<&'a str>,
    /// Byte offset of a quote that is not closed.
    pub open_quote: Option<usize>,
}

/// Cuts a line into words. A line with tabs is separated by them, so that operands may hold blanks; any
/// other line by blanks. Inside quotes a doubled quote stands for one, and no separator counts.
pub(super) fn split(line: &str) -> Words<'_> {
    let by_tabs = has_unquoted_tab(line.trim());
    let mut words = Vec::new();
    let mut open_quote = None;
    let mut quoted = false;
    let mut start = 0;
    let mut push = |from: usize, to: usize, last: bool| {
        let word = line.get(from..to).unwrap_or_default().trim();
        // Two tabs in a row are an empty operand; blanks at the ends and between words are not.
        if !word.is_empty() || (by_tabs && !last && !words.is_empty()) {
            words.push(word);
        }
    };
    for (at, byte) in line.bytes().enumerate() {
        match byte {
            b'"' => {
                quoted = !quoted;
                open_quote = quoted.then_some(at);
            }
            b'\t' if !quoted => {
                push(start, at, false);
                start = at + 1;
            }
            b' ' if !quoted && !by_tabs => {
                push(start, at, false);
                start = at + 1;
            }
            _ => {}
        }
    }
    push(start, line.len(), true);
    // Empty operands at the end of a line are tabs that nothing follows.
    while words.last().is_some_and(|word| word.is_empty()) {
        words.pop();
    }
    Words { words, open_quote }
}

fn has_unquoted_tab(line: &str) -> bool {
    let mut quoted = false;
    line.bytes().any(|byte| {
        quoted ^= byte == b'"';
        byte == b'\t' && !quoted
    })
}

/// The text between the quotes of a word, doubled quotes made single; `None` if it is not one quoted text.
pub fn unquote(word: &str) -> Option<String> {
    let inner = word.strip_prefix('"')?.strip_suffix('"')?;
    if word.len() < 2 {
        return None;
    }
    let mut text = String::with_capacity(inner.len());
    let mut rest = inner;
    while let Some((before, after)) = rest.split_once('"') {
        text.push_str(before);
        text.push('"');
        rest = after.strip_prefix('"')?;
    }
    text.push_str(rest);
    Some(text)
}

/// A text in quotes, its own quotes doubled. Line ends become blanks: nothing in quotes spans lines.
pub fn quote(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\"\""),
            '\r' | '\n' => out.push(' '),
            other => out.push(other),
        }
    }
    out.push('"');
    out
}

/// The fields of a line of quoted fields between commas; `None` if it is anything else.
pub(super) fn quoted_fields(line: &str) -> Option<Vec<String>> {
    let mut fields = Vec::new();
    let mut rest = line.trim();
    loop {
        let end = closing_quote(rest)?;
        let (field, after) = rest.split_at(end);
        fields.push(unquote(field)?);
        match after.trim_start() {
            "" => return Some(fields),
            more => rest = more.strip_prefix(',')?.trim_start(),
        }
    }
}

/// Byte offset behind the quote that closes the text that begins with one.
fn closing_quote(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    if bytes.first() != Some(&b'"') {
        return None;
    }
    let mut at = 1;
    loop {
        match (bytes.get(at)?, bytes.get(at + 1)) {
            (b'"', Some(b'"')) => at += 2,
            (b'"', _) => return Some(at + 1),
            _ => at += 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tabs_or_blanks_separate_operands() {
        let words = |line| split(line).words;
        assert_eq!(words("STR\tX0"), ["STR", "X0"]);
        assert_eq!(words("STR X0  "), ["STR", "X0"]);
        assert_eq!(words("MATH\tN13\t\"N12 * 2 + 1\""), ["MATH", "N13", "\"N12 * 2 + 1\""]);
        assert_eq!(words("MATH N13 \"N12 * 2\t+ 1\""), ["MATH", "N13", "\"N12 * 2\t+ 1\""]);
        assert_eq!(words("CALL\tname\t\t0x0\t"), ["CALL", "name", "", "0x0"]);
        assert_eq!(
            words("STRPRINT SS0 \"say \"\"hi there\"\" now\""),
            ["STRPRINT", "SS0", "\"say \"\"hi there\"\" now\""]
        );
        assert_eq!(words("   "), [""; 0]);
        assert_eq!(split("MATH N0 \"1 + 2").open_quote, Some(8));
        assert_eq!(split("MATH N0 \"\"").open_quote, None);
    }

    #[test]
    fn quotes_come_off_and_back() {
        for text in ["", "plain", "say \"hi\"", "\"", "\"\""] {
            assert_eq!(unquote(&quote(text)).as_deref(), Some(text));
        }
        assert_eq!(quote("\"\""), "\"\"\"\"\"\"");
        for word in ["", "\"", "\"a", "a\"", "\"a\"b\"", "\"\"\""] {
            assert_eq!(unquote(word), None, "{word}");
        }
    }

    #[test]
    fn fields_of_documentation() {
        let fields = quoted_fields(r#""X0","FLAGS =","Start","","say ""go"", then wait""#).expect("fields");
        assert_eq!(fields, ["X0", "FLAGS =", "Start", "", "say \"go\", then wait"]);
        for line in ["", "X0", "\"X0\",", "\"X0\" \"a\"", "\"X0\",\"a"] {
            assert_eq!(quoted_fields(line), None, "{line}");
        }
    }
}
