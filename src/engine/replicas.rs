//! Replicas: systems whose plans differ in numbers only, which a device advances together. Every system has an engine of its own, which
//! knows nothing of the others: its arrays are parts of theirs, and what it dispatches waits until all of them dispatch the kernel,
//! which then has a layer of workgroups for each.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use super::pipeline::{self, SideBySide, Stage};
use super::recording::Recording;
use super::stored::Stored;
use super::texels::Texels;
use crate::gpu::{ConstantsIn, Gpu, GpuError, spacing};
use crate::plan::{self, Plan, Texture};
use crate::shaders::Array;

/// Systems that are advanced together at most: 256 constants of each fit into the uniform buffer of any adapter.
pub(crate) const MOST: u64 = 64;

/// The place of a kernel among those of a run: of several that wait, the first is dispatched first, so that replicas that are apart meet again.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Moment {
    pub step: u64,
    pub phase: StepPhase,
    /// Kernels before it in the phase.
    pub position: u32,
}

/// A phase of a step, in the order of a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum StepPhase {
    Preparation,
    Paths,
    Sort,
    Report,
    Samples,
    Advance,
}

/// A kernel that waits to be dispatched: when, and its number in the plan.
pub(super) type Dispatch = (Moment, usize);

/// Systems that a device advances together.
#[doc(hidden)]
pub struct Replicas {
    gpu: Gpu,
    plan: Plan,
    buffers: HashMap<Array, Stored>,
    textures: HashMap<Array, Texels>,
    pub(super) stages: Arc<[Stage]>,
    /// Numbers of the replicas of a dispatch, on the device.
    numbers: wgpu::Buffer,
    /// Rows of a texture that each has.
    rows: u32,
    waiting: Mutex<Waiting>,
    arrival: Condvar,
}

/// Kernels that wait.
struct Waiting {
    /// Kernels that each is to dispatch; none for a replica that has left.
    dispatches: Vec<Option<VecDeque<Dispatch>>>,
    /// Replicas that the buffer of numbers names.
    numbered: Vec<u32>,
}

/// Replicas for which kernels wait.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Awaited {
    /// All that have not left.
    All,
    /// Those that wait themselves.
    WhoeverWaits,
}

/// Time for which replicas wait for one that does something else, such as drawing a picture: it catches up with them later, as kernels
/// of earlier steps come first. Batches, for whose results a replica waits, are half as long.
const PATIENCE: Duration = Duration::from_millis(300);

/// One of several systems that are advanced together; the others no longer wait for it once it is dropped.
#[doc(hidden)]
pub struct Replica {
    pub(super) group: Arc<Replicas>,
    pub(super) number: u32,
}

impl Replicas {
    /// The number of systems with this plan, of those wanted, that a device can advance together: less than two where a plan has arrays in
    /// portions, kernels whose size depends on the step, or a part of a box.
    #[must_use]
    pub fn fitting(plan: &Plan, gpu: &Gpu, wanted: usize) -> usize {
        let is_alone = plan.part.is_some() || !plan.portions.is_empty();
        if is_alone || plan.kernels.iter().any(|kernel| kernel.demand.is_some()) {
            return 1;
        }
        let limits = gpu.device.limits();
        let largest = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
        let buffers = plan.buffers.iter().map(|buffer| largest / spacing(buffer.bytes));
        let textures = plan.textures.iter().map(|texture| Texture::ROWS / u64::from(texture.size[1]));
        buffers.chain(textures).fold(MOST.min(wanted as u64), u64::min) as usize
    }

    /// Makes room for systems that are to be advanced together by a plan, and compiles its kernels.
    ///
    /// # Errors
    /// [`GpuError`] if the device has too little memory, or a kernel cannot be one of several systems.
    pub fn side_by_side(gpu: &Gpu, plan: Plan, count: u32) -> Result<Vec<Replica>, GpuError> {
        let mut buffers = HashMap::new();
        for &plan::Buffer { array, bytes, .. } in &plan.buffers {
            let bytes = spacing(bytes) * u64::from(count);
            let planned = plan::Buffer { array, bytes, contents: plan::Contents::Zeros };
            buffers.insert(array, Stored::new(gpu, &planned, None)?);
        }
        let rows = plan.textures.iter().map(|texture| texture.size[1]).max().unwrap_or(0);
        let mut textures = HashMap::new();
        for texture in &plan.textures {
            let size = [texture.size[0], rows * count];
            let planned = Texture { size, contents: plan::Contents::Zeros, ..texture.clone() };
            textures.insert(texture.array, Texels::new(gpu, &planned)?);
        }
        let numbers = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("replicas"),
            size: 16 * u64::from(count.div_ceil(4)),
            usage: wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let sizes: BTreeMap<Array, u64> = plan.buffers.iter().map(|buffer| (buffer.array, buffer.bytes)).collect();
        let side = SideBySide { count, sizes: &sizes, rows, numbers: &numbers };
        let stages = pipeline::stages(gpu, &plan, &buffers, &textures, Some(&side))?.into();
        let dispatches = vec![Some(VecDeque::new()); count as usize];
        let waiting = Mutex::new(Waiting { dispatches, numbered: Vec::new() });
        let (gpu, arrival) = (gpu.clone(), Condvar::new());
        let group = Arc::new(Self { gpu, plan, buffers, textures, stages, numbers, rows, waiting, arrival });
        Ok((0..count).map(|number| Replica { group: Arc::clone(&group), number }).collect())
    }

