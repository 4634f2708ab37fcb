//! The file layer of HOOMD's GSD, versions 1 and 2: named arrays of numbers, frame by frame,
//! <https://gsd.readthedocs.io/en/stable/file-layer.html>.
//!
//! A file has a header, an index with an entry of every array, a list of names, and the arrays. Index and list have room to grow;
//! one that is full is copied to the end of the file with at least twice the room. The index names an array only when that is on the
//! disk, and the header a copy only when that is: wherever a process or a machine stops, what the index names is there.

use bytemuck::{Pod, Zeroable};
use std::borrow::Cow;
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::Path;

const MAGIC: u64 = 0x65df_65df_65df_65df;
const HEADER: u64 = size_of::<Header>() as u64;
const ENTRY: u64 = size_of::<Chunk>() as u64;
/// Bytes of a name in version 1, and the unit of the length of the list in both.
const NAME: u64 = 64;
/// Bytes of names: there are at most 65 536 of them.
const MOST_NAMES: u64 = 16 << 20;
/// Entries and names that a new file has room for.
const ROOM: [u64; 2] = [128, 16];
/// Version 2.1, as all versions are written.
const VERSION: u32 = version_word((2, 1));
/// Bytes that are read or written at once.
const PIECE: usize = 1 << 18;

/// Whether a file that begins like this is one of GSD.
pub(super) fn is_one(start: &[u8]) -> bool {
    start.starts_with(&MAGIC.to_le_bytes())
}

/// Why a file cannot be read or continued.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GsdError {
    /// The operating system refused.
    #[error("{0}")]
    Io(#[from] io::Error),
    /// It does not begin as files of GSD do.
    #[error("it is not a GSD file")]
    Format,
    /// Another version of the file layer.
    #[error("it has version {0} of the file layer of GSD")]
    Version(u32),
    /// Parts of it lie beyond its end.
    #[error("it was cut short")]
    Cut,
    /// Its index makes no sense.
    #[error("its index is damaged")]
    Index,
    /// An array of other numbers, or of rows of another length, than was asked for.
    #[error("the array `{0}` holds other numbers, or rows of another length")]
    Array(String),
}

/// A type of numbers that arrays can hold.
pub trait Number: Pod {
    /// Its number in the file.
    const KIND: u8;
}

macro_rules! numbers {
    ($($number:ty: $kind:expr),*) => { $(impl Number for $number { const KIND: u8 = $kind; })* };
}

numbers!(u8: 1, u16: 2, u32: 3, u64: 4, i8: 5, i16: 6, i32: 7, i64: 8, f32: 9, f64: 10);

/// Where an array lies in a file, and what it holds: an entry of the index, as it is in the file.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
pub struct Chunk {
    /// The frame, from 0.
    pub frame: u64,
    /// Number of rows.
    pub rows: u64,
    location: u64,
    /// Numbers in a row.
    pub columns: u32,
    /// The place of its name in the list.
    pub name: u16,
    /// Type of the numbers, as [`Number::KIND`]; 11 is text.
    pub kind: u8,
    flags: u8,
}

impl Chunk {
    /// Bytes of a number; none of an unknown type.
    pub(crate) fn size(self) -> Option<u64> {
        match self.kind {
            1 | 5 | 11 => Some(1),
            2 | 6 => Some(2),
            3 | 7 | 9 => Some(4),
            4 | 8 | 10 => Some(8),
            _ => None,
        }
    }

    /// Where it begins in the file.
    pub(crate) fn location(&self) -> u64 {
        self.location
    }

    fn bytes(self) -> Option<u64> {
        self.rows.checked_mul(self.columns.into())?.checked_mul(self.size()?)
    }
}

const fn version_word((major, minor): (u16, u16)) -> u32 {
    (major as u32) << 16 | minor as u32
}

/// The beginning of a file, as it is there.
#[repr(C)]
#[derive(Debug, Clone, Copy, Pod, Zeroable)]
struct Header {
    magic: u64,
    /// Where the index is, and the number of entries it has room for.
    index: [u64; 2],
    /// Where the names are, and the room for them in units of 64 bytes.
    names: [u64; 2],
    schema_version: u32,
    version: u32,
    application: [u8; NAME as usize],
    schema: [u8; NAME as usize],
    reserved: [u64; 10],
}

