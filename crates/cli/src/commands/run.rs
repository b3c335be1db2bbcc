//! `rungs run`: a program in simulated time.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;
use std::time::Duration;

use ladder::{Address, FileType, Image, Project, Value, members_of};
use sim::scenario::{Controller, Literal, parse_duration, value_for};
use sim::{Machine, Options, Program, Recorder, Unsupported};

use super::open;
use super::test::reasons;
use super::trace::{Column, Row, RungColumn, parts, writer};
use crate::args::RunArguments;
use crate::do_more;
use crate::output::{Error, Outcome, printable};

/// More scans than anyone reads; a slip of units otherwise fills a disk.
const MOST_SCANS: u128 = 10_000_000;

pub fn run(arguments: &RunArguments) -> Result<Outcome, Error> {
    if arguments.watch.is_empty() && arguments.trace_rung.is_empty() {
        return Err(Error::Use("nothing to show: name addresses with --watch or rungs with --trace-rung".to_owned()));
    }
    if arguments.scan.is_zero() || arguments.duration.as_nanos() / arguments.scan.as_nanos() > MOST_SCANS {
        return Err(Error::Use(format!("--for and --scan must give from 1 to {MOST_SCANS} scans")));
    }
    if let Some(text) = do_more_text(&arguments.program) {
        return run_do_more(arguments, &text);
    }
    let project = match open(&arguments.program, rss::Mode::Permissive) {
        Ok(project) => project,
        Err(why) => {
            eprintln!("{}: {why}", arguments.program.display());
            return Ok(Outcome::Unreadable);
        }
    };
    let Some(image) = arguments.image.of(&project) else {
        eprintln!("{}: the project holds no such image", arguments.program.display());
        return Ok(Outcome::Finding);
    };
    let sets = arguments
        .set
        .iter()
        .map(|text| Set::read(text, |place| address(&project, place)))
        .collect::<Result<Vec<_>, _>>()?;
    let rungs = arguments.trace_rung.iter().map(|text| rung(image, text)).collect::<Result<Vec<_>, _>>()?;
    let unsupported = if arguments.accept_unsupported { Unsupported::Fault } else { Unsupported::Refuse };
    let options = Options { choices: arguments.simulation.choices(), unsupported, ..Options::default() };
    let program = match Program::compile(image, &options) {
        Ok(program) => program,
        Err(refusals) => {
            for refusal in &refusals {
                eprintln!("{}: {refusal}", arguments.program.display());
            }
            eprintln!("{}: not run: {} instructions cannot be simulated", arguments.program.display(), refusals.len());
            return Ok(Outcome::Finding);
        }
    };
    for line in reasons(program.approximations()) {
        eprintln!("{}: approximate: {line}", arguments.program.display());
    }
    let approximations: Vec<String> = program.approximations().iter().map(ToString::to_string).collect();
    let columns = |machine: &Machine| columns(&project, machine, &arguments.watch);
    follow(arguments, Simulation { machine: Machine::new(program), sets, rungs, approximations }, columns)
}

/// Enters run and traces it.
fn follow<M: Followed>(
    arguments: &RunArguments,
    mut simulation: Simulation<M>,
    columns: impl FnOnce(&M) -> Result<Vec<(Column, M::Place)>, Error>,
) -> Result<Outcome, Error> {
    simulation.write_initial()?;
    simulation.machine.enter_run();
    simulation.write_initial()?;
    let columns = columns(&simulation.machine)?;
    match &arguments.output {
        Some(path) => simulation.trace(arguments, columns, create(path, arguments.force)?),
        None => simulation.trace(arguments, columns, std::io::stdout().lock()),
    }
}

/// The text of a Do-more program; `None` for anything else, errors included: opening words them.
pub(super) fn do_more_text(path: &Path) -> Option<String> {
    let bytes = super::read_file(path, domore::text::MAX_TEXT).ok()?;
    let text = convert::slc::decode(&bytes).into_owned();
    domore::text::is_domore(&text).then_some(text)
}

fn run_do_more(arguments: &RunArguments, text: &str) -> Result<Outcome, Error> {
    let name = arguments.program.display();
    if !arguments.trace_rung.is_empty() {
        return Err(Error::Use("--trace-rung follows rungs of SLC 500 and MicroLogix programs only".to_owned()));
    }
    let unsupported = match arguments.accept_unsupported {
        true => domore::engine::Unsupported::Stop,
        false => domore::engine::Unsupported::Refuse,
    };
    let options =
        domore::engine::Options { choices: arguments.simulation.do_more(), unsupported, ..Default::default() };
    let (machine, approximations) = match do_more::machine_of(text, &options) {
        Ok(found) => found,
        Err(why) => {
            why.iter().for_each(|line| eprintln!("{}", printable(&format!("{name}: {line}"))));
            eprintln!("{name}: not run");
            return Ok(do_more::refused(text));
        }
    };
    for line in reasons(&approximations) {
        eprintln!("{name}: approximate: {line}");
    }
    let find = |text: &str| match machine.handle(text) {
        Ok(handle) => Ok(handle),
        Err(error) => Err(Error::Use(error.to_string())),
    };
    let sets = arguments.set.iter().map(|text| Set::read(text, find)).collect::<Result<Vec<_>, _>>()?;
    let approximations = approximations.iter().map(ToString::to_string).collect();
    let columns = |machine: &domore::engine::Machine| {
        let mut columns = Vec::new();
        for text in &arguments.watch {
            for part in do_more::members(text) {
                let place = machine.handle(&part).map_err(|why| Error::Use(format!("--watch {text}: {}", why.why)))?;
                columns.push((Column { heading: part, sample: machine.shown(place) }, place));
            }
        }
        Ok(columns)
    };
    follow(arguments, Simulation { machine, sets, rungs: Vec::new(), approximations }, columns)
}

