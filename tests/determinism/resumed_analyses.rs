//! A run that was interrupted and resumed leaves the files of one that was not, whatever it measures and wherever it was
//! interrupted; what its checkpoint holds of analyses is checked.

use mesoscope::output::checkpoint::{self, Checkpoint};
use mesoscope::output::{Summary, files};
use mesoscope::plan::Division;
use mesoscope::run::{Event, Interrupt, Outcome, Run, RunError};
use mesoscope::scene::{self, Checked};
use std::collections::BTreeMap;
use std::path::Path;

use crate::support::{GROOT_WARREN, PREDICTED, SPLITTING, adapter, cells, fluid, water};

/// Steps of a run, the last of them in the middle of windows.
const STEPS: u64 = 42;

/// A scene with plots as small as can be, checkpoints and steps as above, and changes.
fn small(scene: &Checked, changes: &[&str]) -> Checked {
    let own = [
        &format!("time.steps={STEPS}") as &str,
        // A run that stops after every step can be interrupted after any.
        "output.checkpoint.every=1",
        r#"output.plot={"width":320,"height":240}"#,
    ]
    .map(str::to_owned);
    let changes: Vec<String> = own.into_iter().chain(changes.iter().map(|change| (*change).to_owned())).collect();
    scene::parse("test", &serde_json::to_string(scene).unwrap(), &changes).unwrap_or_else(|error| panic!("{error}"))
}

fn run(scene: &Checked, directory: &Path) -> Outcome {
    Run::replace(scene.clone(), directory).execute(&adapter(), &mut |_| {}).unwrap()
}

/// Runs a scene in slabs until it is interrupted at a step after the first.
fn run_until(scene: &Checked, directory: &Path, step: u64, slabs: u32) {
    let interrupt = Interrupt::default();
    let run = Run::replace(scene.clone(), directory).until(&interrupt).on_ranks(Some(of_slabs(slabs)));
    let stopped = run.execute(&adapter(), &mut |event| match event {
        // The interrupt is seen after one step more.
        Event::Advanced(progress) if progress.step + 1 >= step => interrupt.ask(),
        _ => {}
    });
    match stopped {
        Err(RunError::Interrupted { checkpoint_step, .. }) => assert_eq!(checkpoint_step, step),
        other => panic!("{other:?}"),
    }
}

fn resume(directory: &Path) -> Result<Outcome, RunError> {
    Run::resume(directory, None)?.execute(&adapter(), &mut |_| {})
}

/// Ranks one above the other along z.
fn of_slabs(slabs: u32) -> Division {
    Division { parts: [1, 1, slabs] }
}

/// Everything in the directory of a finished run; of its summary and checkpoint what does not tell of the clock.
fn contents(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in std::fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let content = match name.as_str() {
            files::SUMMARY => {
                let mut summary = Summary::load(&path).unwrap();
                (summary.wall_seconds, summary.particle_steps_per_second) = (0.0, 0.0);
                format!("{summary:#?}").into_bytes()
            }
            files::CHECKPOINT => {
                let Checkpoint { run_id, scene, state, files: written, sections } = checkpoint::load(&path).unwrap();
                format!("{run_id} {scene:?} {state:?} {written:?} {sections:?}").into_bytes()
            }
            _ => std::fs::read(&path).unwrap(),
        };
        found.insert(name, content);
    }
    found
}

/// That a scene leaves the same files if it is interrupted at each of these steps.
#[track_caller]
fn goes_on(scene: &Checked, steps: &[u64]) {
    let directory = tempfile::tempdir().unwrap();
    let whole = directory.path().join("whole");
    let summary = run(scene, &whole).summary;
    assert!(!summary.not_conserved.iter().any(|entry| entry.contains("on this driver")), "{:?}", summary.not_conserved);
    let whole = contents(&whole);
    for step in steps {
        let parts = directory.path().join(format!("until {step}"));
        run_until(scene, &parts, *step, 1);
        resume(&parts).unwrap();
        let parts = contents(&parts);
        assert!(parts.keys().eq(whole.keys()), "{step}: {:?}, not {:?}", parts.keys(), whole.keys());
        let differing: Vec<&String> = whole.keys().filter(|name| whole[*name] != parts[*name]).collect();
        assert!(differing.is_empty(), "after an interruption at step {step}: {differing:?}");
    }
}

/// Every analysis of particles, from step 9 on: windows of six samples have edges at 15, 21, 27, 33 and 39.
const EVERYTHING: &[&str] = &[
    "time.equilibration=9",
    "output.energies.every=2",
    r#"output.diffusion={"every":1,"window":6}"#,
    r#"output.viscosity={"every":1,"window":20}"#,
    r#"output.radial_distribution={"every":4,"range":1,"bins":10}"#,
    r#"output.structure_factor={"every":5,"range":8,"bins":8}"#,
    r#"output.clusters={"every":7,"distance":0.4}"#,
    r#"output.autocorrelations=[{"quantity":"velocity","every":1,"window":6,"fit":"exponential"},
        {"quantity":"force","every":2,"window":5}]"#,
    r#"output.histograms=[{"quantity":"velocity","every":1},{"quantity":"speed","every":5,"bins":5},
        {"quantity":"acceleration","every":2}]"#,
    r#"output.profiles={"axis":"y","bins":3,"every":2}"#,
    r#"output.stress={"every":3,"normal":"z"}"#,
    r#"output.trajectory={"every":6,"format":"extended-xyz"}"#,
];

