//! What can go wrong with a run.

use crate::engine::EngineError;
use crate::families::Instability;
use crate::gpu::GpuError;
use crate::numbers::{bytes, counted_in_groups};
use crate::output::OutputError;
use crate::output::checkpoint::CheckpointError;
use crate::plot::PlotError;
use crate::scene::SceneError;
use crate::shaders::Array;
use std::num::NonZero;
use std::path::PathBuf;

/// A failure of a run.
///
/// ```
/// use mesoscope::prelude::*;
///
/// let scene = scene::load("dpd-fluid", &["space.box=[4,4,4]", "output={}"].map(str::to_owned))?;
/// let mut simulation = Simulation::new(&scene, &AdapterChoice::Best)?;
/// let refused: RunError = simulation.set("time.step", 0.02).unwrap_err();
/// assert!(refused.to_string().contains("time.step"), "{refused}");
/// # Ok::<(), RunError>(())
/// ```
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RunError {
    /// The adapter cannot be used, or failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// The simulation left the range where its numbers mean anything.
    #[error(
        "{source}\nthe last good checkpoint, of step {checkpoint_step}, is kept in `{}`",
        crate::printable::path(checkpoint)
    )]
    Unstable {
        /// When, what, and a time step to try.
        source: Instability,
        /// The file of the last good checkpoint.
        checkpoint: PathBuf,
        /// Its step.
        checkpoint_step: u64,
    },
    /// Steps in memory left that range: those that were to be timed, or of a simulation that writes no checkpoint by itself.
    #[error(transparent)]
    UnstableTrial(Instability),
    /// A simulation was asked to stop. It can go on.
    #[error("interrupted at step {step}: the simulation can go on from there")]
    Paused {
        /// The step it has come to.
        step: u64,
    },
    /// A simulation has ended by an error, and can be looked at no more.
    #[error("this simulation has ended: {reason}; begin another one, from its scene or from a checkpoint of it")]
    Ended {
        /// The error.
        reason: String,
    },
    /// Arrays or numbers that do not fit a simulation.
    #[error("{}", .mistakes.join("\n"))]
    Arrays {
        /// All mistakes.
        mistakes: Vec<String>,
    },
    /// The adapter left a loop before its end.
    #[error(
        "{source}\nthe last good checkpoint, of step {checkpoint_step}, is kept in `{}`",
        crate::printable::path(checkpoint)
    )]
    GaveUp {
        /// When, and which adapter.
        source: EngineError,
        /// The file of the last good checkpoint.
        checkpoint: PathBuf,
        /// Its step.
        checkpoint_step: u64,
    },
    /// It was asked to stop before its end.
    #[error(
        "interrupted at step {checkpoint_step}; `mesoscope resume {}` continues it",
        crate::printable::path(checkpoint.parent().unwrap_or(checkpoint))
    )]
    Interrupted {
        /// The file of the checkpoint.
        checkpoint: PathBuf,
        /// Its step.
        checkpoint_step: u64,
    },
    /// It was asked to stop before its first step.
    #[error("interrupted before its first step: nothing was written")]
    NotBegun,
    /// Writing failed on the way, when there was a checkpoint already.
    #[error(
        "{source}\nthe last good checkpoint, of step {checkpoint_step}, is kept in `{}`; `mesoscope resume` continues from it",
        crate::printable::path(checkpoint)
    )]
    Stopped {
        /// What could not be written.
        source: OutputError,
        /// The file of the last good checkpoint.
        checkpoint: PathBuf,
        /// Its step.
        checkpoint_step: u64,
    },
    /// The adapter was lost on the way, when there was a checkpoint already.
    #[error(
        "{source}\nthe last good checkpoint, of step {checkpoint_step}, is kept in `{}`; `mesoscope resume` continues from it",
        crate::printable::path(checkpoint)
    )]
    AdapterLost {
        /// What became of the adapter.
        source: GpuError,
        /// The file of the last good checkpoint.
        checkpoint: PathBuf,
        /// Its step.
        checkpoint_step: u64,
    },
    /// The adapter does not allow a buffer that the scene needs.
    #[error(
        "{source}, for `{}` ({}): {}; `mesoscope check --kernels` lists all buffers",
        .buffer.name(),
        .buffer.purpose(),
        what_fits(*.fits, *.copies, *.ranks)
    )]
    TooLarge {
        /// What the adapter allows.
        source: GpuError,
        /// The largest buffer.
        buffer: Array,
        /// Particles that would fit, about.
        fits: u64,
        /// Copies of the box of a file that the scene is made of.
        copies: u64,
        /// Ranks, each with an adapter as large, that could share the scene, if it can be shared.
        ranks: Option<NonZero<u32>>,
    },
    /// The memory of this machine is too small for the particles on their way to the adapter and back.
    #[error(
        "{} take {} of the memory of this machine{}, and {} are free: fewer particles, or a machine with more memory",
        counted_in_groups(*.particles, "particle"),
        bytes(*.needed),
        if *.is_software { ", in which a software adapter computes," } else { "" },
        bytes(*.free)
    )]
    Memory {
        /// Particles of the scene.
        particles: u64,
        /// Bytes that they take at least.
        needed: u64,
        /// Bytes that are free.
        free: u64,
        /// Whether the adapter has no memory of its own.
        is_software: bool,
    },
    /// The engine refuses the state, or a buffer overflowed.
    #[error(transparent)]
    Engine(EngineError),
    /// A file of the run cannot be written or read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The checkpoint cannot be resumed from.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// Several ranks cannot share the run.
    #[error(
        "several ranks cannot share this run:\n  {}\nthey share particles with pair forces, bonds, angles and tethers, and shallow \
         water: docs/guide/ranks.md says with what",
        .reasons.join("\n  ")
    )]
    Unshared {
        /// Everything that hinders.
        reasons: Vec<String>,
    },
    /// The box cannot be divided among so many ranks.
    #[error("the box cannot be divided like this:\n  {}", .reasons.join("\n  "))]
    Undividable {
        /// Everything that hinders.
        reasons: Vec<String>,
    },
    /// A change to the scene of a run does not fit.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A picture cannot be drawn.
    #[error("cannot draw `{name}`: {source}")]
    Plot {
        /// The file it would have become.
        name: String,
        /// The reason.
        source: PlotError,
    },
}

fn what_fits(particles: u64, copies: u64, ranks: Option<NonZero<u32>>) -> String {
    let fewer = match copies {
        1 => format!("about {} fit", counted_in_groups(particles, "particle")),
        copies => format!("fewer than the {copies} copies of `state.replicate` fit"),
    };
    let shared =
        ranks.map(|ranks| format!(", or all of them on {ranks} ranks that have an adapter each (`--ranks {ranks}`)"));
    fewer + &shared.unwrap_or_default()
}

impl RunError {
    /// True if the adapter has no room for the scene.
    pub(crate) fn exceeds_adapter(&self) -> bool {
        matches!(self, Self::TooLarge { .. } | Self::Gpu(GpuError::TooSmall { .. }))
    }
}

impl From<EngineError> for RunError {
    fn from(error: EngineError) -> Self {
        match error {
            EngineError::Gpu(error) => Self::Gpu(error),
            error => Self::Engine(error),
        }
    }
}
