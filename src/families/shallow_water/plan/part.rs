//! The plan of one of several ranks, each of which has the particles in whole rows of cells: the same kernels, a sum over all ranks of what
//! they bring to the nodes of the mesh, and an exchange of particles at the end of a step. All else on the mesh every rank does for itself.

use super::WATER;
use super::steps::Builder;
use crate::plan::{Beyond, Domain, ParticleWords, Passage, PlannedPart, SharedSum};
use crate::shaders::{Array, Choices, Constant, Entry, grid, mesh, water};
use std::ops::Range;

/// Arrays of the mesh, and tracers, which every rank has.
const WHOLE: [Array; 5] = [Array::Tracers, Array::NodeMasses, Array::PreviousMasses, Array::NodeBath, Array::Depths];

/// Sums of a report that are over the nodes: of potential energy, of squared bath variables, and of mass.
const SUMS_OF_NODES: Range<usize> = 3..6;

impl Builder<'_> {
    /// Plans the part, if the plan is of one.
    pub(super) fn plan_part(&mut self) {
        let Some(part) = self.options.part else { return };
        let particle = ParticleWords { count: WATER as usize / 4, axes: 2, number: 5 };
        let mut planned = part.plan_of_rows(self.water.rows(), particle, self.water.carriers, self.options.list_growth);
        planned.portion = self.options.particles_at_once.unwrap_or(planned.portion);
        self.slots = planned.slots;
        let everywhere = (self.tracers() > 0).then_some(Array::Tracers);
        self.plan.part = Some(PlannedPart { whole: WHOLE.to_vec(), everywhere, ..planned });
    }

    /// What kernels of one of several ranks do otherwise.
    pub(super) fn of_rank(&self) -> Choices {
        if self.plan.part.is_none() {
            return Choices::new();
        }
        let on_mesh = Choices::new().with(mesh::Gathered::OfRank).with(mesh::Visited::OfRank);
        on_mesh.with(grid::Stored::OfRank).with(water::Stored::OfRank)
    }

    /// The rows of cells in which it has particles.
    pub(super) fn visited_rows(&self) -> Range<u64> {
        let all = self.water.rows();
        let visited = self.options.part.map_or(0..all.count, |part| part.division.rows(part.rank, all));
        visited.start.into()..visited.end.into()
    }

    /// Adds the masses of the nodes, which a kernel has gathered, over the ranks.
    pub(super) fn add_up_nodes(&mut self, gather: usize) {
        let Some(part) = &mut self.plan.part else { return };
        let order = self.water.spline_order;
        // Splines of odd order belong to the node below a cell.
        let before = order / 2;
        let stretches = part.part.stretches(self.water.rows(), self.water.mesh[0], [before, order - before]);
        let nodes = self.water.nodes();
        part.sums.push(SharedSum {
            array: Array::NodeMasses,
            beyond: Beyond::Marked,
            after: gather,
            length: nodes,
            stretches,
        });
        let check = self.kernel("check_nodes", Entry::CheckNodeMasses, &Choices::new(), nodes);
        self.plan.before_report.push(check);
    }

    /// Adds the kernels that exchange particles at the end of a step, and count those that have arrived.
    pub(super) fn exchange(&mut self, follows: bool) {
        let Some(part) = self.plan.part.clone() else { return };
        let peers = part.peers.len() as u64;
        self.plan.constants.extend([(Constant::Peers, peers as f64), (Constant::Room, part.room as f64)]);
        self.plan.add_table(Array::Domains, bytemuck::cast_slice::<Domain, u8>(&part.domains).to_vec());
        self.plan.add_buffer(Array::StoredNumber, 4);
        self.plan.add_buffer(Array::Outgoing, WATER * part.room * peers);
        self.plan.add_buffer(Array::OutgoingCounts, 4 * (peers + 1));
        let followed = Choices::new().with_if(follows, water::Followed::OfRank);
        let send = self.kernel("send", Entry::SendWater, &followed, part.slots);
        let count = self.kernel("count_arrived", Entry::BinWater, &followed, part.room * peers);
        for kernels in [&mut self.plan.advance, &mut self.plan.finish_report] {
            kernels.extend([send, count]);
        }
        self.plan.samplers[0].whole = SUMS_OF_NODES;
        let passages = vec![Passage { after: send, until: send }];
        self.plan.part = Some(PlannedPart { passages, ..part });
    }
}
