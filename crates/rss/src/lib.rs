//! RSLogix 500 project files: container, streams, archive objects, typed records.
