//! Potentials of a distance: energy, force, virial and curvature of pairs and bonds, for steps and for what is observed alike.

use super::pairs::Pair;
use crate::document::BondPotential;
use crate::families::particles::terms::electrostatics::Cloud;
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

    /// The same with a largest force, from where on V goes on along a line.
    pub(crate) fn of_limited_bond(potential: Option<&BondPotential>, force: f64, distance: f64) -> Self {
        let (stiffness, length, inverse_extent) =
            match *potential.unwrap_or(&BondPotential::Harmonic { stiffness: 0.0, length: 0.0 }) {
                BondPotential::Harmonic { stiffness, length } => (stiffness, length, 0.0),
                BondPotential::Fene { stiffness, extent, length } => (stiffness, length, 1.0 / extent),
            };
        // K x = F (1 - x²/R²).
        let root = (stiffness * stiffness + (2.0 * force * inverse_extent).powi(2)).sqrt();
        let largest = 2.0 * force / (stiffness + root);
        let extension = distance - length;
        let limited = if stiffness > 0.0 { extension.clamp(-largest, largest) } else { extension };
        let Some(inside) = Self::of_bond(potential, length + limited) else { return Self::default() };
        let beyond = (extension - limited).abs();
        if beyond == 0.0 {
            return inside;
        }
        Self { energy: inside.energy + inside.slope.abs() * beyond, slope: inside.slope, curvature: 0.0 }
    }

    /// What is taken back of two clouds whose energy is C e(ar): of Gaussian ones e = erf(x)/x and a = 1/2σ, of Slater's e = [1 - (1 + x)
    /// e^(-2x)]/x and a = β.
    pub(crate) fn of_excluded_clouds(strength: f64, cloud: Cloud, distance: f64) -> Self {
        match cloud {
            Cloud::Gaussian { width } => Self::of_excluded_gaussians(strength, 0.5 / width, distance),
            Cloud::Slater { decay } => Self::of_excluded_slater_clouds(strength, decay, distance),
        }
    }

    /// With the pull k = -e'/x = [1 - e^(-2x) (1 + 2x + 2x²)]/x³ it is V = -Ca e, V' = Ca³ r k and V'' = Ca³ (4 e^(-2x) - 2k).
    fn of_excluded_slater_clouds(strength: f64, inverse: f64, distance: f64) -> Self {
        let x = inverse * distance;
        let density = (-2.0 * x).exp();
        // Without cancellation where x is small: 4/3 e^(-2x) Σ (2x)^n 3!/(n + 3)!.
        let pull = if x < 1.0 {
            let sum = (4..40).rev().fold(1.0, |sum, term: u32| 1.0 + sum * 2.0 * x / f64::from(term));
            4.0 / 3.0 * density * sum
        } else {
            (1.0 - density * (1.0 + 2.0 * x + 2.0 * x * x)) / x.powi(3)
        };
        let curved = strength * inverse.powi(3);
        Self {
            energy: -strength * inverse * (density * (1.0 + 2.0 * x) + x * x * pull),
            slope: curved * distance * pull,
            curvature: curved * (4.0 * density - 2.0 * pull),
        }
    }

    /// With x = ar and the pull k = (erf(x)/x - 2/√π e^(-x²))/x² it is V = -Ca erf(x)/x, V' = Ca³ r k and V'' = Ca³ (4/√π e^(-x²) - 2k).
    fn of_excluded_gaussians(strength: f64, inverse: f64, distance: f64) -> Self {
        let x = inverse * distance;
        let density = std::f64::consts::FRAC_2_SQRT_PI * (-x * x).exp();
        // Without cancellation where x is small: density Σ 2ⁿ x^(2n-2)/(2n+1)!!.
        let pull = if x < 1.5 {
            let sum = (2..40).rev().fold(1.0, |sum, term: u32| 1.0 + sum * 2.0 * x * x / f64::from(2 * term + 1));
            2.0 / 3.0 * density * sum
        } else {
            (libm::erf(x) / x - density) / (x * x)
        };
        let curved = strength * inverse.powi(3);
        Self {
            energy: -strength * inverse * (density + x * x * pull),
            slope: curved * distance * pull,
            curvature: curved * 2.0 * (density - pull),
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
        assert!((curvature - here.curvature).abs() <= 1e-5 * here.curvature.abs(), "{name} {distance}");
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
        for potential in [&harmonic, &finite] {
            let limited = |distance| Potential::of_limited_bond(Some(potential), 2.0, distance);
            for distance in [0.15, 0.5, 0.9, 1.9, 5.0] {
                assert_derivatives(&format!("limited {potential:?}"), distance, limited);
            }
            assert!((limited(5.0).slope - 2.0).abs() < 1e-12 && limited(0.4).slope.abs() < 2.0);
            assert_eq!(limited(0.5), Potential::of_bond(Some(potential), 0.5).unwrap());
        }
        // For a small extension both are the same spring.
        let near = Potential::of_bond(Some(&finite), 0.2 + 1e-4).unwrap();
        assert!((near.energy / (0.5 * 3.0 * 1e-8) - 1.0).abs() < 1e-7);
        assert!(Potential::of_bond(Some(&finite), 1.7).is_none());
    }

    #[test]
    fn excluded_clouds_have_their_derivatives() {
        for distance in [0.02, 0.5, 1.7, 1.81, 2.0, 4.0] {
            let decay = 0.9;
            for (cloud, charge) in [
                (Cloud::Gaussian { width: 0.6 }, libm::erf(distance / 1.2)),
                (Cloud::Slater { decay }, 1.0 - (1.0 + decay * distance) * (-2.0 * decay * distance).exp()),
            ] {
                let at = |distance| Potential::of_excluded_clouds(1.7, cloud, distance);
                assert_derivatives("clouds", distance, at);
                let expected = -1.7 * charge / distance;
                assert!((at(distance).energy / expected - 1.0).abs() < 1e-13, "{cloud:?} {distance}");
            }
        }
        // On both sides of the place where the form changes.
        for (cloud, place) in [(Cloud::Gaussian { width: 0.6 }, 1.8), (Cloud::Slater { decay: 0.9 }, 1.0 / 0.9)] {
            let [below, above] =
                [place - 1e-12, place + 1e-12].map(|distance| Potential::of_excluded_clouds(1.7, cloud, distance));
            assert!((below.slope - above.slope).abs() < 1e-11 && (below.curvature - above.curvature).abs() < 1e-10);
        }
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
