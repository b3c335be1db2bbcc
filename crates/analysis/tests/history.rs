//! Real archives read as histories: who belongs together, in which order, on what evidence.

use std::path::{Path, PathBuf};

use analysis::history::{Machine, Order, Save, machines, steps};
use ladder::Project;
use rss::Mode;

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

fn read(paths: &[PathBuf]) -> (Vec<Save>, Vec<Project>) {
    let mut all = (Vec::new(), Vec::new());
    for path in paths {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        if let Ok(project) = convert::open(&std::fs::read(path).expect("a file"), &name, Mode::Permissive) {
            all.0.push(Save::of(&name, &project, None));
            all.1.push(project);
        }
    }
    all
}

fn files<'a>(saves: &'a [Save], machine: &Machine) -> Vec<&'a str> {
    machine.saves.iter().map(|entry| saves[entry.save].file.as_str()).collect()
}

fn of<'a>(saves: &[Save], all: &'a [Machine], part: &str) -> &'a Machine {
    let has = |machine: &&Machine| files(saves, machine).iter().any(|file| file.contains(part));
    let mut found = all.iter().filter(has);
    let machine = found.next().expect("a machine");
    assert!(found.next().is_none(), "{part} is in two machines");
    machine
}

fn archive(folder: &str) -> Option<(Vec<Save>, Vec<Project>)> {
    let root = corpus::root()?;
    let paths = corpus::files(&root, ".rss").expect("the corpus can be listed");
    let paths: Vec<PathBuf> = paths.into_iter().filter(|path| path.starts_with(root.join(folder))).collect();
    Some(read(&paths))
}

#[test]
fn backup_numbers_agree_with_the_order_by_save_times() {
    // RSLogix numbers the files it replaces: a witness of its own beside the times inside them.
    let Some((saves, _)) = archive("rslogix500") else { return };
    let all = machines(&saves);
    let (mut pairs, mut told) = (0, 0);
    for machine in &all {
        assert!(machine.saves.iter().all(|entry| entry.order == Order::SaveTime), "{}", machine.name);
        told += machine.notes.len();
        let names: Vec<_> = machine.saves.iter().map(|entry| saves[entry.save].name()).collect();
        let stems: std::collections::BTreeSet<&str> = names.iter().map(|name| name.stem.as_str()).collect();
        for stem in stems {
            let numbers: Vec<u32> =
                names.iter().filter(|name| name.stem == stem).map(|name| name.backup.unwrap_or(u32::MAX)).collect();
            pairs += numbers.windows(2).filter(|pair| pair[0] < pair[1]).count();
        }
    }
    // What disagrees is told.
    assert_eq!((saves.len(), all.len(), pairs, told), (209, 43, 132, 5));
}

#[test]
fn saves_of_one_program_are_one_machine_whatever_was_added_to_their_names() {
    let Some((saves, projects)) = archive("PLC_lowpass") else { return };
    let all = machines(&saves);
    let machine = of(&saves, &all, "bubble_sort");
    let found = files(&saves, machine);
    let expected = ["31cacf", "cb2b81", "training"];
    assert!(found.len() == 3 && found.iter().zip(expected).all(|(file, start)| file.starts_with(start)), "{found:?}");
    let machine = of(&saves, &all, "two_setpoints");
    assert_eq!(machine.saves.len(), 3);
    assert_eq!(all.len(), 2);
    let refs: Vec<&Project> = machine.saves.iter().map(|entry| &projects[entry.save]).collect();
    let found = steps(&refs);
    // A program file came with each save.
    assert!(found.len() == 2 && found.iter().all(|step| !step.change.logic.is_empty()));
}

#[test]
fn a_copy_with_live_values_differs_in_values_alone() {
    let Some((saves, projects)) = archive("PLC_alarm_bit_count") else { return };
    let all = machines(&saves);
    let machine = of(&saves, &all, "alarm_count");
    assert_eq!(files(&saves, machine), ["alarm_count.RSS", "alarm_count_live.RSS"]);
    let refs: Vec<&Project> = machine.saves.iter().map(|entry| &projects[entry.save]).collect();
    let change = &steps(&refs)[0].change;
    assert!(change.logic.is_empty() && change.documentation.is_empty() && change.configuration.is_empty());
    assert!(!change.values.is_empty());
}

/// The motor example as it was saved four times: a rung came, went, and the last save is that of the start.
#[test]
fn what_was_taken_back_is_told() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let (saves, projects) = read(&[folder.join("motor/motor.RSS"), folder.join("batch/batch.RSS")]);
    assert_eq!(machines(&saves).len(), 2);
    let first = projects[0].clone();
    let mut second = first.clone();
    second.main.program_files[2].rungs.remove(0);
    let mut third = first.clone();
    third.main.data_files.iter_mut().find(|file| file.words.len() > 1).expect("a data file").words[0] ^= 1;
    let found = steps(&[&first, &second, &third, &second, &first, &first]);
    let told: Vec<_> = found.iter().map(|step| (step.same_as, step.logic_as)).collect();
    assert_eq!(told, [(None, None), (None, Some(0)), (Some(1), Some(1)), (Some(0), Some(2)), (Some(4), None)]);
}

#[test]
fn hostile_and_empty_archives_have_a_history() {
    assert!(machines(&[]).is_empty());
    let nothing = Save { file: "\u{1B}[2J/../x\n_BAK99999999999999999999.RSS".to_owned(), ..Save::default() };
    let all = machines(&[nothing.clone(), nothing]);
    assert_eq!(all.iter().map(|machine| machine.saves.len()).sum::<usize>(), 2);
    assert!(steps(&[]).is_empty());
}
