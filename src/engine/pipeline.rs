//! A kernel ready to run: pipeline, bound buffers, size.

use std::collections::{BTreeMap, HashMap};
use std::iter;
use std::num::NonZero;
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::stored::Stored;
use super::texels::Texels;
use crate::gpu::{
    CompiledKernel, Gpu, GpuError, LOADED_CONSTANTS, Places, REPLICA_NUMBERS, Replicas, compute_pass,
    constants_in_bytes,
};
use crate::plan::{Kernel, Plan, folded};
use crate::shaders::{Array, Constant};

/// A kernel ready to be recorded.
pub(super) struct Stage {
    /// Its place in the plan.
    pub number: usize,
    pipeline: wgpu::ComputePipeline,
    bindings: wgpu::BindGroup,
    size: Size,
    /// As [`Kernel::takes_long`].
    pub takes_long: bool,
    /// Constants that were compiled into it.
    compiled_in: Arc<[Constant]>,
    /// Constants that it loads, if it does.
    loaded: Option<Loaded>,
}

enum Size {
    Fixed([u32; 2]),
    /// A buffer and the first byte of the number of workgroups in it.
    Demanded(wgpu::Buffer, u64),
}

impl Stage {
    /// Dispatches it, with a layer of workgroups for each of several systems.
    pub(super) fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>, layers: u32) {
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.bindings, &[]);
        match &self.size {
            Size::Fixed([width, height]) => pass.dispatch_workgroups(*width, *height, layers),
            Size::Demanded(buffer, offset) => pass.dispatch_workgroups_indirect(buffer, *offset),
        }
    }
}

/// Runs every kernel without a workgroup: a driver that compiles kernels when they first run has then compiled them.
pub(super) fn run_without_workgroups(gpu: &Gpu, stages: &[Stage]) -> Result<(), GpuError> {
    let mut encoder = gpu.encoder("kernels without workgroups");
    let mut pass = compute_pass(&mut encoder, "kernels without workgroups");
    for stage in stages {
        pass.set_pipeline(&stage.pipeline);
        pass.set_bind_group(0, &stage.bindings, &[]);
        pass.dispatch_workgroups(0, 0, 0);
    }
    drop(pass);
    gpu.wait_for(gpu.queue.submit([encoder.finish()]))
}

/// Arrays of several systems, side by side.
pub(super) struct SideBySide<'a> {
    /// Number of systems.
    pub count: u32,
    /// Bytes that each has in a buffer of an array.
    pub sizes: &'a BTreeMap<Array, u64>,
    /// Rows that each has in a texture.
    pub rows: u32,
    /// The buffer of the numbers of those that a dispatch advances.
    pub numbers: &'a wgpu::Buffer,
}

