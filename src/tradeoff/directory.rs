//! The directory of a tradeoff: made, cleared.

use super::error::TradeoffError;
use super::files;
use super::summary::TradeoffSummary;
use crate::output::{OutputError, RunDirectory};
use crate::scene::Scene;
use crate::sweep::is_plain;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// What a new tradeoff would replace: files of an earlier one, and what has the name of a run; sorted.
pub(super) fn in_the_way(path: &Path, runs: &[(String, Scene)]) -> Vec<PathBuf> {
    let entries = fs::read_dir(path).into_iter().flatten().flatten();
    let is_ours = |name: &str| files::is_of_a_tradeoff(name) || runs.iter().any(|(run, _)| run == name);
    let found = entries.filter(|entry| entry.file_name().to_str().is_some_and(is_ours));
    let mut found: Vec<PathBuf> = found.map(|entry| entry.path()).collect();
    found.sort();
    found
}

/// Creates the directory of a tradeoff and takes its lock. The files of an earlier one there are removed, and so are those of runs that have
/// the name of one of the earlier or of the new; what else is in their directories stays.
pub(super) fn create(path: &Path, runs: &[(String, Scene)]) -> Result<RunDirectory, TradeoffError> {
    let before = TradeoffSummary::load(path).ok();
    let directory = RunDirectory::make(path)?;
    let earlier = before.iter().flat_map(|summary| summary.choices.iter().chain(&summary.finer));
    let names = earlier.map(|run| run.name.as_str()).chain(runs.iter().map(|(name, _)| name.as_str()));
    let places: BTreeSet<PathBuf> = names.filter(|name| is_plain(name)).map(|name| directory.file(name)).collect();
    // Nothing is removed where a run is under way.
    let claimed = places.into_iter().filter(|place| place.is_dir()).map(RunDirectory::claim);
    let claimed = claimed.collect::<Result<Vec<_>, _>>()?;
    for run in &claimed {
        run.clear(true)?;
    }
    for file in in_the_way(path, &[]).into_iter().filter(|file| file.is_file()) {
        fs::remove_file(&file).map_err(OutputError::io("replace", &file))?;
    }
    Ok(directory)
}
