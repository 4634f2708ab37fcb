//! Harmonic chains in a scene.

use crate::scene::{Interaction, Problem, Problems, Scene};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A harmonic chain of beads, and two coarse-grained chains of clusters, with and without friction and noise: Español 1996,
/// doi:10.1103/PhysRevE.53.1572. Each of the three has fixed ends and is simulated twice: with a pulse at temperature zero, and in
/// equilibrium at the temperature of the scene.
///
/// It creates the particles of the scene itself, in a box of one dimension. The chains do not interact, however often they go round
/// the box.
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
    #[serde(default = "half")]
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

/// What the run measures of harmonic chains.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainOutput {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
}

fn one() -> f64 {
    1.0
}

fn half() -> f64 {
    0.5
}

/// Springs are this many standard deviations of their length long, so that they never turn over.
const LONGEST_EXTENSION: f64 = 8.0;

impl HarmonicChainInteraction {
    /// The largest extension to be expected of a spring between clusters: thermal, or on the flank of the pulse.
    fn extension(&self, temperature: f64) -> f64 {
        let thermal = LONGEST_EXTENSION * (f64::from(self.cluster_size) * temperature / self.stiffness).sqrt();
        // A Gaussian is steepest, e^(-1/2) of its height a standard deviation, one standard deviation from the middle.
        let flank = self.pulse.amplitude * (-0.5_f64).exp() / self.pulse.width;
        thermal.max(flank)
    }
}

/// Problems of a scene with harmonic chains at `path`.
pub(crate) fn check(scene: &Scene, chain: &HarmonicChainInteraction, path: &str, problems: &mut Problems) {
    if scene.interactions.len() > 1 {
        let accepted = "`harmonic-chain` as the only interaction of a scene";
        problems.push(Problem::new(path, "found together with another interaction", accepted));
    }
    if !scene.particles.is_empty() {
        let accepted = "an empty list: the chains make their own particles";
        problems.push(Problem::new("particles", format!("found {} groups", scene.particles.len()), accepted));
    }
    let dimension = scene.space.lengths.len();
    if dimension != 1 {
        let accepted = "one edge length: harmonic chains live in one dimension";
        problems.push(Problem::new("space.box", format!("found {dimension}"), accepted));
        return;
    }
    let size = f64::from(chain.cluster_size);
    let thermal = LONGEST_EXTENSION * (scene.temperature / chain.stiffness).sqrt();
    let needed = thermal.max(chain.extension(scene.temperature) / size);
    if chain.spacing < needed {
        let accepted = format!("at least {needed:.4}, so that no spring is inverted");
        problems.push(Problem::new(format!("{path}.spacing"), format!("found {}", chain.spacing), accepted));
    }
    let shortest = 2.0 * (size * chain.spacing + chain.extension(scene.temperature));
    if scene.space.lengths[0] < shortest {
        let accepted = format!("at least {shortest:.4}, twice the longest spring");
        problems.push(Problem::new("space.box[0]", format!("found {}", scene.space.lengths[0]), accepted));
    }
}

/// Problems of a scene without harmonic chains.
pub(crate) fn check_absence(scene: &Scene, problems: &mut Problems) {
    if scene.output.chain.is_some() {
        let accepted = "no `chain`, or a scene with the interaction `harmonic-chain`";
        problems.push(Problem::new("output.chain", "found in a scene without harmonic chains", accepted));
    }
}

/// The harmonic chains of a scene.
#[must_use]
pub fn harmonic_chain(scene: &Scene) -> Option<&HarmonicChainInteraction> {
    scene.interactions.iter().find_map(|interaction| match interaction {
        Interaction::HarmonicChain(chain) => Some(chain),
        _ => None,
    })
}
