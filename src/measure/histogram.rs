//! Histograms of a value that many particles have, and the moments that go with them.

use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_2_SQRT_PI, PI, SQRT_2};

/// Counts in bins of equal width, with what fell outside.
///
/// ```
/// use mesoscope::measure::histogram::Histogram;
///
/// let mut histogram = Histogram::new([0.0, 2.0], 4);
/// for value in [-0.3, 0.1, 0.6, 0.7, 5.0_f64] {
///     let bin = ((value - histogram.range[0]) / histogram.width()).floor();
///     if bin < 0.0 {
///         histogram.below += 1.0;
///     } else if let Some(count) = histogram.counts.get_mut(bin as usize) {
///         *count += 1.0;
///     } else {
///         histogram.above += 1.0;
///     }
/// }
/// assert_eq!((histogram.total(), histogram.width(), histogram.centre(1)), (5.0, 0.5, 0.75));
/// // What fell outside counts too: the density adds up to 3/5 over the range.
/// let sum: f64 = histogram.density().iter().map(|density| density * histogram.width()).sum();
/// assert!((sum - 0.6).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Histogram {
    /// The lower edge of the first bin and the upper edge of the last.
    pub range: [f64; 2],
    /// The number of values in each bin.
    pub counts: Vec<f64>,
    /// The number of values below the range.
    pub below: f64,
    /// The number of values above it, or on its upper edge.
    pub above: f64,
}

impl Histogram {
    /// An empty histogram.
    #[must_use]
    pub fn new(range: [f64; 2], bins: usize) -> Self {
        Self { range, counts: vec![0.0; bins], below: 0.0, above: 0.0 }
    }

    /// Width of a bin.
    #[must_use]
    pub fn width(&self) -> f64 {
        (self.range[1] - self.range[0]) / self.counts.len() as f64
    }

    /// The middle of a bin.
    #[must_use]
    pub fn centre(&self, bin: usize) -> f64 {
        self.range[0] + (bin as f64 + 0.5) * self.width()
    }

    /// The lower and the upper edge of a bin.
    pub(crate) fn edges(&self, bin: usize) -> [f64; 2] {
        [bin, bin + 1].map(|edge| self.range[0] + edge as f64 * self.width())
    }

    /// Number of values, those outside the range included.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.counts.iter().sum::<f64>() + self.below + self.above
    }

    /// The probability density in each bin; over the range it adds up to the part of the values that lie in it. NaN
    /// where nothing was counted.
    #[must_use]
    pub fn density(&self) -> Vec<f64> {
        let scale = 1.0 / (self.total() * self.width());
        self.counts.iter().map(|count| count * scale).collect()
    }
}

/// Means of powers of a value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(crate) struct PowerMeans {
    /// Mean.
    pub first: f64,
    /// Mean square.
    pub second: f64,
    /// Mean fourth power.
    pub fourth: f64,
}

impl PowerMeans {
    /// Standard deviation.
    pub(crate) fn standard_deviation(&self) -> f64 {
        (self.second - self.first * self.first).max(0.0).sqrt()
    }

    /// Variance of the square.
    pub(crate) fn variance_of_square(&self) -> f64 {
        self.fourth - self.second * self.second
    }

    /// ⟨x⁴⟩/⟨x²⟩² about zero: 3 for a Gaussian around it, less where two peaks stand apart, more with heavy tails.
    pub(crate) fn kurtosis(&self) -> f64 {
        self.fourth / (self.second * self.second)
    }
}

/// The Gaussian density with a mean and a standard deviation.
///
/// ```
/// use mesoscope::measure::histogram::gaussian_density;
///
/// assert!((gaussian_density(1.0, 1.0, 2.0) - 0.19947).abs() < 1e-5);
/// assert_eq!(gaussian_density(0.0, 1.0, 2.0), gaussian_density(2.0, 1.0, 2.0));
/// ```
#[must_use]
pub fn gaussian_density(value: f64, mean: f64, standard_deviation: f64) -> f64 {
    let z = (value - mean) / standard_deviation;
    (-0.5 * z * z).exp() / ((2.0 * PI).sqrt() * standard_deviation)
}

