//! Witnesses and helpers shared by the tests over whole projects.
