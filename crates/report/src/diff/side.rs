//! One of two programs that are compared, whatever its dialect: its rungs, drawn, and what places are called.

use std::collections::BTreeMap;
use std::rc::Rc;

use analysis::diff::Place;
use domore::documentation::Documentation as Nicknames;
use ladder::{Documentation, Image};

use crate::Rung;

/// Instructions and branch marks in order, each after a blank.
fn rslogix_text(rung: &ladder::Rung) -> String {
    analysis::diff::words(rung).into_iter().map(|word| word.text).collect::<Vec<_>>().join(" ")
}

/// A program beside another one.
#[derive(Clone, Debug)]
pub struct Side<'a> {
    dialect: Dialect<'a>,
}

#[derive(Clone, Debug)]
enum Dialect<'a> {
    Rslogix { image: &'a Image, documentation: &'a Documentation },
    Domore { blocks: Vec<&'a domore::CodeBlock>, documentation: Rc<Nicknames<'a>> },
}

/// A program file or code block with rungs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// For [`Place::file`].
    pub number: u16,
    /// `LAD 2 - MAIN`, `Program Fill`.
    pub title: String,
    /// How many rungs it has, one that only ends it included.
    pub rungs: usize,
}

impl<'a> Side<'a> {
    /// A program of RSLogix 500; `documentation` may be that of another image.
    pub fn rslogix(image: &'a Image, documentation: &'a Documentation) -> Side<'a> {
        Side { dialect: Dialect::Rslogix { image, documentation } }
    }

    /// A program of Do-more.
    pub fn domore(project: &'a domore::Project) -> Side<'a> {
        let documentation = Rc::new(Nicknames::new(project));
        Side { dialect: Dialect::Domore { blocks: project.code_blocks().collect(), documentation } }
    }

    fn block(&self, number: u16) -> Option<&'a domore::CodeBlock> {
        match &self.dialect {
            Dialect::Domore { blocks, .. } => blocks.get(usize::from(number).checked_sub(1)?).copied(),
            Dialect::Rslogix { .. } => None,
        }
    }

    /// The rung at a place, to be drawn.
    pub fn rung(&self, at: Place) -> Option<Rung<'a>> {
        match &self.dialect {
            Dialect::Rslogix { image, documentation } => {
                let file = image.program_file(at.file).filter(|file| at.rung < file.rungs.len())?;
                Some(Rung::of_file(image, file, at.rung, documentation))
            }
            Dialect::Domore { documentation, .. } => {
                let block = self.block(at.file).filter(|block| at.rung < block.rungs.len())?;
                Some(Rung::of_code_block(at.file.into(), block, at.rung, Rc::clone(documentation)))
            }
        }
    }

    /// The rung as one line of text.
    pub fn text(&self, at: Place) -> String {
        match &self.dialect {
            Dialect::Rslogix { image, .. } => {
                let rung = image.program_file(at.file).and_then(|file| file.rungs.get(at.rung));
                rung.map(rslogix_text).unwrap_or_default()
            }
            Dialect::Domore { .. } => {
                let rung = self.block(at.file).and_then(|block| block.rungs.get(at.rung));
                let all = rung.into_iter().flat_map(|rung| &rung.instructions).map(ToString::to_string);
                all.collect::<Vec<_>>().join("; ")
            }
        }
    }

    /// The symbol or nickname of an operand, if it has one.
    pub fn symbol(&self, operand: &str) -> Option<String> {
        match &self.dialect {
            Dialect::Rslogix { documentation, .. } => {
                let address = ladder::Address::parse(operand).ok()?;
                documentation.shown(&ladder::Target::from(&address), "").symbol
            }
            Dialect::Domore { documentation, .. } => {
                let name = documentation.shown(operand).name;
                (!name.is_empty()).then(|| name.into_owned())
            }
        }
    }

    /// What the box of an instruction calls its operand `index` (from 0); empty where there is only one.
    pub fn operand_name(&self, mnemonic: &str, index: usize) -> Option<&'static str> {
        let (count, name) = match &self.dialect {
            Dialect::Rslogix { image, .. } => {
                let entry = instr::by_mnemonic(mnemonic)?;
                let fits = |form: &&instr::Form| index < form.operands.len();
                let form = entry.forms_for(image.family()).find(fits).or_else(|| entry.forms.iter().find(fits))?;
                (form.operands.len(), form.operands.get(index)?.name)
            }
            Dialect::Domore { .. } => {
                let entry = domore::instruction::by_mnemonic(mnemonic)?;
                (entry.operands.len(), entry.operand(index)?.name)
            }
        };
        Some(if count == 1 { "" } else { name })
    }

    /// Page title and comment of a rung, line by line.
    pub fn comment(&self, at: Place) -> Vec<String> {
        match &self.dialect {
            Dialect::Rslogix { image, .. } => {
                let rung = image.program_file(at.file).and_then(|file| file.rungs.get(at.rung));
                let Some(comment) = rung.and_then(|rung| rung.comment.as_ref()) else { return Vec::new() };
                let title = Some(comment.title.as_str()).filter(|title| !title.is_empty());
                title.into_iter().chain(comment.lines()).map(str::to_owned).collect()
            }
            Dialect::Domore { .. } => {
                let rung = self.block(at.file).and_then(|block| block.rungs.get(at.rung));
                let lines = rung.and_then(|rung| rung.comment.as_ref()).map(domore::Comment::plain_lines);
                lines.into_iter().flatten().map(std::borrow::Cow::into_owned).collect()
            }
        }
    }

    /// `2:4`, `Fill:5`: rungs of Do-more count from 1.
    pub fn place(&self, at: Place) -> String {
        match &self.dialect {
            Dialect::Rslogix { .. } => format!("{}:{}", at.file, at.rung),
            Dialect::Domore { .. } => format!("{}:{}", self.block_name(at.file).unwrap_or_default(), at.rung + 1),
        }
    }

    /// `rung 4`.
    pub fn rung_name(&self, at: Place) -> String {
        let first = usize::from(matches!(self.dialect, Dialect::Domore { .. }));
        format!("rung {}", at.rung + first)
    }

    /// `file 2`, `code block Fill`.
    pub fn part_name(&self, number: u16) -> String {
        match &self.dialect {
            Dialect::Rslogix { .. } => format!("file {number}"),
            Dialect::Domore { .. } => format!("code block {}", self.block_name(number).unwrap_or_default()),
        }
    }

    /// The name of a code block; `None` for a program file.
    pub fn block_name(&self, number: u16) -> Option<String> {
        Some(match self.block(number)?.name.as_str() {
            "" => "(rungs without a code block)".to_owned(),
            name => name.to_owned(),
        })
    }

    /// Numbers of parts by what each is known by: its number, or its name and which of that name it is.
    pub(super) fn known_by(&self) -> BTreeMap<(String, usize), u16> {
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        let mut named = |name: String, number: u16| {
            let count = seen.entry(name.clone()).or_default();
            *count += 1;
            ((name, *count), number)
        };
        match &self.dialect {
            Dialect::Rslogix { image, .. } => {
                image.ladder_files().map(|file| named(file.number.to_string(), file.number)).collect()
            }
            Dialect::Domore { blocks, .. } => {
                (1..=u16::MAX).zip(blocks).map(|(number, block)| named(block.name.clone(), number)).collect()
            }
        }
    }

    /// Everything that has rungs, in order.
    pub fn parts(&self) -> Vec<Part> {
        match &self.dialect {
            Dialect::Rslogix { image, .. } => image
                .ladder_files()
                .map(|file| {
                    let title = match file.name.as_str() {
                        "" => format!("LAD {}", file.number),
                        name => format!("LAD {} - {name}", file.number),
                    };
                    Part { number: file.number, title, rungs: file.rungs.len() }
                })
                .collect(),
            Dialect::Domore { blocks, .. } => (1..=u16::MAX)
                .zip(blocks)
                .map(|(number, block)| {
                    let title = match block.name.as_str() {
                        "" => block.kind.title().to_owned(),
                        name => format!("{} {name}", block.kind.title()),
                    };
                    Part { number, title, rungs: block.rungs.len() }
                })
                .collect(),
        }
    }
}
