//! Do-more projects: opened by content, and their JSON keeps to its published schema.

use std::path::Path;

use convert::designer::{from_bytes, to_bytes, write_json};
use convert::{AnyProject, OpenError, open, open_any};
use rss::Mode;

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../.."))
}

fn example() -> Vec<u8> {
    std::fs::read(root().join("examples/filling_domore/filling.txt")).expect("the example")
}

#[test]
fn the_content_decides() {
    let Ok(AnyProject::Domore(document)) = open_any(&example(), "x.RSS", Mode::Strict) else { panic!("no Do-more") };
    assert_eq!(document.source.file, "x.RSS");
    assert!(matches!(open(&example(), "x", Mode::Permissive), Err(OpenError::OtherDialect)));
    let slc = std::fs::read(root().join("examples/motor/motor.SLC")).expect("an example");
    assert!(matches!(open_any(&slc, "x.txt", Mode::Permissive), Ok(AnyProject::Rslogix(_))));
    let unbalanced = b"PLC DM-SIM\n$PRGRM A\n\nSTR X0\nSTR X1\nOUT Y0\n\n$PGMEND A\n";
    assert!(matches!(open_any(unbalanced, "x", Mode::Strict), Err(OpenError::Strict(_))));
    let Ok(AnyProject::Domore(document)) = open_any(unbalanced, "x", Mode::Permissive) else { panic!("no Do-more") };
    assert_eq!(to_bytes(&document.project), unbalanced);
}

#[test]
fn documents_keep_to_the_schema() {
    let schema = std::fs::read_to_string(root().join("docs/schema/rungs.domore-1.schema.json")).expect("the schema");
    let schema = serde_json::from_str(&schema).expect("JSON");
    let validator = jsonschema::validator_for(&schema).expect("a schema");
    let odd = b"odd line\nPLC X\n#BEGIN DEVICE\nno\n#END\n#BEGIN ODD\nx\n#END\n$WHAT A\n\n#BEGIN NOTE\ny\n#END\n\nSTR X0\nFANCY \"a\"\n\nOUT Y0\n$WHATEND A\n";
    for bytes in [example(), odd.to_vec(), b"STR X0\nOUT Y0".to_vec()] {
        let document = from_bytes(&bytes, ladder::Source::default()).expect("readable");
        let mut json = Vec::new();
        write_json(&document, &mut json).expect("a vector takes all");
        let value: serde_json::Value = serde_json::from_slice(&json).expect("JSON");
        let errors: Vec<String> =
            validator.iter_errors(&value).map(|e| format!("{}: {e}", e.instance_path())).collect();
        assert_eq!(errors, [""; 0]);
    }
}
