//! Electrostatics on the device: against the float64 reference, step by step, and against what is exact.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::fmt::Write as _;

use crate::support::{
    INTEGRATORS, engine, largest_difference, observables, reference, same_observables, start, units_of_a_step,
};

/// Charged beads in water, with a polymer of charges and further interactions.
fn salt(edges: [f64; 3], integrator: &str, electrostatics: &Value, others: &[Value]) -> Checked {
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    let charges = json!({"type": "electrostatics", "bjerrum_length": 1.1});
    let charges: serde_json::Map<String, Value> = charges
        .as_object()
        .unwrap()
        .iter()
        .chain(electrostatics.as_object().unwrap())
        .map(|(key, value)| (key.clone(), value.clone()))
        .collect();
    let dpd = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let interactions = [&[dpd, Value::from(charges)], others].concat();
    crate::support::scene(
        &json!({
            "title": "salt", "seed": 5, "space": {"box": edges}, "time": {"step": 0.02, "steps": 1}, "temperature": 1.2,
            "integrator": integrator,
            "particles": [
                {"species": "cation", "count": 20, "charge": 1.5, "mass": 2},
                {"species": "water", "count": 300},
                {"species": "chain", "count": 30, "charge": -1, "chain": {"beads": 10, "spacing": 0.7}}],
            "interactions": interactions,
            "output": {"energies": {"every": 1}},
        })
        .to_string(),
    )
}

fn bonds(bath: &Value) -> Value {
    json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 60, "length": 0.7}, "friction": 3.0, "bath": bath})
}

fn check(scene: &Checked, what: &str) {
    let (_, state) = start(scene);
    let mut device = engine(scene, &state, Options::default());
    let mut reference = reference(scene, &state);
    for step in 1..=3 {
        device.advance(1, 1).unwrap();
        reference.step().unwrap();
        let found = device.state().unwrap();
        let (momentum, position) = largest_difference(&found, reference.state());
        let units = units_of_a_step(false);
        assert!(momentum <= units * step, "step {step}: momenta differ by {momentum} units ({what})");
        assert!(position <= 4 * units * step, "step {step}: positions differ by {position} units ({what})");
        if scene.model().conserves_momentum() {
            assert_eq!(found.total_momentum(), state.total_momentum(), "momentum moved ({what})");
        }
    }
    let (found, expected) = (observables(&mut device, scene), reference.observe().unwrap());
    same_observables(&found, &expected, 0.0, &[what]);
    let [a, b] = [found, expected].map(|observables| observables.from_body_forces);
    assert_eq!(a.momentum, b.momentum, "{what}");
    assert!((a.work - b.work).abs() < 1e-4 * (1.0 + b.work.abs()), "{what}: {} {}", a.work, b.work);
}

/// Charges of a file, whose species follow in no order, in copies of its box.
#[test]
fn charges_of_copies_are_those_of_their_species() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("state.xyz");
    let mut text = String::from("24\nLattice=\"4 0 0 0 5 0 0 0 4.5\" Properties=species:S:1:pos:R:3\n");
    for index in 0..24_u32 {
        let species = ["W", "P", "M", "M", "W", "P", "W", "W"][(index * 5 % 8) as usize];
        let at = [7, 11, 13].map(|step| f64::from(index * step % 24) / 24.0);
        writeln!(text, "{species} {:.4} {:.4} {:.4}", 4.0 * at[0], 5.0 * at[1], 4.5 * at[2]).unwrap();
    }
    std::fs::write(&file, text).unwrap();
    let scene = crate::support::scene(
        &json!({
            "title": "copies", "space": {"box": [8, 5, 9]}, "time": {"step": 0.01, "steps": 1}, "temperature": 1,
            "integrator": {"type": "cotter-reich"},
            "state": {"file": file, "replicate": [2, 1, 2], "velocities": "thermal"},
            "particles": [{"species": "W"}, {"species": "P", "charge": 1.5}, {"species": "M", "charge": -1.5}],
            "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5},
                {"type": "electrostatics", "bjerrum_length": 1.1},
                {"type": "bonds", "pairs": [[1, 26], [25, 52], [30, 77]], "exclude_charges": true}],
            "output": {"energies": {"every": 1}},
        })
        .to_string(),
    );
    assert_eq!(scene.model().particle_count(), 96);
    check(&scene, "copies");
}

