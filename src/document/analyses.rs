//! Analyses: what a scene can ask a run to measure besides the observables, with the id and the names of each.

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

/// The normalised autocorrelation ⟨A(0)·A(t)⟩ / ⟨A(0)²⟩ of a vector of every particle.
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
    /// The frame of reference of velocities; left out, the box where momentum is conserved, else the centre of mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<Frame>,
}

/// A vector of every particle whose autocorrelation can be measured.
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
    pub const fn name(self) -> &'static str {
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

/// The frame of reference of velocities.
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
    /// the repulsion and the rate Γ of the friction in the mean field of neighbours. Values beyond it are counted separately.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub range: Option<f64>,
    /// The component that is counted; left out, all components together.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<Axis>,
    /// The frame of reference of velocities; left out, the box where momentum is conserved, else the centre of mass.
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
    pub const fn name(self) -> &'static str {
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

/// What a run can measure in addition to the observables, in the order in which their files are listed.
///
/// ```
/// use mesoscope::scene::AnalysisId;
///
/// assert_eq!(AnalysisId::Diffusion.table(), "diffusion.csv");
/// assert!(AnalysisId::ALL.contains(&AnalysisId::Chain) && AnalysisId::Chain.tables().len() == 5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AnalysisId {
    /// The radial distribution function.
    RadialDistribution,
    /// Mean squared displacement and velocity autocorrelation.
    Diffusion,
    /// Sizes of chains.
    ChainSizes,
    /// The decay of transverse momentum waves.
    Viscosity,
    /// The normalised autocorrelation of a vector.
    Autocorrelation(CorrelatedQuantity),
    /// A histogram over particles and steps.
    Histogram(CountedQuantity),
    /// The circulations of material loops.
    Circulation,
    /// Pulses, correlations and variances of harmonic chains.
    Chain,
    /// Numbers of neighbours of Voronoi cells.
    Neighbours,
    /// The decay of a shear wave.
    ShearWave,
}

/// A table that an analysis writes, and its plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnalysisTable {
    /// Name of the table.
    pub file: &'static str,
    /// Name of the plot.
    pub plot: &'static str,
}

/// The name of an analysis and the stems of its tables: its own name, unless others are given.
macro_rules! names {
    ($name:literal) => {
        names!($name: $name)
    };
    ($name:literal: $($stem:literal),+) => {
        ($name, &[$(AnalysisTable { file: concat!($stem, ".csv"), plot: concat!($stem, ".png") }),+])
    };
}

impl AnalysisId {
    /// All of them.
    pub const ALL: [Self; 13] = [
        Self::RadialDistribution,
        Self::Diffusion,
        Self::ChainSizes,
        Self::Viscosity,
        Self::Autocorrelation(CorrelatedQuantity::Velocity),
        Self::Autocorrelation(CorrelatedQuantity::Force),
        Self::Histogram(CountedQuantity::Velocity),
        Self::Histogram(CountedQuantity::Speed),
        Self::Histogram(CountedQuantity::Acceleration),
        Self::Circulation,
        Self::Chain,
        Self::Neighbours,
        Self::ShearWave,
    ];

    const fn names(self) -> (&'static str, &'static [AnalysisTable]) {
        match self {
            Self::RadialDistribution => names!("radial_distribution"),
            Self::Diffusion => names!("diffusion"),
            Self::ChainSizes => names!("chain_sizes"),
            Self::Viscosity => names!("viscosity"),
            Self::Autocorrelation(CorrelatedQuantity::Velocity) => names!("velocity_autocorrelation"),
            Self::Autocorrelation(CorrelatedQuantity::Force) => names!("force_autocorrelation"),
            Self::Histogram(CountedQuantity::Velocity) => names!("velocity_histogram"),
            Self::Histogram(CountedQuantity::Speed) => names!("speed_histogram"),
            Self::Histogram(CountedQuantity::Acceleration) => names!("acceleration_histogram"),
            Self::Circulation => names!("circulation"),
            Self::Chain => {
                names!("chain": "chain_profiles", "chain_pulse", "chain_correlation", "chain_memory", "chain_equilibrium")
            }
            Self::Neighbours => names!("neighbours"),
            Self::ShearWave => names!("shear_wave"),
        }
    }

    /// The key of its result in `run.json`, and the name of its section in a checkpoint.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.names().0
    }

    /// The tables that it writes.
    #[must_use]
    pub const fn tables(self) -> &'static [AnalysisTable] {
        self.names().1
    }

    /// The name of its table; of several, the first.
    #[must_use]
    pub const fn table(self) -> &'static str {
        self.tables()[0].file
    }

    /// The part of a scene that requests it.
    pub(crate) fn path(self) -> String {
        match self {
            Self::Autocorrelation(quantity) => format!("output.autocorrelations ({})", quantity.name()),
            Self::Histogram(quantity) => format!("output.histograms ({})", quantity.name()),
            other => format!("output.{}", other.name()),
        }
    }
}
