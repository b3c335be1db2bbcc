//! Projects that were saved while their controllers ran: what one scan recomputes from the stored
//! inputs and data must be what the controller had stored.
//!
//! A controller is read piece by piece over many scans while it runs, so words that were moving at that
//! moment need not fit each other. Such a difference is explained when the program itself shows the
//! movement, see [`Reason`]; a turned contact must make the image as a whole agree better, so that it
//! cannot explain a word at the cost of others. In the projects known to have been saved while
//! running every other difference stands in [`EXPLAINED`]. Of all other projects whose S:1 says run,
//! many were changed after they were read from their controllers; they count in sum only.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::time::Duration;

use instr::{Kind, Role};
use ladder::{Address, FileType, Image, Instruction, Operand, Value};
use sim::{Machine, Options, Program, Recorder, Unsupported};

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod place;

/// Projects known to have been saved while running, by the beginning or a part of the file name, and
/// the least share of recomputed bits that agrees.
const KNOWN: &[(&str, f64)] = &[
    ("_live", 1.0),
    ("training_bubble_sort_running", 0.60),
    ("_running", 0.94),
    ("LANLOGIX_BR", 0.98),
    ("SW2012_BE", 0.99),
    ("SW2014_AK", 0.99),
    ("SW2084_AD", 0.99),
    ("TVZ_1100_REV02", 1.0),
];

/// Least share over all projects whose S:1 says run.
const LEAST_SHARE: f64 = 0.95;

/// Differences with a reason of their own: file, address, reason.
const EXPLAINED: &[(&str, &str, &str)] = &[
    ("LANLOGIX_BR", "N200:0", "control bits of a message sequence: without a network no message ends"),
    (
        "LANLOGIX_BR",
        "N200:34",
        "one-shot of the end of message MG201:1, which went on between the readings of the two files",
    ),
    (
        "LANLOGIX_BR",
        "N7:124",
        "3.0 - 0.5 into an integer: 3 was stored, halves to the even integer (printed) give 2; `float-ties-away` \
         gives 3; open",
    ),
    ("SW2012_BE", "C5:19.0", "CU follows MG68:0/DN: the message went on between the readings of the two files"),
    (
        "SW2084_AD",
        "B3:0",
        "bit 15 follows S:36/1 alone, which is stored as 1; SW2012_BE has the same rung on the same firmware and \
         agrees: the status file was read at another moment",
    ),
    ("SW2084_AD", "B69:1", "scratch word of a subroutine that a message sequence calls with another word in each step"),
    (
        "SW2084_AD",
        "N27:2",
        "MVM, MOV and SWP: no order of them gives the stored pair N27:2, N27:3; SW2012_BE has the same rung on the \
         same firmware and agrees; the pair was written from elsewhere, open by what",
    ),
    ("SW2084_AD", "N27:3", "as N27:2"),
    ("SW2084_AD", "N64:0", "copy of C5:3.ACC, which is stored as 0: the counters and N64 are not of the same moment"),
    (
        "training_bubble_sort_running",
        "T4:1.0",
        "stored while timing: it is alive for 100 ms between two loops, and the bit of its rung was read before",
    ),
    ("training_bubble_sort_running", "T4:1.ACC", "as T4:1.0"),
    ("training_bubble_sort_running", "N7:2", "made from S:35, the measured time of the last scan"),
];

/// Mode codes of S:1 in which a program is executed: remote run, run.
const RUNNING: [u16; 2] = [6, 30];

/// Bits by word: under its text the address of the word, and which of its bits.
type Bits = BTreeMap<String, (Address, u32)>;

fn add(found: &mut Bits, machine: &Machine, address: &Address, mask: u32) {
    if let Some((mut word, bits)) = place(machine, address) {
        if word.file_type.has_slots() {
            word.word.get_or_insert(0);
        }
        found.entry(word.to_string()).or_insert((word, 0)).1 |= bits & mask;
    }
}

/// The word or long word an address lies in, and its bits there.
fn place(machine: &Machine, address: &Address) -> Option<(Address, u32)> {
    let kind = machine.kind(address).ok()?;
    match kind {
        sim::Kind::Bit => {
            let bit = address.bit.as_ref()?.number()?;
            let mut word = Address { bit: None, ..address.clone() };
            let long = matches!(machine.kind(&word).ok()?, sim::Kind::Long | sim::Kind::Float);
            if word.file_type.has_slots() {
                word.word = Some(word.word.unwrap_or(0) + bit / 16);
            } else if bit > 15 && !long {
                return None;
            }
            Some((word, 1 << if long { bit } else { bit % 16 }))
        }
        sim::Kind::Word => Some((address.clone(), 0xFFFF)),
        sim::Kind::Long | sim::Kind::Float => Some((address.clone(), u32::MAX)),
        _ => None,
    }
}

