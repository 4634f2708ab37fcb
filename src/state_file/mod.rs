//! Files that particles start from: GSD, extended XYZ, LAMMPS data, and checkpoints of earlier runs.
//!
//! Every format has a file of its own; trajectories in GSD are written through its file layer too ([`GsdWriter`]). The first three become
//! one [`ParticleFile`], with what the file says in its own units and order. A length that a file announces is compared with its size before anything is allocated.

pub(crate) mod arrays;
mod atom_style;
pub mod checkpoint;
pub(crate) mod elements;
mod extended_xyz;
mod file_layer;
mod gsd;
mod keys;
mod lammps;
mod lammps_data;
mod lines;
mod tally;

use crate::numbers::{bytes, counted, grouped};
use crate::{host_memory, printable};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use tally::Tally;

pub(crate) use atom_style::AtomStyle;
pub use file_layer::{Chunk, Cursor, GsdError, GsdReader, GsdWriter, Number};
pub use lammps_data::write_lammps;

/// What a file says of particles, in the order and with the units of the file.
///
/// ```
/// use mesoscope::state_file;
///
/// # let directory = tempfile::tempdir()?;
/// # let path = directory.path().join("two.xyz");
/// let text = "2\nLattice=\"4 0 0 0 5 0 0 0 6\" Properties=species:S:1:pos:R:3:velo:R:3\nA 1 1 1 0 0 2\nB 2 2 2 0 1 0\n";
/// std::fs::write(&path, text)?;
/// let file = state_file::read(&path, -1, None)?;
/// assert_eq!((file.len(), file.lengths), (2, Some([4.0, 5.0, 6.0])));
/// assert_eq!((file.species[1].as_str(), file.velocities[1]), ("B", [0.0, 1.0, 0.0]));
///
/// let error = state_file::read(&path, 7, None).unwrap_err();
/// assert!(error.to_string().contains("found frame 7; accepted: 0, or -1 from the end: the file has 1 frame"), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ParticleFile {
    /// Names of the species.
    pub species: Vec<String>,
    /// Other names of the species: where the file has atomic numbers, these beside the symbols of elements; else empty.
    pub numerals: Vec<String>,
    /// Whether these are names; otherwise they are the numbers of types, from 1.
    pub labelled: bool,
    /// The species of every particle, as an index of `species`.
    pub types: Vec<u32>,
    /// What the file calls its particles; empty where they are counted from 0.
    pub numbers: Vec<u64>,
    /// Masses of the species, where the file has them.
    pub masses: Vec<Option<f64>>,
    /// Charges of the species, where the file has them.
    pub charges: Vec<Option<f64>>,
    /// Mistakes that keep the charges from being used, where they are.
    pub charge_mistakes: Vec<Mistake>,
    /// Number of dimensions, where the file says so.
    pub dimension: Option<usize>,
    /// The lower corner of the box.
    pub origin: [f64; 3],
    /// Edge lengths of the box, if the file has one.
    pub lengths: Option<[f64; 3]>,
    /// How far the copy of the box above it along each axis is displaced along x, of a box that is sheared.
    pub displacements: [f64; 3],
    /// Axes along which the file says that its box is not periodic.
    pub open_axes: [bool; 3],
    /// Positions.
    pub positions: Vec<[f64; 3]>,
    /// Velocities; empty where the file has none.
    pub velocities: Vec<[f64; 3]>,
    /// What keeps the velocities from being used, where they are.
    pub velocity_mistakes: Vec<Mistake>,
    /// How often each particle has gone round the box; empty where the file does not say.
    pub images: Vec<[i32; 3]>,
    /// The points that particles are tied to; empty where the file has none.
    pub tethers: Vec<[f64; 3]>,
    /// Bonds, type by type.
    pub bonds: Vec<Links<2>>,
    /// Angles, type by type, with the vertex in the middle.
    pub angles: Vec<Links<3>>,
    /// What else there is in the file, in words.
    pub unused: Vec<String>,
}

/// Bonds or angles of one type.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Links<const LENGTH: usize> {
    /// The name of the type.
    pub name: String,
    /// The particles of each, by their places in the file.
    pub members: Vec<[u32; LENGTH]>,
}

