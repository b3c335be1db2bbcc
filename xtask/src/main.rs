//! Chores: what a developer and CI run, by the same names.
//!
//! `cargo xtask` lists them. Each chore is an ordinary command line that could be typed by hand;
//! this program only keeps the list in one place and the order right.

mod api_tester;
mod contact_sheet;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::time::Instant;

type Outcome = Result<(), String>;

struct Chore {
    name: &'static str,
    help: &'static str,
    run: fn(&[String]) -> Outcome,
}

const CHORES: &[Chore] = &[
    Chore {
        name: "ci",
        help: "everything below but `nightly`, `bench`, `contact-sheet` and `bless`: what must pass before a change lands",
        run: ci,
    },
    Chore { name: "fmt", help: "check formatting", run: |_| cargo(&["fmt", "--all", "--check"]) },
    Chore { name: "clippy", help: "lints, warnings are errors", run: |_| clippy() },
    Chore { name: "doc", help: "build the API documentation, broken links are errors", run: |_| doc() },
    Chore {
        name: "examples",
        help: "check that examples/ is what `rungs build` makes of its text (`--write` rebuilds)",
        run: examples,
    },
    Chore {
        name: "fuzz",
        help: "run every fuzz target on the same few thousand inputs (`--seconds N`: on new ones for that long)",
        run: fuzz,
    },
    Chore {
        name: "setup",
        help: "install what tests need beside Rust: Chromium and its driver where apt-get is, axe-core where npm is, a tester of interfaces where python3 is",
        run: |_| setup(),
    },
    Chore { name: "test", help: "all tests, the corpus checks included where ../shared/corpus is", run: |_| test() },
    Chore {
        name: "nightly",
        help: "at length: 10,000 random programs against the interpreter, 10,000 scans and a report of every project, 200 mutants and 100,000 scans of every proven one",
        run: |_| nightly(),
    },
    Chore {
        name: "bless",
        help: "rewrite generated pages and snapshots; read the difference before committing",
        run: |_| bless(),
    },
    Chore {
        name: "contact-sheet",
        help: "our drawings beside the printouts of the corpus, for eyes (target/contact-sheet)",
        run: contact_sheet::run_chore,
    },
    Chore {
        name: "bench",
        help: "benchmarks: ratios against a baseline in the same run",
        run: |_| cargo(&["bench", "--workspace"]),
    },
];

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let Some(chore) = arguments.first().and_then(|name| CHORES.iter().find(|chore| chore.name == name)) else {
        eprintln!("usage: cargo xtask CHORE\n");
        for chore in CHORES {
            eprintln!("  {:<13} {}", chore.name, chore.help);
        }
        return ExitCode::from(2);
    };
    match (chore.run)(&arguments[1..]) {
        Ok(()) => ExitCode::SUCCESS,
        Err(why) => {
            eprintln!("xtask {}: {why}", chore.name);
            ExitCode::FAILURE
        }
    }
}

/// Cheap checks first; the tests last, so that the runner's own result lines close the output.
fn ci(_: &[String]) -> Outcome {
    for name in ["fmt", "clippy", "doc", "examples", "fuzz", "test"] {
        let start = Instant::now();
        println!("==> {name}");
        let chore = CHORES.iter().find(|chore| chore.name == name).ok_or("no such chore")?;
        (chore.run)(&[]).map_err(|why| format!("{name}: {why}"))?;
        println!("==> {name} passed in {} s", start.elapsed().as_secs());
    }
    Ok(())
}

fn clippy() -> Outcome {
    cargo(&["clippy", "--workspace", "--all-targets", "--quiet", "--", "-D", "warnings"])
}

fn doc() -> Outcome {
    let mut command = cargo_command(&["doc", "--workspace", "--no-deps", "--document-private-items", "--quiet"]);
    run(command.env("RUSTDOCFLAGS", "-D warnings"))
}

/// Programs that tests drive, and the Debian packages that bring them: names differ among systems, so
/// that one of each line is enough.
const NEEDED: [(&[&str], &[&str]); 2] = [
    (&["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"], &["chromium", "chromium-browser"]),
    (&["chromedriver"], &["chromium-driver", "chromium-chromedriver"]),
];

/// The accessibility checker that tests run in pages, in a version that is looked at before it is raised.
const AXE: (&str, &str) = ("axe-core", "4.14.1");

/// Installs what is missing. Tests that need it fail plainly without it, or say that they are skipped with
/// `RUNGS_NO_BROWSER=1`; so this is no failure where packages cannot be installed.
fn setup() -> Outcome {
    if !is_left_out("RUNGS_NO_BROWSER") {
        set_up_browser();
        set_up_axe();
    }
    api_tester::setup()
}

