//! Rungs drawn the way RSLogix prints them, as terminal text and SVG.
//!
//! ```
//! use ladder::{Documentation, Element, Image, Instruction, Mnemonic, Operand, ProgramFile, ProgramFileKind, Rung};
//!
//! let instruction = |name: &'static str, bit| {
//!     Element::Instruction(Instruction::new(Mnemonic::named(name), vec![Operand::parse(bit)]))
//! };
//! let file = ProgramFile {
//!     number: 2,
//!     name: "MAIN".into(),
//!     description: String::new(),
//!     kind: ProgramFileKind::Ladder,
//!     rungs: vec![Rung::new(vec![instruction("XIC", "I:0.0/3"), instruction("OTE", "O:0.0/1")])],
//! };
//! let style = render::Style { width: 60, ..render::Style::default() };
//! let text = render::rung(&Image::default(), &file, 0, &Documentation::default(), &style);
//! assert_eq!(text.lines().collect::<Vec<_>>(), [
//!     "      │  I:0                                          O:0  │",
//!     "0000  ├──┤ ├──────────────────────────────────────────( )──┤",
//!     "      │   3                                            1   │",
//!     "      │                                                    │",
//! ]);
//! ```
//!
//! Layout is separate from painting: [`scene()`] gives the items of a rung with their places on a
//! grid; [`rung()`] paints them as text, [`svg::drawing`] as SVG (see there for links, marks and live state),
//! and [`figure::figure`] gives strokes, areas and texts in units for any other medium. This crate reads no files and
//! knows no terminal: width and colour are given in [`Style`]. Rungs of Do-more projects are in [`domore`].

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

pub mod domore;
mod face;
pub mod figure;
pub mod html;
mod layout;
mod leaf;
mod paint;
pub mod pdf;
mod plain;
mod rung;
pub mod scene;
mod state;
pub mod svg;
mod text;

pub use text::clean;

use std::convert::Infallible;
use std::io;
use std::ops::RangeInclusive;

use ladder::{Documentation, Image, ProgramFile};

/// Narrowest drawing; a smaller [`Style::width`] is taken as this.
pub const MIN_WIDTH: usize = 60;
/// Widest drawing; a larger [`Style::width`] is taken as this.
pub const MAX_WIDTH: usize = 400;

/// How rungs are drawn.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Style {
    /// Columns, rails and rung numbers included; from [`MIN_WIDTH`] to [`MAX_WIDTH`].
    pub width: usize,
    /// ANSI colours.
    pub color: bool,
    /// Lines and contacts of plain ASCII characters. Texts of the project keep theirs.
    pub ascii: bool,
    /// Values last displayed beside operands (`5120<`).
    pub values: bool,
    /// Symbols and descriptions above instructions.
    pub descriptions: bool,
    /// Rung comments and page titles.
    pub comments: bool,
    /// Bits below contacts and coils, elements above, as on paper; `false`: the whole address above.
    pub split_bits: bool,
    /// Contacts that conduct and coils that are on, by the bits in the data tables of the image, as
    /// RSLogix highlights them. Off: a drawing says nothing about them.
    pub state: bool,
}

impl Default for Style {
    fn default() -> Self {
        Style {
            width: 100,
            color: false,
            ascii: false,
            values: true,
            descriptions: true,
            comments: true,
            split_bits: true,
            state: false,
        }
    }
}

/// Values of a running program, in place of those a project file holds.
pub struct Live<'a> {
    /// The value of an operand, by the number of the instruction in its rung and that of the operand;
    /// `None`: as without live values.
    pub value: &'a dyn Fn(usize, usize) -> Option<String>,
}

impl std::fmt::Debug for Live<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Live")
    }
}

impl Style {
    /// For SVG, HTML and PDF: whole addresses at contacts and coils, so that they can be searched.
    pub fn graphic(width: usize) -> Style {
        Style { width, split_bits: false, ..Style::default() }
    }

    fn columns(&self) -> usize {
        self.width.clamp(MIN_WIDTH, MAX_WIDTH)
    }
}

/// A rung with its number, comment and title, ended by a line that only has the power rails.
/// `index` counts from 0; beyond the end of the file the text is empty.
///
/// `documentation` may be that of another image: the online image has none of its own.
pub fn rung(image: &Image, file: &ProgramFile, index: usize, documentation: &Documentation, style: &Style) -> String {
    let mut text = String::new();
    let scene = scene(image, file, index, documentation, style);
    let Ok(()) = paint::paint(&scene, style.color, style.ascii, |line| {
        text.push_str(line);
        Ok::<(), Infallible>(())
    });
    text
}

/// The items of a rung and their places, see [`rung()`]. Colour and ASCII do not matter here.
pub fn scene(
    image: &Image,
    file: &ProgramFile,
    index: usize,
    documentation: &Documentation,
    style: &Style,
) -> scene::Scene {
    laid_out(image, file, index, documentation, style, None)
}

/// As [`scene()`], with values of a running program at the operands.
pub fn live_scene(
    image: &Image,
    file: &ProgramFile,
    index: usize,
    documentation: &Documentation,
    style: &Style,
    live: &Live<'_>,
) -> scene::Scene {
    laid_out(image, file, index, documentation, style, Some(live))
}

fn laid_out(
    image: &Image,
    file: &ProgramFile,
    index: usize,
    documentation: &Documentation,
    style: &Style,
    live: Option<&Live<'_>>,
) -> scene::Scene {
    let Some(rung) = file.rungs.get(index) else { return scene::Scene::default() };
    let source = face::Source { image, file: file.number, edited: rung.edited, documentation, style, live };
    rung::scene(&source, file, index, rung)
}

/// The head of a program file, as at the top of printed pages:
/// `LAD 2 - MAIN --- Total Rungs in File = 10`, and a line below it.
pub fn header(file: &ProgramFile, style: &Style) -> String {
    rung::head(&title(file), style)
}

/// What a program file is, on one line, as in [`header`].
pub fn title(file: &ProgramFile) -> String {
    rung::title(file)
}

/// Writes the head of a program file and its rungs, or those of `rungs` (from 0), one after the
/// other, so that no more than the layout of one rung is in memory.
///
/// # Errors
/// What writing to `out` gives.
pub fn program_file(
    out: &mut dyn io::Write,
    image: &Image,
    file: &ProgramFile,
    rungs: Option<RangeInclusive<usize>>,
    documentation: &Documentation,
    style: &Style,
) -> io::Result<()> {
    out.write_all(header(file, style).as_bytes())?;
    let all = 0..=file.rungs.len().saturating_sub(1);
    let (first, last) = rungs.unwrap_or(all).into_inner();
    for index in (first..file.rungs.len()).take_while(|index| *index <= last) {
        let scene = scene(image, file, index, documentation, style);
        paint::paint(&scene, style.color, style.ascii, |line| out.write_all(line.as_bytes()))?;
    }
    Ok(())
}
