//! Do-more programs side by side: edits made by a seeded generator are found as exactly these edits.

use std::path::Path;

use analysis::diff::{ChangeKind, Difference, EditKind, LogicChange, RungChange, compare_domore};
use domore::address::Address;
use domore::instruction::{Effect, Evidence, Join, by_mnemonic};
use domore::program::{Part, Row};
use domore::{CodeBlock, Instruction, Project, Rung};
use ladder::Source;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

fn text(text: &str) -> Project {
    domore::text::read(text).expect("a program").project
}

fn file(path: &Path) -> Project {
    let bytes = std::fs::read(path).expect("a file");
    convert::designer::from_bytes(&bytes, Source::default()).expect("a program").project
}

fn repository(path: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

fn migrated(path: &Path) -> Option<Project> {
    let bytes = std::fs::read(path).ok()?;
    let read = rss::Project::read(&bytes, rss::Mode::Permissive).ok()?;
    let image = convert::from_rss::project(&read, Source::default()).main;
    Some(convert::migrate::migrate(&image, &[], &convert::migrate::Options::default()).ok()?.project)
}

/// Programs of our own making, written by hand and migrated.
fn examples() -> Vec<Project> {
    let mut all: Vec<Project> = ["crates/domore/tests/data/small.txt", "examples/filling_domore/filling.txt"]
        .iter()
        .map(|path| file(&repository(path)))
        .collect();
    let projects = ["motor/motor.RSS", "batch/batch.RSS", "traffic_light/traffic_light.RSS"];
    all.extend(projects.iter().filter_map(|path| migrated(&repository("examples").join(path))));
    all
}

struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % limit.max(1)
    }
}

#[derive(Clone, Copy, Debug)]
enum Seeded {
    Insert,
    Delete,
    Move,
    Operand,
    Contact,
    Rename,
    NameBlock,
}

const KINDS: [Seeded; 7] =
    [Seeded::Insert, Seeded::Delete, Seeded::Move, Seeded::Operand, Seeded::Contact, Seeded::Rename, Seeded::NameBlock];

type Check = Box<dyn Fn(&Difference) -> bool>;

fn blocks(project: &mut Project) -> Vec<&mut CodeBlock> {
    let blocks = project.parts.iter_mut().filter_map(|part| match part {
        Part::Code(block) => Some(block),
        _ => None,
    });
    blocks.collect()
}

fn changed_rungs(difference: &Difference) -> Vec<&RungChange> {
    let rungs = difference.logic.iter().filter_map(|change| match change {
        LogicChange::Rung(rung) => Some(&**rung),
        LogicChange::File(_) => None,
    });
    rungs.collect()
}

/// Exactly one rung, and no code block.
fn only(difference: &Difference, kind: ChangeKind) -> Option<&RungChange> {
    match (changed_rungs(difference).as_slice(), difference.logic.len()) {
        ([rung], 1) if rung.kind == kind && difference.renames.is_empty() => Some(rung),
        _ => None,
    }
}

/// A control relay that no program uses.
fn fresh(random: &mut Random) -> String {
    format!("C{}", 1900 + random.below(100))
}

/// Operands that name one element of a block, not in brackets or quotes.
fn element(operand: &str) -> Option<(String, u32)> {
    match Address::parse(operand).ok()?.element {
        domore::address::Element::Numbered { block, number, .. } => Some((block, number)),
        _ => None,
    }
}

