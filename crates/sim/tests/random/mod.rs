//! Random programs of all that the plain interpreter knows, and data for them.

#[path = "../../../../tests/src/dice.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod dice;
mod shape;

pub(crate) use dice::Dice;
use ladder::{DataFile, Family, FileType, Image};
use proptest::prelude::*;
use shape::Words;

/// The data files of every random program: type, number, elements.
pub(crate) const FILES: [(FileType, u16, u16); 9] = [
    (FileType::O, 0, 1),
    (FileType::I, 1, 1),
    (FileType::S, 2, 66),
    (FileType::B, 3, 8),
    (FileType::T, 4, 4),
    (FileType::C, 5, 4),
    (FileType::R, 6, 4),
    (FileType::N, 7, 24),
    (FileType::F, 8, 6),
];

/// A random program with its data and inputs.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub(crate) family: Family,
    pub(crate) main: Vec<u64>,
    pub(crate) subroutine: Vec<u64>,
    pub(crate) seed: u64,
    pub(crate) scans: usize,
    /// The program clears the overflow trap in its last rung.
    pub(crate) forgiving: bool,
}

impl Plan {
    pub(crate) fn any() -> impl Strategy<Value = Plan> {
        let families = [
            Family::Slc501,
            Family::Slc502,
            Family::Slc503,
            Family::MicroLogix1000,
            Family::MicroLogix1100,
            Family::MicroLogix1400,
        ];
        (
            proptest::sample::select(families.to_vec()),
            proptest::collection::vec(any::<u64>(), 1..14),
            proptest::collection::vec(any::<u64>(), 0..5),
            any::<u64>(),
            5usize..25,
            any::<u8>(),
        )
            .prop_map(|(family, main, subroutine, seed, scans, mood)| Plan {
                family,
                main,
                subroutine,
                seed,
                scans,
                forgiving: mood > 30,
            })
    }

    pub(crate) fn data(&self) -> Dice {
        Dice(self.seed | 1)
    }

    fn file(&self, seeds: &[u64], sub: bool) -> String {
        shape::file(seeds, sub, |dice| Vocabulary { dice, family: self.family })
    }

    pub(crate) fn files(&self) -> Vec<(u16, String)> {
        let mut main = self.file(&self.main, false);
        if self.forgiving {
            main.push_str("OTU S:5/0\nOTU S:5/2\n");
        }
        vec![(2, main), (3, self.file(&self.subroutine, true))]
    }

    pub(crate) fn text(&self) -> String {
        let files = self.files().into_iter().map(|(number, text)| format!("file {number}\n{text}"));
        format!("{}\n{}", self.family, files.collect::<String>())
    }

    pub(crate) fn image(&self) -> Image {
        let files = self.files().into_iter().map(|(number, text)| {
            let rungs = convert::slc::rung::parse_rungs(&text, Some(self.family));
            (number, rungs.unwrap_or_else(|errors| panic!("{errors:?}\n{text}")))
        });
        let mut image = sim::inline_image(self.family, files.collect());
        image.data_files =
            FILES.iter().map(|(file_type, number, elements)| DataFile::new(*file_type, *number, *elements)).collect();
        image
    }
}

impl Dice {
    /// A word that suits a place: mostly small, sometimes at the limits.
    pub(crate) fn word(&mut self, file_type: FileType, index: usize) -> u16 {
        match (file_type, index % 3) {
            (FileType::T, 0) => self.any() & 0xE000,
            (FileType::T, _) => (self.below(60)) as u16,
            (FileType::C, 0) => self.any() & 0xF800,
            (FileType::R, 0) => self.any() & 0xFF00,
            (FileType::R, _) => self.below(8) as u16,
            // Floats get moderate exponents: low words anything, high words around 1.
            (FileType::F, _) if index % 2 == 1 => 0x3F00 + (self.any() & 0x83FF),
            (FileType::B | FileType::I | FileType::O | FileType::F, _) => self.any(),
            _ => match self.below(12) {
                0 => 0x7FFF,
                1 => 0x8000,
                2 => 0xFFFF,
                3 => self.any(),
                _ => self.below(24) as u16,
            },
        }
    }
}

