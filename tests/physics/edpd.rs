//! Pairs with memory in a fluid: Cotter and Reich, doi:10.1209/epl/i2003-00621-8.
//!
//! The bath does not change what is in equilibrium: whatever its rate, both temperatures are kT and the pressure is that of
//! the standard fluid, 23.635(2) at vanishing time step (Shardlow's integrator, published).

use mesoscope::families::Model;
use mesoscope::measure::Observables;
use mesoscope::plan::Options;
use mesoscope::scene::Scene;
use mesoscope::state::State;

use crate::support::{Device, Implementation, Measured, deviate, equilibrium, fluid, scene, start};

/// The standard fluid with memory in a box of an edge.
fn remembering(edge: f64, rate: f64, scheme: &str, changes: &[&str]) -> Scene {
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
    State { step: 0, ..state }
}

fn check_statics(edge: f64, rates: &[f64], steps: u64, changes: &[&str], [allowance, error]: [f64; 2]) {
    // 3 000 particles and 160 time units leave the mean temperature of the start uncertain by about 0.3 %.
    let state = settled(edge, changes, steps / 5 * 2);
    for (rate, scheme) in rates.iter().zip(["exponential", "cotter-reich", "exponential"].into_iter().cycle()) {
        let scene = remembering(edge, *rate, scheme, changes);
        let mut run = Device::from_state(&scene, &state, Options::default());
        run.step(200);
        let [kinetic, configurational, pressure] = equilibrium(&run.series(10, steps / 10));
        // Of 375 particles the temperature varies by √(2/3N) = .042; of 150 samples some 25 are independent, which makes an
        // error of .008, and from so few blocks it is itself found within a factor of two only.
        kinetic.assert(&format!("kinetic temperature, rate {rate}"), 1.0, 0.01, 0.016);
        configurational.assert(&format!("configurational temperature, rate {rate}"), 1.0, 0.01, 0.024);
        pressure.assert(&format!("pressure, rate {rate}"), 23.635, allowance, error);
    }
}

/// 1 % of the pressure in all: a quarter of it for the time step, the rest four standard errors.
#[test]
fn memory_does_not_change_what_is_in_equilibrium() {
    check_statics(5.0, &[10.0, 100.0, 1000.0], 1500, &[], [0.06, 0.045]);
}

/// Half a per cent of the pressure in all.
#[test]
#[ignore = "minutes"]
fn the_pressure_is_the_same_at_every_rate() {
    check_statics(10.0, &[0.1, 1.0, 10.0, 100.0, 1000.0], 8000, &["time.step=0.005"], [0.06, 0.0145]);
}

/// Self-diffusion at fixed friction comes down to that without memory, .29 within 3 %, as the rate grows.
#[test]
#[ignore = "minutes"]
fn diffusion_comes_down_to_that_without_memory() {
    let state = settled(8.0, &[], 300);
    let mut last = f64::INFINITY;
    for rate in [0.3, 3.0, 1000.0] {
        let scene = remembering(8.0, rate, "exponential", &[]);
        let model = Model::new(&scene);
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
    const PAIRS: usize = 40_000;
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
        for lag in 1..=50 {
            run.step(1);
            let now = momenta(&mut run);
            let products: Vec<f64> = first.iter().zip(&now).map(|(a, b)| a * b / square).collect();
            let what = format!("{scheme}, lag {lag}");
            // √((1 + C²)/N) at most, with the spread of the square itself.
            Measured::of_independent(&products).assert(&what, expected[lag], 0.0, 0.0085);
            expected.push((1.0 + e - g) * expected[lag] - e * expected[lag - 1]);
        }
        assert_eq!(run.reported().total_momentum(), [0; 3]);
    }
}

/// A list of another margin carries pairs for another time: other random numbers, the same statistics.
#[test]
fn the_margin_of_the_list_changes_no_statistics() {
    const SEEDS: u64 = 3;
    let state = settled(4.0, &[], 300);
    // Means of the two temperatures and the pressure over the seeds.
    let means = |skin: &str| {
        let mut sums = [0.0; 3];
        for seed in 1..=SEEDS {
            let scene = remembering(4.0, 5.0, "exponential", &[skin, &format!("seed={seed}")]);
            let mut run = Device::from_state(&scene, &state, Options::default());
            run.step(100);
            for (sum, measured) in sums.iter_mut().zip(equilibrium(&run.series(10, 250))) {
                *sum += measured.mean / SEEDS as f64;
            }
        }
        sums
    };
    let [narrow, wide] = ["interactions.0.skin=0.1", "interactions.0.skin=0.6"].map(means);
    // Such stretches scatter from seed to seed by these (eight seeds of each margin): three times what blocking sees in one of them
    // of the slow turns between kinetic and potential energy.
    for (quantity, scatter) in [0.018, 0.017, 0.06].into_iter().enumerate() {
        let error = scatter * (2.0 / SEEDS as f64).sqrt();
        assert!((narrow[quantity] - wide[quantity]).abs() < 4.0 * error, "{narrow:?} {wide:?}");
        assert!(narrow[quantity] != wide[quantity], "the margin had no effect at all");
    }
}
