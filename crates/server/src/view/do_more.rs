//! A Do-more project as pages show it.

use std::collections::BTreeMap;

use analysis::search::{About, Query, search_domore};
use domore::documentation::Documentation;
use domore::instruction::{self, Effect, Kind};
use domore::memory::{ElementType, Map};
use domore::xref::CrossReference;
use domore::{CodeBlock, Instruction, Project, Rung};
use render::scene::Scene;
use render::{Live, Style, figure};

use super::{
    DataFileView, DataView, ElementView, HitView, HitsView, InstructionView, LISTED, Outline, PointView, Program,
    RoutineView, RungView, TimerView, UseView, UsesView, ValueView, places,
};

/// A Do-more project, with what is known about it.
pub struct DoMoreProgram {
    project: &'static Project,
    documentation: Documentation<'static>,
    map: Map,
    xref: CrossReference,
    outline: Outline,
}

impl DoMoreProgram {
    /// Prepares a project to be served, which keeps it for the rest of the process: a server serves one program
    /// until it ends. `notes` are what a person must know.
    ///
    /// # Errors
    /// The project declares more memory than any controller has.
    pub fn new(file_name: String, project: Project, notes: Vec<String>) -> Result<DoMoreProgram, String> {
        let project: &'static Project = Box::leak(Box::new(project));
        let map = Map::new(project).map_err(|error| error.to_string())?;
        let xref = CrossReference::build(project).map_err(|error| error.to_string())?;
        let documentation = Documentation::new(project);
        let routine = |(number, block): (u16, &CodeBlock)| RoutineView {
            number,
            title: format!("{} {}", block.kind.title(), block.name).trim().to_owned(),
            description: String::new(),
            rungs: block.rungs.len(),
        };
        let data_file = |block: &domore::memory::Block| DataFileView {
            label: block.name.clone(),
            title: String::new(),
            elements: block.count as usize,
        };
        let outline = Outline {
            file: file_name,
            dialect: "do-more",
            controller: project.controller().to_owned(),
            properties: vec![
                ("Controller", project.controller().to_owned()),
                ("Code-blocks", project.code_blocks().count().to_string()),
            ],
            routines: (0..).zip(project.code_blocks()).map(routine).collect(),
            data_files: map.blocks().iter().map(data_file).collect(),
            points: points(&xref, &documentation),
            timers: timers(project, &documentation),
            notes,
        };
        Ok(DoMoreProgram { project, documentation, map, xref, outline })
    }

    fn block(&self, routine: u16) -> Option<&'static CodeBlock> {
        self.project.code_blocks().nth(routine.into())
    }

    /// A rung with places for the values of its instructions.
    fn scene(&self, block: &CodeBlock, index: usize, views: &[InstructionView], style: &Style) -> Scene {
        let live = Live { value: &|number, operand| places(views, number, operand) };
        render::domore::live_scene(block, index, &self.documentation, style, &live)
    }

    fn documented(&self, element: &str) -> (String, String) {
        let shown = self.documentation.shown(element);
        (shown.name.into_owned(), shown.description.join("\n"))
    }
}

/// Input and output points the program names, each once.
fn points(xref: &CrossReference, documentation: &Documentation<'_>) -> Vec<PointView> {
    let mut points = BTreeMap::new();
    for element in xref.elements() {
        let block = element.trim_end_matches(|c: char| c.is_ascii_digit());
        let (input, analog) = match block {
            "X" => (true, false),
            "Y" => (false, false),
            "WX" => (true, true),
            "WY" => (false, true),
            _ => continue,
        };
        let number: u32 = element.trim_start_matches(block).parse().unwrap_or(u32::MAX);
        let shown = documentation.shown(element);
        let point = PointView {
            address: element.to_owned(),
            symbol: shown.name.into_owned(),
            description: shown.description.join("\n"),
            input,
            analog,
        };
        points.insert((!input, analog, number), point);
    }
    points.into_values().collect()
}

/// Timers and counters by the instructions that run them.
fn timers(project: &Project, documentation: &Documentation<'_>) -> Vec<TimerView> {
    let mut timers: BTreeMap<&str, TimerView> = BTreeMap::new();
    for instruction in project.code_blocks().flat_map(|block| &block.rungs).flat_map(|rung| &rung.instructions) {
        let kind = instruction::by_mnemonic(&instruction.mnemonic).and_then(|entry| entry.operands.first());
        let timer = match kind.map(|operand| operand.kind) {
            Some(Kind::Timer) => true,
            Some(Kind::Counter) => false,
            _ => continue,
        };
        let element = instruction.operand(0);
        let entry = timers.entry(element).or_insert_with(|| TimerView {
            address: element.to_owned(),
            kind: String::new(),
            symbol: documentation.shown(element).name.into_owned(),
            description: documentation.shown(element).description.join("\n"),
            preset: None,
            accumulated: format!("{element}.Acc"),
            done: format!("{element}.Done"),
            base: timer.then_some(0.001),
        });
        if !entry.kind.split(' ').any(|kind| kind == instruction.mnemonic) {
            entry.kind = format!("{} {}", entry.kind, instruction.mnemonic).trim().to_owned();
        }
        let preset = instruction.operand(1);
        if preset.starts_with(|c: char| c.is_ascii_alphabetic()) {
            entry.preset.get_or_insert_with(|| preset.to_owned());
        }
    }
    timers.into_values().collect()
}

