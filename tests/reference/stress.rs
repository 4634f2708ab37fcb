//! The stress on the device: of each particle against the float64 reference, and of all against the pressure.

use mesoscope::engine::Sample;
use mesoscope::families::reference::Reference;
use mesoscope::measure::observables_of;
use mesoscope::plan::{Options, Traversal};
use mesoscope::scene::Checked;
use mesoscope::shaders::Array;
use serde_json::{Value, json};
use std::f64::consts::TAU;

use crate::support::{INTEGRATORS, edited, engine, start, traversals};

/// Two species, chains of them with bonds and angles or none, in a box.
fn scene(edges: &[f64], integrator: &str, interactions: &Value, chains: bool) -> Checked {
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    let volume: f64 = edges.iter().product();
    let is_charged = interactions.to_string().contains("electrostatics");
    let group = |species: &str, count: f64, mass: f64| {
        let mut group = json!({"species": species, "count": 4 * (count / 4.0) as u64, "mass": mass});
        if is_charged {
            group["charge"] = json!(mass - 2.0);
        }
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

/// Compares what a report leaves at the start and after some steps.
fn agree(scene: &Checked, options: Options, what: &str) {
    let (model, state) = start(scene);
    let mut engine = engine(scene, &state, options);
    for steps in [0, 3] {
        engine.advance(steps, steps.max(1)).unwrap();
        let reference = Reference::new(model.clone(), engine.state().unwrap());
        let (expected, of_waves) = (reference.virials().unwrap(), reference.virials_of_waves().unwrap());
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
        let samples = engine.finish().unwrap();
        let last = |sampler| samples.iter().rfind(|sample: &&Sample| sample.sampler == sampler).unwrap();
        let sums = &last(1).sums;
        // Of what belongs to no particle: single precision of some thousand waves, each rounded to a unit.
        for component in 0..6 {
            let of_particles: i64 = (0..model.particle_count() as usize)
                .map(|particle| i64::from(words[12 * particle + component] as i32))
                .sum();
            let found = (sums[6 + component] - of_particles) as f64 * unit;
            let largest = of_waves.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            let off = (found - of_waves[component]).abs();
            let place = format!("{what}, step {steps}: waves, component {component}");
            assert!(
                off <= 1e-4 * largest + 100.0 * unit * f64::from(u8::from(largest > 0.0)),
                "{place}: {found}, and {of_waves:?}"
            );
        }
        // The pressure is a third (half) of the trace.
        let observed = observables_of(last(0), engine.plan(), &model);
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

/// Charges: of their waves, and beside pairs that bonds exclude.
#[test]
fn stresses_of_charges_agree_with_the_reference() {
    let dpd = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let bonds = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.6}, "exclude_charges": true});
    for (row, integrator) in INTEGRATORS.iter().enumerate() {
        // Nodes so far apart that waves in the middle of an axis count.
        let spacing = [0.5, 0.35][row % 2];
        let charges = json!({"type": "electrostatics", "bjerrum_length": 6, "width": 0.3, "spacing": spacing, "background": true});
        let interactions = if row % 2 == 0 { json!([dpd, charges]) } else { json!([dpd, charges, bonds]) };
        let scene = scene(BOXES[1], integrator, &interactions, row % 2 == 1);
        assert!(scene.model().particles().electrostatics.is_some());
        agree(&scene, Options::default(), &format!("charges {integrator}"));
    }
}

/// The energy of clouds of charge with a spectrum by the square of the wave number, each by itself included, in a box whose edges are the rows of a
/// lower triangle: of exact phases, places being fractions of the box.
fn energy_of_waves(edges: [[f64; 3]; 3], charges: &[([f64; 3], f64)], spectrum: impl Fn(f64) -> f64) -> f64 {
    const MOST: i32 = 12;
    let volume = edges[0][0] * edges[1][1] * edges[2][2];
    let sides = 2 * MOST + 1;
    let energy_of = |index: i32| {
        let wave = [index % sides, index / sides % sides, index / sides / sides].map(|place| f64::from(place - MOST));
        if wave == [0.0; 3] {
            return 0.0;
        }
        // The product of k and each edge is a multiple of 2π.
        let x = TAU * wave[0] / edges[0][0];
        let y = (TAU * wave[1] - edges[1][0] * x) / edges[1][1];
        let z = (TAU * wave[2] - edges[2][0] * x - edges[2][1] * y) / edges[2][2];
        let square = x * x + y * y + z * z;
        let [mut real, mut imaginary] = [0.0; 2];
        for (place, charge) in charges {
            let phase = TAU * (0..3).map(|axis| wave[axis] * place[axis]).sum::<f64>();
            real += charge * phase.cos();
            imaginary += charge * phase.sin();
        }
        TAU / (volume * square) * spectrum(square) * (real * real + imaginary * imaginary)
    };
    (0..sides.pow(3)).map(energy_of).sum()
}

/// The stress of charges is what a strain of the box takes of their energy, along the axes and across them.
#[test]
fn the_stress_of_charges_is_that_of_a_strain() {
    let edges = [5.0, 6.0, 4.5];
    let gaussian = |square: f64| 3.0 * (-square * 0.64).exp();
    let slater = |square: f64| 3.0 * (1.0 + square / (4.0 * 0.64)).powi(-2);
    let cases: [(_, &dyn Fn(f64) -> f64, f64); 3] = [
        (json!({"width": 0.8}), &gaussian, 1e-4),
        (json!({"width": 0.8, "method": "waves"}), &gaussian, 1e-4),
        (json!({"decay": 0.8}), &slater, 3e-3),
    ];
    for (cloud, spectrum, tolerance) in cases {
        let mut charges = json!({"type": "electrostatics", "bjerrum_length": 3, "spacing": 0.25});
        charges.as_object_mut().unwrap().extend(cloud.as_object().unwrap().clone());
        let scene = crate::support::scene(
            &json!({
                "title": "strained", "seed": 3, "space": {"box": edges}, "time": {"step": 0.01, "steps": 1}, "temperature": 1,
                "integrator": {"type": "cotter-reich"},
                "particles": [{"species": "P", "count": 6, "charge": 1}, {"species": "M", "count": 4, "charge": -1.5}],
                "interactions": [charges],
                "output": {"stress": {"every": 1}},
            })
            .to_string(),
        );
        let (_, state) = start(&scene);
        let charges: Vec<([f64; 3], f64)> = (state.positions.iter().zip(&state.species))
            .map(|(place, species)| {
                (place.map(|word| f64::from(word) / 2_f64.powi(32)), [1.0, -1.5][*species as usize])
            })
            .collect();
        let mut engine = engine(&scene, &state, Options::default());
        let samples = engine.finish().unwrap();
        let unit = engine.plan().stress_unit;
        let found: Vec<f64> = samples.last().unwrap().sums[6..12].iter().map(|sum| *sum as f64 * unit).collect();
        let largest = found.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        for (component, [a, b]) in [[0, 0], [1, 1], [2, 2], [1, 0], [2, 0], [2, 1]].into_iter().enumerate() {
            let strained = |strain: f64| {
                let mut box_edges = [[edges[0], 0.0, 0.0], [0.0, edges[1], 0.0], [0.0, 0.0, edges[2]]];
                box_edges[a][b] += strain * edges[a];
                energy_of_waves(box_edges, &charges, spectrum)
            };
            let expected = -(strained(1e-4) - strained(-1e-4)) / 2e-4;
            let off = (found[component] - expected).abs();
            assert!(off < tolerance * largest, "{cloud} {component}: {found:?}, expected {expected}");
        }
    }
}