/// Maxwell's density of the magnitude of a vector of `dimension` (1 to 3) Gaussian components with this mean square of
/// the magnitude.
///
/// ```
/// use mesoscope::measure::histogram::maxwell_density;
/// // Speeds of particles with kT/m = 1 in three dimensions have the mean √(8/π).
/// let speeds = (0..8000).map(|index| (f64::from(index) + 0.5) * 1e-3);
/// let mean: f64 = speeds.map(|speed| speed * maxwell_density(speed, 3.0, 3) * 1e-3).sum();
/// assert!((mean - (8.0 / std::f64::consts::PI).sqrt()).abs() < 1e-6);
/// ```
#[must_use]
pub fn maxwell_density(speed: f64, mean_square: f64, dimension: usize) -> f64 {
    let variance = mean_square / dimension as f64;
    // The surface of the unit sphere over the normalisation of the components.
    let surface = match dimension {
        1 => 2.0,
        2 => 2.0 * PI * speed,
        _ => 4.0 * PI * speed * speed,
    };
    surface * (-0.5 * speed * speed / variance).exp() / (2.0 * PI * variance).powf(0.5 * dimension as f64)
}

/// The mean of [`gaussian_density`] over an interval: what the density of a bin is compared with, however wide the bin.
///
/// ```
/// use mesoscope::measure::histogram::{gaussian_density, gaussian_mean};
///
/// // 68.27 % within one standard deviation of the mean.
/// assert!((2.0 * gaussian_mean([-1.0, 1.0], 0.0, 1.0) - 0.682_689_492_137).abs() < 1e-12);
/// // Over a narrow interval the mean is the density in its middle, over a wide one it is not.
/// assert!((gaussian_mean([0.5, 0.501], 0.0, 1.0) / gaussian_density(0.5005, 0.0, 1.0) - 1.0).abs() < 1e-6);
/// assert!(gaussian_mean([-1.0, 1.0], 0.0, 1.0) < 0.9 * gaussian_density(0.0, 0.0, 1.0));
/// // A mean that the edges are too large to show.
/// assert_eq!(gaussian_mean([-0.5, 0.5], 1e-19, 1.0), gaussian_mean([-0.5, 0.5], 0.0, 1.0));
/// ```
#[must_use]
pub fn gaussian_mean([low, high]: [f64; 2], mean: f64, standard_deviation: f64) -> f64 {
    let density = |value: f64| gaussian_density(value, mean, standard_deviation);
    let beyond = |value: f64| 0.5 * libm::erfc((value - mean) / (SQRT_2 * standard_deviation));
    // Of the two tails, the differences of the smaller one have more digits.
    let mirrored = low + high < 2.0 * mean;
    let interval = if mirrored { [2.0 * mean - high, 2.0 * mean - low] } else { [low, high] };
    mean_over(interval, standard_deviation, &density, &beyond)
}

/// The mean of [`maxwell_density`] over an interval of speeds, none of them negative.
///
/// ```
/// use mesoscope::measure::histogram::maxwell_mean;
///
/// // In two dimensions 1 - exp(-v²/⟨v²⟩) are slower than v.
/// assert!((3.0 * maxwell_mean([0.0, 3.0], 4.0, 2) - (1.0 - (-2.25_f64).exp())).abs() < 1e-14);
/// ```
#[must_use]
pub fn maxwell_mean(interval: [f64; 2], mean_square: f64, dimension: usize) -> f64 {
    let standard_deviation = (mean_square / dimension as f64).sqrt();
    let beyond = |speed: f64| {
        let u = speed / (SQRT_2 * standard_deviation);
        let tail = (-u * u).exp();
        match dimension {
            1 => libm::erfc(u),
            2 => tail,
            _ => libm::erfc(u) + FRAC_2_SQRT_PI * u * tail,
        }
    };
    mean_over(interval, standard_deviation, &|speed| maxwell_density(speed, mean_square, dimension), &beyond)
}

/// Intervals below this part of a standard deviation have means from the density itself: to a difference of two nearly
/// equal probabilities too few digits would be left.
const NARROW: f64 = 1e-2;

