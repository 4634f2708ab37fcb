//! Bonds between particles: a potential, and a heat bath coupled to the length.

use super::topology::{Alike, Runs};
use crate::document::{BondPotential, BondsInteraction, Scene};
use crate::families::BathStep;

/// All bonds of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bonds {
    /// What each interaction `bonds` asks for, in order.
    pub kinds: Vec<BondKind>,
    /// The bonds, interaction by interaction.
    pub(crate) runs: Runs<2>,
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
    pub(crate) fn add(
        &mut self,
        interaction: &BondsInteraction,
        scene: &Scene,
        species: impl Fn(&str) -> Option<usize>,
    ) {
        let kind = self.kinds.len() as u32;
        let step = BathStep::of(&interaction.bath, interaction.friction, scene.time.step);
        self.kinds.push(BondKind {
            potential: interaction.potential.clone(),
            bath: (step.coupling > 0.0).then_some(step),
            temperature: interaction.bath.temperature(scene.temperature),
            exclude_repulsion: interaction.exclude_repulsion,
        });
        let types = interaction.types.as_deref();
        if interaction.pairs.is_empty() && scene.links_are_from_file(types) {
            scene.file_bonds(types).for_each(|links| self.runs.add_file(kind, links));
        } else if interaction.pairs.is_empty() {
            self.runs.add_chains(kind, scene, interaction.species.as_deref(), species);
        } else {
            self.runs.add_listed(kind, &interaction.pairs);
        }
    }

    /// Number of bonds.
    ///
    /// ```
    /// use mesoscope::{families::Model, scene};
    ///
    /// // Chains of 5, 10 and 20 beads.
    /// let model = Model::new(&scene::load("polymer-melt", &[])?);
    /// let bonds = model.particles().bonds.as_ref().expect("they are bonded");
    /// assert_eq!(bonds.count(), bonds.iter().count() as u64);
    /// // They are counted without being listed.
    /// let set = ["particles.0.count=1000000000", "space.box=[700,700,700]"].map(str::to_owned);
    /// let many = Model::new(&scene::load("polymer-melt", &set)?);
    /// assert!(many.particles().bonds.as_ref().is_some_and(|bonds| bonds.count() > 800_000_000));
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn count(&self) -> u64 {
        self.runs.count()
    }

    /// All bonds, interaction by interaction.
    pub fn iter(&self) -> impl Iterator<Item = Bond> {
        self.runs.iter().map(|(ends, kind)| Bond { ends, kind })
    }

    /// Kinds of bonds and what their bonds have in common.
    pub(crate) fn alike(&self) -> impl Iterator<Item = (u32, Alike<'_, 2>)> {
        self.runs.alike()
    }

    /// The largest number of partners whose repulsion a particle is spared.
    pub(crate) fn most_spared(&self) -> usize {
        self.runs.most_partners(|kind| self.kinds[kind as usize].exclude_repulsion)
    }

    /// Number of bonds whose ends are spared each other's repulsion.
    pub(crate) fn excluding(&self) -> u64 {
        self.runs.count_of(|kind| self.kinds[kind as usize].exclude_repulsion)
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
