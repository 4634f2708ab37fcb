//! A kernel by itself: words in, words out.

use crate::engine::read_back;
use crate::gpu::{Gpu, GpuError, compute_pass};

/// What a kernel of workgroups of 64, with the bindings 0 to read and 1 to write, makes of words. `constants` are its own.
pub(super) fn compute(
    gpu: &Gpu,
    text: &str,
    constants: &[(&str, f64)],
    input: &[u32],
    outputs: usize,
) -> Result<Vec<u32>, GpuError> {
    let bytes = 4 * outputs as u64;
    let (bound, output, pipeline) = gpu.scoped("making a kernel that checks arithmetic", bytes, || {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let buffer = |label, size| {
            let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
            gpu.device().create_buffer(&descriptor)
        };
        let points = buffer("points", 4 * input.len() as u64);
        gpu.queue().write_buffer(&points, 0, bytemuck::cast_slice(input));
        let values = buffer("values", bytes);
        let module = gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("check"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let pipeline = gpu.device().create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("check"),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions { constants, ..Default::default() },
            cache: None,
        });
        let bound = gpu.device().create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("check"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: points.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: values.as_entire_binding() },
            ],
        });
        (bound, values, pipeline)
    })?;
    let bytes = read_back(gpu, bytes, |encoder, staging| {
        {
            let mut pass = compute_pass(encoder, "check");
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &bound, &[]);
            pass.dispatch_workgroups(outputs.div_ceil(64) as u32, 1, 1);
        }
        encoder.copy_buffer_to_buffer(&output, 0, staging, 0, bytes);
    })?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}
