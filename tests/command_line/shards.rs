//! Shards of a sweep: processes that run variants of their own in one directory, who gathers what they left, and copies that are refused.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use mesoscope::gpu::AdapterChoice;
use mesoscope::output::{RunDirectory, files};
use mesoscope::run::Interrupt;
use mesoscope::sweep::{Shard, Sweep, SweepRun, SweepSummary, VariantState};
use serde_json::{Value, json};

use crate::support::program::{Place, bytes, command, fails, listing, succeeds, succeeds_and_tells, text};

/// A fluid of 27 particles.
fn place() -> Place {
    Place::of(json!({
        "title": "small fluid",
        "space": {"box": [3, 3, 3]},
        "time": {"step": 0.02, "steps": 40},
        "temperature": 1,
        "particles": [{"species": "fluid", "number_density": 1}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 2},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    }))
}

/// The arguments of a sweep over the seed.
fn sweep(place: &Place, seeds: &str, further: &[&str]) -> Vec<String> {
    let own = ["sweep", &place.scene(), "--vary", &format!("seed={seeds}"), "--out", &place.argument("out")];
    own.iter().chain(further).map(|argument| (*argument).to_owned()).collect()
}

fn borrowed(arguments: &[String]) -> Vec<&str> {
    arguments.iter().map(String::as_str).collect()
}

/// What a shard says of itself.
fn noted(place: &Place, shard: &str) -> Value {
    let path = place.path("out/shards").join(shard).join("shard.json");
    serde_json::from_slice(&bytes(&path)).unwrap()
}

/// Variables that say which copy of several a process is.
const OF_COPIES: [&str; 24] = [
    "OMPI_COMM_WORLD_RANK",
    "OMPI_COMM_WORLD_SIZE",
    "OMPI_COMM_WORLD_LOCAL_RANK",
    "MV2_COMM_WORLD_RANK",
    "MV2_COMM_WORLD_SIZE",
    "PMI_RANK",
    "PMI_SIZE",
    "PMIX_RANK",
    "SLURM_PROCID",
    "SLURM_LOCALID",
    "SLURM_NTASKS",
    "SLURM_STEP_NUM_TASKS",
    "SLURM_ARRAY_TASK_ID",
    "SLURM_ARRAY_TASK_MIN",
    "SLURM_ARRAY_TASK_MAX",
    "SLURM_ARRAY_TASK_STEP",
    "SLURM_ARRAY_TASK_COUNT",
    "SGE_TASK_ID",
    "SGE_TASK_FIRST",
    "SGE_TASK_LAST",
    "SGE_TASK_STEPSIZE",
    "PBS_ARRAY_INDEX",
    "PBS_ARRAYID",
    "LSB_JOBINDEX",
];

/// The program where these variables, and no others of copies, are set.
fn with(variables: &[(&str, &str)], arguments: &[&str]) -> Output {
    let mut command = command(arguments);
    for name in OF_COPIES {
        command.env_remove(name);
    }
    command.envs(variables.iter().copied()).output().unwrap()
}

