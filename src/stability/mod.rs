//! How far a scene may go: a map of where runs are right, biased, or unstable.
//!
//! A [`Request`] varies one key of a scene along a row, and another from row to row. A [`StabilityRun`] runs all scenes in
//! memory over the same simulated time, compares what they measure with what laws say (the temperature of the bath, an energy
//! that does not drift) or the user, and halves the distance between neighbours that differ until every edge is located. Where
//! [laws](crate::families::limits) bound the scene it says where, and where they and the measurement part. It leaves a table
//! (`stability.csv`), a summary (`stability.json`), a map (`stability.png`) and a page in words (`stability.md`).
//!
//! ```
//! use mesoscope::gpu::AdapterChoice;
//! use mesoscope::stability::{Request, StabilityRun, Verdict};
//!
//! # let directory = tempfile::tempdir()?;
//! # let results = directory.path().join("map");
//! let small = ["space.box=[4,4,4]", "time.equilibration=20", "time.steps=100", "output={}"].map(str::to_owned);
//! let request = Request::load("dpd-fluid", &small, None, &["time.step=0.02..2/3".to_owned()])?.with_bisections(1);
//! let outcome = StabilityRun::start(request, &results).execute(&AdapterChoice::Best, &mut |_| {})?;
//! let row = &outcome.summary.rows[0];
//! assert_ne!(row.cells[row.cells.len() - 1].verdict, Verdict::Right, "no fluid is right with a step of 2");
//! assert!(row.edges().iter().all(|edge| edge.low < edge.high) && results.join("stability.png").exists());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bounds;
mod cell;
mod chart;
pub mod files;
mod page;
mod range;
mod request;
mod run;
mod summary;
mod table;
mod verdict;

pub use bounds::Bound;
pub use cell::Cell;
pub use range::Spacing;
pub use request::Request;
pub use run::{Bisecting, StabilityRun};
pub use summary::{Edge, Row, StabilitySummary};
pub use verdict::Verdict;
