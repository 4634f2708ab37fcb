//! Walls on the device: against the float64 reference, step by step, and against what is exact.

use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::state::State;
use serde_json::{Value, json};

use crate::support::{
    COTTER_REICH, Device, GROOT_WARREN, INTEGRATORS, Implementation, PREDICTED, SPLITTING, STAGED, SideBySide,
    before_and_after, reference_of_particles, start, units_of_a_step,
};

fn read(document: &Value) -> Checked {
    crate::support::scene(&document.to_string())
}

/// A fluid of two species between walls, whose interactions are followed by others.
fn fluid(edges: &[f64], walls: &Value, integrator: &str, others: &[Value]) -> Value {
    let volume: f64 = edges.iter().product();
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    let dpd = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let interactions = [&[dpd], others].concat();
    json!({
        "title": "channel",
        "seed": 5,
        "space": {"box": edges, "walls": walls},
        "time": {"step": 0.02, "steps": 1},
        "temperature": 1,
        "integrator": integrator,
        "particles": [
            {"species": "light", "count": (2.0 * volume) as u64, "placement": {"type": "random"}},
            {"species": "heavy", "count": volume as u64, "mass": 2.5}],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

/// Moving walls that reverse velocities; walls of both kinds that meet in corners.
fn channels() -> Vec<(Vec<f64>, Value)> {
    vec![
        (vec![9.0, 7.0], json!({"y": {"lower_velocity": [-2.0, 0], "upper_velocity": [3.0, 0]}})),
        (vec![9.0, 7.0], json!({"x": {"reflection": "specular"}, "y": {}})),
        (vec![5.0, 4.0, 4.5], json!({"z": {"lower_velocity": [-1.0, 0.5, 0], "upper_velocity": [1.0, 0, 0]}})),
        (vec![5.0, 4.0, 4.5], json!({"x": {"upper_velocity": [0, 0, -1.0]}, "y": {"reflection": "specular"}})),
    ]
}

/// That every particle that is not frozen is between the walls, to the last place.
fn between_walls(scene: &Checked, state: &State) {
    let model = start(scene).0;
    for (axis, end) in model.units.ends().into_iter().enumerate().filter(|(_, end)| *end > 0) {
        let moves = |id: &usize| !model.species[state.species[*id] as usize].frozen;
        let behind = (0..state.len()).filter(moves).find(|id| state.positions[*id][axis] >= end);
        assert_eq!(behind, None, "step {}: behind a wall across axis {axis}", state.step);
    }
}

/// Steps that agree are compared with the momenta that walls have got, of which every meeting may be as many units off as the momentum of
/// its particle. Particles get momentum from each other, from body forces and from walls only.
fn agree(document: &Value) {
    agree_in_motion(document, |found, total, what| assert_eq!(found.exchanged_momentum(), total, "{what}"));
}

/// The same of scenes in which momentum may go elsewhere; `exchanged` compares it in each of the two states of a step.
fn agree_in_motion(document: &Value, exchanged: impl Fn(&State, [i64; 3], &str)) {
    const STEPS: i64 = 5;
    let scene = read(document);
    let (model, state) = start(&scene);
    let mut both = SideBySide::new(scene.clone(), model.clone(), &state, Options::default());
    let units = units_of_a_step(false);
    let what = format!("{document:#}");
    both.steps(STEPS, units, &what, |step, found, expected| {
        between_walls(&scene, found);
        for reached in [found, expected] {
            exchanged(reached, state.total_momentum(), &format!("step {step}\n{document:#}"));
        }
        assert_eq!(found.walls.len(), expected.walls.len());
        for (a, b) in found.walls.iter().zip(&expected.walls) {
            for (a, b) in a.momentum().into_iter().zip(b.momentum()) {
                assert!((a - b).abs() <= units * step * state.len() as i64, "step {step}: {a} {b}\n{document:#}");
            }
        }
    });
    let [measured, expected] = both.energies(&what);
    let scale = (state.len() as f64 * model.units.momentum) * (units * STEPS) as f64;
    for (a, b) in measured.on_walls.momentum.as_flattened().iter().zip(expected.on_walls.momentum.as_flattened()) {
        assert!((a - b).abs() <= scale, "{a} {b}\n{document:#}");
    }
    let touched = measured.on_walls.momentum.as_flattened().iter().map(|sum| sum.abs()).fold(0.0, f64::max);
    assert!(touched > 1.0, "{touched}: too few meetings with walls to say something\n{document:#}");
    // Velocities of walls are a few units.
    assert!((measured.on_walls.work - expected.on_walls.work).abs() <= 20.0 * scale);
    // Work is a sum in single precision of impulses times velocities of a few units.
    let [a, b] = [measured.from_body_forces.work, expected.from_body_forces.work];
    let strongest = 10.0 * model.time_step * STEPS as f64 * state.len() as f64;
    assert!((a - b).abs() <= 1e-5 * strongest, "work: {a}, {b}\n{document:#}");
}

#[test]
fn walls_agree_with_the_reference() {
    for integrator in INTEGRATORS {
        for (edges, walls) in channels() {
            agree(&fluid(&edges, &walls, integrator, &[]));
        }
    }
}

/// Friction along bonds of the first particles, see [`agree_beside`].
fn frictional_bonds(bath: &Value) -> Value {
    json!({"type": "bonds", "pairs": [[0, 1], [1, 2]], "friction": 3, "bath": bath,
        "potential": {"type": "harmonic", "stiffness": 40}})
}

fn coloured_noise() -> Value {
    json!({"type": "coloured-noise", "strength": 20, "time": 0.1})
}

fn memory() -> Value {
    json!({"type": "memory", "rate": 3})
}

/// Couplings that persist, or act on single particles: friction along bonds, baths of both kinds, a coloured noise.
fn couplings() -> [Value; 6] {
    [
        json!({"type": "langevin", "friction": 2}),
        json!({"type": "langevin", "friction": 2, "bath": memory()}),
        coloured_noise(),
        frictional_bonds(&json!({"type": "white"})),
        frictional_bonds(&memory()),
        json!({"type": "body-force", "force": [30, -1]}),
    ]
}

/// Compares a scene of two dimensions, with three more particles at the front if the interaction is one of bonds.
fn agree_beside(mut document: Value, coupling: &Value) {
    if coupling["type"] == "bonds" {
        let at = |place: f64| [1.0 + place, 2.0];
        let listed = json!({"type": "listed", "positions": [at(0.0), at(0.6), at(1.2)]});
        document["particles"].as_array_mut().unwrap().insert(0, json!({"species": "light", "placement": listed}));
    }
    if coupling["type"] == "langevin" || coupling["type"] == "coloured-noise" {
        agree_in_motion(&document, |_, _, _| {});
    } else {
        agree(&document);
    }
}

#[test]
fn couplings_between_walls_agree_with_the_reference() {
    for (number, coupling) in couplings().iter().enumerate() {
        let (edges, walls) = &channels()[number % 2];
        let mut document = fluid(edges, walls, COTTER_REICH, std::slice::from_ref(coupling));
        if number % 2 == 0 {
            document["interactions"][0]["bath"] = memory();
        }
        agree_beside(document, coupling);
    }
    // In a volume, where some are fixed, and on a line.
    let (edges, walls) = &channels()[3];
    for integrator in [COTTER_REICH, GROOT_WARREN, PREDICTED] {
        let mut document = fluid(edges, walls, integrator, &[coloured_noise()]);
        document["particles"][1]["fixed"] = json!(true);
        agree_in_motion(&document, |_, _, _| {});
        agree(&fluid(&[40.0], &json!({"x": {}}), integrator, &[]));
    }
}

/// With bonds and with a body force, whose work over a drift that a wall has reflected is that of both its momenta.
#[test]
fn walls_beside_others_agree_with_the_reference() {
    let bonds = json!({"type": "bonds", "pairs": [[0, 1], [1, 2]], "potential": {"type": "harmonic", "stiffness": 40}});
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let (edges, walls) = &channels()[number % 4];
        let force = json!({"type": "body-force", "force": &[30.0, -1.0, 4.0][..edges.len()]});
        let mut document = fluid(edges, walls, integrator, &[force, bonds.clone()]);
        let last = edges.len() - 1;
        let near = |shift: f64| {
            (0..edges.len()).map(|axis| if axis == last { 2.0 + shift } else { 1.0 }).collect::<Vec<f64>>()
        };
        document["particles"][0]["placement"] = json!({"type": "lattice"});
        document["particles"].as_array_mut().unwrap().insert(
            0,
            json!({"species": "light", "placement": {"type": "listed", "positions": [near(0.0), near(0.6), near(-0.6)]}}),
        );
        agree(&document);
    }
}

/// Walls with layers of frozen particles behind them: both moving, one alone that is thin, beside other walls, specular ones that move.
fn layered_channels() -> Vec<(Vec<f64>, Value, Value)> {
    let layer = |axis: &str, wall: Option<&str>, thickness: f64| {
        let mut placement = json!({"type": "behind-walls", "axis": axis, "thickness": thickness});
        if let Some(wall) = wall {
            placement["wall"] = json!(wall);
        }
        json!({"species": format!("{} wall", wall.unwrap_or("each")), "number_density": 3.3, "mass": 0.7, "placement": placement})
    };
    let both = json!([layer("z", Some("lower"), 1.0), layer("z", Some("upper"), 0.6)]);
    vec![
        (
            vec![9.0, 7.0],
            json!({"y": {"lower_velocity": [-2.0, 0], "upper_velocity": [3.0, 0]}}),
            json!([layer("y", None, 1.0)]),
        ),
        (vec![9.0, 7.0], json!({"x": {}, "y": {}}), json!([layer("x", Some("upper"), 0.5)])),
        (
            vec![5.0, 4.0, 4.5],
            json!({"x": {"reflection": "specular"}, "z": {"lower_velocity": [0, 0.5, 0], "upper_velocity": [0, -1.0, 0]}}),
            both,
        ),
        (
            vec![5.0, 4.0, 4.5],
            json!({"x": {"reflection": "specular", "lower_velocity": [0, 0, -1.5]}}),
            json!([layer("x", None, 1.2)]),
        ),
    ]
}

/// A fluid beside layers, whose pairs with those of the first have coefficients of their own.
fn layered_fluid(channel: &(Vec<f64>, Value, Value), integrator: &str, others: &[Value]) -> Value {
    let (edges, walls, layers) = channel;
    let mut document = fluid(edges, walls, integrator, others);
    let groups = document["particles"].as_array_mut().unwrap();
    groups.extend(layers.as_array().unwrap().iter().cloned());
    let name = layers[0]["species"].clone();
    document["interactions"][0]["pairs"] = json!([{"between": ["light", name], "repulsion": 30, "friction": 6}, {"between": ["heavy", name], "friction": 0}]);
    document
}

#[test]
fn frozen_layers_agree_with_the_reference() {
    for integrator in INTEGRATORS {
        for channel in &layered_channels() {
            agree(&layered_fluid(channel, integrator, &[]));
        }
    }
}

/// With bonds between particles that move, body forces that leave frozen ones alone, and ranges of pairs of species.
#[test]
fn frozen_layers_beside_others_agree_with_the_reference() {
    let bonds = json!({"type": "bonds", "pairs": [[0, 1], [1, 2]], "potential": {"type": "harmonic", "stiffness": 1}});
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let channel = &layered_channels()[number % 4];
        let force = json!({"type": "body-force", "force": &[30.0, -1.0, 4.0][..channel.0.len()]});
        let mut document = layered_fluid(channel, integrator, &[force, bonds.clone()]);
        document["interactions"][0]["pairs"][0]["cutoff"] = json!(0.8);
        let last = channel.0.len() - 1;
        let near = |shift: f64| {
            (0..channel.0.len()).map(|axis| if axis == last { 2.0 + shift } else { 1.0 }).collect::<Vec<f64>>()
        };
        document["particles"].as_array_mut().unwrap().insert(
            0,
            json!({"species": "light", "placement": {"type": "listed", "positions": [near(0.0), near(0.6), near(-0.6)]}}),
        );
        agree(&document);
    }
}

/// Beside layers the walls absorb the impulses of pairs on frozen particles, and nothing acts on these alone: neither
/// the baths on every particle nor a random force.
#[test]
fn couplings_beside_layers_agree_with_the_reference() {
    for (number, coupling) in couplings().iter().enumerate() {
        let channel = &layered_channels()[number % 2];
        let mut document = layered_fluid(channel, COTTER_REICH, std::slice::from_ref(coupling));
        if number % 2 == 0 {
            document["interactions"][0]["bath"] = memory();
            document["interactions"][0]["skin"] = json!([0.05, 0.3, 0.1][number / 2]);
        }
        agree_beside(document, coupling);
    }
    // Split steps of pairs without friction visit their pairs once.
    let mut document = layered_fluid(&layered_channels()[0], SPLITTING, &couplings()[..1]);
    document["interactions"][0] = json!({"type": "dpd", "repulsion": 25, "friction": 0});
    agree_beside(document, &couplings()[0]);
    // A bath whose coupling is not its friction, in a volume; split steps; particles on a line.
    for integrator in [SPLITTING, STAGED] {
        for coupling in [&couplings()[0], &couplings()[3]] {
            agree_beside(layered_fluid(&layered_channels()[0], integrator, std::slice::from_ref(coupling)), coupling);
        }
    }
    let mut document = layered_fluid(&layered_channels()[2], COTTER_REICH, &[]);
    document["interactions"][0] = json!({"type": "dpd", "repulsion": 25, "friction": 0,
        "bath": {"type": "memory", "rate": 3, "coupling": 12}});
    agree(&document);
    let layer = json!({"species": "wall", "count": 5,
        "placement": {"type": "behind-walls", "axis": "x", "thickness": 1.5}});
    for integrator in [COTTER_REICH, GROOT_WARREN, PREDICTED] {
        agree(&layered_fluid(&(vec![40.0], json!({"x": {}}), json!([layer])), integrator, &[]));
    }
}

/// Fixed particles beside layers: both are held, and walls absorb impulses on the latter alone.
#[test]
fn fixed_particles_beside_layers_agree_with_the_reference() {
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let mut document = layered_fluid(&layered_channels()[number % 4], integrator, &[]);
        document["particles"][1]["fixed"] = json!(true);
        agree_in_motion(&document, |_, _, _| {});
    }
}

