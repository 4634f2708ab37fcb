//! The physics a scene asks for, in numbers: species, pair coefficients, cutoff, units. No scene syntax and no wgpu.

use super::{Family, Particles, Physics, PictureKind, ShallowWater, TimeAxis, Voronoi, particles, speeds};
use crate::document::{CHARGE_PARTS, Distribution, Generator, Output, Scene};
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
    /// Whether nothing that acts on them moves them: held where they start, or frozen behind a wall.
    pub fixed: bool,
    /// True if they make up layers behind walls, which absorb the momentum that they are given.
    pub frozen: bool,
    /// Charge of one particle in elementary charges, a multiple of 2⁻¹⁶.
    pub charge: f64,
}

impl Species {
    /// Those of the groups of a scene.
    pub(super) fn of(scene: &Scene) -> Vec<Self> {
        let mut species: Vec<Self> = Vec::new();
        for group in &scene.particles {
            let count = group.resolved_count(&scene.space);
            if let Some(known) = species.iter_mut().find(|known| known.name == group.species) {
                known.count = known.count.saturating_add(count);
            } else {
                let name = group.species.clone();
                let (fixed, frozen) = (group.is_held(), group.is_frozen());
                let charge = f64::from(group.charge_parts()) / CHARGE_PARTS;
                species.push(Self { name, mass: group.mass, count, fixed, frozen, charge });
            }
        }
        species
    }
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
    /// The times of its steps.
    pub time: TimeAxis,
    /// True if turns around the box were counted before the first step: their count goes on, for frames of one trajectory belong together.
    pub(crate) after_turns: bool,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Steps of an earlier run before the first, where it goes on with one.
    pub steps_before: u64,
    /// Random number generator.
    pub generator: Generator,
    /// Distribution of the pair noise; where pairs relax in two stages it is Gaussian.
    pub distribution: Distribution,
    /// The largest velocity along an axis that is expected of a particle, of which thermal ones have the standard deviation.
    pub(crate) expected_velocity: f64,
    /// What belongs to its family.
    pub family: Family,
    /// The model with the numbers that are announced, if any: units are those of its scales.
    announced: Option<Box<Model>>,
}

