//! What is allowed but deserves a second look.

use super::Model;
use crate::document::{Scene, Velocities, Warning};

/// Warnings about a scene that [`crate::scene::load`] accepted.
///
/// ```
/// use mesoscope::{families, scene};
///
/// assert!(families::warnings(&scene::load("dpd-fluid", &[])?).is_empty());
/// let coarse = scene::load("dpd-fluid", &["time.step=0.5".to_owned()])?;
/// assert!(families::warnings(&coarse).iter().any(|warning| warning.path == "time.step"));
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn warnings(scene: &Scene) -> Vec<Warning> {
    Model::new(scene).warnings(scene)
}

pub(super) fn warn(warnings: &mut Vec<Warning>, path: impl Into<String>, message: String) {
    warnings.push(Warning { path: path.into(), message });
}

pub(super) fn warn_of_momentum(scene: &Scene, warnings: &mut Vec<Warning>) {
    let mut total = vec![0.0; scene.space.lengths.len()];
    let mut scale = 0.0;
    for group in &scene.particles {
        let Velocities::Listed { velocities } = &group.velocities else { continue };
        for velocity in velocities {
            for (sum, component) in total.iter_mut().zip(velocity) {
                *sum += group.mass * component;
                scale += group.mass * component.abs();
            }
        }
    }
    if total.iter().any(|sum: &f64| sum.abs() > 1e-9 * scale) {
        let components = total.iter().map(|sum| format!("{sum:.6}")).collect::<Vec<_>>().join(", ");
        let message = format!("the listed velocities add up to a momentum of ({components}), which the run will keep");
        warn(warnings, "particles", message);
    }
}
