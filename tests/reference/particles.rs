//! The float64 reference against closed forms, conservation laws and published or independently measured values.

use mesoscope::families::Model;
use mesoscope::families::initial_state;
use mesoscope::families::reference::{Reference, Relaxation, Unstable};
use mesoscope::noise::{self, stream};
use mesoscope::scene::{Checked, Distribution, Generator, Scene};
use mesoscope::state::State;
use serde_json::{Value, json};

/// A scene with some keys replaced.
fn scene(changes: &Value) -> Checked {
    let mut scene = json!({
        "title": "test", "seed": 11, "space": {"box": [10.0, 10.0, 10.0]}, "time": {"step": 0.1, "steps": 1},
        "temperature": 0.0, "particles": [],
        "interactions": [{"type": "dpd", "repulsion": 20.0, "friction": 4.0}],
    });
    for (key, value) in changes.as_object().unwrap() {
        scene[key] = value.clone();
    }
    let scene: Scene = serde_json::from_value(scene).unwrap();
    scene.check_but_step().unwrap()
}

fn start(changes: &Value) -> (Model, State) {
    let scene = scene(changes);
    (scene.model().clone(), initial_state(&scene))
}

fn reference(changes: &Value) -> Reference {
    let (model, state) = start(changes);
    Reference::new(model, state)
}

fn integrators() -> [Value; 5] {
    [
        json!({"type": "groot-warren"}),
        json!({"type": "groot-warren", "lambda": 0.65}),
        json!({"type": "cotter-reich"}),
        json!({"type": "splitting"}),
        json!({"type": "splitting", "relaxation": "two-stages"}),
    ]
}

/// Two unit masses on the x axis, half a cutoff apart and approaching at unit speed each.
fn approaching(integrator: &Value) -> Value {
    json!({"integrator": integrator, "particles": [{"species": "A",
        "placement": {"type": "listed", "positions": [[1.0, 2.0, 3.0], [1.5, 2.0, 3.0]]},
        "velocities": {"type": "listed", "velocities": [[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]}}]})
}

/// The standard fluid on a lattice with thermal velocities; `count` particles at density 3.
fn fluid(count: u32, time_step: f64, integrator: &Value) -> Value {
    let edge = (f64::from(count) / 3.0).cbrt();
    json!({"space": {"box": [edge, edge, edge]}, "time": {"step": time_step, "steps": 1}, "temperature": 1.0,
        "integrator": integrator,
        "particles": [{"species": "A", "count": count, "placement": {"type": "lattice"}}],
        "interactions": [{"type": "dpd", "repulsion": 25.0, "friction": 4.5}]})
}

#[track_caller]
fn assert_close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "found {found}, expected {expected} ± {tolerance}");
}

/// First drift and next reported momentum of the approaching pair, along x, for both particles.
#[track_caller]
fn assert_first_step(mut run: Reference, drift: f64, momentum: f64) {
    let units = run.model().units;
    assert_eq!(run.reported_state().unwrap().momenta, run.state().momenta, "step 0 reports the initial momenta");
    run.step().unwrap();
    for (particle, sign, origin) in [(0, 1.0, 1.0), (1, -1.0, 1.5)] {
        let position = units.position(run.state().positions[particle]);
        assert_close(position[0], origin + sign * drift, 1e-8);
        assert_close(position[1], 2.0, 1e-8);
        let reported = units.momentum(run.reported_state().unwrap().momenta[particle]);
        assert_close(reported[0], sign * momentum, 1e-7);
        assert_eq!(reported[1..], [0.0, 0.0]);
    }
}

#[test]
fn groot_warren_by_hand() {
    // f(0) = -(20 · ½ + 4 · ¼ · 2) = -12, so p(½) = 1 - .05 · 12 = .4 and the next distance is .42.
    // f(1) = -(20 · .58 + 4 · .58² · .8) = -12.67648.
    let run = reference(&approaching(&json!({"type": "groot-warren"})));
    assert_first_step(run, 0.04, 0.4 - 0.05 * 12.676_48);
    // Predicted: ṽ = 1 - .65 · 1.2 = .4 - .18, of which six bits are kept: .4 - 23 · 2⁻⁷ = .2203125.
    // So f(1) = -(11.6 + 4 · .58² · .440625) = -12.192905.
    let run = reference(&approaching(&json!({"type": "groot-warren", "lambda": 0.65})));
    assert_first_step(run, 0.04, 0.4 - 0.05 * 12.192_905);
}

