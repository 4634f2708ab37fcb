//! Data files of LAMMPS, of atoms in style `full`: <https://docs.lammps.org/read_data.html>.

use super::{Links, ParticleFile};
use std::collections::HashSet;
use std::io::{self, Write};

/// Writes particles as a data file of LAMMPS, of atoms in style `full`: with masses, charges, velocities, images, bonds and angles as far as they
/// are there. Particles that bonds join are a molecule; numbers start at 1. Names of types are those of the particles, without blanks, hashes and
/// quotes. What has no mass has 1.
///
/// ```
/// use mesoscope::state_file::{self, ParticleFile};
///
/// let pair = ParticleFile {
///     species: vec!["A".to_owned()],
///     labelled: true,
///     types: vec![0, 0],
///     lengths: Some([4.0, 4.0, 4.0]),
///     positions: vec![[1.0, 2.0, 3.0], [1.5, 2.0, 3.0]],
///     ..ParticleFile::default()
/// };
/// let mut text = Vec::new();
/// state_file::write_lammps(&pair, "a pair", &mut text)?;
/// let text = String::from_utf8(text)?;
/// assert!(text.contains("Atoms # full\n\n1 1 1 0 1 2 3\n2 2 1 0 1.5 2 3\n"), "{text}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// Those of `out`.
pub fn write_lammps(file: &ParticleFile, title: &str, out: &mut dyn Write) -> io::Result<()> {
    let title = title.replace(char::is_control, " ");
    writeln!(out, "{title}, written by mesoscope\n")?;
    write_counts(file, out)?;
    write_box(file, out)?;
    if file.labelled {
        write_labels("Atom", &labels(file.species.iter()), out)?;
    }
    write_labels("Bond", &labels(file.bonds.iter().map(|links| &links.name)), out)?;
    write_labels("Angle", &labels(file.angles.iter().map(|links| &links.name)), out)?;
    writeln!(out, "Masses\n")?;
    for kind in 0..file.species.len() {
        writeln!(out, "{} {}", kind + 1, file.masses.get(kind).copied().flatten().unwrap_or(1.0))?;
    }
    write_atoms(file, out)?;
    if !file.velocities.is_empty() {
        writeln!(out, "\nVelocities\n")?;
        for (particle, [x, y, z]) in file.velocities.iter().enumerate() {
            writeln!(out, "{} {x} {y} {z}", particle + 1)?;
        }
    }
    write_links("Bonds", &file.bonds, out)?;
    write_links("Angles", &file.angles, out)
}

fn write_counts(file: &ParticleFile, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "{} atoms\n{} atom types", file.len(), file.species.len())?;
    if !file.bonds.is_empty() {
        writeln!(out, "{} bonds\n{} bond types", members(&file.bonds), file.bonds.len())?;
    }
    if !file.angles.is_empty() {
        writeln!(out, "{} angles\n{} angle types", members(&file.angles), file.angles.len())?;
    }
    writeln!(out)
}

fn members<const LENGTH: usize>(links: &[Links<LENGTH>]) -> usize {
    links.iter().map(|links| links.members.len()).sum()
}

/// The box; along axes that a scene lacks it is one unit about zero, as LAMMPS wants it.
fn write_box(file: &ParticleFile, out: &mut dyn Write) -> io::Result<()> {
    let lengths = file.lengths.unwrap_or([1.0; 3]);
    for (axis, name) in super::AXES.iter().enumerate() {
        let low = if axis < file.dimension.unwrap_or(3) { file.origin[axis] } else { -0.5 };
        let high = low + if axis < file.dimension.unwrap_or(3) { lengths[axis] } else { 1.0 };
        writeln!(out, "{low} {high} {name}lo {name}hi")?;
    }
    let [_, second, third] = file.displacements;
    if [second, third] != [0.0; 2] {
        writeln!(out, "{second} {third} 0 xy xz yz")?;
    }
    writeln!(out)
}

/// Names as labels of types, each of which is another: a word without hashes and quotes that begins with no digit and no star.
fn labels<'a>(names: impl Iterator<Item = &'a String>) -> Vec<String> {
    let mut taken = HashSet::new();
    let label = |(number, name): (usize, &String)| {
        let is_plain = |letter: char| !letter.is_whitespace() && !letter.is_control() && !"#\"'".contains(letter);
        let word: String = name.chars().map(|letter| if is_plain(letter) { letter } else { '_' }).collect();
        let is_label = word.starts_with(|first: char| !first.is_ascii_digit() && first != '*');
        let label = if is_label { word } else { format!("type_{word}") };
        if taken.insert(label.clone()) {
            return label;
        }
        let other = format!("{label}_{}", number + 1);
        taken.insert(other.clone());
        other
    };
    names.enumerate().map(label).collect()
}

fn write_labels(noun: &str, labels: &[String], out: &mut dyn Write) -> io::Result<()> {
    if labels.is_empty() {
        return Ok(());
    }
    writeln!(out, "{noun} Type Labels\n")?;
    for (kind, label) in labels.iter().enumerate() {
        writeln!(out, "{} {label}", kind + 1)?;
    }
    writeln!(out)
}

fn write_atoms(file: &ParticleFile, out: &mut dyn Write) -> io::Result<()> {
    let molecules = molecules(file);
    let origin = |axis: usize| if axis < file.dimension.unwrap_or(3) { 1.0 } else { 0.0 };
    writeln!(out, "\nAtoms # full\n")?;
    for (particle, (kind, position)) in file.types.iter().zip(&file.positions).enumerate() {
        let charge = file.charges.get(*kind as usize).copied().flatten().unwrap_or(0.0);
        let [x, y, z] = [0, 1, 2].map(|axis| origin(axis) * position[axis]);
        write!(out, "{} {} {} {charge} {x} {y} {z}", particle + 1, molecules[particle], kind + 1)?;
        if let Some([i, j, k]) = file.images.get(particle) {
            write!(out, " {i} {j} {k}")?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// The first particle of the molecule of a particle, whose way there becomes shorter.
fn first_of(firsts: &mut [u32], mut particle: u32) -> u32 {
    while firsts[particle as usize] != particle {
        let above = firsts[firsts[particle as usize] as usize];
        firsts[particle as usize] = above;
        particle = above;
    }
    particle
}

/// The number of the molecule of each particle, from 1, in the order of their first particles.
fn molecules(file: &ParticleFile) -> Vec<u32> {
    let mut firsts: Vec<u32> = (0..file.len() as u32).collect();
    for [a, b] in file.bonds.iter().flat_map(|links| &links.members) {
        let [a, b] = [first_of(&mut firsts, *a), first_of(&mut firsts, *b)];
        firsts[a.max(b) as usize] = a.min(b);
    }
    let mut numbers = vec![0; firsts.len()];
    let mut count = 0;
    for particle in 0..firsts.len() {
        let first = first_of(&mut firsts, particle as u32) as usize;
        if first == particle {
            count += 1;
            numbers[particle] = count;
        } else {
            numbers[particle] = numbers[first];
        }
    }
    numbers
}

fn write_links<const LENGTH: usize>(section: &str, all: &[Links<LENGTH>], out: &mut dyn Write) -> io::Result<()> {
    if members(all) == 0 {
        return Ok(());
    }
    writeln!(out, "\n{section}\n")?;
    let each = (1..).zip(all).flat_map(|(kind, links)| links.members.iter().map(move |members| (kind, members)));
    for (number, (kind, members)) in (1_u64..).zip(each) {
        let ends = members.map(|member: u32| (u64::from(member) + 1).to_string());
        writeln!(out, "{number} {kind} {}", ends.join(" "))?;
    }
    Ok(())
}
