//! Stochastic mesoscale particle simulations on any GPU through wgpu.
//!
//! A [`scene`] is what the user wrote, typed and checked. A model of one of the [`families`] is the physics it asks for in numbers.
//! A [`plan`] is pure data: the kernels, constants and buffers this scene needs, in order. The [`engine`] executes a
//! plan on an adapter opened by [`gpu`]. [`measure`] turns integer sums into averages with errors, [`output`] and
//! [`plot`] write what the user sees. A [`study`] is many runs that differ in a few values: a [`sweep`],
//! a [`tradeoff`], a map of [`stability`]. [`families::reference`] is the
//! plain float64 implementation every kernel is tested against.
//!
//! All of these in a small run; [`mod@run`] does the same in two lines, and writes files:
//!
//! ```
//! use mesoscope::gpu::AdapterChoice;
//! use mesoscope::plan::{Hardware, Options};
//! use mesoscope::run::{adapter_for, plan};
//! use mesoscope::{engine::Engine, measure, scene};
//!
//! let small = ["space.box=[4,4,4]", r#"output={"energies": {"every": 10}}"#].map(str::to_owned);
//! let scene = scene::load("dpd-fluid", &small)?;
//! let model = scene.model();
//! let state = mesoscope::families::initial_state(&scene);
//!
//! let gpu = adapter_for(&scene, &AdapterChoice::Best)?;
//! let plan = plan(&scene, Hardware::from(&gpu), Options::default());
//! let mut engine = Engine::new(&gpu, plan, &state)?;
//! engine.advance(300, 100)?;
//! let samples = engine.finish()?;
//! let rows = samples.iter().map(|sample| measure::observables_of(sample, engine.plan(), model));
//! let settled: Vec<f64> = rows.filter(|row| row.step >= 100).map(|row| row.kinetic_temperature()).collect();
//!
//! let temperature = measure::statistics::estimate(&settled).ok_or("there is no row to average")?;
//! assert_eq!(temperature.samples, 21);
//! assert!((temperature.value - 1.0).abs() < 0.1, "{temperature:?}");
//! assert_eq!(engine.reported()?.total_momentum(), [0; 3]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A program that may come to run on the software adapter is best started with the variables of [`gpu::driver_environment`].

pub mod calibration;
mod document;
pub mod engine;
pub mod families;
pub mod gpu;
mod host_memory;
#[cfg(test)]
mod layers;
pub mod measure;
pub mod noise;
pub mod numbers;
pub mod output;
pub mod plan;
pub mod plot;
mod prediction;
pub mod prelude;
pub mod printable;
pub mod quantity;
pub mod ranks;
pub mod report;
pub mod run;
pub mod scene;
pub mod self_test;
pub mod shaders;
pub mod stability;
pub mod state;
pub mod state_file;
pub mod study;
pub mod sweep;
pub mod table;
pub mod tessellation;
pub mod tradeoff;

pub use run::Simulation;

/// The examples of the documentation compile.
#[cfg(doctest)]
#[doc = include_str!("../docs/guide/library.md")]
struct LibraryPage;
