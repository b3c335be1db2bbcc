//! The workbench in a real browser: run, force, step back, edit, trend, record, replay.

mod access;
mod support;
mod views;

use std::path::Path;

use rungs_tests::browser::{Browser, key};
use sim::scenario::Scenario;

use support::*;

#[test]
fn the_motor_starts_and_every_scan_can_be_gone_back() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    make_ready(&browser, &page);
    steps(&browser, 2);
    toggle(&browser, "I:0.0/0");
    steps(&browser, 1);
    // The start button lights the rung, and the warning timer begins.
    show(&browser, &page, "ladder/2");
    browser.wait_for("document.querySelector('.rung svg g.i.on')");
    browser.wait_for("document.querySelector('.rung svg path.w.on')");
    browser.screenshot("workbench-ladder");
    let lit = "document.querySelectorAll('.rung svg g.i.on').length";
    let before = browser.number(lit);
    browser.click("#run");
    browser.wait_for("document.querySelector('#run').textContent === 'Pause'");
    show(&browser, &page, "timers");
    let accumulated = "Number(document.querySelector(\".cell[data-address='T4:0.ACC']\").textContent)";
    browser.wait_for(&format!("{accumulated} > 20"));
    browser.wait_for("document.querySelector('meter').value > 0");
    browser.click("#run");
    browser.wait_for("document.querySelector('#run').textContent === 'Run'");
    browser.wait_for(&format!("{accumulated} > 0"));
    let (count, at) = (browser.number(accumulated), scan(&browser));
    for _ in 0..3 {
        browser.click("#back");
    }
    browser.wait_for(&format!("document.querySelector('#status').textContent.includes('scan {} ')", at - 3.0));
    browser.wait_for(&format!("{accumulated} === {}", count - 3.0));
    // Back to the scan before the start button.
    show(&browser, &page, "ladder/2");
    browser.wait_for("document.querySelector('.rung svg g.i')");
    browser.run("document.querySelector('#view').focus()");
    while scan(&browser) > 2.0 {
        let now = scan(&browser);
        browser.keys(if now > 12.0 { "B" } else { "b" });
        browser.wait_for(&format!("!document.querySelector('#status').textContent.includes('scan {now} ')"));
    }
    browser.wait_for(&format!("{lit} < {before}"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_force_is_never_out_of_sight() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "forces");
    browser.click("#view input");
    browser.keys("O:0.0/3");
    browser.click("#view button[title='Force on']");
    browser.wait_for("document.querySelector('.banner.forces')?.textContent.includes('disabled')");
    browser.click("#view .row button");
    browser.wait_for("document.querySelector('.banner.forces')?.textContent.includes('ENABLED')");
    show(&browser, &page, "ladder/2");
    browser.wait_for("document.querySelector('.banner.forces') && document.querySelector('g.forced-on')");
    browser.screenshot("workbench-force");
    show(&browser, &page, "forces");
    browser.click("#view tbody button[title^='Remove']");
    browser.wait_for("!document.querySelector('.banner.forces')");
    // What cannot be forced is refused with a reason.
    browser.click("#view input");
    browser.keys("N7:0");
    browser.click("#view button[title='Force on']");
    browser.wait_for("document.querySelector('.banner.wrong')?.textContent.includes('N7:0')");
    // The refusal itself is logged by the browser as a request that failed.
    assert!(browser.complaints().iter().all(|line| line.contains("409")));
}

