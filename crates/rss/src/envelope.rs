//! The 16-byte envelope around the payload of every `ObjectData` stream.
//!
//! | offset | type | meaning |
//! |---|---|---|
//! | 0 | u32 | kind: 2 = zlib stream, 0 = stored raw |
//! | 4 | u32 | 16, the size of the envelope |
//! | 8 | u32 | stored payload size = stream size - 16 |
//! | 12 | u32 | payload size after decompression |

use crate::error::{Deviation, Space};
use flate2::{Compress, Compression, Decompress, FlushCompress, FlushDecompress, Status};

/// Size of the envelope in bytes.
pub const SIZE: usize = 16;

/// Largest payload inflated; the largest known has 0.6 MB.
pub const MAX_PAYLOAD: usize = 16 << 20;

/// Most bytes inflated from one project.
pub const MAX_TOTAL: usize = 32 << 20;

/// Deflate cannot expand one stored byte to more than this many.
const MAX_RATIO: usize = 1032;

/// How a payload is stored: an open set of which two values are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Storage(pub u32);

impl Storage {
    /// The payload as it is.
    pub const RAW: Storage = Storage(0);
    /// A zlib stream.
    pub const ZLIB: Storage = Storage(2);
}

/// The four fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Envelope {
    /// How the payload is stored.
    pub storage: Storage,
    /// Size of the envelope itself, always 16.
    pub size: u32,
    /// Payload bytes as stored.
    pub stored: u32,
    /// Payload bytes after decompression.
    pub inflated: u32,
}

impl Envelope {
    /// Reads the fields; `None` if the stream is shorter than an envelope.
    #[must_use]
    pub fn read(stream: &[u8]) -> Option<Self> {
        let field = |at: usize| stream.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes);
        Some(Envelope { storage: Storage(field(0)?), size: field(4)?, stored: field(8)?, inflated: field(12)? })
    }

    /// What the payload will take up once inflated, at most, going by the bytes at hand.
    #[must_use]
    pub fn claim(&self, stream: &[u8]) -> usize {
        let body = stream.len().saturating_sub(SIZE);
        let declared = usize::try_from(self.inflated).unwrap_or(usize::MAX);
        match self.storage {
            Storage::ZLIB => declared.min(body.saturating_mul(MAX_RATIO)),
            _ => body,
        }
    }
}

/// A payload as far as it could be opened, with what is wrong with it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Opened {
    /// The payload; cut short where the zlib stream is damaged.
    pub payload: Vec<u8>,
    /// Deviations of the envelope and the zlib stream, at stored offsets.
    pub deviations: Vec<Deviation>,
}

/// Opens a stream: checks its envelope, inflates its payload.
///
/// `room` bounds the payload on top of [`MAX_PAYLOAD`]. Never fails: what is
/// wrong is listed, and the payload holds what could be had.
#[must_use]
pub fn open(stream: &[u8], path: &str, room: usize) -> Opened {
    let mut out = Opened::default();
    let mut note = |offset: usize, expected: String, found: String| {
        out.deviations.push(Deviation {
            stream: path.to_owned(),
            space: Space::Stored,
            offset,
            record: "envelope".to_owned(),
            expected,
            found,
        });
    };
    let Some(envelope) = Envelope::read(stream) else {
        note(stream.len(), format!("an envelope of {SIZE} bytes"), format!("{} bytes", stream.len()));
        return out;
    };
    let body = stream.get(SIZE..).unwrap_or_default();
    let fits = |field: u32, len: usize| usize::try_from(field) == Ok(len);
    if !fits(envelope.size, SIZE) {
        note(4, format!("envelope size {SIZE}"), envelope.size.to_string());
    }
    if !fits(envelope.stored, body.len()) {
        note(8, format!("stored size {}", body.len()), envelope.stored.to_string());
    }
    let limit = room.min(MAX_PAYLOAD);
    match envelope.storage {
        Storage::ZLIB => {
            let claim = envelope.claim(stream);
            if claim > limit {
                note(12, format!("a payload of at most {limit} bytes"), format!("{} bytes claimed", envelope.inflated));
                return out;
            }
            let (payload, problem) = inflate(body, claim);
            if let Some((used, problem)) = problem {
                note(SIZE + used, "a sound zlib stream".into(), problem);
            }
            if !fits(envelope.inflated, payload.len()) {
                note(12, format!("payload size {}", payload.len()), envelope.inflated.to_string());
            }
            out.payload = payload;
        }
        other => {
            if other != Storage::RAW {
                note(0, "kind 0 (raw) or 2 (zlib)".into(), format!("{} (taken as raw)", other.0));
            }
            if !fits(envelope.inflated, body.len()) {
                note(12, format!("payload size {}", body.len()), envelope.inflated.to_string());
            }
            if body.len() > limit {
                note(SIZE, format!("a payload of at most {limit} bytes"), format!("{} bytes", body.len()));
            } else {
                out.payload = body.to_vec();
            }
        }
    }
    out
}

/// Inflates `body` into at most `claim` bytes. A problem comes with the
/// number of stored bytes used before it.
fn inflate(body: &[u8], claim: usize) -> (Vec<u8>, Option<(usize, String)>) {
    // One byte more than claimed tells an overlong stream from a fitting one.
    let mut payload = Vec::with_capacity(claim.saturating_add(1));
    let mut zlib = Decompress::new(true);
    let status = zlib.decompress_vec(body, &mut payload, FlushDecompress::Finish);
    let used = usize::try_from(zlib.total_in()).unwrap_or(body.len());
    let problem = match status {
        _ if payload.len() > claim => {
            payload.truncate(claim);
            Some(format!("more than the {claim} bytes announced"))
        }
        Ok(Status::StreamEnd) if used < body.len() => Some(format!("{} bytes after its end", body.len() - used)),
        Ok(Status::StreamEnd) => None,
        Ok(_) => Some("its end missing".to_owned()),
        Err(e) => Some(e.to_string()),
    };
    (payload, problem.map(|p| (used, p)))
}

