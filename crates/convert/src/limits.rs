//! How large a program may be, whatever form it comes in.

use ladder::{Element, Series};

/// Parts (rungs, instructions, operands, branches, legs) that one program may have. The largest known
/// program has 32,000, and the largest memory of the family, 64K words, holds fewer than this. What
/// works on a program takes about a kilobyte for each.
pub const MAX_PARTS: usize = 200_000;

/// Data words that the files of one image may have: four times the largest memory of the family. A
/// table of them takes some hundred bytes for each.
pub const MAX_DATA_WORDS: usize = 1 << 18;

/// Counts the data words of an image while it is read; `false` for a file that is too much.
pub(crate) fn admit_words(total: &mut usize, words: usize) -> bool {
    let with = total.saturating_add(words);
    if with > MAX_DATA_WORDS {
        return false;
    }
    *total = with;
    true
}

/// What a diagnostic says of a file that is too much.
pub(crate) fn words_left_out(words: usize) -> String {
    format!(
        "expected data files of at most {MAX_DATA_WORDS} words together; the {words} words of this one are left out"
    )
}

/// Counts the parts of a program while it is read.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Parts(usize);

impl Parts {
    /// Counts more parts; `false` if the program has become too large with them.
    pub(crate) fn admit(&mut self, count: usize) -> bool {
        self.0 = self.0.saturating_add(count);
        self.0 <= MAX_PARTS
    }

    /// The program has become too large.
    pub(crate) fn exceeded(self) -> bool {
        self.0 > MAX_PARTS
    }
}

/// What a diagnostic says where a program becomes too large; `left_out` counts this rung and those
/// behind it.
pub(crate) fn left_out(left_out: usize) -> String {
    format!(
        "expected a program of at most {MAX_PARTS} rungs, instructions, operands and branches; this rung and all behind it are left out, {left_out} rungs"
    )
}

/// Parts of a rung with this series. Readers bound how deep branches nest, so it may call itself.
pub(crate) fn of_rung(series: &Series) -> usize {
    let of = |element: &Element| match element {
        Element::Instruction(instruction) => 1 + instruction.operands.len(),
        Element::Branch(branch) => 1 + branch.legs.iter().map(of_rung).sum::<usize>(),
    };
    1 + series.iter().map(of).sum::<usize>()
}
