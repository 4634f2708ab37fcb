//! Analyses of a coupled scene: of particles by number, as everywhere, and of distances, for which the particles are ordered
//! by cell on the side.

use super::Builder;
use crate::plan::ARRANGE;
use crate::plan::analyses::{self, Reported};
use crate::plan::pair_histogram::PairHistogram;
use crate::scene::{Output, RadialDistribution};

impl Builder<'_> {
    pub(super) fn analyses(&mut self, output: &Output) {
        if let Some(asked) = &output.radial_distribution {
            self.radial_distribution(asked);
        }
        // What is reported has no predicted momentum.
        let space = vec![self.dimensions(), "common/particle", "common/control", "common/clock", "common/dispatch"];
        let reported = Reported {
            model: self.model,
            equilibration: self.equilibration,
            workgroup: self.options.workgroup(),
            space,
            masses: [self.species.masses(), &["common/mass_of_species"]].concat(),
            particles: "reported",
            momenta: None,
            forces: "reported_forces",
            force_unit: self.plan.force_unit,
        };
        analyses::add(&mut self.plan, &reported, output);
    }

    /// The module that keeps the forces of a report, or does not.
    pub(super) fn reported_forces(&mut self, output: &Output) -> &'static str {
        if !analyses::needs_forces(output) {
            return "common/force_off";
        }
        self.plan.force_unit = 1.0 / self.impulse();
        self.plan.add_buffer("reported_forces", "impulses on each particle at a report", 16 * self.particles);
        "common/force_on"
    }

    fn radial_distribution(&mut self, asked: &RadialDistribution) {
        let mut kernels = self.binning();
        let groups = self.groups(self.particles.max(self.grid.count()));
        // On the side: the list and what it has noted stay as they are.
        let arrange = [&[self.cells()][..], &ARRANGE].concat();
        kernels.push(self.kernel("arrange_by_cell", &arrange, groups));
        if self.model.pair_force().is_none() {
            self.ordering_buffers();
        }
        let sorted = ["common/particles", self.cells(), "common/cells_plain", "common/cells_buffer", "common/sorted"];
        let modules = [&self.space()[..], &sorted].concat();
        let histogram = PairHistogram { units: &self.model.units, grid: &self.grid, options: self.options, asked };
        histogram.add(&mut self.plan, modules, kernels, self.equilibration, false);
    }
}
