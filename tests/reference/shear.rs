//! Boundaries that shear on the device: against the float64 reference, step by step, and against what is exact.

use mesoscope::families::reference::Reference;
use mesoscope::plan::{Options, Traversal};
use mesoscope::scene::Checked;
use serde_json::{Value, json};

use crate::support::{
    COTTER_REICH, Device, GROOT_WARREN, Implementation, PREDICTED, SPLITTING, STAGED, SideBySide, engine, observables,
    reference_of_particles, start, units_of_a_step,
};

const SHEARED: [&str; 5] = [SPLITTING, GROOT_WARREN, PREDICTED, STAGED, COTTER_REICH];

fn read(document: &Value) -> Checked {
    crate::support::scene(&document.to_string())
}

/// A fluid of one or two species in a box whose boundaries shear.
fn fluid(edges: &[f64], shear: &Value, integrator: &str, heavy: bool) -> Value {
    let volume: f64 = edges.iter().product();
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    let group = |species: &str, count: f64, mass: f64| json!({"species": species, "count": count as u64, "mass": mass, "placement": {"type": "random"}});
    let light = group("light", 2.0 * volume, 1.0);
    json!({
        "title": "sheared", "seed": 5, "space": {"box": edges, "shear": shear},
        "time": {"step": 0.02, "steps": 1}, "temperature": 1, "integrator": integrator,
        "particles": if heavy { json!([light, group("heavy", volume, 2.5)]) } else { json!([light]) },
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {"energies": {"every": 1}},
    })
}

/// Boxes of many cells along the flow, of three, of one, and of three between the boundaries, and shear of either sign, which may start
/// displaced.
fn boxes() -> Vec<(Vec<f64>, Value)> {
    vec![
        (vec![9.0, 7.0], json!({"rate": 0.7, "gradient": "y"})),
        (vec![6.0, 4.0, 4.5], json!({"rate": -1.1, "flow": "x", "gradient": "y", "displacement": 2.2})),
        (vec![3.5, 4.0, 3.0], json!({"rate": 1.3, "gradient": "z", "displacement": -1.1})),
        (vec![2.5, 3.2, 5.0], json!({"rate": 0.9, "gradient": "z"})),
    ]
}

/// Compares some steps, of which the first has a number near the end of its low word. Boundaries are displaced by any part of the box there.
fn agree(document: &Value, options: Options) {
    agree_for(5, document, options);
}

fn agree_for(steps: i64, document: &Value, options: Options) {
    let scene = read(document);
    let (model, mut state) = start(&scene);
    state.step = (1 << 32) - 3;
    if document["integrator"]["lambda"].is_number() {
        state.predicted.clone_from(&state.momenta);
    }
    let is_of_particles =
        |interaction: &Value| interaction["type"] == "langevin" || interaction["type"] == "coloured-noise";
    let conserves = !document["interactions"].as_array().unwrap().iter().any(is_of_particles);
    let mut both = SideBySide::new(scene, model, &state, options);
    let what = format!("{options:?}\n{document:#}");
    let mut crossed = false;
    both.steps(steps, units_of_a_step(false), &what, |step, found, expected| {
        if conserves {
            assert_eq!(found.exchanged_momentum(), state.total_momentum(), "step {step} {what}");
            assert_eq!(expected.exchanged_momentum(), state.total_momentum(), "step {step} {what}");
        }
        assert_eq!(found.walls, expected.walls, "step {step} {what}");
        crossed |= found.walls[0].momentum()[0] != 0;
    });
    assert!(crossed, "too few crossings to say something {what}");
    both.energies(&what);
}

#[test]
fn shear_agrees_with_the_reference() {
    for (number, integrator) in SHEARED.iter().enumerate() {
        // Two boxes, one or two species and either traversal, by turns.
        for (place, (edges, shear)) in boxes().into_iter().enumerate().skip(number % 2).step_by(2) {
            let document = fluid(&edges, &shear, integrator, (number + place / 2) % 2 == 1);
            let traversal = [None, Some(Traversal::Rows)][(number / 2 + place / 2) % 2];
            agree(&document, Options { traversal, ..Options::default() });
        }
    }
}

