//! What an analysis has to say of itself, and what it does with what it takes.

use super::Planner;
use super::gathered::{Gathered, Part};
use super::results::printed_estimate;
use crate::engine::Sample;
use crate::families::{Checked, Model};
use crate::numbers::grouped;
use crate::plan::{Need, Plan};
use crate::plot::{Chart, SeriesInk};
use crate::scene::{Output, Scene};
use crate::state::Reported;
use crate::table::Table;
use serde_json::Value;

/// An analysis: what it asks of a run, what is kept of its samples, and what follows from them.
pub(super) trait Descriptor {
    /// How a scene asks for it; none if it does not.
    fn asked(&self, scene: &Checked) -> Option<Sampling>;

    /// What a report has to leave for its sampler, if a scene asks for it.
    fn needs(&self, output: &Output) -> &'static [Need] {
        let _ = output;
        if self.takes_states() { &[] } else { &[Need::Particles] }
    }

    /// Adds its sampler to a plan, if it has one and a scene asks for it.
    fn add_sampler(&self, planner: &mut Planner<'_>) {
        let _ = planner;
    }

    /// True if its samples are states, and not rows of a sampler.
    fn takes_states(&self) -> bool {
        false
    }

    /// The kept numbers of samples.
    fn parts(&self, scene: &Checked) -> Vec<Part>;

    /// The numbers that a row of its sampler adds to the parts.
    fn numbers_of_sample(&self, setting: &Setting<'_>, sample: &Sample) -> Option<Vec<f64>> {
        let _ = (setting, sample);
        None
    }

    /// The numbers that a state with full-step momenta adds to the parts.
    fn numbers_of_state(&self, setting: &Setting<'_>, state: &Reported) -> Option<Vec<f64>> {
        let _ = (setting, state);
        None
    }

    /// Tables and result of what was gathered; none if there is nothing to write.
    fn conclude(&self, setting: &Setting<'_>, gathered: &Gathered) -> Option<Conclusion>;

    /// The species that the numbers at the end of the name of a column stand for.
    fn species_of(&self, scene: &Checked, numbers: &[usize]) -> Vec<String> {
        let _ = (scene, numbers);
        Vec::new()
    }

    /// The chart of a table that it left.
    fn chart(&self, drawn: &Drawn<'_>) -> Chart;

    /// What is printed of its result at the end of a run, as far as it is there: labels, and the names of means or coefficients.
    fn labels(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// Lines of the table that is printed at the end of a run: what, and its value.
    fn printed(&self, result: &Value) -> Vec<(String, String)> {
        let line = |(label, name): &(&str, &str)| Some(((*label).to_owned(), printed_estimate(&result[*name])?));
        self.labels().iter().filter_map(line).collect()
    }

    /// The names of the numbers that it finds, as they stand at the top of its result; counts of samples and what was asked for are none.
    fn finds(&self, scene: &Checked) -> Vec<&'static str> {
        let _ = scene;
        self.labels().iter().map(|(_, name)| *name).collect()
    }
}

/// How an analysis that a scene asks for is sampled.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Sampling {
    /// The first step sampled.
    pub(super) first: u64,
    /// Steps between two samples.
    pub(super) every: u64,
    /// How the samples are used.
    pub(super) detail: Option<String>,
    /// Numbers in its tables, if they are many.
    pub(super) numbers: u64,
    /// How many tables at the end of its list are not written.
    pub(super) left_out: usize,
}

impl Sampling {
    /// Samples after equilibration.
    pub(super) fn after_equilibration(scene: &Scene, every: u64) -> Self {
        Self { first: scene.time.equilibration, every, ..Self::default() }
    }

    /// Number of samples of a scene.
    pub(super) fn count(&self, scene: &Scene) -> u64 {
        (scene.time.steps.saturating_sub(self.first) / self.every.max(1)).saturating_add(1)
    }

    /// The same in windows of so many samples.
    pub(super) fn in_windows(self, window: u64) -> Self {
        Self { detail: Some(format!("windows of {} samples", grouped(window))), ..self }
    }
}

/// The run that samples belong to.
#[derive(Clone, Copy)]
pub(in crate::run) struct Setting<'a> {
    pub scene: &'a Checked,
    pub plan: &'a Plan,
}

/// What a chart is drawn from.
pub(super) struct Drawn<'a> {
    pub(super) scene: &'a Scene,
    pub(super) model: &'a Model,
    pub(super) table: &'a Table,
    /// Place of the table among those of its analysis.
    pub(super) place: usize,
    /// The result of the run; null where there is none.
    pub(super) result: &'a Value,
}

impl Drawn<'_> {
    pub(super) fn title(&self) -> &str {
        &self.scene.title
    }

    /// The ink of what belongs to the species that a result names: one, a pair, or all of them. Where there is only
    /// one, all are of it.
    pub(super) fn ink(&self, result: &Value) -> SeriesInk {
        let named = &result["species"];
        let names = named.as_array().map_or(std::slice::from_ref(named), Vec::as_slice);
        let numbers = names.iter().filter_map(|name| self.model.species_named(name.as_str()?));
        match numbers.collect::<Vec<usize>>()[..] {
            [one] => SeriesInk::Species([one; 2]),
            [one, other] => SeriesInk::Species([one.min(other), one.max(other)]),
            _ if self.model.species.len() == 1 => SeriesInk::Species([0; 2]),
            _ => SeriesInk::AllSpecies,
        }
    }

    /// The chart with this ink for series that have none of their own.
    pub(super) fn of_species(&self, mut chart: Chart) -> Chart {
        let series = chart.panels.iter_mut().flat_map(|panel| &mut panel.series);
        series.filter(|series| series.ink == SeriesInk::Own).for_each(|series| series.ink = self.ink(self.result));
        chart
    }

    /// A column; nothing where there is none of this name.
    pub(super) fn column(&self, name: &str) -> Vec<f64> {
        self.table.column(name).unwrap_or_default()
    }
}

/// What an analysis leaves.
pub(super) struct Conclusion {
    /// As many as the id has names for, in this order.
    pub(super) tables: Vec<Table>,
    /// The result, or why there is none.
    pub(super) result: Result<Value, String>,
    /// What to know about the result.
    pub(super) warnings: Vec<String>,
}

impl Conclusion {
    pub(super) fn new(table: Table, result: Result<Value, String>) -> Self {
        Self { tables: vec![table], result, warnings: Vec::new() }
    }
}
