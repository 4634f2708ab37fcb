//! The end of a step for every particle: baths on its coordinates, half kicks, drift.

use super::Builder;
use crate::families::particles::plan::{position_bath, walls};
use crate::families::particles::sums::sums;
use crate::shaders::{Array, Choices, Constant, Entry, baths, couplings};

impl Builder<'_> {
    pub(super) fn motion(&mut self) {
        let groups = self.groups(self.particles);
        self.position_constants();
        let choices = self.position_bath().and(&self.held_noise());
        let anchored =
            choices.clone().with_if(self.visits_pairs(), couplings::Anchors::Kept).and(&walls::booking(self.model));
        let advance = self.kernel("move", Entry::MoveParticles, &anchored, groups);
        self.plan.advance.push(advance);
        let memory = self.model.particles().position_bath.as_ref().is_some_and(|bath| bath.memory);
        let forces = self.reported_forces();
        let products = self.model.particles().oscillates_in_memory();
        // Masses, baths, tethers, a random force, walls and an analysis of forces at once are two buffers too many.
        let optional = [
            self.species.have_table(),
            memory,
            products,
            self.model.particles().coloured_noise.is_some(),
            walls::count(self.model) > 0,
            forces.is_some(),
        ];
        let bound = 5 + optional.into_iter().filter(|bound| *bound).count() as u32;
        self.plan.storage_buffers = self.plan.storage_buffers.max(bound);
        let report = choices
            .with_if(memory, baths::PositionReport::Observed)
            .with_if(products, baths::PositionProducts::Tethered)
            .with_any(forces);
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

    /// The bath on coordinates, if there is one.
    fn position_bath(&self) -> Choices {
        let Some(bath) = self.model.particles().position_bath.as_ref() else { return Choices::new() };
        Choices::new()
            .with(if bath.memory { baths::Positions::Memory } else { baths::Positions::White })
            .with_if(bath.temperature > 0.0, baths::PositionNoise::Gaussian)
    }

    /// What a kernel needs of a species' position bath: response of the bath to a drift, its noise of one step, its energy
    /// per square, which is zero of those that a report does not count; zeros of a species that is not there.
    pub(super) fn position_coefficients(&self, species: usize) -> [f64; 3] {
        let Some(bath) = self.model.particles().position_bath.as_ref() else { return [0.0; 3] };
        let Some(step) = bath.steps.get(species) else { return [0.0; 3] };
        let counts = bath.memory && step.continuous_coupling > 0.0;
        let energy = if counts { 0.5 / step.continuous_coupling } else { 0.0 };
        [step.response(), step.noise(bath.temperature), energy / self.plan.quanta.pair_energy]
    }

    fn position_constants(&mut self) {
        let Some(bath) = self.model.particles().position_bath.as_ref() else { return };
        let loss = bath.steps.first().map_or(1.0, |step| 1.0 - step.persistence);
        let memory = bath.memory;
        self.bath_impulse();
        self.plan.constants.push((Constant::PositionLoss, loss));
        self.plan.constants.extend(position_bath::stream(self.model));
        if !self.species.have_table() {
            let [response, noise, energy] = self.position_coefficients(0);
            self.plan.constants.extend([
                (Constant::PositionResponse, response),
                (Constant::PositionNoise, noise),
                (Constant::PositionEnergy, energy),
            ]);
        }
        if memory {
            self.plan.add_buffer(Array::PositionBaths, 16 * self.particles);
        }
        if self.model.particles().oscillates_in_memory() {
            let (units, quanta) = (self.model.units, self.plan.quanta.bath_products);
            self.plan.constants.extend([
                (Constant::BathMomentum, inverse(quanta.momentum) * units.momentum),
                (Constant::BathDisplacement, inverse(quanta.displacement)),
                (Constant::MomentumDisplacement, inverse(quanta.momentum_displacement) * units.momentum),
            ]);
        }
    }
}

/// One over a quantum; nothing of one that is not there.
pub(super) fn inverse(quantum: f64) -> f64 {
    if quantum > 0.0 { 1.0 / quantum } else { 0.0 }
}
