//! Arithmetic and comparisons of numbers.

use instr::Category;
use ladder::{Address, Constant, FileType, Operand};

use super::context::{Context, Step};
use super::{Check, Found, Severity};
use crate::location::Location;
use crate::xref::Through;

pub(super) const CHECKS: &[Check] = &[
    Check {
        code: "MTH01",
        title: "math without overflow handling",
        severity: Severity::Warning,
        default_on: true,
        explanation: "An overflow or a division by zero sets S:5/0, and S:5/0 still set at the end of the scan stops the processor with \
            major fault 0020. Nothing in this program clears it. Usual is an OTU of S:5/0 in the last rung, or limits on the \
            values before the math.",
        find: overflow,
    },
    Check {
        code: "MTH02",
        title: "division by the constant 0",
        severity: Severity::Error,
        default_on: true,
        explanation: "The divisor is 0: the result is not defined and S:5/0 is set, which stops the processor at the end of the scan.",
        find: constant_zero,
    },
    Check {
        code: "MTH03",
        title: "divisor not compared in its rung",
        severity: Severity::Note,
        default_on: false,
        explanation: "The divisor is data and no comparison in the rung looks at it. When it is 0, S:5/0 is set.",
        find: unguarded_divisor,
    },
    Check {
        code: "MTH04",
        title: "float compared for equality",
        severity: Severity::Warning,
        default_on: true,
        explanation: "EQU and NEQ compare every digit. Two floats that were computed in different ways are rarely equal. Use LIM with a \
            tolerance.",
        find: float_equality,
    },
    Check {
        code: "MTH05",
        title: "number that an operand can never reach",
        severity: Severity::Warning,
        default_on: true,
        explanation: "A word holds -32768 to 32767. Compared with a constant outside of that, the result never changes.",
        find: out_of_reach,
    },
    Check {
        code: "MTH06",
        title: "mask without a bit",
        severity: Severity::Warning,
        default_on: true,
        explanation: "The mask is 0: MVM and SQO move nothing, MEQ, and SQC always compare equal, AND always gives 0.",
        find: empty_mask,
    },
    Check {
        code: "MTH07",
        title: "value moved to itself",
        severity: Severity::Note,
        default_on: true,
        explanation: "Source and destination of the MOV are one address: it changes nothing but the flags.",
        find: moved_to_itself,
    },
    Check {
        code: "MTH08",
        title: "sum that grows in every scan",
        severity: Severity::Warning,
        default_on: true,
        explanation: "ADD or SUB takes its own result for a source and no condition stands before it: it counts scans, and overflows in \
            time unless something sets it back.",
        find: grows_every_scan,
    },
    Check {
        code: "MTH09",
        title: "float stored in an integer",
        severity: Severity::Note,
        default_on: false,
        explanation: "A source is a float and the destination a word: the result is rounded, and one outside of -32768 to 32767 \
            overflows.",
        find: rounded,
    },
    Check {
        code: "MTH10",
        title: "DDV without a product before it",
        severity: Severity::Warning,
        default_on: true,
        explanation: "DDV divides the 32-bit number in S:14 and S:13, which the last MUL or DIV left there. No instruction before it in its \
            rung or the one above writes that number.",
        find: double_divide,
    },
];

/// Of one finding about many instructions, the rungs to look at first.
const SAID: usize = 20;

fn sets_overflow(step: &&Step<'_>) -> bool {
    step.info.is_some_and(|info| info.category == Category::Math && info.status.contains(&"S:5/0"))
}

fn overflow(context: &Context<'_>, found: &mut Found) {
    let trap = Address::element(FileType::S, 2, 5).with_bit(0);
    let Some(writes) = context.writes(&trap) else { return };
    if writes.iter().any(|write| write.through != Through::Implied) {
        return;
    }
    let runs = |step: &&Step<'_>| context.runs(step.at.file);
    let all: Vec<Location> = context.steps.iter().filter(sets_overflow).filter(runs).map(|step| step.at).collect();
    if !all.is_empty() {
        let those = if all.len() == 1 {
            "the math instruction".to_owned()
        } else {
            format!("one of {} math instructions", all.len())
        };
        let message = format!("nothing clears S:5/0: an overflow in {those} is fault 0020");
        found.add(all.get(..SAID.min(all.len())).unwrap_or(&all), "S:5/0", message);
    }
}

/// The divisor of a division: the operand, as it stands.
fn divisor<'a>(step: &Step<'a>) -> Option<&'a Operand> {
    match step.name {
        "DIV" => step.it.operands.get(1),
        "DDV" => step.it.operands.first(),
        _ => None,
    }
}

fn is_zero(constant: &Constant) -> bool {
    match constant.number() {
        ladder::Number::Integer(number) => number == 0,
        ladder::Number::Float(number) => number == 0.0,
    }
}

fn constant_zero(context: &Context<'_>, found: &mut Found) {
    for step in &context.steps {
        if divisor(step).and_then(Operand::constant).is_some_and(is_zero) {
            found.add(&[step.at], "", format!("{} by 0", step.name));
        }
    }
}

