//! Files of a run: what they hold, what they survive, and how their failures read.

use crate::support::edited;
use mesoscope::families::Model;
use mesoscope::measure::statistics;
use mesoscope::output::checkpoint::{self, CheckpointError, ContentError};
use mesoscope::output::summary::AdapterSummary;
use mesoscope::output::{
    EnergiesFile, Extent, Id, OutputError, RunDirectory, Summary, TrajectoryWriter, files, read_table,
    write_atomically, write_table,
};
use mesoscope::scene::{Checked, Scene, TrajectoryFormat};
use mesoscope::state::State;
use mesoscope::table::Table;
use std::fs;
use std::path::Path;

use crate::support::gsd;
use crate::support::program::listing;

fn run_id() -> Id {
    Id::of_run(&scene(3))
}

fn scene(dimension: usize) -> Checked {
    let lengths = &[4.0, 5.0, 6.1][..dimension];
    let scene: Scene = serde_json::from_value(serde_json::json!({
        "title": "two species",
        "space": { "box": lengths },
        "time": { "step": 0.01, "steps": 100 },
        "temperature": 1.0,
        "particles": [
            { "species": "light", "count": 2 },
            { "species": "heavy one", "count": 1, "mass": 4.0 },
        ],
    }))
    .unwrap();
    scene.check().unwrap()
}

/// Three particles, at momenta that change with the step.
fn state(step: u64, dimension: usize) -> State {
    let flat = |vector: [u32; 3]| if dimension == 2 { [vector[0], vector[1], 0] } else { vector };
    let flat_signed = |vector: [i32; 3]| if dimension == 2 { [vector[0], vector[1], 0] } else { vector };
    State {
        step,
        positions: vec![flat([0, 1 << 30, 1 << 31]), flat([u32::MAX; 3]), flat([3 << 30, 7, 1 << 29])],
        momenta: vec![flat_signed([1 << 24, -(1 << 23), step as i32]), [0; 3], flat_signed([i32::MIN, i32::MAX, 1])],
        species: vec![0, 0, 1],
        images: vec![flat_signed([1, -2, 3]), [0; 3], flat_signed([-1, 0, 5])],
        ..State::default()
    }
}

#[test]
fn a_run_directory_is_made_with_its_parents_and_protects_an_earlier_run() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("a/b/run");
    let run = RunDirectory::create(&path).unwrap();
    assert_eq!(listing(&path), [files::LOCK]);
    fs::write(run.file("notes.txt"), "mine").unwrap();
    drop(run);
    let run = RunDirectory::create(&path).unwrap();

    for name in [files::SUMMARY, files::ENERGIES, &files::snapshot(12)] {
        run.write(name, |writer| writer.write_all(b"old")).unwrap();
    }
    for made in [RunDirectory::create(&path), RunDirectory::replace(&path)] {
        let error = made.unwrap_err();
        assert!(error.to_string().contains(&format!("in use by process {}", std::process::id())), "{error}");
    }
    assert_eq!(listing(&path), ["energies.csv", "mesoscope.lock", "notes.txt", "run.json", "snapshot-000012.png"]);
    let run = {
        drop(run);
        RunDirectory::open(&path).unwrap()
    };
    let error = RunDirectory::create(&path).unwrap_err();
    assert!(matches!(&error, OutputError::ResultExists { path } if path.ends_with("energies.csv")), "{error}");
    assert!(error.to_string().contains("--force"));
    assert_eq!(fs::read(run.file(files::SUMMARY)).unwrap(), b"old");

    // Where something cannot be replaced, nothing is.
    fs::create_dir(run.file(files::ENERGIES_PLOT)).unwrap();
    let error = RunDirectory::replace(&path).unwrap_err();
    assert!(matches!(&error, OutputError::DirectoryOfThatName { path } if path.ends_with("energies.png")), "{error}");
    assert_eq!(fs::read(run.file(files::ENERGIES)).unwrap(), b"old");
    fs::remove_dir(run.file(files::ENERGIES_PLOT)).unwrap();

    RunDirectory::replace(&path).unwrap();
    assert_eq!(listing(&path), ["notes.txt"]);
}

#[test]
fn files_of_the_user_are_neither_removed_nor_followed() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("run");
    let mine = ["write-test.tmp", "run.json.tmp", "checkpoint.bin.tmp", "energies.csv.tmp", "a.mesoscope-1.tmp"];
    fs::create_dir(&path).unwrap();
    for name in mine {
        fs::write(path.join(name), "mine").unwrap();
    }
    let stale = files::temporary(files::CHECKPOINT.as_ref(), 4711, 3);
    fs::write(path.join(&stale), "half of a checkpoint").unwrap();
    let run = RunDirectory::create(&path).unwrap();
    run.write(files::SUMMARY, |writer| writer.write_all(b"{}")).unwrap();
    // What a process with the number of this one once left is in nobody's way either.
    for number in 0..100 {
        fs::write(path.join(files::temporary("t.csv".as_ref(), std::process::id(), number)), "stale").unwrap();
    }
    run.write("t.csv", |writer| writer.write_all(b"x\n")).unwrap();
    assert_eq!(fs::read(run.file("t.csv")).unwrap(), b"x\n");
    drop(run);
    drop(RunDirectory::claim(&path).unwrap());
    let mut expected: Vec<&str> = mine.into_iter().chain([files::SUMMARY, "t.csv"]).collect();
    expected.sort_unstable();
    assert_eq!(listing(&path), expected);
    assert!(mine.iter().all(|name| fs::read(path.join(name)).unwrap() == b"mine"));
    #[cfg(unix)]
    {
        let target = root.path().join("target");
        fs::write(&target, "mine").unwrap();
        for name in mine {
            fs::remove_file(path.join(name)).unwrap();
            std::os::unix::fs::symlink(&target, path.join(name)).unwrap();
        }
        let run = RunDirectory::replace(&path).unwrap();
        for name in [files::SUMMARY, files::CHECKPOINT, files::ENERGIES] {
            run.write(name, |writer| writer.write_all(b"new")).unwrap();
        }
        assert_eq!(fs::read(&target).unwrap(), b"mine");
        assert!(mine.iter().all(|name| path.join(name).is_symlink()));
    }
}

