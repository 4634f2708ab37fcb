//! The names of the files in a run directory.
//!
//! Numbered snapshots count from 1 without gaps, so that ffmpeg takes them as they are:
//!
//! ```text
//! ffmpeg -framerate 25 -i snapshot-%06d.png -pix_fmt yuv420p movie.mp4
//! ```

use std::path::Path;

pub use super::trajectory::trajectory;
use crate::scene::{AnalysisId, FieldFormat, FieldQuantity, Fields, TrajectoryFormat};
use std::ffi::{OsStr, OsString};

/// The lock of the directory, there as long as a process writes into it.
pub const LOCK: &str = "mesoscope.lock";
/// The table of energies.
pub const ENERGIES: &str = "energies.csv";
/// The plot of energies.
pub const ENERGIES_PLOT: &str = "energies.png";
/// The plot of energies as vector graphics.
const ENERGIES_VECTOR: [&str; 2] = ["energies.svg", "energies.pdf"];
/// The picture of the last state.
pub const SNAPSHOT: &str = "snapshot.png";
/// The state to resume from.
pub use crate::state_file::checkpoint::FILE as CHECKPOINT;
/// The summary of the run.
pub const SUMMARY: &str = "run.json";
/// The trajectory in HOOMD's GSD format.
pub const TRAJECTORY_GSD: &str = "trajectory.gsd";
/// The trajectory in Extended XYZ.
pub const TRAJECTORY_XYZ: &str = "trajectory.xyz";
/// What the names of pictures and arrays of fields on the mesh begin with.
pub(crate) const FIELDS: [&str; 6] = ["depth", "potential_vorticity", "vorticity", "speed", "velocity_x", "velocity_y"];

/// What the names of files of all fields begin with.
const ALL_FIELDS: &str = "fields";

/// Pictures and arrays of fields at the end of a run.
const FIELD_FILES: [[&str; 2]; 6] = [
    ["depth.png", "depth.npy"],
    ["potential_vorticity.png", "potential_vorticity.npy"],
    ["vorticity.png", "vorticity.npy"],
    ["speed.png", "speed.npy"],
    ["velocity_x.png", "velocity_x.npy"],
    ["velocity_y.png", "velocity_y.npy"],
];

/// Every fixed name that a run may write, in the order in which they are listed.
///
/// ```
/// use mesoscope::output::files;
/// use mesoscope::scene::AnalysisId;
///
/// assert!(files::all().any(|name| name == AnalysisId::Diffusion.table()));
/// ```
pub fn all() -> impl Iterator<Item = &'static str> {
    let fixed = [ENERGIES, ENERGIES_PLOT, SNAPSHOT, CHECKPOINT, SUMMARY].into_iter();
    let trajectories = TrajectoryFormat::ALL.into_iter().map(trajectory);
    fixed
        .chain(ENERGIES_VECTOR)
        .chain(trajectories)
        .chain(of_analyses())
        .chain(FIELD_FILES.into_iter().flatten())
        .chain(["fields.nc"])
}

/// The tables and charts of all analyses.
pub(crate) fn of_analyses() -> impl Iterator<Item = &'static str> {
    let tables = AnalysisId::ALL.into_iter().flat_map(AnalysisId::tables);
    tables.flat_map(|names| [names.file, names.plot].into_iter().chain(names.vector))
}

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

/// The names of the files of arrays of fields, numbered from 1 or of the end, each with the fields in it.
///
/// ```
/// use mesoscope::output::files;
/// use mesoscope::scene::{FieldFormat, FieldQuantity, Fields};
///
/// let fields = Fields { quantities: vec![FieldQuantity::Depth, FieldQuantity::Speed], ..Fields::default() };
/// assert_eq!(files::field_arrays(&fields, None)[1], ("speed.npy".to_owned(), vec![FieldQuantity::Speed]));
/// let fields = Fields { format: FieldFormat::Netcdf, ..fields };
/// assert_eq!(files::field_arrays(&fields, Some(7)), [("fields-000007.nc".to_owned(), fields.quantities.clone())]);
/// ```
#[must_use]
pub fn field_arrays(fields: &Fields, number: Option<u64>) -> Vec<(String, Vec<FieldQuantity>)> {
    let quantities = &fields.quantities;
    match fields.format {
        FieldFormat::Npy => quantities.iter().map(|one| (field(one.stem(), number, "npy"), vec![*one])).collect(),
        FieldFormat::Netcdf if quantities.is_empty() => Vec::new(),
        FieldFormat::Netcdf => vec![(field(ALL_FIELDS, number, "nc"), quantities.clone())],
    }
}

/// Whether a file is an array: one of those that a picture shows, which only the run writes.
///
/// ```
/// use mesoscope::output::files;
///
/// assert!(files::is_array("depth.npy") && files::is_array("depth-000007.npy") && !files::is_array("depth.png"));
/// ```
#[must_use]
pub fn is_array(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "npy" || extension == "nc")
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
        ALL_FIELDS => extension == "nc",
        stem => FIELDS.contains(&stem) && ["png", "npy"].contains(&extension),
    };
    (known && field(stem, Some(number), extension) == name).then_some(number)
}

/// The name of the directory with what analyses of a stage have left, in that of a run; the first stage has number 1.
///
/// ```
/// use mesoscope::output::files;
///
/// assert_eq!(files::stage(2), "stage-2");
/// assert!(files::is_stage("stage-2") && !files::is_stage("stage-02") && !files::is_stage("stages"));
/// ```
#[must_use]
pub fn stage(number: usize) -> String {
    format!("stage-{number}")
}

/// Whether a directory of this name is that of a stage.
#[must_use]
pub fn is_stage(name: &str) -> bool {
    let number = name.strip_prefix("stage-").and_then(|digits| digits.parse().ok());
    number.is_some_and(|number| number > 0 && stage(number) == name)
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
    all().any(|known| known == name) || snapshot_number(name).is_some()
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
        for name in ["depth-000007.npy", "potential_vorticity-000007.png", "fields-000007.nc"] {
            assert_eq!(snapshot_number(name), Some(7), "{name}");
        }
        for stranger in [
            "depth-000007.csv",
            "depth-000007.nc",
            "fields-000007.npy",
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
