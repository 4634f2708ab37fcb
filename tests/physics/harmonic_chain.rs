//! Harmonic chains in double precision, step by step, and on the device, against what is exact: Español 1996,
//! doi:10.1103/PhysRevE.53.1572.

use mesoscope::families::{HarmonicChain, SpringChain};
use mesoscope::gpu::AdapterChoice;
use mesoscope::measure::harmonic_chain::{NormalModes, Pulse, ThermalSeries, equilibrium, half_pulses, thermal_start};
use mesoscope::measure::statistics::Estimate;
use mesoscope::output::read_table;
use mesoscope::run;
use rand::{RngExt, SeedableRng, rngs::StdRng};

/// A chain with the noise of strength √(`noise` · kTγ) on every dashpot, moved by leapfrog steps between which friction and
/// noise act at the positions of half a step.
struct Run {
    chain: SpringChain,
    displacements: Vec<f64>,
    momenta: Vec<f64>,
    temperature: f64,
    /// 2 by fluctuation and dissipation, 1 as the paper prints it.
    noise: f64,
    rng: StdRng,
}

fn gaussian(rng: &mut StdRng) -> f64 {
    let uniform = 1.0 - rng.random::<f64>();
    (-2.0 * uniform.ln()).sqrt() * (std::f64::consts::TAU * rng.random::<f64>()).cos()
}

/// κ A x or γ A v of a chain, from the differences along it.
fn pulled(values: &[f64], factor: f64, forces: &mut [f64]) {
    let mut left = 0.0;
    for i in 0..=values.len() {
        let here = values.get(i).copied().unwrap_or(0.0);
        let tension = factor * (here - left);
        if i > 0 {
            forces[i - 1] += tension;
        }
        if i < values.len() {
            forces[i] -= tension;
        }
        left = here;
    }
}

impl Run {
    fn new(chain: SpringChain, (displacements, momenta): (Vec<f64>, Vec<f64>)) -> Self {
        Self { chain, displacements, momenta, temperature: 0.0, noise: 2.0, rng: StdRng::seed_from_u64(7) }
    }

    fn drift(&mut self, time: f64) {
        for (displacement, momentum) in self.displacements.iter_mut().zip(&self.momenta) {
            *displacement += momentum / self.chain.mass * time;
        }
    }

    fn kick(&mut self, time: f64) {
        let mut forces = vec![0.0; self.chain.beads];
        pulled(&self.displacements, self.chain.stiffness, &mut forces);
        for (momentum, force) in self.momenta.iter_mut().zip(forces) {
            *momentum += force * time;
        }
    }

    /// p' = p - γ/m A (p + p')/2 dt + noise, which keeps the temperature exactly; solved along the tridiagonal matrix.
    fn exchange(&mut self, time: f64) {
        if self.chain.friction == 0.0 {
            return;
        }
        let n = self.chain.beads;
        let half = 0.5 * self.chain.friction / self.chain.mass * time;
        let mut right = self.momenta.clone();
        pulled(&self.momenta, half, &mut right);
        let width = (self.noise * self.temperature * self.chain.friction * time).sqrt();
        for bond in 0..=n {
            let kick = width * gaussian(&mut self.rng);
            if bond > 0 {
                right[bond - 1] += kick;
            }
            if bond < n {
                right[bond] -= kick;
            }
        }
        let mut upper = vec![0.0; n];
        for i in 0..n {
            let pivot = 1.0 + 2.0 * half + if i > 0 { half * upper[i - 1] } else { 0.0 };
            upper[i] = -half / pivot;
            right[i] = (right[i] + if i > 0 { half * right[i - 1] } else { 0.0 }) / pivot;
        }
        for i in (0..n - 1).rev() {
            right[i] -= upper[i] * right[i + 1];
        }
        self.momenta = right;
    }

    fn steps(&mut self, count: u64, time: f64) {
        for _ in 0..count {
            self.kick(0.5 * time);
            self.drift(0.5 * time);
            self.exchange(time);
            self.drift(0.5 * time);
            self.kick(0.5 * time);
        }
    }
}

const PULSE: HarmonicChain =
    HarmonicChain { clusters: 200, cluster_size: 16, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };

