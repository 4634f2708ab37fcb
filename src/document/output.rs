//! What a run measures and writes: the keys, and of each analysis what it asks for, its id and its names.

use super::defaults::{is_default, whole};
use super::{
    Axis, Checkpoint, CorrelatedQuantity, CountedQuantity, DecayFit, Energies, Fields, Frame, PlotStyle,
    ProfiledQuantity, Snapshot, Trajectory,
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
    /// Pictures of the particles; none where this is `null`.
    #[serde(default, with = "super::pictures::nullable")]
    #[schemars(with = "Option<Snapshot>", extend("x-of" = ["particles", "voronoi"], "x-instead" = {
        "shallow-water": "no `output.snapshot` in shallow water: `output.fields` draws the water, `output.plot` says how",
    }))]
    pub snapshot: Snapshot,
    /// Checkpoints to resume from.
    #[serde(default)]
    pub checkpoint: Checkpoint,
    /// Positions and velocities for other tools.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<Trajectory>,
    /// The radial distribution function g(r).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "`neighbours`, which counts the neighbours of cells; pairs have no range here",
    }))]
    pub radial_distribution: Option<RadialDistribution>,
    /// The static structure factor S(q).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles", "voronoi"]))]
    pub structure_factor: Option<StructureFactor>,
    /// Mean squared displacement and velocity autocorrelation of the particles that can move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles", "voronoi"]))]
    pub diffusion: Option<Diffusion>,
    /// Clusters of particles that are close to each other, such as micelles and drops.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "`neighbours`, which counts the neighbours of cells; cells fill the box, and so are one cluster",
    }))]
    pub clusters: Option<Clusters>,
    /// Sizes of chains and molecules: squared distance of the ends and squared radius of gyration.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles"]))]
    pub chain_sizes: Option<ChainSizes>,
    /// Shear viscosity from the decay of transverse momentum waves.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles", "voronoi"]))]
    pub viscosity: Option<Viscosity>,
    /// Tables and plots of harmonic chains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles"]))]
    pub chain: Option<SampleInterval>,
    /// Normalised autocorrelations of velocities and forces of the particles that can move, each quantity at most once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 16), extend("x-of" = ["particles", "voronoi"]))]
    pub autocorrelations: Vec<Autocorrelation>,
    /// Histograms of velocities and accelerations of the particles that can move, each quantity at most once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 16), extend("x-of" = ["particles", "voronoi"]))]
    pub histograms: Vec<Histogram>,
    /// The pressure tensor and what follows from it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles"], "x-instead" = {
        "voronoi": "`viscosity` or `shear_wave` for what the stress is wanted for; the faces of cells have no virial",
    }))]
    pub stress: Option<Stress>,
    /// Profiles of density, velocity and temperature along an axis of the box.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["particles", "voronoi"]))]
    pub profiles: Option<Profiles>,
    /// The numbers of neighbours of Voronoi cells after equilibration, as a table and a plot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["voronoi"]))]
    pub neighbours: Option<SampleInterval>,
    /// The decay after equilibration of the shear wave that Voronoi cells start with, and the shear viscosity that
    /// follows from it. The time between samples is to be long compared with that in which friction relaxes a single
    /// cell, and short compared with the decay of the wave.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["voronoi"]))]
    pub shear_wave: Option<SampleInterval>,
    /// Energy and enstrophy of shallow water by wave number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["shallow-water"]))]
    pub spectra: Option<SampleInterval>,
    /// Fields on the mesh of shallow water, as pictures and arrays; left out, depth and potential vorticity at the end.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(extend("x-of" = ["shallow-water"]))]
    pub fields: Option<Fields>,
}

impl Output {
    /// The table of energies alone.
    pub(crate) fn energies_alone(&self) -> Self {
        Self { energies: self.energies.clone(), ..Self::default() }
    }

    /// The same without analyses: with tables, frames, pictures and checkpoints.
    pub(crate) fn without_analyses(&self) -> Self {
        let Self { energies, plot, snapshot, checkpoint, trajectory, fields, .. } = self.clone();
        Self { energies, plot, snapshot, checkpoint, trajectory, fields, ..Self::default() }
    }

