//! Analyses: what a run measures besides the observables, and what it says of them.
//!
//! Each has an id, [`AnalysisId`], and a file here with its [`Descriptor`]: its sampler in the plan, how samples are gathered, its
//! tables and their columns, charts, what `check` says of it before a run and what a run prints at its end.

mod autocorrelation;
mod chain;
mod chain_sizes;
mod circulation;
mod diffusion;
mod histogram;
mod histogram_range;
mod neighbours;
mod pair_histogram;
mod planner;
mod radial_distribution;
mod shear_wave;
mod viscosity;

pub(super) use planner::Planner;
use planner::SumSampler;

use super::RunError;
use super::sections::{Sections, bytes, samples};
use crate::engine::{Engine, Sample};
use crate::families::Model;
use crate::measure::correlation::WindowedAverage;
use crate::numbers::{grouped, with_error};
use crate::output::checkpoint::CheckpointError;
use crate::output::{OutputError, RunDirectory, Summary, write_table};
use crate::plan::{Need, Plan, Sampler, SamplerId};
use crate::plot::{Chart, Found, Mean};
use crate::scene::{AnalysisId, AnalysisTable, Output, Scene};
use crate::state::State;
use crate::table::Table;
use serde_json::{Map, Value};

/// The registry of analyses.
fn descriptor(id: AnalysisId) -> Box<dyn Descriptor> {
    match id {
        AnalysisId::RadialDistribution => Box::new(radial_distribution::RadialDistribution),
        AnalysisId::Diffusion => Box::new(diffusion::Diffusion),
        AnalysisId::ChainSizes => Box::new(chain_sizes::ChainSizes),
        AnalysisId::Viscosity => Box::new(viscosity::Viscosity),
        AnalysisId::Autocorrelation(quantity) => Box::new(autocorrelation::Autocorrelation(quantity)),
        AnalysisId::Histogram(quantity) => Box::new(histogram::Histogram(quantity)),
        AnalysisId::Circulation => Box::new(circulation::Circulation),
        AnalysisId::Chain => Box::new(chain::Chain),
        AnalysisId::Neighbours => Box::new(neighbours::Neighbours),
        AnalysisId::ShearWave => Box::new(shear_wave::ShearWave),
    }
}

/// What is known of an analysis whether or not a run measures it.
trait Descriptor {
    /// How a scene asks for it; none if it does not.
    fn asked(&self, scene: &Scene, model: &Model) -> Option<Sampling>;

    /// What a report has to leave for its sampler.
    fn needs(&self) -> &'static [Need] {
        &[]
    }

    /// Adds its sampler to a plan, if it has one and a scene asks for it.
    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let _ = planner;
    }

    /// Begins to gather what is asked for.
    fn begin(&self, setting: &Setting<'_>) -> Option<Gathering>;

    /// The chart of a table that it left.
    fn chart(&self, drawn: &Drawn<'_>) -> Chart;

    /// Lines of the table that is printed at the end of a run: what, and its value.
    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let _ = result;
        Vec::new()
    }

    /// Bytes that its sections add to a checkpoint, if they are many.
    fn kept_bytes(&self, scene: &Scene, model: &Model) -> u64 {
        let _ = (scene, model);
        0
    }
}

/// What reports have to leave for the analyses that a scene asks for.
pub(super) fn needs(output: &Output) -> Vec<Need> {
    output.analyses().into_iter().flat_map(|id| descriptor(id).needs()).copied().collect()
}

/// Adds the samplers of the analyses that a scene asks for, in its order, and then of those that come with the model.
pub(super) fn add_samplers(planner: &mut Planner<'_>) {
    let mut ids = planner.output.analyses();
    let others = AnalysisId::ALL.into_iter().filter(|id| !ids.contains(id)).collect::<Vec<_>>();
    ids.extend(others);
    for id in ids {
        descriptor(id).add_sampler(planner);
    }
}

/// How an analysis that a scene asks for is sampled.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
struct Sampling {
    /// The first step sampled.
    first: u64,
    /// Steps between two samples.
    every: u64,
    /// How the samples are used.
    detail: Option<String>,
    /// Numbers in its tables, if they are many.
    numbers: u64,
}

impl Sampling {
    /// Samples after equilibration.
    fn after_equilibration(scene: &Scene, every: u64) -> Self {
        Self { first: scene.time.equilibration, every, ..Self::default() }
    }

