//! A small project of our own making with something of everything the model has.

use ladder::*;

/// An instruction as a project stores it: verified, operands typed by their spelling.
pub(crate) fn instruction(name: &'static str, operands: &[&str]) -> Element {
    let operands = operands.iter().map(|text| Operand::parse(text)).collect();
    Element::Instruction(Instruction { compiled: true, ..Instruction::new(Mnemonic::named(name), operands) })
}

pub(crate) fn address(text: &str) -> Address {
    Address::parse(text).expect(text)
}

fn rungs() -> Vec<Rung> {
    let lamp = Branch {
        legs: vec![
            vec![instruction("OTE", &["B3:0/1"])],
            vec![instruction("TON", &["T4:0", "0.01", "100", "0"])],
            Vec::new(),
        ],
    };
    let mut first = Rung::new(vec![instruction("XIC", &["B3:0/0"]), Element::Branch(lamp)]);
    first.edited = true;
    first.comment = Some(Comment {
        text: "Flashes the lamp\r\n100 % of the time\r\n".into(),
        title: "Lamp \"A\"".into(),
        owner: CommentOwner::Address(Target::Address(address("T4:0"))),
    });
    let mut call = Rung::new(vec![instruction("JSR", &["U:4"])]);
    call.comment =
        Some(Comment { text: String::new(), title: "Calls".into(), owner: CommentOwner::Rung { file: 2, rung: 1 } });
    let mut jump = Rung::new(vec![instruction("LBL", &["Q51:3"]), instruction("JMP", &["Q2:3"])]);
    jump.comment =
        Some(Comment { text: String::new(), title: String::new(), owner: CommentOwner::Rung { file: 2, rung: 2 } });
    let mut unknown = Instruction::new(Mnemonic::Unknown(0x1F4), vec![Operand::Unset, Operand::Empty]);
    unknown.displayed = vec![None, Some("5120".into())];
    unknown.message =
        Some(Box::new(MessageSetup { settings: vec![("Channel".into(), "1".into()), ("word 7".into(), "-1".into())] }));
    let unknown = Rung::new(vec![Element::Branch(Branch {
        legs: vec![vec![instruction("XIC", &["LAMP_ON"])], vec![Element::Instruction(unknown)]],
    })]);
    let compute = Rung::new(vec![instruction("CPT", &["N7:0", "( N7:1 + 5 ) | 2"])]);
    vec![first, call, jump, unknown, compute, Rung::new(vec![instruction("END", &[])])]
}

fn file(file_type: FileType, number: u16, elements: u16, words: &[u16]) -> DataFile {
    let mut file = DataFile::new(file_type, number, elements);
    for (slot, word) in file.words.iter_mut().zip(words) {
        *slot = *word;
    }
    file
}

fn data_files() -> Vec<DataFile> {
    use FileType::*;
    let mut outputs = file(O, 0, 2, &[5, 0xFFFF]);
    outputs.forces = vec![Force { on: 0x0003, off: 0xFFFB }, Force::NONE];
    let mut text = file(ST, 9, 3, &[3, 0x4142, 0x4344]);
    text.name = "TEXTS".into();
    text.words[42] = 1;
    text.words[43] = 0x8000;
    text.words[84] = 500;
    let mut pid = DataFile { words_per_element: 23, ..file(PD, 11, 0, &[]) };
    pid.elements = 1;
    pid.words = (0..23).collect();
    vec![
        outputs,
        file(I, 1, 1, &[]),
        file(T, 4, 3, &[0xA000, 100, 7, 0x4200, 5994, 0xFFFF, 0x1301, 0, 0]),
        file(C, 5, 1, &[0xFC00, 10, 3]),
        file(R, 6, 1, &[0x8001, 10, 3]),
        DataFile { description: "counts".into(), ..file(N, 7, 3, &[1, 0x8000, 0xFFFF]) },
        file(F, 8, 7, &[0, 0x3FC0, 0xCCCD, 0x3DCC, 0, 0x7F80, 0, 0xFF80, 0, 0x7FC0, 1, 0x7FC0, 0, 0x8000]),
        text,
        file(L, 10, 2, &[0xFFFF, 0xFFFF, 0, 0x8000]),
        pid,
        DataFile { words: vec![1, 2, 3], ..file(R, 12, 2, &[]) },
        file(Unused, 13, 0, &[]),
        file(Unknown(99), 14, 2, &[7, 8]),
    ]
}

