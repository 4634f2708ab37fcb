//! What is measured of the cells, and the analyses of them by their numbers.

use super::{Builder, plane};
use crate::families::Voronoi;
use crate::plan::{Need, Reported};
use crate::shaders::{Array, Choices, Constant, Entry, voronoi};

/// Sums of a report, in order: kinetic energy, two components of momentum, mass, volume, sides of faces; then free energy,
/// or internal energy, total energy and temperature; then exchanges that a limit has cut; then iterations and residual.
const OF_MOTION: u64 = 6;
const OF_GAS: u64 = 3;
const OF_LIMITS: u64 = 1;
const OF_SOLVER: u64 = 2;

impl Builder<'_> {
    /// Whether the velocities after friction are solved for.
    fn solves(&self) -> bool {
        self.cells.solves(self.model)
    }

    fn quantities(&self) -> u64 {
        let gas = OF_MOTION + if self.cells.keeps_energy() { OF_GAS } else { 1 };
        match (self.solves(), self.has_limits()) {
            (true, _) => OF_MOTION + OF_GAS + OF_LIMITS + OF_SOLVER,
            (false, true) => OF_MOTION + OF_GAS + OF_LIMITS,
            (false, false) => gas,
        }
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
            (Constant::Quantities, self.quantities() as f64),
            (Constant::FirstGroup, 0.0),
            (Constant::Kinetic, 1.0 / quanta.energy),
            (Constant::VolumeSteps, 1.0 / quanta.length_squared),
            (Constant::MeanVolume, Voronoi::mean_volume(self.model)),
        ];
        self.plan.report.push(observe);
    }

    /// The sampler of the observables.
    pub(super) fn observables(&mut self) {
        let quantities = self.quantities();
        let groups = self.groups(self.particles);
        self.plan.sample_observables(self.measured.every, quantities, groups);
    }

    /// The cells of a report, where an analysis needs them.
    pub(super) fn reported(&mut self) -> Option<Reported> {
        if !self.measured.needs(Need::Particles) {
            return None;
        }
        self.plan.add_buffer(Array::Reported, 32 * self.particles);
        Some(Reported { choices: plane(), particles: Array::Reported, momenta: None, forces: Array::ReportedForces })
    }
}
