//! The shear flow of the scene `shallow-water` on meshes of several sizes.

use std::str::FromStr;

use mesoscope::engine::Engine;
use mesoscope::families::{Model, ShallowWater};
use mesoscope::gpu::Gpu;
use mesoscope::measure::{Observables, observables_of};
use mesoscope::plan::{Hardware, Options, Plan};
use mesoscope::run;
use mesoscope::scene::{self, Checked};
use mesoscope::state::State;

use crate::Failure;
use crate::common::timed::Run;

/// The mesh of the scene, at whose spacing it takes steps of this length.
const SCENE_MESH: u32 = 64;
const SCENE_STEP: f64 = 0.02;
/// Spacings in the smoothing length.
const SMOOTHING: f64 = 4.0;
/// Edge of the square into which half of the particles gather, as a share of the box: 1/16 of the cells.
const CROWD: f64 = 0.25;

/// A mesh of that many nodes on each axis, and particles on a square lattice.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    pub mesh: u32,
    pub particles: usize,
}

impl Size {
    /// A mesh with so many particles a cell.
    pub fn filled(mesh: u32, per_cell: usize) -> Self {
        Self { mesh, particles: per_cell * (mesh as usize).pow(2) }
    }

    pub fn nodes(&self) -> usize {
        (self.mesh as usize).pow(2)
    }

    /// Sites of the lattice along each axis.
    fn sites(&self) -> usize {
        self.particles.isqrt()
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let accepted = "accepted: MESH or MESH:PARTICLES, as in 64:65536; MESH a power of two from 8 to 4096, PARTICLES \
                        the square of a whole number";
        let (mesh, particles) = text.split_once(':').map_or((text, None), |(mesh, count)| (mesh, Some(count)));
        let mesh: u32 = mesh.parse().map_err(|_| accepted.to_owned())?;
        let mut size = Self::filled(mesh, 16);
        if let Some(count) = particles {
            size.particles = count.parse().map_err(|_| accepted.to_owned())?;
        }
        let fits = mesh.is_power_of_two() && (8..=4096).contains(&mesh);
        if fits && size.particles > 0 && size.sites().pow(2) == size.particles {
            Ok(size)
        } else {
            Err(accepted.to_owned())
        }
    }
}

/// The scene on a mesh of a size, with the smoothing and the time step that belong to its spacing, and more changes.
pub fn scene(size: Size, energies_every: u64, changes: &[&str]) -> Result<Checked, Failure> {
    let mesh = size.mesh;
    let base = scene::load("shallow-water", &[])?;
    let length = SMOOTHING * base.space.lengths[0] / f64::from(mesh);
    let step = SCENE_STEP * f64::from(SCENE_MESH) / f64::from(mesh);
    let mut all = vec![
        format!("particles[0].count={}", size.particles),
        format!("interactions[0].mesh=[{mesh},{mesh}]"),
        format!("interactions[0].smoothing.length={length:?}"),
        format!("time.step={step:?}"),
        "time.steps=1000000000".to_owned(),
        format!(r#"output={{"energies":{{"every":{energies_every}}}}}"#),
    ];
    all.extend(changes.iter().map(|change| (*change).to_owned()));
    Ok(scene::load("shallow-water", &all)?)
}

/// A run without reports, which are not what is measured.
const NEVER: u64 = 1_000_000_000;

/// The plan for a size, with changes of the scene.
pub fn plan_of(size: Size, changes: &[&str], hardware: Hardware, options: Options) -> Result<Plan, Failure> {
    let scene = scene(size, NEVER, changes)?;
    Ok(run::plan(&scene, hardware, options))
}

/// Where a run begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Start {
    /// On the lattice.
    Even,
    /// Half of all particles in 1/16 of the cells.
    Clustered,
}

/// The flow at step 0: all runs of this size begin with it, the compiled loop too.
pub struct Flow {
    pub size: Size,
    pub model: Model,
    pub water: ShallowWater,
    pub state: State,
}

impl Flow {
    pub fn new(size: Size) -> Result<Self, Failure> {
        let scene = scene(size, NEVER, &[])?;
        let model = scene.model().clone();
        let state = mesoscope::families::initial_state(&scene);
        let water = model.shallow_water().cloned().ok_or("the scene holds no shallow water")?;
        Ok(Self { size, model, water, state })
    }

    /// Milliseconds of a step at so many particle-steps a second.
    pub fn milliseconds(&self, rate: f64) -> f64 {
        1e3 * self.size.particles as f64 / rate
    }

    /// A warm run.
    pub fn run<'a>(&self, gpu: &'a Gpu, changes: &[&str], options: Options, start: Start) -> Result<Run<'a>, Failure> {
        let plan = plan_of(self.size, changes, gpu.into(), options)?;
        let engine = match start {
            Start::Even => Engine::new(gpu, plan, &self.state)?,
            Start::Clustered => Engine::new(gpu, plan, &self.clustered())?,
        };
        Run::new(engine, self.size.particles)
    }

    /// What is measured at step 0 and after so many steps.
    pub fn observed(&self, gpu: &Gpu, steps: u64) -> Result<[Observables; 2], Failure> {
        let scene = scene(self.size, steps, &[])?;
        let plan = run::plan(&scene, gpu.into(), Options::default());
        let mut engine = Engine::new(gpu, plan, &self.state)?;
        engine.advance(steps, steps)?;
        let samples = engine.finish()?;
        let [first, .., last] = samples.as_slice() else { return Err("no energies came back".into()) };
        Ok([first, last].map(|sample| observables_of(sample, engine.plan(), &self.model)))
    }

    /// The same flow with every other particle drawn into a square, each with the velocity that belongs to its place and
    /// a mass that leaves the depth nearly as it was.
    fn clustered(&self) -> State {
        let mut state = self.state.clone();
        let sites = self.size.sites();
        let inside = |place: f64| (place - 0.5).abs() < 0.5 * CROWD;
        for id in 0..state.len() {
            let mut place = [0, 1].map(|axis| f64::from(state.positions[id][axis]) / 4_294_967_296.0);
            if id % 2 == 0 {
                place = place.map(|place| 0.5 + CROWD * (place - 0.5));
            }
            // The particle of the lattice that was here.
            let [column, row] = place.map(|place| ((place * sites as f64) as usize).min(sites - 1));
            let there = row * sites + column;
            let density = if place.iter().all(|place| inside(*place)) { 0.5 + 0.5 / (CROWD * CROWD) } else { 0.5 };
            state.positions[id] = self.model.units.fraction([
                place[0] * self.model.units.lengths[0],
                place[1] * self.model.units.lengths[1],
                0.0,
            ]);
            state.momenta[id] = self.state.momenta[there];
            state.masses[id] = (f64::from(self.state.masses[there]) / density).round_ties_even() as u32;
        }
        state
    }
}
