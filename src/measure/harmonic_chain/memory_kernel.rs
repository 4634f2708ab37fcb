//! The memory that a harmonic chain has of the momenta of its clusters.

use crate::measure::line::weighted_line;
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use std::f64::consts::{PI, TAU};

/// Clusters of a ring that stands for an endless chain. What goes round it needs ω₀t = `RING` × n, and forces on clusters held
/// fixed fall off by 2 + √3 from one to the next.
const RING: usize = 32;

/// The exact memory kernel of a cluster of an endless chain, in units of the beads: ω₀ = m = κ = 1.
///
/// With the beads' matrix in the basis of cluster means Q and of all other coordinates R, the momenta of clusters obey
/// the generalised Langevin equation of Mori with
///
/// `K(t) = D_QR D_RR⁻¹ cos(√D_RR t) D_RQ`,
///
/// the force of beads that move while the means are clamped. If it decayed at once, ∫K = (γ/nm)A, equation (41) of Español
/// 1996, doi:10.1103/PhysRevE.53.1572. But the clamped beads have a lowest frequency, near πω₀/n, so the integral over
/// all times is zero: there is only a plateau at ω₀t ≪ n.
///
/// ```
/// use mesoscope::measure::harmonic_chain::MemoryKernel;
///
/// let kernel = MemoryKernel::new(64);
/// // The friction of large clusters is ½, as long as no wave has crossed them.
/// assert!(kernel.plateau().is_some_and(|plateau| (plateau.friction - 0.5).abs() < 0.02));
/// assert!(kernel.averaged_friction(64.0) < 0.2);
/// assert_eq!(MemoryKernel::new(8).plateau(), None);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MemoryKernel {
    /// Number n of beads in a cluster.
    pub(crate) cluster_size: usize,
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
    /// The kernel of a cluster of `cluster_size` beads. Takes of the order of `cluster_size`³ operations, a few hundred times.
    #[must_use]
    pub fn new(cluster_size: usize) -> Self {
        let waves = (1..=RING / 2).map(|wave| {
            let share = if 2 * wave == RING { 1.0 } else { 2.0 };
            (share / RING as f64, TAU * wave as f64 / RING as f64)
        });
        let modes = waves.flat_map(|(share, phase)| {
            wave_modes(cluster_size, phase).into_iter().map(move |[frequency, weight]| [frequency, share * weight])
        });
        Self { cluster_size, modes: modes.collect() }
    }

    /// K at a time ω₀t, in units of ω₀².
    #[must_use]
    #[cfg(test)]
    fn value(&self, time: f64) -> f64 {
        self.modes.iter().map(|[frequency, weight]| weight * (frequency * time).cos()).sum()
    }

    /// n/2 ∫K from 0 to a time ω₀t: the friction γ* = γ/√(mκ) that a kernel so short would amount to.
    pub(crate) fn running_friction(&self, time: f64) -> f64 {
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
    #[cfg(test)]
    fn lowest_frequency(&self) -> f64 {
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
        let points: Vec<_> = times.map(|time| (time, self.averaged_friction(time), 1.0)).collect();
        let line = weighted_line(points.into_iter())?;
        Some(Plateau { friction: line.intercept, slope: line.slope, range })
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

/// Frequencies and weights of the kernel of a wave of clusters, of which each is ahead of the last by a phase θ.
///
/// Cosines cos(πk(i + ½)/n), k = 1 … n - 1, are the modes of the free beads of a cluster. The springs between clusters add one
/// vector's product with itself, and it is that vector through which the means act: with f the amplitudes of the cosines
/// at the first bead and a = 2f sin(θ/2) for even k, 2f cos(θ/2) for odd k (the latter a quarter of a turn apart in phase),
/// `D_RR = 4 sin²(πk/2n) + a aᵀ` and `D_RQ = 2 sin(θ/2) a/√n`.
fn wave_modes(cluster_size: usize, phase: f64) -> Vec<[f64; 2]> {
    let size = cluster_size as f64;
    let (sine, cosine) = (0.5 * phase).sin_cos();
    let inner = cluster_size.saturating_sub(1);
    let half_angle = |index: usize| PI * (index + 1) as f64 / (2.0 * size);
    let joint = DVector::from_fn(inner, |index, _| {
        let first = (2.0 / size).sqrt() * half_angle(index).cos();
        2.0 * first * if index % 2 == 1 { sine } else { cosine }
    });
    let free = DMatrix::from_diagonal(&DVector::from_fn(inner, |index, _| 4.0 * half_angle(index).sin().powi(2)));
    let eigen = SymmetricEigen::new(free + &joint * joint.transpose());
    let projections = eigen.eigenvectors.tr_mul(&joint);
    let coupling = 4.0 * sine * sine / size;
    let mode =
        |(eigenvalue, projection): (&f64, &f64)| [eigenvalue.sqrt(), coupling * projection * projection / eigenvalue];
    eigen.eigenvalues.iter().zip(projections.iter()).map(mode).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    /// K(t) of the middle one of some clusters between fixed ends, from matrices of all beads: with `P = 1 - QQᵀ`, the clamped
    /// beads move by PDP, of which the means are null vectors.
    fn between_ends(n: usize, clusters: usize, times: &[f64]) -> Vec<f64> {
        let beads = DMatrix::from_fn(n * clusters, n * clusters, |i, j| match i.abs_diff(j) {
            0 => 2.0,
            1 => -1.0,
            _ => 0.0_f64,
        });
        let mean = |i: usize, c: usize| if i / n == c { 1.0 / (n as f64).sqrt() } else { 0.0 };
        let means = DMatrix::from_fn(n * clusters, clusters, mean);
        let projector = DMatrix::identity(n * clusters, n * clusters) - &means * means.transpose();
        let force = &projector * &beads * means.column(clusters / 2);
        let eigen = SymmetricEigen::new(&projector * beads * &projector);
        let projections = eigen.eigenvectors.tr_mul(&force);
        let modes: Vec<(f64, f64)> = eigen.eigenvalues.iter().copied().zip(projections.iter().copied()).collect();
        let moving = || modes.iter().filter(|(eigenvalue, _)| *eigenvalue > 1e-9);
        times.iter().map(|t| moving().map(|(d, p)| p * p / d * (d.sqrt() * t).cos()).sum()).collect()
    }

    /// Nine clusters are nearly endless until what they send to the ends comes back.
    #[test]
    fn the_kernel_is_that_of_a_cluster_among_many() {
        let n = 12;
        let kernel = MemoryKernel::new(n);
        let times = [0.0, 0.5, 3.0, 10.0, 24.0];
        for (time, expected) in times.iter().zip(between_ends(n, 9, &times)) {
            assert!((kernel.value(*time) - expected).abs() < 2e-4, "{time}: {} {expected}", kernel.value(*time));
        }
        let few = between_ends(n, 3, &[0.0])[0];
        assert!((kernel.value(0.0) - few).abs() > 1e-3, "{few}");
    }

    /// The generalised Langevin equation with this kernel gives the exact motion of a wave of clusters,
    /// C = Σ [sin(nq/2)/(n sin(q/2))]² cos(2 sin(q/2) t) over the beads' waves q = (θ + 2πm)/n. Integrated by the trapezoidal
    /// rule: Ċ = -∫ (Ω² + K(t - t')) C(t') dt', where Ω² is the force on the means less what the beads screen.
    #[test]
    fn the_kernel_moves_clusters_as_their_beads_do() {
        let (n, phase) = (8, 1.3_f64);
        let modes = wave_modes(n, phase);
        let kernel = |time: f64| modes.iter().map(|[frequency, weight]| weight * (frequency * time).cos()).sum::<f64>();
        let square = 4.0 * (0.5 * phase).sin().powi(2) / n as f64 - kernel(0.0);
        let (step, steps) = (0.01, 2000);
        let memory: Vec<f64> = (0..=steps).map(|j| kernel(step * f64::from(j))).collect();
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
        for second in 0..=20 {
            let exact = |m: usize| {
                let half = 0.5 * (phase + TAU * m as f64) / n as f64;
                let share = (n as f64 * half).sin() / (n as f64 * half.sin());
                share * share * (2.0 * half.sin() * second as f64).cos()
            };
            let exact: f64 = (0..n).map(exact).sum();
            assert!((found[100 * second] - exact).abs() < 2e-4, "t = {second}: {} {exact}", found[100 * second]);
        }
    }

    /// γ* → ½: with clusters of 64 and 256 beads .4966 and .4974.
    #[test]
    fn the_plateau_lies_at_one_half() {
        for size in [64, 128, 256] {
            let kernel = MemoryKernel::new(size);
            let plateau = kernel.plateau().unwrap();
            assert!((0.495..0.5).contains(&plateau.friction), "{size}: {plateau:?}");
            assert!(plateau.slope < 0.0);
        }
        assert_eq!(MemoryKernel::new(16).plateau(), None);
    }

    /// A sum of sines of a lowest frequency πω₀/n and above has no mean: so has the integral over all times. Its mean over
    /// many periods of the lowest frequency ends within their number's share of its height.
    #[test]
    fn the_integral_over_all_times_is_zero() {
        let kernel = MemoryKernel::new(16);
        assert!((kernel.lowest_frequency() * 16.0 - PI).abs() < 0.1, "{}", kernel.lowest_frequency());
        let long = 1000.0 * PI / kernel.lowest_frequency();
        let mean =
            (0..40_000).map(|j| kernel.running_friction(long * (f64::from(j) + 0.5) / 40_000.0)).sum::<f64>() / 4e4;
        assert!(mean.abs() < 1e-3, "{mean}");
    }
}
