//! Voronoi DPD as its user meets it: files, bytes, messages and exit codes of the program.

use mesoscope::output::{checkpoint, files};
use mesoscope::scene::AnalysisId;
use mesoscope::table::Table;
use serde_json::{Value, json};

use crate::support::program::{Place, bytes, colours, listing, mesoscope, succeeds, text};

/// A scene of 144 cells and small pictures.
fn place() -> Place {
    Place::of(json!({
        "title": "small foam",
        "seed": 3,
        "space": {"box": [12, 12]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 1,
        "particles": [{"species": "A", "count": 144, "mass": 5, "placement": {"type": "lattice", "jitter": 0.3}}],
        "interactions": [{"type": "voronoi"}],
        "output": {
            "energies": {"every": 4},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 400, "height": 400},
            "neighbours": {"every": 10},
        },
    }))
}

/// All values of a column, which are finite.
#[track_caller]
fn column(table: &Table, name: &str) -> Vec<f64> {
    let column = table.column(name).unwrap_or_else(|| panic!("no column `{name}` in {:?}", table.columns));
    assert!(column.iter().all(|value| value.is_finite()), "{name}: {column:?}");
    column
}

const WAVE: &str = r#"{"type":"shear-wave","amplitude":0.3}"#;

fn wave() -> Value {
    serde_json::from_str(WAVE).unwrap()
}

#[test]
fn a_run_leaves_everything_the_scene_asks_for() {
    let place = place()
        .with("/particles/0/velocities", wave())
        .with("/output/shear_wave", json!({"every": 2}))
        .with("/output/trajectory", json!({"every": 20}))
        .with("/output/snapshot/every", json!(20));
    let said = place.run("out", &[]);
    assert!(said.contains("small foam: 144 particles in 2 dimensions"), "{said}");
    for part in ["temperature", "pressure", "neighbours of a cell", "shear viscosity (wave)", "3 numbered snapshots"] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    let expected = [
        "checkpoint.bin",
        "energies.csv",
        "energies.png",
        "neighbours.csv",
        "neighbours.png",
        "run.json",
        "shear_wave.csv",
        "shear_wave.png",
        "snapshot-000001.png",
        "snapshot-000002.png",
        "snapshot-000003.png",
        "snapshot.png",
        "trajectory.gsd",
    ];
    assert_eq!(listing(&place.path("out")), expected);
    for name in expected.iter().filter(|name| name.contains("png")) {
        assert!(colours(&place.path("out").join(name)) > 20, "{name} shows nothing");
    }
    let energies = place.table("out", files::ENERGIES);
    assert_eq!(energies.rows.len(), 11);
    assert!(column(&energies, "momentum_x").iter().all(|value| *value == 0.0), "to the last bit");
    assert!(column(&energies, "mass").iter().all(|value| *value == 720.0), "to the last bit");
    assert!(column(&energies, "volume_error").iter().all(|value| value.abs() < 1e-6));
    assert!(column(&energies, "mean_neighbours").iter().all(|value| *value == 6.0));
    for name in
        ["temperature", "pressure", "potential_energy", "limited_exchanges", "solver_iterations", "solver_residual"]
    {
        column(&energies, name);
    }
    for name in ["internal_energy", "configurational_temperature", "pressure_conservative"] {
        assert_eq!(energies.column(name), None, "{name} does not apply");
    }
    let neighbours = place.table("out", AnalysisId::Neighbours.table());
    let sum: f64 = column(&neighbours, "fraction").iter().sum();
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
    let decay = place.table("out", AnalysisId::ShearWave.table());
    assert_eq!(decay.rows.len(), 21);
    let amplitude = column(&decay, "amplitude")[0];
    // A thermal part with the deviation √(2kT/ΣM), and Σ sin² of a lattice with jitter.
    assert!((amplitude - 0.3).abs() < 4.0 * (2.0_f64 / 720.0).sqrt() + 0.02, "{amplitude}");
    let summary = place.summary("out");
    assert_eq!(summary.results["neighbours"]["mean"]["value"], json!(6.0));
    assert_eq!(summary.results["neighbours"]["samples"], json!(5));
    assert_eq!(summary.conserved_exactly, ["mass, to the last bit", "total momentum, to the last bit"]);
    assert!(summary.not_conserved[0].contains("exchanged with the fluid inside the cells"), "{summary:?}");
}

/// Columns, and what is constant to the last bit, of every form with and without energy and by both schemes.
#[test]
fn every_fluid_has_its_columns_and_keeps_what_it_should() {
    for (form, integrator) in [("gradient", "splitting"), ("consistent", "splitting"), ("paper", "euler")] {
        for energy in [false, true] {
            let mut place = place()
                .with("/integrator", json!({"type": integrator}))
                .with("/time/step", json!(0.005))
                .with("/interactions/0/form", json!(form))
                .with("/interactions/0/molecular_mass", json!(0.1));
            if energy {
                place = place
                    .with("/interactions/0/energy", json!({"conductivity": 10}))
                    .with("/output/snapshot/color", json!("temperature"));
            }
            place.run("out", &["--quiet"]);
            let energies = place.table("out", files::ENERGIES);
            let constant = |name: &str| {
                let values = column(&energies, name);
                assert!(values.iter().all(|value| *value == values[0]), "{form}, {energy}: {name} is {values:?}");
            };
            ["mass", "momentum_x", "momentum_y"].into_iter().for_each(constant);
            assert!(column(&energies, "momentum_x")[0] == 0.0);
            let kinetic = column(&energies, "kinetic_energy");
            assert!(kinetic[10] != kinetic[0], "cells move");
            assert_eq!(energies.column("internal_temperature").is_some(), energy);
            assert!(energies.column("limited_exchanges").is_some(), "{form}");
            assert_eq!(energies.column("solver_iterations").is_some(), integrator == "splitting");
            assert_eq!(energies.column("potential_energy").is_some(), form == "gradient" && !energy);
            let summary = place.summary("out");
            if energy {
                constant("total_energy");
                assert_eq!(summary.conserved_exactly.len(), 3);
                assert!(summary.not_conserved.is_empty());
                // 144 cells of 50 molecules, each at kT = 1 but for what it has given to and taken from motion.
                let internal = column(&energies, "internal_temperature")[10];
                assert!((internal - 1.0).abs() < 0.05, "{internal}");
            }
        }
    }
}