/// Local densities of copies, and forces that depend on them.
#[test]
fn densities_across_boundaries_agree_with_the_reference() {
    for (number, integrator) in SHEARED.iter().enumerate() {
        let (edges, shear) = &boxes()[number % 4];
        let mut document = fluid(edges, shear, integrator, number % 2 == 1);
        document["interactions"][0]["repulsion"] = json!(-10);
        document["interactions"][0]["many_body"] = json!({"repulsion": 6, "cutoff": 0.8});
        let traversal = [None, Some(Traversal::Rows)][number / 2 % 2];
        agree(&document, Options { traversal, ..Options::default() });
    }
}

/// Bonds and angles between copies.
#[test]
fn chains_across_boundaries_agree_with_the_reference() {
    for (number, integrator) in SHEARED.iter().enumerate() {
        let (edges, shear) = &boxes()[number % 3];
        let mut document = fluid(edges, shear, integrator, true);
        for group in document["particles"].as_array_mut().unwrap() {
            group["count"] = json!(group["count"].as_u64().unwrap() / 4 * 4);
            group["chain"] = json!({"beads": 4, "spacing": 0.7});
        }
        document["interactions"].as_array_mut().unwrap().extend([
            json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40}, "exclude_repulsion": number > 1}),
            json!({"type": "angles", "stiffness": 5}),
        ]);
        let scene = read(&document);
        let (model, state) = start(&scene);
        let axis = model.particles().shear.unwrap().gradient;
        let half = 1_u32 << 31;
        let crosses = |ends: [u32; 2]| {
            let [a, b] = ends.map(|end| state.positions[end as usize][axis]);
            a.abs_diff(b) > half
        };
        assert!(model.particles().bonds.as_ref().unwrap().iter().any(|bond| crosses(bond.ends)));
        agree(&document, Options::default());
    }
}

/// Lists that last for some steps while boundaries move on, slowly and displaced: pairs beside a coloured noise, of
/// which the reference searches all in every step, and pairs with memory, whose anchors say when a list was made.
#[test]
fn lists_that_last_across_boundaries_agree_with_the_reference() {
    for remembers in [false, true] {
        let edges = [6.0, 4.0, 4.5];
        let shear = json!({"rate": 0.08, "gradient": "y", "displacement": 2.7});
        let mut document = fluid(&edges, &shear, COTTER_REICH, true);
        document["time"]["step"] = json!(0.005);
        document["temperature"] = json!(2);
        document["interactions"][0]["skin"] = json!(0.3);
        if remembers {
            document["interactions"][0]["bath"] = json!({"type": "memory", "rate": 4});
        } else {
            let noise = json!({"type": "coloured-noise", "strength": 1, "time": 0.1});
            document["interactions"].as_array_mut().unwrap().push(noise);
        }
        let scene = read(&document);
        let (model, state) = start(&scene);
        let (force, shear) = (model.particles().pair_force.clone().unwrap(), model.particles().shear.unwrap());
        // Boundaries go an eighth of the part of the margin after which a list is made again.
        let growth = f64::from(shear.shift(2).wrapping_sub(shear.shift(0))) / 2_f64.powi(32) * edges[0];
        assert!((growth - 0.0016).abs() < 1e-5 && force.skin > 0.25, "{growth} {}", force.skin);
        let mut both = SideBySide::new(scene, model, &state, Options::default());
        let (mut lists, mut anchors) = (0, [Vec::new(), Vec::new()]);
        both.steps(60, units_of_a_step(false), &document.to_string(), |step, found, expected| {
            // Both list anew in the same steps; places differ by some units.
            let renewed = [found.anchors != anchors[0], expected.anchors != anchors[1]];
            assert_eq!(renewed[0], renewed[1], "step {step}");
            lists += u32::from(renewed[0]);
            anchors = [found.anchors.clone(), expected.anchors.clone()];
        });
        assert!(!remembers || (5..40).contains(&lists), "{lists} lists");
        both.energies(&document.to_string());
    }
}

