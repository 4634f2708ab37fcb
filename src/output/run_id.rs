//! What tells one run from another.

use super::checkpoint::Fnv;
use crate::scene::Scene;

/// A number made of everything in a scene but for how long it runs: the same for a run and what goes on with it, another for
/// another scene or seed. It is in `run.json`; a checkpoint holds the whole scene.
///
/// ```
/// use mesoscope::output::run_id;
///
/// let scene = |set: &str| mesoscope::scene::load("dpd-fluid", &[set.to_owned()]);
/// let id = run_id(&scene("seed=1")?);
/// assert_eq!(id.len(), 16);
/// assert_eq!(run_id(&scene("time.steps=50000")?), id);
/// assert_ne!(run_id(&scene("seed=2")?), id);
/// # Ok::<(), mesoscope::scene::SceneError>(())
/// ```
#[must_use]
pub fn run_id(scene: &Scene) -> String {
    let mut endless = scene.clone();
    endless.time.steps = 0;
    let mut sum = Fnv::new();
    // A scene is numbers and text, which can always be written.
    sum.add(&serde_json::to_vec(&endless).unwrap_or_default());
    format!("{:016x}", sum.0)
}
