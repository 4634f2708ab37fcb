//! The scene that a study varies.

use super::variation::steps_of;
use crate::families::StepCheck;
use crate::scene::{PlotStyle, Scene, SceneError, StateFiles, WrittenScene};

/// Reads a file, or takes a built-in scene, with overrides. One of `time.steps` is a number of steps to which what is longer is shortened,
/// too.
pub(crate) fn written_scene(source: &str, set: &[String], steps: Option<u64>) -> Result<WrittenScene, SceneError> {
    let mut set = set.to_vec();
    let set_steps = steps_of(&mut set);
    Ok(WrittenScene::read(source)?.with(&set).for_steps(steps.or(set_steps)))
}

/// The look of pictures of a run of a scene, with changes to it that are given as further overrides.
pub(crate) fn style(
    scene: &WrittenScene,
    run: &Scene,
    changes: &[String],
    files: &StateFiles,
    step: StepCheck,
) -> Result<PlotStyle, SceneError> {
    if changes.is_empty() {
        return Ok(run.output.plot.clone());
    }
    Ok(scene.clone().with(changes).check_among(files, step)?.into_scene().output.plot)
}