struct Vocabulary {
    dice: Dice,
    family: Family,
}

impl Vocabulary {
    fn mx(&self) -> bool {
        shape::is_mx(self.family)
    }

    fn has_indirect(&self) -> bool {
        self.family == Family::Slc503
    }

    fn bit(&mut self) -> String {
        let bit = self.dice.below(16);
        match self.dice.below(14) {
            0 | 1 => format!("I:0/{bit}"),
            2 => format!("O:0/{bit}"),
            3 => format!("T4:{}/{}", self.dice.below(4), self.dice.pick(&["EN", "TT", "DN"])),
            4 => format!("C5:{}/{}", self.dice.below(4), self.dice.pick(&["CU", "CD", "DN", "OV", "UN"])),
            5 => format!("R6:{}/{}", self.dice.below(4), self.dice.pick(&["EN", "EU", "DN", "EM", "ER", "UL", "FD"])),
            6 => format!("N7:{}/{bit}", self.dice.below(24)),
            7 => format!("S:0/{}", self.dice.below(4)),
            8 => format!("T4:{}.ACC/{bit}", self.dice.below(4)),
            9 if self.has_indirect() => format!("B3:[N7:{}]/{bit}", self.dice.below(3)),
            10 => format!("B3/{}", self.dice.below(128)),
            11 => "S:1/15".to_owned(),
            _ => format!("B3:{}/{bit}", self.dice.below(8)),
        }
    }

    /// A bit that nothing else has business with.
    fn output_bit(&mut self) -> String {
        let bit = self.dice.below(16);
        match self.dice.below(4) {
            0 => format!("O:0/{bit}"),
            1 => format!("N7:{}/{bit}", self.dice.below(24)),
            _ => format!("B3:{}/{bit}", self.dice.below(8)),
        }
    }

    fn word(&mut self) -> String {
        match self.dice.below(16) {
            0 => format!("T4:{}.{}", self.dice.below(4), self.dice.pick(&["ACC", "PRE"])),
            1 => format!("C5:{}.{}", self.dice.below(4), self.dice.pick(&["ACC", "PRE"])),
            2 => format!("R6:{}.POS", self.dice.below(4)),
            3 => format!("B3:{}", self.dice.below(8)),
            4 => "O:0".to_owned(),
            5 if self.has_indirect() => format!("N7:[N7:{}]", self.dice.below(4)),
            6 if self.has_indirect() => format!("T4:[N7:{}].ACC", self.dice.below(4)),
            7 if !self.mx() && self.family != Family::Slc501 => format!("#N7:{}", self.dice.below(24)),
            8 if self.has_indirect() => "N[N7:0]:1".to_owned(),
            9 => self.dice.pick(&["S:13", "S:14", "S:24"]).to_owned(),
            10 if self.has_float() => format!("F8:{}", self.dice.below(6)),
            _ => format!("N7:{}", self.dice.below(24)),
        }
    }

    fn has_float(&self) -> bool {
        self.mx() || self.family == Family::Slc503
    }

    fn source(&mut self) -> String {
        match self.dice.below(5) {
            0 => self
                .dice
                .pick(&["0", "1", "-1", "2", "7", "100", "32767", "-32768", "0FF0h", "FFFFh"])
                .replace("FFFFh", "0FFFFh"),
            1 => self.dice.below(20).to_string(),
            _ => self.word(),
        }
    }

    /// A source of whole numbers in a place where floats are not allowed.
    fn integer(&mut self) -> String {
        loop {
            let source = self.source();
            if !source.starts_with('F') {
                return source;
            }
        }
    }

    fn integer_place(&mut self) -> String {
        loop {
            let place = self.place();
            if !place.starts_with('F') {
                return place;
            }
        }
    }

    fn place(&mut self) -> String {
        // Bits of timers and lengths of control elements are written rarely: most such programs only fault.
        loop {
            let word = self.word();
            if !word.ends_with("PRE") || self.dice.below(4) == 0 {
                return word;
            }
        }
    }
}

impl Words for Vocabulary {
    const TND_IN_SUBROUTINES: bool = true;

    fn dice(&mut self) -> &mut Dice {
        &mut self.dice
    }

