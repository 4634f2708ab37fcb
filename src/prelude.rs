//! The types of most programs: what is named here keeps its meaning within a major version.
//!
//! ```
//! use mesoscope::prelude::*;
//!
//! let scene = scene::load("dpd-fluid", &["space.box=[4,4,4]", "output={}"].map(str::to_owned))?;
//! let mut simulation = Simulation::new(&scene, &AdapterChoice::Best)?;
//! simulation.advance(20)?;
//! let Frame { positions, .. } = simulation.frame()?;
//! assert_eq!(positions.len(), 192);
//! # Ok::<(), RunError>(())
//! ```

pub use crate::gpu::{AdapterChoice, Gpu, driver_environment};
pub use crate::measure::statistics::Estimate;
pub use crate::run::{Change, Event, Frame, Frames, Interrupt, Outcome, Rounding, Run, RunError, Simulation};
pub use crate::scene::{self, Checked, Scene, SceneError};
pub use crate::table::Table;
