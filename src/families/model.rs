//! The physics a scene asks for, in numbers: species, pair coefficients, cutoff, units. No scene syntax and no wgpu.

use super::particles::model::{forces, topology};
use super::{Angles, Bonds, ChainGroup, ChainTrios, ColouredNoise, PairForce, PositionBath, ShallowWater, Voronoi};
use crate::scene::{ColouredNoiseInteraction, Distribution, Generator, Integrator, Interaction, NoiseProcess, Scene};
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
    /// The pair force, if the scene has one.
    pub pair_force: Option<PairForce>,
    /// A heat bath on the coordinates of particles.
    pub position_bath: Option<PositionBath>,
    /// A random force on every particle that is constant for random times.
    pub coloured_noise: Option<ColouredNoise>,
    /// Spring constant that ties every particle to where it started.
    pub tether: Option<f64>,
    /// Groups of chains.
    pub chain_groups: Vec<ChainGroup>,
    /// Bonds, if there are any.
    pub bonds: Option<Bonds>,
    /// Angles between bonds, if they are stiff.
    pub angles: Option<Angles>,
    /// Harmonic chains, if the scene is of them; their springs are among the bonds.
    pub chains: Option<ChainTrios>,
    /// Shallow water on a mesh, if the scene has it; the momenta of its particles are per unit of mass.
    pub shallow_water: Option<ShallowWater>,
    /// Voronoi DPD, if the scene is of it.
    pub voronoi: Option<Voronoi>,
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
    /// let repulsions = model.pair_force.as_ref().map(|force| [force.repulsion(0, 0), force.repulsion(0, 1)]);
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
        let (mut pair_force, mut shallow_water, mut voronoi) = (None, None, None);
        let (mut position_bath, mut coloured_noise, mut tether) = (None, None, None);
        let (mut bonds, mut angles) = (Bonds::default(), Angles::default());
        let mut chains = None;
        for interaction in &scene.interactions {
            match interaction {
                Interaction::Dpd(dpd) => pair_force = Some(PairForce::new(dpd, &species, scene.temperature)),
                Interaction::Langevin(langevin) => {
                    position_bath = Some(PositionBath::new(langevin, &species, scene.temperature, scene.time.step));
                }
                Interaction::ColouredNoise(noise) => coloured_noise = Some(ColouredNoise::new(noise)),
                Interaction::Tether(spring) => tether = Some(spring.stiffness),
                Interaction::Bonds(interaction) => bonds.add(interaction, scene, |name| index_of(&species, name)),
                Interaction::Angles(interaction) => angles.add(interaction, scene, |name| index_of(&species, name)),
                Interaction::HarmonicChain(interaction) => {
                    let trios = ChainTrios::new(interaction, scene);
                    species.extend(trios.species());
                    trios.add_bonds(&mut bonds, scene.time.step);
                    chains = Some(trios);
                }
                Interaction::ShallowWater(water) => shallow_water = Some(ShallowWater::new(water, scene)),
                Interaction::Voronoi(interaction) => voronoi = Some(Voronoi::new(interaction, scene, &species)),
            }
        }
        let chain_groups = topology::chain_groups(scene, |name| index_of(&species, name));
        let mut lengths = [1.0; 3];
        lengths[..scene.space.lengths.len()].copy_from_slice(&scene.space.lengths);
        let momentum = match &shallow_water {
            Some(water) => velocity_unit(scene, water),
            None => momentum_unit(scene, &species, pair_force.as_ref(), chains.as_ref()),
        };
        let units = Units { dimension: scene.space.lengths.len(), lengths, momentum };
        if let Some(force) = &mut pair_force {
            // Of two images of a neighbour a list must see only one.
            force.skin = force.skin.min(0.5 * units.shortest_length() - force.cutoff).max(0.0);
        }
        Self {
            units,
            chain_groups,
            species,
            temperature: scene.temperature,
            time_step: scene.time.step,
            seed: scene.seed,
            generator: scene.noise.generator,
            distribution: scene.noise.distribution,
            integrator: scene.integrator.clone(),
            pair_force,
            position_bath,
            coloured_noise,
            tether,
            bonds: (bonds.count() > 0).then_some(bonds),
            angles: (angles.count() > 0).then_some(angles),
            chains,
            shallow_water,
            voronoi,
        }
    }

    /// Whether the scene has more than pairs without memory in two or three dimensions: then every coupling adds its
    /// impulses up on its own, and listed pairs persist.
    #[must_use]
    pub fn is_coupled(&self) -> bool {
        self.shallow_water.is_none()
            && self.voronoi.is_none()
            && (self.pair_force.as_ref().is_some_and(PairForce::remembers)
                || self.position_bath.is_some()
                || self.coloured_noise.is_some()
                || self.tether.is_some()
                || self.bonds.is_some()
                || self.angles.is_some()
                || self.has_fixed_particles()
                || self.units.dimension == 1)
    }

    /// Temperature kT of the bath of pairs.
    #[must_use]
    pub fn pair_temperature(&self) -> f64 {
        self.pair_force.as_ref().map_or(self.temperature, |force| force.temperature)
    }

    /// Whether any force derives from a potential.
    #[must_use]
    pub fn has_potential(&self) -> bool {
        let bonds = self.bonds.as_ref();
        self.shallow_water.is_some()
            // Pressures that follow from the gradient of a free energy.
            || self.voronoi.as_ref().is_some_and(|cells| !cells.exchanges_mass() && !cells.keeps_energy())
            || self.pair_force.as_ref().is_some_and(|force| force.largest_repulsion() > 0.0)
            || self.tether.is_some()
            || bonds.is_some_and(|bonds| bonds.kinds.iter().any(|kind| kind.potential.is_some()))
            || self.angles.is_some()
    }

    /// Whether any bath has a memory.
    #[must_use]
    pub fn has_memory(&self) -> bool {
        self.shallow_water.as_ref().is_some_and(|water| water.bath.is_some_and(|bath| bath.remembers()))
            || self.pair_force.as_ref().is_some_and(PairForce::remembers)
            || self.position_bath.as_ref().is_some_and(|bath| bath.memory)
            || self.bonds.as_ref().is_some_and(Bonds::have_memory)
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
            && self.pair_force.as_ref().is_some_and(|force| force.largest_friction() > 0.0)
    }

    /// Whether the equations of motion keep the total momentum. A mesh, a rotation and whatever acts on particles by
    /// themselves do not.
    #[must_use]
    pub fn conserves_momentum(&self) -> bool {
        self.coloured_noise.is_none() && self.is_free()
    }

    /// Whether temperatures are about the velocity of the centre of mass: where that is constant, and where it is driven by
    /// nothing but a random force.
    #[must_use]
    pub fn measures_about_centre_of_mass(&self) -> bool {
        self.is_free()
    }

    /// Whether nothing but a coloured noise couples particles to what is fixed in space.
    fn is_free(&self) -> bool {
        self.shallow_water.is_none()
            && self.position_bath.is_none()
            && self.tether.is_none()
            && !self.has_fixed_particles()
    }

    /// Number of particles.
    #[must_use]
    pub fn particle_count(&self) -> u64 {
        self.species.iter().fold(0, |sum, species| sum.saturating_add(species.count))
    }
}

