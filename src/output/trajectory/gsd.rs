//! HOOMD's GSD, schema `hoomd` 1.4: <https://gsd.readthedocs.io/en/stable/schema-hoomd.html>.
//!
//! The box is centred: positions lie in `[-L/2, L/2)`. A two-dimensional box has Lz = 0, as HOOMD wants it; it knows no line,
//! which is written as a plane on which all particles have y = 0. Every frame has its step, its time (`log/time`) and the
//! particles' images: position plus image times box is the way since the start. What never changes (box, types, masses,
//! bonds, angles, the id of the run as the text `log/run_id`) is written in the first frame, from which readers take it for all others.
//!
//! Where boundaries shear, every frame has its box, whose tilt `xy` or `xz` says how far they are displaced, and no images.

use super::{Description, Format, Frames};
use crate::output::extent::Checksum;
use crate::output::temporary::Temporary;
use crate::output::watch::Watch;
use crate::output::{Extent, Id, OutputError, files};
use crate::state::State;
use crate::state_file::FROZEN_IN_GSD;
use bytemuck::NoUninit;
use hoomd_gsd::file_layer::{
    DecodeError, EncodeError, GsdFile, Mode, OpenError, ReadError, SyncError, Type, WriteError,
};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Bytes for the name of a type, with at least one zero at the end.
const NAME: usize = 64;

pub(super) const FORMAT: Format = Format {
    file: files::TRAJECTORY_GSD,
    // Position and velocity in single precision, and the image.
    bytes_per_particle: 36,
    create: |path| Ok(Box::new(GsdTrajectory::create(path)?)),
    resume: |path, written| Ok(Box::new(GsdTrajectory::resume(path, written)?)),
    id_of,
};

#[derive(Debug)]
struct GsdTrajectory {
    path: PathBuf,
    /// None after a failed write: the file layer would write again when dropped, at positions that no longer hold.
    file: Option<GsdFile>,
    /// Whether no frame has been added yet.
    empty: bool,
    watch: Watch,
    /// Length of the file after the last flush.
    length: u64,
    /// Frames of the last flush.
    frames: u64,
    /// Of what these frames hold.
    checksum: Checksum,
}

const APPLICATION: &str = concat!("mesoscope ", env!("CARGO_PKG_VERSION"));
/// Other versions are as good.
const PROGRAM: &str = "mesoscope ";
/// The id of the run.
const RUN: &str = "log/run_id";
const SCHEMA: &str = "hoomd";
const SCHEMA_VERSION: (u16, u16) = (1, 4);

impl GsdTrajectory {
    fn create(path: &Path) -> Result<Self, OutputError> {
        let file = create_file(path)?;
        Self::of(path, file, Checksum::default())
    }

    fn resume(path: &Path, written: Extent) -> Result<Self, OutputError> {
        check_index(path)?;
        let file = GsdFile::open(path, Mode::Write).map_err(|error| open_error(path, "continue", error))?;
        let altered = || OutputError::Altered { path: path.to_path_buf() };
        let ours = file.application().starts_with(PROGRAM);
        if !ours || (file.schema(), file.schema_version()) != (SCHEMA, SCHEMA_VERSION) {
            return Err(altered());
        }
        // Every frame has a step of its own, so no two beginnings hold the same.
        let mut checksum = Checksum::default();
        let mut kept = 0;
        while checksum.extent(written.bytes) != written {
            if kept == file.n_frames() || hash_frame(path, &file, kept, &mut checksum).is_err() {
                return Err(altered());
            }
            kept += 1;
        }
        let length = file_length(path)?;
        if length < written.bytes {
            return Err(altered());
        }
        // A frame that was not finished may have left data that no index entry knows of.
        let whole = kept == file.n_frames() && length == written.bytes;
        let file = if whole { file } else { copy_frames(path, file, kept)? };
        Self::of(path, file, checksum)
    }

