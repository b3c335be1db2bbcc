//! The page for everybody: what a checker of accessibility finds, large text, touch, keys only, paper.

use rungs_tests::axe;
use rungs_tests::browser::{Browser, key};

use super::support::*;

/// Every view that the address bar can name.
const VIEWS: &[&str] = &[
    "ladder/2",
    "data/T4",
    "data/B3",
    "controller",
    "session",
    "points",
    "timers",
    "fault",
    "forces",
    "watch",
    "trend",
];

fn api(browser: &Browser, path: &str, body: &str) {
    browser.run(&format!(
        "return fetch('/api/{path}', {{method: 'POST', headers: {{'Content-Type': 'application/json'}}, body: JSON.stringify({body})}})"
    ));
}

/// A motor that runs, with a force, a watch list, a trend, a snapshot and a recording begun.
fn busy(browser: &Browser, page: &str) {
    show(browser, page, "ladder/2");
    api(browser, "record", "{do: 'start'}");
    for (address, value) in [("I:0.0/1", 1), ("I:0.0/2", 1), ("I:0.0/0", 1)] {
        api(browser, "write", &format!("{{address: '{address}', value: {value}}}"));
    }
    api(browser, "force", "{address: 'O:0.0/3', state: true}");
    api(browser, "control", "{do: 'forces', enabled: true}");
    api(browser, "control", "{do: 'scan', count: 5}");
    api(browser, "control", "{do: 'keep', name: 'running'}");
    api(browser, "trend", "{addresses: ['T4:0.ACC', 'O:0.0/1']}");
    browser.run("localStorage.setItem('rungs-watch:motor.RSS', JSON.stringify(['T4:0.ACC', 'I:0.0/0']))");
    browser.go("about:blank");
}

fn ready(browser: &Browser, page: &str, view: &str) {
    show(browser, page, view);
    match view {
        _ if view.starts_with("ladder") => browser.wait_for("document.querySelector('.rung svg, svg.rung')"),
        "trend" => browser.wait_for("document.querySelectorAll('#view tbody tr').length === 2"),
        _ => {}
    }
}

#[test]
fn a_checker_finds_nothing_serious_in_any_view_light_or_dark() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    busy(&browser, &page);
    for dark in [false, true] {
        browser.dark(dark);
        let theme = if dark { "dark" } else { "light" };
        for view in VIEWS {
            ready(&browser, &page, view);
            axe::check(&browser, &format!("{view}, {theme}"));
        }
        show(&browser, &page, "ladder/2");
        browser.wait_for("document.querySelector('svg.rung g.i')");
        browser.run("document.querySelector('svg.rung g.i').focus()");
        browser.keys("m");
        browser.wait_for("document.querySelector('#menu').matches(':popover-open')");
        axe::check(&browser, &format!("menu, {theme}"));
        browser.keys(key::ESCAPE);
        browser.keys("x");
        browser.wait_for("!document.querySelector('#detail').hidden");
        axe::check(&browser, &format!("cross reference, {theme}"));
        browser.keys(key::ESCAPE);
        browser.run("document.querySelector('#view').focus()");
        browser.keys("?");
        browser.wait_for("document.querySelector('#help').open");
        axe::check(&browser, &format!("help, {theme}"));
        browser.keys(key::ESCAPE);
        browser.click("#search-button");
        browser.keys("MOTOR");
        browser.wait_for("document.querySelectorAll('#palette li').length > 1");
        axe::check(&browser, &format!("search, {theme}"));
        browser.keys(key::ESCAPE);
        show(&browser, &page, "data/T4");
        browser.click(".cell[data-address='T4:0.PRE']");
        browser.wait_for("document.querySelector('#ask').open");
        axe::check(&browser, &format!("a value, {theme}"));
        browser.keys(key::ESCAPE);
    }
    // The fault screen, and what a person sees of a recording that has ended.
    show(&browser, &page, "session");
    browser.click("#record-stop");
    browser.wait_for("document.querySelector('#view pre').textContent");
    axe::check(&browser, "recording");
    api(&browser, "write", "{address: 'T4:0.PRE', value: -5}");
    api(&browser, "control", "{do: 'scan', count: 2}");
    for dark in [false, true] {
        browser.dark(dark);
        show(&browser, &page, "fault");
        browser.wait_for("document.querySelector('#view svg.rung')");
        axe::check(&browser, "fault");
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}
