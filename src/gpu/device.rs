//! An opened adapter.

use std::sync::{Arc, Mutex};

use super::adapter::{self, AdapterChoice, AdapterDescription};
use super::compiled::{Compiled, Rewriting};
use super::environment::RequestedPlans;
use super::error::GpuError;

/// What a plan needs beyond the limits of every WebGPU adapter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Requirements {
    /// The largest storage buffer in bytes.
    pub largest_buffer: u64,
    /// The most storage buffers that one kernel binds.
    pub storage_buffers: u32,
    /// Whether to ignore what only some adapters have, subgroups and the serial memory of software adapters: the plans are then
    /// those for any GPU. So they are wherever the environment has `MESOSCOPE_PLAN=gpu`.
    pub portable: bool,
}

/// A limit of an adapter that is too low.
#[derive(Debug, PartialEq, Eq)]
struct Shortage {
    quantity: &'static str,
    allowed: u64,
    needed: u64,
}

impl Shortage {
    fn of(self, adapter: String) -> GpuError {
        let Self { quantity, allowed, needed } = self;
        GpuError::TooSmall { adapter, quantity, allowed, needed }
    }
}

/// The quantity that is short if a kernel binds too many arrays or portions of them.
pub(crate) const STORAGE_BUFFERS: &str = "storage buffers in a kernel";

/// Lanes of the largest workgroup, and the bytes that it shares: every adapter with compute shaders allows these.
const LANES: u32 = 256;
const SHARED_BYTES: u32 = 16_384;

/// The most uniform buffers that one kernel binds: numbers that it loads, and those of replicas.
const UNIFORM_BUFFERS: u32 = 2;

/// The limits to request, as far as an adapter has them.
fn limits(offered: &wgpu::Limits, requirements: Requirements) -> Result<wgpu::Limits, Shortage> {
    let mut limits = wgpu::Limits::default().or_worse_values_from(offered);
    let enough = |quantity, allowed: u64, needed: u64| {
        if allowed < needed { Err(Shortage { quantity, allowed, needed }) } else { Ok(()) }
    };
    let bytes = requirements.largest_buffer;
    let buffers = requirements.storage_buffers;
    enough("bytes in a storage buffer", offered.max_storage_buffer_binding_size, bytes)?;
    enough("bytes in a buffer", offered.max_buffer_size, bytes)?;
    enough(STORAGE_BUFFERS, storage_buffers(offered).into(), buffers.into())?;
    enough("lanes in a workgroup", offered.max_compute_invocations_per_workgroup.into(), LANES.into())?;
    enough("bytes shared by a workgroup", offered.max_compute_workgroup_storage_size.into(), SHARED_BYTES.into())?;
    limits.max_storage_buffer_binding_size = limits.max_storage_buffer_binding_size.max(bytes);
    limits.max_buffer_size = limits.max_buffer_size.max(bytes);
    limits.max_storage_buffers_per_shader_stage = limits.max_storage_buffers_per_shader_stage.max(buffers);
    limits.max_buffers_and_acceleration_structures_per_shader_stage =
        limits.max_buffers_and_acceleration_structures_per_shader_stage.max(buffers.saturating_add(UNIFORM_BUFFERS));
    Ok(limits)
}

/// The storage buffers that one kernel may bind, beside uniform ones.
fn storage_buffers(limits: &wgpu::Limits) -> u32 {
    let all = limits.max_buffers_and_acceleration_structures_per_shader_stage;
    limits.max_storage_buffers_per_shader_stage.min(all.saturating_sub(UNIFORM_BUFFERS))
}

/// What kernels use where lanes load and store one after the other: eight bytes at a time, and textures that are loaded from
/// and stored to as buffers are.
const SERIAL_FEATURES: wgpu::Features =
    wgpu::Features::SHADER_INT64.union(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);

/// The most textures that one kernel binds there.
const STORAGE_TEXTURES: u32 = 8;

/// An opened device with its queue. A clone is another handle of the same device, which closes with the last of them.
///
/// ```
/// use mesoscope::prelude::*;
///
/// // Two simulations share a device, and its compiled kernels.
/// let scene = scene::load("dpd-fluid", &["space.box=[4,4,4]", "output={}"].map(str::to_owned))?;
/// let first = Simulation::new(&scene, &AdapterChoice::Best)?;
/// let gpu: Gpu = first.gpu().clone();
/// let mut second = Simulation::on(&gpu, &scene)?;
/// drop((first, gpu));
/// second.advance(10)?;
/// # Ok::<(), RunError>(())
/// ```
#[derive(Clone)]
pub struct Gpu {
    adapter: wgpu::Adapter,
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    description: Arc<AdapterDescription>,
    subgroup_size: Option<u32>,
    serial_memory: bool,
    portable: bool,
    queues_pairs: bool,
    pub(super) compiled: Arc<Compiled>,
    trouble: Arc<Mutex<Option<String>>>,
}

