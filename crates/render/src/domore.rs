//! Rungs of Do-more projects, drawn with the look of all others.
//!
//! What an instruction is comes from the instruction table of the dialect, what stands where from
//! [`domore::circuit`]. A rung that contacts between rails cannot show stands in words, with the reason.

use std::borrow::Cow;
use std::convert::Infallible;
use std::io;
use std::ops::RangeInclusive;

use domore::circuit::{Node, circuit};
use domore::documentation::Documentation;
use domore::instruction::{self, Effect, Entry, Flow, Kind, Role as Does, Test};
use domore::{CodeBlock, CodeKind, Instruction, Rung};

use crate::face::{Body, Face, Row, Sign, Text, add_labels};
use crate::layout::{MAX_ELEMENTS, NotDrawn, Part};
use crate::rung::{Diagram, compose, head};
use crate::scene::{Role, Scene};
use crate::text::clean;
use crate::{Live, Style, paint};

/// Rows of a table operand that are drawn.
const TABLE_ROWS: usize = 200;

/// A rung with its number (from 1, as Designer counts), comment and documentation, ended by a line
/// that only has the power rails. `index` counts from 0; beyond the end of the block the text is empty.
pub fn rung(block: &CodeBlock, index: usize, documentation: &Documentation<'_>, style: &Style) -> String {
    let mut text = String::new();
    let Ok(()) = paint::paint(&scene(block, index, documentation, style), style.color, style.ascii, |line| {
        text.push_str(line);
        Ok::<(), Infallible>(())
    });
    text
}

/// The items of a rung and their places, see [`rung`].
pub fn scene(block: &CodeBlock, index: usize, documentation: &Documentation<'_>, style: &Style) -> Scene {
    laid_out(block, index, documentation, style, None)
}

/// As [`scene`], with a row for the value of each operand that `live` has one for: boxes of Do-more show none otherwise.
pub fn live_scene(
    block: &CodeBlock,
    index: usize,
    documentation: &Documentation<'_>,
    style: &Style,
    live: &Live<'_>,
) -> Scene {
    laid_out(block, index, documentation, style, Some(live))
}

fn laid_out(
    block: &CodeBlock,
    index: usize,
    documentation: &Documentation<'_>,
    style: &Style,
    live: Option<&Live<'_>>,
) -> Scene {
    let Some(rung) = block.rungs.get(index) else { return Scene::default() };
    let digits = block.rungs.len().to_string().len().max(4);
    let source = Source { documentation, style, live };
    let diagram = Diagram {
        number: format!("{:0digits$}", index + 1),
        title: "",
        comment: rung.comment.as_ref().map(|comment| comment.plain_lines()).unwrap_or_default(),
        edited: false,
        parts: source.parts(rung),
        words: &|| words(rung),
    };
    compose(diagram, style)
}

/// The head of a code block: `Program Batch --- Total Rungs in Code Block = 12`, and a line below it.
pub fn header(block: &CodeBlock, style: &Style) -> String {
    head(&title(block), style)
}

/// What a code block is, on one line, as in [`header`].
pub fn title(block: &CodeBlock) -> String {
    let name = match block.kind {
        CodeKind::Bare => "Rungs without a code block".to_owned(),
        _ => format!("{} {}", clean(block.kind.title()), clean(&block.name)),
    };
    format!("{name} --- Total Rungs in Code Block = {}", block.rungs.len())
}

/// Writes the head of a code block and its rungs, or those of `rungs` (indices from 0).
///
/// # Errors
/// What writing to `out` gives.
pub fn code_block(
    out: &mut dyn io::Write,
    block: &CodeBlock,
    rungs: Option<RangeInclusive<usize>>,
    documentation: &Documentation<'_>,
    style: &Style,
) -> io::Result<()> {
    out.write_all(header(block, style).as_bytes())?;
    let (first, last) = rungs.unwrap_or(0..=usize::MAX).into_inner();
    for index in (first..block.rungs.len()).take_while(|index| *index <= last) {
        let scene = scene(block, index, documentation, style);
        paint::paint(&scene, style.color, style.ascii, |line| out.write_all(line.as_bytes()))?;
    }
    Ok(())
}

/// The instructions of a rung one after the other.
fn words(rung: &Rung) -> String {
    let all: Vec<String> = rung.instructions.iter().map(|it| clean(&it.to_string()).into_owned()).collect();
    all.join("; ")
}

struct Source<'a> {
    documentation: &'a Documentation<'a>,
    style: &'a Style,
    live: Option<&'a Live<'a>>,
}

