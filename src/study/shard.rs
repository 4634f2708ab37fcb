//! A part of the runs of a study, for a process of its own.

use std::fmt;

/// What a text of a shard has to be.
const ACCEPTED: &str = "accepted: the number of a shard and how many there are, from 1/16 to 16/16";

/// One of several parts of a sweep that are run apart, on different machines perhaps.
///
/// Shards are numbered from one. Of n shards, shard i runs the variants i, i + n, i + 2n and so on, where the first variant has the
/// number one: neighbours, which often take as long as each other, belong to different shards.
///
/// ```
/// use mesoscope::study::Shard;
///
/// let shard = Shard::parse("3/4")?;
/// let places: Vec<usize> = (0..10).filter(|place| shard.has(*place)).collect();
/// assert_eq!((shard.to_string().as_str(), places), ("3/4", vec![2, 6]));
/// assert!(Shard::parse("0/4").is_err() && Shard::parse("5/4").is_err());
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    count: u64,
}

impl Shard {
    /// Shard `number`, from one, of `count`; none if there is no such shard.
    #[must_use]
    pub fn new(number: u64, count: u64) -> Option<Self> {
        (1..=count).contains(&number).then_some(Self { number, count })
    }

    /// Reads `3/16`.
    ///
    /// # Errors
    /// What is accepted, in words.
    pub fn parse(text: &str) -> Result<Self, String> {
        let number = |text: &str| text.bytes().all(|digit| digit.is_ascii_digit()).then(|| text.parse().ok()).flatten();
        let shard = text.split_once('/').and_then(|(one, all)| Self::new(number(one)?, number(all)?));
        shard.ok_or_else(|| ACCEPTED.to_owned())
    }

    /// Its number, from one.
    pub(crate) fn number(self) -> u64 {
        self.number
    }

    /// How many there are.
    pub(crate) fn count(self) -> u64 {
        self.count
    }

    /// Whether it has the variant at this place, from zero, in the list of all.
    #[must_use]
    pub fn has(self, place: usize) -> bool {
        place as u64 % self.count == self.number - 1
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}/{}", self.number, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_variant_has_one_shard() {
        for count in 1..=7 {
            let shards: Vec<Shard> = (1..=count).filter_map(|number| Shard::new(number, count)).collect();
            assert_eq!(shards.len() as u64, count);
            for place in 0..30 {
                assert_eq!(shards.iter().filter(|shard| shard.has(place)).count(), 1, "{place} of {count}");
            }
            assert!(shards[0].has(0));
        }
    }

    #[test]
    fn only_shards_that_there_are_are_read() {
        for text in ["1/1", "16/16", "3/4096"] {
            assert_eq!(Shard::parse(text).map(|shard| shard.to_string()), Ok(text.to_owned()));
        }
        for text in [
            "",
            "/",
            "3",
            "0/4",
            "5/4",
            "0/0",
            "a/b",
            "1/",
            "/4",
            "-1/4",
            "+1/4",
            "1/2/3",
            "1 / 4",
            "1/99999999999999999999",
        ] {
            assert_eq!(Shard::parse(text), Err(ACCEPTED.to_owned()), "{text}");
        }
    }
}
