//! Reading a checkpoint: everything is checked before it is believed, and nothing is allocated that is not in the file.

use super::{CHECKSUM, Checkpoint, CheckpointError, Fnv, HEADER, MAGIC, VERSION};
use crate::families::Model;
use crate::output::{Extent, Id, OutputError};
use crate::scene::{self, Scene};
use crate::state::{State, StateArray};
use std::fs::File;
use std::io::{self, BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// Reads a checkpoint and checks all of it: the checksum, then the scene as any other scene, then whether there are as many
/// particles as it asks for.
///
/// # Errors
/// A [`CheckpointError`] for whatever is not exactly as [`save`](super::save) writes it.
pub fn load(path: &Path) -> Result<Checkpoint, CheckpointError> {
    let mut file = open_regular_file(path).map_err(OutputError::io("read the checkpoint", path))?;
    let length = check_envelope(path, &mut file)?;
    // What was checked is read once more, rather than kept: a state may fill the memory.
    file.seek(SeekFrom::Start(HEADER as u64)).map_err(OutputError::io("read the checkpoint", path))?;
    let mut payload = Payload { path, file: BufReader::with_capacity(BUFFER, file), left: length };
    let checkpoint = payload.checkpoint()?;
    if payload.left > 0 {
        return Err(payload.malformed(format!("{} bytes follow its content", payload.left)));
    }
    Ok(checkpoint)
}

/// The id of the run that wrote a checkpoint, of which only the beginning is read; none where it cannot be.
pub(in crate::output) fn id_of(path: &Path) -> Option<Id> {
    let mut beginning = Vec::new();
    open_regular_file(path).ok()?.take(BUFFER as u64).read_to_end(&mut beginning).ok()?;
    let payload = beginning.strip_prefix(&MAGIC)?.strip_prefix(&VERSION.to_le_bytes())?.get(8..)?;
    let (length, rest) = payload.split_first_chunk()?;
    let text = rest.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
    Id::parse(std::str::from_utf8(text).ok()?)
}

/// Bytes read at once.
const BUFFER: usize = 1 << 16;

fn open_regular_file(path: &Path) -> io::Result<File> {
    let file = File::open(path)?;
    // A device may never end.
    if !file.metadata()?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
    Ok(file)
}

/// Checks everything around the payload, and its checksum; returns its length.
fn check_envelope(path: &Path, file: &mut File) -> Result<u64, CheckpointError> {
    let own = || path.to_path_buf();
    let read = |error| OutputError::io("read the checkpoint", path)(error);
    let found = file.metadata().map_err(read)?.len();
    let mut start = Vec::new();
    file.take(HEADER as u64).read_to_end(&mut start).map_err(read)?;
    let magic = start.len().min(MAGIC.len());
    if start.is_empty() || start[..magic] != MAGIC[..magic] {
        return Err(CheckpointError::Magic { path: own() });
    }
    let too_short = || CheckpointError::Length { path: own(), expected: (HEADER + CHECKSUM) as u128, found };
    let (_, rest) = start.split_at_checked(MAGIC.len()).ok_or_else(too_short)?;
    let (version, rest) = rest.split_first_chunk().ok_or_else(too_short)?;
    let version = u32::from_le_bytes(*version);
    if version != VERSION {
        return Err(CheckpointError::Version { path: own(), found: version });
    }
    let length = rest.first_chunk().copied().map(u64::from_le_bytes).ok_or_else(too_short)?;
    let expected = (HEADER + CHECKSUM) as u128 + u128::from(length);
    if expected != u128::from(found) {
        return Err(CheckpointError::Length { path: own(), expected, found });
    }
    let mut sum = Fnv::new();
    let mut buffer = vec![0; BUFFER];
    let mut left = length;
    while left > 0 {
        let some = buffer.len().min(usize::try_from(left).unwrap_or(usize::MAX));
        file.read_exact(&mut buffer[..some]).map_err(read)?;
        sum.add(&buffer[..some]);
        left -= some as u64;
    }
    let mut checksum = [0; CHECKSUM];
    file.read_exact(&mut checksum).map_err(read)?;
    if sum.0.to_le_bytes() == checksum { Ok(length) } else { Err(CheckpointError::Checksum { path: own() }) }
}

/// What is left to read of a payload. No length is believed that goes beyond its end.
struct Payload<'a> {
    path: &'a Path,
    file: BufReader<File>,
    left: u64,
}