/// What is frozen is where it was against its wall, with the same momentum, after any step; the wall goes on by the same integer in every one.
#[test]
fn frozen_particles_go_with_their_walls() {
    for integrator in INTEGRATORS {
        for channel in &layered_channels() {
            let scene = read(&layered_fluid(channel, integrator, &[]));
            let (model, state) = start(&scene);
            let implementations: [Box<dyn Implementation>; 2] =
                [Box::new(Device::new(&scene)), reference_of_particles(model.clone(), state.clone())];
            let frozen: Vec<usize> =
                (0..state.len()).filter(|id| model.species[state.species[*id] as usize].frozen).collect();
            assert!(frozen.len() > 10);
            for mut implementation in implementations {
                let mut before = state.clone();
                let mut shifts = Vec::new();
                for step in 1..=4 {
                    implementation.step(1);
                    let found = implementation.state();
                    let shift = |id: &usize| -> [u32; 3] {
                        std::array::from_fn(|axis| found.positions[*id][axis].wrapping_sub(before.positions[*id][axis]))
                    };
                    let now: Vec<[u32; 3]> = frozen.iter().map(shift).collect();
                    assert!(step == 1 || now == shifts, "{} step {step}", implementation.name());
                    assert!(frozen.iter().all(|id| found.momenta[*id] == state.momenta[*id]), "step {step}");
                    for id in &frozen {
                        let velocity = model.units.momentum(state.momenta[*id]).map(|momentum| momentum / 0.7);
                        for axis in 0..3 {
                            let moved =
                                f64::from(now[frozen.iter().position(|other| other == id).unwrap()][axis] as i32);
                            let expected =
                                velocity[axis] * model.time_step / model.units.lengths[axis] * 4_294_967_296.0;
                            assert!((moved - expected).abs() <= 2.0 + 1e-6 * expected.abs(), "{moved} {expected}");
                        }
                    }
                    shifts = now;
                    before = found;
                }
            }
        }
    }
}

