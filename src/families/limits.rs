//! How far laws say that a scene may go.

use super::Model;
use crate::document::Scene;

/// A law that bounds what a scene may ask for, and how near to its bound the scene is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// The law, in a few words.
    pub law: &'static str,
    /// The part of the bound that the scene takes: it grows with the time step, and is 1 at the bound.
    pub share: f64,
    /// What lies beyond.
    pub beyond: Beyond,
}

/// What lies beyond the bound of a law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Beyond {
    /// No run is stable.
    Unstable,
    /// Runs go on, but their results are known to be biased, or have not been measured.
    Biased,
}

/// The laws that bound a scene, and how near to their bounds it is.
///
/// ```
/// use mesoscope::families::{self, Beyond};
/// use mesoscope::scene;
///
/// // A standing wave of shallow water is stable while p < 1.
/// let share = |step: &str| {
///     let scene = scene::load("shallow-water", &[format!("time.step={step}")])?;
///     let limits = families::limits(&scene);
///     let unstable = limits.iter().filter(|limit| limit.beyond == Beyond::Unstable);
///     Ok::<_, scene::SceneError>(unstable.map(|limit| limit.share).fold(0.0, f64::max))
/// };
/// assert!(share("0.001")? < 1.0 && share("1")? > 1.0);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn limits(scene: &Scene) -> Vec<Limit> {
    let model = Model::new(scene);
    let mut limits = model.physics().limits(scene, &model);
    limits.retain(|limit| limit.share > 0.0);
    limits
}
