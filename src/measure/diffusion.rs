//! Diffusion coefficients from displacements and velocities.

use super::correlation::{Coefficient, WindowedAverage};
use super::line::weighted_line;
use super::statistics;

/// Self-diffusion coefficient D = slope / 2d from windows of the mean squared displacement in d dimensions, sampled
/// every `interval` units of time.
///
/// A line with free intercept (the ballistic start shifts it) is fitted to the second half of each window, with weights
/// 1/t²: the scatter of a squared displacement grows like its mean. The fit is linear in the data, so the mean of the
/// slopes is the slope of the mean. Returns none without a full window of at least four lags.
///
/// ```
/// use mesoscope::measure::{correlation::WindowedAverage, diffusion::diffusion_from_displacement};
///
/// // ⟨Δr²⟩ = 6 D t with D = ½, but for the start.
/// let displacement: Vec<f64> = (0..20).map(|lag| (3.0 * 0.1 * f64::from(lag) - 0.1).max(0.0)).collect();
/// let found = diffusion_from_displacement(&WindowedAverage::of(20, &displacement), 0.1, 3);
/// assert!(found.is_some_and(|found| (found.value - 0.5).abs() < 1e-9));
/// ```
#[must_use]
pub fn diffusion_from_displacement(
    displacement: &WindowedAverage,
    interval: f64,
    dimension: usize,
) -> Option<Coefficient> {
    let start = displacement.lags().div_ceil(2).max(1);
    if displacement.lags() < 4 {
        return None;
    }
    let slopes: Option<Vec<f64>> = displacement
        .windows()
        .map(|window| {
            let points = window.iter().enumerate().skip(start).map(|(lag, value)| {
                let time = lag as f64 * interval;
                (time, *value, 1.0 / (time * time))
            });
            Some(weighted_line(points)?.slope / (2.0 * dimension as f64))
        })
        .collect();
    coefficient(&slopes?)
}

/// Self-diffusion coefficient D = (1/d) ∫ ⟨v(0)·v(t)⟩ dt (Green and Kubo) from windows of the velocity autocorrelation,
/// by the trapezoidal rule up to the end of the window; what lies beyond is left out. Returns none without a full
/// window of at least two lags.
///
/// ```
/// use mesoscope::measure::{correlation::WindowedAverage, diffusion::diffusion_from_velocity};
///
/// // ⟨v(0)·v(t)⟩ = 3 kT/m exp(-γt) with kT/m = 1 and γ = 2: D = kT/mγ.
/// let velocities: Vec<f64> = (0..1000).map(|lag| 3.0 * (-2.0 * 0.01 * f64::from(lag)).exp()).collect();
/// let found = diffusion_from_velocity(&WindowedAverage::of(1000, &velocities), 0.01, 3);
/// assert!(found.is_some_and(|found| (found.value - 0.5).abs() < 1e-4 && found.standard_error.is_none()));
/// ```
#[must_use]
pub fn diffusion_from_velocity(
    autocorrelation: &WindowedAverage,
    interval: f64,
    dimension: usize,
) -> Option<Coefficient> {
    if autocorrelation.lags() < 2 {
        return None;
    }
    let integral = |window: &[f64]| -> f64 { window.windows(2).map(|pair| f64::midpoint(pair[0], pair[1])).sum() };
    let values: Vec<f64> =
        autocorrelation.windows().map(|window| integral(window) * interval / dimension as f64).collect();
    coefficient(&values)
}

fn coefficient(values: &[f64]) -> Option<Coefficient> {
    let (value, standard_error) = statistics::independent(values)?;
    value.is_finite().then_some(Coefficient { value, standard_error })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;

    fn gaussian(seed: u64, step: u64) -> f64 {
        noise::gaussian(noise::step_key(seed, 99, step))
    }

    #[test]
    fn diffusion_of_exact_curves() {
        let mut displacement = WindowedAverage::new(21);
        for slope in [5.0, 7.0] {
            for lag in 0..21 {
                // An offset stands for the ballistic start.
                displacement.push(if lag == 0 { 0.0 } else { slope * 0.1 * f64::from(lag) - 0.25 });
            }
        }
        let found = diffusion_from_displacement(&displacement, 0.1, 3).unwrap();
        assert!((found.value - 1.0).abs() < 1e-12);
        assert!((found.standard_error.unwrap() - 1.0 / 6.0).abs() < 1e-12);
        assert_eq!(diffusion_from_displacement(&WindowedAverage::new(21), 0.1, 3), None);
    }

    #[test]
    fn diffusion_of_a_random_walk() {
        // 200 walkers in two dimensions, unit steps of variance 0.02 per axis: D = 0.01 per unit of time.
        let (walkers, lags, windows) = (200_u64, 40_u64, 50_u64);
        let mut displacement = WindowedAverage::new(lags as usize);
        for window in 0..windows {
            let mut sums = vec![0.0; lags as usize];
            for axis in 0..2 * walkers {
                let mut place = 0.0;
                for lag in 0..lags {
                    sums[lag as usize] += place * place / walkers as f64;
                    place += 0.02_f64.sqrt() * gaussian(axis, window * lags + lag);
                }
            }
            for sum in sums {
                displacement.push(sum);
            }
        }
        let found = diffusion_from_displacement(&displacement, 1.0, 2).unwrap();
        let error = found.standard_error.unwrap();
        assert!((found.value - 0.01).abs() < 4.0 * error, "{found:?}");
        // A single window's slope scatters by a good part of 1/√walkers; over 50 windows a few percent at most.
        assert!(error > 1e-5 && error < 8e-4, "{found:?}");
    }

    #[test]
    fn green_kubo_of_an_exponential() {
        let (interval, lags) = (0.01, 2001);
        let mut autocorrelation = WindowedAverage::new(lags);
        for lag in 0..lags {
            autocorrelation.push(3.0 * (-(lag as f64) * interval).exp());
        }
        let found = diffusion_from_velocity(&autocorrelation, interval, 3).unwrap();
        // ∫ exp(-t) = 1; the trapezoidal rule adds h²/12, the cut takes e⁻²⁰.
        assert!((found.value - 1.0 - interval * interval / 12.0).abs() < 1e-8);
        assert_eq!(found.standard_error, None);
    }
}