    fn of(path: &Path, file: GsdFile, checksum: Checksum) -> Result<Self, OutputError> {
        let (path, watch) = (path.to_path_buf(), Watch::of(path)?);
        let (frames, length) = (file.n_frames(), file_length(&path)?);
        Ok(Self { path, watch, length, frames, checksum, empty: frames == 0, file: Some(file) })
    }

    fn attempt(&mut self, write: impl FnOnce(&mut GsdFile) -> Result<(), WriteError>) -> Result<(), OutputError> {
        let Some(mut file) = self.file.take() else {
            let problem = "an earlier write to it failed".to_owned();
            return Err(OutputError::Trajectory { path: self.path.clone(), problem });
        };
        match write(&mut file) {
            Ok(()) => {
                self.file = Some(file);
                Ok(())
            }
            Err(error) => {
                std::mem::forget(file);
                Err(write_error(&self.path, error))
            }
        }
    }
}

impl Frames for GsdTrajectory {
    fn extent(&self) -> Extent {
        self.checksum.extent(self.length)
    }

    fn check(&self) -> Result<(), OutputError> {
        self.watch.check(self.length)
    }

    fn append(&mut self, description: &Description, state: &State) -> Result<(), OutputError> {
        description.check(&self.path, state)?;
        let first = self.empty;
        self.attempt(|file| {
            if first || description.shear.is_some() {
                write_box(file, description, state.step)?;
            }
            if first {
                write_constants(file, description, state)?;
            }
            if first || description.changing_masses {
                write_masses(file, description, state)?;
            }
            file.write_scalars("configuration/step", [state.step])?;
            file.write_scalars("log/time", [state.step as f64 * description.time_step])?;
            let lean = description.displaced(state.step);
            let positions = state.positions.iter().map(|position| match lean {
                Some(lean) => leaning(description, *position, lean),
                None => centred(description, *position).0,
            });
            file.write_arrays("particles/position", positions)?;
            let velocities =
                (0..state.len()).map(|particle| description.velocity(state, particle).map(|value| value as f32));
            file.write_arrays("particles/velocity", velocities)?;
            if lean.is_none() {
                let images = (0..state.len()).map(|particle| {
                    let (_, rounded) = centred(description, state.positions[particle]);
                    std::array::from_fn::<i32, 3, _>(|axis| state.image(particle)[axis] + rounded[axis])
                });
                file.write_arrays("particles/image", images)?;
            }
            file.end_frame().map_err(|error| WriteError::Encode("frame".to_owned(), state.step, error))
        })?;
        self.empty = false;
        Ok(())
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        self.attempt(|file| file.sync_all().map_err(|error| WriteError::Sync("frame".to_owned(), 0, error)))?;
        if let Some(file) = &self.file {
            while self.frames < file.n_frames() {
                hash_frame(&self.path, file, self.frames, &mut self.checksum)?;
                self.frames += 1;
            }
            // What became of a file that is no longer there is said at the end of the run.
            self.length = self.watch.length().unwrap_or(self.length);
        }
        Ok(())
    }
}

/// The id in the first frame.
fn id_of(path: &Path) -> Option<Id> {
    check_index(path).ok()?;
    let file = GsdFile::open(path, Mode::Read).ok()?;
    file.find_chunk(0, RUN)?;
    let text: Vec<u8> = file.iter_scalars(0, RUN).ok()?.collect();
    Id::parse(std::str::from_utf8(&text).ok()?)
}

fn create_file(path: &Path) -> Result<GsdFile, OutputError> {
    GsdFile::create(path, APPLICATION, SCHEMA, SCHEMA_VERSION).map_err(|error| open_error(path, "create", error))
}

fn write_masses(file: &mut GsdFile, description: &Description, state: &State) -> Result<(), WriteError> {
    let masses = (0..state.len()).map(|particle| description.mass(state, particle) as f32);
    file.write_scalars("particles/mass", masses)
}

