//! The JSON project against its published schema, and back into the model.

mod json_support;

use std::path::Path;

use convert::json::{from_json, to_json, to_json_text};
use serde_json::{Value, json};

fn schema() -> jsonschema::Validator {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schema/rungs.project-1.schema.json");
    let text = std::fs::read_to_string(&path).expect("the published schema");
    let schema: Value = serde_json::from_str(&text).expect("the schema is JSON");
    jsonschema::draft202012::meta::validate(&schema).expect("the schema is a schema");
    jsonschema::draft202012::new(&schema).expect("the schema compiles")
}

#[track_caller]
fn assert_valid(document: &Value) {
    let validator = schema();
    let errors: Vec<_> = validator.iter_errors(document).map(|e| format!("{}: {e}", e.instance_path())).collect();
    assert!(errors.is_empty(), "{errors:#?}");
}

/// The document of the interface description, abbreviated as there.
fn promised() -> Value {
    json!({"schema":"rungs.project/1","source":{"file":"x.RSS","sha256":"..","saved_by":"8.30.00"},
     "processor":{"catalog":"Bul.1763","name":"MicroLogix 1100 Series B","family":"micrologix-1100","project_name":"UNTITLED"},
     "program_files":[{"number":2,"name":"MAIN","description":"","type":"LADDER",
       "rungs":[{"number":0,"title":null,"comment":null,"text":"XIC B3:0/0 BST OTE B3:0/1 NXB TON T4:0 0.01 100 0 BND",
         "instructions":[{"mnemonic":"XIC","operands":["B3:0/0"]}]}]}],
     "data_files":[{"number":4,"type":"T","name":"TIMER","description":"","elements":2,"words":6,
       "values":[{"EN":0,"TT":0,"DN":0,"base":"0.01","PRE":100,"ACC":0}]}],
     "symbols":[{"address":"T4:0","symbol":"LAMP_FLASH_TON","description":["lamp","flash"]}],
     "io":[],"channels":[],"diagnostics":[]})
}

#[test]
fn the_promised_document_is_valid() {
    assert_valid(&promised());
}

#[test]
fn the_schema_lists_what_the_model_has() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schema/rungs.project-1.schema.json");
    let text = std::fs::read_to_string(&path).expect("the published schema");
    let schema: Value = serde_json::from_str(&text).expect("the schema is JSON");
    let families: Vec<&str> = ladder::Family::all().map(|family| family.id()).collect();
    assert_eq!(schema["$defs"]["processor"]["properties"]["family"]["enum"], json!(families));
}

#[test]
fn a_short_document_reads() {
    let mut document = promised();
    document["program_files"][0]["rungs"][0]["instructions"] = json!([
        {"mnemonic":"XIC","operands":["B3:0/0"]},
        {"mnemonic":"OTE","operands":["B3:0/1"]},
        {"mnemonic":"TON","operands":["T4:0","0.01","100","0"]}]);
    document["data_files"][0]["elements"] = json!(1);
    document["data_files"][0]["words"] = json!(3);
    let project = from_json(&document.to_string()).expect("a project");
    let file = project.main.program_file(2).expect("file 2");
    assert_eq!(file.rungs[0].instructions().count(), 3);
    assert!(!file.rungs[0].instructions().any(|i| i.compiled));
    assert_eq!(project.main.data_files[0].words, [0, 100, 0]);
    // Without the list of instructions the text alone gives the rung.
    let mut text_only = document.clone();
    text_only["program_files"][0]["rungs"][0].as_object_mut().expect("a rung").remove("instructions");
    assert_eq!(from_json(&text_only.to_string()).expect("a project"), project);
}

#[test]
fn everything_in_a_project_comes_back() {
    let project = json_support::project();
    let text = to_json_text(&project);
    let document: Value = serde_json::from_str(&text).expect("JSON");
    assert_valid(&document);
    assert_eq!(document, to_json(&project), "text and value are the same document");
    let back = from_json(&text).expect("a project");
    assert_eq!(back, project);
    assert_eq!(to_json_text(&back), text);
}

