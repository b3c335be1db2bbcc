//! `PROCESSOR`.
#![no_main]

use rss::{StreamKind, processor::Processor};
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::payloads(&[StreamKind::Processor]), |bytes| {
    let processor = check::record::<Processor<'_>>(bytes).value;
    let _ = (processor.driver_settings(), processor.route_parts());
});
