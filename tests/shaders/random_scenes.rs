//! Random scenes on random hardware: their kernels link, are valid, find their constants and arrays, and are in the list
//! (`variants.rs`).

use std::collections::{BTreeMap, BTreeSet, HashMap};

use mesoscope::gpu::{LinkedShader, Switched};
use mesoscope::plan::{Hardware, Options, Traversal};
use mesoscope::run;
use mesoscope::scene;
use mesoscope::shaders::{Array, linked_text};
use rand::rngs::StdRng;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use serde_json::{Value, json};

use crate::canonical::hash_of_kernel;
use crate::variants::{Specialized, hashes, report, validated};

/// Draws of one scene.
struct Draws(StdRng);

impl Draws {
    /// True in one of some cases.
    fn one_in(&mut self, cases: u32) -> bool {
        self.0.random_ratio(1, cases)
    }

    fn one_of<T: Clone>(&mut self, values: &[T]) -> T {
        values.choose(&mut self.0).unwrap().clone()
    }
}

/// A scene of particles; many of them are refused.
fn random_scene(draws: &mut Draws) -> Value {
    let dimension = draws.one_of(&[1, 2, 2, 3, 3, 3]);
    let lengths = [json!([60]), json!([9, 7]), json!([5, 5, 6])][dimension - 1].clone();
    let across = ["x", "y", "y"][dimension - 1];
    let memory = json!({"type": "memory", "rate": 3});
    let mut groups = vec![json!({"species": "A", "count": 60})];
    let chained = draws.one_in(3);
    if chained {
        groups[0]["chain"] = json!({"beads": 3, "spacing": 0.5});
    }
    if draws.one_in(2) {
        groups.push(json!({"species": "B", "count": 30, "mass": draws.one_of(&[1.0, 1.0, 2.0])}));
        if draws.one_in(6) {
            groups[1]["fixed"] = json!(true);
        }
    }
    let mut scene = json!({
        "title": "random", "seed": 1, "space": {"box": lengths}, "time": {"step": 0.01, "steps": 1000},
        "temperature": draws.one_of(&[0.0, 1.0, 1.0, 1.0]),
        "noise": {
            "generator": draws.one_of(&["pcg4d", "threefry2x32-20"]),
            "distribution": draws.one_of(&["uniform", "gaussian"]),
        },
        "integrator": draws.one_of(&[
            json!({"type": "splitting"}),
            json!({"type": "splitting", "relaxation": "two-stages"}),
            json!({"type": "splitting", "relaxation": "mean-field"}),
            json!({"type": "cotter-reich"}),
            json!({"type": "groot-warren"}),
            json!({"type": "groot-warren", "lambda": 0.65}),
        ]),
    });
    if draws.one_in(4) {
        scene["space"]["walls"] = json!({across: draws.one_of(&[
            json!({}),
            json!({"reflection": "specular"}),
            json!({"velocity": [[0.2, 0, 0], [-0.2, 0, 0]]}),
        ])});
        if draws.one_in(3) {
            let placement = json!({"type": "behind-walls", "axis": across, "thickness": 1});
            groups.push(json!({"species": "W", "number_density": 3, "placement": placement}));
        }
    } else if draws.one_in(5) {
        scene["space"]["shear"] = json!({"rate": 0.7, "gradient": across});
    }
    let charged = dimension == 3 && draws.one_in(4);
    if charged {
        groups[0]["charge"] = json!(1);
    }
    scene["particles"] = json!(groups);
    scene["interactions"] = interactions(draws, dimension, chained, &memory, groups.len());
    if charged && let Some(interactions) = scene["interactions"].as_array_mut() {
        let mut bonds = interactions.iter_mut().filter(|interaction| interaction["type"] == "bonds");
        if let Some(bonds) = bonds.next().filter(|bonds| bonds["exclude_repulsion"] == true) {
            bonds["exclude_charges"] = json!(true);
        }
        interactions.push(json!({"type": "electrostatics", "bjerrum_length": 1, "background": true}));
    }
    scene["output"] = output(draws, across);
    scene
}

