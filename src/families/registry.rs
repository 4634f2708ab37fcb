//! All families of models.

use super::{Model, Particles, Physics, ShallowWater, Species, Voronoi, particles, shallow_water, voronoi};
use crate::document::{Integrator, Interaction, Problems, Scene, SnapshotColor, SpeciesNames, System, SystemKind};

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
    pub(super) fn new(scene: &Scene, species: &mut Vec<Species>) -> Self {
        match &scene.system {
            System::Particles { integrator, .. } => {
                Self::Particles(Box::new(Particles::new(scene, integrator, species)))
            }
            System::ShallowWater { integrator, water } => {
                Self::ShallowWater(ShallowWater::new(water, *integrator, scene))
            }
            System::Voronoi { integrator, cells } => Self::Voronoi(Voronoi::new(cells, *integrator, scene, species)),
        }
    }

    /// Gives units of what it keeps to both that hold the larger values of either.
    pub(super) fn share_units(&mut self, other: &mut Self) {
        if let (Self::Voronoi(own), Self::Voronoi(others)) = (self, other) {
            own.energy_unit = own.energy_unit.max(others.energy_unit);
            others.energy_unit = own.energy_unit;
        }
    }

    /// Its physics.
    pub(crate) fn physics(&self) -> &dyn Physics {
        match self {
            Self::Particles(particles) => particles.as_ref(),
            Self::ShallowWater(water) => water,
            Self::Voronoi(cells) => cells,
        }
    }
}

/// Checks what a scene has of its kind.
pub(crate) fn check_system(scene: &Scene, species: &SpeciesNames<'_>, problems: &mut Problems) {
    match &scene.system {
        System::Particles { integrator, .. } => particles::checks::check(scene, integrator, species, problems),
        System::ShallowWater { water, .. } => shallow_water::checks::check(scene, water, problems),
        System::Voronoi { cells, .. } => voronoi::checks::check(scene, cells, problems),
    }
}

/// Completes what a scene leaves out and what depends on its system: the integrator of particles, the colour of pictures of cells.
pub(crate) fn complete(scene: &mut Scene, integrator: bool, colour: bool) {
    if integrator
        && particles::checks::defaults_to_cotter_reich(scene)
        && let Some(integrator) = scene.system.particle_integrator_mut()
    {
        *integrator = Integrator::CotterReich {};
    }
    if colour && scene.system.kind() == SystemKind::Voronoi {
        // Of several species theirs.
        let mut species = scene.particles.iter().map(|group| &group.species);
        let first = species.next();
        let several = species.any(|other| Some(other) != first);
        scene.output.snapshot.color = if several { SnapshotColor::Species } else { SnapshotColor::Density };
    }
}

/// Completes what depends on how all else of a scene without mistakes acts together: the rule by which pairs relax, or in steps that
/// are not split, which alone list neighbours, the margin of the list.
pub(crate) fn settle(scene: &mut Scene) {
    match scene.system.particle_integrator() {
        Some(Integrator::Splitting { relaxation: None }) => settle_relaxation(scene),
        Some(Integrator::GrootWarren { .. } | Integrator::CotterReich {}) => settle_margin(scene),
        Some(Integrator::Splitting { relaxation: Some(_) }) | None => {}
    }
}

fn settle_relaxation(scene: &mut Scene) {
    let model = Model::new(scene);
    let relaxation = model.particles().relaxes_pairs().then(|| model.advisable_relaxation());
    if let Some(Integrator::Splitting { relaxation: rule }) = scene.system.particle_integrator_mut() {
        *rule = relaxation;
    }
}

fn settle_margin(scene: &mut Scene) {
    let margins: Vec<Option<f64>> = scene.pair_interactions().map(|(_, dpd)| dpd.skin).collect();
    if margins.is_empty() || margins.iter().any(Option::is_some) {
        return;
    }
    let margin = Model::new(scene).advisable_margin();
    for interaction in scene.system.interactions_mut().into_iter().flatten() {
        if let Interaction::Dpd(dpd) = interaction {
            dpd.skin = margin;
        }
    }
}
