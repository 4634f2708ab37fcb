//! The standard fluid in cubes of several sizes, equilibrated, and timed runs of it.

use std::time::Instant;

use mesoscope::engine::Engine;
use mesoscope::gpu::Gpu;
use mesoscope::model::Model;
use mesoscope::plan::{self, Hardware, Options, Plan};
use mesoscope::scene::{self, Scene};
use mesoscope::state::State;

use crate::Failure;

/// Integrators as scenes name them.
pub const INTEGRATORS: [&str; 2] = ["groot-warren", "splitting"];
/// Steps of 0.04 from random positions to the fluid: over two units of time, several times what its structure needs.
const EQUILIBRATION: u64 = 60;
/// Time a submission should take, and the most steps in it: what `mesoscope run` settles on.
const BATCH_SECONDS: f64 = 0.15;
const LARGEST_BATCH: u64 = 512;

/// The shipped scene with another box, integrator and time step, and nothing measured on the way.
pub fn scene(edge: f64, integrator: &str, time_step: f64) -> Result<Scene, Failure> {
    let changes = [
        format!("space.box=[{edge},{edge},{edge}]"),
        format!(r#"integrator={{"type":"{integrator}"}}"#),
        format!("time.step={time_step}"),
        "time.steps=1000000000".to_owned(),
        "time.equilibration=0".to_owned(),
        r#"output={"energies":{"every":1000000000}}"#.to_owned(),
    ];
    Ok(scene::load("dpd-fluid", &changes)?)
}

pub fn plan_of(scene: &Scene, hardware: Hardware) -> Plan {
    plan::plan(&Model::new(scene), scene.time.equilibration, &scene.output, hardware, Options::default())
}

/// Particles in equilibrium: all runs of this size begin with them, those of LAMMPS too.
pub struct Fluid {
    pub edge: f64,
    pub model: Model,
    pub state: State,
}

impl Fluid {
    pub fn equilibrated(gpu: &Gpu, edge: f64) -> Result<Self, Failure> {
        let scene = scene(edge, "groot-warren", 0.04)?;
        let model = Model::new(&scene);
        let start = scene::placement::initial_state(&scene, &model);
        let mut engine = engine(gpu, &scene, &start)?;
        engine.advance(EQUILIBRATION, 1)?;
        let state = State { step: 0, ..engine.state()? };
        Ok(Self { edge, model, state })
    }

    pub fn particles(&self) -> usize {
        self.state.len()
    }

    /// A run of this fluid.
    pub fn run<'a>(&self, gpu: &'a Gpu, integrator: &str, time_step: f64) -> Result<Run<'a>, Failure> {
        let engine = engine(gpu, &scene(self.edge, integrator, time_step)?, &self.state)?;
        let mut run = Run { engine, particles: self.particles(), step_seconds: 0.0, batch: 1 };
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
}

fn engine<'a>(gpu: &'a Gpu, scene: &Scene, state: &State) -> Result<Engine<'a>, Failure> {
    let plan = plan_of(scene, Hardware { subgroup_size: gpu.subgroup_size() });
    Ok(Engine::new(gpu, plan, state)?)
}

/// An engine that is warm, and how fast it is.
pub struct Run<'a> {
    pub engine: Engine<'a>,
    particles: usize,
    step_seconds: f64,
    batch: u64,
}

impl Run<'_> {
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