fn interactions(draws: &mut Draws, dimension: usize, chained: bool, memory: &Value, species: usize) -> Value {
    let mut interactions = Vec::new();
    if !draws.one_in(5) {
        let mut pairs = json!({
            "type": "dpd", "repulsion": draws.one_of(&[0.0, 25.0, 25.0]),
            "friction": draws.one_of(&[0.0, 4.5, 4.5, 4.5, 40.0]),
        });
        if draws.one_in(5) {
            pairs["bath"] = memory.clone();
        }
        if draws.one_in(4) {
            pairs["weight_exponent"] = json!(1);
        }
        if draws.one_in(6) {
            pairs["many_body"] = json!({"repulsion": 10});
        }
        if species > 1 && draws.one_in(3) {
            pairs["pairs"] = json!([draws.one_of(&[
                json!({"between": ["A", "B"], "repulsion": 30}),
                json!({"between": ["A", "B"], "cutoff": 0.8}),
                json!({"between": ["A", "B"], "weight_exponent": 1}),
            ])]);
        }
        interactions.push(pairs);
        if draws.one_in(6) {
            interactions.push(json!({"type": "dpd", "repulsion": -6, "cutoff": 0.8}));
        }
    }
    if draws.one_in(4) {
        let mut bath = json!({"type": "langevin", "friction": 1.5});
        if draws.one_in(2) {
            bath["bath"] = memory.clone();
        }
        interactions.push(bath);
    }
    if draws.one_in(6) {
        let process = draws.one_of(&["kangaroo", "kangaroo-exponential", "short", "literal"]);
        interactions.push(json!({"type": "coloured-noise", "strength": 1, "time": 0.1, "process": process}));
    }
    if chained {
        let mut bonds = json!({"type": "bonds", "species": ["A"]});
        if !draws.one_in(4) {
            bonds["potential"] = draws.one_of(&[
                json!({"type": "harmonic", "stiffness": 20, "length": 0.5}),
                json!({"type": "fene", "stiffness": 20, "extent": 1.5}),
            ]);
        }
        if draws.one_in(3) {
            bonds["friction"] = json!(2);
            if draws.one_in(2) {
                bonds["bath"] = memory.clone();
            }
        }
        if draws.one_in(4) {
            bonds["exclude_repulsion"] = json!(true);
        }
        interactions.push(bonds);
        if draws.one_in(4) {
            interactions.push(json!({"type": "angles", "stiffness": 3, "species": ["A"]}));
        }
    }
    if draws.one_in(6) {
        interactions.push(json!({"type": "tether", "stiffness": 4}));
    }
    if draws.one_in(4) {
        let mut force = json!({"type": "body-force", "force": vec![0.4; dimension]});
        if draws.one_in(2) {
            force["profile"] = json!(draws.one_of(&["sinusoidal", "opposed"]));
            force["axis"] = json!(["x", "y", "z"][dimension - 1]);
        }
        interactions.push(force);
    }
    json!(interactions)
}

fn output(draws: &mut Draws, across: &str) -> Value {
    let analyses = [
        ("radial_distribution", json!({"every": 2, "range": 1.5, "bins": 10})),
        ("radial_distribution", json!({"every": 2, "range": 1.5, "bins": 10, "species": "all-pairs"})),
        ("radial_distribution", json!({"every": 2, "range": 1.5, "bins": 10, "species": "A"})),
        ("structure_factor", json!({"every": 2, "range": 9, "bins": 5, "vectors": 2})),
        ("structure_factor", json!({"every": 2, "range": 9, "bins": 5, "vectors": 2, "species": "all-pairs"})),
        ("diffusion", json!({"every": 1, "window": 2})),
        ("diffusion", json!({"every": 1, "window": 2, "species": "A"})),
        ("chain_sizes", json!({"every": 2})),
        ("viscosity", json!({"every": 1, "window": 8})),
        ("autocorrelations", json!([{"quantity": "velocity", "every": 1, "window": 2}])),
        ("autocorrelations", json!([{"quantity": "force", "every": 1, "window": 2}])),
        ("histograms", json!([{"quantity": "velocity", "every": 2}])),
        ("histograms", json!([{"quantity": "acceleration", "every": 2}])),
        ("autocorrelations", json!([{"quantity": "force", "every": 1, "window": 2, "species": "A"}])),
        ("histograms", json!([{"quantity": "velocity", "every": 2, "species": "A"}])),
        ("stress", json!({"every": 1})),
        ("profiles", json!({"axis": across, "every": 2, "bins": 5})),
        ("profiles", json!({"axis": across, "every": 2, "bins": 5, "quantities": ["stress"]})),
        ("profiles", json!({"axis": across, "every": 2, "bins": 5, "species": "A"})),
        ("clusters", json!({"every": 2, "distance": 0.6})),
        ("trajectory", json!({"every": 5})),
    ];
    let mut output = json!({"energies": {"every": 1}});
    for (key, value) in analyses {
        if draws.one_in(8) {
            output[key] = value;
        }
    }
    output
}

