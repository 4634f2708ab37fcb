//! The kernels: every variant that a scene can ask for, what compilers say of them, and the functions that they compute by themselves.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

#[path = "../support/mod.rs"]
mod support;

mod canonical;
mod compilers;
mod elementary;
mod index;
mod loops;
mod random_scenes;
mod required;
mod unchanged;
mod variants;
