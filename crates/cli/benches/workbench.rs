//! What the workbench costs and how smooth it is, as people meet it: the command as a process, a real Chromium, and
//! the largest program of the corpus where the corpus is.
//!
//! * from asking for the page to its first rung, beside the time for a page without a program;
//! * the longest time between two pictures while a whole program file scrolls past;
//! * processor time of the server with no browser, with one and with fifty that show sixty rungs each.

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use futures_util::{SinkExt, StreamExt};
use rungs_tests::browser::Browser;
use serde_json::{Value, json};
use tokio_tungstenite::tungstenite::Message;

/// Rungs a browser shows in the measurement of live updates: a tall screen.
const SHOWN: usize = 60;

/// How long each case of live updates is watched.
const TIME: Duration = Duration::from_secs(5);

/// Pixels that the view moves from one picture to the next: some twelve screens a second.
const STEP: usize = 180;

struct Server {
    child: Child,
    /// `127.0.0.1:8500`.
    at: String,
}

impl Server {
    fn start(program: &Path) -> Server {
        let mut command = Command::new(env!("CARGO_BIN_EXE_rungs"));
        command.arg("serve").arg(program).args(["--port", "0", "--accept-unsupported"]);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().expect("the command starts");
        let mut line = String::new();
        BufReader::new(child.stdout.take().expect("its output")).read_line(&mut line).expect("an address");
        let at = line.trim().trim_start_matches("http://").trim_end_matches('/').to_owned();
        assert!(!at.is_empty(), "{} is not served", program.display());
        Server { child, at }
    }

