//! What is measured of the cells, and the analyses of them by their numbers.

use super::{Builder, SPACE};
use crate::plan::analyses;
use crate::scene::Output;

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
        let mut modules = self.cell().to_vec();
        modules.extend(["common/face", "common/sum64", "common/sum64_signed", "common/reduce", "common/totals"]);
        modules.push(match (self.cells.keeps_energy(), self.cells.exchanges_mass()) {
            (true, _) => "common/report_energy",
            (false, false) => "common/report_isothermal",
            (false, true) => "common/report_gas_off",
        });
        modules.extend(match (self.solves(), self.has_limits()) {
            (true, _) => &["common/report_solver", "common/solver"][..],
            (false, true) => &["common/report_limits"],
            (false, false) => &["common/report_nothing"],
        });
        modules.push(if analysed(output) { "common/note_by_id" } else { "common/note_nowhere" });
        modules.push("kernels/observe_cells");
        let groups = self.groups(self.particles);
        let observe = self.kernel("observe", &modules, groups);
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
            space: SPACE.to_vec(),
            masses: vec!["common/own_mass"],
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
