//! Compiled code of one instruction.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::seed::codes(), rungs_fuzz::check::compiled_code);
