//! How particles lie in buffers beside a list and what their terms keep between steps.

use super::{ListLayout, ParticleLayout, WORDS};
use crate::plan::{Length, Misfit, Places, StateLayout, content};
use crate::shaders::Array;
use crate::state::{State, StateArray};

/// Pairs of a particle, on average, in a list of such a capacity: the capacity is half as many again and twelve.
fn pairs_in_list(capacity: usize) -> usize {
    capacity.saturating_sub(12) * 2 / 3
}

/// Particles in an array `particles` in the order of the last list, if there is one, and by number or bond what terms
/// keep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoupledLayout {
    /// The particles themselves.
    pub particles: ParticleLayout,
    /// The list of neighbours, if there are pairs.
    pub list: Option<ListLayout>,
    /// The state of terms between steps.
    pub kept: Vec<KeptArray>,
}

/// An array of the state that a term keeps between steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeptArray {
    /// The buffer. Elements of three words take four there.
    pub array: Array,
    /// The array of a state.
    pub content: StateArray,
    /// Number of elements.
    pub count: usize,
}

impl KeptArray {
    pub(crate) const fn new(array: Array, content: StateArray, count: u64) -> Self {
        Self { array, content, count: count as usize }
    }

    /// Words of an element in the buffer.
    const fn stride(self) -> usize {
        if self.content.width() == 3 { 4 } else { self.content.width() }
    }

    /// Bytes of the buffer.
    pub(crate) fn bytes(self) -> u64 {
        4 * (self.stride() * self.count) as u64
    }

    fn pack(self, state: &State) -> Result<Vec<u32>, Misfit> {
        if state.length(self.content) != self.count {
            return Err(Misfit::Missing(format!("its `{}` are missing", self.content.name())));
        }
        let padding = self.stride() - self.content.width();
        let elements = state.words(self.content).chunks_exact(self.content.width());
        Ok(elements.flat_map(|element| element.iter().copied().chain(std::iter::repeat_n(0, padding))).collect())
    }

    fn unpack(self, words: &[u32], state: &mut State) -> Result<(), String> {
        let elements = words.chunks_exact(self.stride()).take(self.count);
        let words: Vec<u32> = elements.flat_map(|element| &element[..self.content.width()]).copied().collect();
        state.set_words(self.content, &words)
    }
}

impl CoupledLayout {
    /// True if pairs have memory.
    fn pairs_remember(&self) -> bool {
        self.list.is_some_and(|list| list.memory)
    }

    /// Sets the arrays of terms. Sums of the engine may follow them.
    fn unpack_kept(&self, contents: &[&[u32]], state: &mut State) -> Result<(), String> {
        let first = self.buffers().len() - self.kept.len();
        for (place, kept) in self.kept.iter().enumerate() {
            kept.unpack(content(contents, first + place), state)?;
        }
        Ok(())
    }
}

impl StateLayout for CoupledLayout {
    fn buffers(&self) -> Vec<Array> {
        let of_list = self.list.map(|_| [Array::Anchors, Array::Neighbours]).into_iter().flatten();
        let of_list = of_list.chain(self.pairs_remember().then_some(Array::Memories));
        let kept = self.kept.iter().map(|kept| kept.array);
        self.particles.buffers().into_iter().chain(of_list).chain(kept).collect()
    }

    fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, Misfit> {
        let mut contents = self.particles.pack(state, order)?;
        if let Some(list) = self.list {
            contents.extend(list.pack(state, order)?);
        }
        for kept in &self.kept {
            contents.push(kept.pack(state)?);
        }
        Ok(contents)
    }

    fn divides(&self) -> bool {
        self.list.is_none()
    }

    fn unpack(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = self.particles.unpack(step, contents, count)?;
        // A list of pairs without memory may be rebuilt at any time.
        if let Some(list) = self.list.filter(|list| list.memory) {
            let particles = content(contents, 0).chunks_exact(WORDS);
            let numbers: Vec<u32> = particles.take(count).map(|particle| particle[3]).collect();
            let first = self.particles.buffer_count();
            let list_contents = [0, 1, 2].map(|place| content(contents, first + place));
            state.anchors = vec![[0; 3]; count];
            for (number, anchor) in numbers.iter().zip(list_contents[0].chunks_exact(4)) {
                state.anchors[*number as usize] = [anchor[0], anchor[1], anchor[2]];
            }
            state.pair_baths = list.unpack(list_contents, &numbers);
        }
        self.unpack_kept(contents, &mut state)?;
        Ok(state)
    }

    fn begin(&self, step: u64, contents: &[&[u32]], count: usize) -> Result<State, String> {
        let mut state = self.particles.begin(step, contents, count)?;
        self.unpack_kept(contents, &mut state)?;
        Ok(state)
    }

    fn place(&self, particles: &[u32], places: &mut Places, state: &mut State) -> Result<(), String> {
        self.particles.place(particles, places, state)
    }

    fn arrays(&self, count: usize) -> Vec<(StateArray, Length)> {
        let mut arrays = self.particles.arrays(count);
        let anchors = if self.pairs_remember() { count } else { 0 };
        arrays.push((StateArray::Anchors, Length::AfterFirstStep(anchors)));
        if let Some(list) = self.list.filter(|list| list.memory) {
            arrays.push((StateArray::PairBaths, Length::About(count.saturating_mul(pairs_in_list(list.capacity)))));
        }
        arrays.extend(self.kept.iter().map(|kept| (kept.content, Length::Exactly(kept.count))));
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
