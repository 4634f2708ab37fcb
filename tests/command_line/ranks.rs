//! Runs of several ranks: the files of one.

use mesoscope::output::files;
use serde_json::json;

use crate::support::program::{Place, bytes, fails, succeeds, succeeds_and_tells};

/// Chains in a solvent, with springs as soft as one likes.
fn chains(stiffness: f64) -> Place {
    Place::of(json!({
        "title": "chains",
        "space": {"box": [4, 4, 10]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 1,
        "particles": [
            {"species": "chain", "count": 240, "chain": {"beads": 12, "spacing": 0.6}}, {"species": "solvent", "count": 200}
        ],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": stiffness, "length": 0.6}},
            {"type": "angles", "stiffness": 4},
        ],
        "output": {
            "energies": {"every": 5},
            "chain_sizes": {"every": 10},
            "trajectory": {"every": 10},
            "checkpoint": {"every": 20},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    }))
}

const FILES: [&str; 5] =
    [files::ENERGIES, files::TRAJECTORY_GSD, files::CHECKPOINT, files::SNAPSHOT, "chain_sizes.csv"];

#[track_caller]
fn same_files(place: &Place, one: &str, other: &str) {
    for name in FILES {
        let [one, other] = [one, other].map(|run| bytes(&place.path(run).join(name)));
        assert!(one == other, "{name} differs");
    }
}

#[test]
fn bonds_give_the_files_of_one_rank_and_go_on_with_others() {
    let place = chains(50.0);
    place.run("alone", &["--quiet"]);
    place.run("shared", &["--quiet", "--ranks", "2", "--steps", "20"]);
    succeeds(&["resume", &place.argument("shared"), "--steps", "40", "--ranks", "1,1,3", "--quiet"]);
    same_files(&place, "alone", "shared");
    let ranks = serde_json::to_value(place.summary("shared").ranks).unwrap();
    assert_eq!((&ranks["parts"], ranks["ranks"].as_array().map(Vec::len)), (&json!([1, 1, 3]), Some(3)));
    let told = succeeds(&["check", &place.scene(), "--ranks", "2"]);
    assert!(told.contains("of its work is its own"), "{told}");
}

/// Bonds that are longer than expected cost a way back, and no byte.
#[test]
fn long_bonds_are_told_and_change_nothing() {
    let mut place = chains(2000.0);
    place.scene["particles"][0]["chain"]["spacing"] = json!(1.8);
    place.scene["time"]["step"] = json!(0.004);
    place.run("alone", &["--quiet"]);
    let (scene, out) = (place.scene(), place.argument("shared"));
    let (_, told) = succeeds_and_tells(&["run", &scene, "--out", &out, "--ranks", "2"]);
    assert!(told.contains("note: a bond is longer than expected; continuing from step 0 with wider halos"), "{told}");
    same_files(&place, "alone", "shared");
}

#[test]
fn everything_that_hinders_is_told() {
    let mut place = chains(50.0);
    place.scene["integrator"] = json!({"type": "cotter-reich"});
    place.scene["interactions"][1]["friction"] = json!(3);
    place.scene["interactions"][1]["bath"] = json!({"type": "memory", "rate": 2});
    place.scene["output"]["profiles"] = json!({"axis": "y", "bins": 3, "every": 2});
    let reasons = [
        "baths with memory: on one rank only",
        "unless steps are split",
        "`output.profiles` is measured on one device",
    ];
    fails(&["run", &place.scene(), "--out", &place.argument("out"), "--ranks", "2"], 2, &reasons);
}
