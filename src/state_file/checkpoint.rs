//! The bytes of a checkpoint, before anything is made of them: everything is checked, and nothing is allocated that is not in the
//! file. `output::checkpoint` says how it is laid out, and writes it.

use crate::state::{State, StateArray};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};

/// Name of the checkpoint in the directory of a run.
pub const FILE: &str = "checkpoint.bin";

/// Name of the section that holds what a scene needs of the file that its particles started from.
pub(crate) const START: &str = "start";

pub(crate) const MAGIC: [u8; 8] = *b"MESOCKPT";
pub(crate) const VERSION: u32 = 5;
/// Magic, version and length of the payload.
pub(crate) const HEADER: usize = 8 + 4 + 8;
pub(crate) const CHECKSUM: usize = 8;

/// What a checkpoint holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Content {
    pub run_id: String,
    /// The resolved scene, as JSON.
    pub scene: String,
    pub state: State,
    /// Files that grow: names, and their bytes and CRC-32 by then.
    pub files: Vec<(String, u64, u32)>,
    pub sections: Vec<(String, Vec<u8>)>,
}

/// Why a file is no checkpoint.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ContentError {
    /// It cannot be read.
    #[error("cannot be read ({0})")]
    Io(io::Error),
    /// It is something else.
    #[error("is not a checkpoint of mesoscope")]
    Magic,
    /// It was written by another version of the format.
    #[error(
        "has checkpoint format {found}, and this program reads format {VERSION}; resume with the version of mesoscope that wrote it"
    )]
    Version {
        /// The version in the file.
        found: u32,
    },
    /// It is too short or too long.
    #[error("should have {expected} bytes and has {found}: it was cut short or altered")]
    Length {
        /// Length that the header announces.
        expected: u128,
        /// Length of the file.
        found: u64,
    },
    /// Its content is not what was written.
    #[error("is damaged: its checksum does not match its content")]
    Checksum,
    /// Its content passes the checksum and makes no sense.
    #[error("is no valid checkpoint: {0}")]
    Malformed(String),
}

impl From<io::Error> for ContentError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

/// FNV-1a with 64 bits. Each step is a bijection of the sum, so no change of a single byte goes unseen.
pub(crate) struct Fnv(pub(crate) u64);

impl Fnv {
    pub(crate) fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub(crate) fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

/// Bytes read at once.
pub(crate) const BUFFER: usize = 1 << 16;

/// Reads a checkpoint. `check` sees its scene, step and number of particles before the arrays are read; its error is the
/// inner one.
pub(crate) fn read<E>(
    mut file: File,
    check: impl FnOnce(&str, u64, u64) -> Result<(), E>,
) -> Result<Result<Content, E>, ContentError> {
    let length = check_envelope(&mut file)?;
    // What was checked is read once more, rather than kept: a state may fill the memory.
    file.seek(SeekFrom::Start(HEADER as u64))?;
    let mut payload = Payload { file: BufReader::with_capacity(BUFFER, file), left: length };
    let (run_id, scene) = (payload.text()?, payload.text()?);
    let (step, count) = (payload.number()?, payload.number()?);
    if let Err(refusal) = check(&scene, step, count) {
        return Ok(Err(refusal));
    }
    let content = payload.content(run_id, scene, step, count)?;
    if payload.left > 0 {
        return Err(malformed(format!("{} bytes follow its content", payload.left)));
    }
    Ok(Ok(content))
}

/// Checks everything around the payload, and its checksum; returns its length.
fn check_envelope(file: &mut File) -> Result<u64, ContentError> {
    let found = file.metadata()?.len();
    let mut start = Vec::new();
    file.take(HEADER as u64).read_to_end(&mut start)?;
    let magic = start.len().min(MAGIC.len());
    if start.is_empty() || start[..magic] != MAGIC[..magic] {
        return Err(ContentError::Magic);
    }
    let too_short = || ContentError::Length { expected: (HEADER + CHECKSUM) as u128, found };
    let (_, rest) = start.split_at_checked(MAGIC.len()).ok_or_else(too_short)?;
    let (version, rest) = rest.split_first_chunk().ok_or_else(too_short)?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(ContentError::Version { found: version });
    }
    let length = rest.first_chunk().copied().map(u64::from_le_bytes).ok_or_else(too_short)?;
    let expected = (HEADER + CHECKSUM) as u128 + u128::from(length);
    if expected != u128::from(found) {
        return Err(ContentError::Length { expected, found });
    }
    let mut sum = Fnv::new();
    let mut buffer = vec![0; BUFFER];
    let mut left = length;
    while left > 0 {
        let some = buffer.len().min(usize::try_from(left).unwrap_or(usize::MAX));
        file.read_exact(&mut buffer[..some])?;
        sum.add(&buffer[..some]);
        left -= some as u64;
    }
    let mut checksum = [0; CHECKSUM];
    file.read_exact(&mut checksum)?;
    if sum.0.to_le_bytes() == checksum { Ok(length) } else { Err(ContentError::Checksum) }
}

