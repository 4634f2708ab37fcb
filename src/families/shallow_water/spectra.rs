//! Energy and enstrophy of the flow on the nodes, by shells of wave numbers.
//!
//! Each is a sum over the nodes of a product of two fields, and by Parseval's theorem one over their Fourier modes:
//!
//! ```text
//! kinetic energy        ½ Σ h̃ (u² + v²)        √h̃ u and √h̃ v with themselves
//! potential energy      ½ c₀² Σ (h̃ - 1)(h - 1)
//! potential enstrophy   ½ Σ h ((ζ + f₀)/h)²    (ζ + f₀)/√h with itself
//! enstrophy             ½ Σ ζ²
//! ```

use super::flow::MeshFlow;
use super::reference::Smoothing;
use crate::families::{Model, ShallowWater, WaveShell};
use crate::state::Reported;
use rustfft::num_complex::Complex;
use std::f64::consts::TAU;

/// The width of a shell, which has a mode of every axis: the wave number of one wave along the shorter edge.
fn width(model: &Model) -> f64 {
    TAU / model.units.lengths[0].min(model.units.lengths[1])
}

/// The shell of every mode, in the order of transforms.
fn shell_of_modes(water: &ShallowWater, model: &Model) -> Vec<usize> {
    let waves = |axis: usize| {
        let nodes = water.mesh[axis];
        // Modes beyond the middle are those of negative wave numbers.
        (0..nodes).map(move |index| f64::from(index.min(nodes - index)) * TAU / model.units.lengths[axis])
    };
    let along_y: Vec<f64> = waves(1).collect();
    let width = width(model);
    waves(0).flat_map(|x| along_y.iter().map(move |y| (x.hypot(*y) / width).round() as usize)).collect()
}

/// Wave numbers and numbers of modes of all shells, of which the first is the mean.
pub(super) fn shells(water: &ShallowWater, model: &Model) -> Vec<WaveShell> {
    let mut modes: Vec<u64> = Vec::new();
    for shell in shell_of_modes(water, model) {
        modes.resize(modes.len().max(shell + 1), 0);
        modes[shell] += 1;
    }
    let shell = |(place, modes)| WaveShell { wave_number: place as f64 * width(model), modes };
    modes.into_iter().enumerate().map(shell).collect()
}

