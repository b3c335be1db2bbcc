//! What the views give: exports of trends, the watch list, snapshots, conditions, modes, faults, plants, recordings.

use std::path::Path;

use rungs_tests::browser::{Browser, key};
use server::Access;
use sim::scenario::Scenario;

use super::support::*;

/// Keeps what the page saves as a file, as texts by name: pictures as data URLs.
const CATCH: &str = "window.saved = {}; \
    const made = new Map(), make = URL.createObjectURL.bind(URL); \
    URL.createObjectURL = blob => { const url = make(blob); made.set(url, blob); return url; }; \
    HTMLAnchorElement.prototype.click = function () { \
        const reader = new FileReader(), blob = made.get(this.href), name = this.download; \
        reader.onload = () => { window.saved[name] = reader.result; }; \
        if (blob.type.startsWith('image')) reader.readAsDataURL(blob); else reader.readAsText(blob); \
    };";

fn saved(browser: &Browser, name: &str) -> String {
    browser.wait_for(&format!("window.saved['{name}']"));
    let text = browser.run(&format!("return window.saved['{name}']"));
    text.as_str().unwrap_or_default().to_owned()
}

fn cell(address: &str) -> String {
    format!("document.querySelector(\"#view .cell[data-address='{address}']\")?.textContent")
}

/// Types into the field behind a label of the run view, and presses Enter.
fn fill(browser: &Browser, selector: &str, text: &str) {
    browser.click(selector);
    browser.keys(text);
}

