//! The properties: reading any bytes ends, and what was read without complaint is written the same.

use std::io;

use analysis::{CallGraph, Coverage, CrossReference, TimerReport};
use convert::slc::{self, rung};
use ladder::{Documentation, Family, Image, Source};
use rss::{ImageKind, Mode, Parsed, Record, StreamKind};

use crate::seed::EXAMPLES;

const STREAM: &str = "STREAM/ObjectData";

/// A whole file: it is read, accounted for and written, and comes back if nothing deviates.
pub fn container(bytes: &[u8]) {
    let _ = rss::identify(bytes);
    let strict = rss::Project::read(bytes, Mode::Strict);
    let project = match rss::Project::read(bytes, Mode::Permissive) {
        Ok(project) => project,
        Err(error) => {
            placed(&error, usize::MAX);
            assert_eq!(strict.err(), Some(error));
            return;
        }
    };
    let sound = project.missing().next().is_none() && project.deviations().next().is_none();
    assert_eq!(strict.is_ok(), sound);
    let account = rss::verify::verify(&project);
    for stream in &account.streams {
        assert!(stream.understood <= stream.bytes, "{}", stream.stream);
        let silent = stream.error.is_none() && stream.deviations.is_empty();
        assert!(stream.identical || !silent, "{} differs without a word", stream.stream);
    }
    let identical = account.streams.iter().all(|stream| stream.identical);
    assert!(account.roundtrip || !sound || !identical, "a sound project does not come back");
}

/// A payload as one record.
pub fn record<'a, R: Record<'a>>(bytes: &'a [u8]) -> Parsed<R> {
    let parsed = rss::parse::<R>(bytes, STREAM, Mode::Permissive);
    assert!(parsed.understood <= bytes.len());
    if let Some(error) = &parsed.error {
        placed(error, bytes.len());
    }
    let silent = parsed.error.is_none() && parsed.deviations.is_empty();
    if silent {
        assert_eq!(rss::serialize(&parsed.value).as_deref(), Ok(bytes));
    }
    let strict = rss::parse::<R>(bytes, STREAM, Mode::Strict);
    assert_eq!(strict.error.is_none(), silent, "{:?}", strict.error);
    parsed
}

/// An error says where, and the place is in the bytes.
fn placed(error: &rss::Error, end: usize) {
    match error.deviation() {
        Some(deviation) => assert!(deviation.offset <= end, "{error}"),
        None => assert!(matches!(error, rss::Error::Foreign(_)), "{error}"),
    }
}

/// The property set of a project.
pub fn summary(bytes: &[u8]) {
    match rss::summary::Summary::read(bytes) {
        Ok(summary) => {
            assert_eq!(summary.as_bytes(), bytes);
            let _ = summary.instruction_words();
            for id in 0..40 {
                let _ = (summary.number(id), summary.text(id), summary.time(id));
            }
        }
        Err(error) => placed(&error, bytes.len()),
    }
}

/// Compiled code: decoding accepts only what encoding gives back.
pub fn compiled_code(bytes: &[u8]) {
    match rss::code::Code::decode(bytes) {
        Ok(code) => {
            assert_eq!(code.encode().as_deref(), Ok(bytes));
            if let rss::code::Code::Operands { operands, .. } = &code {
                operands.iter().for_each(|operand| drop(convert::code::spell(operand)));
            }
        }
        Err(error) => assert!(error.offset <= bytes.len(), "{error}"),
    }
}

/// A sound project with one stream replaced: whatever it becomes is shown, analysed and exported. The
/// first byte chooses the stream, the second the image.
pub fn model(bytes: &[u8]) {
    let (Some((&[kind, image], payload)), Some(base)) = (bytes.split_first_chunk::<2>(), EXAMPLES.first()) else {
        return;
    };
    let kind = StreamKind::NAMED[usize::from(kind) % StreamKind::NAMED.len()];
    let image = ImageKind::ALL[usize::from(image) % ImageKind::ALL.len()];
    let mut file = base.clone();
    file.set_payload(image, kind, payload).expect("any payload can be stored");
    let project = convert::from_rss::project(&file, Source::default());
    let _ = convert::verify::check_code(&file);
    let documentation = &project.main.documentation;
    for image in [Some(&project.main), project.online.as_ref(), project.autosave.as_ref()].into_iter().flatten() {
        look(image, documentation);
    }
    settles_as_json(&project);
    write(&project);
}

