//! What is gathered from the samplers beside the observables, and what comes out in the end.

mod autocorrelation;
mod chain_sizes;
mod diffusion;
mod histogram;
mod radial_distribution;
mod viscosity;

use super::RunError;
use super::circulations::Circulations;
use super::sections::{Sections, bytes};
use crate::engine::{Engine, Sample};
use crate::families::Model;
use crate::measure::correlation::WindowedAverage;
use crate::output::checkpoint::CheckpointError;
use crate::output::{RunDirectory, Summary, files, write_table};
use crate::plan::Plan;
use crate::plan::analyses::{autocorrelation_name, histogram_name};
use crate::scene::Scene;
use crate::table::Table;
use autocorrelation::Autocorrelation;
use chain_sizes::ChainSizes;
use diffusion::Diffusion;
use histogram::Counts;
use radial_distribution::RadialDistribution;
use serde_json::Value;
use viscosity::Viscosity;

/// What every analysis begins with.
struct Setting<'a> {
    model: &'a Model,
    plan: &'a Plan,
}

/// What becomes of the samples of one sampler.
trait Analysis {
    /// The key of the result, and the name of the section of a checkpoint.
    fn name(&self) -> &'static str;
    /// Adds a sample.
    fn add(&mut self, sample: &Sample);
    /// What a checkpoint has to keep.
    fn section(&self) -> Vec<u8>;
    /// How many numbers that is after so many samples.
    fn numbers_after(&self, samples: u64) -> u64;
    /// Goes on from what [`Self::section`] kept, which is as much as [`Self::numbers_after`] says.
    fn restore(&mut self, numbers: &[f64]);
    /// The part of the scene that asks for it.
    fn path(&self) -> String {
        format!("output.{}", self.name())
    }
    /// Whether there is nothing to write.
    fn is_idle(&self) -> bool {
        false
    }
    /// Table and result.
    fn conclude(&self) -> Conclusion;
}

/// What an analysis leaves.
struct Conclusion {
    file: &'static str,
    table: Table,
    /// The result, or why there is none.
    result: Result<Value, String>,
    /// What to know about the result.
    warnings: Vec<String>,
}

impl Conclusion {
    fn new(file: &'static str, table: Table, result: Result<Value, String>) -> Self {
        Self { file, table, result, warnings: Vec::new() }
    }
}

/// Why windows give no result, if they do not.
fn windows_missing(average: &WindowedAverage, particles: f64) -> Option<String> {
    if average.windows().len() == 0 {
        Some(format!("the run ends before a window of {} samples is full", average.lags()))
    } else if particles == 0.0 {
        Some("there are no particles".to_owned())
    } else {
        None
    }
}

/// The analyses that a scene asks for.
pub(super) struct Analyses {
    gathered: Vec<(usize, Box<dyn Analysis>)>,
}

impl Analyses {
    /// Begins the analyses, or goes on from the sections of a checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] where a section is not as long as its samples make it.
    pub(super) fn new(
        scene: &Scene,
        model: &Model,
        plan: &Plan,
        sections: &Sections<'_>,
    ) -> Result<Self, CheckpointError> {
        let setting = Setting { model, plan };
        let mut gathered = Vec::new();
        for (index, sampler) in plan.samplers.iter().enumerate() {
            let Some(mut analysis) = analysis(scene, &setting, index) else { continue };
            let count = analysis.numbers_after(sampler.samples_before(sections.step));
            if let Some(numbers) = sections.numbers(analysis.name(), count)? {
                analysis.restore(&numbers);
            }
            gathered.push((index, analysis));
        }
        Ok(Self { gathered })
    }

    /// Gives the device back the windows that were open when the checkpoint was saved.
    ///
    /// # Errors
    /// [`RunError::Checkpoint`] where one is missing or of another length.
    pub(super) fn continue_windows(&self, engine: &mut Engine<'_>, sections: &Sections<'_>) -> Result<(), RunError> {
        for (index, analysis) in &self.gathered {
            let Some((buffer, taken)) = engine.plan().samplers[*index].open_window(sections.step) else { continue };
            let planned = engine.plan().buffers.iter().find(|planned| planned.name == buffer);
            let words = planned.map_or(0, |planned| planned.bytes / 4);
            if let Some(words) = sections.words(&window_name(analysis.name()), words)? {
                engine.continue_window(*index, taken, &words)?;
            }
        }
        Ok(())
    }

