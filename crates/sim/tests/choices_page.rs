//! The page of switchable readings says what the list says.

#[test]
fn the_page_is_current() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/semantics-choices.md");
    let page = sim::choices::markdown();
    if std::env::var_os("RUNGS_BLESS").is_some() {
        std::fs::write(&path, &page).expect("writable page");
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == page, "docs/semantics-choices.md is not current: run this test with RUNGS_BLESS=1");
}
