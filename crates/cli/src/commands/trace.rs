//! Traces of a simulation: columns for reading, CSV, JSON lines, VCD.

use std::io::Write;
use std::path::Path;
use std::time::Duration;

use ladder::{Element, Series, Value, format_float};
use serde_json::{Map, json};
use sim::PowerFlow;
use sim::scenario::Controller;

use crate::args::TraceForm;
use crate::output::Error;

/// A value that is followed.
pub struct Column {
    /// Its address as text.
    pub heading: String,
    /// Its value before the first scan: decides how it is written.
    pub sample: Value,
}

/// A rung whose power flow is followed.
pub struct RungColumn {
    pub file: u16,
    pub rung: u16,
    /// Its instructions as text, in stored order.
    pub instructions: Vec<String>,
    /// Instructions and branches in the order they are read.
    pub parts: Vec<Part>,
}

/// A piece of a rung on one line.
pub enum Part {
    /// The instruction of this number.
    Instruction(usize),
    /// Where a branch begins, goes on with the next leg, and ends: `BST`, `NXB`, `BND`.
    Mark(&'static str),
}

/// The pieces of a rung.
pub fn parts(series: &Series) -> Vec<Part> {
    fn walk(series: &Series, next: &mut usize, parts: &mut Vec<Part>) {
        for element in series {
            match element {
                Element::Instruction(_) => {
                    parts.push(Part::Instruction(*next));
                    *next += 1;
                }
                Element::Branch(branch) => {
                    for (leg, inner) in branch.legs.iter().enumerate() {
                        parts.push(Part::Mark(if leg == 0 { "BST" } else { "NXB" }));
                        walk(inner, next, parts);
                    }
                    if !branch.legs.is_empty() {
                        parts.push(Part::Mark("BND"));
                    }
                }
            }
        }
    }
    let mut parts = Vec::new();
    walk(series, &mut 0, &mut parts);
    parts
}

/// What one scan left.
pub struct Row<'a> {
    /// From 1.
    pub scan: u64,
    pub time: Duration,
    pub values: Vec<Value>,
    pub flows: &'a [PowerFlow],
}

/// A form of trace.
pub trait Writer {
    fn head(&mut self, out: &mut dyn Write) -> Result<(), Error>;
    /// `last`: no row follows.
    fn row(&mut self, out: &mut dyn Write, row: &Row<'_>, last: bool) -> Result<(), Error>;
    fn foot(&mut self, _out: &mut dyn Write, _machine: &dyn Controller) -> Result<(), Error> {
        Ok(())
    }
}

/// The writer of a form. `approximations`: what runs only approximately, a line each; told in the forms
/// that have a place for it.
///
/// # Errors
/// The form cannot hold a column.
pub fn writer<'a>(
    form: TraceForm,
    columns: &'a [Column],
    rungs: &'a [RungColumn],
    program: &Path,
    approximations: &'a [String],
) -> Result<Box<dyn Writer + 'a>, Error> {
    let text = columns.iter().find(|column| matches!(column.sample, Value::Text(_)));
    Ok(match (form, text) {
        (TraceForm::Table, _) => Box::new(Table { columns, rungs, widths: Vec::new(), last: None }),
        (TraceForm::Csv, _) => Box::new(Csv { columns, rungs }),
        (TraceForm::Json, _) => Box::new(Json { columns, rungs, approximations }),
        (TraceForm::Vcd, Some(column)) => {
            return Err(Error::Use(format!("{} is a string: a value change dump holds none", column.heading)));
        }
        (TraceForm::Vcd, None) => {
            let scope = program.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
            Box::new(Vcd { columns, rungs, scope, approximations, last: Vec::new() })
        }
    })
}

