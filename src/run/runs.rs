//! Runs that are started, resumed, and executed from their first step to their summary.

use super::adapter::{open_adapter, plan_on};
use super::change::in_units_of;
use super::conservation::warning_of_mixed_ranks;
use super::execution::{Execution, NOTICES, Outcome};
use super::interrupt::Interrupt;
use super::kept_sums::{self, KeptSums, Sharing};
use super::pace::Pace;
use super::pictures;
use super::plan::plan;
use super::sections::Sections;
use super::task::Task;
use super::team;
use super::{Event, RunError};
use crate::engine::{Engine, EngineError, RankReport, Replica, Stepper};
use crate::families::{self, Checked, Instability};
use crate::gpu::{AdapterChoice, ConstantsIn, Gpu, unseen_card};
use crate::numbers::short;
use crate::output::checkpoint::CheckpointError;
use crate::output::summary::{RankSummary, RanksSummary};
use crate::output::{Checkpoint, Id, OutputError, RunDirectory, Summary, checkpoint, files};
use crate::plan::{Division, Hardware, Options, Part, Plan};
use crate::ranks::{Processes, computes_alike, sharing_anywhere};
use crate::scene::{Problem, SceneError, Stage, part_at, value as value_of};
use serde_json::Map;
use std::path::{Path, PathBuf};

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
            let before = scene.time.steps;
            let ramps = scene.stages.last().is_some_and(|last| !last.ramp.is_empty());
            if ramps && steps < before {
                let place = format!("stages[{}].steps", scene.stages.len() - 1);
                let accepted =
                    format!("at least {before}, since the last stage has a ramp, whose line its steps are a part of");
                let problems = vec![Problem::new(place, format!("found {steps} steps in all"), accepted)];
                let name = path.display().to_string();
                return Err(SceneError::Invalid { name, problems, more: 0, further: false }.into());
            }
            scene = scene.changed(|scene| {
                scene.time.steps = steps;
                match scene.stages.last_mut() {
                    // The end of a line goes on as a stage of its own.
                    Some(_) if ramps => scene.stages.push(Stage::new(steps - before, Map::new())),
                    // No steps are a mistake, which the check finds.
                    Some(last) => last.steps = (last.steps + steps).saturating_sub(before),
                    None => {}
                }
            });
            if steps > checkpoint.state.step || !scene.stages.is_empty() {
                scene = scene.check_kept(&path.display().to_string())?;
            }
        }
        // The arrays of a state are the same on every adapter.
        let (hardware, options) = (Hardware::default(), Options::default());
        let part = scene.part_of(checkpoint.state.step)?;
        if let Some(problem) = plan(&part, hardware, options).misfit(&checkpoint.state, part.model()) {
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

    /// The same resumed run with a further stage from its checkpoint on, in which numbers of the scene change: `path.to.number=value`.
    ///
    /// Momenta are rounded where the new numbers need a larger unit, which is said in a notice. Analyses begin anew with the stage.
    ///
    /// ```
    /// use mesoscope::prelude::*;
    ///
    /// # let place = tempfile::tempdir()?;
    /// # let results = place.path().join("results");
    /// let small = ["space.box=[4,4,4]", "time.equilibration=0", "time.steps=40", "output={}"].map(str::to_owned);
    /// Run::start(scene::load("dpd-fluid", &small)?, &results).execute(&AdapterChoice::Best, &mut |_| {})?;
    /// let colder = Run::resume(&results, Some(100))?.in_new_stage(&["temperature=0.5".to_owned()])?;
    /// let outcome: Outcome = colder.execute(&AdapterChoice::Best, &mut |_| {})?;
    /// let ends: Vec<u64> = outcome.summary.stages.iter().map(|stage| stage.last_step).collect();
    /// assert_eq!(ends, [40, 100]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RunError::Scene`] with all mistakes: numbers that cannot change in a run, no steps after the checkpoint, a checkpoint in the middle of
    /// a ramp, a run that was not resumed.
    pub fn in_new_stage(mut self, settings: &[String]) -> Result<Self, RunError> {
        let refused = |path: &str, found: &str, accepted: &str| {
            let problems = vec![Problem::new(path, found.to_owned(), accepted)];
            let name = "the scene of the run".to_owned();
            RunError::from(SceneError::Invalid { name, problems, more: 0, further: false })
        };
        let Beginning::Checkpoint { checkpoint, .. } = &mut self.beginning else {
            return Err(refused(
                "stages",
                "found a run that has not begun",
                "one that is resumed, or a scene with stages",
            ));
        };
        let (step, last) = (checkpoint.state.step, self.scene.time.steps);
        if step == 0 || last <= step {
            let found = format!("found {last} steps in all, of which {step} are behind");
            return Err(refused("time.steps", &found, "more steps: `--steps N` says how many in all"));
        }
        let ends = self.scene.ends_of_stages();
        let begun = ends.iter().filter(|end| **end < step).count().max(1);
        let mut stages = self.scene.stages_of_run();
        stages.truncate(begun);
        if let Some(current) = stages.last_mut() {
            let own = step - ends[begun - 1];
            if !current.ramp.is_empty() && own < current.steps {
                return Err(refused("stages", "found a checkpoint in the middle of a ramp", "the end of the ramp"));
            }
            current.steps = own;
        }
        let mut set = Map::new();
        for setting in settings {
            let (key, value) = setting.split_once('=').unwrap_or((setting, ""));
            let value = value_of(value.trim()).map_err(|accepted| refused(key, "found no value", &accepted))?;
            set.insert(key.trim().to_owned(), value);
        }
        stages.push(Stage::new(last - step, set));
        let before = checkpoint.scene.part_of(step.saturating_sub(1))?;
        let mut changed = (*self.scene).clone();
        changed.stages = stages;
        self.scene = changed.check_kept("the scene of the run")?;
        let after = self.scene.part_of(step)?;
        let (state, rounding) = in_units_of(&after, &before, std::mem::take(&mut checkpoint.state))?;
        if before.model().units.momentum != after.model().units.momentum {
            // Sums that are kept to the last bit are counted in other units from here on.
            checkpoint.sections.retain(|(name, _)| name != kept_sums::SECTION);
            let fresh = Sections::new(Path::new(files::CHECKPOINT), 0, &[]);
            let sums = KeptSums::new(after.model(), &state, &fresh, Sharing::default())?;
            checkpoint.sections.extend(sums.sections());
            let [x, y, z] = rounding.momentum.map(short);
            self.notices.push(format!(
                "step {step}: the numbers of the new stage need a larger unit, to which momenta were rounded: by up to {} each, their sum by ({x}, {y}, {z})",
                short(rounding.largest)
            ));
        }
        checkpoint.state = state;
        checkpoint.scene = self.scene.clone();
        Ok(self)
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
        let first_step = self.first_step();
        let Self { scene, beginning, interrupt, notices, id, division, mixed, draws } = self;
        let parts = scene.parts()?;
        let first = parts[part_at(&parts, first_step)].clone();
        let part = division.map(|division| Part { division, rank: 0 });
        let constants_in = replica.as_ref().map_or(ConstantsIn::Code, Replica::constants_in);
        let mut options = Options { constants_in, part, ..Options::default() };
        // Whatever takes long before the first step can be left; until then nothing is written, or there is a checkpoint already.
        let is_new = matches!(beginning, Beginning::New { .. });
        let asked = interrupt.clone();
        let proceed = move || if is_new && asked.is_asked() { Err(RunError::NotBegun) } else { Ok(()) };
        let keep_alive = || processes.iter().for_each(|processes| processes.channel().keep_alive());
        let planned = replica.as_ref().map(|replica| plan_on(&first, replica.gpu(), options)).transpose()?;
        let suited = planned.filter(|(_, plan)| replica.as_ref().is_some_and(|replica| replica.suits(plan)));
        let (mut gpu, mut plan) = if let Some(suited) = suited {
            suited
        } else {
            replica = None;
            options.constants_in = ConstantsIn::Code;
            open_adapter(&first, choice, options)?
        };
        keep_alive();
        proceed()?;
        let (directory, mut start, earlier, replaces) = match beginning {
            Beginning::New { directory, force } => {
                // In units of all its stages.
                let state = families::initial_state(&first);
                proceed()?;
                families::check_start(&first, &state)?;
                proceed()?;
                let directory = RunDirectory::make(directory)?;
                directory.in_the_way(force)?;
                let start =
                    Checkpoint { run_id: id, scene: scene.clone(), state, files: Vec::new(), sections: Vec::new() };
                (directory, start, None, Some(force))
            }
            Beginning::Checkpoint { directory, checkpoint, earlier } => {
                if let Some(earlier) = &earlier {
                    set_aside(&directory, &scene, &checkpoint, earlier)?;
                }
                (directory, *checkpoint, earlier, None)
            }
        };
        keep_alive();
        let last_step = scene.time.steps;
        let mut pace = Pace::new(scene.model().particle_count(), plan.operations_per_particle);
        let unseen = unseen_card(gpu.description(), choice);
        let task = Task { id, scene, parts, directory, interrupt, notices, unseen, mixed, draws, earlier };
        let mut begun = false;
        let mut kept: Option<Box<dyn Stepper + '_>> = None;
        loop {
            if kept.is_none() {
                observer(Event::Compiling { kernels: plan.kernels.len() });
            }
            let opened = match (kept.take(), replica.take()) {
                (Some(engine), _) => Ok(engine),
                (None, Some(replica)) => {
                    let engine = Engine::of_replica(replica, plan.clone(), &start.state).map_err(RunError::from);
                    engine.map(|engine| -> Box<dyn Stepper> { Box::new(engine) })
                }
                (None, None) => open(&task, &gpu, plan.clone(), (choice, processes), options, &start),
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
                let ended = attempt(&task, &gpu, engine.as_mut(), &mut start, &mut pace, observer)?;
                Ok((ended, engine))
            });
            match ended {
                Ok((Ended::Part(next), mut engine)) => {
                    start = *next;
                    let step = start.state.step;
                    let ends = task.scene.ends_of_stages();
                    if let Some(number) = ends.iter().position(|end| *end == step) {
                        observer(Event::Stage { number, of: task.scene.stages.len() });
                    }
                    let part = &task.parts[task.part_at(step)];
                    let written = serde_json::to_string(part).unwrap_or_default();
                    let renumbered = plan_on(part, &gpu, options).ok().filter(|(_, plan)| {
                        // A failure shows again where an engine is opened.
                        engine.renumber(plan, &written, &start.state).unwrap_or(false)
                    });
                    if let Some((_, renumbered)) = renumbered {
                        (plan, kept) = (renumbered, Some(engine));
                    } else {
                        drop(engine);
                        (gpu, plan) = open_adapter(part, choice, options)?;
                    }
                    keep_alive();
                }
                Ok((Ended::Run(outcome), _)) => return Ok(*outcome),
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
                    (gpu, plan) = open_adapter(&task.parts[task.part_at(start.state.step)], choice, options)?;
                    keep_alive();
                }
                Err(error) => return Err(error),
            }
        }
    }
}