/// The mean of a density over an interval, given the probability `beyond` a value.
fn mean_over(
    [low, high]: [f64; 2],
    standard_deviation: f64,
    density: &dyn Fn(f64) -> f64,
    beyond: &dyn Fn(f64) -> f64,
) -> f64 {
    let width = high - low;
    if width > NARROW * standard_deviation {
        return (beyond(low) - beyond(high)) / width;
    }
    // Gauss and Legendre's rule of three points.
    let shift = 0.5 * width * 0.6_f64.sqrt();
    let middle = f64::midpoint(low, high);
    (5.0 * (density(middle - shift) + density(middle + shift)) + 8.0 * density(middle)) / 18.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_density_counts_what_is_outside() {
        let histogram = Histogram { range: [-1.0, 1.0], counts: vec![1.0, 2.0, 4.0, 0.0], below: 1.0, above: 2.0 };
        assert_eq!((histogram.total(), histogram.width(), histogram.centre(3)), (10.0, 0.5, 0.75));
        assert_eq!(histogram.density(), [0.2, 0.4, 0.8, 0.0]);
        assert!(Histogram::new([0.0, 1.0], 2).density().iter().all(|value| value.is_nan()));
    }

    #[test]
    fn moments_tell_two_peaks_from_a_gaussian() {
        // ±1, half each.
        let peaks = PowerMeans { first: 0.0, second: 1.0, fourth: 1.0 };
        assert_eq!((peaks.standard_deviation(), peaks.variance_of_square(), peaks.kurtosis()), (1.0, 0.0, 1.0));
        assert_eq!(PowerMeans { first: 2.0, second: 4.0, fourth: 16.0 }.standard_deviation(), 0.0);
    }

    /// Means over bins of all widths, near the middle and in the tails, are those of a fine midpoint rule.
    #[test]
    fn means_over_bins_are_integrals_over_their_widths() {
        let averaged = |density: &dyn Fn(f64) -> f64, [low, high]: [f64; 2]| -> f64 {
            let parts = 20_000;
            let width = (high - low) / f64::from(parts);
            (0..parts).map(|part| density(low + (f64::from(part) + 0.5) * width)).sum::<f64>() / f64::from(parts)
        };
        for width in [1e-6, 1e-3, 0.012, 0.0131, 0.5, 3.0] {
            for low in [0.0, 0.3, 2.0, 9.0] {
                // The midpoint rule errs by h²f''/24, at most 2e-9 with these widths, relative to tails e^(-30) more.
                let agrees = |found: f64, density: &dyn Fn(f64) -> f64, interval: [f64; 2]| {
                    let expected = averaged(density, interval);
                    assert!((found / expected - 1.0).abs() < 1e-6, "{interval:?}: {found}, not {expected}");
                };
                for interval in [[low, low + width], [-low - width, -low], [low - 0.5 * width, low + 0.5 * width]] {
                    agrees(gaussian_mean(interval, 0.5, 1.3), &|x| gaussian_density(x, 0.5, 1.3), interval);
                }
                for dimension in 1..=3 {
                    let interval = [low, low + width];
                    let density = |x: f64| maxwell_density(x, 2.5, dimension);
                    agrees(maxwell_mean(interval, 2.5, dimension), &density, interval);
                }
            }
        }
        // Five bins over ±6 kT: the middle of one is 7 % and more away from its mean.
        let middle = gaussian_density(0.0, 0.0, 1.0);
        assert!(gaussian_mean([-1.2, 1.2], 0.0, 1.0) < 0.93 * middle);
        assert!(gaussian_mean([0.0, 1.0], 0.0, 0.0).is_nan() || gaussian_mean([0.0, 1.0], 0.0, 0.0) >= 0.0);
    }

    /// Normalisation and second moment by the midpoint rule, exact to rounding for these smooth integrands.
    #[test]
    fn densities_are_normalised_and_have_their_moments() {
        let step = 1e-3;
        let integral = |density: &dyn Fn(f64) -> f64, from: f64, power: i32| -> f64 {
            (0..30_000).map(|k| from + (f64::from(k) + 0.5) * step).map(|x| x.powi(power) * density(x) * step).sum()
        };
        let gaussian = |x: f64| gaussian_density(x, 0.5, 1.3);
        assert!((integral(&gaussian, -14.5, 0) - 1.0).abs() < 1e-9);
        assert!((integral(&gaussian, -14.5, 2) - 1.3 * 1.3 - 0.25).abs() < 1e-9);
        for dimension in 1..=3 {
            let maxwell = |x: f64| maxwell_density(x, 2.5, dimension);
            assert!((integral(&maxwell, 0.0, 0) - 1.0).abs() < 1e-6, "{dimension}");
            assert!((integral(&maxwell, 0.0, 2) - 2.5).abs() < 1e-6, "{dimension}");
        }
    }
}
