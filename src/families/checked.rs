//! A scene with its model.

use super::{Model, TimeAxis};
use crate::document::{Scene, Warning};
use crate::plan::Plan;
use serde::{Serialize, Serializer};
use std::ops::Deref;
use std::sync::Arc;

/// A scene without mistakes, which it reads as, and the model that was made of it. Nothing changes either; clones share them.
///
/// ```
/// use mesoscope::scene;
///
/// let checked = scene::load("dpd-fluid", &[])?;
/// assert_eq!((checked.temperature, checked.model().particle_count()), (1.0, 24_000));
/// // A scene that has been changed is checked again.
/// let mut cold = checked.into_scene();
/// cold.temperature = -1.0;
/// let refusal = cold.check().unwrap_err();
/// assert!(refusal.to_string().contains("temperature: found -1"));
/// # Ok::<(), scene::SceneError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Checked(Arc<Content>);

#[derive(Debug, Clone)]
struct Content {
    scene: Scene,
    model: Model,
    notices: Vec<Warning>,
}

impl Checked {
    /// A scene that the caller has checked, or is about to, with its model.
    pub(crate) fn presumed(scene: Scene) -> Self {
        let model = Model::new(&scene);
        Self(Arc::new(Content { scene, model, notices: Vec::new() }))
    }

    /// The same with a change that leaves it without mistakes; notices of the scene before do not hold any more.
    pub(crate) fn changed(self, change: impl FnOnce(&mut Scene)) -> Self {
        let mut scene = self.into_scene();
        change(&mut scene);
        Self::presumed(scene)
    }

    /// The same with what was done to the scene that somebody wrote.
    pub(crate) fn noting(self, notices: Vec<Warning>) -> Self {
        Self(Arc::new(Content { notices, ..Arc::unwrap_or_clone(self.0) }))
    }

    /// The same with other times of steps.
    pub(crate) fn with_times(self, times: TimeAxis) -> Self {
        let mut content = Arc::unwrap_or_clone(self.0);
        content.model.time = times;
        Self(Arc::new(content))
    }

    /// The same after parts of a run that counted turns around the box, or did not.
    pub(crate) fn after_turns(self, counted: bool) -> Self {
        let mut content = Arc::unwrap_or_clone(self.0);
        content.model.after_turns = counted;
        Self(Arc::new(content))
    }

    /// The parts of the scene that were shortened to suit its number of steps, and those of its file that are not used.
    #[must_use]
    pub fn notices(&self) -> &[Warning] {
        &self.0.notices
    }

    /// The model of the scene.
    #[must_use]
    pub fn model(&self) -> &Model {
        &self.0.model
    }

    /// Rows of `check`, name by name, beside those that all families have; `cells` are those of the plan in words.
    #[must_use]
    pub fn description(&self, plan: &Plan, cells: &str) -> Vec<(&'static str, String)> {
        self.model().physics().description(self, plan, cells)
    }

    /// The particles of a file or of molecules, and the interactions that act on each species, name by name.
    #[must_use]
    pub fn composition(&self) -> Vec<(&'static str, String)> {
        self.model().physics().composition(self)
    }

    /// Choices that take time and change nothing that is likely to be measured, in words.
    #[must_use]
    pub fn unneeded(&self) -> Vec<String> {
        self.model().physics().unneeded(self)
    }

    /// The scene, to be changed.
    #[must_use]
    pub fn into_scene(self) -> Scene {
        Arc::unwrap_or_clone(self.0).scene
    }
}

impl Deref for Checked {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.0.scene
    }
}

impl PartialEq for Checked {
    fn eq(&self, other: &Self) -> bool {
        self.0.scene == other.0.scene
    }
}

impl Serialize for Checked {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        Scene::serialize(self, serializer)
    }
}
