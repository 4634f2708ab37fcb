//! A study under way: from its beginning, or from where it was interrupted.

use super::concurrency::default_jobs;
use super::directory;
use super::error::StudyError;
use super::groups::{Alike, Group, default_replicas};
use super::members::Member;
use super::record::{self, Record};
use crate::families::Checked;
use crate::gpu::{AdapterChoice, AdapterDescription, Gpu, Requirements};
use crate::output::{OutputError, RunDirectory, write_atomically};
use crate::plan::{Hardware, Options};
use crate::plot::Plotter;
use crate::run::{self, Interrupt, Progress, RunError};
use crate::scene::PlotStyle;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Time from which on a user has to say that all runs may take so long.
pub const LONG: Duration = Duration::from_hours(8);

/// A study to be executed, from the beginning or from where it was interrupted.
#[derive(Debug, Clone)]
pub struct StudyRun<R: Record> {
    pub(crate) request: R::Request,
    pub(crate) summary: R,
    path: PathBuf,
    /// True if a new one may replace what an earlier one left.
    force: bool,
    /// The directory of one that goes on.
    claimed: Option<RunDirectory>,
    interrupt: Interrupt,
    jobs: Option<usize>,
    replicas: Option<usize>,
    longest: Option<Duration>,
}

/// What an observer of a study receives; `E` is what becomes of a run, `P` what follows after the first runs.
#[derive(Debug)]
#[non_exhaustive]
pub enum StudyEvent<'a, E, P> {
    /// The adapter is open and the directory is ready.
    Started {
        /// The adapter.
        adapter: &'a AdapterDescription,
        /// Runs that are not finished yet.
        runs: usize,
        /// The number of them that run at once, at most.
        at_once: usize,
        /// Seconds that they are expected to take, where that is known.
        seconds: Option<f64>,
    },
    /// A run begins, at this step.
    Begun {
        /// Its name.
        run: &'a str,
        /// The step it begins with.
        first_step: u64,
    },
    /// A run has come further.
    Advanced {
        /// Its name.
        run: &'a str,
        /// How far.
        progress: Progress,
    },
    /// A run has ended.
    Ended {
        /// Its name.
        run: &'a str,
        /// What became of it.
        ended: &'a E,
    },
    /// All runs so far have ended, and something else follows.
    Phase {
        /// What follows.
        phase: &'a P,
        /// Runs that it consists of.
        runs: usize,
    },
    /// Tables and pictures follow.
    Finishing,
}

/// The result of a study.
#[derive(Debug)]
#[non_exhaustive]
pub struct StudyOutcome<R> {
    /// Its summary.
    pub summary: R,
    /// Names of the files in its directory, without those of the runs.
    pub files: Vec<String>,
}

/// What observes a study.
pub type Observer<'o, R> = dyn FnMut(StudyEvent<'_, <R as Record>::Ended, <R as Record>::Phase>) + 'o;

impl<R: Record> StudyRun<R> {
    /// All runs from the first, into `directory`, which is created.
    #[must_use]
    pub fn start(request: R::Request, directory: impl Into<PathBuf>) -> Self {
        let summary = R::before(&request);
        Self::of(request, summary, directory.into())
    }

    /// The same in place of an earlier study there, whose files and runs are removed.
    #[must_use]
    pub fn replace(request: R::Request, directory: impl Into<PathBuf>) -> Self {
        Self { force: true, ..Self::start(request, directory) }
    }

    /// What is missing of the study in a directory: runs under way continue from their last checkpoints, those that failed are
    /// tried again. The directory belongs to this process from now on, until the study is dropped or executed.
    ///
    /// # Errors
    /// [`StudyError::Nothing`] when there is none; [`StudyError::Changed`], [`StudyError::Later`] and [`StudyError::Output`] when its
    /// summary was edited, is of a later version or cannot be read, or when another process writes there.
    pub fn resume(directory: impl Into<PathBuf>) -> Result<Self, StudyError> {
        let path = directory.into();
        let (record, request, directory) = record::reopen::<R>(&path)?;
        let summary = record.resumed(&request, &directory);
        Ok(Self { claimed: Some(directory), ..Self::of(request, summary, path) })
    }

