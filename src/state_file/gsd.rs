//! HOOMD's GSD: the file layer, versions 1 and 2, and the schema `hoomd`:
//! <https://gsd.readthedocs.io/en/stable/file-layer.html>, <https://gsd.readthedocs.io/en/stable/schema-hoomd.html>.
//!
//! The crate that writes trajectories reads version 2 alone and maps files into memory; here a file that is damaged, or changes
//! meanwhile, is refused, and of a long trajectory nothing but two frames is read. A frame takes what it lacks from the first
//! one, and that from the defaults of the schema.

use super::{
    FROZEN_IN_GSD, Links, Mistake, Mistakes, ParticleFile, SpeciesMasses, box_mistake, displacements, frozen_layers,
    place_of_frame, triclinic,
};
use crate::state::MOST_PARTICLES;
use std::collections::HashMap;
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};

const MAGIC: u64 = 0x65df_65df_65df_65df;
const HEADER: usize = 256;
const ENTRY: u64 = 32;
/// Bytes of a name in version 1, and the unit of the length of the list in both.
const NAME: u64 = 64;
/// Bytes of names: there are at most 65 536 of them.
const MOST_NAMES: u64 = 16 << 20;

pub(super) fn is_one(start: &[u8]) -> bool {
    start.starts_with(&MAGIC.to_le_bytes())
}

/// Where an array lies in the file.
#[derive(Debug, Clone, Copy)]
struct Entry {
    rows: u64,
    columns: u32,
    location: u64,
    kind: u8,
}

impl Entry {
    /// Bytes of a number; none of an unknown type.
    fn size(self) -> Option<u64> {
        match self.kind {
            1 | 5 | 11 => Some(1),
            2 | 6 => Some(2),
            3 | 7 | 9 => Some(4),
            4 | 8 | 10 => Some(8),
            _ => None,
        }
    }

    fn bytes(self) -> Option<u64> {
        self.rows.checked_mul(self.columns.into())?.checked_mul(self.size()?)
    }
}

/// A file with the arrays of its first frame and of the one that is asked for.
struct Gsd {
    file: File,
    length: u64,
    frame: u64,
    ids: HashMap<String, u16>,
    /// By whether it is the frame that is asked for, and by name.
    entries: HashMap<(bool, u16), Entry>,
}

fn cut_short() -> Mistakes {
    Mistake::new("", "it was cut short, or is damaged: parts of it should lie beyond its end", "a whole GSD file")
        .into()
}

fn word(bytes: &[u8], at: usize) -> u64 {
    bytes.get(at..at + 8).and_then(|word| word.try_into().ok()).map_or(0, u64::from_le_bytes)
}

fn half_word(bytes: &[u8], at: usize) -> u32 {
    bytes.get(at..at + 4).and_then(|word| word.try_into().ok()).map_or(0, u32::from_le_bytes)
}

pub(super) fn read(file: File, length: u64, frame: i64) -> Result<ParticleFile, Mistakes> {
    Gsd::open(file, length, frame)?.particles()
}

