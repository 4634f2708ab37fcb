//! How fast pair forces act, and the time step that follows.

use super::PairForce;
use crate::families::{Model, Species};
use std::f64::consts::PI;

/// Friction that relaxes a velocity by more than this in one step is not resolved.
const FRICTION_LIMIT: f64 = 0.25;

/// The same of friction that relaxes in two stages: temperatures are right beyond it too, but here particles diffuse a tenth too
/// fast, and with more friction they diffuse as if it were less.
const STAGED_FRICTION_LIMIT: f64 = 0.75;

/// A harmonic oscillator of frequency ω is stable in a Verlet scheme up to ω·dt = 2; half of it leaves some accuracy.
pub(crate) const FREQUENCY_LIMIT: f64 = 1.0;

/// How far chance spreads the stiffness of what surrounds a particle, as a part of what it would be if neighbours were anywhere:
/// repulsion keeps them apart. The largest eigenvalue of the dynamical matrix of fluids in equilibrium has 0.5 to 0.7; 0.75 is that of runs
/// that end, which heat has mixed more.
const CROWDING: f64 = 0.75;

impl Model {
    /// The largest mean friction rate of any species that has particles, and its index: Γ = Σ γρ \[ω\] / (d·m), with \[ω\]
    /// the weight integrated over the sphere (disc).
    pub(crate) fn largest_friction_rate(&self, force: &PairForce) -> (f64, usize) {
        let exponent = force.weight_exponent;
        let weight = match self.units.dimension {
            1 => 2.0 * force.cutoff / (exponent + 1.0),
            2 => 2.0 * PI * force.cutoff.powi(2) / ((exponent + 1.0) * (exponent + 2.0)),
            _ => 8.0 * PI * force.cutoff.powi(3) / ((exponent + 1.0) * (exponent + 2.0) * (exponent + 3.0)),
        };
        self.largest(|index| {
            let sum: f64 = self.densities().map(|(other, density)| force.friction(index, other) * density).sum();
            sum * weight / (self.units.dimension as f64 * self.species[index].mass)
        })
    }

    /// The part of a velocity that friction may relax in one step.
    pub(crate) fn friction_limit(&self) -> f64 {
        if self.particles().relaxes_in_two_stages(self) { STAGED_FRICTION_LIMIT } else { FRICTION_LIMIT }
    }

    /// The largest frequency of particles in a fluid, and the species that has it.
    ///
    /// Evenly spread neighbours hold a particle with ω² = Σ aρV(rc) / (d·rc·m), from the radial parts of their force constants a/rc.
    /// The stiffest mode is that of a crowd of some tens of particles. For springs in random directions between z neighbours it
    /// is stiffer by (1 + √(2d/z))², the edge of the spectrum of Marchenko and Pastur, doi:10.1070/SM1967v001n04ABEH001994; repulsion
    /// makes the crowds fewer, and of the root a part is left.
    pub(crate) fn largest_repulsion_frequency(&self, force: &PairForce) -> (f64, usize) {
        let sphere = self.sphere(force);
        let neighbours = self.mean_neighbours(force);
        if neighbours == 0.0 {
            return (0.0, 0);
        }
        let crowded = 1.0 + CROWDING * (2.0 * self.units.dimension as f64 / neighbours).sqrt();
        self.largest(|index| {
            let stiffness: f64 = self.densities().map(|(other, density)| force.stiffness(index, other) * density).sum();
            let mass = self.species[index].mass;
            crowded * (stiffness * sphere / (self.units.dimension as f64 * force.cutoff * mass)).sqrt()
        })
    }

    /// The largest time step that resolves friction and repulsion of pairs; infinite without either.
    pub(crate) fn pair_step(&self) -> f64 {
        let Some(force) = self.particles().pair_force.as_ref() else { return f64::INFINITY };
        let (rate, _) = self.largest_friction_rate(force);
        let (frequency, _) = self.largest_repulsion_frequency(force);
        (self.friction_limit() / rate).min(FREQUENCY_LIMIT / frequency)
    }

    /// Neighbours within the cutoff of evenly spread particles.
    pub(crate) fn mean_neighbours(&self, force: &PairForce) -> f64 {
        self.densities().map(|(_, density)| density).sum::<f64>() * self.sphere(force)
    }

    /// Volume of the sphere within the cutoff.
    fn sphere(&self, force: &PairForce) -> f64 {
        match self.units.dimension {
            1 => 2.0 * force.cutoff,
            2 => PI * force.cutoff.powi(2),
            _ => 4.0 / 3.0 * PI * force.cutoff.powi(3),
        }
    }

    fn densities(&self) -> impl Iterator<Item = (usize, f64)> {
        let volume = self.units.volume();
        self.species.iter().map(move |species| species.count as f64 / volume).enumerate()
    }

    /// The largest value of a property among the species that have particles, and the first species that has it.
    fn largest(&self, property: impl Fn(usize) -> f64) -> (f64, usize) {
        let present = |(_, species): &(usize, &Species)| species.count > 0;
        self.species.iter().enumerate().filter(present).fold((0.0, 0), |most, (index, _)| {
            let value = property(index);
            if value > most.0 { (value, index) } else { most }
        })
    }
}
