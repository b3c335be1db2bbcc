//! The compound file: its storages and streams, read whole within bounds and written anew.

use crate::error::{Deviation, Error, Foreign, Result, Space};
use std::io::{Cursor, Read as _, Write as _};
use std::time::SystemTime;

/// The first bytes of every compound file.
pub const SIGNATURE: [u8; 8] = [0xD0, 0xCF, 0x11, 0xE0, 0xA1, 0xB1, 0x1A, 0xE1];

/// Largest file read. The largest known project has 0.8 MB.
pub const MAX_FILE: usize = 16 << 20;

/// Most storages and streams in one file. Known projects have about 90.
pub const MAX_ENTRIES: usize = 4096;

/// Longest path in bytes. Known projects stay below 150; deep nests of storages would cost quadratic room.
const MAX_PATH: usize = 1024;

/// What the directory says about a storage or stream apart from its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meta {
    /// Class of the storage; nil for streams.
    pub clsid: uuid::Uuid,
    /// User flags.
    pub state: u32,
    /// Creation time; `None` where the directory holds none.
    pub created: Option<SystemTime>,
    /// Time of the last change; `None` where the directory holds none.
    pub modified: Option<SystemTime>,
}

impl Default for Meta {
    fn default() -> Self {
        Meta { clsid: uuid::Uuid::nil(), state: 0, created: None, modified: None }
    }
}

/// A storage or a stream.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Node {
    /// Path from the root, names separated by `/`: `ONLINEIMAGE/PROCESSOR/ObjectData`.
    pub path: String,
    /// Directory fields.
    pub meta: Meta,
    /// The content of a stream, `None` for a storage.
    pub data: Option<Vec<u8>>,
}

/// A compound file in memory: every node below the root, each after the storage that holds it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Container {
    /// Directory fields of the root.
    pub root: Meta,
    /// Storages and streams in directory order, parents first.
    pub nodes: Vec<Node>,
    /// Streams that could be read in part only, each with the place where its sectors end.
    pub damage: Vec<Deviation>,
}

impl Container {
    /// Reads a compound file.
    ///
    /// Follows real files where they leave the published rules (the `cfb`
    /// crate's permissive validation), but no claim of a size is believed that
    /// the bytes at hand cannot back.
    ///
    /// # Errors
    /// [`Error::Foreign`] for anything that is no compound file, and
    /// [`Error::Container`] for one that is damaged or exceeds [`MAX_FILE`] or [`MAX_ENTRIES`].
    pub fn read(bytes: &[u8]) -> Result<Self> {
        if !bytes.starts_with(&SIGNATURE) {
            return Err(Error::Foreign(crate::identify::identify_plain(bytes)));
        }
        if bytes.len() > MAX_FILE {
            return Err(damage(0, "", format!("a file of at most {MAX_FILE} bytes"), format!("{} bytes", bytes.len())));
        }
        let layout = Layout::read(bytes)?;
        let mut file = cfb::CompoundFile::open(Cursor::new(bytes)).map_err(|e| layout.locate(&e))?;
        let mut out = Container { root: meta(&file.root_entry()), ..Container::default() };
        let mut entries = Vec::new();
        for entry in file.walk().filter(|e| !e.is_root()) {
            let refuse = |expected: String| {
                Err(damage(layout.directory, "directory", expected, "one more or longer".to_owned()))
            };
            if entries.len() >= MAX_ENTRIES {
                return refuse(format!("at most {MAX_ENTRIES} storages and streams"));
            }
            if entry.path().as_os_str().len() > MAX_PATH {
                return refuse(format!("paths of at most {MAX_PATH} bytes"));
            }
            entries.push(entry);
        }
        // What all streams together may still take: what the file holds.
        let mut left = bytes.len();
        for entry in entries {
            let path = path_text(&entry);
            let data = if entry.is_stream() {
                let mut data = Vec::new();
                let claim = usize::try_from(entry.len()).unwrap_or(usize::MAX);
                let result = file.open_stream(entry.path()).and_then(|stream| {
                    data.reserve_exact(claim.min(left));
                    stream.take(left as u64).read_to_end(&mut data)
                });
                left -= data.len().min(left);
                if result.is_err() || data.len() != claim {
                    let why = result.err().map(|e| format!(" ({e})")).unwrap_or_default();
                    out.damage.push(Deviation {
                        stream: path.clone(),
                        space: Space::Stored,
                        offset: data.len(),
                        record: String::new(),
                        expected: format!("the {claim} bytes that the directory states"),
                        found: format!("{} bytes{why}", data.len()),
                    });
                }
                Some(data)
            } else {
                None
            };
            out.nodes.push(Node { path, meta: meta(&entry), data });
        }
        Ok(out)
    }

