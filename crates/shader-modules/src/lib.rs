//! Shader modules whose loops are compiled as they are written.
//!
//! wgpu adds a counter of 64 bits to every loop, which ends the loop after 2⁶⁴ turns: to compilers a loop without end is
//! undefined behaviour, from which they may conclude anything. The counter costs two instructions and a branch a turn,
//! and compilers do not unroll what has it: the search for neighbours has one load in flight where four could be.

/// A module without these counters. Bounds of arrays and integer divisions are checked as usual.
///
/// Every loop of every kernel in the module has to end. mesoscope calls it with kernels of its own library of shaders
/// only, of which a test (`tests/shaders/loops.rs`) knows every loop: most count to a bound that is not changed
/// in the loop; the argument for each of the others stands beside the loop, after `Ends:`. Kernels with a loop whose end
/// follows from geometry do not come here.
#[must_use]
pub fn module_without_loop_counters(
    device: &wgpu::Device,
    module: wgpu::ShaderModuleDescriptor<'_>,
) -> wgpu::ShaderModule {
    let checks = wgpu::ShaderRuntimeChecks { force_loop_bounding: false, ..wgpu::ShaderRuntimeChecks::checked() };
    // SAFETY: wgpu requires of the caller what a check that is left out would ensure: here that loops end, see above.
    unsafe { device.create_shader_module_trusted(module, checks) }
}
