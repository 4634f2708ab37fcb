//! A map of stability from its first scene to its page.

use super::cell::{Cell, Comparison, evaluate};
use super::error::StabilityError;
use super::request::Request;
use super::summary::StabilitySummary;
use super::{chart, files, page, table};
use crate::families::Model;
use crate::gpu::{AdapterChoice, AdapterDescription, Gpu};
use crate::output::summary::AdapterSummary;
use crate::output::{OutputError, RunDirectory, write_atomically};
use crate::plan::{Hardware, Options};
use crate::plot::Plotter;
use crate::run::{self, Interrupt, RunError};
use crate::scene::Scene;
use crate::sweep::default_jobs;
use crate::tradeoff::hours;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Instant;

/// Seconds from which on a user has to say that all runs may take so long.
const LONG: f64 = 8.0 * 3600.0;

/// A map to be made, from the beginning or from where it was interrupted.
#[derive(Debug, Clone)]
pub struct StabilityRun {
    request: Request,
    summary: StabilitySummary,
    directory: PathBuf,
    beginning: Beginning,
    interrupt: Interrupt,
    may_be_long: bool,
}

#[derive(Debug, Clone)]
enum Beginning {
    New { force: bool },
    Interrupted { directory: RunDirectory },
}

/// What an observer of a map receives.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum StabilityEvent<'a> {
    /// The adapter is open; the scenes follow.
    Started {
        /// The adapter.
        adapter: &'a AdapterDescription,
        /// Scenes of the grid that were not run yet.
        waiting: usize,
        /// How many run at once.
        jobs: usize,
        /// Seconds that they are expected to take, where that is known.
        seconds: Option<f64>,
    },
    /// It is known what becomes of a scene.
    Ended {
        /// What its row is called.
        row: &'a str,
        /// What became of it.
        cell: &'a Cell,
    },
    /// So many scenes between those before locate edges.
    Bisecting {
        /// Their number.
        scenes: usize,
    },
    /// Tables and pictures follow.
    Finishing,
}

/// What a map leaves.
#[derive(Debug)]
#[non_exhaustive]
pub struct StabilityOutcome {
    /// What `stability.json` says.
    pub summary: StabilitySummary,
    /// Names of the files in its directory.
    pub files: Vec<&'static str>,
    /// The page in words.
    pub page: String,
}

/// A scene to be run: its row and its value.
type Place = (usize, f64);

impl StabilityRun {
    /// All scenes from the first, into `directory`, which is created. With `force` an earlier map there is replaced.
    #[must_use]
    pub fn start(request: Request, directory: impl Into<PathBuf>, force: bool) -> Self {
        let summary = StabilitySummary::before(&request);
        let (directory, beginning) = (directory.into(), Beginning::New { force });
        Self { request, summary, directory, beginning, interrupt: Interrupt::default(), may_be_long: true }
    }

    /// What is missing of the map in a directory, which belongs to this process from now on.
    ///
    /// # Errors
    /// [`StabilityError::NoMap`], and what reading its summary gives rise to.
    pub fn resume(directory: impl Into<PathBuf>) -> Result<Self, StabilityError> {
        let directory = directory.into();
        // Nothing is written where there is no map, no lock either.
        StabilitySummary::load(&directory)?;
        let claimed = RunDirectory::claim(&directory)?;
        let summary = StabilitySummary::load(&directory)?;
        let request = Request::new(summary.arguments.clone())?;
        if !summary.is_of(&request) {
            return Err(StabilityError::Changed { path: directory.join(files::SUMMARY) });
        }
        let beginning = Beginning::Interrupted { directory: claimed };
        Ok(Self { request, summary, directory, beginning, interrupt: Interrupt::default(), may_be_long: true })
    }

    /// The same map, which stops when it is asked to: what is known by then is kept.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// The same map, which is refused before it starts if it would take many hours.
    #[must_use]
    pub fn unless_long(self, may_be_long: bool) -> Self {
        Self { may_be_long, ..self }
    }

