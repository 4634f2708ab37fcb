//! A tradeoff from its first run to its page.

use super::cost::{self, Timed};
use super::length::{self, Extension, Length, Worst};
use super::measures::{self, Measured};
use super::stretch::Stretch;
use super::summary::{Choice, ChoiceState, Float64Stretch, TradeoffSummary, Wanted};
use super::target::{Target, Verdict};
use super::{advice, fields, files};
use crate::families::Checked;
use crate::gpu::{AdapterChoice, Gpu, Requirements};
use crate::numbers::with_error;
use crate::output::{Id, RunDirectory, Summary, checkpoint, files as run_files};
use crate::run::{self, RunError};
use crate::self_test;
use crate::study::{self, Member, Observer, StudyError, StudyEvent, StudyOutcome, StudyRun, each_once};
use std::fmt;
use std::path::Path;
use std::time::Instant;

/// What of a budget the first runs may take: they say how long the others have to be.
const PILOT_SHARE: f64 = 0.2;
/// Particles up to which a step is compared with the float64 reference: it takes a processor seconds. Of fewer particles as many more steps are,
/// up to [`MOST_STEPS_COMPARED`].
const MOST_COMPARED: usize = 50_000;
const MOST_STEPS_COMPARED: usize = 16;
/// Rows of the table of energies that a pilot has at least.
const FEWEST_ROWS: f64 = 32.0;
/// By what the runs are made longer where a verdict is open: it halves every uncertainty.
const FOR_A_VERDICT: f64 = 4.0;
/// How often they are made longer for that where no budget says how long they may take.
const MOST_FOR_A_VERDICT: usize = 2;

/// A tradeoff to be executed.
pub type TradeoffRun = StudyRun<TradeoffSummary>;

/// What follows once all runs have come to an end.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Phase {
    /// All runs are made longer, by a factor of the time that means are taken over.
    Extended {
        /// The factor.
        factor: f64,
        /// The largest relative standard error so far, if the reason is that it is too large.
        worst: Option<f64>,
        /// Seconds that the runs are expected to take in all by then.
        seconds: f64,
        /// How many extensions are expected, this one included.
        rounds: usize,
        /// Seconds that the runs are expected to take in all after the last of them.
        total: f64,
    },
    /// Steps of all choices are timed in turns.
    Timing,
}

impl fmt::Display for Phase {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Extended { factor, worst, seconds, rounds, total } => {
                if let Some(worst) = worst {
                    write!(formatter, "the largest standard error is {} %: ", with_error(100.0 * worst, None))?;
                }
                let duration = advice::duration(*seconds);
                write!(formatter, "means are taken over {factor:.1} times the time, about {duration} of runs in all")?;
                if *rounds > 1 {
                    let duration = advice::duration(*total);
                    write!(formatter, "; {rounds} such rounds are expected, about {duration} by the last")?;
                }
                Ok(())
            }
            Self::Timing => formatter.write_str("timing steps in turns"),
        }
    }
}

