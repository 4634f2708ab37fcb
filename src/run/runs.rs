//! Runs that are started, resumed, and executed from their first step to their summary.

use super::adapter::{open_adapter, plan_on};
use super::conservation::warning_of_mixed_ranks;
use super::execution::{Execution, NOTICES, Outcome};
use super::interrupt::Interrupt;
use super::pace::Pace;
use super::pictures;
use super::plan::plan;
use super::task::Task;
use super::team;
use super::{Event, RunError};
use crate::engine::{Engine, EngineError, RankReport, Replica, Stepper};
use crate::families::{self, Checked, Instability};
use crate::gpu::{AdapterChoice, ConstantsIn, Gpu, unseen_card};
use crate::output::checkpoint::CheckpointError;
use crate::output::summary::{RankSummary, RanksSummary};
use crate::output::{Checkpoint, Id, OutputError, RunDirectory, Summary, checkpoint, files};
use crate::plan::{Division, Hardware, Options, Part, Plan};
use crate::ranks::{Processes, computes_alike, sharing_anywhere};
use std::path::PathBuf;

/// A run to be executed: a scene, where it begins and where its files go.
///
/// ```
/// use mesoscope::prelude::*;
///
/// # let place = tempfile::tempdir()?;
/// # let results = place.path().join("results");
/// let small = ["space.box=[4,4,4]", "time.equilibration=0", "time.steps=40", "output={}"].map(str::to_owned);
/// let scene = scene::load("dpd-fluid", &small)?;
/// let mut last = 0;
/// let outcome: Outcome = Run::start(scene, &results).execute(&AdapterChoice::Best, &mut |event| {
///     if let Event::Advanced(progress) = event {
///         last = progress.step;
///     }
/// })?;
/// assert!(last == 40 && outcome.files.contains(&"energies.csv"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Run {
    scene: Checked,
    beginning: Beginning,
    interrupt: Interrupt,
    /// The changes made to the scene before the run, for its summary.
    notices: Vec<String>,
    id: Id,
    /// How the box is divided among several ranks, if it is.
    division: Option<Division>,
    /// True if ranks may compute differently.
    mixed: bool,
    /// True if pictures are drawn.
    draws: bool,
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
        /// The summary of the run in `run.json`.
        earlier: Option<Box<Summary>>,
    },
}

impl Run {
    /// A run of a checked scene from step 0 into a directory, which is created.
    #[must_use]
    pub fn start(scene: Checked, directory: impl Into<PathBuf>) -> Self {
        Self::begin(scene, directory.into(), false)
    }

    /// The same in place of an earlier run there, whose files are removed.
    #[must_use]
    pub fn replace(scene: Checked, directory: impl Into<PathBuf>) -> Self {
        Self::begin(scene, directory.into(), true)
    }

    fn begin(scene: Checked, directory: PathBuf, force: bool) -> Self {
        let beginning = Beginning::New { directory, force };
        let id = Id::of_run(&scene);
        let notices = scene.notices().iter().map(ToString::to_string).collect();
        Self::new(scene, beginning, notices, id)
    }

