//! Saves of one machine in order, each with what its place rests on.

use std::collections::BTreeMap;

use super::{Entry, Name, Order, Save};

/// A save with what its place is found by.
struct Placed {
    entry: Entry,
    name: Name,
}

/// The saves in order, and what contradicts itself in words.
pub(super) fn in_order(saves: &[Save], group: &[usize]) -> (Vec<Entry>, Vec<String>) {
    let mut placed: Vec<Placed> = Vec::new();
    let mut by_bytes: BTreeMap<&str, usize> = BTreeMap::new();
    // Of copies the one with the plainest name stands for all.
    let mut sorted: Vec<(usize, &Save, Name)> =
        group.iter().filter_map(|index| saves.get(*index).map(|save| (*index, save, save.name()))).collect();
    sorted.sort_by(|(_, a, x), (_, b, y)| {
        let plain = |name: &Name| (name.backup.is_some(), name.stem.clone(), name.backup);
        (plain(x), a.file.len(), &a.file).cmp(&(plain(y), b.file.len(), &b.file))
    });
    for (index, save, name) in sorted {
        if let Some(first) = by_bytes.get(save.sha256.as_str()).filter(|_| !save.sha256.is_empty()) {
            placed.get_mut(*first).into_iter().for_each(|placed| placed.entry.copies.push(index));
            continue;
        }
        by_bytes.insert(&save.sha256, placed.len());
        let (order, when) = match (&save.saved_at, &name.date, &save.modified) {
            (Some(time), ..) => (Order::SaveTime, Some(time.clone())),
            (None, Some(date), _) => (Order::DateInName, Some(date.clone())),
            (None, None, Some(time)) => (Order::FileTime, Some(time.clone())),
            (None, None, None) => (Order::NameOnly, None),
        };
        placed.push(Placed { entry: Entry { save: index, order, when, copies: Vec::new() }, name });
    }
    let (mut sure, rest): (Vec<Placed>, Vec<Placed>) =
        placed.into_iter().partition(|placed| placed.entry.order == Order::SaveTime);
    sure.sort_by(|a, b| (&a.entry.when, number(&a.name)).cmp(&(&b.entry.when, number(&b.name))));
    let mut notes = contradictions(saves, &sure);
    place_rest(&mut sure, rest);
    for pair in sure.windows(2) {
        if let [a, b] = pair
            && a.entry.order == Order::SaveTime
            && b.entry.order == Order::SaveTime
            && a.entry.when == b.entry.when
        {
            let file = |placed: &Placed| saves.get(placed.entry.save).map(|s| s.file.clone()).unwrap_or_default();
            notes.push(format!(
                "{} and {} hold the same save time: which came first is not known, they stand by number and name",
                file(a),
                file(b)
            ));
        }
    }
    (sure.into_iter().map(|placed| placed.entry).collect(), notes)
}

/// Backups by number, the file itself behind them.
fn number(name: &Name) -> (u64, &str) {
    (name.backup.map_or(u64::MAX, u64::from), &name.stem)
}

/// Puts saves without a save time among the others: by backup number beside one of the same name, else by
/// the time they have, else at the end.
fn place_rest(sure: &mut Vec<Placed>, mut rest: Vec<Placed>) {
    rest.sort_by(|a, b| (&a.name.stem, number(&a.name)).cmp(&(&b.name.stem, number(&b.name))));
    for mut placed in rest {
        let siblings = |other: &&Placed| {
            other.name.stem == placed.name.stem && (other.name.backup.is_some() || placed.name.backup.is_some())
        };
        let at = if sure.iter().any(|other| siblings(&other)) {
            placed.entry.order = Order::BackupNumber;
            // A date that did not decide is not the time of its place.
            placed.entry.when = None;
            let later = |other: &Placed| siblings(&other) && number(&other.name) > number(&placed.name);
            let before = sure.iter().position(later);
            before.or_else(|| sure.iter().rposition(|other| siblings(&other)).map(|last| last + 1))
        } else {
            let later = |other: &Placed| match (&other.entry.when, &placed.entry.when) {
                (Some(other), Some(own)) => other > own,
                _ => false,
            };
            sure.iter().position(later)
        };
        sure.insert(at.unwrap_or(sure.len()), placed);
    }
}

