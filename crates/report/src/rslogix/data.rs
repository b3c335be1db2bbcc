//! The list of data files, and every data table in its radix.

use ladder::{DataFile, FileType, Radix, Value, member_name};

use super::{Context, remark};
use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Section, Table, Text};
use crate::options::Kind;
use crate::words;

pub(super) fn list<'a>(context: &Context<'a, '_>) -> Vec<Block<'a>> {
    let mut table = Table::new(&[
        ("Name", ColumnKind::Text),
        ("Number", ColumnKind::Number),
        ("Type", ColumnKind::Text),
        ("Words", ColumnKind::Number),
        ("Elements", ColumnKind::Number),
        ("Last", ColumnKind::Fixed),
        ("Description", ColumnKind::Text),
    ]);
    for file in files(&context.image().data_files) {
        table.row([
            Text::link(file.name.as_str(), anchor(file)),
            Text::link(file.number.to_string(), anchor(file)),
            Text::link(file.file_type.to_string(), anchor(file)),
            file.listed_words().to_string().into(),
            file.elements.to_string().into(),
            words::last_element(file).into(),
            (file.description.clone() + if file.has_forces() { "  [FORCED]" } else { "" }).into(),
        ]);
    }
    vec![Block::Table(table)]
}

/// Unused numbers are not listed, as on paper.
fn files(all: &[DataFile]) -> impl Iterator<Item = &DataFile> {
    all.iter().filter(|file| file.file_type != FileType::Unused)
}

fn anchor(file: &DataFile) -> Anchor {
    Anchor::element(&file.label())
}

pub(super) fn tables<'a>(context: &Context<'a, '_>, sections: &mut Vec<Section<'a>>) {
    let image = context.image();
    let data = files(&image.data_files).map(|file| ("Data File", file));
    let function = files(&image.function_files).map(|file| ("Function File", file));
    for (kind, file) in data.chain(function) {
        // Other types have no radix on paper.
        let radix = match file.value(0) {
            Some(Value::Word(_) | Value::Long(_)) => format!(" ({})", Radix::printed(file.file_type).as_str()),
            _ => String::new(),
        };
        let label = match file.file_type.implied_file() {
            Some(_) if !file.file_type.is_function_file() => format!("{}{}", file.file_type, file.number),
            _ => file.label(),
        };
        let name = if file.name.trim().is_empty() { String::new() } else { format!("  --  {}", file.name.trim()) };
        let description = match file.description.trim() {
            "" => String::new(),
            text => format!(" - {text}"),
        };
        sections.push(Section {
            kind: Kind::Data,
            anchor: anchor(file),
            title: format!("{kind} {label}{radix}{name}{description}"),
            short: format!("{label}{}", name.replace("--", "-")),
            blocks: vec![table(context, file)],
        });
    }
}

/// Rows of one look in a row, from this many on, become one: files are long and mostly zero.
const ALIKE: usize = 4;

/// One element: what stands in its row.
struct Line {
    address: String,
    reference: Anchor,
    cells: Vec<String>,
    forces: Vec<String>,
    documented: String,
}