    /// Adds a sample of any sampler but the first.
    pub(super) fn add(&mut self, sample: &Sample) {
        if let Some((_, analysis)) = self.gathered.iter_mut().find(|(index, _)| *index == sample.sampler) {
            analysis.add(sample);
        }
    }

    /// What a checkpoint has to keep of what the host has gathered.
    pub(super) fn sections(&self) -> Vec<(String, Vec<u8>)> {
        self.gathered.iter().map(|(_, analysis)| (analysis.name().to_owned(), analysis.section())).collect()
    }

    /// What a checkpoint of the current step, of which no sample is taken yet, has to keep of the windows that are open
    /// on the device.
    ///
    /// # Errors
    /// [`RunError`] if the device failed.
    pub(super) fn open_windows(&self, engine: &mut Engine<'_>) -> Result<Vec<(String, Vec<u8>)>, RunError> {
        let mut sections = Vec::new();
        for (index, analysis) in &self.gathered {
            if let Some((buffer, _)) = engine.plan().samplers[*index].open_window(engine.step()) {
                let words = engine.words(buffer)?;
                sections.push((window_name(analysis.name()), words.into_iter().flat_map(u32::to_le_bytes).collect()));
            }
        }
        Ok(sections)
    }

    /// Writes the tables and adds the results, or why there are none, to the summary.
    pub(super) fn conclude(&self, directory: &RunDirectory, summary: &mut Summary) -> Result<(), RunError> {
        for (_, analysis) in self.gathered.iter().filter(|(_, analysis)| !analysis.is_idle()) {
            let Conclusion { file, table, result, warnings } = analysis.conclude();
            match result {
                Ok(result) => {
                    summary.results.insert(analysis.name().to_owned(), result);
                    summary.warnings.extend(warnings);
                }
                Err(reason) => summary.warnings.push(format!("no result for `{}`: {reason}", analysis.path())),
            }
            write_table(&directory.file(file), &table)?;
        }
        Ok(())
    }
}

/// The section with the open window of an analysis.
fn window_name(analysis: &str) -> String {
    format!("{analysis}_window")
}

/// The analysis of a sampler, unless its samples are not for one.
fn analysis(scene: &Scene, setting: &Setting<'_>, index: usize) -> Option<Box<dyn Analysis>> {
    let output = &scene.output;
    let sampler = &setting.plan.samplers[index];
    Some(match sampler.name {
        "radial_distribution" => {
            Box::new(RadialDistribution::new(setting, output.radial_distribution.as_ref()?, sampler))
        }
        "diffusion" => Box::new(Diffusion::new(setting, output.diffusion.as_ref()?)),
        "viscosity" => Box::new(Viscosity::new(setting, output.viscosity.as_ref()?)),
        "chain_sizes" => Box::new(ChainSizes::new(setting)),
        "tracers" => Box::new(Circulations::new(setting.model, setting.model.shallow_water()?)),
        name => {
            let correlated = output.autocorrelations.iter().find(|asked| autocorrelation_name(asked.quantity) == name);
            let counted = output.histograms.iter().find(|asked| histogram_name(asked.quantity) == name);
            match (correlated, counted) {
                (Some(asked), _) => Box::new(Autocorrelation::new(setting, asked)),
                (None, asked) => Box::new(Counts::new(setting, asked?)),
            }
        }
    })
}

