//! Shape of random programs: labels and jumps, branches, subroutines and master control zones. Which
//! instructions stand in it is up to the test.

use ladder::Family;

use super::Dice;

/// Instructions of a test, each the next of its dice.
pub(crate) trait Words {
    /// Subroutines may end the scan.
    const TND_IN_SUBROUTINES: bool;

    fn dice(&mut self) -> &mut Dice;

    /// A condition as SLC text.
    fn condition(&mut self) -> String;

    /// An output as SLC text.
    fn output(&mut self) -> String;
}

/// The text of a file: every rung comes from a number of its own, so that a failing program shrinks by leaving
/// rungs out.
pub(crate) fn file<W: Words>(seeds: &[u64], sub: bool, words: impl Fn(Dice) -> W) -> String {
    let rungs = seeds.iter().enumerate().map(|(number, seed)| {
        let mut writer = Writer { words: words(Dice(seed | 1)), text: Vec::new() };
        writer.rung(number, seeds.len(), sub);
        writer.text.join(" ") + "\n"
    });
    rungs.collect()
}

/// MicroLogix with the instruction set of the 1100 and 1400.
pub(crate) fn is_mx(family: Family) -> bool {
    matches!(family, Family::MicroLogix1100 | Family::MicroLogix1400)
}

/// Time bases of timers.
pub(crate) fn bases(family: Family) -> &'static [&'static str] {
    match family {
        Family::Slc501 => &["0.01"],
        _ if is_mx(family) => &["0.001", "0.01", "1.0"],
        _ => &["0.01", "1.0"],
    }
}

struct Writer<W> {
    words: W,
    text: Vec<String>,
}

impl<W: Words> Writer<W> {
    fn put(&mut self, text: impl Into<String>) {
        self.text.push(text.into());
    }

    fn below(&mut self, limit: u64) -> u64 {
        self.words.dice().below(limit)
    }

    fn output(&mut self) {
        let output = self.words.output();
        self.put(output);
    }

    fn conditions(&mut self, depth: u32) {
        for _ in 0..self.below(3) {
            if depth < 3 && self.below(4) == 0 {
                let legs = 1 + self.below(3);
                self.branch(legs, |writer| writer.conditions(depth + 1));
            } else {
                let condition = self.words.condition();
                self.put(condition);
            }
        }
    }

    fn branch(&mut self, legs: u64, leg: impl Fn(&mut Self)) {
        for number in 0..legs {
            self.put(if number == 0 { "BST" } else { "NXB" });
            leg(self);
        }
        self.put("BND");
    }

    fn rung(&mut self, number: usize, count: usize, sub: bool) {
        if number.is_multiple_of(4) && number > 0 {
            self.put(format!("LBL {}", number / 4));
        }
        self.conditions(0);
        // Jumps go forward only: how instructions are counted is the engine's own business.
        let next_label = number / 4 + 1;
        match self.below(24) {
            0 if next_label * 4 < count => self.put(format!("JMP {next_label}")),
            1 if !sub => self.put("JSR 3"),
            2 if sub => self.put("RET"),
            3 => self.put("MCR"),
            4 if !sub || W::TND_IN_SUBROUTINES => self.put("TND"),
            5..=8 => {
                let legs = 2 + self.below(2);
                self.branch(legs, |writer| {
                    writer.conditions(2);
                    writer.output();
                });
                if self.below(3) == 0 {
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
}
