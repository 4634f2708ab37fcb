//! What is allowed but deserves a second look.

use crate::document::{Scene, SpeciesNames, Velocities, Warning, number_of_copies};
use crate::families::Checked;

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
pub fn warnings(scene: &Checked) -> Vec<Warning> {
    let of_part = |part: &Checked| part.model().physics().warnings(part);
    let mut found = of_part(scene);
    let ends = scene.ends_of_stages();
    for part in scene.parts().unwrap_or_default() {
        let stage = ends.iter().filter(|end| **end <= part.model().time.step).count().saturating_sub(1);
        // Numbers in a message differ along a ramp.
        let known: Vec<String> = found.iter().map(|warning| warning.path.clone()).collect();
        let is_new = |path: &String| !known.iter().any(|known| known == path || known.ends_with(&format!("]: {path}")));
        let new = of_part(&part).into_iter().filter(|warning| is_new(&warning.path));
        found.extend(new.map(|warning| Warning { path: format!("stages[{stage}]: {}", warning.path), ..warning }));
    }
    found
}

pub(super) fn warn(warnings: &mut Vec<Warning>, path: impl Into<String>, message: String) {
    warnings.push(Warning { path: path.into(), message });
}

/// Warns of a momentum that the velocities of a file or of a list add up to.
pub(super) fn warn_of_momentum(scene: &Scene, warnings: &mut Vec<Warning>) {
    let listed = scene.particles.iter().filter_map(|group| match &group.velocities {
        Velocities::Listed { velocities } => Some(velocities.iter().map(|velocity| (group.mass, velocity.as_slice()))),
        _ => None,
    });
    // Velocities of a file may have been rounded to single precision.
    let of_file = momentum(scene, momenta_of_file(scene).into_iter().flatten(), 1e-6);
    for (path, which, momentum) in [
        ("state.velocities", "velocities of the file", of_file),
        ("particles", "listed velocities", momentum(scene, listed.flatten(), 1e-9)),
    ] {
        let Some(momentum) = momentum else { continue };
        let components = momentum.iter().map(|sum| format!("{sum:.6}")).collect::<Vec<_>>().join(", ");
        let message = format!("the {which} add up to a momentum of ({components}), which the run will keep");
        warn(warnings, path, message);
    }
}

/// The sum of masses times velocities, if it is more than a part of what its terms could add up to.
fn momentum<'a>(scene: &Scene, all: impl Iterator<Item = (f64, &'a [f64])>, part: f64) -> Option<Vec<f64>> {
    let mut total = vec![0.0; scene.space.lengths.len()];
    let mut scale = 0.0;
    for (mass, velocity) in all {
        for (sum, component) in total.iter_mut().zip(velocity) {
            *sum += mass * component;
            scale += mass * component.abs();
        }
    }
    total.iter().any(|sum: &f64| sum.abs() > part * scale).then_some(total)
}

/// Masses and velocities of the particles of a file, the mass of all copies together.
fn momenta_of_file(scene: &Scene) -> Option<impl Iterator<Item = (f64, &[f64])>> {
    let start = scene.start()?;
    let mass = |name: &str| scene.particles.iter().find(|group| group.species == name).map_or(0.0, |group| group.mass);
    let copies = number_of_copies(start.copies) as f64;
    let masses: Vec<f64> = SpeciesNames::of(scene).names().iter().map(|name| copies * mass(name)).collect();
    let velocities = start.places.as_ref()?.velocities.iter().zip(&start.species);
    Some(velocities.map(move |(velocity, species)| (masses[usize::from(*species)], velocity.as_slice())))
}
