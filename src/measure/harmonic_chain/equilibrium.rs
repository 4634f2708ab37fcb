//! Exact variances of clusters in equilibrium, between fixed ends. Indices of clusters count from 0.
//!
//! With displacements of beads of covariance kT/κ A⁻¹, those of clusters of n have, to order n/N,
//! `⟨XXᵀ⟩ = (kTn/κ) [A⁻¹ - (1 - n⁻²)/6]`. Equations (26) and (27) of Español 1996, doi:10.1103/PhysRevE.53.1572, miss the
//! second part, which a chain of clusters joined by springs κ/n does not have either: its neighbours are further apart.
//! Here the ends are exact too: the fixed bead is one bead, not one cluster, from its neighbour.

use crate::families::{HarmonicChain, SpringChain};

/// ⟨P²⟩ = nmkT of a cluster, of beads or whole.
///
/// ```
/// use mesoscope::measure::harmonic_chain::equilibrium::momentum_variance;
/// use mesoscope::families::HarmonicChain;
///
/// let chain = HarmonicChain { clusters: 14, cluster_size: 16, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };
///
/// // Sixteen beads of mass 1 at kT = 0.25.
/// assert_eq!(momentum_variance(&chain, 0.25), 4.0);
/// ```
#[must_use]
pub fn momentum_variance(chain: &HarmonicChain, temperature: f64) -> f64 {
    chain.frictionless().mass * temperature
}

/// `⟨X_μ X_ν⟩` of the clusters of a chain of beads.
#[must_use]
#[cfg(test)]
fn cluster_covariance(chain: &HarmonicChain, temperature: f64, clusters: [usize; 2]) -> f64 {
    let size = chain.cluster_size as f64;
    let length = chain.micro().beads as f64 + 1.0;
    let [left, right] = [clusters[0].min(clusters[1]), clusters[0].max(clusters[1])]
        .map(|cluster| cluster as f64 * size + 0.5 * (size + 1.0));
    // The mean of min(i, j) over a cluster is less than its middle by a sixth of its size.
    let own = if clusters[0] == clusters[1] { (size - 1.0 / size) / 6.0 } else { 0.0 };
    temperature / chain.stiffness * (left * (length - right) / length - own)
}

/// The variance of `X_{μ+1} - X_μ` of the clusters of a chain of beads, (kTn/κ) [(2 + n⁻²)/3 - n/(N+1)], in which the last
/// part is that of the fixed ends.
///
/// ```
/// use mesoscope::measure::harmonic_chain::equilibrium::cluster_separation_variance;
/// use mesoscope::families::HarmonicChain;
///
/// let chain = HarmonicChain { clusters: 14, cluster_size: 16, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };
///
/// // Two thirds of n kT/κ = 4, less a fourteenth of it for the fixed ends.
/// assert!((cluster_separation_variance(&chain, 0.25) - 4.0 * (2.0 / 3.0 - 1.0 / 14.0)).abs() < 0.01);
/// ```
#[must_use]
pub fn cluster_separation_variance(chain: &HarmonicChain, temperature: f64) -> f64 {
    let size = chain.cluster_size as f64;
    let length = chain.micro().beads as f64 + 1.0;
    temperature * size / chain.stiffness * ((2.0 + size.powi(-2)) / 3.0 - size / length)
}

/// The variance of `x_{i+1} - x_i` of a chain, kT/κ [1 - 1/(N+1)]; of clusters, that of springs κ/n.
///
/// ```
/// use mesoscope::measure::harmonic_chain::equilibrium::separation_variance;
/// use mesoscope::families::SpringChain;
///
/// let chain = SpringChain { beads: 9, mass: 1.0, stiffness: 2.0, friction: 0.0 };
/// assert_eq!(separation_variance(&chain, 1.0), 0.5 * 0.9);
/// ```
#[must_use]
pub fn separation_variance(chain: &SpringChain, temperature: f64) -> f64 {
    temperature / chain.stiffness * (1.0 - 1.0 / (chain.beads as f64 + 1.0))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use nalgebra::DMatrix;

    const CHAIN: HarmonicChain =
        HarmonicChain { clusters: 6, cluster_size: 5, mass: 2.0, stiffness: 3.0, reduced_friction: 0.5 };

    fn inverse_rouse(beads: usize) -> DMatrix<f64> {
        let entry = |i: usize, j: usize| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        };
        DMatrix::from_fn(beads, beads, entry).try_inverse().unwrap()
    }

    /// Against kT/κ A⁻¹ of all beads, averaged over clusters.
    #[test]
    fn covariances_are_those_of_the_matrix_of_all_beads() {
        let beads = inverse_rouse(30) * (1.5 / 3.0);
        let covariance = |a: usize, b: usize| beads.view((5 * a, 5 * b), (5, 5)).sum() / 25.0;
        for a in 0..6 {
            for b in 0..6 {
                let found = cluster_covariance(&CHAIN, 1.5, [a, b]);
                assert!((found - covariance(a, b)).abs() < 1e-12, "{a} {b}");
            }
            if a > 0 {
                let apart = covariance(a, a) + covariance(a - 1, a - 1) - 2.0 * covariance(a, a - 1);
                assert!((cluster_separation_variance(&CHAIN, 1.5) - apart).abs() < 1e-12);
            }
        }
        let [own, next] = [beads[(7, 7)] + beads[(8, 8)], beads[(7, 8)]];
        assert!((separation_variance(&CHAIN.micro(), 1.5) - (own - 2.0 * next)).abs() < 1e-12);
    }

    /// Far from the ends of a long chain the covariances differ from those of the springs κ/n by the diagonal only:
    /// here by second differences, which the ends do not enter.
    #[test]
    fn clusters_of_beads_are_closer_together_than_their_springs_say() {
        let long = HarmonicChain { clusters: 10_000, ..CHAIN };
        let bulk = 1.5 * 5.0 / 3.0;
        let beads = cluster_separation_variance(&long, 1.5) / bulk;
        assert!((beads - (2.0 + 1.0 / 25.0) / 3.0).abs() < 2e-4, "{beads}");
        let springs = separation_variance(&long.dissipative(), 1.5) / bulk;
        assert!((springs - 1.0).abs() < 2e-4, "{springs}");
        assert_eq!(momentum_variance(&CHAIN, 1.5), 5.0 * 2.0 * 1.5);
    }

    /// `⟨XXᵀ⟩ = (kTn/κ)[A⁻¹ - (1 - n⁻²)/6]` where single beads are the clusters: the inverse matrix itself.
    #[test]
    fn single_beads_are_the_inverse_matrix() {
        let single = HarmonicChain { clusters: 8, cluster_size: 1, ..CHAIN };
        let inverse = inverse_rouse(8);
        for (a, b) in [(0, 0), (2, 5), (7, 6)] {
            assert!((cluster_covariance(&single, 3.0, [a, b]) - inverse[(a, b)]).abs() < 1e-12);
        }
    }
}
