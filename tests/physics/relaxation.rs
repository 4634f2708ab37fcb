//! Split steps with baths without memory on particles, against what they leave exactly.

use mesoscope::scene::Scene;
use serde_json::{Value, json};

use crate::support::{Device, Implementation, Measured, start};

fn scene(particles: Value, interactions: Value) -> Scene {
    let document = json!({
        "title": "relaxation", "seed": 3, "space": {"box": [60, 50, 40]}, "time": {"step": 0.25, "steps": 1}, "temperature": 1.7,
        "integrator": {"type": "splitting"}, "particles": particles, "interactions": interactions,
        "output": {"energies": {"every": 1}},
    });
    crate::support::scene(&document.to_string())
}

/// The momenta of free particles forget as exp(-γt/m), and keep m kT of mean square, however long the step: both are those of
/// independent particles, so that errors of means are known.
#[test]
fn free_particles_forget_exactly() {
    let particles =
        json!([{"species": "light", "count": 6000, "mass": 0.5}, {"species": "heavy", "count": 6000, "mass": 4}]);
    let friction = [1.0, 14.0];
    let bath =
        json!([{"type": "langevin", "friction": friction[0], "species": [{"name": "heavy", "friction": friction[1]}]}]);
    let scene = scene(particles, bath);
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
        let mut run = Device::new(&scene(particles.clone(), bath(friction, 0.0)));
        let first = run.observe().kinetic_energy;
        run.step(20);
        let last = run.observe().kinetic_energy;
        assert!((last / first - kept).abs() < 1e-5, "{friction}: {last} of {first}");
    }
}

#[test]
fn none_one_and_two_particles() {
    for count in [0, 1, 2] {
        for more in [None, Some(json!({"type": "dpd", "repulsion": 25})), Some(json!({"type": "dpd", "friction": 4.5}))]
        {
            let bath = json!({"type": "langevin", "friction": 2});
            let interactions: Vec<Value> = std::iter::once(bath).chain(more).collect();
            let mut run = Device::new(&scene(json!([{"species": "A", "count": count}]), json!(interactions)));
            run.step(10);
            assert_eq!((run.state().len(), run.observe().particles), (count, count as u64));
        }
    }
}