fn bits(machine: &Machine, address: &Address) -> u32 {
    match machine.get(address) {
        Ok(Value::Word(word)) => u32::from(word as u16),
        Ok(Value::Long(long)) => long as u32,
        Ok(Value::Float(float)) => float.to_bits(),
        _ => 0,
    }
}

/// What an executed instruction recomputes. `power`: it had power.
fn results(machine: &Machine, instruction: &Instruction, power: bool, found: &mut Bits) {
    let Some(entry) = instruction.mnemonic.name().and_then(instr::by_mnemonic) else { return };
    let operands = &instruction.operands;
    let Some(form) = entry.form_for(machine.family(), operands.len()).or(entry.forms.first()) else { return };
    let mut add = |address: &Address, mask: u32| add(found, machine, address, mask);
    for (operand, given) in form.operands.iter().zip(operands) {
        let Operand::Address(address) = given else { continue };
        if !address.is_direct() {
            continue;
        }
        let control = address.clone().with_word(0);
        match (operand.kind, entry.mnemonic) {
            // EN, TT, DN follow the rung; ACC follows time.
            (Kind::Timer, _) => add(&control, 0xE000),
            (Kind::Counter, "CTU") => add(&control, 0xA000),
            (Kind::Counter, "CTD") => add(&control, 0x6000),
            (Kind::Bit, "OTE") => add(address, u32::MAX),
            _ if !power || !matches!(operand.role, Role::Write | Role::ReadWrite) => {}
            (Kind::Resettable, _) => {
                add(&control, 0xE000);
                add(&address.clone().with_word(2), u32::MAX);
            }
            _ => add(address, u32::MAX),
        }
    }
}

/// Every word of the data table but inputs, texts and what belongs to the processor.
fn words(image: &Image, machine: &Machine) -> Vec<Address> {
    let mut all = Vec::new();
    for file in &image.data_files {
        let size = file.words_per_element.max(1);
        for element in 0..file.elements {
            match file.file_type {
                FileType::I | FileType::ST | FileType::S => {}
                FileType::O => all.extend(image.io.address_of(FileType::O, element)),
                FileType::F | FileType::L => all.push(Address::element(file.file_type, file.number, element)),
                _ if size == 1 => all.push(Address::element(file.file_type, file.number, element)),
                _ => all.extend(
                    (0..size).map(|word| Address::element(file.file_type, file.number, element).with_word(word)),
                ),
            }
        }
    }
    all.retain(|address| place(machine, address).is_some());
    all
}

/// Why a word may differ.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Reason {
    /// It takes the stored value within a minute, inputs unchanged.
    Time,
    /// Every differing bit moves within a minute, inputs unchanged, but not to the stored value then.
    Moves,
    /// It holds the stored value with another value of one input: an analog one at most 16 counts away,
    /// or a word of contacts with one of them turned and the image as a whole agreeing better.
    Input(String),
    /// It stands in [`EXPLAINED`].
    Listed(&'static str),
    /// None found.
    Open,
}

/// One image before and after a scan.
struct Compared<'a> {
    image: &'a Image,
    /// As it was saved, in run mode.
    saved: Machine,
    /// What one scan recomputes: word, bits, stored value.
    recomputed: Vec<(Address, u32, u32)>,
    /// Input words of which the program names bits; the others are analog.
    contacts: BTreeSet<String>,
}

impl Compared<'_> {
    /// Bits that differ from what was stored.
    fn wrong(&self, machine: &Machine) -> u32 {
        let row =
            |(address, mask, stored): &(Address, u32, u32)| ((bits(machine, address) ^ stored) & mask).count_ones();
        self.recomputed.iter().map(row).sum()
    }

    /// The reason the program itself shows. `differing`: the bits in question, `least`: bits of the
    /// whole image that differ with the stored inputs.
    fn reason(&self, address: &Address, stored: u32, differing: u32, least: u32) -> Reason {
        let mut machine = self.saved.fork();
        let mut moved = 0;
        for step in [10, 100, 1000] {
            for _ in 0..55 {
                machine.scan(Duration::from_millis(step));
                let value = bits(&machine, address);
                if value == stored {
                    return Reason::Time;
                }
                moved |= !(value ^ stored);
            }
        }
        if moved & differing == differing {
            return Reason::Moves;
        }
        let inputs = self.image.data_file(FileType::I, 1).map_or(0, |file| file.elements);
        for input in (0..inputs).filter_map(|word| self.image.io.address_of(FileType::I, word)) {
            let word = bits(&self.saved, &input) as u16;
            let contacts = self.contacts.contains(&input.to_string());
            let values: Vec<u16> = match contacts {
                true => (0..16).map(|bit| word ^ 1 << bit).collect(),
                false => (1..=16).flat_map(|step| [word.wrapping_add(step), word.wrapping_sub(step)]).collect(),
            };
            for value in values {
                let mut machine = self.saved.fork();
                let _ = machine.set(&input, &Value::Word(value as i16));
                machine.scan(Duration::ZERO);
                if bits(&machine, address) == stored && (!contacts || self.wrong(&machine) < least) {
                    return Reason::Input(format!("{input} {value:#06X}, stored {word:#06X}"));
                }
            }
        }
        Reason::Open
    }
}

