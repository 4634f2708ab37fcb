//! What acts on particles one by one: baths, random forces and springs.

use crate::document::Bath;
use crate::document::defaults::is_default;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Friction and noise on every single particle, coupled to its coordinates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LangevinInteraction {
    /// Friction γ of every species not listed in `species`, a force per velocity.
    #[serde(default)]
    #[schemars(range(min = 0.0))]
    pub friction: f64,
    /// Species with a friction of their own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 256))]
    pub species: Vec<SpeciesFriction>,
    /// The heat bath of every coordinate.
    #[serde(default, skip_serializing_if = "is_default")]
    pub bath: Bath,
    /// In a sheared box, the velocity that friction acts on: `peculiar` if left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<FrictionVelocity>,
}

/// The velocity on which friction of single particles acts where boundaries shear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum FrictionVelocity {
    /// Relative to the linear profile of the flow, which then persists.
    Peculiar,
    /// Relative to the box, whose middle is at rest: friction slows the flow.
    Laboratory,
}

/// The friction of one species.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeciesFriction {
    /// The species.
    pub name: String,
    /// Friction γ.
    #[schemars(range(min = 0.0))]
    pub friction: f64,
}

/// A random force on every particle that stays constant for random times: the dynamics of Borreguero, Ellero and Adams.
/// It acts on single particles, so that momentum is not conserved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ColouredNoiseInteraction {
    /// Mean square α of the force.
    #[schemars(range(min = 0.0))]
    pub strength: f64,
    /// Correlation time: ε of `kangaroo` and `literal`, τ of `short`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub time: f64,
    /// The process.
    #[serde(default)]
    pub process: NoiseProcess,
}

/// How a coloured noise jumps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseProcess {
    /// Random directions held for ε/φ with φ = √U: zero mean, isotropic and stationary, with an algebraic tail
    /// C(t) = α(1 - t/2ε) up to ε and αε/2t beyond (default).
    #[default]
    Kangaroo,
    /// The same with exponentially distributed holding times of mean ε/φ: C(t) = α(ε/t)(1 - exp(-t/ε)).
    KangarooExponential,
    /// Exponentially distributed holding times of mean τ, independent of the direction: C(t) = α exp(-t/τ).
    Short,
    /// As the paper prints it, equations (8) and (9): two dimensions only. Its mean is not zero and it ages.
    Literal,
}

/// A spring from every particle to where it started, or was tied in the run that it starts from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TetherInteraction {
    /// Spring constant K.
    #[schemars(range(min = 0.0))]
    pub stiffness: f64,
}