#[test]
fn snapshots_a_resumed_run_takes_again_are_removed() {
    let root = tempfile::tempdir().unwrap();
    let run = RunDirectory::create(root.path()).unwrap();
    for number in 1..=5 {
        run.write(&files::snapshot(number), |writer| writer.write_all(b"p")).unwrap();
    }
    run.remove_snapshots_after(3).unwrap();
    drop(run);
    assert_eq!(listing(root.path()), (1..=3).map(files::snapshot).collect::<Vec<_>>());
}

#[test]
fn a_directory_that_cannot_be_is_refused_with_the_reason() {
    let root = tempfile::tempdir().unwrap();
    let file = root.path().join("file");
    fs::write(&file, "").unwrap();
    let error = RunDirectory::replace(&file).unwrap_err();
    assert!(matches!(&error, OutputError::NoDirectory { path } if *path == file), "{error}");
    let below = file.join("below");
    let error = RunDirectory::replace(&below).unwrap_err();
    assert!(matches!(&error, OutputError::Io { path, .. } if *path == below), "{error}");
    assert!(error.to_string().starts_with("cannot create the directory"), "{error}");
    assert!(RunDirectory::open(root.path().join("absent")).is_err());
    assert!(RunDirectory::open(&file).is_err());
    assert_eq!(fs::read(&file).unwrap(), b"");
    #[cfg(target_os = "linux")]
    {
        // Nobody, not even root, makes files here.
        let error = RunDirectory::create("/proc/self").unwrap_err();
        assert!(error.to_string().starts_with("cannot write to the directory `/proc/self`"), "{error}");
    }
}

#[test]
fn a_file_appears_complete_or_not_at_all() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("run.json");
    write_atomically(&path, |writer| writer.write_all(b"first")).unwrap();
    let error = write_atomically(&path, |writer| {
        writer.write_all(b"sec")?;
        Err(std::io::Error::other("interrupted"))
    })
    .unwrap_err();
    assert!(error.to_string().contains("interrupted"));
    assert_eq!(fs::read(&path).unwrap(), b"first");
    assert_eq!(listing(root.path()), ["run.json"]);

    // The final name is a directory: the move fails, and leaves nothing behind.
    fs::create_dir(root.path().join("taken")).unwrap();
    assert!(write_atomically(&root.path().join("taken"), |writer| writer.write_all(b"x")).is_err());
    assert_eq!(listing(root.path()), ["run.json", "taken"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported_as_such() {
    let is_full = |error: &OutputError| matches!(error, OutputError::Io { source, .. } if source.kind() == std::io::ErrorKind::StorageFull);

    let full = Path::new("/dev/full");
    let error = EnergiesFile::create(full, &["time"]).unwrap_err();
    assert!(is_full(&error), "{error}");
    assert!(error.to_string().starts_with("cannot write `/dev/full`: No space left"), "{error}");

    let model = scene(3).model().clone();
    let error = TrajectoryWriter::create(full, TrajectoryFormat::Gsd, &model, run_id()).unwrap_err();
    assert!(is_full(&error), "{error}");
    let mut trajectory = TrajectoryWriter::create(full, TrajectoryFormat::ExtendedXyz, &model, run_id()).unwrap();
    trajectory.append(&state(0, 3).into()).unwrap();
    assert!(is_full(&trajectory.flush().unwrap_err()));
}

#[test]
fn energies_hold_whole_rows_that_read_back_exactly() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::ENERGIES);
    let mut energies = EnergiesFile::create(&path, &["time", "pressure"]).unwrap();
    energies.append(0, &[0.0, f64::NAN]).unwrap();
    energies.append(20, &[0.2, 23.635]).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "step,time,pressure\n");
    energies.flush().unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "step,time,pressure\n0,0,\n20,0.2,23.635\n");
    assert!(matches!(energies.append(40, &[1.0]), Err(OutputError::RowLength { expected: 2, found: 1, .. })));
    drop(energies);

    let table = read_table(&path).unwrap();
    assert_eq!(table.columns, ["step", "time", "pressure"]);
    assert_eq!(table.column("time").unwrap(), [0.0, 0.2]);
    assert!(table.rows[0][2].is_nan());
    assert_eq!(table.column("absent"), None);
    assert!(matches!(EnergiesFile::create(&path, &["a\nb"]), Err(OutputError::ColumnName { .. })));
}