/// Moves what analyses have left of a stage that was the last, and after which another one begins now, into a directory of its own.
fn set_aside(
    directory: &RunDirectory,
    scene: &Checked,
    checkpoint: &Checkpoint,
    earlier: &Summary,
) -> Result<(), RunError> {
    let step = checkpoint.state.step;
    let Some(number) = scene.ends_of_stages()[1..].iter().position(|end| *end == step) else { return Ok(()) };
    let of_stage = scene.stages[number].output(&scene.output, false).unwrap_or_default();
    if earlier.steps != step || number + 1 == scene.stages.len() || of_stage.analyses().is_empty() {
        return Ok(());
    }
    let stage = directory.make_stage(number + 1)?;
    let mut summary = earlier.clone();
    summary.scene = checkpoint.scene.part_of(step)?.into_scene();
    summary.stages = Vec::new();
    for name in files::of_analyses() {
        let path = directory.file(name);
        if path.exists() {
            std::fs::rename(&path, stage.file(name)).map_err(OutputError::io("move", &path))?;
        }
    }
    summary.tables = stage.tables()?;
    let path = stage.file(files::SUMMARY);
    // Written first, for it is one of its files.
    summary.save(&path)?;
    summary.files = Some(stage.written());
    Ok(summary.save(&path)?)
}

