//! Stages of a run: the bytes of a simulation whose numbers change between its steps, of any number of ranks, and one axis of steps and
//! times.

use mesoscope::Simulation;
use mesoscope::families;
use mesoscope::output::{Summary, checkpoint, files, read_table};
use mesoscope::plan::Division;
use mesoscope::run::{self, Event, Interrupt, Ranks, Run, RunError};
use mesoscope::scene::Checked;
use mesoscope::state::State;
use std::path::Path;

use crate::support::{COTTER_REICH, GROOT_WARREN, PREDICTED, SPLITTING, adapter, fluid, water};

/// Runs a scene into a directory, and returns the state at its end.
fn end_of(scene: &Checked, directory: &Path, slabs: u32) -> State {
    let division = Division { parts: [1, 1, slabs] };
    let run = Run::replace(scene.clone(), directory).on_ranks((slabs > 1).then_some(division));
    run.execute(&adapter(), &mut |_| {}).unwrap();
    checkpoint::load(&directory.join(files::CHECKPOINT)).unwrap().state
}

#[test]
fn a_staged_run_has_the_bytes_of_a_simulation_whose_numbers_change() {
    let memory = r#"interactions.0.bath={"type":"memory","rate":3}"#;
    let shear = r#"space.shear={"rate":0.7,"gradient":"y"}"#;
    let ions = r#"particles=[{"species":"P","count":80,"charge":1.5},{"species":"M","count":120,"charge":-1}]"#;
    let charges = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
        {"type":"electrostatics","bjerrum_length":1.1}]"#;
    for (changes, key, value) in [
        (&[SPLITTING][..], "interactions.0.friction", 9.0),
        (&[GROOT_WARREN], "temperature", 2.0),
        (&[PREDICTED], "interactions.0.repulsion", 60.0),
        (&[COTTER_REICH, memory], "temperature", 0.5),
        (&[SPLITTING, shear], "space.shear.rate", -1.3),
        (&[SPLITTING, ions, charges], "interactions.1.bjerrum_length", 3.0),
        (&[COTTER_REICH, ions, charges], "temperature", 1.5),
    ] {
        let space = ["space.box=[4,4,5]", r#"output={"energies":{"every":4}}"#];
        let plain = fluid(&[&space[..], changes].concat());
        let stages = format!(r#"stages=[{{"steps":13}},{{"steps":17,"set":{{"{key}":{value}}}}}]"#);
        let staged = fluid(&[&space[..], changes, &["time.steps=30", &stages]].concat());
        let place = tempfile::tempdir().unwrap();
        let ended = end_of(&staged, place.path(), 1);

        let first = serde_json::to_value(&*plain).unwrap();
        let first = first.pointer(&format!("/{}", key.replace('.', "/"))).unwrap().as_f64().unwrap();
        let largest = if first.abs() > f64::abs(value) { first } else { value };
        let announced = format!(r#"announced=[{{"key":"{key}","largest":{largest}}}]"#);
        let announced = fluid(&[&space[..], changes, &[&announced]].concat());
        let mut simulation = Simulation::new(&announced, &adapter()).unwrap();
        simulation.advance(13).unwrap();
        simulation.set(key, value).unwrap();
        simulation.advance(17).unwrap();
        let expected = simulation.state().unwrap();
        assert_eq!((ended.step, expected.step), (30, 30));
        assert!(ended.positions == expected.positions && ended.momenta == expected.momenta, "{changes:?}: {key}");

        let mut unchanged = Simulation::new(&announced, &adapter()).unwrap();
        unchanged.advance(30).unwrap();
        assert!(unchanged.state().unwrap().positions != ended.positions, "{changes:?}: {key}");
    }
}

/// Chains whose bonds start longer than they can be begin where bonds have a largest force: at its end none is too long, and the momentum is what it
/// was, on one rank and on several.
#[test]
fn bonds_that_are_too_long_begin_with_a_largest_force() {
    let chains =
        r#"particles=[{"species":"P","count":60,"chain":{"beads":6,"spacing":0.9}},{"species":"W","count":300}]"#;
    let fene = r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},
        {"type":"bonds","potential":{"type":"fene","stiffness":30,"extent":0.8}}]"#;
    let base = ["space.box=[4,4,12]", SPLITTING, "time.step=0.01", chains, fene, r#"output={"energies":{"every":20}}"#];
    let soft = r#"stages=[{"steps":300,"push_off":40},{"steps":100}]"#;
    let staged = fluid(&[&base[..], &["time.steps=400", soft]].concat());
    let started = families::initial_state(&staged);
    let longest = |scene: &Checked, state: &State| {
        let lengths = scene.model().particles().bonds.as_ref().unwrap().iter().map(|bond| {
            let [a, b] = bond.ends.map(|end| state.positions[end as usize]);
            scene.model().units.displacement(a, b).iter().map(|part| part * part).sum::<f64>().sqrt()
        });
        lengths.fold(0.0, f64::max)
    };
    assert!(longest(&staged, &started) > 0.85);
    let places = [tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap()];
    let ended = end_of(&staged, places[0].path(), 1);
    assert!(longest(&staged, &ended) < 0.8, "{}", longest(&staged, &ended));
    assert_eq!(ended.total_momentum(), started.total_momentum());
    let divided = end_of(&staged, places[1].path(), 3);
    assert!(divided.positions == ended.positions && divided.momenta == ended.momenta);
}

/// A ramp is what a program does that changes a number again and again.
#[test]
fn a_ramp_has_the_bytes_of_a_simulation_whose_number_changes_again_and_again() {
    let space = ["space.box=[4,4,4]", SPLITTING, r#"output={"energies":{"every":4}}"#];
    let stages =
        r#"stages=[{"steps":7},{"steps":20,"ramp":{"interactions.0.repulsion":[25,50]},"ramp_every":5},{"steps":9}]"#;
    let staged = fluid(&[&space[..], &["time.steps=36", stages]].concat());
    let place = tempfile::tempdir().unwrap();
    let ended = end_of(&staged, place.path(), 1);
    let announced = r#"announced=[{"key":"interactions.0.repulsion","largest":50}]"#;
    let mut simulation = Simulation::new(&fluid(&[&space[..], &[announced]].concat()), &adapter()).unwrap();
    simulation.advance(7).unwrap();
    for part in 0..4 {
        simulation.set("interactions.0.repulsion", 25.0 + f64::from(part) / 3.0 * 25.0).unwrap();
        simulation.advance(5).unwrap();
    }
    simulation.advance(9).unwrap();
    let expected = simulation.state().unwrap();
    assert!(ended.positions == expected.positions && ended.momenta == expected.momenta);
}

const STAGES: &str = r#"stages=[
    {"steps":10},
    {"steps":20,"set":{"temperature":0.5,"interactions.0.repulsion":40}},
    {"steps":16,"set":{"time.step":0.01},"ramp":{"temperature":[0.5,1]}}]"#;

#[test]
fn stages_share_one_axis_of_steps_and_times() {
    let output =
        r#"output={"energies":{"every":4},"trajectory":{"every":5,"format":"extended-xyz"},"snapshot":{"every":15}}"#;
    let scene = fluid(&["space.box=[4,4,4]", "time.step=0.02", "time.steps=46", STAGES, output]);
    let place = tempfile::tempdir().unwrap();
    end_of(&scene, place.path(), 1);
    let table = read_table(&place.path().join(files::ENERGIES)).unwrap();
    let time = |step: f64| if step <= 30.0 { 0.02 * step } else { 0.6 + 0.01 * (step - 30.0) };
    let expected: Vec<[f64; 2]> = (0..12).map(|row| [f64::from(4 * row), time(f64::from(4 * row))]).collect();
    assert_eq!(table.rows.len(), expected.len());
    for (row, [step, time]) in table.rows.iter().zip(expected) {
        assert!(row[0] == step && (row[1] - time).abs() < 1e-12, "{row:?}, {time}");
    }
    let frames = std::fs::read_to_string(place.path().join("trajectory.xyz")).unwrap();
    let times = frames.lines().filter_map(|line| line.split("Time=").nth(1)?.split(' ').next()?.parse::<f64>().ok());
    let times: Vec<f64> = times.collect();
    assert_eq!(times.len(), 10);
    for (frame, found) in times.iter().enumerate() {
        assert!((found - time(5.0 * frame as f64)).abs() < 1e-12, "{times:?}");
    }
    let summary = Summary::load(&place.path().join(files::SUMMARY)).unwrap();
    let stages: Vec<_> = summary.stages.iter().map(|stage| (stage.first_step, stage.last_step)).collect();
    assert_eq!(stages, [(0, 10), (10, 30), (30, 46)]);
    assert!((summary.stages[2].times[1] - 0.76).abs() < 1e-12);
    assert_eq!(summary.means, summary.stages[2].means);
    // Rows of steps 12, 16, 20, 24 and 28.
    let column = table.columns.iter().position(|name| name == "temperature").unwrap();
    let mean = table.rows[3..8].iter().map(|row| row[column]).sum::<f64>() / 5.0;
    assert!((summary.stages[1].means["temperature"]["value"].as_f64().unwrap() - mean).abs() < 1e-12);
    assert_eq!(summary.numbered.iter().map(|frame| frame.step).collect::<Vec<_>>(), [0, 15, 30, 45]);
    assert!((summary.numbered[3].time - 0.75).abs() < 1e-12);
}

#[test]
fn stages_have_the_same_bytes_on_any_number_of_ranks() {
    let scene = fluid(&["space.box=[4,4,12]", "time.step=0.02", "time.steps=46", STAGES, "output={}"]);
    let place = tempfile::tempdir().unwrap();
    let [alone, shared] = [1, 2].map(|slabs| end_of(&scene, &place.path().join(slabs.to_string()), slabs));
    assert!(alone == shared);
    let [alone, shared] =
        ["1", "2"].map(|slabs| std::fs::read(place.path().join(slabs).join(files::ENERGIES)).unwrap());
    assert!(alone == shared);
}

/// A run that goes on with other numbers is one with a stage more, to the bit where no unit changes.
#[test]
fn a_resumed_run_goes_on_in_a_new_stage() {
    let space = ["space.box=[4,4,4]", SPLITTING, r#"output={"energies":{"every":4}}"#];
    let place = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| place.path().join(name));
    let first = fluid(&[&space[..], &["time.steps=20"]].concat());
    end_of(&first, &one, 1);
    let resumed = Run::resume(&one, Some(44)).unwrap().in_new_stage(&["interactions.0.friction=9".to_owned()]).unwrap();
    let interrupt = Interrupt::default();
    let stopped = resumed.until(&interrupt).execute(&adapter(), &mut |event| {
        if matches!(event, Event::Advanced(progress) if progress.step > 25) {
            interrupt.ask();
        }
    });
    assert!(matches!(stopped, Ok(_) | Err(RunError::Interrupted { .. })), "{stopped:?}");
    if stopped.is_err() {
        Run::resume(&one, None).unwrap().execute(&adapter(), &mut |_| {}).unwrap();
    }
    let stages = r#"stages=[{"steps":20},{"steps":24,"set":{"interactions.0.friction":9}}]"#;
    let ended = end_of(&fluid(&[&space[..], &["time.steps=44", stages]].concat()), &two, 1);
    let found = checkpoint::load(&one.join(files::CHECKPOINT)).unwrap();
    assert!(found.state.positions == ended.positions && found.state.momenta == ended.momenta);
    assert_eq!(found.scene.stages.len(), 2);
    let [mine, theirs] = [&one, &two].map(|place| read_table(&place.join(files::ENERGIES)).unwrap());
    assert_eq!(mine.rows.len(), theirs.rows.len());
    // The first stage had its numbers in the code of kernels.
    for (mine, theirs) in mine.rows.iter().zip(&theirs.rows) {
        assert!(mine.iter().zip(theirs).all(|(a, b)| (a - b).abs() < 1e-4 * b.abs().max(1.0)), "{mine:?} {theirs:?}");
    }
    let refused = |steps, set: &str| {
        let error = Run::resume(&one, Some(steps)).unwrap().in_new_stage(&[set.to_owned()]).unwrap_err();
        error.to_string()
    };
    for (steps, set, expected) in [
        (44, "temperature=2", "time.steps: found 44 steps in all, of which 44 are behind"),
        (60, "seed=2", "stages[2].set.seed: found a key that cannot change in a run"),
        (60, "temperature=cold", "stages[2].set.temperature: found \"cold\"; accepted: a number"),
        (60, "temperature=-1", "stages[2]: with its numbers, temperature: found -1"),
    ] {
        let found = refused(steps, set);
        assert!(found.contains(expected), "{expected}: {found}");
    }
}

/// After a ramp a run goes on with its last numbers.
#[test]
fn a_run_goes_on_after_its_ramp() {
    let space = ["space.box=[4,4,4]", r#"output={"energies":{"every":4}}"#, "time.steps=20"];
    let ramp = r#"stages=[{"steps":20,"ramp":{"interactions.0.repulsion":[25,50]},"ramp_every":7}]"#;
    let place = tempfile::tempdir().unwrap();
    let [one, two] = ["one", "two"].map(|name| place.path().join(name));
    end_of(&fluid(&[&space[..], &[ramp]].concat()), &one, 1);
    let error = Run::resume(&one, Some(10)).unwrap_err().to_string();
    assert!(error.contains("stages[0].steps: found 10 steps in all; accepted: at least 20"), "{error}");
    Run::resume(&one, Some(32)).unwrap().execute(&adapter(), &mut |_| {}).unwrap();
    let found = checkpoint::load(&one.join(files::CHECKPOINT)).unwrap();
    assert_eq!(found.scene.stages.iter().map(|stage| stage.steps).collect::<Vec<_>>(), [20, 12]);
    let longer = ramp.replace(r#","ramp_every":7}]"#, r#","ramp_every":7},{"steps":12}]"#);
    let ended = end_of(&fluid(&[&space[..2], &["time.steps=32", &longer]].concat()), &two, 1);
    assert!(found.state.positions == ended.positions && found.state.momenta == ended.momenta);
}

/// A simulation that goes on from a run with stages has its times, through changes and further checkpoints.
#[test]
fn a_simulation_goes_on_with_the_times_of_stages() {
    let scene = fluid(&["space.box=[4,4,4]", "time.step=0.02", "time.steps=46", STAGES, "output={}"]);
    let place = tempfile::tempdir().unwrap();
    end_of(&scene, place.path(), 1);
    // 30 steps of .02 and 16 of .01.
    let mut simulation = Simulation::from_checkpoint(place.path().join(files::CHECKPOINT), &adapter()).unwrap();
    assert!((simulation.time() - 0.76).abs() < 1e-12, "{}", simulation.time());
    simulation.advance(4).unwrap();
    simulation.set("temperature", 1.0).unwrap();
    assert!((simulation.time() - 0.8).abs() < 1e-12, "{}", simulation.time());
    let again = place.path().join("again.bin");
    simulation.checkpoint(&again).unwrap();
    let again = Simulation::from_checkpoint(&again, &adapter()).unwrap();
    assert_eq!((again.step(), again.time()), (50, simulation.time()));
}

/// Each stage is warned of, by its place, once for each key.
#[test]
fn stages_are_warned_of() {
    let warned = |stages: &str| {
        let scene = fluid(&["time.steps=40", &format!("stages={stages}")]);
        families::warnings(&scene).into_iter().map(|warning| warning.path).collect::<Vec<_>>()
    };
    assert_eq!(warned(r#"[{"steps":40}]"#), Vec::<String>::new());
    // All that a scene of its own is warned of, and along a ramp no more; the relaxation is that of the first step.
    let relaxation = r#"integrator={"type":"splitting","relaxation":"mean-field"}"#;
    let plain = families::warnings(&fluid(&["time.step=0.1", relaxation]));
    let expected: Vec<String> = plain.iter().map(|warning| format!("stages[1]: {}", warning.path)).collect();
    assert!(expected.len() > 1, "{plain:?}");
    assert_eq!(warned(r#"[{"steps":20},{"steps":20,"set":{"time.step":0.1}}]"#), expected);
    assert_eq!(warned(r#"[{"steps":10},{"steps":30,"ramp":{"time.step":[0.1,0.11]}}]"#), expected);
}

#[test]
fn shallow_water_has_stages() {
    let stages = r#"stages=[{"steps":6},{"steps":6,"set":{"time.step":0.01,"interactions.0.rotation":3}}]"#;
    let scene = water(&["time.steps=12", stages]);
    let place = tempfile::tempdir().unwrap();
    let ended = end_of(&scene, place.path(), 1);
    let plain = end_of(&water(&["time.steps=12"]), &place.path().join("plain"), 1);
    assert!(ended.step == 12 && ended.positions != plain.positions);
}

/// Stages that measure and write what others do not.
const MEASURED: &str = r#"stages=[
    {"steps":13,"output":{"energies":{"every":5}}},
    {"steps":40,"set":{"temperature":2},"output":{"trajectory":{"every":8,"format":"extended-xyz"},
        "radial_distribution":{"every":7,"range":2,"bins":20},"clusters":{"every":7,"distance":0.6},
        "diffusion":{"every":2,"window":4}}},
    {"steps":9,"ramp":{"temperature":[2,1]},"ramp_every":3},
    {"steps":30,"output":{"trajectory":{"every":6,"format":"extended-xyz"},"energies":{"every":7},
        "structure_factor":{"every":5,"range":9},"radial_distribution":{"every":5,"range":2,"bins":20}}}]"#;

/// Numbered names and contents of all files in a directory and those in it, without pictures, summaries and checkpoints.
fn tables_in(directory: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(directory).unwrap().map(Result::unwrap) {
        let (name, path) = (entry.file_name().into_string().unwrap(), entry.path());
        if path.is_dir() {
            found.extend(tables_in(&path).into_iter().map(|(inner, content)| (format!("{name}/{inner}"), content)));
        } else if path.extension().is_some_and(|extension| extension == "csv" || extension == "xyz") {
            found.push((name, std::fs::read(path).unwrap()));
        }
    }
    found.sort();
    found
}

/// Frames of a trajectory without the id of the run in their heads, which is another for each scene.
fn frames_of(directory: &Path) -> Vec<(f64, Vec<String>)> {
    let text = std::fs::read_to_string(directory.join("trajectory.xyz")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let count = 2 + lines[0].parse::<usize>().unwrap();
    let time = |head: &str| head.split("Time=").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let frame = |lines: &[&str]| (time(lines[1]), lines[2..].iter().map(|line| (*line).to_owned()).collect());
    lines.chunks(count).map(frame).collect()
}

#[test]
fn a_stage_measures_and_writes_what_it_asks_for() {
    let space = ["space.box=[4,4,4]", "time.step=0.04", r#"output={"energies":{"every":4}}"#];
    let staged = fluid(&[&space[..], &["time.steps=92", MEASURED]].concat());
    let place = tempfile::tempdir().unwrap();
    let whole = place.path().join("whole");
    end_of(&staged, &whole, 1);
    let expected = tables_in(&whole);
    let names: Vec<&str> = expected.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(
        names,
        [
            "energies.csv",
            "radial_distribution.csv",
            "stage-2/cluster_sizes.csv",
            "stage-2/clusters.csv",
            "stage-2/diffusion.csv",
            "stage-2/radial_distribution.csv",
            "structure_factor.csv",
            "trajectory.xyz"
        ]
    );

    let rows: Vec<f64> = read_table(&whole.join(files::ENERGIES)).unwrap().rows.iter().map(|row| row[0]).collect();
    let every = |every: u32, steps: std::ops::Range<u32>| steps.filter(move |step| step.is_multiple_of(every));
    let steps = every(5, 0..13).chain(every(4, 13..62)).chain(every(7, 62..93));
    assert_eq!(rows, steps.map(f64::from).collect::<Vec<_>>());

    // A run that ends with the stage leaves the same in its own directory, and the numbers of the stage are its results.
    let short = place.path().join("short");
    let mut ends = (*staged).clone();
    ends.stages.truncate(2);
    ends.time.steps = 53;
    end_of(&ends.check().unwrap(), &short, 1);
    let summary = Summary::load(&whole.join(files::SUMMARY)).unwrap();
    assert_eq!(summary.stages[1].directory.as_deref(), Some("stage-2"));
    let of_short = Summary::load(&short.join(files::SUMMARY)).unwrap();
    let of_stage = Summary::load(&whole.join("stage-2").join(files::SUMMARY)).unwrap();
    assert_eq!(of_stage.results, summary.stages[1].results);
    for name in ["clusters.csv", "cluster_sizes.csv", "radial_distribution.csv"] {
        let [mine, theirs] =
            [whole.join("stage-2"), short.clone()].map(|place| std::fs::read(place.join(name)).unwrap());
        assert!(mine == theirs, "{name}");
        assert_eq!(of_stage.tables[name], of_short.tables[name]);
    }
    // No sample is due at the last step, which belongs to the next stage.
    let value = |summary: &Summary| summary.results["radial_distribution"].clone();
    assert_eq!(value(&of_stage), value(&of_short));
    assert!(of_stage.files.unwrap().iter().all(|name| whole.join("stage-2").join(name).exists()));
    assert!(whole.join("stage-2/clusters.png").exists());

    // Turns around the box are counted on where no frame is written: frames are those of a run that writes them in all stages.
    let throughout = MEASURED.replace(
        r#""ramp_every":3}"#,
        r#""ramp_every":3,"output":{"trajectory":{"every":2,"format":"extended-xyz"}}}"#,
    );
    let other = place.path().join("throughout");
    end_of(&fluid(&[&space[..], &["time.steps=92", &throughout]].concat()), &other, 1);
    let [mine, theirs] = [&whole, &other].map(|place| frames_of(place));
    assert_eq!((mine.len(), theirs.len()), (5 + 5, 5 + 5 + 4));
    assert!(mine.iter().all(|frame| theirs.contains(frame)));

    // To the bit on two ranks, and after interruptions, wherever they are.
    let shared = place.path().join("shared");
    let wide = ["space.box=[4,4,12]", "time.step=0.04", r#"output={"energies":{"every":4}}"#];
    let on_one_rank =
        run::divide(&fluid(&[&wide[..], &["time.steps=92", MEASURED]].concat()), Ranks::Count(2)).unwrap_err();
    assert!(on_one_rank.to_string().contains("`structure_factor` in output.structure_factor: on one rank only"));
    let shareable = MEASURED.replace(r#""structure_factor":{"every":5,"range":9},"#, "");
    let wide = fluid(&[&wide[..], &["time.steps=92", &shareable]].concat());
    let alone = place.path().join("alone");
    end_of(&wide, &alone, 1);
    end_of(&wide, &shared, 2);
    assert!(tables_in(&alone) == tables_in(&shared));
    let broken = place.path().join("broken");
    let mut run = Run::start(staged, &broken);
    let mut interruptions = 0;
    for asked in [4, 20, 45, 57, 70, 1000] {
        let interrupt = Interrupt::default();
        let ended = run.until(&interrupt).execute(&adapter(), &mut |event| {
            if matches!(event, Event::Advanced(progress) if progress.step >= asked) {
                interrupt.ask();
            }
        });
        assert!(matches!(ended, Ok(_) | Err(RunError::Interrupted { .. })), "{ended:?}");
        interruptions += u32::from(ended.is_err());
        run = Run::resume(&broken, None).unwrap();
    }
    assert!(interruptions > 2, "{interruptions}");
    assert!(tables_in(&broken) == expected);
}

/// What analyses of a stage have found stays when the run goes on after it.
#[test]
fn results_of_a_last_stage_are_kept_when_another_one_follows() {
    let stages = r#"stages=[{"steps":20,"output":{"radial_distribution":{"every":5,"range":1.9}}}]"#;
    let scene = fluid(&["space.box=[4,4,4]", "time.steps=20", stages, r#"output={"energies":{"every":4}}"#]);
    let place = tempfile::tempdir().unwrap();
    end_of(&scene, place.path(), 1);
    let table = std::fs::read(place.path().join("radial_distribution.csv")).unwrap();
    let before = Summary::load(&place.path().join(files::SUMMARY)).unwrap();
    let resumed = Run::resume(place.path(), Some(40)).unwrap().in_new_stage(&["temperature=2".to_owned()]).unwrap();
    let outcome = resumed.execute(&adapter(), &mut |_| {}).unwrap();
    assert_eq!(outcome.summary.stages[0].results, before.results);
    assert!(!outcome.summary.results.contains_key("radial_distribution"));
    assert!(!outcome.files.contains(&"radial_distribution.csv"));
    assert!(std::fs::read(place.path().join("stage-1/radial_distribution.csv")).unwrap() == table);
    // What the next run in the directory removes; a note of the user stays.
    std::fs::write(place.path().join("stage-1/notes.txt"), "mine").unwrap();
    end_of(&fluid(&["space.box=[4,4,4]", "time.steps=4", "output={}"]), place.path(), 1);
    let left: Vec<_> =
        std::fs::read_dir(place.path().join("stage-1")).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["notes.txt"]);
}