/// One thing that is wrong with a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mistake {
    /// The line or frame, or nothing where it is the file as a whole.
    pub place: String,
    /// What is there.
    pub found: String,
    /// What would be right, or what to do.
    pub accepted: String,
}

/// Why particles cannot be read from a file: all that is wrong with it.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{}", .mistakes.iter().map(|mistake| mistake.of(.path)).collect::<Vec<_>>().join("\n"))]
pub struct StateFileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub mistakes: Vec<Mistake>,
}

impl Mistake {
    pub(crate) fn new(place: impl Into<String>, found: impl Into<String>, accepted: impl Into<String>) -> Self {
        Self { place: place.into(), found: found.into(), accepted: accepted.into() }
    }

    /// What is found, with the file and the place.
    pub(crate) fn found_in(&self, path: &Path) -> String {
        let comma = if self.place.is_empty() { "" } else { ", " };
        format!("`{}`{comma}{}: {}", printable::path(path), self.place, self.found)
    }

    fn of(&self, path: &Path) -> String {
        format!("{}; accepted: {}", self.found_in(path), self.accepted)
    }
}

/// Mistakes of a file under way; a reader goes on as long as it can.
#[derive(Debug, Default)]
struct Mistakes {
    listed: Vec<Mistake>,
    unlisted: usize,
}

impl Mistakes {
    /// Mistakes of a file that are told; more are counted.
    const MOST: usize = 8;

    fn push(&mut self, mistake: Mistake) {
        if self.listed.len() < Self::MOST { self.listed.push(mistake) } else { self.unlisted += 1 }
    }

    fn extend(&mut self, mistakes: impl IntoIterator<Item = Mistake>) {
        mistakes.into_iter().for_each(|mistake| self.push(mistake));
    }

    /// Whether nothing more has to be read to say what is wrong.
    fn are_enough(&self) -> bool {
        self.unlisted >= 1000
    }

    fn is_empty(&self) -> bool {
        self.listed.is_empty()
    }

    /// Refuses the file if there are any.
    fn refuse(self) -> Result<(), Self> {
        if self.is_empty() { Ok(()) } else { Err(self) }
    }

    fn into_list(mut self) -> Vec<Mistake> {
        if self.unlisted > 0 {
            let more = counted(self.unlisted as u64, "more mistake");
            self.listed.push(Mistake::new("", format!("found {more} like these"), "as above"));
        }
        self.listed
    }
}

impl From<Mistake> for Mistakes {
    fn from(mistake: Mistake) -> Self {
        Self { listed: vec![mistake], unlisted: 0 }
    }
}

impl From<io::Error> for Mistakes {
    fn from(error: io::Error) -> Self {
        Mistake::new("", format!("it cannot be read ({error})"), FORMATS).into()
    }
}

/// What is accepted in place of anything else.
const FORMATS: &str =
    "a file in GSD, extended XYZ or the data format of LAMMPS, or the directory of a run with a checkpoint";

/// Names of axes.
const AXES: [&str; 3] = ["x", "y", "z"];

/// Reads the particles of a frame, from 0, or from the end where it is negative. The format is recognised by the content. `atom_style` is
/// that of a LAMMPS data file which does not say it, as in an input script.
///
/// # Errors
/// [`StateFileError`] says all that is wrong with the file, with lines or frames.
pub fn read(path: &Path, frame: i64, atom_style: Option<&str>) -> Result<ParticleFile, StateFileError> {
    read_fitting(path, frame, atom_style, &|_| Ok(()))
}

/// Decides of a number of particles whether they are read.
pub(crate) type Fits<'a> = dyn Fn(u64) -> Result<(), Mistake> + 'a;

