//! `rungs diff`: what changed between two programs.

mod folders;
mod json;
mod text;
mod text_side;
mod unified;

use std::io::{IsTerminal, Write};
use std::path::Path;

use analysis::diff::{Difference, Side, compare};
use convert::AnyProject;
use ladder::{Documentation, Image, Project, Severity};

use super::{MOST_BYTES, diagnostics_json, file_name, mode, read_file};
use crate::args::{DiffArguments, Section};
use crate::output::{Error, Outcome, Printable, printable};
use folders::Paired;

/// Columns when nobody tells.
const PIPE_WIDTH: usize = 100;

/// Narrowest terminal for two rungs beside each other.
const TWO_SIDED: usize = 2 * render::MIN_WIDTH + 3;

/// Which sections count and are shown.
#[derive(Clone, Copy)]
pub(super) struct Sections {
    logic: bool,
    documentation: bool,
    values: bool,
    configuration: bool,
}

impl Sections {
    fn of(chosen: &[Section]) -> Sections {
        let has = |section| chosen.is_empty() || chosen.contains(&section);
        Sections {
            logic: has(Section::Logic),
            documentation: has(Section::Documentation),
            values: has(Section::Values),
            configuration: has(Section::Configuration),
        }
    }

    /// Leaves what was not asked for out of a difference.
    fn apply(self, difference: &mut Difference) {
        if !self.logic {
            difference.logic.clear();
            difference.renames.clear();
        }
        if !self.documentation {
            difference.documentation.clear();
        }
        if !self.values {
            difference.values.clear();
        }
        if !self.configuration {
            difference.configuration.clear();
        }
    }
}

/// A program with its name on the command line.
pub(super) struct Program<'a> {
    pub(super) name: String,
    pub(super) image: &'a Image,
    pub(super) documentation: &'a Documentation,
}

impl<'a> Program<'a> {
    fn main(path: &Path, project: &'a Project) -> Program<'a> {
        let image = &project.main;
        Program { name: path.display().to_string(), image, documentation: &image.documentation }
    }
}

/// How results are written.
struct Printer {
    sections: Sections,
    json: bool,
    unified: bool,
    look: text::Look,
}

pub fn run(arguments: &DiffArguments) -> Result<Outcome, Error> {
    let terminal = std::io::stdout().is_terminal();
    let width = arguments.width.unwrap_or_else(|| match terminal_size::terminal_size() {
        Some((width, _)) if terminal => width.0.into(),
        _ => PIPE_WIDTH,
    });
    let printer = Printer {
        sections: Sections::of(&arguments.only),
        json: arguments.json,
        unified: arguments.unified,
        look: text::Look {
            width: width.clamp(render::MIN_WIDTH, render::MAX_WIDTH),
            two_sided: arguments.two_sided || width >= TWO_SIDED,
            color: terminal && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty()),
        },
    };
    let mut out = std::io::BufWriter::new(std::io::stdout().lock());
    let outcome = match (&arguments.new, arguments.online) {
        (Some(_), true) => {
            return Err(Error::Use("--online compares the two images of one file: leave out the second".to_owned()));
        }
        (None, false) => {
            return Err(Error::Use("expected a second file or folder, or --online for the online image".to_owned()));
        }
        (None, true) => online(&arguments.old, arguments.strict, &printer, &mut out)?,
        (Some(new), false) => match (arguments.old.is_dir(), new.is_dir()) {
            (false, false) => pair((&arguments.old, new), arguments.strict, None, &printer, &mut out)?,
            (true, true) => folders::compare(&arguments.old, new, arguments.strict, &printer, &mut out)?,
            _ => return Err(Error::Use("expected two files or two folders, found one of each".to_owned())),
        },
    };
    out.flush()?;
    Ok(outcome)
}

/// The image last exchanged with a processor, against the program as an engineer opens it.
fn online(path: &Path, strict: bool, printer: &Printer, out: &mut dyn Write) -> Result<Outcome, Error> {
    if path.is_dir() {
        return Err(Error::Use("--online takes a file, not a folder".to_owned()));
    }
    let Some((project, _)) = opened(path, strict, printer, out)? else { return Ok(Outcome::Unreadable) };
    let Some(image) = &project.online else {
        return Err(Error::Use(format!("{}: the project holds no online image", path.display())));
    };
    let documentation = &project.main.documentation;
    let name = path.display();
    let old = Program { name: format!("{name} (online image)"), image, documentation };
    let new = Program { name: name.to_string(), image: &project.main, documentation };
    let difference =
        compare(Side { image, documentation: None }, Side { image: &project.main, documentation: Some(documentation) });
    printer.print((&old, &new), None, difference, &[&project], out)
}

