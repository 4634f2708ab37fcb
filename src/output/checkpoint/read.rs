//! Reading a checkpoint: everything is checked before it is believed.

use super::{Checkpoint, CheckpointError};
use crate::families::Checked;
use crate::numbers::counted;
use crate::output::{Extent, Id, OutputError, own_file};
use crate::scene::{FileStart, WrittenScene};
use crate::state_file::checkpoint::{self, BUFFER, Content, ContentError, MAGIC, START, VERSION};
use std::io::Read;
use std::path::Path;
use std::sync::Arc;

/// Reads a checkpoint and checks all of it: the checksum, then the scene as any other scene, then whether there are as many
/// particles as it asks for.
///
/// # Errors
/// A [`CheckpointError`] for whatever is not exactly as [`save`](super::save) writes it.
pub fn load(path: &Path) -> Result<Checkpoint, CheckpointError> {
    let mut early = None;
    let refused = |source| CheckpointError::Scene { path: path.to_path_buf(), source };
    let check = |text: &str, step: u64, count: u64| {
        let scene = WrittenScene::new("its scene", text).check_kept(None).map_err(refused)?;
        let (last, asked) = (scene.time.steps, scene.model().particle_count());
        if step > last {
            let problem = format!("it is of step {step}, and its scene ends with step {last}");
            return Err(CheckpointError::malformed(path, problem));
        }
        if count != asked {
            let problem = format!("it has {}, and its scene {asked}", counted(count, "particle"));
            return Err(CheckpointError::malformed(path, problem));
        }
        early = Some(scene);
        Ok(())
    };
    let file = own_file::open(path).map_err(ContentError::Io);
    let content = file.and_then(|file| checkpoint::read(file, check)).map_err(|error| match error {
        ContentError::Io(error) => OutputError::io("read the checkpoint", path)(error).into(),
        source => CheckpointError::Content { path: path.to_path_buf(), source },
    })??;
    let malformed = |problem: &str| CheckpointError::malformed(path, problem.to_owned());
    let run_id = Id::parse(&content.run_id).ok_or_else(|| malformed("its run id is none"))?;
    let Content { scene: text, state, files, mut sections, .. } = content;
    let mut scene: Checked = early.ok_or_else(|| malformed("it has no scene"))?;
    if scene.has_start() {
        let place = sections.iter().position(|(name, _)| name == START);
        let start = place.map(|place| sections.remove(place).1);
        let start = start.as_deref().and_then(FileStart::from_bytes);
        // Layers of frozen particles follow those of the start.
        let frozen = scene.particles.iter().filter(|group| group.is_frozen());
        let frozen: u64 = frozen.map(|group| group.resolved_count(&scene.space)).sum();
        // Particles that carry fields are in none of their own.
        let are_there = |start: &FileStart| {
            let from_fields = scene.mesh().is_some() && start.species.is_empty();
            from_fields || start.particles().saturating_add(frozen) == state.len() as u64
        };
        let fits = |start: &FileStart| are_there(start) && start.fits(&scene);
        let start = start
            .filter(fits)
            .ok_or_else(|| malformed("what it keeps of the start of its particles makes no sense"))?;
        scene = WrittenScene::new("its scene", text).check_kept(Some(Arc::new(start))).map_err(refused)?;
    }
    let files = files.into_iter().map(|(name, bytes, crc32)| (name, Extent { bytes, crc32 })).collect();
    Ok(Checkpoint { run_id, scene, state, files, sections })
}

/// The id of the run that wrote a checkpoint, of which only the beginning is read; none where it cannot be.
pub(in crate::output) fn id_of(path: &Path) -> Option<Id> {
    let mut beginning = Vec::new();
    own_file::open(path).ok()?.take(BUFFER as u64).read_to_end(&mut beginning).ok()?;
    let payload = beginning.strip_prefix(&MAGIC)?.strip_prefix(&VERSION.to_le_bytes())?.get(8..)?;
    let (length, rest) = payload.split_first_chunk()?;
    let text = rest.get(..usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
    Id::parse(std::str::from_utf8(text).ok()?)
}