/// What a person can ask about an image.
fn look(image: &Image, documentation: &Documentation) {
    let xref = CrossReference::build(image, documentation);
    let _ = (xref.findings(), Coverage::build(image, documentation, &xref));
    let _ = CallGraph::build(image, documentation);
    let _ = analysis::csv::xref(&xref, io::sink());
    let _ = analysis::csv::timers(&TimerReport::build(image, &xref), io::sink());
    let style = render::Style::default();
    for file in image.ladder_files() {
        let _ = render::program_file(&mut io::sink(), image, file, None, documentation, &style);
        for rung in &file.rungs {
            settles_as_text(rung, Some(image.family()));
        }
    }
    let _ = convert::csv::write_symbols(documentation, io::sink());
    let _ = slc::project::read(&slc::project::export(image).file.write());
}

/// A rung written as text reads back as the same rung.
fn settles_as_text(rung: &ladder::Rung, family: Option<Family>) {
    // A rung that could not be read stands for its text, which is no rung.
    if rung::unread_text(rung).is_some() {
        return;
    }
    let text = rung::rung_text_for(rung, family);
    let again = rung::parse_rung(&text, family).unwrap_or_else(|error| panic!("{text}: {error}"));
    assert!(again.same_logic(rung), "{text}\n{again:?}\n{rung:?}");
    assert_eq!(rung::rung_text_for(&again, family), text);
}

/// A project written as JSON reads back, and is then written the same.
fn settles_as_json(project: &ladder::Project) {
    let text = convert::json::to_json_text(project);
    let again = match convert::json::from_json(&text) {
        Ok(again) => again,
        // A damaged file can hold a number twice. Its document shows both, and is not taken for a project.
        Err(error) if error.to_string().contains("each file once") => return,
        Err(error) => panic!("{error}\n{text}"),
    };
    assert_eq!(convert::json::to_json_text(&again), text);
}

/// A project file made of a model reads back without complaint; or the model cannot be stored.
fn write(project: &ladder::Project) {
    if let Ok(built) = convert::to_rss::project_file(project) {
        let bytes = built.file.write().expect("a file within bounds");
        let back = rss::Project::read(&bytes, Mode::Strict).expect("a sound project");
        assert!(rss::verify::verify(&back).roundtrip);
        drop(convert::from_rss::project(&back, Source::default()));
    }
}

/// SLC text drawn as SVG, and the bytes as documentation of what it uses: nothing becomes markup.
pub fn svg(bytes: &[u8]) {
    let text = slc::decode(bytes);
    let Ok(project) = slc::project::read(&text) else { return };
    let image = &project.main;
    let documentation = hostile(image, &text);
    let width = bytes.first().map_or(0, |byte| usize::from(*byte));
    let style = render::Style { state: true, ..render::Style::graphic(width) };
    for file in image.ladder_files() {
        for index in 0..file.rungs.len().min(50) {
            let scene = render::scene(image, file, index, &documentation, &style);
            let figure = render::figure::figure(&scene);
            assert!(figure.width >= scene.width * render::figure::CELL_WIDTH);
            let href = |address: &str| Some(format!("#{address}"));
            let svg = render::svg::drawing(&scene, &render::svg::Options { href: &href, ..Default::default() });
            // Without a style sheet only tags have these characters.
            assert_eq!(svg.matches('<').count(), svg.matches('>').count(), "{svg}");
            assert_eq!(svg.matches("<g ").count(), svg.matches("</g>").count(), "{svg}");
            assert_eq!(svg.matches("<a ").count(), svg.matches("</a>").count(), "{svg}");
            assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>") && !svg.contains("<script"), "{svg}");
        }
    }
}

/// A text as symbol and description of addresses of a program.
fn hostile(image: &Image, text: &str) -> Documentation {
    let mut documentation = image.documentation.clone();
    let rungs = image.ladder_files().flat_map(|file| &file.rungs);
    let addresses =
        rungs.flat_map(|rung| rung.instructions()).flat_map(|i| i.operands.iter().filter_map(|o| o.address()));
    for (address, line) in addresses.zip(text.lines()).take(100) {
        documentation.add(ladder::AddressEntry {
            target: ladder::Target::from(address),
            symbol: line.chars().rev().take(30).collect(),
            description: vec![line.to_owned(); 5],
        });
    }
    documentation
}

