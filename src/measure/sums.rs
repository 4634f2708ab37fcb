//! From the integer sums of a report to observables in real units.

use super::Observables;
use crate::engine::Sample;
use crate::families::Model;
use crate::plan::Plan;

/// The observables of one sample of the first sampler of a plan.
///
/// ```
/// use mesoscope::engine::Engine;
/// use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
/// use mesoscope::plan::{Hardware, Options};
/// use mesoscope::run::plan;
/// use mesoscope::{measure::observables_of, scene};
///
/// let small = ["space.box=[3,3,3]", r#"output={"energies":{"every":10}}"#].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let model = scene.model();
/// let start = mesoscope::families::initial_state(&scene);
/// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
/// let plan = plan(&scene, Hardware::from(&gpu), Options::default());
/// let mut engine = Engine::new(&gpu, plan, &start)?;
/// engine.advance(20, 20)?;
/// let samples = engine.finish()?;
/// let observed: Vec<_> = samples.iter().map(|sample| observables_of(sample, engine.plan(), model)).collect();
/// assert_eq!(observed.iter().map(|row| row.step).collect::<Vec<_>>(), [0, 10, 20]);
/// assert!(observed[0].kinetic_temperature() > 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn observables_of(sample: &Sample, plan: &Plan, model: &Model) -> Observables {
    model.physics().observables(sample.step, &sample.sums, plan, model)
}
