//! The document of a Do-more project.

use std::collections::HashMap;
use std::rc::Rc;

use ::domore::documentation::Documentation;
use ::domore::figures::Figures;
use ::domore::program::{CodeKind, Radix};
use ::domore::xref::{Access, CrossReference, OneSided};
use ::domore::{CodeBlock, Diagnostic, Project};

use crate::anchor::Anchor;
use crate::model::{Block, ColumnKind, Document, Note, NoteKind, Rung, Section, Table, Text};
use crate::options::{Kind, Options};
use crate::rslogix::{Pairs, diagnostics, notes};
use crate::words;

/// A Do-more project as it was read.
#[derive(Clone, Copy, Debug)]
pub struct DomoreSource<'a> {
    /// The file.
    pub source: &'a ladder::Source,
    /// The project.
    pub project: &'a Project,
    /// What deviates from the known form.
    pub diagnostics: &'a [Diagnostic],
}

/// An element and what touches it.
struct Element<'x> {
    name: String,
    accesses: Vec<&'x Access>,
}

struct Context<'a, 'x> {
    source: &'x DomoreSource<'a>,
    documentation: Rc<Documentation<'a>>,
    elements: Vec<Element<'x>>,
    xref: Option<&'x CrossReference>,
    /// Numbers of code blocks by name, as their anchors have them.
    blocks: HashMap<&'a str, usize>,
}

/// Builds the document of a Do-more project: the sections that have a meaning there.
pub fn domore_project<'a>(source: &DomoreSource<'a>, options: &Options) -> Document<'a> {
    let project = source.project;
    let built = CrossReference::build(project);
    let xref = built.as_ref().ok();
    let elements = xref.map_or_else(Vec::new, |xref| {
        let all = xref.elements().map(|name| Element { name: name.to_owned(), accesses: xref.of_element(name) });
        // A nickname for a constant, and the like.
        all.filter(|element| !element.accesses.is_empty()).collect()
    });
    let context = Context {
        source,
        documentation: Rc::new(Documentation::new(project)),
        elements,
        xref,
        blocks: project.code_blocks().enumerate().map(|(number, block)| (block.name.as_str(), number)).collect(),
    };
    let found: Vec<ladder::Diagnostic> = source.diagnostics.iter().map(Diagnostic::to_ladder).collect();
    let mut document = Document {
        title: source.source.file.clone(),
        processor: crate::words::controller(source.project),
        tool: concat!("rungs ", env!("CARGO_PKG_VERSION")).to_owned(),
        date: options.date.clone().unwrap_or_default(),
        notes: notes(&found),
        ..Document::default()
    };
    if let Err(error) = &built {
        let text = format!("No cross reference could be made: {error}");
        document.notes.push(Note::new(NoteKind::Error, text));
    }
    for kind in Kind::all().filter(|kind| options.sections.has(*kind)) {
        let blocks = match kind {
            Kind::Processor => context.controller(),
            Kind::Io => context.devices(),
            Kind::ProgramFiles => context.list(),
            Kind::DataFiles => context.memory(),
            Kind::Ladder => {
                context.code(&mut document.sections);
                continue;
            }
            Kind::Symbols => context.symbols(),
            Kind::CrossReference => context.references(),
            Kind::Undocumented => context.undocumented(),
            Kind::WrittenNeverRead => context.one_sided(OneSided::WrittenNeverRead),
            Kind::ReadNeverWritten => context.one_sided(OneSided::ReadNeverWritten),
            Kind::Coverage => context.coverage(),
            Kind::Diagnostics => diagnostics(&found),
            // The text of a project holds no values, channels, symbol groups or online image; what the
            // others ask of a program is answered for RSLogix projects only.
            Kind::Channels
            | Kind::Data
            | Kind::InstructionComments
            | Kind::SymbolGroups
            | Kind::Timers
            | Kind::Calls
            | Kind::IoMap
            | Kind::Online => continue,
        };
        let title = match kind {
            Kind::Processor => "Controller",
            Kind::Io => "Devices",
            Kind::ProgramFiles => "Code Blocks",
            Kind::DataFiles => "Memory",
            Kind::Symbols => "Element Documentation",
            kind => kind.title(),
        };
        let anchor = Anchor::named(kind.name());
        document.sections.push(Section { kind, anchor, title: title.to_owned(), short: title.to_owned(), blocks });
    }
    document.settle();
    document
}

fn name(block: &CodeBlock) -> String {
    match block.kind {
        CodeKind::Bare => "Rungs without a code block".to_owned(),
        _ => format!("{} {}", block.kind.title(), block.name),
    }
}

