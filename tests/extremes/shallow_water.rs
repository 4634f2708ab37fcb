//! The ends of every range that a scene of shallow water can reach: right, or refused with the reason, and never silent.

use mesoscope::engine::{Engine, EngineError};
use mesoscope::families::reference::{ShallowWaterReference, Unstable};
use mesoscope::families::{Instability, ShallowWater};
use mesoscope::gpu::AdapterKind;
use mesoscope::plan::{Options, Storage, Traversal};
use mesoscope::scene::{Checked, Velocities};
use mesoscope::shaders::Array;
use mesoscope::state::State;

use crate::support::{
    EVERY_STEP, GYRO, ROTATE, WHITE, edited, engine, gpu, in_eights, largest_difference, series, start, step_in_words,
    water,
};

const WARM: &str = "temperature=4e-4";
const UNSMOOTHED: &str = r#"interactions.0.smoothing={"length":0}"#;
const CHEBYSHEV: &str = r#"interactions.0.smoothing={"length":0.8,"solver":{"type":"chebyshev"}}"#;
const STORAGES: [Storage; 2] = [Storage::Bins, Storage::Sorted];

fn stored(storage: Storage) -> Options {
    Options { storage: Some(storage), ..in_eights() }
}

fn shallow_water(scene: &Checked) -> ShallowWater {
    scene.model().shallow_water().unwrap().clone()
}

/// Particles at given places with given velocities.
fn listed(positions: &[[f64; 2]], velocities: &[[f64; 2]]) -> String {
    format!(
        r#"particles=[{{"species":"water","placement":{{"type":"listed","positions":{positions:?}}},"velocities":{{"type":"listed","velocities":{velocities:?}}}}}]"#
    )
}

/// Steps device and reference side by side from a state: velocities within so many integer units a step, positions as
/// far as those carry, and observables to single precision.
fn agrees_from(scene: &Checked, state: &State, steps: u64, units: i64) {
    agrees_in(&STORAGES, scene, state, steps, units);
}

/// The same in some ways to store particles.
fn agrees_in(storages: &[Storage], scene: &Checked, state: &State, steps: u64, units: i64) {
    let (model, _) = start(scene);
    let shortest = model.units.lengths[0].min(model.units.lengths[1]);
    let drift = model.time_step * model.units.momentum / shortest * 2_f64.powi(32);
    let mut reference = ShallowWaterReference::new(model.clone(), state.clone()).unwrap();
    let expected: Vec<State> = (0..steps)
        .map(|_| {
            reference.step().unwrap_or_else(|error| panic!("{error} ({:?})", scene.system));
            reference.state().clone()
        })
        .collect();
    'storages: for &storage in storages {
        let mut device = engine(scene, state, stored(storage));
        for (step, expected) in (1_i64..).zip(&expected) {
            device.advance(1, 1).unwrap();
            let found = match device.state() {
                Ok(found) => found,
                // For the other storage to get right.
                Err(EngineError::Crowded { .. }) if storage == Storage::Bins => {
                    if !storages.contains(&Storage::Sorted) {
                        agrees_in(&[Storage::Sorted], scene, state, steps, units);
                    }
                    continue 'storages;
                }
                Err(error) => panic!("{error}"),
            };
            let (velocity, position) = largest_difference(&found, expected);
            let allowed = units * step;
            let moved = 4 + allowed + ((allowed * step) as f64 * drift) as i64;
            let what = (&scene.system, storage);
            assert!(velocity <= allowed, "step {step}: velocities differ by {velocity} ({what:?})");
            assert!(position <= moved, "step {step}: positions differ by {position} ({what:?})");
            assert_eq!(found.masses, state.masses);
        }
        // Of the very same state.
        let found = ShallowWaterReference::new(model.clone(), device.state().unwrap()).unwrap().observe().unwrap();
        let every = scene.output.energies.every;
        assert_eq!(every, 1, "every step is sampled");
        let measured = *series(&mut device, scene).last().unwrap();
        let scale = found.kinetic_energy + found.potential_energy + 1e-9;
        for (name, a, b) in [
            ("kinetic energy", measured.kinetic_energy, found.kinetic_energy),
            ("potential energy", measured.potential_energy, found.potential_energy),
            ("bath energy", measured.bath_energy, found.bath_energy),
        ] {
            let allowed = 1e-3 * scale.max(if name == "bath energy" { found.bath_energy } else { 0.0 });
            assert!((a - b).abs() <= allowed, "{name}: {a}, {b} in the reference ({:?})", scene.system);
        }
        assert_eq!(measured.mass, found.mass);
    }
}

/// The same from the start of a scene with changes, with one of the ways to store particles: the other one for the next `number`.
/// For cases that between them have both ways with everything that the ways could disagree on.
fn agrees_in_turn(number: usize, changes: &[&str], steps: u64, units: i64) {
    let scene = water(&[&[EVERY_STEP], changes].concat());
    let (_, state) = start(&scene);
    agrees_in(&[STORAGES[number % 2]], &scene, &state, steps, units);
}

