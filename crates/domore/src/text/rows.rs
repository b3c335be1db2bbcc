//! Lines with content and the content of lines, each way in one place, so that they cannot drift apart.

use super::words::{quote, quoted_fields, split, unquote};
use crate::program::{Comment, CommentKind, Controller, Device, ElementDoc, Instruction, MemoryBlock, Origin, Radix};

/// Content that one line holds.
pub(super) trait Line: Sized + PartialEq {
    /// The form of the line, for messages.
    const FORM: &'static str;

    /// The content of a line; `None` if it has another form.
    fn parse(line: &str) -> Option<Self>;

    /// The line as Designer writes it.
    fn format(&self) -> String;

    /// Where and how it was written.
    fn origin(&self) -> &Origin;

    /// The same, to fill in.
    fn origin_mut(&mut self) -> &mut Origin;

    /// The content of a line that was read, with its spelling where that is not Designer's.
    fn read(line: &str) -> Option<Self> {
        let mut content = Self::parse(line)?;
        if content.format() != line {
            content.origin_mut().spelling = Some(line.into());
        }
        Some(content)
    }

    /// The line to write: as it was read if that still says the same, otherwise as Designer writes it.
    fn spelled(&self) -> String {
        match &self.origin().spelling {
            Some(line) if Self::parse(line).as_ref() == Some(self) => line.to_string(),
            _ => self.format(),
        }
    }
}

macro_rules! origin {
    () => {
        fn origin(&self) -> &Origin {
            &self.origin
        }

        fn origin_mut(&mut self) -> &mut Origin {
            &mut self.origin
        }
    };
}

impl Line for Instruction {
    const FORM: &'static str = "an instruction and its operands";

    fn parse(line: &str) -> Option<Self> {
        let words = split(line).words;
        let (mnemonic, operands) = words.split_first()?;
        Some(Instruction::new(*mnemonic, operands.iter().copied()))
    }

    fn format(&self) -> String {
        let mut line = one_line(&self.mnemonic);
        for operand in &self.operands {
            line.push('\t');
            line.push_str(&one_line(operand));
        }
        line
    }

    origin!();
}

impl Line for Controller {
    const FORM: &'static str = "PLC and a model";

    fn parse(line: &str) -> Option<Self> {
        let rest = line.trim().strip_prefix("PLC")?;
        let model = rest.trim();
        let separated = rest.is_empty() || rest.starts_with([' ', '\t']);
        separated.then(|| Controller { model: model.to_owned(), origin: Origin::default() })
    }

    fn format(&self) -> String {
        format!("PLC {}", one_line(&self.model)).trim_end().to_owned()
    }

    origin!();
}

impl Line for Device {
    const FORM: &'static str = "@name, id, type and parameters";

    fn parse(line: &str) -> Option<Self> {
        let mut fields = line.trim().split(',').map(|field| field.trim().to_owned());
        let name = fields.next().filter(|name| name.starts_with('@'))?;
        Some(Device { name, parameters: fields.collect(), origin: Origin::default() })
    }

    fn format(&self) -> String {
        let mut line = format!("\t{}", one_line(&self.name));
        for parameter in &self.parameters {
            line.push_str(", ");
            line.push_str(&one_line(parameter));
        }
        line
    }

    origin!();
}

impl Line for MemoryBlock {
    const FORM: &'static str = "name, type, radix and count";

    fn parse(line: &str) -> Option<Self> {
        let trimmed = line.trim();
        // With tabs a column can be empty; a line of blanks leaves it out.
        let columns: Vec<&str> = if trimmed.contains('\t') {
            trimmed.split('\t').map(str::trim).collect()
        } else {
            trimmed.split_whitespace().collect()
        };
        let (name, rest) = columns.split_first().filter(|(name, _)| !name.is_empty())?;
        let (type_word, rest) = rest.split_first().filter(|(word, _)| !word.is_empty())?;
        let (radix, rest) = match rest.split_first()? {
            (&"decimal", rest) => (Some(Radix::Decimal), rest),
            (&"octal", rest) => (Some(Radix::Octal), rest),
            (&"", rest) => (None, rest),
            // Written without the column.
            _ => (None, rest),
        };
        let (count, extra) = rest.split_first()?;
        let base = if radix == Some(Radix::Octal) { 8 } else { 10 };
        if !count.bytes().all(|byte| byte.is_ascii_digit()) {
            return None;
        }
        Some(MemoryBlock {
            name: (*name).to_owned(),
            type_word: (*type_word).to_owned(),
            radix,
            count: u32::from_str_radix(count, base).ok()?,
            extra: extra.iter().map(|column| (*column).to_owned()).collect(),
            origin: Origin::default(),
        })
    }

