//! The device against the float64 reference, step by step from the same state with the same random words.
//!
//! Both round impulses to 2⁻²⁴ of the thermal momentum and positions to 2⁻³² of the box. Single precision adds a relative
//! error of some 2⁻²³ to an impulse of at most about 2²³ units, so one step may differ by a few units for each of some
//! dozen pairs; a hundred units (`support::units_of_a_step`) allow for that and for little else: the noise of a step is ten
//! thousand times larger.
//! That holds on every driver, for `tests/extremes/edge_of_error.rs` makes functions err as much as they may.

use mesoscope::families::reference::Reference;
use mesoscope::plan::{Options, Traversal};

use crate::support::{
    engine, fluid, largest_difference, observables, predictions_agree, reference, start, units_of_a_step,
};

fn check(changes: &[&str], options: Options) {
    let scene = fluid(changes);
    let (_, state) = start(&scene);
    let mut device = engine(&scene, &state, options);
    let mut reference = reference(&scene, &state);
    let powers = changes.iter().any(|change| change.starts_with("interactions.0.weight_exponent"));
    let units = units_of_a_step(powers);
    for step in 1..=3 {
        device.advance(1, 1).unwrap();
        reference.step().unwrap();
        let found = device.state().unwrap();
        let (momentum, position) = largest_difference(&found, reference.state());
        assert!(momentum <= units * step, "step {step}: momenta differ by {momentum} units ({changes:?})");
        // In these boxes a unit of momentum moves a particle up to four units of position a step.
        assert!(position <= 4 * units * step, "step {step}: positions differ by {position} units ({changes:?})");
        assert_eq!(found.total_momentum(), state.total_momentum(), "momentum moved ({changes:?})");
        if !found.predicted.is_empty() {
            predictions_agree(&found, reference.state());
            reference = Reference::new(reference.model().clone(), found);
        }
    }
    let measured = observables(&mut device, &scene);
    let expected = reference.observe().unwrap();
    for (name, a, b) in [
        ("kinetic energy", measured.kinetic_energy, expected.kinetic_energy),
        ("potential energy", measured.potential_energy, expected.potential_energy),
        ("conservative virial", measured.conservative_virial, expected.conservative_virial),
        ("virial", measured.total_virial, expected.total_virial),
        ("gradient", measured.gradient_squared, expected.gradient_squared),
        ("laplacian", measured.laplacian, expected.laplacian),
    ] {
        let scale = b.abs().max(expected.kinetic_energy.abs()).max(1e-3);
        assert!((a - b).abs() <= 2e-4 * scale, "{name}: {a} on the device, {b} in the reference ({changes:?})");
    }
    assert_eq!(measured.momentum, expected.momentum, "({changes:?})");
}

const EVERY_STEP: &str = "output.energies.every=1";
const TWO_DIMENSIONS: &str = "space.box=[9,7]";
const SPLITTING: &str = r#"integrator={"type":"splitting"}"#;
const LEAPFROG: &str = r#"integrator={"type":"groot-warren"}"#;
const PREDICTED: &str = r#"integrator={"type":"groot-warren","lambda":0.65}"#;
const DISCRETE: &str = r#"integrator={"type":"cotter-reich"}"#;
const MIXTURE: &str =
    r#"particles=[{"species":"A","number_density":2,"mass":1},{"species":"B","number_density":1,"mass":2.5}]"#;
const MIXTURE_FORCE: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,"pairs":[{"between":["A","B"],"repulsion":40,"friction":9},{"between":["B","B"],"repulsion":0}]}]"#;

fn both(changes: &[&str]) {
    for traversal in [Some(Traversal::Rows), None] {
        check(&[changes, &[EVERY_STEP]].concat(), Options { traversal, ..Options::default() });
    }
}

