//! The names of the files in the directory of a sweep, in addition to the directories of its variants.

use crate::study::SWEEP;

/// The table: a row for every variant.
pub const TABLE: &str = "sweep.csv";
/// The summary: what was varied and what came out.
pub const SUMMARY: &str = SWEEP.summary;

/// The table of averages over the seed: a row for every variant but for its seed.
pub(crate) const AVERAGES: &str = "sweep-averages.csv";

/// The plot of means against what is varied; further ones where there are many quantities, from 2.
///
/// ```
/// use mesoscope::sweep::files;
/// assert_eq!([files::means(1), files::means(2)], ["sweep-means.png", "sweep-means-2.png"]);
/// ```
#[must_use]
pub fn means(number: usize) -> String {
    if number < 2 { "sweep-means.png".to_owned() } else { format!("sweep-means-{number}.png") }
}

/// The plot of a quantity.
///
/// ```
/// assert_eq!(mesoscope::sweep::files::plot("total_energy"), "sweep-total_energy.png");
/// ```
#[must_use]
pub fn plot(quantity: &str) -> String {
    SWEEP.plot(quantity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_files_of_a_sweep_are_recognised() {
        for name in [TABLE, AVERAGES, SUMMARY, "sweep-total_energy.png", "sweep-x.png"] {
            assert!(SWEEP.has_file(name), "{name}");
        }
        for name in
            ["sweep", "sweep-.png", "sweep-x.jpg", "sweep.json.bak", "sweep.json.tmp", "energies.csv", "friction=1"]
        {
            assert!(!SWEEP.has_file(name), "{name}");
        }
    }
}
