//! What a program does with its data, as far as the choice of memory depends on it.

use std::collections::{BTreeMap, BTreeSet};

use ladder::{Address, FileType, Image, Instruction, Operand, Place};

use super::ranges::Ranges;

/// Uses of one data file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FileUse {
    /// Some word of it is read or written as a word.
    pub words: bool,
    /// Its words are reached by run-time numbers or as a file (`#B3:0`, `B3:[N7:0]`).
    pub dynamic: bool,
}

/// What was found in all rungs.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    files: BTreeMap<(FileType, u16), FileUse>,
    /// Elements the rungs name, highest number of each file.
    highest: BTreeMap<(FileType, u16), u16>,
    /// Types of which a file is chosen at run time.
    any_file: BTreeSet<FileType>,
    /// I/O words by type, slot and word, whether used as a word, and as bits.
    io: BTreeMap<(FileType, u16, u16), (bool, bool)>,
    /// Status words named anywhere.
    status: BTreeSet<u16>,
    /// Mnemonics that occur.
    mnemonics: BTreeSet<String>,
    /// Timers whose PRE or ACC something but the timer instructions writes: file and element; `None` is
    /// the whole file.
    timers_written: BTreeSet<(u16, Option<u16>)>,
    /// Timers something but their instruction changes in any way, as above.
    timers_changed: BTreeSet<(u16, Option<u16>)>,
    /// How many timer instructions each timer has.
    timers: BTreeMap<(u16, u16), usize>,
    /// Values words can have.
    ranges: Ranges,
}

impl Facts {
    /// Reads all rungs of an image.
    pub fn of(image: &Image) -> Facts {
        let mut facts = Facts { ranges: Ranges::of(image), ..Facts::default() };
        for instruction in image.program_files.iter().flat_map(|file| &file.rungs).flat_map(|rung| rung.instructions())
        {
            if let Some(name) = instruction.mnemonic.name() {
                facts.mnemonics.insert(name.to_owned());
            }
            for address in addresses(instruction) {
                facts.address(address);
            }
            facts.timer_writes(instruction);
            // It divides the math register, which no operand names.
            if instruction.mnemonic == "DDV" {
                facts.status.extend([13, 14]);
            }
        }
        facts
    }

    /// Notes timers whose words or bits something but their own instruction changes.
    fn timer_writes(&mut self, instruction: &Instruction) {
        let name = instruction.mnemonic.name().unwrap_or_default();
        if matches!(name, "TON" | "TOF" | "RTO") {
            let address = instruction.operands.first().and_then(Operand::address);
            let element = address.and_then(|address| Some((address.file.number()?, address.element.number()?)));
            if let Some(element) = element {
                *self.timers.entry(element).or_default() += 1;
            }
            return;
        }
        let form = instr::by_mnemonic(name).and_then(|known| known.forms.first());
        for (index, operand) in instruction.operands.iter().enumerate() {
            let Some(address) = operand.address().filter(|address| address.file_type == FileType::T) else { continue };
            let writes = form.and_then(|form| form.operands.get(index)).is_none_or(|operand| operand.role.writes());
            let Some(file) = address.file.number().filter(|_| writes) else { continue };
            let whole = address.indexed || (address.word.is_none() && address.bit.is_none() && name != "RES");
            let element = address.element.number().filter(|_| !whole);
            self.timers_changed.insert((file, element));
            // A bit of PRE or ACC can be its sign.
            let number = address.bit.is_none() || address.word.is_some_and(|word| word > 0);
            if number && name != "RES" {
                self.timers_written.insert((file, element));
            }
        }
    }

    /// Nothing but its one instruction changes this timer: PRE is a constant, EN, TT, DN and ACC follow
    /// the rung.
    pub fn timer_is_plain(&self, file: u16, element: u16) -> bool {
        !self.any_file.contains(&FileType::T)
            && !self.timers_changed.contains(&(file, None))
            && !self.timers_changed.contains(&(file, Some(element)))
            && self.timer_instructions(file, element) == 1
    }

    /// How many timer instructions this timer has.
    pub fn timer_instructions(&self, file: u16, element: u16) -> usize {
        self.timers.get(&(file, element)).copied().unwrap_or(0)
    }

    /// Something but timer instructions writes words of this timer.
    pub fn timer_is_written(&self, file: u16, element: u16) -> bool {
        self.any_file.contains(&FileType::T)
            || self.timers_written.contains(&(file, None))
            || self.timers_written.contains(&(file, Some(element)))
    }

    fn address(&mut self, address: &Address) {
        for inner in address.indirections() {
            self.address(inner);
        }
        let dynamic = address.indexed || address.element.number().is_none();
        let whole_words = address.bit.is_none();
        let Some(file) = address.file.number() else {
            self.any_file.insert(address.file_type);
            return;
        };
        let usage = self.files.entry((address.file_type, file)).or_default();
        usage.dynamic |= dynamic;
        usage.words |= whole_words;
        if let Place::Number(element) = address.element {
            let highest = self.highest.entry((address.file_type, file)).or_default();
            *highest = element.max(*highest);
        }
        if address.file_type == FileType::S
            && let Place::Number(word) = address.element
        {
            self.status.insert(word);
        }
        if address.file_type.has_slots()
            && let Place::Number(slot) = address.element
        {
            let bit = address.bit.as_ref().and_then(Place::number).unwrap_or(0);
            let word = address.word.unwrap_or(0).saturating_add(bit / 16);
            let usage = self.io.entry((address.file_type, slot, word)).or_default();
            usage.0 |= whole_words;
            usage.1 |= !whole_words;
        }
    }

    /// How a data file is used.
    pub fn file(&self, file_type: FileType, number: u16) -> FileUse {
        let mut usage = self.files.get(&(file_type, number)).copied().unwrap_or_default();
        usage.dynamic |= self.any_file.contains(&file_type);
        usage
    }

    /// Files the rungs name with the highest element of each.
    pub fn named(&self) -> impl Iterator<Item = ((FileType, u16), u16)> {
        self.highest.iter().map(|(key, element)| (*key, *element))
    }

    /// I/O and module words the program names: type, slot, word; used as words, as bits.
    pub fn io(&self) -> impl Iterator<Item = ((FileType, u16, u16), (bool, bool))> {
        self.io.iter().map(|(key, usage)| (*key, *usage))
    }

    /// The word at a direct address stays between the two, whatever the program does.
    pub fn stays_within(&self, address: &Address, low: i32, high: i32) -> bool {
        let (lowest, highest) = self.ranges.word(address);
        lowest >= low && highest <= high
    }

    /// The program names this word of the status file.
    pub fn names_status(&self, word: u16) -> bool {
        self.status.contains(&word) || self.file(FileType::S, 2).dynamic
    }

    /// The program has this instruction.
    pub fn has(&self, mnemonic: &str) -> bool {
        self.mnemonics.contains(mnemonic)
    }
}

/// All addresses of an instruction, those of expressions included; those in brackets belong to theirs.
pub fn addresses(instruction: &Instruction) -> Vec<&Address> {
    let mut found = Vec::new();
    for operand in &instruction.operands {
        match operand {
            Operand::Address(address) => found.push(address),
            Operand::Expression(expression) => {
                found.extend(expression.operands().into_iter().filter_map(Operand::address));
            }
            _ => {}
        }
    }
    found
}
