//! What single rungs become, as a person reads them in both languages. That they also do the same is the
//! business of the tests that run both.

mod migrate_support;

use convert::migrate::{Options, Verdict, migrate};
use ladder::Family;
use migrate_support::image;

/// The instructions a rung becomes, separated by `; `.
#[track_caller]
fn becomes(family: Family, slc: &str, domore: &str) {
    let image = image(family, &[(2, slc)]);
    let migration = migrate(&image, &[], &Options::default()).expect("it migrates");
    let rung = migration.rungs.first().expect("a rung");
    assert_eq!(rung.verdict, Verdict::Exact, "{slc}: {:?}", rung.notes);
    assert_eq!(rung.code.join("; "), domore, "{slc}");
}

// B3:0 lies in C0 to C15, N7:0 in N0; T4:0 in N24 to N26, C5:0 in N42 to N44; I:0 in X0, O:0 in Y0.
const SLC: Family = Family::Slc503;
const MICRO: Family = Family::MicroLogix1400;

#[test]
fn contacts_coils_and_branches() {
    becomes(SLC, "XIC I:0/0 XIO I:0/1 OTE O:0/3", "STR X0; ANDN X1; OUT Y3");
    becomes(SLC, "OTL B3:0/2", "STR ST1; SET C2");
    becomes(SLC, "XIC B3:1/0 OTU N7:1/15", "STR C16; RST N1:15");
    becomes(SLC, "BST XIC I:0/0 NXB XIC B3:0/0 BND XIO I:0/1 OTE B3:0/0", "STR X0; OR C0; ANDN X1; OUT C0");
    becomes(
        SLC,
        "XIC I:0/0 BST XIC I:0/1 XIC I:0/2 NXB XIO I:0/3 XIO I:0/4 BND OTE O:0/0",
        "STR X0; STR X1; AND X2; STRN X3; ANDN X4; ORSTR; ANDSTR; OUT Y0",
    );
    becomes(
        SLC,
        "XIC I:0/0 BST OTE O:0/0 NXB XIC I:0/1 OTE O:0/1 NXB OTL O:0/2 BND",
        "STR X0; OUT Y0; DUPBOOL; AND X1; OUT Y1; POPBOOL; SET Y2",
    );
    // A leg that is a wire makes the others beside it pointless.
    becomes(SLC, "BST XIC I:0/0 NXB BND OTE O:0/0", "STR ST1; OUT Y0");
}

#[test]
fn one_shots() {
    becomes(SLC, "XIC I:0/0 OSR B3:0/5 OTL O:0/0", "STR X0; NOT; RST C5; NOT; ANDN C5; SET C5; SET Y0");
    becomes(MICRO, "XIC I:0/0 ONS B3:0/5 OTL O:0/0", "STR X0; NOT; RST C5; NOT; ANDN C5; SET C5; SET Y0");
    becomes(MICRO, "XIC I:0/0 OSR B3:0/5 B3:0/6", "STR X0; NOT; RST C5; NOT; ANDN C5; SET C5; SET C6; NOT; RST C6");
    becomes(MICRO, "XIC I:0/0 OSF B3:0/5 B3:0/6", "STR X0; SET C5; NOT; AND C5; RST C5; SET C6; NOT; RST C6");
}

#[test]
fn timers() {
    let preset = |base: &str| format!("XIC I:0/0 TON T4:0 {base} 500 0");
    let mut image = image(SLC, &[(2, &preset("0.01"))]);
    let timers = image.data_files.iter_mut().find(|file| file.file_type == ladder::FileType::T).expect("T4");
    if let Some(word) = timers.words.get_mut(1) {
        *word = 500;
    }
    let migration = migrate(&image, &[], &Options::default()).expect("it migrates");
    let rung = migration.rungs.first().expect("a rung");
    assert_eq!(
        rung.code,
        [
            "STR X0",
            "TMR T0 5000",
            "SET N24:15",
            "MATH N26 \"IF(T0.Acc / 10 > N25, N25, T0.Acc / 10)\"",
            "DUPBOOL",
            "AND T0.Done",
            "SET N24:13",
            "NOT",
            "RST N24:13",
            "NOT",
            "POPBOOL",
            "DUPBOOL",
            "ANDN T0.Done",
            "SET N24:14",
            "NOT",
            "RST N24:14",
            "NOT",
            "POPBOOL",
            "NOT",
            "RST N24:15",
            "MOVE 0 N26",
        ]
    );
    becomes(
        SLC,
        "XIC I:0/0 RTO T4:1 1.0 5 0",
        "STR X0; DUPBOOL; AND N27:15; ANDN N27:13; ANDLT N29 N28; MATH D1 \"D1 + D0\"; \
         MATH N29 \"IF(N29 + D1 / 1000 > N28, N28, N29 + D1 / 1000)\"; MATH D1 \"IF(N29 < N28, D1 % 1000, 0)\"; POPBOOL; \
         DUPBOOL; ANDGE N29 N28; SET N27:13; POPBOOL; DUPBOOL; ANDN N27:13; SET N27:14; NOT; RST N27:14; NOT; POPBOOL; \
         SET N27:15; NOT; RST N27:15",
    );
    becomes(SLC, "XIC I:0/1 RES T4:1", "STR X1; RST N27:15; RST N27:14; RST N27:13; MOVE 0 N29; MOVE 0 D0");
}

