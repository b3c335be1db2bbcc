//! Text for Do-more Designer.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::files("txt"), rungs_fuzz::check::domore_text);