#[test]
fn cotter_reich_by_hand() {
    // φ = -½ (1 - r)². The drift that led to step 0 came from r = .7: s = 4 (-.125 + .045) / .1 = -3.2 and
    // f(0) = -(10 + .5 · 3.2) = -11.6, so p(½) = .42 and the next distance is .416.
    // s = 4 (-½ · .584² + .125) / .1 = -1.82112 and f(1) = -(20 · .584 + .584 · 1.82112) = -12.74353408.
    let run = reference(&approaching(&json!({"type": "cotter-reich"})));
    assert_first_step(run, 0.042, 0.42 - 0.05 * 12.743_534_08);
}

#[test]
fn splitting_by_hand() {
    // C(0) = -.5, p(½) = .5, next distance .4; C(1) = -.6 and p' = -.1, γω = 4 · .36 = 1.44, μ = ½.
    let (model, state) = start(&approaching(&json!({"type": "splitting"})));
    let exact = -0.1 * (-1.44_f64 * 0.1 / 0.5).exp();
    let run = Reference::with_relaxation(model.clone(), state.clone(), Relaxation::Exponential);
    assert_first_step(run, 0.05, exact);
    // Two stages: 1 - h + .095 h² with h = 1.44 · .1 / .5.
    let staged = -0.1 * (1.0 - 0.288 + 0.095 * 0.288 * 0.288);
    assert_first_step(Reference::with_relaxation(model.clone(), state.clone(), Relaxation::TwoStages), 0.05, staged);
    // Explicit: -.1 + .144 · .2; one correction: from the midpoint -.0856; two: from -.0876736.
    for (corrections, momentum) in
        [(0, -0.1 + 0.144 * 0.2), (1, -0.1 + 0.144 * 0.1712), (2, -0.1 + 0.144 * 2.0 * 0.087_673_6)]
    {
        let rule = Relaxation::Midpoint { corrections };
        assert_first_step(Reference::with_relaxation(model.clone(), state.clone(), rule), 0.05, momentum);
    }
    // The iteration converges to the implicit midpoint rule, (1 - g/2) / (1 + g/2).
    let rule = Relaxation::Midpoint { corrections: 30 };
    let run = Reference::with_relaxation(model, state, rule);
    assert_first_step(run, 0.05, -0.1 * (1.0 - 0.144) / (1.0 + 0.144));
}

#[test]
fn noise_by_hand() {
    for (generator, name) in [(Generator::Pcg4d, "pcg4d"), (Generator::Threefry2x32, "threefry2x32-20")] {
        for (distribution, distribution_name) in
            [(Distribution::Uniform, "uniform"), (Distribution::Gaussian, "gaussian")]
        {
            let changes = json!({"temperature": 0.5, "noise": {"generator": name, "distribution": distribution_name},
                "particles": [{"species": "A", "velocities": {"type": "rest"},
                    "placement": {"type": "listed", "positions": [[1.5, 2.0, 9.75], [1.5, 2.0, 0.25]]}}],
                "interactions": [{"type": "dpd", "friction": 4.0, "weight_exponent": 1.0}]});
            // The pair is half a cutoff apart through the periodic wall; e is -z. σ² = 2 · 4 · ½ and ω = ½.
            let amplitude = 2.0 * 0.5_f64.sqrt();
            let zeta = |step| {
                let words = noise::words(generator, noise::step_key(11, stream::PAIR, step), [0, 1]);
                match distribution {
                    Distribution::Uniform => 12.0_f64.sqrt() * noise::centred_uniform(words[0]),
                    Distribution::Gaussian => noise::gaussian(words),
                }
            };
            let mut changed = changes.clone();
            for integrator in ["groot-warren", "cotter-reich"] {
                changed["integrator"] = json!({"type": integrator});
                let mut run = reference(&changed);
                run.step().unwrap();
                let momentum = run.model().units.momentum(run.state().momenta[0]);
                assert_close(momentum[2], -0.5 * 0.1_f64.sqrt() * amplitude * zeta(0), 1e-7);
            }
            changed["integrator"] = json!({"type": "splitting"});
            let (model, state) = start(&changed);
            let mut run = Reference::with_relaxation(model.clone(), state.clone(), Relaxation::Exponential);
            run.step().unwrap();
            assert_eq!(run.state().momenta, state.momenta, "step 0 has no relaxation");
            let momentum = run.model().units.momentum(run.reported_state().unwrap().momenta[0]);
            // Width √(kT/μ (1 - e^(-2g))) = √(1 - e^(-.8)), times μ = ½.
            assert_close(momentum[2], -0.5 * (1.0 - (-0.8_f64).exp()).sqrt() * zeta(1), 1e-7);
            // Two stages: √(2h) (1 - (1 + 2b)/4 h) instead, with h = .4 and b = .095.
            let mut run = Reference::with_relaxation(model.clone(), state.clone(), Relaxation::TwoStages);
            run.step().unwrap();
            let momentum = run.model().units.momentum(run.reported_state().unwrap().momenta[0]);
            let width = 0.8_f64.sqrt() * (1.0 - 0.2975 * 0.4);
            // Which is nearly what friction takes, 1 - (1 - h + bh²)².
            assert_close(width.powi(2), 1.0 - (1.0 - 0.4 + 0.095 * 0.16_f64).powi(2), 1e-3);
            assert_close(momentum[2], -0.5 * width * zeta(1), 1e-7);
            let rule = Relaxation::Midpoint { corrections: 0 };
            let mut run = Reference::with_relaxation(model, state, rule);
            run.step().unwrap();
            let momentum = run.model().units.momentum(run.reported_state().unwrap().momenta[0]);
            assert_close(momentum[2], -0.1_f64.sqrt() * amplitude * zeta(1), 1e-7);
        }
    }
}

