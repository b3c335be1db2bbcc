//! Reads an `.SLC` file section by section.

use ladder::Force;

use super::lines::{Lines, push_line, shortened};
use super::{Data, Forces, Ladder, Names, RungLines, Section, SlcFile, Slot, Start, comment, data};

/// Reads a text in time proportional to its length. Never fails: what fits nothing is kept with its
/// section and reported.
pub fn read(text: &str) -> SlcFile {
    let mut lines = Lines::new(text);
    let mut sections = Vec::new();
    while let Some(line) = lines.peek() {
        if line.trim().is_empty() {
            lines.next();
            continue;
        }
        let section = match begins(line) {
            Some(Begin::Start) => start(&mut lines),
            Some(Begin::Rack) => {
                rack(&mut lines, &mut sections);
                continue;
            }
            Some(Begin::Project) => project(&mut lines),
            Some(Begin::Ladder(number)) => ladder(&mut lines, number),
            Some(Begin::Data(header)) => {
                lines.next();
                let mut section = *header;
                data::read(&mut section, &mut lines, is_section);
                Section::Data(section)
            }
            Some(Begin::Force(header)) => forces(&mut lines, header),
            None => other(&mut lines),
        };
        sections.push(section);
    }
    if !sections.iter().any(|section| matches!(section, Section::Start(_))) {
        lines.warn(1, "expected a START line that names the processor, found none");
    }
    SlcFile { sections, diagnostics: lines.into_diagnostics() }
}

/// What a line that begins a section begins.
enum Begin {
    Start,
    Rack,
    Project,
    Ladder(u16),
    Data(Box<Data>),
    Force(Forces),
}

const RACK_HEADINGS: [&str; 2] = ["% PROCESSOR RACK CONFIGURATION INFORMATION %", "% SLOT CONFIGURATION INFORMATION %"];

fn begins(line: &str) -> Option<Begin> {
    let line = line.trim_end();
    if RACK_HEADINGS.contains(&line) {
        return Some(Begin::Rack);
    }
    let (keyword, rest) = line.split_once(' ')?;
    let rest = rest.trim();
    match keyword {
        "START" => Some(Begin::Start),
        "SLOT" => rest.split(' ').next()?.parse::<u16>().ok().map(|_| Begin::Rack),
        "PROJECT" => rest.starts_with('"').then_some(Begin::Project),
        "LADDER" => rest.parse().ok().map(Begin::Ladder),
        "DATA" => data::header(rest).map(|data| Begin::Data(Box::new(data))),
        "FORCE" => {
            let (letter, slot) = rest.split_once(':')?;
            let outputs = match letter {
                "O" => true,
                "I" => false,
                _ => return None,
            };
            Some(Begin::Force(Forces { outputs, slot: slot.parse().ok()?, ..Forces::default() }))
        }
        _ => None,
    }
}

pub(super) fn is_section(line: &str) -> bool {
    begins(line).is_some()
}

fn start(lines: &mut Lines<'_>) -> Section {
    let number = lines.number();
    let text = lines.next().and_then(|line| line.strip_prefix("START ")).unwrap_or("");
    let (catalog, rest) = text.split_once('%').unwrap_or((text, ""));
    let description = rest.trim_end().strip_suffix('%').unwrap_or_else(|| {
        lines.warn(number, "expected `START catalogue % description %`");
        rest
    });
    Section::Start(Start { catalog: catalog.trim().to_owned(), description: description.trim().to_owned() })
}

fn slot_number(rest: &str) -> Option<(u16, &str)> {
    let (number, rest) = rest.split_once(' ')?;
    Some((number.parse().ok()?, rest))
}

fn rack(lines: &mut Lines<'_>, sections: &mut Vec<Section>) {
    let mut slots = Vec::new();
    let mut kept = false;
    while let Some(line) = lines.peek() {
        let text = line.trim_end();
        if RACK_HEADINGS.contains(&text) {
            lines.next();
            continue;
        }
        if !text.starts_with("SLOT ") {
            break;
        }
        let number = lines.number();
        let mut whole = text.to_owned();
        lines.next();
        // Configuration words stand in lines of their own, indented.
        while let Some(more) = lines.peek().filter(|more| more.starts_with(' ') && !more.trim().is_empty()) {
            push_line(&mut whole, more.trim_end());
            lines.next();
        }
        match whole.strip_prefix("SLOT ").and_then(slot) {
            Some(slot) => slots.push(slot),
            None => {
                let expected = "expected `SLOT n catalogue % text % SCAN_IN n SCAN_OUT n ..`";
                let message = format!("{expected}, found `{}`; the project does not hold this slot", shortened(text));
                lines.lost(number, message);
                if !slots.is_empty() {
                    sections.push(Section::Rack(std::mem::take(&mut slots)));
                }
                sections.push(Section::Other(whole));
                kept = true;
            }
        }
    }
    if !slots.is_empty() || !kept {
        sections.push(Section::Rack(slots));
    }
}

