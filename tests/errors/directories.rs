//! Directories of runs in which something is not what the run left there: links, pipes, other content; and what asks for more than there is.

use std::fs;
use std::path::Path;
use std::sync::mpsc;
use std::thread;

use mesoscope::gpu::AdapterChoice;
use mesoscope::output::{OutputError, RunDirectory, files};
use mesoscope::plan::Division;
use mesoscope::run::{self, Run, RunError};
use mesoscope::scene::{self, Checked, SceneError, WrittenScene};
use mesoscope::state_file::GsdWriter;
use serde_json::{Value, json};

use crate::cost::{MEMORY, PATIENCE, measured};

/// A few particles with everything that a run may leave.
fn small() -> Checked {
    let set = [
        "space.box=[3,3,3]",
        r#"time={"step":0.02,"steps":20}"#,
        r#"output={"energies":{"every":4},"trajectory":{"every":10,"format":"extended-xyz"},
            "radial_distribution":{"every":4,"range":1},"plot":{"width":320,"height":240},"snapshot":{"width":64,"height":64}}"#,
    ];
    scene::load("dpd-fluid", &set.map(str::to_owned)).unwrap()
}

/// A finished run of it.
fn finished(directory: &Path) {
    Run::start(small(), directory).execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
}

/// What `resume`, to a later step, and `plot` say of a directory, if they say it soon.
#[track_caller]
fn refusals(directory: &Path) -> [String; 2] {
    let directory = directory.to_path_buf();
    let (sender, receiver) = mpsc::channel();
    thread::spawn(move || {
        let resumed = Run::resume(&directory, Some(40))
            .and_then(|simulation| simulation.execute(&AdapterChoice::Best, &mut |_| {}).map(drop));
        let drawn = RunDirectory::open(&directory).map_err(RunError::from);
        let drawn = drawn.and_then(|place| run::redraw(&place, &AdapterChoice::Best, &[]).map(drop));
        sender.send([resumed, drawn].map(|result| result.err().map(|error| error.to_string()).unwrap_or_default()))
    });
    receiver.recv_timeout(PATIENCE).expect("an answer")
}

/// A pipe would be waited for, a device read for ever, and what a link leads to cut back.
#[cfg(unix)]
#[test]
fn files_that_are_not_the_runs_own_are_refused() {
    let place = tempfile::tempdir().unwrap();
    let directory = place.path().join("run");
    finished(&directory);
    let tables = [files::ENERGIES, files::TRAJECTORY_XYZ, "radial_distribution.csv"];
    for name in [files::SUMMARY, files::CHECKPOINT, files::SNAPSHOT].iter().chain(&tables) {
        let (path, kept) = (directory.join(name), place.path().join("kept"));
        fs::rename(&path, &kept).unwrap();
        let content = fs::read(&kept).unwrap();
        for (what, make) in [
            ("a symbolic link", &(|| std::os::unix::fs::symlink(&kept, &path).unwrap()) as &dyn Fn()),
            ("a symbolic link", &|| std::os::unix::fs::symlink("/dev/zero", &path).unwrap()),
            ("a pipe", &|| assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success())),
        ] {
            make();
            for said in refusals(&directory) {
                assert!(said.contains(name) && said.contains(what), "{name}: {said}");
            }
            fs::remove_file(&path).unwrap();
            assert!(fs::read(&kept).unwrap() == content, "{name} was followed");
        }
        fs::rename(&kept, &path).unwrap();
    }
    // A copy by hard links keeps its tables as they are.
    for name in [files::ENERGIES, files::TRAJECTORY_XYZ] {
        let twin = place.path().join("twin");
        fs::hard_link(directory.join(name), &twin).unwrap();
        let [resumed, drawn] = refusals(&directory);
        assert!(resumed.contains(name) && resumed.contains("hard link") && drawn.is_empty(), "{resumed} {drawn}");
        fs::remove_file(&twin).unwrap();
    }
    assert_eq!(refusals(&directory), ["", ""]);
}

/// Numbers in `run.json` are what the run wrote, or nobody goes on with it.
#[test]
fn summaries_that_were_edited_are_refused() {
    let place = tempfile::tempdir().unwrap();
    finished(place.path());
    let path = place.path().join(files::SUMMARY);
    let written = fs::read(&path).unwrap();
    let edited = |edit: &dyn Fn(&mut Value)| {
        let mut content: Value = serde_json::from_slice(&written).unwrap();
        edit(&mut content);
        fs::write(&path, serde_json::to_vec(&content).unwrap()).unwrap();
    };
    for edit in [
        &(|content: &mut Value| content["means"]["temperature"]["value"] = json!(1.5)) as &dyn Fn(&mut Value),
        &|content| content["results"]["radial_distribution"]["peak_height"] = json!(2),
        &|content| content["warnings"] = json!(["none"]),
        &|content| content["checksum"] = json!("0000000000000000"),
    ] {
        edited(edit);
        let resumed = Run::resume(place.path(), None).unwrap_err();
        assert!(matches!(resumed, RunError::Output(OutputError::Edited { .. })), "{resumed}");
        let drawn = run::redraw(&RunDirectory::open(place.path()).unwrap(), &AdapterChoice::Best, &[]).unwrap_err();
        assert!(matches!(drawn, RunError::Output(OutputError::Edited { .. })), "{drawn}");
    }
    // Other breaks of lines are the same content; an earlier version of the program noted no checksum.
    edited(&|_| {});
    assert!(Run::resume(place.path(), None).unwrap().is_finished());
    edited(&|content| drop(content.as_object_mut().unwrap().remove("checksum")));
    assert!(Run::resume(place.path(), None).unwrap().is_finished());
}

