//! The physics a scene asks for, in numbers: species, pair coefficients, cutoff, units. No scene syntax and no wgpu.

mod bath;
mod dpd;
mod harmonic_chain;
mod shallow_water;

pub use bath::BathStep;
pub use dpd::PairForce;
pub use harmonic_chain::{HarmonicChain, SpringChain};
pub(crate) use shallow_water::{CLEAN_SHARE, LARGEST_DEPTH, LARGEST_MASS, chebyshev_iterations};
pub use shallow_water::{ShallowWater, Tracers};

use crate::scene::{Distribution, Generator, Integrator, Interaction, Scene};
use crate::state::Units;

/// A species of particles.
#[derive(Debug, Clone, PartialEq)]
pub struct Species {
    /// The name in the scene.
    pub name: String,
    /// Mass of one particle.
    pub mass: f64,
    /// Number of particles.
    pub count: u64,
}

/// Everything the equations of motion need.
#[derive(Debug, Clone, PartialEq)]
pub struct Model {
    /// Scales of the integer state.
    pub units: Units,
    /// Species in order of first appearance in the scene.
    pub species: Vec<Species>,
    /// Heat bath temperature kT.
    pub temperature: f64,
    /// Time step.
    pub time_step: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Random number generator.
    pub generator: Generator,
    /// Distribution of the pair noise.
    pub distribution: Distribution,
    /// Integrator.
    pub integrator: Integrator,
    /// The pair force, if the scene has one.
    pub pair_force: Option<PairForce>,
    /// Shallow water on a mesh, if the scene has it; the momenta of its particles are per unit of mass.
    pub shallow_water: Option<ShallowWater>,
}

impl Model {
    /// The model of a checked scene.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let mut species: Vec<Species> = Vec::new();
        for group in &scene.particles {
            let count = group.resolved_count(scene.space.volume());
            match species.iter_mut().find(|known| known.name == group.species) {
                Some(known) => known.count += count,
                None => species.push(Species { name: group.species.clone(), mass: group.mass, count }),
            }
        }
        let (mut pair_force, mut shallow_water) = (None, None);
        for interaction in &scene.interactions {
            match interaction {
                Interaction::Dpd(dpd) => pair_force = Some(PairForce::new(dpd, &species)),
                Interaction::ShallowWater(water) => shallow_water = Some(ShallowWater::new(water, scene)),
            }
        }
        let mut lengths = [1.0; 3];
        lengths[..scene.space.lengths.len()].copy_from_slice(&scene.space.lengths);
        let momentum = match &shallow_water {
            Some(water) => velocity_unit(scene, water),
            None => momentum_unit(scene, &species, pair_force.as_ref()),
        };
        Self {
            units: Units { dimension: scene.space.lengths.len(), lengths, momentum },
            species,
            temperature: scene.temperature,
            time_step: scene.time.step,
            seed: scene.seed,
            generator: scene.noise.generator,
            distribution: scene.noise.distribution,
            integrator: scene.integrator.clone(),
            pair_force,
            shallow_water,
        }
    }

    /// Whether steps are split, friction apart from the conservative force. Without friction there is nothing to split.
    #[must_use]
    pub fn splits(&self) -> bool {
        self.integrator == Integrator::Splitting {}
            && self.pair_force.as_ref().is_some_and(|force| force.largest_friction() > 0.0)
    }

    /// Whether the equations of motion keep the total momentum. A mesh and a rotation do not.
    #[must_use]
    pub fn conserves_momentum(&self) -> bool {
        self.shallow_water.is_none()
    }

    /// Number of particles.
    #[must_use]
    pub fn particle_count(&self) -> u64 {
        self.species.iter().map(|species| species.count).sum()
    }
}

/// A power of two near 2⁻²⁹ of the largest velocity expected in shallow water, where the speed of waves is a high one.
fn velocity_unit(scene: &Scene, water: &ShallowWater) -> f64 {
    let mass = water.nodes() as f64 / water.carriers.max(1) as f64;
    let mut scale = water.wave_speed.max(8.0 * (scene.temperature / mass).sqrt());
    for group in &scene.particles {
        if let crate::scene::Velocities::Listed { velocities } = &group.velocities {
            scale = velocities.iter().flatten().fold(scale, |most, velocity| most.max(velocity.abs()));
        }
    }
    (scale.log2().ceil() - 29.0).exp2()
}

/// A power of two near 2⁻²⁴ of the largest momentum a species has for a reason: thermal, or, in a scene without heat,
/// that of its fastest listed particle or of a particle that has rolled down the repulsion.
fn momentum_unit(scene: &Scene, species: &[Species], pair_force: Option<&PairForce>) -> f64 {
    let heaviest = species.iter().map(|species| species.mass).fold(0.0, f64::max);
    let mut scale = (heaviest * scene.temperature).sqrt();
    for group in &scene.particles {
        if let crate::scene::Velocities::Listed { velocities } = &group.velocities {
            let fastest = velocities.iter().flatten().fold(0.0, |most: f64, v| most.max(v.abs()));
            scale = scale.max(group.mass * fastest / 8.0);
        }
    }
    if scale == 0.0
        && let Some(force) = pair_force
    {
        scale = (heaviest * force.largest_repulsion() * force.cutoff).sqrt();
    }
    if scale == 0.0 {
        scale = 1.0;
    }
    (scale.log2().ceil() - 24.0).exp2()
}
