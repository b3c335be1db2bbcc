//! `MEM DATABASE`.
#![no_main]

use rss::{StreamKind, database::Database};
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::payloads(&[StreamKind::MemDatabase]), |bytes| {
    check::record::<Database<'_>>(bytes);
});
