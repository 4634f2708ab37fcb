//! Files that particles start from, with mistakes: each is refused with its place and what is accepted there. Damaged ones, at
//! random from a seed, are answered without a panic, in bounded time and memory.

use std::fs;
use std::path::Path;

use mesoscope::output::{Id, checkpoint, files};
use mesoscope::run::Run;
use mesoscope::scene::{self, Checked, SceneError};
use mesoscope::state_file::GsdWriter;
use rand::rngs::StdRng;
use rand::{RngExt as _, SeedableRng as _};
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::cost::{MEMORY, PATIENCE, measured};
use crate::support::adapter;

/// Four particles of two species, bonded and bent.
const LAMMPS: &str = "a chain

4 atoms
2 atom types
3 bonds
1 bond types
2 angles
1 angle types

0 4 xlo xhi
0 5 ylo yhi
-1 5 zlo zhi

Atom Type Labels

1 A
2 B

Bond Type Labels

1 backbone

Masses

1 1.5
2 2

Atoms # molecular

3 1 A 2 1 0 0 0 1
1 1 A 1 1 0 0 0 0
4 1 B 3 1 0 -1 0 2
2 1 B 1.5 1.5 0 0 0 0

Velocities

1 0.5 0 0
2 -0.5 0 0
3 0 1 0
4 0 -1 0

Bonds

1 1 1 2
2 backbone 2 3
3 1 3 4

Angles

1 1 1 2 3
2 1 2 3 4
";

const XYZ: &str = "3
Lattice=\"4 0 0 0 5 0 0 0 6\" Properties=species:S:1:pos:R:3:velo:R:3 pbc=\"T T T\"
A 1 1 1 0.5 0 0
B 2 2 2 -0.5 0 0
A 3 3 3 0 0 1
";

