//! The state to resume from, as one binary file.
//!
//! All integers are little-endian:
//!
//! ```text
//! magic            8 bytes   "MESOCKPT"
//! format version   u32
//! payload length   u64
//! payload
//!     scene        u64 length, JSON in UTF-8
//!     step         u64
//!     particles    u64 N
//!     positions    N × 3 u32
//!     momenta      N × 3 i32
//!     species      N u32
//!     arrays       u64 count, of those that are not empty; each: u64 length, name in UTF-8; u64 count, that many u32
//!     sections     u64 count; each: u64 length, name in UTF-8; u64 length, bytes
//! checksum         u64       FNV-1a of the payload
//! ```

use super::{OutputError, write_atomically};
use crate::scene::Scene;
use crate::state::State;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

const MAGIC: [u8; 8] = *b"MESOCKPT";
const VERSION: u32 = 3;
const HEADER: usize = 8 + 4 + 8;
const CHECKSUM: usize = 8;

/// Everything a run needs to go on as if it had never stopped.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    /// The resolved scene.
    pub scene: Scene,
    /// The exact state.
    pub state: State,
    /// What unfinished analyses have gathered: a name and bytes only the analysis understands.
    pub sections: Vec<(String, Vec<u8>)>,
}

/// Why a file cannot be read as a checkpoint.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file cannot be read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The file is something else.
    #[error("`{}` is not a checkpoint of mesoscope", crate::printable::path(path))]
    Magic {
        /// The file.
        path: PathBuf,
    },
    /// The file was written by another version of the format.
    #[error(
        "`{}` has checkpoint format {found}, and this program reads format {VERSION}; resume with the version of mesoscope that wrote it",
        crate::printable::path(path)
    )]
    Version {
        /// The file.
        path: PathBuf,
        /// The version in the file.
        found: u32,
    },
    /// The file ends too early, or goes on too long.
    #[error(
        "`{}` should have {expected} bytes and has {found}: it was cut short or altered",
        crate::printable::path(path)
    )]
    Length {
        /// The file.
        path: PathBuf,
        /// Length the header announces.
        expected: u128,
        /// Length of the file.
        found: u64,
    },
    /// The content is not what was written.
    #[error("`{}` is damaged: its checksum does not match its content", crate::printable::path(path))]
    Checksum {
        /// The file.
        path: PathBuf,
    },
    /// The content passes the checksum and makes no sense.
    #[error("`{}` is no valid checkpoint: {problem}", crate::printable::path(path))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        problem: String,
    },
}

/// Writes a checkpoint of `scene` and `state`, which replaces an earlier one only when it is complete on the disk.
///
/// ```
/// use mesoscope::output::checkpoint;
/// use mesoscope::{model::Model, scene};
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("checkpoint.bin");
/// let scene = scene::load("dpd-fluid", &[])?;
/// let state = scene::placement::initial_state(&scene, &Model::new(&scene));
/// checkpoint::save(&path, &scene, &state, &[])?;
/// let found = checkpoint::load(&path)?;
/// assert!(found.scene == scene && found.state == state);
///
/// // What is not exactly what was written is refused.
/// std::fs::write(&path, &std::fs::read(&path)?[..1000])?;
/// assert!(checkpoint::load(&path).is_err_and(|error| error.to_string().contains("it was cut short")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`OutputError::Io`] when the file cannot be written; an earlier checkpoint is then still there.
pub fn save(path: &Path, scene: &Scene, state: &State, sections: &[(String, Vec<u8>)]) -> Result<(), OutputError> {
    let scene = serde_json::to_vec(scene).map_err(|source| OutputError::Json { path: path.to_path_buf(), source })?;
    let sections_length: u64 = sections.iter().map(|(name, bytes)| 16 + name.len() as u64 + bytes.len() as u64).sum();
    let mut arrays = state.arrays().to_vec();
    arrays.retain(|(_, words)| !words.is_empty());
    let length = 8
        + scene.len() as u64
        + 16
        + 28 * state.len() as u64
        + 8
        + arrays.iter().map(|(name, words)| 16 + name.len() as u64 + 4 * words.len() as u64).sum::<u64>()
        + 8
        + sections_length;
    write_atomically(path, |writer| {
        writer.write_all(&MAGIC)?;
        writer.write_all(&VERSION.to_le_bytes())?;
        writer.write_all(&length.to_le_bytes())?;
        let mut payload = Payload { writer, checksum: Fnv::new(), written: 0 };
        payload.counted(&scene)?;
        payload.number(state.step)?;
        payload.number(state.len() as u64)?;
        payload.words(bytemuck::cast_slice(&state.positions))?;
        payload.words(bytemuck::cast_slice(&state.momenta))?;
        payload.words(&state.species)?;
        payload.number(arrays.len() as u64)?;
        for (name, words) in arrays {
            payload.counted(name.as_bytes())?;
            payload.number(words.len() as u64)?;
            payload.words(words)?;
        }
        payload.number(sections.len() as u64)?;
        for (name, bytes) in sections {
            payload.counted(name.as_bytes())?;
            payload.counted(bytes)?;
        }
        if payload.written != length {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the arrays of the state differ in length"));
        }
        let checksum = payload.checksum.0;
        writer.write_all(&checksum.to_le_bytes())
    })
}

