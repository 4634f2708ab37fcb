//! Trajectories read back by the packages that people read them with, in Python: `make validate`.
//!
//! A virtual environment is made in the target directory. What cannot be installed there is said, and not tested.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use mesoscope::output::{Id, TrajectoryWriter, files};
use mesoscope::plan::Options;
use mesoscope::scene::{Checked, TrajectoryFormat};
use serde_json::{Value, json};

use crate::support::{cells, engine, fluid, start, water};

const PACKAGES: [&str; 3] = ["gsd", "MDAnalysis", "ase"];
const FRAMES: u64 = 6;
const EVERY: u64 = 40;

/// Scenes in one, two and three dimensions, with particles that go round the box.
fn scenes() -> Vec<(&'static str, Checked)> {
    let trajectory = r#"output.trajectory={"every":40}"#;
    let names = r#"particles=[{"species":"Na","count":30,"mass":2.5},{"species":"a solvent","count":20}]"#;
    let chains = r#"particles=[{"species":"C","count":24,"mass":12,"chain":{"beads":4}},{"species":"H","count":9}]"#;
    let bonds = r#"interactions=[{"type":"bonds","potential":{"type":"harmonic","stiffness":9}},{"type":"langevin","friction":0.1}]"#;
    let angles = r#"interactions=[{"type":"bonds","potential":{"type":"harmonic","stiffness":9}},
        {"type":"angles","stiffness":3},{"type":"langevin","friction":0.1}]"#;
    let channel = r#"space={"box":[4,4,5],"walls":{"z":{"lower_velocity":[-1,0,0]}}}"#;
    let layers = r#"particles=[{"species":"A","count":240},
        {"species":"B","number_density":3,"placement":{"type":"behind-walls","axis":"z","thickness":0.9}}]"#;
    let coupled = r#"integrator={"type":"cotter-reich"}"#;
    let tracers = r#"particles=[{"species":"water","count":512,"velocities":{"type":"geostrophic"}},
        {"species":"dye","count":7,"tracer":true,"velocities":{"type":"geostrophic"}}]"#;
    vec![
        ("fluid", fluid(&["space.box=[3,2.5,2.2]", "temperature=2", names, trajectory])),
        ("plane", fluid(&["space.box=[4,3]", "temperature=2", trajectory])),
        ("line", fluid(&["space.box=[20]", "temperature=40", chains, bonds, coupled, trajectory])),
        ("chains", fluid(&["space.box=[4,4,4]", "temperature=4", chains, bonds, coupled, trajectory])),
        ("bent", fluid(&["space.box=[4,4,4]", "temperature=4", chains, angles, coupled, trajectory])),
        ("layers", fluid(&["temperature=4", channel, layers, trajectory])),
        ("cells", cells(64, &[r#"interactions.0.form="consistent""#, "temperature=4", "time.step=0.05", trajectory])),
        ("water", water(&[tracers, trajectory])),
    ]
}

/// Writes both trajectories of a scene and, as numbers of double precision, what they should say.
fn write(scene: &Checked, place: &Path) {
    fs::create_dir_all(place).unwrap();
    let (model, first) = start(scene);
    let mut engine = engine(scene, &first, Options::default());
    let id = Id::of_run(scene);
    let mut writers = [
        TrajectoryWriter::create(&place.join(files::TRAJECTORY_GSD), TrajectoryFormat::Gsd, &model, id).unwrap(),
        TrajectoryWriter::create(&place.join(files::TRAJECTORY_XYZ), TrajectoryFormat::ExtendedXyz, &model, id)
            .unwrap(),
    ];
    let mut frames = Vec::new();
    for frame in 0..FRAMES {
        if frame > 0 {
            engine.advance(EVERY, EVERY).unwrap();
        }
        let state = engine.reported().unwrap();
        for writer in &mut writers {
            writer.append(&state).unwrap();
            writer.flush().unwrap();
        }
        let unit = model.shallow_water().map(|water| water.mass_unit);
        let unit = unit.or(model.voronoi().map(|cells| cells.mass_unit));
        let species = |id: usize| &model.species[state.species[id] as usize];
        let mass = |id: usize| unit.map_or(species(id).mass, |unit| unit * f64::from(state.masses[id]));
        let inertia = |id: usize| if model.shallow_water().is_some() { 1.0 } else { mass(id) };
        let ids = || 0..state.len();
        let unwrapped = |id: usize| -> [f64; 3] {
            let position = model.units.position(state.positions[id]);
            std::array::from_fn(|axis| position[axis] + f64::from(state.images[id][axis]) * model.units.lengths[axis])
        };
        frames.push(json!({
            "step": state.step,
            "time": state.step as f64 * model.time_step,
            "names": ids().map(|id| species(id).name.clone()).collect::<Vec<_>>(),
            "words": ids().map(|id| species(id).name.replace(' ', "_")).collect::<Vec<_>>(),
            "masses": ids().map(mass).collect::<Vec<_>>(),
            "unwrapped": ids().map(unwrapped).collect::<Vec<_>>(),
            "velocities": ids()
                .map(|id| model.units.momentum(state.momenta[id]).map(|momentum| momentum / inertia(id)))
                .collect::<Vec<_>>(),
        }));
        assert!(frame < FRAMES - 1 || state.images.iter().any(|image| *image != [0; 3]), "nothing goes round the box");
    }
    let expected: Value = json!({
        "run_id": id,
        "lengths": model.units.lengths,
        "dimension": model.units.dimension,
        "gaps": model.units.gaps,
        "angles": model.particles().angles.as_ref().map_or(0, |angles| angles.count() as usize),
        "bonds": model.particles().bonds.as_ref().map_or(0, |bonds| bonds.count() as usize),
        "frames": frames,
    });
    fs::write(place.join("expected.json"), expected.to_string()).unwrap();
}

/// The interpreter of a virtual environment with what could be installed; none without Python.
pub fn python(target: &Path, packages: &[&str]) -> Option<PathBuf> {
    let environment = target.join("readers");
    let interpreter = environment.join(if cfg!(windows) { "Scripts/python.exe" } else { "bin/python" });
    if !interpreter.exists() {
        let made = Command::new("python3").args(["-m", "venv"]).arg(&environment).status();
        if !made.is_ok_and(|status| status.success()) {
            return None;
        }
    }
    for package in packages {
        let install = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", *package];
        let installed = Command::new(&interpreter).args(install).output();
        if !installed.is_ok_and(|output| output.status.success()) {
            println!("pip cannot install {package}");
        }
    }
    Some(interpreter)
}

#[test]
#[ignore = "installs Python packages"]
fn other_programs_read_what_was_written() {
    let root = tempfile::tempdir().unwrap();
    for (name, scene) in scenes() {
        write(&scene, &root.path().join(name));
    }
    let Some(python) = python(Path::new(env!("CARGO_TARGET_TMPDIR")), &PACKAGES) else {
        println!("NOT TESTED: there is no Python that makes virtual environments");
        return;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/validation/read_back.py");
    let output = Command::new(python).arg(script).arg(root.path()).output().unwrap();
    println!("{}", String::from_utf8_lossy(&output.stdout));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}