/// The same of a file whose number of particles fits: it is known before any of them is read.
pub(crate) fn read_fitting(
    path: &Path,
    frame: i64,
    atom_style: Option<&str>,
    fits: &Fits<'_>,
) -> Result<ParticleFile, StateFileError> {
    let error = |mistakes: Mistakes| StateFileError { path: path.to_path_buf(), mistakes: mistakes.into_list() };
    let style = atom_style.map(AtomStyle::of).transpose().map_err(|mistake| error(mistake.into()))?;
    let fits = |count: u64| fits_in_memory(count, host_memory::free()).and_then(|()| fits(count));
    read_any(path, frame, style.as_ref(), &fits).map_err(error)
}

/// Bytes of memory that a particle of a file takes at least: its place, its velocity, its species and what a run makes of it.
const BYTES_PER_PARTICLE: u64 = 64;

/// Looks whether so many particles fit into so much memory, if that is known.
pub(crate) fn fits_in_memory(count: u64, free: Option<u64>) -> Result<(), Mistake> {
    let needed = count.saturating_mul(BYTES_PER_PARTICLE);
    let Some(free) = free.filter(|free| needed > *free) else { return Ok(()) };
    let found = format!("found {} particles, which take at least {} of memory", grouped(count), bytes(needed));
    let accepted = format!("particles that fit into the {} that are free on this machine", bytes(free));
    Err(Mistake::new("", found, accepted))
}

/// Opens a file that ends: a device may not, and a pipe is not even opened before somebody writes to it.
pub(crate) fn open_regular_file(path: &Path) -> io::Result<File> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
    }
    File::open(path)
}

fn read_any(path: &Path, frame: i64, style: Option<&AtomStyle>, fits: &Fits<'_>) -> Result<ParticleFile, Mistakes> {
    let mut file = open_regular_file(path)?;
    let mut start = Vec::new();
    file.by_ref().take(START).read_to_end(&mut start)?;
    file.seek(SeekFrom::Start(0))?;
    let length = file.metadata()?.len();
    let is_of_lammps = !file_layer::is_one(&start) && lammps::is_one(&start);
    if !is_of_lammps {
        no_atom_style(style.map(ToString::to_string).as_deref())?;
    }
    if file_layer::is_one(&start) {
        gsd::read(file, frame, fits)
    } else if is_of_lammps {
        only_frame(frame)?;
        lammps::read(file, length, style, fits)
    } else if extended_xyz::is_one(&start) {
        extended_xyz::read(file, length, frame, fits)
    } else {
        let found = if start.is_empty() { "it is empty" } else { "it is in none of the formats that can be read" };
        Err(Mistake::new("", found, FORMATS).into())
    }
}

/// The format of a file that begins like this, in words; none where it is none that is read.
pub(crate) fn format_of(start: &[u8]) -> Option<&'static str> {
    if file_layer::is_one(start) {
        Some("a GSD file")
    } else if lammps::is_one(start) {
        Some("a data file of LAMMPS")
    } else {
        extended_xyz::is_one(start).then_some("an XYZ file")
    }
}

/// The beginning of a text, for a message.
fn shortened(text: &str) -> String {
    let mut short: String = text.chars().take(60).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}

/// Names in a row, each in quotes.
pub(crate) fn quoted<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    names.into_iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Bytes that tell the formats apart: comments may stand before a header of LAMMPS.
const START: u64 = 1 << 14;

/// Refuses a frame of a file that has one.
pub(crate) fn only_frame(frame: i64) -> Result<(), Mistake> {
    place_of_frame(frame, 1).map(|_| ())
}

/// Refuses a style of atoms of what is no data file of LAMMPS.
pub(crate) fn no_atom_style(style: Option<&str>) -> Result<(), Mistake> {
    style.map_or(Ok(()), |style| {
        let found = format!("found the `atom_style` \"{style}\" in `state`, and no data file of LAMMPS");
        Err(Mistake::new("", found, "no `atom_style`"))
    })
}

/// Which frame of so many is meant.
fn place_of_frame(frame: i64, frames: u64) -> Result<u64, Mistake> {
    let place = if frame < 0 { i128::from(frames) + i128::from(frame) } else { i128::from(frame) };
    if let Ok(place) = u64::try_from(place)
        && place < frames
    {
        return Ok(place);
    }
    let accepted = match frames {
        0 => "a file with a frame: this one has none".to_owned(),
        1 => "0, or -1 from the end: the file has 1 frame".to_owned(),
        _ => format!("0 to {}, or -1 to -{frames} from the end: the file has {frames} frames", frames - 1),
    };
    Err(Mistake::new("", format!("found frame {frame}"), accepted))
}

