//! `IO CONFIGURATION`.
#![no_main]

use rss::{StreamKind, io::IoConfiguration};
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::payloads(&[StreamKind::IoConfiguration]), |bytes| {
    let io = check::record::<IoConfiguration<'_>>(bytes).value;
    let _ = (io.slots(), io.total_words());
});
