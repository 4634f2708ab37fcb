//! The particles of a picture: all, or of very many a sample that their numbers alone decide, so that any number of ranks shows the same.

use crate::state::Reported;
use serde::{Deserialize, Serialize};

/// Particles as a report leaves them, in order of their numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Shown {
    /// Their positions, momenta and species.
    pub state: Reported,
    /// Their numbers, if they are a sample.
    pub numbers: Option<Vec<u32>>,
}

/// Which particles belong to a sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Sampling {
    /// Scrambled numbers below this.
    below: u32,
}

impl Sampling {
    /// About so many of all; none if all are to be shown.
    pub(crate) fn new(particles: u64, most: u64) -> Option<Self> {
        let below = (u128::from(most) << 32) / u128::from(particles.max(1));
        u32::try_from(below).ok().map(|below| Self { below })
    }

    /// Whether it holds a particle.
    pub(crate) fn holds(self, number: u32) -> bool {
        scrambled(number) < self.below
    }

    /// The numbers of so many particles that it holds.
    pub(crate) fn numbers(self, particles: u64) -> Vec<u32> {
        (0..u32::try_from(particles).unwrap_or(u32::MAX)).filter(|number| self.holds(*number)).collect()
    }
}

/// A number without the order of its neighbours, which may be one of places: the finish of `MurmurHash3`, a bijection.
fn scrambled(number: u32) -> u32 {
    let mut word = number;
    word = (word ^ (word >> 16)).wrapping_mul(0x85eb_ca6b);
    word = (word ^ (word >> 13)).wrapping_mul(0xc2b2_ae35);
    word ^ (word >> 16)
}

/// What some particles have of an array, which may be one that the state has not.
fn some_of<T: Copy>(all: &[T], numbers: &[u32]) -> Vec<T> {
    numbers.iter().filter_map(|number| all.get(*number as usize)).copied().collect()
}

impl Shown {
    /// All particles of a state, or about so many of them if there are more.
    ///
    /// ```
    /// use mesoscope::engine::Shown;
    /// use mesoscope::state::Reported;
    ///
    /// let count = 10_000;
    /// let positions = (0..count).map(|number| [number, 0, 0]).collect();
    /// let state = Reported { positions, ..Reported::default() };
    /// assert_eq!(Shown::of(state.clone(), 10_000).numbers, None);
    /// let shown = Shown::of(state, 1_000);
    /// assert!(shown.state.len().abs_diff(1_000) < 150);
    /// let positions = shown.state.positions.iter().map(|position| position[0]);
    /// assert_eq!(shown.numbers, Some(positions.collect()));
    /// ```
    #[must_use]
    pub fn of(state: Reported, most: u64) -> Self {
        let Some(sampling) = Sampling::new(state.len() as u64, most) else { return Self::all(state) };
        let numbers = sampling.numbers(state.len() as u64);
        let sample = Reported {
            step: state.step,
            positions: some_of(&state.positions, &numbers),
            momenta: some_of(&state.momenta, &numbers),
            species: some_of(&state.species, &numbers),
            ..Reported::default()
        };
        Self { state: sample, numbers: Some(numbers) }
    }

    /// All particles of a state.
    #[must_use]
    pub fn all(state: Reported) -> Self {
        Self { state, numbers: None }
    }

    /// The place of a particle, if it is shown.
    #[must_use]
    pub(crate) fn place(&self, number: u32) -> Option<usize> {
        match &self.numbers {
            None => Some(number as usize),
            Some(numbers) => numbers.binary_search(&number).ok(),
        }
    }
}
