//! Angles between bonds.

use super::Builder;
use crate::plan::Table;
use crate::shaders::{Choices, Entry, bonds};

impl Builder<'_> {
    pub(super) fn angles(&mut self) {
        let Some(angles) = self.model.angles() else { return };
        let count = angles.count();
        let groups = self.groups(count);
        // The constant of pairs counts both ends of one.
        let laplacian = 1.0 / (self.impulse() * self.plan.quanta.curvature);
        self.plan.constants.extend([
            ("ANGLES", count as f64),
            ("FIRST_ANGLE", self.model.species.len() as f64),
            ("ANGLE_LAPLACIAN", laplacian),
        ]);
        let advance = self.kernel("angles", Entry::BendAngles, &Choices::new(), groups);
        self.plan.advance.push(advance);
        let seen = Choices::new().with(bonds::AngleReport::Observed).with_any(self.forces());
        self.report_kernel("report_angles", Entry::BendAngles, &seen, groups);
        let mobile = self.model.species.iter().map(|species| [u32::from(!species.fixed), 0, 0, 0]);
        let impulses = angles.stiffness.iter().map(|stiffness| ((stiffness * self.impulse()) as f32).to_bits());
        let (head, impulses) = (mobile.flatten().collect(), impulses.collect());
        let table = Table::Angles { head, angles: angles.clone(), impulses };
        self.plan.add_long_table("angles", "angles and their stiffness", table);
        self.plan.operations_per_particle += 100.0 * count as f64 / self.particles.max(1) as f64;
    }
}
