//! Coloured noise on the device: every jump against the law in double precision, correlations against closed forms, and
//! what the noise does to a gas with friction.
//!
//! Forces are measured as impulses between reports: averages over a step, whose correlations follow exactly from C(t).

use mesoscope::engine::Engine;
use mesoscope::families::{ColouredNoise, Model};
use mesoscope::plan::Options;
use mesoscope::scene::{self, Checked};
use mesoscope::state::{Reported, State};

use crate::support::{Device, Implementation, Measured, built_in, changed, edited, engine, start};

const STATIONARY: [&str; 3] = ["kangaroo", "kangaroo-exponential", "short"];
/// Standard errors that a mean of many may be off: one in 150 000 is more than 4.5.
const DEVIATIONS: f64 = 4.5;

/// Particles at rest in a box that nothing but a coloured noise of strength 2 and time 0.05 acts on, with changes.
fn free(process: &str, changes: &[&str]) -> Checked {
    let text = r#"{
        "title": "test", "space": {"box": [50, 50]}, "time": {"step": 0.01, "steps": 1}, "temperature": 0,
        "particles": [{"species": "A", "count": 20000}],
        "interactions": [{"type": "coloured-noise", "strength": 2, "time": 0.05}]
    }"#;
    changed(text, &[&[format!("interactions.0.process={process}").as_str()], changes].concat())
}

fn noise_of(model: &Model) -> ColouredNoise {
    *model.particles().coloured_noise.as_ref().expect("a coloured noise")
}

/// The first steps of a scene on the device.
fn run(scene: &Checked) -> (Model, State, Engine<'static>) {
    let (model, state) = start(scene);
    let engine = engine(scene, &state, Options::default());
    (model, state, engine)
}

/// Force on every particle, averaged over every one of the first steps.
fn forces(scene: &Checked, steps: usize) -> Vec<Vec<[f64; 3]>> {
    forces_at(scene, &(0..steps as u64).collect::<Vec<_>>())
}

/// The same of some steps only.
fn forces_at(scene: &Checked, steps: &[u64]) -> Vec<Vec<[f64; 3]>> {
    let (model, start, mut engine) = run(scene);
    let mut before = Reported::from(start);
    let forces = steps.iter().map(|&step| {
        if engine.step() < step {
            engine.advance(step - engine.step(), 50).unwrap();
            before = engine.reported().unwrap();
        }
        engine.advance(1, 1).unwrap();
        let after = engine.reported().unwrap();
        let change = |(new, old): (&[i32; 3], &[i32; 3])| {
            std::array::from_fn(|axis| f64::from(new[axis] - old[axis]) * model.units.momentum / model.time_step)
        };
        let forces = after.momenta.iter().zip(&before.momenta).map(change).collect();
        before = after;
        forces
    });
    forces.collect()
}

fn mean(values: impl Iterator<Item = f64>) -> Measured {
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for value in values {
        count += 1.0;
        sum += value;
        squares += value * value;
    }
    let mean: f64 = sum / count;
    Measured { mean, error: ((squares / count - mean * mean) / count).sqrt() }
}

#[track_caller]
fn assert_within(found: Measured, expected: f64, widest: f64, what: &str) {
    assert!(found.error <= widest, "{what}: the standard error {} is larger than {widest}", found.error);
    let off = (found.mean - expected).abs();
    assert!(off <= DEVIATIONS * found.error, "{what}: {} ± {}, expected {expected}", found.mean, found.error);
}

/// ∫₀ˣ f by Simpson's rule.
fn integral(f: impl Fn(f64) -> f64, x: f64) -> f64 {
    let pieces = 2000;
    let width = x / f64::from(pieces);
    let weight = |k: i32| {
        if k == 0 || k == pieces {
            1.0
        } else if k % 2 == 1 {
            4.0
        } else {
            2.0
        }
    };
    (0..=pieces).map(|k| weight(k) * f(f64::from(k) * width)).sum::<f64>() * width / 3.0
}