#[test]
fn counters() {
    becomes(
        MICRO,
        "XIC I:0/0 CTU C5:0 5 0",
        "STR X0; DUPBOOL; ANDN N42:15; DUPBOOL; ANDE N44 32767; SET N42:12; POPBOOL; \
         MATH N44 \"IF(N44 == 32767, -32768, N44 + 1)\"; POPBOOL; SET N42:15; NOT; RST N42:15; NOT; \
         OR ST1; ANDGE N44 N43; SET N42:13; NOT; RST N42:13",
    );
    becomes(SLC, "RES C5:0", "STR ST1; RST N42:15; RST N42:14; RST N42:13; RST N42:12; RST N42:11; MOVE 0 N44");
}

/// The rungs of the result by code block.
fn blocks(family: Family, files: &[(u16, &str)]) -> Vec<(String, Vec<String>)> {
    let image = image(family, files);
    let migration = migrate(&image, &[], &Options::default()).expect("it migrates");
    let text = |rung: &domore::Rung| rung.instructions.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
    migration.project.code_blocks().map(|block| (block.name.clone(), block.rungs.iter().map(text).collect())).collect()
}

fn expected(blocks: &[(&str, &[&str])]) -> Vec<(String, Vec<String>)> {
    let owned = |rungs: &[&str]| rungs.iter().map(|rung| (*rung).to_owned()).collect();
    blocks.iter().map(|(name, rungs)| ((*name).to_owned(), owned(rungs))).collect()
}

#[test]
fn a_file_called_once_and_always_stands_in_place() {
    let found = blocks(SLC, &[(2, "XIC I:0/0 OTL B3:0/0\nJSR 3\nXIC B3:0/0 OTL B3:0/1"), (3, "XIC I:0/1 OTU B3:0/0")]);
    let main: &[&str] = &["STR X0; SET C0", "NOP", "STR X1; RST C0", "STR C0; SET C1"];
    assert_eq!(found, expected(&[("$Main", main)]));
}

#[test]
fn other_calls_are_calls() {
    let found = blocks(SLC, &[(2, "XIC I:0/0 JSR 3"), (3, "SBR XIC I:0/1 OTU B3:0/0\nRET")]);
    let call = "STR X0; CALL SLC3 0x0 DST511 \"3\" \"3\"";
    let sub: &[&str] = &["STR X1; RST C0", "NOP", "RET"];
    assert_eq!(found, expected(&[("$Main", &[call]), ("SLC3", sub)]));
}

#[test]
fn what_a_jump_skips_is_called_unless_it_jumps() {
    let found = blocks(SLC, &[(2, "XIC I:0/0 JMP 1\nXIC I:0/1 OTL B3:0/0\nLBL 1 XIC I:0/2 OTL B3:0/1")]);
    let main: &[&str] = &[
        "STR ST1; MOVE 0 D0",
        "STR X0; MOVE 2 D0",
        "STRLE D0 1; CALL SLC2from1 0x0 DST511 \"3\" \"3\"",
        "STR X2; SET C1",
    ];
    assert_eq!(found, expected(&[("$Main", main), ("SLC2from1", &["STR X1; SET C0", "RET"])]));
}

#[test]
fn a_jump_back_repeats() {
    let found = blocks(SLC, &[(2, "LBL 1 XIC I:0/0 OTL B3:0/0\nXIO B3:0/0 JMP 1\nXIC I:0/2 OTL B3:0/1")]);
    let main: &[&str] =
        &["REPEAT", "STR ST1; SET C256", "STR X0; SET C0", "STRN C0; RST C256", "UNTIL C256", "STR X2; SET C1"];
    assert_eq!(found, expected(&[("$Main", main)]));
}

#[test]
fn a_zone_is_in_series_with_its_rungs() {
    let found = blocks(SLC, &[(2, "XIC I:0/0 MCR\nXIC I:0/1 OTL B3:0/0\nMCR\nXIC I:0/2 OTL B3:0/1")]);
    let main: &[&str] = &["STR X0; OUT C256", "STR C256; AND X1; SET C0", "NOP", "STR X2; SET C1"];
    assert_eq!(found, expected(&[("$Main", main)]));
}

#[test]
fn entering_run_is_prepared_before_the_first_rung() {
    let found = blocks(SLC, &[(2, "XIC I:0/0 BST OTE B3:0/1 NXB OTE B3:0/2 NXB CTU C5:0 3 0 NXB OTE N7:1/4 BND")]);
    let first = found.first().and_then(|(_, rungs)| rungs.first()).cloned();
    assert_eq!(first.as_deref(), Some("STR ST0; RSTR C1 C2; RST N1:4; SET N42:15"));
}

#[test]
fn what_has_no_counterpart_stands_as_a_note() {
    let image = image(SLC, &[(2, "XIC I:0/0 SUS 5\nXIC I:0/1 OTL B3:0/0")]);
    let migration = migrate(&image, &[], &Options::default()).expect("it migrates");
    assert_eq!(migration.count(Verdict::Person), 1);
    assert_eq!(migration.rungs.len(), 2, "no rung is lost");
    let text = domore::text::write(&migration.project);
    assert!(text.contains("SLC 2:0  XIC I:0.0/0 SUS 5") && text.contains("person: NO-EQUAL"), "{text}");
}