/// The index of a species by its name.
fn index_of(species: &[Species], name: &str) -> Option<usize> {
    species.iter().position(|species| species.name == name)
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

/// A momentum that forces make this many times larger than motion from elsewhere is the one that integers have to hold: they
/// have room for 64 of the scale that their unit follows, rounded up to a power of two, and heat and neighbours add to it.
const RULED_BY_FORCES: f64 = 48.0;
/// Part of the largest momentum that forces are expected to make which the unit then follows.
const PART_OF_LARGEST: f64 = 0.125;
/// Times that the momenta of the lightest particles may be smaller than the scale that the unit follows: of its 2²⁴ units they have
/// 2¹² then.
const RESOLVED: f64 = 4096.0;

/// A power of two near 2⁻²⁴ (2⁻²⁰ for Voronoi cells) of the largest momentum a species has for a reason: thermal, that of its
/// fastest listed particle or of one that a coloured noise has pushed, or, in a scene without any of these, that of a
/// particle that has rolled down the repulsion. Where forces make momenta far beyond, as in a cold scene, it follows those.
fn momentum_unit(
    scene: &Scene,
    species: &[Species],
    pair_force: Option<&PairForce>,
    chains: Option<&ChainTrios>,
) -> f64 {
    let heaviest = species.iter().map(|species| species.mass).fold(0.0, f64::max);
    let baths = scene.interactions.iter().map(|interaction| interaction.bath_temperature(scene.temperature));
    let hottest = baths.fold(scene.temperature, f64::max);
    let mut scale = (heaviest * hottest).sqrt().max(chains.map_or(0.0, ChainTrios::momentum_scale));
    for group in &scene.particles {
        if let crate::scene::Velocities::Listed { velocities } = &group.velocities {
            let fastest = velocities.iter().flatten().fold(0.0, |most: f64, v| most.max(v.abs()));
            scale = scale.max(group.mass * fastest / 8.0);
        }
        if let crate::scene::Velocities::ShearWave { amplitude, .. } = group.velocities {
            scale = scale.max(group.mass * amplitude.abs() / 8.0);
        }
    }
    for interaction in &scene.interactions {
        if let Interaction::ColouredNoise(noise) = interaction {
            scale = scale.max(noise_momentum(noise, scene.time.step));
        }
    }
    if scale == 0.0
        && let Some(force) = pair_force
    {
        scale = (heaviest * force.largest_repulsion() * force.cutoff).sqrt();
    }
    let lightest = species.iter().map(|species| species.mass).fold(f64::INFINITY, f64::min).min(heaviest);
    let [mut forced, of_lightest] =
        [f64::INFINITY, lightest].map(|heaviest| forces::momentum(scene, species, pair_force, heaviest));
    // A unit for what forces make of a particle that is heavier by far could not resolve a light one.
    if forced > of_lightest * RESOLVED / PART_OF_LARGEST {
        forced = of_lightest;
    }
    if scale == 0.0 {
        // The impulses of weak forces in one step would be lost in rounding.
        scale = if forced > 0.0 && forced < 1.0 / 16.0 { forced } else { 1.0 };
    }
    if forced > RULED_BY_FORCES * scale.log2().ceil().exp2() {
        scale = PART_OF_LARGEST * forced;
    }
    // Voronoi cells that come close throw each other apart, at steps that are too long for them by hundreds of these momenta.
    let voronoi = scene.interactions.iter().any(|interaction| matches!(interaction, Interaction::Voronoi(_)));
    let bits = if voronoi { 20.0 } else { 24.0 };
    (scale.log2().ceil() - bits).exp2()
}

/// The momentum that the forces of a coloured noise may add up to before friction holds it: what the longest time of a
/// kangaroo process gives is 64 of these. A coarser scale would lose the impulse of half a step in rounding.
fn noise_momentum(noise: &ColouredNoiseInteraction, time_step: f64) -> f64 {
    let times = if noise.process == NoiseProcess::Short { 16.0 } else { 96.0 };
    noise.strength.sqrt() * (times * noise.time).clamp(time_step, 4096.0 * time_step)
}
