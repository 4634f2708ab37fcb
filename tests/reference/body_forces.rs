//! Body forces on the device: against the float64 reference, step by step, and against what is exact.

use mesoscope::families::Model;
use mesoscope::measure::Observables;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use serde_json::{Value, json};

use crate::support::{
    Device, INTEGRATORS, Implementation, SideBySide, before_and_after, engine, observables, reference_of_particles,
    same_energies, start, units_of_a_step,
};

fn read(document: &Value) -> Checked {
    crate::support::scene(&document.to_string())
}

/// A fluid of two species in a box, whose interactions are followed by others.
fn fluid(edges: &[f64], integrator: &str, others: &[Value]) -> Value {
    let volume: f64 = edges.iter().product();
    let integrator: Value = serde_json::from_str(integrator.strip_prefix("integrator=").unwrap()).unwrap();
    let dpd = json!({"type": "dpd", "repulsion": 25, "friction": 4.5});
    let interactions = [&[dpd], others].concat();
    json!({
        "title": "driven",
        "seed": 5,
        "space": {"box": edges},
        "time": {"step": 0.01, "steps": 1},
        "temperature": 1,
        "integrator": integrator,
        "particles": [
            {"species": "light", "count": (2.0 * volume) as u64},
            {"species": "heavy", "count": volume as u64, "mass": 2.5}],
        "interactions": interactions,
        "output": {"energies": {"every": 1}},
    })
}

const BOXES: [&[f64]; 3] = [&[61.0], &[9.0, 7.0], &[5.0, 4.0, 4.5]];

/// Forces of every profile: components that fill whole units of momentum, and one that is less than a unit a step.
fn forces(dimension: usize) -> Vec<Vec<Value>> {
    let force = |scale: f64| Value::from([1.5 * scale, -1e-6, 0.7 * scale][..dimension].to_vec());
    let last = ["x", "y", "z"][dimension - 1];
    vec![
        vec![json!({"type": "body-force", "force": force(1.0)})],
        vec![
            json!({"type": "body-force", "profile": "opposed", "axis": last, "force": force(1.0), "species": ["light"]}),
            json!({"type": "body-force", "profile": "opposed", "axis": last, "force": force(-3.0), "species": ["heavy"]}),
        ],
        vec![json!({"type": "body-force", "profile": "sinusoidal", "axis": "x", "waves": 3, "force": force(2.0)})],
    ]
}

/// Momentum that was put in agrees to a unit an impulse of half a step, which a sine may round the other way; and to the bit where
/// there is none. Work is a sum in single precision of impulses times velocities of a few units.
fn same_account(found: &Observables, expected: &Observables, model: &Model, exact: bool, steps: u64, what: &str) {
    let halves = 2.0 * (steps * model.particle_count()) as f64 * model.units.momentum;
    for axis in 0..3 {
        let [a, b] = [found, expected].map(|observables| observables.from_body_forces.momentum[axis]);
        assert!((a - b).abs() <= if exact { 0.0 } else { halves }, "momentum along {axis}: {a}, {b} ({what})");
    }
    let strongest = 10.0 * model.time_step * (steps * model.particle_count()) as f64;
    let [a, b] = [found, expected].map(|observables| observables.from_body_forces.work);
    assert!((a - b).abs() <= 1e-5 * strongest, "work: {a}, {b} ({what})");
}

fn agree(document: &Value, exact: bool) {
    let scene = read(document);
    let (model, state) = start(&scene);
    let mut both = SideBySide::new(scene.clone(), model.clone(), &state, Options::default());
    both.steps(4, units_of_a_step(false), &format!("{document:#}"), |step, found, expected| {
        let [given, known] = [found, expected].map(|state| state.account[0].momentum());
        assert!(!exact || given == known, "step {step}: {given:?}, {known:?}\n{document:#}");
    });
    let measured = observables(&mut both.device, &scene);
    let expected = both.reference.observe();
    same_energies(&measured, &expected, 0.0, &format!("{document:#}"));
    same_account(&measured, &expected, &model, exact, 4, &format!("{document:#}"));
}

#[test]
fn body_forces_agree_with_the_reference() {
    for integrator in INTEGRATORS {
        for edges in &BOXES[1..] {
            for (number, forces) in forces(edges.len()).iter().enumerate() {
                agree(&fluid(edges, integrator, forces), number < 2);
            }
        }
    }
}