    /// The same in windows of so many samples.
    fn in_windows(self, window: u64) -> Self {
        Self { detail: Some(format!("windows of {} samples", grouped(window))), ..self }
    }
}

/// What every analysis begins with.
struct Setting<'a> {
    scene: &'a Scene,
    model: &'a Model,
    plan: &'a Plan,
    /// Its sampler, if it has one.
    sampler: Option<&'a Sampler>,
}

/// What a chart is drawn from.
struct Drawn<'a> {
    scene: &'a Scene,
    table: &'a Table,
    /// Place of the table among those of its analysis.
    place: usize,
    /// The result of the run; null where there is none.
    result: &'a Value,
}

impl Drawn<'_> {
    fn title(&self) -> &str {
        &self.scene.title
    }

    /// A column; nothing where there is none of this name.
    fn column(&self, name: &str) -> Vec<f64> {
        self.table.column(name).unwrap_or_default()
    }
}

/// An analysis under way, by what it takes.
enum Gathering {
    /// Rows of its sampler.
    Samples(Box<dyn OfSamples>),
    /// States.
    States(Box<dyn OfStates>),
}

/// What has been gathered for an analysis.
trait Analysis {
    /// What a checkpoint has to keep.
    fn section(&self) -> Vec<u8>;
    /// How many numbers that is after so many samples.
    fn numbers_after(&self, samples: u64) -> u64;
    /// Continues from what [`Self::section`] kept after so many samples, which is as much as [`Self::numbers_after`] says.
    fn restore(&mut self, numbers: &[f64], samples: u64);
    /// Whether there is nothing to write.
    fn is_idle(&self) -> bool {
        false
    }
    /// Tables and result.
    fn conclude(&self) -> Conclusion;
}

/// An analysis of the rows of a sampler.
trait OfSamples: Analysis {
    /// Adds a row.
    fn add(&mut self, sample: &Sample);
}

/// An analysis of states.
trait OfStates: Analysis {
    /// Adds a state with full-step momenta. A step that was added already, before a run went back, is left out.
    fn add(&mut self, state: &State, model: &Model);
}

/// What an analysis leaves.
struct Conclusion {
    /// As many as the id has names for, in this order.
    tables: Vec<Table>,
    /// The result, or why there is none.
    result: Result<Value, String>,
    /// What to know about the result.
    warnings: Vec<String>,
}

impl Conclusion {
    fn new(table: Table, result: Result<Value, String>) -> Self {
        Self { tables: vec![table], result, warnings: Vec::new() }
    }
}

/// Why an analysis without samples has no result.
const NO_SAMPLE: &str = "no sample was taken after equilibration";

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

/// A coefficient with its error, from a result.
fn found(result: &Value) -> Option<Found> {
    Some((result["value"].as_f64()?, result["standard_error"].as_f64()))
}

/// A coefficient with its error as a line of the table printed at the end.
fn printed(label: &str, coefficient: &Value) -> Option<(String, String)> {
    let (value, error) = found(coefficient)?;
    Some((label.to_owned(), with_error(value, error)))
}

/// A mean of a result or a summary, as charts take it.
pub(super) fn mean(result: &Value) -> Option<Mean> {
    let standard_error = result["standard_error"].as_f64();
    let from_few_samples = standard_error.is_some() && result["converged"] == false;
    Some(Mean { value: result["mean"].as_f64()?, standard_error, from_few_samples, ..Mean::default() })
}

/// A mean of a result or a summary with its error; an error that has not settled, a lower bound, is marked by `*`.
///
/// ```
/// use mesoscope::run::printed_mean;
/// use serde_json::json;
///
/// let mean = json!({ "mean": 1.004, "standard_error": 0.012, "converged": false });
/// assert_eq!(printed_mean(&mean).as_deref(), Some("1.004 ± 0.012 *"));
/// ```
#[must_use]
pub fn printed_mean(entry: &Value) -> Option<String> {
    let mean = mean(entry)?;
    let text = with_error(mean.value, mean.standard_error);
    Some(if mean.from_few_samples { format!("{text} *") } else { text })
}

/// An analysis that a scene asks for, before the run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AskedAnalysis {
    /// Its id.
    pub id: AnalysisId,
    /// The first step sampled.
    pub first: u64,
    /// Steps between two samples.
    pub every: u64,
    /// How the samples are used, in words.
    pub detail: Option<String>,
    /// Numbers that its tables will hold, if they are many.
    pub(crate) numbers: u64,
    /// Bytes that it adds to a checkpoint, if they are many.
    pub(crate) kept_bytes: u64,
}

