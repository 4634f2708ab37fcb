//! How long a run would take: a few steps of it, timed.

use super::RunError;
use super::adapter::plan_for;
use super::sizes::Sizes;
use crate::engine::{Engine, EngineError};
use crate::families::{self, Checked, Instability};
use crate::gpu::{AdapterKind, Gpu};
use crate::plan::{Options, Plan};
use crate::scene::{self};
use std::time::{Duration, Instant};

/// The work of a step and the nodes of a mesh, relative to the small fluid, up to which steps of the scene itself are timed.
const MOST_WORK: f64 = 4.0;
const MOST_NODES: u64 = 1 << 16;

/// Time that steps are tried for.
const PATIENCE: Duration = Duration::from_millis(250);

/// A run takes this many times longer or shorter than steps of the scene itself let expect: shipped scenes took from 0.7 times as
/// long, to 2.8 times where reports cost more than steps, ...
const FACTOR_OF_SCENE: f64 = 3.0;
/// ... and than arithmetic and the steps of another one do.
const FACTOR_OF_ARITHMETIC: f64 = 4.0;

/// Seconds that a pixel of a picture takes to be drawn and compressed, on a software adapter and on others, and that the first one
/// takes more: measured on two cores.
const PIXEL: [f64; 2] = [4e-7, 1e-7];
const FIRST_PICTURE: [f64; 2] = [0.7, 0.2];

/// How long a run is expected to take.
#[derive(Debug, Clone, PartialEq)]
pub struct ExpectedTime {
    /// All steps and reports of the scene; opening the adapter comes on top, and so does [`Self::drawing`].
    pub seconds: f64,
    /// All pictures.
    pub drawing: f64,
    /// A step.
    pub step: f64,
    /// It may be as many times longer or shorter.
    pub factor: f64,
    /// Whether steps of the scene itself were timed; else those of a small fluid, in proportion to the arithmetic.
    pub of_scene: bool,
    /// Steps that were timed.
    pub steps: u64,
    /// How the scene became unstable in a later one of them, as its run will.
    pub unstable: Option<Instability>,
}

/// Times some steps on an adapter: of the scene if it is small, else of a small fluid.
///
/// It takes a quarter of a second, or three steps where these are longer, in addition to what it takes to make the kernels.
///
/// ```
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::{run, scene};
///
/// let small = ["space.box=[4,4,4]", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let expected = run::expected_time(&scene, &run::adapter_for(&scene, &AdapterChoice::Best)?)?;
/// assert!(expected.of_scene && expected.seconds > 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError`] if already the first steps fail: [`RunError::UnstableTrial`] if it is the scene that is unstable.
pub fn expected_time(scene: &Checked, gpu: &Gpu) -> Result<ExpectedTime, RunError> {
    let plan = plan_for(scene, gpu, Options::default());
    let fluid = scene::load("dpd-fluid", &["time.equilibration=0".to_owned(), "output={}".to_owned()])?;
    let work = |plan: &Plan| plan.operations_per_particle * plan.particles as f64;
    let relative = work(&plan) / work(&plan_for(&fluid, gpu, Options::default()));
    let nodes = scene.model().physics().nodes();
    let of_scene = relative <= MOST_WORK && nodes <= MOST_NODES;
    let timed = if of_scene {
        time_of_step(scene, gpu, Options::default())?
    } else {
        let timed = time_of_step(&fluid, gpu, Options::default())?;
        Timed { step: timed.step * relative, ..timed }
    };
    let Timed { step, steps, unstable } = timed;
    let all = scene.time.steps as f64;
    // A report visits everything once more.
    let reports: f64 = plan.samplers.iter().map(|sampler| all / sampler.every as f64).sum();
    let factor = if of_scene { FACTOR_OF_SCENE } else { FACTOR_OF_ARITHMETIC };
    let kind = usize::from(gpu.description().kind != AdapterKind::Software);
    let drawing = FIRST_PICTURE[kind] + PIXEL[kind] * Sizes::of(scene, &plan).pixels;
    Ok(ExpectedTime { seconds: step * (all + reports), drawing, step, factor, of_scene, steps, unstable })
}

/// Steps that were timed.
struct Timed {
    /// Seconds of one.
    step: f64,
    steps: u64,
    unstable: Option<Instability>,
}

/// Times steps of a scene.
fn time_of_step(scene: &Checked, gpu: &Gpu, options: Options) -> Result<Timed, RunError> {
    let model = scene.model();
    let plan = plan_for(scene, gpu, options).without_reports();
    let state = families::initial_state(scene);
    let mut engine = Engine::new(gpu, plan, &state)?;
    // The first steps list neighbours and touch memory for the first time.
    match engine.advance(2, 2).and_then(|()| engine.finish()) {
        Err(EngineError::Unstable(failure)) => {
            return Err(RunError::UnstableTrial(Instability::new(&failure, engine.plan(), model)));
        }
        // As a run does.
        Err(error) => match error.roomier(options, model.particle_count()) {
            Some(roomier) => return time_of_step(scene, gpu, roomier),
            None => return Err(error.into()),
        },
        Ok(_) => {}
    }
    let (mut done, mut steps) = (0, 1);
    let mut unstable = None;
    let start = Instant::now();
    loop {
        match engine.advance(steps, steps).and_then(|()| engine.finish()) {
            // Its steps until then are as long.
            Err(EngineError::Unstable(failure)) => {
                unstable = Some(Instability::new(&failure, engine.plan(), model));
                break;
            }
            Err(EngineError::GaveUp { .. } | EngineError::Crowded { .. } | EngineError::Unsolved { .. })
                if done > 0 =>
            {
                break;
            }
            ended => ended?,
        };
        done += steps;
        let spent = start.elapsed();
        if spent >= PATIENCE || done >= scene.time.steps.max(1) {
            break;
        }
        // As many as may fit, up to as many again twice over.
        let fit = (PATIENCE.saturating_sub(spent)).as_secs_f64() / (spent.as_secs_f64() / done as f64);
        steps = (fit as u64).clamp(1, 2 * done);
    }
    match unstable {
        Some(unstable) if done == 0 => Err(RunError::UnstableTrial(unstable)),
        unstable => Ok(Timed { step: start.elapsed().as_secs_f64() / done.max(1) as f64, steps: done, unstable }),
    }
}
