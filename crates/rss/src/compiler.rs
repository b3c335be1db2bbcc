//! `COMPILER`: result of the last verification: download image, label table, memory figures.

use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::processor::Model;

/// The `CompilerInterface` record. Evidence per field: `docs/format/project-streams.md`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Compiler<'a> {
    /// 1 with an image, 0 without (proven).
    pub has_image: u32,
    /// Controller memory as it would be downloaded; not decoded, see [`Compiler::image_start`].
    pub image: &'a [u8],
    /// 0 (unknown).
    pub before_labels: u16,
    /// Memory address left over from the writing program; 0 without labels. No meaning (proven).
    pub label_pointer: u32,
    /// LBL and JMP instructions.
    pub labels: LabelTable<'a>,
    /// Memory figures.
    pub memory: Memory,
}

/// Memory figures of the last verification; all zero if there was none.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Memory {
    /// Bytes free, second figure, mostly 0 (unknown).
    pub figure_0: u32,
    /// Bytes free in the controller image (inferred).
    pub bytes_free: u32,
    /// Instruction words of the controller (proven); 0 for models of the SLC form.
    pub instruction_words: u32,
    /// Instruction words left (printed).
    pub instruction_words_left: u32,
    /// Data words of the controller (proven).
    pub data_words: u32,
    /// Data words left (printed).
    pub data_words_left: u32,
}

/// Instruction and data words as reports print them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MemoryUse {
    /// Instruction words used.
    pub instruction_words_used: u32,
    /// Instruction words left.
    pub instruction_words_left: u32,
    /// Data table words used; `None` for models of the SLC form, which do not state them.
    pub data_words_used: Option<u32>,
}

impl Memory {
    /// The figures in printed form, `None` if the project was never verified
    /// or the figures contradict each other.
    #[must_use]
    pub fn in_use(&self, model: Model) -> Option<MemoryUse> {
        if self.instruction_words != 0 {
            return Some(MemoryUse {
                instruction_words_used: self.instruction_words.checked_sub(self.instruction_words_left)?,
                instruction_words_left: self.instruction_words_left,
                data_words_used: Some(self.data_words.checked_sub(self.data_words_left)?),
            });
        }
        // Models 8, 28 and 36 state bytes only: 8 bytes an instruction word,
        // of 1,024 words (8) or 941.75 (28, 36). Inferred from the rounding;
        // it reproduces the summary properties of every known case.
        let total_bytes: u32 = match model.0 {
            8 => 1024 * 8,
            28 | 36 => 7534,
            _ => return None,
        };
        if self.bytes_free == 0 {
            return None;
        }
        let left = self.bytes_free / 8;
        // Both are rounded down, so they can add up to one less than there are.
        let used = total_bytes.checked_sub(self.bytes_free)? / 8;
        Some(MemoryUse { instruction_words_used: used, instruction_words_left: left, data_words_used: None })
    }
}

/// What the image begins with (proven for the models that share the layout).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageStart {
    /// First word: 0x0138, 0x0180 or 0x029A by model, else status word S:0.
    pub first_word: u16,
    /// Second word: user program type, else status word S:1.
    pub second_word: u16,
}

impl Compiler<'_> {
    /// The first two words of the image, if it is that long.
    #[must_use]
    pub fn image_start(&self) -> Option<ImageStart> {
        match self.image {
            [a, b, c, d, ..] => {
                Some(ImageStart { first_word: u16::from_le_bytes([*a, *b]), second_word: u16::from_le_bytes([*c, *d]) })
            }
            _ => None,
        }
    }
}

/// The label table; empty if the program has no LBL and no JMP.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct LabelTable<'a> {
    /// Stored form.
    bytes: &'a [u8],
}

/// Bytes before the entries of a label table.
const LABEL_HEADER: usize = 40;
const LBL_BYTES: usize = 23;
const JMP_BYTES: usize = 22;

/// One LBL or JMP of the label table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Label {
    /// Program file.
    pub file: u32,
    /// Rung, from 0.
    pub rung: u32,
    /// Label number.
    pub number: u8,
}

impl<'a> LabelTable<'a> {
    /// The stored bytes.
    #[must_use]
    pub fn as_bytes(&self) -> &'a [u8] {
        self.bytes
    }

    /// LBL and JMP entries; `None` if the table has another shape.
    #[must_use]
    pub fn entries(&self) -> Option<(Vec<Label>, Vec<Label>)> {
        if self.bytes.is_empty() {
            return Some((Vec::new(), Vec::new()));
        }
        let (header, entries) = self.bytes.split_at_checked(LABEL_HEADER)?;
        let total = u32::from_le_bytes(*header.first_chunk::<4>()?);
        let lbl_bytes = usize::from(u16::from_le_bytes(*header.get(4..)?.first_chunk::<2>()?));
        let jmp_bytes = usize::from(u16::from_le_bytes(*header.get(6..)?.first_chunk::<2>()?));
        if usize::try_from(total).ok()? != self.bytes.len()
            || lbl_bytes % LBL_BYTES != 0
            || jmp_bytes % JMP_BYTES != 0
            || lbl_bytes.checked_add(jmp_bytes)? != entries.len()
        {
            return None;
        }
        let (lbl, jmp) = entries.split_at_checked(lbl_bytes)?;
        let read = |entry: &[u8]| {
            Some(Label {
                file: u32::from_le_bytes(*entry.get(4..)?.first_chunk::<4>()?),
                rung: u32::from_le_bytes(*entry.get(8..)?.first_chunk::<4>()?),
                number: *entry.get(12)?,
            })
        };
        Some((
            lbl.chunks_exact(LBL_BYTES).map(read).collect::<Option<_>>()?,
            jmp.chunks_exact(JMP_BYTES).map(read).collect::<Option<_>>()?,
        ))
    }
}

