//! RSLogix 500's text forms: rungs as text, and whole `.SLC` project files.
//!
//! * [`rung`]: one rung between text and model.

pub mod rung;
