//! How the integer state lies in the buffers and textures of a plan.

use crate::prediction;
use crate::state::{Hold, PairBath, State};

/// Units of the heaviest particle: single precision has to round them to integers.
pub(crate) const LARGEST_MASS: f64 = 8_388_607.0;

/// Bytes of a particle of [`Layout::Particles`] and [`Layout::Coupled`].
pub(crate) const PARTICLE: u64 = 32;

/// How the integer state lies in buffers and textures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// One array `particles` of position and id, momentum and species, with what a predicted momentum adds.
    Particles {
        /// Number of dimensions.
        dimension: usize,
        /// Whether particles carry predicted momenta.
        predicted: bool,
    },
    /// Shallow water: an array `particles` of position, velocity, mass and id, in textures two; tracers without mass apart
    /// from them; what the bath remembers of every node.
    Water {
        /// Number of particles with mass, which come first.
        carriers: usize,
        /// Number of tracers.
        tracers: usize,
        /// Nodes that have a bath variable; zero without a bath.
        bath_nodes: usize,
        /// Whether masses and ids of particles with mass are apart from their motion, both in textures.
        texels: bool,
        /// The bins of particles with mass, if they are not in one array.
        bins: Option<Bins>,
    },
    /// Voronoi cells: an array `particles` of position, mass and id, momentum, energy and species.
    Cells {
        /// Whether cells keep account of their energy.
        energies: bool,
    },
    /// Particles whose couplings add their impulses up: an array `particles` in the order of the last list, and by number or
    /// bond whatever else is remembered.
    Coupled {
        /// Number of dimensions.
        dimension: usize,
        /// Whether particles carry predicted momenta.
        predicted: bool,
        /// The list of neighbours, if there are pairs.
        listed: Option<Listed>,
        /// Whether baths on coordinates remember.
        position_baths: bool,
        /// Number of bonds, if their baths remember.
        bond_baths: usize,
        /// Whether there is a coloured noise.
        holds: bool,
        /// Whether particles are tied to where they started.
        tethers: bool,
    },
}

/// A list of neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Listed {
    /// Pairs for which one particle has room.
    pub capacity: usize,
    /// Whether the baths of pairs remember.
    pub memory: bool,
}

/// A bin of particles for every cell of a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bins {
    /// Cells on each axis.
    pub cells: [u32; 2],
    /// Particles that stay in a cell, for which its bin has places.
    pub capacity: usize,
    /// Particles that arrive in a step, for which it has places twice.
    pub arrivals: usize,
    /// Whether cells are centred on nodes, rather than between them.
    pub centred: bool,
}

impl Bins {
    fn cell(&self, position: [u32; 3]) -> usize {
        let along = |axis: usize| {
            let count = u64::from(self.cells[axis]);
            let shift = if self.centred { 1 << 31 } else { 0 };
            ((u64::from(position[axis]) * count + shift) >> 32) % count
        };
        (along(1) * u64::from(self.cells[0]) + along(0)) as usize
    }

    fn count(&self) -> usize {
        self.cells[0] as usize * self.cells[1] as usize
    }

    /// Puts particles into their bins: the bins, how many are in each, and none on their way.
    fn pack(&self, particles: &[[u32; WATER]]) -> Result<Vec<Vec<u32>>, Misfit> {
        let mut bins = vec![0; WATER * self.places() * self.count()];
        let mut stayed = vec![0; self.count()];
        for particle in particles {
            let cell = self.cell([particle[0], particle[1], 0]);
            let place = stayed[cell] as usize;
            if place == self.capacity {
                return Err(Misfit::Crowded);
            }
            let first = WATER * (cell * self.places() + place);
            bins[first..first + WATER].copy_from_slice(particle);
            stayed[cell] += 1;
        }
        Ok(vec![bins, stayed, vec![0; 2 * self.count()]])
    }

    fn places(&self) -> usize {
        self.capacity + 2 * self.arrivals
    }

