//! Search over both dialects: what each kind of query finds, and what it does not.

use analysis::search::{About, Hits, MAX_HITS, Query, search, search_domore};
use ladder::{AddressEntry, Comment, CommentOwner, Documentation, Element, Image, Target, Value};

mod support;

fn hits(found: &Hits) -> Vec<String> {
    let place = |hit: &analysis::search::Hit| {
        hit.location.map_or_else(|| "-".to_owned(), |at| format!("{}:{}.{}", at.file, at.rung, at.instruction))
    };
    found.list.iter().map(|hit| format!("{} {} {}", place(hit), hit.kind, hit.text)).collect()
}

fn comment(text: &str, title: &str) -> Comment {
    Comment { text: text.into(), title: title.into(), owner: CommentOwner::Rung { file: 2, rung: 0 } }
}

fn program() -> Image {
    let mut image = support::image(&[
        "XIC B3:0/0;TON T4:0 0.01 500 0",
        "XIC T4:0/DN;TON T4:1 1.0 30 0",
        "EQU N7:0 -5;MOV 17 N7:1",
        "XIC B3:1/1;OTE O:0/3",
    ]);
    let comment = comment("Wait for the filling pump", "Filling");
    if let Some(rung) = image.program_files.first_mut().and_then(|file| file.rungs.get_mut(1)) {
        rung.comment = Some(comment);
    }
    // Never verified: the boxes have the values.
    for element in image.program_files.iter_mut().flat_map(|file| &mut file.rungs).flat_map(|rung| &mut rung.series) {
        if let Element::Instruction(instruction) = element {
            instruction.compiled = false;
        }
    }
    image
}

fn documentation() -> Documentation {
    let mut documentation = Documentation::default();
    let target = |text: &str| Target::from(&ladder::Address::parse(text).expect("an address"));
    for (address, symbol, description) in
        [("T4:0", "RUN_UP", "pump runs up"), ("N7:1", "RECIPE", "number of the recipe")]
    {
        documentation.add(AddressEntry {
            target: target(address),
            symbol: symbol.to_owned(),
            description: vec![description.to_owned()],
        });
    }
    documentation
}

fn found(text: &str) -> Vec<String> {
    hits(&search(&program(), &documentation(), &Query::new(text)))
}

#[test]
fn addresses_and_symbols_find_every_access() {
    for text in ["T4:0", "run_up"] {
        let all = found(text);
        assert!(all.iter().any(|hit| hit.starts_with("2:0.1 ") && hit.contains("TON")), "{text}: {all:?}");
        assert!(all.iter().any(|hit| hit.starts_with("2:1.0 read XIC T4:0/DN")), "{text}: {all:?}");
    }
    assert!(found("T4:1").iter().all(|hit| hit.starts_with("2:1.1 ")));
    // One bit in two spellings.
    assert_eq!(found("B3/17"), found("B3:1/1"));
    assert_eq!(found("B3/17").len(), 1);
}

#[test]
fn patterns_compare_operands() {
    for (pattern, expected) in [
        ("TON", vec!["2:0.1 instruction TON T4:0 0.01 500 0", "2:1.1 instruction TON T4:1 1.0 30 0"]),
        ("TON * 0.01", vec!["2:0.1 instruction TON T4:0 0.01 500 0"]),
        ("TON * * >=500", vec!["2:0.1 instruction TON T4:0 0.01 500 0"]),
        ("TON * * <500", vec!["2:1.1 instruction TON T4:1 1.0 30 0"]),
        ("ton t4:?", vec!["2:0.1 instruction TON T4:0 0.01 500 0", "2:1.1 instruction TON T4:1 1.0 30 0"]),
        ("T* * * 30", vec!["2:1.1 instruction TON T4:1 1.0 30 0"]),
        ("EQU * !=-5", vec![]),
        ("MOV =17", vec!["2:2.1 instruction MOV 17 N7:1"]),
        ("XIC B3/17", vec!["2:3.0 instruction XIC B3:1/1"]),
    ] {
        assert_eq!(found(pattern), expected, "{pattern}");
    }
}

/// The data table has the values of a verified timer; its box shows those of an earlier time.
#[test]
fn presets_in_force_are_those_of_the_data_table() {
    let mut image = support::image(&["XIC B3:0/0;TON T4:0 0.01 500 0"]);
    let timers = image.data_files.iter_mut().find(|file| file.label() == "T4").expect("timers");
    timers.words[1] = 800;
    let at = |image: &Image| image.value_at(&ladder::Address::parse("T4:0.PRE").expect("an address"));
    assert_eq!(at(&image), Some(Value::Word(800)));
    let count = |text: &str| search(&image, &Documentation::default(), &Query::new(text)).list.len();
    assert_eq!((count("TON * * >=800"), count("TON * * 500")), (1, 0));
}