fn slot(text: &str) -> Option<Slot> {
    let (number, rest) = slot_number(text)?;
    let (described_part, tail) = rest.rsplit_once('%')?;
    let (catalog, description) = described_part.split_once('%')?;
    let mut slot = Slot {
        number,
        catalog: catalog.trim().to_owned(),
        description: description.trim().to_owned(),
        ..Slot::default()
    };
    let mut words = tail.split_whitespace().peekable();
    while let Some(word) = words.next() {
        let mut number = || words.next()?.parse::<u16>().ok();
        match word {
            "SCAN_IN" => slot.scan_in = number()?,
            "SCAN_OUT" => slot.scan_out = number()?,
            "G_FILE" => {
                let count = usize::from(number()?);
                let values: Vec<u16> = words.by_ref().take(count).map_while(data::word).collect();
                if values.len() != count {
                    return None;
                }
                slot.configuration = Some(values);
            }
            "IOCARD" => {
                let numbers = words.by_ref().map(|word| word.parse::<i32>().ok());
                slot.io_card = Some(numbers.collect::<Option<_>>()?);
            }
            _ => return None,
        }
    }
    Some(slot)
}

fn project(lines: &mut Lines<'_>) -> Section {
    let between_quotes = |text: &str| Some(text.trim().strip_prefix('"')?.strip_suffix('"')?.to_owned());
    let mut names = Names::default();
    let number = lines.number();
    let line = lines.next().unwrap_or("");
    match line.strip_prefix("PROJECT ").and_then(between_quotes) {
        Some(name) => names.project = name,
        None => {
            lines.warn(number, "expected `PROJECT \"name\"`");
            names.project = line.strip_prefix("PROJECT ").unwrap_or("").trim().trim_matches('"').to_owned();
        }
    }
    while let Some(line) = lines.peek() {
        let name = line.trim().split_once(char::is_whitespace);
        match name.and_then(|(file, name)| Some((file.parse().ok()?, between_quotes(name)?))) {
            Some(name) => names.program_files.push(name),
            None => break,
        }
        lines.next();
    }
    Section::Project(names)
}

fn ladder(lines: &mut Lines<'_>, number: u16) -> Section {
    lines.next();
    let mut ladder = Ladder { number, ..Ladder::default() };
    while let Some(line) = lines.peek() {
        let text = line.trim();
        if text.is_empty() {
            lines.next();
        } else if is_section(line) {
            break;
        } else if let Some(stated) = comment::rung_number(line) {
            if stated.parse() != Ok(ladder.rungs.len()) {
                let message = format!("expected rung {}, found a rung numbered {stated}", ladder.rungs.len());
                lines.warn(lines.number(), message);
            }
            lines.next();
        } else if text == "SOR" || text.starts_with("SOR ") {
            ladder.rungs.push(rung(lines));
        } else if comment::begins(line) && ladder.rungs.last().is_some_and(|rung| rung.title.is_none()) {
            let title = comment::read(lines);
            if let Some(rung) = ladder.rungs.last_mut() {
                rung.title = Some(title);
            }
        } else {
            let extra = ladder.rungs.last_mut().map_or(&mut ladder.extra, |rung| &mut rung.extra);
            lines.keep(extra, "expected a rung, its number or its comment");
        }
    }
    Section::Ladder(ladder)
}

/// A rung from `SOR` to `EOR`; long ones may be wrapped.
fn rung(lines: &mut Lines<'_>) -> RungLines {
    let mut rung = RungLines { line: lines.number(), ..RungLines::default() };
    while let Some(line) = lines.peek() {
        let text = line.trim_end();
        let first = rung.text.is_empty();
        if !first && (text.is_empty() || text.starts_with('%') || text.starts_with("SOR ") || is_section(line)) {
            break;
        }
        push_line(&mut rung.text, text);
        lines.next();
        if text.rsplit(char::is_whitespace).next() == Some("EOR") {
            break;
        }
    }
    rung
}

fn forces(lines: &mut Lines<'_>, header: Forces) -> Section {
    lines.next();
    let mut section = header;
    while let Some(line) = lines.peek() {
        let text = line.trim();
        if text.is_empty() {
            lines.next();
            continue;
        }
        if is_section(line) {
            break;
        }
        let values = text.split('%').next().unwrap_or("");
        let masks: Option<Vec<u16>> = values.split_whitespace().map(data::word).collect();
        match masks.as_deref() {
            Some(&[on, off]) => {
                section.words.push(Force { on, off });
                lines.next();
            }
            Some([]) if text.contains("ON") && text.contains("OFF") => {
                lines.next();
            }
            _ => lines.keep(&mut section.extra, "expected two force masks"),
        }
    }
    Section::Force(section)
}

fn other(lines: &mut Lines<'_>) -> Section {
    let first = lines.number();
    let mut kept = String::new();
    let mut example = "";
    while let Some(line) = lines.peek().filter(|line| !is_section(line)) {
        if example.is_empty() {
            example = line;
        }
        push_line(&mut kept, line.trim_end());
        lines.next();
    }
    let kept = kept.trim_end().to_owned();
    let last = first.saturating_add(u32::try_from(kept.lines().count()).unwrap_or(u32::MAX)).saturating_sub(1);
    let found = shortened(example);
    lines.lost(first, format!("expected a section, found `{found}`; the project holds nothing up to line {last}"));
    Section::Other(kept)
}
