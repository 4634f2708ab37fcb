//! Walls at the ends of every range: nobody is behind one, and momentum is what it was with what they took up, to the last bit.

use mesoscope::engine::EngineError;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;
use mesoscope::state::State;

use crate::support::{GROOT_WARREN, INTEGRATORS, engine, fluid, start};

const SLIT: &str = r#"space={"box":[4,4,2],"walls":{"z":{"lower_velocity":[-3,0,0],"upper_velocity":[3,0,0]}}}"#;
const CAVITY: &str = r#"space={"box":[4,4,4],"walls":{"x":{},"y":{"reflection":"specular"},"z":{}}}"#;
const DUCT: &str = r#"space={"box":[4,4,4],"walls":{"x":{"lower_velocity":[0,0,-2]},"y":{"reflection":"specular"}}}"#;

/// Particles behind a wall that are not frozen there.
fn behind(scene: &Checked, state: &State) -> usize {
    let model = start(scene).0;
    let ends = model.units.ends();
    let is_behind = |(position, species): &(&[u32; 3], &u32)| {
        !model.species[**species as usize].frozen && (0..3).any(|axis| ends[axis] > 0 && position[axis] >= ends[axis])
    };
    state.positions.iter().zip(&state.species).filter(is_behind).count()
}

/// Runs some steps, of which each is looked at, and gives the last state.
fn steps(scene: &Checked, count: u64) -> State {
    let (_, state) = start(scene);
    assert_eq!(behind(scene, &state), 0, "at the start");
    let mut engine = engine(scene, &state, Options::default());
    let mut last = state.clone();
    for step in 1..=count {
        engine.advance(1, 1).unwrap();
        last = engine.state().unwrap();
        assert_eq!(behind(scene, &last), 0, "step {step}");
        assert_eq!(last.exchanged_momentum(), state.total_momentum(), "step {step}");
    }
    last
}

/// In a slit as narrow as can be, in a closed cavity with corners, hot and without heat, at steps that are as long as can be.
#[test]
fn nobody_is_behind_a_wall() {
    let conditions = [
        (SLIT, "time.step=0.04", "temperature=1"),
        (DUCT, "time.step=0.02", "temperature=20"),
        (CAVITY, "time.step=0.04", "temperature=0"),
        (CAVITY, "time.step=0.04", "temperature=1"),
    ];
    for (number, integrator) in INTEGRATORS.iter().enumerate() {
        for (space, step, heat) in [conditions[number % 4], conditions[(number + 1) % 4]] {
            let random = r#"particles=[{"species":"A","number_density":3,"placement":{"type":"random"}}]"#;
            let weak = r#"interactions=[{"type":"dpd","repulsion":2,"friction":4.5}]"#;
            steps(&fluid(&[space, step, heat, random, weak, integrator]), 12);
        }
    }
}

/// Ten thousand steps in a small hot slit whose walls move with layers behind them, driven across itself too: nobody gets behind a wall, what is
/// frozen stays there, and momentum with what the walls have absorbed keeps one value.
#[test]
fn ten_thousand_steps_beside_layers() {
    let particles = r#"particles=[{"species":"A","number_density":3},
        {"species":"W","number_density":3,"placement":{"type":"behind-walls","axis":"z","thickness":1}}]"#;
    let forces =
        r#"interactions=[{"type":"dpd","repulsion":25,"friction":4.5},{"type":"body-force","force":[0.5,0.1,-0.3]}]"#;
    let scene = fluid(&[SLIT, particles, forces, "temperature=2", "time.step=0.02", "output.energies.every=10000"]);
    let (model, first) = start(&scene);
    let frozen: Vec<usize> = (0..first.len()).filter(|id| model.species[first.species[*id] as usize].frozen).collect();
    assert_eq!((frozen.len(), behind(&scene, &first)), (96, 0));
    let mut engine = engine(&scene, &first, Options::default());
    for _ in 0..100 {
        engine.advance(100, 100).unwrap();
        let state = engine.state().unwrap();
        assert_eq!(behind(&scene, &state), 0, "step {}", state.step);
        assert_eq!(state.exchanged_momentum(), first.exchanged_momentum(), "step {}", state.step);
        for id in &frozen {
            assert_eq!(state.positions[*id][2], first.positions[*id][2], "step {}", state.step);
            assert_eq!(state.momenta[*id], first.momenta[*id], "step {}", state.step);
        }
        assert!(state.walls.iter().all(|wall| wall.momentum() != [0; 3]));
    }
}

