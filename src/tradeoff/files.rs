//! The names of the files in the directory of a tradeoff, in addition to the directories of its runs.

use crate::study::TRADEOFF;

/// The table: a row for every choice.
pub const TABLE: &str = "tradeoff.csv";
/// The summary: what was asked, what every choice costs, and how far off it is.
pub const SUMMARY: &str = TRADEOFF.summary;
/// The page that says in words what to choose.
pub const PAGE: &str = "tradeoff.md";

/// The picture of a measure.
///
/// ```
/// assert_eq!(mesoscope::tradeoff::files::plot("pressure"), "tradeoff-pressure.png");
/// ```
#[must_use]
pub fn plot(measure: &str) -> String {
    TRADEOFF.plot(measure)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_files_of_a_tradeoff_are_recognised() {
        for name in [TABLE, SUMMARY, PAGE, &plot("pressure")] {
            assert!(TRADEOFF.has_file(name), "{name}");
        }
        assert!(!TRADEOFF.has_file("energies.csv"));
    }
}
