//! The names of the files in the directory of a tradeoff, in addition to the directories of its runs.

use crate::study::{self, Kind};

/// What messages say of tradeoffs.
pub(super) const KIND: Kind = Kind {
    command: "tradeoff",
    noun: "tradeoff",
    summary: SUMMARY,
    again: "run the tradeoff again",
    resumed: "goes on",
    shortened: "--budget to shorten them",
    has_file: is_of_a_tradeoff,
};

/// The table: a row for every choice.
pub const TABLE: &str = "tradeoff.csv";
/// The summary: what was asked, what every choice costs, and how far off it is.
pub const SUMMARY: &str = "tradeoff.json";
/// The page that says in words what to choose.
pub const PAGE: &str = "tradeoff.md";

/// The picture of a measure.
///
/// ```
/// assert_eq!(mesoscope::tradeoff::files::plot("pressure"), "tradeoff-pressure.png");
/// ```
#[must_use]
pub fn plot(measure: &str) -> String {
    study::plot(KIND.command, measure)
}

/// Whether a tradeoff may have written a file of this name.
///
/// ```
/// use mesoscope::tradeoff::files;
///
/// assert!(files::is_of_a_tradeoff("tradeoff.md") && files::is_of_a_tradeoff(&files::plot("pressure")));
/// assert!(!files::is_of_a_tradeoff("energies.csv"));
/// ```
#[must_use]
pub fn is_of_a_tradeoff(name: &str) -> bool {
    [TABLE, SUMMARY, PAGE].contains(&name) || study::is_plot(KIND.command, name)
}
