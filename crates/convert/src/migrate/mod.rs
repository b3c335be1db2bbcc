//! From an SLC 500 or MicroLogix program to a Do-more project, with a verdict for every rung.
//!
//! [`migrate()`] is a pure function of the program, a person's allocation and [`Options`]. Every rung of
//! the original becomes one rung of the result, in the same order: contacts and coils as they are, boxes
//! as what they compute, behind each other in the same power flow. What has no counterpart stands as a
//! `NOP` with the original text as its comment and a reason; nothing is left out.
//!
//! * `allocate`, `map_file`: where data lies; `facts`: what the program does with it
//! * `operand`, `emit`: operands and rungs of the result
//! * `table`: one row per instruction, in the modules of their families
//! * `plan`, `control`: program files, subroutines, jumps, zones
//! * `frame`: what the program needs before its first rung and behind its last one
//! * `docs`, `initial`, `report`: documentation, data, what a person reads

pub mod allocate;
mod bits;
mod compare;
mod compute;
pub mod context;
mod control;
mod counters;
pub mod docs;
pub mod emit;
pub mod facts;
mod files;
pub mod forms;
mod frame;
pub mod initial;
mod interrupts;
pub mod map_file;
pub mod marks;
mod math;
mod moves;
pub mod operand;
mod plan;
mod project;
mod ranges;
pub mod report;
mod rung;
mod scale;
mod sequencer;
mod status;
mod store;
mod strings;
mod table;
mod timers;
mod value;

use ladder::Image;

use crate::slc::rung::rung_text;
use allocate::Places;
use context::{Context, Person};
use control::Flow;
use emit::{Contact, Emitter};
use facts::Facts;
pub use initial::Initial;
pub use map_file::{MapError, MapRow};
pub use marks::{Mark, Note};
use plan::{Item, Plan, Zone};

/// Settings of a migration.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Use only forms that Designer itself has written or read; what needs others is left to a person.
    pub only_confirmed: bool,
}

/// How far a rung's conversion holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Verdict {
    /// It does what the original does.
    Exact,
    /// It does so under the conditions stated.
    Condition,
    /// It stands as a `NOP`: a person has to write it.
    Person,
}

impl Verdict {
    /// `exact`, `condition`, `person`.
    pub fn as_str(self) -> &'static str {
        match self {
            Verdict::Exact => "exact",
            Verdict::Condition => "condition",
            Verdict::Person => "person",
        }
    }
}

/// What became of one rung of the original.
#[derive(Clone, Debug, PartialEq)]
pub struct RungResult {
    /// Program file.
    pub file: u16,
    /// Rung number.
    pub rung: u32,
    /// The original as rung text.
    pub original: String,
    /// Code block of the result.
    pub block: String,
    /// Rung in that block, from 0.
    pub block_rung: u32,
    /// The instructions of the result, one per line.
    pub code: Vec<String>,
    /// How far it holds.
    pub verdict: Verdict,
    /// Conditions, or the reason why it needs a person.
    pub notes: Vec<Note>,
}

/// The result.
#[derive(Clone, Debug)]
pub struct Migration {
    /// The project for Designer's import.
    pub project: domore::Project,
    /// One per rung of the original, by file and rung; END rungs are not counted.
    pub rungs: Vec<RungResult>,
    /// Where data lies.
    pub places: Places,
    /// Rows of the address map.
    pub map: Vec<MapRow>,
    /// Values of the data table that are not zero.
    pub initial: Vec<Initial>,
    /// What concerns the program as a whole.
    pub notes: Vec<Note>,
}

impl Migration {
    /// How many rungs have a verdict.
    pub fn count(&self, verdict: Verdict) -> usize {
        self.rungs.iter().filter(|rung| rung.verdict == verdict).count()
    }
}

