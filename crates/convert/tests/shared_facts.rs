//! Facts that crates which must not know each other hold each for itself: they have to agree.
//!
//! `rss` and `ladder` use nothing of each other, and `instr` needs nothing of `rss`; `convert` is the
//! one place that sees all of them.

use instr::structural;
use ladder::{DataFile, FileType, Value};
use rss::program::mark;

#[test]
fn the_marks_of_a_rung_have_the_same_codes() {
    assert_eq!(
        [mark::RUNG_START, mark::RUNG_END, mark::BRANCH_START, mark::BRANCH_END, mark::LEG_START, mark::LEG_END],
        structural::MARKS.map(|mark| mark.opcode)
    );
}

#[test]
fn strings_of_the_data_table_and_of_archives_share_a_code_page() {
    for byte in 0..=u8::MAX {
        let mut file = DataFile::new(FileType::ST, 9, 1);
        file.words[..2].copy_from_slice(&[1, u16::from_be_bytes([byte, 0])]);
        assert_eq!(file.value(0), Some(Value::Text(rss::text::decode_byte(byte).to_string())), "{byte:#04x}");
    }
}
