//! Three-way merges: laws over real saves, and each kind of conflict.

use std::path::Path;

use analysis::diff::{Difference, compare};
use analysis::merge::{Merge, Piece, Side, merge};
use convert::to_rss::merge::{FileSource, RungSource, Sides, Whole, merged_file};
use ladder::{Address, AddressEntry, FileType, Image, Project, Rung, Source, Target};
use rss::Mode;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

fn read(path: &Path) -> Option<(rss::Project, Project)> {
    let file = rss::Project::read(&std::fs::read(path).ok()?, Mode::Permissive).ok()?;
    let project = convert::from_rss::project(&file, Source::default());
    Some((file, project))
}

fn example(name: &str) -> (rss::Project, Project) {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(name)).expect("an example")
}

fn difference(old: &Image, new: &Image) -> Difference {
    let side = |image| analysis::diff::Side { image, documentation: Some(&image.documentation) };
    compare(side(old), side(new))
}

/// Writes a clean merge and reads it back.
fn written(
    base: &rss::Project,
    ours: &(rss::Project, Project),
    theirs: &rss::Project,
    merged: &Merge,
) -> Result<Image, String> {
    let files: Vec<FileSource> = merged
        .files
        .iter()
        .map(|file| FileSource {
            number: file.number,
            theirs: file.side == Side::Theirs,
            rungs: file
                .pieces
                .iter()
                .filter_map(|piece| match piece {
                    Piece::Rung(rung) => Some(RungSource {
                        theirs: rung.side == Side::Theirs,
                        file: rung.at.file,
                        rung: rung.at.rung,
                        comment: rung.comment.clone(),
                    }),
                    Piece::Conflict(_) => None,
                })
                .collect(),
        })
        .collect();
    let theirs_part = |side| side == Side::Theirs;
    let parts = merged.parts;
    let whole = Whole {
        processor: theirs_part(parts.processor),
        io: theirs_part(parts.io),
        channels: theirs_part(parts.channels),
    };
    let sides = Sides { base, ours: &ours.0, theirs, image: &ours.1.main };
    let built = merged_file(sides, &files, &merged.image, whole).map_err(|error| error.to_string())?;
    let bytes = built.file.write().map_err(|error| error.to_string())?;
    let back = rss::Project::read(&bytes, Mode::Permissive).map_err(|error| error.to_string())?;
    let back = convert::from_rss::project(&back, Source::default());
    let before =
        |project: &Project| project.diagnostics.iter().filter(|d| d.severity == ladder::Severity::Error).count();
    if before(&back) > before(&ours.1) {
        return Err(format!("{:?}", back.diagnostics.last()));
    }
    // A rung kept the record it came with: no compiled code differs from its operands that did not before.
    let differing = |file: &rss::Project| convert::verify::check_code(file).differs.len();
    if differing(&rss::Project::read(&bytes, Mode::Permissive).expect("reads")) > differing(&ours.0) + differing(theirs)
    {
        return Err("compiled code differs from its operands".to_owned());
    }
    Ok(back.main)
}

/// What is no setting of a program: the writer keeps that of ours.
fn without_id(mut difference: Difference) -> Difference {
    difference.configuration.retain(|change| {
        change.what != "processor"
            || !["program ID", "driver", "route", "reported type"].contains(&change.name.as_str())
    });
    difference
}

#[test]
fn what_only_one_side_changed_is_taken_over_whole() {
    // Successive saves of the plant archive: each step is what one person did.
    let Some(root) = corpus::root() else { return };
    let all = corpus::files(&root, ".rss").expect("the corpus can be listed");
    let all: Vec<_> = all.into_iter().filter(|path| path.starts_with(root.join("rslogix500"))).collect();
    let (mut merges, mut two_sided, mut unwritable) = (0, 0, Vec::new());
    // Every fourth step in each run; all 240 merges take half a minute.
    for pair in all.windows(2).step_by(4) {
        let stem = |path: &Path| analysis::history::Name::of(&path.to_string_lossy()).stem;
        if stem(&pair[0]) != stem(&pair[1]) {
            continue;
        }
        let (Some(a), Some(b)) = (read(&pair[0]), read(&pair[1])) else { continue };
        let name = pair[1].display();
        let mut check = |ours: &(rss::Project, Project), theirs: &(rss::Project, Project)| {
            let merged = merge(&a.1.main, &ours.1.main, &theirs.1.main);
            assert!(
                merged.is_clean(),
                "{name}: {:?} {:?}",
                merged.conflicts,
                merged.files.iter().flat_map(|f| &f.pieces).find(|p| matches!(p, Piece::Conflict(_)))
            );
            let found = without_id(difference(&b.1.main, &merged.image));
            assert!(found.is_empty(), "{name}: {found:?}");
            match written(&a.0, ours, &theirs.0, &merged) {
                Ok(back) => {
                    let found = difference(&merged.image, &back);
                    assert!(found.is_empty(), "{name}: written: {found:?}");
                }
                Err(why) => unwritable.push(format!("{name}: {why}")),
            }
            merges += 1;
        };
        check(&a, &b);
        check(&b, &a);
        // What a second person did meanwhile: a rung more at the end of each ladder file.
        let more = |image: &Image| {
            let mut image = image.clone();
            for file in image.program_files.iter_mut().filter(|file| file.kind == ladder::ProgramFileKind::Ladder) {
                let at = file.rungs.len().saturating_sub(1);
                let bit = Address::element(FileType::B, 3, file.number).with_bit(7);
                let coil =
                    ladder::Instruction::new(ladder::Mnemonic::named("OTL"), vec![ladder::Operand::Address(bit)]);
                file.rungs.insert(at, Rung::new(vec![ladder::Element::Instruction(coil)]));
            }
            image
        };
        let numbers = |image: &Image| image.ladder_files().map(|file| file.number).collect::<Vec<_>>();
        if numbers(&a.1.main) == numbers(&b.1.main) {
            let merged = merge(&a.1.main, &b.1.main, &more(&a.1.main));
            if merged.is_clean() {
                let found = difference(&more(&b.1.main), &merged.image);
                assert!(found.logic.is_empty() && found.documentation.is_empty(), "{name}: {found:?}");
                two_sided += 1;
            }
        }
    }
    // The others changed the last rung of a file.
    assert!(two_sided > 20, "{two_sided}");
    assert!(merges >= 50, "{merges}");
    assert!(unwritable.is_empty(), "{unwritable:#?}");
}

