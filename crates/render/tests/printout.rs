//! Rungs as they look, to be compared by eye with the vendor's printouts.

mod common;

use common::{commented, documentation, file, image, ins, legs};
use ladder::{Documentation, Element, Instruction, MessageSetup, Mnemonic, Operand, Rung};
use render::Style;

fn narrow() -> Style {
    Style { width: 80, ..Style::default() }
}

fn draw(rung: Rung, documentation: &Documentation, style: &Style) -> String {
    render::rung(&image(), &file(vec![rung]), 0, documentation, style)
}

fn plain(series: ladder::Series, style: &Style) -> String {
    draw(Rung::new(series), &Documentation::default(), style)
}

/// A motor with seal-in contact and a delayed horn.
fn motor() -> (Rung, Documentation) {
    let rung = commented(
        vec![
            legs([vec![ins("XIC", "I:0.0/0")], vec![ins("XIC", "B3:0/0")]]),
            ins("XIO", "I:0.0/1"),
            legs([
                vec![ins("OTE", "B3:0/0")],
                vec![ins("TON", "T4:0 0.01 500 120")],
                vec![ins("XIC", "T4:0/DN"), ins("OTE", "O:0.0/2")],
            ]),
        ],
        "Conveyor 1",
        "Motor with seal-in.\n\n- The horn sounds 5 s after the start; it is loud enough for the whole hall, 85 dB at 20 °C.\n",
    );
    let documentation = documentation(&[
        "I:0.0/0|START_PB|Start|push button",
        "I:0.0/1|STOP_PB|Stop|push button",
        "B3:0/0|MOTOR_RUN|Motor runs",
        "T4:0|HORN_DELAY|Horn delay",
        "O:0.0/2||Horn",
    ]);
    (rung, documentation)
}

#[test]
fn seal_in_with_comment_and_title() {
    let (rung, documentation) = motor();
    insta::assert_snapshot!(draw(rung, &documentation, &narrow()));
}

#[test]
fn ascii_without_comment_and_description() {
    let (rung, documentation) = motor();
    let style = Style { ascii: true, comments: false, descriptions: false, split_bits: false, ..narrow() };
    insta::assert_snapshot!(draw(rung, &documentation, &style));
}

#[test]
fn colour_is_around_texts_only() {
    let (rung, documentation) = motor();
    let coloured = draw(rung.clone(), &documentation, &Style { color: true, ..narrow() });
    let mut stripped = String::new();
    for (index, part) in coloured.split('\u{1B}').enumerate() {
        stripped.push_str(if index == 0 { part } else { part.split_once('m').expect("the end of an escape").1 });
    }
    assert_eq!(stripped, draw(rung, &documentation, &narrow()));
    for wanted in ["\u{1B}[0;2m0000\u{1B}[0m", "\u{1B}[0;32mMOTOR_RUN", "\u{1B}[0;33mMotor with seal-in."] {
        assert!(coloured.contains(wanted), "{wanted:?}");
    }
}

#[test]
fn values_follow_their_operands() {
    let documentation = documentation(&["N7:1||Speed|set point", "N7:2|SPEED", "N7:3|INDEX", "U:5||Recipes"]);
    let boxes = vec![
        ins("LIM", "0=0 N7:1=55 1000=1000"),
        legs([
            vec![ins("MOV", "N7:1=55 N7:2=54")],
            vec![ins("JSR", "U:5")],
            vec![ins("MOV", "1=1 N10:[N7:3]=7")],
            vec![ins("XIC", "B3:1/[N7:3]"), ins("MVM", "N7:1=55 00FFh=00FFh B11:0=0000000000000001")],
        ]),
    ];
    insta::assert_snapshot!(draw(Rung::new(boxes.clone()), &documentation, &narrow()));
    let text = draw(Rung::new(boxes), &documentation, &Style { values: false, ..narrow() });
    assert!(!text.contains('<') && text.contains("N7:2"), "{text}");
}

#[test]
fn edited_rungs_are_marked_and_show_what_was_typed() {
    let mut timer = ins("TON", "T4:0 1.0 30 0");
    if let Element::Instruction(timer) = &mut timer {
        timer.compiled = false;
    }
    let rung = Rung { edited: true, ..Rung::new(vec![ins("XIC", "START"), ins("EQU", "N7:0=3 3=3"), timer]) };
    insta::assert_snapshot!(draw(rung, &Documentation::default(), &narrow()));
}

#[test]
fn data_table_wins_over_the_stored_text_and_the_difference_shows() {
    // The element has PRE 500 and ACC 120.
    insta::assert_snapshot!(plain(vec![ins("TON", "T4:0 0.01 300 120")], &narrow()));
}

#[test]
fn long_series_go_on_below() {
    let mut series: Vec<_> = (0..7).map(|n| ins("EQU", &format!("N7:{n}=0 2=2"))).collect();
    series.push(ins("OTE", "B3:5/5"));
    insta::assert_snapshot!(plain(series, &narrow()));
}

