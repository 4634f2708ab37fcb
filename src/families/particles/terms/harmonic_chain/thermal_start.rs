//! A chain drawn from its canonical equilibrium.

use crate::families::SpringChain;

/// Displacements and momenta of a chain at temperature kT between fixed ends, exactly distributed. `gaussian` gives
/// independent standard Gaussian numbers; 2N + 1 are drawn, N + 1 for the springs and then N for the momenta.
///
/// The springs would be independent but for the fixed ends, which take their common mean from them.
///
/// ```
/// use mesoscope::measure::harmonic_chain::thermal_start;
/// use mesoscope::families::SpringChain;
/// use rand::{RngExt, SeedableRng, rngs::StdRng};
///
/// let chain = SpringChain { beads: 3, mass: 1.0, stiffness: 2.0, friction: 0.0 };
/// let mut generator = StdRng::seed_from_u64(7);
/// // The sum of twelve uniform numbers is near enough to a Gaussian for an example.
/// let gaussian = || (0..12).map(|_| generator.random::<f64>()).sum::<f64>() - 6.0;
/// let (displacements, momenta) = thermal_start(&chain, 1.0, gaussian);
/// assert_eq!((displacements.len(), momenta.len()), (3, 3));
/// ```
#[must_use]
pub fn thermal_start(chain: &SpringChain, temperature: f64, mut gaussian: impl FnMut() -> f64) -> (Vec<f64>, Vec<f64>) {
    let deviation = (temperature / chain.stiffness).sqrt();
    let extensions: Vec<f64> = (0..=chain.beads).map(|_| deviation * gaussian()).collect();
    let mean = extensions.iter().sum::<f64>() / extensions.len() as f64;
    let mut place = 0.0;
    let displacements = extensions[..chain.beads]
        .iter()
        .map(|extension| {
            place += extension - mean;
            place
        })
        .collect();
    let deviation = (chain.mass * temperature).sqrt();
    (displacements, (0..chain.beads).map(|_| deviation * gaussian()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng, rngs::StdRng};

    /// Against kT/κ A⁻¹; 4 standard errors of a variance from 40 000 samples are 2.9 % of it.
    #[test]
    fn displacements_have_the_covariance_of_equilibrium() {
        let chain = SpringChain { beads: 7, mass: 2.0, stiffness: 3.0, friction: 0.0 };
        let mut rng = StdRng::seed_from_u64(1);
        let samples = 40_000;
        let mut covariance = [[0.0; 7]; 7];
        let mut momentum = 0.0;
        for _ in 0..samples {
            let (x, p) = thermal_start(&chain, 1.5, || {
                let uniform = 1.0 - rng.random::<f64>();
                (-2.0 * uniform.ln()).sqrt() * (std::f64::consts::TAU * rng.random::<f64>()).cos()
            });
            for i in 0..7 {
                for j in 0..7 {
                    covariance[i][j] += x[i] * x[j] / f64::from(samples);
                }
                momentum += p[i] * p[i] / (7.0 * f64::from(samples));
            }
        }
        for i in 0..7 {
            for j in 0..7 {
                let [low, high] = [i.min(j) + 1, i.max(j) + 1];
                let exact = 0.5 * (low * (8 - high)) as f64 / 8.0;
                let scale = 0.5 * (((i + 1) * (7 - i) * (j + 1) * (7 - j)) as f64).sqrt() / 8.0;
                assert!((covariance[i][j] - exact).abs() < 0.029 * scale, "{i} {j}: {} {exact}", covariance[i][j]);
            }
        }
        assert!((momentum / 3.0 - 1.0).abs() < 0.029 / 7.0_f64.sqrt(), "{momentum}");
    }
}
