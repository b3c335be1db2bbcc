//! Input that is not what it should be: a place, nothing lost, no panic.

use domore::Problem;
use domore::text::{Error, MAX_LINES, MAX_TEXT, is_domore, read, write};

/// Line, and whether the finding is the expected one, for each finding.
fn findings(text: &str) -> Vec<(u32, Problem)> {
    let reading = read(text).expect("readable");
    assert_eq!(write(&reading.project), text, "nothing is lost");
    reading.diagnostics.into_iter().map(|found| (found.line, found.problem)).collect()
}

#[test]
fn unbalanced_rungs_have_a_place() {
    let found = findings(
        "$PRGRM A\n\nSTR X0\nSTR X1\nOUT Y0\n\nSTR X0\nANDSTR\nOUT Y1\n\nSTR X0\nAND X1\n\nOUT Y2\n\n$PGMEND A\n",
    );
    assert_eq!(
        found,
        [
            (5, Problem::StackLeft(1)),
            (8, Problem::StackUnderflow { mnemonic: "ANDSTR".into(), needs: 2, found: 1 }),
            (12, Problem::NoOutput),
            (14, Problem::NoContact("OUT".into())),
        ]
    );
}

#[test]
fn a_stage_is_the_condition_of_what_follows_it() {
    assert_eq!(findings("$PRGRM A\n\nSG A.S0\n\nOUT Y0\n\nSTR X0\nJMP A.S1\n\n$PGMEND A\n"), []);
}

#[test]
fn boxes_with_several_legs_want_them_all() {
    let found = findings("$PRGRM A\n\nSTR X0\nCNT CT0 5\n\nSTR X0\nSTR X1\nCNT CT0 5\nOUT Y0\n\n$PGMEND A\n");
    assert_eq!(
        found,
        [
            (4, Problem::StackUnderflow { mnemonic: "CNT".into(), needs: 2, found: 1 }),
            (9, Problem::BehindBox("OUT".into())),
        ]
    );
}

#[test]
fn operands_are_counted() {
    let found = findings("$PRGRM A\n\nSTR X0 X1\nTMR T0\n\nSTR X0\nFOR D0 1 5\nOUT Y0\n\n$PGMEND A\n");
    assert_eq!(
        found,
        [
            (3, Problem::OperandCount { mnemonic: "STR".into(), expected: (1, 1), found: 2 }),
            (4, Problem::OperandCount { mnemonic: "TMR".into(), expected: (2, 2), found: 1 }),
            (7, Problem::NotAlone("FOR".into())),
            (8, Problem::NoContact("OUT".into())),
        ]
    );
}

#[test]
fn unknown_sections_blocks_and_lines_are_carried() {
    let found =
        findings("garbage !\n#BEGIN ODD\nx\n#END\n#END\n$ODD B\n\nNOP\n\n$ODDEND B\n$PGMEND C\n$PRGRM D\n\nNOP\n");
    assert_eq!(
        found,
        [
            (1, Problem::UnknownLine),
            (5, Problem::StrayEnd),
            (6, Problem::UnknownCodeKind("$ODD".into())),
            (11, Problem::StrayCodeEnd("$PGMEND C".into())),
            (12, Problem::OpenCodeBlock { name: "D".into(), expected: "$PGMEND D".into() }),
        ]
    );
}

#[test]
fn lines_of_sections_and_quotes_are_checked() {
    let text = "#BEGIN DEVICE\nIntSerial, 1\n#END\n#BEGIN MEM_CONFIG\n\tX\tBIT\n#END\n#BEGIN ELEMENT_DOC\n\"X0\",\"a\n#END\n\
                $PRGRM A\n\n#BEGIN COMMENT\nno quotes\n#END\n\nSTR X0\nMATH N0 \"1 + 2\n\n$PGMEND A\n#BEGIN SYS_CONFIG\nff\n";
    let kinds: Vec<(u32, u32, String)> = read(text)
        .expect("readable")
        .diagnostics
        .into_iter()
        .map(|d| (d.line, d.column, d.problem.to_string()))
        .collect();
    assert_eq!(write(&read(text).expect("readable").project), text);
    let places: Vec<(u32, u32)> = kinds.iter().map(|(line, column, _)| (*line, *column)).collect();
    assert_eq!(places, [(2, 1), (5, 2), (8, 1), (13, 1), (17, 9), (20, 1)], "{kinds:?}");
}

#[test]
fn no_text_and_too_much_are_refused() {
    assert_eq!(read("PLC X\n  \0").unwrap_err(), Error::NotText { line: 2, column: 3, found: '\0' });
    assert_eq!(read("PLC X\r\nSTR\r").unwrap_err(), Error::NotText { line: 2, column: 4, found: '\r' });
    assert_eq!(read(&" ".repeat(MAX_TEXT + 1)).unwrap_err(), Error::TooLarge { unit: "bytes", limit: MAX_TEXT });
    assert_eq!(read(&"\n".repeat(MAX_LINES)).unwrap_err(), Error::TooLarge { unit: "lines", limit: MAX_LINES });
}

#[test]
fn only_designer_texts_are_taken_for_one() {
    for text in [
        "PLC BX-DM1E\n",
        "// x\n\n#BEGIN MEM_CONFIG\n",
        "$PRGRM $Main\n",
        "STR X0\nOUT Y0\n",
        "#BEGIN COMMENT\n\"x\"\n#END\n",
    ] {
        assert!(is_domore(text), "{text}");
    }
    for text in
        ["", "hello world\n", "SOR XIC B3:0/0 OTE B3:0/1 EOR\n", "name = \"x\"\n", "{\"schema\":1}", "OUT of order\n"]
    {
        assert!(!is_domore(text), "{text}");
    }
}

#[test]
fn rungs_without_blank_lines_are_told_apart() {
    let text = "$PRGRM A\nSTR X0\nOUT Y0\nSTR X1\nOUT Y1\nSTR X2\nMOVE 1 N0\nSTR X3\nANDSTR\nOUT Y3\nSG A.S1\nOUT Y4\n$PGMEND A\n";
    let project = read(text).expect("readable").project;
    let sizes: Vec<usize> =
        project.code_block("A").expect("block").rungs.iter().map(|rung| rung.instructions.len()).collect();
    // STR X3 cannot begin a rung: its ANDSTR needs what is before it.
    assert_eq!(sizes, [2, 2, 5, 1, 1]);
    assert_eq!(write(&project), text);
}

#[test]
fn large_input_costs_in_proportion() {
    let mut text = String::from("$PRGRM A\n");
    for number in 0..60_000 {
        text.push_str(&format!("\nSTR X{number}\nOUT Y{number}\n"));
    }
    text.push_str(&"STR X0\n".repeat(60_000));
    text.push_str(&"ORSTR\n".repeat(60_000));
    text.push_str("$PGMEND A\n");
    let reading = read(&text).expect("readable");
    assert_eq!(write(&reading.project), text);
}
