//! Bytes of a text file and characters.

use std::borrow::Cow;

/// Byte order mark that says UTF-8.
const MARK: &[u8] = b"\xEF\xBB\xBF";

/// The text of a file: UTF-8 if it is that, with or without a byte order mark, else code page 1252,
/// which RSLogix writes and in which every byte has a character.
pub fn decode(bytes: &[u8]) -> Cow<'_, str> {
    match std::str::from_utf8(bytes.strip_prefix(MARK).unwrap_or(bytes)) {
        Ok(text) => Cow::Borrowed(text),
        Err(_) => rss::text::decode(bytes),
    }
}

/// The bytes of a text: code page 1252, or UTF-8 with a byte order mark where a character is not in
/// that code page or [`decode`] would take the bytes for UTF-8.
pub fn encode(text: &str) -> Vec<u8> {
    match rss::text::encode(text) {
        Ok(bytes) if text.is_ascii() || std::str::from_utf8(&bytes).is_err() => bytes,
        _ => [MARK, text.as_bytes()].concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_comes_back() {
        for text in ["", "plain", "50 °C ± 2", "Ã©", "Ж", "\u{81}", "日本"] {
            assert_eq!(decode(&encode(text)), text);
        }
        assert_eq!(encode("20 °C"), b"20 \xB0C");
        assert_eq!(decode("20 °C".as_bytes()), "20 °C");
        assert_eq!(decode(b"20 \xB0C"), "20 °C");
    }
}