/// What became of one image.
#[derive(Default)]
struct Outcome {
    bits: u32,
    wrong: u32,
    /// Words that differ: address, values, reason.
    differences: Vec<(Address, String, Reason)>,
}

impl Outcome {
    fn share(&self) -> f64 {
        1.0 - f64::from(self.wrong) / f64::from(self.bits.max(1))
    }

    fn count(&self, wanted: impl Fn(&Reason) -> bool) -> usize {
        self.differences.iter().filter(|row| wanted(&row.2)).count()
    }

    /// `Err`: refused or faulted.
    fn of(image: &Image) -> Result<Outcome, String> {
        let options = Options { unsupported: Unsupported::Fault, ..Options::default() };
        let program = Program::compile(image, &options).map_err(|refusals| format!("refused: {}", refusals[0]))?;
        let stored = Machine::new(program);
        let mut saved = stored.fork();
        saved.resume();
        let mut machine = saved.fork();
        let mut recorder = Recorder::default();
        machine.scan_traced(Duration::ZERO, &mut recorder);
        if let Some(fault) = machine.fault() {
            return Err(format!("{fault}"));
        }
        let mut recomputed = Bits::new();
        for flow in &recorder.seen {
            let rung = image.program_file(flow.file).and_then(|file| file.rungs.get(usize::from(flow.rung)));
            if let Some(instruction) = rung.and_then(|rung| rung.instructions().nth(usize::from(flow.instruction))) {
                results(&machine, instruction, flow.before, &mut recomputed);
            }
        }
        for word in words(image, &machine) {
            let changed = bits(&stored, &word) ^ bits(&machine, &word);
            if changed != 0 {
                add(&mut recomputed, &machine, &word, changed);
            }
        }
        recomputed.retain(|_, (address, _)| !matches!(address.file_type, FileType::I | FileType::S));
        let recomputed =
            recomputed.into_values().map(|(address, mask)| (address.clone(), mask, bits(&stored, &address))).collect();
        let contacts = image
            .ladder_files()
            .flat_map(|file| &file.rungs)
            .flat_map(|rung| rung.instructions())
            .flat_map(|instruction| &instruction.operands)
            .filter_map(Operand::address)
            .filter(|address| address.file_type == FileType::I && address.bit.is_some())
            .filter_map(|address| Some(place(&machine, address)?.0.to_string()))
            .collect();
        let compared = Compared { image, saved, recomputed, contacts };
        let mut outcome = Outcome { wrong: compared.wrong(&machine), ..Outcome::default() };
        for (address, mask, was) in &compared.recomputed {
            let is = bits(&machine, address);
            let wrong = (was ^ is) & mask;
            outcome.bits += mask.count_ones();
            if wrong != 0 {
                let reason = compared.reason(address, *was, wrong, outcome.wrong);
                outcome.differences.push((address.clone(), format!("stored {was:#06X}, computed {is:#06X}"), reason));
            }
        }
        Ok(outcome)
    }
}

/// Images of the corpus whose S:1 says that the program is executed: file name, image.
fn running() -> Option<Vec<(String, &'static str, Image)>> {
    let folder = place::root()?;
    let files = place::files(&folder, ".rss").expect("the corpus can be listed");
    let mut found = Vec::new();
    for path in files {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = std::fs::read(&path).expect("readable file");
        let Ok(file) = rss::Project::read(&bytes, rss::Mode::Permissive) else { continue };
        let project = convert::from_rss::project(&file, ladder::Source::default());
        let named = name.contains("_live") || name.contains("_running");
        let images = [("online", project.online), ("main", named.then_some(project.main))];
        for (kind, image) in images.into_iter().filter_map(|(kind, image)| Some((kind, image?))) {
            let mode = image.data_file(FileType::S, 2).and_then(|file| file.words.get(1)).copied().unwrap_or(0);
            if RUNNING.contains(&(mode & 0x1F)) {
                found.push((name.clone(), kind, image));
            } else if named {
                println!("{name}, {kind} image: mode code {} in S:1, not saved in run mode", mode & 0x1F);
            }
        }
    }
    Some(found)
}