/// G(t) of G'' = C/α, G(0) = G'(0) = 0, for a time ε or τ of one.
fn twice_integrated(process: &str, t: f64) -> f64 {
    match process {
        "kangaroo" if t <= 1.0 => t * t / 2.0 - t.powi(3) / 12.0,
        "kangaroo" => 5.0 / 12.0 + 0.75 * (t - 1.0) + 0.5 * (t * t.ln() - t + 1.0),
        "kangaroo-exponential" => {
            let entire = integral(|u| if u == 0.0 { 1.0 } else { -(-u).exp_m1() / u }, t);
            t * entire - t - (-t).exp_m1()
        }
        "short" => t + (-t).exp_m1(),
        other => panic!("{other} is not stationary"),
    }
}

/// ⟨A(0)·A(n)⟩/α of averages A over steps: the second difference of G.
fn exact_correlation(process: &str, lag: usize, step_over_time: f64) -> f64 {
    let g = |k: i64| twice_integrated(process, k.unsigned_abs() as f64 * step_over_time);
    let lag = lag as i64;
    (g(lag + 1) - 2.0 * g(lag) + g(lag - 1)) / step_over_time.powi(2)
}

#[test]
fn averages_over_steps_follow_from_the_autocorrelation() {
    // The second difference of G against C itself, where a step is short, and against the mean square of white noise.
    for (process, correlation) in [
        ("kangaroo", (|t| if t <= 1.0 { 1.0 - t / 2.0 } else { 0.5 / t }) as fn(f64) -> f64),
        ("kangaroo-exponential", |t| -(-t).exp_m1() / t),
        ("short", |t| (-t).exp()),
    ] {
        for lag in [20, 100, 140, 300] {
            let found = exact_correlation(process, lag, 0.01);
            assert!((found - correlation(lag as f64 * 0.01)).abs() < 1e-4, "{process}: {found} at {lag}");
        }
    }
    assert!((exact_correlation("short", 0, 1000.0) - 0.002).abs() < 3e-6);
}

/// ⟨F(0)·F(t)⟩ in every component, no other correlation, and no drift of either from step 0 on, in forces that are long
/// and short against a step.
fn check_correlations(process: &str, dimension: usize, step: f64, steps: usize) {
    let boxes = ["space.box=[1000000]", "space.box=[50,50]", "space.box=[50,50,50]"];
    let step_over_time = step / 0.05;
    let step = format!("time.step={step}");
    let scene = free(process, &[boxes[dimension - 1], &step]);
    let forces = forces(&scene, steps);
    let particles = forces[0].len();
    let strength = 2.0;
    for lag in [0, 1, 2, 3, 5, 8, 12, 20, 40, 63].into_iter().filter(|lag| *lag < steps) {
        let what = format!("{process} in {dimension} dimensions, {step_over_time} times a step, {lag} steps apart");
        let exact = strength * exact_correlation(process, lag, step_over_time);
        // Means over the origins, of every particle: each axis with itself and with the one before.
        let mut correlations = vec![[[0.0; 3]; 2]; particles];
        let origins = steps - lag;
        for (now, later) in forces.iter().zip(&forces[lag..]) {
            for ([same, cross], (now, later)) in correlations.iter_mut().zip(now.iter().zip(later)) {
                for axis in 0..dimension {
                    same[axis] += now[axis] * later[axis] / origins as f64;
                    if axis > 0 {
                        cross[axis] += now[axis - 1] * later[axis] / origins as f64;
                    }
                }
            }
        }
        let whole = mean(correlations.iter().map(|[same, _]| same.iter().sum()));
        assert_within(whole, exact, 0.01 * strength, &what);
        for axis in 0..dimension {
            let part = mean(correlations.iter().map(|[same, _]| same[axis]));
            assert_within(part, exact / dimension as f64, 0.01 * strength, &format!("{what}, axis {axis}"));
            if axis > 0 {
                let cross = mean(correlations.iter().map(|[_, cross]| cross[axis]));
                assert_within(cross, 0.0, 0.01 * strength, &format!("{what}, axes {} and {axis}", axis - 1));
            }
        }
    }
    for (n, forces) in forces.iter().enumerate().filter(|(n, _)| [0, 1, steps / 2, steps - 1].contains(n)) {
        for axis in 0..dimension {
            let what = format!("{process}, axis {axis} at step {n}");
            assert_within(mean(forces.iter().map(|force| force[axis])), 0.0, 0.01 * strength, &what);
            let square = strength * exact_correlation(process, 0, step_over_time) / dimension as f64;
            let found = mean(forces.iter().map(|force| force[axis] * force[axis]));
            if dimension == 1 && found.error < 1e-3 {
                continue; // Nearly all squares are α.
            }
            assert_within(found, square, 0.01 * strength, &format!("{what}, squared"));
        }
    }
}

