//! One body of physics tests for both implementations: the float64 reference and the device.
//!
//! Statistical tolerances are four standard errors, from blocking averages of the run itself, plus a stated allowance
//! for what is systematic; every test also bounds the standard error itself, so that no run passes by being short.

use mesoscope::families::Observables;
use mesoscope::scene::Checked;

use crate::support::{
    COTTER_REICH, Device, GROOT_WARREN, Implementation, Measured, SPLITTING, STAGED, equilibrium, fluid, order,
    reference, scene,
};

/// Either implementation of a scene.
fn both(scene: &Checked) -> [Box<dyn Implementation>; 2] {
    let (_, state) = crate::support::start(scene);
    [Box::new(reference(scene, &state)), Box::new(Device::new(scene))]
}

/// The standard fluid, with the smaller box for the slower reference: the errors of a scheme do not depend on it.
fn fluids(changes: &[&str]) -> [(Box<dyn Implementation>, Length); 2] {
    let small = fluid(&[&["space.box=[5,5,5]", "output.energies.every=5"], changes].concat());
    let large = fluid(&[&["space.box=[10,10,10]", "output.energies.every=5"], changes].concat());
    let (_, state) = crate::support::start(&small);
    [
        (Box::new(reference(&small, &state)), Length { equilibration: 400, samples: 1200, largest_error: 0.004 }),
        (Box::new(Device::new(&large)), Length { equilibration: 300, samples: 500, largest_error: 0.0025 }),
    ]
}

/// How long to run for a mean, and how good it has to be.
struct Length {
    equilibration: u64,
    samples: u64,
    largest_error: f64,
}

#[test]
fn an_ideal_gas_flies_straight() {
    for dimension in ["[4,5,6]", "[7,5]"] {
        let scene = fluid(&["interactions=[]", &format!("space.box={dimension}"), "output.energies.every=100"]);
        let model = scene.model();
        for mut run in both(&scene) {
            let before = run.state();
            let steps = 200;
            let energy = run.observe().kinetic_energy;
            run.step(steps);
            let after = run.state();
            assert_eq!(after.momenta, before.momenta, "{}", run.name());
            for id in 0..before.len() {
                let velocity = model.units.momentum(before.momenta[id]);
                for axis in 0..model.units.dimension {
                    let drift = model.time_step * velocity[axis] / model.units.lengths[axis] * 4_294_967_296.0;
                    let expected = f64::from(before.positions[id][axis]) + steps as f64 * drift;
                    let turns = ((f64::from(after.positions[id][axis]) - expected) / 4_294_967_296.0).fract();
                    let difference = turns.abs().min(1.0 - turns.abs()) * 4_294_967_296.0;
                    // Each drift is rounded to a unit, and in single precision first.
                    let tolerance = steps as f64 * (1.0 + drift.abs() * 2.0_f64.powi(-22));
                    assert!(difference <= tolerance, "{}: {difference} units, not {tolerance}", run.name());
                }
            }
            assert!((run.observe().kinetic_energy / energy - 1.0).abs() < 1e-6, "{}", run.name());
        }
    }
}

/// Two unit masses in a wide box, with velocities along x, at rest in y and z.
fn two_particles(distance: f64, offset: f64, speed: f64, changes: &[&str]) -> Checked {
    let places = format!("[[4.0,5.0,5.0],[{},{},5.0]]", 4.0 + distance, 5.0 + offset);
    let velocities = format!("[[{speed},0,0],[{},0,0]]", -speed);
    let particles = format!(
        r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":{places}}},
            "velocities":{{"type":"listed","velocities":{velocities}}}}}]"#
    );
    let pair = ["space.box=[10,10,10]", "temperature=0", "output.energies.every=1", &particles];
    fluid(&[&pair, changes].concat())
}