/// The motor example and two copies of it to edit.
fn three() -> [Image; 3] {
    let image = example("motor/motor.RSS").1.main;
    [image.clone(), image.clone(), image]
}

fn rungs(image: &mut Image, number: u16) -> &mut Vec<Rung> {
    &mut image.program_files.iter_mut().find(|file| file.number == number).expect("a file").rungs
}

/// Another bit for the first operand of a rung.
fn change(rung: &mut Rung, bit: u16) {
    let ladder::Element::Instruction(first) = &mut rung.series[0] else { panic!("an instruction first") };
    first.operands[0] = ladder::Operand::Address(Address::element(FileType::B, 3, 60).with_bit(bit));
}

fn whys(merged: &Merge) -> Vec<&str> {
    let pieces = merged.files.iter().flat_map(|file| &file.pieces);
    let rungs = pieces.filter_map(|piece| match piece {
        Piece::Conflict(conflict) => Some(conflict.why),
        Piece::Rung(_) => None,
    });
    rungs.chain(merged.conflicts.iter().map(|conflict| conflict.what.as_str())).collect()
}

#[test]
fn neighbouring_rungs_are_merged_and_one_rung_is_not() {
    let [base, mut ours, mut theirs] = three();
    change(&mut rungs(&mut ours, 2)[1], 1);
    change(&mut rungs(&mut theirs, 2)[2], 2);
    let mut both = ours.clone();
    change(&mut rungs(&mut both, 2)[2], 2);
    let merged = merge(&base, &ours, &theirs);
    assert!(merged.is_clean());
    assert!(difference(&both, &merged.image).is_empty());

    change(&mut rungs(&mut theirs, 2)[1], 3);
    assert_eq!(whys(&merge(&base, &ours, &theirs)), ["both sides changed this rung"]);
    // The same change on both sides is one change.
    assert!(merge(&base, &ours, &ours).is_clean());
}

#[test]
fn two_rungs_inserted_at_one_place_have_no_order() {
    let [base, mut ours, mut theirs] = three();
    let insert = |image: &mut Image, at: usize, bit: u16| {
        let mut rung = base.program_file(2).expect("a file").rungs[2].clone();
        change(&mut rung, bit);
        rungs(image, 2).insert(at, rung);
    };
    insert(&mut ours, 1, 1);
    insert(&mut theirs, 1, 2);
    assert_eq!(
        whys(&merge(&base, &ours, &theirs)),
        ["both sides inserted rungs here: their order is the order of the scan"]
    );
    let [_, mut ours, mut theirs] = three();
    insert(&mut ours, 0, 1);
    insert(&mut theirs, 2, 2);
    let merged = merge(&base, &ours, &theirs);
    assert!(merged.is_clean(), "{:?}", whys(&merged));
    let count = base.program_file(2).expect("a file").rungs.len();
    assert_eq!(merged.image.program_file(2).expect("a file").rungs.len(), count + 2);
}

#[test]
fn a_rung_taken_out_and_changed_is_a_conflict() {
    let [base, mut ours, mut theirs] = three();
    rungs(&mut ours, 2).remove(1);
    change(&mut rungs(&mut theirs, 2)[1], 2);
    assert_eq!(whys(&merge(&base, &ours, &theirs)), ["one side took out or moved rungs that the other side touched"]);
    let [base, ours, mut theirs] = three();
    rungs(&mut theirs, 2).remove(1);
    assert!(difference(&theirs, &merge(&base, &ours, &theirs).image).is_empty());
}

