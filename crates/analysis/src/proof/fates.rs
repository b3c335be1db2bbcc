//! What a converted program says about the rungs it was made from.

use std::collections::{BTreeMap, BTreeSet};

use domore::instruction::Effect;
use ladder::{Image, Instruction, Rung};

use super::RungFate;

/// Reads the comments a migration leaves above each rung (`SLC 2:14  XIC ...`, `condition: ...`,
/// `person: ...`; what stands below one of the last two belongs to it, up to the next of these lines). `None`: no rung says where it comes from.
pub fn fates(project: &domore::Project) -> Option<Vec<RungFate>> {
    let rungs = project.code_blocks().flat_map(|block| &block.rungs);
    let fates: Vec<RungFate> = rungs.filter_map(fate).collect();
    (!fates.is_empty()).then_some(fates)
}

/// A rung of a converted program and the one of the original it was made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Code block, by its place in the text, from 0.
    pub block: usize,
    /// Rung in it, from 0.
    pub rung: usize,
    /// Program file of the original.
    pub file: u16,
    /// Rung of the original, from 0.
    pub from: u32,
}

/// Which rung was made from which, in the order of the converted program, by the marks above its rungs. Rungs without
/// one are the conversion's own.
pub fn origins(project: &domore::Project) -> Vec<Origin> {
    let mut all = Vec::new();
    for (block, code) in project.code_blocks().enumerate() {
        for (number, rung) in code.rungs.iter().enumerate() {
            let lines = rung.comment.iter().flat_map(|comment| &comment.lines);
            let found = lines.filter_map(|line| origin(line)).next_back();
            all.extend(found.map(|(file, from)| Origin { block, rung: number, file, from }));
        }
    }
    all
}

/// What the lines of a comment speak of.
enum Open {
    Nothing,
    Person,
    Condition,
}

/// How a line begins that says where the rungs of a subroutine stand.
const FOLLOWS: &str = "the rungs of file ";

fn fate(rung: &domore::Rung) -> Option<RungFate> {
    let lines = rung.comment.iter().flat_map(|comment| &comment.lines);
    let (mut place, mut person, mut conditions) = (None, None, Vec::<String>::new());
    // What a line that is no mark goes on with: long reasons take several lines.
    let mut open = Open::Nothing;
    for line in lines {
        if let Some(reason) = line.strip_prefix("person: ") {
            person = Some(reason.to_owned());
            open = Open::Person;
        } else if let Some(condition) = line.strip_prefix("condition: ") {
            conditions.push(condition.to_owned());
            open = Open::Condition;
        } else if let Some(found) = origin(line) {
            // The mark is the last line of a comment: what a person wrote above it does not count.
            place = Some(found);
            open = Open::Nothing;
        } else if line.starts_with(FOLLOWS) {
            open = Open::Nothing;
        } else {
            let text = match open {
                Open::Nothing => None,
                Open::Person => person.as_mut(),
                Open::Condition => conditions.last_mut(),
            };
            if let Some(text) = text {
                text.push(' ');
                text.push_str(line);
            }
        }
    }
    place.map(|(file, rung)| RungFate { file, rung, person, conditions })
}

/// Rungs of the original that have an output and whose mark stands above rungs without any: program file
/// and rung. Those left to a person, of `persons` or by their comment, are said to be empty already.
pub(crate) fn emptied(image: &Image, project: &domore::Project, persons: &BTreeSet<(u16, u32)>) -> Vec<(u16, u32)> {
    let mut acts: BTreeMap<(u16, u32), bool> = BTreeMap::new();
    for rung in project.code_blocks().flat_map(|block| &block.rungs) {
        if let Some(found) = fate(rung).filter(|found| found.person.is_none()) {
            *acts.entry((found.file, found.rung)).or_default() |= rung.instructions.iter().any(acting);
        }
    }
    let empty = |place: &(u16, u32)| acts.get(place) == Some(&false) && !persons.contains(place);
    let mut output: BTreeSet<(u16, u32)> = BTreeSet::new();
    let mut other: BTreeSet<(u16, u32)> = BTreeSet::new();
    for (location, it) in crate::instructions(image) {
        let (name, place) = (it.mnemonic.name().unwrap_or_default(), (location.file, location.rung));
        let known = instr::by_mnemonic(name);
        if known.is_some_and(|known| known.forms.iter().any(|form| form.position == instr::Position::Output)) {
            output.insert(place);
        }
        if !PLACED.contains(&name) {
            other.insert(place);
        }
    }
    output.intersection(&other).copied().filter(empty).filter(|place| !leads_nowhere(image, *place)).collect()
}

