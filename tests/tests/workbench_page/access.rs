//! The page for everybody: what a checker of accessibility finds, large text, touch, keys only, paper.

use rungs_tests::axe;
use rungs_tests::browser::{Browser, key};

use super::support::*;

/// Every view that the address bar can name.
pub(crate) const VIEWS: &[&str] = &[
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
        _ if view.starts_with("ladder") => browser.wait_for("document.querySelector('svg.rung')"),
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

#[test]
fn the_main_job_goes_with_keys_alone() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "ladder/2");
    browser.wait_for("document.querySelector('svg.rung g.i')");
    // Tab leads from the start of the page to the ladder, once: arrows go on inside.
    let mut tabs = 0;
    while !browser.is("document.activeElement.matches('g.i')") {
        browser.keys(key::TAB);
        tabs += 1;
        assert!(tabs < 80, "Tab does not come to the ladder");
    }
    let name = "document.activeElement.querySelector('title').textContent";
    let at = |words: &str| browser.wait_for(&format!("{name}.startsWith('{words}')"));
    at("XIC I:0.0/0");
    browser.keys(key::RIGHT);
    at("XIC B3:0/0");
    browser.keys(key::LEFT);
    browser.keys(key::RIGHT);
    browser.keys(key::RIGHT);
    at("XIC I:0.0/1");
    browser.keys(key::ENTER);
    browser.keys(key::RIGHT);
    at("XIC I:0.0/2");
    browser.keys(key::ENTER);
    browser.keys("s");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 1 ')");
    for _ in 0..3 {
        browser.keys(key::LEFT);
    }
    at("XIC I:0.0/0");
    // Enter toggles the contact; the mark and the words say what it did.
    browser.keys(key::ENTER);
    browser.keys("s");
    browser.wait_for(&format!("{name}.includes('true, became true in the last scan')"));
    browser.wait_for("document.activeElement.matches('.on.edge')");
    // Down to the timer: its preset is edited where it stands, then the accumulated value.
    browser.keys(key::DOWN);
    browser.keys(key::DOWN);
    browser.keys(key::RIGHT);
    at("TON T4:0");
    browser.keys("e");
    browser.wait_for("document.activeElement.matches('input.inplace')");
    browser.keys(&format!("250{}", key::TAB));
    browser.wait_for("document.activeElement.ariaLabel === 'New value of T4:0.ACC'");
    browser.keys(&format!("20{}", key::ENTER));
    at("TON T4:0");
    let shown = |value: &str| {
        browser.wait_for(&format!(
            "[...document.activeElement.querySelectorAll('text.live')].some(one => one.textContent === '{value}')"
        ));
    };
    shown("250");
    shown("20");
    browser.wait_for("document.activeElement.querySelector('.flag.set text').textContent === 'EN'");
    // Escape changes nothing.
    browser.keys("e");
    browser.keys(&format!("9{}", key::ESCAPE));
    shown("250");
    // The menu: cross reference of the timer, and back to where it was opened.
    browser.keys("m");
    browser.wait_for("document.activeElement.matches('[role=menuitem]')");
    while !browser.is("document.activeElement.textContent.startsWith('Cross reference of T4:0')") {
        browser.keys(key::DOWN);
    }
    browser.keys(key::ENTER);
    browser.wait_for("document.activeElement.id === 'detail'");
    browser.keys(key::ESCAPE);
    browser.wait_for("document.querySelector('#detail').hidden");
    at("TON T4:0");
    // A force from the contact.
    browser.keys(key::UP);
    browser.keys(key::UP);
    while !browser.is(&format!("{name}.startsWith('XIC I:0.0/1')")) {
        browser.keys(key::RIGHT);
    }
    browser.keys("m");
    while !browser.is("document.activeElement.textContent === 'Force off I:0.0/1'") {
        browser.keys(key::DOWN);
    }
    browser.keys(key::ENTER);
    browser.wait_for("document.querySelector('.banner.forces')?.textContent.includes('I:0.0/1 OFF')");
    browser.wait_for("document.activeElement.matches('.forced-off')");
    // Anywhere by search; run, pause and back by letters.
    browser.run("document.querySelector('#view').focus()");
    browser.keys("s");
    browser.keys("b");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 2 ')");
    browser.keys(" ");
    browser.wait_for("document.querySelector('#run').textContent === 'Pause'");
    browser.keys(" ");
    browser.wait_for("document.querySelector('#run').textContent === 'Run'");
    browser.keys(&format!("{}k{}", key::CONTROL, key::NULL));
    browser.wait_for("document.querySelector('#palette').open");
    browser.keys(&format!("Trend{}", key::ENTER));
    browser.wait_for("location.hash === '#trend' && document.querySelector('#view h2').textContent === 'Trend'");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// Controls of the bars that lie over each other or outside of the window.
const LOST: &str = "(() => { \
    const all = [...document.querySelectorAll('header button, header select, header input, .banner button')] \
        .filter(one => one.getClientRects().length && !one.closest('#menu')); \
    const place = one => one.getBoundingClientRect(); \
    const out = all.filter(one => place(one).left < 0 || place(one).right > innerWidth + 1 || place(one).width < 24 || place(one).height < 24); \
    const over = all.filter((a, i) => all.slice(i + 1).some(b => place(a).left < place(b).right - 1 && place(b).left < place(a).right - 1 \
        && place(a).top < place(b).bottom - 1 && place(b).top < place(a).bottom - 1)); \
    return [...out, ...over].map(one => one.id || one.textContent) })()";

