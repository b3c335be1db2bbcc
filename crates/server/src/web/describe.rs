//! The description of the interface, in the form tools read.
//!
//! `openapi.json` says what is particular to each route. What stands before all of them is added here: the answers
//! of the guard, and the token where this server wants one.

use serde_json::{Map, Value, json};

use super::ASKED_OF_A_PROGRAM;
use super::pair::{OTHER_PATHS, PATHS};
use crate::view::Outline;

/// Answers every route can give, whoever it is asked by.
const ALWAYS: [u16; 8] = [400, 401, 403, 405, 408, 413, 429, 503];

/// What `openapi.json` says, made whole for this server: examples name what its programs have. What is asked of the
/// original can be asked of the other program too; what only two programs have stands there where two are served.
pub(super) fn description(token: bool, program: &Outline, other: Option<&Outline>) -> Value {
    let mut all: Value = serde_json::from_str(include_str!("../../assets/openapi.json")).unwrap_or_default();
    if let Some(paths) = all.get_mut("paths").and_then(Value::as_object_mut) {
        match other {
            None => paths.retain(|path, _| !PATHS.contains(&path.as_str())),
            Some(other) => {
                let mut theirs: Map<String, Value> = Map::new();
                for path in ASKED_OF_A_PROGRAM {
                    let own = paths.get(&format!("/api/{path}")).cloned().unwrap_or_default();
                    theirs.insert(format!("{OTHER_PATHS}{path}"), own);
                }
                for operation in operations(&mut theirs) {
                    if let Some(Value::String(summary)) = operation.get_mut("summary") {
                        summary.push_str(", of the other program");
                    }
                }
                exemplify(&mut theirs, other);
                exemplify(paths, program);
                paths.append(&mut theirs);
            }
        }
        if other.is_none() {
            exemplify(paths, program);
        }
        for operation in operations(paths) {
            let Some(responses) = operation.get_mut("responses").and_then(Value::as_object_mut) else { continue };
            for status in ALWAYS {
                let shape = json!({"$ref": format!("#/components/responses/Problem{status}")});
                responses.insert(status.to_string(), shape);
            }
        }
    }
    let shape = all.pointer_mut("/components/schemas/Address").and_then(Value::as_object_mut);
    if let (Some(shape), Some(point)) = (shape, program.points.first()) {
        shape.insert("examples".to_owned(), json!([point.address]));
    }
    if let (true, Some(all)) = (token, all.as_object_mut()) {
        all.insert("security".to_owned(), json!([{"bearer": []}, {"cookie": []}]));
    }
    all
}

fn operations(paths: &mut Map<String, Value>) -> impl Iterator<Item = &mut Map<String, Value>> {
    let operations = paths.values_mut().filter_map(Value::as_object_mut).flat_map(Map::values_mut);
    operations.filter_map(Value::as_object_mut)
}

/// Parameters get examples that this program has.
fn exemplify(paths: &mut Map<String, Value>, program: &Outline) {
    let routine = program.routines.first().map(|it| json!(it.number));
    let file = program.data_files.first().map(|it| json!(it.label));
    let address = program.points.first().map(|it| json!(it.address));
    let examples = [("routine", routine), ("file", file), ("address", address), ("name", Some(json!("main.js")))];
    for operation in operations(paths) {
        let parameters = operation.get_mut("parameters").and_then(Value::as_array_mut).into_iter().flatten();
        for parameter in parameters.filter_map(Value::as_object_mut) {
            let example = examples.iter().find(|(name, _)| parameter.get("name").is_some_and(|it| it == name));
            if let Some((_, Some(example))) = example {
                parameter.insert("example".to_owned(), example.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn routes_and_description_name_the_same_paths() {
        let (one, other) = (Outline::default(), Outline::default());
        let described = |other| -> BTreeSet<String> {
            let all = description(false, &one, other);
            all["paths"].as_object().expect("paths").keys().cloned().collect()
        };
        let served: BTreeSet<String> = super::super::routes().into_iter().map(|route| route.0).collect();
        assert_eq!(described(Some(&other)), served);
        let alone: BTreeSet<String> = described(None);
        let of_two: Vec<&String> = served.difference(&alone).collect();
        assert_eq!(of_two.len(), ASKED_OF_A_PROGRAM.len() + PATHS.len(), "{of_two:?}");
    }

    #[test]
    fn every_reference_leads_somewhere() {
        fn follow(all: &Value, part: &Value, count: &mut usize) {
            match part {
                Value::Object(map) => {
                    if let Some(Value::String(path)) = map.get("$ref") {
                        assert!(path.strip_prefix('#').is_some_and(|path| all.pointer(path).is_some()), "{path}");
                        *count += 1;
                    }
                    map.values().for_each(|part| follow(all, part, count));
                }
                Value::Array(list) => list.iter().for_each(|part| follow(all, part, count)),
                _ => {}
            }
        }
        let all = description(true, &Outline::default(), Some(&Outline::default()));
        let mut count = 0;
        follow(&all, &all, &mut count);
        assert!(count > 100, "{count}");
    }
}
