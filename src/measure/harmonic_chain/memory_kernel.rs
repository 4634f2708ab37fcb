//! The memory that a harmonic chain has of the momenta of its clusters.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::f64::consts::{FRAC_PI_2, PI};

/// The exact memory kernel of a cluster in the middle of others, in units of the beads: ω₀ = m = κ = 1.
///
/// With the beads' matrix in the basis of cluster means Q and of all other coordinates R, the momenta of clusters obey
/// the generalised Langevin equation of Mori with
///
/// K(t) = D_QR D_RR⁻¹ cos(√D_RR t) D_RQ,
///
/// the force of beads that move while the means are clamped. If it decayed at once, ∫K = (γ/nm)A, equation (41) of Español
/// 1996, doi:10.1103/PhysRevE.53.1572. But the clamped beads have a lowest frequency, near πω₀/n, so the integral over
/// all times is zero: there is only a plateau at ω₀t ≪ n.
#[derive(Debug, Clone, PartialEq)]
pub struct MemoryKernel {
    cluster_size: usize,
    /// Frequency and weight of every mode of the clamped beads: K(t) = Σ weight cos(frequency t).
    modes: Vec<[f64; 2]>,
}

/// The plateau of the running integral.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plateau {
    /// Its height at ω₀t → 0: the friction γ*.
    pub friction: f64,
    /// Its slope against ω₀t.
    pub slope: f64,
    /// The range of ω₀t it was taken from.
    pub range: [f64; 2],
}

