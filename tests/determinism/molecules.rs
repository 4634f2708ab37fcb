//! Molecules are what their bonds say: those of one species in a row are chains, to the last bit.

use mesoscope::plan::Options;
use mesoscope::scene::{self, Checked};
use serde_json::{Value, json};

use crate::support::bytes;
use crate::support::{engine, start};

const STEPS: u64 = 24;

fn scene(particles: &Value, molecules: &Value) -> Checked {
    let mut scene = json!({
        "title": "the same twice",
        "seed": 11,
        "space": {"box": [5, 5, 5]},
        "time": {"step": 0.01, "steps": STEPS},
        "temperature": 1,
        "particles": particles,
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 20, "length": 0.6}},
            {"type": "angles", "stiffness": 3},
        ],
        "output": {"energies": {"every": 8}},
    });
    if !molecules.is_null() {
        scene["molecules"] = molecules.clone();
    }
    scene::parse("test", &scene.to_string(), &[]).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn molecules_in_a_row_are_chains() {
    for closed in [false, true] {
        let mut bonds = vec![[0, 1], [1, 2], [2, 3], [3, 4]];
        let mut angles = vec![[0, 1, 2], [1, 2, 3], [2, 3, 4]];
        if closed {
            bonds.push([4, 0]);
            angles.extend([[3, 4, 0], [4, 0, 1]]);
        }
        let molecule = json!([{"beads": ["A", "A", "A", "A", "A"], "bonds": bonds, "angles": angles, "count": 60,
            "spacing": 0.6}]);
        let molecules = scene(&json!([{"species": "A"}]), &molecule);
        let chains =
            scene(&json!([{"species": "A", "count": 300, "chain": {"beads": 5, "closed": closed}}]), &Value::Null);
        let (_, state) = start(&molecules);
        let end = |scene: &Checked| {
            let mut engine = engine(scene, &state, Options::default());
            engine.advance(STEPS, 8).unwrap();
            (engine.state().unwrap(), engine.finish().unwrap())
        };
        let [a, b] = [&molecules, &chains].map(end);
        assert_ne!(a.0.positions, state.positions);
        assert_eq!(a, b, "{closed}");
    }
}

#[test]
fn the_start_depends_on_the_seed_alone() {
    let molecule = json!([
        {"beads": ["A", "B", "B", "B"], "bonds": [[0, 1], [0, 2], [0, 3]], "angles": [[1, 0, 2]], "count": 40},
        {"beads": ["B"], "count": 50},
    ]);
    let particles = json!([{"species": "B"}, {"species": "A"}]);
    let [one, two] = [(); 2].map(|()| start(&scene(&particles, &molecule)).1);
    assert_eq!(one, two);
    assert_eq!((one.len(), one.total_momentum()), (210, [0; 3]));
    let base = scene(&particles, &molecule);
    let changed = scene::parse("test", &serde_json::to_string(&base).unwrap(), &["seed=12".to_owned()]).unwrap();
    let other = start(&changed).1;
    assert!(other.positions != one.positions && other.species == one.species);
    // The order in which kinds are listed is that of the particles.
    assert_eq!((one.species[0], one.species[1], one.species[209]), (1, 0, 0));
    let plain = bytes::run(&base, Options::default(), STEPS, 8);
    assert!(bytes::same(
        &plain,
        &bytes::run(&base, Options { workgroup_size: Some(32), ..Options::default() }, STEPS, 5)
    ));
}