/// Converts a program.
///
/// `map` holds a person's choices of addresses, rows of an address map that was written before; empty
/// for an allocation of its own.
///
/// # Errors
/// A row of the map that does not fit the program, or places that overlap.
pub fn migrate(image: &Image, map: &[MapRow], options: &Options) -> Result<Migration, MapError> {
    let facts = Facts::of(image);
    let mut places = Places::automatic(image, &facts, options.only_confirmed);
    let wishes = map_file::apply(image, &mut places, map)?;
    let plan = plan::plan(image);
    let mut context = Context::new(image, &facts, options, places);
    for (file, block) in &plan.subroutines {
        if let Some(block) = plan.blocks.get(*block) {
            context.subroutines.insert(*file, block.name.clone());
        }
    }
    context.timed = plan.timed.clone();
    let mut rungs = Vec::new();
    let mut blocks: Vec<domore::CodeBlock> = plan.blocks.iter().map(|block| code_block(&block.name)).collect();
    for (planned, made) in plan.blocks.iter().zip(&mut blocks) {
        for item in &planned.items {
            let new = item_rungs(&mut context, &plan, item, &planned.name, made.rungs.len(), &mut rungs);
            made.rungs.extend(new);
        }
    }
    let initial = initial::values(image, &facts, &context.places);
    finish(&mut context, &mut blocks, &initial, &mut rungs);
    rungs.sort_by_key(|rung| (rung.file, rung.rung));
    let mut notes = notes(image, &context);
    let unwritten: Vec<&str> = initial.iter().filter(|row| !row.is_written()).map(|row| row.slc.as_str()).collect();
    if !unwritten.is_empty() {
        let text = format!(
            "infinity and what is no number cannot be written as a constant: {} start with 0.0 instead",
            unwritten.join(", ")
        );
        notes.push(Note::new(Mark::Rounding, text));
    }
    let documented = docs::documented(&context, &wishes, blocks.iter().map(|block| block.name.as_str()))?;
    let map = map_file::rows(image, &context, &documented);
    let project = project::project(&context, blocks, &documented);
    Ok(Migration { project, rungs, places: context.places, map, initial, notes })
}

fn code_block(name: &str) -> domore::CodeBlock {
    let kind = if name.starts_with('$') { domore::CodeKind::Program } else { domore::CodeKind::Subroutine };
    domore::CodeBlock { kind, name: name.to_owned(), ..domore::CodeBlock::default() }
}

/// The rungs of an item; a rung of the original adds its result.
fn item_rungs(
    context: &mut Context<'_>,
    plan: &Plan,
    item: &Item,
    block: &str,
    block_rung: usize,
    rungs: &mut Vec<RungResult>,
) -> Vec<domore::Rung> {
    let frame = match item {
        Item::Enter(frame) | Item::Repeat { frame, .. } | Item::Until { frame, .. } | Item::Segment { frame, .. } => {
            plan.frames.get(*frame)
        }
        Item::Rung(place) => return vec![original_rung(context, plan, place, block, block_rung, rungs)],
    };
    let Some(frame) = frame else { return Vec::new() };
    let mut e = Emitter::new();
    let alone = |name: &str, operand: Option<String>| domore::Rung::new([domore::Instruction::new(name, operand)]);
    match item {
        Item::Rung(_) => Vec::new(),
        Item::Enter(_) => {
            let register = control::jump_register(context, frame.file);
            e.mov("0", &register);
            vec![domore::Rung::new(e.finish())]
        }
        Item::Repeat { from, .. } => {
            let over = control::loop_bit(context, frame.file, *from);
            e.set(&over);
            vec![alone("REPEAT", None), domore::Rung::new(e.finish())]
        }
        Item::Until { from, .. } => {
            let over = control::loop_bit(context, frame.file, *from);
            let until = alone("UNTIL", Some(over.clone()));
            if !frame.jumps {
                return vec![until];
            }
            let register = control::jump_register(context, frame.file);
            e.and_not(&over);
            e.mov("0", &register);
            vec![domore::Rung::new(e.finish()), until]
        }
        Item::Segment { from, block, .. } => {
            let register = control::jump_register(context, frame.file);
            e.and_compare(emit::Relation::LessOrEqual, &register, &from.to_string());
            let name = plan.blocks.get(*block).map_or("", |block| &block.name);
            control::append_call(&mut e, name);
            vec![domore::Rung::new(e.finish())]
        }
    }
}

fn original_rung(
    context: &mut Context<'_>,
    plan: &Plan,
    place: &plan::Place,
    block: &str,
    block_rung: usize,
    rungs: &mut Vec<RungResult>,
) -> domore::Rung {
    let empty = ladder::Rung::default();
    let frame = plan.frames.get(place.frame);
    let file = frame.map_or(0, |frame| frame.file);
    let image = context.image;
    let rung =
        image.program_file(file).and_then(|file| file.rungs.get(usize::try_from(place.rung).ok()?)).unwrap_or(&empty);
    let original = rung_text(rung);
    context.conditions.clear();
    context.conditional = place.conditional;
    context.left = rung.instructions().count();
    context.jumped = None;
    context.conditions.extend(place.condition.clone());
    context.flow = frame.map(|frame| Flow {
        file,
        labels: frame.labels.clone(),
        end: frame.end,
        jumps: frame.jumps,
        loops: frame.loops.clone(),
        rung: place.rung,
        zone: place.zone,
        in_place: place.in_place,
    });
    let converted = match &place.problem {
        Some(problem) => Err(Person(problem.clone())),
        None => convert(context, file, place.zone, rung),
    };
    let (verdict, notes, instructions) = match converted {
        Ok(instructions) if context.conditions.is_empty() => (Verdict::Exact, Vec::new(), instructions),
        Ok(instructions) => {
            (Verdict::Condition, std::mem::take(&mut context.conditions).into_iter().collect(), instructions)
        }
        Err(Person(note)) => (Verdict::Person, vec![note], Emitter::new().finish()),
    };
    let mut reasons: Vec<String> = notes.iter().map(|note| format!("{}: {note}", verdict.as_str())).collect();
    if let Some(file) = place.in_place {
        reasons.push(format!("the rungs of file {file} follow here"));
    }
    let code = instructions.iter().map(ToString::to_string).collect();
    let lines = docs::rung_comment(file, place.rung, rung, &original, &reasons);
    rungs.push(RungResult {
        file,
        rung: place.rung,
        original,
        block: block.to_owned(),
        block_rung: u32::try_from(block_rung).unwrap_or(u32::MAX),
        code,
        verdict,
        notes,
    });
    domore::Rung { comment: Some(domore::Comment::plain(lines)), instructions }
}

