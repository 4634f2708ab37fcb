//! Tethers beside pairs: a kernel that adds their impulses by sorted particle, and tells a report about them.

use super::bonded::BondedKernels;
use super::{Builder, Masks};
use crate::families::particles::plan::bonded;
use crate::families::particles::plan::tethers;
use crate::plan::Traversal;
use crate::shaders::{Array, Choices, Constant, bonds, pairs};

impl Builder<'_> {
    /// Whether particles are tied to places.
    pub(super) fn is_tethered(&self) -> bool {
        self.model.particles().tether.is_some()
    }

    /// Adds the kernels of tethers to those of bonds; that of a report raises the number of rows.
    pub(super) fn tethers(&mut self, rows: &mut u32, kernels: &mut BondedKernels) {
        let Some(stiffness) = self.model.particles().tether else { return };
        let scales = self.scales();
        self.plan.constants.extend(tethers::constants(&scales, stiffness));
        let kicks = bonded::kicks(self.model.units.dimension);
        let pass = Choices::new().with(pairs::Pass::PullTethers);
        let alone = |builder: &mut Self, name, choices: &Choices| {
            builder.traversal(name, Traversal::Alone, Masks::Unkept, &pass.clone().and(choices))
        };
        kernels.kicks.push(alone(self, "tethers", &kicks));
        let seen = Choices::new().with(bonds::TetherReport::Observed);
        // Half a drift later the report of a split step needs the impulses there.
        let seen = if self.splits() { seen.and(&kicks) } else { seen };
        let report = alone(self, "report_tethers", &seen);
        self.plan.kernels[report].constants.push((Constant::FirstGroup, f64::from(*rows)));
        *rows += self.plan.kernels[report].workgroups;
        let reports = if self.splits() { &mut kernels.configuration } else { &mut kernels.report };
        reports.push(report);
        self.plan.add_buffer(Array::Tethers, 16 * self.particles);
        self.plan.operations_per_particle += 15.0;
    }
}
