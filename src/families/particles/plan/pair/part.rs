//! The plan of one of several ranks, each of which advances a part of the box: the same kernels, with copies of the particles around
//! the part, and an exchange of particles at the end of a step and at the report in the middle of a split one.

use super::super::PARTICLE;
use super::{Builder, Masks};
use crate::plan::{Domain, PlannedPart, Traversal};
use crate::shaders::{Array, Choices, Constant, Entry, grid, pairs, space};

impl Builder<'_> {
    /// How far around a domain particles have to be known for those within it to be advanced: a cutoff for each pass over pairs that
    /// depends on the one before; where distances are counted their range; and where particles are followed as far as one goes in a step.
    fn halo(&self) -> f64 {
        let densities = u32::from(self.force.many_body.is_some());
        let relaxations = match (self.splits() && self.relaxes_pairs(), self.relaxes_in_two_stages()) {
            (false, _) => 0,
            (true, false) => 1,
            (true, true) => 2,
        };
        let passes = u32::from(self.traversal != Traversal::Alone) + relaxations + densities;
        let followed = if self.measured.follows { self.model.physics().reach(self.model) } else { 0.0 };
        (f64::from(passes) * self.force.cutoff).max(self.measured.range).max(followed)
    }

    /// Plans the part, if the plan is of one.
    pub(super) fn plan_part(&mut self) {
        let Some(part) = self.options.part else { return };
        let planned = part.plan(&self.model.units, self.halo(), self.particles, self.options.list_growth);
        self.slots = planned.slots;
        self.plan.part = Some(planned);
    }

    /// What kernels of one of several ranks do otherwise.
    pub(super) fn of_rank(&self) -> Choices {
        if self.plan.part.is_none() {
            return Choices::new();
        }
        Choices::new().with(grid::Stored::OfRank).with(pairs::Reporting::InOrder).with(space::Followed::OfRank)
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
    }

    /// The kernel that notes after a sort which particles are the rank's own, if there are several ranks.
    pub(super) fn mark_owned(&mut self) -> Option<usize> {
        self.plan.part.as_ref()?;
        let pass = Choices::new().with(pairs::Pass::MarkOwned);
        Some(self.traversal("mark_owned", Traversal::Alone, Masks::Unkept, &pass))
    }
}
