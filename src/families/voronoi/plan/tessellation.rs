//! The order of the particles and the cells around them.

use super::Builder;
use crate::plan::Kernel;
use crate::plan::prefix_sum::PrefixSum;
use crate::shaders::{Array, Constant, Entry, core, tessellation};

/// Corners for which an invocation has room in memory of its own, as `shaders/tessellation/corners/private.wgsl` says.
const PRIVATE_CORNERS: u64 = 24;

/// Cells of which one is expected to be in doubt at most: where there are more, invocations make several one after another.
const DOUBTFUL_SHARE: u64 = 8;

/// What an ordering of the particles is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Occasion {
    /// A report: nobody has counted the particles into cells yet, and the clock stands still.
    Report,
    /// Within a step: the drift before has counted the particles.
    Midway,
}

impl Builder<'_> {
    /// Kernels that order the particles as they are now and find the cells around them, for a report.
    pub(super) fn geometry(&mut self) -> Vec<usize> {
        self.geometry_for(Occasion::Report)
    }

    /// Kernels that order the particles as they are now and find the cells around them. They share buffers, and those that
    /// do the same are one.
    pub(super) fn geometry_for(&mut self, occasion: Occasion) -> Vec<usize> {
        let mut kernels = Vec::new();
        let groups = self.groups(self.particles);
        if occasion == Occasion::Report {
            kernels.push(self.shared_kernel("bin", Entry::BinParticles, groups));
        }
        self.scan(&mut kernels);
        let arrange_groups = self.groups(self.particles.max(self.grid.count()));
        kernels.push(self.shared_kernel("arrange", Entry::ArrangeParticles, arrange_groups));
        kernels.push(self.shared_kernel("order_cells", Entry::OrderCells, groups));
        let quickly = self.shared_kernel("tessellate", Entry::Tessellate, groups);
        self.plan.kernels[quickly].constants = vec![(Constant::Spacing, self.spacing())];
        let groups = self.groups(self.particles.div_ceil(DOUBTFUL_SHARE));
        let exactly = self.shared_kernel("tessellate_exactly", Entry::TessellateExactly, groups);
        let [x_weight, y_weight] = weights(self.model.units.lengths);
        let (low, high) = (|weight: u64| f64::from(weight as u32), |weight: u64| (weight >> 32) as f64);
        self.plan.kernels[exactly].constants = vec![
            (Constant::Spacing, self.spacing()),
            (Constant::Corners, self.face_capacity() as f64),
            (Constant::Groups, groups as f64),
            (Constant::WeightXLow, low(x_weight)),
            (Constant::WeightXHigh, high(x_weight)),
            (Constant::WeightYLow, low(y_weight)),
            (Constant::WeightYHigh, high(y_weight)),
        ];
        kernels.extend([quickly, exactly]);
        self.geometry_buffers();
        kernels
    }

    /// Kernels of the prefix sum over grid cells.
    fn scan(&mut self, kernels: &mut Vec<usize>) {
        let choices = self.choices().with(core::Step::Same);
        let sum = PrefixSum { choices: &choices, rows: self.grid.rows(), cells: self.grid.count() };
        kernels.extend(sum.kernels(self.options).into_iter().map(|kernel| self.plan.add_kernel_once(kernel)));
    }

    /// Room for the faces of a cell: more each time that a run has found it too little, but not for more than there can be.
    fn face_capacity(&self) -> u64 {
        let growth = self.options.list_growth;
        if growth == 0 {
            return PRIVATE_CORNERS;
        }
        // Every face ends at two corners, where at least three cells meet; and on the way there are two more.
        let most = (6 * self.particles + 2).max(PRIVATE_CORNERS);
        128_u64.saturating_mul(4_u64.saturating_pow(growth - 1)).min(most)
    }

    /// Mean distance of particles: the unit of length of a cell's polygon.
    fn spacing(&self) -> f64 {
        (self.model.units.volume() / self.particles.max(1) as f64).sqrt()
    }

    /// A kernel that is made once, however often it is asked for.
    fn shared_kernel(&mut self, name: &'static str, entry: Entry, workgroups: u64) -> usize {
        let stored = self.options.list_growth > 0;
        let choices =
            self.choices().with(if stored { tessellation::Corners::Stored } else { tessellation::Corners::Private });
        self.plan.add_kernel_once(Kernel::new(name, entry, choices, workgroups))
    }

    fn geometry_buffers(&mut self) {
        if self.plan.has_buffer(Array::Sorted) {
            return;
        }
        let (particles, cells, rows) = (self.particles, self.grid.count(), self.grid.rows());
        self.plan.add_buffer(Array::Sorted, 32 * particles);
        self.plan.add_buffer(Array::Cells, 4 * (cells + 1 + rows));
        self.plan.add_buffer(Array::Counts, 4 * cells);
        self.plan.add_buffer(Array::Ranks, 4 * particles);
        self.plan.add_buffer(Array::Places, 8 + 16 * particles);
        self.plan.add_row_sums(rows, cells, self.options);
        let faces = self.face_capacity() * particles;
        // With many faces a cell's polygon is where its faces will be, and takes more room.
        let lengths = if self.options.list_growth > 0 { 2 * faces } else { faces };
        self.plan.add_buffer(Array::FaceCounts, 4 * particles);
        self.plan.add_buffer(Array::FaceWords, 4 * faces);
        self.plan.add_buffer(Array::FaceLengths, 4 * lengths);
        self.plan.add_buffer(Array::FaceOffsets, 4 * faces);
        self.plan.add_buffer(Array::Volumes, 4 * particles);
    }
}

/// Whole numbers in the ratio of the squares of the box's edges: the smallest that are right to 32 bits, by continued
/// fractions. Which cells are neighbours is decided exactly for a box whose edges are in that ratio.
fn weights(lengths: [f64; 3]) -> [u64; 2] {
    const LARGEST: f64 = 9.0e15;
    let ratio = ((lengths[1] / lengths[0]) * (lengths[1] / lengths[0])).clamp(1.0 / LARGEST, LARGEST);
    let (mut before, mut now) = ([0.0, 1.0], [1.0, 0.0]);
    let mut rest = ratio;
    loop {
        let whole = rest.floor();
        let next = [whole * now[0] + before[0], whole * now[1] + before[1]];
        if next[0].max(next[1]) > LARGEST {
            break;
        }
        (before, now) = (now, next);
        let close = (now[0] / now[1] - ratio).abs() <= ratio * 2_f64.powi(-32);
        if close || rest == whole {
            break;
        }
        rest = 1.0 / (rest - whole);
    }
    [now[1] as u64, now[0] as u64]
}

#[cfg(test)]
mod tests {
    use super::weights;

    #[test]
    fn weights_are_in_the_ratio_of_squared_edges() {
        assert_eq!(weights([7.0, 7.0, 1.0]), [1, 1]);
        assert_eq!(weights([10.0, 20.0, 1.0]), [1, 4]);
        let pi = std::f64::consts::PI;
        for lengths in [[1000.0, 0.01, 1.0], [3.0_f64.sqrt(), 2.0, 1.0], [pi, 100.0, 1.0], [1.0, 0.123_456_789, 1.0]] {
            let [x, y] = weights(lengths);
            let (found, expected) = (y as f64 / x as f64, (lengths[1] / lengths[0]).powi(2));
            assert!((found / expected - 1.0).abs() <= 2_f64.powi(-32), "{lengths:?}: {x}, {y}");
        }
    }
}
