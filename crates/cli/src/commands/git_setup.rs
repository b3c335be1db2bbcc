//! `rungs git-setup`: lets git show, and merge, project files; and the text that git shows.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::{git, mode, open, read_file};
use crate::args::{GitSetupArguments, TextconvArguments};
use crate::listing;
use crate::output::{Error, Outcome, printable};

/// What stands above our line in an attributes file.
const MARK: &str = "# written by `rungs git-setup`, removed by `rungs git-setup --remove`";

/// Project files, whatever the letters of their ending.
const PATTERN: &str = "*.[Rr][Ss][Ss]";

/// Headings of hunks: the file of a listing, or the rung's program file.
const HEADINGS: &str = "^(==== .* ====|% Program file .*)$";

pub fn run(arguments: &GitSetupArguments) -> Result<Outcome, Error> {
    let scope = if arguments.global { "--global" } else { "--local" };
    let here = Path::new(".");
    let attributes = if arguments.global { global_attributes()? } else { top()?.join(".gitattributes") };
    let program = program(arguments)?;
    let config = |words: &[&str]| {
        let mut command = git::git(here);
        command.args(["config", scope]).args(words);
        git::run(command, None)
    };
    // Ours alone: what was set before goes, so that setting up twice is setting up once.
    for section in ["diff.rungs", "merge.rungs", "difftool.rungs"] {
        let _ = config(&["--remove-section", section]);
    }
    let mut out = std::io::stdout();
    if arguments.remove {
        write_attributes(&attributes, None)?;
        writeln!(out, "removed from git's {} settings and from {}", &scope[2..], attributes.display())?;
        return Ok(Outcome::Done);
    }
    let set = |name: &str, value: &str| config(&[name, value]).map(drop).map_err(Error::Use);
    set("diff.rungs.textconv", &format!("{program} textconv --form {}", listing::FORM))?;
    set("diff.rungs.cachetextconv", "true")?;
    set("diff.rungs.xfuncname", HEADINGS)?;
    set("difftool.rungs.cmd", &format!("{program} diff \"$LOCAL\" \"$REMOTE\""))?;
    let mut line = format!("{PATTERN} -text diff=rungs");
    if arguments.merge {
        set("merge.rungs.name", "rungs and documentation of RSLogix 500 projects")?;
        // Git replaces what follows a `%`.
        set("merge.rungs.driver", &format!("{} merge-driver %O %A %B %P", program.replace('%', "%%")))?;
        // Bases made of several ancestors are no projects anybody saved.
        set("merge.rungs.recursive", "binary")?;
        line.push_str(" merge=rungs");
    }
    write_attributes(&attributes, Some(&line))?;
    writeln!(out, "git diff, log -p and show now show rungs ({line}, in {})", attributes.display())?;
    writeln!(out, "git difftool -t rungs compares them rung by rung")?;
    if arguments.merge {
        writeln!(out, "git merge merges rungs, documentation and data tables")?;
    }
    Ok(Outcome::Done)
}

/// The command as git's shell must see it.
fn program(arguments: &GitSetupArguments) -> Result<String, Error> {
    let path = match &arguments.program {
        Some(path) => path.clone(),
        None => std::env::current_exe()
            .map_err(|error| Error::Use(format!("where this program is cannot be found out: {error}")))?,
    };
    let text = path.to_str().ok_or_else(|| {
        Error::Use(format!("{}: git's settings take only paths of Unicode characters", path.display()))
    })?;
    if cfg!(windows) {
        return Ok(quoted(&text.replace('\\', "/")));
    }
    Ok(quoted(text))
}

/// In single quotes for a shell: nothing in it means anything.
fn quoted(text: &str) -> String {
    format!("'{}'", text.replace('\'', r"'\''"))
}

/// The top of the work tree.
fn top() -> Result<PathBuf, Error> {
    let mut command = git::git(Path::new("."));
    command.args(["rev-parse", "--show-toplevel"]);
    let found = git::run(command, None)
        .map_err(|why| Error::Use(format!("{why}; run this inside a repository, or with --global for all of yours")))?;
    let text = String::from_utf8_lossy(&found);
    Ok(PathBuf::from(text.strip_suffix('\n').unwrap_or(&text)))
}

