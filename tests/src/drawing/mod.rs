//! The ladder as drawn in the PDF reports: contacts, coils, boxes and branches, from lines and texts.
//!
//! The reports of the corpus are vector drawings ("Microsoft Print To PDF"). The
//! wires are blue line segments, a branch is a pair of vertical lines, the slash of
//! an XIO is a line across the contact, symbols lie on green and descriptions on
//! pale yellow, rung comments on yellow, page titles on a green strip over the whole
//! width. So a rung's series and parallel structure can be read back from paper,
//! which the plain text of the report has lost.
//!
//! Lengths are in points with y growing downwards. RSLogix draws on a grid of rows
//! 10.56 points high.

mod content;
mod font;
mod matrix;
mod page;
mod sheet;
mod symbol;
mod walk;

pub use page::{Colour, Fill, Page, Stroke, Text, pages};
pub use symbol::{Field, Instruction, Shape};

use sheet::Sheet;

/// Height of a printed row in points.
const ROW: f64 = 10.56;

/// How far two coordinates may differ and still be the same point of the drawing.
const NEAR: f64 = 0.6;

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() < NEAR
}

/// The ladder pages of one program file.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnFile {
    /// The title as printed: `LAD 2 - MAIN --- Total Rungs in File = 4`.
    pub title: String,
    /// Program file number.
    pub number: u16,
    /// The rungs from top to bottom.
    pub rungs: Vec<DrawnRung>,
}

/// A rung as drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct DrawnRung {
    /// The number left of the rail.
    pub number: Option<usize>,
    /// Whether `e` marks stand left of the rail.
    pub edited: bool,
    /// The page title on its green strip.
    pub title: Option<String>,
    /// The lines of the rung comment as wrapped on paper.
    pub comment: Vec<String>,
    /// What hangs on the wire, from the left rail to the right one.
    pub nodes: Vec<Node>,
    /// What could not be read; empty for a rung understood in full.
    pub faults: Vec<String>,
}

/// A piece of a rung.
#[derive(Debug, Clone, PartialEq)]
pub enum Node {
    /// A contact, coil or box.
    Instruction(Instruction),
    /// Parallel legs from top to bottom, each a series.
    Branch(Vec<Vec<Node>>),
}

impl DrawnRung {
    /// Every instruction in the order of the drawing: left to right, legs top to bottom.
    #[must_use]
    pub fn instructions(&self) -> Vec<&Instruction> {
        let mut found = Vec::new();
        collect(&self.nodes, &mut found);
        found
    }

    /// The structure in one line: mnemonics and operands, with `BST`, `NXB`, `BND` around legs.
    #[must_use]
    pub fn outline(&self) -> String {
        let mut words = Vec::new();
        outline(&self.nodes, &mut words);
        words.join(" ")
    }
}

fn collect<'a>(nodes: &'a [Node], found: &mut Vec<&'a Instruction>) {
    for node in nodes {
        match node {
            Node::Instruction(instruction) => found.push(instruction),
            Node::Branch(legs) => legs.iter().for_each(|leg| collect(leg, found)),
        }
    }
}

fn outline(nodes: &[Node], words: &mut Vec<String>) {
    for node in nodes {
        match node {
            Node::Instruction(instruction) => {
                words.push(instruction.mnemonic.clone());
                words.extend(instruction.operands());
            }
            Node::Branch(legs) => {
                for (index, leg) in legs.iter().enumerate() {
                    words.push(if index == 0 { "BST" } else { "NXB" }.to_owned());
                    outline(leg, words);
                }
                words.push("BND".to_owned());
            }
        }
    }
}

/// Reads every ladder page of a report.
///
/// # Errors
/// When the bytes are no PDF or a page's drawing cannot be decoded.
pub fn read(pdf: &[u8]) -> Result<Vec<DrawnFile>, String> {
    let mut files: Vec<(DrawnFile, Vec<Sheet>)> = Vec::new();
    for page in pages(pdf)? {
        let Some((title, number)) = ladder_title(&page) else { continue };
        if !page.skipped.is_empty() {
            return Err(format!("{title}: drawn with unknown operators {:?}", page.skipped));
        }
        if files.last().is_none_or(|(file, _)| file.number != number) {
            files.push((DrawnFile { title, number, rungs: Vec::new() }, Vec::new()));
        }
        if let Some((_, sheets)) = files.last_mut() {
            sheet::add(sheets, &page);
        }
    }
    let rung = |sheet: &Sheet| walk::rung(sheet);
    Ok(files
        .into_iter()
        .map(|(mut file, sheets)| {
            file.rungs = sheets.iter().map(rung).collect();
            file
        })
        .collect())
}

/// The title line of a ladder page and the file number in it.
fn ladder_title(page: &Page) -> Option<(String, u16)> {
    let text = page.texts.iter().find(|t| t.text.starts_with("LAD ") && t.text.contains("Total Rungs"))?;
    let number = text.text.split_whitespace().nth(1)?.parse().ok()?;
    Some((text.text.trim().to_owned(), number))
}
