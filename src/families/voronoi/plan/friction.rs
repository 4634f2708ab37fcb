//! Conjugate gradients for the velocities after friction, all of them on the device: iterations are recorded ahead, and the
//! kernels of those that are not needed get no workgroups.

use super::Builder;
use crate::plan::folded;
use crate::shaders::{Array, Choices, Constant, Entry, voronoi};

/// Lanes of a workgroup of the solver, whose sums are of single precision: no choice, for results depend on it.
const LANES: u64 = 64;
/// Cells whose equations one workgroup solves as fast as many.
const FEW: u64 = 2048;
/// The buffer of what the solver has come to.
pub(in crate::families::voronoi) const SOLVER: Array = Array::Solver;

/// Bytes of what the solver has come to, before the sums of workgroups.
const HEADER: u64 = 48;

impl Builder<'_> {
    /// Kernels that find the mean velocities of a whole step of friction.
    pub(super) fn solve_friction(&mut self) -> Vec<usize> {
        let groups = self.particles.div_ceil(LANES).max(1);
        let iterations = Choices::new().with_if(!self.solves_at_once(), voronoi::FrictionIterations::Demanded);
        let begin = self.kernel("friction_begin", Entry::FrictionBegin, &iterations, 1);
        let setup =
            self.rubbing().with(voronoi::Visit::Equations).with_if(self.rubs_at_random(), voronoi::NoiseKey::Solver);
        let setup = self.kernel("friction_setup", Entry::FrictionSetup, &setup, groups);
        self.solver_buffers(groups);
        let verdict = vec![
            (Constant::CellGroups, groups as f64),
            (Constant::Tolerance, self.cells.solver.tolerance),
            (Constant::Iterations, f64::from(self.cells.solver.iterations)),
        ];
        let (none, image) = (Choices::new(), Choices::new().with(voronoi::Visit::Image));
        if self.solves_at_once() {
            let solve = self.kernel("friction_solve", Entry::FrictionSolve, &image, 1);
            self.plan.kernels[solve].constants = verdict;
            return vec![begin, setup, solve];
        }
        let image = self.kernel("friction_image", Entry::FrictionImage, &image, groups);
        let judge = self.kernel("friction_judge", Entry::FrictionJudge, &none, 1);
        self.plan.kernels[judge].constants = verdict;
        let step = self.kernel("friction_step", Entry::FrictionStep, &none, groups);
        for kernel in [image, step] {
            self.plan.kernels[kernel].demand = Some(1);
        }
        let mut kernels = vec![begin, setup];
        for _ in 0..self.cells.solver.iterations {
            kernels.extend([image, judge, step]);
        }
        // The residual that is left.
        kernels.extend([image, judge]);
        kernels
    }

    /// Whether one workgroup goes through all iterations.
    fn solves_at_once(&self) -> bool {
        self.particles <= FEW
    }

    fn solver_buffers(&mut self, groups: u64) {
        if !self.solves_at_once() {
            let [width, height] = folded(groups as u32);
            // Filled up to the least size of a buffer.
            let mut demands = [0_u32; 16];
            demands[..3].copy_from_slice(&[width, height, 1]);
            let bytes: Vec<u8> = bytemuck::cast_slice(&demands).to_vec();
            self.plan.add_table(Array::Demands, bytes);
            self.plan.add_buffer(Array::Images, 8 * self.particles);
        }
        self.plan.add_buffer(SOLVER, HEADER + 16 * groups);
        self.plan.add_buffer(Array::Estimates, 16 * self.particles);
        self.plan.add_buffer(Array::Preconditioners, 16 * self.particles);
        self.plan.add_buffer(Array::Searches, 16 * self.particles);
        let directions = if self.solves_at_once() { 32 } else { 16 };
        self.plan.add_buffer(Array::Directions, directions * self.particles);
    }
}
