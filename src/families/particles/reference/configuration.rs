//! Sums over particles, pairs, bonds, angles, tethers and baths at the report point.
//!
//! The virial is that of pairs and bonds. Angles have none: cos θ does not change when all arms are stretched alike, so that
//! Σ r·F = 0. Tethers and baths of coordinates pull at points in space and add nothing to the pressure between particles.
//! The configurational temperature is that of the particles that can move.

use super::Images;
use super::held;
use super::pairs::Pair;
use super::potential::Potential;
use crate::families::{Model, Observables};
use crate::state::State;

/// Sums of the potential and its derivatives, and the particles that they are of.
pub(crate) struct Configuration<'a> {
    pub model: &'a Model,
    pub state: &'a State,
    pub images: &'a Images<'a>,
    pub potential: f64,
    /// The part of it that charges have.
    pub electrostatic: f64,
    pub virial: f64,
    pub gradients: Vec<[f64; 3]>,
    pub laplacians: Vec<f64>,
    pub dimension: usize,
    /// True of each particle that is held, and has no part of virials.
    held: Vec<bool>,
}

impl<'a> Configuration<'a> {
    /// All sums over a state.
    fn new(model: &'a Model, state: &'a State, images: &'a Images<'a>) -> Self {
        let count = state.len();
        let mut sums = Self {
            model,
            state,
            images,
            potential: 0.0,
            electrostatic: 0.0,
            virial: 0.0,
            gradients: vec![[0.0; 3]; count],
            laplacians: vec![0.0; count],
            dimension: model.units.dimension,
            held: (0..count).map(|particle| held::is_held(model, state, particle)).collect(),
        };
        for term in model.particles().terms() {
            term.observe(&mut sums);
        }
        sums
    }

    /// The part of what a pair adds that belongs to ends that can move.
    pub(crate) fn mobile_share(&self, pair: &Pair) -> f64 {
        0.5 * [pair.first, pair.second].into_iter().filter(|end| !self.held[*end]).count() as f64
    }

    /// Adds the potential of a pair or a bond.
    pub(crate) fn add(&mut self, pair: &Pair, potential: &Potential) {
        self.potential += potential.energy;
        self.virial += self.mobile_share(pair) * potential.virial(pair.distance);
        let gradient = potential.gradient(pair);
        let laplacian = potential.laplacian(pair.distance, self.dimension);
        for (end, sign) in [(pair.first, 1.0), (pair.second, -1.0)] {
            self.laplacians[end] += laplacian;
            for axis in 0..3 {
                self.gradients[end][axis] += sign * gradient[axis];
            }
        }
    }
}

