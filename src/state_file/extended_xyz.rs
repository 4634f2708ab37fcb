//! Extended XYZ: frames of text, each with its number of particles, a line of `key=value` and a line for every particle:
//! <https://github.com/libAtoms/extxyz>.
//!
//! Columns that are read: `pos`; `species_name`, as this program writes it, else `species`, else `type`, else the atomic number `Z`;
//! `velo`, `velocities`, `velocity` or `vel`, else `momenta` over `masses`; `masses` or `mass`; `initial_charges`, `charges`, `charge` or `q`; `map_shift` or `images`; `id`. Without
//! `Properties`, a line is a species and a position.

use super::keys::Keys;
use super::lines::Lines;
use super::tally::Tally;
use super::{
    CHARGE, FROZEN, Fits, MASS, Mistake, Mistakes, NumbersOfSpecies, ParticleFile, box_mistake, displacements,
    elements, frozen_layers, place_of_frame, shortened, triclinic, vector,
};
use crate::state::MOST_PARTICLES;
use std::collections::{HashMap, HashSet};
use std::fs::File;

/// Species beyond this number are a sign of a column that is none.
const MOST_SPECIES: usize = 4096;

pub(super) fn is_one(start: &[u8]) -> bool {
    let text = String::from_utf8_lossy(start);
    let mut lines = text.lines();
    let count = lines.next().is_some_and(|line| line.trim().parse::<u64>().is_ok());
    // A number alone may be the title of anything.
    count && lines.next().is_some()
}

/// Where a frame begins.
#[derive(Debug, Clone, Copy)]
struct Frame {
    offset: u64,
    lines_before: u64,
}

pub(super) fn read(file: File, length: u64, frame: i64, fits: &Fits<'_>) -> Result<ParticleFile, Mistakes> {
    let mut lines = Lines::of(file);
    let start = find(&mut lines, length, frame)?;
    lines.seek(start.offset, start.lines_before)?;
    let count = count_of(&mut lines, length)?.unwrap_or(0);
    fits(count)?;
    let Some(comment) = lines.next()? else {
        return Err(Mistake::new("", "the file ends after the number of particles", "a line of keys").into());
    };
    let comment = comment.to_owned();
    let place = lines.place();
    let (file, columns) = header(&comment, &place)?;
    particles(&mut lines, count, &columns, file)
}

/// Finds the frame that is meant.
fn find(lines: &mut Lines, length: u64, frame: i64) -> Result<Frame, Mistakes> {
    let mut frames = Vec::new();
    loop {
        let start = Frame { offset: lines.offset(), lines_before: lines.number() };
        let Some(count) = count_of(lines, length)? else { break };
        frames.push(start);
        if u64::try_from(frame).is_ok_and(|wanted| wanted + 1 == frames.len() as u64) {
            break;
        }
        // One line of keys and one for every particle.
        for line in 0..=count {
            if !lines.skip()? {
                let number = frames.len() - 1;
                let found = format!("frame {number} ends after {} of {count} particles", line.saturating_sub(1));
                let earlier = |last: usize| format!(", or an earlier frame: `\"frame\": {last}` is the last whole one");
                let accepted = format!("a whole file{}", number.checked_sub(1).map_or_else(String::new, earlier));
                return Err(Mistake::new(lines.place(), found, accepted).into());
            }
        }
    }
    Ok(frames[place_of_frame(frame, frames.len() as u64)? as usize])
}

/// The number of particles at the beginning of a frame; none at the end of the file, which empty lines may precede.
fn count_of(lines: &mut Lines, length: u64) -> Result<Option<u64>, Mistakes> {
    let mut text = String::new();
    while text.is_empty() {
        let Some(line) = lines.next()? else { return Ok(None) };
        line.trim().clone_into(&mut text);
    }
    let Some(count) = text.parse::<u64>().ok().filter(|count| *count <= MOST_PARTICLES) else {
        let found = format!("found `{}` in place of a number of particles", shortened(&text));
        return Err(Mistake::new(lines.place(), found, format!("a whole number up to {MOST_PARTICLES}")).into());
    };
    // A line of a particle has a letter, a digit or two, and its end.
    if count > length {
        let found = format!("found {count} particles in a file of {length} bytes");
        return Err(Mistake::new(lines.place(), found, "a whole file").into());
    }
    Ok(Some(count))
}

