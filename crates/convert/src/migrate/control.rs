//! Program flow: subroutines, jumps, returns, zones.

use super::table::{Row, row};

pub(super) const TABLE: &[Row] = &[row("LBL", |_, _, _| Ok(())), row("SBR", |_, _, _| Ok(()))];
