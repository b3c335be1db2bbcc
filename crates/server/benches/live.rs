//! What live updates cost: processor time of a server with no browser, with one and with fifty, each showing sixty
//! rungs of a program that runs in real time. The run without a browser is the baseline.

use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use futures_util::{SinkExt, StreamExt};
use ladder::{Family, Project};
use server::engine::{self, Pace};
use server::view::SlcProgram;
use server::workbench::{Change, ModeChange, Slc, Workbench};
use server::{Access, serve};
use tokio_tungstenite::tungstenite::Message;

/// Rungs of the program, and of one screen.
const RUNGS: usize = 200;
const SHOWN: u16 = 60;

/// How long each case is watched.
const TIME: Duration = Duration::from_secs(5);

/// Contacts, timers that restart themselves and counters, so that something changes on every screen.
fn ladder() -> Vec<String> {
    let rung = |number: usize| match number % 4 {
        0 => format!("XIO T4:{}/DN TON T4:{} 0.01 {} 0", number / 4, number / 4, 20 + number),
        1 => format!("XIC T4:{}/DN CTU C5:{} 30000 0", number / 4, number / 4),
        2 => format!(
            "BST XIC T4:{}/TT NXB XIC B3:{}/0 BND XIO B3:{}/1 OTE B3:{}/2",
            number / 4,
            number / 4,
            number / 4,
            number / 4
        ),
        _ => format!("ADD C5:{}.ACC N7:{} N10:{}", number / 4, number / 4, number / 4),
    };
    (0..RUNGS).map(rung).collect()
}

/// Processor time of this process so far, in seconds; `None` where the system does not tell.
fn processor() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let mut fields = stat.rsplit(')').next()?.split_whitespace().skip(11);
    let ticks: u64 = fields.next()?.parse::<u64>().ok()? + fields.next()?.parse::<u64>().ok()?;
    // Ticks of 10 ms on every Linux that rungs runs on.
    Some(ticks as f64 / 100.0)
}

/// A browser as far as the server sees it: says what it shows and reads what it is told.
async fn browse(at: SocketAddr, told: Arc<AtomicU64>) {
    let (mut socket, _) = tokio_tungstenite::connect_async(format!("ws://{at}/api/live")).await.expect("upgrades");
    let rungs: Vec<(u16, u16)> = (0..SHOWN).map(|rung| (2, rung)).collect();
    let values: Vec<String> =
        (0..SHOWN / 4).flat_map(|at| [format!("T4:{at}.ACC"), format!("C5:{at}.ACC"), format!("N10:{at}")]).collect();
    let see = serde_json::json!({"rungs": rungs, "values": values}).to_string();
    socket.send(Message::Text(see.into())).await.expect("sends");
    while let Some(Ok(message)) = socket.next().await {
        if message.is_text() {
            told.fetch_add(1, Ordering::Relaxed);
        }
    }
}

fn main() {
    // `cargo test` runs benchmarks too, to see that they start.
    if std::env::args().any(|argument| argument == "--test") {
        return;
    }
    let family = Family::MicroLogix1400;
    let rungs =
        ladder().iter().map(|text| convert::slc::rung::parse_rung(text, Some(family)).expect("reads")).collect();
    let image = sim::inline_image(family, vec![(2, rungs)]);
    let program =
        sim::Program::compile(&image, &sim::Options { inline: true, ..Default::default() }).expect("compiles");
    let machine = Slc::new(sim::Machine::new(program), &image);
    let view = SlcProgram::new("bench".to_owned(), Project { main: image, ..Project::default() }, Vec::new());
    let mut bench = Workbench::new(Box::new(machine));
    bench.change(Change::Mode(ModeChange::Run)).expect("runs");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().expect("a runtime");
    runtime.block_on(async {
        let listener = tokio::net::TcpListener::bind("127.0.0.1:0").await.expect("a free port");
        let at = listener.local_addr().expect("bound");
        let engine = engine::start(bench).expect("a thread");
        engine.ask(|engine| engine.set_pace(Pace::RealTime(1.0))).await.expect("takes it");
        tokio::spawn(serve(listener, engine.clone(), Arc::new(view), Access::default(), std::future::pending()));
        let told = Arc::new(AtomicU64::new(0));
        let mut browsers = 0;
        let mut baseline = 0.0;
        println!("{RUNGS} rungs, {SHOWN} shown by each browser, scans of 10 ms in real time; browsers run in this process too");
        println!("{:>9} {:>12} {:>16} {:>22} {:>10}", "browsers", "of one core", "over baseline", "updates per second each", "scans/s");
        for wanted in [0, 1, 50] {
            while browsers < wanted {
                tokio::spawn(browse(at, Arc::clone(&told)));
                browsers += 1;
            }
            tokio::time::sleep(Duration::from_millis(500)).await;
            let scans = async || engine.ask(|engine| engine.bench.state().machine.controller().scans()).await.expect("answers");
            let (start, used, count, first) = (Instant::now(), processor(), told.load(Ordering::Relaxed), scans().await);
            tokio::time::sleep(TIME).await;
            let seconds = start.elapsed().as_secs_f64();
            let share = processor().zip(used).map_or(f64::NAN, |(now, then)| (now - then) / seconds * 100.0);
            if wanted == 0 {
                baseline = share;
            }
            let each = (told.load(Ordering::Relaxed) - count) as f64 / seconds / f64::from(wanted.max(1));
            let rate = (scans().await - first) as f64 / seconds;
            println!("{wanted:>9} {share:>10.1} % {:>14.1} % {each:>22.1} {rate:>10.1}", share - baseline);
        }
    });
}