impl Source<'_> {
    fn parts(&self, rung: &Rung) -> Result<Vec<Part>, NotDrawn> {
        if rung.instructions.len() > MAX_ELEMENTS {
            return Err(NotDrawn::Size);
        }
        circuit(rung).map(|nodes| self.series(rung, &nodes)).map_err(NotDrawn::Form)
    }

    /// Nesting is bounded by [`domore::circuit::MAX_DEPTH`].
    fn series(&self, rung: &Rung, nodes: &[Node]) -> Vec<Part> {
        let face = |index: &usize| rung.instructions.get(*index).map(|it| self.face(it, *index)).unwrap_or_else(empty);
        let part = |node: &Node| match node {
            Node::Instruction(index) => Part::Leaf(face(index)),
            Node::Branch(legs) => Part::Legs(legs.iter().map(|leg| self.series(rung, leg)).collect()),
            Node::Box { index, legs } => {
                let entry = rung.instructions.get(*index).and_then(|it| instruction::by_mnemonic(&it.mnemonic));
                let names = match entry.map(|entry| entry.effect) {
                    Some(Effect::Box { legs }) => legs,
                    _ => &[],
                };
                let leg =
                    |(at, leg): (usize, &Vec<Node>)| (names.get(at).copied().unwrap_or("?"), self.series(rung, leg));
                Part::Box(face(index), legs.iter().enumerate().map(leg).collect())
            }
        };
        nodes.iter().map(part).collect()
    }

    fn face(&self, instruction: &Instruction, index: usize) -> Face {
        let mut face = self.shape(instruction, index);
        face.index = index;
        face.words = clean(&instruction.to_string()).into_owned();
        add_labels(&mut face.words, &face.labels);
        face
    }

    fn shape(&self, instruction: &Instruction, number: usize) -> Face {
        let Some(entry) = instruction::by_mnemonic(&instruction.mnemonic) else {
            return self.unknown(instruction, number);
        };
        let output = Some(!matches!(entry.effect, Effect::Contact { .. } | Effect::Flow(_)));
        let counts = entry.required..=entry.operands.len();
        if counts.contains(&instruction.operands.len())
            && let Some(sign) = sign(entry)
        {
            return Face { output, labels: self.labels(instruction, 0), ..face(self.symbol(instruction, sign)) };
        }
        let owner = entry.operands.iter().position(|operand| {
            matches!(operand.role, Does::Own | Does::Write | Does::Reset | Does::ReadWrite)
                && !matches!(operand.kind, Kind::Table(_))
        });
        let body = Body::Box {
            name: clean(&instruction.mnemonic).into_owned(),
            title: entry.title.to_owned(),
            rows: self.rows(instruction, number, Some(entry), owner),
            flags: &[],
        };
        let labels = owner.map(|index| self.labels(instruction, index)).unwrap_or_default();
        Face { output, labels, ..face(body) }
    }

    /// An instruction that is not in the table: all it holds, nothing guessed.
    fn unknown(&self, instruction: &Instruction, number: usize) -> Face {
        let body = Body::Box {
            name: clean(&instruction.mnemonic).into_owned(),
            title: "(unknown instruction)".to_owned(),
            rows: self.rows(instruction, number, None, None),
            flags: &[],
        };
        face(body)
    }

    /// Description and nickname of operand `index`.
    fn labels(&self, instruction: &Instruction, index: usize) -> Vec<Text> {
        let operand = instruction.operand(index);
        if !self.style.descriptions || operand.is_empty() {
            return Vec::new();
        }
        let shown = self.documentation.shown(operand);
        let lines = shown.description.iter().map(|line| Text::new(Role::Description, clean(line.trim_end())));
        let name = (!shown.name.is_empty()).then(|| text(operand, index).with(Role::Symbol, clean(&shown.name)));
        lines.chain(name).collect()
    }

    /// An operand, with its nickname behind it.
    fn named(&self, operand: &str) -> String {
        let shown = self.documentation.shown(operand);
        if shown.name.is_empty() || !self.style.descriptions {
            return clean(operand).into_owned();
        }
        format!("{} ({})", clean(operand), clean(&shown.name))
    }

    fn symbol(&self, instruction: &Instruction, sign: Sign) -> Body {
        let second = instruction.operands.get(1);
        let second = second.map(|operand| text(operand, 1).with(Role::Address, self.named(operand)));
        let above = text(instruction.operand(0), 0).with(Role::Address, clean(instruction.operand(0)));
        Body::Symbol { sign, above, below: second.into_iter().collect() }
    }

    /// The rows of a box below its title.
    fn rows(
        &self,
        instruction: &Instruction,
        number: usize,
        entry: Option<&Entry>,
        labelled: Option<usize>,
    ) -> Vec<Row> {
        let mut rows = Vec::new();
        for (index, operand) in instruction.operands.iter().enumerate() {
            let known = entry.and_then(|entry| entry.operand(index));
            let name = known.map_or_else(|| format!("Operand {}", index + 1), |known| known.name.to_owned());
            let shown = match known.map(|known| known.kind) {
                Some(Kind::Table(_)) => {
                    table_rows(&mut rows, name, operand);
                    continue;
                }
                Some(Kind::Expression) => {
                    clean(&domore::text::unquote(operand).unwrap_or_else(|| operand.clone())).into_owned()
                }
                Some(Kind::Number) if is_milliseconds(entry, known.map_or("", |known| known.name), operand) => {
                    format!("{} ms", clean(operand))
                }
                _ if labelled == Some(index) => clean(operand).into_owned(),
                _ => self.named(operand),
            };
            rows.push(Row { name, text: text(operand, index).with(Role::Operand, shown), live: false });
            if let Some(value) = self.live.and_then(|live| (live.value)(number, index)) {
                let counts = matches!(known.map(|known| known.kind), Some(Kind::Timer | Kind::Counter));
                let name = if counts { "Acc".to_owned() } else { String::new() };
                let text = Text { operand: Some(index), ..Text::new(Role::Value, clean(value.trim()).into_owned()) };
                rows.push(Row { name, text, live: true });
            }
        }
        rows
    }
}

