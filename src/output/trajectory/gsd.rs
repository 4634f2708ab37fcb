//! HOOMD's GSD, schema `hoomd` 1.4: <https://gsd.readthedocs.io/en/stable/schema-hoomd.html>.
//!
//! The box is centred: positions lie in `[-L/2, L/2)`. A two-dimensional box has Lz = 0, as HOOMD wants it; it knows no line,
//! which is written as a plane on which all particles have y = 0. Every frame has its step, its time (`log/time`) and the
//! particles' images: position plus image times box is the way since the start. What never changes (box, types, masses, charges,
//! bonds, angles, the id of the run as the text `log/run_id`) is written in the first frame, from which readers take it for all others.
//!
//! Where boundaries shear, every frame has its box, whose tilt `xy` or `xz` says how far they are displaced, and no images.

use super::{Description, Format, Frames};
use crate::output::extent::Checksum;
use crate::output::temporary::Temporary;
use crate::output::watch::Watch;
use crate::output::{Extent, Id, OutputError, files, own_file};
use crate::state::Reported;
use crate::state_file::{Chunk, Cursor, FROZEN_IN_GSD, GsdError, GsdReader, GsdWriter, Number};
use std::io;
use std::path::Path;

/// Bytes for the name of a type, with at least one zero at the end.
const NAME: usize = 64;

pub(super) const FORMAT: Format = Format {
    file: files::TRAJECTORY_GSD,
    // Position and velocity in single precision, and the image.
    bytes_per_particle: 36,
    create: |path| Ok(Box::new(GsdTrajectory::of(path, create_file(path)?, true, Checksum::default())?)),
    resume: |path, written| Ok(Box::new(GsdTrajectory::resume(path, written)?)),
    id_of,
};

#[derive(Debug)]
struct GsdTrajectory {
    /// None after a failed write: an unknown part of it is in the file.
    file: Option<GsdWriter>,
    /// Whether no frame has been added yet.
    empty: bool,
    watch: Watch,
    /// Length of the file after the last flush.
    length: u64,
    /// Of what its frames hold.
    checksum: Checksum,
    /// The same with frames that were added since.
    added: Checksum,
}

const APPLICATION: &str = concat!("mesoscope ", env!("CARGO_PKG_VERSION"));
/// Other versions are as good.
const PROGRAM: &str = "mesoscope ";
/// The id of the run.
const RUN: &str = "log/run_id";
/// Numbers of the particles in the scene, where a trajectory has some species only.
const NUMBERS: &str = "log/particles/id";
const SCHEMA: &str = "hoomd";
const SCHEMA_VERSION: (u16, u16) = (1, 4);

impl GsdTrajectory {
    fn resume(path: &Path, written: Extent) -> Result<Self, OutputError> {
        let mut file = open(path)?;
        let altered = || OutputError::Altered { path: path.to_path_buf() };
        let damaged = |error| refused("continue", path, error);
        let ours = file.application().starts_with(PROGRAM);
        if !ours || (&*file.schema(), file.schema_version()) != (SCHEMA, SCHEMA_VERSION) {
            return Err(altered());
        }
        // Every frame has a step of its own, so no two beginnings hold the same.
        let mut walk = Walk::new(&mut file).map_err(damaged)?;
        let (mut checksum, mut kept) = (Checksum::default(), 0);
        while checksum.extent(written.bytes) != written {
            let frame = walk.take(&mut file).map_err(damaged)?;
            if frame.is_empty() || frame.into_iter().any(|chunk| hash(&mut file, chunk, &mut checksum).is_err()) {
                return Err(altered());
            }
            kept += 1;
        }
        let length = file_length(path)?;
        if length < written.bytes {
            return Err(altered());
        }
        // A frame that was not finished may have left data that no index entry knows of.
        let whole = walk.next.is_none() && length == written.bytes;
        let reader = if whole { file } else { copy_frames(path, file, kept)? };
        Self::of(path, GsdWriter::append_to(reader).map_err(damaged)?, kept == 0, checksum)
    }

