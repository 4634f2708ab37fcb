//! Closed forms of couplings and baths: the stationary law and the velocity autocorrelation of every scheme in discrete
//! time, from ensembles of independent oscillators and pairs in one run.
//!
//! The schemes of Cotter and Reich, doi:10.1209/epl/i2003-00621-8, are one family, s' = e s + λₑ(1+e)/2 Δh + noise. With one
//! linear coupling h = q, mass m and V = Kq²/2 its stationary law at any time step is Gaussian with, for B = λₑdt²/m and
//! W = Kdt²/m,
//!
//! ```text
//! ⟨p²⟩ = m kT       ⟨q²⟩ = (kT/K)(4-B)/(4-B-W)       ⟨s²⟩ = kTλₑ(4-W)/(4-B-W)       ⟨qs⟩ = kT B/(4-B-W)
//! ⟨qp⟩ = ⟨ps⟩ = 0   ⟨p²⟩ = 4m kT/(4-B-W) at half steps       stable for B + W < 4
//! ```
//! A mean is within four standard errors. These are at most half a per cent each, so that all four are 2 %, and at most a quarter in
//! tests that `make validate` runs, with four times as many oscillators: then all four are 1 %. Means are over oscillators, which do
//! not know of each other; what a run adds up over time it adds up for each of them.

use mesoscope::families::Model;
use mesoscope::families::reference::Reference;
use mesoscope::measure::Observables;
use mesoscope::plan::Options;
use mesoscope::scene::{self, Checked};
use mesoscope::state::{PairBath, Reported, State};

use crate::support::{
    Device, Implementation, Measured, changed, deviate, edited, fluid, largest_difference, oscillators, start,
};

/// Every implementation of couplings, at the start of a scene from a given state.
fn runs(scene: &Checked, state: &State) -> Vec<Box<dyn Implementation>> {
    let model = scene.model();
    let mut runs: Vec<Box<dyn Implementation>> = vec![Box::new(Reference::new(model.clone(), state.clone()))];
    runs.push(Box::new(Device::from_state(scene, state, Options::default())));
    runs
}

