//! Rung text: what the notation means, what is refused with which words, and that it settles.

use convert::slc::rung::{
    MAX_BRANCH_DEPTH, not_in_text, parse_rung, parse_rungs, rung_text, rung_text_for, unread_rung, unread_text,
};
use ladder::{Branch, Element, Family, Instruction, MessageSetup, Mnemonic, Operand, Rung, Series};

/// The text is written the way it is, and reads as the instructions given.
#[track_caller]
fn settled(text: &str) -> Rung {
    becomes(text, text)
}

/// The text reads, is written as `settled`, and that reads back as the same rung.
#[track_caller]
fn becomes(text: &str, settled: &str) -> Rung {
    let rung = parse_rung(text, None).unwrap_or_else(|error| panic!("{text}: {error}"));
    let written = rung_text(&rung);
    assert_eq!(written, settled);
    let again = parse_rung(&written, None).unwrap_or_else(|error| panic!("{written}: {error}"));
    assert!(again.same_logic(&rung), "{again:?}\n{rung:?}");
    rung
}

fn instruction(rung: &Rung, index: usize) -> &Instruction {
    rung.instructions().nth(index).expect("as many instructions")
}

#[test]
fn the_notation_is_the_vendors() {
    settled("XIC B3:0/0 BST OTE B3:0/1 NXB TON T4:0 0.01 100 0 BND");
    settled("END");
    settled("BST XIC I:0.0/0 NXB BND OTE O:2.0/0");
    settled("BST BST XIC B3:0/0 NXB XIC B3:0/1 BND NXB XIC B3:0/2 BND OTE B3:0/3");
    settled("SQO #N7:0 00FFh O:2.0 R6:0 4 0");
    settled("MVM N7:0 0F0Fh N7:1");
    settled("COP #N7:0 #N10:[N7:1] 5");
    settled("XIC N[N7:4]:21/0 MOV N[N7:4]:[N7:3] T4:[C5:1.ACC].PRE");
    settled("HSL HSC0 N7:0 N7:1 N7:2 N7:3");
    settled("CTU C5:0 10 0 CTD C5:0 10 0 RES C5:0");
    settled("LIM -5 N7:0 1.5 OTE B3:0/0");
}

#[test]
fn people_write_short_forms() {
    becomes("SOR xic i:1/3 ote b3/17 EOR ", "XIC I:1.0/3 OTE B3:1/1");
    becomes("  SOR  XIC\tB3:0/0 \r\n OTE B3:0/1 EOR", "XIC B3:0/0 OTE B3:0/1");
    becomes("MVM N7:0 0xFF N7:1", "MVM N7:0 0xFF N7:1");
    becomes("MVM N7:0 0X00FF N7:1", "MVM N7:0 0X00FF N7:1");
    becomes("", "SOR EOR");
    becomes("SOR EOR", "SOR EOR");
    becomes("BST BND", "BST BND");
}

#[test]
fn subroutines_and_labels() {
    let rung = becomes("JSR U:4", "JSR 4");
    assert_eq!(instruction(&rung, 0).operands, [Operand::ProgramFile(4)]);
    assert!(parse_rung("JSR 4", None).expect("plain number").same_logic(&rung));
    let rung = settled("LBL Q2:1 XIC B3:0/0 JMP Q2:7");
    assert_eq!(instruction(&rung, 0).operands, [Operand::Label { file: 2, number: 1 }]);
    let rung = becomes("LBL 1 JMP 1", "LBL Q0:1 JMP Q0:1");
    assert_eq!(instruction(&rung, 1).operands, [Operand::Label { file: 0, number: 1 }]);
}

#[test]
fn one_shots_differ_between_families() {
    let slc = "XIC B3:0/0 OSR B3:0/1 OTE B3:0/2";
    let micrologix = "XIC B3:0/0 OSR B3:0/1 B3:0/2";
    settled(slc);
    settled(micrologix);
    for family in [Family::SlcFixed, Family::Slc503, Family::MicroLogix1000] {
        assert!(parse_rung(slc, Some(family)).is_ok(), "{family}");
        assert!(parse_rung(micrologix, Some(family)).is_err(), "{family}");
    }
    for family in [Family::MicroLogix1100, Family::MicroLogix1200, Family::MicroLogix1400, Family::MicroLogix1500] {
        let error = parse_rung(slc, Some(family)).expect_err("one operand");
        assert!(error.to_string().contains("Output Bit of OSR"), "{error}");
        assert!(parse_rung(micrologix, Some(family)).is_ok(), "{family}");
    }
    // A rung in the form of another family is still carried, and reads back under any family.
    let rung = parse_rung(slc, None).expect("rung");
    let text = rung_text_for(&rung, Some(Family::MicroLogix1400));
    assert_eq!(text, "XIC B3:0/0 OSR( B3:0/1 ) OTE B3:0/2");
    assert!(parse_rung(&text, Some(Family::MicroLogix1400)).expect("rung").same_logic(&rung));
}

