//! Edits made by a seeded generator on real programs are found as exactly these edits.

use std::path::Path;

use analysis::diff::{ChangeKind, Difference, EditKind, LogicChange, RungChange, Side, compare};
use ladder::{
    Address, Branch, DataFile, Element, FileType, Image, Instruction, Mnemonic, Operand, Place, Project, Rung, Series,
    Source,
};
use rss::Mode;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

fn read(path: &Path) -> Option<Project> {
    let bytes = std::fs::read(path).ok()?;
    let file = rss::Project::read(&bytes, Mode::Permissive).ok()?;
    Some(convert::from_rss::project(&file, Source::default()))
}

fn examples() -> Vec<Project> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    ["motor/motor.RSS", "batch/batch.RSS", "traffic_light/traffic_light.RSS"]
        .iter()
        .map(|name| read(&folder.join(name)).expect("an example"))
        .collect()
}

fn difference(old: &Image, new: &Image) -> Difference {
    let side = |image| Side { image, documentation: Some(&image.documentation) };
    compare(side(old), side(new))
}

/// A small generator of its own: the same edits in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % limit.max(1)
    }
}

/// Addresses no program uses.
fn fresh(kind: FileType, random: &mut Random) -> Address {
    Address::element(kind, 240 + random.below(10) as u16, 900 + random.below(90) as u16)
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Seeded {
    Insert,
    Delete,
    Move,
    Operand,
    Branch,
    Rename,
    Renumber,
}

const KINDS: [Seeded; 7] =
    [Seeded::Insert, Seeded::Delete, Seeded::Move, Seeded::Operand, Seeded::Branch, Seeded::Rename, Seeded::Renumber];

/// A check of a difference, made together with an edit.
type Check = Box<dyn Fn(&Difference) -> bool>;

fn changed_rungs(difference: &Difference) -> Vec<&RungChange> {
    let rungs = difference.logic.iter().filter_map(|change| match change {
        LogicChange::Rung(rung) => Some(&**rung),
        LogicChange::File(_) => None,
    });
    rungs.collect()
}

/// Exactly one rung, and no program file.
fn only(difference: &Difference, kind: ChangeKind) -> Option<&RungChange> {
    match (changed_rungs(difference).as_slice(), difference.logic.len()) {
        ([rung], 1) if rung.kind == kind && difference.renames.is_empty() => Some(rung),
        _ => None,
    }
}

/// Every instruction of a series, branches included.
fn each_operand(series: &mut Series, work: &mut dyn FnMut(&mut Operand)) {
    for element in series {
        match element {
            Element::Instruction(instruction) => instruction.operands.iter_mut().for_each(&mut *work),
            Element::Branch(branch) => branch.legs.iter_mut().for_each(|leg| each_operand(leg, work)),
        }
    }
}

fn instructions(series: &mut Series) -> Vec<&mut Instruction> {
    let mut found = Vec::new();
    for element in series {
        match element {
            Element::Instruction(instruction) => found.push(instruction),
            Element::Branch(branch) => found.extend(branch.legs.iter_mut().flat_map(instructions)),
        }
    }
    found
}

/// Makes one edit; `None` where the program offers none.
fn edit(image: &mut Image, kind: Seeded, random: &mut Random) -> Option<Check> {
    let files: Vec<usize> = (0..image.program_files.len())
        .filter(|index| image.program_files[*index].rungs.iter().filter(|rung| !rung.is_end()).count() > 1)
        .collect();
    if files.is_empty() {
        return None;
    }
    let file = files[random.below(files.len())];
    let number = image.program_files[file].number;
    let rungs = &mut image.program_files[file].rungs;
    let count = rungs.iter().filter(|rung| !rung.is_end()).count();
    let at = random.below(count);
    let place = move |found: Option<analysis::diff::Place>, rung: usize| {
        found.is_some_and(|found| found.file == number && found.rung == rung)
    };
    match kind {
        Seeded::Insert => {
            let mut new = rungs[random.below(count)].clone();
            let coil = Instruction::new(
                Mnemonic::named("OTE"),
                vec![Operand::Address(fresh(FileType::B, random).with_bit(3))],
            );
            new.series.push(Element::Instruction(coil));
            rungs.insert(at, new);
            Some(Box::new(move |found| only(found, ChangeKind::Inserted).is_some_and(|rung| place(rung.new, at))))
        }
        Seeded::Delete => {
            let gone = rungs.remove(at);
            let old = rungs.clone();
            Some(Box::new(move |found| {
                // Of equal neighbours any may be the one that is gone.
                only(found, ChangeKind::Deleted).and_then(|rung| rung.old).is_some_and(|found| {
                    let between = found.rung.min(at)..found.rung.max(at);
                    old.get(between).is_some_and(|rungs| rungs.iter().all(|rung| rung.same_logic(&gone)))
                })
            }))
        }
        Seeded::Move => {
            let to = random.below(count);
            let before = rungs.clone();
            let rung = rungs.remove(at);
            rungs.insert(to, rung);
            if before.iter().zip(rungs.iter()).all(|(a, b)| a.same_logic(b)) {
                return None;
            }
            // Two neighbours that changed places: either one moved.
            Some(Box::new(move |found| {
                only(found, ChangeKind::Moved).is_some_and(|rung| {
                    let exact = place(rung.old, at) && place(rung.new, to);
                    let swapped = at.abs_diff(to) == 1 && place(rung.old, to) && place(rung.new, at);
                    let twin = rung.old.is_some_and(|old| before[old.rung].same_logic(&before[at]));
                    (exact || swapped || twin) && rung.edits.is_empty()
                })
            }))
        }
        Seeded::Operand => {
            let mut all = instructions(&mut rungs[at].series);
            let chosen = random.below(all.len());
            let instruction = all.get_mut(chosen)?;
            let index = random.below(instruction.operands.len());
            let operand = instruction.operands.get_mut(index)?;
            let Operand::Address(address) = operand else { return None };
            if !address.is_direct() || address.file_type.has_slots() {
                return None;
            }
            let new = fresh(address.file_type, random);
            *operand = Operand::Address(Address { file: new.file, element: new.element, ..address.clone() });
            let new = operand.to_string();
            Some(Box::new(move |found| {
                only(found, ChangeKind::Changed).is_some_and(|rung| {
                    let [edit] = rung.edits.as_slice() else { return false };
                    place(rung.old, at)
                        && place(rung.new, at)
                        && edit.kind == EditKind::Operand
                        && edit.operand == Some(index)
                        && edit.old_instruction.map(|number| number as usize) == Some(chosen)
                        && edit.new == new
                })
            }))
        }
        Seeded::Branch => {
            let series = &mut rungs[at].series;
            let index = random.below(series.len());
            let contact = Instruction::new(
                Mnemonic::named("XIC"),
                vec![Operand::Address(fresh(FileType::B, random).with_bit(7))],
            );
            let leg = vec![Element::Instruction(contact)];
            match series.get_mut(index)? {
                Element::Branch(branch) => branch.legs.push(leg),
                element => {
                    let inside = element.clone();
                    *element = Element::Branch(Branch { legs: vec![vec![inside], leg] });
                }
            }
            Some(Box::new(move |found| {
                only(found, ChangeKind::Changed).is_some_and(|rung| {
                    let kinds: Vec<EditKind> = rung.edits.iter().map(|edit| edit.kind).collect();
                    place(rung.old, at) && place(rung.new, at) && kinds == [EditKind::Inserted, EditKind::Branches]
                })
            }))
        }
        Seeded::Rename => {
            let all: Vec<Address> = analysis::instructions(image)
                .flat_map(|(_, instruction)| &instruction.operands)
                .filter_map(Operand::address)
                .filter(|address| !address.file_type.has_slots())
                .filter_map(Address::element_address)
                .collect();
            let old = all.get(random.below(all.len()))?.clone();
            let new = fresh(old.file_type, random);
            let mut operands = 0;
            for file in &mut image.program_files {
                for rung in &mut file.rungs {
                    each_operand(&mut rung.series, &mut |operand| {
                        if let Operand::Address(address) = operand
                            && address.element_address().as_ref() == Some(&old)
                            && address.bit.as_ref().is_none_or(|bit| matches!(bit, Place::Number(_)))
                        {
                            (address.file, address.element) = (new.file.clone(), new.element.clone());
                            operands += usize::from(!address.indexed);
                        }
                    });
                }
            }
            // Inside brackets and expressions it stays, and a single use is a changed operand.
            let gone = analysis::instructions(image)
                .all(|(_, instruction)| instruction.operands.iter().all(|o| !o.to_string().contains(&old.to_string())));
            if operands < 2 || !gone {
                return None;
            }
            let names = (old.to_string(), new.to_string());
            Some(Box::new(move |found| {
                let [rename] = found.renames.as_slice() else { return false };
                (&rename.old, &rename.new) == (&names.0, &names.1)
                    && changed_rungs(found).iter().all(|rung| rung.only_rename && rung.kind == ChangeKind::Changed)
            }))
        }
        Seeded::Renumber => {
            let free = (3..255).rev().find(|free| image.program_files.iter().all(|file| file.number != *free))?;
            if number < 3 {
                return None;
            }
            image.program_files[file].number = free;
            for rung in image.program_files.iter_mut().flat_map(|file| &mut file.rungs) {
                each_operand(&mut rung.series, &mut |operand| {
                    if *operand == Operand::ProgramFile(number) {
                        *operand = Operand::ProgramFile(free);
                    }
                });
            }
            Some(Box::new(move |found| {
                let files = found.logic.iter().filter(|change| matches!(change, LogicChange::File(_)));
                let moved = files.clone().all(|change| match change {
                    LogicChange::File(change) => {
                        (change.kind, change.old, change.new) == (ChangeKind::Moved, Some(number), Some(free))
                    }
                    LogicChange::Rung(_) => false,
                });
                moved && files.count() == 1 && changed_rungs(found).iter().all(|rung| rung.only_rename)
            }))
        }
    }
}

/// Runs this many edits over the programs; at least 99 of 100 must be found as what they are, and none
/// may go unseen.
fn seeded(programs: &[Image], edits: usize, seed: u64) {
    let mut random = Random(seed);
    let (mut made, mut right, mut tried) = (0, 0, 0);
    let mut wrong = Vec::new();
    while made < edits && tried < edits * 20 {
        let kind = KINDS[tried % KINDS.len()];
        tried += 1;
        let which = random.below(programs.len());
        let old = &programs[which];
        let mut new = old.clone();
        let Some(check) = edit(&mut new, kind, &mut random) else { continue };
        let found = difference(old, &new);
        assert!(!found.logic.is_empty(), "program {which}: {kind:?} went unseen");
        assert!(found.values.is_empty(), "program {which}: {kind:?} changed values");
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
    let programs: Vec<Image> = examples().into_iter().map(|project| project.main).collect();
    seeded(&programs, 300, 7);
}

#[test]
fn edits_of_real_programs_are_found_as_what_they_are() {
    let Some(root) = corpus::root() else { return };
    let all = corpus::files(&root, ".rss").expect("the corpus can be listed");
    let images: Vec<Image> = all.iter().step_by(6).filter_map(|path| read(path)).map(|project| project.main).collect();
    seeded(&images, 1000, 1);
}

#[test]
fn every_program_equals_itself() {
    let Some(root) = corpus::root() else { return };
    for path in corpus::files(&root, ".rss").expect("the corpus can be listed") {
        let (Some(a), Some(b)) = (read(&path), read(&path)) else { continue };
        let found = difference(&a.main, &b.main);
        assert!(found.is_empty() && found.notes.is_empty(), "{}: {found:?}", path.display());
    }
}

/// Saves of one machine from before and after a run differ in values alone.
#[test]
fn running_values_are_no_logic() {
    let Some(root) = corpus::root() else { return };
    let image = |name: &str| read(&root.join("PLC_alarm_bit_count").join(name)).map(|project| project.main);
    let (Some(old), Some(new)) = (image("alarm_count.RSS"), image("alarm_count_live.RSS")) else {
        eprintln!("skipped: corpus not present");
        return;
    };
    let found = difference(&old, &new);
    assert!(found.logic.is_empty() && found.documentation.is_empty() && found.configuration.is_empty(), "{found:?}");
    assert!(found.values.iter().any(|change| change.first == "N7:2" && change.last == "N7:5"));
}

/// A number kept free is no file, whatever size its elements would have.
#[test]
fn data_files_without_elements_are_nothing() {
    let with = |file: Option<DataFile>| Image { data_files: file.into_iter().collect(), ..Image::default() };
    let of = |file_type, elements| with(Some(DataFile::new(file_type, 9, elements)));
    for (old, new) in [(with(None), of(FileType::N, 0)), (of(FileType::T, 0), with(None))] {
        assert!(difference(&old, &new).is_empty());
    }
    let found = difference(&of(FileType::N, 0), &of(FileType::N, 2)).configuration;
    let change = found.first().expect("a data file");
    assert_eq!((change.old.as_deref(), change.new.as_deref()), (None, Some("2 elements of 1 words")));
}

fn ladder_of(text: &str) -> Image {
    let mut image = Image::default();
    let rungs = convert::slc::rung::parse_rungs(text, None).expect("rungs");
    image.program_files.push(ladder::ProgramFile {
        number: 2,
        name: String::new(),
        description: String::new(),
        kind: ladder::ProgramFileKind::Ladder,
        rungs,
    });
    image
}

#[test]
fn a_large_different_program_ends_quickly_and_says_so() {
    let many = |modulus: usize, shift: usize| -> Image {
        let mut image = ladder_of("XIC B3:0/0 OTE B3:0/1");
        let Some(file) = image.program_files.first_mut() else { return image };
        let model = file.rungs.first().cloned().unwrap_or_default();
        file.rungs = (0..60_000)
            .map(|index| {
                let mut rung: Rung = model.clone();
                let bit = Address::element(FileType::B, 3, (index * 31 % modulus + shift) as u16).with_bit(0);
                if let Some(Element::Instruction(instruction)) = rung.series.first_mut() {
                    instruction.operands = vec![Operand::Address(bit)];
                }
                rung
            })
            .collect();
        image
    };
    let (old, new) = (many(97, 0), many(89, 40));
    let start = std::time::Instant::now();
    let found = difference(&old, &new);
    assert!(!found.logic.is_empty() && !found.notes.is_empty());
    assert!(start.elapsed().as_secs() < 60, "{:?}", start.elapsed());
}

#[test]
fn never_verified_presets_are_logic() {
    let found = difference(&ladder_of("TON T4:0 0.01 100 0"), &ladder_of("TON T4:0 0.01 200 0"));
    let rung = only(&found, ChangeKind::Changed).expect("one rung");
    let edits: Vec<_> = rung.edits.iter().map(|edit| (edit.kind, &*edit.old, &*edit.new)).collect();
    assert_eq!(edits, [(EditKind::Operand, "100", "200")]);
    let marked: Vec<&str> = rung.new_words.iter().filter(|word| word.marked).map(|word| &*word.text).collect();
    assert_eq!(marked, ["200"]);
}

#[test]
fn setups_of_messages_are_logic_where_both_sides_have_them() {
    let with = |target: Option<&str>| {
        let mut image = ladder_of("XIC B3:0/0 MSG MG9:0");
        for instruction in image
            .program_files
            .iter_mut()
            .flat_map(|file| &mut file.rungs)
            .flat_map(|rung| instructions(&mut rung.series))
        {
            let settings = |target: &str| vec![("Target Address".into(), target.to_owned())];
            instruction.message = target.map(|target| Box::new(ladder::MessageSetup { settings: settings(target) }));
        }
        image
    };
    let found = difference(&with(Some("N7:0")), &with(Some("N7:5")));
    let rung = only(&found, ChangeKind::Changed).expect("one rung");
    assert!(rung.edits.iter().all(|edit| edit.kind == EditKind::Setting && edit.new == "Target Address: N7:5"));
    assert!(!rung.edits.is_empty());
    let text = difference(&with(Some("N7:0")), &with(None));
    assert!(text.logic.is_empty() && text.notes.len() == 1, "{text:?}");
}

#[test]
fn a_changed_contact_and_a_changed_branch_are_told_apart() {
    let old = ladder_of("BST XIC B3:0/0 NXB XIC B3:0/1 BND OTE O:0/0");
    for (text, kinds) in [
        ("BST XIO B3:0/0 NXB XIC B3:0/1 BND OTE O:0/0", vec![EditKind::Instruction]),
        ("BST XIC B3:0/0 NXB XIC B3:0/1 BND OTE O:0/4", vec![EditKind::Operand]),
        ("XIC B3:0/0 XIC B3:0/1 OTE O:0/0", vec![EditKind::Branches]),
        ("BST XIC B3:0/0 NXB XIC B3:0/1 BND XIC I:0/1 OTE O:0/0", vec![EditKind::Inserted]),
        ("BST XIC B3:0/0 NXB XIC B3:0/1 BND", vec![EditKind::Deleted]),
    ] {
        let found = difference(&old, &ladder_of(text));
        let rung = only(&found, ChangeKind::Changed).expect("one rung");
        assert_eq!(rung.edits.iter().map(|edit| edit.kind).collect::<Vec<_>>(), kinds, "{text}");
    }
}
