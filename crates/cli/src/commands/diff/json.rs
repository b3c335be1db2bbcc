//! A difference as JSON.

use analysis::diff::{Change, Difference, Edit, LogicChange, Place, Rename, RungChange, ValueChange, Word};
use serde_json::{Value, json};

pub fn describe(old: &str, new: &str, difference: &Difference) -> Value {
    json!({
        "old": old,
        "new": new,
        "equal": difference.is_empty(),
        "logic": difference.logic.iter().map(logic).collect::<Value>(),
        "documentation": difference.documentation.iter().map(change).collect::<Value>(),
        "values": difference.values.iter().map(value).collect::<Value>(),
        "configuration": difference.configuration.iter().map(change).collect::<Value>(),
        "renames": difference.renames.iter().map(rename).collect::<Value>(),
        "notes": difference.notes,
    })
}

fn logic(found: &LogicChange) -> Value {
    match found {
        LogicChange::File(file) => json!({
            "what": "program file",
            "kind": file.kind.as_str(),
            "file": file.new.or(file.old),
            "old_file": file.old,
            "new_file": file.new,
            "old_rung": null,
            "new_rung": null,
            "rungs": file.rungs,
        }),
        LogicChange::Rung(rung) => self::rung(rung),
    }
}

fn rung(found: &RungChange) -> Value {
    let file = |place: Option<Place>| place.map(|place| place.file);
    let number = |place: Option<Place>| place.map(|place| place.rung);
    json!({
        "what": "rung",
        "kind": found.kind.as_str(),
        "file": file(found.new).or(file(found.old)),
        "old_file": file(found.old),
        "new_file": file(found.new),
        "old_rung": number(found.old),
        "new_rung": number(found.new),
        "only_rename": found.only_rename,
        "edits": found.edits.iter().map(edit).collect::<Value>(),
        "old_text": words(&found.old_words),
        "new_text": words(&found.new_words),
    })
}

fn words(words: &[Word]) -> Option<String> {
    (!words.is_empty()).then(|| words.iter().map(|word| word.text.as_str()).collect::<Vec<_>>().join(" "))
}

fn edit(found: &Edit) -> Value {
    json!({
        "kind": found.kind.as_str(),
        "old_instruction": found.old_instruction,
        "new_instruction": found.new_instruction,
        "mnemonic": found.mnemonic,
        "operand": found.operand,
        "old": found.old,
        "new": found.new,
    })
}

fn change(found: &Change) -> Value {
    json!({"what": found.what, "kind": found.kind().as_str(), "name": found.name, "old": found.old, "new": found.new})
}

fn value(found: &ValueChange) -> Value {
    json!({
        "file": found.file, "first": found.first, "last": found.last,
        "elements": found.old.len(), "old": found.old, "new": found.new,
    })
}

fn rename(found: &Rename) -> Value {
    json!({"old": found.old, "new": found.new, "operands": found.operands})
}
