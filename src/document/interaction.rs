//! Interactions: the tagged union of a scene, which names the families.

use super::{
    AnglesInteraction, BodyForceInteraction, BondsInteraction, ColouredNoiseInteraction, DpdInteraction,
    HarmonicChainInteraction, LangevinInteraction, ShallowWaterInteraction, TetherInteraction, VoronoiInteraction,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A force between particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Interaction {
    /// Dissipative particle dynamics: soft repulsion a(1 - r/rc), friction and noise along the line of centres.
    Dpd(DpdInteraction),
    /// Friction and noise on every single particle: Langevin dynamics, with memory a generalised Langevin equation.
    Langevin(LangevinInteraction),
    /// A random force on every particle that is constant for random times.
    ColouredNoise(ColouredNoiseInteraction),
    /// A spring from every particle to where it started: V = K(r - r₀)²/2.
    Tether(TetherInteraction),
    /// A force on every particle from outside, uniform or varying along an axis, which drives a flow.
    BodyForce(BodyForceInteraction),
    /// Bonds along chains, or between listed particles: a potential, and friction and noise along the bond.
    Bonds(BondsInteraction),
    /// Stiffness of chains: V = k(1 + cos θ) for each angle θ between bonds, least where the chain is straight.
    Angles(AnglesInteraction),
    /// Harmonic chains of beads and of clusters side by side, with their particles; the only interaction of a scene.
    HarmonicChain(HarmonicChainInteraction),
    /// Rotating shallow water by the Hamiltonian particle-mesh method, with a heat bath on the mesh if asked for.
    ShallowWater(ShallowWaterInteraction),
    /// Voronoi DPD: particles that are the cells of a tessellation, with friction, noise and pressure at their faces.
    Voronoi(VoronoiInteraction),
}

impl Interaction {
    /// Range of the forces of pairs that have none of their own, in a scene of this many species; zero where there are none.
    #[must_use]
    pub fn common_cutoff(&self, species: usize) -> f64 {
        match self {
            Self::Dpd(dpd) => dpd.common_cutoff(species).unwrap_or(0.0),
            _ => 0.0,
        }
    }
}

impl Interaction {
    /// Whether it acts on particles and can be combined with others; the others are the only interaction of a scene of another family.
    #[must_use]
    pub fn is_of_particles(&self) -> bool {
        !matches!(self, Self::ShallowWater(_) | Self::Voronoi(_))
    }

    /// Temperature of the heat bath, in a scene of a temperature; that of the scene without one.
    pub(crate) fn bath_temperature(&self, scene: f64) -> f64 {
        match self {
            Self::Dpd(dpd) => dpd.bath.temperature(scene),
            Self::Langevin(langevin) => langevin.bath.temperature(scene),
            Self::Bonds(bonds) => bonds.bath.temperature(scene),
            Self::ColouredNoise(_)
            | Self::Tether(_)
            | Self::BodyForce(_)
            | Self::Angles(_)
            | Self::HarmonicChain(_)
            | Self::ShallowWater(_) => scene,
            Self::Voronoi(voronoi) => voronoi.hottest(scene),
        }
    }
}