/// A scene with the file of a state.
fn text(file: &str, changes: &[(&str, Value)]) -> String {
    let mut scene = json!({
        "title": "from a file",
        "time": {"step": 0.001, "steps": 10},
        "temperature": 1,
        "state": {"file": file},
        "particles": [{"species": "A"}, {"species": "B"}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {"energies": {"every": 10}},
    });
    for (pointer, value) in changes {
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        match scene.pointer_mut(parent).unwrap() {
            Value::Array(list) => list.push(value.clone()),
            object => object[key] = value.clone(),
        }
    }
    scene.to_string()
}

/// A directory with a scene and a file.
struct Place(TempDir);

impl Place {
    fn of(name: &str, content: impl AsRef<[u8]>) -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        fs::write(place.path().join(name), content).unwrap();
        place
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn load(&self, file: &str, changes: &[(&str, Value)]) -> Result<Checked, SceneError> {
        let scene = self.path().join("scene.json");
        fs::write(&scene, text(file, changes)).unwrap();
        scene::load(scene.to_str().unwrap(), &[])
    }

    /// All that is said of the scene.
    #[track_caller]
    fn problems(&self, file: &str, changes: &[(&str, Value)]) -> Vec<String> {
        match self.load(file, changes) {
            Err(SceneError::Invalid { problems, .. }) => problems.iter().map(ToString::to_string).collect(),
            other => panic!("{other:?}"),
        }
    }
}

/// What is said of one mistake in a file of this text.
#[track_caller]
fn refused(content: &str, changes: &[(&str, Value)], expected: &[&str]) {
    let place = Place::of("init", content);
    let found = place.problems("init", changes);
    assert_eq!(found, expected);
}

/// The file with a part replaced; the part is there.
#[track_caller]
fn replaced(text: &str, part: &str, with: &str) -> String {
    assert!(text.contains(part), "{part}");
    text.replacen(part, with, 1)
}

#[test]
fn right_files_are_accepted() {
    for (content, particles, lengths) in [(LAMMPS, 4, [4.0, 5.0, 6.0]), (XYZ, 3, [4.0, 5.0, 6.0])] {
        let scene = Place::of("init", content).load("init", &[]).unwrap();
        let model = scene.model();
        assert_eq!((model.particle_count(), scene.space.lengths.as_slice()), (particles, lengths.as_slice()));
    }
}

#[test]
fn files_that_are_none() {
    let formats = "accepted: a file in GSD, extended XYZ or the data format of LAMMPS, or the directory of a run with a checkpoint";
    let place = Place::of("init", "what is this?\n");
    let foreign = format!("state.file: `init`: it is in none of the formats that can be read; {formats}");
    assert_eq!(place.problems("init", &[]), [foreign]);
    let missing = place.problems("other", &[]);
    assert!(missing[0].starts_with("state.file: `other`: it cannot be read ("), "{missing:?}");
    fs::write(place.path().join("empty"), "").unwrap();
    assert_eq!(place.problems("empty", &[]), [format!("state.file: `empty`: it is empty; {formats}")]);
    fs::create_dir(place.path().join("results")).unwrap();
    assert_eq!(
        place.problems("results", &[]),
        [
            "state.file: `results`: the directory has no `checkpoint.bin`: no run has saved its state there; accepted: the \
          directory of a run with a checkpoint, or a file"
        ]
    );
    fs::write(place.path().join("results/checkpoint.bin"), b"MESOCKPTxx").unwrap();
    let cut = place.problems("results", &[]);
    assert!(
        cut[0].starts_with("state.file: `results`: it should have 28 bytes and has 10: it was cut short"),
        "{cut:?}"
    );
}

/// A pipe would be waited for.
#[cfg(unix)]
#[test]
fn pipes_are_not_opened() {
    let place = Place::of("other", "");
    fs::create_dir(place.path().join("run")).unwrap();
    for name in ["pipe", "run/checkpoint.bin"] {
        let made = std::process::Command::new("mkfifo").arg(place.path().join(name)).status().unwrap();
        assert!(made.success(), "{made}");
    }
    let (sender, receiver) = std::sync::mpsc::channel();
    std::thread::spawn(move || ["pipe", "run"].map(|name| sender.send(place.problems(name, &[]))));
    for name in ["pipe", "run"] {
        let found = receiver.recv_timeout(PATIENCE).unwrap();
        assert!(found[0].starts_with(&format!("state.file: `{name}`: it cannot be read (")), "{found:?}");
        assert!(found[0].contains("it is not a regular file"), "{found:?}");
    }
}

/// The title of a LAMMPS file may be a number, and the second line of an XYZ file anything.
#[test]
fn formats_that_look_alike() {
    assert!(Place::of("init", replaced(LAMMPS, "a chain", "2024")).load("init", &[]).is_ok());
    let plain = "4 \n4 atoms\nA 1 1 1\nB 2 2 2\nA 3 3 3\nB 3 3 1\n";
    let changes = [("/space", json!({"box": [4, 4, 4]})), ("/state/velocities", json!("thermal"))];
    let loaded = Place::of("init", plain).load("init", &changes);
    assert!(loaded.is_ok(), "{loaded:?}");
}

#[test]
fn files_that_end_too_early() {
    let lines = |text: &str, count: usize| text.lines().take(count).fold(String::new(), |all, line| all + line + "\n");
    refused(
        &lines(XYZ, 4),
        &[],
        &["state.file: `init`, line 4: frame 0 ends after 2 of 3 particles; accepted: a whole file"],
    );
    let second_cut = format!("{XYZ}{}", lines(XYZ, 3));
    refused(
        &second_cut,
        &[],
        &[
            "state.file: `init`, line 8: frame 1 ends after 1 of 3 particles; accepted: a whole file, or an earlier frame: \
           `\"frame\": 0` is the last whole one",
        ],
    );
    assert!(Place::of("init", &second_cut).load("init", &[("/state/frame", json!(0))]).is_ok());
    refused(
        &lines(LAMMPS, 32),
        &[],
        &[
            "state.file: `init`, line 32: the section `Atoms` ends after 3 of 4 lines; accepted: as many lines as the header announces",
        ],
    );
    refused(
        &replaced(LAMMPS, "4 atoms", "4000000000 atoms"),
        &[],
        &[&format!(
            "state.file: `init`, line 3: found `4000000000 atoms`; accepted: a whole number, no more than fit in a file of {} bytes",
            LAMMPS.len() + 9
        )],
    );
    refused(
        &replaced(XYZ, "3\n", "4000000000\n"),
        &[],
        &[&format!(
            "state.file: `init`, line 1: found 4000000000 particles in a file of {} bytes; accepted: a whole file",
            XYZ.len() + 9
        )],
    );
}

/// Wherever a GSD file is cut, what is missing is said, and where a whole one can be had.
#[test]
fn gsd_that_ends_too_early() {
    let place = Place::of("other", "");
    let path = place.path().join("init.gsd");
    gsd(&path, 0, 1, 0.0);
    let whole = fs::read(&path).unwrap();
    let unbonded = [("/interactions", json!([]))];
    assert!(place.load("init.gsd", &unbonded).is_ok());
    for length in [12, 100, 255, 256, whole.len() / 2, whole.len() - 1] {
        fs::write(&path, &whole[..length]).unwrap();
        let found = place.problems("init.gsd", &unbonded);
        assert!(
            found.len() == 1 && found[0].contains("accepted: a whole GSD file") && found[0].contains("end"),
            "{length} of {} bytes: {found:?}",
            whole.len()
        );
    }
}

/// Runs of other families have more than a file of particles can say.
#[test]
fn states_of_foreign_runs() {
    let run = |scene: Checked| {
        let place = Place::of("other", "");
        let state = mesoscope::families::initial_state(&scene);
        fs::create_dir(place.path().join("run")).unwrap();
        let path = place.path().join("run").join(files::CHECKPOINT);
        checkpoint::save(&path, Id::of_run(&scene), &scene, &state, &[], &[]).unwrap();
        place
    };
    let flat = |edge: u32, temperature: f64, interaction: Value| {
        let scene = json!({"title": "foreign", "space": {"box": [edge, edge]}, "time": {"step": 0.001, "steps": 1},
            "temperature": temperature, "particles": [{"species": "A", "count": 100}], "interactions": [interaction]});
        scene::parse("foreign", &scene.to_string(), &[]).unwrap()
    };
    for (name, scene) in [
        ("voronoi", flat(9, 1.0, json!({"type": "voronoi", "viscosity": 1}))),
        ("water", flat(16, 0.0, json!({"type": "shallow-water", "mesh": [16, 16], "wave_speed": 1}))),
        ("chain", scene::load("harmonic-chain", &[]).unwrap()),
    ] {
        let place = run(scene);
        let found = place.problems("run", &[("/space", json!({"box": [9, 9, 9]}))]);
        assert!(
            found.len() == 1
                && found[0].starts_with(
                    "state.file: `run`: found a run whose particles have more than a species, a position and"
                )
                && found[0].ends_with("accepted: a run of particles with forces between them"),
            "{name}: {found:?}"
        );
    }
}

/// Copies beyond what any adapter has room for are refused before memory for them is asked for.
#[test]
fn copies_beyond_the_room_of_the_adapter() {
    let place = Place::of("init", XYZ);
    for copies in [[1000, 1000, 100], [1000, 1000, 1000]] {
        let edges = [4, 5, 6].iter().zip(copies).map(|(edge, copies)| edge * copies).collect::<Vec<u64>>();
        let scene =
            place.load("init", &[("/state/replicate", json!(copies)), ("/space", json!({"box": edges}))]).unwrap();
        let (answer, cost) = measured(|| {
            let results = place.path().join("results");
            Run::replace(scene, &results).execute(&adapter(), &mut |_| {}).unwrap_err().to_string()
        });
        let said = answer.unwrap();
        let copies: u64 = copies.iter().product();
        assert!(
            said.contains(" in a ")
                && said.contains(&format!("fewer than the {copies} copies of `state.replicate` fit")),
            "{said}"
        );
        assert!(cost.time < PATIENCE && cost.memory < MEMORY, "{:?}, {} bytes", cost.time, cost.memory);
        assert!(!place.path().join("results").exists(), "nothing is left of it");
    }
}

#[test]
fn species_that_the_scene_lacks() {
    refused(
        &replaced(XYZ, "B 2", "AA 2"),
        &[],
        &[
            "state.file: `init`: found 1 particle of the species `AA`; did you mean `A`? accepted: the species of some particle \
           group: `A`, `B`; or a group with that `type`",
        ],
    );
    refused(
        &replaced(LAMMPS, "2 B\n\nBond", "1 B\n\nBond"),
        &[],
        &["state.file: `init`, line 17: found `1 B`; accepted: every label and every type once"],
    );
    let unlabelled = LAMMPS.replace("Atom Type Labels\n\n1 A\n2 B\n\n", "").replace(" A ", " 1 ").replace(" B ", " 2 ");
    assert!(Place::of("init", &unlabelled).load("init", &[]).is_ok());
    refused(
        &unlabelled,
        &[("/particles", json!([{"species": "A"}]))],
        &[
            "state.file: `init`: found 2 particles of type `2`; accepted: types 1 to 1, which are the species of the scene in their \
           order: `A`; or labels of types, or a `type` in every group",
        ],
    );
}

#[test]
fn bonds_to_what_is_not_there() {
    let far = replaced(&replaced(LAMMPS, "3 1 3 4", "3 1 3 7"), "2 1 2 3 4", "2 1 9 3 4");
    refused(
        &far,
        &[],
        &[
            "state.file: `init`: found bond 3-7 of atoms that are not there; accepted: ids of the section `Atoms`",
            "state.file: `init`: found angle 9-3-4 of atoms that are not there; accepted: ids of the section `Atoms`",
        ],
    );
    refused(
        &replaced(LAMMPS, "3 1 3 4", "3 1 2 1"),
        &[],
        &["state.file: `init`: found bond 1-2 of type `backbone`, more than once; accepted: every bond once"],
    );
    refused(
        &replaced(LAMMPS, "3 1 3 4", "3 2 3 4"),
        &[],
        &["state.file: `init`, line 46: found `3 2 3 4`; accepted: a type from 1 to 1, or a label"],
    );
    let bonds = json!({"type": "bonds", "types": ["backbones"], "potential": {"type": "harmonic", "stiffness": 4}});
    refused(
        LAMMPS,
        &[("/interactions/-", bonds.clone())],
        &[
            "interactions[1].types[0]: found \"backbones\"; did you mean `backbone`? accepted: a type of bonds in `init`: `backbone`",
        ],
    );
    refused(
        XYZ,
        &[("/interactions/-", bonds)],
        &["interactions[1].types[0]: found \"backbones\"; accepted: no `types`: `init` has no bonds"],
    );
    let all = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}});
    refused(
        XYZ,
        &[("/interactions/-", all)],
        &[
            "interactions[1]: found no bonds in the file of `state`; accepted: a file with bonds, `pairs` of particle ids, or \
           particles with a `chain`",
        ],
    );
}

