//! Names of places in a document, made so that they can stand in any link unchanged.

use std::fmt;

/// The name of a place. Only ASCII letters, digits and `- . _ : / ~`; whatever a project says, nothing
/// in it has a meaning in HTML, in a URL fragment or in PDF.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Anchor(String);

impl Anchor {
    /// A place with a name of ours.
    pub(crate) fn named(name: &str) -> Anchor {
        Anchor(encode("", name))
    }

    /// The cross reference entry of an address.
    pub fn reference(address: &str) -> Anchor {
        Anchor(encode("x-", address))
    }

    /// The row of the data table with an element.
    pub fn element(address: &str) -> Anchor {
        Anchor(encode("d-", address))
    }

    /// The entry of an address in the symbol database.
    pub fn symbol(address: &str) -> Anchor {
        Anchor(encode("s-", address))
    }

    /// The row of a timer or counter.
    pub fn timer(address: &str) -> Anchor {
        Anchor(encode("t-", address))
    }

    /// A program file by number, or a code block by its place in the project.
    pub fn file(number: impl fmt::Display) -> Anchor {
        Anchor(format!("f-{number}"))
    }

    /// A rung of a program file, both as shown.
    pub fn rung(file: impl fmt::Display, rung: impl fmt::Display) -> Anchor {
        Anchor(format!("r-{file}-{rung}"))
    }

    /// The text.
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Anchor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Bytes that have a meaning somewhere become `~` and two hex digits, so that different texts stay
/// different.
fn encode(prefix: &str, text: &str) -> String {
    let mut name = String::with_capacity(prefix.len() + text.len());
    name.push_str(prefix);
    for byte in text.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b':' | b'/' => name.push(char::from(byte)),
            other => name.push_str(&format!("~{other:02X}")),
        }
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_of_a_project_gets_a_meaning() {
        assert_eq!(Anchor::reference("T4:0/DN").as_str(), "x-T4:0/DN");
        assert_eq!(Anchor::reference("#N7:[N7:0]").as_str(), "x-~23N7:~5BN7:0~5D");
        assert_eq!(Anchor::element("\"><a~").as_str(), "d-~22~3E~3Ca~7E");
    }
}
