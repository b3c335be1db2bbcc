//! The reference page under `docs/` is what the table says now.

use std::fs;
use std::path::Path;

#[test]
fn the_reference_page_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/instructions.md");
    let page = instr::reference::markdown();
    if std::env::var_os("RUNGS_BLESS").is_some() {
        fs::write(&path, &page).expect("docs/ can be written");
    }
    let stored = fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == page, "docs/instructions.md is stale: run this test with RUNGS_BLESS=1");
}

#[test]
fn every_instruction_has_a_section_and_every_link_a_target() {
    let page = instr::reference::markdown();
    let anchors: Vec<String> = page
        .lines()
        .filter_map(|line| line.strip_prefix("### "))
        .map(|title| title.replace("&lt;", "").replace("&gt;", "").to_lowercase().replace(' ', "-"))
        .map(|title| title.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect())
        .collect();
    assert_eq!(anchors.len(), instr::all().len());
    let mut links = 0;
    for link in page.split("](#").skip(1).filter_map(|rest| rest.split(')').next()) {
        assert!(anchors.iter().any(|anchor| anchor == link), "no section for #{link}");
        links += 1;
    }
    assert_eq!(links, instr::all().len());
    // A table row broken by an unescaped bar would show as a row of another width.
    for line in page.lines().filter(|line| line.starts_with('|')) {
        assert!([3, 5, 6].contains(&line.matches('|').count()), "{line}");
    }
}