    /// What it was asked for.
    #[must_use]
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Runs the scenes of the grid, `jobs` at once or as many as suit the adapter, then those that locate edges, and writes table,
    /// picture and page.
    ///
    /// # Errors
    /// [`StabilityError`]. Scenes that become unstable are in the outcome.
    pub fn execute(
        mut self,
        adapter: &AdapterChoice,
        jobs: Option<usize>,
        observer: &mut dyn FnMut(StabilityEvent<'_>),
    ) -> Result<StabilityOutcome, StabilityError> {
        if let Beginning::New { force: false } = self.beginning
            && let Some(path) = in_the_way(&self.directory).into_iter().next()
        {
            return Err(OutputError::ResultExists { path }.into());
        }
        let waiting = self.waiting();
        let of_base = |source: RunError| match source {
            RunError::Gpu(source) => source.into(),
            source => StabilityError::Run { name: self.request.title().to_owned(), source: Box::new(source) },
        };
        let gpu = run::adapter_for(&self.request.base, adapter).map_err(of_base)?;
        let seconds = self.expected(&waiting, &gpu);
        if let Some(seconds) = seconds.filter(|seconds| !self.may_be_long && *seconds > LONG) {
            return Err(StabilityError::Long { expected: hours(seconds) });
        }
        let place = match &self.beginning {
            Beginning::New { .. } => create(&self.directory)?,
            Beginning::Interrupted { directory } => directory.clone(),
        };
        let description = gpu.description();
        self.summary.adapter = Some(AdapterSummary {
            name: description.name.clone(),
            driver: description.driver.clone(),
            backend: description.backend.clone(),
        });
        self.summary.save(place.path())?;
        let plan = run::plan(
            &Model::new(&self.request.base),
            self.request.base.time.equilibration,
            &self.request.base.output,
            Hardware::from(&gpu),
            Options::default(),
        );
        let work = plan.particles as f64 * plan.operations_per_particle;
        let jobs = jobs.unwrap_or_else(|| default_jobs(description, work, self.request.cell_count())).max(1);
        observer(StabilityEvent::Started { adapter: description, waiting: waiting.len(), jobs, seconds });
        let mut waiting = waiting;
        while !waiting.is_empty() {
            self.run_all(&waiting, jobs, adapter, observer)?;
            waiting = self.waiting();
            if !waiting.is_empty() {
                observer(StabilityEvent::Bisecting { scenes: waiting.len() });
            }
        }
        observer(StabilityEvent::Finishing);
        self.finish(&place, &gpu)
    }

    /// Scenes to be run next: those of the grid, or else those that locate edges.
    fn waiting(&self) -> Vec<Place> {
        let along = &self.request.along;
        let known = |row: usize, value: f64| self.summary.rows[row].cells.iter().any(|cell| cell.value == value);
        let rows = 0..self.summary.rows.len();
        let grid: Vec<Place> = rows
            .clone()
            .flat_map(|row| along.values.iter().map(move |value| (row, *value)))
            .filter(|(row, value)| !known(*row, *value))
            .collect();
        if !grid.is_empty() {
            return grid;
        }
        let neighbours = along.values.windows(2).map(|pair| along.spacing.distance(pair[0], pair[1]));
        let spacing = neighbours.fold(f64::INFINITY, f64::min);
        // A little more, as values are rounded to four digits.
        let nearest = 1.01 * spacing / 2.0_f64.powi(self.summary.arguments.bisections as i32);
        rows.flat_map(|row| {
            self.summary.rows[row].next(along.spacing, nearest).into_iter().map(move |value| (row, value))
        })
        .collect()
    }

    /// Seconds that scenes take at the speed of the scene as it is; none where its first steps fail.
    fn expected(&self, places: &[Place], gpu: &Gpu) -> Option<f64> {
        let base = &self.request.base;
        let steps = base.time.steps.max(1) as f64;
        let seconds =
            run::expected_time(&Scene { output: energies_of(base), ..base.clone() }, gpu).ok()?.seconds / steps;
        let scene = |(row, value): &Place| self.request.scene(*row, *value).ok();
        Some(seconds * places.iter().filter_map(scene).map(|scene| scene.time.steps as f64).sum::<f64>())
    }

    fn run_all(
        &mut self,
        places: &[Place],
        jobs: usize,
        adapter: &AdapterChoice,
        observer: &mut dyn FnMut(StabilityEvent<'_>),
    ) -> Result<(), StabilityError> {
        let start = Instant::now();
        let before = self.summary.spent;
        let Self { request, summary, directory, interrupt, .. } = self;
        let (request, interrupt, directory) = (&*request, &*interrupt, directory.as_path());
        let measures = summary.measures.clone();
        let comparison = Comparison {
            measures: &measures,
            references: &request.arguments.references,
            tolerance: request.arguments.tolerance,
        };
        let next = AtomicUsize::new(0);
        let (sender, receiver) = mpsc::channel();
        let mut trouble = Ok(());
        thread::scope(|scope| {
            for _ in 0..jobs.min(places.len()) {
                let (sender, next, comparison) = (sender.clone(), &next, &comparison);
                scope.spawn(move || {
                    while let Some((row, value)) = places.get(next.fetch_add(1, Ordering::Relaxed)) {
                        let ended = match request.scene(*row, *value) {
                            Ok(scene) => evaluate(*value, &scene, comparison, adapter, interrupt),
                            Err(error) => Ok(Some(Cell::refused(*value, error.to_string()))),
                        };
                        // If nobody listens any more, there is nobody to report to.
                        if sender.send((*row, *value, ended)).is_err() || interrupt.is_asked() {
                            break;
                        }
                    }
                });
            }
            drop(sender);
            for (row, value, ended) in receiver {
                let failed = match ended {
                    Ok(Some(cell)) => {
                        observer(StabilityEvent::Ended { row: &summary.rows[row].label, cell: &cell });
                        summary.rows[row].add(cell);
                        summary.spent = before + start.elapsed().as_secs_f64();
                        summary.save(directory).map_err(StabilityError::from)
                    }
                    Ok(None) => Ok(()),
                    Err(source) => {
                        let along = format!("{} = {value}", request.short(&request.along.key));
                        let label = &summary.rows[row].label;
                        let name = if label.is_empty() { along } else { format!("{label}, {along}") };
                        Err(StabilityError::Run { name, source: Box::new(source) })
                    }
                };
                if failed.is_err() && trouble.is_ok() {
                    // Scenes under way may end; no others begin.
                    next.store(places.len(), Ordering::Relaxed);
                    trouble = failed;
                }
            }
        });
        trouble?;
        if self.interrupt.is_asked() {
            return Err(StabilityError::Interrupted { directory: self.directory.clone() });
        }
        Ok(())
    }

    fn finish(self, place: &RunDirectory, gpu: &Gpu) -> Result<StabilityOutcome, StabilityError> {
        let Self { request, summary, .. } = self;
        let page = page::page(&summary, &request);
        write_atomically(&place.file(files::PAGE), |writer| writer.write_all(page.as_bytes()))?;
        table::write(place.path(), &summary)?;
        summary.save(place.path())?;
        let wrong = |source: RunError| StabilityError::Run { name: files::PLOT.to_owned(), source: Box::new(source) };
        let plotter = Plotter::new(gpu.device(), gpu.queue())
            .map_err(|source| wrong(RunError::Plot { name: files::PLOT.to_owned(), source }))?;
        let drawn = plotter.draw_chart(&chart::chart(&summary, &request), &request.base.output.plot);
        run::save(place, files::PLOT, summary.stability_id, drawn).map_err(wrong)?;
        Ok(StabilityOutcome { summary, files: files::ALL.to_vec(), page })
    }
}

/// The output of a scene that is measured in memory.
fn energies_of(scene: &Scene) -> crate::scene::Output {
    crate::scene::Output { energies: scene.output.energies.clone(), ..Default::default() }
}

/// What a new map would replace.
fn in_the_way(path: &Path) -> Vec<PathBuf> {
    files::ALL.iter().map(|name| path.join(name)).filter(|file| file.exists()).collect()
}

/// Creates the directory of a map and takes its lock; an earlier map there is removed.
fn create(path: &Path) -> Result<RunDirectory, OutputError> {
    let directory = RunDirectory::make(path)?;
    for file in in_the_way(path) {
        fs::remove_file(&file).map_err(OutputError::io("replace", &file))?;
    }
    Ok(directory)
}