/// The analyses that a scene asks for, in the order in which their files are listed.
///
/// ```
/// use mesoscope::families::Model;
/// use mesoscope::scene::{self, AnalysisId};
///
/// let scene = scene::load("dpd-fluid", &[])?;
/// let asked = mesoscope::run::asked_analyses(&scene, &Model::new(&scene));
/// assert_eq!(asked[0].id, AnalysisId::RadialDistribution);
/// # Ok::<(), scene::SceneError>(())
/// ```
#[must_use]
pub fn asked_analyses(scene: &Scene, model: &Model) -> Vec<AskedAnalysis> {
    let asked = AnalysisId::ALL.into_iter().filter_map(|id| {
        let descriptor = descriptor(id);
        let Sampling { first, every, detail, numbers } = descriptor.asked(scene, model)?;
        Some(AskedAnalysis { id, first, every, detail, numbers, kept_bytes: descriptor.kept_bytes(scene, model) })
    });
    asked.collect()
}

/// The largest change of the circulation of a material loop in a run, as a part of what it was at first; none without such loops.
pub(crate) fn circulation_change(summary: &Summary) -> Option<f64> {
    circulation::largest_change(summary.results.get(AnalysisId::Circulation.name())?)
}

/// Lines of the table that is printed at the end of a run: what was found, and its value.
#[must_use]
pub fn printed_results(summary: &Summary) -> Vec<(String, String)> {
    let results = AnalysisId::ALL.into_iter().filter_map(|id| Some((id, summary.results.get(id.name())?)));
    results.flat_map(|(id, result)| descriptor(id).printed(result)).collect()
}

/// All tables that analyses may leave, with their analysis and their place among its tables.
pub(super) fn tables() -> impl Iterator<Item = (AnalysisId, usize, AnalysisTable)> {
    AnalysisId::ALL
        .into_iter()
        .flat_map(|id| id.tables().iter().enumerate().map(move |(place, names)| (id, place, *names)))
}

/// The chart of a table, with the results of a run that belong to it.
pub(super) fn chart(id: AnalysisId, place: usize, table: &Table, scene: &Scene, results: &Map<String, Value>) -> Chart {
    let result = results.get(id.name()).unwrap_or(&Value::Null);
    descriptor(id).chart(&Drawn { scene, table, place, result })
}

/// An analysis of samples under way.
struct Sampled {
    id: AnalysisId,
    /// Index of its sampler.
    sampler: usize,
    analysis: Box<dyn OfSamples>,
}

/// An analysis of states under way.
struct Observed {
    id: AnalysisId,
    first: u64,
    every: u64,
    analysis: Box<dyn OfStates>,
}

impl Observed {
    fn is_due(&self, step: u64) -> bool {
        step >= self.first && step.is_multiple_of(self.every)
    }
}

/// The analyses that a scene asks for.
#[derive(Default)]
pub(super) struct Analyses {
    /// In the order of their samplers.
    sampled: Vec<Sampled>,
    /// In the order in which their files are listed.
    observed: Vec<Observed>,
}

impl Analyses {
    /// Begins the analyses, or continues from the sections of a checkpoint.
    ///
    /// # Errors
    /// [`CheckpointError::Malformed`] where a section is not as long as its samples make it.
    pub(super) fn new(
        scene: &Scene,
        model: &Model,
        plan: &Plan,
        sections: &Sections<'_>,
    ) -> Result<Self, CheckpointError> {
        let mut analyses = Self::default();
        for (index, sampler) in plan.samplers.iter().enumerate() {
            let SamplerId::Analysis(id) = sampler.id else { continue };
            let setting = Setting { scene, model, plan, sampler: Some(sampler) };
            if let Some(Gathering::Samples(mut analysis)) = descriptor(id).begin(&setting) {
                restore(analysis.as_mut(), id, sampler.samples_before(sections.step), sections)?;
                analyses.sampled.push(Sampled { id, sampler: index, analysis });
            }
        }
        let setting = Setting { scene, model, plan, sampler: None };
        for id in AnalysisId::ALL {
            let descriptor = descriptor(id);
            let Some(Sampling { first, every, .. }) = descriptor.asked(scene, model) else { continue };
            if let Some(Gathering::States(mut analysis)) = descriptor.begin(&setting) {
                let every = every.max(1);
                restore(analysis.as_mut(), id, samples(every, first, sections.step), sections)?;
                analyses.observed.push(Observed { id, first, every, analysis });
            }
        }
        Ok(analyses)
    }

