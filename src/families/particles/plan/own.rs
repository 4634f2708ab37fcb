//! Baths on coordinates of particles, and a random force on them that is constant for random times, as parts of the
//! kicks of a step; baths without memory in split steps are none.

use super::bonded::Scales;
use super::position_bath;
use crate::document::NoiseProcess;
use crate::families::{Model, PositionBath};
use crate::noise::{self, stream};
use crate::plan::{Plan, switch};
use crate::shaders::{Array, Constant};

/// Largest time that a constant takes, in half steps: above it every force outlasts any run.
const LONGEST_TIME: f64 = 1e30;

/// The baths on coordinates, if steps do not relax momenta by themselves.
fn bath(model: &Model) -> Option<&PositionBath> {
    let particles = model.particles();
    particles.position_bath.as_ref().filter(|_| !particles.relaxes_particles(model))
}

/// Whether there are baths on coordinates.
pub(super) fn bathes(model: &Model) -> bool {
    bath(model).is_some()
}

/// Whether baths on coordinates have memory.
pub(super) fn remembers(model: &Model) -> bool {
    bath(model).is_some_and(|bath| bath.memory)
}

/// Whether anything acts.
pub(super) fn acts(model: &Model) -> bool {
    model.particles().acts_on_particles(model)
}

/// Baths on coordinates see velocities relative to the mean flow.
fn sees_flow(model: &Model) -> bool {
    model.particles().position_bath.as_ref().is_some_and(|bath| bath.peculiar)
}

/// The constants that say which of them act.
pub(super) fn switches(model: &Model) -> [(Constant, f64); 5] {
    let baths = match bath(model) {
        None => 0.0,
        Some(bath) if !bath.memory => 1.0,
        Some(_) => 2.0,
    };
    [
        switch(Constant::OwnActs, acts(model)),
        (Constant::PositionBaths, baths),
        switch(Constant::ColouredNoise, model.particles().coloured_noise.is_some()),
        switch(Constant::SeesFlow, sees_flow(model)),
        switch(Constant::Oscillates, model.particles().oscillates_in_memory()),
    ]
}

/// Buffers that the kernel at the end of a step binds for them.
pub(super) fn buffers(model: &Model) -> u32 {
    u32::from(remembers(model)) + u32::from(model.particles().coloured_noise.is_some())
}

/// The bath of a species as kernels know it: its response to a drift, its noise of one step, and its energy per square,
/// which is zero of those that a report does not count; zeros of a species that is not there.
pub(super) fn coefficients(scales: &Scales<'_>, species: usize) -> [f64; 3] {
    let Some(bath) = bath(scales.model) else { return [0.0; 3] };
    let Some(step) = bath.steps.get(species) else { return [0.0; 3] };
    let counts = bath.memory && step.continuous_coupling > 0.0;
    let energy = if counts { 0.5 / step.continuous_coupling } else { 0.0 };
    [step.response(), step.noise(bath.temperature), energy / scales.quanta.pair_energy]
}

/// Adds constants and the state between steps.
pub(super) fn add(scales: &Scales<'_>, plan: &mut Plan) {
    add_bath(scales, plan);
    add_noise(scales, plan);
}

fn add_bath(scales: &Scales<'_>, plan: &mut Plan) {
    let model = scales.model;
    let Some(bath) = bath(model) else { return };
    let loss = bath.steps.first().map_or(1.0, |step| 1.0 - step.persistence);
    scales.add_bath_impulse(plan);
    plan.constants.push((Constant::PositionLoss, loss));
    plan.constants.extend(position_bath::stream(model));
    if !scales.species.have_table() {
        let [response, noise, energy] = coefficients(scales, 0);
        plan.constants.extend([
            (Constant::PositionResponse, response),
            (Constant::PositionNoise, noise),
            (Constant::PositionEnergy, energy),
        ]);
    }
    if bath.memory {
        plan.add_buffer(Array::PositionBaths, 16 * model.particle_count());
    }
    if model.particles().oscillates_in_memory() {
        let (units, quanta) = (model.units, scales.quanta.bath_products);
        plan.constants.extend([
            (Constant::BathMomentum, inverse(quanta.momentum) * units.momentum),
            (Constant::BathDisplacement, inverse(quanta.displacement)),
            (Constant::MomentumDisplacement, inverse(quanta.momentum_displacement) * units.momentum),
        ]);
    }
}

fn add_noise(scales: &Scales<'_>, plan: &mut Plan) {
    let model = scales.model;
    let Some(noise) = model.particles().coloured_noise.as_ref() else { return };
    let half_step = 0.5 * model.time_step;
    let key = noise::seed_key(model.seed, stream::JUMP);
    let process = match noise.process {
        NoiseProcess::Kangaroo => 0.0,
        NoiseProcess::KangarooExponential => 1.0,
        NoiseProcess::Short => 2.0,
        NoiseProcess::Literal => 3.0,
    };
    plan.constants.extend([
        (Constant::HoldProcess, process),
        (Constant::HoldImpulse, scales.impulse()),
        (Constant::HoldForce, noise.strength.sqrt()),
        (Constant::HoldTime, (noise.time / half_step).min(LONGEST_TIME)),
        (Constant::JumpStreamX, f64::from(key[0])),
        (Constant::JumpStreamY, f64::from(key[1])),
    ]);
    if noise.process == NoiseProcess::Literal {
        plan.constants.push((Constant::HoldTurns, 1.0 / (std::f64::consts::TAU * noise.time.sqrt())));
    }
    // Words and jumps of the particles whose force ends in a step are few unless forces are short.
    let jumps = model.time_step / noise.time;
    let bytes = size_of::<crate::state::Hold>() as u64;
    plan.add_buffer(Array::Holds, bytes * model.particle_count());
    plan.operations_per_particle += 30.0 + 120.0 * jumps;
}

/// One over a quantum; nothing of one that is not there.
pub(super) fn inverse(quantum: f64) -> f64 {
    if quantum > 0.0 { 1.0 / quantum } else { 0.0 }
}
