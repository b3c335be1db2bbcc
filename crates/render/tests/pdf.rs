//! Pages of a PDF, read back with another library: every text once and as it was, whatever it says.

mod common;

use common::{documentation, file, image, ins, legs};
use lopdf::Object;
use lopdf::content::Content;
use proptest::prelude::*;
use render::pdf::{Canvas, Color, Font, Grid, Letters, Painted, breaks, printable, rung};
use render::scene::{Item, Of, Role, Scene, Shape};

/// The texts a page shows, in order; each is one string operand of `Tj`.
fn shown(page: &Painted) -> Vec<String> {
    let content = Content::decode(&page.content).expect("contents that can be read");
    let strings = content.operations.iter().filter(|operation| operation.operator == "Tj");
    strings
        .map(|operation| match operation.operands.as_slice() {
            [Object::String(bytes, _)] => bytes.iter().map(|byte| windows_1252(*byte)).collect(),
            other => panic!("Tj with {other:?}"),
        })
        .collect()
}

/// The encoding, independent of the one under test: codes 0x80 to 0x9F as Unicode's table gives them.
fn windows_1252(code: u8) -> char {
    const HIGH: &str = "€\0‚ƒ„…†‡ˆ‰Š‹Œ\0Ž\0\0‘’“”•–—˜™š›œ\0žŸ";
    match code {
        0x80..=0x9F => {
            HIGH.chars().nth(usize::from(code - 0x80)).filter(|c| *c != '\0').expect("a code with a character")
        }
        code => char::from(code),
    }
}

const LETTERS: Letters = Letters { font: Font::Mono, size: 9.0, color: Color::BLACK };

fn painted(text: &str) -> Painted {
    let mut canvas = Canvas::new(792.0);
    canvas.text(10.0, 10.0, LETTERS, text);
    canvas.finish()
}

#[test]
fn hostile_texts_are_shown_as_text() {
    for text in [
        "(unbalanced",
        "unbalanced)",
        "back\\slash \\) \\101",
        "endstream endobj",
        ") Tj ET Q 1 0 0 rg (",
        "<script>alert(1)</script>",
        "../../etc/passwd",
        "<FEFF0041> 20 °C – „quoted“",
    ] {
        assert_eq!(shown(&painted(text)), [text]);
    }
    let page = painted("a\u{1B}[31m\r\n\0b→\u{202E}");
    assert_eq!(shown(&page), ["a\\x1B[31m\\x0D\\x0A\\x00b\\u{2192}\\u{202E}"]);
    assert_eq!(page.escaped, 6);
}

fn place(_: &str) -> Option<String> {
    None
}

const GRID: Grid = Grid { left: 36.0, top: 36.0, cell: 5.4, row: 10.8 };

#[test]
fn a_rung_shows_its_texts_and_leads_to_its_addresses() {
    let element = legs([vec![ins("TON", "T4:0 1.0 500 120")], vec![ins("XIC", "T4:0/DN"), ins("OTE", "B3:0/1")]]);
    let file = file(vec![ladder::Rung::new(vec![ins("XIC", "I:0.0/3"), element])]);
    let style = render::Style { split_bits: false, ..render::Style::default() };
    let scene = render::scene(&image(), &file, 0, &documentation(&["T4:0|DELAY|wait", "B3:0/1|LAMP"]), &style);
    let mut canvas = Canvas::new(792.0);
    let mut asked = Vec::new();
    rung(&mut canvas, &scene, 0..scene.height, &GRID, &mut |address| {
        asked.push(address.to_owned());
        (address == "T4:0/DN").then(|| "x-T4:0/DN".to_owned())
    });
    let page = canvas.finish();
    let texts = shown(&page);
    for text in
        ["0000", "I:0.0/3", "TON", "Timer On Delay", "T4:0", "500<", "EN", "DN", "T4:0/DN", "B3:0/1", "LAMP", "wait"]
    {
        assert!(texts.iter().any(|shown| shown.trim() == text), "{text} is not in {texts:?}");
    }
    for address in ["I:0.0/3", "T4:0", "T4:0/DN", "B3:0/1"] {
        assert!(asked.iter().any(|asked| asked == address), "{address} leads nowhere: {asked:?}");
    }
    assert!(!page.links.is_empty());
    for link in &page.links {
        assert_eq!(link.target, "x-T4:0/DN");
        assert!(link.area.left < link.area.right && link.area.top < link.area.bottom, "{link:?}");
    }
}

