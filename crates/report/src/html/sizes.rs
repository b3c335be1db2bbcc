//! About how high things are, so that a browser can leave out what is not in sight and still know where
//! everything else stands.

use std::collections::BTreeSet;

use crate::model::{Block, RowKind, Table};

/// Pixels of one step of size; a row of a drawing.
const STEP: usize = 16;

/// The sizes a page uses: each becomes a class.
#[derive(Debug, Default)]
pub(super) struct Sizes(BTreeSet<usize>);

impl Sizes {
    /// The class of something of so many pixels.
    pub(super) fn class(&mut self, pixels: usize) -> String {
        let exact = pixels.div_ceil(STEP).max(1);
        // Beyond a window a tenth more or less is good enough.
        let steps = if exact > 64 { exact.div_ceil(8) * 8 } else { exact };
        self.0.insert(steps);
        format!("h{steps}")
    }

    /// A rule for each class that was given out.
    pub(super) fn rules(&self) -> String {
        let rule = |steps: &usize| format!(".h{steps}{{contain-intrinsic-size:auto {}px}}\n", steps * STEP);
        self.0.iter().map(rule).collect()
    }
}

/// Pixels of a block that is no rung.
pub(super) fn of_block(block: &Block<'_>) -> usize {
    match block {
        Block::Heading(_) => 44,
        Block::Pairs(pairs) => 20 + 23 * pairs.len(),
        Block::Table(table) => of_table(table),
        // Told when it is drawn.
        Block::Rung(_) => 0,
        Block::Note(_) => 40,
        // Only the first level; trees are short.
        Block::Tree(items) => 20 + 23 * items.len(),
    }
}

/// Pixels of a table.
pub(super) fn of_table(table: &Table) -> usize {
    40 + table.rows.iter().map(|row| of_row(row.kind)).sum::<usize>()
}

/// Pixels of a row.
pub(super) fn of_row(kind: RowKind) -> usize {
    match kind {
        RowKind::Plain => 24,
        RowKind::Group => 34,
    }
}

/// Pixels of a drawing of so many rows.
pub(super) fn of_rows(rows: usize) -> usize {
    rows * STEP
}