#[test]
fn a_collision_without_friction_keeps_its_energy_to_second_order() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        let mut errors = [Vec::new(), Vec::new()];
        for time_step in [0.04, 0.02, 0.01, 0.005] {
            let step = format!("time.step={time_step}");
            let scene = two_particles(0.9, 0.2, 2.0, &[integrator, &step, "interactions.0.friction=0"]);
            for (errors, mut run) in errors.iter_mut().zip(both(&scene)) {
                // Within the cutoff throughout: where in a step it is passed changes the error itself.
                let initial = run.observe().total_energy();
                let steps = (0.32_f64 / time_step).round() as u64;
                let series = run.series(1, steps);
                // The trapezoidal rule, so that the mean square over a fixed time has no error of first order itself.
                let squares: Vec<f64> = series.iter().map(|row| (row.total_energy() - initial).powi(2)).collect();
                let sum = squares.iter().sum::<f64>() - 0.5 * squares[squares.len() - 1];
                errors.push((time_step, (sum / steps as f64).sqrt()));
                let closest = series.iter().map(|row| row.potential_energy).fold(0.0, f64::max);
                assert!(closest > 0.3 * initial, "there is a collision: {closest} of {initial}");
            }
        }
        for (name, errors) in ["reference", "device"].into_iter().zip(&errors) {
            let order = order(errors);
            println!("{name}, {integrator}: order {order:.3}, {errors:?}");
            // The next order, (dt ω)² of a few per cent at the largest step, bends the line a little.
            assert!((order - 2.0).abs() < 0.1, "{name}, {integrator}: order {order}, {errors:?}");
        }
    }
}

#[test]
fn friction_without_weight_damps_a_pair_exponentially() {
    // ω = 1: the relative velocity decays at the rate γ/μ = 2γ. The particles stay within 0.5 ± 0.2.
    let (friction, speed, time) = (2.0_f64, 0.2_f64, 0.8_f64);
    for integrator in [SPLITTING, GROOT_WARREN] {
        let mut errors = [Vec::new(), Vec::new()];
        for time_step in [0.04_f64, 0.02, 0.01] {
            let changes = [
                integrator,
                &format!("time.step={time_step}"),
                "interactions.0.repulsion=0",
                "interactions.0.weight_exponent=0",
                &format!("interactions.0.friction={friction}"),
            ];
            let scene = two_particles(0.5, 0.0, speed, &changes);
            let steps = (time / time_step).round() as i32;
            for (errors, mut run) in errors.iter_mut().zip(both(&scene)) {
                run.step(steps as u64);
                // E = v² for two unit masses at ±v.
                let found = run.observe().kinetic_energy.sqrt() / speed;
                let exact = (-2.0 * friction * time).exp();
                let scheme = if integrator == SPLITTING {
                    exact
                } else {
                    // Half a kick first, whole ones from then on, half of one to complete the last step.
                    (1.0 - friction * time_step).powi(2) * (1.0 - 2.0 * friction * time_step).powi(steps - 1)
                };
                // The device sums energies in integer units, which show in what little is left.
                let tolerance = 1e-4 * exact;
                assert!((found - scheme).abs() < tolerance, "{}, {integrator}: {found}, not {scheme}", run.name());
                errors.push((time_step, (found - exact).abs()));
            }
        }
        if integrator == GROOT_WARREN {
            for errors in &errors {
                let order = order(errors);
                assert!((order - 1.0).abs() < 0.15, "order {order}, {errors:?}");
            }
        }
    }
}

/// Pairs too far apart to feel each other, each at distance ½ along x, at rest.
fn isolated_pairs(noise: &str) -> Checked {
    let cells = 12;
    let mut positions = Vec::new();
    for cell in 0..cells * cells * cells {
        let [x, y, z] = [cell % cells, cell / cells % cells, cell / (cells * cells)].map(|n| 2.0 * f64::from(n) + 0.5);
        positions.push(format!("[{x},{y},{z}],[{},{y},{z}]", x + 0.5));
    }
    scene(&format!(
        r#"{{"title": "test", "space": {{"box": [24, 24, 24]}}, "time": {{"step": 0.04, "steps": 1}}, "temperature": 1.5,
        "integrator": {{"type": "groot-warren"}}, "noise": {noise},
        "particles": [{{"species": "A", "velocities": {{"type": "rest"}},
            "placement": {{"type": "listed", "positions": [{}]}}}}],
        "interactions": [{{"type": "dpd", "friction": 4.5}}]}}"#,
        positions.join(",")
    ))
}

