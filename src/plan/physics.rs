//! What passes between the plan of a family's physics and the analyses that complete it.

use super::{Grid, Kernel, Plan};
use crate::shaders::{Array, Choices, Constant};

/// Something that a report has to leave for an analysis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Need {
    /// The particles by id.
    Particles,
    /// Their momenta where the temperature is measured.
    Momenta,
    /// The forces on them.
    Forces,
    /// The virials of what acts on them.
    Stresses,
    /// The particles in order of cells, for pairs within a distance.
    Order,
}

/// What is measured of a run, as far as the plan of its physics has to know.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Measured {
    /// Steps between two reports of the observables.
    pub every: u64,
    /// What analyses need.
    pub needs: Vec<Need>,
    /// The longest distance at which they look for pairs.
    pub range: f64,
    /// Whether particles are followed.
    pub follows: bool,
    /// Whether frames of a trajectory are read.
    pub frames: bool,
}

impl Measured {
    /// Whether an analysis needs something.
    pub(crate) fn needs(&self, need: Need) -> bool {
        self.needs.contains(&need)
    }
}

/// The plan of the steps and reports of a family, and how analyses find what a report leaves.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PhysicsPlan {
    /// The plan, without analyses, without what follows particles, and for any memory.
    pub plan: Plan,
    /// Particles by id, of a family that has analyses of them.
    pub reported: Option<Reported>,
    /// Particles in order of cells, where they are needed.
    pub ordered: Option<Ordered>,
    /// Buffers that kernels load lane by lane and often, and may find in textures where that is dear.
    pub texture_candidates: Vec<Array>,
    /// Kernels that follow the particles, for trajectories and displacements.
    pub followers: Vec<Kernel>,
    /// The farthest that a particle goes in a step along any axis, as a share of the box.
    pub stride: f64,
}

/// Particles that a report leaves in the order of their ids.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Reported {
    /// The vector space, the stored particle, and where its mass is found.
    pub choices: Choices,
    /// Constants of kernels that find the way between two of them.
    pub between: Vec<(Constant, f64)>,
    /// Their buffer.
    pub particles: Array,
    /// The buffer of their momenta, where velocities are not to be taken from the particles; there only for
    /// [`Need::Momenta`].
    pub momenta: Option<Array>,
    /// The buffer of forces, in units of [`Plan::force_unit`]; there only for [`Need::Forces`].
    pub forces: Array,
}

/// Particles in order of cells.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ordered {
    /// How kernels find them.
    pub choices: Choices,
    /// Kernels that order them, unless steps do.
    pub kernels: Vec<usize>,
    /// The cells.
    pub grid: Grid,
    /// Whether they are in place only after a report.
    pub needs_report: bool,
}
