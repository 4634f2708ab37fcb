//! Shipped scenes as JSON, and ways to change them.

use mesoscope::scene::{self, ParticleGroup, Space};
use serde_json::{Value, json};

pub type Change = fn(&mut Value);

/// The shipped scenes with their names.
pub fn shipped() -> Vec<(&'static str, Value)> {
    scene::builtin().iter().map(|builtin| (builtin.name, serde_json::from_str(builtin.text).unwrap())).collect()
}

/// The interaction of a kind.
pub fn interaction<'a>(scene: &'a Value, kind: &str) -> Option<&'a Value> {
    scene["interactions"].as_array()?.iter().find(|interaction| interaction["type"] == kind)
}

/// Whether a scene is one of particles.
pub fn has_particles(scene: &Value) -> bool {
    ["shallow-water", "voronoi"].iter().all(|kind| interaction(scene, kind).is_none())
}

/// Adds an interaction unless there is one of its kind.
pub fn add(scene: &mut Value, new: Value) {
    if interaction(scene, new["type"].as_str().unwrap()).is_none() {
        scene["interactions"].as_array_mut().unwrap().push(new);
    }
}

pub fn remove(scene: &mut Value, kind: &str) {
    scene["interactions"].as_array_mut().unwrap().retain(|interaction| interaction["type"] != kind);
}

/// Adds an interaction in the place of one of its kind.
fn replace(scene: &mut Value, new: Value) {
    remove(scene, new["type"].as_str().unwrap());
    add(scene, new);
}

/// Sets a key, or leaves it out where the value is null.
fn set_key(object: &mut Value, key: &str, value: Value) {
    let object = object.as_object_mut().unwrap();
    match value {
        Value::Null => drop(object.remove(key)),
        value => drop(object.insert(key.to_owned(), value)),
    }
}

/// Sets a key of an interaction that is there, or leaves it out.
pub fn set(scene: &mut Value, kind: &str, key: &str, value: Value) {
    let interactions = scene["interactions"].as_array_mut().unwrap().iter_mut();
    if let Some(interaction) = interactions.into_iter().find(|known| known["type"] == kind) {
        set_key(interaction, key, value);
    }
}

/// Leaves keys of an interaction out.
pub fn leave_out(scene: &mut Value, kind: &str, keys: &[&str]) {
    for key in keys {
        set(scene, kind, key, Value::Null);
    }
}

/// Sets a key of the scene itself, or leaves it out.
pub fn set_scene(scene: &mut Value, key: &str, value: Value) {
    set_key(scene, key, value);
}

/// Asks for something to be written, or for no more.
pub fn write(scene: &mut Value, key: &str, value: Value) {
    if scene.get("output").is_none() {
        scene["output"] = json!({});
    }
    set_key(&mut scene["output"], key, value);
}

/// Steps that couplings can have too.
pub fn leapfrog(scene: &mut Value) {
    if has_particles(scene) {
        scene["integrator"] = json!({"type": "cotter-reich"});
    }
}

/// The same with some bonds, unless there are bonds.
pub fn bonded(scene: &mut Value) {
    leapfrog(scene);
    let potential = json!({"type": "harmonic", "stiffness": 2});
    add(scene, json!({"type": "bonds", "pairs": [[0, 1], [1, 2]], "potential": potential, "friction": 1}));
}

/// The same with a bath on every particle.
pub fn bathed(scene: &mut Value) {
    leapfrog(scene);
    add(scene, json!({"type": "langevin", "friction": 1}));
}

/// Particles that do not repel each other, whatever their species.
fn without_repulsion(scene: &mut Value) {
    set(scene, "dpd", "repulsion", json!(0));
    set(scene, "dpd", "pairs", Value::Null);
}

/// Ten particles of the only group become one of their own; of molecules, which say their numbers themselves, none.
pub fn split_group(scene: &mut Value) {
    let space: Space = serde_json::from_value(scene["space"].clone()).unwrap();
    if scene.get("molecules").is_some() {
        return;
    }
    let groups = scene["particles"].as_array_mut().unwrap();
    let [group] = groups.as_mut_slice() else { return };
    let count = serde_json::from_value::<ParticleGroup>(group.clone()).unwrap().resolved_count(&space);
    set_key(group, "number_density", Value::Null);
    set_key(group, "count", json!(count - 10));
    let mut other = group.clone();
    other["species"] = json!("other");
    other["count"] = json!(10);
    groups.push(other);
}

