//! A file that grows by whole records.

use super::OutputError;
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// Bytes kept back before they are written of themselves.
const BUFFER: usize = 1 << 20;

/// A file that holds whole records after every flush, even one that failed half-way for want of space.
#[derive(Debug)]
pub(super) struct RecordFile {
    path: PathBuf,
    file: File,
    /// Length of the whole records on disk.
    length: u64,
    /// Whole records not yet on disk.
    buffer: Vec<u8>,
}

impl RecordFile {
    /// Creates an empty file; one that exists is emptied.
    pub(super) fn create(path: &Path) -> Result<Self, OutputError> {
        let file = File::create(path).map_err(OutputError::io("create", path))?;
        Ok(Self { path: path.to_path_buf(), file, length: 0, buffer: Vec::new() })
    }

    /// Opens a file to continue it after its first `length` bytes; what follows them is cut off.
    pub(super) fn resume(path: &Path, length: u64) -> Result<Self, OutputError> {
        let mut file = File::options().write(true).open(path).map_err(OutputError::io("continue", path))?;
        file.set_len(length)
            .and_then(|()| file.seek(SeekFrom::Start(length)))
            .map_err(OutputError::io("cut back", path))?;
        Ok(Self { path: path.to_path_buf(), file, length, buffer: Vec::new() })
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Adds one whole record.
    pub(super) fn append(&mut self, record: &[u8]) -> Result<(), OutputError> {
        self.buffer.extend_from_slice(record);
        if self.buffer.len() >= BUFFER { self.flush() } else { Ok(()) }
    }

    /// Hands all records to the operating system.
    pub(super) fn flush(&mut self) -> Result<(), OutputError> {
        let buffer = std::mem::take(&mut self.buffer);
        if let Err(source) = self.file.write_all(&buffer) {
            // The error to report is the one of the write; there may be nothing to cut back (a pipe, a device).
            let _ = self.file.set_len(self.length);
            let _ = self.file.seek(SeekFrom::Start(self.length));
            return Err(OutputError::Io { attempted: "write", path: self.path.clone(), source });
        }
        self.length += buffer.len() as u64;
        self.buffer = buffer;
        self.buffer.clear();
        Ok(())
    }

    /// Flushes and waits until the records are on the disk.
    pub(super) fn sync(&mut self) -> Result<(), OutputError> {
        self.flush()?;
        self.file.sync_data().map_err(OutputError::io("write", &self.path))
    }
}

impl Drop for RecordFile {
    fn drop(&mut self) {
        // Who needs to know whether this works calls `flush` first.
        let _ = self.flush();
    }
}
