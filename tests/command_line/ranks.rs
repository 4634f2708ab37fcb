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
    let noise = json!({"type": "coloured-noise", "strength": 1, "time": 0.1});
    place.scene["interactions"].as_array_mut().unwrap().push(noise);
    place.scene["output"]["profiles"] = json!({"axis": "y", "bins": 3, "every": 2});
    let reasons = [
        "a bath with memory on every bond in interactions[1]: on one rank only (not implemented: what a bath or",
        "coloured noise in interactions[3]: on one rank only",
        "`profiles` in output.profiles: on one rank only (not implemented: measured on one device)",
    ];
    fails(&["run", &place.scene(), "--out", &place.argument("out"), "--ranks", "2"], 2, &reasons);
}

/// Every scene that several ranks cannot share is refused with what they can.
#[test]
fn what_is_not_shared_is_told_with_what_is() {
    let memory = r#"interactions=[{"type":"dpd","friction":1,"bath":{"type":"memory","rate":2}}]"#;
    for (scene, changes, reason) in [
        ("voronoi-dpd", &[][..], "scenes of this kind: on one rank only"),
        ("harmonic-chain", &[], "harmonic chains in interactions[0]: on one rank only"),
        ("coloured-noise", &[], "coloured noise in interactions[1]: on one rank only"),
        (
            "dpd-fluid",
            &["integrator.type=cotter-reich", memory],
            "pairs with memory in interactions[0]: on one rank only",
        ),
        (
            "dpd-fluid",
            &["integrator.type=cotter-reich", "space.box=[40]"],
            "a box of one dimension in space.box: on one rank only",
        ),
        ("gle-oscillator", &[], "on one rank only"),
        ("dpd-fluid", &[r#"output.stress={"every":10}"#], "`stress` in output.stress: on one rank only"),
    ] {
        let set = changes.iter().flat_map(|change| ["--set", change]);
        let arguments: Vec<&str> = ["check", scene, "--ranks", "2"].into_iter().chain(set).collect();
        fails(&arguments, 2, &[reason, "they share particles with pair forces", "docs/guide/ranks.md"]);
    }
}

/// Numbers of ranks that make no sense or do not fit, however large.
#[test]
fn wrong_numbers_of_ranks_are_refused() {
    for (ranks, part) in [
        ("2,2", "`--ranks 2,2` has 2 numbers, where the box has 3 axes"),
        ("4294967295", "parts fits: each has to be wider than"),
        ("4096", "narrower than the box; "),
        ("1,1,4000000", "4000000 parts along z are too thin"),
        ("0", "a whole number from 1 on"),
        ("4294967296", "a whole number from 1 on"),
    ] {
        fails(&["check", "dpd-fluid", "--set", "output={}", "--ranks", ranks], 2, &[part]);
    }
    let changes = ["--set", "interactions.0.mesh=[32,32]", "--set", "particles.0.count=16384"];
    fails(&[&["check", "shallow-water", "--ranks", "4294967295"][..], &changes].concat(), 2, &["32 rows of cells"]);
}

/// All particles in the part of one rank: the others have nothing to do, and the one needs more memory.
#[test]
fn particles_may_all_be_with_one_rank() {
    let place = |number: usize, spacing: f64| 0.2 + spacing * number as f64;
    let positions: Vec<[f64; 3]> = (0..8000)
        .map(|number| [place(number % 20, 0.58), place(number / 20 % 20, 0.58), place(number / 400, 0.58)])
        .collect();
    let place = Place::of(json!({
        "title": "one part",
        "integrator": {"type": "groot-warren"},
        "space": {"box": [12, 12, 48]},
        "time": {"step": 0.005, "steps": 12},
        "temperature": 1,
        "particles": [{"species": "A", "count": 8000, "placement": {"type": "listed", "positions": positions}}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {"energies": {"every": 3}, "plot": {"width": 320, "height": 240}, "snapshot": {"width": 100, "height": 80}},
    }));
    place.run("alone", &["--quiet"]);
    let (scene, out) = (place.scene(), place.argument("shared"));
    let (_, told) = succeeds_and_tells(&["run", &scene, "--out", &out, "--ranks", "1,1,4"]);
    assert!(told.contains("continuing from step 0 with more memory"), "{told}");
    for name in [files::ENERGIES, files::CHECKPOINT, files::SNAPSHOT] {
        assert!(bytes(&place.path("alone").join(name)) == bytes(&place.path("shared").join(name)), "{name}");
    }
    let shared = place.summary("shared").ranks.unwrap();
    assert!(shared.alike && shared.slowest_over_mean >= 1.0, "{shared:?}");
}

/// More ranks than adapters, and what to expect of them.
#[test]
fn ranks_that_share_an_adapter_are_told_of() {
    let fluid = ["dpd-fluid", "--set", "output={}", "--ranks", "2", "--adapter", "0"];
    let water = ["shallow-water", "--set", "output={}", "--ranks", "2", "--adapter", "0"];
    for scene in [fluid, water] {
        let found = succeeds(&[&["check"][..], &scene].concat());
        assert!(found.contains("warning: 2 ranks share 1 adapter of this machine: they take turns on it"), "{found}");
        let speed = found.lines().find(|line| line.trim_start().starts_with("speed")).unwrap();
        assert!(speed.contains("times that of one rank") && speed.contains("PCIe 4"), "{speed}");
    }
}
