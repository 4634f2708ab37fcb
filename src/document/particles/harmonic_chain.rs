//! Harmonic chains side by side: what a scene says about them.

use crate::document::defaults::{hundredths, one};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A harmonic chain of beads, and the chains of clusters that stand for it with and without friction and noise: Español
/// 1996, doi:10.1103/PhysRevE.53.1572. Each of the three between fixed ends, twice over: with a pulse at temperature zero,
/// and in equilibrium at the temperature of the scene.
///
/// It makes the particles of the scene itself, in a box of one dimension. The chains do not meet, however often they go
/// round the box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct HarmonicChainInteraction {
    /// Number n of beads in a cluster.
    #[schemars(range(min = 2, max = 256))]
    pub cluster_size: u32,
    /// Mass m of a bead; that of a cluster is nm.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub mass: f64,
    /// Stiffness κ of the springs between beads; between clusters it is κ/n.
    #[serde(default = "one")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub stiffness: f64,
    /// Friction between clusters in units of √(mκ); ½, the default, is that of the chain of beads.
    #[serde(default = "hundredths::<50>")]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// Distance of beads at rest, long enough that none passes another; that of clusters is n times as long.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub spacing: f64,
    /// The chains with a pulse.
    pub pulse: ChainPulse,
    /// The chains in equilibrium.
    pub equilibrium: ChainEquilibrium,
}

/// A Gaussian pulse at rest in the middle of a chain, which splits into two halves that travel to the ends.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainPulse {
    /// Number of clusters in a chain.
    #[schemars(range(min = 2, max = 65_536))]
    pub clusters: u32,
    /// Standard deviation of the pulse in clusters.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub width: f64,
    /// Height of the pulse; results are in units of it.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub amplitude: f64,
}

/// A chain in equilibrium.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainEquilibrium {
    /// Number n of clusters in a chain; the relative error of averages is about 1/√n, however long the run.
    #[schemars(range(min = 2, max = 65_536))]
    pub clusters: u32,
}
