//! The analyses of a run under way: begun or continued from a checkpoint, fed, kept and concluded.

use super::describe;
use super::descriptor::{Conclusion, Sampling, Setting};
use super::gathered::Gathered;
use super::quantities;
use crate::engine::{Sample, Stepper};
use crate::output::checkpoint::CheckpointError;
use crate::output::summary::ColumnSummary;
use crate::output::{RunDirectory, Summary, write_table};
use crate::plan::SamplerId;
use crate::run::RunError;
use crate::run::sections::{Sections, bytes, samples};
use crate::scene::AnalysisId;
use crate::state::Reported;

/// An analysis under way.
struct UnderWay {
    id: AnalysisId,
    /// The index of its sampler, of one that takes samples; others take states.
    sampler: Option<usize>,
    first: u64,
    every: u64,
    gathered: Gathered,
}

impl UnderWay {
    fn takes_state(&self, step: u64) -> bool {
        self.sampler.is_none() && step >= self.first && step.is_multiple_of(self.every)
    }
}

/// The analyses that a scene asks for: of samples in the order of their samplers, then of states in the order in which their files are
/// listed.
#[derive(Default)]
pub(in crate::run) struct Analyses(Vec<UnderWay>);

impl Analyses {
    /// Begins the analyses, or continues from the sections of a checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError::Content`] where a section is not as long as its samples make it.
    pub(in crate::run) fn new(setting: &Setting<'_>, sections: &Sections<'_>) -> Result<Self, CheckpointError> {
        let Setting { scene, plan } = *setting;
        let begin = |id: AnalysisId, sampler, first, every| {
            let gathered = Gathered::new(describe(id).parts(scene));
            UnderWay { id, sampler, first, every, gathered }
        };
        let of_samples = plan.samplers.iter().enumerate().filter_map(|(index, sampler)| match sampler.id {
            SamplerId::Analysis(id) => Some(begin(id, Some(index), sampler.first, sampler.every)),
            SamplerId::Observables => None,
        });
        let of_states = AnalysisId::ALL.into_iter().filter(|id| describe(*id).takes_states()).filter_map(|id| {
            let Sampling { first, every, .. } = describe(id).asked(scene)?;
            Some(begin(id, None, first, every.max(1)))
        });
        let mut all: Vec<UnderWay> = of_samples.chain(of_states).collect();
        for UnderWay { id, sampler, first, every, gathered } in &mut all {
            let before = match sampler {
                Some(index) => plan.samplers[*index].samples_before(sections.step),
                None => samples(*every, *first, sections.step),
            };
            if let Some(numbers) = sections.numbers(id.name(), gathered.length_after(before))? {
                gathered.restore(&numbers, before);
            }
        }
        Ok(Self(all))
    }

    /// Gives the device back the windows that were open when the checkpoint was saved.
    ///
    /// # Errors
    /// [`RunError::Checkpoint`] where one is missing or of another length.
    pub(in crate::run) fn continue_windows(
        &self,
        engine: &mut dyn Stepper,
        sections: &Sections<'_>,
    ) -> Result<(), RunError> {
        for (id, sampler) in self.samplers() {
            let Some((buffer, taken)) = engine.plan().samplers[sampler].open_window(sections.step) else { continue };
            let planned = engine.plan().buffers.iter().find(|planned| planned.array == buffer);
            let words = planned.map_or(0, |planned| planned.bytes / 4);
            if let Some(words) = sections.words(&window_name(id), words)? {
                engine.continue_window(sampler, taken, &words)?;
            }
        }
        Ok(())
    }

    /// The analyses of samples, with the indices of their samplers.
    fn samplers(&self) -> impl Iterator<Item = (AnalysisId, usize)> {
        self.0.iter().filter_map(|one| Some((one.id, one.sampler?)))
    }

    /// Adds a sample of any sampler but the first.
    pub(in crate::run) fn add(&mut self, sample: &Sample, setting: &Setting<'_>) {
        if let Some(found) = self.0.iter_mut().find(|one| one.sampler == Some(sample.sampler))
            && let Some(numbers) = describe(found.id).numbers_of_sample(setting, sample)
        {
            found.gathered.add(&numbers);
        }
    }

    /// Steps between two states, of all that take states.
    pub(in crate::run) fn state_intervals(&self) -> Vec<u64> {
        self.0.iter().filter(|one| one.sampler.is_none()).map(|one| one.every).collect()
    }

    /// Whether any takes the state of a step.
    pub(in crate::run) fn take_state(&self, step: u64) -> bool {
        self.0.iter().any(|one| one.takes_state(step))
    }

    /// Adds a state to those that take it. A step that was added already, before a run went back, is left out.
    pub(in crate::run) fn add_state(&mut self, state: &Reported, setting: &Setting<'_>) {
        for one in self.0.iter_mut().filter(|one| one.takes_state(state.step)) {
            if one.gathered.samples() <= samples(one.every, one.first, state.step)
                && let Some(numbers) = describe(one.id).numbers_of_state(setting, state)
            {
                one.gathered.add(&numbers);
            }
        }
    }

