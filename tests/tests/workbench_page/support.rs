//! Programs, the server that shows them, and what a person does on its page.

use std::path::Path;
use std::sync::Arc;

use rungs_tests::browser::Browser;
use rungs_tests::served;
use server::plant::Plant;
use server::view::{DoMoreProgram, Program, SlcProgram};
use server::workbench::{Change, DoMore, Slc, Subject, Workbench};
use server::{Access, engine};

pub(crate) const EXAMPLES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/");

pub(crate) fn project(path: &Path) -> ladder::Project {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    convert::open(&bytes, &name, rss::Mode::Permissive).unwrap_or_else(|error| panic!("{name}: {error}"))
}

pub(crate) fn slc(path: &Path) -> (Box<dyn Subject>, Arc<dyn Program>) {
    let project = project(path);
    let program = sim::Program::compile(&project.main, &sim::Options::default()).expect("every instruction runs");
    let machine = Slc::new(sim::Machine::new(program), &project.main);
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    (Box::new(machine), Arc::new(SlcProgram::new(name, project, Vec::new())))
}

pub(crate) fn do_more(path: &Path) -> (Box<dyn Subject>, Arc<dyn Program>) {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let project = domore::text::read(&text).expect("reads").project;
    let program = domore::engine::Program::compile(&project, &Default::default()).expect("compiles");
    let machine = DoMore::new(program, &project);
    (Box::new(machine), Arc::new(DoMoreProgram::new("program.txt".to_owned(), project, Vec::new()).expect("memory")))
}

/// Serves a program until the tests end; answers the address of its page.
pub(crate) fn serve(served: (Box<dyn Subject>, Arc<dyn Program>), plant: Option<&str>) -> String {
    serve_to(served, plant, Access::default())
}

/// The same, for those who have this access.
pub(crate) fn serve_to(
    (machine, program): (Box<dyn Subject>, Arc<dyn Program>),
    plant: Option<&str>,
    access: Access,
) -> String {
    let mut bench = Workbench::new(machine);
    if let Some(name) = plant {
        let text = std::fs::read_to_string(format!("{EXAMPLES}{name}")).expect(name);
        let plant = Plant::parse(&text).unwrap_or_else(|why| panic!("{name}: {why}"));
        bench.change(Change::Plant(Some(Box::new(plant)))).expect("wires");
    }
    served::until_the_end(move |listener| async {
        let engine = engine::start(bench).expect("a thread");
        server::serve(listener, engine, program, access, std::future::pending()).await
    })
}

pub(crate) fn motor() -> String {
    serve(slc(Path::new(&format!("{EXAMPLES}motor/motor.RSS"))), None)
}

/// The page of one view, when it is all there.
pub(crate) fn show(browser: &Browser, page: &str, view: &str) {
    browser.go(&format!("{page}#{view}"));
    browser.wait_for(&format!(
        "document.querySelector('#view')?.dataset.shown === '#{view}' && document.querySelector('#status').textContent"
    ));
}

pub(crate) fn lamp(address: &str) -> String {
    format!(".lamp[data-address='{address}']")
}

pub(crate) fn toggle(browser: &Browser, address: &str) {
    let lamp = lamp(address);
    let before = browser.is(&format!("document.querySelector(\"{lamp}\").ariaChecked === 'true'"));
    browser.click(&lamp);
    browser.wait_for(&format!("document.querySelector(\"{lamp}\").ariaChecked === '{}'", !before));
}

pub(crate) fn scan(browser: &Browser) -> f64 {
    browser.number("document.querySelector('#status').textContent.match(/scan (\\d+)/)[1]")
}

pub(crate) fn steps(browser: &Browser, count: usize) {
    for _ in 0..count {
        let before = scan(browser);
        browser.click("#step");
        browser.wait_for(&format!("document.querySelector('#status').textContent.includes('scan {} ')", before + 1.0));
    }
}

/// Stop button and overload relay are healthy when closed.
pub(crate) fn make_ready(browser: &Browser, page: &str) {
    show(browser, page, "points");
    browser.wait_for(&format!("document.querySelector(\"{}\")?.ariaChecked === 'false'", lamp("I:0.0/1")));
    toggle(browser, "I:0.0/1");
    toggle(browser, "I:0.0/2");
}

/// Asks the interface for something, as the page does.
pub(crate) fn api(browser: &Browser, path: &str, body: &str) {
    browser.run(&format!(
        "return fetch('/api/{path}', {{method: 'POST', headers: {{'Content-Type': 'application/json'}}, body: JSON.stringify({body})}})"
    ));
}
