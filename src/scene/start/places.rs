//! Real positions of a file as integers, its bonds and angles with the copies that they reach, and a checksum of it all.

use super::{FileStart, OutsidePositions, StateFile, StateVelocities};
use crate::document::{FileLinks, FilePlaces};
use crate::state::{crossings, sheared_copy};
use crate::state_file::{Links, ParticleFile};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a scene keeps of a file without mistakes, in whose box of these edges all particles are; of the dimensions some may have
/// walls, and across one the copy of the box may be displaced along x, in 2⁻³² of the box.
pub(super) fn start(
    file: &ParticleFile,
    state: &StateFile,
    species: &[Option<u8>],
    (dimension, walled, sheared): (usize, [bool; 3], Option<(usize, u32)>),
    lengths: [f64; 3],
    species_of_scene: usize,
) -> FileStart {
    let copies = state.copies();
    let folded = |point: &[f64; 3]| -> [(u32, i32); 3] {
        let fold = |axis: usize| match (point[axis] - file.origin[axis]) / lengths[axis] {
            edges if walled[axis] => (fold(edges.clamp(0.0, LAST)).0, 0),
            edges => fold(edges),
        };
        std::array::from_fn(|axis| if axis < dimension { fold(axis) } else { (0, 0) })
    };
    let fractions = |points: &[[f64; 3]]| points.iter().map(|point| folded(point).map(|(part, _)| part)).collect();
    let positions: Vec<[u32; 3]> = fractions(&file.positions);
    let species: Vec<u8> =
        file.types.iter().map(|kind| species.get(*kind as usize).copied().flatten().unwrap_or(0)).collect();
    let image = |(particle, position): (usize, &[f64; 3])| -> [i32; 3] {
        let (image, folded) = (file.images.get(particle).copied().unwrap_or_default(), folded(position));
        std::array::from_fn(|axis| if axis < dimension { image[axis].saturating_add(folded[axis].1) } else { 0 })
    };
    let are_counted = !file.images.is_empty() || state.outside == OutsidePositions::Wrap;
    let counted = file.positions.iter().filter(|_| are_counted && copies == [1; 3]);
    let images = counted.enumerate().map(image).collect();
    let of_box = Cell { positions: &positions, species: &species, lengths, dimension, copies, sheared };
    let bonds = file.bonds.iter().map(|links| of_box.links(links)).collect();
    let angles = file.angles.iter().map(|links| of_box.links(links)).collect();
    let tethers = fractions(&file.tethers);
    let places = Some(FilePlaces { positions, velocities: Vec::new(), images, tethers, ..FilePlaces::default() });
    let fastest = vec![0.0; species_of_scene];
    let mut start = FileStart { copies, species, fastest, bonds, angles, places, ..FileStart::default() };
    if state.velocities == StateVelocities::File {
        set_in_motion(&mut start, &file.velocities, dimension);
    }
    start
}

/// Gives particles velocities, of which so many components count.
pub(super) fn set_in_motion(start: &mut FileStart, velocities: &[[f64; 3]], dimension: usize) {
    start.fastest.fill(0.0);
    let flat = |velocity: &[f64; 3]| std::array::from_fn(|axis| if axis < dimension { velocity[axis] } else { 0.0 });
    let velocities: Vec<[f64; 3]> = velocities.iter().map(flat).collect();
    for (velocity, species) in velocities.iter().zip(&start.species) {
        let most = &mut start.fastest[usize::from(*species)];
        *most = velocity.iter().fold(*most, |most: f64, part: &f64| most.max(part.abs()));
    }
    if let Some(places) = &mut start.places {
        places.velocities = velocities;
    }
}

/// The last fraction of an edge that does not round to the upper face.
const LAST: f64 = 1.0 - 1.0 / 4_294_967_296.0;

/// A coordinate in edges of the box: its fraction of an edge, in units of 2⁻³², and the whole turns round the box. What rounds to the
/// upper face is at the lower one, one turn further.
fn fold(edges: f64) -> (u32, i32) {
    let turns = edges.floor();
    let part = ((edges - turns) * 4_294_967_296.0).round();
    if part < 4_294_967_296.0 { (part as u32, turns as i32) } else { (0, turns as i32 + 1) }
}

/// The box of a file with its particles.
struct Cell<'a> {
    positions: &'a [[u32; 3]],
    species: &'a [u8],
    lengths: [f64; 3],
    dimension: usize,
    copies: [u32; 3],
    sheared: Option<(usize, u32)>,
}

