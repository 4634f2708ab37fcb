//! What a report says of baths that remember, against the float64 reference of the same state: which of them count, and how they go with
//! momenta and displacements.

use mesoscope::measure::Observables;
use mesoscope::plan::Options;
use serde_json::{Value, json};

use crate::support::{SideBySide, observables, reference_of_particles, scene, start, units_of_a_step};

/// Two species with baths, one of which may be held or coupled to nothing.
fn document(edges: &[f64], interactions: &Value, held: bool) -> Value {
    json!({
        "title": "baths",
        "seed": 5,
        "space": {"box": edges},
        "time": {"step": 0.05, "steps": 1},
        "temperature": 1,
        "integrator": {"type": "cotter-reich"},
        "particles": [
            {"species": "light", "count": 90, "placement": {"type": "random"}},
            {"species": "heavy", "count": 60, "mass": 2.5, "fixed": held, "placement": {"type": "random"}}],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

fn sums(row: &Observables) -> [f64; 5] {
    let products = row.bath_products;
    [row.bath_energy, row.bath_square, products.momentum, products.displacement, products.momentum_displacement]
}

#[test]
fn reports_of_baths_agree_with_the_reference() {
    let memory = json!({"type": "memory", "rate": 3});
    let tether = json!({"type": "tether", "stiffness": 7});
    let all = json!({"type": "langevin", "friction": 2, "bath": memory});
    let some =
        json!({"type": "langevin", "friction": 2, "bath": memory, "species": [{"name": "heavy", "friction": 0}]});
    let pushed = json!({"type": "body-force", "force": [1.5, -0.5]});
    let pairs = json!({"type": "dpd", "friction": 3, "bath": memory, "pairs": [
        {"between": ["light", "light"], "repulsion": 0, "friction": 0}]});
    let boxes: [&[f64]; 3] = [&[40.0], &[7.0, 6.0], &[4.0, 5.0, 4.5]];
    let mut cases = Vec::new();
    for edges in boxes {
        for langevin in [&all, &some] {
            for held in [false, true] {
                cases.push((document(edges, &json!([tether, langevin]), held), true));
                cases.push((document(edges, &json!([langevin]), held), false));
            }
        }
    }
    // Nothing that can move has a bath.
    let none =
        json!({"type": "langevin", "friction": 0, "bath": memory, "species": [{"name": "heavy", "friction": 2}]});
    let unheeded = document(boxes[1], &json!([tether, none]), true);
    cases.push((document(boxes[1], &json!([tether, some, pushed]), false), true));
    cases.push((document(boxes[1], &json!([tether, all, pairs]), false), true));
    cases.push((document(boxes[2], &json!([pairs]), false), false));
    let none_moves = cases.len();
    cases.push((unheeded, false));
    for (place, (document, oscillates)) in cases.into_iter().enumerate() {
        let scene = scene(&document.to_string());
        let (model, state) = start(&scene);
        let mut both = SideBySide::new(scene.clone(), model, &state, Options::default());
        both.steps(4, units_of_a_step(false), &document.to_string(), |_, _, _| {});
        let [found, expected] = [observables(&mut both.device, &scene), both.reference.observe()].map(|row| sums(&row));
        // Sums of some hundred terms in single precision.
        for (number, (found, expected)) in found.into_iter().zip(expected).enumerate() {
            assert!(
                (found - expected).abs() < 1e-4 * expected.abs().max(1.0),
                "{number}: {found}, {expected}\n{document:#}"
            );
            assert_eq!(
                found != 0.0,
                place != none_moves && number < 2 || oscillates,
                "{number}: {found}\n{document:#}"
            );
        }
    }
}

/// Baths with memory and random forces are kicks of split steps, closing and opening, and advance once a step: with one
/// and two stages of friction of pairs, with pairs that are visited once, with none, and beside baths in O.
#[test]
fn split_steps_beside_memory_and_random_forces_agree_with_the_reference() {
    let memory = json!({"type": "memory", "rate": 3});
    let tether = json!({"type": "tether", "stiffness": 7});
    let slow = json!({"type": "langevin", "friction": 2, "bath": memory});
    let white = json!({"type": "langevin", "friction": 2});
    // A stronger noise would need units of forces in which the squares of these are rounded.
    let noise = json!({"type": "coloured-noise", "strength": 1, "time": 0.1});
    let dpd = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let repulsive = json!({"type": "dpd", "repulsion": 25});
    let dense = json!({"type": "dpd", "repulsion": -10, "friction": 4.5, "many_body": {"repulsion": 6}});
    let spring = json!({"type": "harmonic", "stiffness": 40, "length": 0.5});
    let ends = json!([[0, 1], [1, 100], [149, 3]]);
    let remembering = json!({"type": "bonds", "pairs": ends, "potential": spring, "friction": 3, "bath": memory});
    let rubbing = json!({"type": "bonds", "pairs": ends, "potential": spring, "friction": 3});
    let one = json!({"type": "splitting", "relaxation": "mean-field"});
    let two = json!({"type": "splitting", "relaxation": "two-stages"});
    let cases = [
        (&one, json!([dpd, slow, tether])),
        (&two, json!([dpd, slow])),
        (&one, json!([dpd, noise])),
        (&two, json!([dpd, noise, remembering])),
        (&one, json!([dpd, remembering])),
        (&one, json!([dense, remembering, slow])),
        (&one, json!([repulsive, white, remembering, noise])),
        (&one, json!([repulsive, slow, rubbing, tether])),
        (&one, json!([white, noise, remembering])),
        (&one, json!([slow, rubbing])),
    ];
    for (number, (integrator, interactions)) in cases.into_iter().enumerate() {
        let edges: &[f64] = if number % 2 == 0 { &[7.0, 6.0] } else { &[4.0, 5.0, 4.5] };
        let mut document = document(edges, &interactions, number % 3 == 2);
        document["integrator"] = integrator.clone();
        document["time"]["step"] = json!(0.01);
        let scene = scene(&document.to_string());
        let (model, state) = start(&scene);
        assert!(model.particles().splits());
        let mut both = SideBySide::new(scene.clone(), model.clone(), &state, Options::default());
        let what = document.to_string();
        both.steps(4, units_of_a_step(false), &what, |_, _, _| {});
        // Of the very same state.
        both.reference = reference_of_particles(model, both.device.state().unwrap());
        let [found, expected] = both.energies(&what).map(|row| sums(&row));
        let remembers = interactions.to_string().contains("memory");
        for (number, (found, expected)) in found.into_iter().zip(expected).enumerate() {
            assert!((found - expected).abs() < 1e-4 * expected.abs().max(1.0), "{number}: {found}, {expected}\n{what}");
        }
        assert_eq!(found[0] != 0.0, remembers, "{what}");
    }
}

/// Before the first step baths and momenta are those that are drawn, whatever else has a bath: so is the mean of their products.
#[test]
fn products_are_means_over_the_coordinates_of_oscillators() {
    let tether = json!({"type": "tether", "stiffness": 7});
    let langevin = json!({"type": "langevin", "friction": 2, "bath": {"type": "memory", "rate": 3}});
    let pairs = json!({"type": "dpd", "repulsion": 0, "friction": 3, "bath": {"type": "memory", "rate": 3}});
    let product = |interactions: Value| {
        let scene = scene(&document(&[6.0, 5.0], &interactions, false).to_string());
        let (model, state) = start(&scene);
        let mut both = SideBySide::new(scene.clone(), model, &state, Options::default());
        let found = observables(&mut both.device, &scene).bath_products.momentum;
        let expected = both.reference.observe().bath_products.momentum;
        assert!((found - expected).abs() < 1e-5 && found != 0.0, "{found}, {expected}");
        assert_eq!((state.position_baths.len(), state.momenta.len()), (150, 150));
        let of = |particle: usize, axis: usize| {
            let bath = f64::from(f32::from_bits(state.position_baths[particle][axis]));
            bath * f64::from(state.momenta[particle][axis]) * both.model.units.momentum
        };
        let sum: f64 = (0..150).flat_map(|particle| [0, 1].map(|axis| of(particle, axis))).sum();
        assert!((found - sum / 300.0).abs() < 1e-5, "{found}, {}", sum / 300.0);
        found
    };
    let [alone, beside] = [json!([tether, langevin]), json!([tether, langevin, pairs])].map(product);
    assert!((alone - beside).abs() < 1e-5, "{alone}, {beside}");
}
