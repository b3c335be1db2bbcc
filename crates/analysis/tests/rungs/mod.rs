//! Programs of a few rungs, with the data files of the motor example.

use ladder::Image;

/// The motor example, its program still in it.
pub(crate) fn motor() -> Image {
    let motor = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/motor/motor.SLC");
    let bytes = std::fs::read(motor).expect("the example is there");
    convert::open(&bytes, "motor.SLC", rss::Mode::Permissive).expect("reads").main
}

/// `image` with these rungs for its only program.
pub(crate) fn with<T: AsRef<str>>(mut image: Image, rungs: &[T]) -> Image {
    let family = Some(image.processor.family);
    let file = image.program_files.iter_mut().find(|file| file.number == 2).expect("a main program");
    let end = file.rungs.pop().expect("an END rung");
    let rung = |text: &T| convert::slc::rung::parse_rung(text.as_ref(), family).expect("a rung");
    file.rungs = rungs.iter().map(rung).collect();
    file.rungs.push(end);
    image.program_files.retain(|file| file.number <= 2);
    image
}
