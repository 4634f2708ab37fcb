//! What accuracy costs: variants of a scene run over the same stretch of simulated time, their errors against their cost.
//!
//! A [`Request`] says what to vary, as a [sweep](crate::sweep) does, how long to run or how small the statistical error is to
//! be, and against what to compare. A [`TradeoffRun`] runs every variant into a directory of its own, times their steps in
//! turns in one process, takes the difference of every measure from its reference, and says which choices are on the Pareto
//! front of cost and error: no other costs less and errs less. It leaves a table (`tradeoff.csv`), a summary (`tradeoff.json`), a picture of every measure
//! and a page in words (`tradeoff.md`).
//!
//! A measure is a mean of the table of energies, a number that an analysis finds, or one of those that need more than one run:
//! how far the total energy or the circulation of a loop has drifted, how often a limit has acted, and how far fields are from those of a
//! finer run or of an exact solution. Its reference is [given by the user](References), predicted (the temperature of the bath, an
//! energy that does not drift, means that are known exactly), or that of a finer run, whose own error is taken from a second one with
//! twice its time step and, where the user asks for it, a third that is finer still.
//!
//! ```
//! use mesoscope::gpu::AdapterChoice;
//! use mesoscope::tradeoff::{Length, Request, TradeoffRun};
//!
//! # let directory = tempfile::tempdir()?;
//! # let results = directory.path().join("steps");
//! let small = ["space.box=[4,4,4]", "time.equilibration=20", "time.steps=120", r#"output={"energies":{"every":2}}"#];
//! let vary = ["time.step=0.02,0.04".to_owned()];
//! let request = Request::load("dpd-fluid", &small.map(str::to_owned), None, &vary, &[])?
//!     .with_length(Length::default())
//!     .with_measures(&["temperature".to_owned()])?;
//! let outcome = TradeoffRun::start(request, &results).execute(&AdapterChoice::Best, &mut |_| {})?;
//! for choice in &outcome.summary.choices {
//!     let error = choice.errors.iter().find(|found| found.measure == "temperature");
//!     println!("{}: {:?} at {:?}", choice.label, error, choice.cost);
//! }
//! assert!(results.join("tradeoff.csv").exists() && results.join("step=0.02/run.json").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod advice;
mod assessment;
mod charts;
mod cost;
mod deviation;
mod fields;
pub mod files;
mod length;
#[cfg(test)]
mod made_up;
mod measures;
mod pareto;
mod reference;
mod request;
mod run;
mod stretch;
mod summary;
mod table;
mod target;

pub use advice::error_in_words;
pub(crate) use advice::{errors_in_words, legend_of};
pub use cost::Cost;
pub use deviation::Deviation;
pub use length::Length;
pub use measures::Measured;
pub(crate) use measures::{names_of_table, of_table, over_seeds, unknown};
pub(crate) use reference::predicted;
pub use reference::{Reference, References, Source};
pub use request::Request;
pub use run::{Phase, TradeoffRun};
pub(crate) use stretch::Stretch;
pub use summary::{Choice, ChoiceState, Float64Stretch, TradeoffSummary, Wanted};
pub use target::{Amount, Target, Verdict};
