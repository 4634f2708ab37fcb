//! States from files: what this program wrote is read back, what others write is what it says, and a run that began with a file
//! goes on without it.

use crate::support::edited;
use std::fs;
use std::path::Path;

use mesoscope::families::reference::Reference;
use mesoscope::output::{Id, TrajectoryWriter, checkpoint, files};
use mesoscope::scene::{self, Checked, Integrator, KeptStart, TrajectoryFormat, Warning};
use mesoscope::state::State;
use mesoscope::state_file::GsdWriter;
use serde_json::{Value, json};

use crate::support::program::{Place, bytes, fails, succeeds};
use crate::support::start;

/// Chains and a solvent whose name is no chemical symbol, in a box without round numbers.
fn melt() -> Value {
    json!({
        "title": "a melt",
        "seed": 5,
        "space": {"box": [4.1, 5.3, 6.7]},
        "time": {"step": 0.01, "steps": 40},
        "temperature": 1,
        "particles": [
            {"species": "C", "count": 60, "mass": 1.5, "chain": {"beads": 5, "spacing": 0.8}},
            {"species": "a solvent", "count": 90},
        ],
        "interactions": [
            {"type": "dpd", "repulsion": 25, "friction": 4.5},
            {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 20}},
            {"type": "angles", "stiffness": 2},
        ],
        "output": {
            "energies": {"every": 5},
            "trajectory": {"every": 10},
            "checkpoint": {"every": 20},
            "plot": {"width": 640, "height": 480},
            "snapshot": {"width": 100, "height": 80},
        },
    })
}

/// The same with charges.
fn charged_melt() -> Value {
    let mut scene = melt();
    for (group, charge) in [(0, -0.75), (1, 0.5)] {
        scene["particles"][group]["charge"] = json!(charge);
    }
    let interactions = scene["interactions"].as_array_mut().unwrap();
    interactions.push(json!({"type": "electrostatics", "bjerrum_length": 1.1}));
    scene
}

/// The scene with the file of a state, and groups that leave out what the file says.
fn with_state(scene: &Value, state: Value) -> Value {
    let mut scene = scene.clone();
    scene["state"] = state;
    scene.as_object_mut().unwrap().remove("space");
    for group in scene["particles"].as_array_mut().unwrap() {
        for key in ["count", "mass", "charge", "chain"] {
            group.as_object_mut().unwrap().remove(key);
        }
    }
    scene
}

/// A scene in a directory, and what is not used of its file.
#[track_caller]
fn load(directory: &Path, scene: &Value) -> (Checked, Vec<Warning>) {
    let path = directory.join("scene.json");
    fs::write(&path, scene.to_string()).unwrap();
    let scene = scene::load(path.to_str().unwrap(), &[]).unwrap_or_else(|error| panic!("{error}"));
    let notices = scene.notices().to_vec();
    (scene, notices)
}

/// The largest difference of two states: of positions as parts of the box, of momenta as parts of the largest.
fn difference(a: &State, b: &State) -> [f64; 2] {
    let apart = |a: u32, b: u32| f64::from(a.wrapping_sub(b).cast_signed().unsigned_abs()) / 4_294_967_296.0;
    let positions = a.positions.iter().flatten().zip(b.positions.iter().flatten()).map(|(a, b)| apart(*a, *b));
    let largest = a.momenta.iter().flatten().fold(0, |most: u32, unit| most.max(unit.unsigned_abs()));
    let apart = |a: i32, b: i32| f64::from((a - b).unsigned_abs()) / f64::from(largest);
    let momenta = a.momenta.iter().flatten().zip(b.momenta.iter().flatten()).map(|(a, b)| apart(*a, *b));
    [positions.fold(0.0, f64::max), momenta.fold(0.0, f64::max)]
}