/// Nothing: for an index that no rung has.
fn empty() -> Face {
    face(Body::Symbol { sign: Sign::Marked("?"), above: Text::new(Role::Address, ""), below: Vec::new() })
}

/// A face without anything around its body.
fn face(body: Body) -> Face {
    Face { index: 0, words: String::new(), labels: Vec::new(), body, output: None, forced: None, state: None }
}

/// Operand `index` with the address it is.
fn text(operand: &str, index: usize) -> Text {
    // A lone name is an address as well (a stage, a timer structure); digits and quotes begin none.
    let address = operand.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_' || c == '$');
    let address = address && domore::address::Address::parse(operand).is_ok();
    let link = address.then(|| clean(operand).into_owned());
    Text { role: Role::Operand, text: clean(operand).into_owned(), operand: Some(index), link }
}

/// A constant that stands for milliseconds.
fn is_milliseconds(entry: Option<&Entry>, name: &str, operand: &str) -> bool {
    let times = matches!(name, "Preset" | "Delay" | "On time" | "Off time" | "Time");
    let counter = entry.and_then(|entry| entry.operand(0)).is_some_and(|first| first.kind == Kind::Counter);
    times && !counter && !operand.is_empty() && operand.bytes().all(|byte| byte.is_ascii_digit())
}

/// The sign of an instruction that is no box.
fn sign(entry: &'static Entry) -> Option<Sign> {
    Some(match (entry.effect, entry.operands) {
        (Effect::Contact { test, .. }, _) => match test {
            Test::On => Sign::Contact { closed: false },
            Test::Off => Sign::Contact { closed: true },
            Test::Rise => Sign::Marked("PD"),
            Test::Fall => Sign::Marked("ND"),
            Test::Change => Sign::Marked("DLT"),
            Test::Compare(relation) => Sign::Marked(relation.sign()),
        },
        (Effect::Flow(flow), _) => Sign::Marked(match flow {
            Flow::Invert => "NOT",
            Flow::Rise => "PDPF",
            Flow::Fall => "NDPF",
        }),
        (Effect::Output, [one]) if one.kind == Kind::Bit => match entry.mnemonic {
            "OUT" => Sign::Coil(""),
            name => Sign::Coil(name),
        },
        (Effect::Output, [one]) if matches!(one.kind, Kind::Stage | Kind::CodeBlock) => Sign::Coil(entry.mnemonic),
        (Effect::Output | Effect::Alone, []) => Sign::Coil(entry.mnemonic),
        _ => return None,
    })
}

/// A table operand, one row of it in each row of the box.
fn table_rows(rows: &mut Vec<Row>, name: String, operand: &str) {
    let text = domore::text::unquote(operand);
    let text = text.as_deref().unwrap_or(operand);
    let row = |name, text: Cow<'_, str>| Row { name, text: Text::new(Role::Operand, text), live: false };
    let mut words = text.split_whitespace();
    let columns = words.next().and_then(|word| word.parse::<usize>().ok()).filter(|columns| *columns > 0);
    let Some(columns) = columns.filter(|_| !text.contains('"')) else {
        rows.push(row(name, clean(text)));
        return;
    };
    let words: Vec<&str> = words.collect();
    if words.is_empty() {
        rows.push(row(name, Cow::Borrowed("none")));
        return;
    }
    let mut name = Some(name);
    for line in words.chunks(columns).take(TABLE_ROWS) {
        rows.push(row(name.take().unwrap_or_default(), clean(&line.join(" "))));
    }
    let more = words.chunks(columns).count().saturating_sub(TABLE_ROWS);
    if more > 0 {
        let text = Text::new(Role::Note, format!("({more} more)"));
        rows.push(Row { name: String::new(), text, live: false });
    }
}
