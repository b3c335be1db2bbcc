//! A project beside its text: what rung text cannot hold is no difference.

use analysis::diff::{Change, Difference};
use ladder::{IoRange, Project, Slot};
use rss::Foreign;

/// Documentation that rung text has no place for; comments of rungs and titles it holds.
const NOT_IN_TEXT: [&str; 6] = [
    "symbol",
    "description",
    "instruction comment",
    "comment without a rung",
    "program file description",
    "data file description",
];

/// Words for what is not there.
const NOTHING: [&str; 3] = ["", "unknown", "not stored"];

/// The bytes are rung text.
pub(super) fn is_text(bytes: &[u8]) -> bool {
    // A project file is not read twice only to tell this.
    !bytes.starts_with(&[0xD0, 0xCF, 0x11, 0xE0])
        && matches!(rss::Project::read(bytes, rss::Mode::Permissive), Err(rss::Error::Foreign(Foreign::SlcText)))
}

/// Gives the controller's own I/O in `text` what rung text cannot say of it: text names the controller instead of its
/// I/O, and counts words, not the bits of them that have terminals.
pub(super) fn fill_in(text: &mut Project, project: &Project) {
    let catalog = text.main.processor.catalog.clone();
    if catalog.is_none() || catalog != project.main.processor.catalog {
        return;
    }
    let range = |range: &IoRange| (range.first_word, range.words);
    for slot in text.main.io.slots.iter_mut().filter(|slot| slot.number == 0) {
        let same = |other: &&Slot| {
            other.number == slot.number
                && (range(&other.inputs), range(&other.outputs)) == (range(&slot.inputs), range(&slot.outputs))
        };
        let Some(known) = project.main.io.slots.iter().find(same) else { continue };
        slot.inputs.bits = known.inputs.bits;
        slot.outputs.bits = known.outputs.bits;
        if slot.module.catalog == catalog {
            slot.module = known.module.clone();
        }
    }
}

/// Takes out what the side that is a text lacks because texts lack it, and says how much that was.
pub(super) fn leave_out(difference: &mut Difference, old_is_text: bool, new_is_text: bool) {
    if old_is_text == new_is_text {
        return;
    }
    let lacks = |change: &Change| {
        let side = if old_is_text { &change.old } else { &change.new };
        side.as_deref().is_none_or(|text| NOTHING.contains(&text))
    };
    let mut counts = (0, 0);
    difference.documentation.retain(|change| {
        let out = NOT_IN_TEXT.contains(&change.what) && lacks(change);
        counts.0 += usize::from(out);
        !out
    });
    difference.configuration.retain(|change| {
        let out = matches!(change.what, "processor" | "channel" | "data file name") && lacks(change);
        counts.1 += usize::from(out);
        !out
    });
    if counts != (0, 0) {
        difference.notes.push(format!(
            "rung text holds no symbols, descriptions, channels or connection of a processor: {} entries of documentation and \
             {} of configuration, which only the project has, were not compared",
            counts.0, counts.1
        ));
    }
}
