//! What single instructions on data become, as a person reads them in both languages. That they also do
//! the same is the business of the test that runs both.

mod migrate_support;

use convert::migrate::{Options, Verdict, migrate};
use ladder::{Family, FileType};
use migrate_support::image;

/// The rung and the instructions it becomes, separated by `; `.
#[track_caller]
fn becomes(verdict: Verdict, rung: &str, expected: &str) {
    let mut image = image(Family::Slc503, &[(2, rung)]);
    // Lengths come from the data table.
    let length = if rung.contains("BSL") { 16 } else { 4 };
    for file in image.data_files.iter_mut().filter(|file| file.file_type == FileType::R) {
        file.words[1] = length;
    }
    let migration = migrate(&image, &[], &Options::default()).expect("it migrates");
    let result = migration.rungs.first().expect("a rung");
    assert_eq!(result.verdict, verdict, "{rung}: {:?}", result.notes);
    assert_eq!(result.code.join("; "), expected, "{rung}");
}

// N7:0 lies in N0, T4:0 in N24, R6:0 in N54, S:5 in N71, F8:0 in R0; D0 and the like are scratches.

#[test]
fn compares() {
    becomes(Verdict::Exact, "XIC I:0/0 EQU N7:0 5 GRT N7:1 N7:2 OTE O:0/0", "STR X0; ANDE N0 5; ANDGT N1 N2; OUT Y0");
    becomes(Verdict::Exact, "LIM 5 N7:0 8 OTE O:0/0", "STRGE N0 5; ANDLE N0 8; OUT Y0");
    becomes(Verdict::Exact, "XIC I:0/0 LIM 8 N7:0 5 OTE O:0/0", "STR X0; STRGE N0 8; ORLE N0 5; ANDSTR; OUT Y0");
    becomes(
        Verdict::Exact,
        "LIM N7:0 N7:1 N7:2 OTE O:0/0",
        "STRGE N1 N0; ANDLE N1 N2; STRGT N0 N2; STRGE N1 N0; ORLE N1 N2; ANDSTR; ORSTR; OUT Y0",
    );
    becomes(Verdict::Exact, "GEQ N7:0 2.5 OTE O:0/0", "STRGE N0 3; OUT Y0");
    becomes(
        Verdict::Exact,
        "MEQ N7:0 00F0h N7:1 OTE O:0/0",
        r#"STR ST1; MATH D0 "N0 & 240"; MATH D1 "N1 & 240"; ANDE D0 D1; OUT Y0"#,
    );
}

