//! Bonds between particles: a potential, and a heat bath coupled to the length.

use super::bath::BathStep;
use super::topology;
use crate::scene::{BondPotential, BondsInteraction, Scene};

/// All bonds of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bonds {
    /// What each interaction `bonds` asks for, in order.
    pub kinds: Vec<BondKind>,
    /// The bonds, interaction by interaction.
    pub bonds: Vec<Bond>,
}

/// Bonds of one interaction.
#[derive(Debug, Clone, PartialEq)]
pub struct BondKind {
    /// The potential.
    pub potential: Option<BondPotential>,
    /// Step of the bath coupled to the length; none without friction.
    pub bath: Option<BathStep>,
    /// Temperature kT of the bath.
    pub temperature: f64,
    /// Whether bonded particles are spared each other's repulsion.
    pub exclude_repulsion: bool,
}

/// A bond.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bond {
    /// Numbers of the particles.
    pub ends: [u32; 2],
    /// Index of its kind.
    pub kind: u32,
}

impl Bonds {
    pub(super) fn add(&mut self, interaction: &BondsInteraction, scene: &Scene) {
        let kind = self.kinds.len() as u32;
        let step = BathStep::of(&interaction.bath, interaction.friction, scene.time.step);
        self.kinds.push(BondKind {
            potential: interaction.potential.clone(),
            bath: (step.coupling > 0.0).then_some(step),
            temperature: interaction.bath.temperature(scene.temperature),
            exclude_repulsion: interaction.exclude_repulsion,
        });
        let pairs = if interaction.pairs.is_empty() {
            topology::runs::<2>(scene, interaction.species.as_deref())
        } else {
            interaction.pairs.clone()
        };
        self.bonds.extend(pairs.into_iter().map(|ends| Bond { ends, kind }));
    }

    /// Whether any bond remembers.
    #[must_use]
    pub fn have_memory(&self) -> bool {
        self.kinds.iter().any(|kind| kind.bath.is_some_and(|step| step.remembers()))
    }

    /// Whether any bond has friction.
    #[must_use]
    pub fn have_friction(&self) -> bool {
        self.kinds.iter().any(|kind| kind.bath.is_some())
    }
}
