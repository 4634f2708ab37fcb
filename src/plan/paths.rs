//! How often particles cross the periodic box: counted on the device, only for trajectories and displacements.

use super::{Kernel, Plan};
use crate::shaders::Array;

/// Bytes kept for each particle.
pub(crate) const PATH: u64 = 32;

/// The most steps between two counts.
const LONGEST: f64 = 1024.0;

/// Words of [`Paths::buffer`] for each particle: its position at the last count, and how often it had crossed the box until then.
pub(crate) const PATH_WORDS: usize = PATH as usize / 4;

/// The kernels that count.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Paths {
    /// Kernels in order, as indices into [`Plan::kernels`]; empty unless paths are asked for.
    pub kernels: Vec<usize>,
    /// Steps between two counts: no particle crosses half the box in between, or the run ends.
    pub every: u64,
}

impl Paths {
    /// The buffer with what is kept for each particle, by id.
    pub const BUFFER: Array = Array::Paths;

    /// Whether anything is counted.
    #[must_use]
    pub fn are_followed(&self) -> bool {
        !self.kernels.is_empty()
    }
}

impl Plan {
    /// Lets these kernels count. In a step no particle moves further than the fraction `stride` of the box along any axis.
    pub(crate) fn follow(&mut self, kernels: impl IntoIterator<Item = Kernel>, stride: f64) {
        let kernels = kernels.into_iter().map(|kernel| self.add_kernel(kernel)).collect();
        // Strictly less than half a box, whatever the rounding.
        let every = (0.499_999 / stride).floor().clamp(1.0, LONGEST) as u64;
        // Between ranks particles are followed in every step: another may own them in the next.
        let every = if self.part.is_some() { 1 } else { every };
        self.add_buffer(Paths::BUFFER, PATH * self.particles);
        self.paths = Paths { kernels, every };
    }
}
