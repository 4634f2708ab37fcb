//! The decay of a shear wave, and the viscosity that follows from it.

use super::statistics::{Estimate, jackknife};

/// How fast a shear wave decays.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaveDecay {
    /// The first amplitude.
    pub amplitude: f64,
    /// The rate of the exponential decay.
    pub rate: Estimate,
}

/// A decay is measured over lags in which the wave falls by about this exponent.
const LAG: f64 = 0.2;
/// Parts of the series, one of which is left out at a time for the error.
const BLOCKS: usize = 20;
/// The largest exponent of a decay over one sample: of faster ones little but noise is left.
const FASTEST: f64 = 1.5;
/// Fewer samples determine no rate.
const FEWEST: usize = 8;

impl WaveDecay {
    /// Measures the decay of amplitudes that were sampled every `interval` units of time.
    ///
    /// The amplitude of one wave of a fluid is a process of Ornstein and Uhlenbeck: it decays at the rate wanted, driven by
    /// the fluctuations of the fluid. The best estimate of its decay over a lag is then the regression
    /// Σ A(t) A(t + lag) / Σ A(t)², which gives every part of the series the weight that it deserves: much to the beginning,
    /// where the wave stands out, little to the noise at the end. A lag in which the wave decays a little keeps the faster
    /// fluctuations of single cells out of it.
    ///
    /// None where the amplitudes do not decay, do so by more than a factor of 4.5 within a sample, or are too few. The error is that of the jackknife over 20 parts.
    ///
    /// ```
    /// use mesoscope::measure::shear_wave::WaveDecay;
    ///
    /// let amplitudes: Vec<f64> = (0..100).map(|sample| 0.3 * (-0.2 * 0.1 * f64::from(sample)).exp()).collect();
    /// let decay = WaveDecay::of(&amplitudes, 0.1);
    /// assert!(decay.is_some_and(|decay| (decay.rate.value - 0.2).abs() < 1e-9 && decay.amplitude == 0.3));
    /// assert_eq!(WaveDecay::of(&amplitudes[..5], 0.1), None);
    /// let coarse: Vec<f64> = amplitudes.into_iter().step_by(80).chain([0.0; 8]).collect();
    /// assert_eq!(WaveDecay::of(&coarse, 8.0), None);
    /// ```
    #[must_use]
    pub fn of(amplitudes: &[f64], interval: f64) -> Option<Self> {
        if amplitudes.len() < FEWEST {
            return None;
        }
        let pairs = |lag: usize| amplitudes.len() - lag;
        let short = rate(amplitudes, 0..pairs(1), 1, interval).filter(|rate| rate * interval < FASTEST)?;
        let lag = ((LAG / (short.abs() * interval)).round().max(1.0) as usize).min(amplitudes.len() / 4);
        let value = rate(amplitudes, 0..pairs(lag), lag, interval).filter(|rate| *rate > 0.0)?;
        // The sums of each part, so that leaving one out is a subtraction.
        let parts: Vec<[f64; 2]> = (0..BLOCKS)
            .map(|part| sums(amplitudes, part * pairs(lag) / BLOCKS..(part + 1) * pairs(lag) / BLOCKS, lag))
            .collect();
        let total = [0, 1].map(|index| parts.iter().map(|part| part[index]).sum::<f64>());
        let left: Option<Vec<f64>> =
            parts.iter().map(|part| decay([total[0] - part[0], total[1] - part[1]], lag, interval)).collect();
        let found = jackknife(value, &left.unwrap_or_default());
        Some(Self { amplitude: amplitudes[0], rate: found })
    }

    /// The decay at a time after the first amplitude.
    pub(crate) fn at(&self, time: f64) -> f64 {
        self.amplitude * (-self.rate.value * time).exp()
    }
}

