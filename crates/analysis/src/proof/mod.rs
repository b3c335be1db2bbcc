//! Equivalence runs: two programs side by side, scan by scan, with the same inputs and the same time.
//!
//! [`prove_slc`] compares two SLC programs, [`prove_domore`] an SLC program with the Do-more program made of it.
//! Inputs are random, from a seed, and directed: edges of every input, values around every comparison,
//! waits past every preset, leaving and entering run. What the run has not seen yet of the original (each
//! contact both ways, each output with and without power, each timer done, each comparison at its boundary)
//! decides where it goes next. After every scan all data that the map places on both sides must be equal.
//!
//! A run that finds nothing proves nothing beyond what it covered, and says what that was. What is not
//! mapped, not converted or never reached is listed and never counts as equal.

mod ages;
mod campaign;
mod check;
mod fates;
mod goals;
mod inputs;
mod minimize;
mod pairing;
mod pairs;
mod play;
mod progress;
mod random;
mod report;
mod scenario;
mod side;
mod solve;
mod stretches;
mod taint;
mod tape;
mod unreachable;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use ladder::{Address, FileType, Image, Operand};

use crate::{CallGraph, CrossReference, EntryKind};
use campaign::Campaign;
use goals::Goals;
use inputs::Inputs;
use minimize::Player;
use pairs::Pairs;
use play::Both;
use scenario::Preset;
use solve::Solver;
use unreachable::Surroundings;

pub use check::{Refused, refused_domore, refused_slc};
pub use fates::{Origin, fates, origins};
pub use goals::{Goal, GoalKind};
pub use pairing::{AnySide, AnySideMut, Pairing, Row};
pub use pairs::{Mapping, Mismatch};
pub use play::Difference;
pub use progress::Progress;
pub use report::{Coverage, Driven, NOT_MODELLED, Report, RungCoverage, Scope, Verdict};
pub use scenario::{Counterexample, Named};
pub use side::{DoMore, Kind, Side, Slc};

/// Settings of a proof run.
#[derive(Clone, Debug)]
pub struct Options {
    /// Scans of both sides.
    pub scans: u64,
    /// Where the random sequence starts. The same seed gives the same run on any machine.
    pub seed: u64,
    /// Compare a converted program although its text does not say which rung was made from which. The report
    /// then says with its verdict that the identity of the rungs was not checked.
    pub without_marks: bool,
    /// Look for the shortest way to a difference that was found.
    pub minimize: bool,
    /// How scenarios name the original.
    pub original: Named,
    /// How scenarios name the other program.
    pub other: Named,
    /// Readings where documentation of SLC 500 and MicroLogix ends.
    pub choices: sim::Choices,
    /// Readings where documentation of Do-more ends.
    pub domore_choices: domore::choices::Choices,
    /// Where the run says how far it is, and hears that it shall end.
    pub progress: Option<Arc<Progress>>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            scans: 100_000,
            seed: 1,
            without_marks: false,
            minimize: true,
            original: Named::default(),
            other: Named { family: Some("do-more".to_owned()), ..Named::default() },
            choices: sim::Choices::default(),
            domore_choices: domore::choices::Choices::default(),
            progress: None,
        }
    }
}

/// What became of a rung of the original.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RungFate {
    /// Program file.
    pub file: u16,
    /// Rung, from 0.
    pub rung: u32,
    /// It was left to a person, for this reason; the other program does nothing in its place.
    pub person: Option<String>,
    /// It behaves the same under these conditions only.
    pub conditions: Vec<String>,
}

/// Compares two versions of an SLC 500 or MicroLogix program; without a map every address means itself.
pub fn prove_slc(original: &Image, other: &Image, map: Option<&[Mapping]>, options: &Options) -> Report {
    let sides = (slc(original, "original", options), slc(other, "other program", options));
    let (a, b) = match sides {
        (Ok(a), Ok(b)) => (a, b),
        (a, b) => return Report::impossible(a.err().into_iter().chain(b.err()).flatten().collect(), options),
    };
    let identity;
    let map = match map {
        Some(map) => map,
        None => {
            identity = Mapping::identity(original);
            &identity
        }
    };
    let approximations = approximations(b.0.iter().map(ToString::to_string));
    prove(original, a, b.1, approximations, map, None, options)
}

