//! What sweeps, tradeoffs and maps of stability have in common: their files, what goes on with them, and what is refused.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use mesoscope::gpu::AdapterChoice;
use mesoscope::stability::{Request, StabilityRun, StabilitySummary};
use mesoscope::study::StudyEvent;
use serde_json::json;

use crate::support::program::{Place, command, fails, listing, text};

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
        let request = Request::load(&place.scene(), &[], &vary).unwrap().with_bisections(0);
        let run = StabilityRun::start(request, place.path("out"), true).with_jobs(Some(1));
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
    let request = Request::load(&place.scene(), &[], &vary).unwrap().with_bisections(0);
    fs::remove_file(place.path("other.xyz")).unwrap();
    let run = StabilityRun::start(request, place.path("out"), true).with_jobs(Some(1));
    let message = run.execute(&AdapterChoice::Best, &mut |_| {}).unwrap_err().to_string();
    assert!(message.contains("other.xyz` is not what it was"), "{message}");
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
        refused(&study(next, &["--out", "out"]), &["exists already", "--force"]);
        assert_eq!(listing(&out), before, "{next}");
    }
    for (next, expected) in [
        ("tradeoff", &["finer", "notes.md", "step=0.02", "tradeoff-temperature.png"][..]),
        ("stability", &["notes.md", "stability.csv", "stability.json", "stability.md", "stability.png"]),
        ("sweep", &["notes.md", "seed=1", "seed=2", "sweep-averages.csv"]),
    ] {
        succeeds_in(&here, &study(next, &["--out", "out", "--force"]));
        let found = listing(&out);
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
