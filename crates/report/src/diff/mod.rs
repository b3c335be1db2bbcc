//! Two programs side by side: what both dialects offer, and the page that shows a difference.

mod side;

pub use side::{Part, Side};
