//! Angles between bonds.

use super::Builder;

impl Builder<'_> {
    pub(super) fn angles(&mut self) {
        let Some(angles) = &self.model.angles else { return };
        let count = angles.angles.len() as u64;
        let groups = self.groups(count);
        // The constant of pairs counts both ends of one.
        let laplacian = 1.0 / (self.impulse() * self.plan.quanta.curvature);
        self.plan.constants.extend([
            ("ANGLES", count as f64),
            ("FIRST_ANGLE", self.model.species.len() as f64),
            ("ANGLE_LAPLACIAN", laplacian),
        ]);
        let modules = [self.kicks(), "common/contact", "kernels/angles"];
        let advance = self.kernel("angles", &[&modules[..], &["common/angles_unseen"]].concat(), groups);
        self.plan.advance.push(advance);
        let seen = [self.forces(), "common/angles_seen"];
        self.report_kernel("report_angles", &[&modules[..], &seen].concat(), groups);
        let mobile = self.model.species.iter().map(|species| [u32::from(!species.fixed), 0, 0, 0]);
        let bent = angles.angles.iter().map(|angle| {
            let [first, middle, last] = angle.ends;
            let stiffness = angles.stiffness[angle.kind as usize] * self.impulse();
            [first, middle, last, (stiffness as f32).to_bits()]
        });
        let words: Vec<[u32; 4]> = mobile.chain(bent).collect();
        let bytes: Vec<u8> = bytemuck::cast_slice(&words).to_vec();
        self.plan.add_table("angles", "angles and their stiffness", bytes);
        self.plan.operations_per_particle += 100.0 * count as f64 / self.particles.max(1) as f64;
    }
}