#[test]
fn ids_and_numbers() {
    refused(
        &replaced(LAMMPS, "\n1 1 A 1 1 0", "\n3 1 A 1 1 0"),
        &[],
        &[
            "state.file: `init`: found atom 3 more than once; accepted: an id of its own for every atom",
            "state.file: `init`: found bond 1-2 of atoms that are not there; accepted: ids of the section `Atoms`",
            "state.file: `init`: found angle 1-2-3 of atoms that are not there; accepted: ids of the section `Atoms`",
        ],
    );
    refused(
        &replaced(XYZ, "A 1 1 1", "A nan 1 1"),
        &[],
        &["state.file: `init`: found particle 0 with positions that are no finite numbers; accepted: finite numbers"],
    );
    refused(
        &replaced(XYZ, "0 0 1", "0 0 inf"),
        &[],
        &["state.file: `init`: found particle 2 with velocities that are no finite numbers; accepted: finite numbers"],
    );
    refused(
        &replaced(LAMMPS, "2 1 B 1.5 1.5 0", "2 1 B 1.5 NaN 0"),
        &[],
        &["state.file: `init`: found particle 2 with positions that are no finite numbers; accepted: finite numbers"],
    );
    refused(
        &replaced(LAMMPS, "4 0 -1 0", "4 0 -inf 0"),
        &[],
        &["state.file: `init`: found particle 4 with velocities that are no finite numbers; accepted: finite numbers"],
    );
    let numbered = replaced(XYZ, "velo:R:3", "velo:R:3:id:I:1:map_shift:I:3");
    let numbered = numbered.replace("0.5 0 0\n", "0.5 0 0 7 0 0 0\n").replace("0 0 1\n", "0 0 1 8 0 0 0\n");
    let numbered = replaced(&numbered, "-0.5 0 0 7", "-0.5 0 0 9");
    assert!(Place::of("init", &numbered).load("init", &[]).is_ok());
    refused(
        &replaced(&numbered, "0 0 1 8", "0 0 1 7"),
        &[],
        &["state.file: `init`: found particle 7 more than once; accepted: a number of its own for every particle"],
    );
    refused(
        &replaced(&numbered, "0 0 1 8 0 0 0", "0 0 1 8 0 -2147483649 0"),
        &[],
        &[
            "state.file: `init`, line 5: found images beyond 32 bits: [0, -2147483649, 0]; accepted: images from -2147483648 to \
           2147483647",
        ],
    );
    refused(
        &replaced(XYZ, "B 2 2 2", "B 2 7 2"),
        &[],
        &[
            "state.file: `init`: found particle 1 at (2, 7, 2) outside the box; accepted: positions inside the box, 0 to 4 × 0 to 5 × \
           0 to 6; or `\"outside\": \"wrap\"` in `state`, which takes them modulo the box and counts the turns in images",
        ],
    );
    refused(
        &replaced(LAMMPS, "3 1 0 -1 0 2", "3 1 0 2147483648 0 0"),
        &[],
        &[
            "state.file: `init`, line 32: found `4 1 B 3 1 0 2147483648 0 0`; accepted: images, whole numbers from -2147483648 to \
           2147483647",
        ],
    );
    refused(
        &replaced(LAMMPS, "2 1 B 1.5 1.5 0 0 0 0", "2 1 B 1.5 1.5x 0 0 0 0"),
        &[],
        &[
            "state.file: `init`, line 33: found `2 1 B 1.5 1.5x 0 0 0 0`; accepted: an id, a molecule, a type, a position (style \
           `molecular`), and three images or none",
        ],
    );
    refused(
        &replaced(LAMMPS, "# molecular", "# sphere"),
        &[],
        &[&format!("state.file: `init`, line 28: found atoms of the style `sphere`; {STYLES}")],
    );
    let heavy = replaced(XYZ, "velo:R:3", "velo:R:3:masses:R:1");
    let heavy = heavy.replace("0 0 1\n", "0 0 1 2\n").replace("0.5 0 0\n", "0.5 0 0 1\n");
    refused(
        &heavy,
        &[],
        &[
            "state.file: `init`: found particle 2 of `A` with other masses than 1; accepted: one mass for a species, greater than \
           zero: give particles of another mass another species",
        ],
    );
}

/// A mass of a type twice leaves another type without one.
#[test]
fn masses_of_lammps() {
    refused(
        &replaced(LAMMPS, "2 2\n", "A 2\n"),
        &[],
        &["state.file: `init`, line 26: found `A 2`; accepted: every type once: type 1 has the mass 1.5"],
    );
    let said = |content: &str, groups: Value| {
        let place = Place::of("init", content);
        let scene = place.path().join("scene.json");
        fs::write(&scene, text("init", &[("/particles", groups)])).unwrap();
        let scene = scene::load(scene.to_str().unwrap(), &[]).unwrap();
        let notices = scene.notices();
        notices.iter().map(ToString::to_string).filter(|notice| notice.contains("mass")).collect::<Vec<_>>()
    };
    let without = replaced(LAMMPS, "Masses\n\n1 1.5\n2 2\n\n", "");
    let (none, heavy) = (json!({"species": "A"}), json!({"species": "B", "mass": 2}));
    assert_eq!(
        said(&without, json!([none, {"species": "B"}])),
        ["state.file: `init` has no masses of `A`, `B`, and `particles` gives none: they are 1"]
    );
    assert_eq!(
        said(&without, json!([none, heavy])),
        ["state.file: `init` has no mass of `A`, and `particles` gives none: it is 1"]
    );
    assert_eq!(said(LAMMPS, json!([none, heavy])), [""; 0]);
}

/// What is accepted in place of other styles of atoms.
const STYLES: &str = "accepted: the styles `atomic`, `bond`, `angle`, `molecular`, `charge`, `full`, `mdpd`, and `hybrid` of these: others \
                      have more than a place, a type and a charge";

/// Four atoms of two types, whose lines have so many columns between the type and the place or, where there is a molecule, around it.
fn atoms(heading: &str, lines: [&str; 4]) -> String {
    format!(
        "title\n\n4 atoms\n2 atom types\n0 8 xlo xhi\n0 8 ylo yhi\n0 8 zlo zhi\n\n{heading}\n\n{}\n",
        lines.join("\n")
    )
}

/// Charges of a file are those of its species, where groups give none; what differs within a species cannot be.
#[test]
fn charges_of_lammps() {
    let alike = ["1 1 1 -.5 1 1 1", "2 1 2 0.5 2 2 2", "3 2 1 -0.5 3 3 3", "4 2 2 0.5 4 4 4"];
    let different = ["1 1 1 0.0 1 1 1", "2 1 2 0.5 2 2 2", "3 2 1 -0.5 3 3 3", "4 2 2 0.5 4 4 4"];
    let read = |lines: [&str; 4], groups: Value, acts: bool| {
        let place = Place::of("init", atoms("Atoms # full", lines));
        let interactions =
            if acts { json!([{"type": "electrostatics", "bjerrum_length": 1, "spacing": 0.6}]) } else { json!([]) };
        let changes = [
            ("/state/velocities", json!("rest")),
            ("/particles", groups),
            ("/interactions", interactions),
            ("/output/structure_factor", json!({"every": 1, "range": 3, "charges": true})),
        ];
        let changes = if acts { &changes[..] } else { &changes[..3] };
        fs::write(place.path().join("scene.json"), text("init", changes)).unwrap();
        let scene = scene::load(place.path().join("scene.json").to_str().unwrap(), &[]);
        match scene {
            Ok(scene) => {
                let charges = scene.model().species.iter().map(|species| species.charge).collect::<Vec<_>>();
                let notices = scene.notices().iter().map(ToString::to_string);
                let notices: Vec<String> = notices.filter(|notice| notice.contains("charge")).collect();
                Ok((charges, notices))
            }
            Err(SceneError::Invalid { problems, .. }) => Err(problems.iter().map(ToString::to_string).collect()),
            Err(error) => panic!("{error}"),
        }
    };
    let (none, given) = (
        json!([{"species": "A"}, {"species": "B"}]),
        |charge: f64| json!([{"species": "A", "charge": -charge}, {"species": "B", "charge": charge}]),
    );
    assert_eq!(read(alike, none.clone(), true), Ok((vec![-0.5, 0.5], Vec::new())));
    assert_eq!(read(alike, none.clone(), false), Ok((vec![-0.5, 0.5], Vec::new())));
    let unused = |name: &str, charge: f64, index: usize, given: f64| {
        format!("state.file: the charge {charge} of `{name}` is not used: particles[{index}] gives {given}")
    };
    let expected = vec![unused("A", -0.5, 0, -1.0), unused("B", 0.5, 1, 1.0)];
    assert_eq!(read(alike, given(1.0), true), Ok((vec![-1.0, 1.0], expected)));
    let differ = "state.file: not used of `init`: charges, which differ within a species".to_owned();
    assert_eq!(read(different, given(1.0), true), Ok((vec![-1.0, 1.0], vec![differ.clone()])));
    assert_eq!(read(different, none.clone(), false), Ok((vec![0.0, 0.0], vec![differ])));
    let refusal = |species: &str, particle: u32, known: &str| {
        format!(
            "state.file: `init`: found particle {particle} of `{species}` with other charges than {known}; accepted: one charge for a \
             species, from -1024 to 1024: give particles of another charge another species"
        )
    };
    assert_eq!(read(different, none.clone(), true), Err(vec![refusal("1", 3, "0")]));
    let large = ["1 1 1 -.5 1 1 1", "2 1 2 1025 2 2 2", "3 2 1 -0.5 3 3 3", "4 2 2 1025 4 4 4"];
    let all = "state.file: `init`: found particles 2, 4 of `2` with other charges than 1025; accepted: one charge for a species, from -1024 \
               to 1024: give particles of another charge another species";
    assert_eq!(read(large, none, true), Err(vec![all.to_owned()]));
}

