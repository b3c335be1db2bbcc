//! Names what a file is that is no RSLogix 500 project, by its content and never by its name.

use crate::container::{Container, SIGNATURE};
use crate::error::{Error, Foreign};
use crate::stream::StreamKind;

/// What the bytes are, if they are no RSLogix 500 project; `None` for a project
/// (which may still be damaged).
#[must_use]
pub fn identify(bytes: &[u8]) -> Option<Foreign> {
    if !bytes.starts_with(&SIGNATURE) {
        return Some(identify_plain(bytes));
    }
    match Container::read(bytes) {
        Ok(container) => identify_container(&container),
        Err(Error::Foreign(kind)) => Some(kind),
        Err(_) => None,
    }
}

/// What a compound file is, if it holds no stream of an RSLogix 500 project.
#[must_use]
pub fn identify_container(container: &Container) -> Option<Foreign> {
    let mut streams = container.streams().map(|(path, _)| StreamKind::of_path(path).1).peekable();
    if streams.peek().is_none() {
        return Some(Foreign::CompoundWithoutStreams);
    }
    let ours = streams.any(|kind| kind.has_envelope());
    // The summary names the program that wrote the file. RSLogix 5 shares the
    // container, and perhaps the storage names, with RSLogix 500.
    let plc5 = container.stream(StreamKind::SummaryInformation.name()).is_some_and(|summary| {
        positions(summary, b"RSLogix 5").any(|at| !summary.get(at + 9).is_some_and(u8::is_ascii_digit))
    });
    match (plc5, ours) {
        (true, _) => Some(Foreign::Rsp),
        (false, true) => None,
        (false, false) => Some(Foreign::CompoundOther),
    }
}

/// What a file without the compound file signature is.
#[must_use]
pub fn identify_plain(bytes: &[u8]) -> Foreign {
    let head = bytes.get(..bytes.len().min(1 << 16)).unwrap_or_default();
    let starts = |marks: &[&[u8]]| marks.iter().any(|m| head.starts_with(m));
    if bytes.is_empty() {
        Foreign::Empty
    } else if positions(head.get(..head.len().min(1024)).unwrap_or_default(), b"%PDF-").next().is_some() {
        // Readers accept the mark anywhere in the first kilobyte.
        Foreign::Pdf
    } else if starts(&[b"PK\x03\x04", b"PK\x05\x06", b"PK\x07\x08"]) {
        Foreign::Zip
    } else if starts(&[b"\x1F\x8B", b"7z\xBC\xAF\x27\x1C", b"Rar!\x1A\x07", b"MSCF", b"BZh", b"\xFD7zXZ\0"]) {
        Foreign::OtherArchive
    } else if is_acd(bytes) {
        Foreign::Acd
    } else if let Some(text) = as_text(head) {
        identify_text(&text)
    } else if bytes.iter().all(|&b| b == 0) {
        Foreign::Zeros
    } else {
        let mut start = [0; 8];
        for (to, from) in start.iter_mut().zip(bytes) {
            *to = *from;
        }
        Foreign::Unknown { start }
    }
}

fn identify_text(text: &str) -> Foreign {
    let has = |word: &str| text.contains(word);
    if text.trim_start().starts_with('<') {
        return if has("RSLogix5000Content") { Foreign::L5x } else { Foreign::Xml };
    }
    if has("IE_VER") && has("CONTROLLER") {
        return Foreign::L5k;
    }
    let slc = text.lines().map(str::trim_start).any(|line| {
        line.starts_with("SOR ")
            || line.strip_prefix("LADDER ").is_some_and(|n| n.trim().parse::<u16>().is_ok())
            || line.strip_prefix("START ").is_some_and(|rest| rest.contains('%'))
    });
    if slc { Foreign::SlcText } else { Foreign::Text }
}

/// The text of the first bytes, if they are text (UTF-16 with a mark, or bytes
/// of which few are no printable character).
fn as_text(head: &[u8]) -> Option<String> {
    let wide = |little: bool| {
        let units = head.get(2..).unwrap_or_default().chunks_exact(2).map(move |p| match little {
            true => u16::from_le_bytes([p[0], p[1]]),
            false => u16::from_be_bytes([p[0], p[1]]),
        });
        char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
    };
    match head {
        [0xFF, 0xFE, ..] => return Some(wide(true)),
        [0xFE, 0xFF, ..] => return Some(wide(false)),
        _ => {}
    }
    let body = head.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(head);
    let odd = |b: u8| b < 0x20 && !matches!(b, b'\t' | b'\n' | b'\r' | 0x0C | 0x1A);
    // A comment of a program can hold any character: what begins like an SLC text is one all the same.
    let begins_slc = body.trim_ascii_start().starts_with(b"START ");
    let odd = if begins_slc { 0 } else { body.iter().filter(|&&b| odd(b)).count() };
    let high = body.iter().filter(|&&b| b >= 0x7F).count();
    let utf8 = std::str::from_utf8(body).is_ok_and(|_| odd == 0);
    (utf8 || (odd == 0 && high * 10 <= body.len())).then(|| String::from_utf8_lossy(body).into_owned())
}

