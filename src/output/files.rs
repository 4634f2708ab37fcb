//! The names of the files in a run directory.
//!
//! Numbered snapshots count from 1 without gaps, so that ffmpeg takes them as they are:
//!
//! ```text
//! ffmpeg -framerate 25 -i snapshot-%06d.png -pix_fmt yuv420p movie.mp4
//! ```

/// The table of energies.
pub const ENERGIES: &str = "energies.csv";
/// The plot of energies.
pub const ENERGIES_PLOT: &str = "energies.png";
/// The picture of the last state.
pub const SNAPSHOT: &str = "snapshot.png";
/// The state to resume from.
pub const CHECKPOINT: &str = "checkpoint.bin";
/// The summary of the run.
pub const SUMMARY: &str = "run.json";
/// The trajectory in HOOMD's GSD format.
pub const TRAJECTORY_GSD: &str = "trajectory.gsd";
/// The trajectory in Extended XYZ.
pub const TRAJECTORY_XYZ: &str = "trajectory.xyz";
/// The radial distribution function.
pub const RADIAL_DISTRIBUTION: &str = "radial_distribution.csv";
/// The plot of the radial distribution function.
pub const RADIAL_DISTRIBUTION_PLOT: &str = "radial_distribution.png";
/// Mean squared displacement and velocity autocorrelation.
pub const DIFFUSION: &str = "diffusion.csv";
/// The plot of mean squared displacement and velocity autocorrelation.
pub const DIFFUSION_PLOT: &str = "diffusion.png";
/// The autocorrelation of transverse momentum waves.
pub const VISCOSITY: &str = "viscosity.csv";
/// The plot of the autocorrelation of transverse momentum waves.
pub const VISCOSITY_PLOT: &str = "viscosity.png";

/// Every fixed name that a run may write.
pub const ALL: [&str; 13] = [
    ENERGIES,
    ENERGIES_PLOT,
    SNAPSHOT,
    CHECKPOINT,
    SUMMARY,
    TRAJECTORY_GSD,
    TRAJECTORY_XYZ,
    RADIAL_DISTRIBUTION,
    RADIAL_DISTRIBUTION_PLOT,
    DIFFUSION,
    DIFFUSION_PLOT,
    VISCOSITY,
    VISCOSITY_PLOT,
];

/// The name of a numbered snapshot; the first has number 1.
///
/// ```
/// assert_eq!(mesoscope::output::files::snapshot(1), "snapshot-000001.png");
/// ```
#[must_use]
pub fn snapshot(number: u64) -> String {
    format!("snapshot-{number:06}.png")
}

/// The number in the name of a numbered snapshot.
#[must_use]
pub fn snapshot_number(name: &str) -> Option<u64> {
    let number = name.strip_prefix("snapshot-")?.strip_suffix(".png")?.parse().ok()?;
    (snapshot(number) == name).then_some(number)
}

/// Whether a run may have written a file of this name, finished or not.
#[must_use]
pub fn is_of_a_run(name: &str) -> bool {
    let name = name.strip_suffix(".tmp").unwrap_or(name);
    ALL.contains(&name) || snapshot_number(name).is_some()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snapshot_names_go_both_ways_and_sort() {
        for number in [1, 9, 10, 999_999, 1_000_000] {
            assert_eq!(snapshot_number(&snapshot(number)), Some(number));
        }
        assert!(snapshot(9) < snapshot(10));
        for stranger in ["snapshot-1.png", "snapshot-+00001.png", "snapshot-000001.jpg", "snapshot.png"] {
            assert_eq!(snapshot_number(stranger), None, "{stranger}");
        }
    }

    #[test]
    fn only_the_files_of_a_run_are_recognised() {
        for name in ["run.json", "checkpoint.bin.tmp", "snapshot-000017.png", "snapshot-000017.png.tmp"] {
            assert!(is_of_a_run(name), "{name}");
        }
        for name in ["scene.json", "notes.txt", "run.json.bak", "movie.mp4", ".tmp"] {
            assert!(!is_of_a_run(name), "{name}");
        }
    }
}
