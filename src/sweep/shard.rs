//! One shard of a sweep: it runs variants of its own, and writes nothing that another process writes.

use super::run::SweepOutcome;
use super::summary::SweepSummary;
use super::variant::{VariantState, VariantSummary};
use crate::gpu::AdapterChoice;
use crate::output::RunDirectory;
use crate::study::{self, Observer, Record, SHARD_RECORD, Shard, StudyError, StudyRun};
use serde_json::json;

impl StudyRun<SweepSummary> {
    /// Runs the variants of one shard that are not finished, and leaves tables and plots of the sweep to who gathers them: the sweep
    /// that is [resumed](StudyRun::resume) in the same directory once no shard is under way.
    ///
    /// Shards run at the same time, in processes of their own, and any number of times. The first to begin writes the summary of the
    /// sweep; after that each writes into the directories of its variants, and `shards/3-of-16/shard.json` says how far it is. The
    /// outcome has the variants of the shard only.
    ///
    /// ```
    /// use mesoscope::gpu::AdapterChoice;
    /// use mesoscope::study::Shard;
    /// use mesoscope::sweep::{Sweep, SweepRun};
    ///
    /// # let directory = tempfile::tempdir()?;
    /// # let results = directory.path().join("seeds");
    /// let small = ["space.box=[3,3,3]", "time.equilibration=0", "time.steps=10", "output={}"].map(str::to_owned);
    /// let sweep = Sweep::load("dpd-fluid", &small, None, &["seed=1,2,3".to_owned()], &[])?;
    /// for number in 1..=2 {
    ///     let shard = Shard::new(number, 2).ok_or("no such shard")?;
    ///     let run = SweepRun::start(sweep.clone(), &results);
    ///     let outcome = run.execute_shard(shard, &AdapterChoice::Best, &mut |_| {})?;
    ///     assert_eq!(outcome.summary.variants.len(), [2, 1][number as usize - 1]);
    /// }
    /// assert!(!results.join("sweep.csv").exists());
    /// let gathered = SweepRun::resume(&results)?.execute(&AdapterChoice::Best, &mut |_| {})?;
    /// assert!(gathered.failures.is_empty() && results.join("sweep.csv").exists());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`StudyError::OtherStudy`] when the directory holds another sweep, [`InUse`](crate::output::OutputError::InUse)
    /// when the same shard, one of another number of shards, or who gathers them is under way there;
    /// [`StudyError::InterruptedShard`]; those of [`execute`](StudyRun::execute).
    pub fn execute_shard(
        mut self,
        shard: Shard,
        adapter: &AdapterChoice,
        observer: &mut Observer<'_, SweepSummary>,
    ) -> Result<SweepOutcome, StudyError> {
        self.summary.plots.check(&self.request)?;
        let own: Vec<usize> = (0..self.request.variants().len()).filter(|place| shard.has(*place)).collect();
        // Before the directory, as a sweep does.
        let gpu = self.open_adapter(adapter, &own)?;
        let place = self.enter(shard)?;
        let place_of_sweep = self.directory().to_path_buf();
        for number in &own {
            let variant = &self.request.variants()[*number];
            let entry = &mut self.summary.variants[*number];
            entry.record(&place_of_sweep.join(&variant.name), &variant.scene);
        }
        let is_waiting = |number: &&usize| self.summary.variants[**number].state != VariantState::Finished;
        let waiting: Vec<usize> = own.iter().filter(is_waiting).copied().collect();
        let jobs = self.jobs_of(&waiting, &gpu);
        self.summary.adapter = Some(gpu.description().into());
        self.note(&place, shard, &own)?;
        observer(self.started(&waiting, jobs, &gpu, None));
        let ended = self.run_all(&waiting, jobs, adapter, observer, &|sweep| sweep.note(&place, shard, &own));
        let mut failures = match ended {
            Err(StudyError::Interrupted { .. }) => {
                let finished =
                    own.iter().filter(|number| self.summary.variants[**number].state == VariantState::Finished);
                return Err(StudyError::InterruptedShard { shard, finished: finished.count(), all: own.len() });
            }
            ended => ended?,
        };
        for (number, _) in &mut failures {
            *number = own.iter().position(|own| own == number).unwrap_or_default();
        }
        let mut places = 0..;
        self.summary.variants.retain(|_| places.next().is_some_and(|place| shard.has(place)));
        let files = vec![study::name_in_study(shard, SHARD_RECORD)];
        Ok(SweepOutcome { summary: self.summary, failures, files })
    }

    /// Takes the place of a shard in the directory of the sweep, in which the first to come writes the summary.
    fn enter(&mut self, shard: Shard) -> Result<RunDirectory, StudyError> {
        let whole = study::claim_study(self.directory(), self.interrupt())?;
        match study::load::<SweepSummary>(self.directory()) {
            Err(StudyError::Nothing { .. }) => {
                self.check_place()?;
                whole.clear(false)?;
                self.save()?;
            }
            found => {
                let found = found?;
                study::check_version(&found, self.directory())?;
                if !found.is_of(&self.summary) {
                    let (kind, path) = (SweepSummary::KIND, self.directory().join(SweepSummary::KIND.summary));
                    return Err(StudyError::OtherStudy { kind, path });
                }
                // Ids are those of the version of the program that began the sweep.
                for (own, found) in self.summary.variants.iter_mut().zip(found.variants) {
                    own.run_id = found.run_id;
                }
                self.summary.sweep_id = found.sweep_id;
            }
        }
        Ok(study::claim_shard(self.directory(), shard)?)
    }

    /// Writes what the shard says of itself.
    fn note(&self, place: &RunDirectory, shard: Shard, own: &[usize]) -> Result<(), StudyError> {
        let entry = |number: &usize| {
            let VariantSummary { name, state, failure, .. } = &self.summary.variants[*number];
            let mut entry = json!({"name": name, "state": state});
            if let Some(failure) = failure {
                entry["failure"] = failure.as_str().into();
            }
            entry
        };
        let summary = json!({
            "mesoscope_version": env!("CARGO_PKG_VERSION"),
            "sweep_id": self.summary.sweep_id,
            "shard": shard.to_string(),
            "adapter": self.summary.adapter,
            "variants": own.iter().map(entry).collect::<Vec<_>>(),
        });
        place.write(SHARD_RECORD, |writer| writeln!(writer, "{summary:#}"))?;
        Ok(())
    }
}
