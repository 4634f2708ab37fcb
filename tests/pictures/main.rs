//! Pictures, drawn on the adapter of the tests and examined pixel by pixel, and those of whole runs.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod charts;
mod fields;
mod runs;
