//! Correlations in time, and the transport coefficients they give.

use super::statistics;
use serde::{Deserialize, Serialize};

/// Curves measured over and over from new origins in time: a mean squared displacement, a velocity autocorrelation.
///
/// Samples come one by one; each window holds `lags` of them, the first at lag 0. Windows do not overlap, so they are
/// nearly independent and their scatter gives the errors.
///
/// ```
/// use mesoscope::measure::correlation::{Coefficient, WindowedAverage};
///
/// // Two windows, and the beginning of a third, which does not count yet.
/// let average = WindowedAverage::from_samples(3, &[4.0, 2.0, 1.0, 8.0, 4.0, 2.0, 7.0]);
/// let means: Vec<f64> = average.average().iter().map(|lag| lag.value).collect();
/// assert_eq!(means, [6.0, 3.0, 1.5]);
/// assert_eq!(average.normalised()[1], Coefficient { value: 0.5, standard_error: Some(0.0) });
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct WindowedAverage {
    lags: usize,
    samples: Vec<f64>,
}

impl WindowedAverage {
    /// The average of windows of `lags` samples (at least one) that were taken one after the other.
    #[must_use]
    pub fn from_samples(lags: usize, samples: &[f64]) -> Self {
        Self { lags: lags.max(1), samples: samples.to_vec() }
    }

    /// Number of lags in a window.
    #[must_use]
    pub fn lags(&self) -> usize {
        self.lags
    }

    /// The full windows; one that is not yet full is left out.
    #[must_use]
    pub fn windows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.samples.chunks_exact(self.lags)
    }

    /// The mean over all full windows, for each lag; empty before the first window is full.
    #[must_use]
    pub fn average(&self) -> Vec<Coefficient> {
        let column = |lag: usize| -> Vec<f64> { self.windows().map(|window| window[lag]).collect() };
        (0..self.lags).filter_map(|lag| Coefficient::of_independent(&column(lag))).collect()
    }

    /// The mean at each lag over the mean at lag 0. The error is that of the ratio to first order, in which the part that
    /// both share drops out: at lag 0 it is zero.
    #[must_use]
    pub fn normalised(&self) -> Vec<Coefficient> {
        (0..self.lags).filter_map(|lag| self.ratio(|window| window[lag])).collect()
    }

    /// The mean over all lags from one on, over the mean at lag 0, in the same way; none before the first window is full, or without a lag.
    #[must_use]
    pub fn normalised_mean(&self, from: usize) -> Option<Coefficient> {
        let count = self.lags.checked_sub(from).filter(|count| *count > 0)? as f64;
        self.ratio(|window| window[from..].iter().sum::<f64>() / count)
    }

    /// The mean over the windows of a number that is linear in them, over that of lag 0.
    fn ratio(&self, of: impl Fn(&[f64]) -> f64) -> Option<Coefficient> {
        let count = self.windows().len() as f64;
        let first = self.windows().map(|window| window[0]).sum::<f64>() / count;
        let value = self.windows().map(&of).sum::<f64>() / count / first;
        let deviations: Vec<f64> = self.windows().map(|window| (of(window) - value * window[0]) / first).collect();
        Some(Coefficient { value, ..Coefficient::of_independent(&deviations)? })
    }
}

/// A number that was measured: a transport coefficient, or the mean over windows at one lag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Coefficient {
    /// The value.
    pub value: f64,
    /// Standard error from the scatter of windows or blocks; none where there are too few.
    pub standard_error: Option<f64>,
}

impl Coefficient {
    /// The mean of independent values; none where there are none.
    #[must_use]
    pub fn of_independent(values: &[f64]) -> Option<Self> {
        statistics::independent(values).map(|(value, standard_error)| Self { value, standard_error })
    }

    /// The number times a factor that is known exactly.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { value: self.value * factor, standard_error: self.standard_error.map(|error| error * factor) }
    }

    /// Value and error as cells of a table, in which an error that is not known is empty.
    pub(crate) fn cells(self) -> [f64; 2] {
        [self.value, self.standard_error.unwrap_or(f64::NAN)]
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::statistics::student;
    use super::*;

    #[test]
    fn a_normalised_average_knows_what_numerator_and_denominator_share() {
        // Windows of very different power, each of which falls by half.
        let mut samples = [1.0, 3.0, 8.0].map(|power| [power, 0.5 * power]).concat();
        let average = WindowedAverage::from_samples(2, &samples);
        let exact = |value| Coefficient { value, standard_error: Some(0.0) };
        assert_eq!(average.normalised(), [exact(1.0), exact(0.5)]);
        samples.extend([4.0, 4.0]);
        // Ratio 10/16; deviations (y - 10/16 x)/4 of the four windows, (-1, -3, -8, 12)/32, whose mean has the error
        // √(Σ²/12) = √(218/12)/32, and Student's factor of four values.
        let found = WindowedAverage::from_samples(2, &samples).normalised();
        assert_eq!(found[1].value, 0.625);
        let error = (218.0_f64 / 12.0).sqrt() / 32.0 * student(3.0);
        assert!((found[1].standard_error.unwrap() - error).abs() < 1e-15);
        assert!(WindowedAverage::from_samples(2, &[]).normalised().is_empty());
    }

    #[test]
    fn windows_are_averaged_and_the_unfinished_one_is_left_out() {
        assert!(WindowedAverage::from_samples(2, &[]).average().is_empty());
        let average = WindowedAverage::from_samples(2, &[0.0, 1.0, 0.0, 3.0, 7.0]);
        let expected =
            [(0.0, 0.0), (2.0, student(1.0))].map(|(value, error)| Coefficient { value, standard_error: Some(error) });
        assert_eq!(average.average(), expected);
        let bytes = serde_json::to_vec(&average).unwrap();
        assert_eq!(serde_json::from_slice::<WindowedAverage>(&bytes).unwrap(), average);
    }
}
