//! Whether a file that is kept open is still the one of its name.

use super::OutputError;
use super::own_file::identity;
use std::fs;
use std::path::{Path, PathBuf};

/// Looks whether a file is there that a run has written.
///
/// # Errors
/// [`OutputError::Lost`] if it is not.
pub(crate) fn exists(path: &Path) -> Result<(), OutputError> {
    if path.exists() { Ok(()) } else { Err(OutputError::Lost { path: path.to_path_buf(), problem: REMOVED }) }
}

const REMOVED: &str = "it was removed";

/// A file as it was when it was opened.
#[derive(Debug)]
pub(super) struct Watch {
    path: PathBuf,
    identity: Option<(u64, u64)>,
}

impl Watch {
    /// Begins with the file that is at a path now.
    pub(super) fn of(path: &Path) -> Result<Self, OutputError> {
        let metadata = fs::metadata(path).map_err(OutputError::io("look at", path))?;
        Ok(Self { path: path.to_path_buf(), identity: identity(&metadata) })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The length of the file, as long as it is the same.
    pub(super) fn length(&self) -> Option<u64> {
        let metadata = fs::metadata(&self.path).ok()?;
        (identity(&metadata) == self.identity).then_some(metadata.len())
    }

    /// Looks whether the same file is there, as long as it was written.
    pub(super) fn check(&self, length: u64) -> Result<(), OutputError> {
        let problem = match fs::metadata(&self.path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => REMOVED,
            Err(source) => return Err(OutputError::Io { attempted: "look at", path: self.path.clone(), source }),
            Ok(metadata) if identity(&metadata) != self.identity => "another file took its place",
            Ok(metadata) if metadata.is_file() && metadata.len() != length => "something else wrote to it",
            Ok(_) => return Ok(()),
        };
        Err(OutputError::Lost { path: self.path.clone(), problem })
    }
}
