//! What a caller can look at while a program runs: for traces, coverage and proofs.

use crate::memory::Num;

/// Is told what each operation did. `operation` is what [`super::Program::site`] takes.
pub trait Watch {
    /// A rung begins.
    fn rung(&mut self, operation: u32) {
        let _ = operation;
    }
    /// A contact or stage was examined: whether it passes power, inversion included.
    fn contact(&mut self, operation: u32, on: bool) {
        let _ = (operation, on);
    }
    /// Two values were compared.
    fn compare(&mut self, operation: u32, a: Num, b: Num, on: bool) {
        let _ = (a, b);
        self.contact(operation, on);
    }
    /// A coil or box was executed with this power flow; of a box with several legs the lowest.
    fn power(&mut self, operation: u32, on: bool) {
        let _ = (operation, on);
    }
}

/// Looks at nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoWatch;

impl Watch for NoWatch {}
