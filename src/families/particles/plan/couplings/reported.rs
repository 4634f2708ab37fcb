//! What a coupled scene leaves for analyses: particles by number, as everywhere, and ordered by cell on the side.

use super::{Builder, Need, Ordered, Reported};
use crate::shaders::{Array, Choices, Entry, pairs, space};

impl Builder<'_> {
    /// The particles of a report.
    pub(super) fn reported(&self) -> Reported {
        Reported {
            // What is reported has no predicted momentum.
            choices: self.dimension().with(space::Particle::Plain).and(&self.species.choices()),
            particles: Array::Reported,
            momenta: None,
            forces: Array::ReportedForces,
        }
    }

    /// Keeps the forces of a report, where an analysis needs them.
    pub(super) fn reported_forces(&mut self) -> Option<pairs::ReportedForce> {
        if !self.measured.needs(Need::Forces) {
            return None;
        }
        self.plan.force_unit = 1.0 / self.impulse();
        self.plan.add_buffer(Array::ReportedForces, 16 * self.particles);
        Some(pairs::ReportedForce::Kept)
    }

    /// The particles by cell, where an analysis needs them.
    pub(super) fn ordered(&mut self) -> Option<Ordered> {
        if !self.measured.needs(Need::Order) {
            return None;
        }
        let mut kernels = self.binning();
        let groups = self.groups(self.particles.max(self.grid.count()));
        // On the side: the list and what it has noted stay as they are.
        kernels.push(self.kernel("arrange_by_cell", Entry::ArrangeParticles, &Choices::new(), groups));
        if !self.visits_pairs() {
            self.ordering_buffers();
        }
        Some(Ordered { choices: self.choices(), kernels, grid: self.grid, needs_report: false })
    }
}