    /// The particles in bins, those that have stayed and those that have arrived.
    fn particles<'a>(&self, bins: &'a [u32], stayed: &[u32], arrived: &[u32]) -> Vec<&'a [u32]> {
        let mut particles = Vec::new();
        for (cell, bin) in bins.chunks_exact(WATER * self.places()).enumerate().take(self.count()) {
            let bin: Vec<&[u32]> = bin.chunks_exact(WATER).collect();
            let low = stayed.get(cell).map_or(0, |word| (word & 0x7fff_ffff) as usize);
            particles.extend(bin.iter().take(low.min(self.capacity)));
            for turn in 0..2 {
                let high = arrived.get(turn * self.count() + cell).map_or(0, |count| *count as usize);
                particles.extend(bin.iter().skip(self.capacity + turn * self.arrivals).take(high.min(self.arrivals)));
            }
        }
        particles
    }
}

/// Why a state does not fit a layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Misfit {
    /// A bin would have to hold more particles than it can.
    Crowded,
    /// Something the layout stores is not in the state.
    Missing(String),
}

impl From<&str> for Misfit {
    fn from(what: &str) -> Self {
        Self::Missing(format!("{what} missing"))
    }
}

/// Words of a particle or tracer of shallow water, the first of which are its position and velocity.
const WATER: usize = 6;
const MOTION: usize = 4;

/// Particles taken apart: positions and velocities, masses and ids.
fn apart(particles: &[u32]) -> [Vec<u32>; 2] {
    let motion = particles.chunks_exact(WATER).flat_map(|particle| &particle[..MOTION]);
    let masses = particles.chunks_exact(WATER).flat_map(|particle| &particle[MOTION..]);
    [motion.copied().collect(), masses.copied().collect()]
}

/// What [`apart`] took apart.
fn together(motion: &[u32], masses: &[u32]) -> Vec<u32> {
    let pairs = motion.chunks_exact(MOTION).zip(masses.chunks_exact(WATER - MOTION));
    pairs.flat_map(|(motion, masses)| motion.iter().chain(masses)).copied().collect()
}

