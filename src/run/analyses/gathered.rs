//! Kept numbers of the samples of an analysis, in memory and in checkpoints.

use crate::measure::blocks::BlockSums;

/// Numbers that are kept of samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Part {
    /// Those of all samples, one after the other, so many of each.
    Series(usize, Vec<f64>),
    /// Their sums over all samples.
    Sums(Vec<f64>),
    /// Their sums over blocks of samples.
    Blocks(BlockSums),
    /// Those of the last sample, so many.
    Last(usize, Vec<f64>),
}

impl Part {
    pub(super) fn series(width: usize) -> Self {
        Self::Series(width, Vec::new())
    }

    pub(super) fn sums(width: usize) -> Self {
        Self::Sums(vec![0.0; width])
    }

    /// How many numbers of a sample belong to it.
    fn width(&self) -> usize {
        match self {
            Self::Series(width, _) | Self::Last(width, _) => *width,
            Self::Sums(sums) => sums.len(),
            Self::Blocks(blocks) => blocks.width(),
        }
    }

    fn add(&mut self, numbers: &[f64]) {
        match self {
            Self::Series(_, kept) => kept.extend_from_slice(numbers),
            Self::Sums(sums) => sums.iter_mut().zip(numbers).for_each(|(sum, number)| *sum += number),
            Self::Blocks(blocks) => blocks.add(numbers),
            Self::Last(_, kept) => *kept = numbers.to_vec(),
        }
    }

    fn numbers(&self) -> &[f64] {
        match self {
            Self::Series(_, kept) | Self::Last(_, kept) | Self::Sums(kept) => kept,
            Self::Blocks(blocks) => blocks.sums(),
        }
    }

    /// How many numbers are kept after so many samples.
    fn length_after(&self, samples: u64) -> u64 {
        let rows = match self {
            Self::Series(..) => samples,
            Self::Sums(_) => 1,
            Self::Blocks(blocks) => blocks.blocks_after(samples),
            Self::Last(..) => samples.min(1),
        };
        rows.saturating_mul(self.width() as u64)
    }

    fn restore(&mut self, numbers: &[f64], samples: u64) {
        match self {
            Self::Series(_, kept) | Self::Last(_, kept) | Self::Sums(kept) => *kept = numbers.to_vec(),
            Self::Blocks(blocks) => blocks.restore(samples, numbers),
        }
    }
}

/// Gathered samples. The numbers of a sample are those of its parts, one part after the other.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Gathered {
    samples: u64,
    parts: Vec<Part>,
}

impl Gathered {
    /// Begins without a sample.
    pub(super) fn new(parts: Vec<Part>) -> Self {
        Self { samples: 0, parts }
    }

    /// Adds the numbers of a sample; one that has more or fewer than its parts is left out.
    pub(super) fn add(&mut self, mut numbers: &[f64]) {
        let width = self.parts.iter().map(Part::width).sum::<usize>();
        debug_assert_eq!(numbers.len(), width, "a sampler leaves the numbers of all parts");
        if numbers.len() != width {
            return;
        }
        self.samples += 1;
        for part in &mut self.parts {
            let (own, rest) = numbers.split_at(part.width());
            part.add(own);
            numbers = rest;
        }
    }

    /// Number of samples.
    pub(super) fn samples(&self) -> u64 {
        self.samples
    }

    /// The numbers that are kept by the part at this place; nothing where there is no part.
    pub(super) fn part(&self, place: usize) -> &[f64] {
        self.parts.get(place).map_or(&[], Part::numbers)
    }

    /// The sums over blocks, of the first part that has these.
    pub(super) fn blocks(&self) -> Option<&BlockSums> {
        self.parts.iter().find_map(|part| if let Part::Blocks(blocks) = part { Some(blocks) } else { None })
    }

    /// All numbers that are kept, for a checkpoint.
    pub(super) fn numbers(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().flat_map(Part::numbers).copied()
    }

    /// How many numbers are kept after so many samples.
    pub(super) fn length_after(&self, samples: u64) -> u64 {
        self.parts.iter().map(|part| part.length_after(samples)).fold(0, u64::saturating_add)
    }

    /// Continues from what [`Self::numbers`] gave after so many samples, which is as much as [`Self::length_after`]
    /// says.
    pub(super) fn restore(&mut self, mut numbers: &[f64], samples: u64) {
        self.samples = samples;
        for part in &mut self.parts {
            let (own, rest) = numbers.split_at((part.length_after(samples) as usize).min(numbers.len()));
            part.restore(own, samples);
            numbers = rest;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{BlockSums, Gathered, Part};

    fn of_all_parts() -> Gathered {
        Gathered::new(vec![Part::Last(1, Vec::new()), Part::series(2), Part::sums(2), Part::Blocks(BlockSums::new(1))])
    }

    fn after(samples: u64) -> Gathered {
        let mut gathered = of_all_parts();
        for sample in 0..samples {
            let first = 6.0 * sample as f64;
            gathered.add(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|place| first + place));
        }
        gathered
    }

    #[test]
    fn each_part_keeps_its_own_numbers() {
        let gathered = after(3);
        assert_eq!(gathered.samples(), 3);
        assert_eq!(gathered.part(0), [12.0]);
        assert_eq!(gathered.part(1), [1.0, 2.0, 7.0, 8.0, 13.0, 14.0]);
        assert_eq!(gathered.part(2), [27.0, 30.0]);
        assert_eq!(gathered.part(3), [5.0, 11.0, 17.0]);
        assert_eq!(gathered.part(4), [0.0; 0]);
        assert_eq!(gathered.blocks().map(|blocks| blocks.total(0)), Some(33.0));
    }

    /// Restored numbers are those that were kept, and continue alike: without a sample, with some, and with blocks of
    /// two.
    #[test]
    fn restored_numbers_continue() {
        for samples in [0, 1, 5, 513] {
            let kept: Vec<f64> = after(samples).numbers().collect();
            assert_eq!(kept.len() as u64, of_all_parts().length_after(samples), "after {samples}");
            let mut restored = of_all_parts();
            restored.restore(&kept, samples);
            assert_eq!(restored, after(samples), "after {samples}");
            let mut continued = after(samples);
            for gathered in [&mut restored, &mut continued] {
                gathered.add(&[9.0; 6]);
            }
            assert_eq!(restored, continued, "after {samples} and one more");
        }
    }
}
