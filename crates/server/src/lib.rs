//! The local web application: a program on the workbench, watched, forced and stepped in the browser.
//!
//! [`workbench`] is what can be done with a program, without any clock or network; [`engine`] runs it in real time.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

pub mod engine;
pub mod faults;
pub mod plant;
pub mod prover;
pub mod view;
mod web;
pub mod workbench;

pub use web::{Access, Limits, Offline, PairView, serve, serve_pair};