/// The only outputs of a rung leave or call, and there is nothing they could keep from running or let run: a
/// return at the end of its file, a jump to the next rung, a call of a file without rungs.
fn leads_nowhere(image: &Image, (number, rung): (u16, u32)) -> bool {
    let rungs = |number: u16| image.program_file(number).map(|file| file.rungs.as_slice());
    let own = rungs(number).unwrap_or_default();
    let bare = |rungs: &[Rung]| rungs.iter().all(|rung| rung.is_end() || rung.series.is_empty());
    let behind = own.get(rung as usize + 1..).unwrap_or_default();
    let lands = |label: u16| {
        let is = |it: &Instruction| it.mnemonic == "LBL" && super::taint::label(it) == Some(label);
        behind.first().is_some_and(|next| next.instructions().any(is))
    };
    let nothing = |it: &Instruction| match it.mnemonic.name() {
        Some("RET" | "TND") => bare(behind),
        Some("JMP") => super::taint::label(it).is_some_and(lands),
        Some("JSR") => super::taint::called(it).and_then(rungs).is_some_and(bare),
        name => {
            let known = name.and_then(instr::by_mnemonic);
            known.is_some_and(|known| known.forms.iter().all(|form| form.position == instr::Position::Input))
        }
    };
    own.get(rung as usize).is_some_and(|rung| rung.instructions().all(nothing))
}

/// Flow that a conversion expresses by where the rungs stand. A rung of nothing else, without a condition,
/// becomes one that does nothing.
const PLACED: [&str; 5] = ["JSR", "RET", "MCR", "SBR", "LBL"];

/// Everything but contacts, what only moves the power flow, and `NOP`. What is not known may act.
fn acting(instruction: &domore::Instruction) -> bool {
    let entry = domore::instruction::by_mnemonic(&instruction.mnemonic);
    entry.is_none_or(|entry| entry.mnemonic != "NOP" && (entry.is_output() || entry.effect == Effect::Alone))
}

/// `SLC 2:14  ...`.
fn origin(line: &str) -> Option<(u16, u32)> {
    let mark = line.strip_prefix("SLC ")?.split(' ').next()?;
    let (file, rung) = mark.split_once(':')?;
    Some((file.parse().ok()?, rung.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_read_and_other_comments_are_not() {
        let text = "$PRGRM $Main\n\n#BEGIN COMMENT\n\"Pump\"\n\"condition: X: y\"\n\"and z\"\n\"the rungs of file 3 follow here\"\n\"SLC 2:3  XIC B3:0/0\"\n#END\nSTR C0\nOUT C1\n\n\
                    #BEGIN COMMENT\n\"person: MSG: no\"\n\"SLC 2:4  MSG\"\n#END\nNOP\n\n#BEGIN COMMENT\n\"own\"\n#END\nNOP\n\n\
                    $PGMEND $Main\n";
        let project = domore::text::read(text).expect("reads").project;
        let found = fates(&project).expect("marks");
        let place = |fate: &RungFate| (fate.file, fate.rung, fate.person.is_some(), fate.conditions.len());
        assert_eq!(found.iter().map(place).collect::<Vec<_>>(), [(2, 3, false, 1), (2, 4, true, 0)]);
        assert_eq!(found[0].conditions, ["X: y and z"]);
        let plain = domore::text::read("$PRGRM $Main\n\nSTR C0\nOUT C1\n\n$PGMEND $Main\n").expect("reads").project;
        assert_eq!(fates(&plain), None);
    }
}
