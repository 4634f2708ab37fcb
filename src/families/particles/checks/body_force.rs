//! Checks of body forces that a schema cannot express.

use crate::document::{BodyForceInteraction, ForceProfile, Interaction, Problems, Scene, SpeciesNames};
use crate::families::Model;
use crate::families::particles::model::{BodyForces, FixedImpulse};

/// The largest impulse of half a step in units of momentum: several of them still fit the integers.
const LARGEST: f64 = (1_u64 << 27) as f64;

/// Checks one by itself.
pub(super) fn check(
    scene: &Scene,
    names: &SpeciesNames<'_>,
    force: &BodyForceInteraction,
    path: &str,
    problems: &mut Problems,
) {
    let dimension = scene.space.lengths.len();
    if force.force.len() != dimension {
        let found = format!("{} components", force.force.len());
        problems.refuse(format!("{path}.force"), found, format!("{dimension}, one for each axis of the box"));
    }
    let varies = !force.profile.is_uniform();
    match force.axis {
        None if varies => {
            let accepted = "an `axis` along which the force varies: \"x\", \"y\" or \"z\"";
            problems.refuse(format!("{path}.axis"), "none", accepted);
        }
        Some(_) if !varies => {
            let accepted =
                "no `axis`, or the profile `opposed` or `sinusoidal`: a uniform force is the same along all axes";
            problems.refuse(format!("{path}.axis"), "one", accepted);
        }
        Some(axis) if axis as usize >= dimension => {
            let accepted = format!("one of the {dimension} axes of the box");
            problems.refuse(format!("{path}.axis"), format!("\"{}\"", axis.name()), accepted);
        }
        _ => {}
    }
    if let Some(waves) = force.waves.filter(|_| force.profile != ForceProfile::Sinusoidal) {
        problems.refuse(format!("{path}.waves"), waves, "no `waves`, or the profile `sinusoidal`");
    }
    for (index, name) in force.species.iter().flatten().enumerate() {
        let path = format!("{path}.species[{index}]");
        names.check(name, &path, problems);
        if scene.particles.iter().any(|group| group.species == *name && group.is_held()) {
            let found = format!("`{name}`, whose particles are fixed");
            problems.refuse(path, found, "species that can move: what is held takes up no momentum");
        }
    }
}

/// Several add up, but vary in the same way.
pub(super) fn check_together(scene: &Scene, problems: &mut Problems) {
    let mut first: Option<(usize, &BodyForceInteraction)> = None;
    for (index, interaction) in scene.interactions.iter().enumerate() {
        let Interaction::BodyForce(force) = interaction else { continue };
        let Some((earlier, known)) = first else {
            first = Some((index, force));
            continue;
        };
        let way = |force: &BodyForceInteraction| (force.profile, force.axis, force.waves.unwrap_or(1));
        if way(force) != way(known) {
            let found =
                format!("a body force of another profile, axis or number of waves than interactions[{earlier}]");
            let accepted = "the same for all body forces of a scene; their strength may differ from species to species";
            problems.refuse(format!("interactions[{index}]"), found, accepted);
        }
    }
}

/// Refuses forces whose impulses the integers of momenta do not hold, or lose.
pub(in crate::families::particles) fn check_impulses(
    scene: &Scene,
    model: &Model,
    forces: &BodyForces,
    problems: &mut Problems,
) {
    let place = |interaction: &Interaction| matches!(interaction, Interaction::BodyForce(_));
    let path = format!("interactions[{}].force", scene.interactions.iter().position(place).unwrap_or(0));
    let most = LARGEST * model.units.momentum / (0.5 * model.time_step);
    let least = model.units.momentum / (0.5 * model.time_step) / FixedImpulse::FRACTIONS * 256.0;
    for (species, force) in model.species.iter().zip(&forces.forces) {
        for component in force.iter().filter(|component| **component != 0.0) {
            let wrong = if component.abs() >= most {
                format!("less than {most:.3e}, whose impulse of half a step integer momenta hold")
            } else if component.abs() < least {
                format!("at least {least:.3e}, of which half a step gives 2^-24 of a unit of momentum; or no force")
            } else {
                continue;
            };
            problems.refuse(&path, format!("{component:e} on a particle of species `{}`", species.name), wrong);
        }
    }
}
