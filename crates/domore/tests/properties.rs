//! Any rung and any text: what is made comes back, what is read comes back, nothing panics.

use domore::circuit::{Node, circuit};
use domore::program::{CodeBlock, CodeKind, Comment, CommentKind, ElementDoc, MemoryBlock, Radix, Section};
use domore::stack;
use domore::text::{read, write};
use domore::{Instruction, Part, Project, Rung};
use proptest::prelude::*;

/// A random way of contacts: series of contacts and groups in parallel.
#[derive(Clone, Debug)]
enum Way {
    Contact(usize, u16),
    Parallel(Vec<Vec<Way>>),
}

const TESTS: [(&str, bool); 6] = [("", false), ("N", false), ("PD", false), ("ND", false), ("GE", true), ("NE", true)];

fn ways() -> impl Strategy<Value = Vec<Way>> {
    let contact = (0..TESTS.len(), 0_u16..100).prop_map(|(test, bit)| Way::Contact(test, bit));
    let way = contact.prop_recursive(4, 24, 4, |inner| {
        let leg = prop::collection::vec(inner, 1..4);
        prop::collection::vec(leg, 2..4).prop_map(Way::Parallel)
    });
    prop::collection::vec(way, 1..4)
}

/// The stack program of a way.
fn emit(ways: &[Way], out: &mut Vec<Instruction>) {
    for (index, way) in ways.iter().enumerate() {
        match way {
            Way::Contact(test, bit) => {
                let (suffix, pair) = TESTS[*test];
                let mnemonic = format!("{}{suffix}", if index == 0 { "STR" } else { "AND" });
                let operands = if pair { vec![format!("N{bit}"), "5".into()] } else { vec![format!("C{bit}")] };
                out.push(Instruction::new(mnemonic, operands));
            }
            Way::Parallel(legs) => {
                for (number, leg) in legs.iter().enumerate() {
                    emit(leg, out);
                    if number > 0 {
                        out.push(Instruction::new("ORSTR", [""; 0]));
                    }
                }
                if index > 0 {
                    out.push(Instruction::new("ANDSTR", [""; 0]));
                }
            }
        }
    }
}

/// Contacts of a circuit in the order of the text.
fn contacts(nodes: &[Node], found: &mut Vec<usize>) {
    for node in nodes {
        match node {
            Node::Instruction(index) => found.push(*index),
            Node::Branch(legs) => legs.iter().for_each(|leg| contacts(leg, found)),
            Node::Box { index, legs } => {
                legs.iter().for_each(|leg| contacts(leg, found));
                found.push(*index);
            }
        }
    }
}

fn rung() -> impl Strategy<Value = Rung> {
    let comment = prop::option::of((any::<bool>(), prop::collection::vec("[ -~é]{0,20}", 0..3)));
    (prop::collection::vec(ways(), 3), 0_usize..5, comment).prop_map(|(legs, form, comment)| {
        let mut instructions = Vec::new();
        let boxes =
            [("CNT", 2, vec!["CT0", "10"]), ("UDC", 3, vec!["CT1", "N1", "DST511"]), ("TMRA", 2, vec!["T1", "5000"])];
        match boxes.get(form) {
            Some((mnemonic, count, operands)) => {
                legs.iter().take(*count).for_each(|leg| emit(leg, &mut instructions));
                instructions.push(Instruction::new(*mnemonic, operands.iter().copied()));
            }
            None => {
                emit(&legs[0], &mut instructions);
                instructions.push(Instruction::new("OUT", ["Y0"]));
                if form == 4 {
                    instructions.push(Instruction::new("NOT", [""; 0]));
                    instructions.push(Instruction::new("MATH", ["N0", "\"N1 * 2 + \"\"\""]));
                }
            }
        }
        let comment = comment.map(|(formatted, lines)| Comment {
            kind: if formatted { CommentKind::Formatted } else { CommentKind::Plain },
            lines,
            ..Comment::default()
        });
        Rung { comment, instructions }
    })
}

