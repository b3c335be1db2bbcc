//! The lossless check: bytes understood, identical rewrite, code that agrees with the texts.

use rss::program::{Instruction, ProgramFiles};
use rss::{ImageKind, Mode, StreamKind};

use crate::code::{self, CodeError};
use crate::from_rss;

/// How compiled code and operand texts compare over all images of a project.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CodeCheck {
    /// Instructions whose stored code is the code of their texts.
    pub agrees: usize,
    /// Instructions where it is not.
    pub differs: Vec<CodeDifference>,
    /// Instructions that were never compiled since they were edited: nothing to compare.
    pub not_compiled: usize,
    /// Compiled instructions whose code cannot be generated (unknown operation codes and the like).
    pub not_comparable: Vec<CodeDifference>,
}

/// One instruction whose code and texts do not say the same.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CodeDifference {
    /// Stream path.
    pub stream: String,
    /// Program file.
    pub file: u16,
    /// Rung, from 0.
    pub rung: usize,
    /// Mnemonic, or the operation code of an unknown one.
    pub instruction: String,
    /// The operand texts, without displayed values.
    pub text: String,
    /// What the code says in the same spelling, or why there is nothing to compare.
    pub code: String,
}

/// Compares code and texts of every instruction in every image.
pub fn check_code(file: &rss::Project) -> CodeCheck {
    let mut check = CodeCheck::default();
    for image in ImageKind::ALL {
        let Some(stream) = file.stream(image, StreamKind::ProgramFiles) else { continue };
        let programs = rss::parse::<ProgramFiles<'_>>(stream.payload(), stream.path(), Mode::Permissive).value;
        for program in &programs.files {
            for (rung, stored) in program.rungs.iter().enumerate() {
                stored.for_each_instruction(|instruction| {
                    check.instruction(instruction, stream.path(), program.number, rung);
                });
            }
        }
    }
    check
}

impl CodeCheck {
    fn instruction(&mut self, stored: &Instruction<'_>, stream: &str, file: u16, rung: usize) {
        if stored.has_code == 0 {
            self.not_compiled += usize::from(!stored.is_mark());
            return;
        }
        if stored.is_mark() {
            // A mark's code is its own number; it says nothing about operands, so only damage counts.
            if u8::try_from(stored.opcode).is_ok_and(|opcode| *stored.code == [opcode]) {
                return;
            }
        }
        let model = from_rss::instruction(stored);
        let expected = match instr::by_opcode(stored.opcode) {
            Some((definition, form)) => code::compile(definition, form, &model),
            None => Err(CodeError::NoOpcode(model.mnemonic.to_string())),
        };
        let other_base = instr::by_opcode(stored.opcode)
            .and_then(|(_, form)| code::other_time_base(form, &model.operands))
            .map(|(_, code)| format!(" (operation code of time base {code})"));
        if other_base.is_none() && expected.as_ref().is_ok_and(|code| *code == *stored.code) {
            self.agrees += 1;
            return;
        }
        let texts = model.operands.iter().map(ToString::to_string).collect::<Vec<_>>();
        let difference = CodeDifference {
            stream: stream.to_owned(),
            file,
            rung,
            instruction: model.mnemonic.to_string(),
            text: texts.join(" "),
            code: spell(&stored.code) + &other_base.unwrap_or_default(),
        };
        match expected {
            // A text that is no address stands where the code has one: they do differ.
            Ok(_) => self.differs.push(difference),
            Err(CodeError::Operand { .. }) if symbolic(&model) => self.differs.push(difference),
            Err(why) => {
                let code = format!("{} ({why})", difference.code);
                self.not_comparable.push(CodeDifference { code, ..difference });
            }
        }
    }
}

fn symbolic(instruction: &ladder::Instruction) -> bool {
    instruction.operands.iter().any(|operand| matches!(operand, ladder::Operand::Symbol(_)))
}

/// Code in the spelling of programs, in code order; bytes where it cannot be decoded.
fn spell(bytes: &[u8]) -> String {
    let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02X}")).collect::<Vec<_>>().join(" ");
    match rss::code::Code::decode(bytes) {
        Ok(rss::code::Code::Operands { operands, .. }) => {
            operands.iter().map(code::spell).collect::<Vec<_>>().join(" ")
        }
        _ => hex(bytes),
    }
}
