//! Adapts a plan to adapters whose lanes load and store one after the other.
//!
//! From a buffer, software adapters load a vector word by word for each lane; from a texture they load whole texels. So arrays that
//! kernels often load lane by lane are kept in textures.

use super::{Buffer, Plan, Texture};
use crate::shaders::{Array, Entry, arrays, core, grid};

/// Iterations of all loops together that an invocation gets on average: software adapters leave loops after 65 535 of them.
pub(crate) const TURNS: u64 = 1 << 14;

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
    pub(crate) fn suit_serial_memory(&mut self, candidates: &[Array]) {
        for &array in candidates {
            self.hold_in_texture(array);
        }
        for kernel in &mut self.kernels {
            for &array in candidates {
                let bound = kernel.array_of(array);
                // Kernels that see sorted particles as they are stored do so wherever those lie.
                if !(array == Array::Sorted && kernel.choices.has(arrays::Sorted::Stored))
                    && self.textures.iter().any(|texture| texture.array == bound)
                    && let Some(texture) = array.in_texture()
                {
                    kernel.choices.choose(texture);
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
        self.add_texture(Array::Clock, 1);
    }

    /// Holds a buffer in a texture, if there is such a buffer and it fits.
    fn hold_in_texture(&mut self, array: Array) {
        let Some(place) = self.buffers.iter().position(|buffer| buffer.array == array) else { return };
        let words = array.texel_words();
        let texels = self.buffers[place].bytes.div_ceil(4 * u64::from(words));
        if Texture::holds(texels, words) {
            let Buffer { contents, .. } = self.buffers.remove(place);
            self.add_texture_with(array, texels, contents);
        }
    }
}
