//! Random programs on random data: the compiled engine against the plain interpreter, and against
//! itself saved, restored, forked and run twice.

mod random;

use std::time::Duration;

use ladder::{Address, Family, FileType, Image, Value};
use proptest::prelude::*;
use random::{FILES, Plan};
use sim::walker::Walker;
use sim::{Choices, Machine, Options, Program};

fn program(plan: &Plan, image: &Image) -> Program {
    let io = [FileType::O, FileType::I].map(|file_type| word(file_type, u16::from(file_type == FileType::I), 0));
    let options = Options { addresses: io.to_vec(), ..Options::default() };
    Program::compile(image, &options).unwrap_or_else(|refusals| panic!("{refusals:?}\n{}", plan.text()))
}

fn machine(plan: &Plan, image: &Image) -> Machine {
    Machine::new(program(plan, image))
}

/// The address of a word of a data file.
fn word(file_type: FileType, number: u16, index: usize) -> Address {
    let size = usize::from(file_type.words_per_element().unwrap_or(1));
    let (element, sub) = ((index / size) as u16, (index % size) as u16);
    match file_type {
        FileType::I | FileType::O => Address::element(file_type, number, 0).with_word(index as u16),
        _ if size == 1 => Address::element(file_type, number, element),
        _ => Address::element(file_type, number, element).with_word(sub),
    }
}

fn get(machine: &Machine, address: &Address) -> u16 {
    match machine.get(address) {
        Ok(Value::Word(word)) => word as u16,
        other => panic!("{address}: {other:?}"),
    }
}

/// Both start from the words of the machine, overwritten with random data.
fn fill(plan: &Plan, machine: &mut Machine, walker: &mut Walker<'_>) {
    let mut data = plan.data();
    for (file_type, number, _) in FILES {
        let words = walker.words(file_type, number).expect("file");
        for (index, place) in words.iter_mut().enumerate() {
            let address = word(file_type, number, index);
            let value = if file_type == FileType::S { 0 } else { data.word(file_type, index) };
            machine.set(&address, &Value::Word(value as i16)).expect("address");
            *place = value;
        }
    }
}

fn compare(plan: &Plan, scan: usize, machine: &Machine, walker: &mut Walker<'_>) {
    let fault = machine.fault().map(|fault| fault.code);
    assert_eq!(fault, walker.fault(), "scan {scan}\n{}", plan.text());
    for (file_type, number, _) in FILES {
        let words = walker.words(file_type, number).expect("file").clone();
        for (index, expected) in words.iter().enumerate() {
            // Mode codes and clocks belong to the processor, not to the program.
            if file_type == FileType::S && !matches!(index, 0 | 2 | 5 | 6 | 13 | 14 | 24) {
                continue;
            }
            let address = word(file_type, number, index);
            assert_eq!(get(machine, &address), *expected, "{address} in scan {scan}\n{}", plan.text());
        }
    }
}

fn agrees(plan: &Plan) {
    let image = plan.image();
    let mut machine = machine(plan, &image);
    let mut walker = Walker::new(&image, Choices::default(), &FILES);
    fill(plan, &mut machine, &mut walker);
    machine.enter_run();
    walker.enter_run();
    let mut inputs = plan.data();
    for scan in 0..plan.scans {
        let input = inputs.any();
        machine.set(&word(FileType::I, 1, 0), &Value::Word(input as i16)).expect("input");
        if let Some(place) = walker.words(FileType::I, 1).and_then(|words| words.first_mut()) {
            *place = input;
        }
        let dt = if scan == 0 { 0 } else { 1_700_000 * (1 + u64::from(inputs.any() % 20)) };
        machine.scan(Duration::from_nanos(dt));
        walker.scan(dt);
        compare(plan, scan, &machine, &mut walker);
        if walker.fault().is_some() {
            return;
        }
    }
}

/// The data of every scan when the machine is treated by `between` scans.
fn run(plan: &Plan, image: &Image, mut between: impl FnMut(usize, Machine) -> Machine) -> Vec<Vec<u16>> {
    let mut machine = machine(plan, image);
    let mut walker = Walker::new(image, Choices::default(), &FILES);
    fill(plan, &mut machine, &mut walker);
    machine.enter_run();
    let mut inputs = plan.data();
    (0..plan.scans)
        .map(|scan| {
            machine.set(&word(FileType::I, 1, 0), &Value::Word(inputs.any() as i16)).expect("input");
            machine.scan(Duration::from_millis(u64::from(inputs.any() % 30)));
            let data = machine.data().to_vec();
            let before = machine.save();
            let mut empty = Machine::new(program(plan, image));
            std::mem::swap(&mut machine, &mut empty);
            machine = between(scan, empty);
            assert_eq!(before, machine.save());
            data
        })
        .collect()
}

/// 500 programs unless `RUNGS_CASES` says otherwise.
fn cases() -> u32 {
    std::env::var("RUNGS_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(500)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, max_shrink_iters: 2000, ..ProptestConfig::default() })]

    #[test]
    fn engine_and_interpreter_agree(plan in Plan::any()) {
        agrees(&plan);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases() / 5, failure_persistence: None, max_shrink_iters: 500, ..ProptestConfig::default() })]

    #[test]
    fn saving_and_forking_change_nothing(plan in Plan::any(), at in 0usize..20) {
        let image = plan.image();
        let plain = run(&plan, &image, |_, machine| machine);
        let again = run(&plan, &image, |_, machine| machine);
        prop_assert_eq!(&plain, &again, "two runs");
        let restored = run(&plan, &image, |scan, machine| {
            if scan != at {
                return machine;
            }
            let bytes = machine.save();
            let mut other = Machine::new(program(&plan, &image));
            other.restore(&bytes).expect("its own state");
            other
        });
        prop_assert_eq!(&plain, &restored, "saved and restored");
        let forked = run(&plan, &image, |_, machine| machine.fork());
        prop_assert_eq!(&plain, &forked, "forked");
    }
}

#[test]
fn damaged_states_are_refused() {
    let image = sim::inline_image(Family::Slc503, vec![(2, Vec::new())]);
    let options = Options { inline: true, ..Options::default() };
    let mut machine = Machine::new(Program::compile(&image, &options).expect("program"));
    let bytes = machine.save();
    assert_eq!(machine.restore(&bytes), Ok(()));
    assert_eq!(machine.restore(&[]), Err(sim::RestoreError::NotAState));
    assert_eq!(machine.restore(&bytes[..bytes.len() - 1]), Err(sim::RestoreError::NotAState));
    let mut longer = bytes.clone();
    longer.push(0);
    assert_eq!(machine.restore(&longer), Err(sim::RestoreError::NotAState));
    let other = Options { family: Some(Family::MicroLogix1400), ..options };
    let mut other = Machine::new(Program::compile(&image, &other).expect("program"));
    assert_eq!(other.restore(&bytes), Err(sim::RestoreError::OtherProgram));
}
