//! A sweep from its first variant to its last plot.

use super::directory;
use super::error::SweepError;
use super::expansion::{Sweep, Variant};
use super::look::Look;
use super::plots;
use super::summary::SweepSummary;
use super::variant::VariantSummary;
use super::{default_jobs, files, table};
use crate::families::Model;
use crate::gpu::{AdapterChoice, AdapterDescription, Gpu};
use crate::output::summary::AdapterSummary;
use crate::output::{Id, OutputError, RunDirectory, Summary, files as run_files, of_one_run};
use crate::plan::{Hardware, Options};
use crate::run::{self, Event, Interrupt, Outcome, Progress, RunError, Simulation};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;

/// A sweep to be executed, from the beginning or from where it was interrupted.
#[derive(Debug, Clone)]
pub struct SweepRun {
    sweep: Sweep,
    summary: SweepSummary,
    directory: PathBuf,
    beginning: Beginning,
    interrupt: Interrupt,
}

#[derive(Debug, Clone)]
enum Beginning {
    New { force: bool },
    Interrupted { directory: RunDirectory },
}

/// What an observer of a sweep receives.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum SweepEvent<'a> {
    /// The adapter is open and the directory is ready.
    Started {
        /// The adapter.
        adapter: &'a AdapterDescription,
        /// Variants that are not finished yet.
        waiting: usize,
        /// How many of them run at once.
        jobs: usize,
    },
    /// A variant begins, at this step.
    Begun {
        /// Its number.
        variant: usize,
        /// The step it begins with.
        first_step: u64,
    },
    /// A variant has come further.
    Advanced {
        /// Its number.
        variant: usize,
        /// How far.
        progress: Progress,
    },
    /// A variant is finished or has failed.
    Ended {
        /// Its number.
        variant: usize,
        /// What came out.
        summary: &'a VariantSummary,
    },
    /// All variants have ended; the plots follow.
    Finishing,
}

/// What a sweep leaves.
#[derive(Debug)]
#[non_exhaustive]
pub struct SweepOutcome {
    /// What `sweep.json` says.
    pub summary: SweepSummary,
    /// Numbers of the variants that failed, and why.
    pub failures: Vec<(usize, RunError)>,
    /// Names of the files of the sweep that are in its directory, without the directories of the variants.
    pub files: Vec<String>,
}

/// What a worker reports.
enum Message {
    Begun(u64),
    Advanced(Progress),
    Ended(Box<Result<Outcome, RunError>>),
}

impl SweepRun {
    /// All variants from their first step, in directories below `directory`, which is created. With `force` an earlier
    /// sweep there is replaced.
    #[must_use]
    pub fn start(sweep: Sweep, directory: impl Into<PathBuf>, look: Look, force: bool) -> Self {
        let summary = SweepSummary::new(&sweep, look);
        let (directory, beginning) = (directory.into(), Beginning::New { force });
        Self { sweep, summary, directory, beginning, interrupt: Interrupt::default() }
    }

    /// What is missing of the sweep in a directory: variants under way continue from their last checkpoints, those that
    /// failed are tried again. The plots are drawn again, with another look where one is given. The directory belongs to
    /// this process from now on, until the sweep is dropped or executed.
    ///
    /// # Errors
    /// [`SweepError::NoSweep`], [`SweepError::Output`] when another process writes there, and what [`Sweep::load`] and the
    /// files of the sweep give rise to.
    pub fn resume(directory: impl Into<PathBuf>, look: Option<Look>) -> Result<Self, SweepError> {
        let directory = directory.into();
        // Nothing is written where there is no sweep, no lock either.
        SweepSummary::load(&directory)?;
        let claimed = RunDirectory::claim(&directory)?;
        let mut summary = SweepSummary::load(&directory)?;
        let sweep = summary.sweep(&directory)?;
        claimed.check_pictures(summary.sweep_id, files::SUMMARY, files::is_of_a_sweep)?;
        let look = look.unwrap_or_else(|| summary.plots.clone());
        summary = summary.begun_again(&sweep, look);
        for (variant, entry) in sweep.variants().iter().zip(&mut summary.variants) {
            if let Some(run) = finished(&directory.join(&variant.name), variant, entry.run_id) {
                entry.finish(&run);
            }
        }
        let beginning = Beginning::Interrupted { directory: claimed };
        Ok(Self { sweep, summary, directory, beginning, interrupt: Interrupt::default() })
    }