/// Σ A(t) A(t + lag) and Σ A(t)².
fn sums(amplitudes: &[f64], range: std::ops::Range<usize>, lag: usize) -> [f64; 2] {
    let pair = |index: usize| [amplitudes[index] * amplitudes[index + lag], amplitudes[index].powi(2)];
    range.map(pair).fold([0.0; 2], |sum, pair| [sum[0] + pair[0], sum[1] + pair[1]])
}

fn decay([products, squares]: [f64; 2], lag: usize, interval: f64) -> Option<f64> {
    let rate = -(products / squares).ln() / (lag as f64 * interval);
    rate.is_finite().then_some(rate)
}

fn rate(amplitudes: &[f64], range: std::ops::Range<usize>, lag: usize, interval: f64) -> Option<f64> {
    decay(sums(amplitudes, range, lag), lag, interval)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;
    use crate::scene::Generator;

    /// A wave of amplitude 1 that decays at `rate` in thermal noise of such a deviation, with noise of its own in each
    /// sample.
    fn wave(seed: u64, rate: f64, deviation: f64, own: f64, samples: u32) -> Vec<f64> {
        let gaussian = |sample: u32, word: u32| {
            let key = noise::step_key(seed, 77, 0);
            noise::gaussian(noise::words(Generator::Threefry2x32, key, [sample, word]))
        };
        let kept = (-rate).exp();
        let mut amplitude = 1.0;
        (0..samples)
            .map(|sample| {
                let now = amplitude + own * gaussian(sample, 1);
                amplitude = kept * amplitude + deviation * (1.0 - kept * kept).sqrt() * gaussian(sample, 0);
                now
            })
            .collect()
    }

    #[test]
    fn an_exact_decay_is_found_exactly() {
        let amplitudes: Vec<f64> = (0..100).map(|sample| 0.7 * (-0.03 * f64::from(sample)).exp()).collect();
        let found = WaveDecay::of(&amplitudes, 0.5).unwrap();
        assert!((found.rate.value - 0.06).abs() < 1e-12, "{found:?}");
        assert!(found.rate.error.unwrap() < 1e-12, "{found:?}");
        assert_eq!(found.amplitude, 0.7);
        assert!((found.at(10.0) - 0.7 * (-0.6_f64).exp()).abs() < 1e-12);
    }

    #[test]
    fn a_wave_in_noise_is_found_within_its_error() {
        let (rate, count) = (0.01, 200);
        let found: Vec<WaveDecay> =
            (0..count).map(|seed| WaveDecay::of(&wave(seed, rate, 0.03, 0.01, 300), 1.0).unwrap()).collect();
        let mean = found.iter().map(|decay| decay.rate.value).sum::<f64>() / count as f64;
        let deviations = found.iter().map(|decay| (decay.rate.value - rate).powi(2)).sum::<f64>() / count as f64;
        let told = found.iter().map(|decay| decay.rate.error.unwrap().powi(2)).sum::<f64>() / count as f64;
        // Theory: twice the noise over the amplitude, 6 %, for a wave that is seen to its end.
        assert!((deviations.sqrt() / rate - 0.06).abs() < 0.015, "{}", deviations.sqrt() / rate);
        // The mean of 200 to four of its errors, and 2 % for the noise of samples and the logarithm.
        assert!((mean / rate - 1.0).abs() < 4.0 * 0.06 / 200_f64.sqrt() + 0.02, "{}", mean / rate);
        // A variance from 20 parts, averaged over 200 series: to a few tens of per cent.
        assert!((0.6..1.6).contains(&(told / deviations)), "{}", told / deviations);
    }

    #[test]
    fn what_does_not_decay_has_no_rate() {
        assert_eq!(WaveDecay::of(&[1.0; 7], 1.0), None);
        assert_eq!(WaveDecay::of(&[0.0; 100], 1.0), None);
        let growing: Vec<f64> = (0..100).map(|sample| (0.03 * f64::from(sample)).exp()).collect();
        assert_eq!(WaveDecay::of(&growing, 1.0), None);
    }
}
