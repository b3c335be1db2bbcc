//! Monitor windows and trends: `CUSTOM DATA MONITORS`, `GRAPIC FILES`, `RECIPE FILES`, `TRENDS`.
//!
//! The three monitors share one shape: a holder of files, each with entries, a
//! name and a window. Only custom monitors are ever filled by people; the two
//! others are constant in every known project.

use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::text::Text;

/// The three streams of monitor shape.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum MonitorKind {
    /// `CUSTOM DATA MONITORS`.
    #[default]
    Custom,
    /// `GRAPIC FILES` (so spelt).
    Graphic,
    /// `RECIPE FILES`.
    Recipe,
}

impl MonitorKind {
    const ALL: [MonitorKind; 3] = [Self::Custom, Self::Graphic, Self::Recipe];

    /// Class names of holder, file and entry.
    const fn classes(self) -> [&'static str; 3] {
        match self {
            Self::Custom => ["CWatchHolder", "CWatchFile", "CWatchData"],
            Self::Graphic => ["CGraphicHolder", "CGraphicFile", "CWatchData"],
            Self::Recipe => ["CRecipeHolder", "CRecipeFile", "CRecipeData"],
        }
    }
}

/// A stream of monitor shape.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Monitors<'a> {
    /// Which of the three.
    pub kind: MonitorKind,
    /// The monitors; empty if the body has another shape.
    pub files: Vec<Monitor<'a>>,
    /// The body after the root tag where it has another shape: carried, not understood.
    pub other_shape: Option<&'a [u8]>,
}

/// One monitor window.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Monitor<'a> {
    /// Addresses shown.
    pub entries: Vec<MonitorEntry<'a>>,
    /// 0 (unknown).
    pub before_name: u8,
    /// Name, `Untitled` at first.
    pub name: Text<'a>,
    /// Window place and size (inferred).
    pub window: [u8; 16],
    /// More for graphic monitors (4 bytes) and recipes (a title and 12 bytes), unknown.
    pub extra: MonitorExtra<'a>,
}

/// What a monitor has behind its window.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub enum MonitorExtra<'a> {
    /// Nothing: custom monitors.
    #[default]
    None,
    /// Four bytes, zero: graphic monitors.
    Graphic([u8; 4]),
    /// Title, twelve bytes: recipes.
    Recipe(Text<'a>, [u8; 12]),
}

/// One address of a monitor.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MonitorEntry<'a> {
    /// Address as typed; empty in the line that waits for input.
    pub address: Text<'a>,
    /// Two strings, empty (inferred).
    pub strings: [Text<'a>; 2],
    /// 0 (unknown).
    pub byte: u8,
    /// Radix code (inferred).
    pub radix: u32,
    /// `FFFFFFFF`; 0x40 on a line that shows one bit of the word above it (inferred).
    pub field_5: u32,
    /// `FFFFFFFF`; the bit number on such a line (inferred).
    pub bit: u32,
    /// Empty; the bit as shown, `/15`, on such a line (inferred).
    pub suffix: Text<'a>,
    /// Two numbers (unknown).
    pub last: [u32; 2],
}

