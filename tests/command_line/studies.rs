//! What sweeps, tradeoffs and maps of stability have in common: their files, what goes on with them, and what is refused.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use mesoscope::gpu::AdapterChoice;
use mesoscope::output::{Id, Summary};
use mesoscope::stability::{Request, StabilityRun, StabilitySummary};
use mesoscope::study::StudyEvent;
use serde_json::{Value, json};

use crate::support::program::{Place, bytes, command, fails, listing, succeeds, text};

/// A fluid of 64 particles that start from `start.xyz`.
fn place() -> Place {
    let place = Place::of(json!({
        "title": "small fluid",
        "time": {"step": 0.02, "steps": 20},
        "temperature": 1,
        "state": {"file": "start.xyz"},
        "particles": [{"species": "A"}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {
            "energies": {"every": 2},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    }));
    write_start(&place, 0.5);
    place
}

/// A lattice of 64 particles in a box of edge 4, whose corner is so far from that of the box.
fn write_start(place: &Place, corner: f64) {
    let mut file = "64\nLattice=\"4 0 0 0 4 0 0 0 4\" Properties=species:S:1:pos:R:3:velo:R:3\n".to_owned();
    for site in 0..64_u32 {
        let at = [site % 4, site / 4 % 4, site / 16].map(|index| f64::from(index) + corner);
        writeln!(file, "A {} {} {} 0 0 0", at[0], at[1], at[2]).unwrap();
    }
    fs::write(place.path("start.xyz"), file).unwrap();
}

/// The program in a directory.
#[track_caller]
fn succeeds_in(directory: &Path, arguments: &[&str]) -> String {
    let output = command(arguments).current_dir(directory).output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", text(&output.stderr));
    text(&output.stdout).to_owned()
}

/// A tiny study of a kind.
fn study<'a>(command: &'a str, further: &[&'a str]) -> Vec<&'a str> {
    let own = match command {
        "sweep" => &["--vary", "seed=1,2"][..],
        "tradeoff" => &["--vary", "time.step=0.02", "--measure", "temperature"],
        _ => &["--vary", "time.step=0.01,0.02", "--bisections", "0"],
    };
    [&[command, "scene.json", "--quiet"], own, further].concat()
}

#[test]
fn studies_find_the_file_of_their_state_from_anywhere_as_long_as_it_is_the_same() {
    let place = place();
    place.scene();
    let (here, elsewhere) = (place.path(""), tempfile::tempdir().unwrap());
    for command in ["sweep", "tradeoff", "stability"] {
        succeeds_in(&here, &study(command, &["--out", command]));
    }
    fs::remove_dir_all(place.path("sweep/seed=2")).unwrap();
    for command in ["sweep", "tradeoff", "stability"] {
        succeeds_in(elsewhere.path(), &[command, "--resume", &place.argument(command), "--quiet"]);
    }
    assert!(place.path("sweep/seed=2/run.json").exists());
    succeeds_in(elsewhere.path(), &["plot", &place.argument("sweep")]);
    write_start(&place, 0.25);
    let parts = ["start.xyz` is not what it was", "the checksum of its particles was "];
    for command in ["sweep", "tradeoff", "stability"] {
        let message = fails(&[command, "--resume", &place.argument(command)], 5, &parts);
        assert!(!message.contains("was changed"), "{message}");
    }
    fails(&["plot", &place.argument("sweep")], 5, &parts);
    fs::remove_file(place.path("start.xyz")).unwrap();
    fails(&["sweep", "--resume", &place.argument("sweep")], 5, &["start.xyz` is not what it was", "No such file"]);
}

/// A file that changes while a map is made ends the map: its runs are not those of two systems, and a file that is gone is not
/// taken for a scene that is refused.
#[test]
fn a_map_has_one_start() {
    let place = place();
    let vary = ["time.step=0.01,0.02,0.03".to_owned()];
    for change in
        [|place: &Place| write_start(place, 0.25), |place: &Place| drop(fs::remove_file(place.path("start.xyz")))]
    {
        write_start(&place, 0.5);
        let request = Request::load(&place.scene(), &[], None, &vary).unwrap().with_bisections(0);
        let run = StabilityRun::replace(request, place.path("out")).with_jobs(Some(1));
        // The second run may have begun by then, the third has not.
        let ended = run.execute(&AdapterChoice::Best, &mut |event| {
            if let StudyEvent::Ended { .. } = event {
                change(&place);
            }
        });
        let message = ended.unwrap_err().to_string();
        assert!(message.contains("start.xyz` is not what it was"), "{message}");
        assert!(StabilitySummary::load(&place.path("out")).unwrap().rows[0].cells.len() < 3);
    }
    // Files that rows name are kept in mind, too.
    write_start(&place, 0.5);
    fs::copy(place.path("start.xyz"), place.path("other.xyz")).unwrap();
    let vary = [r"state.file=start.xyz,other.xyz".to_owned(), vary[0].clone()];
    let request = Request::load(&place.scene(), &[], None, &vary).unwrap().with_bisections(0);
    fs::remove_file(place.path("other.xyz")).unwrap();
    let run = StabilityRun::replace(request, place.path("out")).with_jobs(Some(1));
    let message = run.execute(&AdapterChoice::Best, &mut |_| {}).unwrap_err().to_string();
    assert!(message.contains("other.xyz` is not what it was"), "{message}");
}

/// The summary of a study.
fn read(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

/// Changes the summary of a study.
fn edit(path: &Path, change: impl Fn(&mut Value)) {
    let mut summary = read(path);
    change(&mut summary);
    fs::write(path, summary.to_string()).unwrap();
}

/// A study whose ids another version made, of whose scenes it knew other keys, goes on with these ids; and whatever the version, what
/// it was asked for is what it goes on with.
#[test]
fn a_study_of_an_earlier_version_goes_on_as_it_is() {
    let place = place();
    place.scene();
    let here = place.path("");
    // One run of each kind: its lists of runs, and what of its request to edit.
    for (command, lists, asked) in [
        ("sweep", &["variants"][..], "/set"),
        ("tradeoff", &["choices", "finer"], "/arguments/set"),
        ("stability", &[], "/arguments/set"),
    ] {
        succeeds_in(&here, &study(command, &["--out", command]));
        let (out, resume) = (place.path(command), [command, "--resume", &place.argument(command), "--quiet"]);
        let path = out.join(format!("{command}.json"));
        let mut runs = Vec::new();
        for run in lists.iter().flat_map(|list| read(&path)[list].as_array().unwrap().clone()) {
            runs.push(run["name"].as_str().unwrap().to_owned());
        }
        // Nothing has run yet, and the ids are others.
        let id = |number: usize| format!("r{number:016x}");
        let of_study = Id::of_sweep((0..runs.len()).map(|number| Id::parse(&id(number)).unwrap()));
        edit(&path, |summary| {
            summary["mesoscope_version"] = json!("0.0.1");
            summary[format!("{command}_id")] = json!(of_study.to_string());
            let mut number = 0;
            for list in lists {
                for run in summary[list].as_array_mut().unwrap() {
                    (run["run_id"], run["state"]) = (json!(id(number)), json!("waiting"));
                    number += 1;
                }
            }
            if command == "stability" {
                summary["rows"][0]["cells"] = json!([]);
            }
        });
        for name in listing(&out) {
            if Path::new(&name).extension().is_some_and(|extension| extension == "png") {
                fs::remove_file(out.join(name)).unwrap();
            } else if out.join(&name).is_dir() {
                fs::remove_dir_all(out.join(name)).unwrap();
            }
        }
        let before = read(&path);
        // Twice: the first time writes everything anew.
        for time in ["first", "second"] {
            succeeds(&resume);
            let after = read(&path);
            for key in [format!("{command}_id"), "mesoscope_version".to_owned(), "request_checksum".to_owned()] {
                assert_eq!(after[&key], before[&key], "{command}, {key}, {time}");
            }
            for (number, name) in runs.iter().enumerate() {
                // One that references are taken from may be a choice, too.
                if runs[..number].contains(name) {
                    continue;
                }
                let run = Summary::load(&out.join(name).join("run.json")).unwrap();
                assert_eq!(run.run_id.to_string(), id(number), "{command}, {name}, {time}");
            }
        }
        edit(&path, |summary| *summary.pointer_mut(asked).unwrap() = json!(["temperature=2"]));
        fails(&resume, 5, &["was changed: it asks for something else"]);
        edit(&path, |summary| *summary.pointer_mut(asked).unwrap() = json!(["temperature=hot"]));
        fails(&resume, 5, &["was changed: it asks for something else"]);
    }
}

/// What laws say of a row is computed when a map is begun or goes on, and not from a file that has changed.
#[test]
fn laws_are_those_of_the_state_that_was_read() {
    let mut place = place();
    place.scene["interactions"] = json!([{"type": "tether", "stiffness": 16}]);
    place.scene["integrator"] = json!({"type": "cotter-reich"});
    let vary = ["time.step=0.1,0.2,0.8".to_owned()];
    let request = || Request::load(&place.scene(), &[], None, &vary).unwrap().with_bisections(0);
    let early = request();
    write_start(&place, 0.25);
    let run = StabilityRun::start(early, place.path("out"));
    let message = run.execute(&AdapterChoice::Best, &mut |_| {}).unwrap_err().to_string();
    assert!(message.contains("start.xyz` is not what it was"), "{message}");
    assert!(!place.path("out").exists(), "a row without laws was left");
    let map = StabilityRun::start(request(), place.path("out")).execute(&AdapterChoice::Best, &mut |_| {});
    let bounds = map.unwrap().summary.rows[0].bounds.clone();
    assert_eq!(bounds.len(), 1, "{bounds:?}");
    // One that lacks them is completed.
    edit(&place.path("out/stability.json"), |summary| summary["rows"][0]["bounds"] = json!([]));
    let map = StabilityRun::resume(place.path("out")).unwrap().execute(&AdapterChoice::Best, &mut |_| {});
    assert_eq!(map.unwrap().summary.rows[0].bounds, bounds);
}

#[test]
fn a_study_replaces_one_of_another_kind_only_when_asked_and_wholly() {
    let place = place();
    place.scene();
    let (here, out) = (place.path(""), place.path("out"));
    let refused = |arguments: &[&str], parts: &[&str]| {
        let output = command(arguments).current_dir(&here).output().unwrap();
        let message = text(&output.stderr).to_owned();
        assert_eq!(output.status.code(), Some(5), "{message}");
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    };
    succeeds_in(&here, &study("sweep", &["--out", "out", "--plot", "temperature"]));
    fs::write(out.join("notes.md"), "mine").unwrap();
    let before = listing(&out);
    for next in ["stability", "tradeoff"] {
        // What goes on is what is there.
        let goes_on = "`mesoscope sweep --resume out` goes on with an interrupted sweep";
        refused(&study(next, &["--out", "out"]), &["exists already", "--force", goes_on]);
        assert_eq!(listing(&out), before, "{next}");
        let goes_on = "it holds a sweep, and `mesoscope sweep --resume out` finishes the sweep";
        refused(&[next, "--resume", "out"], &["there is no ", goes_on]);
    }
    for (next, expected) in [
        ("tradeoff", &["finer", "notes.md", "step=0.02", "tradeoff-temperature.png"][..]),
        ("stability", &["notes.md", "stability.csv", "stability.json", "stability.md", "stability.png"]),
        ("sweep", &["notes.md", "seed=1", "seed=2", "sweep-averages.csv"]),
    ] {
        succeeds_in(&here, &study(next, &["--out", "out", "--force"]));
        let found = listing(&out);
        let goes_on = format!("`mesoscope {next} --resume {}`", place.argument("out"));
        fails(&["resume", &place.argument("out")], 2, &["not a run", &goes_on]);
        if next != "sweep" {
            // The same pictures again, and with another look other ones.
            let picture =
                expected.iter().find(|name| Path::new(name).extension().is_some_and(|end| end == "png")).unwrap();
            let before = bytes(&out.join(picture));
            fs::remove_file(out.join(picture)).unwrap();
            assert!(succeeds(&["plot", &place.argument("out")]).contains(picture));
            assert!(bytes(&out.join(picture)) == before, "{picture}");
            succeeds(&["plot", &place.argument("out"), "--set", "output.plot.theme=dark"]);
            assert!(bytes(&out.join(picture)) != before, "{picture}");
        }
        assert!(expected.iter().all(|name| found.iter().any(|own| own == name)), "{next}: {found:?}");
        let others = ["sweep", "tradeoff", "stability", "seed=", "step="].into_iter().filter(|start| match next {
            "sweep" => !["sweep", "seed="].contains(start),
            "tradeoff" => !["tradeoff", "step="].contains(start),
            _ => *start != "stability",
        });
        for start in others {
            assert!(!found.iter().any(|name| name.starts_with(start)), "{next}: {found:?}");
        }
    }
    // A file that has the name of a run's directory is the user's.
    fs::remove_dir_all(out.join("seed=2")).unwrap();
    fs::write(out.join("seed=2"), "mine").unwrap();
    let before = listing(&out);
    refused(&study("sweep", &["--out", "out", "--force"]), &["seed=2` is a file"]);
    assert_eq!((listing(&out), fs::read_to_string(out.join("seed=2")).unwrap()), (before, "mine".to_owned()));
    succeeds_in(&here, &study("tradeoff", &["--out", "out", "--force"]));
    assert_eq!(fs::read_to_string(out.join("seed=2")).unwrap(), "mine");
}