fn edit(project: &mut Project, kind: Seeded, random: &mut Random) -> Option<Check> {
    let mut all = blocks(project);
    let places: Vec<usize> = (0..all.len()).filter(|index| all[*index].rungs.len() > 1).collect();
    let chosen = *places.get(random.below(places.len()))?;
    let number = chosen as u16 + 1;
    let name = all[chosen].name.clone();
    let rungs = &mut all[chosen].rungs;
    let at = random.below(rungs.len());
    let place = move |found: Option<analysis::diff::Place>, rung: usize| {
        found.is_some_and(|found| found.file == number && found.rung == rung)
    };
    match kind {
        Seeded::Insert => {
            let mut new = rungs[random.below(rungs.len())].clone();
            new.comment = None;
            let effect = |it: &Instruction| by_mnemonic(&it.mnemonic).map(|entry| entry.effect);
            match new.instructions.last().and_then(effect) {
                Some(Effect::Output) => new.instructions.push(Instruction::new("OUT", [fresh(random)])),
                _ => {
                    new =
                        Rung::new([Instruction::new("STR", [fresh(random)]), Instruction::new("OUT", [fresh(random)])])
                }
            }
            rungs.insert(at, new);
            Some(Box::new(move |found| only(found, ChangeKind::Inserted).is_some_and(|rung| place(rung.new, at))))
        }
        Seeded::Delete => {
            let gone = rungs.remove(at);
            let old = rungs.clone();
            Some(Box::new(move |found| {
                only(found, ChangeKind::Deleted).and_then(|rung| rung.old).is_some_and(|found| {
                    // Of equal neighbours any may be the one that is gone.
                    let between = found.rung.min(at)..found.rung.max(at);
                    old.get(between)
                        .is_some_and(|rungs| rungs.iter().all(|rung| rung.instructions == gone.instructions))
                })
            }))
        }
        Seeded::Move => {
            let to = random.below(rungs.len());
            let before = rungs.clone();
            let rung = rungs.remove(at);
            rungs.insert(to, rung);
            if before.iter().zip(rungs.iter()).all(|(a, b)| a.instructions == b.instructions) {
                return None;
            }
            Some(Box::new(move |found| {
                only(found, ChangeKind::Moved).is_some_and(|rung| {
                    let exact = place(rung.old, at) && place(rung.new, to);
                    let swapped = at.abs_diff(to) == 1 && place(rung.old, to) && place(rung.new, at);
                    let twin = rung.old.is_some_and(|old| before[old.rung].instructions == before[at].instructions);
                    (exact || swapped || twin) && rung.edits.is_empty()
                })
            }))
        }
        Seeded::Operand => {
            let index = random.below(rungs[at].instructions.len());
            let instruction = rungs[at].instructions.get_mut(index)?;
            let operand = random.below(instruction.operands.len());
            let written = instruction.operands.get_mut(operand)?;
            let (block, _) = element(written)?;
            let old = written.clone();
            let tail = written.find(['.', ':']).map_or("", |at| &old[at..]);
            *written = format!("{block}{}{tail}", 230 + random.below(20));
            let new = written.clone();
            Some(Box::new(move |found| {
                only(found, ChangeKind::Changed).is_some_and(|rung| {
                    let [edit] = rung.edits.as_slice() else { return false };
                    place(rung.old, at)
                        && edit.kind == EditKind::Operand
                        && edit.operand == Some(operand)
                        && edit.old_instruction.map(|number| number as usize) == Some(index)
                        && (&edit.old, &edit.new) == (&old, &new)
                })
            }))
        }
        // A contact in front of all others: the one that began the rung now continues it.
        Seeded::Contact => {
            let instructions = &mut rungs[at].instructions;
            let first = instructions.first_mut()?;
            let Effect::Contact { join: Join::Push, test } = by_mnemonic(&first.mnemonic)?.effect else { return None };
            let second = Effect::Contact { join: Join::And, test };
            first.mnemonic = domore::instruction::TABLE
                .iter()
                .find(|entry| entry.effect == second && entry.evidence <= Evidence::Inferred)?
                .mnemonic
                .to_owned();
            // Where another way begins, in front is not all of the rung.
            let others = instructions.iter().skip(1).filter_map(|it| by_mnemonic(&it.mnemonic));
            let splits =
                |effect| matches!(effect, Effect::Contact { join: Join::Push | Join::Or, .. } | Effect::Parallel);
            if others.map(|entry| entry.effect).any(splits) {
                return None;
            }
            instructions.insert(0, Instruction::new("STR", [fresh(random)]));
            Some(Box::new(move |found| {
                only(found, ChangeKind::Changed).is_some_and(|rung| {
                    let kinds: Vec<EditKind> = rung.edits.iter().map(|edit| edit.kind).collect();
                    place(rung.new, at) && kinds == [EditKind::Inserted]
                })
            }))
        }
        Seeded::Rename => {
            let used: Vec<(String, u32)> = all
                .iter()
                .flat_map(|block| &block.rungs)
                .flat_map(|rung| &rung.instructions)
                .flat_map(|it| it.operands.iter().filter_map(|operand| element(operand)))
                .filter(|(block, _)| !matches!(block.as_str(), "ST" | "DST" | "SDT"))
                .collect();
            let (block, number) = used.get(random.below(used.len()))?.clone();
            let new = 230 + random.below(20) as u32;
            let mut operands = 0;
            for rung in all.iter_mut().flat_map(|block| &mut block.rungs) {
                for written in rung.instructions.iter_mut().flat_map(|it| &mut it.operands) {
                    let old = written.clone();
                    if element(&old) == Some((block.clone(), number)) {
                        let tail = written.find(['.', ':']).map_or("", |at| &old[at..]);
                        *written = format!("{block}{new}{tail}");
                        operands += 1;
                    } else if old.contains(&format!("{block}{number}")) {
                        return None;
                    }
                }
            }
            let names = (format!("{block}{number}"), format!("{block}{new}"));
            if operands < 2 || used.contains(&(block, new)) {
                return None;
            }
            Some(Box::new(move |found| {
                let [rename] = found.renames.as_slice() else { return false };
                (&rename.old, &rename.new) == (&names.0, &names.1)
                    && changed_rungs(found).iter().all(|rung| rung.only_rename && rung.kind == ChangeKind::Changed)
            }))
        }
        Seeded::NameBlock => {
            if name.starts_with('$') || name.is_empty() {
                return None;
            }
            let new = format!("{name}New");
            for block in &mut all {
                for operand in
                    block.rungs.iter_mut().flat_map(|rung| &mut rung.instructions).flat_map(|it| &mut it.operands)
                {
                    if *operand == name {
                        operand.clone_from(&new);
                    } else if let Some(stage) = operand.strip_prefix(&format!("{name}.")) {
                        *operand = format!("{new}.{stage}");
                    }
                }
            }
            all[chosen].name.clone_from(&new);
            Some(Box::new(move |found| {
                let files: Vec<_> = found.logic.iter().filter(|it| matches!(it, LogicChange::File(_))).collect();
                let moved = |change: &&LogicChange| {
                    matches!(change, LogicChange::File(it) if it.kind == ChangeKind::Moved
                        && (it.old, it.new) == (Some(number), Some(number)))
                };
                files.len() == 1 && files.iter().all(moved) && changed_rungs(found).iter().all(|rung| rung.only_rename)
            }))
        }
    }
}

