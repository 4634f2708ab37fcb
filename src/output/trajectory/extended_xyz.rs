//! Extended XYZ: text that most viewers read. Positions lie in `[0, L]`; real numbers have single precision.
//! Species keep their names, which OVITO accepts; ASE reads the file only where they are chemical symbols.

use super::Description;
use crate::output::OutputError;
use crate::output::records::RecordFile;
use crate::state::State;
use std::fs::File;
use std::io::{BufRead, BufReader, Write};
use std::path::Path;

#[derive(Debug)]
pub(super) struct ExtendedXyz {
    records: RecordFile,
    frame: Vec<u8>,
}

impl ExtendedXyz {
    pub(super) fn create(path: &Path) -> Result<Self, OutputError> {
        Ok(Self { records: RecordFile::create(path)?, frame: Vec::new() })
    }

    pub(super) fn resume(path: &Path, step: u64) -> Result<Self, OutputError> {
        let kept = length_up_to(path, step)?;
        Ok(Self { records: RecordFile::resume(path, kept)?, frame: Vec::new() })
    }

    pub(super) fn append(&mut self, description: &Description, state: &State) -> Result<(), OutputError> {
        description.check(self.records.path(), state)?;
        self.frame.clear();
        write_frame(&mut self.frame, description, state).map_err(OutputError::io("write", self.records.path()))?;
        self.records.append(&self.frame)
    }

    pub(super) fn flush(&mut self) -> Result<(), OutputError> {
        self.records.sync()
    }
}

fn write_frame(text: &mut Vec<u8>, description: &Description, state: &State) -> std::io::Result<()> {
    let [x, y, z] = description.units.lengths;
    let periodic = ["T F F", "T T F", "T T T"][description.units.dimension.clamp(1, 3) - 1];
    let time = state.step as f64 * description.time_step;
    writeln!(text, "{}", state.len())?;
    writeln!(
        text,
        "Lattice=\"{x} 0 0 0 {y} 0 0 0 {z}\" Properties=species:S:1:pos:R:3:velo:R:3 pbc=\"{periodic}\" Step={} Time={time}",
        state.step
    )?;
    // A name is one word in this format.
    let names: Vec<String> =
        description.species.iter().map(|species| species.name.replace(char::is_whitespace, "_")).collect();
    for particle in 0..state.len() {
        let [x, y, z] = description.units.position(state.positions[particle]).map(|value| value as f32);
        let [u, v, w] = description.velocity(state, particle).map(|value| value as f32);
        let name = &names[state.species[particle] as usize];
        writeln!(text, "{name} {x} {y} {z} {u} {v} {w}")?;
    }
    Ok(())
}

/// Bytes of the whole frames whose step is at most `step`.
fn length_up_to(path: &Path, step: u64) -> Result<u64, OutputError> {
    let file = File::open(path).map_err(OutputError::io("continue", path))?;
    let mut lines = BufReader::new(file);
    let mut line = Vec::new();
    let mut number = 0;
    let mut kept = 0;
    // A line without its end was never finished, nor was its frame.
    let mut next = |line: &mut Vec<u8>| -> Result<Option<u64>, OutputError> {
        line.clear();
        let length = lines.read_until(b'\n', line).map_err(OutputError::io("read", path))? as u64;
        Ok((line.last() == Some(&b'\n')).then_some(length))
    };
    let wrong =
        |line: u64, problem: &str| OutputError::Line { path: path.to_path_buf(), line, problem: problem.to_owned() };
    loop {
        let Some(mut length) = next(&mut line)? else { return Ok(kept) };
        number += 1;
        let particles = std::str::from_utf8(&line).ok().and_then(|text| text.trim().parse::<u64>().ok());
        let particles = particles.ok_or_else(|| wrong(number, "expected the number of particles of a frame"))?;
        let Some(comment) = next(&mut line)? else { return Ok(kept) };
        number += 1;
        length += comment;
        let found = std::str::from_utf8(&line)
            .ok()
            .and_then(|text| text.split_whitespace().find_map(|word| word.strip_prefix("Step="))?.parse::<u64>().ok());
        let found = found.ok_or_else(|| wrong(number, "expected `Step=` and the step of the frame"))?;
        if found > step {
            return Ok(kept);
        }
        for _ in 0..particles {
            let Some(particle) = next(&mut line)? else { return Ok(kept) };
            number += 1;
            length += particle;
        }
        kept += length;
    }
}
