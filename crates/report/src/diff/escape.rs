//! Texts of a project as texts of a page.

use std::borrow::Cow;
use std::fmt;

/// A text that shows in a page, as content or in a quoted attribute, exactly as it is: marks have no meaning,
/// control characters are spelled out. Line ends stay.
pub(super) fn escape(text: &str) -> Escaped<'_> {
    Escaped(text)
}

/// See [`escape`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, line) in self.0.split('\n').enumerate() {
            if number > 0 {
                f.write_str("\n")?;
            }
            let clean: Cow<'_, str> = render::clean(line.strip_suffix('\r').unwrap_or(line));
            let mut rest = &*clean;
            while let Some(at) = rest.find(['&', '<', '>', '"', '\'']) {
                let (before, mark) = rest.split_at(at);
                f.write_str(before)?;
                f.write_str(match mark.as_bytes().first() {
                    Some(b'&') => "&amp;",
                    Some(b'<') => "&lt;",
                    Some(b'>') => "&gt;",
                    Some(b'"') => "&quot;",
                    _ => "&#39;",
                })?;
                // All of these marks are one byte long.
                rest = mark.get(1..).unwrap_or_default();
            }
            f.write_str(rest)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_breaks_out() {
        let text = "<script>\"onload='x'\" & \u{1B}[2J\r\n</svg>";
        assert_eq!(
            escape(text).to_string(),
            "&lt;script&gt;&quot;onload=&#39;x&#39;&quot; &amp; \\x1B[2J\n&lt;/svg&gt;"
        );
    }
}
