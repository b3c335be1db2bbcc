//! Text that cannot be taken for markup.

use std::borrow::Cow;

/// Any text for the inside of an element or of a quoted attribute, in HTML and XML. Control characters and
/// what XML does not allow become U+FFFD.
pub fn escape(text: &str) -> Cow<'_, str> {
    let special = |c: char| matches!(c, '<' | '>' | '&' | '"' | '\'') || !allowed(c);
    if !text.contains(special) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match c {
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            c if allowed(c) => out.push(c),
            _ => out.push('\u{FFFD}'),
        }
    }
    Cow::Owned(out)
}

/// The characters of XML 1.0 that show, and white space.
fn allowed(c: char) -> bool {
    matches!(c, '\t' | '\n' | '\r') || !(c.is_control() || matches!(c, '\u{FFFE}' | '\u{FFFF}'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_is_text() {
        assert_eq!(escape("plain °C"), "plain °C");
        assert_eq!(escape("</text><script a=\"b'\">&"), "&lt;/text&gt;&lt;script a=&quot;b&#39;&quot;&gt;&amp;");
        assert_eq!(escape("a\0b\u{1B}c\u{9B}\u{FFFF}\t\n"), "a\u{FFFD}b\u{FFFD}c\u{FFFD}\u{FFFD}\t\n");
    }
}