impl ParticleFile {
    /// Number of particles.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no particles.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// What the file calls a particle.
    pub(crate) fn number(&self, particle: usize) -> u64 {
        self.numbers.get(particle).copied().unwrap_or(particle as u64)
    }

    /// What is wrong with the particles in a box of so many dimensions, but for their velocities: axes beyond are not looked at. Across some axes
    /// there are walls, along which nothing is periodic; where positions are wrapped, along the others they may be anywhere.
    pub(crate) fn mistakes(&self, dimension: usize, lengths: [f64; 3], walled: [bool; 3], wraps: bool) -> Vec<Mistake> {
        let mut mistakes = Mistakes::default();
        let mut nowhere = Tally::default();
        let mut outside = Tally::default();
        let open: Vec<&str> =
            (0..dimension).filter(|axis| self.open_axes[*axis] && !walled[*axis]).map(|axis| AXES[axis]).collect();
        if let [all @ .., last] = open.as_slice() {
            let axes = if all.is_empty() { (*last).to_owned() } else { format!("{} and {last}", all.join(", ")) };
            let accepted =
                "a box that is periodic along every axis of the scene without `space.walls`: `pbc=\"T T T\"`";
            mistakes.push(Mistake::new("", format!("found a box that is not periodic along {axes}"), accepted));
        }
        // In a box that leans along x a place may be beside the upright one.
        let leaning = self.displacements.iter().fold(0.0_f64, |most, way| most.max(way.abs()));
        let slack = |axis: usize| if axis == 0 { leaning } else { 0.0 };
        for (particle, position) in self.positions.iter().enumerate() {
            let place = &position[..dimension];
            if place.iter().any(|value| !value.is_finite()) {
                nowhere.add(|| self.number(particle).to_string());
            } else if (0..dimension).any(|axis| {
                let place = position[axis] - self.origin[axis];
                if wraps && !walled[axis] {
                    (place / lengths[axis]).abs() > MOST_TURNS
                } else {
                    !is_inside(place + slack(axis), lengths[axis] + 2.0 * slack(axis))
                }
            }) {
                let shown = place.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
                outside.add(|| format!("{} at ({shown})", self.number(particle)));
            }
        }
        let what = "with positions that are no finite numbers";
        mistakes.extend(nowhere.mistake("particle", what, "finite numbers"));
        let upper: Vec<String> = (0..dimension)
            .map(|axis| format!("{} to {}", self.origin[axis], self.origin[axis] + lengths[axis]))
            .collect();
        let remedy = if wraps {
            "nothing wraps positions across walls, nor those whose digits end before the box, a million boxes away"
        } else {
            "or `\"outside\": \"wrap\"` in `state`, which takes them modulo the box and counts the turns in images"
        };
        let accepted = format!("positions inside the box, {}; {remedy}", upper.join(" × "));
        mistakes.extend(outside.mistake("particle", "outside the box", accepted));
        self.check_links(&self.bonds, "bond", &mut mistakes);
        self.check_links(&self.angles, "angle", &mut mistakes);
        mistakes.into_list()
    }

    /// What is wrong with the velocities in so many dimensions, which matters where they are used.
    pub(crate) fn mistakes_of_velocities(&self, dimension: usize) -> Vec<Mistake> {
        let mut mistakes = self.velocity_mistakes.clone();
        let is_endless =
            |particle: &usize| self.velocities[*particle][..dimension].iter().any(|value| !value.is_finite());
        let particles = (0..self.velocities.len()).filter(is_endless);
        let endless: Tally = particles.map(|particle| self.number(particle)).collect();
        let what = "with velocities that are no finite numbers";
        mistakes.extend(endless.mistake("particle", what, "finite numbers"));
        mistakes
    }

