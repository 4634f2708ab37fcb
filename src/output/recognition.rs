//! Which run the files in a directory belong to.

use super::id::RUN_KEY;
use super::{Id, OutputError, RunDirectory, checkpoint, files, own_file, picture, trajectory};
use serde_json::Value;
use std::path::Path;

impl RunDirectory {
    /// Looks whether a file in the directory has the id of another run than this one, which is that of `reference`. Tables
    /// and arrays have none: their lengths and checksums are in the checkpoint and the summary.
    ///
    /// # Errors
    /// [`OutputError::OtherRun`] names the first such file, [`OutputError::Io`] one that is no regular file of the directory, or means
    /// that the directory cannot be listed.
    pub fn check_run(&self, run: Id, reference: &'static str) -> Result<(), OutputError> {
        self.check_ids(run, reference, files::is_of_a_run)
    }

    /// The same for files of a kind, with the id of a run or a sweep.
    pub(crate) fn check_ids(
        &self,
        id: Id,
        reference: &'static str,
        kind: impl Fn(&str) -> bool,
    ) -> Result<(), OutputError> {
        for name in self.names(kind)? {
            let path = self.file(&name);
            own_file::check(&path).map_err(OutputError::io("use", &path))?;
            id.check(&path, id_in(&name, &path), reference)?;
        }
        Ok(())
    }
}

/// The id in a file of a run or in a picture; none where the format has no place for it, or where it cannot be read.
fn id_in(name: &str, path: &Path) -> Option<Id> {
    match name {
        files::SUMMARY => Id::parse(own_file::json::<Value>(path).ok()?.get(RUN_KEY)?.as_str()?),
        files::CHECKPOINT => checkpoint::id_of(path),
        // What is neither has no id.
        _ => trajectory::id_of(name, path).or_else(|| picture::id_of(path)),
    }
}
