//! Scenes from absolute zero to great heat, for each kind of force: integer momenta have room for what the forces do, however
//! cold it is, and resolve it.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use mesoscope::model::Model;
use mesoscope::reference::{CouplingsReference, Reference, Unstable};
use mesoscope::scene::{self, Scene, placement};
use serde_json::{Value, json};

const TEMPERATURES: [f64; 9] = [0.0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0, 1e2];

/// Momenta that a run takes.
const ROOM: u32 = 1 << 30;

/// Interactions of chains or of single particles, with the largest momentum of a particle of mass 1 that they make from rest.
fn cases() -> Vec<(&'static str, Value, f64)> {
    let bonds = |potential: Value| json!({"type": "bonds", "friction": 1, "potential": potential});
    let harmonic =
        |stiffness: f64, length: f64| bonds(json!({"type": "harmonic", "stiffness": stiffness, "length": length}));
    vec![
        ("repulsion", json!([{"type": "dpd", "repulsion": 25, "friction": 4.5}]), 2.0),
        (
            "repulsion and memory",
            json!([{"type": "dpd", "repulsion": 25, "friction": 4.5, "bath": {"type": "memory", "rate": 10}}]),
            2.0,
        ),
        ("bonds", json!([harmonic(1.0, 0.0)]), 0.1),
        ("stiff bonds", json!([harmonic(400.0, 0.7)]), 1.0),
        ("weak bonds", json!([harmonic(1e-6, 0.0)]), 1e-7),
        ("bonds at rest", json!([harmonic(1.0, 1.0)]), 0.0),
        ("finite bonds", json!([bonds(json!({"type": "fene", "stiffness": 30, "extent": 1.5}))]), 1.0),
        ("angles", json!([harmonic(10.0, 1.0), {"type": "angles", "stiffness": 5}]), 0.3),
        ("tethers", json!([{"type": "tether", "stiffness": 10}, {"type": "langevin", "friction": 1}]), 0.0),
        ("a driven bath", json!([{"type": "langevin", "friction": 1, "bath": {"type": "memory", "rate": 3}}]), 0.0),
        (
            "coloured noise",
            json!([{"type": "coloured-noise", "strength": 4, "time": 0.2}, {"type": "langevin", "friction": 1}]),
            0.3,
        ),
    ]
}

fn scene_of(interactions: &Value, temperature: f64) -> Scene {
    let text = json!({
        "title": "cold", "seed": 5, "space": {"box": [8, 8, 8]}, "time": {"step": 0.01, "steps": 80}, "temperature": temperature,
        "particles": [{"species": "A", "count": 120, "chain": {"beads": 12}}], "interactions": interactions,
    });
    scene::parse("cold", &text.to_string(), &[]).unwrap()
}

/// The largest momentum after some steps and on the way, in units, and the momentum of a unit. Great heat may tear bonds of
/// finite length apart, and then it is that until there.
fn largest(interactions: &Value, temperature: f64) -> (u32, f64) {
    let scene = scene_of(interactions, temperature);
    let model = Model::new(&scene);
    let unit = model.units.momentum;
    let state = placement::initial_state(&scene, &model);
    let of = |momenta: &[[i32; 3]]| momenta.iter().flatten().map(|units| units.unsigned_abs()).max().unwrap();
    let mut most = of(&state.momenta);
    if model.is_coupled() {
        let mut run = CouplingsReference::new(model, state);
        for _ in 0..80 {
            match run.step() {
                Ok(()) => {}
                Err(Unstable::Bond { .. }) if temperature >= 1.0 => break,
                Err(problem) => panic!("{interactions}, kT = {temperature}: {problem:?}"),
            }
            most = most.max(of(&run.state().momenta));
        }
    } else {
        let mut run = Reference::new(model, state);
        for _ in 0..80 {
            run.step().unwrap();
            most = most.max(of(&run.state().momenta));
        }
    }
    (most, unit)
}

#[test]
fn momenta_fit_and_are_resolved_at_any_temperature() {
    for (name, interactions, from_rest) in cases() {
        for temperature in TEMPERATURES {
            let (most, unit) = largest(&interactions, temperature);
            let momentum = f64::from(most) * unit;
            println!("{name}, kT = {temperature:e}: {most} units of {unit:e}");
            // What forces and heat make of the momenta is in them.
            assert!(most < ROOM, "{name}, kT = {temperature}: {most}");
            assert!(momentum >= from_rest, "{name}, kT = {temperature}: {momentum}");
            assert!(momentum >= 2.0 * temperature.sqrt(), "{name}, kT = {temperature}: {momentum}");
            // Unless nothing moves at all, the largest momentum has ten bits.
            assert!(from_rest == 0.0 && temperature == 0.0 || most > 1 << 10, "{name}, kT = {temperature}: {most}");
        }
    }
}

/// Where heat rules, the unit follows it alone: runs keep their bytes.
#[test]
fn heat_rules_the_unit_where_it_is_larger_than_what_forces_do() {
    for (name, interactions, _) in cases().into_iter().filter(|(name, ..)| *name != "coloured noise") {
        for temperature in [1.0, 4.0, 100.0] {
            let unit = Model::new(&scene_of(&interactions, temperature)).units.momentum;
            assert_eq!(unit, (temperature.sqrt().log2().ceil() - 24.0).exp2(), "{name}");
        }
    }
}
