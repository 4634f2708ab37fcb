//! Simulations that are advanced, looked at and changed step by step: against engines and runs, to the bit.

use std::time::Duration;

use mesoscope::Simulation;
use mesoscope::engine::Engine;
use mesoscope::families::initial_state;
use mesoscope::gpu::{ConstantsIn, GpuError};
use mesoscope::output::{files, read_table};
use mesoscope::plan::{Hardware, Options};
use mesoscope::run::{self, Interrupt, Run, RunError};
use mesoscope::scene::Checked;
use mesoscope::state::State;
use serde_json::json;

use crate::support::{
    COTTER_REICH, ENERGY, GROOT_WARREN, INTEGRATORS, PREDICTED, SPLITTING, adapter, built_in, cells, edited, fluid,
    gpu, oscillators, water,
};

fn simulation(scene: &Checked) -> Simulation {
    Simulation::new(scene, &adapter()).unwrap()
}

/// One scene of each kind, small.
fn scenes() -> Vec<(&'static str, Checked)> {
    let longer = |(name, scene): (&'static str, Checked)| {
        (name, edited(&scene, |scene| (scene.time.steps, scene.time.equilibration) = (100, 0)))
    };
    kinds().into_iter().map(longer).collect()
}

fn kinds() -> Vec<(&'static str, Checked)> {
    let chain = ["time.steps=100", "output={}"];
    let sheared = r#"space.shear={"rate":0.7,"gradient":"y","displacement":1.1}"#;
    vec![
        ("splitting", fluid(&[SPLITTING, r#"output.stress={"every":7}"#])),
        ("Groot and Warren", fluid(&[GROOT_WARREN])),
        ("predicted", fluid(&[PREDICTED])),
        ("Cotter and Reich", fluid(&[COTTER_REICH])),
        ("memory", fluid(&[r#"interactions.0.bath={"type":"memory","rate":3}"#])),
        ("shear", fluid(&[SPLITTING, sheared, r#"output.stress={"every":7}"#])),
        ("walls", built_in("couette", &["space.box=[6,6,6]", "output={}"])),
        ("oscillators", oscillators(&[])),
        ("chain", built_in("harmonic-chain", &chain)),
        ("water", water(&[])),
        ("cells", cells(64, &[])),
        ("cells with energies", cells(64, &[ENERGY])),
    ]
}

/// The state after some steps that nobody looks at.
fn unseen(scene: &Checked, steps: u64) -> State {
    let plan = run::plan(scene, Hardware::from(gpu()), Options::default().with_room(scene.model().particle_count()));
    let mut engine = Engine::new(gpu(), plan, &initial_state(scene)).unwrap();
    engine.advance(steps, 7).unwrap();
    engine.state().unwrap()
}

/// A state without the turns round the box, which are counted where somebody looks only.
fn unturned(state: &State) -> State {
    State { images: Vec::new(), ..state.clone() }
}

#[test]
fn looking_changes_no_bit() {
    for (name, scene) in scenes() {
        let mut simulation = simulation(&scene);
        let frames: Vec<_> = simulation.frames(11, 3).collect::<Result<_, _>>().unwrap();
        assert_eq!(frames.iter().map(|frame| frame.step).collect::<Vec<_>>(), [3, 6, 9, 11], "{name}");
        simulation.advance(9).unwrap();
        simulation.observables().unwrap();
        simulation.frame().unwrap();
        assert!(unturned(&simulation.state().unwrap()) == unturned(&unseen(&scene, 20)), "{name}");
    }
}

/// Frames are those of trajectories, and observables the rows of tables.
#[test]
fn a_simulation_sees_what_a_run_writes() {
    for (name, scene) in scenes() {
        let scene = edited(&scene, |scene| {
            scene.time.steps = 24;
            scene.output.energies.every = 4;
            scene.output.trajectory = serde_json::from_value(json!({"every": 8, "format": "extended-xyz"})).unwrap();
            scene.output.snapshot.is_off = true;
        });
        let root = tempfile::tempdir().unwrap();
        Run::replace(scene.clone(), root.path()).without_pictures().execute(&adapter(), &mut |_| {}).unwrap();
        let table = read_table(&root.path().join(files::ENERGIES)).unwrap();
        let mut simulation = simulation(&scene);
        for row in &table.rows {
            simulation.advance(row[0] as u64 - simulation.step()).unwrap();
            let seen: Vec<f64> = simulation.observables().unwrap().into_iter().map(|(_, value)| value).collect();
            // Numbers of a table are the shortest that read back as they are.
            assert!(same(&seen, &row[1..]), "{name} at {}: {seen:?}, {row:?}", row[0]);
        }
        let kept = simulation.energies();
        assert_eq!(kept.columns, table.columns);
        assert!(kept.rows.iter().zip(&table.rows).all(|(one, other)| same(one, other)), "{name}");
        assert_eq!(kept.rows.len(), table.rows.len(), "{name}");

        let text = std::fs::read_to_string(root.path().join(files::TRAJECTORY_XYZ)).unwrap();
        let mut simulation = Simulation::on(simulation.gpu(), &scene).unwrap();
        let particles = scene.model().particle_count() as usize;
        let lines: Vec<&str> = text.lines().collect();
        for (number, lines) in lines.chunks_exact(particles + 2).enumerate() {
            simulation.advance(8 * number as u64 - simulation.step()).unwrap();
            let frame = simulation.frame().unwrap();
            for (particle, line) in lines[2..].iter().enumerate() {
                let written: Vec<f64> = line.split(' ').skip(1).filter_map(|word| word.parse().ok()).collect();
                let seen = [frame.positions[particle], frame.velocities[particle]].concat();
                // Sheared boxes are written as leaning cells.
                let first = usize::from(name == "shear");
                let close = |(one, other): (&f64, &f64)| (one - other).abs() <= 1e-5 * (1.0 + other.abs());
                assert!(
                    seen[first..].iter().zip(&written[first..6]).all(close),
                    "{name}, {particle}: {seen:?}, {line}"
                );
            }
        }
    }
}

fn same(one: &[f64], other: &[f64]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(one, other)| one == other || one.is_nan() && other.is_nan())
}

#[test]
fn a_checkpoint_goes_on_to_the_bit() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("a.ckpt");
    for (name, scene) in scenes() {
        let mut whole = simulation(&scene);
        whole.advance(13).unwrap();
        whole.checkpoint(&path).unwrap();
        whole.advance(10).unwrap();
        let mut rest = Simulation::from_checkpoint(&path, &adapter()).unwrap();
        assert_eq!((rest.step(), rest.scene().title.as_str()), (13, scene.title.as_str()));
        rest.advance(10).unwrap();
        assert!(whole.state().unwrap() == rest.state().unwrap(), "{name}");
        let [one, other] = [whole, rest].map(|mut simulation| simulation.observables().unwrap());
        let numbers = |seen: Vec<(&str, f64)>| seen.into_iter().map(|(_, value)| value).collect::<Vec<_>>();
        assert!(same(&numbers(one), &numbers(other)), "{name}");
    }
}

/// The checkpoint of a run that followed no particle goes on too.
#[test]
fn a_run_goes_on_step_by_step() {
    let scene = edited(&fluid(&[SPLITTING]), |scene| scene.time.steps = 30);
    let root = tempfile::tempdir().unwrap();
    Run::replace(scene.clone(), root.path()).without_pictures().execute(&adapter(), &mut |_| {}).unwrap();
    let mut simulation = Simulation::from_checkpoint(root.path().join(files::CHECKPOINT), &adapter()).unwrap();
    simulation.advance(10).unwrap();
    assert!(unturned(&simulation.state().unwrap()) == unturned(&unseen(&scene, 40)));
    // Turns round the box are counted from there on.
    assert!(simulation.frame().unwrap().images.iter().flatten().all(|turns| turns.abs() <= 1));
}

/// A scene in which a number is changed goes on as one that had this number from the start would from the same state.
#[test]
fn a_changed_number_is_that_of_another_scene() {
    let walls = ["space.box=[6,6,6]", "output={}"];
    let cases = [
        (fluid(&[SPLITTING]), "interactions.0.friction", 9.0),
        (fluid(&[COTTER_REICH]), "interactions.0.repulsion", 40.0),
        (fluid(&[GROOT_WARREN]), "temperature", 1.3),
        (fluid(&[r#"interactions.0.bath={"type":"memory","rate":3}"#]), "interactions.0.bath.rate", 5.0),
        (oscillators(&[]), "interactions[1].stiffness", 12.0),
        (built_in("couette", &walls), "space.walls.z.upper_velocity.0", 0.3),
    ];
    for (scene, key, value) in cases {
        let scene = edited(&scene, |scene| (scene.time.steps, scene.time.equilibration) = (100, 0));
        let mut simulation = simulation(&scene);
        simulation.advance(12).unwrap();
        let before = simulation.state().unwrap();
        let rounding = simulation.set(key, value).unwrap();
        assert_eq!(rounding.momentum, [0.0; 3], "{key}");
        let after = simulation.state().unwrap();
        let changed = simulation.scene().clone();
        assert_ne!(changed, scene);
        simulation.advance(8).unwrap();
        let [one, other] = [&scene, &changed].map(|scene| scene.model().units.momentum);
        // Where the unit of momentum is another one, the momenta are rounded.
        let before = if one == other { before } else { after };
        let goes_on_as = |simulation: &mut Simulation, before: &State| {
            let options = Options { constants_in: ConstantsIn::Buffer, ..Options::default() };
            let plan = run::plan(simulation.scene(), Hardware::from(gpu()), options.with_room(before.len() as u64));
            let mut engine = Engine::new(gpu(), plan, &unturned(before)).unwrap();
            engine.advance(8, 8).unwrap();
            let [seen, expected] = [&simulation.state().unwrap(), &engine.state().unwrap()].map(unturned);
            assert!(seen == expected, "{key}");
            seen
        };
        let seen = goes_on_as(&mut simulation, &before);
        // Changed once more, the kernels are those that there are.
        assert_eq!(simulation.openings(), 2, "{key}");
        simulation.set(key, 1.01 * value).unwrap();
        assert_eq!(simulation.openings(), 2, "{key}");
        let before = simulation.state().unwrap();
        simulation.advance(8).unwrap();
        goes_on_as(&mut simulation, &before);
        simulation.set(key, value).unwrap();
        simulation.advance(4).unwrap();
        assert!(seen != unturned(&unseen(&scene, 20)), "{key} changes nothing");
        assert_eq!(simulation.changes().iter().map(|change| change.step).collect::<Vec<_>>(), [12, 20, 28]);
        // And is told by a checkpoint.
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join("b.ckpt");
        simulation.checkpoint(&path).unwrap();
        let mut resumed = Simulation::from_checkpoint(&path, &adapter()).unwrap();
        assert_eq!((resumed.changes(), resumed.scene()), (simulation.changes(), &changed));
        resumed.advance(6).unwrap();
        simulation.advance(6).unwrap();
        assert!(resumed.state().unwrap() == simulation.state().unwrap(), "{key}: a checkpoint goes on otherwise");
    }
}

/// Changes are in the summary of a simulation, and in that of a run that starts from its checkpoint, resumed or not.
#[test]
fn changes_are_told_wherever_a_state_goes() {
    let root = tempfile::tempdir().unwrap();
    let path = root.path().join("changed.ckpt");
    let scene = fluid(&[SPLITTING]);
    let mut simulation = simulation(&scene);
    simulation.advance(4).unwrap();
    simulation.set("interactions.0.repulsion", 20).unwrap();
    simulation.advance(3).unwrap();
    simulation.checkpoint(&path).unwrap();
    let told = serde_json::to_value(simulation.changes()).unwrap();
    assert_eq!(
        (&told[0]["step"], &told[0]["key"], &told[0]["value"]),
        (&json!(4), &json!("interactions.0.repulsion"), &json!(20))
    );
    let read = |path: &std::path::Path| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
    };
    let summary = root.path().join("run.json");
    simulation.summary(&summary).unwrap();
    let written = read(&summary);
    assert_eq!((&written["changes"], &written["steps"]), (&told, &json!(7)));
    assert_eq!(written["scene"]["interactions"][0]["repulsion"], json!(20.0));
    assert!(written["means"]["temperature"]["value"].is_null() && written["wall_seconds"].as_f64().unwrap() > 0.0);

    let state = format!("state={}", json!({"file": path}));
    let started = fluid(&[SPLITTING, "interactions.0.repulsion=20", "particles=[{\"species\":\"A\"}]", &state]);
    let species = &scene.particles[0].species;
    assert_eq!(started.particles[0].species, *species);
    let directory = root.path().join("run");
    Run::replace(edited(&started, |scene| scene.time.steps = 5), &directory)
        .without_pictures()
        .execute(&adapter(), &mut |_| {})
        .unwrap();
    assert_eq!(read(&directory.join(files::SUMMARY))["start"]["changes"], told);
    Run::resume(&directory, Some(9)).unwrap().without_pictures().execute(&adapter(), &mut |_| {}).unwrap();
    let resumed = read(&directory.join(files::SUMMARY));
    assert_eq!((&resumed["start"]["changes"], &resumed["steps"]), (&told, &json!(9)));
    // Further changes are added to these by whoever goes on.
    let mut further = Simulation::from_checkpoint(directory.join(files::CHECKPOINT), &adapter()).unwrap();
    further.set("temperature", 1.25).unwrap();
    further.checkpoint(&path).unwrap();
    let again = fluid(&[
        SPLITTING,
        "interactions.0.repulsion=20",
        "temperature=1.25",
        "particles=[{\"species\":\"A\"}]",
        &state,
    ]);
    let all = again.start().unwrap().changes.iter().map(|change| change.key.as_str()).collect::<Vec<_>>();
    assert_eq!(all, ["interactions.0.repulsion", "temperature"]);
}

/// Means are of what goes on now.
#[test]
fn means_begin_anew_with_a_change() {
    let scene = edited(&fluid(&[SPLITTING]), |scene| scene.output.energies.every = 10);
    let mut simulation = simulation(&scene);
    simulation.advance(200).unwrap();
    let mean = |simulation: &Simulation, name: &str| {
        simulation.means().into_iter().find(|(known, _)| *known == name).and_then(|(_, mean)| mean)
    };
    assert_eq!(mean(&simulation, "temperature").unwrap().samples, 21);
    simulation.set("temperature", 4.0).unwrap();
    assert_eq!(mean(&simulation, "temperature"), None);
    simulation.advance(300).unwrap();
    for name in ["temperature", "configurational_temperature"] {
        assert_eq!(mean(&simulation, name).unwrap().samples, 30, "{name}");
    }
    assert!(mean(&simulation, "temperature").unwrap().value > 3.0);
    // All rows are in the table.
    assert_eq!(simulation.energies().rows.len(), 51);
}

/// Boundaries that shear at another rate move on from where they are.
#[test]
fn a_shear_rate_changes_without_a_jump() {
    for displacement in ["", r#","displacement":1.1"#] {
        let scene = fluid(&[SPLITTING, &format!(r#"space.shear={{"rate":0.7,"gradient":"y"{displacement}}}"#)]);
        let mut simulation = simulation(&scene);
        simulation.advance(50).unwrap();
        let before = simulation.frame().unwrap();
        assert_eq!((before.unwrapped(0), &before.periodic[..]), (None, &[true; 3][..]));
        let before = before.displacement.unwrap().1;
        simulation.set("space.shear.rate", -0.3).unwrap();
        let after = simulation.frame().unwrap().displacement.unwrap().1;
        assert!((before - after).abs() < 1e-8, "{before}, {after}");
        simulation.advance(25).unwrap();
        let later = simulation.frame().unwrap().displacement.unwrap().1;
        // At 25 steps of .04 the copy above has gone back by .3 of the height of 5, perhaps over a boundary.
        assert!(
            ((after - later).rem_euclid(simulation.scene().space.lengths[0]) - 1.5).abs() < 1e-6,
            "{after}, {later}"
        );
    }
}

/// A larger unit of momentum rounds the momenta, and leaves their sum.
#[test]
fn a_hotter_scene_has_larger_units() {
    let scene = fluid(&[SPLITTING]);
    let mut simulation = simulation(&scene);
    simulation.advance(5).unwrap();
    let unit = |scene: &Checked| scene.model().units.momentum;
    let before = simulation.frame().unwrap();
    let rounding = simulation.set("temperature", 100).unwrap();
    let larger = unit(simulation.scene());
    assert!(larger > unit(&scene), "{larger}");
    let after = simulation.state().unwrap();
    assert_eq!((after.total_momentum(), rounding.momentum), ([0; 3], [0.0; 3]));
    assert_eq!(rounding.largest, 0.5 * larger);
    for (one, other) in simulation.frame().unwrap().velocities.iter().zip(&before.velocities) {
        // A report of a split step adds half a kick, whose noise is that of the new temperature.
        assert!(one.iter().zip(other).all(|(one, other)| (one - other).abs() < 20.0));
    }
    // Sums that a scene keeps cannot be rounded so, nor energies of cells, whose unit follows from the temperature.
    let walls = built_in("couette", &["space.box=[6,6,6]", "output={}"]);
    let mut simulation = self::simulation(&cells(64, &[ENERGY]));
    let refusal = simulation.set("temperature", 50.0).unwrap_err().to_string();
    assert!(refusal.contains("cannot be converted"), "{refusal}");
    let mut simulation = self::simulation(&walls);
    let refusal = simulation.set("temperature", 1e4).unwrap_err().to_string();
    assert!(refusal.contains("cannot be converted; accepted: values that need no other unit"), "{refusal}");
    simulation.advance(1).unwrap();
}

/// Units are those of the largest values that a scene announces: up to these no change rounds anything, whatever else
/// is kept in them.
#[test]
fn announced_numbers_change_no_unit() {
    let walls = ["space.box=[6,6,6]", "output={}"];
    let heavy = r#"particles=[{"species":"A","number_density":2},{"species":"B","number_density":1,"mass":9}]"#;
    let cases = [
        (fluid(&[SPLITTING]), "temperature", 16.0),
        (built_in("couette", &walls), "temperature", 16.0),
        (built_in("couette", &walls), "space.walls.z.upper_velocity.0", 40.0),
        // Units of energies follow from heavy particles where these are the warm ones, and else from light ones.
        (built_in("couette", &[&walls[..], &[heavy]].concat()), "temperature", 16.0),
        (cells(64, &[ENERGY]), "temperature", 50.0),
        (oscillators(&[]), "temperature", 64.0),
        (water(&[]), "temperature", 10.0),
    ];
    for (scene, key, largest) in cases {
        let announcing = |largest: f64| {
            let announced = json!([{"key": key, "largest": largest}]);
            edited(&scene, |scene| scene.announced = serde_json::from_value(announced).unwrap())
        };
        let unit = |scene: &Checked| scene.model().units.momentum;
        let announced = announcing(largest);
        assert!(unit(&announced) > unit(&scene), "{key}");
        let mut simulation = simulation(&announced);
        simulation.advance(6).unwrap();
        let before = simulation.state().unwrap();
        for part in [1.0, 0.1, 0.9] {
            let rounding = simulation.set(key, part * largest).unwrap();
            assert_eq!((rounding.largest, rounding.momentum), (0.0, [0.0; 3]), "{key} {part}");
            assert_eq!(unit(simulation.scene()), unit(&announced), "{key} {part}");
            assert!(simulation.state().unwrap().momenta == before.momenta, "{key} {part}");
        }
        assert_eq!(simulation.scene().announced, announced.announced);
        assert_eq!(simulation.openings(), 1, "{key} opens an engine again");
        // A run of the scene has the same bits.
        let mut simulation = self::simulation(&announced);
        simulation.advance(20).unwrap();
        assert!(unturned(&simulation.state().unwrap()) == unturned(&unseen(&announced, 20)), "{key}");
    }
}

#[test]
fn velocities_and_positions_can_be_set() {
    for integrator in INTEGRATORS.iter().chain(&[r#"interactions.0.bath={"type":"memory","rate":3}"#]) {
        let scene = fluid(&[integrator]);
        let mut simulation = simulation(&scene);
        for steps in [0, 7] {
            simulation.advance(steps).unwrap();
            let frame = simulation.frame().unwrap();
            let wanted: Vec<[f64; 3]> =
                (0..frame.velocities.len()).map(|id| [0.1, -0.2, 0.3].map(|v| v * ((id % 7) as f64 - 3.0))).collect();
            let rounding = simulation.set_velocities(&wanted).unwrap();
            let unit = scene.model().units.momentum;
            assert!(rounding.largest <= 2.0 * unit, "{integrator} at {steps}: {rounding:?}, {unit}");
            let found = simulation.frame().unwrap();
            for (found, wanted) in found.velocities.iter().zip(&wanted) {
                assert!(found.iter().zip(wanted).all(|(one, other)| (one - other).abs() <= 2.0 * unit), "{integrator}");
            }
            assert_eq!(found.positions, frame.positions);
            let moved: Vec<[f64; 3]> = frame.positions.iter().map(|[x, y, z]| [*y, *z, *x]).collect();
            let rounding = simulation.set_positions(&moved).unwrap();
            assert!(rounding.largest <= 5.0 / 2_f64.powi(32), "{rounding:?}");
            let found = simulation.frame().unwrap();
            for (found, moved) in found.positions.iter().zip(&moved) {
                assert!(
                    found.iter().zip(moved).all(|(one, other)| (one - other).abs() <= rounding.largest),
                    "{integrator}"
                );
            }
            simulation.advance(5).unwrap();
            let momentum = simulation.state().unwrap().total_momentum();
            let expected: [f64; 3] = std::array::from_fn(|axis| wanted.iter().map(|velocity| velocity[axis]).sum());
            let found = momentum.map(|sum| sum as f64 * unit);
            let rounded = |(one, other): (&f64, &f64)| (one - other).abs() <= 2.0 * unit * wanted.len() as f64;
            assert!(found.iter().zip(&expected).all(rounded), "{integrator}: {found:?}, {expected:?}");
        }
    }
}

/// A state that is set again where it is goes on as it would have.
#[test]
fn positions_that_stay_change_no_bit() {
    for scene in
        [fluid(&[SPLITTING]), fluid(&[COTTER_REICH]), fluid(&[r#"interactions.0.bath={"type":"memory","rate":3}"#])]
    {
        let mut simulation = simulation(&scene);
        simulation.advance(9).unwrap();
        let frame = simulation.frame().unwrap();
        simulation.set_positions(&frame.positions).unwrap();
        simulation.advance(6).unwrap();
        assert!(unanchored(&simulation.state().unwrap()) == unanchored(&unseen(&scene, 15)));
    }
}

/// A state without the places where neighbours were listed either.
fn unanchored(state: &State) -> State {
    State { images: Vec::new(), anchors: Vec::new(), ..state.clone() }
}

#[test]
fn what_does_not_fit_is_named() {
    let scene = fluid(&[COTTER_REICH]);
    let mut simulation = simulation(&scene);
    let frame = simulation.frame().unwrap();
    let refused = |ended: Result<_, RunError>| match ended {
        Err(RunError::Arrays { mistakes }) => mistakes.join("\n"),
        other => panic!("{other:?}"),
    };
    let mut wrong = frame.velocities.clone();
    (wrong[3][0], wrong[7][1]) = (f64::NAN, f64::INFINITY);
    assert_eq!(
        refused(simulation.set_velocities(&wrong)),
        "particle 3, 7 is not finite: the first has (NaN, 0.0, 0.0)".replace(
            "0.0, 0.0",
            &format!("{}, {}", mesoscope::numbers::short(wrong[3][1]), mesoscope::numbers::short(wrong[3][2]))
        )
    );
    assert!(refused(simulation.set_velocities(&wrong[1..])).starts_with("found 374 particles; accepted: 375"));
    let mut fast = frame.velocities.clone();
    fast[0][2] = 1e12;
    assert!(refused(simulation.set_velocities(&fast)).contains("particle 0 is too fast for the unit of momentum"));
    let mut outside = frame.positions.clone();
    outside.iter_mut().take(12).for_each(|position| position[1] = 5.5);
    let found = refused(simulation.set_positions(&outside));
    assert!(found.starts_with("particle 0, 1, 2, 3, 4, 5, 6, 7 and 4 more lies outside of the box"), "{found}");
    let mut hot = self::simulation(&cells(64, &[ENERGY]));
    let still = vec![[0.0; 3]; 64];
    assert!(refused(hot.set_velocities(&still)).contains("keep account of kinetic and internal energy together"));
    for key in ["time.step", "space.box.0", "seed", "particles.0.number_density", "title"] {
        assert!(refused(simulation.set(key, 2)).contains("cannot change between steps"), "{key}");
    }
    assert!(refused(simulation.set("interactions.0.bath", json!({"type": "memory", "rate": 3}))).contains("no number"));
    let wrong = simulation.set("interactions.0.repulsion", json!("much")).unwrap_err();
    assert!(wrong.to_string().contains("interactions[0].repulsion: found the text \"much\""), "{wrong}");
    let unknown = simulation.set("interactions.0.repulsoin", 3).unwrap_err();
    assert!(unknown.to_string().contains("did you mean `repulsion`?"), "{unknown}");
    assert!(simulation.changes().is_empty());
    // After all of this it is what it was.
    simulation.advance(20).unwrap();
    assert!(unturned(&simulation.state().unwrap()) == unturned(&unseen(&scene, 20)));
}

#[test]
fn a_simulation_that_became_unstable_says_so_again() {
    let scene = fluid(&[COTTER_REICH]);
    let mut simulation = simulation(&scene);
    let fast = vec![[4e4, 0.0, 0.0]; 375];
    let _ = simulation.set_velocities(&fast);
    let error = simulation.set("interactions.0.repulsion", 1e7).and_then(|_| simulation.advance(500)).unwrap_err();
    assert!(matches!(error, RunError::UnstableTrial(_)), "{error}");
    let again = simulation.advance(1).unwrap_err();
    assert!(again.to_string().starts_with("this simulation has ended: "), "{again}");
    assert!(matches!(simulation.frame(), Err(RunError::Ended { .. })));
}

#[test]
fn an_interrupt_and_the_clock_stop_between_steps() {
    let scene = fluid(&[SPLITTING, "space.box=[12,12,12]"]);
    let interrupt = Interrupt::default();
    let mut simulation = simulation(&scene).until(&interrupt);
    let mut done = 0;
    while done < 400 {
        let steps = simulation.advance_within(400 - done, Duration::from_millis(20)).unwrap();
        assert!(steps > 0);
        done += steps;
    }
    interrupt.ask();
    let paused = simulation.advance(1_000_000).unwrap_err();
    assert!(matches!(paused, RunError::Paused { step } if step == simulation.step()), "{paused}");
    let reached = simulation.step();
    assert!(unturned(&simulation.state().unwrap()) == unturned(&unseen(&scene, reached)));
}

/// Several simulations, each in a thread of its own with a device of its own, and two on one device.
#[test]
fn several_simulations_at_once_have_their_own_bits() {
    let scene = fluid(&[SPLITTING]);
    let expected = unturned(&unseen(&scene, 40));
    let bits = |mut simulation: Simulation| {
        simulation.advance(40).unwrap();
        unturned(&simulation.state().unwrap())
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..2).map(|_| scope.spawn(|| bits(self::simulation(&scene)))).collect();
        for thread in threads {
            assert!(thread.join().unwrap() == expected);
        }
    });
    let first = simulation(&scene);
    let second = Simulation::on(first.gpu(), &scene).unwrap();
    assert!(bits(first) == expected && bits(second) == expected);
}

/// A card that is lost in the middle ends what needs it, and the checkpoint before goes on to the bit.
#[test]
fn a_lost_adapter_leaves_the_checkpoint() {
    let scene = fluid(&["time.steps=40"]);
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("before.ckpt");
    let mut lost = simulation(&scene);
    lost.advance(10).unwrap();
    lost.checkpoint(&path).unwrap();
    lost.gpu().device().destroy();
    let error = lost.advance(10).and_then(|()| lost.state().map(drop)).unwrap_err();
    assert!(matches!(error, RunError::Gpu(GpuError::Lost { .. })), "{error:?}");
    let mut again = Simulation::from_checkpoint(&path, &adapter()).unwrap();
    again.advance(10).unwrap();
    assert!(unturned(&again.state().unwrap()) == unturned(&unseen(&scene, 20)));
}
