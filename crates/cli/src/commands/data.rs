//! `rungs data`: data tables.

use std::io::Write;

use ladder::{Address, DataFile, FileType, Radix, Value, format_float};
use serde::{Serialize, Serializer};
use serde_json::json;

use super::{Opened, diagnostics_json, domore, each_dialect, one_line};
use crate::args::DataArguments;
use crate::files;
use crate::output::{Columns, Error, Outcome, Printable};

pub fn run(arguments: &DataArguments) -> Result<Outcome, Error> {
    let (paths, wanted) = files::split(&arguments.files);
    let slc = |opened: &Opened, out: &mut dyn Write| {
        // JSON has its own way to spell control characters.
        let mut printable = Printable(&mut *out);
        let out: &mut dyn Write = if arguments.input.json { out } else { &mut printable };
        let mut outcome = Outcome::Done;
        let (mut json_files, mut json_function_files) = (Vec::new(), Vec::new());
        let mut json_values = Vec::new();
        if !arguments.input.json {
            writeln!(out, "{}", opened.title())?;
        }
        for choice in choices(opened, &wanted) {
            match choice {
                Choice::File(file) if arguments.input.json => {
                    let row = FileRow::of(opened, file);
                    // Function files share numbers with data files.
                    match is_function_file(opened, file) {
                        true => json_function_files.push(row),
                        false => json_files.push(row),
                    }
                }
                Choice::File(file) => print_file(opened, file, arguments.radix, out)?,
                Choice::Address(address) => {
                    let value = opened.image().value_at(&address);
                    let text = value.as_ref().map(|value| value.text(radix_of(address.file_type, arguments.radix)));
                    if value.is_none() {
                        eprintln!("{}: {address} is not in the data table", opened.path.display());
                        outcome = Outcome::Finding;
                    }
                    if arguments.input.json {
                        json_values
                            .push(json!({"address": address.to_string(), "value": value.as_ref().map(value_json)}));
                    } else if let Some(text) = text {
                        let shown = opened.documentation().shown(&(&address).into(), "");
                        let symbol = shown.symbol.unwrap_or_default();
                        writeln!(
                            out,
                            "{}",
                            format!("{address}  {text}  {symbol}  {}", one_line(&shown.description)).trim_end()
                        )?;
                    }
                }
                Choice::Unknown(text) => {
                    eprintln!("{}: `{text}` is no data file, address or symbol of this project", opened.path.display());
                    outcome = Outcome::Finding;
                }
            }
        }
        if arguments.input.json {
            let document = Document {
                file: opened.path.display().to_string(),
                data_files: json_files,
                function_files: json_function_files,
                values: json_values,
                diagnostics: diagnostics_json(&opened.project),
            };
            serde_json::to_writer(&mut *out, &document).map_err(std::io::Error::from)?;
            writeln!(out)?;
        }
        Ok(outcome)
    };
    each_dialect(&paths, &arguments.input, slc, |opened, out| domore::data(opened, &wanted, arguments.input.json, out))
}

#[derive(Serialize)]
struct Document<'o> {
    file: String,
    data_files: Vec<FileRow<'o>>,
    function_files: Vec<FileRow<'o>>,
    values: Vec<serde_json::Value>,
    diagnostics: serde_json::Value,
}

fn is_function_file(opened: &Opened, file: &DataFile) -> bool {
    opened.image().function_files.iter().any(|of| std::ptr::eq(of, file))
}

enum Choice<'o> {
    File(&'o DataFile),
    Address(Address),
    Unknown(String),
}

fn choices<'o>(opened: &'o Opened, wanted: &[String]) -> Vec<Choice<'o>> {
    let image = opened.image();
    let files = || image.data_files.iter().chain(&image.function_files).filter(|f| f.file_type != FileType::Unused);
    if wanted.is_empty() {
        return files().map(Choice::File).collect();
    }
    let choose = |text: &String| {
        if let Some(file) = files().find(|file| {
            let plain = file.file_type.implied_file() == Some(file.number);
            file.label().eq_ignore_ascii_case(text) || (plain && file.file_type.to_string().eq_ignore_ascii_case(text))
        }) {
            return Choice::File(file);
        }
        let address = Address::parse(text).ok().or_else(|| {
            let entry = opened.documentation().by_symbol(text)?;
            entry.target.direct_address().cloned()
        });
        address.map_or_else(|| Choice::Unknown(text.clone()), Choice::Address)
    };
    wanted.iter().map(choose).collect()
}

