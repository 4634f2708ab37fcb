//! Whether a product and a sum can be rounded once on a device.

use std::sync::OnceLock;

use mesoscope::gpu::Gpu;

use super::kernel;

const KERNEL: &str = "
    @group(0) @binding(0) var<storage, read_write> numbers: array<f32, 4>;
    @compute @workgroup_size(1)
    fn main() { numbers[3] = fma(numbers[0], numbers[1], numbers[2]); }";

/// Whether contraction can be played on the adapter of the tests: by double precision, or by the built-in `fma` where it rounds
/// once, which WGSL leaves to drivers. Says so where it cannot.
pub fn can_contract(gpu: &Gpu) -> bool {
    static FUSED: OnceLock<bool> = OnceLock::new();
    let fused = *FUSED.get_or_init(|| is_fused(gpu));
    let can = fused || gpu.device().features().contains(wgpu::Features::SHADER_F64);
    if !can {
        println!("skipped: neither does `fma` round once on this adapter nor has it double precision");
    }
    can
}

/// Whether `fma` rounds once: (1 + 2⁻¹²)² - 1 - 2⁻¹¹ is 2⁻²⁴, and with the product rounded by itself it is 0.
fn is_fused(gpu: &Gpu) -> bool {
    let factor = 1.0 + 2_f32.powi(-12);
    let numbers = [factor, factor, -1.0 - 2_f32.powi(-11), 7.0];
    let found = kernel::run(gpu, wgpu::ShaderSource::Wgsl(KERNEL.into()), &[], &numbers, 1)[3];
    assert!(found.abs() <= 2_f32.powi(-23), "fma gives {found}");
    found == 2_f32.powi(-24)
}
