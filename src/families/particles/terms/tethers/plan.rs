//! Tethers on the device: a kernel that gathers their impulses, and one that reports them.

use super::Tethers;
use crate::families::particles::plan::step::{Builder, GatheringKernels, Masks};
use crate::families::particles::terms::PlannedTerm;
use crate::plan::Traversal;
use crate::shaders::{Choices, Constant, bonds, pairs};

impl PlannedTerm for Tethers {
    fn gather(&self, builder: &mut Builder<'_>, rows: &mut u32, kernels: &mut GatheringKernels) {
        let (scales, stiffness) = (builder.scales(), self.stiffness);
        builder.plan.constants.extend([
            (Constant::Tether, stiffness * scales.impulse()),
            (Constant::TetherEnergy, 0.5 * stiffness / scales.quanta.pair_energy),
            (Constant::TetherLaplacian, stiffness * builder.model.units.dimension as f64 / scales.quanta.curvature),
        ]);
        let pass = Choices::new().with(pairs::Pass::PullTethers).and(&builder.kicks());
        kernels.kicks.push(builder.traversal("tethers", Traversal::Alone, Masks::Unkept, &pass));
        // Half a drift later the report of a split step needs the impulses there.
        let seen = pass.with(bonds::TetherReport::Observed);
        let report = builder.traversal("report_tethers", Traversal::Alone, Masks::Unkept, &seen);
        builder.leaves_rows(report, rows);
        let reports = if builder.splits() { &mut kernels.configuration } else { &mut kernels.report };
        reports.push(report);
        builder.plan.operations_per_particle += 15.0;
    }
}
