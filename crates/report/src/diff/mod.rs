//! Two programs side by side: what both dialects offer, and the page that shows a difference.

mod drawing;
mod page;
mod rows;
mod side;
mod text;
mod words;

pub use page::{Comparison, Entry, Shown, index, page};
pub use rows::{Chapter, Row, chapters};
pub use side::{Part, Side};
pub use text::{Stretch, stretches};
pub use words::sentence;
