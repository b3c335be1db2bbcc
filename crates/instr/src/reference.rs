//! The instruction reference page, written from the table.
