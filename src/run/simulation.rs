//! A scene on a device, advanced step by step.

use super::RunError;
use super::adapter::{open_adapter, plan_for};
use super::analyses::stress_of_sample;
use super::colour_ranges::ColourRanges;
use super::division::{Ranks, divide};
use super::energy_rows::EnergyRows;
use super::frame::{Frame, Here, with_flow};
use super::pace::{self, Pace};
use super::pictures::{mesh_depth, most_shown};
use super::runs::ranks;
use super::sections::Sections;
use super::settling;
use super::tally::Carried;
use super::team::team;
use super::views::Views;
use crate::engine::{Engine, EngineError, RankReport, Replica, Replicas, Sample, Shown, Stepper};
use crate::families::pictures::MeshPictures;
use crate::families::{self, Checked, Instability, PictureKind};
use crate::gpu::{AdapterChoice, AdapterDescription, ConstantsIn, Gpu};
use crate::measure::statistics::Estimate;
use crate::measure::{Field, observables_of};
use crate::output::summary::{AdapterSummary, ColumnSummary, StartSummary, Summary};
use crate::output::{Checkpoint, Id, TrajectoryWriter, checkpoint, files};
use crate::plan::{Division, Options, Part, SamplerId};
use crate::run::Interrupt;
use crate::scene::{AnalysisId, Change, FieldQuantity, Output, Trajectory, TrajectoryFormat};
use crate::state::State;
use crate::table::Table;
use crate::tessellation::Tessellation;
use image::RgbaImage;
use std::iter;
use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::path::Path;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

/// Name of the section of a checkpoint that keeps the times of steps.
const TIMES: &str = "times";

/// Steps that are repeated at most where an array turns out too small.
const STEPS_BETWEEN_STATES: u64 = 4096;

/// A scene on a device, advanced by a given number of steps at a time; between steps its state can be read and changed.
///
/// A simulation writes no file by itself, and of the measurements of a [`Run`](super::Run) it makes the rows of the table
/// of energies only. Reading its state changes no bit of the steps that follow. The device closes when the last
/// simulation on it is dropped.
///
/// ```
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::{Simulation, scene};
///
/// let small = ["space.box=[4,4,4]", r#"output={"energies": {"every": 10}}"#].map(str::to_owned);
/// let mut simulation = Simulation::new(&scene::load("dpd-fluid", &small)?, &AdapterChoice::Best)?;
/// simulation.advance(200)?;
/// let speeds = simulation.frames(100, 20).map(|frame| {
///     let fastest = frame?.velocities.iter().map(|[x, y, z]| (x * x + y * y + z * z).sqrt()).fold(0.0, f64::max);
///     Ok(fastest)
/// });
/// let speeds = speeds.collect::<Result<Vec<f64>, mesoscope::run::RunError>>()?;
/// assert_eq!((speeds.len(), simulation.step()), (5, 300));
/// assert!(simulation.observable("temperature")?.is_some_and(|temperature| temperature > 0.5));
/// // Rows of the table of energies are kept, every ten steps.
/// assert_eq!(simulation.energies().rows.len(), 31);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Simulation {
    pub(super) scene: Checked,
    /// The scene as it is planned: with what can be looked at, and no analysis besides.
    planned: Checked,
    place: Place,
    options: Options,
    pub(super) engine: Box<dyn Stepper>,
    /// The counts of the device when the engine began.
    carried: Carried,
    rows: EnergyRows,
    /// Where to begin again if an array turns out too small, and what had been counted there.
    saved: Arc<State>,
    counted: Carried,
    pace: Pace,
    interrupt: Interrupt,
    /// Samples of the last step that was sampled.
    sampled: Vec<Sample>,
    /// The energies and the state of the current step, as far as they have been read.
    here: Option<Here>,
    pub(super) changes: Vec<Change>,
    /// How often an engine was opened.
    openings: u32,
    /// Why no further step can be taken.
    end: Option<String>,
}

/// The devices of a simulation.
#[derive(Clone)]
struct Place {
    /// The device, of several ranks that of the first.
    gpu: Gpu,
    shared: Option<Shared>,
}

