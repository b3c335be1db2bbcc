//! `cargo xtask contact-sheet`: rungs as we draw them beside the same rungs as RSLogix printed them.
//!
//! For eyes, not for CI: the sheet stays in `target/contact-sheet`, because it holds parts of other people's
//! programs. What was judged on it stands in `docs/contact-sheet.md`.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{Outcome, cargo, root, run, target_directory};

/// A rung: project and report below the corpus without their endings, program file, rung, and what it is
/// there for.
struct Case {
    project: &'static str,
    report: &'static str,
    file: u16,
    rung: usize,
    shapes: &'static str,
}

/// A project whose report has its name.
const fn case(project: &'static str, file: u16, rung: usize, shapes: &'static str) -> Case {
    Case { project, report: project, file, rung, shapes }
}

/// Printed from a running processor, so its values are later ones.
const fn cascading(rung: usize, shapes: &'static str) -> Case {
    let (project, report) = ("PLC_2s_lamp_flash/cascading_timers", "PLC_2s_lamp_flash/cascading_timers_live");
    Case { project, report, file: 2, rung, shapes }
}

const SORT: &str = "PLC_lowpass/training_bubble_sort_running";
const COUNT: &str = "PLC_alarm_bit_count/alarm_count_live";
const REJECT: &str = "PLC_reject_timing/TVZ_1100_REV02_LatchmoorAnnotations";
const PUMPS: &str = "PLC_3_pump_sequencing/3_pump_sequencing";

/// Every shape that the printouts show.
const CASES: &[Case] = &[
    case(
        "PLC_reject_timing/lecky_demo_tof_loop",
        2,
        3,
        "branches nested three deep, title, comment, JMP, LBL, OTL, OTU, indirect bits",
    ),
    case(
        "PLC_lowpass/training_two_setpoints_running_0.965",
        5,
        6,
        "branch in a branch, CTU with its flags, RES, JSR, GRT",
    ),
    case(SORT, 253, 0, "LIM, AND, DIV, RET"),
    case(SORT, 100, 3, "CPW with an indexed file"),
    case(SORT, 4, 3, "SCP, a box of many rows"),
    case(REJECT, 3, 1, "TOF"),
    case(REJECT, 3, 8, "LEQ"),
    case(REJECT, 4, 2, "HSL, NEQ, OTE"),
    case(REJECT, 4, 5, "MVM, ONS"),
    case(REJECT, 4, 6, "title, comment, XIO, an indirect bit, highlights, OTL"),
    case(REJECT, 4, 8, "LIM with live values, outputs in a branch"),
    case(REJECT, 11, 1, "BSL"),
    case(COUNT, 254, 1, "MUL, OR"),
    case(COUNT, 255, 1, "CLR, FLL"),
    Case {
        project: "RSLogix-Simulation-Projects/DynamicDataExchange",
        report: "RSLogix-Simulation-Projects/DynamicDataExchange_PDF",
        file: 3,
        rung: 0,
        shapes: "ACN, COP, strings",
    },
    Case {
        project: "RSLogix-Simulation-Projects/Pump_Control_HOA_and_Alarms",
        report: "RSLogix-Simulation-Projects/Pump_Control_HOA_and_Alarms_PDF",
        file: 5,
        rung: 3,
        shapes: "OSR as a box, TON",
    },
    case("Fast-FIFO-test/fast_test", 2, 2, "OSF"),
    case("Fast-FIFO-test/fast_test", 2, 5, "END"),
    case(PUMPS, 234, 0, "SBR"),
    case(PUMPS, 255, 3, "XOR"),
    case("PLC_2s_lamp_flash/sti_1000ms_live", 2, 0, "STS"),
    cascading(0, "TON with its flags, symbols with a member"),
    cascading(3, "five outputs in a branch, module names, OTU and OTL of one bit"),
];

/// Dots per inch of the crops: a row of theirs is then as high as one of ours.
const DPI: u32 = 109;

/// Above this, in points, stands the title of a page; comments can name program files as well.
const TITLE: f64 = 36.0;

/// A rung number on a page of a report, in points.
struct Place {
    page: usize,
    width: f64,
    from: f64,
    to: f64,
}