/// Six columns are a molecule, a charge or a density; only five are of one style. The scene may say which it is.
#[test]
fn styles_of_lammps_are_not_guessed() {
    let plain = ["1 1 1 1 1", "2 2 2 2 2", "3 1 3 3 3", "4 2 4 4 4"];
    let charged = ["1 1 0.0 1 1 1", "2 2 0.5 2 2 2", "3 1 -0.5 3 3 3", "4 2 0.0 4 4 4"];
    let full = ["1 1 1 0.0 1 1 1", "2 1 2 0.5 2 2 2", "3 2 1 -0.5 3 3 3", "4 2 2 0.0 4 4 4"];
    let hybrid = ["1 1 1 1 1 1 0.0", "2 2 2 2 2 1 0.5", "3 1 3 3 3 2 -.5", "4 2 4 4 4 2 0"];
    let thermal = ("/state/velocities", json!("thermal"));
    let read = |content: &str, style: Option<&str>| {
        let place = Place::of("init", content);
        let style = style.map(|style| ("/state/atom_style", json!(style)));
        let changes: Vec<_> = [thermal.clone()].into_iter().chain(style).collect();
        fs::write(place.path().join("scene.json"), text("init", &changes)).unwrap();
        match scene::load(place.path().join("scene.json").to_str().unwrap(), &[]) {
            Ok(scene) => {
                let state = mesoscope::families::initial_state(&scene);
                let unit = 1_u32 << 29;
                assert_eq!(state.positions, [1, 2, 3, 4].map(|place| [place * unit; 3]), "{content}");
                assert_eq!(state.species, [0, 1, 0, 1], "{content}");
                let notices =
                    scene.notices().iter().map(ToString::to_string).filter(|notice| notice.contains("not used"));
                Ok(notices.collect::<Vec<_>>())
            }
            Err(SceneError::Invalid { problems, .. }) => Err(problems.iter().map(ToString::to_string).collect()),
            Err(error) => panic!("{error}"),
        }
    };
    let unused = |what: &str| Ok(vec![format!("state.file: not used of `init`: {what}")]);
    for (heading, lines, style, expected) in [
        ("Atoms", plain, None, Ok(Vec::new())),
        ("Atoms # charge", charged, None, unused("charges, which differ within a species")),
        ("Atoms", charged, Some("charge"), unused("charges, which differ within a species")),
        ("Atoms # of my own", charged, Some("mdpd"), unused("densities")),
        ("Atoms # mdpd", charged, None, unused("densities")),
        ("Atoms #full", full, None, unused("charges, which differ within a species")),
        ("Atoms", full, Some("full"), unused("charges, which differ within a species")),
        ("Atoms # hybrid", hybrid, Some("hybrid molecular charge"), unused("charges, which differ within a species")),
        ("Atoms # hybrid bond charge", hybrid, None, unused("charges, which differ within a species")),
        ("Atoms # atomic", plain, Some("atomic"), Ok(Vec::new())),
    ] {
        assert_eq!(read(&atoms(heading, lines), style), expected, "{heading} {style:?}");
    }
    let example = |style: &str| {
        format!(
            "`\"atom_style\": \"{style}\"` in `state`, or `Atoms # {style}` in the file, with the style that its lines are of"
        )
    };
    for (heading, lines, style, expected) in [
        (
            "Atoms",
            charged,
            None,
            format!(
                "state.file: `init`, line 11: found `Atoms` without a style, and 6 columns, as `bond`, `angle`, `molecular`, `charge`, \
                 `mdpd` have, and others; accepted: {}",
                example("bond")
            ),
        ),
        (
            "Atoms",
            full,
            None,
            format!(
                "state.file: `init`, line 11: found `Atoms` without a style, and 7 columns, as `full` has, and others; accepted: {}",
                example("full")
            ),
        ),
        (
            "Atoms # hybrid",
            hybrid,
            None,
            "state.file: `init`, line 9: found atoms of the style `hybrid`, and not which styles it is made of; accepted: `atom_style` in \
             `state` with all of them, in the order of the input script, such as \"hybrid full mdpd\""
                .to_owned(),
        ),
        (
            "Atoms # charge",
            charged,
            Some("full"),
            "state.file: `init`, line 9: found atoms of the style `charge`, and the `atom_style` \"full\" in `state`; accepted: the style \
             that the file says, or no `atom_style`"
                .to_owned(),
        ),
        ("Atoms # body", plain, None, format!("state.file: `init`, line 9: found atoms of the style `body`; {STYLES}")),
        ("Atoms # mine", plain, None, format!("state.file: `init`, line 9: found atoms of the style `mine`; {STYLES}")),
        ("Atoms", plain, Some("fulll"), format!("state.atom_style: found atoms of the style `fulll`; {STYLES}")),
    ] {
        assert_eq!(read(&atoms(heading, lines), style), Err(vec![expected]), "{heading} {style:?}");
    }
    // A style that lines are not of is found out where a column is none of what it should be.
    let wrong = read(&atoms("Atoms", charged), Some("molecular")).unwrap_err();
    assert!(
        wrong.len() == 4 && wrong[0].contains("line 11: found `1 1 0.0 1 1 1`; accepted: a type from 1 to 2"),
        "{wrong:?}"
    );
    refused(
        XYZ,
        &[("/state/atom_style", json!("full"))],
        &[
            "state.file: `init`: found the `atom_style` \"full\" in `state`, and no data file of LAMMPS; accepted: no `atom_style`",
        ],
    );
}

