//! Small streams: version, revision notes, power budget, recipe flag, source control, and the constant ones.

use crate::archive::{Reader, Record, Writer};
use crate::error::Result;
use crate::stream::StreamKind;
use crate::text::Text;

/// `Version`: the application version that saved the project (`CVersionData`, proven).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Version<'a> {
    /// Full version, e.g. `8.30.00.16`.
    pub full: Text<'a>,
    /// Version without the build, e.g. `8.30.00`.
    pub version: Text<'a>,
    /// Build number, e.g. `16`.
    pub build: Text<'a>,
}

impl<'a> Record<'a> for Version<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CVersionData")?;
        self.full = r.string("the full version")?;
        self.version = r.string("the version")?;
        self.build = r.string("the build")?;
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CVersionData");
        w.string(&self.full)?;
        w.string(&self.version)?;
        w.string(&self.build)
    }
}

/// `REVISION NOTES`: revision counters and the notes typed at saving (`CRevision`, proven).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RevisionNotes<'a> {
    /// Current revision; no note has a higher one.
    pub current: u32,
    /// Counter (unknown); with `counter_b` it often adds up to `current`.
    pub counter_a: u32,
    /// Counter (unknown); mostly equal to the revision number of the summary properties.
    pub counter_b: u32,
    /// Revision and text, in stored order, mostly newest first.
    pub notes: Vec<(u32, Text<'a>)>,
}

impl<'a> Record<'a> for RevisionNotes<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CRevision")?;
        self.current = r.u32("the current revision")?;
        self.counter_a = r.u32("counter a")?;
        self.counter_b = r.u32("counter b")?;
        let count = r.count_u16("a number of notes", 5)?;
        r.mark();
        for index in 0..count {
            r.enter("note", index)?;
            let revision = r.u32("a revision")?;
            self.notes.push((revision, r.string("a note")?));
            r.leave();
            r.mark();
        }
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CRevision");
        w.u32(self.current);
        w.u32(self.counter_a);
        w.u32(self.counter_b);
        w.count_u16(self.notes.len())?;
        for (revision, note) in &self.notes {
            w.u32(*revision);
            w.string(note)?;
        }
        Ok(())
    }
}

/// Bytes of the power budget before the one field that is ever set.
const POWER_ZEROS: usize = 56;

/// `IO MISC_POWER_CONFIGURATION` (`CIOPwr`).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PowerConfiguration {
    /// 56 bytes, zero in every known project (unknown).
    pub first: [u8; POWER_ZEROS],
    /// 0, or the number of I/O points of the base unit chosen in the power
    /// dialog (inferred). A setting of that dialog, not of the hardware.
    pub base_points: u32,
}

impl Default for PowerConfiguration {
    fn default() -> Self {
        PowerConfiguration { first: [0; POWER_ZEROS], base_points: 0 }
    }
}

impl<'a> Record<'a> for PowerConfiguration {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CIOPwr")?;
        let first = r.array("the power budget")?;
        self.first = r.usually("56 zero bytes", first, &[0; POWER_ZEROS])?;
        self.base_points = r.u32("the points of the base unit")?;
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CIOPwr");
        w.bytes(&self.first);
        w.u32(self.base_points);
        Ok(())
    }
}

/// `RCP HOLDER` (`CRCPHolder`).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct RcpHolder {
    /// 0 (unknown).
    pub word_0: u16,
    /// 1 for models 60 to 63, 0 for the others (inferred: recipes supported).
    pub recipes: u16,
    /// 0 (unknown).
    pub word_2: u16,
}

impl<'a> Record<'a> for RcpHolder {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CRCPHolder")?;
        self.word_0 = r.u16("word 0")?;
        self.recipes = r.u16("the recipe flag")?;
        self.word_2 = r.u16("word 2")?;
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CRCPHolder");
        w.u16(self.word_0);
        w.u16(self.recipes);
        w.u16(self.word_2);
        Ok(())
    }
}

/// `SourceControl` (`CSourceControlPersistantData`, so spelt).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SourceControl<'a> {
    /// 9 zero bytes (unknown).
    pub first: [u8; 9],
    /// Path of a project file, mostly empty (proven).
    pub path: Text<'a>,
    /// 16 zero bytes (unknown).
    pub last: [u8; 16],
}

