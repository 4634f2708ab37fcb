//! Adapts a plan to adapters whose lanes load and store one after the other.
//!
//! From a buffer, software adapters load a vector word by word for each lane; from a texture they load whole texels. So arrays that
//! kernels often load lane by lane are kept in textures.

use super::{Buffer, Kernel, Layout, Plan, Texture};
use crate::shaders::{Choice, Entry, arrays, core, grid, pairs};

/// Iterations of all loops together that an invocation gets on average: software adapters leave loops after 65 535 of them.
pub(crate) const TURNS: u64 = 1 << 14;

/// A buffer that may be kept in a texture instead.
#[derive(Clone, Copy)]
struct Candidate {
    name: &'static str,
    /// Words of a texel.
    words: u32,
    /// The variant with which kernels read it then.
    texture: Choice,
}

impl Candidate {
    /// What a kernel reaches by the name: the buffer, or another in its place.
    fn bound(&self, kernel: &Kernel) -> &'static str {
        let renamed = kernel.renamed.iter().find(|(variable, _)| *variable == self.name);
        renamed.map_or(self.name, |(_, buffer)| buffer)
    }
}

fn candidate(name: &'static str, words: u32, texture: impl Into<Choice>) -> Candidate {
    Candidate { name, words, texture: texture.into() }
}

/// Kernels that mainly move particles or shares of nodes load and store words in pairs; where arithmetic dominates, separating the
/// pairs costs more than it saves. For particles this matters only where they are too many for textures.
const MOVES_WORDS: [Entry; 8] = [
    Entry::VisitMeshCells,
    Entry::VisitMeshStrips,
    Entry::GatherNodes,
    Entry::GatherNodesOfEight,
    Entry::ScatterParticles,
    Entry::ScanCells,
    Entry::ScanBlocks,
    Entry::ScanRows,
];

impl Plan {
    /// Adapts kernels and buffers to lanes that run one after the other.
    pub(crate) fn suit_serial_memory(&mut self) {
        let candidates = self.candidates();
        for array in &candidates {
            self.hold_in_texture(array);
        }
        for kernel in &mut self.kernels {
            for array in &candidates {
                let name = array.bound(kernel);
                if self.textures.iter().any(|texture| texture.name == name) {
                    kernel.choices.choose(array.texture);
                }
            }
            // Kernels notice if a loop is left before its end. The clock, which every lane reads, is in a texel.
            kernel.choices.choose(core::Turns::Counted);
            kernel.choices.choose(core::Clock::Texture);
            if MOVES_WORDS.contains(&kernel.entry) {
                kernel.choices.choose(core::Words::Pairs);
            }
            // Few lanes wait for each other where one workgroup has all of the work.
            if kernel.entry == Entry::ScanCells {
                kernel.choices.choose(grid::ScanWidth::Narrow);
            }
        }
        self.add_texture("clock", "step and key of its random words, for kernels to read", 4, 1);
    }

    /// Arrays that every kernel of this plan accesses through functions, so that they may be in textures.
    fn candidates(&self) -> Vec<Candidate> {
        let waves =
            [candidate("waves", 2, arrays::Waves::Texture), candidate("waves_next", 2, arrays::WavesNext::Texture)];
        if let Layout::Water { .. } = self.layout {
            // Only Fourier transforms do.
            let transforms = self.kernels.iter().any(|kernel| kernel.entry == Entry::FourierTurn);
            return if transforms { waves.to_vec() } else { Vec::new() };
        }
        let mut candidates = vec![
            candidate("cells", 1, arrays::Cells::Texture),
            candidate("ranks", 1, arrays::Ranks::Texture),
            candidate("coefficients", 4, arrays::Coefficients::Texture),
        ];
        // Where the hits of a split step share the buffer of the particles, it stays one.
        if !self.kernels.iter().any(|kernel| kernel.choices.has(pairs::Hits::Keep)) {
            candidates.push(candidate("particles", 4, arrays::Particles::Texture));
        }
        // Where neighbours are found by lists, or as Voronoi cells.
        if matches!(self.layout, Layout::Coupled { .. } | Layout::Cells { .. }) {
            candidates.extend([
                candidate("sorted", 4, arrays::Sorted::Texture),
                candidate("neighbours", 1, arrays::Neighbours::Texture),
                candidate("neighbours_next", 1, arrays::NeighboursNext::Texture),
                candidate("memories", 2, arrays::Memories::Texture),
                candidate("memories_next", 2, arrays::MemoriesNext::Texture),
            ]);
        }
        candidates
    }

    /// Keeps a buffer in a texture, if there is such a buffer and it fits.
    fn hold_in_texture(&mut self, array: &Candidate) {
        let Some(place) = self.buffers.iter().position(|buffer| buffer.name == array.name) else { return };
        let texels = self.buffers[place].bytes.div_ceil(4 * u64::from(array.words));
        if Texture::holds(texels, array.words) {
            let Buffer { name, purpose, contents, .. } = self.buffers.remove(place);
            self.add_texture_with(name, purpose, array.words, texels, contents);
        }
    }
}
