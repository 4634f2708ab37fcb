//! Changes to a simulation between its steps: of numbers of its scene, of positions and velocities.

use super::RunError;
use super::plan::plan;
use super::simulation::Simulation;
use crate::families::{Checked, Kinematics};
use crate::numbers::short;
use crate::plan::{Hardware, Options};
use crate::scene::{self, Change, Rounding};
use crate::state::{State, StateArray};
use serde_json::Value;

/// Particles whose numbers a message lists.
const LISTED: usize = 8;

/// How often velocities are set until a report finds them, at most: friction in the closing half step leaves a part of what lacks.
const ATTEMPTS: usize = 64;

impl Simulation {
    /// The changes since the start of the scene.
    #[must_use]
    pub fn changes(&self) -> &[Change] {
        &self.changes
    }

    /// Changes a number of the scene: `temperature`, a number of `interactions`, `integrator`, `space.walls`, or `space.shear.rate`, by its
    /// path as in overrides of scenes. Velocities, and the numbers that baths remember, stay as they are.
    ///
    /// Momenta are whole multiples of a unit that follows from the scene, and from the largest values that `announced`
    /// in it lists: up to these no unit changes. Where a change needs a larger unit all the same, momenta are rounded
    /// to it, so that their sum stays, to half a unit: the [`Rounding`] says how much it changed. The first change
    /// compiles kernels once more, with their numbers in a buffer; those of a scene that announces numbers have them
    /// there from the start.
    ///
    /// ```
    /// use mesoscope::gpu::AdapterChoice;
    /// use mesoscope::{Simulation, scene};
    ///
    /// let scene = scene::load("dpd-fluid", &["space.box=[4,4,4]", "output={}"].map(str::to_owned))?;
    /// let mut simulation = Simulation::new(&scene, &AdapterChoice::Best)?;
    /// simulation.advance(50)?;
    /// simulation.set("temperature", 2.0)?;
    /// simulation.set("interactions.0.repulsion", 15)?;
    /// simulation.advance(400)?;
    /// assert!(simulation.observable("temperature")?.is_some_and(|temperature| temperature > 1.5));
    /// assert_eq!(simulation.changes()[1].step, 50);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RunError::Arrays`] for a key that cannot change between steps, [`RunError::Scene`] for a value that the scene does not accept.
    pub fn set(&mut self, key: &str, new: impl Into<Value>) -> Result<Rounding, RunError> {
        let (key, new) = (scene::changeable(key).map_err(mistake)?, new.into());
        let old = self.scene.clone();
        let state = self.state()?;
        let mut settings = vec![format!("{key}={new}")];
        let mut other = (*old).clone();
        if let (Some(shear), Some(rate), "space.shear.rate") = (&mut other.space.shear, new.as_f64(), key.as_str()) {
            shear.rate = rate;
            let displacement = scene::displacement_at(&old, &other, self.step());
            settings.extend(displacement.map(|displacement| format!("space.shear.displacement={displacement}")));
        }
        let scene = scene::overridden(&old, &settings)?;
        let scene = scene.with_times(old.model().time).after_turns(old.model().after_turns);
        if !scene::differ_in_numbers(&old, &scene) {
            return Err(mistake(format!(
                "{key}: it is no number of this scene, whose value could change between steps; accepted: a number in place of a number"
            )));
        }
        let (state, rounding) = in_units_of(&scene, &old, (*state).clone())?;
        self.replace(scene, state)?;
        self.changes.push(Change { step: self.step(), key, value: new, rounding });
        Ok(rounding)
    }