/// A line of anything, most of it from the vocabulary of the form.
fn line() -> impl Strategy<Value = String> {
    const WORDS: [&str; 34] = [
        "",
        "  ",
        "// note",
        "PLC DM-SIM",
        "#BEGIN COMMENT ",
        "#BEGIN MEM_CONFIG",
        "#BEGIN DEVICE",
        "#BEGIN SYS_CONFIG",
        "#BEGIN ELEMENT_DOC",
        "#BEGIN WHAT",
        "#END",
        "#End ",
        "$PRGRM A",
        "$PGMEND A",
        "$PRGRM\t$Main",
        "$PGMEND\t$Main",
        "$LGCMOD B",
        "$LGCEND B",
        "$ODD C",
        "STR X0",
        "STR\tX1",
        "AND X2",
        "OUT Y0",
        "ORSTR",
        "NOT",
        "NOP",
        "SG A.S0",
        "MATH N0 \"1 + 2",
        "CNT CT0 5",
        "\"quoted\"",
        "\"X0\",\"FLAGS =\",\"a\",\"\",\"\"",
        "\tX\tBIT\tdecimal\t2048\t-1",
        "\t@Int, 1, 2",
        "\tDLX\tBIT\toctal\t01000",
    ];
    prop_oneof![
        8 => prop::sample::select(WORDS.to_vec()).prop_map(str::to_owned),
        1 => "[ -~\t]{0,30}",
        1 => "[^\r\n\u{0}-\u{8}\u{b}-\u{1f}\u{7f}]{0,12}",
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn rungs_come_back(rungs in prop::collection::vec(rung(), 0..6), kind in 0_usize..4) {
        for rung in &rungs {
            prop_assert_eq!(stack::check(rung, false), vec![]);
            let nodes = circuit(rung).expect("contacts between rails");
            let mut found = Vec::new();
            contacts(&nodes, &mut found);
            let joins = |it: &Instruction| it.is("ORSTR") || it.is("ANDSTR");
            let all: Vec<usize> = (0..rung.instructions.len()).filter(|i| !joins(&rung.instructions[*i])).collect();
            prop_assert_eq!(found, all, "every instruction stands in the drawing, in its order");
        }
        let kinds = [CodeKind::Program, CodeKind::Subroutine, CodeKind::Task, CodeKind::Interrupt];
        let block = CodeBlock { kind: kinds[kind].clone(), name: "Block".into(), rungs, ..CodeBlock::default() };
        let memory = MemoryBlock { name: "DLX".into(), type_word: "BIT".into(), radix: Some(Radix::Octal), count: 512, ..MemoryBlock::default() };
        let doc = ElementDoc { element: "X0".into(), flags: Some(String::new()), nickname: "Start".into(), description: vec!["a \"b\", c".into()], ..ElementDoc::default() };
        let parts = vec![Part::Memory(Section::new([memory])), Part::Code(block), Part::Documentation(Section::new([doc]))];
        let project = Project { parts, ..Project::default() };
        let text = write(&project);
        let reading = read(&text).expect("readable");
        prop_assert_eq!(&reading.project, &project, "{}", text);
        prop_assert_eq!(&reading.diagnostics, &vec![], "{}", text);
        prop_assert_eq!(write(&reading.project), text);
    }

    #[test]
    fn any_lines_come_back(lines in prop::collection::vec(line(), 0..40), crlf: bool, ended: bool) {
        let end = if crlf { "\r\n" } else { "\n" };
        let mut text = lines.join(end);
        if ended && !text.is_empty() {
            text.push_str(end);
        }
        let reading = read(&text).expect("readable");
        prop_assert_eq!(write(&reading.project), text);
        // Without the memory of how it was written it says the same.
        for block in reading.project.code_blocks() {
            for rung in &block.rungs {
                let _ = circuit(rung);
            }
        }
    }
}
