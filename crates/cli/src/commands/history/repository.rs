//! A history as a git repository: one folder for each machine, one commit for each save.
//!
//! The commits depend on the saves alone (names, contents, order), so the same archive gives the same
//! commit ids everywhere. Names from projects and archives become file names of plain characters.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use jiff::Timestamp;

use crate::commands::git;
use crate::listing::Text;

/// Longest part of a path, in characters.
const LONGEST: usize = 80;

/// Longest first line of a commit message, in characters.
const SUBJECT: usize = 100;

/// The branch that is written.
const BRANCH: &str = "main";

/// A save as a commit.
pub struct Commit {
    /// Folder of its machine, safe.
    pub folder: String,
    /// First line and the rest, not cleaned yet.
    pub subject: String,
    pub body: String,
    /// Seconds since 1970; `None` if nothing tells, then that of the commit before.
    pub time: Option<i64>,
    /// What saved it: `RSLogix 500 8.30.00`.
    pub author: String,
    pub texts: Vec<Text>,
}

/// A name as a part of a path on any system: plain characters, no way up, nothing git or Windows keeps for
/// itself.
pub fn safe(name: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || " ._-+#()".contains(c) { c } else { '_' };
    let text: String = name.chars().map(plain).take(LONGEST).collect();
    let text = text.trim_matches(|c| matches!(c, ' ' | '.' | '-'));
    let stem = text.split('.').next().unwrap_or_default().trim().to_ascii_uppercase();
    let device = matches!(stem.as_str(), "CON" | "PRN" | "AUX" | "NUL")
        || stem.strip_prefix("COM").or(stem.strip_prefix("LPT")).is_some_and(|rest| rest.len() == 1);
    match text {
        "" => "unnamed".to_owned(),
        text if device || text.to_ascii_lowercase().starts_with("git") => format!("_{text}"),
        text => text.to_owned(),
    }
}

/// Names for several things that must not share one, letters of both cases alike.
#[derive(Default)]
pub struct Names(BTreeSet<String>);

impl Names {
    /// The safe form of a name, with a number behind it if it is taken.
    pub fn take(&mut self, name: &str) -> String {
        let first = safe(name);
        let mut name = first.clone();
        let mut number = 2_u32;
        while !self.0.insert(name.to_ascii_lowercase()) {
            name = match first.rsplit_once('.') {
                Some((stem, ending)) => format!("{stem} ({number}).{ending}"),
                None => format!("{first} ({number})"),
            };
            number = number.saturating_add(1);
        }
        name
    }
}

/// Refuses a folder that holds something.
///
/// # Errors
/// In words.
pub fn check_target(folder: &Path) -> Result<(), String> {
    if std::fs::symlink_metadata(folder).is_err() {
        return Ok(());
    }
    match folder.read_dir().map(|mut entries| entries.next().is_some()) {
        Ok(false) => Ok(()),
        Ok(true) => Err(format!("{}: not empty; a history is written into a new or empty folder", folder.display())),
        Err(error) => Err(format!("{}: {error}", folder.display())),
    }
}

/// Writes the commits as a new repository with its files checked out.
///
/// # Errors
/// What git or the file system says.
pub fn write(folder: &Path, commits: &[Commit]) -> Result<(), String> {
    check_target(folder)?;
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut init = git::git(folder);
    // No template: it could bring hooks.
    init.args(["-c", "core.hooksPath=/dev/null", "init", "--quiet", "--template=", "--object-format=sha1"]);
    init.args(["--initial-branch", BRANCH, "."]);
    git::run(init, None)?;
    let mut import = git::git(folder);
    import.args(["fast-import", "--quiet", "--done", "--date-format=raw"]);
    git::run(import, Some(&stream(commits)))?;
    let mut checkout = git::git(folder);
    checkout.args([
        "-c",
        "core.hooksPath=/dev/null",
        "-c",
        "core.autocrlf=false",
        "reset",
        "--quiet",
        "--hard",
        BRANCH,
    ]);
    git::run(checkout, None)?;
    Ok(())
}

