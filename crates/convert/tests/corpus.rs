//! Every project of the corpus through the model: code against texts, known counts.

use std::path::Path;

use convert::{from_rss, verify};
use ladder::{ProgramFileKind, Source};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

fn read(path: &Path) -> Option<rss::Project> {
    rss::Project::read(&std::fs::read(path).expect("file"), rss::Mode::Permissive).ok()
}

#[test]
fn compiled_code_is_what_the_operand_texts_compile_to() {
    let Some(folder) = corpus::root() else { return };
    let files = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let (mut agrees, mut not_compiled, mut differs) = (0, 0, Vec::new());
    for path in &files {
        let Some(project) = read(path) else { continue };
        let check = verify::check_code(&project);
        agrees += check.agrees;
        not_compiled += check.not_compiled;
        let name = path.file_name().and_then(|name| name.to_str()).unwrap_or("").to_owned();
        differs.extend(check.differs.into_iter().chain(check.not_comparable).map(|d| (name.clone(), d)));
    }
    println!("{agrees} instructions agree, {} differ, {not_compiled} were never compiled", differs.len());
    for difference in &differs {
        println!("{difference:?}");
    }
    assert!(agrees > 100_000, "{agrees}");
    // One instruction of one program stores a symbol as text while its code has the address.
    let others: Vec<_> =
        differs.iter().filter(|(_, d)| d.text.split(' ').next() != Some("LOAD_CELL_RAW_INPUT")).collect();
    assert!(others.is_empty(), "{} instructions differ", others.len());
}

#[test]
fn counts_of_a_large_program() {
    let Some(folder) = corpus::root() else { return };
    let project = read(&folder.join("acd/LANLOGIX_BR.RSS")).expect("a project");
    let project = from_rss::project(&project, Source::default());
    for image in [Some(&project.main), project.online.as_ref()].into_iter().flatten() {
        let ladder: Vec<_> = image.ladder_files().collect();
        assert_eq!(ladder.len(), 41);
        assert_eq!(image.program_files.len(), 256);
        assert_eq!(image.program_files.iter().filter(|f| f.kind == ProgramFileKind::System).count(), 2);
        let rungs = || ladder.iter().flat_map(|file| &file.rungs);
        assert_eq!(rungs().count(), 1016);
        assert_eq!(rungs().filter(|rung| rung.is_end()).count(), 41);
        let count = |mnemonic: &str| rungs().flat_map(|r| r.instructions()).filter(|i| i.mnemonic == mnemonic).count();
        assert_eq!(rungs().flat_map(|r| r.instructions()).count(), 8519);
        for (mnemonic, number) in
            [("XIC", 2977), ("MOV", 951), ("TON", 112), ("RTO", 15), ("CPT", 69), ("JSR", 38), ("MSG", 3)]
        {
            assert_eq!(count(mnemonic), number, "{mnemonic}");
        }
    }
}

#[test]
fn operands_are_spelled_as_stored() {
    let Some(folder) = corpus::root() else { return };
    let files = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let mut texts = std::collections::BTreeMap::<String, String>::new();
    let mut seen = 0;
    for project in files.iter().filter_map(|path| read(path)) {
        for stream in project.streams().filter(|stream| stream.kind() == rss::StreamKind::ProgramFiles) {
            let programs: rss::program::ProgramFiles<'_> =
                rss::parse(stream.payload(), stream.path(), rss::Mode::Permissive).value;
            for rung in programs.files.iter().flat_map(|file| &file.rungs) {
                rung.for_each_instruction(|instruction| {
                    let Some((_, form)) = instr::by_opcode(instruction.opcode) else { return };
                    for (index, text) in instruction.operands.iter().enumerate() {
                        if let Some((_, false)) = form.operand_of_string(index) {
                            seen += 1;
                            let text = text.decode();
                            let spelled = ladder::Operand::parse(&text).to_string();
                            if spelled != text.trim() {
                                texts.insert(text.into_owned(), spelled);
                            }
                        }
                    }
                });
            }
        }
    }
    println!("{seen} operand texts");
    assert!(texts.is_empty(), "{texts:?}");
}

#[test]
fn a_project_written_from_the_model_reads_back_equal() {
    let Some(folder) = corpus::root() else { return };
    let files = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let mut written = 0;
    for path in &files {
        let Some(project) = read(path) else { continue };
        let model = from_rss::project(&project, Source::default());
        let built = convert::to_rss::project_file(&model).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let bytes = built.file.write().expect("bytes");
        let again = rss::Project::read(&bytes, rss::Mode::Strict).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let check = verify::check_code(&again);
        assert!(check.differs.is_empty(), "{}: {:?}", path.display(), check.differs);
        let back = from_rss::project(&again, Source::default());
        assert_eq!(back.diagnostics, [], "{}", path.display());
        let (before, after) = (&model.main.program_files, &back.main.program_files);
        assert_eq!(before.len(), after.len(), "{}", path.display());
        for (a, b) in before.iter().zip(after) {
            let place = format!("{} file {}", path.display(), a.number);
            assert_eq!((&a.name, &a.description, a.kind), (&b.name, &b.description, b.kind), "{place}");
            assert_eq!(a.rungs.len(), b.rungs.len(), "{place}");
            for (number, (a, b)) in a.rungs.iter().zip(&b.rungs).enumerate() {
                assert!(a.same_logic(b), "{place} rung {number}:\n{a:#?}\n{b:#?}");
                assert_eq!(
                    a.comment.as_ref().map(|c| (&c.text, &c.title)),
                    b.comment.as_ref().map(|c| (&c.text, &c.title))
                );
            }
        }
        for file in &model.main.data_files {
            let other = back.main.data_file(file.file_type, file.number);
            let other = other.unwrap_or_else(|| panic!("{} {}", path.display(), file.label()));
            let size = file.words.len();
            assert_eq!(file.words, other.words[..size], "{} {}", path.display(), file.label());
            assert_eq!((&file.name, &file.description), (&other.name, &other.description));
        }
        assert_eq!(model.main.function_files, back.main.function_files);
        assert_eq!(model.main.io, back.main.io, "{}", path.display());
        assert_eq!(model.main.documentation.entries().len(), back.main.documentation.entries().len());
        for entry in model.main.documentation.entries() {
            assert_eq!(
                back.main.documentation.entry(&entry.target).is_some(),
                entry.target != ladder::Target::Unassigned
            );
        }
        written += 1;
    }
    println!("{written} projects written and read back");
    assert!(written > 250);
}