/// Coefficients of the first species with the last, in place of those of any pairs. Nothing without a pair force.
pub fn set_pair(scene: &mut Value, coefficients: Value) {
    let groups = scene["particles"].as_array().unwrap();
    let [Some(first), Some(last)] = [groups.first(), groups.last()] else { return };
    let mut pair = coefficients;
    pair["between"] = json!([first["species"], last["species"]]);
    set(scene, "dpd", "pairs", json!([pair]));
}

/// Two species whose pairs all have the same forces.
pub fn alike(scene: &mut Value) {
    if interaction(scene, "dpd").is_some() {
        set(scene, "dpd", "pairs", Value::Null);
        set(scene, "dpd", "cutoff", Value::Null);
        set(scene, "dpd", "weight_exponent", Value::Null);
        split_group(scene);
    }
}

/// Sets a key of the last group.
pub fn set_last_group(scene: &mut Value, key: &str, value: Value) {
    if let Some(group) = scene["particles"].as_array_mut().unwrap().last_mut() {
        group[key] = value;
    }
}

/// Water at rest, whatever its surface and rotation.
pub fn at_rest(scene: &mut Value) {
    if interaction(scene, "shallow-water").is_some() {
        for group in scene["particles"].as_array_mut().unwrap() {
            group["velocities"] = json!({"type": "rest"});
        }
    }
}

/// A number of tracers on a circle, and no others.
pub fn tracers(scene: &mut Value, count: u64) {
    if interaction(scene, "shallow-water").is_none() {
        return;
    }
    let groups = scene["particles"].as_array_mut().unwrap();
    groups.retain(|group| group["tracer"] != true);
    groups.push(json!({"species": "loop", "count": count, "tracer": true, "velocities": {"type": "rest"},
        "placement": {"type": "circle", "center": [1, 1], "radius": 0.5}}));
}

pub fn no_tracers(scene: &mut Value) {
    scene["particles"].as_array_mut().unwrap().retain(|group| group["tracer"] != true);
}

/// Nothing but the table of energies.
pub fn no_analyses(scene: &mut Value) {
    for key in ANALYSES.iter().chain(&LISTS) {
        write(scene, key, Value::Null);
    }
}

/// The temperature of a scene of this kind.
pub fn heat(scene: &mut Value, kind: &str, temperature: f64) {
    if interaction(scene, kind).is_some() {
        scene["temperature"] = json!(temperature);
    }
}

