//! `CHANNEL CONFIGURATION`.
#![no_main]

use rss::channel::ChannelConfiguration;
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::channels(), |bytes| {
    for channel in check::record::<ChannelConfiguration<'_>>(bytes).value.channels {
        let _ = (channel.general(), channel.serial(), channel.ethernet(), channel.records().count());
    }
});