#[test]
fn people_see_what_they_know() {
    let document = to_json(&json_support::project());
    let main = &document["program_files"][1];
    let rung = &main["rungs"][0];
    assert_eq!(rung["text"], "XIC B3:0/0 BST OTE B3:0/1 NXB TON T4:0 0.01 100 0 NXB BND");
    assert_eq!(rung["title"], "Lamp \"A\"");
    assert_eq!(rung["comment"], "Flashes the lamp\r\n100 % of the time\r\n");
    assert_eq!(rung["instructions"][2]["operands"], json!(["T4:0", "0.01", "100", "0"]));
    assert_eq!(main["rungs"][1]["text"], "JSR 4");
    assert_eq!(main["rungs"][1]["instructions"][0]["operands"], json!(["U:4"]));
    assert_eq!(main["rungs"][1]["comment"], Value::Null);
    assert_eq!(main["rungs"][5]["text"], "END");
    let values = |index: usize| &document["data_files"][index]["values"];
    assert_eq!(values(0), &json!([5, -1]));
    assert_eq!(document["data_files"][0]["forces"], json!([{"word":0,"address":"O:0.0","on":[0,1],"off":[2]}]));
    assert_eq!(
        values(2),
        &json!([{"EN":1,"TT":0,"DN":1,"base":"0.01","PRE":100,"ACC":7},
                {"EN":0,"TT":1,"DN":0,"base":"1.0","PRE":5994,"ACC":-1},
                {"EN":0,"TT":0,"DN":0,"base":null,"PRE":0,"ACC":0}])
    );
    assert_eq!(document["data_files"][2]["raw"], json!([{"word":6,"words":[0x1301,0,0]}]));
    assert_eq!(values(3), &json!([{"CU":1,"CD":1,"DN":1,"OV":1,"UN":1,"UA":1,"PRE":10,"ACC":3}]));
    assert_eq!(values(4), &json!([{"EN":1,"EU":0,"DN":0,"EM":0,"ER":0,"UL":0,"IN":0,"FD":0,"LEN":10,"POS":3}]));
    assert_eq!(values(5), &json!([1, -32768, -1]));
    assert_eq!(values(6).to_string(), r#"[1.5,0.1,"Infinity","-Infinity","NaN","NaN",-0.0]"#);
    assert_eq!(values(7)[0], "ABC");
    assert_eq!(values(8), &json!([-1, i32::MIN]));
    assert_eq!(values(9)[0].as_array().map(Vec::len), Some(23));
    assert_eq!(values(10)[1], Value::Null);
}

#[test]
fn a_line_is_a_rung() {
    let text = to_json_text(&json_support::project());
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("\"text\":\"JSR 4\"")).collect();
    // Offline and online.
    assert_eq!(lines.len(), 2, "{text}");
    for line in lines {
        let rung: Value = serde_json::from_str(line.trim().trim_end_matches(',')).expect("one rung in one line");
        assert_eq!(rung["number"], 1);
    }
    assert!(text.ends_with("}\n"));
}

/// Changes one member, gives the pointer and message of the error.
#[track_caller]
fn refused(pointer: &str, value: Value) -> String {
    let mut document = to_json(&json_support::project());
    let (owner, name) = pointer.rsplit_once('/').expect("a pointer");
    match document.pointer_mut(owner).expect("a member to change") {
        Value::Object(members) => drop(members.insert(name.to_owned(), value)),
        list => list[name.parse::<usize>().expect("an index")] = value,
    }
    from_json(&document.to_string()).expect_err("an error").to_string()
}

#[test]
fn errors_say_where_what_and_found() {
    for (pointer, value, expected) in [
        ("/schema", json!("rungs.project/2"), "/schema: expected \"rungs.project/1\", found \"rungs.project/2\""),
        ("/processor/family", json!("plc-5"), "/processor/family: expected one of slc-500-fixed, "),
        ("/program_files/1/number", json!(70_000), "expected u16, found integer `70000`"),
        ("/program_files/1/rungs/2/number", json!(9), "/program_files/1/rungs/2/number: expected 2, found 9"),
        ("/program_files/1/rungs/0/text", json!("XIC"), "/program_files/1/rungs/0/text: expected "),
        ("/program_files/1/rungs/0/text", json!("XIC B3:0/0"), "/program_files/1/rungs/0/instructions/1: expected no"),
        (
            "/program_files/1/rungs/0/instructions/0/mnemonic",
            json!("XIO"),
            "expected XIC as in the text, found \"XIO\"",
        ),
        (
            "/data_files/0/values/0",
            json!(40_000),
            "/data_files/0/values/0: expected a signed 16-bit integer, found 40000",
        ),
        ("/data_files/2/values/0/PRE", json!("x"), "/data_files/2/values/0/PRE: expected an integer, found a string"),
        ("/data_files/2/values/0/EN", json!(2), "/data_files/2/values/0/EN: expected 0 or 1, found 2"),
        ("/data_files/2/values/1", json!({"EN":0}), "/data_files/2/values/1: expected member TT, found none"),
        ("/data_files/5/elements", json!(4), "/data_files/5/values: expected 4 values, as many as elements, found 3"),
        ("/data_files/5/words", json!(4_000_000_000_u64), "/data_files/5/words: expected 3, "),
        ("/data_files/0/forces/0/word", json!(2), "/data_files/0/forces/0/word: expected a word below 2, found 2"),
        (
            "/data_files/0/forces/0/on",
            json!([16]),
            "/data_files/0/forces/0/on/0: expected a bit from 0 to 15, found 16",
        ),
        ("/data_files/0/force_words", json!(65_535), "/data_files/0/force_words: expected at most 3, found 65535"),
        ("/symbols/0/address", json!("T4"), "/symbols/0/address: expected "),
        ("/symbols/0/kind", json!("adress"), "/symbols/0/kind: expected one of address, "),
        ("/diagnostics/0/severity", json!("bad"), "expected one of note, warning, error, found \"bad\""),
        ("/online/io/0/module/confidence", json!(""), "/online/io/0/module/confidence: expected one of unknown, "),
        // Members that contradict each other.
        ("/data_files/1/number", json!(0), "/data_files/1/number: expected each file once, found another file 0"),
        ("/program_files/1/number", json!(0), "/program_files/1/number: expected each file once, found another file 0"),
        ("/processor/catalog", json!("Bul.1766"), "expected \"Bul.1763\" as the model 61 has, found \"Bul.1766\""),
        (
            "/program_files/1/rungs/0/instructions/0/operands/0",
            json!("B3:7/7"),
            "/program_files/1/rungs/0/instructions: expected the operands of the text, ",
        ),
        ("/memory", json!({}), "expected a member `instruction_words_used`, found none"),
    ] {
        let error = refused(pointer, value);
        assert!(error.contains(expected), "{pointer}: {error}");
    }
}

