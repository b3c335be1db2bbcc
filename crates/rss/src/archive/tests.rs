//! Tests of the archive rules, with bytes laid out by hand after the MFC sources' published behaviour.

use super::*;
use crate::text::Text;

fn reader(bytes: &[u8]) -> Reader<'_> {
    Reader::new(bytes, "S", Mode::Permissive)
}

#[test]
fn classes_and_objects_share_one_counter() {
    // Class A is 1, its object 2; class B is 3, its object 4; then A again, B again, object 2, null.
    let bytes = b"\xFF\xFF\x80\0\x01\0A\xFF\xFF\x80\0\x01\0B\x01\x80\x03\x80\x02\0\0\0";
    let mut r = reader(bytes);
    assert_eq!(r.expect_object("A"), Ok(2));
    assert_eq!(r.expect_object("B"), Ok(4));
    assert_eq!(r.expect_object("A"), Ok(5));
    assert_eq!(r.expect_object("B"), Ok(6));
    assert_eq!(r.object(), Ok(Object::Reference { number: 2 }));
    assert_eq!(r.object(), Ok(Object::Null));
    assert_eq!(r.remaining(), 0);

    let mut w = Writer::new();
    assert_eq!((w.object("A"), w.object("B"), w.object("A"), w.object("B")), (2, 4, 5, 6));
    w.reference(2);
    w.null();
    assert_eq!(w.into_bytes(), bytes);
}

#[test]
fn numbers_from_7fff_on_take_the_big_tag() {
    let mut w = Writer::new();
    // 1 class, then objects 2 to 0x7FFE.
    for _ in 2..0x7FFF {
        w.object("A");
    }
    let late = w.object("B"); // class B takes 0x7FFF, its object 0x8000
    assert_eq!(late, 0x8000);
    let at = w.len();
    w.object("B");
    w.reference(late);
    w.reference(0x7FFE);
    let bytes = w.into_bytes();
    assert_eq!(&bytes[at..], b"\xFF\x7F\xFF\x7F\0\x80\xFF\x7F\0\x80\0\0\xFE\x7F");

    let mut r = Reader::new(&bytes, "S", Mode::Strict);
    for n in 2..0x7FFF {
        assert_eq!(r.expect_object("A"), Ok(n));
    }
    assert_eq!(r.expect_object("B"), Ok(0x8000));
    assert_eq!(r.expect_object("B"), Ok(0x8001));
    assert_eq!(r.object(), Ok(Object::Reference { number: 0x8000 }));
    assert_eq!(r.object(), Ok(Object::Reference { number: 0x7FFE }));
}

#[test]
fn tags_out_of_range_are_located() {
    for (bytes, found) in [
        (&b"\x01\x80"[..], "class number 1"),
        (b"\x05\0", "a reference to object 5, which does not exist"),
        (b"\xFF\x7F\x34\x12\x01\x80", "class number 70196"),
        (b"\xFF\xFF\x80\0\x02\0A!", "\"A!\""),
    ] {
        let error = reader(bytes).object().expect_err("must fail");
        let Error::Record(d) = error else { panic!("{error:?}") };
        assert_eq!(d.found, found);
    }
    // A class number is no object number, and the other way round.
    let mut r = reader(b"\xFF\xFF\x80\0\x01\0A\x01\0");
    assert_eq!(r.expect_object("A"), Ok(2));
    assert!(r.object().is_err());
    let mut r = reader(b"\xFF\xFF\x80\0\x01\0A\x02\x80");
    assert_eq!(r.expect_object("A"), Ok(2));
    assert!(r.object().is_err());
}

#[test]
fn strings_keep_the_form_of_their_length() {
    let long = [b'x'; 0x1_0000];
    let mut cases: Vec<(Vec<u8>, LengthForm)> = vec![
        (b"\x02T4".to_vec(), LengthForm::Shortest),
        (b"\xFF\x02\0T4".to_vec(), LengthForm::Word),
        (b"\xFF\xFF\xFF\x02\0\0\0T4".to_vec(), LengthForm::Long),
        (b"\xFF\xFE\xFF\x02T\x004\0".to_vec(), LengthForm::Shortest),
        (b"\xFF\xFE\xFF\xFF\x02\0T\x004\0".to_vec(), LengthForm::Word),
        (b"\xFF\xFE\xFF\xFF\xFF\xFF\x02\0\0\0T\x004\0".to_vec(), LengthForm::Long),
    ];
    cases.push(([b"\xFF\xFF\0".as_slice(), &long[..0xFF]].concat(), LengthForm::Shortest));
    cases.push(([b"\xFF\xFF\xFF\xFE\xFF\0\0".as_slice(), &long[..0xFFFE]].concat(), LengthForm::Shortest));
    cases.push(([b"\xFF\xFE\xFF\xFF\xFE\xFF".as_slice(), &[0; 0x1_FFFC]].concat(), LengthForm::Word));
    for (bytes, form) in cases {
        let mut r = reader(&bytes);
        let text = r.string("text").expect("reads");
        assert_eq!(r.remaining(), 0);
        assert_eq!(text.length_form(), form);
        let mut w = Writer::new();
        w.string(&text).expect("writes");
        assert_eq!(w.into_bytes(), bytes);
    }
}

