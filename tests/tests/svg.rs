//! Every rung as SVG: nothing lies over anything else, nothing is cut off, every address can be searched.

use std::collections::HashSet;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::{Path, PathBuf};

use convert::AnyProject;
use ladder::{Documentation, Image};
use render::Style;
use render::scene::{Role, Scene, Shape};
use rungs_tests::corpus;
use rungs_tests::svg_boxes::check;

/// Columns: the narrowest drawing, and a page.
const WIDTHS: [usize; 2] = [render::MIN_WIDTH, 120];

#[derive(Default)]
struct Account {
    rungs: usize,
    drawings: usize,
    texts: usize,
    faults: Vec<String>,
    /// Equal rungs of other saves need no second look.
    seen: HashSet<u64>,
}

impl Account {
    fn look(&mut self, name: &str, scene: &Scene) {
        let mut hasher = DefaultHasher::new();
        for item in &scene.items {
            // Numbers of rungs differ where one was inserted before.
            match &item.shape {
                Shape::Text(Role::RungNumber, text) => text.len().hash(&mut hasher),
                _ => item.hash(&mut hasher),
            }
        }
        if !self.seen.insert(hasher.finish()) {
            return;
        }
        self.drawings += 1;
        let (texts, faults) = faults(scene);
        self.texts += texts;
        self.faults.extend(faults.iter().take(3).map(|fault| format!("{name}: {fault}")));
    }

    fn image(&mut self, name: &str, image: &Image, documentation: &Documentation) {
        for file in image.ladder_files() {
            for index in 0..file.rungs.len() {
                self.rungs += 1;
                for width in WIDTHS {
                    let style = Style { state: true, ..Style::graphic(width) };
                    let scene = render::scene(image, file, index, documentation, &style);
                    self.look(&format!("{name} {}:{index} in {width} columns", file.number), &scene);
                }
            }
        }
    }

    fn project(&mut self, name: &str, bytes: &[u8]) {
        match convert::open_any(bytes, name, rss::Mode::Permissive) {
            Ok(AnyProject::Rslogix(project)) => {
                let documentation = &project.main.documentation;
                for image in [Some(&project.main), project.online.as_ref()].into_iter().flatten() {
                    self.image(name, image, documentation);
                }
                if let Some(autosave) = &project.autosave {
                    self.image(name, autosave, &autosave.documentation);
                }
            }
            Ok(AnyProject::Domore(document)) => {
                let documentation = domore::documentation::Documentation::new(&document.project);
                for block in document.project.code_blocks() {
                    for index in 0..block.rungs.len() {
                        self.rungs += 1;
                        for width in WIDTHS {
                            let scene = render::domore::scene(block, index, &documentation, &Style::graphic(width));
                            self.look(&format!("{name} {} {index} in {width} columns", block.name), &scene);
                        }
                    }
                }
            }
            Err(_) => {}
        }
    }

    fn print(&self) {
        println!("{} rungs, {} different drawings, {} texts", self.rungs, self.drawings, self.texts);
    }
}

/// Texts of a scene, and what is wrong with its drawing.
fn faults(scene: &Scene) -> (usize, Vec<String>) {
    let svg = render::svg::drawing(scene, &render::svg::Options { standalone: true, ..Default::default() });
    let mut outcome = check(&svg);
    let wide = format!(" width=\"{}\" ", scene.width * render::figure::CELL_WIDTH);
    if !svg.contains(&wide) {
        outcome.faults.push("wider than asked for".into());
    }
    (outcome.texts, outcome.faults)
}

/// Draws every rung of these projects.
fn look_at(account: &mut Account, root: &Path, ending: &str) {
    for path in corpus::files(root, ending).expect("a folder can be listed") {
        let bytes = std::fs::read(&path).expect("a project can be read");
        account.project(&corpus::name(root, &path), &bytes);
    }
}

fn done(account: &Account) {
    account.print();
    let faults = &account.faults;
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults[..faults.len().min(40)].join("\n"));
}

#[test]
fn no_drawing_of_the_corpus_overlaps_or_is_cut_off() {
    let Some(root) = corpus::root() else { return };
    let mut account = Account::default();
    look_at(&mut account, &root, ".rss");
    assert!(account.rungs > 1000 && account.drawings > 1000, "a corpus without rungs");
    done(&account);
}

fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples")
}

#[test]
fn no_drawing_of_the_examples_overlaps_or_is_cut_off() {
    let mut account = Account::default();
    for ending in [".rss", ".slc", ".txt"] {
        look_at(&mut account, &examples(), ending);
    }
    assert!(account.rungs > 50, "{} rungs", account.rungs);
    done(&account);
}

/// Whatever is moved out of its place must be noticed: otherwise the tests above say nothing.
#[test]
fn scenes_with_anything_out_of_place_are_noticed() {
    let bytes = std::fs::read(examples().join("motor/motor.RSS")).expect("an example");
    let project = convert::open(&bytes, "motor.RSS", rss::Mode::Strict).expect("a sound example");
    let file = project.main.ladder_files().next().expect("a ladder file");
    let draw = |index| render::scene(&project.main, file, index, &project.main.documentation, &Style::graphic(80));
    let scenes: Vec<Scene> = (0..file.rungs.len()).map(draw).collect();
    let mut kinds = HashSet::new();
    for (scene, index, item) in
        scenes.iter().flat_map(|s| s.items.iter().enumerate().map(move |(i, item)| (s, i, item)))
    {
        let moves: &[(isize, isize)] = match &item.shape {
            // Onto the line or text below or above it.
            Shape::Text(Role::Address | Role::Operand, _) => &[(0, 1)],
            Shape::Contact { .. } => &[(0, -1), (-3, 0)],
            Shape::Coil(_) => &[(-3, 0)],
            Shape::Frame { .. } => &[(-3, 0), (0, 1), (2, 0)],
            _ => continue,
        };
        kinds.insert(std::mem::discriminant(&item.shape));
        for (x, y) in moves {
            let mut broken = scene.clone();
            let item = &mut broken.items[index];
            item.x = item.x.saturating_add_signed(*x);
            item.y = item.y.saturating_add_signed(*y);
            assert!(!faults(&broken).1.is_empty(), "not noticed: {:?} moved by {x}, {y}", scene.items[index]);
        }
    }
    assert!(kinds.len() >= 4, "too few shapes to say anything");
    // A text that goes on, a drawing cut off, and another one over it.
    let text = |x: usize, y: usize, text: &str| {
        let mut broken = scenes[0].clone();
        let mut item = broken.items[0].clone();
        (item.x, item.y, item.shape) = (x, y, Shape::Text(Role::Note, text.to_owned()));
        broken.items.push(item);
        faults(&broken).1
    };
    assert!(text(30, 0, &"too long ".repeat(20)).contains(&"wider than asked for".to_owned()));
    assert!(!text(30, scenes[0].height, "below the drawing").is_empty());
    assert!(!text(2, 0, "through the rail").is_empty());
}