/// Kinetic and potential energy, potential enstrophy and enstrophy of every shell.
pub(super) fn of_state(water: &ShallowWater, model: &Model, state: &Reported) -> Vec<[f64; 4]> {
    let smoothing = Smoothing::new(water, [model.units.lengths[0], model.units.lengths[1]]);
    let flow = MeshFlow::new(model, water, state);
    let masses = flow.masses();
    let unsmoothed: Vec<f64> = masses.iter().map(|mass| mass - 1.0).collect();
    let smoothed = smoothing.apply(&unsmoothed);
    let vorticity = flow.vorticity();
    let weighted = |component: &[f64]| -> Vec<f64> {
        component.iter().zip(&masses).map(|(velocity, mass)| mass.sqrt() * velocity).collect()
    };
    let [along_x, along_y] = flow.velocity().map(|component| weighted(&component));
    let potential = vorticity.iter().zip(&smoothed).map(|(zeta, h)| (zeta + water.rotation) / (1.0 + h).sqrt());
    let modes = |field: &[f64]| smoothing.modes(field);
    let potential = modes(&potential.collect::<Vec<_>>());
    let [along_x, along_y, unsmoothed, smoothed, vorticity] =
        [&along_x, &along_y, &unsmoothed, &smoothed, &vorticity].map(|field| modes(field));
    let product = |a: &Complex<f64>, b: &Complex<f64>| 0.5 * (a * b.conj()).re / masses.len() as f64;
    let mut shells = vec![[0.0; 4]; self::shells(water, model).len()];
    for (mode, shell) in shell_of_modes(water, model).into_iter().enumerate() {
        let of = |field: &[Complex<f64>]| product(&field[mode], &field[mode]);
        let found = [
            of(&along_x) + of(&along_y),
            water.wave_speed.powi(2) * product(&unsmoothed[mode], &smoothed[mode]),
            of(&potential),
            of(&vorticity),
        ];
        shells[shell].iter_mut().zip(found).for_each(|(sum, found)| *sum += found);
    }
    shells
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::initial_state;
    use crate::families::reference::ShallowWaterReference;
    use crate::scene;

    fn flow(surface: &str, further: &[&str]) -> (Model, Reported) {
        let changes = [
            "interactions.0.mesh=[32,16]",
            "interactions.0.smoothing.length=0.4",
            "particles.0.count=8192",
            &format!("interactions.0.surface={surface}"),
        ];
        let changes: Vec<String> = changes.iter().chain(further).map(|change| (*change).to_owned()).collect();
        let scene = scene::load("shallow-water", &changes).unwrap();
        (scene.model().clone(), initial_state(&scene).into())
    }

    /// The sums over all shells are those over all nodes, after steps that have mixed the water too.
    #[test]
    fn shells_add_up_to_the_whole() {
        let bump = r#"[{"type":"bump","center":[3,3],"radius":0.6,"amplitude":0.2}]"#;
        let (model, state) = flow(bump, &[]);
        let water = model.shallow_water().unwrap();
        let start = crate::state::State {
            positions: state.positions.clone(),
            momenta: state.momenta.clone(),
            masses: state.masses.clone(),
            species: state.species.clone(),
            ..crate::state::State::default()
        };
        let mut reference = ShallowWaterReference::new(model.clone(), start).unwrap();
        reference.run(20).unwrap();
        let state = reference.reported_state().unwrap();
        let shells = of_state(water, &model, &state);
        let total = |place: usize| shells.iter().map(|shell| shell[place]).sum::<f64>();
        let flow = MeshFlow::new(&model, water, &state);
        let (masses, depth, vorticity) = (flow.masses(), reference.depth(), flow.vorticity());
        let sum = |of: &dyn Fn(usize) -> f64| 0.5 * (0..masses.len()).map(of).sum::<f64>();
        let [u, v] = flow.velocity();
        let exact = [
            sum(&|node| masses[node] * (u[node].powi(2) + v[node].powi(2))),
            reference.observe().unwrap().potential_energy,
            sum(&|node| (vorticity[node] + water.rotation).powi(2) / depth[node]),
            sum(&|node| vorticity[node].powi(2)),
        ];
        for (place, exact) in exact.into_iter().enumerate() {
            assert!(exact > 0.0 && (total(place) / exact - 1.0).abs() < 1e-10, "{place}: {} {exact}", total(place));
        }
        // What the particles of a node have of motion against each other is not of the flow.
        assert!(total(0) < reference.observe().unwrap().kinetic_energy);
        let modes: u64 = self::shells(water, &model).iter().map(|shell| shell.modes).sum();
        assert_eq!(modes, 32 * 16);
    }

    /// A plane wave is in the shell of its wave number, along either axis of a box that is no square.
    #[test]
    fn a_plane_wave_is_in_its_shell() {
        for (periods, expected) in [("[0,2]", 2), ("[4,0]", 2), ("[6,4]", 5)] {
            let wave = format!(r#"[{{"type":"wave","periods":{periods},"amplitude":0.01}}]"#);
            let (model, state) = flow(&wave, &["space.box=[12.566370614359172,6.283185307179586]"]);
            let water = model.shallow_water().unwrap();
            let shells = of_state(water, &model, &state);
            for place in [0, 1, 3] {
                let total: f64 = shells.iter().map(|shell| shell[place]).sum();
                assert!(total > 0.0 && shells[expected][place] > 0.99 * total, "{periods} {place}: {shells:?}");
            }
            assert!((self::shells(water, &model)[expected].wave_number - expected as f64).abs() < 1e-12);
        }
    }
}
