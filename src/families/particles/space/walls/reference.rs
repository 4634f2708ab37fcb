//! Reflection at plane walls, in the same integer places as on the device: particles are at the places 0 to end - 1 of a walled axis, and
//! the walls half a place beyond them, so that k places behind the lower wall is the place k - 1.

use super::PlaneWalls;
use crate::families::particles::reference::held;
use crate::families::reference::whole_fractions;
use crate::families::{Model, OnWalls};
use crate::state::{State, WallImpulse};

/// A particle that flies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Flight {
    /// Where it is.
    pub place: [u32; 3],
    /// Its momentum.
    pub momentum: [i64; 3],
    /// What has become of a unit of momentum along each axis.
    pub turned: [i64; 3],
}

/// What flies: a species, for a number of equal parts of a step; back where walls move the other way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Way {
    /// Index of the species.
    pub species: u32,
    /// Parts of a step.
    pub parts: i64,
    /// Whether the time goes backward.
    pub back: bool,
}

/// Reflections in a part of a drift, after which a particle stays at the wall that it meets.
const MOST_REFLECTIONS: usize = 8;

/// A meeting with a wall.
struct Meeting<'a> {
    walls: &'a PlaneWalls,
    upper: bool,
    /// Its number among all walls.
    number: usize,
    /// Places behind it where the way would end.
    behind: i64,
    /// Part of the way that is left there.
    left: f64,
}

/// The wall that is first met on a way from a place, if any.
fn first_met<'a>(model: &'a Model, place: [u32; 3], way: [i64; 3]) -> Option<Meeting<'a>> {
    let ends = model.units.ends();
    let mut met: Option<Meeting<'a>> = None;
    for (pair, walls) in model.particles().walls.iter().enumerate() {
        let axis = walls.axis;
        let target = i64::from(place[axis]) + way[axis];
        let behind = if way[axis] < 0 { -target } else { target - (i64::from(ends[axis]) - 1) };
        if behind <= 0 {
            continue;
        }
        let left = (behind as f64 - 0.5) / way[axis].abs() as f64;
        if met.as_ref().is_none_or(|known| left > known.left) {
            let upper = way[axis] > 0;
            met = Some(Meeting { walls, upper, number: 2 * pair + usize::from(upper), behind, left });
        }
    }
    met
}

/// The drift of a part of a step.
fn drift(model: &Model, momentum: [i64; 3], way: Way) -> [i64; 3] {
    let mass = model.species[way.species as usize].mass;
    std::array::from_fn(|axis| {
        let velocity = momentum[axis] as f64 * model.units.momentum / mass;
        whole_fractions(model.time_step * velocity / way.parts as f64, model.units.lengths[axis])
    })
}

/// A place at the end of a way, across the periodic box or at most to a wall.
fn advance(place: u32, way: i64, end: u32) -> u32 {
    if end == 0 { place.wrapping_add(way as u32) } else { (i64::from(place) + way).clamp(0, i64::from(end) - 1) as u32 }
}

/// Flies one of the parts of a step; adds what walls absorb to their sums.
pub(crate) fn fly(model: &Model, start: Flight, way: Way, taken: &mut [[i64; 3]]) -> Flight {
    let ends = model.units.ends();
    let mut flight = start;
    let mut ahead = drift(model, start.momentum, way);
    if PlaneWalls::behind(&model.particles().walls, ends, start.place).is_some() {
        // What is frozen goes with its wall.
        flight.place = std::array::from_fn(|axis| start.place[axis].wrapping_add(ahead[axis] as u32));
        return flight;
    }
    let mut time_left = 1.0;
    for _ in 0..MOST_REFLECTIONS {
        let Some(met) = first_met(model, flight.place, ahead) else { break };
        time_left *= met.left;
        let signs = met.walls.signs().map(i64::from);
        let push = met.walls.push(met.upper, way.species as usize, model);
        let before = flight.momentum;
        for axis in 0..3 {
            let push = if way.back { -push[axis] } else { push[axis] };
            flight.momentum[axis] = signs[axis] * before[axis] + push as i64;
            flight.turned[axis] *= signs[axis];
            taken[met.number][axis] += before[axis] - flight.momentum[axis];
        }
        let next = drift(model, flight.momentum, way);
        for axis in 0..3 {
            let across = axis == met.walls.axis;
            let beyond = if across { 0 } else { (met.left * ahead[axis] as f64).round_ties_even() as i64 };
            flight.place[axis] = advance(flight.place[axis], ahead[axis] - beyond, ends[axis]);
            ahead[axis] = match (across, met.upper) {
                (true, false) => met.behind - 1,
                (true, true) => 1 - met.behind,
                (false, _) => (time_left * next[axis] as f64).round_ties_even() as i64,
            };
        }
    }
    for axis in 0..3 {
        flight.place[axis] = advance(flight.place[axis], ahead[axis], ends[axis]);
    }
    flight
}

/// Where a particle was and how it moved before all parts of the drift that has brought it here.
pub(crate) fn before(model: &Model, state: &State, particle: usize, parts: i64) -> Flight {
    let way = Way { species: state.species[particle], parts, back: true };
    let momentum = state.momenta[particle].map(|units| -i64::from(units));
    let mut flight = Flight { place: state.positions[particle], momentum, turned: [1; 3] };
    let mut taken = vec![[0; 3]; 2 * model.particles().walls.len()];
    for _ in 0..parts {
        flight = fly(model, flight, way, &mut taken);
    }
    Flight { momentum: flight.momentum.map(|units| -units), ..flight }
}

/// Momentum that walls have absorbed, with the momentum absorbed since.
pub(crate) fn add(walls: &[WallImpulse], taken: &[[i64; 3]]) -> Vec<WallImpulse> {
    let sum = |(index, taken): (usize, &[i64; 3])| {
        let before = walls.get(index).copied().unwrap_or_default().momentum();
        WallImpulse::new(std::array::from_fn(|axis| before[axis] + taken[axis]))
    };
    taken.iter().enumerate().map(sum).collect()
}

/// Momentum that walls have absorbed until a report point, with that of frozen particles there.
pub(crate) fn on_walls(model: &Model, state: &State, momenta: &[[i64; 3]]) -> OnWalls {
    let all = add(&state.walls, &held::absorbed(model, state, momenta));
    let walls = if all.is_empty() { &state.walls } else { &all };
    OnWalls::new(model, walls.iter().map(|wall| wall.momentum().map(|units| units as f64)))
}
