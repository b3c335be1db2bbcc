//! Who reads and writes what, through every kind of operand.

use domore::text::read;
use domore::xref::CrossReference;

const TEXT: &str = r#"PLC DM-SIM
#BEGIN MEM_CONFIG
	PID_0	PID		0
#END
$PRGRM Batch

STR X0
TMR T0 5000

STR Start
STRGE CT0.Acc N10
ANDSTR
MATH D1 "N[D80 - 1] + AVGR(R5, 3) * 2"

STR C5
RSTR C0 C10

STR T0.Done
COPY 0x1 "4 0x0 D0 D10 4 0x0 V0 N0 N3"

STR C40
MOVE V84:SD C32:UW

STR C1
INIT "3 N20 N25 -1"

STR C1
FANCY D0 "x D5"

STR C1
JMP Batch.S1

STR C1
MEMCOPY D0 D2 0x20000 3

STRE PID_0.Mode 1
OUT Y0

$PGMEND Batch
#BEGIN ELEMENT_DOC
"X9","FLAGS =","Start","",""
#END
"#;

/// Rung, role and text of all accesses that touch an element.
fn touching(element: &str) -> Vec<String> {
    let project = read(TEXT).expect("readable").project;
    let xref = CrossReference::build(&project).expect("memory fits");
    let area = xref.area(element).expect("an element");
    let role = |role: Option<domore::instruction::Role>| role.map_or("?", domore::instruction::Role::as_str);
    let line = |a: &domore::xref::Access| {
        format!("{} {}{} {}", a.rung, if a.may { "may " } else { "" }, role(a.role), a.written)
    };
    xref.touching(&area).into_iter().map(line).collect()
}

#[test]
fn structures_own_their_members() {
    assert_eq!(touching("T0"), ["1 own T0", "4 read T0.Done"]);
    assert_eq!(touching("T0.Done"), ["1 own T0", "4 read T0.Done"]);
    assert_eq!(touching("T0.Acc"), ["1 own T0"]);
    assert_eq!(touching("CT0"), ["2 read CT0.Acc"]);
}

#[test]
fn nicknames_and_elements_are_one() {
    assert_eq!(touching("X9"), ["2 read Start"]);
    assert_eq!(touching("Start"), ["2 read Start"]);
}

#[test]
fn ranges_casts_and_copies_reach_what_is_inside() {
    assert_eq!(touching("C5"), ["3 read C5", "3 reset C0"]);
    assert_eq!(touching("C11"), [""; 0]);
    assert_eq!(touching("C47"), ["5 write C32:UW"]);
    assert_eq!(touching("V85"), ["4 may read V0", "5 read V84:SD"]);
    assert_eq!(touching("D3"), ["4 read D0", "9 write D2"]);
    assert_eq!(touching("D13"), ["4 write D10"]);
    assert_eq!(touching("N24"), ["2 may read N[D80 - 1]", "4 may write N0", "6 write N20"]);
    assert_eq!(touching("R7"), ["2 may read R5"]);
    assert_eq!(touching("R4"), [""; 0]);
}

#[test]
fn indices_counts_stages_and_unknown_instructions_count() {
    assert_eq!(touching("D80"), ["2 read D80"]);
    assert_eq!(touching("N3"), ["2 may read N[D80 - 1]", "4 may write N0", "4 read N3"]);
    assert_eq!(touching("Batch.S1"), ["8 refer Batch.S1"]);
    assert_eq!(touching("D0"), ["4 read D0", "7 ? D0", "9 read D0"]);
    assert_eq!(touching("PID_0.Mode"), ["10 read PID_0.Mode"]);
    let project = read(TEXT).expect("readable").project;
    let xref = CrossReference::build(&project).expect("memory fits");
    let unresolved: Vec<_> = xref.unresolved().iter().map(|it| (it.rung, it.operand.as_str())).collect();
    assert_eq!(unresolved, [(7, "\"x D5\"")]);
}

#[test]
fn every_element_lists_what_touches_it() {
    let project = read(TEXT).expect("readable").project;
    let xref = CrossReference::build(&project).expect("memory fits");
    for element in xref.elements() {
        let listed = xref.of_element(element);
        let area = xref.area(element).expect("an element");
        assert_eq!(listed, xref.touching(&area), "{element}");
    }
}
