//! What can go wrong with a sweep as a whole.

use crate::gpu::GpuError;
use crate::output::OutputError;
use crate::run::RunError;
use crate::scene::SceneError;
use std::path::PathBuf;

/// A failure of a sweep; that of a single variant is recorded in [`super::VariantSummary`] instead.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// What is to be varied is not said as it should be.
    #[error("{}", mistakes.join("\n"))]
    Arguments {
        /// All mistakes.
        mistakes: Vec<String>,
    },
    /// There is no such scene, or it cannot be read.
    #[error(transparent)]
    Scene(SceneError),
    /// Variants whose scenes say something that is not accepted.
    #[error("{}", list(mistakes))]
    Variants {
        /// All mistakes.
        mistakes: Vec<Mistake>,
    },
    /// A quantity to plot that no variant measures.
    #[error("there is no quantity `{wanted}` to plot; accepted: {}", accepted.join(", "))]
    Quantity {
        /// What was asked for.
        wanted: String,
        /// The quantities that are measured.
        accepted: Vec<String>,
    },
    /// The directory holds no sweep.
    #[error("there is no sweep in `{}`: it has no sweep.json", crate::printable::path(path))]
    NoSweep {
        /// The directory.
        path: PathBuf,
    },
    /// The summary of the sweep does not fit the ids in it.
    #[error(
        "`{}` was changed: it describes other runs than those whose ids are in it; restore it, or run the sweep again with --force",
        crate::printable::path(path)
    )]
    Changed {
        /// The summary.
        path: PathBuf,
    },
    /// It was asked to stop before its end.
    #[error(
        "interrupted after {finished} of {all} variants; `mesoscope sweep --resume {}` finishes the sweep",
        crate::printable::path(directory)
    )]
    Interrupted {
        /// Variants that are finished.
        finished: usize,
        /// All variants.
        all: usize,
        /// The directory of the sweep.
        directory: PathBuf,
    },
    /// The adapter cannot be used.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A file of the sweep cannot be written or read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A plot cannot be drawn.
    #[error(transparent)]
    Run(#[from] RunError),
}

/// A mistake that some variants share.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Mistake {
    /// Names of the variants.
    pub variants: Vec<String>,
    /// What is wrong and what to do.
    pub message: String,
}

/// Mistakes beyond this number are counted, not listed.
const LISTED: usize = 12;

fn list(mistakes: &[Mistake]) -> String {
    let mut lines: Vec<String> = mistakes.iter().take(LISTED).map(ToString::to_string).collect();
    if mistakes.len() > LISTED {
        lines.push(format!("and {} more", mistakes.len() - LISTED));
    }
    lines.join("\n")
}

/// Variants beyond this number are counted, not named.
const NAMED: usize = 6;

impl std::fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<String> = self.variants.iter().take(NAMED).map(|name| format!("`{name}`")).collect();
        let noun = if self.variants.len() == 1 { "variant" } else { "variants" };
        write!(formatter, "{noun} {}", names.join(", "))?;
        if self.variants.len() > NAMED {
            write!(formatter, " and {} more", self.variants.len() - NAMED)?;
        }
        write!(formatter, ": {}", self.message)
    }
}
