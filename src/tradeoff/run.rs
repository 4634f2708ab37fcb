//! A tradeoff from its first run to its page.

use super::cost::{self, Timed};
use super::directory::{create, in_the_way};
use super::error::TradeoffError;
use super::length::{self, Extension};
use super::measures;
use super::request::{COARSER, FINER, Request};
use super::stretch::Stretch;
use super::summary::{Choice, ChoiceState, TradeoffSummary};
use super::target::Verdict;
use super::{advice, charts, fields, files, table};
use crate::gpu::{AdapterChoice, AdapterDescription, Gpu, Requirements};
use crate::output::summary::AdapterSummary;
use crate::output::{Id, OutputError, RunDirectory, Summary, checkpoint, files as run_files, write_atomically};
use crate::plot::Plotter;
use crate::run::{self, Event, Interrupt, Progress, RunError, Simulation};
use crate::scene::Scene;
use crate::self_test;
use std::path::PathBuf;
use std::time::Instant;

/// Seconds from which on a user has to say that all runs may take so long.
const LONG: f64 = 8.0 * 3600.0;
/// What of a budget the first runs may take: they say how long the others have to be.
const PILOT_SHARE: f64 = 0.2;
/// Particles up to which a step is compared with the float64 reference: it takes a processor seconds.
const MOST_COMPARED: usize = 50_000;
/// Rows of the table of energies that a pilot has at least.
const FEWEST_ROWS: f64 = 32.0;
/// By what the runs are made longer where a verdict is open: it halves every uncertainty.
const FOR_A_VERDICT: f64 = 4.0;
/// How often they are made longer for that where no budget says how long they may take.
const MOST_FOR_A_VERDICT: usize = 2;

/// A tradeoff to be executed, from the beginning or from where it was interrupted.
#[derive(Debug, Clone)]
pub struct TradeoffRun {
    request: Request,
    summary: TradeoffSummary,
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

/// What an observer of a tradeoff receives.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum TradeoffEvent<'a> {
    /// The adapter is open; the runs follow.
    Started {
        /// The adapter.
        adapter: &'a AdapterDescription,
        /// Number of runs, with those that references are taken from.
        runs: usize,
        /// Seconds that all of them are expected to take, at first.
        seconds: f64,
    },
    /// A run has come further.
    Advanced {
        /// Its name.
        name: &'a str,
        /// How far.
        progress: Progress,
    },
    /// A run has ended.
    Ended {
        /// What came out.
        choice: &'a Choice,
    },
    /// All runs are made longer, by a factor of the time that means are taken over.
    Extended {
        /// The factor.
        factor: f64,
        /// The largest relative standard error so far, if the reason is that it is too large.
        worst: Option<f64>,
    },
    /// Steps of all choices are timed in turns.
    Timing,
    /// Tables and pictures follow.
    Finishing,
}

/// What a tradeoff leaves.
#[derive(Debug)]
#[non_exhaustive]
pub struct TradeoffOutcome {
    /// What `tradeoff.json` says.
    pub summary: TradeoffSummary,
    /// Names of the files in its directory, without those of the runs.
    pub files: Vec<String>,
    /// The page in words.
    pub page: String,
}

impl TradeoffRun {
    /// All runs from their first step, in directories below `directory`, which is created. With `force` an earlier tradeoff there is
    /// replaced.
    #[must_use]
    pub fn start(request: Request, directory: impl Into<PathBuf>, force: bool) -> Self {
        let (directory, beginning) = (directory.into(), Beginning::New { force });
        let summary = TradeoffSummary::before(&request);
        Self { request, summary, directory, beginning, interrupt: Interrupt::default(), may_be_long: true }
    }

    /// What is missing of the tradeoff in a directory, which belongs to this process from now on.
    ///
    /// # Errors
    /// [`TradeoffError::NoTradeoff`], and what reading its summary gives rise to.
    pub fn resume(directory: impl Into<PathBuf>) -> Result<Self, TradeoffError> {
        let directory = directory.into();
        TradeoffSummary::load(&directory)?;
        let claimed = RunDirectory::claim(&directory)?;
        let summary = TradeoffSummary::load(&directory)?;
        let request = Request::new(summary.arguments.clone())?;
        if !summary.is_of(&request) {
            return Err(TradeoffError::Changed { path: directory.join(files::SUMMARY) });
        }
        let beginning = Beginning::Interrupted { directory: claimed };
        Ok(Self { request, summary, directory, beginning, interrupt: Interrupt::default(), may_be_long: true })
    }

