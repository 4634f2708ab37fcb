//! The stress on the device: of each particle against the float64 reference, and of all against the pressure.

use mesoscope::engine::Sample;
use mesoscope::families::Model;
use mesoscope::families::reference::{Reference, Virial};
use mesoscope::measure::observables_of;
use mesoscope::plan::{Options, Traversal};
use mesoscope::scene::Checked;
use mesoscope::shaders::Array;
use mesoscope::state::State;
use serde_json::{Value, json};

use crate::support::{INTEGRATORS, edited, engine, start, traversals};

/// Two species, chains of them with bonds and angles or none, in a box.
fn scene(edges: &[f64], integrator: &str, interactions: &Value, chains: bool) -> Checked {
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    let volume: f64 = edges.iter().product();
    let group = |species: &str, count: f64, mass: f64| {
        let mut group = json!({"species": species, "count": 4 * (count / 4.0) as u64, "mass": mass});
        if chains {
            group["chain"] = json!({"beads": 4, "spacing": 0.8});
        }
        group
    };
    let document = json!({
        "title": "stressed", "seed": 5, "space": {"box": edges}, "time": {"step": 0.01, "steps": 100}, "temperature": 1,
        "integrator": integrator,
        "particles": [group("light", 2.0 * volume, 1.0), group("heavy", volume, 2.5)],
        "interactions": interactions,
        "output": {"energies": {"every": 1}, "stress": {"every": 1}},
    });
    crate::support::scene(&document.to_string())
}

fn virials(model: Model, state: State) -> Vec<Virial> {
    Reference::new(model, state).virials().unwrap()
}

/// Compares what a report leaves at the start and after some steps.
fn agree(scene: &Checked, options: Options, what: &str) {
    let (model, state) = start(scene);
    let mut engine = engine(scene, &state, options);
    for steps in [0, 3] {
        engine.advance(steps, steps.max(1)).unwrap();
        let expected = virials(model.clone(), engine.state().unwrap());
        engine.reported().unwrap();
        let words = engine.words(Array::ReportedStresses).unwrap();
        let unit = engine.plan().stress_unit;
        let found: Vec<f64> = words.iter().map(|word| f64::from(*word as i32) * unit).collect();
        let expected: Vec<f64> =
            expected.iter().flat_map(|virial| [virial.conservative, virial.frictional].concat()).collect();
        assert!(found.len() >= expected.len(), "{what}: {} words", found.len());
        // Single precision against double: noise and friction of some ten pairs, each to some units in the last of 24 bits, and every pair
        // rounded to a unit.
        let largest = expected.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let tolerance = 2e-5 * largest + 24.0 * unit;
        for (word, (found, expected)) in found.iter().zip(&expected).enumerate() {
            let place = format!("{what}, step {steps}: particle {}, word {}", word / 12, word % 12);
            assert!((found - expected).abs() < tolerance, "{place}: {found}, and {expected} in the reference");
        }
        let frictional =
            expected.chunks(12).flat_map(|words| &words[6..]).fold(0.0_f64, |sum, value| sum + value.abs());
        assert_eq!(frictional > 0.0, steps > 0 || !what.contains("splitting"), "{what}, step {steps}: {frictional}");
        // The pressure is a third (half) of the trace.
        let samples = engine.finish().unwrap();
        let last = |sampler| samples.iter().rfind(|sample: &&Sample| sample.sampler == sampler).unwrap();
        let observed = observables_of(last(0), engine.plan(), &model);
        let sums = &last(1).sums;
        let trace = |part: usize| (0..3).map(|axis| sums[6 * part + axis] as f64).sum::<f64>();
        let virial = (trace(1) + trace(2)) * unit;
        assert!((virial - observed.total_virial).abs() < 1e-5 * observed.total_virial.abs(), "{what}: {virial}");
        let kinetic = 0.5 * trace(0) * engine.plan().quanta.energy;
        assert!((kinetic / observed.kinetic_energy - 1.0).abs() < 1e-6, "{what}: {kinetic}");
    }
}

const BOXES: [&[f64]; 2] = [&[9.0, 7.0], &[5.0, 4.0, 4.5]];

#[test]
fn stresses_of_pairs_agree_with_the_reference() {
    let dpd = json!([{"type": "dpd", "repulsion": 25, "friction": 4.5, "pairs": [
        {"between": ["light", "heavy"], "repulsion": 40, "friction": 9, "cutoff": 0.9}]}]);
    for (row, integrator) in INTEGRATORS.iter().enumerate() {
        // Either box and either traversal, by turns.
        for (column, traversal) in traversals().into_iter().enumerate() {
            let edges = BOXES[(row + column) % 2];
            let serial_memory = Some(traversal == Traversal::Clusters);
            let options = Options { traversal: Some(traversal), serial_memory, ..Options::default() };
            agree(&scene(edges, integrator, &dpd, false), options, &format!("{integrator} {edges:?} {traversal:?}"));
        }
    }
}