    /// Processor time so far, in seconds; `None` where the system does not tell.
    fn processor(&self) -> Option<f64> {
        let stat = std::fs::read_to_string(format!("/proc/{}/stat", self.child.id())).ok()?;
        let mut fields = stat.rsplit(')').next()?.split_whitespace().skip(11);
        let ticks: u64 = fields.next()?.parse::<u64>().ok()? + fields.next()?.parse::<u64>().ok()?;
        // Ticks of 10 ms on every Linux that rungs runs on.
        Some(ticks as f64 / 100.0)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// A program of so many rungs in which something always changes, as a project file.
fn long_program(rungs: usize) -> PathBuf {
    let mut text = "START Bul.1766\n\nPROJECT \"LONG\"\n  2  \"MAIN\"\n\nLADDER 2\n".to_owned();
    for number in 0..rungs {
        let at = number / 4;
        let rung = match number % 4 {
            0 => format!("XIO T4:{at}/DN TON T4:{at} 0.01 {} 0", 20 + number % 500),
            1 => format!("XIC T4:{at}/DN CTU C5:{at} 30000 0"),
            2 => format!(
                "BST XIC T4:{at}/TT NXB XIC B3:{at}/0 BND XIO B3:{at}/1 BST OTE B3:{at}/2 NXB OTE B3:{at}/3 BND"
            ),
            _ => format!("GEQ C5:{at}.ACC 0 BST ADD C5:{at}.ACC N7:{at} N10:{at} NXB MOV N10:{at} N11:{at} BND"),
        };
        text.push_str(&format!("% Rung: {number} %\nSOR {rung} EOR\n"));
        if number % 10 == 0 {
            text.push_str(
                "% TITLE/RUNG DESCRIPTION\nTITLE: A part\nRUNG DESCRIPTION: What this part of the program does. %\n",
            );
        }
    }
    let folder = std::env::temp_dir().join(format!("rungs-bench-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let (source, built) = (folder.join("long.SLC"), folder.join("long.RSS"));
    std::fs::write(&source, text).expect("writes");
    let mut build = Command::new(env!("CARGO_BIN_EXE_rungs"));
    let done = build.arg("build").arg(&source).arg("-o").arg(&built).arg("--force").output().expect("starts");
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    built
}

/// The largest program of the corpus.
fn largest() -> Option<PathBuf> {
    let near = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/corpus");
    let corpus = std::env::var_os("RUNGS_CORPUS").map_or(near, PathBuf::from);
    let found = ["acd/LANLOGIX_BR.RSS", "LANLOGIX_BR.RSS"].map(|name| corpus.join(name));
    found.into_iter().find(|path| path.is_file())
}

/// Program files by their numbers of rungs, largest first: rungs and number.
fn routines(browser: &Browser) -> Vec<(u64, u64)> {
    browser.run(
        "window.asked = null; fetch('/api/project').then((one) => one.json()).then((one) => { window.asked = one; })",
    );
    browser.wait_for("window.asked");
    let project = browser.run("return window.asked.routines.map((one) => [one.rungs, one.number])");
    let mut routines: Vec<(u64, u64)> = serde_json::from_value(project).expect("numbers");
    routines.sort_by(|a, b| b.cmp(a));
    routines
}

/// Milliseconds from asking for a page until something is there; the middle one of five.
fn opens(browser: &Browser, page: &str, there: &str) -> f64 {
    let mut all: Vec<f64> = Vec::new();
    for _ in 0..5 {
        browser.go("about:blank");
        let start = Instant::now();
        browser.go(page);
        while !browser.is(there) {
            std::thread::sleep(Duration::from_millis(2));
        }
        all.push(start.elapsed().as_secs_f64() * 1000.0);
    }
    all.sort_by(f64::total_cmp);
    all[2]
}

/// Scrolls a whole program file past and prints how long pictures took.
fn scroll(browser: &Browser, server: &Server, (rungs, routine): (u64, u64)) {
    browser.go("about:blank");
    browser.go(&format!("http://{}/#ladder/{routine}", server.at));
    browser.wait_for("document.querySelector('.rung svg')");
    browser.run(&format!(
        "const view = document.querySelector('#view'); const times = []; let last = performance.now(); window.done = null;
         requestAnimationFrame(function next() {{
           const now = performance.now(); times.push(now - last); last = now; view.scrollTop += {STEP};
           if (view.scrollTop + view.clientHeight < view.scrollHeight - 1) requestAnimationFrame(next);
           else {{ times.sort((a, b) => b - a); window.done = times; }}
         }});"
    ));
    wait(browser);
    let frames = browser.number("window.done.length");
    let longest = || {
        let nth = |at: &str| browser.number(&format!("window.done[Math.min({at}, window.done.length - 1)]"));
        (
            nth("0"),
            nth("9"),
            nth("window.done.length >> 1"),
            browser.number("window.done.filter((time) => time > 100).length"),
        )
    };
    let (worst, tenth, median, over) = longest();
    browser.wait_for("document.querySelector('.rung-place:last-of-type svg')");
    let drawn = browser.number("document.querySelectorAll('.rung-place svg').length");
    // What other programs of this machine cost: as many pictures while nothing moves.
    browser.run(&format!(
        "const times = []; let last = performance.now(); window.done = null;
         requestAnimationFrame(function next() {{
           const now = performance.now(); times.push(now - last); last = now;
           if (times.length < {frames}) requestAnimationFrame(next); else {{ times.sort((a, b) => b - a); window.done = times; }}
         }});"
    ));
    wait(browser);
    let still = longest();
    println!(
        "scroll {rungs} rungs, {frames:.0} pictures; {drawn:.0} rungs stay drawn; beside it as many pictures while nothing moves:"
    );
    for (what, (worst, tenth, median, over)) in [("scrolling", (worst, tenth, median, over)), ("still", still)] {
        println!(
            "{what:>10} median {median:.1} ms, tenth longest {tenth:.0} ms, longest {worst:.0} ms, over 100 ms: {over:.0}"
        );
    }
}

/// Waits until pictures have been counted.
fn wait(browser: &Browser) {
    let start = Instant::now();
    while !browser.is("window.done") && start.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(100));
    }
}

/// A browser as far as the server sees it: says what it shows and reads what it is told.
async fn browse(at: String, see: String, told: Arc<AtomicU64>) {
    let (mut socket, _) = tokio_tungstenite::connect_async(format!("ws://{at}/api/live")).await.expect("upgrades");
    socket.send(Message::Text(see.into())).await.expect("sends");
    while let Some(Ok(message)) = socket.next().await {
        if message.is_text() {
            told.fetch_add(1, Ordering::Relaxed);
        }
    }
}

/// What a page that shows the first rungs of a program file follows.
fn seen(browser: &Browser, routine: u64) -> Value {
    browser.run(&format!(
        "window.asked = null; fetch('/api/routines/{routine}/rungs?count={SHOWN}').then((one) => one.json()).then((all) => {{
           const values = all.flatMap((one) => one.instructions).flatMap((one) => [...one.values.map((value) => value.address), one.bit]);
           window.asked = {{ rungs: all.map((one) => [{routine}, one.rung]), values: [...new Set(values.filter(Boolean))] }};
         }})"
    ));
    browser.wait_for("window.asked");
    browser.run("return window.asked")
}

