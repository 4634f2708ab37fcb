//! The exact motion of a chain without noise.

use crate::families::SpringChain;
use std::f64::consts::PI;

/// The normal modes of a chain between fixed ends: sin(πik/(N+1)), bead i = 1 … N, mode k = 1 … N.
///
/// ```
/// use mesoscope::{measure::harmonic_chain::NormalModes, families::SpringChain};
///
/// // One bead between two walls swings with frequency √2, in units of √(κ/m).
/// let bead = SpringChain { beads: 1, mass: 1.0, stiffness: 1.0, friction: 0.0 };
/// let (displacements, momenta) = NormalModes::new(bead).evolved(&[0.3], &[0.0], 1.0);
/// let (sine, cosine) = 2_f64.sqrt().sin_cos();
/// assert!((displacements[0] - 0.3 * cosine).abs() < 1e-12);
/// assert!((momenta[0] + 0.3 * 2_f64.sqrt() * sine).abs() < 1e-12);
/// ```
#[derive(Debug, Clone)]
pub struct NormalModes {
    chain: SpringChain,
    /// sin(πj/(N+1)) for j = 0 … 2N+1, one full turn.
    sines: Vec<f64>,
}

impl NormalModes {
    /// The modes of a chain.
    #[must_use]
    pub fn new(chain: SpringChain) -> Self {
        let turn = 2 * (chain.beads + 1);
        let sines = (0..turn).map(|j| (PI * j as f64 / (chain.beads + 1) as f64).sin()).collect();
        Self { chain, sines }
    }

    /// The eigenvalue 4 sin²(πk/2(N+1)) of the Rouse matrix that belongs to mode k = 1 … N.
    pub(crate) fn eigenvalue(&self, mode: usize) -> f64 {
        4.0 * (PI * mode as f64 / (2 * (self.chain.beads + 1)) as f64).sin().powi(2)
    }

    /// Displacements and momenta a time later, without noise. Takes of the order of N² operations.
    #[must_use]
    pub fn evolved(&self, displacements: &[f64], momenta: &[f64], time: f64) -> (Vec<f64>, Vec<f64>) {
        let [mut position_amplitudes, mut momentum_amplitudes] =
            [displacements, momenta].map(|values| self.transformed(values));
        for index in 0..self.chain.beads {
            let response = self.response(index + 1, time);
            let [position, momentum] = [position_amplitudes[index], momentum_amplitudes[index]];
            position_amplitudes[index] =
                response.position * position + response.displacement * momentum / self.chain.mass;
            momentum_amplitudes[index] = response.velocity * momentum
                - self.chain.stiffness * self.eigenvalue(index + 1) * response.displacement * position;
        }
        (self.transformed(&position_amplitudes), self.transformed(&momentum_amplitudes))
    }

    /// ⟨P(0)P(t)⟩/⟨P²⟩ in equilibrium of clusters of `cluster_size` beads, averaged over all clusters, at some times.
    /// Friction is accompanied by its noise. Of large clusters of a long frictionless chain it is max(0, 1 - ω₀t/n).
    #[must_use]
    pub fn momentum_autocorrelation(&self, cluster_size: usize, times: &[f64]) -> Vec<f64> {
        let beads = self.chain.beads;
        let size = cluster_size.clamp(1, beads.max(1));
        let clusters = beads / size;
        let cosines: Vec<f64> = (0..self.sines.len()).map(|j| (PI * j as f64 / (beads + 1) as f64).cos()).collect();
        let mut correlations = vec![0.0; times.len()];
        for mode in 1..=beads {
            // The sum of a mode over a cluster: its value in the middle times the sum of cos(πk(i - middle)/(N+1)).
            let half = PI * mode as f64 / (2 * (beads + 1)) as f64;
            let spread = (half * size as f64).sin() / half.sin();
            let mut squares = 0.0;
            for cluster in 0..clusters {
                // Twice the index of the middle is whole, and the cosine of twice the angle gives the square of the sine.
                let twice_the_middle = 2 * cluster * size + size + 1;
                squares += 0.5 - 0.5 * cosines[twice_the_middle * mode % cosines.len()];
            }
            let weight = 2.0 / (beads + 1) as f64 * spread * spread * squares / (clusters * size) as f64;
            for (correlation, time) in correlations.iter_mut().zip(times) {
                *correlation += weight * self.response(mode, *time).velocity;
            }
        }
        correlations
    }

    /// The sine transform that is its own inverse.
    fn transformed(&self, values: &[f64]) -> Vec<f64> {
        let turn = self.sines.len();
        let norm = (4.0 / turn as f64).sqrt();
        let amplitude = |k: usize| {
            let mut index = 0;
            let mut sum = 0.0;
            for value in values {
                index += k;
                if index >= turn {
                    index -= turn;
                }
                sum += value * self.sines[index];
            }
            norm * sum
        };
        (1..=self.chain.beads).map(amplitude).collect()
    }

    /// How the mean of a mode answers a time after it was displaced or kicked.
    fn response(&self, mode: usize, time: f64) -> Response {
        let eigenvalue = self.eigenvalue(mode);
        let square = self.chain.stiffness * eigenvalue / self.chain.mass;
        let damping = 0.5 * self.chain.friction * eigenvalue / self.chain.mass;
        let difference = square - damping * damping;
        let rate = difference.abs().sqrt();
        let (cosine, sine_over_rate) = if rate * time < 1e-6 {
            let decay = (-damping * time).exp();
            (decay, decay * time)
        } else if difference > 0.0 {
            let decay = (-damping * time).exp();
            let (sine, cosine) = (rate * time).sin_cos();
            (decay * cosine, decay * sine / rate)
        } else {
            let [slow, fast] = [rate - damping, -rate - damping].map(|exponent| (exponent * time).exp());
            (0.5 * (slow + fast), 0.5 * (slow - fast) / rate)
        };
        Response {
            position: cosine + damping * sine_over_rate,
            displacement: sine_over_rate,
            velocity: cosine - damping * sine_over_rate,
        }
    }
}

