//! Split steps with baths without memory on particles: the device against the reference, step by step.

use serde_json::{Value, json};

use super::bonds::agree;

/// Particles of two species with frictions and masses of their own, some of them in chains.
fn crowd(edges: &[f64], interactions: &[Value]) -> Value {
    let volume: f64 = edges.iter().product();
    let chains = (0.2 * volume).round() as u64;
    json!({
        "title": "relaxation", "seed": 11, "space": {"box": edges}, "time": {"step": 0.02, "steps": 1},
        "temperature": 1.3, "integrator": {"type": "splitting"},
        "particles": [
            {"species": "A", "count": 4 * chains, "mass": 2, "chain": {"beads": 4, "spacing": 0.8}},
            {"species": "B", "count": 6 * chains},
        ],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

const BOXES: [&[f64]; 2] = [&[9.0, 7.0], &[5.0, 4.0, 4.5]];

fn langevin() -> Value {
    json!({"type": "langevin", "friction": 1.5, "species": [{"name": "A", "friction": 8}]})
}

/// In one of the boxes: another one for the next `number`.
fn in_turn(number: usize, interactions: &[Value], change: fn(&mut Value)) {
    let mut document = crowd(BOXES[number % 2], interactions);
    change(&mut document);
    agree(&document);
}

#[test]
fn particles_in_a_bath_agree_with_the_reference() {
    let nothing = |_: &mut Value| {};
    let repulsion = json!({"type": "dpd", "repulsion": 25});
    let rubbing = json!({"type": "dpd", "repulsion": 25, "friction": 4.5,
        "pairs": [{"between": ["A", "B"], "cutoff": 0.8, "friction": 2}]});
    let bonds = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.8},
        "exclude_repulsion": true});
    let body =
        |edges: usize| json!({"type": "body-force", "force": vec![0.5; edges], "profile": "opposed", "axis": "x"});
    in_turn(0, &[langevin()], nothing);
    in_turn(1, &[langevin(), repulsion.clone()], nothing);
    in_turn(0, &[langevin(), repulsion.clone(), bonds.clone()], |document| {
        document["space"]["walls"] = json!({"y": {}});
    });
    in_turn(1, &[langevin(), rubbing.clone()], |document| document["integrator"]["relaxation"] = json!("two-stages"));
    in_turn(1, &[langevin(), bonds.clone(), json!({"type": "angles", "stiffness": 4})], nothing);
    for (number, edges) in BOXES.into_iter().enumerate() {
        in_turn(number, &[rubbing.clone(), langevin(), bonds.clone(), body(edges.len())], nothing);
    }
}

#[test]
fn tethers_agree_with_the_reference() {
    let tether = json!({"type": "tether", "stiffness": 30});
    let rubbing = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let bonds = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40, "length": 0.8}});
    let far = |document: &mut Value| document["time"]["step"] = json!(0.05);
    in_turn(0, std::slice::from_ref(&tether), far);
    in_turn(1, &[tether.clone(), langevin()], far);
    in_turn(0, &[tether.clone(), langevin(), json!({"type": "dpd", "repulsion": 25})], far);
    in_turn(1, &[tether.clone(), rubbing.clone()], |_| {});
    in_turn(0, &[tether, rubbing, bonds, langevin()], |_| {});
}

#[test]
fn friction_along_bonds_agrees_with_the_reference() {
    let rubbing = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let repulsion = json!({"type": "dpd", "repulsion": 25});
    let harmonic = json!({"type": "harmonic", "stiffness": 40, "length": 0.8});
    let bonds = json!({"type": "bonds", "potential": harmonic, "friction": 6, "exclude_repulsion": true});
    let strong = json!({"type": "bonds", "friction": 1e9});
    let cold = json!({"type": "bonds", "friction": 3, "bath": {"type": "white", "temperature": 0}});
    // A ring has three rounds, and bonds across it more; particles of two masses.
    let across = json!({"type": "bonds", "potential": harmonic, "pairs": [[0, 2], [1, 3], [4, 400], [400, 401]]});
    let rings = |document: &mut Value| document["particles"][0]["chain"]["closed"] = json!(true);
    let one = |document: &mut Value| {
        document["particles"] = json!([{"species": "A", "count": 120, "chain": {"beads": 3, "closed": true}}]);
        document["noise"] = json!({"generator": "threefry2x32-20"});
    };
    in_turn(0, std::slice::from_ref(&strong), |_| {});
    in_turn(1, &[bonds.clone(), rubbing.clone()], rings);
    in_turn(0, &[bonds.clone(), repulsion, langevin()], one);
    in_turn(1, &[strong, rubbing, cold, json!({"type": "angles", "stiffness": 3})], one);
    let mut crossed = across;
    crossed["friction"] = json!(2);
    agree(&crowd(&[20.0, 20.0], &[bonds, crossed]));
}

#[test]
fn baths_at_their_ends_agree_with_the_reference() {
    let one = |document: &mut Value| {
        document["particles"] = json!([{"species": "A", "count": 300}]);
        document["noise"] = json!({"generator": "threefry2x32-20"});
    };
    // One species, of which the coefficients are constants; a temperature of its own, and none.
    for (number, temperature) in [0.4, 0.0].into_iter().enumerate() {
        let bath = json!({"type": "white", "temperature": temperature});
        in_turn(number, &[json!({"type": "langevin", "friction": 1.5, "bath": bath})], one);
    }
    // Next to no friction, and one that leaves nothing of a momentum.
    for (number, friction) in [1e-9, 1e3, 1e12].into_iter().enumerate() {
        in_turn(number, &[json!({"type": "langevin", "friction": friction})], one);
    }
    in_turn(1, &[json!({"type": "langevin", "species": [{"name": "A", "friction": 1e6}]})], |_| {});
}
