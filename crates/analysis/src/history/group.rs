//! Which saves belong to one machine, and which machines go back to one project.

use std::collections::BTreeMap;

use super::{Machine, Save};

/// Instructions in common, of 1000, from which saves of one project and file name are one program.
const SAME_NAME: u32 = 300;

/// From which saves of one file name are one program though their projects were created apart: many
/// unrelated programs are called `TEST`.
const SAME_NAME_ALONE: u32 = 600;

/// From which a save of one project, whose name has another one's in it, is a later state of that one: a
/// name with a word more can be a variant too.
const NAME_WITHIN: u32 = 700;

/// From which saves with one program ID on one processor are the program of one processor.
const SAME_ID: u32 = 900;

/// From which saves of one project, by its creation time and processor name, are copies of one program:
/// only values, or a rung here and there, differ.
const SAME_PROJECT: u32 = 950;

/// From which two machines are told as related.
const RELATED: u32 = 500;

/// Related machines that are told of one.
const MOST_RELATED: usize = 5;

/// How evidence of names begins.
const NAMED: &str = "file name";

/// Letters of a name from which finding it in another one tells something.
const SHORTEST_NAME: usize = 5;

/// Saves that belong together.
pub(super) struct Group {
    pub(super) saves: Vec<usize>,
    pub(super) evidence: Vec<String>,
}

/// Who belongs to whom: a forest in which each save points towards the first of its group.
struct Forest {
    parent: Vec<usize>,
    evidence: Vec<(usize, String)>,
}

impl Forest {
    fn root(&mut self, mut at: usize) -> usize {
        while let Some(parent) = self.parent.get(at).copied().filter(|parent| *parent != at) {
            // Shortens the way for the next time.
            let above = self.parent.get(parent).copied().unwrap_or(parent);
            if let Some(place) = self.parent.get_mut(at) {
                *place = above;
            }
            at = above;
        }
        at
    }

    fn join(&mut self, a: usize, b: usize, why: impl FnOnce() -> String) {
        let (a, b) = (self.root(a), self.root(b));
        if a != b {
            self.evidence.push((a, why()));
            if let Some(place) = self.parent.get_mut(a.max(b)) {
                *place = a.min(b);
            }
        }
    }
}

/// Names that engineers leave as they were: they tell nothing.
fn says_nothing(processor_name: &str) -> bool {
    processor_name.is_empty() || processor_name.eq_ignore_ascii_case("UNTITLED")
}

pub(super) fn groups(saves: &[Save]) -> Vec<Group> {
    let mut forest = Forest { parent: (0..saves.len()).collect(), evidence: Vec::new() };
    let alike = |a: &Save, b: &Save| a.profile.similarity(&b.profile);
    for both in keyed(saves, |save| (!save.sha256.is_empty()).then(|| save.sha256.clone())) {
        for (_, i, j) in neighbours(&both) {
            forest.join(i, j, || "the same bytes".to_owned());
        }
    }
    for both in keyed(saves, |save| Some(save.name().stem)) {
        for (_, i, j) in all_pairs(&both) {
            let (Some(a), Some(b)) = (saves.get(i), saves.get(j)) else { continue };
            let created = a.created_at.is_some() && a.created_at == b.created_at;
            let empty = a.profile.is_empty() || b.profile.is_empty();
            let least = if created { SAME_NAME / 3 } else { SAME_NAME_ALONE };
            if (created && empty) || ((created || a.catalog == b.catalog) && alike(a, b) >= least) {
                forest.join(i, j, || format!("{NAMED} {}", a.name().shown));
            }
        }
    }
    // A program ID alone is not enough: one program can run in two machines.
    let by_id = |save: &Save| {
        let way = (!save.route.is_empty()).then(|| save.route.clone())?;
        Some((save.program_id?, save.catalog.clone(), save.processor_name.clone(), way))
    };
    for both in keyed(saves, by_id) {
        for ((id, ..), i, j) in all_pairs(&both) {
            let (Some(a), Some(b)) = (saves.get(i), saves.get(j)) else { continue };
            if alike(a, b) >= SAME_ID {
                forest.join(i, j, || {
                    format!("program ID {id:04X}h of one processor and the way to it, in {} and {}", a.file, b.file)
                });
            }
        }
    }
    let by_project = |save: &Save| {
        let created = save.created_at.clone()?;
        Some((created, save.catalog.clone(), save.processor_name.clone()))
    };
    for both in keyed(saves, by_project) {
        for ((created, ..), i, j) in all_pairs(&both) {
            let (Some(a), Some(b)) = (saves.get(i), saves.get(j)) else { continue };
            let shared = alike(a, b);
            let (x, y) = (a.name(), b.name());
            if shared >= NAME_WITHIN && (has_name(&x.stem, &y.stem) || has_name(&y.stem, &x.stem)) {
                let whole = if x.stem.len() < y.stem.len() { x.shown } else { y.shown };
                forest.join(i, j, || format!("{NAMED} {whole}, with something added, and creation of the project"));
            } else if shared >= SAME_PROJECT {
                forest.join(i, j, || {
                    format!(
                        "one project by its creation ({created}) and {}.{} % of the instructions, in {} and {}",
                        shared / 10,
                        shared % 10,
                        a.file,
                        b.file
                    )
                });
            }
        }
    }
    let mut found: BTreeMap<usize, Group> = BTreeMap::new();
    for save in 0..saves.len() {
        let root = forest.root(save);
        found.entry(root).or_insert_with(|| Group { saves: Vec::new(), evidence: Vec::new() }).saves.push(save);
    }
    for (save, why) in std::mem::take(&mut forest.evidence) {
        let root = forest.root(save);
        if let Some(group) = found.get_mut(&root)
            && !group.evidence.contains(&why)
        {
            group.evidence.push(why);
        }
    }
    found.into_values().map(|group| Group { evidence: names_together(group.evidence), ..group }).collect()
}

