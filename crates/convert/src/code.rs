//! Compiled code of an instruction from its operands, and the comparison of the two.
//!
//! A project stores every instruction twice: as the texts a person sees and as the code the
//! processor runs. The code follows from the texts alone and does not depend on the processor
//! model, so it can be generated for a program written as text, and a stored program can be checked
//! for texts that do not say what the processor does.

use std::fmt;

use instr::{Form, Instruction as Definition, Kind, Role};
use ladder::{Address, Constant, Expression, FileType, Instruction, Number, Operand, Operator, TimeBase};
use rss::code::{self, Code, FilePlace, Step};

use crate::codes;

/// Why an instruction has no code, or another than its operands say.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum CodeError {
    /// The operation code of the instruction is not known.
    NoOpcode(String),
    /// Code for this operand has never been seen, or it does not fit the code's fields.
    Operand {
        /// Name of the operand as in the box.
        name: &'static str,
        /// Why there is no code.
        why: String,
    },
    /// Operands that the instruction does not have, or lacks.
    Count {
        /// Operands the instruction has.
        expected: usize,
        /// Operands found.
        found: usize,
    },
}

impl fmt::Display for CodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            CodeError::NoOpcode(mnemonic) => write!(f, "the operation code of {mnemonic} is not known"),
            CodeError::Operand { name, why } => write!(f, "operand {name}: {why}"),
            CodeError::Count { expected, found } => write!(f, "expected {expected} operands, found {found}"),
        }
    }
}

impl std::error::Error for CodeError {}

/// Time base of a timer's operand text and of its operation code, where they are not the same. No byte
/// of the compiled code holds the time base: it is the operation code that says it.
pub(crate) fn other_time_base<'o>(form: &Form, operands: &'o [Operand]) -> Option<(&'o Operand, &'static str)> {
    let coded = form.time_base?;
    // The time base follows the timer. One that is not entered yet differs from nothing.
    let text = operands.get(1).filter(|text| !matches!(text, Operand::Unset | Operand::Empty))?;
    (TimeBase::from_text(&text.to_string()) != Some(coded)).then(|| (text, coded.text()))
}

/// The compiled code of an instruction in a given form of the table. Values displayed beside the
/// operands decide the type of some constants, as they do in RSLogix.
///
/// # Errors
/// Where no code is known for the instruction or one of its operands.
pub fn compile(definition: &Definition, form: &Form, instruction: &Instruction) -> Result<Vec<u8>, CodeError> {
    let opcode = form.opcode.and_then(|opcode| u8::try_from(opcode).ok());
    let opcode = opcode.ok_or_else(|| CodeError::NoOpcode(definition.mnemonic.to_owned()))?;
    if instruction.operands.len() != form.operands.len() {
        return Err(CodeError::Count { expected: form.operands.len(), found: instruction.operands.len() });
    }
    let expression = form.operands.iter().position(|operand| operand.kind == Kind::Expression);
    let code = match expression {
        Some(index) => expression_code(form, instruction, index)?,
        None => {
            let operand = |&index: &usize| operand_code(form, instruction, index);
            let operands = form.code_order.iter().map(operand).collect::<Result<Vec<_>, _>>()?;
            Code::Operands { opcode, operands }
        }
    };
    code.encode().map_err(|error| CodeError::Operand { name: "code", why: error.found })
}