/// Two species of different masses and coefficients, in two or three dimensions.
fn mixture(lengths: &[f64], integrator: &Value) -> Value {
    json!({"space": {"box": lengths}, "time": {"step": 0.02, "steps": 1}, "temperature": 1.5, "integrator": integrator,
        "particles": [{"species": "A", "count": 90}, {"species": "B", "count": 60, "mass": 2.5},
            {"species": "A", "count": 7, "velocities": {"type": "rest"}}],
        "interactions": [{"type": "dpd", "repulsion": 25.0, "friction": 4.5,
            "pairs": [{"between": ["A", "B"], "repulsion": 40.0, "friction": 9.0}]}]})
}

#[test]
fn momentum_is_conserved_to_the_last_bit() {
    for integrator in integrators() {
        for lengths in [&[3.5, 4.0, 4.5][..], &[2.5, 4.0, 4.5], &[6.0, 7.0]] {
            let mut run = reference(&mixture(lengths, &integrator));
            let before = run.state().clone();
            run.run(100).unwrap();
            assert_ne!(run.state().momenta, before.momenta);
            assert_eq!(run.state().total_momentum(), [0; 3], "{integrator} {lengths:?}");
            assert_eq!(run.reported_state().unwrap().total_momentum(), [0; 3]);
            assert_eq!(run.observe().unwrap().momentum, [0.0; 3]);
            assert_eq!(run.state().step, 100);
        }
    }
}

#[test]
fn relaxations_conserve_momentum() {
    for rule in [Relaxation::Exponential, Relaxation::Midpoint { corrections: 3 }] {
        let (model, state) = start(&mixture(&[3.5, 4.0, 4.5], &json!({"type": "splitting"})));
        let mut run = Reference::with_relaxation(model, state, rule);
        run.run(50).unwrap();
        assert_eq!(run.state().total_momentum(), [0; 3]);
    }
}

#[test]
fn free_particles_fly_straight() {
    for integrator in integrators() {
        let mut run = reference(&json!({"integrator": integrator, "interactions": [], "particles": [
            {"species": "A", "mass": 2.0, "placement": {"type": "listed", "positions": [[9.0, 0.5, 5.0]]},
             "velocities": {"type": "listed", "velocities": [[0.75, -0.5, 0.0]]}}]}));
        run.run(80).unwrap();
        let units = run.model().units;
        // x = 9 + 6 and y = .5 - 4, through the walls.
        let position = units.position(run.state().positions[0]);
        for (found, expected) in position.into_iter().zip([5.0, 6.5, 5.0]) {
            assert_close(found, expected, 80.0 * 10.0 / 4_294_967_296.0);
        }
        assert_eq!(units.momentum(run.state().momenta[0]), [1.5, -1.0, 0.0]);
        assert_eq!(run.reported_state().unwrap().momenta, run.state().momenta);
    }
}

