//! Where the particles of a scene start, and how fast.

use super::particles::chains;
use super::particles::space::layers;
use crate::document::{FileStart, Generator, ParticleGroup, Placement, StateVelocities, Velocities};
use crate::families::{Checked, Model};
use crate::noise::{self, stream};
use crate::numbers::grouped;
use crate::state::{State, crossings};
use std::ops::Range;

/// The state at step 0 of a scene: particles numbered group by group, each group in its own order; those of a file in the order of
/// the file.
///
/// `scene` has been checked and `model` was made from it. The words of random placements and velocities depend on
/// the seed and the particle's number only, and always come from Threefry: what is drawn once may cost a little more.
/// The net momentum of all thermal groups together is zero to the last bit, so a single thermal particle is at rest.
///
/// ```
/// use mesoscope::{families::initial_state, scene};
///
/// let small = ["space.box=[4,4,4]", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let state = initial_state(&scene);
/// assert_eq!((state.step, state.len()), (0, 192));
/// assert_eq!(state.total_momentum(), [0; 3]);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn initial_state(scene: &Checked) -> State {
    let model = scene.model();
    let mut state = State::default();
    let mut thermal: Vec<Range<usize>> = Vec::new();
    if let Some(state) = scene.start().and_then(|start| start.places.as_ref()?.state.clone()) {
        return count_turns(state, scene);
    }
    let has_fields = scene.fields_of_start().is_some();
    let of_run = scene.start().and_then(|start| start.places.as_ref()).filter(|places| !places.masses.is_empty());
    if let Some(velocities) = scene.start_velocities().filter(|_| !has_fields && of_run.is_none()) {
        if let Some(start) = scene.start() {
            state = from_file(start, velocities, model);
        }
        for group in scene.particles.iter().filter(|group| group.is_frozen()) {
            let count = group.resolved_count(&scene.space) as usize;
            add_group(&mut state, group, count, model, 0.0);
        }
        let moves = |id: &usize| !model.species[state.species[*id] as usize].fixed;
        if velocities == StateVelocities::Thermal {
            thermal = ranges((0..state.len()).filter(moves));
        }
        return complete(state, scene, &thermal);
    }
    let lattices = scene.particles.iter().filter(|group| group.placement.is_lattice()).count();
    let mut lattice = 0;
    for group in &scene.particles {
        let first = state.len();
        let count = group.resolved_count(&scene.space) as usize;
        add_group(&mut state, group, count, model, lattice as f64 / lattices.max(1) as f64);
        lattice += usize::from(group.placement.is_lattice());
        let draws = scene.start_velocities().is_none_or(|velocities| velocities == StateVelocities::Thermal);
        if draws && group.velocities == Velocities::Thermal && !group.is_held() {
            thermal.push(first..first + count);
        }
    }
    if let Some(places) = of_run {
        state.positions.clone_from(&places.positions);
        state.masses.clone_from(&places.masses);
        for (momentum, velocity) in state.momenta.iter_mut().zip(&places.velocities) {
            *momentum = velocity.map(|part| to_units(part, model));
        }
    }
    complete(state, scene, &thermal)
}

/// Appends a group with its momenta.
fn add_group(state: &mut State, group: &ParticleGroup, count: usize, model: &Model, shift: f64) {
    let first = state.len();
    place(state, group, count, model, shift);
    model.physics().set_in_motion(state, group, first..first + count, model);
    let species = model.species.iter().position(|species| species.name == group.species).unwrap_or(0);
    state.species.resize(first + count, species as u32);
    // Times round the box that a file says.
    if !state.images.is_empty() {
        state.images.resize(first + count, [0; 3]);
    }
}

/// What a run takes from the file that its particles are from, in words: where the noise begins, and what steps and times are counted from.
#[must_use]
pub fn start_in_words(scene: &Checked) -> Option<String> {
    let model = scene.model();
    let file = &scene.state.as_ref()?.file;
    if scene.earlier_run().is_some() {
        let steps = grouped(model.steps_before);
        return Some(format!(
            "goes on with the run in `{file}` after {steps} steps, to the last bit: noise, baths and whatever depends on time or adds up do; \
             `step` and `time` are counted from there"
        ));
    }
    let remembers = model.has_memory() || model.particles().coloured_noise.is_some();
    let forgets = if remembers { "; what baths remember is drawn anew" } else { "" };
    let what = if scene.mesh().is_some() { "water" } else { "particles" };
    Some(format!("{what} of `{file}`, with noise of its own{forgets}; `step` and `time` are counted from 0"))
}

