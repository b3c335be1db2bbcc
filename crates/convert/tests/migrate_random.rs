//! Random programs of bits, timers, counters and program flow, migrated and run beside the original:
//! every word of data must agree after every scan, over stops and restarts, with uneven scan times.

mod migrate_support;
#[path = "../../sim/tests/random/shape.rs"]
mod shape;

use std::time::Duration;

use convert::migrate::{Options, Verdict};
use ladder::{Family, FileType};
use migrate_support::dice::Dice;
use migrate_support::{Both, image};
use proptest::prelude::*;
use shape::Words;

const FAMILIES: [Family; 5] =
    [Family::Slc501, Family::Slc503, Family::MicroLogix1000, Family::MicroLogix1100, Family::MicroLogix1400];

struct Vocabulary {
    dice: Dice,
    family: Family,
}

impl Vocabulary {
    fn mx(&self) -> bool {
        shape::is_mx(self.family)
    }

    fn bit(&mut self) -> String {
        let bit = self.dice.below(16);
        match self.dice.below(14) {
            0..=4 => format!("I:0/{}", self.dice.below(6)),
            5 => format!("O:0/{bit}"),
            6 | 7 => format!("T4:{}/{}", self.dice.below(6), self.dice.pick(&["EN", "TT", "DN"])),
            8 => format!("C5:{}/{}", self.dice.below(4), self.dice.pick(&["CU", "CD", "DN", "OV", "UN"])),
            9 => format!("N7:{}/{bit}", self.dice.below(4)),
            10 => "S:1/15".to_owned(),
            11 => format!("T4:{}.ACC/{}", self.dice.below(6), self.dice.below(3)),
            12 if self.family == Family::Slc503 => format!("B10:[N7:{}]/{bit}", self.dice.below(3)),
            13 if self.family == Family::Slc503 => format!("B3:{}/[N7:3]", self.dice.below(4)),
            _ => format!("B3:{}/{}", self.dice.below(4), bit % 4),
        }
    }

    fn output_bit(&mut self) -> String {
        match self.dice.below(4) {
            0 => format!("O:0/{}", self.dice.below(16)),
            1 => format!("N7:{}/{}", 4 + self.dice.below(4), self.dice.below(16)),
            _ => format!("B3:{}/{}", self.dice.below(4), self.dice.below(4)),
        }
    }
}

impl Words for Vocabulary {
    // A person has to look at such a program: there would be nothing to compare.
    const TND_IN_SUBROUTINES: bool = false;

    fn dice(&mut self) -> &mut Dice {
        &mut self.dice
    }

    fn condition(&mut self) -> String {
        match self.dice.below(10) {
            0..=4 => format!("XIC {}", self.bit()),
            5..=7 => format!("XIO {}", self.bit()),
            _ if self.mx() => format!("ONS B3:{}/{}", 4 + self.dice.below(4), self.dice.below(16)),
            _ => format!("OSR B3:{}/{}", 4 + self.dice.below(4), self.dice.below(16)),
        }
    }

    fn output(&mut self) -> String {
        match self.dice.below(20) {
            0..=4 => format!("OTE {}", self.output_bit()),
            5 => format!("OTL {}", self.output_bit()),
            6 => format!("OTU {}", self.bit().replace("S:1/15", "S:5/0")),
            7..=11 => {
                let name = self.dice.pick(&["TON", "TON", "TOF", "RTO"]);
                format!("{name} T4:{} {} 10 0", self.dice.below(6), self.dice.pick(shape::bases(self.family)))
            }
            12..=14 => format!("{} C5:{} 3 0", self.dice.pick(&["CTU", "CTD"]), self.dice.below(4)),
            15 => format!("RES {}", self.dice.pick(&["T4:0", "T4:3", "C5:1", "C5:2", "R6:0", "R6:1"])),
            16 if self.mx() => {
                let name = self.dice.pick(&["OSR", "OSF"]);
                format!("{name} B3:{}/{} {}", 4 + self.dice.below(4), self.dice.below(16), self.output_bit())
            }
            _ => format!("OTE {}", self.output_bit()),
        }
    }
}

/// Runs a program for a while: whether it was compared, or the first difference.
fn run(family: Family, main: &[u64], sub: &[u64], seed: u64, scans: usize) -> Result<bool, String> {
    let words = |dice| Vocabulary { dice, family };
    let (main, sub) = (shape::file(main, false, words), shape::file(sub, true, words));
    let mut image = image(family, &[(2, &main), (3, &sub)]);
    let mut dice = Dice(seed | 1);
    for data in &mut image.data_files {
        for (index, word) in data.words.iter_mut().enumerate() {
            *word = match (data.file_type, index % 3) {
                (FileType::T, 0) => (dice.next() as u16) & 0xE000,
                (FileType::T, 1) => dice.below(12) as u16,
                (FileType::T, _) => dice.below(14) as u16,
                (FileType::C, 0) => (dice.next() as u16) & 0xF800,
                (FileType::C, 1) => dice.below(5) as u16,
                (FileType::C, _) => match dice.below(4) {
                    0 => 0x7FFE,
                    1 => 0x8001,
                    _ => dice.below(6) as u16,
                },
                (FileType::N, _) => dice.below(8) as u16,
                (FileType::B | FileType::O, _) => dice.next() as u16,
                _ => 0,
            };
        }
    }
    let mut both = Both::new(&image, &Options { only_confirmed: seed.is_multiple_of(4) });
    let persons: Vec<_> = both.migration.rungs.iter().filter(|rung| rung.verdict == Verdict::Person).collect();
    if !persons.is_empty() {
        // What stands open is not comparable.
        return Ok(false);
    }
    both.enter_run();
    for scan in 0..scans {
        let bits = dice.next() as u16 & dice.next() as u16;
        both.input(0, bits);
        if dice.below(40) == 0 {
            both.stop();
            both.enter_run();
        }
        let dt = Duration::from_millis([0, 1, 7, 10, 13, 30, 250, 1000][dice.below(8) as usize]);
        if let Some(difference) = both.scan(dt) {
            let text = both.text();
            return Err(format!("{family}\n{difference} after {scan}\n{main}file 3\n{sub}\n{text}"));
        }
        if !both.running() {
            break;
        }
    }
    Ok(true)
}

/// `RUNGS_CASES` for long runs.
fn cases() -> u32 {
    std::env::var("RUNGS_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(200)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(), failure_persistence: None, max_shrink_iters: 4000, ..ProptestConfig::default() })]

    #[test]
    fn random_programs_stay_equal(
        family in proptest::sample::select(FAMILIES.to_vec()),
        main in proptest::collection::vec(any::<u64>(), 1..12),
        sub in proptest::collection::vec(any::<u64>(), 0..5),
        seed in any::<u64>(),
        scans in 5usize..60,
    ) {
        if let Err(difference) = run(family, &main, &sub, seed, scans) {
            return Err(TestCaseError::fail(difference));
        }
    }
}

#[test]
fn most_random_programs_are_compared() {
    let mut dice = Dice(77);
    let compared = (0..100)
        .filter(|number| {
            let main: Vec<u64> = (0..8).map(|_| dice.next()).collect();
            let sub: Vec<u64> = (0..3).map(|_| dice.next()).collect();
            let family = FAMILIES[number % FAMILIES.len()];
            run(family, &main, &sub, dice.next(), 5).unwrap_or_else(|difference| panic!("{difference}"))
        })
        .count();
    assert!(compared >= 60, "{compared} of 100");
}