impl<'a> Record<'a> for Monitors<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        let at = r.offset();
        let root = r.object()?;
        let kind = MonitorKind::ALL.into_iter().find(|kind| {
            let [holder, ..] = kind.classes();
            matches!(root, crate::archive::Object::New { class, .. } if class.name == holder.as_bytes())
        });
        let Some(kind) = kind else {
            return Err(r.unexpected(at, "CWatchHolder, CGraphicHolder or CRecipeHolder", &root));
        };
        self.kind = kind;
        r.mark();
        let start = r.checkpoint();
        let read = read_files(r, kind).and_then(|files| match r.remaining() {
            0 => Ok(files),
            rest => Err(r.fault("the end of the stream", format_args!("{rest} more bytes"))),
        });
        match read {
            Ok(files) => self.files = files,
            Err(error) => {
                // The shape was taken from few projects with entries: another one
                // is carried, but nothing vouches for it.
                r.rewind(&start);
                r.deviation("a list of monitors", error)?;
                self.other_shape = Some(r.opaque("a monitor of another shape", r.remaining())?);
            }
        }
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        let [holder, file, entry] = self.kind.classes();
        w.object(holder);
        if let Some(body) = self.other_shape {
            w.bytes(body);
            return Ok(());
        }
        w.count_u16(self.files.len())?;
        for monitor in &self.files {
            w.object(file);
            w.count_u16(monitor.entries.len())?;
            for item in &monitor.entries {
                w.object(entry);
                w.string(&item.address)?;
                w.string(&item.strings[0])?;
                w.string(&item.strings[1])?;
                w.u8(item.byte);
                w.u32(item.radix);
                w.u32(item.field_5);
                w.u32(item.bit);
                w.string(&item.suffix)?;
                w.u32(item.last[0]);
                w.u32(item.last[1]);
            }
            w.u8(monitor.before_name);
            w.string(&monitor.name)?;
            w.bytes(&monitor.window);
            match &monitor.extra {
                MonitorExtra::None => {}
                MonitorExtra::Graphic(bytes) => w.bytes(bytes),
                MonitorExtra::Recipe(title, bytes) => {
                    w.string(title)?;
                    w.bytes(bytes);
                }
            }
        }
        Ok(())
    }
}

fn read_files<'a>(r: &mut Reader<'a>, kind: MonitorKind) -> Result<Vec<Monitor<'a>>> {
    let [_, file, entry] = kind.classes();
    let count = r.count_u16("a number of monitors", 22)?;
    let mut files = Vec::with_capacity(count);
    for _ in 0..count {
        r.expect_object(file)?;
        let entries = r.count_u16("a number of entries", 27)?;
        let mut monitor = Monitor { entries: Vec::with_capacity(entries), ..Monitor::default() };
        for _ in 0..entries {
            r.expect_object(entry)?;
            monitor.entries.push(MonitorEntry {
                address: r.string("an address")?,
                strings: [r.string("an empty text")?, r.string("an empty text")?],
                byte: r.u8("a byte")?,
                radix: r.u32("a radix")?,
                field_5: r.u32("field 5 of an entry")?,
                bit: r.u32("a bit number")?,
                suffix: r.string("a bit suffix")?,
                last: [r.u32("a number of an entry")?, r.u32("a number of an entry")?],
            });
        }
        monitor.before_name = r.u8("a byte before the name")?;
        monitor.name = r.string("a monitor name")?;
        monitor.window = r.array("a window")?;
        monitor.extra = match kind {
            MonitorKind::Custom => MonitorExtra::None,
            MonitorKind::Graphic => MonitorExtra::Graphic(r.array("four bytes")?),
            MonitorKind::Recipe => MonitorExtra::Recipe(r.string("a recipe title")?, r.array("twelve bytes")?),
        };
        files.push(monitor);
    }
    Ok(files)
}

impl Monitors<'static> {
    /// The stream of a new project: one monitor with one empty line.
    #[must_use]
    pub fn empty(kind: MonitorKind) -> Self {
        let (window, extra) = match kind {
            MonitorKind::Custom => ([0x145, 0x96, 0xA2, 0x87, 0], MonitorExtra::None),
            MonitorKind::Graphic => ([0x253, 0x1C2, 0x5A, 0x78, 0], MonitorExtra::Graphic([0; 4])),
            MonitorKind::Recipe => (
                [0x177, 0x96, 0x50, 0x78, 0xA2],
                MonitorExtra::Recipe(
                    Text::from_bytes(b"Current Recipe"),
                    [0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0x7F, 0x64, 0],
                ),
            ),
        };
        Monitors {
            kind,
            files: vec![Monitor {
                entries: vec![MonitorEntry {
                    radix: 0x0B,
                    field_5: u32::MAX,
                    bit: u32::MAX,
                    ..MonitorEntry::default()
                }],
                before_name: 0,
                name: Text::from_bytes(b"Untitled"),
                window: window_bytes(window),
                extra,
            }],
            other_shape: None,
        }
    }
}