impl Model {
    /// The model of a checked scene.
    ///
    /// ```
    ///
    /// let model = mesoscope::scene::load("binary-mixture", &[])?.model().clone();
    /// assert_eq!((model.units.dimension, model.particle_count()), (2, 14_400));
    /// let names: Vec<&str> = model.species.iter().map(|species| species.name.as_str()).collect();
    /// assert_eq!(names, ["A", "B"]);
    /// let force = model.particles().pair_force.as_ref();
    /// let repulsions = force.map(|force| [force.repulsion(0, 0), force.repulsion(0, 1)]);
    /// assert_eq!(repulsions, Some([25.0, 60.0]));
    /// assert!(model.conserves_momentum() && !model.has_memory());
    /// # Ok::<(), mesoscope::scene::SceneError>(())
    /// ```
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut species = Species::of(scene);
        let mut lengths = [1.0; 3];
        lengths[..scene.space.lengths.len()].copy_from_slice(&scene.space.lengths);
        let mut family = Family::new(scene, &mut species);
        let mut announced = scene.as_announced().map(|scene| Box::new(Self::new(&scene)));
        let earlier = scene.earlier_run();
        let physics = family.physics();
        let [momentum, expected_velocity] = if let Some(earlier) = earlier {
            // A run that goes on with an earlier one has its units.
            [earlier.momentum_unit, earlier.expected_velocity]
        } else {
            let own = [physics.momentum_unit(scene, &species), speeds::expected(scene, &species, physics)];
            let others = announced.as_ref().map_or(own, |model| [model.units.momentum, model.expected_velocity]);
            [own[0].max(others[0]), own[1].max(others[1])]
        };
        let gaps = physics.gaps(scene);
        let edges = lengths;
        let lengths: [f64; 3] = std::array::from_fn(|axis| edges[axis] + gaps[axis]);
        // The rounded sum less this is the edge again.
        let gaps = std::array::from_fn(|axis| lengths[axis] - edges[axis]);
        if let Some(announced) = &mut announced {
            announced.units.momentum = momentum;
            family.share_units(&mut announced.family);
        }
        let mut model = Self {
            units: Units { dimension: scene.space.lengths.len(), lengths, gaps, momentum },
            species,
            temperature: scene.temperature,
            time_step: scene.time.step,
            time: TimeAxis { step: 0, time: 0.0, interval: scene.time.step },
            after_turns: false,
            seed: scene.noise_seed(),
            steps_before: earlier.map_or(0, |earlier| earlier.steps),
            generator: scene.noise.generator,
            distribution: scene.noise.distribution,
            expected_velocity,
            family,
            announced,
        };
        // Uniform numbers leave pairs that relax wholly in a step too few fast ones: few neighbours end up cold.
        if model.particles().relaxes_in_two_stages() {
            model.distribution = Distribution::Gaussian;
        }
        model
    }

    /// The model whose scales units of sums follow: with the numbers that are announced, if there are any.
    #[must_use]
    pub(crate) fn of_scales(&self) -> &Self {
        self.announced.as_deref().unwrap_or(self)
    }

    /// What noise and forces that depend on time go by at a step: the steps since the first of the earlier runs that it goes on with. At zero
    /// momenta are those of the report point; later they are half a step behind.
    pub(crate) fn clock(&self, step: u64) -> u64 {
        self.steps_before.wrapping_add(step)
    }

    /// Whether its steps are those of another model, whenever they begin.
    pub(crate) fn has_the_steps_of(&self, other: &Self) -> bool {
        let (mut one, mut other) = (self.clone(), other.clone());
        one.steps_before = other.steps_before;
        if one.announced.is_some() != other.announced.is_some() {
            // Kernels that load their numbers may round otherwise.
            return false;
        }
        // Only sums of reports have other units.
        one.announced.clone_from(&other.announced);
        match (&mut one.family, &mut other.family) {
            (Family::Particles(mine), Family::Particles(theirs)) => mine.take_links_alike(theirs),
            _ => return false,
        }
        one == other
    }

    /// Whether any bath has a memory.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.physics().has_memory()
    }

    /// Whether some particles are held where they start; those behind walls are not among them.
    pub(crate) fn has_fixed_particles(&self) -> bool {
        self.species.iter().any(|species| species.fixed && !species.frozen && species.count > 0)
    }

    /// Whether it is counted how often particles go round the box: for trajectories and displacements, and not where boundaries shear,
    /// for then that is no whole number.
    pub(crate) fn follows_paths(&self, output: &Output) -> bool {
        let is_needed = self.after_turns || output.trajectory.is_some() || output.diffusion.is_some();
        is_needed && self.particles().shear.is_none()
    }

    /// Whether something drives a flow of particles: boundaries that shear, walls that move, or forces from outside.
    #[must_use]
    pub fn is_driven(&self) -> bool {
        let particles = self.particles();
        particles.shear.is_some_and(|shear| shear.velocity != 0.0)
            || particles.walls_move()
            || particles.body_forces.is_some()
    }

    /// Number of frozen particles behind walls.
    pub(crate) fn frozen_particles(&self) -> u64 {
        self.species.iter().filter(|species| species.frozen).map(|species| species.count).sum()
    }

    /// Number of particles that can move.
    #[must_use]
    pub fn mobile_particles(&self) -> u64 {
        self.mobile_particles_of(None)
    }

    /// The number of a species.
    pub(crate) fn species_named(&self, name: &str) -> Option<usize> {
        self.species.iter().position(|species| species.name == name)
    }

    /// Number of particles of a species that can move; without a name of all.
    pub(crate) fn mobile_particles_of(&self, species: Option<&str>) -> u64 {
        let asked = |known: &&Species| !known.fixed && species.is_none_or(|name| known.name == name);
        self.species.iter().filter(asked).map(|species| species.count).sum()
    }

    /// Mass of all particles but those of layers behind walls, which have none that counts.
    pub(crate) fn mobile_mass(&self) -> f64 {
        let species = self.species.iter().filter(|species| !species.frozen);
        species.map(|species| species.mass * species.count as f64).sum()
    }

    /// Whether the equations of motion keep the total momentum. A mesh, a rotation and whatever acts on particles by
    /// themselves do not.
    #[must_use]
    pub fn conserves_momentum(&self) -> bool {
        self.exchanges_momentum()
            && self.particles().body_forces.is_none()
            && self.particles().walls.is_empty()
            && self.particles().shear.is_none()
    }

    /// True if particles get momentum from each other, from body forces and from walls only, so that the total is the
    /// momentum that the two have added.
    pub(crate) fn exchanges_momentum(&self) -> bool {
        self.particles().coloured_noise.is_none() && self.physics().is_free() && !self.has_fixed_particles()
    }

    /// Whether temperatures are about the velocity of the centre of mass: where that is constant, and where it is driven by
    /// nothing but a random force.
    pub(crate) fn measures_about_centre_of_mass(&self) -> bool {
        self.physics().is_free()
            && !self.has_fixed_particles()
            && self.particles().walls.is_empty()
            && self.particles().shear.is_none()
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
            steps_before: self.steps_before,
            time_step: self.time_step,
            suggested_step: (0.25 * self.time_step)
                .min(speeds::longest_step(self))
                .min(self.physics().longest_step(self)),
            ..Plan::new(self.units, layout, quanta)
        }
    }

    /// Edges of what pictures show: the box, with the layers of frozen particles behind its walls.
    pub(crate) fn edges_with_layers(&self) -> [f64; 3] {
        let mut edges = self.units.edges();
        for walls in &self.particles().walls {
            edges[walls.axis] += 2.0 * walls.layer;
        }
        edges
    }

    /// The physics of its family.
    pub(crate) fn physics(&self) -> &dyn Physics {
        self.family.physics()
    }

    /// Its particles, with their number.
    #[must_use]
    pub fn particles_in_words(&self) -> String {
        self.physics().particles_in_words(self.particle_count())
    }

    /// The kind of pictures that a run draws.
    #[must_use]
    pub fn picture(&self) -> PictureKind {
        self.physics().picture()
    }

    /// What is expected of the errors that its step makes, measure by measure, in words.
    #[must_use]
    pub fn estimates(&self) -> Vec<String> {
        self.physics().estimates(self)
    }

    /// What acts on particles; nothing in a model of another family.
    #[must_use]
    pub fn particles(&self) -> &Particles {
        if let Family::Particles(particles) = &self.family { particles } else { &particles::NONE }
    }

    /// What acts on particles, in a model of them, to change it.
    pub fn particles_mut(&mut self) -> Option<&mut Particles> {
        if let Family::Particles(particles) = &mut self.family { Some(particles) } else { None }
    }

    /// Shallow water on a mesh, in a model of it; the momenta of its particles are per unit of mass.
    #[must_use]
    pub fn shallow_water(&self) -> Option<&ShallowWater> {
        if let Family::ShallowWater(water) = &self.family { Some(water) } else { None }
    }

    /// Voronoi DPD, in a model of it.
    #[must_use]
    pub fn voronoi(&self) -> Option<&Voronoi> {
        if let Family::Voronoi(cells) = &self.family { Some(cells) } else { None }
    }
}
