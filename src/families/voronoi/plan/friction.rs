//! Conjugate gradients for the velocities after friction, all of them on the device: iterations are recorded ahead, and the
//! kernels of those that are not needed get no workgroups.

use super::Builder;
use crate::plan::folded;
use crate::shaders::{Choices, Entry, voronoi};

/// Lanes of a workgroup of the solver, whose sums are of single precision: no choice, for results depend on it.
const LANES: u64 = 64;
/// Cells whose equations one workgroup solves as fast as many.
const FEW: u64 = 2048;
/// The buffer of what the solver has come to.
pub(in crate::families::voronoi) const SOLVER: &str = "solver";

/// Bytes of what the solver has come to, before the sums of workgroups.
const HEADER: u64 = 48;

impl Builder<'_> {
    /// Kernels that find the mean velocities of a whole step of friction.
    pub(super) fn solve_friction(&mut self) -> Vec<usize> {
        let groups = self.particles.div_ceil(LANES).max(1);
        let iterations = Choices::new().with_if(!self.solves_at_once(), voronoi::FrictionIterations::Demanded);
        let begin = self.kernel("friction_begin", Entry::FrictionBegin, &iterations, 1);
        let setup = self.rubbing().with_if(self.rubs_at_random(), voronoi::NoiseKey::Solver);
        let setup = self.kernel("friction_setup", Entry::FrictionSetup, &setup, groups);
        self.solver_buffers(groups);
        let verdict = vec![
            ("CELL_GROUPS", groups as f64),
            ("TOLERANCE", self.cells.solver.tolerance),
            ("ITERATIONS", f64::from(self.cells.solver.iterations)),
        ];
        let none = Choices::new();
        if self.solves_at_once() {
            let solve = self.kernel("friction_solve", Entry::FrictionSolve, &none, 1);
            self.plan.kernels[solve].constants = verdict;
            return vec![begin, setup, solve];
        }
        let image = self.kernel("friction_image", Entry::FrictionImage, &none, groups);
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
            self.plan.add_table("demands", "workgroups of an iteration of the solver", bytes);
            self.plan.add_buffer("images", "what friction makes of preconditioned residuals", 8 * self.particles);
        }
        self.plan.add_buffer(SOLVER, "how far the solver of the friction has come", HEADER + 16 * groups);
        self.plan.add_buffer("estimates", "mean velocities in friction, and residuals", 16 * self.particles);
        self.plan.add_buffer("preconditioners", "what a cell's own friction does to its velocity", 16 * self.particles);
        self.plan.add_buffer("searches", "preconditioned residuals", 16 * self.particles);
        let directions = if self.solves_at_once() { 32 } else { 16 };
        self.plan.add_buffer(
            "directions",
            "directions of search, and what friction makes of them",
            directions * self.particles,
        );
    }
}