/// Compares an SLC 500 or MicroLogix program with a Do-more program. `fates` is what the migration says of
/// each rung of the original (see [`fates()`] for one that is read from its text); without it a rung that went
/// missing can be seen in behaviour only, and the programs are not comparable unless
/// [`Options::without_marks`] asks for that.
pub fn prove_domore(
    original: &Image,
    other: &domore::Project,
    map: &[Mapping],
    fates: Option<&[RungFate]>,
    options: &Options,
) -> Report {
    let settings = domore::engine::Options { choices: options.domore_choices, ..Default::default() };
    let program = domore::engine::Program::compile(other, &settings);
    let program = program.map_err(|refusals| {
        refusals.iter().map(|refusal| format!("the other program cannot be run: {refusal}")).collect::<Vec<_>>()
    });
    let inside = Options { choices: choices_of_converted(options.choices), ..options.clone() };
    let (a, program) = match (slc(original, "original", &inside), program) {
        (Ok(a), Ok(program)) => (a, program),
        (a, b) => return Report::impossible(a.err().into_iter().chain(b.err()).flatten().collect(), options),
    };
    let approximations = approximations(program.approximations().iter().map(ToString::to_string));
    let mut report = prove(original, a, DoMore::new(program), approximations, map, fates, options);
    let persons = fates.unwrap_or_default().iter().filter(|fate| fate.person.is_some());
    let persons = persons.map(|fate| (fate.file, fate.rung)).collect();
    let emptied = fates::emptied(original, other, &persons);
    let empty = |(file, rung)| format!("{file}:{rung}: nothing that acts stands under its mark");
    report.missing_rungs.extend(emptied.into_iter().map(empty));
    if fates.is_none() {
        let why = "which rung came from which is not known: a missing rung shows in behaviour only";
        if options.without_marks {
            report.identity_unchecked = true;
            report.notes.push(why.to_owned());
        } else {
            let why = format!("the text of the other program carries no rung marks (`SLC 2:0  ...`): {why}");
            report.incomparable.push(why);
        }
    }
    report
}

/// Readings of the original in a comparison with a converted program. What lies behind a file is another file there
/// and here: an index beyond its file is outside the conditions a conversion states, and has to stop the original so
/// that it is noticed.
pub fn choices_of_converted(choices: sim::Choices) -> sim::Choices {
    choices.with(sim::Choice::IndirectStaysInFile)
}

type Compiled = (Vec<sim::Approximation>, Slc);

fn slc(image: &Image, which: &str, options: &Options) -> Result<Compiled, Vec<String>> {
    let settings = sim::Options { choices: options.choices, ..sim::Options::default() };
    let program = sim::Program::compile(image, &settings).map_err(|refusals| {
        refusals.iter().map(|refusal| format!("the {which} cannot be run: {refusal}")).collect::<Vec<_>>()
    })?;
    let approximations = program.approximations().to_vec();
    Ok((approximations, Slc { machine: sim::Machine::new(program) }))
}

/// Each once.
fn approximations(all: impl Iterator<Item = String>) -> Vec<String> {
    let mut seen = BTreeSet::new();
    all.filter(|text| seen.insert(text.clone())).collect()
}

