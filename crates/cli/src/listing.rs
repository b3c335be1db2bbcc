//! A project as text for comparing line by line: each section in files of its own, nothing numbered that
//! an insertion would renumber.

use std::fmt::Write;

use analysis::diff::{Side, compare};
use convert::slc::rung::instruction_text;
use instr::Stored;
use ladder::{
    AddressEntry, DataFile, Documentation, Element, FileType, Image, Instruction, Operand, Project, Radix, Rung,
};

/// Counted up with every change of this text: git caches it under the command that made it.
pub const FORM: u32 = 1;

/// Columns up to which a rung stays on one line.
const ONE_LINE: usize = 100;

/// Branches inside each other that are set in further; deeper ones stay at that column.
const DEEPEST: usize = 24;

/// A text of a project.
pub struct Text {
    /// `program/002 MAIN.slc`; names in it come from the project and can hold anything.
    pub path: Vec<String>,
    pub text: String,
}

/// The sections of a project: program, documentation, values, configuration.
pub fn texts(project: &Project) -> Vec<Text> {
    let image = &project.main;
    let mut all = Vec::new();
    for file in image.ladder_files() {
        let name = [format!("{:03}", file.number), file.name.clone()].join(" ");
        let mut text = format!("% Program file {} {} %\n", file.number, one_line(&file.name));
        for rung in file.rungs.iter().filter(|rung| !rung.is_end() || rung.comment.is_some()) {
            text.push('\n');
            write_rung(image, rung, &mut text);
        }
        all.push(Text { path: vec!["program".to_owned(), format!("{}.slc", name.trim_end())], text });
    }
    all.push(Text { path: path("documentation/symbols.csv"), text: symbols(&image.documentation) });
    all.push(Text { path: path("documentation/other.txt"), text: other_documentation(project) });
    for file in image.data_files.iter().chain(&image.function_files) {
        let text = values(image, file);
        if !text.is_empty() {
            all.push(Text { path: vec!["values".to_owned(), format!("{}.txt", file.label())], text });
        }
    }
    all.push(Text { path: path("configuration.txt"), text: configuration(project) });
    all
}

/// The same as one text with headings: what `git diff` shows of a project.
pub fn whole(project: &Project) -> String {
    let mut out = String::new();
    for text in texts(project) {
        let _ = writeln!(out, "==== {} ====\n{}", clean(&text.path.join("/")), text.text);
    }
    for found in project.diagnostics.iter().filter(|found| found.severity == ladder::Severity::Error) {
        let _ = writeln!(out, "NOT READ: {}", clean(&format!("{}: {}", found.place, found.message)));
    }
    out
}

fn path(text: &str) -> Vec<String> {
    text.split('/').map(str::to_owned).collect()
}

/// A line as a terminal may get it: `git log` hands it on.
fn clean(line: &str) -> String {
    render::clean(line).into_owned()
}

/// On one line, without what would end a comment of the notation.
pub fn one_line(text: &str) -> String {
    clean(&text.replace(['\r', '\n', '%'], " "))
}

/// The comment above, then the rung: on one line, or with a line for each leg.
pub fn write_rung(image: &Image, rung: &Rung, out: &mut String) {
    if let Some(comment) = &rung.comment {
        let title = Some(comment.title.as_str()).filter(|title| !title.trim().is_empty());
        let title = title.map(|title| format!("TITLE: {}", one_line(title)));
        // `%` would end the comment: the wide form of it stands in its place.
        let lines: Vec<String> = comment.lines().map(|line| clean(&line.replace('%', "\u{FF05}"))).collect();
        let all: Vec<&str> = title.iter().chain(&lines).map(String::as_str).collect();
        if !all.is_empty() {
            let _ = writeln!(out, "% {} %", all.join("\n  "));
        }
    }
    let mut words = Vec::new();
    series(image, &rung.series, 0, &mut words);
    let single = words.iter().map(|(_, word)| word.as_str()).collect::<Vec<_>>().join(" ");
    if single.chars().count() <= ONE_LINE {
        let _ = writeln!(out, "{}", clean(format!("SOR {single}").trim_end()).trim_end().to_owned() + " EOR");
    } else {
        out.push_str("SOR");
        let mut at = None;
        for (depth, word) in &words {
            let mark = matches!(word.as_str(), "BST" | "NXB" | "BND");
            if mark || at != Some(*depth) || word.len() > ONE_LINE {
                let _ = write!(out, "\n{}", "  ".repeat(1 + (*depth).min(DEEPEST)));
            } else {
                out.push(' ');
            }
            out.push_str(&clean(word));
            at = Some(*depth);
        }
        out.push_str("\nEOR\n");
    }
    for instruction in rung.instructions() {
        for (name, value) in instruction.message.iter().flat_map(|setup| &setup.settings) {
            // The flags of the last message are no setting.
            if name != "Status" {
                let _ = writeln!(out, "% {} {}: {} %", instruction.mnemonic, one_line(name), one_line(value));
            }
        }
    }
}

