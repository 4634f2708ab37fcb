//! Stochastic mesoscale particle simulations on any GPU through wgpu.
//!
//! A [`scene`] is what the user wrote, typed and checked. A [`model`] is the physics it asks for in numbers.
//! A [`plan`] is pure data: the kernels, constants and buffers this scene needs, in order. The [`engine`] executes a
//! plan on an adapter opened by [`gpu`]. [`measure`] turns integer sums into averages with errors, [`output`] and
//! [`plot`] write what the user sees. A [`sweep`] is many runs that differ in a few values. [`mod@reference`] is the
//! plain float64 implementation every kernel is tested against.

pub mod engine;
pub mod gpu;
pub mod measure;
pub mod model;
pub mod noise;
pub mod output;
pub mod plan;
pub mod plot;
pub mod reference;
pub mod run;
pub mod scene;
pub mod state;
pub mod sweep;
pub mod tessellation;

/// The Rust example of the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
