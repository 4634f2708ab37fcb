//! Features of scenes of particles that do not go together: one table, from which come the mistakes that `check` names,
//! the reasons why ranks cannot share a scene, and the table of docs/combinations.md.
//!
//! Two features that no [`Refusal`] names go together, unless a check of one of them says otherwise for some of its
//! values (tests/combinations runs all pairs against the reference).

use super::terms;
use crate::document::{Integrator, Problems, ProfiledQuantity, Scene};

/// The features with their names in messages and tables, and what each is.
macro_rules! features {
    ($($feature:ident $name:literal $meaning:literal)*) => {
        /// A feature of a scene.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Feature {
            $(#[doc = $meaning] $feature,)*
        }

        use Feature::{$($feature),*};

        impl Feature {
            /// All features.
            pub const ALL: &'static [Self] = &[$($feature),*];

            /// Its name in messages and tables.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self {
                    $($feature => $name,)*
                }
            }
        }
    };
}

features! {
    Pairs "pairs without memory" "Pairs whose bath has no memory."
    PairsWithMemory "pairs with memory" "Pairs whose bath has a memory."
    SeveralPairForces "several `dpd`" "Pair forces that add up."
    ManyBody "a many-body repulsion" "A repulsion that depends on local densities."
    Langevin "Langevin friction" "Friction and noise of single particles."
    LangevinWithMemory "a bath with memory on every particle" "A bath with memory on every particle."
    ColouredNoise "coloured noise" "A random force that is constant for random times."
    Bonds "bonds" "Bonds without friction."
    FrictionOfBonds "friction along bonds" "Friction and noise along bonds."
    MemoryOfBonds "a bath with memory on every bond" "A bath with memory on every bond."
    Exclusion "`exclude_repulsion`" "Bonds whose ends do not repel each other."
    Angles "angles" "Angles between bonds."
    Tethers "tethers" "Springs to places in space."
    Electrostatics "electrostatics" "Forces between charged particles."
    UniformForce "a uniform body force" "A force from outside that is the same everywhere."
    VaryingForce "a body force that varies" "A force from outside that varies in space."
    HarmonicChain "harmonic chains" "Harmonic chains, which are a scene by themselves."
    FixedParticles "fixed particles" "Particles that are held where they start."
    Line "a box of one dimension" "A box of one dimension."
    Walls "walls" "Walls."
    Layers "layers of frozen particles" "Layers of frozen particles behind walls."
    Shear "shear" "Boundaries that shear."
    Splitting "`splitting`" "The integrator `splitting`."
    GrootWarren "`groot-warren`" "The integrator `groot-warren`."
    CotterReich "`cotter-reich`" "The integrator `cotter-reich`."
    State "`state`" "A start from a file."
    Molecules "`molecules`" "A start from molecules."
    RadialDistribution "`radial_distribution`" "The radial distribution function."
    StructureFactor "`structure_factor`" "The structure factor."
    Diffusion "`diffusion`" "Displacements and velocity correlations."
    Clusters "`clusters`" "Clusters of particles."
    ChainSizes "`chain_sizes`" "Sizes of chains."
    Viscosity "`viscosity`" "The viscosity from momentum waves."
    Autocorrelations "`autocorrelations`" "Autocorrelations of velocities and forces."
    Histograms "`histograms`" "Histograms of velocities and accelerations."
    Stress "`stress`" "The pressure tensor."
    StressWindow "a `window` of `stress`" "The correlation of the pressure tensor in a window, for the viscosity."
    Profiles "`profiles`" "Profiles along an axis."
    StressProfiles "`profiles` of stress" "Profiles of the stress."
    Ranks "ranks" "A run that several ranks share."
}