fn prove<B: Side>(
    image: &Image,
    (own, a): Compiled,
    b: B,
    others: Vec<String>,
    map: &[Mapping],
    fates: Option<&[RungFate]>,
    options: &Options,
) -> Report {
    let xref = CrossReference::build(image, &image.documentation);
    let mut report = Report::empty(options);
    report.approximations = [approximations(own.iter().map(ToString::to_string)), others];
    if image.data_files.iter().any(|file| file.has_forces()) {
        report.notes.push("the original holds forces: they were left out".to_owned());
    }
    let pairs = pairs(image, &xref, (&a, &b), map, fates, &mut report);
    let inputs = Inputs::new(image, &xref, &a, &b, &pairs);
    report.take_map(&pairs, &inputs.left_out);
    if pairs.compared() == 0 {
        report.incomparable.push("no data of the two programs can be compared".to_owned());
        return report;
    }
    let mut both = Both { a, b };
    both.a.machine.enable_forces(false);
    let presets = start(&mut both, &inputs, &pairs);
    let goals = Goals::new(image, &xref, &both.a);
    let solver = Solver::new(image, &both.a, inputs.all.iter().map(|input| (input.at, input.kind)));
    let base = Both { a: both.a.fork(), b: both.b.fork() };
    let short = has_timed_interrupt(image);
    if short {
        let why = "a timed interrupt runs in the original: it came at most once between two scans";
        report.notes.push(why.to_owned());
    }
    let steady = has_steady_period(image, &xref, &both.a, &inputs);
    let limits = (options.seed, options.scans);
    let outline = base.a.machine.outline();
    let places: Vec<_> = inputs.all.iter().map(|input| (input.at, input.kind)).collect();
    let names = terminals(&xref, &base.a);
    let loaded = base.a.machine.data();
    let surroundings = Surroundings {
        outline: &outline,
        loaded,
        inputs: &places,
        names: &names,
        progress: options.progress.as_deref(),
    };
    let timers = timers(image, &base.a);
    let progress = options.progress.as_deref();
    let mut campaign = Campaign::new(
        both,
        &pairs,
        &inputs,
        goals,
        (&solver, &surroundings),
        timers,
        limits,
        (short, steady),
        progress,
    );
    campaign.run();
    report.take_run(&campaign, inputs.all.len());
    if campaign.is_stopped() && campaign.found.is_none() {
        let (scans, all) = (report.scans, options.scans);
        report.notes.push(format!("the run was stopped early, after {scans} of {all} scans"));
    }
    if let Some((difference, tape)) = campaign.found.take() {
        let scratch = Both { a: base.a.fork(), b: base.b.fork() };
        if let Some(progress) = progress {
            progress.shortens();
        }
        let mut player = Player { base: &base, scratch, pairs: &pairs, inputs: &inputs, spent: 0, progress };
        let shortest = if options.minimize { player.shortest(&tape) } else { None };
        let (tape, difference) = shortest.unwrap_or((tape, difference));
        let named = (&options.original, &options.other);
        let example = scenario::write(&tape, &difference, &inputs, &presets, named, options.seed);
        report.found = Some((difference, example));
    }
    report
}

/// Finds what belongs together, without what rungs left to a person decide.
fn pairs<B: Side>(
    image: &Image,
    xref: &CrossReference<'_>,
    (a, b): (&Slc, &B),
    map: &[Mapping],
    fates: Option<&[RungFate]>,
    report: &mut Report,
) -> Pairs {
    let persons = rungs(image, fates, report);
    let taint = taint::tainted(image, xref, a, &persons).unwrap_or_else(|| {
        report.incomparable.push("which rungs run at all depends on rungs that were left to a person".to_owned());
        let words = 0..u32::try_from(a.machine.data().len()).unwrap_or(u32::MAX);
        taint::Taint { bits: words.map(|word| (word, u16::MAX)).collect(), rungs: persons.clone(), stops: true }
    });
    report.not_compared = taint.bits.len();
    let mut pairs = Pairs::new(image, xref, a, b, map, &taint.bits);
    let stated = fates.unwrap_or_default().iter().filter(|fate| !fate.conditions.is_empty());
    pairs.persons = taint.rungs;
    pairs.stops_unknown = taint.stops;
    pairs.conditions = stated.map(|fate| (fate.file, fate.rung, fate.conditions.clone())).collect();
    pairs
}

/// Checks that every rung has a fate; answers those left to a person.
fn rungs(image: &Image, fates: Option<&[RungFate]>, report: &mut Report) -> BTreeSet<(u16, u32)> {
    let Some(fates) = fates else { return BTreeSet::new() };
    let known: BTreeSet<(u16, u32)> = fates.iter().map(|fate| (fate.file, fate.rung)).collect();
    for file in image.ladder_files() {
        for (number, rung) in (0..).zip(&file.rungs) {
            if !rung.is_end() && !known.contains(&(file.number, number)) {
                report.missing_rungs.push(format!("{}:{number}", file.number));
            }
        }
    }
    for fate in fates {
        if let Some(why) = &fate.person {
            report.persons.push(format!("{}:{}: {why}", fate.file, fate.rung));
        }
        report.conditions.extend(fate.conditions.iter().map(|why| format!("{}:{}: {why}", fate.file, fate.rung)));
    }
    fates.iter().filter(|fate| fate.person.is_some()).map(|fate| (fate.file, fate.rung)).collect()
}

/// Puts both sides where they begin alike: terminals off, clocks at one time. Answers what scenarios must
/// set for that.
fn start<B: Side>(both: &mut Both<B>, inputs: &Inputs<B::Target>, pairs: &Pairs) -> Vec<Preset> {
    let mut presets = Vec::new();
    for (at, original, other) in pairs.input_words() {
        if both.a.word(at) != 0
            && let (Ok(own), Ok(target)) = (both.a.target(&original), both.b.target(&other))
        {
            both.a.write(&own, 0);
            both.b.write(&target, 0);
            presets.push(Preset { original, other, kind: Kind::Word, value: 0 });
        }
    }
    // Fields the program reads, and the whole date where it reads one of them.
    let clock = |address: &Address| matches!(address.file_type, FileType::S | FileType::RTC);
    if inputs.all.iter().any(|input| clock(&input.a.0)) {
        presets.extend(date(both, inputs, pairs));
    }
    presets
}