#[test]
fn resumed_energies_continue_after_the_step_and_keep_earlier_rows() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::ENERGIES);
    let mut energies = EnergiesFile::create(&path, &["x"]).unwrap();
    let mut extents = Vec::new();
    for step in 0..10 {
        energies.append(10 * step, &[1.0 / (step + 1) as f64]).unwrap();
        energies.sync().unwrap();
        extents.push(energies.extent());
    }
    drop(energies);
    let whole = fs::read(&path).unwrap();

    // As a killed process may leave it: the last row is not finished.
    fs::write(&path, &whole[..whole.len() - 3]).unwrap();
    let mut energies = EnergiesFile::resume(&path, &["x"], extents[8]).unwrap();
    energies.append(90, &[0.1]).unwrap();
    drop(energies);
    assert_eq!(fs::read(&path).unwrap(), whole);

    let mut energies = EnergiesFile::resume(&path, &["x"], extents[5]).unwrap();
    assert_eq!(energies.extent(), extents[5]);
    for step in 6..10 {
        energies.append(10 * step, &[1.0 / (step + 1) as f64]).unwrap();
    }
    energies.sync().unwrap();
    assert_eq!(energies.extent(), extents[9]);
    energies.check().unwrap();
    drop(energies);
    assert_eq!(fs::read(&path).unwrap(), whole);

    // Any bit of what is kept; what is cut off may be anything.
    for place in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[place] ^= 1 << (place % 8);
        fs::write(&path, &bytes).unwrap();
        let resumed = EnergiesFile::resume(&path, &["x"], extents[5]);
        if place < extents[5].bytes as usize {
            assert!(matches!(resumed, Err(OutputError::Altered { .. } | OutputError::Columns { .. })), "byte {place}");
            assert_eq!(fs::read(&path).unwrap(), bytes, "it is left as it is");
        } else {
            drop(resumed.unwrap());
            assert_eq!(fs::read(&path).unwrap(), whole[..extents[5].bytes as usize]);
        }
    }
    fs::write(&path, &whole).unwrap();

    let error = EnergiesFile::resume(&path, &["y"], extents[5]).unwrap_err();
    assert!(matches!(&error, OutputError::Columns { found, .. } if found == "step,x"), "{error}");
    fs::write(&path, &whole[..extents[5].bytes as usize - 1]).unwrap();
    assert!(matches!(EnergiesFile::resume(&path, &["x"], extents[5]), Err(OutputError::Altered { .. })));
    assert!(matches!(EnergiesFile::resume(&root.path().join("no"), &["x"], extents[1]), Err(OutputError::Io { .. })));
}

#[test]
fn a_file_that_vanishes_is_missed() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::ENERGIES);
    let model = scene(3).model().clone();
    let states = [state(0, 3), state(5, 3)];
    let problems: [(&str, &dyn Fn()); 3] = [
        ("it was removed", &|| fs::remove_file(&path).unwrap()),
        ("another file took its place", &|| {
            fs::copy(&path, root.path().join("copy")).unwrap();
            fs::rename(root.path().join("copy"), &path).unwrap();
        }),
        ("something else wrote to it", &|| fs::OpenOptions::new().write(true).open(&path).unwrap().set_len(3).unwrap()),
    ];
    for (problem, act) in problems {
        let mut energies = EnergiesFile::create(&path, &["x"]).unwrap();
        energies.append(0, &[1.0]).unwrap();
        energies.flush().unwrap();
        energies.check().unwrap();
        act();
        let lost = energies.check().unwrap_err();
        assert!(matches!(lost, OutputError::Lost { .. }) && lost.to_string().contains(problem), "{lost}");
        for format in [TrajectoryFormat::Gsd, TrajectoryFormat::ExtendedXyz] {
            let mut trajectory = TrajectoryWriter::create(&path, format, &model, run_id()).unwrap();
            for state in &states {
                trajectory.append(&state.clone().into()).unwrap();
                trajectory.flush().unwrap();
                trajectory.check().unwrap();
            }
            act();
            let lost = trajectory.check().unwrap_err();
            assert!(matches!(lost, OutputError::Lost { .. }) && lost.to_string().contains(problem), "{lost}");
        }
    }
}

#[test]
fn tables_say_which_line_is_wrong() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("t.csv");
    let cases: [(&[u8], u64, &str); 6] = [
        (b"", 1, "header"),
        (b"a,b\n1,2\n1,x\n", 3, "`x`"),
        (b"a,b\n1\n", 2, "expected 2 cells, found 1"),
        (b"a,b\n1,2,3\n", 2, "found 3"),
        (b"a,\"b\n1,2\n", 1, "quotation"),
        (b"a,b\n1,\xff\n", 2, "UTF-8"),
    ];
    for (content, number, part) in cases {
        fs::write(&path, content).unwrap();
        let error = read_table(&path).unwrap_err();
        assert!(matches!(error, OutputError::Line { line, .. } if line == number), "{error}");
        assert!(error.to_string().contains(part), "{error}");
    }
    assert!(matches!(read_table(&root.path().join("absent")), Err(OutputError::Io { .. })));
    fs::write(&path, "a,b\r\n1,2\r\n").unwrap();
    assert_eq!(read_table(&path).unwrap().rows, [[1.0, 2.0]]);

    let table = Table { columns: vec!["r".into(), "g of A,B".into()], rows: vec![vec![0.05, 0.0], vec![0.15, 1e-9]] };
    write_table(&path, &table).unwrap();
    assert_eq!(read_table(&path).unwrap(), table);
    let uneven = Table { columns: vec!["r".into()], rows: vec![vec![]] };
    assert!(matches!(write_table(&path, &uneven), Err(OutputError::RowLength { .. })));
}

