//! Nicknames, descriptions and comments as a person reads them.

use std::borrow::Cow;
use std::collections::HashMap;

use crate::program::{Comment, CommentKind, ElementDoc, Project};

/// The element documentation of a project, found by element or nickname.
#[derive(Debug, Default)]
pub struct Documentation<'p> {
    elements: HashMap<&'p str, &'p ElementDoc>,
    nicknames: HashMap<&'p str, &'p ElementDoc>,
}

/// What is known of an operand.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Shown<'p> {
    /// Nickname with the member or cast of the operand, `RunDelay.Done`; the element where the operand
    /// is itself a nickname; empty if neither is known.
    pub name: Cow<'p, str>,
    /// Description, lines without those that are empty at its end.
    pub description: &'p [String],
}

impl<'p> Documentation<'p> {
    /// Indexes the documentation of a project; of several entries for one element the first counts.
    pub fn new(project: &'p Project) -> Self {
        let mut documentation = Documentation::default();
        for entry in project.documentation() {
            documentation.elements.entry(&entry.element).or_insert(entry);
            if !entry.nickname.is_empty() {
                documentation.nicknames.entry(&entry.nickname).or_insert(entry);
            }
        }
        documentation
    }

    /// The entry of exactly this element (`T0`, `T0.Done`, `V84:SD`).
    pub fn entry(&self, element: &str) -> Option<&'p ElementDoc> {
        self.elements.get(element).copied()
    }

    /// The entry with this nickname.
    pub fn nickname(&self, nickname: &str) -> Option<&'p ElementDoc> {
        self.nicknames.get(nickname).copied()
    }

    /// What to show with an operand: its own documentation, or that of the element it is a member or
    /// cast of.
    pub fn shown(&self, operand: &str) -> Shown<'p> {
        let of = |entry: &'p ElementDoc, name| Shown { name, description: entry.lines() };
        if let Some(entry) = self.entry(operand) {
            return of(entry, Cow::Borrowed(&entry.nickname));
        }
        if let Some(entry) = self.nickname(operand) {
            return of(entry, Cow::Borrowed(&entry.element));
        }
        let Some((base, rest)) = operand.find(['.', ':']).map(|at| operand.split_at(at)) else {
            return Shown::default();
        };
        let found = self.entry(base).map(|entry| (entry, &entry.nickname));
        let found = found.or_else(|| self.nickname(base).map(|entry| (entry, &entry.element)));
        match found {
            Some((entry, name)) if name.is_empty() => of(entry, Cow::Borrowed("")),
            Some((entry, name)) => of(entry, Cow::Owned(format!("{name}{rest}"))),
            None => Shown::default(),
        }
    }
}

impl Comment {
    /// The comment as lines of plain text: a formatted one without its tags.
    pub fn plain_lines(&self) -> Vec<Cow<'_, str>> {
        match self.kind {
            CommentKind::Formatted => self.lines.iter().flat_map(|line| unformatted(line)).map(Cow::Owned).collect(),
            _ => self.lines.iter().map(|line| Cow::Borrowed(line.as_str())).collect(),
        }
    }
}

/// Tags of formatted comments that only concern how text looks.
const LOOKS: [&str; 7] = ["B", "I", "U", "S", "FONT", "CENTER", "SPAN"];

/// The text of a formatted line. `<br>` begins a new line, except at the end, where there is one anyway.
/// What is no known tag is kept.
fn unformatted(line: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    let mut rest = line;
    while let Some(at) = rest.find(['<', '%']) {
        let (text, after) = rest.split_at(at);
        push(&mut lines, text);
        let escape = after.get(..3).and_then(|code| match code.to_ascii_uppercase().as_str() {
            "%25" => Some("%"),
            "%3C" => Some("<"),
            "%3E" => Some(">"),
            _ => None,
        });
        let tag = after.strip_prefix('<').and_then(|tag| tag.split_once('>'));
        let name = |tag: &str| {
            let word = tag.trim_start_matches('/').split([' ', '/']).next().unwrap_or_default();
            word.to_ascii_uppercase()
        };
        rest = match (escape, tag) {
            (Some(character), _) => {
                push(&mut lines, character);
                after.get(3..).unwrap_or_default()
            }
            (None, Some((tag, behind))) if name(tag) == "BR" => {
                if !behind.is_empty() {
                    lines.push(String::new());
                }
                behind
            }
            (None, Some((tag, behind))) if LOOKS.contains(&name(tag).as_str()) => behind,
            _ => {
                let (kept, behind) = after.split_at(1);
                push(&mut lines, kept);
                behind
            }
        };
    }
    push(&mut lines, rest);
    lines
}

fn push(lines: &mut [String], text: &str) {
    if let Some(last) = lines.last_mut() {
        last.push_str(text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::{Part, Section};

    fn doc(element: &str, nickname: &str, description: &str) -> ElementDoc {
        ElementDoc {
            element: element.into(),
            nickname: nickname.into(),
            description: vec![description.into(), String::new()],
            ..ElementDoc::default()
        }
    }

    #[test]
    fn members_and_casts_take_the_documentation_of_their_element() {
        let entries = [
            doc("T0", "RunDelay", "after start"),
            doc("T1.Done", "Ready", ""),
            doc("V84:SD", "Total", ""),
            doc("X0", "", "button"),
        ];
        let project = Project { parts: vec![Part::Documentation(Section::new(entries))], ..Project::default() };
        let documentation = Documentation::new(&project);
        let shown = |operand| {
            let shown = documentation.shown(operand);
            (shown.name.into_owned(), shown.description.join("/"))
        };
        assert_eq!(shown("T0"), ("RunDelay".into(), "after start".into()));
        assert_eq!(shown("T0.Done"), ("RunDelay.Done".into(), "after start".into()));
        assert_eq!(shown("T1.Done"), ("Ready".into(), String::new()));
        assert_eq!(shown("V84:SD"), ("Total".into(), String::new()));
        assert_eq!(shown("X0"), (String::new(), "button".into()));
        assert_eq!(shown("RunDelay"), ("T0".into(), "after start".into()));
        assert_eq!(shown("RunDelay.Acc"), ("T0.Acc".into(), "after start".into()));
        assert_eq!(shown("N7"), (String::new(), String::new()));
    }

    #[test]
    fn formatted_comments_become_plain() {
        let plain = |line: &str| {
            let comment = Comment { kind: CommentKind::Formatted, lines: vec![line.into()], ..Comment::default() };
            comment.plain_lines().join("|")
        };
        assert_eq!(plain("<B>100%25</B> of <FONT color=#FF0000 tsize=12>all</FONT><br>"), "100% of all");
        assert_eq!(plain("one<br>two<BR/>three"), "one|two|three");
        assert_eq!(plain("a %3C b < c <unknown> 5 % 日"), "a < b < c <unknown> 5 % 日");
    }
}
