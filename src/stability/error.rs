//! What can go wrong with a map of stability as a whole.

use crate::gpu::GpuError;
use crate::output::OutputError;
use crate::run::RunError;
use crate::scene::SceneError;
use std::path::PathBuf;

/// A failure of a map. A scene that becomes unstable is a result and no failure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StabilityError {
    /// What is asked for is not said as it should be; all mistakes.
    #[error("{}", mistakes.join("\n"))]
    Arguments {
        /// All mistakes.
        mistakes: Vec<String>,
    },
    /// There is no such scene, or it is not accepted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The summary does not fit what was asked for.
    #[error(
        "`{}` was changed: its scenes are not those that were asked for; restore it, or make the map again with --force",
        crate::printable::path(path)
    )]
    Changed {
        /// The summary.
        path: PathBuf,
    },
    /// There is no map in the directory.
    #[error("there is no map of stability in `{}`: it has no stability.json", crate::printable::path(path))]
    NoMap {
        /// The directory.
        path: PathBuf,
    },
    /// It would take very long, and nobody said that it may.
    #[error(
        "all runs together would take about {expected}: pass --yes to run them, or shorten them with --set time.steps=N or a narrower range"
    )]
    Long {
        /// The estimate, in words.
        expected: String,
    },
    /// It was asked to stop before its end.
    #[error("interrupted; `mesoscope stability --resume {}` goes on", crate::printable::path(directory))]
    Interrupted {
        /// The directory.
        directory: PathBuf,
    },
    /// The adapter cannot be used.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A file cannot be written or read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A run failed for a reason that says nothing about its scene.
    #[error("`{name}`: {source}")]
    Run {
        /// What distinguishes the run.
        name: String,
        /// Why it failed.
        source: Box<RunError>,
    },
}