    /// Gives the device back the windows that were open when the checkpoint was saved.
    ///
    /// # Errors
    /// [`RunError::Checkpoint`] where one is missing or of another length.
    pub(super) fn continue_windows(&self, engine: &mut Engine<'_>, sections: &Sections<'_>) -> Result<(), RunError> {
        for Sampled { id, sampler, .. } in &self.sampled {
            let Some((buffer, taken)) = engine.plan().samplers[*sampler].open_window(sections.step) else { continue };
            let planned = engine.plan().buffers.iter().find(|planned| planned.array == buffer);
            let words = planned.map_or(0, |planned| planned.bytes / 4);
            if let Some(words) = sections.words(&window_name(*id), words)? {
                engine.continue_window(*sampler, taken, &words)?;
            }
        }
        Ok(())
    }

    /// Adds a sample of any sampler but the first.
    pub(super) fn add(&mut self, sample: &Sample) {
        if let Some(found) = self.sampled.iter_mut().find(|sampled| sampled.sampler == sample.sampler) {
            found.analysis.add(sample);
        }
    }

    /// Steps between two states, of all that take states.
    pub(super) fn state_intervals(&self) -> Vec<u64> {
        self.observed.iter().map(|observed| observed.every).collect()
    }

    /// Whether any takes the state of a step.
    pub(super) fn take_state(&self, step: u64) -> bool {
        self.observed.iter().any(|observed| observed.is_due(step))
    }

    /// Adds a state to those that take it.
    pub(super) fn add_state(&mut self, state: &State, model: &Model) {
        for observed in self.observed.iter_mut().filter(|observed| observed.is_due(state.step)) {
            observed.analysis.add(state, model);
        }
    }

    /// What a checkpoint has to keep of what the host has gathered of samples.
    pub(super) fn sections_of_samples(&self) -> Vec<(String, Vec<u8>)> {
        self.sampled.iter().map(|sampled| (sampled.id.name().to_owned(), sampled.analysis.section())).collect()
    }

    /// What a checkpoint has to keep of what the host has gathered of states.
    pub(super) fn sections_of_states(&self) -> Vec<(String, Vec<u8>)> {
        self.observed.iter().map(|observed| (observed.id.name().to_owned(), observed.analysis.section())).collect()
    }

    /// What a checkpoint of the current step, of which no sample is taken yet, has to keep of the windows that are open
    /// on the device.
    ///
    /// # Errors
    /// [`RunError`] if the device failed.
    pub(super) fn open_windows(&self, engine: &mut Engine<'_>) -> Result<Vec<(String, Vec<u8>)>, RunError> {
        let mut sections = Vec::new();
        for Sampled { id, sampler, .. } in &self.sampled {
            if let Some((buffer, _)) = engine.plan().samplers[*sampler].open_window(engine.step()) {
                let words = engine.words(buffer)?;
                sections.push((window_name(*id), words.into_iter().flat_map(u32::to_le_bytes).collect()));
            }
        }
        Ok(sections)
    }

    /// Writes the tables and adds the results, or why there are none, to the summary; `proceed` says before each analysis
    /// whether to.
    pub(super) fn conclude(
        &self,
        directory: &RunDirectory,
        summary: &mut Summary,
        proceed: &dyn Fn() -> Result<(), RunError>,
    ) -> Result<(), RunError> {
        for (id, analysis) in self.all().filter(|(_, analysis)| !analysis.is_idle()) {
            proceed()?;
            conclude(id, analysis, directory, summary)?;
        }
        Ok(())
    }

    fn all(&self) -> impl Iterator<Item = (AnalysisId, &dyn Analysis)> {
        let sampled = self.sampled.iter().map(|sampled| (sampled.id, sampled.analysis.as_ref() as &dyn Analysis));
        sampled.chain(self.observed.iter().map(|observed| (observed.id, observed.analysis.as_ref() as &dyn Analysis)))
    }
}