/// The failure of a run from a state, after so many steps in one batch.
fn failure(scene: &Checked, state: &State, options: Options, batch: u64) -> Result<Instability, EngineError> {
    let mut engine = engine(scene, state, options);
    match engine.advance(batch, batch).and_then(|()| engine.finish().map(drop)) {
        Err(error) => {
            // The engine is fit for another state.
            let (_, first) = start(scene);
            if !matches!(engine.upload(&first), Err(EngineError::Crowded { .. })) {
                assert_eq!(engine.state().unwrap().positions, first.positions);
            }
            explained(error, &engine, scene)
        }
        Ok(()) => panic!("no failure in {batch} steps ({:?}, {options:?})", scene.system),
    }
}

/// What an unstable run says.
fn explained(error: EngineError, engine: &Engine<'_>, scene: &Checked) -> Result<Instability, EngineError> {
    match error {
        EngineError::Unstable(failure) => Ok(Instability::new(&failure, engine.plan(), scene.model())),
        other => Err(other),
    }
}

/// Step, quantity and suggested time step of an unstable run.
fn unstable(error: &Instability) -> (u64, &str, f64) {
    (error.step, &error.quantity, error.suggested_step.unwrap_or(0.0))
}

// ---- Few particles

#[test]
fn no_water_at_all() {
    let tracers = r#"particles=[{"species":"dye","count":20,"tracer":true}]"#;
    for (number, particles) in ["particles=[]", tracers].into_iter().enumerate() {
        for bath in [&[][..], &[WHITE, WARM]] {
            for (index, smoothing) in
                [UNSMOOTHED, CHEBYSHEV, "interactions.0.smoothing.power=2"].into_iter().enumerate()
            {
                if !bath.is_empty() && smoothing == UNSMOOTHED {
                    continue; // A bath takes its scales from the smoothing.
                }
                let scene = water(&[&[EVERY_STEP, particles, smoothing], bath].concat());
                let (_, state) = start(&scene);
                let mut engine = engine(&scene, &state, stored(STORAGES[(number + index) % 2]));
                engine.advance(5, 2).unwrap();
                let found = engine.state().unwrap();
                assert_eq!((found.step, found.len()), (5, state.len()));
                if bath.is_empty() {
                    assert_eq!(found.positions, state.positions, "nothing drives tracers at rest");
                }
                for row in series(&mut engine, &scene) {
                    assert_eq!([row.kinetic_energy, row.potential_energy, row.mass], [0.0; 3]);
                    assert_eq!(row.bath_square > 0.0, !bath.is_empty());
                }
            }
        }
    }
}

#[test]
fn one_particle_and_two() {
    let one = listed(&[[1.3, 6.2]], &[[1.0, -2.0]]);
    let two = listed(&[[1.3, 6.2], [1.3, 6.2]], &[[1.0, -2.0], [-2.0, 0.5]]);
    // Every order with both numbers, both integrators and both ways to store.
    for (number, particles) in [&one, &two].into_iter().enumerate() {
        for order in 1..=3 {
            let turn = number + order;
            let integrator = [GYRO, ROTATE][turn % 2];
            let order = format!("interactions.0.spline_order={order}");
            // All mass of the box in one place makes steep slopes.
            let changes = ["interactions.0.mesh=[8,8]", particles, integrator, &order, "time.step=0.002"];
            agrees_in_turn(turn, &changes, 5, 20_000);
        }
    }
}

