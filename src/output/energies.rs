//! The table of energies: a row per sample, for as long as the run lasts.

use super::records::RecordFile;
use super::table::header_line;
use super::{Extent, OutputError, own_file};
use crate::numbers::push_exact;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// `energies.csv`, open for writing.
///
/// The first column is `step`; the others are named by the caller. Numbers have the fewest digits that give the same
/// `f64` back, so equal values give equal bytes. Rows reach the disk at [`flush`](Self::flush), always whole.
///
/// ```
/// use mesoscope::output::EnergiesFile;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("energies.csv");
/// let mut energies = EnergiesFile::create(&path, &["temperature", "pressure"])?;
/// energies.append(0, &[1.02, f64::NAN])?;
/// energies.flush()?;
/// let first = energies.extent();
/// energies.append(20, &[0.98, 23.5])?;
/// energies.flush()?;
/// assert_eq!(std::fs::read_to_string(&path)?, "step,temperature,pressure\n0,1.02,\n20,0.98,23.5\n");
///
/// // A run that continues from before a row writes it again.
/// EnergiesFile::resume(&path, &["temperature", "pressure"], first)?;
/// assert_eq!(std::fs::read_to_string(&path)?, "step,temperature,pressure\n0,1.02,\n");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct EnergiesFile {
    records: RecordFile,
    columns: usize,
    line: Vec<u8>,
}

impl EnergiesFile {
    /// Creates the table with its header: `step`, then `columns`.
    ///
    /// # Errors
    /// [`OutputError::ColumnName`] for a name a table cannot hold; [`OutputError::Io`] when the file cannot be written.
    pub fn create<S: AsRef<str>>(path: &Path, columns: &[S]) -> Result<Self, OutputError> {
        let header = full_header(path, columns)?;
        let mut records = RecordFile::create(path)?;
        records.append(header.as_bytes())?;
        records.flush()?;
        Ok(Self { records, columns: columns.len(), line: Vec::new() })
    }

    /// Continues the table of an earlier run after what [`extent`](Self::extent) said was written of it. That stays as it
    /// is, byte for byte; later rows, and a last line that was never finished, are cut off.
    ///
    /// # Errors
    /// [`OutputError::Columns`] when the header is another one, [`OutputError::Altered`] when the rows are not those that
    /// were written, [`OutputError::Io`] when the file cannot be read or written.
    pub fn resume<S: AsRef<str>>(path: &Path, columns: &[S], written: Extent) -> Result<Self, OutputError> {
        let expected = full_header(path, columns)?;
        let file = own_file::open(path).map_err(OutputError::io("continue", path))?;
        let mut line = Vec::new();
        // A header that never ends is another one.
        let mut lines = BufReader::new(file).take(expected.len() as u64 + 1);
        lines.read_until(b'\n', &mut line).map_err(OutputError::io("read", path))?;
        if line != expected.as_bytes() {
            return Err(OutputError::Columns {
                path: path.to_path_buf(),
                expected: expected.trim_end().to_owned(),
                found: String::from_utf8_lossy(&line).trim_end().to_owned(),
            });
        }
        let records = RecordFile::resume(path, written)?;
        Ok(Self { records, columns: columns.len(), line: Vec::new() })
    }

    /// What has been written of the table: all rows until the last [`flush`](Self::flush).
    #[must_use]
    pub fn extent(&self) -> Extent {
        self.records.extent()
    }

    /// Looks whether the table under this name is still the one that was written.
    ///
    /// # Errors
    /// [`OutputError::Lost`] says what became of it.
    pub fn check(&self) -> Result<(), OutputError> {
        self.records.check()
    }

    /// Adds a row. What is not finite leaves its cell empty: the quantity has no value at this step.
    ///
    /// # Errors
    /// [`OutputError::RowLength`] unless there is one value for each column; [`OutputError::Io`] when a full buffer
    /// cannot be written.
    pub fn append(&mut self, step: u64, values: &[f64]) -> Result<(), OutputError> {
        if values.len() != self.columns {
            return Err(OutputError::RowLength {
                path: self.records.path().to_path_buf(),
                expected: self.columns,
                found: values.len(),
            });
        }
        self.line.clear();
        self.line.extend_from_slice(step.to_string().as_bytes());
        for value in values {
            self.line.push(b',');
            push_exact(&mut self.line, *value);
        }
        self.line.push(b'\n');
        self.records.append(&self.line)
    }

    /// Hands all rows to the operating system: call it at the end of a batch.
    ///
    /// # Errors
    /// [`OutputError::Io`] when they cannot be written; the file then ends with the rows of the last flush that worked.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.records.flush()
    }

    /// Flushes and waits for the disk: call it before a checkpoint that counts on these rows.
    ///
    /// # Errors
    /// As [`flush`](Self::flush).
    pub fn sync(&mut self) -> Result<(), OutputError> {
        self.records.sync()
    }
}

fn full_header<S: AsRef<str>>(path: &Path, columns: &[S]) -> Result<String, OutputError> {
    header_line(path, std::iter::once("step").chain(columns.iter().map(AsRef::as_ref)))
}
