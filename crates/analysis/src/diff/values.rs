//! Contents of data files.

use ladder::{Address, DataFile, FileType, Image, Value, format_float};

use super::ValueChange;

/// Values of files that are in both programs with one type, element by element as far as both reach.
pub(super) fn compare(old: &Image, new: &Image) -> Vec<ValueChange> {
    let mut changes = Vec::new();
    for (a, b) in super::configuration::data_files(old, new) {
        if let (Some(a), Some(b)) = (a, b) {
            file(a, b, new, &mut changes);
        }
    }
    changes
}

fn file(a: &DataFile, b: &DataFile, image: &Image, changes: &mut Vec<ValueChange>) {
    if (a.file_type, a.words_per_element) != (b.file_type, b.words_per_element) {
        return;
    }
    // The element a run of changes ended with.
    let mut run: Option<u16> = None;
    for element in 0..a.elements.min(b.elements) {
        let (Some(x), Some(y)) = (a.element_words(element), b.element_words(element)) else { break };
        if x == y {
            continue;
        }
        let single = x.len() < 2 || matches!(a.file_type, FileType::F | FileType::L | FileType::ST);
        if !single {
            members(b, element, (x, y), changes);
            continue;
        }
        let address = address(b, element, image);
        let values = (text(a, element), text(b, element));
        match changes.last_mut().filter(|_| run.is_some() && run == element.checked_sub(1)) {
            Some(change) => {
                change.last = address;
                change.old.push(values.0);
                change.new.push(values.1);
            }
            None => changes.push(one(b, address, values.0, values.1)),
        }
        run = Some(element);
    }
    for (element, (x, y)) in (0..).zip(a.forces.iter().zip(&b.forces)) {
        if x != y {
            let masks = |force: &ladder::Force| format!("forced on {:04X}h, forced off {:04X}h", force.on, !force.off);
            changes.push(one(b, address(b, element, image), masks(x), masks(y)));
        }
    }
}

fn one(file: &DataFile, address: String, old: String, new: String) -> ValueChange {
    ValueChange { file: file.label(), first: address.clone(), last: address, old: vec![old], new: vec![new] }
}

/// Words of I and O by their slot.
fn address(file: &DataFile, element: u16, image: &Image) -> String {
    let slot = image.io.address_of(file.file_type, element);
    slot.unwrap_or_else(|| Address::element(file.file_type, file.number, element)).to_string()
}

fn text(file: &DataFile, element: u16) -> String {
    match file.value(element) {
        Some(Value::Word(word)) => word.to_string(),
        Some(Value::Long(long)) => long.to_string(),
        Some(Value::Float(float)) => {
            // Two patterns can print alike; the difference must be visible.
            let bits = float.to_bits();
            let text = format_float(float);
            if text.parse::<f32>().map(f32::to_bits) == Ok(bits) { text } else { format!("{text} ({bits:08X}h)") }
        }
        Some(Value::Text(text)) => {
            let words = file.element_words(element).unwrap_or_default();
            let used = words.first().copied().unwrap_or(0);
            format!("{text:?}, {used} characters")
        }
        _ => {
            let words = file.element_words(element).unwrap_or_default();
            words.iter().map(|word| format!("{word:04X}h")).collect::<Vec<_>>().join(" ")
        }
    }
}

/// The members of an element that differ: `T4:0.ACC`, `C5:1/DN`.
fn members(file: &DataFile, element: u16, words: (&[u16], &[u16]), changes: &mut Vec<ValueChange>) {
    let whole = || Address::element(file.file_type, file.number, element);
    for (word, (x, y)) in (0..).zip(words.0.iter().zip(words.1)) {
        if x == y {
            continue;
        }
        let flags = word == 0 && matches!(file.file_type, FileType::T | FileType::C | FileType::R);
        if !flags {
            let address = whole().with_word(word).to_string();
            changes.push(one(file, address, (*x as i16).to_string(), (*y as i16).to_string()));
            continue;
        }
        for bit in (0..16).rev() {
            let (p, q) = (x >> bit & 1, y >> bit & 1);
            if p != q {
                changes.push(one(file, whole().with_bit(bit).to_string(), p.to_string(), q.to_string()));
            }
        }
    }
}