/// Puts a payload into an envelope. Compressed bytes are those of zlib's
/// default level; another deflate implementation gives other bytes of equal meaning.
///
/// `None` if the payload exceeds the 32-bit length fields.
#[must_use]
pub fn seal(payload: &[u8], storage: Storage) -> Option<Vec<u8>> {
    let mut out = vec![0; SIZE];
    if storage == Storage::ZLIB {
        out.reserve(payload.len() / 2 + 64);
        let mut zlib = Compress::new(Compression::new(6), true);
        loop {
            let used = usize::try_from(zlib.total_in()).ok()?;
            match zlib.compress_vec(payload.get(used..)?, &mut out, FlushCompress::Finish) {
                Ok(Status::StreamEnd) => break,
                Ok(_) => out.reserve(out.len().max(256)),
                Err(_) => return None,
            }
        }
    } else {
        out.extend_from_slice(payload);
    }
    let stored = u32::try_from(out.len() - SIZE).ok()?;
    let inflated = u32::try_from(payload.len()).ok()?;
    for (at, field) in [(0, storage.0), (4, 16), (8, stored), (12, inflated)] {
        out.get_mut(at..at + 4)?.copy_from_slice(&field.to_le_bytes());
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(opened: &Opened) -> Vec<String> {
        opened.deviations.iter().map(ToString::to_string).collect()
    }

    #[test]
    fn a_payload_comes_back_in_both_forms() {
        let payload: Vec<u8> = (0..100_000_u32).map(|i| (i / 7 % 251) as u8).collect();
        for storage in [Storage::RAW, Storage::ZLIB] {
            for len in [0, 1, 1000, payload.len()] {
                let stream = seal(&payload[..len], storage).expect("seals");
                let opened = open(&stream, "S", usize::MAX);
                assert_eq!(messages(&opened), Vec::<String>::new());
                assert_eq!(opened.payload, &payload[..len]);
                assert_eq!(Envelope::read(&stream).map(|e| e.storage), Some(storage));
            }
        }
    }

    #[test]
    fn lengths_are_checked() {
        let mut stream = seal(b"ladder", Storage::RAW).expect("seals");
        stream[8] = 9;
        stream[12] = 200;
        let opened = open(&stream, "S", usize::MAX);
        assert_eq!(opened.payload, b"ladder");
        assert_eq!(
            messages(&opened),
            [
                "S, stored offset 0x8, in envelope: expected stored size 6, found 9",
                "S, stored offset 0xc, in envelope: expected payload size 6, found 200",
            ]
        );
        assert_eq!(
            messages(&open(b"abc", "S", 9)),
            ["S, stored offset 0x3, in envelope: expected an envelope of 16 bytes, found 3 bytes"]
        );
    }

    #[test]
    fn a_bomb_is_refused_by_its_claim_and_by_its_ratio() {
        let zeros = vec![0; MAX_PAYLOAD + 1];
        let bomb = seal(&zeros, Storage::ZLIB).expect("seals");
        assert!(bomb.len() < MAX_PAYLOAD / 500);
        let opened = open(&bomb, "S", usize::MAX);
        assert!(opened.payload.is_empty());
        assert_eq!(opened.deviations.len(), 1);

        // A claim that the stored bytes cannot back allocates next to nothing.
        let mut liar = seal(b"x", Storage::ZLIB).expect("seals");
        liar[12..16].copy_from_slice(&u32::MAX.to_le_bytes());
        let opened = open(&liar, "S", usize::MAX);
        assert_eq!(opened.payload, b"x");
        assert!(opened.payload.capacity() < 20_000);

        // A claim too small cuts the payload and says so.
        let mut small = seal(&[7; 1000], Storage::ZLIB).expect("seals");
        small[12..16].copy_from_slice(&10_u32.to_le_bytes());
        let opened = open(&small, "S", usize::MAX);
        assert_eq!(opened.payload, [7; 10]);
        assert!(!opened.deviations.is_empty());
    }

    #[test]
    fn a_damaged_zlib_stream_yields_what_precedes_the_damage() {
        // Noise, which deflate can only store: a cut loses its share of the payload.
        let mut state = 1_u32;
        let payload: Vec<u8> = std::iter::repeat_with(|| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        })
        .take(100_000)
        .collect();
        let stream = seal(&payload, Storage::ZLIB).expect("seals");
        let cut = stream.len() / 2;
        let opened = open(&stream[..cut], "S", usize::MAX);
        assert!(opened.payload.len() > 10_000, "{}", opened.payload.len());
        assert!(payload.starts_with(&opened.payload));
        assert!(messages(&opened).iter().any(|m| m.contains("sound zlib stream")), "{:?}", messages(&opened));
    }

    #[test]
    fn bytes_after_the_zlib_stream_are_reported() {
        let mut stream = seal(b"ladder", Storage::ZLIB).expect("seals");
        stream.extend_from_slice(b"tail");
        let stored = u32::try_from(stream.len() - SIZE).expect("small");
        stream[8..12].copy_from_slice(&stored.to_le_bytes());
        let opened = open(&stream, "S", usize::MAX);
        assert_eq!(opened.payload, b"ladder");
        assert!(messages(&opened)[0].contains("4 bytes after its end"), "{:?}", messages(&opened));
    }
}
