//! How Voronoi cells start: masses, momenta and energies, once their places are known.

use super::checks::LIGHTEST;
use crate::document::{Generator, InitialMasses, Problems, Scene, Velocities};
use crate::families::start::bring_to_rest;
use crate::families::{Checked, Voronoi};
use crate::noise::{self, stream};
use crate::state::State;
use crate::tessellation::Tessellation;
use std::f64::consts::TAU;

/// Gives cells at their places what they start with.
///
/// Thermal momenta follow the mass and the temperature of each cell, a shear wave its mass and place. The net momentum of
/// all cells with either is zero to the last bit.
pub(crate) fn fill(state: &mut State, scene: &Checked, cells: &Voronoi) {
    let model = scene.model();
    let temperatures = temperatures(state, scene);
    state.masses = masses(state, scene, cells).into_iter().map(|units| units as u32).collect();
    let mass = |masses: &[u32], id: usize| f64::from(masses[id]) * cells.mass_unit;
    let to_units = |momentum: f64| (momentum / model.units.momentum).round_ties_even() as i32;
    let key = noise::step_key(model.seed, stream::VELOCITY, 0);
    let mut moving = Vec::new();
    let mut first = 0;
    for group in &scene.particles {
        let ids = first..first + group.resolved_count(&scene.space) as usize;
        first = ids.end;
        if matches!(group.velocities, Velocities::Thermal | Velocities::ShearWave { .. }) {
            moving.push(ids.clone());
        }
        for id in ids.clone() {
            let mass = mass(&state.masses, id);
            let velocity: [f64; 2] = match &group.velocities {
                Velocities::Thermal | Velocities::ShearWave { .. } => {
                    let width = (temperatures[id] / mass).sqrt();
                    let mut velocity = [0, 1].map(|axis| {
                        width * noise::gaussian(noise::words(Generator::Threefry2x32, key, [id as u32, axis]))
                    });
                    if let Velocities::ShearWave { amplitude, periods } = group.velocities {
                        let phase = f64::from(state.positions[id][1]) / 4_294_967_296.0 * f64::from(periods);
                        velocity[0] += amplitude * (TAU * phase).sin();
                    }
                    velocity
                }
                Velocities::Listed { velocities } => {
                    let listed = velocities.get(id - ids.start);
                    [0, 1].map(|axis| listed.and_then(|velocity| velocity.get(axis)).copied().unwrap_or(0.0))
                }
                Velocities::Rest | Velocities::Geostrophic => [0.0; 2],
            };
            state.momenta[id] = [to_units(mass * velocity[0]), to_units(mass * velocity[1]), 0];
        }
    }
    let own_masses = state.masses.clone();
    bring_to_rest(state, &moving, model.units.dimension, |id| mass(&own_masses, id));
    if cells.keeps_energy() {
        let energy = |id: usize| {
            let mass = mass(&state.masses, id);
            let squares: f64 = model.units.momentum(state.momenta[id]).iter().map(|part| part * part).sum();
            let internal = mass / cells.molecular_mass * temperatures[id];
            ((internal + squares / (2.0 * mass)) / cells.energy_unit).round_ties_even() as i32
        };
        state.energies = (0..state.len()).map(energy).collect();
    }
}

/// Temperature kT of every cell at the start: that of the last region around it, or of the scene.
fn temperatures(state: &State, scene: &Checked) -> Vec<f64> {
    let model = scene.model();
    let regions =
        scene.system.voronoi().and_then(|voronoi| voronoi.energy.as_ref()).map(|energy| &energy.initial_temperatures);
    let temperature = |position: &[u32; 3]| {
        let around = regions.into_iter().flatten().rfind(|region| {
            let centre = model.units.fraction([region.center[0], region.center[1], 0.0]);
            let [x, y, _] = model.units.displacement(*position, centre);
            x.hypot(y) < region.radius
        });
        around.map_or(scene.temperature, |region| region.temperature)
    };
    state.positions.iter().map(temperature).collect()
}

/// Masses of all cells in integer units, as real numbers that are whole: their sum is that of the groups to the last unit.
fn masses(state: &State, scene: &Checked, cells: &Voronoi) -> Vec<f64> {
    let model = scene.model();
    let units = |mass: f64| (mass / cells.mass_unit).round_ties_even();
    let groups = scene.particles.iter();
    let counted = groups.map(|group| (group.resolved_count(&scene.space) as usize, units(group.mass)));
    if cells.initial_masses == InitialMasses::Equal {
        return counted.flat_map(|(count, mass)| std::iter::repeat_n(mass, count)).collect();
    }
    let total: f64 = counted.map(|(count, mass)| count as f64 * mass).sum();
    let lengths = [model.units.lengths[0], model.units.lengths[1]];
    let tessellation = Tessellation::of_fractions(lengths, &state.positions);
    let volumes = tessellation.cells.iter().map(|cell| cell.volume);
    let shares: Vec<f64> = if cells.initial_masses == InitialMasses::UniformPressure {
        // pV = NkT of N = M/m molecules.
        volumes.zip(temperatures(state, scene)).map(|(volume, temperature)| volume / temperature).collect()
    } else {
        volumes.collect()
    };
    let scale = total / shares.iter().sum::<f64>();
    let mut masses: Vec<f64> = shares.iter().map(|share| (share * scale).round_ties_even()).collect();
    // What rounding has left over is at most half a unit a cell.
    let left = total - masses.iter().sum::<f64>();
    for mass in masses.iter_mut().take(left.abs() as usize) {
        *mass += left.signum();
    }
    masses
}

/// Masses that follow from the volumes of cells have to be such as the integers can hold.
pub(super) fn check_masses(scene: &Scene, cells: &Voronoi, masses: &[u32], problems: &mut Problems) {
    let Some(voronoi) = scene.system.voronoi().filter(|voronoi| voronoi.initial_masses != InitialMasses::Equal) else {
        return;
    };
    let [low, high] = [LIGHTEST * 2_f64.powi(24), f64::from(u32::MAX)];
    // What is beyond the range of integers is at its end.
    let fits = |mass: u32| f64::from(mass) >= low && mass < u32::MAX;
    let Some(cell) = masses.iter().position(|mass| !fits(*mass)) else { return };
    let name = if voronoi.initial_masses == InitialMasses::UniformDensity { "density" } else { "pressure" };
    let mass = f64::from(masses[cell]) * cells.mass_unit;
    let most = if masses[cell] == u32::MAX { " or more" } else { "" };
    let found =
        format!("`uniform-{name}`, with a mass of {mass:.3e}{most} by the volume of the cell of particle {cell}");
    let accepted = format!(
        "masses between {:.1e} and {:.1e}: a more even placement, as a lattice, or `equal` masses",
        low * cells.mass_unit,
        high * cells.mass_unit
    );
    problems.refuse("interactions[0].initial_masses", found, accepted);
}

/// Refuses cells with energy that start in one place: what passes between them has no bound, however short the step.
pub(super) fn check_places(cells: &Voronoi, state: &State, problems: &mut Problems) {
    if !cells.keeps_energy() {
        return;
    }
    let mut places: Vec<(&[u32; 3], usize)> = state.positions.iter().zip(0..).collect();
    places.sort_unstable();
    let Some(pair) = places.windows(2).find(|pair| pair[0].0 == pair[1].0) else { return };
    let accepted = "cells some distance apart: the heat and work that pass between two in one place have no bound";
    problems.refuse("particles", format!("cells {} and {} in one place", pair[0].1, pair[1].1), accepted);
}
