//! What `rungs show` writes at the instructions of a rung, against what RSLogix wrote there.

use crate::rungs::{Both, pairs};
use crate::{Outcome, Pair};
use render::Style;
use render::scene::{Role, Shape};
use rungs_tests::drawing::{Instruction, Shape as Drawn};

/// Symbols and descriptions above the instructions.
pub(crate) fn labels(pair: &Pair<'_>) -> Outcome {
    compare(pair, &[Role::Symbol, Role::Description], |i, texts| {
        texts.extend(i.symbol.iter().chain(&i.description).cloned());
    })
}

/// Titles and names of parameters in boxes.
pub(crate) fn boxes(pair: &Pair<'_>) -> Outcome {
    compare(pair, &[Role::BoxTitle, Role::Name], |i, texts| {
        if i.shape == Drawn::Box {
            texts.extend(i.title.clone());
            texts.extend(i.fields.iter().map(|f| f.label.clone()));
        }
    })
}

/// Address, bit and module at contacts and coils.
pub(crate) fn points(pair: &Pair<'_>) -> Outcome {
    compare(pair, &[Role::Address, Role::Module], |i, texts| {
        texts.extend([&i.above, &i.below, &i.module].into_iter().flatten().cloned());
    })
}

/// Operands and live values in boxes, the values without their `<`.
pub(crate) fn operands(pair: &Pair<'_>) -> Outcome {
    compare(pair, &[Role::Operand, Role::Value], |i, texts| {
        let rows = i.fields.iter().flat_map(|f| std::iter::once(&f.text).chain(&f.values));
        texts.extend(rows.map(|t| t.trim_end_matches('<').to_owned()));
    })
}

/// Contacts and coils that are highlighted as true.
pub(crate) fn highlights(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    let documentation = &pair.whole.main.documentation;
    let style = Style { state: true, ..Style::default() };
    for both in pairs(pair, pair.image) {
        let Some(file) = pair.image.program_file(both.file) else { continue };
        let scene = render::scene(pair.image, file, both.number, documentation, &style);
        for ((drawn, read), spot) in both.instructions().into_iter().zip(&scene.instructions) {
            if drawn.shape != Drawn::Box {
                let operands = || read.operands.iter().map(|o| format!(" {o}")).collect::<String>();
                let place = format!("{both} {}{}", read.mnemonic, operands());
                outcome.row(place, drawn.lit, spot.state == Some(true));
            }
        }
    }
    outcome
}

/// Compares the texts of some roles rung by rung, whatever their order on the line.
fn compare(pair: &Pair<'_>, roles: &[Role], take: impl Fn(&Instruction, &mut Vec<String>)) -> Outcome {
    let mut outcome = Outcome::default();
    for both in pairs(pair, pair.image) {
        let mut printed = Vec::new();
        for instruction in both.drawn.instructions() {
            take(instruction, &mut printed);
        }
        let mut read = rendered(pair, &both, roles);
        for texts in [&mut printed, &mut read] {
            texts.retain_mut(|t| {
                *t = t.trim_end_matches('<').trim().to_owned();
                !t.is_empty()
            });
            texts.sort_unstable();
        }
        if !printed.is_empty() || !read.is_empty() {
            outcome.row(&both, printed, read);
        }
    }
    outcome
}

fn rendered(pair: &Pair<'_>, both: &Both<'_>, roles: &[Role]) -> Vec<String> {
    // A print option: one report of the corpus has whole addresses above its contacts.
    let drawn = pair.report.drawing.iter().flat_map(|f| &f.rungs).flat_map(|r| r.instructions());
    let whole = drawn.filter_map(|i| i.above.as_ref()).any(|text| text.contains('/'));
    let style = Style { width: render::MAX_WIDTH, split_bits: !whole, ..Style::default() };
    let documentation = &pair.whole.main.documentation;
    let Some(file) = pair.image.program_file(both.file) else { return Vec::new() };
    let scene = render::scene(pair.image, file, both.number, documentation, &style);
    let texts = scene.items.into_iter().filter_map(|item| match item.shape {
        Shape::Text(role, text) if roles.contains(&role) => Some(text),
        _ => None,
    });
    texts.collect()
}
