//! Two programs side by side in a real browser: both ladders, one set of controls, and the way to a difference.

#[path = "../../crates/server/tests/support/pair.rs"]
mod two;

use rungs_tests::axe;
use rungs_tests::browser::Browser;
use rungs_tests::served;
use server::workbench::Workbench;
use server::{Access, engine};
use two::Two;

/// The seal-in contact inverted.
const SEAL: (&str, &str) = ("STR\tX0\nOR\tC0\n", "STR\tX0\nORN\tC0\n");

/// Serves an example beside its migration until the tests end; answers the address of its page.
fn serve(example: &str, changes: &[(&str, &str)], access: Access) -> String {
    let two = Two::of(example, changes);
    let pair = two.pair();
    let (program, pages) = two.views(&pair);
    served::until_the_end(move |listener| async {
        let engine = engine::start(Workbench::new(Box::new(pair))).expect("a thread");
        server::serve_pair(listener, engine, program, pages, access, std::future::pending()).await
    })
}

fn open(browser: &Browser, page: &str) {
    browser.go(page);
    browser
        .wait_for("document.querySelectorAll('.pane').length === 2 && document.querySelector('#status').textContent");
    for pane in [1, 2] {
        browser.wait_for(&format!("document.querySelector('.pane:nth-child({pane}) .rung svg g.i')"));
    }
}

/// A script finds the section of a rung in one of the panes.
fn rung(pane: usize, number: usize) -> String {
    format!("document.querySelector('.pane:nth-child({pane}) .rung-place[data-rung=\"{number}\"]')")
}

fn row(original: &str) -> String {
    format!(
        "[...document.querySelectorAll('.pair-values tbody tr')].find((row) => row.querySelector('th button').textContent === '{original}')"
    )
}

fn scan(browser: &Browser) -> f64 {
    browser.number("document.querySelector('#status').textContent.match(/scan (\\d+)/)[1]")
}

#[test]
fn one_set_of_controls_drives_both() {
    let Some(browser) = Browser::start() else { return };
    let page = serve("motor/motor.RSS", &[], Access::default());
    browser.resize(1400, 900);
    open(&browser, &page);
    assert!(browser.text("#difference").contains("Nothing has been scanned"));
    browser.click("#step");
    browser
        .wait_for("document.querySelector('#difference').textContent.includes('No difference in the 1 scan so far')");
    // An input is toggled in the ladder of either side and changes on both.
    for (pane, contact) in [(1, "I:0.0/1"), (2, "X2"), (2, "X0")] {
        let node = format!(
            "[...document.querySelectorAll('.pane:nth-child({pane}) g.i')].find((it) => \
             it.querySelector('title').textContent.includes('{contact}'))"
        );
        browser.wait_for(&node);
        browser.run(&format!("({node}).dispatchEvent(new MouseEvent('click', {{bubbles: true}}))"));
        let number = if pane == 1 { contact.to_owned() } else { format!("I:0.0/{}", &contact[1..]) };
        let cells = format!("[...({}).querySelectorAll('.cell')].map((it) => it.textContent).join()", row(&number));
        browser.wait_for(&format!("{cells} === '1,1'"));
    }
    browser.click("#step");
    for pane in [1, 2] {
        browser.wait_for(&format!("document.querySelector('.pane:nth-child({pane}) .rung svg g.i.on')"));
        browser.wait_for(&format!("document.querySelector('.pane:nth-child({pane}) .rung svg path.w.on')"));
    }
    let horn = format!("[...({}).querySelectorAll('.cell')].map((it) => it.textContent).join()", row("O:0.0/1"));
    browser.wait_for(&format!("{horn} === '1,1'"));
    browser.screenshot("workbench-pair");
    // Back on both.
    browser.click("#back");
    browser.wait_for(&format!("{horn} === '0,0'"));
    assert_eq!(scan(&browser), 1.0);
    // One side alone cannot be changed, and says so.
    let refused = browser.run(
        "return fetch('/api/other/write', {method: 'POST', headers: {'Content-Type': 'application/json'}, \
         body: JSON.stringify({address: 'C17', value: 1})}).then((it) => it.status)",
    );
    assert_eq!(refused, serde_json::json!(409));
    assert!(browser.complaints().iter().all(|line| line.contains("409")));
}