impl MemoryKernel {
    /// The kernel of the middle one of `clusters` clusters of `cluster_size` beads between fixed ends. What comes back
    /// from the ends needs ω₀t = (clusters - 1) × `cluster_size`; before that the number of clusters makes no difference.
    /// Takes of the order of (`clusters` × `cluster_size`)³ operations.
    #[must_use]
    pub fn new(cluster_size: usize, clusters: usize) -> Self {
        let internal = internal_coordinates(cluster_size);
        let width = internal.ncols();
        let total = clusters * width;
        // Inside a cluster the beads' matrix is the same in every cluster; neighbours share one spring.
        let own = DMatrix::from_fn(cluster_size, cluster_size, |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0,
        });
        let block = internal.transpose() * &own * &internal;
        let [first, last] =
            [0, cluster_size.saturating_sub(1)].map(|bead| internal.row(bead.min(cluster_size)).transpose());
        let neighbour = -(&last * first.transpose());
        let mut matrix = DMatrix::zeros(total, total);
        for cluster in 0..clusters {
            let at = cluster * width;
            matrix.view_mut((at, at), (width, width)).copy_from(&block);
            if cluster + 1 < clusters {
                matrix.view_mut((at, at + width), (width, width)).copy_from(&neighbour);
                matrix.view_mut((at + width, at), (width, width)).copy_from(&neighbour.transpose());
            }
        }
        let mean = 1.0 / (cluster_size as f64).sqrt();
        let middle = clusters / 2;
        let mut coupling = DVector::zeros(total);
        coupling.rows_mut(middle * width, width).copy_from(&((&first + &last) * mean));
        if middle > 0 {
            coupling.rows_mut((middle - 1) * width, width).copy_from(&(&last * -mean));
        }
        if middle + 1 < clusters {
            coupling.rows_mut((middle + 1) * width, width).copy_from(&(&first * -mean));
        }
        let eigen = SymmetricEigen::new(matrix);
        let projections = eigen.eigenvectors.tr_mul(&coupling);
        let mode = |(eigenvalue, projection): (&f64, &f64)| [eigenvalue.sqrt(), projection * projection / eigenvalue];
        Self { cluster_size, modes: eigen.eigenvalues.iter().zip(projections.iter()).map(mode).collect() }
    }

    /// Number n of beads in a cluster.
    #[must_use]
    pub fn cluster_size(&self) -> usize {
        self.cluster_size
    }

    /// K at a time ω₀t, in units of ω₀².
    #[must_use]
    pub fn value(&self, time: f64) -> f64 {
        self.modes.iter().map(|[frequency, weight]| weight * (frequency * time).cos()).sum()
    }

    /// n/2 ∫K from 0 to a time ω₀t: the friction γ* = γ/√(mκ) that a kernel so short would amount to.
    #[must_use]
    pub fn running_friction(&self, time: f64) -> f64 {
        self.integral(time, 0.0)
    }

    /// The same, averaged over the fastest oscillation, of frequency 2ω₀: twice over a time π/ω₀, so that a straight line
    /// stays one.
    #[must_use]
    pub fn averaged_friction(&self, time: f64) -> f64 {
        self.integral(time, PI)
    }

    /// The lowest frequency of the clamped beads, in units of ω₀.
    #[must_use]
    pub fn lowest_frequency(&self) -> f64 {
        self.modes.iter().map(|[frequency, _]| *frequency).fold(f64::INFINITY, f64::min)
    }

    /// The plateau: a straight line through the averaged running integral in π < ω₀t < n/8, continued to zero. None for
    /// clusters of fewer than 64 beads, whose memory ends before the plateau begins.
    #[must_use]
    pub fn plateau(&self) -> Option<Plateau> {
        const SAMPLES: usize = 200;
        let range = [PI, self.cluster_size as f64 / 8.0];
        if self.cluster_size < 64 {
            return None;
        }
        let times = (0..SAMPLES).map(|j| range[0] + (range[1] - range[0]) * j as f64 / (SAMPLES - 1) as f64);
        let points: Vec<[f64; 2]> = times.map(|time| [time, self.averaged_friction(time)]).collect();
        let mean = |axis: usize| points.iter().map(|point| point[axis]).sum::<f64>() / SAMPLES as f64;
        let [time, friction] = [mean(0), mean(1)];
        let product: f64 = points.iter().map(|point| (point[0] - time) * (point[1] - friction)).sum();
        let square: f64 = points.iter().map(|point| (point[0] - time).powi(2)).sum();
        let slope = product / square;
        Some(Plateau { friction: friction - slope * time, slope, range })
    }

    fn integral(&self, time: f64, width: f64) -> f64 {
        let part = |[frequency, weight]: &[f64; 2]| {
            let half = 0.5 * width * frequency;
            let average = if half > 0.0 { (half.sin() / half).powi(2) } else { 1.0 };
            weight * average * (frequency * time).sin() / frequency
        };
        0.5 * self.cluster_size as f64 * self.modes.iter().map(part).sum::<f64>()
    }
}

