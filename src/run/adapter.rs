//! The adapter of a run, and the plan for it.

use super::RunError;
use super::plan::plan;
use crate::document::number_of_copies;
use crate::families::Checked;
use crate::gpu::{AdapterChoice, Gpu, GpuError, Requirements};
use crate::plan::{self, Division, Hardware, Options, Part, Plan};

/// Opens an adapter that allows the buffers of a scene, for which it makes the plan.
pub(super) fn open_adapter(scene: &Checked, choice: &AdapterChoice, options: Options) -> Result<(Gpu, Plan), RunError> {
    let open = |hardware| {
        let plan = plan(scene, hardware, options);
        plan::check_precision(scene, &plan)?;
        let (largest_buffer, storage_buffers) = (plan.largest_buffer(), plan.storage_buffers);
        let opened = Gpu::open(choice, Requirements { largest_buffer, storage_buffers, ..Requirements::default() });
        let gpu = opened.map_err(|error| match plan.buffers.iter().max_by_key(|buffer| buffer.bytes) {
            Some(largest) if matches!(error, GpuError::TooSmall { .. }) => {
                let copies = scene.state.as_ref().map_or(1, |state| number_of_copies(state.copies()));
                RunError::TooLarge { source: error, buffer: largest.array, copies }
            }
            _ => error.into(),
        })?;
        let plan = if Hardware::from(&gpu) == hardware { plan } else { plan_for(scene, &gpu, options) };
        Ok((gpu, plan))
    };
    match open(Hardware::default()) {
        // What the plan for any adapter needs this one may not: some get by with smaller buffers.
        Err(RunError::TooLarge { .. }) => open(Hardware::from(&Gpu::open(choice, Requirements::default())?)),
        opened => opened,
    }
}

/// Opens the adapter that a run of this scene would open.
///
/// ```
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::{run, scene};
///
/// let gpu = run::adapter_for(&scene::load("dpd-fluid", &[])?, &AdapterChoice::Best)?;
/// println!("{}", gpu.description().name);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError::Gpu`] without an adapter that allows its buffers, [`RunError::Scene`] if its numbers are beyond single precision.
pub fn adapter_for(scene: &Checked, choice: &AdapterChoice) -> Result<Gpu, RunError> {
    Ok(open_adapter(scene, choice, Options::default())?.0)
}

/// Opens the adapter that the first of the ranks that share this scene would open, where each has its own part of the box.
///
/// # Errors
/// As [`adapter_for`].
pub fn adapter_for_rank(scene: &Checked, division: Option<Division>, choice: &AdapterChoice) -> Result<Gpu, RunError> {
    let options = Options { part: division.map(|division| Part { division, rank: 0 }), ..Options::default() };
    Ok(open_adapter(scene, choice, options)?.0)
}

/// The plan of a scene on an adapter.
pub(super) fn plan_for(scene: &Checked, gpu: &Gpu, options: Options) -> Plan {
    plan(scene, gpu.into(), options)
}
