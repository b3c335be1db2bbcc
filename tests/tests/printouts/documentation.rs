//! The address and symbol database, rung comments and page titles.

use crate::rungs::{address_text, pairs};
use crate::{Outcome, Pair};
use ladder::Target;
use std::collections::BTreeMap;

/// Every row of the address and symbol database, and no other.
pub(crate) fn symbols(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    let Some(printed) = &pair.report.printout.symbols else { return outcome };
    let mut left: BTreeMap<(String, String), Vec<String>> = BTreeMap::new();
    for entry in pair.whole.main.documentation.entries() {
        if matches!(entry.target, Target::ProgramFile(_) | Target::DataFile(_)) {
            continue;
        }
        let key = (spelled(&entry.target), entry.symbol.clone());
        left.entry(key).or_default().push(squeeze(&entry.description.join(" ")));
    }
    for row in printed {
        let read = left.get_mut(&(row.address.clone(), row.symbol.clone())).and_then(Vec::pop);
        outcome.row(format!("{} {}", row.address, row.symbol), Some(squeeze(&row.description)), read);
    }
    for ((address, symbol), rest) in left {
        for description in rest {
            outcome.missing(format!("{address} {symbol} {description} is not printed"));
        }
    }
    outcome
}

pub(crate) fn spelled(target: &Target) -> String {
    match target {
        Target::Address(address) => address_text(address),
        other => other.to_string(),
    }
}

/// Runs of white space made one space.
fn squeeze(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The comment and title drawn over every rung. RSLogix takes them from the project's one database
/// also for an image read from the processor, so they are compared with the main image.
pub(crate) fn comments(pair: &Pair<'_>) -> Outcome {
    let mut outcome = Outcome::default();
    for both in pairs(pair, &pair.whole.main) {
        let letters = |text: &str| text.split_whitespace().collect::<String>();
        let comment = both.rung.comment.as_ref();
        let text = letters(comment.map_or("", |c| c.text.as_str()));
        let printed = letters(&both.drawn.comment.concat());
        if !(text.is_empty() && printed.is_empty()) {
            outcome.row(format!("{both} comment"), printed, text);
        }
        let title = letters(comment.map_or("", |c| c.title.as_str()));
        let printed = letters(both.drawn.title.as_deref().unwrap_or_default());
        if !(title.is_empty() && printed.is_empty()) {
            outcome.row(format!("{both} title"), printed, title);
        }
    }
    outcome
}
