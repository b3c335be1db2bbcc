//! Where scenarios get their programs: files beside them, ladder text inside them.

use std::io::Read;
use std::path::{Path, PathBuf};

use convert::slc::rung::parse_rungs;
use domore::engine::Options;
use ladder::{Constant, Element, Family, Image, Operand, Rung, Series, Severity};
use sim::scenario::{Foreign, Loader, RunError, Scenario, Spot, Subject, Target};

use crate::commands::open;
use crate::do_more;

/// Loads for scenarios of one folder.
pub struct FolderLoader {
    /// Folder that relative paths start from; what is not there is looked for from the current folder.
    pub folder: PathBuf,
    /// Readings of Do-more where documentation ends.
    pub do_more: domore::choices::Choices,
}

impl FolderLoader {
    fn file(&self, path: &str) -> PathBuf {
        // A scenario written on Windows means the same file.
        let path = path.replace('\\', "/");
        let beside = self.folder.join(&path);
        if beside.exists() || !Path::new(&path).exists() { beside } else { PathBuf::from(path) }
    }

    /// The text of a Do-more program; `None` if the file is something else.
    fn do_more_text(&self, path: &Spot<String>, wanted: bool) -> Result<Option<String>, RunError> {
        let at = |value: String| RunError::Scenario(Spot { value, line: path.line });
        let file = self.file(&path.value);
        let mut bytes = Vec::new();
        let read = std::fs::File::open(&file).and_then(|file| file.take(MOST_TEXT + 1).read_to_end(&mut bytes));
        match read {
            // What is larger is no text of a program; the reader of projects says what it is.
            Ok(length) if length as u64 > MOST_TEXT => return Ok(None),
            Err(error) if wanted => return Err(at(format!("{}: {error}", path.value))),
            Err(_) => return Ok(None),
            Ok(_) => {}
        }
        let text = convert::slc::decode(&bytes).into_owned();
        Ok((wanted || domore::text::is_domore(&text)).then_some(text))
    }
}

/// Most bytes of a file that are looked at as Do-more text.
const MOST_TEXT: u64 = 64 << 20;

impl Loader for FolderLoader {
    fn controller(&self, scenario: &Scenario) -> Result<Option<Foreign>, RunError> {
        let wanted = scenario.target == Some(Target::DoMore);
        let options = Options { choices: self.do_more, ..Options::default() };
        match &scenario.program {
            Subject::Inline(routines) if wanted => do_more::from_routines(routines, &options).map(Some),
            Subject::File(path) if wanted || scenario.target.is_none() => match self.do_more_text(path, wanted)? {
                Some(text) => do_more::from_file(&text, path.line, &options).map(Some),
                None => Ok(None),
            },
            _ => Ok(None),
        }
    }

    fn program(&self, path: &str) -> Result<Image, String> {
        let project = open(&self.file(path), rss::Mode::Permissive)?;
        match project.diagnostics.iter().find(|diagnostic| diagnostic.severity == Severity::Error) {
            // A test on half a program would prove nothing.
            Some(worst) => Err(format!("not all of it could be read: {}: {}", worst.place, worst.message)),
            None => Ok(project.main),
        }
    }

    fn rungs(&self, text: &str, family: Family) -> Result<Vec<Rung>, Vec<(u32, String)>> {
        let family = (family != Family::Unknown).then_some(family);
        let mut rungs = parse_rungs(text, family).map_err(|errors| -> Vec<_> {
            errors.into_iter().map(|error| (error.line, error.to_string())).collect()
        })?;
        rungs.iter_mut().for_each(|rung| hexadecimal(&mut rung.series));
        Ok(rungs)
    }
}

/// Reads `F0F0h` as the number it is: in a project such a word could be a symbol, but a ladder inside
/// a scenario has none.
fn hexadecimal(series: &mut Series) {
    for element in series {
        match element {
            Element::Branch(branch) => branch.legs.iter_mut().for_each(hexadecimal),
            Element::Instruction(instruction) => {
                for operand in &mut instruction.operands {
                    if let Operand::Symbol(text) = operand
                        && text.ends_with(['h', 'H'])
                        && let Some(constant) = Constant::parse(&format!("0{text}"))
                    {
                        *operand = Operand::Constant(constant);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hex_masks_may_begin_with_a_letter() {
        let loader = FolderLoader { folder: PathBuf::new(), do_more: Default::default() };
        let rungs =
            loader.rungs("BST MEQ N7:0 FFF0h N7:1 NXB XIC B3:0/0 BND OTE B3:0/1", Family::Slc503).expect("reads");
        let mask = rungs.iter().flat_map(Rung::instructions).next().and_then(|meq| meq.operands.get(1).cloned());
        assert!(matches!(mask, Some(Operand::Constant(mask)) if mask.as_integer() == Some(0xFFF0)));
        let error = loader.rungs("OTE B3:0/0\nXCI B3:0/1", Family::Slc503).expect_err("no such instruction");
        assert_eq!(error.first().map(|error| error.0), Some(2));
    }
}