impl<'a> Context<'a, '_> {
    fn project(&self) -> &'a Project {
        self.source.project
    }

    fn controller(&self) -> Vec<Block<'a>> {
        let (file, project) = (self.source.source, self.project());
        let figures = Figures::of(project);
        let mut pairs = Pairs::new();
        pairs.add("Controller", if project.controller().is_empty() { "not named" } else { project.controller() });
        pairs.add("Family", "Do-more");
        pairs.add("Code Blocks", project.code_blocks().count().to_string());
        pairs.add("Rungs", figures.rungs.to_string());
        pairs.add("Instructions", figures.instructions.to_string());
        pairs.add("File", file.file.as_str());
        pairs.add("Size", format!("{} bytes", file.bytes));
        pairs.add("SHA-256", file.sha256.as_str());
        for (name, lines) in project.carried() {
            pairs.add(&format!("Section {name}"), format!("{}, carried untouched", words::count(lines, "line")));
        }
        let mut blocks = vec![pairs.block()];
        if !figures.unknown.is_empty() {
            let list: Vec<String> = figures.unknown.iter().map(|(name, count)| format!("{name} ({count})")).collect();
            let text = format!("Instructions that are not known, carried with their operands: {}.", list.join(", "));
            blocks.push(Block::Note(Note::new(NoteKind::Warning, text)));
        }
        blocks
    }

    fn devices(&self) -> Vec<Block<'a>> {
        let mut table = Table::new(&[("Device", ColumnKind::Text), ("Parameters", ColumnKind::Text)]);
        for device in self.project().devices() {
            table.row([device.name.as_str().into(), device.parameters.join(", ").into()]);
        }
        or_none(table, "The project names no devices.")
    }

    fn list(&self) -> Vec<Block<'a>> {
        let mut table = Table::new(&[
            ("Name", ColumnKind::Text),
            ("Kind", ColumnKind::Text),
            ("Rungs", ColumnKind::Number),
            ("Instructions", ColumnKind::Number),
            ("Stages", ColumnKind::Number),
        ]);
        for (number, block) in self.project().code_blocks().enumerate() {
            table.row([
                Text::link(if block.name.is_empty() { name(block) } else { block.name.clone() }, Anchor::file(number)),
                block.kind.title().into(),
                block.rungs.len().to_string().into(),
                block.instructions().to_string().into(),
                block.stages().to_string().into(),
            ]);
        }
        or_none(table, "The project has no code blocks.")
    }

    fn memory(&self) -> Vec<Block<'a>> {
        let mut table = Table::new(&[
            ("Name", ColumnKind::Text),
            ("Type", ColumnKind::Text),
            ("Count", ColumnKind::Number),
            ("Numbers", ColumnKind::Text),
            ("Further columns", ColumnKind::Text),
        ]);
        for block in self.project().memory() {
            table.row([
                block.name.as_str().into(),
                block.type_word.as_str().into(),
                block.count_text().into(),
                block.radix.map_or("", Radix::as_str).into(),
                block.extra.join(" ").into(),
            ]);
        }
        or_none(table, "The project states no memory configuration.")
    }

    fn code(&self, sections: &mut Vec<Section<'a>>) {
        for (number, block) in self.project().code_blocks().enumerate() {
            let rungs = 0..block.rungs.len();
            let drawn = rungs.map(|index| Rung::of_code_block(number, block, index, Rc::clone(&self.documentation)));
            sections.push(Section {
                kind: Kind::Ladder,
                anchor: Anchor::file(number),
                title: format!("{} --- Total Rungs in Code Block = {}", name(block), block.rungs.len()),
                short: name(block),
                blocks: drawn.map(Block::Rung).collect(),
            });
        }
    }

    fn symbols(&self) -> Vec<Block<'a>> {
        let mut table = Table::new(&[
            ("Element", ColumnKind::Fixed),
            ("Nickname", ColumnKind::Text),
            ("Description", ColumnKind::Text),
        ]);
        for entry in self.project().documentation() {
            table.row_at(
                Anchor::symbol(&entry.element),
                [
                    Text::link(entry.element.as_str(), Anchor::reference(&entry.element)),
                    entry.nickname.as_str().into(),
                    words::one_line(entry.lines()).into(),
                ],
            );
        }
        or_none(table, "The project documents no elements.")
    }

    fn rung(&self, access: &Access) -> Text {
        let shown = if access.code_block.is_empty() {
            access.rung.to_string()
        } else {
            format!("{}:{}", access.code_block, access.rung)
        };
        match self.blocks.get(access.code_block.as_str()) {
            Some(number) => Text::link(shown, Anchor::rung(number, access.rung)),
            None => shown.into(),
        }
    }

    fn documented(&self, element: &str) -> (String, String) {
        let shown = self.documentation.shown(element);
        (shown.name.into_owned(), words::one_line(shown.description))
    }

    fn references(&self) -> Vec<Block<'a>> {
        let mut table = Table::new(&[
            ("Rung", ColumnKind::Fixed),
            ("Does", ColumnKind::Text),
            ("Instruction", ColumnKind::Fixed),
            ("Operand", ColumnKind::Fixed),
            ("Through", ColumnKind::Text),
        ]);
        for element in &self.elements {
            let (nickname, description) = self.documented(&element.name);
            let name = Text::link(element.name.as_str(), Anchor::symbol(&element.name));
            table.group(Anchor::reference(&element.name), [name, nickname.into(), description.into()]);
            for access in &element.accesses {
                let (written, through) = (access.written.as_str(), access.through.as_str());
                let does = access.does();
                table.row([
                    self.rung(access),
                    does.into(),
                    access.mnemonic.as_str().into(),
                    written.into(),
                    through.into(),
                ]);
            }
        }
        let mut blocks = or_none(table, "The program names no element.");
        let Some(xref) = self.xref else { return blocks };
        if !xref.is_listable() {
            let text = "So many ranges that accesses through them are shown for single elements only.";
            blocks.push(Block::Note(Note::new(NoteKind::Warning, text)));
        }
        if !xref.unresolved().is_empty() {
            let mut table = Table::new(&[
                ("Rung", ColumnKind::Fixed),
                ("Instruction", ColumnKind::Fixed),
                ("Operand", ColumnKind::Fixed),
                ("Expected", ColumnKind::Text),
            ]);
            for it in xref.unresolved() {
                let place = format!("{}:{}", it.code_block, it.rung);
                table.row([place.as_str(), &it.mnemonic, &it.operand, &it.why].map(Text::from));
            }
            blocks.push(Block::Heading("Operands about which nothing can be said".to_owned()));
            blocks.push(Block::Table(table));
        }
        blocks
    }

    fn undocumented(&self) -> Vec<Block<'a>> {
        let without = self.elements.iter().filter(|element| {
            let (nickname, description) = self.documented(&element.name);
            nickname.is_empty() && description.is_empty()
        });
        or_none(self.elements_table(without), "Every element the program uses is documented.")
    }

    fn one_sided(&self, side: OneSided) -> Vec<Block<'a>> {
        let found = self.elements.iter().filter(|it| OneSided::of(&it.name, &it.accesses) == Some(side));
        or_none(self.elements_table(found), "None.")
    }

    fn elements_table<'e, 'y: 'e>(&self, elements: impl Iterator<Item = &'e Element<'y>>) -> Table {
        let mut table = Table::new(&[
            ("Element", ColumnKind::Fixed),
            ("Nickname", ColumnKind::Text),
            ("Description", ColumnKind::Text),
            ("Rungs", ColumnKind::Text),
        ]);
        for element in elements {
            let (nickname, description) = self.documented(&element.name);
            let mut rungs = Text::default();
            for access in &element.accesses {
                rungs.push(if rungs.is_empty() { "" } else { ", " }, None);
                rungs = rungs.and(self.rung(access));
            }
            let name = Text::link(element.name.as_str(), Anchor::reference(&element.name));
            table.row([name, nickname.into(), description.into(), rungs]);
        }
        table
    }

    fn coverage(&self) -> Vec<Block<'a>> {
        let figures = Figures::of(self.project());
        let documented = self.elements.iter().filter(|element| {
            let (nickname, description) = self.documented(&element.name);
            !(nickname.is_empty() && description.is_empty())
        });
        let mut pairs = Pairs::new();
        pairs
            .add("Elements used with a nickname or description", words::share(documented.count(), self.elements.len()));
        pairs.add("Documented elements", figures.documented.to_string());
        pairs.add("Documented elements with a nickname", words::share(figures.nicknames, figures.documented));
        pairs.add("Rungs with a comment", words::share(figures.commented, figures.rungs));
        vec![pairs.block()]
    }
}

fn or_none<'a>(table: Table, none: &str) -> Vec<Block<'a>> {
    vec![if table.rows.is_empty() { Block::Note(Note::new(NoteKind::Remark, none)) } else { Block::Table(table) }]
}