#[test]
fn correlations_are_exact_within_holding_times() {
    for process in STATIONARY {
        check_correlations(process, 2, 0.005, 64);
    }
}

#[test]
fn correlations_have_their_tails() {
    for process in STATIONARY {
        check_correlations(process, 2, 0.04, 64);
    }
}

#[test]
fn correlations_are_exact_with_several_jumps_in_a_step() {
    for process in STATIONARY {
        check_correlations(process, 2, 0.4, 13);
    }
}

#[test]
fn correlations_in_one_and_three_dimensions() {
    for process in STATIONARY {
        for dimension in [1, 3] {
            check_correlations(process, dimension, 0.02, 41);
        }
    }
}

/// Mean force ⟨F(t)⟩/√α of the printed process a time t = k·width·ε after it has begun, and ⟨F(0)·F(t)⟩/α: the renewal
/// equation m(t) = ∫_{hold > t} f + ∫ m(t - s) dP(s), where the hold ε/φ of a uniform φ has the density ε/s².
fn literal_law(time: f64, width: f64, count: usize) -> (Vec<[f64; 2]>, Vec<f64>) {
    let turn = 1.0 / time.sqrt();
    let force = |phi: f64| [(phi * turn).cos(), (phi * turn).sin()];
    // ∫₀ᵠ f.
    let survived = |phi: f64| [(phi * turn).sin() / turn, (1.0 - (phi * turn).cos()) / turn];
    let first = (1.0 / width).round() as usize;
    let mut means: Vec<[f64; 2]> = Vec::new();
    let mut correlations = Vec::new();
    for k in 0..count {
        let t = k as f64 * width;
        let phi = if k <= first { 1.0 } else { 1.0 / t };
        let mut mean = survived(phi);
        let mut correlation = phi;
        if k > first {
            for j in first..=k {
                let s = j as f64 * width;
                let weight = width / (s * s) * if j == first || j == k { 0.5 } else { 1.0 };
                let (later, now) = (means[k - j], force(1.0 / s));
                for axis in 0..2 {
                    mean[axis] += weight * later[axis];
                    correlation += weight * later[axis] * now[axis];
                }
            }
        }
        means.push(mean);
        correlations.push(correlation);
    }
    (means, correlations)
}

