//! What can go wrong while a plan runs.

use crate::gpu::GpuError;
use crate::plan::{Failure, Options};

/// A failure of a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The graphics layer failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The simulation left the range of valid numbers; [`crate::families::Instability`] says how.
    #[error("the run became unstable at step {}", .0.step)]
    Unstable(Failure),
    /// More particles at the ends of rows than their copies have capacity for, or more in a bin than it holds.
    #[error("capacity exceeded at step {step}: more particles crowd in one place than the plan has memory for")]
    Crowded {
        /// The first step at which it was seen.
        step: u64,
    },
    /// A bond that reaches beyond what one of several ranks knows around its part.
    #[error("at step {step} a bond reaches beyond the halo of a rank")]
    Overreached {
        /// The first step at which it was seen.
        step: u64,
    },
    /// A solver needs more iterations than were recorded.
    #[error("at step {step} a solver needs more iterations than were recorded")]
    Unsolved {
        /// The first step at which it was seen.
        step: u64,
    },
    /// The adapter left a loop before its end, as software adapters do after some 65 000 iterations.
    #[error(
        "the adapter {adapter} gave up at step {step}: too many particles crowd in one place or form one chain; use another \
         adapter, particles further apart, or shorter chains"
    )]
    GaveUp {
        /// The first step at which it was seen.
        step: u64,
        /// The name of the adapter.
        adapter: String,
    },
    /// Another of the ranks that share a run is lost, or what it sends.
    #[error("{reason}")]
    Ranks {
        /// Which, and what is wrong with it.
        reason: String,
    },
    /// A state that does not fit the plan.
    #[error("the state does not fit the plan: {reason}")]
    State {
        /// What does not fit.
        reason: String,
    },
}

impl EngineError {
    /// Options with more room where an array turned out too small, a bond too long for ranks, or iterations too few; none after
    /// other errors.
    pub(crate) fn roomier(&self, options: Options, particles: u64) -> Option<Options> {
        match self {
            Self::Crowded { .. } if options.has_room_left() => Some(options.with_room(particles)),
            Self::Overreached { .. } if options.may_lengthen() => Some(options.with_longer_bonds()),
            Self::Unsolved { .. } => options.with_more_iterations(),
            _ => None,
        }
    }
}