    /// The same sweep, whose variants save checkpoints and stop when it is asked to.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// The sweep.
    #[must_use]
    pub fn sweep(&self) -> &Sweep {
        &self.sweep
    }

    /// Numbers of the variants that are not finished.
    #[must_use]
    pub fn waiting(&self) -> Vec<usize> {
        let variants = self.summary.variants.iter().enumerate();
        variants.filter(|(_, entry)| entry.state != super::VariantState::Finished).map(|(number, _)| number).collect()
    }

    /// Runs the variants that are not finished, `jobs` at once or as many as [`default_jobs`] says, and writes table,
    /// summary and plots. Table and summary are up to date after every variant. A variant that fails does not stop the
    /// others.
    ///
    /// # Errors
    /// [`SweepError`]: no usable adapter, a quantity to plot that nobody measures, files of the sweep itself that
    /// cannot be written, an interruption. Failures of variants are in the outcome.
    pub fn execute(
        mut self,
        choice: &AdapterChoice,
        jobs: Option<usize>,
        observer: &mut dyn FnMut(SweepEvent<'_>),
    ) -> Result<SweepOutcome, SweepError> {
        self.summary.plots.check(&self.sweep)?;
        let waiting = self.waiting();
        // Before the directory: an adapter that is not there should not cost an earlier sweep its files.
        let (gpu, largest) = self.open_adapter(choice, &waiting)?;
        // The directory is that of this process until the end.
        let claimed = match &self.beginning {
            Beginning::New { force } => directory::create(&self.directory, &self.sweep, *force)?,
            Beginning::Interrupted { directory } => directory.clone(),
        };
        let adapter = gpu.description();
        if !waiting.is_empty() {
            self.summary.adapter = Some(AdapterSummary {
                name: adapter.name.clone(),
                driver: adapter.driver.clone(),
                backend: adapter.backend.clone(),
            });
        }
        self.summary.average();
        save(&self.directory, &self.sweep, &self.summary)?;
        let jobs = jobs.unwrap_or_else(|| default_jobs(adapter, largest, waiting.len())).clamp(1, waiting.len().max(1));
        observer(SweepEvent::Started { adapter, waiting: waiting.len(), jobs });
        let failures = self.run_all(&waiting, jobs, choice, observer)?;
        let proceed = || {
            if !self.interrupt.is_asked() {
                return Ok(());
            }
            let all = self.sweep.variants().len();
            let finished = all - self.waiting().len();
            Err(SweepError::Interrupted { finished, all, directory: self.directory.clone() })
        };
        proceed()?;
        observer(SweepEvent::Finishing);
        let style = plots::style(&self.sweep);
        let drawn = plots::draw(&claimed, &self.sweep, &self.summary, &style, &gpu, &proceed)?;
        let averages = (!self.summary.averages.is_empty()).then_some(files::AVERAGES);
        let tables = [files::TABLE].into_iter().chain(averages).chain([files::SUMMARY]);
        let files = tables.map(str::to_owned).chain(drawn).collect();
        Ok(SweepOutcome { summary: self.summary, failures, files })
    }

    /// Opens an adapter with the capacity for the largest of these variants, and says how many operations a step of it takes.
    fn open_adapter(&self, choice: &AdapterChoice, waiting: &[usize]) -> Result<(Gpu, f64), SweepError> {
        let scenes = waiting.iter().map(|number| &self.sweep.variants()[*number].scene);
        let Some(scene) = scenes.max_by_key(|scene| Model::new(scene).particle_count()) else {
            // Nothing to run: plots take little room.
            return Ok((Gpu::open(choice, crate::gpu::Requirements::default())?, 0.0));
        };
        let gpu = run::adapter_for(scene, choice)?;
        let plan = run::plan(
            &Model::new(scene),
            scene.time.equilibration,
            &scene.output,
            Hardware::from(&gpu),
            Options::default(),
        );
        Ok((gpu, plan.particles as f64 * plan.operations_per_particle))
    }

    fn run_all(
        &mut self,
        waiting: &[usize],
        jobs: usize,
        choice: &AdapterChoice,
        observer: &mut dyn FnMut(SweepEvent<'_>),
    ) -> Result<Vec<(usize, RunError)>, SweepError> {
        let Self { sweep, summary, directory, beginning, interrupt } = self;
        let (sweep, directory, resuming) =
            (&*sweep, directory.as_path(), matches!(beginning, Beginning::Interrupted { .. }));
        let interrupt = &*interrupt;
        let ids: Vec<Id> = summary.variants.iter().map(|variant| variant.run_id).collect();
        let ids = &ids;
        let next = AtomicUsize::new(0);
        let (sender, receiver) = mpsc::channel();
        let mut failures = Vec::new();
        let mut trouble = Ok(());
        thread::scope(|scope| {
            for _ in 0..jobs {
                let (sender, next) = (sender.clone(), &next);
                scope.spawn(move || {
                    while let Some(number) = waiting.get(next.fetch_add(1, Ordering::Relaxed)) {
                        if interrupt.is_asked() {
                            break;
                        }
                        let variant = &sweep.variants()[*number];
                        let simulation = simulation(variant, ids[*number], &directory.join(&variant.name), resuming);
                        work(*number, simulation, interrupt, choice, &sender);
                    }
                });
            }
            drop(sender);
            for (number, message) in receiver {
                match message {
                    Message::Begun(first_step) => observer(SweepEvent::Begun { variant: number, first_step }),
                    Message::Advanced(progress) => observer(SweepEvent::Advanced { variant: number, progress }),
                    Message::Ended(result) => {
                        match *result {
                            Ok(outcome) => summary.variants[number].finish(&outcome.summary),
                            // It waits to be continued.
                            Err(RunError::Interrupted { .. }) => continue,
                            Err(error) => {
                                summary.variants[number].fail(error.to_string());
                                failures.push((number, error));
                            }
                        }
                        summary.average();
                        if let Err(error) = save(directory, sweep, summary) {
                            // Variants under way may end; no others begin.
                            next.store(waiting.len(), Ordering::Relaxed);
                            trouble = Err(error);
                        }
                        observer(SweepEvent::Ended { variant: number, summary: &summary.variants[number] });
                    }
                }
            }
        });
        failures.sort_by_key(|(number, _)| *number);
        trouble.map(|()| failures)
    }
}

/// Writes table and summary.
fn save(directory: &Path, sweep: &Sweep, summary: &SweepSummary) -> Result<(), SweepError> {
    summary.save(directory)?;
    Ok(table::write(directory, summary, &sweep.keys())?)
}

/// The run of a variant: from its checkpoint if a sweep is resumed and there is one, else from the beginning.
fn simulation(variant: &Variant, id: Id, directory: &Path, resuming: bool) -> Result<Simulation, RunError> {
    let steps = variant.scene.time.steps;
    let begin = |force| Simulation::start(variant.scene.clone(), directory, force).with_id(id).noting(&variant.notices);
    if !resuming {
        return Ok(begin(false));
    }
    if directory.is_dir() {
        // The run of another scene is not to be continued, nor to be overwritten.
        RunDirectory::open(directory)?.check_run(id, files::SUMMARY)?;
    }
    if !directory.join(run_files::CHECKPOINT).exists() {
        // What a resumed sweep finds without a checkpoint is the beginning of this very run.
        return Ok(begin(true));
    }
    let simulation = Simulation::resume(directory, Some(steps))?;
    if simulation.first_step() > steps {
        return Err(OutputError::Continued { directory: directory.to_path_buf(), finished: steps }.into());
    }
    Ok(simulation)
}

fn work(
    number: usize,
    simulation: Result<Simulation, RunError>,
    interrupt: &Interrupt,
    choice: &AdapterChoice,
    sender: &mpsc::Sender<(usize, Message)>,
) {
    // If nobody listens any more, there is nobody to report.
    let report = |message: Message| drop(sender.send((number, message)));
    let result = simulation.and_then(|simulation| {
        report(Message::Begun(simulation.first_step()));
        simulation.until(interrupt).execute(choice, &mut |event| {
            if let Event::Advanced(progress) = event {
                report(Message::Advanced(progress));
            }
        })
    });
    report(Message::Ended(Box::new(result)));
}

/// The summary of the run of a variant, if it reached its last step and left all of its files.
fn finished(directory: &Path, variant: &Variant, id: Id) -> Option<Summary> {
    if !directory.is_dir() {
        return None;
    }
    // A process that still writes there is not finished; what a killed one left half-written is removed.
    let directory = RunDirectory::claim(directory).ok()?;
    directory.check_run(id, files::SUMMARY).ok()?;
    let reached_its_end = |summary: &Summary| {
        summary.run_id == id && summary.steps >= variant.scene.time.steps && of_one_run(&summary.scene, &variant.scene)
    };
    let summary = Summary::load(&directory.file(run_files::SUMMARY)).ok().filter(reached_its_end)?;
    summary.is_complete(&directory).then_some(summary)
}