#[test]
fn shards_at_the_same_time_leave_what_the_sweep_leaves() {
    let place = place();
    let whole = place.argument("whole");
    succeeds(&["sweep", &place.scene(), "--vary", "seed=1,2,3,4,5", "--out", &whole, "--quiet"]);
    // All of them begin at once.
    let arguments = ["1/3", "2/3", "3/3"].map(|shard| sweep(&place, "1,2,3,4,5", &["--shard", shard, "--quiet"]));
    let mut processes = arguments.map(|arguments| command(&borrowed(&arguments)).spawn().unwrap());
    for process in &mut processes {
        assert!(process.wait().unwrap().success());
    }
    let (whole, out) = (place.path("whole"), place.path("out"));
    let expected = ["seed=1", "seed=2", "seed=3", "seed=4", "seed=5", "shards", "sweep.json"];
    assert_eq!(listing(&out), expected, "shards leave no table and no plots");
    for (shard, expected) in
        [("1-of-3", &["seed=1", "seed=4"][..]), ("2-of-3", &["seed=2", "seed=5"]), ("3-of-3", &["seed=3"])]
    {
        let entries = noted(&place, shard)["variants"].as_array().unwrap().clone();
        let names: Vec<&str> = entries.iter().map(|entry| entry["name"].as_str().unwrap()).collect();
        assert_eq!(names, expected);
        assert!(entries.iter().all(|entry| entry["state"] == "finished"), "{entries:?}");
        assert_eq!(listing(&out.join("shards").join(shard)), ["shard.json"]);
    }
    let said = succeeds(&["sweep", "--resume", &place.argument("out")]);
    assert!(said.contains("0 of 5 variants left of seed"), "{said}");
    let mut expected = listing(&whole);
    expected.push("shards".to_owned());
    expected.sort();
    assert_eq!(listing(&out), expected);
    for name in listing(&whole).iter().filter(|name| name.starts_with("sweep-")) {
        assert!(bytes(&whole.join(name)) == bytes(&out.join(name)), "{name} differs");
    }
    for seed in 1..=5 {
        for name in [files::ENERGIES, files::CHECKPOINT, files::SNAPSHOT] {
            let name = format!("seed={seed}/{name}");
            assert!(bytes(&whole.join(&name)) == bytes(&out.join(&name)), "{name} differs");
        }
    }
    // All of it makes way for another sweep when that is asked for.
    succeeds(&borrowed(&sweep(&place, "7,8", &["--quiet", "--force", "--plot", "pressure"])));
    let expected = ["seed=7", "seed=8", "sweep-averages.csv", "sweep-pressure.png", "sweep.csv", "sweep.json"];
    assert_eq!(listing(&out), expected);
}

#[test]
fn a_shard_has_nothing_to_do_with_the_variants_of_others() {
    let place = place();
    let shard = |shard: &str| sweep(&place, "1,2,3", &["--shard", shard]);
    let said = succeeds(&borrowed(&shard("1/2")));
    assert!(said.contains("2 variants of seed, shard 1/2") && said.contains("shards/1-of-2/shard.json"), "{said}");
    assert!(said.contains("seed=3") && !said.contains("seed=2"), "{said}");
    let out = place.path("out");
    assert_eq!(listing(&out), ["seed=1", "seed=3", "shards", "sweep.json"]);
    // Whoever looks into a directory removes what a killed process left there, under a name like this.
    let left = out.join("seed=2").join("run.json.mesoscope-4711-3.tmp");
    fs::create_dir(out.join("seed=2")).unwrap();
    fs::write(&left, "half").unwrap();
    // Again: nothing is left to do, and the summary of the sweep stays what it is.
    let summary = bytes(&out.join("sweep.json"));
    let table = out.join("seed=1").join(files::ENERGIES);
    let time = |path: &Path| fs::metadata(path).unwrap().modified().unwrap();
    let before = (time(&table), time(&out.join("sweep.json")));
    let said = succeeds(&borrowed(&shard("1/2")));
    assert!(said.contains("0 of 2 variants left of seed, shard 1/2"), "{said}");
    assert!((time(&table), time(&out.join("sweep.json"))) == before, "run again");
    assert!(left.exists(), "a shard looked into the directory of another's variant");
    // One that is missing is run again, by the shard that it belongs to or by who gathers.
    fs::remove_dir_all(out.join("seed=3")).unwrap();
    succeeds(&borrowed(&shard("1/2")));
    assert!(bytes(&out.join("sweep.json")) == summary && out.join("seed=3").join(files::SUMMARY).exists());
    let said = succeeds(&["sweep", "--resume", &place.argument("out")]);
    assert!(said.contains("1 of 3 variants left of seed") && !left.exists(), "{said}");
    let summary = SweepSummary::load(&out).unwrap();
    assert!(summary.variants.iter().all(|variant| variant.state == VariantState::Finished));
    // There may be more shards than variants, and other numbers of shards later.
    let said = succeeds(&borrowed(&shard("4/4")));
    assert!(said.contains("0 variants of seed, shard 4/4"), "{said}");
    // What fails is noted, and does not stop the others.
    let unstable = ["sweep", &place.scene(), "--out", &place.argument("other"), "--shard", "1/1"];
    let vary = ["--vary", "interactions.0.repulsion=10,2900"];
    let message = fails(&[&unstable[..], &vary].concat(), 4, &["1 of 2 variants failed", "`repulsion=2900`"]);
    assert!(message.contains("repulsion=10  finished"), "{message}");
    let path = place.path("other/shards/1-of-1/shard.json");
    let noted: Value = serde_json::from_slice(&bytes(&path)).unwrap();
    assert_eq!(noted["variants"][1]["state"], "failed");
}