/// Peak and variance of each half at τ = 40 from steps, within 2 % of independently measured values, and within the error of
/// the steps of the exact motion.
#[test]
fn the_pulse_of_three_chains() {
    let beads = Pulse { amplitude: 1.0, width: 2.0 }.displacements(&PULSE);
    let (clusters, still) = PULSE.coarse_grained(&beads, &vec![0.0; beads.len()]);
    let time = 40.0 * PULSE.cluster_time();
    let at_rest = vec![0.0; beads.len()];
    for (name, chain, start, step, peak, variance) in [
        ("micro", PULSE.micro(), (beads, at_rest), 0.1, 0.480, 4.08),
        ("dissipative", PULSE.dissipative(), (clusters.clone(), still.clone()), 0.5, 0.205, 24.0),
        ("frictionless", PULSE.frictionless(), (clusters, still), 0.5, 0.458, 4.08),
    ] {
        let energy = chain.energy(&start.0, &start.1);
        let (exact, _) = NormalModes::new(chain).evolved(&start.0, &start.1, time);
        let mut run = Run::new(chain, start);
        run.steps((time / step).round() as u64, step);
        let error = run.displacements.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(error < 2e-4, "{name}: {error}");
        let kept = chain.energy(&run.displacements, &run.momenta) / energy;
        assert_eq!((kept - 1.0).abs() < 1e-3, chain.friction == 0.0, "{name}: {kept}");
        let found = if chain.beads > 200 {
            PULSE.coarse_grained(&run.displacements, &run.momenta).0
        } else {
            run.displacements
        };
        for half in half_pulses(&found) {
            assert!((half.peak / peak - 1.0).abs() < 0.02, "{name}: {half:?}");
            assert!((half.variance / variance - 1.0).abs() < 0.02, "{name}: {half:?}");
        }
    }
}

const THERMAL: HarmonicChain =
    HarmonicChain { clusters: 256, cluster_size: 16, mass: 1.0, stiffness: 1.0, reduced_friction: 0.5 };

fn assert_within(name: &str, found: Option<Estimate>, expected: f64) {
    let found = found.unwrap();
    let error = found.error.unwrap();
    assert!((found.value - expected).abs() < 4.0 * error, "{name}: {found:?}, expected {expected}");
    assert!(error < 0.05 * expected, "{name}: the error {error} shows nothing");
}

/// ⟨P²⟩ and the variance of `X_{μ+1} - X_μ` of the dissipative chain, with the noise of fluctuation and dissipation and with
/// that of equation (47): √(kTγ) keeps half the temperature.
#[test]
fn the_printed_noise_keeps_half_the_temperature() {
    let temperature = 1.5;
    let chain = THERMAL.dissipative();
    for (noise, kept) in [(2.0, 1.0), (1.0, 0.5)] {
        let mut rng = StdRng::seed_from_u64(11);
        // From the temperature the noise is said to keep, and a tenth of the way off.
        let start = thermal_start(&chain, 1.1 * kept * temperature, || gaussian(&mut rng));
        let mut run = Run { temperature, noise, ..Run::new(chain, start) };
        let step = 0.5;
        // The waves of the longest relaxation take no part in either variance.
        run.steps(1500, step);
        let mut series = ThermalSeries::new(chain.beads);
        for _ in 0..400 {
            run.steps(16, step);
            series.push(&run.displacements, &run.momenta);
        }
        let estimates = series.estimates();
        let name = format!("noise √({noise} kTγ)");
        let momentum = kept * equilibrium::momentum_variance(&THERMAL, temperature);
        assert_within(&name, estimates.momentum_variance, momentum);
        // The drift-friction-drift splitting with kicks outside widens springs by ω²dt²/4 at most, 0.1 %.
        let separation = kept * equilibrium::separation_variance(&chain, temperature);
        assert_within(&name, estimates.separation_variance, separation);
    }
}

