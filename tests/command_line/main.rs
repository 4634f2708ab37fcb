//! The program as its user meets it: files, bytes, messages, exit codes, and the documentation that describes them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod adapter_check;
mod documentation;
#[cfg(unix)]
mod interruption;
mod manifest;
mod molecules;
mod output;
mod particles;
mod ranks;
mod report;
mod schema;
mod seeds;
mod shallow_water;
mod shards;
mod stability;
mod states;
mod studies;
mod sweep;
mod terminal;
mod tradeoff;
mod voronoi;