/// Listed pairs with memory, whose list is made again in every step, so fast do boundaries move.
#[test]
fn lists_across_boundaries_agree_with_the_reference() {
    for (number, (edges, shear)) in boxes().into_iter().enumerate() {
        let mut document = fluid(&edges, &shear, COTTER_REICH, number % 2 == 1);
        document["interactions"][0]["bath"] = json!({"type": "memory", "rate": 4});
        document["time"]["step"] = json!(0.01);
        agree_for(12, &document, Options::default());
    }
}

/// Baths and forces on single particles, and baths along bonds, which see the flow or the box, and copies across
/// boundaries.
#[test]
fn baths_across_boundaries_agree_with_the_reference() {
    let white = json!({"type": "white"});
    let memory = json!({"type": "memory", "rate": 3});
    let langevin =
        |bath: &Value, velocity: &str| json!({"type": "langevin", "friction": 3, "bath": bath, "velocity": velocity});
    let bonds = |bath: &Value| json!({"type": "bonds", "potential": {"type": "harmonic", "stiffness": 40}, "friction": 3, "bath": bath});
    // A stronger noise would need units of forces in which the squares of these are rounded.
    let noise = json!({"type": "coloured-noise", "strength": 1, "time": 0.1});
    let cases = [
        (SPLITTING, langevin(&white, "peculiar")),
        (SPLITTING, langevin(&white, "laboratory")),
        (COTTER_REICH, langevin(&white, "peculiar")),
        (GROOT_WARREN, langevin(&white, "peculiar")),
        (PREDICTED, langevin(&white, "laboratory")),
        (COTTER_REICH, langevin(&memory, "peculiar")),
        (COTTER_REICH, langevin(&memory, "laboratory")),
        (COTTER_REICH, noise.clone()),
        (GROOT_WARREN, noise.clone()),
        (SPLITTING, bonds(&white)),
        (COTTER_REICH, bonds(&white)),
        (PREDICTED, bonds(&white)),
        (COTTER_REICH, bonds(&memory)),
        (SPLITTING, langevin(&memory, "peculiar")),
        (STAGED, noise),
        (SPLITTING, bonds(&memory)),
    ];
    for (number, (integrator, beside)) in cases.into_iter().enumerate() {
        let (edges, shear) = &boxes()[number % 3];
        let mut document = fluid(edges, shear, integrator, number % 2 == 1 || beside["type"] == "bonds");
        if beside["type"] == "bonds" {
            for group in document["particles"].as_array_mut().unwrap() {
                group["count"] = json!(group["count"].as_u64().unwrap() / 4 * 4);
                group["chain"] = json!({"beads": 4, "spacing": 0.7});
            }
        }
        // With pairs, and by themselves.
        let alone = number % 4 == 0 && number < 12 && beside["type"] != "bonds";
        let mut interactions = document["interactions"].as_array().unwrap().clone();
        interactions.push(beside);
        document["interactions"] = json!(interactions[usize::from(alone)..]);
        agree(&document, Options::default());
    }
}

