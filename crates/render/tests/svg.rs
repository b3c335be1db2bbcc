//! Drawings as SVG: links, marks, power, state and forces; and no text of a project that becomes markup.

mod common;

use common::{commented, documentation, file, image, ins, legs};
use ladder::{DataFile, Documentation, Element, FileType, Force, Image, Rung};
use proptest::prelude::*;
use render::Style;
use render::scene::{Role, Scene, Shape};
use render::svg::{Change, Mark, Options, drawing};

fn scene(image: &Image, series: ladder::Series, documentation: &Documentation) -> Scene {
    let style = Style { state: true, ..Style::graphic(100) };
    render::scene(image, &file(vec![Rung::new(series)]), 0, documentation, &style)
}

fn texts(scene: &Scene, wanted: Role) -> Vec<&str> {
    let text = |item: &'_ render::scene::Item| matches!(&item.shape, Shape::Text(role, _) if *role == wanted);
    scene
        .items
        .iter()
        .filter(|item| text(item))
        .filter_map(|item| match &item.shape {
            Shape::Text(_, text) => Some(text.as_str()),
            _ => None,
        })
        .collect()
}

/// The group of an instruction in a drawing.
fn group(svg: &str, index: usize) -> &str {
    let at = svg.find(&format!("data-i=\"{index}\"")).expect("the instruction");
    let start = svg[..at].rfind("<g").expect("its group");
    let end = svg[at..].find("</g>").expect("its end");
    &svg[start..at + end]
}

/// Bits B3:0/0 and B3:0/3 are 1, N7:0 is 3; input 2 is forced on, output 1 forced off.
fn running() -> Image {
    let mut image = image();
    let mut bits = DataFile::new(FileType::B, 3, 2);
    bits.words = vec![0b1001, 0b10];
    let mut numbers = DataFile::new(FileType::N, 7, 2);
    numbers.words = vec![3, 17];
    let mut inputs = DataFile::new(FileType::I, 1, 1);
    inputs.forces = vec![Force { on: 0b100, off: 0xFFFF }];
    let mut outputs = DataFile::new(FileType::O, 0, 1);
    outputs.forces = vec![Force { on: 0, off: 0xFFFD }];
    image.data_files.extend([bits, numbers, inputs, outputs]);
    image
}

#[test]
fn every_operand_is_a_link_to_its_whole_address() {
    let documentation = documentation(&["T4:0|HORN_DELAY|Horn"]);
    let series = vec![
        ins("XIC", "I:0.0/2"),
        ins("EQU", "N7:0 5"),
        ins("CPT", "F8:0"),
        ins("COP", "#N7:0 #N7:1 2"),
        ins("TON", "T4:0 0.01 500 120"),
    ];
    let scene = scene(&running(), series, &documentation);
    let svg = drawing(&scene, &Options { href: &|address| Some(format!("#x{address}")), ..Options::default() });
    for address in ["I:0.0/2", "N7:0", "F8:0", "N7:1", "T4:0"] {
        assert!(svg.contains(&format!("<a href=\"#x{address}\">")), "{address} in {svg}");
    }
    assert!(svg.contains(">I:0.0/2</text>"), "a whole address that can be searched: {svg}");
    assert!(group(&svg, 4).contains("<title>TON T4:0 0.01 500 120, HORN_DELAY, Horn</title>"), "{svg}");
    assert_eq!(group(&svg, 4).matches("href=\"#xT4:0\"").count(), 2, "the operand and the symbol");
    let plain = drawing(&scene, &Options::default());
    assert!(!plain.contains("<a "));
}

#[test]
fn addresses_in_comments_are_links_where_they_lead_somewhere() {
    let rung = commented(vec![ins("OTE", "B3:0/1")], "Page of I:0/2", "See N7:5, not N7:6. (T4:0.acc) 12:30");
    let scene = render::scene(&image(), &file(vec![rung]), 0, &Documentation::default(), &Style::graphic(100));
    let href = |address: &str| (address != "N7:6").then(|| format!("#{address}"));
    let svg = drawing(&scene, &Options { href: &href, ..Options::default() });
    for link in ["<a href=\"#N7:5\">N7:5</a>, not N7:6.", "(<a href=\"#T4:0.ACC\">T4:0.acc</a>)", ">I:0/2</a>"] {
        assert!(svg.contains(link), "{link} in {svg}");
    }
    assert!(svg.contains(" 12:30</text>"), "a time is no address: {svg}");
}