/// Of a damped oscillator after some time.
struct Response {
    /// Its place after a unit displacement.
    position: f64,
    /// Its place after a unit velocity. Its velocity after a unit displacement is -ω² times this.
    displacement: f64,
    /// Its velocity after a unit velocity.
    velocity: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::HarmonicChain;

    const CHAIN: SpringChain = SpringChain { beads: 12, mass: 2.0, stiffness: 3.0, friction: 0.0 };

    /// J₀(x) of positive x by Bessel's integral; the trapezoidal rule is exact to rounding for a periodic integrand.
    fn bessel(x: f64) -> f64 {
        (0..400).map(|j| (x * (PI * (f64::from(j) + 0.5) / 400.0).sin()).cos()).sum::<f64>() / 400.0
    }

    /// Every bead, displaced or kicked, obeys the equations of motion: a difference quotient against the forces.
    #[test]
    fn the_motion_obeys_its_equations() {
        // γ from none to one that overdamps most modes.
        for friction in [0.0, 0.4, 6.0] {
            let chain = SpringChain { friction, ..CHAIN };
            let modes = NormalModes::new(chain);
            let start: Vec<f64> = (0..12).map(|i| f64::from(i * i % 7) - 2.0).collect();
            let kick: Vec<f64> = (0..12).map(|i| f64::from(i * 5 % 11) - 4.0).collect();
            let at = |time: f64| modes.evolved(&start, &kick, time);
            let (same, still) = at(0.0);
            for i in 0..12 {
                assert!((same[i] - start[i]).abs() < 1e-13 && (still[i] - kick[i]).abs() < 1e-13);
            }
            let (time, step) = (1.7, 1e-4);
            let [before, now, after] = [time - step, time, time + step].map(at);
            let rouse = |x: &[f64], i: usize| {
                2.0 * x[i] - if i > 0 { x[i - 1] } else { 0.0 } - if i < 11 { x[i + 1] } else { 0.0 }
            };
            for i in 0..12 {
                let velocity = (after.0[i] - before.0[i]) / (2.0 * step);
                assert!((velocity - now.1[i] / 2.0).abs() < 1e-6, "friction {friction}");
                let force = -3.0 * rouse(&now.0, i) - friction / 2.0 * rouse(&now.1, i);
                assert!(((after.1[i] - before.1[i]) / (2.0 * step) - force).abs() < 1e-5, "friction {friction}");
            }
        }
    }

    #[test]
    fn energy_is_kept_without_friction_only() {
        let start: Vec<f64> = (0..12).map(|i| f64::from(i % 3)).collect();
        let still = vec![0.0; 12];
        for (friction, kept) in [(0.0, true), (0.1, false)] {
            let chain = SpringChain { friction, ..CHAIN };
            let (x, p) = NormalModes::new(chain).evolved(&start, &still, 30.0);
            let change = chain.energy(&x, &p) / chain.energy(&start, &still) - 1.0;
            assert_eq!(change.abs() < 1e-12, kept, "{change}");
        }
    }

    /// In the middle of a long chain `⟨p_i(0) p_i(t)⟩/mkT = J₀(2ω₀t)` (Schrödinger 1914); the ends change the average by
    /// 1/N.
    #[test]
    fn a_bead_forgets_its_momentum_as_in_an_infinite_chain() {
        let beads = 4000;
        let chain = SpringChain { beads, ..CHAIN };
        let times: Vec<f64> = (0..20).map(|j| f64::from(j) * 0.5).collect();
        let found = NormalModes::new(chain).momentum_autocorrelation(1, &times);
        for (time, found) in times.iter().zip(found) {
            let expected = bessel(2.0 * chain.frequency() * time);
            assert!((found - expected).abs() < 2.0 / beads as f64, "t = {time}: {found}, {expected}");
        }
    }

    /// The same sum taken over the matrix of all beads.
    #[test]
    fn clusters_add_up_the_correlations_of_their_beads() {
        let modes = NormalModes::new(CHAIN);
        let time = 0.9;
        let mut sum = 0.0;
        for cluster in 0..4 {
            let mut kick = vec![0.0; 12];
            kick[3 * cluster..3 * cluster + 3].fill(1.0);
            let (_, later) = modes.evolved(&[0.0; 12], &kick, time);
            sum += later[3 * cluster..3 * cluster + 3].iter().sum::<f64>();
        }
        let found = modes.momentum_autocorrelation(3, &[0.0, time]);
        assert!((found[0] - 1.0).abs() < 1e-13);
        assert!((found[1] - sum / 12.0).abs() < 1e-13, "{} {}", found[1], sum / 12.0);
    }

    /// The mean of the triangle over the ends of a chain of N' clusters differs by 1/N', the corners by 1/√n or so.
    #[test]
    fn large_clusters_forget_linearly() {
        let chain = HarmonicChain { clusters: 60, cluster_size: 64, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };
        let taus = [0.25, 0.5, 0.75, 1.5, 2.0, 4.0];
        let times = taus.map(|tau| tau * chain.cluster_time());
        let found = NormalModes::new(chain.micro()).momentum_autocorrelation(64, &times);
        for (tau, found) in taus.iter().zip(found) {
            assert!((found - (1.0 - tau).max(0.0)).abs() < 0.02, "τ = {tau}: {found}");
        }
    }
}
