//! The names of the files in the directory of a tradeoff, in addition to the directories of its runs.

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
    format!("tradeoff-{measure}.png")
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
    let measure = name.strip_prefix("tradeoff-").and_then(|rest| rest.strip_suffix(".png"));
    [TABLE, SUMMARY, PAGE].contains(&name) || measure.is_some_and(|measure| !measure.is_empty())
}
