//! What two programs have in common, without matching their rungs: for finding which file became which.

use std::hash::BuildHasher;

use foldhash::fast::FixedState;
use ladder::Image;

use super::language::{Language, Piece};
use super::renames::Mapping;
use super::rslogix::Rslogix;

/// The instructions of a program with their operands, as numbers. Displayed values are no part of it.
///
/// Numbers of different instructions can be equal in rare cases, so a profile says how much two programs
/// are alike, never that they are equal: [`super::compare`] does.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Profile {
    /// One number for each instruction, sorted.
    instructions: Vec<u64>,
}

impl Profile {
    /// The profile of a program.
    pub fn of(image: &Image) -> Profile {
        let (state, mapping, mut text, mut whole) =
            (FixedState::default(), Mapping::default(), String::new(), String::new());
        let mut instructions = Vec::new();
        for rung in image.ladder_files().flat_map(|file| &file.rungs).filter(|rung| !rung.is_end()) {
            for (_, instruction) in Rslogix::pieces(rung).into_iter().filter_map(Piece::instruction) {
                whole.clear();
                Rslogix::words(image, instruction, &mapping, &mut text, &mut |word| {
                    whole.push_str(word);
                    whole.push(' ');
                });
                instructions.push(state.hash_one(&whole));
            }
        }
        instructions.sort_unstable();
        Profile { instructions }
    }

    /// Instructions of the program.
    pub fn len(&self) -> usize {
        self.instructions.len()
    }

    /// The program has no instruction but the ends of its files.
    pub fn is_empty(&self) -> bool {
        self.instructions.is_empty()
    }

    /// Instructions in common, of 1000: twice the shared ones by all of both. Two empty programs have
    /// nothing in common that would tell anything: 0.
    pub fn similarity(&self, other: &Profile) -> u32 {
        let (a, b) = (&self.instructions, &other.instructions);
        if a.is_empty() && b.is_empty() {
            return 0;
        }
        super::keys::similarity(a, b)
    }
}
