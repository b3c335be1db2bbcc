//! Projects in git as a user has them: diff, log and merges of a real repository, and histories as one.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use ladder::{Address, AddressEntry, FileType, Operand, Project, Source, Target};
use rss::Mode;

/// A folder of its own for each test, which is its user's home too.
struct Repository {
    home: PathBuf,
    top: PathBuf,
}

impl Repository {
    fn new(name: &str) -> Repository {
        let home = Path::new(env!("CARGO_TARGET_TMPDIR")).join("git").join(name);
        let _ = std::fs::remove_dir_all(&home);
        let top = home.join("plant saves");
        std::fs::create_dir_all(&top).expect("a folder");
        let repository = Repository { home, top };
        repository.git(&["init", "--quiet", "--initial-branch", "main"], 0);
        repository.git(&["config", "user.name", "tester"], 0);
        repository.git(&["config", "user.email", "tester@example.invalid"], 0);
        repository
    }

    fn start(&self, program: &str) -> Command {
        let mut command = Command::new(program);
        command.current_dir(&self.top).env("HOME", &self.home).env("XDG_CONFIG_HOME", self.home.join("config"));
        command.env("GIT_CONFIG_NOSYSTEM", "1").env("GIT_PAGER", "cat").env_remove("GIT_DIR");
        command
    }

    fn git(&self, arguments: &[&str], code: i32) -> String {
        output(self.start("git").args(arguments), code)
    }

    fn rungs(&self, arguments: &[&str], code: i32) -> String {
        output(self.start(env!("CARGO_BIN_EXE_rungs")).args(arguments), code)
    }

    fn save(&self, name: &str, project: &Project) {
        let built = convert::to_rss::project_file(project).expect("builds");
        std::fs::write(self.top.join(name), built.file.write().expect("writes")).expect("a file");
    }

    fn open(&self, name: &str) -> Project {
        let bytes = std::fs::read(self.top.join(name)).expect("a file");
        convert::from_rss::project(&rss::Project::read(&bytes, Mode::Strict).expect("reads"), Source::default())
    }

    fn commit(&self, message: &str) {
        self.git(&["add", "--all"], 0);
        self.git(&["commit", "--quiet", "-m", message], 0);
    }
}

fn output(command: &mut Command, code: i32) -> String {
    let Output { status, stdout, stderr } = command.output().expect("the command starts");
    let (stdout, stderr) = (String::from_utf8_lossy(&stdout).into_owned(), String::from_utf8_lossy(&stderr));
    assert_eq!(status.code(), Some(code), "{command:?}\n{stdout}\n{stderr}");
    stdout
}

fn motor() -> Project {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/motor/motor.RSS");
    convert::open(&std::fs::read(path).expect("the example"), "motor.RSS", Mode::Strict).expect("reads")
}

/// Another address for the first operand of a rung of the main program.
fn change(project: &mut Project, rung: usize, address: &str) {
    let file = project.main.program_files.iter_mut().find(|file| file.number == 2).expect("the main program");
    let ladder::Element::Instruction(first) = &mut file.rungs[rung].series[0] else { panic!("an instruction first") };
    first.operands[0] = Operand::Address(Address::parse(address).expect("an address"));
}

fn name_it(project: &mut Project, address: &str, symbol: &str) {
    let target = Target::Address(Address::parse(address).expect("an address"));
    project.main.documentation.add(AddressEntry { target, symbol: symbol.to_owned(), description: Vec::new() });
}

fn text_of(project: &Project, rung: usize) -> String {
    convert::slc::rung::rung_text(&project.main.program_file(2).expect("the main program").rungs[rung])
}

/// A name that a careless shell line or format would take apart.
const NAME: &str = "it's a \"pump\" $(touch broken) %A; #2.RSS";

