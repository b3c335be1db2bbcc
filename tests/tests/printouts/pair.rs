//! Reports, the projects beside them, and which image a report was printed from.

use crate::{ASPECTS, Outcome};
use ladder::{Image, Project};
use rungs_tests::corpus;
use rungs_tests::drawing::{self, DrawnFile};
use rungs_tests::printout::{self, Candidate, Printout, TagRow};
use std::path::{Path, PathBuf};

/// A report with its drawing and the projects that may be its source.
pub(crate) struct Report {
    /// Path below the corpus folder.
    pub(crate) name: String,
    /// The text.
    pub(crate) printout: Printout,
    /// The drawn ladder pages.
    pub(crate) drawing: Vec<DrawnFile>,
    /// Projects of the same folder that can be read, best name first.
    pub(crate) projects: Vec<(Candidate, Project)>,
}

/// A report beside one image of one project.
pub(crate) struct Pair<'a> {
    /// The report.
    pub(crate) report: &'a Report,
    /// File name of the project.
    pub(crate) project: String,
    /// The project, for what images share.
    pub(crate) whole: &'a Project,
    /// The image.
    pub(crate) image: &'a Image,
    /// `main`, `online` or `autosave`.
    pub(crate) image_name: &'static str,
}

/// The one listing of the corpus that RSLogix did not print.
const TAGS: &str = "address_symbol_database.pdf.txt";

/// Reads all reports of the corpus and the projects beside them.
pub(crate) fn reports(root: &Path) -> Vec<Report> {
    let projects = corpus::files(root, ".rss").expect("corpus can be listed");
    let texts = corpus::files(root, ".pdf.txt").expect("corpus can be listed");
    texts.iter().filter(|t| !t.ends_with(TAGS)).map(|text| read(root, text, &projects)).collect()
}

/// The tag dictionaries of the corpus, each with the project of its folder.
pub(crate) fn tags(root: &Path) -> Vec<(Vec<TagRow>, Project)> {
    let projects = corpus::files(root, ".rss").expect("corpus can be listed");
    let texts = corpus::files(root, TAGS).expect("corpus can be listed");
    let pair = |text: &PathBuf| {
        let (rows, _) = printout::parse_tags(&std::fs::read_to_string(text).expect("the listing is UTF-8 text"));
        let project = printout::candidates(text, "", &projects).iter().find_map(|c| open(&c.path));
        (rows, project.expect("a project lies beside the listing"))
    };
    texts.iter().map(pair).collect()
}

fn read(root: &Path, text: &Path, projects: &[PathBuf]) -> Report {
    let printout = printout::parse(&std::fs::read_to_string(text).expect("a report is UTF-8 text"));
    // The drawing is in the PDF beside the text; a report kept as text alone is compared without it.
    let drawing = match std::fs::read(text.with_extension("")) {
        Ok(bytes) => drawing::read(&bytes).expect("a report beside its text is a PDF"),
        Err(_) => Vec::new(),
    };
    let found = printout::candidates(text, &printout.name, projects);
    let open = |candidate: Candidate| Some((open(&candidate.path)?, candidate)).map(|(p, c)| (c, p));
    let projects = found.into_iter().filter_map(open).collect();
    Report { name: corpus::name(root, text), printout, drawing, projects }
}

fn open(path: &Path) -> Option<Project> {
    let bytes = std::fs::read(path).ok()?;
    convert::open(&bytes, "", rss::Mode::Permissive).ok()
}

/// The outcome of every aspect, by its name.
pub(crate) type Outcomes = Vec<(&'static str, Outcome)>;

/// The image that agrees best: the printed program ID decides, then the number of rows that agree.
pub(crate) fn best(report: &Report) -> Option<(Pair<'_>, Outcomes)> {
    let mut best: Option<((bool, usize), Pair<'_>, Outcomes)> = None;
    for (candidate, project) in &report.projects {
        let images = [
            ("main", Some(&project.main)),
            ("online", project.online.as_ref()),
            ("autosave", project.autosave.as_ref()),
        ];
        for (image_name, image) in images.into_iter().filter_map(|(name, image)| Some((name, image?))) {
            let file = candidate.path.file_name().map(|n| n.to_string_lossy().into_owned());
            let project_name = file.unwrap_or_default();
            let pair = Pair { report, project: project_name, whole: project, image, image_name };
            let outcomes: Outcomes = ASPECTS.iter().map(|(name, compare)| (*name, compare(&pair))).collect();
            let agreeing = outcomes.iter().map(|(_, o)| o.rows.saturating_sub(o.wrong.len())).sum();
            let printed = report.printout.processor.as_ref().and_then(|p| p.program_id);
            let same_id = printed.is_some_and(|id| image.processor.program_id == Some(id));
            let score = (same_id, agreeing);
            if best.as_ref().is_none_or(|(most, ..)| score > *most) {
                best = Some((score, pair, outcomes));
            }
        }
    }
    best.map(|(_, pair, outcomes)| (pair, outcomes))
}
