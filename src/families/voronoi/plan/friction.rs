//! Conjugate gradients for the velocities after friction, all of them on the device: some iterations are recorded, and a run
//! whose friction needs more is repeated with twice as many.

use super::Builder;
use crate::shaders::{Array, Choices, Constant, Entry, voronoi};

/// Lanes of a workgroup of the solver, whose sums are of single precision: no choice, for results depend on it.
const LANES: u64 = 64;
/// Cells whose equations one workgroup solves as fast as many.
const FEW: u64 = 2048;
/// Sums of workgroups that every workgroup adds up for itself, which costs less than a kernel that does so for all.
const FEW_SUMS: u64 = 1024;
/// Iterations that usual friction takes at most.
const USUAL: u32 = 8;
/// The buffer of what the solver has come to.
pub(in crate::families::voronoi) const SOLVER: Array = Array::Solver;

/// Bytes of what the solver has come to, before the sums of workgroups.
const HEADER: u64 = 64;

impl Builder<'_> {
    /// Kernels that find the mean velocities of a whole step of friction.
    pub(super) fn solve_friction(&mut self) -> Vec<usize> {
        let groups = self.particles.div_ceil(LANES).max(1);
        let (none, image) = (Choices::new(), Choices::new().with(voronoi::Visit::Image));
        let begin = self.kernel("friction_begin", Entry::FrictionBegin, &none, 1);
        let setup =
            self.rubbing().with(voronoi::Visit::Equations).with_if(self.rubs_at_random(), voronoi::NoiseKey::Solver);
        let setup = self.kernel("friction_setup", Entry::FrictionSetup, &setup, groups);
        self.solver_buffers(groups);
        let has_total = groups > FEW_SUMS;
        let (first, sums) = if has_total { (groups, 1) } else { (0, groups) };
        let all = [(Constant::CellGroups, groups as f64)];
        let added = [(Constant::FirstSum, first as f64), (Constant::Sums, sums as f64)];
        let judged = [
            (Constant::Tolerance, self.cells.solver.tolerance),
            (Constant::Iterations, f64::from(self.cells.solver.iterations)),
        ];
        let recorded = self.recorded_iterations();
        let mut with = |name, entry, choices: &Choices, groups, constants: &[&[(Constant, f64)]]| {
            let kernel = self.kernel(name, entry, choices, groups);
            self.plan.kernels[kernel].constants = constants.concat();
            kernel
        };
        let Some(recorded) = recorded else {
            return vec![begin, setup, with("friction_solve", Entry::FrictionSolve, &image, 1, &[&all, &judged])];
        };
        let step = with("friction_step", Entry::FrictionStep, &none, groups, &[&added, &judged]);
        let end = with("friction_end", Entry::FrictionEnd, &none, 1, &[&all, &judged]);
        let total = has_total.then(|| with("friction_total", Entry::FrictionTotal, &none, 1, &[&all]));
        let image = self.kernel("friction_image", Entry::FrictionImage, &image, groups);
        let iteration = || std::iter::once(image).chain(total).chain([step]);
        let iterations = (0..recorded).flat_map(|_| iteration());
        [begin, setup].into_iter().chain(iterations).chain([image, end]).collect()
    }

    /// Iterations that are kernels; none where one workgroup goes through all of them.
    fn recorded_iterations(&self) -> Option<u32> {
        let usual = USUAL.saturating_mul(1 << self.options.iteration_growth.min(31));
        (self.particles > FEW).then(|| usual.min(self.cells.solver.iterations))
    }

    fn solver_buffers(&mut self, groups: u64) {
        let many = self.recorded_iterations().is_some();
        if many {
            self.plan.add_buffer(Array::Images, 8 * self.particles);
        }
        self.plan.add_buffer(SOLVER, HEADER + 16 * (groups + 1));
        self.plan.add_buffer(Array::Estimates, 16 * self.particles);
        self.plan.add_buffer(Array::Preconditioners, 16 * self.particles);
        self.plan.add_buffer(Array::Searches, 16 * self.particles);
        let directions = if many { 16 } else { 32 };
        self.plan.add_buffer(Array::Directions, directions * self.particles);
    }
}