/// A Monday before noon.
const DATE: [(&str, u16, u16, u32); 6] = [
    ("Year", 37, 0, 2024),
    ("Month", 38, 1, 4),
    ("Day", 39, 2, 15),
    ("Hour", 40, 3, 11),
    ("Minute", 41, 4, 59),
    ("Second", 42, 5, 30),
];

fn date<B: Side>(both: &mut Both<B>, inputs: &Inputs<B::Target>, pairs: &Pairs) -> Vec<Preset> {
    let rtc = inputs.all.iter().any(|input| input.a.0.file_type == FileType::RTC);
    let mut presets = Vec::new();
    for (field, status, word, value) in DATE {
        let address = match rtc {
            true => Address::element(FileType::RTC, 0, 0).with_word(word),
            false => Address::element(FileType::S, 2, status),
        };
        let original = address.to_string();
        let Some(other) = pairs.clock(field, &original) else { continue };
        if let (Ok(own), Ok(target)) = (both.a.target(&original), both.b.target(&other)) {
            both.a.write(&own, value);
            both.b.write(&target, value);
            presets.push(Preset { original, other, kind: Kind::Word, value });
        }
    }
    presets
}

/// Where the period of a timed interrupt stands.
const SET_POINTS: [&str; 2] = ["S:30", "STI:0.SPM"];

/// A timed interrupt can come: a file is set up for one, and a period stands in the data or is written.
fn has_timed_interrupt(image: &Image) -> bool {
    let calls = CallGraph::build(image, &image.documentation);
    let named = |kind| calls.files.iter().flat_map(|file| &file.entries).any(|entry| entry.kind == kind);
    let value = |text: &str| Address::parse(text).ok().and_then(|address| image.value_at(&address));
    let period = SET_POINTS.into_iter().filter_map(value).any(|value| value != ladder::Value::Word(0));
    let started = crate::instructions(image).any(|(_, it)| matches!(it.mnemonic.name(), Some("STS" | "STE")));
    named(EntryKind::TimedInterrupt) && (period || started)
}

/// Whether the period of a timed interrupt changes in the main program at most, which no interrupt routine can call.
fn has_steady_period<T>(image: &Image, xref: &CrossReference<'_>, a: &Slc, inputs: &Inputs<T>) -> bool {
    const MAIN: u16 = 2;
    let started = crate::instructions(image).filter(|(_, it)| it.mnemonic.name() == Some("STS"));
    let words = SET_POINTS.iter().filter_map(|text| Address::parse(text).ok());
    let mut words = words.filter_map(|word| Some((a.place(&word.to_string()).ok()?.0, word)));
    let stays = words.all(|(at, word)| {
        let written = xref.of(&word).iter().any(|it| it.role.writes() && it.location.file != MAIN);
        !written && inputs.all.iter().all(|input| input.at >> 4 != at >> 4)
    });
    stays && started.map(|(location, _)| location.file).all(|file| file == MAIN)
}

/// Addresses of terminals by place: which slot a word belongs to does not show in its place.
fn terminals(xref: &CrossReference<'_>, a: &Slc) -> BTreeMap<u32, String> {
    let named = xref.named().into_iter().filter(|address| address.file_type.has_slots() && address.is_direct());
    let place = |address: &Address| Some((a.place(&address.to_string()).ok()?.0, address.to_string()));
    named.filter(|address| address.bit.is_some()).filter_map(place).collect()
}

/// Timers the program runs: place of PRE and milliseconds per count.
fn timers(image: &Image, a: &Slc) -> Vec<(u32, u32)> {
    let mut all = BTreeSet::new();
    for (_, instruction) in crate::instructions(image) {
        if matches!(instruction.mnemonic.name(), Some("TON" | "TOF" | "RTO"))
            && let Some(address) = instruction.operands.first().and_then(Operand::address).filter(|it| it.is_direct())
            && let Ok((at, _)) = a.place(&address.to_string())
        {
            let base = ladder::TimeBase::from_control(a.word(at)).map_or(10, ladder::TimeBase::milliseconds);
            all.insert((at + 16, base));
        }
    }
    all.into_iter().collect()
}
