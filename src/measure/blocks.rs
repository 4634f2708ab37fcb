//! Sums over blocks of samples, from which means of many quantities follow with errors in little memory.

use super::statistics::{Estimate, estimate};

/// Sums of rows of numbers over blocks of equal numbers of samples.
///
/// Whenever a number of blocks is full, neighbours become one block of twice as many samples: more than half of them remain, however long the
/// series is. Those of [`BlockSums::new`], more than 256, are enough for the errors of [`estimate`] to settle where the run is a few hundred
/// times as long as the correlation.
///
/// ```
/// use mesoscope::measure::blocks::BlockSums;
///
/// // Two quantities of which the second is counted: the mean of the first for each of the second.
/// let mut sums = BlockSums::new(2);
/// for sample in 0..1000 {
///     let count = f64::from(1 + sample % 3);
///     sums.add(&[5.0 * count, count]);
/// }
/// assert_eq!(sums.total(1), 1999.0);
/// let ratio = sums.ratio(|row| row[0], |row| row[1]).ok_or("nothing was counted")?;
/// assert_eq!((ratio.value, ratio.error), (5.0, Some(0.0)));
/// # Ok::<(), &str>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct BlockSums {
    width: usize,
    most: u64,
    samples: u64,
    /// Rows of sums, one a block; the last may not be full.
    blocks: Vec<f64>,
}

impl BlockSums {
    /// Begins with rows of so many numbers.
    #[must_use]
    pub fn new(width: usize) -> Self {
        Self::with_most(width, 512)
    }

    /// Begins with rows of so many numbers in at most so many blocks: 64 know an error to some tenth, in an eighth of the memory.
    pub(crate) fn with_most(width: usize, most: u64) -> Self {
        Self { width, most: most.max(2), samples: 0, blocks: Vec::new() }
    }

    /// Continues from the sums of blocks that so many samples have left.
    pub(crate) fn restore(&mut self, samples: u64, blocks: &[f64]) {
        self.samples = samples;
        self.blocks = blocks.to_vec();
    }

    /// Samples in a full block after so many.
    fn length(&self, samples: u64) -> u64 {
        samples.div_ceil(self.most).next_power_of_two()
    }

    /// Number of blocks after so many samples, the last of which may not be full.
    pub(crate) fn blocks_after(&self, samples: u64) -> u64 {
        samples.div_ceil(self.length(samples))
    }

    /// Adds a sample; numbers beyond the width are left out, and missing ones count as zero.
    pub fn add(&mut self, row: &[f64]) {
        let before = self.length(self.samples);
        self.samples += 1;
        let length = self.length(self.samples);
        if length > before {
            self.join();
        }
        let block = ((self.samples - 1) / length) as usize;
        self.blocks.resize((block + 1) * self.width, 0.0);
        self.blocks[block * self.width..].iter_mut().zip(row).for_each(|(sum, value)| *sum += value);
    }

    fn join(&mut self) {
        let width = self.width;
        let pairs = self.blocks.chunks(2 * width.max(1));
        self.blocks = pairs
            .flat_map(|pair| {
                let (first, second) = pair.split_at(width.min(pair.len()));
                let second = second.iter().copied().chain(std::iter::repeat(0.0));
                first.iter().zip(second).map(|(a, b)| a + b).collect::<Vec<f64>>()
            })
            .collect();
    }

    /// Numbers in a row.
    pub(crate) fn width(&self) -> usize {
        self.width
    }

    /// Number of samples.
    pub(crate) fn samples(&self) -> u64 {
        self.samples
    }

    /// The sums of all blocks, one row after the other.
    pub(crate) fn sums(&self) -> &[f64] {
        &self.blocks
    }

    fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.blocks.chunks_exact(self.width.max(1))
    }

    /// The sum of a quantity over all samples.
    #[must_use]
    pub fn total(&self, quantity: usize) -> f64 {
        self.rows().map(|row| row.get(quantity).copied().unwrap_or(0.0)).sum()
    }

    /// The ratio of two numbers that are made of sums and grow with them in proportion; none where the second is zero. The
    /// error is that of the ratio to first order, from the blocks that are full; there is none with fewer than two. The samples of a
    /// correlation are those of whole blocks.
    #[must_use]
    pub fn ratio(&self, numerator: impl Fn(&[f64]) -> f64, denominator: impl Fn(&[f64]) -> f64) -> Option<Estimate> {
        self.ratio_of(&self.rows().map(|row| [numerator(row), denominator(row)]).collect::<Vec<_>>())
    }

    fn ratio_of(&self, pairs: &[[f64; 2]]) -> Option<Estimate> {
        let total = pairs.iter().fold([0.0; 2], |sum, pair| [sum[0] + pair[0], sum[1] + pair[1]]);
        if total[1] == 0.0 {
            return None;
        }
        let value = total[0] / total[1];
        let full = (self.samples / self.length(self.samples)) as usize;
        let full = &pairs[..full.min(pairs.len())];
        let mean = full.iter().map(|pair| pair[1]).sum::<f64>() / full.len().max(1) as f64;
        let deviations: Vec<f64> = full.iter().map(|pair| (pair[0] - value * pair[1]) / mean).collect();
        let samples = self.samples as usize;
        Some(match estimate(&deviations) {
            Some(found) => Estimate {
                value,
                samples,
                correlation_samples: found.correlation_samples.map(|blocks| blocks * self.length(self.samples) as f64),
                ..found
            },
            None => Estimate::new(value, None, samples),
        })
    }

    /// The mean over samples of a number that is made of their sums.
    pub(crate) fn mean(&self, number: impl Fn(&[f64]) -> f64) -> Option<Estimate> {
        // What every sample counts once is a quantity of its own.
        let length = self.length(self.samples) as f64;
        let last = self.rows().count().saturating_sub(1);
        let left = self.samples as f64 - last as f64 * length;
        let counted =
            self.rows().enumerate().map(|(block, row)| [number(row), if block == last { left } else { length }]);
        self.ratio_of(&counted.collect::<Vec<_>>())
    }

    /// A number that is made of the means of all quantities, by a jackknife over the blocks that are full; none where it does not exist, if
    /// only without one of them. There is no error with fewer than two.
    pub(crate) fn jackknife(&self, number: impl Fn(&[f64]) -> Option<f64>) -> Option<Estimate> {
        let totals: Vec<f64> = (0..self.width).map(|quantity| self.total(quantity)).collect();
        let mean = |row: Option<&[f64]>| {
            let less = if row.is_some() { self.length(self.samples) } else { 0 };
            let left = (self.samples - less) as f64;
            let sums = totals.iter().enumerate().map(|(index, total)| total - row.map_or(0.0, |row| row[index]));
            number(&sums.map(|sum| sum / left).collect::<Vec<f64>>())
        };
        let value = mean(None)?;
        let full = (self.samples / self.length(self.samples)) as usize;
        let without = Estimate::new(value, None, self.samples as usize);
        if full < 2 {
            return Some(without);
        }
        let count = full as f64;
        let pseudovalue = |row| Some(count * value - (count - 1.0) * mean(Some(row))?);
        let pseudovalues = self.rows().take(full).map(pseudovalue).collect::<Option<Vec<f64>>>()?;
        let found = estimate(&pseudovalues)?;
        Some(Estimate { value, samples: self.samples as usize, ..found })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::noise;

    #[test]
    fn sums_are_kept_whatever_the_number_of_samples() {
        for samples in [0_u64, 1, 2, 511, 512, 513, 1023, 1024, 1025, 5000] {
            let mut sums = BlockSums::new(2);
            (0..samples).for_each(|sample| sums.add(&[1.0, sample as f64]));
            let blocks = sums.sums().len() as u64 / 2;
            assert_eq!(blocks, sums.blocks_after(samples), "{samples}");
            assert!(blocks <= 512 && (samples < 512 || blocks > 256), "{samples}: {blocks}");
            assert_eq!((sums.total(0), sums.samples()), (samples as f64, samples));
            assert_eq!(sums.total(1), (samples * samples.saturating_sub(1) / 2) as f64);
            let mut restored = BlockSums::new(2);
            restored.restore(samples, sums.sums());
            assert_eq!(restored, sums);
        }
    }

    #[test]
    fn a_mean_counts_every_sample_once() {
        let mut sums = BlockSums::new(1);
        // 513 samples make 257 blocks, of which the last has one.
        (0..513).for_each(|sample| sums.add(&[f64::from(sample)]));
        assert_eq!(sums.mean(|row| row[0]).unwrap().value, 256.0);
        assert_eq!(BlockSums::new(1).mean(|row| row[0]), None);
    }

    /// The square of the mean 2 of numbers of unit variance has the error 4/√n, and the jackknife of a mean is the mean.
    #[test]
    fn a_jackknife_knows_the_errors_of_other_numbers() {
        let samples = 10_000_u64;
        let mut sums = BlockSums::with_most(1, 64);
        (0..samples).for_each(|sample| sums.add(&[2.0 + noise::gaussian(noise::step_key(4, 99, sample))]));
        assert!(sums.sums().len() <= 64);
        let square = sums.jackknife(|means| Some(means[0] * means[0])).unwrap();
        let (error, exact) = (square.error.unwrap(), 4.0 / (samples as f64).sqrt());
        assert!((error / exact - 1.0).abs() < 0.5 && !square.few, "{square:?}");
        assert!((square.value - 4.0).abs() < 4.0 * exact, "{square:?}");
        let [mean, same] = [sums.mean(|row| row[0]), sums.jackknife(|means| Some(means[0]))].map(Option::unwrap);
        assert!((mean.error.unwrap() / same.error.unwrap() - 1.0).abs() < 0.05, "{mean:?} {same:?}");
        assert_eq!(sums.jackknife(|_| None), None);
    }

    /// Numbers of unit variance, each seen twice: the error of the mean of n is √(2/n).
    #[test]
    fn errors_are_those_of_correlated_samples() {
        let samples = 20_000_u64;
        let mut sums = BlockSums::new(1);
        (0..samples).for_each(|sample| sums.add(&[noise::gaussian(noise::step_key(3, 99, sample / 2))]));
        let mean = sums.mean(|row| row[0]).unwrap();
        let (error, exact) = (mean.error.unwrap(), (2.0 / samples as f64).sqrt());
        // 313 blocks of 64, of which hardly one knows of the next.
        assert!(!mean.few && (error / exact - 1.0).abs() < 0.64, "{error} against {exact}");
        assert!(mean.value.abs() < 4.0 * exact, "{}", mean.value);
    }
}
