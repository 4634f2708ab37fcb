//! Stochastic mesoscale particle simulations on any GPU through wgpu.
//!
//! The [`prelude`] is the interface: a scene, a [`Simulation`] of it that is advanced step by step, a
//! [`Run`](prelude::Run) that writes files, and what these return. It keeps its meaning within a major version.
//!
//! ```
//! use mesoscope::prelude::*;
//!
//! let small = ["space.box=[4,4,4]", "time.equilibration=100", r#"output={"energies": {"every": 10}}"#].map(str::to_owned);
//! let scene = scene::load("dpd-fluid", &small)?;
//! let mut simulation = Simulation::new(&scene, &AdapterChoice::Best)?;
//! simulation.advance(300)?;
//! let means = simulation.means();
//! let temperature = means.iter().find(|(name, _)| *name == "temperature").and_then(|(_, mean)| *mean);
//! assert!(temperature.is_some_and(|mean| (mean.value - 1.0).abs() < 0.1), "{temperature:?}");
//! # Ok::<(), RunError>(())
//! ```
//!
//! All other modules may change with every version; `cargo doc --features internals` documents them. A `scene` is what
//! the user wrote, typed and checked. A model of one of the `families` is its physics in numbers. A `plan` is pure
//! data: the kernels, constants and buffers that the scene needs, in order. The `engine` executes a plan on an adapter
//! opened by `gpu`. `measure` turns integer sums into averages with errors, `output` and `plot` write what the user
//! sees. A `study` is many runs that differ in a few values: a `sweep`, a `tradeoff`, a map of `stability`.
//! `families::reference` is the plain float64 implementation that every kernel is tested against.
//!
//! A program that may come to run on the software adapter is best started with the variables of
//! [`driver_environment`](prelude::driver_environment).

#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod calibration;
mod document;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod engine;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod families;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod gpu;
mod host_memory;
#[cfg(test)]
mod layers;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod measure;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod noise;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod numbers;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod output;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod plan;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod plot;
mod prediction;
pub mod prelude;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod printable;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod quantity;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod ranks;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod report;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod run;
pub mod scene;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod self_test;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod shaders;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod stability;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod state;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod state_file;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod study;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod sweep;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod table;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod tessellation;
#[cfg_attr(not(feature = "internals"), doc(hidden))]
pub mod tradeoff;

pub use run::Simulation;

/// The examples of the documentation compile.
#[cfg(doctest)]
#[doc = include_str!("../docs/guide/library.md")]
struct LibraryPage;
