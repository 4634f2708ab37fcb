//! The names of the files in the directory of a sweep, beside the directories of its variants.

/// The table: a row for every variant.
pub const TABLE: &str = "sweep.csv";
/// The summary: what was varied and what came out.
pub const SUMMARY: &str = "sweep.json";

/// The plot of a quantity.
///
/// ```
/// assert_eq!(mesoscope::sweep::files::plot("total_energy"), "sweep-total_energy.png");
/// ```
#[must_use]
pub fn plot(quantity: &str) -> String {
    format!("sweep-{quantity}.png")
}

/// Whether a sweep may have written a file of this name, finished or not.
///
/// ```
/// use mesoscope::sweep::files;
///
/// assert!(files::is_of_a_sweep(&files::plot("temperature")));
/// assert!(!files::is_of_a_sweep("energies.csv"));
/// ```
#[must_use]
pub fn is_of_a_sweep(name: &str) -> bool {
    let name = name.strip_suffix(".tmp").unwrap_or(name);
    let is_plot = name.strip_prefix("sweep-").and_then(|rest| rest.strip_suffix(".png")).is_some_and(|q| !q.is_empty());
    name == TABLE || name == SUMMARY || is_plot
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_files_of_a_sweep_are_recognised() {
        for name in ["sweep.csv", "sweep.json.tmp", "sweep-total_energy.png", "sweep-x.png.tmp"] {
            assert!(is_of_a_sweep(name), "{name}");
        }
        for name in ["sweep", "sweep-.png", "sweep-x.jpg", "sweep.json.bak", "energies.csv", "friction=1"] {
            assert!(!is_of_a_sweep(name), "{name}");
        }
    }
}
