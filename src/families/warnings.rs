//! What is allowed but deserves a second look.

use super::Model;
use crate::document::{Scene, SpeciesNames, Velocities, Warning};

/// Warnings about a scene that [`crate::scene::load`] accepted.
///
/// ```
/// use mesoscope::{families, scene};
///
/// assert!(families::warnings(&scene::load("dpd-fluid", &[])?).is_empty());
/// let coarse = scene::load("dpd-fluid", &["time.step=0.1".to_owned()])?;
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
    if let Some(momentum) = momentum_of_file(scene) {
        let components = momentum.iter().map(|sum| format!("{sum:.6}")).collect::<Vec<_>>().join(", ");
        let message =
            format!("the velocities of the file add up to a momentum of ({components}), which the run will keep");
        warn(warnings, "state.velocities", message);
    }
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

/// The momentum of the particles of a file, if it is more than rounding to single precision leaves.
fn momentum_of_file(scene: &Scene) -> Option<Vec<f64>> {
    let start = scene.start()?;
    let places = start.places.as_ref()?;
    let names = SpeciesNames::of(scene);
    let mass =
        |name: &&str| scene.particles.iter().find(|group| group.species == **name).map_or(0.0, |group| group.mass);
    let masses: Vec<f64> = names.names().iter().map(mass).collect();
    let copies: f64 = start.copies.iter().map(|copies| f64::from(*copies)).product();
    let mut total = vec![0.0; scene.space.lengths.len()];
    let mut scale = 0.0;
    for (velocity, species) in places.velocities.iter().zip(&start.species) {
        for (sum, component) in total.iter_mut().zip(velocity) {
            *sum += copies * masses[usize::from(*species)] * component;
            scale += copies * masses[usize::from(*species)] * component.abs();
        }
    }
    total.iter().any(|sum: &f64| sum.abs() > 1e-6 * scale).then_some(total)
}