/// A compute pass with a name.
pub(crate) fn compute_pass<'a>(encoder: &'a mut wgpu::CommandEncoder, label: &str) -> wgpu::ComputePass<'a> {
    encoder.begin_compute_pass(&wgpu::ComputePassDescriptor { label: Some(label), timestamp_writes: None })
}

impl Gpu {
    /// A command encoder with a name.
    pub(crate) fn encoder(&self, label: &str) -> wgpu::CommandEncoder {
        self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some(label) })
    }

    /// Opens an adapter with WebGPU's core limits, raised only where `requirements` ask for it. Limits that no kernel needs, such as the
    /// size of textures, may be lower.
    ///
    /// ```
    /// use mesoscope::gpu::{AdapterChoice, Gpu, GpuError, Requirements, list_adapters};
    ///
    /// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
    /// assert_eq!(gpu.description(), &list_adapters()[0]);
    /// gpu.health()?;
    ///
    /// let missing = Gpu::open(&AdapterChoice::parse(Some("no such adapter")), Requirements::default());
    /// assert!(matches!(missing, Err(GpuError::NoSuchAdapter { .. })));
    /// # Ok::<(), GpuError>(())
    /// ```
    ///
    /// # Errors
    /// [`GpuError`] if there is no such adapter, if it cannot meet the requirements or if it does not open, and if the environment
    /// requests plans that are unknown.
    pub fn open(choice: &AdapterChoice, requirements: Requirements) -> Result<Self, GpuError> {
        Self::open_with(adapter::choose(choice)?, requirements, None)
    }

    /// Opens the adapter once more, for other requirements. Plans are of the kind that this device gets, and kernels are rewritten as for it.
    ///
    /// ```
    /// use mesoscope::gpu::{AdapterChoice, Gpu, GpuError, Requirements};
    ///
    /// let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
    /// let impossible = Requirements { storage_buffers: u32::MAX, ..Requirements::default() };
    /// assert!(matches!(gpu.reopen(impossible), Err(GpuError::TooSmall { .. })));
    /// # Ok::<(), GpuError>(())
    /// ```
    ///
    /// # Errors
    /// [`GpuError`] if the adapter cannot meet the requirements or does not open.
    pub fn reopen(&self, requirements: Requirements) -> Result<Self, GpuError> {
        let requirements = Requirements { portable: self.portable || requirements.portable, ..requirements };
        Self::open_with(self.adapter.clone(), requirements, self.compiled.rewriting())
    }

    /// Whether the device meets requirements.
    #[must_use]
    pub(crate) fn meets(&self, requirements: Requirements) -> bool {
        let limits = self.device.limits();
        requirements.storage_buffers <= storage_buffers(&limits)
            && requirements.largest_buffer <= limits.max_storage_buffer_binding_size.min(limits.max_buffer_size)
            && (self.portable || !requirements.portable)
    }

    /// The same, but every kernel is rewritten before a pipeline is made from it.
    ///
    /// With this a test emulates another compiler: `rewriting` gets each linked module and the features of the device, which
    /// has double precision wherever the adapter has, and may change arithmetic as drivers do, say by contracting products
    /// and sums. It must leave the bindings as they are.
    ///
    /// ```
    /// use std::sync::{Arc, Mutex};
    ///
    /// use mesoscope::engine::Engine;
    /// use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
    /// # use mesoscope::plan::{Hardware, Options};
    /// # use mesoscope::run::plan;
    /// # use mesoscope::scene;
    ///
    /// let seen = Arc::new(Mutex::new(0));
    /// let counter = Arc::clone(&seen);
    /// let rewriting = Arc::new(move |_: &mut naga::Module, _| *counter.lock().unwrap() += 1);
    /// let gpu = Gpu::open_rewriting(&AdapterChoice::Best, Requirements::default(), rewriting)?;
    /// # let scene = scene::load("dpd-fluid", &["space.box=[3,3,3]", "output={}"].map(str::to_owned))?;
    /// # let start = mesoscope::families::initial_state(&scene);
    /// # let plan = plan(&scene, Hardware::from(&gpu), Options::default());
    /// let engine = Engine::new(&gpu, plan, &start)?;
    /// assert!(*seen.lock().unwrap() > 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::open`].
    pub fn open_rewriting(
        choice: &AdapterChoice,
        requirements: Requirements,
        rewriting: Rewriting,
    ) -> Result<Self, GpuError> {
        Self::open_with(adapter::choose(choice)?, requirements, Some(rewriting))
    }

    fn open_with(
        adapter: wgpu::Adapter,
        requirements: Requirements,
        rewriting: Option<Rewriting>,
    ) -> Result<Self, GpuError> {
        let requested = RequestedPlans::from_environment()?;
        let portable = requested != RequestedPlans::Suitable || requirements.portable;
        let info = adapter.get_info();
        let offered = adapter.limits();
        let mut limits = limits(&offered, requirements).map_err(|shortage| shortage.of(info.name.clone()))?;
        let texels = |format| {
            let flags = adapter.get_texture_format_features(format).flags;
            flags.contains(wgpu::TextureFormatFeatureFlags::STORAGE_READ_WRITE)
        };
        let serial_memory = !portable
            && info.device_type == wgpu::DeviceType::Cpu
            && adapter.features().contains(SERIAL_FEATURES)
            && offered.max_storage_textures_per_shader_stage >= STORAGE_TEXTURES
            && [wgpu::TextureFormat::Rgba32Uint, wgpu::TextureFormat::Rg32Uint].into_iter().all(texels);
        if serial_memory {
            limits.max_storage_textures_per_shader_stage = STORAGE_TEXTURES;
        }
        // Only these have subgroups work on eight particles together.
        let subgroups = serial_memory && adapter.features().contains(wgpu::Features::SUBGROUP);
        let timestamps = adapter.features() & wgpu::Features::TIMESTAMP_QUERY;
        let wanted = |feature, usable| if usable { feature } else { wgpu::Features::empty() };
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            label: Some("mesoscope"),
            required_features: timestamps
                | wanted(adapter.features() & wgpu::Features::SHADER_F64, rewriting.is_some())
                | wanted(wgpu::Features::SUBGROUP, subgroups)
                | wanted(SERIAL_FEATURES, serial_memory),
            required_limits: limits,
            ..Default::default()
        }))
        .map_err(|error| GpuError::Open { adapter: info.name.clone(), reason: error.to_string() })?;
        let trouble = Arc::new(Mutex::new(None));
        let note = Arc::clone(&trouble);
        device.on_uncaptured_error(Arc::new(move |error: wgpu::Error| record(&note, error.to_string())));
        let note = Arc::clone(&trouble);
        device.set_device_lost_callback(move |reason, message| {
            if reason != wgpu::DeviceLostReason::Destroyed {
                record(&note, message);
            }
        });
        Ok(Self {
            adapter,
            device,
            queue,
            description: Arc::new(AdapterDescription::new(&info)),
            subgroup_size: (subgroups && info.subgroup_min_size == info.subgroup_max_size)
                .then_some(info.subgroup_min_size),
            serial_memory,
            portable,
            queues_pairs: requested == RequestedPlans::PortableWithQueue,
            compiled: Arc::new(Compiled::new(rewriting)),
            trouble,
        })
    }

    /// The description of the adapter.
    #[must_use]
    pub fn description(&self) -> &AdapterDescription {
        &self.description
    }

    /// The device, for drawing.
    #[must_use]
    pub fn device(&self) -> &wgpu::Device {
        &self.device
    }

    /// The queue, for drawing.
    #[must_use]
    pub fn queue(&self) -> &wgpu::Queue {
        &self.queue
    }

    /// The number of lanes of every subgroup, if it is fixed and subgroup operations are used, which they are where memory is serial.
    #[must_use]
    pub fn subgroup_size(&self) -> Option<u32> {
        self.subgroup_size
    }

    /// Whether lanes load and store one after the other. Kernels may then load and store eight bytes at a time, and read from and write to
    /// the same texture.
    #[must_use]
    pub fn serial_memory(&self) -> bool {
        self.serial_memory
    }

    /// True if the environment requests with `MESOSCOPE_PLAN=gpu-queue` that the lanes of a workgroup share a queue of pairs.
    #[must_use]
    pub fn queues_pairs(&self) -> bool {
        self.queues_pairs
    }

    /// Bytes of the largest array that a kernel can bind, if the device is opened for it.
    #[must_use]
    pub fn largest_binding(&self) -> u64 {
        let offered = self.adapter.limits();
        offered.max_storage_buffer_binding_size.min(offered.max_buffer_size)
    }

    /// Waits until a submission has run.
    ///
    /// # Errors
    /// [`GpuError::Lost`] with the driver's message.
    pub(crate) fn wait_for(&self, submission: wgpu::SubmissionIndex) -> Result<(), GpuError> {
        let all_before = wgpu::PollType::Wait { submission_index: Some(submission), timeout: None };
        let lost = |error: wgpu::PollError| GpuError::Lost {
            adapter: self.description.name.clone(),
            reason: error.to_string(),
        };
        self.device.poll(all_before).map(|_| ()).map_err(lost)
    }

    /// True if linked modules are rewritten before pipelines are made from them.
    pub(crate) fn is_rewriting(&self) -> bool {
        self.compiled.rewriting().is_some()
    }

    /// The first error that reached no error scope, or the loss of the device.
    ///
    /// # Errors
    /// [`GpuError::Lost`] with the driver's message.
    pub fn health(&self) -> Result<(), GpuError> {
        match self.trouble.lock().ok().and_then(|trouble| trouble.clone()) {
            Some(reason) => Err(GpuError::Lost { adapter: self.description.name.clone(), reason }),
            None => Ok(()),
        }
    }

    /// Runs `work` inside error scopes, and turns what they catch into a typed error.
    ///
    /// # Errors
    /// [`GpuError::OutOfMemory`] or [`GpuError::Refused`].
    pub(crate) fn scoped<T>(&self, doing: &str, bytes: u64, work: impl FnOnce() -> T) -> Result<T, GpuError> {
        let memory = self.device.push_error_scope(wgpu::ErrorFilter::OutOfMemory);
        let validation = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let made = work();
        let refused = pollster::block_on(validation.pop());
        let starved = pollster::block_on(memory.pop());
        if starved.is_some() {
            return Err(GpuError::OutOfMemory {
                adapter: self.description.name.clone(),
                doing: doing.to_owned(),
                bytes,
            });
        }
        match refused {
            Some(error) => Err(GpuError::Refused { doing: doing.to_owned(), reason: error.to_string() }),
            None => Ok(made),
        }
    }
}