#[test]
fn a_trend_is_exported_as_it_is_drawn() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "trend");
    browser.run(CATCH);
    for (typed, address) in [("T4:0.ACC", "T4:0.ACC"), ("HORN", "O:0.0/1")] {
        browser.click("#view form input");
        browser.run("document.querySelector('#view form input').value = ''");
        browser.keys(&format!("{typed}{}", key::ENTER));
        browser.wait_for(&format!(
            "[...document.querySelectorAll('#view tbody th')].some(one => one.textContent === '{address}')"
        ));
    }
    for (address, value) in [("I:0.0/1", 1), ("I:0.0/2", 1)] {
        api(&browser, "write", &format!("{{address: '{address}', value: {value}}}"));
    }
    api(&browser, "control", "{do: 'scan', count: 2}");
    api(&browser, "write", "{address: 'I:0.0/0', value: 1}");
    api(&browser, "control", "{do: 'scan', count: 4}");
    browser.wait_for("document.querySelector('#view tbody .now').textContent === '3'");
    browser.click("#view button[title='Save as a table']");
    // Scan 1 passes no time; in scan 3 the button is pressed, the horn sounds and the timer begins.
    let table = "\"time_s\",\"T4:0.ACC\",\"O:0.0/1\"\n0,0,0\n0.02,0,1\n0.03,1,1\n0.04,2,1\n0.05,3,1\n";
    assert_eq!(saved(&browser, "trend.csv"), table);
    // The picture is the chart: of its size, and not empty.
    browser.click("#view button[title='Save as a picture']");
    let picture = saved(&browser, "trend.png");
    assert!(picture.starts_with("data:image/png;base64,"), "{picture:.40}");
    let seen = browser.run(
        "return new Promise(done => { const image = new Image(); image.onload = () => { \
            const canvas = document.createElement('canvas'); canvas.width = image.width; canvas.height = image.height; \
            const context = canvas.getContext('2d'); context.drawImage(image, 0, 0); \
            const bytes = context.getImageData(0, 0, image.width, image.height).data, colours = new Set(); \
            for (let i = 0; i < bytes.length; i += 4) colours.add(bytes[i] << 16 | bytes[i + 1] << 8 | bytes[i + 2]); \
            const chart = document.querySelector('#view canvas'); \
            done([image.width === chart.width && image.height === chart.height, colours.has(0x0b57b0), colours.has(0xb3261e)]); \
        }; image.src = window.saved['trend.png']; })",
    );
    assert_eq!(seen, serde_json::json!([true, true, true]), "size and the colours of both lines");
    // The cursor reads values at its place, by keys too: 30 s wide, the end is now.
    assert!(browser.is("document.querySelector('#view tbody .at').textContent === ''"));
    browser.run("document.querySelector('#view canvas').focus()");
    browser.keys(key::RIGHT);
    browser.wait_for("document.querySelector('#view tbody .at').textContent === '3'");
    browser.keys(key::LEFT);
    browser.wait_for("document.querySelector('#view tbody .at').textContent === '–'");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn the_watch_list_is_kept_and_values_take_every_radix() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "watch");
    for name in ["T4:0.PRE", "HORN"] {
        browser.click("#view form input");
        browser.keys(&format!("{name}{}", key::ENTER));
        let address = if name == "HORN" { "O:0.0/1" } else { name };
        browser.wait_for(&format!("{} === '{}'", cell(address), if name == "HORN" { "0" } else { "300" }));
    }
    // It is still there when the page comes again, with symbols.
    browser.go("about:blank");
    show(&browser, &page, "watch");
    browser.wait_for(&format!("{} === '300'", cell("T4:0.PRE")));
    assert_eq!(browser.text("#view tbody tr:nth-child(2) .symbol"), "HORN");
    browser.click("#view .cell[data-address='T4:0.PRE']");
    browser.keys(&format!("1F4h{}", key::ENTER));
    browser.wait_for(&format!("{} === '500'", cell("T4:0.PRE")));
    browser.click("#view button[title='Remove O:0.0/1']");
    browser.wait_for("document.querySelectorAll('#view tbody tr').length === 1");
    // A whole timer stands for its members.
    browser.click("#view form input");
    browser.keys(&format!("T4:1{}", key::ENTER));
    browser.wait_for("[...document.querySelectorAll('#view tbody th')].map((one) => one.textContent).join().endsWith('T4:1/EN,T4:1/TT,T4:1/DN,T4:1.PRE,T4:1.ACC')");
    // Data tables show and take every radix.
    show(&browser, &page, "data/N7");
    browser.click("#view .cell[data-address='N7:0']");
    browser.keys(&format!("1111 0000 0000 0001{}", key::ENTER));
    browser.wait_for(&format!("{} === '-4095'", cell("N7:0")));
    for (radix, text) in
        [("binary", "1111 0000 0000 0001"), ("octal", "170001"), ("hex", "F001h"), ("ascii", "\\\\F0\\\\01")]
    {
        browser.run(&format!(
            "const one = document.querySelector('#view select'); one.value = '{radix}'; one.dispatchEvent(new Event('change'))"
        ));
        browser.wait_for(&format!("{} === '{text}'", cell("N7:0")));
    }
    // Bit by bit, as the vendor shows binary files; keys lead along the bits.
    show(&browser, &page, "data/B3");
    let bit = |number: u8| format!("document.querySelector(\"#view button[title='B3:0/{number}']\")");
    browser.wait_for(&format!("{}?.textContent === '0'", bit(15)));
    browser.run(&format!("{}.focus()", bit(15)));
    for _ in 0..3 {
        browser.keys(key::RIGHT);
    }
    browser.keys(key::ENTER);
    browser.wait_for(&format!("{0}.textContent === '1' && {0}.ariaPressed === 'true'", bit(12)));
    browser.run(
        "const one = document.querySelector('#view select'); one.value = 'hex'; one.dispatchEvent(new Event('change'))",
    );
    browser.wait_for(&format!("{} === '1000h'", cell("B3:0")));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn snapshots_conditions_modes_and_power() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    make_ready(&browser, &page);
    toggle(&browser, "I:0.0/0");
    steps(&browser, 2);
    browser.click("#more");
    browser.wait_for("document.querySelector('#keep')");
    fill(&browser, "#view input[placeholder='before start']", "two scans");
    browser.click("#keep");
    browser.wait_for("document.querySelector('#view button[title=\"Go on from two scans\"]')");
    // As fast as it can until the timer stands at 150, and not a scan more.
    fill(&browser, "#view input[placeholder='T4:0.ACC']", "T4:0.ACC");
    fill(&browser, "#view input[placeholder='100']", "150");
    browser.click("#until");
    browser.wait_for("document.querySelector('#banners').textContent.includes('the condition holds')");
    assert_eq!(scan(&browser), 151.0, "150 ticks of 10 ms after the scan that began");
    // A condition that makes no sense is refused in words, without asking the server.
    fill(&browser, "#view input[placeholder='100']", "many");
    browser.click("#until");
    browser.wait_for("document.querySelector('.banner.wrong')?.textContent.includes('150many is no number')");
    browser.click("#view button[title='Go on from two scans']");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 2 ')");
    let mode = |mode: &str| {
        browser.run(&format!(
            "const one = document.querySelector('#mode'); one.value = '{mode}'; one.dispatchEvent(new Event('change'))"
        ));
        let shown = mode.to_uppercase();
        browser.wait_for(&format!("document.querySelector('#status').textContent.startsWith('{shown} ')"));
    };
    mode("program");
    mode("test");
    mode("run");
    // Power comes back with a first pass: the prescan resets the timer, the seal-in contact drops.
    browser.click("#power-cycle");
    steps(&browser, 1);
    show(&browser, &page, "timers");
    browser.wait_for(&format!("{} === '0'", cell("T4:0.ACC")));
    browser.wait_for("document.querySelector('#status').textContent.startsWith('RUN ')");
    // Begin again: nothing is left but the snapshot.
    browser.click("#more");
    browser.wait_for("document.querySelector('#restart')");
    browser.click("#restart");
    browser.wait_for("document.querySelector('#status').textContent.startsWith('PROGRAM · scan 0 ')");
    browser.wait_for("document.querySelector('#view button[title=\"Go on from two scans\"]')");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_fault_shows_its_rung_its_cause_and_the_way_on() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    make_ready(&browser, &page);
    toggle(&browser, "I:0.0/0");
    steps(&browser, 2);
    show(&browser, &page, "ladder/2");
    browser.wait_for("document.querySelector('svg.rung text.live')");
    // The preset is edited where it stands, to something a controller faults at.
    let live = "svg.rung g[data-i='1'] text.live";
    browser.wait_for(&format!("document.querySelector(\"{live}\").textContent === '300'"));
    browser.click(live);
    browser.wait_for("document.activeElement.matches('input.inplace')");
    browser.keys(&format!("-5{}", key::ENTER));
    browser.wait_for(&format!("document.querySelector(\"{live}\").textContent === '-5'"));
    browser.click("#step");
    browser.wait_for("document.querySelector('.banner.fault')");
    browser.click("#fault-show");
    browser.wait_for("document.querySelector('#view svg.rung')");
    let said = browser.text("#view");
    for words in
        ["0034", "negative timer preset", "LAD 2 - MAIN rung 1", "Preset or accumulator of a timer is below zero"]
    {
        assert!(said.contains(words), "{words}: {said}");
    }
    browser.wait_for("[...document.querySelectorAll('#view text.live')].some(one => one.textContent === '-5')");
    assert!(browser.is("document.querySelector('#mode').value === 'fault'"));
    browser.screenshot("workbench-fault");
    // Back before it: the fault is gone, the value is still wrong.
    browser.click("#fault-back");
    browser.wait_for(
        "!document.querySelector('.banner.fault') && document.querySelector('#status').textContent.includes('scan 2 ')",
    );
    assert_eq!(browser.text("#view p"), "The controller has no fault.");
    steps_to_fault(&browser);
    // Cleared as it stands it comes back; mended it does not.
    browser.click("#fault-run");
    browser.wait_for("document.querySelector('#status').textContent.startsWith('RUN ')");
    steps_to_fault(&browser);
    api(&browser, "write", "{address: 'T4:0.PRE', value: 300}");
    api(&browser, "write", "{address: 'T4:0.ACC', value: 0}");
    browser.click("#fault-run");
    browser.wait_for("!document.querySelector('.banner.fault')");
    steps(&browser, 3);
    assert!(browser.is("document.querySelector('#status').textContent.startsWith('RUN ')"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

fn steps_to_fault(browser: &Browser) {
    api(browser, "write", "{address: 'T4:0.PRE', value: -5}");
    browser.click("#step");
    browser.wait_for("document.querySelector('.banner.fault') && document.querySelector('#fault-run')");
}

#[test]
fn what_is_recorded_with_forces_says_so_and_replays() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "session");
    browser.run(CATCH);
    browser.click("#record");
    browser.wait_for("document.querySelector('.banner')?.textContent.includes('Recording')");
    // The stop button and the relay are forced healthy, the start button is pressed.
    browser.run("location.hash = 'points'");
    browser.wait_for("document.querySelector('#view').dataset.shown === '#points'");
    for (address, entry) in
        [("I:0.0/1", "Force on I:0.0/1"), ("I:0.0/2", "Force on I:0.0/2"), ("O:0.0/3", "Force on O:0.0/3")]
    {
        browser.click(&format!("button[aria-label='What can be done with {address}']"));
        browser.wait_for("document.querySelector('#menu').matches(':popover-open')");
        browser.run(&format!(
            "[...document.querySelectorAll('#menu [role=menuitem]')].find(one => one.textContent === '{entry}').click()"
        ));
        browser.wait_for(&format!("document.querySelector('.banner.forces')?.textContent.includes('{address} ON')"));
    }
    toggle(&browser, "I:0.0/0");
    steps(&browser, 2);
    // Installed is not enabled: nothing runs yet.
    assert!(browser.is("document.querySelector('#view').textContent.includes('forced ON (disabled)')"));
    assert!(!browser.is("document.querySelector(\".lamp[data-address='O:0.0/1']\").classList.contains('lit')"));
    browser.run("location.hash = 'forces'");
    browser.wait_for("document.querySelector('#view').dataset.shown === '#forces'");
    browser.click("#view .row button");
    browser.wait_for("document.querySelector('.banner.forces')?.textContent.includes('ENABLED')");
    steps(&browser, 3);
    browser.run("location.hash = 'session'");
    browser.wait_for("document.querySelector('#expect')");
    browser.click("#expect");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 5 ')");
    browser.click("#record-stop");
    browser.wait_for("document.querySelector('#view pre').textContent");
    assert_eq!(browser.text(".problems"), "Replayed on a fresh machine: all expectations are met.");
    browser.click("#view button[title='Save as a file']");
    let text = saved(&browser, "recording.toml");
    assert!(text.contains("O:0.0/3 forced ON") && text.contains("note = \"forces enabled\""), "{text}");
    assert!(text.contains("\"O:0.0/1\" = 1"), "the horn is expected: {text}");
    let scenario = Scenario::parse(&text).unwrap_or_else(|why| panic!("{why}\n{text}"));
    let project = project(Path::new(&format!("{EXAMPLES}motor/motor.RSS")));
    let program = sim::Program::compile(&project.main, &sim::Options::default()).expect("runs");
    let report = sim::scenario::play(&scenario, &mut sim::Machine::new(program), Vec::new()).expect("plays");
    assert_eq!((report.failures.len(), report.scans), (0, 5), "{text}");
    assert!(report.checks > 3, "{text}");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_do_more_project_goes_the_same_way() {
    let Some(browser) = Browser::start() else { return };
    let page =
        serve(do_more(Path::new(&format!("{EXAMPLES}filling_domore/filling.txt"))), Some("filling_domore/plant.toml"));
    // The tree has the names of its vendor, and no test mode.
    show(&browser, &page, "controller");
    let tree = browser.text("#tree");
    assert!(tree.contains("Code-Blocks") && tree.contains("Memory") && tree.contains("$Main"), "{tree}");
    assert!(!browser.is("document.querySelector('#mode option[value=test]')"));
    // The plant closes its loop: bottles come while the belt runs, and the counter counts them.
    show(&browser, &page, "session");
    browser.click("#record");
    browser.wait_for("document.querySelector('.banner')?.textContent.includes('Recording')");
    show(&browser, &page, "points");
    toggle(&browser, "X0");
    steps(&browser, 3);
    browser.wait_for("document.querySelector(\".lamp[data-address='Y0']\").classList.contains('lit')");
    let gauges = browser.text("#view .gauges");
    assert!(gauges.contains("belt") && gauges.contains("product"), "{gauges}");
    browser.run("location.hash = 'session'");
    browser.wait_for("document.querySelector('#until')");
    fill(&browser, "#view input[placeholder='T4:0.ACC']", "X3");
    fill(&browser, "#view input[placeholder='100']", "1");
    browser.click("#until");
    browser.wait_for("document.querySelector('#banners').textContent.includes('the condition holds')");
    let seconds = browser.number("document.querySelector('#status').textContent.match(/(\\d+):(\\d+\\.\\d+)/)[2]");
    // 1.4 m at 0.4 m/s, when the front of the bottle comes to the nozzle; the first one is put on at the start.
    assert!((3.0..8.0).contains(&seconds), "the first bottle is at the nozzle after {seconds} s");
    steps(&browser, 2);
    browser.click("#expect");
    browser.click("#record-stop");
    browser.wait_for("document.querySelector('#view pre').textContent");
    assert_eq!(browser.text(".problems"), "Replayed on a fresh machine: all expectations are met.");
    let text = browser.run("return document.querySelector('#view pre').textContent");
    let text = text.as_str().unwrap_or_default();
    assert!(
        text.contains("family = \"do-more\"") && text.contains("\"X3\" = 1"),
        "what the plant did is in it: {text}"
    );
    // Boxes show what runs in them; a contact is toggled where it stands.
    show(&browser, &page, "ladder/1");
    browser.wait_for("document.querySelector('svg.rung g.i')");
    let timer = "[...document.querySelectorAll('svg.rung g.i')].find(one => one.querySelector('title').textContent.startsWith('TMR T0')) \
        ?.querySelector('text.live')?.textContent";
    browser.wait_for(&format!("Number({timer}) >= 2500"));
    let contact = "[...document.querySelectorAll('svg.rung g.i')].find(one => one.querySelector('.hit') && /^STR X0/.test(one.querySelector('title').textContent))";
    browser.wait_for(contact);
    browser.run(&format!("{contact}.focus()"));
    let was = browser.is(&format!("{contact}.matches('.on')"));
    browser.keys(key::ENTER);
    steps(&browser, 1);
    browser.wait_for(&format!("{contact}.matches('.on') === {}", !was));
    browser.keys("b");
    // Source and destination of a MOVE have their values in its box.
    browser.wait_for("[...document.querySelectorAll('g.i')].some((one) => one.querySelector('title')?.textContent.startsWith('MOVE') && one.querySelectorAll('text.live').length === 2)");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn the_batch_plant_fills_boxes_until_the_program_has_counted_them() {
    let Some(browser) = Browser::start() else { return };
    let page = serve(slc(Path::new(&format!("{EXAMPLES}batch/batch.RSS"))), Some("batch/plant.toml"));
    show(&browser, &page, "points");
    toggle(&browser, "I:0.0/0");
    toggle(&browser, "I:0.0/1");
    browser.click("#run");
    // In real time: the feeder runs, its pieces are counted, and the sensor blinks.
    browser.wait_for("document.querySelector(\".lamp[data-address='O:0.0/0']\").classList.contains('lit')");
    browser.wait_for("document.querySelector(\".lamp[data-address='I:0.0/2']\").ariaChecked === 'true'");
    browser.wait_for("document.querySelector('#view .gauges').textContent.includes('feeder')");
    show(&browser, &page, "timers");
    browser
        .run("const one = document.querySelector('#speed'); one.value = '100'; one.dispatchEvent(new Event('change'))");
    browser.wait_for(&format!("Number({}) >= 1", cell("C5:1.ACC")));
    assert!(!browser.is("document.querySelector('.banner.wrong')"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn who_may_only_look_can_change_nothing() {
    let Some(browser) = Browser::start() else { return };
    let page = serve_to(
        slc(Path::new(&format!("{EXAMPLES}motor/motor.RSS"))),
        None,
        Access { read_only: true, ..Access::default() },
    );
    for view in ["ladder/2", "data/B3", "data/T4", "points", "forces", "session", "trend"] {
        show(&browser, &page, view);
        let changing = "[...document.querySelectorAll('#controls *, #view button, #view input, #view [role=switch]')] \
            .filter(one => !one.disabled && /^(Run|Scan|◀ Back|Force|Enable|Remove|Begin|End|Keep|Follow|Write|Restart|Power)/.test(one.textContent))";
        assert_eq!(browser.number(&format!("{changing}.length")), 0.0, "{view}");
        assert!(!browser.is("[...document.querySelectorAll('#view .cell, #view .lamp.input, #view [data-bit]')].some(one => !one.disabled)"), "{view}");
    }
    assert_eq!(browser.text("#controls"), "read-only");
    // A contact tells what it is, and changes nothing.
    show(&browser, &page, "ladder/2");
    browser.wait_for("document.querySelector('svg.rung g.i')");
    browser.run("document.querySelector('svg.rung g.i').focus()");
    browser.keys(key::ENTER);
    browser.wait_for("document.querySelector('#menu').matches(':popover-open')");
    assert!(!browser.is("/Toggle|Force|Edit|Trend/.test(document.querySelector('#menu').textContent)"));
    browser.run(
        "[...document.querySelectorAll('#menu [role=menuitem]')].find((one) => /^Cross/.test(one.textContent)).click()",
    );
    browser.wait_for("!document.querySelector('#detail').hidden");
    assert!(!browser.is("/Force|Write|Trend/.test(document.querySelector('#detail').textContent)"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}