/// The box of a frame: its edges, and the tilts xy, xz and yz.
fn write_box(file: &mut GsdFile, description: &Description, step: u64) -> Result<(), WriteError> {
    let (mut lengths, [_, second, third]) = (box_of(description), description.tilts(step));
    let [xy, xz] = [second / lengths[1], third / lengths[2]].map(|tilt| tilt as f32);
    if description.units.dimension <= 2 {
        lengths[2] = 0.0;
    }
    let [x, y, z] = lengths.map(|length| length as f32);
    file.write_scalars("configuration/box", [x, y, z, xy, xz, 0.0])
}

fn write_constants(file: &mut GsdFile, description: &Description, state: &State) -> Result<(), WriteError> {
    file.write_scalars("configuration/dimensions", [description.units.dimension.max(2) as u8])?;
    file.write_scalars("particles/N", [state.len() as u32])?;
    file.write_arrays("particles/types", description.species.iter().map(|species| type_name(&species.name)))?;
    file.write_scalars("particles/typeid", state.species.iter().copied())?;
    if let Some(frozen) = description.frozen_particles(state) {
        file.write_scalars(FROZEN_IN_GSD, [frozen as u32])?;
    }
    file.write_scalars(RUN, description.run.to_string().into_bytes())?;
    write_links(file, &BONDS, &description.bonds)?;
    write_links(file, &ANGLES, &description.angles)
}

/// The names of the arrays that join particles, and of a type of them.
struct Links {
    count: &'static str,
    types: &'static str,
    type_ids: &'static str,
    groups: &'static str,
    kind: &'static str,
}

const BONDS: Links =
    Links { count: "bonds/N", types: "bonds/types", type_ids: "bonds/typeid", groups: "bonds/group", kind: "bond" };
const ANGLES: Links = Links {
    count: "angles/N",
    types: "angles/types",
    type_ids: "angles/typeid",
    groups: "angles/group",
    kind: "angle",
};

/// Bonds or angles, if there are any.
fn write_links<const N: usize>(file: &mut GsdFile, names: &Links, links: &[([u32; N], u32)]) -> Result<(), WriteError> {
    let Some(last) = links.iter().map(|(_, kind)| *kind).max() else { return Ok(()) };
    file.write_scalars(names.count, [links.len() as u32])?;
    file.write_arrays(names.types, (0..=last).map(|kind| type_name(&format!("{} {kind}", names.kind))))?;
    file.write_scalars(names.type_ids, links.iter().map(|(_, kind)| *kind))?;
    file.write_arrays(names.groups, links.iter().map(|(ends, _)| *ends))
}

/// The box of the file: that between the walls, or where particles are frozen behind them the whole period, which no position is outside of.
fn box_of(description: &Description) -> [f64; 3] {
    if description.species.iter().any(|species| species.frozen) {
        description.units.lengths
    } else {
        description.units.edges()
    }
}

/// The position relative to the centre of the box. Where rounding to single precision would reach the upper face, the
/// lower one is meant, the same place inside the box: one of the next image, which the second array says.
fn centred(description: &Description, position: [u32; 3]) -> ([f32; 3], [i32; 3]) {
    let mut images = [0; 3];
    let centred = std::array::from_fn(|axis| {
        if axis >= description.units.dimension {
            return 0.0;
        }
        let length = description.units.lengths[axis];
        if description.units.gaps[axis] > 0.0 {
            let edge = length - description.units.gaps[axis];
            let half = (box_of(description)[axis] as f32) / 2.0;
            let value = description.units.position(position)[axis] - 0.5 * edge;
            return (value as f32).clamp(-half, half.next_down());
        }
        let half = (length as f32) / 2.0;
        let value = (f64::from((position[axis] ^ 0x8000_0000) as i32) * length / 4_294_967_296.0) as f32;
        images[axis] = i32::from(value >= half);
        if value >= half { -half } else { value }
    });
    (centred, images)
}

/// The position relative to the centre of a box that leans along x with an axis, by some edges over its length: in that box.
fn leaning(description: &Description, position: [u32; 3], (axis, edges): (usize, f64)) -> [f32; 3] {
    let (mut centred, _) = centred(description, position);
    let part = |axis: usize| f64::from((position[axis] ^ 0x8000_0000) as i32) / 4_294_967_296.0;
    let upright = part(0) - edges * part(axis);
    let upright = upright - (upright + 0.5).floor();
    centred[0] = ((upright + edges * part(axis)) * description.units.lengths[0]) as f32;
    centred
}

