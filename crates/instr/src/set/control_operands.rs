//! The control element and its length and position, as shift, stack, sequencer and ASCII instructions share them.

use ladder::FileType::R;

use crate::model::*;
use crate::row::*;

/// A control element with the members an instruction uses.
pub(super) const fn control(touches: &'static [Touch]) -> Operand {
    op("Control", Role::ReadWrite, Kind::Control).touching(touches)
}

/// LEN of the control element, shown as it was last displayed.
pub(super) const LENGTH: Operand = op("Length", Role::Parameter, Kind::Length).snapshot();
/// POS of the control element, shown as it was last displayed.
pub(super) const POSITION: Operand = op("Position", Role::Parameter, Kind::Position).snapshot();

/// Control element of an instruction that exchanges characters with a port in the background.
pub(super) const ASCII_CONTROL: Operand = control(&[
    w(R, "EN"),
    w(R, "EU"),
    w(R, "DN"),
    w(R, "EM"),
    w(R, "ER"),
    r(R, "UL"),
    w(R, "IN"),
    w(R, "FD"),
    r(R, "LEN"),
    w(R, "POS"),
]);