/// A chain of beads from its own equilibrium: variances and autocorrelation of its clusters against the exact ones, and
/// the variance of neighbours against that of springs between clusters, which it does not have.
#[test]
fn clusters_of_beads_in_equilibrium() {
    let chain = THERMAL.micro();
    let mut rng = StdRng::seed_from_u64(5);
    let mut run = Run::new(chain, thermal_start(&chain, 1.0, || gaussian(&mut rng)));
    let mut series = ThermalSeries::new(THERMAL.clusters);
    let (step, steps) = (0.1, 40);
    for _ in 0..80 {
        let (displacements, momenta) = THERMAL.coarse_grained(&run.displacements, &run.momenta);
        series.push(&displacements, &momenta);
        run.steps(steps, step);
    }
    let estimates = series.estimates();
    let separation = equilibrium::cluster_separation_variance(&THERMAL, 1.0);
    let within = |found: Option<Estimate>, exact: f64| {
        let found = found.unwrap();
        let error = found.error.unwrap();
        assert!((found.value - exact).abs() < 4.0 * error && error < 0.12 * exact, "{found:?}, exact {exact}");
        (found.value, error)
    };
    let scale = equilibrium::momentum_variance(&THERMAL, 1.0);
    within(estimates.momentum_variance, scale);
    let (mean, error) = within(estimates.separation_variance, separation);
    let springs = equilibrium::separation_variance(&THERMAL.frictionless(), 1.0);
    assert!((mean - springs).abs() > 5.0 * error, "{mean} ± {error}, {springs}");
    let times: Vec<f64> = (0..16).map(|lag| f64::from(lag) * steps as f64 * step).collect();
    let exact = NormalModes::new(chain).momentum_autocorrelation(THERMAL.cluster_size, &times);
    for (lag, (found, exact)) in series.momentum_correlation(16).into_iter().zip(exact).enumerate() {
        let error = found.error.unwrap();
        assert!((found.value - exact * scale).abs() < 4.0 * error, "lag {lag}: {found:?}, exact {}", exact * scale);
    }
}

const TABLES: [&str; 5] =
    ["chain_profiles.csv", "chain_pulse.csv", "chain_correlation.csv", "chain_memory.csv", "chain_equilibrium.csv"];

/// The shipped scene, smaller: the pulse as it moves exactly, equilibrium within 4 standard errors, and the same tables to
/// the last byte from a run that was stopped half-way.
#[test]
fn the_scene_on_the_device() {
    let overrides = |steps: u64| {
        let chain = "interactions[0].";
        [
            format!("time.steps={steps}"),
            format!("{chain}pulse.clusters=40"),
            format!("{chain}equilibrium.clusters=256"),
            "output.energies.every=320".to_owned(),
        ]
    };
    let scene = |steps: u64| mesoscope::scene::load("harmonic-chain", &overrides(steps)).unwrap();
    let [whole, halves] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let outcome = run::Run::replace(scene(1280), whole.path()).execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    let first = run::Run::replace(scene(640), halves.path());
    first.execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    let rest = run::Run::resume(halves.path(), Some(1280)).unwrap();
    rest.execute(&AdapterChoice::Best, &mut |_| {}).unwrap();
    for name in TABLES {
        let [one, other] = [&whole, &halves].map(|directory| std::fs::read(directory.path().join(name)).unwrap());
        assert!(one == other, "{name}");
        assert!(whole.path().join(name).with_extension("png").exists(), "{name}");
    }
    // The steps of ω₀dt = 0.1 are off by their square, and positions by 2048/2³² of a pulse 32 high.
    let pulse = read_table(&whole.path().join("chain_pulse.csv")).unwrap();
    for chain in ["micro", "dpd", "frictionless"] {
        for (quantity, tolerance) in [("peak", 1e-3), ("variance", 0.01), ("energy", 1e-3)] {
            let [found, exact] = ["", "exact_"].map(|kind| pulse.column(&format!("{chain}_{kind}{quantity}")).unwrap());
            for (found, exact) in found.iter().zip(&exact) {
                assert!((found / exact - 1.0).abs() < tolerance, "{chain} {quantity}: {found} {exact}");
            }
        }
        let results = &outcome.summary.results["chain"]["chains"][chain];
        for quantity in ["momentum_variance_over_nmkT", "separation_variance_times_stiffness_over_nkT"] {
            let [mean, error, exact] = ["value", "error", "exact"].map(|key| results[quantity][key].as_f64().unwrap());
            assert!(
                (mean - exact).abs() < 4.0 * error && error < 0.12,
                "{chain} {quantity}: {mean} ± {error}, {exact}"
            );
        }
    }
}