#[test]
fn a_checkpoint_comes_back_to_the_last_bit() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::CHECKPOINT);
    // Numbers that a hasty parser misses by the last bit.
    let scene = edited(&scene(3), |scene| {
        scene.time.step = 0.1 + 0.2;
        scene.temperature = 1.234_567_890_123_456_7e-7;
        scene.space.lengths = vec![14.0 / 3.0, 5.0 + f64::EPSILON, 900.719_925_474_099_3];
    });
    let sections = vec![("diffusion".to_owned(), vec![1, 2, 3]), ("größe".to_owned(), Vec::new())];
    let written = vec![(files::ENERGIES.to_owned(), Extent { bytes: u64::MAX, crc32: u32::MAX })];
    let mut state = state(99, 3);
    for predicted in [Vec::new(), vec![[1, -2, 3]; 3]] {
        state.predicted = predicted;
        checkpoint::save(&path, run_id(), &scene, &state, &written, &sections).unwrap();
        let loaded = checkpoint::load(&path).unwrap();
        assert_eq!((&loaded.scene, &loaded.state), (&scene, &state));
        assert_eq!((&loaded.files, &loaded.sections), (&written, &sections));
        assert_eq!(loaded.run_id, run_id());
        let first = fs::read(&path).unwrap();
        checkpoint::save(&path, run_id(), &loaded.scene, &loaded.state, &loaded.files, &loaded.sections).unwrap();
        assert_eq!(fs::read(&path).unwrap(), first);
    }
    let nothing = edited(&scene, |scene| scene.particles.clear());
    checkpoint::save(&path, run_id(), &nothing, &State::default(), &[], &[]).unwrap();
    assert_eq!(checkpoint::load(&path).unwrap().state, State::default());
    assert_eq!(listing(root.path()), [files::CHECKPOINT]);

    state.momenta.pop();
    assert!(matches!(checkpoint::save(&path, run_id(), &scene, &state, &[], &[]), Err(OutputError::Io { .. })));
    assert_eq!(checkpoint::load(&path).unwrap().state, State::default());
}

#[test]
fn a_damaged_checkpoint_is_refused_whatever_the_damage() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::CHECKPOINT);
    checkpoint::save(&path, run_id(), &scene(2), &state(7, 2), &[], &[("a".to_owned(), vec![9; 10])]).unwrap();
    let whole = fs::read(&path).unwrap();
    let load = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        checkpoint::load(&path)
    };
    assert!(load(&whole).is_ok());
    for length in 0..whole.len() {
        let error = load(&whole[..length]).unwrap_err();
        let expected = if length == 0 {
            matches!(error, CheckpointError::Content { source: ContentError::Magic, .. })
        } else {
            matches!(error, CheckpointError::Content { source: ContentError::Length { .. }, .. })
        };
        assert!(expected, "{length} bytes: {error}");
    }
    for place in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[place] ^= 0x10;
        let error = load(&bytes).unwrap_err();
        let expected = match place {
            0..8 => matches!(error, CheckpointError::Content { source: ContentError::Magic, .. }),
            8..12 => matches!(error, CheckpointError::Content { source: ContentError::Version { .. }, .. }),
            12..20 => matches!(error, CheckpointError::Content { source: ContentError::Length { .. }, .. }),
            _ => matches!(error, CheckpointError::Content { source: ContentError::Checksum, .. }),
        };
        assert!(expected, "byte {place}: {error}");
    }
    let longer = [&whole[..], b"x"].concat();
    assert!(matches!(load(&longer), Err(CheckpointError::Content { source: ContentError::Length { .. }, .. })));
    fs::remove_file(&path).unwrap();
    assert!(matches!(checkpoint::load(&path), Err(CheckpointError::Output(_))));
    assert!(matches!(checkpoint::load(root.path()), Err(CheckpointError::Output(_))));
}

/// A file whose checksum is right and whose lengths are not.
#[test]
fn hostile_lengths_in_a_checkpoint_allocate_nothing() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::CHECKPOINT);
    checkpoint::save(&path, run_id(), &scene(2), &state(7, 2), &[], &[("a".to_owned(), vec![9; 10])]).unwrap();
    let whole = fs::read(&path).unwrap();
    let payload = &whole[20..whole.len() - 8];
    let sealed = |payload: &[u8]| {
        let sum = payload
            .iter()
            .fold(0xcbf2_9ce4_8422_2325_u64, |sum, byte| (sum ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3));
        [&whole[..12], &(payload.len() as u64).to_le_bytes(), payload, &sum.to_le_bytes()].concat()
    };
    assert_eq!(sealed(payload), whole);
    let length = |at: usize| u64::from_le_bytes(payload[at..at + 8].try_into().unwrap()) as usize;
    let after_id = 8 + length(0);
    let scene = after_id + 8..after_id + 8 + length(after_id);
    for place in 0..payload.len() - 7 {
        // The text of the scene holds no length.
        let lengths = [u64::MAX / 12, 1 << 40];
        for length in lengths.into_iter().take(if scene.contains(&place) { place % 16 / 15 } else { 2 }) {
            let mut altered = payload.to_vec();
            altered[place..place + 8].copy_from_slice(&length.to_le_bytes());
            fs::write(&path, sealed(&altered)).unwrap();
            // Where the eight bytes are a position, a momentum or the step, the file is as good as before.
            if let Err(error) = checkpoint::load(&path) {
                let refused = matches!(
                    error,
                    CheckpointError::Content { source: ContentError::Malformed(_), .. } | CheckpointError::Scene { .. }
                );
                assert!(refused, "{place}: {error}");
            }
        }
    }
    for place in [0, after_id, scene.end + 8] {
        let mut altered = payload.to_vec();
        altered[place..place + 8].copy_from_slice(&(u64::MAX / 12).to_le_bytes());
        fs::write(&path, sealed(&altered)).unwrap();
        assert!(matches!(
            checkpoint::load(&path),
            Err(CheckpointError::Content { source: ContentError::Malformed(_), .. })
        ));
    }
}

