//! Tests of the operand encoding: the published forms, text beside bytes.

use super::*;
use proptest::prelude::*;

/// Spells an operand with bare numbers, enough to tell the forms apart.
fn spell(o: &Operand) -> String {
    let place = |p: &Place| match p {
        Place::Number(n) => n.to_string(),
        Place::By(o) => format!("[{}]", spell(o)),
    };
    match o {
        Operand::Int(v) => v.to_string(),
        Operand::Long(v) => format!("{v}L"),
        Operand::Float(bits) => format!("{:?}", f32::from_bits(*bits)),
        Operand::Stack => "pop".to_owned(),
        Operand::Address(a) => {
            let file = match &a.file {
                FilePlace::Data(p) => place(p),
                FilePlace::Function(n) => format!("f{n}"),
            };
            let word = a.word.map(|w| format!(".{w}")).unwrap_or_default();
            let bit = a.bit.as_ref().map(|b| format!("/{}", place(b))).unwrap_or_default();
            let hash = if a.indexed { "#" } else { "" };
            format!("{hash}<{}>{file}:{}{word}{bit}", a.type_code, place(&a.element))
        }
    }
}

#[test]
fn every_form_reads_as_listed_and_comes_back() {
    // Bytes as real projects hold them for the text in the comment.
    let forms: &[(&[u8], &str)] = &[
        (&[0x07, 0x08, 0x07, 0x00, 0x07, 0x03], "<7>7:3"),         // N7:3
        (&[0x17, 0x08, 0xF3, 0x00, 0x03, 0x00], "<3>3:0/15"),      // B3:0/15
        (&[0x17, 0x08, 0xD4, 0x00, 0x04, 0x88], "<4>4:136/13"),    // T4:136/DN
        (&[0x0F, 0x08, 0x01, 0x03, 0x01, 0x04], "<1>1:4.3"),       // I:4.3
        (&[0x0F, 0x08, 0x04, 0x02, 0x04, 0x00], "<4>4:0.2"),       // T4:0.ACC
        (&[0x1F, 0x08, 0x41, 0x00, 0x01, 0x00], "<1>1:0.0/4"),     // I:0.0/4
        (&[0x87, 0x00, 0x10, 0x00, 0x66, 0x00], "<16>102:0"),      // L102:0
        (&[0x97, 0x00, 0xD0, 0x07, 0x09, 0x01], "<16>9:1/31"),     // L9:1/31
        (&[0x8F, 0x00, 0x16, 0x80, 0x19, 0x00], "<22>25:0.16"),    // PD25:0.CVP
        (&[0x9F, 0x00, 0x53, 0x8B, 0x44, 0x00], "<19>68:0.17/13"), // MG68:0/DN
        (&[0x85, 0x00, 0x27, 0x00, 0x01, 0x09], "<39>f1:9"),       // ES1:9
        (&[0x8D, 0x00, 0x11, 0x38, 0x00, 0x00], "<17>f0:0.7"),     // HSC:0.HIP
        (&[0x9D, 0x00, 0xD1, 0x12, 0x00, 0x00], "<17>f0:0.2/11"),  // HSC:0/CE
        (&[0x07, 0x88, 0x07, 0x00, 0x07, 0x03], "#<7>7:3"),        // #N7:3
        (&[0x8D, 0x80, 0x17, 0x00, 0x00, 0x00], "#<23>f0:0.0"),    // #RTC:0.YR
        (&[0x00, 0x02, 0x01, 0xFF, 0x00, 0x00], "-255"),
        (&[0x00, 0x01, 0xFF, 0xFF, 0xFF, 0xFF], "-1L"),
        (&[0x00, 0x04, 0x00, 0x00, 0xC8, 0x42], "100.0"),
        (&[0x00; 6], "pop"),
    ];
    let n7 = |element: u8| [0x07, 0x08, 0x07, 0x00, 0x07, element];
    let indirect = [
        ([0x47, 0x08, 0x03, 0x00, 0x67, 0x0A], 1, "<3>103:10/[<7>7:0]"), // B103:10/[N7:0]
        ([0x03, 0x28, 0x07, 0x00, 0x09, 0x00], 1, "<7>9:[<7>7:0]"),      // N9:[N7:0]
        ([0x13, 0x28, 0x17, 0x00, 0xC8, 0x00], 1, "<7>200:[<7>7:0]/1"),  // N200:[N7:0]/1
        ([0x43, 0x28, 0x07, 0x00, 0x64, 0x00], 2, "<7>100:[<7>7:0]/[<7>7:1]"),
        ([0x05, 0x48, 0x07, 0x00, 0x00, 0x02], 1, "<7>[<7>7:0]:2"), // N[N7:0]:2
        ([0x01, 0x68, 0x07, 0x00, 0x00, 0x00], 2, "<7>[<7>7:0]:[<7>7:1]"),
        ([0x09, 0x68, 0x04, 0x01, 0x00, 0x00], 2, "<4>[<7>7:0]:[<7>7:1].1"),
        ([0x03, 0xA8, 0x0E, 0x00, 0x2E, 0x00], 1, "#<14>46:[<7>7:0]"), // #ST46:[N7:0]
        ([0xC7, 0x00, 0x10, 0x00, 0x09, 0x00], 1, "<16>9:0/[<7>7:0]"), // L9:0/[N7:0]
    ];
    let mut cases: Vec<(Vec<u8>, &str)> = forms.iter().map(|(b, t)| (b.to_vec(), *t)).collect();
    for (head, places, text) in indirect {
        let mut bytes = head.to_vec();
        (0..places).for_each(|i| bytes.extend_from_slice(&n7(i)));
        cases.push((bytes, text));
    }
    for (bytes, text) in cases {
        let code = [&[0x1C], &bytes[..]].concat();
        let decoded = Code::decode(&code).unwrap_or_else(|e| panic!("{text}: {e}"));
        let Code::Operands { opcode: 0x1C, operands } = &decoded else { panic!("{decoded:?}") };
        assert_eq!(operands.iter().map(spell).collect::<Vec<_>>(), [text]);
        assert_eq!(decoded.encode(), Ok(code));
    }
}