#[test]
fn the_printed_process_ages_as_the_renewal_equation_says() {
    // Per draw: PHYSICS of the paper's own parameters.
    let (means, correlations) = literal_law(0.05, 1.0 / 200.0, 4001);
    assert!((means[0][0] + 0.2172).abs() < 1e-4 && (means[0][1] - 0.2768).abs() < 1e-4);
    let steps = [0, 5, 9, 10, 15, 30, 60, 120, 199]; // of ε/10, 20 grid points
    let scene = free("literal", &["time.step=0.005", "particles.0.count=40000"]);
    let forces = forces_at(&scene, &steps);
    let average = |values: &dyn Fn(usize) -> f64, step: usize| {
        let part = |j: usize| if j == 0 || j == 20 { 0.5 } else { 1.0 } * values(20 * step + j);
        (0..=20).map(part).sum::<f64>() / 20.0
    };
    for (force, step) in forces.iter().zip(steps.map(|step| step as usize)) {
        for axis in 0..2 {
            let expected = 2_f64.sqrt() * average(&|k| means[k][axis], step);
            let found = mean(force.iter().map(|force| force[axis]));
            // The grid of the renewal equation adds a thousandth.
            let off = (found.mean - expected).abs();
            println!("step {step}, axis {axis}: {} ± {}, expected {expected}", found.mean, found.error);
            assert!(off < DEVIATIONS * found.error + 1e-3 && found.error < 0.01, "{found:?}, expected {expected}");
        }
        // The first step is shorter than any hold: its average is the first force itself.
        let expected = 2.0 * average(&|k| correlations[k], step);
        let found = mean(forces[0].iter().zip(force).map(|(a, b)| a[0] * b[0] + a[1] * b[1]));
        println!("step {step}: correlation {} ± {}, expected {expected}", found.mean, found.error);
        assert!((found.mean - expected).abs() < DEVIATIONS * found.error + 2e-3, "{found:?}, expected {expected}");
    }
    // It ages towards (√α, 0), slowly.
    let late = mean(forces[steps.len() - 1].iter().map(|force| force[0])).mean;
    assert!(late > mean(forces[0].iter().map(|force| force[0])).mean + 0.5, "{late}");
}

/// The process of a particle in double precision after a time in half steps: jumps so far, force, time left, and the
/// integral of the force.
fn by_hand(model: &Model, id: u32, elapsed: f64) -> (u32, [f64; 3], f64, [f64; 3]) {
    let noise = noise_of(model);
    let half_step = 0.5 * model.time_step;
    let dimension = model.units.dimension;
    let mut now = noise.start(dimension, ColouredNoise::uniform_numbers(model, id, 0));
    let (mut begun, mut jumps, mut integral) = (0.0, 1, [0.0; 3]);
    loop {
        let end = begun + now.time / half_step;
        let until = end.min(elapsed);
        for (sum, force) in integral.iter_mut().zip(now.force) {
            *sum += force * (until - begun) * half_step;
        }
        if end > elapsed {
            return (jumps, now.force, end - elapsed, integral);
        }
        begun = end;
        now = noise.jump(dimension, ColouredNoise::uniform_numbers(model, id, jumps));
        jumps += 1;
    }
}

/// Every particle's process after some steps against [`by_hand`].
fn check_jumps(scene: &Checked, steps: u64) -> u64 {
    let (model, _, mut engine) = run(scene);
    engine.advance(steps, 10).unwrap();
    let state = engine.state().unwrap();
    let elapsed = (2 * steps - 1) as f64;
    let strength = noise_of(&model).strength.sqrt();
    let (mut uncertain, mut total) = (0, 0);
    for (id, hold) in state.holds.iter().enumerate() {
        let (jumps, force, left, integral) = by_hand(&model, id as u32, elapsed);
        let found_left = f64::from(hold.halves) + f64::from(f32::from_bits(hold.fraction));
        // Single precision of the holding times, each of at most what has passed and is left.
        let timing = 1e-6 * (f64::from(jumps) + elapsed + left);
        let what = format!("{} particle {id}: {hold:?}, jump {jumps}, left {left}", scene.title);
        if hold.jump != jumps {
            // One jump falls on the end of the half step but for rounding.
            assert!(left < timing || found_left < timing || hold.jump.abs_diff(jumps) == 1, "{what}");
            uncertain += 1;
            continue;
        }
        total += u64::from(jumps);
        assert!((found_left - left).abs() <= timing, "{what}: off by {}", found_left - left);
        for axis in 0..3 {
            let found = f64::from(f32::from_bits(hold.force[axis]));
            // The error of the sine and the cosine, and single precision, on any driver.
            assert!((found - force[axis]).abs() < 1e-6 * strength, "{what}: force {found} for {}", force[axis]);
            let impulse = f64::from(state.momenta[id][axis]) * model.units.momentum;
            // Every half step is rounded to units of momentum.
            let rounding = 0.5 * elapsed * model.units.momentum + strength * model.time_step * timing;
            assert!((impulse - integral[axis]).abs() < rounding, "{what}: {impulse} for {}", integral[axis]);
        }
    }
    assert!(uncertain * 1000 <= state.len(), "{uncertain} of {} particles", state.len());
    total
}