/// A division of the box among ranks, each with an adapter of a choice.
#[derive(Debug, Clone)]
struct Shared {
    division: Division,
    choice: AdapterChoice,
}

/// The end of an advance.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stop {
    /// At the step that was requested.
    Reached,
    /// It was asked to stop, or its time was up.
    Interrupted,
}

/// The kinds of readings besides the rows of the table of energies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sight {
    /// Frames with velocities and images.
    Frames,
    /// Nothing.
    EnergiesAlone,
}

impl Sight {
    /// The scene with what a plan needs for it.
    fn planned(self, scene: &Checked) -> Checked {
        scene.clone().changed(|scene| {
            let Output { energies, stress, .. } = std::mem::take(&mut scene.output);
            scene.output.energies = energies;
            if self == Self::Frames {
                scene.output.stress = stress;
                scene.output.trajectory = Some(Trajectory::every(u64::MAX));
            }
        })
    }
}

impl Simulation {
    /// A simulation of a scene at its start, on an adapter.
    ///
    /// # Errors
    /// [`RunError`] if there is no usable adapter, or the start cannot be.
    pub fn new(scene: &Checked, choice: &AdapterChoice) -> Result<Self, RunError> {
        Self::on_ranks(scene, choice, 1)
    }

    /// The same on several ranks, threads of this process with an adapter each, which divide the box: all numbers are
    /// those of one rank, to the last bit.
    ///
    /// ```
    /// use mesoscope::prelude::*;
    ///
    /// let scene = scene::load("dpd-fluid", &["space.box=[3,3,12]", "output={}"].map(str::to_owned))?;
    /// let mut alone = Simulation::new(&scene, &AdapterChoice::Best)?;
    /// let mut shared = Simulation::on_ranks(&scene, &AdapterChoice::Best, 2)?;
    /// alone.advance(20)?;
    /// shared.advance(20)?;
    /// assert_eq!(shared.observables()?, alone.observables()?);
    /// assert_eq!(shared.state()?, alone.state()?);
    /// # Ok::<(), RunError>(())
    /// ```
    ///
    /// # Errors
    /// [`RunError::Unshared`] and [`RunError::Undividable`] if the ranks cannot share the scene, and as [`Self::new`].
    pub fn on_ranks(scene: &Checked, choice: &AdapterChoice, ranks: u32) -> Result<Self, RunError> {
        let place = Place::new(&Sight::Frames.planned(scene), choice, ranks)?;
        Self::at_start(Sight::Frames, place, scene, None)
    }