#[test]
fn outputs_that_do_not_fit_stand_at_the_right_rail_below() {
    let series = vec![
        ins("GRT", "L244:0=0 L244:2=0"),
        legs([vec![ins("XIO", "B235:0/0")], vec![]]),
        ins("EQU", "N7:0=0 1=1"),
        ins("CTU", "C5:0 10 0"),
    ];
    insta::assert_snapshot!(plain(series, &Style { width: 76, ..narrow() }));
}

#[test]
fn branches_nest() {
    let inner = legs([vec![ins("XIC", "B3:0/3")], vec![], vec![ins("XIO", "B3:0/4"), ins("ONS", "B3:0/5")]]);
    let middle = legs([vec![ins("LES", "N7:0=1 N7:1=2"), inner], vec![ins("XIC", "S:1/15")]]);
    let outer = legs([vec![middle, ins("XIC", "HSC:0/FE")], vec![ins("XIC", "I:0.0/12"), ins("XIC", "I:3.1/4")]]);
    let series = vec![outer, ins("OTL", "B3:1/0"), ins("RES", "C5:0")];
    insta::assert_snapshot!(plain(series, &narrow()));
}

#[test]
fn bits_of_io_count_through_the_words_of_their_slot() {
    let series = vec![ins("XIC", "I:1.1/3"), ins("XIO", "I:0.1/[N7:0]"), ins("EQU", "I:3.1 1"), ins("OTE", "O:0.2/5")];
    let text = plain(series, &narrow());
    let words: Vec<&str> = text.split(|c: char| c.is_whitespace() || c == '│').filter(|w| !w.is_empty()).collect();
    for (wanted, times) in [("I:1", 1), ("19", 1), ("O:0", 1), ("37", 1), ("I:0.1", 1), ("[N7:0]", 1), ("I:3.1", 1)] {
        assert_eq!(words.iter().filter(|word| **word == wanted).count(), times, "{wanted} in\n{text}");
    }
}

#[test]
fn unknown_instructions_show_all_they_hold() {
    let unknown = Instruction::new(Mnemonic::Unknown(0x4D), vec![Operand::parse("N7:0"), Operand::parse("#N9:0")]);
    let mut message =
        Instruction::new(Mnemonic::named("MSG"), vec![Operand::parse("MG9:0"), Operand::Empty, Operand::parse("N7:0")]);
    message.message = Some(Box::new(MessageSetup {
        settings: vec![("Channel".into(), "0".into()), ("Target Address".into(), "16386".into())],
    }));
    let series = vec![
        ins("NEWINS", "N7:5"),
        ins("MOV", "N7:1"),
        legs([vec![Element::Instruction(unknown)], vec![Element::Instruction(message)]]),
    ];
    insta::assert_snapshot!(plain(series, &Style { width: 100, ..narrow() }));
}

#[test]
fn long_texts_are_wrapped_never_cut() {
    let mut cpt = Instruction::new(Mnemonic::named("CPT"), vec![Operand::parse("F8:0")]);
    cpt.operands.push(Operand::parse(" ( N7:62 * 1.5 ) + ( F8:10 | ( N7:63 - 100.0 ) ) + ( N7:64 * N7:65 ) "));
    let bit = ins("XIC", "T[N77:110]:[C5:255.ACC]/DN");
    let odd = ins("OTE", "A_SYMBOL_THAT_IS_LONGER_THAN_THE_PLACE_BESIDE_IT_BECAUSE_IT_CAME_FROM_A_TEXT");
    insta::assert_snapshot!(plain(vec![bit, Element::Instruction(cpt), odd], &Style { width: 60, ..narrow() }));
}

#[test]
fn whole_file() {
    let rungs = vec![
        Rung::new(vec![ins("SBR", ""), ins("LBL", "Q0:3"), ins("JMP", "Q7:3")]),
        Rung::new(vec![ins("OSR", "B3:0/1 B3:0/2")]),
        Rung::new(vec![ins("MCR", "")]),
        Rung::new(Vec::new()),
        Rung::new(vec![ins("END", "")]),
    ];
    let mut file = file(rungs);
    file.description = "start and stop".into();
    let mut out = Vec::new();
    let (image, documentation) = (image(), Documentation::default());
    render::program_file(&mut out, &image, &file, None, &documentation, &Style { width: 60, ..narrow() })
        .expect("written");
    insta::assert_snapshot!(String::from_utf8(out).expect("text"));
    let mut part = Vec::new();
    render::program_file(&mut part, &image, &file, Some(3..=99), &documentation, &narrow()).expect("written");
    let part = String::from_utf8(part).expect("text");
    assert!(part.contains("0003") && part.contains("0004") && !part.contains("0002"), "{part}");
}
