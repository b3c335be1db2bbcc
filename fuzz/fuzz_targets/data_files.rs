//! `DATA FILES`.
#![no_main]

use rss::{StreamKind, data::DataFiles};
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::payloads(&[StreamKind::DataFiles]), |bytes| {
    check::record::<DataFiles<'_>>(bytes);
});
