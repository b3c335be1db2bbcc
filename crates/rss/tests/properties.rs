//! What is written reads back: archives, containers and projects of any shape.

use proptest::collection::{btree_map, vec};
use proptest::prelude::*;
use rss::archive::{Object, Reader, Writer};
use rss::program::{Branch, Instruction, Item, LadFile, Leg, ProgramFiles, Rung, mark};
use rss::verify::verify;
use rss::{Container, ImageKind, Mode, Project, StreamKind, Text, parse, serialize};
use std::borrow::Cow;

const CLASSES: [&str; 4] = ["CIns", "CBranch", "CRung", "CLadFile"];

/// One thing in an archive.
#[derive(Clone, Debug)]
enum Part {
    Object(usize),
    Null,
    /// Refers back to one of the objects so far, if any.
    Back(prop::sample::Index),
    Count(usize),
    Text(Vec<u8>),
    Number(u32),
}

fn part() -> impl Strategy<Value = Part> {
    prop_oneof![
        4 => (0..CLASSES.len()).prop_map(Part::Object),
        1 => Just(Part::Null),
        2 => any::<prop::sample::Index>().prop_map(Part::Back),
        1 => prop_oneof![0..20_usize, 0xFFF0..0x1_0010_usize].prop_map(Part::Count),
        2 => prop_oneof![9 => vec(any::<u8>(), 0..300), 1 => vec(Just(b'x'), 0xFFF0..0x1_0010)].prop_map(Part::Text),
        1 => any::<u32>().prop_map(Part::Number),
    ]
}

proptest! {
    #[test]
    fn archives_read_back(parts in vec(part(), 0..60)) {
        let mut w = Writer::new();
        let mut objects = Vec::new();
        for part in &parts {
            match part {
                Part::Object(class) => objects.push(w.object(CLASSES[*class])),
                Part::Null => w.null(),
                Part::Back(index) if objects.is_empty() => { let _ = index; }
                Part::Back(index) => w.reference(*index.get(&objects)),
                Part::Count(n) => w.count(*n).expect("fits"),
                Part::Text(bytes) => w.string(&Text::from_bytes(bytes)).expect("fits"),
                Part::Number(n) => w.u32(*n),
            }
        }
        let bytes = w.into_bytes();
        let mut r = Reader::new(&bytes, "S", Mode::Strict);
        let mut seen = Vec::new();
        for part in &parts {
            match part {
                Part::Object(class) => seen.push(r.expect_object(CLASSES[*class]).expect("the object")),
                Part::Null => prop_assert_eq!(r.object(), Ok(Object::Null)),
                Part::Back(_) if seen.is_empty() => {}
                Part::Back(index) => prop_assert_eq!(r.object(), Ok(Object::Reference { number: *index.get(&seen) })),
                Part::Count(n) => prop_assert_eq!(r.count("a count", 0), Ok(*n)),
                Part::Text(bytes) => prop_assert_eq!(r.string("text"), Ok(Text::from_bytes(bytes))),
                Part::Number(n) => prop_assert_eq!(r.u32("a number"), Ok(*n)),
            }
        }
        prop_assert_eq!(r.remaining(), 0);
        prop_assert_eq!(seen, objects);
    }

    #[test]
    fn containers_read_back(
        streams in btree_map("[A-Z]{1,3}(/[a-z0-9 ]{1,31}){0,3}/[A-Z\u{5}]{1,20}", vec(any::<u8>(), 0..6000), 0..12),
    ) {
        let mut container = Container::default();
        let mut kept = Vec::new();
        for (path, content) in &streams {
            // A stream's name may turn up as a storage of another path: such a pair no file can hold.
            let clash = |other: &String| other.starts_with(&format!("{path}/")) || path.starts_with(&format!("{other}/"));
            if !kept.iter().any(clash) {
                container.set_stream(path, content.clone());
                kept.push(path.clone());
            }
        }
        let back = Container::read(&container.write().expect("writes")).expect("reads");
        prop_assert_eq!(back.streams().count(), kept.len());
        for path in &kept {
            prop_assert_eq!(back.stream(path), streams.get(path).map(Vec::as_slice));
        }
        let mut nodes = [container.nodes, back.nodes];
        nodes.iter_mut().for_each(|n| n.sort_by(|a, b| a.path.cmp(&b.path)));
        prop_assert_eq!(&nodes[0], &nodes[1]);
    }

    #[test]
    fn programs_read_back(program in program()) {
        let bytes = serialize(&program).expect("writes");
        let parsed = parse::<ProgramFiles>(&bytes, "PROGRAM FILES/ObjectData", Mode::Strict);
        prop_assert_eq!(parsed.understood, bytes.len());
        prop_assert_eq!(&parsed.into_result(), &Ok(program));
        let mut project = Project::new();
        project.set_payload(ImageKind::Main, StreamKind::ProgramFiles, &bytes).expect("sets");
        prop_assert!(verify(&project).roundtrip);
    }

    /// Any bytes at all: read without panic, and what is read without complaint comes back.
    #[test]
    fn any_payload_is_read_or_refused(bytes in vec(any::<u8>(), 0..400)) {
        for &kind in StreamKind::NAMED {
            let mut project = Project::new();
            project.set_payload(ImageKind::Main, kind, &bytes).expect("sets");
            for s in verify(&project).streams {
                prop_assert!(s.identical || s.error.is_some() || !s.deviations.is_empty(), "{}", s.stream);
            }
        }
    }
}

