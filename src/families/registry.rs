//! All families of models.

use super::{Model, Particles, Physics, ShallowWater, Species, Voronoi, particles, shallow_water, voronoi};
use crate::document::{Integrator, Interaction, Placement, Problems, Scene, SnapshotColor, SpeciesNames, Velocities};

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
    let mut water = scene.interactions.iter().enumerate().filter(|(_, interaction)| is_water(interaction));
    let first_water = water.next().map(|(index, _)| index);
    for (index, interaction) in scene.interactions.iter().enumerate() {
        let path = format!("interactions[{index}]");
        let alone = match interaction {
            // Of a second one all has been said.
            Interaction::ShallowWater(_) if Some(index) != first_water => continue,
            Interaction::ShallowWater(_) | Interaction::Voronoi(_) | Interaction::HarmonicChain(_) => true,
            _ => false,
        };
        if alone && scene.interactions.len() > 1 {
            let accepted = format!("`{}` as the only interaction of a scene", interaction.name());
            problems.refuse(&path, "together with another interaction", accepted);
        }
        match interaction {
            Interaction::ShallowWater(water) if scene.interactions.len() == 1 => {
                shallow_water::checks::check(scene, water, &path, problems);
            }
            Interaction::Voronoi(voronoi) => voronoi::checks::check(scene, voronoi, &path, problems),
            _ => {
                if let Some(term) = particles::terms::of(interaction) {
                    term.check(scene, species, &path, problems);
                }
            }
        }
    }
    particles::checks::check_scene(scene, species, problems);
    check_absence(scene, problems);
}

/// Nodes along x and y of the mesh on which a scene has fields, if it has.
pub(crate) fn mesh_of(scene: &Scene) -> Option<[u32; 2]> {
    scene.interactions.iter().find_map(|interaction| match interaction {
        Interaction::ShallowWater(water) => Some(water.mesh),
        _ => None,
    })
}

fn is_water(interaction: &Interaction) -> bool {
    matches!(interaction, Interaction::ShallowWater(_))
}

fn is_voronoi(interaction: &Interaction) -> bool {
    matches!(interaction, Interaction::Voronoi(_))
}

/// Refuses what has a meaning in another family only.
fn check_absence(scene: &Scene, problems: &mut Problems) {
    let dry = !scene.interactions.iter().any(is_water);
    let without_cells = !scene.interactions.iter().any(is_voronoi);
    let is_chain = |interaction: &Interaction| matches!(interaction, Interaction::HarmonicChain(_));
    let without_chains = !scene.interactions.iter().any(is_chain);
    let of_water = "a scene with a `shallow-water` interaction only";
    let of_cells = "a scene with a `voronoi` interaction only";
    let integrator = format!("`{}`", scene.integrator.name());
    match scene.integrator {
        Integrator::Gyro {} | Integrator::Rotate {} if dry => problems.refuse("integrator.type", integrator, of_water),
        Integrator::Euler {} if without_cells => problems.refuse("integrator.type", integrator, of_cells),
        _ => {}
    }
    for (index, group) in scene.particles.iter().enumerate() {
        let path = format!("particles[{index}]");
        if group.tracer && dry {
            problems.refuse(format!("{path}.tracer"), "true", of_water);
        }
        match group.velocities {
            Velocities::Geostrophic if dry => {
                problems.refuse(format!("{path}.velocities.type"), "`geostrophic`", of_water);
            }
            Velocities::ShearWave { .. } if without_cells => {
                problems.refuse(format!("{path}.velocities.type"), "`shear-wave`", of_cells);
            }
            _ => {}
        }
        if matches!(group.placement, Placement::Circle { .. }) && scene.space.lengths.len() != 2 && dry {
            problems.refuse(format!("{path}.placement.type"), "`circle`", "a two-dimensional box for a circle");
        }
    }
    let output = &scene.output;
    match output.snapshot.color {
        SnapshotColor::Density if without_cells => problems.refuse("output.snapshot.color", "`density`", of_cells),
        SnapshotColor::Temperature if without_cells => {
            problems.refuse("output.snapshot.color", "`temperature`", of_cells);
        }
        _ => {}
    }
    let of_chains = "no `chain`, or a scene with the interaction `harmonic-chain`";
    for (key, is_astray, lacking, accepted) in [
        ("fields", output.fields.is_some() && dry, "a mesh", of_water),
        ("spectra", output.spectra.is_some() && dry, "a mesh", of_water),
        ("neighbours", output.neighbours.is_some() && without_cells, "Voronoi cells", of_cells),
        ("shear_wave", output.shear_wave.is_some() && without_cells, "Voronoi cells", of_cells),
        ("chain", output.chain.is_some() && without_chains, "harmonic chains", of_chains),
    ] {
        if is_astray {
            problems.refuse(format!("output.{key}"), format!("in a scene without {lacking}"), accepted);
        }
    }
}

/// Completes what a scene leaves out and what depends on its interactions: the integrator, the colour of pictures.
pub(crate) fn complete(scene: &mut Scene, integrator: bool, colour: bool) {
    let water = scene.interactions.iter().any(is_water);
    let cells = scene.interactions.iter().any(is_voronoi);
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
