//! Monitors and trends; the class of the root object tells which.
#![no_main]

use rss::monitors::{Monitors, Trends};
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::monitors(), |bytes| {
    check::record::<Monitors<'_>>(bytes);
    check::record::<Trends<'_>>(bytes);
});