#[test]
fn every_jump_is_that_of_the_law_in_double_precision() {
    for process in ["kangaroo", "kangaroo-exponential", "short", "literal"] {
        for dimension in [1, 2, 3] {
            if process == "literal" && dimension != 2 {
                continue;
            }
            for generator in ["pcg4d", "threefry2x32-20"] {
                let boxes = ["space.box=[1000000]", "space.box=[50,50]", "space.box=[50,50,50]"];
                let generator = format!("noise.generator={generator}");
                let changes = [boxes[dimension - 1], &generator, "particles.0.count=2000", "time.step=0.05"];
                let jumps = check_jumps(&free(process, &changes), 40);
                assert!(jumps > 5 * 2000, "{process}: only {jumps} jumps");
            }
        }
    }
}

#[test]
fn as_many_jumps_in_a_step_as_a_scene_may_ask_for() {
    for process in STATIONARY {
        let scene = free(process, &["particles.0.count=500", "time.step=12.8", "space.box=[1000000,1000000]"]);
        let jumps = check_jumps(&scene, 10);
        assert!(jumps > 10 * 100 * 500, "{process}: only {jumps} jumps");
    }
}

#[test]
fn forces_that_outlast_any_run_lose_nothing() {
    for time in [1e7, 1e12, 1e90] {
        let scene =
            free("kangaroo", &[&format!("interactions.0.time={time}"), "particles.0.count=200", "time.step=0.001"]);
        let (_, before, mut engine) = run(&scene);
        engine.advance(50, 50).unwrap();
        let after = engine.state().unwrap();
        for (old, new) in before.holds.iter().zip(&after.holds) {
            // Whole half steps are counted down exactly, and nothing else changes.
            if old.jump == new.jump {
                assert_eq!((old.halves - new.halves, old.fraction, old.force), (99, new.fraction, new.force));
            }
        }
        let kept = before.holds.iter().zip(&after.holds).filter(|(old, new)| old.jump == new.jump).count();
        assert!(kept >= 199, "{kept}");
    }
}

/// A gas of pairs with friction under noise.
fn gas(changes: &[&str]) -> Checked {
    built_in("coloured-noise", changes)
}

#[test]
fn reruns_restarts_reports_and_storage_change_no_bit() {
    for process in ["kangaroo", "short"] {
        let process = format!("interactions.1.process={process}");
        let scene = gas(&[&process, "space.box=[12,12]", "particles.0.count=300", "time.step=0.02"]);
        let (_, before, mut whole) = run(&scene);
        whole.advance(60, 60).unwrap();
        let expected = whole.state().unwrap();
        assert_ne!(expected.holds, before.holds);

        let (_, _, mut stopped) = run(&scene);
        stopped.advance(23, 7).unwrap();
        let middle = stopped.state().unwrap();
        let mut resumed = engine(&scene, &middle, Options::default());
        let backwards: Vec<usize> = (0..middle.len()).rev().collect();
        resumed.upload_in_order(&middle, &backwards).unwrap();
        resumed.advance(37, 37).unwrap();
        assert_eq!(resumed.state().unwrap(), expected, "{process}");

        let (_, _, mut watched) = run(&scene);
        for _ in 0..59 {
            watched.advance(1, 1).unwrap();
            watched.reported().unwrap();
        }
        watched.advance(1, 1).unwrap();
        assert_eq!(watched.state().unwrap(), expected, "{process}, with reports");

        let other = edited(&scene, |scene| scene.seed += 1);
        let (_, _, mut other) = run(&other);
        other.advance(60, 60).unwrap();
        assert_ne!(other.state().unwrap().holds, expected.holds);
    }
}

