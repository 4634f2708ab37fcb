//! What can go wrong with a tradeoff as a whole.

use crate::gpu::GpuError;
use crate::output::OutputError;
use crate::run::RunError;
use crate::scene::SceneError;
use crate::sweep::SweepError;
use std::path::PathBuf;

/// A failure of a tradeoff. A variant that becomes unstable is a result and no failure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum TradeoffError {
    /// What is asked for is not said as it should be; all mistakes.
    #[error("{}", mistakes.join("\n"))]
    Arguments {
        /// All mistakes.
        mistakes: Vec<String>,
    },
    /// What is to be varied, or the scene, is not accepted.
    #[error(transparent)]
    Sweep(#[from] SweepError),
    /// A variant makes no scene over the common stretch of time.
    #[error("variant `{variant}`: {source}")]
    Variant {
        /// Its name.
        variant: String,
        /// What is wrong with it.
        source: SceneError,
    },
    /// The summary does not fit what was asked for.
    #[error(
        "`{}` was changed: its runs are not those that it was asked for; restore it, or run the tradeoff again with --force",
        crate::printable::path(path)
    )]
    Changed {
        /// The summary.
        path: PathBuf,
    },
    /// There is no tradeoff in the directory.
    #[error("there is no tradeoff in `{}`: it has no tradeoff.json", crate::printable::path(path))]
    NoTradeoff {
        /// The directory.
        path: PathBuf,
    },
    /// It would take very long, and nobody said that it may.
    #[error("all runs together would take about {expected}: pass --yes to run them, or --budget to shorten them")]
    Long {
        /// The estimate, in words.
        expected: String,
    },
    /// It was asked to stop before its end.
    #[error("interrupted; `mesoscope tradeoff --resume {}` goes on", crate::printable::path(directory))]
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
        /// The name of the run.
        name: String,
        /// Why it failed.
        source: Box<RunError>,
    },
}