/// Particles that nothing acts on are where straight ways in the plane of all copies have taken them, to the last place: what crosses a
/// boundary at any time of a step comes in at the same place.
#[test]
fn free_particles_go_straight_among_the_copies() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        let mut document = fluid(&[7.0, 3.0], &json!({"rate": 1.5, "gradient": "y"}), integrator, false);
        document["interactions"] = json!([]);
        document["temperature"] = json!(0);
        document["particles"] = json!([{"species": "one",
            "placement": {"type": "listed", "positions": [[1.0, 0.1], [2.0, 2.9], [6.5, 1.5]]},
            "velocities": {"type": "listed", "velocities": [[1.5, -3.25], [-2.0, 7.5], [0.25, 0.0]]}}]);
        let scene = read(&document);
        let (model, state) = start(&scene);
        let shear = model.particles().shear.unwrap();
        let implementations: [Box<dyn Implementation>; 2] =
            [Box::new(Device::new(&scene)), reference_of_particles(model.clone(), state.clone())];
        for mut implementation in implementations {
            for step in 1..=80_i64 {
                implementation.step(1);
                let found = implementation.state();
                for id in 0..state.len() {
                    let way = |axis: usize| {
                        let momentum = f64::from(state.momenta[id][axis]) * model.units.momentum;
                        momentum * model.time_step * step as f64 / model.units.lengths[axis] * 4_294_967_296.0
                    };
                    let y = i64::from(state.positions[id][1]) + way(1).round() as i64;
                    let boxes = y.div_euclid(1 << 32);
                    let displaced = i64::from(shear.shift(2 * step as u64)) * boxes;
                    let x = i64::from(state.positions[id][0]) + way(0).round() as i64 - displaced;
                    let jump = boxes * i64::from(shear.jump(0, &model));
                    assert_eq!(i64::from(found.momenta[id][0]), i64::from(state.momenta[id][0]) - jump, "step {step}");
                    let off = |found: u32, expected: i64| i64::from(found.wrapping_sub(expected as u32) as i32).abs();
                    // Of every drift the last place; of single precision also what it leaves of its 24 bits. A jump is a whole number of
                    // units, of which a drift is 2^-24 of what the jump makes of it.
                    let places = step * (2 + (1 << 26) / (1 << 22));
                    assert!(
                        off(found.positions[id][0], x) <= places,
                        "{} step {step}: x of {id}",
                        implementation.name()
                    );
                    assert!(
                        off(found.positions[id][1], y) <= places,
                        "{} step {step}: y of {id}",
                        implementation.name()
                    );
                }
                assert_eq!(found.exchanged_momentum(), state.total_momentum());
            }
        }
    }
}

/// Two particles in contact across a boundary, of which one is seen displaced and faster: repulsion and friction are those of the distance
/// and the velocity between the copies.
#[test]
fn a_pair_across_a_boundary_sees_copies() {
    // After 10 steps of 0.05 the boundaries of a box of 4 with a rate of 1 are displaced by 2.
    let mut document = fluid(&[8.0, 4.0], &json!({"rate": 1.0, "gradient": "y"}), GROOT_WARREN, false);
    document["temperature"] = json!(0);
    document["time"]["step"] = json!(0.05);
    document["particles"] = json!([{"species": "one",
        "placement": {"type": "listed", "positions": [[3.0, 3.9], [1.4, 0.4]]},
        "velocities": {"type": "listed", "velocities": [[0.5, 0.0], [0.5, 0.0]]}}]);
    let scene = read(&document);
    let (model, mut state) = start(&scene);
    state.step = 10;
    let implementations: [Box<dyn Implementation>; 2] = [
        Box::new(Device::from_state(&scene, &state, Options::default())),
        reference_of_particles(model.clone(), state.clone()),
    ];
    for mut implementation in implementations {
        let observed = implementation.observe();
        // From the copy of the second at (3.4, 4.4), which moves with .5 + 4.
        let distance = (0.4_f64.powi(2) + 0.5_f64.powi(2)).sqrt();
        let closeness = 1.0 - distance;
        let energy = 0.5 * 25.0 * closeness * closeness;
        let name = implementation.name();
        assert!((observed.potential_energy / energy - 1.0).abs() < 1e-5, "{name}: {}", observed.potential_energy);
        let [x, y] = [-0.4 / distance, -0.5 / distance];
        let force = 25.0 * closeness - 4.5 * closeness * closeness * x * (0.5 - 4.5);
        implementation.step(1);
        let found = implementation.state();
        let impulse = 0.05 * force;
        for (id, sign) in [(0, 1.0), (1, -1.0)] {
            let velocity = found.momenta[id].map(|units| f64::from(units) * model.units.momentum);
            let expected = [0.5 + sign * impulse * x, sign * impulse * y];
            assert!(
                (0..2).all(|axis| (velocity[axis] - expected[axis]).abs() < 1e-5),
                "{name}: {velocity:?} {expected:?}"
            );
        }
    }
}

