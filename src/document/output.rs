//! What a run writes.

use super::{
    AnalysisId, Autocorrelation, ChainOutput, ChainSizes, Diffusion, Fields, Histogram, Neighbours, PlotStyle,
    RadialDistribution, ShearWave, Snapshot, Viscosity,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the run measures and writes. Everything optional is off, and costs nothing, unless it is requested.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Output {
    /// The table of energies.
    #[serde(default)]
    pub energies: Energies,
    /// The appearance of the plots.
    #[serde(default)]
    pub plot: PlotStyle,
    /// Pictures of the particles.
    #[serde(default)]
    pub snapshot: Snapshot,
    /// Checkpoints to resume from.
    #[serde(default)]
    pub checkpoint: Checkpoint,
    /// Positions and velocities for other tools.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<Trajectory>,
    /// The radial distribution function g(r).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub radial_distribution: Option<RadialDistribution>,
    /// Mean squared displacement and velocity autocorrelation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub diffusion: Option<Diffusion>,
    /// Sizes of chains: end-to-end distance and radius of gyration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain_sizes: Option<ChainSizes>,
    /// Shear viscosity from the decay of transverse momentum waves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub viscosity: Option<Viscosity>,
    /// Tables and plots of harmonic chains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<ChainOutput>,
    /// Normalised autocorrelations of velocities and forces, each quantity at most once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 16))]
    pub autocorrelations: Vec<Autocorrelation>,
    /// Histograms of velocities and accelerations, each quantity at most once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 16))]
    pub histograms: Vec<Histogram>,
    /// The numbers of neighbours of Voronoi cells, as a table and a plot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub neighbours: Option<Neighbours>,
    /// The decay of the shear wave that Voronoi cells start with, and the shear viscosity that follows from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shear_wave: Option<ShearWave>,
    /// Fields on the mesh of shallow water, as pictures and arrays; left out, depth and potential vorticity at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fields: Option<Fields>,
}

impl Output {
    /// The analyses that it asks for by keys of their own, and of a list of quantities in the order of the list.
    pub(crate) fn analyses(&self) -> Vec<AnalysisId> {
        let keys = [
            (AnalysisId::RadialDistribution, self.radial_distribution.is_some()),
            (AnalysisId::Diffusion, self.diffusion.is_some()),
            (AnalysisId::Viscosity, self.viscosity.is_some()),
            (AnalysisId::ChainSizes, self.chain_sizes.is_some()),
            (AnalysisId::Chain, self.chain.is_some()),
            (AnalysisId::Neighbours, self.neighbours.is_some()),
            (AnalysisId::ShearWave, self.shear_wave.is_some()),
        ];
        let asked = keys.into_iter().filter(|(_, asked)| *asked).map(|(id, _)| id);
        let correlated = self.autocorrelations.iter().map(|asked| AnalysisId::Autocorrelation(asked.quantity));
        let counted = self.histograms.iter().map(|asked| AnalysisId::Histogram(asked.quantity));
        asked.chain(correlated).chain(counted).collect()
    }
}

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