/// A text as the header has it, which is shorter than its field.
fn field(text: &str) -> [u8; NAME as usize] {
    let mut field = [0; NAME as usize];
    field[..text.len()].copy_from_slice(text.as_bytes());
    field
}

/// A text that is ended by a zero.
fn text(field: &[u8]) -> Cow<'_, str> {
    String::from_utf8_lossy(until_zero(field))
}

pub(super) fn until_zero(field: &[u8]) -> &[u8] {
    field.split(|byte| *byte == 0).next().unwrap_or_default()
}

/// A file that is read: nothing of it is kept in memory but its names.
#[derive(Debug)]
pub struct GsdReader {
    file: File,
    length: u64,
    header: Header,
    names: Vec<String>,
}

/// A place in the index of a file.
#[derive(Debug, Default)]
pub struct Cursor {
    /// Entries that were read.
    read: u64,
    piece: Vec<u8>,
    /// Bytes of the piece that were looked at.
    seen: usize,
    frame: u64,
}

impl GsdReader {
    /// Reads header and names.
    ///
    /// # Errors
    /// [`GsdError`] where it is no whole file of versions 1 or 2.
    pub fn new(mut file: File) -> Result<Self, GsdError> {
        let length = file.metadata()?.len();
        let mut start = Vec::new();
        file.seek(SeekFrom::Start(0))?;
        Read::by_ref(&mut file).take(HEADER).read_to_end(&mut start)?;
        if start.len() < HEADER as usize {
            return Err(if is_one(&start) { GsdError::Cut } else { GsdError::Format });
        }
        if !is_one(&start) {
            return Err(GsdError::Format);
        }
        let header: Header = bytemuck::pod_read_unaligned(&start);
        let version = header.version >> 16;
        if ![1, 2].contains(&version) {
            return Err(GsdError::Version(version));
        }
        let is_inside = |[location, count]: [u64; 2], size: u64| {
            count.checked_mul(size).and_then(|bytes| location.checked_add(bytes)).is_some_and(|end| end <= length)
        };
        if !is_inside(header.index, ENTRY) || !is_inside(header.names, NAME) || header.names[1] * NAME > MOST_NAMES {
            return Err(GsdError::Cut);
        }
        file.seek(SeekFrom::Start(header.names[0]))?;
        let mut list = vec![0; (header.names[1] * NAME) as usize];
        file.read_exact(&mut list)?;
        // One after the other, each ended by a zero; in version 1, each in its own field.
        let names: Vec<&[u8]> = if version == 1 {
            list.chunks(NAME as usize).map(until_zero).collect()
        } else {
            list.split(|byte| *byte == 0).collect()
        };
        let names = names.into_iter().take_while(|name| !name.is_empty());
        let names = names.map(|name| String::from_utf8_lossy(name).into_owned()).collect();
        Ok(Self { file, length, header, names })
    }