/// A particle alone in a box with specular walls is where it would be in a row of mirrored boxes, to the last place.
#[test]
fn a_free_particle_is_mirrored() {
    for integrator in INTEGRATORS {
        for edges in [vec![7.0, 3.0], vec![7.0, 3.0, 5.0]] {
            let walls = json!({"x": {"reflection": "specular"}, "y": {"reflection": "specular"}});
            let mut document = fluid(&edges, &walls, integrator, &[]);
            let (place, velocity) = (&[3.0, 0.25, 2.5][..edges.len()], &[1.75, -23.5, 3.25][..edges.len()]);
            document["interactions"] = json!([]);
            document["temperature"] = json!(0);
            document["particles"] = json!([{"species": "one",
                "placement": {"type": "listed", "positions": [place]},
                "velocities": {"type": "listed", "velocities": [velocity]}}]);
            let scene = read(&document);
            let (model, state) = start(&scene);
            let ends = model.units.ends();
            let implementations: [Box<dyn Implementation>; 2] =
                [Box::new(Device::new(&scene)), reference_of_particles(model.clone(), state.clone())];
            let drift = |axis: usize| {
                let momentum = f64::from(state.momenta[0][axis]) * model.units.momentum;
                (momentum * model.time_step / model.units.lengths[axis] * 4_294_967_296.0).round_ties_even() as i64
            };
            for mut implementation in implementations {
                for step in 1..=60_i64 {
                    implementation.step(1);
                    let found = implementation.state();
                    between_walls(&scene, &found);
                    for axis in 0..edges.len() {
                        let unfolded = i64::from(state.positions[0][axis]) + step * drift(axis);
                        let expected = match i64::from(ends[axis]) {
                            0 => unfolded.rem_euclid(1 << 32),
                            end if unfolded.rem_euclid(2 * end) < end => unfolded.rem_euclid(2 * end),
                            end => 2 * end - 1 - unfolded.rem_euclid(2 * end),
                        };
                        let off = (i64::from(found.positions[0][axis]) - expected).abs();
                        // Single precision rounds drifts, the same way in every step.
                        let allowed = if implementation.name() == "device" {
                            step * (1 + drift(axis).abs() / (1 << 22))
                        } else {
                            0
                        };
                        assert!(off <= allowed, "{} step {step} axis {axis}: {off} off", implementation.name());
                    }
                    assert_eq!(found.exchanged_momentum(), state.total_momentum());
                    let speed = |axis: usize| found.momenta[0][axis].abs();
                    assert!((0..3).all(|axis| speed(axis) == state.momenta[0][axis].abs()));
                }
            }
        }
    }
}

