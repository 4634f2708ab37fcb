//! Interactions of particles: the tagged union of their laws.

use super::{
    AnglesInteraction, Bath, BodyForceInteraction, BondsInteraction, ColouredNoiseInteraction, DpdInteraction,
    ElectricFieldInteraction, ElectrostaticsInteraction, HarmonicChainInteraction, LangevinInteraction,
    TetherInteraction,
};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A force between particles.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
#[strum(serialize_all = "kebab-case")]
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
    /// An electric field from outside, which acts on particles with a `charge`.
    ElectricField(ElectricFieldInteraction),
    /// Electrostatic forces between particles with a `charge`, which are clouds of a Gaussian density.
    Electrostatics(ElectrostaticsInteraction),
    /// Harmonic chains of beads and of clusters side by side, with their particles; the only interaction of a scene.
    HarmonicChain(HarmonicChainInteraction),
}

impl Interaction {
    /// Its name in a scene.
    pub(crate) fn name(&self) -> &'static str {
        self.into()
    }

    /// Its heat bath with the largest friction, if it has one on particles, pairs or bonds.
    #[must_use]
    pub fn bath(&self) -> Option<(&Bath, f64)> {
        match self {
            Self::Dpd(dpd) => {
                let own = dpd.pairs.iter().filter_map(|pair| pair.friction);
                Some((&dpd.bath, own.fold(dpd.friction, f64::max)))
            }
            Self::Langevin(langevin) => {
                let own = langevin.species.iter().map(|entry| entry.friction);
                Some((&langevin.bath, own.fold(langevin.friction, f64::max)))
            }
            Self::Bonds(bonds) => Some((&bonds.bath, bonds.friction)),
            _ => None,
        }
    }

    /// The same bath, to replace it.
    #[must_use]
    pub fn bath_mut(&mut self) -> Option<&mut Bath> {
        match self {
            Self::Dpd(dpd) => Some(&mut dpd.bath),
            Self::Langevin(langevin) => Some(&mut langevin.bath),
            Self::Bonds(bonds) => Some(&mut bonds.bath),
            _ => None,
        }
    }

    /// Temperature of the heat bath, in a scene of a temperature; that of the scene without one.
    pub(crate) fn bath_temperature(&self, scene: f64) -> f64 {
        self.bath().map_or(scene, |(bath, _)| bath.temperature(scene))
    }
}