/// A Logix 5000 project database: ends in a table of its member files. The last
/// eight bytes begin with the number of members; each has a record of 528 bytes
/// before that: name (260 UTF-16 units), length, offset.
fn is_acd(bytes: &[u8]) -> bool {
    let u32_at = |at: usize| {
        let field = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        usize::try_from(u32::from_le_bytes(field)).ok()
    };
    let table = || {
        let end = bytes.len().checked_sub(8)?;
        let members = u32_at(end)?;
        let start = end.checked_sub(members.checked_mul(528)?)?;
        let name = bytes.get(start..start.checked_add(520)?)?;
        let (length, offset) = (u32_at(start + 520)?, u32_at(start + 524)?);
        let named = matches!(name, [b' '..=b'~', 0, b' '..=b'~', 0, ..]);
        Some(members > 0 && named && length.checked_add(offset)? <= start)
    };
    table().unwrap_or(false)
}

fn positions<'b>(bytes: &'b [u8], mark: &'b [u8]) -> impl Iterator<Item = usize> + 'b {
    bytes.windows(mark.len()).enumerate().filter(move |(_, w)| *w == mark).map(|(at, _)| at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_names_the_file() {
        let mut acd = b"text header".to_vec();
        let mut name: Vec<u8> = "Comps.Dat".encode_utf16().flat_map(u16::to_le_bytes).collect();
        name.resize(520, 0);
        acd.extend_from_slice(&name);
        acd.extend_from_slice(&[4, 0, 0, 0, 2, 0, 0, 0]);
        acd.extend_from_slice(&[1, 0, 0, 0, 9, 9, 9, 9]);
        let utf16: Vec<u8> = [0xFF, 0xFE]
            .into_iter()
            .chain("<?xml?>\n<RSLogix5000Content>".encode_utf16().flat_map(u16::to_le_bytes))
            .collect();
        let cases: [(&[u8], Foreign); 16] = [
            (b"", Foreign::Empty),
            (b"%PDF-1.5\n", Foreign::Pdf),
            (b"\0\0%PDF-1.5\n", Foreign::Pdf),
            (b"PK\x03\x04rest", Foreign::Zip),
            (b"\x1F\x8B\x08\0", Foreign::OtherArchive),
            (&acd, Foreign::Acd),
            (b"\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<RSLogix5000Content SchemaRevision=\"1.0\">", Foreign::L5x),
            (&utf16, Foreign::L5x),
            (b"<html>", Foreign::Xml),
            (b"IE_VER := 2.8;\nCONTROLLER c (", Foreign::L5k),
            (b"START 1747-L40A % fixed %\n\nLADDER 2\n", Foreign::SlcText),
            (b"  SOR XIC B3:0/0 OTE B3:0/1 EOR", Foreign::SlcText),
            (b"START Bul.1766 % x %\nLADDER 2\n% TITLE\x01\x1B\0 %\n", Foreign::SlcText),
            (b"Dear reader,\r\nno ladder here.", Foreign::Text),
            (&[0; 600], Foreign::Zeros),
            (b"\x01\x02\x03\x04\x80", Foreign::Unknown { start: [1, 2, 3, 4, 0x80, 0, 0, 0] }),
        ];
        for (bytes, expected) in cases {
            assert_eq!(identify(bytes), Some(expected), "{:?}", crate::text::decode(bytes));
        }
    }

    #[test]
    fn compound_files_are_told_apart() {
        let none = Container::default().write().expect("writes");
        assert_eq!(identify(&none), Some(Foreign::CompoundWithoutStreams));
        let mut word = Container::default();
        word.set_stream("WordDocument", vec![0; 10]);
        assert_eq!(identify(&word.write().expect("writes")), Some(Foreign::CompoundOther));
        let mut ours = Container::default();
        ours.set_stream("PROCESSOR/ObjectData", vec![0; 10]);
        ours.set_stream("\u{5}SummaryInformation", b"..RSLogix 500 Pro\0".to_vec());
        assert_eq!(identify(&ours.write().expect("writes")), None);
        ours.set_stream("\u{5}SummaryInformation", b"..RSLogix 5\0".to_vec());
        assert_eq!(identify(&ours.write().expect("writes")), Some(Foreign::Rsp));
    }
}
