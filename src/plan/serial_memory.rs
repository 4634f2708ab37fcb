//! Suits a plan to adapters whose lanes load and store one after the other.
//!
//! Software adapters assemble a vector that lanes load from a buffer word by word, each time through memory; from a texture
//! they load whole texels. So what kernels load lane by lane, and often, is held in textures.

use super::{Buffer, Kernel, Layout, Plan, Texture};

/// Turns of all loops together that an invocation is given on average: software adapters leave loops after 65 535 of them.
pub(crate) const TURNS: u64 = 1 << 14;

/// A buffer that may be held in a texture instead.
struct Candidate {
    name: &'static str,
    /// Words of a texel.
    words: u32,
    /// The module by which kernels come to the buffer.
    module: &'static str,
    /// Its counterpart for a texture.
    counterpart: &'static str,
}

impl Candidate {
    /// What a kernel comes to by the module: the buffer, or another in its place.
    fn bound(&self, kernel: &Kernel) -> Option<&'static str> {
        let renamed = kernel.renamed.iter().find(|(variable, _)| *variable == self.name);
        kernel.modules.contains(&self.module).then(|| renamed.map_or(self.name, |(_, buffer)| buffer))
    }
}

const fn candidate(name: &'static str, words: u32, module: &'static str, counterpart: &'static str) -> Candidate {
    Candidate { name, words, module, counterpart }
}

const ORDER: [Candidate; 3] = [
    candidate("cells", 1, "common/cells_buffer", "common/cells_texels"),
    candidate("ranks", 1, "common/ranks", "common/ranks_texels"),
    candidate("coefficients", 4, "common/coefficient_entries", "common/coefficient_entries_texels"),
];

/// Where depths are smoothed by Fourier transforms.
const WAVES: [Candidate; 2] = [
    candidate("waves", 2, "common/waves", "common/waves_texels"),
    candidate("waves_next", 2, "common/waves_next", "common/waves_next_texels"),
];

const PARTICLES: Candidate = candidate("particles", 4, "common/particles", "common/particles_texels");

/// Where neighbours are found by lists, or as Voronoi cells.
const NEIGHBOURHOODS: [Candidate; 5] = [
    candidate("sorted", 4, "common/sorted", "common/sorted_texels"),
    candidate("neighbours", 1, "common/neighbours", "common/neighbours_texels"),
    candidate("neighbours_next", 1, "common/neighbours_next", "common/neighbours_next_texels"),
    candidate("memories", 2, "common/memories", "common/memories_texels"),
    candidate("memories_next", 2, "common/memories_next", "common/memories_next_texels"),
];

/// Modules of kernels that are replaced: kernel, module, replacement. Words are loaded and stored in pairs where particles and
/// shares of nodes are moved about and little else is done (where arithmetic is what costs, taking the pairs apart costs more
/// than it saves), and few lanes wait for each other where one workgroup has all of the work. Of the particles this matters
/// where they are too many for textures.
const SUITED: [(&str, &str, &str); 9] = [
    ("deposit", "common/storage", "common/storage_paired"),
    ("gather_nodes", "common/storage", "common/storage_paired"),
    ("scatter", "common/storage", "common/storage_paired"),
    ("push", "common/storage", "common/storage_paired"),
    ("push_from_report", "common/storage", "common/storage_paired"),
    ("scan", "common/storage", "common/storage_paired"),
    ("scan_blocks", "common/storage", "common/storage_paired"),
    ("scan_rows", "common/storage", "common/storage_paired"),
    ("scan", "common/scan_wide", "common/scan_narrow"),
];

impl Plan {
    /// Suits kernels and buffers to lanes that are taken one after the other.
    pub(crate) fn suit_serial_memory(&mut self) {
        let neighbourhoods = matches!(self.layout, Layout::Coupled { .. } | Layout::Cells { .. });
        // Where the hits of a split step share the buffer of the particles, it stays one.
        let shared = self.kernels.iter().any(|kernel| kernel.modules.contains(&"common/found"));
        let arrays: Vec<&Candidate> = (ORDER.iter().chain(&WAVES))
            .chain((!shared).then_some(&PARTICLES))
            .chain(NEIGHBOURHOODS.iter().filter(|_| neighbourhoods))
            .collect();
        for array in &arrays {
            self.hold_in_texture(array);
        }
        for array in &arrays {
            self.come_to_texture(array);
        }
        self.count_turns();
        self.show_clock();
        for kernel in &mut self.kernels {
            for (_, usual, suited) in SUITED.into_iter().filter(|(name, ..)| *name == kernel.name) {
                for module in kernel.modules.iter_mut().filter(|module| **module == usual) {
                    *module = suited;
                }
            }
        }
    }

    /// Has kernels notice where loops are left before their end.
    fn count_turns(&mut self) {
        let modules = self.kernels.iter_mut().flat_map(|kernel| &mut kernel.modules);
        for module in modules.filter(|module| **module == "common/turns_endless") {
            *module = "common/turns_counted";
        }
    }

    /// Has kernels read the clock, which every lane does, from a texel.
    fn show_clock(&mut self) {
        for module in
            self.kernels.iter_mut().flat_map(|kernel| &mut kernel.modules).filter(|module| **module == "common/clock")
        {
            *module = "common/clock_texels";
        }
        self.add_texture("clock", "step and key of its random words, for kernels to read", 4, 1);
    }

    /// Holds a buffer in a texture if a kernel comes to it by its module.
    fn hold_in_texture(&mut self, array: &Candidate) {
        let used = self.kernels.iter().any(|kernel| array.bound(kernel) == Some(array.name));
        let place = self.buffers.iter().position(|buffer| buffer.name == array.name);
        if let Some(place) = place.filter(|_| used) {
            let texels = self.buffers[place].bytes.div_ceil(4 * u64::from(array.words));
            if Texture::holds(texels, array.words) {
                let Buffer { name, purpose, contents, .. } = self.buffers.remove(place);
                self.add_texture_with(name, purpose, array.words, texels, contents);
            }
        }
    }

    /// Has every kernel that comes by the array's module to a texture, be it this array or another in its place, do so by the
    /// counterpart.
    fn come_to_texture(&mut self, array: &Candidate) {
        for kernel in &mut self.kernels {
            let held = array.bound(kernel).is_some_and(|name| self.textures.iter().any(|texture| texture.name == name));
            for module in kernel.modules.iter_mut().filter(|module| held && **module == array.module) {
                *module = array.counterpart;
            }
            if held && !kernel.modules.contains(&"common/texels") {
                kernel.modules.push("common/texels");
            }
        }
    }
}
