//! `rungs migrate`: a program for another controller, with a report.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use analysis::proof::{self, RungFate};
use convert::migrate::report::Report;
use convert::migrate::{MapRow, Migration, Options, Verdict, map_file, migrate};
use ladder::{Image, Severity};

use super::{Opened, mode, open, prove, read_file};
use crate::args::MigrateArguments;
use crate::output::{Error, Outcome, printable};

/// Most bytes of an address map.
const MOST_MAP: usize = 64 << 20;

pub fn run(arguments: &MigrateArguments) -> Result<Outcome, Error> {
    let path = &arguments.file;
    let project = match open(path, mode(arguments.strict)) {
        Ok(project) => project,
        Err(why) => {
            eprintln!("{}", printable(&format!("{}: {why}", path.display())));
            return Ok(Outcome::Unreadable);
        }
    };
    let errors: Vec<_> = project.diagnostics.iter().filter(|found| found.severity == Severity::Error).collect();
    if !errors.is_empty() {
        for error in errors {
            eprintln!("{}", printable(&format!("{}: {}: {}", path.display(), error.place, error.message)));
        }
        eprintln!("{}: nothing written: a migration must start from the whole program", path.display());
        return Ok(Outcome::Unreadable);
    }
    let opened = Opened { path: path.clone(), project, choice: arguments.image };
    if opened.lacks_image() {
        return Ok(Outcome::Finding);
    }
    let map = match arguments.map.as_deref().map(read_map).transpose() {
        Ok(map) => map.unwrap_or_default(),
        Err(why) => {
            eprintln!("{}", printable(&why));
            return Ok(Outcome::Unreadable);
        }
    };
    // The online image has no documentation of its own.
    let image = Image { documentation: opened.documentation().clone(), ..opened.image().clone() };
    let options = Options { only_confirmed: arguments.only_confirmed };
    let migration = migrate(&image, &map, &options).map_err(|error| Error::Use(error.to_string()))?;
    let mut report = Report::new(&opened.project.source, &image, &migration, &options);
    let names = Names::of(&arguments.out, path);
    let mut writing: Vec<PathBuf> = names.all().map(Path::to_owned).to_vec();
    if arguments.prove {
        writing.extend(prove::FILES.map(|name| arguments.out.join(name)));
    }
    if let Some(there) = writing.iter().find(|target| target.exists() && !arguments.overwrite) {
        return Err(Error::Use(format!("{} exists; --overwrite replaces it", there.display())));
    }
    std::fs::create_dir_all(&arguments.out)?;
    std::fs::write(&names.program, convert::designer::to_bytes(&migration.project))?;
    std::fs::write(&names.map, map_file::write(&migration.map))?;
    std::fs::write(&names.initial, initial(&migration)?)?;
    std::fs::write(&names.documentation, documentation(&migration)?)?;
    let mut outcome = if report.counts.person > 0 { Outcome::Finding } else { Outcome::Done };
    if arguments.prove {
        let proof = proven(arguments, &image, &migration, &names);
        report.proof = Some(proof.to_string().lines().map(row).collect());
        prove::write(&proof, &arguments.out)?;
        outcome = outcome.max(prove::outcome(&proof));
    }
    std::fs::write(&names.json, report.json())?;
    std::fs::write(&names.html, report.html())?;
    print(arguments, &report, &migration, &names)?;
    Ok(outcome)
}

/// What is written.
struct Names {
    program: PathBuf,
    map: PathBuf,
    initial: PathBuf,
    documentation: PathBuf,
    json: PathBuf,
    html: PathBuf,
}

impl Names {
    fn of(folder: &Path, project: &Path) -> Names {
        let stem = project.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        Names {
            program: folder.join(format!("{stem}.txt")),
            map: folder.join("address-map.csv"),
            initial: folder.join("initial-values.csv"),
            documentation: folder.join("documentation.csv"),
            json: folder.join("report.json"),
            html: folder.join("report.html"),
        }
    }

    fn all(&self) -> [&Path; 6] {
        [&self.program, &self.map, &self.initial, &self.documentation, &self.json, &self.html]
    }
}

fn read_map(path: &Path) -> Result<Vec<MapRow>, String> {
    let named = |why: String| format!("{}: {why}", path.display());
    let bytes = read_file(path, MOST_MAP).map_err(named)?;
    // Spreadsheet programs write the code page of their country or UTF-8, as it happens.
    let text = convert::slc::decode(&bytes);
    map_file::read(&text).map_err(|error| named(error.to_string()))
}