#[test]
fn without_strength_nothing_moves() {
    for process in STATIONARY {
        let (_, before, mut engine) = run(&free(process, &["interactions.0.strength=0", "particles.0.count=100"]));
        engine.advance(20, 20).unwrap();
        let after = engine.state().unwrap();
        assert_eq!(before.positions, after.positions);
        assert_eq!(after.total_momentum(), [0; 3]);
        assert!(before.holds.is_empty() && after.holds.is_empty());
    }
}

#[test]
fn temperatures_are_about_the_centre_of_mass() {
    // The printed process drives all particles alike.
    let scene = free("literal", &["time.step=0.02", "output.energies.every=1"]);
    let model = scene.model();
    let mut device = Device::new(&scene);
    device.step(400);
    let row = device.observe();
    let reported = device.reported();
    let momenta: Vec<[f64; 3]> = reported.momenta.iter().map(|units| model.units.momentum(*units)).collect();
    let count = momenta.len() as f64;
    let bulk: [f64; 3] = std::array::from_fn(|axis| momenta.iter().map(|momentum| momentum[axis]).sum::<f64>() / count);
    let squares = |about: [f64; 3]| {
        let square = |momentum: &[f64; 3]| (0..2).map(|axis| (momentum[axis] - about[axis]).powi(2)).sum::<f64>();
        momenta.iter().map(square).sum::<f64>()
    };
    let temperature = squares(bulk) / (2.0 * (count - 1.0));
    assert!((row.kinetic_temperature() / temperature - 1.0).abs() < 1e-5, "{row:?}, {temperature}");
    // Which is much less than what there is in the box.
    assert!(squares([0.0; 3]) / (2.0 * count) > 2.0 * temperature);
    for axis in 0..2 {
        assert!((row.centre_of_mass_velocity()[axis] - bulk[axis]).abs() < 1e-5 * bulk[0].abs());
    }
}

fn problems(text_changes: &[&str]) -> String {
    let text = r#"{
        "title": "test", "space": {"box": [5, 5, 5]}, "time": {"step": 0.01, "steps": 1}, "temperature": 0,
        "particles": [{"species": "A", "count": 2}],
        "interactions": [{"type": "coloured-noise", "strength": 2, "time": 0.05}]
    }"#;
    let changes: Vec<String> = text_changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", text, &changes) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

#[test]
fn what_cannot_be_computed_is_refused_with_the_reason() {
    assert_eq!(problems(&[]), "");
    let printed = problems(&["interactions.0.process=literal"]);
    assert!(printed.contains("interactions[0].process: found \"literal\" in 3 dimensions"), "{printed}");
    let fast = problems(&["interactions.0.time=0.000039"]);
    assert!(fast.contains("interactions[0].time: found 0.000039") && fast.contains("white noise"), "{fast}");
    assert_eq!(problems(&["interactions.0.time=0.0000390625"]), "", "exactly a 256th of a step");
    let long = problems(&["interactions.0.time=0.001", "time.steps=300000000"]);
    assert!(long.contains("time.steps: found 300000000") && long.contains("at most 214748364 "), "{long}");
    for wrong in ["interactions.0.time=0", "interactions.0.strength=-1", "interactions.0.process=cangaroo"] {
        assert_ne!(problems(&[wrong]), "", "{wrong}");
    }
}

#[test]
fn warnings_tell_of_the_printed_process_and_of_rounding() {
    let text =
        |scene: &Checked| -> String { mesoscope::families::warnings(scene).iter().map(ToString::to_string).collect() };
    assert!(!text(&gas(&[])).contains("interactions[1]"), "{}", text(&gas(&[])));
    let printed = text(&gas(&["interactions.1.process=literal"]));
    assert!(printed.contains("interactions[1].process") && printed.contains("no stationary state"), "{printed}");
    let weak = text(&gas(&["interactions.1.strength=1e-9"]));
    assert!(weak.contains("interactions[1].strength") && weak.contains("rounding"), "{weak}");
}

