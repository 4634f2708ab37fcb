//! Files that are complete or absent: written under a name of their own, then moved to their final one.

use super::{OutputError, files};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// A new file in the directory of the one it is to become; removed unless it is moved there.
///
/// Its name is one that only mesoscope gives ([`files::temporary`]), and nothing that exists is opened, emptied or followed
/// as a link.
#[derive(Debug)]
pub(super) struct Temporary {
    path: PathBuf,
    moved: bool,
}

impl Temporary {
    /// Makes the file.
    pub(super) fn beside(path: &Path) -> io::Result<(Self, File)> {
        static NUMBER: AtomicU64 = AtomicU64::new(0);
        let name = path.file_name().ok_or(io::ErrorKind::InvalidInput)?;
        loop {
            let number = NUMBER.fetch_add(1, Ordering::Relaxed);
            let temporary = path.with_file_name(files::temporary(name, std::process::id(), number));
            match File::options().write(true).create_new(true).open(&temporary) {
                // A killed process had the number that this one has now.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                made => return made.map(|file| (Self { path: temporary, moved: false }, file)),
            }
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives the file its final name; one that has it is replaced.
    pub(super) fn move_to(mut self, path: &Path) -> io::Result<()> {
        fs::rename(&self.path, path)?;
        self.moved = true;
        Ok(())
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.moved {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Writes a file under a temporary name in the same directory, and moves it to `path` once it is on the disk. On an error the
/// temporary file is removed, and what was at `path` before is still there.
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
    let write = || -> io::Result<()> {
        let (temporary, file) = Temporary::beside(path)?;
        let mut writer = BufWriter::with_capacity(1 << 18, file);
        content(&mut writer)?;
        let file = writer.into_inner().map_err(io::IntoInnerError::into_error)?;
        // A name must never point at data that a power failure can still take away.
        file.sync_all()?;
        drop(file);
        temporary.move_to(path)
    };
    write().map_err(OutputError::io("write", path))
}
