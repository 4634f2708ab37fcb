//! The directory of a run.

use super::temporary::Temporary;
use super::{DirectoryLock, Extent, OutputError, files, write_atomically};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A directory that a run writes into, and no other process with it.
///
/// ```
/// use mesoscope::output::{OutputError, RunDirectory, files};
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("results");
/// let results = RunDirectory::create(&path)?;
/// results.write(files::ENERGIES, |writer| writer.write_all(b"step\n0\n"))?;
/// // As long as the run writes, the directory is its own.
/// assert!(matches!(RunDirectory::replace(&path), Err(OutputError::InUse { .. })));
/// drop(results);
/// // Another run replaces it only when that is asked for.
/// assert!(matches!(RunDirectory::create(&path), Err(OutputError::ResultExists { .. })));
/// let results = RunDirectory::replace(&path)?;
/// assert!(!results.file(files::ENERGIES).exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct RunDirectory {
    path: PathBuf,
    /// Where this process writes, as long as it does.
    lock: Option<Arc<DirectoryLock>>,
}

impl RunDirectory {
    /// Creates the directory, with its parents, takes its lock and makes sure that it can be written to.
    ///
    /// Files that no run writes (notes, the scene) are left alone. With `force`, the files of an earlier run are
    /// removed, so that what is there afterwards belongs to one run.
    ///
    /// # Errors
    /// [`OutputError::InUse`] when another process writes there; [`OutputError::ResultExists`] when there are files of an earlier
    /// run; [`OutputError::DirectoryOfThatName`] when a directory has the name of a result;
    /// [`OutputError::NoDirectory`] when `path` is a file; [`OutputError::Io`] when the directory cannot be created, listed,
    /// cleared or written to.
    pub fn create(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        let directory = Self::make(path)?;
        directory.clear(false)?;
        Ok(directory)
    }

    /// The same in place of an earlier run, whose files are removed.
    ///
    /// # Errors
    /// As [`Self::create`], but for files of an earlier run.
    pub fn replace(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        let directory = Self::make(path)?;
        directory.clear(true)?;
        Ok(directory)
    }

    /// Creates the directory and takes its lock; what is in it stays.
    pub(crate) fn make(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        let path = path.into();
        if path.exists() && !path.is_dir() {
            return Err(OutputError::NoDirectory { path });
        }
        fs::create_dir_all(&path).map_err(OutputError::io("create the directory", &path))?;
        Self::claim(path)
    }

    /// Removes the files of an earlier run, if that is allowed, and makes sure that the directory can be written to.
    pub(crate) fn clear(&self, force: bool) -> Result<(), OutputError> {
        let in_the_way = self.in_the_way(force)?;
        // Better to learn now that nothing can be written than after an hour of simulation.
        let probe = Temporary::beside(&self.file(files::SUMMARY));
        probe.map(drop).map_err(OutputError::io("write to the directory", &self.path))?;
        for stage in self.stages()? {
            stage.remove(files::is_of_a_run)?;
            // What else is in it stays.
            let _ = fs::remove_dir(&stage.path);
        }
        for name in in_the_way {
            let path = self.file(&name);
            fs::remove_file(&path).map_err(OutputError::io("replace", &path))?;
        }
        Ok(())
    }

    /// The directories of stages of an earlier run.
    fn stages(&self) -> Result<Vec<Self>, OutputError> {
        let paths = self.names(files::is_stage)?.into_iter().map(|name| self.file(&name));
        Ok(paths.filter(|path| path.is_dir()).map(|path| Self { path, lock: None }).collect())
    }

    /// Makes the directory of a stage, if it is not there; the lock is that of the run.
    pub(crate) fn make_stage(&self, number: usize) -> Result<Self, OutputError> {
        let path = self.file(&files::stage(number));
        if path.exists() && !path.is_dir() {
            return Err(OutputError::NoDirectory { path });
        }
        fs::create_dir_all(&path).map_err(OutputError::io("create the directory", &path))?;
        Ok(Self { path, lock: None })
    }

    /// The files of an earlier run, if they may be removed and can be.
    pub(crate) fn in_the_way(&self, force: bool) -> Result<Vec<String>, OutputError> {
        let in_the_way = self.names(files::is_of_a_run)?;
        // Nothing is removed where not everything can be.
        let mut paths = in_the_way.iter().map(|name| self.file(name));
        if let Some(path) = paths.find(|path| path.is_dir()) {
            return Err(OutputError::DirectoryOfThatName { path });
        }
        if let (false, Some(name)) = (force, in_the_way.first()) {
            return Err(OutputError::ResultExists { path: self.file(name) });
        }
        Ok(in_the_way)
    }