    /// Bonds and angles join particles that are there, all different, and each set of them once.
    fn check_links<const LENGTH: usize>(&self, all: &[Links<LENGTH>], noun: &str, mistakes: &mut Mistakes) {
        for links in all {
            let (mut missing, mut repeated) = (Tally::default(), Tally::default());
            let named =
                |members: &[u32; LENGTH]| members.map(|member| self.number(member as usize).to_string()).join("-");
            let mut known = Vec::with_capacity(links.members.len());
            for members in &links.members {
                if members.iter().any(|member| *member as usize >= self.len()) {
                    missing.add(|| named(members));
                } else if (1..LENGTH).any(|at| members[..at].contains(&members[at])) {
                    repeated.add(|| named(members));
                } else {
                    let backward = std::array::from_fn(|at| members[LENGTH - 1 - at]);
                    known.push((*members).min(backward));
                }
            }
            known.sort_unstable();
            let again = known.windows(2).filter(|pair| pair[0] == pair[1]).map(|pair| named(&pair[0])).collect();
            let mut refuse = |tally: Tally, what: &str, accepted: &str| {
                mistakes.extend(tally.mistake(noun, &format!("of type `{}`, {what}", links.name), accepted));
            };
            let most = format!("particles of the file, which has {}", self.len());
            refuse(missing, "to particles that are not there", &most);
            refuse(repeated, "of a particle with itself", "particles that are all different");
            refuse(again, "more than once", &format!("every {noun} once"));
        }
    }
}

/// Numbers that as many words say.
fn vector<T, const LENGTH: usize>(words: &[&str], read: impl Fn(&str) -> Option<T>) -> Option<[T; LENGTH]> {
    words.iter().map(|word| read(word)).collect::<Option<Vec<T>>>()?.try_into().ok()
}

/// What lengths and masses may differ by, as parts of themselves: files in single precision round.
pub(crate) const ROUNDING: f64 = 1e-6;

/// Boxes from which on a position of double precision has fewer digits than one in the box.
const MOST_TURNS: f64 = (1 << 20) as f64;

/// Whether a place lies on an edge of a box from 0 to `length`.
fn is_inside(place: f64, length: f64) -> bool {
    (-ROUNDING * length..=(1.0 + ROUNDING) * length).contains(&place)
}

/// Why edges of a box are none, if they are.
fn box_mistake(lengths: &[f64]) -> Option<Mistake> {
    let bad = lengths.iter().find(|length| !(length.is_finite() && (1e-100..=1e100).contains(*length)))?;
    Some(Mistake::new("", format!("found a box with an edge of {bad}"), "edges of positive length"))
}

/// How far copies above a box are displaced along x, from the tilts that are lengths along x of its second and third vector, and along y of its
/// third: shear makes one of the first two.
fn displacements(second: f64, third: f64, along_y: f64) -> Option<[f64; 3]> {
    (along_y == 0.0 && (second == 0.0 || third == 0.0) && second.is_finite() && third.is_finite())
        .then_some([0.0, second, third])
}

/// The refusal of a box that is not orthogonal.
fn triclinic(place: impl Into<String>, tilts: &str) -> Mistake {
    let found = format!("found a triclinic box ({tilts})");
    let accepted = "an orthogonal box: positions are fractions of the edges, which have to be along the axes";
    Mistake::new(place, found, accepted)
}

/// What a trajectory says of the number of particles that are frozen behind walls.
pub(crate) const FROZEN: &str = "frozen_particles";
pub(crate) const FROZEN_IN_GSD: &str = "log/frozen_particles";

/// The refusal of a box with layers of frozen particles behind its walls.
pub(crate) fn frozen_layers(place: impl Into<String>, count: u64) -> Mistake {
    let found = format!("found a run with layers of frozen particles, {count} of them, behind its walls");
    let accepted = "a run without layers: no scene takes them from a file, for `behind-walls` places them anew. Without them its positions \
                    between the walls can start a scene";
    Mistake::new(place, found, accepted)
}

/// A number that all particles of a species share.
#[derive(Debug, Clone, Copy)]
struct SharedNumber {
    noun: &'static str,
    is_possible: fn(f64) -> bool,
    accepted: &'static str,
}

