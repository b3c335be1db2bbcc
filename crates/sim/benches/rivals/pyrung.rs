//! The ladder in pyrung, a Python package that simulates another ladder dialect.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use super::{MIX, SCANS_PER_INPUT, lines};

/// Runs the ordinary runner and the compiled replay runner, each for as many scans as asked for.
const MAIN: &str = r"
def measure(plc, scans):
    word = 1
    start = 0
    for s in range(-5, scans):
        if s == 0: start = time.perf_counter()
        if s % SCANS_PER_INPUT == 0:
            word ^= word << 7 & 0xFFFF; word ^= word >> 9; word ^= word << 8 & 0xFFFF
            plc.patch({f'i{n}': bool(word >> n & 1) for n in range(16)})
        plc.step()
    return int((time.perf_counter() - start) * 1e9)
scans = int(sys.argv[1])
print(measure(PLC(logic, dt=0.01), scans), measure(CompiledPLC(logic, dt=0.01), scans * 5) // 5)
";

fn source(rungs: usize) -> String {
    let mut text = format!(
        "import sys, time\nfrom pyrung import *\nfrom pyrung.core import CompiledPLC\n\
         SCANS_PER_INPUT = {SCANS_PER_INPUT}\ni = [Bool(f'i{{n}}') for n in range(16)]\nlogic = Program(strict=False)\nwith logic:\n"
    );
    for (index, line) in lines(rungs, 2).enumerate() {
        if index % MIX.len() == 0 {
            let k = index / MIX.len();
            let _ = writeln!(text, "    b0, b1, b2, b3 = (Bool(f'b{{n}}_{k}') for n in range(4))");
            let _ = writeln!(text, "    t, c, n = Timer.clone('t{k}'), Counter.clone('c{k}'), Int('n{k}')");
        }
        if !line.is_empty() {
            let _ = writeln!(text, "    {line}");
        }
    }
    text + MAIN
}

/// A Python that has pyrung: the one of `folder`, made there if need be.
fn python(folder: &Path) -> Result<PathBuf, String> {
    let home = folder.join("pyrung");
    let python = home.join("bin/python");
    let succeeds = |command: &mut Command| match command.output() {
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => Err(String::from_utf8_lossy(&output.stderr).trim().to_owned()),
        Err(error) => Err(error.to_string()),
    };
    if succeeds(Command::new(&python).args(["-c", "import pyrung"])).is_err() {
        succeeds(Command::new("python3").args(["-m", "venv"]).arg(&home)).map_err(|why| format!("python3: {why}"))?;
        succeeds(Command::new(&python).args(["-m", "pip", "install", "--quiet", "pyrung"]))
            .map_err(|why| format!("pip: {why}"))?;
    }
    Ok(python)
}

/// Times of `scans` scans of the ladder in pyrung: its runner and its compiled replay runner.
///
/// # Errors
/// Python or pyrung is not there, or fails.
pub(crate) fn run(folder: &Path, rungs: usize, scans: u64) -> Result<[Duration; 2], String> {
    let python = python(folder)?;
    let file = folder.join("ladder.py");
    std::fs::write(&file, source(rungs)).map_err(|error| error.to_string())?;
    let output = Command::new(python).arg(&file).arg(scans.to_string()).output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let times: Vec<u64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match times[..] {
        [runner, compiled] => Ok([runner, compiled].map(Duration::from_nanos)),
        _ => Err(format!("unexpected answer: {text}{}", String::from_utf8_lossy(&output.stderr))),
    }
}
