//! The repulsion of many-body dissipative particle dynamics, doi:10.1103/PhysRevE.68.066702.

use super::scene::{MOST_DIFFERENT, largest_cutoff};
use crate::document::{DpdInteraction, ManyBody, Problems, Scene, SpeciesNames};
use std::f64::consts::PI;

/// A repulsion that derives from an energy ψ(ρ̄ᵢ) of every particle in its local density ρ̄ᵢ = Σ w(rᵢⱼ) over all others, with the weight
/// w(r) = C (1 - r/rd)² of integral 1: C = 15/(2πrd³) in three dimensions, 6/(πrd²) in two. With ψ = ¼ B C rd (ρ̄/C)², which in three
/// dimensions is πrd⁴Bρ̄²/30, the force between two particles is B (ρ̄ᵢ + ρ̄ⱼ) (1 - r/rd).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ManyBodyForce {
    /// Strength B, a force per density.
    pub repulsion: f64,
    /// Range rd.
    pub cutoff: f64,
    /// Number of axes of the box.
    dimension: usize,
}

impl ManyBodyForce {
    pub(super) fn new(many_body: ManyBody, dimension: usize) -> Self {
        Self { repulsion: many_body.repulsion, cutoff: many_body.cutoff, dimension }
    }

    /// The density C that another particle in the same place adds.
    ///
    /// ```
    /// use mesoscope::scene;
    ///
    /// let liquid = r#"interactions.0.many_body={"repulsion":25,"cutoff":0.75}"#.to_owned();
    /// let model = scene::load("dpd-fluid", &[liquid])?.model().clone();
    /// let many_body = model.particles().pair_force.as_ref().and_then(|force| force.many_body);
    /// let density = many_body.map_or(0.0, |many_body| many_body.contact_density());
    /// assert!((density - 7.5 / (std::f64::consts::PI * 0.75_f64.powi(3))).abs() < 1e-12);
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn contact_density(&self) -> f64 {
        match self.dimension {
            2 => 6.0 / (PI * self.cutoff.powi(2)),
            _ => 15.0 / (2.0 * PI * self.cutoff.powi(3)),
        }
    }

    /// ψ, the energy of a particle where the density around it is ρ̄.
    pub(crate) fn self_energy(&self, density: f64) -> f64 {
        0.25 * self.repulsion * self.cutoff * density * density / self.contact_density()
    }

    /// The sum of the magnitudes of its forces on a particle among evenly spread ones of a density, 2Bρ²∫(1 - r/rd) dV.
    pub(crate) fn strain(&self, density: f64) -> f64 {
        2.0 * self.repulsion * density * density * self.sphere() / (self.dimension as f64 + 1.0)
    }

    /// Volume of the sphere (disc) within its range.
    pub(crate) fn sphere(&self) -> f64 {
        match self.dimension {
            2 => PI * self.cutoff.powi(2),
            _ => 4.0 / 3.0 * PI * self.cutoff.powi(3),
        }
    }
}

/// Checks the many-body repulsion of an interaction by itself.
pub(super) fn check(
    scene: &Scene,
    species: &SpeciesNames<'_>,
    dpd: &DpdInteraction,
    path: &str,
    problems: &mut Problems,
) {
    for (index, pair) in dpd.pairs.iter().enumerate().filter(|(_, pair)| pair.many_body.is_some()) {
        if pair.many_body != dpd.many_body {
            let accepted = format!(
                "that of {path}.many_body: local densities are of all particles, and with different coefficients no potential has \
                 these forces (Warren, doi:10.1103/PhysRevE.87.045303); pairs of species differ in their `repulsion`"
            );
            let found = "another many-body repulsion than that of the interaction";
            problems.refuse(format!("{path}.pairs[{index}].many_body"), found, accepted);
        }
    }
    // Without species there is no pair whose cutoff it could be compared with.
    let Some(many_body) = dpd.acting_many_body().filter(|_| species.count() > 0) else { return };
    let largest = largest_cutoff(scene, species);
    if many_body.cutoff > largest {
        let accepted = format!("at most {largest}, the largest cutoff of pairs, which are looked for within it");
        problems.refuse(format!("{path}.many_body.cutoff"), many_body.cutoff, accepted);
    } else if many_body.cutoff < largest / MOST_DIFFERENT {
        let accepted = format!("at least {}, a hundredth of the largest cutoff", largest / MOST_DIFFERENT);
        problems.refuse(format!("{path}.many_body.cutoff"), many_body.cutoff, accepted);
    }
}
