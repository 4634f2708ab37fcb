//! Whether a series of samples begins with a transient, and where it is over.

use super::statistics::estimate;

/// The beginning of a series that is unlike the rest, and spoils its mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Transient {
    /// Samples to leave out at the beginning; half of all where the series does not settle.
    pub samples: usize,
    /// Whether the rest is steady.
    pub settles: bool,
    /// The mean of the rest.
    pub mean: f64,
}

/// The transient at the beginning of a series of finite samples in the order of time; none where the series may as well be
/// stationary, or its mean is the same within its error whether the beginning is left out or not.
///
/// How a system relaxes reveals as little as how it fluctuates, since both follow the same law (Onsager): what gives a transient
/// away is that the series begins where it never is later. The series is averaged in blocks, 10, 20 and 40 of them. To all blocks
/// after the first (and after the second, the third) a process y' = c + φy + ξ is fitted, which says where the series
/// is stationary, and how far it strays from there. A block that lies further out than that by a limit, which grows with φ,
/// begins a transient. Beside that, the means of the first eighth, quarter and half are compared with that of the second
/// half, which has to be 90 times as long as its correlation.
///
/// Of stationary autoregressive series that are ten or more correlation times long, fewer than 2 in 1000 are taken for a transient,
/// and of shorter ones fewer than 6 in 1000: one shorter than its correlation begins somewhere as well. Series of fewer than 10
/// samples say nothing.
///
/// The transient ends where the mean of the rest is known best: the rule of White, doi:10.1177/003754979706900601,
/// for batches of five samples (MSER-5), of one below a hundred samples. Where that leaves out half of the series or
/// more, or what is left begins with a transient again, the series does not settle.
///
/// ```
/// use mesoscope::measure::equilibration::transient;
/// use mesoscope::noise::{gaussian, step_key};
///
/// let noise = |sample: u64| gaussian(step_key(1, 99, sample));
/// let steady: Vec<f64> = (0..500).map(noise).collect();
/// assert_eq!(transient(&steady), None);
///
/// let relaxing: Vec<f64> = (0..500).map(|sample| 30.0 * (-(sample as f64) / 20.0).exp() + noise(sample)).collect();
/// let found = transient(&relaxing).ok_or("it begins far out")?;
/// assert!(found.settles && (40..150).contains(&found.samples) && found.mean.abs() < 0.2);
///
/// let drifting: Vec<f64> = (0..500).map(|sample| -0.1 * sample as f64 + noise(sample)).collect();
/// assert!(transient(&drifting).is_some_and(|found| !found.settles));
/// # Ok::<(), &str>(())
/// ```
#[must_use]
pub fn transient(series: &[f64]) -> Option<Transient> {
    if !is_transient(series) {
        return None;
    }
    let cut = best_cut(series);
    let settles = 2 * cut < series.len().saturating_sub(2 * batch(series)) && !is_transient(&series[cut..]);
    let samples = if settles { cut } else { series.len() / 2 };
    let rest = estimate(&series[samples..])?;
    let whole = series.iter().sum::<f64>() / series.len() as f64;
    let spoils = (whole - rest.value).abs() > rest.error.unwrap_or(0.0);
    spoils.then_some(Transient { samples, settles, mean: rest.value })
}

/// Numbers of blocks, with the largest deviation of the first at φ = 0 and what is added to that at φ = 1: of fewer
/// blocks less is known.
const LEVELS: [(usize, f64, f64); 3] = [(10, 8.0, 5.0), (20, 5.0, 4.0), (40, 4.5, 3.0)];

/// Blocks that may be the first of a transient: some quantities are where they belong at the very start, and leave it.
const STARTS: usize = 3;

/// The largest difference of the means of parts, in errors of the difference.
const LARGEST_DIFFERENCE: f64 = 5.0;

/// Fewest samples of a half that says how much it varies.
const ENOUGH: usize = 64;

/// Fewest of its own correlations.
const ENOUGH_CORRELATIONS: f64 = 90.0;