/// A window record: 0, four measures, 0, 1, and one word more.
fn window_bytes(measures: [u16; 5]) -> [u8; 16] {
    let [a, b, c, d, e] = measures;
    let mut bytes = [0; 16];
    for (pair, word) in bytes.chunks_exact_mut(2).zip([0, a, b, c, d, 0, 1, e]) {
        pair.copy_from_slice(&word.to_le_bytes());
    }
    bytes
}

/// `TRENDS` (`CTrendHolder`, proven).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Trends<'a> {
    /// Trend charts.
    pub charts: Vec<Trend<'a>>,
}

/// One trend chart.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Trend<'a> {
    /// Name.
    pub name: Text<'a>,
    /// An embedded compound file, not decoded.
    pub file: &'a [u8],
}

impl<'a> Record<'a> for Trends<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CTrendHolder")?;
        let count = r.count_u16("a number of trends", 7)?;
        r.mark();
        for index in 0..count {
            r.enter("trend", index)?;
            r.expect_object("CTrendFile")?;
            let name = r.string("a trend name")?;
            let size = r.count_u32("the size of a trend", 1)?;
            let file = r.opaque("a trend", size)?;
            self.charts.push(Trend { name, file });
            r.leave();
            r.mark();
        }
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CTrendHolder");
        w.count_u16(self.charts.len())?;
        for chart in &self.charts {
            w.object("CTrendFile");
            w.string(&chart.name)?;
            w.count_u32(chart.file.len())?;
            w.bytes(chart.file);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archive::{parse, serialize};
    use crate::error::Mode;

    #[test]
    fn a_custom_monitor_with_a_word_and_one_of_its_bits() {
        let mut bytes = b"\xFF\xFF\x80\0\x0C\0CWatchHolder\x01\0\xFF\xFF\x80\0\x0A\0CWatchFile\x02\0".to_vec();
        bytes.extend(b"\xFF\xFF\x80\0\x0A\0CWatchData\x04N7:0\0\0\0\x02\0\0\0");
        bytes.extend(b"\xFF\xFF\xFF\xFF\xFF\xFF\xFF\xFF\0\x01\0\0\0\0\0\0\0");
        bytes.extend(b"\x05\x80\x06N7:0/2\0\0\0\0\0\0\0\x40\0\0\0\x02\0\0\0\x02/2\x20\0\0\0\x01\0\0\0");
        bytes.extend(b"\0\x05Pumps");
        bytes.extend([9; 16]);
        let parsed = parse::<Monitors>(&bytes, "S", Mode::Strict);
        assert_eq!((parsed.error, parsed.understood), (None, bytes.len()));
        let entries = &parsed.value.files[0].entries;
        assert_eq!(entries[0].radix, 2);
        assert_eq!(entries[1].address, "N7:0/2");
        assert_eq!((entries[1].bit, entries[1].suffix.to_string()), (2, "/2".to_owned()));
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }

    #[test]
    fn another_shape_is_carried() {
        let bytes = b"\xFF\xFF\x80\0\x0C\0CWatchHolder\x07\0rest".to_vec();
        let parsed = parse::<Monitors>(&bytes, "S", Mode::Permissive);
        assert_eq!((parsed.error, parsed.understood), (None, 18));
        assert_eq!(parsed.deviations.len(), 1, "{:?}", parsed.deviations);
        assert_eq!(parsed.value.other_shape, Some(&b"\x07\0rest"[..]));
        assert_eq!(serialize(&parsed.value), Ok(bytes.clone()));
        assert!(parse::<Monitors>(&bytes, "S", Mode::Strict).error.is_some());
    }

    #[test]
    fn trends_hold_files() {
        let bytes =
            b"\xFF\xFF\x80\0\x0C\0CTrendHolder\x01\0\xFF\xFF\x80\0\x0A\0CTrendFile\x04Heat\x03\0\0\0abc".to_vec();
        let parsed = parse::<Trends>(&bytes, "S", Mode::Strict);
        assert_eq!((parsed.error, parsed.understood), (None, bytes.len() - 3));
        assert_eq!(parsed.value.charts[0].file, b"abc");
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }
}