    /// The analyses that it asks for by keys of their own, and of a list of quantities in the order of the list.
    pub(crate) fn analyses(&self) -> Vec<AnalysisId> {
        let keys = [
            (AnalysisId::RadialDistribution, self.radial_distribution.is_some()),
            (AnalysisId::StructureFactor, self.structure_factor.is_some()),
            (AnalysisId::Diffusion, self.diffusion.is_some()),
            (AnalysisId::Clusters, self.clusters.is_some()),
            (AnalysisId::Viscosity, self.viscosity.is_some()),
            (AnalysisId::ChainSizes, self.chain_sizes.is_some()),
            (AnalysisId::Chain, self.chain.is_some()),
            (AnalysisId::Neighbours, self.neighbours.is_some()),
            (AnalysisId::ShearWave, self.shear_wave.is_some()),
            (AnalysisId::Spectra, self.spectra.is_some()),
            (AnalysisId::Profiles, self.profiles.is_some()),
            (AnalysisId::Stress, self.stress.is_some()),
        ];
        let asked = keys.into_iter().filter(|(_, asked)| *asked).map(|(id, _)| id);
        let correlated = self.autocorrelations.iter().map(|asked| AnalysisId::Autocorrelation(asked.quantity));
        let counted = self.histograms.iter().map(|asked| AnalysisId::Histogram(asked.quantity));
        asked.chain(correlated).chain(counted).collect()
    }

    /// Pairs of species that analyses name, with the places of these in the scene, and the bins that a workgroup counts of each pair.
    pub(crate) fn pairs_of_species(&self) -> impl Iterator<Item = (&'static str, &CountedPairs, u32)> {
        let radial = self.radial_distribution.as_ref().map(|asked| (&asked.species, asked.bins));
        let factor = self.structure_factor.as_ref().map(|asked| (&asked.species, 1));
        let asked = [("output.radial_distribution.species", radial), ("output.structure_factor.species", factor)];
        asked
            .into_iter()
            .filter_map(|(path, asked)| asked.and_then(|(pairs, bins)| Some((path, pairs.as_ref()?, bins))))
    }

    /// Species of single particles that analyses name, with the places of these in the scene.
    pub(crate) fn species(&self) -> impl Iterator<Item = (String, &str)> {
        let diffusion =
            self.diffusion.iter().filter_map(|asked| Some(("output.diffusion".to_owned(), asked.species.as_deref()?)));
        let correlated = self.autocorrelations.iter().enumerate();
        let correlated = correlated.filter_map(|(index, asked)| {
            Some((format!("output.autocorrelations[{index}]"), asked.species.as_deref()?))
        });
        let counted = self.histograms.iter().enumerate();
        let counted = counted
            .filter_map(|(index, asked)| Some((format!("output.histograms[{index}]"), asked.species.as_deref()?)));
        diffusion.chain(correlated).chain(counted)
    }

    /// Species that analyses of places name, with the places of these in the scene: their particles may be held.
    pub(crate) fn placed_species(&self) -> impl Iterator<Item = (&'static str, &str)> {
        let clusters = self.clusters.as_ref().map(|asked| ("output.clusters.species", &asked.species));
        let profiles = self.profiles.as_ref().map(|asked| ("output.profiles.species", &asked.species));
        let chains = self.chain_sizes.as_ref().map(|asked| ("output.chain_sizes.species", &asked.species));
        [clusters, profiles, chains]
            .into_iter()
            .flatten()
            .filter_map(|(path, species)| Some((path, species.as_deref()?)))
    }

    /// Frames of velocities that analyses name, with the places of these in the scene and their quantities.
    pub(crate) fn frames(&self) -> impl Iterator<Item = (String, String, Frame)> {
        let correlated = self.autocorrelations.iter().enumerate().filter_map(|(index, asked)| {
            Some((format!("output.autocorrelations[{index}]"), asked.quantity.to_string(), asked.frame?))
        });
        let counted = self.histograms.iter().enumerate().filter_map(|(index, asked)| {
            Some((format!("output.histograms[{index}]"), asked.quantity.to_string(), asked.frame?))
        });
        correlated.chain(counted)
    }
}

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
    #[serde(default = "whole::<100>")]
    #[schemars(range(min = 1, max = 4096))]
    pub bins: u32,
    /// The species whose pairs are counted; left out, pairs of all particles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<CountedPairs>,
}

/// The static structure factor S(q) of the particles that are not frozen, from the wave vectors of the periodic box.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StructureFactor {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// Largest wave number, at least that of one wave along the longest edge of the box.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub range: f64,
    /// Number of bins of the wave number; those that hold no wave vector of the box are left out.
    #[serde(default = "whole::<100>")]
    #[schemars(range(min = 1, max = 1024))]
    pub bins: u32,
    /// The most wave vectors of a bin, chosen at random and always alike.
    #[serde(default = "whole::<16>")]
    #[schemars(range(min = 1, max = 256))]
    pub vectors: u32,
    /// The species whose pairs are taken; left out, pairs of all particles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<CountedPairs>,
    /// True for the structure factor of charge, in which every particle counts by its charge; without `species`.
    #[serde(default, skip_serializing_if = "is_default")]
    pub charges: bool,
}

/// Pairs of species: `"A"` for pairs of A, `["A", "B"]` for pairs of A with B, `"all-pairs"` for every two species by themselves.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum CountedPairs {
    /// Pairs within a species; or those of every two, by the name `all-pairs`.
    Within(String),
    /// Pairs of two species with each other.
    Between([String; 2]),
}

