//! Executes a plan: owns buffers, textures and pipelines, records many steps per submission, and reads results back while the next
//! batch runs. It knows no physics.

mod error;
mod exchange;
mod pipeline;
mod readback;
mod recording;
mod replicas;
mod shown;
mod stepper;
mod stored;
mod texels;
mod timing;

pub use error::EngineError;
pub use exchange::{Swap, Traffic};
pub(crate) use readback::read as read_back;
pub(crate) use replicas::MOST as MOST_REPLICAS;
pub use replicas::{Replica, Replicas};
pub(crate) use shown::Sampling;
pub use shown::Shown;
pub use stepper::{RankReport, Stepper};
pub use timing::{StageClock, StageTime};

use std::collections::{HashMap, VecDeque};
use std::ops::Range;
use std::sync::Arc;

use crate::gpu::{Gpu, GpuError};
use crate::plan::paths::PATH_WORDS;
use crate::plan::{self, Failure, FailureKind, Hardware, Layout, Misfit, PARTICLE_WORDS, Paths, Places, Plan, TIDYING};
use crate::shaders::Array;
use crate::state::{Reported, State, crossings};
use exchange::Exchange;
use pipeline::Stage;
use readback::Readback;
use recording::Recording;
use replicas::StepPhase;
use serde::{Deserialize, Serialize};
use stored::Stored;
use texels::Texels;

/// Words of the control buffer, as `shaders/core/control.wgsl` declares them.
#[repr(C)]
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Control {
    /// Current step, low and high word.
    pub step: [u32; 2],
    /// The step that the next sort begins.
    pub next: [u32; 2],
    /// The key of this step's random words.
    pub key: [u32; 2],
    /// Key of the whole stream.
    pub seed_key: [u32; 2],
    /// 0 at step 0; else 1.
    pub closing: i32,
    /// Sorts since the upload.
    pub elapsed: u32,
    /// Failure bits.
    pub failures: u32,
    /// `elapsed` at the first failure.
    pub failure_elapsed: u32,
    /// The first place with a failure.
    pub failure_place: u32,
    /// 1 when the neighbour list has to be rebuilt.
    pub demand: u32,
    /// Exchanges that a limit has cut, low word.
    pub limited: u32,
    /// The high word.
    pub limited_high: u32,
}

/// One row of a sampler.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sample {
    /// Index of the sampler in [`Plan::samplers`].
    pub sampler: usize,
    /// The step it belongs to.
    pub step: u64,
    /// The sums, in the units that the plan states.
    pub sums: Vec<i64>,
}

/// How far the particles are within a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Phase {
    /// Advanced, in no particular order: what a checkpoint holds.
    Advanced,
    /// Sorted into cells; `reported` once the particles by id are in place.
    Sorted { reported: bool },
}

/// A plan on a device, with its state.
///
/// ```
/// use mesoscope::engine::Engine;
/// use mesoscope::shaders::Array;
/// # use mesoscope::gpu::{AdapterChoice, Gpu, Requirements};
/// # use mesoscope::plan::{Hardware, Options};
/// # use mesoscope::run::plan;
/// # use mesoscope::scene;
/// # let small = ["space.box=[3,3,3]", "output={}"].map(str::to_owned);
/// # let scene = scene::load("dpd-fluid", &small)?;
/// # let start = mesoscope::families::initial_state(&scene);
/// # let gpu = Gpu::open(&AdapterChoice::Best, Requirements::default())?;
/// # let plan = plan(&scene, Hardware::from(&gpu), Options::default());
/// let mut engine = Engine::new(&gpu, plan, &start)?;
/// engine.advance(30, 10)?;
/// let state = engine.state()?;
/// assert_eq!((state.step, state.total_momentum()), (30, start.total_momentum()));
/// // The table of energies has a row every 20 steps.
/// let steps: Vec<u64> = engine.finish()?.iter().map(|sample| sample.step).collect();
/// assert_eq!(steps, [0, 20]);
///
/// // From the same state it computes the same, to the last bit, whatever the batches.
/// engine.upload(&start)?;
/// engine.advance(30, 7)?;
/// assert_eq!(engine.state()?, state);
///
/// // The order in which particles are stored does not matter either; any buffer of the plan can be read.
/// let backwards: Vec<usize> = (0..start.len()).rev().collect();
/// engine.upload_in_order(&start, &backwards)?;
/// assert_eq!(engine.words(Array::Particles)?[3] as usize, start.len() - 1, "the last particle is stored first");
/// engine.advance(30, 10)?;
/// assert_eq!(engine.state()?, state);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Engine<'a> {
    gpu: Gpu,
    plan: Plan,
    buffers: HashMap<Array, Stored>,
    textures: HashMap<Array, Texels>,
    stages: Arc<[Stage]>,
    /// Species of the particles, for layouts that leave them on the host.
    species: Vec<u32>,
    step: u64,
    first_step: u64,
    phase: Phase,
    /// Rows that each sampler's buffer will hold once everything submitted has run.
    pending_rows: Vec<u64>,
    in_flight: VecDeque<Readback>,
    collected: Vec<Sample>,
    /// How particles pass to other ranks and from them, if there are several.
    exchange: Option<Exchange<'a>>,
    /// Its place among systems that are advanced together, if it is one of several.
    replica: Option<Replica>,
}