/// A wall that moves gives twice its momentum to what it reverses, and absorbs the rest, to the last bit.
#[test]
fn a_moving_wall_reverses_velocities_relative_to_its_own() {
    for integrator in INTEGRATORS {
        let walls = json!({"z": {"upper_velocity": [1.5, -0.5, 0]}});
        let mut document = fluid(&[5.0, 5.0, 5.0], &walls, integrator, &[]);
        document["interactions"] = json!([]);
        document["temperature"] = json!(0);
        document["particles"] = json!([{"species": "one", "mass": 2,
            "placement": {"type": "listed", "positions": [[1.0, 2.0, 4.95]]},
            "velocities": {"type": "listed", "velocities": [[1.0, 0.25, 5.0]]}}]);
        let scene = read(&document);
        let (model, state) = start(&scene);
        let implementations: [Box<dyn Implementation>; 2] =
            [Box::new(Device::new(&scene)), reference_of_particles(model.clone(), state.clone())];
        for mut implementation in implementations {
            implementation.step(1);
            let found = implementation.state();
            let name = implementation.name();
            let velocity = found.momenta[0].map(|units| f64::from(units) * model.units.momentum / 2.0);
            assert_eq!(velocity, [2.0 * 1.5 - 1.0, 2.0 * -0.5 - 0.25, -5.0], "{name}");
            // Half of the drift of .1 is over when the particle meets the wall.
            let place = model.units.position(found.positions[0]);
            let expected = [1.0 + 0.01 * (1.0 + 2.0), 2.0 + 0.01 * (0.25 - 1.25), 4.95];
            for axis in 0..3 {
                assert!((place[axis] - expected[axis]).abs() < 1e-7, "{name} {axis}: {place:?}");
            }
            let taken = found.walls[1].momentum().map(|units| units as f64 * model.units.momentum);
            assert_eq!(taken, [2.0 * (1.0 - 2.0), 2.0 * (0.25 + 1.25), 2.0 * 10.0], "{name}");
            assert_eq!(found.walls[0].momentum(), [0; 3], "{name}");
        }
    }
}

