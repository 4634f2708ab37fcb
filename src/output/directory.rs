//! The directory of a run, and files that are complete or absent.

use super::{OutputError, files};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A directory that a run writes into.
///
/// ```
/// use mesoscope::output::{OutputError, RunDirectory, files};
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("results");
/// let results = RunDirectory::create(&path, false)?;
/// results.write(files::ENERGIES, |writer| writer.write_all(b"step\n0\n"))?;
/// // Another run takes its place only when it is told to.
/// assert!(matches!(RunDirectory::create(&path, false), Err(OutputError::InTheWay { .. })));
/// RunDirectory::create(&path, true)?;
/// assert!(!results.file(files::ENERGIES).exists());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct RunDirectory {
    path: PathBuf,
}

impl RunDirectory {
    /// Creates the directory, with its parents, and makes sure that it can be written to.
    ///
    /// Files that no run writes (notes, the scene) are left alone. With `force`, the files of an earlier run are
    /// removed, so that what is there afterwards belongs to one run.
    ///
    /// # Errors
    /// [`OutputError::InTheWay`] when there are files of an earlier run and `force` is not given;
    /// [`OutputError::DirectoryInTheWay`] when a directory has the name of a result; [`OutputError::NoDirectory`] when
    /// `path` is a file; [`OutputError::Io`] when the directory cannot be created, listed, cleared or written to.
    pub fn create(path: impl Into<PathBuf>, force: bool) -> Result<Self, OutputError> {
        let directory = Self { path: path.into() };
        if directory.path.exists() && !directory.path.is_dir() {
            return Err(OutputError::NoDirectory { path: directory.path });
        }
        fs::create_dir_all(&directory.path).map_err(OutputError::io("create the directory", &directory.path))?;
        let in_the_way = directory.run_files()?;
        // Nothing is removed where not everything can be.
        let mut paths = in_the_way.iter().map(|name| directory.file(name));
        if let Some(path) = paths.find(|path| path.is_dir()) {
            return Err(OutputError::DirectoryInTheWay { path });
        }
        if let (false, Some(name)) = (force, in_the_way.first()) {
            return Err(OutputError::InTheWay { path: directory.file(name) });
        }
        directory.probe()?;
        for name in in_the_way {
            let path = directory.file(&name);
            fs::remove_file(&path).map_err(OutputError::io("replace", &path))?;
        }
        Ok(directory)
    }

    /// Opens the directory of an earlier run, to resume it or to draw its plots.
    ///
    /// # Errors
    /// [`OutputError::Io`] when it does not exist or is no directory.
    pub fn open(path: impl Into<PathBuf>) -> Result<Self, OutputError> {
        let path = path.into();
        fs::read_dir(&path).map_err(OutputError::io("open the directory", &path))?;
        Ok(Self { path })
    }

    /// Where the directory is.
    #[must_use]
    pub fn path(&self) -> &Path {
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

    /// Removes numbered snapshots above `last`: those a resumed run will take again.
    ///
    /// # Errors
    /// [`OutputError::Io`] when the directory cannot be listed or a file cannot be removed.
    pub fn remove_snapshots_after(&self, last: u64) -> Result<(), OutputError> {
        for name in self.run_files()? {
            if files::snapshot_number(&name).is_some_and(|number| number > last) {
                let path = self.file(&name);
                fs::remove_file(&path).map_err(OutputError::io("remove", &path))?;
            }
        }
        Ok(())
    }

    /// The names of all files that a run may have written, sorted.
    fn run_files(&self) -> Result<Vec<String>, OutputError> {
        let list = || -> io::Result<Vec<String>> {
            let mut names = Vec::new();
            for entry in fs::read_dir(&self.path)? {
                if let Ok(name) = entry?.file_name().into_string()
                    && files::is_of_a_run(&name)
                {
                    names.push(name);
                }
            }
            names.sort();
            Ok(names)
        };
        list().map_err(OutputError::io("list the directory", &self.path))
    }

    /// Better to learn now that nothing can be written than after an hour of simulation.
    fn probe(&self) -> Result<(), OutputError> {
        let path = self.file("write-test.tmp");
        File::create(&path)
            .and_then(|_| fs::remove_file(&path))
            .map_err(OutputError::io("write to the directory", &self.path))
    }
}

/// Writes a file under a temporary name beside `path` (`.tmp` added), and moves it to `path` once it is on the disk.
/// On an error the temporary file is removed, and what was at `path` before is still there.
///
/// ```
/// use mesoscope::output::write_atomically;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("results.txt");
/// write_atomically(&path, |writer| writer.write_all(b"complete"))?;
/// let broken = write_atomically(&path, |writer| {
///     writer.write_all(b"half of")?;
///     Err(std::io::Error::other("the power is gone"))
/// });
/// assert!(broken.is_err());
/// assert_eq!(std::fs::read_to_string(&path)?, "complete");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError::Io`] when the file cannot be written, or with the error that `content` returns.
pub fn write_atomically(
    path: &Path,
    content: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    let mut temporary = path.as_os_str().to_owned();
    temporary.push(".tmp");
    let temporary = PathBuf::from(temporary);
    let write = || -> io::Result<()> {
        let mut writer = BufWriter::with_capacity(1 << 18, File::create(&temporary)?);
        content(&mut writer)?;
        let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
        // A name must never point at data that a power failure can still take away.
        file.sync_all()?;
        drop(file);
        fs::rename(&temporary, path)
    };
    write().map_err(|source| {
        // Where the temporary file could not be created there is nothing to remove.
        let _ = fs::remove_file(&temporary);
        OutputError::Io { attempted: "write", path: path.to_path_buf(), source }
    })
}