fn steps_of(path: &Path) -> Vec<u64> {
    let mut file = gsd::open(path);
    (0..file.frames().unwrap()).map(|frame| gsd::scalars::<u64>(&mut file, frame, "configuration/step")[0]).collect()
}

/// Bonds and angles are in the first frame, and stay there when a trajectory is cut back to it; a line is a plane in HOOMD's terms.
#[test]
fn gsd_holds_bonds_and_angles() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::TRAJECTORY_GSD);
    let scene = serde_json::from_value(serde_json::json!({
        "title": "line", "space": {"box": [50.0]}, "time": {"step": 0.1, "steps": 1}, "temperature": 1.0,
        "integrator": {"type": "cotter-reich"},
        "particles": [{"species": "bead", "count": 6, "chain": {"beads": 3}}],
        "interactions": [
            {"type": "bonds", "pairs": [[5, 1]]},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 1.0}},
            {"type": "angles", "stiffness": 1.0},
        ],
    }));
    let scene: Scene = scene.unwrap();
    let scene = scene.check().unwrap();
    let model = scene.model();
    let start = mesoscope::families::initial_state(&scene);
    let mut trajectory = TrajectoryWriter::create(&path, TrajectoryFormat::Gsd, model, run_id()).unwrap();
    let mut extents = Vec::new();
    for step in [0, 10, 20] {
        trajectory.append(&State { step, ..start.clone() }.into()).unwrap();
        trajectory.flush().unwrap();
        extents.push(trajectory.extent());
    }
    drop(trajectory);
    drop(TrajectoryWriter::resume(&path, TrajectoryFormat::Gsd, model, run_id(), extents[1]).unwrap());

    let mut file = gsd::open(&path);
    assert_eq!(file.frames().unwrap(), 2);
    assert_eq!(gsd::scalars::<u32>(&mut file, 0, "bonds/N"), [5]);
    assert_eq!(gsd::scalars::<u32>(&mut file, 0, "bonds/typeid"), [0, 1, 1, 1, 1]);
    let groups: Vec<[u32; 2]> = gsd::arrays(&mut file, 0, "bonds/group");
    assert_eq!(groups, [[5, 1], [0, 1], [1, 2], [3, 4], [4, 5]]);
    assert_eq!(gsd::arrays::<i8, 64>(&mut file, 0, "bonds/types").len(), 2);
    assert_eq!(gsd::scalars::<u32>(&mut file, 0, "angles/N"), [2]);
    assert_eq!(gsd::scalars::<u32>(&mut file, 0, "angles/typeid"), [0, 0]);
    let groups: Vec<[u32; 3]> = gsd::arrays(&mut file, 0, "angles/group");
    assert_eq!(groups, [[0, 1, 2], [3, 4, 5]]);
    assert_eq!(gsd::arrays::<i8, 64>(&mut file, 0, "angles/types").len(), 1);
    assert_eq!(gsd::scalars::<u8>(&mut file, 0, "configuration/dimensions"), [2]);
    assert_eq!(gsd::scalars::<f32>(&mut file, 0, "configuration/box")[..3], [50.0, 1.0, 0.0]);
    let positions: Vec<[f32; 3]> = gsd::arrays(&mut file, 0, "particles/position");
    assert!(positions.iter().all(|position| position[1..] == [0.0, 0.0]), "{positions:?}");
}

