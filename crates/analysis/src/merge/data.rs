//! Data tables: shape, names, values and forces.

use std::collections::BTreeMap;

use ladder::{Address, DataFile, FileType, Image};

use super::{Conflict, Side, Three, decide, text};

/// Values kept from ours that a note names.
const NAMED: usize = 6;

pub(super) fn merge(three: Three<'_>, image: &mut Image, conflicts: &mut Vec<Conflict>, notes: &mut Vec<String>) {
    let mut kept: Vec<String> = Vec::new();
    let tables = [three.base, three.ours, three.theirs].map(|image| image.data_files.as_slice());
    image.data_files = files(tables, conflicts, &mut kept);
    let functions = [three.base, three.ours, three.theirs].map(|image| image.function_files.as_slice());
    image.function_files = files(functions, conflicts, &mut kept);
    if !kept.is_empty() {
        let shown: Vec<&str> = kept.iter().take(NAMED).map(String::as_str).collect();
        let more = if kept.len() > NAMED { " and others" } else { "" };
        notes.push(format!(
            "{} values of data tables differ on both sides; those of ours stay: {}{more}",
            kept.len(),
            shown.join(", ")
        ));
    }
}

/// Files of one number and type are one file; several of one key keep their order.
type Key = (u16, FileType, usize);

fn keyed(files: &[DataFile]) -> (Vec<Key>, BTreeMap<String, &DataFile>) {
    let (mut order, mut map, mut seen) = (Vec::new(), BTreeMap::new(), BTreeMap::new());
    for file in files {
        let count = seen.entry(format!("{:?} {}", file.file_type, file.number)).or_insert(0_usize);
        let key = (file.number, file.file_type, *count);
        *count += 1;
        map.insert(format!("{key:?}"), file);
        order.push(key);
    }
    (order, map)
}

/// A number that no file uses.
fn is_free(file: &DataFile) -> bool {
    file.file_type == FileType::Unused
}

fn files(all: [&[DataFile]; 3], conflicts: &mut Vec<Conflict>, kept: &mut Vec<String>) -> Vec<DataFile> {
    let [base, ours, theirs] = all.map(keyed);
    let mut result: Vec<DataFile> = Vec::new();
    let only_theirs = theirs.0.iter().filter(|key| !ours.1.contains_key(&format!("{key:?}")));
    for key in ours.0.iter().chain(only_theirs) {
        let name = format!("{key:?}");
        let found = [base.1.get(&name), ours.1.get(&name), theirs.1.get(&name)].map(Option::<&&DataFile>::copied);
        match found {
            [b, Some(o), Some(t)] => result.push(file(b, o, t, conflicts, kept)),
            // Taken out by one side, and no longer as it was on the other.
            [Some(b), Some(one), None] | [Some(b), None, Some(one)] if !is_free(one) && b != one => {
                conflicts.push(Conflict {
                    what: format!("data file {} was deleted on one side and changed on the other", one.label()),
                    base: Some(format!("{} elements", b.elements)),
                    ours: found[1].map(|file| format!("{} elements", file.elements)),
                    theirs: found[2].map(|file| format!("{} elements", file.elements)),
                });
                result.push(one.clone());
            }
            [None, Some(one), None] | [None, None, Some(one)] => result.push(one.clone()),
            // Gone on one side and as it was on the other; or a free number, which comes with its new type.
            _ => {}
        }
    }
    numbers(result, all, conflicts)
}

/// One file for each number: a free number gives way, two files of one number are a conflict.
fn numbers(files: Vec<DataFile>, all: [&[DataFile]; 3], conflicts: &mut Vec<Conflict>) -> Vec<DataFile> {
    let doubled = |list: &[DataFile], file: &DataFile| {
        list.iter().filter(|other| other.number == file.number && !is_free(other)).count() > 1
    };
    let mut result: Vec<DataFile> = Vec::new();
    for file in files {
        // Function files and the M files share numbers among types from the start.
        let shares = all.iter().any(|list| doubled(list, &file));
        match result.iter_mut().find(|other| other.number == file.number).filter(|_| !shares) {
            None => result.push(file),
            Some(other) if is_free(other) => *other = file,
            Some(_) if is_free(&file) => {}
            Some(other) => conflicts.push(Conflict {
                what: format!("data file {} is of another type on each side", file.number),
                base: None,
                ours: Some(other.label()),
                theirs: Some(file.label()),
            }),
        }
    }
    result.sort_by_key(|file| (matches!(file.file_type, FileType::M0 | FileType::M1), file.number));
    if all[1].is_sorted_by_key(|file| file.number) {
        return result;
    }
    // Function files keep the order they are stored in.
    let place = |file: &DataFile| {
        let same = |other: &DataFile| other.number == file.number && other.file_type == file.file_type;
        all[1].iter().position(same).unwrap_or(usize::MAX)
    };
    result.sort_by_key(place);
    result
}