    /// The sections of a checkpoint with gathered samples and states.
    pub(in crate::run) fn sections(&self) -> [Vec<(String, Vec<u8>)>; 2] {
        let (samples, states): (Vec<_>, Vec<_>) = self.0.iter().partition(|one| one.sampler.is_some());
        let section = |one: &UnderWay| (one.id.name().to_owned(), bytes(one.gathered.numbers()));
        [samples, states].map(|all| all.into_iter().map(section).collect())
    }

    /// What a checkpoint of the current step, of which no sample is taken yet, has to keep of the windows that are open
    /// on the device.
    ///
    /// # Errors
    /// [`RunError`] if the device failed.
    pub(in crate::run) fn open_windows(&self, engine: &mut dyn Stepper) -> Result<Vec<(String, Vec<u8>)>, RunError> {
        let mut sections = Vec::new();
        for (id, sampler) in self.samplers() {
            if let Some((buffer, _)) = engine.plan().samplers[sampler].open_window(engine.step()) {
                let words = engine.words(buffer)?;
                sections.push((window_name(id), words.into_iter().flat_map(u32::to_le_bytes).collect()));
            }
        }
        Ok(sections)
    }

    /// Writes the tables and adds the results, or why there are none, to the summary; `proceed` says before each analysis
    /// whether to.
    pub(in crate::run) fn conclude(
        &self,
        setting: &Setting<'_>,
        directory: &RunDirectory,
        summary: &mut Summary,
        proceed: &dyn Fn() -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        for UnderWay { id, gathered, .. } in &self.0 {
            proceed()?;
            let Some(Conclusion { tables, result, warnings }) = describe(*id).conclude(setting, gathered) else {
                continue;
            };
            let dimension = setting.scene.model().units.dimension;
            for (names, table) in id.tables().iter().zip(&tables) {
                let columns = table.columns.iter().filter_map(|column| {
                    let quantity = quantities::named(*id, column);
                    debug_assert!(quantity.is_some(), "`{column}` of {id:?} is described");
                    let species = describe(*id).species_of(setting.scene, &quantities::numbers_of(column));
                    Some(ColumnSummary { species, ..ColumnSummary::new(column, quantity?, dimension) })
                });
                summary.columns.insert(names.file.to_owned(), columns.collect());
            }
            match result {
                Ok(result) => {
                    let result = quantities::with_units(*id, result, dimension);
                    summary.results.insert(id.name().to_owned(), result);
                    summary.warnings.extend(warnings);
                }
                Err(reason) => summary.warnings.push(format!("no result for `{}`: {reason}", id.path())),
            }
            for (names, table) in id.tables().iter().zip(&tables) {
                write_table(&directory.file(names.file), table)?;
            }
        }
        Ok(())
    }
}