/// Members of the elements of a structured block.
fn columns(element: ElementType) -> Vec<String> {
    let members: &[&str] = match element {
        ElementType::Timer => &[".Acc", ".Done", ".Timing", ".Zero", ".Reset"],
        ElementType::Counter => &[".Acc", ".Done", ".DnDone", ".Zero", ".Reset"],
        _ => &[""],
    };
    members.iter().map(|member| (*member).to_owned()).collect()
}

fn views(rung: &Rung) -> Vec<InstructionView> {
    rung.instructions.iter().map(instruction).collect()
}

fn instruction(instruction: &Instruction) -> InstructionView {
    let entry = instruction::by_mnemonic(&instruction.mnemonic);
    let named = |operand: &str| operand.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
    let mut values = Vec::new();
    let mut bit = None;
    for (index, operand) in instruction.operands.iter().enumerate().filter(|(_, operand)| named(operand)) {
        let value = |address: String| ValueView { address, operand: index, instead: false };
        match entry.and_then(|entry| entry.operand(index)).map(|operand| operand.kind) {
            Some(Kind::Bit) if index == 0 => bit = Some(operand.clone()),
            Some(Kind::Timer | Kind::Counter) => values.push(value(format!("{operand}.Acc"))),
            Some(Kind::Number | Kind::Value) => values.push(value(operand.clone())),
            _ => {}
        }
    }
    InstructionView {
        mnemonic: instruction.mnemonic.clone(),
        operands: instruction.operands.clone(),
        values,
        flags: Vec::new(),
        contact: entry.is_some_and(|entry| matches!(entry.effect, Effect::Contact { .. })) && bit.is_some(),
        forcible: bit.as_ref().is_some_and(|bit| bit.starts_with(['X', 'Y'])),
        bit,
    }
}

impl Program for DoMoreProgram {
    fn file_name(&self) -> &str {
        &self.outline.file
    }

    fn scenario_family(&self) -> Option<String> {
        Some("do-more".to_owned())
    }

    fn outline(&self) -> &Outline {
        &self.outline
    }

    fn rung(&self, routine: u16, index: usize, width: usize) -> Option<RungView> {
        let block = self.block(routine)?;
        let views = views(block.rungs.get(index)?);
        let scene = self.scene(block, index, &views, &Style::graphic(width));
        Some(RungView::new(index, scene, views))
    }

    fn heights(&self, routine: u16, width: usize) -> Vec<usize> {
        let Some(block) = self.block(routine) else { return Vec::new() };
        let style = Style::graphic(width);
        let height = |(index, rung)| self.scene(block, index, &views(rung), &style).height * figure::CELL_HEIGHT;
        block.rungs.iter().enumerate().map(height).collect()
    }

    fn data(&self, label: &str, from: usize, count: usize) -> Option<DataView> {
        let block = self.map.block(label)?;
        let last = (block.count as usize).min(from.saturating_add(count));
        let element = |index: usize| {
            let address = block.element_name(u32::try_from(index).unwrap_or(u32::MAX));
            let (symbol, description) = self.documented(&address);
            ElementView { address, symbol, description }
        };
        Some(DataView {
            label: block.name.clone(),
            columns: columns(block.element),
            radix: "decimal",
            elements: (from..last).map(element).collect(),
        })
    }

    fn uses(&self, text: &str) -> Result<UsesView, String> {
        let area = self.xref.area(text);
        let area = area.ok_or_else(|| format!("`{text}` is no element or nickname of this program"))?;
        let all = self.xref.touching(&area);
        let (symbol, description) = self.documented(text);
        let uses = all.iter().take(LISTED).filter_map(|access| {
            let routine = self.project.code_blocks().position(|block| block.name == access.code_block)?;
            Some(UseView {
                routine: u16::try_from(routine).ok()?,
                rung: access.rung.saturating_sub(1),
                instruction: None,
                text: format!("{} {}", access.mnemonic, access.written),
                access: access.does(),
            })
        });
        Ok(UsesView {
            address: text.to_owned(),
            symbol,
            description,
            uses: uses.collect(),
            left_out: all.len().saturating_sub(LISTED),
        })
    }

    fn search(&self, text: &str) -> Result<HitsView, String> {
        let found = search_domore(self.project, &Query::new(text));
        let hits = found.list.iter().take(LISTED).map(|hit| {
            let (mut block, mut address) = (hit.location.map(|location| location.file), None);
            match &hit.about {
                Some(About::ProgramFile(place)) => block = Some(*place),
                Some(About::Address(about)) => address = Some(about.clone()),
                Some(About::DataFile(_)) | None => {}
            }
            HitView {
                // Code blocks count from 1 there.
                routine: block.map(|block| block.saturating_sub(1)),
                rung: hit.location.map(|location| location.rung as usize),
                kind: hit.kind.to_owned(),
                text: hit.text.clone(),
                address,
                data: None,
            }
        });
        let left_out = found.list.len().saturating_sub(LISTED) + found.not_listed;
        Ok(HitsView { named: None, hits: hits.collect(), left_out })
    }
}