/// The attributes file for all repositories of a user: git's setting, else where git looks without one.
fn global_attributes() -> Result<PathBuf, Error> {
    let mut command = git::git(Path::new("."));
    command.args(["config", "--global", "--type=path", "core.attributesFile"]);
    if let Ok(found) = git::run(command, None) {
        let text = String::from_utf8_lossy(&found);
        let text = text.strip_suffix('\n').unwrap_or(&text);
        if !text.is_empty() {
            return Ok(PathBuf::from(text));
        }
    }
    let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let folder = variable("XDG_CONFIG_HOME").or_else(|| Some(variable("HOME")?.join(".config")));
    let folder = folder.ok_or_else(|| Error::Use("neither XDG_CONFIG_HOME nor HOME is set".to_owned()))?;
    Ok(folder.join("git").join("attributes"))
}

/// Puts our line into an attributes file, or takes it out; all other lines stay as they are.
fn write_attributes(path: &Path, line: Option<&str>) -> Result<(), Error> {
    let wrong = |error: std::io::Error| Error::Use(format!("{}: {error}", path.display()));
    let before = match std::fs::read(path) {
        Ok(bytes) => bytes,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Vec::new(),
        Err(error) => return Err(wrong(error)),
    };
    let mut after: Vec<u8> = Vec::new();
    let mut ours = false;
    for text in before.split_inclusive(|byte| *byte == b'\n') {
        let trimmed = text.trim_ascii_end();
        // The mark, and the line below it if it is one of ours.
        if trimmed == MARK.as_bytes() {
            ours = true;
            continue;
        }
        if std::mem::take(&mut ours) && trimmed.starts_with(PATTERN.as_bytes()) {
            continue;
        }
        after.extend(text);
    }
    if let Some(line) = line {
        if !after.is_empty() && !after.ends_with(b"\n") {
            after.push(b'\n');
        }
        after.extend(format!("{MARK}\n{line}\n").bytes());
    }
    if after == before {
        return Ok(());
    }
    if after.is_empty() {
        return std::fs::remove_file(path).map_err(wrong);
    }
    if let Some(folder) = path.parent().filter(|folder| !folder.as_os_str().is_empty()) {
        std::fs::create_dir_all(folder).map_err(wrong)?;
    }
    std::fs::write(path, after).map_err(wrong)
}

/// The text git shows for a project. A file that is none must not stop `git log`: the text says so.
pub fn textconv(arguments: &TextconvArguments) -> Result<Outcome, Error> {
    let path = &arguments.file;
    if arguments.form.is_some_and(|form| form != listing::FORM) {
        eprintln!("rungs: this text has another form than git was set up for: run `rungs git-setup` again");
    }
    let text = match open(path, mode(false)) {
        Ok(project) => listing::whole(&project),
        // Git hands over an empty file where there is none.
        Err(_) if read_file(path, 0).is_ok() => String::new(),
        Err(why) => {
            let size = std::fs::metadata(path).map(|data| data.len()).unwrap_or(0);
            format!("NOT READABLE: {why} ({size} bytes)\n")
        }
    };
    std::io::stdout().write_all(printable(&text).as_bytes())?;
    Ok(Outcome::Done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attributes_of_others_stay_as_they_are() {
        let folder = std::env::temp_dir().join(format!("rungs-attributes-{}", std::process::id()));
        let path = folder.join("x y").join("attributes");
        let read = || std::fs::read_to_string(&path).unwrap_or_default();
        write_attributes(&path, Some("*.[Rr][Ss][Ss] -text diff=rungs merge=rungs")).expect("writes");
        write_attributes(&path, Some("*.[Rr][Ss][Ss] -text diff=rungs")).expect("writes");
        assert_eq!(read(), format!("{MARK}\n*.[Rr][Ss][Ss] -text diff=rungs\n"));
        write_attributes(&path, None).expect("writes");
        assert!(!path.exists());
        std::fs::write(&path, "*.pdf binary\n*.[Rr][Ss][Ss] mine\nlast").expect("writes");
        write_attributes(&path, Some("*.[Rr][Ss][Ss] -text diff=rungs")).expect("writes");
        assert!(read().starts_with("*.pdf binary\n*.[Rr][Ss][Ss] mine\nlast\n#"), "{}", read());
        write_attributes(&path, None).expect("writes");
        assert_eq!(read(), "*.pdf binary\n*.[Rr][Ss][Ss] mine\nlast\n");
        let _ = std::fs::remove_dir_all(&folder);
    }

    #[test]
    fn a_shell_takes_the_path_as_one_word() {
        assert_eq!(quoted("/a b/it's $(x)/rungs"), r"'/a b/it'\''s $(x)/rungs'");
    }
}