/// Interrupted in each of three stages, where each begins, and in ramps.
#[test]
fn stages_go_on_at_any_step() {
    let stages = r#"stages=[{"steps":4},
        {"steps":4,"set":{"interactions.0.repulsion":40},"ramp":{"temperature":[1,0.5]},"ramp_every":2},
        {"steps":34,"set":{"time.step":0.01},"ramp":{"interactions.0.friction":[3,9]},"ramp_every":10}]"#;
    let scene = small(&fluid(&["space.box=[3,3,3]", "time.step=0.02", "output={}"]), &[EVERYTHING, &[stages]].concat());
    goes_on(&scene, &[1, 3, 4, 5, 6, 7, 8, 9, 17, 18, 22, 41]);
    // Particles are followed in the last stage only.
    let diffusion = r#"output.diffusion={"every":1,"window":6}"#;
    let scene =
        small(&fluid(&["space.box=[3,3,3]", "output={}"]), &[diffusion, r#"stages=[{"steps":20},{"steps":22}]"#]);
    goes_on(&scene, &[10, 20, 21, 30]);
}

#[test]
fn particles_go_on_at_any_step() {
    let scene = small(&fluid(&["space.box=[3,3,3]", "time.step=0.02"]), EVERYTHING);
    // During equilibration, at the first sample, in the middle of a window, and on its edge.
    goes_on(&scene, &[6, 9, 18, 21]);
}

/// Of several ranks the first measures by number what all have, and its windows go on with others.
#[test]
fn ranks_go_on_with_windows_of_each_other() {
    let changes = [&EVERYTHING[..5], &EVERYTHING[EVERYTHING.len() - 1..]].concat();
    for (number, integrator) in [SPLITTING, GROOT_WARREN, PREDICTED].into_iter().enumerate() {
        let scene = small(&fluid(&["space.box=[3,3,10]", "time.step=0.02", integrator]), &changes);
        let directory = tempfile::tempdir().unwrap();
        let whole = directory.path().join("whole");
        run(&scene, &whole);
        let [first, second] = [[1, 3], [3, 2], [2, 1]][number];
        let parts = directory.path().join("parts");
        run_until(&scene, &parts, 18, first);
        let resumed = Run::resume(&parts, None).unwrap().on_ranks(Some(of_slabs(second)));
        resumed.execute(&adapter(), &mut |_| {}).unwrap();
        let [whole, parts] = [contents(&whole), contents(&parts)];
        // The summary says how many ranks there were.
        let differing: Vec<&String> =
            whole.keys().filter(|name| *name != files::SUMMARY && whole.get(*name) != parts.get(*name)).collect();
        assert!(differing.is_empty(), "{first} ranks, then {second}: {differing:?}");
        assert!(whole.contains_key("diffusion.csv") && whole.contains_key("viscosity.csv"), "{:?}", whole.keys());
    }
}

#[test]
#[ignore = "a minute; run by `make validate`"]
fn particles_go_on_at_every_step() {
    let steps: Vec<u64> = (2..STEPS).collect();
    for integrator in crate::support::INTEGRATORS {
        goes_on(&small(&fluid(&["space.box=[3,3,3]", "time.step=0.01", integrator]), EVERYTHING), &steps);
    }
}

#[test]
fn couplings_with_memory_go_on() {
    let chains = r#"[{"species":"A","count":24,"chain":{"beads":4,"spacing":0.9}},
        {"species":"B","count":10,"chain":{"beads":5,"spacing":0.9}}]"#;
    let bonds = r#"[{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":10}},
        {"type":"bonds","potential":{"type":"harmonic","stiffness":4}}]"#;
    let mut text: serde_json::Value = serde_json::to_value(fluid(&["space.box=[4,4,4]", "time.step=0.01"])).unwrap();
    text["particles"] = serde_json::from_str(chains).unwrap();
    text["interactions"] = serde_json::from_str(bonds).unwrap();
    text["integrator"] = serde_json::json!({"type": "cotter-reich"});
    let scene = scene::parse("test", &text.to_string(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let of_species = [
        "output.radial_distribution.species=all-pairs",
        "output.structure_factor.species=all-pairs",
        "output.diffusion.species=B",
    ];
    let changes = [&[r#"output.chain_sizes={"every":3}"#][..], EVERYTHING, &of_species].concat();
    goes_on(&small(&scene, &changes), &[12]);
}

#[test]
fn voronoi_cells_go_on() {
    let sampled = [
        "time.equilibration=9",
        "output.energies.every=2",
        r#"output.diffusion={"every":1,"window":6}"#,
        r#"output.viscosity={"every":2,"window":10}"#,
        r#"output.histograms=[{"quantity":"velocity","every":4}]"#,
        r#"output.neighbours={"every":6}"#,
    ];
    goes_on(&small(&cells(100, &["time.step=0.01", "interactions.0.energy={}"]), &sampled), &[18]);
    let wave = r#"particles.0.velocities={"type":"shear-wave","amplitude":0.3,"periods":1}"#;
    let scene = small(&cells(100, &[wave]), &[r#"output.shear_wave={"every":3}"#, "output.energies.every=4"]);
    goes_on(&scene, &[21]);
}

#[test]
fn shallow_water_goes_on() {
    let mut text: serde_json::Value = serde_json::to_value(water(&["time.step=0.01"])).unwrap();
    let circle = serde_json::json!({"species": "loop", "count": 200, "tracer": true,
        "placement": {"type": "circle", "center": [3, 3], "radius": 0.8}, "velocities": {"type": "geostrophic"}});
    text["particles"].as_array_mut().unwrap().push(circle);
    let scene = scene::parse("test", &text.to_string(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let fields = r#"output.fields={"every":20,"quantities":["depth"]}"#;
    goes_on(&small(&scene, &["output.energies.every=2", fields]), &[27]);
    // Several fields in one file, and states of the mesh.
    let fields = r#"output.fields={"every":10,"format":"netcdf","quantities":["depth","velocity-x"]}"#;
    goes_on(&small(&scene, &["output.energies.every=2", fields, "output.spectra.every=3"]), &[17]);
}

#[test]
fn harmonic_chains_go_on() {
    let changes = [
        "space.box=[1024]",
        "interactions.0.cluster_size=4",
        "interactions.0.pulse.clusters=40",
        "interactions.0.equilibrium.clusters=64",
        "output.energies.every=4",
        "output.chain.every=3",
    ];
    goes_on(&small(&scene::load("harmonic-chain", &[]).unwrap(), &changes), &[15]);
}

/// What a checkpoint with a right checksum may hold of analyses is refused unless it is as long as its step makes it.
#[test]
fn sections_of_another_length_are_refused() {
    let scene = small(&fluid(&["space.box=[3,3,3]", "time.step=0.02"]), EVERYTHING);
    let directory = tempfile::tempdir().unwrap();
    run_until(&scene, directory.path(), 18, 1);
    let path = directory.path().join(files::CHECKPOINT);
    let saved = std::fs::read(&path).unwrap();
    let Checkpoint { run_id, scene, state, files: written, sections } = checkpoint::load(&path).unwrap();
    let names: Vec<&str> = sections.iter().map(|(name, _)| name.as_str()).collect();
    for name in ["diffusion_window", "velocity_autocorrelation_window", "viscosity", "kept_sums", "configuration"] {
        assert!(names.contains(&name), "{names:?}");
    }
    let energies = std::fs::read(directory.path().join(files::ENERGIES)).unwrap();
    for index in 0..sections.len() {
        // Two of the four kinds each, so that every kind is tried of a few sections.
        for damage in [index % 4, (index + 1) % 4] {
            let mut damaged = sections.clone();
            let bytes = &mut damaged[index].1;
            match damage {
                0 => bytes.truncate(bytes.len().saturating_sub(4)),
                1 => bytes.extend([0; 8]),
                2 => bytes.clear(),
                _ => drop(damaged.remove(index)),
            }
            if damaged == sections {
                continue;
            }
            checkpoint::save(&path, run_id, &scene, &state, &written, &damaged).unwrap();
            let error = resume(directory.path()).unwrap_err();
            let told = error.to_string();
            assert!(matches!(error, RunError::Checkpoint(_)), "{told}");
            assert!(told.contains("is no valid checkpoint: its section `"), "{}: {told}", sections[index].0);
            assert!(energies == std::fs::read(directory.path().join(files::ENERGIES)).unwrap());
        }
    }
    std::fs::write(&path, saved).unwrap();
    resume(directory.path()).unwrap();
}

/// A state that has lost what is to be kept is found out by the next report.
#[test]
fn a_changed_momentum_is_told() {
    let scene = small(&fluid(&["space.box=[3,3,3]", "time.step=0.02", "output.energies.every=5"]), &[]);
    let directory = tempfile::tempdir().unwrap();
    run_until(&scene, directory.path(), 18, 1);
    let path = directory.path().join(files::CHECKPOINT);
    let Checkpoint { run_id, scene, mut state, files: written, sections } = checkpoint::load(&path).unwrap();
    state.momenta[7][1] += 2;
    checkpoint::save(&path, run_id, &scene, &state, &written, &sections).unwrap();
    let summary = resume(directory.path()).unwrap().summary;
    let told = "the total momentum along y should be constant to the last bit, but at step 20 it had changed by";
    let warned = summary.warnings.iter().filter(|warning| warning.starts_with(told) && warning.contains("(2 units)"));
    assert_eq!(warned.count(), 1, "{:?}", summary.warnings);
    assert_eq!(summary.conserved_exactly, ["mass"]);
    let lost =
        summary.not_conserved.iter().filter(|entry| entry.starts_with("total momentum: on this driver changed by"));
    assert_eq!(lost.count(), 1, "{:?}", summary.not_conserved);
}
