//! Extended XYZ: text that most viewers read. Positions lie in `[0, L]`; real numbers have single precision.
//!
//! A line of a particle holds, in this order:
//!
//! - `species`: a chemical symbol, for ASE reads nothing else and others choose colours by it. A species that is not named
//!   by one gets one that no other has (`He` in the absence of helium), and its name stands in `species_name` at the end.
//! - `pos`, `velo`: position and velocity (of these names in OVITO and QUIP).
//! - `masses`, `momenta`: as ASE has them, whose velocities are momenta over masses.
//! - `map_shift`: how often the particle has gone round the box (OVITO's periodic image).
//! - `id`: where a trajectory has some species only, the number of the particle in the scene, from 0.
//!
//! Where boundaries shear, the second or the third vector of `Lattice` leans along x as far as they are displaced, and there is no `map_shift`.
//!
//! The comment line has the id of the run. All numbers are in the units of the scene. `Lattice` has three vectors in any
//! dimension, and `pbc` says which are real.

use super::{Description, Format, Frames};
use crate::output::records::RecordFile;
use crate::output::{Extent, Id, OutputError, files, id, own_file};
use crate::state::Reported;
use crate::state_file::{FROZEN, elements};
use std::io::{BufRead, BufReader, Read, Write};
use std::path::Path;

pub(super) const FORMAT: Format = Format {
    file: files::TRAJECTORY_XYZ,
    // A species and a dozen numbers.
    bytes_per_particle: 110,
    create: |path| Ok(Box::new(ExtendedXyz::of(RecordFile::create(path)?))),
    resume: |path, written| Ok(Box::new(ExtendedXyz::of(RecordFile::resume(path, written)?))),
    id_of,
};

#[derive(Debug)]
struct ExtendedXyz {
    records: RecordFile,
    frame: Vec<u8>,
}

impl ExtendedXyz {
    fn of(records: RecordFile) -> Self {
        Self { records, frame: Vec::new() }
    }
}

impl Frames for ExtendedXyz {
    fn extent(&self) -> Extent {
        self.records.extent()
    }

    fn check(&self) -> Result<(), OutputError> {
        self.records.check()
    }

    fn append(&mut self, description: &Description, state: &Reported) -> Result<(), OutputError> {
        description.check(self.records.path(), state)?;
        self.frame.clear();
        write_frame(&mut self.frame, description, state).map_err(OutputError::io("write", self.records.path()))?;
        self.records.append(&self.frame)
    }

    fn flush(&mut self) -> Result<(), OutputError> {
        self.records.sync()
    }
}

/// The id in the comment line of the first frame.
fn id_of(path: &Path) -> Option<Id> {
    // A line that never ends is no comment of ours.
    let mut lines = BufReader::new(own_file::open(path).ok()?.take(1 << 12)).lines();
    let comment = lines.nth(1)?.ok()?;
    let key = |word: &str| word.strip_prefix(id::RUN_KEY)?.strip_prefix('=').and_then(Id::parse);
    comment.split(' ').find_map(key)
}

fn write_frame(text: &mut Vec<u8>, description: &Description, state: &Reported) -> std::io::Result<()> {
    let [x, y, z] = description.units.edges();
    let is_periodic = |axis: usize| axis < description.units.dimension.max(1) && description.units.gaps[axis] == 0.0;
    let periodic = [0, 1, 2].map(|axis| if is_periodic(axis) { "T" } else { "F" }).join(" ");
    let time = description.time.at(state.step);
    let is_bad = |character: char| character.is_whitespace() || character.is_control();
    // Each as one word of the format.
    let word = |name: &str| if name.is_empty() { "_".to_owned() } else { name.replace(is_bad, "_") };
    let names: Vec<String> = description.species.iter().map(|species| word(&species.name)).collect();
    let symbols = elements::symbols(&names.iter().map(String::as_str).collect::<Vec<_>>());
    let named = names != symbols;
    let frozen = description.frozen_particles(state).map(|frozen| format!(" {FROZEN}={frozen}")).unwrap_or_default();
    writeln!(text, "{}", state.len())?;
    let [_, second, third] = description.tilts(state.step);
    writeln!(
        text,
        "Lattice=\"{x} 0 0 {second} {y} 0 {third} 0 {z}\" \
         Properties=species:S:1:pos:R:3:velo:R:3:masses:R:1:momenta:R:3{}{}{}{} pbc=\"{periodic}\" Step={} \
         Time={time} {}={}{frozen}",
        if description.are_charged() { ":initial_charges:R:1" } else { "" },
        if description.shear.is_none() { ":map_shift:I:3" } else { "" },
        if description.numbers.is_some() { ":id:I:1" } else { "" },
        if named { ":species_name:S:1" } else { "" },
        state.step,
        description.run.key(),
        description.run
    )?;
    for particle in 0..state.len() {
        let species = state.species[particle] as usize;
        let mass = description.kinematics.mass(state, particle);
        let velocity = description.kinematics.velocity(state, particle);
        let mut position = description.units.position(state.positions[particle]);
        if let Some((axis, edges)) = description.displaced(state.step) {
            // Into the cell that leans.
            let lean = edges * position[axis] / description.units.lengths[axis] * x;
            position[0] = lean + (position[0] - lean).rem_euclid(x);
        }
        let [x, y, z] = position.map(|value| value as f32);
        let [u, v, w] = velocity.map(|value| value as f32);
        let [p, q, r] = velocity.map(|value| (mass * value) as f32);
        let symbol = symbols[species];
        write!(text, "{symbol} {x} {y} {z} {u} {v} {w} {} {p} {q} {r}", mass as f32)?;
        if description.are_charged() {
            write!(text, " {}", description.species[species].charge as f32)?;
        }
        if description.shear.is_none() {
            let [i, j, k] = state.image(particle);
            write!(text, " {i} {j} {k}")?;
        }
        if let Some(number) = description.numbers.as_ref().and_then(|numbers| numbers.get(particle)) {
            write!(text, " {number}")?;
        }
        if named {
            write!(text, " {}", names[species])?;
        }
        writeln!(text)?;
    }
    Ok(())
}
