//! The ends of every range a scene can reach: right, or refused with the reason, and never silent.

use mesoscope::engine::EngineError;
use mesoscope::families::Instability;
use mesoscope::families::reference::Reference;
use mesoscope::plan::{self, FailureKind, Options, Traversal};
use mesoscope::run;
use mesoscope::scene::Checked;
use mesoscope::shaders::Constant;
use mesoscope::state::State;

use crate::support::{
    COTTER_REICH, EVERY_STEP, GROOT_WARREN, INTEGRATORS, PREDICTED, SPLITTING, STAGED, edited, engine, fluid, hardware,
    largest_difference, observables, reference, same_observables, series, start, step_in_words, traversals,
};

const TWO_DIMENSIONS: &str = "space.box=[5,5]";
const REST: &str = r#"particles.0.velocities={"type":"rest"}"#;

fn count(particles: u64) -> String {
    format!(r#"particles=[{{"species":"A","count":{particles}}}]"#)
}

/// Particles at given places with given velocities.
fn listed(positions: &str, velocities: &str) -> String {
    format!(
        r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":{positions}}},"velocities":{{"type":"listed","velocities":{velocities}}}}}]"#
    )
}

fn options(traversal: Traversal) -> Options {
    Options { traversal: Some(traversal), ..Options::default() }
}

/// Steps device and reference side by side, with every way to visit pairs: momenta and positions within so many integer units a
/// step, total momentum to the bit, observables to single precision.
fn agrees(changes: &[&str], steps: u64, units: i64) {
    agrees_with(&traversals(), changes, steps, units);
}

/// The same with one of the ways: another one for the next `number`. For cases that between them have every way with everything that
/// the ways could disagree on.
fn agrees_in_turn(number: usize, changes: &[&str], steps: u64, units: i64) {
    let traversals = traversals();
    agrees_with(&[traversals[number % traversals.len()]], changes, steps, units);
}

fn agrees_with(traversals: &[Traversal], changes: &[&str], steps: u64, units: i64) {
    let scene = fluid(&[changes, &[EVERY_STEP]].concat());
    let (model, state) = start(&scene);
    // How many units of position a unit of momentum becomes in a step, at most.
    let lightest = model.species.iter().map(|species| species.mass).fold(f64::INFINITY, f64::min);
    let shortest = model.units.lengths[..model.units.dimension].iter().copied().fold(f64::INFINITY, f64::min);
    let drift = model.time_step * model.units.momentum / lightest / shortest * 2_f64.powi(32);
    // The device rounds the rates of relaxation to 2⁻¹⁶, the reference does not: an error of second order in the rate.
    let rate_rounding = if changes.iter().any(|change| change.contains("splitting")) { 10 } else { 1 };
    let mut reference_run = reference(&scene, &state);
    let expected: Vec<State> = (0..steps)
        .map(|_| {
            reference_run.step().unwrap();
            reference_run.state().clone()
        })
        .collect();
    for &traversal in traversals {
        let mut device = engine(&scene, &state, options(traversal));
        for (step, expected) in (1_i64..).zip(&expected) {
            device.advance(1, 1).unwrap();
            let found = device.state().unwrap();
            let (momentum, position) = largest_difference(&found, expected);
            let allowed = units * step * rate_rounding;
            let moved = allowed + (allowed as f64 * drift) as i64;
            assert!(momentum <= allowed, "{traversal:?} step {step}: momenta differ by {momentum} ({changes:?})");
            assert!(position <= moved, "{traversal:?} step {step}: positions differ by {position} ({changes:?})");
            assert_eq!(found.total_momentum(), state.total_momentum(), "{traversal:?} step {step} ({changes:?})");
        }
        // Of the very same state: sums like the Laplacian's nearly cancel, and then tell of the last bit of a position.
        let found = device.state().unwrap();
        let found = reference(&scene, &found);
        same_observables(
            &observables(&mut device, &scene),
            &found.observe().unwrap(),
            jump_of_curvature(&found),
            changes,
        );
    }
}

/// V'' jumps by a/rc at the cutoff. Of a million pairs, one or two are so close to it that single precision may put them
/// on the other side.
fn jump_of_curvature(reference: &Reference) -> f64 {
    let Some(force) = reference.model().particles().pair_force.as_ref() else { return 0.0 };
    let pairs = reference.radial_distribution(force.cutoff, 1)[0] as f64;
    (3e-6 * pairs).floor() * 2.0 * force.largest_repulsion() / force.cutoff
}

/// A particle of these looks into 24 389 cells, for which one invocation would make 70 000 turns: more than software adapters do before
/// they leave every loop, which is 65 535. Every cell costs two, and one more where any lane of a vector finds a particle.
#[test]
fn pairs_far_apart_are_all_counted() {
    let scene = fluid(&[
        GROOT_WARREN,
        "space.box=[29,29,29]",
        &count(6100),
        "time.equilibration=0",
        r#"output.radial_distribution={"every":1000,"range":14.5,"bins":8}"#,
    ]);
    assert_eq!(planned(&scene, Options::default()).cells, [29; 3]);
    let (_, state) = start(&scene);
    let samples = engine(&scene, &state, Options::default()).finish().unwrap();
    let found = &samples.iter().find(|sample| sample.sums.len() == 8).unwrap().sums;
    for (bin, known) in reference(&scene, &state).radial_distribution(14.5, 8).into_iter().enumerate() {
        // Single precision puts a few of the millions into the bin beside theirs.
        let difference = (found[bin] as f64 - known as f64).abs();
        assert!(difference < 1e-5 * known as f64 + 3.0, "bin {bin}: {} instead of {known}", found[bin]);
    }
}

// ---- Few particles

#[test]
fn no_particles() {
    for integrator in INTEGRATORS {
        for lengths in ["[5,5,5]", "[5,5]", "[1e6,2,2]"] {
            let scene = fluid(&[
                integrator,
                EVERY_STEP,
                "particles=[]",
                "time.steps=100",
                &format!("space.box={lengths}"),
                r#"output.radial_distribution={"every":1,"range":1}"#,
                r#"output.diffusion={"every":1,"window":8}"#,
                r#"output.viscosity={"every":1,"window":8}"#,
            ]);
            let (_, state) = start(&scene);
            let mut engine = engine(&scene, &state, Options::default());
            engine.advance(5, 2).unwrap();
            assert_eq!(engine.state().unwrap(), State { step: 5, ..State::default() });
            let samples = engine.finish().unwrap();
            assert_eq!(samples.len(), 4 * 6);
            assert!(samples.iter().all(|sample| sample.sums.iter().all(|sum| *sum == 0)));
        }
    }
}

/// Whatever would act on particles.
#[test]
fn nothing_acts_on_no_particles() {
    let dpd = r#"{"type":"dpd","repulsion":25,"friction":4.5}"#;
    let of_any_step = [
        format!(r#"interactions=[{dpd},{{"type":"body-force","force":[1,2,3]}}]"#),
        format!(r#"interactions=[{dpd},{{"type":"body-force","force":[1,0,0],"profile":"opposed","axis":"y"}}]"#),
        format!(r#"interactions=[{dpd},{{"type":"body-force","force":[1,0,0],"profile":"sinusoidal","axis":"y"}}]"#),
        format!(r#"interactions=[{dpd},{{"type":"langevin","friction":1}}]"#),
        format!(r#"interactions=[{dpd},{{"type":"tether","stiffness":1}}]"#),
        r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}]"#.to_owned(),
        r#"space.walls={"z":{"upper_velocity":[1,0,0]}}"#.to_owned(),
    ];
    let coupled = [
        r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5,"bath":{"type":"memory","rate":3}}]"#,
        r#"interactions=[{"type":"langevin","friction":1,"bath":{"type":"memory","rate":3}},{"type":"tether","stiffness":1}]"#,
        r#"interactions=[{"type":"coloured-noise","strength":1,"time":1},{"type":"body-force","force":[1,2,3]}]"#,
    ];
    let of_any_step =
        of_any_step.iter().flat_map(|change| [SPLITTING, COTTER_REICH].map(|integrator| (integrator, change.as_str())));
    let coupled = coupled.map(|change| (COTTER_REICH, change));
    let sheared = [(SPLITTING, r#"space.shear={"rate":0.1,"gradient":"y"}"#)];
    for (integrator, change) in of_any_step.chain(coupled).chain(sheared) {
        let scene = fluid(&[integrator, change, "particles=[]", EVERY_STEP, "space.box=[5,5,5]"]);
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(3, 2).unwrap();
        assert_eq!(engine.state().unwrap().step, 3, "{integrator} {change}");
    }
}

#[test]
fn a_single_particle_goes_straight_round_the_box() {
    for integrator in INTEGRATORS {
        // 100 steps of 0.04 at (3, -2, 0.5): once round and more along x, backwards through the boundary along y.
        let scene = fluid(&[integrator, &listed("[[4.5,0.5,2]]", "[[3,-2,0.5]]")]);
        let (model, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(100, 7).unwrap();
        let found = engine.state().unwrap();
        assert_eq!(found.momenta, state.momenta);
        let expected = model.units.fraction([4.5 + 12.0, 0.5 - 8.0, 2.0 + 2.0]);
        for (found, expected) in found.positions[0].iter().zip(expected) {
            // Half a unit of rounding a step, and the single precision of the drift.
            let off = found.wrapping_sub(expected) as i32;
            assert!(off.abs() <= 100 * 20, "{off} units of 2^-32 of the box");
        }
    }
}

#[test]
fn two_particles_collide_elastically() {
    // Without friction and noise the repulsion hands the velocities over, for 1/2 v² is below the barrier a rc / 2.
    for dimension in [2, 3] {
        let [box_, positions, velocities] = if dimension == 3 {
            ["space.box=[10,10,10]", "[[4,5,5],[6,5,5]]", "[[1,0,0],[-1,0,0]]"]
        } else {
            ["space.box=[10,10]", "[[5,9.2],[5,0.8]]", "[[0,1],[0,-1]]"]
        };
        let changes = [box_, "temperature=0", "interactions.0.friction=0", "time.step=0.005"];
        let scene = fluid(&[&changes[..], &[GROOT_WARREN, &listed(positions, velocities)]].concat());
        let (model, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(400, 100).unwrap();
        let found = engine.state().unwrap();
        assert_eq!(found.total_momentum(), [0; 3]);
        let axis = 3 - dimension;
        let [first, second] = [0, 1].map(|id| model.units.momentum(found.momenta[id]));
        assert!((first[axis] + 1.0).abs() < 1e-4, "{first:?}");
        assert!((second[axis] - 1.0).abs() < 1e-4, "{second:?}");
    }
}

// ---- Friction and its weight

/// Two particles that pass through each other without repulsion or noise lose γ/m ∫ω dr of each one's velocity:
/// du = -2γ/m ω dr for the relative velocity u, and ∫ω dr from -rc to rc is 2 rc / (s + 1).
#[test]
fn friction_takes_the_integral_of_its_weight() {
    // Every integrator with a jump at the cutoff or a straight weight, and with a smooth or a narrow one.
    for (integrator, exponents) in INTEGRATORS.iter().zip([[0.0, 10.0], [1.0, 2.0]].into_iter().cycle()) {
        for exponent in exponents {
            let friction = 0.5 * (exponent + 1.0);
            let scene = fluid(&[
                integrator,
                "space.box=[10,10,10]",
                "temperature=0",
                "time.step=0.00197",
                "interactions.0.repulsion=0",
                &format!("interactions.0.friction={friction}"),
                &format!("interactions.0.weight_exponent={exponent}"),
                &listed("[[9.4,5,5],[0.6,5,5]]", "[[2,0,0],[-2,0,0]]"),
            ]);
            let (model, state) = start(&scene);
            let mut engine = engine(&scene, &state, Options::default());
            engine.advance(600, 100).unwrap();
            let found = engine.state().unwrap();
            assert_eq!(found.total_momentum(), [0; 3]);
            let speed = model.units.momentum(found.momenta[0])[0];
            // Each loses 2γ/(s+1) = 1 of its speed of 2, but for a step at the cutoff, where the weight may jump, and one
            // at the centre, where it has its peak.
            assert!((speed - 1.0).abs() < 4e-3 + 6e-3 * friction, "exponent {exponent}: {speed} ({integrator})");
        }
    }
}

#[test]
fn extreme_weight_exponents_agree_with_the_reference() {
    // Both exponents with both ways to visit pairs, and so every integrator.
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        agrees_in_turn(number, &[integrator, "interactions.0.weight_exponent=0"], 3, 100);
        agrees_in_turn(number + 1, &[integrator, "interactions.0.weight_exponent=10", TWO_DIMENSIONS], 3, 100);
    }
}

#[test]
fn friction_from_none_to_too_much() {
    agrees(&[GROOT_WARREN, "interactions.0.friction=0"], 3, 100);
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        agrees_in_turn(number, &[integrator, "interactions.0.friction=1e-12"], 3, 100);
        // Relaxed in two stages no friction is too much that is not refused.
        if *integrator == STAGED {
            continue;
        }
        // Short of what is refused.
        let friction = if *integrator == SPLITTING { "1e4" } else { "200" };
        unstable(number / 2, &fluid(&[integrator, &format!("interactions.0.friction={friction}")]), 50);
    }
}

/// The run fails as unstable within one batch, says when, and suggests a smaller step that is not zero. With one of the ways to
/// visit pairs: another one for the next `number`.
fn unstable(number: usize, scene: &Checked, batch: u64) {
    let (model, state) = start(scene);
    let traversals = traversals();
    let mut engine = engine(scene, &state, options(traversals[number % traversals.len()]));
    let outcome = engine.advance(batch, batch).and_then(|()| engine.finish().map(drop));
    match outcome {
        Err(EngineError::Unstable(failure)) => {
            let error = Instability::new(&failure, engine.plan(), &model);
            let Instability { step, quantity, suggested_step, .. } = &error;
            assert!(*step < batch, "{error}");
            assert!(!quantity.is_empty());
            let suggested_step = suggested_step.unwrap();
            assert!(suggested_step > 0.0 && suggested_step < scene.time.step, "{error}");
            let message = error.to_string();
            assert!(message.contains(&format!("at step {step}")), "{message}");
            assert!(message.contains(&step_in_words(suggested_step)), "{message}");
        }
        other => panic!("{other:?} instead of an unstable run"),
    }
    // The engine is fit for another state.
    engine.upload(&state).unwrap();
    assert_eq!(engine.state().unwrap(), State { predicted: engine.state().unwrap().predicted, ..state });
}

// ---- Time steps and temperatures

#[test]
fn an_exploding_time_step_is_caught_within_a_batch() {
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        // Refused, but for a program that goes on without a check.
        let scene = edited(&fluid(&[integrator]), |scene| scene.time.step = [0.5, 0.9][number % 2]);
        unstable(number / 2, &scene, 50);
    }
    // The same of a step that would be fine, for a particle that is too fast.
    let fast = listed("[[1,1,1],[3,3,3]]", "[[200,0,0],[0,0,0]]");
    let scene = edited(&fluid(&[GROOT_WARREN, &fast, "time.step=0.004"]), |scene| scene.time.step = 0.04);
    (0..traversals().len()).for_each(|number| unstable(number, &scene, 4));
}

#[test]
fn the_first_failing_step_is_named() {
    // From (0, 0) at rest towards each other... one particle that falls into reach at a known step is kicked away.
    let scene = fluid(&[
        GROOT_WARREN,
        "space.box=[40,40,40]",
        "temperature=0",
        "interactions.0.repulsion=1e9",
        "interactions.0.friction=0",
        &listed("[[10,5,5],[15.5,5,5]]", "[[12.5,0,0],[0,0,0]]"),
    ]);
    // 4.5 to go at 0.5 a step: within reach after 10 steps, and then kicked by millions.
    let (_, state) = start(&scene);
    for (traversal, batch) in traversals().into_iter().flat_map(|traversal| [1, 4, 50].map(|batch| (traversal, batch)))
    {
        let mut engine = engine(&scene, &state, options(traversal));
        match engine.advance(50, batch).and_then(|()| engine.finish().map(drop)) {
            Err(EngineError::Unstable(failure)) => {
                assert!([9, 10].contains(&failure.step), "{failure:?}");
                assert!(failure.is(FailureKind::Impulse), "{traversal:?}: {failure:?}");
            }
            other => panic!("{other:?}"),
        }
    }
}

/// Energy in units of E, length in L and mass in M, all powers of two: the integer state must not notice.
#[test]
fn powers_of_two_of_every_unit_leave_the_integers_alone() {
    let run = |integrator: &str, energy: f64, length: f64, mass: f64, second: f64| {
        let time = length * (mass / energy).sqrt();
        let scene = fluid(&[
            integrator,
            &format!("space.box=[{0},{0},{0}]", 5.0 * length),
            &format!("time.step={:e}", 0.03125 * time),
            &format!("temperature={energy:e}"),
            &format!(
                r#"particles=[{{"species":"A","count":300,"mass":{mass:e}}},{{"species":"{}","count":75,"mass":{:e}}}]"#,
                if second == 1.0 { "A" } else { "B" },
                second * mass
            ),
            &format!("interactions.0.cutoff={length:e}"),
            &format!("interactions.0.repulsion={:e}", 25.0 * energy / length),
            &format!("interactions.0.friction={:e}", 4.5 * mass / time),
            EVERY_STEP,
        ]);
        let (model, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        engine.advance(10, 10).unwrap();
        let state = engine.state().unwrap();
        let last = observables(&mut engine, &scene);
        let sums = [
            last.kinetic_energy / energy,
            last.potential_energy / energy,
            last.total_virial / energy,
            last.gradient_squared * (length / energy).powi(2),
            last.laplacian * length * length / energy,
        ];
        (state, sums, model.units.momentum)
    };
    let two = |power: i32| 2_f64.powi(power);
    // Each run compiles its kernels anew: all units at once for all, and one by one the units of one integrator each.
    let powers = [(40, 0, 0), (-40, 0, 0), (0, 20, 0), (0, -20, 0), (0, 0, 40), (0, 0, -40)]; // 2⁴⁰ is about 10¹²
    let cases = INTEGRATORS.iter().flat_map(|integrator| [(integrator, 1.0), (integrator, 2.5)]);
    for (number, (integrator, second)) in cases.enumerate() {
        let (state, sums, unit) = run(integrator, 1.0, 1.0, 1.0, second);
        let own = powers.into_iter().skip(number).step_by(2 * INTEGRATORS.len());
        for (energy, length, mass) in std::iter::once((20, -4, 10)).chain(own) {
            let scaled = run(integrator, two(energy), two(length), two(mass), second);
            assert_eq!(scaled.2, unit * (two(energy) * two(mass)).sqrt(), "momentum unit");
            assert!(scaled.0 == state, "2^{energy} energy, 2^{length} length, 2^{mass} mass ({integrator})");
            assert_eq!(scaled.1, sums, "2^{energy}, 2^{length}, 2^{mass} ({integrator})");
        }
    }
}

#[test]
fn without_heat_energy_only_falls() {
    for integrator in INTEGRATORS {
        let scene = fluid(&[integrator, "temperature=0", "time.step=0.005", REST, EVERY_STEP]);
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        assert!(engine.plan().constants.contains(&(Constant::Distribution, 0.0)), "a cold scene has noise");
        engine.advance(300, 100).unwrap();
        assert_eq!(engine.state().unwrap().total_momentum(), [0; 3]);
        let found = series(&mut engine, &scene);
        let first = found[0].total_energy();
        assert_eq!(found[0].kinetic_energy, 0.0);
        // Verlet's own wobble of the energy is of second order in the step.
        for pair in found.windows(2) {
            assert!(pair[1].total_energy() <= pair[0].total_energy() + 2e-4 * first, "step {}", pair[1].step);
        }
        assert!(found.iter().any(|row| row.kinetic_energy > 0.01 * first), "nothing moved ({integrator})");
        assert!(
            found.last().unwrap().total_energy() < 0.8 * first,
            "{} of {first}",
            found.last().unwrap().total_energy()
        );
    }
}

// ---- Densities

#[test]
fn a_thousand_neighbours() {
    // 4π/3 · 239 and π · 318 neighbours within the cutoff.
    for (box_, particles, integrator) in
        [("space.box=[2,2,2]", 1910, SPLITTING), ("space.box=[3,3]", 2865, COTTER_REICH)]
    {
        agrees(&[integrator, box_, &count(particles), "time.step=0.0005"], 2, 300);
    }
}

#[test]
fn a_dilute_gas_and_one_pair_across_a_corner() {
    let pair = r#"{"species":"A","placement":{"type":"listed","positions":[[99.8,0.1,99.9],[0.1,99.9,0.2]]}}"#;
    let gas = format!(r#"particles=[{{"species":"A","count":98}},{pair}]"#);
    // One that visits the pairs once a step, and one that visits them twice.
    for integrator in [GROOT_WARREN, SPLITTING] {
        let changes = [integrator, "space.box=[100,100,100]", gas.as_str()];
        agrees(&changes, 5, 100);
        let (_, state) = start(&fluid(&changes));
        assert!(
            reference(&fluid(&changes), &state).observe().unwrap().potential_energy > 0.0,
            "the pair does not touch"
        );
    }
}

#[test]
fn coincident_particles() {
    // Three in one place and one beside them: the three have no direction and no force between them until they part.
    let places = ["[[1,1,1],[1,1,1],[1,1,1],[1.5,1,1]]", "[[0,0,0],[0,0,0],[5,5,5],[2.5,2.5,2.5]]"];
    for (place, positions) in places.into_iter().enumerate() {
        for (number, integrator) in INTEGRATORS.iter().enumerate() {
            let velocities = "[[1,0,0],[1,0,0],[0,-1,0],[0,0,1]]";
            let changes = [*integrator, &listed(positions, velocities)];
            agrees_in_turn(place + number, &changes, 5, 100);
            // Observed where they lie on each other, before the first step.
            let scene = fluid(&[&changes[..], &[EVERY_STEP]].concat());
            let (_, state) = start(&scene);
            let measured = observables(&mut engine(&scene, &state, Options::default()), &scene);
            same_observables(&measured, &reference(&scene, &state).observe().unwrap(), 0.0, &changes);
        }
    }
    // The same momenta in the same place: they never part, and nothing is ever not a number.
    let scene = fluid(&[GROOT_WARREN, &listed("[[1,1,1],[1,1,1]]", "[[1,2,3],[1,2,3]]")]);
    let (_, state) = start(&scene);
    let mut engine = engine(&scene, &state, Options::default());
    engine.advance(100, 10).unwrap();
    let found = engine.state().unwrap();
    assert_eq!(found.positions[0], found.positions[1]);
    assert_eq!(found.momenta, state.momenta);
}

/// Where the sums of a report hold the momentum.
const MOMENTUM: std::ops::Range<usize> = 2..5;

/// The sums of a report are 64-bit integers: those of a hundred million particles, thrown down at random, have to fit.
#[test]
fn sums_of_a_hundred_million_particles_fit() {
    let cold = "temperature=0.01";
    for changes in
        [&[][..], &["interactions.0.repulsion=100"], &[cold], &["interactions.0.repulsion=0"], &["time.step=0.001"]]
    {
        let scene = fluid(&[&[GROOT_WARREN, EVERY_STEP, "space.box=[8,8,8]"], changes].concat());
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        let row = &engine.finish().unwrap()[0];
        for (quantity, sum) in row.sums.iter().enumerate().filter(|(quantity, _)| !MOMENTUM.contains(quantity)) {
            let all = *sum as f64 * 1e8 / state.len() as f64;
            assert!(all.abs() < 2_f64.powi(63), "quantity {quantity}: {all:e} ({changes:?})");
            let resolved = sum.abs() > 1 << 20 || *sum == 0 && changes == ["interactions.0.repulsion=0"];
            assert!(resolved, "quantity {quantity} holds only {sum} units ({changes:?})");
        }
    }
}

// ---- Boxes

#[test]
fn boxes_of_exactly_two_and_three_cutoffs() {
    for (number, cutoffs) in [2.0, 3.0].into_iter().enumerate() {
        for shape in 0..3 {
            // Grids know nothing of the unit of length: each box with one of the cutoffs.
            let cutoff = [1.3, 0.1][(number + shape) % 2];
            let edge = cutoffs * cutoff;
            let cutoff_change = format!("interactions.0.cutoff={cutoff}");
            // Velocities fit the cutoff, and so do the steps.
            let step = format!("time.step={}", 0.02 * cutoff);
            let lengths = [
                format!("space.box=[{edge},{edge},{edge}]"),
                format!("space.box=[{edge},{edge}]"),
                format!("space.box=[{},{edge},{}]", 6.0 * cutoff, 3.0 * edge),
            ];
            agrees(&[GROOT_WARREN, &lengths[shape], &cutoff_change, &step, &count(60)], 2, 100);
        }
    }
}

#[test]
fn a_box_of_a_million_cutoffs() {
    // Two pairs within reach, one of them across the boundary, and one particle far from all others.
    let cube = listed(
        "[[0.1,10,10],[999999.7,10,10],[500000,500000,500000],[500000.3,500000.4,499999.8],[3e5,7e5,1e5]]",
        "[[1,0,0],[0,1,0],[0,0,1],[-1,0,0],[0,-1,-1]]",
    );
    let square = listed("[[0.1,10],[999999.7,10],[500000,0.2],[500000.3,999999.9]]", "[[1,0],[0,1],[0,1],[-1,-1]]");
    let boxes = [("space.box=[1e6,1e6,1e6]", &cube), ("space.box=[1e6,1e6]", &square)];
    for (integrator, (box_, particles)) in INTEGRATORS.iter().zip(boxes.into_iter().cycle()) {
        let changes = [*integrator, box_, particles.as_str()];
        agrees(&changes, 5, 100);
        let scene = fluid(&changes);
        let (_, state) = start(&scene);
        assert_eq!(reference(&scene, &state).radial_distribution(1.0, 1), [2], "pairs within reach");
    }
}

#[test]
fn elongated_boxes() {
    let boxes = ["[1000,2,2]", "[2,1000,2]", "[2,2,1000]", "[1000,3,3]", "[1000,2]", "[2,1000]"];
    // One that visits the pairs twice a step, and one that predicts momenta: each in boxes along every axis and in both dimensions.
    for (box_, integrator) in boxes.into_iter().zip([SPLITTING, PREDICTED, SPLITTING, PREDICTED, PREDICTED, SPLITTING])
    {
        agrees(&[integrator, &format!("space.box={box_}"), &count(3000)], 1, 100);
    }
}

// ---- Masses and species

#[test]
fn masses_twelve_orders_apart() {
    // The light ones move a thousand cutoffs a unit of time; the heavy ones repel each other enough to be felt.
    let particles =
        r#"particles=[{"species":"light","count":150,"mass":1e-6},{"species":"heavy","count":150,"mass":1e6}]"#;
    let force = r#"interactions=[{"type":"dpd","repulsion":0.1,"friction":1e-3,"pairs":[{"between":["heavy","heavy"],"repulsion":1e4}]}]"#;
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        agrees_in_turn(number, &[integrator, particles, "time.step=1e-5", force], 5, 100);
    }
}

#[test]
fn sixteen_species() {
    let mut groups = Vec::new();
    let mut pairs = Vec::new();
    for a in 0..16 {
        groups.push(format!(r#"{{"species":"s{a}","count":{},"mass":{}}}"#, 10 + 2 * a, 0.5 + 0.25 * f64::from(a)));
        for b in 0..=a {
            let (repulsion, friction) = (f64::from(a * 5 - b * 3), f64::from((a * 7 + b * 7) % 10));
            pairs.push(format!(r#"{{"between":["s{a}","s{b}"],"repulsion":{repulsion},"friction":{friction}}}"#));
        }
    }
    let particles = format!("particles=[{}]", groups.join(","));
    let force = format!(r#"interactions=[{{"type":"dpd","pairs":[{}]}}]"#, pairs.join(","));
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        agrees_in_turn(number, &[integrator, &particles, &force], 3, 100);
        agrees_in_turn(number + 1, &[integrator, &particles, &force, "space.box=[10,10]"], 3, 100);
    }
}

// ---- Crowding

/// A scene whose particles all lie in the first cells along x.
fn crowd(particles: u64) -> (Checked, State) {
    let scene = fluid(&[GROOT_WARREN, "space.box=[16,8,8]", "time.step=0.002", &count(particles)]);
    let (_, mut state) = start(&scene);
    for position in &mut state.positions {
        position[0] = (position[0] >> 6).wrapping_sub(1 << 25);
    }
    (scene, state)
}

/// Particles in the first and the last cell along x, which need copies.
fn copies(scene: &Checked, state: &State) -> u64 {
    let cells = u64::from(planned(scene, Options::default()).cells[0]);
    let end = |x: u32| [0, cells - 1].contains(&((u64::from(x) * cells) >> 32));
    state.positions.iter().filter(|position| end(position[0])).count() as u64
}

fn planned(scene: &Checked, options: Options) -> plan::Plan {
    run::plan(scene, hardware(), options)
}

#[test]
fn a_crowd_at_the_end_of_the_rows_is_right_or_refused() {
    let (scene, state) = crowd(3000);
    assert_eq!(copies(&scene, &state), 3000);
    let mut expected = reference(&scene, &state);
    expected.step().unwrap();
    for traversal in traversals() {
        // As planned, for a fluid that fills the box, there is not enough room.
        let mut crowded = engine(&scene, &state, options(traversal));
        match crowded.advance(1, 1).and_then(|()| crowded.finish().map(drop)) {
            Err(EngineError::Crowded { step: 0 }) => {}
            other => panic!("{other:?}"),
        }
        // With just enough, the result is right; with room for one copy fewer, it is refused.
        let with_room = |room: u64| {
            let options = Options { copies: Some(room), ..options(traversal) };
            let mut engine = engine(&scene, &state, options);
            engine.advance(1, 1).and_then(|()| engine.state())
        };
        let found = with_room(3000).unwrap();
        let (momentum, position) = largest_difference(&found, expected.state());
        assert!(momentum <= 300 && position <= 300, "{traversal:?}: {momentum} {position}");
        assert_eq!(found.total_momentum(), state.total_momentum());
        for missing in [1, 2999] {
            assert!(matches!(with_room(3000 - missing), Err(EngineError::Crowded { step: 0 })), "{missing} too few");
        }
    }
}

#[test]
fn room_for_copies_is_exact_for_a_fluid_too() {
    let scene = fluid(&[GROOT_WARREN, "space.box=[6,5,4]"]);
    let (_, state) = start(&scene);
    let needed = copies(&scene, &state);
    assert!(needed > 50 && needed < state.len() as u64);
    for (room, fits) in [(needed, true), (needed - 1, false), (needed - 5, false)] {
        for traversal in traversals() {
            let mut engine = engine(&scene, &state, Options { copies: Some(room), ..options(traversal) });
            match engine.advance(1, 1).and_then(|()| engine.state()) {
                Ok(found) => {
                    assert!(fits, "{traversal:?}: room for {room} of {needed} copies went unnoticed");
                    let mut expected = reference(&scene, &state);
                    expected.step().unwrap();
                    assert!(largest_difference(&found, expected.state()).0 <= 100);
                }
                Err(EngineError::Crowded { step: 0 }) => assert!(!fits, "{traversal:?}: room for {room} was enough"),
                Err(other) => panic!("{other}"),
            }
        }
    }
}

/// In a box of three cells across rows, both ends of a pair at the far ends of two cells see each other: momentum is kept.
#[test]
fn pairs_at_the_ends_of_cells_see_each_other() {
    for (box_, [first, second]) in [
        ("space.box=[3,3,3]", ["[1.5,1.0001,1.5]", "[1.5,0.0015,1.5]"]),
        ("space.box=[3,3,3]", ["[1.5,1.5,2.0001]", "[1.5,1.5,1.0015]"]),
        ("space.box=[4,3]", ["[1.5,1.0001]", "[1.5,0.0015]"]),
    ] {
        let particles = format!(
            r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":[{first},{second}]}},"velocities":{{"type":"rest"}}}}]"#
        );
        let scene = fluid(&[box_, &particles, "temperature=0", "time.step=0.02"]);
        let (_, state) = start(&scene);
        for traversal in traversals() {
            let mut engine = engine(&scene, &state, Options { traversal: Some(traversal), ..Options::default() });
            engine.advance(30, 10).unwrap();
            let last = engine.state().unwrap();
            assert_ne!(last.momenta[0], [0; 3], "{box_}: they do not meet");
            assert_eq!(last.total_momentum(), [0; 3], "{box_}");
        }
    }
}
