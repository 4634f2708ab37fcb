//! The directory of a study: made, cleared.

use super::kind::{KINDS, Kind};
use super::record::Record;
use super::shard_places;
use crate::output::{OutputError, RunDirectory, own_file};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Creates the directory of a study, takes its lock and makes sure that it can be written to. With `force`, the files and
/// runs of earlier studies there, of any kind, or of a single run, are removed; anything else is left alone.
///
/// # Errors
/// Those of [`check`]; [`OutputError::InUse`] when another process writes there.
pub(super) fn create<R: Record>(path: &Path, study: &R, force: bool) -> Result<RunDirectory, OutputError> {
    let in_the_way = check(path, study, force)?;
    let directory = RunDirectory::make(path)?;
    shard_places::check_idle(path, |_| true)?;
    let earlier = KINDS.into_iter().flat_map(|kind| runs_of(kind, path));
    let names = earlier.chain(study.runs().into_iter().map(str::to_owned));
    let of_runs = names.filter(|name| is_plain(name)).map(|name| path.join(name));
    let of_runs: BTreeSet<PathBuf> = of_runs.filter(|path| path.is_dir()).collect();
    // Nothing is removed where a run is under way.
    let of_runs = of_runs.into_iter().map(RunDirectory::claim).collect::<Result<Vec<_>, _>>()?;
    directory.clear(force)?;
    shard_places::clear(path)?;
    for run in of_runs {
        run.clear(true)?;
        let path = run.path().to_path_buf();
        // With its lock goes the last file of ours; what else is in there belongs to the user, and so does the directory.
        drop(run);
        let _ = fs::remove_dir(path);
    }
    for file in &in_the_way {
        fs::remove_file(file).map_err(OutputError::io("replace", file))?;
    }
    Ok(directory)
}

/// Files of earlier studies of any kind; sorted.
///
/// # Errors
/// [`OutputError::ResultExists`] when there are any, or a directory has the name of a run, and `force` is not given;
/// [`OutputError::NoDirectory`] when a file has that name, and [`OutputError::DirectoryOfThatName`] when a directory has the name of
/// a file of the study, even with `force`; [`OutputError::Io`].
pub(super) fn check<R: Record>(path: &Path, study: &R, force: bool) -> Result<Vec<PathBuf>, OutputError> {
    let entries = match fs::read_dir(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(OutputError::io("list the directory", path))?,
    };
    let runs = study.runs();
    let (mut files, mut directories) = (Vec::new(), Vec::new());
    for entry in entries {
        let entry = entry.map_err(OutputError::io("list the directory", path))?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        let path = entry.path();
        match (path.is_dir(), runs.contains(&name.as_str())) {
            (true, true) => directories.push(path),
            // Nobody but the user made it.
            (false, true) => return Err(OutputError::NoDirectory { path }),
            (true, false) if R::KIND.has_file(&name) => return Err(OutputError::DirectoryOfThatName { path }),
            (false, false) if KINDS.iter().any(|kind| kind.has_file(&name)) => files.push(path),
            _ => {}
        }
    }
    files.sort();
    match files.iter().chain(&directories).min() {
        Some(first) if !force => Err(OutputError::ResultExists { path: first.clone() }),
        _ => Ok(files),
    }
}

/// Names of the runs that a summary of this kind lists; none where there is none.
fn runs_of(kind: &Kind, directory: &Path) -> Vec<String> {
    let summary: Value = own_file::json(&directory.join(kind.summary)).unwrap_or_default();
    let lists = kind.runs.iter().filter_map(|key| summary.get(key)?.as_array());
    lists.flatten().filter_map(|run| Some(run.get("name")?.as_str()?.to_owned())).collect()
}

/// Whether a name leads into the directory of the study and nowhere else.
fn is_plain(name: &str) -> bool {
    let mut components = Path::new(name).components();
    matches!((components.next(), components.next()), (Some(Component::Normal(_)), None))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_lead_elsewhere_are_left_alone() {
        assert!(is_plain("friction=4.5"));
        for name in ["", ".", "..", "a/b", "/tmp", "../friction=4.5"] {
            assert!(!is_plain(name), "{name}");
        }
    }
}