#[test]
fn a_text_without_room_is_told() {
    let item = Item { x: 0, y: 0, shape: Shape::Text(Role::Symbol, "温度".into()), of: Of::Rung };
    let scene = Scene { width: 10, height: 1, items: vec![item], ..Scene::default() };
    let mut canvas = Canvas::new(100.0);
    assert_eq!(rung(&mut canvas, &scene, 0..1, &GRID, &mut place), ["\\u{6E29}\\u{5EA6}"]);
    assert_eq!(canvas.finish().escaped, 2);
}

fn items() -> impl Strategy<Value = Vec<Item>> {
    let text = prop::sample::select(vec![Role::Comment, Role::Symbol, Role::Address, Role::Operand, Role::Value]);
    let shape = prop_oneof![
        (text, "[ -~]{1,12}").prop_map(|(role, text)| Shape::Text(role, text)),
        (0..30_usize, any::<bool>()).prop_map(|(length, arrows)| Shape::Down { length, arrows }),
        (2..20_usize, 2..30_usize, "[A-Z]{0,4}").prop_map(|(width, height, name)| Shape::Frame { width, height, name }),
        Just(Shape::Rail),
        any::<bool>().prop_map(|closed| Shape::Contact { closed }),
        "[A-Z]{0,3}".prop_map(Shape::Coil),
    ];
    prop::collection::vec(
        (0..90_usize, 0..120_usize, shape).prop_map(|(x, y, shape)| Item { x, y, shape, of: Of::Rung }),
        0..60,
    )
}

/// Every text of a scene, signs included, without blanks at its ends.
fn texts(scene: &Scene) -> Vec<String> {
    let text = |item: &Item| match &item.shape {
        Shape::Text(_, text) | Shape::Coil(text) | Shape::Marked(text) => Some(text.clone()),
        Shape::Frame { name, .. } => Some(name.clone()),
        _ => None,
    };
    let shown = scene.items.iter().filter_map(text).map(|text| text.trim_matches(' ').to_owned());
    shown.filter(|text| !text.is_empty()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    #[test]
    fn any_text_reads_back(text in "\\PC{0,40}|.{0,40}|[()\\\\<>/%\\r\\n\\x00-\\x1F]{0,20}") {
        let (wanted, escaped) = printable(&text);
        let page = painted(&text);
        prop_assert_eq!(page.escaped, escaped);
        let texts = shown(&page);
        if wanted.chars().all(|c| c == ' ') {
            prop_assert!(texts.is_empty());
        } else {
            prop_assert_eq!(texts, [wanted.into_owned()]);
        }
    }

    #[test]
    fn a_rung_cut_into_pieces_loses_nothing(items in items(), first in 0..60_usize, others in 0..60_usize) {
        let height = items.iter().map(|item| item.y + 1).max().unwrap_or(1);
        let scene = Scene { width: 100, height, items, ..Scene::default() };
        let pieces = breaks(&scene, first, others);
        let mut next = 0;
        let mut all = Vec::new();
        for (index, piece) in pieces.iter().enumerate() {
            prop_assert_eq!(piece.start, next);
            let room = if index == 0 { first } else { others };
            prop_assert!(piece.len() <= room.max(4));
            next = piece.end;
            let mut canvas = Canvas::new(792.0);
            rung(&mut canvas, &scene, piece.clone(), &GRID, &mut place);
            all.extend(shown(&canvas.finish()));
        }
        prop_assert_eq!(next, height);
        let mut wanted = texts(&scene);
        wanted.sort();
        all.sort();
        prop_assert_eq!(all, wanted);
    }
}