/// The same beside layers that move, whose pairs have potential energies and do work.
#[test]
fn energy_is_the_work_that_layers_do() {
    for integrator in [&INTEGRATORS[0], &INTEGRATORS[1], &INTEGRATORS[3]] {
        let mut document = layered_fluid(&layered_channels()[2], integrator, &[]);
        document["interactions"][0] = json!({"type": "dpd", "repulsion": 25, "friction": 0});
        document["space"]["walls"]["z"]["upper_velocity"] = json!([0, -3, 0]);
        document["particles"][0]["placement"] = json!({"type": "lattice"});
        document["time"]["step"] = json!(0.002);
        document["output"]["energies"]["every"] = json!(100);
        let scene = read(&document);
        for (name, [first, last]) in before_and_after(&scene, 500) {
            let gained = last.total_energy() - first.total_energy();
            let work = last.on_walls.work;
            assert!(work.abs() > 20.0, "{name}: {work}: too little to say something");
            assert!((gained - work).abs() < 1e-3 * last.total_energy(), "{name}: {gained} {work}");
        }
    }
}

/// Without friction the energy of a fluid changes by the work of walls and forces, as far as the leapfrog scheme keeps energies: a part of a
/// thousand here.
#[test]
fn energy_is_the_work_that_was_done() {
    let force = json!({"type": "body-force", "force": [2.0, 0, 0]});
    let walls = json!({"z": {"lower_velocity": [-1.0, 0, 0], "upper_velocity": [1.0, 0, 0]}});
    for integrator in [&INTEGRATORS[0], &INTEGRATORS[1], &INTEGRATORS[3]] {
        let mut document = fluid(&[5.0, 4.0, 4.5], &walls, integrator, std::slice::from_ref(&force));
        document["interactions"][0]["friction"] = json!(0);
        document["particles"][0]["placement"] = json!({"type": "lattice"});
        document["time"]["step"] = json!(0.002);
        document["output"]["energies"]["every"] = json!(100);
        let scene = read(&document);
        for (name, [first, last]) in before_and_after(&scene, 500) {
            let gained = last.total_energy() - first.total_energy();
            let [walls, forces] = [last.on_walls.work, last.from_body_forces.work];
            assert!(walls.abs() > 20.0 && forces.abs() > 5.0, "{walls}, {forces}: too little to say something");
            assert!((gained - walls - forces).abs() < 1e-3 * last.total_energy(), "{name}: {gained} {walls} {forces}");
        }
    }
}