/// The first columns of what is read.
#[derive(Debug, Default)]
struct Columns {
    all: usize,
    species: Option<usize>,
    /// Whether what names the species is an atomic number.
    is_atomic_number: bool,
    position: Option<usize>,
    velocity: Option<usize>,
    momentum: Option<usize>,
    mass: Option<usize>,
    charge: Option<usize>,
    image: Option<usize>,
    id: Option<usize>,
}

/// Numbers of a key, of which there have to be so many.
fn numbers<const COUNT: usize>(keys: &Keys, name: &str, place: &str) -> Result<Option<[f64; COUNT]>, Mistake> {
    let Some(text) = keys.value(name, place)? else { return Ok(None) };
    let separators = |letter: char| letter.is_whitespace() || [',', '[', ']'].contains(&letter);
    let parts: Vec<&str> = text.split(separators).filter(|part| !part.is_empty()).collect();
    let wrong = || Mistake::new(place, format!("found {name}=\"{}\"", shortened(text)), format!("{COUNT} numbers"));
    vector(&parts, real).map(Some).ok_or_else(wrong)
}

/// The contents of the line of keys: a file without particles, and the columns of their lines.
fn header(comment: &str, place: &str) -> Result<(ParticleFile, Columns), Mistakes> {
    let keys = Keys::of(comment, place)?;
    let value = |name: &str| keys.value(name, place);
    if let Some(count) = value(FROZEN)?.and_then(|text| text.parse().ok()) {
        return Err(frozen_layers(place, count).into());
    }
    let mut file = ParticleFile { labelled: true, ..ParticleFile::default() };
    if let Some(lattice) = numbers::<9>(&keys, "Lattice", place)? {
        let edges = [lattice[0], lattice[4], lattice[8]];
        let longest = edges.iter().fold(0.0, |most: f64, edge| most.max(edge.abs()));
        let across = [1, 2, 3, 5, 6, 7].map(|at| if lattice[at].abs() > 1e-12 * longest { lattice[at] } else { 0.0 });
        let [first_y, first_z, second, second_z, third, third_y] = across;
        let leaning = displacements(second, third, third_y).filter(|_| [first_y, first_z, second_z] == [0.0; 3]);
        let Some(leaning) = leaning else {
            let lattice = shortened(value("Lattice")?.unwrap_or_default());
            return Err(triclinic(place, &format!("Lattice=\"{lattice}\"")).into());
        };
        if let Some(mistake) = box_mistake(&edges) {
            return Err(Mistake { place: place.to_owned(), ..mistake }.into());
        }
        (file.lengths, file.displacements) = (Some(edges), leaning);
    }
    file.origin = numbers(&keys, "Origin", place)?.unwrap_or_default();
    if let Some(text) = value("pbc")? {
        let wrong = || {
            let found = format!("found pbc=\"{}\"", shortened(text));
            Mistake::new(place, found, "`T` or `F` for each of three axes")
        };
        let periodic = truths(text).ok_or_else(wrong)?;
        file.dimension = Some(match periodic {
            [true, false, false] => 1,
            [true, true, false] => 2,
            _ => 3,
        });
        // Without a box of its own a file leaves it to the scene.
        file.open_axes = periodic.map(|is| !is && file.lengths.is_some());
    }
    let columns = Columns::of(value("Properties")?.unwrap_or("species:S:1:pos:R:3"), place, &mut file.unused)?;
    Ok((file, columns))
}

/// Three values that are true or false.
fn truths(text: &str) -> Option<[bool; 3]> {
    let words = text.split(|letter: char| !letter.is_alphanumeric()).filter(|word| !word.is_empty());
    vector(&words.collect::<Vec<_>>(), |word| match word.to_ascii_lowercase().as_str() {
        "t" | "true" | "1" => Some(true),
        "f" | "false" | "0" => Some(false),
        _ => None,
    })
}