    /// The program that wrote the file.
    pub(crate) fn application(&self) -> Cow<'_, str> {
        text(&self.header.application)
    }

    /// What the names of arrays mean, by the name of a schema.
    #[must_use]
    pub fn schema(&self) -> Cow<'_, str> {
        text(&self.header.schema)
    }

    /// The version of the schema, major and minor.
    #[must_use]
    pub fn schema_version(&self) -> (u16, u16) {
        ((self.header.schema_version >> 16) as u16, self.header.schema_version as u16)
    }

    /// The name of an array; none where the list has no such place.
    pub(crate) fn name(&self, chunk: Chunk) -> Option<&str> {
        self.names.get(usize::from(chunk.name)).map(String::as_str)
    }

    /// The next array in the order of the index: frame by frame. None at its end.
    ///
    /// # Errors
    /// [`GsdError`] where the index cannot be read or makes no sense.
    pub(crate) fn next(&mut self, cursor: &mut Cursor) -> Result<Option<Chunk>, GsdError> {
        let [index, room] = self.header.index;
        if cursor.seen == cursor.piece.len() {
            let more = (room - cursor.read).min(PIECE as u64 / ENTRY);
            cursor.piece.resize((more * ENTRY) as usize, 0);
            self.file.seek(SeekFrom::Start(index + cursor.read * ENTRY))?;
            self.file.read_exact(&mut cursor.piece)?;
            (cursor.read, cursor.seen) = (cursor.read + more, 0);
        }
        let Some(entry) = cursor.piece.get(cursor.seen..cursor.seen + ENTRY as usize) else { return Ok(None) };
        let chunk = Chunk { flags: 0, ..bytemuck::pod_read_unaligned(entry) };
        if chunk.location == 0 {
            return Ok(None);
        }
        // An array without rows may begin where the file ends.
        if chunk.location > self.length || chunk.frame >= room || chunk.frame < cursor.frame {
            return Err(GsdError::Index);
        }
        (cursor.seen, cursor.frame) = (cursor.seen + ENTRY as usize, chunk.frame);
        Ok(Some(chunk))
    }

    /// Number of frames: those that have arrays, and all before them.
    ///
    /// # Errors
    /// As [`next`](Self::next).
    pub fn frames(&mut self) -> Result<u64, GsdError> {
        let (mut cursor, mut frames) = (Cursor::default(), 0);
        while let Some(chunk) = self.next(&mut cursor)? {
            frames = chunk.frame + 1;
        }
        Ok(frames)
    }

    /// The bytes of an array.
    ///
    /// # Errors
    /// [`GsdError`] where they cannot be read, or do not lie in the file.
    pub(crate) fn content(&mut self, chunk: Chunk) -> Result<impl Read + '_, GsdError> {
        let is_inside = |bytes: &u64| chunk.location.checked_add(*bytes).is_some_and(|end| end <= self.length);
        let bytes = chunk.bytes().filter(is_inside).ok_or(GsdError::Cut)?;
        self.file.seek(SeekFrom::Start(chunk.location))?;
        Ok(Read::by_ref(&mut self.file).take(bytes))
    }

    /// The rows of an array; none where the frame has no array of this name.
    ///
    /// # Errors
    /// [`GsdError`] where it holds other numbers, or cannot be read.
    pub fn array<T: Number, const M: usize>(
        &mut self,
        frame: u64,
        name: &str,
    ) -> Result<Option<Vec<[T; M]>>, GsdError> {
        let mut cursor = Cursor::default();
        while let Some(chunk) = self.next(&mut cursor)? {
            if chunk.frame == frame && self.name(chunk) == Some(name) {
                if chunk.kind != T::KIND || chunk.columns as usize != M {
                    return Err(GsdError::Array(name.to_owned()));
                }
                let mut bytes = Vec::new();
                self.content(chunk)?.read_to_end(&mut bytes)?;
                let numbers: Vec<T> = bytemuck::pod_collect_to_vec(&bytes);
                return Ok(Some(
                    numbers.chunks_exact(M).map(|row| std::array::from_fn(|column| row[column])).collect(),
                ));
            }
        }
        Ok(None)
    }
}

/// A file that is written. Frames reach the disk at [`sync`](Self::sync), and not when it is dropped.
///
/// ```
/// use mesoscope::state_file::{GsdReader, GsdWriter};
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("numbers.gsd");
/// let mut file = GsdWriter::create(&path, "an example", "numbers", (1, 0))?;
/// file.write("primes", [[2_u32, 3], [5, 7]])?;
/// file.end_frame();
/// file.sync()?;
/// let mut file = GsdReader::new(std::fs::File::open(&path)?)?;
/// assert_eq!(file.schema(), "numbers");
/// assert_eq!(file.frames()?, 1);
/// assert_eq!(file.array::<u32, 2>(0, "primes")?, Some(vec![[2, 3], [5, 7]]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct GsdWriter {
    file: File,
    header: Header,
    /// All names, and how many of them are in the file.
    names: Vec<String>,
    listed: usize,
    /// Entries in the file.
    indexed: u64,
    /// Arrays of frames that are not in the index yet, and how many of them belong to frames that have ended.
    chunks: Vec<Chunk>,
    ended: usize,
    frame: u64,
    /// Length of the file, and what follows.
    length: u64,
    buffer: Vec<u8>,
}

