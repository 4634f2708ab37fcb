//! A file that grows by whole records.

use super::extent::{Checksum, Extent};
use super::watch::Watch;
use super::{OutputError, own_file};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;

/// Bytes kept back before they are written of themselves.
const BUFFER: usize = 1 << 20;

/// A file that holds whole records after every flush, even one that failed half-way for want of space.
#[derive(Debug)]
pub(super) struct RecordFile {
    file: File,
    watch: Watch,
    /// Length of the whole records on disk.
    length: u64,
    /// Of these records.
    checksum: Checksum,
    /// Whole records not yet on disk.
    buffer: Vec<u8>,
}

impl RecordFile {
    /// Creates an empty file; one that exists is emptied.
    pub(super) fn create(path: &Path) -> Result<Self, OutputError> {
        let file = File::create(path).map_err(OutputError::io("create", path))?;
        Self::of(path, file, 0, Checksum::default())
    }

    /// Opens a file to continue it after what was written of it; what follows that is cut off.
    ///
    /// # Errors
    /// [`OutputError::Altered`] when its beginning is not what was written: then nothing is cut off.
    pub(super) fn resume(path: &Path, written: Extent) -> Result<Self, OutputError> {
        let mut file = own_file::open_to_continue(path).map_err(OutputError::io("continue", path))?;
        let mut checksum = Checksum::default();
        let found = checksum.read((&mut file).take(written.bytes)).map_err(OutputError::io("read", path))?;
        if checksum.extent(found) != written {
            return Err(OutputError::Altered { path: path.to_path_buf() });
        }
        file.set_len(found)
            .and_then(|()| file.seek(SeekFrom::Start(found)))
            .map_err(OutputError::io("cut back", path))?;
        Self::of(path, file, found, checksum)
    }

    fn of(path: &Path, file: File, length: u64, checksum: Checksum) -> Result<Self, OutputError> {
        Ok(Self { file, watch: Watch::of(path)?, length, checksum, buffer: Vec::new() })
    }

    pub(super) fn path(&self) -> &Path {
        self.watch.path()
    }

    /// What has been handed to the operating system.
    pub(super) fn extent(&self) -> Extent {
        self.checksum.extent(self.length)
    }

    /// Looks whether the file of this name is still the one that was written.
    pub(super) fn check(&self) -> Result<(), OutputError> {
        self.watch.check(self.length)
    }

    /// Adds one whole record.
    pub(super) fn append(&mut self, record: &[u8]) -> Result<(), OutputError> {
        self.buffer.extend_from_slice(record);
        if self.buffer.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    /// Hands all records to the operating system.
    pub(super) fn flush(&mut self) -> Result<(), OutputError> {
        let buffer = std::mem::take(&mut self.buffer);
        if let Err(error) = self.file.write_all(&buffer) {
            // The error to report is the one of the write; there may be nothing to cut back (a pipe, a device).
            let _ = self.file.set_len(self.length);
            let _ = self.file.seek(SeekFrom::Start(self.length));
            return Err(OutputError::io("write", self.path())(error));
        }
        self.length += buffer.len() as u64;
        self.checksum.add(&buffer);
        self.buffer = buffer;
        self.buffer.clear();
        Ok(())
    }

    /// Flushes and waits until the records are on the disk.
    pub(super) fn sync(&mut self) -> Result<(), OutputError> {
        self.flush()?;
        self.file.sync_data().map_err(OutputError::io("write", self.path()))
    }
}

impl Drop for RecordFile {
    fn drop(&mut self) {
        // Who needs to know whether this works calls `flush` first.
        let _ = self.flush();
    }
}
