//! Damage that no checksum shows, and processes that end at any moment: checkpoints altered by someone who computes their
//! checksum anew, tables with a flipped bit, runs killed while they compute, write and finish.
//!
//! Every case follows from a seed. A few run with all tests; `make validate` runs thousands.

use crate::support::edited;
use std::fs;
use std::ops::Range;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::process::Stdio;
use std::time::Instant;

use mesoscope::gpu::AdapterChoice;
use mesoscope::output::{Id, checkpoint, files};
use mesoscope::run::{Interrupt, Run, RunError};
use mesoscope::scene::{self, Checked};
use mesoscope::sweep::{self, SweepSummary, VariantState, VariantSummary};
use rand::rngs::StdRng;
use rand::seq::IndexedRandom as _;
use rand::{RngExt as _, SeedableRng as _};
use serde_json::{Value, json};

use crate::cost::{MEMORY, PATIENCE, measured};
use crate::support::program::{Place, assert_same, bytes, command, listing, results, succeeds, text};

/// A small scene of every kind of state: a name, the built-in scene, and what makes it small.
fn families() -> Vec<(&'static str, Checked)> {
    let output = r#"output={"energies":{"every":3},"trajectory":{"every":10},"checkpoint":{"every":20},
        "radial_distribution":{"every":4,"range":1.2},"plot":{"width":640,"height":480},
        "snapshot":{"every":25,"width":100,"height":80}}"#;
    let flat = output.replace(r#""radial_distribution":{"every":4,"range":1.2},"#, "");
    let xyz = flat.replace(r#"{"every":10}"#, r#"{"every":10,"format":"extended-xyz"}"#);
    let cells = flat.replace(r#""plot""#, r#""neighbours":{"every":7},"plot""#);
    let chain = r#"output={"energies":{"every":3},"chain":{"every":5},"plot":{"width":640,"height":480}}"#;
    let time = r#"time={"step":0.01,"steps":60,"equilibration":10}"#;
    let shorter = r#"time={"step":0.001,"steps":60,"equilibration":10}"#;
    let beads = r#"particles=[{"species":"bead","count":60,"chain":{"beads":5,"spacing":0.9}}]"#;
    let remembering = r#"interactions.1.bath={"type":"memory","rate":2}"#;
    let kinds: [(&str, &str, &[&str]); 8] = [
        ("fluid", "dpd-fluid", &["space.box=[4,4,4]", time, output]),
        ("memory", "edpd-fluid", &["space.box=[4,4,4]", time, output]),
        ("melt", "polymer-melt", &["space.box=[4,4,4]", beads, time, output]),
        (
            "bonds",
            "polymer-melt",
            &["space.box=[4,4,4]", beads, r#"integrator={"type":"cotter-reich"}"#, remembering, time, output],
        ),
        ("noise", "coloured-noise", &["space.box=[9,9]", "particles.0.count=50", time, &xyz]),
        ("water", "shallow-water-memory", &["interactions.0.mesh=[16,16]", "particles.0.count=4096", time]),
        (
            "cells",
            "voronoi-energy",
            &[
                "particles.0.count=100",
                "space.box=[10,10]",
                "interactions.0.energy.initial_temperatures=[]",
                shorter,
                &cells,
            ],
        ),
        (
            "chain",
            "harmonic-chain",
            &[
                "interactions.0.pulse.clusters=32",
                "interactions.0.pulse.amplitude=8",
                "interactions.0.equilibrium.clusters=16",
                r#"time={"step":0.1,"steps":60}"#,
                chain,
            ],
        ),
    ];
    let load = |(name, builtin, set): (&'static str, &str, &[&str])| {
        let set: Vec<String> = set.iter().map(|text| (*text).to_owned()).collect();
        (name, scene::load(builtin, &set).unwrap_or_else(|error| panic!("{name}: {error}")))
    };
    kinds.into_iter().map(load).collect()
}

/// Names and contents.
type Files = Vec<(String, Vec<u8>)>;

/// A run of every family that has come half-way.
fn half_way(place: &Path) -> Vec<(&'static str, Files)> {
    let run = |(name, scene): (&'static str, Checked)| {
        let directory = place.join(name);
        let half = edited(&scene, |scene| scene.time.steps = 30);
        Run::start(half, &directory).execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
        fs::remove_file(directory.join(files::SUMMARY)).unwrap();
        let files = listing(&directory).into_iter().map(|name| (name.clone(), bytes(&directory.join(&name))));
        let files = files.collect();
        fs::remove_dir_all(&directory).unwrap();
        (name, files)
    };
    families().into_iter().map(run).collect()
}

/// The directory of a run, with these files and no others.
fn lay_out(directory: &Path, files: &[(String, Vec<u8>)]) {
    let _ = fs::remove_dir_all(directory);
    fs::create_dir_all(directory).unwrap();
    for (name, content) in files {
        fs::write(directory.join(name), content).unwrap();
    }
}

/// Bytes of a checkpoint before its payload and after it.
const HEADER: usize = 20;
const CHECKSUM: usize = 8;

/// A payload with what goes around it.
fn sealed(start: &[u8], payload: &[u8]) -> Vec<u8> {
    let step = |sum: u64, byte: &u8| (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    let sum = payload.iter().fold(0xcbf2_9ce4_8422_2325_u64, step);
    [start, &(payload.len() as u64).to_le_bytes(), payload, &sum.to_le_bytes()].concat()
}

/// Where the scene is in a payload.
fn scene_in(payload: &[u8]) -> Range<usize> {
    let length = |at: usize| u64::from_le_bytes(payload[at..at + 8].try_into().unwrap()) as usize;
    // After the id of the run.
    let begin = 8 + length(0) + 8;
    begin..begin + length(begin - 8)
}

/// One mistake, or a few.
fn mutated(payload: &[u8], random: &mut StdRng) -> Vec<u8> {
    let mut altered = payload.to_vec();
    let scene = scene_in(payload);
    let rest = scene.end..payload.len();
    match random.random_range(0..7) {
        0 => {
            for _ in 0..random.random_range(1..4) {
                altered[random.random_range(rest.clone())] ^= 1 << random.random_range(0..8);
            }
        }
        1 => {
            let place = random.random_range(rest.start..rest.end - 7);
            let extreme =
                *[0, 1, 255, 1 << 32, 1 << 40, u64::MAX / 12, u64::MAX, i64::MAX as u64].choose(random).unwrap();
            altered[place..place + 8].copy_from_slice(&extreme.to_le_bytes());
        }
        2 => {
            // Words, as most of a state are: the largest, the smallest, what is not a number.
            let words = (rest.len() - 16) / 4;
            for _ in 0..random.random_range(1..20) {
                let place = rest.start + 16 + 4 * random.random_range(0..words);
                let extreme =
                    *[0, 1, u32::MAX, 1 << 31, i32::MAX as u32, 0x7fc0_0000, 0x7f80_0000].choose(random).unwrap();
                altered[place..place + 4].copy_from_slice(&extreme.to_le_bytes());
            }
        }
        3 => {
            let place = random.random_range(rest);
            let length = random.random_range(1..200).min(payload.len() - place);
            altered.drain(place..place + length);
        }
        4 => {
            let place = random.random_range(rest);
            let length = random.random_range(1..200).min(payload.len() - place);
            let twice = payload[place..place + length].to_vec();
            altered.splice(place..place, twice);
        }
        5 => altered[random.random_range(scene)] ^= 1 << random.random_range(0..8),
        _ => {
            let mut document: Value = serde_json::from_slice(&payload[scene.clone()]).unwrap();
            let mut numbers = Vec::new();
            find_numbers(&document, String::new(), &mut numbers);
            for _ in 0..random.random_range(1..3) {
                let extreme =
                    [json!(0), json!(-1), json!(1), json!(1e9), json!(4_294_967_296_u64), json!(1e300), json!(1e-300)];
                *document.pointer_mut(numbers.choose(random).unwrap()).unwrap() =
                    extreme.choose(random).unwrap().clone();
            }
            let text = document.to_string();
            let length = scene.start - 8..scene.start;
            altered.splice(scene, text.bytes());
            altered[length].copy_from_slice(&(text.len() as u64).to_le_bytes());
        }
    }
    altered
}

/// The places of all numbers in a document.
fn find_numbers(value: &Value, path: String, found: &mut Vec<String>) {
    match value {
        Value::Number(_) => found.push(path),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(index, value)| find_numbers(value, format!("{path}/{index}"), found));
        }
        Value::Object(object) => {
            object.iter().for_each(|(key, value)| find_numbers(value, format!("{path}/{key}"), found));
        }
        _ => {}
    }
}

/// Alters checkpoints, and goes on with those that are not refused, as long as there are no more of them than `executed`.
fn alter_checkpoints(seed: u64, each: usize, executed: usize) {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("run");
    let mut random = StdRng::seed_from_u64(seed);
    let (mut refused, mut accepted, mut gone_on) = (0, 0, [0; 3]);
    for (name, files) in half_way(place.path()) {
        let whole = files.iter().find(|(name, _)| name == files::CHECKPOINT).unwrap().1.clone();
        let (start, payload) = (&whole[..12], &whole[HEADER..whole.len() - CHECKSUM]);
        assert!(sealed(start, payload) == whole, "the format is another one");
        lay_out(&directory, &files);
        drop(Run::resume(&directory, Some(40)).unwrap_or_else(|error| panic!("{name}: {error}")));
        let mut allowed = executed;
        for case in 0..each {
            let altered = sealed(start, &mutated(payload, &mut random));
            fs::write(directory.join(files::CHECKPOINT), &altered).unwrap();
            let say = |problem: &str| {
                let kept = std::env::temp_dir().join(format!("mesoscope-checkpoint-{name}-{seed}-{case}.bin"));
                fs::write(&kept, &altered).unwrap();
                panic!("{name}, case {case} of seed {seed}: {problem}; see {}", kept.display())
            };
            let (resumed, cost) = measured(|| Run::resume(&directory, Some(40)));
            let Ok(resumed) = resumed else { say("it panics") };
            if cost.memory > MEMORY {
                say("it takes too much memory");
            }
            if cost.time > PATIENCE {
                say("it takes too long");
            }
            match resumed {
                Err(error) => {
                    refused += 1;
                    let said = error.to_string();
                    assert!(!said.is_empty() && !matches!(error, RunError::Engine(_) | RunError::Gpu(_)), "{said}");
                }
                Ok(simulation) => {
                    accepted += 1;
                    if allowed == 0 || simulation.is_finished() {
                        continue;
                    }
                    allowed -= 1;
                    // To the end, or as far as a run comes that is asked to stop from the start.
                    let interrupt = Interrupt::default();
                    if simulation.scene().time.steps > 40 || case % 2 == 0 {
                        interrupt.ask();
                    }
                    let run = simulation.until(&interrupt);
                    let ended = catch_unwind(AssertUnwindSafe(|| run.execute(&AdapterChoice::Best, &mut |_| {})));
                    let Ok(ended) = ended else { say("its run panics") };
                    match ended {
                        Ok(_) => gone_on[0] += 1,
                        Err(RunError::Interrupted { .. }) => gone_on[1] += 1,
                        Err(error) => {
                            assert!(!error.to_string().is_empty());
                            gone_on[2] += 1;
                        }
                    }
                    lay_out(&directory, &files);
                }
            }
        }
    }
    let [finished, stopped, failed] = gone_on;
    println!(
        "seed {seed}: of {} altered checkpoints {refused} were refused and {accepted} taken; of those that went on \
         {finished} came to their end, {stopped} were stopped, {failed} failed with a message",
        refused + accepted
    );
}

#[test]
fn checkpoints_with_a_right_checksum_are_refused_or_harmless() {
    alter_checkpoints(1, 16, 1);
}

#[test]
#[ignore = "thousands of checkpoints"]
fn thousands_of_checkpoints_with_a_right_checksum_are_refused_or_harmless() {
    for seed in 2..6 {
        alter_checkpoints(seed, 400, 10);
    }
}

/// What a run begins with and what it comes to fits the scene, for all scenes that are shipped.
#[test]
fn shipped_scenes_come_back_from_checkpoints() {
    let place = tempfile::tempdir().unwrap();
    for builtin in scene::builtin() {
        let scene = scene::load(builtin.name, &[]).unwrap();
        let state = mesoscope::families::initial_state(&scene);
        checkpoint::save(&place.path().join(files::CHECKPOINT), Id::of_run(&scene), &scene, &state, &[], &[]).unwrap();
        let resumed = Run::resume(place.path(), None);
        let resumed = resumed.unwrap_or_else(|error| panic!("{}: {error}", builtin.name));
        assert!(*resumed.scene() == scene, "{}", builtin.name);
    }
}

/// Flips bits of tables and trajectories: those of what is kept are noticed, all others make no difference.
fn flip_tables(seed: u64, each: usize) {
    let place = tempfile::tempdir().unwrap();
    let mut random = StdRng::seed_from_u64(seed);
    let (mut refused, mut harmless) = (0, 0);
    for (name, scene) in families().into_iter().filter(|(name, _)| ["fluid", "noise"].contains(name)) {
        let (whole, directory) = (place.path().join(name), place.path().join("run"));
        let run = |steps: u64| {
            let scene = edited(&scene, |scene| scene.time.steps = steps);
            Run::replace(scene, &whole).execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
        };
        run(50);
        let longer = listing(&whole).into_iter().map(|name| (name.clone(), bytes(&whole.join(name))));
        let mut longer: Vec<(String, Vec<u8>)> = longer.filter(|(name, _)| name != files::SUMMARY).collect();
        run(40);
        // Tables have rows that the checkpoint knows nothing of, as after a kill.
        let saved = bytes(&whole.join(files::CHECKPOINT));
        longer.iter_mut().find(|(name, _)| name == files::CHECKPOINT).unwrap().1 = saved;
        run(60);
        let growing = [files::ENERGIES, files::TRAJECTORY_GSD, files::TRAJECTORY_XYZ];
        for case in 0..each {
            let mut altered = longer.clone();
            let mut tables: Vec<_> = altered.iter_mut().filter(|(name, _)| growing.contains(&name.as_str())).collect();
            let table = random.random_range(0..tables.len());
            let (table, content) = &mut *tables[table];
            let place = random.random_range(0..content.len());
            content[place] ^= 1 << random.random_range(0..8);
            let table = table.clone();
            lay_out(&directory, &altered);
            let resumed = Run::resume(&directory, Some(60)).unwrap();
            match resumed.execute(&AdapterChoice::Best, &mut |_| {}) {
                Err(RunError::Stopped { source, .. } | RunError::Output(source)) => {
                    refused += 1;
                    assert!(source.to_string().contains(&table), "{source}");
                }
                Err(error) => panic!("case {case}: {error}"),
                Ok(_) => {
                    harmless += 1;
                    if table == files::TRAJECTORY_GSD {
                        // What no reader sees of a GSD file is left alone.
                        fs::copy(whole.join(&table), directory.join(&table)).unwrap();
                    }
                    assert_same(&directory, &whole);
                }
            }
        }
    }
    println!(
        "seed {seed}: of {} flipped bits of tables {refused} were refused, {harmless} were cut off",
        refused + harmless
    );
}

#[test]
fn flipped_bits_of_tables_are_refused_or_cut_off() {
    flip_tables(1, 8);
}

#[test]
#[ignore = "thousands of flipped bits"]
fn thousands_of_flipped_bits_of_tables_are_refused_or_cut_off() {
    flip_tables(2, 1000);
}

/// Kills runs at random moments, once or more, and lets them go on to their end: every file has the bytes of a run that was
/// never killed.
fn kill(seed: u64, names: &[&str], each: usize) {
    let mut random = StdRng::seed_from_u64(seed);
    let (mut kills, mut before_the_first_checkpoint) = (0, 0);
    for (name, scene) in families().into_iter().filter(|(name, _)| names.contains(name)) {
        let place = Place::of(serde_json::to_value(&scene).unwrap());
        let (out, scene) = (place.argument("out"), place.scene());
        let begun = Instant::now();
        succeeds(&["run", &scene, "--out", &place.argument("whole"), "--quiet"]);
        let whole = begun.elapsed();
        for case in 0..each {
            let run = ["run", &scene, "--out", &out, "--quiet", "--force"];
            let resume = ["resume", &out, "--quiet"];
            let mut arguments: &[&str] = &run;
            for _ in 0..random.random_range(1..4) {
                let mut child = command(arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
                std::thread::sleep(whole.mul_f64(random.random_range(0.0..1.1)));
                child.kill().unwrap();
                child.wait().unwrap();
                kills += 1;
                let saved = place.path("out").join(files::CHECKPOINT).exists();
                arguments = if saved { &resume } else { &run };
                before_the_first_checkpoint += usize::from(!saved);
            }
            let output = command(arguments).output().unwrap();
            assert!(output.status.success(), "{name}, case {case} of seed {seed}: {}", text(&output.stderr));
            assert_same(&place.path("out"), &place.path("whole"));
        }
    }
    println!(
        "seed {seed}: {kills} kills, {before_the_first_checkpoint} of them before the first checkpoint; all runs went on"
    );
}

#[test]
fn killed_runs_go_on_as_if_they_had_not_been() {
    kill(1, &["fluid", "cells"], 1);
}

#[test]
#[ignore = "hundreds of kills"]
fn hundreds_of_killed_runs_go_on_as_if_they_had_not_been() {
    kill(2, &["fluid", "memory", "melt", "bonds", "noise", "water", "cells", "chain"], 20);
}

/// Everything that a sweep leaves, apart from how long it took: names with their contents.
fn sweep_results(directory: &Path) -> Files {
    let timeless = |name: &str, content: Vec<u8>| match name {
        sweep::files::SUMMARY => {
            let mut summary = SweepSummary::load(directory).unwrap();
            for variant in &mut summary.variants {
                (variant.wall_seconds, variant.particle_steps_per_second) = (0.0, 0.0);
            }
            serde_json::to_vec(&summary).unwrap()
        }
        sweep::files::TABLE => {
            let lines: Vec<Vec<&str>> = text(&content).lines().map(|line| line.split(',').collect()).collect();
            let is_time = |column: usize| ["wall_seconds", "particle_steps_per_second"].contains(&lines[0][column]);
            let kept = lines.iter().map(|cells| {
                let kept = (0..cells.len()).filter(|column| !is_time(*column)).map(|column| cells[column]);
                kept.collect::<Vec<_>>().join(",")
            });
            kept.collect::<Vec<_>>().join("\n").into_bytes()
        }
        _ => content,
    };
    let found = listing(directory).into_iter().flat_map(|name| {
        let path = directory.join(&name);
        if path.is_dir() {
            let files = results(&path).into_iter().map(|(file, content)| (format!("{name}/{file}"), content));
            return files.collect();
        }
        vec![(name.clone(), timeless(&name, bytes(&path)))]
    });
    found.collect()
}

/// Kills sweeps at random moments, once to three times, and lets them come to their end: every file, of the sweep and of its
/// runs, has the bytes of a sweep that was never killed.
fn kill_sweeps(seed: u64, names: &[&str], each: usize) {
    let mut random = StdRng::seed_from_u64(seed);
    let (mut kills, mut before_the_summary, mut after_a_variant) = (0, 0, 0);
    for (name, scene) in families().into_iter().filter(|(name, _)| names.contains(name)) {
        let place = Place::of(serde_json::to_value(&scene).unwrap());
        let (out, scene) = (place.argument("out"), place.scene());
        let sweep = |out: &str, jobs: &str| {
            let vary = ["--vary", "seed=1,2,3,4"];
            let all = [&["sweep", &scene, "--out", out, "--quiet", "--force", "--jobs", jobs], &vary[..]].concat();
            all.into_iter().map(str::to_owned).collect::<Vec<_>>()
        };
        let run = |arguments: &[String]| command(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        let begun = Instant::now();
        assert!(run(&sweep(&place.argument("whole"), "2")).status().unwrap().success());
        let whole = begun.elapsed();
        let expected = sweep_results(&place.path("whole"));
        for case in 0..each {
            let jobs = random.random_range(1..3).to_string();
            let mut arguments = sweep(&out, &jobs);
            for _ in 0..random.random_range(1..4) {
                let mut child = run(&arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
                std::thread::sleep(whole.mul_f64(random.random_range(0.0..1.1)));
                child.kill().unwrap();
                child.wait().unwrap();
                kills += 1;
                match SweepSummary::load(&place.path("out")) {
                    Ok(summary) => {
                        let finished = |variant: &VariantSummary| variant.state == VariantState::Finished;
                        after_a_variant += usize::from(summary.variants.iter().any(finished));
                        arguments = ["sweep", "--resume", &out, "--quiet", "--jobs", &jobs].map(str::to_owned).to_vec();
                    }
                    Err(_) => before_the_summary += 1,
                }
            }
            let output = run(&arguments).output().unwrap();
            assert!(output.status.success(), "{name}, case {case} of seed {seed}: {}", text(&output.stderr));
            let found = sweep_results(&place.path("out"));
            let listed = |files: &Files| files.iter().map(|(name, _)| name.clone()).collect::<Vec<_>>();
            assert_eq!(listed(&found), listed(&expected), "{name}, case {case} of seed {seed}");
            for ((file, content), (_, expected)) in found.iter().zip(&expected) {
                assert!(content == expected, "{name}, case {case} of seed {seed}: {file} differs");
            }
            fs::remove_dir_all(place.path("out")).unwrap();
        }
    }
    println!(
        "seed {seed}: {kills} kills of sweeps, {before_the_summary} of them before their first file and {after_a_variant} \
         after their first run; all sweeps came to their end"
    );
}

#[test]
fn killed_sweeps_come_to_their_end_as_if_they_had_not_been() {
    kill_sweeps(1, &["fluid"], 2);
}

#[test]
#[ignore = "hundreds of kills"]
fn hundreds_of_killed_sweeps_come_to_their_end_as_if_they_had_not_been() {
    kill_sweeps(2, &["fluid", "melt", "noise", "water", "cells"], 16);
}
