//! The files of a directory as a run or a study left them there: regular ones, and no links to others.
//!
//! A pipe is waited for, a device may not end, and what a link leads to belongs to somebody else: none of them is opened.

use super::OutputError;
use crate::state_file::checkpoint::Fnv;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::fs::{self, File, Metadata};
use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

/// Bytes of the longest line of a table.
const LONGEST_LINE: u64 = 1 << 20;

/// Opens a file of a directory to read it.
pub(super) fn open(path: &Path) -> io::Result<File> {
    check(path)?;
    File::open(path)
}

/// Opens a file of a directory to continue it in its place.
pub(super) fn open_to_continue(path: &Path) -> io::Result<File> {
    check_to_continue(path)?;
    File::options().read(true).write(true).open(path)
}

/// Looks whether a file may be opened.
pub(super) fn check(path: &Path) -> io::Result<Metadata> {
    let found = fs::symlink_metadata(path)?;
    if found.is_file() {
        return Ok(found);
    }
    let what = match found.file_type() {
        kind if kind.is_symlink() => "it is a symbolic link, which is not followed",
        kind if kind.is_dir() => "it is a directory",
        _ => "it is a pipe, a socket or a device",
    };
    Err(refused(format!("{what}: the files in this directory are regular files of its own")))
}

/// Looks whether a file may be continued in its place, where a file of two names would change under both.
pub(crate) fn check_to_continue(path: &Path) -> io::Result<()> {
    let found = check(path)?;
    #[cfg(unix)]
    if std::os::unix::fs::MetadataExt::nlink(&found) > 1 {
        return Err(refused(
            "it has another name (a hard link), under which it would change too: replace it by a copy",
        ));
    }
    #[cfg(not(unix))]
    let _ = found;
    Ok(())
}

/// The identity of a file among those with its name; none where the system has none.
#[cfg(unix)]
#[allow(clippy::unnecessary_wraps)]
pub(super) fn identity(metadata: &Metadata) -> Option<(u64, u64)> {
    use std::os::unix::fs::MetadataExt;
    Some((metadata.dev(), metadata.ino()))
}

#[cfg(not(unix))]
pub(super) fn identity(_: &Metadata) -> Option<(u64, u64)> {
    None
}

fn refused(reason: impl Into<String>) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidInput, reason.into())
}

/// Reads a JSON file of a directory; what is not JSON is not read to its end.
///
/// # Errors
/// [`OutputError::Line`] where it is not what is expected, [`OutputError::Io`] where it cannot be read.
pub(crate) fn json<T: DeserializeOwned>(path: &Path) -> Result<T, OutputError> {
    let file = open(path).map_err(OutputError::io("read", path))?;
    serde_json::from_reader(BufReader::new(file)).map_err(|error| {
        let line = error.line() as u64;
        if error.is_io() {
            return OutputError::io("read", path)(error.into());
        }
        OutputError::Line { path: path.to_path_buf(), line, problem: error.to_string() }
    })
}

/// A checksum of values, whatever the spaces and the breaks of lines between them.
pub(crate) fn checksum_of<'v>(values: impl IntoIterator<Item = &'v Value>) -> String {
    let mut sum = Fnv::new();
    for value in values {
        // Values of JSON can always be written.
        sum.add(&serde_json::to_vec(value).unwrap_or_default());
    }
    format!("{:016x}", sum.0)
}

/// The lines of a table, with their ends; one that is too long to be one of a table is an error.
pub(crate) fn lines(path: &Path) -> io::Result<impl Iterator<Item = io::Result<String>>> {
    let mut reader = BufReader::new(open(path)?);
    let mut next = move || {
        let mut line = Vec::new();
        reader.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line)?;
        if line.len() as u64 == LONGEST_LINE {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "a line does not end within a megabyte"));
        }
        String::from_utf8(line).map_err(|_| io::Error::new(io::ErrorKind::InvalidData, "expected text in UTF-8"))
    };
    Ok(std::iter::from_fn(move || Some(next()).filter(|line| !line.as_ref().is_ok_and(String::is_empty))))
}

#[cfg(test)]
#[cfg(unix)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn only_regular_files_without_other_names_are_opened() {
        let directory = tempfile::tempdir().unwrap();
        let path = |name: &str| directory.path().join(name);
        fs::write(path("own"), "text").unwrap();
        assert!(open(&path("own")).is_ok() && open_to_continue(&path("own")).is_ok());
        std::os::unix::fs::symlink(path("own"), path("link")).unwrap();
        std::os::unix::fs::symlink("/dev/zero", path("endless")).unwrap();
        fs::create_dir(path("directory")).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
        for (name, word) in
            [("link", "symbolic link"), ("endless", "symbolic link"), ("directory", "a directory"), ("pipe", "a pipe")]
        {
            for error in [open(&path(name)).unwrap_err(), open_to_continue(&path(name)).unwrap_err()] {
                assert!(error.to_string().contains(word), "{name}: {error}");
            }
        }
        // A copy of a directory by hard links shares its bytes with the original.
        fs::hard_link(path("own"), path("twin")).unwrap();
        assert!(open(&path("own")).is_ok());
        assert!(open_to_continue(&path("own")).unwrap_err().to_string().contains("hard link"));
    }

    /// Terabytes without a line, and without a bracket: nothing is read that can have no meaning.
    #[test]
    fn files_of_nothing_are_not_read_to_their_ends() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("sparse");
        File::create(&path).unwrap().set_len(1 << 42).unwrap();
        let error = lines(&path).unwrap().next().unwrap().unwrap_err();
        assert!(error.to_string().contains("does not end within a megabyte"), "{error}");
        assert!(matches!(json::<serde_json::Value>(&path), Err(OutputError::Line { line: 1, .. })));
    }
}
