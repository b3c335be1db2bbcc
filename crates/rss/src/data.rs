//! Data files: the data tables of the controller, their values and forces, as the streams store them.
//!
//! ```text
//! DATA FILES             := OBJ CDataHolder { count, file*;           count, file*;  count, M file* }
//! Extensional DATA FILES := OBJ CDataHolder { count, file*, u32 zero; count, file*;  count, M file* }
//! file := OBJ CDataFile   { body }    (M file: CSlcMDataFile), each with a tail in the extensional stream
//! body := u16 type, h0, h1, h2, elements, words, a, b;  data;  forces;  u16 number, description, name, u32 t
//! ```

use crate::archive::{Object, Reader, Record, Writer};
use crate::error::Result;
use crate::text::Text;
use std::borrow::Cow;

/// Type code of a data file: an open set. Named are the codes this crate's
/// layout depends on; letters and members belong to the program model.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileTypeCode(pub u16);

impl FileTypeCode {
    /// Outputs; has a force table.
    pub const OUTPUT: FileTypeCode = FileTypeCode(0);
    /// Inputs; has a force table.
    pub const INPUT: FileTypeCode = FileTypeCode(1);
    /// A file number reserved by the processor.
    pub const RESERVED: FileTypeCode = FileTypeCode(9);
    /// A file number not in use.
    pub const UNUSED: FileTypeCode = FileTypeCode(10);

    /// True for the types whose data is followed by a force table.
    #[must_use]
    pub fn has_forces(self) -> bool {
        self == Self::OUTPUT || self == Self::INPUT
    }
}

/// 16-bit words, as stored or as built.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Words<'a>(Cow<'a, [u8]>);

impl<'a> Words<'a> {
    fn stored(bytes: &'a [u8]) -> Self {
        Words(Cow::Borrowed(bytes))
    }

    /// Number of words.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len() / 2
    }

    /// True without words.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Word `index`.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<u16> {
        let at = index.checked_mul(2)?;
        let bytes = self.0.get(at..at.checked_add(2)?)?;
        Some(u16::from_le_bytes(bytes.try_into().ok()?))
    }

    /// Sets word `index`; false if there is none.
    pub fn set(&mut self, index: usize, word: u16) -> bool {
        let slot = index.checked_mul(2).and_then(|at| self.0.to_mut().get_mut(at..at.checked_add(2)?));
        match slot {
            Some(bytes) => {
                bytes.copy_from_slice(&word.to_le_bytes());
                true
            }
            None => false,
        }
    }

    /// All words in order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = u16> + '_ {
        self.0.chunks_exact(2).map(|pair| u16::from_le_bytes([pair[0], pair[1]]))
    }
}

impl FromIterator<u16> for Words<'_> {
    fn from_iter<I: IntoIterator<Item = u16>>(words: I) -> Self {
        Words(Cow::Owned(words.into_iter().flat_map(u16::to_le_bytes).collect()))
    }
}

/// Tail of a file in the extensional stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extension {
    /// Always 2; perhaps a version.
    pub x0: u16,
    /// Three zeros, then 0 or 1. Meaning unknown.
    pub x1: [u8; 4],
}

impl Default for Extension {
    fn default() -> Self {
        Extension { x0: 2, x1: [0; 4] }
    }
}

/// A data file (class `CDataFile` or `CSlcMDataFile`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DataFile<'a> {
    /// Type of the file.
    pub type_code: FileTypeCode,
    /// Always 0. Meaning unknown.
    pub h0: u16,
    /// 0, or 1 on outputs of a few new projects. Meaning unknown.
    pub h1: u16,
    /// 0 or 1, perhaps a download protection. Inferred.
    pub h2: u16,
    /// Number of elements.
    pub elements: u16,
    /// 16-bit words per element, 0 for an unused file.
    pub words: u16,
    /// Always 0. Meaning unknown.
    pub a: u16,
    /// Always 0xFFFF. Meaning unknown, perhaps "global".
    pub b: u16,
    /// `elements * words` words, element after element.
    pub data: Words<'a>,
    /// Two words per element, on-mask then off-mask; only inputs and outputs have them. See [`DataFile::force`].
    pub forces: Words<'a>,
    /// File number as printed; 0 for function files; M0 is 0, M1 is 1.
    pub number: u16,
    /// File description.
    pub description: Text<'a>,
    /// File name, empty for function files.
    pub name: Text<'a>,
    /// Always 0. Meaning unknown.
    pub t: u32,
    /// The tail, in the extensional stream only.
    pub extension: Option<Extension>,
}

impl Default for DataFile<'_> {
    fn default() -> Self {
        DataFile {
            type_code: FileTypeCode::UNUSED,
            h0: 0,
            h1: 0,
            h2: 0,
            elements: 0,
            words: 0,
            a: 0,
            b: 0xFFFF,
            data: Words::default(),
            forces: Words::default(),
            number: 0,
            description: Text::default(),
            name: Text::default(),
            t: 0,
            extension: None,
        }
    }
}

impl DataFile<'_> {
    /// The force pair of word `index` as (on, off): the controller uses
    /// `(data | on) & off`. No force is `(0, 0xFFFF)`. Layout proven; the rule is
    /// proven for inputs.
    #[must_use]
    pub fn force(&self, index: usize) -> Option<(u16, u16)> {
        let at = index.checked_mul(2)?;
        Some((self.forces.get(at)?, self.forces.get(at.checked_add(1)?)?))
    }
}

