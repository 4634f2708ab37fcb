//! The program as its user meets it: files, bytes, messages and exit codes.

use std::fs;
use std::path::Path;

use mesoscope::output::{Summary, checkpoint, files, read_table};
use mesoscope::scene::AnalysisId;
use serde_json::{Value, json};

use crate::support::gsd;
use crate::support::program::{
    Place, bytes, colours, contents, fails, listing, mesoscope, picture, size, succeeds, succeeds_and_tells, text,
};

/// A scene of 375 particles that takes small pictures.
fn place() -> Place {
    Place::of(json!({
        "title": "small fluid",
        "space": {"box": [5, 5, 5]},
        "time": {"step": 0.03, "steps": 60, "equilibration": 12},
        "temperature": 1,
        "particles": [{"species": "fluid", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 3},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 200, "height": 160},
        },
    }))
}

fn state(directory: &Path) -> mesoscope::state::State {
    checkpoint::load(&directory.join(files::CHECKPOINT)).unwrap().state
}

#[test]
fn a_run_leaves_everything_the_scene_asks_for() {
    // This integrator measures the kinetic energy and shows the particles at the same moment of a step.
    let place = place()
        .with("/integrator", json!({"type": "groot-warren"}))
        .with("/output/snapshot/every", json!(25))
        .with("/output/trajectory", json!({"every": 20, "format": "extended-xyz"}))
        .with("/output/radial_distribution", json!({"every": 5, "range": 2, "bins": 40}))
        .with("/output/diffusion", json!({"every": 3, "window": 4}))
        .with("/output/viscosity", json!({"every": 2, "window": 12}));
    let said = place.run("out", &[]);
    let out = place.path("out");
    for part in
        ["small fluid: 375 particles in 3 dimensions", "temperature", "pressure", "particle-steps/s", "run.json"]
    {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    for name in
        [files::ENERGIES_PLOT, AnalysisId::RadialDistribution.tables()[0].plot, AnalysisId::Diffusion.tables()[0].plot]
    {
        assert_eq!(size(&out.join(name)), (640, 480), "{name}");
        assert!(colours(&out.join(name)) > 10, "{name} is empty");
    }
    for name in ["snapshot.png", "snapshot-000001.png", "snapshot-000002.png", "snapshot-000003.png"] {
        assert_eq!(size(&out.join(name)), (200, 160), "{name}");
        assert!(colours(&out.join(name)) > 10, "{name} is empty");
    }
    assert!(!out.join("snapshot-000004.png").exists());
    let energies = read_table(&out.join(files::ENERGIES)).unwrap();
    let columns = "step,time,kinetic_energy,potential_energy,total_energy,temperature,configurational_temperature,pressure,\
                   pressure_conservative,momentum_x,momentum_y,momentum_z,center_of_mass_velocity_x,\
                   center_of_mass_velocity_y,center_of_mass_velocity_z";
    assert_eq!(energies.columns.join(","), columns);
    let steps: Vec<f64> = (0..=20).map(|row| f64::from(3 * row)).collect();
    assert_eq!(energies.column("step").unwrap(), steps);
    assert_eq!(energies.column("time").unwrap(), steps.iter().map(|step| step * 0.03).collect::<Vec<_>>());
    for row in &energies.rows {
        assert_eq!(row[4], row[2] + row[3]);
        assert_eq!(row[9..], [0.0; 6], "total momentum");
    }
    // One frame is a count, a header and a line for every particle.
    let trajectory = fs::read_to_string(out.join(files::TRAJECTORY_XYZ)).unwrap();
    assert_eq!(trajectory.lines().count(), 4 * (2 + 375));
    let summary = Summary::load(&out.join(files::SUMMARY)).unwrap();
    assert_eq!((summary.steps, summary.particles), (60, 375));
    assert!(summary.particle_steps_per_second > 0.0 && summary.wall_seconds > 0.0);
    assert_eq!(summary.scene.title, "small fluid");
    assert!(summary.conserved_exactly.iter().any(|entry| entry.contains("momentum")));
    assert!(summary.not_conserved.iter().any(|entry| entry.contains("heat bath")));
    let temperature = energies.column("temperature").unwrap();
    let mean = temperature[4..].iter().sum::<f64>() / 17.0;
    assert!((summary.means["temperature"]["value"].as_f64().unwrap() - mean).abs() < 1e-12);
    assert_eq!(summary.means["temperature"]["samples"], 17);
    assert!((summary.means["configurational_temperature"]["value"].as_f64().unwrap() - 1.0).abs() < 0.5);
    let pairs = read_table(&out.join(AnalysisId::RadialDistribution.table())).unwrap();
    let g = pairs.column("radial_distribution").unwrap();
    assert_eq!(g.len(), 40);
    // Far away, pairs are as frequent as in an ideal gas.
    assert!((g[30..].iter().sum::<f64>() / 10.0 - 1.0).abs() < 0.03, "{g:?}");
    assert!(g[0] < 0.9, "{g:?}");
    let results = &summary.results;
    assert_eq!(results["radial_distribution"]["samples"], 10.0);
    let correlation = read_table(&out.join(AnalysisId::Diffusion.table())).unwrap();
    assert_eq!(results["diffusion"]["windows"], 4);
    assert_eq!(correlation.rows.len(), 4);
    assert_eq!(correlation.column("mean_squared_displacement").unwrap()[0], 0.0);
    // The windows begin at steps 12, 24, 36 and 48, and there v·v is twice the kinetic energy.
    let kept = correlation.column("velocity_autocorrelation").unwrap();
    let kinetic = energies.column("kinetic_energy").unwrap();
    let squared = [4, 8, 12, 16].iter().map(|row: &usize| 2.0 * kinetic[*row] / 375.0).sum::<f64>() / 4.0;
    assert!((kept[0] / squared - 1.0).abs() < 1e-6 && kept[3] < kept[0], "{kept:?} from {squared}");
    // A run this short has no viscosity, and says why.
    assert!(summary.warnings.iter().any(|warning| warning.contains("output.viscosity")), "{:?}", summary.warnings);
}

#[test]
fn the_same_scene_gives_the_same_bytes() {
    let place = place();
    place.run("a", &["--quiet"]);
    place.run("b", &["--quiet"]);
    // Where the run stops in between changes nothing either.
    place.run("c", &["--quiet", "--set", "output.checkpoint.every=7", "--set", "output.snapshot.every=11"]);
    for other in ["b", "c"] {
        for name in [files::ENERGIES, files::ENERGIES_PLOT, files::SNAPSHOT] {
            let [a, other_one] = ["a", other].map(|run| contents(&place.path(run), name));
            assert!(a == other_one, "{name} of {other}");
        }
        assert_eq!(state(&place.path("a")), state(&place.path(other)));
    }
    assert_eq!(bytes(&place.path("a").join("checkpoint.bin")), bytes(&place.path("b").join("checkpoint.bin")));
    place.run("d", &["--quiet", "--set", "seed=2"]);
    assert_ne!(state(&place.path("a")).positions, state(&place.path("d")).positions);
}

#[test]
fn half_a_run_resumed_is_a_whole_run() {
    for integrator in
        [json!({"type": "splitting"}), json!({"type": "groot-warren", "lambda": 0.65}), json!({"type": "cotter-reich"})]
    {
        let place = place()
            .with("/integrator", integrator)
            .with("/output/snapshot/every", json!(20))
            .with("/output/trajectory", json!({"every": 10}))
            .with("/output/radial_distribution", json!({"every": 5, "range": 2}))
            .with("/output/viscosity", json!({"every": 1, "window": 8}));
        place.run("whole", &["--quiet"]);
        // Step 30 falls on a row, a frame and a sample of g(r).
        place.run("parts", &["--quiet", "--steps", "30"]);
        succeeds(&["resume", &place.argument("parts"), "--steps", "60", "--quiet"]);
        let (whole, parts) = (place.path("whole"), place.path("parts"));
        for name in [
            files::ENERGIES,
            files::CHECKPOINT,
            AnalysisId::RadialDistribution.table(),
            files::TRAJECTORY_GSD,
            files::ENERGIES_PLOT,
            files::SNAPSHOT,
            "snapshot-000004.png",
        ] {
            assert!(
                bytes(&whole.join(name)) == bytes(&parts.join(name)),
                "{name} differs: {}",
                place.scene["integrator"]
            );
        }
        let [whole, parts] = [whole, parts].map(|path| Summary::load(&path.join(files::SUMMARY)).unwrap());
        assert_eq!(whole.means, parts.means);
        assert_eq!(whole.results, parts.results);
    }
}

/// Frozen particles behind walls are in checkpoints, trajectories and pictures, not in profiles, and a run in parts has the files of a whole one.
#[test]
fn layers_behind_walls_are_in_the_files_of_a_run() {
    let walls = json!({"z": {"lower_velocity": [-1, 0, 0], "upper_velocity": [1, 0, 0]}});
    let placement = json!({"type": "behind-walls", "axis": "z", "thickness": 1});
    let place = place()
        .with("/space/walls", walls)
        .with("/time/steps", json!(40))
        .with(
            "/particles",
            json!([{"species": "fluid", "number_density": 3},
                {"species": "wall", "number_density": 3, "placement": placement}]),
        )
        .with("/output/trajectory", json!({"every": 20, "format": "gsd"}))
        .with("/output/profiles", json!({"axis": "z", "every": 2, "bins": 10}));
    place.whole_again_and_in_parts();
    let whole = place.path("whole");
    assert_eq!(state(&whole).len(), 375 + 150);
    assert!(colours(&whole.join("snapshot.png")) > 10);
    let columns = place.table("whole", "profiles.csv").columns;
    assert!(
        columns.contains(&"number_density".to_owned())
            && !columns.iter().any(|name| name.starts_with("number_density_0"))
    );
    let counted: f64 = place.table("whole", "profiles.csv").values("number_density").iter().sum();
    assert!((counted / 10.0 - 3.0).abs() < 1e-9, "{counted}");

    let mut file = gsd::open(&whole.join(files::TRAJECTORY_GSD));
    let lengths: Vec<f32> = gsd::scalars(&mut file, 0, "configuration/box");
    assert!(lengths[2] > 8.0 && lengths[2] < 8.01, "{lengths:?}");
    let kinds: Vec<u32> = gsd::scalars(&mut file, 0, "particles/typeid");
    for frame in 0..file.frames().unwrap() {
        let positions: Vec<[f32; 3]> = gsd::arrays(&mut file, frame, "particles/position");
        let velocities: Vec<[f32; 3]> = gsd::arrays(&mut file, frame, "particles/velocity");
        for ((kind, [_, _, z]), velocity) in kinds.iter().zip(positions).zip(velocities) {
            if *kind == 0 {
                assert!(z.abs() <= 2.5, "{z}");
            } else {
                assert!(z.abs() >= 2.5 && z.abs() <= 3.5, "{z}");
                assert_eq!(velocity, [z.signum(), 0.0, 0.0]);
            }
        }
    }
}

#[test]
fn resuming_a_finished_run_does_nothing() {
    let place = place();
    place.run("out", &["--quiet"]);
    let before = bytes(&place.path("out").join(files::SUMMARY));
    let said = succeeds(&["resume", &place.argument("out")]);
    assert!(said.contains("is finished at step 60"), "{said}");
    let said = succeeds(&["resume", &place.argument("out"), "--steps", "30"]);
    assert!(said.contains("has reached step 60"), "{said}");
    assert_eq!(bytes(&place.path("out").join(files::SUMMARY)), before);
    // Killed between the last checkpoint and the summary: the rest is written.
    fs::remove_file(place.path("out").join(files::SUMMARY)).unwrap();
    succeeds(&["resume", &place.argument("out"), "--quiet"]);
    assert_eq!(place.summary("out").steps, 60);
}

#[test]
fn nothing_is_overwritten_unless_asked() {
    let place = place();
    fs::create_dir(place.path("out")).unwrap();
    fs::write(place.path("out").join("notes.txt"), "mine").unwrap();
    place.run("out", &["--quiet"]);
    let before = bytes(&place.path("out").join(files::ENERGIES));
    let (scene, out) = (place.scene(), place.argument("out"));
    fails(&["run", &scene, "--out", &out, "--set", "seed=5"], 5, &["checkpoint.bin", "--force", "--out"]);
    assert_eq!(bytes(&place.path("out").join(files::ENERGIES)), before);
    place.run("out", &["--quiet", "--force", "--set", "seed=5"]);
    assert_ne!(bytes(&place.path("out").join(files::ENERGIES)), before);
    assert_eq!(bytes(&place.path("out").join("notes.txt")), b"mine");
    // An adapter that is not there costs no results.
    let before = bytes(&place.path("out").join(files::ENERGIES));
    fails(&["run", &scene, "--out", &out, "--force", "--adapter", "abacus"], 3, &["abacus"]);
    assert_eq!(bytes(&place.path("out").join(files::ENERGIES)), before);
}

#[test]
fn an_explosion_is_reported_with_its_step() {
    let place = place().with("/interactions/0/repulsion", json!(690)).with("/output/checkpoint", json!({"every": 10}));
    let (scene, out) = (place.scene(), place.argument("out"));
    let message = fails(
        &["run", &scene, "--out", &out],
        4,
        &[
            "became unstable at step ",
            "try a time step of 0.007 or less",
            "checkpoint, of step 0",
            "warning: time.step",
        ],
    );
    assert!(message.contains(place.path("out").join(files::CHECKPOINT).to_str().unwrap()), "{message}");
    let kept = state(&place.path("out"));
    assert_eq!((kept.step, kept.len()), (0, 375));
    // What was measured until then is a whole table.
    place.table("out", files::ENERGIES);
    assert!(!place.path("out").join(files::SUMMARY).exists());
    fails(&["plot", &out], 5, &["run.json", "no run has been finished there", "mesoscope resume"]);
    let found = |message: &str| message.lines().find(|line| line.contains("became unstable")).map(str::to_owned);
    assert_eq!(found(&fails(&["resume", &out], 4, &[])), found(&message));
}

/// A run that was killed between its first file and its first checkpoint.
#[test]
fn a_run_that_saved_nothing_cannot_be_resumed() {
    let place = Place::of(json!({}));
    let out = place.argument("out");
    fs::create_dir(place.path("out")).unwrap();
    fails(&["resume", &out], 5, &["cannot read the checkpoint"]);
    fails(&["plot", &out], 5, &["there is no run in this directory"]);
    fs::write(place.path("out").join(files::ENERGIES), "step,time\n").unwrap();
    let told = ["ended before it saved its first checkpoint", "run the scene again with --force"];
    fails(&["resume", &out], 5, &told);
    fails(&["plot", &out], 5, &told);
    assert_eq!(listing(&place.path("out")), [files::ENERGIES]);
}

#[test]
fn crowding_at_the_ends_of_the_box_is_survived() {
    let positions: Vec<[f64; 2]> =
        (0..2400).map(|index| [f64::from(index % 40) * 0.02, f64::from(index / 40) + 0.5]).collect();
    let place = place()
        .with("/space/box", json!([10, 60]))
        .with("/time", json!({"step": 0.0005, "steps": 12}))
        .with("/particles", json!([{"species": "fluid", "placement": {"type": "listed", "positions": positions}}]))
        .with("/integrator", json!({"type": "groot-warren"}));
    let (scene, out) = (place.scene(), place.argument("out"));
    let output = mesoscope(&["run", &scene, "--out", &out]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert!(
        text(&output.stderr).contains("too many particles crowd in one part of the box; continuing"),
        "{}",
        text(&output.stderr)
    );
    let energies = place.table("out", files::ENERGIES);
    assert_eq!(energies.column("step").unwrap(), [0.0, 3.0, 6.0, 9.0, 12.0]);
}

#[test]
fn an_unknown_adapter_is_answered_with_those_there_are() {
    let place = place();
    let known = succeeds(&["adapters"]);
    let (scene, out) = (place.scene(), place.argument("out"));
    for arguments in [&["run", &scene, "--out", &out][..], &["check", &scene]] {
        let message = fails(&[arguments, &["--adapter", "abacus"]].concat(), 3, &["abacus", "0: "]);
        let first = message.split("0: ").nth(1).unwrap().split([',', '\n', ';']).next().unwrap();
        assert!(known.contains(first.trim()), "`{first}` is not in: {known}");
    }
    assert!(!place.path("out").exists());
}

#[test]
fn files_that_cannot_be_written_or_read() {
    let place = place();
    let scene = place.scene();
    let below_a_file = place.argument("scene.json/out");
    fails(&["run", &scene, "--out", &below_a_file], 5, &["cannot create the directory", "scene.json"]);
    fails(&["run", &scene, "--out", &scene], 5, &["scene.json` is a file, and the results need a directory", "--out"]);
    for command in ["resume", "plot"] {
        let told = ["nowhere` is no directory", "hint: give the directory that `mesoscope run` or a study wrote"];
        fails(&[command, &place.argument("nowhere")], 5, &told);
        fails(&[command, &scene], 5, &["scene.json` is a file, not the directory of a run"]);
    }
    place.run("out", &["--quiet"]);
    fails(&["plot", &place.argument("nowhere")], 5, &["hint: results are in `", "/out`"]);
    fails(&["run", &place.argument("out")], 2, &["out` is the directory of a run: `mesoscope resume "]);
    fails(
        &["resume", &place.argument("out"), "--set", "seed=3"],
        2,
        &["time.steps: found", "more steps: `--steps N` says how many"],
    );
    let path = place.path("out").join(files::CHECKPOINT);
    let whole = bytes(&path);
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 1;
    fs::write(&path, &damaged).unwrap();
    fails(&["resume", &place.argument("out"), "--steps", "90"], 5, &["damaged", "hint: it cannot be repaired"]);
    fs::write(&path, &whole[..whole.len() / 2]).unwrap();
    fails(&["resume", &place.argument("out"), "--steps", "90"], 5, &["cut short"]);
    fs::write(&path, "{}").unwrap();
    fails(&["resume", &place.argument("out"), "--steps", "90"], 5, &["not a checkpoint"]);
    fs::write(&path, &whole).unwrap();
    // A table that lost a row, or its end, is left as it is.
    let energies = place.path("out").join(files::ENERGIES);
    let table = fs::read_to_string(&energies).unwrap();
    let lines: Vec<&str> = table.split_inclusive('\n').collect();
    let without = [&lines[..2], &lines[3..]].concat().concat();
    for (left, missing) in [(without.as_str(), lines[2]), (&table[..lines[..3].concat().len() - 2], lines[2])] {
        fs::write(&energies, left).unwrap();
        let step = missing.split(',').next().unwrap();
        let told = format!("the row of step {step} is missing");
        fails(&["resume", &place.argument("out"), "--steps", "90"], 5, &["energies.csv", &told, "--force"]);
        assert_eq!(fs::read_to_string(&energies).unwrap(), left);
    }
    fs::remove_file(&energies).unwrap();
    fails(&["resume", &place.argument("out"), "--steps", "90"], 5, &["energies.csv"]);
    // Nor is there a plot of what the run did not measure.
    fs::write(&energies, "a,b\n1,2\n").unwrap();
    fails(&["plot", &place.argument("out")], 5, &["energies.csv` is not what the run wrote", "--force"]);
    let told = ["energies.csv` is not what the run wrote: it has the columns `a,b`", "the run writes `step,time,"];
    fails(&["resume", &place.argument("out"), "--steps", "90"], 5, &told);
}

#[test]
fn wrong_scenes_run_nothing() {
    let place = place();
    let (scene, out) = (place.scene(), place.argument("out"));
    fails(&["run", &scene, "--out", &out, "--set", "time.step=0"], 2, &["time.step", "0"]);
    fails(&["run", &scene, "--out", &out, "--set", "fricton=1"], 2, &["fricton"]);
    fails(&["run", "no-such-scene", "--out", &out], 2, &["no-such-scene", "dpd-fluid"]);
    // Numbers that single precision cannot hold.
    for (path, value) in [
        ("time.step", "1e300"),
        ("time.step", "1e-300"),
        ("temperature", "1e300"),
        ("particles[0].mass", "1e300"),
        ("particles[0].mass", "1e-300"),
        ("interactions[0].repulsion", "1e300"),
        ("interactions[0].friction", "1e300"),
    ] {
        let set = format!("{}={value}", path.replace('[', ".").replace(']', ""));
        let told = format!("{path}: found {value}; accepted: a number nearer to the others");
        fails(&["run", &scene, "--out", &out, "--set", &set], 2, &[&told, "choose other units"]);
        fails(&["check", &scene, "--set", &set], 2, &[&told]);
    }
    assert!(!place.path("out").exists());
}

#[test]
fn check_says_whether_the_adapter_that_is_asked_for_has_room() {
    let place = place().with("/space/box", json!([400, 400, 400]));
    let parts =
        ["but this scene needs ", " particles fit, or all of them on ", "ranks that have an adapter each (`--ranks "];
    fails(&["check", &place.scene(), "--adapter", "0"], 3, &parts);
}

/// Its steps are those of the run.
#[test]
fn check_fails_where_its_own_trial_does() {
    let place = place().with("/time", json!({"step": 0.04, "steps": 60}));
    let scene = place.scene();
    let hot = [scene.as_str(), "--set", "temperature=300"];
    let said = fails(&[&["check"], &hot[..]].concat(), 4, &["became unstable at step 0", "try a time step of "]);
    let ran = fails(&[&["run", "--out", &place.argument("out")], &hot[..]].concat(), 4, &[]);
    let reason = said.lines().find(|line| line.contains("became unstable")).unwrap();
    assert!(ran.contains(reason), "{said} {ran}");
}

#[test]
fn check_predicts_how_far_a_scene_may_go_and_what_it_pays_for() {
    let said = succeeds(&["check", "-v", "dpd-fluid"]);
    for part in [
        "advisable up to 0.0407 (1 % of the temperature, by repulsion); stable by theory up to 0.129 (oscillation ω dt = 2)",
        "temperature +0.1 % (-0.9 % by friction in one stage, +1.0 % by repulsion), configurational temperature -0.7 %",
        "viscosity up to -0.5 % (friction of a flow -3.1 %), diffusion within 2 %",
        "as measured with a step of 0.04 (DPD fluid, 20",
        "`mesoscope stability dpd-fluid` runs it with longer and longer steps",
    ] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    assert!(!said.contains("pays for"), "{said}");
    let said = succeeds(&["check", "-v", "dpd-fluid", "--set", "time.step=0.03"]);
    assert!(
        said.contains("off, interpolated between steps of 0.02 and 0.04 that were measured (DPD fluid, 20"),
        "{said}"
    );
    // It becomes unstable, which is said when everything else has been, if the steps that were timed came so far.
    let output = mesoscope(&["check", "edpd-fluid", "--set", "time.step=0.1"]);
    let said = text(&output.stdout);
    assert!(
        said.contains("not measured at this step; ") && said.contains("off at a step of 0.06, the nearest"),
        "{said}"
    );
    // B + W = dt²(1 + 1000 tanh(500 dt)/(500 dt)), which is 4 at dt = 1.236.
    let forgotten = ["interactions.1.bath.rate=1000", "output.energies.every=1"];
    let said = succeeds(&["check", "-v", "gle-oscillator", "--set", forgotten[0], "--set", forgotten[1]]);
    for part in [
        "by theory up to 1.24 (B + W = 4)",
        "reports: about 50 % of the time",
        "the memory of interactions[1]: at a rate of 1000 a step leaves nothing of it",
    ] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    // What theory knows: B/(4 - B - W) with B = .2 and W = .01. What was not measured is said, with the command that measures this scene as it was changed.
    assert!(
        said.contains("bath times displacement 0.05277") && said.contains("known exactly for this scheme"),
        "{said}"
    );
    let said = succeeds(&["check", "-v", "coloured-noise", "--set", "output.energies.every=1"]);
    let command = "`mesoscope tradeoff coloured-noise --set output.energies.every=1 --vary time.step=";
    assert!(said.contains("not measured of a scene like this") && said.contains(command), "{said}");
    let quoted = "--set 'output.energies={\"every\":20}'";
    let said = succeeds(&["check", "-v", "gle-oscillator", "--set", "output.energies={\"every\":20}"]);
    assert!(said.contains(quoted), "{said}");
    // Choices that cost time and change nothing, where they do not.
    let staged = r#"integrator={"type":"splitting","relaxation":"two-stages"}"#;
    let one_stage = "friction in two stages, 1.5 times the time of a step: a step relaxes ";
    let (strong, gaussian) = ("interactions.0.friction=45", "noise.distribution=gaussian");
    let idle = r#"particles=[{"species":"fluid","number_density":3},{"species":"idle","count":0}]"#;
    let chebyshev = r#"interactions.0.smoothing.solver={"type":"chebyshev","tolerance":1e-6}"#;
    for (scene, set, what) in [
        ("dpd-fluid", &[staged][..], Some(one_stage)),
        ("dpd-fluid", &[staged, strong], None),
        ("dpd-fluid", &[gaussian], Some("Gaussian noise, 7 to 17 % of a step")),
        ("edpd-fluid", &[gaussian], None),
        ("dpd-fluid", &[idle], Some("species without particles: idle")),
        ("shallow-water", &[chebyshev], Some("the smoothing solver `chebyshev`: on 64 × 64 nodes `fft`")),
        ("shallow-water", &[chebyshev, "interactions.0.mesh=[60,64]"], None),
    ] {
        let changes = set.iter().flat_map(|change| ["--set", change]);
        let said = succeeds(&["check", "-v", scene].into_iter().chain(changes).collect::<Vec<_>>());
        match what {
            Some(what) => assert!(
                said.lines().any(|line| line
                    .trim_start()
                    .strip_prefix("pays for")
                    .is_some_and(|rest| rest.trim_start().starts_with(what))),
                "{scene} {set:?}: {said}"
            ),
            None => assert!(!said.contains("pays for"), "{scene} {set:?}: {said}"),
        }
    }
}

#[test]
fn check_prints_the_plan() {
    let place = place().with("/output/radial_distribution", json!({"every": 5, "range": 2}));
    let short = succeeds(&["check", &place.scene()]);
    // Lines for a beginner: time, what is written, and how far off it is, as measured and by theory.
    let starts: Vec<&str> = short.lines().map(|line| line.split_whitespace().next().unwrap_or_default()).collect();
    assert_eq!(starts, ["small", "time", "files", "memory", "accuracy", "expected", "-v"], "{short}");
    for part in ["steps of 375 particles", "for pictures, within a factor of", " in the memory of an adapter"] {
        assert!(short.contains(part), "`{part}` is not in: {short}");
    }
    let long = succeeds(&["check", "-v", &place.scene()]);
    assert!(long.contains("bytes a particle") && !long.contains("scatter_particles"), "{long}");
    let said = succeeds(&["check", &place.scene(), "--kernels"]);
    // Few cells are sorted in one workgroup where dispatches cost more than turns.
    let (kernel, entry) = if said.contains("scatter_particles") {
        ("scatter", "scatter_particles")
    } else {
        ("sort", "sort_in_one_workgroup")
    };
    for part in [
        "small fluid",
        "375 in 3 dimensions, box 5 × 5 × 5",
        entry,
        "CELLS_X = 5",
        "bytes a particle",
        "operations a particle",
        "radial_distribution: every 5 steps from step 12",
        "pair_histogram",
        "a row every 3 steps",
    ] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    let shader = succeeds(&["check", &place.scene(), "--shader", kernel]);
    assert!(shader.contains("// shaders/grid/bin.wgsl:") && shader.contains(&format!("fn {entry}(")), "{shader}");
    fails(&["check", &place.scene(), "--shader", "scater"], 2, &["no kernel `scater`; it has ", kernel]);
    // What the scene leaves out is not there, and what deserves a second look is named.
    let said = succeeds(&[
        "check",
        "--kernels",
        &place.scene(),
        "--set",
        "interactions.0.repulsion=0",
        "--set",
        "space.box=[5,5,2]",
        "--set",
        "output.radial_distribution=null",
    ]);
    assert!(said.contains("REPULSIVE = 0") && !said.contains("pair_histogram"), "{said}");
    assert!(said.contains("warning: space.box[2]"), "{said}");
}

#[test]
fn plots_can_be_drawn_again() {
    let place = place().with("/output/radial_distribution", json!({"every": 5, "range": 2}));
    place.run("out", &["--quiet"]);
    place.draws_again(&[files::ENERGIES_PLOT, AnalysisId::RadialDistribution.tables()[0].plot, files::SNAPSHOT]);
    let out = place.argument("out");
    succeeds(&["plot", &out, "--set", "output.plot.width=800", "--set", "output.snapshot.height=100"]);
    assert_eq!(size(&place.path("out").join(files::ENERGIES_PLOT)), (800, 480));
    assert_eq!(size(&place.path("out").join(files::SNAPSHOT)), (200, 100));
    fails(&["plot", &out, "--set", "seed=3"], 2, &["seed=3", "output.plot."]);
    fails(&["plot", &out, "--set", "output.plot.widht=3"], 2, &["out/run.json` has 1 mistake", "widht", "width"]);
    fs::write(place.path("out").join(AnalysisId::RadialDistribution.table()), "a,b\n1,2\n").unwrap();
    fails(&["plot", &out], 5, &["radial_distribution.csv` is not what the run wrote", "--force"]);
}

/// Numbers are the same without pictures, also where the run was interrupted, and `plot` draws those of the end.
#[test]
fn a_run_without_pictures_can_be_drawn_later() {
    let place = place()
        .with("/output/snapshot/every", json!(25))
        .with("/output/radial_distribution", json!({"every": 5, "range": 2, "bins": 40}));
    place.run("drawn", &[]);
    let said = place.run("out", &["--no-pictures", "--steps", "36"]);
    assert!(!said.contains(".png") && !said.contains("numbered"), "{said}");
    let (drawn, out) = (place.path("drawn"), place.path("out"));
    succeeds(&["resume", &place.argument("out"), "--steps", "60", "--no-pictures"]);
    assert!(listing(&out).iter().all(|name| !name.contains(".png")), "{:?}", listing(&out));
    let said = succeeds(&["resume", &place.argument("out")]);
    assert!(said.contains("nothing to do"), "{said}");
    let rdf = &AnalysisId::RadialDistribution.tables()[0];
    for name in [files::ENERGIES, rdf.file] {
        assert_eq!(bytes(&out.join(name)), bytes(&drawn.join(name)), "{name}");
    }
    succeeds(&["plot", &place.argument("out")]);
    for name in [files::ENERGIES_PLOT, files::SNAPSHOT, rdf.plot] {
        assert_eq!(picture(&out.join(name)), picture(&drawn.join(name)), "{name}");
    }
    // Pictures of an earlier end are not those of a later one, and only snapshots that are there count.
    place.run("part", &["--steps", "36"]);
    let resumed = |further: &[&str]| succeeds(&[&["resume", &place.argument("part")], further].concat());
    let said = resumed(&["--steps", "54", "--no-pictures"]);
    assert!(said.contains("2 numbered snapshots") && !said.contains(".png"), "{said}");
    let pictures = |name: &String| name.contains(".png");
    let left: Vec<String> = listing(&place.path("part")).into_iter().filter(pictures).collect();
    assert_eq!(left, ["snapshot-000001.png", "snapshot-000002.png"]);
    let said = resumed(&["--steps", "90"]);
    assert!(said.contains("3 numbered snapshots") && said.contains("energies.png"), "{said}");
    let numbered = place.summary("part").numbered;
    let frames: Vec<_> = numbered.iter().map(|frame| (frame.number, frame.step, frame.time)).collect();
    assert_eq!(frames, [(1, 0, 0.0), (2, 25, 0.75), (4, 75, 2.25)]);
    assert!(place.summary("out").numbered.is_empty());
}

/// Every line on standard error is an event, from the start to the end, also of a run that goes on.
#[test]
fn progress_can_be_read_by_programs() {
    let place = place().with("/time/steps", json!(40));
    let (scene, out) = (place.scene(), place.argument("out"));
    let events = |arguments: &[&str]| -> Vec<Value> {
        let (_, said) = succeeds_and_tells(&[arguments, &["--progress", "json"]].concat());
        said.lines().map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("no event: {line}"))).collect()
    };
    let coarse = ["run", &scene, "--out", &out, "--steps", "36", "--set", "time.step=0.09"];
    for (arguments, first, last) in [(&coarse[..], 0, 36), (&["resume", &out, "--steps", "60"][..], 36, 60)] {
        let events = events(arguments);
        let named = |name: &str| events.iter().filter(|event| event["event"] == name).collect::<Vec<_>>();
        assert_eq!(named("started")[0]["first_step"], first);
        let warned = named("warned");
        assert!(warned.iter().any(|event| event["warning"].as_str().unwrap().starts_with("time.step: ")), "{warned:?}");
        let advanced = named("advanced");
        assert_eq!((&advanced.last().unwrap()["step"], &advanced[0]["last_step"]), (&json!(last), &json!(last)));
        assert!(advanced.last().unwrap()["temperature"].as_f64().unwrap() > 0.1, "{advanced:?}");
        let end = &events[events.len() - 2..];
        assert_eq!((&end[0], &end[1]["event"]), (&json!({"event": "finishing"}), &json!("finished")));
        assert!(end[1]["files"].as_array().unwrap().contains(&json!("run.json")), "{end:?}");
    }
    fails(&["run", &scene, "--out", &out, "--progress", "json", "--quiet"], 2, &["--quiet"]);
    fails(&["run", &scene, "--out", &out, "--progress", "xml"], 2, &["json"]);
}

