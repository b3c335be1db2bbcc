//! An RSLogix 500 project as pages show it.

use std::collections::BTreeMap;

use analysis::search::{About, Query, search};
use analysis::{CrossReference, TimerReport};
use instr::{Drawing, Kind};
use ladder::{Address, DataFile, FileType, Image, Instruction, Operand, ProgramFile, Project, Rung, Target};
use render::scene::Scene;
use render::{Live, Style, figure};

use super::{
    DataFileView, DataView, ElementView, FlagView, HitView, HitsView, InstructionView, LISTED, Outline, PointView,
    Program, RoutineView, RungView, TimerView, UseView, UsesView, ValueView, places,
};

/// The main image of a project, with what is known about it.
pub struct SlcProgram {
    image: &'static Image,
    xref: CrossReference<'static>,
    outline: Outline,
}

impl SlcProgram {
    /// Prepares a project to be served, which keeps it for the rest of the process: a server serves one program
    /// until it ends. `notes` are what a person must know besides what reading the project said.
    pub fn new(file_name: String, project: Project, notes: Vec<String>) -> SlcProgram {
        let project: &'static Project = Box::leak(Box::new(project));
        let image = &project.main;
        let xref = CrossReference::build(image, &image.documentation);
        let read = project.diagnostics.iter().map(|diagnostic| format!("{}: {}", diagnostic.place, diagnostic.message));
        let timers = TimerReport::build(image, &xref);
        let outline = Outline {
            file: file_name,
            dialect: "slc",
            controller: controller(image),
            properties: properties(project),
            routines: image.ladder_files().map(routine).collect(),
            data_files: files(image).map(data_file).collect(),
            points: points(image, &xref),
            timers: timers.elements.iter().filter(|timer| !timer.instructions.is_empty()).map(timer).collect(),
            notes: read.chain(notes).collect(),
        };
        SlcProgram { image, xref, outline }
    }

    fn views(&self, rung: &Rung) -> Vec<InstructionView> {
        rung.instructions().map(|it| instruction(self.image, it)).collect()
    }

    /// A rung with places for the values of its instructions. What RSLogix displayed when the project was saved is left
    /// out: beside values of now it would be taken for one.
    fn scene(&self, file: &ProgramFile, index: usize, views: &[InstructionView], width: usize) -> Scene {
        let live = Live { value: &|number, operand| places(views, number, operand) };
        let style = Style { values: false, ..Style::graphic(width) };
        render::live_scene(self.image, file, index, &self.image.documentation, &style, &live)
    }

    fn documented(&self, address: &Address) -> (String, String) {
        let shown = self.image.documentation.shown(&Target::from(address), "");
        (shown.symbol.unwrap_or_default(), shown.description.join("\n"))
    }
}

fn controller(image: &Image) -> String {
    let catalog = image.processor.catalog.as_deref().unwrap_or_default();
    format!("{catalog} {}", image.processor.name.as_deref().unwrap_or_default()).trim().to_owned()
}

/// What the vendor shows as controller properties and I/O configuration.
fn properties(project: &Project) -> Vec<(&'static str, String)> {
    let Image { processor, memory, io, .. } = &project.main;
    let id = processor.program_id.map(|id| format!("{id:04X}"));
    let memory = memory.filter(|_| !project.main.is_edited());
    let words = memory.map(|memory| {
        let (used, left) = (memory.instruction_words_used, memory.instruction_words_left);
        format!("{used} instruction words used, {left} left")
    });
    let slot = |slot: &ladder::Slot| {
        let catalog = slot.module.catalog.as_deref().unwrap_or("unknown module");
        ("I/O slot", format!("{}: {catalog} {}", slot.number, slot.module.description).trim().to_owned())
    };
    let saved = [project.source.application.as_str(), project.source.saved_by.as_str()].join(" ");
    let named = [
        ("Processor type", controller(&project.main)),
        ("Processor name", processor.project_name.trim().to_owned()),
        ("Program ID", id.unwrap_or_default()),
        ("Program memory", words.unwrap_or_default()),
        ("Saved by", saved.trim().to_owned()),
    ];
    let known = named.into_iter().filter(|(_, value)| !value.is_empty());
    let unknown = io.unknown.iter().map(|why| ("I/O configuration", why.clone()));
    known.chain(io.slots.iter().map(slot)).chain(unknown).collect()
}

fn files(image: &Image) -> impl Iterator<Item = &DataFile> {
    image.data_files.iter().chain(&image.function_files).filter(|file| file.file_type != FileType::Unused)
}