impl Payload<'_> {
    fn malformed(&self, problem: impl Into<String>) -> CheckpointError {
        CheckpointError::Malformed { path: self.path.to_path_buf(), problem: problem.into() }
    }

    /// Elements that follow, if there are as many.
    fn elements<T: bytemuck::Pod>(&mut self, count: u64) -> Result<Vec<T>, CheckpointError> {
        let bytes = count.checked_mul(size_of::<T>() as u64).filter(|bytes| *bytes <= self.left);
        let (Some(bytes), Ok(count)) = (bytes, usize::try_from(count)) else {
            return Err(self.malformed("a length is wrong"));
        };
        let mut elements = vec![T::zeroed(); count];
        self.file
            .read_exact(bytemuck::cast_slice_mut(&mut elements))
            .map_err(OutputError::io("read the checkpoint", self.path))?;
        self.left -= bytes;
        Ok(elements)
    }

    /// Elements made of words.
    fn words<T: bytemuck::Pod>(&mut self, count: u64) -> Result<Vec<T>, CheckpointError> {
        let mut elements = self.elements(count)?;
        if cfg!(target_endian = "big") {
            for word in bytemuck::cast_slice_mut::<T, u32>(&mut elements) {
                *word = u32::from_le(*word);
            }
        }
        Ok(elements)
    }

    fn number(&mut self) -> Result<u64, CheckpointError> {
        Ok(u64::from_le_bytes(self.elements(8)?.try_into().unwrap_or_default()))
    }

    fn text(&mut self) -> Result<String, CheckpointError> {
        let length = self.number()?;
        String::from_utf8(self.elements(length)?).map_err(|_| self.malformed("a text is not UTF-8"))
    }

    fn checkpoint(&mut self) -> Result<Checkpoint, CheckpointError> {
        let run_id = self.run_id()?;
        let scene = self.scene()?;
        let (step, count) = (self.number()?, self.number()?);
        let (last, asked) = (scene.time.steps, Model::new(&scene).particle_count());
        if step > last {
            return Err(self.malformed(format!("it is of step {step}, and its scene ends with step {last}")));
        }
        if count != asked {
            return Err(self.malformed(format!("it has {count} particles, and its scene {asked}")));
        }
        let (positions, momenta, species) = (self.words(count)?, self.words(count)?, self.words(count)?);
        let mut state = State { step, positions, momenta, species, ..State::default() };
        let mut known: Vec<String> = Vec::new();
        for _ in 0..self.number()? {
            let name = self.text()?;
            let count = self.number()?;
            let words = self.words(count)?;
            if known.contains(&name) {
                return Err(self.malformed(format!("it holds `{}` twice", name.escape_debug())));
            }
            let array = StateArray::ALL.into_iter().find(|array| array.name() == name);
            let array =
                array.ok_or_else(|| self.malformed(format!("it holds an unknown array `{}`", name.escape_debug())))?;
            state.set_words(array, &words).map_err(|problem| self.malformed(problem))?;
            known.push(name);
        }
        if let Some(array) = state.misshapen() {
            return Err(self.malformed(format!("some particles have `{}` and others none", array.name())));
        }
        let mut files = Vec::new();
        for _ in 0..self.number()? {
            let (name, bytes) = (self.text()?, self.number()?);
            let crc32 = u32::from_le_bytes(self.elements(4)?.try_into().unwrap_or_default());
            files.push((name, Extent { bytes, crc32 }));
        }
        let mut sections = Vec::new();
        for _ in 0..self.number()? {
            let name = self.text()?;
            let length = self.number()?;
            sections.push((name, self.elements(length)?));
        }
        Ok(Checkpoint { run_id, scene, state, files, sections })
    }

    fn run_id(&mut self) -> Result<Id, CheckpointError> {
        let text = self.text()?;
        Id::parse(&text).ok_or_else(|| self.malformed("its run id is none"))
    }

    fn scene(&mut self) -> Result<Scene, CheckpointError> {
        let text = self.text()?;
        scene::parse("its scene", &text, &[])
            .map_err(|source| CheckpointError::Scene { path: self.path.to_path_buf(), source })
    }
}
