//! A project file as a whole: container, streams, payloads; read, changed and written.

use crate::container::{Container, MAX_FILE};
use crate::envelope::{self, Envelope, MAX_TOTAL, Opened, Storage};
use crate::error::{Deviation, Error, Mode, Result, Space};
use crate::identify::identify_container;
use crate::stream::{ImageKind, StreamKind};
use std::sync::OnceLock;

/// One stream's place in the container, and its payload once somebody asked for it.
#[derive(Clone, Debug)]
struct Slot {
    node: usize,
    image: ImageKind,
    kind: StreamKind,
    /// Bytes its payload may take, from the budget of the whole project.
    room: usize,
    opened: OnceLock<Opened>,
}

/// An RSLogix 500 project file in memory.
///
/// Payloads are inflated when first asked for, so looking at one stream does
/// not cost the others.
#[derive(Clone, Debug, Default)]
pub struct Project {
    container: Container,
    slots: Vec<Slot>,
    missing: Vec<Missing>,
}

/// A stream that every project has and this one lacks.
#[derive(Clone, Debug, PartialEq)]
pub struct Missing {
    /// What was looked for.
    pub deviation: Deviation,
    /// Without it the program is not whole: its processor, its ladder or all of its data.
    pub essential: bool,
}

/// The streams of an image that describe the program. Every project seen has them in its main image
/// and, [`StreamKind::MemDatabase`] excepted, in its online image.
const PROGRAM: [StreamKind; 8] = [
    StreamKind::Processor,
    StreamKind::ProgramFiles,
    StreamKind::DataFiles,
    StreamKind::ExtensionalDataFiles,
    StreamKind::MemDatabase,
    StreamKind::IoConfiguration,
    StreamKind::ChannelConfiguration,
    StreamKind::Compiler,
];

/// One stream of a [`Project`].
#[derive(Clone, Copy, Debug)]
pub struct Stream<'p> {
    project: &'p Project,
    slot: &'p Slot,
}

impl Project {
    /// Reads a project file.
    ///
    /// In [`Mode::Permissive`] damage inside a stream is left to that stream; in
    /// [`Mode::Strict`] every payload is opened and the first deviation is the error.
    ///
    /// ```
    /// use rss::{Error, Foreign, Mode, Project};
    /// assert_eq!(Project::read(b"%PDF-1.5 ..", Mode::Permissive).err(), Some(Error::Foreign(Foreign::Pdf)));
    /// ```
    ///
    /// # Errors
    /// [`Error::Foreign`] if the file is something else, [`Error::Container`]
    /// if the compound file is damaged, and in strict mode any deviation.
    pub fn read(bytes: &[u8], mode: Mode) -> Result<Self> {
        let container = Container::read(bytes)?;
        if let Some(kind) = identify_container(&container) {
            return Err(Error::Foreign(kind));
        }
        let mut project = Project { container, ..Project::default() };
        project.index();
        project.look_for_missing();
        if mode == Mode::Strict
            && let Some(first) = project.missing().map(|missing| &missing.deviation).chain(project.deviations()).next()
        {
            return Err(first.clone().into());
        }
        Ok(project)
    }

    /// A project without any stream, to be filled by [`Project::set_payload`].
    #[must_use]
    pub fn new() -> Self {
        Project::default()
    }

    /// Lists the streams and shares out the room for payloads, in directory order.
    fn index(&mut self) {
        let mut left = MAX_TOTAL;
        self.slots.clear();
        for (node, n) in self.container.nodes.iter().enumerate() {
            let Some(data) = &n.data else { continue };
            let (image, kind) = StreamKind::of_path(&n.path);
            let room = left;
            if is_enveloped(kind, &n.path) {
                // A claim beyond the room is refused and takes nothing from the others.
                let claim = Envelope::read(data).map_or(0, |e| e.claim(data));
                left = left.checked_sub(claim).unwrap_or(left);
            }
            self.slots.push(Slot { node, image, kind, room, opened: OnceLock::new() });
        }
    }

