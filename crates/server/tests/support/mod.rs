//! Machines made of ladder text.

#![allow(dead_code, reason = "each test uses what it needs")]

pub(crate) mod wire;

use ladder::{Family, Image, Value};
use server::workbench::{Slc, Workbench};

/// A MicroLogix 1100 program whose file 2 has these rungs.
pub(crate) fn image(ladder: &[&str]) -> Image {
    let family = Family::MicroLogix1100;
    let rung = |text: &&str| convert::slc::rung::parse_rung(text, Some(family)).expect("reads");
    sim::inline_image(family, vec![(2, ladder.iter().map(rung).collect())])
}

/// It on a machine in program mode.
pub(crate) fn machine(ladder: &[&str]) -> Slc {
    let image = image(ladder);
    let options = sim::Options { inline: true, ..sim::Options::default() };
    let program = sim::Program::compile(&image, &options).expect("compiles");
    Slc::new(sim::Machine::new(program), &image)
}

/// What stands at an address.
pub(crate) fn read(bench: &Workbench, address: &str) -> Value {
    bench.state().machine.controller().read(address).expect(address)
}