#[test]
fn placeholders_are_left_out_and_come_back() {
    let rung = settled("PID PD9:0 N7:0 N7:1");
    let operands = &instruction(&rung, 0).operands;
    assert_eq!(operands.len(), 4);
    assert_eq!(operands[3], Operand::Empty);
    let rung = settled("XIC B3:0/0 MSG MG9:0 N7:0");
    assert_eq!(instruction(&rung, 1).operands.len(), 3);
    assert_eq!(instruction(&rung, 1).operands[1], Operand::Empty);
    let rung = settled("MSG MG9:0 0 N64:0 RIX80:0 OTE B3:0/0");
    assert_eq!(instruction(&rung, 0).operands.len(), 5);
}

#[test]
fn message_settings_are_not_in_the_text() {
    let mut rung = parse_rung("MSG MG9:0 N7:0", None).expect("rung");
    assert!(not_in_text(&rung).is_empty());
    if let Some(Element::Instruction(message)) = rung.series.first_mut() {
        message.message = Some(Box::new(MessageSetup { settings: vec![("Channel".into(), "0".into())] }));
    }
    assert_eq!(not_in_text(&rung), ["the settings behind the setup screen of MSG MG9:0"]);
}

#[test]
fn a_message_in_another_notation_keeps_its_words() {
    // What RSLogix writes for MSG is not known; eight words fit no form.
    becomes(
        "XIC B3:0/0 MSG PEER 500CPU N9:0 14 N7:0 1 N7:5 10 OTE B3:0/1",
        "XIC B3:0/0 MSG( PEER 500CPU N9:0 14 N7:0 1 N7:5 10 ) OTE B3:0/1",
    );
}

#[test]
fn expressions_end_where_they_cannot_go_on() {
    let rung = settled("CPT N7:0 ( N7:1 + 5 ) * 2 OTE B3:0/0");
    assert_eq!(rung.instructions().count(), 2);
    becomes("CPT N7:0 (N7:1+5) OTE B3:0/0".replace('+', " + ").as_str(), "CPT N7:0 ( N7:1 + 5 ) OTE B3:0/0");
    becomes("CPT F8:0 SIN(F8:1) ** 2", "CPT F8:0 SIN ( F8:1 ) ** 2");
    for (text, instructions) in [
        ("CPT N7:0 N7:1 AND N7:2", 1),
        ("CPT N7:0 N7:1 + 1 AND N7:2 N7:3 N7:4", 2),
        ("CPT N7:0 N7:1 OR N7:2 NOT N7:3 N7:4", 2),
        ("CPT N7:0 N7:1 AND N7:2 OR N7:3 N7:4 N7:5 OTE B3:0/0", 3),
        ("CPT N7:0 N7:1 XOR N7:2 N7:3 N7:4 AND N7:2 N7:3 N7:4 NEG N7:0 N7:1", 4),
        ("CPT N7:0 N7:1 AND \"a b\" N7:3 N7:4", 2),
        ("CPT N7:0 N7:1 AND N7:3 \"a b\" N7:4", 2),
        ("CPT N7:0 N7:1 - 1 SQR N7:0 N7:1 OR N7:0 N7:1 N7:2", 3),
        ("BST CPT N7:0 N7:1 NXB AND N7:0 N7:1 N7:2 BND", 2),
    ] {
        assert_eq!(settled(text).instructions().count(), instructions, "{text}");
    }
}

#[test]
fn what_the_notation_cannot_say_is_quoted() {
    let rung = Rung::new(vec![
        Element::Instruction(Instruction::new(Mnemonic::Unknown(0x4D), vec![Operand::parse("N7:0"), Operand::Empty])),
        Element::Instruction(Instruction::new(Mnemonic::Unknown(0x1234), vec![])),
        Element::Instruction(Instruction::new(Mnemonic::named("XIC"), vec![Operand::Unset])),
        Element::Instruction(Instruction::new(Mnemonic::named("XIC"), vec![Operand::parse("a \"b\"\r\n")])),
        Element::Instruction(Instruction::new(Mnemonic::named("XIC"), vec![Operand::parse("MOV")])),
        Element::Instruction(Instruction::new(Mnemonic::named("OTE"), vec![Operand::Empty])),
        Element::Instruction(Instruction::new(Mnemonic::named("OTE"), vec![])),
    ]);
    let text = rung_text(&rung);
    assert_eq!(
        text,
        "op0x4D( N7:0 \"\" ) op0x1234( ) XIC ? XIC \"a \"\"b\"\"\\u{D}\\u{A}\" XIC \"MOV\" OTE \"\" OTE( )"
    );
    assert!(parse_rung(&text, None).expect("text").same_logic(&rung));
}

