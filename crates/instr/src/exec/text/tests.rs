//! String instructions at their limits.

use proptest::prelude::*;

use super::*;
use crate::exec::Lineage;

fn rules() -> Rules {
    Rules::new(Lineage::S3)
}

fn element(text: &str) -> [u16; WORDS] {
    let mut words = [0; WORDS];
    Text::cut(text.bytes()).0.write(&mut words, rules());
    words
}

fn string(text: &Text) -> String {
    text.characters().iter().map(|character| char::from(*character)).collect()
}

fn number(text: &str, to: Width) -> Option<(Option<Number>, Flags)> {
    let outcome = aci(&element(text), to, rules().math(0x4000)).unwrap_or_else(|_| panic!("{text}"));
    outcome.map(|outcome| (outcome.value, outcome.flags))
}

fn bad_length() -> [u16; WORDS] {
    let mut words = element("A");
    words[0] = 83;
    words
}

#[test]
fn layout() {
    let words = element("ABC");
    assert_eq!(words[..3], [3, 0x4142, 0x4300]);
    assert_eq!(Text::read(&words).map(|text| string(&text)), Ok("ABC".to_owned()));
    assert_eq!(Text::read(&[3, 0x4142]), Err(StringError), "too few words");
    assert_eq!(Text::read(&[]), Err(StringError));
    assert_eq!(Text::read(&bad_length()), Err(StringError));
    assert_eq!(Text::read(&[0xFFFF; WORDS]), Err(StringError), "a negative length");
    assert_eq!(Text::read(&[0]), Ok(Text::EMPTY));
}

#[test]
fn what_stands_behind_the_end() {
    let mut words = element("ABCDEF");
    Text::cut(*b"xyz").0.write(&mut words, rules());
    assert_eq!(words[..4], [3, u16::from_be_bytes(*b"xy"), u16::from_be_bytes(*b"zD"), u16::from_be_bytes(*b"EF")]);
    Text::cut(*b"xyz").0.write(&mut words, rules().with(Choice::StringClearsRest));
    assert_eq!(words[2..4], [u16::from_be_bytes(*b"z\0"), 0]);
    Text::cut(*b"xyz").0.write(&mut words[..2], rules());
    Text::EMPTY.write(&mut [], rules());
}

#[test]
fn string_to_integer() {
    let word = |value: i16| Some(Number::Word(value));
    assert_eq!(number("ABC-123X", Width::Word), Some((word(-123), Flags::SIGN)));
    assert_eq!(number("1,234 56", Width::Word), Some((word(1234), Flags::NONE)));
    assert_eq!(number("+7", Width::Word), Some((word(7), Flags::NONE)));
    assert_eq!(number("- 7", Width::Word), Some((word(7), Flags::NONE)), "the sign is not next to the digit");
    assert_eq!(number("000", Width::Word), Some((word(0), Flags::ZERO)));
    assert_eq!(number("32767", Width::Word), Some((word(32767), Flags::NONE)));
    assert_eq!(number("32768", Width::Word), Some((word(32767), Flags::OVERFLOW)));
    assert_eq!(number("-32768", Width::Word), Some((word(-32768), Flags::SIGN)));
    assert_eq!(number("-32769", Width::Word), Some((word(32767), Flags::OVERFLOW)));
    assert_eq!(number("99999999999999999999999", Width::Long), Some((Some(Number::Long(i32::MAX)), Flags::OVERFLOW)));
    assert_eq!(number("no digit -", Width::Word), None);
    assert_eq!(number("", Width::Word), None);
    let signed = rules().with(Choice::AciSigned).math(0);
    let outcome = aci(&element("-40000"), Width::Word, signed);
    assert_eq!(outcome.map(|o| o.and_then(|o| o.value)), Ok(word(-32768)));
    assert_eq!(aci(&bad_length(), Width::Word, signed), Err(StringError));
}

#[test]
fn integer_to_string() {
    let text = |value| string(&aic(value, rules().math(0)));
    assert_eq!(text(Number::Word(0)), "0");
    assert_eq!(text(Number::Word(-32768)), "-32768");
    assert_eq!(text(Number::Long(i32::MIN)), "-2147483648");
    assert_eq!(text(Number::Float(2.5)), "2");
}