impl Columns {
    /// The columns that are read; `unused` are told of the others.
    fn of(properties: &str, place: &str, unused: &mut Vec<String>) -> Result<Self, Mistakes> {
        let wrong = |accepted: &str| {
            Mistakes::from(Mistake::new(place, format!("found Properties={}", shortened(properties)), accepted))
        };
        let parts: Vec<&str> = properties.split(':').collect();
        if !parts.len().is_multiple_of(3) {
            return Err(wrong("a name, a kind and a number of columns for each, divided by colons"));
        }
        let mut columns = Self::default();
        let mut names = [None; 4];
        for triple in parts.chunks_exact(3) {
            let first = columns.all;
            let Some(width) = triple[2].parse::<usize>().ok().filter(|width| (1..=10_000).contains(width)) else {
                return Err(wrong("numbers of columns from 1 to 10000"));
            };
            columns.all += width;
            let (place, needed) = match triple[0] {
                "species_name" => (&mut names[0], 1),
                "species" => (&mut names[1], 1),
                "type" => (&mut names[2], 1),
                "Z" => (&mut names[3], 1),
                "pos" => (&mut columns.position, 3),
                "velo" | "velocities" | "velocity" | "vel" => (&mut columns.velocity, 3),
                "momenta" => (&mut columns.momentum, 3),
                "masses" | "mass" => (&mut columns.mass, 1),
                "initial_charges" | "charges" | "charge" | "q" => (&mut columns.charge, 1),
                "map_shift" | "images" => (&mut columns.image, 3),
                "id" => (&mut columns.id, 1),
                other => {
                    unused.push(format!("the column `{}`", shortened(other)));
                    continue;
                }
            };
            if width != needed {
                return Err(wrong(&format!("{needed} columns of `{}`", triple[0])));
            }
            match place {
                None => *place = Some(first),
                Some(_) => unused.push(format!("the column `{}`, which says it again", triple[0])),
            }
        }
        columns.species = names.into_iter().flatten().next();
        columns.is_atomic_number = columns.species.is_some() && columns.species == names[3];
        for (name, place) in [("type", names[2]), ("Z", names[3])] {
            if place.is_some() && place != columns.species {
                unused.push(format!("the column `{name}`, beside names of species"));
            }
        }
        if columns.position.is_none() {
            return Err(wrong("a column `pos` of positions"));
        }
        if columns.species.is_none() {
            return Err(wrong("a column `species`, or `Z` of atomic numbers"));
        }
        if columns.velocity.is_none() && columns.momentum.is_some() && columns.mass.is_none() {
            columns.momentum = None;
            unused.push("the column `momenta`, for there are no `masses` in the file".to_owned());
        }
        Ok(columns)
    }
}

/// A real number, whose exponent may be marked as Fortran does.
fn real(word: &str) -> Option<f64> {
    word.parse().ok().or_else(|| word.replace(['d', 'D'], "e").parse().ok())
}

/// A particle as its line says it.
struct Particle<'a> {
    species: &'a str,
    position: [f64; 3],
    velocity: Option<[f64; 3]>,
    mass: Option<f64>,
    charge: Option<f64>,
    image: Option<[i64; 3]>,
    id: Option<u64>,
}

