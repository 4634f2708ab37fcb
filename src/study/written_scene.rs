//! The scene that a study varies.

use super::variation::steps_of;
use crate::families::StepCheck;
use crate::scene::{self, PlotStyle, Scene, SceneError, StateFiles, Warning};
use serde::{Deserialize, Serialize};

/// A scene as it was written, and what applies to all runs of it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct WrittenScene {
    /// The name of the scene in messages.
    #[serde(rename = "scene")]
    pub name: String,
    /// Its text.
    pub text: String,
    /// Overrides of all runs.
    pub set: Vec<String>,
    /// The number of steps of the scene, to which what is longer is shortened.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub steps: Option<u64>,
}

impl WrittenScene {
    /// Reads a file, or takes a built-in scene. An override of `time.steps` is a number of steps to which what is
    /// longer is shortened, too.
    pub(crate) fn read(source: &str, set: &[String], steps: Option<u64>) -> Result<Self, SceneError> {
        let mut set = set.to_vec();
        let set_steps = steps_of(&mut set);
        let (name, text) = scene::read(source)?;
        Ok(Self { name, text, set, steps: steps.or(set_steps) })
    }

    /// The overrides of a run that has some of its own.
    pub(crate) fn overrides(&self, own: impl IntoIterator<Item = String>) -> Vec<String> {
        self.set.iter().cloned().chain(own).collect()
    }

    /// The scene of a run with overrides of its own, and what was shortened in it.
    pub(crate) fn with(
        &self,
        own: impl IntoIterator<Item = String>,
        files: &StateFiles,
        step: StepCheck,
    ) -> Result<(Scene, Vec<Warning>), SceneError> {
        scene::parse_with(files, &self.name, &self.text, &self.overrides(own), self.steps, step)
    }

    /// The look of pictures of a run with overrides of its own, and with changes to it that are given as further ones.
    pub(crate) fn style(
        &self,
        run: &Scene,
        own: impl IntoIterator<Item = String>,
        changes: &[String],
        files: &StateFiles,
        step: StepCheck,
    ) -> Result<PlotStyle, SceneError> {
        if changes.is_empty() {
            return Ok(run.output.plot.clone());
        }
        Ok(self.with(own.into_iter().chain(changes.iter().cloned()), files, step)?.0.output.plot)
    }
}
