//! How often particles go round the box, which trajectories tell: followed on the device, and only for them.

use super::{Kernel, Plan};

/// Bytes of what is kept of a particle.
const PATH: u64 = 32;

/// Particles are followed at least so often.
const LONGEST: f64 = 1024.0;

/// Words of [`Paths::buffer`] for each particle: its position when it was last followed and how often it had gone round the box.
pub(crate) const PATH_WORDS: usize = PATH as usize / 4;

/// The kernels that follow the particles.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Paths {
    /// Kernels in order, as indices into [`Plan::kernels`]; none where nobody asks.
    pub kernels: Vec<usize>,
    /// Steps after which they run again: no particle goes half round the box in between, or the run ends.
    pub every: u64,
}

impl Paths {
    /// Name of the buffer of what is kept of each particle, by id.
    pub const BUFFER: &'static str = "paths";

    /// Whether anybody asks.
    #[must_use]
    pub fn are_followed(&self) -> bool {
        !self.kernels.is_empty()
    }
}

impl Plan {
    /// Has these kernels follow the particles; none goes further in a step than a share of the box of `stride` along any
    /// axis.
    pub(crate) fn follow(&mut self, kernels: impl IntoIterator<Item = Kernel>, stride: f64) {
        let kernels = kernels.into_iter().map(|kernel| self.add_kernel(kernel)).collect();
        // Strictly less than half a box, whatever the rounding.
        let every = (0.499_999 / stride).floor().clamp(1.0, LONGEST) as u64;
        self.add_buffer(Paths::BUFFER, "where each particle was last, and times round the box", PATH * self.particles);
        self.paths = Paths { kernels, every };
    }
}