    fn format(&self) -> String {
        let (radix, count) = match self.radix {
            Some(Radix::Decimal) => ("decimal", self.count.to_string()),
            Some(Radix::Octal) => ("octal", format!("0{:o}", self.count)),
            None => ("", self.count.to_string()),
        };
        let mut line = format!("\t{}\t{}\t{radix}\t{count}", one_line(&self.name), one_line(&self.type_word));
        for column in &self.extra {
            line.push('\t');
            line.push_str(&one_line(column));
        }
        line
    }

    origin!();
}

const FLAGS: &str = "FLAGS =";

impl Line for ElementDoc {
    const FORM: &'static str = "quoted fields between commas: element, flags, nickname, extra, description";

    fn parse(line: &str) -> Option<Self> {
        let fields = quoted_fields(line)?;
        let (element, mut rest) = fields.split_first()?;
        let mut flags = None;
        if let Some((first, others)) = rest.split_first()
            && let Some(words) = first.strip_prefix(FLAGS)
        {
            flags = Some(words.trim().to_owned());
            rest = others;
        }
        let field = |index: usize| rest.get(index).cloned().unwrap_or_default();
        Some(ElementDoc {
            element: element.clone(),
            flags,
            nickname: field(0),
            extra: field(1),
            description: rest.get(2..).unwrap_or_default().to_vec(),
            origin: Origin::default(),
        })
    }

    fn format(&self) -> String {
        let mut line = quote(&self.element);
        let mut field = |text: &str| {
            line.push(',');
            line.push_str(&quote(text));
        };
        match self.flags.as_deref() {
            Some("") => field(FLAGS),
            Some(words) => field(&format!("{FLAGS} {words}")),
            None => {}
        }
        field(&self.nickname);
        field(&self.extra);
        self.description.iter().for_each(|text| field(text));
        line
    }

    origin!();
}

/// A comment is a section of several lines, which are kept as one text with `\n` between them.
impl Line for Comment {
    const FORM: &'static str = "#BEGIN, lines in quotes, #END";

    fn parse(text: &str) -> Option<Self> {
        let mut lines = text.split('\n');
        let word = begin_word(lines.next()?)?;
        let kind = comment_kind(word).unwrap_or_else(|| CommentKind::Other(word.to_owned()));
        let mut content: Vec<&str> = lines.collect();
        // A section that is cut off has no end line.
        content.pop_if(|line| is_end(line));
        let lines = match kind {
            CommentKind::Other(_) => content.into_iter().map(str::to_owned).collect(),
            _ => content.into_iter().map(comment_line).collect(),
        };
        Some(Comment { kind, lines, origin: Origin::default() })
    }

    fn format(&self) -> String {
        let mut text = format!("#BEGIN {}", one_line(self.word()));
        if !matches!(self.kind, CommentKind::Other(_)) {
            // Designer leaves a blank behind the word.
            text.push(' ');
        }
        for line in &self.lines {
            text.push('\n');
            match self.kind {
                CommentKind::Other(_) => text.push_str(&one_line(line)),
                _ => text.push_str(&quote(line)),
            }
        }
        text.push_str("\n#END");
        text
    }

    origin!();
}

/// The text of a line of a comment. What is not in quotes counts as it stands.
fn comment_line(line: &str) -> String {
    unquote(line.trim()).unwrap_or_else(|| line.trim().to_owned())
}

/// Whether a line of a comment has the form it should have.
pub(super) fn is_comment_line(line: &str) -> bool {
    unquote(line.trim()).is_some()
}

/// The kind of comment that a section of this name is.
pub(super) fn comment_kind(word: &str) -> Option<CommentKind> {
    match word {
        "COMMENT" => Some(CommentKind::Plain),
        "FMT_COMMENT" => Some(CommentKind::Formatted),
        _ => None,
    }
}

/// The name of a section: what follows `#BEGIN`.
pub(super) fn begin_word(line: &str) -> Option<&str> {
    let word = line.trim();
    let (head, rest) = word.split_at_checked("#BEGIN".len())?;
    let separated = rest.is_empty() || rest.starts_with([' ', '\t']);
    (head.eq_ignore_ascii_case("#BEGIN") && separated).then(|| rest.trim())
}

/// Whether a line ends a section.
pub(super) fn is_end(line: &str) -> bool {
    line.trim().eq_ignore_ascii_case("#END")
}

/// A text that cannot break out of its line.
pub(super) fn one_line(text: &str) -> String {
    text.replace(['\r', '\n'], " ")
}