/// Text as rungs and as a whole file.
pub fn slc_text(bytes: &[u8]) {
    let text = slc::decode(bytes);
    for family in [None, Some(Family::MicroLogix1400)] {
        for rung in rung::parse_rungs(&text, family).into_iter().flatten() {
            settles_as_text(&rung, family);
        }
    }
    let lines =
        |text: &str| text.lines().map(str::trim).filter(|line| !line.is_empty()).map(str::to_owned).collect::<Vec<_>>();
    let first = slc::file::read(&text).write();
    let second = slc::file::read(&first).write();
    assert_eq!(lines(&second), lines(&first));
    assert_eq!(slc::file::read(&second).write(), second);
    if let Ok(project) = slc::project::read(&text) {
        look(&project.main, &project.main.documentation);
        settles_as_json(&project);
        write(&project);
    }
}

/// SLC text migrated to Do-more, and the bytes as an address map.
pub fn migration(bytes: &[u8]) {
    use convert::migrate::{Options, map_file, migrate, report::Report};
    let text = slc::decode(bytes);
    let map = map_file::read(&text).unwrap_or_default();
    assert_eq!(map_file::read(&map_file::write(&map)).unwrap_or_default(), map);
    let Ok(project) = slc::project::read(&text) else { return };
    let image = &project.main;
    let rungs = image.ladder_files().flat_map(|file| file.rungs.iter().take_while(|rung| !rung.is_end())).count();
    for only_confirmed in [false, true] {
        let options = Options { only_confirmed };
        let Ok(migration) = migrate(image, &map, &options).or_else(|_| migrate(image, &[], &options)) else { return };
        assert_eq!(migration.rungs.len(), rungs, "a rung is lost");
        let text = domore::text::write(&migration.project);
        if let Ok(reading) = domore::text::read(&text) {
            assert!(reading.diagnostics.is_empty(), "{:?}", reading.diagnostics.first());
            assert!(domore::stack::check_project(&reading.project).is_empty());
        }
        let report = Report::new(&project.source, image, &migration, &options);
        assert!(report.html().ends_with("</html>\n") && report.json().ends_with("}\n"));
    }
}

/// A JSON document.
pub fn json(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok(project) = convert::json::from_json(text) {
        look(&project.main, &project.main.documentation);
        settles_as_json(&project);
        write(&project);
    }
}

/// A table of symbols: what is read is written and reads back the same.
pub fn csv(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let read = |text: &str| {
        let mut image = Image::default();
        convert::csv::read_symbols(text, &mut image).map(|()| image)
    };
    let write = |image: &Image| {
        let mut bytes = Vec::new();
        convert::csv::write_symbols(&image.documentation, &mut bytes).expect("memory takes all");
        String::from_utf8(bytes).expect("UTF-8")
    };
    if let Ok(image) = read(text) {
        // Line ends inside a description settle in the first step.
        let settle = |text: &str| write(&read(text).unwrap_or_else(|error| panic!("{error:?}\n{text}")));
        let first = settle(&write(&image));
        assert_eq!(settle(&first), first);
    }
}

/// A text for Do-more Designer, with everything that is done with one.
pub fn domore_text(bytes: &[u8]) {
    let Ok(document) = convert::designer::from_bytes(bytes, Source::default()) else { return };
    let mixed = document.diagnostics.iter().any(|it| it.problem == domore::Problem::MixedLineEnds);
    let written = convert::designer::to_bytes(&document.project);
    assert!(mixed || written == bytes, "a text does not come back");
    let again = convert::designer::from_bytes(&written, Source::default()).expect("what is written reads");
    assert_eq!(again.project, document.project);
    let documentation = domore::documentation::Documentation::new(&document.project);
    let style = render::Style::default();
    for block in document.project.code_blocks().take(4) {
        let last = 20.min(block.rungs.len());
        render::domore::code_block(&mut io::sink(), block, Some(0..=last), &documentation, &style)
            .expect("a sink takes all");
    }
    convert::designer::write_json(&document, io::sink()).expect("a sink takes all");
    if let Ok(xref) = domore::xref::CrossReference::build(&document.project) {
        let elements: Vec<&str> = xref.elements().take(20).collect();
        for element in elements {
            let _ = xref.of_element(element);
        }
    }
    domore_run(&document.project);
}

/// Whatever compiles runs in bounds, and its state comes back.
fn domore_run(project: &domore::Project) {
    use domore::engine::{Machine, Options, Program, Unsupported};
    let options = Options { unsupported: Unsupported::Stop, watchdog: 2_000, ..Options::default() };
    let Ok(program) = Program::compile(project, &options) else { return };
    let mut machine = Machine::new(program);
    machine.enter_run();
    for _ in 0..4 {
        machine.scan(std::time::Duration::from_millis(70));
    }
    let saved = machine.save();
    machine.restore(&saved).expect("its own state");
    assert!(machine.save() == saved, "a state does not come back");
    machine.enter_program();
}
