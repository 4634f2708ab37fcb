//! Correlations in time, and the transport coefficients they give.

use super::statistics::{Estimate, independent};
use serde::{Deserialize, Serialize};

/// Curves measured over and over from new origins in time: a mean squared displacement, a velocity autocorrelation.
///
/// Samples come one by one; each window holds `lags` of them, the first at lag 0. Windows do not overlap, so they are
/// nearly independent and their scatter gives the errors.
///
/// ```
/// use mesoscope::measure::correlation::WindowedAverage;
///
/// // Two windows, and the beginning of a third, which does not count yet.
/// let average = WindowedAverage::from_samples(3, &[4.0, 2.0, 1.0, 8.0, 4.0, 2.0, 7.0]);
/// let means: Vec<f64> = average.average().iter().map(|lag| lag.value).collect();
/// assert_eq!(means, [6.0, 3.0, 1.5]);
/// let second = average.normalised()[1];
/// assert_eq!((second.value, second.error), (0.5, Some(0.0)));
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
    pub(crate) fn lags(&self) -> usize {
        self.lags
    }

    /// The full windows; one that is not yet full is left out.
    pub(crate) fn windows(&self) -> impl ExactSizeIterator<Item = &[f64]> {
        self.samples.chunks_exact(self.lags)
    }

    /// The mean over all full windows, for each lag; empty before the first window is full.
    #[must_use]
    pub fn average(&self) -> Vec<Estimate> {
        let column = |lag: usize| -> Vec<f64> { self.windows().map(|window| window[lag]).collect() };
        (0..self.lags).filter_map(|lag| independent(&column(lag))).collect()
    }

    /// The mean at each lag over the mean at lag 0. The error is that of the ratio to first order, in which the part that
    /// both share drops out: at lag 0 it is zero.
    #[must_use]
    pub fn normalised(&self) -> Vec<Estimate> {
        (0..self.lags).filter_map(|lag| self.ratio(|window| window[lag])).collect()
    }

    /// The mean over all lags from one on, over the mean at lag 0, in the same way; none before the first window is full, or without a lag.
    pub(crate) fn normalised_mean(&self, from: usize) -> Option<Estimate> {
        let count = self.lags.checked_sub(from).filter(|count| *count > 0)? as f64;
        self.ratio(|window| window[from..].iter().sum::<f64>() / count)
    }

    /// The mean over the windows of a number that is linear in them, over that of lag 0.
    fn ratio(&self, of: impl Fn(&[f64]) -> f64) -> Option<Estimate> {
        let count = self.windows().len() as f64;
        let first = self.windows().map(|window| window[0]).sum::<f64>() / count;
        let value = self.windows().map(&of).sum::<f64>() / count / first;
        let deviations: Vec<f64> = self.windows().map(|window| (of(window) - value * window[0]) / first).collect();
        Some(Estimate { value, ..independent(&deviations)? })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::measure::statistics::student;

    #[test]
    fn a_normalised_average_knows_what_numerator_and_denominator_share() {
        // Windows of very different power, each of which falls by half.
        let mut samples = [1.0, 3.0, 8.0].map(|power| [power, 0.5 * power]).concat();
        let average = WindowedAverage::from_samples(2, &samples);
        let exact = |value| Estimate::new(value, Some(0.0), 3);
        assert_eq!(average.normalised(), [exact(1.0), exact(0.5)]);
        samples.extend([4.0, 4.0]);
        // Ratio 10/16; deviations (y - 10/16 x)/4 of the four windows, (-1, -3, -8, 12)/32, whose mean has the error
        // √(Σ²/12) = √(218/12)/32, and Student's factor of four values.
        let found = WindowedAverage::from_samples(2, &samples).normalised();
        assert_eq!(found[1].value, 0.625);
        let error = (218.0_f64 / 12.0).sqrt() / 32.0 * student(3.0);
        assert!((found[1].error.unwrap() - error).abs() < 1e-15);
        assert!(WindowedAverage::from_samples(2, &[]).normalised().is_empty());
    }

    #[test]
    fn windows_are_averaged_and_the_unfinished_one_is_left_out() {
        assert!(WindowedAverage::from_samples(2, &[]).average().is_empty());
        let average = WindowedAverage::from_samples(2, &[0.0, 1.0, 0.0, 3.0, 7.0]);
        let expected = [(0.0, 0.0), (2.0, student(1.0))].map(|(value, error)| Estimate::new(value, Some(error), 2));
        assert_eq!(average.average(), expected);
        let bytes = serde_json::to_vec(&average).unwrap();
        assert_eq!(serde_json::from_slice::<WindowedAverage>(&bytes).unwrap(), average);
    }
}
