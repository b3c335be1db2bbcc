//! Rungs of Do-more text as a person sees them.

use domore::documentation::Documentation;
use domore::text::read;
use render::Style;

const TEXT: &str = r#"PLC DM-SIM
$PRGRM Batch

#BEGIN COMMENT
"seal-in with two start buttons"
"and a key"
#END

STR X0
OR X1
OR C0
ANDN X2
OUT C0
OUT Y0

STR C0
TMR T0 5000

STR X3
STR X4
OR ST0
CNT CT0 N10

STR X3
ANDPD C7
STR ST2
STR X4
ORND X5
STRLT N1 N2
ORSTR
UDC CT1 10 DST511

STR C0
STR T0.Done
STRGE CT0.Acc 5
ORSTR
ANDSTR
MOVE N11 N12
MATH N13 "N12 * 2 + 1"

#BEGIN FMT_COMMENT
"<B>if</B> / else<br>100%25"
#END

STR C1
MOVE 1 N20
NOT
MOVE 2 N20

STR C1
DUPBOOL
ANDE D0 0
SET C2
POPBOOL
ANDNE D0 0
RST C2

STR C1
STR C3
FANCYBOX D0 "x ""y"""

STR ST1
CALL Rate 0x0 DST511 "3 D3 D4 1 N0 N1 5" "3"

STR C1
OUT Y5
OR C2
OUT Y6

SG Batch.S0

JMP Batch.S1

NOP

$PGMEND Batch
#BEGIN ELEMENT_DOC
"X0","FLAGS =","Start","","start button","panel A"
"T0","FLAGS =","RunDelay","","delay after start"
"CT0","FLAGS =","Boxes","","boxes on the belt"
"N10","FLAGS =","BatchSize","",""
#END
"#;

#[test]
fn rungs_of_all_forms() {
    let reading = read(TEXT).expect("readable");
    let documentation = Documentation::new(&reading.project);
    let mut out = Vec::new();
    for block in reading.project.code_blocks() {
        render::domore::code_block(&mut out, block, None, &documentation, &Style::default())
            .expect("a vector takes all");
    }
    insta::assert_snapshot!(String::from_utf8(out).expect("text"));
}

#[test]
fn narrow_and_ascii() {
    let reading = read(TEXT).expect("readable");
    let documentation = Documentation::new(&reading.project);
    let style = Style { width: 60, ascii: true, comments: false, descriptions: false, ..Style::default() };
    let block = reading.project.code_block("Batch").expect("block");
    let text: String = (3..5).map(|index| render::domore::rung(block, index, &documentation, &style)).collect();
    insta::assert_snapshot!(text);
}

/// The sign of an instruction can be wider than its operand.
#[test]
fn every_instruction_is_drawn_over_a_short_operand() {
    for entry in domore::instruction::TABLE {
        let operands = "\tA".repeat(entry.operands.len().max(1));
        let text = format!("PLC DM-SIM\n$PRGRM $Main\n\nSTR C0\n{}{operands}\n\n$PGMEND $Main\n", entry.mnemonic);
        let reading = read(&text).expect("readable");
        let documentation = Documentation::new(&reading.project);
        let block = reading.project.code_block("$Main").expect("block");
        let drawn: String = (0..block.rungs.len())
            .map(|index| render::domore::rung(block, index, &documentation, &Style::default()))
            .collect();
        assert!(drawn.contains('A'), "{}: {drawn}", entry.mnemonic);
    }
}