fn seeded(programs: &[Project], edits: usize, seed: u64) {
    let mut random = Random(seed);
    let (mut made, mut right, mut tried) = (0, 0, 0);
    let mut wrong = Vec::new();
    while made < edits && tried < edits * 40 {
        let kind = KINDS[tried % KINDS.len()];
        tried += 1;
        let which = random.below(programs.len());
        let old = &programs[which];
        let mut new = old.clone();
        let Some(check) = edit(&mut new, kind, &mut random) else { continue };
        let found = compare_domore(old, &new);
        assert!(!found.logic.is_empty(), "program {which}: {kind:?} went unseen");
        made += 1;
        if check(&found) {
            right += 1;
        } else {
            wrong.push(format!("program {which}: {kind:?}: {:?} {:?}", found.renames, found.logic));
        }
    }
    eprintln!("{right} of {made} edits found as what they are");
    assert!(made == edits, "only {made} edits could be made");
    assert!(right * 100 >= made * 99, "{right} of {made}:\n{}", wrong.join("\n"));
}

#[test]
fn edits_of_examples_are_found_as_what_they_are() {
    seeded(&examples(), 700, 7);
}

#[test]
fn edits_of_migrated_programs_are_found_as_what_they_are() {
    let Some(root) = corpus::root() else { return };
    let all = corpus::files(&root, ".rss").expect("the corpus can be listed");
    let programs: Vec<Project> = all.iter().step_by(17).filter_map(|path| migrated(path)).collect();
    seeded(&programs, 700, 3);
}