fn record(note: &Mutex<Option<String>>, message: String) {
    if let Ok(mut slot) = note.lock() {
        slot.get_or_insert(message);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_adapters_open_and_large_scenes_need_large_ones() {
        let usual = wgpu::Limits::default();
        let none = Requirements::default();
        assert_eq!(limits(&usual, none), Ok(usual.clone()));
        // As the graphics processor of a Raspberry Pi: textures of 4096 texels, which computing does not need.
        let small = wgpu::Limits { max_texture_dimension_2d: 4096, max_texture_dimension_1d: 4096, ..usual.clone() };
        assert_eq!(limits(&small, none), Ok(small.clone()));

        let shortage = |offered: &wgpu::Limits, requirements| limits(offered, requirements).err();
        let bytes = usual.max_storage_buffer_binding_size;
        let large = Requirements { largest_buffer: bytes + 1, ..none };
        let (quantity, allowed, needed) = ("bytes in a storage buffer", bytes, bytes + 1);
        assert_eq!(shortage(&usual, large), Some(Shortage { quantity, allowed, needed }));
        let roomy =
            wgpu::Limits { max_storage_buffer_binding_size: 2 * bytes, max_buffer_size: 4 * bytes, ..usual.clone() };
        let raised = wgpu::Limits { max_storage_buffer_binding_size: bytes + 1, ..usual.clone() };
        assert_eq!(limits(&roomy, large), Ok(raised));
        assert_eq!(limits(&roomy, none), Ok(usual.clone()), "no more than is needed");

        let nine = Requirements { storage_buffers: 9, ..none };
        let (quantity, allowed, needed) = ("storage buffers in a kernel", 8, 9);
        assert_eq!(shortage(&usual, nine), Some(Shortage { quantity, allowed, needed }));
        let narrow = wgpu::Limits { max_compute_invocations_per_workgroup: 128, ..usual };
        let (quantity, allowed, needed) = ("lanes in a workgroup", 128, 256);
        assert_eq!(shortage(&narrow, none), Some(Shortage { quantity, allowed, needed }));
    }
}