/// Completes a state whose particles have places and momenta; `thermal` are those whose momenta were drawn.
fn complete(mut state: State, scene: &Checked, thermal: &[Range<usize>]) -> State {
    scene.model().physics().complete_start(&mut state, scene, thermal);
    count_turns(state, scene)
}

/// A state with the times round the box, where a trajectory needs them.
fn count_turns(mut state: State, scene: &Checked) -> State {
    let model = scene.model();
    if !model.follows_paths(&scene.output) {
        state.images = Vec::new();
    } else if state.images.is_empty() {
        state.images = images(&state, model);
    }
    state
}

/// The particles of a file, copy by copy.
fn from_file(start: &FileStart, velocities: StateVelocities, model: &Model) -> State {
    let Some(places) = start.places.as_ref().filter(|places| !places.positions.is_empty()) else {
        return State::default();
    };
    let mut state = State::default();
    let [x, y, z] = start.copies.map(u64::from);
    // What the fractions of a copy are of the whole box.
    let part =
        |fraction: u32, copy: u64, copies: u64| (((copy << 32) + u64::from(fraction) + copies / 2) / copies) as u32;
    let species: Vec<u32> = start.species.iter().map(|species| u32::from(*species)).collect();
    for copy in 0..x * y * z {
        let [i, j, k] = [copy % x, copy / x % y, copy / (x * y)];
        let place = |[a, b, c]: &[u32; 3]| model.units.between_walls([part(*a, i, x), part(*b, j, y), part(*c, k, z)]);
        state.positions.extend(places.positions.iter().map(place));
        state.species.extend_from_slice(&species);
        state.tethers.extend(places.tethers.iter().zip(&places.positions).map(|(tether, position)| {
            // The point may lie beyond an end of the copy.
            let crossed = crossings(*position, *tether);
            std::array::from_fn(|axis| {
                let (copy, copies) = ([i, j, k][axis], start.copies[axis]);
                let copy = (copy as i64 + i64::from(crossed[axis])).rem_euclid(copies.into()) as u64;
                part(tether[axis], copy, copies.into())
            })
        }));
    }
    let key = noise::step_key(model.seed, stream::VELOCITY, 0);
    let momentum = |id: usize| {
        let species = &model.species[state.species[id] as usize];
        match velocities {
            _ if species.fixed => [0; 3],
            StateVelocities::Rest => [0; 3],
            StateVelocities::Thermal => thermal_momentum(id, species.mass, key, model),
            StateVelocities::File => {
                let number = id % start.species.len().max(1);
                let velocity = places.velocities.get(number).copied().unwrap_or_default();
                velocity.map(|part| to_units(species.mass * part, model))
            }
        }
    };
    state.momenta = (0..state.len()).map(momentum).collect();
    state.images.clone_from(&places.images);
    state
}

/// A momentum in integer units.
fn to_units(momentum: f64, model: &Model) -> i32 {
    (momentum / model.units.momentum).round_ties_even() as i32
}

/// A momentum of Maxwell's distribution.
fn thermal_momentum(id: usize, mass: f64, key: [u32; 2], model: &Model) -> [i32; 3] {
    let width = (mass * model.temperature).sqrt();
    std::array::from_fn(|axis| {
        if axis >= model.units.dimension {
            return 0;
        }
        let words = noise::words(Generator::Threefry2x32, key, [id as u32, axis as u32]);
        to_units(width * noise::gaussian(words), model)
    })
}

