//! The place of a list of neighbours in buffers, with the memories of its pairs: then two lists lie there by turns.

use crate::plan::Misfit;
use crate::state::{PairBath, State};

/// Bits of a listed neighbour that tell where it is stored.
const NEIGHBOUR: u32 = 0x7fff_ffff;

/// A list of neighbours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ListLayout {
    /// Pairs for which one particle has room.
    pub capacity: usize,
    /// Whether the baths of pairs remember.
    pub memory: bool,
}

impl ListLayout {
    /// Where the particles were when they were listed, the list, and what its pairs remember if they do: the first of two
    /// lists. A state without a list gets an empty one, made so far away that a new one is asked for.
    pub(super) fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        let count = state.len();
        if !state.anchors.is_empty() && state.anchors.len() != count {
            return Err("places of the last list are".into());
        }
        let away = |position: [u32; 3]| position.map(|component| component.wrapping_add(1 << 31));
        let anchors = order.iter().flat_map(|&id| {
            let [x, y, z] = state.anchors.get(id).copied().unwrap_or_else(|| away(state.positions[id]));
            [x, y, z, 0]
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

    /// The pairs of the current of two lists, in order of their numbers. The highest bit of every anchor says which it is.
    pub(super) fn unpack(&self, [anchors, neighbours, memories]: [&[u32]; 3], numbers: &[u32]) -> Vec<PairBath> {
        let count = numbers.len();
        let lists_before = anchors.get(3).map_or(0, |word| (word >> 31) as usize);
        let neighbours = &neighbours[lists_before * (self.capacity + 1) * count..];
        let memories = &memories[lists_before * 2 * self.capacity * count..];
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
