//! Lines of a text file, of which one is in memory at a time.

use super::{FORMATS, Mistake, Mistakes};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom};

/// Bytes of the longest line that is read.
const LONGEST: u64 = 1 << 20;

/// Lines of a file, counted from 1.
pub(super) struct Lines {
    reader: BufReader<File>,
    buffer: Vec<u8>,
    /// Number of the last line that was read.
    number: u64,
    /// Bytes of the file that have been read.
    offset: u64,
}

impl Lines {
    pub(super) fn of(file: File) -> Self {
        Self { reader: BufReader::with_capacity(1 << 18, file), buffer: Vec::new(), number: 0, offset: 0 }
    }

    pub(super) fn number(&self) -> u64 {
        self.number
    }

    /// The place of the last line, in words.
    pub(super) fn place(&self) -> String {
        format!("line {}", self.number)
    }

    pub(super) fn offset(&self) -> u64 {
        self.offset
    }

    /// Goes to a line that begins at an offset.
    pub(super) fn seek(&mut self, offset: u64, lines_before: u64) -> io::Result<()> {
        self.reader.seek(SeekFrom::Start(offset))?;
        (self.offset, self.number) = (offset, lines_before);
        Ok(())
    }

    /// The next line, without its end; none at the end of the file.
    pub(super) fn next(&mut self) -> Result<Option<&str>, Mistakes> {
        self.buffer.clear();
        let read = self.reader.by_ref().take(LONGEST).read_until(b'\n', &mut self.buffer)? as u64;
        if read == 0 {
            return Ok(None);
        }
        self.number += 1;
        self.offset += read;
        if read == LONGEST && self.buffer.last() != Some(&b'\n') {
            return Err(self.endless());
        }
        let number = self.number;
        match std::str::from_utf8(&self.buffer) {
            Ok(text) => Ok(Some(text.trim_end_matches(['\n', '\r']))),
            Err(_) => {
                Err(Mistake::new(format!("line {number}"), "found bytes that are no text in UTF-8", FORMATS).into())
            }
        }
    }

    fn endless(&self) -> Mistakes {
        Mistake::new(self.place(), "found a line that does not end within a megabyte", FORMATS).into()
    }

    /// Skips a line; whether there was one.
    pub(super) fn skip(&mut self) -> Result<bool, Mistakes> {
        let mut rest = self.reader.by_ref().take(LONGEST);
        let skipped = rest.skip_until(b'\n')? as u64;
        let is_endless = rest.limit() == 0;
        self.offset += skipped;
        self.number += u64::from(skipped > 0);
        if is_endless { Err(self.endless()) } else { Ok(skipped > 0) }
    }
}
