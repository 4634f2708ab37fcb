//! What can go wrong with a study as a whole.

use super::kind::Kind;
use super::shard::Shard;
use crate::gpu::GpuError;
use crate::output::OutputError;
use crate::printable;
use crate::run::RunError;
use crate::scene::SceneError;
use std::path::{Path, PathBuf};

/// A failure of a study. A run that becomes unstable is one of its results.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StudyError {
    /// What is asked for is not said as it should be.
    #[error("{}", mistakes.join("\n"))]
    Arguments {
        /// All mistakes.
        mistakes: Vec<String>,
    },
    /// There is no such scene, or it is not accepted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Variants whose scenes say something that is not accepted.
    #[error("{}", shortened(mistakes, LISTED, Mistake::to_string, ["\n", "\n"]))]
    Variants {
        /// All mistakes.
        mistakes: Vec<Mistake>,
    },
    /// The directory holds no study of this kind.
    #[error("there is no {} in `{}`: {}", kind.noun, printable::path(path), lacking(path, kind))]
    Nothing {
        /// What was looked for.
        kind: &'static Kind,
        /// The directory.
        path: PathBuf,
    },
    /// The summary does not fit what it says that it was asked for.
    #[error(
        "`{}` was changed: it {}; restore it, or {} with --force",
        printable::path(path),
        reasons.join(", and it "),
        kind.again
    )]
    Changed {
        /// What it is a summary of.
        kind: &'static Kind,
        /// The summary.
        path: PathBuf,
        /// What does not fit, each to be read after "it".
        reasons: Vec<&'static str>,
    },
    /// The summary was written by a later version of the program.
    #[error(
        "`{}` was written by version {version}, which is later than this one, {}: go on with that version, or {} with --force",
        printable::path(path),
        env!("CARGO_PKG_VERSION"),
        kind.again
    )]
    Later {
        /// What it is a summary of.
        kind: &'static Kind,
        /// The summary.
        path: PathBuf,
        /// The version.
        version: String,
    },
    /// It would take very long, and nobody said that it may.
    #[error("all runs together would take {} {expected}: pass --yes to run them, or {}", kind.estimate, kind.shortened)]
    Long {
        /// What would take so long.
        kind: &'static Kind,
        /// The estimate, in words.
        expected: String,
    },
    /// It was asked to stop before its end.
    #[error("interrupted{progress}; {} {}", kind.resuming(directory), kind.resumed)]
    Interrupted {
        /// What was interrupted.
        kind: &'static Kind,
        /// How far it had come, in words; empty where it does not say.
        progress: String,
        /// Its directory.
        directory: PathBuf,
    },
    /// A shard was asked to stop before its end.
    #[error("interrupted after {finished} of {all} variants of shard {shard}; the same command goes on with it")]
    InterruptedShard {
        /// The shard.
        shard: Shard,
        /// Its variants that are finished.
        finished: usize,
        /// All of its variants.
        all: usize,
    },
    /// The directory holds a study that was asked for in another way than this shard.
    #[error(
        "`{}` is of another {} than this shard: give all shards the same scene and options, or choose another directory with --out",
        printable::path(path),
        kind.noun
    )]
    OtherStudy {
        /// The kind of study.
        kind: &'static Kind,
        /// The summary in the directory.
        path: PathBuf,
    },
    /// The adapter cannot be used.
    #[error(transparent)]
    Gpu(#[from] GpuError),
    /// A file of the study cannot be written or read.
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
    /// The scenes cannot be run on this adapter, or a picture of the study cannot be drawn.
    #[error(transparent)]
    Common(RunError),
}

impl StudyError {
    /// One mistake in what is asked for.
    pub(crate) fn mistake(mistake: impl Into<String>) -> Self {
        Self::Arguments { mistakes: vec![mistake.into()] }
    }

    /// Refuses what is asked for if there are mistakes in it.
    pub(crate) fn refuse(mistakes: Vec<String>) -> Result<(), Self> {
        if mistakes.is_empty() { Ok(()) } else { Err(Self::Arguments { mistakes }) }
    }

    /// The failure of a run of this name.
    pub(crate) fn of_run(name: &str, source: impl Into<RunError>) -> Self {
        Self::Run { name: name.to_owned(), source: Box::new(source.into()) }
    }

    /// A variant of this name that makes no scene.
    pub(crate) fn of_variant(name: &str, source: SceneError) -> Self {
        if matches!(source, SceneError::StateChanged { .. }) {
            return Self::Scene(source);
        }
        Self::Variants { mistakes: vec![Mistake { variants: vec![name.to_owned()], message: source.to_string() }] }
    }
}

impl From<RunError> for StudyError {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Gpu(error) => Self::Gpu(error),
            error => Self::Common(error),
        }
    }
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

/// What a directory lacks, and what it has instead.
fn lacking(path: &Path, kind: &Kind) -> String {
    if let Some(other) = Kind::of(path) {
        return format!("it holds a {}, and {} {}", other.noun, other.resuming(path), other.resumed);
    }
    if path.is_dir() { format!("it has no {}", kind.summary) } else { "there is no such directory".to_owned() }
}

/// Mistakes beyond this number are counted, not listed.
const LISTED: usize = 12;

/// Variants beyond this number are counted, not named.
const NAMED: usize = 6;

/// Some entries, of which those beyond a number are counted; the words about them come after `and`.
fn shortened<T>(all: &[T], most: usize, word: impl Fn(&T) -> String, [comma, and]: [&str; 2]) -> String {
    let words = all.iter().take(most).map(word).collect::<Vec<_>>().join(comma);
    if all.len() > most { format!("{words}{and}and {} more", all.len() - most) } else { words }
}

impl std::fmt::Display for Mistake {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let noun = if self.variants.len() == 1 { "variant" } else { "variants" };
        let names = shortened(&self.variants, NAMED, |name| format!("`{name}`"), [", ", " "]);
        write!(formatter, "{noun} {names}: {}", self.message)
    }
}
