//! `rungs verify`: every byte accounted for.

use std::io::Write;
use std::path::Path;

use convert::AnyProject;
use convert::designer::is_designer;
use convert::verify::{CodeCheck, CodeDifference, check_code};
use serde_json::{Value, json};

use super::domore::{self, OpenedDomore};
use super::{MOST_BYTES, each_file, file_name, mode, read_file};
use crate::args::VerifyArguments;
use crate::output::{Columns, Error, Outcome, Printable};

pub fn run(arguments: &VerifyArguments) -> Result<Outcome, Error> {
    each_file(&arguments.files, arguments.json, |path, _, out| {
        let bytes = match read_file(path, MOST_BYTES) {
            Ok(bytes) => bytes,
            Err(why) => return Ok(Err(why)),
        };
        let project = match rss::Project::read(&bytes, mode(arguments.strict)) {
            Ok(project) => project,
            Err(_) if is_designer(&bytes) => return designer(path, &bytes, arguments, out),
            Err(why) => return Ok(Err(why.to_string())),
        };
        let name = path.display().to_string();
        let verification = rss::verify::verify(&project);
        let code = check_code(&project);
        let missing: Vec<_> = project.missing().collect();
        if arguments.json {
            writeln!(out, "{}", line(&name, &verification, &missing, &code))?;
        } else {
            print(&name, &verification, &missing, &code, &mut Printable(out))?;
        }
        Ok(Ok(judge(&verification, &missing, &code, arguments.strict)))
    })
}

/// A text for Do-more Designer.
fn designer(
    path: &Path,
    bytes: &[u8],
    arguments: &VerifyArguments,
    out: &mut dyn Write,
) -> Result<Result<Outcome, String>, Error> {
    match convert::open_any(bytes, &file_name(path), mode(arguments.strict)) {
        Ok(AnyProject::Domore(document)) => {
            let opened = OpenedDomore { path: path.to_owned(), document: *document };
            let outcome = domore::verify(&opened, bytes, arguments.json, &mut Printable(&mut *out))?;
            if !arguments.json {
                out.flush()?;
                opened.warn();
            }
            Ok(Ok(outcome))
        }
        Ok(AnyProject::Rslogix(_)) => Ok(Err("expected a project file or a Do-more text".to_owned())),
        Err(why) => Ok(Err(why.to_string())),
    }
}

/// A stream that is missing where there is no program without it, or could not be opened or read to
/// its end, is unreadable input; deviations, other missing streams, and bytes or code that differ, are a
/// finding. Read strictly, any deviation is unreadable input, as for every command.
fn judge(
    verification: &rss::verify::Verification,
    missing: &[&rss::Missing],
    code: &CodeCheck,
    strict: bool,
) -> Outcome {
    let deviations = || verification.streams.iter().flat_map(|stream| &stream.deviations);
    let unopened = deviations().any(|deviation| strict || deviation.space != rss::Space::Inflated);
    if unopened
        || missing.iter().any(|missing| missing.essential)
        || verification.streams.iter().any(|stream| stream.error.is_some())
    {
        Outcome::Unreadable
    } else if !verification.roundtrip
        || !code.differs.is_empty()
        || !missing.is_empty()
        || deviations().next().is_some()
    {
        Outcome::Finding
    } else {
        Outcome::Done
    }
}

fn line(name: &str, verification: &rss::verify::Verification, missing: &[&rss::Missing], code: &CodeCheck) -> Value {
    let streams = verification.streams.iter().map(|stream| {
        let mut value = json!({
            "stream": stream.stream,
            "bytes": stream.bytes,
            "understood": stream.understood,
            "identical": stream.identical,
        });
        if let Some(error) = &stream.error {
            value["error"] = error.to_string().into();
        }
        if !stream.deviations.is_empty() {
            value["deviations"] = stream.deviations.iter().map(ToString::to_string).collect();
        }
        value
    });
    json!({
        "file": name,
        "streams": streams.collect::<Value>(),
        "missing": missing.iter().map(|missing| missing.deviation.to_string()).collect::<Value>(),
        "roundtrip": verification.roundtrip,
        "code_agrees": code.agrees,
        "code_differs": code.differs.iter().map(difference).collect::<Value>(),
        "code_not_compiled": code.not_compiled,
        "code_not_comparable": code.not_comparable.iter().map(difference).collect::<Value>(),
    })
}

fn difference(difference: &CodeDifference) -> Value {
    json!({
        "stream": difference.stream,
        "file": difference.file,
        "rung": difference.rung,
        "instruction": difference.instruction,
        "text": difference.text,
        "code": difference.code,
    })
}

fn print(
    name: &str,
    verification: &rss::verify::Verification,
    missing: &[&rss::Missing],
    code: &CodeCheck,
    out: &mut impl Write,
) -> Result<(), Error> {
    writeln!(out, "{name}")?;
    let mut table = Columns::new(&["Stream", "Bytes", "Understood", "Rewrite"]);
    let (mut bytes, mut understood) = (0, 0);
    for stream in &verification.streams {
        bytes += stream.bytes;
        understood += stream.understood;
        let rewrite = if stream.identical { "identical" } else { "DIFFERS" };
        // The first character of the summary stream's name is a control character.
        let stream_name = stream.stream.escape_debug().to_string();
        table.row([stream_name, stream.bytes.to_string(), stream.understood.to_string(), rewrite.to_owned()]);
    }
    table.write(out, "  ")?;
    writeln!(out, "  {understood} of {bytes} bytes understood; the rest is carried unchanged")?;
    let whole = if verification.roundtrip { "reads back equal, stream by stream" } else { "DOES NOT read back equal" };
    writeln!(out, "  Written to a new file it {whole}")?;
    writeln!(
        out,
        "  Compiled code agrees with the operands of {} instructions, differs for {}; {} never compiled, {} not comparable",
        code.agrees,
        code.differs.len(),
        code.not_compiled,
        code.not_comparable.len()
    )?;
    for (what, list) in [("differs", &code.differs), ("not comparable", &code.not_comparable)] {
        for found in list {
            writeln!(
                out,
                "    {what}: {}, file {} rung {}: {} {} -- code: {}",
                found.stream, found.file, found.rung, found.instruction, found.text, found.code
            )?;
        }
    }
    for missing in missing {
        writeln!(out, "  {}: {}", if missing.essential { "ERROR" } else { "deviation" }, missing.deviation)?;
    }
    for stream in &verification.streams {
        if let Some(error) = &stream.error {
            writeln!(out, "  ERROR {error}")?;
        }
        for deviation in &stream.deviations {
            writeln!(out, "  deviation: {deviation}")?;
        }
    }
    Ok(())
}