/// Positions with the number of crossings of the box of some particles, by id; a state without these numbers counts as the first.
fn pack_paths(state: &State, ids: Range<usize>) -> Result<Vec<u32>, EngineError> {
    if state.images.len() != state.len() && (state.step > 0 || !state.images.is_empty()) {
        return Err(EngineError::State { reason: "the times round the box are missing".to_owned() });
    }
    let image = |id: usize| state.images.get(id).copied().unwrap_or_default();
    Ok(ids.flat_map(|id| path(state.positions[id], image(id))).collect())
}

/// The words of what is kept of a particle on its path.
fn path([x, y, z]: [u32; 3], image: [i32; 3]) -> [u32; PATH_WORDS] {
    let [across_x, across_y, across_z] = image.map(|boxes| boxes as u32);
    [x, y, z, 0, across_x, across_y, across_z, 0]
}

/// Bytes of the same.
const PATH_BYTES: u64 = 4 * PATH_WORDS as u64;

/// Batches that may wait on the device while the host continues.
const BATCHES_IN_FLIGHT: usize = 2;

/// The most bytes of a buffer for reading: any device allows as many.
const MOST_READ_AT_ONCE: u64 = 1 << 28;

impl From<&Gpu> for Hardware {
    fn from(gpu: &Gpu) -> Self {
        Self {
            subgroup_size: gpu.subgroup_size(),
            serial_memory: gpu.serial_memory(),
            queues_pairs: gpu.queues_pairs(),
            largest_binding: Some(gpu.largest_binding()),
        }
    }
}

impl<'a> Engine<'a> {
    /// Creates the buffers, textures and pipelines of a plan and uploads a state.
    ///
    /// # Errors
    /// [`EngineError`] if the device has too little memory, a shader is not valid or the state does not fit.
    pub fn new(gpu: &Gpu, plan: Plan, state: &State) -> Result<Self, EngineError> {
        let mut engine = Self::without_state(gpu, plan)?;
        engine.upload(state)?;
        Ok(engine)
    }

    /// The engine of one of several ranks, which needs its part of a state before it can advance: [`Self::upload_part`].
    ///
    /// # Errors
    /// [`EngineError`] as for [`Self::new`], or if the plan is not of a part.
    pub fn of_part(gpu: &Gpu, plan: Plan, swap: Box<dyn Swap + 'a>) -> Result<Self, EngineError> {
        let part = plan.part.clone().ok_or_else(no_part)?;
        let mut engine = Self::without_state(gpu, plan)?;
        engine.exchange = Some(Exchange::new(gpu, part, swap, &engine.buffers));
        Ok(engine)
    }

    /// Lets drivers with serial memory, which compile a kernel when it first runs, compile all of them now: other ranks that come later find
    /// them in the driver's cache.
    pub(crate) fn compile(&self) -> Result<(), EngineError> {
        if self.gpu.serial_memory() {
            pipeline::run_without_workgroups(&self.gpu, &self.stages)?;
        }
        Ok(())
    }

    fn without_state(gpu: &Gpu, plan: Plan) -> Result<Self, EngineError> {
        let stored = |buffer: &plan::Buffer| {
            let portions = plan.portions.get(&buffer.array).copied();
            Ok((buffer.array, Stored::new(gpu, buffer, portions)?))
        };
        let buffers = plan.buffers.iter().map(stored).collect::<Result<HashMap<_, _>, GpuError>>()?;
        let textures = plan.textures.iter().map(|planned| Ok((planned.array, Texels::new(gpu, planned)?)));
        let textures = textures.collect::<Result<HashMap<_, _>, GpuError>>()?;
        let stages = pipeline::stages(gpu, &plan, &buffers, &textures, None)?.into();
        Ok(Self::of_arrays(gpu, plan, buffers, textures, stages))
    }

    /// The engine of one of several systems that are advanced together, with their kernels; its plan differs from theirs in numbers only.
    ///
    /// # Errors
    /// As [`Self::new`].
    #[doc(hidden)]
    pub fn of_replica(replica: Replica, plan: Plan, state: &State) -> Result<Self, EngineError> {
        let (buffers, textures) = replica.arrays(&plan)?;
        let (gpu, stages) = (replica.gpu().clone(), Arc::clone(&replica.group.stages));
        let mut engine = Self::of_arrays(&gpu, plan, buffers, textures, stages);
        engine.replica = Some(replica);
        engine.upload(state)?;
        Ok(engine)
    }

    fn of_arrays(
        gpu: &Gpu,
        plan: Plan,
        buffers: HashMap<Array, Stored>,
        textures: HashMap<Array, Texels>,
        stages: Arc<[Stage]>,
    ) -> Self {
        let pending_rows = vec![0; plan.samplers.len()];
        Self {
            gpu: gpu.clone(),
            plan,
            buffers,
            textures,
            stages,
            species: Vec::new(),
            step: 0,
            first_step: 0,
            phase: Phase::Advanced,
            pending_rows,
            in_flight: VecDeque::new(),
            collected: Vec::new(),
            exchange: None,
            replica: None,
        }
    }