impl<'a> Record<'a> for SourceControl<'a> {
    fn read(&mut self, r: &mut Reader<'a>) -> Result<()> {
        r.expect_object("CSourceControlPersistantData")?;
        let first = r.array("nine bytes")?;
        self.first = r.usually("nine zero bytes", first, &[0; 9])?;
        self.path = r.string("the path")?;
        let last = r.array("sixteen bytes")?;
        self.last = r.usually("sixteen zero bytes", last, &[0; 16])?;
        Ok(())
    }

    fn write(&self, w: &mut Writer) -> Result<()> {
        w.object("CSourceControlPersistantData");
        w.bytes(&self.first);
        w.string(&self.path)?;
        w.bytes(&self.last);
        Ok(())
    }
}

/// A stream that has the same content in every known project: one object.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Constant {
    /// The stream.
    pub kind: StreamKind,
    /// Body of its root object.
    pub body: &'static [u8],
}

/// Constant streams whose body has no inner structure.
pub const CONSTANTS: &[Constant] = &[
    Constant { kind: StreamKind::ApplicationHelp, body: &[0] },
    Constant { kind: StreamKind::DataLogging, body: &[0; 2] },
    Constant { kind: StreamKind::ReportOptionSetup, body: &[0; 5] },
    Constant { kind: StreamKind::Workspace, body: &[0; 3] },
];

/// The constant stream of this kind, if it is one.
#[must_use]
pub fn constant(kind: StreamKind) -> Option<&'static Constant> {
    CONSTANTS.iter().find(|known| known.kind == kind)
}

impl Constant {
    /// The payload as every known project stores it.
    #[must_use]
    pub fn payload(&self) -> Vec<u8> {
        let mut w = Writer::new();
        w.object(self.kind.root_class());
        w.bytes(self.body);
        w.into_bytes()
    }
}

/// Content of the stream `Contents`, which has no envelope.
pub const CONTENTS: [u8; 12] = [0x80, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::archive::{parse, serialize};
    use crate::error::Mode;

    fn round_trip<'a, R: Record<'a> + Clone>(bytes: &'a [u8]) -> R {
        let parsed = parse::<R>(bytes, "S", Mode::Strict);
        assert_eq!(parsed.error, None);
        assert_eq!(parsed.understood, bytes.len());
        assert_eq!(serialize(&parsed.value).as_deref(), Ok(bytes));
        parsed.value
    }

    #[test]
    fn version() {
        let record: Version = round_trip(b"\xFF\xFF\x80\0\x0C\0CVersionData\x0A9.00.00.07\x079.00.00\x0207");
        assert_eq!((record.version.to_string(), record.build.to_string()), ("9.00.00".into(), "07".into()));
    }

    #[test]
    fn revision_notes_keep_their_order() {
        let record: RevisionNotes = round_trip(
            b"\xFF\xFF\x80\0\x09\0CRevision\x03\0\0\0\x01\0\0\0\x02\0\0\0\x02\0\x01\0\0\0\x05first\x03\0\0\0\x04last",
        );
        assert_eq!((record.current, record.counter_a, record.counter_b), (3, 1, 2));
        assert_eq!(record.notes[0].0, 1);
        assert_eq!(record.notes[1].1, "last");
    }

    #[test]
    fn power_recipes_and_source_control() {
        let mut bytes = b"\xFF\xFF\x80\0\x06\0CIOPwr".to_vec();
        bytes.extend([0; 56]);
        bytes.extend([32, 0, 0, 0]);
        assert_eq!(round_trip::<PowerConfiguration>(&bytes).base_points, 32);
        let record: RcpHolder = round_trip(b"\xFF\xFF\x80\0\x0A\0CRCPHolder\0\0\x01\0\0\0");
        assert_eq!(record.recipes, 1);
        let mut bytes = b"\xFF\xFF\x80\0\x1C\0CSourceControlPersistantData".to_vec();
        bytes.extend([0; 9]);
        bytes.extend(b"\x08C:\\A.RSS");
        bytes.extend([0; 16]);
        assert_eq!(round_trip::<SourceControl>(&bytes).path, "C:\\A.RSS");
    }

    #[test]
    fn values_never_seen_are_deviations_and_survive() {
        let mut bytes = b"\xFF\xFF\x80\0\x06\0CIOPwr".to_vec();
        bytes.extend([7; 60]);
        let parsed = parse::<PowerConfiguration>(&bytes, "S", Mode::Permissive);
        assert_eq!((parsed.error, parsed.deviations.len()), (None, 1));
        assert_eq!(serialize(&parsed.value), Ok(bytes));
    }

    #[test]
    fn constants_are_one_object_each() {
        assert_eq!(
            constant(StreamKind::Workspace).map(Constant::payload),
            Some(b"\xFF\xFF\x80\0\x11\0CWorkSpaceManager\0\0\0".to_vec())
        );
        assert_eq!(constant(StreamKind::ProgramFiles), None);
    }
}
