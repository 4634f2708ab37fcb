//! Errors that runs print against the scatter of what they find with other seeds: `make validate`. Each test prints its table in Markdown.

use mesoscope::noise;
use serde_json::{Value, json};

use crate::support::program::Place;

const SEEDS: u64 = 32;

/// Runs a scene with as many seeds; the scatter of each number over the root of the mean square of its printed errors is 1, as nearly as 32 seeds
/// tell: to 1/√(2 · 31), 13 %, two of which are allowed beyond .8 and 1.25.
fn compare(scene: &Value, names: &[&str]) {
    let mut found: Vec<Vec<[f64; 2]>> = vec![Vec::new(); names.len()];
    for seed in 1..=SEEDS {
        let place = Place::of(scene.clone()).with("/seed", json!(seed));
        place.run("out", &["--quiet"]);
        let summary: Value = serde_json::from_slice(&std::fs::read(place.path("out/run.json")).unwrap()).unwrap();
        for (name, found) in names.iter().zip(&mut found) {
            let number = summary.pointer(name).unwrap_or_else(|| panic!("{name} is missing: {summary}"));
            let value = number["value"].as_f64().unwrap_or_else(|| panic!("{name}: {number}"));
            found.push([value, number["error"].as_f64().unwrap()]);
        }
    }
    println!("| number | mean | scatter over printed error | within one error |\n|-|-|-|-|");
    let mut wrong = Vec::new();
    for (name, found) in names.iter().zip(&found) {
        let count = found.len() as f64;
        let mean = found.iter().map(|[value, _]| value).sum::<f64>() / count;
        let variance = found.iter().map(|[value, _]| (value - mean).powi(2)).sum::<f64>() / (count - 1.0);
        let printed = found.iter().map(|[_, error]| error * error).sum::<f64>() / count;
        let ratio = (variance / printed).sqrt();
        let within = found.iter().filter(|[value, error]| (value - mean).abs() < *error).count();
        println!("| {name} | {mean:.5} ± {:.5} | {ratio:.2} | {within} of {SEEDS} |", printed.sqrt());
        if !(0.8 / 1.26..=1.25 * 1.26).contains(&ratio) {
            wrong.push(format!("{name}: {ratio:.2}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
#[ignore = "minutes"]
fn errors_of_the_fluid_its_diffusion_and_viscosity() {
    let scene = json!({
        "title": "fluid", "space": {"box": [3, 3, 3]}, "time": {"step": 0.04, "steps": 6400, "equilibration": 400}, "temperature": 1,
        "particles": [{"species": "A", "number_density": 3}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}],
        "output": {"energies": {"every": 20}, "diffusion": {"every": 5, "window": 60}, "stress": {"every": 1, "window": 50}},
    });
    let names = [
        "/means/temperature",
        "/means/configurational_temperature",
        "/means/potential_energy",
        "/means/pressure_conservative",
        "/means/pressure",
        "/results/diffusion/diffusion_einstein",
        "/results/stress/shear_viscosity",
    ];
    compare(&scene, &names);
}

/// Runs some ten correlations long, whose errors have a star.
#[test]
#[ignore = "minutes"]
fn errors_of_a_slab() {
    let [edge, length] = [3.0, 8.0];
    let count = (1.5 * edge * edge * length) as u32;
    let positions = |species: u32| -> Vec<[f64; 3]> {
        let part = |id: u32, axis: u32| 0.5 + noise::centred_uniform(noise::pcg4d([id, axis, species, 1])[0]);
        let from = 0.5 * length * f64::from(species);
        (0..count).map(|id| [edge * part(id, 0), edge * part(id, 1), from + 0.5 * length * part(id, 2)]).collect()
    };
    let listed = |name: &str, species: u32| json!({"species": name, "placement": {"type": "listed", "positions": positions(species)}});
    let scene = json!({
        "title": "slab", "space": {"box": [edge, edge, length]}, "time": {"step": 0.04, "steps": 5500, "equilibration": 1500},
        "temperature": 1, "particles": [listed("A", 0), listed("B", 1)],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5, "pairs": [{"between": ["A", "B"], "repulsion": 65}]}],
        "output": {"energies": {"every": 20}, "stress": {"every": 10, "normal": "z"}},
    });
    let names = [
        "/results/stress/surface_tension_conservative",
        "/results/stress/surface_tension",
        "/means/potential_energy",
        "/means/pressure_conservative",
    ];
    compare(&scene, &names);
}

/// Pentamers, whose sizes are forgotten slowly.
#[test]
#[ignore = "minutes"]
fn errors_of_pentamers() {
    let scene = json!({
        "title": "pentamers", "space": {"box": [3, 3, 3]}, "time": {"step": 0.04, "steps": 3500, "equilibration": 1000}, "temperature": 1,
        "particles": [{"species": "A", "count": 80, "chain": {"beads": 5, "spacing": 0.8}}],
        "interactions": [{"type": "dpd", "repulsion": 25, "friction": 4.5}, {"type": "bonds", "potential": {"type": "harmonic", "stiffness": 4}}],
        "output": {"energies": {"every": 20}, "chain_sizes": {"every": 5}},
    });
    compare(
        &scene,
        &["/results/chain_sizes/0/end_to_end_squared", "/results/chain_sizes/0/radius_of_gyration_squared"],
    );
}