/// What is left to read of a payload. No length is believed that goes beyond its end.
struct Payload {
    file: BufReader<File>,
    left: u64,
}

fn malformed(problem: impl Into<String>) -> ContentError {
    ContentError::Malformed(problem.into())
}

impl Payload {
    /// Elements that follow, if there are as many.
    fn elements<T: bytemuck::Pod>(&mut self, count: u64) -> Result<Vec<T>, ContentError> {
        let bytes = count.checked_mul(size_of::<T>() as u64).filter(|bytes| *bytes <= self.left);
        let (Some(bytes), Ok(count)) = (bytes, usize::try_from(count)) else {
            return Err(malformed("a length is wrong"));
        };
        let mut elements = vec![T::zeroed(); count];
        self.file.read_exact(bytemuck::cast_slice_mut(&mut elements))?;
        self.left -= bytes;
        Ok(elements)
    }

    /// Elements made of words.
    fn words<T: bytemuck::Pod>(&mut self, count: u64) -> Result<Vec<T>, ContentError> {
        let mut elements = self.elements(count)?;
        if cfg!(target_endian = "big") {
            for word in bytemuck::cast_slice_mut::<T, u32>(&mut elements) {
                *word = u32::from_le(*word);
            }
        }
        Ok(elements)
    }

    fn number(&mut self) -> Result<u64, ContentError> {
        Ok(u64::from_le_bytes(self.elements(8)?.try_into().unwrap_or_default()))
    }

    fn text(&mut self) -> Result<String, ContentError> {
        let length = self.number()?;
        String::from_utf8(self.elements(length)?).map_err(|_| malformed("a text is not UTF-8"))
    }

    /// All that follows the number of particles.
    fn content(&mut self, run_id: String, scene: String, step: u64, count: u64) -> Result<Content, ContentError> {
        let (positions, momenta, species) = (self.words(count)?, self.words(count)?, self.words(count)?);
        let mut state = State { step, positions, momenta, species, ..State::default() };
        let mut known: Vec<String> = Vec::new();
        for _ in 0..self.number()? {
            let name = self.text()?;
            let count = self.number()?;
            let words = self.words(count)?;
            if known.contains(&name) {
                return Err(malformed(format!("it holds `{}` twice", name.escape_debug())));
            }
            let array = StateArray::ALL.into_iter().find(|array| array.name() == name);
            let array =
                array.ok_or_else(|| malformed(format!("it holds an unknown array `{}`", name.escape_debug())))?;
            state.set_words(array, &words).map_err(malformed)?;
            known.push(name);
        }
        if let Some(array) = state.misshapen() {
            return Err(malformed(format!("some particles have `{}` and others none", array.name())));
        }
        let mut files = Vec::new();
        for _ in 0..self.number()? {
            let (name, bytes) = (self.text()?, self.number()?);
            let crc32 = u32::from_le_bytes(self.elements(4)?.try_into().unwrap_or_default());
            files.push((name, bytes, crc32));
        }
        let mut sections = Vec::new();
        for _ in 0..self.number()? {
            let name = self.text()?;
            let length = self.number()?;
            sections.push((name, self.elements(length)?));
        }
        Ok(Content { run_id, scene, state, files, sections })
    }
}