    /// The same tradeoff, whose runs save checkpoints and stop when it is asked to.
    #[must_use]
    pub fn until(self, interrupt: &Interrupt) -> Self {
        Self { interrupt: interrupt.clone(), ..self }
    }

    /// The same tradeoff, which is refused before it starts if it would take many hours and no budget limits it.
    #[must_use]
    pub fn unless_long(self, may_be_long: bool) -> Self {
        Self { may_be_long, ..self }
    }

    /// What it was asked for.
    #[must_use]
    pub fn request(&self) -> &Request {
        &self.request
    }

    /// Runs every choice and what it is compared with, times them, and writes tables, pictures and the page.
    ///
    /// # Errors
    /// [`TradeoffError`]. A choice that becomes unstable is in the outcome.
    pub fn execute(
        mut self,
        adapter: &AdapterChoice,
        observer: &mut dyn FnMut(TradeoffEvent<'_>),
    ) -> Result<TradeoffOutcome, TradeoffError> {
        let runs = self.runs(&self.summary.stretch)?;
        if let Beginning::New { force: false } = self.beginning
            && let Some(path) = in_the_way(&self.directory, &runs).into_iter().next()
        {
            return Err(OutputError::ResultExists { path }.into());
        }
        let seconds = self.plan_pilot(&runs, adapter)?;
        // Steps follow from the stretch, which may be shorter now; all else stays.
        let place = match &self.beginning {
            Beginning::New { .. } => create(&self.directory, &runs)?,
            Beginning::Interrupted { directory } => directory.clone(),
        };
        // Every run opens the adapter for itself, this is to know it.
        let gpu = Gpu::open(adapter, Requirements::default())?;
        let description = gpu.description();
        self.summary.adapter = Some(AdapterSummary {
            name: description.name.clone(),
            driver: description.driver.clone(),
            backend: description.backend.clone(),
        });
        self.summary.save(place.path())?;
        observer(TradeoffEvent::Started { adapter: description, runs: count(&runs), seconds });
        loop {
            let start = Instant::now();
            let advanced = self.advance(&runs, adapter, observer);
            self.summary.spent += start.elapsed().as_secs_f64();
            self.summary.save(place.path())?;
            advanced?;
            self.summary.assess(&self.request)?;
            let spent = self.summary.spent;
            let extension = if self.summary.is_long_enough {
                Extension { factor: 1.0, is_short: self.summary.is_short }
            } else {
                self.extension(spent)
            };
            if extension.factor <= 1.0 {
                self.summary.is_short = extension.is_short;
                break;
            }
            let budget = self.request.arguments.length.budget;
            if budget.is_none() && !self.may_be_long && spent * extension.factor > LONG {
                return Err(TradeoffError::Long { expected: advice::hours(spent * extension.factor) });
            }
            let wanted = self.request.arguments.length.error;
            let worst = wanted.and_then(|_| length::worst_error(&self.summary.choices, &self.summary.measures));
            observer(TradeoffEvent::Extended { factor: extension.factor, worst });
            self.summary.stretch.averaged *= extension.factor;
            self.summary.extensions += 1;
            self.summary.is_short = extension.is_short;
            self.summary.save(place.path())?;
        }
        self.summary.is_long_enough = true;
        self.summary.save(place.path())?;
        observer(TradeoffEvent::Timing);
        self.time(&runs, adapter)?;
        self.summary.assess(&self.request)?;
        self.choose();
        observer(TradeoffEvent::Finishing);
        self.finish(&place, &gpu)
    }

    /// All runs: the choices, then those that references are taken from where some measure needs them.
    fn runs(&self, stretch: &Stretch) -> Result<Vec<(String, Scene)>, TradeoffError> {
        let mut runs = Vec::new();
        for variant in self.request.sweep.variants() {
            runs.push((variant.name.clone(), stretch.applied(&variant.name, &variant.scene)?));
        }
        let [finer, coarser] = self.request.finer_scenes()?;
        runs.push((FINER.to_owned(), stretch.applied(FINER, &finer)?));
        runs.push((COARSER.to_owned(), stretch.applied(COARSER, &coarser)?));
        Ok(runs)
    }

    /// The seconds that all runs are expected to take, after the stretch of time was shortened to what a budget leaves for a pilot.
    fn plan_pilot(&mut self, runs: &[(String, Scene)], adapter: &AdapterChoice) -> Result<f64, TradeoffError> {
        let mut seconds = 0.0;
        for (name, scene) in &runs[..count(runs)] {
            let wrong = |source: RunError| TradeoffError::Run { name: name.clone(), source: Box::new(source) };
            match run::adapter_for(scene, adapter).and_then(|gpu| run::expected_time(scene, &gpu)) {
                Ok(expected) => seconds += expected.seconds,
                // What cannot be stable takes no time.
                Err(error) if cost::is_unstable(&error) || matches!(error, RunError::Engine(_)) => {}
                Err(error) => return Err(wrong(error)),
            }
        }
        let length = self.request.arguments.length;
        if let (Some(budget), Beginning::New { .. }) = (length.budget, &self.beginning) {
            let stretch = self.summary.stretch;
            let all = (stretch.equilibration + stretch.averaged).max(f64::MIN_POSITIVE);
            let before = seconds * stretch.equilibration / all;
            if before > budget {
                let expected = advice::duration(before);
                let mistake =
                    format!("equilibration alone takes about {expected}: give a larger --budget, or shorten it");
                return Err(TradeoffError::Arguments { mistakes: vec![mistake] });
            }
            let allowed = (PILOT_SHARE * budget - before) / (seconds - before).max(1e-9);
            if allowed < 1.0 {
                // Some rows at least, and a window of every analysis: what has none keeps its length.
                let least = FEWEST_ROWS * self.request.base.output.energies.every as f64 * stretch.step;
                let averaged = (stretch.averaged * allowed).max(least).min(stretch.averaged);
                let shorter = Stretch { averaged, ..stretch };
                if self.runs(&shorter).is_ok() {
                    seconds = before + (seconds - before) * averaged / stretch.averaged;
                    self.summary.stretch = shorter;
                }
            }
        } else if length.budget.is_none() && !self.may_be_long && seconds > LONG {
            return Err(TradeoffError::Long { expected: advice::hours(seconds) });
        }
        Ok(seconds)
    }

    /// Brings all runs to the end of the stretch, one after the other.
    fn advance(
        &mut self,
        runs: &[(String, Scene)],
        adapter: &AdapterChoice,
        observer: &mut dyn FnMut(TradeoffEvent<'_>),
    ) -> Result<(), TradeoffError> {
        let stretch = self.summary.stretch;
        for (index, (name, scene)) in runs.iter().enumerate() {
            if self.interrupt.is_asked() {
                return Err(TradeoffError::Interrupted { directory: self.directory.clone() });
            }
            if self.entry(index).state == ChoiceState::Unstable {
                continue;
            }
            // A choice may be what the finer run is compared with.
            let twin = (0..self.summary.choices.len().min(index)).find(|twin| runs[*twin].1 == *scene);
            if let Some(twin) = twin.filter(|_| index >= self.summary.choices.len()) {
                let twin = self.summary.choices[twin].clone();
                *self.entry(index) = twin;
                continue;
            }
            let mut scene = scene.clone();
            scene.time.steps = stretch.steps(&scene);
            let ended = self.simulate(name, &scene, adapter, observer)?;
            let measured = match &ended {
                Ok(summary) => {
                    let directory = RunDirectory::open(self.directory.join(name))?;
                    measures::of_run(summary, &scene, &directory)?
                }
                Err(_) => Vec::new(),
            };
            let entry = self.entry(index);
            entry.measured = measured;
            entry.time_step = scene.time.step;
            let spoilt = ended.as_ref().ok().and_then(|summary| summary.unequilibrated.as_ref());
            entry.unequilibrated =
                spoilt.map(|found| found.means.iter().map(|mean| mean.quantity.clone()).collect()).unwrap_or_default();
            match ended {
                Ok(summary) => (entry.state, entry.steps) = (ChoiceState::Finished, summary.steps),
                Err(error) => {
                    entry.state = ChoiceState::Unstable;
                    entry.failure = error.to_string().lines().next().map(str::to_owned);
                }
            }
            observer(TradeoffEvent::Ended { choice: self.entry(index) });
            self.summary.save(&self.directory)?;
        }
        self.compare_fields(runs)
    }

    /// The entry of a run in the summary.
    fn entry(&mut self, index: usize) -> &mut Choice {
        let choices = self.summary.choices.len();
        if index < choices { &mut self.summary.choices[index] } else { &mut self.summary.finer[index - choices] }
    }

    /// Brings one run to its last step: the summary, or why it became unstable.
    fn simulate(
        &self,
        name: &str,
        scene: &Scene,
        adapter: &AdapterChoice,
        observer: &mut dyn FnMut(TradeoffEvent<'_>),
    ) -> Result<Result<Summary, RunError>, TradeoffError> {
        let wrong = |source: RunError| match source {
            RunError::Interrupted { .. } => TradeoffError::Interrupted { directory: self.directory.clone() },
            source => TradeoffError::Run { name: name.to_owned(), source: Box::new(source) },
        };
        let directory = self.directory.join(name);
        let steps = scene.time.steps;
        let simulation = if directory.join(run_files::CHECKPOINT).exists() {
            RunDirectory::open(&directory)?.check_run(Id::of_run(scene), files::SUMMARY)?;
            Simulation::resume(&directory, Some(steps)).map_err(wrong)?
        } else {
            Simulation::start(scene.clone(), &directory, true)
        };
        if simulation.is_finished() {
            return Ok(Ok(Summary::load(&directory.join(run_files::SUMMARY))?));
        }
        let ended = simulation.until(&self.interrupt).execute(adapter, &mut |event| {
            if let Event::Advanced(progress) = event {
                observer(TradeoffEvent::Advanced { name, progress });
            }
        });
        match ended {
            Ok(outcome) => Ok(Ok(outcome.summary)),
            Err(error) if cost::is_unstable(&error) => Ok(Err(error)),
            Err(error) => Err(wrong(error)),
        }
    }

    /// Adds the distances of fields and curves from those of the finer run; how far the run with twice its step is from it says how
    /// certain they are.
    fn compare_fields(&mut self, runs: &[(String, Scene)]) -> Result<(), TradeoffError> {
        if self.summary.finer.iter().any(|run| run.state != ChoiceState::Finished) {
            return Ok(());
        }
        let place = |name: &str| RunDirectory::open(self.directory.join(name));
        let finer = place(FINER)?;
        let coarser = self.summary.finer.last().map_or(COARSER, |run| run.name.as_str());
        let limits = fields::distances(&place(coarser)?, &finer)?;
        let mut found = Vec::new();
        for (index, (name, _)) in runs.iter().enumerate().take(self.summary.choices.len()) {
            // Fields at another time differ for that alone: rows of tables end at different times where steps do not fit.
            let times =
                [&self.summary.choices[index], &self.summary.finer[0]].map(|run| run.steps as f64 * run.time_step);
            let at_once = (times[0] - times[1]).abs() < 1e-6 * self.summary.finer[0].time_step;
            if self.summary.choices[index].state == ChoiceState::Finished && at_once {
                found.push((index, fields::distances(&place(name)?, &finer)?));
            }
        }
        for (index, distances) in found {
            let measured = &mut self.summary.choices[index].measured;
            measured.retain(|known| !known.measure.ends_with(fields::DISTANCE));
            measured.extend(distances.into_iter().map(|mut distance| {
                let limit = limits.iter().find(|limit| limit.measure == distance.measure);
                distance.standard_error = limit.map(|limit| limit.value);
                distance
            }));
        }
        Ok(())
    }

    /// Whether and by what to make all runs longer.
    fn extension(&self, spent: f64) -> Extension {
        let summary = &self.summary;
        let asked = self.request.arguments.length;
        let worst = length::worst_error(&summary.choices, &summary.measures);
        let found = length::extension(&asked, worst, spent, summary.stretch.averaged, summary.extensions);
        if found.factor > 1.0 || asked.budget.is_some() && asked.error.is_none() {
            return found;
        }
        // A target that may or may not be met asks for more samples.
        let is_open = summary.choices.iter().filter(|choice| choice.verdict == Some(Verdict::Open)).any(|choice| {
            self.request.arguments.targets.iter().any(|target| {
                let (Some(error), Some(reference)) =
                    (choice.error(&target.measure), summary.reference(&target.measure))
                else {
                    return false;
                };
                let fluctuates = choice.value(&target.measure).is_some_and(|measured| measured.fluctuates);
                let is_known = error.uncertainty.is_some() && fluctuates;
                is_known && target.verdict(error, reference.value) == Verdict::Open
            })
        });
        if asked.budget.is_none() && summary.extensions >= MOST_FOR_A_VERDICT {
            return found;
        }
        if !is_open {
            return found;
        }
        let wanted = length::Length { error: worst.map(|worst| worst / FOR_A_VERDICT.sqrt()), ..asked };
        let more = length::extension(&wanted, worst, spent, summary.stretch.averaged, summary.extensions);
        Extension { is_short: found.is_short || more.is_short, ..more }
    }

    /// Times the steps of all choices that came to their end, in turns.
    fn time(&mut self, runs: &[(String, Scene)], adapter: &AdapterChoice) -> Result<(), TradeoffError> {
        let finished: Vec<usize> = (0..self.summary.choices.len())
            .filter(|index| self.summary.choices[*index].state == ChoiceState::Finished)
            .collect();
        let mut states = Vec::new();
        for index in &finished {
            let name = &runs[*index].0;
            let path = self.directory.join(name).join(run_files::CHECKPOINT);
            let wrong =
                |error| TradeoffError::Run { name: name.clone(), source: Box::new(RunError::Checkpoint(error)) };
            states.push(checkpoint::load(&path).map_err(wrong)?.state);
        }
        let timed: Vec<Timed<'_>> = finished
            .iter()
            .zip(&states)
            .map(|(index, state)| Timed { name: &runs[*index].0, scene: &runs[*index].1, state })
            .collect();
        let proceed = || {
            let interrupted = TradeoffError::Interrupted { directory: self.directory.clone() };
            if self.interrupt.is_asked() { Err(interrupted) } else { Ok(()) }
        };
        let costs = cost::measure(&timed, adapter, &proceed)?;
        for ((index, cost), state) in finished.into_iter().zip(costs).zip(&states) {
            if self.interrupt.is_asked() {
                return Err(TradeoffError::Interrupted { directory: self.directory.clone() });
            }
            let choice = &mut self.summary.choices[index];
            choice.cost = cost;
            if state.len() <= MOST_COMPARED && choice.float64_distance.is_none() {
                let (name, scene) = &runs[index];
                let wrong = |source| TradeoffError::Run { name: name.clone(), source: Box::new(source) };
                let gpu = run::adapter_for(scene, adapter).map_err(wrong)?;
                choice.float64_distance = self_test::distance_from_reference(&gpu, scene).ok();
            }
        }
        Ok(())
    }

    /// The cheapest choice that meets all targets.
    fn choose(&mut self) {
        let cost = |choice: &&Choice| choice.cost.map_or(f64::INFINITY, |cost| cost.seconds_per_time);
        let meets = self
            .summary
            .choices
            .iter()
            .filter(|choice| choice.verdict == Some(Verdict::Meets) && choice.cost.is_some());
        let chosen = meets.min_by(|a, b| cost(a).total_cmp(&cost(b)));
        self.summary.chosen = chosen.map(|choice| choice.name.clone());
    }

    fn finish(self, place: &RunDirectory, gpu: &Gpu) -> Result<TradeoffOutcome, TradeoffError> {
        let Self { request, summary, .. } = self;
        let page = advice::page(&summary, request.title());
        write_atomically(&place.file(files::PAGE), |writer| writer.write_all(page.as_bytes()))?;
        table::write(place.path(), &summary, &request.sweep.keys())?;
        summary.save(place.path())?;
        let wrong = |source: RunError| TradeoffError::Run { name: files::plot("*"), source: Box::new(source) };
        let plotter = Plotter::new(gpu.device(), gpu.queue())
            .map_err(|source| wrong(RunError::Plot { name: files::plot("*"), source }))?;
        let mut written = vec![files::TABLE.to_owned(), files::SUMMARY.to_owned(), files::PAGE.to_owned()];
        for measure in &summary.measures {
            let Some(chart) = charts::chart(&summary, &request, measure) else { continue };
            let name = files::plot(measure);
            let drawn = plotter.draw_chart(&chart, &request.base.output.plot);
            run::save(place, &name, summary.tradeoff_id, drawn).map_err(wrong)?;
            written.push(name);
        }
        Ok(TradeoffOutcome { summary, files: written, page })
    }
}

/// Number of runs to be made: the last, with which the finer one is compared, may be a choice.
fn count(runs: &[(String, Scene)]) -> usize {
    let is_choice = runs.split_last().is_some_and(|((_, last), others)| others.iter().any(|(_, other)| other == last));
    runs.len() - usize::from(is_choice)
}
