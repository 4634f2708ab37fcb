//! Baths without memory on single particles, in the O of a split step: a kernel between the two passes over pairs.

use super::{Builder, Masks};
use crate::families::particles::plan::position_bath;
use crate::plan::Traversal;
use crate::shaders::{Choices, Constant, pairs};

impl Builder<'_> {
    /// The kernel that relaxes the momenta of particles, if they have a bath; it leaves its part of the forces where an
    /// analysis needs them.
    pub(super) fn relax_particles(&mut self) -> Vec<usize> {
        if !self.relaxes_particles() {
            return Vec::new();
        }
        let pass = Choices::new().with(pairs::Pass::RelaxParticles);
        self.plan.operations_per_particle += 60.0;
        let kernel = self.traversal("relax_particles", Traversal::Alone, Masks::Unkept, &pass);
        self.adds_forces(kernel, self.reports_own_forces());
        vec![kernel]
    }

    /// The constants of that kernel; where there is a table, the rest of them are its entries.
    pub(super) fn particle_constants(&mut self) {
        if !self.relaxes_particles() {
            return;
        }
        self.plan.constants.extend(position_bath::stream(self.model));
        if !self.species.have_table() {
            let [loss, deviation] = self.relaxation(0);
            self.plan.constants.extend([(Constant::PositionResponse, loss), (Constant::PositionNoise, deviation)]);
        }
    }

    /// The entries of a table of coefficients, one for each species.
    pub(super) fn particle_entries(&self) -> Vec<f32> {
        let entry = |species| {
            let [loss, deviation] = self.relaxation(species);
            [loss as f32, deviation as f32, 0.0, 0.0]
        };
        (0..self.model.species.len()).flat_map(entry).collect()
    }

    /// What the momentum of a particle of a species loses in a step, as a part of it, and the standard deviation of
    /// what it gains, in momentum units: 1 - c and √(m kT (1 - c²)), c = exp(-γdt/m); zeros of one that is not there.
    fn relaxation(&self, species: usize) -> [f64; 2] {
        let Some(bath) = self.model.particles().position_bath.as_ref() else { return [0.0; 2] };
        let Some(mass) = self.model.species.get(species).map(|species| species.mass) else { return [0.0; 2] };
        // λₑ = 2γ/dt
        let exponent = 0.5 * bath.steps[species].coupling * self.model.time_step.powi(2) / mass;
        let variance = -mass * bath.temperature * (-2.0 * exponent).exp_m1();
        [-(-exponent).exp_m1(), variance.sqrt() / self.model.units.momentum]
    }
}
