//! How shallow water starts: masses from the depth, velocities in balance or thermal, variables of the bath.

use super::carried;
use crate::document::{Generator, ParticleGroup, Velocities};
use crate::families::{Checked, Model, ShallowWater, start};
use crate::noise::{self, stream};
use crate::state::State;
use std::ops::Range;

/// Gives the particles of a group masses and velocities; thermal ones follow when all masses are known.
pub(super) fn set_in_motion(
    water: &ShallowWater,
    state: &mut State,
    group: &ParticleGroup,
    ids: Range<usize>,
    model: &Model,
) {
    fill(state, group, ids.start, model, water);
    match &group.velocities {
        Velocities::Thermal => state.momenta.resize(ids.end, [0; 3]),
        Velocities::Geostrophic if !group.fixed => {
            let first = ids.start;
            let to_units = |velocity: f64| (velocity / model.units.momentum).round_ties_even() as i32;
            let surface = water.surface([model.units.lengths[0], model.units.lengths[1]]);
            let factor = water.wave_speed * water.wave_speed / water.rotation;
            let balanced = state.positions[first..].iter().map(|position| {
                let [x, y, _] = model.units.position(*position);
                let [slope_x, slope_y] = surface.slope([x, y]);
                [to_units(-factor * slope_y), to_units(factor * slope_x), 0]
            });
            state.momenta.extend(balanced);
        }
        _ => start::set_in_motion(state, group, ids, model),
    }
}

/// Completes the state, once all particles are there.
pub(super) fn complete(water: &ShallowWater, state: &mut State, scene: &Checked, thermal: &[Range<usize>]) {
    let model = scene.model();
    match scene.fields_of_start() {
        Some(fields) => carried::carry(water, state, fields, model),
        None => set_mean_depth(&mut state.masses[..water.carriers as usize], water),
    }
    draw_thermal_velocities(state, thermal, model, water);
    draw_bath(state, model, water);
}

/// Gives the particles of a group masses in proportion to the depth where they are; tracers have none.
fn fill(state: &mut State, group: &ParticleGroup, first: usize, model: &Model, water: &ShallowWater) {
    let surface = water.surface([model.units.lengths[0], model.units.lengths[1]]);
    let mean = water.nodes() as f64 / water.carriers.max(1) as f64 / water.mass_unit;
    let masses = state.positions[first..].iter().map(|position| {
        if group.tracer {
            return 0;
        }
        let [x, y, _] = model.units.position(*position);
        let depth = surface.unsmoothed([x, y], water.smoothing.length, water.smoothing.power);
        (mean * depth).round_ties_even() as u32
    });
    state.masses.extend(masses);
}

/// Scales the masses so that they add up to 1 a node, to the last unit.
pub(super) fn set_mean_depth(masses: &mut [u32], water: &ShallowWater) {
    let wanted = water.total_mass();
    let sum: u64 = masses.iter().map(|mass| u64::from(*mass)).sum();
    if sum == 0 {
        return;
    }
    let scale = wanted as f64 / sum as f64;
    let mut left = wanted as i64;
    for mass in masses.iter_mut() {
        *mass = (f64::from(*mass) * scale).round_ties_even() as u32;
        left -= i64::from(*mass);
    }
    // What rounding has left over is at most half a unit a particle.
    let heavy = masses.iter_mut().filter(|mass| **mass > 0);
    for mass in heavy.take(left.unsigned_abs() as usize) {
        *mass = mass.saturating_add_signed(left.signum() as i32);
    }
}

/// Maxwell's distribution of velocities for particles of different masses. The mesh takes momentum anyway, so that the
/// centre of mass need not be at rest.
fn draw_thermal_velocities(state: &mut State, thermal: &[Range<usize>], model: &Model, water: &ShallowWater) {
    let key = noise::step_key(model.seed, stream::VELOCITY, 0);
    for particle in thermal.iter().cloned().flatten() {
        if state.masses[particle] == 0 {
            continue;
        }
        let width = (model.temperature / (f64::from(state.masses[particle]) * water.mass_unit)).sqrt();
        for axis in 0..2 {
            let words = noise::words(Generator::Threefry2x32, key, [particle as u32, axis as u32]);
            let velocity = width * noise::gaussian(words);
            state.momenta[particle][axis] = (velocity / model.units.momentum).round_ties_even() as i32;
        }
    }
}

/// Draws the bath variables of all nodes from their law at rest.
fn draw_bath(state: &mut State, model: &Model, water: &ShallowWater) {
    let Some(bath) = &water.bath else { return };
    let key = noise::step_key(model.seed, stream::MESH, 0);
    let width = bath.deviation(model.temperature) / water.wave_speed;
    let nodes = 0..water.nodes() as u32;
    let draw = |node| (width * noise::gaussian(noise::words(model.generator, key, [0, node]))) as f32;
    state.node_bath = nodes.map(|node| draw(node).to_bits()).collect();
}