#[test]
fn one_process_at_a_time_runs_a_shard_or_gathers() {
    let place = place();
    let shard = |shard: &str| sweep(&place, "1,2,3", &["--shard", shard, "--quiet"]);
    succeeds(&borrowed(&shard("1/2")));
    let out = place.path("out");
    let under_way = RunDirectory::claim(out.join("shards/1-of-2")).unwrap();
    let parts = ["shards/1-of-2` is in use by process"];
    fails(&borrowed(&shard("1/2")), 5, &parts);
    fails(&borrowed(&shard("1/3")), 5, &parts);
    fails(&["sweep", "--resume", &place.argument("out")], 5, &parts);
    fails(&["plot", &place.argument("out")], 5, &parts);
    let before = listing(&out);
    fails(&borrowed(&sweep(&place, "7,8", &["--force"])), 5, &parts);
    assert_eq!(listing(&out), before);
    succeeds(&borrowed(&shard("2/2")));
    drop(under_way);
    // While somebody gathers, no shard begins. This one is not patient.
    let gathering = SweepRun::resume(&out).unwrap();
    let asked = || Sweep::load(&place.scene(), &[], None, &["seed=1,2,3".to_owned()], &[]).unwrap();
    let interrupt = Interrupt::default();
    interrupt.ask();
    let run = SweepRun::start(asked(), &out).until(&interrupt);
    let ended = run.execute_shard(Shard::new(2, 2).unwrap(), &AdapterChoice::Best, &mut |_| {});
    let message = ended.unwrap_err().to_string();
    assert!(message.contains("out` is in use by process"), "{message}");
    // Nor does a second gather.
    fails(&["sweep", "--resume", &place.argument("out")], 5, &["out` is in use by process"]);
    drop(gathering);
    // A shard of another number of shards follows when the others have ended.
    succeeds(&borrowed(&shard("1/3")));
    // Who holds the directory for a moment only is waited for.
    let moment = RunDirectory::claim(&out).unwrap();
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| succeeds(&borrowed(&shard("1/2"))));
        std::thread::sleep(std::time::Duration::from_millis(1500));
        assert!(!waiting.is_finished());
        drop(moment);
    });
}

