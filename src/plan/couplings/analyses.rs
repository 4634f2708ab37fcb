//! Analyses of a coupled scene: of particles by number, as everywhere, and of distances, for which the particles are ordered
//! by cell on the side.

use super::Builder;
use crate::plan::analyses::{self, Reported};
use crate::plan::recording::record_histogram;
use crate::plan::{ARRANGE, Sampler};
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
        let span = |axis: usize| {
            let width = self.model.units.lengths[axis] / f64::from(self.grid.cells[axis]);
            let cells = 2 * (asked.range / width).ceil() as u32 + 1;
            f64::from(if axis < self.grid.dimension { cells.min(self.grid.cells[axis]) } else { 1 })
        };
        let bins = u64::from(asked.bins);
        let rows = self.grid.rows();
        let segments = (self.particles / rows).div_ceil(self.options.workgroup()).clamp(1, (8192 / rows).max(1));
        let constants = vec![
            ("BINS", bins as f64),
            ("HISTOGRAM_RANGE", asked.range),
            ("SPAN_X", span(0)),
            ("SPAN_Y", span(1)),
            ("SPAN_Z", span(2)),
            ("SEGMENTS", segments as f64),
        ];
        let mut kernels = self.binning();
        let groups = self.groups(self.particles.max(self.grid.count()));
        // On the side: the list and what it has noted stay as they are.
        let arrange = [&[self.cells()][..], &ARRANGE].concat();
        kernels.push(self.kernel("arrange_by_cell", &arrange, groups));
        let sorted = [self.cells(), "common/cells_plain", "common/cells_buffer", "common/sorted"];
        let span = if self.model.units.dimension == 3 { "common/span3" } else { "common/span2" };
        let modules = [&sorted[..], &["common/contact", span, "kernels/pair_histogram"]].concat();
        let count = self.kernel("pair_histogram", &modules, rows * segments);
        self.plan.kernels[count].constants = constants;
        kernels.push(count);
        let record = record_histogram(bins).renamed(vec![("samples", "histogram_samples")]);
        kernels.push(self.plan.add_kernel(record));
        let capacity = 16;
        self.plan.add_buffer("histogram", "pairs by distance", 8 * bins);
        self.plan.add_buffer("histogram_samples", "histograms waiting to be read", 8 * (1 + capacity * (1 + bins)));
        if self.model.pair_force.is_none() {
            self.ordering_buffers();
        }
        self.plan.samplers.push(Sampler {
            name: "radial_distribution",
            first: self.equilibration,
            every: asked.every,
            kernels,
            samples: "histogram_samples",
            quantities: asked.bins as usize,
            capacity,
            needs_report: false,
        });
    }
}
