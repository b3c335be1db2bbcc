//! Two folders: which file of one is which of the other, by name, then by content.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::{Path, PathBuf};

use analysis::diff::Profile;
use convert::AnyProject;
use serde_json::json;

use super::{Printer, pair};
use crate::commands::{MOST_BYTES, file_name, mode, read_file};
use crate::files;
use crate::output::{Error, Outcome, Printable, printable};

/// Instructions in common, of 1000, from which a file of another name is taken for the same program.
const SAME_PROGRAM: u32 = 600;

/// Instructions from which a likeness says something: small programs of beginners are much alike.
const ENOUGH: usize = 8;

/// Pairs of files that are looked at for their content; beyond that only equal bytes are found.
const MOST_PAIRS: usize = 250_000;

/// How two files were found to belong together.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Paired {
    Name,
    Bytes,
    Content,
}

impl Paired {
    pub(super) fn as_str(self) -> &'static str {
        match self {
            Paired::Name => "name",
            Paired::Bytes => "bytes",
            Paired::Content => "content",
        }
    }
}

/// A file of a folder.
struct Found {
    path: PathBuf,
    /// Below the folder.
    name: String,
    bytes: Option<Vec<u8>>,
}

impl Found {
    /// Its bytes, if there are any.
    fn content(&self) -> Option<&[u8]> {
        self.bytes.as_deref().filter(|bytes| !bytes.is_empty())
    }
}

fn list(folder: &Path) -> Result<Vec<Found>, Error> {
    // An empty folder is a folder: all files of the other one came or went.
    let found = match files::expand(&[folder.to_owned()], files::PROJECTS) {
        Ok(found) => found,
        Err(_) if folder.read_dir().is_ok() => Vec::new(),
        Err(why) => return Err(Error::Use(why)),
    };
    let one = |path: PathBuf| Found {
        name: path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().into_owned(),
        bytes: read_file(&path, MOST_BYTES).ok(),
        path,
    };
    Ok(found.into_iter().map(one).collect())
}

/// Compares all files of two folders with their counterparts; files without one are told.
pub(super) fn compare(
    old: &Path,
    new: &Path,
    strict: bool,
    printer: &Printer,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let (left, right) = (list(old)?, list(new)?);
    if left.is_empty() && right.is_empty() {
        // A wrong path must not pass for two equal archives.
        let (old, new) = (old.display(), new.display());
        return Err(Error::Use(printable(&format!("{old}, {new}: no .RSS file in these folders"))));
    }
    let mut outcome = Outcome::Done;
    for (folder, found) in [(old, &left), (new, &right)] {
        duplicates(folder, found, printer, out)?;
    }
    let pairs = paired(&left, &right, strict);
    let mut shown: Vec<(&str, Option<usize>, Option<usize>, Paired)> = Vec::new();
    for (i, j, how) in &pairs {
        shown.push((right.get(*j).map_or("", |found| found.name.as_str()), Some(*i), Some(*j), *how));
    }
    let alone = |count: usize, side: fn(&(usize, usize, Paired)) -> usize| {
        let taken: BTreeSet<usize> = pairs.iter().map(side).collect();
        (0..count).filter(move |index| !taken.contains(index)).collect::<Vec<_>>()
    };
    for i in alone(left.len(), |pair| pair.0) {
        shown.push((left.get(i).map_or("", |found| found.name.as_str()), Some(i), None, Paired::Name));
    }
    for j in alone(right.len(), |pair| pair.1) {
        shown.push((right.get(j).map_or("", |found| found.name.as_str()), None, Some(j), Paired::Name));
    }
    shown.sort_by_key(|(name, ..)| name.to_lowercase());
    let (mut differ, mut equal, mut renamed, mut removed, mut added) = (0, 0, 0, 0, 0);
    for (_, i, j, how) in shown {
        let (a, b) = (i.and_then(|i| left.get(i)), j.and_then(|j| right.get(j)));
        let found = match (a, b) {
            (Some(a), Some(b)) => {
                let found = pair((&a.path, &b.path), strict, Some(how), printer, out)?;
                if how != Paired::Name {
                    renamed += 1;
                }
                if found == Outcome::Done {
                    equal += 1
                } else {
                    differ += 1
                }
                // A file with another name is a difference of the folders.
                if how == Paired::Name { found } else { found.max(Outcome::Finding) }
            }
            (Some(only), None) => {
                removed += 1;
                only_in(only, old, "removed", printer, out)?
            }
            (None, Some(only)) => {
                added += 1;
                only_in(only, new, "added", printer, out)?
            }
            (None, None) => continue,
        };
        outcome = outcome.max(found);
    }
    if !printer.json {
        writeln!(
            Printable(out),
            "{differ} files differ or were not readable, {equal} equal, {renamed} of them under another name; {removed} removed, {added} added"
        )?;
    }
    Ok(outcome)
}

/// A file without a counterpart.
fn only_in(
    found: &Found,
    folder: &Path,
    change: &str,
    printer: &Printer,
    out: &mut dyn Write,
) -> Result<Outcome, Error> {
    let (file, folder) = (found.path.display().to_string(), folder.display().to_string());
    if let Some(pages) = &printer.pages {
        let (old, new) = if change == "removed" { (file.as_str(), "") } else { ("", file.as_str()) };
        pages.without_page(old, new, change);
    } else if printer.json {
        writeln!(out, "{}", json!({"file": file, "only_in": folder, "change": change}))?;
    } else {
        writeln!(Printable(out), "{file}: only in {folder} ({change})\n")?;
    }
    Ok(Outcome::Finding)
}