fn nothing_is_lost(browser: &Browser, what: &str) {
    let lost = browser.run(&format!("return {LOST}"));
    assert_eq!(lost, serde_json::json!([]), "{what}");
    assert!(browser.is("document.documentElement.scrollWidth <= innerWidth + 1"), "{what} is wider than the window");
    // What does not fit scrolls inside the view; the program keeps some room.
    assert!(browser.is("document.querySelector('#view').clientHeight >= 150"), "{what} leaves the program no room");
}

#[test]
fn text_of_twice_the_size_loses_nothing() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    busy(&browser, &page);
    for view in VIEWS {
        // Zoom of the browser: half as much room.
        browser.zoom(1280, 900, 2.0);
        ready(&browser, &page, view);
        nothing_is_lost(&browser, &format!("{view} at 200 %"));
        browser.no_zoom();
        // Text alone.
        ready(&browser, &page, view);
        browser.run("document.documentElement.style.fontSize = '200%'");
        nothing_is_lost(&browser, &format!("{view} with text of 200 %"));
        browser.run("document.documentElement.style.fontSize = ''");
    }
    show(&browser, &page, "ladder/2");
    browser.run("document.documentElement.style.fontSize = '200%'");
    // Drawings grow with the text, and are laid out anew for the room there is.
    browser.wait_for("document.querySelector('svg.rung')?.getBoundingClientRect().height > 2 * 16 * 5");
    assert!(
        browser.is(
            "[...document.querySelectorAll('svg.rung text')].every(one => getComputedStyle(one).fontSize === '13px')"
        ),
        "texts of a drawing fill their lines and no more"
    );
    // A drawing of the fewest columns may be wider than what is left; it is no wider than that.
    browser
        .wait_for("[...document.querySelectorAll('svg.rung')].every(one => one.viewBox.baseVal.width <= 60 * 8 + 40)");
    browser.screenshot("workbench-large-text");
    browser.click("#step");
    browser.wait_for("document.querySelector('#status').textContent.includes('scan 6 ')");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_finger_hits_everything_on_a_tablet() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    busy(&browser, &page);
    browser.resize(820, 1100);
    for view in VIEWS {
        ready(&browser, &page, view);
        nothing_is_lost(&browser, view);
        let small = browser.run(
            "return [...document.querySelectorAll('button, select, input, a[href], summary, [role=button], [role=switch]')] \
             .filter(one => one.getClientRects().length && !one.closest('.skip, dialog, #menu') && one.className !== 'skip') \
             .map(one => [one, one.getBoundingClientRect()]) \
             .filter(([, at]) => at.width < 24 || at.height < 24) \
             .map(([one, at]) => `${one.tagName} ${one.id || one.textContent} ${at.width} x ${at.height}`)",
        );
        assert_eq!(small, serde_json::json!([]), "{view}");
        // What is used all the time is as large as a fingertip.
        assert!(
            browser.is("[...document.querySelectorAll('header button, header select, .lamp.input')] \
                        .every(one => !one.getClientRects().length || one.getBoundingClientRect().height >= 44)"),
            "{view}"
        );
    }
    // The tree comes when it is asked for and goes when something was chosen.
    assert!(browser.is("document.querySelector('#tree').getClientRects().length === 0"));
    browser.click("#tree-button");
    browser.wait_for("document.querySelector('#tree').getClientRects().length > 0");
    browser.screenshot("workbench-tree-820");
    browser.click("#tree a[href='#timers']");
    browser.wait_for("document.querySelector('#view h2').textContent === 'Timers and counters'");
    assert!(browser.is("document.querySelector('#tree').getClientRects().length === 0"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_theme_is_chosen_kept_and_not_printed() {
    let Some(browser) = Browser::start() else { return };
    let page = motor();
    show(&browser, &page, "ladder/2");
    let paper = |browser: &Browser| browser.run("return getComputedStyle(document.body).backgroundColor");
    let (white, dark) = (serde_json::json!("rgb(255, 255, 255)"), serde_json::json!("rgb(22, 22, 22)"));
    assert_eq!(paper(&browser), white);
    browser.dark(true);
    assert_eq!(paper(&browser), dark, "as the system");
    let choose = |theme: &str| {
        browser.click("#help-button");
        browser.wait_for("document.querySelector('#help').open");
        browser.run(&format!(
            "const one = document.querySelector('#theme'); one.value = '{theme}'; one.dispatchEvent(new Event('change'))"
        ));
        browser.keys(key::ESCAPE);
    };
    choose("light");
    assert_eq!(paper(&browser), white, "chosen against the system");
    browser.dark(false);
    choose("dark");
    browser.go("about:blank");
    show(&browser, &page, "ladder/2");
    assert_eq!(paper(&browser), dark, "kept");
    browser.wait_for("document.querySelector('svg.rung')");
    let ink = "getComputedStyle(document.querySelector('svg.rung')).fill";
    assert!(browser.is(&format!("{ink} === 'rgb(232, 232, 232)'")), "drawings follow");
    // On paper: light, without controls, with the program.
    browser.run("dispatchEvent(new Event('beforeprint'))");
    browser.print(true);
    assert_eq!(paper(&browser), white, "paper");
    assert!(browser.is(&format!("{ink} === 'rgb(17, 17, 17)'")));
    assert!(browser.is("['header', '#tree'].every(one => !document.querySelector(one).getClientRects().length)"));
    assert!(browser.is("document.querySelector('svg.rung').getClientRects().length"));
    browser.screenshot("workbench-print");
    browser.print(false);
    browser.run("dispatchEvent(new Event('afterprint'))");
    assert_eq!(paper(&browser), dark);
    choose("system");
    assert_eq!((paper(&browser), browser.is("localStorage.getItem('rungs-theme') === null")), (white, true));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}