/// Trajectories hold single precision: numbers are rounded by at most 2⁻²⁴ of themselves. Positions in GSD are up to half an edge, of
/// a box that is rounded too; those in extended XYZ up to a whole one. A checkpoint holds every bit.
#[test]
fn what_was_written_is_read_back() {
    let place = tempfile::tempdir().unwrap();
    let text = charged_melt();
    let written = scene::parse("melt", &text.to_string(), &[]).unwrap();
    let (model, mut state) = start(&written);
    // Somewhere else than at the start, and round the box.
    for (id, image) in state.images.iter_mut().enumerate() {
        *image = image.map(|turns| turns + id as i32 % 3 - 1);
    }
    let id = Id::of_run(&written);
    for (format, name) in [(TrajectoryFormat::Gsd, "a.gsd"), (TrajectoryFormat::ExtendedXyz, "a.xyz")] {
        let mut writer = TrajectoryWriter::create(&place.path().join(name), format, &model, id).unwrap();
        let other = State { step: 5, ..start(&changed_seed(&text)).1 };
        writer.append(&other.clone().into()).unwrap();
        writer.append(&State { step: 10, ..state.clone() }.into()).unwrap();
        writer.append(&State { step: 15, ..other }.into()).unwrap();
        writer.flush().unwrap();
    }
    fs::create_dir(place.path().join("run")).unwrap();
    checkpoint::save(&place.path().join("run").join(files::CHECKPOINT), id, &written, &state, &[], &[]).unwrap();
    let single = 2.0_f64.powi(-24);
    for (file, frame, tolerances) in
        [("a.gsd", 1, [single, 2.0 * single]), ("a.xyz", -2, [1.5 * single, 2.0 * single]), ("run", -1, [0.0, 0.0])]
    {
        let mut asked = with_state(&text, json!({"file": file, "frame": frame}));
        asked["particles"] = json!([{"species": "C"}, {"species": "a_solvent"}]);
        if file == "a.xyz" {
            // This format knows neither bonds nor angles.
            asked["interactions"].as_array_mut().unwrap().truncate(1);
        } else {
            asked["particles"][1]["species"] = json!("a solvent");
        }
        let (scene, notices) = load(place.path(), &asked);
        let (read, found) = start(&scene);
        for axis in 0..3 {
            let ratio = read.units.lengths[axis] / model.units.lengths[axis];
            assert!((ratio - 1.0).abs() <= tolerances[0], "{file}: {ratio}");
        }
        let apart = difference(&state, &found);
        assert!(apart[0] <= tolerances[0] && apart[1] <= tolerances[1], "{file}: {apart:?}");
        assert_eq!((&found.species, &found.images), (&state.species, &state.images), "{file}");
        let masses: Vec<f64> = read.species.iter().map(|species| species.mass).collect();
        assert_eq!(masses, [1.5, 1.0], "{file}");
        assert_eq!([0, 1].map(|species| read.species[species].charge), [-0.75, 0.5], "{file}");
        let bonds = |model: &mesoscope::families::Model| {
            model.particles().bonds.as_ref().map_or(0, |bonds| bonds.iter().count())
        };
        assert_eq!(bonds(&read), if file == "a.xyz" { 0 } else { bonds(&model) });
        let angles = |model: &mesoscope::families::Model| {
            model.particles().angles.as_ref().map_or(Vec::new(), |all| all.iter().collect())
        };
        if file != "a.xyz" {
            assert_eq!(angles(&model).len(), 36);
            assert_eq!(angles(&read), angles(&model), "{file}");
        }
        if file == "run" {
            assert_eq!(found, state);
            assert_eq!(notices, []);
        }
    }
    // The scene itself, with its chains, from its own state.
    let mut again = text.clone();
    again["state"] = json!({"file": "run"});
    let (scene, notices) = load(place.path(), &again);
    assert_eq!(start(&scene).1, state);
    assert_eq!(notices.len(), 1);
    assert_eq!(
        notices[0].to_string(),
        "state.file: not used of `run`: bonds of type `bond 0`; angles of type `angle 0`"
    );
    // Everything that is resolved is in the scene, and it is that scene again.
    let text = serde_json::to_string(&scene).unwrap();
    let name = place.path().join("scene.json");
    assert_eq!(scene::parse(name.to_str().unwrap(), &text, &[]).unwrap(), scene);
}

/// A run goes into a data file of LAMMPS as it was at its last report, and comes back from it.
#[test]
fn runs_are_exported_to_lammps_and_read_back() {
    let place = Place::of(charged_melt());
    place.run("run", &[]);
    let run = place.path("run");
    let data = place.path("melt.data");
    let export = ["export", run.to_str().unwrap(), "--out", data.to_str().unwrap()];
    assert!(succeeds(&export).contains("melt.data: 150 particles"));
    fails(&export, 5, &["melt.data` exists", "--force"]);
    succeeds(&[&export[..], &["--force"]].concat());
    let text = fs::read_to_string(&data).unwrap();
    assert!(text.contains("150 atoms\n2 atom types\n48 bonds\n1 bond types\n36 angles\n1 angle types\n"), "{text}");
    // Chains of five beads are molecules, and so is every bead of the solvent.
    let molecule = |atom: usize| {
        let line = text.lines().skip_while(|line| *line != "Atoms # full").nth(1 + atom).unwrap();
        line.split(' ').nth(1).unwrap().parse::<usize>().unwrap()
    };
    assert_eq!([1, 5, 6, 60, 61, 150].map(molecule), [1, 1, 2, 12, 13, 102]);
    let read = mesoscope::state_file::read(&data, -1, None).unwrap();
    let expected = scene::particles_of(&run, -1).unwrap();
    assert_eq!((&read.types, &read.positions, &read.images), (&expected.types, &expected.positions, &expected.images));
    assert_eq!((&read.masses, &read.charges, &read.lengths), (&expected.masses, &expected.charges, &expected.lengths));
    assert_eq!(read.velocities, expected.velocities);
    assert_eq!(
        (&read.bonds[0].members, &read.angles[0].members),
        (&expected.bonds[0].members, &expected.angles[0].members)
    );
    assert_eq!(read.species, ["C", "a_solvent"]);
    assert_eq!(read.charges, [Some(-0.75), Some(0.5)]);
    fails(&["export", place.path("nothing").to_str().unwrap()], 5, &["nothing"]);
}

