//! Scenes from absolute zero to great heat, for each kind of force: integer momenta have room for what the forces do, however
//! cold it is, and resolve it.

use mesoscope::families::reference::{Reference, Unstable};
use mesoscope::scene::{self, Checked};
use serde_json::{Value, json};

use crate::support::{Device, Implementation as _, edited};

const TEMPERATURES: [f64; 9] = [0.0, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2, 1.0, 1e2];

/// Momenta that a run takes.
const ROOM: u32 = 1 << 30;

/// Interactions of chains or of single particles, with the largest momentum of a particle of mass 1 that they make from rest.
fn cases() -> Vec<(&'static str, Value, f64)> {
    let bonds = |potential: Value| json!({"type": "bonds", "friction": 1, "potential": potential});
    let harmonic =
        |stiffness: f64, length: f64| bonds(json!({"type": "harmonic", "stiffness": stiffness, "length": length}));
    vec![
        ("repulsion", json!([{"type": "dpd", "repulsion": 25, "friction": 4.5}]), 2.0),
        (
            "repulsion and memory",
            json!([{"type": "dpd", "repulsion": 25, "friction": 4.5, "bath": {"type": "memory", "rate": 10}}]),
            2.0,
        ),
        ("bonds", json!([harmonic(1.0, 0.0)]), 0.1),
        ("stiff bonds", json!([harmonic(400.0, 0.7)]), 1.0),
        ("weak bonds", json!([harmonic(1e-6, 0.0)]), 1e-7),
        ("bonds at rest", json!([harmonic(1.0, 1.0)]), 0.0),
        ("finite bonds", json!([bonds(json!({"type": "fene", "stiffness": 30, "extent": 1.5}))]), 1.0),
        ("angles", json!([harmonic(10.0, 1.0), {"type": "angles", "stiffness": 5}]), 0.3),
        ("tethers", json!([{"type": "tether", "stiffness": 10}, {"type": "langevin", "friction": 1}]), 0.0),
        ("a driven bath", json!([{"type": "langevin", "friction": 1, "bath": {"type": "memory", "rate": 3}}]), 0.0),
        (
            "coloured noise",
            json!([{"type": "coloured-noise", "strength": 4, "time": 0.2}, {"type": "langevin", "friction": 1}]),
            0.3,
        ),
    ]
}

fn scene_of(interactions: &Value, temperature: f64) -> Checked {
    let text = json!({
        "title": "cold", "seed": 5, "space": {"box": [8, 8, 8]}, "time": {"step": 0.01, "steps": 80}, "temperature": temperature,
        "particles": [{"species": "A", "count": 120, "chain": {"beads": 12}}], "interactions": interactions,
    });
    scene::parse("cold", &text.to_string(), &[]).unwrap()
}

fn largest_of(momenta: &[[i32; 3]]) -> u32 {
    momenta.iter().flatten().map(|units| units.unsigned_abs()).max().unwrap()
}

/// The largest momentum after some steps and on the way, in units, and the momentum of a unit. Great heat may tear bonds of
/// finite length apart, and then it is that until there.
fn largest(interactions: &Value, temperature: f64) -> (u32, f64) {
    let scene = scene_of(interactions, temperature);
    let model = scene.model();
    let unit = model.units.momentum;
    let state = mesoscope::families::initial_state(&scene);
    let mut most = largest_of(&state.momenta);
    let mut run = Reference::new(model.clone(), state);
    for _ in 0..80 {
        match run.step() {
            Ok(()) => {}
            Err(Unstable::Bond { .. }) if temperature >= 1.0 => break,
            Err(problem) => panic!("{interactions}, kT = {temperature}: {problem:?}"),
        }
        most = most.max(largest_of(&run.state().momenta));
    }
    (most, unit)
}

#[test]
fn momenta_fit_and_are_resolved_at_any_temperature() {
    for (name, interactions, from_rest) in cases() {
        for temperature in TEMPERATURES {
            let (most, unit) = largest(&interactions, temperature);
            let momentum = f64::from(most) * unit;
            println!("{name}, kT = {temperature:e}: {most} units of {unit:e}");
            // What forces and heat make of the momenta is in them.
            assert!(most < ROOM, "{name}, kT = {temperature}: {most}");
            assert!(momentum >= from_rest, "{name}, kT = {temperature}: {momentum}");
            assert!(momentum >= 2.0 * temperature.sqrt(), "{name}, kT = {temperature}: {momentum}");
            // Unless nothing moves at all, the largest momentum has ten bits.
            assert!(from_rest == 0.0 && temperature == 0.0 || most > 1 << 10, "{name}, kT = {temperature}: {most}");
        }
    }
}

/// Where heat rules, the unit follows it alone: runs keep their bytes.
#[test]
fn heat_rules_the_unit_where_it_is_larger_than_what_forces_do() {
    for (name, interactions, _) in cases().into_iter().filter(|(name, ..)| *name != "coloured noise") {
        for temperature in [1.0, 4.0, 100.0] {
            let unit = scene_of(&interactions, temperature).model().units.momentum;
            assert_eq!(unit, (temperature.sqrt().log2().ceil() - 24.0).exp2(), "{name}");
        }
    }
}

