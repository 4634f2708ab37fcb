//! Why a command failed, in words, with its exit code.

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
#[derive(Debug, thiserror::Error)]
#[error("{message}")]
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

    /// The failure of a run, in other words.
    pub fn of_run(error: &RunError, message: impl Into<String>) -> Self {
        Self { exit_code: run_code(error), message: message.into() }
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

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        let advice = match &error {
            SceneError::NotFound { name, .. } => format!("\nhint: {}", super::guidance::of_scene(name)),
            SceneError::Invalid { further, .. } => format!(
                "\n{}hint: `mesoscope schema` prints every key with its meaning, `mesoscope scenes NAME` a complete \
                 scene",
                if *further { "note: further checks follow once these mistakes are mended\n" } else { "" }
            ),
            _ => String::new(),
        };
        Self { exit_code: scene_code(&error), message: format!("{error}{advice}") }
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        let unknown = matches!(error, GpuError::NoSuchAdapter { .. });
        let advice = if unknown { "\nhint: `mesoscope adapters` describes them" } else { "" };
        Self { exit_code: gpu_code(&error), message: format!("{error}{advice}") }
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Self::input_output(error.to_string())
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let advice = match error {
            RunError::Gpu(error) => return error.into(),
            RunError::Scene(error) => return error.into(),
            RunError::Checkpoint(CheckpointError::Output(_)) => {
                format!("\nhint: give the directory that `mesoscope run` wrote, with its {}", files::CHECKPOINT)
            }
            RunError::Checkpoint(CheckpointError::Content { source: ContentError::Version { .. }, .. }) => {
                String::new()
            }
            RunError::Checkpoint(_) => {
                "\nhint: it cannot be repaired: restore it from a copy, or run the scene again with --force".to_owned()
            }
            _ => String::new(),
        };
        Self::of_run(&error, format!("{error}{advice}"))
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        let exit_code = match &error {
            StudyError::Interrupted { .. } | StudyError::InterruptedShard { .. } => INTERRUPTED,
            StudyError::Variants { .. } | StudyError::Arguments { .. } | StudyError::Long { .. } => 2,
            StudyError::Run { source, .. } => run_code(source),
            _ => 5,
        };
        let advice = match error {
            StudyError::Scene(error) => return error.into(),
            StudyError::Gpu(error) => return error.into(),
            StudyError::Common(error) => return error.into(),
            StudyError::Variants { .. } => {
                "\nhint: `mesoscope schema` prints every key with its meaning; nothing has been run"
            }
            _ => "",
        };
        Self { exit_code, message: format!("{error}{advice}") }
    }
}

fn scene_code(error: &SceneError) -> u8 {
    match error {
        SceneError::Read { .. } | SceneError::StateChanged { .. } => 5,
        SceneError::TooManyParticles { .. } => 3,
        _ => 2,
    }
}

fn gpu_code(error: &GpuError) -> u8 {
    if matches!(error, GpuError::Plan { .. }) { 2 } else { 3 }
}

fn run_code(error: &RunError) -> u8 {
    match error {
        RunError::Scene(error) => scene_code(error),
        RunError::Gpu(error) => gpu_code(error),
        RunError::Unstable { .. } | RunError::UnstableTrial(_) | RunError::GaveUp { .. } => 4,
        RunError::Interrupted { .. } | RunError::NotBegun => INTERRUPTED,
        // What the scene says about its pictures cannot be drawn; anything else is between the adapter and us.
        RunError::Unshared { .. }
        | RunError::Undividable { .. }
        | RunError::Plot { source: PlotError::Size { .. } | PlotError::Input(_) | PlotError::TypeTooLarge, .. } => 2,
        RunError::TooLarge { .. }
        | RunError::Memory { .. }
        | RunError::AdapterLost { .. }
        | RunError::Plot { .. }
        | RunError::Engine(_) => 3,
        _ => 5,
    }
}