#[test]
fn shards_of_different_sweeps_do_not_mix() {
    let place = place();
    let (scene, out) = (place.scene(), place.argument("out"));
    let shard = |scene: &str, further: &[&str]| {
        let own = ["sweep", scene, "--out", &out, "--shard", "2/2", "--quiet"];
        own.iter().chain(further).map(|argument| (*argument).to_owned()).collect::<Vec<String>>()
    };
    let same = ["--vary", "seed=1,2"];
    succeeds(&borrowed(&sweep(&place, "1,2", &["--shard", "1/2", "--quiet"])));
    let before = bytes(&place.path("out/sweep.json"));
    let mut other_scene = place.scene.clone();
    other_scene["title"] = json!("another");
    fs::write(place.path("other.json"), other_scene.to_string()).unwrap();
    let other_scene = place.argument("other.json");
    for (scene, further) in [
        (&scene, &["--vary", "seed=1,3"][..]),
        (&scene, &["--vary", "seed=1,2,3"]),
        (&scene, &["--vary", "seed=1,2", "--set", "temperature=2"]),
        (&scene, &["--vary", "seed=1,2", "--steps", "20"]),
        (&scene, &["--vary", "seed=1,2", "--also", "temperature=2"]),
        (&other_scene, &same),
    ] {
        fails(&borrowed(&shard(scene, further)), 5, &["sweep.json` is of another sweep than this shard"]);
        assert!(bytes(&place.path("out/sweep.json")) == before && !place.path("out/seed=2").exists(), "{further:?}");
    }
    succeeds(&borrowed(&shard(&scene, &same)));
    // Nor with what is no sweep.
    for (name, arguments) in [
        ("run", vec!["run", &scene]),
        ("stability", vec!["stability", &scene, "--vary", "time.step=0.01,0.02", "--bisections", "0"]),
    ] {
        let path = place.argument(name);
        succeeds(&[&arguments[..], &["--out", &path, "--quiet"]].concat());
        let before = listing(&place.path(name));
        let arguments = ["sweep", &scene, "--vary", "seed=1,2", "--shard", "1/2", "--out", &path];
        fails(&arguments, 5, &["exists already"]);
        assert_eq!(listing(&place.path(name)), before);
    }
}

#[test]
fn mistakes_in_shards_are_named() {
    let place = place();
    for text in ["0/4", "5/4", "a/b", "3", "", "1/0", "-1/4"] {
        let shard = format!("--shard={text}");
        fails(&borrowed(&sweep(&place, "1,2", &[&shard])), 2, &["from 1/16 to 16/16, or `auto`"]);
    }
    fails(&borrowed(&sweep(&place, "1,2", &["--shard", "1/2", "--force"])), 2, &["--shard", "--force"]);
    fails(&["sweep", "--resume", "out", "--shard", "1/2"], 2, &["--shard", "--resume"]);
    let arguments = sweep(&place, "1,2", &["--shard", "auto"]);
    for (variables, part) in [
        (&[][..], "nothing says which shard this is"),
        (&[("PBS_ARRAY_INDEX", "2")], "--shard $PBS_ARRAY_INDEX/16"),
        (&[("SLURM_ARRAY_TASK_ID", "2")], "not what says of how many"),
        (
            &[("SLURM_ARRAY_TASK_ID", "7"), ("SLURM_ARRAY_TASK_MIN", "1"), ("SLURM_ARRAY_TASK_COUNT", "4")],
            "this array have gaps",
        ),
    ] {
        let output = with(variables, &borrowed(&arguments));
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{message}");
        assert!(message.contains(part), "{message}");
    }
    assert!(!place.path("out").exists());
}

#[test]
fn the_environment_says_which_shard() {
    let place = place();
    let arguments = sweep(&place, "1,2,3,4", &["--shard", "auto", "--quiet"]);
    for (variables, shard) in [
        (
            &[
                ("SLURM_ARRAY_TASK_ID", "5"),
                ("SLURM_ARRAY_TASK_MIN", "5"),
                ("SLURM_ARRAY_TASK_MAX", "6"),
                ("SLURM_ARRAY_TASK_COUNT", "2"),
                // Of the script of the job, which is one copy.
                ("SLURM_PROCID", "0"),
                ("SLURM_NTASKS", "8"),
            ][..],
            "1-of-2",
        ),
        (
            &[
                ("OMPI_COMM_WORLD_RANK", "1"),
                ("OMPI_COMM_WORLD_SIZE", "2"),
                // There may be fewer adapters than copies.
                ("OMPI_COMM_WORLD_LOCAL_RANK", "1"),
            ],
            "2-of-2",
        ),
    ] {
        let output = with(variables, &borrowed(&arguments));
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(place.path("out/shards").join(shard).exists(), "{variables:?}");
    }
    let said = succeeds(&["sweep", "--resume", &place.argument("out")]);
    assert!(said.contains("0 of 4 variants left"), "{said}");
}