/// Files in which a number has no meaning are not exported: bonds to nowhere, charges that differ within a species, no box. A mass that is missing is said.
#[test]
fn files_without_meaning_are_not_exported() {
    let place = tempfile::tempdir().unwrap();
    let export = |name: &str, content: &str| {
        let file = place.path().join(name);
        fs::write(&file, content).unwrap();
        ["export".to_owned(), file.to_str().unwrap().to_owned(), "--out".to_owned(), format!("{}.data", file.display())]
    };
    let refused = |name: &str, content: &str, parts: &[&str]| {
        let arguments = export(name, content);
        fails(&arguments.each_ref().map(String::as_str), 5, parts);
        assert!(!place.path().join(format!("{name}.data")).exists());
    };
    let xyz = |head: &str, lines: [&str; 2]| format!("2\n{head}\n{}\n{}\n", lines[0], lines[1]);
    refused("open.xyz", &xyz("Properties=species:S:1:pos:R:3", ["A 1 1 1", "A 2 2 2"]), &["found no box", "Lattice"]);
    let charged = r#"Lattice="4 0 0 0 4 0 0 0 4" Properties=species:S:1:pos:R:3:charge:R:1"#;
    refused(
        "charged.xyz",
        &xyz(charged, ["A 1 1 1 0.5", "A 2 2 2 1"]),
        &["particle 1 of `A` with other charges than 0.5"],
    );
    let path = place.path().join("bonded.gsd");
    let mut file = GsdWriter::create(&path, "test", "hoomd", (1, 4)).unwrap();
    file.write("configuration/box", [[4.0_f32], [4.0], [4.0], [0.0], [0.0], [0.0]]).unwrap();
    file.write("particles/N", [[2_u32]]).unwrap();
    file.write("particles/position", [[0.0_f32; 3], [1.0; 3]]).unwrap();
    file.write("bonds/N", [[1_u32]]).unwrap();
    file.write("bonds/group", [[0_u32, 7]]).unwrap();
    file.end_frame();
    file.sync().unwrap();
    drop(file);
    fails(&["export", path.to_str().unwrap()], 5, &["found bond 0-7", "not there"]);
    let alike = export("alike.xyz", &xyz(charged, ["A#1 1 1 1 0.5", "A#1 2 2 2 0.5"]));
    let said = succeeds(&alike.each_ref().map(String::as_str));
    assert!(said.contains("2 particles, without masses of `A#1`: they are 1"), "{said}");
    let data = fs::read_to_string(place.path().join("alike.xyz.data")).unwrap();
    assert!(data.contains("Atom Type Labels\n\n1 A_1\n") && data.contains("\n2 2 1 0.5 2 2 2\n"), "{data}");
}

fn changed_seed(text: &Value) -> Checked {
    scene::parse("melt", &text.to_string(), &["seed=6".to_owned()]).unwrap()
}

/// Positions and velocities of double precision give every bit again, in both versions of the file layer.
#[test]
fn double_precision_keeps_every_bit() {
    let place = tempfile::tempdir().unwrap();
    let mut text = melt();
    text["space"]["box"] = json!([4, 5, 6]);
    text["interactions"].as_array_mut().unwrap().truncate(1);
    text["particles"][0]["chain"] = Value::Null;
    let written = scene::parse("melt", &text.to_string(), &[]).unwrap();
    let (model, state) = start(&written);
    let units = model.units;
    let path = place.path().join("a.gsd");
    let mut file = GsdWriter::create(&path, "test", "hoomd", (1, 4)).unwrap();
    file.write("configuration/box", [[4.0_f32], [5.0], [6.0], [0.0], [0.0], [0.0]]).unwrap();
    file.write("particles/N", [[state.len() as u32]]).unwrap();
    let name = |text: &str| -> [u8; 16] { std::array::from_fn(|at| text.as_bytes().get(at).copied().unwrap_or(0)) };
    file.write("particles/types", [name("a solvent"), name("C")]).unwrap();
    file.write("particles/typeid", state.species.iter().map(|species| [1 - species])).unwrap();
    file.write("particles/mass", state.species.iter().map(|species| [[1.5_f32, 1.0][*species as usize]])).unwrap();
    let centred = |fraction: &[u32; 3]| -> [f64; 3] {
        let position = units.position(*fraction);
        std::array::from_fn(|axis| position[axis] - 0.5 * units.lengths[axis])
    };
    file.write("particles/position", state.positions.iter().map(centred)).unwrap();
    let masses = [1.5, 1.0];
    let velocity = |id: usize| units.momentum(state.momenta[id]).map(|part| part / masses[state.species[id] as usize]);
    file.write("particles/velocity", (0..state.len()).map(velocity)).unwrap();
    file.end_frame();
    file.sync().unwrap();
    drop(file);
    let asked = with_state(&text, json!({"file": "a.gsd"}));
    let again = || State { images: Vec::new(), ..start(&load(place.path(), &asked).0).1 };
    assert_eq!(again(), State { images: Vec::new(), ..state.clone() });
    // The first version has a field of 64 bytes for every name.
    let mut content = bytes(&path);
    let word = |content: &[u8], at: usize| u64::from_le_bytes(content[at..at + 8].try_into().unwrap()) as usize;
    let (names, length) = (word(&content, 24), 64 * word(&content, 32));
    let packed: Vec<Vec<u8>> = content[names..names + length].split(|byte| *byte == 0).map(<[u8]>::to_vec).collect();
    content[names..names + length].fill(0);
    for (place, name) in packed.iter().take_while(|name| !name.is_empty()).enumerate() {
        content[names + 64 * place..][..name.len()].copy_from_slice(name);
    }
    content[44..48].copy_from_slice(&(1_u32 << 16).to_le_bytes());
    fs::write(&path, content).unwrap();
    assert_eq!(again(), State { images: Vec::new(), ..state });
}

/// Three beads and a solvent in any order, with comments and images.
const LAMMPS: &str = "LAMMPS data file, written by hand

4 atoms
2 atom types
2 bonds
2 bond types
1 angles
1 angle types

-2 6 xlo xhi   # an edge of 8
0 4 ylo yhi
0 2 zlo zhi

Masses

2 3   # solvent
1 1.5

Pair Coeffs

1 25 4.5
2 25 4.5

Atoms # molecular

30 1 1 5.5 1 1 0 0 0
10 1 1 -1.5 1 1 1 0 0   # over the boundary
20 1 1 -0.5 1 1.5 1 0 -2
7 2 2 2 3 0.5

Velocities

7 0.25 0 0
10 1 0 0
20 0 -1 0
30 0 0 0.5

Bonds

1 1 30 10
2 2 10 20

Angles

1 1 30 10 20
";

