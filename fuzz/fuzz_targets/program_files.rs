//! `PROGRAM FILES`.
#![no_main]

use rss::program::ProgramFiles;
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::programs(), |bytes| {
    check::record::<ProgramFiles<'_>>(bytes);
});
