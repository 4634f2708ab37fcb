//! Body forces of a scene.

use super::{BodyForces, FixedImpulse};
use crate::document::{BodyForceInteraction, ForceProfile, Interaction, Problems, Scene, SpeciesNames};
use crate::families::particles::combinations::Feature;
use crate::families::particles::composition::all_particles;
use crate::families::particles::terms::SceneTerm;
use crate::families::{Checked, Particles, Species};

/// The largest impulse of half a step in units of momentum: several of them still fit the integers.
const LARGEST: f64 = (1_u64 << 27) as f64;

impl SceneTerm for BodyForceInteraction {
    fn acts(&self) -> bool {
        self.force.iter().any(|component| *component != 0.0)
    }

    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(if self.profile.is_uniform() { Feature::UniformForce } else { Feature::VaryingForce }, "")]
    }

    fn check(&self, scene: &Scene, names: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        let dimension = scene.space.lengths.len();
        check_length(&self.force, scene, &format!("{path}.force"), problems);
        let varies = !self.profile.is_uniform();
        match self.axis {
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
                problems.refuse(format!("{path}.axis"), format!("\"{axis}\""), accepted);
            }
            _ => {}
        }
        if let Some(waves) = self.waves.filter(|_| self.profile != ForceProfile::Sinusoidal) {
            problems.refuse(format!("{path}.waves"), waves, "no `waves`, or the profile `sinusoidal`");
        }
        for (index, name) in self.species.iter().flatten().enumerate() {
            let path = format!("{path}.species[{index}]");
            names.check(name, &path, problems);
            if scene.particles.iter().any(|group| group.species == *name && group.is_held()) {
                let found = format!("`{name}`, whose particles are fixed");
                problems.refuse(path, found, "species that can move: held particles absorb no momentum");
            }
        }
    }

    fn members(&self, _: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        Some(self.species.as_ref().map_or_else(|| all_particles(names), |species| species.join(", ")))
    }

    /// Adds its force to those of earlier interactions. What is held absorbs no momentum.
    fn add(&self, _: &Scene, species: &mut Vec<Species>, particles: &mut Particles) {
        let forces = particles.body_forces.get_or_insert_with(|| BodyForces {
            profile: self.profile,
            axis: self.axis.map_or(0, |axis| axis as usize),
            waves: self.waves.unwrap_or(1),
            turn: None,
            forces: vec![[0.0; 3]; species.len()],
        });
        let is_named = |species: &Species| self.species.as_ref().is_none_or(|names| names.contains(&species.name));
        let all = species.iter().zip(&mut forces.forces);
        for (_, force) in all.filter(|(species, _)| is_named(species) && !species.fixed) {
            for (sum, component) in force.iter_mut().zip(&self.force) {
                *sum += component;
            }
        }
    }
}

/// A vector has a component for each axis.
pub(super) fn check_length(vector: &[f64], scene: &Scene, path: &str, problems: &mut Problems) {
    let dimension = scene.space.lengths.len();
    if vector.len() != dimension {
        let found = format!("{} components", vector.len());
        problems.refuse(path, found, format!("{dimension}, one for each axis of the box"));
    }
}

/// Several add up, but vary in the same way.
pub(crate) fn check_together(scene: &Scene, problems: &mut Problems) {
    let mut ways = scene.interactions().iter().enumerate().filter_map(|(index, interaction)| match interaction {
        Interaction::BodyForce(force) => Some((index, (force.profile, force.axis, force.waves.unwrap_or(1), None))),
        Interaction::ElectricField(field) => Some((index, (ForceProfile::Uniform, None, 1, field.frequency))),
        _ => None,
    });
    let Some((earlier, known)) = ways.next() else { return };
    for (index, _) in ways.filter(|(_, way)| *way != known) {
        let found =
            format!("a body force of another profile, axis, number of waves or frequency than interactions[{earlier}]");
        let accepted = "the same for all body forces and electric fields of a scene; their strength may differ from species to species";
        problems.refuse(format!("interactions[{index}]"), found, accepted);
    }
}

/// Refuses forces whose impulses the integers of momenta do not hold, or lose.
pub(super) fn check_impulses(scene: &Checked, forces: &BodyForces, problems: &mut Problems) {
    let model = scene.model();
    let place = |name, key| Some(format!("interactions[{}].{key}", scene.places_of(name).next()?));
    let path = place("body-force", "force").or_else(|| place("electric-field", "field")).unwrap_or_default();
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
