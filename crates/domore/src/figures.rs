//! What can be counted in a project.

use std::collections::BTreeMap;

use crate::instruction::by_mnemonic;
use crate::{CodeBlock, Part, Project};

/// Counts over a project.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Figures {
    /// Instructions.
    pub instructions: usize,
    /// Rungs that hold instructions.
    pub rungs: usize,
    /// Rungs with a comment.
    pub commented: usize,
    /// Instructions that are not in the table, with how often each occurs.
    pub unknown: BTreeMap<String, usize>,
    /// Elements with documentation.
    pub documented: usize,
    /// Those with a nickname.
    pub nicknames: usize,
}

impl Figures {
    /// Counts.
    pub fn of(project: &Project) -> Figures {
        let rungs = || project.code_blocks().flat_map(|block| &block.rungs);
        let mut unknown = BTreeMap::new();
        let mut instructions = 0;
        for instruction in rungs().flat_map(|rung| &rung.instructions) {
            instructions += 1;
            if by_mnemonic(&instruction.mnemonic).is_none() {
                *unknown.entry(instruction.mnemonic.clone()).or_insert(0) += 1;
            }
        }
        Figures {
            instructions,
            rungs: rungs().filter(|rung| !rung.instructions.is_empty()).count(),
            commented: rungs().filter(|rung| rung.comment.is_some()).count(),
            unknown,
            documented: project.documentation().count(),
            nicknames: project.documentation().filter(|entry| !entry.nickname.is_empty()).count(),
        }
    }
}

impl CodeBlock {
    /// Rungs that are stages.
    pub fn stages(&self) -> usize {
        self.rungs.iter().filter(|rung| rung.stage().is_some()).count()
    }

    /// Instructions of all rungs.
    pub fn instructions(&self) -> usize {
        self.rungs.iter().map(|rung| rung.instructions.len()).sum()
    }
}

impl Project {
    /// Sections that are carried untouched: name and number of lines.
    pub fn carried(&self) -> impl Iterator<Item = (&str, usize)> {
        self.parts.iter().filter_map(|part| match part {
            Part::Raw(section) => Some((section.name.as_str(), section.lines.len())),
            _ => None,
        })
    }
}
