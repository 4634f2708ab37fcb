//! The shear viscosity from transverse momentum waves.

use super::line::{Line, weighted_line};
use super::statistics::{Estimate, FEWEST_REPLICATES, jackknife};
use serde::{Deserialize, Serialize};

/// A Fourier mode of the momentum density perpendicular to its wave vector: Σ p_⊥ exp(-i k·r), sampled in time.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct TransverseMode {
    /// Magnitude k of the wave vector.
    pub wave_number: f64,
    /// Real and imaginary part of the amplitude, one pair per sample.
    pub amplitudes: Vec<[f64; 2]>,
}

/// Shear viscosity from the decay of transverse modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ShearViscosity {
    /// Dynamic viscosity η: the mean over wave numbers.
    pub viscosity: Estimate,
    /// Kinematic viscosity η/ρ.
    pub kinematic_viscosity: Estimate,
    /// The result of each wave number, smallest first. If they fall with k by more than their errors, the waves are
    /// too short for hydrodynamics and the first is the best.
    pub waves: Vec<WaveViscosity>,
}

/// Shear viscosity from the modes of one wave number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WaveViscosity {
    /// Wave number k.
    pub wave_number: f64,
    /// Number of modes averaged.
    pub modes: usize,
    /// Dynamic viscosity η.
    pub viscosity: Estimate,
    /// The normalised autocorrelation C, one value per lag, up to the end of the fit.
    pub autocorrelation: Vec<f64>,
    /// First lag of the fit; the last is the end of `autocorrelation`.
    pub fit_from: usize,
    /// The fitted exponential at these lags.
    pub fit: Vec<f64>,
}

/// Why no viscosity comes out.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ViscosityError {
    /// There is no mode, the modes differ in length, or one has no positive wave number.
    #[error("there are no complete time series of transverse momentum modes")]
    NoModes,
    /// All amplitudes are zero, or some are not finite.
    #[error("the transverse momentum modes with k = {wave_number} carry no finite momentum")]
    NoSignal {
        /// The wave number.
        wave_number: f64,
    },
    /// Fewer than three samples while C falls from 0.9 to 0.3.
    #[error(
        "the autocorrelation of the mode with k = {wave_number} decays within {lags} samples; sample it more often \
         (smaller `output.viscosity.every`)"
    )]
    TooCoarse {
        /// The wave number.
        wave_number: f64,
        /// Lags in the range of the fit.
        lags: usize,
    },
    /// C stays above 0.6 up to the largest lag.
    #[error(
        "the autocorrelation of the mode with k = {wave_number} only falls to {lowest:.2}; raise \
         `output.viscosity.window` or run longer"
    )]
    TooShort {
        /// The wave number.
        wave_number: f64,
        /// Where C ends.
        lowest: f64,
    },
}

/// C at the first lag of the fit: the start, where the stress has not yet relaxed and C is no exponential, is left out.
const FIT_FROM: f64 = 0.9;
/// C at the last lag of the fit: beyond it, the noise of a finite series, which hardly falls with the lag, weighs more
/// and more in log C.
const FIT_TO: f64 = 0.3;
/// The highest end of C that a fit still makes sense of.
const FIT_LEAST: f64 = 0.6;
/// Blocks of the jackknife, if the series is long enough.
const BLOCKS: usize = 20;