#[test]
fn every_program_equals_itself() {
    let mut programs = examples();
    if let Some(root) = corpus::root() {
        programs.extend(corpus::files(&root.join("domore"), ".txt").expect("a list").iter().map(|path| file(path)));
    }
    for project in &programs {
        let again = text(&domore::text::write(project));
        let found = compare_domore(project, &again);
        assert!(found.is_empty() && found.notes.is_empty(), "{found:?}");
    }
}

const BASE: &str = "PLC DM-SIM\n\n$PRGRM $Main\n\nSTR X0\nOR X1\nANDN C5\nOUT Y0\n\nSTR C1\nTMR T0 500\n\n$PGMEND $Main\n\n\
     #BEGIN ELEMENT_DOC\n\"C5\",\"FLAGS =\",\"Stop\",\"\",\"stop\"\n\"SK0\",\"FLAGS =\",\"Limit\",\"500\",\"\"\n#END\n";

fn kinds(difference: &Difference) -> Vec<EditKind> {
    changed_rungs(difference).iter().flat_map(|rung| rung.edits.iter().map(|edit| edit.kind)).collect()
}

#[test]
fn changes_are_told_the_way_a_ladder_reads() {
    let old = text(BASE);
    for (from, to, expected) in [
        ("ANDN C5", "AND C5", vec![EditKind::Instruction]),
        ("OUT Y0", "OUT Y7", vec![EditKind::Operand]),
        ("TMR T0 500", "TMR T0 600", vec![EditKind::Operand]),
        ("STR C1", "STR X9\nAND C1", vec![EditKind::Inserted]),
        ("STR X0\nOR X1", "STR X0\nAND X1", vec![EditKind::Branches]),
        // One drawing in two spellings: the text that runs is not the same.
        ("STR X0\nOR X1", "STR X0\nSTR X1\nORSTR", vec![EditKind::Branches]),
    ] {
        assert!(BASE.contains(from));
        let found = compare_domore(&old, &text(&BASE.replace(from, to)));
        assert_eq!(kinds(&found), expected, "{from} -> {to}: {found:?}");
        assert!(found.documentation.is_empty() && found.configuration.is_empty(), "{found:?}");
    }
}

#[test]
fn spelling_is_no_logic() {
    let old = text(BASE);
    for (from, to) in [("ANDN C5", "ANDN Stop"), ("ANDN C5", "andn c5"), ("500", "0x1F4"), ("X0", "x0")] {
        let new = text(&BASE.replacen(from, to, 1));
        let found = compare_domore(&old, &new);
        assert!(found.logic.is_empty(), "{from} -> {to}: {found:?}");
    }
}

#[test]
fn a_nickname_that_moved_changes_the_rungs_that_use_it() {
    let old = BASE.replace("ANDN C5", "ANDN Stop");
    let new = old.replace("\"C5\"", "\"C6\"");
    let found = compare_domore(&text(&old), &text(&new));
    let rung = only(&found, ChangeKind::Changed).expect("one rung");
    assert_eq!((&*rung.edits[0].old, &*rung.edits[0].new), ("Stop (C5)", "Stop (C6)"));
    let constant = BASE.replace("TMR T0 500", "TMR T0 Limit");
    let found = compare_domore(&text(&constant), &text(&constant.replace("\"Limit\",\"500\"", "\"Limit\",\"700\"")));
    let rung = only(&found, ChangeKind::Changed).expect("one rung");
    assert_eq!((&*rung.edits[0].old, &*rung.edits[0].new), ("Limit (SK0=500)", "Limit (SK0=700)"));
    assert_eq!(found.configuration.len(), 1, "{found:?}");
}