use crate::text::LengthForm;

#[test]
fn counts_and_lengths_are_checked_before_anything_is_allocated() {
    let mut r = reader(b"\xFF\xFF\xFF\xFF\xFF\xFF");
    assert!(r.count("items", 1).is_err());
    let mut r = reader(b"\x04\0abc");
    let error = r.count("a number of items", 1).expect_err("must fail");
    assert_eq!(
        error.to_string(),
        "S, inflated offset 0x2: expected a number of items that fits the 3 bytes left, found 4"
    );
    assert!(reader(b"\xFF\xFF\xFF\xFF\xFF\xFF\xFFxyz").string("text").is_err());
    assert!(reader(b"\xFF\xFE\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFFxyz").string("text").is_err());
    assert_eq!(reader(b"\xFF\xFF\x02\0\0\0ab").count("items", 1), Ok(2));
    assert!(Reader::new(b"\xFF\xFF\x02\0\0\0ab", "S", Mode::Strict).count("items", 1).is_err());
}

#[test]
fn a_message_carries_the_path() {
    let mut r = reader(b"\x01");
    r.enter("file", 4).expect("shallow");
    r.enter_named("force table").expect("shallow");
    let error = r.u32("a mask").expect_err("must fail");
    assert_eq!(
        error.to_string(),
        "S, inflated offset 0x0, in file 4 > force table: expected a mask (4 bytes), found 1 bytes before the end"
    );
}

#[test]
fn rewinding_forgets_numbers() {
    let mut r = reader(b"\xFF\xFF\x80\0\x01\0A\x01\x80");
    let start = r.checkpoint();
    assert_eq!(r.expect_object("A"), Ok(2));
    r.rewind(&start);
    assert_eq!(r.expect_object("A"), Ok(2));
    assert_eq!(r.expect_object("A"), Ok(3));
}

#[test]
fn nesting_has_a_limit() {
    let mut r = reader(b"");
    let mut depth = 0;
    while r.enter("leg", 0).is_ok() {
        depth += 1;
    }
    assert_eq!(depth, MAX_DEPTH);
}

#[test]
fn trailing_bytes_are_a_deviation() {
    #[derive(Default)]
    struct One<'a>(Text<'a>);
    impl<'a> Record<'a> for One<'a> {
        fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
            self.0 = r.string("text")?;
            Ok(())
        }
        fn write(&self, w: &mut Writer) -> Result<()> {
            w.string(&self.0)
        }
    }
    let parsed = parse::<One>(b"\x01xyy", "S", Mode::Permissive);
    assert_eq!((parsed.understood, parsed.error.is_none(), parsed.deviations.len()), (2, true, 1));
    let parsed = parse::<One>(b"\x01xyy", "S", Mode::Strict);
    assert_eq!((parsed.understood, parsed.error.is_some()), (2, true));
    assert_eq!(serialize(&parsed.value), Ok(b"\x01x".to_vec()));
}

#[test]
fn carried_bytes_are_not_understood() {
    #[derive(Default)]
    struct Tail<'a>(Text<'a>, &'a [u8]);
    impl<'a> Record<'a> for Tail<'a> {
        fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
            self.0 = r.string("text")?;
            self.1 = r.opaque("the rest", r.remaining())?;
            Ok(())
        }
        fn write(&self, w: &mut Writer) -> Result<()> {
            w.string(&self.0)?;
            w.bytes(self.1);
            Ok(())
        }
    }
    let bytes = b"\x01xyyy";
    let parsed = parse::<Tail>(bytes, "S", Mode::Strict);
    assert_eq!((parsed.understood, parsed.error.is_none()), (2, true));
    assert_eq!(serialize(&parsed.value), Ok(bytes.to_vec()));
}
