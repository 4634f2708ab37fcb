//! The files that the scenes of a study start from: where they are, and that they stay what they were.

use super::{Scene, SceneError, StateFile, start};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Files of states that scenes of one text were read with. Scenes that are read later get the same particles, or are refused.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct StateFiles {
    /// The absolute directory that paths of files are relative to; none where it is the one beside the scene.
    directory: Option<String>,
    read: Vec<FileRead>,
}

/// What was read of a file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct FileRead {
    file: String,
    frame: i64,
    checksum: String,
}

impl StateFiles {
    /// Those of a scene of that name, none of which has been read yet.
    pub(crate) fn of(name: &str) -> Self {
        let beside = start::path(name, "");
        let directory = std::path::absolute(if beside.as_os_str().is_empty() { Path::new(".") } else { &beside }).ok();
        // A path that is no text cannot be written into a summary: there it stays relative.
        Self { directory: directory.and_then(|path| path.to_str().map(str::to_owned)), read: Vec::new() }
    }

    /// Whether no scene has a file.
    pub(crate) fn is_empty(&self) -> bool {
        self.read.is_empty()
    }

    /// Notes what a scene was read from, if that is new.
    pub(crate) fn note(&mut self, scene: &Scene) {
        if let Some(state) = &scene.state
            && let Some(checksum) = state.checksum.clone()
            && self.known(state).is_none()
        {
            self.read.push(FileRead { file: state.file.clone(), frame: state.frame, checksum });
        }
    }

    /// Where the file of a scene of that name is.
    pub(crate) fn path(&self, name: &str, file: &str) -> PathBuf {
        match &self.directory {
            Some(directory) => Path::new(directory).join(file),
            None => start::path(name, file),
        }
    }

    /// The checksum that was read, if the file was.
    pub(crate) fn known(&self, state: &StateFile) -> Option<&str> {
        let found = self.read.iter().find(|read| read.file == state.file && read.frame == state.frame);
        found.map(|read| read.checksum.as_str())
    }

    /// Looks whether a file is still what it was.
    ///
    /// # Errors
    /// [`SceneError::StateChanged`] if it is not.
    pub(crate) fn check(&self, path: &Path, state: &StateFile, found: &str) -> Result<(), SceneError> {
        match self.known(state).filter(|known| *known != found) {
            None => Ok(()),
            Some(known) => {
                let reason = format!("the checksum of its particles was {known} and is {found} now");
                Err(SceneError::StateChanged { path: path.to_path_buf(), reason })
            }
        }
    }
}