#[test]
fn marks_are_classes_with_words_for_those_who_do_not_see_them() {
    let scene = scene(
        &image(),
        vec![ins("XIC", "B3:9/0"), ins("XIO", "B3:9/1"), ins("OTE", "B3:9/2")],
        &Documentation::default(),
    );
    let changes = [Change::Inserted, Change::Deleted, Change::Changed];
    let mark = |index: usize| Mark { change: changes.get(index).copied(), found: index == 2, ..Mark::default() };
    let svg = drawing(&scene, &Options { mark: &mark, id: "r5", ..Options::default() });
    assert!(
        group(&svg, 0).contains("class=\"i inserted\" data-i=\"0\" id=\"r5-0\"><title>inserted: XIC B3:9/0</title>"),
        "{svg}"
    );
    // Crossed out besides its outline.
    assert_eq!(group(&svg, 1).matches("class=\"outline\"").count(), 2, "{svg}");
    assert!(group(&svg, 2).contains("class=\"i changed found\""), "{svg}");
    assert!(!svg.contains(" style="), "no style attributes: {svg}");
}

#[test]
fn forces_and_states_of_the_project_show_in_both_media() {
    let image = running();
    let series = vec![
        ins("XIC", "I:0.0/2"),
        ins("XIC", "B3:0/0"),
        ins("XIO", "B3:0/0"),
        ins("XIC", "B3:0/[N7:0]"),
        ins("XIC", "B3:0/[N7:1]"),
        ins("OTU", "B3:0/3"),
        ins("OTE", "O:0.0/1"),
        ins("XIC", "B3:99/0"),
    ];
    let scene = scene(&image, series.clone(), &Documentation::default());
    let state: Vec<Option<bool>> = scene.instructions.iter().map(|spot| spot.state).collect();
    // The index 17 counts on into the next word; what the project does not hold is not known.
    let on = Some(true);
    assert_eq!(state, [Some(false), on, Some(false), on, on, on, Some(false), None]);
    let forced: Vec<Option<bool>> = scene.instructions.iter().map(|spot| spot.forced).collect();
    assert_eq!(forced, [on, None, None, None, None, None, Some(false), None]);
    assert_eq!(texts(&scene, Role::Force), ["force ON", "force OFF"]);
    let svg = drawing(&scene, &Options::default());
    assert!(group(&svg, 0).contains("class=\"i off forced-on\"") && group(&svg, 0).contains("(forced on)"), "{svg}");
    assert!(group(&svg, 1).contains("class=\"i on\""), "{svg}");
    assert!(!group(&svg, 7).contains("bar"), "nothing claimed about what is not known: {svg}");
    // A terminal may lack colour: words and a letter say it.
    let text = render::rung(
        &image,
        &file(vec![Rung::new(series)]),
        0,
        &Documentation::default(),
        &Style { state: true, ..Style::default() },
    );
    assert!(text.contains("force ON") && text.contains("force OFF"), "{text}");
    assert_eq!(text.split(|c: char| !c.is_alphanumeric()).filter(|word| *word == "T").count(), 4, "{text}");
}

#[test]
fn power_flows_through_branches() {
    // 0 and (1, or nothing, or 2 and 3) and 4: the empty leg is a wire.
    let branch = legs([vec![ins("XIC", "B3:0/1")], vec![ins("XIC", "B3:0/2"), ins("XIC", "B3:0/3")]]);
    let series = vec![ins("XIC", "B3:0/0"), branch, ins("OTE", "B3:0/4")];
    let scene = scene(&image(), series, &Documentation::default());
    let powered = |on: &[usize]| {
        let nodes = scene.powered(&|index| on.contains(&index));
        scene.instructions.iter().map(|spot| nodes[spot.enters]).collect::<Vec<bool>>()
    };
    assert_eq!(powered(&[]), [true, false, false, false, false]);
    assert_eq!(powered(&[0, 2]), [true, true, true, true, false]);
    assert_eq!(powered(&[0, 2, 3]), [true; 5]);
    assert_eq!(powered(&[0, 1]), [true, true, true, false, true]);
    let short = legs([vec![ins("XIC", "B3:0/1")], Vec::new()]);
    let scene = self::scene(&image(), vec![short, ins("OTE", "B3:0/4")], &Documentation::default());
    assert_eq!(scene.powered(&|_| false), [true, false, true], "an empty leg carries power");
    let svg = drawing(&scene, &Options { power: Some(&|_| false), ..Options::default() });
    assert!(svg.contains("class=\"w on\" data-n=\"0\"") && svg.contains("class=\"w on\" data-n=\"2\""), "{svg}");
}