fn instruction() -> impl Strategy<Value = Item<'static>> {
    (vec("[A-Z0-9:/.\\[\\]]{0,12}", 0..6), any::<bool>(), 6..0x9C_u16).prop_map(|(operands, compiled, opcode)| {
        let code = if compiled { vec![opcode as u8, 7, 8] } else { Vec::new() };
        Item::Instruction(Instruction {
            operands: operands.iter().map(|o| Text::new(o).expect("ASCII").into_owned()).collect(),
            has_code: u16::from(compiled),
            opcode,
            code: Cow::Owned(code),
            ..Instruction::default()
        })
    })
}

fn between(start: u16, items: Vec<Item<'static>>, end: u16) -> Vec<Item<'static>> {
    let bare = |opcode| Item::Instruction(Instruction { opcode, ..Instruction::default() });
    [vec![bare(start)], items, vec![bare(end)]].concat()
}

fn item() -> impl Strategy<Value = Item<'static>> {
    instruction().prop_recursive(4, 40, 4, |inner| {
        let leg =
            vec(inner, 0..4).prop_map(|items| Item::Leg(Leg { items: between(mark::LEG_START, items, mark::LEG_END) }));
        vec(leg, 2..4)
            .prop_map(|legs| Item::Branch(Branch { items: between(mark::BRANCH_START, legs, mark::BRANCH_END) }))
    })
}

fn program() -> impl Strategy<Value = ProgramFiles<'static>> {
    let rung = (vec(item(), 0..5), 0..2_u32, any::<u32>()).prop_map(|(items, edited, comment_id)| Rung {
        leg: Leg { items: between(mark::RUNG_START, items, mark::RUNG_END) },
        edited,
        comment_id,
        ..Rung::default()
    });
    vec((vec(rung, 0..6), any::<u16>(), any::<[u8; 10]>(), "[ -~]{0,300}"), 0..5).prop_map(|files| {
        let files = files.into_iter().enumerate().map(|(i, (rungs, flags, name, description))| LadFile {
            rung_count: u16::try_from(rungs.len()).expect("few"),
            flags,
            name,
            number: u16::try_from(i).expect("few"),
            description: Text::new(&description).expect("ASCII").into_owned(),
            rungs,
        });
        ProgramFiles { files: files.collect() }
    })
}
