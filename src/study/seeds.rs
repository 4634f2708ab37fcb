//! Seeds of independent runs of one scene.

use super::error::StudyError;
use super::written_scene::written_scene;
use crate::families::{Checked, StepCheck};
use crate::scene::StateFiles;

/// The key of a scene that makes samples of its runs.
pub(crate) const SEED: &str = "seed";

/// The most independent runs of one scene: of more, the error of their mean is known to a few per cent anyway.
pub const MOST_SEEDS: u32 = 1024;

/// The variation that makes `count` independent runs of a scene, with its own seed and those that follow.
///
/// # Errors
/// [`StudyError::Arguments`] unless there are 1 to [`MOST_SEEDS`]; [`StudyError::Scene`] when there is no such scene.
///
/// ```
/// let set = ["seed=7".to_owned()];
/// assert_eq!(mesoscope::study::variation_of_seeds("dpd-fluid", &set, 3)?, "seed=7,8,9");
/// # Ok::<(), mesoscope::study::StudyError>(())
/// ```
pub fn variation_of_seeds(scene: &str, set: &[String], count: u32) -> Result<String, StudyError> {
    check_count(count)?;
    let written = written_scene(scene, set, None)?;
    let own = written.check_among(&StateFiles::of(&written.name), StepCheck::Allow)?.seed;
    let seeds: Vec<String> = (0..count).map(|further| following(own, further).to_string()).collect();
    Ok(format!("{SEED}={}", seeds.join(",")))
}

/// Refuses numbers of seeds that no study has.
pub(crate) fn check_count(count: u32) -> Result<(), StudyError> {
    if (1..=MOST_SEEDS).contains(&count) {
        return Ok(());
    }
    Err(StudyError::mistake(format!("{count} seeds; accepted: 1 to {MOST_SEEDS}, the independent runs of each scene")))
}

/// The seed that is `further` places after another one.
fn following(seed: u64, further: u32) -> u64 {
    seed.wrapping_add(u64::from(further))
}

/// A scene with the seed that is `further` places after its own.
pub(crate) fn reseeded(scene: &Checked, further: u32) -> Checked {
    if further == 0 {
        return scene.clone();
    }
    scene.clone().changed(|scene| scene.seed = following(scene.seed, further))
}
