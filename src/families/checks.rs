//! What can be checked only in a scene without any other mistake: whether its time step can be stable, and its start.

use super::{Checked, initial_state, speeds};
use crate::document::{Problems, SceneError};
use crate::state::State;

/// Particles up to which a start is tried where a scene is checked; a start of more is looked at when a run makes it.
const MOST_TRIED: u64 = 20_000;

/// Whether a time step that cannot be stable is a mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StepCheck {
    /// It is refused.
    Refuse,
    /// It is what somebody wants to see.
    Allow,
}

/// All problems of a scene that makes sense otherwise.
pub(crate) fn check(scene: &Checked, step: StepCheck, problems: &mut Problems) {
    let model = scene.model();
    // Of a run that continues the places are elsewhere.
    let has_places = !scene.has_start() || scene.start().is_some_and(|start| start.places.is_some());
    let may_refuse = model.physics().may_refuse_starts() || scene.fields_of_start().is_some();
    if has_places && may_refuse && model.particle_count() <= MOST_TRIED {
        model.physics().check_start(scene, &initial_state(scene), problems);
    }
    model.physics().check_capacity(scene, problems);
    if step == StepCheck::Refuse {
        model.physics().check_step(scene, problems);
        speeds::check(scene, problems);
    }
}

/// Refuses a start of more particles than a check of the scene tries.
///
/// ```
/// use mesoscope::{families, scene};
///
/// // Springs that reach no further than 0.9 beside chains of spacing 1.
/// let spring = r#"interactions.1.potential={"type":"fene","stiffness":30,"extent":0.9,"length":0}"#;
/// let set = [spring.to_owned(), "particles.0.count=40000".to_owned(), "space.box=[40,40,40]".to_owned()];
/// let scene = scene::load("polymer-melt", &set)?;
/// let refusal = families::check_start(&scene, &mesoscope::families::initial_state(&scene)).unwrap_err();
/// assert!(refusal.to_string().contains("potential.extent: found 0.9, and a distance of "));
/// # Ok::<(), scene::SceneError>(())
/// ```
///
/// # Errors
/// [`SceneError::Invalid`] where bonds are longer than they can be, or masses beyond what integers hold.
pub fn check_start(scene: &Checked, state: &State) -> Result<(), SceneError> {
    let model = scene.model();
    let mut problems = Problems::default();
    if model.particle_count() > MOST_TRIED {
        model.physics().check_start(scene, state, &mut problems);
    }
    if problems.is_empty() {
        return Ok(());
    }
    let (problems, more) = problems.into_parts();
    Err(SceneError::Invalid { name: scene.title.clone(), problems, more, further: false })
}
