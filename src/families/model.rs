//! The physics a scene asks for, in numbers: species, pair coefficients, cutoff, units. No scene syntax and no wgpu.

use super::{
    Angles, Bonds, ChainGroup, ChainTrios, ColouredNoise, Family, PairForce, Particles, Physics, PictureKind,
    PositionBath, ShallowWater, Voronoi, speeds,
};
use crate::document::{Distribution, Generator, Integrator, Scene, Warning};
use crate::noise;
use crate::plan::{Plan, Quanta, StateLayout};
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
    /// Whether they are held where they start.
    pub fixed: bool,
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
    /// The largest velocity along an axis that is expected of a particle, of which thermal ones have the standard deviation.
    pub(crate) expected_velocity: f64,
    /// What belongs to its family.
    pub family: Family,
}

impl Model {
    /// The model of a checked scene.
    ///
    /// ```
    /// use mesoscope::families::Model;
    ///
    /// let model = Model::new(&mesoscope::scene::load("binary-mixture", &[])?);
    /// assert_eq!((model.units.dimension, model.particle_count()), (2, 14_400));
    /// let names: Vec<&str> = model.species.iter().map(|species| species.name.as_str()).collect();
    /// assert_eq!(names, ["A", "B"]);
    /// let repulsions = model.pair_force().map(|force| [force.repulsion(0, 0), force.repulsion(0, 1)]);
    /// assert_eq!(repulsions, Some([25.0, 60.0]));
    /// assert!(model.conserves_momentum() && !model.is_coupled());
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        let mut species: Vec<Species> = Vec::new();
        for group in &scene.particles {
            let count = group.resolved_count(scene.space.volume());
            if let Some(known) = species.iter_mut().find(|known| known.name == group.species) {
                known.count = known.count.saturating_add(count);
            } else {
                let name = group.species.clone();
                species.push(Species { name, mass: group.mass, count, fixed: group.fixed });
            }
        }
        let mut lengths = [1.0; 3];
        lengths[..scene.space.lengths.len()].copy_from_slice(&scene.space.lengths);
        let family = Family::of(scene, &mut species);
        let momentum = family.physics().momentum_unit(scene, &species);
        let expected_velocity = speeds::expected(scene, &species, family.physics());
        Self {
            units: Units { dimension: scene.space.lengths.len(), lengths, momentum },
            species,
            temperature: scene.temperature,
            time_step: scene.time.step,
            seed: scene.seed,
            generator: scene.noise.generator,
            distribution: scene.noise.distribution,
            integrator: scene.integrator.clone(),
            expected_velocity,
            family,
        }
    }

    /// Whether it is of particles with more than pairs without memory in two or three dimensions: then every coupling adds its
    /// impulses up on its own, and listed pairs persist.
    #[must_use]
    pub fn is_coupled(&self) -> bool {
        self.particles().is_some_and(|particles| particles.are_coupled)
    }

    /// Temperature kT of the bath of pairs.
    #[must_use]
    pub fn pair_temperature(&self) -> f64 {
        self.pair_force().map_or(self.temperature, |force| force.temperature)
    }

    /// Whether any force derives from a potential.
    #[must_use]
    pub fn has_potential(&self) -> bool {
        self.physics().has_potential()
    }

    /// Whether any bath has a memory.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.physics().has_memory()
    }

    /// Whether some particles are held where they start.
    #[must_use]
    pub fn has_fixed_particles(&self) -> bool {
        self.species.iter().any(|species| species.fixed && species.count > 0)
    }

    /// Number of particles that can move.
    #[must_use]
    pub fn mobile_particles(&self) -> u64 {
        self.species.iter().filter(|species| !species.fixed).map(|species| species.count).sum()
    }

    /// Whether steps are split, friction apart from the conservative force. Without friction there is nothing to split.
    #[must_use]
    pub fn splits(&self) -> bool {
        self.integrator == Integrator::Splitting {}
            && self.pair_force().is_some_and(|force| force.largest_friction() > 0.0)
    }

    /// Whether the equations of motion keep the total momentum. A mesh, a rotation and whatever acts on particles by
    /// themselves do not.
    #[must_use]
    pub fn conserves_momentum(&self) -> bool {
        self.coloured_noise().is_none() && self.measures_about_centre_of_mass()
    }

    /// Whether temperatures are about the velocity of the centre of mass: where that is constant, and where it is driven by
    /// nothing but a random force.
    #[must_use]
    pub fn measures_about_centre_of_mass(&self) -> bool {
        self.physics().is_free() && !self.has_fixed_particles()
    }

    /// Number of particles.
    #[must_use]
    pub fn particle_count(&self) -> u64 {
        self.species.iter().fold(0, |sum, species| sum.saturating_add(species.count))
    }

    /// A plan of it that does nothing yet; its noise is of the stream.
    pub(crate) fn empty_plan(&self, cells: [u32; 3], layout: impl StateLayout, quanta: Quanta, stream: u32) -> Plan {
        Plan {
            particles: self.particle_count(),
            cells,
            seed_key: noise::seed_key(self.seed, stream),
            time_step: self.time_step,
            suggested_step: (0.25 * self.time_step)
                .min(speeds::longest_step(self))
                .min(self.physics().longest_step(self)),
            ..Plan::new(self.units, layout, quanta)
        }
    }

    /// The physics of its family.
    #[must_use]
    pub(crate) fn physics(&self) -> &dyn Physics {
        self.family.physics()
    }

    /// Its particles, with their number.
    #[must_use]
    pub fn particles_in_words(&self) -> String {
        self.physics().particles_in_words(self.particle_count())
    }

    /// What `check` says of it, name by name, beside what all families have; `cells` are those of the plan in words.
    #[must_use]
    pub fn description(&self, scene: &Scene, plan: &Plan, cells: &str) -> Vec<(&'static str, String)> {
        self.physics().description(scene, self, plan, cells)
    }

    /// The kind of pictures that a run draws.
    #[must_use]
    pub fn picture(&self) -> PictureKind {
        self.physics().picture()
    }

    /// Warnings about its scene.
    #[must_use]
    pub fn warnings(&self, scene: &Scene) -> Vec<Warning> {
        self.physics().warnings(scene, self)
    }

    /// What belongs to particles, in a model of them.
    #[must_use]
    pub fn particles(&self) -> Option<&Particles> {
        match &self.family {
            Family::Particles(particles) => Some(particles),
            _ => None,
        }
    }

    /// Shallow water on a mesh, in a model of it; the momenta of its particles are per unit of mass.
    #[must_use]
    pub fn shallow_water(&self) -> Option<&ShallowWater> {
        match &self.family {
            Family::ShallowWater(water) => Some(water),
            _ => None,
        }
    }

    /// Voronoi DPD, in a model of it.
    #[must_use]
    pub fn voronoi(&self) -> Option<&Voronoi> {
        match &self.family {
            Family::Voronoi(cells) => Some(cells),
            _ => None,
        }
    }

    /// The pair force, if there is one.
    #[must_use]
    pub fn pair_force(&self) -> Option<&PairForce> {
        self.particles()?.pair_force.as_ref()
    }

    /// The pair force, to change it.
    pub fn pair_force_mut(&mut self) -> Option<&mut PairForce> {
        match &mut self.family {
            Family::Particles(particles) => particles.pair_force.as_mut(),
            _ => None,
        }
    }

    /// A heat bath on the coordinates of particles.
    #[must_use]
    pub fn position_bath(&self) -> Option<&PositionBath> {
        self.particles()?.position_bath.as_ref()
    }

    /// A random force on every particle that is constant for random times.
    #[must_use]
    pub fn coloured_noise(&self) -> Option<&ColouredNoise> {
        self.particles()?.coloured_noise.as_ref()
    }

    /// Spring constant that ties every particle to where it started.
    #[must_use]
    pub fn tether(&self) -> Option<f64> {
        self.particles()?.tether
    }

    /// Bonds, if there are any.
    #[must_use]
    pub fn bonds(&self) -> Option<&Bonds> {
        self.particles()?.bonds.as_ref()
    }

    /// Angles between bonds, if they are stiff.
    #[must_use]
    pub fn angles(&self) -> Option<&Angles> {
        self.particles()?.angles.as_ref()
    }

    /// Harmonic chains, if the scene is of them; their springs are among the bonds.
    #[must_use]
    pub fn chains(&self) -> Option<&ChainTrios> {
        self.particles()?.chains.as_ref()
    }

    /// Groups of chains.
    #[must_use]
    pub fn chain_groups(&self) -> &[ChainGroup] {
        self.particles().map_or(&[], |particles| &particles.chain_groups)
    }
}