/// The section with the open window of an analysis.
fn window_name(id: AnalysisId) -> String {
    format!("{}_window", id.name())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::families::Checked;
    use crate::measure::statistics::student;
    use crate::plan::{Hardware, Options};
    use crate::run::analyses::histogram;
    use crate::run::plan;
    use std::path::Path;

    /// The analyses after `step` steps that left these sections.
    fn after(step: u64, sections: &[(String, Vec<u8>)], setting: &Setting<'_>) -> Result<Analyses, CheckpointError> {
        Analyses::new(setting, &Sections::new(Path::new("checkpoint.bin"), step, sections))
    }

    /// What is concluded from samples is concluded from their section too, for every analysis of particles.
    #[test]
    fn sections_restore_what_was_gathered() {
        let scene = serde_json::from_value(serde_json::json!({
            "title": "all", "space": { "box": [5.0, 5.0] }, "time": { "step": 0.5, "steps": 100 }, "temperature": 1.0,
            "particles": [{ "species": "A", "count": 2 }],
            "interactions": [{ "type": "dpd", "repulsion": 25.0 }],
            "output": {
                "radial_distribution": { "every": 1, "range": 2.0, "bins": 3 },
                "diffusion": { "every": 1, "window": 2 },
                "viscosity": { "every": 1, "window": 8 },
                "autocorrelations": [
                    { "quantity": "velocity", "every": 1, "window": 2 },
                    { "quantity": "force", "every": 1, "window": 2 },
                ],
                "histograms": [
                    { "quantity": "velocity", "every": 1, "bins": 4 },
                    { "quantity": "speed", "every": 1, "bins": 4 },
                    { "quantity": "acceleration", "every": 1, "bins": 4 },
                ],
            },
        }))
        .unwrap();
        let scene = Checked::presumed(scene);
        let plan = plan(&scene, Hardware::default(), Options::default());
        let run = &Setting { scene: &scene, plan: &plan };
        let mut analyses = after(0, &[], run).unwrap();
        for step in 0..3_i64 {
            for (sampler, planned) in plan.samplers.iter().enumerate().skip(1) {
                let sums = (0..planned.quantities as i64).map(|index| (1 + index * index * (step + 1)) << 20).collect();
                analyses.add(&Sample { sampler, step: step as u64, sums }, run);
            }
        }
        assert_eq!(analyses.0.len(), 8);
        let [sections, _] = analyses.sections();
        let restored = after(3, &sections, run).unwrap();
        let fresh = after(0, &[], run).unwrap();
        for ((one, restored), fresh) in analyses.0.iter().zip(&restored.0).zip(&fresh.0) {
            let id = one.id;
            let [gathered, restored, fresh] = [one, restored, fresh].map(|one| &one.gathered);
            let text = |gathered: &Gathered| {
                let conclusion = describe(id).conclude(run, gathered).unwrap();
                format!("{:?} {:?} {:?}", conclusion.tables, conclusion.result, conclusion.warnings)
            };
            assert_eq!(text(restored), text(gathered), "{id:?}");
            assert_eq!(restored, gathered, "{id:?}");
            assert!(fresh.numbers().ne(gathered.numbers()), "{id:?}");
        }
        // What belongs to another step, was cut off, or is missing altogether, is refused.
        for (index, (name, _)) in sections.iter().enumerate() {
            let refused = |sections: &[(String, Vec<u8>)], step: u64| {
                let error = after(step, sections, run).err().map(|error| error.to_string()).unwrap_or_default();
                assert!(error.contains("is no valid checkpoint: its section"), "{name}: {error}");
            };
            for damage in
                [|bytes: &mut Vec<u8>| bytes.truncate(bytes.len() - 1), |bytes: &mut Vec<u8>| bytes.extend([0; 8])]
            {
                let mut damaged = sections.clone();
                damage(&mut damaged[index].1);
                refused(&damaged, 3);
            }
            let mut fewer = sections.clone();
            fewer.remove(index);
            refused(&fewer, 3);
            refused(&sections, 4);
        }
    }

    /// Numbers worked out by hand.
    #[test]
    fn samples_become_means_in_real_units() {
        let scene = |output: &str| -> Checked {
            let text = format!(
                r#"{{"title": "t", "space": {{"box": [5, 5]}}, "time": {{"step": 0.5, "steps": 100}}, "temperature": 1,
                "particles": [{{"species": "A", "count": 2}}], "interactions": [{{"type": "dpd", "repulsion": 25}}],
                "output": {output}}}"#
            );
            Checked::presumed(serde_json::from_str(&text).unwrap())
        };
        let gathered = |scene: &Checked, samples: &[&[i64]]| -> Conclusion {
            let plan = plan(scene, Hardware::default(), Options::default());
            let setting = &Setting { scene, plan: &plan };
            let mut analyses = after(0, &[], setting).unwrap();
            for (step, sums) in samples.iter().enumerate() {
                analyses.add(&Sample { sampler: 1, step: step as u64, sums: sums.to_vec() }, setting);
            }
            describe(analyses.0[0].id).conclude(setting, &analyses.0[0].gathered).unwrap()
        };
        let correlated = scene(r#"{"autocorrelations": [{"quantity": "velocity", "every": 2, "window": 2}]}"#);
        let conclusion = gathered(&correlated, &[&[8], &[4], &[16], &[4]]);
        // Ratio 8/24; deviations (4 - 8/3)/12 and (4 - 16/3)/12, ±1/9, whose mean has the error 1/9, and Student's factor of two values.
        let [first, second] = [&conclusion.tables[0].rows[0], &conclusion.tables[0].rows[1]];
        assert_eq!(first[..3], [0.0, 1.0, 0.0]);
        assert_eq!(second[0], 1.0);
        assert!((second[1] - 1.0 / 3.0).abs() < 1e-15 && (second[2] - student(1.0) / 9.0).abs() < 1e-15, "{second:?}");

        let counted = scene(r#"{"histograms": [{"quantity": "velocity", "every": 1, "bins": 2, "range": 4}]}"#);
        // Two particles of two components: one value below, one in the first bin, two in the second; then the powers.
        let unit = 1.0 / histogram::moment_quantum(2);
        let powers = [0.5, 1.5, 0.75, 1.5, 1.0].map(|power: f64| (power * unit) as i64);
        let conclusion = gathered(&counted, &[&[&[1, 2, 1, 0, 0][..], &powers].concat()]);
        let densities: Vec<f64> = conclusion.tables[0].rows.iter().map(|row| row[1]).collect();
        assert_eq!(densities, [1.0 / 16.0, 2.0 / 16.0]);
        let result = conclusion.result.unwrap();
        // Means of x: 4 · 0.5/4, of x²: 16 · 1.5/4, of x⁴: 256 · 0.75/4; of r²: 16 · 1.5/2, of r⁴: 256 · 1/2.
        assert_eq!((result["mean"].as_f64(), result["mean_square"].as_f64()), (Some(0.5), Some(12.0)));
        assert_eq!(result["standard_deviation"].as_f64(), Some((6.0_f64 - 0.25).sqrt()));
        assert_eq!(result["kurtosis"].as_f64(), Some(48.0 / 36.0));
        assert_eq!(result["variance_of_square"].as_f64(), Some(128.0 - 144.0));
        assert!(conclusion.warnings[0].contains("25.00 %"), "{:?}", conclusion.warnings);
    }
}
