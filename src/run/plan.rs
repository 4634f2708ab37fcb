//! The plan of a run: the physics, completed with the samplers of the analyses, and suited to the memory of the adapter.

use super::analyses::{Planner, add_samplers, needs};
use crate::families::Checked;
use crate::gpu::ConstantsIn;
use crate::plan::{Hardware, Measured, Options, Plan};

/// Makes the plan of a scene.
///
/// ```
/// use mesoscope::plan::{Hardware, Options};
/// use mesoscope::run::plan;
///
/// // No device is needed to see what a run would do, nor to check its shaders.
/// let scene = mesoscope::scene::load("dpd-fluid", &[])?;
/// let plan = plan(&scene, Hardware::default(), Options::default());
/// assert_eq!((plan.particles, plan.cells), (24_000, [20, 20, 20]));
/// assert!(plan.samplers[0].due(40) && !plan.samplers[0].due(41));
/// for kernel in plan.sort.iter().chain(&plan.advance).map(|&index| &plan.kernels[index]) {
///     mesoscope::gpu::link(kernel.name, kernel.entry, &kernel.choices)?;
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn plan(scene: &Checked, hardware: Hardware, options: Options) -> Plan {
    let (model, output) = (scene.model(), &scene.output);
    let range = output.radial_distribution.as_ref().map_or(0.0, |asked| asked.range);
    let follows = model.follows_paths(output);
    let (every, needs, frames) = (output.energies.every, needs(output), output.trajectory.is_some());
    let measured = Measured { every, needs, range, follows, frames };
    let mut physics = model.physics().plan(model, &measured, hardware, options);
    add_samplers(&mut Planner::new(model, output, scene.time.equilibration, options, &mut physics));
    let mut plan = physics.plan;
    if follows {
        plan.follow(physics.followers, physics.stride);
    }
    // Runs that change none, too: kernels with folded constants may round otherwise.
    plan.constants_in = if scene.loads_numbers() { ConstantsIn::Buffer } else { options.constants_in };
    plan.count_storage_buffers();
    if options.suits_serial_memory(hardware) {
        plan.suit_serial_memory(&physics.texture_candidates);
    }
    plan.particles_at_once = options.particles_at_once;
    plan.divide(hardware.largest_binding);
    plan
}
