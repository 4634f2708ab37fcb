//! Pairs of species with a cutoff and a weight exponent of their own: the device against the float64 reference, step by step, and both
//! against the law.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use serde_json::{Value, json};

use crate::support::{
    Device, INTEGRATORS, Implementation, SideBySide, reference_of_particles, start, traversals, units_of_a_step,
};

const BOXES: [&[f64]; 3] = [&[61.0], &[9.0, 7.0], &[5.0, 4.0, 4.5]];
const COTTER_REICH: &str = INTEGRATORS[3];

fn read(document: &Value) -> Checked {
    crate::support::scene(&document.to_string())
}

fn fluid(edges: &[f64], integrator: &str, dpd: &Value, others: &[Value]) -> Value {
    let volume: f64 = edges.iter().product();
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    let interactions = [std::slice::from_ref(dpd), others].concat();
    json!({
        "title": "mixture",
        "seed": 3,
        "space": {"box": edges},
        "time": {"step": 0.01, "steps": 1},
        "temperature": 1,
        "integrator": integrator,
        "particles": [
            {"species": "light", "count": (2.0 * volume) as u64},
            {"species": "heavy", "count": volume as u64, "mass": 2.5}],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

/// Three cutoffs, the largest that of unlike particles, and either one exponent or three.
fn pairs(exponents: [f64; 3]) -> Value {
    let [common, unlike, light] = exponents;
    json!({
        "type": "dpd", "repulsion": 25, "friction": 4.5, "cutoff": 0.8, "weight_exponent": common,
        "pairs": [
            {"between": ["heavy", "light"], "cutoff": 1, "repulsion": 40, "friction": 9, "weight_exponent": unlike},
            {"between": ["light", "light"], "cutoff": 0.55, "weight_exponent": light}],
    })
}

const ONE_EXPONENT: [f64; 3] = [2.0; 3];
const THREE_EXPONENTS: [f64; 3] = [1.0, 3.0, 0.5];

/// The device and the reference, step by step from the same state with the same random words; both round impulses to the same units.
fn agree(document: &Value, options: Options) {
    let scene = read(document);
    let (model, state) = start(&scene);
    let mut both = SideBySide::new(scene, model, &state, options);
    let powers = document["interactions"][0]["weight_exponent"] != json!(2.0);
    let what = format!("{document:#}");
    both.steps(3, units_of_a_step(powers), &what, |_, _, _| {});
    both.energies(&what);
}

fn is_split(integrator: &str) -> bool {
    integrator.contains("splitting")
}

#[test]
fn every_integrator_agrees_with_the_reference() {
    for integrator in INTEGRATORS {
        for edges in &BOXES[1..] {
            for exponents in [ONE_EXPONENT, THREE_EXPONENTS] {
                let document = fluid(edges, integrator, &pairs(exponents), &[]);
                for traversal in traversals() {
                    agree(&document, Options { traversal: Some(traversal), ..Options::default() });
                }
                if !is_split(integrator) {
                    agree(&document, Options { listed: true, ..Options::default() });
                }
            }
        }
    }
}

/// Exponents alone, and cutoffs alone without repulsion or without friction.
#[test]
fn single_coefficients_agree_with_the_reference() {
    let exponent = json!({
        "type": "dpd", "repulsion": 25, "friction": 4.5, "weight_exponent": 2.5,
        "pairs": [{"between": ["heavy", "light"], "weight_exponent": 1}],
    });
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let edges = BOXES[1 + number % 2];
        agree(&fluid(edges, integrator, &exponent, &[]), Options::default());
        let mut cutoffs = pairs(ONE_EXPONENT);
        let without = ["repulsion", "friction"][number % 2];
        cutoffs[without] = json!(0);
        cutoffs["pairs"][0][without] = json!(0);
        agree(&fluid(edges, integrator, &cutoffs, &[]), Options::default());
    }
}

/// With bonds that spare their beads the repulsion, and with a body force, whose numbers lie in the same table.
#[test]
fn bonds_and_body_forces_beside_them_agree_with_the_reference() {
    let bonds = json!({"type": "bonds", "exclude_repulsion": true, "pairs": [[0, 1], [1, 2]],
        "potential": {"type": "harmonic", "stiffness": 40}});
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let edges = BOXES[1 + number % 2];
        let force = json!({"type": "body-force", "force": vec![1.5; edges.len()], "species": ["heavy"]});
        let exponents = [THREE_EXPONENTS, ONE_EXPONENT][number % 2];
        agree(&fluid(edges, integrator, &pairs(exponents), &[bonds.clone(), force]), Options::default());
    }
}

/// A bath of pairs with memory, one of particles beside it, and a line: all of these have lists.
#[test]
fn memory_and_position_baths_agree_with_the_reference() {
    let langevin = json!({"type": "langevin", "friction": 2, "bath": {"type": "memory", "rate": 5}});
    for edges in BOXES {
        for exponents in [ONE_EXPONENT, THREE_EXPONENTS] {
            let mut remembering = pairs(exponents);
            remembering["bath"] = json!({"type": "memory", "rate": 3});
            agree(&fluid(edges, COTTER_REICH, &remembering, &[]), Options::default());
            agree(&fluid(edges, COTTER_REICH, &pairs(exponents), std::slice::from_ref(&langevin)), Options::default());
        }
    }
}

/// An attraction further than the first repulsion, one of its own between unlike particles, and friction of a third
/// interaction.
fn several(exponent: f64) -> [Value; 3] {
    [
        json!({"type": "dpd", "repulsion": 25, "cutoff": 0.9}),
        json!({"type": "dpd", "repulsion": -6, "cutoff": 1.2, "pairs": [{"between": ["light", "light"], "repulsion": 0},
            {"between": ["heavy", "light"], "cutoff": 0.7, "repulsion": 9}]}),
        json!({"type": "dpd", "friction": 4.5, "weight_exponent": exponent, "pairs": [{"between": ["heavy", "heavy"], "cutoff": 1.3}]}),
    ]
}

/// Several pair forces in all integrators, of two species and of one, which has a table then too; with a many-body
/// repulsion, and with bonds whose ends none of them pushes apart.
#[test]
fn several_pair_forces_agree_with_the_reference() {
    let bonds = json!({"type": "bonds", "exclude_repulsion": true, "pairs": [[0, 1], [1, 2]],
        "potential": {"type": "harmonic", "stiffness": 40}});
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let (edges, exponent) = (BOXES[1 + number % 2], [2.0, 1.0][number % 2]);
        let [first, second, third] = several(exponent);
        let others = [second, third, bonds.clone()];
        let document = fluid(edges, integrator, &first, &others);
        for traversal in traversals() {
            agree(&document, Options { traversal: Some(traversal), ..Options::default() });
        }
        if !is_split(integrator) {
            agree(&document, Options { listed: true, ..Options::default() });
        }
        let mut alone = fluid(
            edges,
            integrator,
            &json!({"type": "dpd", "repulsion": 25, "cutoff": 0.9}),
            &[
                json!({"type": "dpd", "repulsion": -6, "cutoff": 1.2}),
                json!({"type": "dpd", "repulsion": 3}),
                json!({"type": "dpd", "friction": 4.5}),
            ],
        );
        alone["particles"].as_array_mut().unwrap().pop();
        agree(&alone, Options::default());
        let mut dense = first;
        dense["many_body"] = json!({"repulsion": 10, "cutoff": 0.7});
        agree(&fluid(edges, integrator, &dense, &others[..2]), Options::default());
    }
    for edges in BOXES {
        let [first, second, mut third] = several(2.0);
        third["bath"] = json!({"type": "memory", "rate": 3});
        agree(&fluid(edges, COTTER_REICH, &first, &[second, third]), Options::default());
    }
}

