//! The directory of a study: made, cleared.

use super::record::{self, Record};
use crate::output::{OutputError, RunDirectory};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Creates the directory of a study, takes its lock and makes sure that it can be written to. With `force`, the files and
/// runs of an earlier study there, or of a single run, are removed; anything else is left alone.
///
/// # Errors
/// [`OutputError::ResultExists`] when there are such files and `force` is not given; [`OutputError::Io`].
pub(super) fn create<R: Record>(path: &Path, study: &R, force: bool) -> Result<RunDirectory, OutputError> {
    let in_the_way = check(path, study, force)?;
    let earlier: Option<R> = record::load(path).ok();
    let directory = RunDirectory::make(path)?;
    let names = earlier.iter().chain([study]).flat_map(Record::runs);
    let of_runs = names.filter(|name| is_plain(name)).map(|name| path.join(name));
    let of_runs: BTreeSet<PathBuf> = of_runs.filter(|path| path.is_dir()).collect();
    // Nothing is removed where a run is under way.
    let of_runs = of_runs.into_iter().map(RunDirectory::claim).collect::<Result<Vec<_>, _>>()?;
    directory.clear(force)?;
    for run in of_runs {
        run.clear(true)?;
        let path = run.path().to_path_buf();
        // With its lock goes the last file of ours; what else is in there belongs to the user, and so does the directory.
        drop(run);
        let _ = fs::remove_dir(path);
    }
    for file in in_the_way.iter().filter(|path| path.is_file()) {
        fs::remove_file(file).map_err(OutputError::io("replace", file))?;
    }
    Ok(directory)
}

/// Files of an earlier study, and what has the name of a run's directory; sorted.
///
/// # Errors
/// [`OutputError::ResultExists`] when there are any and `force` is not given; [`OutputError::Io`].
pub(super) fn check<R: Record>(path: &Path, study: &R, force: bool) -> Result<Vec<PathBuf>, OutputError> {
    let entries = match fs::read_dir(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(OutputError::io("list the directory", path))?,
    };
    let runs = study.runs();
    let mut found = Vec::new();
    for entry in entries {
        let entry = entry.map_err(OutputError::io("list the directory", path))?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        if (R::KIND.has_file)(&name) || runs.contains(&name.as_str()) {
            found.push(entry.path());
        }
    }
    found.sort();
    match found.first() {
        Some(first) if !force => Err(OutputError::ResultExists { path: first.clone() }),
        _ => Ok(found),
    }
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