#[test]
fn a_file_of_lammps_is_what_it_says() {
    let place = tempfile::tempdir().unwrap();
    let partial = place.path().join("init.data");
    fs::write(&partial, LAMMPS).unwrap();
    let asked = json!({
        "title": "by hand",
        "time": {"step": 0.01, "steps": 10},
        "temperature": 1,
        "state": {"file": "init.data"},
        "particles": [{"species": "bead"}, {"species": "solvent"}],
        "interactions": [
            {"type": "bonds", "types": ["2"], "potential": {"type": "harmonic", "stiffness": 5}},
            {"type": "angles", "stiffness": 1},
        ],
        "output": {"trajectory": {"every": 10}},
    });
    let told = scene::load(write(place.path(), &asked).as_str(), &[]).unwrap_err().to_string();
    assert!(told.contains("found images of 3 of 4 atoms"), "{told}");
    fs::write(&partial, LAMMPS.replace("7 2 2 2 3 0.5\n", "7 2 2 2 3 0.5 0 0 0\n")).unwrap();
    let (scene, notices) = load(place.path(), &asked);
    let (model, state) = start(&scene);
    // By their ids: 7, 10, 20, 30.
    let eighth = 1 << 29;
    let x = |place: u32| place * (eighth / 2);
    assert_eq!(
        state.positions,
        [[x(8), 3 << 30, 1 << 30], [x(1), 1 << 30, 1 << 31], [x(3), 1 << 30, 3 << 30], [x(15), 1 << 30, 1 << 31]]
    );
    assert_eq!(state.species, [1, 0, 0, 0]);
    assert_eq!(state.images, [[0; 3], [1, 0, 0], [1, 0, -2], [0; 3]]);
    let velocities: Vec<[f64; 3]> = (0..4)
        .map(|id| model.units.momentum(state.momenta[id]).map(|part| part / [1.5, 3.0][state.species[id] as usize]))
        .collect();
    assert_eq!(velocities, [[0.25, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 0.5]]);
    let masses: Vec<f64> = model.species.iter().map(|species| species.mass).collect();
    assert_eq!((model.units.lengths, masses), ([8.0, 4.0, 2.0], vec![1.5, 3.0]));
    let bonds: Vec<[u32; 2]> = model.particles().bonds.as_ref().unwrap().iter().map(|bond| bond.ends).collect();
    let angles: Vec<[u32; 3]> = model.particles().angles.as_ref().unwrap().iter().map(|angle| angle.ends).collect();
    assert_eq!((bonds, angles), (vec![[1, 2]], vec![[3, 1, 2]]));
    let said: Vec<String> = notices.iter().map(ToString::to_string).collect();
    assert_eq!(said, ["state.file: not used of `init.data`: the section `Pair Coeffs`; bonds of type `1`"]);
    let momentum = mesoscope::families::warnings(&scene).iter().map(ToString::to_string).collect::<Vec<_>>();
    assert!(
        momentum.iter().any(|warning| warning.contains("add up to a momentum of (2.250000, -1.500000, 0.750000)")),
        "{momentum:?}"
    );
}

fn write(directory: &Path, scene: &Value) -> String {
    let path = directory.join("scene.json");
    fs::write(&path, scene.to_string()).unwrap();
    path.to_str().unwrap().to_owned()
}

/// Copies of a box are what the box is, over and over: the energy is as many times as large, whatever crosses the boundary.
#[test]
fn copies_of_a_box_are_like_the_box() {
    let place = tempfile::tempdir().unwrap();
    let text = melt();
    let written = scene::parse("melt", &text.to_string(), &[]).unwrap();
    let (model, state) = start(&written);
    fs::create_dir(place.path().join("run")).unwrap();
    let path = place.path().join("run").join(files::CHECKPOINT);
    checkpoint::save(&path, Id::of_run(&written), &written, &state, &[], &[]).unwrap();
    let crossing = model.particles().bonds.as_ref().unwrap().iter().filter(|bond| {
        let [a, b] = bond.ends.map(|end| state.positions[end as usize]);
        mesoscope::state::crossings(a, b) != [0; 3]
    });
    assert!(crossing.count() > 3, "bonds cross the boundary");
    let one = Reference::new(model, state.clone());
    let alone = one.observe().unwrap();
    let [energy, kinetic] = [alone.potential_energy, alone.kinetic_energy];
    let (scene, _) = load(place.path(), &with_state(&text, json!({"file": "run", "replicate": [2, 1, 3]})));
    let lengths = [2.0 * 4.1, 5.3, 3.0 * 6.7];
    assert!((0..3).all(|axis| (scene.space.lengths[axis] - lengths[axis]).abs() < 1e-12), "{:?}", scene.space);
    let (model, six) = start(&scene);
    assert_eq!((six.len(), model.particles().bonds.as_ref().unwrap().count()), (900, 6 * 48));
    let seen = Reference::new(model, six).observe().unwrap();
    // Positions are rounded to 2⁻³² of an edge, which changes no energy by more than a part in 10⁷.
    let ratio = seen.potential_energy / energy;
    assert!((ratio / 6.0 - 1.0).abs() < 1e-7, "{ratio}");
    assert!((seen.kinetic_energy / kinetic / 6.0 - 1.0).abs() < 1e-12);
    // Neighbours along the first axis are those of the box too.
    let fluid = json!([{"type": "dpd", "repulsion": 25, "friction": 4.5}]);
    let mut simple = with_state(&text, json!({"file": "run"}));
    simple["interactions"] = fluid;
    let counted = |asked: &Value| {
        let (model, state) = start(&load(place.path(), asked).0);
        Reference::new(model, state).radial_distribution(1.5, 3)
    };
    let single = counted(&simple);
    simple["state"]["replicate"] = json!([3, 1, 1]);
    assert_eq!(counted(&simple), single.iter().map(|pairs| 3 * pairs).collect::<Vec<_>>());
}

