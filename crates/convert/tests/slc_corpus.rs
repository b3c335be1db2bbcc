//! Every project of the corpus through SLC text: the same rungs, data words, forces and comments.

use std::path::Path;

use convert::slc::file::read;
use convert::slc::project::{export, project};
use convert::slc::rung::{parse_rung, rung_text, rung_text_for};
use convert::{from_rss, slc};
use ladder::{Family, FileType, Image, Project, Rung, Severity, Source};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

/// Every readable project, with its file name.
fn projects(folder: &Path) -> impl Iterator<Item = (String, Project)> {
    let found = corpus::files(folder, ".rss").expect("the corpus can be listed");
    found.into_iter().filter_map(|path| {
        let bytes = std::fs::read(&path).expect("file");
        let file = rss::Project::read(&bytes, rss::Mode::Permissive).ok()?;
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or("").to_owned();
        Some((name, from_rss::project(&file, Source::default())))
    })
}

fn images(project: &Project) -> impl Iterator<Item = &Image> {
    [Some(&project.main), project.online.as_ref(), project.autosave.as_ref()].into_iter().flatten()
}

/// Like [`Rung::same_logic`], but for message settings: no text has them.
fn same_text_logic(a: &Rung, b: &Rung) -> bool {
    fn without_settings(rung: &Rung) -> Rung {
        let mut rung = rung.clone();
        let mut open: Vec<&mut ladder::Series> = vec![&mut rung.series];
        while let Some(series) = open.pop() {
            for element in series {
                match element {
                    ladder::Element::Instruction(instruction) => instruction.message = None,
                    ladder::Element::Branch(branch) => open.extend(&mut branch.legs),
                }
            }
        }
        rung
    }
    without_settings(a).same_logic(&without_settings(b))
}

#[test]
fn every_rung_comes_back_from_its_text() {
    let Some(folder) = corpus::root() else { return };
    let (mut rungs, mut instructions, mut grouped, mut wrong) = (0, 0, 0, Vec::new());
    for (name, project) in projects(&folder) {
        for image in images(&project) {
            for file in &image.program_files {
                for (index, rung) in file.rungs.iter().enumerate() {
                    rungs += 1;
                    instructions += rung.instructions().count();
                    let text = rung_text(rung);
                    grouped += text.matches("( ").count();
                    let back = |family: Option<Family>| {
                        let text = rung_text_for(rung, family);
                        parse_rung(&text, family)
                            .is_ok_and(|again| same_text_logic(&again, rung) && rung_text_for(&again, family) == text)
                    };
                    let with_family = parse_rung(&text, Some(image.family()));
                    if !back(None)
                        || !back(Some(image.family()))
                        || !with_family.is_ok_and(|again| same_text_logic(&again, rung))
                    {
                        wrong.push(format!("{name} file {} rung {index}: {text}", file.number));
                    }
                }
            }
        }
    }
    println!("{rungs} rungs with {instructions} instructions, {grouped} groups of parentheses");
    assert!(wrong.is_empty(), "{} rungs: {:#?}", wrong.len(), &wrong[..wrong.len().min(10)]);
    assert!(rungs > 10_000, "{rungs}");
}

#[test]
fn every_image_comes_back_from_its_text_file() {
    let Some(folder) = corpus::root() else { return };
    let (mut count, mut words, mut comments) = (0, 0, 0);
    for (name, original) in projects(&folder) {
        for image in images(&original) {
            let made = export(image);
            let text = made.file.write();
            // The bytes in between are those of a file.
            let bytes = slc::encode(&text);
            let parsed = read(&slc::decode(&bytes));
            assert_eq!(parsed.diagnostics, [], "{name}");
            assert_eq!(parsed.write(), text, "{name}");
            let again = project(&parsed);
            let errors: Vec<_> = again.diagnostics.iter().filter(|d| d.severity == Severity::Error).collect();
            assert!(errors.is_empty(), "{name}: {errors:#?}");
            let again = &again.main;
            assert_eq!(again.family(), image.family(), "{name}");
            assert_eq!(again.processor.name, image.processor.name, "{name}");
            for file in image.ladder_files() {
                let other = again.program_file(file.number).expect("the same files");
                assert_eq!((&other.name, other.rungs.len()), (&file.name, file.rungs.len()), "{name}");
                for (a, b) in file.rungs.iter().zip(&other.rungs) {
                    assert!(same_text_logic(a, b), "{name}: {}", rung_text(a));
                    let texts = |rung: &Rung| {
                        let lines = |text: &str| text.replace("\r\n", "\n").replace('\r', "\n");
                        rung.comment.as_ref().map(|c| (lines(&c.text), lines(&c.title)))
                    };
                    assert_eq!(texts(a), texts(b), "{name}: {}", rung_text(a));
                    comments += usize::from(a.comment.is_some());
                }
            }
            let used = |image: &Image| {
                let kept = |t: FileType| !matches!(t, FileType::Unused | FileType::Reserved | FileType::Unknown(_));
                let all = image.data_files.iter().chain(&image.function_files).filter(|f| kept(f.file_type));
                all.map(|f| (f.file_type, f.number, f.elements, f.words.clone(), f.forces.clone())).collect::<Vec<_>>()
            };
            let (mine, theirs) = (used(again), used(image));
            for (mine, theirs) in mine.iter().zip(&theirs) {
                assert_eq!(mine, theirs, "{name}");
            }
            assert_eq!(mine.len(), theirs.len(), "{name}");
            words += mine.iter().map(|file| file.3.len()).sum::<usize>();
            count += 1;
        }
    }
    println!("{count} images, {words} data words, {comments} comments");
    assert!(count > 400, "{count}");
}

/// The vendor's text names the function files that projects of the same controller store by number:
/// the same ones, in the same order, of the same size.
#[test]
fn function_files_are_those_the_vendors_text_names() {
    let Some(folder) = corpus::root() else { return };
    let text = std::fs::read_to_string(folder.join("RsLogix500Helper/59-BSGS.SLC")).expect("the file");
    // A file without elements does not show how large they are.
    let sizes = |image: &Image| {
        let files = image.function_files.iter().filter(|file| file.elements > 0);
        files.map(|f| (f.file_type, f.number, f.elements, f.words_per_element)).collect::<Vec<_>>()
    };
    let named = slc::project::read(&text).expect("a project").main;
    assert_eq!(named.processor.model, Some(62));
    let (mut same, mut reordered) = (0, 0);
    for (name, project) in projects(&folder) {
        for image in images(&project).filter(|image| matches!(image.processor.model, Some(62 | 63))) {
            if sizes(image) == sizes(&named) {
                same += 1;
                continue;
            }
            let sorted = |image: &Image| {
                let mut sizes = sizes(image);
                sizes.sort_unstable();
                sizes
            };
            assert_eq!(sorted(image), sorted(&named), "{name}");
            reordered += 1;
        }
    }
    println!("{same} images with the order of the text, {reordered} with another");
    assert!(same > 100 && reordered < same, "{same} {reordered}");
}
