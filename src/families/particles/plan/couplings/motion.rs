//! The end of a step for every particle: baths on its coordinates, half kicks, drift.

use super::Builder;
use crate::noise::{self, stream};
use crate::scene::{Generator, Output};

impl Builder<'_> {
    pub(super) fn motion(&mut self, output: &Output) {
        let groups = self.groups(self.particles);
        self.position_constants();
        let mut modules = [self.species.coefficients(), &["common/drift"]].concat();
        modules.push(if self.model.has_fixed_particles() { "common/fixed_on" } else { "common/fixed_off" });
        modules.extend(self.position_modules());
        modules.extend(self.hold_modules());
        // Both may need it.
        let needs_threefry = self.noisy_positions()
            || self.model.coloured_noise().is_some() && self.model.generator == Generator::Threefry2x32;
        if needs_threefry {
            modules.push("common/threefry");
        }
        if self.noisy_positions() || self.model.coloured_noise().is_some() {
            modules.push("common/elementary");
            modules.extend(self.words());
        }
        let anchors = if self.model.pair_force().is_some() { "common/anchors_on" } else { "common/anchors_off" };
        let advance = self.kernel("move", &[&modules[..], &[anchors, "kernels/move"]].concat(), groups);
        self.plan.advance.push(advance);
        let memory = self.model.position_bath().is_some_and(|bath| bath.memory);
        let seen = if memory { "common/position_seen" } else { "common/position_unseen" };
        let forces = self.reported_forces(output);
        // Masses, baths, a random force and an analysis of forces at once are one buffer too many.
        let optional =
            [self.species.have_table(), memory, self.model.coloured_noise().is_some(), forces == "common/force_on"];
        self.plan.storage_buffers = (5 + optional.into_iter().filter(|bound| *bound).count() as u32).max(8);
        let report = [&modules[..], &[seen, forces, "kernels/observe"]].concat();
        self.report_kernel("observe", &report, groups);
        if self.model.has_potential() {
            self.plan.add_buffer(
                "forces",
                "impulses of half a step by conservative forces, at a report",
                16 * self.particles,
            );
            self.report_kernel("square_forces", &["kernels/square_forces"], groups);
        }
        self.plan.operations_per_particle += 60.0;
    }

    fn noisy_positions(&self) -> bool {
        self.model.position_bath().is_some_and(|bath| bath.temperature > 0.0)
    }

    fn position_modules(&self) -> Vec<&'static str> {
        let Some(bath) = self.model.position_bath() else {
            return vec!["common/position_off", "common/position_noise_off"];
        };
        let mut modules = vec![if bath.memory { "common/position_memory" } else { "common/position_white" }];
        modules.push(if self.species.have_table() {
            "common/position_coefficients_table"
        } else {
            "common/position_coefficients_single"
        });
        if self.noisy_positions() {
            modules.push("common/gaussian");
            modules.push(match self.model.units.dimension {
                1 => "common/position_noise1",
                2 => "common/position_noise2",
                _ => "common/position_noise3",
            });
        } else {
            modules.push("common/position_noise_off");
        }
        modules
    }

    /// What a kernel needs of a species' position bath: response of the bath to a drift, its noise of one step, its energy
    /// per square.
    pub(super) fn position_coefficients(&self, species: usize) -> [f64; 3] {
        let Some(bath) = self.model.position_bath() else { return [0.0; 3] };
        let step = bath.steps[species];
        let energy = if bath.memory && step.continuous_coupling > 0.0 { 0.5 / step.continuous_coupling } else { 0.0 };
        [step.response(), step.noise(bath.temperature), energy / self.plan.quanta.pair_energy]
    }

    fn position_constants(&mut self) {
        let Some(bath) = self.model.position_bath() else { return };
        let loss = bath.steps.first().map_or(1.0, |step| 1.0 - step.persistence);
        let memory = bath.memory;
        let key = noise::seed_key(self.model.seed, stream::PARTICLE);
        self.plan.constants.extend([
            ("POSITION_IMPULSE", self.impulse()),
            ("POSITION_LOSS", loss),
            ("PARTICLE_STREAM_X", f64::from(key[0])),
            ("PARTICLE_STREAM_Y", f64::from(key[1])),
        ]);
        if !self.species.have_table() && !self.model.species.is_empty() {
            let [response, noise, energy] = self.position_coefficients(0);
            self.plan.constants.extend([
                ("POSITION_RESPONSE", response),
                ("POSITION_NOISE", noise),
                ("POSITION_ENERGY", energy),
            ]);
        }
        if memory {
            self.plan.add_buffer("position_baths", "bath of each coordinate, by number", 16 * self.particles);
        }
    }
}
