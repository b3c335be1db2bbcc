//! Random programs of bits, timers, counters and program flow, migrated and run beside the original:
//! every word of data must agree after every scan, over stops and restarts, with uneven scan times.

mod migrate_support;

use std::fmt::Write as _;
use std::time::Duration;

use convert::migrate::{Options, Verdict};
use ladder::{Family, FileType};
use migrate_support::{Both, Dice, image};
use proptest::prelude::*;

const FAMILIES: [Family; 5] =
    [Family::Slc501, Family::Slc503, Family::MicroLogix1000, Family::MicroLogix1100, Family::MicroLogix1400];

struct Writer {
    dice: Dice,
    family: Family,
    text: String,
}

impl Writer {
    fn put(&mut self, text: &str) {
        self.text.push_str(text);
        self.text.push(' ');
    }

    fn mx(&self) -> bool {
        matches!(self.family, Family::MicroLogix1100 | Family::MicroLogix1400)
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

    fn condition(&mut self) {
        let text = match self.dice.below(10) {
            0..=4 => format!("XIC {}", self.bit()),
            5..=7 => format!("XIO {}", self.bit()),
            _ if self.mx() => format!("ONS B3:{}/{}", 4 + self.dice.below(4), self.dice.below(16)),
            _ => format!("OSR B3:{}/{}", 4 + self.dice.below(4), self.dice.below(16)),
        };
        self.put(&text);
    }

    fn conditions(&mut self, depth: u32) {
        for _ in 0..self.dice.below(3) {
            if depth < 3 && self.dice.below(4) == 0 {
                self.put("BST");
                for leg in 0..1 + self.dice.below(3) {
                    if leg > 0 {
                        self.put("NXB");
                    }
                    self.conditions(depth + 1);
                }
                self.put("BND");
            } else {
                self.condition();
            }
        }
    }

    fn rung(&mut self, number: usize, count: usize, sub: bool) {
        if number.is_multiple_of(4) && number > 0 {
            self.put(&format!("LBL {}", number / 4));
        }
        self.conditions(0);
        let next_label = number / 4 + 1;
        match self.dice.below(24) {
            0 if next_label * 4 < count => self.put(&format!("JMP {next_label}")),
            1 if !sub => self.put("JSR 3"),
            2 if sub => self.put("RET"),
            3 => self.put("MCR"),
            4 if !sub => self.put("TND"),
            5..=8 => {
                self.put("BST");
                for leg in 0..2 + self.dice.below(2) {
                    if leg > 0 {
                        self.put("NXB");
                    }
                    self.conditions(2);
                    self.output();
                }
                self.put("BND");
                if self.dice.below(3) == 0 {
                    self.conditions(1);
                    self.output();
                }
            }
            9 => {
                self.output();
                self.conditions(1);
                self.output();
            }
            _ => self.output(),
        }
    }

    fn output(&mut self) {
        let text = match self.dice.below(20) {
            0..=4 => format!("OTE {}", self.output_bit()),
            5 => format!("OTL {}", self.output_bit()),
            6 => format!("OTU {}", self.bit().replace("S:1/15", "S:5/0")),
            7..=11 => {
                let name = self.dice.pick(&["TON", "TON", "TOF", "RTO"]);
                let bases: &[&str] = match self.family {
                    Family::Slc501 => &["0.01"],
                    _ if self.mx() => &["0.001", "0.01", "1.0"],
                    _ => &["0.01", "1.0"],
                };
                format!("{name} T4:{} {} 10 0", self.dice.below(6), self.dice.pick(bases))
            }
            12..=14 => format!("{} C5:{} 3 0", self.dice.pick(&["CTU", "CTD"]), self.dice.below(4)),
            15 => format!("RES {}", self.dice.pick(&["T4:0", "T4:3", "C5:1", "C5:2", "R6:0", "R6:1"])),
            16 if self.mx() => {
                let name = self.dice.pick(&["OSR", "OSF"]);
                format!("{name} B3:{}/{} {}", 4 + self.dice.below(4), self.dice.below(16), self.output_bit())
            }
            _ => format!("OTE {}", self.output_bit()),
        };
        self.put(&text);
    }
}

fn file(seeds: &[u64], family: Family, sub: bool) -> String {
    let mut text = String::new();
    for (number, seed) in seeds.iter().enumerate() {
        let mut writer = Writer { dice: Dice(seed | 1), family, text: String::new() };
        writer.rung(number, seeds.len(), sub);
        let _ = writeln!(text, "{}", writer.text.trim());
    }
    text
}

/// Runs a program for a while: whether it was compared, or the first difference.
fn run(family: Family, main: &[u64], sub: &[u64], seed: u64, scans: usize) -> Result<bool, String> {
    let (main, sub) = (file(main, family, false), file(sub, family, true));
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
