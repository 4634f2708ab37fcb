//! Shear at the ends of every range: peculiar momentum is what it was, to the last bit.

use mesoscope::engine::EngineError;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::state::State;

use crate::support::{GROOT_WARREN, PREDICTED, SPLITTING, STAGED, engine, fluid, start};

const SHEARED: [&str; 4] = [SPLITTING, GROOT_WARREN, PREDICTED, STAGED];

fn sheared(rate: f64) -> String {
    format!(r#"space={{"box":[5,4,5],"shear":{{"rate":{rate:e},"gradient":"z"}}}}"#)
}

/// Runs some steps from a state, and gives the last.
fn run(scene: &Checked, state: &State, steps: u64) -> State {
    let mut engine = engine(scene, state, Options::default());
    engine.advance(steps, 8).unwrap();
    let last = engine.state().unwrap();
    assert_eq!(last.exchanged_momentum(), state.total_momentum());
    last
}

/// A rate of zero is no shear, and one of next to nothing gives the same positions and momenta.
#[test]
fn next_to_no_shear() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        let [none, zero, least] = ["space.box=[5,4,5]".to_owned(), sheared(0.0), sheared(1e-30)].map(|space| {
            let scene = fluid(&[&space, integrator]);
            let (_, state) = start(&scene);
            run(&scene, &state, 20)
        });
        assert!(none == zero, "{integrator}");
        assert!(none.positions == least.positions && none.momenta == least.momenta, "{integrator}");
        assert_eq!((none.walls.len(), least.walls.len()), (0, 1));
    }
}

/// As fast as a step takes: the boundaries pass each other by twice the cutoff in every step.
#[test]
fn huge_rates() {
    for integrator in SHEARED {
        for rate in [9.0, -9.0].into_iter().take(if integrator == SPLITTING { 2 } else { 1 }) {
            // A step of .04 times 9 times half of the edge of 5 is .9 of the cutoff.
            let weak = r#"interactions=[{"type":"dpd","repulsion":1,"friction":0.1}]"#;
            let scene = fluid(&[&sheared(rate), integrator, weak, "temperature=0.01"]);
            let (_, state) = start(&scene);
            let last = run(&scene, &state, 3);
            assert_ne!(last.walls[0].momentum()[0], 0, "{integrator} {rate}");
        }
    }
}

/// Velocities beyond the cutoff in a step end a run as they do without shear.
#[test]
fn too_far_in_a_step() {
    let scene = fluid(&[&sheared(9.0), GROOT_WARREN, "temperature=0.01"]);
    let (_, mut state) = start(&scene);
    state.momenta.iter_mut().for_each(|momentum| momentum[0] *= 2);
    let mut engine = engine(&scene, &state, Options::default());
    let error = engine.advance(1, 1).and_then(|()| engine.state().map(|_| ())).unwrap_err();
    assert!(matches!(error, EngineError::Unstable { .. }), "{error}");
}

/// The displacement of the boundaries follows from the number of the step, to its last bit: of two runs at steps in which it is the same,
/// the particles are.
#[test]
fn any_number_of_steps() {
    // A rate of 2^-5 displaces the boundaries by 2^-8 of the box of 4 in a step of 2^-3: the same again after 2^8 steps.
    let space = r#"space={"box":[4,4,4],"shear":{"rate":0.03125,"gradient":"y"}}"#;
    for integrator in [SPLITTING, GROOT_WARREN] {
        let weak = r#"interactions=[{"type":"dpd","repulsion":3,"friction":0.5}]"#;
        let scene = fluid(&[space, integrator, weak, "time.step=0.125", "temperature=0"]);
        let (_, start) = start(&scene);
        let after = |step: u64| {
            let last = run(&scene, &State { step, ..start.clone() }, 6);
            (last.positions, last.momenta)
        };
        let first = after(256 * 3 + 200);
        for step in [(1 << 32) - 56, (1 << 63) + 200, u64::MAX - 55] {
            assert!(first == after(step), "{integrator} {step}");
        }
        assert!(first != after(256 * 3 + 201), "{integrator}");
    }
}

/// Nobody, one, and two that meet across a boundary.
#[test]
fn few_particles() {
    for integrator in [SPLITTING, GROOT_WARREN] {
        for positions in ["[1,1,0.01]", "[1,1,0.01],[1.2,1,4.99]", "[1,1,0.01],[4.9,3.9,4.99],[1,1,0.3],[1,1.5,4.9]"] {
            let particles =
                format!(r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":[{positions}]}}}}]"#);
            let scene = fluid(&[&sheared(1.0), integrator, &particles]);
            let (_, state) = start(&scene);
            run(&scene, &state, 60);
        }
        let scene = fluid(&[&sheared(1.0), integrator, r#"particles=[{"species":"A","count":0}]"#]);
        let (_, state) = start(&scene);
        run(&scene, &state, 2);
    }
}
