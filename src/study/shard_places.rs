//! The directories of shards in that of a study: each belongs to one process, which notes there how far its shard is.

use super::shard::Shard;
use crate::output::{OutputError, RunDirectory};
use crate::run::Interrupt;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// The directory that holds all of them.
const SHARDS: &str = "shards";

/// What a shard says of itself.
pub(crate) const RECORD: &str = "shard.json";

/// How long to wait for the directory of a study, which every shard has for an instant when it begins: many begin at once.
const PATIENCE: Duration = Duration::from_mins(1);
const PAUSE: Duration = Duration::from_millis(20);

/// The directory of a study for this process alone, made where there is none. Shards begin, and end of each other's way, while
/// they have it; who gathers what they left keeps it.
///
/// # Errors
/// [`OutputError::InUse`] when another process keeps it, or an interrupt was asked for meanwhile; those of [`RunDirectory::make`].
pub(crate) fn claim_study(path: &Path, interrupt: &Interrupt) -> Result<RunDirectory, OutputError> {
    let start = Instant::now();
    loop {
        match RunDirectory::make(path) {
            Err(OutputError::InUse { .. }) if start.elapsed() < PATIENCE && !interrupt.is_asked() => {
                thread::sleep(PAUSE);
            }
            claimed => return claimed,
        }
    }
}

/// The directory of a shard, as long as it is under way; the directory of the study belongs to this process.
///
/// # Errors
/// [`OutputError::InUse`] when the same shard, or one of another number of shards, is under way; [`OutputError::Io`].
pub(crate) fn claim(study: &Path, shard: Shard) -> Result<RunDirectory, OutputError> {
    // They divide the runs in another way.
    check_idle(study, |other| other.count() != shard.count())?;
    RunDirectory::make(study.join(SHARDS).join(name(shard)))
}

/// What the directory of a shard is called, from that of the study.
pub(crate) fn name_in_study(shard: Shard, file: &str) -> String {
    format!("{SHARDS}/{}/{file}", name(shard))
}

/// Looks whether shards like these are under way; no others begin while the directory of the study belongs to this process.
///
/// # Errors
/// [`OutputError::InUse`] names the first that is; [`OutputError::Io`].
pub(super) fn check_idle(study: &Path, is_asked: impl Fn(Shard) -> bool) -> Result<(), OutputError> {
    for (shard, path) in all(study)? {
        if is_asked(shard) {
            RunDirectory::claim(path)?;
        }
    }
    Ok(())
}

/// Removes what shards have noted.
pub(super) fn clear(study: &Path) -> Result<(), OutputError> {
    for (_, path) in all(study)? {
        let directory = RunDirectory::claim(&path)?;
        match fs::remove_file(directory.file(RECORD)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                return Err(OutputError::io("replace", &directory.file(RECORD))(error));
            }
            _ => {}
        }
        drop(directory);
        // What else is in there belongs to the user, and so does the directory.
        let _ = fs::remove_dir(path);
    }
    let _ = fs::remove_dir(study.join(SHARDS));
    Ok(())
}

/// The shards that have directories, by their names.
fn all(study: &Path) -> Result<Vec<(Shard, PathBuf)>, OutputError> {
    let place = study.join(SHARDS);
    let entries = match fs::read_dir(&place) {
        Err(error) if matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => {
            return Ok(Vec::new());
        }
        entries => entries.map_err(OutputError::io("list the directory", &place))?,
    };
    let mut found = Vec::new();
    for entry in entries {
        let entry = entry.map_err(OutputError::io("list the directory", &place))?;
        let shard = entry.file_name().to_str().and_then(of_name).filter(|_| entry.path().is_dir());
        found.extend(shard.map(|shard| (shard, entry.path())));
    }
    found.sort_by(|one, other| one.1.cmp(&other.1));
    Ok(found)
}

fn name(shard: Shard) -> String {
    format!("{}-of-{}", shard.number(), shard.count())
}

fn of_name(text: &str) -> Option<Shard> {
    let (number, count) = text.split_once("-of-")?;
    let shard = Shard::new(number.parse().ok()?, count.parse().ok()?)?;
    (name(shard) == text).then_some(shard)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_name_stands_for_a_shard() {
        let shard = Shard::new(3, 16);
        assert_eq!(shard.map(name).as_deref(), Some("3-of-16"));
        assert_eq!(of_name("3-of-16"), shard);
        for text in ["3-of-", "03-of-16", "+3-of-16", "0-of-16", "17-of-16", "3-of-16~", "notes"] {
            assert_eq!(of_name(text), None, "{text}");
        }
    }
}