/// Shear viscosity η from the autocorrelation of transverse momentum modes at equilibrium, for mass density `density`
/// (per area in two dimensions), sampled every `interval` units of time, up to `largest_lag` samples.
///
/// Linear hydrodynamics makes C(t) = exp(-η k² t / ρ): Palmer, doi:10.1103/PhysRevE.49.359. For every wave number, C is
/// averaged over its modes, and a line with free intercept is fitted to log C where C falls from 0.9 to 0.3. The weights
/// are the inverse variances of log C for an exponentially correlated Gaussian series (Bartlett's formula),
/// 1/var ∝ C² / (1 - C² + 2 C² log C). Wave numbers are averaged with weights k² times their number of modes: the number
/// of relaxation times that each has seen. Errors come from a jackknife over up to 20 blocks of time, each at least
/// twice as long as the fit; there is no error if fewer than 5 fit in.
///
/// ```
/// use mesoscope::measure::shear_viscosity::{TransverseMode, shear_viscosity};
/// use mesoscope::noise::{step_key, two_gaussians};
///
/// // A mode that forgets at the rate η k²/ρ = 0.8 · 0.5² / 3, sampled every 0.5 units of time.
/// let memory = (-0.5 * 0.8 * 0.25 / 3.0_f64).exp();
/// let mut amplitude = [1.0, 0.0];
/// let amplitudes = (0..20_000).map(|sample| {
///     let [x, y] = two_gaussians(step_key(1, 99, sample)).map(|number| (1.0 - memory * memory).sqrt() * number);
///     amplitude = [memory * amplitude[0] + x, memory * amplitude[1] + y];
///     amplitude
/// });
/// let mode = TransverseMode { wave_number: 0.5, amplitudes: amplitudes.collect() };
/// let found = shear_viscosity(&[mode], 3.0, 0.5, 500)?.viscosity;
/// let error = found.error.unwrap_or(f64::NAN);
/// assert!((found.value - 0.8).abs() < 4.0 * error && error < 0.2);
/// # Ok::<(), mesoscope::measure::shear_viscosity::ViscosityError>(())
/// ```
///
/// # Errors
/// A [`ViscosityError`] that says which setting to change.
pub fn shear_viscosity(
    modes: &[TransverseMode],
    density: f64,
    interval: f64,
    largest_lag: usize,
) -> Result<ShearViscosity, ViscosityError> {
    let mut modes: Vec<&TransverseMode> = modes.iter().collect();
    modes.sort_by(|a, b| a.wave_number.total_cmp(&b.wave_number));
    let samples = modes.first().map_or(0, |mode| mode.amplitudes.len());
    if samples < 2
        || modes.iter().any(|mode| mode.amplitudes.len() != samples || mode.wave_number.is_nan())
        || modes[0].wave_number <= 0.0
    {
        return Err(ViscosityError::NoModes);
    }
    let waves: Vec<&[&TransverseMode]> =
        modes.chunk_by(|a, b| (b.wave_number - a.wave_number).abs() <= 1e-9 * b.wave_number).collect();
    let decays: Result<Vec<Decay>, ViscosityError> =
        waves.iter().map(|wave| Decay::measure(wave, largest_lag.min(samples - 1))).collect();
    let decays = decays?;

    let longest = decays.iter().map(|decay| decay.autocorrelation.len()).max().unwrap_or(1);
    let blocks = (samples / (2 * longest)).min(BLOCKS);
    let blocks = if blocks < FEWEST_REPLICATES { 0 } else { blocks };
    let weights: Vec<f64> =
        waves.iter().map(|wave| wave.len() as f64 * wave[0].wave_number * wave[0].wave_number).collect();
    let weighted = |values: &[f64]| -> f64 {
        let sum: f64 = values.iter().zip(&weights).map(|(value, weight)| value * weight).sum();
        sum / weights.iter().sum::<f64>()
    };
    let mut values = Vec::new();
    let mut without: Vec<Vec<f64>> = vec![Vec::new(); blocks];
    let mut results = Vec::new();
    for (wave, decay) in waves.iter().zip(&decays) {
        let wave_number = wave[0].wave_number;
        let scale = density / (wave_number * wave_number * interval);
        let value = scale * decay.rate;
        let replicates: Vec<f64> =
            decay.rates_without_blocks(wave, blocks).into_iter().map(|rate| scale * rate).collect();
        for (all, replicate) in without.iter_mut().zip(&replicates) {
            all.push(*replicate);
        }
        values.push(value);
        results.push(WaveViscosity {
            wave_number,
            modes: wave.len(),
            viscosity: jackknife(value, &replicates),
            autocorrelation: decay.autocorrelation.clone(),
            fit_from: decay.fit_from,
            fit: decay.fit(),
        });
    }
    let complete = without.iter().filter(|values| values.len() == waves.len());
    let replicates: Vec<f64> = complete.map(|values| weighted(values)).collect();
    let viscosity = jackknife(weighted(&values), &replicates);
    let kinematic_viscosity = viscosity.times(1.0 / density);
    Ok(ShearViscosity { viscosity, kinematic_viscosity, waves: results })
}

/// The autocorrelation of one wave number and its decay rate per sample.
struct Decay {
    autocorrelation: Vec<f64>,
    fit_from: usize,
    rate: f64,
    /// Value of the fit at lag zero.
    amplitude: f64,
}