#[test]
fn rungs_that_belong_together_are_level_and_lead_to_each_other() {
    let Some(browser) = Browser::start() else { return };
    let page = serve("motor/motor.RSS", &[], Access::default());
    browser.resize(1400, 900);
    open(&browser, &page);
    // Rung 0 of the original is rung 5 of the converted program, and stands beside it.
    for (original, converted) in [(0, 5), (3, 8), (7, 12)] {
        let tops = |pane, number| format!("{}.getBoundingClientRect().top", rung(pane, number));
        browser.wait_for(&format!("Math.abs({} - {}) < 3", tops(1, original), tops(2, converted)));
    }
    assert!(browser.text(".pane:nth-child(2) .pair-label:has(+ [data-rung='0'])").contains("added by the conversion"));
    // A click leads to the counterpart, in either direction.
    let lead = |pane: usize, number: usize| {
        format!(".pane:nth-child({pane}) .pair-label:has(+ [data-rung='{number}']) button")
    };
    assert_eq!(browser.text(&lead(1, 7)), "→ $Main rung 13");
    browser.run(&format!("document.querySelector(\"{}\").click()", lead(1, 7)));
    let seen = |pane: usize, number: usize| {
        let body = format!("document.querySelector('.pane:nth-child({pane}) .pane-body').getBoundingClientRect()");
        let rung = rung(pane, number);
        format!(
            "{rung}.classList.contains('goal') && {rung}.getBoundingClientRect().top < {body}.bottom && {rung}.getBoundingClientRect().bottom > {body}.top"
        )
    };
    browser.wait_for(&seen(2, 12));
    browser.run(&format!("{}.click()", rung(2, 6)));
    browser.wait_for(&seen(1, 1));
    // Narrow, one stands above the other, and it still leads there.
    browser.resize(480, 900);
    browser.wait_for("document.querySelectorAll('.pane')[1].getBoundingClientRect().top > document.querySelectorAll('.pane')[0].getBoundingClientRect().bottom");
    browser.wait_for(&format!("{}?.querySelector('svg')", rung(1, 0)));
    browser.run(&format!("document.querySelector(\"{}\").click()", lead(1, 4)));
    browser.wait_for(&seen(2, 9));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_search_leads_to_the_difference() {
    let Some(browser) = Browser::start() else { return };
    let page = serve("motor/motor.RSS", &[SEAL], Access::default());
    browser.resize(1400, 1000);
    open(&browser, &page);
    browser.click("#prove");
    browser.wait_for("document.querySelector('#verdict strong')?.textContent === 'different'");
    browser.wait_for("document.querySelector('.tape').offsetHeight > 0 && document.querySelector('#play')");
    let told = browser.text("#verdict p:nth-of-type(2)");
    let scans: f64 = told.split("after ").nth(1).and_then(|rest| rest.split(' ').next()?.parse().ok()).expect("scans");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 0 ')");
    // Scan by scan; then in one go.
    browser.click("#tape-step");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 1 ')");
    browser.click("#tape-difference");
    browser.wait_for("document.querySelector('#difference').classList.contains('differs')");
    assert_eq!(scan(&browser), scans);
    let difference = browser.text("#difference");
    let what = told.split(", after").next().expect("what differs");
    assert!(difference.contains(what) && difference.contains(&format!("in scan {scans} ")), "{difference} / {told}");
    // It is marked in words, by a sign and by a bar, and stands first.
    let first = "document.querySelector('.pair-values tbody tr')";
    browser.wait_for(&format!(
        "{first}.classList.contains('differs') && {first}.querySelector('.mark').textContent === '≠'"
    ));
    browser.screenshot("workbench-pair-difference");
    for dark in [false, true] {
        browser.dark(dark);
        axe::check(&browser, "a difference");
    }
    browser.screenshot("workbench-pair-dark");
    browser.dark(false);
    browser.click("#difference-rung");
    browser.wait_for("document.querySelectorAll('.pane .goal').length === 2");
    // Back on the tape, both are equal again; nothing is changed by hand meanwhile.
    browser.click("#back");
    browser.wait_for("!document.querySelector('#difference').classList.contains('differs')");
    browser.click(".pair-values tbody td .cell");
    browser.wait_for("document.querySelector('.banner.wrong')?.textContent.includes('tape')");
    browser.click("#tape-leave");
    browser.wait_for("document.querySelector('.tape').offsetHeight === 0");
    assert!(browser.complaints().iter().all(|line| line.contains("409")));
}

#[test]
fn a_search_that_finds_nothing_says_what_it_covered() {
    let Some(browser) = Browser::start() else { return };
    let page = serve("traffic_light/traffic_light.RSS", &[], Access::default());
    browser.resize(1400, 1000);
    open(&browser, &page);
    browser.run("document.querySelector('.pair-search input:nth-of-type(1)').focus()");
    browser.run("const it = document.querySelectorAll('.pair-search input')[1]; it.value = 3000");
    browser.click("#prove");
    browser.wait_for("document.querySelector('#verdict strong')");
    assert_eq!(browser.text("#verdict strong"), "no difference found within this coverage");
    assert!(browser.text(".coverage").contains("rung conditions: "), "{}", browser.text(".coverage"));
    browser.run("document.querySelector('#verdict details').open = true");
    assert!(browser.text("#verdict pre").contains("not exercised by any run"));
    browser.run("document.querySelector('#verdict').scrollIntoView()");
    browser.screenshot("workbench-pair-verdict");
    axe::check(&browser, "a verdict");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn both_fit_three_widths() {
    let Some(browser) = Browser::start() else { return };
    let page = serve("motor/motor.RSS", &[SEAL], Access::default());
    for (width, height) in [(1400, 900), (820, 1100), (480, 900)] {
        browser.resize(width, height);
        open(&browser, &page);
        if width == 1400 {
            for contact in ["I:0.0/1", "I:0.0/2"] {
                browser.run(&format!("({}).querySelector('.cell').click()", row(contact)));
                let lit = format!("({}).querySelector('.cell').textContent === '1'", row(contact));
                browser.wait_for(&lit);
            }
            browser.click("#step");
        }
        browser.wait_for("document.querySelector('.pair-values tr.differs')");
        browser.screenshot(&format!("workbench-pair-{width}"));
        assert!(
            browser.is("document.documentElement.scrollWidth <= innerWidth + 1"),
            "wider than the window at {width}"
        );
        browser.run("document.querySelector('.pair-values').scrollIntoView()");
        browser.screenshot(&format!("workbench-pair-values-{width}"));
        axe::check(&browser, &format!("two programs at {width}"));
    }
    browser.resize(1280, 900);
    browser.run("document.documentElement.style.fontSize = '200%'");
    browser.wait_for("document.querySelector('.rung svg')");
    assert!(browser.is("document.documentElement.scrollWidth <= innerWidth + 1"), "text of twice the size");
    browser.screenshot("workbench-pair-large-text");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn who_may_only_look_sees_both() {
    let Some(browser) = Browser::start() else { return };
    let page = serve("motor/motor.RSS", &[], Access { read_only: true, ..Access::default() });
    open(&browser, &page);
    assert!(
        !browser
            .is("document.querySelector('#prove') || document.querySelector('.pair-values .cell:not(output):enabled')")
    );
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// A scenario is stepped through on one program as well, in every view.
#[test]
fn one_program_plays_a_tape_too() {
    let Some(browser) = Browser::start() else { return };
    let two = Two::of("motor/motor.RSS", &[]);
    let program = sim::Program::compile(&two.original.main, &sim::Options::default()).expect("runs");
    let machine = server::workbench::Slc::new(sim::Machine::new(program), &two.original.main);
    let mut bench = Workbench::new(Box::new(machine));
    let text =
        "name = \"start\"\nprogram = \"motor.RSS\"\nscan = \"10ms\"\n[[step]]\nset = { \"I:0.0/1\" = 1 }\nscans = 4\n";
    let tape = server::workbench::Tape::read(text, bench.initial()).expect("reads");
    bench.play(tape).expect("plays");
    let view = server::view::SlcProgram::new("motor.RSS".to_owned(), two.original, Vec::new());
    let page = served::until_the_end(move |listener| async {
        let engine = engine::start(bench).expect("a thread");
        server::serve(listener, engine, std::sync::Arc::new(view), Access::default(), std::future::pending()).await
    });
    browser.go(&format!("{page}#points"));
    browser.wait_for("document.querySelector('.tape')?.offsetHeight > 0");
    browser.click("#tape-step");
    browser.wait_for("document.querySelector('.tape').textContent.includes('scan 1 of 4')");
    browser.click("#tape-end");
    browser.wait_for("document.querySelector('#banners').textContent.includes('the tape has ended')");
    browser.click("#tape-start");
    browser.wait_for("document.querySelector('.tape').textContent.includes('scan 0 of 4')");
    browser.click("#tape-leave");
    browser.wait_for("document.querySelector('.tape').offsetHeight === 0");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}