fn unguarded_divisor(context: &Context<'_>, found: &mut Found) {
    for (index, step) in context.steps.iter().enumerate() {
        let Some(divisor) = divisor(step).filter(|operand| matches!(operand, Operand::Address(_))) else { continue };
        let before = context.steps.get(..index).unwrap_or_default().iter().rev();
        let mut rung = before.take_while(|other| (other.at.file, other.at.rung) == (step.at.file, step.at.rung));
        let compares = |other: &Step<'_>| other.info.is_some_and(|info| info.category == Category::Compare);
        if !rung.any(|other| compares(other) && other.it.operands.contains(divisor)) {
            found.add(
                &[step.at],
                divisor,
                format!("{divisor} is divided by and no comparison in the rung looks at it"),
            );
        }
    }
}

fn float_equality(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "EQU" | "NEQ")) {
        let float = (0..step.it.operands.len())
            .filter_map(|index| context.address(step, index))
            .find(|address| address.file_type == FileType::F);
        if let Some(address) = float {
            let text: Vec<String> = step.it.operands.iter().map(ToString::to_string).collect();
            found.add(&[step.at], &address, format!("{} {} compares a float for equality", step.name, text.join(" ")));
        }
    }
}

fn is_word(address: &Address) -> bool {
    use FileType as T;
    matches!(address.file_type, T::N | T::B | T::O | T::I | T::A)
        || (matches!(address.file_type, T::T | T::C | T::R) && address.word.is_some())
}

fn out_of_reach(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "EQU" | "NEQ" | "LES" | "LEQ" | "GRT" | "GEQ")) {
        let word = (0..step.it.operands.len()).filter_map(|i| context.address(step, i)).find(is_word);
        // Hex constants are bit patterns: FFFFh is -1.
        let large = step
            .it
            .operands
            .iter()
            .filter_map(Operand::constant)
            .filter(|it| !it.is_hex())
            .find(|it| it.as_integer().is_some_and(|number| !(-32_768..=32_767).contains(&number)));
        if let (Some(address), Some(constant)) = (word, large) {
            found.add(&[step.at], &address, format!("{address} can never reach {constant}"));
        }
    }
}

fn empty_mask(context: &Context<'_>, found: &mut Found) {
    for step in &context.steps {
        let mask = match step.name {
            "MVM" | "MEQ" | "SQO" | "SQC" => 1,
            "AND" => match (step.integer(0), step.integer(1)) {
                (Some(0), _) => 0,
                _ => 1,
            },
            _ => continue,
        };
        if step.integer(mask) == Some(0) {
            found.add(&[step.at], "", format!("the mask of {} is 0", step.name));
        }
    }
}

fn moved_to_itself(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| step.name == "MOV") {
        if let [Operand::Address(source), Operand::Address(dest)] = step.it.operands.as_slice()
            && source == dest
        {
            found.add(&[step.at], source, format!("MOV {source} {dest} changes nothing"));
        }
    }
}

fn grows_every_scan(context: &Context<'_>, found: &mut Found) {
    for step in context.steps.iter().filter(|step| matches!(step.name, "ADD" | "SUB") && !step.gated) {
        let [a, b, dest] = step.it.operands.as_slice() else { continue };
        let Some(address) = context.address(step, 2).filter(Address::is_direct) else { continue };
        let own = a == dest || (step.name == "ADD" && b == dest);
        let other = if a == dest { b } else { a };
        let Some(writes) = context.writes(&address) else { return };
        // What another rung sets anew is no sum over scans.
        let alone = writes.iter().all(|write| write.at == step.at);
        if own && alone && !other.constant().is_some_and(is_zero) {
            found.add(&[step.at], &address, format!("{address} changes in every scan and nothing sets it back"));
        }
    }
}

fn rounded(context: &Context<'_>, found: &mut Found) {
    let computes = |step: &&Step<'_>| {
        matches!(step.name, "MOV" | "ADD" | "SUB" | "MUL" | "DIV" | "SCP" | "SCL" | "CPT" | "SQR" | "NEG" | "ABS")
    };
    for step in context.steps.iter().filter(computes) {
        let dest = if step.name == "CPT" { 0 } else { step.it.operands.len().saturating_sub(1) };
        let Some(address) = context.address(step, dest).filter(is_word) else { continue };
        let sources = (0..step.it.operands.len()).filter(|index| *index != dest);
        let float = sources.filter_map(|i| context.address(step, i)).find(|it| it.file_type == FileType::F);
        if let Some(float) = float {
            found.add(&[step.at], &address, format!("{float} is rounded into {address}"));
        }
    }
}

fn double_divide(context: &Context<'_>, found: &mut Found) {
    let is_register =
        |address: &Address| address.file_type == FileType::S && matches!(address.element.number(), Some(13 | 14));
    for (index, step) in context.steps.iter().enumerate().filter(|(_, step)| step.name == "DDV") {
        let before = context.steps.get(..index).unwrap_or_default().iter().rev();
        let near = |other: &&Step<'_>| other.at.file == step.at.file && other.at.rung.saturating_add(1) >= step.at.rung;
        let leaves = |other: &Step<'_>| {
            other.name.is_empty()
                || other.info.is_some_and(|info| info.status.contains(&"S:13"))
                || (0..other.it.operands.len()).filter_map(|i| context.address(other, i)).any(|it| is_register(&it))
        };
        if !before.take_while(near).any(leaves) {
            found.add(&[step.at], "S:13", "nothing in this rung or the one above leaves a number in S:14 and S:13");
        }
    }
}