/// Velocities of Maxwell's distribution are those of any other scene, and leave nothing of the momentum.
#[test]
fn velocities_are_drawn_where_that_is_asked_for() {
    let place = tempfile::tempdir().unwrap();
    let text = melt();
    let written = scene::parse("melt", &text.to_string(), &[]).unwrap();
    let (_, state) = start(&written);
    fs::create_dir(place.path().join("run")).unwrap();
    let path = place.path().join("run").join(files::CHECKPOINT);
    checkpoint::save(&path, Id::of_run(&written), &written, &state, &[], &[]).unwrap();
    let asked = |velocities: &str| {
        start(&load(place.path(), &with_state(&text, json!({"file": "run", "velocities": velocities}))).0).1
    };
    let thermal = asked("thermal");
    assert_eq!(asked("thermal"), thermal, "the same seed draws the same");
    assert!(
        thermal.momenta != state.momenta && thermal.total_momentum() == [0; 3],
        "others than those of the run before"
    );
    assert_eq!(asked("rest").momenta, [[0; 3]; 150]);
    let changed = with_state(&text, json!({"file": "run", "velocities": "thermal"}));
    let other = start(&scene::load(&write(place.path(), &changed), &["seed=8".to_owned()]).unwrap()).1;
    assert!(other.momenta != thermal.momenta && other.positions == state.positions);
    assert_eq!(other.total_momentum(), [0; 3]);
}

/// Particles of a run stay tied to where they were tied, in every copy to the point that is near, whatever becomes of velocities. What
/// a new run has no use for, or begins anew, is said.
#[test]
fn tethers_of_a_run_go_on() {
    let place = tempfile::tempdir().unwrap();
    let text = json!({
        "title": "tethered",
        "space": {"box": [4.1, 5.3, 6.7]},
        "time": {"step": 0.01, "steps": 10},
        "temperature": 1,
        "particles": [{"species": "A", "count": 60}],
        "interactions": [
            {"type": "tether", "stiffness": 3},
            {"type": "langevin", "friction": 1, "bath": {"type": "memory", "rate": 2}},
            {"type": "coloured-noise", "strength": 1, "time": 0.05},
        ],
    });
    let written = scene::parse("tethered", &text.to_string(), &[]).unwrap();
    let (model, mut state) = start(&written);
    // Up to an eighth of an edge away from where they started, some of them across the boundary.
    for (id, position) in state.positions.iter_mut().enumerate() {
        *position = position.map(|part| part.wrapping_add((id as u32 % 17) << 26).wrapping_sub(1 << 29));
    }
    let across = state.positions.iter().zip(&state.tethers);
    let across = across.filter(|(position, tether)| mesoscope::state::crossings(**position, **tether) != [0; 3]);
    assert!(across.count() > 3, "tethers cross the boundary");
    fs::create_dir(place.path().join("run")).unwrap();
    let path = place.path().join("run").join(files::CHECKPOINT);
    checkpoint::save(&path, Id::of_run(&written), &written, &state, &[], &[]).unwrap();
    let potential = |model, state| Reference::new(model, state).observe().unwrap().potential_energy;
    let alone = potential(model, state.clone());
    let asked = |state: Value, interactions: &Value| {
        let mut asked = with_state(&text, state);
        asked["interactions"] = interactions.clone();
        load(place.path(), &asked)
    };
    let interactions = &text["interactions"];
    for velocities in ["file", "thermal", "rest"] {
        let (scene, notices) = asked(json!({"file": "run", "velocities": velocities}), interactions);
        let found = start(&scene).1;
        assert!(found.tethers == state.tethers && found.positions == state.positions, "{velocities}");
        if velocities == "file" {
            // It goes on with all that the run had.
            assert_eq!((found, notices), (state.clone(), Vec::new()));
            continue;
        }
        let said = notices[0].message.as_str();
        assert!(said.starts_with("not used of `run`: what its baths remember; its coloured noise"), "{said}");
        assert!(!said.contains("tied"), "{said}");
    }
    // Positions are rounded to 2⁻³² of an edge, which changes no energy by more than a part in 10⁷.
    let (scene, _) = asked(json!({"file": "run", "replicate": [2, 1, 3]}), interactions);
    let (model, six) = start(&scene);
    let ratio = potential(model, six) / alone;
    assert!((ratio / 6.0 - 1.0).abs() < 1e-7, "{ratio}");
    // Without tethers the points are of no use; a run without them ties particles to where they are.
    let fluid = json!([{"type": "dpd", "repulsion": 25, "friction": 4.5}]);
    let (scene, notices) = asked(json!({"file": "run"}), &fluid);
    assert_eq!(start(&scene).1.tethers, <[[u32; 3]; 0]>::default());
    assert!(notices[0].message.ends_with("; the points that its particles are tied to"), "{notices:?}");
    let free = scene.clone();
    fs::create_dir(place.path().join("free")).unwrap();
    let path = place.path().join("free").join(files::CHECKPOINT);
    checkpoint::save(&path, Id::of_run(&free), &free, &start(&free).1, &[], &[]).unwrap();
    let (scene, notices) = asked(json!({"file": "free"}), interactions);
    let tied = start(&scene).1;
    assert!(tied.tethers == tied.positions && tied.positions == state.positions);
    assert_eq!(notices, []);
}

/// The scene of a sheared melt, whose boundaries are displaced by .62 of the box after 40 steps.
fn sheared() -> Value {
    let mut text = melt();
    text["space"]["shear"] = json!({"rate": 1.2, "gradient": "y"});
    text["output"].as_object_mut().unwrap().remove("trajectory");
    text
}

