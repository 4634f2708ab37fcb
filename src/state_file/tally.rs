//! Things of one kind: a few named, all counted.

use super::Mistake;
use std::fmt::Display;

/// Things of one kind: a few named, all counted.
#[derive(Debug, Clone, Default)]
pub(super) struct Tally {
    named: Vec<String>,
    count: u64,
}

/// Things that are named.
const NAMED: usize = 5;

impl Tally {
    pub(super) fn add(&mut self, name: impl FnOnce() -> String) {
        self.count += 1;
        if self.named.len() < NAMED {
            self.named.push(name());
        }
    }

    /// All of them in words, if there are any.
    pub(super) fn phrase(&self, noun: &str) -> Option<String> {
        let more = self.count - self.named.len() as u64;
        let plural = if self.count == 1 { "" } else { "s" };
        let named = self.named.join(", ");
        match (self.count, more) {
            (0, _) => None,
            (_, 0) => Some(format!("{noun}{plural} {named}")),
            _ => Some(format!("{noun}{plural} {named} and {more} more")),
        }
    }

    /// The mistake that they are there, if there are any.
    pub(super) fn mistake(&self, noun: &str, what: &str, accepted: impl Into<String>) -> Option<Mistake> {
        Some(Mistake::new("", format!("found {} {what}", self.phrase(noun)?), accepted))
    }
}

impl<T: Display> FromIterator<T> for Tally {
    fn from_iter<I: IntoIterator<Item = T>>(names: I) -> Self {
        let mut tally = Self::default();
        names.into_iter().for_each(|name| tally.add(|| name.to_string()));
        tally
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_are_named_and_all_counted() {
        let phrase = |numbers: &[u64]| numbers.iter().collect::<Tally>().phrase("atom");
        assert_eq!(phrase(&[]), None);
        assert_eq!(phrase(&[7]).as_deref(), Some("atom 7"));
        assert_eq!(phrase(&[7, 0, 1, 2, 3, 4, 5, 6, 7, 8]).as_deref(), Some("atoms 7, 0, 1, 2, 3 and 5 more"));
    }
}
