//! `rungs show`: the ladder in the terminal.

use std::io::{IsTerminal, Write};

use convert::slc::rung::rung_text;
use ladder::{ProgramFile, ProgramFileKind};
use serde_json::json;

use super::{Opened, domore, each_dialect, write_json};
use crate::args::ShowArguments;
use crate::output::{Error, Outcome};

/// Columns when nobody tells: what a printed page and a pipe take well.
const PIPE_WIDTH: usize = 100;

pub fn run(arguments: &ShowArguments) -> Result<Outcome, Error> {
    let terminal = std::io::stdout().is_terminal();
    let width = arguments.width.unwrap_or_else(|| match terminal_size::terminal_size() {
        Some((width, _)) if terminal => width.0.into(),
        _ => PIPE_WIDTH,
    });
    let style = render::Style {
        width,
        color: terminal && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty()),
        ascii: arguments.ascii,
        state: arguments.state,
        ..render::Style::default()
    };
    let slc = |opened: &Opened, out: &mut dyn Write| {
        let mut outcome = Outcome::Done;
        if !arguments.blocks.is_empty() {
            eprintln!("{}: program files have numbers, not names: use --file N", opened.path.display());
            outcome = Outcome::Finding;
        }
        for number in &arguments.program_files {
            if opened.image().program_file(*number).is_none_or(|file| file.kind != ProgramFileKind::Ladder) {
                eprintln!("{}: program file {number} holds no ladder", opened.path.display());
                outcome = Outcome::Finding;
            }
        }
        for file in chosen(opened, arguments) {
            if arguments.rung.is_some_and(|range| range.first >= file.rungs.len()) {
                let last = file.rungs.len().saturating_sub(1);
                eprintln!("{}: program file {} has rungs 0 to {last}", opened.path.display(), file.number);
                outcome = Outcome::Finding;
            }
        }
        if arguments.input.json {
            write_json(opened, describe(opened, arguments), out)?;
        } else {
            draw(opened, arguments, &style, out)?;
        }
        Ok(outcome)
    };
    each_dialect(&arguments.files, &arguments.input, slc, |opened, out| domore::show(opened, arguments, &style, out))
}

/// The ladder files that were asked for.
fn chosen<'o>(opened: &'o Opened, arguments: &'o ShowArguments) -> impl Iterator<Item = &'o ProgramFile> {
    let wanted = &arguments.program_files;
    opened.image().ladder_files().filter(move |file| wanted.is_empty() || wanted.contains(&file.number))
}

fn draw(opened: &Opened, arguments: &ShowArguments, style: &render::Style, out: &mut dyn Write) -> Result<(), Error> {
    writeln!(out, "{}\n", opened.title())?;
    for file in chosen(opened, arguments) {
        let range = arguments.rung.map(|range| range.first..=range.last);
        if range.as_ref().is_some_and(|range| *range.start() >= file.rungs.len()) {
            continue;
        }
        render::program_file(&mut *out, opened.image(), file, range, opened.documentation(), style)?;
        writeln!(out)?;
    }
    Ok(())
}

fn describe(opened: &Opened, arguments: &ShowArguments) -> serde_json::Value {
    let wanted = |index: &usize| arguments.rung.is_none_or(|range| (range.first..=range.last).contains(index));
    let files = chosen(opened, arguments).map(|file| {
        let rungs = file.rungs.iter().enumerate().filter(|(index, _)| wanted(index)).map(|(index, rung)| {
            let text = |value: &str| (!value.is_empty()).then(|| value.to_owned());
            json!({
                "number": index,
                "edited": rung.edited,
                "title": rung.comment.as_ref().and_then(|comment| text(&comment.title)),
                "comment": rung.comment.as_ref().and_then(|comment| text(&comment.text)),
                "text": rung_text(rung),
            })
        });
        json!({"number": file.number, "name": file.name, "rungs": rungs.collect::<serde_json::Value>()})
    });
    json!({"file": opened.path.display().to_string(), "program_files": files.collect::<serde_json::Value>()})
}
