//! Pairs with memory in a fluid: Cotter and Reich, doi:10.1209/epl/i2003-00621-8.
//!
//! The bath does not change what is in equilibrium: whatever its rate, both temperatures are kT and the pressure is that of
//! the standard fluid, 23.635(2) at vanishing time step (Shardlow's integrator, published).

use mesoscope::measure::Observables;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::state::State;

use crate::support::{Device, Implementation, Measured, deviate, equilibrium, fluid, scene, start};

/// The standard fluid with memory in a box of an edge.
fn remembering(edge: f64, rate: f64, scheme: &str, changes: &[&str]) -> Checked {
    let lengths = format!("space.box=[{edge},{edge},{edge}]");
    let bath = format!(r#"interactions.0.bath={{"type":"memory","rate":{rate},"scheme":"{scheme}"}}"#);
    fluid(&[&["time.step=0.01", "output.energies.every=10", &lengths, &bath], changes].concat())
}

/// A state in equilibrium, from a fluid with a fast bath: a slow one would take long to get there. Since a slow one does
/// not change the energy much either, the state is one whose energy is near the mean over so many samples.
fn settled(edge: f64, changes: &[&str], samples: u64) -> State {
    let lattice = [&[r#"particles.0.placement.type="lattice""#], changes].concat();
    let mut run = Device::new(&remembering(edge, 1000.0, "exponential", &lattice));
    run.step(800);
    let energies: Vec<f64> = run.series(10, samples).iter().map(Observables::total_energy).collect();
    let mean = energies.iter().sum::<f64>() / energies.len() as f64;
    while (run.observe().total_energy() / mean - 1.0).abs() > 2e-4 {
        run.step(10);
    }
    let state = run.reported();
    State { positions: state.positions, momenta: state.momenta, species: state.species, ..State::default() }
}

/// Standard errors of the two temperatures and the pressure in a run of so many particles and so many time units.
///
/// Eight seeds of 192 particles and 25 time units at rate 5 scattered by these, and so did eight with another margin of the list: three
/// times what blocking sees of the slow turns between kinetic and potential energy in one of them.
fn scatter(particles: usize, time: f64) -> [f64; 3] {
    let shorter = (192.0 / particles as f64 * 25.0 / time).sqrt();
    [0.018, 0.017, 0.06].map(|scatter| scatter * shorter)
}

/// Runs of the rates, each with a margin of the list, against the law; and the mean of the rates, which is known better.
fn check_statics(edge: f64, cases: &[(f64, f64)], [settling, steps]: [u64; 2], changes: &[&str]) {
    let state = settled(edge, changes, settling);
    let mut means = [0.0; 3];
    let mut errors = [0.0; 3];
    for ((rate, margin), scheme) in cases.iter().zip(["exponential", "cotter-reich", "exponential"].into_iter().cycle())
    {
        let margin = format!("interactions.0.skin={margin}");
        let scene = remembering(edge, *rate, scheme, &[changes, &[&margin]].concat());
        let mut run = Device::from_state(&scene, &state, Options::default());
        run.step(200);
        let measured = equilibrium(&run.series(10, steps / 10));
        errors = scatter(state.len(), steps as f64 * scene.time.step);
        check_equilibrium(&format!("rate {rate}"), measured.map(|measured| measured.mean), errors);
        for (mean, measured) in means.iter_mut().zip(measured) {
            *mean += measured.mean / cases.len() as f64;
        }
    }
    check_equilibrium("all rates", means, errors.map(|error| error / (cases.len() as f64).sqrt()));
}

/// kT is 1 and the pressure that of the standard fluid, but for a part of what four standard errors allow that the time step makes.
fn check_equilibrium(what: &str, means: [f64; 3], errors: [f64; 3]) {
    let expected =
        [("kinetic temperature", 1.0, 0.01), ("configurational temperature", 1.0, 0.01), ("pressure", 23.635, 0.06)];
    for (((name, value, allowance), mean), error) in expected.into_iter().zip(means).zip(errors) {
        Measured { mean, error }.assert(&format!("{name}, {what}"), value, allowance, error);
    }
}

/// The pressure is within 1.2 % at each rate, and within .8 % on average: a quarter of a per cent is for the time step, the rest four
/// standard errors. Neither does it know of the margin of the list, which decides which pairs go on with the bath that they had.
#[test]
fn memory_does_not_change_what_is_in_equilibrium() {
    check_statics(5.0, &[(10.0, 0.1), (100.0, 0.6), (1000.0, 0.3)], [400, 1500], &[]);
}

/// Within half a per cent of the pressure at each rate, and a third on average.
#[test]
#[ignore = "minutes"]
fn the_pressure_is_the_same_at_every_rate() {
    let cases = [(0.1, 0.3), (1.0, 0.3), (10.0, 0.1), (100.0, 0.6), (1000.0, 0.3)];
    // 3 000 particles and 160 time units leave the mean temperature of the start uncertain by about 0.3 %.
    check_statics(10.0, &cases, [3200, 8000], &["time.step=0.005"]);
}

/// Self-diffusion at fixed friction comes down to that without memory, .29 within 3 %, as the rate grows.
#[test]
#[ignore = "minutes"]
fn diffusion_comes_down_to_that_without_memory() {
    let state = settled(8.0, &[], 300);
    let mut last = f64::INFINITY;
    for rate in [0.3, 3.0, 1000.0] {
        let scene = remembering(8.0, rate, "exponential", &[]);
        let model = scene.model();
        let mut run = Device::from_state(&scene, &state, Options::default());
        run.step(300);
        // Twice the slope of the squared displacement between two times, over stretches end to end.
        let mut rates = Vec::new();
        for _ in 0..24 {
            let mut from = run.reported();
            let mut travelled = vec![[0.0; 3]; from.len()];
            let mut squares = [0.0; 2];
            for part in 0..6 {
                run.step(50);
                let now = run.reported();
                for (id, way) in travelled.iter_mut().enumerate() {
                    let step = model.units.displacement(now.positions[id], from.positions[id]);
                    for axis in 0..3 {
                        way[axis] += step[axis];
                    }
                }
                let square = travelled.iter().flatten().map(|x| x * x).sum::<f64>() / from.len() as f64;
                if part == 2 {
                    squares[0] = square;
                }
                squares[1] = square;
                from = now;
            }
            rates.push((squares[1] - squares[0]) / (6.0 * 1.5));
        }
        let measured = Measured::of(&rates);
        println!("rate {rate}: D = {:.4} ± {:.4}", measured.mean, measured.error);
        assert!(measured.mean < last - 2.0 * measured.error, "rate {rate}: {measured:?}, before {last}");
        last = measured.mean;
        if rate == 1000.0 {
            measured.assert("diffusion of a fast bath", 0.29, 0.015, 0.006);
        }
    }
}

/// Pairs on a line, each alone: with a weight of 1 everywhere inside the cutoff φ is linear, so that the velocity
/// autocorrelation of the relative motion is C₀ = 1, C₁ = 1 - g/2, Cₙ₊₁ = (1 + e - g)Cₙ - e Cₙ₋₁ with g = B(1 + e)/2.
#[test]
fn a_pair_alone_has_the_discrete_velocity_autocorrelation() {
    const PAIRS: usize = 10_000;
    // The correlation falls by √e, .80 to .82, a step: to a hundredth, the standard error.
    const LAGS: usize = 22;
    let (time_step, rate, coupling, mass) = (0.1_f64, 4.0_f64, 30.0_f64, 2.0_f64);
    for scheme in ["cotter-reich", "symmetric", "exponential"] {
        let text = format!(
            r#"{{
            "title": "test", "space": {{"box": [{}]}}, "time": {{"step": {time_step}, "steps": 1}}, "temperature": 1.5,
            "particles": [{{"species": "A", "count": {}, "mass": {mass}}}],
            "interactions": [{{"type": "dpd", "cutoff": 20, "weight_exponent": 0, "skin": 2,
                "bath": {{"type": "memory", "rate": {rate}, "coupling": {coupling}, "scheme": "{scheme}"}}}}]
        }}"#,
            50 * PAIRS,
            2 * PAIRS
        );
        let scene = scene(&text);
        let (model, mut state) = start(&scene);
        for index in 0..PAIRS {
            let p = (0.5 * mass * 1.5_f64).sqrt() * deviate(8, [index as u32, 0]);
            state.momenta[index] = [(p / model.units.momentum).round() as i32, 0, 0];
            state.momenta[PAIRS + index] = [-state.momenta[index][0], 0, 0];
            let place = 50.0 * index as f64 + 15.0;
            state.positions[index] = model.units.fraction([place, 0.0, 0.0]);
            state.positions[PAIRS + index] = model.units.fraction([place - 10.0, 0.0, 0.0]);
        }
        let a = rate * time_step;
        let (e, factor) = match scheme {
            "cotter-reich" => (1.0 / (1.0 + a), 1.0 / (1.0 + a / 2.0)),
            "symmetric" => ((1.0 - a / 2.0) / (1.0 + a / 2.0), 1.0),
            _ => ((-a).exp(), (a / 2.0).tanh() / (a / 2.0)),
        };
        // The reduced mass is half of one.
        let g = coupling * factor * time_step * time_step / (0.5 * mass) * (1.0 + e) / 2.0;
        let mut expected = vec![1.0, 1.0 - g / 2.0];
        let mut run = Device::from_state(&scene, &state, Options::default());
        let momenta = |run: &mut Device| -> Vec<f64> {
            run.reported().momenta[..PAIRS].iter().map(|p| f64::from(p[0])).collect()
        };
        let first = momenta(&mut run);
        let square = first.iter().map(|p| p * p).sum::<f64>() / PAIRS as f64;
        for lag in 1..=LAGS {
            run.step(1);
            let now = momenta(&mut run);
            let mean = first.iter().zip(&now).map(|(a, b)| a * b / square).sum::<f64>() / PAIRS as f64;
            // The error of a slope of regression between two Gaussian numbers of equal width; and rounding of single precision.
            let error = ((1.0 - expected[lag].powi(2)) / PAIRS as f64).sqrt();
            Measured { mean, error }.assert(&format!("{scheme}, lag {lag}"), expected[lag], 1e-4, 0.01);
            expected.push((1.0 + e - g) * expected[lag] - e * expected[lag - 1]);
        }
        assert_eq!(run.reported().total_momentum(), [0; 3]);
    }
}
