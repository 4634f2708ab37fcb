//! HOOMD's GSD in the schema `hoomd`: <https://gsd.readthedocs.io/en/stable/schema-hoomd.html>.
//!
//! A file that is damaged, or changes meanwhile, is refused, and of a long trajectory nothing but two frames is read. A frame takes
//! what it lacks from the first one, and that from the defaults of the schema.

use super::file_layer::{Chunk, Cursor, GsdError, GsdReader, until_zero};
use super::{
    CHARGE, FROZEN_IN_GSD, Fits, Links, MASS, Mistake, Mistakes, NumbersOfSpecies, ParticleFile, SharedNumber,
    box_mistake, displacements, frozen_layers, place_of_frame, triclinic,
};
use crate::state::MOST_PARTICLES;
use std::collections::HashMap;
use std::fs::File;
use std::io::Read;

/// A file with the arrays of its first frame and of the one that is asked for.
struct Gsd {
    file: GsdReader,
    frame: u64,
    /// By whether it is the frame that is asked for, and by name.
    chunks: HashMap<(bool, String), Chunk>,
}

impl From<GsdError> for Mistakes {
    fn from(error: GsdError) -> Self {
        let damaged = match error {
            GsdError::Io(error) => return error.into(),
            GsdError::Version(version) => {
                let found = format!("found version {version} of the file layer of GSD");
                return Mistake::new("", found, "versions 1 and 2").into();
            }
            GsdError::Cut => "it was cut short, or is damaged: parts of it should lie beyond its end".to_owned(),
            error => format!("it is damaged: {error}"),
        };
        Mistake::new("", damaged, "a whole GSD file").into()
    }
}

pub(super) fn read(file: File, frame: i64, fits: &Fits<'_>) -> Result<ParticleFile, Mistakes> {
    Gsd::open(GsdReader::new(file)?, frame)?.particles(fits)
}

impl Gsd {
    fn open(mut file: GsdReader, frame: i64) -> Result<Self, Mistakes> {
        let (schema, (version, _)) = (file.schema(), file.schema_version());
        if schema != "hoomd" || ![1, 2].contains(&version) {
            let found = format!("found the schema `{schema}` in version {version}");
            return Err(Mistake::new("", found, "a GSD file of the schema `hoomd` in version 1 or 2").into());
        }
        let frames = file.frames()?;
        let frame = place_of_frame(frame, frames)?;
        let (mut cursor, mut chunks) = (Cursor::default(), HashMap::new());
        while let Some(chunk) = file.next(&mut cursor)?.filter(|chunk| chunk.frame <= frame) {
            let Some(name) = file.name(chunk) else { continue };
            for here in [false, true].into_iter().filter(|here| chunk.frame == if *here { frame } else { 0 }) {
                chunks.insert((here, name.to_owned()), chunk);
            }
        }
        Ok(Self { file, frame, chunks })
    }

    fn place(&self) -> String {
        format!("frame {}", self.frame)
    }

    fn entry(&self, here: bool, name: &str) -> Option<Chunk> {
        self.chunks.get(&(here, name.to_owned())).copied()
    }

    /// An array of the frame, or of the first one if that serves.
    fn entry_or_first(&self, name: &str, first_serves: bool) -> Option<Chunk> {
        self.entry(true, name).or_else(|| self.entry(false, name).filter(|_| first_serves))
    }

    fn wrong(&self, name: &str, found: &str, accepted: &str) -> Mistakes {
        Mistake::new(self.place(), format!("found `{name}` {found}"), accepted).into()
    }

    /// The bytes of an array, all of which have to lie in the file.
    fn bytes(&mut self, name: &str, entry: Chunk) -> Result<Vec<u8>, Mistakes> {
        let mut bytes = Vec::new();
        match self.file.content(entry).and_then(|mut content| Ok(content.read_to_end(&mut bytes)?)) {
            Ok(_) => Ok(bytes),
            Err(GsdError::Cut) => {
                Err(self.wrong(name, "beyond the end of the file, or of an unknown type", "a whole GSD file"))
            }
            Err(error) => Err(error.into()),
        }
    }

    /// The numbers of an array of so many rows and columns; double precision holds all that is not of 64 bits.
    fn numbers<const COLUMNS: usize>(
        &mut self,
        name: &str,
        entry: Chunk,
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
        let text = |row: &[u8]| String::from_utf8_lossy(until_zero(row)).into_owned();
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
        self.entry_or_first(name, first_serves).map(|entry| self.numbers(name, entry, rows)).transpose()
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

    fn particles(mut self, fits: &Fits<'_>) -> Result<ParticleFile, Mistakes> {
        if let Some(count) = self.number(FROZEN_IN_GSD)? {
            return Err(frozen_layers(self.place(), count).into());
        }
        let count = self.number("particles/N")?.unwrap_or(0);
        fits(count)?;
        let first_serves = self.first_has("particles/N", count)?;
        let species = self.names("particles/types")?.unwrap_or_else(|| vec!["A".to_owned()]);
        let Some(positions) = self.of_particles::<3>("particles/position", count, first_serves)? else {
            return Err(self.wrong("particles/position", "missing", "a position for every particle"));
        };
        let types = self.types("particles/typeid", count, first_serves, &species)?;
        let velocities = self.of_particles("particles/velocity", count, first_serves)?.unwrap_or_default();
        let images = self.of_particles::<3>("particles/image", count, first_serves)?.unwrap_or_default();
        let mut mistakes = Mistakes::default();
        let mut of_species = |name: &str, shared: SharedNumber| -> Result<_, Mistakes> {
            let mut numbers = NumbersOfSpecies::new(shared);
            let of_particles = self.of_particles::<1>(name, count, first_serves)?.unwrap_or_default();
            for (particle, ([number], species)) in of_particles.into_iter().zip(&types).enumerate() {
                numbers.add(*species as usize, number, || particle.to_string());
            }
            Ok(numbers.finish(&species))
        };
        let (masses, mass_mistakes) = of_species("particles/mass", MASS)?;
        let (charges, charge_mistakes) = of_species("particles/charge", CHARGE)?;
        mistakes.extend(mass_mistakes);
        let dimension = self.number("configuration/dimensions")?.filter(|number| [2, 3].contains(number));
        let (lengths, displacements, dimension) = self.lengths(dimension.map(|number| number as usize))?;
        let is_image = |image: &[f64; 3]| image.iter().all(|turns| i32::try_from(*turns as i64).is_ok());
        if let Some(particle) = images.iter().position(|image| !is_image(image)) {
            let found = format!("found images of particle {particle} beyond 32 bits: {:?}", images[particle]);
            mistakes.push(Mistake::new(self.place(), found, "images from -2147483648 to 2147483647"));
        }
        let (bonds, angles) = (self.links("bonds")?, self.links("angles")?);
        mistakes.refuse()?;
        Ok(ParticleFile {
            labelled: true,
            types,
            masses,
            charges,
            charge_mistakes,
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
        const NAMES: &str = "\
            particles/diameter particles/body particles/moment_inertia particles/orientation particles/angmom \
            particles/type_shapes dihedrals/group impropers/group constraints/group pairs/group";
        let is_there = |name: &&str| self.entry_or_first(name, true).is_some_and(|entry| entry.rows > 0);
        NAMES.split(' ').filter(is_there).map(|name| format!("`{name}`")).collect()
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
