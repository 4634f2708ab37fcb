//! Where the particles of a scene start, and how fast.

use super::{Generator, ParticleGroup, Placement, Scene, Velocities};
use crate::model::Model;
use crate::noise::{self, stream};
use crate::state::State;

/// The state at step 0 of a scene: particles numbered group by group, each group in its own order.
///
/// `scene` has been checked and `model` was made from it. The words of random placements and velocities depend on
/// the seed and the particle's number only, and always come from Threefry: what is drawn once may cost a little more.
/// The net momentum of all thermal groups together is zero to the last bit, so a single thermal particle is at rest.
#[must_use]
pub fn initial_state(scene: &Scene, model: &Model) -> State {
    let mut state = State::default();
    let mut thermal = Vec::new();
    let lattices = scene.particles.iter().filter(|group| group.placement == Placement::Lattice).count();
    let mut lattice = 0;
    for group in &scene.particles {
        let first = state.len();
        let count = group.resolved_count(scene.space.volume()) as usize;
        place(&mut state, group, count, model, lattice as f64 / lattices.max(1) as f64);
        lattice += usize::from(group.placement == Placement::Lattice);
        set_in_motion(&mut state, group, count, model);
        let species = model.species.iter().position(|species| species.name == group.species).unwrap_or(0);
        state.species.resize(first + count, species as u32);
        if group.velocities == Velocities::Thermal {
            thermal.extend(first..first + count);
        }
    }
    bring_to_rest(&mut state, &thermal, model);
    state
}

/// Appends the positions of a group; `shift` moves a lattice by this fraction of its spacing, so that the lattices of
/// several groups do not fall on each other.
fn place(state: &mut State, group: &ParticleGroup, count: usize, model: &Model, shift: f64) {
    let dimension = model.units.dimension;
    let first = state.len();
    match &group.placement {
        Placement::Random => {
            let key = noise::step_key(model.seed, stream::POSITION, 0);
            state.positions.extend((first..first + count).map(|id| {
                let [x, y] = noise::words(Generator::Threefry2x32, key, [id as u32, 0]);
                let [z, _] = noise::words(Generator::Threefry2x32, key, [id as u32, 1]);
                if dimension == 3 { [x, y, z] } else { [x, y, 0] }
            }));
        }
        Placement::Lattice => {
            let sites = lattice_sites(count as u64, &model.units.lengths[..dimension]);
            let all: u128 = sites.iter().map(|sites| u128::from(*sites)).product();
            let offset = (0.5 + shift).fract();
            state.positions.extend((0..count).map(|index| {
                // Sites left empty are spread over the lattice instead of collecting at its end.
                let mut site = index as u128 * all / count as u128;
                std::array::from_fn(|axis| {
                    if axis >= dimension {
                        return 0;
                    }
                    let coordinate = (site % u128::from(sites[axis])) as f64;
                    site /= u128::from(sites[axis]);
                    ((coordinate + offset) / sites[axis] as f64 * 4_294_967_296.0).round() as u64 as u32
                })
            }));
        }
        Placement::Listed { positions } => {
            state.positions.extend(positions.iter().map(|position| {
                let position = std::array::from_fn(|axis| position.get(axis).copied().unwrap_or(0.0));
                model.units.fraction(position)
            }));
        }
    }
}

/// The numbers of lattice sites along each axis: the axis with the widest spacing is refined until all fit.
fn lattice_sites(count: u64, lengths: &[f64]) -> [u64; 3] {
    let mut sites = [1_u64; 3];
    while sites.iter().map(|sites| u128::from(*sites)).product::<u128>() < u128::from(count) {
        let mut widest = 0;
        for axis in 1..lengths.len() {
            if lengths[axis] / sites[axis] as f64 > lengths[widest] / sites[widest] as f64 {
                widest = axis;
            }
        }
        sites[widest] += 1;
    }
    sites
}

/// Appends the momenta of a group, rounded to integer units.
fn set_in_motion(state: &mut State, group: &ParticleGroup, count: usize, model: &Model) {
    let dimension = model.units.dimension;
    let first = state.momenta.len();
    let to_units = |momentum: f64| (momentum / model.units.momentum).round_ties_even() as i32;
    match &group.velocities {
        Velocities::Thermal => {
            let key = noise::step_key(model.seed, stream::VELOCITY, 0);
            let width = (group.mass * model.temperature).sqrt();
            state.momenta.extend((first..first + count).map(|id| {
                std::array::from_fn(|axis| {
                    if axis >= dimension {
                        return 0;
                    }
                    let words = noise::words(Generator::Threefry2x32, key, [id as u32, axis as u32]);
                    to_units(width * noise::gaussian(words))
                })
            }));
        }
        Velocities::Rest => state.momenta.resize(first + count, [0; 3]),
        Velocities::Listed { velocities } => {
            state.momenta.extend(velocities.iter().take(count).map(|velocity| {
                std::array::from_fn(|axis| to_units(group.mass * velocity.get(axis).copied().unwrap_or(0.0)))
            }));
            state.momenta.resize(first + count, [0; 3]);
        }
    }
}

/// Takes the common centre-of-mass velocity from the listed particles, to the last bit of their net momentum.
fn bring_to_rest(state: &mut State, particles: &[usize], model: &Model) {
    let mass = |species: u32| model.species[species as usize].mass;
    let total_mass: f64 = particles.iter().map(|&particle| mass(state.species[particle])).sum();
    for axis in 0..model.units.dimension {
        let net: i64 = particles.iter().map(|&particle| i64::from(state.momenta[particle][axis])).sum();
        let mut left = net;
        for &particle in particles {
            let share = (net as f64 * (mass(state.species[particle]) / total_mass)).round_ties_even() as i64;
            state.momenta[particle][axis] = (i64::from(state.momenta[particle][axis]) - share) as i32;
            left -= share;
        }
        // What rounding the shares has left over is at most half a unit per particle.
        for &particle in particles.iter().take(left.unsigned_abs() as usize) {
            state.momenta[particle][axis] -= left.signum() as i32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lattices_follow_the_shape_of_the_box() {
        assert_eq!(lattice_sites(1000, &[10.0, 10.0, 10.0]), [10, 10, 10]);
        assert_eq!(lattice_sites(200, &[20.0, 10.0]), [20, 10, 1]);
        assert_eq!(lattice_sites(100, &[0.01, 10.0, 10.0]), [1, 10, 10]);
        assert_eq!(lattice_sites(28, &[3.0, 3.0, 3.0]), [4, 3, 3]);
        assert_eq!(lattice_sites(0, &[3.0, 3.0]), [1, 1, 1]);
    }
}