impl Cell<'_> {
    fn links<const LENGTH: usize>(&self, links: &Links<LENGTH>) -> Arc<FileLinks<LENGTH>> {
        let mut spans: BTreeMap<(u8, u8), [f64; 2]> = BTreeMap::new();
        for members in &links.members {
            let [a, b] = [members[0] as usize, members[1] as usize];
            let distance = self.distance(a, b);
            let kinds = (self.species[a].min(self.species[b]), self.species[a].max(self.species[b]));
            let span = spans.entry(kinds).or_insert([distance; 2]);
            *span = [span[0].min(distance), span[1].max(distance)];
        }
        let shifts =
            if self.copies == [1; 3] { Vec::new() } else { links.members.iter().map(|all| self.shifts(all)).collect() };
        Arc::new(FileLinks {
            name: links.name.clone(),
            members: links.members.clone(),
            shifts,
            copies: self.copies,
            particles: self.positions.len() as u32,
            spans,
        })
    }

    /// The copies that particles are in, from that of the first, where each is near to the one before.
    fn shifts<const LENGTH: usize>(&self, members: &[u32; LENGTH]) -> [[i8; 3]; LENGTH] {
        let mut shifts = [[0; 3]; LENGTH];
        for at in 1..LENGTH {
            let [before, here] = [members[at - 1], members[at]].map(|member| self.positions[member as usize]);
            let crossed = crossings(before, here);
            shifts[at] = std::array::from_fn(|axis| shifts[at - 1][axis] + crossed[axis] as i8);
        }
        shifts
    }

    /// The shortest distance of two particles.
    fn distance(&self, a: usize, b: usize) -> f64 {
        let [a, b] = [a, b].map(|particle| self.positions[particle]);
        let b = self.sheared.map_or(b, |sheared| sheared_copy(a, b, sheared));
        let apart = (0..self.dimension).map(|axis| {
            let turns = a[axis].wrapping_sub(b[axis]).cast_signed();
            f64::from(turns) * self.lengths[axis] / 4_294_967_296.0
        });
        apart.map(|part| part * part).sum::<f64>().sqrt()
    }
}

/// CRC-32 of what a file says of particles, in hexadecimal digits.
pub(super) fn checksum(file: &ParticleFile) -> String {
    let mut sum = crc32fast::Hasher::new();
    let mut add = |name: &str, bytes: &[u8]| {
        sum.update(name.as_bytes());
        sum.update(&(bytes.len() as u64).to_le_bytes());
        sum.update(bytes);
    };
    for name in &file.species {
        add("species", name.as_bytes());
    }
    add("types", bytemuck::cast_slice(&file.types));
    add("box", bytemuck::cast_slice(&file.lengths.map_or(Vec::new(), |lengths| lengths.to_vec())));
    add("origin", bytemuck::cast_slice(&file.origin));
    add("positions", bytemuck::cast_slice(&file.positions));
    add("velocities", bytemuck::cast_slice(&file.velocities));
    add("images", bytemuck::cast_slice(&file.images));
    if !file.tethers.is_empty() {
        add("tethers", bytemuck::cast_slice(&file.tethers));
    }
    let masses: Vec<f64> = file.masses.iter().map(|mass| mass.unwrap_or(0.0)).collect();
    if file.displacements != [0.0; 3] {
        add("displacements", bytemuck::cast_slice(&file.displacements));
    }
    add("masses", bytemuck::cast_slice(&masses));
    let charges: Vec<f64> = file.charges.iter().map(|charge| charge.unwrap_or(0.0)).collect();
    if charges.iter().any(|charge| *charge != 0.0) {
        add("charges", bytemuck::cast_slice(&charges));
    }
    for links in &file.bonds {
        add(&links.name, bytemuck::cast_slice(&links.members));
    }
    for links in &file.angles {
        add(&links.name, bytemuck::cast_slice(&links.members));
    }
    format!("{:08x}", sum.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_folded_into_the_box() {
        for (edges, folded) in [
            (0.0, (0, 0)),
            (0.25, (1 << 30, 0)),
            (-0.25, (3 << 30, -1)),
            (2.75, (3 << 30, 2)),
            (1.0, (0, 1)),
            // The last unit, and half a unit more, which rounds to the upper face.
            (1.0 - 2.0_f64.powi(-32), (u32::MAX, 0)),
            (1.0 - 2.0_f64.powi(-33), (0, 1)),
            (-2.0_f64.powi(-34), (0, 0)),
        ] {
            assert_eq!(fold(edges), folded, "{edges}");
        }
    }
}
