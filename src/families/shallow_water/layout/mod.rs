//! How water and tracers lie in buffers and textures, and what the bath remembers of the mesh.

mod bins;

pub use bins::Bins;

use crate::plan::{Length, Misfit, Places, StateLayout, content};
use crate::shaders::Array;
use crate::state::{State, StateArray};

/// Units of the heaviest particle: single precision has to round them to integers.
pub(super) const LARGEST_MASS: f64 = 8_388_607.0;

/// Words of a particle or tracer, the first of which are its position and velocity.
const WATER: usize = 6;
const MOTION: usize = 4;

/// Shallow water: an array `particles` of position, velocity, mass and id, in textures two; tracers without mass apart
/// from them; what the bath remembers of every node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct WaterLayout {
    /// Number of particles with mass, which come first.
    pub carriers: usize,
    /// Number of tracers.
    pub tracers: usize,
    /// Nodes that have a bath variable; zero without a bath.
    pub bath_nodes: usize,
    /// Whether masses and ids of particles with mass are apart from their motion, both in textures.
    pub texels: bool,
    /// The bins of particles with mass, if they are not in one array.
    pub bins: Option<Bins>,
}

impl WaterLayout {
    /// Keeps what baths remember on the nodes, in the arrays from one on.
    fn keep_nodes(&self, contents: &[&[u32]], first: usize, state: &mut State) {
        if self.bath_nodes > 0 {
            state.node_masses = content(contents, first).iter().copied().take(self.bath_nodes).collect();
            state.node_bath = content(contents, first + 1).iter().copied().take(self.bath_nodes).collect();
        }
    }
}

/// A state of so many particles that are not there yet.
fn empty(step: u64, count: usize) -> State {
    let (positions, momenta) = (vec![[0; 3]; count], vec![[0; 3]; count]);
    State { step, positions, momenta, masses: vec![0; count], ..State::default() }
}

/// Puts particles, as they are stored, into a state.
fn put<'a>(
    particles: impl IntoIterator<Item = &'a [u32]>,
    places: &mut Places,
    state: &mut State,
) -> Result<(), String> {
    for particle in particles {
        let id = places.take(particle[5])?;
        state.positions[id] = [particle[0], particle[1], 0];
        state.momenta[id] = [particle[2] as i32, particle[3] as i32, 0];
        state.masses[id] = particle[4];
    }
    Ok(())
}

impl StateLayout for WaterLayout {
    fn buffers(&self) -> Vec<Array> {
        let mut names = match (self.bins.is_some(), self.texels) {
            (false, false) => vec![Array::Particles],
            (false, true) => vec![Array::Particles, Array::ParticleMasses],
            (true, false) => vec![Array::Bins, Array::Stayed, Array::Arrived],
            (true, true) => vec![Array::Bins, Array::BinMasses, Array::Stayed, Array::Arrived],
        };
        if self.tracers > 0 {
            names.push(Array::Tracers);
        }
        if self.bath_nodes > 0 {
            names.extend([Array::PreviousMasses, Array::NodeBath]);
        }
        names
    }

    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        let nodes = self.bath_nodes;
        if state.masses.len() != state.len() {
            return Err("masses are".into());
        }
        if nodes > 0 && state.node_bath.len() != nodes {
            return Err("bath variables are".into());
        }
        if nodes > 0 && state.step > 0 && state.node_masses.len() != nodes {
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
        let (water, drifting): (Vec<usize>, Vec<usize>) = order.iter().partition(|id| **id < self.carriers);
        let mut contents = match self.bins {
            Some(bins) => bins.pack(&water.iter().map(particle).collect::<Vec<_>>())?,
            None => vec![water.iter().flat_map(particle).collect::<Vec<u32>>()],
        };
        if self.texels {
            let [motion, masses] = apart(&contents[0]);
            contents.splice(0..1, [motion, masses]);
        }
        if self.tracers > 0 {
            contents.push(drifting.iter().flat_map(particle).collect());
        }
        if nodes > 0 {
            let previous = state.node_masses.clone();
            contents.push(if previous.is_empty() { vec![0; nodes] } else { previous });
            contents.push(state.node_bath.clone());
        }
        Ok(contents)
    }

    fn unpack(&self, step: u64, all: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = empty(step, count);
        let contents = |index: usize| content(all, index);
        let joined = if self.texels { together(contents(0), contents(1)) } else { Vec::new() };
        let (water, water_arrays) = if self.texels { (joined.as_slice(), 2) } else { (contents(0), 1) };
        let arrays = water_arrays + if self.bins.is_some() { 2 } else { 0 };
        let mut particles = match self.bins {
            Some(bins) => bins.particles(water, contents(water_arrays), contents(water_arrays + 1)),
            None => water.chunks_exact(WATER).take(self.carriers).collect(),
        };
        if self.tracers > 0 {
            particles.extend(contents(arrays).chunks_exact(WATER).take(self.tracers));
        }
        if particles.len() != count {
            return Err(format!("{} of {count} particles came back", particles.len()));
        }
        put(particles, &mut Places::of(count), &mut state)?;
        self.keep_nodes(all, arrays + usize::from(self.tracers > 0), &mut state);
        Ok(state)
    }

    fn begin(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        if self.texels || self.bins.is_some() {
            return Err("water that several ranks share out lies in one array".to_owned());
        }
        let mut state = empty(step, count);
        let drifting = if self.tracers > 0 { content(contents, 1) } else { &[] };
        put(drifting.chunks_exact(WATER).take(self.tracers), &mut Places::of(count), &mut state)?;
        self.keep_nodes(contents, 1 + usize::from(self.tracers > 0), &mut state);
        Ok(state)
    }

    fn place(&self, particles: &[u32], places: &mut Places, state: &mut State) -> Result<(), String> {
        put(particles.chunks_exact(WATER), places, state)
    }

    fn arrays(&self, count: usize) -> Vec<(StateArray, Length)> {
        vec![
            (StateArray::Masses, Length::Exactly(count)),
            (StateArray::NodeMasses, Length::AfterFirstStep(self.bath_nodes)),
            (StateArray::NodeBath, Length::Exactly(self.bath_nodes)),
        ]
    }

    fn wrong_content(&self, state: &State) -> Option<String> {
        let heavy = state.masses.iter().any(|mass| f64::from(*mass) > LARGEST_MASS);
        heavy.then(|| format!("a particle has a mass of more than {LARGEST_MASS} units"))
    }
}

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

#[cfg(test)]
mod tests {
    use super::{Bins, WaterLayout};
    use crate::plan::StateLayout;
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
            let layout = WaterLayout { carriers: 5, tracers: 2, bath_nodes: 0, texels, bins };
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
