//! Adapts a plan to adapters whose lanes load and store one after the other.
//!
//! From a buffer, software adapters load a vector word by word for each lane; from a texture they load whole texels. So arrays that
//! kernels often load lane by lane are kept in textures.

use super::{Buffer, Kernel, Plan, Texture};
use crate::shaders::{Choice, Entry, core, grid};

/// Iterations of all loops together that an invocation gets on average: software adapters leave loops after 65 535 of them.
pub(crate) const TURNS: u64 = 1 << 14;

/// A buffer that may be held in a texture instead.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Candidate {
    name: &'static str,
    /// Words of a texel.
    words: u32,
    /// The variant with which kernels read it then.
    texture: Choice,
}

impl Candidate {
    /// A buffer that every kernel comes to by functions, so that it may be in a texture of so many words a texel.
    pub fn new(name: &'static str, words: u32, texture: impl Into<Choice>) -> Self {
        Self { name, words, texture: texture.into() }
    }

    /// What a kernel comes to by the name: the buffer, or another in its place.
    fn bound(&self, kernel: &Kernel) -> &'static str {
        let renamed = kernel.renamed.iter().find(|(variable, _)| *variable == self.name);
        renamed.map_or(self.name, |(_, buffer)| buffer)
    }
}

/// Kernels that move particles or shares of nodes about and do little else load and store words in pairs; where arithmetic is
/// what costs, taking the pairs apart costs more than it saves. Of the particles this matters where they are too many for
/// textures.
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
    /// Suits kernels and buffers to lanes that are taken one after the other.
    pub(crate) fn suit_serial_memory(&mut self, candidates: &[Candidate]) {
        for array in candidates {
            self.hold_in_texture(array);
        }
        for kernel in &mut self.kernels {
            for array in candidates {
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

    /// Holds a buffer in a texture, if there is such a buffer and it fits.
    fn hold_in_texture(&mut self, array: &Candidate) {
        let Some(place) = self.buffers.iter().position(|buffer| buffer.name == array.name) else { return };
        let texels = self.buffers[place].bytes.div_ceil(4 * u64::from(array.words));
        if Texture::holds(texels, array.words) {
            let Buffer { name, purpose, contents, .. } = self.buffers.remove(place);
            self.add_texture_with(name, purpose, array.words, texels, contents);
        }
    }
}
