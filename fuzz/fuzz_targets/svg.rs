//! Drawings as SVG of SLC text with itself as documentation.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::files("SLC"), rungs_fuzz::check::svg);