    fn of(path: &Path, file: GsdWriter, empty: bool, checksum: Checksum) -> Result<Self, OutputError> {
        let (watch, length) = (Watch::of(path)?, file_length(path)?);
        Ok(Self { watch, length, added: checksum.clone(), checksum, empty, file: Some(file) })
    }

    fn attempt(&mut self, write: impl FnOnce(&mut Frame) -> io::Result<()>) -> Result<(), OutputError> {
        let Some(file) = self.file.take() else {
            let problem = "an earlier write to it failed".to_owned();
            return Err(OutputError::Trajectory { path: self.watch.path().to_path_buf(), problem });
        };
        let mut frame = Frame { file, checksum: &mut self.added };
        write(&mut frame).map_err(OutputError::io("write", self.watch.path()))?;
        self.file = Some(frame.file);
        Ok(())
    }
}

impl Frames for GsdTrajectory {
    fn extent(&self) -> Extent {
        self.checksum.extent(self.length)
    }

    fn check(&self) -> Result<(), OutputError> {
        self.watch.check(self.length)
    }

    fn append(&mut self, description: &Description, state: &Reported) -> Result<(), OutputError> {
        description.check(self.watch.path(), state)?;
        let first = self.empty;
        self.attempt(|frame| {
            if first || description.shear.is_some() {
                write_box(frame, description, state.step)?;
            }
            if first {
                write_constants(frame, description, state)?;
            }
            if first || description.changing_masses {
                let masses = (0..state.len()).map(|particle| description.kinematics.mass(state, particle) as f32);
                frame.scalars("particles/mass", masses)?;
            }
            frame.scalars("configuration/step", [state.step])?;
            frame.scalars("log/time", [description.time.at(state.step)])?;
            let lean = description.displaced(state.step);
            let positions = state.positions.iter().map(|position| match lean {
                Some(lean) => leaning(description, *position, lean),
                None => centred(description, *position).0,
            });
            frame.arrays("particles/position", positions)?;
            let velocities = (0..state.len())
                .map(|particle| description.kinematics.velocity(state, particle).map(|value| value as f32));
            frame.arrays("particles/velocity", velocities)?;
            if lean.is_none() {
                let images = (0..state.len()).map(|particle| {
                    let (_, rounded) = centred(description, state.positions[particle]);
                    std::array::from_fn::<i32, 3, _>(|axis| state.image(particle)[axis] + rounded[axis])
                });
                frame.arrays("particles/image", images)?;
            }
            frame.file.end_frame();
            Ok(())
        })?;
        self.empty = false;
        Ok(())
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        self.attempt(|frame| frame.file.sync())?;
        self.checksum = self.added.clone();
        // What became of a file that is no longer there is said at the end of the run.
        self.length = self.watch.length().unwrap_or(self.length);
        Ok(())
    }
}

/// The id in the first frame.
fn id_of(path: &Path) -> Option<Id> {
    let text = GsdReader::new(own_file::open(path).ok()?).ok()?.array::<u8, 1>(0, RUN).ok()??;
    Id::parse(std::str::from_utf8(text.as_flattened()).ok()?)
}

fn create_file(path: &Path) -> Result<GsdWriter, OutputError> {
    GsdWriter::create(path, APPLICATION, SCHEMA, SCHEMA_VERSION).map_err(OutputError::io("create", path))
}

/// A frame that is being written, and the checksum of what it holds.
struct Frame<'a> {
    file: GsdWriter,
    checksum: &'a mut Checksum,
}

