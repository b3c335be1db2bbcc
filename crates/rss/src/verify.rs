//! Accounts for every byte of a project: what each record covers, and whether writing gives the same bytes back.

use crate::archive::{Record, parse, serialize};
use crate::compiler::Compiler;
use crate::data::{DataFiles, ExtensionalDataFiles};
use crate::database::Database;
use crate::error::{Deviation, Error, Mode, Result};
use crate::io::IoConfiguration;
use crate::monitors::{Monitors, Trends};
use crate::processor::Processor;
use crate::program::ProgramFiles;
use crate::project::{Project, Stream};
use crate::small::{self, PowerConfiguration, RcpHolder, RevisionNotes, SourceControl, Version};
use crate::stream::StreamKind;
use crate::summary::Summary;

/// The account of one stream.
#[derive(Clone, Debug, PartialEq)]
pub struct StreamReport {
    /// Full path, e.g. `ONLINEIMAGE/PROGRAM FILES/ObjectData`.
    pub stream: String,
    /// What it holds.
    pub kind: StreamKind,
    /// Size in bytes of the inflated payload (of the stream itself where there is no envelope).
    pub bytes: usize,
    /// Of these, the bytes that belong to fields of a record; a stream without a record counts 0.
    pub understood: usize,
    /// True if the record, written again, gives the same payload. A stream
    /// without a record is carried as it is, which is identical.
    pub identical: bool,
    /// What stopped reading its record.
    pub error: Option<Error>,
    /// What deviates without stopping: in the envelope, the zlib stream, the record.
    pub deviations: Vec<Deviation>,
}

/// The account of a project.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification {
    /// One account per stream, in directory order.
    pub streams: Vec<StreamReport>,
    /// True if every stream is identical and the project, written to a new file, reads back equal stream by stream.
    pub roundtrip: bool,
}

/// Reads every stream of a project as a record, writes it again and compares.
#[must_use]
pub fn verify(project: &Project) -> Verification {
    let streams: Vec<_> = project.streams().map(verify_stream).collect();
    let roundtrip = streams.iter().all(|s| s.identical) && rewrites_equal(project).unwrap_or(false);
    Verification { streams, roundtrip }
}

/// The account of one stream.
#[must_use]
pub fn verify_stream(stream: Stream<'_>) -> StreamReport {
    account(stream, true)
}

/// Reads one stream as its record and drops it: the account without writing
/// again (`identical` then says only that reading met no error).
#[must_use]
pub fn read_stream(stream: Stream<'_>) -> StreamReport {
    account(stream, false)
}

fn account(stream: Stream<'_>, write: bool) -> StreamReport {
    let mut report = match stream.kind() {
        StreamKind::ProgramFiles => record::<ProgramFiles>(stream, write),
        StreamKind::DataFiles => record::<DataFiles>(stream, write),
        StreamKind::ExtensionalDataFiles => record::<ExtensionalDataFiles>(stream, write),
        StreamKind::MemDatabase => record::<Database>(stream, write),
        StreamKind::Processor => record::<Processor>(stream, write),
        StreamKind::IoConfiguration => record::<IoConfiguration>(stream, write),
        StreamKind::ChannelConfiguration => record::<crate::channel::ChannelConfiguration>(stream, write),
        StreamKind::PowerConfiguration => record::<PowerConfiguration>(stream, write),
        StreamKind::Compiler => record::<Compiler>(stream, write),
        StreamKind::Version => record::<Version>(stream, write),
        StreamKind::RevisionNotes => record::<RevisionNotes>(stream, write),
        StreamKind::RcpHolder => record::<RcpHolder>(stream, write),
        StreamKind::SourceControl => record::<SourceControl>(stream, write),
        StreamKind::CustomDataMonitors | StreamKind::GraphicFiles | StreamKind::RecipeFiles => {
            record::<Monitors>(stream, write)
        }
        StreamKind::Trends => record::<Trends>(stream, write),
        StreamKind::SummaryInformation => summary(stream),
        StreamKind::ApplicationHelp
        | StreamKind::DataLogging
        | StreamKind::ReportOptionSetup
        | StreamKind::Workspace
        | StreamKind::Contents => constant(stream),
        StreamKind::ReportOptions | StreamKind::ReportOptions5 | StreamKind::Pc5Options | StreamKind::Other => {
            carried(stream)
        }
    };
    let below: Vec<_> = stream.damage().chain(stream.deviations()).cloned().collect();
    // Bytes the compound file lacks cannot come back.
    report.identical &= stream.damage().next().is_none();
    report.deviations.splice(0..0, below);
    report
}

