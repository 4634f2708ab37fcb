//! Langevin friction on the device: a part of the kicks of a step, and in split steps without memory a kernel between
//! the two passes over pairs.

use super::PositionBath;
use crate::families::Model;
use crate::families::particles::plan::bonded::Scales;
use crate::families::particles::plan::step::{Builder, Masks};
use crate::families::particles::terms::PlannedTerm;
use crate::noise::{self, stream};
use crate::plan::{Plan, Traversal, switch};
use crate::shaders::{Choices, Constant, pairs};

/// The baths on coordinates, if steps do not relax momenta by themselves.
pub(crate) fn bath(model: &Model) -> Option<&PositionBath> {
    let particles = model.particles();
    particles.position_bath.as_ref().filter(|_| !particles.relaxes_particles())
}

/// True if baths on coordinates have memory.
pub(crate) fn remembers(model: &Model) -> bool {
    bath(model).is_some_and(|bath| bath.memory)
}

/// The bath of a species as kernels know it: its response to a drift, its noise of one step, and its energy per square,
/// which is zero of those that a report does not count; zeros of a species that is not there.
pub(crate) fn coefficients(scales: &Scales<'_>, species: usize) -> [f64; 3] {
    let Some(bath) = bath(scales.model) else { return [0.0; 3] };
    let Some(step) = bath.steps.get(species) else { return [0.0; 3] };
    let counts = bath.memory && step.continuous_coupling > 0.0;
    let energy = if counts { 0.5 / step.continuous_coupling } else { 0.0 };
    [step.response(), step.noise(bath.temperature), energy / scales.quanta.pair_energy]
}

/// The key of the random numbers over all steps, and whether any are drawn.
fn stream(model: &Model) -> [(Constant, f64); 3] {
    let key = noise::seed_key(model.seed, stream::PARTICLE);
    let noisy = model.particles().position_bath.as_ref().is_some_and(|bath| bath.temperature > 0.0);
    [
        switch(Constant::PositionBathsNoisy, noisy),
        (Constant::ParticleStreamX, f64::from(key[0])),
        (Constant::ParticleStreamY, f64::from(key[1])),
    ]
}

/// One over a quantum; nothing of one that is not there.
pub(crate) fn inverse(quantum: f64) -> f64 {
    if quantum > 0.0 { 1.0 / quantum } else { 0.0 }
}

impl PlannedTerm for PositionBath {
    fn add_constants(&self, scales: &Scales<'_>, plan: &mut Plan) {
        let model = scales.model;
        plan.constants.push(switch(Constant::SeesFlow, self.peculiar));
        if model.particles().relaxes_particles() {
            return;
        }
        scales.add_bath_impulse(plan);
        plan.constants.extend([
            (Constant::PositionBaths, if self.memory { 2.0 } else { 1.0 }),
            (Constant::PositionLoss, self.steps.first().map_or(1.0, |step| 1.0 - step.persistence)),
        ]);
        plan.constants.extend(stream(model));
        if !scales.species.have_table() {
            let [response, noise, energy] = coefficients(scales, 0);
            plan.constants.extend([
                (Constant::PositionResponse, response),
                (Constant::PositionNoise, noise),
                (Constant::PositionEnergy, energy),
            ]);
        }
        if model.particles().oscillates_in_memory() {
            let (units, quanta) = (model.units, scales.quanta.bath_products);
            plan.constants.extend([
                (Constant::Oscillates, 1.0),
                (Constant::BathMomentum, inverse(quanta.momentum) * units.momentum),
                (Constant::BathDisplacement, inverse(quanta.displacement)),
                (Constant::MomentumDisplacement, inverse(quanta.momentum_displacement) * units.momentum),
            ]);
        }
    }
}

impl Builder<'_> {
    /// The kernel that relaxes the momenta of particles, if they have a bath; it leaves its part of the forces where an
    /// analysis needs them.
    pub(crate) fn relax_particles(&mut self) -> Vec<usize> {
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
    pub(crate) fn particle_constants(&mut self) {
        if !self.relaxes_particles() {
            return;
        }
        self.plan.constants.extend(stream(self.model));
        if !self.species.have_table() {
            let [loss, deviation] = self.relaxation(0);
            self.plan.constants.extend([(Constant::PositionResponse, loss), (Constant::PositionNoise, deviation)]);
        }
    }

    /// The entries of a table of coefficients, one for each species.
    pub(crate) fn particle_entries(&self) -> Vec<f32> {
        let entry = |species| {
            let [loss, deviation] = self.relaxation(species);
            [loss as f32, deviation as f32, 0.0, 0.0]
        };
        (0..self.model.species.len()).flat_map(entry).collect()
    }

    /// The part of the momentum that a particle of a species loses in a step, and the standard deviation of
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
