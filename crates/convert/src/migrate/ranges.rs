//! Which values a word can have, as far as the program alone decides.
//!
//! Every instruction that writes a word widens what is known of it, until nothing changes any more;
//! the order of the program plays no part. So an index that is always masked or only made of bits is
//! known to stay in its file. A word the program never writes is there for somebody outside to write:
//! it can have any value.

use std::collections::{BTreeMap, HashMap};

use ladder::{Address, Element, FileType, Image, Instruction, Operand, Place, Series};

/// Values a word can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Range {
    /// Lowest and highest value.
    pub(super) low: i32,
    pub(super) high: i32,
    /// Bits that can be 1.
    ones: u16,
}

const FULL: Range = Range { low: -32_768, high: 32_767, ones: 0xFFFF };

impl Range {
    fn constant(value: i16) -> Range {
        Range { low: value.into(), high: value.into(), ones: value as u16 }
    }

    /// Any combination of these bits.
    fn mask(ones: u16) -> Range {
        if ones & 0x8000 != 0 { FULL } else { Range { low: 0, high: ones.into(), ones } }
    }

    fn between(low: i32, high: i32) -> Range {
        if low < -32_768 || high > 32_767 {
            return FULL;
        }
        let ones =
            if low < 0 { 0xFFFF } else { (u32::from(high as u16) + 1).next_power_of_two().wrapping_sub(1) as u16 };
        Range { low, high, ones }
    }

    fn join(self, other: Range) -> Range {
        Range { low: self.low.min(other.low), high: self.high.max(other.high), ones: self.ones | other.ones }
    }

    /// `self` with the bits of `source` where the mask can be 1.
    fn blend(self, source: Range, mask: Range) -> Range {
        let kept = match mask.low == mask.high {
            true => self.ones & !(mask.low as u16),
            false => self.ones,
        };
        Range::mask(kept | source.ones & mask.ones)
    }
}

/// Ranges of all words of the data table.
#[derive(Clone, Debug, Default)]
pub(super) struct Ranges {
    files: BTreeMap<(FileType, u16), File>,
}

#[derive(Clone, Debug)]
struct File {
    size: usize,
    words: Vec<Range>,
    /// Words the program writes.
    written: Vec<bool>,
}

impl File {
    fn join(&mut self, first: usize, count: usize, range: impl Fn(usize) -> Range) {
        let words = self.words.iter_mut().zip(&mut self.written).skip(first).take(count);
        for (index, (word, written)) in words.enumerate() {
            *word = word.join(range(index));
            *written = true;
        }
    }
}

/// Rounds after which whatever still grows can have any value.
const ROUNDS: usize = 6;

impl Ranges {
    pub(super) fn of(image: &Image) -> Ranges {
        let mut ranges = Ranges::default();
        for file in &image.data_files {
            let known = matches!(file.file_type, FileType::N | FileType::B | FileType::T | FileType::C | FileType::R);
            if known {
                let words: Vec<_> = file.words.iter().map(|word| Range::constant(*word as i16)).collect();
                let size = usize::from(file.words_per_element.max(1));
                let written = vec![false; words.len()];
                ranges.files.insert((file.file_type, file.number), File { size, words, written });
            }
        }
        let (mut masked, mut bounded) = (HashMap::new(), HashMap::new());
        for rung in image.program_files.iter().flat_map(|file| &file.rungs) {
            masked_sums(&rung.series, &mut masked, 0);
            bounded_sums(&rung.series, &mut bounded, 0);
        }
        for round in 0..ROUNDS + 4 {
            let before = ranges.files.clone();
            for rung in image.program_files.iter().flat_map(|file| &file.rungs) {
                for instruction in rung.instructions() {
                    let this = std::ptr::from_ref(instruction);
                    match (masked.get(&this), bounded.get(&this)) {
                        (Some(mask), _) => ranges.write(instruction.operands.get(2), Range::mask(*mask)),
                        (None, Some(highest)) => {
                            let low = ranges.read(instruction.operands.get(2)).low;
                            ranges.write(instruction.operands.get(2), Range::between(low.min(*highest), *highest));
                        }
                        (None, None) => ranges.apply(instruction),
                    }
                }
            }
            if round == 0 {
                ranges.open_unwritten();
                continue;
            }
            let mut changed = false;
            for (key, file) in &mut ranges.files {
                let Some(old) = before.get(key) else { continue };
                for (word, old) in file.words.iter_mut().zip(&old.words) {
                    changed |= word != old;
                    if word != old && round >= ROUNDS {
                        *word = FULL;
                    }
                }
            }
            if !changed {
                return ranges;
            }
        }
        // Not settled: nothing is known.
        Ranges::default()
    }