/// A controller whose places are found once, before the first scan.
trait Followed: Controller {
    type Place;
    fn value(&self, place: &Self::Place) -> Option<Value>;
    fn put(&mut self, place: &Self::Place, value: &Value) -> Result<(), String>;
    /// A scan of which the recorder keeps what it wants.
    fn scan_recorded(&mut self, dt: Duration, recorder: &mut Recorder);
}

impl Followed for Machine {
    type Place = Address;

    fn value(&self, place: &Address) -> Option<Value> {
        self.get(place).ok()
    }

    fn put(&mut self, place: &Address, value: &Value) -> Result<(), String> {
        self.set(place, value).map_err(|why| why.to_string())
    }

    fn scan_recorded(&mut self, dt: Duration, recorder: &mut Recorder) {
        self.scan_traced(dt, recorder);
    }
}

impl Followed for domore::engine::Machine {
    type Place = domore::engine::Handle;

    fn value(&self, place: &Self::Place) -> Option<Value> {
        Some(self.shown(*place))
    }

    fn put(&mut self, place: &Self::Place, value: &Value) -> Result<(), String> {
        self.put_shown(*place, value)
    }

    fn scan_recorded(&mut self, dt: Duration, _: &mut Recorder) {
        self.scan(dt);
    }
}

fn create(path: &Path, force: bool) -> Result<File, Error> {
    if path.exists() && !force {
        return Err(Error::Use(format!("{} exists; --force overwrites it", path.display())));
    }
    File::create(path).map_err(|error| Error::Use(format!("{}: {error}", path.display())))
}

/// An address, or the one a symbol stands for.
fn address(project: &Project, text: &str) -> Result<Address, Error> {
    let symbol = || project.main.documentation.by_symbol(text)?.target.direct_address().cloned();
    let found = Address::parse(text).ok().or_else(symbol);
    match found {
        Some(address) if address.is_direct() => Ok(address),
        Some(_) => Err(Error::Use(format!("{text} is no fixed place"))),
        None => Err(Error::Use(format!("`{text}` is no address or symbol of this program"))),
    }
}

/// A value to write at a time.
struct Set<P> {
    text: String,
    place: P,
    literal: Literal,
    /// `None`: before the first scan.
    at: Option<Duration>,
}

impl<P> Set<P> {
    fn read(text: &str, find: impl Fn(&str) -> Result<P, Error>) -> Result<Set<P>, Error> {
        let wrong = |why: &str| Error::Use(format!("--set {text}: {why}"));
        let (place, rest) = text.split_once('=').ok_or_else(|| wrong("expected ADDRESS=VALUE"))?;
        // A string may hold an `@` of its own: what follows the last one is a time only if it reads as one.
        let timed = rest.rsplit_once('@').and_then(|(value, time)| Some((value, parse_duration(time).ok()?)));
        let (value, at) = timed.map_or((rest, None), |(value, time)| (value, Some(time)));
        let literal = match (value.parse::<i64>(), value.parse::<f64>()) {
            (Ok(integer), _) => Literal::Integer(integer),
            (_, Ok(float)) => Literal::Float(float),
            _ => Literal::Text(value.to_owned()),
        };
        Ok(Set { text: text.to_owned(), place: find(place.trim())?, literal, at })
    }
}

/// Reads `4` or `3:4`; the rung must exist.
fn rung(image: &Image, text: &str) -> Result<RungColumn, Error> {
    let wrong = |why: String| Error::Use(format!("--trace-rung {text}: {why}"));
    let (file, number) = text.split_once(':').unwrap_or(("2", text));
    let (Ok(file), Ok(number)) = (file.parse::<u16>(), number.parse::<u16>()) else {
        return Err(wrong("expected a rung number, or FILE:RUNG".to_owned()));
    };
    let rungs = image.ladder_files().find(|ladder| ladder.number == file).map(|ladder| &ladder.rungs);
    let rungs = rungs.ok_or_else(|| wrong(format!("program file {file} holds no ladder")))?;
    let rung = rungs.get(usize::from(number));
    let rung =
        rung.ok_or_else(|| wrong(format!("program file {file} has rungs 0 to {}", rungs.len().saturating_sub(1))))?;
    let text = |instruction| convert::slc::rung::instruction_text(instruction, Some(image.family()));
    let instructions = rung.instructions().map(text).collect();
    Ok(RungColumn { file, rung: number, instructions, parts: parts(&rung.series) })
}