/// Times round the box at the start, so that what is bonded together is whole: from the first particle of every molecule
/// along its bonds.
fn images(state: &State, model: &Model) -> Vec<[i32; 3]> {
    let mut images = vec![[0; 3]; state.len()];
    let Some(bonds) = model.particles().bonds.as_ref() else { return images };
    let mut bonded: Vec<Vec<usize>> = vec![Vec::new(); state.len()];
    for [first, second] in bonds.iter().map(|bond| bond.ends.map(|end| end as usize)) {
        bonded[first].push(second);
        bonded[second].push(first);
    }
    let mut reached = vec![false; state.len()];
    let mut ahead = Vec::new();
    for first in 0..state.len() {
        if !std::mem::replace(&mut reached[first], true) {
            ahead.push(first);
        }
        while let Some(particle) = ahead.pop() {
            for &other in &bonded[particle] {
                if !std::mem::replace(&mut reached[other], true) {
                    let crossed = crossings(state.positions[particle], state.positions[other]);
                    images[other] = std::array::from_fn(|axis| images[particle][axis] + crossed[axis]);
                    ahead.push(other);
                }
            }
        }
    }
    images
}

/// Appends the positions of a group; `shift` moves a lattice by this fraction of its spacing, so that the lattices of
/// several groups do not fall on each other.
fn place(state: &mut State, group: &ParticleGroup, count: usize, model: &Model, shift: f64) {
    let dimension = model.units.dimension;
    let first = state.len();
    if let (Some(chain), Placement::Random | Placement::Lattice { .. }) = (&group.chain, &group.placement) {
        return chains::place(state, group, chain, count, model, shift);
    }
    match &group.placement {
        Placement::Random => {
            state.positions.extend((first..first + count).map(|id| random_position(id, model)));
        }
        Placement::Lattice { jitter } => {
            let sites = lattice_sites(count as u64, &model.units.edges()[..dimension]);
            let all: u128 = sites.iter().map(|sites| u128::from(*sites)).product();
            let offset = (0.5 + shift).fract();
            let shifts = |id: usize| {
                let shift = |word: u32| jitter * (f64::from(word) / 2_147_483_648.0 - 1.0);
                if *jitter > 0.0 { random_words(id, model).map(shift) } else { [0.0; 3] }
            };
            state.positions.extend((0..count).map(|index| {
                let shifts = shifts(first + index);
                // Sites left empty are spread over the lattice instead of collecting at its end.
                let mut site = index as u128 * all / count as u128;
                model.units.between_walls(std::array::from_fn(|axis| {
                    if axis >= dimension {
                        return 0;
                    }
                    let coordinate = (site % u128::from(sites[axis])) as f64;
                    site /= u128::from(sites[axis]);
                    let place = (coordinate + offset + shifts[axis]) / sites[axis] as f64;
                    (place * 4_294_967_296.0).round() as i64 as u32
                }))
            }));
        }
        Placement::Circle { .. } | Placement::Listed { .. } => {
            let places = (0..count as u64).filter_map(|index| group.placement.position(index, count as u64));
            state.positions.extend(places.map(|place| model.units.place(place)));
        }
        Placement::BehindWalls { .. } => layers::place(state, &group.placement, count, model),
    }
}

/// A random place in the box.
pub(crate) fn random_position(id: usize, model: &Model) -> [u32; 3] {
    model.units.between_walls(random_words(id, model))
}

/// Random fractions of the box.
fn random_words(id: usize, model: &Model) -> [u32; 3] {
    let key = noise::step_key(model.seed, stream::POSITION, 0);
    let [x, y] = noise::words(Generator::Threefry2x32, key, [id as u32, 0]);
    let [z, _] = noise::words(Generator::Threefry2x32, key, [id as u32, 1]);
    let words = [x, y, z];
    std::array::from_fn(|axis| if axis < model.units.dimension { words[axis] } else { 0 })
}

