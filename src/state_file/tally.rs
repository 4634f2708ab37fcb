//! Things of one kind: a few named, all counted.

use super::Mistake;

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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_few_are_named_and_all_counted() {
        let mut tally = Tally::default();
        assert_eq!(tally.phrase("atom"), None);
        tally.add(|| "7".to_owned());
        assert_eq!(tally.phrase("atom").as_deref(), Some("atom 7"));
        (0..9).for_each(|number| tally.add(|| number.to_string()));
        assert_eq!(tally.phrase("atom").as_deref(), Some("atoms 7, 0, 1, 2, 3 and 5 more"));
    }
}
