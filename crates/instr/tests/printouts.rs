//! Compares titles and operand names with the instruction boxes in reports printed by RSLogix 500.
//!
//! A box on paper is the mnemonic, centred over the title, and below the title the operand names at
//! the column of the title, each with its text at the right; a value last displayed stands on a line
//! of its own:
//!
//! ```text
//!                     GRT
//!     Greater Than (A>B)
//!     Source A        N7:0
//!                        0<
//!     Source B          15
//!                       15<
//! ```

use std::collections::BTreeMap;
use std::fs;

use instr::{Drawing, Form, Instruction, Names, Stored, all, by_mnemonic};

/// A run of text without two blanks in a row: first column and text.
type Segment = (usize, String);

fn segments(line: &str) -> Vec<Segment> {
    let chars: Vec<char> = line.chars().collect();
    let blank = |at: usize| chars.get(at).is_none_or(|c| c.is_whitespace());
    let mut found = Vec::new();
    let mut at = 0;
    while at < chars.len() {
        if blank(at) {
            at += 1;
            continue;
        }
        let start = at;
        while at < chars.len() && !(blank(at) && blank(at + 1)) {
            at += 1;
        }
        found.push((start, chars[start..at].iter().collect::<String>().trim_end().to_owned()));
    }
    found
}

/// Text extraction moves the rows of a box by up to this many columns against each other.
const DRIFT: usize = 5;

/// The segment of `line` that begins at the left edge of a box.
fn at_edge(line: &str, edge: usize) -> Option<Segment> {
    segments(line)
        .into_iter()
        .filter(|(column, _)| column.abs_diff(edge) <= DRIFT)
        .min_by_key(|(column, _)| column.abs_diff(edge))
}

#[derive(Default)]
struct Tally {
    boxes: BTreeMap<&'static str, usize>,
    rows: usize,
    flags: usize,
    wrong: Vec<String>,
}

/// Whether any form is drawn as a box; only those have a title on paper.
fn is_box(instruction: &Instruction) -> bool {
    instruction.forms.iter().any(|form| matches!(form.drawing, Drawing::Box { .. }))
}

/// Checks the rows under a title: how many operands agree, or what does not.
fn check_rows(form: &Form, rows: &[&str], edge: usize) -> Result<usize, String> {
    let mut row = 0;
    for operand in form.operands {
        let Some(line) = rows.get(row) else { return Err("the report ends".to_owned()) };
        let (_, text) = at_edge(line, edge).ok_or_else(|| format!("no name where `{}` is expected", operand.name))?;
        let named = text == operand.name || text.strip_prefix(operand.name).is_some_and(|rest| rest.starts_with(' '));
        if !named {
            return Err(format!("`{text}` where `{}` is expected", operand.name));
        }
        row += 1;
        if operand.stored == Stored::SourceAndValue {
            // The value stands at the right, alone in this box; a binary one can begin near the edge.
            let value = rows.get(row).ok_or_else(|| format!("no value under `{}`", operand.name))?;
            if at_edge(value, edge).is_some_and(|(_, text)| !text.ends_with('<')) {
                return Err(format!("`{}` has no value line", operand.name));
            }
            row += 1;
        }
    }
    // Below the last operand the box ends: nothing more stands at its edge.
    match rows.get(row).and_then(|line| at_edge(line, edge)) {
        Some((_, text)) => Err(format!("one more row: `{text}`")),
        None => Ok(form.operands.len()),
    }
}

/// Checks that the status flags stand right of the box, from top to bottom.
fn check_flags(form: &Form, rows: &[&str], edge: usize) -> Result<usize, String> {
    let Drawing::Box { flags } = form.drawing else { return Ok(0) };
    let right: Vec<String> = rows
        .iter()
        .take(form.operands.len() + 1)
        .flat_map(|row| segments(row).into_iter().filter(|(column, _)| *column > edge).map(|(_, text)| text))
        .collect();
    let mut at = 0;
    for flag in flags {
        at += right[at..].iter().position(|text| text == flag).ok_or_else(|| format!("no flag `{flag}`"))? + 1;
    }
    Ok(flags.len())
}

fn check_report(name: &str, text: &str, tally: &mut Tally) {
    let lines: Vec<&str> = text.lines().collect();
    for (number, line) in lines.iter().enumerate() {
        for (column, word) in segments(line) {
            let Some(instruction) = by_mnemonic(&word).filter(|i| is_box(i)) else { continue };
            let Some(next) = lines.get(number + 1) else { continue };
            let middle = column + word.len() / 2;
            let Some((edge, title)) = segments(next)
                .into_iter()
                .filter(|(start, text)| *start <= column && middle <= start + text.chars().count().max(24))
                .max_by_key(|(start, _)| *start)
            else {
                continue;
            };
            // A mnemonic can also be a word of a comment or a symbol; a box needs one of its titles.
            let is_title = all().iter().any(|other| other.title == title);
            if !is_title {
                continue;
            }
            let place = format!("{name}:{}: {word}", number + 1);
            if title != instruction.title {
                tally.wrong.push(format!("{place}: title `{title}`, table has `{}`", instruction.title));
                continue;
            }
            *tally.boxes.entry(instruction.mnemonic).or_default() += 1;
            let rows = lines.get(number + 2..).unwrap_or_default();
            let shown = lines.get(number + 1..).unwrap_or_default();
            // The forms of one mnemonic that are boxes on these controllers differ in code only, so the
            // first that agrees settles it.
            let mut reason = None;
            for form in instruction.forms.iter().filter(|form| matches!(form.drawing, Drawing::Box { .. })) {
                match check_rows(form, rows, edge).and_then(|n| Ok((n, check_flags(form, shown, edge)?))) {
                    Ok((rows, flags)) => {
                        tally.rows += rows;
                        tally.flags += flags;
                        reason = None;
                        break;
                    }
                    Err(why) => reason = reason.or(Some(why)),
                }
            }
            if let Some(reason) = reason {
                tally.wrong.push(format!("{place}: {reason}"));
            }
        }
    }
}

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

#[test]
fn boxes_on_paper_have_our_titles_and_names() {
    let Some(folder) = corpus::root() else { return };
    let paths = corpus::files(&folder, ".pdf.txt").expect("the corpus can be listed");
    let mut tally = Tally::default();
    for path in &paths {
        let text = String::from_utf8_lossy(&fs::read(path).expect("a listed report is readable")).into_owned();
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        check_report(&name, &text, &mut tally);
    }
    let boxes: usize = tally.boxes.values().sum();
    println!("{} reports, {boxes} boxes, {} operand rows, {} flags", paths.len(), tally.rows, tally.flags);
    println!("{:?}", tally.boxes);
    assert!(tally.wrong.is_empty(), "{} differ:\n{}", tally.wrong.len(), tally.wrong.join("\n"));
    for instruction in all() {
        let seen = tally.boxes.contains_key(instruction.mnemonic);
        assert_eq!(instruction.names == Names::Printout, seen, "{}: names read on paper?", instruction.mnemonic);
    }
}
