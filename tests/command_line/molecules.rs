//! Molecules from the scene to the files of a run.

use mesoscope::output::files;
use mesoscope::scene;
use serde_json::{Value, json};

use crate::support::program::{Place, bytes, succeeds};

fn surfactant() -> Value {
    json!({
        "title": "surfactants in water",
        "seed": 3,
        "space": {"box": [5, 5, 6]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 1,
        "particles": [{"species": "head", "mass": 1.5}, {"species": "tail"}, {"species": "water"}],
        "molecules": [
            {"beads": ["head", "tail", "tail"], "bonds": [[0, 1], [1, 2]], "bond_types": ["joint", "backbone"],
                "angles": [[0, 1, 2]], "count": 30, "spacing": 0.7},
            {"beads": ["water"], "number_density": 2},
        ],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "types": ["backbone"], "potential": {"type": "harmonic", "stiffness": 50, "length": 0.7}},
            {"type": "bonds", "types": ["joint"], "potential": {"type": "harmonic", "stiffness": 20, "length": 0.5}},
            {"type": "angles", "stiffness": 4},
        ],
        "output": {
            "energies": {"every": 5},
            "trajectory": {"every": 10},
            "checkpoint": {"every": 20},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    })
}

/// Between layers of frozen particles, and with a species that no bead has.
fn confined() -> Value {
    let mut scene = surfactant();
    scene["space"]["walls"] = json!({"z": {}});
    let layer = json!({"species": "wall", "number_density": 3, "placement": {"type": "behind-walls", "axis": "z", "thickness": 1}});
    scene["particles"].as_array_mut().unwrap().extend([json!({"species": "oil"}), layer]);
    scene["output"]["chain_sizes"] = json!({"every": 5});
    scene["output"]["radial_distribution"] = json!({"every": 5, "range": 1});
    scene
}

#[test]
fn half_a_run_resumed_is_a_whole_run() {
    half_is_whole(surfactant());
    half_is_whole(confined());
}

fn half_is_whole(scene: Value) {
    let place = Place::of(scene);
    place.run("whole", &["--quiet"]);
    place.run("parts", &["--quiet", "--steps", "20"]);
    succeeds(&["resume", &place.argument("parts"), "--steps", "40", "--quiet"]);
    succeeds(&["plot", &place.argument("parts"), "--set", "output.plot.theme=dark"]);
    for name in [files::ENERGIES, files::TRAJECTORY_GSD, files::CHECKPOINT] {
        let [whole, parts] = ["whole", "parts"].map(|run| bytes(&place.path(run).join(name)));
        assert!(whole == parts, "{name} differs");
    }
    let summary = place.summary("parts");
    assert_eq!(summary.scene, place.summary("whole").scene);
    assert_eq!(summary.scene.molecules.len(), 2);
}

/// The last frame of a trajectory holds the same molecules, whole and of the same types.
#[test]
fn a_trajectory_starts_the_same_molecules() {
    let place = Place::of(surfactant());
    place.run("first", &["--quiet"]);
    let mut next = surfactant();
    next["state"] = json!({"file": "first/trajectory.gsd"});
    next.as_object_mut().unwrap().remove("molecules");
    let types = ["bond 0", "bond 1"];
    for (place, name) in types.into_iter().enumerate() {
        next["interactions"][1 + place]["types"] = json!([name]);
    }
    std::fs::write(place.path("next.json"), next.to_string()).unwrap();
    let [next, before] = [place.path("next.json"), place.path("scene.json")]
        .map(|path| scene::load(path.to_str().unwrap(), &[]).unwrap());
    let bonds = |scene: &scene::Checked| {
        let model = scene.model();
        model.particles().bonds.as_ref().unwrap().iter().map(|bond| (bond.ends, bond.kind)).collect::<Vec<_>>()
    };
    assert_eq!(bonds(&next), bonds(&before));
    let angles = |scene: &scene::Checked| {
        let model = scene.model();
        model.particles().angles.as_ref().unwrap().iter().map(|angle| (angle.ends, angle.kind)).collect::<Vec<_>>()
    };
    assert_eq!(angles(&next).len(), 30);
    assert_eq!(angles(&next), angles(&before));
    // The longest bond is far below half of the box: no molecule was torn at the boundary.
    let spans = next.start().unwrap().bonds.iter().flat_map(|links| links.spans.values()).map(|span| span[1]);
    assert!(spans.fold(0.0, f64::max) < 1.5);
}

#[test]
fn their_number_can_be_varied() {
    let place = Place::of(surfactant());
    let vary = "molecules.0.count=0,10";
    succeeds(&["sweep", &place.scene(), "--vary", vary, "--out", &place.argument("sweep"), "--quiet"]);
    let particles = |run: &str| {
        let groups = place.summary(run).scene.particles;
        groups.iter().map(|group| group.count.unwrap_or(0)).collect::<Vec<_>>()
    };
    assert_eq!(particles("sweep/count=0"), [0, 0, 300]);
    assert_eq!(particles("sweep/count=10"), [10, 20, 300]);
}
