//! Checks every entry of the instruction table.

use std::collections::{BTreeMap, BTreeSet};

use instr::{
    Category, Drawing, Evidence, Extent, Form, Instruction, Kind, Names, Operand, Position, Role, Stored, TextCount,
    TextLevel, all, by_mnemonic, by_opcode, structural,
};
use ladder::{Family, TimeBase, member_by_name};

fn forms() -> impl Iterator<Item = (&'static Instruction, &'static Form)> {
    all().iter().flat_map(|instruction| instruction.forms.iter().map(move |form| (instruction, form)))
}

fn operands() -> impl Iterator<Item = (&'static Instruction, &'static Form, &'static Operand)> {
    forms().flat_map(|(i, form)| form.operands.iter().map(move |operand| (i, form, operand)))
}

#[test]
fn mnemonics_are_sorted_unique_upper_case() {
    assert!(all().windows(2).all(|pair| pair[0].mnemonic < pair[1].mnemonic));
    for instruction in all() {
        let name = instruction.mnemonic;
        assert!((2..=3).contains(&name.len()) && name.bytes().all(|b| b.is_ascii_uppercase()), "{name}");
        assert_eq!(by_mnemonic(name).map(|found| found.mnemonic), Some(name));
        assert!(structural::MARKS.iter().all(|mark| mark.text != Some(name)) && name != structural::NXB, "{name}");
    }
    assert!(by_mnemonic("ton").is_none() && by_mnemonic("").is_none() && by_mnemonic("ZZZ").is_none());
}

#[test]
fn opcodes_are_unique_and_found() {
    let mut seen = BTreeMap::new();
    for (instruction, form) in forms() {
        let Some(opcode) = form.opcode else { continue };
        assert!(!structural::is_structural(opcode), "{}", instruction.mnemonic);
        if let Some(other) = form.stored_as {
            let (owner, _) = by_opcode(opcode).unwrap_or_else(|| panic!("{opcode:#04X} has an owner"));
            assert_eq!(owner.mnemonic, other);
            continue;
        }
        assert_eq!(seen.insert(opcode, instruction.mnemonic), None, "{opcode:#04X} stands twice");
        let (found, found_form) = by_opcode(opcode).unwrap_or_else(|| panic!("{opcode:#04X} is found"));
        assert_eq!(found.mnemonic, instruction.mnemonic);
        assert!(std::ptr::eq(found_form, form), "{}", instruction.mnemonic);
    }
    for code in (0..=0xFFFF_u16).filter(|code| !seen.contains_key(code)) {
        assert!(by_opcode(code).is_none(), "{code:#06X}");
    }
}