impl Gsd {
    fn open(mut file: File, length: u64, frame: i64) -> Result<Self, Mistakes> {
        let mut header = [0; HEADER];
        if length < HEADER as u64 {
            return Err(cut_short());
        }
        file.read_exact(&mut header)?;
        let [index, index_entries, names, name_entries] = [8, 16, 24, 32].map(|at| word(&header, at));
        let version = half_word(&header, 44) >> 16;
        if ![1, 2].contains(&version) {
            let found = format!("found version {version} of the file layer of GSD");
            return Err(Mistake::new("", found, "versions 1 and 2").into());
        }
        let text = header[112..176].split(|byte| *byte == 0).next().unwrap_or_default();
        let (schema, schema_version) = (String::from_utf8_lossy(text).into_owned(), half_word(&header, 40) >> 16);
        if schema != "hoomd" || ![1, 2].contains(&schema_version) {
            let found = format!("found the schema `{schema}` in version {schema_version}");
            return Err(Mistake::new("", found, "a GSD file of the schema `hoomd` in version 1 or 2").into());
        }
        let end = |location: u64, count: u64, size: u64| {
            count.checked_mul(size).and_then(|bytes| location.checked_add(bytes)).filter(|end| *end <= length)
        };
        let both = end(index, index_entries, ENTRY).zip(end(names, name_entries, NAME));
        if both.is_none() || name_entries * NAME > MOST_NAMES {
            return Err(cut_short());
        }
        file.seek(SeekFrom::Start(names))?;
        let mut list = vec![0; (name_entries * NAME) as usize];
        file.read_exact(&mut list)?;
        let ids = if version == 2 { packed(&list) } else { padded(&list) };
        let (frames, file) = Self::frames(file, index, index_entries, length)?;
        let wanted = place_of_frame(frame, frames)?;
        let mut found = Self { file, length, frame: wanted, ids, entries: HashMap::new() };
        found.collect(index, index_entries)?;
        Ok(found)
    }

    /// Looks through the index; returns the number of frames.
    fn frames(mut file: File, index: u64, entries: u64, length: u64) -> Result<(u64, File), Mistakes> {
        file.seek(SeekFrom::Start(index))?;
        let mut reader = BufReader::with_capacity(1 << 16, file);
        let mut frames = 0;
        for _ in 0..entries {
            let mut entry = [0; ENTRY as usize];
            reader.read_exact(&mut entry)?;
            let (frame, location) = (word(&entry, 0), word(&entry, 16));
            if location == 0 {
                break;
            }
            // A chunk without rows may begin where the file ends.
            if location > length || frame >= entries || frame + 1 < frames {
                let found = "it is damaged: its index makes no sense";
                return Err(Mistake::new("", found, "a whole GSD file").into());
            }
            frames = frame + 1;
        }
        Ok((frames, reader.into_inner()))
    }

    /// Remembers where the arrays of the two frames lie.
    fn collect(&mut self, index: u64, entries: u64) -> Result<(), Mistakes> {
        let mut file = self.file.try_clone()?;
        file.seek(SeekFrom::Start(index))?;
        let mut reader = BufReader::with_capacity(1 << 16, file);
        for _ in 0..entries {
            let mut bytes = [0; ENTRY as usize];
            reader.read_exact(&mut bytes)?;
            let (frame, location) = (word(&bytes, 0), word(&bytes, 16));
            if location == 0 || frame > self.frame {
                break;
            }
            let id = u16::from_le_bytes([bytes[28], bytes[29]]);
            let (rows, columns, kind) = (word(&bytes, 8), half_word(&bytes, 24), bytes[30]);
            let entry = Entry { rows, columns, location, kind };
            if frame == 0 {
                self.entries.insert((false, id), entry);
            }
            if frame == self.frame {
                self.entries.insert((true, id), entry);
            }
        }
        Ok(())
    }

    fn place(&self) -> String {
        format!("frame {}", self.frame)
    }

    fn entry(&self, here: bool, name: &str) -> Option<Entry> {
        self.entries.get(&(here, *self.ids.get(name)?)).copied()
    }

    /// An array of the frame, or of the first one if that serves.
    fn entry_or_first(&self, name: &str, first_serves: bool) -> Option<Entry> {
        self.entry(true, name).or_else(|| self.entry(false, name).filter(|_| first_serves))
    }

    fn wrong(&self, name: &str, found: &str, accepted: &str) -> Mistakes {
        Mistake::new(self.place(), format!("found `{name}` {found}"), accepted).into()
    }

    /// The bytes of an array, all of which have to lie in the file.
    fn bytes(&mut self, name: &str, entry: Entry) -> Result<Vec<u8>, Mistakes> {
        let inside = |bytes: &u64| entry.location.checked_add(*bytes).is_some_and(|end| end <= self.length);
        let Some(bytes) = entry.bytes().filter(inside) else {
            return Err(self.wrong(name, "beyond the end of the file, or of an unknown type", "a whole GSD file"));
        };
        self.file.seek(SeekFrom::Start(entry.location))?;
        let mut content = vec![0; bytes as usize];
        self.file.read_exact(&mut content)?;
        Ok(content)
    }