#[test]
fn diff_and_log_show_rungs_whatever_the_file_is_called() {
    let repository = Repository::new("diff");
    repository.rungs(&["git-setup"], 0);
    let mut project = motor();
    repository.save(NAME, &project);
    repository.commit("first");
    change(&mut project, 2, "B3:0/5");
    name_it(&mut project, "B3:0/5", "NEW_CONDITION");
    let timers = project.main.data_files.iter_mut().find(|file| file.file_type == FileType::T).expect("timers");
    timers.words[1] = 77;
    repository.save(NAME, &project);
    for found in [repository.git(&["diff"], 0), {
        repository.commit("second");
        repository.git(&["log", "-p", "-1"], 0)
    }] {
        assert!(found.contains("\n-SOR XIC T4:0/TT OTE O:0.0/1 EOR\n+SOR XIC B3:0/5 OTE O:0.0/1 EOR\n"), "{found}");
        assert!(found.contains("\n+B3:0/5,NEW_CONDITION,"), "{found}");
        assert!(found.contains("PRE 77"), "{found}");
        assert!(!found.contains("Binary files"), "{found}");
    }
    assert!(!repository.top.join("broken").exists());
    // A file that is no project must not stop the log.
    std::fs::write(repository.top.join("x.rss"), "nothing").expect("a file");
    repository.commit("third");
    assert!(repository.git(&["log", "-p", "-1"], 0).contains("+NOT READABLE: "));
}

#[test]
fn setting_up_twice_is_setting_up_once_and_removing_leaves_nothing() {
    let repository = Repository::new("setup");
    std::fs::write(repository.top.join(".gitattributes"), "*.pdf binary\n").expect("a file");
    let config = || std::fs::read_to_string(repository.top.join(".git/config")).expect("the settings");
    let attributes = || std::fs::read_to_string(repository.top.join(".gitattributes")).expect("the attributes");
    let before = config();
    repository.rungs(&["git-setup", "--merge"], 0);
    let first = (config(), attributes());
    assert!(first.1.contains("diff=rungs merge=rungs"), "{}", first.1);
    repository.rungs(&["git-setup", "--merge"], 0);
    assert_eq!((config(), attributes()), first);
    repository.rungs(&["git-setup"], 0);
    assert!(!attributes().contains("merge=rungs") && !config().contains("merge-driver"));
    repository.rungs(&["git-setup", "--remove"], 0);
    assert_eq!((config(), attributes()), (before, "*.pdf binary\n".to_owned()));
    repository.rungs(&["git-setup", "--global", "--merge"], 0);
    let global = repository.home.join("config/git/attributes");
    assert!(std::fs::read_to_string(&global).expect("the attributes").contains("merge=rungs"));
    repository.rungs(&["git-setup", "--global", "--remove"], 0);
    assert!(!global.exists());
    let outside = Repository { home: repository.home.clone(), top: std::env::temp_dir() };
    outside.rungs(&["git-setup"], 2);
}

/// A repository with the motor program and two branches that changed it.
fn branches(name: &str, ours: impl Fn(&mut Project), theirs: impl Fn(&mut Project)) -> Repository {
    let repository = Repository::new(name);
    repository.rungs(&["git-setup", "--merge"], 0);
    let base = motor();
    repository.save(NAME, &base);
    repository.commit("base");
    repository.git(&["checkout", "--quiet", "-b", "theirs"], 0);
    let mut changed = base.clone();
    theirs(&mut changed);
    repository.save(NAME, &changed);
    repository.commit("theirs");
    repository.git(&["checkout", "--quiet", "main"], 0);
    let mut changed = base;
    ours(&mut changed);
    repository.save(NAME, &changed);
    repository.commit("ours");
    repository
}

