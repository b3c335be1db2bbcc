//! A scene as SVG, for pages and as a file of its own.
//!
//! ```
//! use ladder::{Documentation, Element, Image, Instruction, Mnemonic, Operand, ProgramFile, ProgramFileKind, Rung};
//! use render::svg;
//!
//! let instruction = |name: &'static str, bit| {
//!     Element::Instruction(Instruction::new(Mnemonic::named(name), vec![Operand::parse(bit)]))
//! };
//! let file = ProgramFile {
//!     number: 2,
//!     name: "MAIN".into(),
//!     description: String::new(),
//!     kind: ProgramFileKind::Ladder,
//!     rungs: vec![Rung::new(vec![instruction("XIC", "B3:0/3"), instruction("OTE", "T4:0/DN")])],
//! };
//! let style = render::Style::graphic(60);
//! let scene = render::scene(&Image::default(), &file, 0, &Documentation::default(), &style);
//! let options = svg::Options {
//!     // Every address that a text shows, in the spelling of the model.
//!     href: &|address| Some(format!("#{}", address.replace([':', '/'], "-"))),
//!     // The second instruction is new in this version of the program.
//!     mark: &|index| svg::Mark {
//!         change: (index == 1).then_some(svg::Change::Inserted),
//!         ..svg::Mark::default()
//!     },
//!     ..svg::Options::default()
//! };
//! let page = format!("<style>{}</style>{}", svg::STYLE, svg::drawing(&scene, &options));
//! assert!(page.contains(r##"<a href="#B3-0-3">"##) && page.contains(">T4:0/DN</text>"));
//! assert!(page.contains(r#"class="i inserted" data-i="1"><title>inserted: OTE T4:0/DN</title>"#));
//! ```
//!
//! A drawing holds no script, no style attribute and no reference to anything outside; [`STYLE`] goes once
//! into the page it stands in. Every text fills its columns exactly, whatever the font, and stands in one
//! piece, so that it can be selected and searched. Colours are CSS variables (`--rung-wire`, ...), light
//! and dark by the reader's setting or `data-theme` on an element around; marks differ in weight, dashes or
//! shape too.
//!
//! Classes, for style sheets and scripts of a page: `svg.rung`; `g.i` with `data-i` for an instruction, with
//! `on` or `off`, `forced-on` or `forced-off`, `inserted`, `deleted` or `changed`, `found`; `path.w` with
//! `data-n` for a wire, with `on` if it has power; texts by their [`Role`], those of an operand with `data-o`.

mod escape;
mod style;

use std::fmt::Write;

use crate::figure::{Area, Figure, Group, Ink, Line, Pen, Step, figure};
use crate::scene::{Role, Scene, Spot};

pub use escape::escape;
pub use style::STYLE;

/// How a scene is drawn.
pub struct Options<'a> {
    /// Where an address leads, in the spelling of the model (`T4:0/DN`). Asked for operands and symbols,
    /// and for addresses in comments and expressions too.
    pub href: &'a dyn Fn(&str) -> Option<String>,
    /// What is to be seen of an instruction, by its number in the rung.
    pub mark: &'a dyn Fn(usize) -> Mark,
    /// Whether power leaves an instruction: wires with power are drawn as such.
    pub power: Option<&'a dyn Fn(usize) -> bool>,
    /// A file of its own: with name space and style sheet.
    pub standalone: bool,
    /// The `id` of the drawing; instruction 3 gets the same and `-3`. Empty: none.
    pub id: &'a str,
    /// What the drawing is, for people who do not see it. Empty: `Rung 0004`.
    pub label: &'a str,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Options { href: &|_| None, mark: &|_| Mark::default(), power: None, standalone: false, id: "", label: "" }
    }
}

impl std::fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Options { standalone, id, label, .. } = self;
        f.debug_struct("Options").field("standalone", standalone).field("id", id).field("label", label).finish()
    }
}

/// What is to be seen of an instruction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mark {
    /// In a comparison.
    pub change: Option<Change>,
    /// It conducts, or is on. `None`: what [`Spot::state`] says.
    pub on: Option<bool>,
    /// Its point is forced on or off. `None`: what [`Spot::forced`] says.
    pub forced: Option<bool>,
    /// It is what the reader was looking for.
    pub found: bool,
}

/// What a comparison says about an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Only in the new program: a solid outline.
    Inserted,
    /// Only in the old program: a dashed outline, crossed out.
    Deleted,
    /// In both, with other operands: a dotted outline.
    Changed,
}

impl Change {
    /// The class, and what stands before the instruction's words.
    pub fn as_str(self) -> &'static str {
        match self {
            Change::Inserted => "inserted",
            Change::Deleted => "deleted",
            Change::Changed => "changed",
        }
    }
}