/// A scene that starts from a run, with shear of its own or none.
fn from_sheared(shear: Option<Value>) -> Value {
    let mut asked = with_state(&sheared(), json!({"file": "before"}));
    if let Some(shear) = shear {
        asked["space"] = json!({"box": [4.1, 5.3, 6.7], "shear": shear});
    }
    asked
}

/// Boundaries are where the run before has left them: bonds, angles and neighbours across them are the same, whatever the rate is now.
#[test]
fn a_sheared_run_goes_on_from_where_its_boundaries_are() {
    let place = Place::of(sheared());
    place.run("before", &["--quiet"]);
    let before = checkpoint::load(&place.path("before").join(files::CHECKPOINT)).unwrap();
    let (model, _) = start(&before.scene);
    let crossing = model.particles().bonds.as_ref().unwrap().iter().filter(|bond| {
        let [a, b] = bond.ends.map(|end| before.state.positions[end as usize]);
        mesoscope::state::crossings(a, b)[1] != 0
    });
    assert!(crossing.count() > 1, "bonds cross the boundary");
    // Of a scheme that measures the configuration where the state is, not half a drift later.
    let energy = |scene: &Checked, state: State| {
        let scene =
            edited(scene, |scene| *scene.system.particle_integrator_mut().unwrap() = Integrator::CotterReich {});
        let model = scene.model();
        Reference::new(model.clone(), state).observe().unwrap().potential_energy
    };
    let expected = energy(&before.scene, before.state.clone());
    let directory = place.path("before").parent().unwrap().to_owned();
    for rate in [1.2, -0.3, 0.0] {
        let (scene, _) = load(&directory, &from_sheared(Some(json!({"rate": rate, "gradient": "y"}))));
        let displacement = scene.space.shear.as_ref().unwrap().displacement;
        // 40 steps of .01 at 1.2 × 5.3.
        assert!((displacement - (2.544_f64).rem_euclid(4.1)).abs() < 1e-8, "{displacement}");
        let (_, state) = start(&scene);
        assert_eq!(state.positions, before.state.positions);
        let found = energy(&scene, state);
        assert!((found / expected - 1.0).abs() < 1e-12, "rate {rate}: {found}, {expected}");
        // The resolved scene says it, and is that scene again.
        let text = serde_json::to_string(&scene).unwrap();
        let name = directory.join("scene.json");
        assert_eq!(scene::parse(name.to_str().unwrap(), &text, &[]).unwrap(), scene);
    }
    // Elsewhere, in a box at rest or one that shears along another axis, and in copies, others would be near each other.
    let told = |asked: &Value| scene::load(&write(&directory, asked), &[]).unwrap_err().to_string();
    let rest = told(&from_sheared(None));
    assert!(
        rest.contains("state.file: `before`: found a triclinic box, whose copy above it along y is displaced by 2.54")
            && rest.contains("`space.shear` with the `gradient` y"),
        "{rest}"
    );
    assert_eq!(told(&from_sheared(Some(json!({"rate": 1, "gradient": "z"})))), rest);
    let other = told(&from_sheared(Some(json!({"rate": 1, "gradient": "y", "displacement": 1.5}))));
    assert!(other.contains("space.shear.displacement: found 1.5; accepted: 2.54"), "{other}");
    let mut copies = from_sheared(Some(json!({"rate": 1, "gradient": "y"})));
    copies["space"]["box"] = json!([8.2, 5.3, 6.7]);
    copies["state"]["replicate"] = json!([2, 1, 1]);
    let copied = told(&copies);
    assert!(
        copied.contains("state.replicate: found copies of a box whose boundaries are displaced by 2.54"),
        "{copied}"
    );
}