/// The numbers of lattice sites along each axis: the axis with the widest spacing is refined until all fit.
pub(crate) fn lattice_sites(count: u64, lengths: &[f64]) -> [u64; 3] {
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
pub(super) fn set_in_motion(state: &mut State, group: &ParticleGroup, ids: Range<usize>, model: &Model) {
    let (first, count) = (ids.start, ids.len());
    match &group.velocities {
        _ if group.fixed => state.momenta.resize(first + count, [0; 3]),
        _ if group.is_frozen() => {
            let momenta = layers::momenta(&state.positions[first..first + count], group.mass, model);
            state.momenta.extend(momenta);
        }
        Velocities::Thermal => {
            let key = noise::step_key(model.seed, stream::VELOCITY, 0);
            state.momenta.extend((first..first + count).map(|id| thermal_momentum(id, group.mass, key, model)));
        }
        Velocities::Rest | Velocities::Geostrophic | Velocities::ShearWave { .. } => {
            state.momenta.resize(first + count, [0; 3]);
        }
        Velocities::Listed { velocities } => {
            state.momenta.extend(velocities.iter().take(count).map(|velocity| {
                std::array::from_fn(|axis| to_units(group.mass * velocity.get(axis).copied().unwrap_or(0.0), model))
            }));
            state.momenta.resize(first + count, [0; 3]);
        }
    }
}

/// Numbers in ascending order, as ranges.
pub(crate) fn ranges(numbers: impl Iterator<Item = usize>) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some(last) if last.end == number => last.end += 1,
            _ => ranges.push(number..number + 1),
        }
    }
    ranges
}