    /// What the program does not write, others may; presets and lengths stay what they are set to.
    fn open_unwritten(&mut self) {
        let plain = |key: &(FileType, u16)| matches!(key.0, FileType::N | FileType::B);
        for file in self.files.iter_mut().filter(|(key, _)| plain(key)).map(|(_, file)| file) {
            for (word, written) in file.words.iter_mut().zip(&file.written) {
                if !written {
                    *word = FULL;
                }
            }
        }
    }

    /// Lowest and highest value of the word at a direct address.
    pub(super) fn word(&self, address: &Address) -> (i32, i32) {
        let range = self.read_address(address);
        (range.low, range.high)
    }

    fn place(&self, address: &Address) -> Option<(FileType, u16, usize)> {
        let file = address.file.number()?;
        let found = self.files.get(&(address.file_type, file))?;
        if address.indexed {
            return None;
        }
        let sub = usize::from(address.word.unwrap_or(0));
        Some((address.file_type, file, usize::from(address.element.number()?) * found.size + sub))
    }

    fn read_address(&self, address: &Address) -> Range {
        if address.bit.is_some() {
            return FULL;
        }
        if let Some((file_type, file, word)) = self.place(address) {
            let found = self.files.get(&(file_type, file));
            return found.and_then(|file| file.words.get(word)).copied().unwrap_or(FULL);
        }
        let all = address.file.number().and_then(|file| self.files.get(&(address.file_type, file)));
        match all.filter(|file| file.size == 1 && !address.indexed) {
            Some(file) => file.words.iter().copied().reduce(Range::join).unwrap_or(FULL),
            None => FULL,
        }
    }

    fn read(&self, operand: Option<&Operand>) -> Range {
        match operand {
            Some(Operand::Address(address)) => self.read_address(address),
            Some(Operand::Constant(constant)) => match constant.as_integer() {
                Some(value) if (-32_768..=65_535).contains(&value) => Range::constant(value as u16 as i16),
                _ => FULL,
            },
            _ => FULL,
        }
    }

    /// A word can have these values too. What is decided at run time is the whole file, or all of a type.
    fn write(&mut self, operand: Option<&Operand>, range: Range) {
        let Some(Operand::Address(address)) = operand else { return };
        if let Some((file_type, file, word)) = self.place(address) {
            let Some(file) = self.files.get_mut(&(file_type, file)) else { return };
            // A structure without a member is all of its words.
            let count = if address.word.is_none() && address.bit.is_none() { file.size } else { 1 };
            file.join(word, count, |_| range);
            return;
        }
        let number = address.file.number();
        let chosen = self
            .files
            .iter_mut()
            .filter(|(key, _)| key.0 == address.file_type && number.is_none_or(|number| number == key.1));
        chosen.for_each(|(_, file)| file.join(0, usize::MAX, |_| range));
    }

    /// One bit changes.
    fn write_bit(&mut self, operand: Option<&Operand>) {
        let Some(Operand::Address(address)) = operand else { return };
        let bit = match &address.bit {
            Some(Place::Number(bit)) => 1_u16.checked_shl(u32::from(*bit)).unwrap_or(0),
            _ => 0xFFFF,
        };
        let word = Address { bit: None, ..address.clone() };
        match self.place(&Address { word: word.word.or(Some(0)), ..word.clone() }) {
            Some((file_type, file, index)) if bit != 0xFFFF => {
                if let Some(file) = self.files.get_mut(&(file_type, file)) {
                    let ones = file.words.get(index).map_or(0xFFFF, |word| word.ones);
                    file.join(index, 1, |_| Range::mask(ones | bit));
                }
            }
            _ => self.write(
                Some(&Operand::Address(Address { element: Place::Indirect(Box::new(word.clone())), ..word })),
                FULL,
            ),
        }
    }

