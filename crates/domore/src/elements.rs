//! Operands that name no memory: a block nobody declared, a number beyond the end of its block.

use std::collections::HashSet;

use crate::address::{Address, Constant, Element, unquote};
use crate::diagnostic::{Diagnostic, Problem};
use crate::instruction::{self, Kind};
use crate::math::Expression;
use crate::memory::Map;
use crate::program::{Instruction, Project};

/// Each such operand, where it stands first.
///
/// Only what reads as an element with a number is looked at: a plain name can be a nickname that was not exported or a
/// device. Operands of instructions that are not known mean what nobody knows.
pub fn check(project: &Project) -> Vec<Diagnostic> {
    // Memory that cannot be laid out is told by what needs it.
    let Ok(map) = Map::new(project) else { return Vec::new() };
    let (mut found, mut seen) = (Vec::new(), HashSet::new());
    for block in project.code_blocks() {
        for (index, rung) in block.rungs.iter().enumerate() {
            for instruction in &rung.instructions {
                for operand in operands(instruction, &map) {
                    let problem = (!seen.contains(&operand)).then(|| lacks(&operand, &map)).flatten();
                    if let Some(why) = problem {
                        found.push(Diagnostic {
                            line: instruction.origin.line().unwrap_or(0),
                            column: 1,
                            rung: Some((block.name.clone(), index + 1)),
                            problem: Problem::NoSuchElement { operand: operand.clone(), why },
                        });
                    }
                    seen.insert(operand);
                }
            }
        }
    }
    found
}

/// The operands that are elements, those of expressions too.
fn operands(instruction: &Instruction, map: &Map) -> Vec<String> {
    let Some(entry) = instruction::by_mnemonic(&instruction.mnemonic) else { return Vec::new() };
    let mut all = Vec::new();
    for (index, text) in instruction.operands.iter().enumerate() {
        match entry.operand(index).map(|operand| operand.kind) {
            Some(Kind::Bit | Kind::Number | Kind::Value | Kind::Timer | Kind::Counter) => all.push(text.clone()),
            Some(Kind::Expression) => {
                let parsed =
                    unquote(text).and_then(|text| Expression::parse_with(&text, &|block| map.radix(block)).ok());
                let addresses = parsed.iter().flat_map(Expression::addresses);
                all.extend(addresses.map(|(address, _)| address.to_string()));
            }
            _ => {}
        }
    }
    all
}

/// Why nothing stands at an element.
fn lacks(text: &str, map: &Map) -> Option<String> {
    if text.is_empty() || Constant::parse(text).is_some() {
        return None;
    }
    let address = Address::parse_with(text, |block| map.radix(block)).ok()?;
    let block = match &address.element {
        Element::Numbered { block, .. } | Element::Indexed { block, .. } => block,
        Element::Named(_) => return None,
    };
    let why = map.resolve(&address).err()?.why;
    if address.base().is_some_and(|base| map.is_foreign(&base)) || map.is_foreign(block) {
        return None;
    }
    let beyond = matches!((&address.element, map.block(block)), (Element::Numbered { number, .. }, Some(block)) if *number >= block.count);
    (beyond || map.block(block).is_none()).then_some(why)
}

#[cfg(test)]
mod tests {
    #[test]
    fn elements_without_memory_are_told_once() {
        let text = "#BEGIN MEM_CONFIG\n\tC\tBIT\tdecimal\t16\n\tBatch7\tPID\t\t0\n#END\n$PRGRM $Main\n\nSTR X0\nOUT QQ7\nOUT \
                    C16\n\nSTR QQ7\nANDGT N5000 1\nOUT Pump2\nOUT Batch7.Man\nMATH D0 \"W9 + V4096 + 3\"\nMOVE 7 \
                    T0.Acc\nOUT START\nANDE $Main.S1 1\nFANCY ZZ1\nMOVE WW[D0] DST511\n\n$PGMEND $Main\n#BEGIN \
                    ELEMENT_DOC\n\"C1\",\"FLAGS =\",\"Pump2\",\"\"\n#END\n";
        let project = crate::text::read(text).expect("reads").project;
        let found = super::check(&project);
        let told: Vec<_> = found.iter().map(|it| (it.line, it.problem.to_string())).collect();
        let shown: Vec<_> = told.iter().map(|(line, text)| format!("{line}: {text}")).collect();
        let names = ["QQ7", "C16", "N5000", "W9", "V4096", "WW[D0]"];
        assert_eq!(shown.len(), names.len(), "{shown:#?}");
        for (text, name) in shown.iter().zip(names) {
            assert!(text.contains(name), "{name}: {shown:#?}");
        }
    }
}
