//! The device against the float64 reference, step by step from the same state with the same random words.
//!
//! Both round impulses to 2⁻²⁴ of the thermal momentum and positions to 2⁻³² of the box. Single precision adds a relative
//! error of some 2⁻²³ to an impulse of at most about 2²³ units, so one step may differ by a few units for each of some
//! dozen pairs; a hundred units (`support::units_of_a_step`) allow for that and for little else: the noise of a step is ten
//! thousand times larger.
//! That holds on every driver, for `tests/extremes/edge_of_error.rs` makes functions err as much as they may.

use mesoscope::families::reference::Reference;
use mesoscope::plan::Options;

use crate::support::{
    COTTER_REICH, EVERY_STEP, GROOT_WARREN, MIXTURE, PREDICTED, SPLITTING, STAGED, engine, fluid, largest_difference,
    observables, predictions_agree, reference, same_observables, start, traversals, units_of_a_step,
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
    same_observables(&observables(&mut device, &scene), &reference.observe().unwrap(), 0.0, changes);
}

const TWO_DIMENSIONS: &str = "space.box=[9,7]";
const MIXTURE_FORCE: &str = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,"pairs":[{"between":["A","B"],"repulsion":40,"friction":9},{"between":["B","B"],"repulsion":0}]}]"#;

/// With every way to visit pairs.
fn both(changes: &[&str]) {
    (0..traversals().len()).for_each(|number| in_turn(number, changes));
}

/// With one of the ways: another one for the next `number`.
fn in_turn(number: usize, changes: &[&str]) {
    let traversals = traversals();
    let traversal = Some(traversals[number % traversals.len()]);
    check(&[changes, &[EVERY_STEP]].concat(), Options { traversal, ..Options::default() });
}

#[test]
fn splitting() {
    both(&[SPLITTING]);
    both(&[SPLITTING, TWO_DIMENSIONS]);
    both(&[SPLITTING, MIXTURE, MIXTURE_FORCE]);
    both(&[SPLITTING, MIXTURE, MIXTURE_FORCE, TWO_DIMENSIONS]);
    both(&[SPLITTING, "space.box=[2,2,2]", r#"particles=[{"species":"A","count":100}]"#, "time.step=0.002"]);
    in_turn(0, &[SPLITTING, "interactions.0.repulsion=0"]);
    in_turn(1, &[SPLITTING, "interactions.0.friction=0"]);
    in_turn(0, &[SPLITTING, "interactions.0.friction=1e-6"]);
    in_turn(1, &[SPLITTING, "interactions.0.friction=200"]);
    in_turn(0, &[SPLITTING, "temperature=0", r#"particles.0.velocities={"type":"rest"}"#]);
}

#[test]
fn splitting_in_two_stages() {
    both(&[STAGED]);
    both(&[STAGED, MIXTURE, MIXTURE_FORCE, TWO_DIMENSIONS]);
    in_turn(0, &[STAGED, MIXTURE, MIXTURE_FORCE]);
    in_turn(1, &[STAGED, "space.box=[2,2,2]", r#"particles=[{"species":"A","count":100}]"#, "time.step=0.002"]);
    in_turn(0, &[STAGED, "interactions.0.repulsion=0", "interactions.0.friction=1e-6"]);
    in_turn(1, &[STAGED, "interactions.0.friction=500"]);
    // Rates whose sums need a larger unit.
    in_turn(0, &[STAGED, "interactions.0.friction=1e4", "time.step=0.02"]);
    in_turn(0, &[STAGED, "temperature=0", r#"particles.0.velocities={"type":"rest"}"#]);
}

#[test]
fn a_report_changes_nothing() {
    for integrator in [SPLITTING, STAGED] {
        let scene = fluid(&[integrator, EVERY_STEP]);
        let silent = fluid(&[integrator, "output.energies.every=1000"]);
        let (_, state) = start(&scene);
        let mut often = engine(&scene, &state, Options::default());
        let mut never = engine(&silent, &state, Options::default());
        often.advance(20, 4).unwrap();
        never.advance(20, 4).unwrap();
        assert_eq!(often.state().unwrap(), never.state().unwrap());
    }
}

#[test]
fn groot_warren() {
    both(&[GROOT_WARREN]);
    both(&[GROOT_WARREN, TWO_DIMENSIONS]);
}

#[test]
fn groot_warren_with_prediction() {
    both(&[PREDICTED]);
    both(&[PREDICTED, TWO_DIMENSIONS]);
}

#[test]
fn cotter_reich() {
    both(&[COTTER_REICH]);
    both(&[COTTER_REICH, TWO_DIMENSIONS]);
}

#[test]
fn species_with_their_own_mass_and_coefficients() {
    for integrator in [GROOT_WARREN, PREDICTED, COTTER_REICH] {
        both(&[integrator, MIXTURE, MIXTURE_FORCE]);
    }
}

#[test]
fn general_weight_exponent() {
    in_turn(0, &[GROOT_WARREN, "interactions.0.weight_exponent=1"]);
    in_turn(1, &[COTTER_REICH, "interactions.0.weight_exponent=3"]);
}

#[test]
fn every_generator_and_distribution() {
    both(&[GROOT_WARREN, r#"noise={"generator":"threefry2x32-20"}"#]);
    both(&[GROOT_WARREN, r#"noise={"distribution":"gaussian"}"#]);
    both(&[GROOT_WARREN, r#"noise={"generator":"threefry2x32-20","distribution":"gaussian"}"#]);
}

#[test]
fn forces_left_out() {
    in_turn(1, &[GROOT_WARREN, "interactions.0.repulsion=0"]);
    in_turn(0, &[GROOT_WARREN, "interactions.0.friction=0"]);
    in_turn(1, &[GROOT_WARREN, "temperature=0", r#"particles.0.velocities={"type":"rest"}"#]);
    both(&[GROOT_WARREN, "interactions=[]"]);
}

/// Boxes of two and three cutoffs exactly, and very long ones, are in `extremes`.
#[test]
fn boxes_of_every_shape() {
    for lengths in ["[2.5,3.5,6]", "[2,11,4]", "[40,2.2,2.2]", "[3,17]", "[30,2.9]"] {
        both(&[GROOT_WARREN, &format!("space.box={lengths}")]);
    }
}

#[test]
fn few_particles() {
    for count in [0, 1, 2, 3] {
        both(&[GROOT_WARREN, &format!(r#"particles=[{{"species":"A","count":{count}}}]"#)]);
    }
}

#[test]
fn dense_and_coincident_particles() {
    both(&[GROOT_WARREN, "space.box=[2,2,2]", r#"particles=[{"species":"A","count":400}]"#, "time.step=0.002"]);
    both(&[
        GROOT_WARREN,
        r#"particles=[{"species":"A","placement":{"type":"listed","positions":[[1,1,1],[1,1,1],[1.5,1,1]]}}]"#,
    ]);
}

#[test]
fn the_step_counter_has_two_words() {
    let scene = fluid(&[GROOT_WARREN, EVERY_STEP]);
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