/// Bonds that exclude the charges of their ends: along chains, of two species, far apart, twice, and of what has no charge.
#[test]
fn excluded_charges_are_those_of_the_reference() {
    let along = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 60, "length": 0.7}, "exclude_charges": true});
    let listed = json!({"type": "bonds", "pairs": [[3, 17], [0, 345], [321, 320], [5, 100], [40, 41]],
        "exclude_charges": true});
    for integrator in INTEGRATORS {
        let bonds = [along.clone(), listed.clone()];
        let scene = salt([5.0, 6.0, 5.5], integrator, &json!({}), &bonds);
        check(&scene, &format!("excluded, {integrator}"));
        // Excluded charges count.
        let (_, state) = start(&scene);
        let [with, without] = [&scene, &salt([5.0, 6.0, 5.5], integrator, &json!({}), &[])]
            .map(|scene| reference(scene, &state).observe().unwrap().electrostatic_energy);
        assert!(with < without - 5.0, "{with} {without}");
    }
    check(&salt([5.0; 3], INTEGRATORS[0], &json!({}), std::slice::from_ref(&listed)), "excluded pairs alone");
    let slater = json!({"decay": 0.929, "spacing": 0.3});
    check(&salt([5.0; 3], INTEGRATORS[0], &slater, &[along, listed]), "excluded charges of Slater");
}

/// Fields that are constant and that oscillate, also where nothing else acts on charges.
#[test]
fn fields_are_those_of_the_reference() {
    let constant = json!({"type": "electric-field", "field": [1.5, -0.3, 0.2]});
    let oscillating = json!({"type": "electric-field", "field": [1.5, -0.3, 0.2], "frequency": 4.9});
    for field in [&constant, &oscillating] {
        for integrator in [INTEGRATORS[0], INTEGRATORS[3]] {
            check(
                &salt([5.0; 3], integrator, &json!({}), std::slice::from_ref(field)),
                &format!("{integrator}, {field}"),
            );
        }
    }
    let mut alone =
        serde_json::to_value(&*salt([5.0; 3], INTEGRATORS[0], &json!({}), std::slice::from_ref(&oscillating))).unwrap();
    alone["interactions"].as_array_mut().unwrap().remove(1);
    let alone = crate::support::scene(&alone.to_string());
    assert!(alone.model().particles().electrostatics.is_none());
    check(&alone, "a field alone");
}

/// An oscillating field gives a free charge the velocity qE sin(ωt)/mω, whatever the number of the step.
#[test]
fn an_oscillating_field_moves_charges_to_and_fro() {
    let scene = crate::support::scene(
        &json!({
            "title": "field", "space": {"box": [5, 5, 5]}, "time": {"step": 0.01, "steps": 1}, "temperature": 1,
            "integrator": {"type": "cotter-reich"},
            "particles": [{"species": "ion", "count": 4, "charge": -2, "mass": 0.5, "velocities": {"type": "rest"}}],
            "interactions": [{"type": "electric-field", "field": [0.0, 3.0, 0.0], "frequency": 0.5}],
            "output": {"energies": {"every": 1}},
        })
        .to_string(),
    );
    let (_, state) = start(&scene);
    let mut device = engine(&scene, &state, Options::default());
    for step in (50..=400).step_by(50) {
        device.advance(50, 25).unwrap();
        let observables = observables(&mut device, &scene);
        let expected = 4.0 * -2.0 * 3.0 * (TAU * 0.5 * 0.01 * f64::from(step)).sin() / (TAU * 0.5);
        assert!((observables.momentum[1] - expected).abs() < 2e-3, "{step}: {} {expected}", observables.momentum[1]);
        assert!((observables.kinetic_energy - observables.from_body_forces.work).abs() < 2e-4 * 40.0, "{step}");
    }
}

#[test]
fn steps_are_those_of_the_reference() {
    for integrator in INTEGRATORS {
        check(&salt([5.0, 6.0, 5.5], integrator, &json!({}), &[]), integrator);
    }
    for (electrostatics, edges) in [
        (json!({"order": 4}), [5.0, 5.0, 5.0]),
        (json!({"spacing": 0.25, "width": 0.4}), [5.0, 5.0, 4.0]),
        (json!({"spacing": 0.3, "width": 1.2}), [7.0, 5.0, 4.0]),
        (json!({"spacing": 0.3, "decay": 0.929}), [5.0, 5.0, 4.0]),
        (json!({"method": "waves"}), [5.0, 5.0, 4.0]),
        (json!({"method": "waves", "decay": 0.929, "spacing": 0.3, "background": true}), [5.0, 4.0, 4.0]),
        (json!({"background": true, "bjerrum_length": 20.0}), [5.0, 5.0, 5.0]),
    ] {
        check(&salt(edges, INTEGRATORS[0], &electrostatics, &[]), &electrostatics.to_string());
    }
    for bath in [json!({"type": "white"}), json!({"type": "memory", "rate": 2.0})] {
        check(&salt([5.0; 3], INTEGRATORS[3], &json!({}), &[bonds(&bath)]), &format!("bonds, {bath}"));
        check(&salt([5.0; 3], INTEGRATORS[0], &json!({}), &[bonds(&bath)]), &format!("split bonds, {bath}"));
    }
}
