//! Electrostatic forces between charges that are clouds, on a mesh alone: they are so wide that it resolves all of their
//! spectrum, and no pair is computed by itself. For Gaussian ones
//!
//! ```text
//! U = 1/2V Σ_(k≠0) (4π kT lB/k²) e^(-k²σ²) |ρ(k)|² - kT lB Σ q²/(2σ√π),    ρ(k) = Σ q e^(-ik·r)
//! ```
//! Charges are spread in integers, and the potential of a node is rounded to an integer once, so that the force on all charges
//! together is one of rounding; that is taken back, unit by unit, and the total momentum stays what it is to the last bit.

mod cloud;
mod description;
mod direct;
mod exclusions;
mod mesh;
mod plan;
mod reference;
mod scene;

pub use cloud::Cloud;
pub(crate) use description::description;
pub(crate) use mesh::expected_error;
pub(crate) use scene::charged_species;

use super::Term;
use crate::document::{CHARGE_PARTS, Problems};
use crate::families::{Checked, Model, Species};
use std::f64::consts::PI;

/// Electrostatic forces between the charged particles of a model.
#[derive(Debug, Clone, PartialEq)]
pub struct Electrostatics {
    /// kT lB: energy times distance of two unit charges far from each other.
    pub strength: f64,
    /// The density of a charge.
    pub cloud: Cloud,
    /// Nodes of the mesh on each axis.
    pub mesh: [u32; 3],
    /// Points of the splines and of the differences along each axis.
    pub order: u32,
    /// The largest wave number of waves that are summed one by one, in place of a mesh.
    pub largest_wave: Option<f64>,
    /// Particles with a charge, by number.
    pub(crate) charged: Charged,
}

impl Default for Electrostatics {
    fn default() -> Self {
        Self {
            strength: 1.0,
            cloud: Cloud::Gaussian { width: 0.6076 },
            mesh: [20; 3],
            order: 6,
            largest_wave: None,
            charged: Charged::default(),
        }
    }
}

/// Particles with a charge: those of one copy, run by run, and the copies.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Charged {
    /// The first particle of a run, their number and their charge in 2⁻¹⁶ of an elementary charge.
    pub runs: Vec<Run>,
    /// Particles of a copy, those without a charge included.
    pub period: u64,
    /// Number of copies.
    pub copies: u64,
}

/// Particles that follow each other and have one charge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Run {
    pub first: u64,
    pub count: u64,
    pub charge: i32,
}

impl Charged {
    /// Number of particles with a charge.
    pub(crate) fn count(&self) -> u64 {
        self.copies * self.runs.iter().map(|run| run.count).sum::<u64>()
    }

    /// The charge of a particle, in elementary charges.
    pub(crate) fn of(&self, particle: u32) -> f64 {
        // Without copies there is no period.
        let place = u64::from(particle).checked_rem(self.period).unwrap_or(particle.into());
        let before = self.runs.partition_point(|run| run.first <= place).checked_sub(1);
        let run = before.map(|index| self.runs[index]).filter(|run| place < run.first + run.count);
        run.map_or(0.0, |run| f64::from(run.charge) / CHARGE_PARTS)
    }

    /// Number and charge of each of them, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (u64, i32)> + '_ {
        let of_copy = move |copy: u64| {
            self.runs.iter().flat_map(move |run| {
                (0..run.count).map(move |place| (copy * self.period + run.first + place, run.charge))
            })
        };
        (0..self.copies).flat_map(of_copy)
    }

    /// A sum over them of something of their charges in elementary charges.
    pub(crate) fn sum(&self, of: impl Fn(f64) -> f64) -> f64 {
        let of_run = |run: &Run| run.count as f64 * of(f64::from(run.charge) / CHARGE_PARTS);
        self.copies as f64 * self.runs.iter().map(of_run).sum::<f64>()
    }

    /// The largest of them, whatever its sign, in elementary charges.
    pub(crate) fn largest(&self) -> f64 {
        self.runs.iter().map(|run| f64::from(run.charge.unsigned_abs())).fold(0.0, f64::max) / CHARGE_PARTS
    }
}

