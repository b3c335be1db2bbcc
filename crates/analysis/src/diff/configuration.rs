//! Processor, I/O, channels, shape of data files, names of program files.

use std::collections::BTreeMap;

use ladder::{Channel, DataFile, Image, Processor, ProgramFile, Slot};

use super::Change;
use super::logic::Matched;

/// Things of both programs by name. Things of one name keep their order.
pub(super) struct Named<K>(BTreeMap<(K, usize), [Option<String>; 2]>);

impl<K: Ord + Clone> Named<K> {
    pub(super) fn new(old: impl IntoIterator<Item = (K, String)>, new: impl IntoIterator<Item = (K, String)>) -> Self {
        let mut all: BTreeMap<(K, usize), [Option<String>; 2]> = BTreeMap::new();
        let mut side = |items: &mut dyn Iterator<Item = (K, String)>, index: usize| {
            let mut seen: BTreeMap<K, usize> = BTreeMap::new();
            for (name, text) in items {
                let count = seen.entry(name.clone()).or_default();
                let pair = all.entry((name, *count)).or_default();
                *count += 1;
                if let Some(place) = pair.get_mut(index) {
                    *place = Some(text);
                }
            }
        };
        side(&mut old.into_iter(), 0);
        side(&mut new.into_iter(), 1);
        Named(all)
    }

    /// Those that differ.
    pub(super) fn changes(self, what: &'static str, name: impl Fn(&K) -> String) -> impl Iterator<Item = Change> {
        let differing = self.0.into_iter().filter(|(_, [old, new])| old != new);
        differing.map(move |((key, _), [old, new])| Change { what, name: name(&key), old, new })
    }
}

pub(super) fn compare(old: &Image, new: &Image, matched: &Matched) -> Vec<Change> {
    let mut changes = Vec::new();
    let name = String::clone;
    changes.extend(
        Named::new(processor(&old.processor), processor(&new.processor)).changes("processor", |name| name.to_string()),
    );
    changes.extend(Named::new(slots(old), slots(new)).changes("I/O", |number| format!("slot {number}")));
    for (what, a, b) in [
        ("base unit", Some(old.io.base_unit.clone()), Some(new.io.base_unit.clone())),
        ("not read", old.io.unknown.clone(), new.io.unknown.clone()),
    ] {
        if a != b {
            changes.push(Change { what: "I/O", name: what.to_owned(), old: a, new: b });
        }
    }
    let settings = |image: &Image| image.channels.iter().flat_map(channel).collect::<Vec<_>>();
    changes.extend(Named::new(settings(old), settings(new)).changes("channel", name));
    for (a, b) in data_files(old, new) {
        let shape = |file: &DataFile| format!("{} elements of {} words", file.elements, file.words_per_element);
        // A file without elements holds nothing: a place kept free, which texts of the program do not list.
        let held = |file: Option<&DataFile>| file.filter(|file| file.elements != 0).map(shape);
        let texts = (held(a), held(b));
        let label = b.or(a).map(DataFile::label).unwrap_or_default();
        if texts.0 != texts.1 {
            changes.push(Change { what: "data file", name: label.clone(), old: texts.0, new: texts.1 });
        }
        if let (Some(a), Some(b)) = (a, b)
            && a.name != b.name
        {
            changes.push(Change {
                what: "data file name",
                name: label,
                old: Some(a.name.clone()),
                new: Some(b.name.clone()),
            });
        }
    }
    changes.extend(program_files(old, new, matched));
    changes
}