/// Makes the sheet, and a picture of it where there is a Chromium.
pub(crate) fn run_chore(_: &[String]) -> Outcome {
    let corpus = std::env::var_os("RUNGS_CORPUS").map_or_else(|| root().join("../shared/corpus"), PathBuf::from);
    if !corpus.is_dir() {
        println!("skipped: corpus not present");
        return Ok(());
    }
    cargo(&["build", "--quiet", "--package", "cli"])?;
    let rungs = target_directory().join("debug").join(format!("rungs{}", std::env::consts::EXE_SUFFIX));
    let folder = target_directory().join("contact-sheet");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut page = String::from(
        "<!doctype html><meta charset=\"utf-8\"><title>Contact sheet</title>\
         <style>body{font:15px sans-serif;margin:16px;background:#fff}section{border-top:2px solid #888;padding:8px 0}\
         div{display:inline-block;vertical-align:top;margin-right:16px}</style>\n",
    );
    for (number, case) in CASES.iter().enumerate() {
        let ours = format!("{number:02}.svg");
        let (file, rung) = (case.file.to_string(), case.rung.to_string());
        let project = corpus.join(format!("{}.RSS", case.project));
        let arguments = ["--to", "svg", "--state", "--width", "100", "--force", "--file", &file, "--rung", &rung];
        let mut export = Command::new(&rungs);
        run(export.arg("export").arg(project).args(arguments).arg("--out").arg(folder.join(&ours)))?;
        let theirs = format!("{number:02}");
        crop(&corpus.join(format!("{}.pdf", case.report)), case, &folder.join(&theirs))?;
        // Writing to a string cannot fail.
        let _ = writeln!(
            page,
            "<section><h3>{number}. {} {file}:{rung} - {}</h3><div><img src=\"{theirs}.png\" alt=\"printed\"></div>\
             <div><img src=\"{ours}\" alt=\"ours\"></div></section>",
            case.project, case.shapes
        );
    }
    let sheet = folder.join("index.html");
    std::fs::write(&sheet, page).map_err(|error| format!("{}: {error}", sheet.display()))?;
    println!("{}", sheet.display());
    picture(&sheet)
}

/// The part of a report from the rung before to the one after.
fn crop(report: &Path, case: &Case, to: &Path) -> Outcome {
    let place = place(report, case)?;
    let dots = |points: f64| format!("{:.0}", points * f64::from(DPI) / 72.0);
    let page = (place.page + 1).to_string();
    let (y, height) = (dots(place.from), dots(place.to - place.from));
    let width = dots(place.width);
    let mut command = Command::new("pdftoppm");
    command.args(["-r", &DPI.to_string(), "-png", "-singlefile", "-f", &page, "-l", &page]);
    run(command.args(["-x", "0", "-y", &y, "-W", &width, "-H", &height]).arg(report).arg(to))
}

fn place(report: &Path, case: &Case) -> Result<Place, String> {
    let output = Command::new("pdftotext").arg("-bbox").arg(report).arg("-").output();
    let output = output.map_err(|error| format!("pdftotext: {error}"))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let number = format!("{:04}", case.rung);
    for (page, content) in text.split("<page ").skip(1).enumerate() {
        let words: Vec<(f64, f64, &str)> = content.lines().filter_map(word).collect();
        let of_file = words
            .windows(2)
            .any(|pair| matches!(pair, [(_, y, "LAD"), (_, _, file)] if *y < TITLE && file.parse() == Ok(case.file)));
        let numbers =
            || words.iter().filter(|(x, _, text)| *x < 30.0 && text.len() == 4 && text.parse::<u32>().is_ok());
        let Some((_, y, _)) = numbers().find(|(_, _, text)| of_file && *text == number) else { continue };
        let size = |name| attribute(content, name).ok_or_else(|| format!("{}: a page without size", report.display()));
        let (width, height) = (size("width")?, size("height")?);
        let from = numbers().map(|(_, at, _)| *at).filter(|at| at < y).fold(24.0, f64::max);
        let to = numbers().map(|(_, at, _)| *at).filter(|at| at > y).fold(height - 30.0, f64::min);
        return Ok(Place { page, width, from, to });
    }
    Err(format!("{}: no rung {} of file {}", report.display(), case.rung, case.file))
}

/// Left end, upper end and text of a line of `pdftotext -bbox`.
fn word(line: &str) -> Option<(f64, f64, &str)> {
    let (head, text) = line.trim().strip_prefix("<word ")?.split_once('>')?;
    Some((attribute(head, "xMin")?, attribute(head, "yMin")?, text.strip_suffix("</word>")?))
}

fn attribute(text: &str, name: &str) -> Option<f64> {
    let (_, rest) = text.split_once(&format!("{name}=\""))?;
    rest.split('"').next()?.parse().ok()
}

/// A picture of the sheet beside it.
fn picture(sheet: &Path) -> Outcome {
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"];
    let Some(name) = names.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok()) else {
        println!("no picture: there is no Chromium");
        return Ok(());
    };
    let picture = sheet.with_extension("png");
    let mut command = Command::new(name);
    // A sandbox is of no use for our own page, and is not there in containers.
    command.args(["--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--window-size=2200,12000"]);
    run(command.arg(format!("--screenshot={}", picture.display())).arg(sheet))?;
    println!("{}", picture.display());
    Ok(())
}