fn table<'a>(context: &Context<'a, '_>, file: &DataFile) -> Block<'a> {
    if file.elements == 0 {
        return remark("The file has no elements.");
    }
    let radix = Radix::printed(file.file_type);
    let io = &context.image().io;
    let first = file.value(0);
    let mut columns = vec![("Offset", ColumnKind::Fixed)];
    columns.extend(match &first {
        Some(Value::Timer(_) | Value::Counter(_) | Value::Control(_)) => {
            let names = first.as_ref().map(Value::columns).map(|(names, _)| names).unwrap_or_default();
            names.iter().map(|name| (*name, ColumnKind::Number)).collect()
        }
        Some(Value::Word(_)) if radix == Radix::Binary => vec![(BITS, ColumnKind::Fixed)],
        Some(Value::Word(_)) if radix == Radix::Hexadecimal => {
            vec![("Hex", ColumnKind::Number), ("Decimal", ColumnKind::Number), (BITS, ColumnKind::Fixed)]
        }
        Some(Value::Text(_)) => vec![("Text", ColumnKind::Text)],
        Some(Value::Words(_)) => vec![("Words other than 0", ColumnKind::Text)],
        _ => vec![("Value", ColumnKind::Number)],
    });
    if file.has_forces() {
        columns.extend([("Forced on", ColumnKind::Fixed), ("Forced off", ColumnKind::Fixed)]);
    }
    columns.push(("(Symbol) Description", ColumnKind::Text));
    let mut table = Table::new(&columns);
    let lines = (0..file.elements).filter_map(|element| {
        let value = file.value(element)?;
        let address = file.element_address(element, io);
        let (symbol, description) = context.documented(&address);
        let mut documented = if symbol.is_empty() { String::new() } else { format!("({symbol})") };
        for part in [description, module(context, &address)] {
            if !part.is_empty() {
                documented = if documented.is_empty() { part } else { format!("{documented} {part}") };
            }
        }
        let forces = match file.forces.get(usize::from(element)).filter(|_| file.has_forces()) {
            Some(force) => {
                let mask = |mask: u16| if mask == 0 { String::new() } else { bits(mask) };
                vec![mask(force.on), mask(!force.off)]
            }
            None => Vec::new(),
        };
        let reference = context.reference(&address);
        Some(Line {
            address: address.to_string(),
            reference,
            cells: cells(file.file_type, &value, radix),
            forces,
            documented,
        })
    });
    let mut alike: Vec<Line> = Vec::new();
    for line in lines {
        let fits = |last: &Line| {
            last.cells == line.cells
                && last.forces == line.forces
                && last.documented.is_empty()
                && line.documented.is_empty()
        };
        if alike.last().is_some_and(|last| !fits(last)) {
            put(&mut table, &mut alike);
        }
        alike.push(line);
    }
    put(&mut table, &mut alike);
    Block::Table(table)
}

/// Writes lines of one look and forgets them.
fn put(table: &mut Table, alike: &mut Vec<Line>) {
    let count = alike.len();
    if count >= ALIKE
        && let [first, .., last] = alike.as_slice()
    {
        let mut cells: Vec<Text> = vec![Text::plain(format!("{} .. {}", first.address, last.address))];
        cells.extend(first.cells.iter().chain(&first.forces).map(|cell| cell.as_str().into()));
        cells.push(format!("{count} elements, all the same").into());
        table.row_at(Anchor::element(&first.address), cells);
        alike.clear();
        return;
    }
    for line in alike.drain(..) {
        let mut cells = vec![Text::link(line.address.as_str(), line.reference)];
        cells.extend(line.cells.into_iter().chain(line.forces).map(Text::from));
        cells.push(line.documented.into());
        table.row_at(Anchor::element(&line.address), cells);
    }
}

/// The module an I/O word belongs to, as paper prints it beside the word.
fn module(context: &Context<'_, '_>, address: &ladder::Address) -> String {
    let Some(point) = context.image().io.resolve(address) else { return String::new() };
    let module = &point.slot.module;
    [module.catalog.as_deref().unwrap_or("unknown module"), module.description.as_str()].join("  ").trim().to_owned()
}

/// Columns of bits as on paper, bit 0 at the right.
const BITS: &str = "15 14 13 12 11 10  9  8  7  6  5  4  3  2  1  0";

/// Bits under [`BITS`].
fn bits(word: u16) -> String {
    (0..16).rev().map(|bit| format!("{:>2}", word >> bit & 1)).collect::<Vec<_>>().join(" ")
}

fn cells(file_type: FileType, value: &Value, radix: Radix) -> Vec<String> {
    match value {
        Value::Timer(_) | Value::Counter(_) | Value::Control(_) => value.columns().1,
        Value::Word(word) if radix == Radix::Binary => vec![bits(word.cast_unsigned())],
        Value::Word(word) if radix == Radix::Hexadecimal => {
            let unsigned = word.cast_unsigned();
            vec![format!("{unsigned:04X}"), word.to_string(), bits(unsigned)]
        }
        Value::Text(text) => vec![text.clone()],
        Value::Words(words) => {
            let named = (0_u16..).zip(words).filter(|(_, word)| **word != 0).map(|(at, word)| {
                let name =
                    member_name(file_type, at, None).map_or_else(|| format!("word {at}"), |it| it.name.to_owned());
                format!("{name} {}", radix.word(*word))
            });
            let named: Vec<String> = named.collect();
            vec![if named.is_empty() { "all 0".to_owned() } else { named.join(", ") }]
        }
        value => vec![value.text(radix)],
    }
}
