//! Texts of a project as texts of a page.

use std::fmt;

/// A text that shows in a page, as content or in a quoted attribute, exactly as it is: marks have no meaning,
/// control characters are spelled out. Line ends stay.
pub(crate) fn escape(text: &str) -> Escaped<'_> {
    Escaped(text)
}

/// See [`escape`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Escaped<'a>(&'a str);

impl fmt::Display for Escaped<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (number, line) in self.0.split('\n').enumerate() {
            if number > 0 {
                f.write_str("\n")?;
            }
            f.write_str(&render::svg::escape(&render::clean(line.strip_suffix('\r').unwrap_or(line))))?;
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