/// All kernels of a plan, in its order. Drivers compile on the thread that asks, so each core asks for its share.
pub(super) fn stages(
    gpu: &Gpu,
    plan: &Plan,
    buffers: &HashMap<Array, Stored>,
    textures: &HashMap<Array, Texels>,
    beside: Option<&SideBySide<'_>>,
) -> Result<Vec<Stage>, GpuError> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get).min(plan.kernels.len());
    let next = AtomicUsize::new(0);
    let make_share = || {
        let numbers = iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        let numbers = numbers.take_while(|number| *number < plan.kernels.len());
        numbers.map(|number| (number, stage(gpu, plan, number, buffers, textures, beside))).collect::<Vec<_>>()
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
    number: usize,
    buffers: &HashMap<Array, Stored>,
    textures: &HashMap<Array, Texels>,
    beside: Option<&SideBySide<'_>>,
) -> Result<Stage, GpuError> {
    let kernel = &plan.kernels[number];
    let [width, height] = folded(kernel.workgroups);
    // By which kernels of a folded dispatch number their workgroups.
    let fold = (height > 1).then_some((Constant::Fold, f64::from(width)));
    let constants = kernel.constants_in(plan).chain(fold);
    let values: HashMap<Constant, f64> = constants.collect();
    let bytes_of = |variable| beside?.sizes.get(&kernel.array_of(variable)).copied();
    let replicas = beside.map(|&SideBySide { count, rows, .. }| Replicas { count, bytes_of: &bytes_of, rows });
    let places = Places {
        constants: plan.constants_in,
        portions_of: &|variable| plan.portions.get(&kernel.array_of(variable)).copied(),
        replicas: replicas.as_ref(),
    };
    let compiled = gpu.compile(kernel.name, kernel.entry, &kernel.choices, values.clone().into_iter(), &places)?;
    let CompiledKernel { pipeline, bindings, constants: compiled_in, loaded } = compiled;
    let loaded = Loaded::new(gpu, kernel, loaded, beside.map_or(1, |beside| beside.count));
    if let (Some(loaded), None) = (&loaded, beside) {
        loaded.write(gpu, &values, 0);
    }
    let bound = bindings.iter().map(|binding| {
        let array = kernel.array_of(binding.array);
        let buffer = buffers.get(&array).map(|stored| stored.portion(binding.portion).as_entire_binding());
        let resource = buffer.or_else(|| textures.get(&array).map(Texels::binding));
        let resource = resource.ok_or_else(|| GpuError::Refused {
            doing: format!("binding the buffers of kernel `{}`", kernel.name),
            reason: format!("the plan has no buffer and no texture `{}`", array.name()),
        })?;
        Ok(wgpu::BindGroupEntry { binding: binding.number, resource })
    });
    let mut entries = bound.collect::<Result<Vec<_>, GpuError>>()?;
    entries.extend(
        loaded.as_ref().map(|loaded| wgpu::BindGroupEntry {
            binding: LOADED_CONSTANTS,
            resource: loaded.buffer.as_entire_binding(),
        }),
    );
    entries.extend(beside.map(|SideBySide { numbers, .. }| wgpu::BindGroupEntry {
        binding: REPLICA_NUMBERS,
        resource: numbers.as_entire_binding(),
    }));
    let group = gpu.scoped(&format!("binding kernel `{}`", kernel.name), 0, || {
        gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(kernel.name),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        })
    })?;
    let size = match (kernel.demand, buffers.get(&Array::Demands)) {
        (Some(place), Some(stored)) => Size::Demanded(stored.portion(0).clone(), 12 * u64::from(place)),
        _ => Size::Fixed([width, height]),
    };
    Ok(Stage { number, pipeline, bindings: group, size, takes_long: kernel.takes_long, compiled_in, loaded })
}

/// Constants that a kernel loads.
pub(super) struct Loaded {
    buffer: wgpu::Buffer,
    constants: Arc<[Constant]>,
}

impl Loaded {
    /// Those of some systems, if a kernel loads any.
    fn new(gpu: &Gpu, kernel: &Kernel, constants: Arc<[Constant]>, count: u32) -> Option<Self> {
        let bytes = constants_in_bytes(&constants, &HashMap::new()).len() as u64;
        (bytes > 0).then(|| {
            let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(kernel.name),
                size: bytes * u64::from(count),
                usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            Self { buffer, constants }
        })
    }

    /// Writes those of a system.
    fn write(&self, gpu: &Gpu, values: &HashMap<Constant, f64>, system: u32) {
        let bytes = constants_in_bytes(&self.constants, values);
        gpu.queue.write_buffer(&self.buffer, bytes.len() as u64 * u64::from(system), &bytes);
    }
}

impl Stage {
    /// True if the constants of the kernel of a plan differ from those of another at most where they are not compiled into this one.
    pub(super) fn suits(&self, kernels: [&Kernel; 2], plans: [&Plan; 2]) -> bool {
        let [mut one_has, mut other_has] = [0, 1].map(|side| {
            let all = kernels[side].constants_in(plans[side]);
            let compiled_in = all.filter(|(constant, _)| self.compiled_in.contains(constant));
            compiled_in.map(|(constant, value)| (constant.name(), value.to_bits())).collect::<Vec<_>>()
        });
        one_has.sort_unstable();
        other_has.sort_unstable();
        one_has == other_has
    }

    /// Loads the constants of a plan from now on, in place of those of one of several systems.
    pub(super) fn load(&self, gpu: &Gpu, kernel: &Kernel, plan: &Plan, system: u32) {
        if let Some(loaded) = &self.loaded {
            loaded.write(gpu, &kernel.constants_in(plan).collect(), system);
        }
    }
}

/// True if plans differ in numbers only: in constants that the kernels of the first one load from buffers, and in tables.
pub(super) fn differ_in_numbers(own: &Plan, new: &Plan, stages: &[Stage]) -> bool {
    let mut kernels = own.kernels.iter().zip(&new.kernels).zip(stages);
    own.differs_in_numbers(new) && kernels.all(|((old, kernel), stage)| stage.suits([old, kernel], [own, new]))
}