fn routine(file: &ladder::ProgramFile) -> RoutineView {
    RoutineView {
        number: file.number,
        title: format!("LAD {} - {}", file.number, file.name.trim()),
        description: file.description.trim().to_owned(),
        rungs: file.rungs.len(),
    }
}

fn data_file(file: &DataFile) -> DataFileView {
    let title = format!("{} {}", file.name.trim(), file.description.trim()).trim().to_owned();
    DataFileView { label: file.label(), title, elements: elements(file) }
}

/// Rows of a data file: elements, or words of I and O.
fn elements(file: &DataFile) -> usize {
    match file.file_type.has_slots() {
        true => file.words.len(),
        false => usize::from(file.elements),
    }
}

/// Input and output points the program names, each once.
fn points(image: &Image, xref: &CrossReference<'_>) -> Vec<PointView> {
    let mut points = BTreeMap::new();
    for address in xref.named() {
        let address = Address { indexed: false, ..address.clone() };
        if address.file_type.has_slots() && address.is_direct() {
            let shown = image.documentation.shown(&Target::from(&address), "");
            let point = PointView {
                symbol: shown.symbol.unwrap_or_default(),
                description: shown.description.join("\n"),
                input: address.file_type == FileType::I,
                analog: address.bit.is_none(),
                address: address.to_string(),
            };
            points.insert((address.file_type != FileType::I, key(&address)), point);
        }
    }
    points.into_values().collect()
}

/// Slot, word and bit, to sort by.
fn key(address: &Address) -> (u16, u16, u16) {
    let number = |place: &ladder::Place| match place {
        ladder::Place::Number(number) => *number,
        _ => u16::MAX,
    };
    (number(&address.element), address.word.unwrap_or(0), address.bit.as_ref().map_or(0, number))
}

fn timer(timer: &analysis::TimerCounter) -> TimerView {
    let address = timer.address.to_string();
    TimerView {
        kind: timer.mnemonics().join(" "),
        symbol: timer.symbol.clone().unwrap_or_default(),
        description: timer.description.join("\n"),
        preset: Some(format!("{address}.PRE")),
        accumulated: format!("{address}.ACC"),
        done: format!("{address}/DN"),
        base: timer.base.map(|base| f64::from(base.milliseconds()) / 1000.0),
        address,
    }
}

impl Program for SlcProgram {
    fn file_name(&self) -> &str {
        &self.outline.file
    }