fn is_transient(series: &[f64]) -> bool {
    let begins_far_out = LEVELS.iter().any(|(blocks, limit, slope)| {
        let means = block_means(series, *blocks);
        (0..STARTS).any(|start| {
            means.get(start..).and_then(deviation).is_some_and(|(deviation, memory)| deviation > limit + slope * memory)
        })
    });
    begins_far_out || largest_difference(series) > LARGEST_DIFFERENCE
}

/// The means of so many blocks of equal length, without the remainder at the end; none if the series is shorter.
fn block_means(series: &[f64], blocks: usize) -> Vec<f64> {
    let length = series.len() / blocks;
    if length == 0 {
        return Vec::new();
    }
    series.chunks_exact(length).take(blocks).map(|block| block.iter().sum::<f64>() / length as f64).collect()
}

/// How far the first value is from where all others say that the series is stationary, in standard deviations, and
/// the coefficient φ that they have. None where they say nothing.
fn deviation(values: &[f64]) -> Option<(f64, f64)> {
    let pairs = values.len().checked_sub(1).filter(|pairs| *pairs > 2)? as f64;
    let mean = |values: &[f64]| values.iter().sum::<f64>() / pairs;
    let (before, after) = (&values[..values.len() - 1], &values[1..]);
    let [mean_before, mean_after] = [before, after].map(mean);
    let products = |other: &[f64], mean_other: f64| -> f64 {
        before.iter().zip(other).map(|(a, b)| (a - mean_before) * (b - mean_other)).sum()
    };
    let slope = products(after, mean_after) / products(before, mean_before);
    let residual = |(a, b): (&f64, &f64)| b - mean_after - slope * (a - mean_before);
    let variance =
        before.iter().zip(after).map(residual).map(|residual| residual * residual).sum::<f64>() / (pairs - 2.0);
    // Not a number where all values are equal.
    let memory = slope.max(0.0);
    if !(slope.is_finite() && memory < 1.0) {
        return None;
    }
    let stationary = (mean_after - memory * mean_before) / (1.0 - memory);
    let spread = variance / (1.0 - memory * memory) + variance / (pairs * (1.0 - memory).powi(2));
    let deviation = (values[0] - stationary).abs() / spread.sqrt();
    (!deviation.is_nan()).then_some((deviation, memory))
}

/// The largest difference between the mean of the first eighth, quarter or half and that of the second half, in its
/// standard errors from the scatter and the correlation of the second half; zero where these are not known.
fn largest_difference(series: &[f64]) -> f64 {
    let second = &series[series.len().div_ceil(2)..];
    let Some(half) = estimate(second).filter(|_| second.len() >= ENOUGH) else { return 0.0 };
    let (Some(error), Some(correlation)) = (half.error, half.correlation_samples) else { return 0.0 };
    if correlation * ENOUGH_CORRELATIONS > second.len() as f64 {
        return 0.0;
    }
    let variance_of_one = error * error * second.len() as f64;
    let difference = |part: usize| {
        let first = &series[..series.len() / part];
        let mean = first.iter().sum::<f64>() / first.len() as f64;
        let variance = variance_of_one / first.len() as f64 + error * error;
        (mean - half.value).abs() / variance.sqrt()
    };
    [8, 4, 2].map(difference).into_iter().fold(0.0, f64::max)
}

/// Samples of a batch of the rule of White.
fn batch(series: &[f64]) -> usize {
    if series.len() < 100 { 1 } else { 5 }
}