#[test]
fn changes_of_different_rungs_merge_into_a_project() {
    let repository = branches(
        "merge",
        |ours| {
            change(ours, 2, "B3:0/5");
            name_it(ours, "B3:0/5", "OF_OURS");
        },
        |theirs| {
            change(theirs, 3, "B3:0/6");
            let main = theirs.main.program_files.iter_mut().find(|file| file.number == 2).expect("a file");
            let rung = main.rungs[1].clone();
            main.rungs.insert(5, rung);
            let comment = main.rungs[0].comment.as_mut().expect("a comment");
            comment.text = "Changed by theirs".to_owned();
            name_it(theirs, "B3:0/6", "OF_THEIRS");
        },
    );
    repository.git(&["merge", "--quiet", "-m", "merged", "theirs"], 0);
    assert_eq!(repository.git(&["status", "--porcelain"], 0), "");
    let merged = repository.open(NAME);
    assert_eq!(text_of(&merged, 2), "XIC B3:0/5 OTE O:0.0/1");
    assert_eq!(text_of(&merged, 3), "XIC B3:0/6 OTE O:0.0/0");
    assert_eq!(text_of(&merged, 5), text_of(&merged, 1));
    let main = merged.main.program_file(2).expect("the main program");
    assert_eq!(main.rungs[0].comment.as_ref().map(|comment| comment.text.as_str()), Some("Changed by theirs"));
    for symbol in ["OF_OURS", "OF_THEIRS"] {
        assert!(merged.main.documentation.by_symbol(symbol).is_some(), "{symbol}");
    }
    // What was never touched is as it was, and the code agrees with the operands.
    let shown = repository.rungs(&["verify", NAME], 0);
    assert!(shown.contains("differs for 0"), "{shown}");
    let parents = repository.git(&["log", "-1", "--format=%P"], 0);
    assert_eq!(parents.split_whitespace().count(), 2);
}

#[test]
fn a_rung_changed_on_both_sides_stays_for_a_person() {
    let repository = branches(
        "conflict",
        |ours| change(ours, 2, "B3:0/5"),
        |theirs| {
            change(theirs, 2, "B3:0/6");
            change(theirs, 3, "B3:0/7");
        },
    );
    let before = std::fs::read(repository.top.join(NAME)).expect("ours");
    repository.git(&["merge", "--quiet", "theirs"], 1);
    assert!(repository.git(&["status", "--porcelain"], 0).contains("UU "));
    assert_eq!(std::fs::read(repository.top.join(NAME)).expect("ours"), before);
    let text = std::fs::read_to_string(repository.top.join(format!("{NAME}.conflict.slc"))).expect("the conflict");
    let expected = "<<<<<<< ours\n% Rung 2:2 %\nSOR XIC B3:0/5 OTE O:0.0/1 EOR\n\
                    ||||||| base\n% Rung 2:2 %\nSOR XIC T4:0/TT OTE O:0.0/1 EOR\n\
                    =======\n% Rung 2:2 %\nSOR XIC B3:0/6 OTE O:0.0/1 EOR\n>>>>>>> theirs\n\n\
                    % The contactor";
    assert!(text.contains(expected), "{text}");
    // What does not conflict is merged in the text.
    assert!(text.contains("SOR XIC B3:0/7 OTE O:0.0/0 EOR"), "{text}");
    repository.git(&["merge", "--abort"], 0);
}

#[test]
fn what_cannot_be_merged_whole_stays_ours() {
    let repository = branches("broken", |ours| change(ours, 2, "B3:0/5"), |theirs| change(theirs, 3, "B3:0/6"));
    for (name, bytes) in [("base", &b""[..]), ("theirs", b"no project")] {
        std::fs::write(repository.top.join(name), bytes).expect("a file");
    }
    let before = std::fs::read(repository.top.join(NAME)).expect("ours");
    repository.rungs(&["merge-driver", "base", NAME, NAME, "x.RSS"], 1);
    repository.rungs(&["merge-driver", NAME, NAME, "theirs", "x.RSS"], 1);
    assert_eq!(std::fs::read(repository.top.join(NAME)).expect("ours"), before);
}

