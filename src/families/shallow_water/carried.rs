//! A start from fields on the nodes: masses and velocities of particles that have these fields.
//!
//! With ψₖ(Xᵢ) the splines of the scheme, particles have the depth h̃ₖ = Σ mᵢ ψₖ(Xᵢ) and the momentum Σ mᵢ Vᵢ ψₖ(Xᵢ) on the nodes. Of all
//! masses that give a depth those nearest to equal ones are mᵢ = m̄ Σ cₖ ψₖ(Xᵢ), and of all velocities that give a momentum those of the least
//! kinetic energy are Vᵢ = Σ aₖ ψₖ(Xᵢ). Both coefficients solve a symmetric positive system on the nodes, by conjugate gradients.

use super::flow::MeshFlow;
use super::reference::{Smoothing, mesh_splines};
use super::start::set_mean_depth;
use crate::document::{MeshFields, Problems, brief};
use crate::families::{Checked, LARGEST_DEPTH, Model, ShallowWater};
use crate::state::{Reported, State};

/// Where iterations end: at this distance from the fields, in mean depths and in the largest velocity.
const TOLERANCE: f64 = 1e-7;
const MOST_ITERATIONS: usize = 500;
/// The distance that a start may have from the fields, in mean depths and in the largest velocity: that of integer masses and velocities
/// is below a hundredth of it.
const LARGEST_DISTANCE: f64 = 1e-4;

/// Gives particles at their places masses and, where the fields have velocities, velocities.
pub(super) fn carry(water: &ShallowWater, state: &mut State, fields: &MeshFields, model: &Model) {
    let carriers = water.carriers as usize;
    if carriers == 0 || fields.depth.len() as u64 != water.nodes() {
        return;
    }
    let smoothing = smoothing(water, model);
    let mean = water.nodes() as f64 / carriers as f64;
    let positions = std::mem::take(&mut state.positions);
    let places = Places { water, positions: &positions };
    let deviation: Vec<f64> = fields.depth.iter().map(|depth| depth - 1.0).collect();
    let unsmoothed: Vec<f64> = smoothing.undo(&deviation).iter().map(|deviation| 1.0 + deviation).collect();
    let is_near = |rest: &[f64]| largest(&smoothing.apply(rest)) <= TOLERANCE;
    let share = |of: &[f64]| places.spread(|particle| mean * places.gather(of, particle));
    let depths = solved(&share, &unsmoothed, unsmoothed.clone(), &is_near);
    // No particle has less than nothing, or more than integers hold: what that costs is measured in `check`.
    let units = |particle: usize| {
        let depth = places.gather(&depths, particle).clamp(0.0, LARGEST_DEPTH);
        (mean * depth / water.mass_unit).round_ties_even() as u32
    };
    for (particle, mass) in state.masses[..carriers].iter_mut().enumerate() {
        *mass = units(particle);
    }
    set_mean_depth(&mut state.masses[..carriers], water);
    if let Some(velocity) = &fields.velocity {
        let masses: Vec<f64> = state.masses.iter().map(|units| f64::from(*units) * water.mass_unit).collect();
        let depth = places.spread(|particle| masses[particle]);
        let share = |of: &[f64]| places.spread(|particle| masses[particle] * places.gather(of, particle));
        let fastest = velocity.iter().map(|component| largest(component)).fold(0.0, f64::max);
        let is_near =
            |rest: &[f64]| rest.iter().zip(&depth).all(|(rest, depth)| rest.abs() <= TOLERANCE * fastest * depth);
        for (axis, component) in velocity.iter().enumerate() {
            let momentum: Vec<f64> = component.iter().zip(&depth).map(|(velocity, depth)| velocity * depth).collect();
            let of_nodes = solved(&share, &momentum, component.clone(), &is_near);
            for (particle, momentum) in state.momenta.iter_mut().enumerate() {
                let velocity = places.gather(&of_nodes, particle);
                momentum[axis] = (velocity / model.units.momentum).round_ties_even() as i32;
            }
        }
    }
    state.positions = positions;
}

