//! The state to resume from, as one binary file.
//!
//! All integers are little-endian:
//!
//! ```text
//! magic            8 bytes   "MESOCKPT"
//! format version   u32
//! payload length   u64
//! payload
//!     run id       u64 length, text
//!     scene        u64 length, JSON in UTF-8
//!     step         u64
//!     particles    u64 N
//!     positions    N × 3 u32
//!     momenta      N × 3 i32
//!     species      N u32
//!     arrays       u64 count, of those that are not empty; each: u64 length, name in UTF-8; u64 count, that many u32
//!     files        u64 count, of those that grow; each: u64 length, name in UTF-8; u64 bytes, u32 CRC-32
//!     sections     u64 count; each: u64 length, name in UTF-8; u64 length, bytes
//! checksum         u64       FNV-1a of the payload
//! ```

mod read;

use super::{Extent, Id, OutputError, write_atomically};
use crate::families::Checked;
use crate::scene::{Scene, SceneError};
use crate::state::{State, StateArray};
pub use crate::state_file::checkpoint::ContentError;
use crate::state_file::checkpoint::{Fnv, MAGIC, START, VERSION};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

pub(super) use read::id_of;
pub use read::load;

/// Everything a run needs to continue as if it had never stopped.
#[derive(Debug, Clone, PartialEq)]
pub struct Checkpoint {
    /// The id of the run.
    pub run_id: Id,
    /// The resolved scene.
    pub scene: Checked,
    /// The exact state.
    pub state: State,
    /// What had been written by then of the files that grow, by name: the table of energies and the trajectory.
    pub files: Vec<(String, Extent)>,
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
    /// The file is no checkpoint of this version, or damaged.
    #[error("`{}` {source}", crate::printable::path(path))]
    Content {
        /// The file.
        path: PathBuf,
        /// The reason.
        source: ContentError,
    },
    /// The scene in it is refused, as it would be in a file of its own.
    #[error("`{}` is no valid checkpoint: {source}", crate::printable::path(path))]
    Scene {
        /// The file.
        path: PathBuf,
        /// The mistakes of the scene.
        source: SceneError,
    },
}

impl CheckpointError {
    /// That the content of a file passes the checksum and makes no sense.
    pub(crate) fn malformed(path: &Path, problem: String) -> Self {
        Self::Content { path: path.to_path_buf(), source: ContentError::Malformed(problem) }
    }
}

/// Writes a checkpoint of a run, its scene and state, which replaces an earlier one only when it is complete on the disk.
///
/// ```
/// use mesoscope::output::{Id, checkpoint};
/// use mesoscope::families;
/// use mesoscope::scene;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("checkpoint.bin");
/// let scene = scene::load("dpd-fluid", &[])?;
/// let state = mesoscope::families::initial_state(&scene);
/// checkpoint::save(&path, Id::of_run(&scene), &scene, &state, &[], &[])?;
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
pub fn save(
    path: &Path,
    run_id: Id,
    scene: &Scene,
    state: &State,
    files: &[(String, Extent)],
    sections: &[(String, Vec<u8>)],
) -> Result<(), OutputError> {
    let start = scene.start().map(|start| (START.to_owned(), start.to_bytes()));
    let scene = serde_json::to_vec(scene).map_err(|source| OutputError::Json { path: path.to_path_buf(), source })?;
    let sections: Vec<&(String, Vec<u8>)> = start.iter().chain(sections).collect();
    let mut arrays = StateArray::ALL.map(|array| (array.name(), state.words(array))).to_vec();
    arrays.retain(|(_, words)| !words.is_empty());
    let run_id = run_id.to_string();
    let content = |payload: &mut Payload<'_>| -> io::Result<()> {
        payload.counted(run_id.as_bytes())?;
        payload.counted(&scene)?;
        payload.number(state.step)?;
        payload.number(state.len() as u64)?;
        payload.words(bytemuck::cast_slice(&state.positions))?;
        payload.words(bytemuck::cast_slice(&state.momenta))?;
        payload.words(&state.species)?;
        payload.number(arrays.len() as u64)?;
        for (name, words) in &arrays {
            payload.counted(name.as_bytes())?;
            payload.number(words.len() as u64)?;
            payload.words(words)?;
        }
        payload.number(files.len() as u64)?;
        for (name, extent) in files {
            payload.counted(name.as_bytes())?;
            payload.number(extent.bytes)?;
            payload.bytes(&extent.crc32.to_le_bytes())?;
        }
        payload.number(sections.len() as u64)?;
        for (name, bytes) in &sections {
            payload.counted(name.as_bytes())?;
            payload.counted(bytes)?;
        }
        Ok(())
    };
    write_atomically(path, |writer| {
        if state.momenta.len() != state.len() || state.species.len() != state.len() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "the arrays of the state differ in length"));
        }
        // Its length comes before the content.
        let mut counted = Payload { writer: &mut io::sink(), checksum: None, written: 0 };
        content(&mut counted)?;
        writer.write_all(&MAGIC)?;
        writer.write_all(&VERSION.to_le_bytes())?;
        writer.write_all(&counted.written.to_le_bytes())?;
        let mut sum = Fnv::new();
        content(&mut Payload { writer, checksum: Some(&mut sum), written: 0 })?;
        writer.write_all(&sum.0.to_le_bytes())
    })
}

struct Payload<'a> {
    writer: &'a mut dyn Write,
    checksum: Option<&'a mut Fnv>,
    written: u64,
}

impl Payload<'_> {
    fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some(checksum) = &mut self.checksum {
            checksum.add(bytes);
        }
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