/// Two files; `how` they were found to belong together if their folders are compared.
fn pair(
    (old, new): (&Path, &Path),
    strict: bool,
    how: Option<Paired>,
    printer: &Printer,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let (a, b) = (opened(old, strict, printer, out)?, opened(new, strict, printer, out)?);
    let (Some((a, a_is_text)), Some((b, b_is_text))) = (a, b) else { return Ok(Outcome::Unreadable) };
    let (x, y) = (Program::main(old, &a), Program::main(new, &b));
    let mut difference = compare(
        Side { image: x.image, documentation: Some(x.documentation) },
        Side { image: y.image, documentation: Some(y.documentation) },
    );
    text_side::leave_out(&mut difference, a_is_text, b_is_text);
    let outcome = printer.print((&x, &y), how, difference, &[&a, &b], out);
    // Giving back two large models piece by piece would take longer than comparing them.
    std::mem::forget((a, b));
    outcome
}

/// A project and whether it is rung text, or `None` when it cannot be read, which is reported.
fn opened(path: &Path, strict: bool, printer: &Printer, out: &mut dyn Write) -> Result<Option<(Project, bool)>, Error> {
    let read = read_file(path, MOST_BYTES).and_then(|bytes| {
        let project = convert::open_any(&bytes, &file_name(path), mode(strict)).map_err(|error| error.to_string())?;
        Ok((project, text_side::is_text(&bytes)))
    });
    let why = match read {
        Ok((AnyProject::Rslogix(project), is_text)) => return Ok(Some((*project, is_text))),
        Ok((AnyProject::Domore(_), _)) => {
            let why = "programs of Do-more are not compared by this command; their text form is made for any text \
                       comparison";
            return Err(Error::Use(printable(&format!("{}: {why}", path.display()))));
        }
        Err(why) => why,
    };
    if printer.json {
        writeln!(out, "{}", serde_json::json!({"file": path.display().to_string(), "error": why}))?;
    }
    eprintln!("{}", printable(&format!("{}: {why}", path.display())));
    Ok(None)
}

impl Printer {
    fn print(
        &self,
        (old, new): (&Program<'_>, &Program<'_>),
        how: Option<Paired>,
        mut difference: Difference,
        projects: &[&Project],
        out: &mut dyn Write,
    ) -> Result<Outcome, Error> {
        self.sections.apply(&mut difference);
        let broken = |project: &&&Project| project.diagnostics.iter().any(|d| d.severity == Severity::Error);
        let broken: Vec<&&Project> = projects.iter().filter(broken).collect();
        if self.json {
            let mut document = json::describe(old, new, &difference);
            if let Some(how) = how {
                document["paired_by"] = how.as_str().into();
            }
            document["diagnostics"] = projects.iter().map(|project| diagnostics_json(project)).collect();
            writeln!(out, "{document}")?;
        } else {
            let renamed = match how {
                Some(Paired::Bytes) => "the same bytes under another name",
                Some(Paired::Content) => "found under another name by its content",
                _ => "",
            };
            if !renamed.is_empty() {
                writeln!(Printable(&mut *out), "# {} is now {}: {renamed}", old.name, new.name)?;
            }
            if self.unified {
                unified::write(self.sections, (old, new), &difference, out)?;
            } else if how.is_some() && difference.is_empty() {
                writeln!(Printable(&mut *out), "{}: equal\n", new.name)?;
            } else {
                text::write(&self.look, self.sections, (old, new), &difference, out)?;
            }
        }
        out.flush()?;
        for project in &broken {
            let errors = || project.diagnostics.iter().filter(|d| d.severity == Severity::Error);
            for found in errors().take(5) {
                let line = format!("{}: {}: {}", project.source.file, found.place, found.message);
                eprintln!("{}", printable(&line));
            }
            let count = errors().count();
            eprintln!(
                "{}: not all of it could be read ({count} errors): what is equal above may differ there",
                printable(&project.source.file)
            );
        }
        Ok(match (broken.is_empty(), difference.is_empty()) {
            (false, _) => Outcome::Unreadable,
            (true, true) => Outcome::Done,
            (true, false) => Outcome::Finding,
        })
    }
}