#[test]
fn two_species_in_a_plane() {
    let place = place()
        .with("/space/box", json!([9, 7]))
        .with("/particles", json!([{"species": "A", "count": 120}, {"species": "B", "count": 80, "mass": 2}]))
        .with("/interactions/0/repulsion", json!(0));
    let said = place.run("out", &[]);
    assert!(said.contains("200 particles in 2 dimensions") && !said.contains("configurational"), "{said}");
    let energies = place.table("out", files::ENERGIES);
    let columns = "step,time,kinetic_energy,total_energy,temperature,pressure,momentum_x,momentum_y,\
                   center_of_mass_velocity_x,center_of_mass_velocity_y";
    assert_eq!(energies.columns.join(","), columns);
    let drawn = picture(&place.path("out").join(files::SNAPSHOT));
    let coloured =
        |strong: usize, weak: usize| drawn.pixels().filter(|p| p[strong] > p[weak].saturating_add(60)).count();
    assert!(coloured(2, 0) > 100 && coloured(0, 2) > 100, "both species show");
}

#[test]
fn scenes_of_no_and_of_one_particle() {
    for (count, empty) in [(0, ["temperature", "center_of_mass_velocity_x"]), (1, ["temperature", "pressure"])] {
        let place = place()
            .with("/particles", json!([{"species": "A", "count": count}]))
            .with("/output/radial_distribution", json!({"every": 5, "range": 2}))
            .with("/output/diffusion", json!({"every": 2, "window": 6}))
            .with("/output/viscosity", json!({"every": 2, "window": 12}));
        place.run("out", &[]);
        let energies = place.table("out", files::ENERGIES);
        assert_eq!(energies.rows.len(), 21);
        assert!(energies.column("kinetic_energy").unwrap().iter().all(|energy| *energy == 0.0));
        for name in empty {
            assert!(energies.column(name).unwrap().iter().all(|value| value.is_nan()), "{name} of {count}");
        }
        let summary = place.summary("out");
        assert!(summary.means["temperature"].is_null());
        assert!(summary.warnings.iter().any(|warning| warning.contains("radial_distribution")));
        assert_eq!(size(&place.path("out").join(files::SNAPSHOT)), (200, 160));
    }
}