fn seconds(time: Duration) -> String {
    format!("{:.6}", time.as_secs_f64()).trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn plain(value: &Value) -> String {
    match value {
        Value::Bit(bit) => u8::from(*bit).to_string(),
        Value::Word(word) => word.to_string(),
        Value::Long(long) => long.to_string(),
        Value::Float(float) => format_float(*float),
        Value::Text(text) => text.clone(),
        other => format!("{other:?}"),
    }
}

/// The last execution of an instruction in a scan; `None` when the scan passed it over.
fn flow<'f>(row: &Row<'f>, rung: &RungColumn, instruction: usize) -> Option<&'f PowerFlow> {
    let here = |flow: &&PowerFlow| {
        (flow.file, flow.rung, usize::from(flow.instruction)) == (rung.file, rung.rung, instruction)
    };
    row.flows.iter().rev().find(here)
}

/// Columns for reading; only rows in which something changed, the first and the last.
struct Table<'a> {
    columns: &'a [Column],
    rungs: &'a [RungColumn],
    widths: Vec<usize>,
    last: Option<(Vec<Value>, Vec<String>)>,
}

impl Writer for Table<'_> {
    fn head(&mut self, out: &mut dyn Write) -> Result<(), Error> {
        write!(out, "{:>8}  {:>10}", "scan", "time s")?;
        for column in self.columns {
            let heading = column.heading.clone();
            // The widest number of its kind, so that columns stand.
            let least = match column.sample {
                Value::Bit(_) => 1,
                Value::Word(_) => 6,
                Value::Text(_) => 20,
                _ => 12,
            };
            self.widths.push(heading.chars().count().max(least));
            write!(out, "  {heading:>width$}", width = self.widths.last().copied().unwrap_or(least))?;
        }
        writeln!(out)?;
        Ok(())
    }

    fn row(&mut self, out: &mut dyn Write, row: &Row<'_>, last: bool) -> Result<(), Error> {
        let rungs: Vec<String> = self.rungs.iter().map(|rung| power(row, rung)).collect();
        let state = (row.values.clone(), rungs);
        if !last && self.last.as_ref() == Some(&state) {
            return Ok(());
        }
        write!(out, "{:>8}  {:>10}", row.scan, seconds(row.time))?;
        for (value, width) in row.values.iter().zip(&self.widths) {
            write!(out, "  {:>width$}", plain(value))?;
        }
        writeln!(out)?;
        for text in &state.1 {
            writeln!(out, "          {text}")?;
        }
        self.last = Some(state);
        Ok(())
    }
}

/// A rung in one scan, power marked at every instruction and branches as rung text writes them:
/// `rung 2:4  BST ━[XIC B3:0/0]━ NXB ━[XIC B3:0/1]╌ BND ━[OTE B3:0/2]━`.
fn power(row: &Row<'_>, rung: &RungColumn) -> String {
    let mut text = format!("rung {}:{} ", rung.file, rung.rung);
    let mut executed = false;
    for part in &rung.parts {
        let line = |on: bool| if on { '━' } else { '╌' };
        let index = match part {
            Part::Mark(mark) => {
                text.push_str(&format!(" {mark}"));
                continue;
            }
            Part::Instruction(index) => *index,
        };
        let instruction = rung.instructions.get(index).map_or("", String::as_str);
        match flow(row, rung, index) {
            Some(flow) => {
                executed = true;
                text.push_str(&format!(" {}[{instruction}]{}", line(flow.before), line(flow.after)));
            }
            None => text.push_str(&format!("  [{instruction}] ")),
        }
    }
    if executed { text } else { format!("rung {}:{}  not scanned", rung.file, rung.rung) }
}

/// The columns of a traced rung in tables of values: `2:4.1 TON T4:0 0.01 100 0`.
fn flow_headings(rungs: &[RungColumn]) -> impl Iterator<Item = String> {
    rungs.iter().flat_map(|rung| {
        let heading = move |(index, text): (usize, &String)| format!("{}:{}.{index} {text}", rung.file, rung.rung);
        rung.instructions.iter().enumerate().map(heading)
    })
}