/// The difference of positions after the same time with steps twice as long, by size.
fn error_of_halving(integrator: &str, steps: [u64; 2]) -> f64 {
    let run = |count: u64| {
        let mut document = fluid(&[5.0, 4.0], &json!({"rate": 1.0, "gradient": "y"}), integrator, false);
        document["temperature"] = json!(0);
        document["particles"][0]["placement"] = json!({"type": "lattice", "jitter": 0.2});
        document["particles"][0]["velocities"] = json!({"type": "rest"});
        // With a friction of nothing to speak of steps are split.
        document["interactions"][0]["friction"] = json!(1e-9);
        document["interactions"][0]["repulsion"] = json!(5);
        document["time"]["step"] = json!(0.4 / count as f64);
        let scene = read(&document);
        let (model, state) = start(&scene);
        let mut reference = Reference::new(model, state);
        reference.run(count).unwrap();
        (scene.model().clone(), reference.state().clone())
    };
    let [(model, a), (_, b)] = steps.map(run);
    let square = |(a, b): (&[u32; 3], &[u32; 3])| model.units.displacement(*a, *b).iter().map(|d| d * d).sum::<f64>();
    (a.positions.iter().zip(&b.positions).map(square).sum::<f64>() / a.len() as f64).sqrt()
}

/// Where boundaries are displaced in time with the particles, the error is that of the integrators without shear: a quarter at half the
/// step.
#[test]
fn shear_keeps_the_order_of_the_integrators() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        let [coarse, fine] = [[10, 20], [20, 40]].map(|steps| error_of_halving(integrator, steps));
        let ratio = coarse / fine;
        assert!((3.0..5.5).contains(&ratio), "{integrator}: {coarse:e} {fine:e}");
    }
}

/// The start flows with the linear profile, and its temperature is about that.
#[test]
fn thermal_starts_flow_with_the_profile() {
    let document = fluid(&[9.0, 30.0], &json!({"rate": 2.0, "gradient": "y"}), SPLITTING, true);
    let scene = read(&document);
    let (model, state) = start(&scene);
    let mut sums = [0.0; 2];
    for (id, position) in state.positions.iter().enumerate() {
        let height = f64::from(position[1]) / 4_294_967_296.0 - 0.5;
        let mass = model.species[state.species[id] as usize].mass;
        sums[0] += height * f64::from(state.momenta[id][0]) * model.units.momentum / mass;
        sums[1] += height * height;
    }
    // The slope is 60 to a part of 1/sqrt(N h²) = 12 % of thermal velocities.
    assert!((sums[0] / sums[1] - 60.0).abs() < 5.0 * 0.13, "{}", sums[0] / sums[1]);
    let observed = observables(&mut engine(&scene, &state, Options::default()), &scene);
    // d N = 1620 degrees of freedom.
    assert!((observed.kinetic_temperature() - 1.0).abs() < 5.0 * (2.0_f64 / 1620.0).sqrt());
    assert_eq!(state.total_momentum()[1], 0);
}

/// Profiles of the velocity along the gradient are about that of the flow, which is up to 30 here; sums over a layer scatter by √(Σm kT), 16.
#[test]
fn profiles_are_about_the_flow() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        let mut document = fluid(&[9.0, 30.0], &json!({"rate": 2.0, "gradient": "y"}), integrator, true);
        document["time"] = json!({"step": 0.005, "steps": 10});
        document["output"]["profiles"] = json!({"axis": "y", "bins": 5, "every": 1});
        let scene = read(&document);
        let (model, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(3, 3).unwrap();
        engine.reported().unwrap();
        let samples = engine.finish().unwrap();
        let last = samples.iter().rfind(|sample| sample.sampler == 1).unwrap();
        for layer in last.sums.chunks_exact(6) {
            let [counts, momentum] = [layer[0] + layer[1], layer[3]];
            assert!(counts > 100, "{layer:?}");
            let momentum = momentum as f64 * model.units.momentum;
            assert!(momentum.abs() < 6.0 * 16.0, "{integrator}: {momentum}");
        }
    }
}