#[test]
fn a_run_of_no_steps() {
    let place = place();
    place.run("out", &["--quiet", "--set", "time.equilibration=0", "--steps", "0"]);
    let energies = place.table("out", files::ENERGIES);
    assert_eq!(energies.column("step").unwrap(), [0.0]);
    succeeds(&["resume", &place.argument("out"), "--steps", "6", "--quiet"]);
    let energies = place.table("out", files::ENERGIES);
    assert_eq!(energies.column("step").unwrap(), [0.0, 3.0, 6.0]);
}

#[test]
fn warnings_and_quiet() {
    let place = place().with("/space/box", json!([5, 5, 2]));
    let (scene, out) = (place.scene(), place.argument("out"));
    let output = mesoscope(&["run", &scene, "--out", &out]);
    assert!(text(&output.stderr).contains("warning: space.box[2]"), "{}", text(&output.stderr));
    let output = mesoscope(&["run", &scene, "--out", &out, "--force", "--quiet"]);
    assert_eq!((text(&output.stdout), text(&output.stderr)), ("", ""));
    let summary = place.summary("out");
    assert!(summary.warnings.iter().any(|warning| warning.starts_with("space.box[2]")));
}

/// Charts in vector formats are files of a run: listed, drawn again, gone where nobody asks for them any more, and named with the id of the run.
#[test]
fn charts_are_vector_graphics_too() {
    let output = json!({"plot": {"width": 640, "height": 480}, "snapshot": {"width": 100, "height": 80},
        "clusters": {"every": 5, "distance": 0.5}});
    let place = place().with("/output", output).with("/time/steps", json!(20));
    let vector = r#"output.plot.vector=["svg","pdf"]"#;
    let said = place.run("out", &["--quiet", "--set", vector]);
    assert!(said.is_empty(), "{said}");
    let (out, summary) = (place.path("out"), place.summary("out"));
    let drawn = |end: &str| -> Vec<String> { listing(&out).into_iter().filter(|name| name.ends_with(end)).collect() };
    for end in ["svg", "pdf"] {
        let names = ["cluster_sizes", "clusters", "energies"].map(|name| format!("{name}.{end}"));
        assert_eq!(drawn(end), names);
        assert!(names.iter().all(|name| summary.files.as_ref().unwrap().contains(name)), "{:?}", summary.files);
    }
    let svg = fs::read_to_string(out.join("energies.svg")).unwrap();
    assert!(svg.contains(&format!("run_id {}", summary.run_id)), "{}", &svg[..400]);
    let argument = place.argument("out");
    assert!(succeeds(&["plot", &argument, "--set", r#"output.plot.vector=["svg"]"#]).contains("energies.svg"));
    assert!(drawn("pdf").is_empty() && fs::read_to_string(out.join("energies.svg")).unwrap() == svg);
    succeeds(&["plot", &argument, "--set", "output.plot.vector=[]"]);
    assert!(drawn("svg").is_empty() && drawn("png").len() == 4);
    fails(
        &["plot", &argument, "--set", r#"output.plot.vector=["eps"]"#],
        2,
        &["found the text \"eps\"", "\"svg\", \"pdf\""],
    );
}