/// One `<svg>` element with the scene.
pub fn drawing(scene: &Scene, options: &Options<'_>) -> String {
    let figure = figure(scene);
    let mut svg = Svg { out: String::with_capacity(1024 + 160 * scene.items.len()), options };
    svg.document(scene, &figure);
    svg.out
}

struct Svg<'a> {
    out: String,
    options: &'a Options<'a>,
}

impl Svg<'_> {
    /// Writing to a string cannot fail.
    fn put(&mut self, arguments: std::fmt::Arguments<'_>) {
        let _ = self.out.write_fmt(arguments);
    }

    fn document(&mut self, scene: &Scene, figure: &Figure) {
        let Figure { width, height, .. } = *figure;
        self.out.push_str("<svg class=\"rung\"");
        if self.options.standalone {
            self.out.push_str(" xmlns=\"http://www.w3.org/2000/svg\"");
        }
        if !self.options.id.is_empty() {
            self.put(format_args!(" id=\"{}\"", escape(self.options.id)));
        }
        let number = format!("Rung {}", scene.number);
        let label = if self.options.label.is_empty() { &number } else { self.options.label };
        // With links in it, it is no picture to those who hear it: they could not follow them.
        let mut inside = Svg { out: String::with_capacity(self.out.capacity()), options: self.options };
        inside.content(scene, figure);
        let role = if inside.out.contains("<a href=") { "group" } else { "img" };
        self.put(format_args!(
            " width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" role=\"{role}\" aria-label=\"{}\" xml:space=\"preserve\">",
            escape(label)
        ));
        if self.options.standalone {
            self.put(format_args!("<style>{STYLE}</style>"));
            self.put(format_args!("<rect class=\"paper\" width=\"{width}\" height=\"{height}\"/>"));
        }
        self.out.push_str(&inside.out);
        self.out.push_str("</svg>");
    }

    /// Backgrounds, then wires, then what stands on them.
    fn content(&mut self, scene: &Scene, figure: &Figure) {
        let behind = figure.rung.iter().take_while(|ink| matches!(ink, Ink::Fill(..))).count();
        let (backgrounds, rest) = figure.rung.split_at(behind);
        backgrounds.iter().for_each(|ink| self.ink(ink));
        self.wires(scene, figure);
        rest.iter().for_each(|ink| self.ink(ink));
        for group in &figure.instructions {
            self.group(group, scene.instructions.iter().find(|spot| spot.index == group.index));
        }
    }

    fn wires(&mut self, scene: &Scene, figure: &Figure) {
        let power = self.options.power.map(|power| scene.powered(power));
        for (node, steps) in &figure.wires {
            let on = power.as_ref().is_some_and(|power| power.get(*node).copied().unwrap_or(false));
            self.put(format_args!("<path class=\"w{}\" data-n=\"{node}\" d=\"", if on { " on" } else { "" }));
            self.path(steps);
            self.out.push_str("\"/>");
        }
    }

    fn group(&mut self, group: &Group, spot: Option<&Spot>) {
        let index = group.index;
        let mark = (self.options.mark)(index);
        let on = mark.on.or(spot.and_then(|spot| spot.state));
        let forced = mark.forced.or(spot.and_then(|spot| spot.forced));
        let mut classes = String::from("i");
        let states = [
            mark.change.map(Change::as_str),
            on.map(|on| if on { "on" } else { "off" }),
            forced.map(|on| if on { "forced-on" } else { "forced-off" }),
            mark.found.then_some("found"),
        ];
        for class in states.into_iter().flatten() {
            classes.push(' ');
            classes.push_str(class);
        }
        self.put(format_args!("<g class=\"{classes}\" data-i=\"{index}\""));
        if !self.options.id.is_empty() {
            self.put(format_args!(" id=\"{}-{index}\"", escape(self.options.id)));
        }
        self.out.push_str("><title>");
        if let Some(change) = mark.change {
            self.put(format_args!("{}: ", change.as_str()));
        }
        if let Some(spot) = spot {
            self.put(format_args!("{}", escape(&spot.title)));
        }
        let told = [
            forced.map(|on| if on { "forced on" } else { "forced off" }),
            on.map(|on| if on { "true" } else { "false" }),
        ];
        for told in told.into_iter().flatten() {
            self.put(format_args!(" ({told})"));
        }
        self.out.push_str("</title>");
        if on.is_some() {
            group.bars.iter().for_each(|bar| self.rect("bar", *bar));
        }
        group.inks.iter().for_each(|ink| self.ink(ink));
        if mark.change.is_some() || mark.found {
            self.rect("outline", group.outline);
        }
        if mark.change == Some(Change::Deleted) {
            let Area { x, y, width, height } = group.outline;
            self.put(format_args!("<path class=\"outline\" d=\"M{x} {}L{} {y}\"/>", y + height, x + width));
        }
        self.out.push_str("</g>");
    }

    fn rect(&mut self, class: &str, area: Area) {
        let Area { x, y, width, height } = area;
        self.put(format_args!("<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\"/>"));
    }

    fn ink(&mut self, ink: &Ink) {
        match ink {
            Ink::Fill(role, area) => self.rect(&format!("bg {}", class(*role)), *area),
            Ink::Stroke(pen, steps) => {
                let class = match pen {
                    Pen::Rail => "rail",
                    Pen::Wire => "w",
                    Pen::Sign => "sign",
                    Pen::Frame => "frame",
                };
                self.put(format_args!("<path class=\"{class}\" d=\""));
                self.path(steps);
                self.out.push_str("\"/>");
            }
            Ink::Text(line) => self.text(line),
        }
    }

    fn path(&mut self, steps: &[Step]) {
        let mut at = (0, 0);
        for step in steps {
            match *step {
                Step::Move(x, y) => {
                    self.put(format_args!("M{x} {y}"));
                    at = (x, y);
                }
                Step::Line(x, y) => {
                    match (x == at.0, y == at.1) {
                        (true, _) => self.put(format_args!("V{y}")),
                        (_, true) => self.put(format_args!("H{x}")),
                        _ => self.put(format_args!("L{x} {y}")),
                    }
                    at = (x, y);
                }
                Step::Curve(one, two, end) => {
                    self.put(format_args!("C{} {} {} {} {} {}", one.0, one.1, two.0, two.1, end.0, end.1));
                    at = end;
                }
            }
        }
    }

    fn text(&mut self, line: &Line) {
        let Line { x, y, width, role, ref text, operand, ref link } = *line;
        let href = link.as_deref().and_then(|link| (self.options.href)(link));
        if let Some(href) = &href {
            self.put(format_args!("<a href=\"{}\">", escape(href)));
        }
        self.put(format_args!("<text class=\"{}\" x=\"{x}\" y=\"{y}\"", class(role)));
        // One letter needs no stretching; a wider one does.
        self.put(format_args!(" textLength=\"{width}\" lengthAdjust=\"spacingAndGlyphs\""));
        if let Some(operand) = operand {
            self.put(format_args!(" data-o=\"{operand}\""));
        }
        self.out.push('>');
        if link.is_none() && matches!(role, Role::Comment | Role::Title | Role::Operand | Role::Description) {
            self.linked(text);
        } else {
            self.put(format_args!("{}", escape(text)));
        }
        self.out.push_str("</text>");
        if href.is_some() {
            self.out.push_str("</a>");
        }
    }

    /// A text in which addresses are links.
    fn linked(&mut self, text: &str) {
        let mut rest = text;
        while let Some((before, word, after)) = next_word(rest) {
            self.put(format_args!("{}", escape(before)));
            match address(word).and_then(|address| (self.options.href)(&address)) {
                Some(href) => self.put(format_args!("<a href=\"{}\">{}</a>", escape(&href), escape(word))),
                None => self.put(format_args!("{}", escape(word))),
            }
            rest = after;
        }
        self.put(format_args!("{}", escape(rest)));
    }
}

