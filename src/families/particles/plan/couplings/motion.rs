//! The end of a step for every particle: what acts on it by itself, half kicks, drift.

use super::Builder;
use crate::families::particles::plan::{own, walls};
use crate::families::particles::sums::sums;
use crate::shaders::{Array, Choices, Entry, couplings};

impl Builder<'_> {
    pub(super) fn motion(&mut self) {
        let groups = self.groups(self.particles);
        own::add(&self.scales(), &mut self.plan);
        let anchored = own::choices(self.model)
            .with_if(self.visits_pairs(), couplings::Anchors::Kept)
            .and(&walls::booking(self.model));
        let advance = self.kernel("move", Entry::MoveParticles, &anchored, groups);
        self.plan.advance.push(advance);
        let forces = self.reported_forces();
        // Masses, baths, tethers, a random force and an analysis of forces at once are two buffers too many.
        let acting = u32::from(self.species.have_table()) + own::buffers(self.model);
        let step = 3 + u32::from(self.visits_pairs()) + u32::from(walls::count(self.model) > 0);
        let report = 5 + own::products(self.model) + u32::from(forces.is_some());
        self.plan.storage_buffers = self.plan.storage_buffers.max(acting + step.max(report));
        let report = own::report_choices(self.model).with_any(forces);
        self.report_kernel("observe", Entry::ObserveParticles, &report, groups);
        if let Some(observe) = self.plan.report.last() {
            self.plan.kernels[*observe].constants.extend(walls::frozen_sums(self.model, &sums(self.model)));
        }
        if self.model.has_potential() {
            self.plan.add_buffer(Array::Forces, 16 * self.particles);
            self.report_kernel("square_forces", Entry::SquareForces, &Choices::new(), groups);
        }
        self.plan.operations_per_particle += 60.0;
    }
}