    fn look_for_missing(&mut self) {
        let images: Vec<_> = self.images().filter(|&image| image != ImageKind::Main).collect();
        for image in std::iter::once(ImageKind::Main).chain(images) {
            let lacks = |kind| self.stream(image, kind).is_none();
            // The two data streams hold the same tables.
            let no_data = lacks(StreamKind::DataFiles) && lacks(StreamKind::ExtensionalDataFiles);
            let missing = PROGRAM.into_iter().filter(|&kind| lacks(kind)).filter_map(|kind| {
                let essential = match kind {
                    StreamKind::Processor | StreamKind::ProgramFiles => true,
                    StreamKind::DataFiles => no_data,
                    StreamKind::MemDatabase if image == ImageKind::Online => return None,
                    _ => false,
                };
                let deviation = Deviation {
                    stream: String::new(),
                    space: Space::File,
                    offset: 0,
                    record: String::new(),
                    expected: format!("a stream {}", kind.path(image)),
                    found: "none".to_owned(),
                };
                Some(Missing { deviation, essential })
            });
            let missing: Vec<_> = missing.collect();
            self.missing.extend(missing);
        }
    }

    /// Streams that every project has and this one lacks.
    pub fn missing(&self) -> impl Iterator<Item = &Missing> {
        self.missing.iter()
    }

    /// The compound file, with stored (not inflated) stream contents.
    #[must_use]
    pub fn container(&self) -> &Container {
        &self.container
    }

    /// All streams in directory order.
    pub fn streams(&self) -> impl Iterator<Item = Stream<'_>> {
        self.slots.iter().map(|slot| Stream { project: self, slot })
    }

    /// A named stream of an image.
    #[must_use]
    pub fn stream(&self, image: ImageKind, kind: StreamKind) -> Option<Stream<'_>> {
        self.streams().find(|s| s.image() == image && s.kind() == kind && kind != StreamKind::Other)
    }

    /// The images present: those that have a program or a processor.
    pub fn images(&self) -> impl Iterator<Item = ImageKind> {
        ImageKind::ALL.into_iter().filter(|&image| {
            [StreamKind::Processor, StreamKind::ProgramFiles].iter().any(|&kind| self.stream(image, kind).is_some())
        })
    }

    /// Everything that deviates below the level of records: streams cut short,
    /// envelopes, zlib streams. Opens every payload.
    pub fn deviations(&self) -> impl Iterator<Item = &Deviation> {
        self.container
            .damage
            .iter()
            .chain(self.slots.iter().flat_map(|slot| Stream { project: self, slot }.deviations()))
    }

    /// Replaces the payload of a named stream, or adds the stream. If the
    /// payload is the one already there, the stored bytes stay as they are;
    /// otherwise they are compressed anew.
    ///
    /// # Errors
    /// [`Error::Unwritable`] for [`StreamKind::Other`], which names no stream,
    /// and for payloads beyond 32 bits.
    pub fn set_payload(&mut self, image: ImageKind, kind: StreamKind, payload: &[u8]) -> Result<()> {
        if kind == StreamKind::Other {
            return Err(Error::Unwritable("a stream without a name".to_owned()));
        }
        let old = self.stream(image, kind);
        if let Some(stream) = old
            && stream.payload() == payload
            && stream.deviations().is_empty()
        {
            return Ok(());
        }
        let content = match kind.storage() {
            Some(usual) => {
                // A stream keeps the kind it was stored in.
                let storage = old.and_then(|s| Envelope::read(s.stored())).map_or(usual, |e| match e.storage {
                    Storage::RAW => Storage::RAW,
                    _ => Storage::ZLIB,
                });
                envelope::seal(payload, storage).ok_or_else(|| {
                    Error::Unwritable(format!("{}: payload of {} bytes", kind.path(image), payload.len()))
                })?
            }
            None => payload.to_vec(),
        };
        let path = kind.path(image);
        self.container.set_stream(&path, content);
        self.container.damage.retain(|d| !d.stream.eq_ignore_ascii_case(&path));
        self.index();
        Ok(())
    }

    /// Writes the project to a new file. Streams not changed keep their stored bytes.
    ///
    /// # Errors
    /// [`Error::Unwritable`] if a name cannot be held, or the file would be
    /// larger than [`Project::read`] accepts.
    pub fn write(&self) -> Result<Vec<u8>> {
        let bytes = self.container.write()?;
        if bytes.len() > MAX_FILE {
            return Err(Error::Unwritable(format!("a file of {} bytes, more than {MAX_FILE}", bytes.len())));
        }
        Ok(bytes)
    }
}