fn convert(
    context: &mut Context<'_>,
    file: u16,
    zone: Zone,
    rung: &ladder::Rung,
) -> context::Converted<Vec<domore::Instruction>> {
    let mut e = Emitter::new();
    if matches!(zone, Zone::Inside | Zone::Turns) {
        let bit = control::zone_bit(context, file);
        e.contact(&Contact::On(bit));
    }
    rung::series(context, &mut e, &rung.series)?;
    let code = e.finish();
    if let Some(levels) = forms::too_deep(&code) {
        let text = format!("an expression of {levels} levels of parentheses: MATH takes 8");
        return Err(Person::new(Mark::NoCounterpart, text));
    }
    if context.options.only_confirmed
        && let Some(form) = forms::in_expressions(&code)
    {
        return Err(Person::new(Mark::NoCounterpart, format!("{form}: its text form is not confirmed by Designer")));
    }
    Ok(code)
}

/// Adds what stands around the program, and the ends of subroutines.
fn finish(
    context: &mut Context<'_>,
    blocks: &mut Vec<domore::CodeBlock>,
    initial: &[Initial],
    rungs: &mut [RungResult],
) {
    let after = frame::after(context);
    let before = frame::before(context, !initial.is_empty());
    let shift = u32::try_from(before.len()).unwrap_or(u32::MAX);
    for rung in rungs.iter_mut().filter(|rung| rung.block == "$Main") {
        rung.block_rung = rung.block_rung.saturating_add(shift);
    }
    if let Some(main) = blocks.first_mut() {
        main.rungs.splice(0..0, before);
        main.rungs.extend(after);
    }
    if !initial.is_empty() {
        let done = frame::initialized(context);
        let mut block = code_block(initial::INIT_BLOCK);
        block.rungs = initial::rungs(initial, &done);
        blocks.push(block);
    }
    for block in blocks.iter_mut().filter(|block| block.kind == domore::CodeKind::Subroutine) {
        block.rungs.push(domore::Rung::new([domore::Instruction::new("RET", [""; 0])]));
    }
}

/// What a person has to know about the program as a whole.
fn notes(image: &Image, context: &Context<'_>) -> Vec<Note> {
    let mut notes = Vec::new();
    let forced = image.data_files.iter().any(|file| file.forces.iter().any(|force| *force != ladder::Force::NONE));
    if forced {
        notes.push(Note::new(Mark::AsyncIo, "the project holds forces: they are not carried over"));
    }
    if context.needs.minor_errors {
        let here = match context.options.only_confirmed {
            true => "the last rung sets slcFault and keeps the outputs off; the program goes on",
            false => "the last rung does the same with HALT; restart by PROGRAM and RUN",
        };
        let text = "overflow (S:5/0) and control register errors (S:5/2) stop the original at the end of the scan";
        notes.push(Note::new(Mark::Fault, format!("{text}: {here}")));
    }
    if !context.needs.apart.is_empty() {
        let timers: Vec<&str> = context.needs.apart.iter().map(String::as_str).collect();
        let text = "not executed in every scan: the time between two executions counts, up to 11.5 days; what the original \
                    counts there is documented up to 2.5 s";
        notes.push(Note::new(Mark::TimerBase, format!("{} {text}", timers.join(", "))));
    }
    if context.reads_rtc || context.status_words.iter().any(|word| *word > 35) {
        let text = "the program reads the clock: set the Do-more clock to the time of the original's";
        notes.push(Note::new(Mark::Clock, text));
    }
    if image.program_file(2).is_none() {
        notes.push(Note::new(Mark::Fault, "there is no program file 2: the original does not run"));
    }
    notes
}
