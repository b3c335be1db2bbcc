//! `rungs serve A B`: an original and what was made of it, side by side.

use std::path::Path;
use std::sync::Arc;

use analysis::diff::rung_pairs;
use analysis::proof::{self, Mapping, Named, Progress, RungFate, choices_of_converted};
use convert::AnyProject;
use ladder::Image;
use server::PairView;
use server::prover::{Prover, Run};
use server::workbench::{Pair, Slc, Subject, Workbench};
use sim::Approximation;

use super::serve::{View, not_run, of_do_more, slc};
use super::{file_name, prove};
use crate::args::ServeArguments;
use crate::output::{Error, Outcome, printable};

/// What is served, or how the command ends without serving.
type Loaded = Result<(Workbench, View, PairView), Outcome>;

pub fn load(arguments: &ServeArguments, other: &Path) -> Result<Loaded, Error> {
    let path = &arguments.program;
    if other.is_dir() {
        let why = "is a folder: name the program that `rungs migrate` wrote there, and its address-map.csv with --map";
        return Err(Error::Use(format!("{}: {why}", other.display())));
    }
    let (first, second) = match (prove::open(path), prove::open(other)) {
        (Ok(first), Ok(second)) => (first, second),
        (first, second) => {
            let wrong = [first.err(), second.err()];
            wrong.into_iter().flatten().for_each(|why| eprintln!("{}", printable(&why)));
            return Ok(Err(Outcome::Unreadable));
        }
    };
    let AnyProject::Rslogix(original) = first else {
        let name = path.display();
        return Err(Error::Use(format!("{name}: the original must be an SLC 500 or MicroLogix program")));
    };
    let rows = match arguments.map.as_deref().map(prove::mappings).transpose() {
        Ok(rows) => rows,
        Err(why) => {
            eprintln!("{}", printable(&why));
            return Ok(Err(Outcome::Unreadable));
        }
    };
    let mut options = proof::Options {
        choices: arguments.simulation.choices(),
        domore_choices: arguments.simulation.do_more(),
        original: Named { program: prove::beside(path, Path::new("")), family: None },
        ..proof::Options::default()
    };
    options.other.program = prove::beside(other, Path::new(""));
    if let (Some(rows), Some(path)) = (&rows, &arguments.map) {
        let (numbers, map): (Vec<usize>, Vec<Mapping>) = rows.iter().cloned().unzip();
        prove::refuse(&original.main, &second, &map, &numbers, path, &options)?;
    }
    let map: Option<Vec<Mapping>> = rows.map(|rows| rows.into_iter().map(|(_, mapping)| mapping).collect());
    let image = original.main.clone();
    let file = file_name(other);
    let sides = Sides { arguments, image, options, other };
    match second {
        AnyProject::Rslogix(changed) => {
            sides.options_of_slc().versions(file_name(path), *original, file, *changed, map)
        }
        AnyProject::Domore(document) => {
            let map = map.ok_or_else(prove::needs_map)?;
            sides.converted(file_name(path), *original, file, document.project, map)
        }
    }
}

/// The original, and how to look at both.
struct Sides<'a> {
    arguments: &'a ServeArguments,
    image: Image,
    options: proof::Options,
    other: &'a Path,
}

impl Sides<'_> {
    fn options_of_slc(mut self) -> Self {
        self.options.other.family = None;
        self
    }

    /// Two versions of a program.
    fn versions(
        self,
        file: String,
        original: ladder::Project,
        other_file: String,
        other: ladder::Project,
        map: Option<Vec<Mapping>>,
    ) -> Result<Loaded, Error> {
        let choices = self.options.choices;
        let changed = other.main.clone();
        let (a, b) = (slc(self.arguments, choices, file, original), slc(self.arguments, choices, other_file, other));
        let sides = match (a, b) {
            (Ok(a), Ok((machine, view))) => (a, (Box::new(machine) as Box<dyn Subject>, view)),
            (a, b) => return Ok(Err(self.refused(a.err(), b.err()))),
        };
        let place = |place: analysis::diff::Place| [usize::from(place.file), place.rung];
        let pairs = rung_pairs(&self.image, &changed).into_iter();
        let rungs = pairs.map(|(a, b)| join(place(a), place(b))).collect();
        let (image, options, given) = (self.image.clone(), self.options.clone(), map.clone());
        let run = move |seed, scans, progress: Arc<Progress>| {
            let options = proof::Options { seed, scans, progress: Some(progress), ..options.clone() };
            proof::prove_slc(&image, &changed, given.as_deref(), &options)
        };
        let map = map.unwrap_or_else(|| Mapping::identity(&self.image));
        self.together(sides, &map, None, rungs, Arc::new(run))
    }

    /// A program and the Do-more program made of it.
    fn converted(
        self,
        file: String,
        original: ladder::Project,
        other_file: String,
        project: domore::Project,
        map: Vec<Mapping>,
    ) -> Result<Loaded, Error> {
        let settings = domore::engine::Options {
            choices: self.options.domore_choices,
            unsupported: match self.arguments.accept_unsupported {
                true => domore::engine::Unsupported::Stop,
                false => domore::engine::Unsupported::Refuse,
            },
            ..Default::default()
        };
        let program = domore::engine::Program::compile(&project, &settings);
        let program = program.map_err(|refusals| refusals.iter().map(ToString::to_string).collect::<Vec<_>>());
        let b = program.and_then(|program| {
            let named = program.approximations().iter();
            let named: Vec<_> = named.map(|found| Approximation { site: None, why: found.to_string() }).collect();
            of_do_more(other_file, project.clone(), program, &named)
        });
        let a = slc(self.arguments, choices_of_converted(self.options.choices), file, original);
        let sides = match (a, b) {
            (Ok(a), Ok((machine, view))) => (a, (Box::new(machine) as Box<dyn Subject>, view)),
            (a, b) => return Ok(Err(self.refused(a.err(), b.err()))),
        };
        let origins = proof::origins(&project).into_iter();
        let rungs = origins.map(|it| join([usize::from(it.file), it.from as usize], [it.block, it.rung])).collect();
        let fates = proof::fates(&project);
        let (image, options, given) = (self.image.clone(), self.options.clone(), (map.clone(), fates.clone()));
        let run = move |seed, scans, progress: Arc<Progress>| {
            let options = proof::Options { seed, scans, progress: Some(progress), ..options.clone() };
            proof::prove_domore(&image, &project, &given.0, given.1.as_deref(), &options)
        };
        self.together(sides, &map, fates.as_deref(), rungs, Arc::new(run))
    }

    fn refused(&self, a: Option<Vec<String>>, b: Option<Vec<String>>) -> Outcome {
        let paths = [self.arguments.program.as_path(), self.other];
        for (path, why) in paths.into_iter().zip([a, b]) {
            if let Some(why) = why {
                not_run(path, &why);
            }
        }
        Outcome::Finding
    }

    fn together(
        self,
        ((a, view), (b, other)): ((Slc, View), (Box<dyn Subject>, View)),
        map: &[Mapping],
        fates: Option<&[RungFate]>,
        rungs: Vec<[usize; 4]>,
        run: Arc<Run>,
    ) -> Result<Loaded, Error> {
        let pair = Pair::new(&self.image, a, b, map, fates).map_err(Error::Use)?;
        let pairing = Arc::clone(pair.pairing());
        let pages = PairView::new(other, pairing, &self.image.documentation, rungs, Prover::new(run));
        Ok(Ok((Workbench::new(Box::new(pair)), view, pages)))
    }
}

fn join([a, b]: [usize; 2], [c, d]: [usize; 2]) -> [usize; 4] {
    [a, b, c, d]
}
