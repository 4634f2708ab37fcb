//! What a run measures of particles.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The radial distribution function g(r).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RadialDistribution {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Largest distance, at most half the shortest box edge.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub range: f64,
    /// Number of bins.
    #[serde(default = "hundred_bins")]
    #[schemars(range(min = 1, max = 4096))]
    pub bins: u32,
}

fn hundred_bins() -> u32 {
    100
}

/// Mean squared displacement and velocity autocorrelation.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Diffusion {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Samples in one window; each window starts from a new origin and the windows are averaged.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub window: u64,
}

/// Sizes of the chains of each group: squared distance of the ends and squared radius of gyration.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainSizes {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
}

/// Shear viscosity from the decay of the longest transverse momentum waves.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Viscosity {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Largest lag of the correlation, in samples.
    #[schemars(range(min = 8, max = 100_000))]
    pub window: u64,
}

/// The normalised autocorrelation ⟨A(0)·A(t)⟩ / ⟨A(0)²⟩ of a vector that every particle has.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Autocorrelation {
    /// What is correlated.
    pub quantity: CorrelatedQuantity,
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Samples in one window; each window starts from a new origin and the windows are averaged.
    #[schemars(range(min = 2, max = 1_000_000))]
    pub window: u64,
    /// The curve fitted to it.
    #[serde(default)]
    pub fit: DecayFit,
    /// What velocities are relative to; left out, the box where momentum is conserved, else the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<Frame>,
}

/// A vector that every particle has and that can be correlated with itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CorrelatedQuantity {
    /// The velocity, where the temperature is measured.
    Velocity,
    /// The change of momentum around the report over the time it takes: all forces, friction and noise included.
    /// With `splitting` it is that of the whole step, two half kicks and the relaxation between them.
    Force,
}

impl CorrelatedQuantity {
    /// The name in a scene.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Force => "force",
        }
    }
}

/// A curve fitted to a decay in time t.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum DecayFit {
    /// None (default).
    #[default]
    None,
    /// a exp(-bt).
    Exponential,
    /// a exp(-(bt)^c).
    StretchedExponential,
    /// exp(-at/2) \[cos Ωt + (a/2Ω) sin Ωt\], a damped oscillation, or overdamped where Ω² < 0.
    DampedOscillation,
}

/// What velocities are relative to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Frame {
    /// The box.
    Box,
    /// The centre of mass of all particles at the same step.
    CentreOfMass,
}

/// A histogram over particles and steps, normalised to a probability density.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Histogram {
    /// What is counted.
    pub quantity: CountedQuantity,
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Number of bins.
    #[serde(default = "hundred_bins")]
    #[schemars(range(min = 1, max = 1024))]
    pub bins: u32,
    /// Largest magnitude: components are counted from minus to plus this, speeds from zero. Left out, six times the
    /// thermal scale: of velocity √(kT/m), of acceleration √(kT/m) √(ω² + min(2Γ/dt, 4/dt²)) with the frequency ω of
    /// the repulsion and the rate Γ of the friction in the mean field of neighbours. What is beyond is counted apart.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub range: Option<f64>,
    /// The component that is counted; left out, all of them alike.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Axis>,
    /// What velocities are relative to; left out, the box where momentum is conserved, else the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<Frame>,
}

/// What a histogram counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CountedQuantity {
    /// Components of the velocity, where the temperature is measured.
    Velocity,
    /// The magnitude of the velocity.
    Speed,
    /// Components of the acceleration: the force that `autocorrelations` correlate over the mass.
    Acceleration,
}

impl CountedQuantity {
    /// The name in a scene.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Velocity => "velocity",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
        }
    }
}

/// An axis of the box.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}