/// Energy a rc/2 (1 - r/rc)² and force a (1 - r/rc) of two particles, with the values that HOOMD-blue's own test of its DPD force has
/// for a cutoff of 2.5. Other pairs of species have other cutoffs.
#[test]
fn two_particles_in_contact_have_the_published_energy_and_force() {
    let energies_and_forces = [(0.5, 0.75, 0.30625, 0.35), (1.5, 1.5, 0.3, 0.6)];
    let all = INTEGRATORS.iter().flat_map(|integrator| energies_and_forces.map(|known| (integrator, known)));
    for ((integrator, (repulsion, distance, energy, force)), second) in
        all.flat_map(|known| [None, Some(-2.0)].map(|second| (known, second)))
    {
        // Of a second pair force with a cutoff of 3.
        let closeness = 1.0 - distance / 3.0;
        let of_second = |second: f64| {
            let more = second * closeness;
            [1.5 * more * closeness, more, more * distance, 2.0 * (second / 3.0 - 2.0 * more / distance)]
        };
        let more = second.map_or([0.0; 4], of_second);
        // V'' + 2V'/r at both ends.
        let laplacian = 2.0 * (repulsion / 2.5 - 2.0 * force / distance);
        let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
        let at = |x: f64| json!({"type": "listed", "positions": [[x, 3.5, 3.5]]});
        let document = json!({
            "title": "two particles",
            "space": {"box": [7, 7, 7]},
            "time": {"step": 0.04, "steps": 1},
            "temperature": 0,
            "integrator": integrator,
            "particles": [
                {"species": "A", "placement": at(3.0), "velocities": {"type": "rest"}},
                {"species": "B", "placement": at(3.0 + distance), "velocities": {"type": "rest"}}],
            "interactions": [{"type": "dpd", "repulsion": 7, "pairs": [
                {"between": ["A", "B"], "cutoff": 2.5, "repulsion": repulsion},
                {"between": ["A", "A"], "cutoff": 3.5}]},
                {"type": "dpd", "repulsion": second.unwrap_or(0.0), "cutoff": 3}],
            "output": {"energies": {"every": 1}},
        });
        let scene = read(&document);
        let (model, state) = start(&scene);
        let device: Box<dyn Implementation> = Box::new(Device::new(&scene));
        for mut run in [device, reference_of_particles(model, state)] {
            let found = run.observe();
            let of_one = (found.gradient_squared / 2.0).sqrt().copysign(force + more[1]);
            for (what, found, [first, second]) in [
                ("energy", found.potential_energy, [energy, more[0]]),
                ("force", of_one, [force, more[1]]),
                ("virial", found.conservative_virial, [force * distance, more[2]]),
                ("Laplacian", found.laplacian, [laplacian, more[3]]),
            ] {
                let expected: f64 = first + second;
                // The force is an impulse of half a step, some twenty thousand units of momentum, and sums of a report have units of
                // their own; both round by less than this.
                let allowed = if ["force", "Laplacian"].contains(&what) { 1e-4 } else { 3e-6 };
                assert!(
                    (found - expected).abs() < allowed * (first.abs() + second.abs()),
                    "{}: {what} {found}, known {expected}\n{document:#}",
                    run.name()
                );
            }
        }
    }
}
