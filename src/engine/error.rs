//! What can go wrong while a plan runs.

use crate::gpu::GpuError;

/// A failure of a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EngineError {
    /// The graphics layer failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The simulation left the range where its numbers mean anything.
    #[error("the run became unstable at step {step}: {quantity}; {}", advice(*.suggested_step))]
    Unstable {
        /// The first step at which it was seen.
        step: u64,
        /// What went out of range.
        quantity: String,
        /// A time step worth trying, where that is what helps.
        suggested_step: Option<f64>,
    },
    /// More particles at the ends of rows than there is room to copy, or in a bin than it holds.
    #[error("at step {step} the particles crowd so much that they do not fit the memory planned for them")]
    Crowded {
        /// The first step at which it was seen.
        step: u64,
    },
    /// The adapter left a loop before its end, as software adapters do after some 65 000 turns.
    #[error(
        "at step {step} so many particles crowd in one place, or make one chain, that the adapter {adapter} gave up looking \
         through them; another adapter, particles further apart, or shorter chains, will do"
    )]
    GaveUp {
        /// The first step at which it was seen.
        step: u64,
        /// The name of the adapter.
        adapter: String,
    },
    /// A state that does not fit the plan.
    #[error("the state does not fit the plan: {reason}")]
    State {
        /// What does not fit.
        reason: String,
    },
}

/// The largest number of one digit not above `value`.
pub(super) fn round_down(value: f64) -> f64 {
    let magnitude = 10_f64.powf(value.log10().floor());
    let rounded = (value / magnitude).floor() * magnitude;
    format!("{rounded:.0e}").parse().unwrap_or(rounded)
}

fn advice(suggested_step: Option<f64>) -> String {
    match suggested_step {
        Some(step) => format!("try a time step of {step} or less"),
        None => {
            "no time step helps: give more particles a cell, a smoothing of another length, or the five-point symbol"
                .to_owned()
        }
    }
}