/// One column per value to follow; elements spread over their members.
fn columns(project: &Project, machine: &Machine, watch: &[String]) -> Result<Vec<(Column, Address)>, Error> {
    let mut columns = Vec::new();
    for text in watch {
        let place = address(project, text)?;
        let missing = |why: sim::AccessError| Error::Use(format!("--watch {text}: {why}"));
        let value = machine.get(&place).map_err(missing)?;
        let whole = matches!(value, Value::Timer(_) | Value::Counter(_) | Value::Control(_));
        if !whole {
            if matches!(value, Value::Words(_)) {
                return Err(Error::Use(format!("--watch {text}: name a member of this element")));
            }
            columns.push((Column { heading: place.to_string(), sample: value }, place));
            continue;
        }
        let flagged = matches!(place.file_type, FileType::T | FileType::C | FileType::R);
        for member in members_of(place.file_type).filter(|_| flagged) {
            let mut part = place.clone().with_word(member.word);
            if let Some(bit) = member.bit {
                part = Address { word: None, ..part }.with_bit(bit);
            }
            let sample = machine.get(&part).map_err(missing)?;
            columns.push((Column { heading: part.to_string(), sample }, part));
        }
    }
    Ok(columns)
}

struct Simulation<M: Followed> {
    machine: M,
    sets: Vec<Set<M::Place>>,
    rungs: Vec<RungColumn>,
    /// What runs only approximately, a line each.
    approximations: Vec<String>,
}

impl<M: Followed> Simulation<M> {
    fn write_initial(&mut self) -> Result<(), Error> {
        self.write(|set| set.at.is_none())
    }

    fn write(&mut self, due: impl Fn(&Set<M::Place>) -> bool) -> Result<(), Error> {
        for set in self.sets.iter().filter(|set| due(set)) {
            let wrong = |why: String| Error::Use(format!("--set {}: {why}", set.text));
            let present = self.machine.value(&set.place).ok_or_else(|| wrong("there is no such place".to_owned()))?;
            let value = value_for(&set.literal, &present).map_err(wrong)?;
            self.machine.put(&set.place, &value).map_err(wrong)?;
        }
        Ok(())
    }

    /// Scans until the time is over, a row per scan; ends early when the processor stops.
    fn trace(
        mut self,
        arguments: &RunArguments,
        columns: Vec<(Column, M::Place)>,
        out: impl Write,
    ) -> Result<Outcome, Error> {
        let (columns, places): (Vec<Column>, Vec<M::Place>) = columns.into_iter().unzip();
        let mut out = BufWriter::new(out);
        let rungs = std::mem::take(&mut self.rungs);
        let approximations = std::mem::take(&mut self.approximations);
        let mut writer = writer(arguments.format, &columns, &rungs, &arguments.program, &approximations)?;
        writer.head(&mut out)?;
        let mut recorder =
            Recorder { rungs: rungs.iter().map(|rung| (rung.file, rung.rung)).collect(), seen: Vec::new() };
        let (mut scans, mut dt, mut last_set) = (0u64, Duration::ZERO, None);
        loop {
            let now = self.machine.now() + dt;
            self.write(|set| set.at.is_some_and(|at| at <= now && last_set.is_none_or(|last| at > last)))?;
            last_set = Some(now);
            recorder.seen.clear();
            if recorder.rungs.is_empty() {
                self.machine.scan(dt);
            } else {
                self.machine.scan_recorded(dt, &mut recorder);
            }
            scans += 1;
            dt = arguments.scan;
            // Every column was read once before the first scan: the places exist.
            let values = places.iter().zip(&columns);
            let values =
                values.map(|(place, c)| self.machine.value(place).unwrap_or_else(|| c.sample.clone())).collect();
            let row = Row { scan: scans, time: self.machine.now(), values, flows: &recorder.seen };
            let last = self.machine.now() + arguments.scan > arguments.duration || !self.machine.is_executing();
            writer.row(&mut out, &row, last)?;
            if last {
                break;
            }
        }
        writer.foot(&mut out, &self.machine)?;
        out.flush()?;
        if let Some(fault) = self.machine.stopped() {
            eprintln!(
                "{}: scan {scans}, {:.3} s: {fault}",
                arguments.program.display(),
                self.machine.now().as_secs_f64()
            );
            return Ok(Outcome::Finding);
        }
        if !self.machine.is_executing() {
            eprintln!("{}: the program suspended the processor in scan {scans}", arguments.program.display());
        }
        Ok(Outcome::Done)
    }
}