#[test]
fn the_same_scene_gives_the_same_bytes_and_half_a_run_resumed_is_a_whole_run() {
    for (form, energy) in [("gradient", json!({"conductivity": 10})), ("paper", Value::Null)] {
        let mut place = place()
            .with("/particles/0/velocities", wave())
            .with("/interactions/0/form", json!(form))
            .with("/interactions/0/molecular_mass", json!(0.1))
            // So small that it acts all the time, and its count has to go on.
            .with("/interactions/0/exchange_limit", json!(0.002))
            .with("/output/shear_wave", json!({"every": 3}))
            .with("/output/snapshot/every", json!(10))
            .with("/output/trajectory", json!({"every": 8}));
        if !energy.is_null() {
            place = place.with("/interactions/0/energy", energy);
        }
        // Step 20 falls on a row, a picture and a sample, step 13 on nothing.
        place.whole_again_and_in_parts();
        let limited = column(&place.table("whole", files::ENERGIES), "limited_exchanges");
        assert!(limited[5] > 0.0 && limited[10] > limited[5], "{limited:?}");
    }
}

#[test]
fn plots_can_be_drawn_again() {
    let place = place().with("/particles/0/velocities", wave()).with("/output/shear_wave", json!({"every": 2}));
    place.run("out", &["--quiet"]);
    let out = place.path("out");
    let before = place.draws_again(&["energies.png", "neighbours.png", "shear_wave.png", "snapshot.png"]);
    succeeds(&["plot", &place.argument("out"), "--set", "output.snapshot.color=speed"]);
    assert_ne!(bytes(&out.join("snapshot.png")), before[3], "another quantity");
}

#[test]
fn the_last_state_is_in_the_checkpoint() {
    let place = place()
        .with("/interactions/0/form", json!("paper"))
        .with("/interactions/0/energy", json!({"conductivity": 1}))
        .with("/interactions/0/molecular_mass", json!(0.1))
        .with("/interactions/0/initial_masses", json!("uniform-density"));
    place.run("out", &["--quiet"]);
    let checkpoint = checkpoint::load(&place.path("out").join(files::CHECKPOINT)).unwrap();
    let model = checkpoint.scene.model();
    let cells = model.voronoi().unwrap();
    let state = checkpoint.state;
    assert_eq!((state.step, state.len(), state.masses.len(), state.energies.len()), (40, 144, 144, 144));
    let mass = state.masses.iter().map(|mass| f64::from(*mass)).sum::<f64>() * cells.mass_unit;
    assert_eq!(mass, 720.0);
    assert_eq!(state.total_momentum(), [0; 3]);
    let energies = place.table("out", files::ENERGIES);
    let total = state.energies.iter().map(|energy| f64::from(*energy)).sum::<f64>() * cells.energy_unit;
    assert_eq!(column(&energies, "total_energy")[10], total);
}

#[test]
fn wrong_scenes_run_nothing() {
    let output = mesoscope(&["run", "voronoi-dpd", "--out", "/nowhere", "--set", "particles.0.fixed=true"]);
    assert_eq!(output.status.code(), Some(2));
    let message = text(&output.stderr);
    assert!(
        message.contains("particles[0].fixed: found in a scene of Voronoi DPD; accepted: cells that move"),
        "{message}"
    );
}

#[test]
fn check_says_what_the_scene_requires() {
    let said = succeeds(&["check", "-v", "voronoi-energy"]);
    for part in [
        "search grid",
        "gradient: constant masses",
        "ideal gas, 125 molecules a cell",
        "tracked in every cell, heat conductivity 1000",
        "5 of friction at faces, about 6.175 of the network of cells",
        "conjugate gradients, at most",
        "neighbours.csv, neighbours.png",
        "snapshot-….png",
    ] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    let said = succeeds(&["check", "-v", "voronoi-dpd"]);
    assert!(said.contains("paper: cells exchange mass") && !said.contains("conjugate gradients"), "{said}");
    let said = succeeds(&["check", "-v", "voronoi-shear"]);
    assert!(said.contains("shear_wave.csv, shear_wave.png") && !said.contains("neighbours.csv"), "{said}");
    let said = succeeds(&["scenes"]);
    for name in ["voronoi-dpd", "voronoi-energy", "voronoi-shear"] {
        assert!(said.contains(name), "`{name}` is not in: {said}");
    }
}

#[test]
fn sweeps_see_the_quantities_of_cells() {
    let place = place().with("/time/steps", json!(20));
    let (scene, out) = (place.scene(), place.argument("sweep"));
    let quantities = ["--plot", "temperature", "--plot", "mean_neighbours", "--plot", "solver_iterations"];
    let said =
        succeeds(&[&["sweep", &scene, "--vary", "time.step=0.01,0.02", "--out", &out], &quantities[..]].concat());
    assert!(said.contains("0.01") && said.contains("0.02"), "{said}");
    for variant in ["step=0.01", "step=0.02"] {
        assert!(place.path("sweep").join(variant).join(files::SUMMARY).exists(), "{:?}", listing(&place.path("sweep")));
    }
}