#[test]
fn a_rung_that_could_not_be_read_keeps_its_text() {
    let rung = unread_rung("XIC B3:0/0 XYZ 5");
    assert_eq!(unread_text(&rung), Some("XIC B3:0/0 XYZ 5"));
    assert_eq!(rung_text(&rung), "XIC B3:0/0 XYZ 5");
}

#[test]
fn errors_name_place_and_remedy() {
    for (text, line, column, words) in [
        ("XCI B3:0/0", 1, 1, "expected an instruction, found `XCI`; did you mean XIC?"),
        (
            "XIC B3:0/0\n  TON T4:0 0.01 100 OTE B3:0/0",
            2,
            21,
            "expected Accum of TON, which has the operands Timer, Time Base, Preset, Accum, found `OTE`",
        ),
        ("XIC", 1, 4, "expected Bit of XIC, which has the operand Bit, found the end of the text"),
        ("XIC B3:0/0 B3:0/1", 1, 12, "expected an instruction after XIC, which has the operand Bit, found `B3:0/1`"),
        ("MCR B3:0/1", 1, 5, "expected an instruction after MCR, which has no operands"),
        ("BST XIC B3:0/0", 1, 15, "expected BND"),
        ("SOR XIC B3:0/0", 1, 15, "expected EOR"),
        ("BST XIC B3:0/0 EOR", 1, 16, "expected BND before the end of the rung"),
        ("XIC B3:0/0 BND", 1, 12, "expected a BST before BND"),
        ("NXB", 1, 1, "expected a BST before NXB"),
        ("XIC B3:0/0 EOR OTE B3:0/1", 1, 16, "expected the end of the rung"),
        ("XIC B3:0/0 SOR", 1, 12, "expected EOR before the next rung"),
        ("op0x4D N7:0", 1, 1, "expected `op0x4D(`, the operands, `)`"),
        ("op0x4D( N7:0", 1, 13, "expected an operand or `)`"),
        ("CPT N7:0 N7:1 +", 1, 16, "in the expression of CPT"),
        ("CPT N7:0 ( N7:1", 1, 16, "expected ) in the expression of CPT"),
        ("CPT N7:0", 1, 9, "expected Expression of CPT"),
        ("\"XIC\" B3:0/0", 1, 1, "expected an instruction"),
    ] {
        let error = parse_rung(text, None).expect_err(text);
        assert_eq!((error.line, error.column), (line, column), "{text}: {error}");
        assert!(error.to_string().contains(words), "{text}: {error}");
    }
}

#[test]
fn nesting_is_bounded() {
    let nested = |depth: usize| format!("{}XIC B3:0/0{}", "BST ".repeat(depth), " NXB BND".repeat(depth));
    settled(&nested(MAX_BRANCH_DEPTH));
    let error = parse_rung(&nested(MAX_BRANCH_DEPTH + 1), None).expect_err("too deep");
    assert!(error.to_string().contains("nested at most 64 deep"), "{error}");
    assert!(parse_rung(&"BST ".repeat(100_000), None).is_err());
    assert!(parse_rung(&nested(100_000), None).is_err());
    // Written from the model there is no limit: a damaged project may nest deeper.
    let mut series = Series::new();
    for _ in 0..1000 {
        series = vec![Element::Branch(Branch { legs: vec![series, Series::new()] })];
    }
    assert_eq!(rung_text(&Rung::new(series)).len(), 1000 * "BST NXB BND ".len() - 1);
}

#[test]
fn lists_of_rungs() {
    let text = "XIC B3:0/0 OTE B3:0/1\n\n% a comment %\r\nSOR XIC B3:0/2\n OTE B3:0/3 EOR \nSOR EOR SOR TND EOR\n";
    let rungs = parse_rungs(text, None).expect("rungs");
    let texts: Vec<String> = rungs.iter().map(rung_text).collect();
    assert_eq!(texts, ["XIC B3:0/0 OTE B3:0/1", "XIC B3:0/2 OTE B3:0/3", "SOR EOR", "TND"]);
    let errors = parse_rungs("XIC\nOTE B3:0/0\nSOR XIC B3:0/0\nFOO EOR", None).expect_err("two errors");
    let places: Vec<_> = errors.iter().map(|error| (error.line, error.column)).collect();
    assert_eq!(places, [(1, 4), (4, 1)]);
}