impl Decay {
    fn measure(wave: &[&TransverseMode], largest_lag: usize) -> Result<Self, ViscosityError> {
        let wave_number = wave[0].wave_number;
        let samples = wave[0].amplitudes.len();
        let power = products(wave, 0, 0, samples) / samples as f64;
        if !(power.is_finite() && power > 0.0) {
            return Err(ViscosityError::NoSignal { wave_number });
        }
        let mut autocorrelation = vec![1.0];
        // The end of the fit ends the work: longer lags are never needed.
        for lag in 1..=largest_lag {
            let value = products(wave, lag, 0, samples - lag) / (samples - lag) as f64 / power;
            if value < FIT_TO {
                break;
            }
            autocorrelation.push(value);
        }
        let lowest = autocorrelation.iter().copied().fold(1.0, f64::min);
        if autocorrelation.len() > largest_lag && lowest > FIT_LEAST {
            return Err(ViscosityError::TooShort { wave_number, lowest });
        }
        let fit_from = autocorrelation.iter().position(|value| *value <= FIT_FROM).unwrap_or(autocorrelation.len());
        let lags = autocorrelation.len() - fit_from;
        if lags < 3 {
            return Err(ViscosityError::TooCoarse { wave_number, lags });
        }
        let line =
            decay_line(&autocorrelation, fit_from, &autocorrelation).ok_or(ViscosityError::NoSignal { wave_number })?;
        Ok(Self { autocorrelation, fit_from, rate: -line.slope, amplitude: line.intercept.exp() })
    }

    /// The exponential at all lags that it was fitted to.
    fn fit(&self) -> Vec<f64> {
        let lags = self.fit_from..self.autocorrelation.len();
        lags.map(|lag| self.amplitude * (-self.rate * lag as f64).exp()).collect()
    }

    /// The rates that come out when one block of time origins after the other is left out, over the same lags and with
    /// the same weights; empty where some of them cannot be taken.
    fn rates_without_blocks(&self, wave: &[&TransverseMode], blocks: usize) -> Vec<f64> {
        if blocks == 0 {
            return Vec::new();
        }
        let samples = wave[0].amplitudes.len();
        let lags = self.autocorrelation.len();
        let edge = |block: usize, lag: usize| (samples * block / blocks).min(samples - lag);
        // Only the lags that enter: the normalisation and the fit.
        let used: Vec<usize> = std::iter::once(0).chain(self.fit_from..lags).collect();
        let sums: Vec<Vec<f64>> = used
            .iter()
            .map(|lag| (0..blocks).map(|b| products(wave, *lag, edge(b, *lag), edge(b + 1, *lag))).collect())
            .collect();
        (0..blocks)
            .map(|left_out| {
                let mean = |index: usize| {
                    let lag = used[index];
                    let count = samples - lag - (edge(left_out + 1, lag) - edge(left_out, lag));
                    (sums[index].iter().sum::<f64>() - sums[index][left_out]) / count as f64
                };
                let power = mean(0);
                let mut replicate = vec![1.0; lags];
                for (index, lag) in used.iter().enumerate().skip(1) {
                    replicate[*lag] = mean(index) / power;
                }
                decay_line(&replicate, self.fit_from, &self.autocorrelation).map(|line| -line.slope)
            })
            .collect::<Option<Vec<f64>>>()
            .unwrap_or_default()
    }
}

/// Σ Re a(t + lag) a*(t) over the modes and over the origins t in `from..to`.
fn products(wave: &[&TransverseMode], lag: usize, from: usize, to: usize) -> f64 {
    wave.iter()
        .map(|mode| {
            let origins = &mode.amplitudes[from..to];
            let later = &mode.amplitudes[from + lag..to + lag];
            origins.iter().zip(later).map(|(a, b)| a[0] * b[0] + a[1] * b[1]).sum::<f64>()
        })
        .sum()
}