impl Electrostatics {
    /// Σ q² over all particles.
    pub(crate) fn squares(&self) -> f64 {
        self.charged.sum(|charge| charge * charge)
    }

    /// Energy of charges each by itself, which waves count: of Gaussian ones kT lB Σ q²/(2σ√π).
    pub(crate) fn own_energy(&self) -> f64 {
        self.strength * self.squares() / (2.0 * self.cloud.contact_length())
    }

    /// The Laplacian of the potential that waves count for charges each by itself, which a charge that moves takes along: `1/V Σ_k` (k²
    /// times the spectrum) Σ q², a sum that is an integral ∫ d³k/(2π)³ but for the wave of all zeros.
    pub(crate) fn own_laplacian(&self, volume: f64) -> f64 {
        // All waves less that of all zeros.
        let all = 4.0 * PI * self.strength / self.cloud.volume();
        self.squares() * (all - 4.0 * PI * self.strength / volume)
    }

    /// The part of the charges that can move, by their squares: the Laplacian of the potential with respect to the places of others does not
    /// count.
    pub(crate) fn mobile_part(species: &[Species]) -> f64 {
        let squares = |counts: fn(&Species) -> bool| -> f64 {
            let counted = species.iter().filter(|species| counts(species));
            counted.map(|species| species.count as f64 * species.charge.powi(2)).sum()
        };
        squares(|species| !species.fixed) / squares(|_| true)
    }

    /// The inverse of Debye's length: κ² = 4π lB Σ q²/V.
    pub(crate) fn screening(&self, temperature: f64, volume: f64) -> f64 {
        (4.0 * PI * self.strength / temperature * self.squares() / volume).sqrt()
    }

    /// The square of the frequency at which all charges of one sign swing against those of the other: 4π kT lB/V Σ q²/m of those that can move.
    fn plasma_frequency_squared(&self, model: &Model) -> f64 {
        let mobile = model.species.iter().filter(|species| !species.fixed);
        let of_species = |species: &Species| species.count as f64 * species.charge.powi(2) / species.mass;
        4.0 * PI * self.strength / model.units.lengths.iter().product::<f64>() * mobile.map(of_species).sum::<f64>()
    }

    /// The part of a turn, in radians, that these swings make in a step.
    fn swing(&self, model: &Model) -> f64 {
        self.plasma_frequency_squared(model).sqrt() * model.time_step
    }

    /// The potential of a unit charge at its centre.
    fn contact(&self) -> f64 {
        self.strength / self.cloud.contact_length()
    }
}

impl Term for Electrostatics {
    fn has_potential(&self) -> bool {
        true
    }

    fn check_capacity(&self, scene: &Checked, problems: &mut Problems) {
        scene::check_capacity(scene, self, problems);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn charges_are_found_by_the_number_of_their_particle() {
        let run = |first, count, charge: f64| Run { first, count, charge: (charge * CHARGE_PARTS) as i32 };
        let runs = vec![run(1, 2, 0.5), run(3, 1, -1.5), run(6, 1, 1.0)];
        let in_copy = [0.0, 0.5, 0.5, -1.5, 0.0, 0.0, 1.0, 0.0];
        let copied = Charged { runs: runs.clone(), period: 8, copies: 3 };
        for particle in 0..24 {
            assert_eq!(copied.of(particle), in_copy[particle as usize % 8], "{particle}");
        }
        let single = Charged { runs, period: 0, copies: 1 };
        assert_eq!([0, 2, 3, 6, 7, 100].map(|particle| single.of(particle)), [0.0, 0.5, -1.5, 1.0, 0.0, 0.0]);
        let listed: Vec<(u64, i32)> = copied.iter().collect();
        assert_eq!(listed.len() as u64, copied.count());
        for (particle, charge) in listed {
            assert_eq!(f64::from(charge) / CHARGE_PARTS, copied.of(particle as u32), "{particle}");
        }
    }
}
