//! Boundaries that shear: where the images of particles are, and what becomes of particles that cross a boundary.

use super::ShearedBox;
use crate::families::Model;
use crate::families::particles::reference::end_of_step;
use crate::families::reference::{Unstable, drift, narrow, whole_fractions};
use crate::state::{State, Units, WallImpulse};

/// The places of all integers of an axis.
const BOX: i64 = 1 << 32;

/// The images of a periodic box at a moment.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Images<'a> {
    /// The box.
    pub units: &'a Units,
    /// The axis across which boundaries shear, and how far the image above is displaced along x.
    shift: Option<(usize, u32)>,
}

impl<'a> Images<'a> {
    /// Of a box whose boundaries are at rest.
    #[cfg(test)]
    pub(crate) fn at_rest(units: &'a Units) -> Self {
        Self { units, shift: None }
    }

    /// Those of a model after some halves of time steps.
    pub(crate) fn after(model: &'a Model, halves: u64) -> Self {
        let shift = |shear: &ShearedBox| (shear.gradient, shear.shift(halves));
        Self { units: &model.units, shift: model.particles().shear.as_ref().map(shift) }
    }

    /// Those of a model where a step begins.
    pub(crate) fn of_step(model: &'a Model, step: u64) -> Self {
        Self::after(model, model.clock(step).wrapping_mul(2))
    }

    /// Whether boundaries shear.
    pub(crate) fn shear(&self) -> bool {
        self.shift.is_some()
    }

    /// The displacement from the nearest image of b to a, and by how many boxes that image is above b.
    pub(crate) fn displacement(&self, a: [u32; 3], mut b: [u32; 3]) -> ([f64; 3], i64) {
        let Some((axis, shift)) = self.shift else { return (self.units.displacement(a, b), 0) };
        let nearest = i64::from(a[axis].wrapping_sub(b[axis]) as i32);
        let boxes_up = (i64::from(a[axis]) - i64::from(b[axis]) - nearest) / BOX;
        b[0] = (i64::from(b[0]) + boxes_up * i64::from(shift)).rem_euclid(BOX) as u32;
        (self.units.displacement(a, b), boxes_up)
    }
}

/// By how much the momentum of a particle's image some boxes above it is larger, along x.
pub(crate) fn jump(model: &Model, species: u32, boxes_up: i64) -> i64 {
    let jump = |shear: &ShearedBox| i64::from(shear.jump(species as usize, model));
    model.particles().shear.as_ref().map_or(0, |shear| boxes_up * jump(shear))
}

/// The momentum of the linear profile where a particle is, in units; none without shear.
pub(crate) fn flow(model: &Model, state: &State, particle: usize) -> f64 {
    let at = |shear: &ShearedBox| {
        shear.flow(state.species[particle] as usize, state.positions[particle][shear.gradient], model)
    };
    model.particles().shear.as_ref().map_or(0.0, at)
}

/// Gives particles momenta and moves them by some of the equal parts of a step. Where the image comes in depends on how far it is displaced
/// when the part ends.
///
/// # Errors
/// [`Unstable`] when a momentum or a drift does not fit the integer state.
pub(crate) fn move_on(
    (model, shear): (&Model, &ShearedBox),
    masses: &[f64],
    state: &mut State,
    momenta: &[[i32; 3]],
    parts: i64,
    of_parts: i64,
) -> Result<(), Unstable> {
    let whole = end_of_step::drifts(model, masses, momenta, of_parts);
    let ways: Vec<[i64; 3]> = whole.iter().map(|way| way.map(|units| units / of_parts * parts)).collect();
    drift(&mut state.clone(), &ways)?;
    let mut moved: Vec<[i64; 3]> = momenta.iter().map(|momentum| momentum.map(i64::from)).collect();
    let mut taken = 0;
    for (particle, momentum) in moved.iter_mut().enumerate() {
        let jump = i64::from(shear.jump(state.species[particle] as usize, model));
        for part in 1..=parts {
            let halves = (2 * part / of_parts) as u64;
            let shift = i64::from(shear.shift(model.clock(state.step).wrapping_mul(2).wrapping_add(halves)));
            let mut place = state.positions[particle].map(i64::from);
            for axis in 0..3 {
                let velocity = momentum[axis] as f64 * model.units.momentum / masses[particle];
                let way = model.time_step * velocity / of_parts as f64;
                place[axis] += whole_fractions(way, model.units.lengths[axis]);
            }
            let crossed = place[shear.gradient].div_euclid(BOX);
            place[0] -= crossed * shift;
            momentum[0] -= crossed * jump;
            taken += crossed * jump;
            state.positions[particle] = place.map(|place| place.rem_euclid(BOX) as u32);
        }
    }
    state.momenta = narrow(&moved, state.step)?;
    let before = state.walls.first().copied().unwrap_or_default().momentum();
    state.walls = vec![WallImpulse::new([before[0] + taken, before[1], before[2]])];
    Ok(())
}