    fn of(request: R::Request, summary: R, path: PathBuf) -> Self {
        let interrupt = Interrupt::default();
        Self {
            request,
            summary,
            path,
            force: false,
            claimed: None,
            interrupt,
            jobs: None,
            replicas: None,
            longest: None,
        }
    }

    /// The same study, which stops when it is asked to: what is known by then is kept, and runs save checkpoints.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// The same study, so many runs at once; without a number as many as [`default_jobs`] says.
    #[must_use]
    pub fn with_jobs(self, jobs: Option<usize>) -> Self {
        Self { jobs, ..self }
    }

    /// The same study, which advances so many runs together in the dispatches of one, where their plans differ in numbers only. Without a
    /// number they are as many as [`default_replicas`] says, of those that differ in their seeds: each has the bytes that it has alone.
    #[must_use]
    pub fn with_replicas(self, replicas: Option<usize>) -> Self {
        Self { replicas, ..self }
    }

    /// The same study, which does not begin what is expected to take longer than this; without a time it may take as long as it likes.
    #[must_use]
    pub fn up_to(self, longest: Option<Duration>) -> Self {
        Self { longest, ..self }
    }

    /// What it was asked for.
    #[must_use]
    pub fn request(&self) -> &R::Request {
        &self.request
    }

    /// Its directory.
    #[must_use]
    pub fn directory(&self) -> &Path {
        &self.path
    }

    pub(crate) fn is_new(&self) -> bool {
        self.claimed.is_none()
    }

    /// Refuses a directory in which the study would replace something it may not; nothing is written.
    pub(crate) fn check_place(&self) -> Result<(), OutputError> {
        if self.is_new() {
            directory::check(&self.path, &self.summary, self.force)?;
        }
        Ok(())
    }

    /// The directory, made where the study is new: that of this process until the end.
    pub(crate) fn open_place(&self) -> Result<RunDirectory, OutputError> {
        let create = || directory::create(&self.path, &self.summary, self.force);
        self.claimed.clone().map_or_else(create, Ok)
    }

    /// Writes the summary.
    pub(crate) fn save(&self) -> Result<(), OutputError> {
        record::save(&self.summary, &self.path)
    }

    /// Writes tables, page and summary, and names their files.
    pub(crate) fn write(&self) -> Result<Vec<String>, OutputError> {
        let (tables, page) = (self.summary.tables(&self.request), self.summary.page(&self.request));
        for (name, text) in tables.iter().chain(&page) {
            write_atomically(&self.path.join(name), |writer| writer.write_all(text.as_bytes()))?;
        }
        self.save()?;
        let [tables, page] = [tables, page.into_iter().collect()].map(|texts| texts.into_iter().map(|(name, _)| name));
        Ok(tables.chain([R::KIND.summary]).chain(page).map(str::to_owned).collect())
    }

    /// Writes and draws all that a study leaves at its end.
    pub(crate) fn finish(
        self,
        place: &RunDirectory,
        gpu: &Gpu,
        observer: &mut Observer<'_, R>,
    ) -> Result<StudyOutcome<R>, StudyError> {
        observer(StudyEvent::Finishing);
        let mut files = self.write()?;
        let style = self.summary.style(&self.request, &[])?;
        files.extend(draw(place, &self.summary, &self.request, &style, gpu, &|| self.proceed())?);
        Ok(StudyOutcome { summary: self.summary, files })
    }

    pub(crate) fn interrupt(&self) -> &Interrupt {
        &self.interrupt
    }

    /// Whether to go on.
    ///
    /// # Errors
    /// [`StudyError::Interrupted`] if it was asked to stop.
    pub(crate) fn proceed(&self) -> Result<(), StudyError> {
        if !self.interrupt.is_asked() {
            return Ok(());
        }
        let progress = self.summary.progress();
        Err(StudyError::Interrupted { kind: R::KIND, progress, directory: self.path.clone() })
    }

    /// Refuses what takes so many seconds, unless it may.
    pub(crate) fn refuse_long(&self, seconds: f64) -> Result<(), StudyError> {
        if self.longest.is_none_or(|longest| seconds <= longest.as_secs_f64()) {
            return Ok(());
        }
        Err(StudyError::Long { kind: R::KIND, expected: in_hours(seconds) })
    }

