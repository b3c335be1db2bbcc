//! The status file: which words have a counterpart, which are computed, which need a person.

use ladder::{Address, FileType, Place};

use super::context::{Context, Converted, Person};
use super::emit::FIRST_SCAN;
use super::marks::Mark;

/// What a status word is here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Word {
    /// Plain memory that conversions keep: flags, math register, index register.
    Kept,
    /// Computed at the beginning of each scan.
    Computed,
    /// Written by the controller itself and without counterpart.
    Foreign,
}

fn word_kind(word: u16) -> Word {
    match word {
        0 | 2 | 5 | 13 | 14 | 24 => Word::Kept,
        1 | 4 | 35 | 37..=42 | 53 => Word::Computed,
        _ => Word::Foreign,
    }
}

impl Context<'_> {
    /// A status word is read as a word.
    pub(super) fn status_read(&mut self, address: &Address) -> Converted {
        let Place::Number(word) = address.element else { return Ok(()) };
        self.status_word_read(word)
    }

    fn status_word_read(&mut self, word: u16) -> Converted {
        match word_kind(word) {
            Word::Kept => {}
            Word::Computed if word == 1 => {
                return Err(Person::new(Mark::Status, "S:1 as a word: mode and state bits have no common counterpart"));
            }
            Word::Computed => self.needs_computed(word),
            Word::Foreign => self.condition(
                Mark::Status,
                format!("S:{word} belongs to the original's controller: here it is plain memory with its saved value"),
            ),
        }
        Ok(())
    }

    fn needs_computed(&mut self, word: u16) {
        self.status_words.insert(word);
    }

    /// A status bit is read; `Some` when it is no bit of the image.
    pub(super) fn status_bit_read(&mut self, word: u16, bit: u16) -> Converted<Option<String>> {
        match (word, bit) {
            (1, 15) => Ok(Some(FIRST_SCAN.to_owned())),
            (1, 13) => Ok(Some("ST2".to_owned())),
            (1, _) => {
                let what =
                    format!("S:1/{bit} tells the state of the original's controller; here it keeps its saved value");
                self.condition(Mark::Status, what);
                Ok(None)
            }
            _ => self.status_word_read(word).map(|()| None),
        }
    }

    /// A status word or bit is written by the program.
    pub(super) fn status_write(&mut self, address: &Address) -> Converted {
        if address.file_type != FileType::S {
            return Ok(());
        }
        let Place::Number(word) = address.element else { return Ok(()) };
        match word {
            5 => {
                self.needs.minor_errors = true;
                Ok(())
            }
            0 | 2 | 13 | 14 | 24 => Ok(()),
            1 | 4 | 6 | 35 => {
                Err(Person::new(Mark::Status, format!("{address} is written: the controller's own state")))
            }
            37..=42 | 53 => Err(Person::new(
                Mark::Clock,
                format!("{address} is written: setting the clock has no counterpart here"),
            )),
            _ => {
                self.condition(Mark::Status, format!("writing {address} has no effect beyond the stored value"));
                Ok(())
            }
        }
    }
}
