//! Timing a step by stage does not change the step.

use mesoscope::engine::StageClock;
use mesoscope::plan::Options;

use crate::support::{INTEGRATORS, engine, fluid, start};

#[test]
fn timed_steps_are_ordinary_steps() {
    for integrator in INTEGRATORS {
        // A sample at steps 0 and 5, which are not timed but must be taken.
        let scene = fluid(&[integrator, "time.steps=100", "output.energies.every=5"]);
        let (_, state) = start(&scene);
        let mut plain = engine(&scene, &state, Options::default());
        plain.advance(8, 8).unwrap();
        let expected = plain.state().unwrap();
        let mut timed = engine(&scene, &state, Options::default());
        let mut clocks = vec![StageClock::Submissions];
        if timed.stage_clock() == StageClock::Timestamps {
            clocks.push(StageClock::Timestamps);
        }
        for clock in clocks {
            timed.upload(&state).unwrap();
            let stages = timed.time_stages(8, clock).unwrap();
            assert_eq!(timed.state().unwrap(), expected, "{integrator}, {clock:?}");
            let samples: Vec<u64> = timed.finish().unwrap().iter().map(|sample| sample.step).collect();
            assert_eq!(samples, [0, 5], "{integrator}, {clock:?}");
            let plan = timed.plan();
            assert_eq!(stages.len(), plan.sort.len() + plan.before_report.len() + plan.advance.len());
            assert!(stages.iter().all(|stage| stage.seconds.is_finite() && stage.seconds >= 0.0));
            assert!(stages.iter().any(|stage| stage.seconds > 0.0), "{integrator}, {clock:?}");
        }
    }
}

#[test]
fn a_reported_step_cannot_be_timed() {
    let scene = fluid(&["time.steps=100"]);
    let (_, state) = start(&scene);
    let mut engine = engine(&scene, &state, Options::default());
    engine.finish().unwrap();
    assert!(engine.time_stages(1, StageClock::Submissions).is_err());
    engine.advance(1, 1).unwrap();
    assert!(engine.time_stages(0, StageClock::Submissions).unwrap().is_empty());
}