/// The next run of characters that addresses are made of, with what stands before and after it.
fn next_word(text: &str) -> Option<(&str, &str, &str)> {
    let part = |c: char| c.is_ascii_alphanumeric() || matches!(c, ':' | '/' | '.' | '_' | '$');
    let start = text.find(|c: char| c.is_ascii_alphanumeric() || c == '$')?;
    let (before, rest) = text.split_at(start);
    let end = rest.find(|c| !part(c)).unwrap_or(rest.len());
    let (word, _) = rest.split_at(end);
    let word = word.trim_end_matches(['.', ':', '/', '_']);
    let word = if word.is_empty() { rest.get(..1)? } else { word };
    Some((before, word, rest.get(word.len()..)?))
}

/// A word as an address in the spelling of the model; as it is where it is none of SLC.
fn address(word: &str) -> Option<String> {
    if !word.bytes().any(|byte| byte.is_ascii_digit()) || !word.starts_with(|c: char| c.is_ascii_alphabetic()) {
        return None;
    }
    Some(ladder::Address::parse(word).map_or_else(|_| word.to_owned(), |address| address.to_string()))
}

/// The class of a text.
fn class(role: Role) -> &'static str {
    match role {
        Role::RungNumber => "number",
        Role::EditMark => "edit",
        Role::Title => "title",
        Role::Comment => "comment",
        Role::Description => "description",
        Role::Symbol => "symbol",
        Role::Address => "address",
        Role::Module => "module",
        Role::Mnemonic => "mnemonic",
        Role::BoxTitle => "box",
        Role::Name => "name",
        Role::Operand => "operand",
        Role::Value => "value",
        Role::Note => "note",
        Role::Force => "force",
        Role::State => "state",
    }
}