    fn apply(&mut self, instruction: &Instruction) {
        let name = instruction.mnemonic.name().unwrap_or_default();
        let at = |index: usize| instruction.operands.get(index);
        match name {
            "MOV" => self.write(at(1), self.read(at(0))),
            "CLR" => self.write(at(0), Range::constant(0)),
            "AND" => self.write(at(2), Range::mask(self.read(at(0)).ones & self.read(at(1)).ones)),
            "OR" | "XOR" => self.write(at(2), Range::mask(self.read(at(0)).ones | self.read(at(1)).ones)),
            "MVM" => self.write(at(2), self.read(at(2)).blend(self.read(at(0)), self.read(at(1)))),
            "ADD" | "SUB" => {
                let (a, b) = (self.read(at(0)), self.read(at(1)));
                let sum = match name {
                    "ADD" => Range::between(a.low + b.low, a.high + b.high),
                    _ => Range::between(a.low - b.high, a.high - b.low),
                };
                self.write(at(2), sum);
            }
            "OTE" | "OTL" | "OTU" | "ONS" | "OSR" | "OSF" => {
                instruction.operands.iter().for_each(|operand| self.write_bit(Some(operand)));
            }
            "TON" | "TOF" | "RTO" => {
                // ACC counts up from 0 and stops at PRE.
                let preset = self.part(at(0), 1);
                self.write_part(at(0), 0, FULL);
                self.write_part(at(0), 2, Range::between(0, preset.high.max(0)));
            }
            "CTU" | "CTD" => {
                self.write_part(at(0), 0, FULL);
                self.write_part(at(0), 2, FULL);
            }
            "RES" => {
                self.write_part(at(0), 0, FULL);
                self.write_part(at(0), 2, Range::constant(0));
            }
            "SQO" | "SQC" | "SQL" => self.sequencer(name, instruction),
            "BSL" | "BSR" => {
                // POS and LEN stay as they are.
                self.write(at(0), FULL);
                self.write_part(at(1), 0, FULL);
            }
            "FFL" | "LFL" | "FFU" | "LFU" => {
                // The stack or the destination; POS stays within the stack.
                let length = self.part(at(2), 1);
                self.write(at(if matches!(name, "FFL" | "LFL") { 1 } else { 0 }), FULL);
                if matches!(name, "FFU" | "LFU") {
                    self.write(at(1), FULL);
                }
                self.write_part(at(2), 0, FULL);
                self.write_part(at(2), 2, if length.low > 0 { Range::between(0, length.high) } else { FULL });
            }
            "FLL" => self.fill(instruction),
            "COP" | "CPW" => self.copy(name, instruction),
            _ => self.others(name, instruction),
        }
    }

    /// A word of a structured element.
    fn write_part(&mut self, operand: Option<&Operand>, word: u16, range: Range) {
        if let Some(Operand::Address(address)) = operand {
            let part = Address { word: Some(word), ..address.clone() };
            self.write(Some(&Operand::Address(part)), range);
        }
    }

    fn part(&self, operand: Option<&Operand>, word: u16) -> Range {
        match operand {
            Some(Operand::Address(address)) => self.read_address(&Address { word: Some(word), ..address.clone() }),
            _ => FULL,
        }
    }