    /// Writes a new compound file (version 3, 512-byte sectors, as RSLogix does)
    /// that reads back equal: same storages, streams, contents and directory fields.
    ///
    /// # Errors
    /// [`Error::Unwritable`] for a name that a compound file cannot hold, or a
    /// node whose storage is missing.
    pub fn write(&self) -> Result<Vec<u8>> {
        let refuse = |path: &str, e: &std::io::Error| Error::Unwritable(format!("{}: {e}", path.escape_debug()));
        let mut file = cfb::CompoundFile::create_with_version(cfb::Version::V3, Cursor::new(Vec::new()))
            .map_err(|e| refuse("/", &e))?;
        for node in &self.nodes {
            match &node.data {
                Some(data) => file.create_new_stream(&node.path).and_then(|mut s| {
                    s.write_all(data)?;
                    s.flush()
                }),
                None => file.create_storage(&node.path),
            }
            .map_err(|e| refuse(&node.path, &e))?;
        }
        // Directory fields last: creating a child touches the times of its storage.
        let mut set = |path: &str, meta: &Meta, storage: bool| -> std::io::Result<()> {
            file.set_state_bits(path, meta.state)?;
            if storage {
                file.set_storage_clsid(path, meta.clsid)?;
                file.set_created_time(path, meta.created.unwrap_or(epoch()))?;
                file.set_modified_time(path, meta.modified.unwrap_or(epoch()))?;
            }
            Ok(())
        };
        set("/", &self.root, true).map_err(|e| refuse("/", &e))?;
        for node in &self.nodes {
            set(&node.path, &node.meta, node.data.is_none()).map_err(|e| refuse(&node.path, &e))?;
        }
        file.flush().map_err(|e| refuse("/", &e))?;
        Ok(file.into_inner().into_inner())
    }

    /// The content of a stream. Names compare without regard to case, as in any compound file.
    #[must_use]
    pub fn stream(&self, path: &str) -> Option<&[u8]> {
        self.nodes.iter().find(|n| n.data.is_some() && n.path.eq_ignore_ascii_case(path))?.data.as_deref()
    }

    /// The streams with their paths.
    pub fn streams(&self) -> impl Iterator<Item = (&str, &[u8])> {
        self.nodes.iter().filter_map(|n| Some((n.path.as_str(), n.data.as_deref()?)))
    }

    /// Sets the content of a stream, making it and its storages as needed.
    pub fn set_stream(&mut self, path: &str, content: Vec<u8>) {
        if let Some(node) = self.nodes.iter_mut().find(|n| n.data.is_some() && n.path.eq_ignore_ascii_case(path)) {
            node.data = Some(content);
            return;
        }
        for (end, _) in path.match_indices('/') {
            let parent = &path[..end];
            if !self.nodes.iter().any(|n| n.path.eq_ignore_ascii_case(parent)) {
                self.nodes.push(Node { path: parent.to_owned(), meta: Meta::default(), data: None });
            }
        }
        self.nodes.push(Node { path: path.to_owned(), meta: Meta::default(), data: Some(content) });
    }

    /// What a compound file without RSLogix 500 streams is.
    #[must_use]
    pub fn foreign_kind(&self) -> Foreign {
        if self.streams().next().is_none() { Foreign::CompoundWithoutStreams } else { Foreign::CompoundOther }
    }
}

/// The start of compound-file time, 1601-01-01, which stands for "no time".
fn epoch() -> SystemTime {
    let since_1601 = std::time::Duration::from_secs(11_644_473_600);
    SystemTime::UNIX_EPOCH.checked_sub(since_1601).unwrap_or(SystemTime::UNIX_EPOCH)
}

fn meta(entry: &cfb::Entry) -> Meta {
    let known = |time| (time != epoch()).then_some(time);
    Meta {
        clsid: *entry.clsid(),
        state: entry.state_bits(),
        created: known(entry.created()),
        modified: known(entry.modified()),
    }
}

fn path_text(entry: &cfb::Entry) -> String {
    let text = entry.path().to_string_lossy().replace('\\', "/");
    text.strip_prefix('/').map(str::to_owned).unwrap_or(text)
}

fn damage(offset: usize, record: &str, expected: String, found: String) -> Error {
    Error::Container(Box::new(Deviation {
        stream: String::new(),
        space: Space::File,
        offset,
        record: record.to_owned(),
        expected,
        found,
    }))
}

/// Where the parts of a compound file begin, for messages: the `cfb` crate
/// says what is wrong, but not where.
struct Layout {
    directory: usize,
    fat: usize,
    minifat: usize,
}