    /// The numbers of an array of so many rows and columns; double precision holds all that is not of 64 bits.
    fn numbers<const COLUMNS: usize>(
        &mut self,
        name: &str,
        entry: Entry,
        rows: u64,
    ) -> Result<Vec<[f64; COLUMNS]>, Mistakes> {
        if entry.rows != rows || entry.columns as usize != COLUMNS {
            let found = format!("of {} × {} numbers", entry.rows, entry.columns);
            return Err(self.wrong(name, &found, &format!("{rows} × {COLUMNS} numbers")));
        }
        let bytes = self.bytes(name, entry)?;
        Ok(match entry.kind {
            1 => convert(&bytes, |word| u8::from_le_bytes(word).into()),
            2 => convert(&bytes, |word| u16::from_le_bytes(word).into()),
            3 => convert(&bytes, |word| u32::from_le_bytes(word).into()),
            4 => convert(&bytes, |word| u64::from_le_bytes(word) as f64),
            5 => convert(&bytes, |word| i8::from_le_bytes(word).into()),
            6 => convert(&bytes, |word| i16::from_le_bytes(word).into()),
            7 => convert(&bytes, |word| i32::from_le_bytes(word).into()),
            8 => convert(&bytes, |word| i64::from_le_bytes(word) as f64),
            9 => convert(&bytes, |word| f32::from_le_bytes(word).into()),
            10 => convert(&bytes, f64::from_le_bytes),
            _ => return Err(self.wrong(name, "of text", "numbers")),
        })
    }

    /// A whole number; none where neither frame has it.
    fn number(&mut self, name: &str) -> Result<Option<u64>, Mistakes> {
        let Some(entry) = self.entry_or_first(name, true) else { return Ok(None) };
        let [value] = self.numbers::<1>(name, entry, 1)?[0];
        if value >= 0.0 && value.fract() == 0.0 && value <= MOST_PARTICLES as f64 {
            Ok(Some(value as u64))
        } else {
            Err(self.wrong(name, &format!("of {value}"), &format!("a whole number up to {MOST_PARTICLES}")))
        }
    }

    /// Names of types, each a row of characters; none where there is no row.
    fn names(&mut self, name: &str) -> Result<Option<Vec<String>>, Mistakes> {
        let Some(entry) = self.entry_or_first(name, true) else { return Ok(None) };
        if entry.rows > 1 << 16 || entry.size() != Some(1) {
            return Err(self.wrong(name, "of too many rows, or of something else than characters", "names of types"));
        }
        let bytes = self.bytes(name, entry)?;
        let rows = bytes.chunks(entry.columns.max(1) as usize);
        let text =
            |row: &[u8]| String::from_utf8_lossy(row.split(|byte| *byte == 0).next().unwrap_or_default()).into_owned();
        let names: Vec<String> = rows.map(text).collect();
        Ok(Some(names).filter(|names| !names.is_empty()))
    }

    /// Indices of types: whole numbers, each the place of a name.
    fn types(&mut self, name: &str, rows: u64, first_serves: bool, names: &[String]) -> Result<Vec<u32>, Mistakes> {
        let Some(entry) = self.entry_or_first(name, first_serves) else {
            return Ok(vec![0; usize::try_from(rows).unwrap_or(0)]);
        };
        let types = self.numbers::<1>(name, entry, rows)?;
        let is_one = |value: f64| value.fract() == 0.0 && (0.0..names.len().max(1) as f64).contains(&value);
        if let Some([bad]) = types.iter().find(|[value]| !is_one(*value)) {
            return Err(self.wrong(name, &format!("of {bad}"), &format!("the places of {} types", names.len())));
        }
        Ok(types.into_iter().map(|[value]| value as u32).collect())
    }