/// An ideal gas whose friction γ is relative to the flow of a sheared box keeps the linear profile. From the Langevin
/// equation of the peculiar velocity, du/dt = -γu - rate w + noise with the velocity w across the flow, follow ⟨uw⟩ =
/// -rate kT/2γ and ⟨u²⟩ = kT (1 + rate²/2γ²).
#[test]
fn friction_relative_to_the_flow_has_the_stress_of_a_langevin_gas() {
    let (rate, friction) = (1.5_f64, 2.0_f64);
    for integrator in ["splitting", "cotter-reich", "groot-warren"] {
        let scene = fluid(&[
            &format!(r#"integrator={{"type":"{integrator}"}}"#),
            &format!(r#"interactions=[{{"type":"langevin","friction":{friction}}}]"#),
            &format!(r#"space={{"box":[8,8,8],"shear":{{"rate":{rate},"gradient":"y"}}}}"#),
            r#"particles=[{"species":"A","count":3000}]"#,
            "time.step=0.05",
            "output.energies.every=10",
        ]);
        let model = scene.model();
        let shear = model.particles().shear.expect("shear");
        let mut device = Device::new(&scene);
        device.step(120);
        let (mut temperatures, mut stresses) = (Vec::new(), Vec::new());
        for _ in 0..60 {
            temperatures.push(device.observe().kinetic_temperature());
            let Reported { positions, momenta, .. } = device.reported();
            let product = |(position, momentum): (&[u32; 3], &[i32; 3])| {
                let flow = shear.flow(0, position[1], model);
                (f64::from(momentum[0]) - flow) * f64::from(momentum[1]) * model.units.momentum.powi(2)
            };
            stresses.push(positions.iter().zip(&momenta).map(product).sum::<f64>() / positions.len() as f64);
            device.step(20);
        }
        let kinetic = Measured::of(&temperatures);
        kinetic.assert(integrator, 1.0 + (rate / friction).powi(2) / 6.0, 0.005, 0.005);
        let stress = Measured::of(&stresses);
        stress.assert(&format!("{integrator}: stress"), -rate * 0.5 / friction, 0.005, 0.005);
    }
}

/// Friction of single particles that sees velocities predicted by λ leaves ⟨v²⟩ = (kT/m) 2/(2 + (2λ - 1) γdt/m).
#[test]
fn predicted_friction_of_particles_has_its_temperature() {
    for lambda in [0.3_f64, 0.65] {
        let scene = fluid(&[
            &format!(r#"integrator={{"type":"groot-warren","lambda":{lambda}}}"#),
            r#"interactions=[{"type":"langevin","friction":4}]"#,
            r#"particles=[{"species":"A","count":3000}]"#,
            "time.step=0.1",
            "output.energies.every=5",
        ]);
        let mut device = Device::new(&scene);
        device.step(60);
        let column: Vec<f64> = device.series(5, 600).iter().map(Observables::kinetic_temperature).collect();
        let expected = 2.0 / (2.0 + (2.0 * lambda - 1.0) * 0.4);
        Measured::of(&column).assert(&format!("lambda {lambda}"), expected, 0.002, 0.003);
    }
}

/// Kicks of a bath with memory in split steps keep the linear law, for O relaxes momenta where they are independent of
/// places and baths: ⟨p²⟩ = m kT and ⟨s²⟩ = kTλₑ(4-W)/(4-B-W), beside any friction of pairs.
#[test]
fn split_steps_keep_the_law_of_oscillators_with_memory() {
    let (time_step, rate, friction, stiffness) = (0.15_f64, 4.0, 5.0, 20.0);
    let (_, ratio) = family("cotter-reich", rate * time_step);
    let bath = ratio * rate * friction;
    let (strain, spring) = (bath * time_step * time_step, stiffness * time_step * time_step);
    let square = bath * (4.0 - spring) / (4.0 - strain - spring);
    for relaxation in ["mean-field", "two-stages"] {
        let scene = fluid(&[
            &format!(r#"integrator={{"type":"splitting","relaxation":"{relaxation}"}}"#),
            &format!(
                r#"interactions=[{{"type":"dpd","friction":0.2}},{{"type":"tether","stiffness":{stiffness}}},
                {{"type":"langevin","friction":{friction},"bath":{{"type":"memory","rate":{rate}}}}}]"#
            ),
            "space.box=[10,10,10]",
            r#"particles=[{"species":"A","count":3000}]"#,
            &format!("time.step={time_step}"),
            "output.energies.every=5",
        ]);
        let mut device = Device::new(&scene);
        device.step(60);
        let series = device.series(5, 600);
        let column = |value: fn(&Observables) -> f64| series.iter().map(value).collect::<Vec<f64>>();
        let kinetic = Measured::of(&column(Observables::kinetic_temperature));
        kinetic.assert(&format!("{relaxation}: kinetic temperature"), 1.0, 0.006, 0.004);
        let found = Measured::of(&column(|row| row.bath_square));
        found.assert(&format!("{relaxation}: bath"), square, 0.002 * square, 0.02);
    }
}

const SCHEMES: [&str; 3] = ["cotter-reich", "symmetric", "exponential"];

/// e and λₑ/λ of a scheme at a = αdt.
fn family(scheme: &str, a: f64) -> (f64, f64) {
    match scheme {
        "cotter-reich" => (1.0 / (1.0 + a), 1.0 / (1.0 + a / 2.0)),
        "symmetric" => ((1.0 - a / 2.0) / (1.0 + a / 2.0), 1.0),
        "exponential" => ((-a).exp(), (a / 2.0).tanh() / (a / 2.0)),
        _ => panic!("no scheme {scheme}"),
    }
}

/// Between walls a gas with memory is even and has its temperature. Where its baths take a drift that a wall has reflected for a straight one, there
/// are 15 % more particles at the walls, and kT is .974.
#[test]
fn a_gas_with_memory_between_walls_is_even() {
    let scene = fluid(&[
        r#"integrator={"type":"cotter-reich"}"#,
        r#"interactions=[{"type":"langevin","friction":2,"bath":{"type":"memory","rate":3}}]"#,
        r#"space={"box":[6,6,4],"walls":{"z":{}}}"#,
        r#"particles=[{"species":"A","count":3000}]"#,
        "time.step=0.1",
        "output.energies.every=50",
    ]);
    let units = scene.model().units;
    let mut device = Device::new(&scene);
    device.step(300);
    let (mut temperatures, mut squares) = (Vec::new(), Vec::new());
    for _ in 0..40 {
        device.step(50);
        temperatures.push(device.observe().kinetic_temperature());
        let positions = device.reported().positions;
        let from_middle = positions.iter().map(|place| (units.position(*place)[2] / 2.0 - 1.0).powi(2));
        squares.push(from_middle.sum::<f64>() / positions.len() as f64);
    }
    Measured::of(&temperatures).assert("temperature", 1.005, 0.002, 0.003);
    // 1/3, and .3 % less for the density of .983 at the walls.
    Measured::of(&squares).assert("squared distance from the middle", 0.3325, 0.001, 0.001);
}

/// One linear coupling in discrete time.
#[derive(Debug, Clone, Copy)]
struct Linear {
    mass: f64,
    temperature: f64,
    time_step: f64,
    persistence: f64,
    /// B.
    bath: f64,
    /// W.
    spring: f64,
}

impl Linear {
    fn coupling(&self) -> f64 {
        self.bath * self.mass / self.time_step.powi(2)
    }

    fn stiffness(&self) -> f64 {
        self.spring * self.mass / self.time_step.powi(2)
    }

    fn margin(&self) -> f64 {
        4.0 - self.bath - self.spring
    }

    fn momentum_square(&self) -> f64 {
        self.mass * self.temperature
    }

    fn half_step_square(&self) -> f64 {
        4.0 * self.mass * self.temperature / self.margin()
    }

    fn position_square(&self) -> f64 {
        self.temperature / self.stiffness() * (4.0 - self.bath) / self.margin()
    }

    fn bath_square(&self) -> f64 {
        self.temperature * self.coupling() * (4.0 - self.spring) / self.margin()
    }

    fn position_bath(&self) -> f64 {
        self.temperature * self.bath / self.margin()
    }

    /// q, p and s of oscillator `index` from the stationary law; without a spring q is zero.
    fn draw(&self, index: u32) -> [f64; 3] {
        let [a, b, c] = [0, 1, 2].map(|number| deviate(7, [index, number]));
        let p = self.momentum_square().sqrt() * a;
        if self.spring == 0.0 {
            return [0.0, p, self.bath_square().sqrt() * c];
        }
        let q = self.position_square().sqrt() * b;
        let slope = self.position_bath() / self.position_square();
        let rest = self.bath_square() - slope * self.position_bath();
        [q, p, slope * q + rest.sqrt() * c]
    }

    /// ⟨p(0)p(n)⟩/⟨p²⟩ of the free coupling for n up to `most`.
    fn autocorrelation(&self, most: usize) -> Vec<f64> {
        assert_eq!(self.spring, 0.0);
        let e = self.persistence;
        let g = self.bath * (1.0 + e) / 2.0;
        let mut correlation = vec![1.0, 1.0 - g / 2.0];
        while correlation.len() <= most {
            let [before, now] = [correlation[correlation.len() - 2], correlation[correlation.len() - 1]];
            correlation.push((1.0 + e - g) * now - e * before);
        }
        correlation
    }
}

/// A scene of oscillators and its law: α dt and B and W decide everything else.
fn oscillator(scheme: &str, a: f64, bath: f64, spring: f64, count: usize) -> (Checked, Linear) {
    let (persistence, factor) = family(scheme, a);
    let law = Linear { mass: 2.0, temperature: 1.5, time_step: 0.1, persistence, bath, spring };
    let scene = oscillators(&[
        &format!("particles.0.count={count}"),
        &format!("interactions.0.bath.rate={}", a / law.time_step),
        &format!("interactions.0.bath.coupling={}", law.coupling() / factor),
        &format!("interactions.0.bath.scheme=\"{scheme}\""),
        &format!("interactions.1.stiffness={}", law.stiffness()),
    ]);
    (scene, law)
}

/// Where the spring of a particle ends; the origin for one without a spring.
fn rest_of(state: &State, id: usize) -> [u32; 3] {
    state.tethers.get(id).copied().unwrap_or_default()
}

/// Puts all oscillators of a state into the stationary law.
fn settle(state: &mut State, model: &Model, law: &Linear) {
    for id in 0..state.len() {
        for axis in 0..model.units.dimension {
            let [q, p, s] = law.draw((3 * id + axis) as u32);
            let units = q / model.units.lengths[axis] * 4_294_967_296.0;
            state.positions[id][axis] = rest_of(state, id)[axis].wrapping_add(units.round() as i64 as u32);
            state.momenta[id][axis] = (p / model.units.momentum).round() as i32;
            if let Some(bath) = state.position_baths.get_mut(id) {
                bath[axis] = (s as f32).to_bits();
            }
        }
    }
}

/// q, p, s and the half-step p of every degree of freedom at the current step, which ends with this.
type Coordinates = dyn Fn(&Model, &Reported, &State) -> Vec<[f64; 4]>;

/// The coordinates of particles on tethers, from the state at the report point and the one a step later, which has s.
fn coordinates_of_oscillators(model: &Model, reported: &Reported, after: &State) -> Vec<[f64; 4]> {
    let particle = |id: usize| {
        let q = model.units.displacement(reported.positions[id], rest_of(after, id));
        let p = model.units.momentum(reported.momenta[id]);
        let half = model.units.momentum(after.momenta[id]);
        let s = after.position_baths.get(id).map_or([0.0; 3], |bath| bath.map(|bits| f64::from(f32::from_bits(bits))));
        (0..model.units.dimension).map(move |axis| [q[axis], p[axis], s[axis], half[axis]])
    };
    (0..reported.len()).flat_map(particle).collect()
}

/// Second moments against the law, over `samples` samples `every` steps apart.
fn check_law(
    what: &str,
    scene: &Checked,
    run: &mut dyn Implementation,
    law: &Linear,
    coordinates: &Coordinates,
    [samples, every]: [u64; 2],
    largest_error: f64,
) {
    let model = scene.model();
    let mut sums: Vec<[f64; 7]> = Vec::new();
    for _ in 0..samples {
        let reported = run.reported();
        run.step(1);
        let found = coordinates(model, &reported, &run.state());
        sums.resize(found.len(), [0.0; 7]);
        for (sum, [q, p, s, half]) in sums.iter_mut().zip(found) {
            for (sum, term) in sum.iter_mut().zip([p * p, q * q, s * s, q * s, q * p, p * s, half * half]) {
                *sum += term / samples as f64;
            }
        }
        run.step(every - 1);
    }
    let [p2, q2, s2] = [law.momentum_square(), law.position_square(), law.bath_square()];
    let expected = [
        ("⟨p²⟩", p2, p2),
        ("⟨q²⟩", q2, q2),
        ("⟨s²⟩", s2, s2),
        ("⟨qs⟩", law.position_bath(), (q2 * s2).sqrt()),
        ("⟨qp⟩", 0.0, (q2 * p2).sqrt()),
        ("⟨ps⟩", 0.0, (p2 * s2).sqrt()),
        ("half-step ⟨p²⟩", law.half_step_square(), law.half_step_square()),
    ];
    for (index, (name, value, scale)) in expected.into_iter().enumerate() {
        if law.bath > 0.0 || !name.contains('s') || name.starts_with('h') {
            let numbers: Vec<f64> = sums.iter().map(|sum| sum[index] / scale).collect();
            Measured::of_independent(&numbers).assert(
                &format!("{what} {name}, {}", run.name()),
                value / scale,
                0.0,
                largest_error,
            );
        }
    }
}

/// How well the means of an ensemble are to be known: four standard errors are 2 % or 1 %.
#[derive(Debug, Clone, Copy)]
enum Precision {
    TwoPerCent,
    OnePerCent,
}

impl Precision {
    /// The largest standard error.
    fn largest_error(self) -> f64 {
        match self {
            Self::TwoPerCent => 0.005,
            Self::OnePerCent => 0.0025,
        }
    }

    /// The size of an ensemble, from that for 1 %.
    fn of(self, count: usize) -> usize {
        match self {
            Self::TwoPerCent => count / 4,
            Self::OnePerCent => count,
        }
    }
}

#[test]
fn oscillators_reach_the_stationary_law() {
    check_way_to_the_stationary_law(Precision::TwoPerCent);
}

#[test]
#[ignore = "a minute"]
fn oscillators_reach_the_stationary_law_within_one_per_cent() {
    check_way_to_the_stationary_law(Precision::OnePerCent);
}

fn check_way_to_the_stationary_law(precision: Precision) {
    for scheme in SCHEMES {
        for a in [0.1, 1.0, 10.0] {
            let count = precision.of(if a < 1.0 { 32_000 } else { 20_000 });
            let (scene, law) = oscillator(scheme, a, 2.0, 1.0, count);
            // From the ends of the tethers, with 2% of any deviation left at most.
            let (_, state) = start(&scene);
            for mut run in runs(&scene, &state) {
                run.step(120);
                let what = format!("{scheme} {a}");
                let error = precision.largest_error();
                check_law(&what, &scene, run.as_mut(), &law, &coordinates_of_oscillators, [8, 12], error);
            }
        }
    }
}

#[test]
fn oscillators_keep_the_stationary_law() {
    check_keeping_of_the_stationary_law(Precision::TwoPerCent);
}

#[test]
#[ignore = "a minute"]
fn oscillators_keep_the_stationary_law_within_one_per_cent() {
    check_keeping_of_the_stationary_law(Precision::OnePerCent);
}

/// A bath of αdt = 10⁻³ forgets in thousands of steps, and the symmetric one of 10³ flips its sign for hundreds: there the
/// law is kept, once it is reached.
fn check_keeping_of_the_stationary_law(precision: Precision) {
    for scheme in SCHEMES {
        for a in [1e-3, 1e3] {
            let (scene, law) = oscillator(scheme, a, 2.0, 1.0, precision.of(110_000));
            let (model, mut state) = start(&scene);
            settle(&mut state, &model, &law);
            for mut run in runs(&scene, &state) {
                let what = format!("{scheme} {a}");
                let error = precision.largest_error();
                check_law(&what, &scene, run.as_mut(), &law, &coordinates_of_oscillators, [3, 25], error);
            }
        }
    }
}

/// Particles joined in pairs by springs without a length, each with its own baths: the mode in which they move against each other
/// is an oscillator of twice the stiffness.
#[test]
fn pairs_on_springs_reach_the_stationary_law_of_their_mode() {
    for scheme in SCHEMES {
        let (persistence, factor) = family(scheme, 1.0);
        let law = Linear { mass: 2.0, temperature: 1.5, time_step: 0.1, persistence, bath: 1.5, spring: 1.5 };
        let scene = oscillators(&[
            "particles.0.count=10000",
            "particles.0.chain={\"beads\":2,\"spacing\":0.1}",
            "interactions.0.bath.rate=10",
            &format!("interactions.0.bath.coupling={}", law.coupling() / factor),
            &format!("interactions.0.bath.scheme=\"{scheme}\""),
            &format!(
                "interactions.1={{\"type\":\"bonds\",\"potential\":{{\"type\":\"harmonic\",\"stiffness\":{}}}}}",
                0.5 * law.stiffness()
            ),
        ]);
        let (_, state) = start(&scene);
        for mut run in runs(&scene, &state) {
            run.step(120);
            let error = Precision::TwoPerCent.largest_error();
            let what = format!("{scheme}, pairs");
            check_law(&what, &scene, run.as_mut(), &law, &coordinates_of_pairs, [8, 12], error);
        }
    }
}

/// The coordinates in which two particles in a row move against each other.
fn coordinates_of_pairs(model: &Model, reported: &Reported, after: &State) -> Vec<[f64; 4]> {
    let against = |values: [f64; 2]| (values[1] - values[0]) * 0.5_f64.sqrt();
    let pair = |first: usize| {
        let apart = model.units.displacement(reported.positions[first + 1], reported.positions[first]);
        let momenta = |momenta: &[[i32; 3]]| {
            let [a, b] = [first, first + 1].map(|id| model.units.momentum(momenta[id]));
            std::array::from_fn::<f64, 3, _>(|axis| against([a[axis], b[axis]]))
        };
        let (p, half) = (momenta(&reported.momenta), momenta(&after.momenta));
        let bath = |id: usize| after.position_baths[id].map(|bits| f64::from(f32::from_bits(bits)));
        let (a, b) = (bath(first), bath(first + 1));
        (0..3).map(move |axis| [apart[axis] * 0.5_f64.sqrt(), p[axis], against([a[axis], b[axis]]), half[axis]])
    };
    (0..reported.len()).step_by(2).flat_map(pair).collect()
}

#[test]
fn a_free_bath_has_the_discrete_velocity_autocorrelation() {
    check_velocity_autocorrelation(Precision::TwoPerCent);
}

#[test]
#[ignore = "a minute"]
fn a_free_bath_has_the_discrete_velocity_autocorrelation_within_one_per_cent() {
    check_velocity_autocorrelation(Precision::OnePerCent);
}

fn check_velocity_autocorrelation(precision: Precision) {
    for scheme in SCHEMES {
        for a in [1e-3, 1.0, 1e3] {
            // Others than slow baths, and the symmetric one that flips its sign, have forgotten all by then.
            let lags = if a < 1.0 || scheme == "symmetric" && a > 1.0 { 50 } else { 20 };
            let (scene, law) = oscillator(scheme, a, 1.5, 0.0, precision.of(55_000));
            let (model, mut state) = start(&scene);
            settle(&mut state, &model, &law);
            let expected = law.autocorrelation(lags);
            for mut run in runs(&scene, &state) {
                let momenta = |momenta: Vec<[i32; 3]>| -> Vec<f64> {
                    momenta.iter().flatten().map(|units| f64::from(*units)).collect()
                };
                let first = momenta(run.reported().momenta);
                let squares: f64 = first.iter().map(|p| p * p).sum();
                run.step(1);
                let mut before = momenta(run.state().momenta);
                for (lag, expected) in expected.iter().enumerate().skip(1) {
                    run.step(1);
                    // A half kick closes a step and opens the next: p(n) is the mean of the half steps around it.
                    let after = momenta(run.state().momenta);
                    let now: Vec<f64> =
                        before.iter().zip(&after).map(|(before, after)| 0.5 * (before + after)).collect();
                    before = after;
                    let products: f64 = first.iter().zip(&now).map(|(a, b)| a * b).sum();
                    let found = products / squares;
                    // The error of a slope of regression between two Gaussian numbers of equal width.
                    let error = ((1.0 - expected * expected) / first.len() as f64).sqrt();
                    assert!(error <= precision.largest_error());
                    // Rounding of single precision in fifty steps.
                    let tolerance = 4.0 * error + 1e-4;
                    assert!(
                        (found - expected).abs() <= tolerance,
                        "{scheme} {a}, {}, lag {lag}: {found}, expected {expected} ± {tolerance}",
                        run.name()
                    );
                }
            }
        }
    }
}

/// Observables against the coordinates they are sums of.
#[test]
fn observables_are_sums_over_oscillators() {
    let (scene, law) = oscillator("cotter-reich", 1.0, 2.0, 1.0, 2000);
    let scene = edited(&scene, |scene| scene.output.energies.every = 30);
    let (model, state) = start(&scene);
    for mut run in runs(&scene, &state) {
        run.step(30);
        let observed = run.observe();
        let reported = run.reported();
        run.step(1);
        let found = coordinates_of_oscillators(&model, &reported, &run.state());
        let mean = |index: usize| found.iter().map(|c| c[index] * c[index]).sum::<f64>() / found.len() as f64;
        let count = found.len() as f64;
        let stiffness = law.stiffness();
        let continuous = law.coupling() / family("cotter-reich", 1.0).1;
        for (name, value, expected) in [
            ("kinetic energy", observed.kinetic_energy, 0.5 * count * mean(1) / law.mass),
            ("temperature", observed.kinetic_temperature(), mean(1) / law.mass),
            ("potential energy", observed.potential_energy, 0.5 * count * stiffness * mean(0)),
            ("configurational temperature", observed.configurational_temperature(), stiffness * mean(0)),
            ("bath square", observed.bath_square, mean(2)),
            ("bath energy", observed.bath_energy, 0.5 * count * mean(2) / continuous),
        ] {
            assert!((value / expected - 1.0).abs() < 2e-4, "{name}, {}: {value}, expected {expected}", run.name());
        }
        let product = |a: usize, b: usize| found.iter().map(|c| c[a] * c[b]).sum::<f64>() / found.len() as f64;
        for (name, value, [a, b]) in [
            ("bath times momentum", observed.bath_products.momentum, [2, 1]),
            ("bath times displacement", observed.bath_products.displacement, [2, 0]),
            ("momentum times displacement", observed.bath_products.momentum_displacement, [1, 0]),
        ] {
            let (expected, scale) = (product(a, b), (mean(a) * mean(b)).sqrt());
            assert!((value - expected).abs() < 2e-4 * scale, "{name}, {}: {value}, expected {expected}", run.name());
        }
    }
}

#[test]
fn white_baths_keep_their_temperature() {
    check_white_baths(Precision::TwoPerCent);
}

#[test]
#[ignore = "seconds"]
fn white_baths_keep_their_temperature_within_one_per_cent() {
    check_white_baths(Precision::OnePerCent);
}

fn check_white_baths(precision: Precision) {
    // B = 2γdt/m, e = 0; the spring is as stiff as before.
    let law = Linear { mass: 2.0, temperature: 1.5, time_step: 0.1, persistence: 0.0, bath: 2.0, spring: 1.0 };
    let friction = law.bath * law.mass / (2.0 * law.time_step);
    let scene = oscillators(&[
        &format!("particles.0.count={}", precision.of(20_000)),
        r#"interactions.0.bath={"type":"white"}"#,
        &format!("interactions.0.friction={friction}"),
        &format!("interactions.1.stiffness={}", law.stiffness()),
    ]);
    let (_, state) = start(&scene);
    assert!(state.position_baths.is_empty());
    for mut run in runs(&scene, &state) {
        run.step(60);
        // The bath variable is not kept: its own moments are those of a memory that is as short.
        let model = scene.model();
        let mut sums: Vec<[f64; 3]> = Vec::new();
        for _ in 0..8 {
            let reported = run.reported();
            run.step(1);
            let found = coordinates_of_oscillators(model, &reported, &run.state());
            sums.resize(found.len(), [0.0; 3]);
            for (sum, [q, p, _, half]) in sums.iter_mut().zip(found) {
                for (sum, term) in sum.iter_mut().zip([p * p, q * q, half * half]) {
                    *sum += term / 8.0;
                }
            }
            run.step(9);
        }
        let values = [law.momentum_square(), law.position_square(), law.half_step_square()];
        for (index, value) in values.into_iter().enumerate() {
            let numbers: Vec<f64> = sums.iter().map(|sum| sum[index] / value).collect();
            let what = format!("white, moment {index}, {}", run.name());
            Measured::of_independent(&numbers).assert(&what, 1.0, 0.0, precision.largest_error());
        }
    }
}

/// Just inside B + W = 4 a cold oscillator stays within bounds, just outside it grows without any.
#[test]
fn stability_ends_where_b_and_w_add_up_to_four() {
    const STEPS: u64 = 400;
    for scheme in SCHEMES {
        for (a, spring) in [(0.01, 2.0), (1.0, 0.5)] {
            for (edge, stable) in [(3.96, true), (4.04, false)] {
                let (scene, law) = oscillator(scheme, a, 3.9 - spring, spring, 4);
                // A scene that is certainly unstable is refused: the spring is made stiffer afterwards.
                let stiffer = Linear { spring: spring + edge - 3.9, ..law };
                let scene = edited(&scene, |scene| {
                    scene.temperature = 0.0;
                    scene.system.interactions_mut().unwrap()[1] =
                        scene::Interaction::Tether(scene::TetherInteraction { stiffness: stiffer.stiffness() });
                    scene.particles[0].velocities =
                        scene::Velocities::Listed { velocities: vec![vec![1.0, -0.7, 0.4]; 4] };
                });
                let (model, mut state) = start(&scene);
                // Slow beside what the unit of momentum was made for, so that there is room to grow.
                for momentum in state.momenta.iter_mut().flatten() {
                    *momentum /= 32;
                }
                for mut run in runs(&scene, &state) {
                    let mut largest = f64::INFINITY;
                    if run.attempt(STEPS) {
                        let momenta = run.state().momenta;
                        let along = momenta.iter().map(|momentum| 16.0 * model.units.momentum(*momentum)[0].abs());
                        largest = along.fold(0.0, f64::max);
                    }
                    // Inside, a mode is at most 1/√(1 - 3.96/4) = 10 times as large as its start, which is 1 here.
                    let what = format!("{scheme} {a}, {}: {largest} at B + W = {edge}", run.name());
                    assert!(if stable { largest < 20.0 } else { largest > 100.0 }, "{what}");
                }
            }
        }
    }
}

/// A bath that never forgets conserves E + Σs²/2λ as well as a symplectic scheme conserves energy: to second order in
/// the step, without drift.
#[test]
fn a_bath_that_never_forgets_conserves_the_extended_energy() {
    for scheme in SCHEMES {
        let mut errors = Vec::new();
        for halving in 0..2 {
            let scene = oscillators(&[
                "time.step=0.02",
                &format!("time.step={}", 0.02 / f64::from(1 << halving)),
                "interactions.0.bath.rate=0",
                &format!("interactions.0.bath.scheme=\"{scheme}\""),
                "particles.0.count=200",
                "output.energies.every=25",
            ]);
            let (_, state) = start(&scene);
            for (index, mut run) in runs(&scene, &state).into_iter().enumerate() {
                let energy = |run: &mut dyn Implementation| {
                    let observed = run.observe();
                    observed.total_energy() + observed.bath_energy
                };
                let first = energy(run.as_mut());
                let mut largest = [0.0_f64; 2];
                for sample in 0..16 {
                    run.step(25 << halving);
                    let error = (energy(run.as_mut()) / first - 1.0).abs();
                    largest[sample / 8] = largest[sample / 8].max(error);
                }
                let name = run.name();
                // No drift: the second half of the run is no worse than the first.
                assert!(largest[1] < 1.5 * largest[0], "{scheme}, {name}: {largest:?}");
                assert!(largest[0] < 3e-3 && largest[0] > 1e-6, "{scheme}, {name}: {largest:?}");
                if halving == 0 {
                    errors.push(largest[0]);
                } else {
                    let ratio = errors[index] / largest[0];
                    assert!((3.0..5.5).contains(&ratio), "{scheme}, {name}: half the step divides errors by {ratio}");
                }
            }
        }
    }
}

/// Pairs of masses 1 and 3 on a line, bonded.
fn dimers(count: usize, law: &Linear, bond: &str) -> Checked {
    assert_eq!(law.mass, 0.75, "the reduced mass");
    let pairs: Vec<[usize; 2]> = (0..count).map(|index| [index, count + index]).collect();
    let text = format!(
        r#"{{
        "title": "test", "space": {{"box": [128]}}, "time": {{"step": {}, "steps": 1}}, "temperature": {},
        "particles": [{{"species": "A", "count": {count}, "mass": 1}}, {{"species": "B", "count": {count}, "mass": 3}}],
        "interactions": [{{"type": "bonds", "pairs": {pairs:?}, {bond}}}],
        "output": {{"energies": {{"every": 1000000}}}}
    }}"#,
        law.time_step, law.temperature
    );
    crate::support::scene(&text)
}

/// Length at rest of the dimers: far from zero, where |r| would not be linear.
const LENGTH: f64 = 32.0;

/// Puts all dimers into the stationary law, with their centres of mass at rest.
fn settle_dimers(state: &mut State, model: &Model, law: &Linear) {
    let count = state.len() / 2;
    for index in 0..count {
        let [q, p, s] = law.draw(index as u32);
        let units = (LENGTH + q) / model.units.lengths[0] * 4_294_967_296.0;
        state.positions[index][0] = state.positions[count + index][0].wrapping_add(units.round() as u32);
        state.momenta[index][0] = (p / model.units.momentum).round() as i32;
        state.momenta[count + index][0] = -state.momenta[index][0];
        if let Some(bath) = state.bond_baths.get_mut(index) {
            *bath = (s as f32).to_bits();
        }
    }
}

fn coordinates_of_dimers(model: &Model, reported: &Reported, after: &State) -> Vec<[f64; 4]> {
    let count = reported.len() / 2;
    let relative = |momenta: &[[i32; 3]], index: usize| {
        let [first, second] = [index, count + index].map(|id| model.units.momentum(momenta[id])[0]);
        (3.0 * first - second) / 4.0
    };
    let dimer = |index: usize| {
        let r = model.units.displacement(reported.positions[index], reported.positions[count + index])[0];
        let s = after.bond_baths.get(index).map_or(0.0, |bits| f64::from(f32::from_bits(*bits)));
        [r - LENGTH, relative(&reported.momenta, index), s, relative(&after.momenta, index)]
    };
    (0..count).map(dimer).collect()
}

#[test]
fn bonds_keep_the_stationary_law_of_their_reduced_mass() {
    check_bonds(Precision::TwoPerCent);
}

#[test]
#[ignore = "half a minute"]
fn bonds_keep_the_stationary_law_of_their_reduced_mass_within_one_per_cent() {
    check_bonds(Precision::OnePerCent);
}

fn check_bonds(precision: Precision) {
    for (scheme, a) in [("cotter-reich", 0.5), ("cotter-reich", 5.0), ("symmetric", 1.0), ("exponential", 1.0)] {
        let (persistence, factor) = family(scheme, a);
        let law = Linear { mass: 0.75, temperature: 1.5, time_step: 0.1, persistence, bath: 2.0, spring: 1.0 };
        let scene = dimers(
            precision.of(40_000),
            &law,
            &format!(
                r#""potential": {{"type": "harmonic", "stiffness": {}, "length": {LENGTH}}},
                "bath": {{"type": "memory", "rate": {}, "coupling": {}, "scheme": "{scheme}"}}"#,
                law.stiffness(),
                a / law.time_step,
                law.coupling() / factor
            ),
        );
        let (model, mut state) = start(&scene);
        settle_dimers(&mut state, &model, &law);
        for mut run in runs(&scene, &state) {
            let what = format!("bond {scheme} {a}");
            let error = precision.largest_error();
            check_law(&what, &scene, run.as_mut(), &law, &coordinates_of_dimers, [12, 8], error);
            assert_eq!(run.state().total_momentum(), [0; 3], "{}", run.name());
        }
    }
}

/// ⟨Δr²⟩ grows by 2D a time with D = kTα/λ, after a constant that is left behind at the start: velocities are forgotten by √e in a
/// step at least, and so by a thousand in twenty.
#[test]
fn a_free_bond_diffuses_as_its_friction_says() {
    const FRAMES: usize = 12;
    const STEPS: u64 = 20;
    for scheme in SCHEMES {
        let a = 1.0;
        let (persistence, factor) = family(scheme, a);
        let law = Linear { mass: 0.75, temperature: 1.5, time_step: 0.1, persistence, bath: 1.0, spring: 0.0 };
        let coupling = law.coupling() / factor;
        let scene = dimers(
            10_000,
            &law,
            &format!(
                r#""bath": {{"type": "memory", "rate": {}, "coupling": {coupling}, "scheme": "{scheme}"}}"#,
                a / law.time_step
            ),
        );
        let (model, mut state) = start(&scene);
        settle_dimers(&mut state, &model, &law);
        let expected = law.temperature * (a / law.time_step) / coupling;
        for mut run in runs(&scene, &state) {
            let count = state.len() / 2;
            let lengths = |state: &State| -> Vec<f64> {
                let length =
                    |index| model.units.displacement(state.positions[index], state.positions[count + index])[0];
                (0..count).map(length).collect()
            };
            let frames: Vec<Vec<f64>> = (0..=FRAMES)
                .map(|frame| {
                    run.step(if frame == 0 { 0 } else { STEPS });
                    lengths(&run.state())
                })
                .collect();
            // Stretches of two frames, minus those of one.
            let time = 2.0 * STEPS as f64 * law.time_step;
            let rates: Vec<f64> = (0..count)
                .map(|index| {
                    let mean = |length: usize| {
                        let squares = frames.iter().zip(&frames[length..]);
                        let sum: f64 = squares.map(|(from, to)| (to[index] - from[index]).powi(2)).sum();
                        sum / (FRAMES + 1 - length) as f64
                    };
                    (mean(2) - mean(1)) / time / expected
                })
                .collect();
            let what = format!("diffusion {scheme}, {}", run.name());
            Measured::of_independent(&rates).assert(&what, 1.0, 0.0, 0.01);
        }
    }
}

/// Pairs on a line, each far from the others, that a weak spring keeps within the range of a friction of weight 1: then
/// φ = r - rc, and a pair is one linear coupling.
fn touching_pairs(count: usize, changes: &[&str]) -> (Checked, State) {
    let pairs: Vec<[usize; 2]> = (0..count).map(|index| [index, count + index]).collect();
    let text = format!(
        r#"{{
        "title": "test", "space": {{"box": [{}]}}, "time": {{"step": 0.1, "steps": 1}}, "temperature": 1.5,
        "particles": [{{"species": "A", "count": {}, "mass": 2}}],
        "interactions": [{{"type": "dpd", "cutoff": 4, "weight_exponent": 0, "skin": 0.3}},
            {{"type": "bonds", "pairs": {pairs:?}, "potential": {{"type": "harmonic", "stiffness": 50, "length": 2}}}}],
        "noise": {{"distribution": "gaussian"}}, "output": {{"energies": {{"every": 1000000}}}}
    }}"#,
        8 * count,
        2 * count
    );
    let scene = changed(&text, changes);
    let (model, mut state) = start(&scene);
    for index in 0..count {
        let p = (1.5_f64).sqrt() * deviate(8, [index as u32, 0]);
        state.momenta[index][0] = (p / model.units.momentum).round() as i32;
        state.momenta[count + index][0] = -state.momenta[index][0];
        let q = 0.2 * deviate(8, [index as u32, 1]);
        let place = 8.0 * index as f64 + 4.0;
        state.positions[index] = model.units.fraction([place, 0.0, 0.0]);
        state.positions[count + index] = model.units.fraction([place - 2.0 - q, 0.0, 0.0]);
    }
    (scene, state)
}

