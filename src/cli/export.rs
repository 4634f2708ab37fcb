//! `mesoscope export`: particles as a data file of LAMMPS.

use std::path::PathBuf;

use mesoscope::output::write_atomically;
use mesoscope::{printable, scene, state_file};

use super::{Failure, heading, print};

/// Write the particles of a run, or of a frame of a file, as a data file of LAMMPS
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  mesoscope export dpd-fluid                          the last checkpoint of a run, into dpd-fluid.data
  mesoscope export trajectory.gsd --frame 0 --out start.data

Atoms are of the style `full`: with molecules, charges, images, bonds and angles; masses and velocities beside them. Lengths, masses and times are those of the
scene, and charges elementary ones: in units `lj` of LAMMPS, where temperatures are 1, multiply them by the root of the Bjerrum length.")]
pub struct Arguments {
    /// Directory of a run, or a file in GSD, extended XYZ or the data format of LAMMPS
    #[arg(value_name = "SOURCE")]
    source: PathBuf,

    /// Frame of a file, from 0; negative ones are counted from the end
    #[arg(long, default_value_t = -1, allow_negative_numbers = true, value_name = "N")]
    frame: i64,

    /// The file [default: SOURCE.data]
    #[arg(long, help_heading = heading::OUTPUT, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Replace a file that is there
    #[arg(long, help_heading = heading::OUTPUT)]
    force: bool,
}

/// Writes the file.
pub fn execute(arguments: &Arguments) -> Result<(), Failure> {
    // A directory may be called `.`.
    let source = std::fs::canonicalize(&arguments.source).unwrap_or_else(|_| arguments.source.clone());
    let default = || PathBuf::from(source.file_name().unwrap_or("particles".as_ref())).with_added_extension("data");
    let out = arguments.out.clone().unwrap_or_else(default);
    let shown = printable::path(&out);
    if out.exists() && !arguments.force {
        let message = format!("`{shown}` exists; give another name with --out, or replace it with --force");
        return Err(Failure::input_output(message));
    }
    let particles = scene::particles_of(&arguments.source, arguments.frame)
        .map_err(|error| Failure::input_output(error.to_string()))?;
    let title = printable::path(&arguments.source);
    write_atomically(&out, |writer| state_file::write_lammps(&particles, &title, writer))?;
    let has_mass = |kind: &usize| particles.masses.get(*kind).copied().flatten().is_some();
    let without = (0..particles.species.len()).filter(|kind| !has_mass(kind));
    let without: Vec<_> = without.map(|kind| format!("`{}`", printable::name(&particles.species[kind]))).collect();
    let masses = if without.is_empty() {
        String::new()
    } else {
        format!(", without masses of {}: they are 1", without.join(", "))
    };
    print(&format!("{shown}: {} particles{masses}\n", particles.len()))
}
