//! Reports in a real browser: search, links and Back, folding, keys, three widths, hostile texts.

use std::path::{Path, PathBuf};

use report::{Options, Source};
use rungs_tests::axe;
use rungs_tests::browser::{Browser, key};
use rungs_tests::corpus;

fn open(path: &Path) -> ladder::Project {
    let bytes = std::fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    convert::open(&bytes, &name, rss::Mode::Permissive).unwrap_or_else(|error| panic!("{name}: {error}"))
}

fn example(name: &str) -> ladder::Project {
    open(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples").join(name))
}

/// The page of a project, in a file of its own.
fn page(project: &ladder::Project, name: &str) -> PathBuf {
    let document = report::project(&Source::of(project), &Options::default());
    let mut bytes = Vec::new();
    report::html::page(&document, &mut bytes).expect("a vector takes all");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join(format!("{name}.html"));
    std::fs::write(&path, bytes).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    path
}

/// What stands at the top of the window below the bar, as the id of the place that was jumped to.
const IN_SIGHT: &str = "(id => { const r = document.getElementById(id).getBoundingClientRect(); \
                        return r.top >= 0 && r.top < innerHeight * 0.7 })";

fn assert_in_sight(browser: &Browser, id: &str) {
    browser.wait_for(&format!("{IN_SIGHT}({id:?})"));
}

#[test]
fn search_follow_and_back() {
    let Some(browser) = Browser::start() else { return };
    browser.open(&page(&example("motor/motor.RSS"), "motor"));
    assert_eq!(browser.text("header h1"), "motor.RSS");
    // From an address to its cross reference entry.
    browser.keys("/");
    browser.wait_for("document.activeElement.id === 'search'");
    browser.keys("o:0/1");
    browser.wait_for("document.querySelectorAll('#found li').length > 1");
    assert_eq!(browser.text("#found li b"), "O:0.0/1", "{}", browser.text("#found ol"));
    browser.keys(key::ENTER);
    browser.wait_for("location.hash === '#x-O:0.0/1'");
    let entry = browser.run("return location.hash.slice(1)").as_str().unwrap_or_default().to_owned();
    assert_in_sight(&browser, &entry);
    // From there to a rung.
    browser.click(":target td a[href^='#r-']");
    browser.wait_for("location.hash.startsWith('#r-2-')");
    let rung = browser.run("return location.hash.slice(1)").as_str().unwrap_or_default().to_owned();
    assert_in_sight(&browser, &rung);
    // And back.
    browser.back();
    browser.wait_for(&format!("location.hash === {:?}", format!("#{entry}")));
    assert_in_sight(&browser, &entry);
    // An address in a drawing leads to its entry.
    browser.run(&format!("location.hash = {rung:?}"));
    assert_in_sight(&browser, &rung);
    browser.click(&format!("#{rung} svg a[href^='#x-']"));
    browser.wait_for("location.hash.startsWith('#x-')");
    let from_drawing = browser.run("return location.hash.slice(1)").as_str().unwrap_or_default().to_owned();
    assert_in_sight(&browser, &from_drawing);
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn search_finds_symbols_comments_and_texts() {
    let Some(browser) = Browser::start() else { return };
    let project = example("motor/motor.RSS");
    browser.open(&page(&project, "motor_search"));
    let entry = project.main.documentation.entries().iter().find(|entry| !entry.symbol.is_empty()).expect("a symbol");
    let comment = project.main.ladder_files().flat_map(|file| &file.rungs).find_map(|rung| rung.comment.as_ref());
    let words: Vec<&str> = comment.expect("a comment").text.split_whitespace().take(3).collect();
    for (query, expected) in [
        (entry.symbol.to_lowercase(), entry.target.to_string()),
        (words.join(" "), "2:".to_owned()),
        ("sha-256".to_owned(), "SHA-256".to_owned()),
    ] {
        browser.keys(key::ESCAPE);
        browser.keys(key::ESCAPE);
        browser.keys("/");
        browser.keys(&query);
        browser.wait_for("document.querySelectorAll('#found li').length > 0");
        std::thread::sleep(std::time::Duration::from_millis(120));
        let found = browser.text("#found ol");
        assert!(found.contains(&expected), "{query}: {found}");
    }
    browser.keys(key::ESCAPE);
    browser.keys("/");
    browser.keys("zzz-nothing-has-this");
    browser.wait_for("document.querySelector('#found p').textContent === 'nothing found'");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn keys_fold_theme_and_help() {
    let Some(browser) = Browser::start() else { return };
    browser.open(&page(&example("batch/batch.RSS"), "batch"));
    let open = "document.querySelectorAll('section > details[open]').length";
    let all = browser.number("document.querySelectorAll('section > details').length");
    assert!((browser.number(open) - all).abs() < 0.5);
    // A folded file opens when a link leads into it.
    browser.keys("c");
    assert!(browser.number(open) < 0.5);
    browser.run("location.hash = '#r-2-1'");
    browser.wait_for("document.querySelector('#f-2 > details').open");
    assert_in_sight(&browser, "r-2-1");
    browser.keys("c");
    browser.keys("c");
    assert!((browser.number(open) - all).abs() < 0.5);
    browser.click("#f-2 summary");
    assert!(browser.is("!document.querySelector('#f-2 > details').open"));
    browser.click("#f-2 summary");
    // From rung to rung.
    browser.run("document.getElementById('f-2').scrollIntoView()");
    browser.keys("j");
    browser.wait_for("document.querySelector('.r.here')");
    let first = browser.run("return document.querySelector('.here').id");
    browser.keys("j");
    browser.wait_for(&format!("document.querySelector('.here').id !== {first}"));
    browser.keys("k");
    browser.wait_for(&format!("document.querySelector('.here').id === {first}"));
    // Help and theme.
    browser.keys("?");
    browser.wait_for("document.querySelector('#help').open");
    browser.keys(key::ESCAPE);
    browser.wait_for("!document.querySelector('#help').open");
    let back = "getComputedStyle(document.body).backgroundColor";
    let before = browser.run(&format!("return {back}"));
    browser.keys("t");
    browser.wait_for(&format!("{back} !== {before}"));
    browser.run("document.getElementById('f-2').scrollIntoView()");
    let _ = browser.screenshot("report_dark");
    // Arrows choose among what was found.
    browser.keys("/");
    browser.keys("timer");
    browser.wait_for("document.querySelectorAll('#found li').length > 2");
    browser.keys(key::DOWN);
    browser.wait_for("document.querySelectorAll('#found li')[1].ariaSelected === 'true'");
    browser.keys(key::UP);
    browser.wait_for("document.querySelectorAll('#found li')[0].ariaSelected === 'true'");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn usable_at_three_widths() {
    let Some(browser) = Browser::start() else { return };
    browser.open(&page(&example("traffic_light/traffic_light.RSS"), "traffic_light"));
    for (name, width, height) in [("wide", 1400, 900), ("medium", 820, 1000), ("narrow", 500, 900)] {
        browser.resize(width, height);
        for (part, place) in
            [("top", "processor"), ("ladder", "r-2-0"), ("data", "d-B3"), ("xref", "xref"), ("timers", "timers")]
        {
            browser.run(&format!("location.hash = ''; location.hash = '#{place}'"));
            browser.run("return new Promise(done => requestAnimationFrame(() => requestAnimationFrame(done)))");
            let _ = browser.screenshot(&format!("report_{name}_{part}"));
        }
        // Wide things scroll in themselves, the page does not.
        let over = browser.number("document.documentElement.scrollWidth - document.documentElement.clientWidth");
        assert!(over < 1.5, "{name}: {over} pixels too wide");
        assert!(browser.is("document.querySelector('#search').getBoundingClientRect().width > 150"), "{name}");
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn texts_of_a_project_stay_texts() {
    let Some(browser) = Browser::start() else { return };
    let hostile = [
        "<script>document.title='BROKEN'</script>",
        "\"onload=\"document.title='BROKEN'",
        "'><img src=x onerror=document.title='BROKEN'>",
        "</svg></style></title></pre></details><b class=broken>",
        "\u{1B}[2J\u{1B}]0;BROKEN\u{7}\u{9B}31m",
        "../../../etc/passwd",
        "javascript:alert(1)",
        "&lt;b class=broken&gt; &#60;i&#62;",
        "{{constructor}} ${document.title='BROKEN'}",
    ];
    let long = "long words ".repeat(300);
    let mut project = example("motor/motor.RSS");
    project.source.file = format!("{}.RSS", hostile[0]);
    project.main.processor.project_name = hostile[2].into();
    let image = &mut project.main;
    for (file, text) in image.program_files.iter_mut().zip(hostile.iter().cycle()) {
        file.name = (*text).into();
        file.description = hostile[3].into();
    }
    for (file, text) in image.data_files.iter_mut().zip(hostile.iter().cycle().skip(1)) {
        file.name = (*text).into();
        file.description = (*text).into();
    }
    let texts: Vec<&str> = hostile.iter().copied().chain([long.as_str()]).collect();
    let rungs = image.program_files.iter_mut().flat_map(|file| &mut file.rungs);
    for (number, rung) in rungs.enumerate() {
        rung.comment = Some(ladder::Comment {
            text: texts[number % texts.len()].to_owned(),
            title: hostile[number % hostile.len()].to_owned(),
            owner: ladder::CommentOwner::Rung { file: 2, rung: 0 },
        });
    }
    let mut documentation = ladder::Documentation::default();
    for (number, entry) in image.documentation.entries().iter().enumerate() {
        let (symbol, line) = (hostile[number % hostile.len()], hostile[(number + 4) % hostile.len()]);
        documentation.add(ladder::AddressEntry {
            target: entry.target.clone(),
            symbol: symbol.to_owned(),
            description: vec![line.to_owned()],
        });
    }
    documentation.add(ladder::AddressEntry {
        target: ladder::Target::Other(hostile[1].to_owned()),
        symbol: hostile[2].to_owned(),
        description: vec![long.clone()],
    });
    image.documentation = documentation;
    project.diagnostics.push(ladder::Diagnostic {
        severity: ladder::Severity::Warning,
        place: hostile[0].into(),
        message: hostile[4].into(),
    });
    browser.open(&page(&project, "hostile"));
    // Everything is there to be read, and nothing of it became part of the page.
    let text = browser.run("return document.querySelector('main').textContent");
    let text = text.as_str().unwrap_or_default();
    for it in hostile.iter().filter(|it| !it.contains('\u{1B}')) {
        assert!(text.contains(it), "{it} is not to be read");
    }
    assert!(text.contains("\\x1B[2J"), "control characters are spelled out");
    assert!(
        browser.number(
            "document.querySelectorAll('main script, img, .broken, main style, main title:not(svg title)').length"
        ) < 0.5
    );
    assert!(browser.number("document.scripts.length - 1").abs() < 0.5);
    let handlers =
        "[...document.querySelectorAll('*')].filter(e => [...e.attributes].some(a => a.name.startsWith('on'))).length";
    assert!(browser.number(handlers) < 0.5);
    let links = "[...document.querySelectorAll('a')].filter(a => !a.getAttribute('href').startsWith('#')).length";
    assert!(browser.number(links) < 0.5, "every link stays in the page");
    assert!(browser.is("document.title.startsWith('<script>')"));
    // Not when it is found either.
    browser.keys("/");
    browser.keys("<script>");
    browser.wait_for("document.querySelectorAll('#found li').length > 0");
    assert!(browser.number("document.querySelectorAll('#found script, #found img').length") < 0.5);
    assert!(browser.is("!document.title.startsWith('BROKEN')"));
    assert_eq!(browser.complaints(), Vec::<String>::new());
    browser.keys(key::ESCAPE);
    let _ = browser.screenshot("report_hostile");
}

#[test]
fn a_large_project_opens_and_searches_fast() {
    let Some(root) = corpus::root() else { return };
    let Some(browser) = Browser::start() else { return };
    let path = page(&open(&root.join("acd/LANLOGIX_BR.RSS")), "lanlogix");
    let bytes = std::fs::metadata(&path).map(|it| it.len()).unwrap_or(u64::MAX);
    assert!(bytes <= 15_000_000, "{bytes} bytes");
    let start = std::time::Instant::now();
    browser.open(&path);
    browser.wait_for("document.querySelector('#f-6')");
    println!("LANLOGIX_BR: {bytes} bytes, opened in {} ms", start.elapsed().as_millis());
    let search = "const box = document.querySelector('#search'), start = performance.now(); box.focus(); box.value = ARG; \
                  box.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter'})); return performance.now() - start";
    // The first search makes the index. How long each takes is told, and asserted only so far that a loaded machine
    // does not fail and a search that hangs does.
    for query in ["b3:0/1", "t4:", "n7:0"] {
        let took = browser.run(&search.replace("ARG", &format!("{query:?}"))).as_f64().unwrap_or(f64::MAX);
        println!("LANLOGIX_BR: search {query} took {took:.0} ms");
        assert!(took < 20_000.0, "{query}: {took} ms");
    }
    browser.run("location.hash = '#r-6-40'");
    assert_in_sight(&browser, "r-6-40");
    let _ = browser.screenshot("report_lanlogix_6_40");
    browser.run("location.hash = '#r-30-5'");
    assert_in_sight(&browser, "r-30-5");
    let _ = browser.screenshot("report_lanlogix_30_5");
    browser.back();
    browser.wait_for("location.hash === '#r-6-40'");
    assert_in_sight(&browser, "r-6-40");
    assert_eq!(browser.complaints(), Vec::<String>::new());
}

#[test]
fn a_checker_of_accessibility_finds_nothing_serious() {
    let Some(browser) = Browser::start() else { return };
    let path = page(&example("motor/motor.RSS"), "motor_accessible");
    for (dark, theme) in [(false, "light"), (true, "dark")] {
        browser.dark(dark);
        browser.open(&path);
        axe::check_document(&browser, &format!("report, {theme}"));
    }
    assert_eq!(browser.complaints(), Vec::<String>::new());
}