impl CountedPairs {
    /// The name for the pairs of every two species.
    pub const ALL: &str = "all-pairs";
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
    /// The species of the particles that it is of; left out, all that can move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<String>,
}

/// The interval of a measurement that has no other settings.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SampleInterval {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
}

/// Clusters: particles are of one where they are closer than a distance, or joined by a bond.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clusters {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// The distance below which two particles are of one cluster, at most half the shortest box edge: such as the first minimum of their radial
    /// distribution function.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub distance: f64,
    /// Particles of the smallest cluster that is counted; smaller ones are in the table of sizes only.
    #[serde(default = "whole::<1>")]
    #[schemars(range(min = 1))]
    pub least: u32,
    /// The species that clusters are made of; left out, all that is not frozen behind walls.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<String>,
}

/// Sizes of chains and molecules.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChainSizes {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// The species that chains and molecules have particles of; left out, all chains and molecules are measured.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<String>,
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
    /// The species of the particles that it is of; left out, all that can move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<String>,
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
    #[serde(default = "whole::<100>")]
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
    /// The species of the particles that it is of; left out, all that can move.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<String>,
}

/// The pressure tensor: the momentum that particles carry, and the virials of the conservative forces and of friction and noise.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stress {
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// The axis across flat interfaces, such as the two of a slab: their surface tension follows. Left out, none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<Axis>,
    /// Number of interfaces across `normal` that share the tension; left out, the two of a slab.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 10_000))]
    pub interfaces: Option<u32>,
    /// Largest lag of the autocorrelation of the shear stress, in samples: the shear viscosity follows, by Green and Kubo. Left out,
    /// none. With friction that has no memory, samples have to be those of every step.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 2, max = 100_000))]
    pub window: Option<u64>,
}

/// Averages over the particles in bins of equal width along an axis of the box, and over time.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profiles {
    /// The axis along which the bins follow each other.
    pub axis: Axis,
    /// Number of bins.
    #[serde(default = "whole::<40>")]
    #[schemars(range(min = 1, max = 1024))]
    pub bins: u32,
    /// Steps between two samples.
    #[schemars(range(min = 1))]
    pub every: u64,
    /// What is averaged, each quantity at most once; left out, density, velocity and temperature.
    #[serde(default = "usual_profiles")]
    #[schemars(length(min = 1, max = 16))]
    pub quantities: Vec<ProfiledQuantity>,
    /// The species of the particles that it is of; left out, all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub species: Option<String>,
}

fn usual_profiles() -> Vec<ProfiledQuantity> {
    ProfiledQuantity::USUAL.to_vec()
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
    /// The static structure factor.
    StructureFactor,
    /// Mean squared displacement and velocity autocorrelation.
    Diffusion,
    /// Sizes of chains.
    ChainSizes,
    /// Clusters of particles.
    Clusters,
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
    /// Spectra of energy and enstrophy.
    Spectra,
    /// Profiles along an axis.
    Profiles,
    /// The pressure tensor.
    Stress,
}

/// A table that an analysis writes, and its plot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AnalysisTable {
    /// Name of the table.
    pub file: &'static str,
    /// Name of the plot.
    pub plot: &'static str,
    /// Names of the plot as vector graphics, in the order of their formats.
    pub vector: [&'static str; 2],
}

/// The name of an analysis and the stems of its tables: its own name, unless others are given.
macro_rules! names {
    ($name:literal) => {
        names!($name: $name)
    };
    ($name:literal: $($stem:literal),+) => {
        ($name, &[$(AnalysisTable {
            file: concat!($stem, ".csv"),
            plot: concat!($stem, ".png"),
            vector: [concat!($stem, ".svg"), concat!($stem, ".pdf")],
        }),+])
    };
}

impl AnalysisId {
    /// All of them.
    pub const ALL: [Self; 18] = [
        Self::RadialDistribution,
        Self::StructureFactor,
        Self::Diffusion,
        Self::ChainSizes,
        Self::Clusters,
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
        Self::Spectra,
        Self::Profiles,
        Self::Stress,
    ];

    const fn names(self) -> (&'static str, &'static [AnalysisTable]) {
        match self {
            Self::RadialDistribution => names!("radial_distribution"),
            Self::StructureFactor => names!("structure_factor"),
            Self::Diffusion => names!("diffusion"),
            Self::ChainSizes => names!("chain_sizes"),
            Self::Clusters => names!("clusters": "clusters", "cluster_sizes"),
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
            Self::Spectra => names!("spectra"),
            Self::Profiles => names!("profiles"),
            Self::Stress => names!("stress": "stress", "stress_correlation"),
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
            Self::Autocorrelation(quantity) => format!("output.autocorrelations ({quantity})"),
            Self::Histogram(quantity) => format!("output.histograms ({quantity})"),
            other => format!("output.{}", other.name()),
        }
    }
}
