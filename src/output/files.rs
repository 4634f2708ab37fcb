//! The names of the files in a run directory.
//!
//! Numbered snapshots count from 1 without gaps, so that ffmpeg takes them as they are:
//!
//! ```text
//! ffmpeg -framerate 25 -i snapshot-%06d.png -pix_fmt yuv420p movie.mp4
//! ```

use std::ffi::{OsStr, OsString};

/// The lock of the directory, there as long as a process writes into it.
pub const LOCK: &str = "mesoscope.lock";
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
/// Sizes of chains.
pub const CHAIN_SIZES: &str = "chain_sizes.csv";
/// The plot of sizes of chains.
pub const CHAIN_SIZES_PLOT: &str = "chain_sizes.png";
/// The autocorrelation of transverse momentum waves.
pub const VISCOSITY: &str = "viscosity.csv";
/// The plot of the autocorrelation of transverse momentum waves.
pub const VISCOSITY_PLOT: &str = "viscosity.png";
/// The normalised velocity autocorrelation.
pub const VELOCITY_AUTOCORRELATION: &str = "velocity_autocorrelation.csv";
/// The plot of the normalised velocity autocorrelation.
pub const VELOCITY_AUTOCORRELATION_PLOT: &str = "velocity_autocorrelation.png";
/// The normalised force autocorrelation.
pub const FORCE_AUTOCORRELATION: &str = "force_autocorrelation.csv";
/// The plot of the normalised force autocorrelation.
pub const FORCE_AUTOCORRELATION_PLOT: &str = "force_autocorrelation.png";
/// The histogram of velocities.
pub const VELOCITY_HISTOGRAM: &str = "velocity_histogram.csv";
/// The plot of the histogram of velocities.
pub const VELOCITY_HISTOGRAM_PLOT: &str = "velocity_histogram.png";
/// The histogram of speeds.
pub const SPEED_HISTOGRAM: &str = "speed_histogram.csv";
/// The plot of the histogram of speeds.
pub const SPEED_HISTOGRAM_PLOT: &str = "speed_histogram.png";
/// The histogram of accelerations.
pub const ACCELERATION_HISTOGRAM: &str = "acceleration_histogram.csv";
/// The plot of the histogram of accelerations.
pub const ACCELERATION_HISTOGRAM_PLOT: &str = "acceleration_histogram.png";

/// The circulations of material loops.
pub const CIRCULATION: &str = "circulation.csv";
/// The plot of the circulations of material loops.
pub const CIRCULATION_PLOT: &str = "circulation.png";

/// The table of pulses of harmonic chains at a few times.
pub const CHAIN_PROFILES: &str = "chain_profiles.csv";
/// The plot of pulses of harmonic chains at a few times.
pub const CHAIN_PROFILES_PLOT: &str = "chain_profiles.png";
/// The table of peak, variance and energy of the pulses of harmonic chains.
pub const CHAIN_PULSE: &str = "chain_pulse.csv";
/// The plot of peak, variance and energy of the pulses of harmonic chains.
pub const CHAIN_PULSE_PLOT: &str = "chain_pulse.png";
/// The table of the momentum autocorrelation of the clusters of harmonic chains.
pub const CHAIN_CORRELATION: &str = "chain_correlation.csv";
/// The plot of the momentum autocorrelation of the clusters of harmonic chains.
pub const CHAIN_CORRELATION_PLOT: &str = "chain_correlation.png";
/// The table of the running integral of the exact memory of clusters of a harmonic chain.
pub const CHAIN_MEMORY: &str = "chain_memory.csv";
/// The plot of the running integral of the exact memory of clusters of a harmonic chain.
pub const CHAIN_MEMORY_PLOT: &str = "chain_memory.png";
/// The table of the variances of the clusters of harmonic chains in equilibrium.
pub const CHAIN_EQUILIBRIUM: &str = "chain_equilibrium.csv";
/// The plot of the variances of the clusters of harmonic chains in equilibrium.
pub const CHAIN_EQUILIBRIUM_PLOT: &str = "chain_equilibrium.png";

/// The table of the numbers of neighbours of Voronoi cells.
pub const NEIGHBOURS: &str = "neighbours.csv";
/// The plot of the numbers of neighbours of Voronoi cells.
pub const NEIGHBOURS_PLOT: &str = "neighbours.png";
/// The table of the decay of a shear wave.
pub const SHEAR_WAVE: &str = "shear_wave.csv";
/// The plot of the decay of a shear wave.
pub const SHEAR_WAVE_PLOT: &str = "shear_wave.png";

/// What the names of pictures and arrays of fields on the mesh begin with.
pub const FIELDS: [&str; 4] = ["depth", "potential_vorticity", "vorticity", "speed"];