    fn waiting(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Dispatches kernels of a replica in their order, each together with other replicas if they come to it as well; returns once all
    /// are submitted.
    pub(super) fn dispatch(&self, number: u32, dispatches: Vec<Dispatch>) {
        let number = number as usize;
        let mut waiting = self.waiting();
        if let Some(queue) = &mut waiting.dispatches[number] {
            queue.extend(dispatches);
        }
        loop {
            self.submit_common(&mut waiting, Awaited::All);
            if waiting.dispatches[number].as_ref().is_none_or(VecDeque::is_empty) {
                return;
            }
            let waited = self.arrival.wait_timeout(waiting, PATIENCE);
            let (woken, time) = waited.unwrap_or_else(PoisonError::into_inner);
            waiting = woken;
            if time.timed_out() {
                self.submit_common(&mut waiting, Awaited::WhoeverWaits);
            }
        }
    }

    /// Submits kernels until one of the replicas that are awaited has none that waits: what it dispatches next may come first.
    fn submit_common(&self, waiting: &mut Waiting, awaited: Awaited) {
        let mut recorded: Option<(Vec<u32>, Recording)> = None;
        let each = waiting.dispatches.iter().zip(0_u32..);
        let present: Vec<u32> = each
            .filter(|(queue, _)| match awaited {
                Awaited::All => queue.is_some(),
                Awaited::WhoeverWaits => queue.as_ref().is_some_and(|queue| !queue.is_empty()),
            })
            .map(|(_, number)| number)
            .collect();
        loop {
            let front = |number: &u32| {
                let queue = waiting.dispatches[*number as usize].as_ref()?;
                Some((*number, *queue.front()?))
            };
            let next: Option<Vec<(u32, Dispatch)>> = present.iter().map(front).collect();
            let Some(next) = next else { break };
            let Some(first) = next.iter().map(|(_, dispatch)| *dispatch).min() else { break };
            let together: Vec<u32> =
                next.iter().filter(|(_, dispatch)| *dispatch == first).map(|(number, _)| *number).collect();
            for number in &together {
                waiting.dispatches[*number as usize].as_mut().and_then(VecDeque::pop_front);
            }
            if let Some((_, mut earlier)) = recorded.take_if(|(numbers, _)| *numbers != together) {
                earlier.submit();
            }
            let (_, recording) = recorded.get_or_insert_with(|| {
                if waiting.numbered != together {
                    let mut words = together.clone();
                    words.resize(together.len().next_multiple_of(4), 0);
                    self.gpu.queue.write_buffer(&self.numbers, 0, bytemuck::cast_slice(&words));
                    waiting.numbered.clone_from(&together);
                }
                (together.clone(), Recording::new(&self.gpu, "replicas"))
            });
            recording.dispatch_layers(&self.stages[first.1], together.len() as u32);
        }
        if let Some((_, mut recording)) = recorded {
            recording.submit();
            self.arrival.notify_all();
        }
    }
}

/// Buffers and textures by their arrays.
type Arrays = (HashMap<Array, Stored>, HashMap<Array, Texels>);

impl Replica {
    /// The device.
    pub(crate) fn gpu(&self) -> &Gpu {
        &self.group.gpu
    }

    /// Where the kernels of the group have their constants.
    pub(crate) fn constants_in(&self) -> ConstantsIn {
        self.group.plan.constants_in
    }

    /// True if a plan differs from that of the group in numbers only.
    #[must_use]
    pub fn suits(&self, plan: &Plan) -> bool {
        pipeline::differ_in_numbers(&self.group.plan, plan, &self.group.stages)
    }

    /// Its part of the arrays, with what a plan has in them.
    pub(super) fn arrays(&self, plan: &Plan) -> Result<Arrays, GpuError> {
        let (group, number) = (&self.group, self.number);
        let (mut buffers, mut textures) = (HashMap::new(), HashMap::new());
        for planned in &plan.buffers {
            let begin = spacing(planned.bytes) * u64::from(number);
            let own = group.buffers[&planned.array].stretch(begin, planned.bytes);
            if let Some(bytes) = planned.contents.bytes() {
                own.write(&group.gpu, 0, &bytes)?;
            }
            buffers.insert(planned.array, own);
        }
        for planned in &plan.textures {
            let own = group.textures[&planned.array].rows_from(group.rows * number, planned);
            own.fill(&group.gpu);
            textures.insert(planned.array, own);
        }
        for (stage, kernel) in group.stages.iter().zip(&plan.kernels) {
            stage.load(&group.gpu, kernel, plan, number);
        }
        Ok((buffers, textures))
    }
}

impl Drop for Replica {
    fn drop(&mut self) {
        let mut waiting = self.group.waiting();
        waiting.dispatches[self.number as usize] = None;
        // Those that have waited for it alone go on.
        self.group.submit_common(&mut waiting, Awaited::All);
        self.group.arrival.notify_all();
    }
}
