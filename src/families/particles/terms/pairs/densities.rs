//! Many-body dissipative particle dynamics: the local densities of a state, and what follows from the energies ψ(ρ̄ᵢ) of its
//! particles.
//!
//! ```text
//! ρ̄ᵢ = Σ w(rᵢⱼ) over all j ≠ i,   w(r) = C (1 - r/rd)² within rd,   V = Σ ψ(ρ̄ᵢ),   ψ = K ρ̄²
//! Fᵢⱼ = -[ψ'(ρ̄ᵢ) + ψ'(ρ̄ⱼ)] w'(rᵢⱼ) e = B (ρ̄ᵢ + ρ̄ⱼ) (1 - rᵢⱼ/rd) e
//! ∇ᵢ²V = ψ''(ρ̄ᵢ) |Σ w' e|² + Σ { ψ'' w'² + [ψ'(ρ̄ᵢ) + ψ'(ρ̄ⱼ)] (w'' + (d - 1) w'/r) }
//! ```
//! Warren, doi:10.1103/PhysRevE.68.066702, with K = πrd⁴B/30 in three dimensions.

use crate::families::particles::reference::{Configuration, Pair};
use crate::families::{ManyBodyForce, Model};
use std::f64::consts::PI;

/// The local densities of all particles.
pub(crate) struct Densities {
    law: ManyBodyForce,
    dimension: usize,
    /// ρ̄ of each.
    of_particles: Vec<f64>,
}

impl Densities {
    /// Those of the particles of the pairs that are found, which are all within the range; none if no force depends on them.
    pub(crate) fn of(model: &Model, particles: usize, found: &[Pair]) -> Option<Self> {
        let law = model.particles().pair_force.as_ref()?.many_body?;
        let mut sums = Self { law, dimension: model.units.dimension, of_particles: vec![0.0; particles] };
        for pair in found {
            let weight = sums.weight(pair.distance)[0];
            sums.of_particles[pair.first] += weight;
            sums.of_particles[pair.second] += weight;
        }
        Some(sums)
    }

    /// Adds the potential of the densities of some pairs.
    pub(crate) fn observe(&self, found: &[Pair], sums: &mut Configuration<'_>) {
        sums.potential += self.energy();
        for pair in found {
            let (force, laplacian) = (self.force(pair), self.laplacian(pair));
            sums.virial += sums.mobile_share(pair) * pair.distance * force;
            for (end, sign) in [(pair.first, -1.0), (pair.second, 1.0)] {
                sums.laplacians[end] += laplacian;
                for (axis, component) in pair.direction().into_iter().enumerate() {
                    sums.gradients[end][axis] += sign * force * component;
                }
            }
        }
        for (sum, laplacian) in sums.laplacians.iter_mut().zip(self.laplacians_of_particles(found)) {
            *sum += laplacian;
        }
    }

    /// w, w' and w''.
    fn weight(&self, distance: f64) -> [f64; 3] {
        let range = self.law.cutoff;
        if distance >= range {
            return [0.0; 3];
        }
        let norm = if self.dimension == 2 { 6.0 / (PI * range.powi(2)) } else { 7.5 / (PI * range.powi(3)) };
        let closeness = 1.0 - distance / range;
        [norm * closeness * closeness, -2.0 * norm * closeness / range, 2.0 * norm / (range * range)]
    }

    /// K of ψ = K ρ̄².
    fn strength(&self) -> f64 {
        let (range, repulsion) = (self.law.cutoff, self.law.repulsion);
        if self.dimension == 2 { PI * range.powi(3) * repulsion / 24.0 } else { PI * range.powi(4) * repulsion / 30.0 }
    }

    /// ψ'(ρ̄ᵢ) + ψ'(ρ̄ⱼ).
    fn slopes(&self, pair: &Pair) -> f64 {
        2.0 * self.strength() * (self.of_particles[pair.first] + self.of_particles[pair.second])
    }

    /// The force that pushes both particles apart.
    pub(crate) fn force(&self, pair: &Pair) -> f64 {
        -self.slopes(pair) * self.weight(pair.distance)[1]
    }

    /// V.
    pub(crate) fn energy(&self) -> f64 {
        self.strength() * self.of_particles.iter().map(|density| density * density).sum::<f64>()
    }

    /// The parts of ∇²V by the positions of both ends that belong to a pair; two particles in one place have none.
    pub(crate) fn laplacian(&self, pair: &Pair) -> f64 {
        if pair.distance == 0.0 {
            return 0.0;
        }
        let [_, slope, curvature] = self.weight(pair.distance);
        let laplacian = curvature + (self.dimension - 1) as f64 * slope / pair.distance;
        2.0 * self.strength() * slope * slope + self.slopes(pair) * laplacian
    }

    /// The rest of ∇²V, ψ'' |∇ρ̄ᵢ|², of every particle.
    pub(crate) fn laplacians_of_particles(&self, found: &[Pair]) -> Vec<f64> {
        let mut gradients = vec![[0.0; 3]; self.of_particles.len()];
        for pair in found {
            let slope = self.weight(pair.distance)[1];
            for (axis, component) in pair.direction().into_iter().enumerate() {
                gradients[pair.first][axis] += slope * component;
                gradients[pair.second][axis] -= slope * component;
            }
        }
        let square = |gradient: &[f64; 3]| gradient.iter().map(|slope| slope * slope).sum::<f64>();
        gradients.iter().map(|gradient| 2.0 * self.strength() * square(gradient)).collect()
    }
}