/// The bytes of a name, cut between characters if it is too long.
fn type_name(name: &str) -> [i8; NAME] {
    let end = (0..NAME.min(name.len() + 1)).rev().find(|end| name.is_char_boundary(*end)).unwrap_or(0);
    let bytes = &name.as_bytes()[..end];
    std::array::from_fn(|index| bytes.get(index).map_or(0, |byte| byte.cast_signed()))
}

fn file_length(path: &Path) -> Result<u64, OutputError> {
    Ok(std::fs::metadata(path).map_err(OutputError::io("look at", path))?.len())
}

/// What can be done with the arrays of a frame.
trait Chunks {
    fn scalars<T: Type + NoUninit>(&mut self, name: &str, values: impl ExactSizeIterator<Item = T>) -> Outcome;
    fn arrays<T: Type + NoUninit, const M: usize>(
        &mut self,
        name: &str,
        values: impl ExactSizeIterator<Item = [T; M]>,
    ) -> Outcome;
}

type Outcome = Result<(), OutputError>;

/// Visits the arrays of a frame in the order in which [`GsdTrajectory::append`] wrote them.
fn visit(path: &Path, file: &GsdFile, frame: u64, visitor: &mut impl Chunks) -> Outcome {
    let unreadable =
        |error: ReadError| OutputError::Trajectory { path: path.to_path_buf(), problem: error.to_string() };
    macro_rules! chunk {
        (scalars $kind:ty, $name:expr) => {
            if file.find_chunk(frame, $name).is_some() {
                visitor.scalars($name, file.iter_scalars::<$kind>(frame, $name).map_err(unreadable)?)?;
            }
        };
        (arrays $kind:ty, $columns:expr, $name:expr) => {
            if file.find_chunk(frame, $name).is_some() {
                visitor.arrays($name, file.iter_arrays::<$kind, $columns>(frame, $name).map_err(unreadable)?)?;
            }
        };
    }
    chunk!(scalars f32, "configuration/box");
    chunk!(scalars u8, "configuration/dimensions");
    chunk!(scalars u32, "particles/N");
    chunk!(arrays i8, NAME, "particles/types");
    chunk!(scalars u32, "particles/typeid");
    chunk!(scalars u32, FROZEN_IN_GSD);
    chunk!(scalars u8, RUN);
    chunk!(scalars u32, BONDS.count);
    chunk!(arrays i8, NAME, BONDS.types);
    chunk!(scalars u32, BONDS.type_ids);
    chunk!(arrays u32, 2, BONDS.groups);
    chunk!(scalars u32, ANGLES.count);
    chunk!(arrays i8, NAME, ANGLES.types);
    chunk!(scalars u32, ANGLES.type_ids);
    chunk!(arrays u32, 3, ANGLES.groups);
    chunk!(scalars f32, "particles/mass");
    chunk!(scalars u64, "configuration/step");
    chunk!(scalars f64, "log/time");
    chunk!(arrays f32, 3, "particles/position");
    chunk!(arrays f32, 3, "particles/velocity");
    chunk!(arrays i32, 3, "particles/image");
    Ok(())
}

