//! Why a command failed, in words, with its exit code.

use std::fmt;

use mesoscope::gpu::GpuError;
use mesoscope::output::checkpoint::{CheckpointError, ContentError};
use mesoscope::output::{OutputError, files};
use mesoscope::plot::PlotError;
use mesoscope::run::RunError;
use mesoscope::scene::SceneError;
use mesoscope::study::StudyError;

/// As of other programs that an interrupt ends.
pub const INTERRUPTED: u8 = 130;

/// Why a command failed.
#[derive(Debug)]
pub struct Failure {
    exit_code: u8,
    message: String,
}

impl Failure {
    /// A wrong command line or scene: exit code 2.
    pub fn usage(message: impl Into<String>) -> Self {
        Self { exit_code: 2, message: message.into() }
    }

    /// No adapter that could run this: exit code 3.
    pub fn no_adapter(message: impl Into<String>) -> Self {
        Self { exit_code: 3, message: message.into() }
    }

    /// A run became unstable: exit code 4.
    pub fn unstable(message: impl Into<String>) -> Self {
        Self { exit_code: 4, message: message.into() }
    }

    /// Input or output failed: exit code 5.
    pub fn input_output(message: impl Into<String>) -> Self {
        Self { exit_code: 5, message: message.into() }
    }

    /// A signal asked to stop.
    pub fn interrupted(message: impl Into<String>) -> Self {
        Self { exit_code: INTERRUPTED, message: message.into() }
    }

    /// The failure of a run, in other words.
    pub fn of_run(error: &RunError, message: impl Into<String>) -> Self {
        Self { exit_code: exit_code(error), message: message.into() }
    }

    /// What stands before the message: an interruption is no error.
    pub fn prefix(&self) -> &'static str {
        if self.exit_code == INTERRUPTED { "" } else { "error: " }
    }

    /// What the process returns.
    pub fn exit_code(&self) -> u8 {
        self.exit_code
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.message)
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Read { .. } | SceneError::StateChanged { .. } => Self::input_output(error.to_string()),
            SceneError::TooManyParticles { .. } => Self::no_adapter(error.to_string()),
            SceneError::NotFound { ref name, .. } => {
                Self::usage(format!("{error}\nhint: {}", super::guidance::of_scene(name)))
            }
            SceneError::Invalid { further, .. } => Self::usage(format!(
                "{error}\n{}hint: `mesoscope schema` prints every key with its meaning, `mesoscope scenes NAME` a complete scene",
                if further { "note: further checks follow once these mistakes are mended\n" } else { "" }
            )),
            _ => Self::usage(error.to_string()),
        }
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::NoSuchAdapter { .. } => {
                Self::no_adapter(format!("{error}\nhint: `mesoscope adapters` describes them"))
            }
            GpuError::Plan { .. } => Self::usage(error.to_string()),
            _ => Self::no_adapter(error.to_string()),
        }
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::input_output(error.to_string())
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Gpu(error) => error.into(),
            RunError::Scene(error) => error.into(),
            error @ (RunError::Interrupted { .. } | RunError::NotBegun) => Self::interrupted(error.to_string()),
            RunError::Checkpoint(CheckpointError::Output(_)) => Self::input_output(format!(
                "{error}\nhint: give the directory that `mesoscope run` wrote, with its {}",
                files::CHECKPOINT
            )),
            RunError::Checkpoint(CheckpointError::Content { source: ContentError::Version { .. }, .. }) => {
                Self::input_output(error.to_string())
            }
            RunError::Checkpoint(_) => Self::input_output(format!(
                "{error}\nhint: it cannot be repaired: restore it from a copy, or run the scene again with --force"
            )),
            error => Self::of_run(&error, error.to_string()),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Scene(error) => error.into(),
            StudyError::Gpu(error) => error.into(),
            StudyError::Common(error) => error.into(),
            StudyError::Interrupted { .. } | StudyError::InterruptedShard { .. } => {
                Self::interrupted(error.to_string())
            }
            StudyError::Variants { .. } => Self::usage(format!(
                "{error}\nhint: `mesoscope schema` prints every key with its meaning; nothing has been run"
            )),
            StudyError::Arguments { .. } | StudyError::Long { .. } => Self::usage(error.to_string()),
            StudyError::Run { ref source, .. } => Self::of_run(source, error.to_string()),
            _ => Self::input_output(error.to_string()),
        }
    }
}

fn exit_code(error: &RunError) -> u8 {
    match error {
        RunError::Unstable { .. } | RunError::UnstableTrial(_) | RunError::GaveUp { .. } => 4,
        RunError::Scene(SceneError::Read { .. } | SceneError::StateChanged { .. }) => 5,
        // What the scene says about its pictures cannot be drawn; anything else is between the adapter and us.
        RunError::Scene(_)
        | RunError::Gpu(GpuError::Plan { .. })
        | RunError::Unshared { .. }
        | RunError::Undividable { .. }
        | RunError::Plot { source: PlotError::Size { .. } | PlotError::Input(_) | PlotError::TypeTooLarge, .. } => 2,
        RunError::Gpu(_) | RunError::TooLarge { .. } | RunError::Plot { .. } | RunError::Engine(_) => 3,
        _ => 5,
    }
}