/// Springs that start far from rest or not, by what only the whole scene tells, with the largest momentum that comes of it.
fn springs() -> Vec<(&'static str, Value, [f64; 2])> {
    let scene = |lengths: Value, step: f64, particles: Value, bonds: Value| {
        json!({
            "title": "springs", "seed": 5, "space": {"box": lengths}, "time": {"step": step, "steps": 120},
            "particles": particles, "interactions": [bonds],
        })
    };
    let spring = |stiffness: f64, length: f64| json!({"type": "harmonic", "stiffness": stiffness, "length": length});
    let pairs: Vec<[u32; 2]> = (0..20).map(|pair| [2 * pair, 2 * pair + 1]).collect();
    let listed = |positions: Value| json!({"type": "listed", "positions": positions});
    vec![
        // Up to half of the longest edge apart.
        (
            "pairs at random places in a long box",
            scene(
                json!([400, 4, 4]),
                0.01,
                json!([{"species": "A", "count": 40}]),
                json!({"type": "bonds", "potential": spring(1.0, 0.0), "pairs": pairs}),
            ),
            [50.0, 150.0],
        ),
        // Half a unit off, of reduced mass 5e5.
        (
            "heavy beads among light particles",
            scene(
                json!([8, 8, 8]),
                10.0,
                json!([{"species": "light", "count": 10},
                    {"species": "heavy", "mass": 1e6, "count": 20, "chain": {"beads": 2, "spacing": 1.5}}]),
                json!({"type": "bonds", "potential": spring(1.0, 1.0)}),
            ),
            [300.0, 400.0],
        ),
        // The light ends get what the heavy ones get.
        (
            "light beads on heavy ones",
            scene(
                json!([8, 8, 8]),
                0.01,
                json!([{"species": "light", "placement": listed(json!([[1, 1, 1], [7.5, 4, 4]]))},
                    {"species": "heavy", "mass": 1e6, "placement": listed(json!([[2.5, 1, 1], [1, 4, 4]]))}]),
                json!({"type": "bonds", "potential": spring(1.0, 1.0), "pairs": [[0, 2], [1, 3]]}),
            ),
            [0.4, 0.6],
        ),
        (
            "a listed pair, off by a tenth, through the edge of the box",
            scene(
                json!([1000, 1000, 1000]),
                0.001,
                json!([{"species": "A", "placement": listed(json!([[999.5, 3, 3], [0.6, 3, 3]]))}]),
                json!({"type": "bonds", "potential": spring(1e4, 1.0), "pairs": [[0, 1]]}),
            ),
            [6.0, 10.0],
        ),
        (
            "a listed chain at rest",
            scene(
                json!([1000, 1000, 1000]),
                0.001,
                json!([{"species": "A", "chain": {"beads": 3, "closed": true},
                    "placement": listed(json!([[1, 1, 1], [2, 1, 1], [1.5, 1.866, 1]]))}]),
                json!({"type": "bonds", "potential": spring(1e4, 1.0)}),
            ),
            [0.0, 1.0],
        ),
        // A circle of 100 beads, 0.628 apart.
        (
            "a ring of beads on a circle",
            scene(
                json!([1000, 1000]),
                0.001,
                json!([{"species": "A", "count": 100, "chain": {"beads": 100, "closed": true},
                    "placement": {"type": "circle", "center": [500, 500], "radius": 10}}]),
                json!({"type": "bonds", "potential": spring(1e4, 0.6)}),
            ),
            [0.0, 4.0],
        ),
    ]
}

#[test]
fn springs_start_as_far_from_rest_as_the_scene_says() {
    for (name, mut text, [least, most]) in springs() {
        for temperature in [0.0, 1e-8] {
            text["temperature"] = json!(temperature);
            let scene = scene::parse("springs", &text.to_string(), &[]).unwrap();
            let model = scene.model();
            let state = mesoscope::families::initial_state(&scene);
            let unit = model.units.momentum;
            let mut run = Reference::new(model.clone(), state);
            let mut units = 0;
            for _ in 0..120 {
                run.step().unwrap();
                units = units.max(largest_of(&run.state().momenta));
            }
            let momentum = f64::from(units) * unit;
            println!("{name}, kT = {temperature:e}: {momentum} in {units} units");
            assert!(units < ROOM && momentum >= least && momentum <= most, "{name}, kT = {temperature}: {momentum}");
            assert!(units > 1 << 10, "{name}, kT = {temperature}: {units} units");
            // Neither is it a failure on the device.
            let mut device = Device::new(&scene);
            device.step(120);
            let momenta = [&device.state(), run.state()].map(|state| f64::from(largest_of(&state.momenta)) * unit);
            let [found, expected] = momenta;
            // Single precision knows lengths to 1e-7, of which the stiffest spring makes 1e-6 in a step.
            assert!((found - expected).abs() < 1e-3 * momentum + 5e-4, "{name}: {found}, not {expected}");
        }
        // At a temperature of one its momenta are resolved as those of any other scene, unless the springs make far more.
        // In steps that they need not be able to take.
        let scene = scene::parse("springs", &text.to_string(), &[]).unwrap();
        let scene = edited(&scene, |scene| scene.temperature = 1.0);
        let model = scene.model();
        let heaviest = model.species.iter().map(|species| species.mass).fold(0.0, f64::max);
        let thermal = (heaviest.sqrt().log2().ceil() - 24.0).exp2();
        assert!(model.units.momentum == thermal || most > 48.0 * thermal * 2_f64.powi(24), "{name}");
    }
}
