//! The directory of a sweep: made, cleared, opened again.

use super::expansion::Sweep;
use super::files;
use super::summary::SweepSummary;
use crate::output::{OutputError, RunDirectory};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

/// Creates the directory of a sweep, takes its lock and makes sure that it can be written to. With `force`, the runs and
/// files of an earlier sweep there, or of a single run, are removed; anything else is left alone.
///
/// # Errors
/// [`OutputError::ResultExists`] when there are such files and `force` is not given; [`OutputError::Io`].
pub(super) fn create(path: &Path, sweep: &Sweep, force: bool) -> Result<RunDirectory, OutputError> {
    let in_the_way = in_the_way(path, sweep)?;
    if let (false, Some(first)) = (force, in_the_way.first()) {
        return Err(OutputError::ResultExists { path: first.clone() });
    }
    let earlier = SweepSummary::load(path).map(|summary| summary.variants).unwrap_or_default();
    let directory = RunDirectory::make(path)?;
    let names = earlier.iter().map(|variant| &variant.name).chain(sweep.variants().iter().map(|variant| &variant.name));
    let of_variants = names.filter(|name| is_plain(name)).map(|name| path.join(name));
    let of_variants: BTreeSet<PathBuf> = of_variants.filter(|path| path.is_dir()).collect();
    // Nothing is removed where a run is under way.
    let of_variants = of_variants.into_iter().map(RunDirectory::claim).collect::<Result<Vec<_>, _>>()?;
    directory.clear(force)?;
    for variant in of_variants {
        variant.clear(true)?;
        let path = variant.path().to_path_buf();
        // With its lock goes the last file of ours; what else is in there belongs to the user, and so does the directory.
        drop(variant);
        let _ = fs::remove_dir(path);
    }
    for file in in_the_way.iter().filter(|path| path.is_file()) {
        fs::remove_file(file).map_err(OutputError::io("replace", file))?;
    }
    Ok(directory)
}

/// Files of an earlier sweep, and what has the name of a variant's directory; sorted.
fn in_the_way(path: &Path, sweep: &Sweep) -> Result<Vec<PathBuf>, OutputError> {
    let entries = match fs::read_dir(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        entries => entries.map_err(OutputError::io("list the directory", path))?,
    };
    let mut found = Vec::new();
    for entry in entries {
        let entry = entry.map_err(OutputError::io("list the directory", path))?;
        let Ok(name) = entry.file_name().into_string() else { continue };
        if files::is_of_a_sweep(&name) || sweep.variants().iter().any(|variant| variant.name == name) {
            found.push(entry.path());
        }
    }
    found.sort();
    Ok(found)
}

/// Whether a name leads into the directory of the sweep and nowhere else.
pub(crate) fn is_plain(name: &str) -> bool {
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