/// Whether a variable asks to leave tests out.
fn is_left_out(variable: &str) -> bool {
    std::env::var_os(variable).is_some_and(|value| value == "1")
}

fn set_up_browser() {
    let missing: Vec<_> = NEEDED.iter().filter(|(programs, _)| !programs.iter().any(|name| on_path(name))).collect();
    if missing.is_empty() {
        return;
    }
    let names: Vec<&str> = missing.iter().filter_map(|(programs, _)| programs.first().copied()).collect();
    if !on_path("apt-get") {
        println!("tests of pages need {}: install them, or set RUNGS_NO_BROWSER=1", names.join(" and "));
        return;
    }
    println!("installing {}", names.join(", "));
    // Package lists can be old and still good enough.
    if let Err(why) = apt(&["update", "-q"]) {
        println!("{why}");
    }
    for (programs, packages) in missing {
        let install = |package: &&&str| apt(&["install", "-qy", "--no-install-recommends", package]).is_ok();
        if packages.iter().find(install).is_none() {
            println!("{} could not be installed; tests of pages need it", programs.first().unwrap_or(&""));
        }
    }
}

/// Set to 1, tests of pages run without looking at accessibility, and say so.
const NO_AXE: &str = "RUNGS_NO_AXE";

/// Whether the accessibility checker is there in the version of [`AXE`].
fn has_axe() -> bool {
    let (name, version) = AXE;
    let package = root().join("target/npm/node_modules").join(name).join("package.json");
    std::fs::read_to_string(package).is_ok_and(|text| text.contains(&format!("\"version\": \"{version}\"")))
}

/// Puts the accessibility checker below `target/npm`, where `tests/src/axe.rs` looks for it.
fn set_up_axe() {
    let (name, version) = AXE;
    let folder = root().join("target/npm");
    if has_axe() || is_left_out(NO_AXE) {
        return;
    }
    let package = format!("{name}@{version}");
    let lacks = |why: &str| println!("{why}: tests of accessibility need {package} below {}", folder.display());
    if !on_path("npm") && on_path("apt-get") {
        println!("installing npm");
        if let Err(why) = apt(&["install", "-qy", "--no-install-recommends", "npm"]) {
            println!("{why}");
        }
    }
    if !on_path("npm") {
        lacks("npm is not here: install Node.js");
        return;
    }
    println!("installing {package}");
    if let Err(why) = std::fs::create_dir_all(&folder) {
        lacks(&why.to_string());
        return;
    }
    let quiet = ["--no-save", "--no-package-lock", "--no-audit", "--no-fund", "--ignore-scripts", "--loglevel=error"];
    let mut npm = Command::new("npm");
    npm.args(["install", &package, "--prefix"]).arg(&folder).args(quiet).current_dir(&folder);
    if let Err(why) = run(&mut npm) {
        lacks(&why);
    }
}

/// Runs `apt-get` as whoever may.
fn apt(arguments: &[&str]) -> Outcome {
    let root = Command::new("id").arg("-u").output().is_ok_and(|it| it.stdout.trim_ascii() == b"0");
    let mut command = Command::new(if root { "apt-get" } else { "sudo" });
    if !root {
        command.args(["-n", "apt-get"]);
    }
    run(command.args(arguments).env("DEBIAN_FRONTEND", "noninteractive"))
}

fn on_path(name: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(name).is_file())
}

/// What could not be installed is left out, and this says so; `cargo test` by itself fails without it.
fn test() -> Outcome {
    setup()?;
    let mut command = cargo_command(&["test", "--workspace", "--no-fail-fast"]);
    for (there, variable, what) in [
        (has_axe(), NO_AXE, "accessibility of pages, as axe-core is not here"),
        (api_tester::is_there(), api_tester::WITHOUT, "the workbench's interface, as schemathesis is not here"),
    ] {
        if !there {
            println!("SKIPPED: tests of {what}");
            command.env(variable, "1");
        }
    }
    run(&mut command)
}

