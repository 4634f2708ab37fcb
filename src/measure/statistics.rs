//! Means of correlated series, with errors.

use crate::numbers::with_error;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The most values whose correlation is summed: longer series are averaged in pairs first, which changes no sum over all lags.
const MOST_VALUES: usize = 1024;

/// The window of the sum of correlations closes where e^(-W/τ) < τ/√(nW), with τ this many times the correlation time found so far.
const CAUTION: f64 = 2.5;

/// Fewest values that say something of their correlation.
const FEWEST_CORRELATED: usize = 8;

/// The least statistical inefficiency that is believed: few values seem to cancel each other now and then.
const LEAST_INEFFICIENCY: f64 = 0.5;

/// Degrees of freedom from which an error counts as settled: it is then known to a quarter, 1/√(2 · 8).
const ENOUGH_FREEDOM: f64 = 8.0;

/// A measured number: a mean, a transport coefficient, a parameter of a fit.
///
/// ```
/// use mesoscope::prelude::*;
///
/// let pressure = Estimate::new(23.635, Some(0.012), 200);
/// assert_eq!((pressure.to_string().as_str(), pressure.few), ("23.635 ± 0.012", false));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Estimate {
    /// Its value.
    pub value: f64,
    /// Standard error: the true value lies within it with the probability of 68 %, however few the samples are. None where these are too few.
    pub error: Option<f64>,
    /// Number of samples, windows or blocks whose scatter is the error.
    #[serde(default)]
    pub samples: usize,
    /// Statistical inefficiency of a series: how many successive samples count as one independent one. At least about 1 for
    /// positively correlated samples; none where the samples do not vary, are fewer than two, or are no series.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation_samples: Option<f64>,
    /// True if the samples are too few for the error to be known to a quarter of itself. A series shorter than some ten times its
    /// correlation hides how long that is: its error may be larger than `error`.
    #[serde(default)]
    pub few: bool,
}

impl Estimate {
    /// A value with an error from the scatter of so many independent values.
    #[must_use]
    pub fn new(value: f64, error: Option<f64>, samples: usize) -> Self {
        let few = error.is_none() || error != Some(0.0) && samples as f64 - 1.0 < ENOUGH_FREEDOM;
        Self { value, error, samples, correlation_samples: None, few }
    }

    /// The number times a positive factor that is known exactly.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, error: self.error.map(|error| error * factor), ..self }
    }

    /// Value and error as cells of a table, in which an error that is not known is empty.
    pub(crate) fn cells(self) -> [f64; 2] {
        [self.value, self.error.unwrap_or(f64::NAN)]
    }
}

/// The value with its error, as text: `0.500 ± 0.020`.
impl fmt::Display for Estimate {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&with_error(self.value, self.error))
    }
}

/// Estimates the mean of a series in the order of time; values that are not finite are left out.
/// Returns none when nothing is left.
///
/// The error is that of Wolff, doi:10.1016/S0010-4655(03)00467-3: the variance of the mean is `C/n` with the sum of the autocovariance `Γ`
/// over a window of lags, `C = Γ(0) + 2 Σ Γ(t)`, which ends where the noise of more lags would outweigh what they add (his equation 52), and
/// grows by `(2W+1)/n` of itself because deviations are taken from the mean of the series (49). Its relative variance is about
/// `2 (2W+1)/n` (Madras and Sokal, doi:10.1007/BF01022990), twice the inverse of the degrees of freedom that it has as a variance: Student's
/// distribution with that many widens the error. Series of ten correlations and more have errors that are on average within a tenth to a fifth
/// of the exact one, and right where they are long. Fewer than eight samples count as independent.
///
/// ```
/// use mesoscope::{measure::statistics::estimate, noise};
///
/// // Independent numbers, each of which is seen four times in a row.
/// let number = |step: u64| noise::gaussian(noise::step_key(1, 99, step / 4));
/// let series: Vec<f64> = (0..4096).map(number).collect();
/// let found = estimate(&series).ok_or("there is no number to average")?;
/// let error = found.error.unwrap_or(f64::NAN);
/// assert!(found.value.abs() < 4.0 * error && (error - 1.0 / 32.0).abs() < 0.01);
/// assert!(!found.few && found.correlation_samples.is_some_and(|samples| samples > 2.5 && samples < 6.0));
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn estimate(series: &[f64]) -> Option<Estimate> {
    let mut values: Vec<f64> = series.iter().copied().filter(|value| value.is_finite()).collect();
    let samples = values.len();
    if samples == 0 {
        return None;
    }
    // Averages of differences from one sample lose no digits where the mean is large and the scatter small.
    let origin = values[0];
    for value in &mut values {
        *value -= origin;
    }
    let mean = origin + values.iter().sum::<f64>() / samples as f64;
    let without_error = Estimate::new(mean, None, samples);
    let Some(first) = variance_of_mean(&values) else { return Some(without_error) };
    if first == 0.0 {
        return Some(Estimate { error: Some(0.0), few: false, ..without_error });
    }
    while values.len() > MOST_VALUES {
        values = values.chunks_exact(2).map(|pair| f64::midpoint(pair[0], pair[1])).collect();
    }
    let (variance, freedom) =
        if samples < FEWEST_CORRELATED { (first, samples as f64 - 1.0) } else { correlated_variance(&values) };
    Some(Estimate {
        error: Some(variance.sqrt() * student(freedom)),
        correlation_samples: Some(variance / first),
        few: freedom < ENOUGH_FREEDOM,
        ..without_error
    })
}

