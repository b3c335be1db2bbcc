//! Symbol tables in CSV, written and read.

mod json_support;

use convert::csv::{read_symbols, write_symbols};
use ladder::{Documentation, Image, Target};

fn written(documentation: &Documentation) -> String {
    let mut bytes = Vec::new();
    write_symbols(documentation, &mut bytes).expect("writing to memory");
    String::from_utf8(bytes).expect("UTF-8")
}

#[test]
fn rows_are_quoted_as_the_standard_says() {
    let text = written(&json_support::project().main.documentation);
    assert_eq!(
        text,
        "address,symbol,description,kind,mnemonic\r\n\
         T4:0,LAMP_FLASH_TON,\"lamp\nflash\",address,\r\n\
         U:4,PUMPS,,program_file_operand,\r\n\
         Q2:3,,again,label,\r\n\
         program file 2,,main,program_file,\r\n\
         data file 7,,counts,data_file,\r\n\
         ,SPARE,,unassigned,\r\n\
         [?],,\"\n=1+1, \"\"quoted\"\"\",other,\r\n\
         T4:0/DN,,half a second over,instruction_comment,XIC\r\n\
         ,,,instruction_comment,0\r\n"
    );
}

#[test]
fn documentation_comes_back() {
    let project = json_support::project();
    let mut image = Image::default();
    read_symbols(&written(&project.main.documentation), &mut image).expect("a table");
    assert_eq!(image.documentation.entries(), project.main.documentation.entries());
    assert_eq!(image.documentation.instruction_comments(), project.main.documentation.instruction_comments());
    // Reading it again replaces rows by themselves; only what has no address cannot be matched.
    let before = image.documentation.entries().len();
    read_symbols("\u{feff}Symbol,Address\nPUMP,u:4\nLAMP,t4:0\n", &mut image).expect_err("u:4 is no address");
    assert_eq!(image.documentation.entries().len(), before);
    read_symbols("\u{feff}Symbol,Address\nPUMP,U:4\nLAMP,t4:0\n", &mut image).expect("a table");
    assert_eq!(image.documentation.entries().len(), before);
    let lamp = image.documentation.by_symbol("lamp").map(|entry| entry.target.to_string());
    assert_eq!(lamp.as_deref(), Some("T4:0"));
    assert_eq!(image.documentation.entry(&Target::ProgramFileOperand(4)).map(|e| e.symbol.as_str()), Some("PUMP"));
    assert!(image.documentation.by_symbol("LAMP_FLASH_TON").is_none());
}

#[test]
fn a_table_kept_by_hand_can_be_short() {
    let mut image = Image::default();
    let table = "address,symbol,description\nI:1/3,START,\"start\r\nbutton\"\nB3/17,MOTOR\n";
    read_symbols(table, &mut image).expect("a table");
    let entries = image.documentation.entries();
    assert_eq!(entries.len(), 2);
    assert_eq!(entries[0].target.to_string(), "I:1.0/3");
    assert_eq!(entries[0].description, ["start", "button"]);
    assert_eq!(entries[1].target.to_string(), "B3:1/1");
}

#[test]
fn errors_name_line_and_column() {
    for (table, expected) in [
        ("", "line 1: expected a column address, found \"\""),
        ("address;symbol\n", "line 1: expected columns from address, symbol"),
        ("address,address\n", "line 1: expected each column once"),
        ("symbol\n", "line 1: expected a column address"),
        ("address,symbol\nN7:0,A\nN7,B\n", "line 3, column address: expected an address, or its kind"),
        ("address,kind\nN7:0,adress\n", "line 2, column address: expected address, "),
        ("address,symbol\nN7:0,A,B\n", "line 2: expected 2 cells, as in the first row, found 3"),
        ("address,symbol,mnemonic\nN7:0,A,XIC\n", "line 2, column symbol: expected no symbol"),
    ] {
        let mut image = Image::default();
        let error = read_symbols(table, &mut image).expect_err(table).to_string();
        assert!(error.starts_with(expected), "{error}");
        assert_eq!(image, Image::default());
    }
}
