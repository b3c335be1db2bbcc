//! The `rungs` command: arguments in, library call, text or JSON out.

// A panic in a reader loses what was read: input must end in a value or a located error.
#![cfg_attr(not(test), warn(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::unreachable))]
// A binary has no API: `pub` only says what other modules use.
#![allow(unreachable_pub)]

mod args;
mod commands;
mod do_more;
mod files;
mod listing;
mod output;
mod scenario_loader;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let arguments = args::Arguments::parse();
    match commands::run(arguments) {
        Ok(outcome) => outcome.into(),
        // A reader that went away (`rungs show X | head`) is no failure of ours.
        Err(error) if error.is_broken_pipe() => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rungs: {}", output::printable(&error.to_string()));
            ExitCode::from(error.exit_code())
        }
    }
}
