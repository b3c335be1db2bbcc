//! From an SLC 500 or MicroLogix program to a Do-more project, with a verdict for every rung.
//!
//! [`migrate()`] is a pure function of the program, a person's allocation and [`Options`]. Every rung of
//! the original becomes one rung of the result, in the same order: contacts and coils as they are, boxes
//! as what they compute, behind each other in the same power flow. What has no counterpart stands as a
//! `NOP` with the original text as its comment and a reason; nothing is left out.
//!
//! * `allocate`, `map_file`: where data lies; `facts`: what the program does with it
//! * `operand`, `emit`: operands and rungs of the result
//! * `table`: one row per instruction, in the modules of their families
//! * `control`: program files, subroutines, jumps, zones
//! * `frame`: what the program needs before its first rung and behind its last one
//! * `docs`, `initial`, `report`: documentation, data, what a person reads

pub mod allocate;
mod bits;
pub mod context;
mod control;
mod counters;
pub mod emit;
pub mod facts;
pub mod marks;
pub mod operand;
mod rung;
mod status;
mod table;
mod timers;

/// Settings of a migration.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Use only forms that Designer itself has written or read; what needs others is left to a person.
    pub only_confirmed: bool,
}