#[test]
fn a_scan_recomputes_what_running_controllers_had_stored() {
    let Some(images) = running() else { return };
    let (mut failures, mut rows, mut stopped) = (Vec::new(), BTreeSet::new(), 0);
    let (mut all, mut used, mut other) = (Outcome::default(), BTreeSet::new(), Outcome::default());
    for (name, kind, image) in &images {
        let known = KNOWN.iter().find(|(part, _)| name.contains(part));
        let mut outcome = match Outcome::of(image) {
            Ok(outcome) => outcome,
            Err(why) => {
                println!("{name}, {kind} image does not run: {why}");
                stopped += 1;
                failures.extend(known.map(|_| format!("{name}, {kind} image: {why}")));
                continue;
            }
        };
        for (address, values, reason) in &mut outcome.differences {
            let text = address.to_string();
            let row = EXPLAINED.iter().position(|row| name.starts_with(row.0) && row.1 == text);
            if let Some(row) = row.filter(|_| matches!(reason, Reason::Open | Reason::Moves)) {
                used.insert(row);
                *reason = Reason::Listed(EXPLAINED[row].2);
            }
            println!("    {text} {values}: {reason:?}");
            if known.is_some() && *reason == Reason::Open {
                failures.push(format!("{name}, {kind} image: {text} {values}"));
            }
        }
        let row = row(&format!("{name}, {kind}"), &outcome);
        println!("{row}");
        let share = outcome.share();
        match known {
            Some((_, least)) if share < *least => {
                failures.push(format!("{name}, {kind} image: only {:.2} % agree", 100.0 * share));
            }
            Some(_) => drop(rows.insert(row)),
            None => {
                other.bits += outcome.bits;
                other.wrong += outcome.wrong;
                other.differences.extend(outcome.differences.iter().cloned());
            }
        }
        all.bits += outcome.bits;
        all.wrong += outcome.wrong;
    }
    rows.insert(row(&format!("{} other images", images.len() - stopped - rows.len()), &other));
    // One project was saved in the middle of an edit: a RES without its operand.
    assert!(stopped <= 1, "{stopped} images do not run");
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert!(all.share() >= LEAST_SHARE, "only {:.4} agree", all.share());
    if images.iter().any(|(name, ..)| name.starts_with("LANLOGIX_BR")) {
        let stale: Vec<_> = (0..EXPLAINED.len()).filter(|row| !used.contains(row)).map(|row| EXPLAINED[row]).collect();
        assert!(stale.is_empty(), "no longer differ: {stale:?}");
        page(&rows);
    }
}

/// A row of the table in `docs/simulation.md`.
fn row(name: &str, outcome: &Outcome) -> String {
    let agreeing = outcome.bits - outcome.wrong;
    let share = if outcome.bits == 0 { "-".to_owned() } else { format!("{:.2} %", 100.0 * outcome.share()) };
    format!(
        "| {name} | {} | {agreeing} | {share} | {} | {} | {} | {} | {} |",
        outcome.bits,
        outcome.count(|reason| *reason == Reason::Time),
        outcome.count(|reason| *reason == Reason::Moves),
        outcome.count(|reason| matches!(reason, Reason::Input(_))),
        outcome.count(|reason| matches!(reason, Reason::Listed(_))),
        outcome.count(|reason| *reason == Reason::Open),
    )
}

/// Holds the tables of `docs/simulation.md` to what was measured; `RUNGS_BLESS=1` writes them.
fn page(rows: &BTreeSet<String>) {
    let listed = EXPLAINED.iter().map(|(file, address, reason)| format!("| {file} | `{address}` | {reason} |"));
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/simulation.md");
    let text = std::fs::read_to_string(&path).unwrap_or_default();
    let mut wanted = String::new();
    let mut table = false;
    for line in text.lines() {
        // The rows behind the head of a table are ours.
        if !(table && line.starts_with("| ")) {
            wanted.push_str(line);
            wanted.push('\n');
            table = false;
        }
        if line.starts_with("|---|---:|") {
            rows.iter().for_each(|row| wanted.push_str(&format!("{row}\n")));
            table = true;
        } else if line == "|---|---|---|" {
            listed.clone().for_each(|row| wanted.push_str(&format!("{row}\n")));
            table = true;
        }
    }
    if std::env::var_os("RUNGS_BLESS").is_some() {
        std::fs::write(&path, &wanted).expect("docs/simulation.md can be written");
    } else {
        assert!(text == wanted, "docs/simulation.md is old: run this test with RUNGS_BLESS=1");
    }
}