#[test]
fn energy_without_friction_is_conserved_to_second_order() {
    for integrator in integrators() {
        let error = |time_step: f64| {
            let mut changes = fluid(192, time_step, &integrator);
            changes["interactions"][0]["friction"] = json!(0.0);
            let mut run = reference(&changes);
            let initial = run.observe().unwrap().total_energy();
            let steps = (2.0 / time_step).round() as usize;
            let squares: f64 = (0..steps)
                .map(|_| {
                    run.step().unwrap();
                    (run.observe().unwrap().total_energy() - initial).powi(2)
                })
                .sum();
            (squares / steps as f64).sqrt() / initial
        };
        let (coarse, fine) = (error(0.01), error(0.005));
        assert!(coarse < 1e-3, "{integrator}: {coarse}");
        let ratio = coarse / fine;
        assert!((3.2..4.8).contains(&ratio), "{integrator}: {coarse} / {fine} = {ratio}");
    }
}

#[test]
fn friction_alone_takes_energy_away() {
    for integrator in integrators() {
        let mut changes = fluid(192, 0.02, &integrator);
        changes["interactions"][0]["repulsion"] = json!(0.0);
        let (mut model, state) = start(&changes);
        model.temperature = 0.0;
        model.particles_mut().and_then(|particles| particles.pair_force.as_mut()).unwrap().temperature = 0.0;
        let mut run = Reference::new(model, state);
        let initial = run.observe().unwrap().kinetic_energy;
        let mut last = initial;
        for step in 0..100 {
            run.step().unwrap();
            let energy = run.observe().unwrap().kinetic_energy;
            assert!(energy < last, "{integrator}, step {step}: {energy} after {last}");
            last = energy;
        }
        assert!(last < 0.1 * initial, "{integrator}: {last} of {initial}");
    }
}

#[test]
fn the_step_counter_has_64_bits() {
    for integrator in integrators() {
        let (mut model, state) = start(&mixture(&[4.0, 4.0, 4.0], &integrator));
        let after = |model: &Model, step: u64| {
            let mut run = Reference::new(model.clone(), State { step, ..state.clone() });
            run.step().unwrap();
            assert_eq!(run.state().step, step + 1);
            run.state().momenta.clone()
        };
        let wrapped = 1_u64 << 32;
        assert_ne!(after(&model, wrapped + 5), after(&model, 5), "{integrator}: noise repeats");
        assert_eq!(after(&model, 5), after(&model, 5));
        model.temperature = 0.0;
        model.particles_mut().and_then(|particles| particles.pair_force.as_mut()).unwrap().temperature = 0.0;
        assert_eq!(after(&model, wrapped), after(&model, 5), "{integrator}: taken for the first step");
        assert_ne!(after(&model, wrapped), after(&model, 0));
    }
}

#[test]
fn a_run_continues_from_its_state() {
    for integrator in integrators() {
        let (model, state) = start(&mixture(&[4.0, 4.0, 4.0], &integrator));
        let mut whole = Reference::new(model.clone(), state.clone());
        whole.run(20).unwrap();
        let mut half = Reference::new(model.clone(), state);
        half.run(10).unwrap();
        let observed = half.observe().unwrap();
        assert_eq!(half.observe().unwrap(), observed, "observing changes nothing");
        let mut rest = Reference::new(model, half.state().clone());
        rest.run(10).unwrap();
        assert_eq!(rest.state(), whole.state(), "{integrator}");
    }
}

#[test]
fn none_one_and_two_particles() {
    for integrator in integrators() {
        for lengths in [json!([4.0, 4.0, 4.0]), json!([4.0, 4.0]), json!([2.0, 2.0])] {
            for count in 0..3_u64 {
                let mut run =
                    reference(&json!({"space": {"box": lengths}, "temperature": 1.0, "integrator": integrator,
                    "particles": [{"species": "A", "count": count}]}));
                run.run(20).unwrap();
                let observed = run.observe().unwrap();
                assert_eq!((observed.particles, observed.step), (count, 20));
                assert_eq!(observed.momentum, [0.0; 3]);
                assert_eq!(observed.kinetic_temperature().is_nan(), count < 2);
                if count < 2 {
                    assert_eq!(observed.kinetic_energy, 0.0, "a single thermal particle is at rest");
                    assert!(observed.configurational_temperature().is_nan());
                } else {
                    assert!(observed.kinetic_energy > 0.0);
                }
            }
        }
    }
}