/// Files of one folder with the same bytes.
fn duplicates(folder: &Path, found: &[Found], printer: &Printer, out: &mut dyn Write) -> Result<(), Error> {
    let mut same: BTreeMap<&[u8], Vec<&Found>> = BTreeMap::new();
    for file in found {
        if let Some(bytes) = file.content() {
            same.entry(bytes).or_default().push(file);
        }
    }
    let mut groups: Vec<Vec<&Found>> = same.into_values().filter(|files| files.len() > 1).collect();
    groups.sort_by(|a, b| a.first().map(|file| &file.name).cmp(&b.first().map(|file| &file.name)));
    for group in groups {
        let names: Vec<String> = group.iter().map(|file| file.path.display().to_string()).collect();
        if let Some(pages) = &printer.pages {
            pages.without_page("", "", &format!("the same bytes: {}", names.join(", ")));
        } else if printer.json {
            writeln!(out, "{}", json!({"folder": folder.display().to_string(), "same_bytes": names}))?;
        } else {
            writeln!(Printable(&mut *out), "Same bytes: {}\n", names.join(", "))?;
        }
    }
    Ok(())
}

/// By names, upper and lower case alike; then equal bytes; then the most alike programs first.
fn paired(left: &[Found], right: &[Found], strict: bool) -> Vec<(usize, usize, Paired)> {
    let mut pairs = Vec::new();
    let (mut free_left, mut free_right) = (vec![true; left.len()], vec![true; right.len()]);
    let mut take = |i: usize, j: usize, how, pairs: &mut Vec<(usize, usize, Paired)>| {
        if let (Some(a), Some(b)) = (free_left.get_mut(i), free_right.get_mut(j))
            && *a
            && *b
        {
            (*a, *b) = (false, false);
            pairs.push((i, j, how));
        }
    };
    // The same letters first: a folder can hold `a.RSS` and `A.RSS`.
    let names = |fold: fn(&str) -> String| {
        let mut of: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for (j, found) in right.iter().enumerate() {
            of.entry(fold(&found.name)).or_default().push(j);
        }
        let with = left.iter().enumerate().flat_map(move |(i, found)| {
            let same = of.get(&fold(&found.name)).cloned().unwrap_or_default();
            same.into_iter().map(move |j| (i, j))
        });
        with.collect::<Vec<_>>()
    };
    for fold in [str::to_owned, str::to_lowercase as fn(&str) -> String] {
        for (i, j) in names(fold) {
            take(i, j, Paired::Name, &mut pairs);
        }
    }
    let rest = |pairs: &[(usize, usize, Paired)]| {
        let (a, b): (BTreeSet<usize>, BTreeSet<usize>) = pairs.iter().map(|pair| (pair.0, pair.1)).unzip();
        let free = |count: usize, taken: BTreeSet<usize>| (0..count).filter(|n| !taken.contains(n)).collect::<Vec<_>>();
        (free(left.len(), a), free(right.len(), b))
    };
    let (a, b) = rest(&pairs);
    for i in &a {
        for j in &b {
            let (x, y) = (left.get(*i).and_then(Found::content), right.get(*j).and_then(Found::content));
            if x.is_some() && x == y {
                take(*i, *j, Paired::Bytes, &mut pairs);
            }
        }
    }
    let (a, b) = rest(&pairs);
    if a.len().saturating_mul(b.len()) > MOST_PAIRS {
        eprintln!("{} and {} files have no counterpart by name: their contents are not compared", a.len(), b.len());
        return pairs;
    }
    let profiles = |found: &[Found], indexes: &[usize]| -> Vec<(usize, Profile)> {
        let all = indexes.iter().filter_map(|index| Some((*index, profile(found.get(*index)?, strict)?)));
        all.filter(|(_, profile)| profile.len() >= ENOUGH).collect()
    };
    let (a, b) =
        if a.is_empty() || b.is_empty() { (Vec::new(), Vec::new()) } else { (profiles(left, &a), profiles(right, &b)) };
    let mut alike = Vec::new();
    for (i, x) in &a {
        for (j, y) in &b {
            let shared = x.similarity(y);
            if shared >= SAME_PROGRAM {
                alike.push((std::cmp::Reverse(shared), *i, *j));
            }
        }
    }
    alike.sort_unstable();
    for (_, i, j) in alike {
        take(i, j, Paired::Content, &mut pairs);
    }
    pairs
}

fn profile(found: &Found, strict: bool) -> Option<Profile> {
    let bytes = found.bytes.as_deref()?;
    match convert::open_any(bytes, &file_name(&found.path), mode(strict)) {
        Ok(AnyProject::Rslogix(project)) => Some(Profile::of(&project.main)),
        Ok(AnyProject::Domore(_)) => None,
        // Reported when it is compared or told.
        Err(why) => {
            eprintln!("{}", printable(&format!("{}: {why}", found.path.display())));
            None
        }
    }
}