/// Refuses fields that the particles of a scene cannot have.
pub(super) fn check(
    water: &ShallowWater,
    scene: &Checked,
    state: &State,
    fields: &MeshFields,
    problems: &mut Problems,
) {
    if water.carriers == 0 {
        return;
    }
    if fields.depth.len() as u64 != water.nodes() {
        let found = format!("fields on {} nodes", fields.depth.len());
        problems.refuse("state.file", found, format!("fields on the {} nodes of the scene", water.nodes()));
        return;
    }
    let [depth, velocity] = distances(water, scene.model(), state, fields);
    let accepted = format!(
        "at most {LARGEST_DISTANCE}: fields that vary over several nodes, on a `lattice` of four particles a node or more, where the depth before \
         smoothing is above 0 and up to {LARGEST_DEPTH}"
    );
    // NaN is no distance.
    for (what, unit, distance) in [("depth", "the mean depth", depth), ("velocity", "the largest velocity", velocity)] {
        if distance.is_nan() || distance > LARGEST_DISTANCE {
            let found = format!(
                "a {what} on the nodes that no masses and velocities of these particles have: they miss it by {} of {unit}",
                brief(distance)
            );
            problems.refuse("state.file", found, accepted.clone());
        }
    }
}

/// How far the fields of a start are from those of a file, at most: in mean depths, and in the largest velocity.
pub(super) fn distances(water: &ShallowWater, model: &Model, state: &State, fields: &MeshFields) -> [f64; 2] {
    let flow = MeshFlow::new(model, water, &Reported::from(state.clone()));
    let deviation: Vec<f64> = flow.masses().iter().map(|mass| mass - 1.0).collect();
    let depth = smoothing(water, model).apply(&deviation);
    let apart = |a: &[f64], b: &[f64]| {
        // NaN is further than anything.
        a.iter()
            .zip(b)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, |most: f64, apart| if apart <= most { most } else { apart })
    };
    let depth = apart(&depth, &fields.depth.iter().map(|depth| depth - 1.0).collect::<Vec<_>>());
    let velocity = fields.velocity.as_ref().map_or(0.0, |velocity| {
        let fastest = velocity.iter().map(|component| largest(component)).fold(f64::MIN_POSITIVE, f64::max);
        flow.velocity().iter().zip(velocity).map(|(found, asked)| apart(found, asked) / fastest).fold(0.0, f64::max)
    });
    [depth, velocity]
}

fn smoothing(water: &ShallowWater, model: &Model) -> Smoothing {
    Smoothing::new(water, [model.units.lengths[0], model.units.lengths[1]])
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Particles at places on the mesh.
struct Places<'a> {
    water: &'a ShallowWater,
    positions: &'a [[u32; 3]],
}

impl Places<'_> {
    /// Calls a function for every node that a particle reaches, with the value of its spline.
    fn reach(&self, particle: usize, mut at: impl FnMut(usize, f64)) {
        let columns = self.water.mesh[0] as usize;
        let [along_x, along_y] = mesh_splines(self.water, self.positions[particle]);
        for (row, weight_y) in along_y.nodes.iter().zip(along_y.weights) {
            for (column, weight_x) in along_x.nodes.iter().zip(along_x.weights) {
                at(column + row * columns, weight_x * weight_y);
            }
        }
    }

    /// Σ fₖ ψₖ(X) of values on the nodes.
    fn gather(&self, of: &[f64], particle: usize) -> f64 {
        let mut sum = 0.0;
        self.reach(particle, |node, weight| sum += weight * of[node]);
        sum
    }

    /// Σ wᵢ ψₖ(Xᵢ) over all that carry water.
    fn spread(&self, weight: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.water.nodes() as usize];
        for particle in 0..self.water.carriers as usize {
            let of_particle = weight(particle);
            self.reach(particle, |node, weight| sums[node] += weight * of_particle);
        }
        sums
    }
}

/// The solution of a symmetric positive system by conjugate gradients, from a first guess.
fn solved(
    matrix: &dyn Fn(&[f64]) -> Vec<f64>,
    wanted: &[f64],
    mut solution: Vec<f64>,
    is_near: &dyn Fn(&[f64]) -> bool,
) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut rest: Vec<f64> = wanted.iter().zip(matrix(&solution)).map(|(wanted, found)| wanted - found).collect();
    let mut direction = rest.clone();
    let mut square = dot(&rest, &rest);
    for _ in 0..MOST_ITERATIONS {
        if is_near(&rest) {
            break;
        }
        let image = matrix(&direction);
        let step = square / dot(&direction, &image);
        // Nothing is left but rounding.
        if !step.is_finite() || step <= 0.0 {
            break;
        }
        for index in 0..rest.len() {
            solution[index] += step * direction[index];
            rest[index] -= step * image[index];
        }
        let before = std::mem::replace(&mut square, dot(&rest, &rest));
        for (direction, rest) in direction.iter_mut().zip(&rest) {
            *direction = rest + square / before * *direction;
        }
    }
    solution
}
