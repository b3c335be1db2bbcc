//! An example beside what a migration makes of it, changed or not.

#![allow(dead_code, reason = "each test uses what it needs")]

use std::path::{Path, PathBuf};
use std::sync::Arc;

use analysis::proof::{self, Mapping, Options, Progress, RungFate, choices_of_converted};
use ladder::Project;
use server::PairView;
use server::prover::Prover;
use server::view::{DoMoreProgram, Program, SlcProgram};
use server::workbench::{DoMore, Pair, Slc, Workbench};

/// The examples of the repository, wherever the crate of the test stands in it.
fn examples() -> PathBuf {
    let above = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().map(|folder| folder.join("examples"));
    above.into_iter().find(|folder| folder.join("README.md").is_file()).expect("the examples are there")
}

/// An original and what was made of it.
pub(crate) struct Two {
    pub(crate) original: Project,
    pub(crate) converted: domore::Project,
    pub(crate) map: Vec<Mapping>,
    pub(crate) fates: Option<Vec<RungFate>>,
}

impl Two {
    /// `motor/motor.RSS` and its migration with these texts replaced, each of which must stand in it.
    pub(crate) fn of(example: &str, changes: &[(&str, &str)]) -> Two {
        let path = examples().join(example);
        let bytes = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let original = convert::open(&bytes, example, rss::Mode::Permissive).expect("reads");
        let migration = convert::migrate::migrate(&original.main, &[], &Default::default()).expect("migrates");
        let rows = migration.map.iter().filter(|row| row.places_data());
        let mapping = |row: &convert::migrate::MapRow| Mapping {
            original: row.slc.clone(),
            words: row.words,
            other: row.domore.clone(),
        };
        let mut text = domore::text::write(&migration.project).replace("\r\n", "\n");
        for (from, to) in changes {
            assert!(text.contains(from), "`{from}` is not in\n{text}");
            text = text.replacen(from, to, 1);
        }
        let converted = domore::text::read(&text).expect("reads back").project;
        let fates = proof::fates(&converted);
        Two { original, converted, map: rows.map(mapping).collect(), fates }
    }

    pub(crate) fn pair(&self) -> Pair {
        let choices = choices_of_converted(sim::Choices::default());
        let options = sim::Options { choices, ..sim::Options::default() };
        let program = sim::Program::compile(&self.original.main, &options).expect("runs");
        let a = Slc::new(sim::Machine::new(program), &self.original.main);
        let program = domore::engine::Program::compile(&self.converted, &Default::default()).expect("runs");
        let b = DoMore::new(program, &self.converted);
        Pair::new(&self.original.main, a, Box::new(b), &self.map, self.fates.as_deref()).expect("begins alike")
    }

    pub(crate) fn bench(&self) -> Workbench {
        Workbench::new(Box::new(self.pair()))
    }

    /// What a proof says of the two.
    pub(crate) fn prove(&self, seed: u64, scans: u64, progress: Option<Arc<Progress>>) -> proof::Report {
        let options = Options { seed, scans, progress, ..Options::default() };
        proof::prove_domore(&self.original.main, &self.converted, &self.map, self.fates.as_deref(), &options)
    }

    /// What pages show of the two.
    pub(crate) fn views(self, pair: &Pair) -> (Arc<dyn Program>, PairView) {
        let two = Arc::new(self);
        let view = SlcProgram::new("original.RSS".to_owned(), two.original.clone(), Vec::new());
        let other = DoMoreProgram::new("converted.txt".to_owned(), two.converted.clone(), Vec::new()).expect("memory");
        let origins = proof::origins(&two.converted);
        let rungs = origins.iter().map(|it| [it.file.into(), it.from as usize, it.block, it.rung]).collect();
        let documentation = two.original.main.documentation.clone();
        let run = move |seed, scans, progress| two.prove(seed, scans, Some(progress));
        let prover = Prover::new(Arc::new(run));
        let pages = PairView::new(Arc::new(other), Arc::clone(pair.pairing()), &documentation, rungs, prover);
        (Arc::new(view), pages)
    }
}