#[test]
fn two_couplings_to_noise_keep_their_own_random_numbers() {
    // With a Langevin bath in the same kernel, the jumps are those without it.
    let langevin = r#"interactions=[{"type": "coloured-noise", "strength": 2, "time": 0.05},
        {"type": "langevin", "friction": 1}]"#;
    for generator in ["noise.generator=pcg4d", "noise.generator=threefry2x32-20"] {
        let alone = free("kangaroo", &["particles.0.count=300", generator, "temperature=1"]);
        let both = free("kangaroo", &["particles.0.count=300", generator, "temperature=1", langevin]);
        let holds = |scene: &Checked| {
            let (_, _, mut engine) = run(scene);
            engine.advance(30, 30).unwrap();
            let state = engine.state().unwrap();
            (state.holds, state.momenta)
        };
        let (alone, both) = (holds(&alone), holds(&both));
        assert_eq!(alone.0, both.0);
        assert_ne!(alone.1, both.1);
    }
}

/// Temperatures of the gas over `time` after `settling`, sampled every half unit of time.
fn temperature(settling: f64, time: f64, time_step: f64, changes: &[&str]) -> Measured {
    let every = (0.5 / time_step).round() as u64;
    let step = format!("time.step={time_step}");
    let rate = format!("output.energies.every={every}");
    // Friction without noise of its own lets the gas form clusters: the list has to have room for them.
    let options = Options { list_growth: 3, ..Options::default() };
    let mut device = Device::with(&gas(&[&[step.as_str(), &rate], changes].concat()), options);
    device.step((settling / time_step / every as f64).ceil() as u64 * every);
    let rows = device.series(every, (time / 0.5) as u64);
    Measured::of(&rows.iter().map(mesoscope::measure::Observables::kinetic_temperature).collect::<Vec<_>>())
}

fn show(found: Measured) -> String {
    format!("{:.4} ± {:.4}", found.mean, found.error)
}

#[test]
#[ignore = "minutes"]
fn temperatures_of_the_processes() {
    println!("| process | T | expected |\n|-|-|-|");
    // The kangaroos keep a large force for long: the error of their temperature is that of few independent samples.
    for (process, time, expected, allowance, largest_error, time_step, duration) in [
        ("short", 0.039, 1.0, 0.01, 0.005, 0.01, 2400.0),
        ("short", 0.05, 1.27, 0.02, 0.01, 0.01, 1500.0),
        ("kangaroo", 0.05, 4.8, 0.3, 0.36, 0.002, 1000.0),
        ("kangaroo-exponential", 0.05, 8.6, 0.4, 0.48, 0.002, 1000.0),
    ] {
        let process_change = format!("interactions.1.process={process}");
        let time_change = format!("interactions.1.time={time}");
        let found = temperature(200.0, duration, time_step, &[&process_change, &time_change]);
        println!("| {process}, {time} | {} | {expected} ± {allowance} |", show(found));
        found.assert(process, expected, allowance, largest_error);
    }
}

#[test]
#[ignore = "minutes"]
fn temperature_along_the_line_of_the_paper() {
    println!("| α | γ | T |\n|-|-|-|");
    for strength in [1.0_f64, 2.0, 3.0, 6.0] {
        let friction = (strength / 5.23).powf(1.0 / 0.89);
        let changes = [
            "interactions.1.process=short".to_owned(),
            "interactions.1.time=0.039".to_owned(),
            format!("interactions.1.strength={strength}"),
            format!("interactions.0.friction={friction}"),
        ];
        let changes: Vec<&str> = changes.iter().map(String::as_str).collect();
        let found = temperature(150.0, 600.0, 0.01, &changes);
        println!("| {strength} | {friction:.4} | {} |", show(found));
        found.assert(&format!("strength {strength}"), 1.0, 0.05, 0.01);
    }
}