#[test]
fn documentation_and_configuration_are_apart_from_logic() {
    let old = text(BASE);
    let named = |change: &analysis::diff::Change| format!("{} {}", change.what, change.name);
    for (from, to, documentation, configuration) in [
        ("\"stop\"", "\"halt\"", "description C5", ""),
        ("\"Stop\"", "\"Halt\"", "nickname C5", ""),
        ("STR X0", "#BEGIN COMMENT\n\"seal-in\"\n#END\n\nSTR X0", "rung comment $Main:1", ""),
        ("PLC DM-SIM", "PLC BX-DM1E", "", "controller model"),
        ("$PRGRM", "#BEGIN MEM_CONFIG\n\tN\tSWORD\tdecimal\t99\n#END\n\n$PRGRM", "", "memory N"),
        ("$PRGRM", "#BEGIN SYS_CONFIG\n00ff\n#END\n\n$PRGRM", "", "section SYS_CONFIG"),
    ] {
        let new = text(&BASE.replacen(from, to, 1));
        let found = compare_domore(&old, &new);
        assert!(found.logic.is_empty() && found.values.is_empty() && found.values_left_out, "{found:?}");
        assert_eq!(found.documentation.iter().map(named).collect::<Vec<_>>().join(", "), documentation, "{to}");
        assert_eq!(found.configuration.iter().map(named).collect::<Vec<_>>().join(", "), configuration, "{to}");
        assert!(!compare_domore(&new, &old).is_empty());
    }
    let plain = BASE.replace("STR X0", "#BEGIN COMMENT\n\"bold\"\n#END\n\nSTR X0");
    let formatted = BASE.replace("STR X0", "#BEGIN FMT_COMMENT\n\"<B>bold</B>\"\n#END\n\nSTR X0");
    let found = compare_domore(&text(&plain), &text(&formatted));
    assert_eq!(found.documentation.iter().map(named).collect::<Vec<_>>(), ["rung comment format $Main:1"]);
}

#[test]
fn code_blocks_come_go_and_change_places() {
    let second = "$LGCMOD Report\n\nSTR ST1\nMATH D0 \"D1 + 1\"\n\n$LGCEND Report\n\n";
    let with = BASE.replace("#BEGIN ELEMENT_DOC", &format!("{second}#BEGIN ELEMENT_DOC"));
    let before = BASE.replace("$PRGRM $Main", &format!("{second}$PRGRM $Main"));
    let found = compare_domore(&text(BASE), &text(&with));
    assert!(
        matches!(found.logic.first(), Some(LogicChange::File(it)) if it.kind == ChangeKind::Inserted && it.new == Some(2))
    );
    assert_eq!(found.logic.len(), 1, "{found:?}");
    let found = compare_domore(&text(&with), &text(&before));
    assert!(found.logic.is_empty(), "{found:?}");
    let order: Vec<_> = found.configuration.iter().map(|it| (it.what, it.old.as_deref(), it.new.as_deref())).collect();
    assert_eq!(order, [("code blocks", Some("$Main\nReport"), Some("Report\n$Main"))]);
    let task = with.replace("$LGCMOD", "$TSK").replace("$LGCEND", "$TSKEND");
    let found = compare_domore(&text(&with), &text(&task));
    assert_eq!(found.configuration.first().map(|it| it.what), Some("code block kind"), "{found:?}");
}

/// Lines nobody understands are compared too: nothing is equal that was not looked at.
#[test]
fn lines_that_were_not_understood_are_differences() {
    let old = BASE.replace("PLC DM-SIM", "PLC DM-SIM\nWHAT IS THIS");
    let found = compare_domore(&text(BASE), &text(&old));
    assert!(!found.is_empty(), "{found:?}");
    let rows = |project: &Project| {
        let documentation = project.parts.iter().filter_map(|part| match part {
            Part::Documentation(section) => Some(&section.rows),
            _ => None,
        });
        documentation.flatten().filter(|row| matches!(row, Row::Unread(_))).count()
    };
    let broken = text(&BASE.replace("#END", "no quotes\n#END"));
    assert_eq!(rows(&broken), 1);
    assert!(!compare_domore(&text(BASE), &broken).is_empty());
}
