//! Between project files, the program model, SLC text, JSON and CSV.