#[test]
fn texts_are_found_in_comments_symbols_and_descriptions() {
    assert_eq!(found("pump"), ["2:1.0 comment Wait for the filling pump", "- description T4:0 RUN_UP pump runs up"]);
    assert_eq!(found("filling"), ["2:1.0 title Filling", "2:1.0 comment Wait for the filling pump"]);
    assert_eq!(found("recipe number"), Vec::<String>::new());
    assert_eq!(found("RECI"), ["- symbol N7:1 RECIPE", "- description N7:1 RECIPE number of the recipe"]);
    let about: Vec<_> =
        search(&program(), &documentation(), &Query::new("RECI")).list.into_iter().map(|hit| hit.about).collect();
    assert_eq!(about, vec![Some(About::Address("N7:1".to_owned())); 2]);
    // A text that begins like an instruction.
    let mut image = program();
    if let Some(rung) = image.program_files.first_mut().and_then(|file| file.rungs.first_mut()) {
        rung.comment = Some(comment("Add water slowly", ""));
    }
    let all = hits(&search(&image, &documentation(), &Query::new("add water")));
    assert_eq!(all, ["2:0.0 comment Add water slowly"]);
}

#[test]
fn regular_expressions_look_at_instructions_and_texts() {
    let query = Query::regex("^(EQU|MOV) ").expect("an expression");
    let all = hits(&search(&program(), &documentation(), &query));
    assert_eq!(all, ["2:2.0 instruction EQU N7:0 -5", "2:2.1 instruction MOV 17 N7:1"]);
    let query = Query::regex("run[s_]").expect("an expression");
    assert_eq!(search(&program(), &documentation(), &query).list.len(), 2);
    assert!(Query::regex("(").is_err());
    // As large as an expression can be made to grow.
    assert!(Query::regex(&format!("{}{{1000}}{{1000}}", "a")).is_err());
}

#[test]
fn hits_are_bounded_and_counted() {
    let rung = "XIC B3:0/0;".repeat(200);
    let rungs: Vec<&str> = (0..60).map(|_| rung.trim_end_matches(';')).collect();
    let found = search(&support::image(&rungs), &Documentation::default(), &Query::new("XIC"));
    assert_eq!((found.list.len(), found.not_listed), (MAX_HITS, 2000));
}

const FILLING: &str = "PLC DM-SIM\n\n#BEGIN DEVICE\n\t@IntSerial, 10, 15\n#END\n\n#BEGIN MEM_CONFIG\n\tN\tSWORD\tdecimal\t4096\n#END\n\n\
     $PRGRM $Main\n\n#BEGIN COMMENT\n\"Belt runs\"\n#END\n\nSTR X0\nOR C0\nOUT Y0\n\nSTR C0\nTMR T0 2500\n\n\
     STR T0.Done\nRUN Fill\n\n$PGMEND $Main\n\n$PRGRM Fill\n\nSTR ST1\nTMR T1 Limit\n\nSTR ST1\nMATH N1 \"N2 + N3\"\n\n$PGMEND Fill\n\n\
     #BEGIN ELEMENT_DOC\n\"X0\",\"FLAGS =\",\"Start\",\"\",\"start button\"\n\"SK1\",\"FLAGS =\",\"Limit\",\"500\",\"\"\n#END\n";

fn found_in_filling(query: &Query) -> Vec<String> {
    hits(&search_domore(&domore::text::read(FILLING).expect("a program").project, query))
}

#[test]
fn programs_of_do_more_are_searched_alike() {
    for (text, expected) in [
        ("X0", vec!["1:0.0 read STR X0 (definite)"]),
        ("start", vec!["1:0.0 read STR X0 (definite)"]),
        ("N3", vec!["2:1.0 read MATH N3 (definite)"]),
        ("T0", vec!["1:1.0 own TMR T0 (definite)", "1:2.0 read STR T0.Done (definite)"]),
        ("Fill", vec!["1:2.0 refer RUN Fill (definite)"]),
        ("TMR * >=2500", vec!["1:1.1 instruction TMR T0 2500"]),
        ("TMR * 500", vec!["2:0.1 instruction TMR T1 Limit"]),
        ("STR Start", vec!["1:0.0 instruction STR X0"]),
        ("T*R * <600", vec!["2:0.1 instruction TMR T1 Limit"]),
        ("belt", vec!["1:0.0 comment Belt runs"]),
        ("button", vec!["- description X0 Start start button"]),
        ("serial", vec!["- device @IntSerial 10, 15"]),
        ("TON", vec![]),
    ] {
        assert_eq!(found_in_filling(&Query::new(text)), expected, "{text}");
    }
    let query = Query::regex("^TMR T\\d").expect("an expression");
    assert_eq!(found_in_filling(&query), ["1:1.1 instruction TMR T0 2500", "2:0.1 instruction TMR T1 Limit"]);
}
