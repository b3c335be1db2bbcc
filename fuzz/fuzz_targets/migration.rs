//! Migration of SLC text to Do-more.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::files("SLC"), rungs_fuzz::check::migration);