fn operand_code(form: &Form, instruction: &Instruction, index: usize) -> Result<code::Operand, CodeError> {
    let (Some(definition), Some(operand)) = (form.operands.get(index), instruction.operands.get(index)) else {
        return Err(CodeError::Count { expected: form.operands.len(), found: instruction.operands.len() });
    };
    let fail = |why: String| CodeError::Operand { name: definition.name, why };
    match operand {
        Operand::Address(address) => address_code(address).map_err(fail),
        Operand::Constant(constant) => {
            let kind = constant_kind(form, instruction, index, constant);
            constant_code(constant, kind).map_err(fail)
        }
        Operand::ProgramFile(number) | Operand::Label { number, .. } | Operand::HighSpeedCounter(number) => {
            i16::try_from(*number).map(code::Operand::Int).map_err(|_| fail(format!("{number} does not fit 16 bits")))
        }
        other => Err(fail(format!("`{other}` has no compiled form"))),
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum ConstantKind {
    Word,
    Long,
    Float,
}

/// Which of the three constant forms RSLogix compiles. The rule reproduces every known constant;
/// its parts are in `docs/format/program-files.md`.
fn constant_kind(form: &Form, instruction: &Instruction, index: usize, constant: &Constant) -> ConstantKind {
    let definition = form.operands.get(index);
    let shown = instruction.displayed(index);
    let others = || {
        let all = instruction.operands.iter().enumerate();
        all.filter(move |(other, _)| *other != index).map(|(_, operand)| operand)
    };
    let is_length = definition.is_some_and(|definition| definition.kind == Kind::Length);
    let float_beside = || others().any(|operand| operand.address().is_some_and(|a| a.file_type == FileType::F));
    if matches!(constant.number(), Number::Float(_)) || shown.is_some_and(|value| value.contains('.')) {
        return ConstantKind::Float;
    }
    // Without a displayed value (never on line, or written as text) the other operands decide.
    if !is_length && matches!(shown, None | Some("?")) && definition.is_some_and(|d| d.has_value()) && float_beside() {
        return ConstantKind::Float;
    }
    // RAC loads the 32-bit accumulator of a high-speed counter. HSL, which also names a counter, has
    // 16-bit constants.
    let counter_value = instruction.mnemonic == "RAC" && definition.is_some_and(|d| d.role == Role::Read);
    let long_beside = others().any(|operand| operand.address().is_some_and(is_long));
    let fits = constant.as_integer().is_some_and(|value| fits_word(value, constant.is_hex()));
    if !is_length && (long_beside || counter_value || !fits) { ConstantKind::Long } else { ConstantKind::Word }
}

fn fits_word(value: i64, hex: bool) -> bool {
    i16::try_from(value).is_ok() || (hex && u16::try_from(value).is_ok())
}

/// The addressed value is 32 bits wide and no float.
fn is_long(address: &Address) -> bool {
    let long_member = || {
        ladder::members_of(address.file_type).any(|m| m.long && Some(m.word) == address.word && address.bit.is_none())
    };
    address.file_type == FileType::L || long_member()
}

fn constant_code(constant: &Constant, kind: ConstantKind) -> Result<code::Operand, String> {
    let too_large = || format!("{constant} does not fit its form");
    Ok(match (kind, constant.number()) {
        (ConstantKind::Float, Number::Float(value)) => code::Operand::float(value),
        // The spelling decides the float, as it does where the constant is typed in.
        (ConstantKind::Float, Number::Integer(value)) => {
            code::Operand::float(value.to_string().parse().map_err(|_| too_large())?)
        }
        (ConstantKind::Long, Number::Integer(value)) => {
            // Hex constants are bit patterns: 0FFFFFFFFh is -1.
            let pattern = i32::try_from(value).or_else(|_| u32::try_from(value).map(u32::cast_signed));
            code::Operand::Long(pattern.map_err(|_| too_large())?)
        }
        (ConstantKind::Word, Number::Integer(value)) => {
            let pattern = i16::try_from(value).or_else(|_| u16::try_from(value).map(u16::cast_signed));
            code::Operand::Int(pattern.map_err(|_| too_large())?)
        }
        (ConstantKind::Long | ConstantKind::Word, Number::Float(_)) => return Err(too_large()),
    })
}

fn address_code(address: &Address) -> Result<code::Operand, String> {
    let type_code = codes::type_code(address.file_type)
        .and_then(|code| u8::try_from(code).ok())
        .ok_or_else(|| format!("{}: no stored number of file type {} is known", address, address.file_type))?;
    let small = |number: u16| u8::try_from(number).map_err(|_| format!("{address}: {number} does not fit 8 bits"));
    let place = |place: &ladder::Place| {
        Ok::<_, String>(match place {
            ladder::Place::Number(number) => code::Place::Number(small(*number)?),
            ladder::Place::Indirect(inner) => code::Place::By(address_code(inner)?),
        })
    };
    let file = match (&address.file, address.file_type.is_function_file()) {
        (ladder::Place::Number(number), true) => FilePlace::Function(small(*number)?),
        (file, _) => FilePlace::Data(place(file)?),
    };
    Ok(code::Operand::Address(Box::new(code::Address {
        type_code,
        file,
        element: place(&address.element)?,
        word: address.word.map(small).transpose()?,
        bit: address.bit.as_ref().map(place).transpose()?,
        indexed: address.indexed,
    })))
}

/// CPT: a stack program in post-order whose last step names the destination. Only the four
/// arithmetic operators have been seen.
fn expression_code(form: &Form, instruction: &Instruction, index: usize) -> Result<Code, CodeError> {
    let fail = |why: String| CodeError::Operand { name: "Expression", why };
    let Some(Operand::Expression(expression)) = instruction.operands.get(index) else {
        return Err(fail("expected an expression".to_owned()));
    };
    let destination = form.operands.iter().position(|operand| operand.role.writes()).unwrap_or(0);
    let mut steps = Vec::new();
    let top = emit(expression, &mut steps).map_err(fail)?;
    let result = operand_code(form, instruction, destination)?;
    match steps.last_mut() {
        Some(last) if top == code::Operand::Stack => last.result = result,
        _ => return Err(fail("code for an expression without operator has not been seen".to_owned())),
    }
    Ok(Code::Expression(steps))
}

/// Emits the steps of an expression and tells where its value is.
fn emit(expression: &Expression, steps: &mut Vec<Step>) -> Result<code::Operand, String> {
    match expression {
        Expression::Group(inner) => emit(inner, steps),
        Expression::Value(operand) => match &**operand {
            Operand::Address(address) => address_code(address),
            Operand::Constant(constant) => {
                let float = matches!(constant.number(), Number::Float(_));
                constant_code(constant, if float { ConstantKind::Float } else { ConstantKind::Word })
            }
            other => Err(format!("`{other}` has no compiled form")),
        },
        Expression::Unary(function, _) => Err(format!("code for {} has not been seen", function.symbol())),
        Expression::Binary(operator, left, right) => {
            let opcode = match operator {
                Operator::Add => 0x27,
                Operator::Subtract => 0x28,
                Operator::Multiply => 0x29,
                Operator::Divide => 0x2A,
                other => return Err(format!("code for {} has not been seen", other.symbol())),
            };
            let a = emit(left, steps)?;
            let b = emit(right, steps)?;
            steps.push(Step { operator: opcode, a, b, result: code::Operand::Stack });
            Ok(code::Operand::Stack)
        }
    }
}

/// An operand of compiled code as a program writes it; `None` for the stack of an expression.
pub(crate) fn operand_of(operand: &code::Operand) -> Option<Operand> {
    Some(match operand {
        code::Operand::Int(value) => Operand::Constant(Constant::integer((*value).into())),
        code::Operand::Long(value) => Operand::Constant(Constant::integer(*value)),
        code::Operand::Float(bits) => Operand::Constant(Constant::float(f32::from_bits(*bits))),
        code::Operand::Stack => return None,
        code::Operand::Address(address) => Operand::Address(address_of(address)),
    })
}

/// The same as text, for messages.
pub fn spell(operand: &code::Operand) -> String {
    operand_of(operand).map_or_else(|| "(stack)".to_owned(), |operand| operand.to_string())
}

fn address_of(address: &code::Address) -> Address {
    let place = |place: &code::Place| match place {
        code::Place::Number(number) => ladder::Place::Number((*number).into()),
        code::Place::By(code::Operand::Address(inner)) => ladder::Place::Indirect(Box::new(address_of(inner))),
        // Only addresses have been seen in brackets; anything else is spelled as file 0 of an unknown type.
        code::Place::By(_) => ladder::Place::Indirect(Box::new(Address::element(FileType::Unknown(u16::MAX), 0, 0))),
    };
    Address {
        indexed: address.indexed,
        file_type: codes::file_type(address.type_code.into()),
        file: match &address.file {
            FilePlace::Data(file) => place(file),
            FilePlace::Function(number) => ladder::Place::Number((*number).into()),
        },
        element: place(&address.element),
        word: address.word.map(u16::from),
        bit: address.bit.as_ref().map(place),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ladder::Mnemonic;

    fn code(mnemonic: &'static str, operands: &[&str], displayed: &[&str]) -> Vec<u8> {
        let definition = instr::by_mnemonic(mnemonic).expect("known");
        let operands: Vec<Operand> = operands.iter().map(|text| Operand::parse(text)).collect();
        let form = definition.forms.iter().find(|f| f.operands.len() == operands.len()).expect("form");
        let mut instruction = Instruction::new(Mnemonic::named(mnemonic), operands);
        instruction.displayed = displayed.iter().map(|text| (!text.is_empty()).then(|| (*text).to_owned())).collect();
        compile(definition, form, &instruction).expect("code")
    }

    #[test]
    fn known_examples() {
        assert_eq!(code("XIC", &["B3:0/15"], &[]), [0x39, 0x17, 0x08, 0xF3, 0x00, 0x03, 0x00]);
        assert_eq!(code("XIC", &["I:0.0/0"], &[]), [0x39, 0x1F, 0x08, 0x01, 0x00, 0x01, 0x00]);
        assert_eq!(code("XIC", &["T4:136/DN"], &[])[1..], [0x17, 0x08, 0xD4, 0x00, 0x04, 0x88]);
        assert_eq!(code("XIC", &["MG68:0/DN"], &[])[1..], [0x9F, 0x00, 0x53, 0x8B, 0x44, 0x00]);
        assert_eq!(code("JSR", &["U:4"], &[]), [0x15, 0x00, 0x02, 4, 0, 0, 0]);
        // Length first, then source and destination.
        assert_eq!(
            code("COP", &["#N7:3", "#L51:1", "5"], &[]),
            [0x22, 0x00, 0x02, 5, 0, 0, 0, 0x07, 0x88, 0x07, 0x00, 0x07, 3, 0x87, 0x80, 0x10, 0, 0x33, 1]
        );
        assert_eq!(code("MOV", &["10", "F8:0"], &["10.0", "0.0"])[1..7], [0x00, 0x04, 0x00, 0x00, 0x20, 0x41]);
        assert_eq!(code("MOV", &["10", "L9:0"], &["10", "0"])[1..7], [0x00, 0x01, 10, 0, 0, 0]);
    }

    #[test]
    fn an_expression_is_a_stack_program() {
        let expected: &[u8] = &[
            0x8A, 0x2A, 0x07, 0x08, 0x08, 0, 8, 8, 0x07, 0x08, 0x07, 0, 7, 0x3E, 0, 0, 0, 0, 0, 0, 0x29, 0, 0, 0, 0, 0,
            0, 0x00, 0x04, 0, 0, 0xC8, 0x42, 0x07, 0x08, 0x08, 0, 8, 0x0E, 0x8B,
        ];
        assert_eq!(code("CPT", &["F8:14", " ( F8:8 | N7:62 ) * 100.0 "], &[]), expected);
    }

    #[test]
    fn what_was_never_seen_is_refused() {
        let definition = instr::by_mnemonic("XIC").expect("known");
        let instruction = Instruction::new(Mnemonic::named("XIC"), vec![Operand::Symbol("START".into())]);
        let error = compile(definition, &definition.forms[0], &instruction);
        assert!(matches!(error, Err(CodeError::Operand { .. })), "{error:?}");
    }
}
