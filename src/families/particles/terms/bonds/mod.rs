//! Bonds between particles: a potential, and a heat bath coupled to the length.

mod exclusions;
pub(crate) mod plan;
pub(crate) mod reference;
mod relaxation;
mod scene;
mod start;

pub(crate) use start::check_extents;

use super::Term;
use crate::document::{BondPotential, Problems};
use crate::families::particles::KeptArray;
use crate::families::particles::model::topology::{Alike, Bond, Runs};
use crate::families::{BathStep, Checked, Model};
use crate::shaders::Array;
use crate::state::{State, StateArray};

/// All bonds of a scene.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bonds {
    /// What each interaction `bonds` asks for, in order.
    pub kinds: Vec<BondKind>,
    /// The bonds, interaction by interaction.
    pub(crate) runs: Runs<2>,
    /// The largest force of a potential, if there is one.
    pub(crate) largest_force: Option<f64>,
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
    /// True if the repulsion between bonded particles is excluded.
    pub exclude_repulsion: bool,
    /// True if the charges of bonded particles do not act on each other.
    pub exclude_charges: bool,
}

impl Term for Bonds {
    fn has_potential(&self) -> bool {
        self.have_potentials()
    }

    fn has_memory(&self) -> bool {
        self.have_memory()
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn baths(&self, _: &Model) -> Vec<(BathStep, f64)> {
        self.kinds.iter().filter_map(|kind| Some((kind.bath?, kind.temperature))).collect()
    }

    fn check_capacity(&self, scene: &Checked, problems: &mut Problems) {
        let model = scene.model();
        if model.particles().relaxes_bonds() {
            scene::check_rounds(self, problems);
        }
    }

    fn keeps(&self, _: &Model) -> Option<KeptArray> {
        self.have_memory().then(|| KeptArray::new(Array::BondBaths, StateArray::BondBaths, self.count()))
    }

    fn complete_start(&self, state: &mut State, model: &Model) {
        if self.have_memory() {
            start::draw_baths(self, state, model);
        }
    }
}

impl Bonds {
    /// True if any has a potential.
    pub(crate) fn have_potentials(&self) -> bool {
        self.kinds.iter().any(|kind| kind.potential.is_some())
    }

    /// True if any bond has a potential or a bath: others only exclude repulsion.
    pub(crate) fn have_forces(&self) -> bool {
        self.kinds.iter().any(|kind| kind.potential.is_some() || kind.bath.is_some())
    }

    /// Number of bonds.
    ///
    /// ```
    /// use mesoscope::scene;
    ///
    /// // Chains of 5, 10 and 20 beads.
    /// let model = scene::load("polymer-melt", &[])?.model().clone();
    /// let bonds = model.particles().bonds.as_ref().expect("they are bonded");
    /// assert_eq!(bonds.count(), bonds.iter().count() as u64);
    /// // They are counted without being listed.
    /// let set = ["particles.0.count=1000000000", "space.box=[700,700,700]"].map(str::to_owned);
    /// let many = scene::load("polymer-melt", &set)?.model().clone();
    /// assert!(many.particles().bonds.as_ref().is_some_and(|bonds| bonds.count() > 800_000_000));
    /// # Ok::<(), scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn count(&self) -> u64 {
        self.runs.count()
    }

    /// All bonds, interaction by interaction.
    pub fn iter(&self) -> impl Iterator<Item = Bond> {
        self.runs.iter()
    }

    /// Kinds of bonds and what their bonds have in common.
    pub(crate) fn alike(&self) -> impl Iterator<Item = (u32, Alike<'_, 2>)> {
        self.runs.alike()
    }

    /// The largest number of partners of a particle between which the repulsion is excluded.
    pub(crate) fn most_excluded(&self) -> usize {
        self.runs.most_partners(|kind| self.kinds[kind as usize].exclude_repulsion)
    }

    /// Number of bonds that exclude the repulsion of their ends.
    pub(crate) fn excluding(&self) -> u64 {
        self.runs.count_of(|kind| self.kinds[kind as usize].exclude_repulsion)
    }

    /// Number of bonds that exclude the charges of their ends.
    pub(crate) fn excluding_charges(&self) -> u64 {
        self.runs.count_of(|kind| self.kinds[kind as usize].exclude_charges)
    }

    /// The bonds with friction and their places among all bonds, in rounds: those of a round share no particle. Each is
    /// in the first round in which its ends are free; bonds that do not find one among [`Self::MOST_ROUNDS`] are left
    /// out, which no scene has whose particles have at most half as many.
    pub(crate) fn rounds(&self) -> Vec<Vec<(u32, Bond)>> {
        let mut rounds: Vec<Vec<(u32, Bond)>> = Vec::new();
        // A bit of each round that a particle has a bond in.
        let mut taken = vec![0_u64; self.frictional_end()];
        for (place, bond) in self.frictional() {
            let both = bond.ends.iter().fold(0, |both, end| both | taken[*end as usize]);
            let round = both.trailing_ones();
            if round >= Self::MOST_ROUNDS {
                continue;
            }
            for end in bond.ends {
                taken[end as usize] |= 1 << round;
            }
            if rounds.len() <= round as usize {
                rounds.push(Vec::new());
            }
            rounds[round as usize].push((place, bond));
        }
        rounds
    }

    /// The most rounds.
    const MOST_ROUNDS: u32 = u64::BITS;

    /// The most bonds with friction that a particle may have where they relax in rounds: two that share a bond exclude
    /// that from one round less than twice as many.
    pub(crate) const MOST_FRICTIONAL: u32 = Self::MOST_ROUNDS / 2;

    /// The most bonds with friction that are put into rounds: a list of them takes two gigabytes then.
    pub(crate) const MOST_IN_ROUNDS: u64 = 1 << 27;

    /// A particle with more bonds with friction than that, and how many.
    pub(crate) fn most_crowded(&self) -> Option<(u32, u32)> {
        let mut bonds = vec![0_u32; self.frictional_end()];
        for end in self.frictional().flat_map(|(_, bond)| bond.ends) {
            bonds[end as usize] += 1;
        }
        let most = (0..).zip(bonds).max_by_key(|(particle, bonds)| (*bonds, std::cmp::Reverse(*particle)));
        most.filter(|(_, bonds)| *bonds > Self::MOST_FRICTIONAL)
    }

    /// One more than the last particle with friction along a bond.
    fn frictional_end(&self) -> usize {
        self.frictional().flat_map(|(_, bond)| bond.ends).max().map_or(0, |last| last as usize + 1)
    }

    /// The bonds with friction, with their places among all.
    fn frictional(&self) -> impl Iterator<Item = (u32, Bond)> {
        let has_friction = |bond: &Bond| self.kinds[bond.kind as usize].bath.is_some();
        self.iter().enumerate().filter(move |(_, bond)| has_friction(bond)).map(|(place, bond)| (place as u32, bond))
    }

    /// Number of bonds with friction.
    pub(crate) fn frictional_count(&self) -> u64 {
        self.runs.count_of(|kind| self.kinds[kind as usize].bath.is_some())
    }

    /// Whether any bond remembers.
    pub(crate) fn have_memory(&self) -> bool {
        self.kinds.iter().any(|kind| kind.bath.is_some_and(|step| step.remembers()))
    }

    /// Whether any bond has friction.
    pub(crate) fn have_friction(&self) -> bool {
        self.kinds.iter().any(|kind| kind.bath.is_some())
    }
}
