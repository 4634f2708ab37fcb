//! Analyses of a coupled scene: of particles by number, as everywhere, and of distances, for which the particles are ordered
//! by cell on the side.

use super::Builder;
use crate::plan::analyses::{self, Reported};
use crate::plan::pair_histogram::PairHistogram;
use crate::scene::{Output, RadialDistribution};
use crate::shaders::{Choices, Entry, pairs, space};

impl Builder<'_> {
    pub(super) fn analyses(&mut self, output: &Output) {
        if let Some(asked) = &output.radial_distribution {
            self.radial_distribution(asked);
        }
        let reported = Reported {
            model: self.model,
            equilibration: self.equilibration,
            workgroup: self.options.workgroup(),
            // What is reported has no predicted momentum.
            choices: self.dimension().with(space::Particle::Plain).and(&self.species.choices()),
            particles: "reported",
            momenta: None,
            forces: "reported_forces",
            force_unit: self.plan.force_unit,
        };
        analyses::add(&mut self.plan, &reported, output);
    }

    /// Keeps the forces of a report, where an analysis asks.
    pub(super) fn reported_forces(&mut self, output: &Output) -> Option<pairs::ReportedForce> {
        if !analyses::needs_forces(output) {
            return None;
        }
        self.plan.force_unit = 1.0 / self.impulse();
        self.plan.add_buffer("reported_forces", "impulses on each particle at a report", 16 * self.particles);
        Some(pairs::ReportedForce::Kept)
    }

    fn radial_distribution(&mut self, asked: &RadialDistribution) {
        let mut kernels = self.binning();
        let groups = self.groups(self.particles.max(self.grid.count()));
        // On the side: the list and what it has noted stay as they are.
        kernels.push(self.kernel("arrange_by_cell", Entry::ArrangeParticles, &Choices::new(), groups));
        if self.model.pair_force().is_none() {
            self.ordering_buffers();
        }
        let choices = self.choices();
        let histogram = PairHistogram { units: &self.model.units, grid: &self.grid, options: self.options, asked };
        histogram.add(&mut self.plan, &choices, kernels, self.equilibration, false);
    }
}