/// Continues an analysis from its section after so many samples.
fn restore<Kind: Analysis + ?Sized>(
    analysis: &mut Kind,
    id: AnalysisId,
    samples: u64,
    sections: &Sections<'_>,
) -> Result<(), CheckpointError> {
    if let Some(numbers) = sections.numbers(id.name(), analysis.numbers_after(samples))? {
        analysis.restore(&numbers, samples);
    }
    Ok(())
}

fn conclude(
    id: AnalysisId,
    analysis: &dyn Analysis,
    directory: &RunDirectory,
    summary: &mut Summary,
) -> Result<(), OutputError> {
    let Conclusion { tables, result, warnings } = analysis.conclude();
    match result {
        Ok(result) => {
            summary.results.insert(id.name().to_owned(), result);
            summary.warnings.extend(warnings);
        }
        Err(reason) => summary.warnings.push(format!("no result for `{}`: {reason}", id.path())),
    }
    for (names, table) in id.tables().iter().zip(&tables) {
        write_table(&directory.file(names.file), table)?;
    }
    Ok(())
}

/// The section with the open window of an analysis.
fn window_name(id: AnalysisId) -> String {
    format!("{}_window", id.name())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;
    use crate::plan::{Hardware, Options};
    use crate::run::plan;
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
        assert_eq!(analyses.sampled.len(), 8);
        let sections = analyses.sections_of_samples();
        let restored = after(3, &sections, run).unwrap();
        let fresh = after(0, &[], run).unwrap();
        for (((id, analysis), (_, restored)), (_, fresh)) in analyses.all().zip(restored.all()).zip(fresh.all()) {
            let text = |analysis: &dyn Analysis| {
                let conclusion = analysis.conclude();
                format!("{:?} {:?} {:?}", conclusion.tables, conclusion.result, conclusion.warnings)
            };
            assert_eq!(text(restored), text(analysis), "{id:?}");
            assert_eq!(restored.section(), analysis.section(), "{id:?}");
            assert_ne!(fresh.section(), analysis.section(), "{id:?}");
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
            analyses.sampled[0].analysis.conclude()
        };
        let correlated = scene(r#"{"autocorrelations": [{"quantity": "velocity", "every": 2, "window": 2}]}"#);
        let conclusion = gathered(&correlated, &[&[8], &[4], &[16], &[4]]);
        // Ratio 8/24; deviations (4 - 8/3)/12 and (4 - 16/3)/12, ±1/9, whose mean has the error 1/9.
        let [first, second] = [&conclusion.tables[0].rows[0], &conclusion.tables[0].rows[1]];
        assert_eq!(first[..3], [0.0, 1.0, 0.0]);
        assert_eq!(second[0], 1.0);
        assert!((second[1] - 1.0 / 3.0).abs() < 1e-15 && (second[2] - 1.0 / 9.0).abs() < 1e-15, "{second:?}");

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

    #[test]
    fn results_stand_in_the_charts_of_their_tables() {
        let scene = crate::scene::load("ideal-dissipative-gas", &[]).unwrap();
        let results = serde_json::json!({
            "diffusion": { "diffusion_einstein": { "value": 0.3, "standard_error": 0.01 }, "diffusion_green_kubo": null },
            "shear_wave": { "decay_rate": { "value": 0.2, "standard_error": 0.01 },
                "kinematic_viscosity": { "value": 7.0, "standard_error": null } },
        });
        let results = results.as_object().unwrap();
        let table = |columns: &[&str]| {
            Table::new(columns.to_vec(), (0..8).map(|row| vec![1.0 + f64::from(row); columns.len()]).collect())
        };
        let drawn = |id: AnalysisId, columns: &[&str], results| chart(id, 0, &table(columns), &scene, results);
        let found = drawn(AnalysisId::Diffusion, &["time", "mean_squared_displacement"], results);
        assert_eq!(found.panels[0].series[1].name, "6 D t + b, D = 0.300 ± 0.010");
        let found = drawn(AnalysisId::ShearWave, &["time", "amplitude", "fit"], results);
        assert!(found.subtitle.ends_with("kinematic viscosity 7"), "{}", found.subtitle);
        assert_eq!(found.panels[0].series[1].name, "exponential decay, rate 0.200 ± 0.010");
        // A run of an earlier version, without results.
        let found = drawn(AnalysisId::Diffusion, &["time", "mean_squared_displacement"], &Map::new());
        assert_eq!(found.panels[0].series.len(), 1);
    }
}