    fn sequencer(&mut self, name: &str, instruction: &Instruction) {
        let at = |index: usize| instruction.operands.get(index);
        let control = at(if name == "SQL" { 2 } else { 3 });
        let length = self.part(control, 1);
        self.write_part(control, 0, FULL);
        self.write_part(control, 2, if length.low > 0 { Range::between(0, length.high) } else { FULL });
        match name {
            "SQO" => {
                // Any word of the file from its start on.
                let file =
                    at(0).and_then(Operand::address).map(|address| Address { indexed: false, ..address.clone() });
                let mut source = FULL;
                if let Some((file_type, number, word)) = file.and_then(|address| self.place(&address))
                    && let Some(found) = self.files.get(&(file_type, number))
                    && let Ok(steps) = usize::try_from(length.high)
                {
                    let words = found.words.iter().skip(word).take(steps.saturating_add(1)).copied();
                    source = words.reduce(Range::join).unwrap_or(FULL);
                }
                let stepped = |operand: Option<&Operand>| {
                    operand.and_then(Operand::address).is_some_and(|address| address.indexed)
                };
                let mask = if stepped(at(1)) { FULL } else { self.read(at(1)) };
                if stepped(at(2)) {
                    self.write(at(2), FULL);
                } else {
                    self.write(at(2), self.read(at(2)).blend(source, mask));
                }
            }
            "SQL" => self.write(at(0), FULL),
            _ => {}
        }
    }

    fn fill(&mut self, instruction: &Instruction) {
        let at = |index: usize| instruction.operands.get(index);
        let value = self.read(at(0));
        let length = at(2).and_then(Operand::constant).and_then(|constant| constant.as_integer());
        let start = at(1).and_then(Operand::address).map(|address| Address { indexed: false, ..address.clone() });
        let place = start.and_then(|address| self.place(&address));
        match (place, length.and_then(|length| usize::try_from(length).ok())) {
            (Some((file_type, number, word)), Some(length)) => {
                if let Some(file) = self.files.get_mut(&(file_type, number)) {
                    let range = if file.size == 1 { value } else { FULL };
                    file.join(word, length.saturating_mul(file.size), |_| range);
                }
            }
            _ => self.write(at(1), FULL),
        }
    }

    /// COP and CPW of a fixed length between fixed places: word by word.
    fn copy(&mut self, name: &str, instruction: &Instruction) {
        let at = |index: usize| instruction.operands.get(index);
        let length = at(2).and_then(Operand::constant).and_then(|constant| constant.as_integer());
        let place = |ranges: &Ranges, operand: Option<&Operand>| {
            let address = operand.and_then(Operand::address)?;
            ranges.place(&Address { indexed: false, ..address.clone() })
        };
        let ends = (place(self, at(0)), place(self, at(1)), length.and_then(|length| usize::try_from(length).ok()));
        let (Some((from_type, from_file, from)), Some((to_type, to_file, to)), Some(length)) = ends else {
            return self.others(name, instruction);
        };
        let size = self.files.get(&(to_type, to_file)).map_or(1, |file| file.size);
        let words = if name == "COP" { length.saturating_mul(size) } else { length };
        let source: Vec<Range> = self
            .files
            .get(&(from_type, from_file))
            .map(|file| file.words.iter().skip(from).take(words).copied().collect())
            .unwrap_or_default();
        let Some(file) = self.files.get_mut(&(to_type, to_file)) else { return };
        file.join(to, words, |index| source.get(index).copied().unwrap_or(FULL));
    }

    /// Everything an instruction writes can have any value.
    fn others(&mut self, name: &str, instruction: &Instruction) {
        let form = instr::by_mnemonic(name).and_then(|known| known.forms.first());
        for (index, operand) in instruction.operands.iter().enumerate() {
            let writes = form.and_then(|form| form.operands.get(index)).is_none_or(|operand| operand.role.writes());
            let Some(address) = operand.address().filter(|_| writes) else { continue };
            let file = address.indexed || address.word.is_none() && address.bit.is_none();
            // A file or structure: how far it reaches does not matter, all of the file is open.
            let whole = Address { element: Place::Indirect(Box::new(address.clone())), ..address.clone() };
            let operand = if file { Operand::Address(whole) } else { operand.clone() };
            match &operand {
                Operand::Address(address) if address.bit.is_some() => self.write_bit(Some(&operand)),
                _ => self.write(Some(&operand), FULL),
            }
        }
    }
}

