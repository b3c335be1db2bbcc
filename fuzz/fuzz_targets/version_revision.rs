//! The small streams; the class of the root object tells which.
#![no_main]

use rss::StreamKind::{PowerConfiguration, RcpHolder, RevisionNotes, SourceControl, Version};
use rss::small;
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::payloads(&[Version, RevisionNotes, PowerConfiguration, RcpHolder, SourceControl]), |bytes| {
    check::record::<small::Version<'_>>(bytes);
    check::record::<small::RevisionNotes<'_>>(bytes);
    check::record::<small::PowerConfiguration>(bytes);
    check::record::<small::RcpHolder>(bytes);
    check::record::<small::SourceControl<'_>>(bytes);
});