impl StudyRun<TradeoffSummary> {
    /// Runs every choice and what it is compared with, times them, and writes tables, pictures and the page.
    ///
    /// # Errors
    /// [`StudyError`]. A choice that becomes unstable is in the outcome.
    pub fn execute(
        mut self,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, TradeoffSummary>,
    ) -> Result<StudyOutcome<TradeoffSummary>, StudyError> {
        let runs = self.runs(&self.summary.stretch)?;
        self.check_place()?;
        let waiting = self.waiting(&runs);
        let seconds = self.plan_pilot(&waiting, adapter)?;
        // Every run opens the adapter for itself, this is to know it.
        let gpu = Gpu::open(adapter, Requirements::default())?;
        let largest = study::largest(waiting.iter().map(|member| &member.scene)).unwrap_or(&self.request.base);
        let jobs = self.jobs_for(largest, waiting.len(), &gpu);
        // Steps follow from the stretch, which may be shorter now; all else stays.
        let place = self.open_place()?;
        self.summary.adapter = Some(gpu.description().into());
        self.save()?;
        let (count, seconds) = (waiting.len(), (!waiting.is_empty()).then_some(seconds));
        let at_once = self.under_way(jobs, largest, waiting.len(), &gpu);
        observer(StudyEvent::Started { adapter: gpu.description(), runs: count, at_once, seconds });
        loop {
            self.advance(&runs, jobs, adapter, observer)?;
            self.save()?;
            self.summary.assess(&self.request)?;
            let Extension { factor, is_short, rounds, total } = self.extension();
            self.summary.wanted = None;
            self.summary.is_short = is_short;
            if factor <= 1.0 {
                break;
            }
            let length = self.request.arguments.length;
            let [seconds, total] = [factor, total].map(|factor| self.summary.spent * factor);
            if length.budget.is_none() && self.refuse_long(total).is_err() {
                // What is known by now is worth its tables, and it can go on from here.
                self.summary.is_short = true;
                self.summary.wanted = Some(Wanted { rounds, seconds: total });
                break;
            }
            let worst = length.error.and_then(|_| Some(self.worst_error()?.counted));
            self.summary.stretch.averaged *= factor;
            self.summary.extensions += 1;
            self.save()?;
            let phase = Phase::Extended { factor, worst, seconds, rounds, total };
            observer(StudyEvent::Phase { phase: &phase, runs: self.waiting(&runs).len() });
        }
        self.summary.is_long_enough = self.summary.wanted.is_none();
        self.save()?;
        observer(StudyEvent::Phase { phase: &Phase::Timing, runs: 0 });
        self.time(&runs, adapter)?;
        self.summary.assess(&self.request)?;
        self.summary.choose();
        self.finish(&place, &gpu, observer)
    }

    /// All runs: the choices, then those that references are taken from where some measure needs them.
    fn runs(&self, stretch: &Stretch) -> Result<Vec<(String, Checked)>, StudyError> {
        let TradeoffSummary { choices, finer, further_seeds, .. } = &self.summary;
        let mut names = choices.iter().chain(finer).chain(further_seeds).map(|run| run.name.as_str());
        let mut runs = Vec::new();
        for further in 0..self.request.seeds() {
            for (scene, name) in self.request.scenes(further)?.iter().zip(&mut names) {
                runs.push((name.to_owned(), fields::leaving_compared(stretch.applied(name, scene)?)));
            }
        }
        Ok(runs)
    }

    /// The number of choices and of runs that references are taken from: those of one seed.
    fn runs_of_a_seed(&self) -> usize {
        self.summary.choices.len() + self.summary.finer.len()
    }

    /// The choice whose run an entry shares: one that references are taken from may be a choice, too.
    fn twin(&self, runs: &[(String, Checked)], index: usize) -> Option<usize> {
        let (choices, all) = (self.summary.choices.len(), self.runs_of_a_seed());
        let (seed, place) = (index / all, index % all);
        (seed * all..seed * all + choices).find(|twin| place >= choices && runs[*twin].1 == runs[index].1)
    }

    /// The runs that have to come to the end of the stretch: not those of choices that became unstable with any seed,
    /// nor those that another entry has.
    fn members(&mut self, runs: &[(String, Checked)]) -> Vec<Member> {
        let stretch = self.summary.stretch;
        let mut members = Vec::new();
        for (entry, (name, scene)) in runs.iter().enumerate() {
            let first_seed = entry % self.runs_of_a_seed();
            let is_unstable = [first_seed, entry].into_iter().any(|run| self.entry(run).state == ChoiceState::Unstable);
            if self.twin(runs, entry).is_some() || is_unstable {
                continue;
            }
            let steps = stretch.steps(scene);
            let scene = scene.clone().changed(|scene| scene.time.steps = steps);
            // The id stays that of the version of the program that began the run.
            let id = *self.entry(entry).run_id.get_or_insert_with(|| Id::of_run(&scene));
            members.push(Member { entry, name: name.clone(), id, scene });
        }
        members
    }

    /// Those of them that have not come there yet.
    fn waiting(&mut self, runs: &[(String, Checked)]) -> Vec<Member> {
        let mut members = self.members(runs);
        // What stands in the place of a new study is not of it.
        let is_begun = !self.is_new() || self.summary.adapter.is_some();
        members.retain(|member| !(is_begun && self.finished(member).is_some()));
        members
    }