/// Holds listed pairs to the law of one linear coupling, on the device alone where there are many.
fn check_pairs(precision: Precision) {
    let count = precision.of(48_000);
    for (scheme, a) in [("cotter-reich", 0.3), ("symmetric", 1.5), ("exponential", 1.0)] {
        let (persistence, factor) = family(scheme, a);
        let law = Linear { mass: 1.0, temperature: 1.5, time_step: 0.1, persistence, bath: 1.0, spring: 0.5 };
        let (scene, state) = touching_pairs(
            count,
            &[&format!(
                r#"interactions.0.bath={{"type":"memory","rate":{},"coupling":{},"scheme":"{scheme}"}}"#,
                a / law.time_step,
                law.coupling() / factor
            )],
        );
        let response = law.coupling() * (1.0 + persistence) / 2.0;
        let coordinates = move |model: &Model, reported: &Reported, after: &State| -> Vec<[f64; 4]> {
            let count = reported.len() / 2;
            let pair = |(index, bath): (usize, &PairBath)| {
                assert_eq!([bath.first as usize, bath.second as usize], [index, count + index]);
                let r = model.units.displacement(reported.positions[index], reported.positions[count + index])[0];
                // What is kept is e s - λₑ(1+e)/2 φ.
                let kept = f64::from(f32::from_bits(bath.memory));
                let s = (kept + response * (r - 4.0)) / persistence;
                let momentum = |momenta: &[[i32; 3]]| model.units.momentum(momenta[index])[0];
                [r - 2.0, momentum(&reported.momenta), s, momentum(&after.momenta)]
            };
            after.pair_baths.iter().enumerate().map(pair).collect()
        };
        let mut both = runs(&scene, &state);
        if count > 20_000 {
            both.retain(|run| run.name() != "reference");
        }
        for mut run in both {
            run.step(60);
            let what = format!("pairs {scheme} {a}");
            check_law(&what, &scene, run.as_mut(), &law, &coordinates, [12, 8], precision.largest_error());
            assert_eq!(run.state().total_momentum(), [0; 3], "{what}");
        }
    }
}