/// Power behind every instruction of the traced rungs.
fn flows<'f>(row: &'f Row<'_>, rungs: &'f [RungColumn]) -> impl Iterator<Item = Option<bool>> {
    rungs.iter().flat_map(move |rung| (0..rung.instructions.len()).map(move |i| flow(row, rung, i).map(|f| f.after)))
}

struct Csv<'a> {
    columns: &'a [Column],
    rungs: &'a [RungColumn],
}

impl Csv<'_> {
    fn record(out: &mut dyn Write, cells: impl Iterator<Item = String>) -> Result<(), Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let text = writer.write_record(cells.collect::<Vec<_>>()).map_err(std::io::Error::other);
        text?;
        let bytes = writer.into_inner().map_err(|error| std::io::Error::other(error.to_string()))?;
        out.write_all(&bytes)?;
        Ok(())
    }
}

impl Writer for Csv<'_> {
    fn head(&mut self, out: &mut dyn Write) -> Result<(), Error> {
        let addresses = self.columns.iter().map(|column| column.heading.clone());
        let cells = ["scan".to_owned(), "time_s".to_owned()].into_iter().chain(addresses);
        Self::record(out, cells.chain(flow_headings(self.rungs)))
    }

    fn row(&mut self, out: &mut dyn Write, row: &Row<'_>, _last: bool) -> Result<(), Error> {
        let cells = [row.scan.to_string(), seconds(row.time)].into_iter().chain(row.values.iter().map(plain));
        let power = flows(row, self.rungs).map(|on| on.map_or(String::new(), |on| u8::from(on).to_string()));
        Self::record(out, cells.chain(power))
    }
}

struct Json<'a> {
    columns: &'a [Column],
    rungs: &'a [RungColumn],
    approximations: &'a [String],
}

impl Writer for Json<'_> {
    fn head(&mut self, _out: &mut dyn Write) -> Result<(), Error> {
        Ok(())
    }

    fn row(&mut self, out: &mut dyn Write, row: &Row<'_>, _last: bool) -> Result<(), Error> {
        let value = |value: &Value| match value {
            Value::Bit(bit) => json!(u8::from(*bit)),
            Value::Word(word) => json!(word),
            Value::Long(long) => json!(long),
            // JSON has no numbers for NaN and infinity.
            Value::Float(float) if float.is_finite() => json!(float),
            other => json!(plain(other)),
        };
        let pairs = self.columns.iter().zip(&row.values);
        let values: Map<_, _> = pairs.map(|(column, found)| (column.heading.clone(), value(found))).collect();
        let mut line = json!({"scan": row.scan, "time_s": row.time.as_secs_f64(), "values": values});
        if !self.rungs.is_empty() {
            let rungs: Map<_, _> = self
                .rungs
                .iter()
                .map(|rung| {
                    let one = |(index, text): (usize, &String)| match flow(row, rung, index) {
                        Some(flow) => json!({"instruction": text, "before": flow.before, "after": flow.after}),
                        None => json!({"instruction": text, "before": null, "after": null}),
                    };
                    let flows: serde_json::Value = rung.instructions.iter().enumerate().map(one).collect();
                    (format!("{}:{}", rung.file, rung.rung), flows)
                })
                .collect();
            line["rungs"] = json!(rungs);
        }
        writeln!(out, "{line}")?;
        Ok(())
    }

    fn foot(&mut self, out: &mut dyn Write, machine: &dyn Controller) -> Result<(), Error> {
        let line = json!({
            "end": true,
            "scans": machine.scans(),
            "time_s": machine.now().as_secs_f64(),
            "fault": machine.stopped().map(|stop| stop.text),
            "strays": machine.strays(),
            "approximations": self.approximations,
        });
        writeln!(out, "{line}")?;
        Ok(())
    }
}

/// IEEE 1364 value change dump, time in microseconds.
struct Vcd<'a> {
    columns: &'a [Column],
    rungs: &'a [RungColumn],
    scope: String,
    approximations: &'a [String],
    /// What was written last, a text per variable.
    last: Vec<String>,
}

