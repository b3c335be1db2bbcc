//! The SLC 500 and MicroLogix instruction set, one place per instruction.