/// Values that say that something is off, and the scene that does not mention it.
pub fn ways_to_say_off() -> Vec<(&'static str, Change, Change)> {
    vec![
        (
            "no repulsion",
            |scene| {
                set(scene, "dpd", "pairs", Value::Null);
                set(scene, "dpd", "repulsion", json!(0));
            },
            |scene| {
                set(scene, "dpd", "pairs", Value::Null);
                set(scene, "dpd", "repulsion", Value::Null);
            },
        ),
        (
            "no friction",
            |scene| {
                leave_out(scene, "dpd", &["pairs", "bath"]);
                set(scene, "dpd", "friction", json!(0));
            },
            |scene| leave_out(scene, "dpd", &["pairs", "bath", "friction"]),
        ),
        (
            "no memory",
            |scene| set(scene, "dpd", "bath", json!({"type": "white"})),
            |scene| set(scene, "dpd", "bath", Value::Null),
        ),
        (
            "no many-body repulsion",
            |scene| set(scene, "dpd", "many_body", json!({"repulsion": 0})),
            |scene| set(scene, "dpd", "many_body", Value::Null),
        ),
        (
            "the usual weight",
            |scene| set(scene, "dpd", "weight_exponent", json!(2)),
            |scene| set(scene, "dpd", "weight_exponent", Value::Null),
        ),
        (
            "no pairs of species",
            |scene| set(scene, "dpd", "pairs", json!([])),
            |scene| set(scene, "dpd", "pairs", Value::Null),
        ),
        (
            "a cutoff and an exponent that are those of all pairs",
            |scene| {
                alike(scene);
                set_pair(scene, json!({"cutoff": 1, "weight_exponent": 2}));
            },
            alike,
        ),
        (
            "no prediction",
            |scene| scene["integrator"] = json!({"type": "groot-warren", "lambda": 0.5}),
            |scene| scene["integrator"] = json!({"type": "groot-warren"}),
        ),
        (
            "one stage of friction",
            |scene| scene["integrator"] = json!({"type": "splitting", "relaxation": "mean-field"}),
            |scene| scene["integrator"] = json!({"type": "splitting"}),
        ),
        (
            "the usual noise",
            |scene| set_scene(scene, "noise", json!({"generator": "pcg4d", "distribution": "uniform"})),
            |scene| set_scene(scene, "noise", Value::Null),
        ),
        (
            "no frictions of species",
            |scene| set(scene, "langevin", "species", json!([])),
            |scene| set(scene, "langevin", "species", Value::Null),
        ),
        (
            "no friction of particles",
            |scene| replace(scene, json!({"type": "langevin", "friction": 0})),
            |scene| remove(scene, "langevin"),
        ),
        (
            "no memory of particles",
            |scene| {
                let bath = json!({"type": "memory", "rate": 3});
                replace(scene, json!({"type": "langevin", "friction": 0, "bath": bath}));
            },
            |scene| remove(scene, "langevin"),
        ),
        (
            "no random force",
            |scene| replace(scene, json!({"type": "coloured-noise", "strength": 0, "time": 1})),
            |scene| remove(scene, "coloured-noise"),
        ),
        (
            "no stiffness of tethers",
            |scene| replace(scene, json!({"type": "tether", "stiffness": 0})),
            |scene| remove(scene, "tether"),
        ),
        (
            "no body force",
            |scene| {
                let force = vec![0; scene["space"]["box"].as_array().unwrap().len()];
                replace(scene, json!({"type": "body-force", "force": force}));
            },
            |scene| remove(scene, "body-force"),
        ),
        (
            "no stiffness of angles",
            |scene| replace(scene, json!({"type": "angles", "stiffness": 0})),
            |scene| remove(scene, "angles"),
        ),
        (
            "no friction of bonds",
            |scene| set(scene, "bonds", "friction", json!(0)),
            |scene| set(scene, "bonds", "friction", Value::Null),
        ),
        (
            "no repulsion to be spared",
            |scene| {
                without_repulsion(scene);
                set(scene, "bonds", "exclude_repulsion", json!(true));
            },
            without_repulsion,
        ),
        (
            "no surface",
            |scene| set(scene, "shallow-water", "surface", json!([])),
            |scene| set(scene, "shallow-water", "surface", Value::Null),
        ),
        (
            "no rotation",
            |scene| {
                at_rest(scene);
                set(scene, "shallow-water", "rotation", json!(0));
            },
            |scene| {
                at_rest(scene);
                set(scene, "shallow-water", "rotation", Value::Null);
            },
        ),
        (
            "no length to smooth over",
            |scene| {
                set(scene, "shallow-water", "bath", Value::Null);
                let solver = json!({"type": "chebyshev"});
                set(scene, "shallow-water", "smoothing", json!({"length": 0, "power": 2, "solver": solver}));
            },
            |scene| leave_out(scene, "shallow-water", &["bath", "smoothing"]),
        ),
        ("no tracers", |scene| tracers(scene, 0), no_tracers),
        (
            "no viscosity to solve for",
            |scene| {
                set(scene, "voronoi", "viscosity", json!(0));
                set(scene, "voronoi", "friction_solver", json!({"iterations": 9}));
            },
            |scene| {
                set(scene, "voronoi", "viscosity", json!(0));
                set(scene, "voronoi", "friction_solver", Value::Null);
            },
        ),
        (
            "no temperatures of cells",
            |scene| set(scene, "voronoi", "energy", json!({"initial_temperatures": []})),
            |scene| set(scene, "voronoi", "energy", json!({})),
        ),
        (
            "no lists",
            |scene| {
                for key in LISTS {
                    write(scene, key, json!([]));
                }
            },
            |scene| {
                for key in LISTS {
                    write(scene, key, Value::Null);
                }
            },
        ),
        (
            "no analyses",
            |scene| {
                for key in ANALYSES {
                    scene["output"][key] = Value::Null;
                }
            },
            |scene| {
                for key in ANALYSES {
                    write(scene, key, Value::Null);
                }
            },
        ),
        ("nothing to write", |scene| scene["output"] = json!({}), |scene| set_scene(scene, "output", Value::Null)),
    ]
}

const LISTS: [&str; 2] = ["autocorrelations", "histograms"];
const ANALYSES: [&str; 14] = [
    "clusters",
    "trajectory",
    "radial_distribution",
    "structure_factor",
    "diffusion",
    "chain_sizes",
    "viscosity",
    "chain",
    "neighbours",
    "shear_wave",
    "spectra",
    "profiles",
    "stress",
    "fields",
];