/// Minus the slope of log C per lag; `weights_from` is the C that sets the weights.
fn decay_line(autocorrelation: &[f64], from: usize, weights_from: &[f64]) -> Option<Line> {
    let points = (from..autocorrelation.len()).map(|lag| {
        let c = weights_from[lag];
        // Bartlett's variance is positive for 0 < C < 1; a C that noise lifts to 1 gets the weight of one just below.
        let c = c.min(1.0 - 1e-3);
        let weight = c * c / (1.0 - c * c + 2.0 * c * c * c.ln());
        (lag as f64, autocorrelation[lag].ln(), weight)
    });
    weighted_line(points).filter(|line| line.slope.is_finite())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;

    fn gaussian(seed: u64, step: u64) -> f64 {
        noise::gaussian(noise::step_key(seed, 99, step))
    }

    /// A complex Ornstein-Uhlenbeck process: its autocorrelation is exp(-rate t) at every whole t.
    fn relaxing_mode(seed: u64, wave_number: f64, rate: f64, samples: u64) -> TransverseMode {
        let memory = (-rate).exp();
        let mut value = [gaussian(2 * seed, 0), gaussian(2 * seed + 1, 0)];
        let amplitudes = (1..=samples)
            .map(|step| {
                let sample = value;
                for (part, stream) in value.iter_mut().zip(2 * seed..) {
                    *part = memory * *part + (1.0 - memory * memory).sqrt() * gaussian(stream, step);
                }
                sample
            })
            .collect();
        TransverseMode { wave_number, amplitudes }
    }

    #[test]
    fn viscosity_of_modes_with_a_known_decay() {
        let (density, interval, samples) = (3.0, 0.5, 20_000);
        let viscosity = 0.8;
        let runs = 12;
        let mut squares = 0.0;
        for run in 0..runs {
            let modes: Vec<TransverseMode> = (0..6)
                .map(|index| {
                    let wave_number: f64 = if index < 4 { 0.5 } else { 0.8 };
                    let rate = viscosity * wave_number * wave_number / density * interval;
                    relaxing_mode(100 * run + index, wave_number, rate, samples)
                })
                .collect();
            let found = shear_viscosity(&modes, density, interval, 500).unwrap();
            let error = found.viscosity.error.unwrap();
            assert!((found.viscosity.value - viscosity).abs() < 4.0 * error, "run {run}: {:?}", found.viscosity);
            // No estimator of the rate of a complex mode does better than √(1/(rate · time)); a fit to part of C
            // should do within a factor of a few of that.
            let relaxations: f64 = found
                .waves
                .iter()
                .zip([0.25, 0.64])
                .map(|(wave, k2)| wave.modes as f64 * viscosity * k2 / density * interval * samples as f64)
                .sum();
            let best = viscosity / relaxations.sqrt();
            assert!(error > 0.5 * best && error < 4.0 * best, "run {run}: {error} against {best}");
            squares += ((found.viscosity.value - viscosity) / error).powi(2);
            assert_eq!(found.waves.iter().map(|wave| wave.modes).collect::<Vec<_>>(), [4, 2]);
            assert!((found.kinematic_viscosity.value * density / found.viscosity.value - 1.0).abs() < 1e-15);
        }
        // Errors neither too small nor too large: Σ z² has mean near 12 and standard deviation near √24.
        assert!(squares > 2.0 && squares < 12.0 + 4.0 * 24.0_f64.sqrt(), "Σ z² = {squares}");
    }

    #[test]
    fn an_offset_at_short_times_does_not_enter() {
        // White noise on top of the mode lowers C at every lag but zero by one factor.
        let (rate, samples) = (0.02, 100_000);
        let mut mode = relaxing_mode(7, 1.0, rate, samples);
        for (step, amplitude) in mode.amplitudes.iter_mut().enumerate() {
            amplitude[0] += 0.2 * gaussian(70, step as u64);
            amplitude[1] += 0.2 * gaussian(71, step as u64);
        }
        let found = shear_viscosity(&[mode], 1.0, 1.0, 400).unwrap().viscosity;
        assert!((found.value - rate).abs() < 4.0 * found.error.unwrap(), "{found:?}");
    }

    #[test]
    fn what_cannot_be_fitted_is_named() {
        assert_eq!(shear_viscosity(&[], 1.0, 1.0, 10), Err(ViscosityError::NoModes));
        for wave_number in [0.0, f64::NAN] {
            let uniform = relaxing_mode(1, wave_number, 0.02, 100);
            assert_eq!(shear_viscosity(&[uniform], 1.0, 1.0, 10), Err(ViscosityError::NoModes));
        }
        let silent = TransverseMode { wave_number: 1.0, amplitudes: vec![[0.0; 2]; 100] };
        assert!(matches!(shear_viscosity(&[silent], 1.0, 1.0, 10), Err(ViscosityError::NoSignal { .. })));
        let mut broken = relaxing_mode(1, 1.0, 0.02, 1000);
        broken.amplitudes[17][0] = f64::NAN;
        assert!(matches!(shear_viscosity(&[broken], 1.0, 1.0, 10), Err(ViscosityError::NoSignal { .. })));
        let fast = relaxing_mode(1, 1.0, 1.0, 10_000);
        assert!(matches!(shear_viscosity(&[fast], 1.0, 1.0, 100), Err(ViscosityError::TooCoarse { .. })));
        let slow = relaxing_mode(1, 1.0, 0.001, 10_000);
        let error = shear_viscosity(&[slow], 1.0, 1.0, 50).unwrap_err();
        assert!(matches!(error, ViscosityError::TooShort { .. }), "{error}");
        let uneven = [relaxing_mode(1, 1.0, 0.02, 100), relaxing_mode(2, 1.0, 0.02, 90)];
        assert_eq!(shear_viscosity(&uneven, 1.0, 1.0, 10), Err(ViscosityError::NoModes));
    }

    #[test]
    fn a_short_series_has_a_value_and_no_error() {
        let found = shear_viscosity(&[relaxing_mode(3, 1.0, 0.02, 200)], 1.0, 1.0, 150).unwrap();
        assert_eq!(found.viscosity.error, None);
        assert!(found.viscosity.value > 0.0);
    }
}