impl Layout {
    /// The buffers and textures that hold the state.
    #[must_use]
    pub fn buffers(&self) -> Vec<&'static str> {
        match *self {
            Self::Particles { .. } | Self::Cells { .. } => vec!["particles"],
            Self::Coupled { listed, position_baths, bond_baths, holds, tethers, .. } => {
                let optional = [
                    ("anchors", listed.is_some()),
                    ("neighbours", listed.is_some()),
                    ("memories", listed.is_some_and(|listed| listed.memory)),
                    ("position_baths", position_baths),
                    ("bond_baths", bond_baths > 0),
                    ("holds", holds),
                    ("tethers", tethers),
                ];
                let asked = optional.into_iter().filter(|(_, asked)| *asked).map(|(name, _)| name);
                std::iter::once("particles").chain(asked).collect()
            }
            Self::Water { tracers, bath_nodes, texels, bins, .. } => {
                let mut names = match (bins.is_some(), texels) {
                    (false, false) => vec!["particles"],
                    (false, true) => vec!["particles", "particle_masses"],
                    (true, false) => vec!["bins", "stayed", "arrived"],
                    (true, true) => vec!["bins", "bin_masses", "stayed", "arrived"],
                };
                if tracers > 0 {
                    names.push("tracers");
                }
                if bath_nodes > 0 {
                    names.extend(["previous_masses", "node_bath"]);
                }
                names
            }
        }
    }

    /// The contents of [`Self::buffers`], with the particles in a given order of their ids.
    ///
    /// ```
    /// use mesoscope::{plan::Layout, state::State};
    ///
    /// let layout = Layout::Particles { dimension: 2, predicted: false };
    /// let positions = vec![[1, 2, 0], [3, 4, 0]];
    /// let state = State { positions, momenta: vec![[-1, 1, 0]; 2], species: vec![0, 0], ..State::default() };
    /// // The order in storage is forgotten when the state is read back.
    /// let words = layout.pack(&state, &[1, 0]).map_err(|misfit| format!("{misfit:?}"))?;
    /// let contents: Vec<&[u32]> = words.iter().map(Vec::as_slice).collect();
    /// assert_eq!(layout.unpack(0, &contents, 2)?, state);
    /// # Ok::<(), String>(())
    /// ```
    ///
    /// # Errors
    /// [`Misfit`].
    pub fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        match *self {
            Self::Particles { predicted, .. } => Ok(vec![pack_particles(state, order, predicted)?]),
            Self::Cells { energies } => Ok(vec![pack_cells(state, order, energies)?]),
            Self::Coupled { predicted, listed, position_baths, bond_baths, holds, tethers, .. } => {
                let mut contents = vec![pack_particles(state, order, predicted)?];
                if let Some(listed) = listed {
                    contents.extend(listed.pack(state, order)?);
                }
                if position_baths {
                    contents.push(by_number(&state.position_baths, state.len(), "bath variables are", |s| {
                        [s[0], s[1], s[2], 0]
                    })?);
                }
                if bond_baths > 0 {
                    if state.bond_baths.len() != bond_baths {
                        return Err("bath variables of bonds are".into());
                    }
                    contents.push(state.bond_baths.clone());
                }
                if holds {
                    contents.push(by_number(
                        &state.holds,
                        state.len(),
                        "random forces are",
                        bytemuck::cast::<Hold, [u32; 6]>,
                    )?);
                }
                if tethers {
                    contents.push(by_number(&state.tethers, state.len(), "ends of tethers are", |r| {
                        [r[0], r[1], r[2], 0]
                    })?);
                }
                Ok(contents)
            }
            Self::Water { carriers, tracers, bath_nodes, texels, bins } => {
                if state.masses.len() != state.len() {
                    return Err("masses are".into());
                }
                if bath_nodes > 0 && state.node_bath.len() != bath_nodes {
                    return Err("bath variables are".into());
                }
                if bath_nodes > 0 && state.step > 0 && state.node_masses.len() != bath_nodes {
                    return Err("the mesh of the step before is".into());
                }
                if let Some(id) = state.masses.iter().position(|mass| f64::from(*mass) > LARGEST_MASS) {
                    let mass = state.masses[id];
                    return Err(Misfit::Missing(format!(
                        "the mass of particle {id} is {mass} units, more than the {LARGEST_MASS} that one particle may have"
                    )));
                }
                let particle = |id: &usize| {
                    let ([x, y, _], [u, v, _]) = (state.positions[*id], state.momenta[*id]);
                    [x, y, u as u32, v as u32, state.masses[*id], *id as u32]
                };
                let (water, drifting): (Vec<usize>, Vec<usize>) = order.iter().partition(|id| **id < carriers);
                let mut contents = match bins {
                    Some(bins) => bins.pack(&water.iter().map(particle).collect::<Vec<_>>())?,
                    None => vec![water.iter().flat_map(particle).collect::<Vec<u32>>()],
                };
                if texels {
                    let [motion, masses] = apart(&contents[0]);
                    contents.splice(0..1, [motion, masses]);
                }
                if tracers > 0 {
                    contents.push(drifting.iter().flat_map(particle).collect());
                }
                if bath_nodes > 0 {
                    let previous = state.node_masses.clone();
                    contents.push(if previous.is_empty() { vec![0; bath_nodes] } else { previous });
                    contents.push(state.node_bath.clone());
                }
                Ok(contents)
            }
        }
    }

    /// The state at a step in the contents of [`Self::buffers`]; what `pack` put in, in order of the ids.
    ///
    /// # Errors
    /// What is wrong with the contents.
    pub fn unpack(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state =
            State { step, positions: vec![[0; 3]; count], momenta: vec![[0; 3]; count], ..State::default() };
        let mut seen = vec![false; count];
        let mut place = |id: u32| {
            let place = id as usize;
            let fresh = seen.get_mut(place).is_some_and(|seen| !std::mem::replace(seen, true));
            if fresh { Ok(place) } else { Err(format!("a particle came back with number {id}")) }
        };
        let contents = |index: usize| contents.get(index).copied().unwrap_or_default();
        match *self {
            Self::Particles { dimension, predicted } => {
                unpack_particles(&mut state, contents(0), dimension, predicted, place)?;
            }
            Self::Cells { energies } => unpack_cells(&mut state, contents(0), energies, place)?,
            Self::Coupled { dimension, predicted, .. } => {
                unpack_particles(&mut state, contents(0), dimension, predicted, place)?;
                let particles = contents(0).chunks_exact(PARTICLE as usize / 4);
                let numbers: Vec<u32> = particles.take(count).map(|particle| particle[3]).collect();
                for (index, name) in self.buffers().into_iter().enumerate() {
                    self.unpack_array(&mut state, name, contents(index), &numbers, contents(index.saturating_sub(1)));
                }
            }
            Self::Water { carriers, tracers, bath_nodes, texels, bins } => {
                state.masses = vec![0; count];
                let joined = if texels { together(contents(0), contents(1)) } else { Vec::new() };
                let (water, water_arrays) = if texels { (joined.as_slice(), 2) } else { (contents(0), 1) };
                let arrays = water_arrays + if bins.is_some() { 2 } else { 0 };
                let mut particles = match bins {
                    Some(bins) => bins.particles(water, contents(water_arrays), contents(water_arrays + 1)),
                    None => water.chunks_exact(WATER).take(carriers).collect(),
                };
                if tracers > 0 {
                    particles.extend(contents(arrays).chunks_exact(WATER).take(tracers));
                }
                if particles.len() != count {
                    return Err(format!("{} of {count} particles came back", particles.len()));
                }
                for particle in particles {
                    let id = place(particle[5])?;
                    state.positions[id] = [particle[0], particle[1], 0];
                    state.momenta[id] = [particle[2] as i32, particle[3] as i32, 0];
                    state.masses[id] = particle[4];
                }
                if bath_nodes > 0 {
                    let first = arrays + usize::from(tracers > 0);
                    state.node_masses = contents(first).iter().copied().take(bath_nodes).collect();
                    state.node_bath = contents(first + 1).iter().copied().take(bath_nodes).collect();
                }
            }
        }
        Ok(state)
    }
}