    /// A simulation of a scene at its start, on a device that is open, which several simulations may share.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn on(gpu: &Gpu, scene: &Checked) -> Result<Self, RunError> {
        Self::at_start(Sight::Frames, Place { gpu: gpu.clone(), shared: None }, scene, None)
    }

    /// Simulations of scenes that differ in their seeds, of which only this can be seen; the device advances up to `most` of them together.
    pub(crate) fn side_by_side(
        sight: Sight,
        gpu: &Gpu,
        scenes: &[Checked],
        most: usize,
    ) -> Result<Vec<Self>, RunError> {
        let begin = |scene: &Checked, replica: Option<Replica>| {
            Self::at_start(sight, Place { gpu: gpu.clone(), shared: None }, scene, replica)
        };
        let alone = || scenes.iter().map(|scene| begin(scene, None)).collect();
        let [first, _, ..] = scenes else { return alone() };
        let plan = plan_for(&sight.planned(first), gpu, Options::default());
        let fitting = Replicas::fitting(&plan, gpu, most);
        if fitting < 2 {
            return alone();
        }
        thread::scope(|scope| {
            let mut begun = Vec::new();
            for group in scenes.chunks(fitting) {
                // Where the device has too little memory for them together, each tries for itself.
                let replicas = Replicas::side_by_side(gpu, plan.clone(), group.len() as u32).unwrap_or_default();
                let replicas = replicas.into_iter().map(Some).chain(iter::repeat_with(|| None));
                // Replicas wait for each other where they begin, too.
                begun.extend(
                    group.iter().zip(replicas).map(|(scene, replica)| scope.spawn(move || begin(scene, replica))),
                );
            }
            begun.into_iter().map(|begun| begun.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
        })
    }

    fn at_start(sight: Sight, place: Place, scene: &Checked, replica: Option<Replica>) -> Result<Self, RunError> {
        if !scene.stages.is_empty() {
            let text = "stages: a simulation takes its steps from its program; accepted: a scene without `stages`, and `set` between steps";
            return Err(RunError::Arrays { mistakes: vec![text.to_owned()] });
        }
        let state = families::initial_state(scene);
        families::check_start(scene, &state)?;
        Self::from_state(sight, place, scene, replica, state, Carried::default(), Vec::new())
    }

    /// A simulation that goes on from a checkpoint: of another one, or of a run. Rows of the table of energies begin there.
    ///
    /// # Errors
    /// [`RunError::Checkpoint`] where there is no checkpoint or it is damaged, and as [`Self::new`].
    pub fn from_checkpoint(path: impl AsRef<Path>, choice: &AdapterChoice) -> Result<Self, RunError> {
        Self::from_checkpoint_on_ranks(path, choice, 1)
    }

    /// The same on several ranks, how many ever the checkpoint is from.
    ///
    /// # Errors
    /// As [`Self::from_checkpoint`] and [`Self::on_ranks`].
    pub fn from_checkpoint_on_ranks(
        path: impl AsRef<Path>,
        choice: &AdapterChoice,
        ranks: u32,
    ) -> Result<Self, RunError> {
        let path = path.as_ref();
        let Checkpoint { scene, mut state, sections, .. } = checkpoint::load(path)?;
        let mut scene = scene.part_of(state.step)?;
        if let Some((_, times)) = sections.iter().find(|(name, _)| name == TIMES) {
            let times = serde_json::from_slice(times).map_err(|error| {
                checkpoint::CheckpointError::malformed(path, format!("its section `{TIMES}` is none ({error})"))
            })?;
            scene = scene.with_times(times);
        }
        let planned = Sight::Frames.planned(&scene);
        if planned.model().follows_paths(&planned.output) && state.images.is_empty() {
            // The state of a run that followed no particle.
            state.images = vec![[0; 3]; state.len()];
        }
        let place = Place::new(&planned, choice, ranks)?;
        if let Some(problem) = plan_for(&planned, &place.gpu, Options::default()).misfit(&state, scene.model()) {
            return Err(checkpoint::CheckpointError::malformed(path, problem).into());
        }
        let carried = Carried::new(scene.model(), &Sections::new(path, state.step, &sections))?;
        let changes = Change::from_sections(&sections);
        Self::from_state(Sight::Frames, place, &scene, None, state, carried, changes)
    }

    fn from_state(
        sight: Sight,
        place: Place,
        scene: &Checked,
        replica: Option<Replica>,
        state: State,
        carried: Carried,
        changes: Vec<Change>,
    ) -> Result<Self, RunError> {
        let planned = sight.planned(scene);
        // Kernels of the steps that follow are those that the changes left.
        let is_changed = changes.iter().any(Change::is_of_number);
        let constants_in = if is_changed { ConstantsIn::Buffer } else { ConstantsIn::Code };
        let options = Options { part: place.part(), constants_in, ..Options::default() };
        let together = replica.and_then(|replica| {
            let plan = plan_for(&planned, &place.gpu, options);
            replica.suits(&plan).then(|| Engine::of_replica(replica, plan, &state).ok())?
        });
        let (engine, options) = match together {
            Some(engine) => (Box::new(engine) as Box<dyn Stepper>, options),
            None => place.open(&planned, &state, options)?,
        };
        let (particles, operations) = (scene.model().particle_count(), engine.plan().operations_per_particle);
        let pace = match sight {
            Sight::Frames => Pace::for_looking(particles, operations),
            Sight::EnergiesAlone => Pace::new(particles, operations),
        };
        Ok(Self {
            rows: EnergyRows::new(scene),
            scene: scene.clone(),
            planned,
            place,
            options,
            engine,
            counted: carried.clone(),
            carried,
            saved: Arc::new(state),
            pace,
            interrupt: Interrupt::default(),
            sampled: Vec::new(),
            here: None,
            changes,
            openings: 1,
            end: None,
        })
    }

    /// The same, which stops advancing when it is asked to.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// The scene, as changes have left it.
    #[must_use]
    pub fn scene(&self) -> &Checked {
        &self.scene
    }

    /// The adapter.
    #[must_use]
    pub fn adapter(&self) -> &AdapterDescription {
        self.place.gpu.description()
    }

    /// The device, on which further simulations may run.
    #[must_use]
    pub fn gpu(&self) -> &Gpu {
        &self.place.gpu
    }

    /// How often an engine was opened: at the start, and again by changes for which the kernels of the last one do not
    /// suffice.
    #[doc(hidden)]
    #[must_use]
    pub fn openings(&self) -> u32 {
        self.openings
    }

    /// The ranks that share the simulation, if there are several.
    #[must_use]
    pub fn ranks(&self) -> &[RankReport] {
        self.engine.ranks()
    }

    /// The current step.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.engine.step()
    }

    /// The time of the current step, in units of the scene.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.scene.model().time.at(self.step())
    }

    /// Takes steps, and returns when the device has done them. It may go beyond the steps of the scene.
    ///
    /// # Errors
    /// [`RunError`] if the device fails, the simulation becomes unstable, or it is asked to stop: then it can go on.
    pub fn advance(&mut self, steps: u64) -> Result<(), RunError> {
        let last = self.step().saturating_add(steps);
        match self.advance_to(last, None)? {
            Stop::Reached => Ok(()),
            Stop::Interrupted => Err(RunError::Paused { step: self.step() }),
        }
    }

    /// Takes at most so many steps within about this time, at least one, and returns how many.
    ///
    /// # Errors
    /// As [`Self::advance`].
    pub fn advance_within(&mut self, steps: u64, time: Duration) -> Result<u64, RunError> {
        let first = self.step();
        self.advance_to(first.saturating_add(steps), Some(Instant::now() + time))?;
        Ok(self.step() - first)
    }

    /// Frames of the next steps, every so many of them, of every one where that is 0; the last step has one.
    pub fn frames(&mut self, steps: u64, every: u64) -> Frames<'_> {
        let last = self.step().saturating_add(steps);
        Frames { simulation: self, last, every: every.max(1) }
    }

    /// Goes on until a step, or until the time is up.
    pub(crate) fn advance_to(&mut self, last: u64, deadline: Option<Instant>) -> Result<Stop, RunError> {
        self.check_end()?;
        if self.step() < last {
            self.here = None;
        }
        loop {
            match self.submit(last, deadline) {
                Ok(()) if self.step() >= last => return Ok(Stop::Reached),
                Ok(()) => return Ok(Stop::Interrupted),
                Err(error) => self.make_room(error)?,
            }
        }
    }

    /// Begins again from where it was saved, with more room, as a run does; every other error ends it.
    fn make_room(&mut self, error: EngineError) -> Result<(), RunError> {
        let particles = self.scene.model().particle_count();
        let Some(options) = error.roomier(self.options, particles) else { return Err(self.ended(error)) };
        (self.engine, self.options) = self.place.open(&self.planned, &self.saved, options)?;
        self.carried = self.counted.clone();
        Ok(())
    }

    /// Saves the current step.
    fn save(&mut self) -> Result<(), EngineError> {
        self.saved = Arc::new(self.engine.state()?);
        self.counted = self.carried.advanced(self.scene.model(), &mut *self.engine)?;
        Ok(())
    }

    /// Submits batches until a step or a time, and waits for them.
    fn submit(&mut self, last: u64, deadline: Option<Instant>) -> Result<(), EngineError> {
        let first = self.engine.step();
        let Self { engine, pace, saved, counted, carried, interrupt, scene, .. } = self;
        let mut samples = Vec::new();
        let advanced = pace::advance(&mut **engine, pace, last, &mut |engine, _, advanced| {
            samples.extend(engine.take_samples());
            advanced?;
            if engine.step() - saved.step >= STEPS_BETWEEN_STATES {
                *saved = Arc::new(engine.state()?);
                *counted = carried.advanced(scene.model(), engine)?;
            }
            let is_over = interrupt.is_asked() || deadline.is_some_and(|deadline| Instant::now() >= deadline);
            Ok::<_, EngineError>(if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        });
        // Samples from before a failure are good.
        self.add_samples(samples);
        advanced?;
        self.engine.wait()?;
        if self.engine.step() > first && self.engine.plan().samplers[0].due(self.engine.step()) {
            // A sample moves the particles of split steps on, whose state is needed to look at them.
            self.save()?;
            self.take_samples();
            let samples = self.engine.finish()?;
            self.add_samples(samples);
        }
        self.pace.finished();
        self.take_samples();
        Ok(())
    }

    /// Takes samples that have come in.
    fn take_samples(&mut self) {
        let samples = self.engine.take_samples();
        self.add_samples(samples);
    }

    /// Adds rows to the table of energies; what is repeated has some already.
    fn add_samples(&mut self, samples: Vec<Sample>) {
        for sample in samples {
            let is_new = self.rows.last_step().is_none_or(|step| sample.step > step);
            if sample.sampler == 0 && is_new && self.engine.plan().samplers[0].due(sample.step) {
                let observables = self.observables_in(&sample);
                self.rows.add(&observables);
            }
            self.sampled.retain(|known| known.step == sample.step && known.sampler != sample.sampler);
            self.sampled.push(sample);
        }
    }

    fn observables_in(&self, sample: &Sample) -> families::Observables {
        let model = self.scene.model();
        let mut observables = observables_of(sample, self.engine.plan(), model);
        self.carried.complete(model, &mut observables);
        observables
    }

    /// Closes a simulation whose engine failed.
    fn ended(&mut self, error: EngineError) -> RunError {
        let error = match error {
            EngineError::Unstable(failure) => {
                RunError::UnstableTrial(Instability::new(&failure, self.engine.plan(), self.scene.model()))
            }
            error => error.into(),
        };
        self.end = Some(error.to_string());
        error
    }

    fn check_end(&self) -> Result<(), RunError> {
        self.end.clone().map_or(Ok(()), |reason| Err(RunError::Ended { reason }))
    }

    /// Looks at the current step, once.
    pub(super) fn here(&mut self) -> Result<&Here, RunError> {
        self.check_end()?;
        while self.here.is_none() {
            let step = self.step();
            match self.look() {
                Ok(here) => self.here = Some(here),
                Err(error) => {
                    self.make_room(error)?;
                    self.advance(step - self.step())?;
                }
            }
        }
        self.here.as_ref().ok_or_else(|| RunError::Ended { reason: "nothing was seen".to_owned() })
    }

    fn look(&mut self) -> Result<Here, EngineError> {
        let is_shown = |id: SamplerId| [SamplerId::Observables, SamplerId::Analysis(AnalysisId::Stress)].contains(&id);
        let samplers = self.engine.plan().samplers.iter().enumerate();
        let shown: Vec<usize> =
            samplers.filter(|(_, sampler)| is_shown(sampler.id)).map(|(number, _)| number).collect();
        if self.saved.step != self.step() {
            self.save()?;
        }
        let state = Arc::clone(&self.saved);
        let mut reported = self.engine.report_of(&state)?;
        with_flow(&mut reported, &self.planned);
        let samples = self.engine.measure(&shown)?;
        self.add_samples(samples);
        self.sampled.retain(|sample| sample.step == state.step);
        Ok(Here { state, reported })
    }

    /// The particles at the current step: positions, velocities, species, images.
    ///
    /// # Errors
    /// [`RunError`] if the device fails, or the simulation has ended.
    pub fn frame(&mut self) -> Result<Frame, RunError> {
        // A clone shares its content.
        let scene = self.scene.clone();
        Ok(Frame::new(&self.here()?.reported, scene.model()))
    }

    /// The exact state at the current step, from which the steps that follow are taken.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn state(&mut self) -> Result<Arc<State>, RunError> {
        Ok(Arc::clone(&self.here()?.state))
    }

    /// The numbers of a row of the table of energies at the current step, name by name.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn observables(&mut self) -> Result<Vec<(&'static str, f64)>, RunError> {
        self.here()?;
        let Some(sample) = self.sampled.iter().find(|sample| sample.sampler == 0) else { return Ok(Vec::new()) };
        let (row, model) = (self.observables_in(sample), self.scene.model());
        let columns = model.physics().columns(model);
        Ok(columns.iter().map(|column| (column.name, column.value(&row, self.time()))).collect())
    }

    /// One of these numbers; none of a name that no column has.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn observable(&mut self, name: &str) -> Result<Option<f64>, RunError> {
        Ok(self.observables()?.into_iter().find(|(known, _)| *known == name).map(|(_, value)| value))
    }

    /// The pressure tensor at the current step, from its parts: motion, conservative forces, friction and noise, each as xx, yy, zz, xy, xz,
    /// yz. None of a scene without `output.stress`, whose plan does not measure it.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn stress(&mut self) -> Result<Option<[[f64; 6]; 3]>, RunError> {
        self.here()?;
        Ok(self.sampled.iter().find_map(|sample| stress_of_sample(sample, self.engine.plan(), self.scene.model())))
    }

    /// The table of energies since the simulation began, every `output.energies.every` steps.
    #[must_use]
    pub fn energies(&self) -> Table {
        self.rows.table()
    }

    /// The rows of that table that means are of.
    pub(crate) fn settled(&self) -> Table {
        self.rows.settled()
    }

    /// The means of the columns of that table with their standard errors, after equilibration and after the last
    /// [change](Self::changes); none of a column without rows.
    #[must_use]
    pub fn means(&self) -> Vec<(&'static str, Option<Estimate>)> {
        self.rows.means()
    }

    /// The fields of shallow water on the nodes of its mesh at the current step: depth, potential vorticity and all others that `output.fields`
    /// can name. None of other scenes.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn fields(&mut self) -> Result<Vec<(FieldQuantity, Field)>, RunError> {
        let found = self.mesh_pictures(&FieldQuantity::ALL)?;
        let fields = found.into_iter().flat_map(|pictures| pictures.fields);
        Ok(fields.map(|shown| (shown.quantity, shown.field)).collect())
    }

    fn mesh_pictures(&mut self, quantities: &[FieldQuantity]) -> Result<Option<MeshPictures>, RunError> {
        if self.scene.model().picture() != PictureKind::Fields {
            return Ok(None);
        }
        let reported = self.here()?.reported.clone();
        let model = self.scene.model();
        let depth = mesh_depth(&mut *self.engine, model)?;
        Ok(model.physics().mesh_pictures(quantities, &reported, &depth, model))
    }

    /// The Voronoi cells at the current step, with their areas, corners and faces; none of other scenes.
    ///
    /// # Errors
    /// As [`Self::frame`].
    pub fn cells(&mut self) -> Result<Option<Tessellation>, RunError> {
        let [x, y, _] = self.scene.model().units.lengths;
        let is_of_cells = self.scene.model().picture() == PictureKind::Cells;
        let positions = &self.here()?.reported.positions;
        Ok(is_of_cells.then(|| Tessellation::of_fractions([x, y], positions)))
    }

    /// A picture of the current step as `output.snapshot` asks for it; of shallow water the first field that `output.fields` names. None of
    /// particles on a line.
    ///
    /// # Errors
    /// [`RunError::Plot`] if it cannot be drawn, and as [`Self::frame`].
    pub fn draw(&mut self) -> Result<Option<RgbaImage>, RunError> {
        let asked = self.scene.output.fields.clone().unwrap_or_default();
        let pictures = self.mesh_pictures(&asked.quantities)?;
        let reported = self.here()?.reported.clone();
        let (model, gpu) = (self.scene.model(), self.place.gpu.clone());
        let mut views = Views::new(&gpu, &self.scene, ColourRanges::default());
        let drawn = match pictures.as_ref().and_then(|pictures| Some((pictures, pictures.fields.first()?))) {
            Some((pictures, shown)) => {
                let range = asked.ranges.of(shown.quantity);
                Some(views.field(shown, pictures, &reported, range, model))
            }
            None => views.snapshot(&Shown::of(reported, most_shown(&self.scene)), model),
        };
        drawn.transpose().map_err(|source| RunError::Plot { name: "the current step".to_owned(), source })
    }

    /// A trajectory file in the format of its extension, `gsd` or `xyz`, to which [`write`](Self::write) adds frames. One that exists is
    /// replaced.
    ///
    /// # Errors
    /// [`RunError::Arrays`] for another extension, [`RunError::Output`] if it cannot be created.
    pub fn trajectory(&self, path: impl AsRef<Path>) -> Result<TrajectoryWriter, RunError> {
        let path = path.as_ref();
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        let mut formats = TrajectoryFormat::ALL.into_iter();
        let Some(format) = formats.find(|format| files::trajectory(*format).rsplit('.').next() == Some(extension))
        else {
            let text =
                format!("`{}`: found the extension `{extension}`; accepted: gsd, xyz", crate::printable::path(path));
            return Err(RunError::Arrays { mistakes: vec![text] });
        };
        Ok(TrajectoryWriter::create(path, format, self.scene.model(), Id::of_run(&self.scene))?)
    }

    /// Adds the current step to a trajectory.
    ///
    /// # Errors
    /// [`RunError::Output`] if it cannot be written, and as [`Self::frame`].
    pub fn write(&mut self, trajectory: &mut TrajectoryWriter) -> Result<(), RunError> {
        trajectory.append(&self.here()?.reported)?;
        Ok(trajectory.flush()?)
    }

    /// Saves a checkpoint of the current step, from which a simulation [continues](Self::from_checkpoint) to the bit, and a scene may start.
    ///
    /// # Errors
    /// [`RunError`] if it cannot be written, and as [`Self::frame`].
    pub fn checkpoint(&mut self, path: impl AsRef<Path>) -> Result<(), RunError> {
        let state = self.state()?;
        let carried = self.carried.section(self.scene.model(), &mut *self.engine)?;
        let times = self.scene.model().time;
        // Times of steps that another time step preceded do not follow from the scene.
        let times = (times.step > 0).then(|| (TIMES.to_owned(), serde_json::to_vec(&times).unwrap_or_default()));
        let sections: Vec<_> = carried.into_iter().chain(Change::section(&self.changes)).chain(times).collect();
        // A scene ends after its checkpoint.
        let steps = self.scene.time.steps.max(state.step);
        let scene = self.scene.clone().changed(|scene| scene.time.steps = steps);
        Ok(checkpoint::save(path.as_ref(), Id::of_run(&scene), &scene, &state, &[], &sections)?)
    }

    /// Writes what `run.json` says of a run: the scene, the adapter, changes between steps, speed, and the means of the
    /// table of energies since the last change, with their errors. Nothing is said of conservation, which is not
    /// watched.
    ///
    /// # Errors
    /// [`RunError::Output`] if it cannot be written.
    pub fn summary(&self, path: impl AsRef<Path>) -> Result<(), RunError> {
        let scene = &self.scene;
        let adapter = AdapterSummary::from(self.adapter());
        let mut summary =
            Summary::new(Id::of_run(scene), scene.clone().into_scene(), adapter, scene.model().particle_count());
        let (steps, spent) = self.pace.done();
        summary.set_duration(self.step(), steps, spent.as_secs_f64());
        summary.ranks = ranks(&*self.engine);
        summary.start = StartSummary::new(scene);
        summary.changes.clone_from(&self.changes);
        summary.columns.insert(files::ENERGIES.to_owned(), ColumnSummary::of_energies(scene.model()));
        summary.warnings = families::warnings(scene).iter().map(ToString::to_string).collect();
        self.rows.summarise(settling::is_about_equilibrium(scene, scene.model()), &mut summary);
        Ok(summary.save(path.as_ref())?)
    }

    /// Goes on from another state of the same step.
    pub(super) fn restart(&mut self, state: State) -> Result<(), RunError> {
        let carried = self.carried.advanced(self.scene.model(), &mut *self.engine)?;
        match self.engine.upload(&state) {
            Err(EngineError::Crowded { .. }) => {
                (self.engine, self.options) = self.place.open(&self.planned, &state, self.options)?;
            }
            uploaded => uploaded?,
        }
        self.begin(carried, state);
        Ok(())
    }

    /// Nothing is known but the state that the engine has begun with.
    fn begin(&mut self, carried: Carried, state: State) {
        (self.counted, self.carried) = (carried.clone(), carried);
        // A row of this step is of what was before.
        self.rows.begin_anew(state.step + u64::from(self.rows.last_step() == Some(state.step)));
        self.saved = Arc::new(state);
        (self.here, self.sampled) = (None, Vec::new());
    }

    /// Goes on with another scene, whose plan is for the same particles.
    pub(super) fn replace(&mut self, scene: Checked, state: State) -> Result<(), RunError> {
        let carried = self.carried.advanced(self.scene.model(), &mut *self.engine)?;
        let planned = Sight::Frames.planned(&scene);
        let plan = plan_for(&planned, &self.place.gpu, self.options);
        if let Some(problem) = plan.misfit(&state, planned.model()) {
            return Err(RunError::Arrays { mistakes: vec![problem] });
        }
        let written = serde_json::to_string(&planned).unwrap_or_default();
        if !self.engine.renumber(&plan, &written, &state)? {
            // From now on numbers change without compiling kernels.
            let options = Options { constants_in: ConstantsIn::Buffer, ..self.options };
            (self.engine, self.options) = self.place.open(&planned, &state, options)?;
            self.openings += 1;
        }
        (self.scene, self.planned) = (scene, planned);
        self.begin(carried, state);
        Ok(())
    }
}

