//! JSON projects.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::documents(), rungs_fuzz::check::json);
