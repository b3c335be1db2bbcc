//! Compares the table with the stored programs of real projects: codes, operand counts, operand
//! kinds, the order of operands in compiled code, processors, time bases.

use std::collections::BTreeMap;
use std::fs;

use instr::{Form, Kind, by_opcode};
use ladder::{Family, FileType, Operand, Place};
use rss::code::{Code, FilePlace, Operand as CodeOperand, Place as CodePlace};
use rss::processor::Processor;
use rss::program::{Instruction, ProgramFiles};
use rss::{Mode, Project, StreamKind, parse};

#[derive(Default)]
struct Tally {
    projects: usize,
    instructions: usize,
    codes: usize,
    by_code: BTreeMap<u16, usize>,
    wrong: BTreeMap<String, (usize, String)>,
}

impl Tally {
    fn wrong(&mut self, what: String, place: &str, instruction: &Instruction<'_>) {
        let entry = self.wrong.entry(what).or_insert_with(|| {
            let texts: Vec<_> = instruction.operands.iter().map(|text| text.to_string()).collect();
            (0, format!("{place} {texts:?}"))
        });
        entry.0 += 1;
    }
}

#[path = "../../../tests/src/corpus.rs"]
#[allow(dead_code, unreachable_pub, reason = "one text for every crate's tests, each of which uses a part")]
mod corpus;

/// What may stand as an operand of this kind, by spelling.
fn fits(kind: Kind, text: &str) -> bool {
    let operand = Operand::parse(text);
    if matches!(operand, Operand::Symbol(_) | Operand::Unset) {
        return true;
    }
    let address = operand.address();
    let element = |types: &[FileType]| {
        address.is_some_and(|a| types.contains(&a.file_type) && a.word.is_none() && a.bit.is_none())
    };
    match kind {
        Kind::Bit => address.is_some_and(|a| a.bit.is_some()),
        Kind::Word | Kind::Mask | Kind::WordOrFile => {
            operand.constant().is_some() || address.is_some_and(|a| a.bit.is_none())
        }
        Kind::Timer => element(&[FileType::T]),
        Kind::Counter => element(&[FileType::C]),
        Kind::Control => element(&[FileType::R]),
        Kind::Resettable => element(&[FileType::T, FileType::C, FileType::R]),
        Kind::File => address.is_some_and(|a| a.indexed && a.bit.is_none()),
        Kind::String => address.is_some_and(|a| a.file_type == FileType::ST),
        Kind::Label => matches!(operand, Operand::Label { .. }),
        Kind::ProgramFile => matches!(operand, Operand::ProgramFile(_)),
        Kind::TimeBase => ["1.0", "0.01", "0.001"].contains(&text),
        Kind::Constant
        | Kind::Preset
        | Kind::Accum
        | Kind::Length
        | Kind::Position
        | Kind::PtoNumber
        | Kind::PwmNumber
        | Kind::QueueNumber => operand.constant().is_some(),
        Kind::Expression => matches!(operand, Operand::Expression(_) | Operand::Address(_) | Operand::Constant(_)),
        Kind::HscNumber => matches!(operand, Operand::HighSpeedCounter(_)),
        Kind::PidBlock => element(&[FileType::PD]),
        Kind::MessageBlock => element(&[FileType::MG]),
        Kind::RoutingBlock => element(&[FileType::RIX]),
        Kind::SetupScreen => text.is_empty() || text == "Setup Screen",
        _ => true,
    }
}

/// Text and code name the same thing, as far as file, element and value tell.
fn agrees(text: &str, code: &CodeOperand) -> bool {
    let same = |text: &Place, code: &CodePlace| match (text, code) {
        (Place::Number(n), CodePlace::Number(c)) => *n == u16::from(*c),
        (Place::Indirect(_), CodePlace::By(_)) => true,
        _ => false,
    };
    match (Operand::parse(text), code) {
        (Operand::Address(address), CodeOperand::Address(code)) => {
            let file = match &code.file {
                FilePlace::Data(file) => same(&address.file, file),
                _ => true,
            };
            file && same(&address.element, &code.element) && address.indexed == code.indexed
        }
        (Operand::Constant(constant), CodeOperand::Int(value)) => {
            constant.as_integer().is_some_and(|i| i == i64::from(*value) || i == i64::from(*value as u16))
        }
        (Operand::Constant(constant), CodeOperand::Long(value)) => {
            constant.as_integer().is_some_and(|i| i == i64::from(*value) || i == i64::from(*value as u32))
        }
        (Operand::Constant(_), CodeOperand::Float(_)) => true,
        (
            Operand::Label { number, .. } | Operand::ProgramFile(number) | Operand::HighSpeedCounter(number),
            CodeOperand::Int(value),
        ) => i64::from(number) == i64::from(*value),
        // The code of an unresolved symbol is an address; what it names is another matter.
        (Operand::Symbol(_), CodeOperand::Address(_)) => true,
        _ => false,
    }
}