/// Frames of a simulation, while it advances.
///
/// ```
/// use mesoscope::prelude::*;
///
/// let scene = scene::load("dpd-fluid", &["space.box=[4,4,4]", "output={}"].map(str::to_owned))?;
/// let mut simulation = Simulation::new(&scene, &AdapterChoice::Best)?;
/// let steps: Vec<u64> = simulation.frames(25, 10).map(|frame| Ok(frame?.step)).collect::<Result<_, RunError>>()?;
/// assert_eq!(steps, [10, 20, 25]);
/// # Ok::<(), RunError>(())
/// ```
pub struct Frames<'s> {
    simulation: &'s mut Simulation,
    last: u64,
    every: u64,
}

impl Iterator for Frames<'_> {
    type Item = Result<Frame, RunError>;

    fn next(&mut self) -> Option<Self::Item> {
        let left = self.last.checked_sub(self.simulation.step()).filter(|left| *left > 0)?;
        let frame = self.simulation.advance(left.min(self.every)).and_then(|()| self.simulation.frame());
        if frame.is_err() {
            self.last = 0;
        }
        Some(frame)
    }
}

impl Place {
    /// An adapter that allows the buffers of a scene, of several ranks those of its first part.
    fn new(scene: &Checked, choice: &AdapterChoice, ranks: u32) -> Result<Self, RunError> {
        let division = if ranks == 1 { None } else { Some(divide(scene, Ranks::Count(ranks))?) };
        let shared = division.map(|division| Shared { division, choice: choice.clone() });
        let part = division.map(|division| Part { division, rank: 0 });
        let (gpu, _) = open_adapter(scene, choice, Options { part, ..Options::default() })?;
        Ok(Self { gpu, shared })
    }

    /// The part of the first rank, of several.
    fn part(&self) -> Option<Part> {
        self.shared.as_ref().map(|shared| Part { division: shared.division, rank: 0 })
    }

    /// An engine, or the ranks that share its work, with as much room as the first state needs.
    fn open(
        &self,
        scene: &Checked,
        state: &State,
        mut options: Options,
    ) -> Result<(Box<dyn Stepper>, Options), RunError> {
        loop {
            match self.open_with(scene, state, options) {
                Err(RunError::Engine(error)) => {
                    options = error.roomier(options, scene.model().particle_count()).ok_or(error)?;
                }
                opened => return Ok((opened?, options)),
            }
        }
    }

    /// The same with the room that these options leave.
    fn open_with(&self, scene: &Checked, state: &State, options: Options) -> Result<Box<dyn Stepper>, RunError> {
        let Some(Shared { division, choice }) = &self.shared else {
            return Ok(Box::new(Engine::new(&self.gpu, plan_for(scene, &self.gpu, options), state)?));
        };
        let team = team(scene, &self.gpu, choice, *division, options, state)?;
        team.check_alike()?;
        Ok(Box::new(team))
    }
}
