//! Shallow water as its user meets it: files, bytes, messages and exit codes of the program.

use std::f64::consts::{PI, TAU};
use std::fs;
use std::path::Path;

use mesoscope::output::{Summary, checkpoint, files, read_table};
use mesoscope::scene::AnalysisId;
use serde_json::json;

use crate::support::program::{Place, bytes, colours, command, fails, listing, mesoscope, size, succeeds, text};

/// A scene of 1024 particles, two loops and small pictures.
fn place() -> Place {
    Place::of(json!({
        "title": "small sea",
        "seed": 3,
        "space": {"box": [TAU, TAU]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 4e-4,
        "particles": [
            {"species": "water", "count": 1024, "placement": {"type": "lattice"}, "velocities": {"type": "geostrophic"}},
            {"species": "dye", "count": 5, "tracer": true},
            {"species": "inner", "count": 200, "tracer": true, "velocities": {"type": "geostrophic"},
             "placement": {"type": "circle", "center": [3, 3], "radius": 0.5}},
            {"species": "outer", "count": 400, "tracer": true, "velocities": {"type": "geostrophic"},
             "placement": {"type": "circle", "center": [3, 3], "radius": 1}},
        ],
        "interactions": [{
            "type": "shallow-water", "mesh": [16, 16],
            "wave_speed": TAU, "rotation": TAU,
            "smoothing": {"length": 0.8},
            "surface": [{"type": "bump", "center": [3, 3], "radius": 1, "amplitude": 0.1}],
            "bath": {"type": "memory", "epsilon": 1},
        }],
        "output": {"energies": {"every": 4}, "plot": {"width": 640, "height": 480}},
    }))
}

/// Shape and values of an array of numpy's format 1.0 in 64-bit floats.
fn array(path: &Path) -> (String, Vec<f64>) {
    let bytes = bytes(path);
    assert_eq!(bytes[..8], *b"\x93NUMPY\x01\x00", "{}", path.display());
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = text(&bytes[10..10 + length]).to_owned();
    assert!(header.contains("'descr': '<f8'") && header.contains("'fortran_order': False"), "{header}");
    let values = bytes[10 + length..].chunks_exact(8).map(|number| f64::from_le_bytes(number.try_into().unwrap()));
    (header, values.collect())
}

/// Without a rotation, from rest: the circulation is 0 and stays so.
#[test]
fn circulations_of_nothing() {
    let place = place().with("/interactions/0/rotation", json!(0)).with(
        "/particles",
        json!([
            {"species": "water", "count": 1024, "placement": {"type": "lattice"}, "velocities": {"type": "rest"}},
            {"species": "inner", "count": 200, "tracer": true, "velocities": {"type": "rest"},
             "placement": {"type": "circle", "center": [3, 3], "radius": 0.5}},
            {"species": "outer", "count": 2, "tracer": true, "velocities": {"type": "rest"},
             "placement": {"type": "circle", "center": [3, 3], "radius": 0.1}},
        ]),
    );
    let said = place.run("out", &[]);
    assert!(said.contains("circulation of `inner`  0.0000, changes by up to"), "{said}");
    assert!(!said.contains("circulation of `outer`"), "{said}");
    let summary = place.summary("out");
    let circulation = &summary.results["circulation"];
    assert_eq!(circulation["inner"]["initial"]["value"], 0.0);
    assert!(circulation["inner"]["largest_relative_change"].is_null(), "{circulation}");
    let change = circulation["inner"]["largest_change"]["value"].as_f64().unwrap();
    assert!(change < 1e-5, "{change}");
    // Two points are no loop.
    let nothing =
        json!({"initial": null, "resolved_until": null, "largest_change": null, "largest_relative_change": null});
    assert_eq!(circulation["outer"], nothing);
}

/// The summary says what arrays hold: their quantity, the places of the nodes, and the steps of those with numbers.
#[test]
fn arrays_of_fields_are_described() {
    let fields = json!({"every": 16, "quantities": ["depth", "vorticity"]});
    let place = place().with("/output/fields", fields).with("/space/box", json!([TAU, 2.0 * TAU]));
    let place = place.with("/interactions/0/mesh", json!([16, 32]));
    place.run("out", &["--no-pictures", "--quiet"]);
    let summary = place.summary("out");
    let mesh = summary.mesh.unwrap();
    assert!(array(&place.path("out/depth-000002.npy")).0.contains("(16, 32,)"));
    assert_eq!((mesh.nodes, mesh.spacing), ([16, 32], [TAU / 16.0; 2]));
    let steps: Vec<_> = summary.numbered.iter().map(|frame| (frame.number, frame.step)).collect();
    assert_eq!(steps, [(1, 0), (2, 16), (3, 32)]);
    let described = &summary.columns["vorticity.npy"][0];
    assert_eq!((&described.symbol[..], &described.unit[..]), ("ζ", "1/time unit"));
    // Loops have names of their own, and are of no species.
    let circulations = &summary.columns["circulation.csv"];
    assert_eq!(circulations.iter().map(|column| &column.name[..]).collect::<Vec<_>>(), ["time", "inner", "outer"]);
    assert!(circulations.iter().all(|column| column.species.is_empty()) && circulations[1].symbol == "Γ");
}

/// What the plan for any adapter would need lavapipe cannot bind; what it needs itself it can.
#[test]
fn a_large_mesh_is_planned_for_the_adapter_that_is_there() {
    let place = place().with("/interactions/0/mesh", json!([2048, 2048]));
    let output = command(&["check", "-v", &place.scene()]).env_remove("MESOSCOPE_PLAN").output().unwrap();
    let said = text(&output.stdout);
    assert!(output.status.success() && said.contains("2048 × 2048 nodes"), "{said}{}", text(&output.stderr));
    assert!(!said.contains("no adapter that can run it"), "{said}");
}

#[test]
fn a_run_leaves_everything_the_scene_asks_for() {
    let place = place().with(
        "/output/fields",
        json!({"every": 15,
            "quantities": ["depth", "potential-vorticity", "vorticity", "speed", "velocity-x", "velocity-y"]}),
    );
    let said = place.run("out", &[]);
    let out = place.path("out");
    assert!(said.starts_with("small sea: 1629 particles in 2 dimensions, on "), "{said}");
    assert!(said.contains("circulation of `outer`  17.") && said.contains("3 numbered frames of each field"), "{said}");
    let mut expected: Vec<String> =
        ["checkpoint.bin", "circulation.csv", "circulation.png", "energies.csv", "energies.png", "run.json"]
            .map(str::to_owned)
            .to_vec();
    for stem in ["depth", "potential_vorticity", "vorticity", "speed", "velocity_x", "velocity_y"] {
        for extension in ["png", "npy"] {
            expected.push(format!("{stem}.{extension}"));
            // Steps 0, 15 and 30; the end has no number of its own.
            expected.extend((1..=3).map(|number| format!("{stem}-00000{number}.{extension}")));
        }
    }
    expected.sort();
    assert_eq!(listing(&out), expected);
    for name in expected.iter().filter(|name| !name.contains('-') && (name.contains(".png") || name.contains(".npy"))) {
        assert!(said.contains(name.as_str()), "`{name}` is not in: {said}");
    }
    for name in expected.iter().filter(|name| Path::new(name).extension().is_some_and(|extension| extension == "png")) {
        assert_eq!(size(&out.join(name)).1, 480, "{name}");
        assert!(colours(&out.join(name)) > 20, "{name} is empty");
    }

    let (header, depth) = array(&out.join("depth.npy"));
    assert!(header.contains("'shape': (16, 16,)"), "{header}");
    assert!((depth.iter().sum::<f64>() / 256.0 - 1.0).abs() < 1e-6, "the mean depth is 1");
    let (_, first) = array(&out.join("depth-000001.npy"));
    assert_ne!(first, depth);
    // The hill of a tenth at (3, 3), near node (8, 8).
    let highest = (0..256).max_by(|a, b| first[*a].total_cmp(&first[*b])).unwrap();
    assert_eq!((highest / 16, highest % 16), (8, 8));
    let [speed, along_x, along_y] =
        ["speed", "velocity_x", "velocity_y"].map(|stem| array(&out.join(format!("{stem}.npy"))).1);
    for node in 0..256 {
        assert!((speed[node] - along_x[node].hypot(along_y[node])).abs() <= 1e-6 * speed[node], "node {node}");
    }
    let (_, vorticity) = array(&out.join("potential_vorticity-000001.npy"));
    // Far from the hill it is f₀ at a depth of nearly 1.
    assert!((vorticity[0] / TAU - 1.0).abs() < 0.1, "{}", vorticity[0]);

    let energies = read_table(&out.join(files::ENERGIES)).unwrap();
    let columns = "step,time,kinetic_energy,potential_energy,total_energy,bath_energy,extended_energy,bath_square,temperature,\
                   momentum_x,momentum_y,center_of_mass_velocity_x,center_of_mass_velocity_y";
    assert_eq!(energies.columns.join(","), columns);
    assert_eq!(energies.column("step").unwrap(), (0..=10).map(|row| f64::from(4 * row)).collect::<Vec<_>>());
    for row in &energies.rows {
        assert_eq!((row[4], row[6]), (row[2] + row[3], row[2] + row[3] + row[5]));
    }
    let circulation = read_table(&out.join(AnalysisId::Circulation.table())).unwrap();
    assert_eq!(circulation.columns, ["time", "inner", "outer"]);
    assert_eq!(circulation.rows.len(), 11);
    // f₀ times the area, and the flow's share.
    for (name, area) in [("inner", 0.25 * PI), ("outer", PI)] {
        let values = circulation.column(name).unwrap();
        assert!((values[0] / (TAU * area) - 1.0).abs() < 0.2, "{name}: {}", values[0]);
        assert!(values.iter().all(|value| (value / values[0] - 1.0).abs() < 1e-3), "{name}: {values:?}");
    }
    let summary = Summary::load(&out.join(files::SUMMARY)).unwrap();
    let inner = circulation.column("inner").unwrap();
    let change = inner.iter().map(|value| (value - inner[0]).abs()).fold(0.0, f64::max);
    assert_eq!(summary.results["circulation"]["inner"]["largest_change"]["value"], change);
    assert_eq!((summary.steps, summary.particles), (40, 1629));
    assert!(summary.results["circulation"]["outer"]["initial"]["value"].is_number(), "{:?}", summary.results);
    assert!(summary.conserved_exactly.iter().any(|entry| entry.contains("mass on the mesh")));
    assert!(summary.not_conserved.iter().any(|entry| entry.contains("bath on the mesh")));
    assert!(summary.warnings.is_empty(), "{:?}", summary.warnings);
}

#[test]
fn a_plain_scene_leaves_depth_and_potential_vorticity() {
    let place = place()
        .with("/particles", json!([{"species": "water", "count": 512, "velocities": {"type": "rest"}}]))
        .with("/temperature", json!(0))
        .without("/interactions/0/bath");
    let said = place.run("out", &[]);
    let expected = [
        "checkpoint.bin",
        "depth.npy",
        "depth.png",
        "energies.csv",
        "energies.png",
        "potential_vorticity.npy",
        "potential_vorticity.png",
        "run.json",
    ];
    assert_eq!(listing(&place.path("out")), expected);
    assert!(said.contains("total energy ") && !said.contains("temperature") && !said.contains("snapshot"), "{said}");
    let energies = place.table("out", files::ENERGIES);
    assert!(
        !energies.columns.iter().any(|name| name.contains("bath") || name.contains("extended")),
        "{:?}",
        energies.columns
    );
    let summary = place.summary("out");
    assert!(summary.not_conserved[0].contains("only as well as the time step"), "{:?}", summary.not_conserved);
}

#[test]
fn the_same_scene_gives_the_same_bytes_and_half_a_run_resumed_is_a_whole_run() {
    for (integrator, bath) in [("gyro", json!({"type": "memory", "epsilon": 1})), ("rotate", json!({"type": "white"}))]
    {
        let place = place()
            .with("/integrator", json!({"type": integrator}))
            .with("/interactions/0/bath", bath)
            .with("/output/fields", json!({"every": 10}))
            .with("/output/trajectory", json!({"every": 8}));
        // Step 20 falls on a row and a picture, step 13 on nothing.
        place.whole_again_and_in_parts();
        let whole = listing(&place.path("whole"));
        assert!(whole.contains(&"potential_vorticity-000005.npy".to_owned()), "{whole:?}");
    }
}

#[test]
fn plots_can_be_drawn_again() {
    let place = place().with("/output/fields", json!({"every": 0, "quantities": ["depth", "speed"]}));
    place.run("out", &["--quiet"]);
    let out = place.path("out");
    let before =
        place.draws_again(&["energies.png", "circulation.png", "depth.png", "speed.png", "depth.npy", "speed.npy"]);
    succeeds(&["plot", &place.argument("out"), "--set", "output.plot.height=600", "--set", "output.plot.theme=dark"]);
    assert_eq!(size(&out.join("depth.png")).1, 600);
    assert_eq!(size(&out.join("circulation.png")), (640, 600));
    assert_ne!(bytes(&out.join("speed.png")), before[3]);
}

#[test]
fn nothing_is_overwritten_unless_asked() {
    let place = place().with("/output/fields", json!({"every": 20}));
    place.run("out", &["--quiet"]);
    let out = place.argument("out");
    let before = bytes(&place.path("out").join("depth.npy"));
    fails(&["run", &place.scene(), "--out", &out, "--set", "seed=5"], 5, &["checkpoint.bin", "--force", "--out"]);
    assert_eq!(bytes(&place.path("out").join("depth.npy")), before);
    fs::write(place.path("out").join("depth-notes.txt"), "mine").unwrap();
    place.run("out", &["--quiet", "--force", "--set", "seed=5", "--set", "output.fields.every=0"]);
    assert_ne!(bytes(&place.path("out").join("depth.npy")), before);
    // What belonged to the earlier run is gone, and what belongs to the user is not.
    let names = listing(&place.path("out"));
    assert!(!names.iter().any(|name| name.contains("-0000")), "{names:?}");
    assert!(names.contains(&"depth-notes.txt".to_owned()));
}

#[test]
fn a_crowd_makes_the_run_go_on_with_more_memory() {
    // Two thousand particles in one cell of 64, so little water each that it hardly moves.
    let positions: Vec<[f64; 2]> =
        (0..2000).map(|index| [3.2 + 1e-4 * f64::from(index % 50), 3.2 + 1e-3 * f64::from(index / 50)]).collect();
    let place = place()
        .with("/particles", json!([{"species": "water", "placement": {"type": "listed", "positions": positions}, "velocities": {"type": "rest"}}]))
        .with("/interactions/0/mesh", json!([8, 8]))
        .with("/interactions/0/surface", json!([]))
        .with("/time", json!({"step": 1e-5, "steps": 12}));
    let (scene, out) = (place.scene(), place.argument("out"));
    for storage_is_of_bins in [true, false] {
        let output = mesoscope(&["run", &scene, "--out", &out, "--force"]);
        let said = text(&output.stderr);
        assert!(output.status.success(), "{said}");
        assert!(
            said.contains(
                "note: too many particles are in one cell of the mesh; continuing from step 0 with more memory"
            ),
            "{said}"
        );
        let energies = place.table("out", files::ENERGIES);
        assert_eq!(energies.column("step").unwrap(), [0.0, 4.0, 8.0, 12.0]);
        if storage_is_of_bins {
            // A resumed run meets the same crowd.
            succeeds(&["resume", &out, "--steps", "16"]);
            let energies = place.table("out", files::ENERGIES);
            assert_eq!(energies.rows.len(), 5);
            succeeds(&["plot", &out]);
        }
    }
}

#[test]
fn an_unstable_run_is_reported_with_its_step_and_a_step_that_works() {
    let place = place()
        .with("/time", json!({"step": 2.3, "steps": 4000}))
        .with("/output/checkpoint", json!({"every": 1000}))
        .without("/interactions/0/bath");
    let (scene, out) = (place.scene(), place.argument("out"));
    let message = fails(
        &["run", &scene, "--out", &out],
        4,
        &[
            "became unstable at step ",
            "; try a time step of 0.",
            "checkpoint, of step 0",
            "warning: time.step: the rotation turns a particle by 14.451 in one step",
        ],
    );
    assert_eq!(checkpoint::load(&place.path("out").join(files::CHECKPOINT)).unwrap().state.step, 0);
    assert!(!place.path("out").join(files::SUMMARY).exists());
    let suggested = message.split("try a time step of ").nth(1).unwrap().split(' ').next().unwrap();
    let step = format!("time.step={suggested}");
    let output = mesoscope(&["run", &scene, "--out", &out, "--force", "--set", &step, "--steps", "400"]);
    assert!(output.status.success(), "{suggested}: {}", text(&output.stderr));
    assert!(!text(&output.stderr).contains("warning"), "{}", text(&output.stderr));
}

#[test]
fn a_negative_depth_is_named() {
    let place = place()
        .with("/particles", json!([{"species": "water", "placement": {"type": "listed", "positions": [[PI, PI]]}}]))
        .with("/temperature", json!(0))
        .with("/interactions/0/surface", json!([]))
        .with("/interactions/0/smoothing", json!({"length": 0.2, "solver": {"type": "fft", "symbol": "spectral"}}))
        .with("/interactions/0/spline_order", json!(1))
        .without("/interactions/0/bath");
    fails(
        &["run", &place.scene(), "--out", &place.argument("out")],
        4,
        &[
            "became unstable at step 0: the depth at mesh node (",
            "where x = ",
            ", is negative; no time step helps: ",
            "checkpoint, of step 0",
        ],
    );
}

#[test]
fn wrong_scenes_run_nothing() {
    let place = place();
    let (scene, out) = (place.scene(), place.argument("out"));
    for (change, part) in [
        ("interactions.0.mesh=[12,16]", "the solver `chebyshev`, which takes any mesh"),
        ("interactions.0.smoothing.length=0", "interactions[0].bath"),
        ("interactions.0.smoothing.length=-1", "interactions[0].smoothing.length: found -1"),
        ("interactions.0.mesh=[2,16]", "the width of a spline of order 3"),
        ("interactions.0.rotation=0", "geostrophic"),
    ] {
        fails(&["run", &scene, "--out", &out, "--set", change], 2, &[part]);
    }
    assert!(!place.path("out").exists());
}

#[test]
fn check_says_what_the_scene_requires() {
    let said = succeeds(&["check", "--kernels", "shallow-water"]);
    for part in [
        "65,536 in 2 dimensions",
        "gyro, time step 0.02",
        "mesh",
        "64 × 64 nodes, splines of order 3, 16.0 particles a node",
        "smoothing",
        "fft, five-point",
        "stability",
        "of the limit",
        "deposit",
        "smooth rows",
        "mesh/pass/push",
        "node_masses",
        "depth.png",
        "potential_vorticity.npy",
        "a row every",
    ] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    assert!(!said.contains("\n  cells "), "{said}");
    assert!(!said.contains("bath"), "a scene without a bath needs nothing of one: {said}");
    let said = succeeds(&["check", "--kernels", "shallow-water-memory"]);
    for part in ["memory, epsilon 1, cotter-reich", "mesh_bath", "BATH_NOISE", "node_bath"] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    let place = place()
        .with("/interactions/0/bath", json!({"type": "white"}))
        .with("/interactions/0/mesh", json!([12, 10]))
        .with("/interactions/0/smoothing/solver", json!({"type": "chebyshev"}))
        .with("/output/fields", json!({"every": 5, "quantities": ["speed"]}));
    // The page is printed whole where the trial becomes unstable.
    let output = mesoscope(&["check", "--kernels", &place.scene(), "--set", "time.step=0.4"]);
    assert_eq!(output.status.code(), Some(4));
    let said = text(&output.stdout);
    for part in [
        "1024 of water and 605 tracers, in 2 dimensions",
        "12 × 10 nodes",
        "chebyshev, tolerance 0.000001",
        "iterations",
        "white",
        "push_tracers",
        "circulation.csv",
        "speed-….png",
        "every 5 steps",
        "warning: time.step: the stiffest wave on the mesh takes p = ",
    ] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    assert!(!place.path("scene").exists());
}
