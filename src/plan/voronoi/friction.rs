//! Conjugate gradients for the velocities after friction, all of them on the device: iterations are recorded ahead, and the
//! kernels of those that are not needed get no workgroups.

use super::Builder;
use crate::plan::{Contents, folded};

/// Lanes of a workgroup of the solver, whose sums are of single precision: no choice, for results depend on it.
const LANES: u64 = 64;
/// Bytes of what the solver has come to, before the sums of workgroups.
const HEADER: u64 = 48;

impl Builder<'_> {
    /// Kernels that find the mean velocities of a whole step of friction.
    pub(super) fn solve_friction(&mut self) -> Vec<usize> {
        let groups = self.particles.div_ceil(LANES).max(1);
        let begin =
            self.bare_kernel("friction_begin", vec!["common/control", "common/solver", "kernels/friction_begin"], 1);
        let mut setup =
            vec!["common/solver", "common/friction_sums", "common/preconditioner", "common/face", "common/facet"];
        setup.extend(self.cell());
        setup.extend(["common/side"]);
        setup.extend(self.rubbing());
        if self.rubs_at_random() {
            setup.extend(self.words());
            setup.push("common/key_of_solver");
        } else {
            setup.push("common/key_unused");
        }
        setup.push("kernels/friction_setup");
        let setup = self.kernel("friction_setup", &setup, groups);
        let image = ["common/solver", "common/friction_sums", "common/face", "kernels/friction_image"];
        let image = self.kernel("friction_image", &image, groups);
        let judge = ["common/solver", "common/friction_sums", "kernels/friction_judge"];
        let judge = self.bare_kernel("friction_judge", judge.to_vec(), 1);
        let step = ["common/solver", "common/friction_sums", "common/preconditioner", "kernels/friction_step"];
        let step = self.kernel("friction_step", &step, groups);
        self.plan.kernels[judge].constants = vec![
            ("CELL_GROUPS", groups as f64),
            ("TOLERANCE", self.cells.solver.tolerance),
            ("ITERATIONS", f64::from(self.cells.solver.iterations)),
        ];
        for kernel in [image, step] {
            self.plan.kernels[kernel].demand = Some(1);
        }
        self.solver_buffers(groups);
        let mut kernels = vec![begin, setup];
        for _ in 0..self.cells.solver.iterations {
            kernels.extend([image, judge, step]);
        }
        // The residual that is left.
        kernels.extend([image, judge]);
        kernels
    }

    fn solver_buffers(&mut self, groups: u64) {
        let [width, height] = folded(groups as u32);
        let demands: [u32; 6] = [width, height, 1, 0, 0, 0];
        let bytes: Vec<u8> = bytemuck::cast_slice(&demands).to_vec();
        // As large as the least buffer.
        let bytes = [bytes, vec![0; 40]].concat();
        self.buffer_of(
            "demands",
            "workgroups of an iteration of the solver",
            bytes.len() as u64,
            Contents::Bytes(bytes),
        );
        self.buffer("solver", "how far the solver of the friction has come", HEADER + 16 * groups);
        self.buffer("estimates", "mean velocities in friction, and residuals", 16 * self.particles);
        self.buffer("preconditioners", "what a cell's own friction does to its velocity", 16 * self.particles);
        self.buffer("searches", "preconditioned residuals", 16 * self.particles);
        self.buffer("images", "what friction makes of them", 8 * self.particles);
        self.buffer("directions", "directions of search, and what friction makes of them", 16 * self.particles);
    }
}
