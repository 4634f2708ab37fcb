//! One run from its first step to its summary.

use super::analyses::Analyses;
use super::conservation::{conserved, not_conserved};
use super::energies::{self, EnergyRecorder};
use super::exchange_tally::{self, ExchangeTally};
use super::interrupt::Interrupt;
use super::kept_sums::{self, KeptSums};
use super::pace::Pace;
use super::pictures::{self, Pictures};
use super::schedule::Schedule;
use super::sections::Sections;
use super::{Event, Progress, RunError};
use crate::engine::{Engine, EngineError, Sample};
use crate::families::{self, Instability, KeptQuantity, Model, ShallowWater};
use crate::gpu::{AdapterChoice, Gpu, GpuError, Requirements};
use crate::measure::observables_of;
use crate::output::checkpoint::CheckpointError;
use crate::output::summary::AdapterSummary;
use crate::output::{
    Checkpoint, Extent, OutputError, RunDirectory, Summary, TrajectoryWriter, checkpoint, exists, files,
};
use crate::plan::{self, Hardware, Options, Plan};
use crate::scene::{self, Scene, Warning};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A run to be executed: a scene, where it begins and where its files go.
#[derive(Debug, Clone)]
pub struct Simulation {
    scene: Scene,
    beginning: Beginning,
    interrupt: Interrupt,
    /// What was done to the scene before the run, for its summary.
    notices: Vec<String>,
}

#[derive(Debug, Clone)]
enum Beginning {
    New {
        directory: PathBuf,
        force: bool,
    },
    Checkpoint {
        directory: RunDirectory,
        checkpoint: Box<Checkpoint>,
        /// What `run.json` says of the same run.
        earlier: Option<Box<Summary>>,
    },
}

/// What a run leaves.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Outcome {
    /// What `run.json` says.
    pub summary: Summary,
    /// Names of the files of this run that are in its directory, sorted; numbered snapshots are counted instead.
    pub files: Vec<&'static str>,
    /// Number of numbered snapshots.
    pub snapshots: u64,
}

impl Simulation {
    /// A run of a checked scene from step 0 into a directory, which is created. With `force` the files of an earlier
    /// run there are replaced.
    #[must_use]
    pub fn start(scene: Scene, directory: impl Into<PathBuf>, force: bool) -> Self {
        let beginning = Beginning::New { directory: directory.into(), force };
        Self { scene, beginning, interrupt: Interrupt::default(), notices: Vec::new() }
    }