/// A particle on the first and on the last place between walls, and one that flies along a wall, stay between them.
#[test]
fn particles_at_a_wall() {
    let (mut positions, mut velocities) = (Vec::new(), Vec::new());
    for velocity in ["[0,0,0]", "[3,0,0]", "[0,0,-7]", "[1,0,7]"] {
        for place in ["[1,1,0]", "[1,1,4]", "[4,4,4]", "[0,0,0]"] {
            positions.push(place);
            velocities.push(velocity);
        }
    }
    let particles = format!(
        r#"particles=[{{"species":"A","placement":{{"type":"listed","positions":[{}]}},
            "velocities":{{"type":"listed","velocities":[{}]}}}}]"#,
        positions.join(","),
        velocities.join(",")
    );
    for integrator in INTEGRATORS {
        steps(&fluid(&[CAVITY, "temperature=0", "interactions=[]", &particles, integrator]), 30);
    }
}

/// Without any particle a plan still has its walls.
#[test]
fn nobody_at_all() {
    let none = r#"particles=[{"species":"A","count":0}]"#;
    let last = steps(&fluid(&[CAVITY, none]), 2);
    assert_eq!(last.walls.len(), 6);
}

/// A step that is longer than a cutoff ends a run, as it does without walls, and does not take anybody through one.
#[test]
fn a_drift_beyond_the_cutoff_is_refused() {
    let fast = r#"particles=[{"species":"A","placement":{"type":"listed","positions":[[1,1,1]]},
        "velocities":{"type":"listed","velocities":[[0,0,20]]}}]"#;
    let scene = fluid(&[SLIT, "temperature=0", fast, GROOT_WARREN]);
    let (_, mut state) = start(&scene);
    state.momenta[0][2] *= 4;
    let mut engine = engine(&scene, &state, Options::default());
    let error = engine.advance(1, 1).and_then(|()| engine.state().map(|_| ())).unwrap_err();
    assert!(matches!(error, EngineError::Unstable { .. }), "{error}");
}

/// The start of every placement is between the walls.
#[test]
fn every_placement_is_between_the_walls() {
    for placement in [r#"{"type":"random"}"#, r#"{"type":"lattice"}"#, r#"{"type":"lattice","jitter":0.5}"#] {
        for chain in
            ["", r#","chain":{"beads":5,"spacing":0.9}"#, r#","chain":{"beads":4,"spacing":0.9,"closed":true}"#]
        {
            if placement.contains("jitter") && !chain.is_empty() {
                continue;
            }
            let particles = format!(r#"particles=[{{"species":"A","count":200,"placement":{placement}{chain}}}]"#);
            for space in [SLIT, CAVITY] {
                let scene = fluid(&[space, &particles]);
                let (model, state) = start(&scene);
                assert_eq!(behind(&scene, &state), 0, "{placement} {chain}");
                // Spread over all of the space, not a part of it.
                let highest = state.positions.iter().map(|position| position[2]).max().unwrap();
                assert!(f64::from(highest) > 0.7 * f64::from(model.units.ends()[2]), "{placement} {chain}");
            }
        }
    }
    let molecules = r#"molecules=[{"beads":["A","A","A","A"],"bonds":[[0,1],[1,2],[2,3]],"count":50,"spacing":0.8}]"#;
    let scene = fluid(&[CAVITY, molecules, r#"particles=[{"species":"A"}]"#]);
    let (_, state) = start(&scene);
    assert_eq!((state.len(), behind(&scene, &state)), (200, 0));
}
