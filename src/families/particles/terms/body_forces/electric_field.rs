//! An electric field of a scene: a uniform body force in proportion to the charge of each species.

use super::{BodyForces, TURN, check_length};
use crate::document::{ElectricFieldInteraction, ForceProfile, Problems, Scene, SpeciesNames};
use crate::families::particles::combinations::Feature;
use crate::families::particles::terms::SceneTerm;
use crate::families::particles::terms::electrostatics;
use crate::families::{Particles, Species};

impl ElectricFieldInteraction {
    /// The part of a turn that the field makes in a step, in 2⁻³².
    fn turn(&self, time_step: f64) -> Option<u32> {
        Some((self.frequency? * time_step * TURN).round().clamp(0.0, f64::from(u32::MAX)) as u32)
    }
}

impl SceneTerm for ElectricFieldInteraction {
    fn acts(&self) -> bool {
        self.field.iter().any(|component| *component != 0.0)
    }

    fn features(&self) -> Vec<(Feature, &'static str)> {
        vec![(Feature::UniformForce, "")]
    }

    fn check(&self, scene: &Scene, _: &SpeciesNames<'_>, path: &str, problems: &mut Problems) {
        check_length(&self.field, scene, &format!("{path}.field"), problems);
        if !scene.particles.iter().any(|group| group.charge_parts() != 0) {
            problems.refuse(path, "no particle with a charge", "a `charge` other than 0 in one of `particles`");
        }
        if let Some(frequency) = self.frequency {
            let turns = frequency * scene.time.step;
            // Impulses at either end of an oscillation that has few steps are no sample of it.
            if turns > 0.1 || (turns * TURN).round() == 0.0 {
                let accepted = format!(
                    "from {:.3e} to {:.4}, at which an oscillation has ten steps of {}",
                    0.5 / TURN / scene.time.step,
                    0.1 / scene.time.step,
                    scene.time.step
                );
                problems.refuse(format!("{path}.frequency"), frequency, accepted);
            }
        }
    }

    fn at_most_once(&self) -> Option<[&'static str; 2]> {
        Some(["acts on the same charges again", "one `electric-field`: fields add up"])
    }

    fn members(&self, scene: &Scene, names: &SpeciesNames<'_>) -> Option<String> {
        Some(electrostatics::charged_species(scene, names))
    }

    /// Adds its force to those of body forces. What is held absorbs no momentum.
    fn add(&self, scene: &Scene, species: &mut Vec<Species>, particles: &mut Particles) {
        let forces = particles.body_forces.get_or_insert_with(|| BodyForces {
            profile: ForceProfile::Uniform,
            axis: 0,
            waves: 1,
            turn: self.turn(scene.time.step),
            forces: vec![[0.0; 3]; species.len()],
        });
        let all = species.iter().zip(&mut forces.forces).filter(|(species, _)| !species.fixed);
        for (species, force) in all {
            for (sum, component) in force.iter_mut().zip(&self.field) {
                *sum += species.charge * component;
            }
        }
    }
}
