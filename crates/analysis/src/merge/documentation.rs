//! Symbols, descriptions and comments, entry by entry.

use std::collections::{BTreeMap, HashMap};
use std::hash::Hash;

use ladder::{AddressEntry, Comment, Documentation, InstructionComment, Target};

use super::{Conflict, Three, text};

/// The key of an entry: its target, its symbol where that is all there is, and which of equal ones it is.
type Key = (Target, String, usize);

pub(super) fn merge(three: Three<'_>, conflicts: &mut Vec<Conflict>) -> Documentation {
    let [base, ours, theirs] = [three.base, three.ours, three.theirs].map(|image| &image.documentation);
    let mut result = Documentation::default();
    let all = [base, ours, theirs].map(|documentation| entries(documentation));
    for key in order(&all[1].0, &all[2].0) {
        let found = [&all[0], &all[1], &all[2]].map(|(_, map)| map.get(key).copied());
        if gone(&found) {
            continue;
        }
        let name = || if key.1.is_empty() { key.0.to_string() } else { key.1.clone() };
        let symbols = found.map(|entry| entry.map(|entry| entry.symbol.as_str()).filter(|text| !text.is_empty()));
        let lines = found.map(|entry| entry.map(|entry| entry.description.join("\n")).filter(|text| !text.is_empty()));
        let symbol = text(|| format!("symbol of {}", name()), symbols, conflicts).unwrap_or_default();
        let description = text(
            || format!("description of {}", name()),
            [lines[0].as_deref(), lines[1].as_deref(), lines[2].as_deref()],
            conflicts,
        );
        let description = description.map(|text| text.split('\n').map(str::to_owned).collect()).unwrap_or_default();
        result.add(AddressEntry { target: key.0.clone(), symbol, description });
    }
    one_place(&result, [base, ours, theirs], conflicts);
    let all = [base, ours, theirs].map(|documentation| under(documentation));
    for key in order(&all[1].0, &all[2].0) {
        let found = [&all[0], &all[1], &all[2]].map(|(_, map)| map.get(key).copied());
        if gone(&found) {
            continue;
        }
        let lines = found.map(|comment| comment.map(|comment| comment.lines.join("\n")));
        let merged = text(
            || format!("comment of {} {}", key.0, key.1.as_ref().map(ToString::to_string).unwrap_or_default()),
            [lines[0].as_deref(), lines[1].as_deref(), lines[2].as_deref()],
            conflicts,
        );
        if let Some(merged) = merged {
            result.add_instruction_comment(InstructionComment {
                mnemonic: key.0.clone(),
                target: key.1.clone(),
                lines: merged.split('\n').map(str::to_owned).collect(),
            });
        }
    }
    // Comments that no rung shows: those that either side has, but those a side took out.
    let same = |a: &Comment| (a.text.clone(), a.title.clone(), format!("{:?}", a.owner));
    let set = |documentation: &Documentation| -> Vec<_> { documentation.detached_comments.iter().map(same).collect() };
    let (before, left, right) = (set(base), set(ours), set(theirs));
    for comment in &ours.detached_comments {
        let key = same(comment);
        if right.contains(&key) || !before.contains(&key) {
            result.detached_comments.push(comment.clone());
        }
    }
    for comment in &theirs.detached_comments {
        let key = same(comment);
        if !left.contains(&key) && !before.contains(&key) {
            result.detached_comments.push(comment.clone());
        }
    }
    result
}

/// One side took it out, and the other one left it as it was.
fn gone<T: PartialEq>(found: &[Option<&T>; 3]) -> bool {
    match found {
        [Some(base), Some(one), None] | [Some(base), None, Some(one)] => base == one,
        [_, None, None] => true,
        _ => false,
    }
}

/// Keys of ours, then those that only theirs has.
fn order<'k, K: Eq + Hash>(ours: &'k [K], theirs: &'k [K]) -> Vec<&'k K> {
    let known: std::collections::HashSet<&K> = ours.iter().collect();
    ours.iter().chain(theirs.iter().filter(|key| !known.contains(key))).collect()
}

fn entries(documentation: &Documentation) -> (Vec<Key>, HashMap<Key, &AddressEntry>) {
    keyed(documentation.entries(), |entry| match &entry.target {
        Target::Unassigned => (Target::Unassigned, entry.symbol.clone()),
        target => (target.clone(), String::new()),
    })
}

type UnderKey = (String, Option<Target>, usize);

fn under(documentation: &Documentation) -> (Vec<UnderKey>, HashMap<UnderKey, &InstructionComment>) {
    keyed(documentation.instruction_comments(), |comment| (comment.mnemonic.clone(), comment.target.clone()))
}

type Keyed<'a, A, B, T> = (Vec<(A, B, usize)>, HashMap<(A, B, usize), &'a T>);

fn keyed<A: Clone + Eq + Hash, B: Clone + Eq + Hash, T>(items: &[T], key: impl Fn(&T) -> (A, B)) -> Keyed<'_, A, B, T> {
    let (mut order, mut map, mut seen) = (Vec::new(), HashMap::new(), HashMap::new());
    for item in items {
        let (a, b) = key(item);
        let number = seen.entry((a.clone(), b.clone())).or_insert(0_usize);
        let key = (a, b, *number);
        *number += 1;
        order.push(key.clone());
        map.insert(key, item);
    }
    (order, map)
}

/// A symbol that two addresses have now and none of the programs had twice.
fn one_place(result: &Documentation, before: [&Documentation; 3], conflicts: &mut Vec<Conflict>) {
    fn places(documentation: &Documentation) -> BTreeMap<String, Vec<String>> {
        let mut found: BTreeMap<String, Vec<String>> = BTreeMap::new();
        for entry in documentation.entries().iter().filter(|entry| !entry.symbol.is_empty()) {
            found.entry(entry.symbol.to_uppercase()).or_default().push(entry.target.to_string());
        }
        found.retain(|_, places| places.len() > 1);
        found
    }
    let twice: Vec<_> = before.iter().map(|documentation| places(documentation)).collect();
    for (symbol, places) in places(result) {
        if twice.iter().all(|before| before.get(&symbol).is_none_or(|old| old.len() < places.len())) {
            conflicts.push(Conflict {
                what: format!("symbol {symbol} would stand for {}", places.join(" and ")),
                base: None,
                ours: places.first().cloned(),
                theirs: places.last().cloned(),
            });
        }
    }
}
