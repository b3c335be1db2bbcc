//! Requests to the workbench, messages of its pages, plant files.
#![no_main]

rungs_fuzz::target!(rungs_fuzz::client::seeds(), rungs_fuzz::client::client);
