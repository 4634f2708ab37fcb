//! How particles lie in buffers whose couplings add their impulses up.

use super::{ListLayout, ParticleLayout, WORDS};
use crate::plan::{Length, Misfit, Places, StateLayout, content};
use crate::shaders::Array;
use crate::state::{Hold, State, StateArray};

/// Pairs of a particle, on average, in a list of such a capacity: the capacity is half as many again and twelve.
fn pairs_in_list(capacity: usize) -> usize {
    capacity.saturating_sub(12) * 2 / 3
}

/// Particles whose couplings add their impulses up: an array `particles` in the order of the last list, and by number or
/// bond whatever else is remembered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct CoupledLayout {
    /// The particles themselves.
    pub particles: ParticleLayout,
    /// The list of neighbours, if there are pairs.
    pub list: Option<ListLayout>,
    /// Whether baths on coordinates remember.
    pub position_baths: bool,
    /// Number of bonds, if their baths remember.
    pub bond_baths: usize,
    /// Whether there is a coloured noise.
    pub holds: bool,
    /// Whether particles are tied to where they started.
    pub tethers: bool,
}

impl CoupledLayout {
    /// Whether pairs remember.
    fn pairs_remember(&self) -> bool {
        self.list.is_some_and(|list| list.memory)
    }

    /// Contents of what particles alone do not have.
    fn rest<'a>(&self, contents: &[&'a [u32]]) -> impl Iterator<Item = &'a [u32]> {
        contents.iter().copied().skip(self.particles.buffer_count())
    }
}

impl StateLayout for CoupledLayout {
    fn buffers(&self) -> Vec<Array> {
        let optional = [
            (Array::Anchors, self.list.is_some()),
            (Array::Neighbours, self.list.is_some()),
            (Array::Memories, self.pairs_remember()),
            (Array::PositionBaths, self.position_baths),
            (Array::BondBaths, self.bond_baths > 0),
            (Array::Holds, self.holds),
            (Array::Tethers, self.tethers),
        ];
        let asked = optional.into_iter().filter(|(_, asked)| *asked).map(|(name, _)| name);
        self.particles.buffers().into_iter().chain(asked).collect()
    }

    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        let mut contents = self.particles.pack(state, order)?;
        let count = state.len();
        if let Some(list) = self.list {
            contents.extend(list.pack(state, order)?);
        }
        if self.position_baths {
            let baths = by_number(&state.position_baths, count, "bath variables are", |s| [s[0], s[1], s[2], 0])?;
            contents.push(baths);
        }
        if self.bond_baths > 0 {
            if state.bond_baths.len() != self.bond_baths {
                return Err("bath variables of bonds are".into());
            }
            contents.push(state.bond_baths.clone());
        }
        if self.holds {
            let holds = by_number(&state.holds, count, "random forces are", bytemuck::cast::<Hold, [u32; 6]>)?;
            contents.push(holds);
        }
        if self.tethers {
            contents.push(by_number(&state.tethers, count, "ends of tethers are", |r| [r[0], r[1], r[2], 0])?);
        }
        Ok(contents)
    }

    fn unpack(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = self.particles.unpack(step, contents, count)?;
        let particles = content(contents, 0).chunks_exact(WORDS);
        let numbers: Vec<u32> = particles.take(count).map(|particle| particle[3]).collect();
        let mut rest = self.rest(contents);
        let mut next = || rest.next().unwrap_or_default();
        if let Some(list) = self.list {
            let (anchors, neighbours) = (next(), next());
            // A list of pairs that remember nothing may be made anew at any time.
            if list.memory {
                state.anchors = vec![[0; 3]; count];
                for (number, anchor) in numbers.iter().zip(anchors.chunks_exact(4)) {
                    state.anchors[*number as usize] = [anchor[0], anchor[1], anchor[2]];
                }
                state.pair_baths = list.unpack(neighbours, next(), &numbers);
            }
        }
        if self.position_baths {
            state.position_baths = next().chunks_exact(4).take(count).map(|s| [s[0], s[1], s[2]]).collect();
        }
        if self.bond_baths > 0 {
            state.bond_baths = next().iter().copied().take(self.bond_baths).collect();
        }
        if self.holds {
            let holds = next().chunks_exact(6).take(count);
            state.holds = holds.map(|words| bytemuck::pod_read_unaligned(bytemuck::cast_slice(words))).collect();
        }
        if self.tethers {
            state.tethers = ends_of_tethers(next(), count);
        }
        Ok(state)
    }

    // Nothing else that is remembered is shared out.
    fn begin(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = self.particles.begin(step, contents, count)?;
        if self.tethers {
            state.tethers = ends_of_tethers(self.rest(contents).next().unwrap_or_default(), count);
        }
        Ok(state)
    }

    fn place(&self, particles: &[u32], places: &mut Places, state: &mut State) -> Result<(), String> {
        self.particles.place(particles, places, state)
    }

    fn arrays(&self, count: usize) -> Vec<(StateArray, Length)> {
        let all_if = |asked: bool| if asked { count } else { 0 };
        let mut arrays = self.particles.arrays(count);
        arrays.push((StateArray::Anchors, Length::AfterFirstStep(all_if(self.pairs_remember()))));
        if let Some(list) = self.list.filter(|list| list.memory) {
            arrays.push((StateArray::PairBaths, Length::About(count.saturating_mul(pairs_in_list(list.capacity)))));
        }
        arrays.extend([
            (StateArray::PositionBaths, Length::Exactly(all_if(self.position_baths))),
            (StateArray::BondBaths, Length::Exactly(self.bond_baths)),
            (StateArray::Holds, Length::Exactly(all_if(self.holds))),
            (StateArray::Tethers, Length::Exactly(all_if(self.tethers))),
        ]);
        arrays
    }

    fn wrong_content(&self, state: &State) -> Option<String> {
        let exists = |id: u32| (id as usize) < state.len();
        let in_order = state.pair_baths.windows(2).all(|pair| {
            let [a, b] = [pair[0], pair[1]].map(|pair| (pair.first, pair.second));
            a < b
        });
        let wrong =
            state.pair_baths.iter().any(|pair| pair.first >= pair.second || !exists(pair.second) || pair.spared > 1);
        (wrong || !in_order).then(|| "its pairs are not those of its particles".to_owned())
    }
}

fn ends_of_tethers(words: &[u32], count: usize) -> Vec<[u32; 3]> {
    words.chunks_exact(4).take(count).map(|r| [r[0], r[1], r[2]]).collect()
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
