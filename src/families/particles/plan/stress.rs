//! What reports leave for analyses of the stress.

use crate::families::Model;
use crate::plan::{Kernel, Measured, Need, Plan};
use crate::shaders::{Array, Choices, Constant, Entry};

/// Words of a particle: two symmetric tensors.
const WORDS: u64 = 12;

/// Whether an analysis needs the stress.
pub(crate) fn is_needed(measured: &Measured) -> bool {
    measured.needs(Need::Stresses)
}

/// Adds the array of stresses and the kernel that clears it, which comes before those that add to it.
pub(crate) fn begin(model: &Model, workgroup: u64, plan: &mut Plan) -> usize {
    plan.stress_unit = unit(model);
    plan.constants.push((Constant::Stress, 1.0 / longest(model)));
    plan.add_buffer(Array::ReportedStresses, 4 * WORDS * model.particle_count());
    let groups = model.particle_count().div_ceil(workgroup).max(1);
    plan.add_kernel(Kernel::new("clear_stresses", Entry::ClearStresses, Choices::new(), groups))
}

/// The unit of the virials of a particle: half of an impulse of half a step times a length.
pub(crate) fn unit(model: &Model) -> f64 {
    model.units.momentum / model.time_step * longest(model)
}

/// At least twice the length over which anything acts, a power of two. The impulses on a particle are less than 2³⁰ units
/// together, or its run ends, and with it its stress fits 32 bits in units of an impulse times this.
fn longest(model: &Model) -> f64 {
    let particles = model.particles();
    let cutoff = particles.pair_force.as_ref().map_or(1.0, |force| force.cutoff);
    let bonded = particles.bonds.is_some() || particles.angles.is_some();
    let diagonal =
        model.units.lengths[..model.units.dimension].iter().map(|length| length * length).sum::<f64>().sqrt();
    let reach = if bonded { cutoff.max(0.5 * diagonal) } else { cutoff };
    2.0 * reach.log2().ceil().exp2()
}