fn live(browser: &Browser, server: &Server, routine: u64) {
    let see = seen(browser, routine);
    let count = |key: &str| see[key].as_array().map_or(0, Vec::len);
    println!(
        "live updates, real time with scans of 10 ms, {} rungs and {} values shown by each:",
        count("rungs"),
        count("values")
    );
    browser.run(
        "window.asked = null; fetch('/api/control', { method: 'POST', headers: { 'Content-Type': 'application/json' },
         body: '{\"do\": \"run\", \"speed\": 1}' }).then(() => { window.asked = true; })",
    );
    browser.wait_for("window.asked");
    // The page itself must not be one of those that look.
    browser.go("about:blank");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    runtime.block_on(async {
        let told = Arc::new(AtomicU64::new(0));
        let (mut browsers, mut baseline) = (0, f64::NAN);
        println!("{:>10} {:>14} {:>16} {:>20}", "browsers", "of one core", "over the first", "updates/s for each");
        for wanted in [0, 1, 50] {
            while browsers < wanted {
                tokio::spawn(browse(server.at.clone(), json!(see).to_string(), Arc::clone(&told)));
                browsers += 1;
            }
            tokio::time::sleep(Duration::from_secs(1)).await;
            let (start, used, first) = (Instant::now(), server.processor(), told.load(Ordering::Relaxed));
            tokio::time::sleep(TIME).await;
            let seconds = start.elapsed().as_secs_f64();
            let share = server.processor().zip(used).map_or(f64::NAN, |(now, then)| (now - then) / seconds * 100.0);
            if wanted == 0 {
                baseline = share;
            }
            let each = (told.load(Ordering::Relaxed) - first) as f64 / seconds / f64::from(wanted.max(1));
            println!("{wanted:>10} {share:>12.1} % {:>14.1} % {each:>20.1}", share - baseline);
        }
    });
}

fn measure(browser: &Browser, name: &str, program: &Path) {
    let server = Server::start(program);
    println!("\n{name}");
    let page = format!("http://{}/", server.at);
    let plain = opens(browser, &format!("{page}assets/style.css"), "document.body.textContent");
    let first = opens(browser, &page, "document.querySelector('.rung svg')");
    println!(
        "first rung after {first:.0} ms (goal 1000), {:.1} times a page of plain text, {plain:.0} ms",
        first / plain
    );
    let routines = routines(browser);
    scroll(browser, &server, routines[0]);
    let shown = routines.iter().rev().find(|(rungs, _)| *rungs >= SHOWN as u64).unwrap_or(&routines[0]);
    live(browser, &server, shown.1);
}

fn main() {
    // `cargo test` runs benchmarks too, to see that they start.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let Some(browser) = Browser::start() else { return };
    match largest() {
        Some(program) => measure(&browser, "LANLOGIX_BR", &program),
        None => println!("skipped: corpus not present"),
    }
    let long = long_program(1000);
    measure(&browser, "a program file of 1,000 rungs in which everything moves", &long);
    let _ = long.parent().map(std::fs::remove_dir_all);
}