#[test]
fn concatenation() {
    let joined = |a: &str, b: &str| acn(&element(a), &element(b)).map(|(text, cut)| (string(&text), cut));
    assert_eq!(joined("AB", "CDE"), Ok(("ABCDE".to_owned(), false)));
    assert_eq!(joined("", ""), Ok((String::new(), false)));
    let half = "x".repeat(41);
    assert_eq!(joined(&half, &half), Ok(("x".repeat(82), false)));
    assert_eq!(joined(&half, &format!("{half}y")), Ok(("x".repeat(82), true)));
    assert_eq!(acn(&element("A"), &bad_length()), Err(StringError));
}

#[test]
fn extraction() {
    let part = |index, number| aex(&element("abcdef"), index, number, rules()).map(|text| string(&text));
    assert_eq!(part(2, 3), Ok("bcd".to_owned()));
    assert_eq!(part(5, 10), Ok("ef".to_owned()), "up to the end, no error");
    assert_eq!(part(6, 82), Ok("f".to_owned()));
    for (index, number) in [(0, 1), (1, 0), (7, 1), (83, 1), (1, 83), (-1, 1), (i32::MAX, i32::MIN)] {
        assert_eq!(part(index, number), Err(StringError), "{index} {number}");
    }
    let all = rules().with(Choice::ExtractNeedsAll);
    assert_eq!(aex(&element("abcdef"), 5, 3, all), Err(StringError));
    assert_eq!(aex(&element("abcdef"), 5, 2, all).map(|text| string(&text)), Ok("ef".to_owned()));
    assert_eq!(aex(&element(""), 1, 1, rules()), Err(StringError));
    assert_eq!(aex(&bad_length(), 1, 1, rules()), Err(StringError));
}

#[test]
fn search() {
    let find = |what: &str, index| asc(&element(what), index, &element("abcabc"));
    assert_eq!(find("bc", 1), Ok(2));
    assert_eq!(find("bc", 3), Ok(5));
    assert_eq!(find("bc", 6), Ok(0));
    assert_eq!(find("BC", 1), Ok(0), "case matters");
    assert_eq!(find("abcabcabc", 1), Ok(0));
    for index in [0, 7, 83, -1] {
        assert_eq!(find("bc", index), Err(StringError));
    }
    assert_eq!(find("", 1), Err(StringError));
    assert_eq!(asc(&element("a"), 1, &bad_length()), Err(StringError));
}

#[test]
fn comparison() {
    assert_eq!(asr(&element("abc"), &element("abc")), Ok(true));
    assert_eq!(asr(&element("abc"), &element("abC")), Ok(false));
    assert_eq!(asr(&element("abc"), &element("ab")), Ok(false));
    let mut noisy = element("abc");
    noisy[2] |= 0x7F;
    assert_eq!(asr(&noisy, &element("abc")), Ok(true), "what stands behind the end does not count");
    assert_eq!(asr(&element("abc"), &bad_length()), Err(StringError));
}

#[test]
fn lines() {
    assert_eq!(line_length(b"ab\rcd\r", b"\r"), Some(3));
    assert_eq!(line_length(b"ab\rcd\r\n", b"\r\n"), Some(7));
    assert_eq!(line_length(b"ab", b"\r"), None);
    assert_eq!(line_length(b"ab", b""), None);
}

proptest! {
    #[test]
    fn numbers_come_back(value: i32) {
        let mut words = [0; WORDS];
        aic(Number::Long(value), rules().math(0)).write(&mut words, rules());
        let back = aci(&words, Width::Long, rules().math(0)).map(|o| o.and_then(|o| o.value));
        prop_assert_eq!(back, Ok(Some(Number::Long(value))));
    }

    #[test]
    fn what_is_found_can_be_extracted(text in "[ab]{1,82}", what in "[ab]{1,4}", index in 1_i32..83) {
        match asc(&element(&what), index, &element(&text)) {
            Ok(0) => prop_assert!(!text[index as usize - 1..].contains(&what)),
            Ok(at) => {
                let part = aex(&element(&text), at.into(), what.len() as i32, rules()).map(|part| string(&part));
                prop_assert_eq!(part, Ok(what));
            }
            Err(_) => prop_assert!(index as usize > text.len()),
        }
    }

    #[test]
    fn any_words_are_survived(words in prop::collection::vec(any::<u16>(), 0..50), index: i32, number: i32) {
        let mode = rules().math(0);
        let _ = (aci(&words, Width::Word, mode), acn(&words, &words), aex(&words, index, number, rules()));
        let _ = (asc(&words, index, &words), asr(&words, &words));
    }
}