/// A short name of printable characters for variable `index`.
fn code(mut index: usize) -> String {
    let mut code = String::new();
    loop {
        // 94 printable characters from `!` on.
        code.push(char::from(b'!' + (index % 94) as u8));
        index /= 94;
        if index == 0 {
            return code;
        }
        index -= 1;
    }
}

/// Names end at blanks, and viewers take dots for scopes, brackets for bit ranges, and colons too: GTKWave
/// drops a variable with a colon in its name.
fn vcd_name(text: &str) -> String {
    let plain = |c: char| match c {
        '.' | ':' | '[' | ']' | '$' | '\\' => '_',
        c if c.is_ascii_graphic() => c,
        _ => '_',
    };
    let name: String = text.chars().map(plain).collect();
    if name.is_empty() { "program".to_owned() } else { name }
}

impl Vcd<'_> {
    fn states(&self, row: &Row<'_>) -> Vec<String> {
        let values = row.values.iter().map(|value| match value {
            Value::Bit(bit) => u8::from(*bit).to_string(),
            Value::Word(word) => format!("b{:016b} ", word.cast_unsigned()),
            Value::Long(long) => format!("b{:032b} ", long.cast_unsigned()),
            Value::Float(float) => format!("r{float:e} "),
            _ => "x".to_owned(),
        });
        let power = flows(row, self.rungs).map(|on| on.map_or("x", |on| if on { "1" } else { "0" }).to_owned());
        values.chain(power).collect()
    }
}

impl Writer for Vcd<'_> {
    fn head(&mut self, out: &mut dyn Write) -> Result<(), Error> {
        writeln!(out, "$version rungs {} $end", env!("CARGO_PKG_VERSION"))?;
        for line in self.approximations {
            // A dollar sign could end the comment.
            writeln!(out, "$comment approximate: {} $end", line.replace('$', "_"))?;
        }
        writeln!(out, "$timescale 1 us $end")?;
        writeln!(out, "$scope module {} $end", vcd_name(&self.scope))?;
        for (index, column) in self.columns.iter().enumerate() {
            let (kind, size) = match column.sample {
                Value::Word(_) => ("wire", 16),
                Value::Long(_) => ("wire", 32),
                Value::Float(_) => ("real", 64),
                _ => ("wire", 1),
            };
            writeln!(out, "$var {kind} {size} {} {} $end", code(index), vcd_name(&column.heading))?;
        }
        for (index, heading) in flow_headings(self.rungs).enumerate() {
            writeln!(out, "$var wire 1 {} {} $end", code(self.columns.len() + index), vcd_name(&heading))?;
        }
        writeln!(out, "$upscope $end\n$enddefinitions $end")?;
        Ok(())
    }

    fn row(&mut self, out: &mut dyn Write, row: &Row<'_>, last: bool) -> Result<(), Error> {
        let states = self.states(row);
        let first = self.last.is_empty();
        let changed: Vec<usize> =
            (0..states.len()).filter(|index| first || self.last.get(*index) != states.get(*index)).collect();
        if !changed.is_empty() || last {
            writeln!(out, "#{}", row.time.as_micros())?;
            if first {
                writeln!(out, "$dumpvars")?;
            }
            for index in changed {
                writeln!(out, "{}{}", states.get(index).map_or("x", String::as_str), code(index))?;
            }
            if first {
                writeln!(out, "$end")?;
            }
        }
        self.last = states;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_printable_and_distinct() {
        let codes: Vec<_> = (0..20_000).map(code).collect();
        assert!(codes.iter().all(|code| code.bytes().all(|b| b.is_ascii_graphic())));
        let distinct: std::collections::BTreeSet<_> = codes.iter().collect();
        assert_eq!(distinct.len(), codes.len());
    }

    #[test]
    fn names_hold_nothing_a_viewer_misreads() {
        assert_eq!(vcd_name("T4:0.ACC"), "T4_0_ACC");
        assert_eq!(vcd_name("2:4.1 TON T4:0 0.01 100 0"), "2_4_1_TON_T4_0_0_01_100_0");
    }
}