/// An orthonormal basis of the coordinates of a cluster that leave its mean where it is: cosines.
fn internal_coordinates(cluster_size: usize) -> DMatrix<f64> {
    let size = cluster_size as f64;
    DMatrix::from_fn(cluster_size, cluster_size.saturating_sub(1), |bead, wave| {
        (2.0 / size).sqrt() * (PI * (wave + 1) as f64 * (bead as f64 + 0.5) / size).cos()
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// K(0) = D_QR D_RR⁻¹ D_RQ, by elimination of the clamped means from the beads' matrix itself: the Schur complement,
    /// with a basis that is no basis of cosines.
    #[test]
    fn the_kernel_begins_with_what_the_beads_screen() {
        let (n, clusters) = (6, 5);
        let beads = DMatrix::from_fn(n * clusters, n * clusters, |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0_f64,
        });
        let means =
            DMatrix::from_fn(n * clusters, clusters, |i, c| if i / n == c { 1.0 / (n as f64).sqrt() } else { 0.0 });
        // (Qᵀ D⁻¹ Q)⁻¹ = D_QQ - D_QR D_RR⁻¹ D_RQ.
        let eliminated = (means.transpose() * beads.clone().try_inverse().unwrap() * &means).try_inverse().unwrap();
        let direct = means.transpose() * beads * &means;
        let expected = direct[(2, 2)] - eliminated[(2, 2)];
        let found = MemoryKernel::new(n, clusters).value(0.0);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }

    /// The generalised Langevin equation with this kernel gives the exact momentum autocorrelation of a cluster. With a
    /// single cluster it is a scalar equation: Ċ = -Ω² ∫C - ∫K C, integrated by the trapezoidal rule.
    #[test]
    fn the_kernel_moves_a_cluster_as_its_beads_do() {
        use crate::measure::harmonic_chain::NormalModes;
        use crate::model::SpringChain;
        let n = 8;
        let kernel = MemoryKernel::new(n, 1);
        // The whole restoring force on the mean, 2/n, less what the beads screen.
        let square = 2.0 / n as f64 - kernel.value(0.0);
        let (step, steps) = (0.01, 1500);
        let memory: Vec<f64> = (0..=steps).map(|j| kernel.value(step * j as f64)).collect();
        let rate = |found: &[f64]| {
            let last = found.len() - 1;
            let ends = |j: usize| if j == 0 || j == last { 0.5 } else { 1.0 };
            -(0..=last).map(|j| ends(j) * step * found[j] * (square + memory[last - j])).sum::<f64>()
        };
        let mut found = vec![1.0];
        let mut before = 0.0;
        for _ in 0..steps {
            // Heun's rule: predict, then correct with the mean of both rates.
            let now = *found.last().unwrap();
            found.push(now + step * before);
            let after = rate(&found);
            *found.last_mut().unwrap() = now + 0.5 * step * (before + after);
            before = rate(&found);
        }
        let chain = SpringChain { beads: n, mass: 1.0, stiffness: 1.0, friction: 0.0 };
        let times: Vec<f64> = (0..=15).map(f64::from).collect();
        let exact = NormalModes::new(chain).momentum_autocorrelation(n, &times);
        for (second, exact) in exact.iter().enumerate() {
            assert!((found[100 * second] - exact).abs() < 2e-4, "t = {second}: {} {exact}", found[100 * second]);
        }
    }

    /// More clusters change nothing before a wave comes back from the ends.
    #[test]
    fn the_ends_are_far_away() {
        let [three, seven] = [3, 7].map(|clusters| MemoryKernel::new(16, clusters));
        for time in [0.0, 3.0, 10.0, 24.0] {
            assert!((three.running_friction(time) - seven.running_friction(time)).abs() < 1e-4, "{time}");
        }
        assert!((three.running_friction(60.0) - seven.running_friction(60.0)).abs() > 1e-2);
    }

    /// γ* → ½: with clusters of 64 and 256 beads .4966 and .4974.
    #[test]
    fn the_plateau_lies_at_one_half() {
        for size in [64, 128, 256] {
            let kernel = MemoryKernel::new(size, 3);
            let plateau = kernel.plateau().unwrap();
            assert!((0.495..0.5).contains(&plateau.friction), "{size}: {plateau:?}");
            assert!(plateau.slope < 0.0);
        }
        assert_eq!(MemoryKernel::new(16, 3).plateau(), None);
    }

    /// A sum of sines of a lowest frequency πω₀/n and above has no mean: so has the integral over all times. Its mean over
    /// many periods of the lowest frequency ends within their number's share of its height.
    #[test]
    fn the_integral_over_all_times_is_zero() {
        let kernel = MemoryKernel::new(16, 9);
        assert!((kernel.lowest_frequency() * 16.0 - PI).abs() < 0.1, "{}", kernel.lowest_frequency());
        let long = 2000.0 * FRAC_PI_2 / kernel.lowest_frequency();
        let mean =
            (0..40_000).map(|j| kernel.running_friction(long * (f64::from(j) + 0.5) / 40_000.0)).sum::<f64>() / 4e4;
        assert!(mean.abs() < 1e-3, "{mean}");
    }
}