#[test]
fn pairs_with_memory_reach_the_stationary_law() {
    check_pairs(Precision::TwoPerCent);
}

#[test]
#[ignore = "a minute on a software adapter: run by `make validate`"]
fn pairs_with_memory_reach_the_stationary_law_within_one_per_cent() {
    check_pairs(Precision::OnePerCent);
}

/// ⟨v²⟩ = (kT/m) 2/(2 + (2λ - 1)(γdt/m + Kdt²/m)) for Groot and Warren's λ, and kT/m for the discrete gradient.
#[test]
fn white_pairs_have_the_temperature_of_their_integrator() {
    let (friction, time_step, stiffness) = (4.0, 0.1, 50.0);
    let factor: f64 = friction * time_step + stiffness * time_step * time_step;
    let warren = |lambda: f64| 2.0 / (2.0 + (2.0 * lambda - 1.0) * factor);
    for (integrator, expected) in [
        (r#"{"type":"cotter-reich"}"#.to_owned(), 1.0),
        (r#"{"type":"groot-warren"}"#.to_owned(), 1.0),
        (r#"{"type":"groot-warren","lambda":0.65}"#.to_owned(), warren(0.65)),
        (r#"{"type":"groot-warren","lambda":0.3}"#.to_owned(), warren(0.3)),
    ] {
        let (scene, state) = touching_pairs(
            7000,
            &[&format!("interactions.0.friction={friction}"), &format!("integrator={integrator}")],
        );
        let model = scene.model();
        for mut run in runs(&scene, &state) {
            run.step(60);
            let count = state.len() / 2;
            let mut squares = vec![0.0; count];
            for _ in 0..20 {
                let reported = run.reported();
                for (square, momentum) in squares.iter_mut().zip(&reported.momenta) {
                    *square += model.units.momentum(*momentum)[0].powi(2) / 1.5 / 20.0;
                }
                run.step(6);
            }
            let what = format!("{integrator}, {}", run.name());
            Measured::of_independent(&squares).assert(&what, expected, 0.0, 0.005);
        }
    }
}

/// A memory much shorter than the step is none: pairs, bonds and particles then move as under white noise of the same
/// random words, but for what single precision loses of bath variables. The noise of white pairs has the other sign, so
/// that pairs have none here.
#[test]
fn a_fast_bath_is_white_noise() {
    let scene = |bath: &str| {
        let text = format!(
            r#"{{
            "title": "test", "space": {{"box": [5, 5, 5]}}, "time": {{"step": 0.02, "steps": 1}}, "temperature": 1.0,
            "integrator": {{"type": "cotter-reich"}},
            "particles": [{{"species": "A", "count": 300}}], "noise": {{"distribution": "gaussian"}},
            "interactions": [{{"type": "dpd", "repulsion": 25, "friction": 4.5, "bath": {{{bath}, "temperature": 0}}}},
                {{"type": "langevin", "friction": 2, "bath": {{{bath}}}}},
                {{"type": "bonds", "pairs": [[0, 1], [2, 3], [4, 5], [7, 6]], "friction": 3, "bath": {{{bath}}}}}]
        }}"#
        );
        crate::support::scene(&text)
    };
    let white = scene(r#""type":"white""#);
    for scheme in ["cotter-reich", "exponential"] {
        let fast = scene(&format!(r#""type":"memory","rate":1e11,"scheme":"{scheme}""#));
        let (model, state) = start(&fast);
        let mut remembering = Reference::new(model, state);
        // The first step begins with baths at rest, which white noise has no need of.
        remembering.step().unwrap();
        let begun = remembering.state().clone();
        assert!(!begun.pair_baths.is_empty() && begun.bond_baths.len() == 4);
        let mut forgetting = Reference::new(white.model().clone(), begun.clone());
        for step in 1..=20 {
            remembering.step().unwrap();
            forgetting.step().unwrap();
            let (momentum, _) = largest_difference(remembering.state(), forgetting.state());
            // A kick of a pair is some 10⁵ units.
            assert!(momentum <= 20 * step, "{scheme} {step}: {momentum}");
        }
        assert!(remembering.state().anchors != begun.anchors, "the list was made anew");
    }
}

/// A pair that leaves and comes back: its bath goes on if it stayed on the list, which a wide skin makes likelier, and
/// starts anew otherwise. Both are right in law: a bath knows nothing of the fluid it is in.
#[test]
fn a_fluid_with_memory_does_not_know_of_its_list() {
    const RATE: f64 = 10.0;
    let (friction, time_step) = (4.5, 0.01);
    for (scheme, skin) in [("cotter-reich", 0.05), ("cotter-reich", 0.6), ("symmetric", 0.3), ("exponential", 0.3)] {
        let scene = fluid(&[
            "space.box=[6,6,6]",
            &format!("time.step={time_step}"),
            "interactions.0.repulsion=10",
            &format!("interactions.0.skin={skin}"),
            &format!(r#"interactions.0.bath={{"type":"memory","rate":{RATE},"scheme":"{scheme}"}}"#),
            r#"integrator={"type":"cotter-reich"}"#,
            "output.energies.every=5",
        ]);
        let (_, state) = start(&scene);
        let at_rest = RATE * friction * family(scheme, RATE * time_step).1;
        // The reference takes the same steps; it is run where most pairs come and go.
        let shown = if skin < 0.1 { 2 } else { 1 };
        for mut run in runs(&scene, &state).into_iter().rev().take(shown) {
            run.step(200);
            let series = run.series(5, 240);
            let temperature: Vec<f64> = series.iter().map(Observables::kinetic_temperature).collect();
            let bath: Vec<f64> = series.iter().map(|row| row.bath_square / at_rest).collect();
            let what = format!("fluid {scheme} {skin}, {}", run.name());
            // Stretches of this length scatter by 0.0133, as 24 of them do; blocking sees too few of the slow turns between
            // kinetic and potential energy. B is 0.06 for some thirteen pairs a particle: a bit of that is allowed for.
            let temperature = Measured { error: 0.0133, ..Measured::of(&temperature) };
            temperature.assert(&format!("{what}, temperature"), 1.0, 0.005, 0.0133);
            // Some 4 000 pairs within reach, each of which has forgotten s² after half of 1/α: 120 times in this run.
            let bath = Measured { error: (2.0 / (4000.0 * 120.0_f64)).sqrt(), ..Measured::of(&bath) };
            bath.assert(&format!("{what}, bath"), 1.0, 0.01, 0.0021);
            run.step(1);
            assert_eq!(run.state().total_momentum(), [0; 3], "{what}");
        }
    }
}

/// Every step of the device from wherever it is, rebuilt lists and all, against one step of the reference from there.
///
/// Impulses are rounded to some 2⁻²⁴ of a thermal momentum; single precision adds a relative error of some 2⁻²³ to impulses
/// of at most about 2²³ units for each of some dozen pairs. A hundred units are a hundred-thousandth of the noise of a step.
///
/// A pair that is as far apart as the cutoff, to the digits of single precision, may meet here and not there: of some 4 000 pairs
/// with three times as many per unit of distance, one in 1 500 steps. It has no weight there, and moves less than 0.1 in a step.
#[test]
fn every_step_of_the_device_is_one_of_the_reference() {
    for (changes, steps) in [
        (vec!["interactions.0.skin=0", "space.box=[4,4,4]"], 60),
        (vec!["interactions.0.skin=0.05", "space.box=[4,4,4]"], 60),
        (vec!["interactions.0.skin=0.6", "space.box=[6,6,6]"], 200),
        (vec!["interactions.0.skin=0.3", "space.box=[12,9]"], 100),
    ] {
        let mut changes = changes;
        changes.extend([
            "time.step=0.01",
            "interactions.0.repulsion=10",
            r#"interactions.0.bath={"type":"memory","rate":10}"#,
            r#"integrator={"type":"cotter-reich"}"#,
        ]);
        let scene = fluid(&changes);
        let (model, state) = start(&scene);
        let mut device = Device::from_state(&scene, &state, Options::default());
        let cutoff = model.particles().pair_force.as_ref().unwrap().cutoff;
        let (mut lists, mut doubtful) = (0, 0);
        let mut before = state;
        for step in 0..steps {
            let mut reference = Reference::new(model.clone(), before.clone());
            reference.step().unwrap();
            device.step(1);
            let found = device.state();
            let expected = reference.state();
            let what = format!("step {step}, {changes:?}");
            let (momentum, position) = largest_difference(&found, expected);
            assert!(momentum <= 100 && position <= 400, "{what}: {momentum} and {position} units off");
            lists += usize::from(found.anchors != before.anchors);
            assert_eq!(found.anchors, expected.anchors, "{what}");
            assert_eq!(found.pair_baths.len(), expected.pair_baths.len(), "{what}");
            for (a, b) in found.pair_baths.iter().zip(&expected.pair_baths) {
                assert_eq!([a.first, a.second], [b.first, b.second], "{what}");
                if a.stamp != b.stamp {
                    let ends = [a.first, a.second].map(|id| found.positions[id as usize]);
                    let way = model.units.displacement(ends[0], ends[1]);
                    let distance = way.iter().map(|component| component * component).sum::<f64>().sqrt();
                    assert!((distance - cutoff).abs() < 0.1, "{what}: {a:?} {b:?} at a distance of {distance}");
                    doubtful += 1;
                    continue;
                }
                let [a, b] = [a, b].map(|bath| f32::from_bits(bath.memory));
                assert!((a - b).abs() < 1e-4, "{what}: {a} {b}");
            }
            before = found;
        }
        assert!(lists > 3, "{changes:?}: {lists} lists");
        assert!(doubtful <= 2, "{changes:?}: {doubtful} pairs met here and not there");
    }
}

/// The impulse of a coloured noise is ∫F dt over its jumps, of which a step may hold many or none.
#[test]
fn coloured_noise_gives_the_impulse_of_its_jumps() {
    use mesoscope::families::ColouredNoise;
    for (dimension, process) in
        [(1, "kangaroo"), (2, "kangaroo"), (3, "kangaroo"), (3, "kangaroo-exponential"), (2, "short"), (2, "literal")]
    {
        for time in [0.004, 0.3] {
            let lengths = &[20.0, 20.0, 20.0][..dimension];
            let text = format!(
                r#"{{
                "title": "test", "space": {{"box": {lengths:?}}}, "time": {{"step": 0.01, "steps": 1}}, "temperature": 1.0,
                "particles": [{{"species": "A", "count": 50, "velocities": {{"type": "rest"}}}}],
                "interactions": [{{"type": "coloured-noise", "strength": 4, "time": {time}, "process": "{process}"}}]
            }}"#
            );
            let scene = crate::support::scene(&text);
            let (model, state) = start(&scene);
            let noise: ColouredNoise = *model.particles().coloured_noise.as_ref().unwrap();
            for mut run in runs(&scene, &state) {
                const STEPS: u64 = 40;
                run.step(STEPS);
                let found = run.state();
                // The momenta are those after the opening half kick of the last step.
                let end = (STEPS as f64 - 0.5) * model.time_step;
                let mut jumps = 0;
                for id in 0..found.len() {
                    let mut passed = 0.0;
                    let mut expected = [0.0; 3];
                    for number in 0.. {
                        let uniform = ColouredNoise::uniform_numbers(&model, id as u32, number);
                        let jump =
                            if number == 0 { noise.start(dimension, uniform) } else { noise.jump(dimension, uniform) };
                        let held = jump.time.min(end - passed);
                        for axis in 0..3 {
                            expected[axis] += held * jump.force[axis];
                        }
                        passed += jump.time;
                        if passed >= end {
                            assert_eq!(found.holds[id].jump, number + 1, "{process}, {}", run.name());
                            jumps += number;
                            break;
                        }
                    }
                    let momentum = model.units.momentum(found.momenta[id]);
                    for axis in 0..3 {
                        // Half a unit for each of the two impulses of a step, and the rounding of single precision.
                        let tolerance = model.units.momentum * STEPS as f64 + 2e-6;
                        let error = (momentum[axis] - expected[axis]).abs();
                        assert!(error < tolerance, "{process} {dimension} {time}, {}: off by {error}", run.name());
                    }
                }
                assert!(jumps > if time < 0.01 { 500 } else { 5 }, "{process} {time}: {jumps} jumps");
            }
        }
    }
}

/// The stationary start of coloured noise, F·F being constant while a force is held: C(t)/α is the share of forces that
/// outlast t.
#[test]
fn the_start_of_coloured_noise_is_stationary() {
    for (process, expected) in [
        ("kangaroo", [1.0 - 0.125, 0.5, 0.125]),
        (
            "kangaroo-exponential",
            [4.0 * (1.0 - (-0.25_f64).exp()), 1.0 - (-1.0_f64).exp(), 0.25 * (1.0 - (-4.0_f64).exp())],
        ),
        ("short", [(-0.25_f64).exp(), (-1.0_f64).exp(), (-4.0_f64).exp()]),
    ] {
        let text = format!(
            r#"{{
            "title": "test", "space": {{"box": [20, 20]}}, "time": {{"step": 0.01, "steps": 1}}, "temperature": 1.0,
            "particles": [{{"species": "A", "count": 100000}}],
            "interactions": [{{"type": "coloured-noise", "strength": 4, "time": 0.5, "process": "{process}"}}]
        }}"#
        );
        let (_, state) = start(&crate::support::scene(&text));
        for (ratio, expected) in [0.25, 1.0, 4.0].into_iter().zip(expected) {
            // 100 half steps are a time ε.
            let outlast = |hold: &&mesoscope::state::Hold| {
                f64::from(hold.halves) + f64::from(f32::from_bits(hold.fraction)) > 100.0 * ratio
            };
            let share = state.holds.iter().filter(outlast).count() as f64 / 1e5;
            let error = (expected * (1.0 - expected) / 1e5_f64).sqrt();
            assert!(
                (share - expected).abs() < 4.0 * error,
                "{process} {ratio}: {share}, expected {expected} ± {error}"
            );
        }
        let mean: [f64; 2] = [0, 1]
            .map(|axis| state.holds.iter().map(|hold| f64::from(f32::from_bits(hold.force[axis]))).sum::<f64>() / 1e5);
        let square: f64 = state
            .holds
            .iter()
            .map(|hold| hold.force.iter().map(|bits| f64::from(f32::from_bits(*bits)).powi(2)).sum::<f64>())
            .sum::<f64>()
            / 1e5;
        assert!((square - 4.0).abs() < 1e-5, "{process}: {square}");
        assert!(mean.iter().all(|mean| mean.abs() < 4.0 * (2.0_f64 / 1e5).sqrt()), "{process}: {mean:?}");
    }
}