/// Frames of a sheared run have the cell that leans as far as boundaries are displaced, with all particles in it: in it pairs have the energy
/// that the run has measured, but for the rounding of positions to 2⁻²⁴ of 6.7, which changes forces of up to 25 in 500 pairs by less than .01.
#[test]
fn frames_of_a_sheared_run_lean() {
    for (format, file, shear, side, split) in [
        ("gsd", "before/trajectory.gsd", json!({"rate": 1.2, "gradient": "y"}), 1, true),
        ("extended-xyz", "before/trajectory.xyz", json!({"rate": -1.2, "gradient": "z"}), 2, true),
        ("gsd", "before/trajectory.gsd", json!({"rate": 1.2, "gradient": "z"}), 2, false),
    ] {
        let mut text = sheared();
        text["space"]["shear"] = shear.clone();
        text["output"]["trajectory"] = json!({"every": 10, "format": format});
        text["interactions"].as_array_mut().unwrap().truncate(1);
        text["integrator"] = json!({"type": if split { "splitting" } else { "groot-warren" }});
        let place = Place::of(text);
        place.run("before", &["--quiet"]);
        let measured = *place.table("before", files::ENERGIES).column("potential_energy").unwrap().last().unwrap();
        let last = checkpoint::load(&place.path("before").join(files::CHECKPOINT)).unwrap();
        let directory = place.path("before").parent().unwrap().to_owned();
        let mut asked = from_sheared(Some(shear));
        asked["state"]["file"] = json!(file);
        asked["interactions"].as_array_mut().unwrap().truncate(1);
        // Where energies are those of the positions of the step.
        asked["integrator"] = json!({"type": "groot-warren"});
        let solvent = if format == "gsd" { "a solvent" } else { "a_solvent" };
        asked["particles"] = json!([{"species": "C"}, {"species": solvent}]);
        let scene = load(&directory, &asked).0;
        let (model, state) = start(&scene);
        // The shorter way round the box is as good.
        let velocity = scene.space.shear.as_ref().unwrap().rate * scene.space.lengths[side];
        let boxes = (scene.space.shear.as_ref().unwrap().displacement - velocity * 0.4) / 4.1;
        assert!((boxes - boxes.round()).abs() < 1e-6, "{format}: {boxes}");
        let found = Reference::new(model, state.clone()).observe().unwrap().potential_energy;
        // That of a split step is measured half a drift later.
        assert!(split || (found - measured).abs() < 0.01, "{format}: {found}, {measured} in the run");
        assert!(state.images.is_empty() && last.state.images.is_empty());
        let apart = difference(&last.state, &state)[0];
        assert!(apart <= 4.0 * 2.0_f64.powi(-24), "{format}: {apart}");
        if format == "extended-xyz" {
            let frames = fs::read_to_string(place.path(file)).unwrap();
            let lines: Vec<&str> = frames.lines().collect();
            let mut tilts = Vec::new();
            for frame in lines.chunks_exact(152) {
                assert!(!frame[1].contains("map_shift"), "{}", frame[1]);
                let lattice: Vec<f64> =
                    frame[1].split('"').nth(1).unwrap().split(' ').map(|number| number.parse().unwrap()).collect();
                let lean = lattice[3 * side];
                assert!(lean.abs() <= 0.5 * 4.1 + 1e-9 && lattice[3 * (3 - side)] == 0.0, "{lattice:?}");
                tilts.push(lean);
                for line in &frame[2..] {
                    let place: Vec<f64> =
                        line.split(' ').skip(1).take(3).map(|number| number.parse().unwrap()).collect();
                    let upright = place[0] - lean * place[side] / lattice[4 * side];
                    assert!((-1e-5..4.1 + 1e-5).contains(&upright), "{line} in {lattice:?}");
                }
            }
            // Every ten steps by 1.2 · 6.7 · .1, taken round the box.
            let expected = [0.0, -0.804, -1.608, 4.1 - 2.412, 4.1 - 3.216];
            assert!(tilts.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6), "{tilts:?}");
            assert_eq!(tilts.len(), 5);
        }
    }
}

/// A run with displaced boundaries keeps its bits in parts, and momentum including that lost at sheared boundaries.
#[test]
fn a_run_with_displaced_boundaries_in_parts() {
    let place = Place::of(sheared());
    place.run("before", &["--quiet"]);
    let mut next = from_sheared(Some(json!({"rate": 2, "gradient": "y"})));
    next["state"]["file"] = json!(place.argument("before"));
    let next = Place::of(next);
    next.whole_again_and_in_parts();
    let conserved = next.summary("whole").conserved_exactly;
    assert!(conserved.iter().any(|what| what.contains("including that lost at sheared boundaries")), "{conserved:?}");
}

/// Between walls nothing is periodic: a run is read back as it was, and its frames to the precision of the format.
#[test]
fn a_run_between_walls_is_read_back() {
    let mut text = melt();
    text["space"]["walls"] = json!({"z": {"upper_velocity": [0.5, 0, 0]}});
    let place = Place::of(text.clone());
    place.run("before", &["--quiet"]);
    let last = checkpoint::load(&place.path("before").join(files::CHECKPOINT)).unwrap().state;
    let directory = place.path("before").parent().unwrap().to_owned();
    // Momenta of frames are those of the report, less than a step from those of the checkpoint.
    for (file, tolerances) in [("before", [0.0, 0.0]), ("before/trajectory.gsd", [4.0 * 2.0_f64.powi(-24), 0.8])] {
        let mut asked = with_state(&text, json!({"file": file}));
        asked["space"] = text["space"].clone();
        let (scene, _) = load(&directory, &asked);
        let (_, found) = start(&scene);
        let apart = difference(&last, &found);
        assert!(apart[0] <= tolerances[0] && apart[1] <= tolerances[1], "{file}: {apart:?}");
        assert_eq!(found.walls.len(), 2, "{file}");
        let anew = found.walls.iter().all(|wall| wall.momentum() == [0; 3]);
        assert!(if file == "before" { found.walls == last.walls } else { anew }, "{file}: what walls took up");
    }
    // A layer follows the particles of the file, which are where they were, though the space behind the walls is wider.
    let layer =
        json!({"species": "wall", "count": 90, "placement": {"type": "behind-walls", "axis": "z", "thickness": 1}});
    for file in ["before", "before/trajectory.gsd"] {
        let mut asked = with_state(&text, json!({"file": file}));
        asked["space"] = text["space"].clone();
        asked["particles"].as_array_mut().unwrap().push(layer.clone());
        let (model, found) = start(&load(&directory, &asked).0);
        assert_eq!((found.len(), last.len(), &found.species[150..]), (240, 150, &[2; 90][..]), "{file}");
        let (before, _) = start(&scene::parse("before", &text.to_string(), &[]).unwrap());
        for (id, place) in found.positions.iter().enumerate() {
            let place = model.units.position(*place);
            let inside = (0.0..6.7).contains(&place[2]);
            assert_eq!(inside, id < 150, "{file}: particle {id} at {place:?}");
            if let Some(old) = last.positions.get(id) {
                let old = before.units.position(*old);
                assert!((0..3).all(|axis| (old[axis] - place[axis]).abs() < 3e-6), "{file}: {old:?} {place:?}");
            }
        }
    }
    // Without walls the same places are in a box that is periodic, where its ends are next to each other.
    let mut asked = with_state(&text, json!({"file": "before/trajectory.gsd"}));
    asked["interactions"].as_array_mut().unwrap().truncate(1);
    assert!(start(&load(&directory, &asked).0).1.walls.is_empty());
}