const NOISES: [&str; 4] = [
    r#"{"generator": "pcg4d", "distribution": "uniform"}"#,
    r#"{"generator": "pcg4d", "distribution": "gaussian"}"#,
    r#"{"generator": "threefry2x32-20", "distribution": "uniform"}"#,
    r#"{"generator": "threefry2x32-20", "distribution": "gaussian"}"#,
];

#[test]
fn the_noise_of_pairs_has_no_mean_and_unit_variance() {
    for noise in NOISES {
        let scene = isolated_pairs(noise);
        let model = scene.model();
        for mut run in both(&scene) {
            run.step(1);
            let state = run.state();
            // The first half kick: √dt/2 σ (1 - ½) ζ with σ² = 2 · 4.5 · 1.5.
            let amplitude = 0.5 * 0.04_f64.sqrt() * (2.0 * 4.5 * 1.5_f64).sqrt() * 0.5;
            let noises: Vec<f64> = state
                .momenta
                .chunks_exact(2)
                .map(|pair| {
                    assert_eq!([pair[0][0], pair[0][1], pair[0][2]], [-pair[1][0], 0, 0]);
                    model.units.momentum(pair[0])[0] / amplitude
                })
                .collect();
            let count = noises.len() as f64;
            let moment = |power: i32| noises.iter().map(|noise| noise.powi(power)).sum::<f64>() / count;
            let uniform = noise.contains("uniform");
            // The variance of ζ² is that of ⟨ζ⁴⟩ = 9/5 or 3.
            let kurtosis = if uniform { 1.8 } else { 3.0 };
            let tolerances = [4.0 / count.sqrt(), 4.0 * ((kurtosis - 1.0) / count).sqrt()];
            let (mean, variance) = (moment(1), moment(2));
            println!("{}, {noise}: mean {mean:.4}, variance {variance:.4} of {count}", run.name());
            assert!(mean.abs() < tolerances[0], "{}, {noise}: mean {mean}", run.name());
            assert!((variance - 1.0).abs() < tolerances[1], "{}, {noise}: variance {variance}", run.name());
            let beyond = noises.iter().filter(|noise| noise.abs() > 3.0_f64.sqrt() * (1.0 + 1e-6)).count();
            // Of Gaussian numbers, 8.3 % are beyond √3.
            assert!(if uniform { beyond == 0 } else { (beyond as f64 / count - 0.083).abs() < 0.03 });
        }
    }
}

/// The known temperatures of Groot and Warren's integrator with one of the noises; with the first for twice as long as with others.
fn check_known_temperatures(number: usize) {
    let noise = format!("noise={}", NOISES[number]);
    for (mut run, length) in fluids(&[GROOT_WARREN, "time.step=0.04", &noise]) {
        // Every generator and every distribution once on the slower reference; single steps are compared with each of them.
        if run.name() == "reference" && ![0, 3].contains(&number) {
            continue;
        }
        let (shorter, largest_error) =
            if number == 0 { (1, length.largest_error) } else { (2, 1.7 * length.largest_error) };
        run.step(length.equilibration);
        let [kinetic, configurational, _] = equilibrium(&run.series(5, length.samples / shorter));
        let what = format!("{}, {noise}", run.name());
        kinetic.assert(&format!("{what}: kinetic"), 1.030, 0.003, largest_error);
        configurational.assert(&format!("{what}: configurational"), 1.057, 0.003, largest_error);
    }
}

#[test]
fn groot_warren_has_its_known_temperatures() {
    check_known_temperatures(0);
}

#[test]
fn every_noise_gives_the_same_temperatures() {
    (1..NOISES.len()).for_each(check_known_temperatures);
}

