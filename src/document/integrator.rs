//! How the equations of motion are integrated.

use super::defaults::hundredths;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Integrator of particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Integrator {
    /// Splitting A(½) B(½) O B(½) A(½) with the pair velocities relaxed at the half-drifted positions; one neighbour
    /// traversal per step. The default: both temperatures are within about one per cent at a step of 0.04 in the
    /// standard fluid. Baths without memory on particles and along bonds relax exactly.
    Splitting {
        /// How O relaxes pairs that share particles. Left out, `mean-field`, unless that is expected to leave the temperature or the
        /// viscosity of the scene more than 1 % too low: then `two-stages`. The scene in run.json has the choice.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        relaxation: Option<PairRelaxation>,
    },
    /// Groot and Warren's modified velocity Verlet scheme, doi:10.1063/1.474784.
    GrootWarren {
        /// Weight λ of the predicted velocity that enters the friction.
        #[serde(default = "hundredths::<50>")]
        #[schemars(range(min = 0.0, max = 1.0))]
        lambda: f64,
    },
    /// The Markov limit (18)-(21) of Cotter and Reich, doi:10.1209/epl/i2003-00621-8: friction from the discrete
    /// gradient of the coupling function. With memory, friction along bonds, and for couplings on single particles,
    /// their scheme (14)-(17): the default of scenes with memory, coloured noise, fixed particles or one dimension, and
    /// of those with friction along bonds or couplings on single particles and no pair force.
    CotterReich {},
}

impl Default for Integrator {
    fn default() -> Self {
        Self::Splitting { relaxation: None }
    }
}

/// Integrator of shallow water.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum WaterIntegrator {
    /// Shallow water: kick(½) G kick(½), where G is the exact flow of free particles that the rotation bends into
    /// circles. Symplectic in its magnetic form, so that it conserves the circulation of material loops at any time step.
    /// The default of scenes of shallow water.
    Gyro {},
    /// Shallow water: R(½) kick(½) drift kick(½) R(½) with R the rotation of velocities alone.
    Rotate {},
}

impl Default for WaterIntegrator {
    fn default() -> Self {
        Self::Gyro {}
    }
}

/// Integrator of Voronoi DPD.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum CellIntegrator {
    /// Voronoi DPD: splitting A(½) B(½) O B(½) A(½), in which O is friction and noise by Crank-Nicolson (default).
    Splitting {},
    /// Voronoi DPD: the explicit scheme of Euler, as printed by Flekkøy, Coveney and De Fabritiis,
    /// doi:10.1103/PhysRevE.62.2140. Its temperature is 2 % too high at a time step of 0.005, where that of `splitting` is right even at 0.16.
    Euler {},
}

impl Default for CellIntegrator {
    fn default() -> Self {
        Self::Splitting {}
    }
}

/// How the integrator `splitting` relaxes the velocities of pairs that share particles, at positions that stand still.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PairRelaxation {
    /// All pairs at once, each at the rate that its particles feel on average: one visit of the pairs. Exact for a pair alone. Friction of
    /// a flow is too weak and the temperature too low by shares that grow with friction times step.
    MeanField,
    /// The same in two stages with the same Gaussian noise, which leave the temperature, and the friction of a flow up to one that relaxes
    /// most of a velocity in a step: two visits of the pairs. Diffusion is a few per cent too slow.
    TwoStages,
}