/// Positions outside the box are taken modulo the box where the scene asks for it, with the turns that they have made, but not across walls.
#[test]
fn positions_outside_are_wrapped() {
    let lines = ["1 1 1 9 1", "2 2 -7.5 2 2", "3 1 3 3 20", "4 2 4 4 4"];
    let turned = ["1 1 1 9 1 0 2 0", "2 2 -7.5 2 2 1 0 0", "3 1 3 3 20 0 0 -1", "4 2 4 4 4 5 0 0"];
    let wrap = |space: Value| {
        let output = json!({"trajectory": {"every": 1}});
        vec![
            ("/state/velocities", json!("thermal")),
            ("/state/outside", json!("wrap")),
            ("/output", output),
            ("/space", space),
        ]
    };
    let whole = json!({"box": [8, 8, 8]});
    let counted = [[0, 1, 0], [-1, 0, 0], [0, 0, 2], [0, 0, 0]];
    let kept = [[0, 3, 0], [0, 0, 0], [0, 0, 1], [5, 0, 0]];
    for (lines, images) in [(lines, counted), (turned, kept)] {
        let scene = Place::of("init", atoms("Atoms # atomic", lines)).load("init", &wrap(whole.clone())).unwrap();
        let state = mesoscope::families::initial_state(&scene);
        let unit = 1_u32 << 28;
        let expected = [[2, 2, 2], [1, 4, 4], [6, 6, 8], [8, 8, 8]];
        assert_eq!(state.positions, expected.map(|place| place.map(|part: u32| part * unit)));
        assert_eq!(state.images, images);
    }
    let place = Place::of("init", atoms("Atoms # atomic", lines));
    let walled = place.problems("init", &wrap(json!({"box": [8, 8, 8], "walls": {"z": {}}})));
    assert!(
        walled.len() == 1
            && walled[0].contains("found particle 3 at (3, 3, 20) outside the box; accepted: positions inside"),
        "{walled:?}"
    );
    let sheared = place.problems("init", &wrap(json!({"box": [8, 8, 8], "shear": {"rate": 1, "gradient": "y"}})));
    assert!(sheared[0].starts_with("state.outside: found \"wrap\" in a scene whose boundaries shear"), "{sheared:?}");
    let far = Place::of("init", atoms("Atoms # atomic", ["1 1 1e9 1 1", "2 2 2 2 2", "3 1 3 3 3", "4 2 4 4 4"]));
    let far = far.problems("init", &wrap(whole));
    assert!(far[0].contains("found particle 1 at (1000000000, 1, 1) outside the box"), "{far:?}");
}

/// Types of a file are those of species by name or, where they are numbers, in their order; a `type` says otherwise.
#[test]
fn types_of_a_file_are_mapped() {
    let numbered = atoms("Atoms # atomic", ["1 1 1 1 1", "2 2 2 2 2", "3 2 3 3 3", "4 2 4 4 4"]);
    let named = XYZ.replace("B 2", "C 2");
    let thermal = ("/state/velocities", json!("thermal"));
    let species = |content: &str, groups: &Value| {
        let place = Place::of("init", content);
        let scene = place.load("init", &[("/particles", groups.clone()), thermal.clone()]);
        scene.map(|scene| {
            let rows = scene.composition();
            // The resolved scene says it again, and is the same.
            let text = serde_json::to_string(&scene).unwrap();
            fs::write(place.path().join("again.json"), text).unwrap();
            let again = scene::load(place.path().join("again.json").to_str().unwrap(), &[]).unwrap();
            assert_eq!((&again.particles, again.start()), (&scene.particles, scene.start()));
            rows[0].1.clone()
        })
    };
    for (content, groups, expected) in [
        (&numbered, json!([{"species": "H"}, {"species": "W"}]), "H 1 (type 1), W 3 (type 2)"),
        (&numbered, json!([{"species": "W"}, {"species": "H"}]), "W 1 (type 1), H 3 (type 2)"),
        (&numbered, json!([{"species": "W", "type": 2}, {"species": "H", "type": "1"}]), "W 3 (type 2), H 1 (type 1)"),
        (&named, json!([{"species": "A"}, {"species": "B", "type": "C"}]), "A 2, B 1 (type C)"),
    ] {
        assert_eq!(species(content, &groups).unwrap(), expected, "{groups}");
    }
    let problems = |content: &str, groups: Value| match species(content, &groups) {
        Err(SceneError::Invalid { problems, .. }) => problems.iter().map(ToString::to_string).collect::<Vec<_>>(),
        other => panic!("{other:?}"),
    };
    for (groups, expected) in [
        (
            json!([{"species": "W", "type": 3}, {"species": "H", "type": 1}]),
            "particles[0].type: found `3`; accepted: a type of `init`: `1`, `2`",
        ),
        (
            json!([{"species": "W", "type": 1}, {"species": "H", "type": 1}]),
            "particles[1].type: found the type `1` for `W` and for `H`; accepted: a type of its own for every species",
        ),
        (
            json!([{"species": "W", "type": 2}, {"species": "H"}]),
            "particles[1].type: missing, and found in another group; accepted: a type of `init` in all groups, or in none: `1`, `2`",
        ),
        (
            json!([{"species": "W", "count": 1, "type": 2}, {"species": "H", "type": 1}]),
            "particles[0].count: found 1 particle; accepted: 3, the number of particles of `W` in `init`, or no `count`",
        ),
    ] {
        assert!(problems(&numbered, groups)[0].starts_with(expected), "{expected}");
    }
    let alone =
        text("init", &[("/state", Value::Null), ("/particles", json!([{"species": "A", "count": 1, "type": 1}]))]);
    let told = scene::parse("test", &alone, &[]).unwrap_err().to_string();
    assert!(told.contains("particles[0].type: found without a `state`"), "{told}");
}

