//! Whether two rungs say the same, for merging.

use std::collections::BTreeSet;

use ladder::{Image, Rung};

use super::keys::{Interner, RungKey};
use super::language::{Half, Language};
use super::renames::Mapping;
use super::rslogix::Rslogix;
use super::{ChangeKind, Difference, LogicChange, Place, logic};

/// Compares rungs of several programs.
#[derive(Default)]
pub(crate) struct Equality(Interner);

impl Equality {
    /// The same logic, whatever is displayed. Two rungs that are not there are the same.
    pub(crate) fn same(&mut self, a: Option<(&Image, &Rung)>, b: Option<(&Image, &Rung)>) -> bool {
        let (Some((x, a)), Some((y, b))) = (a, b) else { return a.is_none() && b.is_none() };
        let (p, q) = (self.key(x, a), self.key(y, b));
        let half = |program, rung, key| Half::<Rslogix> { program, rung, key };
        p.id == q.id && !Rslogix::values_differ(half(x, a, &p), half(y, b, &q))
    }

    fn key(&mut self, image: &Image, rung: &Rung) -> RungKey {
        self.0.rung::<Rslogix>(image, rung, &Mapping::default())
    }
}

/// What differs in the logic, and the rungs that belong together and kept their order, ascending.
pub(crate) fn matched(old: &Image, new: &Image) -> (Difference, Vec<(Place, Place)>) {
    let mut difference = Difference::default();
    let matched = logic::compare::<Rslogix>(old, new, &mut difference);
    let moved: BTreeSet<Place> = difference
        .logic
        .iter()
        .filter_map(|change| match change {
            LogicChange::Rung(rung) if rung.kind == ChangeKind::Moved => rung.new,
            _ => None,
        })
        .collect();
    let pairs = matched.rungs.into_iter().filter(|(_, new)| !moved.contains(new)).collect();
    (difference, pairs)
}
