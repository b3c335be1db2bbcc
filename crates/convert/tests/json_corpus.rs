//! Every project of the corpus as JSON: valid under the schema, and the same model when read back.

use std::path::Path;
use std::time::{Duration, Instant};

use convert::from_rss;
use convert::json::{from_json, to_json_text};
use ladder::{Project, Source};
use serde_json::Value;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

fn read(path: &Path) -> Option<Project> {
    let bytes = std::fs::read(path).expect("file");
    let file = rss::Project::read(&bytes, rss::Mode::Permissive).ok()?;
    Some(from_rss::project(&file, Source { file: "program.RSS".into(), ..Source::default() }))
}

/// The first rung or part that did not come back.
fn difference(name: &str, a: &Project, b: &Project) -> String {
    let images = [
        Some((&a.main, &b.main)),
        a.online.as_ref().zip(b.online.as_ref()),
        a.autosave.as_ref().zip(b.autosave.as_ref()),
    ];
    for (a, b) in images.into_iter().flatten() {
        for (a, b) in a.program_files.iter().zip(&b.program_files) {
            if let Some((number, (x, y))) = a.rungs.iter().zip(&b.rungs).enumerate().find(|(_, (x, y))| x != y) {
                return format!("{name}: file {} rung {number}:\n{x:?}\n{y:?}", a.number);
            }
        }
        for (x, y) in a.data_files.iter().zip(&b.data_files).chain(a.function_files.iter().zip(&b.function_files)) {
            if x != y {
                return format!("{name}: data file {}:\n{x:?}\n{y:?}", x.label());
            }
        }
        for (x, y) in a.documentation.entries().iter().zip(b.documentation.entries()) {
            if x != y {
                return format!("{name}: {x:?}\n{y:?}");
            }
        }
        if a != b {
            return format!("{name}: another part of an image");
        }
    }
    format!("{name}: another part of the project")
}

#[test]
fn real_projects_are_valid_and_come_back() {
    let Some(folder) = corpus::root() else { return };
    let schema = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schema/rungs.project-1.schema.json");
    let schema: Value = serde_json::from_str(&std::fs::read_to_string(schema).expect("schema")).expect("JSON");
    let schema = jsonschema::draft202012::new(&schema).expect("the schema compiles");
    let files = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let (mut read_count, mut rungs, mut structures, mut bytes) = (0, 0, 0, 0);
    let mut slowest = (Duration::ZERO, String::new());
    let mut wrong = Vec::new();
    for path in &files {
        let Some(project) = read(path) else { continue };
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        read_count += 1;
        let start = Instant::now();
        let text = to_json_text(&project);
        slowest = slowest.max((start.elapsed(), format!("{name}, {} bytes", text.len())));
        bytes += text.len();
        match from_json(&text) {
            Ok(back) if back == project => {}
            Ok(back) => wrong.push(difference(&name, &project, &back)),
            Err(error) => wrong.push(format!("{name}: {error}")),
        }
        let document: Value = serde_json::from_str(&text).expect("JSON");
        let errors = schema.iter_errors(&document).take(3);
        wrong.extend(errors.map(|error| format!("{name}: {}: {error}", error.instance_path())));
        for image in [Some(&project.main), project.online.as_ref(), project.autosave.as_ref()].into_iter().flatten() {
            rungs += image.program_files.iter().map(|file| file.rungs.len()).sum::<usize>();
        }
        structures += text.matches("\"structure\":").count();
    }
    println!("{read_count} projects, {rungs} rungs, {structures} with a structure, {bytes} bytes of JSON");
    println!("slowest to write: {slowest:?}");
    assert!(read_count > 0, "no project of the corpus could be read");
    assert!(wrong.is_empty(), "{} wrong, the first:\n{}", wrong.len(), wrong[..wrong.len().min(5)].join("\n"));
}
