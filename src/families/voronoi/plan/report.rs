//! What is measured of the cells, and the analyses of them by their numbers.

use super::{Builder, plane};
use crate::families::Voronoi;
use crate::families::voronoi::observables;
use crate::plan::{Need, Reported};
use crate::shaders::{Array, Choices, Constant, Entry, voronoi};

impl Builder<'_> {
    /// Whether the velocities after friction are solved for.
    fn solves(&self) -> bool {
        self.cells.solves()
    }

    /// The kernel that adds up what the cells are like.
    pub(super) fn report(&mut self) {
        let choices = Choices::new()
            .with_any(match (self.cells.keeps_energy(), self.cells.exchanges_mass()) {
                (true, _) => Some(voronoi::GasReport::Energy),
                (false, false) => Some(voronoi::GasReport::Isothermal),
                (false, true) => None,
            })
            .with_any(match (self.solves(), self.has_limits()) {
                (true, _) => Some(voronoi::RunReport::Solver),
                (false, true) => Some(voronoi::RunReport::Limits),
                (false, false) => None,
            })
            .with_if(self.measured.needs(Need::Particles), voronoi::Note::ById);
        let groups = self.groups(self.particles);
        let observe = self.kernel("observe", Entry::ObserveCells, &choices, groups);
        let quanta = self.plan.quanta;
        self.plan.kernels[observe].constants = vec![
            (Constant::FirstGroup, 0.0),
            (Constant::Kinetic, 1.0 / quanta.energy),
            (Constant::VolumeSteps, 1.0 / quanta.length_squared),
            (Constant::MeanVolume, Voronoi::mean_volume(self.model)),
        ];
        self.plan.report.push(observe);
    }

    /// The sampler of the observables.
    pub(super) fn observables(&mut self) {
        let (sums, groups) = (observables::sums(self.cells, self.model), self.groups(self.particles));
        self.plan.sample_observables(self.measured.every, &sums, groups);
    }

    /// The cells of a report, where an analysis needs them.
    pub(super) fn reported(&mut self) -> Option<Reported> {
        if !self.measured.needs(Need::Particles) {
            return None;
        }
        self.plan.add_buffer(Array::Reported, 32 * self.particles);
        let choices = plane();
        Some(Reported {
            choices,
            between: Vec::new(),
            particles: Array::Reported,
            momenta: None,
            forces: Array::ReportedForces,
        })
    }
}
