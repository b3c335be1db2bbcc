//! What a comparison found.

/// Rows compared and rows that differ.
#[derive(Debug, Clone, Default)]
pub(crate) struct Outcome {
    /// Number of rows compared.
    pub(crate) rows: usize,
    /// One line for each row that differs.
    pub(crate) wrong: Vec<String>,
}

impl Outcome {
    /// Counts a row, and its place with both values if they differ.
    pub(crate) fn row<T: PartialEq + std::fmt::Debug>(&mut self, place: impl std::fmt::Display, printed: T, read: T) {
        self.rows += 1;
        if printed != read {
            self.wrong.push(format!("{place}: printed {printed:?}, read {read:?}"));
        }
    }

    /// Counts a row that is there on one side only.
    pub(crate) fn missing(&mut self, what: impl std::fmt::Display) {
        self.rows += 1;
        self.wrong.push(what.to_string());
    }
}
