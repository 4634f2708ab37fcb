//! Springs from every particle to where it started.

use super::Builder;
use crate::families::particles::plan::tethers;
use crate::shaders::{Array, Choices, Entry, bonds};

impl Builder<'_> {
    pub(super) fn tethers(&mut self) {
        let Some(stiffness) = self.model.particles().tether else { return };
        let groups = self.groups(self.particles);
        let constants = tethers::constants(&self.scales(), stiffness);
        self.plan.constants.extend(constants);
        let advance = self.kernel("tethers", Entry::PullTethers, &Choices::new(), groups);
        self.plan.advance.push(advance);
        let seen = Choices::new().with(bonds::TetherReport::Observed).with_any(self.forces());
        self.report_kernel("report_tethers", Entry::PullTethers, &seen, groups);
        self.plan.add_buffer(Array::Tethers, 16 * self.particles);
        self.plan.operations_per_particle += 15.0;
    }
}
