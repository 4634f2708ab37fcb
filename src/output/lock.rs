//! The lock of a directory: one process at a time writes there.

use super::own_file::identity;
use super::{OutputError, files};
use crate::printable;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// The right to write into a directory, held until it is dropped.
///
/// The operating system keeps the lock, on the file [`files::LOCK`], and takes it away from a process that ends in
/// whatever way: what a killed run leaves behind never blocks another one. The file holds the number of the process and
/// is removed with the lock. Where a file system knows no locks, nothing is kept out.
///
/// ```
/// use mesoscope::output::{DirectoryLock, OutputError};
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path();
/// let lock = DirectoryLock::claim(path)?;
/// let Err(OutputError::InUse { holder, .. }) = DirectoryLock::claim(path) else { panic!("claimed twice") };
/// assert!(holder.contains(&std::process::id().to_string()) || cfg!(not(unix)));
/// drop(lock);
/// DirectoryLock::claim(path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct DirectoryLock {
    path: PathBuf,
    file: File,
}

/// What stands in the file before the number of the process.
const BEFORE: &str = "locked by mesoscope, process ";

impl DirectoryLock {
    /// Takes the lock of a directory that exists.
    ///
    /// # Errors
    /// [`OutputError::InUse`] when another process, or another part of this one, holds it; [`OutputError::Io`] when no
    /// file can be made in the directory, or the file of this name there is none of mesoscope.
    pub fn claim(directory: &Path) -> Result<Self, OutputError> {
        let path = directory.join(files::LOCK);
        let refused = |source| OutputError::Io { attempted: "write to the directory", path: directory.into(), source };
        loop {
            let mut file = open(&path).map_err(refused)?;
            match file.try_lock() {
                // A file system without locks, as some network file systems are, is no reason to refuse a run.
                Ok(()) | Err(TryLockError::Error(_)) => {}
                Err(TryLockError::WouldBlock) => {
                    // Where locks keep readers out too, nothing says which.
                    let process = read(&mut file).ok().and_then(|text| process_in(&text));
                    let holder = process.map_or("another process".to_owned(), |process| format!("process {process}"));
                    return Err(OutputError::InUse { directory: directory.into(), holder });
                }
            }
            // Who held the lock may have removed the file after it was opened here: then it protects nothing.
            if !is_at(&file, &path) {
                continue;
            }
            let text = read(&mut file).map_err(refused)?;
            // A process killed while it wrote its number leaves a part.
            if process_in(&text).is_none() && !BEFORE.as_bytes().starts_with(&text) {
                let source = io::Error::new(io::ErrorKind::AlreadyExists, "it is not the lock of a run; move it away");
                return Err(OutputError::Io { attempted: "lock", path, source });
            }
            // The lock goes with its file if its number cannot be written.
            let lock = Self { path: path.clone(), file };
            let mut file = &lock.file;
            let number = format!("{BEFORE}{}\n", std::process::id());
            let signed = file.set_len(0).and_then(|()| file.rewind()).and_then(|()| file.write_all(number.as_bytes()));
            signed.map_err(refused)?;
            return Ok(lock);
        }
    }
}

impl Drop for DirectoryLock {
    fn drop(&mut self) {
        // While the lock is held nobody else removes the file, and who opens it until then looks whether it is in place.
        // A file that stays does no harm.
        if cfg!(unix) && is_at(&self.file, &self.path) {
            let _ = fs::remove_file(&self.path);
        } else {
            let _ = self.file.set_len(0);
        }
    }
}

/// Opens the file, or makes it; a link is not followed.
fn open(path: &Path) -> io::Result<File> {
    if path.symlink_metadata().is_ok_and(|found| !found.is_file()) {
        let text = format!("`{}` is not the lock of a run; move it away", printable::path(path));
        return Err(io::Error::new(io::ErrorKind::AlreadyExists, text));
    }
    File::options().read(true).write(true).create(true).truncate(false).open(path)
}

fn read(file: &mut File) -> io::Result<Vec<u8>> {
    let mut text = Vec::new();
    file.rewind()?;
    file.take(BEFORE.len() as u64 + 32).read_to_end(&mut text)?;
    Ok(text)
}

/// The process that holds the lock, or held it when it ended.
fn process_in(text: &[u8]) -> Option<u32> {
    std::str::from_utf8(text).ok()?.strip_prefix(BEFORE)?.trim_end().parse().ok()
}

/// True if a file that is open still has this name; elsewhere than on Unix it is never removed.
fn is_at(file: &File, path: &Path) -> bool {
    let [open, there] = [file.metadata(), fs::symlink_metadata(path)].map(|found| found.ok().map(|it| identity(&it)));
    open.is_some() && open == there
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn what_a_killed_process_leaves_does_not_block() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join(files::LOCK);
        for left in [format!("{BEFORE}1\n"), BEFORE[..7].to_owned(), String::new(), format!("{BEFORE}4294967295")] {
            fs::write(&path, &left).unwrap();
            let lock = DirectoryLock::claim(directory.path()).unwrap();
            let found = fs::read_to_string(&path).unwrap();
            assert!(cfg!(not(unix)) || found == format!("{BEFORE}{}\n", std::process::id()), "{found}");
            drop(lock);
            assert!(cfg!(not(unix)) || !path.exists(), "{left}");
        }
    }

    #[test]
    fn files_of_others_are_left_alone() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join(files::LOCK);
        fs::write(&path, "mine").unwrap();
        assert!(matches!(DirectoryLock::claim(directory.path()), Err(OutputError::Io { .. })));
        assert_eq!(fs::read(&path).unwrap(), b"mine");
        #[cfg(unix)]
        {
            let target = directory.path().join("target");
            fs::write(&target, "").unwrap();
            fs::remove_file(&path).unwrap();
            std::os::unix::fs::symlink(&target, &path).unwrap();
            let error = DirectoryLock::claim(directory.path()).unwrap_err();
            assert!(error.to_string().contains(files::LOCK), "{error}");
            assert!(fs::read(&target).unwrap().is_empty() && path.is_symlink());
        }
    }

    /// Threads that take and leave the lock as fast as they can: two of them never have it at once.
    #[test]
    fn nobody_holds_a_lock_that_another_one_holds() {
        use std::sync::atomic::{AtomicU32, Ordering};
        let directory = tempfile::tempdir().unwrap();
        let (holders, claims) = (AtomicU32::new(0), AtomicU32::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..500 {
                        let Ok(lock) = DirectoryLock::claim(directory.path()) else { continue };
                        assert_eq!(holders.fetch_add(1, Ordering::SeqCst), 0, "two hold the lock");
                        claims.fetch_add(1, Ordering::SeqCst);
                        std::thread::yield_now();
                        holders.fetch_sub(1, Ordering::SeqCst);
                        drop(lock);
                    }
                });
            }
        });
        assert!(claims.load(Ordering::SeqCst) > 0);
    }
}
