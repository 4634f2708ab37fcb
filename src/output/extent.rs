//! How much of a file there was, and what it held.

use super::{OutputError, own_file};
use serde::{Deserialize, Serialize};
use std::io::{self, BufReader, Read};
use std::path::Path;

/// Length and checksum of a file, or of its beginning.
///
/// ```
/// use mesoscope::output::Extent;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("table.csv");
/// std::fs::write(&path, "123456789")?;
/// assert_eq!(Extent::of(&path)?, Extent { bytes: 9, crc32: 0xcbf4_3926 });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Extent {
    /// Number of bytes.
    pub bytes: u64,
    /// CRC-32 (IEEE 802.3) of the bytes; of a trajectory in GSD, of what its frames hold.
    pub crc32: u32,
}

impl Extent {
    /// The extent of a whole file.
    ///
    /// # Errors
    /// [`OutputError::Io`] when it cannot be read.
    pub fn of(path: &Path) -> Result<Self, OutputError> {
        let read = || {
            let mut sum = Checksum::default();
            let bytes = sum.read(own_file::open(path)?)?;
            Ok(sum.extent(bytes))
        };
        read().map_err(OutputError::io("read", path))
    }

    /// Looks whether a file holds what was written. No more than that is read of it, and nothing where the file is shorter.
    ///
    /// # Errors
    /// [`OutputError::Io`] when it cannot be read.
    pub(crate) fn find_in(&self, path: &Path) -> Result<Found, OutputError> {
        let find = || {
            let file = own_file::open(path)?;
            let length = file.metadata()?.len();
            let mut sum = Checksum::default();
            if length < self.bytes || sum.read(file.take(self.bytes))? != self.bytes {
                return Ok(Found::Nowhere);
            }
            Ok(match sum.extent(self.bytes) == *self {
                true if length == self.bytes => Found::Whole,
                true => Found::AtTheBeginning,
                false => Found::Nowhere,
            })
        };
        find().map_err(OutputError::io("read", path))
    }
}

/// Where in a file something was found that had been written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Found {
    /// It is the file.
    Whole,
    /// More follows.
    AtTheBeginning,
    Nowhere,
}

/// A checksum under way.
#[derive(Debug, Clone, Default)]
pub(super) struct Checksum(crc32fast::Hasher);

impl Checksum {
    pub(super) fn add(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// The extent of as many bytes, with the checksum of what was added.
    pub(super) fn extent(&self, bytes: u64) -> Extent {
        Extent { bytes, crc32: self.0.clone().finalize() }
    }
}

impl Checksum {
    /// Adds everything that a source holds, and returns its length.
    pub(super) fn read(&mut self, source: impl Read) -> io::Result<u64> {
        io::copy(&mut BufReader::with_capacity(1 << 16, source), self)
    }
}

impl io::Write for Checksum {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.add(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