impl Frame<'_> {
    fn scalars<T: Number>(
        &mut self,
        name: &str,
        values: impl IntoIterator<Item = T, IntoIter: ExactSizeIterator>,
    ) -> io::Result<()> {
        self.arrays(name, values.into_iter().map(|value| [value]))
    }

    fn arrays<T: Number, const M: usize>(
        &mut self,
        name: &str,
        rows: impl IntoIterator<Item = [T; M], IntoIter: ExactSizeIterator>,
    ) -> io::Result<()> {
        let rows = rows.into_iter();
        begin_array(self.checksum, name, rows.len() as u64);
        let mut piece = Vec::with_capacity(2 * HASHED);
        let rows = rows.inspect(|row| {
            piece.extend_from_slice(bytemuck::cast_slice(row));
            if piece.len() >= HASHED {
                self.checksum.add(&piece);
                piece.clear();
            }
        });
        self.file.write(name, rows)?;
        self.checksum.add(&piece);
        Ok(())
    }
}

/// Bytes added to a checksum at once.
const HASHED: usize = 1 << 14;

/// Adds what comes before the content of an array to a checksum.
fn begin_array(checksum: &mut Checksum, name: &str, rows: u64) {
    checksum.add(name.as_bytes());
    checksum.add(&rows.to_le_bytes());
}

/// The box of a frame: its edges, and the tilts xy, xz and yz.
fn write_box(frame: &mut Frame, description: &Description, step: u64) -> io::Result<()> {
    let (mut lengths, [_, second, third]) = (box_of(description), description.tilts(step));
    let [xy, xz] = [second / lengths[1], third / lengths[2]].map(|tilt| tilt as f32);
    if description.units.dimension <= 2 {
        lengths[2] = 0.0;
    }
    let [x, y, z] = lengths.map(|length| length as f32);
    frame.scalars("configuration/box", [x, y, z, xy, xz, 0.0])
}

fn write_constants(frame: &mut Frame, description: &Description, state: &Reported) -> io::Result<()> {
    frame.scalars("configuration/dimensions", [description.units.dimension.max(2) as u8])?;
    frame.scalars("particles/N", [state.len() as u32])?;
    frame.arrays("particles/types", description.species.iter().map(|species| type_name(&species.name)))?;
    frame.scalars("particles/typeid", state.species.iter().copied())?;
    if description.are_charged() {
        let charge = |species: &u32| description.species[*species as usize].charge as f32;
        frame.scalars("particles/charge", state.species.iter().map(charge))?;
    }
    if let Some(frozen) = description.frozen_particles(state) {
        frame.scalars(FROZEN_IN_GSD, [frozen as u32])?;
    }
    if let Some(numbers) = &description.numbers {
        frame.scalars(NUMBERS, numbers.iter().copied())?;
    }
    frame.scalars(RUN, description.run.to_string().into_bytes())?;
    write_links(frame, "bond", &description.bonds)?;
    write_links(frame, "angle", &description.angles)
}