/// Adds what a frame holds to a checksum.
fn hash_frame(path: &Path, file: &GsdFile, frame: u64, checksum: &mut Checksum) -> Outcome {
    struct Hash<'a>(&'a mut Checksum);

    impl Hash<'_> {
        fn add<T: NoUninit>(&mut self, name: &str, values: impl Iterator<Item = T>, count: usize) {
            self.0.add(name.as_bytes());
            self.0.add(&(count as u64).to_le_bytes());
            let mut buffer = Vec::with_capacity(HASHED);
            for value in values {
                buffer.extend_from_slice(bytemuck::bytes_of(&value));
                if buffer.len() >= HASHED {
                    self.0.add(&buffer);
                    buffer.clear();
                }
            }
            self.0.add(&buffer);
        }
    }

    impl Chunks for Hash<'_> {
        fn scalars<T: Type + NoUninit>(&mut self, name: &str, values: impl ExactSizeIterator<Item = T>) -> Outcome {
            let count = values.len();
            self.add(name, values, count);
            Ok(())
        }

        fn arrays<T: Type + NoUninit, const M: usize>(
            &mut self,
            name: &str,
            values: impl ExactSizeIterator<Item = [T; M]>,
        ) -> Outcome {
            let count = values.len();
            self.add(name, values.flatten(), count);
            Ok(())
        }
    }

    visit(path, file, frame, &mut Hash(checksum))
}

/// Bytes added to a checksum at once.
const HASHED: usize = 1 << 14;

/// Copies the first frames to a new file and puts it in the place of the old one: the file layer cannot take frames
/// away. The copy has the bytes of a file that never had more frames.
fn copy_frames(path: &Path, old: GsdFile, frames: u64) -> Result<GsdFile, OutputError> {
    let (temporary, _) = Temporary::beside(path).map_err(OutputError::io("copy", path))?;
    copy_into(path, &old, temporary.path(), frames)?;
    // Some systems do not replace a file that is open.
    drop(old);
    temporary.move_to(path).map_err(OutputError::io("replace", path))?;
    GsdFile::open(path, Mode::Write).map_err(|error| open_error(path, "continue", error))
}

fn copy_into(path: &Path, old: &GsdFile, temporary: &Path, frames: u64) -> Result<(), OutputError> {
    struct Copy<'a>(&'a mut GsdTrajectory);

    impl Chunks for Copy<'_> {
        fn scalars<T: Type + NoUninit>(&mut self, name: &str, values: impl ExactSizeIterator<Item = T>) -> Outcome {
            self.0.attempt(|file| file.write_scalars(name, values))
        }

        fn arrays<T: Type + NoUninit, const M: usize>(
            &mut self,
            name: &str,
            values: impl ExactSizeIterator<Item = [T; M]>,
        ) -> Outcome {
            self.0.attempt(|file| file.write_arrays(name, values))
        }
    }

    let mut new = GsdTrajectory::create(temporary)?;
    for frame in 0..frames {
        visit(path, old, frame, &mut Copy(&mut new))?;
        new.attempt(|file| file.end_frame().map_err(|error| WriteError::Encode("frame".to_owned(), frame, error)))?;
        // One frame in memory at a time.
        new.flush()?;
    }
    Ok(())
}

/// Makes sure that the header and the index of a file point inside it: the file layer takes that for granted.
/// The layout is described in <https://gsd.readthedocs.io/en/stable/file-layer.html>.
fn check_index(path: &Path) -> Result<(), OutputError> {
    const ENTRY: u64 = 32;
    let read = || -> io::Result<Option<&'static str>> {
        let mut file = File::open(path)?;
        let length = file.metadata()?.len();
        if length < 256 {
            return Ok(Some("it is shorter than a header"));
        }
        let mut header = [0_u64; 5];
        file.read_exact(bytemuck::cast_slice_mut(&mut header))?;
        let [magic, index, index_entries, names, name_entries] = header;
        if magic != 0x65df_65df_65df_65df {
            return Ok(Some("it is not a GSD file"));
        }
        let inside = |location: u64, count: u64, size: u64| {
            count.checked_mul(size).and_then(|bytes| location.checked_add(bytes)).is_some_and(|end| end <= length)
        };
        if !inside(index, index_entries, ENTRY) || !inside(names, name_entries, 64) {
            return Ok(Some("it was cut short"));
        }
        file.seek(SeekFrom::Start(names))?;
        let mut list = Vec::new();
        file.by_ref().take(name_entries * 64).read_to_end(&mut list)?;
        let known = list.split(|byte| *byte == 0).take_while(|name| !name.is_empty()).count();
        file.seek(SeekFrom::Start(index))?;
        let mut entries = io::BufReader::new(file);
        for _ in 0..index_entries {
            let mut entry = [0_u8; 32];
            entries.read_exact(&mut entry)?;
            let word = |at: usize| bytemuck::pod_read_unaligned::<u64>(&entry[at..at + 8]);
            let (frame, rows, location) = (word(0), word(8), word(16));
            if location == 0 {
                break;
            }
            let columns = bytemuck::pod_read_unaligned::<u32>(&entry[24..28]);
            let name = bytemuck::pod_read_unaligned::<u16>(&entry[28..30]);
            let size: u64 = match entry[30] {
                1 | 5 | 11 => 1,
                2 | 6 => 2,
                3 | 7 | 9 => 4,
                4 | 8 | 10 => 8,
                _ => return Ok(Some("its index holds an unknown type")),
            };
            if !inside(location, rows.saturating_mul(u64::from(columns)), size) {
                return Ok(Some("it was cut short"));
            }
            if frame >= index_entries || usize::from(name) >= known {
                return Ok(Some("its index is damaged"));
            }
        }
        Ok(None)
    };
    match read().map_err(OutputError::io("continue", path))? {
        None => Ok(()),
        Some(problem) => Err(OutputError::Trajectory { path: path.to_path_buf(), problem: problem.to_owned() }),
    }
}

