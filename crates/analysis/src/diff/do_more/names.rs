//! What the operands of a Do-more program stand for, and addresses that another one replaced throughout.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use domore::address::{Address, Constant, Element};
use domore::instruction::{self, Kind};
use domore::memory::{ElementType, Map, SYSTEM_NICKNAMES};
use domore::{Instruction, Project};

use crate::diff::Rename;
use crate::diff::renames::consistent;

/// Nicknames that stand for nicknames are followed so far.
const MOST_STEPS: usize = 4;

/// Elements, nicknames and named constants of a project.
pub(super) struct Names {
    /// `None` where the memory is larger than any controller's: then blocks are not known.
    map: Option<Map>,
    /// By nickname in upper case: the element.
    nicknames: HashMap<String, String>,
    /// By element in upper case (`SK3`): the value.
    constants: HashMap<String, String>,
}

/// From the old program to the new: names in upper case.
#[derive(Clone, Debug, Default)]
pub(super) struct Mapping {
    names: BTreeMap<String, String>,
}

impl Mapping {
    /// Code blocks with another name.
    pub(super) fn of_blocks<'a>(pairs: impl IntoIterator<Item = (&'a str, &'a str)>) -> Mapping {
        let upper = |(a, b): (&str, &str)| (a.to_ascii_uppercase(), b.to_ascii_uppercase());
        Mapping { names: pairs.into_iter().map(upper).collect() }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.names.is_empty()
    }
}

impl Names {
    pub(super) fn new(project: &Project) -> Names {
        let mut names = Names { map: Map::new(project).ok(), nicknames: HashMap::new(), constants: HashMap::new() };
        for (nickname, element) in SYSTEM_NICKNAMES {
            names.nicknames.insert(nickname.to_ascii_uppercase(), (*element).to_owned());
        }
        for entry in project.documentation() {
            let element = entry.element.to_ascii_uppercase();
            if element.strip_prefix("SK").is_some_and(|rest| rest.parse::<u32>().is_ok()) {
                names.constants.insert(element.clone(), entry.extra.trim().to_owned());
            }
            if !entry.nickname.is_empty() {
                names.nicknames.insert(entry.nickname.to_ascii_uppercase(), entry.element.clone());
            }
        }
        names
    }

    /// An operand by what it means: nicknames as their elements, names in upper case, numbers by their value.
    /// Nothing for an operand that is not there.
    pub(super) fn spell(&self, instruction: &Instruction, index: usize, mapping: &Mapping, text: &mut String) {
        let Some(operand) = instruction.operands.get(index) else { return };
        let known = instruction::by_mnemonic(&instruction.mnemonic).and_then(|entry| entry.operand(index));
        let is_text = operand.starts_with('"');
        match known.map(|known| known.kind) {
            Some(Kind::Expression | Kind::Table(_)) => self.spell_text(operand, mapping, text),
            // Texts are what they are, and of others in quotes nothing is known.
            _ if is_text => text.push_str(operand),
            _ => match Constant::parse(operand) {
                Some(constant) => text.push_str(&format!("{:?}", constant.value)),
                None => self.spell_text(operand, mapping, text),
            },
        }
    }

    /// Names, numbers and signs one after the other.
    fn spell_text(&self, written: &str, mapping: &Mapping, text: &mut String) {
        each_part(written, |part| match part {
            Part::Name(name) => text.push_str(&self.name(name, mapping, 0)),
            Part::Member(rest) => text.push_str(&rest.to_ascii_uppercase()),
            Part::Other(other) => text.push_str(other),
        });
    }

    /// A name by what it stands for.
    fn name(&self, name: &str, mapping: &Mapping, steps: usize) -> String {
        let upper = name.to_ascii_uppercase();
        let element = self.element(name);
        if element.is_none()
            && steps < MOST_STEPS
            && let Some(target) = self.nicknames.get(&upper)
        {
            let mut text = String::new();
            each_part(target, |part| match part {
                Part::Name(name) => text.push_str(&self.name(name, mapping, steps + 1)),
                Part::Member(rest) => text.push_str(&rest.to_ascii_uppercase()),
                Part::Other(other) => text.push_str(other),
            });
            return text;
        }
        if let Some(value) = self.constants.get(&upper) {
            return format!("{upper}={value}");
        }
        let upper = element.map_or(upper, |(element, _)| element);
        mapping.names.get(&upper).cloned().unwrap_or(upper)
    }

    /// The element of a memory block in its one spelling, and its type.
    fn element(&self, name: &str) -> Option<(String, ElementType)> {
        let map = self.map.as_ref()?;
        let address = Address::parse_with(name, |block| map.radix(block)).ok()?;
        if let Some(item) = map.block(name) {
            return Some((name.to_ascii_uppercase(), item.element));
        }
        let Element::Numbered { block, number, radix, .. } = address.element else { return None };
        let kind = map.block(&block)?.element;
        let plain = Element::Numbered { block: block.to_ascii_uppercase(), number, radix, zeros: 0 };
        Some((plain.to_string(), kind))
    }
}