/// The variance of the mean of correlated values, and its degrees of freedom.
fn correlated_variance(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let deviations: Vec<f64> = values.iter().map(|value| value - mean).collect();
    let covariance = |lag: usize| {
        let products = deviations.iter().zip(&deviations[lag..]).map(|(a, b)| a * b);
        products.sum::<f64>() / (values.len() - lag) as f64
    };
    let square = covariance(0);
    let (mut sum, mut window) = (square, 0.0);
    for lag in 1..=values.len() / 2 {
        sum += 2.0 * covariance(lag);
        window = lag as f64;
        let time = 0.5 * sum / square;
        let decay = if time > 0.5 { CAUTION / ((time + 0.5) / (time - 0.5)).ln() } else { 0.0 };
        if (-window / decay).exp() <= decay / (window * count).sqrt() {
            break;
        }
    }
    let lags = 2.0 * window + 1.0;
    let sum = sum.max(LEAST_INEFFICIENCY * square) * (1.0 + lags / count);
    (sum / count, (count / lags).max(1.0))
}

/// The half width of the interval that holds 68 % of Student's distribution with so many degrees of freedom, in standard errors: the expansion
/// of Cornish and Fisher, within .2 %, whose last coefficient makes it tan(.683 π/2) for one.
pub(crate) fn student(freedom: f64) -> f64 {
    let few = 1.0 / freedom;
    1.0 + few * (0.5 + few * (0.25 + few * 0.0867))
}

/// Half widths of the intervals that hold 95 % of Student's distribution with one to four degrees of freedom, in
/// standard errors.
const FEW_FREEDOMS: [f64; 4] = [12.706, 4.303, 3.182, 2.776];

/// The same of any number of them: of more than four the expansion of Cornish and Fisher, within .3 %.
fn student_95(freedom: usize) -> f64 {
    let few = 1.0 / freedom as f64;
    let expanded = 1.960 + few * (2.372 + few * (2.823 + few * 2.556));
    FEW_FREEDOMS.get(freedom.wrapping_sub(1)).copied().unwrap_or(expanded)
}

/// The mean of independent values, and an error of which two hold the true value with the probability of 95 %, however
/// few they are; none of fewer than two values.
pub(crate) fn mean_within_two_errors(values: &[f64]) -> Option<(f64, f64)> {
    let Estimate { value, .. } = independent(values)?;
    let differences: Vec<f64> = values.iter().map(|one| one - values[0]).collect();
    Some((value, 0.5 * student_95(values.len() - 1) * variance_of_mean(&differences)?.sqrt()))
}

