//! Runs that start from what others have left: their row 0 is the last row of those, to the last bit where a run goes on unchanged; their
//! noise is another, or goes on.

use std::path::Path;

use mesoscope::engine::{Engine, Stepper};
use mesoscope::output::{Id, TrajectoryWriter, checkpoint, files};
use mesoscope::plan::Options;
use mesoscope::scene::{self, Checked, TrajectoryFormat};
use mesoscope::state::State;
use serde_json::{Value, json};
use tempfile::TempDir;

use crate::support::{
    COTTER_REICH, EVERY_STEP, INTEGRATORS, PREDICTED, SPLITTING, STAGED, changed, edited, engine, fluid, reference,
    reference_of_particles, start,
};

const STEPS: u64 = 7;

/// A scene in a directory that starts from `file` there, with the forces of another scene and changes given as `path=value`.
fn continued(directory: &Path, scene: &Checked, file: &str, changes: &[&str]) -> Checked {
    let mut text = serde_json::to_value(scene).unwrap();
    for group in text["particles"].as_array_mut().unwrap() {
        group.as_object_mut().unwrap().retain(|key, _| key == "species" || key == "mass" || key == "fixed");
    }
    text["state"] = json!({ "file": file });
    // Boundaries that shear are where the file says.
    if let Some(shear) = text.pointer_mut("/space/shear").and_then(Value::as_object_mut) {
        shear.remove("displacement");
    }
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    let name = directory.join("scene.json").display().to_string();
    scene::parse(&name, &text.to_string(), &changes).unwrap_or_else(|error| panic!("{error}"))
}

/// The checkpoint of a run of a scene in a directory.
fn save(directory: &Path, scene: &Checked, state: &State) {
    let path = directory.join("run").join(files::CHECKPOINT);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    checkpoint::save(&path, Id::of_run(scene), scene, state, &[], &[]).unwrap();
}

/// Sums of the report of the current step.
fn report(engine: &mut Engine<'_>) -> Vec<i64> {
    let step = engine.step();
    let rows = engine.finish().unwrap();
    rows.into_iter().find(|row| row.step == step && row.sampler == 0).unwrap().sums
}

/// A run of a scene, and one that goes on with it: the same reports and states, on the device and in the reference.
#[track_caller]
fn goes_on(scene: &Checked) {
    let directory = TempDir::new().unwrap();
    let mut first = engine(scene, &start(scene).1, Options::default());
    first.advance(STEPS, STEPS).unwrap();
    let left = first.state().unwrap();
    save(directory.path(), scene, &left);
    let after = continued(directory.path(), scene, "run", &[]);
    let (model, state) = start(&after);
    assert_eq!((model.steps_before, model.seed), (STEPS, scene.seed));
    assert_eq!(state, State { step: 0, ..left.clone() });

    let mut second = engine(&after, &state, Options::default());
    assert_eq!(report(&mut second), report(&mut first));
    for engine in [&mut first, &mut second] {
        engine.advance(3, 2).unwrap();
    }
    let (expected, found) = (first.state().unwrap(), second.state().unwrap());
    assert_eq!(found, State { step: 3, ..expected });

    let mut twin = reference_of_particles(scene.model().clone(), left);
    let mut next = reference_of_particles(model, state);
    assert_eq!(next.reported().momenta, twin.reported().momenta);
    twin.step(2);
    next.step(2);
    assert_eq!(next.state(), State { step: 2, ..twin.state() });
}