    /// An array of every particle, if it is there.
    fn of_particles<const COLUMNS: usize>(
        &mut self,
        name: &str,
        rows: u64,
        first_serves: bool,
    ) -> Result<Option<Vec<[f64; COLUMNS]>>, Mistakes> {
        match self.entry_or_first(name, first_serves) {
            Some(entry) => self.numbers(name, entry, rows).map(Some),
            None => Ok(None),
        }
    }

    /// Bonds or angles, type by type.
    fn links<const LENGTH: usize>(&mut self, folder: &str) -> Result<Vec<Links<LENGTH>>, Mistakes> {
        let rows = self.number(&format!("{folder}/N"))?.unwrap_or(0);
        if rows == 0 {
            return Ok(Vec::new());
        }
        let first_serves = self.first_has(&format!("{folder}/N"), rows)?;
        let names = self.names(&format!("{folder}/types"))?.unwrap_or_else(|| vec![String::new()]);
        let name = format!("{folder}/group");
        let Some(entry) = self.entry_or_first(&name, first_serves) else {
            return Err(self.wrong(&name, "missing", &format!("{rows} × {LENGTH} numbers")));
        };
        let groups = self.numbers::<LENGTH>(&name, entry, rows)?;
        let types = self.types(&format!("{folder}/typeid"), rows, first_serves, &names)?;
        let mut all: Vec<Links<LENGTH>> = names.into_iter().map(|name| Links { name, members: Vec::new() }).collect();
        for (members, kind) in groups.into_iter().zip(types) {
            // What is no number of a particle is the number of none that is there.
            let number = |value: f64| if value >= 0.0 && value.fract() == 0.0 { value as u32 } else { u32::MAX };
            all[kind as usize].members.push(members.map(number));
        }
        Ok(all)
    }

    /// Whether the first frame has as many of something, so that its arrays serve.
    fn first_has(&mut self, name: &str, count: u64) -> Result<bool, Mistakes> {
        let Some(entry) = self.entry(false, name) else { return Ok(count == 0) };
        let [value] = self.numbers::<1>(name, entry, 1)?[0];
        Ok(value == count as f64)
    }

    fn particles(mut self) -> Result<ParticleFile, Mistakes> {
        if let Some(count) = self.number(FROZEN_IN_GSD)? {
            return Err(frozen_layers(self.place(), count).into());
        }
        let count = self.number("particles/N")?.unwrap_or(0);
        let first_serves = self.first_has("particles/N", count)?;
        let species = self.names("particles/types")?.unwrap_or_else(|| vec!["A".to_owned()]);
        let Some(positions) = self.of_particles::<3>("particles/position", count, first_serves)? else {
            return Err(self.wrong("particles/position", "missing", "a position for every particle"));
        };
        let types = self.types("particles/typeid", count, first_serves, &species)?;
        let velocities = self.of_particles("particles/velocity", count, first_serves)?.unwrap_or_default();
        let images = self.of_particles::<3>("particles/image", count, first_serves)?.unwrap_or_default();
        let mut mistakes = Mistakes::default();
        let mut masses = SpeciesMasses::default();
        let of_particles = self.of_particles::<1>("particles/mass", count, first_serves)?.unwrap_or_default();
        for (particle, ([mass], species)) in of_particles.into_iter().zip(&types).enumerate() {
            masses.add(*species as usize, mass, || particle.to_string());
        }
        let dimension = self.number("configuration/dimensions")?.filter(|number| [2, 3].contains(number));
        let (lengths, displacements, dimension) = self.lengths(dimension.map(|number| number as usize))?;
        let is_image = |image: &[f64; 3]| image.iter().all(|turns| i32::try_from(*turns as i64).is_ok());
        if let Some(particle) = images.iter().position(|image| !is_image(image)) {
            let found = format!("found images of particle {particle} beyond 32 bits: {:?}", images[particle]);
            mistakes.push(Mistake::new(self.place(), found, "images from -2147483648 to 2147483647"));
        }
        let masses = masses.finish(&species, &mut mistakes);
        let (bonds, angles) = (self.links("bonds")?, self.links("angles")?);
        if !mistakes.is_empty() {
            return Err(mistakes);
        }
        Ok(ParticleFile {
            labelled: true,
            types,
            masses,
            dimension: Some(dimension),
            origin: lengths.map(|length| -0.5 * length),
            lengths: Some(lengths),
            displacements,
            positions,
            velocities,
            images: images.into_iter().map(|image| image.map(|turns| turns as i32)).collect(),
            bonds,
            angles,
            unused: self.unused(),
            species,
            ..ParticleFile::default()
        })
    }