/// The codes whose instruction RSLogix printed or saved one at a time, from the format description.
/// Kept apart from the table so that a slip in one of its rows shows.
const KNOWN: &[(u16, &str)] = &[
    (0x08, "MCR"),
    (0x09, "RET"),
    (0x0B, "TND"),
    (0x0C, "END"),
    (0x0E, "RTO"),
    (0x0F, "TON"),
    (0x10, "TOF"),
    (0x11, "CTU"),
    (0x12, "CTD"),
    (0x13, "RES"),
    (0x14, "CLR"),
    (0x15, "JSR"),
    (0x16, "JMP"),
    (0x17, "TOD"),
    (0x18, "FRD"),
    (0x1B, "NOT"),
    (0x1C, "MOV"),
    (0x1E, "NEG"),
    (0x1F, "SUS"),
    (0x20, "DCD"),
    (0x21, "FLL"),
    (0x22, "COP"),
    (0x23, "AND"),
    (0x24, "OR"),
    (0x25, "XOR"),
    (0x26, "MVM"),
    (0x27, "ADD"),
    (0x28, "SUB"),
    (0x29, "MUL"),
    (0x2A, "DIV"),
    (0x2B, "BSR"),
    (0x2C, "BSL"),
    (0x2D, "SQO"),
    (0x2E, "SQC"),
    (0x2F, "OTE"),
    (0x30, "OTL"),
    (0x31, "OTU"),
    (0x32, "EQU"),
    (0x33, "NEQ"),
    (0x34, "GRT"),
    (0x35, "GEQ"),
    (0x36, "LES"),
    (0x37, "LEQ"),
    (0x38, "MEQ"),
    (0x39, "XIC"),
    (0x3A, "XIO"),
    (0x3B, "LBL"),
    (0x3C, "OSR"),
    (0x3D, "SBR"),
    (0x3F, "LIM"),
    (0x40, "SQL"),
    (0x41, "FFL"),
    (0x42, "FFU"),
    (0x43, "LFL"),
    (0x44, "LFU"),
    (0x45, "SCL"),
    (0x46, "SQR"),
    (0x48, "REF"),
    (0x4B, "INT"),
    (0x54, "RTO"),
    (0x55, "TOF"),
    (0x56, "TON"),
    (0x5D, "IIM"),
    (0x5E, "IOM"),
    (0x64, "ENC"),
    (0x7A, "ACI"),
    (0x7B, "ACN"),
    (0x7D, "AEX"),
    (0x7E, "AHL"),
    (0x7F, "AIC"),
    (0x80, "ARD"),
    (0x81, "ARL"),
    (0x82, "ASC"),
    (0x83, "AWA"),
    (0x85, "ASR"),
    (0x8A, "CPT"),
    (0x95, "SCP"),
    (0x96, "SWP"),
    (0x98, "ABS"),
    (0x9B, "HSL"),
    (0x9C, "MSG"),
    (0x9D, "OSF"),
    (0x9E, "OSR"),
    (0x9F, "PID"),
    (0xA0, "PTO"),
    (0xA1, "PWM"),
    (0xA2, "RAC"),
    (0xA3, "RTO"),
    (0xA4, "STS"),
    (0xA5, "SVC"),
    (0xA6, "TOF"),
    (0xA7, "TON"),
    (0xA8, "UID"),
    (0xA9, "UIE"),
    (0xAA, "UIF"),
    (0xAB, "ONS"),
    (0xAC, "DLG"),
    (0xAD, "RTA"),
    (0xAE, "CPW"),
    (0xAF, "GCD"),
    (0xB0, "RCP"),
    (0xB2, "LCD"),
    (0xB3, "MSG"),
    (0xB6, "MSG"),
];

#[test]
fn every_known_code_has_its_mnemonic_and_no_other_code_is_claimed() {
    for (opcode, mnemonic) in KNOWN {
        assert_eq!(by_opcode(*opcode).map(|(i, _)| i.mnemonic), Some(*mnemonic), "{opcode:#04X}");
    }
    let claimed = forms().filter(|(_, form)| form.stored_as.is_none()).filter_map(|(_, form)| form.opcode).count();
    assert_eq!(claimed, KNOWN.len());
}

#[test]
fn entries_are_complete() {
    for instruction in all() {
        let name = instruction.mnemonic;
        assert!(!instruction.title.is_empty() && instruction.title.trim() == instruction.title, "{name}");
        assert!(instruction.doc.ends_with('.') && instruction.doc.len() >= 10, "{name}: {}", instruction.doc);
        assert!(!instruction.doc.contains("  "), "{name}: {}", instruction.doc);
        assert!(!instruction.forms.is_empty(), "{name}");
        assert!(Category::ALL.contains(&instruction.category), "{name}");
    }
    let categories: BTreeSet<_> = all().iter().map(|instruction| instruction.category).collect();
    assert_eq!(categories.len(), Category::ALL.len(), "no group is empty");
    for (instruction, form) in forms() {
        assert!(!form.families.is_empty(), "{}", instruction.mnemonic);
        assert_eq!(form.opcode.is_none(), form.evidence == Evidence::Manual, "{}", instruction.mnemonic);
    }
}

#[test]
fn operands_are_named_and_consistent() {
    for (instruction, form, operand) in operands() {
        let place = format!("{} {}", instruction.mnemonic, operand.name);
        assert!(!operand.name.is_empty() && operand.name.trim() == operand.name, "{place}");
        if operand.role == Role::Parameter {
            assert!(operand.extent == Extent::None && operand.touches.is_empty(), "{place}");
        }
        if matches!(operand.stored, Stored::Value | Stored::Blank) {
            assert_eq!(operand.role, Role::Parameter, "{place}: a snapshot is no access");
        }
        assert_eq!(operand.stored == Stored::Blank, operand.kind == Kind::SetupScreen, "{place}");
        let length = match operand.extent {
            Extent::Elements { length, size_of } => {
                assert!(form.operands[size_of].kind == Kind::File, "{place}");
                Some(length)
            }
            Extent::Steps { length }
            | Extent::ValueOrSteps { length }
            | Extent::Words { length }
            | Extent::Bits { length } => Some(length),
            _ => None,
        };
        if let Some(length) = length {
            assert_eq!(form.operands[length].kind, Kind::Length, "{place}");
        }
    }
}