/// Reads a checkpoint and checks all of it.
///
/// # Errors
/// A [`CheckpointError`] for whatever is not exactly as [`save`] writes it.
pub fn load(path: &Path) -> Result<Checkpoint, CheckpointError> {
    let bytes = read_regular_file(path)?;
    let own = || path.to_path_buf();
    let payload = payload_of(path, &bytes)?;
    let malformed = |problem: String| CheckpointError::Malformed { path: own(), problem };
    let mut reader = Reader { rest: payload };
    let (scene, mut state, arrays, sections) =
        reader.content().ok_or_else(|| malformed("a length is wrong".to_owned()))?;
    for (name, words) in arrays {
        state.set_array(&name, &words).map_err(malformed)?;
    }
    let scene: Scene = serde_json::from_slice(scene).map_err(|error| malformed(format!("its scene: {error}")))?;
    if let Some(name) = state.misshapen() {
        return Err(malformed(format!("some particles have `{name}` and others none")));
    }
    Ok(Checkpoint { scene, state, sections })
}

fn read_regular_file(path: &Path) -> Result<Vec<u8>, OutputError> {
    let read = || -> io::Result<Vec<u8>> {
        let mut file = File::open(path)?;
        let metadata = file.metadata()?;
        // A device may never end.
        if !metadata.is_file() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
        }
        let mut bytes = Vec::new();
        bytes.try_reserve_exact(usize::try_from(metadata.len()).unwrap_or(usize::MAX))?;
        file.read_to_end(&mut bytes)?;
        Ok(bytes)
    };
    read().map_err(OutputError::io("read the checkpoint", path))
}

/// The payload, once everything around it is known to be right.
fn payload_of<'a>(path: &Path, bytes: &'a [u8]) -> Result<&'a [u8], CheckpointError> {
    let path = || path.to_path_buf();
    if !bytes.starts_with(&MAGIC[..MAGIC.len().min(bytes.len())]) || bytes.is_empty() {
        return Err(CheckpointError::Magic { path: path() });
    }
    let found = bytes.len() as u64;
    let too_short = || CheckpointError::Length { path: path(), expected: (HEADER + CHECKSUM) as u128, found };
    let mut header = Reader { rest: bytes.get(MAGIC.len()..).ok_or_else(too_short)? };
    let version = header.take(4).and_then(|word| word.try_into().ok()).map(u32::from_le_bytes);
    let version = version.ok_or_else(too_short)?;
    if version != VERSION {
        return Err(CheckpointError::Version { path: path(), found: version });
    }
    let length = header.number().ok_or_else(too_short)?;
    let expected = (HEADER + CHECKSUM) as u128 + u128::from(length);
    if expected != u128::from(found) {
        return Err(CheckpointError::Length { path: path(), expected, found });
    }
    let (payload, checksum) = header.rest.split_at(header.rest.len() - CHECKSUM);
    let mut sum = Fnv::new();
    sum.add(payload);
    if sum.0.to_le_bytes() != checksum {
        return Err(CheckpointError::Checksum { path: path() });
    }
    Ok(payload)
}