const MASS: SharedNumber = SharedNumber {
    noun: "masses",
    is_possible: |mass| mass.is_finite() && mass > 0.0,
    accepted: "one mass for a species, greater than zero: give particles of another mass another species",
};
const CHARGE: SharedNumber = SharedNumber {
    noun: "charges",
    is_possible: |charge| (-1024.0..=1024.0).contains(&charge),
    accepted: "one charge for a species, from -1024 to 1024: give particles of another charge another species",
};

/// A number of species from those of particles: of one species all are the same.
#[derive(Debug)]
struct NumbersOfSpecies {
    of: SharedNumber,
    numbers: Vec<Option<f64>>,
    different: Vec<Tally>,
}

impl NumbersOfSpecies {
    fn new(of: SharedNumber) -> Self {
        Self { of, numbers: Vec::new(), different: Vec::new() }
    }

    fn add(&mut self, species: usize, number: f64, particle: impl FnOnce() -> String) {
        if species >= self.numbers.len() {
            self.numbers.resize(species + 1, None);
            self.different.resize_with(species + 1, Tally::default);
        }
        let known = *self.numbers[species].get_or_insert(number);
        // A NaN is not even equal to itself.
        if known != number || !(self.of.is_possible)(number) {
            self.different[species].add(particle);
        }
    }

    /// The numbers of all species, and the mistakes: numbers that differ within one.
    fn finish(mut self, species: &[String]) -> (Vec<Option<f64>>, Vec<Mistake>) {
        let mistake = |(index, tally): (usize, Tally)| {
            let what = format!("of `{}` with other {} than {}", species[index], self.of.noun, self.numbers[index]?);
            tally.mistake("particle", &what, self.of.accepted)
        };
        let mistakes = std::mem::take(&mut self.different).into_iter().enumerate().filter_map(mistake).collect();
        self.numbers.resize(species.len(), None);
        (self.numbers, mistakes)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn frames_are_counted_from_both_ends() {
        assert_eq!(place_of_frame(-1, 5), Ok(4));
        assert_eq!(place_of_frame(-5, 5), Ok(0));
        assert_eq!(place_of_frame(4, 5), Ok(4));
        for frame in [5, -6, i64::MAX, i64::MIN] {
            let accepted = place_of_frame(frame, 5).unwrap_err().accepted;
            assert_eq!(accepted, "0 to 4, or -1 to -5 from the end: the file has 5 frames");
        }
        assert!(place_of_frame(0, 0).is_err());
    }

    #[test]
    fn all_that_is_wrong_with_particles_is_said() {
        let mut file = ParticleFile {
            species: vec!["A".to_owned()],
            types: vec![0; 4],
            positions: vec![[0.0, 1.0, 9.0], [4.0, 5.0, 9.0], [f64::NAN, 0.0, 0.0], [4.1, 0.0, 0.0]],
            velocities: vec![[0.0; 3], [f64::INFINITY, 0.0, 0.0], [0.0; 3], [0.0; 3]],
            bonds: vec![Links { name: "b".to_owned(), members: vec![[0, 1], [1, 0], [2, 2], [3, 4]] }],
            ..ParticleFile::default()
        };
        let found: Vec<String> =
            file.mistakes(2, [4.0, 5.0, 1.0], [false; 3], false).into_iter().map(|mistake| mistake.found).collect();
        assert_eq!(
            found,
            [
                "found particle 2 with positions that are no finite numbers",
                "found particle 3 at (4.1, 0) outside the box",
                "found bond 3-4 of type `b`, to particles that are not there",
                "found bond 2-2 of type `b`, of a particle with itself",
                "found bond 0-1 of type `b`, more than once",
            ]
        );
        let found = file.mistakes_of_velocities(2);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].found, "found particle 1 with velocities that are no finite numbers");
        // The third axis counts in three dimensions.
        file.positions.truncate(2);
        assert_eq!(
            file.mistakes(3, [4.0, 5.0, 1.0], [false; 3], false)[0].found,
            "found particles 0 at (0, 1, 9), 1 at (4, 5, 9) outside the box"
        );
    }
}
