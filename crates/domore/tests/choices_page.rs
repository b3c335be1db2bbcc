//! The page of readings says what the lists say.

#[test]
fn the_page_is_current() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/domore-choices.md");
    let page = domore::choices::markdown();
    if std::env::var_os("RUNGS_BLESS").is_some() {
        std::fs::write(&path, &page).expect("writable page");
    }
    let stored = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(stored == page, "docs/domore-choices.md is not current: run this test with RUNGS_BLESS=1");
}

#[test]
fn names_are_unique_and_read_back() {
    for row in domore::choices::LIST {
        let choices = domore::choices::Choices::parse([row.name]).expect(row.name);
        assert!(choices.has(row.choice));
        assert_eq!(domore::choices::LIST.iter().filter(|other| other.name == row.name).count(), 1);
        assert!(sim_names_differ(row.name));
    }
    assert!(domore::choices::Choices::parse(["nothing"]).is_none());
}

/// Both dialects share one option: names of this one begin with a mark of their own.
fn sim_names_differ(name: &str) -> bool {
    name.starts_with("dm-")
}