/// Nesting of branches that is looked at.
const MAX_DEPTH: usize = 32;

/// Sums that a mask follows at once, in the same power flow: `ADD N7:0 1 N7:0` beside
/// `AND N7:0 255 N7:0`. Their result is never seen without the mask.
fn masked_sums(series: &Series, found: &mut HashMap<*const Instruction, u16>, depth: usize) {
    if depth > MAX_DEPTH {
        return;
    }
    for (element, next) in series.iter().zip(series.iter().skip(1)) {
        if let (Element::Instruction(first), Element::Instruction(second)) = (element, next) {
            note_masked(first, second, found);
        }
    }
    for element in series {
        let Element::Branch(branch) = element else { continue };
        for (leg, next) in branch.legs.iter().zip(branch.legs.iter().skip(1)) {
            if let ([Element::Instruction(first)], [Element::Instruction(second)]) = (leg.as_slice(), next.as_slice()) {
                note_masked(first, second, found);
            }
        }
        for leg in &branch.legs {
            masked_sums(leg, found, depth + 1);
        }
    }
}

fn note_masked(first: &Instruction, second: &Instruction, found: &mut HashMap<*const Instruction, u16>) {
    if let Some(mask) = mask_behind(first, second) {
        found.insert(std::ptr::from_ref(first), mask);
    }
}

/// Counting up that a comparison right before it ends: `LES N7:0 100 ADD N7:0 1 N7:0`, with the highest
/// result of each.
fn bounded_sums(series: &Series, found: &mut HashMap<*const Instruction, i32>, depth: usize) {
    if depth > MAX_DEPTH {
        return;
    }
    for (element, next) in series.iter().zip(series.iter().skip(1)) {
        let Element::Instruction(compare) = element else { continue };
        let sum = match next {
            Element::Instruction(sum) => Some(sum),
            Element::Branch(branch) => match branch.legs.first().and_then(|leg| leg.first()) {
                Some(Element::Instruction(sum)) => Some(sum),
                _ => None,
            },
        };
        if let Some(sum) = sum
            && let Some(highest) = highest_sum(compare, sum)
        {
            found.insert(std::ptr::from_ref(sum), highest);
        }
    }
    for element in series {
        let Element::Branch(branch) = element else { continue };
        branch.legs.iter().for_each(|leg| bounded_sums(leg, found, depth + 1));
    }
}

/// The highest result of `ADD x n x` behind `LES x k` or `LEQ x k`.
fn highest_sum(compare: &Instruction, sum: &Instruction) -> Option<i32> {
    let ([word, limit], [a, b, result]) = (compare.operands.as_slice(), sum.operands.as_slice()) else { return None };
    let last = match compare.mnemonic.name()? {
        "LES" => 1,
        "LEQ" => 0,
        _ => return None,
    };
    let step = if a == word { b } else { a };
    let direct = word.address().is_some_and(Address::is_direct);
    if sum.mnemonic != "ADD" || !direct || result != word || (a != word && b != word) {
        return None;
    }
    let number = |operand: &Operand| i32::try_from(operand.constant()?.as_integer()?).ok();
    let (limit, step) = (number(limit)?, number(step).filter(|step| *step >= 0)?);
    limit.checked_sub(last)?.checked_add(step).filter(|highest| (0..=32_767).contains(highest))
}

/// The mask that the second instruction puts on the result of the first, a sum.
fn mask_behind(first: &Instruction, second: &Instruction) -> Option<u16> {
    let to = first.operands.get(2)?;
    let [a, b, result] = second.operands.as_slice() else { return None };
    let sum = first.mnemonic == "ADD" || first.mnemonic == "SUB";
    let direct = to.address().is_some_and(Address::is_direct);
    if !sum || !direct || second.mnemonic != "AND" || result != to {
        return None;
    }
    let mask = if a == to {
        b
    } else if b == to {
        a
    } else {
        return None;
    };
    let mask = mask.constant()?.as_integer()?;
    u16::try_from(mask).ok().filter(|mask| *mask <= 0x7FFF)
}