/// The content of both data file streams.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DataHolder<'a> {
    /// Data table files; the index is the file number.
    pub user: Vec<DataFile<'a>>,
    /// Four zero bytes between the lists; only the extensional stream has them.
    pub between: Option<u32>,
    /// Function files (MicroLogix 1100 and later).
    pub function: Vec<DataFile<'a>>,
    /// M0 and M1.
    pub m: Vec<DataFile<'a>>,
}

/// The stream `DATA FILES`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DataFiles<'a>(pub DataHolder<'a>);

/// The stream `Extensional DATA FILES`: the same files, each with an [`Extension`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExtensionalDataFiles<'a>(pub DataHolder<'a>);

impl<'a> Record<'a> for DataFiles<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        self.0.read(r, false)
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        self.0.write(w, false)
    }
}

impl<'a> Record<'a> for ExtensionalDataFiles<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        self.0.read(r, true)
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        self.0.write(w, true)
    }
}

const FILE: &str = "CDataFile";
const M_FILE: &str = "CSlcMDataFile";
/// Files that one list may hold. Compiled code names a file by one byte, so no list needs more than
/// 256; the bound, with room to spare, keeps a small stream of tiny files from claiming all memory.
const MAX_FILES: usize = 4096;
/// Fewest bytes of a file with its tag.
const MIN_FILE: usize = 2 + 16 + 8;

impl<'a> DataHolder<'a> {
    fn read(&mut self, r: &mut Reader<'a>, extended: bool) -> Result<()> {
        r.expect_object("CDataHolder")?;
        files(&mut self.user, r, "data file", FILE, extended)?;
        if extended {
            let zero = r.u32("the field between the lists")?;
            self.between = Some(r.usually("the field between the lists", zero, &0)?);
            r.mark();
        }
        files(&mut self.function, r, "function file", FILE, extended)?;
        files(&mut self.m, r, "M file", M_FILE, extended)
    }

    fn write(&self, w: &mut Writer, extended: bool) -> Result<()> {
        w.object("CDataHolder");
        write_files(&self.user, w, FILE, extended)?;
        if extended {
            w.u32(self.between.unwrap_or(0));
        }
        write_files(&self.function, w, FILE, extended)?;
        write_files(&self.m, w, M_FILE, extended)
    }
}

fn files<'a>(
    out: &mut Vec<DataFile<'a>>,
    r: &mut Reader<'a>,
    what: &'static str,
    class: &'static str,
    extended: bool,
) -> Result<()> {
    let at = r.offset();
    let count = r.count("a number of files", MIN_FILE)?;
    if count > MAX_FILES {
        return Err(r.fault_at(at, format_args!("at most {MAX_FILES} files"), count));
    }
    // A count is a claim; files beyond the usual number make their room as they come.
    out.reserve_exact(count.min(1024));
    r.mark();
    for index in 0..count {
        r.enter(what, index)?;
        let at = r.offset();
        match r.object()? {
            Object::New { class: c, .. } if c.name == class.as_bytes() => {}
            other => return Err(r.unexpected(at, class, &other)),
        }
        let file = DataFile::read(r, extended)?;
        out.push(file);
        r.leave();
        r.mark();
    }
    Ok(())
}

fn write_files(files: &[DataFile<'_>], w: &mut Writer, class: &'static str, extended: bool) -> Result<()> {
    w.count(files.len())?;
    files.iter().try_for_each(|file| {
        w.object(class);
        file.write(w, extended)
    })
}

impl<'a> DataFile<'a> {
    fn read(r: &mut Reader<'a>, extended: bool) -> Result<Self> {
        let type_code = FileTypeCode(r.u16("a file type")?);
        let mut out = DataFile {
            type_code,
            h0: r.u16("h0")?,
            h1: r.u16("h1")?,
            h2: r.u16("h2")?,
            elements: r.u16("a number of elements")?,
            words: r.u16("words per element")?,
            a: r.u16("a")?,
            b: r.u16("b")?,
            ..DataFile::default()
        };
        // At most 2^32 words: within range on every supported machine, and
        // checked against the payload by `bytes`.
        let words = usize::from(out.elements).saturating_mul(usize::from(out.words));
        out.data = Words::stored(r.bytes("data words", words.saturating_mul(2))?);
        if type_code.has_forces() {
            out.forces = Words::stored(r.bytes("a force table", usize::from(out.elements) * 4)?);
        }
        out.number = r.u16("a file number")?;
        out.description = r.string("a file description")?;
        out.name = r.string("a file name")?;
        out.t = r.u32("t")?;
        if extended {
            out.extension = Some(Extension { x0: r.u16("x0")?, x1: r.array("x1")? });
        }
        Ok(out)
    }

    fn write(&self, w: &mut Writer, extended: bool) -> Result<()> {
        let refuse = |what: &str, has: usize, needs: usize| {
            crate::error::Error::Unwritable(format!("data file {}: {has} {what} where {needs} belong", self.number))
        };
        let needs = usize::from(self.elements).saturating_mul(usize::from(self.words));
        if self.data.len() != needs {
            return Err(refuse("words", self.data.len(), needs));
        }
        let needs = if self.type_code.has_forces() { usize::from(self.elements) * 2 } else { 0 };
        if self.forces.len() != needs {
            return Err(refuse("force words", self.forces.len(), needs));
        }
        for field in [self.type_code.0, self.h0, self.h1, self.h2, self.elements, self.words, self.a, self.b] {
            w.u16(field);
        }
        w.bytes(&self.data.0);
        w.bytes(&self.forces.0);
        w.u16(self.number);
        w.string(&self.description)?;
        w.string(&self.name)?;
        w.u32(self.t);
        if extended {
            let tail = self.extension.unwrap_or_default();
            w.u16(tail.x0);
            w.bytes(&tail.x1);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