    fn condition(&mut self) -> String {
        match self.dice.below(12) {
            0..=4 => format!("XIC {}", self.bit()),
            5..=7 => format!("XIO {}", self.bit()),
            8 => format!("LIM {} {} {}", self.source(), self.word(), self.source()),
            9 => format!("MEQ {} {} {}", self.integer_place(), self.integer(), self.integer()),
            10 if !self.mx() => format!("OSR B3:{}/{}", self.dice.below(8), self.dice.below(16)),
            10 => format!("ONS B3:{}/{}", self.dice.below(8), self.dice.below(16)),
            _ => {
                let name = self.dice.pick(&["EQU", "NEQ", "LES", "LEQ", "GRT", "GEQ"]);
                format!("{name} {} {}", self.word(), self.source())
            }
        }
    }

    fn output(&mut self) -> String {
        match self.dice.below(26) {
            0..=3 => format!("OTE {}", self.output_bit()),
            4 => format!("OTL {}", self.output_bit()),
            5 => format!("OTU {}", self.bit().replace("S:1/15", "S:5/0")),
            6..=8 => {
                let name = self.dice.pick(&["TON", "TOF", "RTO"]);
                let base = self.dice.pick(shape::bases(self.family));
                format!("{name} T4:{} {base} {} 0", self.dice.below(4), self.dice.below(30))
            }
            9 | 10 => {
                let name = self.dice.pick(&["CTU", "CTD"]);
                format!("{name} C5:{} {} 0", self.dice.below(4), self.dice.below(10))
            }
            11 => format!("RES {}", self.dice.pick(&["T4:0", "T4:3", "C5:1", "C5:2", "R6:0", "R6:1"])),
            12 | 13 => format!("MOV {} {}", self.source(), self.place()),
            14 | 15 => {
                let name = self.dice.pick(&["ADD", "SUB", "MUL", "DIV"]);
                format!("{name} {} {} {}", self.word(), self.source(), self.place())
            }
            16 => {
                let name = self.dice.pick(&["AND", "OR", "XOR"]);
                format!("{name} {} {} {}", self.integer_place(), self.integer(), self.integer_place())
            }
            17 => {
                let name = self.dice.pick(&["NEG", "SQR", "DCD", "NOT"]);
                format!("{name} {} {}", self.integer_place(), self.integer_place())
            }
            18 => format!("MVM {} {} {}", self.integer_place(), self.integer(), self.integer_place()),
            19 => format!("CLR {}", self.place()),
            20 => format!("FLL {} #N7:{} {}", self.integer(), self.dice.below(20), self.dice.below(6)),
            21 => {
                // The source never runs out before the destination does.
                let (from, length) = (self.dice.below(12), self.dice.below(10));
                let dest = self.dice.pick(&["#N7:0", "#N7:2", "#N7:5", "#N7:20", "#B3:1", "#B3:6", "#T4:2"]);
                let length = if dest.starts_with("#T") { length % 4 } else { length };
                format!("COP #N7:{from} {dest} {length}")
            }
            22 => {
                let name = self.dice.pick(&["BSL", "BSR"]);
                format!("{name} #B3:{} R6:0 {} {}", self.dice.below(6), self.bit(), self.dice.below(40))
            }
            23 => {
                let name = self.dice.pick(&["FFL", "LFL"]);
                format!("{name} {} #N7:12 R6:1 {} 0", self.integer(), 1 + self.dice.below(8))
            }
            24 => {
                let name = self.dice.pick(&["FFU", "LFU"]);
                format!("{name} #N7:12 {} R6:1 {} 0", self.integer_place(), 1 + self.dice.below(8))
            }
            _ => {
                let length = self.dice.below(7);
                // Written with `#` an operand would step along: another instruction than the interpreter has.
                let (mask, place) = (self.integer().replace('#', ""), self.integer_place().replace('#', ""));
                match self.dice.pick(&["SQO", "SQC", "SQL"]) {
                    "SQL" => format!("SQL #N7:15 {place} R6:3 {length} 0"),
                    name => format!("{name} #N7:16 {mask} {place} R6:2 {length} 0"),
                }
            }
        }
    }
}