    /// Gives all particles other velocities, in units of length over time, in the order of their numbers.
    ///
    /// A report finds these velocities to within a unit of momentum or two. Where the closing half step of an integrator has friction and
    /// noise, the momenta before it are sought from which it ends at them.
    ///
    /// # Errors
    /// [`RunError::Arrays`] with all mistakes: another number of particles, numbers that are not finite or too large, held particles that would
    /// move; and for cells with internal energies, of which velocities are a part.
    pub fn set_velocities(&mut self, velocities: &[[f64; 3]]) -> Result<Rounding, RunError> {
        let scene = self.scene.clone();
        let model = scene.model();
        let kinematics = Kinematics::new(model);
        if !self.here()?.state.energies.is_empty() {
            // Energy that is no motion is inside.
            let text = "cells of this scene keep account of kinetic and internal energy together: other velocities would heat or cool \
                        what is inside";
            return Err(mistake(format!("{text}; accepted: scenes without internal energies")));
        }
        let mut mistakes: Vec<String> = wrong_count(velocities.len(), model.particle_count()).into_iter().collect();
        mistakes.extend(listed("is not finite", velocities, |_, velocity| {
            velocity.iter().any(|number| !number.is_finite())
        }));
        let species = &self.here()?.state.species.clone();
        mistakes.extend(listed("is held, and its velocity is not zero", velocities, |particle, velocity| {
            let held = species.get(particle).is_some_and(|species| model.species[*species as usize].fixed);
            held && *velocity != [0.0; 3]
        }));
        mistakes.extend(listed("has components beyond the dimensions of the box", velocities, |_, velocity| {
            velocity[model.units.dimension..].iter().any(|component| *component != 0.0)
        }));
        if mistakes.is_empty() {
            let reported = &self.here()?.reported;
            mistakes.extend(listed(
                "is too fast for the unit of momentum of the scene",
                velocities,
                |particle, velocity| {
                    velocity
                        .iter()
                        .any(|component| kinematics.units_of(*component, reported, particle).abs() > MOST_UNITS)
                },
            ));
        }
        refuse(mistakes)?;
        let wanted: Vec<[i64; 3]> = {
            let reported = &self.here()?.reported;
            let units = |(particle, velocity): (usize, &[f64; 3])| {
                velocity.map(|component| kinematics.units_of(component, reported, particle).round_ties_even() as i64)
            };
            velocities.iter().enumerate().map(units).collect()
        };
        let mut nearest = i64::MAX;
        for _ in 0..ATTEMPTS {
            let here = self.here()?;
            let mut state = (*here.state).clone();
            let mut most = 0;
            for ((momentum, found), wanted) in state.momenta.iter_mut().zip(&here.reported.momenta).zip(&wanted) {
                for axis in 0..3 {
                    let lacking = wanted[axis] - i64::from(found[axis]);
                    most = most.max(lacking.abs());
                    momentum[axis] =
                        (i64::from(momentum[axis]) + lacking).clamp(i32::MIN.into(), i32::MAX.into()) as i32;
                }
            }
            if most <= 1 && most >= nearest || most == 0 {
                break;
            }
            nearest = nearest.min(most);
            for (predicted, momentum) in state.predicted.iter_mut().zip(&state.momenta) {
                *predicted = *momentum;
            }
            self.restart(state)?;
        }
        let reported = &self.here()?.reported;
        let deviation = |(particle, velocity): (usize, &[f64; 3])| {
            let found = kinematics.velocity(reported, particle);
            (0..3).map(|axis| (found[axis] - velocity[axis]).abs()).fold(0.0, f64::max)
        };
        let largest = velocities.iter().enumerate().map(deviation).fold(0.0, f64::max);
        Ok(self.note("velocities", largest))
    }

    /// Moves all particles, in units of length, in the order of their numbers. How often they have gone round the box is counted on from where
    /// it was, without the way of this move.
    ///
    /// # Errors
    /// [`RunError::Arrays`] with all mistakes: another number of particles, numbers that are not finite, positions outside of the box.
    pub fn set_positions(&mut self, positions: &[[f64; 3]]) -> Result<Rounding, RunError> {
        let scene = self.scene.clone();
        let model = scene.model();
        let units = model.units;
        let edges = units.edges();
        let species = &self.here()?.state.species.clone();
        let frozen =
            |particle: usize| species.get(particle).is_some_and(|species| model.species[*species as usize].frozen);
        let mut mistakes: Vec<String> = wrong_count(positions.len(), model.particle_count()).into_iter().collect();
        mistakes.extend(listed("is not finite", positions, |_, position| {
            position.iter().any(|number| !number.is_finite())
        }));
        mistakes.extend(listed("lies outside of the box", positions, |particle, position| {
            let is_outside = |axis: usize| !(0.0..=edges[axis]).contains(&position[axis]);
            !frozen(particle)
                && position.iter().all(|number| number.is_finite())
                && (0..units.dimension).any(is_outside)
        }));
        refuse(mistakes)?;
        let mut state = (*self.here()?.state).clone();
        let mut largest: f64 = 0.0;
        for (particle, (place, position)) in state.positions.iter_mut().zip(positions).enumerate() {
            if frozen(particle) {
                continue;
            }
            let found = units.place(*position);
            for axis in 0..units.dimension {
                let off = (units.position(found)[axis] - position[axis]).abs();
                largest = largest.max(off.min((off - units.lengths[axis]).abs()));
                place[axis] = found[axis];
            }
        }
        // Neighbours are listed anew.
        state.anchors.clear();
        self.restart(state)?;
        Ok(self.note("positions", largest))
    }