/// Names of program files, and numbers that are not ladder on both sides.
fn program_files(old: &Image, new: &Image, matched: &Matched) -> Vec<Change> {
    let became: BTreeMap<u16, u16> = matched.files.iter().copied().collect();
    let described = |file: &ProgramFile| format!("{} {:?}", file.kind.as_str(), file.name);
    let before = old.program_files.iter().map(|file| (became.get(&file.number).copied().unwrap_or(file.number), file));
    let ladder = |file: &ProgramFile| file.kind == ladder::ProgramFileKind::Ladder;
    // Ladder files of one side are logic; a free number that one side does not list is nothing.
    let mut pairs: BTreeMap<u16, [Option<&ProgramFile>; 2]> = BTreeMap::new();
    for (number, file) in before {
        pairs.entry(number).or_default()[0] = Some(file);
    }
    for file in &new.program_files {
        pairs.entry(file.number).or_default()[1] = Some(file);
    }
    let both = pairs.into_iter().filter_map(|(number, pair)| match pair {
        [Some(a), Some(b)] if ladder(a) == ladder(b) => Some((number, a, b)),
        _ => None,
    });
    both.filter(|(_, a, b)| described(a) != described(b))
        .map(|(number, a, b)| Change {
            what: "program file name",
            name: number.to_string(),
            old: Some(described(a)),
            new: Some(described(b)),
        })
        .collect()
}

/// Data files and function files of both programs by number and type.
pub(super) fn data_files<'a>(old: &'a Image, new: &'a Image) -> Vec<(Option<&'a DataFile>, Option<&'a DataFile>)> {
    fn all(image: &Image) -> impl Iterator<Item = ((bool, u16, ladder::FileType), &DataFile)> {
        let tables = image.data_files.iter().map(|file| ((false, file.number, file.file_type), file));
        tables.chain(image.function_files.iter().map(|file| ((true, file.number, file.file_type), file)))
    }
    // Of several files with one label each keeps its place.
    let mut order = Vec::new();
    let mut pairs: std::collections::HashMap<_, [Option<&DataFile>; 2]> = std::collections::HashMap::new();
    for (side, image) in [old, new].into_iter().enumerate() {
        let mut seen: std::collections::HashMap<_, usize> = std::collections::HashMap::new();
        for (key, file) in all(image) {
            let count = seen.entry(key).or_default();
            let pair = pairs.entry((key, *count)).or_insert_with(|| {
                order.push((key, *count));
                [None, None]
            });
            *count += 1;
            if let Some(place) = pair.get_mut(side) {
                *place = Some(file);
            }
        }
    }
    order.sort_by_key(|((function, number, _), count)| (*function, *number, *count));
    order.into_iter().filter_map(|key| pairs.get(&key).map(|[a, b]| (*a, *b))).collect()
}

fn processor(processor: &Processor) -> Vec<(&'static str, String)> {
    let text = |text: &Option<String>| text.clone().unwrap_or_else(|| "unknown".to_owned());
    let number =
        |number: Option<u16>| number.map_or_else(|| "not stored".to_owned(), |number| format!("{number:04X}h"));
    let state = |state: Option<bool>| match state {
        Some(true) => "yes",
        Some(false) => "no",
        None => "unknown",
    };
    vec![
        ("catalogue number", text(&processor.catalog)),
        ("name", text(&processor.name)),
        ("model number", number(processor.model)),
        ("family", processor.family.to_string()),
        ("processor name", processor.project_name.clone()),
        ("main program", processor.main_program.clone()),
        ("program ID", number(processor.program_id)),
        ("reported type", number(processor.reported_type)),
        ("driver", processor.driver.clone()),
        ("route", processor.route.clone()),
        ("deny future access", state(processor.deny_future_access).to_owned()),
        ("password fields in use", state(processor.password_fields_used).to_owned()),
    ]
}

fn slots(image: &Image) -> Vec<(u16, String)> {
    let one = |slot: &Slot| {
        let module = slot.module.catalog.clone().unwrap_or_else(|| format!("unknown ({})", slot.module.identity));
        let words = slot.configuration.iter().map(|word| format!("{word:04X}h")).collect::<Vec<_>>().join(" ");
        let range =
            |range: &ladder::IoRange| format!("{} words from {} ({} bits)", range.words, range.first_word, range.bits);
        let (inputs, outputs) = (range(&slot.inputs), range(&slot.outputs));
        (slot.number, format!("{module}, inputs {inputs}, outputs {outputs}, configuration {words}"))
    };
    image.io.slots.iter().map(one).collect()
}

fn channel(channel: &Channel) -> Vec<(String, String)> {
    let number = channel.number;
    let mut all = vec![(format!("{number}, driver"), channel.driver.clone())];
    all.extend(channel.settings.iter().map(|setting| (format!("{number}, {}", setting.name), setting.value.clone())));
    all
}