impl Layout {
    /// One of the arrays of a coupled scene; `numbers` are those of the particles as they are stored, and `previous` is the
    /// array before it.
    fn unpack_array(&self, state: &mut State, name: &str, words: &[u32], numbers: &[u32], previous: &[u32]) {
        let count = numbers.len();
        match (name, self) {
            // A list of pairs that remember nothing may be made anew at any time.
            ("anchors", Self::Coupled { listed: Some(Listed { memory: true, .. }), .. }) => {
                let mut anchors = vec![[0; 3]; count];
                for (number, anchor) in numbers.iter().zip(words.chunks_exact(4)) {
                    anchors[*number as usize] = [anchor[0], anchor[1], anchor[2]];
                }
                state.anchors = anchors;
            }
            ("memories", Self::Coupled { listed: Some(listed), .. }) => {
                state.pair_baths = listed.unpack(previous, words, numbers);
            }
            ("position_baths", _) => {
                state.position_baths = words.chunks_exact(4).take(count).map(|s| [s[0], s[1], s[2]]).collect();
            }
            ("bond_baths", Self::Coupled { bond_baths, .. }) => {
                state.bond_baths = words.iter().copied().take(*bond_baths).collect();
            }
            ("holds", _) => {
                let holds = words.chunks_exact(6).take(count);
                state.holds = holds.map(|words| bytemuck::pod_read_unaligned(bytemuck::cast_slice(words))).collect();
            }
            ("tethers", _) => {
                state.tethers = words.chunks_exact(4).take(count).map(|r| [r[0], r[1], r[2]]).collect();
            }
            _ => {}
        }
    }
}

