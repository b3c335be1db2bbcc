//! What the fuzz targets share. A target is one property of [`check`] with the seeds it starts from,
//! see [`seed`]; it aborts where the property does not hold.

pub mod check;
pub mod client;
pub mod seed;

pub use libfuzzer_sys;

/// A fuzz target: its seeds, and the property that must hold for any bytes.
#[macro_export]
macro_rules! target {
    ($seeds:expr, $property:expr) => {
        $crate::libfuzzer_sys::fuzz_target!(
            init: $crate::seed::plant(module_path!(), $seeds),
            |bytes: &[u8]| $property(bytes)
        );
    };
}