/// Streams named `ObjectData` sit in an envelope, known or not.
fn is_enveloped(kind: StreamKind, path: &str) -> bool {
    kind.has_envelope()
        || (kind == StreamKind::Other
            && path.rsplit_once('/').is_some_and(|(_, name)| name.eq_ignore_ascii_case("ObjectData")))
}

impl<'p> Stream<'p> {
    /// Full path, e.g. `ONLINEIMAGE/PROGRAM FILES/ObjectData`.
    #[must_use]
    pub fn path(&self) -> &'p str {
        self.project.container.nodes.get(self.slot.node).map_or("", |n| &n.path)
    }

    /// The image it belongs to.
    #[must_use]
    pub fn image(&self) -> ImageKind {
        self.slot.image
    }

    /// What it holds.
    #[must_use]
    pub fn kind(&self) -> StreamKind {
        self.slot.kind
    }

    /// The bytes in the compound file, envelope included.
    #[must_use]
    pub fn stored(&self) -> &'p [u8] {
        self.project.container.nodes.get(self.slot.node).and_then(|n| n.data.as_deref()).unwrap_or_default()
    }

    /// True if the payload sits in an envelope.
    #[must_use]
    pub fn has_envelope(&self) -> bool {
        is_enveloped(self.kind(), self.path())
    }

    /// The payload: inflated, or the stored bytes of a stream without envelope.
    /// If the stream is damaged this is what could be had; see [`Stream::deviations`].
    #[must_use]
    pub fn payload(&self) -> &'p [u8] {
        if self.has_envelope() { &self.opened().payload } else { self.stored() }
    }

    /// What the compound file lacks of the stream.
    pub fn damage(&self) -> impl Iterator<Item = &'p Deviation> {
        let path = self.path();
        self.project.container.damage.iter().filter(move |d| d.stream == path)
    }

    /// What is wrong with the envelope or the zlib stream.
    #[must_use]
    pub fn deviations(&self) -> &'p [Deviation] {
        if self.has_envelope() { &self.opened().deviations } else { &[] }
    }

    fn opened(&self) -> &'p Opened {
        self.slot.opened.get_or_init(|| envelope::open(self.stored(), self.path(), self.slot.room))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Project {
        let mut p = Project::new();
        for (image, kind) in
            [ImageKind::Main, ImageKind::Online].into_iter().flat_map(|i| PROGRAM.map(|kind| (i, kind)))
        {
            p.set_payload(image, kind, b"payload").expect("sets");
        }
        p.set_payload(ImageKind::Main, StreamKind::Processor, b"raw payload").expect("sets");
        p.set_payload(ImageKind::Online, StreamKind::ProgramFiles, &[5; 9000]).expect("sets");
        p.set_payload(ImageKind::Main, StreamKind::Contents, b"plain").expect("sets");
        p
    }

    #[test]
    fn a_project_reads_back_stream_by_stream() {
        let bytes = sample().write().expect("writes");
        let back = Project::read(&bytes, Mode::Strict).expect("reads");
        let payload = |image, kind| back.stream(image, kind).map(|s| s.payload().to_vec());
        assert_eq!(payload(ImageKind::Main, StreamKind::Processor), Some(b"raw payload".to_vec()));
        assert_eq!(payload(ImageKind::Online, StreamKind::ProgramFiles), Some(vec![5; 9000]));
        assert_eq!(payload(ImageKind::Main, StreamKind::Contents), Some(b"plain".to_vec()));
        assert_eq!(payload(ImageKind::Main, StreamKind::Trends), None);
        assert_eq!(back.images().collect::<Vec<_>>(), [ImageKind::Main, ImageKind::Online]);
        assert_eq!(back.streams().count(), 2 * PROGRAM.len() + 1);
    }

    #[test]
    fn an_unchanged_payload_keeps_its_stored_bytes() {
        let mut p = sample();
        let path = StreamKind::ProgramFiles.path(ImageKind::Online);
        // The same payload compressed by another implementation.
        let mut other = vec![0; envelope::SIZE];
        let mut zlib = flate2::Compress::new(flate2::Compression::new(0), true);
        other.reserve(10_000);
        zlib.compress_vec(&[5; 9000], &mut other, flate2::FlushCompress::Finish).expect("deflates");
        let stored = u32::try_from(other.len() - envelope::SIZE).expect("small");
        for (at, field) in [(0, 2), (4, 16), (8, stored), (12, 9000)] {
            other[at..at + 4].copy_from_slice(&u32::to_le_bytes(field));
        }
        p.container.set_stream(&path, other.clone());
        p.index();
        p.set_payload(ImageKind::Online, StreamKind::ProgramFiles, &[5; 9000]).expect("sets");
        assert_eq!(p.container().stream(&path), Some(&other[..]));
        p.set_payload(ImageKind::Online, StreamKind::ProgramFiles, &[6; 9000]).expect("sets");
        assert_ne!(p.container().stream(&path), Some(&other[..]));
    }

    #[test]
    fn damage_in_one_stream_leaves_the_others() {
        let mut p = sample();
        p.container.set_stream(&StreamKind::ProgramFiles.path(ImageKind::Online), b"short".to_vec());
        let bytes = p.write().expect("writes");
        let back = Project::read(&bytes, Mode::Permissive).expect("reads");
        assert_eq!(back.deviations().count(), 1);
        assert_eq!(back.stream(ImageKind::Main, StreamKind::Processor).map(|s| s.payload()), Some(&b"raw payload"[..]));
        assert!(matches!(Project::read(&bytes, Mode::Strict), Err(Error::Record(_))));
    }

    #[test]
    fn missing_streams_are_told() {
        let without = |image: ImageKind, gone: &[StreamKind]| {
            let whole = sample();
            let mut p = Project::new();
            for stream in whole.streams().filter(|s| s.image() != image || !gone.contains(&s.kind())) {
                p.set_payload(stream.image(), stream.kind(), stream.payload()).expect("sets");
            }
            let bytes = p.write().expect("writes");
            let back = Project::read(&bytes, Mode::Permissive).expect("reads");
            assert_eq!(Project::read(&bytes, Mode::Strict).is_ok(), back.missing().next().is_none());
            back.missing().map(|missing| missing.essential).collect::<Vec<_>>()
        };
        use StreamKind::{DataFiles, ExtensionalDataFiles, IoConfiguration, MemDatabase, ProgramFiles};
        assert!(without(ImageKind::Main, &[]).is_empty());
        assert_eq!(without(ImageKind::Main, &[ProgramFiles]), [true]);
        assert_eq!(without(ImageKind::Main, &[IoConfiguration]), [false]);
        assert_eq!(without(ImageKind::Main, &[DataFiles]), [false]);
        assert_eq!(without(ImageKind::Main, &[DataFiles, ExtensionalDataFiles]), [true, false]);
        assert!(without(ImageKind::Online, &[MemDatabase]).is_empty());
    }

    #[test]
    fn many_bombs_share_one_budget() {
        let mut p = Project::new();
        let zeros = vec![0; MAX_TOTAL / 5 * 2];
        for &kind in StreamKind::NAMED.iter().filter(|k| k.storage() == Some(Storage::ZLIB)).take(5) {
            p.set_payload(ImageKind::Main, kind, &zeros).expect("sets");
        }
        p.set_payload(ImageKind::Main, StreamKind::Processor, b"x").expect("sets");
        p.index();
        let total: usize = p.streams().map(|s| s.payload().len()).sum();
        assert!(total <= MAX_TOTAL, "{total}");
        assert_eq!(p.deviations().count(), 3);
    }
}
