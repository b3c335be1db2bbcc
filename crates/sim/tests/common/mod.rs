//! A machine on inline ladder, with addresses as text.
#![allow(dead_code)] // every test file uses its own part

use std::time::Duration;

use ladder::{Address, Family, Value};
use sim::{Choices, Machine, Options, Program};

/// A machine in run mode and the time its scans take.
pub(crate) struct Bench {
    pub(crate) machine: Machine,
    pub(crate) dt: Duration,
    scanned: bool,
}

/// Compiles `files` (number and rung texts) for a family; `addresses` must exist too.
pub(crate) fn compile(family: Family, files: &[(u16, &str)], addresses: &[&str], choices: Choices) -> Program {
    let files = files
        .iter()
        .map(|(number, text)| (*number, convert::slc::rung::parse_rungs(text, Some(family)).expect("rungs")))
        .collect();
    let image = sim::inline_image(family, files);
    let options = Options {
        inline: true,
        choices,
        addresses: addresses.iter().map(|text| Address::parse(text).expect("address")).collect(),
        ..Options::default()
    };
    Program::compile(&image, &options).expect("the program compiles")
}

impl Bench {
    /// One main program, all addresses of `data` set before entering run.
    pub(crate) fn new(family: Family, ladder: &str, data: &[(&str, i64)]) -> Bench {
        Bench::files(family, &[(2, ladder)], data, Choices::default())
    }

    pub(crate) fn files(family: Family, files: &[(u16, &str)], data: &[(&str, i64)], choices: Choices) -> Bench {
        let names: Vec<&str> =
            data.iter().map(|(name, _)| *name).chain(["S:65", "B3:7", "N7:20", "I:0", "O:0"]).collect();
        let mut machine = Machine::new(compile(family, files, &names, choices));
        for (name, value) in data {
            set(&mut machine, name, *value);
        }
        machine.enter_run();
        Bench { machine, dt: Duration::from_millis(10), scanned: false }
    }

    pub(crate) fn set(&mut self, address: &str, value: i64) -> &mut Self {
        set(&mut self.machine, address, value);
        self
    }

    pub(crate) fn scans(&mut self, count: usize) -> &mut Self {
        for _ in 0..count {
            let dt = if self.scanned { self.dt } else { Duration::ZERO };
            self.machine.scan(dt);
            self.scanned = true;
        }
        self
    }

    /// A scan with the bit 0, then one with it 1, `count` times.
    pub(crate) fn edges(&mut self, bit: &str, count: usize) -> &mut Self {
        for _ in 0..count {
            self.set(bit, 0).scans(1).set(bit, 1).scans(1);
        }
        self
    }

    #[track_caller]
    pub(crate) fn expect(&mut self, expected: &[(&str, i64)]) -> &mut Self {
        for (address, value) in expected {
            assert_eq!(self.get(address), *value, "{address}");
        }
        self
    }

    /// Bits as 0 and 1, words and long words signed.
    #[track_caller]
    pub(crate) fn get(&self, address: &str) -> i64 {
        match self.machine.get(&Address::parse(address).expect(address)).expect(address) {
            Value::Bit(on) => on.into(),
            Value::Word(word) => word.into(),
            Value::Long(long) => long.into(),
            other => panic!("{address}: {other:?}"),
        }
    }

    /// Code of the fault the machine stopped with.
    pub(crate) fn fault(&self) -> Option<u16> {
        self.machine.fault().map(|fault| fault.code)
    }
}

#[track_caller]
fn set(machine: &mut Machine, address: &str, value: i64) {
    let value = Value::Long(i32::try_from(value).expect("32 bits"));
    machine.set(&Address::parse(address).expect(address), &value).expect(address);
}
