//! Tethers: a kernel that gathers their impulses, and tells a report about them.

use super::gathered::GatheringKernels;
use super::{Builder, Masks};
use crate::families::particles::plan::tethers;
use crate::plan::Traversal;
use crate::shaders::{Array, Choices, bonds, pairs};

impl Builder<'_> {
    /// Whether particles are tied to places.
    pub(super) fn is_tethered(&self) -> bool {
        self.model.particles().tether.is_some()
    }

    /// Adds the kernels of tethers to those of other couplings; that of a report raises the number of rows.
    pub(super) fn tethers(&mut self, rows: &mut u32, kernels: &mut GatheringKernels) {
        let Some(stiffness) = self.model.particles().tether else { return };
        self.plan.constants.extend(tethers::constants(&self.scales(), stiffness));
        let pass = Choices::new().with(pairs::Pass::PullTethers).and(&self.kicks());
        kernels.kicks.push(self.traversal("tethers", Traversal::Alone, Masks::Unkept, &pass));
        // Half a drift later the report of a split step needs the impulses there.
        let seen = pass.with(bonds::TetherReport::Observed);
        let report = self.traversal("report_tethers", Traversal::Alone, Masks::Unkept, &seen);
        self.leaves_rows(report, rows);
        let reports = if self.splits() { &mut kernels.configuration } else { &mut kernels.report };
        reports.push(report);
        self.plan.add_buffer(Array::Tethers, 16 * self.particles);
        self.plan.operations_per_particle += 15.0;
    }
}
