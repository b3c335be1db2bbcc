//! Random projects through JSON: the model that comes back is the one that went in.

mod json_support;

use convert::json::{from_json, to_json, to_json_text};
use ladder::*;
use proptest::prelude::*;

/// Instructions with operands in spellings that programs use, and some that no table knows.
const INSTRUCTIONS: &[(&str, &[&str])] = &[
    ("XIC", &["B3:0/15"]),
    ("XIO", &["I:1.0/3"]),
    ("OTE", &["N[N7:4]:21/0"]),
    ("TON", &["T4:0", "0.01", "100", "0"]),
    ("CTU", &["C5:[N7:0]", "-1", "0"]),
    ("RES", &["T4:0"]),
    ("MOV", &["#N7:3", "L9:1"]),
    ("MVM", &["N7:0", "00FFh", "N7:1"]),
    ("LIM", &["-32768", "F8:0", "1000.0"]),
    ("CPT", &["F8:0", "( N7:62 * 1.5 ) + 500.0"]),
    ("COP", &["#N7:0", "#ST9:1", "5"]),
    ("JSR", &["U:255"]),
    ("JMP", &["Q3:7"]),
    ("LBL", &["Q0:7"]),
    ("SBR", &[]),
    ("NOP", &[]),
    ("AFI", &[]),
    ("OSR", &["B3:0/1", "B3:0/2"]),
    ("OSR", &["B3:0/1"]),
    ("XIC", &["?"]),
    ("XIC", &["MOTOR_ON/3"]),
    ("MSG", &["MG9:0", "Setup Screen"]),
    ("ABC", &["a b", "", "\"x\" y"]),
    ("XIC", &["BST"]),
];

fn instruction() -> impl Strategy<Value = Instruction> {
    let known = proptest::sample::select(INSTRUCTIONS).prop_map(|(name, operands)| {
        let operands = operands.iter().map(|text| Operand::parse(text)).collect();
        Instruction::new(Mnemonic::named(name), operands)
    });
    let unknown = any::<u16>().prop_map(|code| Instruction::new(Mnemonic::Unknown(code), vec![Operand::Unset]));
    let message = proptest::option::of((text(), text()));
    (prop_oneof![12 => known, 1 => unknown], any::<bool>(), proptest::option::of(text()), message).prop_map(
        |(mut instruction, compiled, displayed, message)| {
            instruction.compiled = compiled;
            if displayed.is_some() {
                instruction.displayed = vec![displayed; instruction.operands.len()];
            }
            instruction.message =
                message.map(|(name, value)| Box::new(MessageSetup { settings: vec![(name.into(), value)] }));
            instruction
        },
    )
}

fn text() -> impl Strategy<Value = String> {
    prop_oneof!["[ -~]{0,12}", "[A-Z_]{1,8}", ".{0,4}", Just("two\r\nlines \"quoted\"".to_owned())]
}

fn series() -> impl Strategy<Value = Series> {
    let leaf = instruction().prop_map(Element::Instruction);
    let element = leaf.prop_recursive(3, 16, 4, |inner| {
        let leg = proptest::collection::vec(inner, 0..3);
        proptest::collection::vec(leg, 2..4).prop_map(|legs| Element::Branch(Branch { legs }))
    });
    proptest::collection::vec(element, 0..4)
}

fn target() -> impl Strategy<Value = Target> {
    prop_oneof![
        proptest::sample::select(vec!["N7:0", "T4:0/DN", "I:1.0/3", "N[N7:4]:2", "HSC:0.HIP", "#N7:0"])
            .prop_map(|text| Target::Address(json_support::address(text))),
        any::<u16>().prop_map(Target::ProgramFileOperand),
        any::<(u16, u16)>().prop_map(|(file, number)| Target::Label { file, number }),
        any::<u16>().prop_map(Target::ProgramFile),
        any::<u16>().prop_map(Target::DataFile),
        Just(Target::Unassigned),
        text().prop_map(Target::Other),
    ]
}

fn comment() -> impl Strategy<Value = Comment> {
    let owner = prop_oneof![
        (0..4_u16, 0..4_u32).prop_map(|(file, rung)| CommentOwner::Rung { file, rung }),
        target().prop_map(CommentOwner::Address),
    ];
    (text(), text(), owner).prop_map(|(text, title, owner)| Comment { text, title, owner })
}