/// A part of an operand.
enum Part<'t> {
    /// A name or element.
    Name(&'t str),
    /// A member or cast with its sign: `.Acc`, `:UW`.
    Member(&'t str),
    /// A number, a sign, blanks (any number of them as one).
    Other(&'t str),
}

/// Takes an operand, expression or table apart.
fn each_part<'t>(text: &'t str, mut work: impl FnMut(Part<'t>)) {
    let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '$' | '@' | '#' | '~' | '?');
    let run = |text: &str, is: &dyn Fn(char) -> bool| text.find(|c: char| !is(c)).unwrap_or(text.len());
    let mut rest = text;
    let mut behind_name = false;
    while let Some(first) = rest.chars().next() {
        let (length, name) = if first.is_ascii_digit() {
            (run(rest, &|c| is_name(c) || c == '.'), false)
        } else if is_name(first) {
            (run(rest, &is_name), true)
        } else if first.is_whitespace() {
            (run(rest, &char::is_whitespace), false)
        } else {
            (first.len_utf8(), false)
        };
        let (part, behind) = rest.split_at(length);
        rest = behind;
        if behind_name && matches!(first, '.' | ':') {
            let end = run(rest, &is_name);
            let start = text.len() - rest.len() - length;
            rest = rest.get(end..).unwrap_or_default();
            work(Part::Member(text.get(start..start + length + end).unwrap_or_default()));
            continue;
        }
        // Behind an index a member may follow as behind a name.
        behind_name = name || first == ']';
        work(match (name, first.is_whitespace()) {
            (true, _) => Part::Name(part),
            (false, true) => Part::Other(" "),
            (false, false) => Part::Other(part),
        });
    }
}

/// Elements that stand in the place of others in matched instructions.
#[derive(Default)]
pub(super) struct Replaced {
    pairs: Vec<(String, String)>,
}

impl Replaced {
    /// Takes two operands in their one spelling; what is alike but for elements of one type counts.
    pub(super) fn add(&mut self, old: (&Names, &str), new: (&Names, &str)) {
        let parts = |text: &str| -> Vec<(bool, String)> {
            let mut all = Vec::new();
            each_part(text, |part| {
                all.push(match part {
                    Part::Name(name) => (true, name.to_owned()),
                    Part::Member(other) | Part::Other(other) => (false, other.to_owned()),
                });
            });
            all
        };
        let (a, b) = (parts(old.1), parts(new.1));
        let alike = |(x, y): (&(bool, String), &(bool, String))| x == y || (x.0 && y.0);
        if a.len() != b.len() || !a.iter().zip(&b).all(alike) {
            return;
        }
        for ((_, x), (_, y)) in a.iter().zip(&b).filter(|(x, y)| x != y) {
            if let (Some((x, p)), Some((y, q))) = (old.0.element(x), new.0.element(y))
                && p == q
            {
                self.pairs.push((x, y));
            }
        }
    }

    /// What was replaced throughout: twice or more, always by the same element, the old one gone and the new
    /// one not used before.
    pub(super) fn find(&self, old: (&Project, &Names), new: (&Project, &Names), mapping: &mut Mapping) -> Vec<Rename> {
        if self.pairs.is_empty() {
            return Vec::new();
        }
        let (before, after) = (used(old.0, old.1), used(new.0, new.1));
        let mut found = Vec::new();
        for (from, (to, operands)) in consistent(self.pairs.iter().cloned()) {
            if !after.contains(&from) && !before.contains(&to) {
                found.push(Rename { old: from.clone(), new: to.clone(), operands });
                mapping.names.insert(from, to);
            }
        }
        found
    }
}

/// Every name that a program uses.
fn used(project: &Project, names: &Names) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    let mut text = String::new();
    for instruction in project.code_blocks().flat_map(|block| &block.rungs).flat_map(|rung| &rung.instructions) {
        for index in 0..instruction.operands.len() {
            text.clear();
            names.spell(instruction, index, &Mapping::default(), &mut text);
            each_part(&text, |part| {
                if let Part::Name(name) = part
                    && !all.contains(name)
                {
                    all.insert(name.to_owned());
                }
            });
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use domore::program::{ElementDoc, Part as ProjectPart, Section};

    fn names() -> Names {
        let doc = |element: &str, nickname: &str, extra: &str| ElementDoc {
            element: element.into(),
            nickname: nickname.into(),
            extra: extra.into(),
            ..ElementDoc::default()
        };
        let entries = [doc("C5", "PumpRun", ""), doc("T0.Done", "Ready", ""), doc("SK3", "Limit", "12")];
        let project = Project { parts: vec![ProjectPart::Documentation(Section::new(entries))], ..Project::default() };
        Names::new(&project)
    }

    fn spelled(text: &str) -> String {
        let names = names();
        let mut words = text.split(' ');
        let instruction = Instruction::new(words.next().expect("a mnemonic"), [words.collect::<Vec<_>>().join(" ")]);
        let mut out = String::new();
        names.spell(&instruction, 0, &Mapping::default(), &mut out);
        out
    }

    #[test]
    fn operands_have_one_spelling() {
        assert_eq!(spelled("STR pumprun"), "C5");
        assert_eq!(spelled("STR c5"), spelled("STR PumpRun"));
        assert_eq!(spelled("STR Ready"), spelled("STR t0.done"));
        assert_eq!(spelled("STR SS007"), "SS7");
        assert_eq!(spelled("STR T0.Acc"), "T0.ACC");
        assert_eq!(spelled("STR DLV1400:uw"), "DLV1400:UW");
        assert_eq!(spelled("STR V[N1 + PumpRun].x"), "V[N1 + C5].X");
        assert_eq!(spelled("STR 0x10"), spelled("STR 16"));
        assert_eq!(spelled("STR Limit"), "SK3=12");
        assert_eq!(spelled("STR $FirstScan"), "ST0");
        assert_ne!(spelled("STR 16"), spelled("STR 16.0"));
    }

    #[test]
    fn texts_in_quotes_keep_every_character() {
        let names = names();
        let text = |operand: &str| {
            let mut out = String::new();
            names.spell(&Instruction::new("STRPRINT", ["SS0", operand]), 1, &Mapping::default(), &mut out);
            out
        };
        assert_eq!(text("\"pump  RUN\""), "\"pump  RUN\"");
    }
}
