//! Whether a product and a sum can be rounded once on a device.

use std::sync::OnceLock;

use mesoscope::gpu::Gpu;

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
    let device = gpu.device();
    let size = 16;
    let buffer =
        |usage| device.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false });
    let numbers = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST);
    let staging = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
    let factor = 1.0 + 2_f32.powi(-12);
    gpu.queue().write_buffer(&numbers, 0, bytemuck::cast_slice(&[factor, factor, -1.0 - 2_f32.powi(-11), 7.0]));
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: None,
        source: wgpu::ShaderSource::Wgsl(KERNEL.into()),
    });
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: wgpu::PipelineCompilationOptions::default(),
        cache: None,
    });
    let bindings = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &pipeline.get_bind_group_layout(0),
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: numbers.as_entire_binding() }],
    });
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    {
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &bindings, &[]);
        pass.dispatch_workgroups(1, 1, 1);
    }
    encoder.copy_buffer_to_buffer(&numbers, 0, &staging, 0, size);
    gpu.queue().submit([encoder.finish()]);
    staging.slice(..).map_async(wgpu::MapMode::Read, |mapped| mapped.unwrap());
    device.poll(wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = staging.slice(..).get_mapped_range().unwrap();
    let found = bytemuck::pod_collect_to_vec::<u8, f32>(&bytes)[3];
    assert!(found.abs() <= 2_f32.powi(-23), "fma gives {found}");
    found == 2_f32.powi(-24)
}
