//! Accessibility of a page, looked at by axe-core in the browser.
//!
//! `cargo xtask setup` puts it below `target/npm`.

use std::path::Path;
use std::sync::OnceLock;

use serde_json::Value;

use crate::browser::Browser;

/// Set to 1, nothing is looked at, and this is said.
pub const NO_AXE: &str = "RUNGS_NO_AXE";

/// Something a person with a disability would stumble over.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// `minor`, `moderate`, `serious` or `critical`.
    pub impact: String,
    /// Name of the rule.
    pub rule: String,
    /// What is wrong, and with which elements.
    pub text: String,
}

impl Finding {
    /// It keeps people from using the page.
    #[must_use]
    pub fn is_serious(&self) -> bool {
        !matches!(self.impact.as_str(), "minor" | "moderate")
    }
}

/// The checker.
///
/// # Panics
/// When it is not installed, so that a test never passes without having looked.
fn source() -> &'static str {
    static SOURCE: OnceLock<String> = OnceLock::new();
    SOURCE.get_or_init(|| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/npm/node_modules/axe-core/axe.min.js");
        std::fs::read_to_string(&path).unwrap_or_else(|error| {
            panic!(
                "axe-core is needed ({}: {error}): `cargo xtask setup` installs it where npm is; {NO_AXE}=1 \
                 leaves it out",
                path.display()
            )
        })
    })
}

/// What axe-core finds wrong with the page as it stands; `touch`: also controls too small for a finger. Nothing where
/// [`NO_AXE`] leaves it out.
///
/// # Panics
/// When it does not run.
#[must_use]
pub fn findings(browser: &Browser, touch: bool) -> Vec<Finding> {
    if std::env::var_os(NO_AXE).is_some_and(|value| value == "1") {
        println!("skipped: {NO_AXE}=1");
        return Vec::new();
    }
    if !browser.is("window.axe") {
        // Where a page defines modules of its own, the checker would hide in them.
        browser.run(&format!("const module = undefined, define = undefined; {}; return 0", source()));
    }
    let found = browser.run(&format!(
        "return axe.run(document, {{rules: {{'target-size': {{enabled: {touch}}}}}, resultTypes: ['violations']}}).then(result => \
         result.violations.map(one => [one.impact, one.id, one.help, one.nodes.map(node => node.target.join(' ') + ' ' + \
         node.any.concat(node.all, node.none).map(check => check.message).join('; '))]))",
    ));
    let rows = found.as_array().unwrap_or_else(|| panic!("axe-core answered {found}"));
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let finding = |row: &Value| {
        let nodes: Vec<String> = row[3].as_array().into_iter().flatten().map(text).collect();
        let shown = nodes.iter().take(5).fold(String::new(), |all, node| format!("{all}\n    {node}"));
        let left = nodes.len().saturating_sub(5);
        let more = if left > 0 { format!("\n    and {left} more") } else { String::new() };
        Finding { impact: text(&row[0]), rule: text(&row[1]), text: format!("{}{shown}{more}", text(&row[2])) }
    };
    rows.iter().map(finding).collect()
}

/// Asserts that nothing serious is found in a page that is worked with, and prints what else is.
///
/// # Panics
/// When something serious is found.
pub fn check(browser: &Browser, page: &str) {
    asserted(&findings(browser, true), page);
}

/// The same for a page that is read: links in its tables may stand as close as the lines of a book.
///
/// # Panics
/// When something serious is found.
pub fn check_document(browser: &Browser, page: &str) {
    asserted(&findings(browser, false), page);
}

fn asserted(all: &[Finding], page: &str) {
    let lines = |serious: bool| -> Vec<String> {
        let some = all.iter().filter(|finding| finding.is_serious() == serious);
        some.map(|it| format!("{page}: {} {}: {}", it.impact, it.rule, it.text)).collect()
    };
    lines(false).iter().for_each(|line| println!("{line}"));
    let serious = lines(true);
    assert!(serious.is_empty(), "{}", serious.join("\n"));
}
