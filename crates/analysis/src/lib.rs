//! Cross reference and the timer and counter report.
