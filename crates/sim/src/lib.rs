//! A scan engine for SLC 500 and MicroLogix programs.
//!
//! [`Program::compile`] turns an [`ladder::Image`] into a flat list of operations whose addresses are
//! resolved once; [`Machine`] runs it scan by scan. The engine reads no file, no clock and no network:
//! time is an argument of [`Machine::scan`], inputs and outputs are images, partners on a network are
//! behind the [`Peer`] trait. The same inputs give the same trace on any machine.
//!
//! ```
//! use ladder::{Address, Family, Value};
//! use sim::{Machine, Options, Program};
//! use std::time::Duration;
//!
//! let rung = convert::slc::rung::parse_rung("XIC B3:0/0 TON T4:0 0.01 100 0", Some(Family::Slc503))?;
//! let image = sim::inline_image(Family::Slc503, vec![(2, vec![rung])]);
//! let options = Options { inline: true, ..Options::default() };
//! let program = Program::compile(&image, &options).map_err(|refusals| format!("{refusals:?}"))?;
//! let mut machine = Machine::new(program);
//! machine.enter_run();
//! machine.set(&Address::parse("B3:0/0")?, &Value::Bit(true))?;
//! machine.scan(Duration::ZERO);
//! machine.scan(Duration::from_millis(500));
//! assert_eq!(machine.get(&Address::parse("T4:0.ACC")?)?, Value::Word(50));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing is left out silently: what has no faithful execution is refused with its rung
//! ([`Refusal`]), or runs in an approximation that [`Program::approximations`] names.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]

mod access;
pub mod choices;
mod compile;
mod core;
mod family;
mod fault;
mod layout;
mod machine;
mod op;
mod options;
pub mod outline;
mod outside;
mod peer;
mod program;
pub mod scenario;
pub mod shared;
mod snapshot;
mod state;
pub mod status;
mod trace;
pub mod walker;

pub use access::{AccessError, Kind};
pub use choices::{Choice, Choices};
pub use fault::{FaultClass, MajorFault};
pub use machine::{Machine, Mode, ScanReport};
pub use options::{Options, Unsupported, inline_image};
pub use peer::{NoPeer, Peer, PeerAnswer, PeerRequest};
pub use program::{Approximation, Program, Refusal, Site};
pub use snapshot::RestoreError;
pub use trace::{PowerFlow, Recorder, Trace};