fn report(stream: Stream<'_>) -> StreamReport {
    StreamReport {
        stream: stream.path().to_owned(),
        kind: stream.kind(),
        bytes: stream.payload().len(),
        understood: 0,
        identical: false,
        error: None,
        deviations: Vec::new(),
    }
}

fn record<'p, R: Record<'p>>(stream: Stream<'p>, write: bool) -> StreamReport {
    let parsed = parse::<R>(stream.payload(), stream.path(), Mode::Permissive);
    let same = || serialize(&parsed.value).is_ok_and(|b| b == stream.payload());
    let identical = parsed.error.is_none() && (!write || same());
    StreamReport {
        understood: parsed.understood,
        identical,
        error: parsed.error,
        deviations: parsed.deviations,
        ..report(stream)
    }
}

/// The property set is read where it is known and written back as stored.
fn summary(stream: Stream<'_>) -> StreamReport {
    let mut out = report(stream);
    match Summary::read(stream.payload()) {
        Ok(summary) => {
            out.understood = out.bytes;
            out.identical = summary.as_bytes() == stream.payload();
        }
        Err(error) => out.error = Some(error),
    }
    out
}

/// Streams with one known content are understood if they hold it, and carried otherwise.
fn constant(stream: Stream<'_>) -> StreamReport {
    let known = match stream.kind() {
        StreamKind::Contents => stream.payload() == small::CONTENTS,
        kind => small::constant(kind).is_some_and(|constant| constant.payload() == stream.payload()),
    };
    let out = carried(stream);
    StreamReport { understood: if known { out.bytes } else { 0 }, ..out }
}

fn carried(stream: Stream<'_>) -> StreamReport {
    StreamReport { identical: true, ..report(stream) }
}

/// Writes the project to a new file and compares what reads back: same
/// streams and storages, same stored bytes, same directory fields.
fn rewrites_equal(project: &Project) -> Result<bool> {
    let back = Project::read(&project.write()?, Mode::Permissive)?;
    let (old, new) = (project.container(), back.container());
    let find = |path: &str| new.nodes.iter().find(|n| n.path == path);
    Ok(old.root == new.root
        && old.nodes.len() == new.nodes.len()
        && old.nodes.iter().all(|n| find(&n.path).is_some_and(|m| m == n)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stream::ImageKind;

    #[test]
    fn each_stream_is_accounted_for() {
        let mut p = Project::new();
        let version = b"\xFF\xFF\x80\0\x0C\0CVersionData\x0A8.30.00.16\x078.30.00\x0216".to_vec();
        p.set_payload(ImageKind::Main, StreamKind::Version, &version).expect("sets");
        p.set_payload(ImageKind::Main, StreamKind::Contents, &small::CONTENTS).expect("sets");
        p.set_payload(ImageKind::Main, StreamKind::ReportOptions, b"whatever").expect("sets");
        let v = verify(&p);
        assert!(v.roundtrip);
        let rows: Vec<_> = v.streams.iter().map(|s| (s.kind, s.bytes, s.understood, s.identical)).collect();
        assert_eq!(
            rows,
            [
                (StreamKind::Version, version.len(), version.len(), true),
                (StreamKind::Contents, 12, 12, true),
                (StreamKind::ReportOptions, 8, 0, true),
            ]
        );

        // A record cut short: understood as far as it goes, not identical.
        p.set_payload(ImageKind::Main, StreamKind::Version, &version[..30]).expect("sets");
        let v = verify(&p);
        assert!(!v.roundtrip && !v.streams[0].identical && v.streams[0].error.is_some());
        assert!(v.streams[0].understood <= 30);
    }
}
