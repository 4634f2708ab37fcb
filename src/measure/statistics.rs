//! Means of correlated series, with errors.

use serde::{Deserialize, Serialize};

/// Fewest blocks from which a standard error is taken: with 16, it is itself known to 1/√30, about 18 %.
const FEWEST_BLOCKS: usize = 16;

/// A mean and how well it is known.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Mean of the samples.
    pub mean: f64,
    /// Standard error of the mean; none with fewer than two samples.
    pub standard_error: Option<f64>,
    /// Number of samples.
    pub samples: usize,
    /// Statistical inefficiency: how many successive samples count as one independent one. At least about 1 for
    /// positively correlated samples; none where the samples do not vary or are fewer than two.
    pub correlation_samples: Option<f64>,
    /// Whether the series is long enough for the error to have reached its plateau. If not, the true error is likely
    /// to be larger than `standard_error`.
    pub converged: bool,
}

/// Estimates the mean of a series in the order of time; values that are not finite are left out.
/// Returns none when nothing is left.
///
/// The error is that of the blocking method of Flyvbjerg and Petersen, doi:10.1063/1.457480: neighbours are averaged
/// in pairs again and again, and the apparent error of the mean rises to a plateau once a block is longer than the
/// correlation. The block length is the smallest power of two B with B³ > 2n (s(B)/s(1))⁴, where s(B) is the apparent
/// error with blocks of B samples: the rule of Lee et al., doi:10.1103/PhysRevE.83.066706, which balances the bias of
/// short blocks against the noise of few blocks. If no length with at least 16 blocks satisfies it, the series is too
/// short: the largest apparent error with at least 16 blocks (or without blocking, if it is shorter than that) is
/// given and marked as not converged.
///
/// ```
/// use mesoscope::{measure::statistics::estimate, noise};
///
/// // Independent numbers, each of which is seen four times in a row.
/// let number = |step: u64| noise::gaussian(noise::step_key(1, 99, step / 4));
/// let series: Vec<f64> = (0..4096).map(number).collect();
/// let found = estimate(&series).ok_or("there is no number to average")?;
/// let error = found.standard_error.unwrap_or(f64::NAN);
/// assert!(found.mean.abs() < 4.0 * error && (error - 1.0 / 32.0).abs() < 0.01);
/// assert!(found.converged && found.correlation_samples.is_some_and(|samples| samples > 2.5 && samples < 6.0));
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn estimate(series: &[f64]) -> Option<Estimate> {
    let mut blocks: Vec<f64> = series.iter().copied().filter(|value| value.is_finite()).collect();
    let samples = blocks.len();
    if samples == 0 {
        return None;
    }
    // Averages of differences from one sample lose no digits where the mean is large and the scatter small.
    let origin = blocks[0];
    for value in &mut blocks {
        *value -= origin;
    }
    let mean = origin + blocks.iter().sum::<f64>() / samples as f64;
    let Some(first) = variance_of_mean(&blocks) else {
        return Some(Estimate { mean, standard_error: None, samples, correlation_samples: None, converged: false });
    };
    let exact = |converged| Estimate { mean, standard_error: Some(0.0), samples, correlation_samples: None, converged };
    if first == 0.0 {
        return Some(exact(true));
    }
    let mut block_length = 1.0_f64;
    let mut largest = first;
    let mut converged = false;
    while blocks.len() >= FEWEST_BLOCKS {
        let Some(variance) = variance_of_mean(&blocks) else { break };
        largest = largest.max(variance);
        if block_length.powi(3) > 2.0 * samples as f64 * (variance / first).powi(2) {
            largest = variance;
            converged = true;
            break;
        }
        blocks = blocks.chunks_exact(2).map(|pair| f64::midpoint(pair[0], pair[1])).collect();
        block_length *= 2.0;
    }
    Some(Estimate {
        mean,
        standard_error: Some(largest.sqrt()),
        samples,
        correlation_samples: Some(largest / first),
        converged,
    })
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

/// Mean and standard error of independent values; none where there are no values.
///
/// ```
/// use mesoscope::measure::statistics::independent;
/// assert_eq!(independent(&[1.0, 2.0, 3.0]), Some((2.0, Some((1.0_f64 / 3.0).sqrt()))));
/// assert_eq!(independent(&[7.0]), Some((7.0, None)));
/// assert_eq!(independent(&[]), None);
/// ```
#[must_use]
pub fn independent(values: &[f64]) -> Option<(f64, Option<f64>)> {
    if values.is_empty() {
        return None;
    }
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    Some((mean, variance_of_mean(values).map(f64::sqrt)))
}

/// Fewest values of a jackknife that give an error.
pub(super) const FEWEST_REPLICATES: usize = 5;

/// The jackknife's standard error from the values with one block left out each.
pub(super) fn jackknife_error(replicates: &[f64]) -> Option<f64> {
    if replicates.len() < FEWEST_REPLICATES {
        return None;
    }
    let count = replicates.len() as f64;
    let mean = replicates.iter().sum::<f64>() / count;
    let squares: f64 = replicates.iter().map(|value| (value - mean).powi(2)).sum();
    Some((squares * (count - 1.0) / count).sqrt())
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

    #[test]
    fn the_error_of_correlated_series_is_the_exact_one() {
        let length = 1 << 15;
        for memory in [0.0, 0.5, 0.9] {
            let runs = 24;
            let estimates: Vec<Estimate> =
                (0..runs).map(|seed| estimate(&autoregressive(seed, memory, length)).unwrap()).collect();
            assert!(estimates.iter().all(|estimate| estimate.converged));
            let exact = exact_error(memory, length);
            let mean = estimates.iter().map(|e| e.standard_error.unwrap()).sum::<f64>() / runs as f64;
            // The rule stops at the power of two above B = (2n c²)^⅓ with inefficiency c = (1+φ)/(1-φ). With n/B
            // blocks one error is known to √(B/2n); blocks of B miss 2φ/(B(1-φ²)) of the variance, half of that of
            // the error. B may come out twice as large or half as large.
            let inefficiency = (1.0 + memory) / (1.0 - memory);
            let block = (2.0 * length as f64 * inefficiency * inefficiency).cbrt();
            let scatter = (2.0 * 2.0 * block / (2.0 * length as f64)).sqrt() / (runs as f64).sqrt();
            let bias = 2.0 * memory / (block * (1.0 - memory * memory));
            let tolerance = 4.0 * scatter + bias;
            assert!((mean / exact - 1.0).abs() < tolerance, "φ = {memory}: {mean} against {exact} ± {tolerance}");
            let found = estimates.iter().map(|e| e.correlation_samples.unwrap()).sum::<f64>() / runs as f64;
            assert!((found / inefficiency - 1.0).abs() < 2.0 * tolerance, "φ = {memory}: c = {found}");
            // Σ z² over the runs has mean 24 and standard deviation √48.
            let chi_squared: f64 = estimates.iter().map(|e| (e.mean / exact).powi(2)).sum();
            assert!((chi_squared - runs as f64).abs() < 4.0 * (2.0 * runs as f64).sqrt(), "χ² = {chi_squared}");
        }
    }

    #[test]
    fn a_series_as_long_as_its_correlation_is_marked() {
        let estimate = estimate(&autoregressive(1, 0.999, 1000)).unwrap();
        assert!(!estimate.converged);
        assert!(estimate.correlation_samples.unwrap() > 10.0);
    }

    #[test]
    fn short_and_constant_series() {
        assert_eq!(estimate(&[]), None);
        assert_eq!(estimate(&[f64::NAN, f64::INFINITY]), None);
        let one = estimate(&[3.0]).unwrap();
        assert_eq!((one.mean, one.standard_error, one.samples), (3.0, None, 1));
        let two = estimate(&[1.0, 2.0]).unwrap();
        assert_eq!((two.mean, two.standard_error, two.samples, two.converged), (1.5, Some(0.5), 2, false));
        let constant = estimate(&[0.1; 1000]).unwrap();
        assert_eq!((constant.mean, constant.standard_error, constant.correlation_samples), (0.1, Some(0.0), None));
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
        assert!((shifted.standard_error.unwrap() - clean.standard_error.unwrap()).abs() < 1e-7);
    }
}