#[test]
fn splitting_has_both_temperatures_within_a_hundredth() {
    for (mut run, length) in fluids(&[SPLITTING, "time.step=0.04"]) {
        run.step(length.equilibration);
        let [kinetic, configurational, _] = equilibrium(&run.series(5, length.samples));
        kinetic.assert(&format!("{}, kinetic", run.name()), 1.0, 0.01, length.largest_error);
        configurational.assert(&format!("{}, configurational", run.name()), 1.0, 0.01, length.largest_error);
    }
}

/// Masses, cutoffs, exponents and frictions differ, and what moves and where it is have the temperature of the bath. The reference takes
/// the same single steps.
#[test]
fn a_mixture_of_three_cutoffs_has_both_temperatures() {
    let mixture = r#"particles=[{"species":"A","number_density":2},{"species":"B","number_density":1,"mass":2.5}]"#;
    // The repulsions a rc⁴ are about the same, so that the species stay mixed.
    let pairs = r#"interactions.0.pairs=[{"between":["A","A"],"cutoff":1.2,"repulsion":15,"weight_exponent":1},
        {"between":["B","B"],"cutoff":0.8,"repulsion":60,"friction":40,"weight_exponent":3},
        {"between":["A","B"],"friction":9}]"#;
    for (integrator, step) in [(STAGED, "time.step=0.02"), (COTTER_REICH, "time.step=0.01")] {
        let mut run =
            Device::new(&fluid(&[integrator, step, mixture, pairs, "space.box=[8,8,8]", "output.energies.every=10"]));
        run.step(500);
        // 1 536 particles: a sample is off by √(2/4608) = .021, and 250 of them, some three of which make a new one, by .0023.
        let [kinetic, configurational, _] = equilibrium(&run.series(10, 250));
        kinetic.assert(&format!("kinetic, {integrator}"), 1.0, 0.008, 0.005);
        configurational.assert(&format!("configurational, {integrator}"), 1.0, 0.01, 0.008);
    }
}

/// Where all pairs relax at once it is .84 in the dense fluid; with uniform noise two stages have .94 in the dilute one.
#[test]
fn two_stages_keep_the_temperature_under_strong_friction() {
    for (density, edge, friction) in [(3.0, 7, 100), (0.3, 15, 80)] {
        let mut run = Device::new(&fluid(&[
            STAGED,
            &format!("space.box=[{edge},{edge},{edge}]"),
            &format!("particles.0.number_density={density}"),
            "output.energies.every=1",
            "interactions.0.repulsion=0",
            &format!("interactions.0.friction={friction}"),
        ]));
        run.step(100);
        // Some 1 020 particles: a sample is off by √(2/3060) = .026; two steps make a new one where it is dense, some ten where
        // pairs have to meet.
        let series = run.series(1, if density > 1.0 { 400 } else { 1500 });
        let temperatures: Vec<f64> = series.iter().map(Observables::kinetic_temperature).collect();
        let kinetic = Measured::of(&temperatures);
        kinetic.assert(&format!("kinetic at density {density}"), 1.0, 0.008, 0.005);
    }
}

/// The reference takes the same single steps.
#[test]
fn the_pressure_is_the_published_one() {
    let mut run =
        Device::new(&fluid(&["space.box=[10,10,10]", "output.energies.every=5", SPLITTING, "time.step=0.02"]));
    run.step(600);
    let [_, _, pressure] = equilibrium(&run.series(5, 500));
    // 23.635(2), with 0.5 % for the step and the size of the box.
    pressure.assert("pressure", 23.635, 0.005 * 23.635, 0.1);
}

/// The reference takes the same single steps, and `reference` has a longer run of it.
#[test]
fn cotter_reich_has_the_temperature_and_the_published_pressure() {
    let mut run =
        Device::new(&fluid(&["space.box=[10,10,10]", "output.energies.every=5", COTTER_REICH, "time.step=0.01"]));
    run.step(800);
    let [kinetic, configurational, pressure] = equilibrium(&run.series(5, 500));
    kinetic.assert("kinetic", 1.0, 0.01, 0.004);
    configurational.assert("configurational", 1.0, 0.01, 0.004);
    pressure.assert("pressure", 23.635, 0.005 * 23.635, 0.1);
}

