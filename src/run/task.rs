//! What a run has to do, and how it ends early.

use super::RunError;
use super::interrupt::Interrupt;
use crate::families::Checked;
use crate::gpu::GpuError;
use crate::output::{Checkpoint, Id, OutputError, RunDirectory, Summary, checkpoint, files};
use crate::scene::part_at;

/// What stays the same if a run has to go back.
pub(super) struct Task {
    pub id: Id,
    pub scene: Checked,
    /// The scenes of its parts, in each of which all numbers are constant; the scene alone where it has no stages.
    pub parts: Vec<Checked>,
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

    /// The number of the part that begins at a step or goes on there.
    pub(super) fn part_at(&self, step: u64) -> usize {
        part_at(&self.parts, step)
    }

    /// The time of a step.
    pub(super) fn time_of(&self, step: u64) -> f64 {
        self.parts[self.part_at(step)].model().time.at(step)
    }

    /// Stops if the run is asked to, with a checkpoint of this step on disk.
    pub(super) fn obey(&self, checkpoint_step: u64) -> Result<(), RunError> {
        if self.interrupt.is_asked() {
            let checkpoint = self.directory.file(files::CHECKPOINT);
            return Err(RunError::Interrupted { checkpoint, checkpoint_step });
        }
        Ok(())
    }

    /// Adds to a failure to write, or of an adapter that is lost, what is left to continue from.
    pub(super) fn stopped(&self, error: RunError, checkpoint_step: u64) -> RunError {
        let checkpoint = self.directory.file(files::CHECKPOINT);
        match error {
            // No checkpoint restores what is lost.
            RunError::Output(source) if checkpoint.exists() && !matches!(source, OutputError::Lost { .. }) => {
                RunError::Stopped { source, checkpoint, checkpoint_step }
            }
            RunError::Gpu(source @ GpuError::Lost { .. }) if checkpoint.exists() => {
                RunError::AdapterLost { source, checkpoint, checkpoint_step }
            }
            error => error,
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    use crate::scene;

    #[test]
    fn what_is_left_to_go_on_from_is_said() {
        let directory = tempfile::tempdir().unwrap();
        let scene = scene::load("dpd-fluid", &[]).unwrap();
        let task = Task {
            id: Id::of_run(&scene),
            parts: vec![scene.clone()],
            scene,
            directory: RunDirectory::make(directory.path().to_path_buf()).unwrap(),
            interrupt: Interrupt::default(),
            notices: Vec::new(),
            unseen: None,
            mixed: false,
            draws: false,
            earlier: None,
        };
        let lost = || GpuError::Lost { adapter: "card".to_owned(), reason: "reset".to_owned() }.into();
        assert!(matches!(task.stopped(lost(), 20), RunError::Gpu(GpuError::Lost { .. })));
        std::fs::write(directory.path().join(files::CHECKPOINT), "").unwrap();
        let said = task.stopped(lost(), 20).to_string();
        for part in ["adapter `card` stopped answering: reset", "checkpoint, of step 20,", "`mesoscope resume`"] {
            assert!(said.contains(part), "{said}");
        }
    }
}
