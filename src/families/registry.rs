//! All families of models.

use super::{Model, Particles, Physics, ShallowWater, Species, Voronoi, particles, shallow_water, voronoi};
use crate::document::{Integrator, Interaction, Problem, Problems, Scene, SnapshotColor, SpeciesNames};

/// A family, with what a model of it has.
#[derive(Debug, Clone, PartialEq)]
pub enum Family {
    /// Particles with forces between them.
    Particles(Box<Particles>),
    /// Shallow water on particles and a mesh.
    ShallowWater(ShallowWater),
    /// Voronoi cells.
    Voronoi(Voronoi),
}

impl Family {
    /// The family of a scene; some add species.
    pub(super) fn of(scene: &Scene, species: &mut Vec<Species>) -> Self {
        for interaction in &scene.interactions {
            match interaction {
                Interaction::ShallowWater(water) => return Self::ShallowWater(ShallowWater::new(water, scene)),
                Interaction::Voronoi(cells) => return Self::Voronoi(Voronoi::new(cells, scene, species)),
                _ => {}
            }
        }
        Self::Particles(Box::new(Particles::new(scene, species)))
    }

    /// Its physics.
    #[must_use]
    pub(crate) fn physics(&self) -> &dyn Physics {
        match self {
            Self::Particles(particles) => particles.as_ref(),
            Self::ShallowWater(water) => water,
            Self::Voronoi(cells) => cells,
        }
    }
}

/// Checks the interactions of a scene one by one and together, and that nothing is asked for which its family does not have.
pub(crate) fn check_interactions(scene: &Scene, species: &SpeciesNames<'_>, problems: &mut Problems) {
    let of_water = |interaction: &Interaction| matches!(interaction, Interaction::ShallowWater(_));
    let first_water = scene.interactions.iter().position(of_water);
    for (index, interaction) in scene.interactions.iter().enumerate() {
        let path = format!("interactions[{index}]");
        match interaction {
            Interaction::ColouredNoise(noise) => {
                particles::checks::coloured_noise::check(scene, noise, &path, problems);
            }
            // Of a second one all has been said.
            Interaction::ShallowWater(_) if Some(index) != first_water => {}
            Interaction::ShallowWater(_) if scene.interactions.len() > 1 => {
                let accepted = "`shallow-water` as the only interaction of a scene";
                problems.push(Problem::new(&path, "found together with another interaction", accepted));
            }
            Interaction::ShallowWater(water) => {
                shallow_water::checks::check(scene, water, &path, problems);
            }
            Interaction::Dpd(dpd) => particles::checks::pairs::check(scene, species, dpd, &path, problems),
            Interaction::Voronoi(voronoi) => voronoi::checks::check(scene, voronoi, &path, problems),
            Interaction::HarmonicChain(chain) => {
                particles::checks::harmonic_chain::check(scene, chain, &path, problems);
            }
            _ => {}
        }
        particles::checks::check_interaction(scene, species, interaction, &path, problems);
    }
    particles::checks::check_scene(scene, species, problems);
    if first_water.is_none() {
        shallow_water::checks::check_absence(scene, problems);
    }
    if crate::document::voronoi(scene).is_none() {
        voronoi::checks::check_absence(scene, problems);
    }
    if particles::checks::harmonic_chain::harmonic_chain(scene).is_none() {
        particles::checks::harmonic_chain::check_absence(scene, problems);
    }
}

/// Completes what a scene leaves out and what depends on its interactions: the integrator, the colour of pictures.
pub(crate) fn complete(scene: &mut Scene, integrator: bool, colour: bool) {
    let of_type = |wanted: fn(&Interaction) -> bool| scene.interactions.iter().any(wanted);
    let water = of_type(|interaction| matches!(interaction, Interaction::ShallowWater(_)));
    let cells = of_type(|interaction| matches!(interaction, Interaction::Voronoi(_)));
    if integrator && water {
        scene.integrator = Integrator::Gyro {};
    } else if integrator && particles::checks::defaults_to_cotter_reich(scene) {
        scene.integrator = Integrator::CotterReich {};
    }
    if colour && cells {
        // Of several species theirs.
        let mut species = scene.particles.iter().map(|group| &group.species);
        let first = species.next();
        let several = species.any(|other| Some(other) != first);
        scene.output.snapshot.color = if several { SnapshotColor::Species } else { SnapshotColor::Density };
    }
}

/// Completes what depends on how all else of a scene without mistakes acts together: the rule by which pairs relax.
pub(crate) fn settle(scene: &mut Scene) {
    if scene.integrator != (Integrator::Splitting { relaxation: None }) {
        return;
    }
    let model = Model::new(scene);
    if model.particles().relaxes_pairs(&model) {
        scene.integrator = Integrator::Splitting { relaxation: Some(model.advisable_relaxation()) };
    }
}
