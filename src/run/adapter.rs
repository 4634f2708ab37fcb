//! The adapter of a run, and the plan for it.

use super::RunError;
use super::division::{Ranks, divide};
use super::plan::plan;
use crate::document::number_of_copies;
use crate::families::Checked;
use crate::gpu::{AdapterChoice, AdapterKind, Gpu, GpuError, Requirements, STORAGE_BUFFERS};
use crate::host_memory;
use crate::plan::{self, Division, Hardware, Options, Part, Plan};
use std::num::NonZero;

/// Opens an adapter that allows the buffers of a scene, for which it makes the plan.
pub(super) fn open_adapter(scene: &Checked, choice: &AdapterChoice, options: Options) -> Result<(Gpu, Plan), RunError> {
    let open = |hardware: Hardware| -> Result<(Gpu, Plan), RunError> {
        let plan = plan(scene, hardware, options);
        plan::check_precision(scene, &plan)?;
        let gpu = open_for(choice, &plan).map_err(|error| {
            // An adapter that was not asked yet may get by with less.
            let ranks = hardware.largest_binding.and_then(|_| enough_ranks(scene, choice, hardware, options));
            too_large(scene, &plan, error, ranks)
        })?;
        // No binding was too large.
        let same = hardware == Hardware { largest_binding: hardware.largest_binding, ..Hardware::from(&gpu) };
        let plan = if same { plan } else { plan_for(scene, &gpu, options) };
        check_memory(&plan, &gpu)?;
        Ok((gpu, plan))
    };
    match open(Hardware::default()) {
        // What the plan for any adapter needs this one may not: some get by with smaller buffers, or with arrays in portions.
        Err(error) if error.exceeds_adapter() => open(Hardware::from(&Gpu::open(choice, Requirements::default())?)),
        opened => opened,
    }
}

/// The plan for a device that is open, with the device.
pub(super) fn plan_on(scene: &Checked, gpu: &Gpu, options: Options) -> Result<(Gpu, Plan), RunError> {
    let plan = plan_for(scene, gpu, options);
    plan::check_precision(scene, &plan)?;
    check_memory(&plan, gpu)?;
    Ok((gpu.clone(), plan))
}

fn open_for(choice: &AdapterChoice, plan: &Plan) -> Result<Gpu, GpuError> {
    let (largest_buffer, storage_buffers) = (plan.largest_buffer(), plan.storage_buffers);
    Gpu::open(choice, Requirements { largest_buffer, storage_buffers, ..Requirements::default() })
}

/// The number of ranks, more than there are, each with such an adapter, that could share a scene: found by trying; none
/// where it cannot be shared, or not among a thousand.
fn enough_ranks(scene: &Checked, choice: &AdapterChoice, hardware: Hardware, options: Options) -> Option<NonZero<u32>> {
    let now = options.part.map_or(1, |part| part.division.ranks());
    let more = (1..=10).map_while(|doublings| now.checked_mul(1 << doublings).and_then(NonZero::new));
    let fits = |ranks: &NonZero<u32>| {
        divide(scene, Ranks::Count(ranks.get())).is_ok_and(|division| {
            let part = Some(Part { division, rank: 0 });
            open_for(choice, &plan(scene, hardware, Options { part, ..options })).is_ok()
        })
    };
    more.into_iter().find(fits)
}

/// The error of an adapter that refuses a plan, with the array that is to blame and what would fit.
fn too_large(scene: &Checked, plan: &Plan, source: GpuError, ranks: Option<NonZero<u32>>) -> RunError {
    let GpuError::TooSmall { allowed, needed, quantity, .. } = source else { return source.into() };
    let largest = plan.buffers.iter().max_by_key(|buffer| match quantity {
        STORAGE_BUFFERS => buffer.bytes,
        _ => plan.bytes_at_once(buffer),
    });
    let most = largest.and_then(|largest| plan.undivided.get(&largest.array)).copied().unwrap_or(0);
    let (allowed, needed) = (allowed.max(most).max(1), needed.max(1));
    match largest {
        // The buffers of a kernel are too many because its arrays are, or the portions of these.
        Some(largest) if quantity != STORAGE_BUFFERS || !plan.portions.is_empty() => RunError::TooLarge {
            buffer: largest.array,
            fits: (plan.particles as f64 * (allowed as f64 / needed as f64)) as u64,
            copies: scene.state.as_ref().map_or(1, |state| number_of_copies(state.copies())),
            ranks,
            source,
        },
        _ => source.into(),
    }
}

/// Refuses a plan whose particles do not fit into the memory of this machine, where that is known: they pass through it.
fn check_memory(plan: &Plan, gpu: &Gpu) -> Result<(), RunError> {
    let is_software = gpu.description().kind == AdapterKind::Software;
    let needed = plan.host_bytes().saturating_add(if is_software { plan.bytes() } else { 0 });
    match host_memory::free().filter(|free| needed > *free) {
        Some(free) => Err(RunError::Memory { particles: plan.particles, needed, free, is_software }),
        None => Ok(()),
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