#[test]
fn moves_and_bit_patterns() {
    becomes(Verdict::Exact, "XIC I:0/0 MOV N7:0 N7:1", "STR X0; MOVE N0 N1");
    becomes(Verdict::Exact, "MOV 500 T4:1.PRE", "STR ST1; MOVE 500 N28");
    becomes(Verdict::Exact, "MVM N7:0 00FFh N7:1", r#"STR ST1; MATH N1 "(N1 & (-256)) | (N0 & 255)""#);
    becomes(Verdict::Exact, "AND N7:0 255 N7:0", r#"STR ST1; MATH N0 "N0 & 255""#);
    becomes(Verdict::Exact, "XOR N7:0 7 N7:0", r#"STR ST1; MATH N0 "(N0 | 7) - (N0 & 7)""#);
    becomes(Verdict::Exact, "NOT N7:0 N7:1", r#"STR ST1; MATH N1 "-1 - N0""#);
}

#[test]
fn whole_numbers() {
    becomes(
        Verdict::Exact,
        "ADD N7:0 1 N7:0",
        r#"STR ST1; MATH D0 "N0 + 1"; MATH N0 "IF(D0 > 32767, 32767, D0)"; ANDNE D0 N0; SET N71:0"#,
    );
    becomes(
        Verdict::Exact,
        "SUB N7:0 N7:1 N7:2",
        r#"STR ST1; MATH D0 "N0 - N1"; MATH N2 "IF(D0 > 32767, 32767, IF(D0 < -32768, -32768, D0))"; ANDNE D0 N2; SET N71:0"#,
    );
    becomes(
        Verdict::Exact,
        "MUL N7:0 60 N7:1",
        r#"STR ST1; MATH D0 "N0 * 60"; MATH N1 "IF(D0 > 32767, 32767, IF(D0 < -32768, -32768, D0))"; ANDNE D0 N1; SET N71:0"#,
    );
    becomes(Verdict::Exact, "DIV N7:0 10 N7:1", r#"STR ST1; MATH N1 "IF(N0 < 0, -((5 - N0) / 10), (N0 + 5) / 10)""#);
    becomes(
        Verdict::Exact,
        "DIV N7:0 N7:1 N7:2",
        r#"STR ST1; MATH D0 "(ABS(N0) + ABS(N1) / 2) / IF(N1 == 0, 1, ABS(N1))"; MATH D1 "IF(N1 == 0, 32768, IF(N0 < 0, -IF(N1 < 0, -D0, D0), IF(N1 < 0, -D0, D0)))"; MATH N2 "IF(D1 > 32767, 32767, IF(D1 < -32768, -32768, D1))"; ANDNE D1 N2; SET N71:0"#,
    );
    becomes(
        Verdict::Exact,
        "ABS N7:0 N7:0",
        r#"STR ST1; MATH D0 "ABS(N0)"; MATH N0 "IF(D0 > 32767, 32767, D0)"; ANDNE D0 N0; SET N71:0"#,
    );
    becomes(
        Verdict::Exact,
        "SCP N7:0 0 16383 0 55 N7:1",
        r#"STR ST1; MATH N1 "IF(N0 * 55 < 0, -((8191 - N0 * 55) / 16383), (N0 * 55 + 8191) / 16383)""#,
    );
    becomes(
        Verdict::Exact,
        "CPT N7:0 N7:1 * ( N7:2 | 100 )",
        r#"STR ST1; MATH D2 "IF(N2 < 0, -((50 - N2) / 100), (N2 + 50) / 100)"; MATH D3 "N1 * D2"; MATH N0 "IF(D3 > 32767, 32767, IF(D3 < -32768, -32768, D3))"; ANDNE D3 N0; SET N71:0"#,
    );
}

#[test]
fn files_and_control_elements() {
    becomes(Verdict::Exact, "COP #N7:0 #N7:10 5", r#"STR ST1; COPY 0x0 "4 0x0 N0 N10 5""#);
    becomes(
        Verdict::Exact,
        "COP #N7:0 #N7:2 7",
        r#"STR ST1; COPY 0x0 "4 0x0 N0 N2 2"; COPY 0x0 "4 0x0 N0 N4 4"; MOVE N0 N8"#,
    );
    becomes(Verdict::Exact, "COP #N7:5 #N7:0 10", "STR ST1; MEMCOPY N5 N0 0x20000 10");
    becomes(Verdict::Exact, "FLL 0 #N7:0 20", r#"STR ST1; INIT "3 N0 N19 0""#);
    becomes(
        Verdict::Exact,
        "FLL N7:3 #N7:10 5",
        r#"STR ST1; MOVE N3 N10; MOVE N10 N11; COPY 0x0 "4 0x0 N10 N12 2"; MOVE N10 N14"#,
    );
    becomes(
        Verdict::Exact,
        "SWP #N7:0 1",
        r#"STR ST1; MATH D0 "(N0 & 255) * 256 + ((N0 & 65280) / 256)"; MATH N0 "((D0 + 32768) & 65535) - 32768""#,
    );
    becomes(
        Verdict::Exact,
        "XIC I:0/0 BSL #N7:0 R6:0 B3:0/0 16",
        r#"STR X0; DUPBOOL; ANDN N54:15; MATH D0 "IF(C0 == 0, 0, 1)"; MATH D1 "IF((N0 & 32768) == 0, 0, 1)"; MATH N0 "(N0 & 16383) * 2 + D0 - IF((N0 & 16384) == 0, 0, 32768)"; DUPBOOL; ANDNE D1 0; SET N54:10; POPBOOL; DUPBOOL; ANDE D1 0; RST N54:10; POPBOOL; SET N54:13; RST N54:11; POPBOOL; SET N54:15; NOT; RST N54:15; NOT; NOT; RST N54:13"#,
    );
    becomes(
        Verdict::Exact,
        "XIC I:0/0 SQO #N7:0 00FFh O:0.0 R6:0 4 0",
        r#"STR X0; DUPBOOL; ANDN N54:15; DUPBOOL; STRN ST0; ORNE N56 0; ANDSTR; MATH N56 "IF(N56 > 3, 1, N56 + 1)"; RST N54:13; RST N54:11; POPBOOL; POPBOOL; SET N54:15; NOT; RST N54:15; NOT; DUPBOOL; ANDE N56 4; SET N54:13; POPBOOL; MATH D0 "N[N56]"; MATH WY0 "(WY0 & (-256)) | (D0 & 255)""#,
    );
}

#[test]
fn floats() {
    becomes(Verdict::Condition, "ADD F8:0 0.5 F8:1", r#"STR ST1; MATH R1 "R0 + 0.5""#);
    becomes(
        Verdict::Condition,
        "MOV F8:0 N7:0",
        r#"STR ST1; MATH R6 "IF(R0 < 40000.0, IF(R0 < -40000.0, -40000.0, R0), 40000.0)"; MATH D0 "TRUNC(R6)"; MATH R6 "R6 - TOREAL(D0)"; MATH D0 "D0 + IF(ABS(R6) > 0.5, 1, IF(ABS(R6) == 0.5, ABS(D0) % 2, 0)) * IF(R6 < 0.0, -1, 1)"; MATH N0 "IF(D0 > 32767, 32767, IF(D0 < -32768, -32768, D0))"; ANDNE D0 N0; SET N71:0"#,
    );
    becomes(Verdict::Condition, "SCP N7:0 0.0 16383.0 0.0 20.0 F8:0", r#"STR ST1; MATH R0 "0.0012207776 * N0""#);
    becomes(
        Verdict::Condition,
        "DIV F8:0 F8:1 F8:2",
        r#"STR ST1; DUPBOOL; ANDE R1 0.0; SET C256; NOT; RST C256; NOT; POPBOOL; DUPBOOL; AND C256; SET N71:0; MATH R2 "IF(R0 < 0.0, -10.0, 10.0) * 100000000000000000000000000000000000000.0 * IF(R0 == 0.0, 0.0, 1.0)"; POPBOOL; ANDN C256; MATH R2 "R0 / R1""#,
    );
}

#[test]
fn inferred_forms_can_be_avoided() {
    // Without HALT an overflow stops nothing, which is stated.
    let options = Options { only_confirmed: true };
    for (rung, verdict) in [
        ("AND N7:0 255 N7:0", Verdict::Exact),
        ("SQR N7:0 N7:1", Verdict::Person),
        ("ADD N7:0 1 N7:0", Verdict::Condition),
        ("DIV N7:0 N7:1 N7:2", Verdict::Condition),
        ("SCP N7:0 0 16383 0 55 N7:1", Verdict::Exact),
        ("MOV F8:0 N7:0", Verdict::Condition),
        ("COP #N7:0 #N7:2 7", Verdict::Exact),
    ] {
        let image = image(Family::Slc503, &[(2, rung)]);
        let migration = migrate(&image, &[], &options).expect("it migrates");
        assert_eq!(migration.rungs.first().map(|result| result.verdict), Some(verdict), "{rung}");
    }
}
