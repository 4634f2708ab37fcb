//! Many-body dissipative particle dynamics at the ends of every range.

use mesoscope::engine::EngineError;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;

use crate::support::{INTEGRATORS, engine, fluid, observables, reference_of_particles, same_energies, start};

const FORCE: &str = r#"interactions=[{"type":"dpd","repulsion":-40,"friction":4.5,"many_body":{"repulsion":25}}]"#;
const REPORTS: [&str; 3] = ["time.step=0.01", "time.steps=100", "output.energies.every=1"];

fn listed(positions: &str) -> String {
    format!(r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":[{positions}]}}}}]"#)
}

fn scene(changes: &[&str]) -> Checked {
    fluid(&[&[FORCE][..], &REPORTS, changes].concat())
}

/// Some steps, of which the last is compared with the reference of the same state.
fn agree(scene: &Checked, steps: u64) {
    let (model, state) = start(scene);
    let mut engine = engine(scene, &state, Options::default());
    engine.advance(steps, steps).unwrap();
    let last = engine.state().unwrap();
    assert_eq!(last.total_momentum(), state.total_momentum());
    let found = observables(&mut engine, scene);
    same_energies(&found, &reference_of_particles(model, last).observe(), 0.0, &scene.title);
    assert!(found.potential_energy.is_finite() && found.laplacian.is_finite());
}

/// None, one, two, and two and three in one place.
#[test]
fn few_particles() {
    let few = ["", "[1,1,1]", "[1,1,1],[1.3,1,1]", "[1,1,1],[1,1,1]", "[1,1,1],[1,1,1],[1,1,1],[1.5,1,1]"];
    for (number, positions) in few.into_iter().enumerate() {
        let none = r#"particles=[{"species":"A","count":0}]"#.to_owned();
        let particles = if positions.is_empty() { none } else { listed(positions) };
        for integrator in [INTEGRATORS[number], INTEGRATORS[(number + 1) % INTEGRATORS.len()]] {
            agree(&scene(&[&particles, integrator]), 3);
        }
    }
}

/// Without heat, at rest and falling; in a box of three cutoffs, and of two, where an axis is a single cell.
#[test]
fn cold_and_narrow() {
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        let space = ["space.box=[3,3,3]", "space.box=[2,2,7]", "space.box=[2,9]"][number % 3];
        let state = ["temperature=0", "particles.0.number_density=7"][number % 2];
        agree(&scene(&[state, space, integrator]), 10);
    }
}

/// Densities have room for a thousand particles in one place; more end the run, and do not wrap. Software adapters may have given up
/// before.
#[test]
fn a_density_beyond_its_range_is_a_failure() {
    for (count, fits) in [(200, true), (1100, false)] {
        let crowd = listed(&vec!["[1,1,1]"; count].join(","));
        // A force so weak that no impulse is out of range.
        let weak = r#"interactions=[{"type":"dpd","many_body":{"repulsion":1e-4}}]"#;
        let scene = scene(&[&crowd, weak, r#"particles.0.velocities={"type":"rest"}"#]);
        if fits {
            agree(&scene, 2);
            continue;
        }
        let (_, state) = start(&scene);
        let mut engine = engine(&scene, &state, Options::default());
        let result = engine.advance(2, 1).and_then(|()| engine.state().map(|_| ()));
        assert!(
            matches!(result, Err(EngineError::Unstable { .. } | EngineError::GaveUp { .. })),
            "{count}: {result:?}"
        );
    }
}