/// Why two features do not go together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum Reason {
    /// The two together have no meaning, or the result would not be what its name says.
    #[error("physics: {0}")]
    Physics(&'static str),
    /// The two together have a meaning, and the program cannot do it yet.
    #[error("not implemented: {0}")]
    NotImplemented(&'static str),
}

impl Reason {
    /// True if the two have a meaning together, which the program lacks.
    #[must_use]
    pub const fn is_missing(&self) -> bool {
        matches!(self, Self::NotImplemented(_))
    }
}

/// A feature that does not go with some others.
#[derive(Debug, Clone, Copy)]
pub struct Refusal {
    /// The feature, in whose place of a scene the mistake is found.
    pub feature: Feature,
    /// The others.
    pub others: &'static [Feature],
    /// The reason.
    pub reason: Reason,
}

const fn physics(feature: Feature, others: &'static [Feature], why: &'static str) -> Refusal {
    Refusal { feature, others, reason: Reason::Physics(why) }
}

const fn missing(feature: Feature, others: &'static [Feature], why: &'static str) -> Refusal {
    Refusal { feature, others, reason: Reason::NotImplemented(why) }
}

/// All of them.
pub const REFUSALS: &[Refusal] = &[
    physics(
        GrootWarren,
        &[PairsWithMemory, LangevinWithMemory, MemoryOfBonds, HarmonicChain],
        "a bath with memory is coupled to places, and `groot-warren` predicts the velocities of a friction; \
         `cotter-reich` takes both",
    ),
    physics(Walls, &[Tethers], "a tether would pull through a wall"),
    physics(Walls, &[HarmonicChain], "harmonic chains have fixed ends of their own"),
    physics(Shear, &[Tethers], "images of the end of a tether move across a boundary that shears"),
    physics(Shear, &[FixedParticles], "images of a fixed particle move across a boundary that shears"),
    physics(Shear, &[Line], "a flow varies across its direction"),
    physics(ManyBody, &[Exclusion], "bonded particles are part of the density around each other"),
    physics(ManyBody, &[Layers], "local densities end behind the wall"),
    physics(Stress, &[Line], "on a line there is `pressure` in energies.csv"),
    physics(Stress, &[FixedParticles, Tethers, Layers], "what holds particles in place carries stress too"),
    physics(StressProfiles, &[Line], "on a line there is `pressure` in energies.csv"),
    physics(StressProfiles, &[FixedParticles, Tethers, Layers], "what holds particles in place carries stress too"),
    physics(
        StressWindow,
        &[Shear],
        "Green and Kubo's viscosity is that of a fluid at rest; in shear it is that of the mean stress",
    ),
    physics(StressWindow, &[ColouredNoise], "Green and Kubo's viscosity is that of a fluid in equilibrium"),
    physics(Viscosity, &[Line], "there is no shear on a line"),
    physics(
        Viscosity,
        &[Walls, Shear],
        "its waves are those of a periodic box at rest; `stress` and `profiles` have the viscosity of a flow",
    ),
    physics(
        Viscosity,
        &[Langevin, LangevinWithMemory, ColouredNoise, Tethers, FixedParticles, VaryingForce],
        "its waves decay by the exchange of momentum between particles, and these change their momentum themselves",
    ),
    missing(PairsWithMemory, &[ManyBody], "local densities are found in cells, and memory is kept in a list"),
    missing(Line, &[ManyBody], "local densities are found in cells, and pairs on a line in a list"),
    missing(Splitting, &[PairsWithMemory], "a split step that relaxes pairs with memory; `cotter-reich` takes them"),
    missing(Splitting, &[Line, HarmonicChain], "a split step of pairs in a list; `cotter-reich` takes them"),
    missing(Shear, &[Walls], "images of walls that boundaries carry along; walls that move make a shear flow too"),
    missing(
        Electrostatics,
        &[Walls],
        "charges between walls need the field of images beyond them, and here the box is periodic",
    ),
    missing(Electrostatics, &[Shear], "wave vectors of a box that shears lean with it"),
    missing(Electrostatics, &[StressProfiles], "the stress of charges is one of waves, and belongs to no particle"),
    physics(Electrostatics, &[Line], "charges are clouds in three dimensions"),
    physics(StructureFactor, &[Shear], "the wave vectors of a box that shears lean with it"),
    missing(RadialDistribution, &[Shear], "pairs further than the cutoff are found round a box at rest"),
    missing(Clusters, &[Shear], "close pairs are found in cells, round a box at rest"),
    missing(Diffusion, &[Shear], "displacements in a flow that carries copies past each other"),
    missing(
        Ranks,
        &[PairsWithMemory, LangevinWithMemory, MemoryOfBonds, ColouredNoise, HarmonicChain],
        "what a bath or a noise remembers does not change its rank with the particle",
    ),
    missing(Ranks, &[Line], "pairs in a list"),
    missing(Ranks, &[StructureFactor, Autocorrelations, Histograms, Stress, Profiles], "measured on one device"),
];

impl Feature {
    /// The place in a scene that first has it, if any has; the number of ranks is no part of a scene.
    #[must_use]
    pub fn place(self, scene: &Scene) -> Option<String> {
        let when = |there: bool, path: &str| there.then(|| path.to_owned());
        let group = |key: &str, wanted: &dyn Fn(&crate::document::ParticleGroup) -> bool| {
            scene.particles.iter().position(wanted).map(|index| format!("particles[{index}]{key}"))
        };
        let (output, integrator) = (&scene.output, scene.system.particle_integrator());
        match self {
            SeveralPairForces => scene.pair_interactions().nth(1).map(|(index, _)| format!("interactions[{index}]")),
            FixedParticles => group(".fixed", &|group| group.fixed && !group.is_frozen()),
            Line => when(scene.space.lengths.len() == 1, "space.box"),
            Walls => when(!scene.space.walls.is_empty(), "space.walls"),
            Layers => group(".placement", &|group| group.is_frozen()),
            Shear => when(scene.space.shear.is_some(), "space.shear"),
            Splitting => when(matches!(integrator, Some(Integrator::Splitting { .. })), "integrator.type"),
            GrootWarren => when(matches!(integrator, Some(Integrator::GrootWarren { .. })), "integrator.type"),
            CotterReich => when(matches!(integrator, Some(Integrator::CotterReich {})), "integrator.type"),
            State => when(scene.state.is_some(), "state"),
            Molecules => when(!scene.molecules.is_empty(), "molecules"),
            RadialDistribution => when(output.radial_distribution.is_some(), "output.radial_distribution"),
            StructureFactor => when(output.structure_factor.is_some(), "output.structure_factor"),
            Diffusion => when(output.diffusion.is_some(), "output.diffusion"),
            Clusters => when(output.clusters.is_some(), "output.clusters"),
            ChainSizes => when(output.chain_sizes.is_some(), "output.chain_sizes"),
            Viscosity => when(output.viscosity.is_some(), "output.viscosity"),
            Autocorrelations => when(!output.autocorrelations.is_empty(), "output.autocorrelations"),
            Histograms => when(!output.histograms.is_empty(), "output.histograms"),
            Stress => when(output.stress.is_some(), "output.stress"),
            StressWindow => {
                let window = output.stress.as_ref().is_some_and(|stress| stress.window.is_some());
                when(window, "output.stress.window")
            }
            Profiles => when(output.profiles.is_some(), "output.profiles"),
            StressProfiles => {
                let profiles = output.profiles.as_ref();
                let stress = profiles.is_some_and(|asked| asked.quantities.contains(&ProfiledQuantity::Stress));
                when(stress, "output.profiles.quantities")
            }
            Ranks => None,
            _ => scene.interactions().iter().enumerate().find_map(|(index, interaction)| {
                let term = Some(terms::of(interaction)).filter(|term| term.acts())?;
                let (_, key) = term.features().into_iter().find(|(feature, _)| *feature == self)?;
                Some(format!("interactions[{index}]{key}"))
            }),
        }
    }

    /// The features that it is a part of.
    #[must_use]
    pub const fn requires(self) -> &'static [Self] {
        match self {
            Layers => &[Walls],
            StressWindow => &[Stress],
            StressProfiles => &[Profiles],
            _ => &[],
        }
    }

    /// The refusal of two features, in either order.
    ///
    /// ```
    /// use mesoscope::families::combinations::Feature;
    ///
    /// assert!(Feature::Walls.refusal(Feature::PairsWithMemory).is_none());
    /// let refusal = Feature::Tethers.refusal(Feature::Walls).expect("a tether may not lead through a wall");
    /// assert!(!refusal.reason.is_missing());
    /// ```
    #[must_use]
    pub fn refusal(self, other: Self) -> Option<&'static Refusal> {
        let names = |refusal: &&Refusal, feature: Self, other: Self| {
            refusal.feature == feature && refusal.others.contains(&other)
        };
        REFUSALS.iter().find(|refusal| names(refusal, self, other) || names(refusal, other, self))
    }
}

/// Adds a mistake for every two features of a scene that do not go together.
pub(super) fn check(scene: &Scene, problems: &mut Problems) {
    for refusal in REFUSALS {
        let Some(path) = refusal.feature.place(scene) else { continue };
        for other in refusal.others {
            let Some(place) = other.place(scene) else { continue };
            let accepted = format!("{} without {} ({})", refusal.feature.name(), other.name(), refusal.reason);
            problems.refuse(&path, format!("together with {} in {place}", other.name()), accepted);
        }
    }
}

/// The reasons why several ranks cannot share a scene.
pub(super) fn unshared(scene: &Scene) -> Vec<String> {
    let mut reasons = Vec::new();
    for refusal in REFUSALS.iter().filter(|refusal| refusal.feature == Ranks) {
        for other in refusal.others {
            let Some(place) = other.place(scene) else { continue };
            reasons.push(format!("{} in {place}: on one rank only ({})", other.name(), refusal.reason));
        }
    }
    reasons
}