/// Bonds or angles, if there are any.
fn write_links<const N: usize>(frame: &mut Frame, noun: &str, links: &[([u32; N], u32)]) -> io::Result<()> {
    let Some(last) = links.iter().map(|(_, kind)| *kind).max() else { return Ok(()) };
    frame.scalars(&format!("{noun}s/N"), [links.len() as u32])?;
    let types: Vec<[i8; NAME]> = (0..=last).map(|kind| type_name(&format!("{noun} {kind}"))).collect();
    frame.arrays(&format!("{noun}s/types"), types)?;
    frame.scalars(&format!("{noun}s/typeid"), links.iter().map(|(_, kind)| *kind))?;
    frame.arrays(&format!("{noun}s/group"), links.iter().map(|(ends, _)| *ends))
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

/// Frames of a file, one after the other.
struct Walk {
    cursor: Cursor,
    /// The first array of the next frame.
    next: Option<Chunk>,
}

impl Walk {
    fn new(file: &mut GsdReader) -> Result<Self, GsdError> {
        let mut cursor = Cursor::default();
        let next = file.next(&mut cursor)?;
        Ok(Self { cursor, next })
    }

    /// The arrays of the next frame in the order in which [`GsdTrajectory::append`] wrote them.
    fn take(&mut self, file: &mut GsdReader) -> Result<Vec<Chunk>, GsdError> {
        let mut chunks: Vec<Chunk> = Vec::new();
        while let Some(chunk) = self.next.filter(|next| chunks.first().is_none_or(|first| first.frame == next.frame)) {
            chunks.push(chunk);
            self.next = file.next(&mut self.cursor)?;
        }
        chunks.sort_by_key(Chunk::location);
        Ok(chunks)
    }
}

/// Arrays of whole numbers, one a row.
const INTEGERS: [&str; 8] =
    ["particles/N", "particles/typeid", NUMBERS, FROZEN_IN_GSD, "bonds/N", "bonds/typeid", "angles/N", "angles/typeid"];

/// Whether a trajectory of ours has an array of this name and kind.
fn is_ours(name: &str, chunk: Chunk) -> bool {
    let [byte, integer, long, real, double] = [u8::KIND, u32::KIND, u64::KIND, f32::KIND, f64::KIND];
    let expected = match name {
        "configuration/box" | "particles/mass" | "particles/charge" => (real, 1),
        "configuration/dimensions" | RUN => (byte, 1),
        _ if INTEGERS.contains(&name) => (integer, 1),
        "particles/types" | "bonds/types" | "angles/types" => (i8::KIND, NAME as u32),
        "bonds/group" => (integer, 2),
        "angles/group" => (integer, 3),
        "configuration/step" => (long, 1),
        "log/time" => (double, 1),
        "particles/position" | "particles/velocity" => (real, 3),
        "particles/image" => (i32::KIND, 3),
        _ => return false,
    };
    (chunk.kind, chunk.columns) == expected
}

/// Adds an array to a checksum, if it is one of ours.
fn hash(file: &mut GsdReader, chunk: Chunk, checksum: &mut Checksum) -> Result<(), GsdError> {
    let name = file.name(chunk).filter(|name| is_ours(name, chunk)).ok_or(GsdError::Index)?;
    begin_array(checksum, name, chunk.rows);
    checksum.read(file.content(chunk)?)?;
    Ok(())
}

/// Copies the first frames to a new file and puts it in the place of the old one: the file layer cannot take frames
/// away. The copy has the bytes of a file that never had more frames.
fn copy_frames(path: &Path, mut old: GsdReader, frames: u64) -> Result<GsdReader, OutputError> {
    let (temporary, _) = Temporary::beside(path).map_err(OutputError::io("copy", path))?;
    let mut new = create_file(temporary.path())?;
    let mut copy = || -> Result<(), GsdError> {
        let mut walk = Walk::new(&mut old)?;
        for _ in 0..frames {
            for chunk in walk.take(&mut old)? {
                new.copy(&mut old, chunk)?;
            }
            new.end_frame();
            new.sync()?;
        }
        Ok(())
    };
    copy().map_err(|error| refused("copy", path, error))?;
    // Some systems do not replace a file that is open.
    drop((old, new));
    temporary.move_to(path).map_err(OutputError::io("replace", path))?;
    open(path)
}

fn open(path: &Path) -> Result<GsdReader, OutputError> {
    let file = own_file::open_to_continue(path).map_err(OutputError::io("continue", path))?;
    GsdReader::new(file).map_err(|error| refused("continue", path, error))
}

fn refused(attempted: &'static str, path: &Path, error: GsdError) -> OutputError {
    match error {
        GsdError::Io(source) => OutputError::Io { attempted, path: path.to_path_buf(), source },
        error => OutputError::Trajectory { path: path.to_path_buf(), problem: error.to_string() },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::families::{Kinematics, TimeAxis};
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
            time: TimeAxis { step: 0, time: 0.0, interval: 0.1 },
            species: Vec::new(),
            kinematics: Kinematics::default(),
            changing_masses: false,
            shear: None,
            bonds: Vec::new(),
            angles: Vec::new(),
            numbers: None,
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