/// Takes the common centre-of-mass velocity from the particles of some ranges, to the last bit of their net momentum.
pub(crate) fn bring_to_rest(
    state: &mut State,
    particles: &[Range<usize>],
    dimension: usize,
    mass: impl Fn(usize) -> f64,
) {
    let particles = || particles.iter().cloned().flatten();
    let total_mass: f64 = particles().map(&mass).sum();
    for axis in 0..dimension {
        let net: i64 = particles().map(|particle| i64::from(state.momenta[particle][axis])).sum();
        let mut left = net;
        for particle in particles() {
            let share = (net as f64 * (mass(particle) / total_mass)).round_ties_even() as i64;
            state.momenta[particle][axis] = (i64::from(state.momenta[particle][axis]) - share) as i32;
            left -= share;
        }
        // What rounding the shares has left over is at most half a unit per particle.
        for particle in particles().take(left.unsigned_abs() as usize) {
            state.momenta[particle][axis] -= left.signum() as i32;
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;
    use crate::families::reference::Reference;
    use serde_json::{Value, json};

    fn start(seed: u64, lengths: &Value, particles: &Value) -> (Model, State) {
        let scene = serde_json::from_value(json!({
            "title": "test", "seed": seed, "space": {"box": lengths}, "time": {"step": 0.1, "steps": 1},
            "temperature": 2.0, "particles": particles, "interactions": [{"type": "dpd"}],
        }))
        .unwrap();
        let scene = Checked::presumed(scene);
        (scene.model().clone(), initial_state(&scene))
    }

    #[test]
    fn particles_are_numbered_group_by_group() {
        let (_, state) = start(
            1,
            &json!([4.0, 5.0]),
            &json!([{"species": "B", "count": 2}, {"species": "A", "number_density": 0.1}, {"species": "B", "count": 1}]),
        );
        assert_eq!(state.species, [0, 0, 1, 1, 0]);
        assert_eq!((state.positions.len(), state.momenta.len(), state.step), (5, 5, 0));
        assert!(state.positions.iter().all(|position| position[2] == 0));
        assert!(state.momenta.iter().all(|momentum| momentum[2] == 0));
        assert!(state.predicted.is_empty());
    }

    #[test]
    fn thermal_groups_together_are_at_rest_and_at_temperature() {
        let (model, state) = start(
            1,
            &json!([9.0, 9.0, 9.0]),
            &json!([{"species": "A", "count": 3001}, {"species": "B", "count": 2000, "mass": 7.0},
                {"species": "A", "velocities": {"type": "listed", "velocities": [[1.0, -2.0, 0.5]]},
                 "placement": {"type": "listed", "positions": [[-1.0, 10.0, 4.5]]}}]),
        );
        let last = state.len() - 1;
        assert_eq!(model.units.momentum(state.momenta[last]), [1.0, -2.0, 0.5]);
        assert_eq!(state.positions[last], model.units.fraction([8.0, 1.0, 4.5]));
        assert_eq!(state.total_momentum(), state.momenta[last].map(i64::from));
        for (range, mass) in [(0..3001, 1.0_f64), (3001..5001, 7.0)] {
            let count = range.len() as f64;
            let momenta: Vec<f64> =
                state.momenta[range].iter().flat_map(|momentum| model.units.momentum(*momentum)).collect();
            let moment =
                |power: i32| momenta.iter().map(|p| (p / mass.sqrt()).powi(power)).sum::<f64>() / (3.0 * count);
            let width = (2.0 / (3.0 * count)).sqrt();
            assert!((moment(2) / 2.0 - 1.0).abs() < 4.0 * width, "{}", moment(2));
            // Maxwell's distribution: ⟨v⁴⟩ = 3 (kT/m)².
            assert!((moment(4) / 12.0 - 1.0).abs() < 10.0 * width, "{}", moment(4));
        }
    }

    #[test]
    fn a_single_thermal_particle_is_at_rest() {
        let (_, state) = start(3, &json!([2.0, 2.0]), &json!([{"species": "A", "count": 1}]));
        assert_eq!(state.momenta, [[0; 3]]);
        let (_, state) = start(3, &json!([2.0, 2.0]), &json!([{"species": "A", "count": 0}]));
        assert!(state.is_empty());
    }

    #[test]
    fn random_positions_are_uniform_and_follow_the_seed() {
        let particles = json!([{"species": "A", "count": 8000}]);
        let (_, state) = start(1, &json!([9.0, 7.0, 8.0]), &particles);
        let mut octants = [0_u32; 8];
        for [x, y, z] in &state.positions {
            octants[(x >> 31 | (y >> 31) << 1 | (z >> 31) << 2) as usize] += 1;
        }
        // Expected 1000 ± 30 each.
        assert!(octants.iter().all(|count| (880..1120).contains(count)), "{octants:?}");
        assert_eq!(start(1, &json!([9.0, 7.0, 8.0]), &particles).1, state);
        assert_ne!(start(2, &json!([9.0, 7.0, 8.0]), &particles).1.positions, state.positions);
        assert_ne!(start(2, &json!([9.0, 7.0, 8.0]), &particles).1.momenta, state.momenta);
    }

    #[test]
    fn lattices_are_even_and_do_not_coincide() {
        let lattice = json!({"type": "lattice"});
        let (model, state) =
            start(1, &json!([8.0, 4.0, 4.0]), &json!([{"species": "A", "count": 1024, "placement": lattice}]));
        // 16 × 8 × 8 sites, half a unit apart: each particle has its six neighbours.
        let run = Reference::new(model, state);
        assert_eq!(run.radial_distribution(0.6, 1), [3 * 1024]);
        assert_eq!(run.radial_distribution(0.49, 1), [0]);

        let (model, state) = start(
            1,
            &json!([4.0, 4.0, 4.0]),
            &json!([{"species": "A", "count": 64, "placement": lattice}, {"species": "B", "count": 64, "placement": lattice}]),
        );
        // Each at the centres of the other's cells, √¾ away.
        let run = Reference::new(model, state);
        assert_eq!(run.radial_distribution(0.86, 1), [0]);
        assert_eq!(run.radial_distribution(0.88, 1), [8 * 64]);

        // Of 4³ sites for 50 particles, every half of the box holds 25.
        let (_, state) =
            start(1, &json!([4.0, 4.0, 4.0]), &json!([{"species": "A", "count": 50, "placement": lattice}]));
        let lower = state.positions.iter().filter(|position| position[2] < 1 << 31).count();
        assert!((24..=26).contains(&lower), "{lower}");
    }

    #[test]
    fn lattices_follow_the_shape_of_the_box() {
        assert_eq!(lattice_sites(1000, &[10.0, 10.0, 10.0]), [10, 10, 10]);
        assert_eq!(lattice_sites(200, &[20.0, 10.0]), [20, 10, 1]);
        assert_eq!(lattice_sites(100, &[0.01, 10.0, 10.0]), [1, 10, 10]);
        assert_eq!(lattice_sites(28, &[3.0, 3.0, 3.0]), [4, 3, 3]);
        assert_eq!(lattice_sites(0, &[3.0, 3.0]), [1, 1, 1]);
    }
}
