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

/// Whether a tradeoff may have written a file of this name.
///
/// ```
/// use mesoscope::tradeoff::files;
///
/// for name in [files::TABLE, files::SUMMARY, files::PAGE, &files::plot("pressure")] {
///     assert!(files::is_of_a_tradeoff(name));
/// }
/// assert!(!files::is_of_a_tradeoff("energies.csv"));
/// ```
#[must_use]
pub fn is_of_a_tradeoff(name: &str) -> bool {
    TRADEOFF.has_file(name)
}
