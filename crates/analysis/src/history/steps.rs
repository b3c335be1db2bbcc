//! What changed from each save of a machine to the next.

use ladder::Project;

use crate::diff::{Difference, Profile, Side, compare};

/// Earlier saves that one is compared with to find that a change was taken back.
const MOST_BACK: usize = 12;

/// A save beside the one before it.
#[derive(Clone, Debug, Default)]
pub struct Step {
    /// What changed since the save before.
    pub change: Difference,
    /// The latest earlier save with the same logic, documentation, values and configuration, by its place;
    /// that is the one before if nothing changed at all.
    pub same_as: Option<usize>,
    /// The logic changed, and is now that of this earlier save again.
    pub logic_as: Option<usize>,
}

/// One step for each project but the first. Only the offline programs are compared.
pub fn steps(projects: &[&Project]) -> Vec<Step> {
    let profiles: Vec<Profile> = projects.iter().map(|project| Profile::of(&project.main)).collect();
    let mut found = Vec::new();
    for (at, pair) in projects.windows(2).enumerate() {
        let [before, after] = pair else { continue };
        let change = difference(before, after);
        let mut step = Step { same_as: change.is_empty().then_some(at), ..Step::default() };
        if !change.is_empty() {
            // Equal programs have equal profiles; which of them are equal a comparison tells.
            let candidates = (0..at).rev().filter(|back| profiles.get(*back) == profiles.get(at + 1)).take(MOST_BACK);
            for back in candidates {
                let Some(earlier) = projects.get(back) else { continue };
                let again = difference(earlier, after);
                if again.is_empty() && step.same_as.is_none() {
                    step.same_as = Some(back);
                }
                if again.logic.is_empty() && !change.logic.is_empty() && step.logic_as.is_none() {
                    step.logic_as = Some(back);
                }
            }
        }
        step.change = change;
        found.push(step);
    }
    found
}

fn difference(old: &Project, new: &Project) -> Difference {
    compare(
        Side { image: &old.main, documentation: Some(&old.main.documentation) },
        Side { image: &new.main, documentation: Some(&new.main.documentation) },
    )
}
