//! Where scenarios get their programs: files beside them, ladder text inside them.

use std::path::{Path, PathBuf};

use convert::slc::rung::parse_rungs;
use ladder::{Constant, Element, Family, Image, Operand, Rung, Series, Severity};
use sim::scenario::Loader;

use crate::commands::open;

/// Loads for scenarios of one folder.
pub struct FolderLoader {
    /// Folder that relative paths start from; what is not there is looked for from the current folder.
    pub folder: PathBuf,
}

impl Loader for FolderLoader {
    fn program(&self, path: &str) -> Result<Image, String> {
        // A scenario written on Windows means the same file.
        let path = path.replace('\\', "/");
        let beside = self.folder.join(&path);
        let file = if beside.exists() || !Path::new(&path).exists() { beside } else { PathBuf::from(path) };
        let project = open(&file, rss::Mode::Permissive)?;
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
        let loader = FolderLoader { folder: PathBuf::new() };
        let rungs =
            loader.rungs("BST MEQ N7:0 FFF0h N7:1 NXB XIC B3:0/0 BND OTE B3:0/1", Family::Slc503).expect("reads");
        let mask = rungs.iter().flat_map(Rung::instructions).next().and_then(|meq| meq.operands.get(1).cloned());
        assert!(matches!(mask, Some(Operand::Constant(mask)) if mask.as_integer() == Some(0xFFF0)));
        let error = loader.rungs("OTE B3:0/0\nXCI B3:0/1", Family::Slc503).expect_err("no such instruction");
        assert_eq!(error.first().map(|error| error.0), Some(2));
    }
}