/// The radix that was asked for, or the one of paper.
fn radix_of(file_type: FileType, chosen: Option<crate::args::Radix>) -> Radix {
    chosen.map_or_else(|| Radix::printed(file_type), Radix::from)
}

fn print_file(
    opened: &Opened,
    file: &DataFile,
    radix: Option<crate::args::Radix>,
    out: &mut dyn Write,
) -> Result<(), Error> {
    let radix = radix_of(file.file_type, radix);
    let name = [file.name.as_str(), file.description.as_str()].into_iter().filter(|part| !part.is_empty());
    let name = name.collect::<Vec<_>>().join(" - ");
    writeln!(out, "\nData file {}  {}  ({} elements)", file.label(), name, file.elements)?;
    let symbol = |element: u16| {
        let address = file.element_address(element, &opened.image().io);
        let shown = opened.documentation().shown(&(&address).into(), "");
        shown.symbol.unwrap_or_else(|| one_line(&shown.description))
    };
    let first = file.value(0);
    let structured = first.as_ref().map(Value::columns).filter(|(names, _)| !names.is_empty());
    let mut table = match (&structured, file.words_per_element, file.file_type) {
        (Some((names, _)), _, _) => {
            let mut headings = vec!["Address"];
            headings.extend(*names);
            headings.push("Symbol");
            Columns::new(&headings)
        }
        // Forces and a symbol per word leave no room for several words in a row.
        _ if !file.forces.is_empty() => Columns::new(&["Address", "Value", "Forced on", "Forced off", "Symbol"]),
        _ => Columns::new(&["Address", "Value", "Symbol"]),
    };
    for element in 0..file.elements {
        let Some(value) = file.value(element) else { continue };
        let mut row = vec![file.element_address(element, &opened.image().io).to_string()];
        match &structured {
            Some(_) => row.extend(value.columns().1),
            None => row.push(value.text(radix)),
        }
        if let Some(force) = file.forces.get(usize::from(element)) {
            let mask = |bits: u16| if bits == 0 { String::new() } else { Radix::Binary.word(bits) };
            row.extend([mask(force.on), mask(!force.off)]);
        }
        row.push(symbol(element));
        table.row(row);
    }
    Ok(table.write(out, "  ")?)
}

/// The value of an element in JSON: numbers, strings, an object for a structured element.
fn value_json(value: &Value) -> serde_json::Value {
    let (names, cells) = value.columns();
    // All cells but the time base are integers.
    let cell = |cell: String| cell.parse::<i64>().map_or_else(|_| json!(cell), |number| json!(number));
    match value {
        Value::Bit(bit) => json!(u8::from(*bit)),
        Value::Word(word) => json!(word),
        Value::Long(long) => json!(long),
        Value::Float(float) if float.is_finite() => json!(float),
        Value::Float(float) => json!(format_float(*float)),
        Value::Words(words) => words.iter().map(|word| word.cast_signed()).collect(),
        Value::Text(text) => json!(text),
        Value::Timer(_) | Value::Counter(_) | Value::Control(_) => {
            let name = |name: &str| if name == "BASE" { "base".to_owned() } else { name.to_owned() };
            names.iter().zip(cells).map(|(n, c)| (name(n), cell(c))).collect::<serde_json::Map<_, _>>().into()
        }
    }
}

/// A data file in JSON, its values made one by one while they are written.
#[derive(Serialize)]
struct FileRow<'o> {
    number: u16,
    #[serde(rename = "type")]
    file_type: String,
    name: &'o str,
    description: &'o str,
    elements: u16,
    values: Values<'o>,
}

struct Values<'o> {
    opened: &'o Opened,
    file: &'o DataFile,
}

impl<'o> FileRow<'o> {
    fn of(opened: &'o Opened, file: &'o DataFile) -> FileRow<'o> {
        FileRow {
            number: file.number,
            file_type: file.file_type.to_string(),
            name: &file.name,
            description: &file.description,
            elements: file.elements,
            values: Values { opened, file },
        }
    }
}

impl Serialize for Values<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq((0..self.file.elements).filter_map(|element| {
            let value = value_json(&self.file.value(element)?);
            let address = self.file.element_address(element, &self.opened.image().io).to_string();
            Some(json!({"address": address, "value": value}))
        }))
    }
}