#[test]
fn gsd_holds_what_hoomd_expects() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::TRAJECTORY_GSD);
    let model = scene(3).model().clone();
    let mut trajectory = TrajectoryWriter::create(&path, TrajectoryFormat::Gsd, &model, run_id()).unwrap();
    for step in [0, 10] {
        trajectory.append(&state(step, 3).into()).unwrap();
    }
    trajectory.flush().unwrap();
    drop(trajectory);

    let mut file = gsd::open(&path);
    assert_eq!((&*file.schema(), file.schema_version()), ("hoomd", (1, 4)));
    assert_eq!(file.frames().unwrap(), 2);
    let numbers: Vec<f32> = gsd::scalars(&mut file, 0, "configuration/box");
    assert_eq!(numbers, [4.0, 5.0, 6.1, 0.0, 0.0, 0.0]);
    let numbers: Vec<f32> = gsd::scalars(&mut file, 0, "particles/mass");
    assert_eq!(numbers, [1.0, 1.0, 4.0]);
    assert_eq!(gsd::scalars::<u32>(&mut file, 0, "particles/typeid"), [0, 0, 1]);
    assert_eq!(gsd::scalars::<u32>(&mut file, 0, "particles/N"), [3]);
    let names: Vec<[i8; 64]> = gsd::arrays(&mut file, 0, "particles/types");
    let names: Vec<String> = names
        .iter()
        .map(|name| name.iter().map(|byte| char::from(byte.cast_unsigned())).take_while(|c| *c != '\0').collect())
        .collect();
    assert_eq!(names, ["light", "heavy one"]);
    let positions: Vec<[f32; 3]> = gsd::arrays(&mut file, 1, "particles/position");
    assert_eq!(positions[0], [-2.0, -1.25, 0.0]);
    assert_eq!(positions[1], [-2.0, -2.5, -3.05]);
    let velocities: Vec<[f32; 3]> = gsd::arrays(&mut file, 1, "particles/velocity");
    assert_eq!(gsd::scalars::<f64>(&mut file, 1, "log/time"), [10.0 * model.time_step]);
    let images: Vec<[i32; 3]> = gsd::arrays(&mut file, 1, "particles/image");
    // The second particle is so near to the upper faces that single precision puts it on the lower ones of the next box.
    assert_eq!(images, [[1, -2, 3], [1, 1, 1], [-1, 0, 5]]);
    let unit = model.units.momentum;
    assert_eq!(velocities[0], [(unit * 16_777_216.0) as f32, (-unit * 8_388_608.0) as f32, (unit * 10.0) as f32]);
    assert_eq!(velocities[2][0], (unit * f64::from(i32::MIN) / 4.0) as f32);

    let flat = root.path().join("flat.gsd");
    let model = scene(2).model().clone();
    let mut trajectory = TrajectoryWriter::create(&flat, TrajectoryFormat::Gsd, &model, run_id()).unwrap();
    trajectory.append(&state(0, 2).into()).unwrap();
    trajectory.flush().unwrap();
    let mut file = gsd::open(&flat);
    assert_eq!(gsd::scalars::<u8>(&mut file, 0, "configuration/dimensions"), [2]);
    assert_eq!(gsd::scalars::<f32>(&mut file, 0, "configuration/box")[2], 0.0);
    assert!(gsd::arrays::<f32, 3>(&mut file, 0, "particles/position").iter().all(|position| position[2] == 0.0));
}

/// Writes frames of steps 0, 10, 20, …; returns the extents after each.
fn write_frames(path: &Path, format: TrajectoryFormat, model: &Model, frames: u64) -> Vec<Extent> {
    let mut trajectory = TrajectoryWriter::create(path, format, model, run_id()).unwrap();
    let extents = (0..frames).map(|frame| {
        trajectory.append(&state(10 * frame, 3).into()).unwrap();
        trajectory.flush().unwrap();
        trajectory.extent()
    });
    extents.collect()
}

#[test]
fn trajectories_resume_at_the_step() {
    let root = tempfile::tempdir().unwrap();
    let model = scene(3).model().clone();
    for (format, name) in
        [(TrajectoryFormat::Gsd, files::TRAJECTORY_GSD), (TrajectoryFormat::ExtendedXyz, files::TRAJECTORY_XYZ)]
    {
        let path = root.path().join(name);
        let extents = write_frames(&path, format, &model, 50);
        let straight = fs::read(&path).unwrap();
        // Nothing to drop, some frames to drop, all frames but the first to drop; and data of a frame that was not finished.
        for (last, more) in [(49, 0), (23, 0), (0, 0), (49, 100)] {
            fs::write(&path, [straight.as_slice(), &vec![7; more]].concat()).unwrap();
            let mut trajectory =
                TrajectoryWriter::resume(&path, format, &model, run_id(), extents[last as usize]).unwrap();
            assert_eq!(trajectory.extent(), extents[last as usize]);
            for frame in last + 1..50 {
                trajectory.append(&state(10 * frame, 3).into()).unwrap();
                trajectory.flush().unwrap();
            }
            assert_eq!(trajectory.extent(), extents[49]);
            trajectory.check().unwrap();
            drop(trajectory);
            assert!(fs::read(&path).unwrap() == straight, "{name} cut back to frame {last}");
            if format == TrajectoryFormat::Gsd {
                assert_eq!(steps_of(&path), (0..50).map(|frame| 10 * frame).collect::<Vec<_>>());
                assert_eq!(gsd::scalars::<f32>(&mut gsd::open(&path), 0, "particles/mass").len(), 3);
            }
        }
        assert!(!listing(root.path()).iter().any(|name| name.contains(".tmp")));
    }
}

/// Masses that change are in every frame.
#[test]
fn trajectories_with_changing_masses_are_cut_back_to_the_byte() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::TRAJECTORY_GSD);
    let scene = r#"{"title": "t", "space": {"box": [9, 9]}, "time": {"step": 0.1, "steps": 1}, "temperature": 1,
        "particles": [{"species": "A", "count": 16}], "interactions": [{"type": "voronoi", "form": "paper"}]}"#;
    let scene = mesoscope::scene::parse("t", scene, &[]).unwrap();
    let model = scene.model();
    let start = mesoscope::families::initial_state(&scene);
    let mut trajectory = TrajectoryWriter::create(&path, TrajectoryFormat::Gsd, model, run_id()).unwrap();
    let mut written = Vec::new();
    for step in 0..9 {
        trajectory.append(&State { step, ..start.clone() }.into()).unwrap();
        trajectory.flush().unwrap();
        written.push((trajectory.extent(), fs::read(&path).unwrap()));
    }
    drop(trajectory);
    for (extent, bytes) in written.iter().rev() {
        drop(TrajectoryWriter::resume(&path, TrajectoryFormat::Gsd, model, run_id(), *extent).unwrap());
        assert!(fs::read(&path).unwrap() == *bytes, "{extent:?}");
    }
}

