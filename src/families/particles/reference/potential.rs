//! Potentials of a distance: energy, force, virial and curvature of pairs and bonds, for steps and for what is observed alike.

use super::pairs::Pair;
use crate::document::BondPotential;
use crate::families::{PairForce, SoftRepulsion};

/// V, V' and V'' at a distance.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Potential {
    /// V.
    pub energy: f64,
    /// V'.
    pub slope: f64,
    /// V''.
    pub curvature: f64,
}

impl Potential {
    /// The conservative force between particles of two species: the sum of their repulsions, each within its cutoff.
    pub(crate) fn of_pair(force: &PairForce, [a, b]: [usize; 2], distance: f64) -> Self {
        let acting = force.repulsions(a, b).filter(|own| distance < own.cutoff);
        acting.map(|own| Self::of_repulsion(own, distance)).fold(Self::default(), |sum, own| Self {
            energy: sum.energy + own.energy,
            slope: sum.slope + own.slope,
            curvature: sum.curvature + own.curvature,
        })
    }

    /// V = a rc/2 (1 - r/rc)², so V' = -a (1 - r/rc) and V'' = a/rc.
    fn of_repulsion(repulsion: SoftRepulsion, distance: f64) -> Self {
        let SoftRepulsion { strength, cutoff } = repulsion;
        let closeness = 1.0 - distance / cutoff;
        let magnitude = strength * closeness;
        Self { energy: 0.5 * cutoff * magnitude * closeness, slope: -magnitude, curvature: strength / cutoff }
    }

    /// Of a bond of some length; none for a length that is out of reach.
    pub(crate) fn of_bond(potential: Option<&BondPotential>, distance: f64) -> Option<Self> {
        match *potential.unwrap_or(&BondPotential::Harmonic { stiffness: 0.0, length: 0.0 }) {
            BondPotential::Harmonic { stiffness, length } => {
                let extension = distance - length;
                Some(Self {
                    energy: 0.5 * stiffness * extension * extension,
                    slope: stiffness * extension,
                    curvature: stiffness,
                })
            }
            BondPotential::Fene { stiffness, extent, length } => {
                let extension = distance - length;
                let square = (extension / extent).powi(2);
                (square < 1.0).then(|| Self {
                    energy: -0.5 * stiffness * extent * extent * (-square).ln_1p(),
                    slope: stiffness * extension / (1.0 - square),
                    curvature: stiffness * (1.0 + square) / (1.0 - square).powi(2),
                })
            }
        }
    }

    /// The force that pushes both ends apart.
    pub(crate) fn force(&self) -> f64 {
        -self.slope
    }

    /// r·F.
    pub(crate) fn virial(&self, distance: f64) -> f64 {
        distance * self.force()
    }

    /// ∇²V by the position of either end, V'' + (d - 1) V'/r. Two particles in the same place have no direction, and no
    /// derivatives.
    pub(crate) fn laplacian(&self, distance: f64, dimension: usize) -> f64 {
        if distance == 0.0 { 0.0 } else { self.curvature + (dimension - 1) as f64 * self.slope / distance }
    }

    /// ∇V by the position of the first end; by that of the second it is the opposite.
    pub(crate) fn gradient(&self, pair: &Pair) -> [f64; 3] {
        pair.direction().map(|component| self.slope * component)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    use crate::scene;

    fn assert_derivatives(name: &str, distance: f64, at: impl Fn(f64) -> Potential) {
        let (less, more, here) = (at(distance - 1e-5), at(distance + 1e-5), at(distance));
        let slope = (more.energy - less.energy) / 2e-5;
        assert!((slope - here.slope).abs() < 1e-6 * here.slope.abs().max(1.0), "{name} {distance}");
        let curvature = (more.slope - less.slope) / 2e-5;
        assert!((curvature - here.curvature).abs() < 1e-5 * here.curvature, "{name} {distance}");
    }

    #[test]
    fn potentials_of_bonds_have_their_derivatives() {
        let harmonic = BondPotential::Harmonic { stiffness: 3.0, length: 0.7 };
        let finite = BondPotential::Fene { stiffness: 3.0, extent: 1.5, length: 0.2 };
        for potential in [&harmonic, &finite] {
            for distance in [0.1, 0.7, 1.3, 1.65] {
                let at = |distance| Potential::of_bond(Some(potential), distance).unwrap();
                assert_derivatives(&format!("{potential:?}"), distance, at);
            }
        }
        // For a small extension both are the same spring.
        let near = Potential::of_bond(Some(&finite), 0.2 + 1e-4).unwrap();
        assert!((near.energy / (0.5 * 3.0 * 1e-8) - 1.0).abs() < 1e-7);
        assert!(Potential::of_bond(Some(&finite), 1.7).is_none());
    }

    #[test]
    fn potentials_of_pairs_have_their_derivatives() {
        let scene = scene::load("dpd-fluid", &["interactions.0.cutoff=1.3".to_owned()]).unwrap();
        let force = scene.model().particles().pair_force.as_ref().unwrap();
        for distance in [0.1, 0.7, 1.25] {
            assert_derivatives("pair", distance, |distance| Potential::of_pair(force, [0, 0], distance));
        }
    }
}