#[cfg(test)]
mod tests {
    use ladder::{DataFile, Family};

    use super::*;

    fn word(rungs: &str, address: &str) -> (i32, i32) {
        let rungs = crate::slc::rung::parse_rungs(rungs, Some(Family::MicroLogix1400)).expect("rungs");
        let file = ladder::ProgramFile {
            number: 2,
            name: String::new(),
            description: String::new(),
            kind: ladder::ProgramFileKind::Ladder,
            rungs,
        };
        let mut image = Image { program_files: vec![file], ..Image::default() };
        image.data_files = vec![
            DataFile::new(FileType::B, 3, 4),
            DataFile::new(FileType::T, 4, 4),
            DataFile::new(FileType::R, 6, 2),
            DataFile::new(FileType::N, 7, 20),
        ];
        image.data_files[2].words[1] = 4;
        for (index, value) in [5, 7, 9, 11, 13].into_iter().enumerate() {
            image.data_files[3].words[10 + index] = value;
        }
        Ranges::of(&image).word(&Address::parse(address).expect("an address"))
    }

    #[test]
    fn masks_and_bits_bound_a_word() {
        assert_eq!(word("BST ADD N7:0 1 N7:0 NXB AND N7:0 255 N7:0 BND", "N7:0"), (0, 255));
        assert_eq!(word("ADD N7:0 1 N7:0\nAND N7:0 255 N7:0", "N7:0"), (-32_768, 32_767));
        assert_eq!(word("XIC B3:0/0 OTE N7:0/1\nXIC B3:0/1 OTL N7:0/0", "N7:0"), (0, 3));
        assert_eq!(word("OTE N7:0/1\nOTE N7:1/0\nOR N7:0 N7:1 N7:2\nXOR N7:2 7 N7:2", "N7:2"), (0, 7));
        assert_eq!(word("OTE N7:0/15", "N7:0"), (-32_768, 32_767));
        assert_eq!(word("MOV 5 N7:0\nMOV N7:0 N7:1\nMOV -2 N7:0", "N7:1"), (-2, 5));
        assert_eq!(word("MOV 5 N7:[N7:3]", "N7:0"), (0, 5));
        assert_eq!(word("MOV N7:1 N7:0", "N7:0"), (-32_768, 32_767), "N7:1 is for somebody else to write");
        assert_eq!(word("MOV T4:0.ACC N7:0\nMOV 99 T4:0.PRE\nTON T4:0 0.01 10 0", "N7:0"), (0, 99));
        assert_eq!(word("OTE N7:0/2\nCOP #N7:0 #N7:3 3\nFLL 0 #N7:0 3", "N7:3"), (0, 4));
        assert_eq!(word("MOV C5:0.ACC N7:0", "N7:0"), (-32_768, 32_767));
    }

    #[test]
    fn sequencers_stay_inside_their_length() {
        let rungs = "SQO #N7:10 00FFh T4:1.PRE R6:0 4 0\nTON T4:1 1.0 25 0";
        assert_eq!(word(rungs, "R6:0.POS"), (0, 4));
        assert_eq!(word(rungs, "T4:1.PRE"), (0, 255));
        assert_eq!(word(&format!("{rungs}\nMOV -1 R6:0.POS"), "R6:0.POS"), (-1, 4));
        assert_eq!(word(&format!("{rungs}\nCOP #N7:0 #R6:0 1"), "R6:0.POS"), (-32_768, 32_767));
    }

    #[test]
    fn counting_up_that_a_comparison_ends_is_bounded() {
        assert_eq!(word("CLR N7:1\nLES N7:1 12 BST ADD N7:1 1 N7:1 NXB OTL B3:0/0 BND", "N7:1"), (0, 12));
        assert_eq!(word("LEQ N7:1 12 ADD N7:1 2 N7:1", "N7:1"), (0, 14));
        assert_eq!(word("LES N7:2 12 ADD N7:1 1 N7:1", "N7:1"), (-32_768, 32_767), "another word is compared");
    }
}
