//! The plan of one of several ranks, each of which advances a part of the box: the same kernels, with copies of the particles around
//! the part, and an exchange of particles at the end of a step and at the report in the middle of a split one.

use super::super::PARTICLE;
use super::{Builder, Masks};
use crate::families::particles::plan::bonded;
use crate::plan::{Domain, Halo, PlannedPart, Traversal};
use crate::shaders::{Array, Choices, Constant, Entry, bonds, couplings, grid, pairs, space};

/// A length beyond all others, which single precision holds.
const LONGEST: f64 = 1e30;

impl Builder<'_> {
    /// How far around a domain particles have to be known for those within it to be advanced: a cutoff for each pass over pairs that
    /// depends on the one before, and the length of a bond for each round of friction along bonds; then once more a cutoff, or as far as bonds
    /// and angles reach. Where particles are followed as far as one goes in a step; and where distances are counted their range, at
    /// the steps at which they are.
    fn halo(&self) -> Halo {
        let densities = u32::from(self.force.many_body.is_some());
        let relaxations = match (self.splits() && self.relaxes_pairs(), self.relaxes_in_two_stages()) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        };
        let relaxed = f64::from(relaxations) * self.force.cutoff;
        let pairs = f64::from(u32::from(self.traversal != Traversal::Alone) + densities) * self.force.cutoff;
        let followed = if self.measured.follows { self.model.physics().reach(self.model) } else { 0.0 };
        let close = (relaxed + pairs).max(followed);
        let sampled = self.measured.range;
        if !self.is_bonded() {
            return Halo { close, width: close, bonded: None, sampled };
        }
        let bonded = relaxed + f64::from(bonded::rounds(self.model)) * self.bond_reach();
        let links = f64::from(bonded::links(self.model)) * self.bond_reach();
        Halo { close, width: close.max(bonded + pairs.max(links)), bonded: Some(bonded), sampled }
    }

    /// How long bonds may become before the run goes back for a wider halo.
    fn bond_reach(&self) -> f64 {
        bonded::longest_expected(self.model, self.force.cutoff) * 1.5_f64.powi(self.options.lengthened as i32)
    }

    /// Plans the part, if the plan is of one.
    pub(super) fn plan_part(&mut self) {
        let Some(part) = self.options.part else { return };
        let (halo, reach) = (self.halo(), self.model.physics().reach(self.model));
        let mut planned = part.plan(&self.model.units, halo, reach, self.particles, self.options.list_growth);
        // No step changes where tethers end.
        planned.whole.extend(self.model.particles().tether.is_some().then_some(Array::Tethers));
        planned.portion = self.options.particles_in_message.unwrap_or(planned.portion);
        self.slots = planned.slots;
        self.plan.part = Some(planned);
    }

    /// What kernels of one of several ranks do otherwise.
    pub(super) fn of_rank(&self) -> Choices {
        if self.plan.part.is_none() {
            return Choices::new();
        }
        Choices::new()
            .with(grid::Stored::OfRank)
            .with(pairs::Reporting::InOrder)
            .with(space::Followed::OfRank)
            .with_if(self.is_bonded(), couplings::Slots::OfRank)
            .with_if(self.is_bonded(), bonds::Presence::OfRank)
            .with_if(self.is_bonded(), couplings::Places::Sorted)
    }

    /// Adds the kernels that exchange particles, after which they are counted into cells by `bin`.
    pub(super) fn exchange(&mut self, bin: usize) {
        let Some(part) = self.plan.part.clone() else { return };
        let peers = part.peers.len() as u64;
        self.plan.constants.extend([(Constant::Peers, peers as f64), (Constant::Room, part.room as f64)]);
        self.plan.add_table(Array::Domains, bytemuck::cast_slice::<Domain, u8>(&part.domains).to_vec());
        self.plan.add_buffer(Array::StoredNumber, 4);
        self.plan.add_buffer(Array::OwnedSlots, 4 * part.slots);
        self.plan.add_buffer(Array::Outgoing, PARTICLE * part.room * peers);
        self.plan.add_buffer(Array::OutgoingCounts, 4 * (peers + 1));
        let marked = self.mark_owned();
        self.plan.sort.extend(marked);
        let send = self.kernel("send", Entry::SendParticles, self.choices(), part.slots.max(self.grid.count()));
        self.plan.part = Some(PlannedPart { exchange: send, ..part });
        self.passed_on = vec![send, bin];
        if self.is_bonded() {
            let forget = self.kernel("forget_slots", Entry::ForgetSlots, Choices::new(), self.particles);
            self.plan.prepare.push(forget);
        }
    }

    /// The longest bond along which friction is passed on, if there are several ranks; of any length if they all know the whole box.
    pub(super) fn longest_bond(&self) -> Option<(Constant, f64)> {
        let [_, needed, ..] = self.plan.part.as_ref()?.domains[..] else { return None };
        Some((Constant::BondReach, if needed.is_whole() { LONGEST } else { self.bond_reach() }))
    }

    /// The kernel that notes after a sort which particles are the rank's own, if there are several ranks.
    pub(super) fn mark_owned(&mut self) -> Option<usize> {
        self.plan.part.as_ref()?;
        let pass = Choices::new().with(pairs::Pass::MarkOwned);
        Some(self.traversal("mark_owned", Traversal::Alone, Masks::Unkept, &pass))
    }
}