#[test]
fn particles_in_the_same_place_do_not_interact() {
    for integrator in integrators() {
        let mut run = reference(&json!({"temperature": 1.0, "integrator": integrator, "particles": [
            {"species": "A", "velocities": {"type": "rest"},
             "placement": {"type": "listed", "positions": [[1.0, 1.0, 1.0], [1.0, 11.0, -9.0]]}}]}));
        let positions = run.state().positions.clone();
        assert_eq!(positions[0], positions[1]);
        run.run(3).unwrap();
        assert_eq!(run.state().positions, positions);
        let observed = run.observe().unwrap();
        assert_eq!((observed.kinetic_energy, observed.gradient_squared, observed.total_virial), (0.0, 0.0, 0.0));
        // a rc / 2 of one pair at no distance.
        assert_eq!(observed.potential_energy, 10.0);
    }
}

#[test]
fn what_does_not_fit_the_state_is_an_error() {
    for integrator in integrators() {
        let mut changes = approaching(&integrator);
        changes["interactions"] = json!([{"type": "dpd", "repulsion": 1e9, "friction": 0.0}]);
        let mut run = reference(&changes);
        let before = run.state().clone();
        assert_eq!(run.run(5), Err(Unstable::Momentum { step: 0, particle: 0 }), "{integrator}");
        assert_eq!(run.state(), &before);
        changes["interactions"] = json!([]);
        // A check of the scene would refuse such a step.
        let (mut model, state) = start(&changes);
        model.time_step = 6.0;
        let mut run = Reference::new(model, state);
        let before = run.state().clone();
        assert_eq!(run.run(5), Err(Unstable::Drift { step: 0, particle: 0 }), "{integrator}");
        assert_eq!(run.state(), &before);
    }
}

#[test]
fn gradient_and_laplacian_are_derivatives_of_the_energy() {
    for lengths in [json!([3.0, 3.5, 4.0]), json!([5.0, 6.0])] {
        let dimension = lengths.as_array().unwrap().len();
        // Far from the cutoff and from zero distance, where the third derivatives are large.
        let positions = json!([[1.0, 1.0, 1.0], [1.3, 1.2, 0.8], [0.9, 1.45, 1.1], [1.55, 1.45, 1.3]]);
        let positions: Vec<Value> =
            positions.as_array().unwrap().iter().map(|p| json!(p.as_array().unwrap()[..dimension])).collect();
        let (model, state) = start(&json!({"space": {"box": lengths}, "particles": [
            {"species": "A", "velocities": {"type": "rest"},
             "placement": {"type": "listed", "positions": positions[..2]}},
            {"species": "B", "velocities": {"type": "rest"},
             "placement": {"type": "listed", "positions": positions[2..]}}],
            "interactions": [{"type": "dpd", "repulsion": 20.0, "cutoff": 1.25,
                "pairs": [{"between": ["A", "B"], "repulsion": 35.0}]}]}));
        let observe = |state: &State| Reference::new(model.clone(), state.clone()).observe().unwrap();
        let centre = observe(&state);
        let shift = 1_u32 << 17;
        let (mut gradient_squared, mut laplacian) = (0.0, 0.0);
        for particle in 0..state.len() {
            for axis in 0..dimension {
                let step = f64::from(shift) * model.units.lengths[axis] / 4_294_967_296.0;
                let [ahead, behind] = [shift, shift.wrapping_neg()].map(|shift| {
                    let mut moved = state.clone();
                    moved.positions[particle][axis] = moved.positions[particle][axis].wrapping_add(shift);
                    observe(&moved).potential_energy
                });
                gradient_squared += ((ahead - behind) / (2.0 * step)).powi(2);
                laplacian += (ahead - 2.0 * centre.potential_energy + behind) / (step * step);
            }
        }
        assert_close(centre.gradient_squared / gradient_squared, 1.0, 1e-6);
        assert_close(centre.laplacian / laplacian, 1.0, 1e-4);
        assert_close(centre.configurational_temperature(), gradient_squared / laplacian, 1e-2);
        assert!(centre.gradient_squared > 100.0 && centre.laplacian.abs() > 10.0);
    }
}

