//! The mistakes of a scene.

use super::error::Problem;
use std::fmt::Display;

/// The most mistakes that are kept; further ones are counted.
const MOST: usize = 250;

/// The mistakes of a scene: the first of them as text, and the number of the others.
#[derive(Debug, Default)]
pub(crate) struct Problems {
    listed: Vec<Problem>,
    unlisted: usize,
}

impl Problems {
    pub(crate) fn push(&mut self, problem: Problem) {
        if self.is_full() {
            self.unlisted += 1;
        } else {
            self.listed.push(problem);
        }
    }

    /// Adds a mistake: the value found at a path, and what is accepted there. No text is made of what is only counted.
    pub(crate) fn refuse(&mut self, path: impl Display, found: impl Display, accepted: impl Display) {
        self.add(path, format_args!("found {found}"), accepted);
    }

    /// Adds a mistake that is another than a value in its place, as a phrase.
    pub(crate) fn add(&mut self, path: impl Display, phrase: impl Display, accepted: impl Display) {
        if self.is_full() {
            self.unlisted += 1;
        } else {
            self.listed.push(Problem::new(path, phrase.to_string(), accepted.to_string()));
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.listed.is_empty()
    }

    /// Whether further mistakes are only counted, so that their text is not needed.
    pub(crate) fn is_full(&self) -> bool {
        self.listed.len() >= MOST
    }

    /// Number of mistakes.
    pub(crate) fn count(&self) -> usize {
        self.listed.len() + self.unlisted
    }

    /// Adds those that another found.
    pub(crate) fn append(&mut self, other: Self) {
        let unlisted = other.unlisted;
        self.extend(other.listed);
        self.unlisted += unlisted;
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &Problem> {
        self.listed.iter()
    }

    /// Keeps those of which a predicate holds; what is only counted is not asked about.
    pub(crate) fn retain(&mut self, keep: impl FnMut(&Problem) -> bool) {
        self.listed.retain(keep);
    }

    /// The mistakes, and how many are not among them.
    pub(crate) fn into_parts(self) -> (Vec<Problem>, usize) {
        (self.listed, self.unlisted)
    }
}

impl Extend<Problem> for Problems {
    fn extend<T: IntoIterator<Item = Problem>>(&mut self, problems: T) {
        for problem in problems {
            self.push(problem);
        }
    }
}

/// A number short enough for a sentence.
pub(crate) fn brief(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) { format!("{value:.3}") } else { format!("{value:.2e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_counted_and_not_kept() {
        let mut problems = Problems::default();
        problems.extend((0..5000).map(|index| Problem::new(index, "found", "none")));
        assert_eq!((problems.count(), problems.iter().count(), problems.is_full()), (5000, MOST, true));
        let mut all = Problems::default();
        all.push(Problem::new("first", "found", "none"));
        all.append(problems);
        let (listed, unlisted) = all.into_parts();
        assert_eq!((listed.len(), unlisted, listed[0].path.as_str()), (MOST, 4751, "first"));
    }
}