#[test]
fn touched_members_exist() {
    for (instruction, _, operand) in operands() {
        for touch in operand.touches {
            let member = member_by_name(touch.file_type, touch.member);
            let place = format!("{} {} touches {}", instruction.mnemonic, operand.name, touch.member);
            // IN is drawn RN in the boxes of the ASCII instructions; the address member is IN.
            assert_eq!(member.map(|m| m.name), Some(touch.member), "{place}");
            assert_ne!(touch.role, Role::Parameter, "{place}");
        }
    }
}

#[test]
fn code_order_names_compiled_operands_once() {
    for (instruction, form) in forms() {
        let place = instruction.mnemonic;
        let mut order = form.code_order.to_vec();
        order.sort_unstable();
        order.dedup();
        assert_eq!(order.len(), form.code_order.len(), "{place}: an operand twice");
        for index in order {
            let operand = &form.operands[index];
            assert!(operand.is_source(), "{place}: {} is not compiled", operand.name);
        }
        // What is entered and compiled is in the code, but for the time base (it is in the opcode), the
        // expression (it becomes steps) and operands nobody has identified.
        for (index, operand) in form.operands.iter().enumerate().filter(|(_, operand)| operand.is_source()) {
            let elsewhere = matches!(operand.kind, Kind::TimeBase | Kind::Expression | Kind::Unidentified)
                || form.operands.iter().any(|other| other.kind == Kind::Expression);
            assert!(
                elsewhere || form.code_order.contains(&index) || form.opcode.is_none(),
                "{place}: {}",
                operand.name
            );
        }
        if form.code_seen && form.evidence == Evidence::Samples {
            assert!(form.operands.is_empty(), "{place}: samples do not show operand bytes");
        }
    }
}

#[test]
fn strings_map_back_to_operands() {
    for (instruction, form) in forms() {
        let mut expected = Vec::new();
        for (index, operand) in form.operands.iter().enumerate() {
            expected.push((index, false));
            if operand.has_value() {
                expected.push((index, true));
            }
        }
        let found: Vec<_> = (0..form.string_count()).filter_map(|string| form.operand_of_string(string)).collect();
        assert_eq!(found, expected, "{}", instruction.mnemonic);
        assert_eq!(form.operand_of_string(form.string_count()), None);
    }
    let strings = |name: &str| by_mnemonic(name).map(|i| i.forms[0].string_count());
    // Counts that the one-at-a-time samples recorded.
    for (name, count) in [
        ("TON", 4),
        ("CTU", 3),
        ("CLR", 2),
        ("TOD", 4),
        ("MVM", 6),
        ("SCL", 8),
        ("SCP", 12),
        ("SWP", 2),
        ("COP", 3),
        ("FFL", 5),
        ("SQO", 6),
        ("SQL", 5),
        ("BSL", 4),
        ("PID", 4),
        ("HSL", 5),
        ("IIM", 3),
        ("ACI", 3),
        ("ACN", 3),
        ("AEX", 4),
        ("AHL", 6),
        ("AIC", 3),
        ("ARD", 6),
        ("ASC", 5),
        ("ASR", 2),
        ("AWA", 6),
        ("GCD", 4),
        ("LCD", 8),
    ] {
        assert_eq!(strings(name), Some(count), "{name}");
    }
    assert_eq!(by_opcode(0xB3).map(|(_, form)| form.string_count()), Some(4));
}

#[test]
fn drawing_fits_position() {
    for (instruction, form) in forms() {
        let fits = match form.drawing {
            Drawing::Contact { .. } => form.position == Position::Input,
            Drawing::Coil(_) => matches!(form.position, Position::Output | Position::FileEnd),
            Drawing::Marked(_) => matches!(form.position, Position::Input | Position::RungStart),
            Drawing::Box { .. } => form.position != Position::FileEnd,
        };
        assert!(fits, "{}", instruction.mnemonic);
        if let Drawing::Coil(letters) | Drawing::Marked(letters) = form.drawing {
            let short = ["", "L", "U"].contains(&letters);
            assert!(short || letters == instruction.mnemonic, "{}", instruction.mnemonic);
        }
    }
    let conditions: BTreeSet<_> =
        forms().filter(|(_, form)| form.position == Position::Input).map(|(i, _)| i.mnemonic).collect();
    let expected = ["ASR", "EQU", "GEQ", "GRT", "LEQ", "LES", "LIM", "MEQ", "NEQ", "ONS", "OSR", "XIC", "XIO"];
    assert_eq!(conditions, expected.into());
}