impl GsdWriter {
    /// Makes a file without frames, in place of one that may be there.
    ///
    /// # Errors
    /// Where it cannot be written, or a text has more than 63 bytes.
    pub fn create(path: &Path, application: &str, schema: &str, schema_version: (u16, u16)) -> io::Result<Self> {
        if application.len().max(schema.len()) >= NAME as usize {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "GSD holds 63 bytes of a name"));
        }
        let [entries, names] = ROOM;
        let header = Header {
            magic: MAGIC,
            index: [HEADER, entries],
            names: [HEADER + entries * ENTRY, names],
            schema_version: version_word(schema_version),
            version: VERSION,
            application: field(application),
            schema: field(schema),
            reserved: [0; 10],
        };
        let mut file = File::options().read(true).write(true).create(true).truncate(true).open(path)?;
        file.write_all(bytemuck::bytes_of(&header))?;
        let length = header.names[0] + names * NAME;
        file.set_len(length)?;
        file.sync_all()?;
        Ok(Self::from_reader(GsdReader { file, length, header, names: Vec::new() }, 0, 0))
    }

    /// Continues a file of version 2 that is open for writing.
    ///
    /// # Errors
    /// [`GsdError`] where its index cannot be read, or it has another version.
    pub(crate) fn append_to(mut reader: GsdReader) -> Result<Self, GsdError> {
        let version = reader.header.version >> 16;
        if version != VERSION >> 16 {
            return Err(GsdError::Version(version));
        }
        let (mut cursor, mut indexed, mut frame) = (Cursor::default(), 0, 0);
        while let Some(chunk) = reader.next(&mut cursor)? {
            (indexed, frame) = (indexed + 1, chunk.frame + 1);
        }
        Ok(Self::from_reader(reader, indexed, frame))
    }

    /// The writer that goes on after these entries and frames of a file.
    fn from_reader(file: GsdReader, indexed: u64, frame: u64) -> Self {
        let GsdReader { file, length, header, names } = file;
        let (listed, chunks, buffer) = (names.len(), Vec::new(), Vec::new());
        Self { file, header, names, listed, indexed, chunks, ended: 0, frame, length, buffer }
    }

    /// Adds an array to the frame.
    ///
    /// # Errors
    /// Where it cannot be written, the frame has an array of this name, or the file 65 536 names.
    pub fn write<T: Number, const M: usize>(
        &mut self,
        name: &str,
        rows: impl IntoIterator<Item = [T; M]>,
    ) -> io::Result<()> {
        let mut chunk = self.begin(name, T::KIND, M as u32)?;
        for row in rows {
            self.add(bytemuck::cast_slice(&row))?;
            chunk.rows += 1;
        }
        self.chunks.push(chunk);
        Ok(())
    }

    /// Adds an array of another file to the frame.
    ///
    /// # Errors
    /// As [`write`](Self::write), and [`GsdError`] of the other file.
    pub(crate) fn copy(&mut self, reader: &mut GsdReader, chunk: Chunk) -> Result<(), GsdError> {
        let name = reader.name(chunk).ok_or(GsdError::Index)?;
        let copy = Chunk { rows: chunk.rows, ..self.begin(name, chunk.kind, chunk.columns)? };
        let mut content = reader.content(chunk)?;
        let mut piece = vec![0; PIECE];
        let mut missing = chunk.bytes().unwrap_or(0);
        while missing > 0 {
            let part = &mut piece[..missing.min(PIECE as u64) as usize];
            content.read_exact(part)?;
            self.add(part)?;
            missing -= part.len() as u64;
        }
        self.chunks.push(copy);
        Ok(())
    }

    fn begin(&mut self, name: &str, kind: u8, columns: u32) -> io::Result<Chunk> {
        let refused = |reason: String| Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
        let place = self.names.iter().position(|known| known == name).unwrap_or(self.names.len());
        let Some(id) = u16::try_from(place).ok().filter(|_| !name.is_empty() && !name.contains('\0')) else {
            return refused(format!("GSD holds 65536 names without zeros, and `{name}` is none of them"));
        };
        if self.chunks[self.ended..].iter().any(|chunk| chunk.name == id) {
            return refused(format!("frame {} has two arrays `{name}`", self.frame));
        }
        if place == self.names.len() {
            self.names.push(name.to_owned());
        }
        let location = self.length + self.buffer.len() as u64;
        Ok(Chunk { frame: self.frame, rows: 0, location, columns, name: id, kind, flags: 0 })
    }

    fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.buffer.extend_from_slice(bytes);
        if self.buffer.len() >= PIECE { self.write_buffer() } else { Ok(()) }
    }

    fn write_buffer(&mut self) -> io::Result<()> {
        let bytes = std::mem::take(&mut self.buffer);
        self.write_at(self.length, &bytes)?;
        self.length += bytes.len() as u64;
        Ok(())
    }

    fn write_at(&mut self, place: u64, bytes: &[u8]) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(place))?;
        self.file.write_all(bytes)
    }

    /// Ends the frame; the next array belongs to the next one.
    pub fn end_frame(&mut self) {
        // Readers search the index for frame and name.
        self.chunks[self.ended..].sort_unstable_by_key(|chunk| chunk.name);
        self.ended = self.chunks.len();
        self.frame += 1;
    }

    /// The bytes of the list of names from one on.
    fn list(&self, from: usize) -> Vec<u8> {
        self.names[from..].iter().flat_map(|name| [name.as_bytes(), &[0]].concat()).collect()
    }

    /// Hands all frames that have ended to the disk.
    ///
    /// # Errors
    /// Where they cannot be written; the frames of the last time are still there.
    pub fn sync(&mut self) -> io::Result<()> {
        self.write_buffer()?;
        let mut header = self.header;
        self.list_names(&mut header)?;
        self.make_room(&mut header)?;
        self.file.sync_all()?;
        if (header.index, header.names) != (self.header.index, self.header.names) {
            self.write_at(0, bytemuck::bytes_of(&header))?;
            self.file.sync_all()?;
        }
        self.header = header;
        let entries: Vec<Chunk> = self.chunks.drain(..self.ended).collect();
        self.write_at(self.header.index[0] + self.indexed * ENTRY, bytemuck::cast_slice(&entries))?;
        self.indexed += self.ended as u64;
        self.ended = 0;
        self.file.sync_all()
    }

    /// Writes the names that are new, or all at the end of the file where they have no room.
    fn list_names(&mut self, header: &mut Header) -> io::Result<()> {
        let (new, all) = (self.list(self.listed), self.list(0));
        let [place, mut room] = header.names;
        if all.len() as u64 >= room * NAME {
            while all.len() as u64 >= room * NAME {
                room *= 2;
            }
            header.names = [self.length, room];
            self.write_at(self.length, &all)?;
            self.extend(room * NAME)?;
        } else {
            self.write_at(place + (all.len() - new.len()) as u64, &new)?;
        }
        self.listed = self.names.len();
        Ok(())
    }

    /// Copies the index to the end of the file where new entries have no room.
    fn make_room(&mut self, header: &mut Header) -> io::Result<()> {
        let [place, mut room] = header.index;
        let entries = self.indexed + self.ended as u64;
        if entries <= room {
            return Ok(());
        }
        while room <= entries {
            room *= 2;
        }
        header.index = [self.length, room];
        let mut piece = vec![0; PIECE];
        let mut copied = 0;
        while copied < self.indexed * ENTRY {
            let count = (self.indexed * ENTRY - copied).min(PIECE as u64);
            let piece = &mut piece[..count as usize];
            self.file.seek(SeekFrom::Start(place + copied))?;
            self.file.read_exact(piece)?;
            self.write_at(header.index[0] + copied, piece)?;
            copied += count;
        }
        self.extend(room * ENTRY)
    }

    /// Makes the file longer; what was not written is zero.
    fn extend(&mut self, bytes: u64) -> io::Result<()> {
        self.length += bytes;
        self.file.set_len(self.length)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Outcome = Result<(), Box<dyn std::error::Error>>;

    /// A file by the specification, number by number: of two frames, the second of which begins with the name that is second in the list.
    #[test]
    fn bytes_are_those_of_the_specification() -> Outcome {
        let directory = tempfile::tempdir()?;
        let path = directory.path().join("two.gsd");
        let mut file = GsdWriter::create(&path, "a program", "hoomd", (1, 4))?;
        file.write("a", [[1.5_f32, -2.0], [0.0, 4.0]])?;
        file.write("bc", [[7_u64]])?;
        file.end_frame();
        file.write("bc", [[8_u64]])?;
        file.write("a", [[9_i8]; 3])?;
        file.end_frame();
        file.sync()?;
        let (index, names, data) = (256, 256 + 128 * 32, 256 + 128 * 32 + 1024);
        let mut expected = vec![0; data];
        let mut place = |at: usize, bytes: &[u8]| expected[at..at + bytes.len()].copy_from_slice(bytes);
        for (at, word) in [0x65df_65df_65df_65df, index as u64, 128, names as u64, 16].into_iter().enumerate() {
            place(8 * at, &word.to_le_bytes());
        }
        place(40, &[4, 0, 1, 0, 1, 0, 2, 0]);
        place(48, b"a program");
        place(112, b"hoomd");
        place(names, b"a\0bc\0");
        // Frame, rows, location; columns; name and type.
        let entries: [(u64, u64, u64, u32, [u8; 4]); 4] = [
            (0, 2, data as u64, 2, [0, 0, 9, 0]),
            (0, 1, data as u64 + 16, 1, [1, 0, 4, 0]),
            (1, 3, data as u64 + 32, 1, [0, 0, 5, 0]),
            (1, 1, data as u64 + 24, 1, [1, 0, 4, 0]),
        ];
        for (at, (frame, rows, location, columns, rest)) in entries.into_iter().enumerate() {
            for (word, value) in [frame, rows, location].into_iter().enumerate() {
                place(index + 32 * at + 8 * word, &value.to_le_bytes());
            }
            place(index + 32 * at + 24, &columns.to_le_bytes());
            place(index + 32 * at + 28, &rest);
        }
        for value in [1.5_f32, -2.0, 0.0, 4.0] {
            expected.extend(value.to_le_bytes());
        }
        expected.extend([7_u64, 8].into_iter().flat_map(u64::to_le_bytes));
        expected.extend([9, 9, 9]);
        assert!(std::fs::read(&path)? == expected);
        Ok(())
    }

    /// Index and names move to the end of the file when they are full, one by one or at once; the bytes do not depend on whether the file was closed
    /// meanwhile.
    #[test]
    fn files_grow() -> Outcome {
        let directory = tempfile::tempdir()?;
        let name = |number: u32| format!("a name that is so long that twenty like it do not fit, number {number}");
        let write = |file: &mut GsdWriter, frame: u32| -> Outcome {
            for number in 0..=frame % 20 {
                file.write(&name(number), [[frame, number]])?;
            }
            file.end_frame();
            Ok(())
        };
        let mut found = Vec::new();
        for (every, closed) in [(1, false), (1, true), (100, false)] {
            let path = directory.path().join(format!("{every}{closed}.gsd"));
            let mut file = GsdWriter::create(&path, "a program", "numbers", (1, 0))?;
            for frame in 0..30 {
                write(&mut file, frame)?;
                if frame % every == 0 {
                    file.sync()?;
                    if closed {
                        file =
                            GsdWriter::append_to(GsdReader::new(File::options().read(true).write(true).open(&path)?)?)?;
                    }
                }
            }
            file.sync()?;
            found.push(std::fs::read(&path)?);
            let mut file = GsdReader::new(File::open(&path)?)?;
            assert_eq!((file.frames()?, file.header.index[1], file.header.names[1]), (30, 512, 32));
            for frame in [0, 19, 20, 29] {
                for number in [0, frame % 20] {
                    let array = file.array::<u32, 2>(frame.into(), &name(number))?;
                    assert_eq!(array, Some(vec![[frame, number]]), "{frame}, {number}");
                }
                assert_eq!(file.array::<u32, 2>(frame.into(), &name(frame % 20 + 1))?, None);
            }
        }
        assert!(found[0] == found[1]);
        Ok(())
    }

    /// A frame is there once all of it is on the disk, however much of it was written before.
    #[test]
    fn frames_appear_whole() -> Outcome {
        let directory = tempfile::tempdir()?;
        let path = directory.path().join("large.gsd");
        let frames = || -> Result<u64, GsdError> { GsdReader::new(File::open(&path)?)?.frames() };
        let mut file = GsdWriter::create(&path, "a program", "numbers", (1, 0))?;
        let large = || (0..PIECE as u32).map(|number| [number]);
        file.write("small", [[1_u8]])?;
        file.end_frame();
        file.sync()?;
        file.write("small", [[2_u8]])?;
        file.write("large", large())?;
        assert!(std::fs::metadata(&path)?.len() > PIECE as u64);
        assert_eq!(frames()?, 1);
        // Frames that have ended do not take one along that has not.
        file.sync()?;
        assert_eq!(frames()?, 1);
        file.end_frame();
        assert_eq!(frames()?, 1);
        file.sync()?;
        assert_eq!(frames()?, 2);
        let mut reader = GsdReader::new(File::open(&path)?)?;
        assert_eq!(reader.array::<u32, 1>(1, "large")?, Some(large().collect()));
        assert!(matches!(reader.array::<i32, 1>(1, "large"), Err(GsdError::Array(name)) if name == "large"));
        let refused = file.write("small", [[3_u8]]).and_then(|()| file.write("small", [[4_u8]]));
        assert!(refused.is_err_and(|error| error.to_string() == "frame 2 has two arrays `small`"));
        Ok(())
    }
}