/// Every fixed name that a run may write.
pub const ALL: [&str; 49] = [
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
    CHAIN_SIZES,
    CHAIN_SIZES_PLOT,
    VISCOSITY,
    VISCOSITY_PLOT,
    VELOCITY_AUTOCORRELATION,
    VELOCITY_AUTOCORRELATION_PLOT,
    FORCE_AUTOCORRELATION,
    FORCE_AUTOCORRELATION_PLOT,
    VELOCITY_HISTOGRAM,
    VELOCITY_HISTOGRAM_PLOT,
    SPEED_HISTOGRAM,
    SPEED_HISTOGRAM_PLOT,
    ACCELERATION_HISTOGRAM,
    ACCELERATION_HISTOGRAM_PLOT,
    CIRCULATION,
    CIRCULATION_PLOT,
    CHAIN_PROFILES,
    CHAIN_PROFILES_PLOT,
    CHAIN_PULSE,
    CHAIN_PULSE_PLOT,
    CHAIN_CORRELATION,
    CHAIN_CORRELATION_PLOT,
    CHAIN_MEMORY,
    CHAIN_MEMORY_PLOT,
    CHAIN_EQUILIBRIUM,
    CHAIN_EQUILIBRIUM_PLOT,
    NEIGHBOURS,
    NEIGHBOURS_PLOT,
    SHEAR_WAVE,
    SHEAR_WAVE_PLOT,
    "depth.png",
    "depth.npy",
    "potential_vorticity.png",
    "potential_vorticity.npy",
    "vorticity.png",
    "vorticity.npy",
    "speed.png",
    "speed.npy",
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

/// The name of a picture (`png`) or an array (`npy`) of a field, numbered from 1 or of the end.
///
/// ```
/// use mesoscope::output::files;
/// assert_eq!(files::field("depth", Some(1), "npy"), "depth-000001.npy");
/// assert_eq!(files::field("depth", None, "png"), "depth.png");
/// ```
#[must_use]
pub fn field(stem: &str, number: Option<u64>, extension: &str) -> String {
    match number {
        Some(number) => format!("{stem}-{number:06}.{extension}"),
        None => format!("{stem}.{extension}"),
    }
}

/// The number in the name of a numbered snapshot or field.
///
/// ```
/// use mesoscope::output::files;
///
/// assert_eq!(files::snapshot_number(&files::snapshot(12)), Some(12));
/// assert_eq!(files::snapshot_number("snapshot-12.png"), None);
/// ```
#[must_use]
pub fn snapshot_number(name: &str) -> Option<u64> {
    let (stem, rest) = name.split_once('-')?;
    let (digits, extension) = rest.split_once('.')?;
    let number = digits.parse().ok()?;
    let known = match stem {
        "snapshot" => extension == "png",
        stem => FIELDS.contains(&stem) && ["png", "npy"].contains(&extension),
    };
    (known && field(stem, Some(number), extension) == name).then_some(number)
}

/// Whether a run may have written a file of this name.
///
/// ```
/// use mesoscope::output::files::is_of_a_run;
/// assert!(is_of_a_run("energies.csv") && is_of_a_run("snapshot-000017.png"));
/// assert!(!is_of_a_run("notes.txt"));
/// ```
#[must_use]
pub fn is_of_a_run(name: &str) -> bool {
    ALL.contains(&name) || snapshot_number(name).is_some()
}

/// The name of a file that a process has not finished writing, before it becomes `name`.
///
/// ```
/// use mesoscope::output::files;
///
/// let name = files::temporary("run.json".as_ref(), 4711, 3);
/// assert_eq!(name, "run.json.mesoscope-4711-3.tmp");
/// assert_eq!(files::of_temporary("run.json.mesoscope-4711-3.tmp"), Some("run.json"));
/// assert_eq!(files::of_temporary("run.json.tmp"), None);
/// ```
#[must_use]
pub fn temporary(name: &OsStr, process: u32, number: u64) -> OsString {
    let mut temporary = name.to_owned();
    temporary.push(format!("{TEMPORARY}{process}-{number}.tmp"));
    temporary
}

/// What a file was to become that was never finished.
#[must_use]
pub fn of_temporary(name: &str) -> Option<&str> {
    let (name, rest) = name.rsplit_once(TEMPORARY)?;
    let (process, number) = rest.strip_suffix(".tmp")?.split_once('-')?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (!name.is_empty() && is_number(process) && is_number(number)).then_some(name)
}

/// What stands between the name of a file and what is temporary about it.
const TEMPORARY: &str = ".mesoscope-";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snapshot_names_go_both_ways_and_sort() {
        for number in [1, 9, 10, 999_999, 1_000_000] {
            assert_eq!(snapshot_number(&snapshot(number)), Some(number));
        }
        assert!(snapshot(9) < snapshot(10));
        for name in ["depth-000007.npy", "potential_vorticity-000007.png"] {
            assert_eq!(snapshot_number(name), Some(7), "{name}");
        }
        for stranger in [
            "depth-000007.csv",
            "height-000007.png",
            "snapshot-000007.npy",
            "snapshot-1.png",
            "snapshot-+00001.png",
            "snapshot-000001.jpg",
            "snapshot.png",
        ] {
            assert_eq!(snapshot_number(stranger), None, "{stranger}");
        }
    }

    #[test]
    fn only_the_files_of_a_run_are_recognised() {
        for name in ["run.json", "checkpoint.bin", "snapshot-000017.png"] {
            assert!(is_of_a_run(name), "{name}");
        }
        for name in ["scene.json", "notes.txt", "run.json.bak", "run.json.tmp", "movie.mp4", ".tmp", LOCK] {
            assert!(!is_of_a_run(name), "{name}");
        }
        for name in ["a.mesoscope-1-2.tmp", "sweep.csv.mesoscope-18446744073709551616-0.tmp"] {
            assert!(of_temporary(name).is_some(), "{name}");
        }
        for name in
            ["a.mesoscope--2.tmp", "a.mesoscope-1.tmp", ".mesoscope-1-2.tmp", "a.mesoscope-1-2.tmp.bak", "a.tmp"]
        {
            assert!(of_temporary(name).is_none(), "{name}");
        }
    }
}
