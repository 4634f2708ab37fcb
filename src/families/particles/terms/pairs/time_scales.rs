//! How fast pair forces act, and the time step that follows.

use super::PairForce;
use crate::families::{Model, Species};

/// Friction that relaxes a velocity by more than this in one step is not resolved.
const FRICTION_LIMIT: f64 = 0.25;

/// The same of friction that relaxes in two stages: temperatures are right beyond it too, but here particles diffuse a tenth too
/// slowly, and more friction is weakened.
const STAGED_FRICTION_LIMIT: f64 = 0.75;

/// A harmonic oscillator of frequency ω is stable in a Verlet scheme up to ω·dt = 2; half of it leaves some accuracy.
pub(crate) const FREQUENCY_LIMIT: f64 = 1.0;

/// How far chance spreads the stiffness of what surrounds a particle, as a part of what it would be if neighbours were anywhere:
/// repulsion keeps them apart. The largest eigenvalue of the dynamical matrix of fluids in equilibrium has 0.5 to 0.7; 0.75 is that of runs
/// that end, which heat has mixed more.
const CROWDING: f64 = 0.75;

impl Model {
    /// The largest mean friction rate of any species that has particles, and its index: Γ = Σ γρ \[ω\] / (d·m) at the densities ρ around it, with \[ω\]
    /// the weight integrated over the sphere (disc).
    pub(crate) fn largest_friction_rate(&self, force: &PairForce) -> (f64, usize) {
        self.largest(|index| self.friction_rate(force, index))
    }

    /// The mean friction rate of a species.
    pub(super) fn friction_rate(&self, force: &PairForce, index: usize) -> f64 {
        let dimension = self.units.dimension;
        // In units of the weight of the species with itself.
        let unit = force.weight_volume(index, index, dimension);
        let of_pair = |(other, density): (usize, f64)| {
            force.friction(index, other) * density * (force.weight_volume(index, other, dimension) / unit)
        };
        self.densities(index).map(of_pair).sum::<f64>() * unit / (dimension as f64 * self.species[index].mass)
    }

    /// The part of a velocity that friction may relax in one step.
    pub(crate) fn friction_limit(&self) -> f64 {
        if self.particles().relaxes_in_two_stages() { STAGED_FRICTION_LIMIT } else { FRICTION_LIMIT }
    }

    /// The largest frequency of particles in a fluid, and the species that has it.
    ///
    /// Evenly spread neighbours hold a particle with ω² = Σ aρV(rc)/rc / (d·m), from the radial parts of their force
    /// constants a/rc, which of several repulsions add up. The stiffest mode is that of a crowd of some tens of
    /// particles. For springs in random directions between z neighbours it is stiffer by (1 + √(2d/z))², the edge of
    /// the spectrum of Marchenko and Pastur, doi:10.1070/SM1967v001n04ABEH001994; repulsion makes the crowds fewer, and
    /// of the root a part is left.
    pub(crate) fn largest_repulsion_frequency(&self, force: &PairForce) -> (f64, usize) {
        let dimension = self.units.dimension;
        self.largest(|index| {
            let neighbours = self.neighbours(force, index);
            if neighbours == 0.0 {
                return 0.0;
            }
            let crowded = 1.0 + CROWDING * (2.0 * dimension as f64 / neighbours).sqrt();
            let of_pair = |(other, density): (usize, f64)| force.stiffness(index, other, dimension) * density;
            let stiffness: f64 = self.densities(index).map(of_pair).sum();
            let of_pairs = crowded * (stiffness / (dimension as f64 * self.species[index].mass)).sqrt();
            of_pairs.hypot(self.many_body_stiffness(force).map_or(0.0, |[stiffness, neighbours]| {
                let crowded = 1.0 + CROWDING * (2.0 * dimension as f64 / neighbours).sqrt();
                crowded * (stiffness / self.species[index].mass).sqrt()
            }))
        })
    }