impl<'a> Record<'a> for Compiler<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CompilerInterface")?;
        self.has_image = r.u32("the image flag")?;
        let length = r.count_u32("the image length", 1)?;
        r.mark();
        self.image = r.opaque("the image", length)?;
        self.before_labels = r.u16("a word before the label table")?;
        let length = r.u16("the length of the label table")?;
        self.label_pointer = r.u32("the label pointer")?;
        r.enter_named("label table")?;
        let at = r.offset();
        let bytes = r.bytes("the label table", usize::from(length))?;
        self.labels = LabelTable { bytes };
        if self.labels.entries().is_none() {
            r.deviation_at(
                at,
                "a label table of a header, LBL and JMP entries",
                format_args!("{} bytes of another shape", bytes.len()),
            )?;
        }
        r.leave();
        r.mark();
        r.enter_named("memory figures")?;
        self.memory = Memory {
            figure_0: r.u32("memory figure 0")?,
            bytes_free: r.u32("bytes free")?,
            instruction_words: r.u32("instruction words")?,
            instruction_words_left: r.u32("instruction words left")?,
            data_words: r.u32("data words")?,
            data_words_left: r.u32("data words left")?,
        };
        r.leave();
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CompilerInterface");
        w.u32(self.has_image);
        w.count_u32(self.image.len())?;
        w.bytes(self.image);
        w.u16(self.before_labels);
        w.count_u16(self.labels.bytes.len())?;
        w.u32(self.label_pointer);
        w.bytes(self.labels.bytes);
        for figure in [
            self.memory.figure_0,
            self.memory.bytes_free,
            self.memory.instruction_words,
            self.memory.instruction_words_left,
            self.memory.data_words,
            self.memory.data_words_left,
        ] {
            w.u32(figure);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archive::{parse, serialize};
    use crate::error::Mode;

    fn stream(image: &[u8], labels: &[u8]) -> Vec<u8> {
        let mut b = b"\xFF\xFF\x80\0\x11\0CompilerInterface".to_vec();
        b.extend(u32::from(!image.is_empty()).to_le_bytes());
        b.extend((image.len() as u32).to_le_bytes());
        b.extend(image);
        b.extend(0u16.to_le_bytes());
        b.extend((labels.len() as u16).to_le_bytes());
        b.extend(0u32.to_le_bytes());
        b.extend(labels);
        for figure in [0u32, 50_000, 6656, 6600, 4096, 4000] {
            b.extend(figure.to_le_bytes());
        }
        b
    }

    /// One LBL (file 4, rung 2, label 7) and one JMP to it in rung 9.
    fn labels() -> Vec<u8> {
        let mut b = vec![40 + 23 + 22, 0, 0, 0, 23, 0, 22, 0];
        b.extend([1; 1]);
        b.extend([0; 31]);
        b.extend(b"\0\0\0\0\x04\0\0\0\x02\0\0\0\x07\0\0\0\0\0\0\0\0\0\0");
        b.extend(b"\0\0\0\0\x04\0\0\0\x09\0\0\0\x07\0\0\0\0\0\0\0\0\0");
        b
    }

    #[test]
    fn image_is_carried_labels_and_figures_are_read() {
        let bytes = stream(b"\x80\x01\x08\x81rest", &labels());
        let parsed = parse::<Compiler>(&bytes, "COMPILER/ObjectData", Mode::Strict);
        assert_eq!(parsed.error, None);
        assert_eq!(parsed.understood, bytes.len() - 8);
        let record = parsed.value;
        assert_eq!(record.image_start(), Some(ImageStart { first_word: 0x0180, second_word: 0x8108 }));
        let (lbl, jmp) = record.labels.entries().expect("known shape");
        assert_eq!(lbl, [Label { file: 4, rung: 2, number: 7 }]);
        assert_eq!(jmp, [Label { file: 4, rung: 9, number: 7 }]);
        assert_eq!(
            record.memory.in_use(Model(61)),
            Some(MemoryUse { instruction_words_used: 56, instruction_words_left: 6600, data_words_used: Some(96) })
        );
        assert_eq!(serialize(&record), Ok(bytes));
    }

    #[test]
    fn the_empty_form_has_63_bytes() {
        let bytes = serialize(&Compiler::default()).expect("writes");
        assert_eq!(bytes.len(), 63);
        let parsed = parse::<Compiler>(&bytes, "S", Mode::Strict);
        assert_eq!((parsed.error, parsed.understood), (None, 63));
        assert_eq!(parsed.value.memory.in_use(Model(61)), None);
    }

    #[test]
    fn a_label_table_of_another_shape_is_a_deviation() {
        let mut odd = labels();
        odd.pop();
        let bytes = stream(b"", &odd);
        let parsed = parse::<Compiler>(&bytes, "S", Mode::Permissive);
        assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }
}
