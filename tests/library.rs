//! The library: one program, which compiles and links once what its modules share.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod combinations;
mod determinism;
mod extremes;
mod physics;
mod pictures;
mod reference;
mod support;
mod validation;
