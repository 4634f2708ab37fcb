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
            Self::Blocks(_) => BlockSums::blocks_after(samples),
            Self::Last(..) => samples.min(1),
        };
        rows.saturating_mul(self.width() as u64)
    }

    fn restore(&mut self, numbers: &[f64], samples: u64) {
        match self {
            Self::Series(_, kept) | Self::Last(_, kept) | Self::Sums(kept) => *kept = numbers.to_vec(),
            Self::Blocks(blocks) => *blocks = BlockSums::of(blocks.width(), samples, numbers),
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