#[test]
fn splitting() {
    both(&[SPLITTING]);
    both(&[SPLITTING, TWO_DIMENSIONS]);
    both(&[SPLITTING, MIXTURE, MIXTURE_FORCE]);
    both(&[SPLITTING, MIXTURE, MIXTURE_FORCE, TWO_DIMENSIONS]);
    both(&[SPLITTING, "interactions.0.repulsion=0"]);
    both(&[SPLITTING, "interactions.0.friction=0"]);
    both(&[SPLITTING, "interactions.0.friction=1e-6"]);
    both(&[SPLITTING, "interactions.0.friction=200"]);
    both(&[SPLITTING, "temperature=0", r#"particles.0.velocities={"type":"rest"}"#]);
    both(&[SPLITTING, "space.box=[2,2,2]", r#"particles=[{"species":"A","count":100}]"#, "time.step=0.002"]);
}

#[test]
fn a_report_changes_nothing() {
    let scene = fluid(&[SPLITTING, EVERY_STEP]);
    let silent = fluid(&[SPLITTING, "output.energies.every=1000"]);
    let (_, state) = start(&scene);
    let mut often = engine(&scene, &state, Options::default());
    let mut never = engine(&silent, &state, Options::default());
    often.advance(20, 4).unwrap();
    never.advance(20, 4).unwrap();
    assert_eq!(often.state().unwrap(), never.state().unwrap());
}

#[test]
fn groot_warren() {
    both(&[LEAPFROG]);
    both(&[LEAPFROG, TWO_DIMENSIONS]);
}

#[test]
fn groot_warren_with_prediction() {
    both(&[PREDICTED]);
    both(&[PREDICTED, TWO_DIMENSIONS]);
}

#[test]
fn cotter_reich() {
    both(&[DISCRETE]);
    both(&[DISCRETE, TWO_DIMENSIONS]);
}

#[test]
fn species_with_their_own_mass_and_coefficients() {
    for integrator in [LEAPFROG, PREDICTED, DISCRETE] {
        both(&[integrator, MIXTURE, MIXTURE_FORCE]);
    }
}

#[test]
fn general_weight_exponent() {
    both(&[LEAPFROG, "interactions.0.weight_exponent=1"]);
    both(&[DISCRETE, "interactions.0.weight_exponent=3"]);
}

#[test]
fn every_generator_and_distribution() {
    both(&[LEAPFROG, r#"noise={"generator":"threefry2x32-20"}"#]);
    both(&[LEAPFROG, r#"noise={"distribution":"gaussian"}"#]);
    both(&[LEAPFROG, r#"noise={"generator":"threefry2x32-20","distribution":"gaussian"}"#]);
}

#[test]
fn forces_left_out() {
    both(&[LEAPFROG, "interactions.0.repulsion=0"]);
    both(&[LEAPFROG, "interactions.0.friction=0"]);
    both(&[LEAPFROG, "temperature=0", r#"particles.0.velocities={"type":"rest"}"#]);
    both(&[LEAPFROG, "interactions=[]"]);
}

/// Boxes of two and three cutoffs exactly, and very long ones, are in `extremes`.
#[test]
fn boxes_of_every_shape() {
    for lengths in ["[2.5,3.5,6]", "[2,11,4]", "[40,2.2,2.2]", "[3,17]", "[30,2.9]"] {
        both(&[LEAPFROG, &format!("space.box={lengths}")]);
    }
}

#[test]
fn few_particles() {
    for count in [0, 1, 2, 3] {
        both(&[LEAPFROG, &format!(r#"particles=[{{"species":"A","count":{count}}}]"#)]);
    }
}

#[test]
fn dense_and_coincident_particles() {
    both(&[LEAPFROG, "space.box=[2,2,2]", r#"particles=[{"species":"A","count":400}]"#, "time.step=0.002"]);
    both(&[
        LEAPFROG,
        r#"particles=[{"species":"A","placement":{"type":"listed","positions":[[1,1,1],[1,1,1],[1.5,1,1]]}}]"#,
    ]);
}

#[test]
fn the_step_counter_has_two_words() {
    let scene = fluid(&[LEAPFROG, EVERY_STEP]);
    let (_, mut state) = start(&scene);
    state.step = u64::from(u32::MAX) - 1;
    let units = units_of_a_step(false);
    let mut device = engine(&scene, &state, Options::default());
    let mut reference = reference(&scene, &state);
    for step in 1..=4 {
        device.advance(1, 1).unwrap();
        reference.step().unwrap();
        let (momentum, position) = largest_difference(&device.state().unwrap(), reference.state());
        assert!(momentum <= units * step && position <= 4 * units * step);
    }
    assert_eq!(device.finish().unwrap().last().unwrap().step, u64::from(u32::MAX) + 3);
}