fn open_error(path: &Path, attempted: &'static str, error: OpenError) -> OutputError {
    match error {
        OpenError::IO(_, source) | OpenError::Decode(_, DecodeError::IO(source)) => {
            OutputError::Io { attempted, path: path.to_path_buf(), source }
        }
        OpenError::Decode(_, error) => OutputError::Trajectory { path: path.to_path_buf(), problem: error.to_string() },
        error => OutputError::Trajectory { path: path.to_path_buf(), problem: error.to_string() },
    }
}

fn write_error(path: &Path, error: WriteError) -> OutputError {
    let problem = match error {
        WriteError::Sync(_, _, SyncError::IO(source)) => {
            return OutputError::Io { attempted: "write", path: path.to_path_buf(), source };
        }
        WriteError::Sync(_, _, error) => error.to_string(),
        WriteError::Encode(name, frame, error @ EncodeError::DuplicateChunkName(..)) => {
            format!("frame {frame} has two chunks `{name}`: {error}")
        }
        error => error.to_string(),
    };
    OutputError::Trajectory { path: path.to_path_buf(), problem }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::state::Units;

    #[test]
    fn long_names_are_cut_between_characters() {
        let name = type_name(&"é".repeat(40));
        assert_eq!((name[61] != 0, name[62], name[63]), (true, 0, 0));
        assert_eq!(type_name("").iter().filter(|byte| **byte != 0).count(), 0);
        assert_eq!(type_name(&"x".repeat(63))[62..], [i8::try_from(b'x').unwrap_or(0), 0]);
    }

    #[test]
    fn positions_stay_below_the_upper_face() {
        let units = Units { dimension: 3, lengths: [10.0, 0.3, 7.0], gaps: [0.0; 3], momentum: 1.0 };
        let description = Description {
            run: Id::of_sweep([]),
            units,
            time_step: 0.1,
            species: Vec::new(),
            mass_unit: None,
            specific_momenta: false,
            changing_masses: false,
            shear: None,
            bonds: Vec::new(),
            angles: Vec::new(),
        };
        assert_eq!(centred(&description, [1 << 31; 3]), ([0.0; 3], [0; 3]));
        assert_eq!(centred(&description, [u32::MAX; 3]), ([-5.0, -0.15, -3.5], [1; 3]));
        for fraction in [0, 1, (1 << 31) - 1, 1 << 31, u32::MAX - 1, u32::MAX] {
            for (value, length) in centred(&description, [fraction; 3]).0.into_iter().zip(units.lengths) {
                let half = length as f32 / 2.0;
                assert!(value >= -half && value < half, "{fraction}: {value} with L/2 = {half}");
            }
        }
    }
}
