//! The ladder program model: project, program files, rungs, addresses, data files, documentation.