/// FNV-1a with 64 bits. Each step is a bijection of the sum, so no change of a single byte goes unseen.
struct Fnv(u64);

impl Fnv {
    fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    fn add(&mut self, bytes: &[u8]) {
        for byte in bytes {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

struct Payload<'a> {
    writer: &'a mut dyn Write,
    checksum: Fnv,
    written: u64,
}

impl Payload<'_> {
    fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.checksum.add(bytes);
        self.written += bytes.len() as u64;
        self.writer.write_all(bytes)
    }

    fn number(&mut self, number: u64) -> io::Result<()> {
        self.bytes(&number.to_le_bytes())
    }

    fn counted(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.number(bytes.len() as u64)?;
        self.bytes(bytes)
    }

    fn words(&mut self, words: &[u32]) -> io::Result<()> {
        for chunk in words.chunks(1 << 14) {
            let chunk: Vec<u32> = chunk.iter().map(|word| word.to_le()).collect();
            self.bytes(bytemuck::cast_slice(&chunk))?;
        }
        Ok(())
    }
}

/// Takes pieces off the front of a slice; `None` when there is less than asked for. Nothing is allocated before its
/// bytes are known to be there.
struct Reader<'a> {
    rest: &'a [u8],
}

type Content<'a> = (&'a [u8], State, Vec<(String, Vec<u32>)>, Vec<(String, Vec<u8>)>);

impl<'a> Reader<'a> {
    fn take(&mut self, length: u64) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(usize::try_from(length).ok()?)?;
        self.rest = rest;
        Some(taken)
    }

    fn number(&mut self) -> Option<u64> {
        Some(u64::from_le_bytes(self.take(8)?.try_into().ok()?))
    }

    fn counted(&mut self) -> Option<&'a [u8]> {
        let length = self.number()?;
        self.take(length)
    }

    fn words(&mut self, count: u64) -> Option<Vec<u32>> {
        let bytes = self.take(count.checked_mul(4)?)?;
        let mut words: Vec<u32> = bytemuck::pod_collect_to_vec(bytes);
        for word in &mut words {
            *word = u32::from_le(*word);
        }
        Some(words)
    }

    fn counted_words(&mut self) -> Option<Vec<u32>> {
        let count = self.number()?;
        self.words(count)
    }

    fn vectors<T: bytemuck::Pod>(&mut self, count: u64) -> Option<Vec<[T; 3]>> {
        Some(bytemuck::cast_slice(&self.words(count.checked_mul(3)?)?).to_vec())
    }

    fn content(&mut self) -> Option<Content<'a>> {
        let scene = self.counted()?;
        let step = self.number()?;
        let count = self.number()?;
        let positions = self.vectors(count)?;
        let momenta = self.vectors(count)?;
        let species = self.words(count)?;
        let mut arrays = Vec::new();
        for _ in 0..self.number()? {
            let name = std::str::from_utf8(self.counted()?).ok()?.to_owned();
            arrays.push((name, self.counted_words()?));
        }
        let mut sections = Vec::new();
        for _ in 0..self.number()? {
            let name = std::str::from_utf8(self.counted()?).ok()?.to_owned();
            sections.push((name, self.counted()?.to_vec()));
        }
        let state = State { step, positions, momenta, species, ..State::default() };
        self.rest.is_empty().then_some((scene, state, arrays, sections))
    }
}