    /// The edges of the box, the third one as 1 where it has none, how far copies above it are displaced, and the number of dimensions.
    fn lengths(&mut self, dimension: Option<usize>) -> Result<([f64; 3], [f64; 3], usize), Mistakes> {
        let name = "configuration/box";
        let Some(entry) = self.entry_or_first(name, true) else {
            return Err(self.wrong(name, "missing", "a box"));
        };
        let numbers: Vec<[f64; 1]> = self.numbers(name, entry, 6)?;
        let [x, y, mut z, xy, xz, yz] = std::array::from_fn(|at| numbers[at][0]);
        let dimension = dimension.unwrap_or(if z == 0.0 { 2 } else { 3 });
        let Some(displacements) = displacements(xy * y, xz * z, yz) else {
            return Err(triclinic(self.place(), &format!("xy = {xy}, xz = {xz}, yz = {yz}")).into());
        };
        if z == 0.0 && dimension == 2 {
            z = 1.0;
        }
        if let Some(mistake) = box_mistake(&[x, y, z]) {
            return Err(Mistake { place: self.place(), ..mistake }.into());
        }
        Ok(([x, y, z], displacements, dimension))
    }

    /// Arrays of particles and of topology that are read by nobody.
    fn unused(&self) -> Vec<String> {
        const NAMES: [&str; 11] = [
            "particles/charge",
            "particles/diameter",
            "particles/body",
            "particles/moment_inertia",
            "particles/orientation",
            "particles/angmom",
            "particles/type_shapes",
            "dihedrals/group",
            "impropers/group",
            "constraints/group",
            "pairs/group",
        ];
        let is_there = |name: &&str| self.entry_or_first(name, true).is_some_and(|entry| entry.rows > 0);
        NAMES.into_iter().filter(is_there).map(|name| format!("`{name}`")).collect()
    }
}

/// Numbers of a known size, row by row.
fn convert<const SIZE: usize, const COLUMNS: usize>(
    bytes: &[u8],
    number: impl Fn([u8; SIZE]) -> f64,
) -> Vec<[f64; COLUMNS]> {
    let one = |row: &[u8], column: usize| row[column * SIZE..(column + 1) * SIZE].try_into().map_or(f64::NAN, &number);
    bytes.chunks_exact(SIZE * COLUMNS).map(|row| std::array::from_fn(|column| one(row, column))).collect()
}

/// Names of version 2: one after the other, each ended by a zero.
fn packed(list: &[u8]) -> HashMap<String, u16> {
    let names = list.split(|byte| *byte == 0).take_while(|name| !name.is_empty());
    numbered(names)
}

/// Names of version 1: each in its own field.
fn padded(list: &[u8]) -> HashMap<String, u16> {
    let names = list.chunks(NAME as usize).map(|field| field.split(|byte| *byte == 0).next().unwrap_or_default());
    numbered(names.take_while(|name| !name.is_empty()))
}

fn numbered<'a>(names: impl Iterator<Item = &'a [u8]>) -> HashMap<String, u16> {
    names.zip(0..=u16::MAX).map(|(name, id)| (String::from_utf8_lossy(name).into_owned(), id)).collect()
}
