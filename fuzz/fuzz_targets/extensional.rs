//! `Extensional DATA FILES`.
#![no_main]

use rss::{StreamKind, data::ExtensionalDataFiles};
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::payloads(&[StreamKind::ExtensionalDataFiles]), |bytes| {
    check::record::<ExtensionalDataFiles<'_>>(bytes);
});
