//! What a run has to do, and how it ends early.

use super::RunError;
use super::interrupt::Interrupt;
use crate::families::Checked;
use crate::output::{Checkpoint, Id, OutputError, RunDirectory, Summary, checkpoint, files};

/// What stays the same if a run has to go back.
pub(super) struct Task {
    pub id: Id,
    pub scene: Checked,
    pub directory: RunDirectory,
    pub interrupt: Interrupt,
    /// What was done to the scene before the run.
    pub notices: Vec<String>,
    /// A warning of a graphics card that no driver offers.
    pub unseen: Option<String>,
    /// Whether ranks may compute differently.
    pub mixed: bool,
    /// True if pictures are drawn.
    pub draws: bool,
    /// What `run.json` says of an earlier part of the run.
    pub earlier: Option<Box<Summary>>,
}

impl Task {
    /// The last checkpoint on disk; the start itself if nothing was saved since.
    pub(super) fn last_checkpoint(&self, start: Checkpoint) -> Result<Checkpoint, RunError> {
        let path = self.directory.file(files::CHECKPOINT);
        if path.exists() || start.state.positions.is_empty() { Ok(checkpoint::load(&path)?) } else { Ok(start) }
    }

    /// Stops if the run is asked to, with a checkpoint of this step on disk.
    pub(super) fn obey(&self, checkpoint_step: u64) -> Result<(), RunError> {
        if self.interrupt.is_asked() {
            let checkpoint = self.directory.file(files::CHECKPOINT);
            return Err(RunError::Interrupted { checkpoint, checkpoint_step });
        }
        Ok(())
    }

    /// Adds to a failure to write what is left to continue from.
    pub(super) fn stopped(&self, error: RunError, checkpoint_step: u64) -> RunError {
        let checkpoint = self.directory.file(files::CHECKPOINT);
        match error {
            // No checkpoint restores what is lost.
            RunError::Output(source) if checkpoint.exists() && !matches!(source, OutputError::Lost { .. }) => {
                RunError::Stopped { source, checkpoint, checkpoint_step }
            }
            error => error,
        }
    }
}