impl Layout {
    /// Checks the header fields that have one right value, so that each is named with its offset.
    fn read(bytes: &[u8]) -> Result<Self> {
        let u16_at = |at: usize| bytes.get(at..at + 2).and_then(|b| b.try_into().ok()).map(u16::from_le_bytes);
        let u32_at = |at: usize| bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map(u32::from_le_bytes);
        if bytes.len() < 512 {
            return Err(damage(bytes.len(), "header", "512 bytes".into(), format!("{} bytes", bytes.len())));
        }
        let version = u16_at(26).unwrap_or(0);
        let shift = if version == 4 { 12 } else { 9 };
        for (at, what, expected) in
            [(28, "byte order", 0xFFFE), (30, "sector shift", shift), (32, "mini sector shift", 6)]
        {
            let found = u16_at(at).unwrap_or(0);
            if found != expected {
                return Err(damage(at, "header", format!("{what} {expected:#x}"), format!("{found:#x}")));
            }
        }
        if version != 3 && version != 4 {
            return Err(damage(26, "header", "version 3 or 4".into(), version.to_string()));
        }
        let cutoff = u32_at(56).unwrap_or(0);
        if cutoff != 4096 {
            return Err(damage(56, "header", "mini stream cutoff 4096".into(), cutoff.to_string()));
        }
        let sector = |at| {
            let n = u32_at(at).and_then(|n| usize::try_from(n).ok()).unwrap_or(0);
            n.checked_add(1).and_then(|n| n.checked_mul(1 << shift)).filter(|&o| o < bytes.len()).unwrap_or(at)
        };
        Ok(Layout { directory: sector(48), fat: sector(76), minifat: sector(60) })
    }

    fn locate(&self, error: &std::io::Error) -> Error {
        let text = error.to_string();
        let (offset, record) = if text.contains("MiniFAT") || text.contains("mini sector") {
            (self.minifat, "mini sector table")
        } else if text.contains("FAT") || text.contains("sector") || text.contains("chain") {
            (self.fat, "sector table")
        } else {
            (self.directory, "directory")
        };
        damage(offset, record, "a sound compound file".into(), text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Container {
        let mut c = Container::default();
        c.set_stream("PROCESSOR/ObjectData", vec![7; 5000]);
        c.set_stream("ONLINEIMAGE/PROCESSOR/ObjectData", vec![8; 63]);
        c.set_stream("\u{5}SummaryInformation", Vec::new());
        c.root.clsid = uuid::Uuid::from_bytes([3; 16]);
        c.root.modified = Some(SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1_600_000_000));
        c.nodes[0].meta.state = 5;
        c.nodes[0].meta.created = c.root.modified;
        c
    }

    fn by_path(mut c: Container) -> Container {
        c.nodes.sort_by(|a, b| a.path.cmp(&b.path));
        c
    }

    #[test]
    fn what_is_written_reads_back_equal() {
        let c = sample();
        let bytes = c.write().expect("writes");
        assert_eq!(u16::from_le_bytes([bytes[26], bytes[27]]), 3);
        let back = Container::read(&bytes).expect("reads");
        assert_eq!(by_path(back), by_path(c.clone()));
        // Nothing of the clock gets in.
        assert_eq!(c.write(), Ok(bytes));
    }

    #[test]
    fn names_compare_without_case() {
        assert_eq!(sample().stream("Processor/OBJECTDATA").map(<[u8]>::len), Some(5000));
    }

    #[test]
    fn a_header_field_is_named_with_its_offset() {
        let mut bytes = sample().write().expect("writes");
        bytes[30] = 8;
        let error = Container::read(&bytes).expect_err("must fail");
        assert_eq!(
            error.to_string(),
            "damaged compound file: file offset 0x1e, in header: expected sector shift 0x9, found 0x8"
        );
    }

    #[test]
    fn streams_cannot_claim_more_than_the_file_holds() {
        let mut bytes = sample().write().expect("writes");
        // The directory entry of the 5000-byte stream: length at offset 120 of its 128 bytes.
        let at = bytes.windows(4).position(|w| w == 5000_u32.to_le_bytes()).expect("has the length");
        bytes[at..at + 4].copy_from_slice(&0x7FFF_FFFF_u32.to_le_bytes());
        let container = Container::read(&bytes).expect("reads in part");
        assert_eq!(container.damage.len(), 1);
        let message = container.damage[0].to_string();
        assert!(message.starts_with("PROCESSOR/ObjectData, stored offset"), "{message}");
        assert!(message.contains("expected the 2147483647 bytes that the directory states"), "{message}");
        let total: usize = container.streams().map(|(_, data)| data.len()).sum();
        assert!(total <= bytes.len());
        // The other streams are whole.
        assert_eq!(container.stream("ONLINEIMAGE/PROCESSOR/ObjectData"), Some(&[8; 63][..]));
    }
}