#[test]
fn a_preset_is_edited_and_a_trend_followed() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "data/T4");
    let preset = ".cell[data-address='T4:0.PRE']";
    browser.wait_for(&format!("document.querySelector(\"{preset}\")?.textContent > 0"));
    browser.click(preset);
    browser.wait_for("document.querySelector('#ask').open");
    browser.keys(&format!("777{}", key::ENTER));
    browser.wait_for(&format!("document.querySelector(\"{preset}\").textContent === '777'"));
    make_ready(&browser, &page);
    toggle(&browser, "I:0.0/0");
    show(&browser, &page, "trend");
    browser.click("#view form input");
    browser.keys(&format!("T4:0.ACC{}", key::ENTER));
    browser.wait_for("document.querySelectorAll('#view tbody tr').length === 1");
    steps(&browser, 5);
    browser.wait_for("document.querySelector('#view tbody .now').textContent === '4'");
    // Something is drawn in the colour of the line.
    let inked = "(() => { const c = document.querySelector('#view canvas'); \
                 const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; \
                 const seen = new Set(); for (let i = 0; i < d.length; i += 4) seen.add(d[i] << 16 | d[i+1] << 8 | d[i+2]); \
                 return seen.size })()";
    browser.wait_for(&format!("{inked} > 3"));
    browser.screenshot("workbench-trend");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn what_is_recorded_replays_with_the_same_result() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "ladder/2");
    browser.click("#more");
    browser.wait_for("document.querySelector('#record')");
    browser.click("#record");
    browser.wait_for("document.querySelector('.banner')?.textContent.includes('Recording')");
    make_ready(&browser, &page);
    toggle(&browser, "I:0.0/0");
    steps(&browser, 4);
    toggle(&browser, "I:0.0/0");
    steps(&browser, 3);
    browser.click("#more");
    browser.wait_for("document.querySelector('#expect')");
    browser.click("#expect");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 7 ')");
    browser.click("#record-stop");
    browser.wait_for("document.querySelector('#view pre').textContent");
    assert_eq!(browser.text(".problems"), "Replayed on a fresh machine: all expectations are met.");
    let text = browser.run("return document.querySelector('#view pre').textContent");
    let text = text.as_str().unwrap_or_default();
    let scenario = Scenario::parse(text).unwrap_or_else(|why| panic!("{why}\n{text}"));
    let project = project(Path::new(&format!("{EXAMPLES}motor/motor.RSS")));
    let program = sim::Program::compile(&project.main, &sim::Options::default()).expect("runs");
    let report = sim::scenario::play(&scenario, &mut sim::Machine::new(program), Vec::new()).expect("plays");
    assert_eq!((report.failures.len(), report.scans), (0, 7), "{text}");
    assert!(report.checks > 3, "outputs are looked at: {text}");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn search_leads_to_uses_and_rungs() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "ladder/2");
    browser.click("#search-button");
    browser.wait_for("document.querySelector('#palette').open");
    browser.keys("HORN");
    browser.wait_for("document.querySelectorAll('#palette li').length > 1");
    browser.keys(key::ENTER);
    browser.wait_for("!document.querySelector('#detail').hidden");
    assert_eq!(browser.text("#detail h2"), "O:0.0/1");
    browser.click("#detail .uses button");
    browser.wait_for("document.querySelector('.rung.goal svg')");
    let goal = "document.querySelector('.rung.goal').getBoundingClientRect()";
    browser.wait_for(&format!("{goal}.top < innerHeight && {goal}.bottom > 0"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// Whoever is quicker than a view sees the one chosen last.
#[test]
fn a_view_that_comes_late_takes_no_others_place() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "points");
    browser.run(
        "const real = fetch; window.fetch = async (path, options) => { \
            if (/heights/.test(path)) await new Promise((done) => setTimeout(done, 400)); return real(path, options); }; \
            location.hash = 'ladder/2'; setTimeout(() => { location.hash = 'timers'; }, 100); setTimeout(() => { window.late = true; }, 1500)",
    );
    browser.wait_for("window.late");
    assert_eq!(browser.text("#view h2"), "Timers and counters");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// Documentation leads to what it is about, a call to what it calls.
#[test]
fn what_is_found_and_what_is_called_can_be_gone_to() {
    let Some(browser) = Browser::start() else { return };
    let page = serve(slc(Path::new(&format!("{EXAMPLES}batch/batch.RSS"))), None);
    show(&browser, &page, "ladder/2");
    for (text, kind, arrived) in [
        ("box has left", "description", "document.querySelector('#detail h2')?.textContent === 'I:0.0/3'"),
        ("ox_left", "symbol", "document.querySelector('#detail h2')?.textContent === 'I:0.0/3'"),
        ("fill", "program file", "location.hash === '#ladder/3/0'"),
        ("binary", "data file", "location.hash === '#data/B3'"),
    ] {
        browser.click("#search-button");
        browser.wait_for("document.querySelector('#palette').open");
        browser.run(
            "const one = document.querySelector('#palette input'); one.value = ''; one.dispatchEvent(new Event('input'))",
        );
        browser.keys(text);
        let item = format!(
            "[...document.querySelectorAll('#palette li')].find((one) => one.firstChild.textContent === '{kind}')"
        );
        browser.wait_for(&item);
        browser.run(&format!("{item}.click()"));
        browser.wait_for(arrived);
    }
    show(&browser, &page, "ladder/2");
    browser.wait_for("document.querySelector('g.i .frame')");
    let operand = "[...document.querySelectorAll('#view text.operand')].find((one) => one.textContent === 'U:3')";
    browser.wait_for(operand);
    browser.run(&format!("{operand}.dispatchEvent(new MouseEvent('click', {{ bubbles: true }}))"));
    browser.wait_for("location.hash === '#ladder/3/0'");
    // Of a timer everything is shown, not a value it has not.
    show(&browser, &page, "timers");
    browser.click("#view tbody th button");
    browser.wait_for("document.querySelector('#detail .members')");
    browser.wait_for(
        "[...document.querySelectorAll('#detail .members output')].every((one) => /^\\d+$/.test(one.textContent))",
    );
    assert_eq!(browser.text("#detail h2"), browser.text("#view tbody th button"));
    let names = "[...document.querySelectorAll('#detail .members button')].map((one) => one.textContent).join()";
    browser.wait_for(&format!("{names} === '/EN,/TT,/DN,.PRE,.ACC'"));
    browser.click("#detail .members button[title^='T4:0.PRE']");
    browser.wait_for("document.querySelector('#detail h2').textContent === 'T4:0.PRE'");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn two_pages_see_one_truth() {
    let (Some(one), Some(two)) = (Browser::start(), Browser::start()) else { return };
    let page = motor();
    show(&one, &page, "points");
    show(&two, &page, "points");
    toggle(&one, "I:0.0/1");
    two.wait_for(&format!("document.querySelector(\"{}\").ariaChecked === 'true'", lamp("I:0.0/1")));
    toggle(&two, "I:0.0/1");
    one.wait_for(&format!("document.querySelector(\"{}\").ariaChecked === 'false'", lamp("I:0.0/1")));
    for browser in [one, two] {
        assert_eq!(browser.complaints(), Vec::<String>::new());
    }
}

#[test]
fn a_plant_closes_the_loop_of_either_dialect() {
    let Some(browser) = Browser::start() else { return };
    let page = serve(slc(Path::new(&format!("{EXAMPLES}batch/batch.RSS"))), Some("batch/plant.toml"));
    show(&browser, &page, "points");
    toggle(&browser, "I:0.0/0");
    toggle(&browser, "I:0.0/1");
    browser.run(
        "return fetch('/api/control', {method: 'POST', headers: {'Content-Type': 'application/json'}, \
         body: JSON.stringify({do: 'until', address: 'C5:1.ACC', relation: '>=', value: 2, scans: 20000})})",
    );
    browser.wait_for("document.querySelector('#banners').textContent.includes('the condition holds')");
    assert!(!browser.is("document.querySelector('.banner.wrong')"));
    let page =
        serve(do_more(Path::new(&format!("{EXAMPLES}filling_domore/filling.txt"))), Some("filling_domore/plant.toml"));
    show(&browser, &page, "points");
    toggle(&browser, "X0");
    steps(&browser, 3);
    browser.wait_for("document.querySelector(\".lamp[data-address='Y0']\").classList.contains('lit')");
    show(&browser, &page, "ladder/1");
    browser.wait_for("document.querySelector('.rung svg g.i.on') && document.querySelector('.rung svg path.w.on')");
    browser.screenshot("workbench-do-more");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn every_view_fits_three_widths() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    make_ready(&browser, &page);
    toggle(&browser, "I:0.0/0");
    steps(&browser, 3);
    for (width, height) in [(1400, 900), (820, 1100), (480, 900)] {
        browser.resize(width, height);
        for (dark, theme) in [(false, "light"), (true, "dark")] {
            browser.dark(dark);
            for view in access::VIEWS {
                show(&browser, &page, view);
                let name = format!("{}-{width}-{theme}", view.replace('/', "-"));
                browser.screenshot(&format!("workbench-{name}"));
                assert!(
                    browser.is("document.documentElement.scrollWidth <= innerWidth + 1"),
                    "{name} is wider than the window"
                );
                // Where a drawing could be laid out for the width, it needs no bar of its own.
                assert!(
                    browser.is("[...document.querySelectorAll('.rung-place')].every(one => one.scrollWidth <= one.clientWidth + 1)"),
                    "{name}"
                );
            }
        }
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}