/// Scenes of some particles whose state has something of its own.
const KINDS: &[(&str, &[&str])] = &[
    ("splitting", &[SPLITTING]),
    ("two stages", &[STAGED]),
    ("groot-warren", &[PREDICTED]),
    ("memory of pairs", &[r#"interactions.0.bath={"type":"memory","rate":10}"#]),
    ("shear", &[r#"space.shear={"rate":0.7,"gradient":"y","displacement":1.3}"#, "seed=18446744073709551615"]),
    ("cotter-reich", &[COTTER_REICH]),
    (
        "walls and body force",
        &[
            r#"space.walls={"z":{"lower_velocity":[1,0,0]}}"#,
            r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","force":[0.3,0,0]}]"#,
        ],
    ),
    ("many-body", &[r#"interactions.0.many_body={"repulsion":25,"cutoff":0.75}"#, "interactions.0.repulsion=-40"]),
];

const SMALL: [&str; 2] = ["space.box=[3,3,3]", EVERY_STEP];

fn small(changes: &[&str]) -> Checked {
    fluid(&[&SMALL[..], changes].concat())
}

/// Particles by themselves: baths, tethers and a random force.
fn single(interactions: &str) -> Checked {
    let text = format!(
        r#"{{"title": "test", "space": {{"box": [9, 9, 9]}}, "time": {{"step": 0.05, "steps": 1}}, "temperature": 1.5,
        "particles": [{{"species": "A", "count": 20, "mass": 3}}], "interactions": [{interactions}],
        "output": {{"energies": {{"every": 1}}}}}}"#
    );
    changed(&text, &[])
}

const BEADS: &str = r#"{"title": "test", "space": {"box": [9, 9, 9]}, "time": {"step": 0.02, "steps": 1}, "temperature": 1,
    "particles": [{"species": "A", "count": 20, "chain": {"beads": 5, "spacing": 0.8}}],
    "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5},
        {"type": "bonds", "friction": 2, "potential": {"type": "harmonic", "stiffness": 20, "length": 0.8}},
        {"type": "angles", "stiffness": 1}],
    "output": {"energies": {"every": 1}, "trajectory": {"every": 100}}}"#;

#[test]
fn a_run_goes_on_to_the_last_bit() {
    for (name, changes) in &KINDS[..3] {
        eprintln!("{name}");
        goes_on(&small(changes));
    }
    goes_on(&single(
        r#"{"type": "langevin", "bath": {"type": "memory", "rate": 1, "coupling": 2}}, {"type": "tether", "stiffness": 3}"#,
    ));
}

#[test]
#[ignore = "a minute: what a_run_goes_on_to_the_last_bit shows, of all kinds of scenes"]
fn runs_of_all_kinds_go_on_to_the_last_bit() {
    for (name, changes) in KINDS {
        eprintln!("{name}");
        goes_on(&small(changes));
    }
    for interactions in [
        r#"{"type": "langevin", "friction": 2}, {"type": "tether", "stiffness": 3}"#,
        r#"{"type": "coloured-noise", "process": "kangaroo", "strength": 1, "time": 0.12}"#,
    ] {
        eprintln!("{interactions}");
        goes_on(&single(interactions));
    }
    for bath in [&[][..], &[r#"interactions.1.bath={"type":"memory","rate":5}"#]] {
        goes_on(&changed(BEADS, bath));
    }
}

/// Two on a spring without friction: their kinetic energy after seven steps is known to six digits. A run with another time step starts
/// with it too, whatever the integrator, for velocities in a checkpoint are half a step behind.
#[test]
fn a_run_with_another_step_has_the_velocities_of_the_last_report() {
    let text = r#"{"title": "two on a spring", "space": {"box": [10, 10, 10]}, "time": {"step": 0.05, "steps": 7}, "temperature": 0,
        "particles": [{"species": "a", "placement": {"type": "listed", "positions": [[4.5, 5, 5], [5.5, 5, 5]]},
            "velocities": {"type": "rest"}}],
        "interactions": [{"type": "dpd", "repulsion": 0, "friction": 0},
            {"type": "bonds", "pairs": [[0, 1]], "potential": {"type": "harmonic", "stiffness": 100, "length": 0.8}}]}"#;
    for integrator in [SPLITTING, PREDICTED, COTTER_REICH] {
        let directory = TempDir::new().unwrap();
        let scene = changed(text, &[integrator]);
        let (model, state) = start(&scene);
        let mut run = reference_of_particles(model, state);
        run.step(STEPS);
        save(directory.path(), &scene, &run.state());
        let after = continued(directory.path(), &scene, "run", &["time.step=0.03"]);
        let (model, state) = start(&after);
        let momentum = model.units.momentum(state.momenta[0])[0];
        assert!((momentum * momentum - 1.547_885).abs() < 1e-5, "{integrator}: {}", momentum * momentum);
        assert_eq!((model.steps_before, state.step), (0, 0));
        assert_eq!(state.total_momentum(), [0; 3]);
    }
}

/// The momenta of a fluid with friction that goes on with another repulsion are those of the last report, to a few units of rounding.
#[test]
fn a_fluid_with_other_forces_has_the_velocities_of_the_last_report() {
    for integrator in INTEGRATORS {
        let directory = TempDir::new().unwrap();
        let scene = small(&[integrator]);
        let (model, state) = start(&scene);
        let mut run = reference_of_particles(model, state);
        run.step(STEPS);
        save(directory.path(), &scene, &run.state());
        let (model, state) = start(&continued(directory.path(), &scene, "run", &["interactions.0.repulsion=30"]));
        assert_eq!(state.momenta, run.reported().momenta, "{integrator}");
        assert_eq!((state.positions, state.predicted.len()), (run.state().positions, 0));
        assert_ne!(model.seed, scene.seed);
    }
}

/// A frame has the kinetic energy of its row and the positions where forces are evaluated, on any number of ranks, and a run that
/// starts from it writes it again.
#[test]
fn frames_are_of_one_time_and_are_written_again() {
    for changes in [
        &[SPLITTING][..],
        &[STAGED, r#"space.shear={"rate":0.7,"gradient":"y"}"#, r#"output.profiles={"axis":"y","bins":3,"every":1}"#],
    ] {
        let directory = TempDir::new().unwrap();
        let scene = small(&[changes, &[r#"output.trajectory={"every":100}"#]].concat());
        let (model, state) = start(&scene);
        let mut device = engine(&scene, &state, Options::default());
        device.advance(STEPS, STEPS).unwrap();
        let places = device.state().unwrap().positions;
        let frame = device.frame().unwrap();
        assert_eq!(frame.positions, places);
        assert!(device.state().is_err(), "its particles have been moved on");
        let sheared = model.particles().shear.is_some();
        let rows = device.finish().unwrap();
        let row = rows.iter().rfind(|row| row.sampler == 0).unwrap();
        let row = mesoscope::measure::observables_of(row, device.plan(), &model);
        let squares =
            frame.momenta.iter().map(|momentum| model.units.momentum(*momentum).iter().map(|p| p * p).sum::<f64>());
        let kinetic = 0.5 * squares.sum::<f64>();
        assert!(sheared || (kinetic / row.kinetic_energy - 1.0).abs() < 1e-6, "{kinetic} {}", row.kinetic_energy);
        if sheared {
            // Whether an analysis takes velocities without the flow or not.
            let plain = edited(&scene, |scene| scene.output.profiles = None);
            let mut device = engine(&plain, &state, Options::default());
            device.advance(STEPS, STEPS).unwrap();
            let whole = device.frame().unwrap();
            assert_eq!(whole.positions, frame.positions);
            let shear = model.particles().shear.unwrap();
            for (particle, (momentum, relative)) in whole.momenta.iter().zip(&frame.momenta).enumerate() {
                let flow =
                    shear.flow(frame.species[particle] as usize, frame.positions[particle][shear.gradient], &model);
                assert!((f64::from(momentum[0] - relative[0]) - flow).abs() < 2.0, "{particle}");
                assert_eq!(momentum[1..], relative[1..]);
            }
            continue;
        }
        for format in [TrajectoryFormat::Gsd, TrajectoryFormat::ExtendedXyz] {
            let file = files::trajectory(format);
            let mut trajectory =
                TrajectoryWriter::create(&directory.path().join(file), format, &model, Id::of_run(&scene)).unwrap();
            trajectory.append(&frame).unwrap();
            trajectory.flush().unwrap();
            drop(trajectory);
            let after = continued(directory.path(), &scene, file, &[]);
            let (model, state) = start(&after);
            assert_ne!(model.seed, scene.seed);
            let again = engine(&after, &state, Options::default()).frame().unwrap();
            let off = |one: &[u32; 3], other: &[u32; 3]| {
                (0..3).map(|axis| one[axis].wrapping_sub(other[axis]).cast_signed().unsigned_abs()).max()
            };
            let places =
                again.positions.iter().zip(&frame.positions).map(|(one, other)| off(one, other)).max().flatten();
            // Single precision; a box of 2³² places.
            assert!(places.unwrap() < 512, "{places:?}");
            let slowed =
                again.momenta.iter().flatten().zip(frame.momenta.iter().flatten()).map(|(a, b)| (a - b).abs()).max();
            assert!(slowed.unwrap() < 16, "{slowed:?}");
        }
    }
}

/// Frames of one file, formats and runs: no two have the noise of each other or of the run that wrote them.
#[test]
fn other_noise_follows_from_every_file() {
    let directory = TempDir::new().unwrap();
    let scene = small(&[SPLITTING, r#"output.trajectory={"every":100}"#]);
    let (model, state) = start(&scene);
    let mut run = reference(&scene, &state);
    let path = |name: &str| directory.path().join(name);
    let create = |format: TrajectoryFormat| {
        TrajectoryWriter::create(&path(files::trajectory(format)), format, &model, Id::of_run(&scene)).unwrap()
    };
    let mut trajectories = [TrajectoryFormat::Gsd, TrajectoryFormat::ExtendedXyz].map(create);
    for _ in 0..2 {
        run.run(3).unwrap();
        for trajectory in &mut trajectories {
            trajectory.append(&run.reported_state().unwrap()).unwrap();
            trajectory.flush().unwrap();
        }
    }
    let atoms: Vec<String> = (1..=2).map(|id| format!("{id} 1 {id} 1 1\n")).collect();
    let data = format!(
        "two\n\n2 atoms\n1 atom types\n\n0 3 xlo xhi\n0 3 ylo yhi\n0 3 zlo zhi\n\nMasses\n\n1 1\n\nAtoms # atomic\n\n{}\nVelocities\n\n1 1 0 0\n2 0 1 0\n",
        atoms.concat()
    );
    std::fs::write(path("two.data"), data).unwrap();
    save(directory.path(), &scene, run.state());
    let seed = |file: &str, changes: &[&str]| continued(directory.path(), &scene, file, changes).model().seed;
    let mut seeds = vec![scene.seed, seed("two.data", &[]), seed("run", &["time.step=0.02"])];
    for file in ["trajectory.gsd", "trajectory.xyz"] {
        seeds.extend([0, 1].map(|frame| seed(file, &[&format!("state.frame={frame}")])));
    }
    seeds.push(seed("trajectory.gsd", &["seed=1"]));
    let count = seeds.len();
    seeds.sort_unstable();
    seeds.dedup();
    assert_eq!(seeds.len(), count);
    // The same again has the same.
    assert_eq!(seed("trajectory.gsd", &[]), seed("trajectory.gsd", &["state.frame=1"]));
    // What a checkpoint keeps of the file is enough to go on with its noise.
    let after = continued(directory.path(), &scene, "trajectory.gsd", &[]);
    let (model, state) = start(&after);
    save(directory.path(), &after, &state);
    let kept = checkpoint::load(&path("run").join(files::CHECKPOINT)).unwrap();
    assert_eq!(kept.scene.model().seed, model.seed);
}

/// Free particles in a Langevin bath, and a run that goes on with them: velocities of the two runs are not correlated at the same times,
/// and together particles diffuse as they should.
#[test]
fn noise_is_not_repeated() {
    const PARTICLES: usize = 1000;
    let scene = changed(
        r#"{"title": "free", "space": {"box": [10, 10, 10]}, "time": {"step": 0.05, "steps": 400}, "temperature": 1,
            "particles": [{"species": "a", "count": 1000}], "interactions": [{"type": "langevin", "friction": 1}]}"#,
        &[],
    );
    let directory = TempDir::new().unwrap();
    // Momenta after 0, 1, 2 and 5 units of time, the sum of all changes of position, and the state at the end.
    let run = |scene: &Checked| {
        let (model, state) = start(scene);
        let units = model.units;
        let mut run = reference_of_particles(model, state);
        let (mut ways, mut velocities) = (vec![[0.0; 3]; PARTICLES], Vec::new());
        let mut before = run.state().positions;
        for step in 0..400 {
            if [20, 40, 100].contains(&step) {
                velocities.push(run.reported().momenta);
            }
            run.step(1);
            let now = run.state().positions;
            for (way, (now, before)) in ways.iter_mut().zip(now.iter().zip(&before)) {
                let moved = units.displacement(*now, *before);
                (0..3).for_each(|axis| way[axis] += moved[axis]);
            }
            before = now;
        }
        (ways, velocities, run.state())
    };
    let (first, velocities, state) = run(&scene);
    save(directory.path(), &scene, &state);
    for (changes, exact) in [(&[][..], true), (&["interactions.0.friction=1.0000001"], false)] {
        let after = continued(directory.path(), &scene, "run", changes);
        assert_eq!(after.model().steps_before > 0, exact);
        let (second, others, _) = run(&after);
        for (one, other) in velocities.iter().zip(&others) {
            let product = |a: &[[i32; 3]], b: &[[i32; 3]]| {
                let all = a.iter().flatten().zip(b.iter().flatten());
                all.map(|(a, b)| f64::from(*a) * f64::from(*b)).sum::<f64>()
            };
            let correlation = product(one, other) / (product(one, one) * product(other, other)).sqrt();
            // 3 000 components: three standard errors.
            assert!(correlation.abs() < 0.055, "{correlation}");
        }
        let squares =
            first.iter().zip(&second).map(|(a, b)| (0..3).map(|axis| (a[axis] + b[axis]).powi(2)).sum::<f64>());
        let mean = squares.sum::<f64>() / PARTICLES as f64;
        // 6 D t - 6 = 234 for t = 40, with the standard deviation √(2/3) of one of 1 000.
        assert!((mean / 234.0 - 1.0).abs() < 0.08, "{mean}");
    }
}