/// The number of samples, at most half, without which Σ(y - ȳ)²/k² over the k batches left is least.
fn best_cut(series: &[f64]) -> usize {
    let length = batch(series);
    let batches = block_means(series, series.len() / length);
    let (mut best, mut cut) = (f64::INFINITY, 0);
    let (mut count, mut mean, mut squares) = (0.0, 0.0, 0.0);
    // From the end, so that sums over what is left grow by one batch at a time.
    for (index, value) in batches.iter().enumerate().rev() {
        count += 1.0;
        let step = value - mean;
        mean += step / count;
        squares += step * (value - mean);
        let spread = squares / (count * count);
        if 2 * index <= batches.len() && spread <= best {
            (best, cut) = (spread, index);
        }
    }
    cut * length
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise;

    /// A stationary AR(1) series x' = φx + √(1-φ²)ξ with unit variance, and what is added to each sample.
    fn series(seed: u64, memory: f64, length: u64, added: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut value = 0.0;
        let sample = |step: u64| {
            let scale = if step == 0 { 1.0 } else { (1.0 - memory * memory).sqrt() };
            value = memory * value + scale * noise::gaussian(noise::step_key(seed, 99, step));
            value + added(step as f64 / length as f64)
        };
        (0..length).map(sample).collect()
    }

    /// How many of so many series are taken for a transient.
    fn alarms(runs: u64, memory: f64, length: u64, added: impl Fn(f64) -> f64 + Copy) -> u64 {
        (0..runs).filter(|seed| transient(&series(*seed, memory, length, added)).is_some()).count() as u64
    }

    /// At the stated rate of 2 in 1000 (6 where the series is shorter than ten correlation times), more alarms than
    /// counted here would be four deviations of the number expected away.
    #[test]
    fn stationary_series_rarely_alarm() {
        let mut rows = Vec::new();
        for length in [11, 50, 200, 1000, 4000] {
            for memory in [0.0, 0.5, 0.9, 0.99] {
                let correlation = (1.0 + memory) / (1.0 - memory);
                let rate = if length as f64 >= 10.0 * correlation { 2e-3 } else { 6e-3 };
                let runs = if length > 500 { 300 } else { 1000 };
                let expected = rate * runs as f64;
                let found = alarms(runs, memory, length, |_| 0.0);
                rows.push((length, memory, found));
                assert!(found as f64 <= expected + 4.0 * expected.sqrt(), "{length} {memory}: {found} of {runs}");
            }
        }
        println!("{rows:?}");
    }

    #[test]
    fn relaxing_series_alarm() {
        let far = |decay: f64| move |time: f64| 30.0 * (-time / decay).exp();
        for (length, memory, decay, least) in [
            (11, 0.5, 0.2, 0.6),
            (50, 0.5, 0.1, 0.9),
            (50, 0.9, 0.1, 0.99),
            (1000, 0.0, 0.02, 0.99),
            (1000, 0.9, 0.05, 0.99),
            (1000, 0.0, 0.5, 0.99),
        ] {
            let found = alarms(200, memory, length, far(decay));
            assert!(found as f64 >= least * 200.0, "{length} {memory} {decay}: {found}");
        }
        // In a long series a few deviations over a fifth of it are seen.
        assert!(alarms(100, 0.5, 4000, |time| 5.0 * (-time / 0.2).exp()) >= 95);
    }

    #[test]
    fn the_cut_leaves_a_steady_rest() {
        let found = transient(&series(5, 0.5, 1000, |time| 30.0 * (-time / 0.02).exp()));
        let found = found.filter(|found| found.settles).map(|found| (found.samples, found.mean));
        // 30 e^(-t/20) is below the error of the mean, √(3/900), after 125 samples.
        assert!(found.is_some_and(|(samples, mean)| (60..250).contains(&samples) && mean.abs() < 0.25), "{found:?}");
        let drifting = transient(&series(5, 0.5, 1000, |time| -20.0 * time));
        assert!(drifting.is_some_and(|found| !found.settles && found.samples == 500), "{drifting:?}");
    }

    /// The kinetic temperature of a mixture that starts at random places, every tenth step of a hundred.
    #[test]
    fn a_short_run_from_random_places_alarms() {
        let temperature = [1.000, 2.177, 1.812, 1.565, 1.398, 1.352, 1.294, 1.209, 1.178, 1.161, 1.111];
        assert!(transient(&temperature).is_some_and(|found| !found.settles && found.mean < 1.25));
    }

    #[test]
    fn what_does_not_vary_or_is_too_short_says_nothing() {
        for series in [vec![], vec![1.0], vec![2.0; 9], vec![2.0; 1000], (0..9).map(f64::from).collect()] {
            assert_eq!(transient(&series), None);
        }
        // One value apart from others that are all the same is a transient, if any is.
        let mut start = vec![1.0; 100];
        start[0] = 50.0;
        assert!(transient(&start).is_some_and(|found| found.settles && found.mean == 1.0));
        assert!(transient(&[f64::NAN; 50]).is_none());
    }
}