    fn scenario_family(&self) -> Option<String> {
        None
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn rung(&self, routine: u16, index: usize, width: usize) -> Option<RungView> {
        let file = self.image.ladder_files().find(|file| file.number == routine)?;
        let views = self.views(file.rungs.get(index)?);
        let scene = self.scene(file, index, &views, width);
        Some(RungView::new(index, scene, views))
    }

    fn heights(&self, routine: u16, width: usize) -> Vec<usize> {
        let Some(file) = self.image.ladder_files().find(|file| file.number == routine) else { return Vec::new() };
        let height = |(index, rung)| self.scene(file, index, &self.views(rung), width).height * figure::CELL_HEIGHT;
        file.rungs.iter().enumerate().map(height).collect()
    }

    fn data(&self, label: &str, from: usize, count: usize) -> Option<DataView> {
        let file = files(self.image).find(|file| file.label().eq_ignore_ascii_case(label))?;
        let last = elements(file).min(from.saturating_add(count));
        let element = |index: usize| {
            let address = match file.file_type.has_slots() {
                true => self.image.io.address_of(file.file_type, u16::try_from(index).ok()?)?,
                false => Address::element(file.file_type, file.number, u16::try_from(index).ok()?),
            };
            let (symbol, description) = self.documented(&address);
            Some(ElementView { address: address.to_string(), symbol, description })
        };
        let columns: &[&str] = match file.file_type {
            FileType::T => &["/EN", "/TT", "/DN", ".PRE", ".ACC"],
            FileType::C => &["/CU", "/CD", "/DN", "/OV", "/UN", "/UA", ".PRE", ".ACC"],
            FileType::R => &["/EN", "/EU", "/DN", "/EM", "/ER", "/UL", "/IN", "/FD", ".LEN", ".POS"],
            _ => &[""],
        };
        Some(DataView {
            label: file.label(),
            columns: columns.iter().map(|column| (*column).to_owned()).collect(),
            radix: match file.file_type {
                FileType::B | FileType::I | FileType::O | FileType::S => "binary",
                _ => "decimal",
            },
            elements: (from..last).filter_map(element).collect(),
        })
    }

    fn uses(&self, text: &str) -> Result<UsesView, String> {
        let symbol = || self.image.documentation.by_symbol(text)?.target.direct_address().cloned();
        let address = Address::parse(text).ok().or_else(symbol);
        let address = address.ok_or_else(|| format!("`{text}` is no address or symbol of this program"))?;
        let (symbol, description) = self.documented(&address);
        let all = self.xref.of(&address);
        let uses = all.iter().take(LISTED).map(|access| UseView {
            routine: access.location.file,
            rung: access.location.rung as usize,
            instruction: Some(access.location.instruction as usize),
            text: format!("{} {}", access.mnemonic, access.address),
            access: access.role.as_str().to_owned(),
        });
        Ok(UsesView {
            address: address.to_string(),
            symbol,
            description,
            uses: uses.collect(),
            left_out: all.len().saturating_sub(LISTED),
        })
    }

    fn search(&self, text: &str) -> Result<HitsView, String> {
        let found = search(self.image, &self.image.documentation, &Query::new(text));
        let ladder = |number: &u16| self.outline.routines.iter().any(|routine| routine.number == *number);
        let label = |number: u16| files(self.image).find(|file| file.number == number).map(DataFile::label);
        let hits = found.list.iter().take(LISTED).map(|hit| {
            let (mut routine, mut address, mut data) = (hit.location.map(|location| location.file), None, None);
            match &hit.about {
                Some(About::ProgramFile(number)) => routine = Some(*number).filter(ladder),
                Some(About::Address(about)) => address = Some(about.clone()),
                Some(About::DataFile(number)) => data = label(*number),
                None => {}
            }
            let rung = hit.location.map(|location| location.rung as usize);
            HitView { routine, rung, kind: hit.kind.to_owned(), text: hit.text.clone(), address, data }
        });
        let left_out = found.list.len().saturating_sub(LISTED) + found.not_listed;
        Ok(HitsView { named: None, hits: hits.collect(), left_out })
    }
}

/// An instruction with what a page shows of it.
fn instruction(image: &Image, instruction: &Instruction) -> InstructionView {
    let direct = |operand: &Operand| operand.address().filter(|address| address.is_direct()).cloned();
    let known = instruction.mnemonic.name().and_then(instr::by_mnemonic);
    let form = known.and_then(|known| known.form_for(image.family(), instruction.operands.len()));
    let mut values = Vec::new();
    let mut element: Option<Address> = None;
    for (index, operand) in instruction.operands.iter().enumerate() {
        let kind = form.and_then(|form| form.operands.get(index)).map(|operand| operand.kind);
        let member = match kind {
            Some(Kind::Preset) => Some("PRE"),
            Some(Kind::Accum) => Some("ACC"),
            Some(Kind::Length) => Some("LEN"),
            Some(Kind::Position) => Some("POS"),
            _ => None,
        };
        if matches!(kind, Some(Kind::Timer | Kind::Counter | Kind::Control)) {
            element = direct(operand).filter(|address| address.word.is_none());
            // A whole element has no value of its own.
            continue;
        }
        match (member, &element, direct(operand)) {
            (Some(member), Some(element), _) => {
                values.push(ValueView { address: format!("{element}.{member}"), operand: index, instead: true });
            }
            (_, _, Some(address)) if address.bit.is_none() => {
                let address = Address { indexed: false, ..address }.to_string();
                values.push(ValueView { address, operand: index, instead: false });
            }
            // Brackets are followed by the machine; what an index leads to depends on S:24 at that moment.
            (_, _, None) => {
                let address = operand.address().filter(|address| !address.indexed && address.bit.is_none());
                values.extend(address.map(|address| ValueView {
                    address: address.to_string(),
                    operand: index,
                    instead: false,
                }));
            }
            _ => {}
        }
    }
    let drawn = match form.map(|form| form.drawing) {
        Some(Drawing::Box { flags }) => flags,
        _ => &[],
    };
    let flag = |name: &&'static str| FlagView { name, address: element.as_ref().map(|it| format!("{it}/{name}")) };
    let flags = drawn.iter().map(flag).collect();
    let sign = form.is_some_and(|form| !matches!(form.drawing, Drawing::Box { .. }));
    let bit = instruction.operands.first().and_then(direct).filter(|address| sign && address.bit.is_some());
    InstructionView {
        mnemonic: instruction.mnemonic.to_string(),
        operands: instruction.operands.iter().map(ToString::to_string).collect(),
        values,
        flags,
        contact: bit.is_some() && form.is_some_and(|form| matches!(form.drawing, Drawing::Contact { .. })),
        forcible: bit.as_ref().is_some_and(|address| address.file_type.has_slots()),
        bit: bit.map(|address| address.to_string()),
    }
}