    /// Takes the lock of the directory of an earlier run, to resume it or to draw its plots, and removes what a killed
    /// process has not finished writing there.
    ///
    /// # Errors
    /// [`OutputError::InUse`] when another process writes there; [`OutputError::Io`] when it does not exist or is no
    /// directory.
    pub fn claim(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        let mut directory = Self::open(path)?;
        directory.lock = Some(Arc::new(DirectoryLock::claim(&directory.path)?));
        directory.remove(|name| files::of_temporary(name).is_some())?;
        Ok(directory)
    }

    /// Opens a directory whose lock this process has already, or only to look into it.
    ///
    /// # Errors
    /// [`OutputError::Io`] when it does not exist or is no directory.
    pub fn open(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        let path = path.into();
        fs::read_dir(&path).map_err(OutputError::io("open the directory", &path))?;
        Ok(Self { path, lock: None })
    }

    /// Where the directory is.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Where a file of this name is, or would be.
    #[must_use]
    pub fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes a file of this name, which appears complete or not at all; see [`write_atomically`].
    ///
    /// # Errors
    /// [`OutputError::Io`] when the file cannot be written.
    pub fn write(
        &self,
        name: &str,
        content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<PathBuf, OutputError> {
        let path = self.file(name);
        write_atomically(&path, content)?;
        Ok(path)
    }

    /// Whether there is a file that a run may have written.
    pub(crate) fn has_results(&self) -> Result<bool, OutputError> {
        Ok(!self.names(files::is_of_a_run)?.is_empty())
    }

    /// The names of the files of a run that are there, but for numbered ones, in the order in which they are listed.
    pub(crate) fn written(&self) -> Vec<String> {
        files::all().filter(|name| self.file(name).exists()).map(str::to_owned).collect()
    }

    /// The tables that are there, as they are.
    pub(crate) fn tables(&self) -> Result<BTreeMap<String, Extent>, OutputError> {
        let is_table = |name: &String| Path::new(name).extension().is_some_and(|extension| extension == "csv");
        let tables = self.written().into_iter().filter(is_table);
        tables.map(|name| Ok((name.clone(), Extent::of(&self.file(&name))?))).collect()
    }

    /// Removes numbered snapshots above `last`: those a resumed run will take again.
    ///
    /// # Errors
    /// [`OutputError::Io`] when the directory cannot be listed or a file cannot be removed.
    pub fn remove_snapshots_after(&self, last: u64) -> Result<(), OutputError> {
        self.remove(|name| files::snapshot_number(name).is_some_and(|number| number > last))
    }

    /// Removes the pictures of the end of a run, those without a number.
    pub(crate) fn remove_last_pictures(&self) -> Result<(), OutputError> {
        let is_picture = |name: &str| ["png", "svg", "pdf"].iter().any(|extension| name.ends_with(extension));
        self.remove(|name| files::all().any(|known| known == name) && is_picture(name))
    }

    /// The number of numbered snapshots, and of numbered frames of fields.
    pub(crate) fn snapshots(&self) -> Result<u64, OutputError> {
        let numbers: BTreeSet<_> =
            self.names(|_| true)?.iter().filter_map(|name| files::snapshot_number(name)).collect();
        Ok(numbers.len() as u64)
    }

    /// Removes a file, if it is there.
    pub(crate) fn remove_file(&self, name: &str) -> Result<(), OutputError> {
        self.remove(|known| known == name)
    }

    /// Removes all files of a kind.
    fn remove(&self, kind: impl Fn(&str) -> bool) -> Result<(), OutputError> {
        for path in self.names(kind)?.iter().map(|name| self.file(name)) {
            fs::remove_file(&path).map_err(OutputError::io("remove", &path))?;
        }
        Ok(())
    }

    /// The names of all files of a kind, sorted.
    pub(super) fn names(&self, kind: impl Fn(&str) -> bool) -> Result<Vec<String>, OutputError> {
        let entries = fs::read_dir(&self.path).and_then(Iterator::collect::<io::Result<Vec<_>>>);
        let entries = entries.map_err(OutputError::io("list the directory", &self.path))?;
        let names = entries.into_iter().filter_map(|entry| entry.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| kind(name)).collect();
        names.sort();
        Ok(names)
    }
}
