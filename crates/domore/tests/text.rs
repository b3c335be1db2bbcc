//! Reading and writing the text form: nothing is lost, nothing is moved, deviations have a place.

use std::path::PathBuf;

use domore::instruction::by_mnemonic;
use domore::program::{CodeKind, CommentKind, LineEnd, Radix};
use domore::text::{read, write};
use domore::{Instruction, Problem, Rung};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod place;

const SMALL: &str = include_str!("data/small.txt");

fn corpus() -> Option<PathBuf> {
    place::root().map(|root| root.join("domore")).filter(|folder| folder.is_dir())
}

#[test]
fn exports_come_back_as_they_are() {
    let Some(folder) = corpus() else { return };
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("folder") {
        let path = entry.expect("entry").path();
        let text = std::fs::read_to_string(&path).expect("text");
        let reading = read(&text).expect("readable");
        assert_eq!(reading.diagnostics, [], "{}", path.display());
        assert_eq!(write(&reading.project), text, "{}", path.display());
        count += 1;
        // What Designer writes must be what this crate writes without having read it.
        for block in reading.project.code_blocks() {
            for rung in &block.rungs {
                for instruction in &rung.instructions {
                    assert!(by_mnemonic(&instruction.mnemonic).is_some(), "{instruction}");
                }
            }
        }
    }
    assert!(count > 0, "no export in the corpus");
}

#[test]
fn a_project_is_read_whole() {
    let reading = read(SMALL).expect("readable");
    let project = &reading.project;
    assert_eq!(project.controller(), "DM-SIM");
    assert_eq!(
        project.devices().map(|d| (d.name.as_str(), d.parameters.len())).collect::<Vec<_>>(),
        [("@IntSerial", 2), ("@IntModTCPClient", 5)]
    );
    let memory: Vec<_> = project.memory().map(|m| (m.name.as_str(), m.radix, m.count, m.extra.len())).collect();
    assert_eq!(
        memory,
        [
            ("X", Some(Radix::Decimal), 2048, 1),
            ("DLX", Some(Radix::Octal), 0o1000, 1),
            ("N", Some(Radix::Decimal), 4096, 0),
            ("MSG", None, 0, 0),
            ("Batch", None, 0, 1),
            ("Rate", None, 0, 0),
        ]
    );
    let blocks: Vec<_> = project.code_blocks().map(|b| (b.kind.clone(), b.name.as_str(), b.rungs.len())).collect();
    assert_eq!(
        blocks,
        [(CodeKind::Program, "$Main", 2), (CodeKind::Program, "Batch", 12), (CodeKind::Subroutine, "Rate", 2)]
    );
    let main = project.code_block("$Main").expect("block");
    let comment = main.rungs[0].comment.as_ref().expect("comment");
    assert_eq!(comment.lines, ["start the \"batch\" program", "", "second paragraph"]);
    assert_eq!(main.rungs[1].comment.as_ref().expect("comment").kind, CommentKind::Formatted);
    assert_eq!(main.rungs[0].instructions, [Instruction::new("STR", ["ST0"]), Instruction::new("RUN", ["Batch"])]);
    assert_eq!(main.rungs[0].line(), Some(33));
    let batch = project.code_block("Batch").expect("block");
    assert_eq!(batch.rungs[0].stage(), Some("Batch.S0"));
    assert_eq!(batch.rungs[7].instructions[1].operands, ["SS0", "0x1", "\"2 \"\"a b\"\" 0x0\""]);
    let docs: Vec<_> = project.documentation().collect();
    assert_eq!(docs[0].lines(), ["start button", "panel A"]);
    assert_eq!((docs[1].nickname.as_str(), docs[1].extra.as_str()), ("Limit", "100"));
    assert_eq!(docs[2].flags.as_deref(), Some("REST_READONLY SPARK_DISABLED"));
    assert_eq!(docs[2].lines().len(), 0);
    // The only finding: a box that nobody knows, carried with its operands.
    assert_eq!(reading.diagnostics.len(), 1, "{:?}", reading.diagnostics);
    assert_eq!(reading.diagnostics[0].problem, Problem::UnknownInstruction("FANCYBOX".into()));
    assert_eq!(reading.diagnostics[0].place(), "line 95, column 1, Batch rung 12");
}

#[test]
fn text_comes_back_with_either_line_end_and_separator() {
    let crlf = SMALL.replace('\n', "\r\n");
    let blanks = SMALL.replace('\t', " ");
    let unended = SMALL.trim_end().to_owned();
    let ragged = SMALL.replace('\n', "  \n").replace("#END", "#End").replace("\nSTR\t", "\n  STR   ");
    for text in [SMALL, &crlf, &blanks, &unended, &ragged] {
        let reading = read(text).expect("readable");
        assert_eq!(write(&reading.project), text);
        let same = read(SMALL).expect("readable").project;
        assert_eq!(reading.project.parts.len(), same.parts.len());
        for (a, b) in reading.project.code_blocks().zip(same.code_blocks()) {
            assert_eq!(a, b);
        }
    }
    assert_eq!(read(&crlf).expect("readable").project.format.line_end, LineEnd::CrLf);
}

#[test]
fn a_changed_instruction_is_written_anew() {
    let mut project = read(&SMALL.replace('\t', " ")).expect("readable").project;
    for part in &mut project.parts {
        if let domore::Part::Code(block) = part
            && block.name == "$Main"
        {
            block.rungs[0].instructions[0].operands[0] = "X7".into();
            block.rungs.push(Rung::new([Instruction::new("STR", ["X8"]), Instruction::new("OUT", ["Y8"])]));
        }
    }
    let text = write(&project);
    assert!(text.contains("\nSTR\tX7\nRUN Batch\n"), "{text}");
    assert!(text.contains("\nNOP\n\nSTR\tX8\nOUT\tY8\n\n$PGMEND"), "{text}");
    assert_eq!(read(&text).expect("readable").project, project);
}