#[test]
fn timers_have_a_form_per_time_base() {
    for name in ["TON", "TOF", "RTO"] {
        let timer = by_mnemonic(name).unwrap_or_else(|| panic!("{name}"));
        assert_eq!(timer.forms.len(), 3);
        for base in [TimeBase::Millisecond, TimeBase::Centisecond, TimeBase::Second] {
            let form = timer.form_with_time_base(base).unwrap_or_else(|| panic!("{name} {base:?}"));
            assert_eq!(form.code_order, [0]);
        }
        let slow = timer.form_with_time_base(TimeBase::Millisecond).unwrap_or_else(|| panic!("{name}"));
        assert!(!slow.families.contains(Family::MicroLogix1000), "0.001 s is not on the MicroLogix 1000");
    }
    assert!(forms().all(|(i, form)| form.time_base.is_none() || i.category == Category::Timer));
}

#[test]
fn forms_are_chosen_by_family_and_operand_count() {
    let osr = by_mnemonic("OSR").unwrap_or_else(|| panic!("OSR"));
    let opcode = |family, count| osr.form_for(family, count).and_then(|form| form.opcode);
    assert_eq!(opcode(Family::MicroLogix1000, 1), Some(0x3C));
    assert_eq!(opcode(Family::Slc503, 1), Some(0x3C));
    assert_eq!(opcode(Family::MicroLogix1400, 2), Some(0x9E));
    assert_eq!(opcode(Family::MicroLogix1400, 1), Some(0x3C), "a foreign form still reads");
    assert_eq!(opcode(Family::Unknown, 2), Some(0x9E));
    assert_eq!(opcode(Family::MicroLogix1400, 3), None);
}

#[test]
fn text_counts_are_those_of_the_text_format() {
    let count = |name: &str| by_mnemonic(name).map(|i| i.forms[0].text_operands());
    for (name, operands) in [
        ("XIC", 1),
        ("ONS", 1),
        ("OSF", 2),
        ("TON", 4),
        ("CTU", 3),
        ("RES", 1),
        ("GEQ", 2),
        ("LIM", 3),
        ("MEQ", 3),
        ("ADD", 3),
        ("CLR", 1),
        ("MOV", 2),
        ("MVM", 3),
        ("SCL", 4),
        ("SCP", 6),
        ("SWP", 2),
        ("COP", 3),
        ("JSR", 1),
        ("JMP", 1),
        ("SBR", 0),
        ("MCR", 0),
        ("END", 0),
        ("SUS", 1),
        ("IIM", 3),
        ("BSL", 4),
        ("SQO", 6),
        ("SQC", 6),
        ("SQL", 5),
        ("FFL", 5),
        ("LFU", 5),
        ("PID", 3),
        ("DDV", 2),
        ("TND", 0),
        ("REF", 0),
        ("STD", 0),
    ] {
        assert_eq!(count(name), Some(TextCount::Exactly(operands)), "{name}");
    }
    assert_eq!(count("CPT"), Some(TextCount::Expression { before: 1 }));
    assert!(matches!(count("MSG"), Some(TextCount::Unknown { .. })));
    for (instruction, form) in forms() {
        // Two known forms of one mnemonic with the same count would be ambiguous in text.
        let same = instruction.forms.iter().filter(|other| {
            other.text != TextLevel::Unknown
                && other.time_base == form.time_base
                && other.families.overlaps(form.families)
                && other.text_operands() == form.text_operands()
        });
        assert!(form.text == TextLevel::Unknown || same.count() == 1, "{}", instruction.mnemonic);
    }
}

#[test]
fn names_are_read_or_said_to_be_unconfirmed() {
    for instruction in all() {
        let printed = instruction.forms.iter().any(|form| form.evidence >= Evidence::Inferred);
        assert!(printed || instruction.names != Names::Printout, "{}", instruction.mnemonic);
    }
}