#[test]
fn an_expression_is_a_row_of_steps() {
    // ( F8:8 | N7:62 ) * 100.0 into F8:14
    let code = [
        &[0x8A][..],
        &[0x2A, 0x07, 0x08, 0x08, 0x00, 0x08, 0x08, 0x07, 0x08, 0x07, 0x00, 0x07, 0x3E, 0, 0, 0, 0, 0, 0],
        &[0x29, 0, 0, 0, 0, 0, 0, 0x00, 0x04, 0x00, 0x00, 0xC8, 0x42, 0x07, 0x08, 0x08, 0x00, 0x08, 0x0E],
        &[0x8B],
    ]
    .concat();
    let decoded = Code::decode(&code).expect("decodes");
    let Code::Expression(steps) = &decoded else { panic!("{decoded:?}") };
    let text: Vec<String> = steps
        .iter()
        .map(|s| format!("{:x} {} {} {}", s.operator, spell(&s.a), spell(&s.b), spell(&s.result)))
        .collect();
    assert_eq!(text, ["2a <8>8:8 <7>7:62 pop", "29 pop 100.0 <8>8:14"]);
    assert_eq!(decoded.encode(), Ok(code));
}

#[test]
fn what_encoding_would_not_give_back_is_refused() {
    for (bytes, why) in [
        (&[0x1C, 0x07, 0x18, 0x07, 0x00, 0x07, 0x03][..], "unknown flag 0x1000"),
        (&[0x1C, 0x87, 0x08, 0x07, 0x00, 0x07, 0x03], "wide and narrow at once"),
        (&[0x1C, 0x07, 0x08, 0x17, 0x00, 0x07, 0x03], "a bit without its flag"),
        (&[0x1C, 0x07, 0x08, 0x07, 0x01, 0x07, 0x03], "a word without its flag"),
        (&[0x1C, 0x00, 0x02, 0x01, 0x00, 0x01, 0x00], "a 16-bit constant with a high half"),
        (&[0x1C, 0x02, 0x00, 0x01, 0x00, 0x01, 0x00], "no address, no constant"),
        (&[0x1C, 0x07, 0x08], "too short"),
        (&[0x1C, 0x03, 0x28, 0x07, 0x00, 0x09, 0x00], "an indirection without its operand"),
        (&[0x8A, 0x2A], "an expression cut short"),
        (&[], "nothing"),
    ] {
        assert!(Code::decode(bytes).is_err(), "{why}");
    }
    let nest = [&[0x1C][..], &[0x03, 0x28, 0x07, 0x00, 0x09, 0x00].repeat(100_000)].concat();
    assert!(Code::decode(&nest).is_err(), "endless indirection");
}

fn operand() -> impl Strategy<Value = Operand> {
    let leaf = prop_oneof![
        any::<i16>().prop_map(Operand::Int),
        any::<i32>().prop_map(Operand::Long),
        any::<u32>().prop_map(Operand::Float),
        Just(Operand::Stack),
    ];
    leaf.prop_recursive(3, 12, 3, |inner| {
        let place = prop_oneof![any::<u8>().prop_map(Place::Number), inner.prop_map(Place::By)];
        let file = prop_oneof![place.clone().prop_map(FilePlace::Data), any::<u8>().prop_map(FilePlace::Function)];
        (0..48_u8, file, place.clone(), proptest::option::of(0..32_u8), proptest::option::of(place), any::<bool>())
            .prop_map(|(type_code, file, element, word, bit, indexed)| {
                let bit = bit.map(|b| match b {
                    Place::Number(n) => Place::Number(n % 16),
                    by => by,
                });
                Operand::Address(Box::new(Address { type_code, file, element, word, bit, indexed }))
            })
    })
}

proptest! {
    #[test]
    fn encoded_operands_decode_equal(opcode in 0..0x8A_u8, operands in proptest::collection::vec(operand(), 0..5)) {
        let code = Code::Operands { opcode, operands };
        let bytes = code.encode().expect("fits");
        prop_assert_eq!(Code::decode(&bytes), Ok(code));
    }

    #[test]
    fn any_bytes_decode_to_themselves_or_not_at_all(bytes in proptest::collection::vec(any::<u8>(), 0..60)) {
        if let Ok(code) = Code::decode(&bytes) {
            prop_assert_eq!(code.encode(), Ok(bytes));
        }
    }
}