/// One name is the other with something put before or behind it.
fn has_name(long: &str, short: &str) -> bool {
    let rest = long.strip_prefix(short).map(|rest| rest.starts_with('_'));
    let rest = rest.or_else(|| long.strip_suffix(short).map(|rest| rest.ends_with('_')));
    short.len() >= SHORTEST_NAME && rest == Some(true)
}

/// One entry for all names.
fn names_together(evidence: Vec<String>) -> Vec<String> {
    let (names, mut rest): (Vec<String>, Vec<String>) = evidence.into_iter().partition(|why| why.starts_with(NAMED));
    let names: Vec<&str> = names.iter().filter_map(|why| why.strip_prefix(NAMED)).map(str::trim).collect();
    if !names.is_empty() {
        rest.insert(0, format!("{NAMED} {}", names.join(", ")));
    }
    rest
}

/// Saves by a key; those without one are left out.
fn keyed<K: Ord + Clone>(saves: &[Save], key: impl Fn(&Save) -> Option<K>) -> Vec<(K, Vec<usize>)> {
    let mut found: BTreeMap<K, Vec<usize>> = BTreeMap::new();
    for (index, save) in saves.iter().enumerate() {
        if let Some(key) = key(save) {
            found.entry(key).or_default().push(index);
        }
    }
    found.into_iter().filter(|(_, indexes)| indexes.len() > 1).collect()
}

/// Each with the next: enough where all are equal.
fn neighbours<K: Clone>(of: &(K, Vec<usize>)) -> Vec<(K, usize, usize)> {
    of.1.windows(2).filter_map(|pair| Some((of.0.clone(), *pair.first()?, *pair.get(1)?))).collect()
}

/// Saves of one key that are compared with all others of it; beyond that with the nearest ones.
const MOST_EACH: usize = 64;

fn all_pairs<K: Clone>(of: &(K, Vec<usize>)) -> Vec<(K, usize, usize)> {
    let mut pairs = Vec::new();
    for (at, i) in of.1.iter().enumerate() {
        pairs.extend(of.1.iter().skip(at + 1).take(MOST_EACH).map(|j| (of.0.clone(), *i, *j)));
    }
    pairs
}

/// For each machine others whose projects were created at the same moment, or that have a processor name
/// in common, and whose programs are alike.
pub(super) fn related(saves: &[Save], machines: &[Machine]) -> Vec<Vec<(usize, u32)>> {
    let mut found: Vec<Vec<(usize, u32)>> = vec![Vec::new(); machines.len()];
    let mut places: BTreeMap<usize, usize> = BTreeMap::new();
    for (place, machine) in machines.iter().enumerate() {
        places.extend(machine.saves.iter().map(|entry| (entry.save, place)));
    }
    let mut best: BTreeMap<(usize, usize), u32> = BTreeMap::new();
    let created = |save: &Save| save.created_at.clone();
    let named = |save: &Save| (!says_nothing(&save.processor_name)).then(|| save.processor_name.clone());
    for both in keyed(saves, created).into_iter().chain(keyed(saves, named)) {
        for (_, i, j) in all_pairs(&both) {
            let (Some(p), Some(q)) = (places.get(&i), places.get(&j)) else { continue };
            let (Some(a), Some(b)) = (saves.get(i), saves.get(j)) else { continue };
            if p != q {
                let shared = best.entry((*p.min(q), *p.max(q))).or_default();
                *shared = a.profile.similarity(&b.profile).max(*shared);
            }
        }
    }
    for ((p, q), shared) in best.into_iter().filter(|(_, shared)| *shared >= RELATED) {
        found.get_mut(p).into_iter().for_each(|list| list.push((q, shared)));
        found.get_mut(q).into_iter().for_each(|list| list.push((p, shared)));
    }
    for list in &mut found {
        list.sort_by_key(|(place, shared)| (std::cmp::Reverse(*shared), *place));
        list.truncate(MOST_RELATED);
    }
    found
}