/// Mistakes in kernels of random scenes, each with the scene that requests it.
fn complaints(accepted: usize, seed: u64) -> BTreeMap<String, String> {
    let mut draws = Draws(StdRng::seed_from_u64(seed));
    let known = hashes();
    let (mut found, mut unlisted) = (0, BTreeMap::new());
    let mut seen: HashMap<String, LinkedShader> = HashMap::new();
    let mut specialized: HashMap<(String, Switched), Specialized> = HashMap::new();
    let mut complaints = BTreeMap::new();
    while found < accepted {
        let text = random_scene(&mut draws).to_string();
        let hardware = Hardware {
            subgroup_size: draws.one_of(&[None, Some(8), Some(32)]),
            serial_memory: draws.one_in(2),
            ..Hardware::default()
        };
        let traversal = draws.one_of(&[None, None, Some(Traversal::Rows), Some(Traversal::Clusters)]);
        let options = Options { traversal, listed: draws.one_in(6), ..Options::default() };
        let Ok(scene) = scene::parse("test", &text, &[]) else { continue };
        found += 1;
        let plan = run::plan(&scene, hardware, options);
        let held: BTreeSet<Array> = (plan.buffers.iter().map(|buffer| buffer.array))
            .chain(plan.textures.iter().map(|texture| texture.array))
            .collect();
        for kernel in &plan.kernels {
            let linked = linked_text(kernel.entry, &kernel.choices).unwrap();
            let shader = seen.entry(linked.text.clone()).or_insert_with(|| validated(kernel.entry, &linked));
            if !known.contains(&hash_of_kernel(&shader.module)) {
                let variants = linked.parts.iter().map(|part| part.path).filter(|path| path.matches('/').count() == 2);
                let variants: BTreeSet<&str> = variants.collect();
                let variants = variants.into_iter().collect::<Vec<_>>().join(" ");
                let complaint = format!("{} of {variants} is in no plan of the list", kernel.entry.name());
                unlisted.entry(complaint).or_insert(text.clone());
            }
            let constants: Vec<_> = kernel.constants_in(&plan).collect();
            let key = (linked.text.clone(), shader.switched(&constants));
            let used = specialized.entry(key).or_insert_with(|| Specialized::new(shader, &constants));
            let given: BTreeSet<&str> = constants.iter().map(|(constant, _)| constant.name()).collect();
            let missing = (shader.module.overrides.iter())
                .filter(|(_, own)| own.init.is_none())
                .filter_map(|(_, own)| own.name.as_deref())
                .filter(|name| used.constants.iter().any(|constant| constant.name() == *name) && !given.contains(name))
                .map(|name| format!("constant {name} of `{}` has no value", kernel.name));
            let unbound = (used.bindings.iter())
                .filter(|binding| !held.contains(&kernel.array_of(binding.array)))
                .map(|binding| format!("array `{}` of `{}` is not there", binding.array.name(), kernel.name));
            complaints.extend(missing.chain(unbound).map(|complaint| (complaint, text.clone())));
        }
    }
    println!("{found} scenes, {} distinct kernels, {} beyond the list", seen.len(), unlisted.len());
    complaints.extend(unlisted);
    complaints
}

#[test]
fn kernels_of_random_scenes_are_valid_and_find_what_they_need() {
    report(&complaints(200, 46));
}

#[test]
#[ignore = "minutes: kernels_of_random_scenes_are_valid_and_find_what_they_need for ten times as many"]
fn kernels_of_many_random_scenes_are_valid_and_find_what_they_need() {
    report(&complaints(2000, 47));
}
