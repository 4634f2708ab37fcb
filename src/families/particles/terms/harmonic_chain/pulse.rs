//! A pulse that falls into two halves, which travel to the ends of a chain.

use crate::families::HarmonicChain;

/// A Gaussian pulse at rest in the middle of a chain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pulse {
    /// Its height.
    pub amplitude: f64,
    /// Its standard deviation in clusters.
    pub width: f64,
}

impl Pulse {
    /// The displacements of all beads.
    #[must_use]
    pub fn displacements(&self, chain: &HarmonicChain) -> Vec<f64> {
        let beads = chain.micro().beads;
        let middle = 0.5 * (beads as f64 - 1.0);
        let deviation = self.width * chain.cluster_size as f64;
        let at = |bead: usize| (bead as f64 - middle) / deviation;
        (0..beads).map(|bead| self.amplitude * (-0.5 * at(bead) * at(bead)).exp()).collect()
    }
}

/// One half of a pulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPulse {
    /// The largest displacement of a cluster.
    pub peak: f64,
    /// The mean place, in clusters from the first, weighted with the displacements.
    pub centre: f64,
    /// The variance of the places, in clusters squared.
    pub variance: f64,
}

/// The halves of a pulse on the left and on the right of the middle of a chain of clusters. Where the displacements of
/// a half add up to nothing, as in a chain at rest, the half is not a number.
///
/// ```
/// use mesoscope::measure::harmonic_chain::half_pulses;
///
/// let [left, right] = half_pulses(&[0.0, 1.0, 2.0, 1.0, 3.0, 0.0, 3.0, 0.0]);
/// assert_eq!((left.peak, left.centre, left.variance), (2.0, 2.0, 0.5));
/// assert_eq!((right.peak, right.centre, right.variance), (3.0, 5.0, 1.0));
/// ```
#[must_use]
pub fn half_pulses(displacements: &[f64]) -> [HalfPulse; 2] {
    let middle = displacements.len() / 2;
    let half = |first: usize, values: &[f64]| {
        let total: f64 = values.iter().sum();
        let places = || values.iter().enumerate().map(|(index, value)| ((first + index) as f64, value / total));
        let centre: f64 = places().map(|(place, weight)| weight * place).sum();
        HalfPulse {
            peak: values.iter().copied().fold(f64::NAN, f64::max),
            centre,
            variance: places().map(|(place, weight)| weight * (place - centre).powi(2)).sum(),
        }
    };
    let (left, right) = displacements.split_at(middle);
    [half(0, left), half(middle, right)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::harmonic_chain::NormalModes;

    const CHAIN: HarmonicChain =
        HarmonicChain { clusters: 200, cluster_size: 16, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };

    /// Halves of a Gaussian of variance σ² travel without changing, those of a dissipative chain widen by γ*τ, and a mean
    /// over n beads adds (1 - n⁻²)/12 to any variance. Friction lowers the peak to √(σ²/(σ² + γ*τ)) of its height, and the
    /// dispersion of a chain of few clusters to .458 of the whole.
    #[test]
    fn a_pulse_falls_into_two() {
        let pulse = Pulse { amplitude: 1.0, width: 2.0 };
        let beads = pulse.displacements(&CHAIN);
        let (clusters, at_rest) = CHAIN.coarse_grained(&beads, &vec![0.0; beads.len()]);
        let time = 40.0 * CHAIN.cluster_time();
        let (micro, momenta) = NormalModes::new(CHAIN.micro()).evolved(&beads, &vec![0.0; beads.len()], time);
        let micro = CHAIN.coarse_grained(&micro, &momenta).0;
        let [dissipative, frictionless] = [CHAIN.dissipative(), CHAIN.frictionless()]
            .map(|chain| NormalModes::new(chain).evolved(&clusters, &at_rest, time).0);
        let averaged = 4.0 + (1.0 - 1.0 / 256.0) / 12.0;
        for (name, found, peak, variance) in [
            ("micro", micro, 0.4802, averaged),
            ("dissipative", dissipative, 0.2045, averaged + 0.5 * 40.0),
            ("frictionless", frictionless, 0.4579, averaged),
        ] {
            let [left, right] = half_pulses(&found);
            assert!((left.peak - peak).abs() < 1e-4, "{name}: {left:?}");
            assert!((left.peak - right.peak).abs() < 1e-9 && (left.variance - right.variance).abs() < 1e-6, "{name}");
            // The widening halves of the dissipative pulse reach over the middle and lag by a fraction of a cluster.
            assert!((left.variance / variance - 1.0).abs() < 0.003, "{name}: {left:?}");
            assert!((left.centre + right.centre - 199.0).abs() < 1e-9, "{name}");
        }
    }

    #[test]
    fn a_chain_at_rest_has_no_pulse() {
        assert!(half_pulses(&[0.0; 6]).iter().all(|half| half.centre.is_nan() && half.variance.is_nan()));
        assert!(half_pulses(&[])[0].peak.is_nan());
    }
}