/// Instructions and branch marks with their depth. Damaged projects nest deep: no recursion.
fn series(image: &Image, elements: &[Element], depth: usize, out: &mut Vec<(usize, String)>) {
    enum Step<'a> {
        Elements(&'a [Element], usize),
        Legs(&'a [ladder::Series], usize),
        Mark(&'static str, usize),
    }
    let mut steps = vec![Step::Elements(elements, depth)];
    while let Some(step) = steps.pop() {
        match step {
            Step::Mark(mark, depth) => out.push((depth, mark.to_owned())),
            Step::Elements(elements, depth) => {
                let Some((first, rest)) = elements.split_first() else { continue };
                steps.push(Step::Elements(rest, depth));
                match first {
                    Element::Instruction(instruction) => out.push((depth, logic_text(image, instruction))),
                    Element::Branch(branch) => {
                        out.push((depth + 1, "BST".to_owned()));
                        steps.push(Step::Mark("BND", depth + 1));
                        if let Some((first, rest)) = branch.legs.split_first() {
                            steps.push(Step::Legs(rest, depth + 1));
                            steps.push(Step::Elements(first, depth + 1));
                        }
                    }
                }
            }
            Step::Legs(legs, depth) => {
                let Some((first, rest)) = legs.split_first() else { continue };
                out.push((depth, "NXB".to_owned()));
                steps.push(Step::Legs(rest, depth));
                steps.push(Step::Elements(first, depth));
            }
        }
    }
}

/// The instruction without the presets and accumulators that the data table holds: `values/` has them.
fn logic_text(image: &Image, instruction: &Instruction) -> String {
    let form = instruction
        .mnemonic
        .name()
        .and_then(instr::by_mnemonic)
        .and_then(|entry| entry.forms.iter().find(|form| form.operands.len() == instruction.operands.len()));
    let stored = |index: usize| form.and_then(|form| form.operands.get(index)).map(|operand| operand.stored);
    let value = |index: usize| stored(index) == Some(Stored::Value);
    let values = (0..instruction.operands.len()).filter(|index| value(*index)).count();
    if values == 0 || !(instruction.compiled || in_table(image, instruction, values)) {
        return instruction_text(instruction, None);
    }
    let mut text = instruction.mnemonic.to_string();
    for (index, operand) in instruction.operands.iter().enumerate() {
        if !value(index) && stored(index) != Some(Stored::Blank) && *operand != Operand::Empty {
            let _ = write!(text, " {operand}");
        }
    }
    text
}

/// The last operands of an instruction that was not verified say what the data table says.
fn in_table(image: &Image, instruction: &Instruction, values: usize) -> bool {
    let element = instruction.operands.iter().find_map(|operand| match operand {
        Operand::Address(address) if matches!(address.file_type, FileType::T | FileType::C | FileType::R) => {
            Some(address)
        }
        _ => None,
    });
    let words = element.and_then(|address| {
        image.data_file(address.file_type, address.file.number()?)?.element_words(address.element.number()?)
    });
    let shown = instruction.operands.iter().skip(instruction.operands.len().saturating_sub(values));
    let table = words.unwrap_or_default().iter().skip(1).take(values).map(|word| word.cast_signed().to_string());
    table.eq(shown.map(ToString::to_string))
}

/// Symbols and descriptions by address. Stored order changes from save to save.
fn symbols(documentation: &Documentation) -> String {
    let mut sorted = Documentation::default();
    let mut entries: Vec<&AddressEntry> = documentation.entries().iter().filter(|entry| !is_blank(entry)).collect();
    let numbers = |text: &str| -> Vec<u32> {
        text.split(|c: char| !c.is_ascii_digit()).filter_map(|digits| digits.parse().ok()).collect()
    };
    let key = |target: &str| {
        let letters: String = target.chars().take_while(|c| !c.is_ascii_digit()).collect();
        (letters, numbers(target), target.to_owned())
    };
    entries.sort_by_cached_key(|entry| (key(&entry.target.to_string()), entry.symbol.clone()));
    let cleaned = |lines: &[String]| lines.iter().map(|line| clean(line)).collect::<Vec<_>>();
    for entry in entries {
        sorted.add(AddressEntry {
            target: entry.target.clone(),
            symbol: clean(&entry.symbol),
            description: cleaned(&entry.description),
        });
    }
    let mut comments: Vec<&ladder::InstructionComment> = documentation.instruction_comments().iter().collect();
    let target = |comment: &ladder::InstructionComment| comment.target.as_ref().map(ToString::to_string);
    comments.sort_by_cached_key(|comment| (key(&target(comment).unwrap_or_default()), comment.mnemonic.clone()));
    for comment in comments {
        sorted.add_instruction_comment(ladder::InstructionComment {
            mnemonic: clean(&comment.mnemonic),
            target: comment.target.clone(),
            lines: cleaned(&comment.lines),
        });
    }
    let mut bytes = Vec::new();
    // Writing to memory cannot fail.
    let _ = convert::csv::write_symbols(&sorted, &mut bytes);
    String::from_utf8_lossy(&bytes).replace("\r\n", "\n")
}

/// RSLogix keeps entries of addresses that were only looked at.
fn is_blank(entry: &AddressEntry) -> bool {
    entry.symbol.is_empty() && entry.description.iter().all(|line| line.trim().is_empty())
}

/// What documentation hangs on no address: descriptions of files, comments whose rung is gone, notes.
fn other_documentation(project: &Project) -> String {
    let (image, mut out) = (&project.main, String::new());
    for file in image.program_files.iter().filter(|file| !file.description.is_empty()) {
        let _ = writeln!(out, "program file {}: {}", file.number, one_line(&file.description));
    }
    for file in image.data_files.iter().chain(&image.function_files).filter(|file| !file.description.is_empty()) {
        let _ = writeln!(out, "data file {}: {}", file.label(), one_line(&file.description));
    }
    let mut detached: Vec<String> = Vec::new();
    for comment in &image.documentation.detached_comments {
        let mut text = "comment without a rung:\n".to_owned();
        if !comment.title.is_empty() {
            let _ = writeln!(text, "  TITLE: {}", one_line(&comment.title));
        }
        for line in comment.lines() {
            let _ = writeln!(text, "  {}", clean(line));
        }
        detached.push(text);
    }
    detached.sort();
    out.extend(detached);
    let mut notes: Vec<&ladder::RevisionNote> = project.revision_notes.iter().collect();
    notes.sort_by_key(|note| note.revision);
    for note in notes.into_iter().filter(|note| !note.note.trim().is_empty()) {
        let _ = writeln!(out, "revision {}: {}", note.revision, one_line(&note.note));
    }
    out
}

/// Elements that are not 0, and forces.
fn values(image: &Image, file: &DataFile) -> String {
    if matches!(file.file_type, FileType::Unused | FileType::Reserved) {
        return String::new();
    }
    let mut out = String::new();
    let radix = Radix::printed(file.file_type);
    for element in 0..file.elements {
        let zero = file.element_words(element).is_none_or(|words| words.iter().all(|word| *word == 0));
        let force = file.forces.get(usize::from(element)).filter(|force| **force != ladder::Force::NONE);
        let address = || file.element_address(element, &image.io);
        if let Some(value) = file.value(element).filter(|_| !zero) {
            let _ = writeln!(out, "{}  {}", address(), clean(&value.text(radix)));
        }
        if let Some(force) = force {
            let _ = writeln!(out, "{}  forced on {:016b}  forced off {:016b}", address(), force.on, !force.off);
        }
    }
    if !out.is_empty() {
        out.insert_str(0, "% elements that are not listed are 0 %\n");
    }
    out
}

/// Everything that a comparison calls configuration: what an empty project lacks.
fn configuration(project: &Project) -> String {
    let (empty, mut out) = (Image::default(), String::new());
    let side = |image| Side { image, documentation: None };
    for change in compare(side(&empty), side(&project.main)).configuration {
        if let Some(value) = change.new.filter(|value| !value.is_empty()) {
            let _ = writeln!(out, "{} {}: {}", change.what, one_line(&change.name), one_line(&value));
        }
    }
    for file in project.main.program_files.iter().filter(|file| !file.name.is_empty()) {
        let _ = writeln!(out, "program file {} ({}): {}", file.number, file.kind.as_str(), one_line(&file.name));
    }
    out
}
