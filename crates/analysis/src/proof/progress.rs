//! A proof run as seen from another thread: how far it is, and whether anybody still wants it.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Shared between a run and whoever looks on. The run never waits for it.
#[derive(Debug, Default)]
pub struct Progress {
    scans: AtomicU64,
    arguing: AtomicBool,
    shortening: AtomicBool,
    stopped: AtomicBool,
}

impl Progress {
    /// Asks the run to end. What it has seen until then is its result.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// Somebody asked for the end.
    pub fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Scans of both sides so far.
    pub fn scans(&self) -> u64 {
        self.scans.load(Ordering::Relaxed)
    }

    /// It looks for what cannot happen, and makes no scans meanwhile.
    pub fn is_arguing(&self) -> bool {
        self.arguing.load(Ordering::Relaxed)
    }

    /// A difference was found, and the way to it is being made shorter.
    pub fn is_shortening(&self) -> bool {
        self.shortening.load(Ordering::Relaxed)
    }

    pub(crate) fn at(&self, scans: u64) {
        self.scans.store(scans, Ordering::Relaxed);
    }

    pub(crate) fn argues(&self, arguing: bool) {
        self.arguing.store(arguing, Ordering::Relaxed);
    }

    pub(crate) fn shortens(&self) {
        self.shortening.store(true, Ordering::Relaxed);
    }
}