/// Words of all particles in an order of their numbers.
fn pack_particles(state: &State, order: &[usize], predicted: bool) -> Result<Vec<u32>, Misfit> {
    if predicted && state.step > 0 && state.predicted.len() != state.len() {
        return Err("predicted momenta are".into());
    }
    let mut words: Vec<u32> = Vec::with_capacity(PARTICLE as usize / 4 * state.len());
    for &id in order {
        words.extend(state.positions[id]);
        words.push(id as u32);
        words.extend(state.momenta[id].map(|unit| unit as u32));
        let prediction = match state.predicted.get(id) {
            Some(seen) if predicted => {
                prediction::packed(prediction::shifted(*seen, state.momenta[id].map(i32::wrapping_neg)))
            }
            _ => 0,
        };
        words.push(state.species[id] | (prediction << 8));
    }
    Ok(words)
}

/// What [`pack_particles`] packed; `place` tells where a number belongs, once.
fn unpack_particles(
    state: &mut State,
    words: &[u32],
    dimension: usize,
    predicted: bool,
    mut place: impl FnMut(u32) -> Result<usize, String>,
) -> Result<(), String> {
    let count = state.positions.len();
    state.species = vec![0; count];
    if predicted {
        state.predicted = vec![[0; 3]; count];
    }
    for particle in words.chunks_exact(PARTICLE as usize / 4).take(count) {
        let id = place(particle[3])?;
        state.positions[id] = [particle[0], particle[1], if dimension == 3 { particle[2] } else { 0 }];
        state.momenta[id] = [particle[4] as i32, particle[5] as i32, particle[6] as i32];
        state.species[id] = particle[7] & 255;
        if predicted {
            let shift = prediction::unpacked(particle[7] >> 8);
            state.predicted[id] = prediction::shifted(state.momenta[id], shift);
        }
    }
    Ok(())
}

/// Words of all Voronoi cells in an order of their numbers, as `shaders/voronoi/cell.wgsl` declares them.
fn pack_cells(state: &State, order: &[usize], energies: bool) -> Result<Vec<u32>, Misfit> {
    if state.masses.len() != state.len() {
        return Err("masses are".into());
    }
    if energies && state.energies.len() != state.len() {
        return Err("energies are".into());
    }
    let words = order.iter().flat_map(|&id| {
        let ([x, y, _], [px, py, _]) = (state.positions[id], state.momenta[id]);
        let energy = if energies { state.energies[id] } else { 0 };
        [x, y, state.masses[id], id as u32, px as u32, py as u32, energy as u32, state.species[id]]
    });
    Ok(words.collect())
}

/// What [`pack_cells`] packed; `place` tells where a number belongs, once.
fn unpack_cells(
    state: &mut State,
    words: &[u32],
    energies: bool,
    mut place: impl FnMut(u32) -> Result<usize, String>,
) -> Result<(), String> {
    let count = state.positions.len();
    state.species = vec![0; count];
    state.masses = vec![0; count];
    state.energies = vec![0; if energies { count } else { 0 }];
    for cell in words.chunks_exact(8).take(count) {
        let id = place(cell[3])?;
        state.positions[id] = [cell[0], cell[1], 0];
        state.masses[id] = cell[2];
        state.momenta[id] = [cell[4] as i32, cell[5] as i32, 0];
        state.species[id] = cell[7];
        if energies {
            state.energies[id] = cell[6] as i32;
        }
    }
    Ok(())
}

/// Words of something that every particle has, in order of their numbers.
fn by_number<T: Copy, const WIDTH: usize>(
    elements: &[T],
    count: usize,
    what: &str,
    words: impl Fn(T) -> [u32; WIDTH],
) -> Result<Vec<u32>, Misfit> {
    if elements.len() != count {
        return Err(what.into());
    }
    Ok(elements.iter().flat_map(|element| words(*element)).collect())
}

/// Bits of a listed neighbour that tell where it is stored.
const NEIGHBOUR: u32 = 0x7fff_ffff;