fn rung() -> impl Strategy<Value = Rung> {
    (series(), any::<bool>(), proptest::option::of(comment())).prop_map(|(series, edited, comment)| Rung {
        series,
        edited,
        comment,
    })
}

fn data_file() -> impl Strategy<Value = DataFile> {
    use FileType::*;
    let types = vec![O, I, S, B, T, C, R, N, F, A, ST, L, D, M0, PD, MG, HSC, Reserved, Unused, Unknown(77)];
    (proptest::sample::select(types), any::<u16>(), 0..4_u16, proptest::option::of(0..5_u16)).prop_flat_map(
        |(file_type, number, elements, size)| {
            let file = DataFile::new(file_type, number, elements);
            // Now and then elements of a size that the type does not have.
            let size = size.unwrap_or(file.words_per_element);
            let words = usize::from(elements) * usize::from(size);
            // Nor have force masks always the number of the words.
            let forces = if file.forces.is_empty() { 0 } else { file.forces.len() + usize::from(number % 3) };
            (
                proptest::collection::vec(any::<u16>(), words),
                proptest::collection::vec(any::<(u16, u16)>(), forces),
                text(),
            )
                .prop_map(move |(words, forces, name)| DataFile {
                    words,
                    words_per_element: size,
                    forces: forces.into_iter().map(|(on, off)| Force { on, off }).collect(),
                    name,
                    ..file.clone()
                })
        },
    )
}

fn documentation() -> impl Strategy<Value = Documentation> {
    let entry = (target(), text(), proptest::collection::vec(text(), 0..3))
        .prop_map(|(target, symbol, description)| AddressEntry { target, symbol, description });
    let under = (proptest::option::of(target()), text(), proptest::collection::vec(text(), 0..3))
        .prop_map(|(target, mnemonic, lines)| InstructionComment { mnemonic, target, lines });
    (
        proptest::collection::vec(entry, 0..4),
        proptest::collection::vec(under, 0..3),
        proptest::collection::vec(comment(), 0..3),
    )
        .prop_map(|(entries, comments, detached_comments)| {
            let mut documentation = Documentation::default();
            documentation.detached_comments = detached_comments;
            entries.into_iter().for_each(|entry| documentation.add(entry));
            comments.into_iter().for_each(|comment| documentation.add_instruction_comment(comment));
            documentation
        })
}

fn image() -> impl Strategy<Value = Image> {
    let families: Vec<Family> = Family::all().collect();
    (
        proptest::sample::select(families),
        proptest::collection::vec(rung(), 0..4),
        proptest::collection::vec(data_file(), 0..4),
        documentation(),
    )
        .prop_map(|(family, rungs, data_files, documentation)| {
            let mut image = json_support::project().main;
            image.processor.family = family;
            if let Some(file) = image.program_files.last_mut() {
                file.rungs = rungs;
            }
            image.data_files = data_files;
            image.documentation = documentation;
            image
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn projects_come_back(main in image(), autosave in proptest::option::of(image())) {
        let project = Project { main, autosave, ..json_support::project() };
        let text = to_json_text(&project);
        let back = from_json(&text).map_err(|error| TestCaseError::fail(format!("{error}\n{text}")))?;
        prop_assert_eq!(&back, &project);
        // The compact form of other tools is the same document.
        let again = from_json(&to_json(&project).to_string());
        prop_assert_eq!(again.as_ref(), Ok(&project));
    }

    /// Whatever is changed in a document, reading ends with a project or an error, and what is read
    /// can be written.
    #[test]
    fn damaged_documents_never_panic(changes in proptest::collection::vec((any::<prop::sample::Index>(), "[ -~]"), 1..4)) {
        let mut text = to_json_text(&json_support::project());
        for (index, with) in changes {
            let at = index.index(text.len());
            if text.is_char_boundary(at) && text.is_char_boundary(at + 1) {
                text.replace_range(at..=at, &with);
            }
        }
        if let Ok(project) = from_json(&text) {
            let again = from_json(&to_json_text(&project));
            prop_assert_eq!(again.as_ref(), Ok(&project));
        }
    }
}