    fn note(&mut self, key: &str, largest: f64) -> Rounding {
        let rounding = Rounding { largest, momentum: [0.0; 3] };
        self.changes.push(Change { step: self.step(), key: key.to_owned(), value: Value::Null, rounding });
        rounding
    }
}

/// Units of momentum up to which a velocity is accepted: a quarter of what an integer holds.
const MOST_UNITS: f64 = (1 << 29) as f64;

fn mistake(text: String) -> RunError {
    RunError::Arrays { mistakes: vec![text] }
}

fn refuse(mistakes: Vec<String>) -> Result<(), RunError> {
    if mistakes.is_empty() { Ok(()) } else { Err(RunError::Arrays { mistakes }) }
}

fn wrong_count(found: usize, particles: u64) -> Option<String> {
    (found as u64 != particles).then(|| format!("found {found} particles; accepted: {particles}, those of the scene"))
}

/// The mistake that some particles share, with their first numbers.
fn listed(what: &str, vectors: &[[f64; 3]], is_wrong: impl Fn(usize, &[f64; 3]) -> bool) -> Option<String> {
    let wrong: Vec<usize> = (0..vectors.len()).filter(|particle| is_wrong(*particle, &vectors[*particle])).collect();
    let first = *wrong.first()?;
    let numbers: Vec<String> = wrong.iter().take(LISTED).map(ToString::to_string).collect();
    let more = if wrong.len() > LISTED { format!(" and {} more", wrong.len() - LISTED) } else { String::new() };
    let [x, y, z] = vectors[first].map(short);
    Some(format!("particle {}{more} {what}: the first has ({x}, {y}, {z})", numbers.join(", ")))
}

/// The units of what a scene keeps besides positions and momenta: of momentum, of work, of its sums.
fn kept_units(scene: &Checked, state: &State) -> Vec<f64> {
    let model = scene.model();
    let work = plan(scene, Hardware::default(), Options::default()).quanta.energy;
    let sums = model.physics().kept(model, state).into_iter().map(|sum| sum.unit);
    [model.units.momentum, work].into_iter().chain(sums).collect()
}

/// The state in the units of another scene, which are as large or differ by a power of two.
pub(super) fn in_units_of(scene: &Checked, old: &Checked, mut state: State) -> Result<(State, Rounding), RunError> {
    let [from, to] = [old, scene].map(|scene| scene.model().units.momentum);
    let of_velocities = [StateArray::Predicted, StateArray::Images, StateArray::Anchors, StateArray::Tethers];
    let keeps = |array: &StateArray| !of_velocities.contains(array) && !state.words(*array).is_empty();
    if StateArray::ALL.iter().any(keeps) && kept_units(old, &state) != kept_units(scene, &state) {
        let text = "the change needs other units, in which what this scene keeps, such as accounts, masses and memory, cannot be converted";
        return Err(mistake(format!(
            "{text}; accepted: values that need no other unit, which `announced` in the scene provides, or a new simulation"
        )));
    }
    if from == to {
        return Ok((state, Rounding::default()));
    }
    let ratio = from / to;
    let before = state.total_momentum();
    for momenta in [&mut state.momenta, &mut state.predicted] {
        for component in momenta.iter_mut().flatten() {
            let units = f64::from(*component) * ratio;
            if units.abs() > f64::from(i32::MAX) {
                return Err(mistake(
                    "the momenta are too large for the units that the change needs: change in smaller steps".to_owned(),
                ));
            }
            *component = units.round_ties_even() as i32;
        }
    }
    // Rounding alone would leave a sum of its own, by a few units.
    let moves = |particle: &usize| !scene.model().species[state.species[*particle] as usize].fixed;
    let mobile: Vec<usize> = (0..state.len()).filter(moves).collect();
    for axis in 0..3 {
        let lacking = (before[axis] as f64 * ratio).round_ties_even() as i64 - state.total_momentum()[axis];
        for particle in mobile.iter().take(lacking.unsigned_abs() as usize) {
            state.momenta[*particle][axis] += lacking.signum() as i32;
        }
    }
    let after = state.total_momentum();
    let momentum = std::array::from_fn(|axis| after[axis] as f64 * to - before[axis] as f64 * from);
    Ok((state, Rounding { largest: 0.5 * to.max(0.0), momentum }))
}