#[test]
#[ignore = "minutes"]
fn standard_dissipative_particles_beside_it() {
    let dpd = r#"interactions=[{"type": "dpd", "repulsion": 0, "friction": 0.5}]"#;
    let integrator = r#"integrator={"type": "splitting"}"#;
    let time_step = 0.01;
    let mut device = Device::new(&gas(&["time.step=0.01", "output.energies.every=50", integrator, dpd]));
    device.step(2000);
    let (mut temperatures, mut variances) = (Vec::new(), Vec::new());
    for _ in 0..600 {
        device.step((2.0 / time_step) as u64);
        temperatures.push(device.observe().kinetic_temperature());
        let reported = device.reported();
        let unit = gas(&[integrator, dpd]).model().units;
        let squares: Vec<f64> = reported
            .momenta
            .iter()
            .map(|units| unit.momentum(*units).iter().map(|component| component * component).sum())
            .collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        variances.push(squares.iter().map(|square| (square - mean).powi(2)).sum::<f64>() / squares.len() as f64);
    }
    let (temperature, variance) = (Measured::of(&temperatures), Measured::of(&variances));
    println!("DPD γ = 0.5: T {}, var(v²) {}", show(temperature), show(variance));
    temperature.assert("temperature", 1.001, 0.005, 0.004);
    variance.assert("variance of the squared velocity", 4.0, 0.1, 0.03);
}

#[test]
#[ignore = "minutes"]
fn accelerations_have_two_peaks_and_velocities_of_short_forces_are_gaussian() {
    for process in ["kangaroo", "short"] {
        let process_change = format!("interactions.1.process={process}");
        let scene = gas(&[&process_change, "time.step=0.005"]);
        let (model, _, mut engine) = run(&scene);
        engine.advance(20_000, 500).unwrap();
        let (mut accelerations, mut velocities) = (Vec::new(), Vec::new());
        for _ in 0..100 {
            engine.advance(99, 99).unwrap();
            engine.advance(1, 1).unwrap();
            let before = engine.reported().unwrap();
            engine.advance(1, 1).unwrap();
            let after = engine.reported().unwrap();
            for (new, old) in after.momenta.iter().zip(&before.momenta) {
                let [_, new, _] = model.units.momentum(*new);
                let [_, old, _] = model.units.momentum(*old);
                accelerations.push((new - old) / model.time_step);
                velocities.push(new);
            }
        }
        let moments = |values: &[f64]| {
            let count = values.len() as f64;
            let mean = values.iter().sum::<f64>() / count;
            let moment = |power| values.iter().map(|value| (value - mean).powi(power)).sum::<f64>() / count;
            (mean, moment(2).sqrt(), moment(4) / moment(2).powi(2))
        };
        let (mean, deviation, kurtosis) = moments(&accelerations);
        let mut bins = [0_u32; 61];
        for value in &accelerations {
            let bin = ((value - mean) / deviation * 10.0).round() + 30.0;
            if (0.0..61.0).contains(&bin) {
                bins[bin as usize] += 1;
            }
        }
        let peak = |range: std::ops::Range<usize>| {
            range.max_by_key(|bin| bins[*bin]).map(|bin| (bin as f64 - 30.0) / 10.0).unwrap()
        };
        let (low, high, valley) = (peak(0..30), peak(31..61), f64::from(bins[30]));
        let contrast = f64::from(bins[(high * 10.0) as usize + 30]) / valley;
        let (_, _, velocity_kurtosis) = moments(&velocities);
        println!(
            "{process}: acceleration peaks at {low} and {high} σ, {contrast:.2} times the density at 0, kurtosis \
             {kurtosis:.3}; velocity kurtosis {velocity_kurtosis:.3}"
        );
        assert!((low + 1.4).abs() < 0.11 && (high - 1.4).abs() < 0.11 && contrast > 1.5);
        if process == "short" {
            assert!((velocity_kurtosis - 3.0).abs() < 0.1, "{velocity_kurtosis}");
        } else {
            assert!(velocity_kurtosis > 4.0, "{velocity_kurtosis}");
        }
    }
}
