//! Sweeps: runs of one scene that differ in a few of its values.
//!
//! A [`Sweep`] is what the user asked for: a scene, and for some of its keys the values to try. It is expanded into
//! variants, all of which are checked before anything runs. A [`SweepRun`] executes them, each into a directory of
//! its own that is the directory of an ordinary run, and leaves a table (`sweep.csv`), a summary (`sweep.json`) and
//! for every quantity of the tables of energies one plot of all variants (`sweep-total_energy.png`).
//!
//! A variant has the same bytes as the same scene run alone: variants under way at the same time share nothing but the
//! adapter, each with a device of its own. Means over time are plotted against what is varied (`sweep-means.png`); where the
//! seed is among the keys, they are means over seeds, with errors from their scatter, and stand in `sweep-averages.csv` too.
//!
//! A [`Shard`] is a part of the variants for a process of its own ([`SweepRun::execute_shard`]), on another machine perhaps.
//!
//! ```
//! use mesoscope::gpu::AdapterChoice;
//! use mesoscope::study;
//! use mesoscope::sweep::{Look, Sweep, SweepRun, SweepSummary};
//!
//! # let directory = tempfile::tempdir()?;
//! # let results = directory.path().join("frictions");
//! let small = ["space.box=[3,3,3]", "time.equilibration=0", "time.steps=20", "output={}"].map(str::to_owned);
//! let vary = ["interactions.0.friction=1,4.5".to_owned()];
//! let asked = Sweep::load("dpd-fluid", &small, None, &vary, &[])?;
//! let look = Look { quantities: vec!["temperature".to_owned()], ..Look::default() };
//! let run = SweepRun::start(asked, &results).with_look(look);
//! let outcome = run.execute(&AdapterChoice::Best, &mut |_| {})?;
//! for variant in &outcome.summary.variants {
//!     println!("{}: {:?}", variant.name, variant.means.get("temperature"));
//! }
//! assert_eq!(outcome.files, ["sweep.csv", "sweep.json", "sweep-means.png", "sweep-temperature.png"]);
//! let wide = ["output.plot.width=1600".to_owned()];
//! assert_eq!(study::redraw::<SweepSummary>(&results, &AdapterChoice::Best, &wide)?, outcome.files[2..]);
//! assert!(outcome.failures.is_empty() && results.join("friction=4.5/run.json").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod averages;
pub mod files;
mod look;
mod means_chart;
mod observables;
mod plots;
mod run;
mod shard;
mod summary;
mod table;
mod variant;

pub use crate::study::{Setting, Shard, Sweep, Variant, Variation};
pub use averages::SeedAverage;
pub use look::Look;
pub(crate) use observables::numbers_of;
pub use run::{SweepOutcome, SweepRun};
pub use summary::SweepSummary;
pub use variant::{VariantState, VariantSummary};