#[test]
fn structure_counts_instead_of_text() {
    let mut document = to_json(&json_support::project());
    let rung = &mut document["program_files"][1]["rungs"][0];
    rung["text"] = json!("what a later release may write");
    rung["structure"] = json!("BST 0 NXB 1 2 BND");
    let project = from_json(&document.to_string()).expect("a project");
    let rung = &project.main.program_files[1].rungs[0];
    assert!(matches!(rung.series.as_slice(), [ladder::Element::Branch(branch)] if branch.legs.len() == 2));
    document["program_files"][1]["rungs"][0]["structure"] = json!("BST 0 NXB 1 2");
    let error = from_json(&document.to_string()).expect_err("an error").to_string();
    assert_eq!(error, "/program_files/1/rungs/0/structure: expected BND, found \"the end\"");
}

/// Nesting beyond what rung text allows still comes back.
#[test]
fn deep_branches_come_back() {
    let mut project = json_support::project();
    let mut series = vec![json_support::instruction("XIC", &["B3:0/0"])];
    for _ in 0..100 {
        series = vec![ladder::Element::Branch(ladder::Branch { legs: vec![series, Vec::new()] })];
    }
    project.main.program_files[1].rungs = vec![ladder::Rung::new(series)];
    let document = to_json(&project);
    assert_valid(&document);
    assert!(document["program_files"][1]["rungs"][0]["structure"].is_string());
    assert_eq!(from_json(&document.to_string()), Ok(project));
}

#[test]
fn text_errors_have_line_and_column() {
    for (text, expected) in [
        ("", "JSON document (line 1, column 0): expected JSON text, found EOF"),
        ("{\n]", "line 2, column 1"),
        ("[]", "expected an object, found invalid length 0"),
        ("{\"schema\":\"rungs.project/1\",\"schem\":1}", "/schem (line 1, column 35): expected one of `schema`"),
        ("{\"schema\":\"a\",\"schema\":\"b\"}", "expected `schema` once, found it again"),
    ] {
        let error = from_json(text).expect_err("an error").to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
    let document = to_json_text(&json_support::project());
    assert!(from_json(&format!("{document} x")).is_err(), "nothing may follow");
    assert!(from_json(&"[".repeat(1_000_000)).is_err());
    assert!(from_json(&format!("{{\"io\":{}", "[".repeat(1_000_000))).is_err());
    // A document cut anywhere is an error, never a smaller project.
    for end in (0..document.trim_end().len()).step_by(97).filter(|end| document.is_char_boundary(*end)) {
        assert!(from_json(&document[..end]).is_err(), "cut at {end}");
    }
}

#[test]
fn the_schema_refuses_what_is_no_project() {
    let validator = schema();
    for (pointer, value) in [
        ("/schema", json!("rungs.project/2")),
        ("/program_files/1/type", json!("SFC")),
        ("/program_files/1/rungs/0/comment", json!(5)),
        ("/program_files/1/rungs/0/instructions/0/operands/0", json!(5)),
        ("/processor/family", json!("plc-5")),
        ("/processor", json!({"family": "unknown"})),
        ("/data_files/2/values/0", json!(5)),
        ("/data_files/2/values/0/base", json!("0.1")),
        ("/data_files/5/values/0", json!(40_000)),
        ("/data_files/6/values/0", json!("nan")),
        ("/data_files/9/values/0", json!(1)),
        ("/symbols/0", json!({"address": "N7:0", "symbol": "", "description": [], "descripton": []})),
        ("/online", json!([])),
    ] {
        let mut document = to_json(&json_support::project());
        assert!(validator.is_valid(&document));
        *document.pointer_mut(pointer).expect("a member to change") = value;
        assert!(!validator.is_valid(&document), "{pointer}");
    }
    let mut document = to_json(&json_support::project());
    document.as_object_mut().expect("an object").remove("diagnostics");
    assert!(!validator.is_valid(&document));
}
