//! Angles between bonds.

use super::Builder;
use crate::families::Angles;
use crate::plan::Words;
use crate::shaders::{Array, Choices, Constant, Entry, bonds};

impl Builder<'_> {
    pub(super) fn angles(&mut self) {
        let Some(angles) = self.model.particles().angles.as_ref() else { return };
        let count = angles.count();
        let groups = self.groups(count);
        // The constant of pairs counts both ends of one.
        let laplacian = 1.0 / (self.impulse() * self.plan.quanta.curvature);
        self.plan.constants.extend([
            (Constant::Angles, count as f64),
            (Constant::FirstAngle, self.model.species.len() as f64),
            (Constant::AngleLaplacian, laplacian),
        ]);
        let advance = self.kernel("angles", Entry::BendAngles, &Choices::new(), groups);
        self.plan.advance.push(advance);
        let seen = Choices::new().with(bonds::AngleReport::Observed).with_any(self.forces());
        self.report_kernel("report_angles", Entry::BendAngles, &seen, groups);
        let mobile = self.model.species.iter().map(|species| [u32::from(!species.fixed), 0, 0, 0]);
        let impulses = angles.stiffness.iter().map(|stiffness| ((stiffness * self.impulse()) as f32).to_bits());
        let (head, impulses) = (mobile.flatten().collect(), impulses.collect());
        let table = AngleTable { head, angles: angles.clone(), impulses };
        self.plan.add_long_table(Array::Angles, table);
        self.plan.operations_per_particle += 100.0 * count as f64 / self.particles.max(1) as f64;
    }
}

/// Words about species, then the ends of each angle and the impulse of its stiffness in half a step.
#[derive(Debug, Clone, PartialEq)]
struct AngleTable {
    /// What comes before the angles.
    head: Vec<u32>,
    angles: Angles,
    /// The impulse of each kind of angles, bits of `f32`.
    impulses: Vec<u32>,
}

impl Words for AngleTable {
    fn count(&self) -> u64 {
        self.angles.count().saturating_mul(4).saturating_add(self.head.len() as u64)
    }

    fn words(&self) -> Vec<u32> {
        let angles = self.angles.iter().flat_map(|angle| {
            let [first, middle, last] = angle.ends;
            [first, middle, last, self.impulses[angle.kind as usize]]
        });
        self.head.iter().copied().chain(angles).collect()
    }
}
