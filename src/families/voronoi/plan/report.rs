//! What is measured of the cells, and the analyses of them by their numbers.

use super::{Builder, plane};
use crate::plan::analyses;
use crate::scene::Output;
use crate::shaders::{Choices, Entry, voronoi};

/// Sums of a report, in order: kinetic energy, two components of momentum, mass, volume, sides of faces; then free energy,
/// or internal energy, total energy and temperature; then exchanges that a limit has cut; then iterations and residual.
const OF_MOTION: u64 = 6;
const OF_GAS: u64 = 3;
const OF_LIMITS: u64 = 1;
const OF_SOLVER: u64 = 2;

impl Builder<'_> {
    /// Whether the velocities after friction are solved for.
    fn solves(&self) -> bool {
        self.rubs() && !self.is_explicit()
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
    pub(super) fn report(&mut self, output: &Output) {
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
            .with_if(analysed(output), voronoi::Note::ById);
        let groups = self.groups(self.particles);
        let observe = self.kernel("observe", Entry::ObserveCells, &choices, groups);
        let quanta = self.plan.quanta;
        self.plan.kernels[observe].constants = vec![
            ("QUANTITIES", self.quantities() as f64),
            ("FIRST_GROUP", 0.0),
            ("KINETIC", 1.0 / quanta.energy),
            ("VOLUME_STEPS", 1.0 / quanta.length_squared),
            ("MEAN_VOLUME", super::mean_volume(self.model)),
        ];
        self.plan.report.push(observe);
    }

    /// The sampler of the observables.
    pub(super) fn observables(&mut self, output: &Output) {
        let quantities = self.quantities();
        let groups = self.groups(self.particles);
        self.plan.sample_observables(output.energies.every, quantities, groups);
    }

    /// What a scene asks for about cells by their numbers.
    pub(super) fn analyses(&mut self, output: &Output) {
        if !analysed(output) {
            return;
        }
        self.plan.add_buffer("reported", "cells of the last report by number", 32 * self.particles);
        let reported = analyses::Reported {
            model: self.model,
            equilibration: self.equilibration,
            workgroup: self.options.workgroup(),
            choices: plane(),
            particles: "reported",
            momenta: None,
            forces: "reported_forces",
            force_unit: 0.0,
        };
        analyses::add(&mut self.plan, &reported, output);
    }
}

/// Whether a scene has an analysis of reported particles.
fn analysed(output: &Output) -> bool {
    output.diffusion.is_some()
        || output.viscosity.is_some()
        || !output.autocorrelations.is_empty()
        || !output.histograms.is_empty()
}