/// What `test` does with 500 programs and 300 scans, at full length.
fn nightly() -> Outcome {
    for (test, variable) in [("differential", "RUNGS_CASES"), ("corpus", "RUNGS_SCANS")] {
        let mut command = cargo_command(&["test", "--release", "--package", "sim", "--test", test]);
        run(command.args(["--", "--nocapture"]).env(variable, "10000"))?;
    }
    let mut reports = cargo_command(&["test", "--release", "--package", "rungs-tests", "--test", "report_pdf"]);
    run(reports.args(["--", "--nocapture"]).env("RUNGS_REPORTS", "all"))?;
    let mut coverage = cargo_command(&["test", "--release", "--package", "analysis", "--test", "coverage"]);
    run(coverage.args(["--", "--nocapture"]).env("RUNGS_SCANS", "100000"))?;
    let mut impossible = cargo_command(&["test", "--release", "--package", "analysis", "--test", "impossible"]);
    run(impossible.args(["--", "--nocapture"]).env("RUNGS_CASES", "3000").env("RUNGS_RUNGS", "150"))?;
    let mut mutants = cargo_command(&["test", "--release", "--package", "analysis", "--test", "mutants"]);
    run(mutants.args(["--", "--nocapture"]).env("RUNGS_MUTANTS", "200"))
}

fn bless() -> Outcome {
    let mut command = cargo_command(&["test", "--workspace", "--no-fail-fast", "--quiet"]);
    run(command.env("RUNGS_BLESS", "1").env("INSTA_UPDATE", "always"))?;
    examples(&["--write".to_owned()])
}

/// Builds every `examples/*/*.SLC` and compares with the project kept beside it.
fn examples(arguments: &[String]) -> Outcome {
    cargo(&["build", "--release", "--quiet", "--package", "cli"])?;
    let rungs = target_directory().join("release").join(format!("rungs{}", std::env::consts::EXE_SUFFIX));
    let write = arguments.iter().any(|argument| argument == "--write");
    for text in example_texts()? {
        let project = text.with_extension("RSS");
        let built = if write { project.clone() } else { target_directory().join("example.RSS") };
        run(Command::new(&rungs).arg("build").arg(&text).arg("-o").arg(&built).arg("--force"))?;
        let same = std::fs::read(&built).ok() == std::fs::read(&project).ok();
        if !same {
            return Err(format!(
                "{} is not what its text builds: run `cargo xtask examples --write`",
                project.display()
            ));
        }
        run(Command::new(&rungs).arg("verify").arg(&project))?;
    }
    Ok(())
}

fn example_texts() -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    for folder in list(&root().join("examples"))? {
        if folder.is_dir() {
            found.extend(list(&folder)?.into_iter().filter(|path| path.extension().is_some_and(|e| e == "SLC")));
        }
    }
    if found.is_empty() { Err("no example texts found".to_owned()) } else { Ok(found) }
}

/// A short run of every fuzz target: enough to catch what a change breaks at once. cargo-fuzz is
/// installed if it is not there. Coverage instrumentation needs unstable flags only for sanitizers,
/// which stay off: the crates hold no `unsafe` for them to watch.
fn fuzz(arguments: &[String]) -> Outcome {
    let limits = match arguments {
        [flag, seconds] if flag == "--seconds" => vec![format!("-max_total_time={seconds}")],
        // The same inputs every time: a chore that fails must fail again when it is looked into.
        [] => ["-seed=1", "-runs=200", "-max_total_time=10"].map(str::to_owned).to_vec(),
        _ => return Err("expected nothing or `--seconds N`".to_owned()),
    };
    let have = cargo_command(&["fuzz", "--version"]).output().is_ok_and(|output| output.status.success());
    if !have {
        cargo(&["install", "cargo-fuzz", "--locked", "--quiet"])?;
    }
    let mut targets: Vec<String> = list(&root().join("fuzz/fuzz_targets"))?
        .into_iter()
        .filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()))
        .collect();
    targets.sort();
    for target in targets {
        println!("fuzz {target} {}", limits.join(" "));
        let mut command = cargo_command(&[
            "fuzz",
            "run",
            "--sanitizer",
            "none",
            "--release",
            &target,
            "--",
            "-rss_limit_mb=512",
            "-malloc_limit_mb=256",
            "-timeout=5",
            "-max_len=65536",
            "-verbosity=0",
            "-print_final_stats=0",
        ]);
        run(command.args(&limits).env("RUSTC_BOOTSTRAP", "1"))?;
    }
    Ok(())
}

fn list(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let entries = std::fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    Ok(paths)
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().map(Path::to_path_buf).unwrap_or_default()
}

fn target_directory() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

fn cargo(arguments: &[&str]) -> Outcome {
    run(&mut cargo_command(arguments))
}

fn cargo_command(arguments: &[&str]) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root()).args(arguments);
    command
}

fn run(command: &mut Command) -> Outcome {
    let status = command.status().map_err(|error| format!("{command:?}: {error}"))?;
    if status.success() { Ok(()) } else { Err(format!("{command:?} ended with {status}")) }
}
