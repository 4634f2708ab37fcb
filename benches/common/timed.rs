//! Timed runs of an engine.

use std::time::Instant;

use mesoscope::engine::{Engine, StageClock, StageTime};
use mesoscope::families::initial_state;
use mesoscope::gpu::Gpu;
use mesoscope::plan::Options;
use mesoscope::scene::Checked;

use super::{Failure, plan_of};

/// Time a submission should take, and the most steps in it: what `mesoscope run` settles on.
const BATCH_SECONDS: f64 = 0.15;
const LARGEST_BATCH: u64 = 512;

/// An engine that is warm, and how fast it is.
pub struct Run<'a> {
    pub engine: Engine<'a>,
    particles: usize,
    step_seconds: f64,
    batch: u64,
}

impl<'a> Run<'a> {
    /// Takes the first steps of an engine with so many particles.
    pub fn new(engine: Engine<'a>, particles: usize) -> Result<Self, Failure> {
        let mut run = Self { engine, particles, step_seconds: 0.0, batch: 1 };
        // The first steps of a pipeline are slow, and step 0 takes a sample.
        run.seconds(2, 2)?;
        let mut steps = 2;
        loop {
            run.step_seconds = run.seconds(steps, steps)? / steps as f64;
            if run.step_seconds * steps as f64 > 0.05 {
                break;
            }
            steps *= 4;
        }
        run.batch = ((BATCH_SECONDS / run.step_seconds) as u64).clamp(1, LARGEST_BATCH);
        Ok(run)
    }

    /// A run of a scene with the best plan for the adapter, from the start and after some steps that are not timed.
    pub fn of_scene(gpu: &'a Gpu, scene: &Checked, options: Options, before: u64) -> Result<Self, Failure> {
        let state = initial_state(scene);
        let mut engine = Engine::new(gpu, plan_of(scene, gpu.into(), options), &state)?;
        engine.advance(before, 50)?;
        engine.finish()?;
        Self::new(engine, state.len())
    }

    /// Times every kernel of a step: over how many steps and how, in words, and what each takes; then what a step of a batch takes.
    pub fn stages(&mut self, seconds: f64) -> Result<(String, Vec<StageTime>, f64), Failure> {
        let step = self.particles as f64 / self.rate(seconds)?;
        // Not sorted or reported, as a step begins.
        self.engine.advance(1, 1)?;
        let clock = self.engine.stage_clock();
        let steps = ((2.0 * seconds / step) as u64).clamp(5, 100);
        let stages = self.engine.time_stages(steps, clock)?;
        let how = match clock {
            StageClock::Timestamps => "timestamps of the device",
            StageClock::Submissions => "every kernel submitted alone, less an empty submission",
        };
        Ok((format!("medians of {steps} steps; {how}"), stages, step))
    }

    /// Seconds that a number of steps take, from the first submission until the device is done.
    fn seconds(&mut self, steps: u64, batch: u64) -> Result<f64, Failure> {
        let begun = Instant::now();
        self.engine.advance(steps, batch)?;
        self.engine.finish()?;
        Ok(begun.elapsed().as_secs_f64())
    }

    /// Particle-steps a second over about that many seconds.
    pub fn rate(&mut self, seconds: f64) -> Result<f64, Failure> {
        self.rate_batched(seconds, self.batch)
    }

    /// The same with a given number of steps a submission.
    pub fn rate_batched(&mut self, seconds: f64, batch: u64) -> Result<f64, Failure> {
        let steps = ((seconds / self.step_seconds) as u64).max(4);
        Ok((steps * self.particles as u64) as f64 / self.seconds(steps, batch)?)
    }
}