fn table<const N: usize>(header: [&str; N], rows: impl Iterator<Item = [String; N]>) -> Result<Vec<u8>, Error> {
    let mut writer = csv::WriterBuilder::new().terminator(csv::Terminator::CRLF).from_writer(Vec::new());
    let failed = |error: csv::Error| Error::Write(std::io::Error::other(error));
    writer.write_record(header).map_err(failed)?;
    for row in rows {
        writer.write_record(row).map_err(failed)?;
    }
    writer.into_inner().map_err(|error| Error::Write(std::io::Error::other(error.to_string())))
}

fn initial(migration: &Migration) -> Result<Vec<u8>, Error> {
    let rows = migration.initial.iter().map(|row| [row.slc.clone(), row.domore.clone(), row.value.clone()]);
    table(["slc", "domore", "value"], rows)
}

fn documentation(migration: &Migration) -> Result<Vec<u8>, Error> {
    let rows = migration.project.documentation().map(|row| {
        let description = row.lines().join("\n");
        [row.element.clone(), row.nickname.clone(), description]
    });
    table(["domore", "nickname", "description"], rows)
}

/// The proof run over what was converted.
fn proven(arguments: &MigrateArguments, image: &Image, migration: &Migration, names: &Names) -> proof::Report {
    let fates: Vec<RungFate> = migration
        .rungs
        .iter()
        .map(|rung| {
            let texts = || rung.notes.iter().map(ToString::to_string);
            RungFate {
                file: rung.file,
                rung: rung.rung,
                person: (rung.verdict == Verdict::Person).then(|| texts().collect::<Vec<_>>().join("; ")),
                conditions: if rung.verdict == Verdict::Condition { texts().collect() } else { Vec::new() },
            }
        })
        .collect();
    let mut options = proof::Options { scans: arguments.scans, seed: arguments.seed, ..proof::Options::default() };
    options.original.program = prove::beside(&arguments.file, &arguments.out);
    options.other.program = prove::beside(&names.program, &arguments.out);
    let map = prove::of_rows(&migration.map);
    let progress = Arc::new(proof::Progress::default());
    options.progress = Some(progress.clone());
    prove::watched(&progress, options.scans, arguments.seconds, || {
        proof::prove_domore(image, &migration.project, &map, Some(&fates), &options)
    })
}

/// A line of the proof's report as name and value.
fn row(line: &str) -> (String, String) {
    match line.split_once(':') {
        Some((name, value)) if !name.starts_with(' ') => (name.to_owned(), value.trim().to_owned()),
        _ => (String::new(), line.trim().to_owned()),
    }
}

fn print(arguments: &MigrateArguments, report: &Report, migration: &Migration, names: &Names) -> Result<(), Error> {
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let document = serde_json::json!({"file": arguments.file.display().to_string(), "counts": report.counts,
            "unconfirmed": report.unconfirmed, "notes": report.notes, "marks": report.marks, "proof": report.proof});
        return Ok(writeln!(out, "{document}")?);
    }
    let counts = report.counts;
    writeln!(out, "{}", printable(&arguments.file.display().to_string()))?;
    writeln!(out, "  {:6} rungs", counts.rungs)?;
    writeln!(out, "  {:6} converted exactly", counts.exact)?;
    writeln!(out, "  {:6} converted with a stated condition", counts.condition)?;
    writeln!(out, "  {:6} need a person", counts.person)?;
    for rung in migration.rungs.iter().filter(|rung| rung.verdict == Verdict::Person) {
        for note in &rung.notes {
            writeln!(out, "         {}:{}  {}", rung.file, rung.rung, printable(&note.to_string()))?;
        }
    }
    for note in &migration.notes {
        writeln!(out, "  {}", printable(&note.to_string()))?;
    }
    if !report.unconfirmed.is_empty() {
        writeln!(out, "  {} forms were never checked against Designer, see the report", report.unconfirmed.len())?;
    }
    for (name, value) in report.proof.iter().flatten() {
        writeln!(out, "  {}", printable(&format!("{name}  {value}")))?;
    }
    for path in names.all() {
        writeln!(out, "  {}", printable(&path.display().to_string()))?;
    }
    Ok(())
}
