//! What can go wrong with files.

use super::Id;
use std::io;
use std::path::{Path, PathBuf};

/// A failure to write or read a file of a run.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The operating system refused.
    #[error("cannot {attempted} `{}`: {source}", crate::printable::path(path))]
    Io {
        /// What was attempted, as in "cannot create …".
        attempted: &'static str,
        /// The file or directory.
        path: PathBuf,
        /// The reason the system gives.
        source: io::Error,
    },
    /// The directory holds a file of an earlier run.
    #[error(
        "`{}` exists already, likely from an earlier run: pass --force to replace all results there, or choose another directory with --out",
        crate::printable::path(path)
    )]
    ResultExists {
        /// The first such file.
        path: PathBuf,
    },
    /// Another process writes into the directory.
    #[error(
        "`{}` is in use by {holder}: wait for its end, or stop it, or choose another directory",
        crate::printable::path(directory)
    )]
    InUse {
        /// The directory.
        directory: PathBuf,
        /// The process, with its number where it is known.
        holder: String,
    },
    /// A file that a run kept open is not what it was.
    #[error(
        "`{}` is not complete: {problem} while the run was under way; what was in it is lost: run the scene again with --force to have it",
        crate::printable::path(path)
    )]
    Lost {
        /// The file.
        path: PathBuf,
        /// What happened to it.
        problem: &'static str,
    },
    /// A directory has the name of a result.
    #[error(
        "`{}` is a directory, and a result is to have its name: move it away, or choose another directory with --out",
        crate::printable::path(path)
    )]
    DirectoryOfThatName {
        /// The directory inside that of the run.
        path: PathBuf,
    },
    /// A file stands where the directory should be.
    #[error("`{}` is a file, and the results need a directory: choose one with --out", crate::printable::path(path))]
    NoDirectory {
        /// The file.
        path: PathBuf,
    },
    /// A column name that a table cannot hold.
    #[error(
        "`{name}` cannot head a column of `{}`: names are not empty and hold no control characters",
        crate::printable::path(path)
    )]
    ColumnName {
        /// The table.
        path: PathBuf,
        /// The name.
        name: String,
    },
    /// A row that does not fit its table.
    #[error("a row of {found} values does not fit the {expected} columns of `{}`", crate::printable::path(path))]
    RowLength {
        /// The table.
        path: PathBuf,
        /// Columns of the table.
        expected: usize,
        /// Values of the row.
        found: usize,
    },
    /// A line of a text file that cannot be understood.
    #[error("`{}`, line {line}: {problem}", crate::printable::path(path))]
    Line {
        /// The file.
        path: PathBuf,
        /// Line number, from 1.
        line: u64,
        /// What is wrong with it.
        problem: String,
    },
    /// A table lacks a row that was written before.
    #[error(
        "`{}` is not what the run wrote: the row of step {step} is missing; restore the file, or run the scene again with --force",
        crate::printable::path(path)
    )]
    MissingRow {
        /// The table.
        path: PathBuf,
        /// The step of the first row that is missing.
        step: u64,
    },
    /// A file that a run is to continue does not hold what was written.
    #[error(
        "`{}` is not what the run wrote: its length or checksum is not the one that the run noted; restore the file, or run the scene again with --force",
        crate::printable::path(path)
    )]
    Altered {
        /// The table or trajectory.
        path: PathBuf,
    },
    /// A file in the directory of a run has the id of another one.
    #[error(
        "`{}` belongs to another {1} than `{reference}`, of another scene or seed: its {2} is {found}, not {expected}; put the files of one {1} together",
        crate::printable::path(path),
        expected.noun(),
        found.key()
    )]
    OtherRun {
        /// The file of the other run.
        path: PathBuf,
        /// The id in it.
        found: Id,
        /// The id of the run in this directory.
        expected: Id,
        /// The file that this id is from.
        reference: &'static str,
    },
    /// A summary that speaks of another scene than the run has.
    #[error(
        "`{}` was changed: it describes another scene than the run has; remove it, and `mesoscope resume` writes it again",
        crate::printable::path(path)
    )]
    OtherScene {
        /// The summary.
        path: PathBuf,
    },
    /// A summary is not what a run wrote.
    #[error(
        "`{}` was changed after a run wrote it: its content has another checksum; restore it, or remove it, and `mesoscope resume` writes it again",
        crate::printable::path(path)
    )]
    Edited {
        /// The summary.
        path: PathBuf,
    },
    /// A run was taken further than its summary says, and has not ended.
    #[error(
        "the run in `{0}` was continued beyond step {finished} and has not ended: `mesoscope resume {0}` continues it",
        crate::printable::path(directory)
    )]
    Continued {
        /// The directory of the run.
        directory: PathBuf,
        /// The step up to which it was finished, or was to be.
        finished: u64,
    },
    /// A run ended before it saved anything to continue from.
    #[error(
        "the run in `{}` ended before it saved its first checkpoint, so there is nothing to resume: run the scene again with --force",
        crate::printable::path(directory)
    )]
    NothingSaved {
        /// The directory of the run.
        directory: PathBuf,
    },
    /// No run has been finished in the directory.
    #[error("`{}` is missing: {advice}", crate::printable::path(path))]
    Unfinished {
        /// The summary that a finished run leaves.
        path: PathBuf,
        /// What that means.
        advice: &'static str,
    },
    /// A table of a run has other columns than the run writes.
    #[error(
        "`{}` is not what the run wrote: it has the columns `{found}`, and the run writes `{expected}`; restore the file, or run the scene again with --force",
        crate::printable::path(path)
    )]
    Columns {
        /// The table.
        path: PathBuf,
        /// The header this run writes.
        expected: String,
        /// The header in the file.
        found: String,
    },
    /// A state that does not fit the model of the trajectory.
    #[error("cannot write step {step} to `{}`: {problem}", crate::printable::path(path))]
    State {
        /// The trajectory.
        path: PathBuf,
        /// The step of the state.
        step: u64,
        /// What does not fit.
        problem: &'static str,
    },
    /// A binary trajectory that cannot be continued.
    #[error("`{}` is no trajectory this program can continue: {problem}", crate::printable::path(path))]
    Trajectory {
        /// The trajectory.
        path: PathBuf,
        /// What is wrong with it.
        problem: String,
    },
    /// A value that JSON cannot hold.
    #[error("cannot express the content of `{}` as JSON: {source}", crate::printable::path(path))]
    Json {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: serde_json::Error,
    },
}

impl OutputError {
    /// Adds what was attempted, and on which path, to an error of the operating system.
    pub(crate) fn io(attempted: &'static str, path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_path_buf();
        move |source| Self::Io { attempted, path, source }
    }
}