fn file(
    base: Option<&DataFile>,
    ours: &DataFile,
    theirs: &DataFile,
    conflicts: &mut Vec<Conflict>,
    kept: &mut Vec<String>,
) -> DataFile {
    let label = ours.label();
    let mut part = |what: &str, of: fn(&DataFile) -> &str| {
        let all = [base.map(of), Some(of(ours)), Some(of(theirs))];
        text(|| format!("{what} of data file {label}"), all, conflicts).unwrap_or_default()
    };
    let (name, description) = (part("name", |file| &file.name), part("description", |file| &file.description));
    let mut result = DataFile { name, description, ..ours.clone() };
    if ours.words_per_element != theirs.words_per_element {
        if ours.elements > 0 || theirs.elements > 0 {
            conflicts.push(Conflict {
                what: format!("data file {label} has elements of another size on each side"),
                base: base.map(|file| file.words_per_element.to_string()),
                ours: Some(ours.words_per_element.to_string()),
                theirs: Some(theirs.words_per_element.to_string()),
            });
        }
        return result;
    }
    // Both grew: what either side added has room in the larger one.
    let before = base.map_or(0, |file| file.elements);
    let elements = match decide(&before, &ours.elements, &theirs.elements) {
        Some(Side::Ours) => ours.elements,
        Some(Side::Theirs) => theirs.elements,
        None => ours.elements.max(theirs.elements),
    };
    let size = usize::from(ours.words_per_element);
    let mut words = Vec::with_capacity(usize::from(elements).saturating_mul(size));
    let structure = matches!(ours.file_type, FileType::T | FileType::C | FileType::R);
    for element in 0..elements {
        let of = |file: Option<&DataFile>| file.and_then(|file| file.element_words(element)).map(<[u16]>::to_vec);
        let zero = || vec![0; size];
        let (b, o, t) = (of(base), of(Some(ours)), of(Some(theirs)));
        let (Some(o), Some(t)) = (&o, &t) else {
            words.extend(o.or(t).unwrap_or_else(zero));
            continue;
        };
        let b = b.unwrap_or_else(zero);
        if !structure {
            match decide(&b, o, t) {
                Some(Side::Theirs) => words.extend(t),
                Some(Side::Ours) => words.extend(o),
                None => {
                    kept.push(Address::element(ours.file_type, ours.number, element).to_string());
                    words.extend(o);
                }
            }
            continue;
        }
        for (number, word) in (0_u8..).zip(o.iter().enumerate()) {
            let (index, own) = word;
            let (old, other) = (b.get(index).copied().unwrap_or(0), t.get(index).copied().unwrap_or(*own));
            let address =
                || Address::element(ours.file_type, ours.number, element).with_word(number.into()).to_string();
            words.push(match decide(&old, own, &other) {
                Some(Side::Theirs) => other,
                Some(Side::Ours) => *own,
                // Presets and lengths are set by people.
                None if number == 1 => {
                    let text = |word: u16| Some(word.cast_signed().to_string());
                    conflicts.push(Conflict {
                        what: address(),
                        base: text(old),
                        ours: text(*own),
                        theirs: text(other),
                    });
                    *own
                }
                None => {
                    kept.push(address());
                    *own
                }
            });
        }
    }
    result.elements = elements;
    result.words = words;
    if elements != ours.elements && elements == theirs.elements {
        result.forces.clone_from(&theirs.forces);
    }
    let forces = |file: Option<&DataFile>| file.map(|file| file.forces.clone()).unwrap_or_default();
    match decide(&forces(base), &ours.forces, &theirs.forces) {
        Some(Side::Theirs) if elements == theirs.elements => result.forces.clone_from(&theirs.forces),
        None => conflicts.push(Conflict {
            what: format!("forces of data file {label}"),
            base: base.map(|_| "the forces of the base".to_owned()),
            ours: Some("the forces of ours".to_owned()),
            theirs: Some("the forces of theirs".to_owned()),
        }),
        _ => {}
    }
    result
}