    fn recording(&self, label: &'static str) -> Recording {
        Recording::of(&self.gpu, self.replica.as_ref(), label)
    }

    /// The plan being executed.
    #[must_use]
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The current step.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.step
    }

    /// Replaces the state: positions, momenta and step. Samples of the old state that have not been taken are lost, and
    /// so are its failures: the engine starts again.
    ///
    /// # Errors
    /// [`EngineError::State`] if the number of particles is not that of the plan.
    pub fn upload(&mut self, state: &State) -> Result<(), EngineError> {
        self.upload_stored(state, None)
    }

    /// The same with the particles stored in a given order of their ids, which changes no result: a checkpoint need not keep the order
    /// of storage.
    ///
    /// # Errors
    /// [`EngineError::State`] if the number of particles is not that of the plan or the order is not one of all ids.
    pub fn upload_in_order(&mut self, state: &State, order: &[usize]) -> Result<(), EngineError> {
        let mut sorted_order = order.to_vec();
        sorted_order.sort_unstable();
        if !sorted_order.iter().copied().eq(0..state.len()) {
            let reason = "the storage order is not an order of all particles".to_owned();
            return Err(EngineError::State { reason });
        }
        self.upload_stored(state, Some(order))
    }

    fn upload_stored(&mut self, state: &State, order: Option<&[usize]>) -> Result<(), EngineError> {
        let arrays = self.plan.layout.buffers();
        let mut written = 0;
        for stretch in self.stretches(&self.plan.layout, state.len()) {
            let contents = match order {
                Some(order) => self.pack(state, &order[stretch.clone()])?,
                None => self.pack(state, &stretch.clone().collect::<Vec<_>>())?,
            };
            let count = if stretch.start == 0 { contents.len() } else { 1 };
            for (array, words) in arrays.iter().zip(&contents).take(count) {
                match self.textures.get(array) {
                    Some(texels) => texels.write(&self.gpu, words),
                    // Only of the first array is there more than one stretch.
                    None => self.buffers[array].write(&self.gpu, written, bytemuck::cast_slice(words))?,
                }
            }
            written += contents.first().map_or(0, |words| 4 * words.len() as u64);
        }
        // Else every particle comes back with its species.
        if !self.plan.layout.divides() {
            self.species.clone_from(&state.species);
        }
        if let Some(buffer) = self.buffers.get(&Paths::BUFFER) {
            for stretch in self.stretches(&self.plan.layout, state.len()) {
                let offset = PATH_BYTES * stretch.start as u64;
                buffer.write(&self.gpu, offset, bytemuck::cast_slice(&pack_paths(state, stretch)?))?;
            }
        }
        self.begin(state.step)
    }

    /// Ranges of particles that pass to the device or back together.
    fn stretches(&self, layout: &Layout, count: usize) -> impl Iterator<Item = Range<usize>> + use<> {
        let length = self.plan.stretch(layout, count as u64) as usize;
        // A state without particles has one stretch, too.
        (0..count.max(1)).step_by(length).map(move |first| first..(first + length).min(count))
    }

    /// A state as the plan has it in buffers and textures.
    pub(crate) fn pack(&self, state: &State, order: &[usize]) -> Result<Vec<Vec<u32>>, EngineError> {
        if state.len() as u64 != self.plan.particles {
            let reason = format!("{} particles, where the plan has {}", state.len(), self.plan.particles);
            return Err(EngineError::State { reason });
        }
        self.plan.layout.pack(state, order).map_err(|misfit| match misfit {
            Misfit::Crowded => EngineError::Crowded { step: state.step },
            Misfit::Missing(reason) => EngineError::State { reason },
        })
    }

    /// The same of some particles, in order of their ids.
    pub(crate) fn pack_some(&self, state: &State, ids: Range<u64>) -> Result<Vec<Vec<u32>>, EngineError> {
        self.pack(state, &(ids.start as usize..ids.end as usize).collect::<Vec<_>>())
    }

    /// The same with where all particles were last if they are followed: what [`Self::upload_part`] takes.
    pub(crate) fn pack_for_parts(&self, state: &State, ids: Range<u64>) -> Result<Vec<Vec<u32>>, EngineError> {
        let mut contents = self.pack_some(state, ids)?;
        if self.plan.paths.are_followed() {
            contents.push(pack_paths(state, 0..state.len())?);
        }
        Ok(contents)
    }

    /// Of particles as they are stored those that this rank has to know.
    pub(crate) fn needed(&self, particles: &[u32]) -> Result<Vec<u32>, EngineError> {
        Ok(self.part()?.needed(particles))
    }

    /// Leaves the other ranks, which learn of it where they wait for this one.
    pub(crate) fn leave(&mut self) {
        if let Some(mut exchange) = self.exchange.take() {
            exchange.leave();
        }
    }

    /// Replaces the state of one of several ranks, as [`Self::upload`] does, by its own particles and those that it has to know,
    /// which are given as they are stored; with the other arrays of the state, of whose sums only the first rank keeps any.
    ///
    /// # Errors
    /// [`EngineError::Crowded`] if they are more than the part can store.
    pub(crate) fn upload_part(&mut self, step: u64, particles: &[u32], others: &[Vec<u32>]) -> Result<(), EngineError> {
        let exchange = self.exchange.as_mut().ok_or_else(no_part)?;
        let bytes: &[u8] = bytemuck::cast_slice(particles);
        let buffer = &self.buffers[&Array::Particles];
        if bytes.len() as u64 > buffer.bytes() {
            return Err(EngineError::Crowded { step });
        }
        buffer.write(&self.gpu, 0, bytes)?;
        // Sums over all ranks are with the first; other arrays all ranks have.
        let first = exchange.is_first();
        let arrays = self.plan.layout.buffers().into_iter().skip(1);
        let followed = self.plan.paths.are_followed().then_some(Paths::BUFFER);
        for (array, words) in arrays.chain(followed).zip(others) {
            let mut words = words.clone();
            match array {
                _ if first || exchange.part.whole.contains(&array) => {}
                Paths::BUFFER => words.chunks_exact_mut(PATH_WORDS).for_each(|path| path[PATH_WORDS / 2..].fill(0)),
                _ => words.fill(0),
            }
            self.buffers[&array].write(&self.gpu, 0, bytemuck::cast_slice(&words))?;
        }
        exchange.begin(particles.len() as u64)?;
        self.begin(step)
    }

    /// Begins at a step, with the state in place.
    fn begin(&mut self, first: u64) -> Result<(), EngineError> {
        let clock = self.plan.steps_before.wrapping_add(first);
        let step = [clock as u32, (clock >> 32) as u32];
        let control = Control {
            step,
            next: step,
            seed_key: self.plan.seed_key,
            failure_elapsed: u32::MAX,
            failure_place: u32::MAX,
            ..Control::default()
        };
        self.buffers[&Array::Control].write(&self.gpu, 0, bytemuck::bytes_of(&control))?;
        let mut recording = self.recording("upload");
        if let Some(counts) = self.buffers.get(&Array::Counts) {
            recording.clear(counts, 0..counts.bytes());
        }
        self.step = first;
        self.first_step = first;
        recording.begin(first, StepPhase::Preparation);
        recording.dispatch_all(&self.stages, &self.plan.prepare);
        for sampler in &self.plan.samplers {
            // Rows and windows of the state before are discarded.
            recording.clear(&self.buffers[&sampler.samples], 0..8);
        }
        self.gpu.queue.submit([recording.finish().finish()]);
        self.in_flight.clear();
        self.collected.clear();
        self.phase = Phase::Advanced;
        Ok(())
    }

    /// Advances by `steps`, taking every sample that is due at the start of each step, in submissions of at most `batch`
    /// steps. Returns before the device is done; see [`Self::finish`].
    ///
    /// # Errors
    /// [`EngineError`] as soon as a finished batch shows a failure, or if the step number would overflow.
    pub fn advance(&mut self, steps: u64, batch: u64) -> Result<(), EngineError> {
        if steps > u64::MAX - self.step {
            return Err(EngineError::State {
                reason: format!("{steps} steps from step {} are more than can be numbered", self.step),
            });
        }
        let mut left = steps;
        while left > 0 {
            let now = left.min(batch.max(1));
            let mut recording = self.recording("batch");
            let mut done = 0;
            while done < now && self.room_for_samples() {
                self.record_sample(&mut recording)?;
                let reported = self.phase == Phase::Sorted { reported: true };
                self.look_ahead(self.step + 1, false)?;
                recording.begin(self.step, StepPhase::Advance);
                let kernels = if reported { &self.plan.finish_report } else { &self.plan.advance };
                record(kernels, &self.stages, &mut self.exchange, self.step, &mut recording)?;
                self.phase = Phase::Advanced;
                self.step += 1;
                done += 1;
            }
            left -= done;
            self.submit(recording.finish())?;
        }
        Ok(())
    }

    /// Takes the samples due at the current step without advancing, waits for the device, and returns all samples
    /// collected since the last call, in order.
    ///
    /// # Errors
    /// [`EngineError`] if the device failed or the run became unstable.
    pub fn finish(&mut self) -> Result<Vec<Sample>, EngineError> {
        let mut recording = self.recording("samples at the end");
        if self.plan.samplers.iter().any(|sampler| sampler.due(self.step) && !sampler.gathered) {
            self.record_sample(&mut recording)?;
        }
        self.submit(recording.finish())?;
        self.wait_all()?;
        Ok(std::mem::take(&mut self.collected))
    }

    /// Replaces the plan by another one, which differs in numbers only: in constants that kernels load from buffers,
    /// and in tables. False if it differs in more, and nothing has changed. The state has to be uploaded again.
    ///
    /// # Errors
    /// [`EngineError`] if the device failed.
    pub(crate) fn load_numbers(&mut self, plan: &Plan) -> Result<bool, EngineError> {
        // The constants of replicas lie beside each other.
        if self.replica.is_some() || !pipeline::differ_in_numbers(&self.plan, plan, &self.stages) {
            return Ok(false);
        }
        self.wait_all()?;
        for (stage, kernel) in self.stages.iter().zip(&plan.kernels) {
            stage.load(&self.gpu, kernel, plan, 0);
        }
        for (own, new) in self.plan.buffers.iter().zip(&plan.buffers) {
            if let Some(bytes) = new.contents.bytes().filter(|_| own.contents != new.contents) {
                self.buffers[&new.array].write(&self.gpu, 0, &bytes)?;
            }
        }
        for (own, new) in self.plan.textures.iter().zip(&plan.textures) {
            if let Some(bytes) = new.contents.bytes().filter(|_| own.contents != new.contents) {
                self.textures[&new.array].write(&self.gpu, &bytemuck::pod_collect_to_vec::<u8, u32>(&bytes));
            }
        }
        self.plan = plan.clone();
        Ok(true)
    }

    /// The particles as a report of this step finds them, whose state is known.
    ///
    /// # Errors
    /// As [`Self::reported`].
    pub(crate) fn report_of(&mut self, state: &State) -> Result<Reported, EngineError> {
        if !self.plan.has_buffer(Array::ReportedMomenta) {
            return self.reported();
        }
        self.report_now()?;
        let words = self.words(Array::ReportedMomenta)?;
        let momenta = words.chunks_exact(4).map(|word| [word[0], word[1], word[2]].map(u32::cast_signed)).collect();
        Ok(Reported { momenta, ..state.clone().into() })
    }

    /// Takes samples of this step by some samplers, due or not: samples at the steps at which they are due do not
    /// depend on it.
    ///
    /// # Errors
    /// As [`Self::reported`].
    pub(crate) fn take_measurements(&mut self, samplers: &[usize]) -> Result<(), EngineError> {
        self.report_now()?;
        let mut recording = self.recording("samples");
        recording.begin(self.step, StepPhase::Samples);
        for &number in samplers {
            let sampler = &self.plan.samplers[number];
            if !sampler.due(self.step) {
                recording.dispatch_all(&self.stages, &sampler.kernels);
                self.pending_rows[number] += 1;
            }
        }
        self.submit(recording.finish())
    }

    /// Samples of the batches that have finished so far, in order.
    pub(crate) fn take_samples(&mut self) -> Vec<Sample> {
        std::mem::take(&mut self.collected)
    }

    /// The state to continue from, ordered by id. Only before a sample or a report of the current step is taken, which move the particles
    /// on: after [`Self::advance`], [`Self::upload`], and [`Self::finish`] where no sample was due.
    ///
    /// # Errors
    /// [`EngineError`] if the device failed, or if the step has been sampled or reported already.
    pub fn state(&mut self) -> Result<State, EngineError> {
        self.check_advanced()?;
        self.download()
    }

    /// The same of one of several ranks: its own particles, as they are stored, and its part of what is summed over all: with
    /// that the times each particle has gone round the box, if it is followed, two words an axis.
    ///
    /// # Errors
    /// As [`Self::state`], or if the plan is of no part.
    pub(crate) fn own_state(&mut self) -> Result<Vec<Vec<u32>>, EngineError> {
        self.check_advanced()?;
        let particles = self.words(Array::Particles)?;
        let particles = self.part()?.own_of(&particles);
        self.with_sums(particles)
    }

    /// Particles, with the sums that belong to a state, and from the first rank with the arrays that all have.
    fn with_sums(&mut self, particles: Vec<u32>) -> Result<Vec<Vec<u32>>, EngineError> {
        let part = self.part()?;
        let (first, words) = (part.is_first(), part.part.particle);
        let arrays = self.plan.layout.buffers().into_iter().skip(1);
        let arrays: Vec<(Array, bool)> =
            arrays.map(|array| (array, first || !part.part.whole.contains(&array))).collect();
        let sums = arrays.into_iter().map(|(array, given)| if given { self.words(array) } else { Ok(Vec::new()) });
        let sums = sums.collect::<Result<Vec<_>, _>>()?;
        let crossed = if self.plan.paths.are_followed() {
            let paths = self.words(Paths::BUFFER)?;
            let everywhere = self.part()?.part.everywhere.filter(|_| first);
            let more = everywhere.map(|array| self.words(array)).transpose()?.unwrap_or_default();
            let counted = (self.plan.particles - self.part()?.part.shared) as usize;
            let own = [&particles[..], &more[..more.len().min(words.count * counted)]].concat();
            Some(exchange::crossed(&paths, words, &own))
        } else {
            None
        };
        Ok(std::iter::once(particles).chain(sums).chain(crossed).collect())
    }

    fn check_advanced(&self) -> Result<(), EngineError> {
        if self.phase == Phase::Advanced {
            return Ok(());
        }
        let reason = format!(
            "step {} has been sampled or reported already, which moves its particles on: read the state before, or advance",
            self.step
        );
        Err(EngineError::State { reason })
    }

    fn part(&self) -> Result<&Exchange<'a>, EngineError> {
        self.exchange.as_ref().ok_or_else(no_part)
    }

    /// What has been exchanged with other ranks.
    #[must_use]
    pub(crate) fn traffic(&self) -> Traffic {
        self.exchange.as_ref().map(|exchange| exchange.traffic).unwrap_or_default()
    }

    /// The particles at the report of the current step, ordered by id: what a snapshot shows. In a split step they are half a drift further
    /// than the forces, with the momenta of that drift.
    ///
    /// # Errors
    /// [`EngineError`] if the device failed or the run became unstable.
    pub fn reported(&mut self) -> Result<Reported, EngineError> {
        self.report_now()?;
        let Some((buffer, layout)) = self.plan.reported.clone() else { return Ok(self.download()?.into()) };
        self.wait_all()?;
        let mut state = self.unpack(&layout, &[buffer])?;
        self.complete_images(&mut state)?;
        Ok(state.into())
    }

    /// The momenta of [`Stepper::frame`] that one of several ranks knows, two words an axis, and zero for the particles
    /// of others.
    ///
    /// # Errors
    /// As [`Self::reported`], or if the plan is of no part.
    pub(crate) fn own_momenta(&mut self) -> Result<Vec<Vec<u32>>, EngineError> {
        self.part()?;
        self.report_now()?;
        let words = self.words(Array::ReportedMomenta)?;
        let wide = |word: &u32| [*word, if word.cast_signed() < 0 { u32::MAX } else { 0 }];
        Ok(vec![Vec::new(), words.chunks_exact(4).flat_map(|word| &word[..3]).flat_map(wide).collect()])
    }

    /// The same of one of several ranks: its own particles, as they are stored, and its part of what is summed over all.
    ///
    /// # Errors
    /// As [`Self::reported`], or if the plan is of no part.
    pub(crate) fn own_reported(&mut self) -> Result<Vec<Vec<u32>>, EngineError> {
        self.part()?;
        self.report_now()?;
        let (particles, counts) = (self.words(Array::Particles)?, self.words(Array::OutgoingCounts)?);
        let marks = self.plan.has_buffer(Array::OwnedSlots).then(|| self.words(Array::OwnedSlots)).transpose()?;
        let particles = self.part()?.sorted_of(&particles, marks.as_deref(), &counts);
        self.with_sums(particles)
    }

    /// Takes the samples of the current step that are measured of the particles of all ranks, which are given in the order of their ids,
    /// with how often each has crossed the box where a sampler needs that.
    pub(crate) fn measure_gathered(&mut self, particles: &[u32], images: &[[i32; 3]]) -> Result<(), EngineError> {
        let each = particles.chunks_exact(PARTICLE_WORDS as usize).zip(images);
        let paths: Vec<u32> = each.flat_map(|(words, image)| path([words[0], words[1], words[2]], *image)).collect();
        let write = |array: Array, words: &[u32]| {
            let buffer = self.buffers.get(&array).filter(|buffer| buffer.bytes() == 4 * words.len() as u64);
            let problem = || EngineError::State { reason: "the plan gathers other particles".to_owned() };
            buffer.ok_or_else(problem)?.write(&self.gpu, 0, bytemuck::cast_slice(words))?;
            Ok::<(), EngineError>(())
        };
        write(Array::Reported, particles)?;
        if self.plan.has_buffer(Array::GatheredPaths) {
            write(Array::GatheredPaths, &paths)?;
        }
        let mut recording = self.recording("samples of all ranks");
        for (number, sampler) in self.plan.samplers.iter().enumerate() {
            if sampler.gathered && sampler.due(self.step) {
                recording.dispatch_all(&self.stages, &sampler.kernels);
                self.pending_rows[number] += 1;
            }
        }
        self.submit(recording.finish())
    }

    fn report_now(&mut self) -> Result<(), EngineError> {
        let mut recording = self.recording("report");
        self.record_sample(&mut recording)?;
        self.record_report(&mut recording)?;
        self.submit(recording.finish())
    }

    /// The words of a buffer or texture of the plan, as they are once the device is done.
    ///
    /// # Errors
    /// [`EngineError`] if the device failed or the plan has no such buffer or texture.
    pub fn words(&mut self, array: Array) -> Result<Vec<u32>, EngineError> {
        self.wait_all()?;
        Ok(bytemuck::pod_collect_to_vec(&self.read(array)?))
    }

    fn read(&self, array: Array) -> Result<Vec<u8>, EngineError> {
        let bytes = match (self.buffers.get(&array), self.textures.get(&array)) {
            (Some(buffer), _) => self.read_range(buffer, 0..buffer.bytes())?,
            (None, Some(texels)) => {
                readback::read(&self.gpu, texels.bytes(), |encoder, staging| texels.copy_to(encoder, staging))?
            }
            (None, None) => {
                let reason = format!("the plan has no buffer and no texture `{}`", array.name());
                return Err(EngineError::State { reason });
            }
        };
        Ok(bytes)
    }

    /// Reads a stretch of an array, of which a readback buffer holds a part only where it is long.
    fn read_range(&self, buffer: &Stored, range: Range<u64>) -> Result<Vec<u8>, GpuError> {
        let most = self.gpu.device.limits().max_buffer_size.min(MOST_READ_AT_ONCE);
        let mut bytes = Vec::new();
        for begin in range.clone().step_by(most as usize) {
            let part = begin..range.end.min(begin + most);
            let read = readback::read(&self.gpu, part.end - part.start, |encoder, staging| {
                buffer.copy_to(encoder, part, staging, 0);
            })?;
            if bytes.is_empty() { bytes = read } else { bytes.extend_from_slice(&read) }
        }
        Ok(bytes)
    }

    fn download(&mut self) -> Result<State, EngineError> {
        self.wait_all()?;
        let mut state = self.unpack(&self.plan.layout, &self.plan.layout.buffers())?;
        if state.species.is_empty() {
            state.species.clone_from(&self.species);
        }
        self.complete_images(&mut state)?;
        Ok(state)
    }

    /// The state in some arrays, of which all that is submitted has run.
    fn unpack(&self, layout: &Layout, arrays: &[Array]) -> Result<State, EngineError> {
        let wrong = |reason| EngineError::State { reason };
        let count = self.plan.particles as usize;
        let (&first, others) = arrays.split_first().ok_or_else(|| wrong("the plan has no state".to_owned()))?;
        let others = others.iter().map(|array| self.read(*array)).collect::<Result<Vec<_>, _>>()?;
        let mut contents: Vec<&[u32]> = vec![&[]];
        contents.extend(others.iter().map(|bytes| bytemuck::cast_slice::<u8, u32>(bytes)));
        let Some(buffer) = self.buffers.get(&first).filter(|_| layout.divides()) else {
            let bytes = self.read(first)?;
            contents[0] = bytemuck::cast_slice(&bytes);
            return layout.unpack(self.step, &contents, count).map_err(wrong);
        };
        let mut state = layout.begin(self.step, &contents, count).map_err(wrong)?;
        let mut places = Places::of(count);
        let particle = 4 * u64::from(PARTICLE_WORDS);
        for stretch in self.stretches(layout, count).filter(|stretch| !stretch.is_empty()) {
            let range = particle * stretch.start as u64..particle * stretch.end as u64;
            let bytes = self.read_range(buffer, range)?;
            layout.place(bytemuck::cast_slice(&bytes), &mut places, &mut state).map_err(wrong)?;
        }
        Ok(state)
    }

    /// Adds how often the particles have crossed the box, if that is counted.
    fn complete_images(&mut self, state: &mut State) -> Result<(), EngineError> {
        if !self.plan.paths.are_followed() {
            return Ok(());
        }
        self.wait_all()?;
        let buffer = &self.buffers[&Paths::BUFFER];
        state.images.reserve_exact(state.len());
        for stretch in self.stretches(&self.plan.layout, state.len()).filter(|stretch| !stretch.is_empty()) {
            let range = PATH_BYTES * stretch.start as u64..PATH_BYTES * stretch.end as u64;
            let bytes = self.read_range(buffer, range)?;
            let words: &[u32] = bytemuck::cast_slice(&bytes);
            let paths = words.chunks_exact(PATH_WORDS).zip(&state.positions[stretch]);
            state.images.extend(paths.map(|(path, position)| {
                let since = crossings([path[0], path[1], path[2]], *position);
                std::array::from_fn::<_, 3, _>(|axis| path[4 + axis].cast_signed() + since[axis])
            }));
        }
        Ok(())
    }

    /// Whether the particles are sorted in memory at the current step.
    fn tidies(&self) -> bool {
        let has_gaps = self.exchange.as_ref().is_some_and(Exchange::has_gaps);
        !self.plan.tidy.is_empty() && (has_gaps || (self.step - self.first_step).is_multiple_of(TIDYING))
    }

    /// Sorts, unless that has been done, and takes the samples that are due.
    fn record_sample(&mut self, recording: &mut Recording) -> Result<(), EngineError> {
        if self.phase != Phase::Advanced {
            // Already sorted: the samples of this step have been taken.
            return Ok(());
        }
        if self.plan.paths.are_followed() && (self.step - self.first_step).is_multiple_of(self.plan.paths.every) {
            recording.begin(self.step, StepPhase::Paths);
            recording.dispatch_all(&self.stages, &self.plan.paths.kernels);
        }
        recording.begin(self.step, StepPhase::Sort);
        let tidy = if self.tidies() { self.plan.tidy.as_slice() } else { &[] };
        for kernels in [self.plan.sort.as_slice(), tidy, self.plan.before_report.as_slice()] {
            record(kernels, &self.stages, &mut self.exchange, self.step, recording)?;
        }
        self.phase = Phase::Sorted { reported: false };
        let here = |&sampler: &usize| {
            let sampler = &self.plan.samplers[sampler];
            sampler.due(self.step) && !sampler.gathered
        };
        let due: Vec<usize> = (0..self.plan.samplers.len()).filter(here).collect();
        if due.iter().any(|&sampler| self.plan.samplers[sampler].needs_report) {
            self.record_report(recording)?;
        }
        recording.begin(self.step, StepPhase::Samples);
        for sampler in due {
            recording.dispatch_all(&self.stages, &self.plan.samplers[sampler].kernels);
            self.pending_rows[sampler] += 1;
        }
        Ok(())
    }

    fn record_report(&mut self, recording: &mut Recording) -> Result<(), EngineError> {
        if self.phase == (Phase::Sorted { reported: false }) {
            self.look_ahead(self.step, true)?;
            if self.exchange.is_some()
                && let Some(momenta) = self.buffers.get(&Array::ReportedMomenta)
            {
                // What other ranks report now is theirs alone.
                recording.clear(momenta, 0..momenta.bytes());
            }
            recording.begin(self.step, StepPhase::Report);
            record(&self.plan.report, &self.stages, &mut self.exchange, self.step, recording)?;
            self.phase = Phase::Sorted { reported: true };
        }
        Ok(())
    }

    /// Lets the exchange that is recorded next bring what samples of a step need that look further than forces reach: the one within the
    /// report, where they are taken after it, or the one before the step.
    fn look_ahead(&mut self, step: u64, in_report: bool) -> Result<(), EngineError> {
        let Some(exchange) = &mut self.exchange else { return Ok(()) };
        let due = |sampler: &usize| {
            let sampler = self.plan.samplers.get(*sampler);
            sampler.is_some_and(|sampler| sampler.needs_report == in_report && sampler.due(step))
        };
        let wider = self.plan.part.as_ref().and_then(|part| part.wider.as_ref());
        Ok(exchange.widen(wider.is_some_and(|wider| wider.samplers.iter().any(due)))?)
    }

    fn room_for_samples(&self) -> bool {
        self.plan.samplers.iter().zip(&self.pending_rows).all(|(sampler, rows)| rows + 1 < sampler.capacity)
    }

    /// Submits a batch with the readback of its samples, and collects older batches if too many wait.
    fn submit(&mut self, encoder: wgpu::CommandEncoder) -> Result<(), EngineError> {
        let readback = Readback::begin(&self.gpu, encoder, &self.plan, &self.buffers, &self.pending_rows)?;
        self.pending_rows.fill(0);
        self.in_flight.push_back(readback);
        while self.in_flight.len() > BATCHES_IN_FLIGHT {
            self.collect_oldest()?;
        }
        Ok(())
    }

    pub(crate) fn wait_all(&mut self) -> Result<(), EngineError> {
        while !self.in_flight.is_empty() {
            self.collect_oldest()?;
        }
        Ok(())
    }

    fn collect_oldest(&mut self) -> Result<(), EngineError> {
        let Some(readback) = self.in_flight.pop_front() else { return Ok(()) };
        let (control, samples) = readback.collect(&self.gpu, &self.plan)?;
        self.check(&control)?;
        self.collected.extend(samples);
        Ok(())
    }

    fn check(&self, control: &Control) -> Result<(), EngineError> {
        if let Some(step) = self.exchange.as_ref().and_then(|exchange| exchange.crowded) {
            return Err(EngineError::Crowded { step });
        }
        if control.failures == 0 {
            return Ok(());
        }
        let step = self.first_step + u64::from(control.failure_elapsed.max(1) - 1);
        let failure = Failure { step, bits: control.failures, place: control.failure_place };
        if failure.is(FailureKind::Frames) {
            return Err(EngineError::Crowded { step });
        }
        // Failures that follow from an unfinished solution are none of the scene.
        if failure.is(FailureKind::Iterations) {
            return Err(EngineError::Unsolved { step });
        }
        if failure.is(FailureKind::Reach) {
            // Who knows the whole box misses nobody.
            if self.exchange.as_ref().is_some_and(Exchange::knows_all) {
                return Err(EngineError::Ranks { reason: "particles were lost between ranks".to_owned() });
            }
            return Err(EngineError::Overreached { step });
        }
        if failure.is(FailureKind::Loops) {
            return Err(EngineError::GaveUp { step, adapter: self.gpu.description().name.clone() });
        }
        Err(EngineError::Unstable(failure))
    }
}

pub(crate) fn no_part() -> EngineError {
    EngineError::State { reason: "the plan is of no part".to_owned() }
}

/// Records kernels, and exchanges with other ranks what they ask for.
fn record(
    kernels: &[usize],
    stages: &[Stage],
    exchange: &mut Option<Exchange<'_>>,
    step: u64,
    recording: &mut Recording,
) -> Result<(), EngineError> {
    for &kernel in kernels {
        recording.dispatch(&stages[kernel]);
        if let Some(exchange) = exchange {
            exchange.follow(kernel, recording, step)?;
        }
    }
    Ok(())
}
