//! One kernel ready to run: pipeline, bound buffers, size.

use std::collections::HashMap;

use crate::gpu::{self, Gpu, GpuError};
use crate::plan::{Kernel, Plan};

/// A kernel ready to be recorded.
pub(super) struct Stage {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    workgroups: [u32; 2],
}

impl Stage {
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        pass.dispatch_workgroups(self.workgroups[0], self.workgroups[1], 1);
    }
}

/// Folds a number of workgroups into two dimensions of at most 65 535; a few of them may find nothing to do.
pub(super) fn fold(workgroups: u32) -> [u32; 2] {
    const LIMIT: u32 = 65_535;
    if workgroups <= LIMIT {
        [workgroups, 1]
    } else {
        let height = workgroups.div_ceil(LIMIT);
        [workgroups.div_ceil(height), height]
    }
}

pub(super) fn stage(
    gpu: &Gpu,
    plan: &Plan,
    kernel: &Kernel,
    buffers: &HashMap<&'static str, wgpu::Buffer>,
) -> Result<Stage, GpuError> {
    let linked = gpu::link(kernel.name, &kernel.modules)?;
    let constants: Vec<(&str, f64)> = kernel
        .constants
        .iter()
        .chain(&plan.constants)
        .filter(|(name, _)| linked.overrides.iter().any(|known| known == name))
        .copied()
        .collect();
    let mut entries = Vec::new();
    for binding in &linked.bindings {
        let name = kernel
            .renamed
            .iter()
            .find(|(variable, _)| *variable == binding.name)
            .map_or(binding.name.as_str(), |(_, buffer)| buffer);
        let buffer = buffers.get(name).ok_or_else(|| GpuError::Refused {
            doing: format!("binding the buffers of kernel `{}`", kernel.name),
            reason: format!("the plan has no buffer `{name}`"),
        })?;
        entries.push(wgpu::BindGroupEntry { binding: binding.number, resource: buffer.as_entire_binding() });
    }
    let (pipeline, bindings) = gpu.scoped(&format!("making kernel `{}`", kernel.name), 0, || {
        let module = gpu.device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(kernel.name),
            source: wgpu::ShaderSource::Naga(std::borrow::Cow::Owned(linked.module)),
        });
        let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(kernel.name),
            layout: None,
            module: &module,
            entry_point: Some("main"),
            compilation_options: wgpu::PipelineCompilationOptions {
                constants: &constants,
                // Every kernel writes workgroup memory before it reads it.
                zero_initialize_workgroup_memory: false,
            },
            cache: None,
        });
        let bindings = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(kernel.name),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        (pipeline, bindings)
    })?;
    Ok(Stage { pipeline, bindings, workgroups: fold(kernel.workgroups) })
}

#[cfg(test)]
mod tests {
    use super::fold;

    #[test]
    fn folding_covers_every_workgroup() {
        for count in [1, 65_535, 65_536, 131_071, 1_000_000, 20_000_000] {
            let [width, height] = fold(count);
            assert!(width <= 65_535 && height <= 65_535);
            assert!(u64::from(width) * u64::from(height) >= u64::from(count));
        }
    }
}