/// With MPI they know of each other: `tests/mpi`.
#[cfg(not(feature = "mpi"))]
#[test]
fn copies_that_know_nothing_of_each_other_are_refused() {
    let place = place();
    let copy = [("OMPI_COMM_WORLD_RANK", "0"), ("OMPI_COMM_WORLD_SIZE", "3")];
    let (scene, out) = (place.scene(), place.argument("out"));
    for arguments in [
        &["run", &scene, "--out", &out][..],
        &["sweep", &scene, "--vary", "seed=1,2", "--out", &out],
        &["tradeoff", &scene, "--vary", "time.step=0.01,0.02", "--out", &out],
        &["stability", &scene, "--out", &out],
        &["resume", &out],
        &["plot", &out],
    ] {
        for (variables, name) in [
            (&copy[..], "`OMPI_COMM_WORLD_SIZE` is 3"),
            (&[("PMI_RANK", "1"), ("PMI_SIZE", "2")], "`PMI_SIZE` is 2"),
            (&[("SLURM_PROCID", "0"), ("SLURM_STEP_NUM_TASKS", "4")], "`SLURM_STEP_NUM_TASKS` is 4"),
        ] {
            let output = with(variables, arguments);
            let message = text(&output.stderr);
            assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
            assert!(
                message.contains(name) && message.contains("without MPI") && message.contains("--shard auto"),
                "{message}"
            );
            assert!(!place.path("out").exists());
        }
    }
    // What writes nothing may be one of several, and one copy is alone.
    assert!(with(&copy, &["scenes"]).status.success());
    let alone = [("OMPI_COMM_WORLD_RANK", "0"), ("OMPI_COMM_WORLD_SIZE", "1")];
    let output = with(&alone, &["run", &scene, "--out", &out, "--quiet"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
}

/// A shard that is stopped or killed goes on where it was, and its runs are those that they would have been.
#[cfg(unix)]
#[test]
fn a_shard_that_is_stopped_goes_on() {
    use std::process::Stdio;
    use std::time::{Duration, Instant};

    let place = place().with("/time/steps", json!(10_000)).with("/output/energies/every", json!(20));
    let arguments = sweep(&place, "1,2,3", &["--shard", "1/2", "--jobs", "1", "--quiet"]);
    let table = place.path("out/seed=1").join(files::ENERGIES);
    for (signal, code) in [("-TERM", Some(130)), ("-KILL", None)] {
        let child = command(&borrowed(&arguments)).stderr(Stdio::piped()).spawn().unwrap();
        let begun = Instant::now();
        while !fs::read_to_string(&table).is_ok_and(|table| table.lines().count() > 4) {
            assert!(begun.elapsed() < Duration::from_mins(1), "it does not begin");
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(Command::new("kill").args([signal, &child.id().to_string()]).status().unwrap().success());
        let ended = child.wait_with_output().unwrap();
        let said = text(&ended.stderr);
        assert_eq!(ended.status.code(), code, "{said}");
        if code.is_some() {
            let told = " of 2 variants of shard 1/2; the same command goes on with it\n";
            assert!(said.starts_with("interrupted after ") && said.ends_with(told), "{said}");
        }
    }
    let (_, told) = succeeds_and_tells(&borrowed(&arguments));
    assert!(!told.contains("error"), "{told}");
    succeeds(&["run", &place.scene(), "--set", "seed=1", "--out", &place.argument("alone"), "--quiet"]);
    let [alone, shard] = ["alone", "out/seed=1"].map(|run| bytes(&place.path(run).join(files::ENERGIES)));
    assert!(alone == shard);
    assert_eq!(noted(&place, "1-of-2")["variants"][1]["state"], "finished");
}