    /// Continues the run in a directory from its last checkpoint, up to step `steps` where that is given. The directory
    /// belongs to this process from now on, until the simulation is dropped or executed.
    ///
    /// # Errors
    /// [`RunError::Checkpoint`] when there is no checkpoint or it is damaged; [`RunError::Output`] when another process
    /// writes there, or when `run.json` belongs to another run; [`RunError::Scene`] when the scene cannot do with as few
    /// steps.
    pub fn resume(directory: impl Into<PathBuf>, steps: Option<u64>) -> Result<Self, RunError> {
        let directory = directory.into();
        if !directory.join(files::CHECKPOINT).exists() {
            // Nothing is written where there is no run, no lock either.
            checkpoint::load(&directory.join(files::CHECKPOINT))?;
        }
        let directory = RunDirectory::claim(directory)?;
        let path = directory.file(files::CHECKPOINT);
        let checkpoint = checkpoint::load(&path)?;
        let mut scene = checkpoint.scene.clone();
        let notices = checkpoint.sections.iter().find(|(name, _)| name == NOTICES);
        let notices = notices.and_then(|(_, bytes)| serde_json::from_slice(bytes).ok()).unwrap_or_default();
        if let Some(steps) = steps.filter(|steps| *steps != scene.time.steps) {
            scene.time.steps = steps;
            if steps > checkpoint.state.step {
                scene = scene::checked(&path.display().to_string(), &scene)?;
            }
        }
        let model = Model::new(&scene);
        // What a state has to have is the same on every adapter.
        let (hardware, options) = (Hardware::default(), Options::default());
        let plan = plan::plan(&model, scene.time.equilibration, &scene.output, hardware, options);
        if let Some(problem) = plan.misfit(&checkpoint.state, &model) {
            return Err(CheckpointError::Malformed { path, problem }.into());
        }
        let summary = directory.file(files::SUMMARY);
        let earlier = match Summary::load(&summary) {
            Ok(summary) => Some(Box::new(summary)),
            // It will be written anew.
            Err(OutputError::Unfinished { .. } | OutputError::Line { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        if let Some(earlier) = &earlier {
            earlier.check_run(&scene, &summary)?;
        }
        let beginning = Beginning::Checkpoint { directory, checkpoint: Box::new(checkpoint), earlier };
        Ok(Self { scene, beginning, interrupt: Interrupt::default(), notices })
    }

    /// The same run, whose summary also says what was done to the scene, as [`scene::load_for`] does.
    #[must_use]
    pub fn noting(mut self, notices: &[Warning]) -> Self {
        self.notices.extend(notices.iter().map(ToString::to_string));
        self
    }

    /// What was done to the scene before the run.
    #[must_use]
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// The same run, which saves a checkpoint and stops when it is asked to.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// The scene, with every default filled in.
    #[must_use]
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The step the run begins with.
    #[must_use]
    pub fn first_step(&self) -> u64 {
        match &self.beginning {
            Beginning::New { .. } => 0,
            Beginning::Checkpoint { checkpoint, .. } => checkpoint.state.step,
        }
    }

    /// Whether nothing is left to do: the last step is behind, and everything that the run was to leave is there.
    #[must_use]
    pub fn is_finished(&self) -> bool {
        let step = self.first_step();
        let complete = match &self.beginning {
            Beginning::Checkpoint { directory, earlier: Some(earlier), .. } => {
                earlier.steps == step && earlier.is_complete(directory)
            }
            _ => false,
        };
        step > self.scene.time.steps || step == self.scene.time.steps && complete
    }

    /// Runs to the end and writes everything the scene asks for.
    ///
    /// The trajectory of states depends on scene, adapter and driver only: how often it was interrupted and resumed,
    /// snapshots, checkpoints and the size of batches change no bit of it.
    ///
    /// # Errors
    /// [`RunError`]: no usable adapter, a run that became unstable or was interrupted, files that cannot be written. What was measured
    /// until then and the last good checkpoint are on disk.
    pub fn execute(self, choice: &AdapterChoice, observer: &mut dyn FnMut(Event<'_>)) -> Result<Outcome, RunError> {
        let Self { scene, beginning, interrupt, notices } = self;
        let model = Model::new(&scene);
        let mut options = Options::default();
        // Before the directory: an adapter that is not there should not cost an earlier run its files.
        let mut gpu = open_adapter(&scene, &model, choice, options)?;
        let (directory, mut start, earlier) = match beginning {
            Beginning::New { directory, force } => {
                let state = families::initial_state(&scene, &model);
                families::check_start(&scene, &model, &state)?;
                let directory = RunDirectory::create(directory, force)?;
                (directory, Checkpoint { scene: scene.clone(), state, files: Vec::new(), sections: Vec::new() }, None)
            }
            Beginning::Checkpoint { directory, checkpoint, earlier } => (directory, *checkpoint, earlier),
        };
        let (first_step, last_step) = (start.state.step, scene.time.steps);
        observer(Event::Started { adapter: gpu.description(), first_step, last_step });
        let mut pace = Pace::new(model.particle_count());
        let task = Task { scene, model, directory, interrupt, notices, earlier };
        loop {
            match task.attempt(&gpu, options, &start, &mut pace, observer) {
                Err(RunError::Engine(EngineError::Crowded { .. })) if options.has_room_left() => {
                    // Too rare for every run to pay for it in memory or time.
                    options = options.with_room(task.model.particle_count());
                    start = task.last_checkpoint(start)?;
                    let reason = task.model.physics().crowd();
                    observer(Event::Repeating { from: start.state.step, reason });
                    gpu = open_adapter(&task.scene, &task.model, choice, options)?;
                }
                ended => return ended,
            }
        }
    }
}

/// What stays the same if a run has to go back.
struct Task {
    scene: Scene,
    model: Model,
    directory: RunDirectory,
    interrupt: Interrupt,
    /// What was done to the scene before the run.
    notices: Vec<String>,
    /// What `run.json` says of an earlier part of the run.
    earlier: Option<Box<Summary>>,
}

impl Task {
    /// The last checkpoint on disk; the start itself if nothing was saved since.
    fn last_checkpoint(&self, start: Checkpoint) -> Result<Checkpoint, RunError> {
        let path = self.directory.file(files::CHECKPOINT);
        if path.exists() { Ok(checkpoint::load(&path)?) } else { Ok(start) }
    }

    /// Runs from `start` to the end.
    fn attempt(
        &self,
        gpu: &Gpu,
        options: Options,
        start: &Checkpoint,
        pace: &mut Pace,
        observer: &mut dyn FnMut(Event<'_>),
    ) -> Result<Outcome, RunError> {
        let plan = plan_for(&self.scene, &self.model, gpu, options);
        let mut engine = Engine::new(gpu, plan, &start.state)?;
        let mut run = Run::open(self, gpu, &mut engine, start)?;
        run.notices = &self.notices;
        match run.advance_to_end(&mut engine, pace, observer) {
            Err(RunError::Engine(source @ (EngineError::Unstable(_) | EngineError::GaveUp { .. }))) => {
                run.energies.flush()?;
                let (checkpoint, checkpoint_step) = (self.directory.file(files::CHECKPOINT), run.saved_step);
                return Err(match source {
                    EngineError::Unstable(failure) => {
                        let source = Instability::new(&failure, engine.plan(), &self.model);
                        RunError::Unstable { source, checkpoint, checkpoint_step }
                    }
                    source => RunError::GaveUp { source, checkpoint, checkpoint_step },
                });
            }
            Err(error) => return Err(self.stopped(error, run.saved_step)),
            Ok(()) => {}
        }
        observer(Event::Finishing);
        let mut warnings = self.notices.clone();
        warnings.extend(self.model.warnings(&self.scene).iter().map(ToString::to_string));
        warnings.extend(run.kept_sums.warning());
        warnings.extend(pictures::lettering(&self.scene));
        let saved_step = run.saved_step;
        run.conclude(warnings, pace.done()).map_err(|error| self.stopped(error, saved_step))
    }

    /// Stops if the run is asked to, with a checkpoint of this step on disk.
    fn obey(&self, checkpoint_step: u64) -> Result<(), RunError> {
        if self.interrupt.is_asked() {
            let checkpoint = self.directory.file(files::CHECKPOINT);
            return Err(RunError::Interrupted { checkpoint, checkpoint_step });
        }
        Ok(())
    }

    /// Says of a failure to write what is left to go on from.
    fn stopped(&self, error: RunError, checkpoint_step: u64) -> RunError {
        let checkpoint = self.directory.file(files::CHECKPOINT);
        match error {
            // What is lost no checkpoint goes on from.
            RunError::Output(source) if checkpoint.exists() && !matches!(source, OutputError::Lost { .. }) => {
                RunError::Stopped { source, checkpoint, checkpoint_step }
            }
            error => error,
        }
    }
}

/// Opens an adapter with room for the buffers of a scene.
pub(super) fn open_adapter(
    scene: &Scene,
    model: &Model,
    choice: &AdapterChoice,
    options: Options,
) -> Result<Gpu, RunError> {
    let open = |hardware| {
        let plan = plan::plan(model, scene.time.equilibration, &scene.output, hardware, options);
        plan::check_precision(scene, &plan)?;
        let (largest_buffer, storage_buffers) = (plan.largest_buffer(), plan.storage_buffers);
        Gpu::open(choice, Requirements { largest_buffer, storage_buffers, ..Requirements::default() }).map_err(
            |error| match plan.buffers.iter().max_by_key(|buffer| buffer.bytes) {
                Some(largest) if matches!(error, GpuError::TooSmall { .. }) => {
                    RunError::TooLarge { source: error, buffer: largest.name, purpose: largest.purpose }
                }
                _ => error.into(),
            },
        )
    };
    match open(Hardware::default()) {
        // What the plan for any adapter needs this one may not: some get by with smaller buffers.
        Err(RunError::TooLarge { .. }) => open(Hardware::from(&Gpu::open(choice, Requirements::default())?)),
        opened => opened,
    }
}

/// Opens the adapter that a run of this scene would open.
///
/// ```
/// use mesoscope::gpu::AdapterChoice;
/// use mesoscope::{run, scene};
///
/// let gpu = run::adapter_for(&scene::load("dpd-fluid", &[])?, &AdapterChoice::Best)?;
/// println!("{}", gpu.description().name);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RunError::Gpu`] without an adapter that has room for it, [`RunError::Scene`] if its numbers are beyond single precision.
pub fn adapter_for(scene: &Scene, choice: &AdapterChoice) -> Result<Gpu, RunError> {
    open_adapter(scene, &Model::new(scene), choice, Options::default())
}

/// The plan of a scene on an adapter.
pub(super) fn plan_for(scene: &Scene, model: &Model, gpu: &Gpu, options: Options) -> Plan {
    plan::plan(model, scene.time.equilibration, &scene.output, gpu.into(), options)
}

/// A run under way: its open files and what it has gathered.
struct Run<'a> {
    task: &'a Task,
    scene: &'a Scene,
    model: &'a Model,
    gpu: &'a Gpu,
    directory: &'a RunDirectory,
    schedule: Schedule,
    energies: EnergyRecorder,
    analyses: Analyses,
    tally: ExchangeTally,
    kept_sums: KeptSums,
    trajectory: Option<TrajectoryWriter>,
    pictures: Pictures<'a>,
    /// What was done to the scene before the run.
    notices: &'a [String],
    /// Step of the checkpoint on disk.
    saved_step: u64,
    /// When it was written.
    saved_at: Instant,
}

impl<'a> Run<'a> {
    /// Creates the files of a run at step 0, or cuts them back to what was there before the step of `start`.
    fn open(task: &'a Task, gpu: &'a Gpu, engine: &mut Engine<'_>, start: &Checkpoint) -> Result<Self, RunError> {
        let Task { scene, model, directory, .. } = task;
        let step = start.state.step;
        let path = directory.file(files::CHECKPOINT);
        let sections = Sections::new(&path, step, &start.sections);
        // What is wrong with the checkpoint is found before a file is touched.
        let analyses = Analyses::new(scene, model, engine.plan(), &sections)?;
        analyses.continue_windows(engine, &sections)?;
        let tally = if model.voronoi().is_some() { ExchangeTally::new(&sections)? } else { ExchangeTally::default() };
        let kept_sums = KeptSums::new(model, &start.state, &sections)?;
        let schedule = Schedule::new(scene, analyses.state_intervals());
        let written = |name: &str| match start.files.iter().find(|(known, _)| known == name) {
            // At step 0 there is nothing yet.
            _ if step == 0 => Ok(None),
            Some((_, extent)) => Ok(Some(*extent)),
            None => Err(sections.malformed(format!("it does not know `{name}`"))),
        };
        let table = directory.file(files::ENERGIES);
        let energies = EnergyRecorder::open(&table, scene, model, written(files::ENERGIES)?, &sections)?;
        let trajectory = match &scene.output.trajectory {
            None => None,
            Some(asked) => {
                let name = files::trajectory(asked.format);
                let path = directory.file(name);
                Some(match written(name)? {
                    None => TrajectoryWriter::create(&path, asked.format, model)?,
                    Some(written) => TrajectoryWriter::resume(&path, asked.format, model, written)?,
                })
            }
        };
        directory.remove_snapshots_after(schedule.snapshots_before(step))?;
        Ok(Self {
            task,
            scene,
            model,
            gpu,
            directory,
            schedule,
            energies,
            analyses,
            tally,
            kept_sums,
            trajectory,
            pictures: Pictures::new(gpu, directory, scene, &start.sections),
            notices: &[],
            saved_step: step,
            saved_at: Instant::now(),
        })
    }

    fn advance_to_end(
        &mut self,
        engine: &mut Engine<'_>,
        pace: &mut Pace,
        observer: &mut dyn FnMut(Event<'_>),
    ) -> Result<(), RunError> {
        let begun = pace.done();
        let first = engine.step();
        self.visit(engine, pace)?;
        while engine.step() < self.scene.time.steps {
            let event = self.schedule.next(engine.step());
            pace.begin();
            while engine.step() < event {
                let steps = pace.batch().min(event - engine.step());
                let advanced = engine.advance(steps, steps);
                // A failure is found a few batches late: what came before it is good.
                let samples = engine.take_samples();
                self.record(&samples, engine.plan())?;
                self.energies.flush()?;
                advanced?;
                pace.submitted(steps);
                observer(Event::Advanced(self.progress(first, begun, pace)));
                // Here nothing has been added yet of what is due at this step.
                let interrupted = self.task.interrupt.is_asked() && engine.step() < self.scene.time.steps;
                if interrupted || self.schedule.checkpoint_after(self.saved_at.elapsed()) {
                    self.save(engine, pace)?;
                }
                if interrupted {
                    self.obey()?;
                }
            }
            self.visit(engine, pace)?;
            observer(Event::Advanced(self.progress(first, begun, pace)));
        }
        Ok(())
    }

    /// Stops if the run is asked to. What is not saved is lost.
    fn obey(&self) -> Result<(), RunError> {
        self.task.obey(self.saved_step)
    }

    /// Does what is due at the current step: a checkpoint, then the samples, then pictures and frames.
    fn visit(&mut self, engine: &mut Engine<'_>, pace: &mut Pace) -> Result<(), RunError> {
        let step = engine.step();
        if self.schedule.checkpoint(step) {
            self.save(engine, pace)?;
        }
        let last = step == self.scene.time.steps;
        if last {
            // Whatever follows can be done later too.
            self.obey()?;
        }
        let samples = engine.finish()?;
        pace.finished();
        self.record(&samples, engine.plan())?;
        self.energies.flush()?;
        let number = self.schedule.snapshot(step);
        let frame = self.schedule.frame(step);
        if number.is_some() || frame || self.analyses.take_state(step) || last {
            let state = engine.reported()?;
            self.analyses.add_state(&state, self.model);
            if let (true, Some(trajectory)) = (frame, &mut self.trajectory) {
                trajectory.append(&state)?;
                trajectory.flush()?;
            }
            if let Some(water) = self.model.shallow_water() {
                let depth = mesh_depth(engine, water)?;
                for number in number.map(Some).into_iter().chain(last.then_some(None)) {
                    self.pictures.fields(number, &state, &depth, self.model, water)?;
                }
            } else {
                if let Some(number) = number {
                    self.pictures.snapshot(&files::snapshot(number), &state, self.model)?;
                }
                if last {
                    self.pictures.snapshot(files::SNAPSHOT, &state, self.model)?;
                }
            }
        }
        Ok(())
    }

    /// Saves a checkpoint.
    fn save(&mut self, engine: &mut Engine<'_>, pace: &mut Pace) -> Result<(), RunError> {
        let state = engine.state();
        pace.finished();
        let samples = engine.take_samples();
        self.record(&samples, engine.plan())?;
        let state = state?;
        // The checkpoint counts on what is in the files before its step.
        self.energies.sync()?;
        if let Some(trajectory) = &mut self.trajectory {
            trajectory.flush()?;
        }
        let mut sections = self.analyses.sections_of_samples();
        sections.extend(self.analyses.open_windows(engine)?);
        if !self.notices.is_empty() {
            sections.push((NOTICES.to_owned(), serde_json::json!(self.notices).to_string().into_bytes()));
        }
        sections.push((energies::SECTION.to_owned(), self.energies.section()));
        sections.extend(self.analyses.sections_of_states());
        sections.push((kept_sums::SECTION.to_owned(), self.kept_sums.section()));
        sections.extend(self.pictures.sections());
        if self.model.voronoi().is_some() {
            sections.push((exchange_tally::SECTION.to_owned(), self.tally.section(engine)?));
        }
        let mut written = vec![(files::ENERGIES.to_owned(), self.energies.extent())];
        if let (Some(trajectory), Some(asked)) = (&self.trajectory, &self.scene.output.trajectory) {
            written.push((files::trajectory(asked.format).to_owned(), trajectory.extent()));
        }
        checkpoint::save(&self.directory.file(files::CHECKPOINT), self.scene, &state, &written, &sections)?;
        self.saved_step = state.step;
        self.saved_at = Instant::now();
        pace.begin();
        Ok(())
    }

    fn record(&mut self, samples: &[Sample], plan: &Plan) -> Result<(), RunError> {
        for sample in samples {
            if sample.sampler == 0 {
                self.kept_sums.compare(sample);
                let mut observables = observables_of(sample, plan, self.model);
                self.tally.complete(&mut observables);
                self.energies.add(&observables)?;
            } else {
                self.analyses.add(sample);
            }
        }
        Ok(())
    }

    fn progress(&self, first: u64, begun: (u64, Duration), pace: &Pace) -> Progress {
        let (done, spent) = pace.done();
        let (done, spent) = (done - begun.0, (spent.saturating_sub(begun.1)).as_secs_f64());
        let rate = if done > 0 && spent > 0.0 { done as f64 / spent } else { 0.0 };
        let last_step = self.scene.time.steps;
        let step = first + done;
        let left = last_step.saturating_sub(step) as f64 / rate;
        Progress {
            step,
            last_step,
            particle_steps_per_second: rate * self.model.particle_count() as f64,
            remaining: Duration::try_from_secs_f64(left).ok(),
            temperature: self.energies.temperature(),
        }
    }

    /// Writes tables, summary and plots.
    fn conclude(mut self, warnings: Vec<String>, (steps, spent): (u64, Duration)) -> Result<Outcome, RunError> {
        let description = self.gpu.description();
        let adapter = AdapterSummary {
            name: description.name.clone(),
            driver: description.driver.clone(),
            backend: description.backend.clone(),
        };
        let mut summary = Summary::new(self.scene.clone(), adapter, self.model.particle_count());
        let last_step = self.scene.time.steps;
        summary.set_duration(last_step, steps, spent.as_secs_f64());
        if let Some(earlier) = self.task.earlier.as_deref().filter(|earlier| steps == 0 && earlier.steps == last_step) {
            // What is added here took no step.
            summary.wall_seconds = earlier.wall_seconds;
            summary.particle_steps_per_second = earlier.particle_steps_per_second;
        }
        summary.warnings = warnings;
        self.energies.summarise(&mut summary);
        self.analyses.conclude(self.directory, &mut summary, &|| self.obey())?;
        let changed = self.kept_sums.lost();
        let lost: Vec<KeptQuantity> = changed.iter().map(|(quantity, _)| *quantity).collect();
        summary.conserved_exactly = conserved(self.model, &lost);
        summary.not_conserved = not_conserved(self.model, &changed);
        let written = |name: &&str| self.directory.file(name).exists();
        let is_table = |name: &&str| Path::new(name).extension().is_some_and(|extension| extension == "csv");
        for name in files::all().filter(is_table).filter(written) {
            summary.tables.insert(name.to_owned(), Extent::of(&self.directory.file(name))?);
        }
        // Numbers first: they are worth more than pictures if the disk is full.
        let path = self.directory.file(files::SUMMARY);
        summary.save(&path)?;
        self.obey()?;
        self.pictures.energies(&self.energies.table(), self.model, &summary)?;
        let (task, saved_step) = (self.task, self.saved_step);
        self.pictures.analyses(&summary, &|| task.obey(saved_step))?;
        // What was moved away or replaced under way is not what `run.json` speaks of.
        self.energies.check()?;
        if let Some(trajectory) = &self.trajectory {
            trajectory.check()?;
        }
        self.pictures.check()?;
        exists(&self.directory.file(files::CHECKPOINT))?;
        let written: Vec<&str> = files::all().filter(written).collect();
        summary.files = Some(written.iter().map(|name| (*name).to_owned()).collect());
        summary.save(&path)?;
        Ok(Outcome { summary, files: written, snapshots: self.schedule.snapshots_before(last_step + 1) })
    }
}

/// The smoothed depth on the nodes of the mesh, right after a report.
pub(super) fn mesh_depth(engine: &mut Engine<'_>, water: &ShallowWater) -> Result<Vec<f64>, RunError> {
    let words = engine.words("depths")?;
    Ok(words.iter().take(water.nodes() as usize).map(|word| 1.0 + f64::from(f32::from_bits(*word))).collect())
}

/// Name of the section of a checkpoint that holds what was done to the scene before the run.
const NOTICES: &str = "notices";
