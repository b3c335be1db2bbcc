//! Pages of differences in a real browser: keys, links into folds, themes, three widths, hostile texts.

use std::path::{Path, PathBuf};

use analysis::diff::{self, Difference};
use ladder::{Comment, CommentOwner, Project};
use report::diff::{Comparison, Shown, Side};
use rungs_tests::axe;
use rungs_tests::browser::Browser;
use rungs_tests::corpus;

fn open(path: &Path) -> Project {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    convert::open(&bytes, &name, rss::Mode::Permissive).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn example(name: &str) -> Project {
    open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples").join(name))
}

fn side(project: &Project) -> diff::Side<'_> {
    diff::Side { image: &project.main, documentation: Some(&project.main.documentation) }
}

fn compare(old: &Project, new: &Project) -> Difference {
    diff::compare(side(old), side(new))
}

/// The page of two projects, in a file of its own.
fn page(old: &Project, new: &Project, name: &str) -> PathBuf {
    let sides = (Side::rslogix(&old.main, &old.main.documentation), Side::rslogix(&new.main, &new.main.documentation));
    let difference = compare(old, new);
    let comparison = Comparison {
        names: ("plant/old.RSS", "plant/new.RSS"),
        sides: (&sides.0, &sides.1),
        difference: &difference,
        shown: Shown::default(),
        tool: "rungs",
        warnings: &[],
    };
    let mut bytes = Vec::new();
    report::diff::page(&comparison, &mut bytes).expect("a vector takes all");
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.html"));
    std::fs::write(&path, bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    path
}

/// The rung of index `from` of file 2 moved to `to`, an operand of another one changed.
fn edited(project: &Project, from: usize, to: usize, changed: usize) -> Project {
    let mut new = project.clone();
    let file = new.main.program_files.iter_mut().find(|file| file.number == 2).expect("file 2");
    if let Some(ladder::Element::Instruction(first)) =
        file.rungs.get_mut(changed).and_then(|rung| rung.series.first_mut())
    {
        first.operands = vec![ladder::Operand::parse("N7:99/7")];
    }
    let rung = file.rungs.remove(from);
    file.rungs.insert(to, rung);
    new
}

#[test]
fn keys_lead_from_change_to_change_and_links_open_folds() {
    let Some(browser) = Browser::start() else { return };
    let old = example("batch/batch.RSS");
    let count = old.main.program_files.iter().find(|file| file.number == 2).expect("file 2").rungs.len();
    let new = edited(&old, 0, count - 2, 1);
    browser.open(&page(&old, &new, "diff_batch"));
    assert_eq!(browser.text("header h1"), "old.RSS \u{2192} new.RSS");
    let stops = browser.number("document.querySelectorAll('.change').length");
    assert!(stops >= 2.0, "{stops} changes");
    browser.keys("n");
    browser.wait_for("document.querySelectorAll('.at').length === 1");
    assert_eq!(browser.text("#where"), format!("1 / {stops}"));
    browser.keys("n");
    assert_eq!(browser.text("#where"), format!("2 / {stops}"));
    browser.keys("p");
    assert_eq!(browser.text("#where"), format!("1 / {stops}"));
    assert!(
        browser
            .is("(r => r.top >= 0 && r.bottom <= innerHeight)(document.querySelector('.at').getBoundingClientRect())")
    );
    // From where a rung is to where it was, and back.
    browser.click(".moved h4 a");
    browser.wait_for("location.hash.startsWith('#l-2-')");
    browser.click(".left a");
    browser.wait_for("location.hash.startsWith('#c-2-')");
    // The changed contact is outlined on both sides.
    assert_eq!(browser.number("document.querySelectorAll('.pair .old g.changed').length"), 1.0);
    assert_eq!(browser.number("document.querySelectorAll('.pair .new g.changed').length"), 1.0);
    // Everything folded, then unfolded.
    browser.run("for (const fold of document.querySelectorAll('section > details')) fold.open = false");
    browser.run("location.hash = ''");
    browser.click(".sum a[href='#logic']");
    browser.keys("n");
    browser.wait_for("document.querySelector('.at').offsetParent !== null");
    browser.keys("u");
    assert!(browser.is("[...document.querySelectorAll('.same')].every(fold => fold.open)"));
    browser.keys("t");
    let dark = browser.run("return document.documentElement.dataset.theme");
    browser.keys("t");
    assert_ne!(browser.run("return document.documentElement.dataset.theme"), dark);
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn nothing_of_a_project_runs() {
    let Some(browser) = Browser::start() else { return };
    let hostile =
        "\"><script>window.broken = 1</script><img src=x onerror=\"window.broken = 2\"></svg><style>*{display:none}";
    let old = example("motor/motor.RSS");
    let mut new = edited(&old, 0, 1, 2);
    new.main.processor.project_name = hostile.to_owned();
    for file in &mut new.main.program_files {
        file.name = hostile.to_owned();
        for (number, rung) in (0..).zip(&mut file.rungs) {
            let owner = CommentOwner::Rung { file: file.number, rung: number };
            rung.comment = Some(Comment { text: hostile.repeat(30), title: hostile.to_owned(), owner });
        }
    }
    browser.open(&page(&old, &new, "diff_hostile"));
    browser.run("for (const fold of document.querySelectorAll('details')) fold.open = true");
    assert!(browser.is("window.broken === undefined && document.images.length === 0"));
    assert!(
        browser
            .is("document.querySelectorAll('script').length === 1 && document.querySelectorAll('style').length === 1")
    );
    assert!(browser.is("document.body.innerText.includes('<script>window.broken = 1</script>')"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

/// Two saves of one machine, as wide as a desk, a laptop and a telephone: nothing is cut off.
#[test]
fn three_widths_show_all() {
    let Some(browser) = Browser::start() else { return };
    let Some(root) = corpus::root() else { return };
    let save = |name: &str| open(&root.join("rslogix500").join(name));
    let (old, new) = (save("BLUE_BANNER_RESTACKER_OCT_2019_BAK004.RSS"), save("Blue_Banner_Restacker.RSS"));
    browser.open(&page(&old, &new, "diff_saves"));
    for (name, width) in [("desk", 1600), ("laptop", 1000), ("telephone", 500)] {
        browser.resize(width, 1000);
        assert!(browser.is("document.documentElement.scrollWidth <= innerWidth"), "{name}");
        let wide = "[...document.querySelectorAll('.draw')].filter(d => d.scrollWidth > d.clientWidth + 1).length";
        assert_eq!(browser.number(wide), 0.0, "{name}: drawings that are cut off");
        let beside = "(p => p.children[0].offsetTop === p.children[1].offsetTop)(document.querySelector('.pair'))";
        assert_eq!(browser.is(beside), width > 1100, "{name}");
        browser.screenshot(&format!("diff_{name}"));
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_checker_of_accessibility_finds_nothing_serious() {
    let Some(browser) = Browser::start() else { return };
    let old = example("batch/batch.RSS");
    let path = page(&old, &edited(&old, 0, 2, 1), "diff_accessible");
    for (dark, theme) in [(false, "light"), (true, "dark")] {
        browser.dark(dark);
        browser.open(&path);
        axe::check_document(&browser, &format!("difference, {theme}"));
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}
