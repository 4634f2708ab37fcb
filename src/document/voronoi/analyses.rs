//! What a run measures of Voronoi cells.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The histogram of the numbers of neighbours of Voronoi cells, after equilibration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Neighbours {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
}

/// The decay of the wave of `velocities` of type `shear-wave`, after equilibration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ShearWave {
    /// Steps between two samples: long compared with the time in which friction relaxes a single cell, short compared with the decay of
    /// the wave.
    #[schemars(range(min = 1))]
    pub every: u64,
}