/// The line of keys is read by the specification of the format: what a quote or bracket holds is no key, and what readers do not agree on is
/// refused.
#[test]
fn keys_of_extended_xyz() {
    let frame = |comment: &str| format!("2\n{comment}\nA 1 1 1\nB 5 5 5\n");
    let rest = "Properties=species:S:1:pos:R:3";
    let changes = [("/state/velocities", json!("thermal"))];
    for comment in [
        format!(
            r#"comment="he said \" Lattice='3 0 0 0 3 0 0 0 3' \" twice" Lattice="8 0 0 0 8 0 0 0 8" {rest} pbc="T T T""#
        ),
        format!(
            r#""my Lattice"="2 0 0 0 2 0 0 0 2" "x y"="Properties=pos:R:3" Lattice="8 0 0 0 8 0 0 0 8" {rest} pbc="T T T""#
        ),
        format!(r#"meta={{"cell": {{"a": 1}}, "b": [1,2]}} Lattice="8 0 0 0 8 0 0 0 8" {rest} pbc="T T T""#),
        format!("Lattice=[[8, 0, 0], [0, 8.0, 0], [0, 0, 8d0]] {rest} pbc=[T, T, T]"),
        format!("lattice = {{8 0 0 0 8 0 0 0 8}} {rest} PBC = 1,1,1"),
        format!(r#"note= empty="" Lattice="8 0 0 0 8 0 0 0 8" Lattice="8 0 0 0 8 0 0 0 8" {rest}"#),
        // As ASE 3.29 writes it.
        format!(
            r#"Lattice="8.0 0.0 0.0 0.0 8.0 0.0 0.0 0.0 8.0" {rest} note="made \"by hand\" pbc=F,F,F Lattice=\"2 0 0 0 2 0 0 0 2\""
            empty= nothing "my Lattice"="2 0 0 0 2 0 0 0 2" person="O'Brien" nested="_JSON [[1, 2], [3, 4]]"
            table="_JSON {{\"cell\": {{\"pbc\": [false, true]}}, \"Properties\": \"pos:R:3\"}}" flags="T F" energy=-1.5 pbc="T T T""#
        )
        .replace('\n', " "),
    ] {
        let loaded = Place::of("init", frame(&comment)).load("init", &changes);
        let loaded = loaded.unwrap_or_else(|error| panic!("{comment}: {error}"));
        assert_eq!(loaded.space.lengths, [8.0; 3], "{comment}");
    }
    let place = Place::of("init", frame(r#"a remark "without end, and {brackets"#));
    assert!(place.load("init", &[changes[0].clone(), ("/space", json!({"box": [8, 8, 8]}))]).is_ok());
    for (comment, expected) in [
        (
            format!(r#"Lattice="8 0 0 0 8 0 0 0 8" {rest} note="made \"by hand\" pbc=T,T,T was meant" pbc="F F F""#),
            "state.file: `init`: found a box that is not periodic along x, y and z",
        ),
        (
            format!(r#"Lattice="8 0 0 0 8 0 0 0 8 {rest} pbc="T T T""#),
            "state.file: `init`, line 2: found no blank after ",
        ),
        (
            format!("Lattice=[[8 0 0 0 8 0 0 0 8] {rest}"),
            "state.file: `init`, line 2: found quotes or brackets that do not close",
        ),
        (
            format!(r#"Lattice="8 0 0 0 8 0 0 0 8" {rest} Lattice="3 0 0 0 3 0 0 0 3""#),
            "state.file: `init`, line 2: found Lattice twice, as \"8 0 0 0 8 0 0 0 8\" and as \"3 0 0 0 3 0 0 0 3\"",
        ),
        (
            format!(r#"a='b Lattice="3 0 0 0 3 0 0 0 3"' Lattice="8 0 0 0 8 0 0 0 8" {rest}"#),
            "state.file: `init`, line 2: found Lattice within the value a=",
        ),
    ] {
        let found = Place::of("init", frame(&comment)).problems("init", &changes);
        assert!(found.len() == 1 && found[0].starts_with(expected), "{comment}: {found:?}");
    }
}

/// Species may be named by atomic numbers, which are elements or what the scene calls them.
#[test]
fn atomic_numbers() {
    let numbered = "2\nLattice=\"8 0 0 0 8 0 0 0 8\" Properties=Z:I:1:pos:R:3 pbc=\"T T T\"\n6 1 1 1\n200 2 2 2\n";
    let thermal = ("/state/velocities", json!("thermal"));
    for names in [["C", "200"], ["6", "200"]] {
        let groups = json!([{"species": names[1]}, {"species": names[0]}]);
        let loaded = Place::of("init", numbered).load("init", &[("/particles", groups), thermal.clone()]).unwrap();
        let state = mesoscope::families::initial_state(&loaded);
        assert_eq!(state.species, [1, 0], "{names:?}");
    }
    refused(
        numbered,
        &[thermal.clone(), ("/particles", json!([{"species": "O"}, {"species": "200"}]))],
        &[
            "state.file: `init`: found 1 particle of the species `C`; accepted: the species of some particle group: `O`, `200`; or a group \
           with that `type`",
        ],
    );
    refused(
        &numbered.replace("6 1 1 1", "C 1 1 1"),
        &[thermal],
        &["state.file: `init`, line 3: found `C` in column 1; accepted: an atomic number"],
    );
}

/// Velocities of some atoms, or of one twice, matter where they are used.
#[test]
fn incomplete_velocities_of_lammps() {
    let accepted =
        "accepted: one line for every atom of the section `Atoms`; or `velocities` that are \"thermal\" or \"rest\"";
    for (line, expected) in [
        ("3 0.5 0.5 0", vec!["found more than one velocity of atom 3", "found no velocity of atom 1"]),
        ("8 0.5 0.5 0", vec!["found velocities of atom 8, not in `Atoms`", "found no velocity of atom 1"]),
    ] {
        let content = replaced(LAMMPS, "1 0.5 0 0", line);
        let expected: Vec<String> =
            expected.iter().map(|found| format!("state.file: `init`: {found}; {accepted}")).collect();
        refused(&content, &[], &expected.iter().map(String::as_str).collect::<Vec<_>>());
        for other in ["thermal", "rest"] {
            let loaded = Place::of("init", &content).load("init", &[("/state/velocities", json!(other))]);
            assert!(loaded.is_ok(), "{loaded:?}");
        }
    }
    let endless = replaced(XYZ, "0 0 1\n", "0 0 inf\n");
    assert!(Place::of("init", endless).load("init", &[("/state/velocities", json!("rest"))]).is_ok());
}

/// Forces act across every end of the box of a scene; a file without a box leaves it to the scene.
#[test]
fn boxes_that_are_not_periodic() {
    let accepted =
        "accepted: a box that is periodic along every axis of the scene without `space.walls`: `pbc=\"T T T\"`";
    for (periodic, axes) in [("F F F", "x, y and z"), ("F T T", "x"), ("False True False", "x and z")] {
        refused(
            &replaced(XYZ, "T T T", periodic),
            &[],
            &[&format!("state.file: `init`: found a box that is not periodic along {axes}; {accepted}")],
        );
    }
    let boxless = replaced(&replaced(XYZ, "T T T", "F F F"), "Lattice=\"4 0 0 0 5 0 0 0 6\" ", "");
    assert!(Place::of("init", boxless).load("init", &[("/space", json!({"box": [4, 4, 4]}))]).is_ok());
    // Walls are across the open axes.
    let walled = Place::of("init", replaced(XYZ, "T T T", "T T F"));
    assert!(walled.load("init", &[("/space", json!({"box": [4, 5, 6], "walls": {"z": {}}}))]).is_ok());
    assert!(walled.load("init", &[("/space", json!({"box": [4, 5, 6], "walls": {"y": {}}}))]).is_err());
    for unclear in ["T T", "T T maybe"] {
        refused(
            &replaced(XYZ, "T T T", unclear),
            &[],
            &[&format!(
                "state.file: `init`, line 2: found pbc=\"{unclear}\"; accepted: `T` or `F` for each of three axes"
            )],
        );
    }
}

/// A number that is refused is not compared with the file.
#[test]
fn mistakes_of_a_scene_are_said_alone() {
    let place = Place::of("init", XYZ);
    let told = |changes: &[(&str, Value)]| {
        let found = place.problems("init", changes);
        assert_eq!(found.len(), 1, "{found:?}");
        found[0].split(':').next().unwrap_or_default().to_owned()
    };
    assert_eq!(told(&[("/space", json!({"box": [4, 5, -6]}))]), "space.box[2]");
    assert_eq!(told(&[("/state/frame", json!("last"))]), "state.frame");
    assert_eq!(
        told(&[("/state/replicate", json!([2, 0, 1])), ("/space", json!({"box": [8, 5, 6]}))]),
        "state.replicate[1]"
    );
    assert_eq!(told(&[("/particles", json!([{"species": "A", "count": -2}, {"species": "B"}]))]), "particles[0].count");
    // What is wrong elsewhere hides nothing of the file.
    let both = place.problems("init", &[("/temperature", json!(-1)), ("/state/frame", json!(7))]);
    assert_eq!(both.len(), 2, "{both:?}");
}

#[test]
fn boxes() {
    refused(
        &replaced(LAMMPS, "-1 5 zlo zhi", "-1 5 zlo zhi\n0.5 0 0 xy xz yz"),
        &[],
        &[
            "state.file: `init`, line 13: found a triclinic box (0.5 0 0 xy xz yz); accepted: an orthogonal box: positions are \
           fractions of the edges, which have to be along the axes",
        ],
    );
    assert!(
        Place::of("init", replaced(LAMMPS, "-1 5 zlo zhi", "-1 5 zlo zhi\n0 0 0 xy xz yz")).load("init", &[]).is_ok()
    );
    let tilted = Place::of("init", replaced(XYZ, "0 5 0", "1 5 0")).problems("init", &[]);
    assert!(
        tilted[0].starts_with(
            "state.file: `init`: found a triclinic box, whose copy above it along y is displaced by 1 along x; accepted: an orthogonal box; \
             or `space.shear` with the `gradient` y"
        ),
        "{tilted:?}"
    );
    // Shear tilts one vector along x, and nothing else is taken.
    for lattice in ["4 0 0 1 5 0 1 0 6", "4 0 0 0 5 0 0 1 6", "4 0 0 0 5 1 0 0 6", "4 1 0 0 5 0 0 0 6"] {
        let tilted = Place::of("init", replaced(XYZ, "4 0 0 0 5 0 0 0 6", lattice)).problems("init", &[]);
        assert!(tilted[0].contains("line 2: found a triclinic box (Lattice="), "{tilted:?}");
    }
    refused(
        XYZ,
        &[("/space", json!({"box": [4, 5.1, 6]}))],
        &["space.box[1]: found 5.1; accepted: 5, that of `init`, or no `space` at all"],
    );
    refused(
        XYZ,
        &[("/space", json!({"box": [8, 5, 6]})), ("/state/replicate", json!([2, 2, 1]))],
        &["space.box[1]: found 5; accepted: 10, that of `init` in 2 copies, or no `space` at all"],
    );
    refused(
        &replaced(LAMMPS, "0 4 xlo xhi", "4 0 xlo xhi"),
        &[],
        &["state.file: `init`: found a box with an edge of -4 (`xlo xhi`); accepted: edges of positive length"],
    );
    refused(
        &replaced(XYZ, "Lattice=\"4 0 0 0 5 0 0 0 6\" ", ""),
        &[],
        &["space: missing, and `init` has no box; accepted: an object with `box`, or a file with a `Lattice`"],
    );
    assert!(
        Place::of("init", replaced(XYZ, "Lattice=\"4 0 0 0 5 0 0 0 6\" ", ""))
            .load("init", &[("/space", json!({"box": [4, 4, 4]}))])
            .is_ok()
    );
}

#[test]
fn frames_copies_and_velocities() {
    for frame in [1, -2] {
        refused(
            XYZ,
            &[("/state/frame", json!(frame))],
            &[&format!(
                "state.file: `init`: found frame {frame}; accepted: 0, or -1 from the end: the file has 1 frame"
            )],
        );
    }
    refused(
        LAMMPS,
        &[("/state/frame", json!(3))],
        &["state.file: `init`: found frame 3; accepted: 0, or -1 from the end: the file has 1 frame"],
    );
    refused(
        XYZ,
        &[("/state/replicate", json!([2, 0, 1]))],
        &["state.replicate[1]: found 0; accepted: a whole number from 1 to 4294967295"],
    );
    refused(
        XYZ,
        &[("/state/replicate", json!([2, 2]))],
        &["state.replicate: found a list of 2; accepted: a number of copies for each of the 3 axes"],
    );
    refused(
        XYZ,
        &[("/state/replicate", json!([100_000, 100_000, 1]))],
        &[
            "state.replicate: found 30000000000 particles in 10000000000 copies of 3; accepted: at most 4294967295 particles, since \
           they are numbered by 32-bit words",
        ],
    );
    let still = replaced(&XYZ.replace(" 0.5 0 0\n", "\n").replace(" -0.5 0 0\n", "\n"), " 0 0 1\n", "\n");
    let still = replaced(&still, ":velo:R:3", "");
    refused(
        &still,
        &[],
        &[
            "state.velocities: found \"file\", and no velocities in `init`; accepted: \"thermal\" or \"rest\", or a file with \
           velocities; GSD leaves out those that are all zero",
        ],
    );
    for other in ["thermal", "rest"] {
        assert!(Place::of("init", &still).load("init", &[("/state/velocities", json!(other))]).is_ok());
    }
}

#[test]
fn what_does_not_go_with_a_file() {
    refused(
        XYZ,
        &[
            ("/particles/0", json!(0)),
            ("/particles", json!([{"species": "A", "count": 3}, {"species": "B", "mass": 2}])),
        ],
        &[
            "particles[0].count: found 3 particles; accepted: 2, the number of particles of `A` in `init`, or no `count`",
        ],
    );
    let listed = json!([
        {"species": "A", "placement": {"type": "listed", "positions": [[1, 1, 1]]}, "velocities": {"type": "rest"}}, {"species": "B"}
    ]);
    refused(
        XYZ,
        &[("/particles", listed)],
        &[
            "particles[0].placement: found beside a `state`; accepted: no `placement`: the file of `state` says where particles start",
            "particles[0].velocities: found beside a `state`; accepted: no `velocities`: `state.velocities` is `file`, `thermal` or \
             `rest` for all particles",
        ],
    );
    for (interaction, refusal) in [
        (json!({"type": "voronoi", "form": "paper"}), "state: found in a scene of Voronoi DPD"),
        (
            json!({"type": "shallow-water", "mesh": [16, 16], "wave_speed": 1, "rotation": 1}),
            "state.file: `init`: it has no format that is known; accepted: an `.npz` file",
        ),
    ] {
        let place = Place::of("init", XYZ);
        let found =
            place.problems("init", &[("/interactions", json!([interaction])), ("/space", json!({"box": [4, 5]}))]);
        assert!(found.iter().any(|problem| problem.starts_with(refusal)), "{found:?}");
    }
    refused(
        XYZ,
        &[("/state/checksum", json!("12345678"))],
        &[&format!(
            "state.checksum: found \"12345678\", and \"{}\" of `init`; accepted: the file as it was, or no `checksum`",
            Place::of("init", XYZ).load("init", &[]).unwrap().into_scene().state.unwrap().checksum.unwrap()
        )],
    );
    let place = Place::of("init", XYZ);
    let alone = scene::parse(
        "test",
        &text("init", &[("/state", Value::Null), ("/particles", json!([{"species": "A", "count": 1}]))]),
        &[],
    );
    assert!(alone.unwrap_err().to_string().contains("space: missing; accepted: an object with `box`"));
    let types = json!([{"type": "bonds", "types": ["x"], "pairs": [[0, 1]]}]);
    assert_eq!(place.problems("init", &[("/interactions", types.clone())]).len(), 1, "of types and pairs");
    let chains = json!([{"species": "A", "chain": {"beads": 2}}, {"species": "B"}]);
    let found = place.problems("init", &[("/particles", chains.clone())]);
    assert!(
        found[0]
            .starts_with("particles[0].chain: found, and particle 1 of `init` is not where its group would have it"),
        "{found:?}"
    );
    assert_eq!(
        place.problems("init", &[("/particles", chains), ("/state/replicate", json!([2, 1, 1]))]).last().unwrap(),
        "state.replicate: found, beside particles[0].chain, whose beads follow each other in one box only; accepted: bonds of the \
         file in place of chains; or one copy"
    );
}

/// A frame of GSD: two bonded particles, of which the second has its image at the end.
fn gsd(path: &Path, image: i64, bond: u32, tilt: f32) {
    gsd_with(path, [0.0; 3], image, bond, tilt);
}

/// The same with the first particle elsewhere.
fn gsd_with(path: &Path, first: [f64; 3], image: i64, bond: u32, tilt: f32) {
    let mut file = GsdWriter::create(path, "test", "hoomd", (1, 4)).unwrap();
    file.write("configuration/box", [[4.0_f32], [5.0], [6.0], [tilt], [0.0], [0.0]]).unwrap();
    file.write("particles/N", [[2_u32]]).unwrap();
    file.write("particles/types", [[b'A', 0], [b'B', 0]]).unwrap();
    file.write("particles/typeid", [[0_u32], [1]]).unwrap();
    file.write("particles/position", [first, [1.0, 1.0, 1.0]]).unwrap();
    file.write("particles/velocity", [[0.5_f64, 0.0, 0.0], [-0.5, 0.0, 0.0]]).unwrap();
    file.write("particles/image", [[0_i64, 0, 0], [image, 0, 0]]).unwrap();
    file.write("bonds/N", [[1_u32]]).unwrap();
    file.write("bonds/types", [[b'x', 0]]).unwrap();
    file.write("bonds/typeid", [[0_u32]]).unwrap();
    file.write("bonds/group", [[0_u32, bond]]).unwrap();
    file.end_frame();
    file.sync().unwrap();
}

/// An array without rows lies where the file ends.
#[test]
fn empty_arrays_of_gsd() {
    let place = Place::of("other", "");
    let path = place.path().join("init.gsd");
    let mut file = GsdWriter::create(&path, "test", "hoomd", (1, 4)).unwrap();
    file.write("configuration/box", [[4.0_f32], [5.0], [6.0], [0.0], [0.0], [0.0]]).unwrap();
    file.write("particles/N", [[2_u32]]).unwrap();
    file.write("particles/types", [[b'A', 0], [b'B', 0]]).unwrap();
    file.write("particles/typeid", [[0_u32], [1]]).unwrap();
    file.write("particles/position", [[0.0_f64, 0.0, 0.0], [1.0, 1.0, 1.0]]).unwrap();
    file.write("bonds/N", [[0_u32]]).unwrap();
    file.write("bonds/group", Vec::<[u32; 2]>::new()).unwrap();
    file.end_frame();
    file.sync().unwrap();
    drop(file);
    let unbonded = [("/state/velocities", json!("thermal")), ("/interactions", json!([]))];
    let loaded = place.load("init.gsd", &unbonded);
    assert!(loaded.is_ok(), "{loaded:?}");
}

#[test]
fn frames_of_gsd() {
    let place = Place::of("other", "");
    let path = place.path().join("init.gsd");
    gsd(&path, -2, 1, 0.0);
    assert!(place.load("init.gsd", &[]).is_ok());
    gsd(&path, 1 << 31, 1, 0.0);
    assert_eq!(
        place.problems("init.gsd", &[]),
        [
            "state.file: `init.gsd`, frame 0: found images of particle 1 beyond 32 bits: [2147483648.0, 0.0, 0.0]; accepted: images from \
          -2147483648 to 2147483647"
        ]
    );
    gsd(&path, 0, 7, 0.0);
    assert_eq!(
        place.problems("init.gsd", &[]),
        [
            "state.file: `init.gsd`: found bond 0-7 of type `x`, to particles that are not there; accepted: particles of the file, \
          which has 2"
        ]
    );
    let unbonded = [("/interactions", json!([]))];
    gsd_with(&path, [0.5, f64::NAN, 0.0], 0, 1, 0.0);
    let told = "with positions that are no finite numbers; accepted: finite numbers";
    assert_eq!(place.problems("init.gsd", &unbonded), [format!("state.file: `init.gsd`: found particle 0 {told}")]);
    gsd(&path, 0, 1, 0.25);
    // .25 of an edge of 5.
    let tilted = place.problems("init.gsd", &[]);
    assert!(
        tilted[0].contains("found a triclinic box, whose copy above it along y is displaced by 1.25 along x"),
        "{tilted:?}"
    );
    let sheared =
        [("/space", json!({"box": [4, 5, 6], "shear": {"rate": 1, "gradient": "y"}})), ("/interactions", json!([]))];
    let loaded = place.load("init.gsd", &sheared).unwrap();
    assert!((loaded.space.shear.as_ref().unwrap().displacement - 1.25).abs() < 1e-12);
    let mut file = GsdWriter::create(&path, "test", "other", (1, 4)).unwrap();
    file.end_frame();
    file.sync().unwrap();
    drop(file);
    assert_eq!(
        place.problems("init.gsd", &[]),
        [
            "state.file: `init.gsd`: found the schema `other` in version 1; accepted: a GSD file of the schema `hoomd` in version 1 or 2"
        ]
    );
}

/// Two frames of six particles, of which the second takes what does not change from the first: `tests/data/README.md`.
#[test]
fn a_file_of_gsd_5() {
    let place = Place::of("five.gsd", include_bytes!("../data/gsd-5.gsd"));
    for frame in [0, 1] {
        let output = json!({"trajectory": {"every": 1}});
        let bonds = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}});
        let changes = [("/state/frame", json!(frame)), ("/output", output), ("/interactions/-", bonds)];
        let scene = place.load("five.gsd", &changes).unwrap();
        let model = scene.model();
        let state = mesoscope::families::initial_state(&scene);
        assert_eq!(scene.space.lengths, [4.0, 5.0, 6.0]);
        assert_eq!(state.species, [0, 1, 0, 1, 0, 1]);
        assert_eq!(model.species.iter().map(|species| species.mass).collect::<Vec<_>>(), [1.5, 1.0]);
        assert_eq!(
            model.particles().bonds.as_ref().unwrap().iter().map(|bond| bond.ends).collect::<Vec<_>>(),
            [[0, 1], [2, 3]]
        );
        for particle in 0..6 {
            let (at, step, mass) = (particle as f64, f64::from(frame), model.species[particle % 2].mass);
            let expected = [0.5 * at + 0.75, 0.25 * step + 1.5, 5.0 - 0.5 * at];
            let found = model.units.position(state.positions[particle]);
            assert!(
                found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-8),
                "{particle}: {found:?}, {expected:?}"
            );
            let velocity = [0.125 * at, -0.25, step];
            assert_eq!(model.units.momentum(state.momenta[particle]), velocity.map(|part| mass * part), "{particle}");
            assert_eq!(state.images[particle], [particle as i32, 0, -frame]);
        }
    }
}

/// The file with some bytes changed, taken out, put in or cut off; numbers and lengths among them become extreme.
fn damaged(whole: &[u8], random: &mut StdRng) -> Vec<u8> {
    let mut bytes = whole.to_vec();
    for _ in 0..random.random_range(1..=4) {
        let place = random.random_range(0..bytes.len().max(1)).min(bytes.len());
        match random.random_range(0..6) {
            0 => bytes.truncate(place),
            1 if place < bytes.len() => bytes[place] ^= 1 << random.random_range(0..8),
            2 if place + 8 <= bytes.len() => {
                let word = [0, u64::MAX, 1 << 62, 1 << 32, random.random()][random.random_range(0..5)];
                bytes[place..place + 8].copy_from_slice(&u64::to_le_bytes(word));
            }
            3 => {
                let word = ["999999999999", "-1", "nan", "1e308", "\n", " ", "\"", "0", "#"][random.random_range(0..9)];
                bytes.splice(place..place, word.bytes());
            }
            4 => {
                let end = (place + random.random_range(0..40)).min(bytes.len());
                bytes.drain(place..end);
            }
            _ => {
                let end = (place + random.random_range(0..40)).min(bytes.len());
                let again = bytes[place..end].to_vec();
                bytes.splice(place..place, again);
            }
        }
    }
    bytes
}

fn damaged_files_are_answered(cases: u64) {
    let place = Place::of("xyz", XYZ);
    fs::write(place.path().join("lammps"), LAMMPS).unwrap();
    gsd(&place.path().join("gsd"), 3, 1, 0.0);
    let bonds = json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}});
    let angles = json!({"type": "angles", "stiffness": 1});
    let mut accepted = 0;
    for case in 0..cases {
        let format = ["xyz", "lammps", "gsd"][(case % 3) as usize];
        let whole = fs::read(place.path().join(format)).unwrap();
        let mut random = StdRng::seed_from_u64(case);
        fs::write(place.path().join("init"), damaged(&whole, &mut random)).unwrap();
        let changes = [("/interactions/-", bonds.clone()), ("/interactions/-", angles.clone())];
        let changes = &changes[..[0, 2, 1][(case % 3) as usize]];
        let (answer, cost) = measured(|| {
            let scene = match place.load("init", changes) {
                Ok(scene) => scene,
                Err(SceneError::Invalid { problems, .. }) => {
                    assert!(problems.iter().all(|problem| !problem.path.is_empty()), "{problems:?}");
                    return false;
                }
                Err(error) => panic!("{error}"),
            };
            let model = scene.model();
            mesoscope::families::initial_state(&scene).len() as u64 == model.particle_count()
        });
        let answer = answer.unwrap_or_else(|_| panic!("case {case} of {format} panics"));
        assert!(cost.time < PATIENCE && cost.memory < MEMORY, "case {case}: {:?}, {} bytes", cost.time, cost.memory);
        accepted += u64::from(answer);
    }
    // Much of the text is comments, and many a digit may be another.
    assert!(accepted > cases / 50 && accepted < cases * 9 / 10, "{accepted} of {cases} are accepted");
}

#[test]
fn some_damaged_files() {
    damaged_files_are_answered(300);
}

#[test]
#[ignore = "thousands of files"]
fn many_damaged_files() {
    damaged_files_are_answered(20_000);
}