    /// What a run that came to the end of the stretch says.
    fn finished(&self, member: &Member) -> Option<Summary> {
        study::finished(&self.directory().join(&member.name), &member.scene, member.id, files::SUMMARY)
    }

    /// The seconds that runs are expected to take, after the stretch of time was shortened to what a budget leaves for a pilot.
    fn plan_pilot(&mut self, waiting: &[Member], adapter: &AdapterChoice) -> Result<f64, StudyError> {
        let mut seconds = 0.0;
        // With every seed a choice takes the time that it takes with the first.
        let (seeds, of_a_seed) = (f64::from(self.request.seeds()), self.runs_of_a_seed());
        for Member { name, scene, .. } in waiting.iter().filter(|member| member.entry < of_a_seed) {
            self.proceed()?;
            match run::adapter_for(scene, adapter).and_then(|gpu| run::expected_time(scene, &gpu)) {
                Ok(expected) => seconds += seeds * expected.seconds,
                // What cannot be stable takes no time.
                Err(error) if cost::is_unstable(&error) || matches!(error, RunError::Engine(_)) => {}
                Err(error) => return Err(StudyError::of_run(name, error)),
            }
        }
        let Some(budget) = self.request.arguments.length.budget else {
            self.refuse_long(seconds)?;
            return Ok(seconds);
        };
        if !self.is_new() {
            return Ok(seconds);
        }
        let stretch = self.summary.stretch;
        let all = (stretch.equilibration + stretch.averaged).max(f64::MIN_POSITIVE);
        let before = seconds * stretch.equilibration / all;
        if before > budget {
            let expected = advice::duration(before);
            let mistake = format!("equilibration alone takes about {expected}: give a larger --budget, or shorten it");
            return Err(StudyError::mistake(mistake));
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
        Ok(seconds)
    }

    /// Brings all runs to the end of the stretch; what they cost is measured later, in turns.
    fn advance(
        &mut self,
        runs: &[(String, Checked)],
        jobs: usize,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, TradeoffSummary>,
    ) -> Result<(), StudyError> {
        let mut members = Vec::new();
        for member in self.members(runs) {
            // One may have come to its end without being noted: the process was killed.
            if let Some(summary) = self.finished(&member) {
                self.record(&member, Ok(summary))?;
            } else {
                members.push(member);
            }
        }
        self.save()?;
        let (start, before) = (Instant::now(), self.summary.spent);
        let simulated = self.simulate(&members, jobs, adapter, observer, &mut |study, member, ended, observer| {
            // With every result, so that a budget holds after the process was killed.
            study.summary.spent = before + start.elapsed().as_secs_f64();
            let entry = study.record(member, ended)?;
            observer(StudyEvent::Ended { run: &member.name, ended: entry });
            Ok(study.save()?)
        });
        self.summary.spent = before + start.elapsed().as_secs_f64();
        if simulated.is_err() {
            self.save()?;
        }
        simulated?;
        for index in 0..runs.len() {
            if let Some(twin) = self.twin(runs, index) {
                let twin = self.entry(twin).clone();
                *self.entry(index) = twin;
            }
        }
        self.compare_fields()?;
        self.average_seeds();
        Ok(())
    }

    /// Replaces what runs with the first seed measured by the means over all seeds. A choice that is unstable with one
    /// of them is unstable.
    fn average_seeds(&mut self) {
        let all = self.runs_of_a_seed();
        let TradeoffSummary { choices, finer, further_seeds, .. } = &mut self.summary;
        for (place, run) in choices.iter_mut().chain(finer).enumerate() {
            let others = further_seeds.iter().skip(place).step_by(all);
            if run.state == ChoiceState::Finished
                && let Some(unstable) = others.clone().find(|other| other.state == ChoiceState::Unstable)
            {
                (run.state, run.measured) = (ChoiceState::Unstable, Vec::new());
                run.failure = unstable.failure.as_ref().map(|failure| format!("{}: {failure}", unstable.name));
            }
            let runs: Vec<&[Measured]> = std::iter::once(&run.measured)
                .chain(others.clone().map(|other| &other.measured))
                .map(Vec::as_slice)
                .collect();
            run.measured = measures::over_seeds(&runs);
            let spoilt = run.unequilibrated.iter().chain(others.flat_map(|other| &other.unequilibrated)).cloned();
            run.unequilibrated = each_once(spoilt);
        }
    }

    /// Notes what a run measured, or that it became unstable.
    fn record(&mut self, run: &Member, ended: Result<Summary, RunError>) -> Result<&Choice, StudyError> {
        let directory = self.directory().join(&run.name);
        let entry = self.entry(run.entry);
        entry.time_step = run.scene.time.step;
        match ended {
            Ok(summary) => {
                entry.measured = measures::of_run(&summary, &run.scene, &RunDirectory::open(directory)?)?;
                let spoilt = summary.unequilibrated.iter().flat_map(|found| &found.means);
                entry.unequilibrated = spoilt.map(|mean| mean.quantity.clone()).collect();
                (entry.state, entry.steps) = (ChoiceState::Finished, summary.steps);
                entry.conserved_exactly = summary.conserved_exactly;
            }
            Err(error) if cost::is_unstable(&error) => {
                (entry.measured, entry.unequilibrated) = (Vec::new(), Vec::new());
                entry.conserved_exactly.clear();
                entry.state = ChoiceState::Unstable;
                entry.failure = error.to_string().lines().next().map(str::to_owned);
            }
            Err(error) => return Err(StudyError::of_run(&run.name, error)),
        }
        Ok(entry)
    }

    /// The entry of a run in the summary.
    fn entry(&mut self, index: usize) -> &mut Choice {
        let TradeoffSummary { choices, finer, further_seeds, .. } = &mut self.summary;
        let (first, all) = (choices.len(), choices.len() + finer.len());
        if index >= all {
            &mut further_seeds[index - all]
        } else if index >= first {
            &mut finer[index - first]
        } else {
            &mut choices[index]
        }
    }

    /// Adds the distances of fields and curves from those of the finer run; how far the run with twice its step is from it, and one that is
    /// finer still, says how certain they are.
    fn compare_fields(&mut self) -> Result<(), StudyError> {
        let (directory, all) = (self.directory().to_path_buf(), self.runs_of_a_seed());
        let TradeoffSummary { choices, finer, further_seeds, .. } = &mut self.summary;
        let count = choices.len();
        compare_fields_of_a_seed(&directory, choices, finer)?;
        for of_a_seed in further_seeds.chunks_mut(all) {
            let (choices, finer) = of_a_seed.split_at_mut(count);
            compare_fields_of_a_seed(&directory, choices, finer)?;
        }
        Ok(())
    }

    /// The largest relative standard errors of what may have any.
    fn worst_error(&self) -> Option<Worst> {
        let measures = self.request.with_parts(&self.summary.measures);
        if measures.is_empty() { Some(Worst::default()) } else { length::worst_error(&self.summary.choices, &measures) }
    }

    /// Whether and by what to make all runs longer.
    fn extension(&self) -> Extension {
        let summary = &self.summary;
        if summary.is_long_enough {
            return Extension::none(summary.is_short);
        }
        let asked = self.request.arguments.length;
        let of = |length: &Length, worst: Option<Worst>| {
            length::extension(length, worst, summary.spent, summary.stretch.averaged, summary.extensions)
        };
        let found = of(&asked, self.worst_error());
        if found.factor > 1.0 || asked.budget.is_some() && asked.error.is_none() {
            return found;
        }
        // A target that may or may not be met asks for more samples.
        let is_open = |choice: &Choice, target: &Target| {
            let (error, reference) = (choice.error(&target.measure)?, summary.reference(&target.measure)?);
            let is_known = error.uncertainty.is_some() && choice.value(&target.measure)?.fluctuates;
            // More samples make no part of nothing.
            let has_parts = !target.is_part_of_nothing(!reference.is_zero());
            Some(is_known && has_parts && target.verdict(error, reference.value) == Verdict::Open)
        };
        let targets = &self.request.arguments.targets;
        let mut open = summary.choices.iter().filter(|choice| choice.verdict == Some(Verdict::Open));
        let is_any_open = open.any(|choice| targets.iter().any(|target| is_open(choice, target) == Some(true)));
        if !is_any_open || asked.budget.is_none() && summary.extensions >= MOST_FOR_A_VERDICT {
            return found;
        }
        // Whatever the errors are, so many more samples make them smaller.
        let wanted = Length { error: Some(1.0 / FOR_A_VERDICT.sqrt()), ..asked };
        let more = of(&wanted, Some(Worst { counted: 1.0, measured: 1.0 }));
        Extension { is_short: found.is_short || more.is_short, ..more }
    }

    /// Times the steps of all choices that came to their end, in turns.
    fn time(&mut self, runs: &[(String, Checked)], adapter: &AdapterChoice) -> Result<(), StudyError> {
        let (mut finished, mut timed) = (Vec::new(), Vec::new());
        for (index, ((name, scene), choice)) in runs.iter().zip(&self.summary.choices).enumerate() {
            if choice.state == ChoiceState::Finished {
                let path = self.directory().join(name).join(run_files::CHECKPOINT);
                let state = checkpoint::load(&path).map_err(|error| StudyError::of_run(name, error))?.state;
                finished.push(index);
                timed.push(Timed { name, scene, state });
            }
        }
        let costs = cost::measure(&timed, adapter, &|| self.proceed())?;
        for ((index, cost), Timed { name, scene, state }) in finished.into_iter().zip(costs).zip(timed) {
            self.proceed()?;
            let choice = &mut self.summary.choices[index];
            choice.cost = cost;
            if state.len() <= MOST_COMPARED && choice.float64_distance.is_none() {
                let gpu = run::adapter_for(scene, adapter).map_err(|error| StudyError::of_run(name, error))?;
                let steps = (MOST_COMPARED / state.len().max(1)).clamp(1, MOST_STEPS_COMPARED) as u64;
                let found = self_test::distances_from_reference(&gpu, scene, steps).ok();
                choice.float64_distance = found.map(|[of_step, _]| of_step);
                choice.float64_stretch = found.map(|[_, distance]| Float64Stretch { steps, distance });
            }
        }
        Ok(())
    }
}

/// Adds to the choices of a seed the distances of their fields and curves from those of its finer run.
fn compare_fields_of_a_seed(directory: &Path, choices: &mut [Choice], finer: &[Choice]) -> Result<(), StudyError> {
    let place = |run: &Choice| RunDirectory::open(directory.join(&run.name));
    // All of these may be runs of choices.
    let Some((reference, others)) = finer.split_first() else { return Ok(()) };
    if reference.state != ChoiceState::Finished {
        return Ok(());
    }
    let finer = place(reference)?;
    // Fields at another time differ for that alone: rows of tables end at different times where steps do not fit.
    let is_comparable = |run: &Choice| {
        let [time, other] = [run, reference].map(|run| run.steps as f64 * run.time_step);
        run.state == ChoiceState::Finished && (time - other).abs() < 1e-6 * reference.time_step
    };
    let limits = others.iter().filter(|run| is_comparable(run)).map(|run| fields::distances(&place(run)?, &finer));
    let limits = limits.collect::<Result<Vec<_>, _>>()?;
    let limit = |measure: &str| {
        let of_run = |found: &Vec<Measured>| Some(found.iter().find(|limit| limit.measure == measure)?.value);
        let squares: Option<Vec<f64>> = limits.iter().map(of_run).map(|value| Some(value?.powi(2))).collect();
        squares.filter(|squares| squares.len() == others.len()).map(|squares| squares.iter().sum::<f64>().sqrt())
    };
    for choice in choices.iter_mut().filter(|choice| is_comparable(choice)) {
        let distances = fields::distances(&place(choice)?, &finer)?;
        choice.measured.retain(|known| !known.measure.ends_with(fields::DISTANCE));
        let limited = |distance: Measured| Measured { standard_error: limit(&distance.measure), ..distance };
        choice.measured.extend(distances.into_iter().map(limited));
    }
    Ok(())
}
