//! Whole files.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::files("RSS"), rungs_fuzz::check::container);