/// With bonds among pairs, with a bath that makes couplings of them all, on a line, and beside particles that are held.
#[test]
fn body_forces_beside_others_agree_with_the_reference() {
    let bonds = json!({"type": "bonds", "pairs": [[0, 1], [1, 2]], "potential": {"type": "harmonic", "stiffness": 40}});
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let edges = BOXES[1 + number % 2];
        let forces = forces(edges.len());
        agree(&fluid(edges, integrator, &[std::slice::from_ref(&bonds), &forces[number % 2][..]].concat()), true);
    }
    let cotter_reich = r#"integrator={"type":"cotter-reich"}"#;
    let langevin = json!({"type": "langevin", "friction": 2, "bath": {"type": "memory", "rate": 5}});
    for edges in BOXES {
        for (number, forces) in forces(edges.len()).iter().enumerate() {
            let mut document = fluid(edges, cotter_reich, &[std::slice::from_ref(&langevin), &forces[..]].concat());
            agree(&document, number < 2);
            document["particles"][1]["fixed"] = json!(true);
            if number != 1 {
                agree(&document, number < 2);
            }
        }
    }
}

/// To the last bit: the momentum is that of the start and what body forces have added. The impulses of a uniform force add up to its
/// part in every step, however small, less than a unit a particle off at either end of the steps.
#[test]
fn momentum_is_what_forces_add() {
    const STEPS: u64 = 200;
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let edges = BOXES[1 + number % 2];
        for (profile, forces) in forces(edges.len()).iter().enumerate() {
            let scene = read(&fluid(edges, integrator, forces));
            let (model, state) = start(&scene);
            assert_eq!(state.account[0].momentum(), [0; 3]);
            let mut device = engine(&scene, &state, Options::default());
            device.advance(STEPS, 50).unwrap();
            let after = device.state().unwrap();
            assert_eq!(after.exchanged_momentum(), state.total_momentum(), "{integrator} {forces:?}");
            assert_ne!(after.account[0].momentum(), [0; 3]);
            if profile > 0 {
                continue;
            }
            for (axis, force) in [1.5, -1e-6, 0.7].into_iter().take(edges.len()).enumerate() {
                // Both halves of every step, but for the closing one of the first.
                let halves = (2 * STEPS - 1) as f64;
                let exact = force * 0.5 * model.time_step / model.units.momentum * halves;
                let each = after.account[0].momentum()[axis] as f64 / state.len() as f64;
                let off = (each - exact).abs();
                assert!(
                    off <= 2.0 + force.abs() / model.units.momentum * model.time_step * 1e-9,
                    "{axis}: {each} {exact}"
                );
            }
        }
    }
}

/// Without friction the energy of a fluid changes by the work on it, as far as the leapfrog scheme keeps energies: dt²/8 of the
/// squares of forces over the masses, a part of a thousand here.
#[test]
fn energy_is_the_work_that_was_done() {
    for integrator in [&INTEGRATORS[0], &INTEGRATORS[1], &INTEGRATORS[3]] {
        for forces in forces(3) {
            let mut document = fluid(BOXES[2], integrator, &forces);
            document["interactions"][0]["friction"] = json!(0);
            document["time"]["step"] = json!(0.002);
            document["output"]["energies"]["every"] = json!(100);
            let scene = read(&document);
            for (name, [first, last]) in before_and_after(&scene, 500) {
                let (gained, work) = (last.total_energy() - first.total_energy(), last.from_body_forces.work);
                assert_eq!(first.from_body_forces.work, 0.0);
                assert!(work.abs() > 20.0, "{work}: too little to say something");
                assert!((gained - work).abs() < 1e-3 * last.total_energy(), "{name}: {gained} {work}");
            }
        }
    }
}

/// Particles with friction of their own end at the velocity f/γ, which the scheme has exactly; what is held stays.
#[test]
fn a_force_against_friction_ends_at_its_velocity() {
    let velocities = [0.4, -0.1, 0.25];
    for edges in BOXES {
        let force: Vec<f64> = velocities[..edges.len()].iter().map(|velocity| 2.0 * velocity).collect();
        let scene = read(&json!({
            "title": "sediment", "space": {"box": edges}, "time": {"step": 0.01, "steps": 1}, "temperature": 0,
            "particles": [
                {"species": "grain", "count": 40, "mass": 0.5, "velocities": {"type": "rest"}},
                {"species": "wall", "count": 10, "fixed": true, "velocities": {"type": "rest"}},
                {"species": "dust", "count": 10, "velocities": {"type": "rest"}}],
            "interactions": [
                {"type": "langevin", "friction": 2},
                {"type": "body-force", "force": force, "species": ["grain"]}],
            "output": {"energies": {"every": 1}},
        }));
        let (model, state) = start(&scene);
        let implementations: [Box<dyn Implementation>; 2] =
            [Box::new(Device::new(&scene)), reference_of_particles(model.clone(), state)];
        for mut implementation in implementations {
            // Twenty times the time of relaxation m/γ.
            implementation.step(500);
            let last = implementation.state();
            for id in 0..last.len() {
                for axis in 0..3 {
                    let expected = if id < 40 && axis < edges.len() { 0.5 * velocities[axis] } else { 0.0 };
                    let found = f64::from(last.momenta[id][axis]) * model.units.momentum;
                    assert!((found - expected).abs() < 1e-5, "{} {id} {axis}: {found}", implementation.name());
                }
            }
        }
    }
}
