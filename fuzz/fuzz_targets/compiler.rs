//! `COMPILER`.
#![no_main]

use rss::compiler::Compiler;
use rungs_fuzz::{check, seed};

rungs_fuzz::target!(seed::compilers(), |bytes| {
    let compiler = check::record::<Compiler<'_>>(bytes).value;
    let _ = (compiler.image_start(), compiler.labels.entries());
    for model in 0..64 {
        let _ = compiler.memory.in_use(rss::processor::Model(model));
    }
});
