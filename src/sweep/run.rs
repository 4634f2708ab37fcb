//! A sweep from its first variant to its last plot.

use super::averages::averages;
use super::look::Look;
use super::summary::SweepSummary;
use super::variant::VariantSummary;
use crate::families::Checked;
use crate::gpu::{AdapterChoice, Gpu, Requirements};
use crate::run::{self, RunError};
use crate::study::{Member, Observer, StudyError, StudyEvent, StudyOutcome, StudyRun, Variant};
use std::convert::Infallible;

/// Particles times steps that no adapter takes more than some minutes for.
const WORTH_TIMING: f64 = 1e8;

/// A sweep to be executed.
pub type SweepRun = StudyRun<SweepSummary>;

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

impl StudyRun<SweepSummary> {
    /// The same sweep, with plots of this look.
    #[must_use]
    pub fn with_look(mut self, look: Look) -> Self {
        self.summary.plots = look;
        self
    }

    /// Runs the variants that are not finished, and writes table, summary and plots. Table and summary are up to date after
    /// every variant. A variant that fails does not stop the others.
    ///
    /// # Errors
    /// [`StudyError`]: no usable adapter, a quantity to plot that nobody measures, files of the sweep itself that
    /// cannot be written, an interruption. Failures of variants are in the outcome.
    pub fn execute(
        mut self,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, SweepSummary>,
    ) -> Result<SweepOutcome, StudyError> {
        self.summary.plots.check(&self.request)?;
        self.check_place()?;
        let waiting = self.summary.waiting();
        // Before the directory: an adapter that is not there should not cost an earlier sweep its files.
        let gpu = self.open_adapter(adapter, &waiting)?;
        let jobs = self.jobs_of(&waiting, &gpu);
        let seconds = self.expected(&waiting, &gpu);
        self.refuse_long(seconds.unwrap_or_default())?;
        let place = self.open_place()?;
        if !waiting.is_empty() {
            self.summary.adapter = Some(gpu.description().into());
        }
        self.summarise()?;
        observer(self.started(&waiting, jobs, &gpu, seconds));
        let failures = self.run_all(&waiting, jobs, adapter, observer, &Self::summarise)?;
        let StudyOutcome { summary, files } = self.finish(&place, &gpu, observer)?;
        Ok(SweepOutcome { summary, failures, files })
    }

    /// Opens an adapter with the capacity for the largest of these variants.
    pub(super) fn open_adapter(&self, adapter: &AdapterChoice, numbers: &[usize]) -> Result<Gpu, StudyError> {
        let Some(Variant { name, scene, .. }) = self.largest(numbers) else {
            // Nothing to run: plots take little room.
            return Ok(Gpu::open(adapter, Requirements::default())?);
        };
        run::adapter_for(scene, adapter).map_err(|error| match error {
            error if error.exceeds_adapter() => StudyError::of_run(name, error),
            error => error.into(),
        })
    }

    /// How many of these variants are to run at once.
    pub(super) fn jobs_of(&self, waiting: &[usize], gpu: &Gpu) -> usize {
        self.largest(waiting).map_or(1, |variant| self.jobs_for(&variant.scene, waiting.len(), gpu))
    }

    /// The event of a start with these variants.
    pub(super) fn started<'g>(
        &self,
        waiting: &[usize],
        jobs: usize,
        gpu: &'g Gpu,
        seconds: Option<f64>,
    ) -> StudyEvent<'g, VariantSummary, Infallible> {
        let runs = waiting.len();
        let at_once = self.largest(waiting).map_or(1, |variant| self.under_way(jobs, &variant.scene, runs, gpu));
        StudyEvent::Started { adapter: gpu.description(), runs, at_once, seconds }
    }

    /// The variant of the most particles of some.
    fn largest(&self, numbers: &[usize]) -> Option<&Variant> {
        let variants = numbers.iter().map(|number| &self.request.variants()[*number]);
        variants.max_by_key(|variant| variant.scene.model().particle_count())
    }

    /// Seconds that variants take one after another with their pictures, in proportion to the largest, of which steps are timed; none where all are short
    /// or that one fails.
    fn expected(&self, waiting: &[usize], gpu: &Gpu) -> Option<f64> {
        let work = |scene: &Checked| scene.model().particle_count() as f64 * scene.time.steps as f64;
        let all: f64 = waiting.iter().map(|number| work(&self.request.variants()[*number].scene)).sum();
        let largest = &self.largest(waiting).filter(|_| all > WORTH_TIMING)?.scene;
        let expected = run::expected_time(largest, gpu).ok()?;
        Some(expected.seconds * all / work(largest) + expected.drawing * waiting.len() as f64)
    }

    /// Runs variants; `note` writes down after each how far the sweep is.
    pub(super) fn run_all(
        &mut self,
        waiting: &[usize],
        jobs: usize,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, SweepSummary>,
        note: &dyn Fn(&mut Self) -> Result<(), StudyError>,
    ) -> Result<Vec<(usize, RunError)>, StudyError> {
        let member = |entry: &usize| {
            let variant = self.request.variants()[*entry].clone();
            let id = self.summary.variants[*entry].run_id;
            Member { entry: *entry, name: variant.name, scene: variant.scene, id }
        };
        let members: Vec<Member> = waiting.iter().map(member).collect();
        let mut failures = Vec::new();
        self.simulate(&members, jobs, adapter, observer, &mut |sweep, member, ended, observer| {
            let entry = &mut sweep.summary.variants[member.entry];
            match ended {
                Ok(run) => entry.finish(&run),
                Err(error) => {
                    entry.fail(error.to_string());
                    failures.push((member.entry, error));
                }
            }
            let saved = note(sweep);
            let ended = &sweep.summary.variants[member.entry];
            observer(StudyEvent::Ended { run: &ended.name, ended });
            saved
        })?;
        failures.sort_by_key(|(number, _)| *number);
        Ok(failures)
    }

    /// Writes table and summary.
    fn summarise(&mut self) -> Result<(), StudyError> {
        self.summary.averages = averages(&self.summary.variants);
        self.write()?;
        Ok(())
    }
}