/// The input of `git fast-import`.
fn stream(commits: &[Commit]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut time = 0;
    let mut folders: BTreeMap<&str, BTreeMap<String, &str>> = BTreeMap::new();
    for commit in commits {
        time = commit.time.unwrap_or(time).max(0);
        let plain = |c: &char| !matches!(c, '<' | '>');
        let author: String = render::clean(&commit.author).chars().filter(plain).collect();
        line(&mut out, &format!("commit refs/heads/{BRANCH}"));
        line(&mut out, &format!("author {} <> {time} +0000", author.trim()));
        line(&mut out, &format!("committer rungs history <> {time} +0000"));
        data(&mut out, &message(commit));
        let now = paths(&commit.texts);
        let before = folders.entry(&commit.folder).or_default();
        for gone in before.keys().filter(|path| !now.contains_key(*path)) {
            line(&mut out, &format!("D {}/{gone}", commit.folder));
        }
        for (path, text) in &now {
            if before.get(path) != Some(text) {
                line(&mut out, &format!("M 100644 inline {}/{path}", commit.folder));
                data(&mut out, text);
            }
        }
        *before = now;
        out.push(b'\n');
    }
    line(&mut out, "done");
    out
}

fn line(out: &mut Vec<u8>, text: &str) {
    out.extend(text.as_bytes());
    out.push(b'\n');
}

fn data(out: &mut Vec<u8>, text: &str) {
    line(out, &format!("data {}", text.len()));
    line(out, text);
}

/// Safe paths with their texts. A path never begins with a quote, so git takes it as it stands.
fn paths(texts: &[Text]) -> BTreeMap<String, &str> {
    let (mut folders, mut found): (BTreeMap<String, Names>, _) = (BTreeMap::new(), BTreeMap::new());
    for text in texts {
        let Some((name, above)) = text.path.split_last() else { continue };
        let above: String = above.iter().map(|part| safe(part) + "/").collect();
        let name = folders.entry(above.clone()).or_default().take(name);
        found.insert(format!("{above}{name}"), text.text.as_str());
    }
    found
}

fn message(commit: &Commit) -> String {
    let subject = render::clean(&commit.subject.replace(['\r', '\n'], " ")).trim().to_owned();
    let subject = if subject.chars().count() > SUBJECT {
        subject.chars().take(SUBJECT - 3).chain("...".chars()).collect()
    } else {
        subject
    };
    let body: Vec<String> = commit.body.lines().map(|line| render::clean(line).trim_end().to_owned()).collect();
    format!("{subject}\n\n{}\n", body.join("\n").trim())
}

/// Seconds since 1970 of a time or date as the history has it.
pub fn seconds(when: &str) -> Option<i64> {
    let whole = if when.len() == 10 { format!("{when}T00:00:00Z") } else { when.to_owned() };
    whole.parse::<Timestamp>().ok().map(Timestamp::as_second)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_name_leaves_its_folder_or_means_something_to_a_system() {
        for (name, expected) in [
            ("../../etc/passwd", "_.._etc_passwd"),
            ("a/b\\c:d", "a_b_c_d"),
            ("..", "unnamed"),
            ("", "unnamed"),
            ("-rf", "rf"),
            (".git", "_git"),
            (".GITattributes", "_GITattributes"),
            ("git~1", "_git_1"),
            ("nul.txt", "_nul.txt"),
            ("COM1", "_COM1"),
            ("\"quoted\"\n\u{1B}[2J", "_quoted____2J"),
            ("Förderer", "F_rderer"),
            ("line. ", "line"),
        ] {
            assert_eq!(safe(name), expected, "{name:?}");
            assert_eq!(safe(&safe(name)), safe(name), "{name:?}");
        }
        let mut names = Names::default();
        assert_eq!(
            [names.take("A.txt"), names.take("a.TXT"), names.take("b/"), names.take("b?")].join(","),
            "A.txt,a (2).TXT,b_,b_ (2)"
        );
    }

    #[test]
    fn a_message_cannot_end_the_stream() {
        let text =
            Text { path: vec!["program".to_owned(), "002\nD x.slc".to_owned()], text: "data 5\ndone\n".to_owned() };
        let commit = Commit {
            folder: "m".to_owned(),
            subject: "x\ndone\n\u{1B}]0;title\u{7}".to_owned(),
            body: "done\ncommit refs/heads/evil\n".to_owned(),
            time: Some(-5),
            author: "A <b> \n committer".to_owned(),
            texts: vec![text],
        };
        let stream = String::from_utf8(stream(&[commit])).expect("text");
        assert!(stream.contains("author A b \\x0A committer <> 0 +0000\n"), "{stream}");
        assert!(stream.contains("x done \\x1B]0;title\\x07\n"), "{stream}");
        assert!(stream.contains("M 100644 inline m/program/002_D x.slc\ndata 12\n"), "{stream}");
    }
}
