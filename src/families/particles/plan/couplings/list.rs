//! The list of neighbours: who is within the cutoff and a margin, listed again when a particle has come too far.

use super::Builder;
use crate::families::particles::layout::PARTICLE;
use crate::families::{Model, PairForce};
use crate::noise::{self, stream};
use crate::plan::prefix_sum::PrefixSum;
use crate::plan::{Options, folded};
use crate::shaders::{Array, Choices, Constant, Entry, core, couplings};
use std::f64::consts::PI;

/// Room in the list for the pairs that one particle owns: half again as many as there are on average and twelve, and twice
/// that for every time it has turned out to be too little.
pub(super) fn capacity(model: &Model, force: &PairForce, options: Options) -> u64 {
    let particles = model.particle_count();
    let range = force.cutoff + force.skin;
    let ball = match model.units.dimension {
        1 => 2.0 * range,
        2 => PI * range * range,
        _ => 4.0 / 3.0 * PI * range.powi(3),
    };
    let owned = 0.5 * ball * model.density_around();
    let room = (1.5 * owned + 12.0).ceil() * f64::from(options.list_growth.min(31)).exp2();
    (room as u64).min(particles.saturating_sub(1)).max(1)
}

impl Builder<'_> {
    /// Whether bonds ask where a particle is.
    fn needs_slots(&self) -> bool {
        self.model.particles().bonds.is_some() || self.model.particles().angles.is_some()
    }

    /// The clock and, for pairs, the list.
    pub(super) fn list(&mut self) {
        if self.needs_slots() {
            self.plan.add_buffer(Array::Slots, 4 * self.particles);
        }
        let groups = self.groups(self.particles);
        let slots = Choices::new().with_if(self.needs_slots(), couplings::Slots::Kept);
        if !self.visits_pairs() {
            let tick = self.kernel("tick", Entry::BeginPlainStep, &Choices::new(), 1);
            self.plan.sort = vec![tick];
            if self.needs_slots() {
                self.plan.prepare = vec![self.kernel("take_stock", Entry::TakeStock, &slots, groups)];
            }
            return;
        }
        self.list_constants();
        let begin = self.kernel("begin", Entry::BeginListedStep, &Choices::new(), 1);
        let noted = slots.with(couplings::Anchors::Kept);
        self.plan.prepare = vec![self.kernel("take_stock", Entry::TakeStock, &noted, groups)];
        let rebuild = self.rebuild();
        let sizes: Vec<u32> = rebuild
            .iter()
            .flat_map(|kernel| {
                let [width, height] = folded(self.plan.kernels[*kernel].workgroups);
                [width, height, 1]
            })
            .collect();
        for (index, kernel) in rebuild.iter().enumerate() {
            self.plan.kernels[*kernel].demand = Some((rebuild.len() + index) as u32);
        }
        self.plan.kernels[begin].constants.push((Constant::Conditional, rebuild.len() as f64));
        let bytes: Vec<u8> = bytemuck::cast_slice(&[&sizes[..], &vec![0; sizes.len()]].concat()).to_vec();
        self.plan.add_table(Array::Demands, bytes);
        self.plan.sort = [&[begin][..], &rebuild].concat();
        self.list_buffers();
    }

    fn list_constants(&mut self) {
        let range = self.force.cutoff + self.force.skin;
        let span = |axis: usize| {
            let cells = if axis < self.grid.dimension { self.grid.cells[axis] } else { 1 };
            f64::from(if cells >= 3 { 3 } else { 1 })
        };
        self.plan.constants.extend([
            (Constant::SpanX, span(0)),
            (Constant::SpanY, span(1)),
            (Constant::SpanZ, span(2)),
            (Constant::SquaredRange, range * range),
            (Constant::SquaredReach, 0.25 * self.force.skin * self.force.skin),
            (Constant::ListCapacity, self.list_capacity() as f64),
        ]);
    }

    fn list_capacity(&self) -> u64 {
        capacity(self.model, self.force, self.options)
    }

    /// The kernels that count the particles into cells and find where each cell begins.
    pub(super) fn binning(&mut self) -> Vec<usize> {
        let groups = self.groups(self.particles);
        let choices = self.choices().with(core::Step::Same);
        let sum = PrefixSum { choices: &choices, rows: self.grid.rows(), cells: self.grid.count() };
        let mut kernels = vec![self.kernel("bin", Entry::BinParticles, &Choices::new(), groups)];
        kernels.extend(sum.kernels(self.options).into_iter().map(|kernel| self.plan.add_kernel(kernel)));
        kernels
    }

    /// The kernels that order the particles and list their neighbours.
    fn rebuild(&mut self) -> Vec<usize> {
        let groups = self.groups(self.particles);
        let mut kernels = self.binning();
        let arrange_groups = self.groups(self.particles.max(self.grid.count()));
        let arrange = Choices::new()
            .with(couplings::Anchors::Kept)
            .with_if(self.force.remembers(), couplings::Origins::Kept)
            .with_if(self.needs_slots(), couplings::Slots::Kept);
        kernels.push(self.kernel("arrange", Entry::ArrangeParticles, &arrange, arrange_groups));
        let exclusions = Choices::new().with_any(self.exclusions());
        let list = self.kernel("list", Entry::ListNeighbours, &exclusions, groups);
        kernels.push(list);
        if self.force.remembers() {
            let carry = self.kernel("carry", Entry::CarryMemories, &Choices::new(), groups);
            let key = noise::seed_key(self.model.seed, stream::PAIR_START);
            self.plan.kernels[carry].constants =
                vec![(Constant::StartStreamX, f64::from(key[0])), (Constant::StartStreamY, f64::from(key[1]))];
            kernels.push(carry);
            kernels.push(self.kernel("settle_list", Entry::SettleList, &Choices::new(), groups));
        } else {
            self.plan.kernels[list].renamed = vec![(Array::NeighboursNext, Array::Neighbours)];
        }
        kernels.push(self.kernel("settle", Entry::SettleParticles, &Choices::new(), groups));
        kernels
    }

    /// Buffers of particles in order of cells.
    pub(super) fn ordering_buffers(&mut self) {
        let (particles, cells, rows) = (self.particles, self.grid.count(), self.grid.rows());
        self.plan.add_buffer(Array::Sorted, PARTICLE * particles);
        self.plan.add_buffer(Array::Cells, 4 * (cells + 1 + rows));
        self.plan.add_buffer(Array::Counts, 4 * cells);
        self.plan.add_buffer(Array::Ranks, 4 * particles);
        self.plan.add_row_sums(rows, cells, self.options);
    }

    fn list_buffers(&mut self) {
        self.ordering_buffers();
        let particles = self.particles;
        self.plan.add_buffer(Array::Anchors, 16 * particles);
        let pairs = self.list_capacity() * particles;
        self.plan.add_buffer(Array::Neighbours, 4 * (pairs + particles));
        if self.force.remembers() {
            self.plan.add_buffer(Array::CameFrom, 4 * particles);
            self.plan.add_buffer(Array::NeighboursNext, 4 * (pairs + particles));
            self.plan.add_buffer(Array::Memories, 8 * pairs);
            self.plan.add_buffer(Array::MemoriesNext, 8 * pairs);
        }
    }
}