/// Step, positions and velocities.
type Frame = (u64, Vec<[f32; 3]>, Vec<[f32; 3]>);

/// What a reader sees of a trajectory.
fn content_of(path: &Path) -> Vec<Frame> {
    let mut file = gsd::open(path);
    let frames = (0..file.frames().unwrap()).zip(steps_of(path));
    let mut vectors = |frame, name| gsd::arrays::<f32, 3>(&mut file, frame, name);
    frames
        .map(|(frame, step)| (step, vectors(frame, "particles/position"), vectors(frame, "particles/velocity")))
        .collect()
}

#[test]
fn damaged_trajectories_are_refused_and_left_alone() {
    let root = tempfile::tempdir().unwrap();
    let model = scene(3).model().clone();
    let path = root.path().join(files::TRAJECTORY_GSD);
    let extents = write_frames(&path, TrajectoryFormat::Gsd, &model, 3);
    let whole = fs::read(&path).unwrap();
    for length in (0..whole.len()).step_by(7) {
        fs::write(&path, &whole[..length]).unwrap();
        let error = TrajectoryWriter::resume(&path, TrajectoryFormat::Gsd, &model, run_id(), extents[2]).unwrap_err();
        let refused = matches!(error, OutputError::Trajectory { .. } | OutputError::Altered { .. });
        assert!(refused, "{length}: {error}");
        assert_eq!(fs::read(&path).unwrap(), whole[..length]);
    }
    // Header, index, names and all data: any byte is refused, or outside of what a reader sees.
    drop(write_frames(&path, TrajectoryFormat::Gsd, &model, 3));
    let content = content_of(&path);
    let (mut refused, mut harmless) = (0, 0);
    for place in (0..256 + 32 * 40).chain(4352..4352 + 64 * 14).chain(4352 + 8192..whole.len()) {
        let mut bytes = whole.clone();
        bytes[place] ^= 0xff;
        fs::write(&path, &bytes).unwrap();
        match TrajectoryWriter::resume(&path, TrajectoryFormat::Gsd, &model, run_id(), extents[2]) {
            Err(_) => {
                refused += 1;
                assert_eq!(fs::read(&path).unwrap(), bytes);
            }
            Ok(trajectory) => {
                harmless += 1;
                drop(trajectory);
                assert_eq!(content_of(&path), content, "byte {place}");
            }
        }
    }
    println!("of {} flipped bytes of a trajectory {refused} were refused, {harmless} hold nothing", refused + harmless);
    assert!(refused > 500);

    let path = root.path().join(files::TRAJECTORY_XYZ);
    let extents = write_frames(&path, TrajectoryFormat::ExtendedXyz, &model, 3);
    let whole = fs::read(&path).unwrap();
    for place in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[place] ^= 1;
        fs::write(&path, &bytes).unwrap();
        let resumed = TrajectoryWriter::resume(&path, TrajectoryFormat::ExtendedXyz, &model, run_id(), extents[1]);
        let refused = matches!(resumed, Err(OutputError::Altered { .. } | OutputError::OtherRun { .. }));
        assert_eq!(refused, place < extents[1].bytes as usize, "{place}");
    }
}

#[test]
fn extended_xyz_reads_as_documented_and_drops_an_unfinished_frame() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::TRAJECTORY_XYZ);
    let model = scene(2).model().clone();
    let mut trajectory = TrajectoryWriter::create(&path, TrajectoryFormat::ExtendedXyz, &model, run_id()).unwrap();
    trajectory.append(&state(0, 2).into()).unwrap();
    trajectory.flush().unwrap();
    let first = trajectory.extent();
    trajectory.append(&state(5, 2).into()).unwrap();
    let mut wrong = state(6, 2);
    wrong.species[0] = 2;
    assert!(matches!(trajectory.append(&wrong.into()), Err(OutputError::State { step: 6, .. })));
    trajectory.flush().unwrap();
    drop(trajectory);
    let text = fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 10);
    assert_eq!(lines[0], "3");
    assert_eq!(
        lines[6],
        "Lattice=\"4 0 0 0 5 0 0 0 1\" Properties=species:S:1:pos:R:3:velo:R:3:masses:R:1:momenta:R:3:map_shift:I:3:\
         species_name:S:1 pbc=\"T T F\" Step=5 Time=0.05"
            .to_owned()
            + &format!(" run_id={}", run_id())
    );
    assert!(lines[2].starts_with("H 0 1.25 0 ") && lines[2].ends_with(" 1 -2 0 light"), "{}", lines[2]);
    assert!(lines[4].starts_with("He 3 ") && lines[4].ends_with(" -1 0 0 heavy_one"), "{}", lines[4]);
    // As many words a line as the properties announce; momenta are masses times velocities.
    let words: Vec<&str> = lines[4].split(' ').collect();
    assert_eq!(words.len(), 1 + 3 + 3 + 1 + 3 + 3 + 1);
    let number = |place: usize| words[place].parse::<f32>().unwrap();
    assert_eq!(number(7), 4.0);
    assert!((4..7).all(|axis| number(axis + 4) == 4.0 * number(axis)) && number(4) != 0.0, "{words:?}");

    fs::write(&path, &text[..text.len() - 2]).unwrap();
    drop(TrajectoryWriter::resume(&path, TrajectoryFormat::ExtendedXyz, &model, run_id(), first).unwrap());
    assert_eq!(fs::read_to_string(&path).unwrap().lines().count(), 5);
}

