//! The speed of the standard fluid.

use std::time::{Duration, Instant};

use super::Finding;
use crate::engine::{Engine, EngineError};
use crate::families::{self, Model};
use crate::gpu::Gpu;
use crate::plan::{Hardware, Options};
use crate::run::plan;
use crate::scene;

/// How long to measure.
const WHILE: Duration = Duration::from_millis(1500);
/// Steps of a batch.
const BATCH: u64 = 20;

/// Particle-steps a second of the built-in `dpd-fluid`.
pub(super) fn of_the_standard_fluid(gpu: &Gpu) -> Finding {
    let check = "speed of `dpd-fluid`";
    match measure(gpu) {
        Ok((particles, rate)) => {
            let found = format!("{:.2} million particle-steps a second with {particles} particles", rate / 1e6);
            Finding::noted(check, found)
        }
        Err(error) => Finding::new(check, false, error),
    }
}

fn measure(gpu: &Gpu) -> Result<(u64, f64), String> {
    let words = |error: EngineError| error.to_string();
    let scene = scene::load("dpd-fluid", &["output={}".to_owned()]).map_err(|error| error.to_string())?;
    let model = Model::new(&scene);
    let start = families::initial_state(&scene, &model);
    let plan = plan(&model, 0, &scene.output, Hardware::from(gpu), Options::default());
    let particles = plan.particles;
    let mut engine = Engine::new(gpu, plan, &start).map_err(words)?;
    let mut advance = |steps: u64| engine.advance(steps, BATCH).and_then(|()| engine.finish()).map_err(words);
    advance(BATCH)?;
    let clock = Instant::now();
    let mut steps = 0;
    while clock.elapsed() < WHILE {
        advance(2 * BATCH)?;
        steps += 2 * BATCH;
    }
    Ok((particles, steps as f64 * particles as f64 / clock.elapsed().as_secs_f64()))
}
