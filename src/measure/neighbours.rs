//! How many neighbours Voronoi cells have.

use super::statistics::{Estimate, estimate};
use crate::tessellation::Tessellation;

/// Numbers of neighbours that are counted separately; the last one is that or more.
pub(crate) const MOST_NEIGHBOURS: usize = 32;

/// Fractions of the cells of random points that have 0, 1, 2 … neighbours, to a few units of the last digit: from 4 million
/// points by [`Tessellation`], in accord with Tanemura, Forma 18, 221 (2003).
pub(crate) const RANDOM_POINTS: [f64; 14] =
    [0.0, 0.0, 0.0, 0.0113, 0.1068, 0.2595, 0.2947, 0.1988, 0.0901, 0.0297, 0.0074, 0.0015, 0.0002, 0.0];

/// Counts of cells by their number of neighbours, sample by sample.
///
/// ```
/// use mesoscope::{measure::neighbours::NeighbourCounts, tessellation::Tessellation};
///
/// let cells = Tessellation::new([3.0, 2.0], &[[0.1, 0.2], [1.1, 0.1], [2.3, 0.6], [0.6, 1.2], [1.5, 1.4]]);
/// let counts = NeighbourCounts::from_samples(&[NeighbourCounts::of_cells(&cells)]);
/// // By Euler's formula, whatever the points.
/// assert_eq!(counts.mean().map(|found| found.value), Some(6.0));
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct NeighbourCounts {
    samples: Vec<[f64; MOST_NEIGHBOURS + 1]>,
}

impl NeighbourCounts {
    /// Counts of samples, each of which [`Self::of_cells`] has made.
    #[must_use]
    pub fn from_samples(samples: &[[f64; MOST_NEIGHBOURS + 1]]) -> Self {
        Self { samples: samples.to_vec() }
    }

    /// Cells by the number of their faces. Of a cell that meets another at several faces, or itself, all faces count:
    /// the mean is then 6 in any tessellation without corners of more than three cells.
    #[must_use]
    pub fn of_cells(tessellation: &Tessellation) -> [f64; MOST_NEIGHBOURS + 1] {
        let mut counts = [0.0; MOST_NEIGHBOURS + 1];
        for cell in &tessellation.cells {
            counts[cell.faces.len().min(MOST_NEIGHBOURS)] += 1.0;
        }
        counts
    }

    /// Number of samples.
    pub(crate) fn len(&self) -> usize {
        self.samples.len()
    }

    /// Whether there is no sample.
    pub(crate) fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }

    /// The fraction of cells with so many neighbours.
    pub(crate) fn fraction(&self, neighbours: usize) -> Option<Estimate> {
        self.estimate(|counts| counts[neighbours] / counts.iter().sum::<f64>())
    }

    /// The mean number of neighbours.
    #[must_use]
    pub fn mean(&self) -> Option<Estimate> {
        self.estimate(|counts| moment(counts, 1))
    }

    /// The variance of the number of neighbours between the cells of a sample; 1.78 for random points.
    pub(crate) fn variance(&self) -> Option<Estimate> {
        self.estimate(|counts| moment(counts, 2) - moment(counts, 1).powi(2))
    }

    fn estimate(&self, value: impl Fn(&[f64; MOST_NEIGHBOURS + 1]) -> f64) -> Option<Estimate> {
        estimate(&self.samples.iter().map(value).collect::<Vec<_>>())
    }
}

fn moment(counts: &[f64], power: i32) -> f64 {
    let sum: f64 = counts.iter().enumerate().map(|(number, count)| (number as f64).powi(power) * count).sum();
    sum / counts.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;
    use crate::scene::Generator;

    fn random(count: u32) -> Tessellation {
        let key = noise::step_key(5, 78, 0);
        let places: Vec<[u32; 3]> = (0..count)
            .map(|point| noise::words(Generator::Threefry2x32, key, [point, 0]))
            .map(|[x, y]| [x, y, 0])
            .collect();
        Tessellation::of_fractions([1.0, 1.0], &places)
    }

    #[test]
    fn random_points_have_the_fractions_of_the_literature() {
        let count = 60_000;
        let counts = NeighbourCounts::from_samples(&[NeighbourCounts::of_cells(&random(count))]);
        assert_eq!(counts.mean().unwrap().value, 6.0);
        for (neighbours, expected) in RANDOM_POINTS.iter().enumerate() {
            let found = counts.fraction(neighbours).unwrap().value;
            // Four deviations of independent cells, of which real ones have less, and the last digit.
            let error = 4.0 * (expected / f64::from(count)).sqrt() + 2e-4;
            assert!((found - expected).abs() < error, "{neighbours}: {found}, not {expected}");
        }
        let variance = counts.variance().unwrap().value;
        assert!((variance - 1.78).abs() < 0.04, "{variance}");
    }

    #[test]
    fn squares_have_four() {
        let places: Vec<[f64; 2]> = (0..16).map(|site| [f64::from(site % 4), f64::from(site / 4)]).collect();
        let samples = [Tessellation::new([4.0, 4.0], &places), random(16)];
        let counts = NeighbourCounts::from_samples(&samples.each_ref().map(NeighbourCounts::of_cells));
        assert_eq!((counts.len(), counts.samples[0][4]), (2, 16.0));
        assert_eq!(counts.mean().unwrap().value, 5.0);
    }
}
