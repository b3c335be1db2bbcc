//! Rungs drawn as terminal text.