#[test]
fn virials_by_hand() {
    // At step 0 the forces of groot-warren_by_hand: 10 conservative, 12 in all, at distance ½.
    let observed = reference(&approaching(&json!({"type": "groot-warren"}))).observe().unwrap();
    assert_close(observed.conservative_virial, 5.0, 1e-7);
    assert_close(observed.total_virial, 6.0, 1e-7);
    assert_close(observed.potential_energy, 2.5, 1e-7);
    // Splitting at step 1: 12 conservative, and J / dt of the explicit rule, at distance .4. Then p = -.0712 - .6, and
    // half a drift later the distance is .46712, the force 20 (1 - .46712).
    let (model, state) = start(&approaching(&json!({"type": "splitting"})));
    let mut run = Reference::with_relaxation(model, state, Relaxation::Midpoint { corrections: 0 });
    run.step().unwrap();
    let observed = run.observe().unwrap();
    assert_close(observed.conservative_virial, 0.467_12 * 20.0 * (1.0 - 0.467_12), 1e-6);
    assert_close(observed.total_virial, 0.4 * (12.0 - 1.44 * 0.2), 1e-6);
}

#[test]
fn radial_distribution_counts_pairs() {
    let run = reference(&json!({"particles": [{"species": "A", "velocities": {"type": "rest"},
        "placement": {"type": "listed", "positions": [[0.1, 5.0, 5.0], [9.8, 5.0, 5.0], [0.1, 6.25, 5.0]]}}]}));
    // Distances .3, 1.25 and √(.09 + 1.5625) = 1.2855.
    assert_eq!(run.radial_distribution(2.0, 4), [1, 0, 2, 0]);
    assert_eq!(run.radial_distribution(1.27, 1), [2]);
}

/// Means over a run of the standard fluid.
#[derive(Debug, Default)]
struct Means {
    kinetic: f64,
    /// At the positions where the forces are evaluated.
    configurational: f64,
    /// Half a drift later.
    configurational_between: f64,
    pressure: f64,
    conservative_pressure: f64,
}

fn equilibrium(mut run: Reference, equilibration: u64, samples: u32) -> Means {
    run.run(equilibration).unwrap();
    let mut means = Means::default();
    let [mut gradient, mut laplacian, mut gradient_between, mut laplacian_between] = [0.0; 4];
    for _ in 0..samples {
        run.run(5).unwrap();
        let observed = run.observe().unwrap();
        // A split step reports its configuration there already.
        let between = if run.model().particles().splits() {
            observed
        } else {
            Reference::new(run.model().clone(), run.state_between_forces().unwrap()).observe().unwrap()
        };
        means.kinetic += observed.kinetic_temperature() / f64::from(samples);
        means.pressure += observed.pressure() / f64::from(samples);
        means.conservative_pressure += observed.conservative_pressure() / f64::from(samples);
        gradient += observed.gradient_squared;
        laplacian += observed.laplacian;
        gradient_between += between.gradient_squared;
        laplacian_between += between.laplacian;
    }
    means.configurational = gradient / laplacian;
    means.configurational_between = gradient_between / laplacian_between;
    means
}

/// Relaxations that the device does not have; `physics` has its own.
#[test]
#[ignore = "a minute"]
fn splitting_has_its_known_temperatures() {
    for (rule, expected) in
        [(Relaxation::Exponential, [1.023, 1.010]), (Relaxation::Midpoint { corrections: 1 }, [1.005, 0.990])]
    {
        let (model, state) = start(&fluid(3000, 0.04, &json!({"type": "splitting"})));
        let means = equilibrium(Reference::with_relaxation(model, state, rule), 300, 200);
        println!("{rule:?}: {means:?}");
        assert_close(means.kinetic, expected[0], 0.007);
        assert_close(means.configurational_between, expected[1], 0.007);
    }
}

#[test]
#[ignore = "a minute; `physics` has a shorter one on the device"]
fn cotter_reich_has_the_temperature_and_the_published_pressure() {
    let run = reference(&fluid(3000, 0.01, &json!({"type": "cotter-reich"})));
    let means = equilibrium(run, 800, 250);
    println!("cotter-reich: {means:?}");
    assert_close(means.kinetic, 1.0, 0.01);
    assert_close(means.configurational, 1.0, 0.01);
    // Published: 23.635 in the limit of small steps.
    assert_close(means.pressure / 23.635, 1.0, 0.006);
    assert_close(means.conservative_pressure / 23.635, 1.0, 0.006);
}