impl Listed {
    /// Where the particles were when they were listed, the list, and what its pairs remember if they do. A state without a
    /// list gets an empty one, made so far away that a new one is asked for.
    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        let count = state.len();
        if !state.anchors.is_empty() && state.anchors.len() != count {
            return Err("places of the last list are".into());
        }
        let away = |position: [u32; 3]| position.map(|component| component.wrapping_add(1 << 31));
        let anchors = order.iter().flat_map(|&id| {
            let [x, y, z] = state.anchors.get(id).copied().unwrap_or_else(|| away(state.positions[id]));
            [x, y, z, id as u32]
        });
        let mut contents = vec![anchors.collect()];
        let mut neighbours = vec![0_u32; count * (self.capacity + 1)];
        let mut memories = vec![0_u32; if self.memory { 2 * count * self.capacity } else { 0 }];
        let mut slots = vec![0; count];
        for (slot, &id) in order.iter().enumerate() {
            slots[id] = slot;
        }
        for pair in &state.pair_baths {
            let ends = [pair.first, pair.second].map(|id| slots.get(id as usize).copied());
            let [Some(first), Some(second)] = ends else { return Err("particles of remembered pairs are".into()) };
            // The rule of `shaders/couplings/list.wgsl`.
            let odd = pair.first.wrapping_add(pair.second) & 1 == 1;
            let (owner, other) = if odd { (first, second) } else { (second, first) };
            let entry = neighbours[owner] as usize;
            if entry == self.capacity {
                return Err(Misfit::Crowded);
            }
            neighbours[owner] += 1;
            neighbours[(entry + 1) * count + owner] = other as u32 | pair.spared << 31;
            if self.memory {
                let place = 2 * (entry * count + owner);
                memories[place] = pair.memory;
                memories[place + 1] = pair.stamp;
            }
        }
        contents.push(neighbours);
        if self.memory {
            contents.push(memories);
        }
        Ok(contents)
    }

    /// The pairs of a list, in order of their numbers.
    fn unpack(&self, neighbours: &[u32], memories: &[u32], numbers: &[u32]) -> Vec<PairBath> {
        let count = numbers.len();
        let mut pairs = Vec::new();
        for slot in 0..count {
            for entry in 0..(neighbours[slot] as usize).min(self.capacity) {
                let word = neighbours[(entry + 1) * count + slot];
                let other = (word & NEIGHBOUR) as usize;
                let (Some(a), Some(b)) = (numbers.get(slot), numbers.get(other)) else { continue };
                let place = 2 * (entry * count + slot);
                let (memory, stamp) = (memories[place], memories[place + 1]);
                pairs.push(PairBath { first: *a.min(b), second: *a.max(b), memory, stamp, spared: word >> 31 });
            }
        }
        pairs.sort_unstable_by_key(|pair| (pair.first, pair.second));
        pairs
    }
}

#[cfg(test)]
mod tests {
    use super::{Bins, Layout};
    use crate::state::State;

    #[test]
    fn shallow_water_comes_back_from_buffers_and_from_textures_with_rows_filled_up() -> Result<(), String> {
        let count = 7_u32;
        let state = State {
            positions: (0..count).map(|id| [id << 29, 5 * id, 0]).collect(),
            momenta: (0..count as i32).map(|id| [-id, id * id, 0]).collect(),
            masses: (100..100 + count).collect(),
            species: vec![0; count as usize],
            ..State::default()
        };
        let bins = Bins { cells: [4, 2], capacity: 3, arrivals: 2, centred: false };
        let order: Vec<usize> = (0..count as usize).rev().collect();
        for (texels, bins) in [(false, None), (true, None), (false, Some(bins)), (true, Some(bins))] {
            let layout = Layout::Water { carriers: 5, tracers: 2, bath_nodes: 0, texels, bins };
            let mut contents = layout.pack(&state, &order).map_err(|misfit| format!("{misfit:?}"))?;
            assert_eq!(contents.len(), layout.buffers().len());
            if texels {
                contents[0].resize(4096, 0);
                contents[1].resize(4096, 0);
            }
            let words: Vec<&[u32]> = contents.iter().map(Vec::as_slice).collect();
            let mut back = layout.unpack(0, &words, count as usize)?;
            back.species.clone_from(&state.species);
            assert_eq!(back, state, "texels {texels}, {bins:?}");
        }
        Ok(())
    }
}