/// Backup numbers that go down while save times go up.
fn contradictions(saves: &[Save], sure: &[Placed]) -> Vec<String> {
    let mut last: BTreeMap<&str, &Placed> = BTreeMap::new();
    let mut notes = Vec::new();
    for placed in sure {
        if let Some(before) = last.insert(&placed.name.stem, placed)
            && number(&before.name).0 > number(&placed.name).0
        {
            let file = |placed: &Placed| saves.get(placed.entry.save).map(|s| s.file.clone()).unwrap_or_default();
            notes.push(format!(
                "{} was saved after {}, though its name says the opposite: the save times in the files count",
                file(placed),
                file(before)
            ));
        }
    }
    notes
}

#[cfg(test)]
mod tests {
    use super::*;

    fn save(file: &str, saved_at: Option<&str>, modified: Option<&str>) -> Save {
        Save {
            file: file.to_owned(),
            sha256: file.to_owned(),
            saved_at: saved_at.map(str::to_owned),
            modified: modified.map(str::to_owned),
            ..Save::default()
        }
    }

    fn order(saves: &[Save]) -> (Vec<(&str, Order)>, Vec<String>) {
        let all: Vec<usize> = (0..saves.len()).collect();
        let (entries, notes) = in_order(saves, &all);
        (entries.iter().map(|entry| (saves[entry.save].file.as_str(), entry.order)).collect(), notes)
    }

    #[test]
    fn save_times_come_before_numbers_and_numbers_before_file_times() {
        let saves = [
            save("P.RSS", Some("2020-01-05T00:00:00Z"), None),
            save("P_BAK002.RSS", None, Some("1999-01-01T00:00:00Z")),
            save("P_BAK001.RSS", Some("2020-01-01T00:00:00Z"), None),
            save("P_BAK003.RSS", Some("2020-01-03T00:00:00Z"), None),
            save("Q_Feb_02_2021.SLC", None, Some("1999-01-01T00:00:00Z")),
            save("R.SLC", None, Some("2020-01-04T00:00:00Z")),
            save("S.SLC", None, None),
        ];
        let (found, notes) = order(&saves);
        assert_eq!(
            found,
            [
                ("P_BAK001.RSS", Order::SaveTime),
                ("P_BAK002.RSS", Order::BackupNumber),
                ("P_BAK003.RSS", Order::SaveTime),
                ("R.SLC", Order::FileTime),
                ("P.RSS", Order::SaveTime),
                ("Q_Feb_02_2021.SLC", Order::DateInName),
                ("S.SLC", Order::NameOnly),
            ]
        );
        assert!(notes.is_empty());
    }

    #[test]
    fn contradictions_are_told() {
        let saves = [
            save("P_BAK002.RSS", Some("2020-01-01T00:00:00Z"), None),
            save("P_BAK001.RSS", Some("2020-01-02T00:00:00Z"), None),
            save("P.RSS", Some("2020-01-02T00:00:00Z"), None),
        ];
        let (found, notes) = order(&saves);
        let files: Vec<&str> = found.iter().map(|(file, _)| *file).collect();
        assert_eq!(files, ["P_BAK002.RSS", "P_BAK001.RSS", "P.RSS"]);
        assert_eq!(notes.len(), 2, "{notes:?}");
        assert!(notes[0].contains("the opposite") && notes[1].contains("same save time"), "{notes:?}");
    }

    #[test]
    fn copies_are_one_entry() {
        let mut saves = [save("P_BAK001.RSS", None, None), save("P.RSS", None, None), save("P (2).RSS", None, None)];
        saves.iter_mut().for_each(|save| save.sha256 = "same".to_owned());
        let (entries, _) = in_order(&saves, &[0, 1, 2]);
        assert_eq!(entries.len(), 1);
        assert_eq!((entries[0].save, entries[0].copies.as_slice()), (1, [2, 0].as_slice()));
    }
}