fn check_code(form: &Form, instruction: &Instruction<'_>, tally: &mut Tally, mnemonic: &str, place: &str) {
    let operands = match Code::decode(&instruction.code) {
        Ok(Code::Operands { operands, .. }) => operands,
        Ok(Code::Expression(_)) => Vec::new(),
        Err(error) => return tally.wrong(format!("{mnemonic}: {error}"), place, instruction),
    };
    tally.codes += 1;
    if !form.code_seen {
        tally.wrong(format!("{mnemonic}: code is seen here, the table calls it assumed"), place, instruction);
    }
    if operands.len() != form.code_order.len() {
        let what = format!("{mnemonic}: {} operands in code, table has {}", operands.len(), form.code_order.len());
        return tally.wrong(what, place, instruction);
    }
    for (index, code) in form.code_order.iter().zip(&operands) {
        let string = (0..form.string_count()).find(|s| form.operand_of_string(*s) == Some((*index, false)));
        let text = string.and_then(|s| instruction.operands.get(s)).map(ToString::to_string).unwrap_or_default();
        if !agrees(&text, code) {
            tally.wrong(
                format!("{mnemonic}: {} is `{text}`, code has another", form.operands[*index].name),
                place,
                instruction,
            );
        }
    }
}

fn check(instruction: &Instruction<'_>, family: Family, place: &str, tally: &mut Tally) {
    if instr::structural::is_structural(instruction.opcode) {
        return;
    }
    tally.instructions += 1;
    *tally.by_code.entry(instruction.opcode).or_default() += 1;
    let Some((entry, form)) = by_opcode(instruction.opcode) else {
        return tally.wrong(format!("{:#04X} is unknown", instruction.opcode), place, instruction);
    };
    let name = entry.mnemonic;
    if form.string_count() != instruction.operands.len() {
        let what = format!(
            "{name} {:#04X}: {} texts, table has {}",
            instruction.opcode,
            instruction.operands.len(),
            form.string_count()
        );
        return tally.wrong(what, place, instruction);
    }
    if !form.families.contains(family) {
        tally.wrong(format!("{name} {:#04X} is not for {family}", instruction.opcode), place, instruction);
    }
    for (number, text) in instruction.operands.iter().enumerate() {
        let text = text.to_string();
        let Some((index, false)) = form.operand_of_string(number) else { continue };
        let operand = &form.operands[index];
        // A rung that was never verified can hold anything that was typed.
        if instruction.has_code != 0 && !fits(operand.kind, &text) {
            tally.wrong(format!("{name}: {} is `{text}`", operand.name), place, instruction);
        }
    }
    if instruction.has_code != 0 {
        if let Some(base) = form.time_base
            && instruction.operands.get(1).is_none_or(|text| *text != base.text())
        {
            tally.wrong(format!("{name} {:#04X}: another time base", instruction.opcode), place, instruction);
        }
        check_code(form, instruction, tally, name, place);
    }
}

fn family_of(model: u16) -> Family {
    match rss::tables::processor_model(model).map(|model| model.family) {
        Some("slc-500-fixed") => Family::SlcFixed,
        Some(id) => Family::from_id(id).unwrap_or(Family::Unknown),
        None => Family::Unknown,
    }
}

#[test]
fn stored_programs_agree_with_the_table() {
    let Some(folder) = corpus::root() else { return };
    let paths = corpus::files(&folder, ".rss").expect("the corpus can be listed");
    let mut tally = Tally::default();
    for path in &paths {
        let bytes = fs::read(path).expect("a listed project is readable");
        // Foreign and empty files under this name are the business of the reader's own tests.
        let Ok(project) = Project::read(&bytes, Mode::Permissive) else { continue };
        tally.projects += 1;
        let name = path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
        for stream in project.streams().filter(|stream| stream.kind() == StreamKind::ProgramFiles) {
            let family = project.stream(stream.image(), StreamKind::Processor).map_or(Family::Unknown, |processor| {
                family_of(parse::<Processor>(processor.payload(), processor.path(), Mode::Permissive).value.model.0)
            });
            let program = parse::<ProgramFiles>(stream.payload(), stream.path(), Mode::Permissive).value;
            for file in &program.files {
                for (number, rung) in file.rungs.iter().enumerate() {
                    let place = format!("{name} file {} rung {number}", file.number);
                    rung.for_each_instruction(|instruction| check(instruction, family, &place, &mut tally));
                }
            }
        }
    }
    println!(
        "{} projects, {} instructions, {} operation codes, {} compiled instructions compared",
        tally.projects,
        tally.instructions,
        tally.by_code.len(),
        tally.codes
    );
    let wrong: Vec<_> = tally.wrong.iter().map(|(what, (n, place))| format!("{n} x {what}, first {place}")).collect();
    assert!(wrong.is_empty(), "{} differences:\n{}", wrong.len(), wrong.join("\n"));
}