/// What lies behind walls is in no scene that starts from a file.
#[test]
fn layers_of_frozen_particles_are_refused() {
    for format in ["gsd", "extended-xyz"] {
        let mut text = melt();
        text["space"]["walls"] = json!({"z": {}});
        text["particles"].as_array_mut().unwrap().push(
            json!({"species": "wall", "count": 90, "placement": {"type": "behind-walls", "axis": "z", "thickness": 1}}),
        );
        text["output"]["trajectory"]["format"] = json!(format);
        let place = Place::of(text.clone());
        place.run("before", &["--quiet"]);
        let directory = place.path("before").parent().unwrap().to_owned();
        let trajectory = if format == "gsd" { "before/trajectory.gsd" } else { "before/trajectory.xyz" };
        for file in ["before", trajectory] {
            // With a box and walls, and with that of the file.
            for space in [json!({"box": [4.1, 5.3, 6.7], "walls": {"z": {}}}), Value::Null] {
                let mut asked = with_state(&text, json!({"file": file}));
                asked["particles"][2].as_object_mut().unwrap().remove("placement");
                if !space.is_null() {
                    asked["space"] = space;
                }
                let told = scene::load(&write(&directory, &asked), &[]).unwrap_err().to_string();
                assert!(
                    told.contains("found a run with layers of frozen particles, 90 of them, behind its walls")
                        && told.contains("`behind-walls` places them anew"),
                    "{file}: {told}"
                );
            }
        }
    }
}

/// A run in two parts, the file gone in between, leaves the bytes of one that was not interrupted.
#[test]
fn a_run_goes_on_without_its_file() {
    let origin = tempfile::tempdir().unwrap();
    let text = melt();
    let written = scene::parse("melt", &text.to_string(), &[]).unwrap();
    let (_, state) = start(&written);
    let place =
        Place::of(with_state(&text, json!({"file": "before", "replicate": [1, 2, 1], "velocities": "thermal"})));
    fs::create_dir(place.path("before")).unwrap();
    checkpoint::save(&place.path("before").join(files::CHECKPOINT), Id::of_run(&written), &written, &state, &[], &[])
        .unwrap();
    place.run("whole", &["--quiet"]);
    place.run("parts", &["--quiet", "--steps", "20"]);
    fs::rename(place.path("before"), origin.path().join("elsewhere")).unwrap();
    let scene = place.argument("scene.json");
    fails(&["run", &scene, "--out", &place.argument("none")], 2, &["state.file: `before`: it cannot be read"]);
    succeeds(&["resume", &place.argument("parts"), "--steps", "40", "--quiet"]);
    succeeds(&["plot", &place.argument("parts"), "--set", "output.plot.theme=dark"]);
    for name in [files::ENERGIES, files::TRAJECTORY_GSD, files::CHECKPOINT] {
        let [whole, parts] = ["whole", "parts"].map(|run| bytes(&place.path(run).join(name)));
        assert!(whole == parts, "{name} differs");
    }
    let summary = place.summary("parts");
    assert_eq!(summary.scene.state.as_ref().unwrap().checksum.as_ref().unwrap().len(), 8);
    assert_eq!(summary.scene, place.summary("whole").scene);
    // What it keeps of the file can be damaged too.
    let found = checkpoint::load(&place.path("parts").join(files::CHECKPOINT)).unwrap();
    assert_eq!(found.scene.start().unwrap().particles(), 300);
    let mut without = found.scene.clone().into_scene();
    without.kept = KeptStart::default();
    checkpoint::save(
        &place.path("parts").join(files::CHECKPOINT),
        found.run_id,
        &without,
        &found.state,
        &found.files,
        &found.sections,
    )
    .unwrap();
    fails(
        &["resume", &place.argument("parts"), "--steps", "60"],
        5,
        &["what it keeps of the start of its particles makes no sense"],
    );
}

/// Planes and lines: what a file has of further axes is not used, and said to be so.
#[test]
fn fewer_dimensions() {
    let place = tempfile::tempdir().unwrap();
    let text =
        "2\nLattice=\"4 0 0 0 5 0 0 0 6\" Properties=species:S:1:pos:R:3:velo:R:3\nA 1 1 3 0 0 1\nA 2 2 3 0 0 1\n";
    fs::write(place.path().join("a.xyz"), text).unwrap();
    let mut asked = json!({
        "title": "flat",
        "space": {"box": [4, 5]},
        "time": {"step": 0.01, "steps": 10},
        "temperature": 1,
        "state": {"file": "a.xyz"},
        "particles": [{"species": "A"}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
    });
    let (scene, notices) = load(place.path(), &asked);
    assert_eq!(start(&scene).1.positions, [[1 << 30, 858_993_459, 0], [1 << 31, 1_717_986_918, 0]]);
    assert_eq!(start(&scene).1.momenta, [[0; 3]; 2]);
    assert_eq!(notices[0].message, "not used of `a.xyz`: what it says along z, for the scene has 2 dimensions");
    fs::write(place.path().join("a.xyz"), text.replace("velo:R:3", "velo:R:3 pbc=\"T T F\"")).unwrap();
    asked.as_object_mut().unwrap().remove("space");
    assert_eq!(load(place.path(), &asked).0.space.lengths, [4.0, 5.0]);
    // Along z the box has an end, which a scene cannot have.
    asked["space"] = json!({"box": [4, 5, 6]});
    let told = scene::load(write(place.path(), &asked).as_str(), &[]).unwrap_err().to_string();
    assert!(told.contains("state.file: `a.xyz`: found a box that is not periodic along z; accepted: "), "{told}");
}
