//! The names of the files in the directory of a map of stability.

use crate::study::STABILITY;

/// The table: a row for every scene that was run.
pub const TABLE: &str = "stability.csv";
/// The summary: what was asked, what became of every scene, edges and predictions.
pub const SUMMARY: &str = STABILITY.summary;
/// The page that says in words how far a scene may go.
pub const PAGE: &str = "stability.md";
/// The map.
pub const PLOT: &str = "stability.png";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_files_are_of_a_map() {
        assert!([TABLE, SUMMARY, PAGE, PLOT].into_iter().all(|name| STABILITY.has_file(name)));
    }
}