impl Columns {
    fn read<'a>(&self, line: &'a str, place: &str) -> Result<Particle<'a>, Mistake> {
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        if words.len() != self.all {
            let found = format!("found {} columns", words.len());
            return Err(Mistake::new(place, found, format!("{}, as `Properties` says", self.all)));
        }
        let here = |first: usize, width: usize| &words[first..first + width];
        let wrong = |first: usize, width: usize, accepted: &str| {
            let found = format!("found `{}` in column {}", shortened(&here(first, width).join(" ")), first + 1);
            Mistake::new(place, found, accepted)
        };
        let numbers = |first: usize| vector(here(first, 3), real).ok_or_else(|| wrong(first, 3, "three numbers"));
        let position = numbers(self.position.unwrap_or(0))?;
        let velocity = self.velocity.map(numbers).transpose()?;
        let momentum = self.momentum.filter(|_| velocity.is_none()).map(numbers).transpose()?;
        let number = |first: usize, noun: &str| real(words[first]).ok_or_else(|| wrong(first, 1, noun));
        let mass = self.mass.map(|first| number(first, "a mass")).transpose()?;
        let charge = self.charge.map(|first| number(first, "a charge")).transpose()?;
        let turns = |first: usize| vector(here(first, 3), |word| word.parse().ok());
        let turns = |first: usize| turns(first).ok_or_else(|| wrong(first, 3, "three whole numbers"));
        let image = self.image.map(turns).transpose()?;
        let id = |first: usize| words[first].parse().map_err(|_| wrong(first, 1, "a whole number"));
        let id = self.id.map(id).transpose()?;
        let first = self.species.unwrap_or(0);
        if self.is_atomic_number && words[first].parse::<u32>().is_err() {
            return Err(wrong(first, 1, "an atomic number"));
        }
        let over_mass = momentum.zip(mass).map(|(momentum, mass)| momentum.map(|part| part / mass));
        Ok(Particle { species: words[first], position, velocity: velocity.or(over_mass), mass, charge, image, id })
    }
}

fn particles(
    lines: &mut Lines,
    count: u64,
    columns: &Columns,
    mut file: ParticleFile,
) -> Result<ParticleFile, Mistakes> {
    let count = usize::try_from(count).unwrap_or(usize::MAX);
    file.positions.reserve(count);
    let mut mistakes = Mistakes::default();
    let [mut masses, mut charges] = [MASS, CHARGE].map(NumbersOfSpecies::new);
    let mut known: HashMap<String, u32> = HashMap::new();
    for particle in 0..count {
        let place = format!("line {}", lines.number() + 1);
        let Some(line) = lines.next()? else {
            let found = format!("the file ends after {particle} of {count} particles");
            mistakes.push(Mistake::new(lines.place(), found, "a whole file"));
            break;
        };
        let read = match columns.read(line, &place) {
            Ok(read) => read,
            Err(mistake) => {
                mistakes.push(mistake);
                if mistakes.are_enough() {
                    break;
                }
                continue;
            }
        };
        let name = read.species;
        let species = match known.get(name) {
            Some(species) => *species,
            None if known.len() >= MOST_SPECIES => {
                let found = format!("found more than {MOST_SPECIES} species");
                mistakes.push(Mistake::new(place, found, "a column of names of species"));
                break;
            }
            None => {
                file.species.push(name.to_owned());
                known.insert(name.to_owned(), known.len() as u32);
                known.len() as u32 - 1
            }
        };
        file.types.push(species);
        file.positions.push(read.position);
        if let Some(mass) = read.mass {
            masses.add(species as usize, mass, || particle.to_string());
        }
        if let Some(charge) = read.charge {
            charges.add(species as usize, charge, || particle.to_string());
        }
        file.velocities.extend(read.velocity);
        if let Some(image) = read.image {
            let turns = image.map(i32::try_from);
            if turns.iter().any(Result::is_err) {
                let found = format!("found images beyond 32 bits: {image:?}");
                mistakes.push(Mistake::new(place, found, "images from -2147483648 to 2147483647"));
            }
            file.images.push(turns.map(Result::unwrap_or_default));
        }
        file.numbers.extend(read.id);
    }
    let mut seen = HashSet::new();
    let again: Tally = file.numbers.iter().filter(|number| !seen.insert(**number)).collect();
    mistakes.extend(again.mistake("particle", "more than once", "a number of its own for every particle"));
    if columns.is_atomic_number {
        let symbol = |number: &String| number.parse().ok().and_then(elements::symbol);
        let symbols = file.species.iter().map(|number| symbol(number).map_or_else(|| number.clone(), str::to_owned));
        let symbols = symbols.collect();
        file.numerals = std::mem::replace(&mut file.species, symbols);
    }
    let (masses, mass_mistakes) = masses.finish(&file.species);
    file.masses = masses;
    mistakes.extend(mass_mistakes);
    (file.charges, file.charge_mistakes) = charges.finish(&file.species);
    mistakes.refuse()?;
    Ok(file)
}
