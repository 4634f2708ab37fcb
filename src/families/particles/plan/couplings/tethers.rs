//! Springs from every particle to where it started.

use super::Builder;
use crate::shaders::{Choices, Entry, bonds};

impl Builder<'_> {
    pub(super) fn tethers(&mut self) {
        let Some(stiffness) = self.model.tether() else { return };
        let groups = self.groups(self.particles);
        let quanta = self.plan.quanta;
        self.plan.constants.extend([
            ("TETHER", stiffness * self.impulse()),
            ("TETHER_ENERGY", 0.5 * stiffness / quanta.pair_energy),
            ("TETHER_LAPLACIAN", stiffness * self.model.units.dimension as f64 / quanta.curvature),
        ]);
        let advance = self.kernel("tethers", Entry::PullTethers, &Choices::new(), groups);
        self.plan.advance.push(advance);
        let seen = Choices::new().with(bonds::TetherReport::Observed).with_any(self.forces());
        self.report_kernel("report_tethers", Entry::PullTethers, &seen, groups);
        self.plan.add_buffer("tethers", "where each particle is tied to, by number", 16 * self.particles);
        self.plan.operations_per_particle += 15.0;
    }
}
