//! Many-body dissipative particle dynamics: the device against the float64 reference, step by step, and both against the paper's formulas.

use std::f64::consts::PI;

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use serde_json::{Value, json};

use crate::support::{
    COTTER_REICH, Device, GROOT_WARREN, INTEGRATORS, Implementation, SideBySide, reference_of_particles, start,
    traversals, units_of_a_step,
};

const BOXES: [&[f64]; 2] = [&[9.0, 7.0], &[5.0, 4.0, 4.5]];

fn read(document: &Value) -> Checked {
    crate::support::scene(&document.to_string())
}

fn integrator_of(text: &str) -> Value {
    serde_json::from_str(text.strip_prefix("integrator=").unwrap()).unwrap()
}

fn liquid(edges: &[f64], integrator: &str, interactions: &Value, species: usize) -> Value {
    let volume: f64 = edges.iter().product();
    let groups = [
        json!({"species": "light", "count": (2.0 * volume) as u64}),
        json!({"species": "heavy", "count": volume as u64, "mass": 2.5}),
    ];
    json!({
        "title": "liquid",
        "seed": 3,
        "space": {"box": edges},
        "time": {"step": 0.01, "steps": 1},
        "temperature": 1,
        "integrator": integrator_of(integrator),
        "particles": groups[..species],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

fn single() -> Value {
    json!([{"type": "dpd", "repulsion": -40, "friction": 4.5, "many_body": {"repulsion": 25}}])
}

/// Species that attract each other unequally, within cutoffs of their own, of which one is shorter than that of the density.
fn mixed() -> Value {
    json!([{"type": "dpd", "repulsion": -40, "friction": 4.5, "many_body": {"repulsion": 25, "cutoff": 0.8}, "pairs": [
        {"between": ["heavy", "light"], "repulsion": 10, "cutoff": 0.7, "weight_exponent": 1},
        {"between": ["heavy", "heavy"], "repulsion": -30, "friction": 9}]}])
}

/// The device and the reference, step by step from the same state with the same random words; both round impulses to the same units.
fn agree(document: &Value, options: Options) {
    let scene = read(document);
    let (model, state) = start(&scene);
    let mut both = SideBySide::new(scene, model.clone(), &state, options);
    // Some pairs push each other with twenty times the force of the standard fluid, and both densities are rounded too.
    let units = 4 * units_of_a_step(document["interactions"][0]["pairs"].is_array());
    let what = format!("{document:#}");
    both.steps(3, units, &what, |step, found, _| {
        assert_eq!(found.exchanged_momentum(), state.exchanged_momentum(), "step {step}\n{document:#}");
    });
    // Of the very same state.
    both.reference = reference_of_particles(model, both.device.state().unwrap());
    both.energies(&what);
}

#[test]
fn every_integrator_agrees_with_the_reference() {
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        // Either box and either traversal, by turns.
        for (row, traversal) in traversals().into_iter().enumerate() {
            let (interactions, species) = [(single(), 1), (mixed(), 2)][(number + row) % 2].clone();
            let edges = BOXES[(number / 2 + row) % 2];
            let options = Options { traversal: Some(traversal), ..Options::default() };
            agree(&liquid(edges, integrator, &interactions, species), options);
        }
    }
}

/// Without a force of pairs, without friction, with bonds, a body force and walls; on the plans of the adapter and on
/// those for any.
#[test]
fn what_is_beside_it_agrees_with_the_reference() {
    let alone = json!([{"type": "dpd", "many_body": {"repulsion": 25, "cutoff": 0.9}}]);
    let cold = json!([{"type": "dpd", "repulsion": -40, "many_body": {"repulsion": 25}}]);
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let edges = BOXES[number % 2];
        let options = Options { serial_memory: (number % 2 == 1).then_some(false), ..Options::default() };
        agree(&liquid(edges, integrator, [&alone, &cold][number % 2], 1), options);
        // Of one species: with several, all of it binds more buffers than every adapter has.
        let mut driven = single();
        let beside = [
            json!({"type": "bonds", "pairs": [[0, 1], [1, 2]], "potential": {"type": "harmonic", "stiffness": 40}}),
            json!({"type": "body-force", "force": vec![1.5; edges.len()], "species": ["light"]}),
        ];
        let some = [&beside[..], &beside[1..]][number % 2];
        driven.as_array_mut().unwrap().extend_from_slice(some);
        let mut document = liquid(edges, integrator, &driven, 1);
        if number % 2 == 1 {
            document["space"]["walls"] = json!({"y": {}});
        }
        agree(&document, options);
    }
}

/// Friction along bonds with and without memory, gathered beside local densities: where steps are not split, with
/// forces apart from friction.
#[test]
fn baths_of_bonds_beside_it_agree_with_the_reference() {
    let spring = json!({"type": "harmonic", "stiffness": 40, "length": 0.5});
    for (number, integrator) in [COTTER_REICH, GROOT_WARREN].into_iter().enumerate() {
        for bath in [json!({"type": "white"}), json!({"type": "memory", "rate": 3})] {
            if integrator == GROOT_WARREN && bath["type"] == "memory" {
                continue;
            }
            let mut interactions = single();
            let bonds = json!({"type": "bonds", "pairs": [[0, 1], [1, 2], [4, 3]], "potential": spring, "friction": 3,
                "bath": bath});
            interactions.as_array_mut().unwrap().push(bonds);
            let options = Options { serial_memory: (number == 1).then_some(false), ..Options::default() };
            agree(&liquid(BOXES[number], integrator, &interactions, 1), options);
        }
    }
}

/// Of two particles at a distance r each has the other alone around it: ρ̄ = 15/(2πrd³) (1 - r/rd)², the self-energy πrd⁴Bρ̄²/30 and the
/// force B (ρ̄ + ρ̄) (1 - r/rd), beside those of the pair, a/2 (1 - r)² and a (1 - r).
#[test]
fn two_particles_have_the_energy_and_force_of_the_paper() {
    let (attraction, repulsion, range): (f64, f64, f64) = (-40.0, 25.0, 0.75);
    for (integrator, distance) in INTEGRATORS.iter().flat_map(|integrator| [(integrator, 0.3), (integrator, 0.8)]) {
        let at = |x: f64| [x, 3.5, 3.5];
        let document = json!({
            "title": "two particles",
            "space": {"box": [7, 7, 7]},
            "time": {"step": 0.01, "steps": 1},
            "temperature": 0,
            "integrator": integrator_of(integrator),
            "particles": [{"species": "A", "velocities": {"type": "rest"},
                "placement": {"type": "listed", "positions": [at(3.0), at(3.0 + distance)]}}],
            "interactions": [
                {"type": "dpd", "repulsion": attraction, "many_body": {"repulsion": repulsion, "cutoff": range}}],
            "output": {"energies": {"every": 1}},
        });
        let scene = read(&document);
        let closeness = (1.0 - distance / range).max(0.0);
        let density = 15.0 / (2.0 * PI * range.powi(3)) * closeness * closeness;
        let energy = 0.5 * attraction * (1.0 - distance).powi(2)
            + 2.0 * PI * range.powi(4) * repulsion * density * density / 30.0;
        let force = attraction * (1.0 - distance) + repulsion * 2.0 * density * closeness;
        let (model, state) = start(&scene);
        let device: Box<dyn Implementation> = Box::new(Device::new(&scene));
        for mut run in [device, reference_of_particles(model, state)] {
            let found = run.observe();
            let of_one = (found.gradient_squared / 2.0).sqrt();
            for (what, found, expected) in [
                ("energy", found.potential_energy, energy),
                ("force", of_one, force.abs()),
                ("virial", found.conservative_virial, force * distance),
            ] {
                // Impulses are rounded to a unit of momentum, densities to a millionth.
                let close = (found - expected).abs() < 1e-4 * expected.abs();
                assert!(close, "{}: {what} {found}, known {expected}\n{document:#}", run.name());
            }
        }
    }
}
