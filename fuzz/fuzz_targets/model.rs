//! Projects with one stream replaced, through the model to everything made of it.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::streams(), rungs_fuzz::check::model);
