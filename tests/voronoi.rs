//! Voronoi DPD.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod support;

use mesoscope::model::Model;
use mesoscope::plan::Options;
use mesoscope::scene::{self, Scene};
use mesoscope::state::State;
use support::{Device, Implementation};

fn cells(changes: &[&str]) -> Scene {
    let text = r#"{
        "title": "test", "space": {"box": [20, 20]}, "time": {"step": 0.02, "steps": 1}, "temperature": 1.0,
        "particles": [{"species": "A", "count": 400, "mass": 5}],
        "interactions": [{"type": "voronoi"}], "output": {"energies": {"every": 1}}
    }"#;
    let changes: Vec<String> = changes.iter().map(|change| (*change).to_owned()).collect();
    match scene::parse("test", text, &changes) {
        Ok(scene) => scene,
        Err(error) => panic!("{error}"),
    }
}

fn start(scene: &Scene) -> State {
    let model = Model::new(scene);
    let mut state = scene::placement::initial_state(scene, &model);
    let cells = model.voronoi.as_ref().unwrap();
    if state.masses.is_empty() {
        state.masses =
            state.species.iter().map(|s| (model.species[*s as usize].mass / cells.mass_unit) as u32).collect();
    }
    if cells.keeps_energy() && state.energies.is_empty() {
        state.energies = (0..state.len())
            .map(|id| {
                let mass = f64::from(state.masses[id]) * cells.mass_unit;
                let p = model.units.momentum(state.momenta[id]);
                let kinetic = (p[0] * p[0] + p[1] * p[1]) / (2.0 * mass);
                ((kinetic + mass / cells.molecular_mass * model.temperature) / cells.energy_unit).round() as i32
            })
            .collect();
    }
    state
}

#[test]
fn it_runs() {
    for extra in [
        &[][..],
        &[r#"interactions.0.viscosity=0"#],
        &[r#"interactions.0.form="consistent""#],
        &[r#"interactions.0.form="paper""#],
        &[r#"interactions.0.energy={"conductivity":1}"#],
        &[r#"interactions.0.energy={"conductivity":0}"#],
        &[r#"interactions.0.energy={"conductivity":1}"#, r#"interactions.0.viscosity=0"#],
        &[r#"interactions.0.form="consistent""#, r#"interactions.0.energy={"conductivity":1}"#],
        &[r#"interactions.0.form="paper""#, r#"interactions.0.energy={"conductivity":1}"#],
        &[r#"integrator.type="euler""#],
        &[r#"integrator.type="euler""#, r#"interactions.0.form="paper""#],
        &[
            r#"integrator.type="euler""#,
            r#"interactions.0.form="consistent""#,
            r#"interactions.0.energy={"conductivity":1}"#,
        ],
    ] {
        let scene = cells(&[&["time.step=0.005"], extra].concat());
        let state = start(&scene);
        let mut run = Device::from_state(&scene, &state, Options::default());
        println!("{extra:?}");
        for _ in 0..5 {
            run.step(100);
            let after = run.observe();
            println!(
                "  {} T {:.4} p {:?} V {:.5} faces {} m {} E {:.5} Ti {:.4} lim {} it {} res {:.2e} F {:.3}",
                after.step,
                after.kinetic_temperature(),
                after.momentum,
                after.cells.unwrap().volume,
                after.cells.unwrap().faces,
                after.cells.unwrap().mass_units,
                after.cells.unwrap().internal_energy + after.kinetic_energy,
                after.cells.unwrap().internal_temperature,
                after.cells.unwrap().limited_exchanges,
                after.cells.unwrap().iterations,
                after.cells.unwrap().residual,
                after.potential_energy
            );
        }
    }
}