/// What is observed of the motion, with what is observed of the configuration of a state.
pub(super) fn of_configuration(model: &Model, state: &State, images: &Images<'_>, motion: &Observables) -> Observables {
    let configuration = Configuration::new(model, state, images);
    let mobile = |particle: &usize| !configuration.held[*particle];
    let squares = |particle: usize| configuration.gradients[particle].iter().map(|slope| slope * slope).sum::<f64>();
    Observables {
        potential_energy: configuration.potential,
        electrostatic_energy: configuration.electrostatic,
        gradient_squared: (0..state.len()).filter(mobile).map(squares).sum(),
        laplacian: (0..state.len()).filter(mobile).map(|particle| configuration.laplacians[particle]).sum(),
        conservative_virial: configuration.virial,
        ..*motion
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::super::Reference;
    use super::*;
    use crate::families::Checked;
    use crate::families::Family;

    use serde_json::json;

    /// Particles at arbitrary places with every potential there is between them, one of them fixed.
    fn crowd(dimension: usize) -> Reference {
        let positions: Vec<Vec<f64>> = (0..6_u32)
            .map(|id| (0..dimension as u32).map(|axis| 2.0 + 0.4 * f64::from((id * (3 + axis) + axis) % 7)).collect())
            .collect();
        let scene = serde_json::from_value(json!({
            "title": "test", "space": {"box": vec![8.0; dimension]}, "time": {"step": 0.01, "steps": 1},
            "temperature": 0.0, "integrator": {"type": "cotter-reich"},
            "particles": [
                {"species": "A", "placement": {"type": "listed", "positions": positions[..5]},
                    "velocities": {"type": "listed", "velocities": vec![vec![1.0; dimension]; 5]}},
                {"species": "B", "fixed": true, "placement": {"type": "listed", "positions": positions[5..]}}],
            "interactions": [
                {"type": "dpd", "cutoff": 2.5, "repulsion": 25.0},
                {"type": "bonds", "pairs": [[0, 1], [2, 1], [3, 5]], "exclude_repulsion": true,
                    "potential": {"type": "harmonic", "stiffness": 30.0, "length": 0.7}},
                {"type": "bonds", "pairs": [[1, 4]], "potential": {"type": "fene", "stiffness": 20.0, "extent": 9.0}},
                {"type": "angles", "triples": [[0, 1, 2], [4, 3, 5], [0, 5, 1]], "stiffness": 6.0},
                {"type": "tether", "stiffness": 4.0}],
        }))
        .unwrap();
        let scene = Checked::presumed(scene);
        let mut state = crate::families::initial_state(&scene);
        for (id, tether) in state.tethers.iter_mut().enumerate() {
            tether[0] = tether[0].wrapping_add(10_000_000 * id as u32);
        }
        Reference::new(scene.model().clone(), state)
    }

    /// The squares of the slopes of the potential and its Laplacian, from differences, summed over some particles, of which those that are held
    /// do not move and do not count. The impulses of a step without heat have to be those of these slopes.
    fn differences_of_the_potential(reference: &Reference, particles: usize, held: &[usize]) -> [f64; 2] {
        let dimension = reference.model.units.dimension;
        let here = reference.observe().unwrap();
        let shift = 50_000_u32;
        let length = 2.0 * f64::from(shift) * 8.0 / 4_294_967_296.0;
        let (mut squares, mut laplacian) = (0.0, 0.0);
        let mut after = reference.clone();
        after.step().unwrap();
        for id in 0..particles {
            for axis in 0..dimension {
                let energy = |shift: u32| {
                    let mut moved = reference.clone();
                    moved.state.positions[id][axis] = moved.state.positions[id][axis].wrapping_add(shift);
                    moved.observe().unwrap().potential_energy
                };
                let [less, more] = [energy(shift.wrapping_neg()), energy(shift)];
                let slope = (more - less) / length;
                let kick = f64::from(after.state.momenta[id][axis]) - f64::from(reference.state.momenta[id][axis]);
                let kick = kick * reference.model.units.momentum;
                if held.contains(&id) {
                    assert_eq!(after.state.momenta[id], [0; 3], "what is held does not move");
                    continue;
                }
                assert!(
                    (kick + 0.005 * slope).abs() < 1e-5 * slope.abs().max(1.0),
                    "{dimension} {id} {axis}: {kick}, slope {slope}"
                );
                squares += slope * slope;
                laplacian += (more - 2.0 * here.potential_energy + less) / (0.5 * length).powi(2);
            }
        }
        [squares, laplacian]
    }

    #[test]
    fn derivatives_are_those_of_the_potential() {
        for dimension in 1..=3 {
            let reference = crowd(dimension);
            let here = reference.observe().unwrap();
            let [squares, laplacian] = differences_of_the_potential(&reference, 6, &[5]);
            assert!((here.gradient_squared / squares - 1.0).abs() < 1e-6, "{dimension}: {squares}");
            assert!((here.laplacian / laplacian - 1.0).abs() < 1e-4, "{dimension}: {} {laplacian}", here.laplacian);
        }
    }

    /// The same of particles that attract each other and repel each other by their densities, within a range or not, and two in one place.
    fn drop(dimension: usize) -> Reference {
        let place = |id: u32, axis: u32| 2.0 + 0.25 * f64::from((id * (3 + axis) + axis) % 7);
        let mut positions: Vec<Vec<f64>> =
            (0..6_u32).map(|id| (0..dimension as u32).map(|axis| place(id, axis)).collect()).collect();
        positions[5] = positions[4].clone();
        let scene = serde_json::from_value(json!({
            "title": "test", "space": {"box": vec![8.0; dimension]}, "time": {"step": 0.01, "steps": 1},
            "temperature": 0.0, "integrator": {"type": "groot-warren"},
            "particles": [
                {"species": "A", "placement": {"type": "listed", "positions": positions},
                    "velocities": {"type": "listed", "velocities": vec![vec![1.0; dimension]; 6]}}],
            "interactions": [
                {"type": "dpd", "cutoff": 1.3, "repulsion": -40.0, "many_body": {"repulsion": 25.0, "cutoff": 0.9}}],
        }))
        .unwrap();
        let scene = Checked::presumed(scene);
        let state = crate::families::initial_state(&scene);
        Reference::new(scene.model().clone(), state)
    }

    #[test]
    fn derivatives_of_the_many_body_potential_are_its_own() {
        for dimension in 2..=3 {
            let reference = drop(dimension);
            let here = reference.observe().unwrap();
            // The last two are in one place, where the potential has a cusp.
            let [squares, laplacian] = differences_of_the_potential(&reference, 4, &[]);
            let images = Images::at_rest(&reference.model.units);
            let configuration = Configuration::new(&reference.model, &reference.state, &images);
            let found = configuration.gradients[..4].iter().flatten().map(|slope| slope * slope).sum::<f64>();
            assert!((found / squares - 1.0).abs() < 1e-6, "{dimension}: {found} {squares}");
            let found = configuration.laplacians[..4].iter().sum::<f64>();
            assert!((found / laplacian - 1.0).abs() < 1e-4, "{dimension}: {found} {laplacian}");
            let stretched = |factor: f64| {
                let mut stretched = reference.clone();
                for length in &mut stretched.model.units.lengths[..dimension] {
                    *length *= factor;
                }
                stretched.observe().unwrap().potential_energy
            };
            let slope = (stretched(1.0 + 1e-5) - stretched(1.0 - 1e-5)) / 2e-5;
            assert!((here.conservative_virial / -slope - 1.0).abs() < 1e-6, "{dimension}: {slope}");
            assert!((here.total_virial / here.conservative_virial - 1.0).abs() < 1e-12, "{dimension}");
        }
    }

    /// Σ r·F of pairs, bonds and angles is minus the derivative of the potential when everything is stretched.
    #[test]
    fn the_virial_is_that_of_a_stretched_box() {
        for dimension in 1..=3 {
            let mut reference = crowd(dimension);
            // Tethers pull at points in space, and held particles have no part in virials.
            for species in &mut reference.model.species {
                species.fixed = false;
            }
            if let Family::Particles(particles) = &mut reference.model.family {
                particles.tethers = None;
            }
            let energy = |factor: f64| {
                let mut stretched = reference.clone();
                for length in &mut stretched.model.units.lengths[..dimension] {
                    *length *= factor;
                }
                stretched.observe().unwrap().potential_energy
            };
            let slope = (energy(1.0 + 1e-5) - energy(1.0 - 1e-5)) / 2e-5;
            let found = reference.observe().unwrap();
            assert!((found.conservative_virial / -slope - 1.0).abs() < 1e-6, "{dimension}: {slope}");
            assert!((found.total_virial / found.conservative_virial - 1.0).abs() < 1e-12, "{dimension}");
        }
    }
}
