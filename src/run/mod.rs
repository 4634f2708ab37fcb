//! Runs: from a checked scene to the files it leaves.
//!
//! A [`Run`] is started from a scene or resumed from a directory. It opens an adapter, advances the engine from
//! one event to the next (a checkpoint, a snapshot, a frame, the end), and writes what the scene asks for. It prints
//! nothing: an observer learns how far it is.
//!
//! ```
//! use mesoscope::gpu::AdapterChoice;
//! use mesoscope::output::RunDirectory;
//! use mesoscope::run::{self, Event, Run};
//!
//! # let directory = tempfile::tempdir()?;
//! # let results = directory.path().join("results");
//! let small = ["space.box=[4,4,4]", "time.equilibration=0", "time.steps=40", "output={}"].map(str::to_owned);
//! let scene = mesoscope::scene::load("dpd-fluid", &small)?;
//! let simulation = Run::start(scene, &results);
//! let outcome = simulation.execute(&AdapterChoice::Best, &mut |event: Event<'_>| {
//!     if let Event::Advanced(progress) = event {
//!         println!("step {} of {}", progress.step, progress.last_step);
//!     }
//! })?;
//! println!("{:?}", outcome.summary.means.get("temperature"));
//! assert!(outcome.files.contains(&"energies.csv") && results.join("run.json").exists());
//!
//! // Its directory is enough to continue it.
//! let longer = Run::resume(&results, Some(80))?;
//! assert_eq!((longer.first_step(), longer.is_finished()), (40, false));
//!
//! // Or to draw its pictures again, larger.
//! let directory = RunDirectory::open(&results)?;
//! let drawn = run::redraw(&directory, &AdapterChoice::Best, &["output.plot.width=1600".to_owned()])?;
//! assert!(drawn.iter().any(|name| name == "energies.png"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adapter;
mod analyses;
mod change;
mod colour_ranges;
mod conservation;
mod division;
mod energies;
mod energy_rows;
mod error;
mod execution;
mod field_arrays;
mod frame;
mod interrupt;
mod kept_sums;
mod pace;
mod pictures;
mod pilot;
mod plan;
mod runs;
mod schedule;
mod sections;
mod settling;
mod simulation;
mod sizes;
mod tally;
mod task;
mod team;
mod views;

pub use crate::scene::{Change, Rounding};
pub use adapter::{adapter_for, adapter_for_rank};
pub(crate) use analyses::circulation_change;
pub use analyses::{AskedAnalysis, asked_analyses, printed_estimate, printed_results};
pub(crate) use conservation::kept;
pub use division::{Ranks, Share, divide, share_of};
pub(crate) use energies::{quantities, read as read_energies};
pub use error::RunError;
pub use execution::Outcome;
pub use frame::Frame;
pub use interrupt::Interrupt;
pub use pictures::{lettering, redraw};
pub(crate) use pictures::{save, save_vector};
pub use pilot::{ExpectedTime, expected_time};
pub use plan::plan;
pub use runs::Run;
pub use simulation::{Frames, Simulation};
pub(crate) use simulation::{Sight, Stop};
pub use sizes::Sizes;
pub use team::{dismiss, follow, team};

use crate::gpu::AdapterDescription;
use std::time::Duration;

/// What an observer of a run receives.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum Event<'a> {
    /// The driver compiles kernels, which takes some drivers minutes when they see them for the first time.
    Compiling {
        /// Their number.
        kernels: usize,
    },
    /// The adapter is open, and files are written from now on.
    Started {
        /// The adapter.
        adapter: &'a AdapterDescription,
        /// The step the run begins with.
        first_step: u64,
        /// The step it will end with.
        last_step: u64,
    },
    /// What its user should know before it goes on.
    Warned {
        /// In words.
        warning: &'a str,
    },
    /// The device has come further.
    Advanced(Progress),
    /// The run goes back to an earlier step, to repeat the steps since with more memory or wider halos; results are the same.
    Repeating {
        /// The step it continues from.
        from: u64,
        /// Why.
        reason: &'a str,
        /// With what.
        with: &'a str,
    },
    /// Another stage begins.
    Stage {
        /// Its number, from 0.
        number: usize,
        /// The number of stages.
        of: usize,
    },
    /// All steps are done; tables and pictures follow.
    Finishing,
}

/// How far a run is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// The last step that the device has certainly done.
    pub step: u64,
    /// The step to end with.
    pub last_step: u64,
    /// Particle-steps per second since the run began; 0 as long as it is unknown.
    pub particle_steps_per_second: f64,
    /// Time that the rest will take at this rate.
    pub remaining: Option<Duration>,
    /// Kinetic temperature of the last row of the table of energies.
    pub temperature: Option<f64>,
}
