//! `rungs bench`: how fast a program runs here.

use std::io::Write;
use std::time::{Duration, Instant};

use serde_json::json;
use sim::scenario::Controller;
use sim::{Machine, Options, Program, Unsupported};

use super::open;
use super::run::do_more_text;
use super::test::reasons;
use crate::args::BenchArguments;
use crate::do_more;
use crate::output::{Error, Outcome, printable};

/// How long to measure when no number of scans is given.
const MEASURE: Duration = Duration::from_secs(1);
/// The clock is read after so much work at most.
const BATCH: Duration = Duration::from_millis(5);

pub fn run(arguments: &BenchArguments) -> Result<Outcome, Error> {
    let name = arguments.program.display();
    if arguments.scan.is_zero() {
        return Err(Error::Use("--scan must be a time above 0".to_owned()));
    }
    if let Some(text) = do_more_text(&arguments.program) {
        let unsupported = match arguments.accept_unsupported {
            true => domore::engine::Unsupported::Stop,
            false => domore::engine::Unsupported::Refuse,
        };
        let options =
            domore::engine::Options { choices: arguments.simulation.do_more(), unsupported, ..Default::default() };
        return match do_more::machine_of(&text, &options) {
            Ok((mut machine, approximations)) => {
                let approximations = reasons(&approximations);
                report(arguments, "Do-more", measure(&mut machine, arguments), &approximations)
            }
            Err(why) => {
                why.iter().for_each(|line| eprintln!("{}", printable(&format!("{name}: {line}"))));
                eprintln!("{name}: not run");
                Ok(do_more::refused(&text))
            }
        };
    }
    let project = match open(&arguments.program, rss::Mode::Permissive) {
        Ok(project) => project,
        Err(why) => {
            if arguments.json {
                writeln!(std::io::stdout(), "{}", json!({"file": name.to_string(), "error": why}))?;
            }
            eprintln!("{}", printable(&format!("{name}: {why}")));
            return Ok(Outcome::Unreadable);
        }
    };
    let Some(image) = arguments.image.of(&project) else {
        eprintln!("{name}: the project holds no such image");
        return Ok(Outcome::Finding);
    };
    let unsupported = if arguments.accept_unsupported { Unsupported::Fault } else { Unsupported::Refuse };
    let options = Options { choices: arguments.simulation.choices(), unsupported, ..Options::default() };
    match Program::compile(image, &options) {
        Ok(program) => {
            let approximations = reasons(program.approximations());
            let mut machine = Machine::new(program);
            let family = machine.family().name();
            report(arguments, family, measure(&mut machine, arguments), &approximations)
        }
        Err(refusals) => {
            refusals.iter().for_each(|refusal| eprintln!("{}", printable(&format!("{name}: {refusal}"))));
            eprintln!("{name}: not run: {} instructions cannot be simulated", refusals.len());
            Ok(Outcome::Finding)
        }
    }
}

/// What was measured.
struct Measured {
    scans: u64,
    instructions: u64,
    time: Duration,
    simulated: Duration,
    /// Why it ended early.
    stopped: Option<String>,
}

/// Scans until the number or the time is reached, or the controller stops.
fn measure(machine: &mut impl Controller, arguments: &BenchArguments) -> Measured {
    machine.enter_run();
    let mut left = arguments.scans.unwrap_or(u64::MAX);
    let (mut batch, mut dt) = (1, Duration::ZERO);
    let start = Instant::now();
    let mut time = Duration::ZERO;
    while left > 0 && machine.is_executing() && (arguments.scans.is_some() || time < MEASURE) {
        let count = left.min(batch);
        for _ in 0..count {
            machine.scan(dt);
            dt = arguments.scan;
        }
        left -= count;
        let before = std::mem::replace(&mut time, start.elapsed());
        if time - before < BATCH {
            batch = batch.saturating_mul(2);
        }
    }
    let stopped = match machine.stopped() {
        Some(stop) => Some(stop.text),
        None if !machine.is_executing() => Some("the program suspended the processor".to_owned()),
        None => None,
    };
    Measured { scans: machine.scans(), instructions: machine.instructions(), time, simulated: machine.now(), stopped }
}

/// `a / b`, `None` where nothing was counted.
fn ratio(a: f64, b: f64) -> Option<f64> {
    (a > 0.0 && b > 0.0).then(|| a / b)
}

fn report(
    arguments: &BenchArguments,
    family: &str,
    measured: Measured,
    approximations: &[String],
) -> Result<Outcome, Error> {
    let (scans, instructions) = (measured.scans as f64, measured.instructions as f64);
    let seconds = measured.time.as_secs_f64();
    let per_scan = ratio(instructions, scans);
    let rate = ratio(scans, seconds);
    let nanoseconds = ratio(seconds * 1e9, instructions);
    let name = arguments.program.display().to_string();
    let mut out = std::io::stdout().lock();
    if arguments.json {
        let document = json!({
            "file": name,
            "processor": family,
            "scans": measured.scans,
            "instructions": measured.instructions,
            "seconds": seconds,
            "simulated_s": measured.simulated.as_secs_f64(),
            "instructions_per_scan": per_scan,
            "scans_per_second": rate,
            "ns_per_instruction": nanoseconds,
            "stopped": measured.stopped,
            "approximations": approximations,
        });
        writeln!(out, "{document}")?;
    } else {
        let show =
            |value: Option<f64>, digits: usize| value.map_or("-".to_owned(), |value| format!("{value:.digits$}"));
        writeln!(out, "{}", printable(&format!("{name}: {family}")))?;
        writeln!(out, "  scans                {} in {seconds:.3} s", measured.scans)?;
        writeln!(out, "  simulated time       {:.3} s", measured.simulated.as_secs_f64())?;
        writeln!(out, "  instructions / scan  {}", show(per_scan, 1))?;
        writeln!(out, "  scans / second       {}", show(rate, 0))?;
        writeln!(out, "  ns / instruction     {}", show(nanoseconds, 2))?;
        for line in approximations {
            eprintln!("{}", printable(&format!("{name}: approximate: {line}")));
        }
    }
    let Some(why) = measured.stopped else { return Ok(Outcome::Done) };
    eprintln!("{}", printable(&format!("{name}: stopped in scan {}: {why}", measured.scans)));
    Ok(Outcome::Finding)
}
