//! Pictures, drawn on the adapter of the tests and examined pixel by pixel, and those of whole runs.

mod charts;
mod fields;
mod runs;
