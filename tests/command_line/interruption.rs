//! Signals that ask a run or a sweep to stop: what was computed is kept, and the rest can follow.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use mesoscope::output::{Summary, checkpoint, files, read_table};
use mesoscope::scene::AnalysisId;
use mesoscope::stability::{self, StabilitySummary};
use mesoscope::sweep::{SweepSummary, VariantState};
use mesoscope::tradeoff::{ChoiceState, TradeoffSummary};
use serde_json::json;

use crate::support::program::{Place, assert_same, bytes, command, fails, listing, succeeds, text};

/// A scene of 192 particles.
fn place() -> Place {
    Place::of(json!({
        "title": "small fluid",
        "space": {"box": [4, 4, 4]},
        "time": {"step": 0.03, "steps": 50_000_000, "equilibration": 10},
        "temperature": 1,
        "particles": [{"species": "fluid", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 7},
            "trajectory": {"every": 50},
            "radial_distribution": {"every": 20, "range": 1.5},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    }))
}

/// Starts the program and waits until a table has a few rows.
fn begun(mut command: Command, table: &Path) -> Child {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for(&mut child, || read_table(table).is_ok_and(|table| table.rows.len() > 3));
    child
}

#[track_caller]
fn wait_for(child: &mut Child, mut condition: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !condition() {
        assert!(child.try_wait().unwrap().is_none(), "it has ended by itself");
        assert!(begun.elapsed() < Duration::from_mins(1), "it does not begin");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// Sends signals to a process, one right after the other.
#[track_caller]
fn send(signal: &str, process: &Child, times: usize) {
    let process = process.id().to_string();
    let arguments = [vec![signal], vec![process.as_str(); times]].concat();
    assert!(Command::new("kill").args(arguments).status().unwrap().success());
}

/// Exit code, and what it said on standard error.
fn ended(child: Child) -> (Option<i32>, String) {
    let output = child.wait_with_output().unwrap();
    (output.status.code(), text(&output.stderr).to_owned())
}

/// Starts the program, sends it a signal once a table has a few rows, and returns its exit code and what it says on standard
/// error.
fn interrupted(arguments: &[&str], signal: &str, table: &Path) -> (Option<i32>, String) {
    let child = begun(command(arguments), table);
    send(signal, &child, 1);
    ended(child)
}

/// The program with its arguments, started by a shell after a command of its own.
fn after(preparation: &str, arguments: &[&str]) -> Command {
    let program = command(arguments);
    let mut shell = Command::new("sh");
    shell
        .args(["-c", &format!("{preparation}; exec \"$0\" \"$@\"")])
        .arg(program.get_program())
        .args(program.get_args());
    shell
}

fn step_of(directory: &Path) -> u64 {
    checkpoint::load(&directory.join(files::CHECKPOINT)).unwrap().state.step
}

#[test]
fn an_interrupted_run_goes_on_where_it_was() {
    for signal in ["-INT", "-TERM", "-USR1", "-USR2"] {
        let place = place();
        let (parts, table) = (place.argument("parts"), place.path("parts").join(files::ENERGIES));
        let (code, said) = interrupted(&["run", &place.scene(), "--out", &parts], signal, &table);
        assert_eq!(code, Some(130), "{said}");
        let step = checkpoint::load(&place.path("parts").join(files::CHECKPOINT)).unwrap().state.step;
        assert!(step > 0);
        let told = format!("interrupted at step {step}; `mesoscope resume {parts}` continues it");
        assert!(said.ends_with(&format!("{told}\n")) && !said.contains("error"), "{said}");

        let steps = (step + 35).to_string();
        succeeds(&["resume", &parts, "--steps", &steps, "--quiet"]);
        succeeds(&["run", &place.scene(), "--out", &place.argument("whole"), "--steps", &steps, "--quiet"]);
        for name in [files::ENERGIES, files::CHECKPOINT, files::TRAJECTORY_GSD, AnalysisId::RadialDistribution.table()]
        {
            let [whole, parts] = ["whole", "parts"].map(|run| bytes(&place.path(run).join(name)));
            assert!(whole == parts, "{name} differs after step {step}");
        }
    }
}

#[test]
fn an_interrupted_sweep_goes_on_where_it_was() {
    let place = place().with("/time/steps", json!(2500));
    let (out, table) = (place.argument("out"), place.path("out/seed=1").join(files::ENERGIES));
    let arguments = ["sweep", &place.scene(), "--vary", "seed=1,2,3", "--jobs", "1", "--yes", "--out", &out];
    let (code, said) = interrupted(&arguments, "-INT", &table);
    assert_eq!(code, Some(130), "{said}");
    let states = |place: &Place| {
        SweepSummary::load(&place.path("out")).unwrap().variants.iter().map(|variant| variant.state).collect::<Vec<_>>()
    };
    let finished = states(&place).iter().filter(|state| **state == VariantState::Finished).count();
    assert!(finished < 3 && !states(&place).contains(&VariantState::Failed), "{:?}", states(&place));
    let told =
        format!("interrupted after {finished} of 3 variants; `mesoscope sweep --resume {out}` finishes the sweep\n");
    assert!(said.ends_with(&told) && !said.contains("error"), "{said}");

    succeeds(&["sweep", "--resume", &out, "--quiet"]);
    assert_eq!(states(&place), [VariantState::Finished; 3]);
    // The variant that was under way is the same as if it had not been stopped.
    succeeds(&["run", &place.scene(), "--set", "seed=1", "--out", &place.argument("alone"), "--quiet"]);
    let [alone, swept] = ["alone", "out/seed=1"].map(|run| bytes(&place.path(run).join(files::ENERGIES)));
    assert!(alone == swept);
}

/// A tradeoff that a signal stops keeps what has run, and comes to the table of one that nothing stopped.
#[test]
fn a_signal_stops_a_tradeoff_and_it_goes_on() {
    let place = place().with("/time/steps", json!(3000)).with("/output/trajectory", json!(null));
    let (scene, out) = (place.scene(), place.argument("stopped"));
    let arguments = |out| {
        let vary = ["--vary", "time.step=0.02,0.03", "--measure", "pressure", "--jobs", "1", "--out", out];
        [vec!["tradeoff", &scene], vary.to_vec()].concat()
    };
    let table = place.path("stopped/step=0.02").join(files::ENERGIES);
    let (code, said) = interrupted(&arguments(&out), "-TERM", &table);
    assert_eq!(code, Some(130), "{said}");
    let told = format!("`mesoscope tradeoff --resume {out}` goes on\n");
    assert!(said.ends_with(&told) && said.contains("interrupted") && !said.contains("error"), "{said}");
    let waiting = TradeoffSummary::load(&place.path("stopped")).unwrap().choices;
    assert!(waiting.iter().any(|choice| choice.state == ChoiceState::Waiting), "{waiting:?}");
    succeeds(&["tradeoff", "--resume", &out, "--quiet"]);
    succeeds(&arguments(&place.argument("whole")));
    let measured = |name: &str| {
        let choices = TradeoffSummary::load(&place.path(name)).unwrap().choices;
        choices.into_iter().map(|choice| (choice.steps, choice.measured)).collect::<Vec<_>>()
    };
    assert_eq!(measured("stopped"), measured("whole"));
}

/// So does a map of stability: what a signal cuts short is made again, the rest is kept.
#[test]
fn a_signal_stops_a_map_and_it_goes_on() {
    let place = place().with("/time/steps", json!(4000)).with("/output/trajectory", json!(null));
    let place = place.with("/output/radial_distribution", json!(null));
    let scene = place.scene();
    let tables: Vec<Vec<u8>> = ["-INT", "whole"]
        .into_iter()
        .map(|signal| {
            let (out, directory) = (place.argument(signal), place.path(signal));
            let vary = ["--vary", "time.step=0.005..0.02/3", "--bisections", "0", "--jobs", "1", "--out", &out];
            let arguments = [&["stability", &scene][..], &vary].concat();
            if signal == "whole" {
                succeeds(&arguments);
                return bytes(&directory.join(stability::files::TABLE));
            }
            let mut child = command(&arguments).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
            let cells = || StabilitySummary::load(&directory).map_or(0, |map| map.rows[0].cells.len());
            wait_for(&mut child, || cells() > 0);
            send(signal, &child, 1);
            let (code, said) = ended(child);
            assert_eq!(code, Some(130), "{said}");
            let told = format!("`mesoscope stability --resume {out}` goes on\n");
            assert!(said.ends_with(&told) && said.contains("interrupted") && !said.contains("error"), "{said}");
            assert!((1..3).contains(&cells()), "{}", cells());
            succeeds(&["stability", "--resume", &out, "--quiet"]);
            bytes(&directory.join(stability::files::TABLE))
        })
        .collect();
    assert!(tables[0] == tables[1]);
}

/// Two signals within moments are one request, as those of `timeout` and of batch systems; a terminal that is closed asks
/// too, unless the program was started to outlive it.
#[test]
fn repeated_requests_and_closed_terminals_save_a_checkpoint() {
    let place = place();
    let (out, table) = (place.argument("out"), place.path("out").join(files::ENERGIES));
    let scene = place.scene();
    let run = ["run", &scene, "--out", &out, "--force", "--quiet"];
    let stopped = |child: Child| {
        let (code, said) = ended(child);
        let step = step_of(&place.path("out"));
        assert!(code == Some(130) && step > 0, "{code:?} {said}");
        assert!(said.contains(&format!("interrupted at step {step}")), "{said}");
        fs::remove_file(&table).unwrap();
    };
    for _ in 0..3 {
        let child = begun(command(&run), &table);
        send("-TERM", &child, 2);
        stopped(child);
    }
    // Who ignores it here cannot have it attended to there.
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:")).map_or("0", str::trim);
    if u64::from_str_radix(ignored, 16).unwrap() & 1 == 0 {
        let child = begun(command(&run), &table);
        send("-HUP", &child, 1);
        stopped(child);
    }
    let mut child = begun(after("trap '' HUP", &run), &table);
    send("-HUP", &child, 1);
    let rows = || fs::read(&table).map_or(0, |bytes| bytes.split(|byte| *byte == b'\n').count());
    let before = rows();
    wait_for(&mut child, || rows() > before + 100);
    send("-TERM", &child, 1);
    stopped(child);
}

/// Before there is something to save a run ends at once, whatever it is doing.
#[test]
fn an_interrupt_before_the_first_step_leaves_nothing() {
    let place = place().with("/space/box", json!([20, 20, 20]));
    let (out, scene) = (place.argument("out"), place.scene());
    let mut child = command(&["run", &scene, "--out", &out]);
    let mut child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for(&mut child, || place.path("out").join(files::LOCK).exists());
    send("-INT", &child, 1);
    let (code, said) = ended(child);
    assert!(code == Some(130) && said.ends_with("interrupted before its first step: nothing was written\n"), "{said}");
    assert_eq!(listing(&place.path("out")), [files::LOCK]);
    succeeds(&["run", &scene, "--out", &out, "--quiet", "--set", "space.box=[4,4,4]", "--steps", "20"]);
}

/// Who insists does not wait: a second interrupt from the keyboard, or anything a second later.
#[test]
#[ignore = "a large system, which takes seconds to set up"]
fn a_second_interrupt_ends_a_run_at_once() {
    // Four million particles: a step takes longer than both interrupts.
    let place = place().with("/space/box", json!([110, 110, 110]));
    for (signal, pause) in [("-INT", Duration::from_millis(50)), ("-TERM", Duration::from_millis(1100))] {
        let (out, scene) = (place.argument(signal), place.scene());
        let mut child = command(&["run", &scene, "--out", &out]);
        let mut child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        wait_for(&mut child, || place.path(signal).join(files::CHECKPOINT).exists());
        // A run that has not begun its first step ends before it by itself.
        std::thread::sleep(Duration::from_secs(1));
        send(signal, &child, 1);
        std::thread::sleep(pause);
        send(signal, &child, 1);
        let (code, said) = ended(child);
        assert!(code == Some(130) && !said.contains("interrupted at step"), "{said}");
        // The lock of a process that is gone locks nothing.
        let left = listing(&place.path(signal));
        assert!(left.contains(&files::LOCK.to_owned()), "{left:?}");
        succeeds(&["run", &scene, "--out", &out, "--force", "--quiet", "--set", "space.box=[4,4,4]", "--steps", "20"]);
    }
}

/// While a run is under way nothing else touches its directory, and the run is none the worse.
#[test]
fn one_directory_belongs_to_one_process() {
    let place = place();
    let (out, table) = (place.argument("out"), place.path("out").join(files::ENERGIES));
    let scene = place.scene();
    let child = begun(command(&["run", &scene, "--out", &out, "--quiet"]), &table);
    let holder = format!("out` is in use by process {}", child.id());
    for arguments in [
        &["resume", &out][..],
        &["run", &scene, "--out", &out],
        &["run", &scene, "--out", &out, "--force"],
        &["plot", &out],
        &["sweep", &scene, "--vary", "seed=1,2", "--yes", "--out", &out, "--force"],
    ] {
        fails(arguments, 5, &[&holder]);
    }
    send("-INT", &child, 1);
    let (code, said) = ended(child);
    assert_eq!(code, Some(130), "{said}");
    assert!(!listing(&place.path("out")).contains(&files::LOCK.to_owned()));
    let steps = (step_of(&place.path("out")) + 21).to_string();
    succeeds(&["resume", &out, "--steps", &steps, "--quiet"]);
    succeeds(&["run", &scene, "--out", &place.argument("alone"), "--steps", &steps, "--quiet"]);
    for name in [files::ENERGIES, files::TRAJECTORY_GSD] {
        let [alone, disturbed] = ["alone", "out"].map(|run| bytes(&place.path(run).join(name)));
        assert!(alone == disturbed, "{name} differs");
    }

    // A sweep, and the runs in it.
    let (out, table) = (place.argument("swept"), place.path("swept/seed=1").join(files::ENERGIES));
    let child = begun(command(&["sweep", &scene, "--vary", "seed=1,2", "--jobs", "1", "--yes", "--out", &out]), &table);
    let variant = format!("{out}/seed=1");
    for arguments in [&["sweep", "--resume", &out][..], &["plot", &out], &["resume", &variant]] {
        fails(arguments, 5, &["is in use by process", &child.id().to_string()]);
    }
    send("-KILL", &child, 1);
    ended(child);
    // The lock of a process that is gone locks nothing.
    succeeds(&["resume", &variant, "--steps", &(step_of(Path::new(&variant)) + 21).to_string(), "--quiet"]);
}

#[test]
fn a_table_that_vanishes_under_way_is_an_error_at_the_end() {
    let place = place().with("/time/steps", json!(6000));
    let (out, table) = (place.argument("out"), place.path("out").join(files::ENERGIES));
    let child = begun(command(&["run", &place.scene(), "--out", &out, "--quiet"]), &table);
    // It must not end before the file is gone.
    send("-STOP", &child, 1);
    fs::remove_file(&table).unwrap();
    send("-CONT", &child, 1);
    let (code, said) = ended(child);
    assert!(code == Some(5) && said.contains("energies.csv` is not complete: it was removed"), "{code:?} {said}");
    // What was measured is not lost with it.
    assert_eq!(place.summary("out").steps, 6000);
    fails(&["resume", &out], 5, &["cannot continue", "energies.csv"]);
}

/// Other files of the run are looked for too: a trajectory that another file replaces, and pictures.
#[test]
fn files_that_vanish_under_way_are_errors_at_the_end() {
    let place = place().with("/time/steps", json!(3000)).with("/output/snapshot/every", json!(500));
    let scene = place.scene();
    for (name, problem) in [
        (files::TRAJECTORY_GSD, "it was removed"),
        (files::TRAJECTORY_GSD, "another file took its place"),
        ("snapshot-000001.png", "it was removed"),
    ] {
        let (out, path) = (place.argument("out"), place.path("out"));
        let child = begun(command(&["run", &scene, "--out", &out, "--quiet"]), &path.join(files::ENERGIES));
        send("-STOP", &child, 1);
        fs::remove_file(path.join(name)).unwrap();
        if problem.starts_with("another") {
            fs::write(path.join(name), "mine").unwrap();
        }
        send("-CONT", &child, 1);
        let (code, said) = ended(child);
        assert!(code == Some(5) && said.contains(&format!("{name}` is not complete: {problem}")), "{code:?} {said}");
        assert!(!said.contains("continues from"), "{said}");
        assert_eq!(place.summary("out").steps, 3000);
        assert!(path.join(files::ENERGIES_PLOT).exists());
        fs::remove_dir_all(path).unwrap();
    }
}

/// A run that was finished, continued and stopped again is neither drawn as finished nor called damaged, and a sweep that
/// it belongs to leaves it alone.
#[test]
fn runs_that_were_continued_are_left_as_they_are() {
    let place = place().with("/time/steps", json!(30));
    let (scene, out) = (place.scene(), place.argument("out"));
    succeeds(&["sweep", &scene, "--vary", "seed=1,2", "--out", &out, "--quiet"]);
    let (variant, path) = (format!("{out}/seed=1"), place.path("out/seed=1"));
    let rows = text(&bytes(&path.join(files::ENERGIES))).lines().count();
    let mut child = { command(&["resume", &variant, "--steps", "50000000", "--quiet"]) };
    let mut child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for(&mut child, || read_table(&path.join(files::ENERGIES)).is_ok_and(|table| table.rows.len() > rows + 5));
    send("-TERM", &child, 1);
    assert_eq!(ended(child).0, Some(130));
    let before: Vec<_> = listing(&path).into_iter().map(|name| bytes(&path.join(name))).collect();
    fails(&["plot", &variant], 5, &["was continued beyond step 30", "mesoscope resume"]);
    fails(&["sweep", "--resume", &out], 5, &["`seed=1`", "was continued beyond step 30"]);
    let after: Vec<_> = listing(&path).into_iter().map(|name| bytes(&path.join(name))).collect();
    assert!(before == after);
}

/// One that was killed before it saved anything goes on from what was finished.
#[test]
fn a_continued_run_that_saved_nothing_goes_back_to_its_end() {
    let place = place().with("/time/steps", json!(30));
    let (scene, out) = (place.scene(), place.argument("out"));
    succeeds(&["sweep", &scene, "--vary", "seed=1,2", "--out", &out, "--quiet"]);
    let (variant, path) = (format!("{out}/seed=2"), place.path("out/seed=2"));
    let table = bytes(&path.join(files::ENERGIES));
    let mut child = { command(&["resume", &variant, "--steps", "50000000", "--quiet"]) };
    let mut child = child.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
    wait_for(&mut child, || bytes(&path.join(files::ENERGIES)).len() > table.len() + 500);
    send("-KILL", &child, 1);
    ended(child);
    fails(&["plot", &variant], 5, &["was continued beyond step 30"]);
    succeeds(&["sweep", "--resume", &out, "--quiet"]);
    assert!(bytes(&path.join(files::ENERGIES)) == table);
    succeeds(&["plot", &variant]);
}

/// A checkpoint that cannot be read is a reason to ask, not to begin again.
#[test]
fn a_sweep_does_not_replace_what_it_cannot_read() {
    let place = place().with("/time/steps", json!(30));
    let (scene, out) = (place.scene(), place.argument("out"));
    succeeds(&["sweep", &scene, "--vary", "seed=1,2", "--out", &out, "--quiet"]);
    let path = place.path("out/seed=2");
    fs::remove_file(path.join(files::ENERGIES_PLOT)).unwrap();
    let mut damaged = bytes(&path.join(files::CHECKPOINT));
    damaged[100] ^= 1;
    fs::write(path.join(files::CHECKPOINT), &damaged).unwrap();
    let table = bytes(&path.join(files::ENERGIES));
    fails(&["sweep", "--resume", &out], 5, &["`seed=2`", "damaged", "once its directory is removed"]);
    assert!(bytes(&path.join(files::ENERGIES)) == table && bytes(&path.join(files::CHECKPOINT)) == damaged);
    fs::remove_dir_all(&path).unwrap();
    succeeds(&["sweep", "--resume", &out, "--quiet"]);
}

/// Whatever is missing at the end of a run is completed, and nothing half-written stays.
#[test]
fn resume_completes_what_is_missing() {
    let place = place().with("/time/steps", json!(100)).without("/output/trajectory");
    let place = place.with("/output/snapshot", json!({"width": 600, "height": 500}));
    let (scene, whole) = (place.scene(), place.path("whole"));
    succeeds(&["run", &scene, "--out", &place.argument("whole"), "--quiet"]);
    let out = place.path("out");
    let resume = ["resume", &place.argument("out"), "--quiet"];

    // A disk on which tables have room and pictures have not, at the last snapshot or at the first plot. SwiftShader keeps its code in
    // files and is killed under such a limit, by whatever makes a kernel, also where nothing is written.
    let limited = "trap '' XFSZ; ulimit -f 24";
    let output = |mut command: Command| ended(command.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap());
    let driver_works = output(after(limited, &["check", &scene])).0.is_some();
    let ranks = ["--set", "space.box=[4,4,16]", "--set", "particles.0.number_density=0.75", "--ranks", "2"];
    for (number, further) in [&["--set", "output.snapshot.width=64"][..], &[], &ranks].into_iter().enumerate() {
        let out = place.argument(&format!("full{number}"));
        let run = [&["run", &scene, "--out", &out, "--quiet"], further].concat();
        if !driver_works {
            continue;
        }
        let (code, said) = output(after(limited, &run));
        assert_eq!(code, Some(5), "{said}");
        assert!(
            said.contains(".png`: File too large") && said.contains("the last good checkpoint, of step 100"),
            "{said}"
        );
        succeeds(&["resume", &out, "--quiet"]);
        if further.is_empty() {
            assert_same(Path::new(&out), &whole);
        }
        assert!(succeeds(&["resume", &out]).contains("nothing to do"));
    }

    succeeds(&["run", &scene, "--out", &place.argument("out"), "--quiet"]);
    for name in listing(&whole).iter().filter(|name| *name != files::CHECKPOINT && *name != files::ENERGIES) {
        fs::remove_file(out.join(name)).unwrap();
        fs::write(out.join(files::temporary(name.as_ref(), 4711, 1)), "half").unwrap();
        succeeds(&resume);
        assert_same(&out, &whole);
        if name != files::SUMMARY {
            let found = Summary::load(&out.join(files::SUMMARY)).unwrap();
            assert!(found.wall_seconds > 0.0, "the steps took time, which is noted");
        }
    }
    // Stopped while it finished: the numbers are there, and no plot.
    let mut unfinished = Summary::load(&out.join(files::SUMMARY)).unwrap();
    unfinished.files = None;
    unfinished.save(&out.join(files::SUMMARY)).unwrap();
    fs::remove_file(out.join(files::ENERGIES_PLOT)).unwrap();
    succeeds(&resume);
    assert_same(&out, &whole);

    // The same in a sweep.
    let swept = place.argument("swept");
    succeeds(&["sweep", &scene, "--vary", "seed=1,2", "--out", &swept, "--quiet"]);
    let missing = ["seed=1/energies.png", "seed=2/snapshot.png", "seed=2/run.json", "sweep-pressure.png", "sweep.csv"];
    let kept = missing.map(|name| bytes(&place.path("swept").join(name)));
    for name in missing {
        fs::remove_file(place.path("swept").join(name)).unwrap();
    }
    let stale = ["seed=1", ""].map(|run| place.path("swept").join(run).join("run.json.mesoscope-1-1.tmp"));
    for path in &stale {
        fs::write(path, "half").unwrap();
    }
    succeeds(&["sweep", "--resume", &swept, "--quiet"]);
    assert!(stale.iter().all(|path| !path.exists()));
    for (name, kept) in missing.iter().zip(&kept).filter(|(name, _)| name.ends_with("png")) {
        assert!(bytes(&place.path("swept").join(name)) == *kept, "{name}");
    }
    assert!(missing.iter().all(|name| place.path("swept").join(name).exists()));
}

/// An interrupt that comes while tables and plots are made is obeyed, and the rest can follow.
#[test]
fn an_interrupt_while_finishing_is_obeyed() {
    let place = place().with("/time/steps", json!(60)).with("/output/plot", json!({"width": 4000, "height": 3000}));
    succeeds(&["run", &place.scene(), "--out", &place.argument("whole"), "--quiet"]);
    let (out, path) = (place.argument("out"), place.path("out"));
    let mut caught = 0;
    for _ in 0..12 {
        // A snapshot of the turn before would be there at once.
        let _ = fs::remove_dir_all(&path);
        let run = command(&["run", &place.scene(), "--out", &out, "--quiet"]);
        let mut child = { run }.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap();
        wait_for(&mut child, || path.join(files::SNAPSHOT).exists());
        send("-TERM", &child, 1);
        let (code, said) = ended(child);
        if code == Some(0) {
            continue;
        }
        caught += 1;
        assert!(code == Some(130) && said.contains("interrupted at step 60"), "{code:?} {said}");
        assert!(!path.join(AnalysisId::RadialDistribution.tables()[0].plot).exists());
        succeeds(&["resume", &out, "--quiet"]);
        assert_same(&path, &place.path("whole"));
        break;
    }
    assert!(caught > 0, "the run was always faster");
}

/// Files of another seed or scene are not taken for those of a run.
#[test]
fn files_of_different_runs_are_not_mixed() {
    let place = place().with("/time/steps", json!(50)).with("/output/checkpoint", json!({"every": 30}));
    let scene = place.scene();
    let run = |out: &str, set: &str| {
        succeeds(&["run", &scene, "--out", &place.argument(out), "--quiet", "--set", set]);
    };
    run("one", "seed=1");
    for (other, set) in [("seed", "seed=2"), ("scene", "interactions.0.friction=4.4")] {
        run(other, set);
        for name in [files::CHECKPOINT, files::SUMMARY] {
            let kept = bytes(&place.path("one").join(name));
            fs::copy(place.path(other).join(name), place.path("one").join(name)).unwrap();
            for arguments in [&["resume", "--steps", "90"][..], &["resume"], &["plot"]] {
                let one = place.argument("one");
                fails(
                    &[arguments, &[one.as_str()]].concat(),
                    5,
                    &["run.json` belongs to another run than `checkpoint.bin`"],
                );
            }
            fs::write(place.path("one").join(name), kept).unwrap();
        }
        // Without a summary it is the trajectory or a picture that does not belong to the checkpoint, or the table.
        let mixed = place.path("mixed");
        let files = [files::CHECKPOINT, files::ENERGIES, files::TRAJECTORY_GSD, files::SNAPSHOT];
        for (foreign, problem) in [
            (files::ENERGIES, "is not what the run wrote"),
            (files::TRAJECTORY_GSD, "belongs to another run than `checkpoint.bin`"),
            (files::SNAPSHOT, "belongs to another run than `checkpoint.bin`"),
        ] {
            fs::create_dir_all(&mixed).unwrap();
            for name in files {
                let from = if name == foreign { "one" } else { other };
                fs::copy(place.path(from).join(name), mixed.join(name)).unwrap();
            }
            let told = format!("{foreign}` {problem}");
            fails(&["resume", &place.argument("mixed"), "--steps", "90"], 5, &[&told]);
        }
    }
    assert!(succeeds(&["resume", &place.argument("one")]).contains("nothing to do"));
}

/// Nor are those of the variants of a sweep, nor of sweeps.
#[test]
fn files_of_different_sweeps_are_not_mixed() {
    let place = place().with("/time/steps", json!(30));
    let (scene, out, swept) = (place.scene(), place.argument("out"), place.path("out"));
    let sweep = |out: &str, vary: &str| {
        succeeds(&["sweep", &scene, "--vary", vary, "--plot", "temperature", "--out", out, "--quiet"]);
    };
    sweep(&out, "seed=1,2");
    sweep(&place.argument("other"), "seed=1,3");
    let resume = ["sweep", "--resume", &out];
    let variant = swept.join("seed=2");
    // A file of one variant in the place of that of the other.
    let foreign = |name: &str| fs::copy(swept.join("seed=1").join(name), variant.join(name)).unwrap();
    for name in [files::SUMMARY, files::CHECKPOINT, files::TRAJECTORY_GSD, files::ENERGIES_PLOT] {
        let kept = bytes(&variant.join(name));
        foreign(name);
        let told = format!("{name}` belongs to another run than `sweep.json`");
        fails(&["plot", &out], 5, &[&told]);
        fails(&resume, 5, &["`seed=2`", &told]);
        // The same before the first checkpoint of the variant, where there is nothing to resume.
        let saved = bytes(&variant.join(files::CHECKPOINT));
        if name != files::CHECKPOINT {
            fs::remove_file(variant.join(files::CHECKPOINT)).unwrap();
            fails(&resume, 5, &["`seed=2`", &told]);
            fs::write(variant.join(files::CHECKPOINT), saved).unwrap();
        }
        assert!(bytes(&variant.join(name)) == bytes(&swept.join("seed=1").join(name)), "{name} was replaced");
        fs::write(variant.join(name), kept).unwrap();
        succeeds(&resume);
    }
    let kept = bytes(&variant.join(files::ENERGIES));
    foreign(files::ENERGIES);
    fails(&["plot", &out], 5, &["energies.csv` is not what the run wrote"]);
    fails(&resume, 5, &["energies.csv` is not what the run wrote"]);
    fs::write(variant.join(files::ENERGIES), kept).unwrap();

    // A plot of another sweep; a summary that speaks of other runs.
    let plot = swept.join("sweep-temperature.png");
    let kept = bytes(&plot);
    fs::copy(place.path("other").join("sweep-temperature.png"), &plot).unwrap();
    for arguments in [&resume[..], &["plot", &out]] {
        fails(arguments, 5, &["sweep-temperature.png` belongs to another sweep than `sweep.json`"]);
    }
    fs::write(&plot, kept).unwrap();
    let summary = swept.join(mesoscope::sweep::files::SUMMARY);
    let kept = text(&bytes(&summary)).to_owned();
    let found = SweepSummary::load(&swept).unwrap();
    let other = SweepSummary::load(&place.path("other")).unwrap();
    for (old, new) in [
        ("\"temperature\": 1,".to_owned(), "\"temperature\": 2,".to_owned()),
        (found.sweep_id.to_string(), other.sweep_id.to_string()),
        (found.variants[1].run_id.to_string(), other.variants[1].run_id.to_string()),
    ] {
        assert!(kept.contains(&old), "{old}");
        fs::write(&summary, kept.replacen(&old, &new, 1)).unwrap();
        for arguments in [&resume[..], &["plot", &out]] {
            fails(arguments, 5, &["sweep.json` was changed: it describes other runs"]);
        }
    }
    fs::write(&summary, &kept).unwrap();
    succeeds(&resume);
    succeeds(&["plot", &out]);
}
