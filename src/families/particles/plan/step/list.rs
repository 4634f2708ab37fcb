//! The list of neighbours: who is within the cutoff and a margin, listed again when a particle has come too far; without
//! a margin in every step.

use super::{Builder, Order};
use crate::families::particles::layout::PARTICLE;
use crate::families::particles::space::shear::plan as shear;
use crate::families::{Model, PairForce};
use crate::noise::{self, stream};
use crate::plan::prefix_sum::PrefixSum;
use crate::plan::{Options, folded, switch};
use crate::shaders::{Array, Choices, Constant, Entry, arrays, core, couplings, grid};
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
    /// Makes the kernels that list neighbours: in every step, or when it is demanded.
    pub(super) fn order_with_list(&mut self) {
        self.list_constants();
        self.list_buffers();
        if self.lists_always() {
            self.plan.constants.push(switch(Constant::ListsAlways, true));
            if self.keeps_slots() {
                self.plan.prepare = vec![self.take_stock()];
            }
            self.plan.sort = self.listing();
            return;
        }
        self.plan.prepare = vec![self.take_stock()];
        let begin = self.kernel("begin", Entry::BeginListedStep, self.choices(), 1);
        let rebuild = self.listing();
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
    }

    /// True if every step lists neighbours. Without a margin they would be listed anew as soon as a particle has moved:
    /// no kernel has to find out, and none depends on it.
    pub(super) fn lists_always(&self) -> bool {
        self.force.skin == 0.0
    }

    fn list_constants(&mut self) {
        let range = self.force.cutoff + self.force.skin;
        let span = |axis: usize| {
            let cells = if axis < self.grid.dimension { self.grid.cells[axis] } else { 1 };
            f64::from(if cells >= 3 { 3 } else { 1 })
        };
        if self.is_sheared() {
            let margin = self.force.margin_of_copies(self.model);
            self.plan.constants.push((Constant::ShearMargin, f64::from(margin)));
        }
        self.plan.constants.extend([
            (Constant::SpanX, span(0)),
            (Constant::SpanY, span(1)),
            (Constant::SpanZ, span(2)),
            (Constant::SquaredRange, range * range),
            (Constant::SquaredReach, self.force.reach_in_list(self.model).powi(2)),
            (Constant::ListCapacity, self.list_capacity() as f64),
        ]);
    }

    fn list_capacity(&self) -> u64 {
        capacity(self.model, self.force, self.options)
    }

    /// What kernels choose that order particles in an array beside the one in which they are stored.
    pub(super) fn sorted_beside(&self) -> Choices {
        self.choices().with(arrays::Sorted::Buffer)
    }

    /// The kernels that count the particles into cells and find where each cell begins, as chosen for either.
    fn binning(&mut self, counting: Choices, summing: &Choices) -> Vec<usize> {
        let sum = PrefixSum { choices: summing, rows: self.grid.rows(), cells: self.grid.count() };
        let mut kernels = vec![self.kernel("bin", Entry::BinParticles, counting, self.particles)];
        kernels.extend(sum.kernels(self.options).into_iter().map(|kernel| self.plan.add_kernel(kernel)));
        kernels
    }

    /// The kernels that order the particles and list their neighbours. Where every step does, the prefix sum begins it.
    fn listing(&mut self) -> Vec<usize> {
        let sorted = self.sorted_beside();
        let summing = if self.lists_always() { sorted.clone() } else { sorted.clone().with(core::Step::Same) };
        let mut kernels = self.binning(sorted.clone().with(grid::Aside::Kept), &summing);
        let arranged = sorted.with(couplings::Anchors::Kept).with_if(self.keeps_slots(), couplings::Slots::Kept);
        let arrange = self.arrangement("arrange", arranged);
        // From where they were kept aside, to where they are stored.
        self.plan.kernels[arrange].renamed = vec![(Array::Particles, Array::Sorted), (Array::Sorted, Array::Particles)];
        kernels.push(arrange);
        let choices = self.choices().with_any(self.exclusions()).and(&shear::of_visits(self.model));
        let list = self.kernel("list", Entry::ListNeighbours, choices, self.particles);
        if self.force.remembers() {
            let key = noise::seed_key(self.model.seed, stream::PAIR_START);
            self.plan.kernels[list].constants =
                vec![(Constant::StartStreamX, f64::from(key[0])), (Constant::StartStreamY, f64::from(key[1]))];
        }
        kernels.push(list);
        kernels
    }

    /// The kernel that puts particles into their cells.
    fn arrangement(&mut self, name: &'static str, choices: Choices) -> usize {
        self.kernel(name, Entry::ArrangeParticles, choices, self.particles.max(self.grid.count()))
    }

    /// Kernels that order particles by cell on the side, for an analysis: the list and what it has noted stay as they
    /// are.
    pub(super) fn order_aside(&mut self) -> Vec<usize> {
        let choices = self.sorted_beside();
        let mut kernels = self.binning(choices.clone(), &choices.clone().with(core::Step::Same));
        kernels.push(self.arrangement("arrange_by_cell", choices));
        if self.order == Order::Never {
            self.ordering_buffers();
        }
        kernels
    }

    /// Buffers of particles in order of cells.
    fn ordering_buffers(&mut self) {
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
        let lists = if self.force.remembers() { 2 } else { 1 };
        self.plan.add_buffer(Array::Neighbours, 4 * lists * (pairs + particles));
        if self.force.remembers() {
            self.plan.add_buffer(Array::Memories, 8 * lists * pairs);
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use crate::plan::{Hardware, Options, Plan};
    use crate::scene;
    use crate::shaders::Array;

    fn plan(changes: &[&str], options: Options) -> Plan {
        let changes: Vec<String> = changes.iter().copied().map(str::to_owned).collect();
        crate::run::plan(&scene::load("edpd-fluid", &changes).unwrap(), Hardware::default(), options)
    }

    /// Kernels that begin a step, and those of them that depend on it.
    fn counts(plan: &Plan) -> [usize; 2] {
        [plan.sort.len(), plan.sort.iter().filter(|kernel| plan.kernels[**kernel].demand.is_some()).count()]
    }

    #[test]
    fn four_kernels_depend_on_the_step_and_none_where_every_step_lists() {
        let levels = Options { many_level_scan: true, ..Options::default() };
        for (options, more) in [(Options::default(), 0), (levels, 2)] {
            assert_eq!(counts(&plan(&[], options)), [5 + more, 4 + more]);
            let always = plan(&["interactions.0.skin=0"], options);
            assert_eq!(counts(&always), [4 + more, 0]);
            assert!(!always.has_buffer(Array::Demands) && always.prepare.is_empty());
        }
    }

    #[test]
    fn two_lists_by_turns_are_for_pairs_that_remember() {
        let bytes = |plan: &Plan| plan.buffers.iter().find(|buffer| buffer.array == Array::Neighbours).unwrap().bytes;
        let listed = Options { listed: true, ..Options::default() };
        let forgetting = plan(&[r#"interactions.0.bath={"type":"white"}"#, "interactions.0.skin=0.3"], listed);
        assert_eq!(bytes(&plan(&[], Options::default())), 2 * bytes(&forgetting));
        assert!(!forgetting.has_buffer(Array::Memories));
    }
}