/// Files that are nearly all holes: what they announce is weighed, and what has no lines is not read to its end.
#[test]
fn sizes_are_weighed_before_they_are_believed() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("start");
    let sparse = |start: &[u8], length: u64| {
        fs::write(&path, start).unwrap();
        fs::File::options().write(true).open(&path).unwrap().set_len(length).unwrap();
    };
    let scene = place.path().join("scene.json");
    fs::write(&scene, WrittenScene::read("dpd-fluid").unwrap().text).unwrap();
    let read = |frame: i64| {
        let state = format!(r#"state={{"file":"start","frame":{frame},"velocities":"thermal"}}"#);
        let set = [&state, r#"particles=[{"species":"fluid"}]"#, r#"space={"box":[9,9,9]}"#, "output={}"];
        let (found, cost) = measured(|| scene::load(scene.to_str().unwrap(), &set.map(str::to_owned)));
        assert!(cost.memory < MEMORY && cost.time < PATIENCE, "{} bytes, {:?}", cost.memory, cost.time);
        found.unwrap().unwrap_err().to_string()
    };
    let lattice = "Lattice=\"9 0 0 0 9 0 0 0 9\" Properties=species:S:1:pos:R:3\n";
    sparse(format!("4000000000\n{lattice}").as_bytes(), 1 << 40);
    let much = "found 4,000,000,000 particles, which take at least 238.42 GiB of memory";
    let said = read(0);
    assert!(said.contains(much), "{said}");
    // Nothing but zeros where lines should be, in a file that would take minutes to read.
    sparse(format!("1000\n{lattice}").as_bytes(), 1 << 37);
    for frame in [0, -1] {
        let said = read(frame);
        assert!(said.contains("found a line that does not end within a megabyte"), "{frame}: {said}");
    }
    let header = "title\n\n4000000000 atoms\n1 atom types\n0 9 xlo xhi\n0 9 ylo yhi\n0 9 zlo zhi\n\nAtoms\n\n";
    sparse(header.as_bytes(), 1 << 40);
    let said = read(-1);
    assert!(said.contains(much), "{said}");
    let mut file = GsdWriter::create(&path, "test", "hoomd", (1, 4)).unwrap();
    file.write("configuration/box", [[9.0_f32], [9.0], [9.0], [0.0], [0.0], [0.0]]).unwrap();
    file.write("particles/N", [[4_000_000_000_u32]]).unwrap();
    file.write("particles/position", [[0.0_f32; 3]]).unwrap();
    file.end_frame();
    file.sync().unwrap();
    drop(file);
    let mut bytes = fs::read(&path).unwrap();
    // The entry of the positions in the index, at whose end stands how many numbers a row has: its second word is the number of rows.
    let index = u64::from_le_bytes(bytes[8..16].try_into().unwrap()) as usize;
    let entry = bytes[index..].chunks_exact_mut(32).find(|entry| entry[24..28] == [3, 0, 0, 0]).unwrap();
    entry[8..16].copy_from_slice(&4_000_000_000_u64.to_le_bytes());
    sparse(&bytes, 1 << 40);
    let said = read(0);
    assert!(said.contains(much), "{said}");
}

/// Each rank needs room for its own part of the box, and not for all of it.
#[test]
fn ranks_are_weighed_by_their_parts() {
    let set = ["space.box=[150,150,150]", "output.radial_distribution=null"].map(str::to_owned);
    let scene = scene::load("dpd-fluid", &set).unwrap();
    let whole = run::adapter_for(&scene, &AdapterChoice::Best);
    let part = run::adapter_for_rank(&scene, Some(Division { parts: [1, 2, 2] }), &AdapterChoice::Best);
    assert!(part.is_ok(), "{:?}", part.err());
    // A software adapter allows 128 MiB in a buffer; others more.
    assert!(matches!(whole, Ok(_) | Err(RunError::TooLarge { .. })));
}

/// As `run` does: before the first bead is placed.
#[test]
fn molecules_that_no_adapter_holds_are_refused_at_once() {
    let set = ["molecules.0.count=9000000", "space.box=[320,320,320]"].map(str::to_owned);
    let refuse = |_: &Checked| Err(SceneError::TooManyParticles { reason: "the adapter is small".to_owned() });
    let (found, cost) = measured(|| WrittenScene::read("diblock-copolymer").unwrap().with(&set).check_fitting(&refuse));
    assert_eq!(found.unwrap().unwrap_err().to_string(), "the adapter is small");
    assert!(cost.memory < MEMORY, "{}", cost.memory);
}
