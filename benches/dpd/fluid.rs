//! The standard fluid in cubes of several sizes, equilibrated, and timed runs of it.

use mesoscope::engine::Engine;
use mesoscope::families::Model;
use mesoscope::gpu::Gpu;
use mesoscope::plan::Options;
use mesoscope::scene::{self, Checked};
use mesoscope::state::State;

use crate::Failure;
use crate::common::plan_of;
use crate::common::timed::Run;

/// Integrators as scenes name them.
pub const INTEGRATORS: [&str; 2] = ["groot-warren", "splitting"];
/// Steps of 0.04 from random positions to the fluid: over two units of time, several times what its structure needs.
const EQUILIBRATION: u64 = 60;

/// What makes of the shipped scene one with another box, integrator and time step, and nothing measured on the way.
pub fn changes(edge: f64, integrator: &str, time_step: f64) -> Vec<String> {
    vec![
        format!("space.box=[{edge},{edge},{edge}]"),
        format!(r#"integrator={{"type":"{integrator}"}}"#),
        format!("time.step={time_step}"),
        "time.steps=1000000000".to_owned(),
        "time.equilibration=0".to_owned(),
        r#"output={"energies":{"every":1000000000}}"#.to_owned(),
    ]
}

pub fn scene(edge: f64, integrator: &str, time_step: f64) -> Result<Checked, Failure> {
    Ok(scene::load("dpd-fluid", &changes(edge, integrator, time_step))?)
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
        let model = scene.model().clone();
        let start = mesoscope::families::initial_state(&scene);
        let mut engine = engine(gpu, &scene, &start, Options::default())?;
        engine.advance(EQUILIBRATION, 1)?;
        let state = State { step: 0, ..engine.state()? };
        Ok(Self { edge, model, state })
    }

    pub fn particles(&self) -> usize {
        self.state.len()
    }

    /// A run of this fluid.
    pub fn run<'a>(&self, gpu: &'a Gpu, integrator: &str, time_step: f64) -> Result<Run<'a>, Failure> {
        self.run_with(gpu, integrator, time_step, Options::default())
    }

    /// A run of this fluid with options of the plan.
    pub fn run_with<'a>(
        &self,
        gpu: &'a Gpu,
        integrator: &str,
        time_step: f64,
        options: Options,
    ) -> Result<Run<'a>, Failure> {
        Run::new(engine(gpu, &scene(self.edge, integrator, time_step)?, &self.state, options)?, self.particles())
    }
}

/// An engine of a scene from a state.
pub fn engine<'a>(gpu: &'a Gpu, scene: &Checked, state: &State, options: Options) -> Result<Engine<'a>, Failure> {
    Ok(Engine::new(gpu, plan_of(scene, gpu.into(), options), state)?)
}