#[test]
fn a_particle_on_flat_water_goes_round_its_inertial_circle() {
    // Waves so slow that they do not matter: after a period 2π/f₀ the particle is back, at any time step with `gyro`.
    for step in [0.1, 0.25, 1.0 / 3.0] {
        let particle = listed(&[[3.0, 3.0]], &[[2.0, 0.0]]);
        let scene = water(&[
            "interactions.0.mesh=[8,8]",
            "interactions.0.wave_speed=1e-4",
            &particle,
            &format!("time.step={step}"),
        ]);
        let (model, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(30, 7).unwrap();
        let found = engine.state().unwrap();
        // 30 steps are 3, 7.5 and 10 periods.
        let periods = 30.0 * step;
        let [u, v, _] = model.units.momentum(found.momenta[0]);
        let sign = if (periods as u64 * 2) as f64 == 2.0 * periods { 1.0 } else { -1.0 };
        assert!((u - 2.0 * sign).abs() < 1e-4 && v.abs() < 1e-4, "({u}, {v}) after {periods} periods");
        let [x, y, _] = model.units.displacement(found.positions[0], state.positions[0]);
        let expected = if sign > 0.0 { 0.0 } else { -2.0 * 2.0 / std::f64::consts::TAU };
        assert!(x.abs() < 1e-4 && (y - expected).abs() < 1e-4, "({x}, {y}) after {periods} periods");
    }
}

// ---- Places

#[test]
fn particles_on_nodes_and_on_boundaries_of_cells() {
    // Every mesh and every order with both ways to store.
    for (number, mesh) in [[16_u32, 16], [5, 7], [12, 10]].into_iter().enumerate() {
        for order in 1..=3 {
            let storage = STORAGES[(number + order) % 2];
            let mesh_change = format!("interactions.0.mesh={mesh:?}");
            let order_change = format!("interactions.0.spline_order={order}");
            let changes = [EVERY_STEP, &mesh_change, &order_change, CHEBYSHEV, "time.step=0.005"];
            let scene = water(&changes);
            let (_, mut state) = start(&scene);
            // The last place before a node or the middle between two, the place itself, and the next.
            let mut edges = vec![0, 1, u32::MAX, 1 << 31, (1 << 31) - 1];
            for nodes in mesh {
                for half in 1..2 * u64::from(nodes) {
                    let edge = ((half << 32).div_ceil(2 * u64::from(nodes))) as u32;
                    edges.extend([edge - 1, edge, edge + 1]);
                }
            }
            for (index, position) in state.positions.iter_mut().enumerate() {
                let along = |number: usize| edges[number % edges.len()];
                *position = [along(index), along(index / 3 + index / edges.len()), 0];
            }
            agrees_in(&[storage], &scene, &state, 2, 5000);
        }
    }
}

#[test]
fn meshes_and_boxes_of_any_shape() {
    let linear = "interactions.0.spline_order=1";
    let quadratic = "interactions.0.spline_order=2";
    // The smallest meshes of each order with both ways to store, the others in turn.
    let both = ["[4,4]", "[2,2]", "[3,3]"];
    let meshes = [
        ("[4,4]", &[][..]),
        ("[2,2]", &[linear]),
        ("[2,16]", &[linear]),
        ("[3,3]", &[quadratic, CHEBYSHEV]),
        ("[5,7]", &[CHEBYSHEV]),
        ("[5,7]", &[UNSMOOTHED, "time.step=0.004"]),
        ("[7,4]", &[linear, CHEBYSHEV, "space.box=[3,40]", "time.step=0.004"]),
        ("[64,4]", &["space.box=[50,3]", "time.step=0.004"]),
        ("[4,64]", &["space.box=[3,50]", "time.step=0.004", quadratic]),
        ("[128,64]", &["space.box=[12,6]", "time.step=0.01", "interactions.0.smoothing.length=0.2"]),
        ("[16,16]", &["space.box=[6e-6,6e-6]", "interactions.0.smoothing.length=8e-7", "time.step=2e-8"]),
        (
            "[16,16]",
            &[
                "space.box=[6e6,6e6]",
                "interactions.0.smoothing.length=8e5",
                "time.step=2e4",
                "interactions.0.rotation=1e-5",
                r#"particles.0.velocities={"type":"rest"}"#,
            ],
        ),
    ];
    for (number, (mesh, further)) in meshes.into_iter().enumerate() {
        let turns = if both.contains(&mesh) { 2 } else { 1 };
        let mesh = format!("interactions.0.mesh={mesh}");
        let rest = r#"particles.0.velocities={"type":"rest"}"#;
        for turn in 0..turns {
            agrees_in_turn(number + turn, &[&[mesh.as_str(), rest], further].concat(), 3, 5000);
        }
    }
}

// ---- Rotation

#[test]
fn any_angle_of_rotation_in_a_step() {
    use std::f64::consts::{FRAC_PI_2, PI};
    // How particles are stored knows nothing of the angle: in one of the ways each. Nor does the integrator know how a sign or some
    // whole turns are taken off an angle.
    let angles = [0.0, 1e-9, 1.0, PI, 1000.0, -1.0, FRAC_PI_2, -PI, 10.0];
    for (number, (integrator, angles)) in [(GYRO, &angles[..]), (ROTATE, &angles[..5])].into_iter().enumerate() {
        for (index, angle) in angles.iter().enumerate() {
            let rotation = format!("interactions.0.rotation={}", angle / 0.02);
            let thermal = r#"particles.0.velocities={"type":"thermal"}"#;
            let scene = water(&[EVERY_STEP, integrator, &rotation, thermal, "temperature=0.01"]);
            let (_, state) = start(&scene);
            agrees_in(&[STORAGES[(number + index) % 2]], &scene, &state, 4, 2000);
        }
    }
}

#[test]
fn turning_loses_no_speed() {
    // The lattice of integers is turned by shears: whatever the angle, energies wander by rounding alone.
    for rotation in [0.3, 6.3, 50.0, 1e4] {
        let scene = water(&[
            "interactions.0.wave_speed=1e-3",
            "interactions.0.surface=[]",
            r#"particles.0.velocities={"type":"thermal"}"#,
            "temperature=1e-9",
            "output.energies.every=100",
            &format!("interactions.0.rotation={rotation}"),
        ]);
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(1000, 200).unwrap();
        let rows = series(&mut engine, &scene);
        assert_eq!(rows.len(), 11);
        for row in &rows {
            let change = row.total_energy() / rows[0].total_energy() - 1.0;
            assert!(change.abs() < 1e-4, "step {} at f₀ = {rotation}: {change}", row.step);
        }
    }
}

// ---- Heat

#[test]
fn a_cold_bath_takes_energy_and_holds_no_noise() {
    let memory = r#"interactions.0.bath={"type":"memory","epsilon":5}"#;
    for bath in [memory, WHITE] {
        let rest = r#"particles.0.velocities={"type":"rest"}"#;
        let scene = water(&[bath, "temperature=0", EVERY_STEP, "time.step=0.01", rest]);
        let (_, state) = start(&scene);
        assert!(state.node_bath.iter().all(|bits| f32::from_bits(*bits) == 0.0));
        let mut engine = engine(&scene, &state, Options::default());
        for kernel in &engine.plan().kernels {
            let files = kernel.files().unwrap();
            let noisy = files.iter().any(|file| file.starts_with("noise/generators"));
            assert!(!noisy, "`{}` of a cold scene holds noise: {:?}", kernel.name, files);
        }
        engine.advance(400, 100).unwrap();
        let rows = series(&mut engine, &scene);
        let [first, last] = [rows[0], rows[400]].map(|row| row.total_energy());
        assert!(last < 0.95 * first && last > 0.0, "{bath}: {last} of {first}");
        for pair in rows.windows(2) {
            let [before, after] = [pair[0], pair[1]].map(|row| row.total_energy() + row.bath_energy);
            assert!(after < before + 2e-3 * first, "{bath}: step {}: {before} to {after}", pair[1].step);
        }
    }
}

#[test]
fn heat_from_none_to_enormous() {
    let thermal = r#"particles.0.velocities={"type":"thermal"}"#;
    let memory = r#"interactions.0.bath={"type":"memory","epsilon":1}"#;
    // Velocities of 4√kT: the time step and what is allowed of single precision follow them.
    for (turn, (temperature, step)) in [("1e-30", "0.02"), ("1", "0.002"), ("1e12", "1e-8")].into_iter().enumerate() {
        let [temperature, step] = [format!("temperature={temperature}"), format!("time.step={step}")];
        agrees_in_turn(turn, &[thermal, &temperature, &step], 3, 2000);
        agrees_in_turn(turn + 1, &[thermal, memory, &temperature, &step], 3, 20_000);
    }
}

#[test]
fn a_bath_of_any_strength() {
    // In one way to store particles each, which the bath of a node knows nothing of.
    let mut storages = STORAGES.iter().cycle();
    for scheme in ["cotter-reich", "symmetric", "exponential"] {
        for (epsilon, step) in [("0", "0.02"), ("1e-6", "0.02"), ("1e3", "0.005"), ("1e12", "0.0005")] {
            for rate in ["wave-speed", "printed"] {
                if scheme == "symmetric" && epsilon == "1e12"
                    || rate == "printed" && epsilon != "0" && epsilon != "1e-6"
                {
                    continue; // Far beyond the limit of stability: see below.
                }
                let bath = format!(
                    r#"interactions.0.bath={{"type":"memory","epsilon":{epsilon},"scheme":"{scheme}","rate":"{rate}"}}"#
                );
                let scene = water(&[EVERY_STEP, &bath, WARM, &format!("time.step={step}")]);
                let (_, state) = start(&scene);
                agrees_in(&[*storages.next().unwrap()], &scene, &state, 3, 20_000);
            }
        }
    }
    // A bath of no strength is none.
    let none = water(&[r#"interactions.0.bath={"type":"memory","epsilon":0}"#, WARM, EVERY_STEP]);
    let plain = water(&[WARM, EVERY_STEP]);
    let [none, plain] = [none, plain].map(|scene| {
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(20, 10).unwrap();
        let state = engine.state().unwrap();
        let rows = series(&mut engine, &scene);
        assert!(rows.iter().all(|row| [row.bath_energy, row.bath_square] == [0.0; 2]));
        (state.positions, state.momenta)
    });
    assert!(none == plain);
}

#[test]
fn a_bath_that_is_too_stiff_is_caught() {
    let bath = r#"interactions.0.bath={"type":"memory","epsilon":1e12,"scheme":"symmetric"}"#;
    let scene = water(&[bath, WARM]);
    let (_, state) = start(&scene);
    let error = failure(&scene, &state, stored(Storage::Sorted), 50).unwrap();
    let (step, _, suggested) = unstable(&error);
    assert!(step < 50 && suggested > 0.0 && suggested < 1e-6, "{error}");
}

// ---- What the integers cannot hold

#[test]
fn a_time_step_far_beyond_stability_is_caught_and_the_suggested_one_works() {
    // Just beyond stability what grows is rounding, from whatever an adapter makes of the last digit.
    const STEPS: u64 = 500;
    const FAR_BEYOND: u64 = 20;
    let cases: [&[&str]; 4] =
        [&[], &[ROTATE], &[WHITE, WARM], &["interactions.0.rotation=0", r#"particles.0.velocities={"type":"rest"}"#]];
    // Every case just beyond the limit; what is far beyond it, it is in any of them.
    for (step, cases, steps) in
        [(0.45, &cases[..], STEPS), (10.1, &cases[1..2], FAR_BEYOND), (1e6, &cases[2..3], FAR_BEYOND)]
    {
        for (number, &changes) in cases.iter().enumerate() {
            // In both ways to store what fails at once, and in one of them what takes long.
            let storages = if steps < STEPS { &STORAGES[..] } else { &STORAGES[number % 2..][..1] };
            let scene = water(&[changes, &[&format!("time.step={step}")]].concat());
            let (_, state) = start(&scene);
            let mut suggestions = Vec::new();
            for &storage in storages {
                let mut error = failure(&scene, &state, stored(storage), steps);
                if matches!(error, Err(EngineError::Crowded { .. })) {
                    assert_eq!(storage, Storage::Bins);
                    error = failure(&scene, &state, stored(Storage::Sorted), steps);
                }
                let error = error.unwrap();
                let (at, quantity, suggested) = unstable(&error);
                assert!(at < steps && !quantity.is_empty(), "{error}");
                let message = error.to_string();
                assert!(
                    message.contains(&format!("at step {at}: ")) && message.contains(&step_in_words(suggested)),
                    "{message}"
                );
                suggestions.push(suggested);
            }
            let suggested = suggestions[0];
            let scene = water(&[changes, &[&format!("time.step={suggested}")]].concat());
            let (_, state) = start(&scene);
            let mut engine = engine(&scene, &state, Options::default());
            engine.advance(500, 100).unwrap();
            engine.finish().unwrap_or_else(|error| panic!("{suggested} after {step}: {error} ({changes:?})"));
        }
    }
}

#[test]
fn a_velocity_that_leaves_its_range_is_caught_with_its_step() {
    let scene = water(&["interactions.0.wave_speed=1", "time.step=0.001"]);
    let (model, state) = start(&scene);
    let limit = f64::from(1 << 30) * model.units.momentum;
    for storage in STORAGES {
        for (units, fails) in [((1 << 30) - 100_000, false), ((1 << 30) + 100_000, true), (-(1 << 30) - 100_000, true)]
        {
            for (axis, step) in [(0, 0), (1, 7)] {
                let mut state = State { step, ..state.clone() };
                state.momenta[77][axis] = units;
                if !fails {
                    let mut engine = engine(&scene, &state, stored(storage));
                    engine.advance(1, 1).unwrap();
                    engine.finish().unwrap();
                    continue;
                }
                let error = failure(&scene, &state, stored(storage), 20).unwrap();
                let (at, quantity, _) = unstable(&error);
                assert_eq!(at, step, "{error}");
                assert_eq!(
                    quantity,
                    format!("a velocity is above {limit:.3}, more than twice the largest expected in this scene")
                );
            }
        }
    }
}

#[test]
fn a_path_of_half_the_box_is_caught() {
    // Slow enough for its integers, but the box is small.
    let scene = water(&[
        "space.box=[1,1]",
        "interactions.0.smoothing.length=0.13",
        "interactions.0.wave_speed=1e-3",
        "interactions.0.rotation=0",
        "time.step=0.25",
        &listed(&[[0.2, 0.2], [0.7, 0.7]], &[[0.0, 0.0], [0.0, 0.0]]),
        "interactions.0.mesh=[8,8]",
        "interactions.0.surface=[]",
    ]);
    let (model, mut state) = start(&scene);
    for (speed, fails) in [(1.9, false), (2.1, true)] {
        let unit = model.units.momentum * 1024.0;
        let velocities = Velocities::Listed { velocities: vec![vec![0.0, speed], vec![0.0, 0.0]] };
        let fast = edited(&scene, |scene| scene.particles[0].velocities = velocities);
        let (model, listed) = start(&fast);
        assert!(model.units.momentum >= unit);
        state.momenta.clone_from(&listed.momenta);
        for storage in STORAGES {
            if fails {
                let error = failure(&fast, &state, stored(storage), 5).unwrap();
                assert_eq!(
                    (unstable(&error).0, unstable(&error).1),
                    (0, "a velocity is above 2.000, which may go half round the box in one step")
                );
            } else {
                let mut engine = engine(&fast, &state, stored(storage));
                engine.advance(3, 3).unwrap();
                engine.finish().unwrap();
            }
        }
    }
}

// ---- Depth

/// Without smoothing a node is dry as soon as the last particle around it has left, and that is no failure.
#[test]
fn a_node_may_run_dry() {
    let positions: Vec<[f64; 2]> = (0..16).map(|node| [f64::from(node % 4), f64::from(node / 4)]).collect();
    let mut velocities = vec![[0.0, 0.0]; 16];
    // From node (2, 1) to the next in eight steps.
    velocities[6] = [1.0, 0.0];
    let scene = water(&[
        "space.box=[4,4]",
        "interactions.0.mesh=[4,4]",
        "interactions.0.spline_order=1",
        "interactions.0.wave_speed=1e-9",
        "interactions.0.rotation=0",
        "interactions.0.surface=[]",
        "time.step=0.125",
        UNSMOOTHED,
        EVERY_STEP,
        &listed(&positions, &velocities),
    ]);
    let (_, state) = start(&scene);
    agrees_from(&scene, &state, 12, 10);
    let mut engine = engine(&scene, &state, Options::default());
    engine.advance(8, 3).unwrap();
    engine.reported().unwrap();
    let depths: Vec<f32> = engine.words(Array::Depths).unwrap().iter().map(|bits| f32::from_bits(*bits)).collect();
    assert_eq!((depths[6], depths[7], depths[5]), (-1.0, 1.0, 0.0));
}

/// The five-point Laplacian has a positive inverse, and so has Chebyshev's polynomial to its tolerance; the spectral
/// symbol has not.
#[test]
fn a_negative_depth_is_caught_with_place_and_step_and_only_the_spectral_symbol_makes_one() {
    let particle = listed(&[[3.0, 3.0]], &[[0.0, 0.0]]);
    let spectral = r#"{"type":"fft","symbol":"spectral"}"#;
    for (solver, power, positive) in [
        (spectral, 1, false),
        (spectral, 2, false),
        (r#"{"type":"fft"}"#, 1, true),
        (r#"{"type":"fft"}"#, 2, true),
        (r#"{"type":"chebyshev","tolerance":1e-7}"#, 1, true),
    ] {
        let scene = water(&[
            "space.box=[8,8]",
            "interactions.0.mesh=[8,8]",
            "interactions.0.spline_order=1",
            "time.step=1e-4",
            &particle,
            &format!(r#"interactions.0.smoothing={{"length":0.4,"power":{power},"solver":{solver}}}"#),
        ]);
        let (model, mut state) = start(&scene);
        for first in [0, 1 << 40] {
            state.step = first;
            let expected = ShallowWaterReference::new(model.clone(), state.clone()).unwrap().run(2);
            for storage in STORAGES {
                let mut engine = engine(&scene, &state, stored(storage));
                match engine.advance(2, 2).and_then(|()| engine.finish().map(drop)) {
                    Ok(()) => assert!(positive && expected.is_ok(), "{solver}"),
                    Err(error) => {
                        let error = explained(error, &engine, &scene).unwrap();
                        let (step, quantity, _) = unstable(&error);
                        let Err(Unstable::Depth { step: known, node: [k, l] }) = expected else { panic!("{error}") };
                        assert!(!positive && (step, known) == (first, first), "{error}");
                        let place = format!(
                            "the depth at mesh node ({k}, {l}), where x = {k}.0000 and y = {l}.0000, is negative"
                        );
                        assert_eq!(quantity, place);
                    }
                }
            }
        }
    }
}

// ---- Crowds

/// All particles of a scene in a part of one cell, or around one node.
fn crowd(scene: &Checked, around: [u32; 2]) -> State {
    let (_, mut state) = start(scene);
    for position in &mut state.positions {
        *position = [around[0].wrapping_add(position[0] >> 5), around[1].wrapping_add(position[1] >> 5), 0];
    }
    state
}

#[test]
fn a_crowd_in_one_cell_is_refused_by_bins_and_right_when_sorted() {
    let scene = water(&["interactions.0.mesh=[8,8]", "particles.0.count=3000", "time.step=1e-5", EVERY_STEP]);
    let state = crowd(&scene, [3 << 29, 5 << 29]);
    let mut sorted = engine(&scene, &state, stored(Storage::Sorted));
    let mut reference = ShallowWaterReference::new(scene.model().clone(), state.clone()).unwrap();
    sorted.advance(2, 2).unwrap();
    reference.run(2).unwrap();
    let (velocity, position) = largest_difference(&sorted.state().unwrap(), reference.state());
    assert!(velocity <= 2000 && position <= 2000, "{velocity} {position}");
    // Before the first step already, and just as well when the crowd gathers later.
    let (_, spread) = start(&scene);
    let mut bins = engine(&scene, &spread, stored(Storage::Bins));
    assert!(matches!(bins.upload(&state), Err(EngineError::Crowded { step: 0 })));
    bins.upload(&spread).unwrap();
    bins.advance(2, 1).unwrap();
    bins.finish().unwrap();
}

#[test]
fn more_particles_in_a_cell_than_an_adapter_makes_turns_are_all_seen_or_the_run_ends() {
    let scene = water(&["interactions.0.mesh=[8,8]", "particles.0.count=70000", "time.step=1e-7", EVERY_STEP]);
    let state = crowd(&scene, [3 << 29, 5 << 29]);
    for traversal in [in_eights().traversal, Some(Traversal::Rows)] {
        let mut device = engine(&scene, &state, Options { traversal, ..stored(Storage::Sorted) });
        match device.advance(2, 2).and_then(|()| device.finish()) {
            Ok(_) => {
                let nodes = device.words(Array::NodeMasses).unwrap();
                let total: u64 = nodes[..64].iter().map(|mass| u64::from(*mass)).sum();
                assert_eq!(total, shallow_water(&scene).total_mass());
            }
            Err(error) => {
                // Software adapters leave such loops; plans for any GPU do not count turns and see what comes of it.
                let software = gpu().description().kind == AdapterKind::Software;
                let named = match error {
                    EngineError::GaveUp { step: 0, .. } => true,
                    EngineError::Unstable(failure) => failure.step == 0 && software && !gpu().serial_memory(),
                    _ => false,
                };
                assert!(named, "{traversal:?}: {error}");
            }
        }
    }
}

#[test]
fn a_crowd_that_gathers_overflows_a_bin_at_the_same_step_in_any_batch() {
    // All particles of a lattice head for one point, and would be there at step 64.
    let scene = water(&[
        "interactions.0.mesh=[8,8]",
        "particles.0.count=4096",
        "interactions.0.wave_speed=1e-3",
        "interactions.0.rotation=0",
        "interactions.0.surface=[]",
        r#"particles.0.velocities={"type":"rest"}"#,
        "time.step=0.25",
        "interactions.0.smoothing.length=6",
    ]);
    let (model, state) = start(&scene);
    let centre = model.units.fraction([3.2, 3.1, 0.0]);
    let velocities = state.positions.iter().map(|position| {
        let [x, y, _] = model.units.displacement(centre, *position);
        vec![x / 16.0, y / 16.0]
    });
    let velocities = Velocities::Listed { velocities: velocities.collect() };
    let scene = edited(&scene, |scene| scene.particles[0].velocities = velocities);
    let (_, state) = start(&scene);
    let crowded = |batch: u64| {
        let mut bins = engine(&scene, &state, stored(Storage::Bins));
        match bins.advance(64, batch).and_then(|()| bins.finish().map(drop)) {
            Err(EngineError::Crowded { step }) => step,
            other => panic!("{other:?}"),
        }
    };
    let step = crowded(1);
    assert!((2..60).contains(&step), "{step}");
    assert_eq!([crowded(4), crowded(16)], [step; 2]);
    // Up to there both are the same.
    let [bins, sorted] = STORAGES.map(|storage| {
        let mut engine = engine(&scene, &state, stored(storage));
        engine.advance(step, 4).unwrap();
        engine.state().unwrap()
    });
    assert!(bins == sorted);
    let mut sorted = engine(&scene, &state, stored(Storage::Sorted));
    sorted.advance(64, 5).unwrap();
    sorted.finish().unwrap();
}

#[test]
fn more_mass_than_fits_is_caught() {
    // 256 times the mean mass in one cell.
    let scene = water(&["time.step=1e-5"]);
    let on_nodes = [3 << 28, 5 << 28];
    let between = on_nodes.map(|place| place + (1 << 27));
    // The first node that the splines of the cell reach.
    for (around, order, node) in [
        (on_nodes, 3, "(2, 4), where x = 0.7854 and y = 1.5708"),
        ([on_nodes[0], 6 << 28], 3, "(2, 5), where x = 0.7854 and y = 1.9635"),
        (on_nodes, 1, "(3, 5), where x = 1.1781 and y = 1.9635"),
        (between, 2, "(3, 5), where x = 1.1781 and y = 1.9635"),
    ] {
        let scene = edited(&scene, |scene| {
            scene.system.shallow_water_mut().unwrap().spline_order = order;
        });
        for first in [0, 9] {
            let state = State { step: first, ..crowd(&scene, around) };
            let error = failure(&scene, &state, stored(Storage::Sorted), 4).unwrap();
            let (step, quantity, _) = unstable(&error);
            assert_eq!(step, first, "{error}");
            assert!(quantity.starts_with("over a hundred times the mean mass"), "{error}");
            assert!(quantity.contains(&format!("around mesh node {node}")), "{error}");
        }
    }
}

#[test]
fn four_cells_that_fit_and_a_node_between_them_that_does_not() {
    // All mass of 21² nodes within a hair of one node: 110 times the mean in each of four cells, and all of it on the node.
    let scene = water(&["interactions.0.mesh=[21,21]", "interactions.0.spline_order=1", CHEBYSHEV, "time.step=1e-6"]);
    let (_, mut state) = start(&scene);
    let node = [7, 12].map(|index: u64| (index << 32).div_ceil(21) as u32);
    for (index, position) in state.positions.iter_mut().enumerate() {
        let hair =
            [index & 1, index >> 1 & 1].map(|side| if side == 1 { 1_000_u32 } else { 0_u32.wrapping_sub(1_000) });
        *position = [node[0].wrapping_add(hair[0]), node[1].wrapping_add(hair[1]), 0];
    }
    let error = failure(&scene, &state, stored(Storage::Sorted), 2).unwrap();
    let (step, quantity, _) = unstable(&error);
    assert_eq!(step, 0);
    assert!(quantity.contains("around mesh node (7, 12)"), "{error}");
}

#[test]
fn a_hundred_times_the_mean_mass_fits() {
    // All mass of 10² nodes in one cell; smoothed far enough that the others do not run dry.
    for order in 1..=3 {
        let order = format!("interactions.0.spline_order={order}");
        let scene = water(&["interactions.0.mesh=[10,10]", &order, CHEBYSHEV, "time.step=1e-6", EVERY_STEP]);
        let state = crowd(&scene, [(1 << 30) + (1 << 27), (1 << 30) + (1 << 27)]);
        let (model, _) = start(&scene);
        let mut device = engine(&scene, &state, stored(Storage::Sorted));
        let mut reference = ShallowWaterReference::new(model, state).unwrap();
        device.advance(2, 2).unwrap();
        reference.run(2).unwrap();
        let (velocity, position) = largest_difference(&device.state().unwrap(), reference.state());
        assert!(velocity <= 2000 && position <= 2000, "{velocity} {position}");
        let nodes = device.words(Array::NodeMasses).unwrap();
        let total: i64 = nodes[..100].iter().map(|mass| i64::from(*mass as i32)).sum();
        assert_eq!(total as u64, shallow_water(&scene).total_mass());
    }
}

#[test]
fn a_particle_heavier_than_fits_is_refused() {
    let scene = water(&[]);
    let (_, mut state) = start(&scene);
    state.masses[7] = 8_388_607;
    engine(&scene, &state, Options::default()).advance(0, 1).unwrap();
    let mut device = engine(&scene, &state, Options::default());
    state.masses[7] = 8_388_608;
    match device.upload(&state) {
        Err(EngineError::State { reason }) => {
            assert!(reason.contains("the mass of particle 7 is 8388608 units"), "{reason}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn heavy_and_light_particles() {
    // Up to nearly four times the mean depth.
    let surface = r#"interactions.0.surface=[{"type":"bump","center":[3,3],"radius":0.9,"amplitude":1.2},{"type":"bump","center":[3,3],"radius":4,"amplitude":-0.9}]"#;
    for count in [16, 500, 4096] {
        let count = format!("particles.0.count={count}");
        let changes = [surface, &count, "interactions.0.smoothing.length=0.3", "interactions.0.mesh=[8,8]", EVERY_STEP];
        let rest = r#"particles.0.velocities={"type":"rest"}"#;
        let scene = water(&[&changes[..], &[rest, "time.step=0.002"]].concat());
        let (model, state) = start(&scene);
        let water = model.shallow_water().unwrap();
        assert_eq!(state.masses.iter().map(|mass| u64::from(*mass)).sum::<u64>(), water.total_mass());
        let [least, most] = [state.masses.iter().min(), state.masses.iter().max()].map(|mass| *mass.unwrap());
        assert!(least > 0 && most > 2 * least && most < 1 << 23, "{least} {most}");
        agrees_from(&scene, &state, 3, 5000);
    }
}

#[test]
fn tracers_one_and_many() {
    for (turn, tracers) in [0, 1, 2, 1000, 5000, 5000].into_iter().enumerate() {
        let particles = format!(
            r#"particles=[{{"species":"water","count":1024,"placement":{{"type":"lattice"}},"velocities":{{"type":"geostrophic"}}}},
                {{"species":"dye","count":{tracers},"tracer":true,"velocities":{{"type":"geostrophic"}}}},
                {{"species":"loop","count":{tracers},"tracer":true,"placement":{{"type":"circle","center":[0,0],"radius":2}}}}]"#
        );
        agrees_in_turn(turn, &[&particles], 2, 2000);
    }
}