#[test]
fn a_plane_has_the_temperature_of_its_bath() {
    let changes = ["time.step=0.02", "temperature=2", "output.energies.every=5"];
    for (index, lengths) in ["space.box=[10,10]", "space.box=[25,25]"].into_iter().enumerate() {
        let scene = fluid(&[&changes[..], &[SPLITTING, lengths]].concat());
        let mut run = both(&scene).into_iter().nth(index).unwrap();
        run.step(500);
        let [kinetic, configurational, _] = equilibrium(&run.series(5, [1000, 400][index]));
        kinetic.assert(&format!("{}, kinetic", run.name()), 2.0, 0.02, 0.012);
        configurational.assert(&format!("{}, configurational", run.name()), 2.0, 0.02, 0.012);
    }
}

#[test]
fn species_share_the_temperature_and_speeds_are_maxwells() {
    let mixture = r#"particles=[{"species":"A","number_density":1.5},{"species":"B","number_density":1.5,"mass":10}]"#;
    // Strong friction, for heavy particles come to equilibrium slowly. Few kicks then make up a velocity: uniform noise
    // leaves ⟨v⁴⟩ a hundredth low.
    let gaussian = r#"noise={"generator":"pcg4d","distribution":"gaussian"}"#;
    let changes =
        [SPLITTING, mixture, gaussian, "time.step=0.02", "interactions.0.friction=18", "output.energies.every=20"];
    for (index, lengths) in ["space.box=[5,5,5]", "space.box=[10,10,10]"].into_iter().enumerate() {
        let scene = fluid(&[&changes[..], &[lengths]].concat());
        let model = scene.model();
        let mass: f64 = model.species.iter().map(|species| species.mass * species.count as f64).sum();
        let mut run = both(&scene).into_iter().nth(index).unwrap();
        run.step(400);
        let mut temperatures = [Vec::new(), Vec::new()];
        let mut fourth = [Vec::new(), Vec::new()];
        for _ in 0..[400, 120][index] {
            run.step(20);
            let state = run.reported();
            for (species, found) in model.species.iter().enumerate() {
                let energies: Vec<f64> = (0..state.len())
                    .filter(|id| state.species[*id] as usize == species)
                    .map(|id| model.units.momentum(state.momenta[id]).iter().map(|p| p * p).sum::<f64>() / found.mass)
                    .collect();
                let count = energies.len() as f64;
                // At zero total momentum ⟨p²⟩ = 3 kT m (1 - m/M).
                let freedom = 3.0 * (1.0 - found.mass / mass);
                let mean = energies.iter().sum::<f64>() / count;
                temperatures[species].push(mean / freedom);
                // ⟨v⁴⟩ = 5/3 ⟨v²⟩².
                fourth[species].push(energies.iter().map(|e| e * e).sum::<f64>() / count / freedom.powi(2));
            }
        }
        for species in 0..2 {
            let what = format!("{}, mass {}", run.name(), model.species[species].mass);
            let temperature = Measured::of(&temperatures[species]);
            temperature.assert(&format!("{what}, temperature"), 1.0, 0.01, 0.013);
            let square = temperature.mean.powi(2);
            let mean = Measured::of(&fourth[species]).mean / square;
            // Both are of the same speeds: the error is that of the ratio, to first order.
            let change = |(fourth, found): (&f64, &f64)| fourth / square - 2.0 * mean * found / temperature.mean;
            let changes: Vec<f64> = fourth[species].iter().zip(&temperatures[species]).map(change).collect();
            let ratio = Measured { mean, error: Measured::of(&changes).error };
            // A temperature a hundredth off scales out.
            ratio.assert(&format!("{what}, fourth moment"), 5.0 / 3.0, 0.005, 0.03);
        }
    }
}