/// The end of a part of a run.
enum Ended {
    /// It was the last.
    Run(Box<Outcome>),
    /// Another one begins here.
    Part(Box<Checkpoint>),
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
    gpu: &Gpu,
    plan: Plan,
    (choice, processes): (&AdapterChoice, Option<&'a dyn Processes>),
    options: Options,
    start: &Checkpoint,
) -> Result<Box<dyn Stepper + 'a>, RunError> {
    let scene = &task.parts[task.part_at(start.state.step)];
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

/// Runs from `start` to the end of its part.
fn attempt(
    task: &Task,
    gpu: &Gpu,
    engine: &mut (dyn Stepper + '_),
    start: &mut Checkpoint,
    pace: &mut Pace,
    observer: &mut dyn FnMut(Event<'_>),
) -> Result<Ended, RunError> {
    let mut run = Execution::open(task, gpu, engine, start)?;
    let scene = run.scene;
    run.notices = &task.notices;
    let is_last = run.is_last();
    let next = run.advance_to_end(engine, start, pace, observer).and_then(|()| {
        // The last steps may turn out to have failed only here.
        if is_last { Ok(None) } else { run.hand_over(engine, pace).map(Some) }
    });
    match next {
        Err(RunError::Engine(source @ (EngineError::Unstable(_) | EngineError::GaveUp { .. }))) => {
            run.energies.file.flush()?;
            let (checkpoint, checkpoint_step) = (task.directory.file(files::CHECKPOINT), run.saved_step);
            return Err(match source {
                EngineError::Unstable(failure) => {
                    let source = Instability::new(&failure, engine.plan(), scene.model());
                    RunError::Unstable { source, checkpoint, checkpoint_step }
                }
                source => RunError::GaveUp { source, checkpoint, checkpoint_step },
            });
        }
        Err(error) => return Err(task.stopped(error, run.saved_step)),
        Ok(Some(next)) => return Ok(Ended::Part(Box::new(next))),
        Ok(None) => {}
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
    let outcome = run.conclude(engine, warnings, pace.done()).map_err(|error| task.stopped(error, saved_step))?;
    Ok(Ended::Run(Box::new(outcome)))
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