impl Analysis for Circulations {
    fn name(&self) -> &'static str {
        "circulation"
    }

    fn add(&mut self, sample: &Sample) {
        Circulations::add(self, sample);
    }

    fn section(&self) -> Vec<u8> {
        Circulations::section(self)
    }

    fn numbers_after(&self, samples: u64) -> u64 {
        Circulations::numbers_after(self, samples)
    }

    fn restore(&mut self, numbers: &[f64]) {
        Circulations::restore(self, numbers);
    }

    fn is_idle(&self) -> bool {
        self.is_empty()
    }

    fn conclude(&self) -> Conclusion {
        Conclusion::new(files::CIRCULATION, self.table(), Ok(self.result()))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::{Hardware, Options, plan};
    use std::path::Path;

    /// The analyses after `step` steps that left these sections.
    fn after(
        step: u64,
        sections: &[(String, Vec<u8>)],
        (scene, model, plan): (&Scene, &Model, &Plan),
    ) -> Result<Analyses, CheckpointError> {
        Analyses::new(scene, model, plan, &Sections::new(Path::new("checkpoint.bin"), step, sections))
    }

    /// What is concluded from samples is concluded from their section too, for every analysis of particles.
    #[test]
    fn sections_restore_what_was_gathered() {
        let scene: Scene = serde_json::from_value(serde_json::json!({
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
        let model = Model::new(&scene);
        let plan = plan(&model, 0, &scene.output, Hardware::default(), Options::default());
        let run = (&scene, &model, &plan);
        let mut analyses = after(0, &[], run).unwrap();
        for step in 0..3_i64 {
            for (sampler, planned) in plan.samplers.iter().enumerate().skip(1) {
                let sums = (0..planned.quantities as i64).map(|index| (1 + index * index * (step + 1)) << 20).collect();
                analyses.add(&Sample { sampler, step: step as u64, sums });
            }
        }
        assert_eq!(analyses.gathered.len(), 8);
        let sections = analyses.sections();
        let restored = after(3, &sections, run).unwrap();
        let fresh = after(0, &[], run).unwrap();
        for (((_, analysis), (_, restored)), (_, fresh)) in
            analyses.gathered.iter().zip(&restored.gathered).zip(&fresh.gathered)
        {
            let text = |analysis: &dyn Analysis| {
                let conclusion = analysis.conclude();
                format!("{:?} {:?} {:?}", conclusion.table, conclusion.result, conclusion.warnings)
            };
            assert_eq!(text(restored.as_ref()), text(analysis.as_ref()), "{}", analysis.name());
            assert_eq!(restored.section(), analysis.section(), "{}", analysis.name());
            assert_ne!(fresh.section(), analysis.section(), "{}", analysis.name());
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
        let scene = |output: &str| -> Scene {
            let text = format!(
                r#"{{"title": "t", "space": {{"box": [5, 5]}}, "time": {{"step": 0.5, "steps": 100}}, "temperature": 1,
                "particles": [{{"species": "A", "count": 2}}], "interactions": [{{"type": "dpd", "repulsion": 25}}],
                "output": {output}}}"#
            );
            serde_json::from_str(&text).unwrap()
        };
        let gathered = |scene: &Scene, samples: &[&[i64]]| -> Conclusion {
            let model = Model::new(scene);
            let plan = plan(&model, 0, &scene.output, Hardware::default(), Options::default());
            let mut analyses = after(0, &[], (scene, &model, &plan)).unwrap();
            for (step, sums) in samples.iter().enumerate() {
                analyses.add(&Sample { sampler: 1, step: step as u64, sums: sums.to_vec() });
            }
            analyses.gathered[0].1.conclude()
        };
        let correlated = scene(r#"{"autocorrelations": [{"quantity": "velocity", "every": 2, "window": 2}]}"#);
        let conclusion = gathered(&correlated, &[&[8], &[4], &[16], &[4]]);
        // Ratio 8/24; deviations (4 - 8/3)/12 and (4 - 16/3)/12, ±1/9, whose mean has the error 1/9.
        let [first, second] = [&conclusion.table.rows[0], &conclusion.table.rows[1]];
        assert_eq!(first[..3], [0.0, 1.0, 0.0]);
        assert_eq!(second[0], 1.0);
        assert!((second[1] - 1.0 / 3.0).abs() < 1e-15 && (second[2] - 1.0 / 9.0).abs() < 1e-15, "{second:?}");

        let counted = scene(r#"{"histograms": [{"quantity": "velocity", "every": 1, "bins": 2, "range": 4}]}"#);
        // Two particles of two components: one value below, one in the first bin, two in the second; then the powers.
        let unit = 1.0 / crate::plan::analyses::moment_quantum(2);
        let powers = [0.5, 1.5, 0.75, 1.5, 1.0].map(|power: f64| (power * unit) as i64);
        let conclusion = gathered(&counted, &[&[&[1, 2, 1, 0, 0][..], &powers].concat()]);
        let densities: Vec<f64> = conclusion.table.rows.iter().map(|row| row[1]).collect();
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
