//! Sums over particles and pairs at the report point.

use super::configuration::of_configuration;
use super::held;
use super::pairs::close_pairs;
use super::{Reference, Report};
use crate::families::particles::space::shear::reference::{self as shear, Images};
use crate::families::particles::space::walls::reference as walls;
use crate::families::particles::terms::{body_forces, tethers};
use crate::families::{BathProducts, Model, Observables};
use crate::state::State;
use std::f64::consts::TAU;

/// What is observed of the motion: momenta p(n) of particles of some masses. The configuration is left at zero.
pub(super) fn of_motion(model: &Model, state: &State, masses: &[f64], momenta: &[[i64; 3]]) -> Observables {
    let mut total = [0_i64; 3];
    let mut kinetic_energy = 0.0;
    for (particle, (momentum, mass)) in momenta.iter().zip(masses).enumerate() {
        if held::is_held(model, state, particle) {
            continue;
        }
        let flow = [shear::flow(model, state, particle), 0.0, 0.0];
        for axis in 0..3 {
            total[axis] += momentum[axis];
            let peculiar = momentum[axis] as f64 - flow[axis];
            kinetic_energy += (peculiar * model.units.momentum).powi(2) / (2.0 * mass);
        }
    }
    Observables {
        mass: (0..state.len()).filter(|id| !held::is_frozen(model, state, *id)).map(|id| masses[id]).sum(),
        kinetic_energy,
        momentum: total.map(|units| units as f64 * model.units.momentum),
        from_body_forces: body_forces::reference::transfer(model, state, masses),
        on_walls: walls::on_walls(model, state, momenta),
        ..Observables::zero(model, state)
    }
}

/// All observables of the report point, with the configuration of a state some halves of a step after the step began.
pub(super) fn observe(reference: &Reference, configuration: &State, halves: u64, report: &Report) -> Observables {
    let (model, state) = (&reference.model, &reference.state);
    let motion = of_motion(model, state, &reference.masses, &report.momenta);
    let images = Images::after(model, model.clock(state.step).wrapping_mul(2).wrapping_add(halves));
    let baths = report.bath_sums;
    let motion = Observables {
        total_virial: report.virials.total,
        bath_energy: baths.energy,
        bath_square: if baths.count == 0 { 0.0 } else { baths.squares / baths.count as f64 },
        bath_products: products(reference, report),
        ..motion
    };
    of_configuration(model, configuration, &images, &motion)
}

/// Mean products of oscillators with their baths.
fn products(reference: &Reference, report: &Report) -> BathProducts {
    let (model, state) = (&reference.model, &reference.state);
    let bath = model.particles().position_bath.as_ref().filter(|_| model.particles().oscillates_in_memory());
    let Some(bath) = bath else { return BathProducts::default() };
    let (mut sums, mut count) = (BathProducts::default(), 0_u64);
    for particle in (0..state.len()).filter(|particle| !held::is_held(model, state, *particle)) {
        if bath.steps[state.species[particle] as usize].continuous_coupling == 0.0 {
            continue;
        }
        let displacement = tethers::reference::displacement(model, state, particle);
        for axis in 0..model.units.dimension {
            let value = f64::from(f32::from_bits(report.baths.position_baths[particle][axis]));
            let momentum = report.momenta[particle][axis] as f64 * model.units.momentum;
            sums.momentum += value * momentum;
            sums.displacement += value * displacement[axis];
            sums.momentum_displacement += momentum * displacement[axis];
            count += 1;
        }
    }
    let mean = |sum: f64| sum / count.max(1) as f64;
    BathProducts {
        momentum: mean(sums.momentum),
        displacement: mean(sums.displacement),
        momentum_displacement: mean(sums.momentum_displacement),
    }
}

/// Σ cos q·r and Σ sin q·r over the particles of a species, or all that are not frozen, for so many waves along each axis of the box.
pub(super) fn density_wave(reference: &Reference, waves: [i32; 3], species: Option<usize>) -> [f64; 2] {
    let (model, state) = (&reference.model, &reference.state);
    let mut sums = [0.0; 2];
    for (position, of) in state.positions.iter().zip(&state.species) {
        let of = *of as usize;
        if model.species[of].frozen || species.is_some_and(|asked| asked != of) {
            continue;
        }
        // Whole turns count for nothing.
        let turns =
            (0..3).fold(0_u32, |turns, axis| turns.wrapping_add(position[axis].wrapping_mul(waves[axis] as u32)));
        let (sine, cosine) = (TAU * f64::from(turns) / 2_f64.powi(32)).sin_cos();
        sums = [sums[0] + cosine, sums[1] + sine];
    }
    sums
}

/// Counts of unordered pairs in `bins` equal bins of distance up to `range`, of two species or of all.
pub(super) fn radial_distribution(
    reference: &Reference,
    range: f64,
    bins: usize,
    species: Option<[usize; 2]>,
) -> Vec<u64> {
    let mut counts = vec![0; bins];
    let (model, state) = (&reference.model, &reference.state);
    // Frozen particles are not counted.
    let frozen = |id: usize| model.species[state.species[id] as usize].frozen;
    close_pairs(model, state.step, &state.positions, range, &mut |pair| {
        let [a, b] = [pair.first, pair.second].map(|id| state.species[id] as usize);
        let is_asked = species.is_none_or(|asked| asked == [a, b] || asked == [b, a]);
        if !is_asked || frozen(pair.first) || frozen(pair.second) {
            return;
        }
        // Rounding may carry a distance just under the range to the end of the last bin.
        let bin = (pair.distance / range * bins as f64) as usize;
        if let Some(count) = counts.get_mut(bin) {
            *count += 1;
        }
    });
    counts
}
