//! SLC text.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::files("SLC"), rungs_fuzz::check::slc_text);