    /// Runs that a device advances together, and those that it advances alone.
    pub(super) fn groups(&self, members: &[Member], choice: &AdapterChoice) -> Vec<Group> {
        let alone = || Group::of_each(members.len());
        let Some(largest) = largest(members.iter().map(|member| &member.scene)) else { return alone() };
        if self.replicas == Some(1) || members.len() < 2 {
            return alone();
        }
        // A run that opens an adapter says what is wrong with it.
        let Ok(gpu) = run::adapter_for(largest, choice) else { return alone() };
        let most = self.replicas_for(largest, members.len(), &gpu);
        if most < 2 {
            return alone();
        }
        let alike = if self.replicas.is_some() { Alike::ButForNumbers } else { Alike::InConstants };
        Group::of_alike(members, most, alike, &gpu)
    }

    /// The number of so many runs of a scene that the device advances together.
    pub(crate) fn replicas_for(&self, scene: &Checked, runs: usize, gpu: &Gpu) -> usize {
        let default = || default_replicas(gpu.description(), scene.model().particle_count(), runs);
        self.replicas.unwrap_or_else(default)
    }

    /// The number of runs that are under way at once, at most, in so many jobs.
    pub(crate) fn under_way(&self, jobs: usize, scene: &Checked, runs: usize, gpu: &Gpu) -> usize {
        (jobs * self.replicas_for(scene, runs, gpu)).clamp(1, runs.max(1))
    }

    /// The number of runs, or of groups of runs that are advanced together, that are under way at once, of so many runs of which this scene is the
    /// largest.
    pub(crate) fn jobs_for(&self, scene: &Checked, runs: usize, gpu: &Gpu) -> usize {
        if self.jobs.is_none() && self.replicas_for(scene, runs, gpu) > 1 {
            return 1;
        }
        let largest = || {
            let plan = run::plan(scene, Hardware::from(gpu), Options::default());
            plan.particles as f64 * plan.operations_per_particle
        };
        self.jobs.unwrap_or_else(|| default_jobs(gpu.description(), largest(), runs)).clamp(1, runs.max(1))
    }
}

/// A long time in hours or days.
pub(crate) fn in_hours(seconds: f64) -> String {
    let hours = seconds / 3600.0;
    if hours < 48.0 { format!("{hours:.0} hours") } else { format!("{:.0} days", hours / 24.0) }
}

/// The scene of the most particles.
pub(crate) fn largest<'a>(scenes: impl Iterator<Item = &'a Checked>) -> Option<&'a Checked> {
    scenes.max_by_key(|scene| scene.model().particle_count())
}

/// Draws the pictures of the study in a directory again from what it left, with changes to the look given as overrides of the scene
/// (`output.plot.width=800`). Returns the names of the files written.
///
/// # Errors
/// [`StudyError`] when there is no study of this kind in the directory, an override does not fit, or a picture cannot be drawn.
pub fn redraw<R: Record>(
    directory: &Path,
    choice: &AdapterChoice,
    overrides: &[String],
) -> Result<Vec<String>, StudyError> {
    let (record, request, place) = record::reopen::<R>(directory)?;
    let style = record.style(&request, overrides)?;
    let gpu = Gpu::open(choice, Requirements::default())?;
    draw(&place, &record, &request, &style, &gpu, &|| Ok(()))
}

/// Draws the pictures of a study into its directory, and names their files; `proceed` says before each whether to.
fn draw<R: Record>(
    place: &RunDirectory,
    record: &R,
    request: &R::Request,
    style: &PlotStyle,
    gpu: &Gpu,
    proceed: &dyn Fn() -> Result<(), StudyError>,
) -> Result<Vec<String>, StudyError> {
    let charts = record.charts(request, place)?;
    let plotter = Plotter::new(gpu).map_err(|source| RunError::Plot { name: "*.png".to_owned(), source })?;
    let mut written = Vec::new();
    for (name, chart) in charts {
        proceed()?;
        run::save(place, &name, record.id(), plotter.draw_chart(&chart, style))?;
        let vector = run::save_vector(place, &name, record.id(), &chart, style)?;
        written.push(name);
        written.extend(vector);
    }
    Ok(written)
}