/// Variance of the mean of independent values, s²/n; none with fewer than two.
fn variance_of_mean(values: &[f64]) -> Option<f64> {
    if values.len() < 2 {
        return None;
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    Some(squares / (count * (count - 1.0)))
}

/// The mean of independent values; none where there are no values. The true mean lies within the error with the probability
/// of 68 %, by Student's distribution for as many values as there are.
///
/// ```
/// use mesoscope::measure::statistics::independent;
/// let mean = independent(&[1.0, 2.0, 3.0]).unwrap_or_default();
/// // s/√n, and 1.32 times that because three values say little of s.
/// assert!(mean.value == 2.0 && mean.error.is_some_and(|error| (error - 1.32 / 3.0_f64.sqrt()).abs() < 2e-3));
/// assert!(mean.few && independent(&[7.0]).is_some_and(|one| one.value == 7.0 && one.error.is_none()));
/// assert_eq!(independent(&[]), None);
/// ```
#[must_use]
pub fn independent(values: &[f64]) -> Option<Estimate> {
    let first = *values.first()?;
    // Differences from one of them lose no digits where the mean is large and the scatter small.
    let differences: Vec<f64> = values.iter().map(|value| value - first).collect();
    let mean = first + differences.iter().sum::<f64>() / values.len() as f64;
    let widened = |variance: f64| variance.sqrt() * student(values.len() as f64 - 1.0);
    Some(Estimate::new(mean, variance_of_mean(&differences).map(widened), values.len()))
}

/// Fewest values of a jackknife that give an error.
pub(super) const FEWEST_REPLICATES: usize = 5;

/// A value with the jackknife's standard error from the values with one block left out each, widened as that of [`independent`] values.
pub(super) fn jackknife(value: f64, replicates: &[f64]) -> Estimate {
    if replicates.len() < FEWEST_REPLICATES {
        return Estimate::new(value, None, replicates.len());
    }
    let count = replicates.len() as f64;
    let mean = replicates.iter().sum::<f64>() / count;
    let squares: f64 = replicates.iter().map(|value| (value - mean).powi(2)).sum();
    let error = (squares * (count - 1.0) / count).sqrt() * student(count - 1.0);
    Estimate::new(value, Some(error), replicates.len())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;

    /// A stationary AR(1) series x' = φx + √(1-φ²)ξ with unit variance.
    fn autoregressive(seed: u64, memory: f64, length: usize) -> Vec<f64> {
        let mut value = 0.0;
        (0..length as u64)
            .map(|step| {
                let key = noise::step_key(seed, 99, step);
                let scale = if step == 0 { 1.0 } else { (1.0 - memory * memory).sqrt() };
                value = memory * value + scale * noise::gaussian(key);
                value
            })
            .collect()
    }

    /// The exact variance of the mean of n such numbers: (1/n) (1 + 2 Σ (1 - t/n) φ^t).
    fn exact_error(memory: f64, length: usize) -> f64 {
        let n = length as f64;
        let tail = memory * (1.0 - memory.powf(n)) / (n * (1.0 - memory).powi(2));
        (((1.0 + memory) / (1.0 - memory) - 2.0 * tail) / n).sqrt()
    }

    /// The root mean square of errors over the exact one, and of means over their errors.
    fn ratios(runs: u64, exact: f64, series: impl Fn(u64) -> Vec<f64>) -> [f64; 2] {
        let found: Vec<Estimate> = (0..runs).map(|seed| estimate(&series(seed)).unwrap()).collect();
        let error = |estimate: &Estimate| estimate.error.unwrap();
        let of = |value: &dyn Fn(&Estimate) -> f64| {
            (found.iter().map(|one| value(one).powi(2)).sum::<f64>() / runs as f64).sqrt()
        };
        [of(&|one| error(one) / exact), of(&|one| one.value / error(one))]
    }

    /// Means scatter by what is printed, whether the series is a thousand or twenty correlations long.
    #[test]
    fn errors_are_those_that_means_have() {
        for memory in [0.0, 0.5, 0.9, 0.98] {
            let correlation = (1.0 + memory) / (1.0 - memory);
            for (correlations, least, most) in [(20.0, 0.9, 1.25), (50.0, 0.9, 1.25), (300.0, 0.92, 1.15)] {
                let length = (correlations * correlation) as usize;
                let exact = exact_error(memory, length);
                let runs = if length > 4000 { 60 } else { 200 };
                let [error, scatter] = ratios(runs, exact, |seed| autoregressive(seed, memory, length));
                // The scatter of so many runs is itself known to 1/√(2 runs): 4 to 9 %.
                let noise = 3.0 / (2.0 * runs as f64).sqrt();
                let place = format!("φ = {memory}, {correlations} correlations: {error}, {scatter}");
                assert!(error > least && error < most, "{place}");
                assert!(scatter < 1.1 + noise && scatter > 0.9 - noise, "{place}");
            }
        }
    }

    /// Half of the variance remembers hundred samples, the other half none.
    #[test]
    fn a_long_correlation_below_a_short_one_is_found() {
        let (memory, length) = (0.98, 4000);
        let series = |seed: u64| {
            let slow = autoregressive(seed, memory, length);
            let fast = autoregressive(1000 + seed, 0.0, length);
            slow.iter().zip(fast).map(|(slow, fast)| 0.5_f64.sqrt() * (slow + fast)).collect()
        };
        let exact = (0.5 * (exact_error(memory, length).powi(2) + 1.0 / length as f64)).sqrt();
        let [error, scatter] = ratios(200, exact, series);
        assert!(error > 0.85 && error < 1.2 && scatter > 0.8 && scatter < 1.3, "{error}, {scatter}");
    }

    #[test]
    fn the_correlation_and_whether_the_error_has_settled() {
        for memory in [0.0, 0.5, 0.9] {
            let found = estimate(&autoregressive(3, memory, 1 << 15)).unwrap();
            let correlation = (1.0 + memory) / (1.0 - memory);
            assert!(!found.few, "{found:?}");
            assert!((found.correlation_samples.unwrap() / correlation - 1.0).abs() < 0.3, "{found:?}");
        }
        let short = estimate(&autoregressive(1, 0.999, 1000)).unwrap();
        assert!(short.few && short.correlation_samples.unwrap() > 10.0, "{short:?}");
    }

    /// Few independent values: their means lie within the error as often as those of many.
    #[test]
    fn errors_of_few_values_are_students() {
        for (freedom, exact) in [(1.0, 1.8367), (2.0, 1.3213), (4.0, 1.1416), (19.0, 1.0267)] {
            assert!((student(freedom) / exact - 1.0).abs() < 2e-3, "{freedom}: {}", student(freedom));
        }
        for count in [2, 3, 5, 10] {
            let within = |seed: &u64| {
                let Estimate { value: mean, error, .. } = independent(&autoregressive(*seed, 0.0, count)).unwrap();
                mean.abs() < error.unwrap()
            };
            let found = (0..2000).filter(within).count() as f64 / 2000.0;
            // 68.3 % ± 1.0 %.
            assert!((found - 0.683).abs() < 0.04, "{count}: {found}");
        }
    }

    #[test]
    fn short_and_constant_series() {
        assert_eq!(estimate(&[]), None);
        assert_eq!(estimate(&[f64::NAN, f64::INFINITY]), None);
        let one = estimate(&[3.0]).unwrap();
        assert_eq!((one.value, one.error, one.samples), (3.0, None, 1));
        let two = estimate(&[1.0, 2.0]).unwrap();
        assert_eq!((two.value, two.samples, two.few), (1.5, 2, true));
        assert!((two.error.unwrap() / (0.5 * 1.8367) - 1.0).abs() < 1e-3, "{two:?}");
        let constant = estimate(&[0.1; 1000]).unwrap();
        assert_eq!((constant.value, constant.error, constant.correlation_samples), (0.1, Some(0.0), None));
    }

    #[test]
    fn values_that_are_not_finite_are_left_out() {
        let clean = autoregressive(5, 0.5, 1000);
        let holed: Vec<f64> = clean.iter().flat_map(|value| [*value, f64::NAN]).collect();
        assert_eq!(estimate(&holed), estimate(&clean));
    }

    #[test]
    fn a_large_offset_costs_no_digits() {
        let clean = estimate(&autoregressive(5, 0.5, 4096)).unwrap();
        let shifted: Vec<f64> = autoregressive(5, 0.5, 4096).iter().map(|value| value + 1e9).collect();
        let shifted = estimate(&shifted).unwrap();
        // Adding 1e9 rounds each sample to 1.2e-7.
        assert!((shifted.error.unwrap() - clean.error.unwrap()).abs() < 1e-7);
    }

    /// Means of few normal numbers, which two of their errors miss once in twenty.
    #[test]
    fn two_errors_hold_the_mean_of_few_values_with_95_per_cent() {
        for count in [2, 3, 5, 8, 20] {
            let trials = 4000_u64;
            let misses = (0..trials).filter(|trial| {
                let key = |value: u64| noise::step_key(5, count, 32 * trial + value);
                let values: Vec<f64> = (0..count).map(|value| noise::gaussian(key(value.into()))).collect();
                mean_within_two_errors(&values).is_some_and(|(mean, error)| mean.abs() > 2.0 * error)
            });
            // 200 are expected, and 60 are more than four standard deviations.
            let misses = misses.count();
            assert!(misses.abs_diff(200) < 60, "{count} values: {misses} misses of {trials}");
        }
        assert_eq!(mean_within_two_errors(&[1.0]), None);
        assert_eq!(mean_within_two_errors(&[2.0, 2.0]), Some((2.0, 0.0)));
    }
}
