//! A kernel ready to run: pipeline, bound buffers, size.

use std::collections::HashMap;
use std::iter;
use std::num::NonZero;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::texels::Texels;
use crate::gpu::{Gpu, GpuError};
use crate::plan::{Kernel, Plan, folded};

/// A kernel ready to be recorded.
pub(super) struct Stage {
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    size: Size,
    /// As [`Kernel::takes_long`].
    pub takes_long: bool,
}

enum Size {
    Fixed([u32; 2]),
    /// A buffer and the first byte of the number of workgroups in it.
    Demanded(wgpu::Buffer, u64),
}

impl Stage {
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        match &self.size {
            Size::Fixed([width, height]) => pass.dispatch_workgroups(*width, *height, 1),
            Size::Demanded(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, *offset),
        }
    }
}

/// The buffer that holds the workgroups of kernels whose number depends on the step.
pub(super) const DEMANDS: &str = "demands";

/// The constant with which kernels of a folded dispatch number their workgroups.
const FOLD: &str = "FOLD";

/// All kernels of a plan, in its order. Drivers compile on the thread that asks, so each core asks for its share.
pub(super) fn stages(
    gpu: &Gpu,
    plan: &Plan,
    buffers: &HashMap<&'static str, wgpu::Buffer>,
    textures: &HashMap<&'static str, Texels>,
) -> Result<Vec<Stage>, GpuError> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(plan.kernels.len());
    let next = AtomicUsize::new(0);
    let make_share = || {
        let numbers = iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        let kernels = numbers.map_while(|number| Some((number, plan.kernels.get(number)?)));
        kernels.map(|(number, kernel)| (number, stage(gpu, plan, kernel, buffers, textures))).collect::<Vec<_>>()
    };
    let mut made = thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(make_share)).collect();
        let shares = workers.into_iter().map(|worker| worker.join().unwrap_or_else(|panic| resume_unwind(panic)));
        shares.flatten().collect::<Vec<_>>()
    });
    made.sort_by_key(|(number, _)| *number);
    made.into_iter().map(|(_, stage)| stage).collect()
}

fn stage(
    gpu: &Gpu,
    plan: &Plan,
    kernel: &Kernel,
    buffers: &HashMap<&'static str, wgpu::Buffer>,
    textures: &HashMap<&'static str, Texels>,
) -> Result<Stage, GpuError> {
    // A kernel's own constants take precedence over those of the plan.
    let own = |name: &str| kernel.constants.iter().any(|(known, _)| *known == name);
    let constants = kernel.constants.iter().chain(plan.constants.iter().filter(|(name, _)| !own(name)));
    let [width, height] = folded(kernel.workgroups);
    let fold = (height > 1).then_some((FOLD, f64::from(width)));
    let (pipeline, linked) = gpu.compile(kernel.name, kernel.entry, &kernel.choices, constants.copied().chain(fold))?;
    let bound = linked.bindings.iter().map(|binding| {
        let renamed = kernel.renamed.iter().find(|(variable, _)| *variable == binding.name);
        let name = renamed.map_or(binding.name.as_str(), |(_, buffer)| buffer);
        let buffer = buffers.get(name).map(wgpu::Buffer::as_entire_binding);
        let resource = buffer.or_else(|| textures.get(name).map(Texels::binding));
        let resource = resource.ok_or_else(|| GpuError::Refused {
            doing: format!("binding the buffers of kernel `{}`", kernel.name),
            reason: format!("the plan has no buffer and no texture `{name}`"),
        })?;
        Ok(wgpu::BindGroupEntry { binding: binding.number, resource })
    });
    let entries = bound.collect::<Result<Vec<_>, GpuError>>()?;
    let bindings = gpu.scoped(&format!("binding kernel `{}`", kernel.name), 0, || {
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(kernel.name),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    })?;
    let size = match (kernel.demand, buffers.get(DEMANDS)) {
        (Some(place), Some(buffer)) => Size::Demanded(buffer.clone(), 12 * u64::from(place)),
        _ => Size::Fixed([width, height]),
    };
    Ok(Stage { pipeline, bindings, size, takes_long: kernel.takes_long })
}
