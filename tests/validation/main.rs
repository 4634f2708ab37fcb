//! Long runs and other programs: `make validate`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod channels;
mod errors;
mod many_body;
mod micelles;
mod phases;
mod published;
mod readers;
mod shear;
mod states;