#[test]
fn a_history_is_the_same_repository_everywhere() {
    let repository = Repository::new("history");
    let archive = repository.top.join("archive");
    std::fs::create_dir_all(&archive).expect("a folder");
    let mut project = motor();
    // Names that must stay what they are: text.
    project.main.processor.project_name = "../\u{1B}[31m".to_owned();
    let main = project.main.program_files.iter_mut().find(|file| file.number == 2).expect("the main program");
    main.name = "../../x\u{1B}".to_owned();
    name_it(&mut project, "B3:0/9", "EVIL\u{1B}[2J");
    repository.save("archive/pump_BAK001.RSS", &project);
    change(&mut project, 2, "B3:0/5");
    repository.save("archive/pump.RSS", &project);
    repository.save("archive/pump - Copy.RSS", &project);
    let mut heads = Vec::new();
    for target in ["one", "two"] {
        repository.rungs(&["history", "archive", "--to-git", target], 0);
        let top = repository.top.join(target);
        let other = Repository { home: repository.home.clone(), top };
        heads.push(other.git(&["rev-parse", "HEAD"], 0));
        assert_eq!(other.git(&["status", "--porcelain"], 0), "");
        other.git(&["fsck", "--strict"], 0);
        let log = other.git(&["log", "-p"], 0);
        assert!(!log.contains(['\u{9B}', '\u{1B}']), "{log}");
        assert!(log.contains("1 rung changed (pump)"), "{log}");
        assert!(log.contains("Same bytes: pump - Copy.RSS"), "{log}");
        assert!(log.contains("EVIL\\x1B[2J"), "{log}");
        assert_eq!(other.git(&["rev-list", "--count", "HEAD"], 0), "2\n");
        let files = other.git(&["ls-files"], 0);
        assert!(files.contains("pump/program/002 .._.._x_.slc"), "{files}");
        let blame = other.git(&["blame", "pump/program/002 .._.._x_.slc"], 0);
        assert!(blame.contains("SOR XIC B3:0/5 OTE O:0.0/1 EOR"), "{blame}");
    }
    assert_eq!(heads[0], heads[1]);
    let shown = repository.rungs(&["history", "archive", "--to-git", "one"], 2);
    assert!(!shown.contains("commits"), "{shown}");
    let text = repository.rungs(&["history", "archive", "--full"], 0);
    assert!(!text.contains(['\u{9B}', '\u{1B}']), "{text}");
    assert!(text.contains("3 files: 1 machine, 2 saves, 1 copy of the same bytes"), "{text}");
    assert!(text.contains("file 2 rung 2 changed: XIC, operand 1: T4:0/TT -> B3:0/5"), "{text}");
    let json = repository.rungs(&["history", "archive", "--json"], 0);
    let document: serde_json::Value = serde_json::from_str(&json).expect("one document");
    assert_eq!(document["saves"][1]["same_bytes"].as_array().map(Vec::len), Some(1));
    assert_eq!(document["saves"][1]["changes"]["logic"][0]["kind"], "changed");
}

#[test]
fn texts_of_a_history_are_rung_text() {
    let repository = Repository::new("texts");
    std::fs::create_dir_all(repository.top.join("archive")).expect("a folder");
    let project = motor();
    repository.save("archive/motor.RSS", &project);
    repository.rungs(&["history", "archive", "--to-git", "out"], 0);
    let text =
        std::fs::read_to_string(repository.top.join("out/motor/program/002 MAIN.slc")).expect("the main program");
    let (head, _) = include_str!("../../../examples/motor/motor.SLC").split_once("LADDER 2").expect("a ladder");
    let whole = format!("{head}LADDER 2\n{text}");
    let back = convert::open(whole.as_bytes(), "x.SLC", Mode::Permissive).expect("reads");
    let (a, b) = (project.main.program_file(2).expect("a file"), back.main.program_file(2).expect("a file"));
    assert_eq!(a.rungs.len(), b.rungs.len());
}
