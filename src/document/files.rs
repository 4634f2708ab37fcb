//! Tables, checkpoints and trajectories that a run writes as it goes on.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The table of energies.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Energies {
    /// Steps between two rows.
    #[schemars(range(min = 1))]
    pub every: u64,
}

impl Default for Energies {
    fn default() -> Self {
        Self { every: 20 }
    }
}

/// Checkpoints to resume from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Checkpoint {
    /// Steps between two checkpoints; each replaces the previous one. There is always one at the end of the run.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Minutes between two checkpoints, whatever the step.
    #[schemars(range(min = 1))]
    pub minutes: u32,
}

impl Default for Checkpoint {
    fn default() -> Self {
        Self { every: 10_000, minutes: 10 }
    }
}

/// Positions and velocities for other tools.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Trajectory {
    /// Steps between two frames.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// The file format.
    #[serde(default)]
    pub format: TrajectoryFormat,
    /// The species whose particles are written, with the numbers that the particles have in the scene; left out, all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 256))]
    pub species: Vec<String>,
}

impl Trajectory {
    /// Frames of all species every so many steps.
    pub(crate) fn every(every: u64) -> Self {
        Self { every, format: TrajectoryFormat::default(), species: Vec::new() }
    }
}

/// The format of a trajectory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TrajectoryFormat {
    /// HOOMD's binary GSD, `trajectory.gsd` (default).
    #[default]
    Gsd,
    /// Extended XYZ text, `trajectory.xyz`.
    ExtendedXyz,
}

impl TrajectoryFormat {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Gsd, Self::ExtendedXyz];
}