#[test]
fn stresses_of_many_body_forces_agree_with_the_reference() {
    let dpd = json!([{"type": "dpd", "repulsion": -40, "friction": 4.5, "many_body": {"repulsion": 25}, "pairs": [
        {"between": ["light", "heavy"], "repulsion": -30, "cutoff": 0.9}]}]);
    for (row, integrator) in INTEGRATORS.iter().enumerate() {
        agree(&scene(BOXES[row % 2], integrator, &dpd, false), Options::default(), &format!("many-body {integrator}"));
    }
}

#[test]
fn stresses_of_bonds_and_angles_agree_with_the_reference() {
    let bonded = |dpd: &Value, friction: f64| {
        json!([
            dpd,
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.6}, "friction": friction,
                "exclude_repulsion": true},
            {"type": "angles", "stiffness": 6},
        ])
    };
    let white = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let mut memory = white.clone();
    memory["bath"] = json!({"type": "memory", "rate": 10});
    for (row, integrator) in INTEGRATORS.iter().enumerate() {
        let scene = scene(BOXES[row % 2], integrator, &bonded(&white, 0.0), true);
        agree(&scene, Options::default(), &format!("bonds {integrator}"));
    }
    for (edges, dpd) in BOXES.into_iter().zip([&white, &memory]) {
        let scene = scene(edges, crate::support::COTTER_REICH, &bonded(dpd, 2.0), true);
        agree(&scene, Options::default(), &format!("couplings {edges:?}"));
    }
}

/// Between copies across boundaries that shear, and of velocities relative to the profile.
#[test]
fn stresses_in_shear_agree_with_the_reference() {
    let dpd = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let bonds = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40}});
    let sheared = INTEGRATORS.iter().filter(|integrator| **integrator != crate::support::COTTER_REICH);
    for (row, integrator) in sheared.enumerate() {
        let interactions = if row % 2 == 0 { json!([dpd]) } else { json!([dpd, bonds]) };
        let scene = scene(BOXES[row % 2], integrator, &interactions, row % 2 == 1);
        let shear =
            if row % 2 == 0 { json!({"rate": 0.8, "gradient": "y"}) } else { json!({"rate": 0.8, "gradient": "z"}) };
        let scene = edited(&scene, |scene| scene.space.shear = serde_json::from_value(shear).unwrap());
        let traversals = traversals();
        let traversal = traversals[row / 2 % traversals.len()];
        let options = Options { traversal: Some(traversal), ..Options::default() };
        agree(&scene, options, &format!("shear {integrator} {traversal:?}"));
    }
}

/// Between walls and under forces on single particles the stress is that of the pairs; friction of single particles and along bonds is split
/// from the rest of a step.
#[test]
fn stresses_in_company_agree_with_the_reference() {
    let dpd = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let vector = |edges: &[f64], components: [f64; 3]| json!(components[..edges.len()]);
    let pull = |edges: &[f64]| json!({"type": "body-force", "force": vector(edges, [0.3, 0.5, 0.2])});
    let force = |edges: &[f64]| json!({"type": "body-force", "force": vector(edges, [0.7, 0.0, 0.0]), "profile": "opposed", "axis": "y"});
    let langevin = json!({"type": "langevin", "friction": 1.5});
    let rubbing =
        json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.6}, "friction": 3});
    let angles = json!({"type": "angles", "stiffness": 6});
    for (row, integrator) in INTEGRATORS.iter().enumerate() {
        let edges = BOXES[row % 2];
        let scene = scene(edges, integrator, &json!([dpd, pull(edges)]), false);
        let walls = if row % 2 == 0 {
            json!({"y": {"lower_velocity": [-1, 0]}})
        } else {
            json!({"z": {"reflection": "specular"}, "x": {}})
        };
        let scene = edited(&scene, |scene| scene.space.walls = serde_json::from_value(walls).unwrap());
        let traversals = traversals();
        let traversal = Some(traversals[row / 2 % traversals.len()]);
        agree(&scene, Options { traversal, ..Options::default() }, &format!("walls {integrator} {traversal:?}"));
        let periodic = self::scene(edges, integrator, &json!([dpd, force(edges)]), false);
        agree(&periodic, Options::default(), &format!("body forces {integrator}"));
    }
    for edges in BOXES {
        for (name, interactions, chains) in [
            ("langevin", json!([dpd, langevin]), false),
            ("friction along bonds", json!([dpd, rubbing, angles]), true),
            ("all of it", json!([dpd, langevin, rubbing, angles, pull(edges)]), true),
        ] {
            let scene = scene(edges, crate::support::SPLITTING, &interactions, chains);
            agree(&scene, Options::default(), &format!("splitting with {name} {edges:?}"));
        }
    }
}