    /// Continues the run in a directory from its last checkpoint, up to step `steps` where that is given. The directory
    /// belongs to this process from now on, until the simulation is dropped or executed.
    ///
    /// # Errors
    /// [`RunError::Checkpoint`] when there is no checkpoint or it is damaged; [`RunError::Output`] when another process
    /// writes there, or when a file there belongs to another run; [`RunError::Scene`] when the scene cannot do with as few
    /// steps.
    pub fn resume(directory: impl Into<PathBuf>, steps: Option<u64>) -> Result<Self, RunError> {
        let directory = directory.into();
        if !directory.join(files::CHECKPOINT).exists() {
            // Nothing is written where there is no run, no lock either.
            if RunDirectory::open(&directory).and_then(|found| found.has_results()).unwrap_or(false) {
                return Err(OutputError::NothingSaved { directory }.into());
            }
            checkpoint::load(&directory.join(files::CHECKPOINT))?;
        }
        let directory = RunDirectory::claim(directory)?;
        let path = directory.file(files::CHECKPOINT);
        let checkpoint = checkpoint::load(&path)?;
        let mut scene = checkpoint.scene.clone();
        let notices = checkpoint.sections.iter().find(|(name, _)| name == NOTICES);
        let notices = notices.and_then(|(_, bytes)| serde_json::from_slice(bytes).ok()).unwrap_or_default();
        if let Some(steps) = steps.filter(|steps| *steps != scene.time.steps) {
            scene = scene.changed(|scene| scene.time.steps = steps);
            if steps > checkpoint.state.step {
                scene = scene.check_kept(&path.display().to_string())?;
            }
        }
        // The arrays of a state are the same on every adapter.
        let (hardware, options) = (Hardware::default(), Options::default());
        if let Some(problem) = plan(&scene, hardware, options).misfit(&checkpoint.state, scene.model()) {
            return Err(CheckpointError::malformed(&path, problem).into());
        }
        let summary = directory.file(files::SUMMARY);
        let earlier = match Summary::load(&summary) {
            Ok(summary) => Some(Box::new(summary)),
            // It will be written again.
            Err(OutputError::Unfinished { .. } | OutputError::Line { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        if let Some(earlier) = &earlier {
            earlier.check_run(checkpoint.run_id, &scene, &summary)?;
        }
        directory.check_run(checkpoint.run_id, files::CHECKPOINT)?;
        let id = checkpoint.run_id;
        let beginning = Beginning::Checkpoint { directory, checkpoint: Box::new(checkpoint), earlier };
        Ok(Self::new(scene, beginning, notices, id))
    }

    fn new(scene: Checked, beginning: Beginning, notices: Vec<String>, id: Id) -> Self {
        let interrupt = Interrupt::default();
        Self { scene, beginning, interrupt, notices, id, division: None, mixed: false, draws: true }
    }

    /// The same run without pictures; arrays of fields are written. [`redraw`](super::redraw) draws those of its end, and those of an earlier
    /// end are removed.
    #[must_use]
    pub fn without_pictures(self) -> Self {
        Self { draws: false, ..self }
    }

    /// The same run as part of a sweep, whose summary has its id.
    pub(crate) fn with_id(self, id: Id) -> Self {
        Self { id, ..self }
    }

    /// The changes made to the scene before the run.
    #[must_use]
    pub fn notices(&self) -> &[String] {
        &self.notices
    }

    /// The same run, which saves a checkpoint and stops when it is asked to.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// The same run on several ranks, threads of this process with an adapter each, which divide the box: with the results of one.
    #[must_use]
    pub fn on_ranks(self, division: Option<Division>) -> Self {
        Self { division: division.filter(|division| division.ranks() > 1), ..self }
    }

    /// The same with ranks that need not compute alike: momentum is conserved to rounding only where they do not.
    #[must_use]
    pub fn mixed(self) -> Self {
        Self { mixed: true, ..self }
    }

    /// The scene, with every default filled in.
    #[must_use]
    pub fn scene(&self) -> &Checked {
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

    /// True if nothing is left to do: the last step is behind, and everything that the run was to leave is there.
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
        self.perform(Company::Alone, choice, observer)
    }

    /// The same as one of several runs that a device advances together.
    pub(crate) fn execute_with(
        self,
        replica: Replica,
        choice: &AdapterChoice,
        observer: &mut dyn FnMut(Event<'_>),
    ) -> Result<Outcome, RunError> {
        self.perform(Company::Replicas(replica), choice, observer)
    }

    /// The same as the first of several processes, which are the ranks that share the run; the others [`follow`](super::follow).
    ///
    /// # Errors
    /// As [`Self::execute`].
    pub fn execute_among(
        self,
        processes: Option<&dyn Processes>,
        choice: &AdapterChoice,
        observer: &mut dyn FnMut(Event<'_>),
    ) -> Result<Outcome, RunError> {
        self.perform(processes.map_or(Company::Alone, Company::Processes), choice, observer)
    }

    fn perform(
        self,
        company: Company<'_>,
        choice: &AdapterChoice,
        observer: &mut dyn FnMut(Event<'_>),
    ) -> Result<Outcome, RunError> {
        let (processes, mut replica) = match company {
            Company::Alone => (None, None),
            Company::Processes(processes) => (Some(processes), None),
            Company::Replicas(replica) => (None, Some(replica)),
        };
        let Self { scene, beginning, interrupt, notices, id, division, mixed, draws } = self;
        let part = division.map(|division| Part { division, rank: 0 });
        let constants_in = replica.as_ref().map_or(ConstantsIn::Code, Replica::constants_in);
        let mut options = Options { constants_in, part, ..Options::default() };
        // Whatever takes long before the first step can be left; until then nothing is written, or there is a checkpoint already.
        let is_new = matches!(beginning, Beginning::New { .. });
        let asked = interrupt.clone();
        let proceed = move || if is_new && asked.is_asked() { Err(RunError::NotBegun) } else { Ok(()) };
        let keep_alive = || processes.iter().for_each(|processes| processes.channel().keep_alive());
        let planned = replica.as_ref().map(|replica| plan_on(&scene, replica.gpu(), options)).transpose()?;
        let suited = planned.filter(|(_, plan)| replica.as_ref().is_some_and(|replica| replica.suits(plan)));
        let (mut gpu, mut plan) = if let Some(suited) = suited {
            suited
        } else {
            replica = None;
            options.constants_in = ConstantsIn::Code;
            open_adapter(&scene, choice, options)?
        };
        keep_alive();
        proceed()?;
        let (directory, mut start, earlier, replaces) = match beginning {
            Beginning::New { directory, force } => {
                let state = families::initial_state(&scene);
                proceed()?;
                families::check_start(&scene, &state)?;
                proceed()?;
                let directory = RunDirectory::make(directory)?;
                directory.in_the_way(force)?;
                let start =
                    Checkpoint { run_id: id, scene: scene.clone(), state, files: Vec::new(), sections: Vec::new() };
                (directory, start, None, Some(force))
            }
            Beginning::Checkpoint { directory, checkpoint, earlier } => (directory, *checkpoint, earlier, None),
        };
        keep_alive();
        let (first_step, last_step) = (start.state.step, scene.time.steps);
        let mut pace = Pace::new(scene.model().particle_count(), plan.operations_per_particle);
        let unseen = unseen_card(gpu.description(), choice);
        let task = Task { id, scene, directory, interrupt, notices, unseen, mixed, draws, earlier };
        let mut begun = false;
        loop {
            observer(Event::Compiling { kernels: plan.kernels.len() });
            let opened = match replica.take() {
                Some(replica) => {
                    let engine = Engine::of_replica(replica, plan, &start.state).map_err(RunError::from);
                    engine.map(|engine| -> Box<dyn Stepper> { Box::new(engine) })
                }
                None => open(&task, &gpu, plan, (choice, processes), options, &start),
            };
            let ended = opened.and_then(|mut engine| {
                if !std::mem::replace(&mut begun, true) {
                    proceed()?;
                    observer(Event::Started { adapter: gpu.description(), first_step, last_step });
                    if let Some(force) = replaces {
                        // Only now: an adapter or a rank that is not there should not cost an earlier run its files, nor a signal that is
                        // answered with "nothing was written".
                        task.directory.clear(force)?;
                    }
                    if let Some(warning) = &task.unseen {
                        observer(Event::Warned { warning });
                    }
                    // It is known earlier of ranks that are all on this machine.
                    for warning in processes.iter().flat_map(|_| sharing_anywhere(engine.ranks())) {
                        observer(Event::Warned { warning: &warning });
                    }
                    if !computes_alike(engine.ranks()) {
                        observer(Event::Warned { warning: &warning_of_mixed_ranks(task.scene.model()) });
                    }
                }
                attempt(&task, &gpu, engine.as_mut(), &mut start, &mut pace, observer)
            });
            match ended {
                Err(RunError::Engine(error)) => {
                    let model = task.scene.model();
                    // Too rare for every run to pay for it in memory or time.
                    let Some(roomier) = error.roomier(options, model.particle_count()) else {
                        return Err(error.into());
                    };
                    options = roomier;
                    let (reason, with) = match error {
                        EngineError::Overreached { .. } => ("a bond is longer than expected", "wider halos"),
                        EngineError::Unsolved { .. } => {
                            ("friction takes more iterations than expected", "more of them")
                        }
                        _ => (model.physics().crowd(model), "more memory"),
                    };
                    if begun {
                        start = task.last_checkpoint(start)?;
                    }
                    observer(Event::Repeating { from: start.state.step, reason, with });
                    (gpu, plan) = open_adapter(&task.scene, choice, options)?;
                    keep_alive();
                }
                ended => return ended,
            }
        }
    }
}

/// The company in which a run advances.
enum Company<'a> {
    /// The run itself.
    Alone,
    /// Processes that are the ranks that share it.
    Processes(&'a dyn Processes),
    /// The device, together with other runs.
    Replicas(Replica),
}

/// The engine that advances a run, or the ranks that do so together.
fn open<'a>(
    task: &Task,
    gpu: &'a Gpu,
    plan: Plan,
    (choice, processes): (&AdapterChoice, Option<&'a dyn Processes>),
    options: Options,
    start: &Checkpoint,
) -> Result<Box<dyn Stepper + 'a>, RunError> {
    let scene = &task.scene;
    let Some(Part { division, .. }) = options.part else {
        return Ok(Box::new(Engine::new(gpu, plan, &start.state)?));
    };
    let team = match processes {
        Some(processes) => team::team_of_processes(scene, gpu, choice, division, options, &start.state, processes)?,
        None => team::team(scene, gpu, choice, division, options, &start.state)?,
    };
    if !task.mixed {
        team.check_alike()?;
    }
    Ok(Box::new(team))
}

/// Runs from `start` to the end.
fn attempt(
    task: &Task,
    gpu: &Gpu,
    engine: &mut (dyn Stepper + '_),
    start: &mut Checkpoint,
    pace: &mut Pace,
    observer: &mut dyn FnMut(Event<'_>),
) -> Result<Outcome, RunError> {
    let mut run = Execution::open(task, gpu, engine, start)?;
    run.notices = &task.notices;
    match run.advance_to_end(engine, start, pace, observer) {
        Err(RunError::Engine(source @ (EngineError::Unstable(_) | EngineError::GaveUp { .. }))) => {
            run.energies.file.flush()?;
            let (checkpoint, checkpoint_step) = (task.directory.file(files::CHECKPOINT), run.saved_step);
            return Err(match source {
                EngineError::Unstable(failure) => {
                    let source = Instability::new(&failure, engine.plan(), task.scene.model());
                    RunError::Unstable { source, checkpoint, checkpoint_step }
                }
                source => RunError::GaveUp { source, checkpoint, checkpoint_step },
            });
        }
        Err(error) => return Err(task.stopped(error, run.saved_step)),
        Ok(()) => {}
    }
    run.ranks = ranks(engine);
    observer(Event::Finishing);
    let mut warnings = task.notices.clone();
    warnings.extend(task.unseen.clone());
    warnings.extend(families::warnings(&task.scene).iter().map(ToString::to_string));
    warnings.extend(run.kept_sums.mixed.then(|| warning_of_mixed_ranks(task.scene.model())));
    warnings.extend(run.kept_sums.warning());
    warnings.extend(pictures::lettering(&task.scene));
    let saved_step = run.saved_step;
    run.conclude(engine, warnings, pace.done()).map_err(|error| task.stopped(error, saved_step))
}

/// The ranks that have shared a run, if there are several.
pub(super) fn ranks(engine: &dyn Stepper) -> Option<RanksSummary> {
    let part = engine.plan().part.as_ref()?;
    let of_rank = |RankReport { host, adapter, arithmetic, traffic, .. }: &RankReport| {
        let steps = traffic.exchanges.max(1) as f64;
        RankSummary {
            host: host.clone(),
            adapter: adapter.clone(),
            arithmetic: format!("{arithmetic:08x}"),
            copies: traffic.copies as f64 / steps,
            bytes_per_step: traffic.bytes as f64 / steps,
            seconds_computing: traffic.computing.as_secs_f64() / steps,
            seconds_exchanging: traffic.exchanging.as_secs_f64() / steps,
            seconds_waiting: traffic.waiting.as_secs_f64() / steps,
        }
    };
    let ranks: Vec<RankSummary> = engine.ranks().iter().map(of_rank).collect();
    let computing = |rank: &RankSummary| rank.seconds_computing;
    let mean = ranks.iter().map(computing).sum::<f64>() / ranks.len().max(1) as f64;
    let slowest = ranks.iter().map(computing).fold(0.0, f64::max);
    Some(RanksSummary {
        parts: part.part.division.parts,
        halo: part.halo,
        alike: computes_alike(engine.ranks()),
        slowest_over_mean: if mean > 0.0 { slowest / mean } else { 1.0 },
        ranks,
    })
}
