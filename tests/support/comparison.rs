//! How far two implementations may be apart after a step.

use std::sync::OnceLock;

use mesoscope::engine::Engine;
use mesoscope::families::Model;
use mesoscope::measure::Observables;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::self_test::{Function, errors_of_functions};
use mesoscope::state::State;

use super::{Implementation, engine, gpu, observables, reference_of_particles};

/// Pairs of a particle in the standard fluid, or some more.
const PAIRS: i64 = 25;
/// Units in the last place by which the impulse of a pair may be off, and so units of momentum: it is at most 2²³ of them or so.
const PLACES: i64 = 4;

/// Units of momentum by which a step of the standard fluid may differ from the reference. Where weights are powers, the impulses of
/// pairs are as wrong as these are on the adapter.
pub fn units_of_a_step(powers: bool) -> i64 {
    static OF_POWERS: OnceLock<i64> = OnceLock::new();
    let of_powers = || {
        let errors = errors_of_functions(gpu()).expect("a kernel");
        let power = errors.iter().find(|error| error.function == Function::Power).expect("all functions");
        assert!(power.of_allowed <= 1.0, "{power:?}");
        power.last_places.ceil() as i64
    };
    PAIRS * (PLACES + if powers { *OF_POWERS.get_or_init(of_powers) } else { 0 })
}

/// The device and the reference of particles, from one state with the same random words.
pub struct SideBySide {
    pub scene: Checked,
    pub model: Model,
    pub device: Engine<'static>,
    pub reference: Box<dyn Implementation>,
}

impl SideBySide {
    pub fn new(scene: Checked, model: Model, state: &State, options: Options) -> Self {
        let device = engine(&scene, state, options);
        let reference = reference_of_particles(model.clone(), state.clone());
        Self { scene, model, device, reference }
    }

    /// Takes steps, after each of which momenta differ by some units a step at most and positions by four times as many, as a unit of
    /// momentum moves a particle up to four units of position in the boxes of these tests. `also` compares more: it is given the number of
    /// the step, the device's state and the reference's.
    #[track_caller]
    pub fn steps(&mut self, steps: i64, units: i64, what: &str, mut also: impl FnMut(i64, &State, &State)) {
        for step in 1..=steps {
            self.device.advance(1, 1).unwrap();
            self.reference.step(1);
            let found = self.device.state().unwrap();
            let expected = self.reference.state();
            assert_eq!(found.step, expected.step);
            let (momentum, position) = largest_difference(&found, &expected);
            assert!(momentum <= units * step, "step {step}: momenta differ by {momentum} units {what}");
            assert!(position <= 4 * units * step, "step {step}: positions differ by {position} units {what}");
            also(step, &found, &expected);
            // Shifts of predictions are kept in few bits, and rounded the other way they would grow apart.
            if !found.predicted.is_empty() {
                predictions_agree(&found, &expected);
                self.reference = reference_of_particles(self.model.clone(), found);
            }
        }
    }

    /// That both find the same energies.
    #[track_caller]
    pub fn energies(&mut self, what: &str) -> [Observables; 2] {
        let measured = observables(&mut self.device, &self.scene);
        let expected = self.reference.observe();
        same_energies(&measured, &expected, 0.0, what);
        [measured, expected]
    }
}

/// That the predicted momenta of two implementations are the same, but for some whose shift, kept in few bits, lies just
/// between two of them.
pub fn predictions_agree(found: &State, expected: &State) {
    let shifts = |state: &State| -> Vec<[i64; 3]> {
        let pairs = state.predicted.iter().zip(&state.momenta);
        pairs
            .map(|(seen, momentum)| std::array::from_fn(|axis| i64::from(seen[axis]) - i64::from(momentum[axis])))
            .collect()
    };
    let (found, expected) = (shifts(found), shifts(expected));
    assert_eq!(found.len(), expected.len());
    for (particle, (a, b)) in found.iter().zip(&expected).enumerate() {
        let largest = b.iter().map(|units| units.abs()).max().unwrap();
        let difference = a.iter().zip(b).map(|(a, b)| (a - b).abs()).max().unwrap();
        assert!(difference <= largest / 15 + 100, "particle {particle}: shifts {a:?} and {b:?}");
    }
    let differing = found.iter().zip(&expected).filter(|(a, b)| a != b).count();
    assert!(differing * 20 <= found.len(), "{differing} of {} shifts differ", found.len());
}

/// Total momentum but for what body forces put in, mass and energy in integer units, of which the last two are zero where particles have none of their own.
pub fn totals(state: &State) -> ([i64; 3], i64, i64) {
    let masses = state.masses.iter().map(|units| i64::from(*units)).sum();
    let energies = state.energies.iter().map(|units| i64::from(*units)).sum();
    (state.exchanged_momentum(), masses, energies)
}

/// Observables of a fluid on the device are those of the reference of the very same state: momentum to the bit, the others as
/// [`same_energies`] has it.
#[track_caller]
pub fn same_observables(measured: &Observables, expected: &Observables, jump: f64, changes: &[&str]) {
    same_energies(measured, expected, jump, &format!("{changes:?}"));
    assert_eq!(measured.momentum, expected.momentum, "({changes:?})");
}

/// Energies, virials and derivatives of the potential on the device are those of the reference of the very same state to single
/// precision, and the Laplacian also to what single precision may make of `jump`, the second derivative at the cutoff. Bath energies
/// are zero in both where there are no baths.
#[track_caller]
pub fn same_energies(measured: &Observables, expected: &Observables, jump: f64, scene: &str) {
    for (name, a, b) in [
        ("kinetic energy", measured.kinetic_energy, expected.kinetic_energy),
        ("potential energy", measured.potential_energy, expected.potential_energy),
        ("electrostatic energy", measured.electrostatic_energy, expected.electrostatic_energy),
        ("conservative virial", measured.conservative_virial, expected.conservative_virial),
        ("virial", measured.total_virial, expected.total_virial),
        ("gradient", measured.gradient_squared, expected.gradient_squared),
        ("laplacian", measured.laplacian, expected.laplacian),
        ("bath energy", measured.bath_energy, expected.bath_energy),
        ("bath square", measured.bath_square, expected.bath_square),
    ] {
        let scale = b.abs().max(expected.kinetic_energy.abs()).max(1e-3);
        let allowed = 2e-4 * scale + if name == "laplacian" { jump } else { 0.0 };
        assert!((a - b).abs() <= allowed, "{name}: {a} on the device, {b} in the reference ({scene})");
    }
}

/// The largest difference of any momentum or position, in integer units.
pub fn largest_difference(a: &State, b: &State) -> (i64, i64) {
    assert_eq!(a.len(), b.len());
    let mut momentum = 0;
    let mut position = 0;
    for id in 0..a.len() {
        for axis in 0..3 {
            momentum = momentum.max((i64::from(a.momenta[id][axis]) - i64::from(b.momenta[id][axis])).abs());
            let shift = a.positions[id][axis].wrapping_sub(b.positions[id][axis]) as i32;
            position = position.max(i64::from(shift).abs());
        }
    }
    (momentum, position)
}

/// A suggested time step as messages have it.
pub fn step_in_words(step: f64) -> String {
    if step < 1e-4 { format!("{step:e}") } else { step.to_string() }
}
