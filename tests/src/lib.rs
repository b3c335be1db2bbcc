//! Witnesses and helpers shared by the tests over whole projects.
//!
//! A witness is what RSLogix itself printed from a project. Nothing in this
//! crate that reads a witness may use our own decoder: the two meet only in
//! the tests.

pub mod axe;
pub mod book;
pub mod browser;
pub mod corpus;
pub mod dice;
pub mod drawing;
pub mod printout;
pub mod served;
pub mod svg_boxes;