    /// The force constant by which the many-body repulsion of evenly spread neighbours holds a particle, 2Bρ²V(rd)/(rd d), and the number
    /// of these neighbours; none without one.
    ///
    /// ρ is the density of all particles, or of the liquid that they form where they attract each other. Of that Warren's equation of state,
    /// doi:10.1103/PhysRevE.68.066702, has in three dimensions ρ = -a rc⁴/(2B rd⁴) + 4.16 at no pressure, where rd = .75.
    pub(crate) fn many_body_stiffness(&self, force: &PairForce) -> Option<[f64; 2]> {
        let many_body = force.many_body?;
        let (dimension, range) = (self.units.dimension as i32, many_body.cutoff);
        let mean = self.largest(|index| self.densities(index).map(|(_, density)| density).sum()).0;
        let attraction =
            force.largest_attraction(self.units.dimension) / (2.0 * many_body.repulsion * range.powi(dimension + 1));
        let liquid = if attraction > 0.0 { attraction + 4.16 * (0.75 / range).powi(dimension) } else { 0.0 };
        let neighbours = mean.max(liquid) * many_body.sphere();
        let stiffness = 2.0 * many_body.repulsion * mean.max(liquid) * neighbours / (range * f64::from(dimension));
        (neighbours > 0.0).then_some([stiffness, neighbours])
    }

    /// The largest time step that resolves friction and repulsion of pairs; infinite without either.
    pub(crate) fn pair_step(&self) -> f64 {
        let Some(force) = self.particles().pair_force.as_ref() else { return f64::INFINITY };
        let (rate, _) = self.largest_friction_rate(force);
        let (frequency, _) = self.largest_repulsion_frequency(force);
        (self.friction_limit() / rate).min(FREQUENCY_LIMIT / frequency)
    }

    /// Neighbours within their cutoffs of evenly spread particles, for the species that has most.
    pub(crate) fn most_neighbours(&self, force: &PairForce) -> f64 {
        self.largest(|index| self.neighbours(force, index)).0
    }

    /// Neighbours of a particle of a species within their cutoffs, of evenly spread particles.
    fn neighbours(&self, force: &PairForce, index: usize) -> f64 {
        let dimension = self.units.dimension;
        let unit = force.sphere(index, index, dimension);
        self.densities(index)
            .map(|(other, density)| density * (force.sphere(index, other, dimension) / unit))
            .sum::<f64>()
            * unit
    }

    /// Number densities of the species around one, in which no frozen ones are: where the start says where particles are, those of the densest
    /// places there, and not less than in the box.
    pub(crate) fn densities(&self, index: usize) -> impl Iterator<Item = (usize, f64)> {
        let volume = self.units.volume();
        let in_box = move |species: &Species| if species.frozen { 0.0 } else { species.count as f64 / volume };
        let around = self.particles().surroundings.as_ref().and_then(|around| around.densest.get(index));
        let all: f64 = self.species.iter().map(in_box).sum();
        let found = around.map_or(0.0, |around| around.iter().sum());
        let around = around.filter(|_| found > 0.0);
        self.species.iter().enumerate().map(move |(other, species)| {
            let density = around.and_then(|around| around.get(other)).map(|density| density * (all / found).max(1.0));
            (other, density.unwrap_or_else(|| in_box(species)))
        })
    }

    /// The number density of all particles around one, on average at the start.
    pub(crate) fn density_around(&self) -> f64 {
        let around = self.particles().surroundings.as_ref().map_or(0.0, |around| around.mean);
        around.max(self.particle_count() as f64 / self.units.volume())
    }

    /// The largest value of a property among the species that have particles which are not frozen, and the first species that has it.
    fn largest(&self, property: impl Fn(usize) -> f64) -> (f64, usize) {
        let present = |(_, species): &(usize, &Species)| species.count > 0 && !species.frozen;
        self.species.iter().enumerate().filter(present).fold((0.0, 0), |most, (index, _)| {
            let value = property(index);
            if value > most.0 { (value, index) } else { most }
        })
    }
}
