//! The plan of one of several ranks, each of which advances a part of the box: the same kernels, with copies of the particles around
//! the part, and an exchange of particles at the end of a step and at the report in the middle of a split one. Where it pays, the last
//! pass over pairs has two turns, and particles are exchanged during the second.

use super::super::PARTICLE;
use super::{Builder, Masks};
use crate::families::particles::plan::bonded;
use crate::plan::{Cells, Domain, Halo, Passage, PlannedPart, Traversal};
use crate::shaders::{Array, Choices, Constant, Entry, bonds, couplings, grid, pairs, ranks, space};

/// A length beyond all others, which single precision holds.
const LONGEST: f64 = 1e30;

impl Builder<'_> {
    /// How far around a domain particles have to be known for those within it to be advanced: a cutoff for each pass over pairs that
    /// depends on the one before, and the length of a bond for each round of friction along bonds; then once more a cutoff, or as far as bonds
    /// and angles reach. Trajectories need as far as a particle goes in a step. Where distances are counted, the range of these has to be
    /// known as well, at the steps at which they are.
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
        planned.whole.extend(self.model.particles().tethers.is_some().then_some(Array::Tethers));
        planned.portion = self.options.particles_at_once.unwrap_or(planned.portion);
        self.slots = planned.slots;
        // Samples of split steps are taken at their report, and nothing goes on during the exchange there.
        let sampled = if self.splits() { 0.0 } else { halo.sampled };
        self.inner = self.inner_cells(&planned, halo.width.max(sampled) + reach);
        if let (Some(inner), [_, needed, ..]) = (self.inner, &planned.domains[..]) {
            planned.overlapped = inner.share(self.grid.cells) / needed.share() / self.visits();
        }
        self.plan.part = Some(planned);
    }

    /// Cells whose particles no other rank has to know of at the end of a step, if the device is to go on with them
    /// while the others are exchanged: in steps that end with a pass over pairs, particle by particle. Eight particles
    /// that are visited together may be of both kinds, and on the software adapters that visit them so there is nothing
    /// to gain: host and device are one. Impulses are gathered by copies too, which have to be visited for that.
    fn inner_cells(&self, part: &PlannedPart, edge: f64) -> Option<Cells> {
        if !matches!(self.traversal, Traversal::Rows | Traversal::Queue) || self.gathers() {
            return None;
        }
        let own = part.domains.first().filter(|own| !own.is_whole())?;
        let far = own.without_edge(&self.model.units, edge)?;
        far.cells_within(self.grid.cells)
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
            .with_if(self.keeps_slots(), couplings::Slots::OfRank)
            .with_if(self.keeps_slots(), bonds::Presence::OfRank)
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
        let each = part.slots.max(self.grid.count());
        let mut passages = Vec::new();
        if self.inner.is_none() || self.splits() {
            let send = self.kernel("send", Entry::SendParticles, self.choices(), each);
            passages.push(Passage { after: send, until: send });
            self.passed_on = vec![send, bin];
        }
        if let Some(inner) = self.inner {
            let [[x, y, z], [columns, rows, layers]] = [inner.first, inner.count].map(|numbers| numbers.map(f64::from));
            self.plan.constants.extend([
                (Constant::InnerX, x),
                (Constant::InnerY, y),
                (Constant::InnerZ, z),
                (Constant::InnerColumns, columns),
                (Constant::InnerRows, rows),
                (Constant::InnerLayers, layers),
            ]);
            let but_inner = self.choices().with(ranks::Inner::Marked);
            let send = self.kernel("send_edges", Entry::SendParticles, but_inner.clone(), each);
            let bin = self.kernel("bin_edges", Entry::BinParticles, but_inner, part.slots);
            self.passed_on_early = vec![send, bin];
        }
        self.plan.part = Some(PlannedPart { passages, ..part });
        if self.keeps_slots() {
            let forget = self.kernel("forget_slots", Entry::ForgetSlots, Choices::new(), self.particles);
            self.plan.prepare.push(forget);
        }
    }

    /// The longest bond along which friction is passed on, if there are several ranks; of any length if they all know the whole box.
    pub(crate) fn longest_bond(&self) -> Option<(Constant, f64)> {
        let [_, needed, ..] = self.plan.part.as_ref()?.domains[..] else { return None };
        Some((Constant::BondReach, if needed.is_whole() { LONGEST } else { self.bond_reach() }))
    }

    /// The last pass over pairs of a step: one kernel, or one for particles near the faces of a part and one for the others.
    pub(super) fn last_pass(
        &mut self,
        [whole, edges, inner]: [&'static str; 3],
        traversal: Traversal,
        masks: Masks,
        pass: &Choices,
    ) -> Vec<usize> {
        let (Some(cells), Some(part)) = (self.inner, &self.plan.part) else {
            return vec![self.traversal(whole, traversal, masks, pass)];
        };
        // Copies are forgotten at the end of the step.
        let own = part.domains.first().map_or(cells, |own| own.cells_around(self.grid.cells));
        let edges = self.rows_of_part(edges, own, masks, pass);
        let inner = self.rows_of_part(inner, cells, masks, pass);
        for (kernel, is_first) in [(edges, 1.0), (inner, 0.0)] {
            self.plan.kernels[kernel].constants.push((Constant::Edges, is_first));
        }
        vec![edges, inner]
    }

    /// A kernel that visits the pairs of particles in some rows of cells.
    fn rows_of_part(
        &mut self,
        name: &'static str,
        Cells { first, count }: Cells,
        masks: Masks,
        pass: &Choices,
    ) -> usize {
        let kernel = self.traversal(name, Traversal::Rows, masks, pass);
        let rows = u64::from(count[1]) * u64::from(count[2]);
        let segments = self.segments(Traversal::Rows, rows);
        let visits = &mut self.plan.kernels[kernel];
        visits.entry = Entry::VisitRowsOfPart;
        visits.workgroups = (rows * segments) as u32;
        visits.constants = vec![
            (Constant::Segments, segments as f64),
            (Constant::VisitedY, f64::from(first[1])),
            (Constant::VisitedZ, f64::from(first[2])),
            (Constant::VisitedRows, f64::from(count[1])),
            (Constant::VisitedLayers, f64::from(count[2])),
        ];
        kernel
    }

    /// What ends a step: its last pass over pairs, and the exchange.
    pub(super) fn end_with(&mut self, last: &[usize]) -> Vec<usize> {
        let (&[edges, inner], &[send, bin]) = (last, &self.passed_on_early[..]) else {
            return [last, &self.passed_on[..]].concat();
        };
        if let Some(part) = &mut self.plan.part {
            part.passages.push(Passage { after: send, until: inner });
        }
        vec![edges, send, inner, bin]
    }

    /// The kernel that notes after a sort which particles are the rank's own, if there are several ranks.
    pub(super) fn mark_owned(&mut self) -> Option<usize> {
        self.plan.part.as_ref()?;
        let pass = Choices::new().with(pairs::Pass::MarkOwned).with_if(self.inner.is_some(), ranks::Inner::Marked);
        Some(self.traversal("mark_owned", Traversal::Alone, Masks::Unkept, &pass))
    }
}
