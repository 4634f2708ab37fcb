//! Split steps with baths without memory on particles, against what they leave exactly.

use mesoscope::scene::Scene;
use serde_json::{Value, json};

use crate::support::{Device, Implementation, Measured, equilibrium, start};

fn scene(particles: &Value, interactions: &Value) -> Scene {
    let document = json!({
        "title": "relaxation", "seed": 3, "space": {"box": [60, 50, 40]}, "time": {"step": 0.25, "steps": 1},
        "temperature": 1.7, "integrator": {"type": "splitting"}, "particles": particles, "interactions": interactions,
        "output": {"energies": {"every": 1}},
    });
    crate::support::scene(&document.to_string())
}

/// The momenta of free particles forget as exp(-γt/m), and keep m kT of mean square, however long the step: both are
/// those of independent particles, so that errors of means are known.
#[test]
fn free_particles_forget_exactly() {
    let particles =
        json!([{"species": "light", "count": 6000, "mass": 0.5}, {"species": "heavy", "count": 6000, "mass": 4}]);
    let friction = [1.0, 14.0];
    let bath =
        json!([{"type": "langevin", "friction": friction[0], "species": [{"name": "heavy", "friction": friction[1]}]}]);
    let scene = scene(&particles, &bath);
    let (model, first) = start(&scene);
    let mut run = Device::new(&scene);
    // Four times O, which the first step leaves out.
    run.step(5);
    let last = run.state();
    let momentum = |units: i32| f64::from(units) * model.units.momentum;
    for (species, mass) in [(0, 0.5), (1, 4.0)] {
        let ids = (0..first.len()).filter(|id| first.species[*id] == species);
        let pairs: Vec<[f64; 2]> = ids
            .flat_map(|id| (0..3).map(move |axis| (id, axis)))
            .map(|(id, axis)| [momentum(first.momenta[id][axis]), momentum(last.momenta[id][axis])])
            .collect();
        let scaled =
            |value: fn([f64; 2]) -> f64| -> Vec<f64> { pairs.iter().map(|pair| value(*pair) / (mass * 1.7)).collect() };
        let kept = (-friction[species as usize] / mass).exp();
        Measured::of_independent(&scaled(|[a, b]| a * b)).assert("correlation", kept, 0.0, 0.01);
        Measured::of_independent(&scaled(|[_, b]| b * b)).assert("mean square", 1.0, 0.0, 0.012);
    }
}

/// With next to no friction a bath takes and gives next to nothing, and without a temperature it takes what it should.
#[test]
fn no_friction_and_no_temperature() {
    let particles = json!([{"species": "A", "count": 500}]);
    let bath = |friction: f64, temperature: f64| json!([{"type": "langevin", "friction": friction, "bath": {"type": "white", "temperature": temperature}}]);
    for (friction, kept) in [(1e-12, 1.0), (0.8, (-0.4_f64 * 20.0).exp()), (1e9, 0.0)] {
        let mut run = Device::new(&scene(&particles, &bath(friction, 0.0)));
        let first = run.observe().kinetic_energy;
        run.step(20);
        let last = run.observe().kinetic_energy;
        assert!((last / first - kept).abs() < 1e-5, "{friction}: {last} of {first}");
    }
}

/// Oscillators at a step in which they turn by a radian and more: ⟨p²⟩ = m kT and K⟨q²⟩ = kT where they are read,
/// whatever the friction; where forces are evaluated q² would be a third or more too wide.
#[test]
fn oscillators_have_their_temperature_at_any_step_and_friction() {
    for (stiffness, friction) in [(16.0, 0.4), (16.0, 1e6), (40.0, 3.0)] {
        let particles = json!([{"species": "A", "count": 4000}]);
        let interactions =
            json!([{"type": "langevin", "friction": friction}, {"type": "tether", "stiffness": stiffness}]);
        let mut run = Device::new(&scene(&particles, &interactions));
        run.step(60);
        let series = run.series(5, 60);
        let [kinetic, configurational, _] = equilibrium(&series);
        let what = format!("K = {stiffness}, γ = {friction}");
        kinetic.assert(&format!("kinetic temperature, {what}"), 1.7, 0.0, 0.006);
        configurational.assert(&format!("configurational temperature, {what}"), 1.7, 0.0, 0.006);
        let energies: Vec<f64> = series.iter().map(|row| row.potential_energy / 6000.0).collect();
        Measured::of(&energies).assert(&format!("potential energy, {what}"), 1.7, 0.0, 0.006);
    }
}

/// Chains of springs without a length are linear, so that split steps leave both temperatures right, whatever friction
/// along their bonds does: bonds that share beads relax one after the other, each exactly. A bath lets their angular
/// momenta go.
#[test]
fn friction_along_bonds_leaves_the_temperature_of_chains() {
    for friction in [2.0, 1e6] {
        let particles = json!([{"species": "A", "count": 6000, "chain": {"beads": 6, "spacing": 0.8}}]);
        let interactions = json!([{"type": "langevin", "friction": 0.5},
            {"type": "bonds", "friction": friction, "potential": {"type": "harmonic", "stiffness": 8}}]);
        let mut run = Device::new(&scene(&particles, &interactions));
        run.step(100);
        let series = run.series(5, 60);
        let [kinetic, configurational, _] = equilibrium(&series);
        kinetic.assert(&format!("kinetic temperature, γ = {friction}"), 1.7, 0.0, 0.006);
        configurational.assert(&format!("configurational temperature, γ = {friction}"), 1.7, 0.0, 0.009);
    }
}

#[test]
fn none_one_and_two_particles() {
    for count in [0, 1, 2] {
        for more in [
            None,
            Some(json!({"type": "dpd", "repulsion": 25})),
            Some(json!({"type": "dpd", "friction": 4.5})),
            Some(json!({"type": "tether", "stiffness": 3})),
        ] {
            let bath = json!({"type": "langevin", "friction": 2});
            let interactions: Vec<Value> = std::iter::once(bath).chain(more).collect();
            let mut run = Device::new(&scene(&json!([{"species": "A", "count": count}]), &json!(interactions)));
            run.step(10);
            assert_eq!((run.state().len(), run.observe().particles), (count, count as u64));
        }
    }
}
