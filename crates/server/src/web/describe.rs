//! The description of the interface, in the form tools read.
//!
//! `openapi.json` says what is particular to each route. What stands before all of them is added here: the answers
//! of the guard, and the token where this server wants one.

use serde_json::{Map, Value, json};

use crate::view::Outline;

/// Answers every route can give, whoever it is asked by.
const ALWAYS: [u16; 8] = [400, 401, 403, 405, 408, 413, 429, 503];

/// What `openapi.json` says, made whole for this server: examples name what its program has.
pub(super) fn description(token: bool, program: &Outline) -> Value {
    let routine = program.routines.first().map(|it| json!(it.number));
    let file = program.data_files.first().map(|it| json!(it.label));
    let address = program.points.first().map(|it| json!(it.address));
    let examples = [("routine", routine), ("file", file), ("address", address), ("name", Some(json!("main.js")))];
    let mut all: Value = serde_json::from_str(include_str!("../../assets/openapi.json")).unwrap_or_default();
    let paths = all.get_mut("paths").and_then(Value::as_object_mut).into_iter().flat_map(Map::values_mut);
    for operation in paths.filter_map(Value::as_object_mut).flat_map(Map::values_mut) {
        let parameters = operation.get_mut("parameters").and_then(Value::as_array_mut).into_iter().flatten();
        for parameter in parameters.filter_map(Value::as_object_mut) {
            let example = examples.iter().find(|(name, _)| parameter.get("name").is_some_and(|it| it == name));
            if let Some((_, Some(example))) = example {
                parameter.insert("example".to_owned(), example.clone());
            }
        }
        let Some(responses) = operation.get_mut("responses").and_then(Value::as_object_mut) else { continue };
        for status in ALWAYS {
            responses.insert(status.to_string(), json!({"$ref": format!("#/components/responses/Problem{status}")}));
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn routes_and_description_name_the_same_paths() {
        let all = description(false, &Outline::default());
        let described: BTreeSet<&str> = all["paths"].as_object().expect("paths").keys().map(String::as_str).collect();
        let served: BTreeSet<&str> = super::super::routes().iter().map(|route| route.0).collect();
        assert_eq!(described, served);
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
        let all = description(true, &Outline::default());
        let mut count = 0;
        follow(&all, &all, &mut count);
        assert!(count > 100, "{count}");
    }
}
