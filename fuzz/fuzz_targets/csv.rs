//! Tables of symbols.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::files("csv"), rungs_fuzz::check::csv);