#[test]
fn no_rung_comes_twice_or_comes_back() {
    let shift = |image: &mut Image, from: usize, to: usize| {
        let rung = rungs(image, 2).remove(from);
        rungs(image, 2).insert(to, rung);
    };
    let [base, mut ours, mut theirs] = three();
    shift(&mut ours, 1, 5);
    shift(&mut theirs, 1, 3);
    let found = merge(&base, &ours, &theirs);
    assert!(whys(&found).contains(&"both sides moved a rung, to different places"), "{:?}", whys(&found));
    let [_, _, mut theirs] = three();
    rungs(&mut theirs, 2).remove(1);
    let found = merge(&base, &ours, &theirs);
    assert!(whys(&found).contains(&"ours moved a rung that theirs took out"), "{:?}", whys(&found));
    let found = merge(&base, &theirs, &ours);
    assert!(whys(&found).contains(&"theirs moved a rung that ours took out"), "{:?}", whys(&found));
    assert!(merge(&base, &ours, &ours).is_clean());
    let [_, mut ours, mut theirs] = three();
    let mut rung = base.program_file(2).expect("a file").rungs[2].clone();
    change(&mut rung, 4);
    rungs(&mut ours, 2).insert(0, rung.clone());
    rungs(&mut theirs, 2).insert(4, rung);
    let found = merge(&base, &ours, &theirs);
    assert_eq!(whys(&found), ["both sides inserted the same rung, at different places"]);
}

#[test]
fn a_renamed_address_and_a_rung_with_the_old_one_are_a_conflict() {
    let [base, mut ours, mut theirs] = three();
    // An address of the program that ours replaces throughout, and theirs uses once more.
    let address = |text: &str| ladder::Operand::Address(Address::parse(text).expect("an address"));
    let mut found = false;
    for file in &mut ours.program_files {
        for rung in &mut file.rungs {
            rename(&mut rung.series, &address("B3:0/0"), &address("B3:50/9"), &mut found);
        }
    }
    assert!(found, "the example no longer uses B3:0/0");
    let ladder::Element::Instruction(first) = &mut rungs(&mut theirs, 2)[2].series[0] else { panic!("an instruction") };
    first.operands[0] = address("B3:0/0");
    let merged = merge(&base, &ours, &theirs);
    assert!(whys(&merged).iter().any(|why| why.contains("B3:0/0 is now B3:50/9 in ours")), "{:?}", whys(&merged));
}

fn rename(series: &mut [ladder::Element], old: &ladder::Operand, new: &ladder::Operand, found: &mut bool) {
    for element in series {
        match element {
            ladder::Element::Instruction(instruction) => {
                for operand in instruction.operands.iter_mut().filter(|operand| *operand == old) {
                    *operand = new.clone();
                    *found = true;
                }
            }
            ladder::Element::Branch(branch) => branch.legs.iter_mut().for_each(|leg| rename(leg, old, new, found)),
        }
    }
}

#[test]
fn documentation_is_merged_entry_by_entry() {
    let [base, mut ours, mut theirs] = three();
    let add = |image: &mut Image, address: &str, symbol: &str| {
        let target = Target::Address(Address::parse(address).expect("an address"));
        image.documentation.add(AddressEntry { target, symbol: symbol.to_owned(), description: Vec::new() });
    };
    add(&mut ours, "N7:100", "OURS");
    add(&mut theirs, "N7:101", "THEIRS");
    let merged = merge(&base, &ours, &theirs);
    assert!(merged.is_clean());
    let found = |symbol: &str| merged.image.documentation.by_symbol(symbol).is_some();
    assert!(found("OURS") && found("THEIRS"));
    add(&mut theirs, "N7:100", "OTHER");
    add(&mut ours, "N7:102", "THEIRS");
    let merged = merge(&base, &ours, &theirs);
    let found = whys(&merged);
    assert!(found.contains(&"symbol of N7:100"), "{found:?}");
    assert!(found.iter().any(|why| why.starts_with("symbol THEIRS would stand for")), "{found:?}");
}

#[test]
fn presets_are_settings_and_accumulators_are_not() {
    let [mut base, mut ours, mut theirs] = three();
    for (image, words) in [(&mut base, [0, 10, 0]), (&mut ours, [0, 20, 5]), (&mut theirs, [0, 30, 7])] {
        image.data_files.retain(|file| file.file_type != FileType::T);
        let mut file = ladder::DataFile::new(FileType::T, 4, 1);
        file.words = words.to_vec();
        image.data_files.insert(4, file);
    }
    let merged = merge(&base, &ours, &theirs);
    assert_eq!(whys(&merged), ["T4:0.PRE"]);
    assert!(merged.notes.iter().any(|note| note.contains("T4:0.ACC")), "{:?}", merged.notes);
    // Both made a table larger: both additions have room.
    let [base, mut ours, mut theirs] = three();
    for (image, elements, at) in [(&mut ours, 40_u16, 20), (&mut theirs, 60, 50)] {
        let file = image.data_files.iter_mut().find(|file| file.file_type == FileType::N).expect("an N file");
        file.elements = elements;
        file.words = vec![0; usize::from(elements)];
        file.words[at] = elements;
    }
    let merged = merge(&base, &ours, &theirs);
    let file = merged.image.data_files.iter().find(|file| file.file_type == FileType::N).expect("an N file");
    assert_eq!((file.elements, file.words[20], file.words[50]), (60, 40, 60));
}