fn documentation() -> Documentation {
    let mut documentation = Documentation::default();
    let entry = |target, symbol: &str, lines: &[&str]| AddressEntry {
        target,
        symbol: symbol.into(),
        description: lines.iter().map(|line| (*line).into()).collect(),
    };
    documentation.add(entry(Target::Address(address("T4:0")), "LAMP_FLASH_TON", &["lamp", "flash"]));
    documentation.add(entry(Target::ProgramFileOperand(4), "PUMPS", &[]));
    documentation.add(entry(Target::Label { file: 2, number: 3 }, "", &["again"]));
    documentation.add(entry(Target::ProgramFile(2), "", &["main"]));
    documentation.add(entry(Target::DataFile(7), "", &["counts"]));
    documentation.add(entry(Target::Unassigned, "SPARE", &[]));
    documentation.add(entry(Target::Other("[?]".into()), "", &["", "=1+1, \"quoted\""]));
    documentation.add_instruction_comment(InstructionComment {
        mnemonic: "XIC".into(),
        target: Some(Target::Address(address("T4:0/DN"))),
        lines: vec!["half a second over".into()],
    });
    documentation.add_instruction_comment(InstructionComment { mnemonic: "0".into(), target: None, lines: Vec::new() });
    documentation.detached_comments.push(Comment {
        text: "left over".into(),
        title: String::new(),
        owner: CommentOwner::Rung { file: 9, rung: 70 },
    });
    documentation
}

fn image() -> Image {
    Image {
        processor: Processor {
            model: Some(61),
            catalog: Some("Bul.1763".into()),
            name: Some("MicroLogix 1100 Series B".into()),
            family: Family::MicroLogix1100,
            family_confidence: Confidence::Proven,
            evidence: "printed".into(),
            project_name: "UNTITLED".into(),
            program_id: Some(0xFE12),
            password_fields_used: Some(false),
            ..Processor::default()
        },
        program_files: vec![
            ProgramFile {
                number: 0,
                name: String::new(),
                description: String::new(),
                kind: ProgramFileKind::System,
                rungs: Vec::new(),
            },
            ProgramFile {
                number: 2,
                name: "MAIN".into(),
                description: String::new(),
                kind: ProgramFileKind::Ladder,
                rungs: rungs(),
            },
        ],
        data_files: data_files(),
        function_files: vec![DataFile {
            words_per_element: 3,
            words: vec![0, 0xFFFF, 2, 3, 4, 5],
            ..file(FileType::HSC, 0, 2, &[])
        }],
        io: IoConfiguration {
            slots: vec![Slot {
                number: 0,
                module: Module {
                    catalog: None,
                    description: "10 inputs, 6 outputs".into(),
                    identity: "ID 500".into(),
                    confidence: Confidence::Inferred,
                },
                inputs: IoRange { first_word: 0, words: 1, bits: 10 },
                outputs: IoRange { first_word: 0, words: 2, bits: 6 },
                configuration: vec![0, 0xFFFF],
            }],
            base_unit: "BWA: relay outputs".into(),
            unknown: Some("expansion bus not known".into()),
        },
        channels: vec![Channel {
            number: 1,
            driver: "Ethernet".into(),
            settings: vec![Setting {
                name: "IP Address".into(),
                value: "0.0.0.0".into(),
                confidence: Confidence::Proven,
            }],
            unexplained_words: 12,
        }],
        memory: Some(Memory {
            instruction_words_used: 10,
            instruction_words_left: 100,
            data_words_used: None,
            data_words_left: Some(5),
        }),
        documentation: documentation(),
    }
}

/// The whole project.
pub(crate) fn project() -> Project {
    Project {
        source: Source {
            file: "lamp.RSS".into(),
            sha256: "00".repeat(32),
            bytes: 40_000,
            saved_by: "8.30.00".into(),
            application: "RSLogix Micro Starter Lite".into(),
            saved_at: Some("2020-01-02T03:04:05Z".into()),
            created_at: None,
        },
        main: image(),
        online: Some(Image { documentation: Documentation::default(), ..image() }),
        autosave: None,
        revision_notes: vec![RevisionNote { revision: 3, note: "new lamp".into() }],
        diagnostics: vec![Diagnostic {
            severity: Severity::Warning,
            place: "PROGRAM FILES/ObjectData, offset 0x12".into(),
            message: "expected 1, found 2".into(),
        }],
    }
}