#[test]
fn a_box_with_power_says_nothing_about_its_flags() {
    let scene = scene(&image(), vec![ins("XIC", "B3:0/0"), ins("TON", "T4:0 0.01 100 0")], &Documentation::default());
    let mark = |_| Mark { on: Some(true), ..Mark::default() };
    let svg = drawing(&scene, &Options { mark: &mark, ..Options::default() });
    assert_eq!(group(&svg, 0).matches("class=\"bar\"").count(), 2, "both sides of the contact");
    assert_eq!(group(&svg, 1).matches("class=\"bar\"").count(), 0, "EN and DN are bits of their own");
}

#[test]
fn live_values_take_the_place_of_stored_ones() {
    let rungs = file(vec![Rung::new(vec![ins("EQU", "N7:0=1 5=5"), ins("TON", "T4:0 0.01 500 120")])]);
    let value = |instruction: usize, operand: usize| match (instruction, operand) {
        (0, 0) => Some("-32768".to_owned()),
        (1, 3) => Some("499".to_owned()),
        _ => None,
    };
    let live = render::Live { value: &value };
    let scene = render::live_scene(&image(), &rungs, 0, &Documentation::default(), &Style::graphic(100), &live);
    assert_eq!(texts(&scene, Role::Value), ["-32768<", "5<"]);
    let operands = texts(&scene, Role::Operand);
    assert!(operands.contains(&"499<") && operands.contains(&"500<") && !operands.contains(&"120<"), "{operands:?}");
}

#[test]
fn up_to_five_lines_of_description_titles_and_comments_are_all_there() {
    let documentation = documentation(&["B3:0/1|SYMBOL_1|line one|line two|line three|line four|line five"]);
    let comment = "comment ".repeat(375);
    let rungs = file(vec![commented(vec![ins("OTE", "B3:0/1")], "The title", comment.trim_end())]);
    let style = Style::graphic(100);
    let svg = drawing(&render::scene(&image(), &rungs, 0, &documentation, &style), &Options::default());
    let text = render::rung(&image(), &rungs, 0, &documentation, &style);
    for wanted in ["The title", "SYMBOL_1", "line one", "line two", "line three", "line four", "line five"] {
        assert!(svg.contains(&format!(">{wanted}</text>")) && text.contains(wanted), "{wanted}");
    }
    assert_eq!(
        (svg.matches("comment ").count() + svg.matches("comment<").count(), text.matches("comment").count()),
        (375, 375)
    );
}

proptest! {
    #[test]
    fn no_text_becomes_markup(symbol in ".{0,60}", line in "[<>&\"'a-z\\x00-\\x1f/!-]{0,60}", label in ".{0,20}") {
        let mut series = vec![ins("XIC", "B3:0/0")];
        if let Element::Instruction(instruction) = &mut series[0] {
            instruction.operands[0] = ladder::Operand::Text(symbol);
        }
        let rung = commented(series, &line, &line);
        let scene = render::scene(&image(), &file(vec![rung]), 0, &Documentation::default(), &Style::graphic(80));
        let href = |address: &str| Some(format!("{line}{address}"));
        let options = Options { standalone: true, href: &href, id: &label, label: &label, ..Options::default() };
        let svg = drawing(&scene, &options);
        let opened = |name: &str| svg.matches(&format!("<{name}")).count();
        prop_assert_eq!(svg.matches('<').count(), svg.matches('>').count() - child_selectors());
        prop_assert_eq!((opened("svg"), opened("script"), opened("style"), opened("!")), (1, 0, 1, 0));
        prop_assert!(!svg.contains(|c: char| c.is_control() && !matches!(c, '\t' | '\r' | '\n')), "{svg:?}");
    }
}

/// `>` in the style sheet.
fn child_selectors() -> usize {
    render::svg::STYLE.matches('>').count()
}