/// Every file whose format has a place for it holds the id of its run, and is refused in the directory of another one.
#[test]
fn files_of_another_run_are_recognised() {
    let root = tempfile::tempdir().unwrap();
    let directory = RunDirectory::create(root.path()).unwrap();
    let (this, other) = (run_id(), Id::of_run(&scene(2)));
    let model = scene(3).model().clone();
    let write = |name: &str, id: Id| {
        let path = directory.file(name);
        match name {
            files::SUMMARY => {
                Summary::new(id, scene(3).into_scene(), AdapterSummary::default(), 3).save(&path).unwrap();
            }
            files::CHECKPOINT => checkpoint::save(&path, id, &scene(3), &state(0, 3), &[], &[]).unwrap(),
            files::TRAJECTORY_GSD | files::TRAJECTORY_XYZ => {
                let format =
                    if name == files::TRAJECTORY_GSD { TrajectoryFormat::Gsd } else { TrajectoryFormat::ExtendedXyz };
                let mut trajectory = TrajectoryWriter::create(&path, format, &model, id).unwrap();
                for step in [0, 10] {
                    trajectory.append(&state(step, 3).into()).unwrap();
                }
                trajectory.flush().unwrap();
                let written = trajectory.extent();
                drop(trajectory);
                let resumed = TrajectoryWriter::resume(&path, format, &model, this, written);
                assert_eq!(matches!(resumed, Err(OutputError::OtherRun { .. })), id != this, "{name}");
            }
            name => directory.write_picture(name, id, image::RgbaImage::new(8, 8)).unwrap(),
        }
    };
    let snapshot = files::snapshot(3);
    let names = [
        files::SUMMARY,
        files::CHECKPOINT,
        files::TRAJECTORY_GSD,
        files::TRAJECTORY_XYZ,
        files::ENERGIES_PLOT,
        snapshot.as_str(),
    ];
    for name in names {
        write(name, this);
        directory.check_run(this, files::CHECKPOINT).unwrap();
    }
    for name in names {
        write(name, other);
        let error = directory.check_run(this, files::CHECKPOINT).unwrap_err();
        let told = error.to_string();
        assert!(matches!(error, OutputError::OtherRun { .. }) && told.contains(name), "{told}");
        assert!(told.contains(&this.to_string()) && told.contains(&other.to_string()), "{told}");
        write(name, this);
    }
    // What another program has drawn again has no id, and is no other run's.
    image::RgbaImage::new(8, 8).save(directory.file(&snapshot)).unwrap();
    fs::write(directory.file(files::ENERGIES_PLOT), "nothing").unwrap();
    directory.check_run(this, files::CHECKPOINT).unwrap();
}

#[test]
fn a_trajectory_of_nothing_is_fine() {
    let root = tempfile::tempdir().unwrap();
    let empty = edited(&scene(3), |scene| scene.particles.clear());
    let model = empty.model();
    for format in [TrajectoryFormat::Gsd, TrajectoryFormat::ExtendedXyz] {
        let path = root.path().join("t");
        let mut trajectory = TrajectoryWriter::create(&path, format, model, run_id()).unwrap();
        trajectory.append(&State::default().into()).unwrap();
        trajectory.flush().unwrap();
        let written = trajectory.extent();
        drop(trajectory);
        TrajectoryWriter::resume(&path, format, model, run_id(), written).unwrap().flush().unwrap();
    }
}

#[test]
fn the_summary_keeps_its_order_and_reads_back() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join(files::SUMMARY);
    let adapter = AdapterSummary { name: "llvmpipe".into(), driver: "Mesa 22.3".into(), backend: "Vulkan".into() };
    let mut summary = Summary::new(run_id(), scene(3).into_scene(), adapter, 3);
    summary.set_duration(200, 100, 0.5);
    summary.add_mean("temperature", statistics::estimate(&[1.0, 1.2, 0.9]).as_ref());
    summary.add_mean("bath_energy", None);
    summary.results.insert("diffusion".into(), serde_json::json!({"value": 0.29}));
    summary.warnings.push("short".into());
    summary.save(&path).unwrap();
    assert_eq!(Summary::load(&path).unwrap(), summary);
    assert_eq!((summary.steps, summary.particle_steps_per_second), (200, 600.0));

    let text = fs::read_to_string(&path).unwrap();
    let keys = ["mesoscope_version", "adapter", "particle_steps_per_second", "temperature", "bath_energy", "scene"];
    let places: Vec<usize> = keys.iter().map(|key| text.find(&format!("\"{key}\"")).unwrap()).collect();
    assert!(places.is_sorted(), "{text}");
    assert!(text.contains("\"bath_energy\": null") && text.contains("\"samples\": 3"));

    // A run too short for the clock still makes valid JSON.
    summary.set_duration(0, 0, 0.0);
    summary.save(&path).unwrap();
    assert_eq!(Summary::load(&path).unwrap().particle_steps_per_second, 0.0);
    fs::write(&path, "{\n  \"steps\": oops").unwrap();
    assert!(matches!(Summary::load(&path), Err(OutputError::Line { line: 2, .. })));
}
