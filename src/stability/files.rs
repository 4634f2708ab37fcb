//! The names of the files in the directory of a map of stability.

use crate::study::Kind;

/// What messages say of maps.
pub(super) const KIND: Kind = Kind {
    command: "stability",
    noun: "map of stability",
    summary: SUMMARY,
    again: "make the map again",
    resumed: "goes on",
    shortened: "shorten them with --set time.steps=N or a narrower range",
    has_file: |name| ALL.contains(&name),
};

/// The table: a row for every scene that was run.
pub const TABLE: &str = "stability.csv";
/// The summary: what was asked, what became of every scene, edges and predictions.
pub const SUMMARY: &str = "stability.json";
/// The page that says in words how far a scene may go.
pub const PAGE: &str = "stability.md";
/// The map.
pub const PLOT: &str = "stability.png";

/// All of them.
pub(super) const ALL: [&str; 4] = [TABLE, SUMMARY, PAGE, PLOT];
